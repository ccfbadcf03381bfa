//! Hanging cloth: long banners on the court's fronts and gathered curtains in the arches.

use std::f32::consts::{PI, TAU};

use glam::{Mat4, Vec2, Vec3};

use super::materials::{BLUE, GOLD, GREEN, RED};
use super::{BAYS, COURT};
use crate::scene::Mesh;
use crate::scene::builtin::shapes::MeshBuilder;

/// Banners before both long fronts, in every other bay.
pub(super) fn banners() -> Mesh {
    let mut mesh = MeshBuilder::new("banners");
    let colors = [RED, GREEN, BLUE];
    for (side, shift) in [(1.0f32, 0), (-1.0, 1)] {
        for i in 0..4 {
            let bay = 2 * i + shift;
            let x = COURT[0] * (2.0 * (bay as f32 + 0.5) / BAYS[0] as f32 - 1.0);
            let place = Vec3::new(x, 0.0, side * (COURT[1] - 0.72));
            // x to the right for one who looks at the front from the court.
            let right = Vec3::new(-side, 0.0, 0.0);
            mesh.transform = Mat4::from_cols(
                right.extend(0.0),
                Vec3::Y.extend(0.0),
                Vec3::new(0.0, 0.0, -side).extend(0.0),
                place.extend(1.0),
            );
            banner(&mut mesh, colors[(i + 2 * shift) as usize % 3], bay as f32);
        }
    }
    mesh.finish()
}

/// One banner in the plane z = 0 with its rod.
fn banner(mesh: &mut MeshBuilder, material: u32, phase: f32) {
    let (top, bottom, half) = (8.35, 3.55, 0.82);
    mesh.surface(material, 32, 28, Vec2::ONE, |u, v| {
        let (x, drop) = (u * 2.0 - 1.0, 1.0 - v);
        // Folds grow on the way down and the lower hem swings a little.
        let depth = 0.015 + 0.085 * drop.sqrt();
        let fold = (x * 3.5 * PI + phase + 0.9 * (drop * 2.5 + phase).sin()).sin();
        let swing = 0.10 * drop * drop * (x * 1.7 + phase).cos();
        let narrow = 1.0 - 0.08 * (PI * drop).sin();
        // The lower edge hangs in a shallow point.
        let edge = 0.28 * (1.0 - x.abs()) * drop;
        Vec3::new(x * half * narrow, bottom + (top - bottom) * v - edge, depth * fold + swing)
    });
    rod(mesh, Vec3::new(0.0, top + 0.02, 0.0), half + 0.12, 0.022);
    for x in [-1.0f32, 1.0] {
        mesh.icosphere(GOLD, Vec3::new(x * (half + 0.14), top + 0.02, 0.0), 0.05, 2);
        // Brackets back to the wall.
        let (low, high) =
            (Vec3::new(x * 0.6 - 0.015, top + 0.005, -0.5), Vec3::new(x * 0.6 + 0.015, top + 0.035, 0.01));
        mesh.cuboid(GOLD, low, high, 1.0, [true; 6]);
    }
}

fn rod(mesh: &mut MeshBuilder, centre: Vec3, half: f32, radius: f32) {
    mesh.surface(GOLD, 10, 2, Vec2::ONE, |u, v| {
        let (s, c) = (u * TAU).sin_cos();
        centre + Vec3::new((v * 2.0 - 1.0) * half, radius * c, radius * s)
    });
}

/// Pairs of curtains drawn to the sides of some arches of the ground floor.
pub(super) fn curtains() -> Mesh {
    let mut mesh = MeshBuilder::new("curtains");
    let colors = [BLUE, RED, GREEN];
    for (side, shift) in [(1.0f32, 1), (-1.0, 0)] {
        for i in 0..4 {
            let bay = 2 * i + shift;
            let x = COURT[0] * (2.0 * (bay as f32 + 0.5) / BAYS[0] as f32 - 1.0);
            for half in [-1.0f32, 1.0] {
                let place = Vec3::new(x, 0.0, side * (COURT[1] + 0.42));
                mesh.transform = Mat4::from_translation(place);
                curtain(&mut mesh, colors[(i + shift) as usize % 3], half);
            }
        }
    }
    mesh.finish()
}

/// A curtain from the middle of the arch to its side (`half` = -1 or 1), tied back at a third of its height.
fn curtain(mesh: &mut MeshBuilder, material: u32, half: f32) {
    let (top, bottom, tie) = (3.62, 0.2, 0.36);
    mesh.surface(material, 28, 18, Vec2::new(0.7, 1.0), |u, v| {
        let y = bottom + (top - bottom) * v;
        // Width left at this height: full at the rod, a handful at the tie, a little more below.
        let above = ((v - tie) / (1.0 - tie)).max(0.0);
        let below = ((tie - v) / tie).max(0.0);
        let width = 0.24 + 0.80 * above.powf(1.7) + 0.16 * below.sqrt();
        let x = 1.13 - width * u;
        let depth = 0.035 + 0.03 * (1.0 - above);
        Vec3::new(half * x, y, depth * (u * 9.0 * PI).sin())
    });
    // The tie, a gold cord around the gathered cloth.
    let at = bottom + (top - bottom) * tie;
    mesh.ring(GOLD, Vec3::new(half * 1.01, at, 0.0), Vec3::X * 0.155, Vec3::Z * 0.10, 0.02, [20, 6]);
    rod(mesh, Vec3::new(half * 0.56, top + 0.015, 0.0), 0.575, 0.018);
}
