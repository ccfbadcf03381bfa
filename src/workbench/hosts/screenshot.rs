//! The workbench without a window system: painted into an image, worked by a script. It is the same
//! interface as the window's, for pictures in documents and for measuring what the interface itself
//! costs.

use super::frame::Frame;
use super::texts::{Text, texts};
use crate::diagnostics::Diagnostic;
use crate::files::FileError;
use crate::lab::LabError;
use crate::results::stats::{Spread, spread};
use crate::vulkan::{Gpu, GpuOptions, Painter};
use crate::workbench::{Options, PICTURES, Workbench, theme};
use crossbeam_channel::{Receiver, unbounded};
use egui::accesskit::{Action, ActionRequest, Node, NodeId, TreeId};
use egui::epaint::textures::TexturesDelta;
use egui::{Event, Modifiers, PointerButton, Pos2, RawInput, Rect, TextureId, Vec2};
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What to do before the picture is taken.
pub struct Script {
    /// Width and height of the interface, pixels.
    pub size: (u32, u32),
    /// Pixels a point.
    pub scale: f32,
    /// Whether the theme is light, and not dark.
    pub light: bool,
    /// Whether the texts of the picture are listed.
    pub texts: bool,
    /// Labels of widgets to click on, one after the other; `X,Y` clicks at a point of the
    /// interface.
    pub clicks: Vec<String>,
    /// Frames of the interface to measure at the end.
    pub measure: usize,
    /// How the interface keeps pace with the engine, to measure behind that.
    pub pace: Option<Pace>,
    /// A file to save over and over.
    pub edit: Option<Edit>,
    /// How long to wait for the picture to converge after each step.
    pub patience: Duration,
}

/// An edit that goes back and forth, to measure how long it takes until its picture is there.
#[derive(Clone)]
pub struct Edit {
    /// The file.
    pub file: PathBuf,
    /// A text that occurs in it once.
    pub from: String,
    /// What takes its place.
    pub to: String,
    /// How often to save.
    pub times: usize,
}

/// Pictures that the engine makes one after the other, painted as they come.
#[derive(Clone, Copy)]
pub struct Pace {
    /// How many.
    pub pictures: usize,
    /// Time from one frame of the interface to the next; whenever there is something new when
    /// absent.
    pub every: Option<Duration>,
}

/// How the interface kept pace.
pub struct Kept {
    /// Pictures that the engine finished.
    pub pictures: u64,
    /// Pictures that were painted: of several between two frames only the last is.
    pub painted: usize,
    /// From one picture's end to the next, in the engine; ms.
    pub engine_ms: Spread,
    /// From one frame of the interface that shows a new picture to the next; of all frames, where
    /// those have a pace of their own; ms.
    pub paint_ms: Spread,
    /// From a picture's end to the submission of the frame that shows it, ms.
    pub delay_ms: Spread,
    /// CPU time of a frame of the interface, ms.
    pub cpu_ms: Spread,
    /// CPU time of frames with a new layout, ms.
    pub layout_ms: Spread,
    /// Number of frames with a new layout. The others show new pictures in the last one.
    pub layouts: usize,
    /// Main memory that the process held after a tenth of the pictures, and after all; where the
    /// system says.
    pub memory: Option<(u64, u64)>,
}

/// The screenshot and its measurements.
pub struct Shot {
    /// From the file's renaming until the picture made with it is painted, ms.
    pub edit_ms: Option<Spread>,
    /// Width and height.
    pub size: [u32; 2],
    /// RGBA.
    pub bytes: Vec<u8>,
    /// CPU time of a frame of the interface: layout, triangles, recording; ms.
    pub cpu_ms: Spread,
    /// GPU time of drawing a frame of the interface, ms.
    pub gpu_ms: Spread,
    /// GPU time of copying new pictures for it, ms.
    pub copy_ms: Spread,
    /// How the interface kept pace.
    pub pace: Option<Kept>,
    /// The texts of the picture.
    pub texts: Vec<Text>,
    /// Errors that the picture shows.
    pub errors: Vec<Diagnostic>,
    /// Frames that were missing to a converged picture when patience ended.
    pub frames_left: u32,
}

struct Host {
    workbench: Workbench,
    context: egui::Context,
    painter: Painter,
    textures: Vec<TextureId>,
    last: Frame,
    nodes: HashMap<NodeId, Node>,
    script: Script,
    start: Instant,
    woken: Receiver<()>,
    /// The texts of the last frame.
    texts: Vec<Text>,
}

/// Opens the workbench offscreen, follows the script and takes the picture.
///
/// # Errors
/// Everything that opening can fail with; a label that no widget has; a picture that does not
/// settle in time; validation messages.
pub fn take(options: Options, gpu: &GpuOptions, script: Script) -> Result<Shot, LabError> {
    let (wake, woken) = unbounded();
    let gpu = Gpu::open(gpu)?;
    let painter = Painter::offscreen(&gpu, PICTURES)?;
    let textures = (0..PICTURES).map(|i| painter.picture(i)).collect();
    let mut workbench =
        Workbench::new(options, Arc::new(move || wake.send(()).unwrap_or_default()))?;
    workbench.paints_on(gpu.info.id);
    let context = egui::Context::default();
    theme::install(&context);
    context.set_theme(match script.light {
        true => egui::Theme::Light,
        false => egui::Theme::Dark,
    });
    context.enable_accesskit();
    let start = Instant::now();
    let mut host = Host {
        workbench,
        context,
        painter,
        textures,
        last: Frame::default(),
        nodes: HashMap::new(),
        script,
        start,
        woken,
        texts: Vec::new(),
    };
    let shot = host.run();
    let Host {
        workbench, painter, ..
    } = host;
    let mut messages = workbench.close();
    drop(painter);
    messages.extend(gpu.messages());
    LabError::of_messages(messages.len())?;
    shot
}

impl Host {
    fn run(&mut self) -> Result<Shot, LabError> {
        self.settle()?;
        for click in self.script.clicks.clone() {
            let at = self.target(&click)?;
            // As a hand does it: there, down, up, each in a frame of its own.
            self.frame(vec![Event::PointerMoved(at)])?;
            for pressed in [true, false] {
                let button = PointerButton::Primary;
                self.frame(vec![Event::PointerButton {
                    pos: at,
                    button,
                    pressed,
                    modifiers: Modifiers::NONE,
                }])?;
            }
            self.settle()?;
        }
        let until = Instant::now() + self.script.patience;
        while self.workbench.frames_left() > 0 && Instant::now() < until {
            let _ = self.woken.recv_timeout(Duration::from_millis(100));
            self.repaint()?;
        }
        let frames_left = self.workbench.frames_left();
        self.settle()?;
        if self.script.measure > 0 || self.script.pace.is_some() {
            // A window without a screen reader does not describe its widgets either.
            self.context.disable_accesskit();
        }
        let mut cpu = Vec::new();
        let (mut gpu, mut copies) = (Vec::new(), Vec::new());
        for _ in 0..self.script.measure {
            cpu.push(self.frame(Vec::new())?);
            copies.push(self.painter.gpu_ms.0);
            gpu.push(self.painter.gpu_ms.1);
        }
        let pace = self.script.pace.map(|pace| self.pace(pace)).transpose()?;
        let (size, bytes) = self.painter.read()?;
        let edit_ms = self
            .script
            .edit
            .clone()
            .map(|edit| self.edits(&edit))
            .transpose()?
            .map(spread);
        Ok(Shot {
            edit_ms,
            size,
            bytes,
            cpu_ms: spread(cpu),
            gpu_ms: spread(gpu),
            copy_ms: spread(copies),
            pace,
            texts: std::mem::take(&mut self.texts),
            errors: self.workbench.errors(),
            frames_left,
        })
    }

    /// Paints while the engine makes pictures.
    fn pace(&mut self, pace: Pace) -> Result<Kept, LabError> {
        let stamp = |host: &Host| host.workbench.last_picture();
        let Some((first, _)) = stamp(self) else {
            return Err(LabError::Request(
                "there is no picture yet, so its pace cannot be measured".into(),
            ));
        };
        let (mut engine, mut paints, mut delays) = (Vec::new(), Vec::new(), Vec::new());
        let (mut cpu, mut layouts) = (Vec::new(), Vec::new());
        let (mut seen, mut painted, mut early) = (stamp(self), Instant::now(), None);
        let (mut until, mut next) = (painted + self.script.patience, painted);
        while seen.is_some_and(|(frame, _)| frame - first < pace.pictures as u64) {
            match pace.every {
                Some(every) => {
                    next += every;
                    std::thread::sleep(next.saturating_duration_since(Instant::now()));
                }
                None => drop(self.woken.recv_timeout(Duration::from_millis(100))),
            }
            // One frame answers all that has been said meanwhile.
            while self.woken.try_recv().is_ok() {}
            let (ms, laid_out) = self.repaint()?;
            let now = Instant::now();
            let (new, last) = (stamp(self), seen);
            let came = new.zip(last).filter(|(new, last)| new.0 > last.0);
            if let Some(((frame, end), (frame_before, end_before))) = came {
                engine.push((end - end_before).as_secs_f64() * 1e3 / (frame - frame_before) as f64);
                delays.push(end.elapsed().as_secs_f64() * 1e3);
                until = now + self.script.patience;
                seen = new;
            }
            if came.is_some() || pace.every.is_some() {
                paints.push((now - painted).as_secs_f64() * 1e3);
                cpu.push(ms);
                layouts.extend(laid_out.then_some(ms));
                painted = now;
            }
            if early.is_none()
                && seen.is_some_and(|(frame, _)| frame - first >= pace.pictures as u64 / 10)
            {
                early = resident_bytes();
            }
            if now > until {
                return Err(LabError::Request(
                    "the engine has stopped rendering: add --click continuous".into(),
                ));
            }
        }
        Ok(Kept {
            pictures: seen.map_or(0, |(frame, _)| frame - first),
            painted: delays.len(),
            engine_ms: spread(engine),
            paint_ms: spread(paints),
            delay_ms: spread(delays),
            cpu_ms: spread(cpu),
            layouts: layouts.len(),
            layout_ms: spread(layouts),
            memory: early.zip(resident_bytes()),
        })
    }

    /// Saves a file again and again and waits for each picture; the file ends as it was.
    fn edits(&mut self, edit: &Edit) -> Result<Vec<f64>, LabError> {
        let original =
            std::fs::read_to_string(&edit.file).map_err(|e| FileError::content(&edit.file, e))?;
        if original.matches(&edit.from).count() != 1 {
            let message = format!(
                "'{}' must occur exactly once in '{}'",
                edit.from,
                edit.file.display()
            );
            return Err(LabError::Request(message));
        }
        let changed = original.replace(&edit.from, &edit.to);
        let mut times = Vec::new();
        for i in 0..edit.times {
            self.settle()?;
            let before = self.workbench.shown_revision();
            let text = if i % 2 == 0 { &changed } else { &original };
            crate::files::write_whole(&edit.file, text.as_bytes())?;
            let saved = Instant::now();
            while self.workbench.shown_revision() == before {
                if saved.elapsed() > self.script.patience {
                    crate::files::write_whole(&edit.file, original.as_bytes())?;
                    return Err(LabError::Request("the edit led to no picture".into()));
                }
                self.frame(Vec::new())?;
                let _ = self.woken.recv_timeout(Duration::from_millis(2));
            }
            times.push(saved.elapsed().as_secs_f64() * 1e3);
        }
        crate::files::write_whole(&edit.file, original.as_bytes())?;
        Ok(times)
    }

    /// The point to click: a place `X,Y`, or the centre of a widget, which is scrolled into view.
    fn target(&mut self, label: &str) -> Result<Pos2, LabError> {
        if let Some((x, y)) = label.split_once(',')
            && let (Ok(x), Ok(y)) = (x.trim().parse(), y.trim().parse())
        {
            return Ok(Pos2::new(x, y));
        }
        let node = self.find(label)?;
        if !self.is_visible(node) {
            let request = ActionRequest {
                action: Action::ScrollIntoView,
                target_tree: TreeId::ROOT,
                target_node: node,
                data: None,
            };
            self.frame(vec![Event::AccessKitActionRequest(request)])?;
            self.settle()?;
        }
        let bounds = self.nodes.get(&node).and_then(Node::bounds);
        let bounds = bounds.filter(|_| self.is_visible(node));
        let bounds = bounds.ok_or_else(|| {
            LabError::Request(format!(
                "the widget labelled '{label}' is not visible: take a larger --window"
            ))
        })?;
        // In points, as the positions of events: the scale is a transform of the root.
        Ok(Pos2::new(
            (bounds.x0 + bounds.x1) as f32 / 2.0,
            (bounds.y0 + bounds.y1) as f32 / 2.0,
        ))
    }

    /// Whether the centre of a widget is inside the scroll areas around it, and in the window.
    fn is_visible(&self, node: NodeId) -> bool {
        let screen = self.context.content_rect();
        self.context.viewport(|viewport| {
            let layers = viewport.prev_pass.widgets.layers();
            let mut widgets = layers.flat_map(|layer| layer.1);
            let widget = widgets.find(|w| w.id.accesskit_id() == node);
            widget.is_none_or(|w| {
                let shown = w.interact_rect.intersect(screen);
                shown.is_positive() && shown.contains(w.rect.center())
            })
        })
    }

    /// The widget with a label, or with a label that starts like this.
    fn find(&self, label: &str) -> Result<NodeId, LabError> {
        let of = |node: &Node| {
            node.label()
                .or(node.value())
                .map(str::to_string)
                .unwrap_or_default()
        };
        let with = |fits: &dyn Fn(&str) -> bool| {
            let found = self
                .nodes
                .iter()
                .filter(|(_, n)| fits(&of(n)))
                .filter_map(|(id, n)| Some((*id, n.bounds()?)));
            let first = found.min_by(|(_, a), (_, b)| {
                (a.y0, a.x0)
                    .partial_cmp(&(b.y0, b.x0))
                    .unwrap_or(std::cmp::Ordering::Equal)
            });
            first.map(|(id, _)| id)
        };
        with(&|l| l == label)
            .or_else(|| with(&|l| l.starts_with(label)))
            .ok_or_else(|| LabError::Request(format!("no widget is labelled '{label}'")))
    }

    /// Frames until everything requested is there and nothing moves any more.
    fn settle(&mut self) -> Result<(), LabError> {
        let until = Instant::now() + self.script.patience;
        let mut calm = 0;
        while calm < 8 {
            if Instant::now() > until {
                let seconds = self.script.patience.as_secs();
                let why = self
                    .workbench
                    .trouble()
                    .map_or(String::new(), |t| format!(": {t}"));
                return Err(LabError::Request(format!(
                    "no picture after {seconds} s{why}"
                )));
            }
            self.frame(Vec::new())?;
            calm = if self.workbench.settled() {
                calm + 1
            } else {
                0
            };
            let _ = self.woken.recv_timeout(Duration::from_millis(20));
        }
        Ok(())
    }

    /// Paints like the window. Returns the CPU time, ms, and whether the layout is new.
    fn repaint(&mut self) -> Result<(f64, bool), LabError> {
        self.workbench.poll_events();
        let begun = Instant::now();
        if self.last.serves(self.workbench.pixels()).is_none() {
            return Ok((self.frame(Vec::new())?, true));
        }
        let (painter, workbench) = (&mut self.painter, &mut self.workbench);
        let (size, textures) = (self.script.size, TexturesDelta::default());
        self.last.paint(painter, size, textures, workbench)?;
        Ok((
            begun.elapsed().as_secs_f64() * 1e3 - self.painter.waited_ms,
            false,
        ))
    }

    /// One frame of the interface; its CPU time, ms.
    fn frame(&mut self, events: Vec<Event>) -> Result<f64, LabError> {
        let (width, height) = self.script.size;
        let scale = self.script.scale;
        let mut input = RawInput {
            screen_rect: Some(Rect::from_min_size(
                Pos2::ZERO,
                Vec2::new(width as f32, height as f32) / scale,
            )),
            time: Some(self.start.elapsed().as_secs_f64()),
            focused: true,
            events,
            ..RawInput::default()
        };
        input
            .viewports
            .entry(input.viewport_id)
            .or_default()
            .native_pixels_per_point = Some(scale);
        self.workbench.poll_events();
        let begun = Instant::now();
        let (workbench, textures) = (&mut self.workbench, &self.textures);
        let output = self.context.run_ui(input, |ui| workbench.ui(ui, textures));
        if let Some(update) = output.platform_output.accesskit_update {
            self.nodes = update.nodes.into_iter().collect();
        }
        if self.script.texts {
            self.texts = texts(&output.shapes, scale);
        }
        self.last
            .lay_out(&self.context, output.shapes, output.pixels_per_point);
        let (painter, size) = (&mut self.painter, self.script.size);
        self.last
            .paint(painter, size, output.textures_delta, workbench)?;
        // Waiting for the GPU is no cost of the interface.
        Ok(begun.elapsed().as_secs_f64() * 1e3 - self.painter.waited_ms)
    }
}

/// Main memory that the process holds, where the system says (Linux).
fn resident_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmRSS:"))?;
    line.split_whitespace()
        .next()?
        .parse::<u64>()
        .ok()
        .map(|kib| kib * 1024)
}
