//! Cameras kept by name, for each scene: camera paths of one key in `captures/cameras`.

use crate::camera_path::{self, CameraPath, Key};
use crate::experiment::{PlacedCamera, checked_name};
use crate::lab::LabError;
use crate::workbench::panel::control::named;
use crate::workbench::{Workbench, ron_files, short};
use egui::{Ui, WidgetType};
use std::path::{Path, PathBuf};

/// State of this section.
#[derive(Default)]
pub struct Bookmarks {
    name: String,
    /// The folder and its files, as read last.
    known: Option<(PathBuf, Vec<PathBuf>)>,
    said: String,
}

/// The button that was clicked.
enum Asked {
    Go(PathBuf),
    Remove(PathBuf),
    Keep,
}

impl Bookmarks {
    fn rows(&mut self, ui: &mut Ui, folder: PathBuf) -> Option<Asked> {
        let mut asked = None;
        let known = self.known.take().filter(|k| k.0 == folder);
        let files = known.map_or_else(|| ron_files(&folder), |k| k.1);
        if !files.is_empty() {
            ui.horizontal_wrapped(|ui| {
                ui.label("Bookmarks:");
                for file in &files {
                    let button = ui.small_button(short(&file.to_string_lossy()));
                    let button =
                        button.on_hover_text("Click: use this camera. Right click: remove");
                    if button.clicked() {
                        asked = Some(Asked::Go(file.clone()));
                    }
                    if button.secondary_clicked() {
                        asked = Some(Asked::Remove(file.clone()));
                    }
                }
            });
        }
        self.known = Some((folder, files));
        ui.horizontal(|ui| {
            let field = egui::TextEdit::singleline(&mut self.name).hint_text("name");
            let field = ui.add(field.desired_width(100.0));
            named(&field, WidgetType::TextEdit, "camera name");
            let enter = field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
            let is_named = !self.name.trim().is_empty();
            let button = ui.add_enabled(is_named, egui::Button::new("add bookmark").small());
            let button = button.on_hover_text("Saves this camera in captures/cameras");
            if button.clicked() || enter && is_named {
                asked = Some(Asked::Keep);
            }
            ui.weak(&self.said);
        });
        asked
    }
}

impl Workbench {
    /// Buttons for the kept cameras of the scene, and a field to keep this one.
    pub(super) fn bookmark_rows(&mut self, ui: &mut Ui) {
        let cameras = self.setup.home.captures.join("cameras");
        let folder = cameras.join(short(&self.desired.scene));
        let bookmarks = &mut self.tabs.surroundings.bookmarks;
        match bookmarks.rows(ui, folder.clone()) {
            Some(Asked::Go(file)) => self.go_to(&file),
            Some(Asked::Remove(file)) => {
                bookmarks.said = match std::fs::remove_file(&file) {
                    Ok(()) => String::new(),
                    Err(e) => format!("cannot remove '{}': {e}", file.display()),
                };
                bookmarks.known = None;
            }
            Some(Asked::Keep) => {
                let said = match self.keep_camera(&folder) {
                    Ok(name) => format!("saved as {name}"),
                    Err(e) => e.to_string(),
                };
                let bookmarks = &mut self.tabs.surroundings.bookmarks;
                (bookmarks.said, bookmarks.known) = (said, None);
            }
            None => {}
        }
    }

    fn keep_camera(&mut self, folder: &Path) -> Result<String, LabError> {
        let name = checked_name(self.tabs.surroundings.bookmarks.name.trim())?;
        let Some(camera) = &self.desired.camera else {
            return Err(LabError::Request("there is no camera yet".into()));
        };
        let mut path = CameraPath::default();
        camera_path::insert(&mut path, Key::new(0.0, &PlacedCamera::from(camera)))?;
        camera_path::write(&path, &folder.join(format!("{name}.ron")), false)?;
        self.tabs.surroundings.bookmarks.name.clear();
        Ok(name)
    }

    fn go_to(&mut self, file: &Path) {
        match CameraPath::read(file) {
            Ok(path) => {
                if let Some(key) = path.keys.first() {
                    self.go_to_key(key);
                }
            }
            Err(errors) => {
                let text = errors.first().map_or(String::new(), ToString::to_string);
                self.tabs.surroundings.bookmarks.said = text;
            }
        }
    }
}
