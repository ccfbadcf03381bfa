//! Materials.

use std::path::Path;

use ::gltf::material::AlphaMode;
use ::gltf::{Document, texture};
use glam::{Vec3, Vec4};

use super::buffers::{self, Buffers};
use super::extensions::{self, finite3};
use super::means::{Means, name};
use super::placing::{Placing, UvSources};
use crate::scene::progress::Progress;
use crate::scene::texture::{Recipe, Requests, Source};
use crate::scene::warnings::Warnings;
use crate::scene::{Material, SceneError};

/// All materials with their coordinate sources; the default material follows if a primitive needs
/// it.
pub(super) fn read(
    document: &Document,
    data: &Buffers,
    folder: &Path,
    warnings: &mut Warnings,
    progress: Progress,
) -> Result<(Vec<Material>, Vec<UvSources>, Requests), SceneError> {
    let mut requests = Requests::default();
    let images: Vec<Source> = document
        .images()
        .map(|image| buffers::image(&image, document, data, folder))
        .collect();
    let means = Means::load(document, &images, warnings, progress)?;
    let mut materials = Vec::new();
    let mut uv_sources = Vec::new();
    for material in document.materials() {
        let (material, uv) = convert(&material, &images, &means, &mut requests, warnings);
        materials.push(material);
        uv_sources.push(uv);
    }
    if document
        .meshes()
        .flat_map(|mesh| mesh.primitives())
        .any(|p| p.material().index().is_none())
    {
        materials.push(Material {
            base_color: Vec4::ONE,
            metallic: 1.0,
            ..Material::default()
        });
        uv_sources.push(UvSources::default());
    }
    Ok((materials, uv_sources, requests))
}

/// Sources of base colour, metallic and roughness.
struct Base<'a> {
    color: Option<texture::Info<'a>>,
    /// Texture of roughness and metallic.
    rough: Option<(texture::Info<'a>, Recipe)>,
    /// The factors.
    material: Material,
}

fn metallic_roughness<'a>(from: &::gltf::Material<'a>, images: &[Source]) -> Base<'a> {
    let pbr = from.pbr_metallic_roughness();
    let material = Material {
        base_color: finite4(pbr.base_color_factor()),
        metallic: pbr.metallic_factor().clamp(0.0, 1.0),
        roughness: pbr.roughness_factor().clamp(0.0, 1.0),
        ..Material::default()
    };
    let rough = pbr.metallic_roughness_texture().map(|t| {
        let image = source(&t, images);
        (t, Recipe::MetallicRoughness { image })
    });
    Base {
        color: pbr.base_color_texture(),
        rough,
        material,
    }
}

/// KHR_materials_pbrSpecularGlossiness as a dielectric with the specular colour as its reflectance.
fn specular_glossiness<'a>(
    from: &::gltf::material::PbrSpecularGlossiness<'a>,
    name: &str,
    images: &[Source],
    means: &Means,
    warnings: &mut Warnings,
) -> Base<'a> {
    let texture = from.specular_glossiness_texture();
    let specular =
        (finite3(from.specular_factor()) * means.color(texture.as_ref()).truncate()).min(Vec3::ONE);
    // Specular reflection is subtracted from the diffuse part.
    let diffuse =
        finite4(from.diffuse_factor()) * Vec3::splat(1.0 - specular.max_element()).extend(1.0);
    let gloss = from.glossiness_factor().clamp(0.0, 1.0);
    if texture.is_some() {
        let what = "of specular colours in textures (KHR_materials_pbrSpecularGlossiness) only the mean is used";
        warnings.add(what, name);
    }
    let rough = texture.map(|t| {
        let image = source(&t, images);
        (
            t,
            Recipe::Glossiness {
                image,
                factor: (gloss * 255.0).round() as u8,
            },
        )
    });
    let material = Material {
        base_color: diffuse,
        roughness: if rough.is_some() { 1.0 } else { 1.0 - gloss },
        ior: 0.0,
        specular_color: specular,
        ..Material::default()
    };
    Base {
        color: from.diffuse_texture(),
        rough,
        material,
    }
}

fn convert(
    from: &::gltf::Material,
    images: &[Source],
    means: &Means,
    requests: &mut Requests,
    warnings: &mut Warnings,
) -> (Material, UvSources) {
    let name = name(from);
    let base = match from.pbr_specular_glossiness() {
        Some(gloss) => specular_glossiness(&gloss, &name, images, means, warnings),
        None => metallic_roughness(from, images),
    };
    let (color, material) = (base.color, base.material);
    let alpha_cutoff = alpha_cutoff(from, material.base_color.w, &name, warnings);
    let mask = (alpha_cutoff > 0.0).then_some((alpha_cutoff * 255.0).round() as u8);
    let lit = !from.unlit();
    let rough = base.rough.filter(|_| lit);
    let normal = from.normal_texture().filter(|_| lit);
    let emission = from.emissive_texture().filter(|_| lit);

    let mut placing = Placing::default();
    let references = [
        color.as_ref().map(|t| placing.add_texture(t)),
        rough.as_ref().map(|(t, _)| placing.add_texture(t)),
        normal.as_ref().and_then(|_| placing.add_normal_map(from)),
        emission.as_ref().map(|t| placing.add_texture(t)),
    ];
    let uv = placing.sources(&name, warnings);
    let strength = from.emissive_strength().unwrap_or(1.0).max(0.0);
    let mut ask = |recipe: Recipe| requests.ask(recipe, &name);
    let tinted = |image, mask| Recipe::Color { image, mask };
    let bumps = normal
        .as_ref()
        .map(|t| images[t.texture().source().index()].clone());
    let mut material = Material {
        emission: finite3(from.emissive_factor().map(|c| c * strength)),
        alpha_cutoff,
        two_sided: from.double_sided(),
        normal_scale: normal.as_ref().map_or(1.0, |n| n.scale()),
        base_color_texture: color.map(|t| ask(tinted(source(&t, images), mask))),
        metallic_roughness_texture: rough.map(|(_, recipe)| ask(recipe)),
        normal_texture: bumps.map(|image| ask(Recipe::Normal { image })),
        emission_texture: emission.map(|t| ask(tinted(source(&t, images), None))),
        lookups: placing.lookups(references, &uv),
        name: name.clone(),
        ..material
    };
    if lit {
        extensions::specular(&mut material, from, means, warnings);
        extensions::transmission(&mut material, from, means, warnings);
        extensions::warn_of_others(from, &name, warnings);
    } else {
        extensions::unlit(&mut material);
    }
    (material, uv)
}

/// The alpha below which a material is a hole; 0 without holes.
fn alpha_cutoff(from: &::gltf::Material, alpha: f32, name: &str, warnings: &mut Warnings) -> f32 {
    let cutoff = match from.alpha_mode() {
        AlphaMode::Opaque => 0.0,
        // Cutoffs above 1 are equivalent.
        AlphaMode::Mask => from.alpha_cutoff().unwrap_or(0.5).clamp(0.0, 2.0),
        AlphaMode::Blend => {
            if alpha < 0.5 {
                let what = "materials that blend with an alpha below 0.5 everywhere are left out";
                warnings.add(what, format!("{name}, {alpha:.2}"));
            } else {
                warnings.add("materials that blend are shown as masks at alpha 0.5", name);
            }
            0.5
        }
    };
    if cutoff > 1.0 {
        warnings.add(
            "materials with an alphaCutoff above 1 cut everything out",
            name,
        );
    }
    cutoff
}

fn source(info: &texture::Info, images: &[Source]) -> Source {
    images[info.texture().source().index()].clone()
}

fn finite4(color: [f32; 4]) -> Vec4 {
    let color = Vec4::from_array(color);
    if color.is_finite() {
        color.clamp(Vec4::ZERO, Vec4::ONE)
    } else {
        Vec4::ONE
    }
}
