//! Trees and bushes of small leaves: most of a voxel that they touch is air.

use std::f32::consts::TAU;

use glam::{Mat4, Quat, Vec2, Vec3};

use super::noise::Random;
use super::shapes::MeshBuilder;
use super::{assemble, matte, patterns, sun, view};
use crate::scene::{Instance, Material, Mesh, Scene};

const GROUND: u32 = 0;
const BARK: u32 = 1;
/// Quads of one colour.
const LEAF: u32 = 2;
/// Quads of which a mask leaves a sprig.
const SPRIG: u32 = 3;

pub(super) fn build() -> Scene {
    let materials = vec![
        matte("ground", Vec3::new(0.34, 0.3, 0.2)),
        matte("bark", Vec3::new(0.3, 0.22, 0.16)),
        Material { two_sided: true, ..matte("leaf", Vec3::new(0.24, 0.42, 0.12)) },
        Material { alpha_cutoff: 0.5, two_sided: true, base_color_texture: Some(0), ..matte("sprig", Vec3::ONE) },
    ];
    let mut ground = MeshBuilder::new("ground");
    let p = |x: f32, z: f32| Vec3::new(15.0 * x, 0.0, 15.0 * z);
    ground.quad(GROUND, [p(-1.0, 1.0), p(1.0, 1.0), p(1.0, -1.0), p(-1.0, -1.0)], 4, 1.0);
    let meshes = vec![ground.finish(), tree("tree", LEAF, 5), tree("sapling", SPRIG, 6), bush()];
    let mut scene = assemble("foliage", materials, meshes);
    scene.textures.push(patterns::masked("sprig", 256, patterns::leaves));
    scene.instances.truncate(1);
    let places: [(&str, u32, &[[f32; 4]]); 3] = [
        ("tree", 1, &[[-4.2, -3.0, 0.0, 1.0], [3.6, -5.0, 2.0, 1.2], [-1.0, -9.0, 4.0, 1.1], [7.5, 0.5, 1.0, 0.9]]),
        ("sapling", 2, &[[0.4, -3.6, 0.0, 0.75], [-7.0, 1.0, 3.0, 0.9], [5.0, -1.2, 5.0, 0.6]]),
        ("bush", 3, &[[-2.0, 0.6, 0.0, 1.0], [1.9, -0.6, 1.0, 1.2], [-5.2, -0.4, 2.0, 1.1], [3.4, 1.4, 4.0, 0.8]]),
    ];
    for (name, mesh, list) in places {
        scene.instances.extend((1..).zip(list).map(|(i, &[x, z, turn, size])| Instance {
            name: format!("{name} {i}"),
            mesh,
            transform: Mat4::from_scale_rotation_translation(
                Vec3::splat(size),
                Quat::from_rotation_y(turn),
                Vec3::new(x, 0.0, z),
            ),
            animation: None,
        }));
    }
    scene.lights.push(sun(Vec3::new(9.0, 8.4, 7.2), Vec3::new(-0.5, -0.75, -0.4)));
    scene.sky = Vec3::new(0.7, 0.9, 1.2);
    for (name, eye, target) in [
        ("default", Vec3::new(0.3, 1.6, 4.6), Vec3::new(-0.3, 1.75, -3.0)),
        ("below", Vec3::new(-3.6, 1.2, -1.4), Vec3::new(-4.4, 4.0, -3.6)),
    ] {
        scene.cameras.insert(name.into(), view(eye, target, 60.0, 43.0));
    }
    scene
}

/// A trunk and a crown of 1600 leaves, about 5 m high.
fn tree(name: &str, leaf: u32, seed: u64) -> Mesh {
    let mut mesh = MeshBuilder::new(name);
    let outline = [(0.2, -0.1), (0.14, 0.4), (0.11, 2.0), (0.05, 3.6), (0.0, 4.2)].map(|(r, y)| Vec2::new(r, y));
    mesh.lathe(BARK, 12, 12, 1.0, &outline);
    crown(&mut mesh, leaf, &mut Random(seed), 1600, Vec3::Y * 3.4, Vec3::new(1.5, 1.6, 1.5));
    mesh.finish()
}

/// 700 leaves of both kinds, about 1 m high.
fn bush() -> Mesh {
    let mut mesh = MeshBuilder::new("bush");
    let mut random = Random(7);
    crown(&mut mesh, LEAF, &mut random, 350, Vec3::Y * 0.45, Vec3::new(0.7, 0.5, 0.7));
    crown(&mut mesh, SPRIG, &mut random, 350, Vec3::Y * 0.5, Vec3::new(0.75, 0.55, 0.75));
    mesh.finish()
}

/// Leaves in an ellipsoid, more of them near its surface.
fn crown(mesh: &mut MeshBuilder, leaf: u32, random: &mut Random, count: u32, centre: Vec3, radii: Vec3) {
    for _ in 0..count {
        let (turn, height) = (random.unit() * TAU, random.range(-1.0, 1.0));
        let flat = (1.0 - height * height).sqrt();
        let out = Vec3::new(flat * turn.cos(), height, flat * turn.sin());
        let place = centre + out * radii * random.unit().powf(0.4);
        let size = if leaf == SPRIG { random.range(0.2, 0.36) } else { random.range(0.09, 0.17) };
        let along = (out + Vec3::new(random.range(-1.0, 1.0), random.range(-1.2, 0.4), random.range(-1.0, 1.0)))
            .normalize_or(Vec3::Y);
        let side = Quat::from_axis_angle(along, random.unit() * TAU) * along.any_orthonormal_vector();
        let (across, up) = (side * (0.5 * size), along * size);
        mesh.quad(leaf, [place - across, place + across, place + across + up, place - across + up], 1, size);
    }
}
