//! Cameras kept by name, for each scene: camera paths of one key in `captures/cameras`.

use crate::camera_path::{self, CameraPath, Key};
use crate::experiment::{PlacedCamera, checked_name};
use crate::lab::{LabError, Viewpoint};
use crate::workbench::{Workbench, ron_files, short};
use egui::Ui;
use std::path::PathBuf;

/// State of this section.
#[derive(Default)]
pub struct Bookmarks {
    name: String,
    /// The folder and its files, as read last.
    known: Option<(PathBuf, Vec<PathBuf>)>,
    said: String,
}

impl Workbench {
    /// Buttons for the kept cameras of the scene, and a field to keep this one.
    pub(crate) fn bookmark_rows(&mut self, ui: &mut Ui) {
        let folder = self
            .setup
            .home
            .root
            .join("captures/cameras")
            .join(short(&self.desired.scene));
        let known = self.tabs.bookmarks.known.take().filter(|k| k.0 == folder);
        let files = known.map_or_else(|| ron_files(&folder), |k| k.1);
        let (mut go, mut remove) = (None, None);
        if !files.is_empty() {
            ui.horizontal_wrapped(|ui| {
                ui.label("kept:");
                for file in &files {
                    let button = ui.small_button(short(&file.to_string_lossy()));
                    let button = button.on_hover_text("Click: go there. Right click: remove");
                    if button.clicked() {
                        go = Some(file.clone());
                    }
                    if button.secondary_clicked() {
                        remove = Some(file.clone());
                    }
                }
            });
        }
        let mut keep = false;
        ui.horizontal(|ui| {
            let field = egui::TextEdit::singleline(&mut self.tabs.bookmarks.name)
                .hint_text("name")
                .desired_width(100.0);
            let field = ui.add(field);
            field.widget_info(|| {
                egui::WidgetInfo::labeled(egui::WidgetType::TextEdit, true, "camera name")
            });
            let enter = field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
            let named = !self.tabs.bookmarks.name.trim().is_empty();
            let button = ui.add_enabled(named, egui::Button::new("keep camera").small());
            keep = button
                .on_hover_text("Keeps this camera in captures/cameras")
                .clicked()
                || enter && named;
            ui.weak(&self.tabs.bookmarks.said);
        });
        self.tabs.bookmarks.known = Some((folder.clone(), files));
        if let Some(file) = go {
            self.go_to(&file);
        }
        if let Some(file) = remove {
            self.tabs.bookmarks.said = match std::fs::remove_file(&file) {
                Ok(()) => String::new(),
                Err(e) => format!("'{}' stays: {e}", file.display()),
            };
            self.tabs.bookmarks.known = None;
        }
        if keep {
            self.tabs.bookmarks.said = match self.keep_camera(&folder) {
                Ok(name) => format!("kept as {name}"),
                Err(e) => e.to_string(),
            };
            self.tabs.bookmarks.known = None;
        }
    }

    fn keep_camera(&mut self, folder: &std::path::Path) -> Result<String, LabError> {
        let name = checked_name(self.tabs.bookmarks.name.trim())?;
        let Some(camera) = &self.desired.camera else {
            return Err(LabError::Request("there is no camera yet".into()));
        };
        let mut path = CameraPath::default();
        camera_path::insert(&mut path, Key::new(0.0, &PlacedCamera::from(camera)))?;
        camera_path::write(&path, &folder.join(format!("{name}.ron")), false)?;
        self.tabs.bookmarks.name.clear();
        Ok(name)
    }

    fn go_to(&mut self, file: &std::path::Path) {
        let Some(scene) = &self.scene.loaded else {
            return;
        };
        match CameraPath::read(file) {
            Ok(path) => {
                if let Some(key) = path.keys.first() {
                    let placed = PlacedCamera {
                        up: key.up,
                        ..PlacedCamera::new(key.eye, key.target, key.fov_y)
                    };
                    self.desired.camera = Some(Viewpoint::placed(&placed, scene).camera);
                }
            }
            Err(errors) => {
                self.tabs.bookmarks.said = errors.first().map_or(String::new(), ToString::to_string)
            }
        }
    }
}
