//! A hall of fifty vases in relief, a million triangles of a few millimetres: what each stage pays for triangles that are smaller
//! than its cells, texels and pixels.

use glam::{Mat4, Vec2, Vec3};

use super::noise::fractal;
use super::shapes::{MeshBuilder, STANDING};
use super::solid::{Solid, lining};
use super::{assemble, matte, sun, view};
use crate::scene::{Material, Scene};

const WALL: u32 = 0;
const FLOOR: u32 = 1;
const PLINTH: u32 = 2;
/// The first of the vases' four glazes.
const GLAZE: u32 = 3;

/// Vases from wall to wall, and along the hall.
const ROWS: [u8; 2] = [5, 10];
/// Quads around a vase, and from its foot to its lip.
const QUADS: [u32; 2] = [160, 64];

pub(super) fn build() -> Scene {
    let glazed = |name: &str, color: Vec3, roughness: f32| Material { roughness, ..matte(name, color) };
    let materials = vec![
        matte("plaster", Vec3::new(0.72, 0.69, 0.63)),
        matte("floor", Vec3::new(0.36, 0.31, 0.27)),
        matte("plinth", Vec3::new(0.6, 0.6, 0.58)),
        glazed("celadon", Vec3::new(0.42, 0.58, 0.47), 0.3),
        glazed("cobalt", Vec3::new(0.08, 0.16, 0.5), 0.35),
        matte("terracotta", Vec3::new(0.6, 0.27, 0.16)),
        glazed("cream", Vec3::new(0.78, 0.73, 0.6), 0.5),
    ];
    let mut solid = Solid::default();
    solid.fill(Vec3::new(-6.3, -0.3, -11.3), Vec3::new(6.3, 4.8, 11.3), WALL);
    solid.carve(Vec3::new(-6.0, 0.0, -11.0), Vec3::new(6.0, 4.5, 11.0), lining(FLOOR, WALL, WALL));
    for window in 0..5u8 {
        let from = 4.4 * f32::from(window) - 10.4;
        solid.carve(Vec3::new(5.9, 1.6, from), Vec3::new(6.4, 4.0, from + 3.0), [WALL; 6]);
    }
    let mut hall = MeshBuilder::new("hall");
    solid.build(&mut hall);
    let (mut plinths, mut vases) = (MeshBuilder::new("plinths"), MeshBuilder::new("vases"));
    for (i, j) in (0..ROWS[0]).flat_map(|i| (0..ROWS[1]).map(move |j| (i, j))) {
        let place = Vec3::new(2.2 * (f32::from(i) - 2.0), 0.0, 2.0 * (f32::from(j) - 4.5));
        let half = Vec3::new(0.3, 0.0, 0.3);
        plinths.cuboid(PLINTH, place - half, place + half + Vec3::Y * 0.9, 1.0, STANDING);
        vases.transform = Mat4::from_translation(place + Vec3::Y * 0.9);
        vase(&mut vases, GLAZE + u32::from(i + 3 * j) % 4, u32::from(i) * 31 + u32::from(j));
    }
    let mut scene = assemble("vases", materials, vec![hall.finish(), plinths.finish(), vases.finish()]);
    scene.lights.push(sun(Vec3::new(24.0, 22.0, 19.0), Vec3::new(-0.75, -0.6, 0.28)));
    scene.sky = Vec3::new(2.6, 3.1, 3.8);
    scene.cameras.insert("default".into(), view(Vec3::new(-4.9, 2.1, 10.2), Vec3::new(0.6, 0.9, -2.0), 60.0, 26.0));
    scene.cameras.insert("close".into(), view(Vec3::new(0.9, 1.5, 2.4), Vec3::new(0.0, 1.3, 1.0), 50.0, 26.0));
    scene
}

/// 60 cm high, with flutes that wind upwards and a grain.
fn vase(mesh: &mut MeshBuilder, material: u32, seed: u32) {
    const PROFILE: [f32; 7] = [0.09, 0.1, 0.17, 0.22, 0.16, 0.07, 0.1];
    mesh.surface(material, QUADS[0], QUADS[1], Vec2::ONE, |u, v| {
        let x = (v * 6.0).clamp(0.0, 6.0);
        let i = (x as usize).min(5);
        let t = x - i as f32;
        let radius = PROFILE[i] + (PROFILE[i + 1] - PROFILE[i]) * t * t * (3.0 - 2.0 * t);
        let angle = -u * std::f32::consts::TAU;
        let flutes = 0.006 * (16.0 * angle + 9.0 * v).cos();
        let grain = 0.012 * fractal(u, 0.5 * v, 8, seed);
        let r = radius + flutes + grain;
        Vec3::new(r * angle.cos(), 0.6 * v, r * angle.sin())
    });
}
