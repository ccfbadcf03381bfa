//! The options of a run before it starts.

use super::plan::{Kind, Plan, joined, read_values, suggested};
use crate::graph::param::Param;
use crate::workbench::Workbench;
use crate::workbench::desired::edit;
use crate::workbench::panel::control::{named, spin};
use egui::{Button, DragValue, Ui, WidgetType};

/// Largest picture and number of frames.
const MAX_SIZE: u32 = 8192;
const MAX_FRAMES: usize = 10_000;

impl Workbench {
    /// Suggests values of a parameter for a sweep.
    pub(super) fn suggest_values(&mut self, name: &str) {
        let side = self.panel.side;
        let info = self.sides[side].info.clone();
        let (Some(info), Some(side)) = (info, &self.desired.sides[side]) else {
            return;
        };
        let runs = &mut self.tabs.runs;
        name.clone_into(&mut runs.plan.param);
        if let Some(param) = info.graph.params.param(name) {
            runs.values = joined(param, &suggested(param, &edit::value(side, param)));
        }
    }

    /// The options, and the button that starts.
    pub(super) fn form(&mut self, ui: &mut Ui) {
        let plan = &mut self.tabs.runs.plan;
        if plan.size.0 == 0 {
            plan.size = self.desired.size;
        }
        ui.horizontal_wrapped(|ui| {
            for kind in Kind::ALL {
                ui.selectable_value(&mut plan.kind, kind, kind.title());
            }
        });
        ui.weak(plan.kind.about());
        let ready = plan.kind != Kind::Sweep || self.sweep_rows(ui);
        numbers(ui, &mut self.tabs.runs.plan);
        let idle = self.tabs.runs.running.is_none();
        let start = ui.add_enabled(ready && idle, Button::new("Start"));
        let about = "Measures the experiment as it is now, in the background";
        if start.on_hover_text(about).clicked() {
            self.start_run();
        }
    }

    /// Parameter and values of a sweep. Returns whether it can start.
    fn sweep_rows(&mut self, ui: &mut Ui) -> bool {
        let Some(info) = self.sides[self.panel.side].info.clone() else {
            return false;
        };
        let params = &info.graph.params;
        let mut chosen = None;
        ui.horizontal(|ui| {
            ui.label("Parameter");
            let now = self.tabs.runs.plan.param.as_str();
            let text = if now.is_empty() { "choose" } else { now };
            let menu = egui::ComboBox::from_id_salt("swept parameter").selected_text(text);
            let menu = menu.show_ui(ui, |ui| {
                for param in params.offered() {
                    if ui
                        .selectable_label(param.name == now, &param.name)
                        .clicked()
                    {
                        chosen = Some(param.name.clone());
                    }
                }
            });
            named(&menu.response, WidgetType::ComboBox, "swept parameter");
        });
        if let Some(name) = chosen {
            self.suggest_values(&name);
        }
        let runs = &mut self.tabs.runs;
        let Some(param) = params.param(&runs.plan.param) else {
            ui.weak("Choose a parameter here, or right click one in the panel");
            return false;
        };
        values_row(ui, param, &mut runs.values);
        match read_values(param, &runs.values) {
            Ok(values) => {
                runs.plan.values = values;
                true
            }
            Err(why) => {
                ui.colored_label(ui.visuals().error_fg_color, format!("values: {why}"));
                false
            }
        }
    }
}

fn values_row(ui: &mut Ui, param: &Param, values: &mut String) {
    ui.horizontal(|ui| {
        ui.label("Values");
        let field = egui::TextEdit::singleline(values).desired_width(f32::INFINITY);
        let about = format!("Separated by commas; {}", param.expected());
        let field = ui.add(field).on_hover_text(about);
        named(&field, WidgetType::TextEdit, "values of the sweep");
    });
}

/// The numbers that matter for the kind of run.
fn numbers(ui: &mut Ui, plan: &mut Plan) {
    ui.horizontal_wrapped(|ui| {
        ui.label("Size");
        let field = |v| DragValue::new(v).range(2..=MAX_SIZE);
        spin(ui, field(&mut plan.size.0), "width of the run");
        ui.label("x");
        spin(ui, field(&mut plan.size.1), "height of the run");
        let frames = DragValue::new(&mut plan.frames).range(1..=MAX_FRAMES);
        spin(ui, frames.suffix(" frames"), "frames of the run");
        if plan.kind == Kind::Bench {
            let rounds = DragValue::new(&mut plan.rounds).range(1..=1000);
            spin(ui, rounds.suffix(" rounds"), "rounds of the run");
            return;
        }
        let samples = DragValue::new(&mut plan.samples).range(0..=1 << 20);
        spin(
            ui,
            samples.suffix(" samples"),
            "reference samples of the run",
        )
        .on_hover_text("Samples per pixel of the reference. 0 uses a cached reference only");
        if plan.kind == Kind::Fit {
            let bound = DragValue::new(&mut plan.max_error).range(1e-6..=10.0);
            let bound = bound.speed(1e-3).prefix("relMSE at most ");
            spin(ui, bound, "largest error of the run");
        }
    });
}
