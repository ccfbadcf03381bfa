//! From colours, numbers and maps of a file to a scene material.

use glam::{Vec3, Vec4};

use super::pictures::Asked;
use crate::scene::texture::{Recipe, Requests, Source};
use crate::scene::warnings::Warnings;
use crate::scene::{Lookup, Lookups, Material};

/// A texture and its lookup.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::scene) struct Picture {
    pub image: Source,
    pub lookup: Lookup,
}

/// The textures of a material by kind.
#[derive(Clone, Debug, Default)]
pub(in crate::scene) struct Maps {
    pub color: Option<Picture>,
    /// Opacity: white is opaque.
    pub alpha: Option<Picture>,
    /// Grey roughness.
    pub roughness: Option<Picture>,
    /// Grey metallic.
    pub metallic: Option<Picture>,
    pub normal: Option<Picture>,
    /// Whether the normal map may hold heights.
    pub is_bump: bool,
    pub emission: Option<Picture>,
}

/// A material as a file describes it.
#[derive(Clone, Debug)]
pub(in crate::scene) struct Parts {
    pub name: String,
    pub base_color: Vec3,
    pub opacity: f32,
    /// Alpha cutoff, if the file has one.
    pub cutoff: Option<f32>,
    pub roughness: Option<f32>,
    /// Blinn-Phong exponent, used without a roughness.
    pub exponent: Option<f32>,
    pub metallic: Option<f32>,
    pub emission: Vec3,
    pub maps: Maps,
}

impl Maps {
    fn lookups(&self) -> Lookups {
        let lookup = |first: &Option<Picture>, second: &Option<Picture>| {
            let map = first.as_ref().or(second.as_ref());
            map.map_or(Lookup::default(), |map| map.lookup)
        };
        Lookups {
            base_color: lookup(&self.color, &self.alpha),
            metallic_roughness: lookup(&self.roughness, &self.metallic),
            normal: lookup(&self.normal, &None),
            emission: lookup(&self.emission, &None),
        }
    }
}

fn color_recipe(color: Option<Source>, alpha: Option<Source>, mask: u8) -> Option<Recipe> {
    match (color, alpha) {
        (Some(image), None) => Some(Recipe::Color { image, mask: None }),
        (Some(image), Some(alpha)) if image == alpha => Some(Recipe::Color {
            image,
            mask: Some(mask),
        }),
        (color, Some(alpha)) => Some(Recipe::ColorAndMask { color, alpha, mask }),
        (None, None) => None,
    }
}

impl Parts {
    /// The alpha below which nothing is there.
    pub fn cutoff(&self) -> f32 {
        self.cutoff.unwrap_or(0.5).clamp(0.0, 1.0)
    }

    /// The opacity from 0 to 1. Without a map it is rounded to visible or invisible when drawn, and
    /// intermediate values give a warning.
    pub fn opacity(&self, name: &str, warnings: &mut Warnings) -> f32 {
        let (opacity, cutoff) = (self.opacity.clamp(0.0, 1.0), self.cutoff());
        if self.maps.alpha.is_none() && opacity < 1.0 && cutoff > 0.0 {
            let shown = match opacity < cutoff {
                true => "left out",
                false => "opaque",
            };
            let what = format!("materials with an opacity of {opacity:.2} are {shown}");
            warnings.add(what, name);
        }
        opacity
    }

    /// The material, with its textures requested.
    pub fn build(self, requests: &mut Requests) -> Asked {
        let cutoff = self.cutoff();
        let Parts { name, maps, .. } = self;
        let lookups = maps.lookups();
        let masked = maps.alpha.is_some() || self.opacity < cutoff;
        let mask_by_alpha = maps.color.is_some() && maps.alpha.is_none() && self.cutoff.is_none();
        let file = |map: Option<Picture>| map.map(|map| map.image);
        let mask = (cutoff * 255.0).round() as u8;
        let base_color_texture = color_recipe(file(maps.color), file(maps.alpha), mask);
        let (rough_map, metal_map) = (file(maps.roughness), file(maps.metallic));
        let rough_metal = rough_map.is_some() || metal_map.is_some();
        // A missing factor must not disable its map.
        let own = if metal_map.is_some() { 1.0 } else { 0.0 };
        let metallic = self.metallic.unwrap_or(own);
        let exponent = self.exponent.filter(|_| !rough_metal);
        let roughness = self.roughness;
        let roughness = roughness.unwrap_or_else(|| exponent.map_or(1.0, roughness_of));
        let mut ask = |recipe: Recipe| requests.ask(recipe, &name);
        let base_color_texture = base_color_texture.map(&mut ask);
        let metallic_roughness_texture = rough_metal.then(|| {
            ask(Recipe::RoughnessAndMetallic {
                roughness: rough_map,
                metallic: metal_map,
            })
        });
        let normal_texture = file(maps.normal).map(|image| ask(Recipe::Normal { image }));
        let emission_texture =
            file(maps.emission).map(|image| ask(Recipe::Color { image, mask: None }));
        let material = Material {
            base_color: self.base_color.extend(self.opacity),
            metallic: metallic.clamp(0.0, 1.0),
            roughness: roughness.clamp(0.0, 1.0),
            emission: self.emission,
            alpha_cutoff: if masked { cutoff } else { 0.0 },
            // These formats cannot express it, and windings of old files are unreliable, so nothing
            // is culled.
            two_sided: true,
            base_color_texture,
            metallic_roughness_texture,
            normal_texture,
            emission_texture,
            lookups,
            name,
            ..Material::default()
        };
        Asked {
            material,
            mask_by_alpha,
            is_bump: maps.is_bump,
        }
    }
}

/// The roughness with the same lobe width as an exponent.
fn roughness_of(exponent: f32) -> f32 {
    (2.0 / (exponent.max(0.0) + 2.0)).sqrt()
}

/// The default material. Vertex colours replace its colour.
pub(in crate::scene) fn grey(has_colors: bool) -> Material {
    let base_color = if has_colors {
        Vec4::ONE
    } else {
        Material::default().base_color
    };
    Material {
        base_color,
        two_sided: true,
        ..Material::default()
    }
}
