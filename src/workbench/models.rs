//! Model files in the scene menu: those in the folders of CONELAB_SCENES, and a field for the path of any other.

use egui::{Key, TextEdit, Ui};
use std::path::{Path, PathBuf};

/// State of this part of the menu.
#[derive(Default)]
pub struct Models {
    /// Files found, once they were looked for.
    found: Option<Vec<PathBuf>>,
    path: String,
    /// What the path may go on as.
    completions: Option<(String, Vec<String>)>,
}

/// How deep folders are looked into, and the most files that are listed.
const DEEP: usize = 2;
const MOST: usize = 200;

impl Models {
    /// Shows the models; the one that was chosen.
    pub fn menu(&mut self, ui: &mut Ui) -> Option<String> {
        let mut chosen = None;
        let folders = std::env::var("CONELAB_SCENES").unwrap_or_default();
        let found = self.found.get_or_insert_with(|| {
            let mut list = Vec::new();
            folders.split(':').filter(|f| !f.is_empty()).for_each(|f| look(Path::new(f), DEEP, &mut list));
            list.sort();
            list
        });
        if !found.is_empty() {
            ui.weak("models in CONELAB_SCENES");
            egui::ScrollArea::vertical().max_height(200.0).show(ui, |ui| {
                for path in found {
                    let name = path.file_name().map_or(String::new(), |n| n.to_string_lossy().into_owned());
                    if ui.button(name).on_hover_text(path.display().to_string()).clicked() {
                        chosen = Some(path.to_string_lossy().into_owned());
                    }
                }
            });
        }
        let field =
            ui.add(TextEdit::singleline(&mut self.path).hint_text("path of a scene or model").desired_width(240.0));
        field.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::TextEdit, true, "path of a model"));
        if field.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter)) && is_scene(Path::new(self.path.trim())) {
            chosen = Some(self.path.trim().to_string());
        }
        if self.completions.as_ref().is_none_or(|c| c.0 != self.path) {
            self.completions = Some((self.path.clone(), completions(&self.path)));
        }
        for text in self.completions.iter().flat_map(|c| c.1.clone()) {
            if ui.small_button(&text).clicked() {
                if is_scene(Path::new(&text)) {
                    chosen = Some(text.clone());
                }
                self.path = text;
                field.request_focus();
            }
        }
        if chosen.is_some() {
            // Files come and go.
            self.found = None;
        }
        chosen
    }
}

/// Whether a file may hold a scene.
fn is_scene(path: &Path) -> bool {
    let ending = path.extension().map_or(String::new(), |e| e.to_string_lossy().to_lowercase());
    ["gltf", "glb", "obj", "ron"].contains(&ending.as_str()) && path.is_file()
}

fn look(folder: &Path, deep: usize, list: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if list.len() >= MOST {
            return;
        }
        if path.is_dir() {
            if deep > 0 {
                look(&path, deep - 1, list);
            }
        } else if is_scene(&path) && path.extension().is_some_and(|e| e != "ron") {
            list.push(path);
        }
    }
}

/// Folders and scenes that a path may go on as; nothing before something was typed.
fn completions(text: &str) -> Vec<String> {
    let (folder, begin) = match text.rsplit_once('/') {
        Some((folder, begin)) => (format!("{folder}/"), begin),
        None if text.is_empty() => return Vec::new(),
        None => (String::new(), text),
    };
    let place = if folder.is_empty() { Path::new(".") } else { Path::new(&folder) };
    let mut list: Vec<String> = std::fs::read_dir(place)
        .into_iter()
        .flatten()
        .flatten()
        .filter_map(|entry| {
            let name = entry.file_name().to_string_lossy().into_owned();
            let fits = name.starts_with(begin) && !name.starts_with('.') && name != begin;
            let path = entry.path();
            let end = if path.is_dir() { "/" } else { "" };
            (fits && (path.is_dir() || is_scene(&path))).then(|| format!("{folder}{name}{end}"))
        })
        .collect();
    list.sort();
    list.truncate(8);
    list
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_go_on_as_folders_and_scenes() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir_all(folder.path().join("models/deep")).unwrap();
        for file in ["models/a.obj", "models/b.txt", "models/deep/c.glb"] {
            std::fs::write(folder.path().join(file), "").unwrap();
        }
        let start = format!("{}/models/", folder.path().display());
        assert_eq!(completions(&start), [format!("{start}a.obj"), format!("{start}deep/")]);
        assert_eq!(completions(&format!("{start}d")), [format!("{start}deep/")]);
        let mut list = Vec::new();
        look(folder.path(), DEEP, &mut list);
        list.sort();
        assert_eq!(list, ["models/a.obj", "models/deep/c.glb"].map(|f| folder.path().join(f)));
    }
}
