//! Conversion of library materials to scene materials.

use glam::Vec3;

use super::library::Definition;
use super::lines::shown;
use super::maps::{Map, Placement, parse};
use crate::scene::phong::{Asked, Finder, Found, Maps, Parts, Picture, Words};
use crate::scene::texture::{Requests, Source};
use crate::scene::warnings::Warnings;
use crate::scene::{Lookup, Material, Wrap};

/// Properties of a material that its faces need.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Surface {
    /// Index in the scene.
    pub material: u32,
    pub placement: Placement,
    /// Whether the material is fully transparent.
    pub left_out: bool,
}

/// The surface of a piece's material.
pub(super) fn surface_of(surfaces: &[Surface], material: Option<u32>) -> Surface {
    material
        .map_or(surfaces.last(), |used| surfaces.get(used as usize))
        .copied()
        .unwrap_or_default()
}

/// A material with the placement of its textures.
#[derive(Debug)]
pub(super) struct Read {
    pub asked: Asked,
    pub placement: Placement,
}

pub(super) const WORDS: Words = Words {
    holes: "the picture of map_Kd has holes in its alpha and there is no map_d: it is a mask at 0.5",
    all_clear: "the alpha of map_Kd is below 0.5 everywhere: it is left out",
    heights: "bump maps that hold heights are left out. Convert them to normal maps, and write 'norm FILE'",
};

/// Finds and requests textures.
pub(super) struct Pictures<'a> {
    pub finder: &'a mut Finder,
    pub requests: &'a mut Requests,
}

struct Reader<'a, 'b> {
    definition: &'a Definition,
    pictures: &'a mut Pictures<'b>,
    warnings: &'a mut Warnings,
}

fn picture((image, map): (Source, Map)) -> Picture {
    let wrap = match map.clamp {
        true => [Wrap::Clamp; 2],
        false => [Wrap::Repeat; 2],
    };
    Picture {
        image,
        lookup: Lookup {
            wrap,
            ..Lookup::default()
        },
    }
}

/// A material from its statements.
pub(super) fn read(
    definition: &Definition,
    pictures: &mut Pictures,
    warnings: &mut Warnings,
) -> Read {
    let name = definition.name.clone();
    let mut reader = Reader {
        definition,
        pictures,
        warnings,
    };
    let [color, alpha, glow] = ["map_kd", "map_d", "map_ke"].map(|key| reader.map(key));
    let [rough, metal] = ["map_pr", "map_pm"].map(|key| reader.map(key));
    let (normal, is_bump) = reader.normal_map();
    let strength = normal.as_ref().and_then(|(_, map)| map.strength);
    let placement = reader.placement([&color, &alpha, &glow, &rough, &metal, &normal]);
    let laid = |map: Option<(Source, Map)>| map.map(picture);
    let maps = Maps {
        color: laid(color),
        alpha: laid(alpha),
        roughness: laid(rough),
        metallic: laid(metal),
        normal: laid(normal),
        is_bump,
        emission: laid(glow),
    };
    let base_color = reader.factor("kd", "map_Kd", maps.color.is_some());
    let emission = reader.factor("ke", "map_Ke", maps.emission.is_some());
    let opacity = reader.number("d");
    let opacity = opacity.or_else(|| reader.number("tr").map(|t| 1.0 - t));
    let mut parts = Parts {
        base_color: base_color.unwrap_or(Vec3::splat(0.8)),
        emission: emission.unwrap_or(Vec3::ZERO),
        opacity: opacity.unwrap_or(1.0),
        cutoff: reader.number("alpha_cutoff"),
        roughness: reader.number("pr"),
        exponent: reader.number("ns"),
        metallic: reader.number("pm"),
        maps,
        name,
    };
    parts.opacity = parts.opacity(&shown(&parts.name), reader.warnings);
    let asked = parts.build(reader.pictures.requests);
    let material = Material {
        ior: reader.number("ior").unwrap_or(1.5).clamp(0.0, 1e6),
        specular: reader.number("specular").unwrap_or(1.0).clamp(0.0, 1.0),
        specular_color: reader.color("specular_color").unwrap_or(Vec3::ONE),
        two_sided: reader.number("two_sided").is_none_or(|v| v != 0.0),
        normal_scale: reader.number("normal_scale").or(strength).unwrap_or(1.0),
        ..asked.material
    };
    Read {
        asked: Asked { material, ..asked },
        placement,
    }
}

impl Reader<'_, '_> {
    fn number(&self, key: &str) -> Option<f32> {
        self.definition.values.get(key)?.parse().ok()
    }

    fn color(&self, key: &str) -> Option<Vec3> {
        let mut numbers = self
            .definition
            .values
            .get(key)?
            .split(' ')
            .map(|word| word.parse().ok());
        Some(Vec3::new(
            numbers.next()??,
            numbers.next()??,
            numbers.next()??,
        ))
    }

    fn warn(&mut self, what: impl Into<String>) {
        self.warnings.add(what, shown(&self.definition.name));
    }

    /// The factor of a map. Many files have a factor of 0 next to a map, and viewers ignore it.
    fn factor(&mut self, key: &str, map: &str, has_map: bool) -> Option<Vec3> {
        let color = self.color(key);
        if !has_map {
            return color;
        }
        if color == Some(Vec3::ZERO) {
            let title = map.trim_start_matches("map_");
            self.warn(format!(
                "{title} is 0 next to {map}: the map is used as it is"
            ));
            return Some(Vec3::ONE);
        }
        color.or(Some(Vec3::ONE))
    }

    /// The file of an entry, with its options.
    fn map(&mut self, key: &str) -> Option<(Source, Map)> {
        let map = parse(self.definition.values.get(key)?)?;
        for option in &map.left_out {
            self.warn(format!("the option {option} of maps is left out"));
        }
        Some((
            Source::File(self.pictures.finder.find(&map.file, self.warnings)),
            map,
        ))
    }

    /// The normal map, and whether it may hold heights: a bump entry is a height map in the format
    /// but a normal map in many files.
    fn normal_map(&mut self) -> (Option<(Source, Map)>, bool) {
        let [norm, other] = ["norm", "map_kn"].map(|key| self.map(key));
        let [bump, other_bump] = ["map_bump", "bump"].map(|key| self.map(key));
        let given = norm.or(other);
        if given.is_some() {
            return (given, false);
        }
        let Some((source, map)) = bump.or(other_bump) else {
            return (None, false);
        };
        // Most bump maps hold heights, so a placeholder with normals would be wrong.
        if self.pictures.finder.look(&map.file).1 == Found::No {
            self.warnings.add(
                "bump maps that are not there are left out",
                shown(&source.name()),
            );
            return (None, false);
        }
        (Some((source, map)), true)
    }

    /// Placement of the textures: vertices have one set of coordinates, so the first map decides.
    fn placement(&mut self, maps: [&Option<(Source, Map)>; 6]) -> Placement {
        let mut placements = maps.into_iter().flatten().map(|(_, map)| map.placement);
        let Some(first) = placements.next() else {
            return Placement::default();
        };
        if placements.any(|placement| placement != first) {
            self.warn(
                "maps of one material have different -s or -o: those of the first (map_Kd, if there is one) are used",
            );
        }
        first
    }
}
