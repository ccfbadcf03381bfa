//! The control of a parameter, by its kind.

use crate::graph::param::{AUTO, Kind, Param, Value};
use egui::{DragValue, Response, RichText, Ui, WidgetInfo};

/// How a row looks.
pub(crate) struct Look<'a> {
    /// Whether the value is not the default.
    pub changed: bool,
    /// Whether it has no effect now.
    pub idle: bool,
    /// The number that a default stands for, if the graph chooses it.
    pub auto: Option<f64>,
    /// The option that `auto` stands for.
    pub chosen: Option<&'a str>,
}

/// Width of the button that resets a row, points.
const RESET: f32 = 20.0;
/// Width of a number with its unit, and without, points.
const NUMBER: [f32; 2] = [86.0, 58.0];

/// A row narrower than this leaves units to the tooltip, points.
const NARROW: f32 = 300.0;

/// Width of the column of labels, points.
pub(crate) fn label_width(ui: &Ui) -> f32 {
    (0.34 * ui.available_width()).clamp(72.0, 150.0)
}

/// A label of that width; the whole text is in the tooltip if it is cut. A layout of its own for
/// each would cost as much again as the rest of the row.
pub(crate) fn label(ui: &mut Ui, width: f32, text: RichText) -> Response {
    let size = egui::vec2(width, ui.spacing().interact_size.y);
    let (rect, response) = ui.allocate_exact_size(size, egui::Sense::hover());
    let whole = text.text().to_string();
    let text = egui::WidgetText::from(text);
    let wrap = Some(egui::TextWrapMode::Truncate);
    let galley = text.into_galley(ui, wrap, width, egui::TextStyle::Body);
    response.widget_info(|| WidgetInfo::labeled(egui::WidgetType::Label, true, &whole));
    let cut = galley.elided;
    let at = egui::pos2(rect.left(), rect.center().y - galley.size().y / 2.0);
    ui.painter().galley(at, galley, ui.visuals().text_color());
    match cut {
        true => response.on_hover_text(whole),
        false => response,
    }
}

/// The button at the end of a row that sets the default again; none where nothing is to be reset.
pub(crate) fn reset_button(ui: &mut Ui, visible: bool, name: &str) -> bool {
    if !visible {
        return false;
    }
    let right = egui::Layout::right_to_left(egui::Align::Center);
    ui.with_layout(right, |ui| {
        let icon = RichText::new(egui_phosphor::regular::ARROW_COUNTER_CLOCKWISE);
        let reset = ui.add(egui::Button::new(icon).frame(false));
        let name = format!("reset {name}");
        named(&reset, egui::WidgetType::Button, &name);
        reset.on_hover_text("Back to the default").clicked()
    })
    .inner
}

/// Shows a value behind its title; edits go into it.
pub(crate) fn control(
    ui: &mut Ui,
    param: &Param,
    title: &str,
    value: &mut Value,
    look: &Look,
) -> Response {
    let name = match (look.changed, look.idle) {
        (true, _) => RichText::new(title).color(ui.visuals().warn_fg_color),
        (false, true) => RichText::new(title).weak().italics(),
        (false, false) => RichText::new(title),
    };
    let narrow = ui.available_width() < NARROW;
    let width = label_width(ui);
    let label = label(ui, width, name);
    if look.idle {
        // The contrast stays above 4.5:1.
        ui.multiply_opacity(ui.visuals().disabled_alpha);
    }
    let spare = ui.available_width() - RESET - ui.spacing().item_spacing.x;
    let gap = ui.spacing().item_spacing.x;
    ui.spacing_mut().slider_width = (spare - NUMBER[usize::from(narrow)] - 2.0 * gap).max(16.0);
    ui.spacing_mut().combo_width = spare.max(60.0);
    if let Some(auto) = look.auto
        && let Some(response) = automatic(ui, param, title, value, (auto, narrow))
    {
        return response.labelled_by(label.id) | label;
    }
    let response = match (value, &param.kind) {
        (Value::Bool(v), _) => {
            let tick = ui.checkbox(v, "");
            let on = *v;
            tick.widget_info(|| WidgetInfo::selected(egui::WidgetType::Checkbox, true, on, title));
            tick
        }
        (Value::Int(v), _) => {
            let bounds = bounds(param).map(|(low, high)| (low as i64, high as i64));
            let (low, high) = bounds.unwrap_or((i32::MIN.into(), i32::MAX.into()));
            let slid = bounds.map(|range| slider(ui, param, title, v, range));
            let number = DragValue::new(v)
                .suffix(unit(param, narrow))
                .range(low..=high);
            let number = number.speed(param.step.unwrap_or(0.1));
            joined(slid, wide(ui, number, title, narrow))
        }
        (Value::Float(v), _) => {
            let bounds = bounds(param);
            let slid = bounds.map(|range| slider(ui, param, title, v, range));
            let speed = bounds.map_or(0.01, |(low, high)| (high - low) / 500.0);
            let number = number(v, param, speed)
                .suffix(unit(param, narrow))
                .max_decimals(6);
            joined(slid, wide(ui, number, title, narrow))
        }
        (Value::Vector(v), Kind::Colour) if v.len() == 3 => colour(ui, v),
        (Value::Vector(v), _) => {
            let axes = v.iter_mut().zip(["x", "y", "z", "w"]);
            let numbers =
                axes.map(|(x, axis)| spin(ui, number(x, param, 0.01), &format!("{title} {axis}")));
            let numbers = numbers.reduce(|a, b| a | b);
            numbers.unwrap_or_else(|| label.clone())
        }
        (Value::Choice(v), Kind::Choice(options)) => {
            let text = match look.chosen.filter(|_| v == AUTO) {
                Some(chosen) => format!("{AUTO} ({chosen})"),
                None => v.clone(),
            };
            let combo = egui::ComboBox::from_id_salt(("choice", title)).selected_text(text);
            let shown = combo.show_ui(ui, |ui| {
                for (i, option) in options.iter().enumerate() {
                    let help = param.option_help.get(i).map_or("", String::as_str);
                    choice_row(ui, v, option, help);
                }
            });
            shown.response
        }
        (Value::Choice(v), _) => ui.label(v.as_str()),
    };
    response.labelled_by(label.id) | label
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

fn unit(param: &Param, narrow: bool) -> String {
    match param.unit.as_str() {
        _ if narrow => String::new(),
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
    (auto, narrow): (f64, bool),
) -> Option<Response> {
    let default = param.default.number()?;
    let (low, high) = param.range?;
    let (mut now, shown) = (auto, short_number(auto));
    let chosen = format!("auto ({shown}{})", unit(param, false));
    let brief = match narrow {
        true => shown,
        false => chosen.clone(),
    };
    let name = format!("{title}, {chosen}");
    let slid = slider(ui, param, title, &mut now, (low, high));
    let field = number(&mut now, param, (high - low) / 500.0)
        .custom_formatter(move |x, _| match x == auto {
            true => brief.clone(),
            false => short_number(x),
        })
        .custom_parser(move |text| match text.trim().starts_with("auto") {
            true => Some(default),
            false => text.trim().parse().ok(),
        });
    let response = joined(Some(slid), wide(ui, field, &name, narrow));
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
    labelled(ui.add(field), name)
}

/// A field for a number as wide as those of the other rows.
fn wide(ui: &mut Ui, field: DragValue<'_>, name: &str, narrow: bool) -> Response {
    ui.spacing_mut().interact_size.x = NUMBER[usize::from(narrow)];
    labelled(ui.add(field), name)
}

fn labelled(response: Response, name: &str) -> Response {
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

fn joined(slider: Option<Response>, number: Response) -> Response {
    match slider {
        Some(slider) => slider | number,
        None => number,
    }
}
