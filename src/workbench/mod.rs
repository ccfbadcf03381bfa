//! The workbench: an engine that renders in the background, and the interface that controls it.
//!
//! Nothing here knows a window system but the [`hosts`] of the interface: a window, and offscreen
//! screenshots.

mod background;
mod bar;
pub mod desired;
mod dock;
mod editor;
pub mod engine;
pub mod events;
mod help;
mod host;
pub mod hosts;
mod layout;
mod messages;
mod models;
mod opening;
mod panel;
mod pending;
pub mod picture;
mod poll;
pub mod read_back;
pub mod session;
mod tabs;
mod theme;
mod watch;

use crate::diagnostics::Diagnostic;
use crate::experiment::Experiment;
use crate::graph::run::Execution;
use crate::lab::{LabError, Workspace};
use crate::scene::Scene;
use crate::vulkan::{Buffer, DeviceId, GpuOptions, PixelSource, Pixels};
use background::Wake;
use desired::request::{RenderRequest, SideRequest};
use desired::{edit, history, request, sides};
use egui::{TextureId, Ui, Vec2};
use engine::Engine;
use engine::report::{DeviceReport, GraphInfo, PictureReport};
use events::Events;
use opening::picture_of;
use panel::effects;
use picture::compare::Mode;
use picture::{difference, view};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};
use tabs::TABS;

/// Pictures that hosts keep for the interface: A, B, the comparison, the inspector.
pub const PICTURES: usize = 4;
/// The picture of the comparison.
const COMPARISON: usize = 2;
/// The picture of the inspector.
const INSPECTOR: usize = 3;

/// New pixels of a picture: RGBA, 8 bits each, in main memory, on the engine's device, or both.
pub struct NewPixels {
    /// The picture's number.
    pub picture: usize,
    /// Width and height.
    pub size: [u32; 2],
    /// In main memory.
    pub bytes: Option<Arc<Vec<u8>>>,
    /// In memory that the window's device can take.
    pub shared: Option<Arc<Buffer>>,
}

impl NewPixels {
    /// As the painter takes them.
    pub fn source(&self) -> Option<Pixels<'_>> {
        let bytes = || self.bytes.as_ref().map(|b| PixelSource::Bytes(b));
        let source = self
            .shared
            .as_ref()
            .map(PixelSource::Shared)
            .or_else(bytes)?;
        Some(Pixels {
            picture: self.picture,
            size: self.size,
            source,
        })
    }
}

/// Graph, errors and picture of side A or B.
#[derive(Default)]
struct Side {
    info: Option<Arc<GraphInfo>>,
    /// Errors of the last build.
    errors: Vec<Diagnostic>,
    /// Messages of the graph's checks.
    checks: Vec<String>,
    picture: Option<PictureReport>,
}

impl Side {
    /// Whether its picture is of an earlier request.
    fn behind(&self, sent: u64) -> bool {
        self.picture
            .as_ref()
            .is_some_and(|p| p.preview || p.request < sent)
    }
}

/// How to open the workbench.
pub struct Options {
    /// The program's folders.
    pub home: Workspace,
    /// The device that renders.
    pub gpu: GpuOptions,
    /// The experiment to show.
    pub experiment: Experiment,
    /// Its file, which is watched.
    pub file: PathBuf,
    /// Picture size; that of the viewport when absent.
    pub size: Option<(u32, u32)>,
    /// What frames do at first.
    pub execution: Execution,
    /// File for the log of events.
    pub events: Option<PathBuf>,
    /// What of the last session comes back.
    pub restore: session::Restore,
}

/// The workbench.
pub struct Workbench {
    setup: Setup,
    engine: Engine,
    watch: watch::Watch,
    desired: RenderRequest,
    sent: Sent,
    sides: [Side; 2],
    alone: sides::Alone,
    scene: OpenScene,
    experiment: OpenExperiment,
    device: Option<DeviceReport>,
    undo: Undo,
    panel: panel::Panel,
    effects: effects::Effects,
    view: view::View,
    tabs: tabs::Tabs,
    layout: layout::Layout,
    dock: dock::Dock,
    session: session::Session,
    messages: messages::Messages,
    comparison: difference::Comparison,
    /// New pixels for the host.
    pixels: Vec<NewPixels>,
    reload: Reload,
}

/// Folders, device and callbacks of the workbench.
struct Setup {
    home: Workspace,
    gpu: GpuOptions,
    /// Called from other threads when there is something new to show.
    wake: Wake,
    events: Option<Events>,
}

/// The last request to the engine.
struct Sent {
    request: RenderRequest,
    /// Number of requests.
    number: u64,
    at: Instant,
}

impl Default for Sent {
    fn default() -> Sent {
        Sent {
            request: RenderRequest::default(),
            number: 0,
            at: Instant::now(),
        }
    }
}

/// The loaded scene, and the loading of another.
struct OpenScene {
    loaded: Option<Arc<Scene>>,
    /// Name of the loaded scene, and file of its sky's picture.
    source: Option<(String, String)>,
    /// The state before another scene was requested.
    before: Option<history::State>,
    /// Whether no scene is loaded because loading failed.
    missing: bool,
    /// Whether its warnings are shown, until they are dismissed.
    warned: bool,
    /// Diagonal of its bounds [m].
    diagonal: f32,
    /// Name of the scene being loaded, and the completed fraction.
    loading: Option<(String, f32)>,
    /// Scene files of the open menu, each with the message about its missing model.
    files: Option<Vec<(Option<String>, PathBuf)>>,
    models: models::Models,
}

impl OpenScene {
    fn new(root: &Path) -> OpenScene {
        OpenScene {
            loaded: None,
            source: None,
            before: None,
            missing: false,
            warned: false,
            diagonal: 1.0,
            loading: None,
            files: None,
            models: models::Models::new(root),
        }
    }
}

/// The experiment that is edited.
struct OpenExperiment {
    name: String,
    /// Camera and lights, until its scene is loaded.
    file: Option<Experiment>,
    /// Its file as last saved from here. That change needs no reload.
    written: Option<PathBuf>,
    /// Its state when it was opened or saved; absent until its scene is loaded.
    baseline: Option<opening::Edited>,
    /// Whether it differs from that; worked out once a frame.
    modified: bool,
    /// Files that were opened, the latest first.
    recent: Vec<PathBuf>,
}

#[derive(Default)]
struct Undo {
    history: history::History,
    /// Whether undo loads a scene. Its view and light are then those of the desired state.
    returning: bool,
}

/// When files of graphs or shaders changed, for the log of events.
#[derive(Default)]
struct Reload {
    changed_at: Option<Instant>,
    shown: u64,
}

impl Workbench {
    /// Opens the workbench; `wake` is called from other threads when there is something new to
    /// show.
    ///
    /// # Errors
    /// A log that cannot be written.
    pub fn new(options: Options, wake: Wake) -> Result<Workbench, LabError> {
        let root = options.home.root.clone();
        let (session, [a, b]) =
            session::start(&options.home.captures, options.restore, options.file);
        let experiment = a.unwrap_or(options.experiment);
        let events = options.events.as_deref().map(Events::new).transpose();
        let events = events
            .map_err(|e| LabError::Request(format!("cannot write the log of events: {e}")))?;
        let (home, gpu) = (options.home, options.gpu);
        let engine = Engine::start(home.clone(), gpu.clone(), wake.clone());
        let mut watch = watch::Watch::new(&root, wake.clone());
        let desired = RenderRequest {
            sides: [
                Some(SideRequest::of(&experiment)),
                b.as_ref().map(SideRequest::of),
            ],
            scene: experiment.scene.clone(),
            environment: picture_of(&experiment),
            size: options.size.unwrap_or((0, 0)),
            execution: options.execution,
            clock: request::Clock {
                at: experiment.time,
                jumps: 1,
                ..request::Clock::default()
            },
            ..RenderRequest::default()
        };
        watch.experiment(&session.file);
        crate::results::capture::sweep_partials(&home.captures);
        let trouble = watch.trouble.clone();
        Ok(Workbench {
            engine,
            watch,
            sent: Sent::default(),
            desired,
            sides: Default::default(),
            alone: None,
            scene: OpenScene::new(&root),
            experiment: OpenExperiment {
                name: experiment.name.clone(),
                file: Some(experiment),
                written: None,
                baseline: None,
                modified: false,
                recent: Vec::new(),
            },
            device: None,
            undo: Undo::default(),
            panel: panel::Panel::default(),
            effects: effects::Effects::default(),
            view: view::View::default(),
            tabs: tabs::Tabs::default(),
            layout: layout::Layout::new(options.size),
            dock: dock::Dock::default(),
            session,
            messages: messages::Messages {
                status: String::new(),
                trouble,
            },
            comparison: difference::Comparison::default(),
            pixels: Vec::new(),
            reload: Reload::default(),
            setup: Setup {
                home,
                gpu,
                wake,
                events,
            },
        })
    }

    /// The device that paints: where the engine's can share memory with it, pictures stay there.
    pub fn paints_on(&mut self, device: DeviceId) {
        self.desired.window = Some(device);
    }

    fn event(&mut self, name: &str, fields: serde_json::Value) {
        if let Some(events) = &mut self.setup.events {
            events.write(name, fields);
        }
    }

    /// Whether the picture is older than the last good build or shows what no longer compiles.
    fn stale(&self) -> bool {
        self.sides.iter().any(|s| !s.errors.is_empty())
    }

    fn waiting_text(&self) -> String {
        match &self.scene.loading {
            Some((what, part)) => format!("Loading {what}: {:.0} %", 100.0 * part),
            None if self.scene.missing => "No scene".into(),
            None if self.device.is_none() => "Opening the device".into(),
            None => "Compiling passes".into(),
        }
    }

    /// Sets the parameter that the graph names for clicks. No point also deselects the light.
    fn point_at(&mut self, at: Option<Vec2>) {
        if at.is_none() {
            self.tabs.surroundings.selected = None;
        }
        let Some(info) = self.sides[0].info.clone() else {
            return;
        };
        let Some(name) = &info.graph.pointer else {
            return;
        };
        let Some(param) = info.graph.params.param(name) else {
            return;
        };
        let at = at.map_or([-1.0; 2], |p| {
            [f64::from(p.x.floor()), f64::from(p.y.floor())]
        });
        for side in self.desired.sides.iter_mut().flatten() {
            edit::set(
                side,
                param,
                &crate::graph::param::Value::Vector(at.to_vec()),
            );
        }
    }

    /// Whether a point of the picture is chosen.
    fn is_pointed(&self) -> bool {
        let pointer = self.sides[0]
            .info
            .as_ref()
            .and_then(|i| i.graph.pointer.as_ref());
        let side = self.desired.sides[0].as_ref();
        let value = pointer
            .zip(side)
            .and_then(|(name, side)| side.params.iter().find(|p| p.0 == *name).map(|p| &p.1));
        matches!(value, Some(crate::graph::param::Value::Vector(v)) if v.first() >= Some(&0.0))
    }

    /// Whether a click on the picture fills a table.
    fn click_fills_tables(&self) -> bool {
        let fills = |o: &Arc<GraphInfo>| o.graph.pointer.is_some() && !o.graph.tables.is_empty();
        self.sides[0].info.as_ref().is_some_and(fills)
    }

    /// Sends the desired state to the engine, if it changed.
    fn send_request(&mut self) {
        if self.desired != self.sent.request {
            self.sent.request = self.desired.clone();
            self.sent.number += 1;
            self.sent.at = Instant::now();
            self.engine
                .request(self.sent.number, self.sent.request.clone());
        }
    }

    /// What went wrong last, if anything.
    pub fn trouble(&self) -> Option<&str> {
        self.messages.trouble.as_deref()
    }

    /// Errors of both sides in graphs and shaders.
    pub fn errors(&self) -> Vec<Diagnostic> {
        self.sides.iter().flat_map(|s| s.errors.clone()).collect()
    }

    /// Whether everything requested is on screen, or the reason why it cannot be.
    pub fn settled(&self) -> bool {
        let shown = |i: usize| {
            self.desired.sides[i].is_none()
                || !self.sides[i].errors.is_empty() && !self.engine.works()
                || self.sides[i].picture.as_ref().is_some_and(|p| {
                    let known = p.request >= self.sent.number && self.sides[i].info.is_some();
                    !p.preview && known
                })
        };
        shown(0)
            && shown(1)
            && self.scene.loading.is_none()
            && !self.comparison.work.is_working()
            && !TABS.iter().any(|tab| (tab.awaits)(self))
            && !self.effects.awaits()
    }

    /// Frames until all pictures have converged. None while frames go on without end.
    pub fn frames_left(&self) -> u32 {
        let shown = [0, 1].map(|i| {
            self.desired.sides[i]
                .as_ref()
                .and(self.sides[i].picture.as_ref())
        });
        match self.desired.continuous || self.desired.clock.playing {
            true => 0,
            false => shown
                .into_iter()
                .flatten()
                .map(|p| p.left)
                .max()
                .unwrap_or(0),
        }
    }

    /// The interface of one frame.
    pub fn ui(&mut self, ui: &mut Ui, textures: &[TextureId]) {
        layout::release_focus(ui);
        self.shortcuts(ui);
        egui::Panel::top("bar").show(ui, |ui| self.bar(ui));
        egui::Panel::bottom("status").show(ui, |ui| self.status_line(ui));
        egui::CentralPanel::no_frame().show(ui, |ui| match self.layout.hidden {
            true => {
                self.desired.read_back.clear();
                self.dock.middle = ui.max_rect();
                self.picture(ui, textures);
            }
            false => self.dock(ui, textures),
        });
        let place = self.dock.middle;
        self.messages(ui, place);
        if self.layout.help {
            self.help_window(ui, place);
        }
        if let Some(path) = self.scene.models.picked(ui) {
            self.dropped(&path);
        }
        self.fit_size(ui);
        self.note_baseline();
        self.set_title(ui.ctx());
        self.close_question(ui);
        self.keep_session(ui);
        let held = ui.input(|i| i.pointer.any_down()) || ui.ctx().egui_wants_keyboard_input();
        self.remember(held);
        if self.desired.sides[1].is_none() {
            self.sides[1] = Side::default();
            self.comparison.of = None;
        }
        self.compare();
        // Comparisons are made, and events say what pictures hold, in main memory.
        let maps = matches!(self.view.mode, Mode::Difference | Mode::Perceived)
            && self.desired.sides[1].is_some();
        self.desired.bytes = maps || self.setup.events.is_some();
        self.find_effects(ui);
        self.send_request();
        for tab in TABS {
            (tab.end_frame)(self, ui);
        }
    }

    /// The picture has the size of the viewport, once that has stood still for a moment.
    fn fit_size(&mut self, ui: &Ui) {
        let size = self
            .layout
            .fixed_size
            .unwrap_or((self.layout.area[0].max(1), self.layout.area[1].max(1)));
        if size == self.desired.size || size.0 < 2 || size.1 < 2 {
            self.layout.resize_since = None;
            return;
        }
        let first = self.desired.size == (0, 0);
        let since = *self.layout.resize_since.get_or_insert_with(Instant::now);
        let quiet = Duration::from_millis(120);
        if first || since.elapsed() >= quiet {
            self.desired.size = size;
            self.layout.resize_since = None;
        } else {
            ui.ctx().request_repaint_after(quiet);
        }
    }

    /// Ends: waits a little for the frame in work. Returns the device's validation messages.
    pub fn close(self) -> Vec<String> {
        let mut messages = self.tabs.chart.close(Duration::from_secs(5));
        messages.extend(self.engine.stop(Duration::from_secs(20)));
        messages
    }
}

fn ron_files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut list: Vec<PathBuf> = entries
        .map(|e| e.path())
        .filter(|p| p.extension().is_some_and(|e| e == "ron") && p.is_file())
        .collect();
    list.sort();
    list
}

/// A path's stem; a name as it is.
fn short(spec: &str) -> String {
    Path::new(spec)
        .file_stem()
        .map_or_else(|| spec.to_string(), |s| s.to_string_lossy().into_owned())
}
