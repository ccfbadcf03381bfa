//! Rooms that light enters through little: between slats, past a door, around two corners.

use glam::{Mat4, Vec3};

use super::shapes::{MeshBuilder, STANDING};
use super::solid::{Solid, lining};
use super::{assemble, matte, sun, view};
use crate::scene::{Light, LightKind, Material, Mesh, Scene};

const WALL: u32 = 0;
const FLOOR: u32 = 1;
const WOOD: u32 = 2;
const WHITE: u32 = 3;
const BLUE: u32 = 4;

fn materials() -> Vec<Material> {
    vec![
        matte("wall", Vec3::new(0.78, 0.75, 0.7)),
        matte("floor", Vec3::new(0.45, 0.34, 0.24)),
        matte("wood", Vec3::new(0.5, 0.32, 0.18)),
        matte("white", Vec3::splat(0.8)),
        matte("blue", Vec3::new(0.2, 0.32, 0.62)),
    ]
}

fn one(name: &str, build: impl FnOnce(&mut MeshBuilder)) -> Mesh {
    let mut mesh = MeshBuilder::new(name);
    build(&mut mesh);
    mesh.finish()
}

/// A room of 4 x 2.6 x 5 m behind slats of 25 mm, 32 mm apart, in a window of 2.4 x 1.5 m.
pub(super) fn blinds() -> Scene {
    let mut solid = Solid::default();
    solid.fill(Vec3::new(-2.2, -0.2, -2.7), Vec3::new(2.2, 2.8, 2.7), WALL);
    solid.carve(Vec3::new(-2.0, 0.0, -2.5), Vec3::new(2.0, 2.6, 2.5), lining(FLOOR, WALL, WALL));
    solid.carve(Vec3::new(-1.2, 0.8, -2.7), Vec3::new(1.2, 2.3, -2.5), [WHITE; 6]);
    let slats = one("slats", |mesh| {
        let tilt = Mat4::from_rotation_x(-22f32.to_radians());
        for i in 0..46u8 {
            // Across the whole window and into its sides, so that nothing passes beside them.
            mesh.transform = Mat4::from_translation(Vec3::new(0.0, 0.83 + 0.032 * f32::from(i), -2.58)) * tilt;
            let half = Vec3::new(1.21, 0.0005, 0.0125);
            mesh.cuboid(WHITE, -half, half, 1.0, [true; 6]);
        }
    });
    let sofa = one("sofa", |mesh| {
        mesh.cuboid(BLUE, Vec3::new(-1.9, 0.0, -0.6), Vec3::new(-1.0, 0.42, 1.4), 1.0, STANDING);
        mesh.cuboid(BLUE, Vec3::new(-1.99, 0.0, -0.7), Vec3::new(-1.75, 0.8, 1.5), 1.0, STANDING);
        mesh.cuboid(WOOD, Vec3::new(0.0, 0.0, -0.6), Vec3::new(0.9, 0.4, 0.3), 1.0, STANDING);
    });
    let mut scene = assemble("blinds", materials(), vec![one("room", |mesh| solid.build(mesh)), slats, sofa]);
    scene.lights.push(sun(Vec3::new(70.0, 63.0, 52.0), Vec3::new(0.25, -0.62, 0.74)));
    scene.sky = Vec3::new(4.0, 4.8, 6.0);
    scene.cameras.insert("default".into(), view(Vec3::new(1.3, 1.5, 2.2), Vec3::new(-0.5, 0.95, -2.0), 68.0, 7.0));
    scene
}

/// A bright room of 4 x 2.6 x 4 m and a dark one behind a wall of 10 cm, whose door leaves a gap of 25 cm.
pub(super) fn door_ajar() -> Scene {
    let mut solid = Solid::default();
    solid.fill(Vec3::new(-2.2, -0.2, -4.25), Vec3::new(2.2, 2.8, 4.25), WALL);
    solid.carve(Vec3::new(-2.0, 0.0, -4.05), Vec3::new(2.0, 2.6, -0.05), lining(FLOOR, WALL, WALL));
    solid.carve(Vec3::new(-2.0, 0.0, 0.05), Vec3::new(2.0, 2.6, 4.05), lining(FLOOR, WALL, WALL));
    solid.carve(Vec3::new(-0.45, 0.0, -0.05), Vec3::new(0.45, 2.05, 0.05), lining(FLOOR, WHITE, WHITE));
    let door = one("door", |mesh| {
        // It turns about the doorway's edge into the dark room, and reaches into the lintel's height but for 5 mm.
        let hinge = Vec3::new(-0.45, 0.0, 0.05);
        mesh.transform = Mat4::from_translation(hinge) * Mat4::from_rotation_y(-16f32.to_radians());
        mesh.cuboid(WOOD, Vec3::new(0.0, 0.005, -0.04), Vec3::new(0.89, 2.045, 0.0), 1.0, [true; 6]);
    });
    let furniture = one("furniture", |mesh| {
        mesh.cuboid(BLUE, Vec3::new(0.9, 0.0, 1.3), Vec3::new(1.7, 0.45, 2.9), 1.0, STANDING);
        mesh.cuboid(WHITE, Vec3::new(-1.5, 0.0, 0.9), Vec3::new(-1.0, 0.9, 1.4), 1.0, STANDING);
        mesh.cuboid(WOOD, Vec3::new(-1.9, 0.0, -3.9), Vec3::new(-1.4, 1.8, -2.6), 1.0, STANDING);
    });
    let mut scene = assemble("door-ajar", materials(), vec![one("rooms", |mesh| solid.build(mesh)), door, furniture]);
    scene.lights.push(Light {
        name: "lamp".into(),
        kind: LightKind::Point,
        color: Vec3::new(160.0, 142.0, 116.0),
        position: Vec3::new(0.0, 2.3, -2.0),
        direction: Vec3::NEG_Y,
        shadow: true,
    });
    scene.cameras.insert("default".into(), view(Vec3::new(-0.9, 1.6, 3.8), Vec3::new(0.1, 1.0, 0.0), 62.0, 10.0));
    scene.cameras.insert("bright".into(), view(Vec3::new(1.5, 1.6, -3.8), Vec3::new(-0.4, 1.0, 0.0), 62.0, 10.0));
    scene
}

/// A corridor of 1.8 x 2.5 m: 3.5 m from the open end, 5 m across, 5 m to the camera.
pub(super) fn corridor() -> Scene {
    let mut solid = Solid::default();
    solid.fill(Vec3::new(-2.0, -0.2, -6.7), Vec3::new(3.6, 2.7, 3.7), WALL);
    for (low, high) in [
        (Vec3::new(1.6, 0.0, 0.0), Vec3::new(3.4, 2.5, 3.5)),
        (Vec3::new(-1.8, 0.0, -1.8), Vec3::new(3.4, 2.5, 0.0)),
        (Vec3::new(-1.8, 0.0, -6.5), Vec3::new(0.0, 2.5, -1.8)),
    ] {
        solid.carve(low, high, lining(FLOOR, WALL, WALL));
    }
    solid.carve(Vec3::new(1.85, 0.0, 3.5), Vec3::new(3.15, 2.2, 3.7), lining(FLOOR, WHITE, WHITE));
    let furniture = one("furniture", |mesh| {
        mesh.cuboid(BLUE, Vec3::new(-1.79, 0.0, -4.4), Vec3::new(-1.35, 0.8, -3.4), 1.0, STANDING);
        mesh.cuboid(WOOD, Vec3::new(-0.04, 0.0, -3.6), Vec3::new(0.01, 2.05, -2.7), 1.0, STANDING);
    });
    let meshes = vec![one("corridor", |mesh| solid.build(mesh)), furniture];
    let mut scene = assemble("corridor", materials(), meshes);
    scene.lights.push(sun(Vec3::new(900.0, 820.0, 700.0), Vec3::new(-0.12, -0.45, -0.9)));
    scene.sky = Vec3::new(60.0, 70.0, 85.0);
    scene.cameras.insert("default".into(), view(Vec3::new(-0.6, 1.6, -6.2), Vec3::new(-0.9, 1.15, -1.0), 60.0, 12.0));
    scene.cameras.insert("middle".into(), view(Vec3::new(-1.4, 1.6, -0.9), Vec3::new(3.4, 1.1, -0.6), 60.0, 12.0));
    scene
}
