//! Views that the graph offers: one click sets a few parameters, another puts them back.

use super::Workbench;
use crate::graph::param::Value;
use crate::workbench::desired::edit;
use egui::Ui;

/// Earlier parameters of a view: side, name, value.
#[derive(Default)]
pub struct Before(Vec<(usize, String, Option<Value>)>);

impl Before {
    /// Whether no view is shown.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl Workbench {
    /// A button for each view of the graph.
    pub(super) fn view_buttons(&mut self, ui: &mut Ui) {
        let side = self.tabs.inspector.target.side;
        let Some(info) = self.sides[side].info.clone() else {
            return;
        };
        if info.graph.views.is_empty() {
            return;
        }
        let mut chosen = None;
        let mut back = false;
        ui.horizontal_wrapped(|ui| {
            for view in info.graph.views.iter().map(|v| &v.value) {
                if ui.button(&view.title).on_hover_text(&view.help).clicked() {
                    chosen = Some(view);
                }
            }
            let before = egui::Button::new("back");
            let before = ui.add_enabled(!self.tabs.inspector.before.is_empty(), before);
            let about = "Restores the parameters and shows the texture again";
            back = before.on_hover_text(about).clicked();
        });
        ui.separator();
        if back {
            self.leave_view();
        }
        let (Some(view), Some(desired)) = (chosen, &mut self.desired.sides[side]) else {
            return;
        };
        for (name, text) in &view.set.0 {
            let Some(param) = info.graph.params.param(&name.value) else {
                continue;
            };
            let Ok(value) = param.parse(&text.value.0) else {
                continue;
            };
            let before = &mut self.tabs.inspector.before.0;
            if !before.iter().any(|b| b.0 == side && b.1 == name.value) {
                let old = desired.params.iter().find(|p| p.0 == name.value);
                let old = old.map(|p| p.1.clone());
                before.push((side, name.value.clone(), old));
            }
            edit::set(desired, param, &value);
        }
    }

    /// Puts the parameters back.
    fn leave_view(&mut self) {
        for (side, name, old) in std::mem::take(&mut self.tabs.inspector.before.0) {
            let Some(desired) = self.desired.sides[side].as_mut() else {
                continue;
            };
            edit::put(desired, &name, old);
        }
    }
}
