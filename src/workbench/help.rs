//! Keys: one list makes them work and explains them.

use super::Workbench;
use egui::{Key, KeyboardShortcut, Modifiers, Ui};

/// What a key does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    Help,
    Find,
    Undo,
    Redo,
    Play,
    Step,
    Flip,
    Unpoint,
    Save,
    Capture,
    RenderDoc,
}

/// Longer combinations first: Ctrl Z is also pressed when Ctrl Shift Z is.
const KEYS: [(Action, KeyboardShortcut, &str); 12] = [
    (Action::Help, KeyboardShortcut::new(Modifiers::NONE, Key::F1), "these keys"),
    (Action::Find, KeyboardShortcut::new(Modifiers::COMMAND, Key::F), "search the parameters"),
    (Action::Redo, KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z), "redo"),
    (Action::Undo, KeyboardShortcut::new(Modifiers::COMMAND, Key::Z), "undo the last edit of parameters or lights"),
    (Action::Redo, KeyboardShortcut::new(Modifiers::COMMAND, Key::Y), "redo"),
    (Action::Play, KeyboardShortcut::new(Modifiers::NONE, Key::Space), "play and pause time"),
    (Action::Step, KeyboardShortcut::new(Modifiers::NONE, Key::Period), "one frame on"),
    (Action::Flip, KeyboardShortcut::new(Modifiers::NONE, Key::X), "A or B, when comparing by flipping"),
    (Action::Unpoint, KeyboardShortcut::new(Modifiers::NONE, Key::Escape), "forget the point clicked on"),
    (
        Action::Save,
        KeyboardShortcut::new(Modifiers::COMMAND, Key::S),
        "save the experiment, under its name on the Save tab",
    ),
    (Action::Capture, KeyboardShortcut::new(Modifiers::NONE, Key::F12), "capture what is shown to captures/"),
    (Action::RenderDoc, KeyboardShortcut::new(Modifiers::NONE, Key::F11), "capture a frame with RenderDoc"),
];

const MOUSE: [(&str, &str); 6] = [
    ("drag", "turn around the target, or look around when flying"),
    ("right drag", "look around"),
    ("middle drag", "move sideways"),
    ("wheel", "nearer and farther"),
    ("W A S D Q E", "move; with Shift faster"),
    ("click", "show the cones of that point"),
];

/// Actions whose keys were pressed; keys without Ctrl do nothing while text is typed.
pub fn pressed(ui: &Ui, typing: bool) -> Vec<Action> {
    let allowed = |shortcut: &KeyboardShortcut| {
        !typing || shortcut.modifiers.any() || matches!(shortcut.logical_key, Key::F1 | Key::F11 | Key::F12)
    };
    let list = KEYS.iter().filter(|k| allowed(&k.1));
    list.filter(|k| ui.ctx().input_mut(|i| i.consume_shortcut(&k.1))).map(|k| k.0).collect()
}

impl Workbench {
    pub(super) fn help_window(&mut self, ui: &mut Ui) {
        let mut open = self.help;
        egui::Window::new("Keys").open(&mut open).collapsible(false).show(ui.ctx(), |ui| {
            egui::Grid::new("keys").striped(true).show(ui, |ui| {
                for (_, shortcut, text) in &KEYS {
                    ui.monospace(ui.ctx().format_shortcut(shortcut));
                    ui.label(*text);
                    ui.end_row();
                }
                for (mouse, text) in MOUSE {
                    ui.monospace(mouse);
                    ui.label(text);
                    ui.end_row();
                }
            });
        });
        self.help = open;
    }
}
