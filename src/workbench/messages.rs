//! Errors with the place and the source line, over the picture's foot; they go when they are mended.

use super::Workbench;
use super::engine::Order;
use crate::graph::source::{Diagnostic, Severity};
use egui::{Color32, RichText, Ui};

impl Workbench {
    pub(super) fn has_messages(&self) -> bool {
        self.trouble.is_some() || self.sides.iter().any(|s| !s.errors.is_empty() || !s.checks.is_empty())
    }

    pub(super) fn messages(&mut self, ui: &mut Ui) {
        let height = 160.0_f32.min(0.4 * ui.ctx().content_rect().height());
        egui::ScrollArea::vertical().max_height(height).auto_shrink([false, true]).show(ui, |ui| {
            for (side, name) in self.sides.iter().zip(["A", "B"]) {
                if !side.errors.is_empty() {
                    let count = side.errors.len();
                    ui.colored_label(RED, format!("{name} shows the last good picture: {count} to mend in the files"));
                }
                for error in &side.errors {
                    diagnostic(ui, error);
                }
                for check in &side.checks {
                    ui.colored_label(AMBER, check);
                }
            }
            let mut done = false;
            if let Some(trouble) = &self.trouble {
                ui.horizontal_wrapped(|ui| {
                    ui.colored_label(AMBER, trouble);
                    done = ui.small_button("dismiss").clicked();
                    if ui.small_button("Restart device").clicked() {
                        self.engine.order(Order::Restart);
                        done = true;
                    }
                });
            }
            if done {
                self.trouble = None;
            }
        });
    }
}

const RED: Color32 = Color32::from_rgb(255, 110, 90);
const AMBER: Color32 = Color32::from_rgb(255, 196, 84);

fn diagnostic(ui: &mut Ui, d: &Diagnostic) {
    let place = &d.place;
    let mut at = place.file.display().to_string();
    if place.line > 0 {
        at.push_str(&format!(":{}", place.line));
        if place.column > 0 {
            at.push_str(&format!(":{}", place.column));
        }
    }
    let colour = if d.severity == Severity::Error { RED } else { AMBER };
    ui.label(RichText::new(format!("{at}: {}", d.message)).color(colour).monospace());
    if let Some(source) = &d.source {
        ui.label(RichText::new(format!("    | {}", source.trim_end())).monospace());
    }
    if let Some(help) = &d.help {
        ui.weak(format!("    {help}"));
    }
}
