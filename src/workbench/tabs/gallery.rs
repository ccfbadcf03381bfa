//! Saving experiments, captures, and the gallery of captures.

use super::Tab;
use crate::experiment::{Experiment, checked_name};
use crate::lab::LabError;
use crate::results::capture::{self, Summary};
use crate::workbench::background::Background;
use crate::workbench::desired::save;
use crate::workbench::engine::Order;
use crate::workbench::engine::report::Report;
use crate::workbench::panel::control::{named, small_button};
use crate::workbench::{Workbench, short};
use egui::{ColorImage, TextureHandle, TextureId, Ui, Vec2, WidgetType};
use serde_json::json;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// State of this tab.
#[derive(Default)]
pub struct Gallery {
    name: String,
    /// A name that is taken, waiting for a second click.
    taken: Option<String>,
    /// How saving and capturing ended: whether all is well, and in words.
    saved: Option<(bool, String)>,
    captured: Option<(bool, String)>,
    /// Whether the engine is making a capture.
    capturing: bool,
    capture_name: String,
    resources: Vec<String>,
    captures: Option<Vec<Summary>>,
    thumbnails: HashMap<PathBuf, Option<TextureHandle>>,
    /// Small pictures by file, if it can be read.
    decoding: Background<PathBuf, Option<ColorImage>>,
    replays: Background<(), String>,
    replayed: String,
}

impl Tab for Gallery {
    const TITLE: &'static str = "Save";
    const ICON: &'static str = egui_phosphor::regular::FLOPPY_DISK;

    fn show(workbench: &mut Workbench, ui: &mut Ui, _: &[TextureId]) {
        workbench.gallery_tab(ui);
    }

    fn report(workbench: &mut Workbench, report: &Report) {
        match report {
            Report::Captured(result) => workbench.captured(result),
            // A new device has no capture in work.
            Report::Device(_) => workbench.tabs.gallery.capturing = false,
            _ => {}
        }
    }

    fn awaits(workbench: &Workbench) -> bool {
        let gallery = &workbench.tabs.gallery;
        gallery.capturing || gallery.replays.is_working()
    }
}

/// Longest side of a thumbnail, pixels.
const THUMBNAIL: u32 = 160;

impl Workbench {
    fn gallery_tab(&mut self, ui: &mut Ui) {
        // One area for all: in a low pane a list of its own would have no height left.
        let area = egui::ScrollArea::vertical().auto_shrink(false);
        area.show(ui, |ui| {
            ui.strong("Experiment");
            self.save_row(ui);
            ui.separator();
            ui.strong("Capture");
            self.capture_rows(ui);
            ui.separator();
            ui.strong("Captures");
            self.gallery_rows(ui);
        });
    }

    fn save_row(&mut self, ui: &mut Ui) {
        self.name_experiment();
        let gallery = &mut self.tabs.gallery;
        let again = gallery.taken.is_some();
        let text = match (again, self.desired.sides[1].is_some()) {
            (true, _) => "Overwrite",
            (false, false) => "save",
            // The side of the shown parameters.
            (false, true) => ["save A", "save B"][self.panel.side.min(1)],
        };
        let about = "Written to configs/NAME.ron, without values at their default";
        let mut save = false;
        ui.horizontal(|ui| {
            let field = egui::TextEdit::singleline(&mut gallery.name).desired_width(140.0);
            let field = ui.add(field).on_hover_text(about);
            named(&field, WidgetType::TextEdit, "experiment name");
            if field.changed() {
                (gallery.taken, gallery.saved) = (None, None);
            }
            let enter = field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
            save = ui.button(text).on_hover_text("Enter or Ctrl S").clicked() || enter;
        });
        if save {
            self.save(again);
        }
        let gallery = &self.tabs.gallery;
        match &gallery.taken {
            Some(taken) => drop(ui.weak(format!(
                "configs/{taken}.ron exists. Overwriting keeps its comments"
            ))),
            None => said(ui, gallery.saved.as_ref()),
        }
    }

    fn name_experiment(&mut self) {
        if self.tabs.gallery.name.is_empty() {
            self.tabs.gallery.name.clone_from(&self.experiment.name);
        }
    }

    /// Saves side A, or B if the panel shows it. An existing file is replaced only after a second
    /// click.
    pub(crate) fn save(&mut self, replace: bool) {
        self.name_experiment();
        let result = self.save_as(&self.tabs.gallery.name, replace);
        let ok = result.is_ok();
        match result {
            Ok(path) => {
                let file = path.display().to_string();
                self.experiment.name = short(&file);
                self.messages.status = format!("saved {file}");
                self.event("saved", json!({ "path": file }));
                // The name as it was corrected.
                self.tabs.gallery.name.clone_from(&self.experiment.name);
                self.tabs.gallery.taken = None;
                self.opened_file(&path);
                self.session.file.clone_from(&path);
                self.saved_state();
                self.experiment.written = Some(path);
            }
            Err(e) => {
                let taken = checked_name(&self.tabs.gallery.name).ok();
                let taken = taken.filter(|n| !replace && self.experiment_path(n).exists());
                self.tabs.gallery.taken = taken;
                self.messages.status = e.to_string();
                self.event("not saved", json!({ "why": self.messages.status }));
            }
        }
        self.tabs.gallery.saved = Some((ok, self.messages.status.clone()));
    }

    fn experiment_path(&self, name: &str) -> PathBuf {
        let configs = self.setup.home.root.join("configs");
        configs.join(format!("{name}.ron"))
    }

    fn save_as(&self, name: &str, replace: bool) -> Result<PathBuf, LabError> {
        let name = checked_name(name)?;
        if let Some(missing) = self.missing_scene() {
            return Err(LabError::Request(format!("not saved: {missing}")));
        }
        let number = self.panel.side;
        let [a, b] = &self.desired.sides;
        let side = [a, b][number].as_ref().or(a.as_ref());
        let info = self.sides[number].info.as_ref();
        let info = info.or(self.sides[0].info.as_ref());
        let (Some(side), Some(info)) = (side, info) else {
            return Err(LabError::Request(
                "there is nothing to save yet: no graph has been built".into(),
            ));
        };
        let side = save::without_cursors(side, Some(&info.graph));
        let (time, scene) = (self.shown_time(), self.scene.loaded.as_deref());
        let experiment = save::experiment(&self.desired, &side, &name, time, scene);
        let path = self.experiment_path(&name);
        crate::experiment::write(&experiment, &info.graph.params, &path, replace)?;
        Ok(path)
    }

    fn capture_rows(&mut self, ui: &mut Ui) {
        let about =
            "Renders again and saves pictures, sources, settings and times in captures/NAME (F12)";
        ui.horizontal(|ui| {
            let name = &mut self.tabs.gallery.capture_name;
            let field = egui::TextEdit::singleline(name).hint_text(&self.experiment.name);
            let field = ui.add(field.desired_width(140.0));
            named(&field, WidgetType::TextEdit, "capture name");
            if ui.button("capture").on_hover_text(about).clicked() {
                self.capture();
            }
        });
        said(ui, self.tabs.gallery.captured.as_ref());
        let Some(info) = &self.sides[0].info else {
            return;
        };
        let resources = &mut self.tabs.gallery.resources;
        let title = format!("Also save textures ({})", resources.len());
        let header = egui::CollapsingHeader::new(title).id_salt("textures");
        header.show(ui, |ui| {
            ui.weak("Saved as EXR next to the picture");
            for (name, _) in &info.graph.textures {
                let mut chosen = resources.contains(name);
                if ui.checkbox(&mut chosen, name).changed() {
                    resources.retain(|r| r != name);
                    resources.extend(chosen.then(|| name.clone()));
                }
            }
        });
    }

    /// Captures the side that the panel shows.
    pub(crate) fn capture(&mut self) {
        let gallery = &self.tabs.gallery;
        let is_named = !gallery.capture_name.trim().is_empty();
        let name = match is_named {
            true => gallery.capture_name.trim(),
            false => &self.experiment.name,
        };
        let name = checked_name(name).map_err(LabError::from);
        let name = name.and_then(|name| match self.missing_scene() {
            Some(missing) => Err(LabError::Request(format!("not captured: {missing}"))),
            None => Ok(name),
        });
        let ok = name.is_ok();
        match name {
            Ok(name) => {
                self.messages.status = format!("capturing {name}");
                if is_named {
                    self.tabs.gallery.capture_name.clone_from(&name);
                }
                self.tabs.gallery.capturing = true;
                let resources = self.tabs.gallery.resources.clone();
                let (side, timers) = (self.panel.side, self.view.timers);
                self.engine
                    .order(Order::Capture(side, name, resources, timers));
            }
            Err(e) => {
                self.messages.status = e.to_string();
                let fields = json!({ "ok": false, "text": self.messages.status });
                self.event("captured", fields);
            }
        }
        self.tabs.gallery.captured = Some((ok, self.messages.status.clone()));
    }

    fn captured(&mut self, result: &Result<PathBuf, String>) {
        let (ok, text) = match result {
            Ok(path) => {
                let path = path.strip_prefix(&self.setup.home.root).unwrap_or(path);
                (true, format!("captured {}", path.display()))
            }
            Err(why) => (false, format!("not captured: {why}")),
        };
        self.tabs.gallery.capturing = false;
        if ok {
            self.tabs.gallery.captures = None;
        }
        self.event("captured", json!({ "ok": ok, "text": text }));
        self.tabs.gallery.captured = Some((ok, text.clone()));
        self.messages.status = text;
    }

    fn gallery_rows(&mut self, ui: &mut Ui) {
        let folder = self.setup.home.captures.clone();
        let gallery = &mut self.tabs.gallery;
        while let Some((path, image)) = gallery.decoding.take() {
            let (name, linear) = (path.to_string_lossy(), egui::TextureOptions::LINEAR);
            let image = image.ok().flatten();
            let handle = image.map(|i| ui.ctx().load_texture(name, i, linear));
            gallery.thumbnails.insert(path, handle);
        }
        while let Some(((), text)) = self.tabs.gallery.replays.take() {
            let text = text.unwrap_or_else(|panic| panic);
            self.event("replayed", json!({ "text": text }));
            self.tabs.gallery.replayed = text;
        }
        let gallery = &mut self.tabs.gallery;
        if ui.small_button("refresh").clicked() {
            gallery.captures = None;
        }
        let captures = gallery
            .captures
            .get_or_insert_with(|| capture::list(&folder));
        let captures = captures.clone();
        if captures.is_empty() {
            ui.weak("none yet");
        }
        if !gallery.replayed.is_empty() {
            ui.label(&gallery.replayed);
        }
        for summary in captures {
            ui.horizontal(|ui| {
                self.thumbnail(ui, &summary);
                ui.vertical(|ui| self.capture_row(ui, &summary));
            });
            ui.separator();
        }
    }

    fn thumbnail(&mut self, ui: &mut Ui, summary: &Summary) {
        let size = Vec2::new(96.0, 54.0);
        let Some(path) = &summary.picture else {
            ui.allocate_space(size);
            return;
        };
        let gallery = &mut self.tabs.gallery;
        match gallery.thumbnails.get(path) {
            Some(Some(handle)) => {
                let image = egui::Image::from_texture((handle.id(), handle.size_vec2()));
                ui.add(image.max_size(size));
            }
            Some(None) => drop(ui.allocate_space(size)),
            None => {
                gallery.thumbnails.insert(path.clone(), None);
                let file = path.clone();
                let decode = move || small(&file);
                gallery
                    .decoding
                    .start(path.clone(), &self.setup.wake, decode);
                ui.allocate_space(size);
            }
        }
    }

    fn capture_row(&mut self, ui: &mut Ui, summary: &Summary) {
        let name = &summary.name;
        ui.label(name);
        let m = match &summary.manifest {
            Ok(manifest) => manifest,
            Err(why) => {
                return drop(
                    ui.colored_label(ui.visuals().error_fg_color, "damaged")
                        .on_hover_text(why),
                );
            }
        };
        let [w, h] = m.size;
        ui.weak(format!("{} {w}x{h}", short(&m.scene.name)))
            .on_hover_text(format!(
                "{}\n{} ({})\nconelab {}",
                m.when, m.device, m.driver, m.version
            ));
        ui.horizontal(|ui| {
            let about = "Loads its settings. Shaders stay as they are now";
            if small_button(ui, "load", &format!("load {name}"), about) {
                self.load_capture(summary, &m.graph);
            }
            let about = "Renders it again from its own sources and compares every texel";
            if small_button(ui, "replay", &format!("replay {name}"), about) {
                self.replay(&summary.folder);
            }
        });
    }

    fn load_capture(&mut self, summary: &Summary, graph: &str) {
        match Experiment::read(&summary.folder.join("experiment.ron")) {
            Ok(mut experiment) => {
                let own = self.setup.home.root.join("passes").join(graph);
                if own.is_file() {
                    experiment.graph = graph.to_string();
                }
                experiment.name.clone_from(&summary.name);
                self.open(&experiment);
                self.messages.status = format!("loaded {}", summary.name);
            }
            Err(errors) => self.sides[0].errors = errors,
        }
    }

    /// Replays by the program's own command, in a process of its own.
    fn replay(&mut self, folder: &Path) {
        self.tabs.gallery.replayed = "replaying".into();
        let folder = folder.to_path_buf();
        let device = self.device.as_ref().map(|d| d.name.clone());
        let run = move || -> std::io::Result<String> {
            let mut command = std::process::Command::new(std::env::current_exe()?);
            command.arg("replay").arg(&folder);
            if let Some(device) = device {
                command.arg("--device").arg(device);
            }
            let output = command.output()?;
            let text = [output.stdout, output.stderr].concat();
            Ok(String::from_utf8_lossy(&text).trim().to_string())
        };
        let replays = &mut self.tabs.gallery.replays;
        replays.start((), &self.setup.wake, move || {
            run().unwrap_or_else(|e| format!("cannot replay: {e}"))
        });
    }
}

/// A result, next to the button that started it.
fn said(ui: &mut Ui, result: Option<&(bool, String)>) {
    match result {
        Some((true, text)) => drop(ui.weak(text)),
        Some((false, text)) => drop(ui.colored_label(ui.visuals().error_fg_color, text)),
        None => {}
    }
}

/// A picture in thumbnail size; nothing if it cannot be read.
fn small(path: &Path) -> Option<ColorImage> {
    let mut reader = image::ImageReader::open(path).ok()?;
    let mut limits = image::Limits::default();
    limits.max_alloc = Some(1 << 30);
    reader.limits(limits);
    let image = reader
        .decode()
        .ok()?
        .thumbnail(THUMBNAIL, THUMBNAIL)
        .to_rgba8();
    let size = [image.width() as usize, image.height() as usize];
    Some(ColorImage::from_rgba_unmultiplied(size, &image))
}
