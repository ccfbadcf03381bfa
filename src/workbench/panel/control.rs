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
    let name = if changed {
        RichText::new(title).color(CHANGED)
    } else {
        RichText::new(title)
    };
    let unit = if param.unit.is_empty() {
        String::new()
    } else {
        format!(" {}", param.unit)
    };
    let (low, high) = param.range.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
    let bounded = low.is_finite() && high.is_finite();
    let drag = |step: f64| param.step.unwrap_or(step);
    match (value, &param.kind) {
        (Value::Bool(v), _) => ui.checkbox(v, name),
        (Value::Int(v), _) => {
            let range = if bounded {
                (low as i64, high as i64)
            } else {
                (i64::from(i32::MIN), i64::from(i32::MAX))
            };
            let slid = bounded.then(|| slider(ui, param, title, v, range));
            let number = DragValue::new(v)
                .suffix(unit)
                .range(range.0..=range.1)
                .speed(drag(0.1));
            joined(slid, spin(ui, number, title), ui.label(name))
        }
        (Value::Float(v), _) => {
            let slid = bounded.then(|| slider(ui, param, title, v, (low, high)));
            let span = if bounded { (high - low) / 500.0 } else { 0.01 };
            let number = DragValue::new(v)
                .suffix(unit)
                .range(low..=high)
                .clamp_existing_to_range(false);
            joined(
                slid,
                spin(ui, number.speed(drag(span)).max_decimals(6), title),
                ui.label(name),
            )
        }
        (Value::Vector(v), Kind::Colour) if v.len() == 3 => {
            let mut rgb = [v[0] as f32, v[1] as f32, v[2] as f32];
            let response = ui.color_edit_button_rgb(&mut rgb);
            if response.changed() {
                *v = rgb.iter().map(|c| f64::from(*c)).collect();
            }
            joined(None, response, ui.label(name))
        }
        (Value::Vector(v), _) => {
            let numbers = v.iter_mut().zip(["x", "y", "z", "w"]).map(|(x, axis)| {
                let number = DragValue::new(x)
                    .speed(drag(0.01))
                    .range(low..=high)
                    .clamp_existing_to_range(false);
                spin(ui, number, &format!("{title} {axis}"))
            });
            let numbers = numbers.reduce(|a, b| a | b);
            let label = ui.label(name);
            numbers.map_or(label.clone(), |n| n | label)
        }
        (Value::Choice(v), Kind::Choice(options)) => {
            let combo = egui::ComboBox::from_id_salt(("choice", title)).selected_text(v.as_str());
            let shown = combo.show_ui(ui, |ui| {
                for (i, option) in options.iter().enumerate() {
                    ui.horizontal(|ui| {
                        let label = ui.selectable_value(v, option.clone(), option);
                        if let Some(help) = param.option_help.get(i).filter(|help| !help.is_empty())
                        {
                            label.on_hover_text(help);
                            ui.weak(RichText::new(help).small());
                        }
                    });
                }
            });
            let label = ui.label(name);
            shown.response.labelled_by(label.id) | label
        }
        (Value::Choice(v), _) => ui.label(v.as_str()),
    }
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
    let (mut number, shown) = (auto, short_number(auto));
    let unit = if param.unit.is_empty() {
        String::new()
    } else {
        format!(" {}", param.unit)
    };
    let chosen = format!("auto ({shown}{unit})");
    let name = format!("{title}, {chosen}");
    let slid = slider(ui, param, title, &mut number, (low, high));
    let field = DragValue::new(&mut number)
        .range(low..=high)
        .clamp_existing_to_range(false)
        .speed(param.step.unwrap_or((high - low) / 500.0))
        .custom_formatter(move |x, _| {
            if x == auto {
                chosen.clone()
            } else {
                short_number(x)
            }
        })
        .custom_parser(move |text| {
            if text.trim().starts_with("auto") {
                Some(default)
            } else {
                text.trim().parse().ok()
            }
        });
    let response = joined(Some(slid), spin(ui, field, &name), ui.label(title));
    if number != auto {
        *value = match value {
            Value::Int(_) => Value::Int(number.round() as i64),
            _ => Value::Float(number),
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

fn joined(slider: Option<Response>, control: Response, label: Response) -> Response {
    let control = control.labelled_by(label.id);
    slider.map_or(control.clone(), |s| s | control) | label
}
