//! The workbench without a window system: painted into an image, worked by a script. It is the same interface as the
//! window's, for pictures in documents and for measuring what the interface itself costs.

use crate::lab::LabError;
use crate::stats::{Spread, spread};
use crate::vulkan::{Gpu, GpuOptions, Painter, Pixels};
use crate::workbench::{Options, PICTURES, Workbench};
use crossbeam_channel::{Receiver, unbounded};
use egui::accesskit::{Node, NodeId};
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
    /// Labels of widgets to click on, one after the other; `X,Y` clicks at a point of the interface.
    pub clicks: Vec<String>,
    /// Frames of the interface to measure at the end.
    pub measure: usize,
    /// A file to save over and over.
    pub edit: Option<Edit>,
    /// How long to wait for the picture to settle after each step.
    pub patience: Duration,
}

/// An edit that goes back and forth, to measure how long it takes until its picture is there.
#[derive(Clone)]
pub struct Edit {
    /// The file.
    pub file: PathBuf,
    /// A text that stands in it once.
    pub from: String,
    /// What takes its place.
    pub to: String,
    /// How often to save.
    pub times: usize,
}

/// The screenshot and what was measured on the way.
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
}

struct Host {
    workbench: Workbench,
    context: egui::Context,
    painter: Painter,
    textures: Vec<TextureId>,
    nodes: HashMap<NodeId, Node>,
    script: Script,
    start: Instant,
    woken: Receiver<()>,
}

/// Opens the workbench offscreen, follows the script and takes the picture.
///
/// # Errors
/// Everything that opening can fail with; a label that no widget has; a picture that does not settle in time;
/// validation messages.
pub fn take(options: Options, gpu: &GpuOptions, script: Script) -> Result<Shot, LabError> {
    let (wake, woken) = unbounded();
    let gpu = Gpu::open(gpu)?;
    let painter = Painter::offscreen(&gpu, PICTURES)?;
    let textures = (0..PICTURES).map(|i| painter.picture(i)).collect();
    let workbench = Workbench::new(options, Arc::new(move || wake.send(()).unwrap_or_default()))?;
    let context = egui::Context::default();
    context.enable_accesskit();
    let start = Instant::now();
    let mut host = Host { workbench, context, painter, textures, nodes: HashMap::new(), script, start, woken };
    let shot = host.run();
    let Host { workbench, painter, .. } = host;
    let mut messages = workbench.close();
    drop(painter);
    messages.extend(gpu.messages());
    match messages.len() {
        0 => shot,
        n => Err(LabError::Request(format!("the Vulkan validation layer had {n} messages (see above)"))),
    }
}

impl Host {
    fn run(&mut self) -> Result<Shot, LabError> {
        self.settle()?;
        for click in self.script.clicks.clone() {
            let at = self.find(&click)?;
            // As a hand does it: there, down, up, each in a frame of its own.
            self.frame(vec![Event::PointerMoved(at)])?;
            for pressed in [true, false] {
                let button = PointerButton::Primary;
                self.frame(vec![Event::PointerButton { pos: at, button, pressed, modifiers: Modifiers::NONE }])?;
            }
            self.settle()?;
        }
        let mut cpu = Vec::new();
        let (mut gpu, mut copies) = (Vec::new(), Vec::new());
        for _ in 0..self.script.measure {
            cpu.push(self.frame(Vec::new())?);
            copies.push(self.painter.gpu_ms.0);
            gpu.push(self.painter.gpu_ms.1);
        }
        let (size, bytes) = self.painter.read()?;
        let edit_ms = self.script.edit.clone().map(|edit| self.edits(&edit)).transpose()?.map(spread);
        Ok(Shot { edit_ms, size, bytes, cpu_ms: spread(cpu), gpu_ms: spread(gpu), copy_ms: spread(copies) })
    }

    /// Saves a file again and again and waits for each picture; the file ends as it was.
    fn edits(&mut self, edit: &Edit) -> Result<Vec<f64>, LabError> {
        let at = |e: std::io::Error| LabError::Request(format!("'{}': {e}", edit.file.display()));
        let original = std::fs::read_to_string(&edit.file).map_err(at)?;
        if original.matches(&edit.from).count() != 1 {
            let message = format!("'{}' must stand once in '{}'", edit.from, edit.file.display());
            return Err(LabError::Request(message));
        }
        let changed = original.replace(&edit.from, &edit.to);
        let mut times = Vec::new();
        for i in 0..edit.times {
            self.settle()?;
            let before = self.workbench.shown_revision();
            let text = if i % 2 == 0 { &changed } else { &original };
            crate::files::write_whole(&edit.file, text.as_bytes()).map_err(at)?;
            let saved = Instant::now();
            while self.workbench.shown_revision() == before {
                if saved.elapsed() > self.script.patience {
                    crate::files::write_whole(&edit.file, original.as_bytes()).map_err(at)?;
                    return Err(LabError::Request("the edit led to no picture".into()));
                }
                self.frame(Vec::new())?;
                let _ = self.woken.recv_timeout(Duration::from_millis(2));
            }
            times.push(saved.elapsed().as_secs_f64() * 1e3);
        }
        crate::files::write_whole(&edit.file, original.as_bytes()).map_err(at)?;
        Ok(times)
    }

    /// Where a widget is; the whole label counts, then its beginning.
    fn find(&self, label: &str) -> Result<Pos2, LabError> {
        if let Some((x, y)) = label.split_once(',')
            && let (Ok(x), Ok(y)) = (x.trim().parse(), y.trim().parse())
        {
            return Ok(Pos2::new(x, y));
        }
        let of = |node: &Node| node.label().or(node.value()).map(str::to_string).unwrap_or_default();
        let with = |fits: &dyn Fn(&str) -> bool| {
            let found = self.nodes.values().filter(|n| fits(&of(n))).filter_map(|n| n.bounds());
            found.min_by(|a, b| (a.y0, a.x0).partial_cmp(&(b.y0, b.x0)).unwrap_or(std::cmp::Ordering::Equal))
        };
        let bounds = with(&|l| l == label).or_else(|| with(&|l| l.starts_with(label)));
        let bounds = bounds.ok_or_else(|| LabError::Request(format!("no widget is labelled '{label}'")))?;
        Ok(Pos2::new((bounds.x0 + bounds.x1) as f32 / 2.0, (bounds.y0 + bounds.y1) as f32 / 2.0) / self.script.scale)
    }

    /// Frames until everything requested is there and nothing moves any more.
    fn settle(&mut self) -> Result<(), LabError> {
        let until = Instant::now() + self.script.patience;
        let mut calm = 0;
        while calm < 8 {
            if Instant::now() > until {
                let seconds = self.script.patience.as_secs();
                let why = self.workbench.trouble().map_or(String::new(), |t| format!(": {t}"));
                return Err(LabError::Request(format!("the picture was not there after {seconds} s{why}")));
            }
            self.frame(Vec::new())?;
            calm = if self.workbench.settled() { calm + 1 } else { 0 };
            let _ = self.woken.recv_timeout(Duration::from_millis(20));
        }
        Ok(())
    }

    /// One frame of the interface; its CPU time, ms.
    fn frame(&mut self, events: Vec<Event>) -> Result<f64, LabError> {
        let (width, height) = self.script.size;
        let scale = self.script.scale;
        let mut input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, Vec2::new(width as f32, height as f32) / scale)),
            time: Some(self.start.elapsed().as_secs_f64()),
            focused: true,
            events,
            ..RawInput::default()
        };
        input.viewports.entry(input.viewport_id).or_default().native_pixels_per_point = Some(scale);
        self.workbench.poll_events();
        let begun = Instant::now();
        let (workbench, textures) = (&mut self.workbench, &self.textures);
        let output = self.context.run_ui(input, |ui| workbench.ui(ui, textures));
        if let Some(update) = output.platform_output.accesskit_update {
            self.nodes = update.nodes.into_iter().collect();
        }
        let primitives = self.context.tessellate(output.shapes, output.pixels_per_point);
        let pixels: Vec<Pixels<'_>> = workbench
            .pixels()
            .iter()
            .map(|(picture, size, bytes)| Pixels { picture: *picture, size: *size, bytes: bytes.as_slice() })
            .collect();
        let size = self.script.size;
        if self.painter.paint(size, output.pixels_per_point, output.textures_delta, &primitives, &pixels)? {
            drop(pixels);
            workbench.painted();
        }
        // Waiting for the GPU is not what the interface costs.
        Ok(begun.elapsed().as_secs_f64() * 1e3 - self.painter.waited_ms)
    }
}
