//! Pots with bushes in the court, and ivy on columns and over the balustrade.

use std::f32::consts::TAU;

use glam::{Quat, Vec2, Vec3};

use super::materials::{LEAVES, POT, SOIL, TRIM};
use super::{ARCADE_FLOOR, COURT, GALLERY_FLOOR, LOWER_SPRING, column_places};
use crate::scene::Mesh;
use crate::scene::builtin::noise::Random;
use crate::scene::builtin::shapes::MeshBuilder;

/// Pots stand before some columns of the long sides.
fn pot_places() -> Vec<Vec3> {
    let mut places = Vec::new();
    for side in [-1.0f32, 1.0] {
        for x in [-8.25, -2.75, 5.5] {
            places.push(Vec3::new(x, 0.0, side * (COURT[1] - 0.98)));
        }
    }
    places
}

/// Terracotta pots with soil.
pub(super) fn pots() -> Mesh {
    let mut mesh = MeshBuilder::new("pots");
    let p = Vec2::new;
    let outline = [
        p(0.21, 0.0),
        p(0.22, 0.03),
        p(0.25, 0.18),
        p(0.31, 0.36),
        p(0.33, 0.44),
        p(0.37, 0.46),
        p(0.38, 0.54),
        p(0.36, 0.56),
        p(0.31, 0.555),
        p(0.30, 0.47),
    ];
    for place in pot_places() {
        mesh.transform = glam::Mat4::from_translation(place);
        mesh.lathe(POT, 24, 18, 1.0, &outline);
        mesh.lathe(SOIL, 24, 2, 1.0, &[p(0.315, 0.50), p(0.2, 0.52), p(0.0, 0.54)]);
        mesh.ring(TRIM, Vec3::Y * 0.30, Vec3::X * 0.295, Vec3::NEG_Z * 0.295, 0.02, [24, 6]);
    }
    mesh.finish()
}

/// Leaf cards: bushes in the pots, ivy winding up columns and hanging from the gallery.
pub(super) fn foliage() -> Mesh {
    let mut mesh = MeshBuilder::new("foliage");
    let mut random = Random(2026);
    for place in pot_places() {
        let tall = random.range(0.8, 1.15);
        for _ in 0..110 {
            let (turn, rise) = (random.unit() * TAU, random.unit());
            let out = Vec3::new(turn.cos(), 0.0, turn.sin());
            let width = 0.42 * (std::f32::consts::PI * (0.12 + 0.8 * rise)).sin();
            let root = place + Vec3::Y * (0.52 + tall * rise) + out * (width * random.range(0.2, 0.9));
            let lift = random.range(0.2, 1.4) + rise * 0.6;
            let size = random.range(0.22, 0.36);
            card(&mut mesh, &mut random, root, (out + Vec3::Y * lift).normalize(), size);
        }
    }
    for (i, place) in column_places().into_iter().enumerate() {
        if i % 5 == 1 {
            climb(&mut mesh, &mut random, place + Vec3::Y * ARCADE_FLOOR);
        }
    }
    for side in [-1.0f32, 1.0] {
        for x in [-9.6, -4.1, 1.4, 6.9] {
            hang(&mut mesh, &mut random, Vec3::new(x * -side, GALLERY_FLOOR + 0.86, side * (COURT[1] - 0.12)), side);
        }
    }
    mesh.finish()
}

/// Ivy around the shaft of a column.
fn climb(mesh: &mut MeshBuilder, random: &mut Random, foot: Vec3) {
    let height = LOWER_SPRING - ARCADE_FLOOR - 0.2;
    for i in 0..150 {
        let t = i as f32 / 150.0;
        let turn = t * TAU * 2.3 + random.range(-0.5, 0.5);
        let out = Vec3::new(turn.cos(), 0.0, turn.sin());
        let root = foot + Vec3::Y * (0.4 + (height - 0.4) * t) + out * random.range(0.27, 0.31);
        let along = Vec3::new(-turn.sin(), random.range(-0.6, 0.9), turn.cos());
        let size = random.range(0.16, 0.26);
        card(mesh, random, root, (along + out * 0.45).normalize(), size);
    }
}

/// Ivy falling over the balustrade into the court, which is toward -side.
fn hang(mesh: &mut MeshBuilder, random: &mut Random, top: Vec3, side: f32) {
    for _ in 0..7 {
        let x = random.range(-0.75, 0.75);
        let length = random.range(0.7, 1.9) * (1.0 - 0.4 * x.abs());
        let count = (length * 22.0) as u32;
        let sway = random.unit() * TAU;
        for i in 0..count {
            let t = i as f32 / count as f32;
            let swing = 0.09 * (t * 5.0 + sway).sin();
            let depth = 0.07 + 0.22 * (t * 4.0).min(1.0) + random.range(-0.03, 0.05);
            let root = top + Vec3::new(x + swing, -length * t, -side * depth);
            let along = Vec3::new(random.range(-0.8, 0.8), -0.8, -side * random.range(0.1, 0.8));
            let size = random.range(0.15, 0.25);
            card(mesh, random, root, along.normalize(), size);
        }
    }
}

/// A sprig from its root along a direction, bent a little and turned by chance.
fn card(mesh: &mut MeshBuilder, random: &mut Random, root: Vec3, along: Vec3, size: f32) {
    let turn = Quat::from_axis_angle(along, random.unit() * TAU);
    let side = turn * along.any_orthonormal_vector();
    let normal = side.cross(along);
    mesh.grid(LEAVES, 1, 2, |u, v| {
        let droop = 0.22 * v * v;
        let p = root + (side * (u - 0.5) + along * v - normal * droop) * size;
        let slope = (normal + along * (0.44 * v)).normalize();
        (p, slope, Vec2::new(u, 1.0 - v))
    });
}
