//! The control of a parameter, by its kind.

use crate::graph::param::{Kind, Param, Value};
use egui::{Color32, DragValue, Response, RichText, Ui, WidgetInfo};

/// Colour of values that are not at their default.
pub(crate) const CHANGED: Color32 = Color32::from_rgb(255, 196, 84);

/// Shows a value under a title; edits go into it. `auto`: the number that a default stands for, if
/// the graph chooses it.
pub(crate) fn control(
    ui: &mut Ui,
    param: &Param,
    title: &str,
    value: &mut Value,
    (changed, auto): (bool, Option<f64>),
) -> Response {
    if let Some(auto) = auto
        && let Some(response) = automatic(ui, param, title, value, auto)
    {
        return response;
    }
    let name = match changed {
        true => RichText::new(title).color(CHANGED),
        false => RichText::new(title),
    };
    match (value, &param.kind) {
        (Value::Bool(v), _) => ui.checkbox(v, name),
        (Value::Int(v), _) => {
            let bounds = bounds(param).map(|(low, high)| (low as i64, high as i64));
            let (low, high) = bounds.unwrap_or((i32::MIN.into(), i32::MAX.into()));
            let slid = bounds.map(|range| slider(ui, param, title, v, range));
            let number = DragValue::new(v).suffix(unit(param)).range(low..=high);
            let number = number.speed(param.step.unwrap_or(0.1));
            joined(slid, spin(ui, number, title), ui.label(name))
        }
        (Value::Float(v), _) => {
            let bounds = bounds(param);
            let slid = bounds.map(|range| slider(ui, param, title, v, range));
            let speed = bounds.map_or(0.01, |(low, high)| (high - low) / 500.0);
            let number = number(v, param, speed).suffix(unit(param)).max_decimals(6);
            joined(slid, spin(ui, number, title), ui.label(name))
        }
        (Value::Vector(v), Kind::Colour) if v.len() == 3 => {
            joined(None, colour(ui, v), ui.label(name))
        }
        (Value::Vector(v), _) => {
            let axes = v.iter_mut().zip(["x", "y", "z", "w"]);
            let numbers =
                axes.map(|(x, axis)| spin(ui, number(x, param, 0.01), &format!("{title} {axis}")));
            let numbers = numbers.reduce(|a, b| a | b);
            let label = ui.label(name);
            numbers.map_or(label.clone(), |n| n | label)
        }
        (Value::Choice(v), Kind::Choice(options)) => {
            let combo = egui::ComboBox::from_id_salt(("choice", title)).selected_text(v.as_str());
            let shown = combo.show_ui(ui, |ui| {
                for (i, option) in options.iter().enumerate() {
                    let help = param.option_help.get(i).map_or("", String::as_str);
                    choice_row(ui, v, option, help);
                }
            });
            let label = ui.label(name);
            shown.response.labelled_by(label.id) | label
        }
        (Value::Choice(v), _) => ui.label(v.as_str()),
    }
}

fn colour(ui: &mut Ui, value: &mut Vec<f64>) -> Response {
    let mut rgb = [value[0] as f32, value[1] as f32, value[2] as f32];
    let response = ui.color_edit_button_rgb(&mut rgb);
    if response.changed() {
        *value = rgb.iter().map(|c| f64::from(*c)).collect();
    }
    response
}

fn choice_row(ui: &mut Ui, value: &mut String, option: &String, help: &str) {
    ui.horizontal(|ui| {
        let label = ui.selectable_value(value, option.clone(), option);
        if !help.is_empty() {
            label.on_hover_text(help);
            ui.weak(RichText::new(help).small());
        }
    });
}

/// The range of a parameter, if it is finite.
fn bounds(param: &Param) -> Option<(f64, f64)> {
    let range = param.range;
    range.filter(|(low, high)| low.is_finite() && high.is_finite())
}

fn unit(param: &Param) -> String {
    match param.unit.as_str() {
        "" => String::new(),
        unit => format!(" {unit}"),
    }
}

/// A field for a number. A value out of range must not change because it is shown.
fn number<'v>(value: &'v mut f64, param: &Param, speed: f64) -> DragValue<'v> {
    let (low, high) = param.range.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
    DragValue::new(value)
        .range(low..=high)
        .clamp_existing_to_range(false)
        .speed(param.step.unwrap_or(speed))
}

/// A number that the graph chooses: `auto (78)`, and edits start from 78. Nothing for values that
/// are no numbers.
fn automatic(
    ui: &mut Ui,
    param: &Param,
    title: &str,
    value: &mut Value,
    auto: f64,
) -> Option<Response> {
    let default = param.default.number()?;
    let (low, high) = param.range?;
    let (mut now, shown) = (auto, short_number(auto));
    let chosen = format!("auto ({shown}{})", unit(param));
    let name = format!("{title}, {chosen}");
    let slid = slider(ui, param, title, &mut now, (low, high));
    let field = number(&mut now, param, (high - low) / 500.0)
        .custom_formatter(move |x, _| match x == auto {
            true => chosen.clone(),
            false => short_number(x),
        })
        .custom_parser(move |text| match text.trim().starts_with("auto") {
            true => Some(default),
            false => text.trim().parse().ok(),
        });
    let response = joined(Some(slid), spin(ui, field, &name), ui.label(title));
    if now != auto {
        *value = match value {
            Value::Int(_) => Value::Int(now.round() as i64),
            _ => Value::Float(now),
        };
    }
    Some(response)
}

/// A number for people.
pub(crate) fn short_number(x: f64) -> String {
    format!("{}", (x * 1e3).round() / 1e3)
}

fn slider<N: egui::emath::Numeric>(
    ui: &mut Ui,
    param: &Param,
    title: &str,
    v: &mut N,
    (low, high): (N, N),
) -> Response {
    // Ranges over many powers of ten, with no negative part, are easier on a logarithmic slider.
    let (least, most) = (low.to_f64(), high.to_f64());
    let slider = egui::Slider::new(v, low..=high)
        .show_value(false)
        .logarithmic(least > 0.0 && most / least >= 1000.0);
    // A value between the steps, or one that rounding moves, must not change because it is shown.
    let slider = slider.clamping(egui::SliderClamping::Edits);
    let step = param.step.or(N::INTEGRAL.then_some(1.0));
    let response = ui.add(match step {
        Some(step) => slider.step_by(step),
        None => slider,
    });
    let now = v.to_f64();
    response.widget_info(|| WidgetInfo::slider(true, now, title));
    response
}

/// A field for a number, labelled with its name.
pub(crate) fn spin(ui: &mut Ui, field: DragValue<'_>, name: &str) -> Response {
    let response = ui.add(field);
    response.widget_info(|| WidgetInfo::labeled(egui::WidgetType::DragValue, true, name));
    response
}

/// The name of a text field or a menu, which else has none but its content.
pub(crate) fn named(response: &Response, kind: egui::WidgetType, name: &str) {
    response.widget_info(|| WidgetInfo::labeled(kind, true, name));
}

/// A small button with a name of its own, as several have the same text. Returns whether it was
/// clicked.
pub(crate) fn small_button(ui: &mut Ui, text: &str, name: &str, about: &str) -> bool {
    let button = ui.small_button(text);
    named(&button, egui::WidgetType::Button, name);
    button.on_hover_text(about).clicked()
}

fn joined(slider: Option<Response>, control: Response, label: Response) -> Response {
    let control = control.labelled_by(label.id);
    slider.map_or(control.clone(), |s| s | control) | label
}
