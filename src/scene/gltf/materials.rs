//! Materials, and which texture coordinates each of them reads.

use std::path::Path;

use ::gltf::material::AlphaMode;
use ::gltf::{Document, texture};
use glam::{Affine2, Vec2, Vec3, Vec4};

use super::buffers;
use crate::scene::Material;
use crate::scene::texture::{Recipe, Requests, Source};

/// The texture coordinates of a material: a set, and a transform that is baked into the vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct UvSource {
    pub set: u32,
    pub transform: Affine2,
}

impl Default for UvSource {
    fn default() -> Self {
        UvSource { set: 0, transform: Affine2::IDENTITY }
    }
}

/// All materials, and after them the default one where a primitive has none.
pub(super) fn read(
    document: &Document,
    data: &[Vec<u8>],
    folder: &Path,
    warnings: &mut Vec<String>,
) -> (Vec<Material>, Vec<UvSource>, Requests) {
    let mut requests = Requests::default();
    let images: Vec<Source> = document.images().map(|image| buffers::image(&image, document, data, folder)).collect();
    let mut materials = Vec::new();
    let mut uv_sources = Vec::new();
    for material in document.materials() {
        let (material, uv) = convert(&material, &images, &mut requests, warnings);
        materials.push(material);
        uv_sources.push(uv);
    }
    if document.meshes().flat_map(|mesh| mesh.primitives()).any(|p| p.material().index().is_none()) {
        materials.push(Material { base_color: Vec4::ONE, ..Material::default() });
        uv_sources.push(UvSource::default());
    }
    (materials, uv_sources, requests)
}

fn convert(
    from: &::gltf::Material,
    images: &[Source],
    requests: &mut Requests,
    warnings: &mut Vec<String>,
) -> (Material, UvSource) {
    let index = from.index().unwrap_or_default();
    let name = from.name().map_or_else(|| format!("material {index}"), str::to_owned);
    let pbr = from.pbr_metallic_roughness();
    let image = |texture: ::gltf::Texture| images[texture.source().index()].clone();

    let alpha_cutoff = match from.alpha_mode() {
        AlphaMode::Opaque => 0.0,
        AlphaMode::Mask => from.alpha_cutoff().unwrap_or(0.5).clamp(0.0, 1.0),
        AlphaMode::Blend => {
            warnings.push(format!("material '{name}' blends, which is shown as a mask at alpha 0.5"));
            0.5
        }
    };
    let mask = (alpha_cutoff > 0.0).then_some((alpha_cutoff * 255.0).round() as u8);
    let color = pbr.base_color_texture();
    let rough = pbr.metallic_roughness_texture();
    let normal = from.normal_texture();
    let emission = from.emissive_texture();

    // Vertices carry one set of coordinates; the most visible texture decides which. The transform of a normal map
    // cannot be read; exporters give all maps of a material the same.
    let placed: Vec<UvSource> = [&color, &rough, &emission].into_iter().flatten().map(uv_source).collect();
    let normal_set = normal.as_ref().map(|n| n.tex_coord());
    let only_normal = UvSource { set: normal_set.unwrap_or(0), ..UvSource::default() };
    let uv = placed.first().copied().unwrap_or(only_normal);
    if placed.iter().any(|other| *other != uv) || normal_set.is_some_and(|set| set != uv.set) {
        warnings.push(format!("material '{name}' places its textures differently; all are placed like the first"));
    }

    let emission_strength = from.emissive_strength().unwrap_or(1.0);
    let mut ask = |recipe: Recipe| requests.ask(recipe, &name);
    let material = Material {
        base_color: finite4(pbr.base_color_factor()),
        metallic: pbr.metallic_factor().clamp(0.0, 1.0),
        roughness: pbr.roughness_factor().clamp(0.0, 1.0),
        emission: finite3(from.emissive_factor()) * emission_strength.max(0.0),
        alpha_cutoff,
        two_sided: from.double_sided(),
        normal_scale: normal.as_ref().map_or(1.0, |n| n.scale()),
        base_color_texture: color.map(|t| ask(Recipe::Color { image: image(t.texture()), mask })),
        metallic_roughness_texture: rough.map(|t| ask(Recipe::MetallicRoughness { image: image(t.texture()) })),
        normal_texture: normal.map(|t| ask(Recipe::Normal { image: image(t.texture()) })),
        emission_texture: emission.map(|t| ask(Recipe::Color { image: image(t.texture()), mask: None })),
        name: name.clone(),
        ..Material::default()
    };
    (material, uv)
}

fn uv_source(info: &texture::Info) -> UvSource {
    let Some(transform) = info.texture_transform() else {
        return UvSource { set: info.tex_coord(), ..UvSource::default() };
    };
    // KHR_texture_transform turns counter-clockwise in a frame whose v points down.
    let placed = Affine2::from_scale_angle_translation(
        Vec2::from_array(transform.scale()),
        -transform.rotation(),
        Vec2::from_array(transform.offset()),
    );
    UvSource { set: transform.tex_coord().unwrap_or(info.tex_coord()), transform: placed }
}

fn finite3(color: [f32; 3]) -> Vec3 {
    let color = Vec3::from_array(color);
    if color.is_finite() { color.max(Vec3::ZERO) } else { Vec3::ZERO }
}

fn finite4(color: [f32; 4]) -> Vec4 {
    let color = Vec4::from_array(color);
    if color.is_finite() { color.clamp(Vec4::ZERO, Vec4::ONE) } else { Vec4::ONE }
}
