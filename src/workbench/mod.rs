//! The workbench: an engine that renders aside, and the interface that says what it shall render.
//!
//! Nothing here knows a window system: [`crate::window`] and offscreen screenshots are two hosts of the same interface.

mod bar;
mod builder;
mod chart;
pub mod compare;
pub mod edit;
pub mod engine;
pub mod events;
mod gallery;
mod help;
mod history;
mod inspector;
pub mod judge;
mod keep;
mod messages;
mod motion;
mod panel;
mod paths;
mod renderdoc;
pub mod report;
mod surroundings;
mod tables;
mod times;
mod view;
mod watch;
pub mod wish;

use crate::experiment::Experiment;
use crate::graph::source::Diagnostic;
use crate::graph::successor::Change;
use crate::lab::{Home, LabError, viewpoint_of};
use crate::scene::Scene;
use crate::vulkan::GpuOptions;
use compare::{Map, Mode, Shown};
use crossbeam_channel::{Receiver, Sender, unbounded};
use egui::{TextureId, Ui, Vec2};
use engine::{Engine, Order};
use events::Events;
use report::{DeviceReport, Outline, PictureReport, Report};
use serde_json::json;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};
use wish::{SlotWish, Wish};

/// Pictures that hosts keep for the interface: A, B, the comparison, the inspector.
pub const PICTURES: usize = 4;
/// The picture of the comparison.
const COMPARISON: usize = 2;
/// The picture of the inspector.
const INSPECTOR: usize = 3;

/// New pixels of a picture: its number, size and RGBA bytes.
pub type NewPixels = (usize, [u32; 2], Arc<Vec<u8>>);

/// What is compared: mode, gain, A, B.
type ComparisonOf = (Mode, u32, Arc<Vec<u8>>, Arc<Vec<u8>>);

/// What came of it.
type Compared = (Mode, Option<Map>);

/// What is known of A or B.
#[derive(Default)]
struct Slot {
    outline: Option<Arc<Outline>>,
    /// Errors of the last build.
    errors: Vec<Diagnostic>,
    /// Messages of the graph's checks.
    checks: Vec<String>,
    picture: Option<PictureReport>,
}

/// What is shown on the right.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Tab {
    Surroundings,
    Times,
    Chart,
    Inspector,
    Tables,
    Paths,
    Gallery,
}

/// How to open the workbench.
pub struct Options {
    /// Its folders.
    pub home: Home,
    /// The device that renders.
    pub gpu: GpuOptions,
    /// The experiment to open.
    pub experiment: PathBuf,
    /// Another scene than the experiment's.
    pub scene: Option<String>,
    /// Picture size; that of the window's middle when absent.
    pub size: Option<(u32, u32)>,
    /// Where to log what happens.
    pub events: Option<PathBuf>,
}

/// The workbench.
pub struct Workbench {
    engine: Engine,
    watch: watch::Watch,
    wish: Wish,
    /// The wish that the engine was told last.
    told: Wish,
    name: String,
    slots: [Slot; 2],
    scene: Option<Arc<Scene>>,
    /// Of the scene's bounds, m; asking for them walks through all vertices.
    diagonal: f32,
    experiment: Option<Experiment>,
    loading: Option<(String, f32)>,
    device: Option<DeviceReport>,
    history: history::History,
    /// Whether undo goes to the scene that is loaded: its view and light are those of the wish.
    returning: bool,
    panel: panel::Panel,
    panel_slot: usize,
    view: view::View,
    tab: Tab,
    times: times::Times,
    chart: chart::Chart,
    inspector: inspector::Inspector,
    tables: tables::Tables,
    paths: paths::Paths,
    gallery: gallery::Gallery,
    help: bool,
    /// What was said last, and since when.
    status: String,
    trouble: Option<String>,
    pixels: Vec<NewPixels>,
    comparison: Option<(Mode, Map)>,
    comparing: bool,
    /// What was compared last: mode, gain, A, B.
    comparison_of: Option<ComparisonOf>,
    compared: (Sender<Compared>, Receiver<Compared>),
    /// The area of the picture, in pixels of the screen.
    area: [u32; 2],
    fixed_size: Option<(u32, u32)>,
    resize_since: Option<Instant>,
    events: Option<Events>,
    changed_at: Option<Instant>,
    shown_revision: u64,
    wake: Arc<dyn Fn() + Send + Sync>,
    root: PathBuf,
    home: Home,
    gpu: GpuOptions,
}

impl Workbench {
    /// Opens the workbench; `wake` is called from other threads when there is something new to show.
    ///
    /// # Errors
    /// An experiment that cannot be read, a log that cannot be written.
    pub fn new(options: Options, wake: Arc<dyn Fn() + Send + Sync>) -> Result<Workbench, LabError> {
        let experiment = Experiment::read(&options.experiment).map_err(LabError::Input)?;
        let events = options.events.as_deref().map(Events::new).transpose();
        let events = events.map_err(|e| LabError::Request(format!("cannot write the log of events: {e}")))?;
        let root = options.home.root.clone();
        let (home, gpu) = (options.home, options.gpu);
        let engine = Engine::start(home.clone(), gpu.clone(), wake.clone());
        let mut watch = watch::Watch::new(&root, wake.clone());
        let wish = Wish {
            slots: [Some(slot_of(&experiment)), None],
            scene: options.scene.unwrap_or_else(|| experiment.scene.clone()),
            size: options.size.unwrap_or((0, 0)),
            clock: wish::Clock { at: experiment.time, jumps: 1, ..wish::Clock::default() },
            ..Wish::default()
        };
        watch.scene(&wish.scene);
        crate::capture::sweep_partials(&root.join("captures"));
        let trouble = watch.trouble.clone();
        Ok(Workbench {
            engine,
            watch,
            told: Wish::default(),
            wish,
            name: experiment.name.clone(),
            slots: Default::default(),
            scene: None,
            diagonal: 1.0,
            experiment: Some(experiment),
            loading: None,
            device: None,
            history: history::History::default(),
            returning: false,
            panel: panel::Panel::default(),
            panel_slot: 0,
            view: view::View::default(),
            tab: Tab::Surroundings,
            times: times::Times::default(),
            chart: chart::Chart::default(),
            inspector: inspector::Inspector::default(),
            tables: tables::Tables::default(),
            paths: paths::Paths::default(),
            gallery: gallery::Gallery::default(),
            help: false,
            status: String::new(),
            trouble,
            pixels: Vec::new(),
            comparison: None,
            comparing: false,
            comparison_of: None,
            compared: unbounded(),
            area: [0, 0],
            fixed_size: options.size,
            resize_since: None,
            events,
            changed_at: None,
            shown_revision: 0,
            wake,
            root,
            home,
            gpu,
        })
    }

    fn event(&mut self, name: &str, fields: serde_json::Value) {
        if let Some(events) = &mut self.events {
            events.write(name, fields);
        }
    }

    /// Takes in what other threads have to say. Returns how soon to ask again, if something is about to come.
    pub fn pump(&mut self) -> Option<Duration> {
        while let Ok(report) = self.engine.reports.try_recv() {
            self.report(report);
        }
        while let Ok((mode, map)) = self.compared.1.try_recv() {
            self.comparing = false;
            if let Some(map) = map {
                self.pixels.retain(|p| p.0 != COMPARISON);
                self.pixels.push((COMPARISON, map.size, map.bytes.clone()));
                let (mean, max, differing) = (map.mean, map.max, map.differing);
                let name = compare::MODES.iter().find(|m| m.0 == mode).map_or("", |m| m.1);
                self.event("compared", json!({ "mode": name, "mean": mean, "max": max, "differing": differing }));
                self.comparison = Some((mode, map));
            }
        }
        if let Some(pixels) = self.inspector.take(&self.wake) {
            self.pixels.retain(|p| p.0 != INSPECTOR);
            self.pixels.push(pixels);
        }
        self.chart_news();
        match self.watch.take() {
            Ok(changed) => {
                self.files_changed(&changed);
                None
            }
            Err(wait) => wait,
        }
    }

    fn files_changed(&mut self, changed: &watch::Changed) {
        if changed.method {
            self.wish.revision += 1;
            self.changed_at = Some(Instant::now());
            self.event("changed", json!({ "revision": self.wish.revision }));
        }
        if changed.scene {
            self.wish.scene_revision += 1;
        }
        for path in &changed.experiments {
            self.experiment_changed(path);
        }
        self.tell();
    }

    /// The open experiment's file was edited: its values take the place of those here.
    fn experiment_changed(&mut self, path: &Path) {
        if path.file_stem().is_none_or(|s| s.to_string_lossy() != self.name.as_str()) {
            return;
        }
        match Experiment::read(path) {
            Ok(experiment) => {
                self.slots[0].errors.clear();
                if slot_of(&experiment) != self.wish.slots[0].clone().unwrap_or_default()
                    || experiment.scene != self.wish.scene
                {
                    self.open(&experiment);
                    self.status = format!("read {} again", path.display());
                }
            }
            Err(errors) => self.slots[0].errors = errors,
        }
    }

    /// Shows an experiment in slot A.
    fn open(&mut self, experiment: &Experiment) {
        self.history.opens();
        self.name.clone_from(&experiment.name);
        self.wish.slots[0] = Some(slot_of(experiment));
        if self.wish.scene == experiment.scene {
            if let Some(scene) = &self.scene {
                self.wish.camera = viewpoint_of(experiment, scene).ok().map(|v| v.camera);
                self.wish.lights = keep::lights(experiment, scene).unwrap_or_default();
            }
        } else {
            self.open_scene(&experiment.scene);
        }
        self.experiment = Some(experiment.clone());
        self.wish.clock.at = experiment.time;
        self.wish.clock.jumps += 1;
    }

    fn open_scene(&mut self, spec: &str) {
        self.wish.scene = spec.to_string();
        self.wish.lights = None;
        self.returning = false;
        self.watch.scene(spec);
    }

    /// A file was dropped on the window.
    pub fn dropped(&mut self, path: &Path) {
        let spec = path.to_string_lossy().into_owned();
        let is_ron = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("ron"));
        match Experiment::read(path) {
            Ok(experiment) if is_ron => self.open(&experiment),
            _ => {
                self.experiment = None;
                self.open_scene(&spec);
            }
        }
        self.tell();
    }

    fn report(&mut self, report: Report) {
        match report {
            Report::Device(device) => {
                self.event("device", json!({ "name": device.name, "driver": device.driver }));
                self.device = Some(device);
                self.chart.restarted();
                self.trouble = None;
            }
            Report::Built { slot, outline, change, ms, revision, objects } => {
                let Change { kept, built, resized } = change;
                self.status = format!("kept {kept}, rebuilt {built}, resized {resized}, {ms:.0} ms");
                self.event(
                    "built",
                    json!({ "slot": slot, "kept": kept, "rebuilt": built, "resized": resized, "build_ms": ms,
                        "revision": revision, "objects": objects }),
                );
                self.times.built(slot, &outline);
                self.mended(slot);
                self.slots[slot].outline = Some(outline);
            }
            Report::Failed { slot, diagnostics, revision } => {
                let texts: Vec<String> = diagnostics.iter().map(ToString::to_string).collect();
                self.event("failed", json!({ "slot": slot, "errors": texts, "revision": revision }));
                self.slots[slot].errors = diagnostics;
            }
            Report::Set { slot, .. } => {
                self.mended(slot);
            }
            Report::Picture(picture) => self.picture_came(picture),
            Report::Loading(what, part) => self.loading = Some((what, part)),
            Report::Loaded(scene) => self.loaded(scene),
            Report::LoadFailed(why) => {
                self.loading = None;
                self.event("load failed", json!({ "why": why }));
                self.trouble = Some(why);
            }
            Report::Texels(look, texels) => self.inspector.note(look, *texels, &self.wake),
            Report::Table(table, bytes) => self.tables.note(table, bytes),
            Report::Checks(slot, failed) => self.slots[slot].checks = failed,
            Report::Captured(result) => {
                let ok = result.is_ok();
                let text = match result {
                    Ok(path) => {
                        self.gallery.forget();
                        format!("captured {}", path.display())
                    }
                    Err(why) => format!("not captured: {why}"),
                };
                self.event("captured", json!({ "ok": ok, "text": text }));
                self.status = text;
            }
            Report::Judged(judged) => self.judged(judged),
            Report::Trouble(text) => {
                self.event("trouble", json!({ "text": text }));
                self.trouble = Some(text);
            }
        }
    }

    fn mended(&mut self, slot: usize) {
        if !self.slots[slot].errors.is_empty() {
            self.slots[slot].errors.clear();
            self.event("mended", json!({ "slot": slot }));
        }
    }

    fn picture_came(&mut self, picture: PictureReport) {
        if self.wish.slots[picture.slot].is_none() {
            return;
        }
        self.times.note(&picture);
        self.chart.note(&picture);
        let number = picture.slot;
        self.pixels.retain(|p| p.0 != number);
        self.pixels.push((number, picture.size, picture.bytes.clone()));
        if self.events.is_some() {
            let since = self.changed_at.map(|t| t.elapsed().as_secs_f64() * 1e3);
            let fields = json!({ "slot": number, "preview": picture.preview, "frame": picture.frame,
                "wish": picture.wish, "size": picture.size, "time": picture.time, "gpu_ms": picture.gpu_ms,
                "since_change_ms": since,
                "fingerprint": events::fingerprint(&picture.bytes) });
            self.event("picture", fields);
        }
        self.slots[number].picture = Some(picture);
    }

    fn loaded(&mut self, scene: Arc<Scene>) {
        self.loading = None;
        self.trouble = None;
        self.event("loaded", json!({ "scene": scene.name, "triangles": scene.triangle_count() }));
        let same = self.scene.as_ref().is_some_and(|s| s.name == scene.name) && self.wish.camera.is_some();
        if !std::mem::take(&mut self.returning) && (!same || self.experiment.is_some()) {
            let fallback =
                Experiment { camera: crate::experiment::CameraChoice::Named("default".into()), ..self.bare() };
            let experiment = self.experiment.take().unwrap_or(fallback);
            match keep::lights(&experiment, &scene) {
                Ok(lights) => self.wish.lights = lights,
                Err(e) => self.trouble = Some(e.to_string()),
            }
            match viewpoint_of(&experiment, &scene) {
                Ok(v) => self.wish.camera = Some(v.camera),
                Err(e) => {
                    self.trouble = Some(e.to_string());
                    self.wish.camera = Some(crate::lab::Viewpoint::around(&scene).camera);
                }
            }
        }
        let (low, high) = scene.bounds();
        self.diagonal = (high - low).length().max(1e-3);
        self.scene = Some(scene);
        self.tell();
    }

    /// The present experiment, as slot A shows it.
    fn bare(&self) -> Experiment {
        let slot = self.wish.slots[0].clone().unwrap_or_default();
        Experiment { name: self.name.clone(), ..self.wish.experiment(&slot) }
    }

    /// Works out the map of differences on a thread, one at a time.
    fn compare(&mut self) {
        let mode = self.view.mode;
        if !matches!(mode, Mode::Difference | Mode::Perceived) || self.comparing {
            return;
        }
        let shown = |s: &Slot| s.picture.as_ref().map(|p| Shown { size: p.size, bytes: p.bytes.clone() });
        let (Some(a), Some(b)) = (shown(&self.slots[0]), shown(&self.slots[1])) else { return };
        let of = (mode, self.view.gain, a.bytes.clone(), b.bytes.clone());
        let same =
            |o: &ComparisonOf| (o.0, o.1) == (of.0, of.1) && Arc::ptr_eq(&o.2, &of.2) && Arc::ptr_eq(&o.3, &of.3);
        if self.comparison_of.as_ref().is_some_and(same) {
            return;
        }
        self.comparison_of = Some(of);
        self.comparing = true;
        let (out, wake, gain) = (self.compared.0.clone(), self.wake.clone(), self.view.gain);
        std::thread::spawn(move || {
            let map = if mode == Mode::Difference { compare::difference(&a, &b, gain) } else { compare::flip(&a, &b) };
            let _ = out.send((mode, map));
            wake();
        });
    }

    fn comparison_text(&self) -> Option<String> {
        let (mode, map) = self.comparison.as_ref().filter(|(mode, _)| *mode == self.view.mode)?;
        let share = 100.0 * map.differing as f64 / f64::from((map.size[0] * map.size[1]).max(1));
        Some(match mode {
            Mode::Perceived => format!("mean FLIP {:.4}, largest {:.3}", map.mean, map.max),
            _ => format!("mean {:.3}/255, largest {}, {share:.1} % of pixels", map.mean, map.max),
        })
    }

    /// Whether the picture is older than the last good build or shows what no longer compiles.
    fn stale(&self) -> bool {
        self.slots.iter().any(|s| !s.errors.is_empty())
    }

    fn waiting_text(&self) -> String {
        match &self.loading {
            Some((what, part)) => format!("loading {what}: {:.0} %", 100.0 * part),
            None if self.device.is_none() => "opening the device".into(),
            None => "building the passes".into(),
        }
    }

    /// Sets the parameter that the graph names for clicks.
    fn point_at(&mut self, at: Option<Vec2>) {
        let Some(outline) = self.slots[0].outline.clone() else { return };
        let Some(name) = &outline.graph.pointer else { return };
        let Some(param) = outline.graph.params.list.iter().find(|p| p.name == *name) else { return };
        let at = at.map_or([-1.0; 2], |p| [f64::from(p.x.floor()), f64::from(p.y.floor())]);
        for slot in self.wish.slots.iter_mut().flatten() {
            edit::set(slot, param, &crate::graph::param::Value::Vector(at.to_vec()));
        }
    }

    /// Opens the tables, when what was clicked on fills one.
    fn show_tables(&mut self) {
        let fills = |o: &Arc<Outline>| o.graph.pointer.is_some() && !o.graph.tables.is_empty();
        if self.slots[0].outline.as_ref().is_some_and(fills) {
            self.tab = Tab::Tables;
        }
    }

    /// Tells the engine, if something is wished for that it does not know.
    fn tell(&mut self) {
        let mut wish = self.wish.clone();
        wish.number = self.told.number;
        if wish_differs(&wish, &self.told) {
            wish.number += 1;
            self.wish.number = wish.number;
            self.told = wish.clone();
            self.engine.wish(wish);
        }
    }

    /// Pixels that the host has not shown yet.
    pub fn pixels(&self) -> &[NewPixels] {
        &self.pixels
    }

    /// Revision of the files that the shown picture of A was made from.
    pub fn shown_revision(&self) -> u64 {
        self.shown_revision
    }

    /// The host has shown them.
    pub fn painted(&mut self) {
        if let Some(picture) = self.slots[0].picture.as_ref().filter(|_| self.pixels.iter().any(|p| p.0 == 0)) {
            self.shown_revision = picture.revision;
        }
        if !self.pixels.is_empty() {
            if self.events.is_none() {
                self.pixels.clear();
                return;
            }
            let list: Vec<usize> = self.pixels.iter().map(|p| p.0).collect();
            let prints: Vec<String> = self.pixels.iter().map(|p| events::fingerprint(&p.2)).collect();
            let since = self.changed_at.map(|t| t.elapsed().as_secs_f64() * 1e3);
            let wish = self.slots[0].picture.as_ref().map_or(0, |p| p.wish);
            self.event(
                "painted",
                json!({ "pictures": list, "fingerprints": prints, "wish": wish, "since_change_ms": since }),
            );
        }
        self.pixels.clear();
    }

    /// Tells where the widgets are, for scripts; `true` if there is more to tell.
    pub fn describe(&mut self, update: Option<&egui::accesskit::TreeUpdate>, scale: f32) -> bool {
        self.events.as_mut().is_some_and(|e| {
            e.place(self.view.place, scale);
            e.widgets(update, scale)
        })
    }

    /// Whether the widgets are to be described.
    pub fn is_described(&self) -> bool {
        self.events.is_some()
    }

    /// What went wrong last, if anything.
    pub fn trouble(&self) -> Option<&str> {
        self.trouble.as_deref()
    }

    /// Whether everything wished for is on screen.
    pub fn settled(&self) -> bool {
        let shown = |i: usize| {
            self.wish.slots[i].is_none()
                || self.slots[i]
                    .picture
                    .as_ref()
                    .is_some_and(|p| !p.preview && p.wish >= self.told.number && self.slots[i].outline.is_some())
        };
        shown(0) && shown(1) && self.loading.is_none() && !self.comparing && !self.chart_awaits()
    }

    /// The interface of one frame.
    pub fn ui(&mut self, ui: &mut Ui, textures: &[TextureId]) {
        self.shortcuts(ui);
        egui::Panel::top("bar").show(ui, |ui| self.bar(ui));
        egui::Panel::bottom("status").show(ui, |ui| self.status_line(ui));
        if self.has_messages() {
            egui::Panel::bottom("messages").resizable(true).show(ui, |ui| self.messages(ui));
        }
        egui::Panel::left("parameters")
            .default_size(340.0)
            .size_range(180.0..=640.0)
            .show(ui, |ui| self.parameters(ui));
        egui::Panel::right("right")
            .default_size(320.0)
            .size_range(180.0..=760.0)
            .show(ui, |ui| self.right(ui, textures));
        let inspecting = self.tab == Tab::Inspector && self.inspector.in_the_middle();
        egui::CentralPanel::no_frame().show(ui, |ui| match inspecting {
            true => self.inspected(ui, textures),
            false => self.picture(ui, textures),
        });
        if self.help {
            self.help_window(ui);
        }
        self.fit_size(ui);
        let held = ui.input(|i| i.pointer.any_down()) || ui.ctx().egui_wants_keyboard_input();
        self.remember(held);
        if self.wish.slots[1].is_none() {
            self.slots[1] = Slot::default();
            self.comparison_of = None;
        }
        self.compare();
        self.tell();
        self.ask_judge(ui);
    }

    /// The picture has the size of the middle, once that has stood still for a moment.
    fn fit_size(&mut self, ui: &Ui) {
        let size = self.fixed_size.unwrap_or((self.area[0].max(1), self.area[1].max(1)));
        if size == self.wish.size || size.0 < 2 || size.1 < 2 {
            self.resize_since = None;
            return;
        }
        let first = self.wish.size == (0, 0);
        let since = *self.resize_since.get_or_insert_with(Instant::now);
        let quiet = Duration::from_millis(120);
        if first || since.elapsed() >= quiet {
            self.wish.size = size;
            self.resize_since = None;
        } else {
            ui.ctx().request_repaint_after(quiet);
        }
    }

    fn parameters(&mut self, ui: &mut Ui) {
        // A panel that shrinks to what is in it stays small.
        ui.take_available_width();
        if self.wish.slots[1].is_some() {
            ui.horizontal(|ui| {
                ui.selectable_value(&mut self.panel_slot, 0, "A");
                ui.selectable_value(&mut self.panel_slot, 1, "B");
                if ui.small_button("A to B").clicked() {
                    self.wish.slots[1] = self.wish.slots[0].clone();
                }
                if ui.small_button("B to A").clicked() {
                    self.wish.slots[0] = self.wish.slots[1].clone();
                }
                if ui.small_button("swap").clicked() {
                    self.wish.slots.swap(0, 1);
                }
            });
        } else {
            self.panel_slot = 0;
        }
        let number = self.panel_slot;
        let outline = self.slots[number].outline.clone().or(self.slots[0].outline.clone());
        let Some(outline) = outline else {
            ui.weak(self.waiting_text());
            return;
        };
        let other = self.wish.slots[1 - number].clone();
        if let Some(slot) = &mut self.wish.slots[number] {
            self.panel.show(ui, &outline.graph.params, slot, other.as_ref());
        }
    }

    fn right(&mut self, ui: &mut Ui, textures: &[TextureId]) {
        ui.horizontal_wrapped(|ui| {
            for (tab, name) in [
                (Tab::Surroundings, "Scene"),
                (Tab::Times, "Time"),
                (Tab::Chart, "Chart"),
                (Tab::Inspector, "Inspect"),
                (Tab::Tables, "Tables"),
                (Tab::Paths, "Motion"),
                (Tab::Gallery, "Keep"),
            ] {
                ui.selectable_value(&mut self.tab, tab, name);
            }
        });
        ui.separator();
        // What is not looked at need not be made.
        (self.wish.look, self.wish.table) = (None, None);
        match self.tab {
            Tab::Surroundings => self.surroundings(ui),
            Tab::Times => self.times_tab(ui),
            Tab::Chart => self.chart_tab(ui),
            Tab::Inspector => self.inspector_tab(ui, textures),
            Tab::Tables => self.tables_tab(ui),
            Tab::Paths => self.paths_tab(ui),
            Tab::Gallery => self.gallery_tab(ui),
        }
    }

    fn shortcuts(&mut self, ui: &Ui) {
        let typing = ui.ctx().egui_wants_keyboard_input();
        for action in help::pressed(ui, typing) {
            match action {
                help::Action::Help => self.help = !self.help,
                help::Action::Undo => self.go(true),
                help::Action::Redo => self.go(false),
                help::Action::Play => self.wish.clock.playing = !self.wish.clock.playing,
                help::Action::Step => {
                    self.wish.clock.playing = false;
                    self.wish.clock.steps += 1;
                }
                help::Action::Flip => self.view.flipped = !self.view.flipped,
                help::Action::Unpoint => self.point_at(None),
                help::Action::Save => self.save(false),
                help::Action::Capture => self.capture(),
                help::Action::RenderDoc => self.engine.order(Order::RenderDoc),
            }
        }
    }

    /// Ends: waits a little for the frame in work. Returns the device's validation messages.
    pub fn close(self) -> Vec<String> {
        let mut messages = self.chart.close(Duration::from_secs(5));
        messages.extend(self.engine.stop(Duration::from_secs(20)));
        messages
    }
}

/// Whether two wishes differ in anything but their number.
fn wish_differs(a: &Wish, b: &Wish) -> bool {
    a.slots != b.slots
        || a.scene != b.scene
        || a.lights != b.lights
        || a.camera != b.camera
        || a.path != b.path
        || a.size != b.size
        || a.clock != b.clock
        || a.continuous != b.continuous
        || (a.revision, a.scene_revision) != (b.revision, b.scene_revision)
        || a.look != b.look
        || a.table != b.table
}

fn slot_of(experiment: &Experiment) -> SlotWish {
    SlotWish {
        graph: experiment.graph.clone(),
        params: experiment.params.iter().map(|(name, value)| (name.value.clone(), value.clone())).collect(),
    }
}

fn ron_files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut list: Vec<PathBuf> =
        entries.map(|e| e.path()).filter(|p| p.extension().is_some_and(|e| e == "ron") && p.is_file()).collect();
    list.sort();
    list
}

/// A path's stem; a name as it is.
fn short(spec: &str) -> String {
    Path::new(spec).file_stem().map_or_else(|| spec.to_string(), |s| s.to_string_lossy().into_owned())
}
