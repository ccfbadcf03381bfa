//! Keys: one list makes them work and explains them.

use crate::workbench::Workbench;
use egui::{Key, KeyboardShortcut, Modifiers, Ui};

/// The effect of a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    Help,
    Find,
    Undo,
    Redo,
    Play,
    Step,
    Flip,
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
}

const NONE: Modifiers = Modifiers::NONE;

const CTRL: Modifiers = Modifiers::COMMAND;
const CTRL_SHIFT: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);

type Shortcut = (Action, KeyboardShortcut, &'static str);

const fn key(action: Action, modifiers: Modifiers, key: Key, about: &'static str) -> Shortcut {
    (action, KeyboardShortcut::new(modifiers, key), about)
}

/// In the order in which they are explained.
const KEYS: [Shortcut; 19] = [
    key(Action::Help, NONE, Key::F1, "these keys"),
    key(
        Action::Undo,
        CTRL,
        Key::Z,
        "undo the last edit: parameters, passes, lights, scene, opened file",
    ),
    key(Action::Redo, CTRL_SHIFT, Key::Z, "redo"),
    key(Action::Redo, CTRL, Key::Y, "redo"),
    key(
        Action::Open,
        CTRL,
        Key::O,
        "open a scene, a model or an experiment",
    ),
    key(Action::Find, CTRL, Key::F, "search the parameters"),
    key(
        Action::Reload,
        NONE,
        Key::F5,
        "read graphs, shaders and the scene again",
    ),
    key(Action::Reload, CTRL, Key::R, "the same"),
    key(
        Action::Save,
        CTRL,
        Key::S,
        "save the experiment, under its name on the Save tab",
    ),
    key(
        Action::Capture,
        NONE,
        Key::F12,
        "capture the picture to captures/",
    ),
    key(Action::Panels, NONE, Key::H, "hide and show the panels"),
    key(Action::FullScreen, NONE, Key::F11, "full screen"),
    key(
        Action::WholePicture,
        NONE,
        Key::Home,
        "the whole picture again, after zooming",
    ),
    key(
        Action::Timers,
        NONE,
        Key::T,
        "times on the picture: stages, passes, none",
    ),
    key(
        Action::Flip,
        NONE,
        Key::X,
        "A or B, when comparing by flipping",
    ),
    key(Action::Unpoint, NONE, Key::Escape, "clear the probe"),
    key(Action::Play, NONE, Key::Space, "play and pause time"),
    key(Action::Step, NONE, Key::Period, "one frame on"),
    key(
        Action::RenderDoc,
        NONE,
        Key::F10,
        "capture a frame with RenderDoc",
    ),
];

const MOUSE: [(&str, &str); 8] = [
    ("drag", "orbit the target, or look around when flying"),
    ("right drag", "look around"),
    ("middle drag", "pan"),
    ("wheel", "zoom in and out (dolly)"),
    ("Ctrl wheel", "zoom into the picture; the camera stays"),
    (
        "Ctrl drag",
        "move the picture when zoomed; a double click shows all of it",
    ),
    ("W A S D Q E", "move; with Shift faster"),
    ("click", "probe a pixel, for example to draw its cones"),
];

const BUTTONS: [(&str, &str); 5] = [
    (
        "A | B",
        "two experiments side by side; each has its parameters, picked at the left",
    ),
    ("Profiler", "GPU and CPU time per frame and pass, memory"),
    (
        "Chart",
        "error against the path-traced reference, over time; it can be gathered there",
    ),
    ("Graph", "the passes; with and without one of them"),
    ("Inspect", "any texture of the graph, any slice of a volume"),
];

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
    let mut list: Vec<_> = KEYS.iter().filter(|k| allowed(&k.1)).collect();
    // Longer combinations first: Ctrl Z is also pressed when Ctrl Shift Z is.
    list.sort_by_key(|k| !k.1.modifiers.shift);
    list.into_iter()
        .filter(|k| ui.ctx().input_mut(|i| i.consume_shortcut(&k.1)))
        .map(|k| k.0)
        .collect()
}

impl Workbench {
    /// The window of keys, over the picture and not over the parameters.
    pub(super) fn help_window(&mut self, ui: &mut Ui, place: egui::Rect) {
        let mut open = self.layout.help;
        let window = egui::Window::new("Help")
            .open(&mut open)
            .collapsible(false)
            .resizable(false);
        window.default_pos(place.left_top() + egui::vec2(12.0, 12.0)).show(ui.ctx(), |ui| {
            egui::Grid::new("keys").striped(true).show(ui, |ui| {
                for (_, shortcut, text) in &KEYS {
                    ui.monospace(ui.ctx().format_shortcut(shortcut));
                    ui.label(*text);
                    ui.end_row();
                }
                for (mouse, text) in MOUSE.into_iter().chain(BUTTONS) {
                    ui.monospace(mouse);
                    ui.label(text);
                    ui.end_row();
                }
            });
            ui.separator();
            let docs = self.setup.home.root.join("docs");
            let pages = "workbench.md: this window; method.md: the method and its parameters; graph.md: graphs; tour.md: a tour";
            ui.horizontal_wrapped(|ui| {
                ui.label(format!("More in {}.", docs.display())).on_hover_text(pages);
                ui.weak(pages);
            });
        });
        self.layout.help = open;
    }
}
