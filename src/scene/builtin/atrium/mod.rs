//! A two-storey courtyard with arcades, in the spirit of Sponza: sun through an open roof onto light stone and
//! strongly coloured cloth. About 30 x 14 x 12 m; x is the long axis, the court's floor is y = 0.
//!
//! No two faces lie in one plane where they overlap: pieces reach into each other or leave out hidden faces.

mod arcade;
mod cloth;
mod ironwork;
mod materials;
mod ornament;
mod plants;
mod shell;

use std::f32::consts::TAU;

use glam::{Mat4, Quat, Vec3};

use super::{assemble, sun, view};
use crate::scene::{Animation, Instance, Keyframe, Scene};

/// Half the distance between the rows of columns along x and along z.
const COURT: [f32; 2] = [11.0, 3.2];
/// Inner faces of the outer walls.
const WALL: [f32; 2] = [14.8, 6.8];
/// Bays between columns on a long and on a short side.
const BAYS: [u32; 2] = [8, 3];
/// Floor of the arcades, one step above the court.
const ARCADE_FLOOR: f32 = 0.15;
/// Where the arches of the ground floor spring.
const LOWER_SPRING: f32 = 3.2;
/// Floor of the gallery.
const GALLERY_FLOOR: f32 = 5.0;
/// Where the arches of the gallery spring.
const UPPER_SPRING: f32 = 7.35;
/// Top of the gallery's arches' wall, under the cornice.
const WALL_TOP: f32 = 9.1;
/// Centre of the floating ornament's path.
const ORNAMENT: Vec3 = Vec3::new(0.0, 2.55, 0.0);

pub(super) fn build() -> Scene {
    let (materials, textures) = materials::all();
    let meshes = vec![
        shell::floors(),
        shell::walls(),
        shell::roof(),
        shell::trim(),
        arcade::arches(),
        arcade::vaults(),
        arcade::railings(),
        cloth::banners(),
        cloth::curtains(),
        ironwork::chains(),
        ironwork::lanterns(),
        ornament::fountain(),
        plants::pots(),
        plants::foliage(),
        arcade::lower_column(),
        arcade::upper_column(),
        ornament::armillary(),
    ];
    let mut scene = assemble("atrium", materials, meshes);
    scene.textures = textures;
    place_columns(&mut scene);
    if let Some(ornament) = scene.instances.iter_mut().find(|i| i.name == "armillary sphere") {
        ornament.animation = Some(floating());
    }
    scene.lights.push(sun(Vec3::new(14.0, 12.6, 10.4), Vec3::new(-0.34, -0.88, 0.30)));
    scene.sky = Vec3::new(0.50, 0.68, 0.95);
    let diagonal = 35.0;
    for (name, eye, target, fov) in [
        ("default", Vec3::new(9.6, 1.9, -1.15), Vec3::new(-6.0, 3.35, 0.7), 60.0),
        ("gallery", Vec3::new(10.55, 6.75, 0.95), Vec3::new(-6.0, 3.3, -0.5), 60.0),
        ("arcade", Vec3::new(-9.4, 1.75, 5.0), Vec3::new(6.0, 2.2, 4.3), 58.3),
        ("fountain", Vec3::new(3.6, 1.6, 1.9), Vec3::new(-0.4, 1.9, -0.3), 50.0),
    ] {
        scene.cameras.insert(name.into(), view(eye, target, fov, diagonal));
    }
    scene
}

/// Turns the single column of each storey into one instance per place.
fn place_columns(scene: &mut Scene) {
    for (name, floor) in [("lower column", ARCADE_FLOOR), ("upper column", GALLERY_FLOOR)] {
        let Some(index) = scene.instances.iter().position(|i| i.name == name) else {
            continue;
        };
        let mesh = scene.instances.remove(index).mesh;
        for (i, place) in column_places().into_iter().enumerate() {
            scene.instances.push(Instance {
                name: format!("{name} {}", i + 1),
                mesh,
                transform: Mat4::from_translation(place + Vec3::Y * floor),
                animation: None,
            });
        }
    }
}

/// Feet of all columns, around the court.
fn column_places() -> Vec<Vec3> {
    sides().into_iter().flat_map(|(a, b, bays)| (0..bays).map(move |i| a.lerp(b, i as f32 / bays as f32))).collect()
}

/// The four sides of the court: from corner to corner, counter-clockwise seen from above, and their bays.
/// The arcade is to the right of the way along a side.
fn sides() -> [(Vec3, Vec3, u32); 4] {
    let [x, z] = COURT;
    let corner = |sx: f32, sz: f32| Vec3::new(sx * x, 0.0, sz * z);
    let (a, b, c, d) = (corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0), corner(-1.0, -1.0));
    [(a, b, BAYS[0]), (b, c, BAYS[1]), (c, d, BAYS[0]), (d, a, BAYS[1])]
}

/// Each bay of a side: its two columns and the horizontal direction out of the court.
fn bays() -> Vec<(Vec3, Vec3, Vec3)> {
    let mut bays = Vec::new();
    for (a, b, count) in sides() {
        let outward = (b - a).normalize().cross(Vec3::Y);
        let at = |i: u32| a.lerp(b, i as f32 / count as f32);
        bays.extend((0..count).map(|i| (at(i), at(i + 1), outward)));
    }
    bays
}

/// One slow turn with a rise and fall, in quarters so that no step exceeds half a turn.
fn floating() -> Animation {
    let keyframes = (0..=8).map(|i| {
        let turn = i as f32 / 8.0;
        Keyframe {
            time: 12.0 * turn,
            translation: ORNAMENT + Vec3::Y * (0.25 * (turn * TAU).sin()),
            rotation: Quat::from_rotation_y(turn * TAU),
        }
    });
    Animation { keyframes: keyframes.collect(), repeat: true }
}
