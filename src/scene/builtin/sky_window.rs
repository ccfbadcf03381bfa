//! A room that a picture of the sky alone lights, through a window.

use glam::Vec3;

use super::shapes::{MeshBuilder, STANDING};
use super::solid::{Solid, lining};
use super::{assemble, matte, view};
use crate::scene::Scene;
use crate::scene::environment::clear_sky;

const WALL: u32 = 0;
const FLOOR: u32 = 1;
const WOOD: u32 = 2;
const WHITE: u32 = 3;
const BLUE: u32 = 4;

/// Texels around the sky's picture: the sun's disc is one and a half of them wide.
const WIDTH: u32 = 1024;

/// A closed room of 4 x 2.8 x 5 m with a window of 1.8 x 1.4 m. The sun shines through it onto the floor.
pub(super) fn build() -> Scene {
    let materials = vec![
        matte("wall", Vec3::new(0.78, 0.76, 0.72)),
        matte("floor", Vec3::new(0.5, 0.38, 0.26)),
        matte("wood", Vec3::new(0.5, 0.32, 0.18)),
        matte("white", Vec3::splat(0.8)),
        matte("blue", Vec3::new(0.2, 0.32, 0.62)),
    ];
    let mut solid = Solid::default();
    solid.fill(Vec3::new(-2.2, -0.2, -2.7), Vec3::new(2.2, 3.0, 2.7), WALL);
    solid.carve(Vec3::new(-2.0, 0.0, -2.5), Vec3::new(2.0, 2.8, 2.5), lining(FLOOR, WALL, WALL));
    solid.carve(Vec3::new(-0.7, 0.9, -2.7), Vec3::new(1.1, 2.3, -2.5), [WHITE; 6]);
    let mut room = MeshBuilder::new("room");
    solid.build(&mut room);
    let mut furniture = MeshBuilder::new("furniture");
    furniture.cuboid(BLUE, Vec3::new(-1.99, 0.0, -0.2), Vec3::new(-1.15, 0.42, 1.7), 1.0, STANDING);
    furniture.cuboid(WOOD, Vec3::new(1.35, 0.0, -1.0), Vec3::new(1.99, 1.9, 0.2), 1.0, STANDING);
    furniture.cuboid(WHITE, Vec3::new(0.05, 0.0, 0.3), Vec3::new(0.65, 0.5, 0.9), 1.0, STANDING);
    let mut scene = assemble("sky-window", materials, vec![room.finish(), furniture.finish()]);
    let sun = Vec3::new(0.42, 0.85, -0.9);
    let [irradiance, zenith, ground] =
        [Vec3::new(72.0, 64.0, 52.0), Vec3::new(0.9, 1.4, 2.6), Vec3::new(2.7, 2.5, 2.1)];
    scene.sky = Vec3::ONE;
    scene.environment = Some(clear_sky(WIDTH, sun, irradiance, zenith, ground));
    scene.cameras.insert("default".into(), view(Vec3::new(1.5, 1.55, 2.3), Vec3::new(-0.45, 0.95, -2.0), 66.0, 7.0));
    scene.cameras.insert("outside".into(), view(Vec3::new(4.6, 1.9, -7.0), Vec3::new(0.0, 1.7, 0.0), 60.0, 7.0));
    scene
}
