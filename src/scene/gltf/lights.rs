//! KHR_lights_punctual.

use std::f32::consts::FRAC_PI_2;

use ::gltf::Document;
use ::gltf::khr_lights_punctual::{Kind, Light as From};
use glam::{Mat4, Vec3};

use crate::scene::warnings::Warnings;
use crate::scene::{Light, LightKind};

/// Part of the warning about photometric units. Scene files that set this field drop the warning.
pub(in crate::scene) const SCALE: &str = "lights_scale";

/// Intensities from here on are probably photometric: a radiometric sun has about 1000 W/m^2, a 60
/// W lamp 5 W/sr.
const PHOTOMETRIC: f32 = 1000.0;

/// A light placed by its node, or the reason why it is dropped.
pub(super) fn read(
    light: &From,
    name: &str,
    world: Mat4,
    warnings: &mut Warnings,
) -> Result<Light, &'static str> {
    let mut color = Vec3::from_array(light.color()) * light.intensity();
    if !color.is_finite() {
        return Err("a colour or intensity that is too large");
    }
    if color.min_element() < 0.0 {
        warnings.add(
            "negative colours and intensities of lights count as 0",
            name,
        );
        color = color.max(Vec3::ZERO);
    }
    let kind = match light.kind() {
        Kind::Directional => LightKind::Directional,
        Kind::Point => LightKind::Point,
        Kind::Spot {
            inner_cone_angle,
            outer_cone_angle,
        } => {
            let in_order = 0.0 <= inner_cone_angle && inner_cone_angle <= outer_cone_angle;
            if !in_order || outer_cone_angle > FRAC_PI_2 + 1e-6 {
                return Err("cone angles that do not obey 0 <= inner <= outer <= 90 degrees");
            }
            LightKind::Spot {
                inner: inner_cone_angle,
                outer: outer_cone_angle.min(FRAC_PI_2),
            }
        }
    };
    Ok(Light {
        name: light.name().unwrap_or(name).to_owned(),
        kind,
        color,
        position: world.w_axis.truncate(),
        direction: world
            .transform_vector3(Vec3::NEG_Z)
            .normalize_or(Vec3::NEG_Y),
        shadow: true,
    })
}

/// Warns about lights that are probably in lux and candela, as Blender writes them.
pub(super) fn warn_of_units(document: &Document, lights: &[Light], warnings: &mut Warnings) {
    let generator = document
        .as_json()
        .asset
        .generator
        .as_deref()
        .unwrap_or_default();
    let why = if lights
        .iter()
        .any(|light| light.color.max_element() >= PHOTOMETRIC)
    {
        format!("intensities of {PHOTOMETRIC} and more are")
    } else if generator.contains("Blender") {
        "Blender writes intensities that are".into()
    } else {
        return;
    };
    for light in lights {
        let what = format!(
            "{why} probably photometric (lux, candela), and are taken as W/m^2 and W/sr. To divide them by 683 lm/W, \
             write a scene file with `models: [(file: ..., {SCALE}: 0.00146)]`"
        );
        warnings.add(what, &light.name);
    }
}
