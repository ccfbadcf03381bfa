//! Scenes that need no file: built by code, the same every time.

mod atrium;
mod classroom;
mod cornell;
mod fittings;
mod foliage;
mod furnace;
mod gloss;
mod lamps;
mod moving;
mod noise;
mod openings;
mod patterns;
mod scales;
pub(super) mod shapes;
mod sky_window;
mod solid;
mod street;
mod thin_walls;
mod triangles;
mod vases;
mod white_sky;

use glam::{Mat4, Vec3};

use super::mesh::{RawMesh, prepare_all};
use super::progress::{Progress, Watch};
use super::{Camera, Instance, Light, LightKind, Material, Mesh, Scene, defaults};

type Build = fn() -> Scene;

const ALL: &[(&str, &str, Build)] = &[
    ("atrium", "two-storey courtyard with arcades, coloured cloth, plants and a moving ornament", atrium::build),
    ("cornell", "the Cornell box, lit by its emitting quad alone", cornell::build),
    ("furnace", "closed box with albedo 0.5 and emission 1 seen from inside: radiance 2 everywhere", furnace::build),
    ("white-sky", "white sphere under a white sky: it must vanish", white_sky::build),
    ("thin-walls", "slabs of 2, 4 and 8 cm before a bright wall: light must not leak", thin_walls::build),
    ("triangles", "needles, obtuse, huge, sub-voxel and diagonal triangles in a 4 m cube", triangles::build),
    ("moving-box", "a thin box that crosses a lit room", moving::thin_box),
    ("blade", "a thin blade that turns before a lit wall", moving::blade),
    ("small-quad", "a box of 2 m, lit by a quad of 47 x 38 cm close below its ceiling", lamps::small_quad),
    ("emitters", "a dim room with 108 emitters of 1 to 4 cm", lamps::emitters),
    ("ceiling-panel", "an office lit by three panels in its ceiling: wide soft shadows", fittings::ceiling_panel),
    ("neon-tube", "a workshop lit by a tube of 2.6 cm under a reflector and a red one", fittings::neon_tube),
    ("lampshade", "a living room's corner lit by two bulbs of 6 cm in open shades", fittings::lampshade),
    (
        "huge-ground",
        "a class room of 12 m on a ground of 220 m: the volume's extent is not the room's",
        classroom::huge_ground,
    ),
    ("far-away", "the same class room 100 km from the origin: coordinates in steps of 8 mm", classroom::far_away),
    ("pocket", "a dollhouse room of 4 mm", scales::pocket),
    ("plain", "a house of 8 m on a plane of 200 km", scales::plain),
    ("blinds", "a room lit through slats of 25 mm before its window", openings::blinds),
    ("door-ajar", "a dark room beside a bright one: light comes through a gap of 25 cm", openings::door_ajar),
    ("corridor", "a corridor with two bends: light takes many turns from its end to the camera", openings::corridor),
    ("street", "a street between tall houses with recessed windows and balconies under a grey sky", street::build),
    ("gloss", "glossy tiles and a mirror in a room with a window", gloss::build),
    ("foliage", "trees and bushes of small leaves, some cut out by a mask", foliage::build),
    ("sky-window", "a room that a picture of a clear sky lights through a window, sun and all", sky_window::build),
    ("vases", "a hall of fifty vases in relief, a million triangles", vases::build),
];

/// Names and one-line descriptions of all built-in scenes.
pub fn list() -> impl Iterator<Item = (&'static str, &'static str)> {
    ALL.iter().map(|&(name, about, _)| (name, about))
}

/// The function that builds a scene.
pub(super) fn find(name: &str) -> Option<Build> {
    ALL.iter().find(|entry| entry.0 == name).map(|entry| entry.2)
}

/// What to say about a name that is none of them.
pub(super) fn hint(name: &str) -> String {
    let names: Vec<&str> = list().map(|(name, _)| name).collect();
    let nearest = names.iter().max_by(|a, b| strsim::jaro_winkler(a, name).total_cmp(&strsim::jaro_winkler(b, name)));
    let all = names.join(", ");
    match nearest {
        Some(near) if strsim::jaro_winkler(near, name) > 0.7 => {
            format!("did you mean '{near}'? Built-in scenes: {all}; otherwise give a .ron, .obj, .gltf or .glb file")
        }
        _ => format!("built-in scenes: {all}; otherwise give a .ron, .obj, .gltf or .glb file"),
    }
}

/// A scene of meshes at rest, one instance each. Panics on a mistake in a built-in's code.
fn assemble(name: &str, materials: Vec<Material>, meshes: Vec<Mesh>) -> Scene {
    let raw = meshes.into_iter().map(|mesh| RawMesh { mesh, has_normals: true, has_tangents: false }).collect();
    let watch = Watch::new(name);
    let (meshes, _) = prepare_all(raw, &materials, Progress::new(&watch)).expect("built-in meshes are valid");
    let instances = meshes.iter().enumerate().map(|(i, mesh)| Instance {
        name: mesh.name.clone(),
        mesh: i as u32,
        transform: Mat4::IDENTITY,
        animation: None,
    });
    Scene { name: name.into(), instances: instances.collect(), meshes, materials, ..Scene::default() }
}

/// A view with a near plane for a scene of the given diagonal.
fn view(eye: Vec3, target: Vec3, fov_y: f32, diagonal: f32) -> Camera {
    Camera { eye, target, up: Vec3::Y, fov_y, near: defaults::near_plane(diagonal), far: f32::INFINITY }
}

/// A plain dielectric material.
fn matte(name: &str, color: Vec3) -> Material {
    Material { name: name.into(), base_color: color.extend(1.0), ..Material::default() }
}

/// A sun that casts shadows; the direction is the way its light travels.
fn sun(color: Vec3, direction: Vec3) -> Light {
    Light {
        name: "sun".into(),
        kind: LightKind::Directional,
        color,
        position: Vec3::ZERO,
        direction: direction.normalize(),
        shadow: true,
    }
}
