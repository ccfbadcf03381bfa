//! Files that the window opens: the models in the folders of CONELAB_SCENES, and any other by a
//! dialog.

use egui::Ui;
use egui_file_dialog::{DialogState, FileDialog};
use std::path::{Path, PathBuf};

use crate::scene::{SCENE_FILE, model_extensions};

/// The model files of a menu, and the dialog.
pub struct Models {
    /// Files found, once they were looked for.
    found: Option<Vec<(PathBuf, u64)>>,
    dialog: FileDialog,
    sky: FileDialog,
}

/// How deep folders are looked into, and the most files that are listed.
const DEEP: usize = 2;
const MOST: usize = 200;

const OPENED: &str = "Scenes, models, experiments";
const SKIES: &str = "HDRI (.hdr, .exr)";

impl Models {
    /// Begins with the dialog at a folder.
    pub fn new(folder: &Path) -> Models {
        let mut extensions: Vec<&str> = model_extensions().collect();
        extensions.push(SCENE_FILE);
        let dialog = FileDialog::new()
            .title("Open a scene, a model or an experiment")
            .initial_directory(folder.to_path_buf())
            .add_file_filter_extensions(OPENED, extensions)
            .default_file_filter(OPENED)
            .default_size([620.0, 360.0]);
        let sky = FileDialog::new()
            .id("sky")
            .title("Load an HDRI as the sky")
            .initial_directory(folder.to_path_buf())
            .add_file_filter_extensions(SKIES, vec!["hdr", "exr"])
            .default_file_filter(SKIES)
            .default_size([620.0, 360.0]);
        Models {
            found: None,
            dialog,
            sky,
        }
    }

    /// Shows the models; the one that was chosen.
    pub fn menu(&mut self, ui: &mut Ui) -> Option<String> {
        let mut chosen = None;
        let folders = std::env::var_os("CONELAB_SCENES").unwrap_or_default();
        let found = self.found.get_or_insert_with(|| {
            let mut list = Vec::new();
            std::env::split_paths(&folders).for_each(|folder| look(&folder, DEEP, &mut list));
            list.sort();
            list
        });
        if !found.is_empty() {
            ui.weak("models in CONELAB_SCENES");
            let list = egui::ScrollArea::vertical().max_height(200.0);
            list.show(ui, |ui| {
                for (path, bytes) in found {
                    let name = path.file_name().unwrap_or_default().to_string_lossy();
                    let about = path.display().to_string();
                    ui.horizontal(|ui| {
                        if ui.button(name).on_hover_text(&about).clicked() {
                            chosen = Some(about);
                        }
                        ui.weak(format!("{:.1} MB", *bytes as f64 / 1e6))
                            .on_hover_text("Size of the file without its textures");
                    });
                }
            });
        }
        let about =
            "Opens a scene, a model or an experiment. Files can also be dropped on the window";
        if ui.button("open file...").on_hover_text(about).clicked() {
            self.ask();
            ui.close();
        }
        if chosen.is_some() {
            // Files come and go.
            self.found = None;
        }
        chosen
    }

    /// Opens the dialog.
    pub fn ask(&mut self) {
        self.dialog.pick_file();
    }

    /// Whether the dialog is open.
    pub fn is_open(&self) -> bool {
        *self.dialog.state() == DialogState::Open
    }

    /// Shows the dialog, if it is open; the file that was picked.
    pub fn picked(&mut self, ui: &Ui) -> Option<PathBuf> {
        picked(&mut self.dialog, ui)
    }

    /// Opens the dialog for an HDRI.
    pub fn ask_sky(&mut self) {
        self.sky.pick_file();
    }

    /// Shows the dialog for an HDRI, if it is open; the file that was picked.
    pub fn picked_sky(&mut self, ui: &Ui) -> Option<PathBuf> {
        picked(&mut self.sky, ui)
    }
}

fn picked(dialog: &mut FileDialog, ui: &Ui) -> Option<PathBuf> {
    if *dialog.state() == DialogState::Closed {
        return None;
    }
    dialog.update(ui.ctx());
    dialog.take_picked()
}

/// Model files of a folder and those in it.
fn look(folder: &Path, deep: usize, list: &mut Vec<(PathBuf, u64)>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if list.len() >= MOST {
            return;
        }
        let ending = crate::files::ending(&path);
        if path.is_dir() {
            if deep > 0 {
                look(&path, deep - 1, list);
            }
        } else if model_extensions().any(|extension| extension == ending) {
            list.push((path, entry.metadata().map_or(0, |m| m.len())));
        }
    }
}
