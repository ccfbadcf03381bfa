//! The texture coordinates of materials.

use ::gltf::json::extensions::texture::TextureTransform;
use ::gltf::texture::{MagFilter, Sampler, WrappingMode};
use ::gltf::{Material, texture};
use glam::{Affine2, Vec2};

use crate::scene::coordinates::References;
use crate::scene::{Lookup, Lookups, Wrap};

/// A coordinate set of the file and a transform that is baked into the vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct UvSource {
    pub set: u32,
    pub transform: Affine2,
}

impl Default for UvSource {
    fn default() -> Self {
        UvSource {
            set: 0,
            transform: Affine2::IDENTITY,
        }
    }
}

impl UvSource {
    fn of(info: &texture::Info) -> UvSource {
        let Some(t) = info.texture_transform() else {
            return UvSource {
                set: info.tex_coord(),
                ..UvSource::default()
            };
        };
        UvSource {
            set: t.tex_coord().unwrap_or(info.tex_coord()),
            transform: placed(t.offset(), t.rotation(), t.scale()),
        }
    }

    /// Source of a normal map; the crate does not read its transform.
    fn of_normal_map(material: &Material) -> Option<UvSource> {
        let map = material.normal_texture()?;
        let json = map.extension_value("KHR_texture_transform").cloned();
        let transform: Option<TextureTransform> = json.and_then(|t| serde_json::from_value(t).ok());
        Some(match transform {
            None => UvSource {
                set: map.tex_coord(),
                ..UvSource::default()
            },
            Some(t) => UvSource {
                set: t.tex_coord.unwrap_or(map.tex_coord()),
                transform: placed(t.offset.0, t.rotation.0, t.scale.0),
            },
        })
    }
}

/// KHR_texture_transform rotates counter-clockwise in a frame with v pointing down.
fn placed(offset: [f32; 2], rotation: f32, scale: [f32; 2]) -> Affine2 {
    Affine2::from_scale_angle_translation(
        Vec2::from_array(scale),
        -rotation,
        Vec2::from_array(offset),
    )
}

/// The coordinate sources of a material's vertices.
pub(super) type UvSources = crate::scene::coordinates::UvSources<UvSource>;

/// Textures of a material with their coordinate sources and samplers.
pub(super) type Placing = References<UvSource>;

impl Placing {
    /// Adds a texture and returns its index.
    pub fn add_texture(&mut self, info: &texture::Info) -> usize {
        self.add(UvSource::of(info), lookup(&info.texture().sampler()))
    }

    /// The lookups of base colour, metallic and roughness, normals and emission.
    pub fn lookups(&self, references: [Option<usize>; 4], uv: &UvSources) -> Lookups {
        let [base_color, metallic_roughness, normal, emission] =
            references.map(|reference| self.lookup(reference, uv));
        Lookups {
            base_color,
            metallic_roughness,
            normal,
            emission,
        }
    }

    /// Adds the normal map of a material that has one.
    pub fn add_normal_map(&mut self, material: &Material) -> Option<usize> {
        let sampler = material.normal_texture()?.texture().sampler();
        Some(self.add(UvSource::of_normal_map(material)?, lookup(&sampler)))
    }
}

fn lookup(sampler: &Sampler) -> Lookup {
    Lookup {
        wrap: [wrap(sampler.wrap_s()), wrap(sampler.wrap_t())],
        nearest: sampler.mag_filter() == Some(MagFilter::Nearest),
        ..Lookup::default()
    }
}

fn wrap(mode: WrappingMode) -> Wrap {
    match mode {
        WrappingMode::Repeat => Wrap::Repeat,
        WrappingMode::ClampToEdge => Wrap::Clamp,
        WrappingMode::MirroredRepeat => Wrap::Mirror,
    }
}
