//! Two rooms in which one thing moves: a thin box across the light, and a blade that turns before it. What moves is centred
//! at the origin of its own mesh, so that it can be scaled in place.

use glam::{Quat, Vec3};

use super::shapes::MeshBuilder;
use super::{assemble, matte, view};
use crate::scene::{Animation, Instance, Keyframe, Light, LightKind, Mesh, Scene};

const WHITE: u32 = 0;
const RED: u32 = 1;
const ACTOR: u32 = 2;

/// A box 6.4 cm thick, 1.4 m high and 1.2 m deep that crosses a room of 4 x 3 x 4 m at 0.6 m/s, and back.
pub(super) fn thin_box() -> Scene {
    let mut mesh = MeshBuilder::new("thin box");
    let half = Vec3::new(0.032, 0.7, 0.6);
    mesh.cuboid(ACTOR, -half, half, 1.0, [true; 6]);
    let key = |time, x| Keyframe { time, translation: Vec3::new(x, 0.75, -0.2), rotation: Quat::IDENTITY };
    let keyframes = vec![key(0.0, -1.2), key(4.0, 1.2), key(8.0, -1.2)];
    room("moving-box", mesh.finish(), Animation { keyframes, repeat: true })
}

/// A blade of 1.8 x 0.3 x 0.064 m that turns before the back wall, once in 4 s.
pub(super) fn blade() -> Scene {
    let mut mesh = MeshBuilder::new("blade");
    let half = Vec3::new(0.9, 0.15, 0.032);
    mesh.cuboid(ACTOR, -half, half, 1.0, [true; 6]);
    // In quarters, so that no step exceeds half a turn.
    let key = |i: u8| Keyframe {
        time: f32::from(i),
        translation: Vec3::new(0.0, 1.35, -0.9),
        rotation: Quat::from_rotation_z(f32::from(i) * std::f32::consts::FRAC_PI_2),
    };
    room("blade", mesh.finish(), Animation { keyframes: (0..=4).map(key).collect(), repeat: true })
}

/// Floor, back wall, red left wall, a lamp at the upper right, and something that moves.
fn room(name: &str, actor: Mesh, animation: Animation) -> Scene {
    let materials = vec![
        matte("white", Vec3::splat(0.72)),
        matte("red", Vec3::new(0.63, 0.065, 0.05)),
        matte("actor", Vec3::new(0.25, 0.45, 0.70)),
    ];
    let p = |x: f32, y: f32, z: f32| Vec3::new(2.0 * x, 3.0 * y, 2.0 * z);
    let quads = [
        ("floor", WHITE, [p(-1., 0., 1.), p(1., 0., 1.), p(1., 0., -1.), p(-1., 0., -1.)]),
        ("back wall", WHITE, [p(-1., 0., -1.), p(1., 0., -1.), p(1., 1., -1.), p(-1., 1., -1.)]),
        ("left wall", RED, [p(-1., 0., 1.), p(-1., 0., -1.), p(-1., 1., -1.), p(-1., 1., 1.)]),
    ];
    let mut meshes = Vec::new();
    for (name, material, corners) in quads {
        let mut mesh = MeshBuilder::new(name);
        mesh.quad(material, corners, 4, 1.0);
        meshes.push(mesh.finish());
    }
    meshes.push(actor);
    let mut scene = assemble(name, materials, meshes);
    if let Some(Instance { animation: moves, .. }) = scene.instances.last_mut() {
        *moves = Some(animation);
    }
    scene.lights.push(Light {
        name: "lamp".into(),
        kind: LightKind::Spot { inner: 20f32.to_radians(), outer: 50f32.to_radians() },
        color: Vec3::new(60.0, 54.0, 44.0),
        position: Vec3::new(1.7, 2.8, 1.7),
        direction: Vec3::new(-0.62, -0.55, -0.56).normalize(),
        shadow: true,
    });
    scene.cameras.insert("default".into(), view(Vec3::new(0.6, 1.4, 2.6), Vec3::new(-0.2, 1.1, -0.9), 64.0, 6.4));
    scene
}
