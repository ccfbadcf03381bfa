//! Glossy tiles, a mirror and metal by the light of one window: what a cone of one direction has to get right.

use glam::{Vec2, Vec3};

use super::shapes::{MeshBuilder, STANDING};
use super::solid::{Solid, lining};
use super::{assemble, matte, sun, view};
use crate::scene::{Material, Scene};

const WALL: u32 = 0;
const FRAME: u32 = 1;
const MIRROR: u32 = 2;
const RED: u32 = 3;
const BLUE: u32 = 4;
const GREEN: u32 = 5;
const GOLD: u32 = 6;
/// The first of three roughnesses of tiles.
const TILES: u32 = 7;

pub(super) fn build() -> Scene {
    let glossy = |name: &str, color: Vec3, roughness: f32| Material { roughness, ..matte(name, color) };
    let materials = vec![
        matte("wall", Vec3::new(0.74, 0.7, 0.64)),
        matte("frame", Vec3::new(0.3, 0.22, 0.16)),
        Material { metallic: 1.0, ..glossy("mirror", Vec3::splat(0.9), 0.05) },
        glossy("red", Vec3::new(0.7, 0.09, 0.07), 0.25),
        matte("blue", Vec3::new(0.1, 0.22, 0.7)),
        matte("green", Vec3::new(0.15, 0.55, 0.2)),
        Material { metallic: 1.0, ..glossy("gold", Vec3::new(0.95, 0.7, 0.32), 0.2) },
        glossy("dark tiles", Vec3::new(0.2, 0.2, 0.22), 0.1),
        glossy("brown tiles", Vec3::new(0.36, 0.28, 0.22), 0.2),
        glossy("light tiles", Vec3::new(0.6, 0.58, 0.55), 0.3),
    ];
    let mut solid = Solid::default();
    solid.fill(Vec3::new(-3.2, -0.3, -3.2), Vec3::new(3.2, 3.2, 3.2), WALL);
    // The tiles are 1 cm above what is carved.
    solid.carve(Vec3::new(-3.0, -0.01, -3.0), Vec3::new(3.0, 3.0, 3.0), lining(WALL, WALL, WALL));
    solid.carve(Vec3::new(-3.2, 0.5, -1.8), Vec3::new(-3.0, 2.6, 1.4), [WALL; 6]);
    let mut room = MeshBuilder::new("room");
    solid.build(&mut room);
    let mut tiles = MeshBuilder::new("tiles");
    for (i, j) in (0..10u8).flat_map(|i| (0..10u8).map(move |j| (i, j))) {
        let low = Vec3::new(0.6 * f32::from(i) - 3.0, -0.02, 0.6 * f32::from(j) - 3.0);
        let high = low + Vec3::new(0.596, 0.02, 0.596);
        tiles.cuboid(TILES + u32::from(i + 2 * j) % 3, low, high, 1.0, STANDING);
    }
    let mut things = MeshBuilder::new("things");
    things.cuboid(FRAME, Vec3::new(-1.5, 0.25, -3.01), Vec3::new(1.7, 2.55, -2.97), 1.0, [true; 6]);
    things.cuboid(MIRROR, Vec3::new(-1.4, 0.35, -3.01), Vec3::new(1.6, 2.45, -2.95), 1.0, [true; 6]);
    things.cuboid(BLUE, Vec3::new(0.9, 0.0, -1.9), Vec3::new(1.6, 1.3, -1.2), 1.0, STANDING);
    things.cuboid(GREEN, Vec3::new(-2.4, 0.0, -2.4), Vec3::new(-1.9, 0.9, -1.9), 1.0, STANDING);
    things.icosphere(RED, Vec3::new(-0.7, 0.45, -1.2), 0.45, 4);
    things.icosphere(GOLD, Vec3::new(0.35, 0.35, -0.3), 0.35, 4);
    let vase = [(0.0, 0.0), (0.18, 0.0), (0.26, 0.3), (0.1, 0.6), (0.15, 0.8)].map(|(r, y)| Vec2::new(r, y));
    things.transform = glam::Mat4::from_translation(Vec3::new(-1.6, 0.0, -0.4));
    things.lathe(RED, 32, 24, 1.0, &vase);
    let mut scene = assemble("gloss", materials, vec![room.finish(), tiles.finish(), things.finish()]);
    scene.lights.push(sun(Vec3::new(26.0, 23.5, 20.0), Vec3::new(0.72, -0.6, -0.3)));
    scene.sky = Vec3::new(2.4, 3.0, 3.8);
    scene.cameras.insert("default".into(), view(Vec3::new(0.9, 1.55, 2.8), Vec3::new(-0.2, 0.8, -1.6), 62.0, 9.6));
    scene.cameras.insert("floor".into(), view(Vec3::new(-0.4, 0.6, 2.6), Vec3::new(0.0, 0.3, -1.5), 55.0, 9.6));
    scene
}
