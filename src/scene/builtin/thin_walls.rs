//! Slabs of 2, 4 and 8 cm at angles from 0 to 45 degrees before a brightly lit wall: light must not leak through.

use glam::{Mat4, Vec3};

use super::shapes::{MeshBuilder, STANDING};
use super::{assemble, matte, view};
use crate::scene::{Light, LightKind, Scene};

const FLOOR: u32 = 0;
const BRIGHT: u32 = 1;
const SLAB: u32 = 2;

pub(super) fn build() -> Scene {
    let materials = vec![
        matte("floor", Vec3::splat(0.3)),
        matte("bright wall", Vec3::new(0.85, 0.80, 0.70)),
        matte("slab", Vec3::splat(0.6)),
    ];
    let mut ground = MeshBuilder::new("floor");
    let level =
        [Vec3::new(-4.5, 0.0, 4.0), Vec3::new(4.5, 0.0, 4.0), Vec3::new(4.5, 0.0, -3.0), Vec3::new(-4.5, 0.0, -3.0)];
    ground.quad(FLOOR, level, 8, 1.0);
    let mut wall = MeshBuilder::new("bright wall");
    wall.cuboid(BRIGHT, Vec3::new(-4.4, -0.1, -2.9), Vec3::new(4.4, 2.6, -2.5), 1.0, STANDING);
    let mut meshes = vec![ground.finish(), wall.finish()];
    // One row per thickness, from thin and near the wall to thick and far from it.
    for (row, thickness) in [0.02f32, 0.04, 0.08].into_iter().enumerate() {
        for (column, degrees) in [0.0f32, 15.0, 30.0, 45.0].into_iter().enumerate() {
            let mut slab = MeshBuilder::new(&format!("slab {} mm at {degrees} deg", (thickness * 1000.0).round()));
            let place = Vec3::new(-3.0 + 2.0 * column as f32, 0.0, -1.2 + 1.7 * row as f32);
            slab.transform = Mat4::from_translation(place) * Mat4::from_rotation_y(degrees.to_radians());
            let half = Vec3::new(0.7, 0.0, thickness * 0.5);
            slab.cuboid(SLAB, Vec3::new(0.0, -0.1, 0.0) - half, Vec3::new(0.0, 1.2, 0.0) + half, 1.0, STANDING);
            meshes.push(slab.finish());
        }
    }
    let mut scene = assemble("thin-walls", materials, meshes);
    // From behind the camera: the wall shines, and the slabs' far sides see nothing but its light.
    scene.lights.push(Light {
        name: "wall washer".into(),
        kind: LightKind::Directional,
        color: Vec3::splat(12.0),
        position: Vec3::ZERO,
        direction: Vec3::new(0.1, -0.45, -1.0).normalize(),
        shadow: true,
    });
    scene.cameras.insert("default".into(), view(Vec3::new(0.0, 3.4, 7.0), Vec3::new(0.0, 0.6, -0.5), 50.0, 12.0));
    scene.cameras.insert("behind".into(), view(Vec3::new(0.0, 2.2, -2.3), Vec3::new(0.0, 0.3, 1.5), 80.0, 12.0));
    scene
}
