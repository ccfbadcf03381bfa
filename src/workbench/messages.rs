//! Errors with place and source line over the lower edge of the picture, until they are mended.

use crate::diagnostics::{Diagnostic, Place, Severity};
use crate::workbench::engine::Order;
use crate::workbench::{Side, Workbench, editor};
use egui::{Align2, Rect, RichText, Ui};
use std::path::Path;

/// The end of a message after which the device has to be restarted.
const RESTART: &str = "Restart device";

/// Messages that belong to no file.
pub(super) struct Messages {
    /// The last one of the status line.
    pub status: String,
    pub trouble: Option<String>,
}

impl Workbench {
    fn has_messages(&self) -> bool {
        self.messages.trouble.is_some()
            || self.scene.warned
            || self
                .sides
                .iter()
                .any(|s| !s.errors.is_empty() || !s.checks.is_empty())
    }

    /// The messages over the lower edge of `place`: the picture under them keeps its place and
    /// size.
    pub(super) fn messages(&mut self, ui: &mut Ui, place: Rect) {
        if !self.has_messages() {
            return;
        }
        let area = egui::Area::new("messages".into())
            .pivot(Align2::LEFT_BOTTOM)
            .fixed_pos(place.left_bottom());
        area.constrain(false).show(ui.ctx(), |ui| {
            egui::Frame::side_top_panel(ui.style()).show(ui, |ui| {
                ui.set_width((place.width() - 16.0).max(40.0));
                let height = 160.0_f32.min(0.4 * ui.ctx().content_rect().height());
                let scroll = egui::ScrollArea::vertical()
                    .max_height(height)
                    .auto_shrink([false, true]);
                scroll.show(ui, |ui| self.message_rows(ui));
            });
        });
    }

    fn message_rows(&mut self, ui: &mut Ui) {
        self.trouble_row(ui);
        let sides = self.sides.iter().zip(["A", "B"]);
        let root = &self.setup.home.root;
        let open = sides.filter_map(|(side, name)| side_rows(ui, side, name, root));
        if let Some(place) = open.last() {
            self.open_editor(&place);
        }
        if self.scene.warned {
            self.scene_row(ui);
        }
    }

    /// A message that belongs to no file, above the others, which may need scrolling.
    fn trouble_row(&mut self, ui: &mut Ui) {
        let Some(trouble) = self.messages.trouble.clone() else {
            return;
        };
        ui.horizontal_wrapped(|ui| {
            ui.colored_label(ui.visuals().warn_fg_color, &trouble);
            let mut done = ui.small_button("dismiss").clicked();
            if trouble.contains(RESTART) && ui.small_button(RESTART).clicked() {
                self.engine.order(Order::Restart);
                done = true;
            }
            if done {
                self.messages.trouble = None;
            }
        });
    }

    pub(super) fn open_editor(&mut self, place: &Place) {
        let mut file = place.file.clone();
        if !file.is_absolute() && !file.exists() {
            file = self.setup.home.root.join(file);
        }
        let opened = editor::open(&file, place.line);
        let (Ok(text) | Err(text)) = &opened;
        self.event("editor", serde_json::json!({ "text": text }));
        self.opened(opened);
    }

    /// Shows the message of an opened file, or why it was not opened.
    pub(super) fn opened(&mut self, opened: Result<String, String>) {
        match opened {
            Ok(text) => self.messages.status = text,
            Err(text) => self.messages.trouble = Some(text),
        }
    }

    fn scene_row(&mut self, ui: &mut Ui) {
        let warnings = self.scene_warnings();
        let first = warnings.first().cloned().unwrap_or_default();
        let more = match warnings.len() {
            0 | 1 => String::new(),
            n => format!(" (and {} more on the Scene tab)", n - 1),
        };
        ui.horizontal_wrapped(|ui| {
            ui.colored_label(ui.visuals().warn_fg_color, format!("scene: {first}{more}"));
            let dismiss = ui.small_button("dismiss");
            let dismiss = dismiss.on_hover_text("The Scene tab keeps it");
            self.scene.warned = !dismiss.clicked();
        });
    }
}

/// The messages of a side, with paths relative to `root`. Returns the place that was clicked on.
fn side_rows(ui: &mut Ui, side: &Side, name: &str, root: &Path) -> Option<Place> {
    if !side.errors.is_empty() {
        let count = side.errors.len();
        let text = match count {
            1 => format!("1 error: {name} still shows the last good build"),
            n => format!("{n} errors: {name} still shows the last good build"),
        };
        ui.horizontal_wrapped(|ui| {
            ui.colored_label(ui.visuals().error_fg_color, text);
            let copy = ui.small_button("copy");
            if copy.on_hover_text("All of these messages").clicked() {
                let texts: Vec<String> = side.errors.iter().map(ToString::to_string).collect();
                ui.ctx().copy_text(texts.join("\n"));
            }
        });
    }
    let mut open = None;
    for error in &side.errors {
        if diagnostic(ui, error, root) {
            open = Some(error.place.clone());
        }
    }
    for check in &side.checks {
        ui.colored_label(ui.visuals().warn_fg_color, check);
    }
    open
}

/// Shows an error; whether its place was clicked on.
fn diagnostic(ui: &mut Ui, d: &Diagnostic, root: &Path) -> bool {
    let place = &d.place;
    let file = place.file.strip_prefix(root).unwrap_or(&place.file);
    let mut at = file.display().to_string();
    if place.line > 0 {
        at.push_str(&format!(":{}", place.line));
        if place.column > 0 {
            at.push_str(&format!(":{}", place.column));
        }
    }
    let colour = if d.severity == Severity::Error {
        ui.visuals().error_fg_color
    } else {
        ui.visuals().warn_fg_color
    };
    let text = RichText::new(format!("{at}: {}", d.message))
        .color(colour)
        .monospace();
    let mut clicked = false;
    if place.line > 0 {
        let label = ui.add(egui::Label::new(text).sense(egui::Sense::click()));
        clicked = label
            .on_hover_cursor(egui::CursorIcon::PointingHand)
            .on_hover_text(format!("Opens {} in the editor", place.file.display()))
            .clicked();
    } else {
        ui.label(text);
    }
    if let Some(source) = &d.source {
        ui.label(RichText::new(format!("    | {}", source.trim_end())).monospace());
    }
    if let Some(help) = &d.help {
        ui.weak(format!("    {help}"));
    }
    clicked
}
