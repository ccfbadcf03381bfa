//! Camera paths: keys recorded, edited, played, saved; and image sequences.

use super::Tab;
use super::sequence::Sequence;
use crate::camera_path::{self, CameraPath, Key};
use crate::experiment::{PlacedCamera, checked_name};
use crate::lab::{LabError, Viewpoint};
use crate::workbench::panel::control::{named, spin};
use crate::workbench::{Workbench, ron_files, short};
use egui::{DragValue, TextureId, Ui};
use std::path::PathBuf;

/// State of this tab.
pub struct Paths {
    /// The path as it is edited.
    pub path: CameraPath,
    name: String,
    /// Whether the camera follows the path.
    pub follow: bool,
    taken: bool,
    /// The answer to the last saving.
    said: String,
    play: Play,
    /// Image sequences.
    pub sequence: Sequence,
}

/// How far the time is on the path that the camera follows.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Play {
    Stopped,
    /// Sent back to the first key.
    Rewound,
    /// Before the last key.
    Running,
}

impl Default for Paths {
    fn default() -> Self {
        Paths {
            path: CameraPath::default(),
            name: "path".into(),
            follow: false,
            taken: false,
            said: String::new(),
            play: Play::Stopped,
            sequence: Sequence::default(),
        }
    }
}

impl Tab for Paths {
    const TITLE: &'static str = "Motion";
    const ICON: &'static str = egui_phosphor::regular::FILM_STRIP;

    fn show(workbench: &mut Workbench, ui: &mut Ui, _: &[TextureId]) {
        workbench.paths_tab(ui);
    }

    fn poll(workbench: &mut Workbench) {
        workbench.end_of_path();
        workbench.poll_sequence();
    }
}

impl Workbench {
    fn paths_tab(&mut self, ui: &mut Ui) {
        ui.strong("Camera path");
        self.path_files(ui);
        self.path_keys(ui);
        ui.separator();
        ui.strong("Image sequence");
        self.sequence_rows(ui);
    }

    fn path_files(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            ui.menu_button("open", |ui| self.path_menu(ui));
            let paths = &mut self.tabs.paths;
            let field = egui::TextEdit::singleline(&mut paths.name).desired_width(100.0);
            let field = ui.add(field);
            named(&field, egui::WidgetType::TextEdit, "path name");
            let enter = field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
            paths.taken &= !field.changed();
            let text = match paths.taken {
                true => "Overwrite",
                false => "save path",
            };
            let has_keys = !paths.path.keys.is_empty();
            let save = ui.add_enabled(has_keys, egui::Button::new(text));
            if save.clicked() || enter && has_keys {
                self.save_path();
            }
            ui.weak(&self.tabs.paths.said);
        });
    }

    fn path_menu(&mut self, ui: &mut Ui) {
        for file in ron_files(&self.setup.home.root.join("configs/paths")) {
            let name = short(&file.to_string_lossy());
            if !ui.button(&name).clicked() {
                continue;
            }
            match CameraPath::read(&file) {
                Ok(path) => {
                    let paths = &mut self.tabs.paths;
                    (paths.path, paths.name, paths.taken) = (path, name, false);
                    paths.said.clear();
                }
                Err(errors) => self.sides[0].errors = errors,
            }
            ui.close();
        }
    }

    /// Saves the path. An existing file is replaced only after a second click.
    fn save_path(&mut self) {
        let result = self.write_path();
        self.tabs.paths.taken = result.is_err();
        match result {
            Ok(file) => {
                let path = file.display().to_string();
                self.tabs.paths.name = short(&path);
                self.tabs.paths.said = format!("saved {path}");
                self.event("saved", serde_json::json!({ "path": path }));
            }
            Err(e) => self.tabs.paths.said = e.to_string(),
        }
    }

    fn write_path(&self) -> Result<PathBuf, LabError> {
        let paths = &self.tabs.paths;
        let folder = self.setup.home.root.join("configs/paths");
        let file = folder.join(format!("{}.ron", checked_name(&paths.name)?));
        camera_path::write(&paths.path, &file, paths.taken)?;
        Ok(file)
    }

    /// Plays the scene's time, and sets it.
    fn path_time(&mut self, ui: &mut Ui) {
        let mut now = self.shown_time();
        let last = self.tabs.paths.path.keys.last().map_or(0.0, |k| k.time);
        let clock = &mut self.desired.clock;
        ui.horizontal(|ui| {
            let text = if clock.playing { "pause" } else { "play" };
            let play = ui.button(text);
            named(&play, egui::WidgetType::Button, &format!("{text} path"));
            if play.on_hover_text("Space").clicked() {
                clock.playing = !clock.playing;
            }
            let end = if last > 0.0 { last } else { now.max(10.0) };
            let slider = egui::Slider::new(&mut now, 0.0..=end)
                .clamping(egui::SliderClamping::Never)
                .suffix(" s");
            let slider = ui.add(slider);
            named(&slider, egui::WidgetType::Slider, "time of the path");
            if slider.changed() {
                (clock.playing, clock.at) = (false, now);
                clock.jumps += 1;
            }
        });
    }

    /// Stops the time at the last key of a path that does not repeat. Played again, it starts at
    /// the first key.
    fn end_of_path(&mut self) {
        let keys = self.desired.path.as_ref().filter(|path| !path.repeat);
        let keys = keys.map_or(&[][..], |path| &path.keys);
        let (Some(first), Some(last)) = (keys.first(), keys.last()) else {
            return;
        };
        let (first, last) = (first.time, last.time);
        let (now, play) = (self.shown_time(), self.tabs.paths.play);
        let clock = &mut self.desired.clock;
        if !clock.playing || first == last {
            self.tabs.paths.play = Play::Stopped;
            return;
        }
        let (next, jump) = match play {
            _ if now < last => (Play::Running, None),
            Play::Running => (Play::Stopped, Some(last)),
            Play::Stopped => (Play::Rewound, Some(first)),
            Play::Rewound => (Play::Rewound, None),
        };
        self.tabs.paths.play = next;
        if let Some(time) = jump {
            (clock.playing, clock.at) = (next == Play::Rewound, time);
            clock.jumps += 1;
            self.send_request();
        }
    }

    fn path_keys(&mut self, ui: &mut Ui) {
        self.path_bar(ui);
        self.path_time(ui);
        let asked = key_rows(ui, &self.tabs.paths.path.keys);
        let paths = &mut self.tabs.paths;
        match asked {
            Some(Asked::Move(i, time)) => {
                if let Err(e) = camera_path::move_key(&mut paths.path, i, time) {
                    self.messages.status = e.to_string();
                }
            }
            Some(Asked::Remove(i)) => {
                camera_path::remove(&mut paths.path, i);
                paths.follow &= !paths.path.keys.is_empty();
            }
            Some(Asked::Go(key)) => self.go_to_key(&key),
            None => {}
        }
        let paths = &self.tabs.paths;
        let follows = paths.follow && !paths.path.keys.is_empty();
        self.desired.path = follows.then(|| paths.path.clone());
    }

    fn path_bar(&mut self, ui: &mut Ui) {
        let paths = &mut self.tabs.paths;
        ui.horizontal(|ui| {
            let add = ui
                .button("add key")
                .on_hover_text("Adds the current camera one second after the last key");
            if let Some(camera) = self.desired.camera.as_ref().filter(|_| add.clicked()) {
                let time = paths.path.keys.last().map_or(0.0, |k| k.time + 1.0);
                let key = Key::new(time, &PlacedCamera::from(camera));
                if let Err(e) = camera_path::insert(&mut paths.path, key) {
                    self.messages.status = e.to_string();
                }
            }
            let follow = egui::Checkbox::new(&mut paths.follow, "follow");
            ui.add_enabled(!paths.path.keys.is_empty(), follow)
                .on_hover_text("The camera follows the path in the scene's time; play starts it");
            ui.checkbox(&mut paths.path.repeat, "repeat");
        });
    }

    /// Moves the camera to a key of a path.
    pub(super) fn go_to_key(&mut self, key: &Key) {
        if let Some(scene) = &self.scene.loaded {
            let placed = PlacedCamera {
                up: key.up,
                ..PlacedCamera::new(key.eye, key.target, key.fov_y)
            };
            self.desired.camera = Some(Viewpoint::placed(&placed, scene).camera);
        }
    }
}

/// The action on a key.
enum Asked {
    Move(usize, f64),
    Remove(usize),
    Go(Key),
}

fn key_rows(ui: &mut Ui, keys: &[Key]) -> Option<Asked> {
    let mut asked = None;
    let rows = egui::ScrollArea::vertical().max_height(240.0);
    rows.show(ui, |ui| {
        for (i, key) in keys.iter().enumerate() {
            ui.horizontal(|ui| {
                let mut time = key.time;
                let field = DragValue::new(&mut time).speed(0.05).suffix(" s");
                if spin(ui, field, &format!("time of key {}", i + 1)).changed() {
                    asked = Some(Asked::Move(i, time));
                }
                let (x, y, z) = key.eye;
                ui.weak(format!("{x:.2} {y:.2} {z:.2}"));
                if ui.small_button("go").clicked() {
                    asked = Some(Asked::Go(*key));
                }
                if ui.small_button("remove").clicked() {
                    asked = Some(Asked::Remove(i));
                }
            });
        }
    });
    asked
}
