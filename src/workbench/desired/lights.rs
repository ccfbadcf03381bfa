//! New lights: their names, and where they start.

use crate::scene::light::{Kind, Quantity};
use crate::scene::{Camera, Light, LightKind};
use glam::Vec3;

/// Name of a new light: its kind and a number above those of all others. Numbers that only grow
/// keep added lights in the order of a saved experiment.
fn name(kind: &Kind, lights: &[&[Light]]) -> String {
    let number = |light: &Light| light.name.rsplit(' ').next().and_then(|n| n.parse().ok());
    let numbers = lights.iter().copied().flatten().filter_map(number);
    let last: u32 = numbers.filter(|n| *n < u32::MAX).max().unwrap_or(0);
    format!("{} {}", kind.name.to_lowercase(), last + 1)
}

/// A new light of a kind, half way to the camera's target. `lights` are the present lights and the
/// scene's own: their names are taken; `diagonal` is the scene's size, m.
pub(crate) fn new(kind: &Kind, lights: &[&[Light]], camera: &Camera, diagonal: f32) -> Light {
    let view = camera.target - camera.eye;
    let mut light = Light::new(kind, &name(kind, lights));
    light.position = camera.eye + 0.5 * view.clamp_length_max(diagonal);
    light.direction = match light.kind {
        LightKind::Directional => Vec3::new(-0.4, -0.8, -0.4).normalize(),
        // Not along the view, so that its handle is not behind the light.
        _ => (view.normalize_or(Vec3::NEG_Z) + 0.5 * Vec3::NEG_Y).normalize_or(Vec3::NEG_Y),
    };
    let extents: Vec<_> = light.fields().numbers().to_vec();
    let lengths = extents.iter().filter(|f| f.0.quantity == Quantity::Length);
    for (field, extent) in lengths {
        light.set_number(field, extent * 0.1 * f64::from(diagonal));
    }
    // At 0.3 of the diagonal a surface receives 3 W/m².
    light.color = Vec3::splat(match light.kind {
        LightKind::Directional => 3.0,
        LightKind::Point | LightKind::Spot { .. } => 0.27 * diagonal * diagonal,
        LightKind::Rectangle { .. } | LightKind::Disc { .. } => 30.0,
    });
    light
}

/// A copy of a light under a name of its own.
pub(crate) fn copy(light: &Light, lights: &[&[Light]]) -> Light {
    Light {
        name: name(light.kind.row(), lights),
        ..light.clone()
    }
}

/// Name of the light that unlit scenes get.
pub(crate) const HEADLIGHT: &str = "headlight";

/// A light from the camera, for a scene that has none: neither lights nor sky nor emission.
pub(crate) fn headlight(camera: &Camera, diagonal: f32) -> Light {
    let reach = (camera.target - camera.eye).length().min(diagonal);
    Light {
        name: HEADLIGHT.into(),
        position: camera.eye,
        kind: LightKind::Point,
        color: Vec3::splat(3.0 * reach * reach),
        ..Light::default()
    }
}
