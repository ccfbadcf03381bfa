//! Two rooms that only emitting surfaces light, each much smaller than a voxel of a usual volume.

use glam::{Mat4, Vec3};

use super::noise::Random;
use super::shapes::{MeshBuilder, STANDING};
use super::solid::{Solid, lining};
use super::{assemble, matte, view};
use crate::scene::{Material, Mesh, Scene};

const WHITE: u32 = 0;
const RED: u32 = 1;
const GREEN: u32 = 2;
const GLOW: u32 = 3;

/// A box of 2 m without its front, with two blocks, lit by a quad of 47 x 38 cm that hangs 2.5 cm below the ceiling.
pub(super) fn small_quad() -> Scene {
    let materials = vec![
        matte("white", Vec3::new(0.725, 0.71, 0.68)),
        matte("red", Vec3::new(0.63, 0.065, 0.05)),
        matte("green", Vec3::new(0.14, 0.45, 0.091)),
        Material { emission: Vec3::new(38.0, 31.0, 22.0), ..matte("light", Vec3::splat(0.78)) },
    ];
    let mut solid = Solid::default();
    solid.fill(Vec3::new(-1.05, -0.05, -1.05), Vec3::new(1.05, 2.05, 1.0), WHITE);
    // The left wall's face looks to +x.
    solid.carve(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, 2.0, 1.0), [GREEN, RED, WHITE, WHITE, WHITE, WHITE]);
    let mut room = MeshBuilder::new("room");
    solid.build(&mut room);
    let mut lamp = MeshBuilder::new("light");
    let p = |x: f32, z: f32| Vec3::new(0.235 * x, 1.975, 0.19 * z);
    lamp.quad(GLOW, [p(-1.0, -1.0), p(1.0, -1.0), p(1.0, 1.0), p(-1.0, 1.0)], 1, 1.0);
    let mut meshes = vec![room.finish(), lamp.finish()];
    for (name, x, z, height, degrees) in
        [("short block", 0.35, 0.1, 0.6, -16.0f32), ("tall block", -0.35, -0.4, 1.2, 17.0)]
    {
        let mut block = MeshBuilder::new(name);
        block.transform = Mat4::from_translation(Vec3::new(x, 0.0, z)) * Mat4::from_rotation_y(degrees.to_radians());
        let half = Vec3::new(0.3, 0.0, 0.3);
        block.cuboid(WHITE, -half, half + Vec3::Y * height, 1.0, STANDING);
        meshes.push(block.finish());
    }
    let mut scene = assemble("small-quad", materials, meshes);
    scene.cameras.insert("default".into(), view(Vec3::new(0.0, 1.05, 0.97), Vec3::new(0.0, 1.0, -1.0), 88.0, 3.6));
    scene.cameras.insert("outside".into(), view(Vec3::new(0.0, 1.0, 6.8), Vec3::new(0.0, 1.0, 0.0), 20.5, 3.6));
    scene
}

/// Colours of the small emitters; their materials follow the room's.
const COLORS: [(&str, [f32; 3]); 6] = [
    ("warm white", [1.0, 0.75, 0.45]),
    ("red", [1.0, 0.10, 0.06]),
    ("green", [0.12, 0.9, 0.15]),
    ("blue", [0.10, 0.22, 1.0]),
    ("magenta", [0.9, 0.10, 0.7]),
    ("cyan", [0.10, 0.8, 0.9]),
];

/// A room of 5 x 2.8 x 5 m with 108 spheres and quads of 1 to 4 cm that glow on its walls and on strings.
pub(super) fn emitters() -> Scene {
    const WALL: u32 = 0;
    const FLOOR: u32 = 1;
    const WOOD: u32 = 2;
    const FIRST: u32 = 3;
    let mut materials = vec![
        matte("wall", Vec3::splat(0.7)),
        matte("floor", Vec3::new(0.42, 0.36, 0.3)),
        matte("wood", Vec3::new(0.5, 0.33, 0.2)),
    ];
    materials.extend(
        COLORS.map(|(name, color)| Material {
            emission: Vec3::from_array(color) * 110.0,
            ..matte(name, Vec3::splat(0.5))
        }),
    );
    let mut solid = Solid::default();
    solid.fill(Vec3::new(-2.7, -0.2, -2.7), Vec3::new(2.7, 3.0, 2.7), WALL);
    solid.carve(Vec3::new(-2.5, 0.0, -2.5), Vec3::new(2.5, 2.8, 2.5), lining(FLOOR, WALL, WALL));
    let mut room = MeshBuilder::new("room");
    solid.build(&mut room);
    let mut meshes = vec![room.finish(), table(WOOD)];
    let mut random = Random(41);
    let mut spheres = MeshBuilder::new("spheres");
    let mut quads = MeshBuilder::new("quads");
    for i in 0..54u32 {
        let color = FIRST + i % COLORS.len() as u32;
        // Strings of nine under the ceiling, sagging.
        let (string, along) = (i / 9, (i % 9) as f32 / 8.0);
        let sag = 4.0 * along * (1.0 - along);
        let place = Vec3::new(-2.2 + 4.4 * along, 2.65 - 0.5 * sag, -2.0 + 0.75 * string as f32);
        spheres.icosphere(color, place, random.range(0.005, 0.02), 1);
        let half = random.range(0.005, 0.02);
        quads.transform = on_wall(i, &mut random);
        let p = |x: f32, y: f32| Vec3::new(x, y, 0.0) * half;
        quads.quad(color, [p(-1.0, -1.0), p(1.0, -1.0), p(1.0, 1.0), p(-1.0, 1.0)], 1, 1.0);
    }
    meshes.extend([spheres.finish(), quads.finish()]);
    let mut scene = assemble("emitters", materials, meshes);
    scene.cameras.insert("default".into(), view(Vec3::new(1.6, 1.6, 2.3), Vec3::new(-0.4, 1.05, -1.5), 65.0, 7.8));
    scene
}

/// A place one centimetre before one of the four walls, looking into the room.
fn on_wall(i: u32, random: &mut Random) -> Mat4 {
    let turn = Mat4::from_rotation_y((i % 4) as f32 * std::f32::consts::FRAC_PI_2);
    turn * Mat4::from_translation(Vec3::new(random.range(-2.3, 2.3), random.range(0.2, 2.5), -2.49))
}

/// A table with a box on it: something to cast shadows.
fn table(material: u32) -> Mesh {
    let mut mesh = MeshBuilder::new("table");
    mesh.cuboid(material, Vec3::new(-1.2, 0.72, -1.3), Vec3::new(0.6, 0.76, -0.4), 1.0, [true; 6]);
    for (x, z) in [(-1.15, -1.25), (0.49, -1.25), (-1.15, -0.51), (0.49, -0.51)] {
        mesh.cuboid(material, Vec3::new(x, 0.0, z), Vec3::new(x + 0.06, 0.74, z + 0.06), 1.0, STANDING);
    }
    mesh.cuboid(material, Vec3::new(-0.7, 0.76, -1.1), Vec3::new(-0.3, 1.1, -0.7), 1.0, STANDING);
    mesh.finish()
}
