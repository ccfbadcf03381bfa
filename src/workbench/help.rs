//! Keys: one list makes them work and explains them.

use crate::workbench::panel::control::named;
use crate::workbench::tabs::TABS;
use crate::workbench::{Workbench, editor, theme};
use egui::{Align, Key, KeyboardShortcut, Modifiers, Ui};

/// The effect of a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    Help,
    Find,
    Undo,
    Redo,
    Play,
    Step,
    Compare,
    NextMode,
    Flip,
    Continuous,
    Timers,
    Unpoint,
    Save,
    Capture,
    RenderDoc,
    Panels,
    FullScreen,
    WholePicture,
    Open,
    Reload,
    /// Opens a tab, by its number.
    Tab(usize),
}

const NONE: Modifiers = Modifiers::NONE;

const CTRL: Modifiers = Modifiers::COMMAND;
const CTRL_SHIFT: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);

/// Keys of an action, the modifiers first; its heading in the list.
struct Shortcut {
    action: Action,
    keys: KeyboardShortcut,
    group: &'static str,
    about: &'static str,
}

const fn key(
    action: Action,
    (modifiers, key): (Modifiers, Key),
    group: &'static str,
    about: &'static str,
) -> Shortcut {
    let keys = KeyboardShortcut::new(modifiers, key);
    Shortcut {
        action,
        keys,
        group,
        about,
    }
}

const FILES: &str = "Files";
const EDIT: &str = "Edit";
const COMPARE: &str = "Compare";
const PICTURE: &str = "Picture";
const WINDOW: &str = "Window";
const TABS_GROUP: &str = "Tabs";
const CAMERA: &str = "Mouse and camera";

/// Headings, in order.
const GROUPS: [&str; 7] = [FILES, EDIT, COMPARE, PICTURE, CAMERA, WINDOW, TABS_GROUP];

const KEYS: [Shortcut; 22] = [
    key(
        Action::Open,
        (CTRL, Key::O),
        FILES,
        "Open a scene, a model or an experiment",
    ),
    key(
        Action::Save,
        (CTRL, Key::S),
        FILES,
        "Save the experiment under its name on the Save tab",
    ),
    key(
        Action::Capture,
        (NONE, Key::F12),
        FILES,
        "Capture the picture to captures/",
    ),
    key(
        Action::RenderDoc,
        (NONE, Key::F10),
        FILES,
        "Capture a frame with RenderDoc",
    ),
    key(
        Action::Reload,
        (NONE, Key::F5),
        FILES,
        "Reload graphs, shaders and the scene",
    ),
    key(
        Action::Reload,
        (CTRL, Key::R),
        FILES,
        "Reload graphs, shaders and the scene",
    ),
    key(
        Action::Undo,
        (CTRL, Key::Z),
        EDIT,
        "Undo: parameters, passes, lights, scene, opened file",
    ),
    key(Action::Redo, (CTRL_SHIFT, Key::Z), EDIT, "Redo"),
    key(Action::Redo, (CTRL, Key::Y), EDIT, "Redo"),
    key(Action::Find, (CTRL, Key::F), EDIT, "Search the parameters"),
    key(
        Action::Compare,
        (NONE, Key::B),
        COMPARE,
        "Start or end a comparison of A and B",
    ),
    key(
        Action::NextMode,
        (NONE, Key::M),
        COMPARE,
        "Next mode: split, toggle, side by side, difference, FLIP error",
    ),
    key(
        Action::Flip,
        (NONE, Key::X),
        COMPARE,
        "Show A or B, in the mode toggle",
    ),
    key(
        Action::Continuous,
        (NONE, Key::C),
        PICTURE,
        "Render continuously, or only when something changes",
    ),
    key(
        Action::Timers,
        (NONE, Key::T),
        PICTURE,
        "GPU times over the picture: stages, passes, none",
    ),
    key(
        Action::Play,
        (NONE, Key::Space),
        PICTURE,
        "Play or pause time",
    ),
    key(
        Action::Step,
        (NONE, Key::Period),
        PICTURE,
        "Advance time by one frame",
    ),
    key(
        Action::WholePicture,
        (NONE, Key::Home),
        PICTURE,
        "Show the whole picture after zooming",
    ),
    key(
        Action::Unpoint,
        (NONE, Key::Escape),
        PICTURE,
        "Close a menu or a dialog; else clear the probe",
    ),
    key(
        Action::Panels,
        (NONE, Key::H),
        WINDOW,
        "Hide or show the panels",
    ),
    key(Action::FullScreen, (NONE, Key::F11), WINDOW, "Full screen"),
    key(Action::Help, (NONE, Key::F1), WINDOW, "Show this help"),
];

const MOUSE: [(&str, &str); 8] = [
    ("Drag", "Orbit the target, or look around when flying"),
    ("Right drag", "Look around"),
    ("Middle drag", "Pan"),
    ("Wheel", "Zoom in and out (dolly)"),
    ("Ctrl wheel", "Zoom into the picture; the camera stays"),
    (
        "Ctrl drag",
        "Move the zoomed picture; a double click shows all of it",
    ),
    (
        "W A S D Q E",
        "Move, faster with Shift. The keys at these places of a US keyboard, whatever their letters",
    ),
    ("Click", "Probe a pixel, for example to draw its cones"),
];

/// Width of the column of keys, points.
const KEYS_WIDTH: f32 = 150.0;

/// Pages of the documentation.
const PAGES: [(&str, &str); 5] = [
    ("first-steps.md", "First steps"),
    ("workbench.md", "This window"),
    ("method.md", "The method and its parameters"),
    ("graph.md", "Graphs and shaders"),
    ("experiments.md", "Experiments, sweeps, references"),
];

const DIGITS: [Key; 9] = [
    Key::Num1,
    Key::Num2,
    Key::Num3,
    Key::Num4,
    Key::Num5,
    Key::Num6,
    Key::Num7,
    Key::Num8,
    Key::Num9,
];

/// All shortcuts: the list, and a digit for each tab.
fn shortcuts() -> impl Iterator<Item = (Action, KeyboardShortcut)> {
    let tabs = DIGITS.into_iter().zip(0..TABS.len());
    let tabs = tabs.map(|(key, tab)| (Action::Tab(tab), KeyboardShortcut::new(NONE, key)));
    KEYS.iter().map(|k| (k.action, k.keys)).chain(tabs)
}

/// Actions of pressed keys; keys without Ctrl do nothing while text is typed.
pub fn pressed(ui: &Ui, typing: bool) -> Vec<Action> {
    let allowed = |shortcut: &KeyboardShortcut| {
        !typing
            || shortcut.modifiers.any()
            || matches!(
                shortcut.logical_key,
                Key::F1 | Key::F5 | Key::F10 | Key::F11 | Key::F12
            )
    };
    let mut list: Vec<_> = shortcuts().filter(|k| allowed(&k.1)).collect();
    // Longer combinations first: Ctrl Z is also pressed when Ctrl Shift Z is.
    list.sort_by_key(|k| !k.1.modifiers.shift);
    list.into_iter()
        .filter(|k| ui.ctx().input_mut(|i| i.consume_shortcut(&k.1)))
        .map(|k| k.0)
        .collect()
}

/// Rows of a group: keys and effect.
fn rows(ui: &Ui, group: &str) -> Vec<(String, String)> {
    let format = |keys: &KeyboardShortcut| ui.ctx().format_shortcut(keys);
    let own = KEYS.iter().filter(|k| k.group == group);
    let mut rows: Vec<(String, String)> = Vec::new();
    for shortcut in own {
        let keys = format(&shortcut.keys);
        match rows.iter_mut().find(|row| row.1 == shortcut.about) {
            Some(row) => row.0 = format!("{}, {keys}", row.0),
            None => rows.push((keys, shortcut.about.into())),
        }
    }
    if group == CAMERA {
        let mouse = MOUSE.iter();
        rows.extend(mouse.map(|(keys, about)| (keys.to_string(), about.to_string())));
    }
    if group == TABS_GROUP {
        let tabs = (1..=DIGITS.len()).zip(&TABS);
        rows.extend(tabs.map(|(digit, tab)| (digit.to_string(), format!("Open {}", tab.title))));
    }
    rows
}

impl Workbench {
    /// The window of keys, over the picture and not over the parameters.
    pub(super) fn help_window(&mut self, ui: &mut Ui, place: egui::Rect) {
        let mut open = self.layout.help;
        let window = egui::Window::new("Help")
            .open(&mut open)
            .collapsible(false)
            .default_size([460.0, place.height() - 90.0])
            .default_pos(place.left_top() + egui::vec2(12.0, 12.0));
        window.show(ui.ctx(), |ui| self.help(ui));
        self.layout.help = open;
    }

    fn help(&mut self, ui: &mut Ui) {
        let search = &mut self.layout.help_search;
        let field = egui::TextEdit::singleline(search).hint_text("search");
        let field = ui.add(field.desired_width(f32::INFINITY));
        named(&field, egui::WidgetType::TextEdit, "search help");
        let needle = search.to_lowercase();
        let fits = |row: &(String, String)| {
            let text = format!("{} {}", row.0, row.1).to_lowercase();
            needle.split_whitespace().all(|word| text.contains(word))
        };
        ui.add_space(4.0);
        egui::ScrollArea::vertical().show(ui, |ui| {
            for group in GROUPS {
                let rows: Vec<_> = rows(ui, group).into_iter().filter(fits).collect();
                if rows.is_empty() {
                    continue;
                }
                ui.label(theme::title(group));
                for (keys, about) in &rows {
                    ui.horizontal_top(|ui| {
                        let left = egui::Layout::left_to_right(Align::Min);
                        let size = egui::vec2(KEYS_WIDTH, 0.0);
                        ui.allocate_ui_with_layout(size, left, |ui| {
                            ui.set_min_width(KEYS_WIDTH);
                            ui.monospace(keys);
                        });
                        ui.add(egui::Label::new(about).wrap());
                    });
                }
                ui.add_space(6.0);
            }
            ui.label(theme::title("Documentation"));
            let docs = self.setup.home.root.join("docs");
            for (page, about) in PAGES {
                let row = (page.to_string(), about.to_string());
                let file = docs.join(page);
                if !fits(&row) || !file.is_file() {
                    continue;
                }
                if ui.link(about).on_hover_text(page).clicked() {
                    self.opened(editor::show(&file));
                }
            }
            if !docs.is_dir() {
                ui.weak("The pages are in the folder docs of the repository");
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_actions_share_a_key_and_every_key_is_explained() {
        let all: Vec<_> = shortcuts().collect();
        for (i, (action, keys)) in all.iter().enumerate() {
            let others = all[i + 1..].iter().filter(|other| other.1 == *keys);
            assert_eq!(others.count(), 0, "{action:?}");
        }
        assert!(KEYS.iter().all(|k| GROUPS.contains(&k.group)));
        assert!(TABS.len() <= DIGITS.len());
    }

    #[test]
    fn the_pages_exist() {
        let docs = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("docs");
        for (page, _) in PAGES {
            assert!(docs.join(page).is_file(), "{page}");
        }
    }
}
