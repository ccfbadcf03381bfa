//! Triangles that voxelizers find hard, in five groups inside a cube of 4 m.

use glam::{Vec2, Vec3};

use super::noise::Random;
use super::shapes::MeshBuilder;
use super::{assemble, matte, sun, view};
use crate::scene::{Mesh, Scene};

pub(super) fn build() -> Scene {
    let materials = vec![
        matte("needle", Vec3::new(0.80, 0.10, 0.10)),
        matte("obtuse", Vec3::new(0.10, 0.65, 0.15)),
        matte("huge", Vec3::new(0.75, 0.70, 0.60)),
        matte("sub-voxel", Vec3::new(0.12, 0.25, 0.80)),
        matte("diagonal", Vec3::new(0.85, 0.65, 0.10)),
    ];
    let mut scene = assemble("triangles", materials, vec![needle(), obtuse(), huge(), sub_voxel(), diagonal()]);
    for material in &mut scene.materials {
        material.two_sided = true;
    }
    scene.lights.push(sun(Vec3::splat(8.0), Vec3::new(-0.4, -0.8, -0.45)));
    scene.sky = Vec3::splat(0.4);
    scene.cameras.insert("default".into(), view(Vec3::new(4.2, 3.4, 5.6), Vec3::new(0.0, -0.2, 0.0), 45.0, 7.0));
    scene
}

/// A flat triangle, counter-clockwise from its front.
fn add(mesh: &mut MeshBuilder, material: u32, corners: [Vec3; 3]) {
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or(Vec3::Y);
    let corners = corners.map(|corner| mesh.vertex(corner, normal, Vec2::ZERO));
    mesh.triangle(material, corners);
}

/// 3 m long and from 20 mm down to 0.2 mm wide.
fn needle() -> Mesh {
    let mut mesh = MeshBuilder::new("needle");
    for i in 0..16 {
        let t = i as f32 / 15.0;
        let width = 0.02 * 0.01f32.powf(t);
        let start = Vec3::new(-1.8, 0.6 + 1.2 * t, 1.7 - 0.8 * t);
        let end = start + Vec3::new(3.0, 0.3 - 0.6 * t, 0.2);
        add(&mut mesh, 0, [start, end, start + Vec3::Y * width]);
    }
    mesh.finish()
}

/// One angle near 180 degrees: 2 m wide, from 10 cm down to 1 mm high.
fn obtuse() -> Mesh {
    let mut mesh = MeshBuilder::new("obtuse");
    for i in 0..12 {
        let t = i as f32 / 11.0;
        let height = 0.1 * 0.01f32.powf(t);
        let a = Vec3::new(-1.6, -0.9 + 0.11 * i as f32, -1.7 + 0.1 * i as f32);
        add(&mut mesh, 1, [a, a + Vec3::new(2.0, 0.0, 0.3), a + Vec3::new(0.9, height, 0.15)]);
    }
    mesh.finish()
}

/// Two triangles as large as the cube's floor and one through its diagonal.
fn huge() -> Mesh {
    let mut mesh = MeshBuilder::new("huge");
    let p = |x: f32, z: f32| Vec3::new(x, -1.97, z);
    add(&mut mesh, 2, [p(-2.0, 2.0), p(2.0, 2.0), p(2.0, -2.0)]);
    add(&mut mesh, 2, [p(-2.0, 2.0), p(2.0, -2.0), p(-2.0, -2.0)]);
    add(&mut mesh, 2, [Vec3::new(-2.0, -1.9, -1.95), Vec3::new(2.0, -1.9, -1.95), Vec3::new(-1.9, 2.0, -1.8)]);
    mesh.finish()
}

/// 4,096 triangles of 3 mm over a sphere of 35 cm radius.
fn sub_voxel() -> Mesh {
    let mut mesh = MeshBuilder::new("sub-voxel");
    let mut random = Random(4096);
    let centre = Vec3::new(1.1, 0.2, -0.4);
    for _ in 0..4096 {
        let y = random.range(-1.0, 1.0);
        let (s, c) = (random.unit() * std::f32::consts::TAU).sin_cos();
        let out = Vec3::new(c * (1.0 - y * y).sqrt(), y, s * (1.0 - y * y).sqrt());
        let side = out.any_orthonormal_vector();
        let up = out.cross(side);
        let at = centre + out * 0.35;
        add(&mut mesh, 3, [at, at + side * 0.003, at + up * 0.003]);
    }
    mesh.finish()
}

/// Squares whose planes lie at 45 degrees to two axes or evenly to all three.
fn diagonal() -> Mesh {
    let mut mesh = MeshBuilder::new("diagonal");
    let directions = [(1.0, 1.0, 0.0), (0.0, 1.0, 1.0), (1.0, 0.0, 1.0), (1.0, 1.0, 1.0)];
    for (i, (x, y, z)) in directions.into_iter().enumerate() {
        let normal = Vec3::new(x, y, z).normalize();
        let side = normal.any_orthonormal_vector() * 0.42;
        let up = normal.cross(side);
        let centre = Vec3::new(-1.3 + 0.9 * i as f32, -1.2, 1.1);
        let corners = [centre - side - up, centre + side - up, centre + side + up, centre - side + up];
        add(&mut mesh, 4, [corners[0], corners[1], corners[2]]);
        add(&mut mesh, 4, [corners[0], corners[2], corners[3]]);
    }
    mesh.finish()
}
