//! Scenes of unusual sizes: a room of millimetres, and a house on a plane of hundreds of kilometres.

use glam::{Mat4, Vec3};

use super::shapes::{MeshBuilder, STANDING};
use super::solid::{Solid, lining};
use super::{assemble, matte, sun, view};
use crate::scene::{Light, LightKind, Scene};

const WALL: u32 = 0;
const FLOOR: u32 = 1;
const RED: u32 = 2;
const BLUE: u32 = 3;
const WOOD: u32 = 4;

/// A room of 4 x 2.6 x 4 mm with an open front, walls of 0.15 mm, furniture and a lamp.
pub(super) fn pocket() -> Scene {
    const MILLI: f32 = 1e-3;
    let materials = vec![
        matte("wall", Vec3::new(0.75, 0.72, 0.66)),
        matte("floor", Vec3::new(0.48, 0.34, 0.22)),
        matte("red", Vec3::new(0.65, 0.12, 0.1)),
        matte("blue", Vec3::new(0.2, 0.3, 0.65)),
        matte("wood", Vec3::new(0.55, 0.38, 0.22)),
    ];
    // Built in metres, a thousand times as large.
    let mut solid = Solid::default();
    solid.fill(Vec3::new(-2.15, -0.15, -2.15), Vec3::new(2.15, 2.75, 2.0), WALL);
    solid.carve(Vec3::new(-2.0, 0.0, -2.0), Vec3::new(2.0, 2.6, 2.0), lining(FLOOR, WALL, WALL));
    let mut room = MeshBuilder::new("room");
    let mut furniture = MeshBuilder::new("furniture");
    for mesh in [&mut room, &mut furniture] {
        mesh.transform = Mat4::from_scale(Vec3::splat(MILLI));
    }
    solid.build(&mut room);
    furniture.cuboid(RED, Vec3::new(-1.99, 0.0, -1.6), Vec3::new(-1.1, 0.45, 0.8), 1.0, STANDING);
    furniture.cuboid(RED, Vec3::new(-1.99, 0.0, -1.9), Vec3::new(-1.1, 0.9, -1.55), 1.0, STANDING);
    furniture.cuboid(BLUE, Vec3::new(1.3, 0.0, -1.99), Vec3::new(1.95, 1.9, -0.9), 1.0, STANDING);
    furniture.cuboid(WOOD, Vec3::new(-0.2, 0.7, -0.6), Vec3::new(0.9, 0.76, 0.3), 1.0, [true; 6]);
    furniture.cuboid(WOOD, Vec3::new(0.25, 0.0, -0.25), Vec3::new(0.45, 0.73, -0.05), 1.0, STANDING);
    let mut scene = assemble("pocket", materials, vec![room.finish(), furniture.finish()]);
    scene.lights.push(Light {
        name: "lamp".into(),
        kind: LightKind::Spot { inner: 0.0, outer: 75f32.to_radians() },
        color: Vec3::new(1.0, 0.88, 0.7) * (12.0 * MILLI * MILLI),
        position: Vec3::new(0.0, 2.5, 0.2) * MILLI,
        direction: Vec3::NEG_Y,
        shadow: true,
    });
    scene.sky = Vec3::new(0.3, 0.4, 0.55);
    let eye = Vec3::new(0.6, 1.7, 5.6) * MILLI;
    let camera = view(eye, Vec3::new(0.0, 1.1, -0.5) * MILLI, 48.0, 6.6 * MILLI);
    scene.cameras.insert("default".into(), camera);
    scene
}

/// A house of 8 m in the middle of a plane of 200 km.
pub(super) fn plain() -> Scene {
    const ROOF: u32 = 2;
    let materials = vec![
        matte("wall", Vec3::new(0.76, 0.72, 0.62)),
        matte("floor", Vec3::new(0.45, 0.33, 0.22)),
        matte("roof", Vec3::new(0.5, 0.22, 0.15)),
        matte("plain", Vec3::new(0.36, 0.36, 0.22)),
    ];
    const PLAIN: u32 = 3;
    let mut plain = MeshBuilder::new("plain");
    let p = |x: f32, z: f32| Vec3::new(1e5 * x, 0.0, 1e5 * z);
    plain.quad(PLAIN, [p(-1.0, 1.0), p(1.0, 1.0), p(1.0, -1.0), p(-1.0, -1.0)], 1, 1.0);
    let mut solid = Solid::default();
    solid.fill(Vec3::new(-4.0, -0.2, -3.0), Vec3::new(4.0, 3.0, 3.0), WALL);
    solid.carve(Vec3::new(-3.75, 0.1, -2.75), Vec3::new(3.75, 2.7, 2.75), lining(FLOOR, WALL, WALL));
    solid.carve(Vec3::new(-0.5, 0.1, 2.75), Vec3::new(0.5, 2.2, 3.0), lining(FLOOR, WALL, WALL));
    for (low, high) in [(-3.0, -1.4), (1.4, 3.0)] {
        solid.carve(Vec3::new(low, 0.9, 2.75), Vec3::new(high, 2.2, 3.0), lining(WALL, WALL, WALL));
    }
    let mut house = MeshBuilder::new("house");
    solid.build(&mut house);
    roof(&mut house, ROOF);
    let mut scene = assemble("plain", materials, vec![plain.finish(), house.finish()]);
    scene.lights.push(sun(Vec3::new(8.0, 7.5, 6.6), Vec3::new(-0.55, -0.6, -0.58)));
    scene.sky = Vec3::new(0.6, 0.8, 1.1);
    for (name, eye, target, fov) in [
        ("default", Vec3::new(4.5, 1.7, 12.0), Vec3::new(0.0, 1.9, 0.0), 55.0),
        ("inside", Vec3::new(2.9, 1.7, -2.0), Vec3::new(-1.0, 1.2, 2.5), 70.0),
    ] {
        scene.cameras.insert(name.into(), view(eye, target, fov, 2.8e5));
    }
    scene
}

/// Two slopes and two gables over the house, closed from below by the house's ceiling.
fn roof(mesh: &mut MeshBuilder, material: u32) {
    // The slopes begin a little below the top of the walls and before them.
    let eaves = |x: f32, z: f32| Vec3::new(4.3 * x, 2.8, 3.4 * z);
    let ridge = |x: f32| Vec3::new(4.3 * x, 5.0, 0.0);
    mesh.quad(material, [eaves(-1.0, 1.0), eaves(1.0, 1.0), ridge(1.0), ridge(-1.0)], 1, 1.0);
    mesh.quad(material, [eaves(1.0, -1.0), eaves(-1.0, -1.0), ridge(-1.0), ridge(1.0)], 1, 1.0);
    let under = [eaves(-1.0, -1.0), eaves(1.0, -1.0), eaves(1.0, 1.0), eaves(-1.0, 1.0)];
    mesh.quad(material, under, 1, 1.0);
    for (x, corners) in [
        (1.0, [eaves(1.0, 1.0), eaves(1.0, -1.0), ridge(1.0)]),
        (-1.0, [eaves(-1.0, -1.0), eaves(-1.0, 1.0), ridge(-1.0)]),
    ] {
        let corners = corners.map(|p| mesh.vertex(p, Vec3::X * x, glam::Vec2::new(p.z, p.y)));
        mesh.triangle(material, corners);
    }
}
