//! KHR_lights_punctual, and EXT_lights_area as drafted by Khronos (pull request 2525).

use std::f32::consts::FRAC_PI_2;

use ::gltf::khr_lights_punctual::Kind;
use ::gltf::{Document, Node};
use glam::{Mat4, Vec3};
use serde::Deserialize;
use serde_json::Value;

use crate::scene::warnings::Warnings;
use crate::scene::{Light, LightKind};

/// Part of the warning about photometric units. Scene files that set this field drop the warning.
pub(in crate::scene) const SCALE: &str = "lights_scale";

/// Intensities from here on are probably photometric: a radiometric sun has about 1000 W/m^2, a 60
/// W lamp 5 W/sr.
const PHOTOMETRIC: f32 = 1000.0;

/// A light placed by its node, or the reason why it is dropped; `None` without one.
pub(super) fn of_node(
    node: &Node,
    document: &Document,
    name: &str,
    world: Mat4,
    warnings: &mut Warnings,
) -> Option<Result<Light, &'static str>> {
    let (kind, color, own_name) = if let Some(light) = node.light() {
        if node.extension_value(AREA).is_some() {
            warnings.add(
                "a node has one light: that of EXT_lights_area is left out",
                name,
            );
        }
        let color = Vec3::from_array(light.color()) * light.intensity();
        let own_name = light.name().map(str::to_owned);
        (punctual(&light.kind()), color, own_name)
    } else {
        let index = node
            .extension_value(AREA)?
            .get("light")
            .and_then(Value::as_u64);
        let index = index.and_then(|i| usize::try_from(i).ok());
        let lights = document.extension_value(AREA).and_then(|e| e.get("lights"));
        let Some(light) = lights.zip(index).and_then(|(list, i)| list.get(i)) else {
            return Some(Err("no description in the file"));
        };
        let color = light.get("color").map(|c| Vec3::deserialize(c).ok());
        let color = color.map_or(Some(Vec3::ONE), |c| c);
        let Some(color) = color.zip(number(light, "intensity", 1000.0)) else {
            return Some(Err("a colour or intensity that is no number"));
        };
        let own_name = light.get("name").and_then(Value::as_str);
        let (color, intensity) = color;
        (area(light), color * intensity, own_name.map(str::to_owned))
    };
    let kind = match kind {
        Ok(kind) => kind,
        Err(why) => return Some(Err(why)),
    };
    if !color.is_finite() {
        return Some(Err("a colour or intensity that is too large"));
    }
    if color.min_element() < 0.0 {
        warnings.add(
            "negative colours and intensities of lights count as 0",
            name,
        );
    }
    let mut light = Light {
        name: own_name.unwrap_or_else(|| name.to_owned()),
        kind,
        color: color.max(Vec3::ZERO),
        direction: Vec3::NEG_Z,
        ..Light::default()
    };
    light.transform(&world);
    Some(if light.has_sound_extents() {
        Ok(light)
    } else {
        Err("a size that is not 0.0001 to 1000000 m")
    })
}

/// Whether a node has a light.
pub(super) fn has_one(node: &Node) -> bool {
    node.light().is_some() || node.extension_value(AREA).is_some()
}

const AREA: &str = "EXT_lights_area";

fn punctual(kind: &Kind) -> Result<LightKind, &'static str> {
    Ok(match *kind {
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
    })
}

/// A light of EXT_lights_area.
fn area(light: &Value) -> Result<LightKind, &'static str> {
    let rect = light.get("rect").unwrap_or(&Value::Null);
    let (size, aspect) = (number(light, "size", 1.0), number(rect, "aspect", 1.0));
    let Some((size, aspect)) = size.zip(aspect).filter(|(s, a)| *s > 0.0 && *a > 0.0) else {
        return Err("a size that is not above 0");
    };
    match light.get("type").and_then(Value::as_str) {
        Some("rect") => Ok(LightKind::Rectangle {
            width: size * aspect,
            height: size,
        }),
        Some("disk") => Ok(LightKind::Disc { radius: 0.5 * size }),
        _ => Err("a shape other than rect and disk"),
    }
}

/// A number of JSON, or its default where it is missing; `None` if it is something else.
fn number(of: &Value, name: &str, default: f32) -> Option<f32> {
    match of.get(name) {
        None => Some(default),
        Some(value) => value.as_f64().map(|x| x as f32).filter(|x| x.is_finite()),
    }
}

/// Warns about lights that are probably in lux, candela and nits, as Blender writes them.
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
            "{why} probably photometric (lux, candela, nits), and are taken as W/m^2, W/sr and W/(m^2 sr). To divide them by 683 lm/W, \
             write a scene file with `models: [(file: ..., {SCALE}: 0.00146)]`"
        );
        warnings.add(what, &light.name);
    }
}
