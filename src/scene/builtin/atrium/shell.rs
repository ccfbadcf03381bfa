//! Floors, outer walls, roof, cornices and other trim.

use glam::{Mat4, Vec2, Vec3};

use super::materials::{ASHLAR, BRICK, FLOOR, IRON, PLASTER, ROOF, TRIM, WOOD};
use super::{ARCADE_FLOOR, BAYS, COURT, GALLERY_FLOOR, LOWER_SPRING, WALL, WALL_TOP, sides};
use crate::scene::Mesh;
use crate::scene::builtin::shapes::MeshBuilder;

/// Edge of the court's lower floor, inside the columns.
const KERB: [f32; 2] = [COURT[0] - 0.55, COURT[1] - 0.55];
/// Inner edge of the roof.
const EAVES: Vec3 = Vec3::new(10.45, 9.72, 2.65);
/// Outer edge of the roof.
const RIDGE: Vec3 = Vec3::new(15.15, 11.75, 7.15);
/// Top of the outer walls.
const OUTER_TOP: f32 = 11.55;

/// The court, the arcades around it one step higher, and the gallery.
pub(super) fn floors() -> Mesh {
    let mut mesh = MeshBuilder::new("floors");
    level(&mut mesh, FLOOR, [-KERB[0], KERB[0]], [-KERB[1], KERB[1]], 0.0);
    around(&mut mesh, FLOOR, KERB, ARCADE_FLOOR);
    let gallery = [COURT[0] - 0.2, COURT[1] - 0.2];
    around(&mut mesh, WOOD, gallery, GALLERY_FLOOR - 0.02);
    let [x, z] = KERB;
    mesh.cuboid_inside(TRIM, Vec3::new(-x, 0.0, -z), Vec3::new(x, ARCADE_FLOOR, z), 1.0);
    mesh.finish()
}

/// Four rectangles between an inner one and the outer walls.
fn around(mesh: &mut MeshBuilder, material: u32, inner: [f32; 2], y: f32) {
    let ([ix, iz], [ox, oz]) = (inner, WALL);
    level(mesh, material, [-ox, ox], [iz, oz], y);
    level(mesh, material, [-ox, ox], [-oz, -iz], y);
    level(mesh, material, [ix, ox], [-iz, iz], y);
    level(mesh, material, [-ox, -ix], [-iz, iz], y);
}

/// Level rectangle facing up; its tiles are laid in world coordinates.
fn level(mesh: &mut MeshBuilder, material: u32, x: [f32; 2], z: [f32; 2], y: f32) {
    let divisions = |r: [f32; 2]| ((r[1] - r[0]) / 2.0).ceil() as u32;
    mesh.grid(material, divisions(x), divisions(z), |u, v| {
        let p = Vec3::new(x[0] + (x[1] - x[0]) * u, y, z[1] + (z[0] - z[1]) * v);
        (p, Vec3::Y, Vec2::new(p.x, p.z) * 0.5)
    });
}

/// Outer walls: ashlar below, brick above, plain outside, with pilasters and two doors.
pub(super) fn walls() -> Mesh {
    let mut mesh = MeshBuilder::new("walls");
    let [x, z] = WALL;
    let band = GALLERY_FLOOR - 0.02;
    mesh.cuboid_inside(ASHLAR, Vec3::new(-x, ARCADE_FLOOR, -z), Vec3::new(x, band, z), 2.0);
    mesh.cuboid_inside(BRICK, Vec3::new(-x, band, -z), Vec3::new(x, OUTER_TOP, z), 1.0);
    let sides_only = [true, true, false, false, true, true];
    mesh.cuboid(PLASTER, Vec3::new(-x - 0.3, -0.3, -z - 0.3), Vec3::new(x + 0.3, OUTER_TOP, z + 0.3), 2.0, sides_only);
    for (a, b, count) in sides() {
        // A pilaster where the vaults meet the wall, behind each column.
        let along = (b - a).normalize();
        let outward = along.cross(Vec3::Y);
        let depth = if outward.x.abs() > 0.5 { WALL[0] - COURT[0] } else { WALL[1] - COURT[1] };
        for i in 0..=count {
            let foot = a.lerp(b, i as f32 / count as f32) + outward * depth;
            mesh.transform = frame(along, outward, foot + Vec3::Y * ARCADE_FLOOR);
            let top = LOWER_SPRING - ARCADE_FLOOR;
            let faces = [true, true, false, false, true, false];
            mesh.cuboid(TRIM, Vec3::new(-0.22, 0.0, -0.16), Vec3::new(0.22, top + 0.1, 0.05), 1.0, faces);
            mesh.cuboid(TRIM, Vec3::new(-0.28, top - 0.22, -0.22), Vec3::new(0.28, top - 0.04, 0.04), 1.0, CLOSED_BACK);
            mesh.cuboid(TRIM, Vec3::new(-0.27, -0.02, -0.21), Vec3::new(0.27, 0.3, 0.04), 1.0, CLOSED_BACK);
        }
    }
    mesh.transform = Mat4::IDENTITY;
    for side in [-1.0f32, 1.0] {
        doors(&mut mesh, side);
    }
    mesh.finish()
}

/// All faces but the one toward +z, which is in a wall.
const CLOSED_BACK: [bool; 6] = [true, true, true, true, true, false];

/// x along, y up, z outward.
fn frame(along: Vec3, outward: Vec3, origin: Vec3) -> Mat4 {
    Mat4::from_cols(along.extend(0.0), Vec3::Y.extend(0.0), outward.extend(0.0), origin.extend(1.0))
}

/// A wooden door with two leaves in the middle of an end wall, below and on the gallery.
fn doors(mesh: &mut MeshBuilder, side: f32) {
    for floor in [ARCADE_FLOOR, GALLERY_FLOOR] {
        let along = Vec3::new(0.0, 0.0, -side);
        mesh.transform = frame(along, Vec3::X * side, Vec3::new(side * WALL[0], floor, 0.0));
        for (x0, x1) in [(-0.62, -0.01), (0.01, 0.62)] {
            mesh.cuboid(WOOD, Vec3::new(x0, -0.01, -0.07), Vec3::new(x1, 2.35, 0.02), 1.3, CLOSED_BACK);
            let handle = if x0 < 0.0 { -0.09 } else { 0.09 };
            mesh.ring(IRON, Vec3::new(handle, 1.1, -0.09), Vec3::X * 0.045, Vec3::Y * 0.06, 0.01, [16, 6]);
        }
        for (x0, x1) in [(-0.82, -0.6), (0.6, 0.82)] {
            mesh.cuboid(TRIM, Vec3::new(x0, -0.03, -0.13), Vec3::new(x1, 2.42, 0.03), 1.0, CLOSED_BACK);
        }
        mesh.cuboid(TRIM, Vec3::new(-0.9, 2.34, -0.17), Vec3::new(0.9, 2.62, 0.04), 1.0, CLOSED_BACK);
    }
    mesh.transform = Mat4::IDENTITY;
}

/// Four slopes of tiles that fall toward the court, their undersides and the gallery's ceiling.
pub(super) fn roof() -> Mesh {
    let mut mesh = MeshBuilder::new("roof");
    let corner = |at: Vec3, sx: f32, sz: f32| Vec3::new(at.x * sx, at.y, at.z * sz);
    let ring = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];
    for i in 0..4 {
        let (a, b) = (ring[i], ring[(i + 1) % 4]);
        let (low_a, low_b) = (corner(EAVES, a.0, a.1), corner(EAVES, b.0, b.1));
        let (high_a, high_b) = (corner(RIDGE, a.0, a.1), corner(RIDGE, b.0, b.1));
        tiles(&mut mesh, [low_a, low_b, high_b, high_a]);
        // Boards below, and the edge between both.
        let down = Vec3::Y * 0.14;
        mesh.quad(WOOD, [low_b - down, low_a - down, high_a - down, high_b - down], 8, 2.0);
        mesh.quad(TRIM, [low_b - down, low_b + Vec3::Y * 0.02, low_a + Vec3::Y * 0.02, low_a - down], 8, 2.0);
        hip(&mut mesh, low_a, high_a);
    }
    // Beams of the gallery's ceiling, and the ceiling above them.
    let ceiling = WALL_TOP - 0.12;
    for (x, z) in [([-WALL[0], WALL[0]], [COURT[1], WALL[1]]), ([-WALL[0], WALL[0]], [-WALL[1], -COURT[1]])] {
        ceiling_rectangle(&mut mesh, x, z, ceiling);
        let count = 22;
        for i in 0..count {
            let at = x[0] + (x[1] - x[0]) * (i as f32 + 0.5) / count as f32;
            let (low, high) =
                (Vec3::new(at - 0.07, ceiling - 0.2, z[0] + 0.1), Vec3::new(at + 0.07, ceiling + 0.03, z[1] + 0.05));
            mesh.cuboid(WOOD, low, high, 1.5, [true, true, true, false, false, false]);
        }
    }
    for x in [[COURT[0], WALL[0]], [-WALL[0], -COURT[0]]] {
        ceiling_rectangle(&mut mesh, x, [-COURT[1], COURT[1]], ceiling);
    }
    mesh.finish()
}

fn ceiling_rectangle(mesh: &mut MeshBuilder, x: [f32; 2], z: [f32; 2], y: f32) {
    let p = |i: usize, j: usize| Vec3::new(x[i], y, z[j]);
    mesh.quad(WOOD, [p(0, 0), p(1, 0), p(1, 1), p(0, 1)], 4, 2.0);
}

/// One slope, corrugated: low edge, then high edge.
fn tiles(mesh: &mut MeshBuilder, [low_a, low_b, high_b, high_a]: [Vec3; 4]) {
    let width = high_a.distance(high_b);
    let waves = (width / 0.28).round();
    let along = (low_b - low_a).normalize();
    let middle = (high_a + high_b) * 0.5;
    mesh.surface(ROOF, waves as u32 * 6, 5, Vec2::new(1.0, 1.0), |u, v| {
        // Tiles run straight up the slope, so the wave depends on the place along the eaves, not on u.
        let p = low_a.lerp(low_b, u).lerp(high_a.lerp(high_b, u), v);
        let phase = (p - middle).dot(along) / width * waves * std::f32::consts::TAU;
        p + Vec3::Y * (0.05 * phase.cos() + 0.05)
    });
}

/// Half-round tiles over the line where two slopes meet.
fn hip(mesh: &mut MeshBuilder, low: Vec3, high: Vec3) {
    let along = (high - low).normalize();
    let side = along.cross(Vec3::Y).normalize();
    let up = side.cross(along);
    mesh.surface(ROOF, 10, 16, Vec2::new(0.5, 4.0), |u, v| {
        let (s, c) = ((u * 1.4 - 0.2) * std::f32::consts::PI).sin_cos();
        low.lerp(high, v) + side * (0.16 * c) + up * (0.13 * s + 0.04)
    });
}

/// String course, cornice with dentils and balcony edge around the court.
pub(super) fn trim() -> Mesh {
    let mut mesh = MeshBuilder::new("trim");
    for (a, b, count) in sides() {
        let along = (b - a).normalize();
        let outward = along.cross(Vec3::Y);
        // Profiles are mitred at the corners: z runs out of the court, the court's side is -z.
        let half = a.distance(b) * 0.5;
        mesh.transform = frame(along, outward, (a + b) * 0.5);
        let course = [(-0.22, 4.74), (-0.30, 4.78), (-0.31, 4.84), (-0.38, 4.90), (-0.38, 5.03), (0.26, 5.03)];
        profile(&mut mesh, half, &course);
        let cornice = [
            (-0.20, 8.86),
            (-0.28, 8.90),
            (-0.28, 8.98),
            (-0.34, 9.02),
            (-0.34, 9.22),
            (-0.50, 9.30),
            (-0.54, 9.42),
            (-0.54, 9.50),
            (0.2, 9.50),
        ];
        profile(&mut mesh, half, &cornice);
        let dentils = (count as f32 * if count == BAYS[0] { 10.0 } else { 8.0 }) as u32;
        let (from, to) = (-half + 0.5, half - 0.5);
        for i in 0..dentils {
            let x = from + (to - from) * i as f32 / (dentils - 1) as f32;
            let (low, high) = (Vec3::new(x - 0.055, 9.05, -0.42), Vec3::new(x + 0.055, 9.19, -0.32));
            mesh.cuboid(TRIM, low, high, 1.0, [true, true, true, true, true, false]);
        }
        // A frieze of roundels between the arches.
        for i in 1..count {
            let x = -half + 2.0 * half * i as f32 / count as f32;
            for (y, radius) in [(4.42, 0.15), (8.46, 0.13)] {
                let centre = Vec3::new(x, y, -0.25);
                mesh.ring(TRIM, centre, Vec3::X * radius, Vec3::Y * radius, 0.035, [16, 6]);
            }
        }
    }
    mesh.finish()
}

/// Sweeps (z, y) along a side of the court, longer or shorter by z at the corners.
fn profile(mesh: &mut MeshBuilder, half: f32, points: &[(f32, f32)]) {
    for pair in points.windows(2) {
        let ((z0, y0), (z1, y1)) = (pair[0], pair[1]);
        let at = |side: f32, z: f32, y: f32| Vec3::new(side * (half + z), y, z);
        mesh.quad(TRIM, [at(1.0, z0, y0), at(-1.0, z0, y0), at(-1.0, z1, y1), at(1.0, z1, y1)], 1, 1.0);
    }
}
