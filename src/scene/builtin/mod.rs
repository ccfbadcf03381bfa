//! Built-in scenes: scene files that are compiled into the program.

use super::formats::extensions;

/// Name, description and text of each scene file.
const ALL: &[(&str, &str, &str)] = &[
    (
        "atrium",
        "two-storey courtyard with arcades, coloured cloth, plants and a moving ornament",
        include_str!("atrium.ron"),
    ),
    (
        "cornell",
        "the Cornell box, lit by its emitting quad alone",
        include_str!("cornell.ron"),
    ),
    (
        "furnace",
        "closed box with albedo 0.5 and emission 1 seen from inside: radiance 2 everywhere",
        include_str!("furnace.ron"),
    ),
    (
        "white-sky",
        "white sphere under a white sky: it must vanish",
        include_str!("white-sky.ron"),
    ),
    (
        "thin-walls",
        "slabs of 2, 4 and 8 cm before a bright wall: light must not leak",
        include_str!("thin-walls.ron"),
    ),
    (
        "triangles",
        "needles, obtuse, huge, sub-voxel and diagonal triangles in a 4 m cube",
        include_str!("triangles.ron"),
    ),
    (
        "moving-box",
        "a thin box that crosses a lit room",
        include_str!("moving-box.ron"),
    ),
    (
        "blade",
        "a thin blade that turns before a lit wall",
        include_str!("blade.ron"),
    ),
    (
        "small-quad",
        "a box of 2 m, lit by a quad of 47 x 38 cm close below its ceiling",
        include_str!("small-quad.ron"),
    ),
    (
        "emitters",
        "a dim room with 108 emitters of 1 to 4 cm",
        include_str!("emitters.ron"),
    ),
    (
        "ceiling-panel",
        "an office lit by three panels in its ceiling: wide soft shadows",
        include_str!("ceiling-panel.ron"),
    ),
    (
        "neon-tube",
        "a workshop lit by a tube of 2.6 cm under a reflector and a red one",
        include_str!("neon-tube.ron"),
    ),
    (
        "lampshade",
        "a living room's corner lit by two bulbs of 6 cm in open shades",
        include_str!("lampshade.ron"),
    ),
    (
        "huge-ground",
        "a class room of 12 m on a ground of 220 m: the volume's extent is not the room's",
        include_str!("huge-ground.ron"),
    ),
    (
        "far-away",
        "the same class room 100 km from the origin: coordinates in steps of 8 mm",
        include_str!("far-away.ron"),
    ),
    (
        "pocket",
        "a dollhouse room of 4 mm",
        include_str!("pocket.ron"),
    ),
    (
        "plain",
        "a house of 8 m on a plane of 200 km",
        include_str!("plain.ron"),
    ),
    (
        "blinds",
        "a room lit through slats of 25 mm before its window",
        include_str!("blinds.ron"),
    ),
    (
        "door-ajar",
        "a dark room next to a bright one: light enters through a gap of 25 cm",
        include_str!("door-ajar.ron"),
    ),
    (
        "corridor",
        "a corridor with two bends: light takes many turns from its end to the camera",
        include_str!("corridor.ron"),
    ),
    (
        "street",
        "a street between tall houses with recessed windows and balconies under a grey sky",
        include_str!("street.ron"),
    ),
    (
        "gloss",
        "glossy tiles and a mirror in a room with a window",
        include_str!("gloss.ron"),
    ),
    (
        "foliage",
        "trees and bushes of small leaves, some cut out by a mask",
        include_str!("foliage.ron"),
    ),
    (
        "sky-window",
        "a room that a picture of a clear sky lights through a window, sun and all",
        include_str!("sky-window.ron"),
    ),
    (
        "vases",
        "a hall of fifty vases in relief, a million triangles",
        include_str!("vases.ron"),
    ),
];

/// Names and one-line descriptions of all built-in scenes.
pub fn list() -> impl Iterator<Item = (&'static str, &'static str)> {
    ALL.iter().map(|&(name, about, _)| (name, about))
}

/// Whether a built-in scene has this name.
pub(super) fn is_one(name: &str) -> bool {
    ALL.iter().any(|entry| entry.0 == name)
}

/// The scene file of a built-in scene.
pub(super) fn text(name: &str) -> Option<&'static str> {
    let entry = ALL.iter().find(|entry| entry.0 == name)?;
    Some(entry.2)
}

/// The hint for an unknown name.
pub(super) fn hint(name: &str) -> String {
    let names: Vec<&str> = list().map(|(name, _)| name).collect();
    let nearest = names
        .iter()
        .max_by(|a, b| strsim::jaro_winkler(a, name).total_cmp(&strsim::jaro_winkler(b, name)));
    let near = nearest.filter(|near| strsim::jaro_winkler(near, name) > 0.7);
    let (start, built_in) = match near {
        Some(near) => (format!("did you mean '{near}'? "), "Built-in"),
        None => (String::new(), "built-in"),
    };
    format!(
        "{start}{built_in} scenes: {}; otherwise give a {} file",
        names.join(", "),
        extensions()
    )
}
