//! The window: winit's events in, painted frames out. It has a device of its own, see
//! [`crate::workbench::engine`].

use super::frame::Frame;
use crate::lab::LabError;
use crate::vulkan::{Gpu, GpuOptions, Painter, Surface, VulkanError};
use crate::workbench::{Options, PICTURES, Workbench, theme};
use egui::epaint::textures::TexturesDelta;
use egui::{TextureId, ViewportId};
use raw_window_handle::HasDisplayHandle;
use std::sync::Arc;
use std::time::{Duration, Instant};
use winit::application::ApplicationHandler;
use winit::dpi::LogicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::window::{Window, WindowId};

/// Something happened on another thread.
struct WindowWake;

/// How the window itself is opened.
pub struct WindowOptions {
    /// The device that paints the window.
    pub gpu: GpuOptions,
    /// Width and height in points; most of the monitor if absent.
    pub size: Option<(u32, u32)>,
}

/// A window that is open.
struct Open {
    state: egui_winit::State,
    painter: Painter,
    textures: Vec<TextureId>,
    frame: Frame,
    gpu: Arc<Gpu>,
    window: Arc<Window>,
}

struct App {
    workbench: Option<Workbench>,
    options: WindowOptions,
    context: egui::Context,
    open: Option<Open>,
    error: Option<LabError>,
    repaint_at: Option<Instant>,
    messages: Vec<String>,
    /// Whether the interface asked to close the window.
    closes: bool,
}

/// Opens the workbench in a window and runs until it is closed.
///
/// # Errors
/// No window system, no device that can present, an experiment that cannot be read; validation
/// messages.
pub fn run(options: Options, window: WindowOptions) -> Result<(), LabError> {
    let event_loop = EventLoop::<WindowWake>::with_user_event().build().map_err(|e| {
        LabError::Request(format!(
            "cannot open a window: {e}. It needs X11 or Wayland; `conelab render` and `conelab screenshot` need neither"
        ))
    })?;
    let proxy = event_loop.create_proxy();
    // A closed window needs no wake-up.
    let workbench = Workbench::new(
        options,
        Arc::new(move || drop(proxy.send_event(WindowWake))),
    )?;
    let context = egui::Context::default();
    theme::install(&context);
    let mut app = App {
        workbench: Some(workbench),
        options: window,
        context,
        open: None,
        error: None,
        repaint_at: None,
        messages: Vec::new(),
        closes: false,
    };
    let ran = event_loop.run_app(&mut app);
    app.close();
    ran.map_err(|e| LabError::Request(format!("the window failed: {e}")))?;
    if let Some(error) = app.error {
        return Err(error);
    }
    LabError::of_messages(app.messages.len())
}

impl App {
    fn create(&mut self, event_loop: &ActiveEventLoop) -> Result<Open, LabError> {
        let monitor = event_loop
            .primary_monitor()
            .or_else(|| event_loop.available_monitors().next());
        let size = match monitor {
            Some(m) => {
                let (pixels, scale) = (m.size(), m.scale_factor());
                let part = |pixels: u32| (PART * f64::from(pixels) / scale) as u32;
                let most = Some((part(pixels.width), part(pixels.height)));
                let most = most.filter(|size| size.0 > 0 && size.1 > 0);
                let size = self.options.size.or(most).unwrap_or(SIZE);
                clamped(size, scale, (pixels.width, pixels.height))
            }
            None => {
                let (width, height) = self.options.size.unwrap_or(SIZE);
                LogicalSize::new(f64::from(width), f64::from(height))
            }
        };
        let attributes = Window::default_attributes()
            .with_title("conelab")
            .with_inner_size(size);
        let window = event_loop
            .create_window(attributes)
            .map_err(|e| LabError::Request(format!("cannot open a window: {e}")))?;
        let window = Arc::new(window);
        let display = window
            .display_handle()
            .map_err(|e| VulkanError::Window(e.to_string()))?
            .as_raw();
        let gpu = Gpu::open_for(&self.options.gpu, Some(display))?;
        let surface = Surface::new(&gpu, window.clone())?;
        let size = window.inner_size();
        let painter = Painter::for_window(&gpu, surface, (size.width, size.height), PICTURES)?;
        let side = gpu.info.limits.max_image_dimension2_d as usize;
        let scale = Some(window.scale_factor() as f32);
        let state = egui_winit::State::new(
            self.context.clone(),
            ViewportId::ROOT,
            &*window,
            scale,
            window.theme(),
            Some(side),
        );
        let textures = (0..PICTURES).map(|i| painter.picture(i)).collect();
        Ok(Open {
            state,
            painter,
            textures,
            frame: Frame::default(),
            gpu,
            window,
        })
    }

    fn paint(&mut self) -> Result<(), LabError> {
        let (Some(open), Some(workbench)) = (&mut self.open, &mut self.workbench) else {
            return Ok(());
        };
        if workbench.is_described() {
            self.context.enable_accesskit();
        }
        let soon = workbench.poll_events();
        let size = open.window.inner_size();
        if let Some(left) = open.frame.serves(workbench.pixels()) {
            let (painter, size) = (&mut open.painter, (size.width, size.height));
            open.frame
                .paint(painter, size, TexturesDelta::default(), workbench)?;
            let due = Instant::now() + left;
            self.repaint_at = Some(self.repaint_at.map_or(due, |at| at.min(due)));
            return Ok(());
        }
        let input = open.state.take_egui_input(&open.window);
        let released = input
            .events
            .iter()
            .any(|e| matches!(e, egui::Event::PointerButton { pressed: false, .. }));
        let textures = &open.textures;
        let mut output = self.context.run_ui(input, |ui| workbench.ui(ui, textures));
        let more = workbench.describe(
            output.platform_output.accesskit_update.as_ref(),
            output.pixels_per_point,
            released,
        );
        output.platform_output.accesskit_update = None;
        open.state
            .handle_platform_output(&open.window, output.platform_output);
        let viewport = output.viewport_output.get(&ViewportId::ROOT);
        for command in viewport.iter().flat_map(|v| &v.commands) {
            match command {
                egui::ViewportCommand::Fullscreen(on) => open
                    .window
                    .set_fullscreen(on.then_some(winit::window::Fullscreen::Borderless(None))),
                egui::ViewportCommand::Title(title) => open.window.set_title(title),
                egui::ViewportCommand::Close => self.closes = true,
                _ => {}
            }
        }
        let shapes = std::mem::take(&mut output.shapes);
        open.frame
            .lay_out(&self.context, shapes, output.pixels_per_point);
        let (painter, size) = (&mut open.painter, (size.width, size.height));
        open.frame
            .paint(painter, size, output.textures_delta, workbench)?;
        let more = more.then_some(Duration::from_millis(110));
        let delays = [viewport.map(|v| v.repaint_delay), soon, more];
        let delay = delays.into_iter().flatten().min().unwrap_or(Duration::MAX);
        self.repaint_at = Instant::now().checked_add(delay);
        Ok(())
    }

    fn close(&mut self) {
        if let Some(mut workbench) = self.workbench.take() {
            workbench.write_session(&self.context);
            self.messages.extend(workbench.close());
        }
        if let Some(Open {
            painter,
            gpu,
            state,
            ..
        }) = self.open.take()
        {
            drop(painter);
            drop(state);
            self.messages.extend(gpu.messages());
        }
    }

    fn check(&mut self, result: Result<(), LabError>, event_loop: &ActiveEventLoop) {
        if let Err(e) = result {
            self.error = Some(e);
            event_loop.exit();
        }
    }
}

/// Part of the monitor's width and height that a new window takes: bars of the system remain
/// visible.
const PART: f64 = 0.85;

/// Size of a new window where the monitor's is unknown, points.
const SIZE: (u32, u32) = (1600, 900);

/// A size in points that fits a monitor of this size in pixels.
fn clamped(points: (u32, u32), scale: f64, monitor: (u32, u32)) -> LogicalSize<f64> {
    let most = |pixels: u32| {
        if pixels == 0 {
            f64::INFINITY
        } else {
            f64::from(pixels) / scale.max(0.1)
        }
    };
    LogicalSize::new(
        f64::from(points.0).min(most(monitor.0)),
        f64::from(points.1).min(most(monitor.1)),
    )
}

impl ApplicationHandler<WindowWake> for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.open.is_some() {
            return;
        }
        let made = self.create(event_loop).map(|open| {
            open.window.request_redraw();
            if let Some(workbench) = &mut self.workbench {
                workbench.paints_on(open.gpu.info.id);
            }
            self.open = Some(open);
        });
        self.check(made, event_loop);
    }

    fn user_event(&mut self, _: &ActiveEventLoop, WindowWake: WindowWake) {
        if let Some(open) = &self.open {
            open.window.request_redraw();
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(open) = &mut self.open else { return };
        let response = open.state.on_window_event(&open.window, &event);
        if response.repaint {
            open.frame.outdate();
            open.window.request_redraw();
        }
        match event {
            WindowEvent::CloseRequested => {
                let workbench = self.workbench.as_mut();
                if workbench.is_none_or(Workbench::may_close) {
                    event_loop.exit();
                }
                open.window.request_redraw();
            }
            WindowEvent::Resized(_) | WindowEvent::ScaleFactorChanged { .. } => {
                open.painter.resized();
                open.frame.outdate();
                open.window.request_redraw();
            }
            WindowEvent::DroppedFile(path) => {
                if let Some(workbench) = &mut self.workbench {
                    workbench.dropped(&path);
                }
            }
            WindowEvent::RedrawRequested => {
                let painted = self.paint();
                self.check(painted, event_loop);
                if self.closes {
                    event_loop.exit();
                }
            }
            _ => {}
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        let Some(open) = &mut self.open else { return };
        match self.repaint_at {
            Some(at) if at <= Instant::now() => {
                self.repaint_at = None;
                open.frame.outdate();
                open.window.request_redraw();
                event_loop.set_control_flow(ControlFlow::Wait);
            }
            Some(at) => event_loop.set_control_flow(ControlFlow::WaitUntil(at)),
            None => event_loop.set_control_flow(ControlFlow::Wait),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_fits_its_monitor() {
        assert_eq!(
            clamped((1600, 900), 2.0, (1600, 900)),
            LogicalSize::new(800.0, 450.0)
        );
        assert_eq!(
            clamped((1600, 900), 1.0, (3840, 2160)),
            LogicalSize::new(1600.0, 900.0)
        );
        // Some servers know no size.
        assert_eq!(
            clamped((1600, 900), 1.0, (0, 0)),
            LogicalSize::new(1600.0, 900.0)
        );
    }
}
