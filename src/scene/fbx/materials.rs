//! Materials: physical models, and Phong and Lambert, which are converted as in MTL files.

use glam::{DVec3, Vec3};
use ufbx::{Material as From, MaterialMap, ShaderType};

use super::numbers::{color, vector};
use super::pictures::{Pictures, UvSource};
use super::unread;
use crate::scene::Material;
use crate::scene::coordinates::{References, UvSources};
use crate::scene::obj::shown;
use crate::scene::phong::{Asked, Maps, Parts, Picture, Words};
use crate::scene::warnings::Warnings;

pub(super) const WORDS: Words = Words {
    holes: "the picture of the base colour has holes in its alpha and there is no opacity map: it is a mask at 0.5",
    all_clear: "the alpha of the base colour's picture is below 0.5 everywhere: it is left out",
    heights: "bump maps that hold heights are left out. Convert them to normal maps",
};

/// A material and its texture coordinates.
#[derive(Clone, Debug)]
pub(super) struct Read {
    pub asked: Asked,
    pub uv: UvSources<UvSource>,
}

/// All materials in file order.
pub(super) fn read(
    file: &ufbx::Scene,
    pictures: &mut Pictures,
    warnings: &mut Warnings,
) -> Vec<Read> {
    file.materials
        .into_iter()
        .map(|material| convert(material, pictures, warnings))
        .collect()
}

fn convert(from: &From, pictures: &mut Pictures, warnings: &mut Warnings) -> Read {
    let name = shown(&from.element.name);
    let is_phong = is_phong(from.shader_type);
    unread::warn_of_material(from, is_phong, warnings);
    let (pbr, fbx) = (&from.pbr, &from.fbx);
    let mut references = References::default();
    let mut laid = |map: &MaterialMap, warnings: &mut Warnings| {
        let texture = map.texture.as_ref().filter(|_| map.texture_enabled)?;
        let laid = pictures.find(texture, warnings)?;
        let number = references.add(laid.source, laid.lookup);
        Some((number, laid.image, laid.is_missing))
    };
    let alphas = [&pbr.opacity, &fbx.transparency_color];
    let alpha_map = alphas[usize::from(is_phong)];
    let [color_map, alpha] = [&pbr.base_color, alpha_map].map(|map| laid(map, warnings));
    // A Phong exponent is not a roughness.
    let own = Some(&pbr.roughness).filter(|_| !is_phong);
    let roughness = own.and_then(|map| laid(map, warnings));
    let [metallic, emission] = [&pbr.metalness, &pbr.emission_color].map(|map| laid(map, warnings));
    let normal = laid(&fbx.normal_map, warnings).map(|found| (found, false));
    let normal = normal.or_else(|| {
        let bump = laid(&pbr.normal_map, warnings).or(laid(&fbx.bump, warnings));
        bump.map(|f| (f, true))
    });
    // Most bump maps hold heights, so a placeholder with normals would be wrong.
    let normal = match normal {
        Some(((_, image, true), true)) => {
            let what = "bump maps that are not there are left out";
            warnings.add(what, shown(&image.name()));
            None
        }
        other => other,
    };
    let uv = references.sources(&name, warnings);
    let picture = |found: Option<(usize, _, bool)>| {
        found.map(|(number, image, _)| Picture {
            image,
            lookup: references.lookup(Some(number), &uv),
        })
    };
    let is_bump = normal.as_ref().is_some_and(|(_, is_bump)| *is_bump);
    let maps = Maps {
        color: picture(color_map),
        alpha: picture(alpha),
        roughness: picture(roughness),
        metallic: picture(metallic),
        normal: picture(normal.map(|(found, _)| found)),
        is_bump,
        emission: picture(emission),
    };
    let mut parts = parts(from, is_phong, maps, name);
    parts.opacity = parts.opacity(&parts.name, warnings);
    let mut asked = parts.build(pictures.requests);
    asked.material = reflective(from, is_phong, asked.material);
    Read { asked, uv }
}

/// The factors. A texture replaces the value and is multiplied by the factor.
fn parts(from: &From, is_phong: bool, maps: Maps, name: String) -> Parts {
    let (pbr, fbx) = (&from.pbr, &from.fbx);
    let tinted = |map: &MaterialMap, factor: &MaterialMap, has_map: bool, default: Vec3| {
        let value = color(rgb(map)).filter(|_| map.has_value).unwrap_or(default);
        let factor = number(factor).unwrap_or(1.0).max(0.0);
        if has_map {
            Vec3::splat(factor)
        } else {
            value * factor
        }
    };
    let (has_color, grey) = (maps.color.is_some(), Vec3::splat(0.8));
    let base_color = tinted(&pbr.base_color, &pbr.base_factor, has_color, grey);
    let (map, factor) = (&pbr.emission_color, &pbr.emission_factor);
    let emission = tinted(map, factor, maps.emission.is_some(), Vec3::ZERO);
    let opacity = match () {
        () if maps.alpha.is_some() => None,
        () if is_phong => opacity_of_phong(from),
        () => color(rgb(&pbr.opacity))
            .filter(|_| pbr.opacity.has_value)
            .map(|v| v.element_sum() / 3.0),
    };
    let gloss = number(&pbr.glossiness).map(|gloss| 1.0 - gloss);
    let roughness = match maps.roughness {
        _ if is_phong => None,
        Some(_) => Some(1.0),
        None => number(&pbr.roughness).or(gloss),
    };
    Parts {
        base_color: base_color.min(Vec3::ONE),
        emission: Some(emission)
            .filter(|e| e.is_finite())
            .unwrap_or(Vec3::ZERO),
        opacity: opacity.unwrap_or(1.0),
        cutoff: None,
        roughness,
        exponent: number(&fbx.specular_exponent)
            .filter(|_| from.shader_type != ShaderType::FbxLambert),
        metallic: if maps.metallic.is_some() {
            Some(1.0)
        } else {
            number(&pbr.metalness)
        },
        maps,
        name,
    }
}

/// Transparency is the mean of a colour times a factor. Some programs write the opacity instead.
fn opacity_of_phong(from: &From) -> Option<f32> {
    if let Some(opacity) = from.element.props.find_prop("Opacity") {
        return Some(opacity.value_vec4.x as f32).filter(|v| v.is_finite());
    }
    let through = &from.fbx.transparency_color;
    let mean = if through.has_value {
        rgb(through).element_sum() / 3.0
    } else {
        1.0
    };
    let factor = number(&from.fbx.transparency_factor)?;
    Some(1.0 - factor * mean as f32).filter(|v| v.is_finite())
}

/// Index of refraction and specular colour, if the material model has them.
fn reflective(from: &From, is_phong: bool, material: Material) -> Material {
    if is_phong || from.shader_type == ShaderType::BlenderPhong {
        return material;
    }
    let pbr = &from.pbr;
    let tint = color(rgb(&pbr.specular_color)).filter(|_| pbr.specular_color.has_value);
    Material {
        ior: number(&pbr.specular_ior)
            .unwrap_or(material.ior)
            .clamp(0.0, 1e6),
        specular: number(&pbr.specular_factor)
            .unwrap_or(material.specular)
            .clamp(0.0, 1.0),
        specular_color: tint.unwrap_or(material.specular_color),
        ..material
    }
}

/// Whether the model has a Phong exponent instead of a roughness.
fn is_phong(kind: ShaderType) -> bool {
    use ShaderType::*;
    matches!(kind, Unknown | FbxLambert | FbxPhong | WavefrontMtl)
}

fn rgb(map: &MaterialMap) -> DVec3 {
    let v = &map.value_vec4;
    match map.value_components {
        1 => DVec3::splat(v.x),
        _ => vector(ufbx::Vec3 {
            x: v.x,
            y: v.y,
            z: v.z,
        }),
    }
}

fn number(map: &MaterialMap) -> Option<f32> {
    Some(map.value_vec4.x as f32).filter(|v| map.has_value && v.is_finite())
}
