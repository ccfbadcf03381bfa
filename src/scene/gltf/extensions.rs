//! What KHR_materials_* say beyond the core, and what of it is left out.

use ::gltf::Material as From;
use glam::Vec3;
use serde_json::Value;

use super::materials::finite3;
use super::means::Means;
use crate::scene::Material;
use crate::scene::warnings::Warnings;

/// What makes an extension matter, 0 by default: without it the material looks as if the extension were not there.
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

/// A warning for each extension of the material that is left out.
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

/// KHR_materials_ior and KHR_materials_specular. Textures count with their mean: nobody else needs a lookup for them.
pub(super) fn specular(
    material: &mut Material,
    from: &From,
    means: &Means,
    warnings: &mut Warnings,
) {
    if let Some(ior) = from.ior() {
        // 0 stands for a surface that reflects everything; what is below 1 is no medium.
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

/// KHR_materials_transmission: a surface is there or it is not. Light is not bent, and takes no colour on.
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
    // Metals let nothing through; where a texture says what is metal, nothing is assumed to be.
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

/// Makes it a mask that cuts everything out.
fn leave_out(material: &mut Material) {
    material.alpha_cutoff = material.alpha_cutoff.max(0.5);
    material.base_color.w = 0.0;
}

/// KHR_materials_unlit: a surface that reflects nothing and emits its base colour, texture and all.
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
