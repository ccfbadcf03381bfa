//! Values and failed checks that shaders record (`shaders/common/debug.glsl`).

use crate::graph::{Debug, DebugRow};
use crate::workbench::Workbench;
use crate::workbench::engine::report::GraphInfo;
use crate::workbench::read_back::ReadBack;
use egui::Ui;

impl Workbench {
    /// A switch to the values, where a pass that runs records any, and the values; whether they are
    /// shown.
    pub(super) fn shader_values(&mut self, ui: &mut Ui, info: &GraphInfo) -> bool {
        if !Debug::is_recorded(&info.linked, &info.passes) {
            return false;
        }
        let tables = &mut self.tabs.tables;
        tables.shows_values |= info.graph.tables.is_empty();
        ui.horizontal(|ui| {
            let about = "Values of show and failures of check (common/debug.glsl)";
            ui.selectable_value(&mut tables.shows_values, true, "Shader values")
                .on_hover_text(about);
            if !info.graph.tables.is_empty() {
                ui.selectable_value(&mut tables.shows_values, false, "Tables");
            }
        });
        if !tables.shows_values {
            return false;
        }
        self.desired.read_back.push(ReadBack::Debug);
        let Some(debug) = self.tabs.tables.values.take() else {
            ui.weak("…");
            return true;
        };
        egui::ScrollArea::vertical()
            .auto_shrink(false)
            .show(ui, |ui| {
                self.value_rows(ui, "values", &debug.values);
                if debug.lost > 0 {
                    let text = format!("{} more values do not fit", debug.lost);
                    ui.colored_label(ui.visuals().warn_fg_color, text);
                }
                if debug.values.is_empty() {
                    ui.weak("No values: click on the picture");
                }
                ui.add_space(8.0);
                match debug.failed.is_empty() {
                    true => drop(ui.weak("No check failed")),
                    false => self.value_rows(ui, "failed checks", &debug.failed),
                }
            });
        self.tabs.tables.values = Some(debug);
        true
    }

    fn value_rows(&mut self, ui: &mut Ui, title: &str, rows: &[DebugRow]) {
        if rows.is_empty() {
            return;
        }
        ui.strong(title);
        for row in rows {
            ui.horizontal_wrapped(|ui| {
                ui.label(format!("{}:", row.name));
                ui.monospace(&row.value);
            });
            ui.horizontal_wrapped(|ui| {
                ui.add_space(12.0);
                ui.weak(&row.pass);
                self.editor_link(ui, &row.file, row.line);
            });
        }
    }
}
