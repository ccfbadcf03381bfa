//! Closed meshes and their poses.

use conelab::scene::{Instance, Keyframe, Material, Mesh, Mover, Scene, Submesh, Track, Vertex};
use glam::{Mat4, Quat, Vec3};

/// A scene of one mesh.
pub fn placed(mesh: Mesh, materials: Vec<Material>, keyframes: Vec<Keyframe>) -> Scene {
    let track = Track::rigid(&keyframes, false).into();
    let movers = vec![Mover {
        parent: None,
        placed: Mat4::IDENTITY,
        track,
    }];
    let mover = (!keyframes.is_empty()).then_some(0);
    let instances = vec![Instance {
        name: "mesh".into(),
        mesh: 0,
        transform: Mat4::IDENTITY,
        mover,
    }];
    Scene {
        name: "mesh".into(),
        meshes: vec![mesh],
        materials,
        instances,
        movers,
        ..Scene::default()
    }
}

/// A closed surface over a torus of u and v: `point` has the period 1 in both.
pub fn torus(nu: u32, nv: u32) -> Mesh {
    let turn = std::f32::consts::TAU;
    let mut mesh = Mesh::default();
    for (i, j) in (0..nu).flat_map(|i| (0..nv).map(move |j| (i, j))) {
        let (u, v) = (turn * i as f32 / nu as f32, turn * j as f32 / nv as f32);
        let out = Vec3::new(u.cos(), 0.0, u.sin());
        let normal = out * v.cos() + Vec3::Y * v.sin();
        push(&mut mesh, out * 0.5 + normal * 0.22, normal);
        let at = |i: u32, j: u32| i % nu * nv + j % nv;
        let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
        mesh.indices.extend([a, b, c, a, c, d]);
    }
    whole(mesh)
}

/// A cube whose faces are divided and, for `round` 1, blown up to a sphere of triangles of many shapes.
pub fn cube(n: u32, round: f32) -> Mesh {
    let mut mesh = Mesh::default();
    for face in 0..6 {
        let (axis, sign) = (face / 2, if face % 2 == 0 { 1.0 } else { -1.0 });
        let first = mesh.vertices.len() as u32;
        for (i, j) in (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j))) {
            let mut p = Vec3::ZERO;
            p[axis] = sign;
            p[(axis + 1) % 3] = 2.0 * i as f32 / n as f32 - 1.0;
            p[(axis + 2) % 3] = 2.0 * j as f32 / n as f32 - 1.0;
            push(
                &mut mesh,
                (p * 0.45).lerp(p.normalize() * 0.7, round),
                p.normalize(),
            );
            if i < n && j < n {
                let at = |i: u32, j: u32| first + i * (n + 1) + j;
                mesh.indices.extend([
                    at(i, j),
                    at(i + 1, j),
                    at(i + 1, j + 1),
                    at(i, j),
                    at(i + 1, j + 1),
                    at(i, j + 1),
                ]);
            }
        }
    }
    whole(mesh)
}

fn push(mesh: &mut Mesh, position: Vec3, normal: Vec3) {
    mesh.vertices.push(Vertex {
        position: position.into(),
        normal: normal.into(),
        ..Vertex::default()
    });
}

fn whole(mut mesh: Mesh) -> Mesh {
    mesh.submeshes = vec![Submesh {
        first_index: 0,
        index_count: mesh.indices.len() as u32,
        material: 0,
    }];
    mesh
}

/// Poses at 0, 1, 2 ... seconds, the same every time.
pub fn poses(count: usize) -> Vec<Keyframe> {
    let mut state = 12345u64;
    let mut number = || {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 40) as f32 / (1u64 << 24) as f32 * 2.0 - 1.0
    };
    let pose = |i| Keyframe {
        time: i as f32,
        translation: Vec3::new(number(), number(), number()) * 0.1,
        rotation: Quat::from_xyzw(number(), number(), number(), number()).normalize(),
    };
    (0..count).map(pose).collect()
}
