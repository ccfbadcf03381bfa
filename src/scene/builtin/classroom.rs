//! A class room of 9 x 3 x 12 m with windows along one side, on a ground far larger than itself and far from the
//! origin.

use glam::{Mat4, Vec3};

use super::shapes::{MeshBuilder, STANDING};
use super::solid::{Solid, lining};
use super::{assemble, matte, sun, view};
use crate::scene::{Instance, Material, Mesh, Scene};

const PLASTER: u32 = 0;
const FLOOR: u32 = 1;
const FRAME: u32 = 2;
const WOOD: u32 = 3;
const METAL: u32 = 4;
const BOARD: u32 = 5;
const GROUND: u32 = 6;

/// Half the room's size along x and z, and its height.
const ROOM: Vec3 = Vec3::new(4.5, 3.0, 6.0);
/// Thickness of the walls.
const WALL: f32 = 0.15;

/// On a ground of 220 m: a volume around everything has voxels larger than the walls are thick.
pub(super) fn huge_ground() -> Scene {
    scene("huge-ground", 110.0, Vec3::ZERO)
}

/// On a ground of 30 m, 100 km from the origin. Meshes stay around zero; their instances are moved.
pub(super) fn far_away() -> Scene {
    scene("far-away", 15.0, Vec3::new(80_000.0, 0.0, -60_000.0))
}

fn scene(name: &str, ground: f32, origin: Vec3) -> Scene {
    let mut level = MeshBuilder::new("ground");
    let p = |x: f32, z: f32| Vec3::new(x * ground, -0.15, z * ground);
    level.quad(GROUND, [p(-1.0, 1.0), p(1.0, 1.0), p(1.0, -1.0), p(-1.0, -1.0)], 1, 1.0);
    let mut scene = assemble(name, materials(), vec![level.finish(), shell(), board(), desk(), chair()]);
    // In rows before the board, instead of the single ones.
    scene.instances.truncate(3);
    for (row, column) in (0..5u8).flat_map(|row| (0..3u8).map(move |column| (row, column))) {
        let place = Vec3::new(2.6 * f32::from(column) - 2.4, 0.0, 1.6 * f32::from(row) - 2.6);
        for (name, mesh) in [("desk", 3), ("chair", 4)] {
            scene.instances.push(Instance {
                name: format!("{name} {}", 3 * row + column + 1),
                mesh,
                transform: Mat4::from_translation(place),
                animation: None,
            });
        }
    }
    for instance in &mut scene.instances {
        instance.transform = Mat4::from_translation(origin) * instance.transform;
    }
    scene.lights.push(sun(Vec3::new(32.0, 29.0, 25.0), Vec3::new(0.70, -0.62, -0.34)));
    scene.sky = Vec3::new(3.0, 3.6, 4.5);
    let diagonal = 2.0 * ground * std::f32::consts::SQRT_2;
    for (name, eye, target) in [
        ("default", Vec3::new(3.7, 1.65, 5.6), Vec3::new(-1.2, 1.05, -3.0)),
        ("board", Vec3::new(0.4, 1.25, 2.2), Vec3::new(0.0, 1.4, -6.0)),
        ("outside", Vec3::new(-12.0, 2.2, 9.0), Vec3::new(0.0, 1.2, 0.0)),
    ] {
        scene.cameras.insert(name.into(), view(origin + eye, origin + target, 62.0, diagonal));
    }
    scene
}

fn materials() -> Vec<Material> {
    vec![
        matte("plaster", Vec3::new(0.76, 0.74, 0.69)),
        matte("linoleum", Vec3::new(0.42, 0.33, 0.25)),
        matte("frame", Vec3::splat(0.8)),
        matte("wood", Vec3::new(0.58, 0.41, 0.25)),
        matte("metal", Vec3::new(0.2, 0.28, 0.42)),
        matte("board", Vec3::new(0.06, 0.2, 0.13)),
        matte("ground", Vec3::new(0.3, 0.32, 0.22)),
    ]
}

/// Floor, walls and roof; the windows look to -x.
fn shell() -> Mesh {
    let mut solid = Solid::default();
    let out = Vec3::new(ROOM.x + WALL, 0.0, ROOM.z + WALL);
    solid.fill(-out - Vec3::Y * 0.4, out + Vec3::Y * (ROOM.y + 0.2), PLASTER);
    let inner = Vec3::new(ROOM.x, 0.0, ROOM.z);
    solid.carve(-inner, inner + Vec3::Y * ROOM.y, lining(FLOOR, PLASTER, PLASTER));
    for i in 0..5u8 {
        let z = 2.3 * (f32::from(i) - 2.0);
        let (low, high) = (Vec3::new(-out.x, 0.9, z - 0.85), Vec3::new(-ROOM.x, 2.6, z + 0.85));
        solid.carve(low, high, [FRAME; 6]);
        // The window's cross.
        let middle = Vec3::new(-ROOM.x - 0.5 * WALL, 0.0, z);
        solid.fill(middle + Vec3::new(-0.025, 0.9, -0.03), middle + Vec3::new(0.025, 2.6, 0.03), FRAME);
        solid.fill(middle + Vec3::new(-0.025, 2.1, -0.85), middle + Vec3::new(0.025, 2.16, 0.85), FRAME);
    }
    let mut mesh = MeshBuilder::new("shell");
    solid.build(&mut mesh);
    mesh.finish()
}

/// The board, a closed door and a cupboard, each reaching into its wall or standing on the floor.
fn board() -> Mesh {
    let mut mesh = MeshBuilder::new("board");
    let wall = -ROOM.z;
    mesh.cuboid(BOARD, Vec3::new(-1.9, 0.95, wall - 0.01), Vec3::new(1.9, 2.2, wall + 0.03), 1.0, [true; 6]);
    mesh.cuboid(FRAME, Vec3::new(-1.9, 0.9, wall - 0.01), Vec3::new(1.9, 0.94, wall + 0.11), 1.0, [true; 6]);
    mesh.cuboid(WOOD, Vec3::new(ROOM.x - 0.03, 0.0, -5.2), Vec3::new(ROOM.x + 0.01, 2.05, -4.2), 1.0, STANDING);
    mesh.cuboid(WOOD, Vec3::new(ROOM.x - 0.45, 0.0, -2.0), Vec3::new(ROOM.x + 0.01, 1.8, 0.6), 1.0, STANDING);
    mesh.finish()
}

fn desk() -> Mesh {
    let mut mesh = MeshBuilder::new("desk");
    mesh.cuboid(WOOD, Vec3::new(-0.65, 0.72, -0.28), Vec3::new(0.65, 0.745, 0.28), 1.0, [true; 6]);
    legs(&mut mesh, [0.58, 0.22], 0.73);
    mesh.finish()
}

fn chair() -> Mesh {
    let mut mesh = MeshBuilder::new("chair");
    mesh.transform = Mat4::from_translation(Vec3::new(0.05, 0.0, 0.55));
    mesh.cuboid(WOOD, Vec3::new(-0.2, 0.44, -0.2), Vec3::new(0.2, 0.46, 0.2), 1.0, [true; 6]);
    mesh.cuboid(WOOD, Vec3::new(-0.2, 0.62, 0.17), Vec3::new(0.2, 0.84, 0.185), 1.0, [true; 6]);
    for x in [-0.17, 0.145] {
        mesh.cuboid(METAL, Vec3::new(x, 0.45, 0.15), Vec3::new(x + 0.025, 0.82, 0.175), 1.0, STANDING);
    }
    legs(&mut mesh, [0.17, 0.17], 0.45);
    mesh.finish()
}

/// Four legs of 2.5 cm around the origin.
fn legs(mesh: &mut MeshBuilder, [x, z]: [f32; 2], height: f32) {
    for (sx, sz) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let foot = Vec3::new(sx * x, 0.0, sz * z);
        let half = Vec3::new(0.0125, 0.0, 0.0125);
        mesh.cuboid(METAL, foot - half, foot + half + Vec3::Y * height, 1.0, STANDING);
    }
}
