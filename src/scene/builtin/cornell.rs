//! The Cornell box, from the measured data of the Cornell University Program of Computer Graphics, 1 unit = 1 cm. The
//! lamp is a spot light below a faintly glowing panel.

use glam::Vec3;

use super::shapes::MeshBuilder;
use super::{assemble, matte, view};
use crate::scene::{Light, LightKind, Material, Scene};

const WHITE: u32 = 0;
const RED: u32 = 1;
const GREEN: u32 = 2;
const LIGHT: u32 = 3;

pub(super) fn build() -> Scene {
    let light = Material { emission: Vec3::new(1.7, 1.5, 1.1), ..matte("light", Vec3::splat(0.78)) };
    let materials = vec![
        matte("white", Vec3::new(0.725, 0.71, 0.68)),
        matte("red", Vec3::new(0.63, 0.065, 0.05)),
        matte("green", Vec3::new(0.14, 0.45, 0.091)),
        light,
    ];
    let quads: [(&str, u32, [[f32; 3]; 4]); 6] = [
        ("floor", WHITE, [[552.8, 0., 0.], [0., 0., 0.], [0., 0., 559.2], [549.6, 0., 559.2]]),
        ("ceiling", WHITE, [[556., 548.8, 0.], [556., 548.8, 559.2], [0., 548.8, 559.2], [0., 548.8, 0.]]),
        ("back wall", WHITE, [[549.6, 0., 559.2], [0., 0., 559.2], [0., 548.8, 559.2], [556., 548.8, 559.2]]),
        ("right wall", GREEN, [[0., 0., 559.2], [0., 0., 0.], [0., 548.8, 0.], [0., 548.8, 559.2]]),
        ("left wall", RED, [[552.8, 0., 0.], [549.6, 0., 559.2], [556., 548.8, 559.2], [556., 548.8, 0.]]),
        // A little below the ceiling: coincident faces would fight.
        ("light", LIGHT, [[343., 548., 227.], [343., 548., 332.], [213., 548., 332.], [213., 548., 227.]]),
    ];
    let mut meshes = Vec::new();
    for (name, material, corners) in quads {
        let mut mesh = MeshBuilder::new(name);
        mesh.quad(material, corners.map(metres), 1, 1.0);
        meshes.push(mesh.finish());
    }
    let short = [[130., 65.], [82., 225.], [240., 272.], [290., 114.]];
    let tall = [[423., 247.], [265., 296.], [314., 456.], [472., 406.]];
    meshes.push(block("short block", short, 165.0).finish());
    meshes.push(block("tall block", tall, 330.0).finish());
    let mut scene = assemble("cornell", materials, meshes);
    // Radiance 17 15 11 times the panel's 1.365 m^2, as a light without extent: its light bounces from the walls,
    // while an emitting panel alone would only be seen by the first bounce.
    scene.lights.push(Light {
        name: "lamp".into(),
        kind: LightKind::Spot { inner: 0.0, outer: 70f32.to_radians() },
        color: Vec3::new(23.2, 20.5, 15.0),
        position: metres([278.0, 547.0, 279.5]),
        direction: Vec3::NEG_Y,
        shadow: true,
    });
    let camera = view(Vec3::new(2.78, 2.73, -8.0), Vec3::new(2.78, 2.73, 2.8), 39.3, 9.6);
    scene.cameras.insert("default".into(), camera);
    scene
}

fn metres(p: [f32; 3]) -> Vec3 {
    Vec3::from_array(p) * 0.01
}

/// Top and sides over a base given as (x, z); the bottom lies on the floor and is left out.
fn block(name: &str, base: [[f32; 2]; 4], height: f32) -> MeshBuilder {
    let mut mesh = MeshBuilder::new(name);
    let at = |i: usize, y: f32| metres([base[i % 4][0], y, base[i % 4][1]]);
    mesh.quad(WHITE, [0, 1, 2, 3].map(|i| at(i, height)), 1, 1.0);
    for i in 0..4 {
        mesh.quad(WHITE, [at(i, 0.0), at(i + 1, 0.0), at(i + 1, height), at(i, height)].map(|p| p), 1, 1.0);
    }
    mesh
}
