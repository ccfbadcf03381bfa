//! Materials of a library as the scene has them.

use glam::Vec3;

use super::find::{Finder, Found};
use super::library::Definition;
use super::lines::shown;
use super::maps::{Map, Placement, parse};
use crate::scene::texture::{Recipe, Requests, Source};
use crate::scene::warnings::Warnings;
use crate::scene::{Lookup, Lookups, Material, Wrap};

/// What faces need of their material.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Surface {
    /// A number in the scene.
    pub material: u32,
    pub placement: Placement,
    /// Whether nothing of it is there.
    pub left_out: bool,
}

/// The surface of a piece's material.
pub(super) fn surface_of(surfaces: &[Surface], material: Option<u32>) -> Surface {
    material.map_or(surfaces.last(), |used| surfaces.get(used as usize)).copied().unwrap_or_default()
}

/// A material, with questions that its pictures answer.
#[derive(Debug)]
pub(super) struct Read {
    pub material: Material,
    pub placement: Placement,
    /// Whether the alpha of its picture may be a mask: the library has no other.
    pub mask_by_alpha: bool,
    /// Whether its normal map may hold heights.
    pub is_bump: bool,
}

/// Finds pictures and requests them.
pub(super) struct Pictures<'a> {
    pub finder: &'a mut Finder,
    pub requests: &'a mut Requests,
}

struct Reader<'a, 'b> {
    definition: &'a Definition,
    pictures: &'a mut Pictures<'b>,
    warnings: &'a mut Warnings,
}

/// A material from its statements.
pub(super) fn read(definition: &Definition, pictures: &mut Pictures, warnings: &mut Warnings) -> Read {
    let name = definition.name.clone();
    let mut reader = Reader { definition, pictures, warnings };
    let [color, alpha, emission_map] = ["map_kd", "map_d", "map_ke"].map(|key| reader.map(key));
    let [rough_map, metal_map] = ["map_pr", "map_pm"].map(|key| reader.map(key));
    let (normal_map, is_bump) = reader.normal_map();
    let strength = normal_map.as_ref().and_then(|(_, map)| map.strength);
    let placement = reader.placement([&color, &alpha, &emission_map, &rough_map, &metal_map, &normal_map]);
    let lookup = |map: &Option<(Source, Map)>| Lookup {
        wrap: if map.as_ref().is_some_and(|(_, map)| map.clamp) { [Wrap::Clamp; 2] } else { [Wrap::Repeat; 2] },
        ..Lookup::default()
    };
    let lookups = Lookups {
        base_color: lookup(if color.is_some() { &color } else { &alpha }),
        metallic_roughness: lookup(if rough_map.is_some() { &rough_map } else { &metal_map }),
        normal: lookup(&normal_map),
        emission: lookup(&emission_map),
    };
    let file = |map: Option<(Source, Map)>| map.map(|(source, _)| source);
    let (color, alpha, emission_map) = (file(color), file(alpha), file(emission_map));
    let (rough_map, metal_map, normal_map) = (file(rough_map), file(metal_map), file(normal_map));

    let cutoff = reader.number("alpha_cutoff");
    let mask_by_alpha = color.is_some() && alpha.is_none() && cutoff.is_none();
    let cutoff = cutoff.unwrap_or(0.5).clamp(0.0, 1.0);
    let opacity = reader.opacity(alpha.is_some(), cutoff);
    let masked = alpha.is_some() || opacity < cutoff;
    let base_color = reader.factor("kd", "map_Kd", color.is_some()).unwrap_or(Vec3::splat(0.8));
    let emission = reader.factor("ke", "map_Ke", emission_map.is_some()).unwrap_or(Vec3::ZERO);
    let mask = (cutoff * 255.0).round() as u8;
    let base_color_texture = match (color, alpha) {
        (Some(image), None) => Some(Recipe::Color { image, mask: None }),
        (Some(image), Some(alpha)) if image == alpha => Some(Recipe::Color { image, mask: Some(mask) }),
        (color, Some(alpha)) => Some(Recipe::ColorAndMask { color, alpha, mask }),
        (None, None) => None,
    };
    let rough_metal = rough_map.is_some() || metal_map.is_some();
    // A factor that is not given must not switch its map off.
    let metallic = reader.number("pm").unwrap_or(if metal_map.is_some() { 1.0 } else { 0.0 });
    let from_exponent = |ns: f32| {
        if rough_metal { 1.0 } else { (2.0 / (ns.max(0.0) + 2.0)).sqrt() }
    };
    let roughness = reader.number("pr").unwrap_or_else(|| reader.number("ns").map_or(1.0, from_exponent));
    let mut ask = |recipe: Recipe| reader.pictures.requests.ask(recipe, &name);
    let base_color_texture = base_color_texture.map(&mut ask);
    let metallic_roughness_texture =
        rough_metal.then(|| ask(Recipe::RoughnessAndMetallic { roughness: rough_map, metallic: metal_map }));
    let normal_texture = normal_map.map(|image| ask(Recipe::Normal { image }));
    let emission_texture = emission_map.map(|image| ask(Recipe::Color { image, mask: None }));
    let material = Material {
        base_color: base_color.extend(opacity),
        metallic: metallic.clamp(0.0, 1.0),
        roughness: roughness.clamp(0.0, 1.0),
        ior: reader.number("ior").unwrap_or(1.5).clamp(0.0, 1e6),
        specular: reader.number("specular").unwrap_or(1.0).clamp(0.0, 1.0),
        specular_color: reader.color("specular_color").unwrap_or(Vec3::ONE),
        emission,
        alpha_cutoff: if masked { cutoff } else { 0.0 },
        // OBJ cannot say; windings of old files are unreliable, so nothing may be culled.
        two_sided: reader.number("two_sided").is_none_or(|v| v != 0.0),
        normal_scale: reader.number("normal_scale").or(strength).unwrap_or(1.0),
        base_color_texture,
        metallic_roughness_texture,
        normal_texture,
        emission_texture,
        lookups,
        name,
        ..Material::default()
    };
    Read { material, placement, mask_by_alpha, is_bump }
}

impl Reader<'_, '_> {
    fn number(&self, key: &str) -> Option<f32> {
        self.definition.values.get(key)?.parse().ok()
    }

    fn color(&self, key: &str) -> Option<Vec3> {
        let mut numbers = self.definition.values.get(key)?.split(' ').map(|word| word.parse().ok());
        Some(Vec3::new(numbers.next()??, numbers.next()??, numbers.next()??))
    }

    fn warn(&mut self, what: impl Into<String>) {
        self.warnings.add(what, shown(&self.definition.name));
    }

    /// The factor of a map. Viewers take a map as it is, and many files have a factor of 0 next to one.
    fn factor(&mut self, key: &str, map: &str, has_map: bool) -> Option<Vec3> {
        let color = self.color(key);
        if !has_map {
            return color;
        }
        if color == Some(Vec3::ZERO) {
            let title = map.trim_start_matches("map_");
            self.warn(format!("{title} is 0 next to {map}: the map is used as it is"));
            return Some(Vec3::ONE);
        }
        color.or(Some(Vec3::ONE))
    }

    /// `d`, or the rest of `Tr`. Without a map the surface is there, or it is not.
    fn opacity(&mut self, has_map: bool, cutoff: f32) -> f32 {
        let opacity = self.number("d").or_else(|| self.number("tr").map(|t| 1.0 - t));
        let opacity = opacity.unwrap_or(1.0).clamp(0.0, 1.0);
        if !has_map && opacity < 1.0 && cutoff > 0.0 {
            let shown = if opacity < cutoff { "left out" } else { "opaque" };
            self.warn(format!("materials with an opacity of {opacity:.2} are {shown}"));
        }
        opacity
    }

    /// The file of an entry, with its options.
    fn map(&mut self, key: &str) -> Option<(Source, Map)> {
        let map = parse(self.definition.values.get(key)?)?;
        for option in &map.left_out {
            self.warn(format!("the option {option} of maps is left out"));
        }
        Some((Source::File(self.pictures.finder.find(&map.file, self.warnings)), map))
    }

    /// The normal map, and whether it may hold heights: a bump entry is a height map by the format, and a normal map in
    /// many files.
    fn normal_map(&mut self) -> (Option<(Source, Map)>, bool) {
        let [norm, other] = ["norm", "map_kn"].map(|key| self.map(key));
        let [bump, other_bump] = ["map_bump", "bump"].map(|key| self.map(key));
        let given = norm.or(other);
        if given.is_some() {
            return (given, false);
        }
        let Some((source, map)) = bump.or(other_bump) else { return (None, false) };
        // Most bump maps hold heights: a checkerboard of normals would be wrong.
        if self.pictures.finder.look(&map.file).1 == Found::No {
            self.warnings.add("bump maps that are not there are left out", shown(&source.name()));
            return (None, false);
        }
        (Some((source, map)), true)
    }

    /// Where pictures are: vertices have one set of coordinates, so that the first map decides.
    fn placement(&mut self, maps: [&Option<(Source, Map)>; 6]) -> Placement {
        let mut placements = maps.into_iter().flatten().map(|(_, map)| map.placement);
        let Some(first) = placements.next() else { return Placement::default() };
        if placements.any(|placement| placement != first) {
            self.warn(
                "maps of one material have different -s or -o: those of the first (map_Kd, if there is one) are used",
            );
        }
        first
    }
}
