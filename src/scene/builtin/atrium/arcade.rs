//! Columns, arches, vaults and railings.

use std::f32::consts::PI;

use glam::{Mat4, Vec2, Vec3};

use super::materials::{ASHLAR, MARBLE, PLASTER, TRIM};
use super::{ARCADE_FLOOR, COURT, GALLERY_FLOOR, LOWER_SPRING, UPPER_SPRING, WALL, WALL_TOP, bays, column_places};
use crate::scene::Mesh;
use crate::scene::builtin::shapes::{MeshBuilder, STANDING};

/// Half the thickness of the wall over the arches.
const HALF_WALL: f32 = 0.24;
/// Half the width of the wall between two arches, over a column.
const HALF_PIER: f32 = 0.25;

/// Column of the ground floor, its foot at the origin.
pub(super) fn lower_column() -> Mesh {
    column("lower column", LOWER_SPRING - ARCADE_FLOOR, 0.27)
}

/// Column of the gallery, its foot at the origin.
pub(super) fn upper_column() -> Mesh {
    column("upper column", UPPER_SPRING - GALLERY_FLOOR, 0.19)
}

fn column(name: &str, height: f32, r: f32) -> Mesh {
    let mut mesh = MeshBuilder::new(name);
    let plinth = r * 1.5;
    mesh.cuboid(TRIM, Vec3::new(-plinth, 0.0, -plinth), Vec3::new(plinth, r * 0.55, plinth), 1.0, STANDING);
    // Attic base: two rings and a hollow between them.
    let base = [
        (1.30, 0.5),
        (1.42, 0.62),
        (1.42, 0.78),
        (1.26, 0.92),
        (1.16, 0.98),
        (1.18, 1.08),
        (1.28, 1.16),
        (1.20, 1.28),
        (1.0, 1.36),
    ];
    let foot = 1.33 * r;
    mesh.lathe(TRIM, 24, 8, 1.0, &base.map(|(x, y)| Vec2::new(x * r, y * r)));
    // Shaft with a slight swelling.
    let capital = height - 2.1 * r;
    let shaft: Vec<Vec2> = (0..=6)
        .map(|i| {
            let t = i as f32 / 6.0;
            Vec2::new(r * (1.0 - 0.16 * t * t), foot + (capital + 0.05 - foot) * t)
        })
        .collect();
    mesh.lathe(MARBLE, 24, 6, 2.0, &shaft);
    // Bell of the capital, pressed out into two rows of eight leaves.
    mesh.surface(TRIM, 48, 10, Vec2::new(2.0, 0.5), |u, v| {
        let angle = -u * 2.0 * PI;
        let bell = 0.86 + 0.55 * v * v;
        let row = (v * 2.0).floor();
        let curl = (PI * (v * 2.0 - row).clamp(0.0, 1.0)).sin() * 0.20;
        let leaf = (4.0 * angle + row * PI * 0.5).sin().abs();
        let radius = r * (bell + curl * leaf);
        Vec3::new(radius * angle.cos(), capital + 1.68 * r * v, radius * angle.sin())
    });
    let abacus = r * 1.55;
    let (low, high) = (capital + 1.62 * r, height + 0.02);
    mesh.cuboid(TRIM, Vec3::new(-abacus, low, -abacus), Vec3::new(abacus, high, abacus), 1.0, [true; 6]);
    mesh.finish()
}

/// The walls over the columns of both storeys, with their arches.
pub(super) fn arches() -> Mesh {
    let mut mesh = MeshBuilder::new("arches");
    for (a, b, outward) in bays() {
        for (spring, rise, top) in [(LOWER_SPRING, 1.12, GALLERY_FLOOR), (UPPER_SPRING, 1.0, WALL_TOP)] {
            // x along the bay, z out of the court.
            let along = (b - a).normalize();
            let origin = (a + b) * 0.5 + Vec3::Y * spring;
            mesh.transform = frame(along, outward, origin);
            let half = a.distance(b) * 0.5;
            arch_wall(&mut mesh, half, half - HALF_PIER, rise, top - spring);
            moulding(&mut mesh, half - HALF_PIER, rise);
            keystone(&mut mesh, rise);
        }
    }
    for place in column_places() {
        // Blocks on the columns carry the ends of the arches around the corners.
        for (spring, top) in [(LOWER_SPRING, GALLERY_FLOOR), (UPPER_SPRING, WALL_TOP)] {
            if place.x.abs() > COURT[0] - 0.01 && place.z.abs() > COURT[1] - 0.01 {
                mesh.transform = Mat4::from_translation(place + Vec3::Y * spring);
                let (low, high) = (Vec3::new(-0.265, 0.0, -0.265), Vec3::new(0.265, top - spring - 0.02, 0.265));
                mesh.cuboid(ASHLAR, low, high, 2.0, [true, true, false, false, true, true]);
            }
        }
    }
    mesh.finish()
}

/// A right-handed frame with x along a bay, y up and z out of the court.
fn frame(along: Vec3, outward: Vec3, origin: Vec3) -> Mat4 {
    // Along and outward are given so that along x up = outward.
    Mat4::from_cols(along.extend(0.0), Vec3::Y.extend(0.0), outward.extend(0.0), origin.extend(1.0))
}

/// Wall between two columns above the springing, with an elliptical opening.
fn arch_wall(mesh: &mut MeshBuilder, half: f32, opening: f32, rise: f32, top: f32) {
    const SEGMENTS: u32 = 24;
    let curve = |t: f32| Vec2::new(opening * (PI * (1.0 - t)).cos(), rise * (PI * t).sin().max(0.0));
    // Soffit, seen from below.
    mesh.surface(TRIM, SEGMENTS, 1, Vec2::new(3.0, 0.5), |u, v| curve_point(curve(u), (v * 2.0 - 1.0) * HALF_WALL));
    for side in [-1.0f32, 1.0] {
        let z = side * HALF_WALL;
        let normal = Vec3::Z * side;
        // From the arch up to the top, and the strips over the columns.
        let point = |x: f32, y: f32| (Vec3::new(x, y, z), normal, Vec2::new(x, top - y) * 0.5);
        let flip = |u: f32| if side > 0.0 { u } else { 1.0 - u };
        mesh.grid(ASHLAR, SEGMENTS, 1, |u, v| {
            let p = curve(flip(u));
            point(p.x, p.y + (top - p.y) * v)
        });
        for (from, to) in [(-half, -opening), (opening, half)] {
            mesh.grid(ASHLAR, 1, 1, |u, v| point(from + (to - from) * flip(u), top * v));
        }
    }
}

fn curve_point(p: Vec2, z: f32) -> Vec3 {
    p.extend(z)
}

/// A raised band around the opening on the court's side.
fn moulding(mesh: &mut MeshBuilder, opening: f32, rise: f32) {
    let profile = [(-0.012, 0.02), (-0.012, 0.075), (0.05, 0.095), (0.11, 0.07), (0.15, 0.055), (0.16, -0.01)];
    mesh.surface(TRIM, 24, 5, Vec2::new(4.0, 0.3), |u, v| {
        let x = (v * 5.0).clamp(0.0, 5.0);
        let (i, s) = ((x as usize).min(4), x - (x as usize).min(4) as f32);
        let out = profile[i].0 + (profile[i + 1].0 - profile[i].0) * s;
        let depth = profile[i].1 + (profile[i + 1].1 - profile[i].1) * s;
        let angle = PI * u;
        let p = Vec2::new((opening + out) * angle.cos(), (rise + out) * angle.sin());
        curve_point(p, -HALF_WALL - depth)
    });
}

fn keystone(mesh: &mut MeshBuilder, rise: f32) {
    let (low, high) =
        (Vec3::new(-0.09, rise - 0.05, -HALF_WALL - 0.13), Vec3::new(0.09, rise + 0.3, -HALF_WALL + 0.05));
    mesh.cuboid(TRIM, low, high, 1.0, [true; 6]);
}

/// Groin vaults over the ground floor's arcade, one per bay and corner.
pub(super) fn vaults() -> Mesh {
    let mut mesh = MeshBuilder::new("vaults");
    for (a, b, outward) in bays() {
        let depth = if outward.x.abs() > 0.5 { WALL[0] - COURT[0] } else { WALL[1] - COURT[1] };
        let centre = (a + b) * 0.5 + outward * (depth * 0.5);
        let size = (b - a).abs() + outward.abs() * depth;
        vault(&mut mesh, centre, Vec2::new(size.x, size.z) * 0.5);
    }
    for (sx, sz) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
        let centre = Vec3::new(sx * (WALL[0] + COURT[0]) * 0.5, 0.0, sz * (WALL[1] + COURT[1]) * 0.5);
        vault(&mut mesh, centre, Vec2::new(WALL[0] - COURT[0], WALL[1] - COURT[1]) * 0.5);
    }
    mesh.finish()
}

/// Two crossing barrels: the ceiling is the higher of both, so each half of it is a web between two diagonals.
fn vault(mesh: &mut MeshBuilder, centre: Vec3, half: Vec2) {
    const RISE: f32 = 1.30;
    mesh.transform = Mat4::from_translation(centre + Vec3::Y * LOWER_SPRING);
    let height = |x: f32| RISE * (1.0 - x * x).max(0.0).sqrt();
    for side in [-1.0f32, 1.0] {
        // Webs that touch the two edges across z, then those across x. Their fronts face down.
        mesh.surface(PLASTER, 10, 6, Vec2::ONE, |u, v| {
            let (s, t) = ((u * 2.0 - 1.0) * side, v);
            Vec3::new(s * t * half.x, height(s * t), side * t * half.y)
        });
        mesh.surface(PLASTER, 10, 6, Vec2::ONE, |u, v| {
            let (s, t) = ((1.0 - u * 2.0) * side, v);
            Vec3::new(side * t * half.x, height(s * t), s * t * half.y)
        });
    }
}

/// Balustrades between the columns of the gallery.
pub(super) fn railings() -> Mesh {
    let mut mesh = MeshBuilder::new("railings");
    let shape = [
        (0.045, 0.0),
        (0.052, 0.05),
        (0.03, 0.09),
        (0.062, 0.24),
        (0.055, 0.32),
        (0.026, 0.48),
        (0.045, 0.56),
        (0.045, 0.62),
    ];
    let profile = shape.map(|(r, y)| Vec2::new(r, y));
    for (a, b, outward) in bays() {
        let along = (b - a).normalize();
        let half = a.distance(b) * 0.5 - 0.22;
        mesh.transform = frame(along, outward, (a + b) * 0.5 + Vec3::Y * GALLERY_FLOOR);
        let ends = [false, false, true, true, true, true];
        mesh.cuboid(TRIM, Vec3::new(-half, 0.06, -0.09), Vec3::new(half, 0.17, 0.09), 1.0, ends);
        mesh.cuboid(TRIM, Vec3::new(-half, 0.75, -0.1), Vec3::new(half, 0.88, 0.1), 1.0, ends);
        let count = (half * 2.0 / 0.27).floor().max(1.0);
        let place = mesh.transform;
        for i in 0..count as u32 {
            let x = -half + half * 2.0 * (i as f32 + 0.5) / count;
            mesh.transform = place * Mat4::from_translation(Vec3::new(x, 0.15, 0.0));
            mesh.lathe(MARBLE, 10, 7, 1.0, &profile);
        }
    }
    mesh.finish()
}
