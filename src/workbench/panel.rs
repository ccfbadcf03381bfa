//! The panel of parameters, made from what the graph declares: nothing here knows any of them.

use super::edit;
use super::request::SideRequest;
use crate::graph::param::{Kind, Param, Params, Value};
use egui::{Color32, Response, RichText, Ui};

/// What of the panel is not part of the experiment.
#[derive(Default)]
pub struct Panel {
    /// Text that names, groups or help must hold.
    pub search: String,
    /// Show only what is not at its default.
    pub only_changed: bool,
}

/// Colour of what is not at its default.
const CHANGED: Color32 = Color32::from_rgb(255, 196, 84);

impl Panel {
    /// Shows the parameters of a side; edits go into it. `other` is the side it is compared with.
    pub fn show(&mut self, ui: &mut Ui, params: &Params, side: &mut SideRequest, other: Option<&SideRequest>) {
        let top = egui::vec2(ui.available_width(), ui.spacing().interact_size.y);
        ui.allocate_ui_with_layout(top, egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let reset = egui::Button::new(RichText::new("reset all")).small();
            if ui.add_enabled(!side.params.is_empty(), reset).clicked() {
                side.params.clear();
            }
            ui.checkbox(&mut self.only_changed, "changed").on_hover_text("Only what is not at its default");
            ui.add(egui::TextEdit::singleline(&mut self.search).hint_text("search").desired_width(f32::INFINITY));
        });
        let mut groups: Vec<&str> = Vec::new();
        for param in &params.list {
            if !groups.contains(&param.group.as_str()) {
                groups.push(&param.group);
            }
        }
        let needle = self.search.to_lowercase();
        let searching = !needle.is_empty() || self.only_changed;
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            for (number, group) in groups.iter().enumerate() {
                let shown: Vec<&Param> = params
                    .list
                    .iter()
                    .filter(|p| p.group == *group)
                    .filter(|p| matches(p, &needle))
                    .filter(|p| !self.only_changed || is_set(side, p))
                    .collect();
                if shown.is_empty() {
                    continue;
                }
                let count = params.list.iter().filter(|p| p.group == *group && is_set(side, p)).count();
                let title = if group.is_empty() { "Other" } else { group };
                let title = if count > 0 {
                    RichText::new(format!("{title} ({count})")).color(CHANGED)
                } else {
                    RichText::new(title)
                };
                egui::CollapsingHeader::new(title).id_salt(("group", number)).open(searching.then_some(true)).show(
                    ui,
                    |ui| {
                        for param in shown {
                            row(ui, param, side, other);
                        }
                    },
                );
            }
        });
    }
}

fn matches(param: &Param, needle: &str) -> bool {
    needle.is_empty()
        || [&param.name, &param.group, &param.help].iter().any(|text| text.to_lowercase().contains(needle))
}

fn is_set(side: &SideRequest, param: &Param) -> bool {
    side.params.iter().any(|(name, _)| *name == param.name)
}

fn row(ui: &mut Ui, param: &Param, side: &mut SideRequest, other: Option<&SideRequest>) {
    let before = edit::value(side, param);
    let mut value = before.clone();
    let changed = is_set(side, param);
    ui.horizontal(|ui| {
        let reset = ui.add_visible(changed, egui::Button::new("↺").small().frame(false));
        reset
            .widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, format!("reset {}", param.name)));
        if reset.on_hover_text("Back to the default").clicked() {
            value = param.default.clone();
        }
        let response = control(ui, param, &mut value, changed);
        response.on_hover_ui(|ui| help(ui, param));
        if let Some(other) = other {
            let theirs = edit::value(other, param);
            if theirs != before {
                ui.weak(format!("other: {theirs}"));
            }
        }
    });
    if value != before {
        edit::set(side, param, &value);
    }
}

fn help(ui: &mut Ui, param: &Param) {
    ui.set_max_width(320.0);
    ui.strong(&param.name);
    ui.label(&param.help);
    let mut facts = vec![format!("default {}", param.default)];
    if let Some((low, high)) = param.range {
        facts.push(format!("{low} to {high}"));
    }
    if !param.unit.is_empty() {
        facts.push(param.unit.clone());
    }
    if param.is_compiled() {
        facts.push("a constant of its shaders: changing it builds them anew".into());
    }
    ui.weak(facts.join(", "));
}

fn control(ui: &mut Ui, param: &Param, value: &mut Value, changed: bool) -> Response {
    let name = if changed { RichText::new(&param.name).color(CHANGED) } else { RichText::new(&param.name) };
    let unit = if param.unit.is_empty() { String::new() } else { format!(" {}", param.unit) };
    let (low, high) = param.range.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
    let bounded = low.is_finite() && high.is_finite();
    // Ranges over many powers of ten, with no negative part, are easier on a logarithmic slider.
    let logarithmic = low > 0.0 && high / low >= 1000.0;
    match (value, &param.kind) {
        (Value::Bool(v), _) => ui.checkbox(v, name),
        (Value::Int(v), _) if bounded => {
            let slider = egui::Slider::new(v, low as i64..=high as i64).suffix(unit).text(name);
            ui.add(slider.logarithmic(logarithmic).step_by(param.step.unwrap_or(1.0)))
        }
        (Value::Int(v), _) => number(ui, name, |ui| ui.add(egui::DragValue::new(v).suffix(unit))),
        (Value::Float(v), _) if bounded => {
            let slider = egui::Slider::new(v, low..=high).suffix(unit).text(name).logarithmic(logarithmic);
            // A value between the steps, or one that rounding moves, must not change because it is shown.
            let slider = slider.clamping(egui::SliderClamping::Edits);
            ui.add(match param.step {
                Some(step) => slider.step_by(step),
                None => slider,
            })
        }
        (Value::Float(v), _) => {
            let drag = egui::DragValue::new(v).suffix(unit).speed(param.step.unwrap_or(0.01)).range(low..=high);
            number(ui, name, |ui| ui.add(drag))
        }
        (Value::Vector(v), Kind::Colour) if v.len() == 3 => {
            let mut rgb = [v[0] as f32, v[1] as f32, v[2] as f32];
            number(ui, name, |ui| {
                let response = ui.color_edit_button_rgb(&mut rgb);
                if response.changed() {
                    *v = rgb.iter().map(|c| f64::from(*c)).collect();
                }
                response
            })
        }
        (Value::Vector(v), _) => number(ui, name, |ui| {
            let speed = param.step.unwrap_or(0.01);
            let drags = v.iter_mut().map(|x| ui.add(egui::DragValue::new(x).speed(speed).range(low..=high)));
            drags.reduce(|a, b| a | b).unwrap_or_else(|| ui.label(""))
        }),
        (Value::Choice(v), Kind::Choice(options)) => {
            let combo = egui::ComboBox::new(("choice", &param.name), name).selected_text(v.as_str());
            combo
                .show_ui(ui, |ui| {
                    for option in options {
                        ui.selectable_value(v, option.clone(), option);
                    }
                })
                .response
        }
        (Value::Choice(v), _) => ui.label(v.as_str()),
    }
}

/// A control without a label of its own, and its name behind it.
fn number(ui: &mut Ui, name: RichText, control: impl FnOnce(&mut Ui) -> Response) -> Response {
    ui.horizontal(|ui| {
        let response = control(ui);
        let label = ui.label(name);
        response.labelled_by(label.id) | label
    })
    .inner
}
