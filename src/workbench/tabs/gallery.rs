//! Saving experiments, captures, and the gallery of captures.

use super::Tab;
use crate::experiment::{Experiment, checked_name};
use crate::lab::LabError;
use crate::results::capture::{self, Summary};
use crate::workbench::background::Background;
use crate::workbench::desired::save;
use crate::workbench::engine::Order;
use crate::workbench::engine::report::Report;
use crate::workbench::{Workbench, short};
use egui::{ColorImage, TextureHandle, TextureId, Ui, Vec2};
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

    fn show(workbench: &mut Workbench, ui: &mut Ui, _: &[TextureId]) {
        workbench.gallery_tab(ui);
    }

    fn report(workbench: &mut Workbench, report: &Report) {
        if let Report::Captured(result) = report {
            workbench.captured(result);
        }
    }
}

/// Longest side of a thumbnail, pixels.
const THUMBNAIL: u32 = 160;

impl Workbench {
    fn gallery_tab(&mut self, ui: &mut Ui) {
        ui.strong("Experiment");
        self.save_row(ui);
        ui.separator();
        ui.strong("Capture");
        self.capture_rows(ui);
        ui.separator();
        ui.strong("Captures");
        self.gallery_rows(ui);
    }

    fn save_row(&mut self, ui: &mut Ui) {
        if self.tabs.gallery.name.is_empty() {
            self.tabs.gallery.name.clone_from(&self.experiment.name);
        }
        ui.horizontal(|ui| {
            let edit = egui::TextEdit::singleline(&mut self.tabs.gallery.name).desired_width(140.0);
            let field = ui
                .add(edit)
                .on_hover_text("Written to configs/NAME.ron, without values at their default");
            field.widget_info(|| {
                egui::WidgetInfo::labeled(egui::WidgetType::TextEdit, true, "experiment name")
            });
            if field.changed() {
                (self.tabs.gallery.taken, self.tabs.gallery.saved) = (None, None);
            }
            let again = self.tabs.gallery.taken.is_some();
            let text = match (again, self.desired.sides[1].is_some()) {
                (true, _) => "replace it",
                (false, false) => "save",
                // The side of the shown parameters.
                (false, true) => ["save A", "save B"][self.panel.side.min(1)],
            };
            if ui.button(text).on_hover_text("Ctrl S").clicked() {
                self.save(again);
            }
        });
        if let Some(taken) = &self.tabs.gallery.taken {
            ui.weak(format!(
                "configs/{taken}.ron exists; replacing keeps its comments"
            ));
        }
        said(
            ui,
            self.tabs
                .gallery
                .saved
                .as_ref()
                .filter(|_| self.tabs.gallery.taken.is_none()),
        );
    }

    /// Saves side A, or B if the panel shows it. An existing file is replaced only after a second
    /// click.
    pub(crate) fn save(&mut self, replace: bool) {
        if self.tabs.gallery.name.is_empty() {
            self.tabs.gallery.name.clone_from(&self.experiment.name);
        }
        let result = self.save_as(&self.tabs.gallery.name.clone(), replace);
        match result {
            Ok(path) => {
                self.experiment.name = short(&path.to_string_lossy());
                // The name as it was corrected.
                (self.tabs.gallery.taken, self.tabs.gallery.name) =
                    (None, self.experiment.name.clone());
                self.messages.status = format!("saved {}", path.display());
                self.tabs.gallery.saved = Some((true, self.messages.status.clone()));
                self.experiment.written = Some(path.clone());
                self.event(
                    "saved",
                    serde_json::json!({ "path": path.display().to_string() }),
                );
            }
            Err(e) => {
                let taken = checked_name(&self.tabs.gallery.name)
                    .ok()
                    .filter(|n| self.experiment_path(n).exists());
                self.tabs.gallery.taken = taken.filter(|_| !replace);
                self.messages.status = e.to_string();
                self.tabs.gallery.saved = Some((false, self.messages.status.clone()));
                self.event("not saved", serde_json::json!({ "why": e.to_string() }));
            }
        }
    }

    fn experiment_path(&self, name: &str) -> PathBuf {
        self.setup
            .home
            .root
            .join("configs")
            .join(format!("{name}.ron"))
    }

    fn save_as(&self, name: &str, replace: bool) -> Result<PathBuf, LabError> {
        let name = checked_name(name)?;
        if let Some(missing) = self.missing_scene() {
            return Err(LabError::Request(format!("not saved: {missing}")));
        }
        let side = self.desired.sides[self.panel.side]
            .as_ref()
            .or(self.desired.sides[0].as_ref());
        let info = self.sides[self.panel.side]
            .info
            .as_ref()
            .or(self.sides[0].info.as_ref());
        let (Some(side), Some(info)) = (side, info) else {
            return Err(LabError::Request(
                "there is nothing to save yet: no graph has been built".into(),
            ));
        };
        let time = self.sides[0]
            .picture
            .as_ref()
            .map_or(self.desired.clock.at, |p| p.time);
        let side = save::without_pointer(side, info.graph.pointer.as_deref());
        let experiment = save::experiment(
            &self.desired,
            &side,
            &name,
            time,
            self.scene.loaded.as_deref(),
        );
        let path = self.experiment_path(&name);
        crate::experiment::write(&experiment, &info.graph.params, &path, replace)?;
        Ok(path)
    }

    fn capture_rows(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            let edit = egui::TextEdit::singleline(&mut self.tabs.gallery.capture_name).hint_text(&self.experiment.name);
            let field = ui.add(edit.desired_width(140.0));
            field.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::TextEdit, true, "capture name"));
            let hover = "Renders afresh and keeps pictures, sources, settings and times in captures/NAME (F12)";
            if ui.button("capture").on_hover_text(hover).clicked() {
                self.capture();
            }
        });
        said(ui, self.tabs.gallery.captured.as_ref());
        let Some(info) = self.sides[0].info.clone() else {
            return;
        };
        egui::CollapsingHeader::new(format!("resources ({})", self.tabs.gallery.resources.len()))
            .show(ui, |ui| {
                ui.weak("kept as EXR next to the picture");
                for (name, _) in &info.graph.textures {
                    let mut chosen = self.tabs.gallery.resources.contains(name);
                    if ui.checkbox(&mut chosen, name).changed() {
                        self.tabs.gallery.resources.retain(|r| r != name);
                        if chosen {
                            self.tabs.gallery.resources.push(name.clone());
                        }
                    }
                }
            });
    }

    /// Captures the side that the panel shows.
    pub(crate) fn capture(&mut self) {
        let name = match self.tabs.gallery.capture_name.trim() {
            "" => self.experiment.name.clone(),
            name => name.to_string(),
        };
        let checked = checked_name(&name)
            .map_err(LabError::from)
            .and_then(|name| match self.missing_scene() {
                Some(missing) => Err(LabError::Request(format!("not captured: {missing}"))),
                None => Ok(name),
            });
        match checked {
            Ok(name) => {
                self.messages.status = format!("capturing {name}");
                if !self.tabs.gallery.capture_name.trim().is_empty() {
                    self.tabs.gallery.capture_name.clone_from(&name);
                }
                self.tabs.gallery.captured = Some((true, self.messages.status.clone()));
                self.engine.order(Order::Capture(
                    self.panel.side,
                    name,
                    self.tabs.gallery.resources.clone(),
                    self.view.timers,
                ));
            }
            Err(e) => {
                self.messages.status = e.to_string();
                self.tabs.gallery.captured = Some((false, self.messages.status.clone()));
                self.event(
                    "captured",
                    serde_json::json!({ "ok": false, "text": self.messages.status }),
                );
            }
        }
    }

    fn captured(&mut self, result: &Result<PathBuf, String>) {
        let ok = result.is_ok();
        let text = match result {
            Ok(path) => {
                self.tabs.gallery.captures = None;
                format!("captured {}", path.display())
            }
            Err(why) => format!("not captured: {why}"),
        };
        self.event("captured", serde_json::json!({ "ok": ok, "text": text }));
        self.tabs.gallery.captured = Some((ok, text.clone()));
        self.messages.status = text;
    }

    fn gallery_rows(&mut self, ui: &mut Ui) {
        let folder = self.setup.home.root.join("captures");
        while let Some((path, image)) = self.tabs.gallery.decoding.take() {
            let image = image.ok().flatten();
            let handle = image.map(|i| {
                ui.ctx()
                    .load_texture(path.to_string_lossy(), i, egui::TextureOptions::LINEAR)
            });
            self.tabs.gallery.thumbnails.insert(path, handle);
        }
        while let Some(((), text)) = self.tabs.gallery.replays.take() {
            let text = text.unwrap_or_else(|panic| panic);
            self.event("replayed", serde_json::json!({ "text": text }));
            self.tabs.gallery.replayed = text;
        }
        if ui.small_button("refresh").clicked() {
            self.tabs.gallery.captures = None;
        }
        let captures = self
            .tabs
            .gallery
            .captures
            .get_or_insert_with(|| capture::list(&folder))
            .clone();
        if captures.is_empty() {
            ui.weak("none yet");
        }
        if !self.tabs.gallery.replayed.is_empty() {
            ui.label(&self.tabs.gallery.replayed);
        }
        egui::ScrollArea::vertical()
            .auto_shrink(false)
            .show(ui, |ui| {
                for summary in captures {
                    ui.horizontal(|ui| {
                        self.thumbnail(ui, &summary);
                        ui.vertical(|ui| self.capture_row(ui, &summary));
                    });
                    ui.separator();
                }
            });
    }

    fn thumbnail(&mut self, ui: &mut Ui, summary: &Summary) {
        let size = Vec2::new(96.0, 54.0);
        let Some(path) = &summary.picture else {
            ui.allocate_space(size);
            return;
        };
        match self.tabs.gallery.thumbnails.get(path) {
            Some(Some(handle)) => {
                let image = egui::Image::from_texture((handle.id(), handle.size_vec2()));
                ui.add(image.max_size(size));
            }
            Some(None) => drop(ui.allocate_space(size)),
            None => {
                self.tabs.gallery.thumbnails.insert(path.clone(), None);
                let file = path.clone();
                self.tabs
                    .gallery
                    .decoding
                    .start(path.clone(), &self.setup.wake, move || small(&file));
                ui.allocate_space(size);
            }
        }
    }

    fn capture_row(&mut self, ui: &mut Ui, summary: &Summary) {
        ui.label(&summary.name);
        match &summary.manifest {
            Ok(m) => {
                ui.weak(format!(
                    "{} {}x{}",
                    short(&m.scene.name),
                    m.size[0],
                    m.size[1]
                ))
                .on_hover_text(format!(
                    "{}\n{} ({})\nconelab {}",
                    m.when, m.device, m.driver, m.version
                ));
                ui.horizontal(|ui| {
                    let name = &summary.name;
                    let load = ui
                        .small_button("load")
                        .on_hover_text("Its settings, with the shaders as they are now");
                    load.widget_info(|| {
                        egui::WidgetInfo::labeled(
                            egui::WidgetType::Button,
                            true,
                            format!("load {name}"),
                        )
                    });
                    if load.clicked() {
                        self.load_capture(summary, &m.graph);
                    }
                    let replay = ui
                        .small_button("replay")
                        .on_hover_text("Render it again from its own sources and compare");
                    replay.widget_info(|| {
                        egui::WidgetInfo::labeled(
                            egui::WidgetType::Button,
                            true,
                            format!("replay {name}"),
                        )
                    });
                    if replay.clicked() {
                        self.replay(&summary.folder);
                    }
                });
            }
            Err(why) => {
                ui.colored_label(egui::Color32::from_rgb(255, 110, 90), "damaged")
                    .on_hover_text(why);
            }
        }
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
        self.tabs
            .gallery
            .replays
            .start((), &self.setup.wake, move || {
                let run = || -> std::io::Result<String> {
                    let mut command = std::process::Command::new(std::env::current_exe()?);
                    command.arg("replay").arg(&folder);
                    if let Some(device) = device {
                        command.arg("--device").arg(device);
                    }
                    let output = command.output()?;
                    let text = [output.stdout, output.stderr].concat();
                    Ok(String::from_utf8_lossy(&text).into_owned())
                };
                let text = run().unwrap_or_else(|e| format!("cannot replay: {e}"));
                text.trim().to_string()
            });
    }
}

/// A result, next to the button that started it.
fn said(ui: &mut Ui, result: Option<&(bool, String)>) {
    match result {
        Some((true, text)) => drop(ui.weak(text)),
        Some((false, text)) => drop(ui.colored_label(crate::workbench::messages::RED, text)),
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
