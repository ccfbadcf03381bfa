//! Punctual lights.

use glam::{DAffine3, DVec3};
use ufbx::{Exporter, Light as From, LightAreaShape, LightDecay, LightType};

use super::numbers::{color, vector};
use crate::scene::gltf::SCALE;
use crate::scene::warnings::Warnings;
use crate::scene::{Light, LightKind};

/// A light placed by its node, or the reason why it is dropped.
pub(super) fn read(
    from: &From,
    exporter: Exporter,
    name: &str,
    world: &DAffine3,
    warnings: &mut Warnings,
) -> Result<Light, &'static str> {
    let is_blender = matches!(exporter, Exporter::BlenderBinary | Exporter::BlenderAscii);
    // Blender omits values equal to its own template and may omit the template too. ufbx then
    // substitutes values of another template.
    let is_own = |name: &str| {
        !is_blender
            || from
                .element
                .props
                .props
                .iter()
                .any(|prop| prop.name == name)
    };
    let tint = if is_own("Color") {
        vector(from.color)
    } else {
        DVec3::ONE
    };
    let intensity = if is_own("Intensity") {
        from.intensity
    } else {
        1.0
    };
    let is_quadratic = is_blender || from.decay == LightDecay::Quadratic;
    // Blender writes the total power of a lamp in W, and W/m^2 for a sun.
    let whole = if is_blender && from.type_ != LightType::Directional {
        4.0 * std::f64::consts::PI
    } else {
        1.0
    };
    let strength = tint * (intensity / whole);
    if strength.min_element() < 0.0 {
        warnings.add(
            "negative colours and intensities of lights count as 0",
            name,
        );
    }
    let strength = color(strength).ok_or("a colour or intensity that is too large")?;
    let kind = match from.type_ {
        LightType::Directional => LightKind::Directional,
        LightType::Point => LightKind::Point,
        LightType::Spot => spot(from)?,
        LightType::Area => {
            warnings.add(
                "area lights have no extent: they are spots of 180 degrees, spheres are points",
                name,
            );
            match from.area_shape {
                LightAreaShape::Sphere => LightKind::Point,
                LightAreaShape::Rectangle => LightKind::Spot {
                    inner: 0.0,
                    outer: std::f32::consts::FRAC_PI_2,
                },
            }
        }
        LightType::Volume => return Err("a volume"),
    };
    if !is_quadratic && kind != LightKind::Directional {
        warnings.add(
            "lights that do not decay by the square of the distance do so here",
            name,
        );
    }
    if !is_blender {
        let what = format!(
            "intensities have no unit in FBX: a hundredth of them is taken as W/m^2 or W/sr. To scale them, write a scene \
             file with `models: [(file: ..., {SCALE}: 10)]`"
        );
        warnings.add(what, name);
    }
    let direction = world
        .transform_vector3(vector(from.local_direction))
        .normalize_or(DVec3::NEG_Y);
    Ok(Light {
        name: name.to_owned(),
        kind,
        color: strength,
        position: world.translation.as_vec3(),
        direction: direction.as_vec3(),
        ..Light::default()
    })
}

/// Full cone angles in degrees.
fn spot(from: &From) -> Result<LightKind, &'static str> {
    let half = |degrees: f64| (0.5 * degrees).to_radians() as f32;
    let (inner, outer) = (half(from.inner_angle), half(from.outer_angle));
    let largest = std::f32::consts::FRAC_PI_2;
    if !(outer > 0.0 && outer <= largest + 1e-6) {
        return Err("cone angles that are not between 0 and 180 degrees");
    }
    let outer = outer.min(largest);
    Ok(LightKind::Spot {
        inner: if inner.is_finite() {
            inner.clamp(0.0, outer)
        } else {
            0.0
        },
        outer,
    })
}
