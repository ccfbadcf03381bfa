//! Controls of one light: all fields of its kind.

use super::colour::colour;
use super::metres;
use crate::scene::Light;
use crate::scene::light::Quantity;
use egui::Ui;
use glam::Vec3;

/// Controls of all fields of a light.
pub(super) fn fields(ui: &mut Ui, light: &mut Light) {
    let fields = light.fields();
    let row = light.kind.row();
    for (field, _) in fields.vectors() {
        let Some(v) = light.vector(field.name) else {
            continue;
        };
        match field.quantity {
            Quantity::Color => colour(ui, v, "light", row.color, row.unit),
            Quantity::Direction => direction(ui, v, field.name),
            _ => metres(ui, "position, m", v),
        }
    }
    for &(field, mut x) in fields.numbers() {
        let before = x;
        let slider = egui::Slider::new(&mut x, field.range())
            .suffix(format!(" {}", field.quantity.unit()))
            .logarithmic(field.quantity == Quantity::Length)
            .text(match field.name {
                "inner" => "inner cone angle",
                "outer" => "outer cone angle",
                name => name,
            });
        ui.add(slider);
        if x != before {
            light.set_number(field, x);
            light.keep_in_order();
        }
    }
    ui.checkbox(&mut light.shadow, "casts shadows");
}

/// As angles: easier to set than three numbers of a unit vector.
fn direction(ui: &mut Ui, d: &mut Vec3, name: &str) {
    let of = if name == "direction" {
        String::new()
    } else {
        format!("{name}: ")
    };
    let (mut azimuth, mut elevation) = (
        d.z.atan2(d.x).to_degrees(),
        (-d.y).clamp(-1.0, 1.0).asin().to_degrees(),
    );
    let before = (azimuth, elevation);
    let slider = |x, range, name| {
        egui::Slider::new(x, range)
            .suffix(" deg")
            .text(format!("{of}{name}"))
    };
    ui.add(slider(&mut azimuth, -180.0..=180.0, "azimuth"));
    ui.add(slider(&mut elevation, -90.0..=90.0, "elevation"));
    if (azimuth, elevation) != before {
        let (a, e) = (azimuth.to_radians(), elevation.to_radians());
        *d = Vec3::new(e.cos() * a.cos(), -e.sin(), e.cos() * a.sin());
    }
}
