//! The KHR_materials_* extensions, and warnings about unsupported ones.

use ::gltf::Material as From;
use glam::Vec3;
use serde_json::Value;

use super::means::Means;
use crate::scene::Material;
use crate::scene::warnings::Warnings;

/// Extensions with the property that activates them; at its default of 0 the extension has no
/// effect.
const MATTERS: [(&str, &str); 7] = [
    ("KHR_materials_anisotropy", "anisotropyStrength"),
    ("KHR_materials_clearcoat", "clearcoatFactor"),
    (
        "KHR_materials_diffuse_transmission",
        "diffuseTransmissionFactor",
    ),
    ("KHR_materials_dispersion", "dispersion"),
    ("KHR_materials_iridescence", "iridescenceFactor"),
    ("KHR_materials_sheen", "sheenColorFactor"),
    ("KHR_materials_volume", "thicknessFactor"),
];

/// Warns about each active, unsupported extension of the material.
pub(super) fn warn_of_others(from: &From, name: &str, warnings: &mut Warnings) {
    let others = from.extensions().into_iter().flatten();
    for (extension, _) in others.filter(|(extension, value)| matters(extension, value)) {
        warnings.add(format!("{extension} is left out of materials"), name);
    }
}

fn matters(extension: &str, value: &Value) -> bool {
    let Some((_, key)) = MATTERS.iter().find(|(known, _)| *known == extension) else {
        return true;
    };
    let on = |v: &Value| v.as_f64().is_some_and(|v| v != 0.0);
    value
        .get(key)
        .is_some_and(|v| on(v) || v.as_array().is_some_and(|list| list.iter().any(on)))
}

/// KHR_materials_ior and KHR_materials_specular. Textures are reduced to their mean, because no
/// other material needs the lookup.
pub(super) fn specular(
    material: &mut Material,
    from: &From,
    means: &Means,
    warnings: &mut Warnings,
) {
    if let Some(ior) = from.ior() {
        // 0 stands for full reflection; other values below 1 are not physical.
        material.ior = if ior == 0.0 { 0.0 } else { ior.clamp(1.0, 1e6) };
    }
    let Some(specular) = from.specular() else {
        return;
    };
    let (factor, color) = (
        specular.specular_texture(),
        specular.specular_color_texture(),
    );
    material.specular =
        (specular.specular_factor() * means.color(factor.as_ref()).w).clamp(0.0, 1.0);
    material.specular_color =
        finite3(specular.specular_color_factor()) * means.color(color.as_ref()).truncate();
    if factor.is_some() || color.is_some() {
        warnings.add(
            "of textures of KHR_materials_specular only the mean is used",
            &material.name,
        );
    }
}

/// KHR_materials_transmission: surfaces become opaque or invisible. Refraction and tinted
/// transmission are not supported.
pub(super) fn transmission(
    material: &mut Material,
    from: &From,
    means: &Means,
    warnings: &mut Warnings,
) {
    let Some(transmission) = from.transmission() else {
        return;
    };
    let texture = transmission.transmission_texture();
    // Metals transmit nothing. A metallic texture is assumed to be non-metal.
    let metallic = if material.metallic_roughness_texture.is_some() {
        0.0
    } else {
        material.metallic
    };
    let share =
        transmission.transmission_factor() * means.data(texture.as_ref()).x * (1.0 - metallic);
    if share > 0.5 {
        leave_out(material);
        warnings.add(
            "materials that let more than half of the light through (KHR_materials_transmission) are left out",
            format!("{}, {share:.2}", material.name),
        );
    } else if share > 0.0 {
        material.base_color *= Vec3::splat(1.0 - share).extend(1.0);
        warnings.add(
            "materials that let up to half of the light through (KHR_materials_transmission) are opaque, and their base \
             colour is darker by that share",
            format!("{}, {share:.2}", material.name),
        );
    }
}

/// Makes the material a mask that discards everything.
fn leave_out(material: &mut Material) {
    material.alpha_cutoff = material.alpha_cutoff.max(0.5);
    material.base_color.w = 0.0;
}

/// KHR_materials_unlit: no reflection; the base colour and its texture become the emission.
pub(super) fn unlit(material: &mut Material) {
    material.emission = material.base_color.truncate();
    material.emission_texture = material.base_color_texture;
    material.lookups.emission = material.lookups.base_color;
    material.tinted_emission = true;
    material.base_color = Vec3::ZERO.extend(material.base_color.w);
    if material.alpha_cutoff == 0.0 {
        material.base_color_texture = None;
    }
    (material.metallic, material.roughness, material.specular) = (0.0, 1.0, 0.0);
}

/// A finite, non-negative colour.
pub(super) fn finite3(color: [f32; 3]) -> Vec3 {
    let color = Vec3::from_array(color);
    if color.is_finite() {
        color.max(Vec3::ZERO)
    } else {
        Vec3::ZERO
    }
}
