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
    let id = ui.id().with(("chroma", name));
    let kept = ui.data(|d| d.get_temp::<[f32; 3]>(id)).unwrap_or([1.0; 3]);
    let mut chroma = chroma_of(*v, kept.into()).to_array();
    let button = ui.color_edit_button_rgb(&mut chroma);
    named(&button, WidgetType::ColorButton, &format!("{name} colour"));
    let picked = chroma_of(chroma.into(), Vec3::ONE);
    if button.changed() {
        *v = picked * v.max_element();
    }
    ui.data_mut(|d| d.insert_temp(id, picked.to_array()));
}

/// A colour with a largest channel of 1. Black has none: it keeps the last one.
fn chroma_of(v: Vec3, kept: Vec3) -> Vec3 {
    match v.max_element() > 0.0 {
        true => v / v.max_element(),
        false => kept,
    }
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
        *v = chroma_of(*v, kept.into()) * now;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picked_colour_keeps_the_intensity_and_black_its_chroma() {
        let light = Vec3::new(10.0, 5.0, 0.0);
        for dark in [Vec3::new(0.0, 0.0, 0.2), Vec3::splat(0.01)] {
            let picked = chroma_of(dark, Vec3::ONE) * light.max_element();
            assert_eq!(picked.max_element(), 10.0, "{dark}");
        }
        let orange = chroma_of(light, Vec3::ONE);
        assert_eq!(orange, Vec3::new(1.0, 0.5, 0.0));
        assert_eq!(
            chroma_of(Vec3::ZERO, orange) * 4.0,
            Vec3::new(4.0, 2.0, 0.0)
        );
    }
}
