//! Which texture coordinates a material reads, and how.

use ::gltf::json::extensions::texture::TextureTransform;
use ::gltf::texture::{MagFilter, Sampler, WrappingMode};
use ::gltf::{Material, texture};
use glam::{Affine2, Vec2};

use crate::scene::{Lookup, Wrap};

/// Texture coordinates: a set of the file, and a transform that is baked into the vertices.
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

impl UvSource {
    fn of(info: &texture::Info) -> UvSource {
        let Some(t) = info.texture_transform() else {
            return UvSource { set: info.tex_coord(), ..UvSource::default() };
        };
        UvSource {
            set: t.tex_coord().unwrap_or(info.tex_coord()),
            transform: placed(t.offset(), t.rotation(), t.scale()),
        }
    }

    /// Of a normal map, whose transform the crate does not read.
    fn of_normal_map(material: &Material) -> Option<UvSource> {
        let map = material.normal_texture()?;
        let json = map.extension_value("KHR_texture_transform").cloned();
        let transform: Option<TextureTransform> = json.and_then(|t| serde_json::from_value(t).ok());
        Some(match transform {
            None => UvSource { set: map.tex_coord(), ..UvSource::default() },
            Some(t) => UvSource {
                set: t.tex_coord.unwrap_or(map.tex_coord()),
                transform: placed(t.offset.0, t.rotation.0, t.scale.0),
            },
        })
    }
}

/// KHR_texture_transform turns counter-clockwise in a frame whose v points down.
fn placed(offset: [f32; 2], rotation: f32, scale: [f32; 2]) -> Affine2 {
    Affine2::from_scale_angle_translation(Vec2::from_array(scale), -rotation, Vec2::from_array(offset))
}

/// The two kinds of texture coordinates that the vertices of a material have.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct UvSources {
    pub first: UvSource,
    pub second: Option<UvSource>,
}

/// Texture references of a material: where each takes its coordinates from, and its sampler.
#[derive(Default)]
pub(super) struct Placing<'a> {
    references: Vec<(UvSource, Sampler<'a>)>,
}

impl<'a> Placing<'a> {
    /// Adds a reference and gives its number.
    pub fn add(&mut self, info: &texture::Info<'a>) -> usize {
        self.references.push((UvSource::of(info), info.texture().sampler()));
        self.references.len() - 1
    }

    /// Adds the normal map of a material that has one.
    pub fn add_normal_map(&mut self, material: &Material<'a>) -> Option<usize> {
        let sampler = material.normal_texture()?.texture().sampler();
        self.references.push((UvSource::of_normal_map(material)?, sampler));
        Some(self.references.len() - 1)
    }

    /// The two sources that most references take, those of earlier ones first; and whether others are left out.
    pub fn sources(&self) -> (UvSources, bool) {
        let mut counts: Vec<(UvSource, usize)> = Vec::new();
        for (source, _) in &self.references {
            match counts.iter_mut().find(|(known, _)| known == source) {
                Some((_, count)) => *count += 1,
                None => counts.push((*source, 1)),
            }
        }
        // The sort is stable.
        counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        let mut sources = counts.iter().map(|(source, _)| *source);
        let found = UvSources { first: sources.next().unwrap_or_default(), second: sources.next() };
        (found, sources.next().is_some())
    }

    /// How a reference is looked up; one of a third source takes the first.
    pub fn lookup(&self, reference: Option<usize>, sources: &UvSources) -> Lookup {
        let Some((source, sampler)) = reference.and_then(|i| self.references.get(i)) else { return Lookup::default() };
        Lookup {
            wrap: [wrap(sampler.wrap_s()), wrap(sampler.wrap_t())],
            nearest: sampler.mag_filter() == Some(MagFilter::Nearest),
            second_set: sources.second.as_ref() == Some(source),
        }
    }
}

fn wrap(mode: WrappingMode) -> Wrap {
    match mode {
        WrappingMode::Repeat => Wrap::Repeat,
        WrappingMode::ClampToEdge => Wrap::Clamp,
        WrappingMode::MirroredRepeat => Wrap::Mirror,
    }
}
