//! Camera paths: keys recorded, edited, played, saved; and image sequences.

use super::Tab;
use super::sequence::Sequence;
use crate::camera_path::{self, CameraPath, Key};
use crate::experiment::{PlacedCamera, checked_name};
use crate::lab::{LabError, Viewpoint};
use crate::workbench::panel::control::spin;
use crate::workbench::{Workbench, ron_files, short};
use egui::{DragValue, Ui};
use std::path::PathBuf;

pub(crate) const TAB: Tab = Tab::new("Motion", |workbench, ui, _| workbench.paths_tab(ui));

/// State of this tab.
pub struct Paths {
    /// The path as it is edited.
    pub path: CameraPath,
    name: String,
    /// Whether the camera follows the path.
    pub follow: bool,
    taken: bool,
    /// Image sequences.
    pub sequence: Sequence,
}

impl Default for Paths {
    fn default() -> Self {
        Paths {
            path: CameraPath::default(),
            name: "path".into(),
            follow: false,
            taken: false,
            sequence: Sequence::default(),
        }
    }
}

impl Workbench {
    /// The tab.
    pub(crate) fn paths_tab(&mut self, ui: &mut Ui) {
        ui.strong("Camera path");
        self.path_files(ui);
        self.path_keys(ui);
        ui.separator();
        ui.strong("Image sequence");
        self.sequence_rows(ui);
    }

    fn path_files(&mut self, ui: &mut Ui) {
        let folder = self.setup.home.root.join("configs/paths");
        ui.horizontal(|ui| {
            ui.menu_button("open", |ui| {
                for file in ron_files(&folder) {
                    if ui.button(short(&file.to_string_lossy())).clicked() {
                        match CameraPath::read(&file) {
                            Ok(path) => {
                                self.tabs.paths.path = path;
                                self.tabs.paths.name = short(&file.to_string_lossy());
                                self.tabs.paths.taken = false;
                            }
                            Err(errors) => self.sides[0].errors = errors,
                        }
                        ui.close();
                    }
                }
            });
            let edit =
                ui.add(egui::TextEdit::singleline(&mut self.tabs.paths.name).desired_width(100.0));
            edit.widget_info(|| {
                egui::WidgetInfo::labeled(egui::WidgetType::TextEdit, true, "path name")
            });
            if edit.changed() {
                self.tabs.paths.taken = false;
            }
            let text = if self.tabs.paths.taken {
                "replace it"
            } else {
                "save path"
            };
            if ui
                .add_enabled(
                    !self.tabs.paths.path.keys.is_empty(),
                    egui::Button::new(text),
                )
                .clicked()
            {
                match self.save_path(self.tabs.paths.taken) {
                    Ok(file) => {
                        self.messages.status = format!("saved {}", file.display());
                        self.event(
                            "saved",
                            serde_json::json!({ "path": file.display().to_string() }),
                        );
                        self.tabs.paths.taken = false;
                    }
                    Err(e) => {
                        self.tabs.paths.taken = true;
                        self.messages.status = e.to_string();
                    }
                }
            }
        });
    }

    fn path_file(&self) -> Result<PathBuf, LabError> {
        Ok(self
            .setup
            .home
            .root
            .join("configs/paths")
            .join(format!("{}.ron", checked_name(&self.tabs.paths.name)?)))
    }

    fn save_path(&self, replace: bool) -> Result<PathBuf, LabError> {
        let file = self.path_file()?;
        camera_path::write(&self.tabs.paths.path, &file, replace)?;
        Ok(file)
    }

    fn path_keys(&mut self, ui: &mut Ui) {
        let now = self.sides[0].picture.as_ref().map_or(0.0, |p| p.time);
        ui.horizontal(|ui| {
            let add = ui
                .button("add key")
                .on_hover_text("The camera as it stands now, a second after the last key");
            if let Some(camera) = self.desired.camera.as_ref().filter(|_| add.clicked()) {
                let time = self
                    .tabs
                    .paths
                    .path
                    .keys
                    .last()
                    .map_or(0.0, |k| k.time + 1.0);
                let key = Key::new(time, &PlacedCamera::from(camera));
                if let Err(e) = camera_path::insert(&mut self.tabs.paths.path, key) {
                    self.messages.status = e.to_string();
                }
            }
            let can = !self.tabs.paths.path.keys.is_empty();
            let follow = ui.add_enabled(
                can,
                egui::Checkbox::new(&mut self.tabs.paths.follow, "follow"),
            );
            follow.on_hover_text("The camera follows the path in the scene's time; play starts it");
            ui.checkbox(&mut self.tabs.paths.path.repeat, "repeat");
            ui.weak(format!("{now:.2} s"));
        });
        let mut remove = None;
        let mut moved = None;
        let mut go = None;
        egui::ScrollArea::vertical()
            .max_height(240.0)
            .show(ui, |ui| {
                for (i, key) in self.tabs.paths.path.keys.iter().enumerate() {
                    ui.horizontal(|ui| {
                        let mut time = key.time;
                        let field = DragValue::new(&mut time).speed(0.05).suffix(" s");
                        if spin(ui, field, &format!("time of key {}", i + 1)).changed() {
                            moved = Some((i, time));
                        }
                        let (x, y, z) = key.eye;
                        ui.weak(format!("{x:.2} {y:.2} {z:.2}"));
                        if ui.small_button("go").clicked() {
                            go = Some(*key);
                        }
                        if ui.small_button("remove").clicked() {
                            remove = Some(i);
                        }
                    });
                }
            });
        if let Some((i, time)) = moved
            && let Err(e) = camera_path::move_key(&mut self.tabs.paths.path, i, time)
        {
            self.messages.status = e.to_string();
        }
        if let Some(i) = remove {
            camera_path::remove(&mut self.tabs.paths.path, i);
            self.tabs.paths.follow &= !self.tabs.paths.path.keys.is_empty();
        }
        if let (Some(key), Some(scene)) = (go, &self.scene.loaded) {
            let placed = PlacedCamera {
                up: key.up,
                ..PlacedCamera::new(key.eye, key.target, key.fov_y)
            };
            self.desired.camera = Some(Viewpoint::placed(&placed, scene).camera);
        }
        self.desired.path = (self.tabs.paths.follow && !self.tabs.paths.path.keys.is_empty())
            .then(|| self.tabs.paths.path.clone());
    }
}
