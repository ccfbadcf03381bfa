//! A street under a grey sky: without a sun, all light comes from a narrow strip of sky and from the houses.

use glam::Vec3;

use super::shapes::{MeshBuilder, STANDING};
use super::solid::{Lining, Solid};
use super::{assemble, matte, view};
use crate::scene::{Material, Mesh, Scene};

const ASPHALT: u32 = 0;
const PAVEMENT: u32 = 1;
const GLASS: u32 = 2;
const REVEAL: u32 = 3;
const IRON: u32 = 4;
/// The first of four colours of houses.
const FACADE: u32 = 5;

/// From house to house across the street.
const WIDTH: f32 = 13.0;
/// Of a house along the street.
const HOUSE: f32 = 14.0;
/// From floor to floor.
const STOREY: f32 = 3.4;

pub(super) fn build() -> Scene {
    let materials = vec![
        matte("asphalt", Vec3::splat(0.2)),
        matte("pavement", Vec3::splat(0.42)),
        Material { roughness: 0.15, ..matte("glass", Vec3::new(0.2, 0.23, 0.25)) },
        matte("reveal", Vec3::splat(0.7)),
        matte("iron", Vec3::splat(0.22)),
        matte("ochre", Vec3::new(0.68, 0.5, 0.28)),
        matte("grey", Vec3::new(0.55, 0.55, 0.53)),
        matte("red", Vec3::new(0.55, 0.24, 0.18)),
        matte("cream", Vec3::new(0.75, 0.7, 0.58)),
    ];
    let mut meshes = vec![ground()];
    for side in [-1.0f32, 1.0] {
        for i in 0..4u32 {
            let number = if side < 0.0 { i } else { i + 6 };
            meshes.push(house(number, side, HOUSE * (i as f32 - 2.0)));
        }
    }
    let mut scene = assemble("street", materials, meshes);
    scene.sky = Vec3::new(2.2, 2.5, 2.9);
    for (name, eye, target) in [
        ("default", Vec3::new(1.2, 1.7, 23.0), Vec3::new(-0.8, 5.2, 0.0)),
        ("pavement", Vec3::new(-5.3, 1.7, 12.0), Vec3::new(-4.2, 2.4, 0.0)),
    ] {
        scene.cameras.insert(name.into(), view(eye, target, 62.0, 82.0));
    }
    scene
}

fn ground() -> Mesh {
    let mut mesh = MeshBuilder::new("ground");
    let p = |x: f32, z: f32| Vec3::new(30.0 * x, 0.0, 36.0 * z);
    mesh.quad(ASPHALT, [p(-1.0, 1.0), p(1.0, 1.0), p(1.0, -1.0), p(-1.0, -1.0)], 1, 1.0);
    for (low, high) in [(-7.0, -4.2), (4.2, 7.0)] {
        mesh.cuboid(PAVEMENT, Vec3::new(low, 0.0, -34.0), Vec3::new(high, 0.14, 34.0), 1.0, STANDING);
    }
    mesh.finish()
}

/// A house from `z` on, on the side of -x or +x; its number chooses colour, storeys and balconies.
fn house(number: u32, side: f32, z: f32) -> Mesh {
    let storeys = 6 + number * 5 % 3;
    let front = 0.5 * WIDTH * side;
    let wall = FACADE + number % 4;
    // From the street inward, whichever way that is.
    let span = |a: f32, b: f32| if side < 0.0 { (front - b, front - a) } else { (front + a, front + b) };
    let mut solid = Solid::default();
    let place = |solid: &mut Solid, x: (f32, f32), y: (f32, f32), z: (f32, f32), lining: Option<Lining>| {
        let (low, high) = (Vec3::new(x.0, y.0, z.0), Vec3::new(x.1, y.1, z.1));
        match lining {
            Some(lining) => solid.carve(low, high, lining),
            None => solid.fill(low, high, wall),
        }
    };
    let top = 0.6 + STOREY * storeys as f32;
    place(&mut solid, span(0.0, 11.0), (-0.2, top), (z, z + HOUSE), None);
    // The eaves.
    place(&mut solid, span(-0.4, 0.0), (top - 0.3, top), (z, z + HOUSE), None);
    let mut mesh = MeshBuilder::new(&format!("house {}", number + 1));
    for (storey, column) in (0..storeys).flat_map(|storey| (0..5u32).map(move |column| (storey, column))) {
        let (low, middle) = (0.4 + STOREY * storey as f32, z + 2.8 * column as f32 + 1.4);
        let door = storey > 0 && (column + number).is_multiple_of(2);
        let sill = if door { 0.15 } else { 0.9 };
        let pane = [GLASS, GLASS, REVEAL, REVEAL, REVEAL, REVEAL];
        place(&mut solid, span(0.0, 0.28), (low + sill, low + 2.6), (middle - 0.65, middle + 0.65), Some(pane));
        if door {
            balcony(&mut mesh, |a, b| span(-b, -a), low, middle);
        }
    }
    solid.build(&mut mesh);
    mesh.finish()
}

/// A slab and a parapet of plates 3 cm thick; `out` gives x from distances before the wall.
fn balcony(mesh: &mut MeshBuilder, out: impl Fn(f32, f32) -> (f32, f32), low: f32, middle: f32) {
    let mut plate = |material: u32, (x0, x1): (f32, f32), y: (f32, f32), z: (f32, f32)| {
        mesh.cuboid(material, Vec3::new(x0, y.0, middle + z.0), Vec3::new(x1, y.1, middle + z.1), 1.0, [true; 6]);
    };
    plate(PAVEMENT, out(-0.02, 1.1), (low, low + 0.14), (-1.1, 1.1));
    plate(IRON, out(1.05, 1.08), (low + 0.13, low + 1.1), (-1.08, 1.08));
    plate(IRON, out(-0.02, 1.06), (low + 0.13, low + 1.1), (-1.08, -1.05));
    plate(IRON, out(-0.02, 1.06), (low + 0.13, low + 1.1), (1.05, 1.08));
}
