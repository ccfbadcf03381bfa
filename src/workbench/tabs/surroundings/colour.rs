//! A colour as a swatch and an intensity: the picker changes the chroma alone.

use crate::workbench::panel::control::{named, spin};
use egui::{DragValue, Ui, WidgetType};
use glam::Vec3;

const RGB: [&str; 3] = ["red", "green", "blue"];

/// Controls of a linear RGB colour: a swatch, the intensity (the largest of the three channels) and
/// the channels. `name` precedes the accessible names; `quantity` and `unit` label
/// the intensity.
pub(super) fn colour(ui: &mut Ui, v: &mut Vec3, name: &str, quantity: &str, unit: &str) {
    ui.horizontal(|ui| {
        swatch(ui, v, name);
        intensity(ui, v, name);
        ui.label(format!("{quantity}, {unit}"))
            .on_hover_text("The largest channel. The swatch shows the colour without it");
    });
    ui.horizontal(|ui| {
        for (x, channel) in v.as_mut().iter_mut().zip(RGB) {
            let number = DragValue::new(x).range(0.0..=1e7).speed(0.02);
            spin(ui, number, &format!("{name} {channel}"));
        }
        ui.label("linear RGB");
    });
}

/// A button in the colour, which opens a picker.
fn swatch(ui: &mut Ui, v: &mut Vec3, name: &str) {
    let (largest, id) = (v.max_element(), ui.id().with(("chroma", name)));
    // Black has no chroma: it keeps the last one.
    let kept = ui.data(|d| d.get_temp::<[f32; 3]>(id));
    let mut chroma = match largest > 0.0 {
        true => (*v / largest).to_array(),
        false => kept.unwrap_or([1.0; 3]),
    };
    let button = ui.color_edit_button_rgb(&mut chroma);
    named(&button, WidgetType::ColorButton, &format!("{name} colour"));
    if button.changed() {
        let picked = Vec3::from(chroma);
        let full = picked.max_element();
        chroma = match full > 0.0 {
            true => (picked / full).to_array(),
            false => [1.0; 3],
        };
        *v = Vec3::from(chroma) * largest;
    }
    ui.data_mut(|d| d.insert_temp(id, chroma));
}

/// One factor for all channels.
fn intensity(ui: &mut Ui, v: &mut Vec3, name: &str) {
    let before = v.max_element();
    let mut now = before;
    let number = DragValue::new(&mut now).range(0.0..=1e7).speed(0.02);
    spin(ui, number, &format!("{name} intensity"));
    if now != before {
        let id = ui.id().with(("chroma", name));
        let kept = ui.data(|d| d.get_temp::<[f32; 3]>(id)).unwrap_or([1.0; 3]);
        *v = match before > 0.0 {
            true => *v * (now / before),
            false => Vec3::from(kept) * now,
        };
    }
}
