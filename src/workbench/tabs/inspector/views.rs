//! Views that the graph offers: one click sets a few parameters, another puts them back.

use super::Workbench;
use crate::graph::file::ViewDecl;
use crate::graph::param::{Param, Value};
use crate::workbench::desired::edit;
use crate::workbench::desired::request::SideRequest;
use crate::workbench::engine::report::GraphInfo;
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
        // Views start at the inspected mip.
        let target = &self.tabs.inspector.target;
        let mip = mip_param(&info, &target.texture).map(|p| (p, Value::Int(target.mip.into())));
        for (param, value) in settings(&info, view).chain(mip) {
            let before = &mut self.tabs.inspector.before.0;
            if !before.iter().any(|b| b.0 == side && b.1 == param.name) {
                let old = desired.params.iter().find(|p| p.0 == param.name);
                let old = old.map(|p| p.1.clone());
                before.push((side, param.name.clone(), old));
            }
            edit::set(desired, param, &value);
        }
    }

    /// While a view is shown, the inspected mip and the parameter for the mip of the view are the
    /// same. `inspected` is the mip before the slider.
    pub(super) fn link_mip(&mut self, info: &GraphInfo, inspected: u32, last: u32) {
        let target = &mut self.tabs.inspector.target;
        let Some(param) = mip_param(info, &target.texture) else {
            return;
        };
        let Some(desired) = &mut self.desired.sides[target.side] else {
            return;
        };
        if !info
            .graph
            .views
            .iter()
            .any(|v| is_shown(info, &v.value, desired))
        {
            return;
        }
        if target.mip != inspected {
            edit::set(desired, param, &Value::Int(target.mip.into()));
        } else if let Value::Int(mip) = edit::value(desired, param) {
            target.mip = u32::try_from(mip).unwrap_or(0).min(last);
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

/// Parameters and values of a view.
fn settings<'v>(
    info: &'v GraphInfo,
    view: &'v ViewDecl,
) -> impl Iterator<Item = (&'v Param, Value)> {
    view.set.0.iter().filter_map(|(name, text)| {
        let param = info.graph.params.param(&name.value)?;
        Some((param, param.parse(&text.value.0).ok()?))
    })
}

/// Whether a side has the values of a view.
fn is_shown(info: &GraphInfo, view: &ViewDecl, side: &SideRequest) -> bool {
    settings(info, view).all(|(param, value)| edit::value(side, param) == value)
}

/// The parameter that selects the mip of a texture in views.
fn mip_param<'i>(info: &'i GraphInfo, texture: &str) -> Option<&'i Param> {
    let known = info.graph.view_mips.iter().find(|v| v.0 == texture)?;
    info.graph.params.param(&known.1)
}
