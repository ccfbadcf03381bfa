//! Rooms of ordinary size that usual lamps light alone: panels in a ceiling, bare tubes, bulbs in shades.

use glam::{Mat4, Vec2, Vec3};

use super::shapes::{MeshBuilder, STANDING};
use super::solid::{Solid, lining};
use super::{assemble, matte, view};
use crate::scene::{Material, Mesh, Scene};

const WALL: u32 = 0;
const FLOOR: u32 = 1;
const WOOD: u32 = 2;
const DARK: u32 = 3;
/// The first material of a scene's own.
const OWN: u32 = 4;

fn materials(own: impl IntoIterator<Item = Material>) -> Vec<Material> {
    let mut materials = vec![
        matte("wall", Vec3::new(0.78, 0.76, 0.72)),
        matte("floor", Vec3::new(0.4, 0.36, 0.32)),
        matte("wood", Vec3::new(0.52, 0.35, 0.21)),
        matte("dark", Vec3::splat(0.12)),
    ];
    materials.extend(own);
    materials
}

fn glowing(name: &str, emission: Vec3) -> Material {
    Material { emission, ..matte(name, Vec3::splat(0.7)) }
}

/// A room around the y axis from the floor up, of inner size `size`, in walls of 20 cm.
fn hollow(size: Vec3) -> Solid {
    let (low, high) = (Vec3::new(-0.5 * size.x, 0.0, -0.5 * size.z), Vec3::new(0.5 * size.x, size.y, 0.5 * size.z));
    let mut solid = Solid::default();
    solid.fill(low - 0.2, high + 0.2, WALL);
    solid.carve(low, high, lining(FLOOR, WALL, WALL));
    solid
}

fn one(name: &str, build: impl FnOnce(&mut MeshBuilder)) -> Mesh {
    let mut mesh = MeshBuilder::new(name);
    build(&mut mesh);
    mesh.finish()
}

/// A plate of 3 cm on four legs of 5 cm, `size.y` high, its foot in the middle of the lower face.
fn table(mesh: &mut MeshBuilder, foot: Vec3, size: Vec3) {
    let half = Vec3::new(0.5 * size.x, 0.0, 0.5 * size.z);
    let top = foot + Vec3::Y * size.y;
    mesh.cuboid(WOOD, top - half - Vec3::Y * 0.03, top + half, 1.0, [true; 6]);
    for (sx, sz) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
        let leg = foot + Vec3::new(sx * (half.x - 0.05), 0.0, sz * (half.z - 0.05));
        let thick = Vec3::new(0.025, 0.0, 0.025);
        // Into the plate, so that no crack is left.
        mesh.cuboid(WOOD, leg - thick, leg + thick + Vec3::Y * (size.y - 0.02), 1.0, STANDING);
    }
}

/// An office of 6 x 2.8 x 5 m with three panels of 0.6 x 1.2 m, 5 mm deep in its ceiling.
pub(super) fn ceiling_panel() -> Scene {
    const PANEL: u32 = OWN;
    const CUPBOARD: u32 = OWN + 1;
    const SCREEN: u32 = OWN + 2;
    let mut solid = hollow(Vec3::new(6.0, 2.8, 5.0));
    for x in [-1.8, 0.0, 1.8] {
        let (low, high) = (Vec3::new(x - 0.3, 2.8, -0.6), Vec3::new(x + 0.3, 2.805, 0.6));
        solid.carve(low, high, lining(WALL, WALL, PANEL));
    }
    let desks = one("desks", |mesh| {
        for (x, z) in [(-1.6, -0.9), (-1.6, 0.0), (1.3, -0.9), (1.3, 0.6)] {
            let foot = Vec3::new(x, 0.0, z);
            table(mesh, foot, Vec3::new(1.6, 0.74, 0.8));
            let screen = foot + Vec3::new(0.0, 0.74, 0.1);
            mesh.cuboid(SCREEN, screen - Vec3::new(0.1, 0.0, 0.08), screen + Vec3::new(0.1, 0.02, 0.08), 1.0, STANDING);
            let (low, high) = (Vec3::new(-0.28, 0.1, -0.015), Vec3::new(0.28, 0.44, 0.015));
            mesh.cuboid(SCREEN, screen + low, screen + high, 1.0, [true; 6]);
            mesh.cuboid(SCREEN, screen - Vec3::splat(0.015), screen + Vec3::new(0.015, 0.12, 0.01), 1.0, STANDING);
        }
    });
    let cupboard = one("cupboard", |mesh| {
        mesh.cuboid(CUPBOARD, Vec3::new(1.6, 0.0, -2.49), Vec3::new(2.8, 1.95, -2.05), 1.0, STANDING);
    });
    let shelf = one("shelf", |mesh| {
        for i in 0..5u8 {
            let y = 0.05 + 0.42 * f32::from(i);
            mesh.cuboid(WOOD, Vec3::new(-2.4, y, -2.49), Vec3::new(-0.6, y + 0.025, -2.15), 1.0, [true; 6]);
            let books = Vec3::new(-2.3, y + 0.025, -2.45);
            let (low, high) = (books + Vec3::X * 0.3 * f32::from(i % 3), books + Vec3::new(1.1, 0.27, 0.22));
            mesh.cuboid(CUPBOARD, low, high, 1.0, STANDING);
        }
        for x in [-2.43, -0.61] {
            mesh.cuboid(WOOD, Vec3::new(x, 0.0, -2.49), Vec3::new(x + 0.03, 1.8, -2.13), 1.0, STANDING);
        }
    });
    let materials = materials([
        glowing("panel", Vec3::new(15.0, 14.6, 13.8)),
        matte("cupboard", Vec3::new(0.3, 0.42, 0.55)),
        matte("screen", Vec3::splat(0.05)),
    ]);
    let room = one("room", |mesh| solid.build(mesh));
    let mut scene = assemble("ceiling-panel", materials, vec![room, desks, cupboard, shelf]);
    scene.cameras.insert("default".into(), view(Vec3::new(2.6, 1.65, 2.3), Vec3::new(-0.9, 1.0, -1.6), 65.0, 8.3));
    scene.cameras.insert("below".into(), view(Vec3::new(-2.7, 0.5, 2.2), Vec3::new(0.6, 1.5, -1.0), 70.0, 8.3));
    scene
}

/// A workshop of 4 x 2.6 x 6 m with a tube of 2.6 cm by 1.2 m under an open reflector, and a red one on a wall.
pub(super) fn neon_tube() -> Scene {
    const TUBE: u32 = OWN;
    const RED: u32 = OWN + 1;
    const SHEET: u32 = OWN + 2;
    const BLUE: u32 = OWN + 3;
    const LENGTH: f32 = 1.2;
    let tube = |mesh: &mut MeshBuilder, material: u32, middle: Vec3| {
        // From along y to along z.
        mesh.transform = Mat4::from_translation(middle)
            * Mat4::from_rotation_x(90f32.to_radians())
            * Mat4::from_translation(Vec3::Y * (-0.5 * LENGTH));
        mesh.cylinder(material, 0.013, LENGTH, [24, 4]);
    };
    let middle = Vec3::new(0.0, 2.45, 0.0);
    let reflector = one("reflector", |mesh| {
        let half = Vec3::new(0.05, 0.0005, 0.65);
        let ridge = Mat4::from_translation(middle + Vec3::Y * 0.06);
        mesh.transform = ridge;
        mesh.cuboid(SHEET, -half, half, 1.0, [true; 6]);
        for side in [-1.0f32, 1.0] {
            // A wing of 10 cm that leans 40 degrees down from the ridge's edge.
            mesh.transform = ridge
                * Mat4::from_translation(Vec3::X * side * half.x)
                * Mat4::from_rotation_z(side * -40f32.to_radians())
                * Mat4::from_translation(Vec3::X * side * half.x);
            mesh.cuboid(SHEET, -half, half, 1.0, [true; 6]);
        }
        for z in [-0.4, 0.4] {
            mesh.transform = Mat4::from_translation(middle + Vec3::Z * z);
            mesh.cuboid(DARK, Vec3::new(-0.005, 0.06, -0.005), Vec3::new(0.005, 0.16, 0.005), 1.0, [true; 6]);
        }
    });
    let bench = one("bench", |mesh| {
        table(mesh, Vec3::new(-1.6, 0.0, -0.8), Vec3::new(0.7, 0.9, 2.4));
        mesh.cuboid(BLUE, Vec3::new(-1.8, 0.9, -1.6), Vec3::new(-1.45, 1.15, -1.1), 1.0, STANDING);
        mesh.cuboid(DARK, Vec3::new(-1.85, 0.9, -0.4), Vec3::new(-1.6, 1.02, 0.2), 1.0, STANDING);
    });
    let boxes = one("boxes", |mesh| {
        mesh.cuboid(WOOD, Vec3::new(1.2, 0.0, -2.9), Vec3::new(1.99, 0.7, -2.0), 1.0, STANDING);
        mesh.cuboid(WOOD, Vec3::new(1.35, 0.7, -2.8), Vec3::new(1.9, 1.2, -2.2), 1.0, STANDING);
        mesh.cuboid(BLUE, Vec3::new(1.5, 0.0, -0.6), Vec3::new(1.99, 1.9, 0.9), 1.0, STANDING);
        mesh.cuboid(WOOD, Vec3::new(-0.4, 0.0, -2.0), Vec3::new(0.3, 0.45, -1.4), 1.0, STANDING);
    });
    let materials = materials([
        glowing("tube", Vec3::new(90.0, 87.0, 81.0)),
        glowing("red tube", Vec3::new(24.0, 1.6, 1.0)),
        Material { metallic: 1.0, roughness: 0.4, ..matte("sheet", Vec3::splat(0.85)) },
        matte("blue", Vec3::new(0.2, 0.32, 0.62)),
    ]);
    let meshes = vec![
        one("room", |mesh| hollow(Vec3::new(4.0, 2.6, 6.0)).build(mesh)),
        one("tube", |mesh| tube(mesh, TUBE, middle)),
        one("red tube", |mesh| tube(mesh, RED, Vec3::new(-1.95, 1.7, -0.9))),
        reflector,
        bench,
        boxes,
    ];
    let mut scene = assemble("neon-tube", materials, meshes);
    scene.cameras.insert("default".into(), view(Vec3::new(1.2, 1.6, 2.7), Vec3::new(-0.5, 1.25, -1.6), 65.0, 7.7));
    scene.cameras.insert("tube".into(), view(Vec3::new(0.5, 1.7, 1.4), Vec3::new(-0.1, 2.45, -0.1), 60.0, 7.7));
    scene
}

/// A living room's corner of 3.6 x 2.6 x 3.6 m with a floor lamp and a table lamp.
pub(super) fn lampshade() -> Scene {
    const BULB: u32 = OWN;
    const SHADE: u32 = OWN + 1;
    const BLUE: u32 = OWN + 2;
    // Where the shades begin.
    let places = [Vec3::new(1.25, 1.42, -1.3), Vec3::new(-1.35, 0.78, -1.35)];
    let feet = [0.0, 0.48];
    let bulbs = one("bulbs", |mesh| {
        for place in places {
            mesh.icosphere(BULB, place + Vec3::Y * 0.1, 0.03, 2);
        }
    });
    let shades = one("shades", |mesh| {
        for place in places {
            mesh.transform = Mat4::from_translation(place);
            mesh.lathe(SHADE, 48, 4, 1.0, &[Vec2::new(0.2, 0.0), Vec2::new(0.12, 0.22)]);
        }
    });
    let stands = one("stands", |mesh| {
        for (place, foot) in places.into_iter().zip(feet) {
            mesh.transform = Mat4::from_translation(place.with_y(foot));
            mesh.cylinder(DARK, 0.11, 0.02, [24, 1]);
            mesh.cylinder(DARK, 0.012, place.y + 0.075 - foot, [12, 1]);
        }
    });
    let furniture = one("furniture", |mesh| {
        mesh.cuboid(BLUE, Vec3::new(-0.95, 0.0, -1.7), Vec3::new(0.85, 0.42, -0.85), 1.0, STANDING);
        mesh.cuboid(BLUE, Vec3::new(-0.95, 0.4, -1.75), Vec3::new(0.85, 0.85, -1.5), 1.0, [true; 6]);
        for x in [-0.95, 0.65] {
            mesh.cuboid(BLUE, Vec3::new(x, 0.4, -1.52), Vec3::new(x + 0.2, 0.6, -0.85), 1.0, [true; 6]);
        }
        table(mesh, Vec3::new(-1.35, 0.0, -1.35), Vec3::new(0.6, 0.48, 0.6));
        table(mesh, Vec3::new(-0.1, 0.0, 0.1), Vec3::new(1.1, 0.4, 0.6));
        mesh.cuboid(DARK, Vec3::new(-0.3, 0.4, 0.0), Vec3::new(0.0, 0.44, 0.2), 1.0, STANDING);
    });
    let materials = materials([
        glowing("bulb", Vec3::new(450.0, 370.0, 260.0)),
        Material { two_sided: true, ..matte("shade", Vec3::new(0.8, 0.79, 0.76)) },
        matte("blue", Vec3::new(0.2, 0.32, 0.62)),
    ]);
    let room = one("room", |mesh| hollow(Vec3::new(3.6, 2.6, 3.6)).build(mesh));
    let mut scene = assemble("lampshade", materials, vec![room, bulbs, shades, stands, furniture]);
    scene.cameras.insert("default".into(), view(Vec3::new(0.6, 1.5, 1.7), Vec3::new(-0.1, 0.95, -1.4), 70.0, 5.7));
    scene.cameras.insert("lamp".into(), view(Vec3::new(0.1, 1.1, 0.2), Vec3::new(1.2, 1.5, -1.3), 55.0, 5.7));
    scene
}
