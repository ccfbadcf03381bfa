//! The panel of parameters, and the effect of keys.

use crate::workbench::desired::request::SideRequest;
use crate::workbench::engine::Order;
use crate::workbench::picture::zoom;
use crate::workbench::tabs::TABS;
use crate::workbench::{Workbench, dock, help, panel, watch};
use egui::Ui;
use std::time::Instant;

/// What of the window is shown, and how large.
pub(super) struct Layout {
    pub help: bool,
    /// Text that the rows of the help contain.
    pub help_search: String,
    /// Whether the panels at the sides are hidden.
    pub hidden: bool,
    pub full_screen: bool,
    /// The area of the picture [pixels of the screen].
    pub area: [u32; 2],
    /// Size of pictures that do not follow the area.
    pub fixed_size: Option<(u32, u32)>,
    pub resize_since: Option<Instant>,
    /// Whether the window asks about unsaved changes before it closes.
    pub asks_close: bool,
    /// Title and sides of the graph's comparison that was chosen last.
    pub compared: Option<(String, [Option<SideRequest>; 2])>,
    /// The window's title, as last set.
    pub title: String,
}

impl Layout {
    pub fn new(fixed_size: Option<(u32, u32)>) -> Layout {
        Layout {
            help: false,
            help_search: String::new(),
            hidden: false,
            full_screen: false,
            area: [0, 0],
            fixed_size,
            resize_since: None,
            asks_close: false,
            compared: None,
            title: String::new(),
        }
    }
}

impl Workbench {
    pub(super) fn parameters(&mut self, ui: &mut Ui) {
        // A panel that shrinks to its content stays small.
        ui.take_available_width();
        if self.desired.sides[1].is_some() {
            ui.horizontal_wrapped(|ui| {
                ui.selectable_value(&mut self.panel.side, 0, "A");
                ui.selectable_value(&mut self.panel.side, 1, "B");
                if ui.small_button("Copy A to B").clicked() {
                    self.desired.sides[1] = self.desired.sides[0].clone();
                }
                if ui.small_button("Copy B to A").clicked() {
                    self.desired.sides[0] = self.desired.sides[1].clone();
                }
                if ui.small_button("Swap").clicked() {
                    self.desired.sides.swap(0, 1);
                }
            });
        } else {
            self.panel.side = 0;
        }
        let number = self.panel.side;
        let info = self.sides[number].info.as_ref();
        let Some(info) = info.or(self.sides[0].info.as_ref()).cloned() else {
            ui.weak(self.waiting_text());
            return;
        };
        let other = self.desired.sides[1 - number].clone();
        if let Some(side) = &mut self.desired.sides[number] {
            let found = (self.effects.of(number), self.effects.is_old(number));
            let before = side.graph.clone();
            let name = ["B", "A"][number.min(1)];
            let other = other.as_ref().map(|other| (name, other));
            let baseline = self.experiment.baseline.as_ref();
            let file = baseline.filter(|_| number == 0).map(|b| &b.side);
            self.panel.show(ui, &info.graph, side, other, found, file);
            if side.graph != before {
                let side = side.clone();
                self.desired.sides[number] = Some(self.with_graph(&side, &side.graph));
            }
        }
    }

    pub(super) fn shortcuts(&mut self, ui: &Ui) {
        // Menus and dialogs take the keys.
        let dialog = self.layout.asks_close || self.scene.models.is_open();
        if dialog || egui::Popup::is_any_open(ui.ctx()) {
            return;
        }
        let typing = ui.ctx().egui_wants_keyboard_input();
        for action in help::pressed(ui, typing) {
            match action {
                help::Action::Find => {
                    self.layout.hidden = false;
                    panel::Panel::find(ui);
                }
                help::Action::Open => self.scene.models.ask(),
                help::Action::Reload => self.files_changed(&watch::Changed::all()),
                help::Action::Help => self.layout.help = !self.layout.help,
                help::Action::Undo => self.go(true),
                help::Action::Redo => self.go(false),
                help::Action::Play => self.desired.clock.playing = !self.desired.clock.playing,
                help::Action::Step => {
                    self.desired.clock.playing = false;
                    self.desired.clock.steps += 1;
                }
                help::Action::Timers => self.view.timers = self.view.timers.next(),
                help::Action::Flip => self.view.flipped = !self.view.flipped,
                help::Action::Unpoint if std::mem::take(&mut self.panel.typing) => {
                    self.panel.search.clear()
                }
                help::Action::Unpoint => match self.layout.help {
                    true => self.layout.help = false,
                    false => self.point_at(None),
                },
                help::Action::Compare => self.toggle_comparison(),
                help::Action::NextMode => self.view.mode = self.view.mode.next(),
                help::Action::Continuous => self.desired.continuous = !self.desired.continuous,
                help::Action::Tab(number) => {
                    self.layout.hidden = false;
                    self.dock.open(dock::Pane::Tab(TABS[number].title.into()));
                }
                help::Action::Save => self.save(false),
                help::Action::Capture => self.capture(),
                help::Action::Panels => self.layout.hidden = !self.layout.hidden,
                help::Action::FullScreen => {
                    self.layout.full_screen = !self.layout.full_screen;
                    ui.ctx()
                        .send_viewport_cmd(egui::ViewportCommand::Fullscreen(
                            self.layout.full_screen,
                        ));
                }
                help::Action::WholePicture => self.view.zoom = zoom::Zoom::default(),
                help::Action::RenderDoc => self.engine.order(Order::RenderDoc),
            }
        }
    }
}

/// A press of the mouse elsewhere takes the keys away from a text field: a drag on a slider would
/// leave them there, and with them what Ctrl Z means.
pub(super) fn release_focus(ui: &Ui) {
    let Some(focused) = ui.ctx().memory(egui::Memory::focused) else {
        return;
    };
    let pressed = ui.input(|i| {
        if i.pointer.any_pressed() {
            i.pointer.interact_pos()
        } else {
            None
        }
    });
    let rect = ui.ctx().read_response(focused).map(|r| r.rect);
    if let (Some(at), Some(rect)) = (pressed, rect)
        && !rect.contains(at)
    {
        ui.ctx().memory_mut(|m| m.surrender_focus(focused));
    }
}
