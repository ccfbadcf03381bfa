//! Thin chains across the court and the lanterns on them.

use std::f32::consts::TAU;

use glam::{Mat4, Vec2, Vec3};

use super::materials::{GLOW, GOLD, IRON};
use super::{BAYS, COURT, LOWER_SPRING};
use crate::scene::Mesh;
use crate::scene::builtin::shapes::MeshBuilder;

/// How far the chains across the court sag in the middle.
const SAG: f32 = 1.15;
/// Height at which they are fixed.
const HOOK: f32 = 6.85;

/// Where the chains cross the court.
fn crossings() -> [f32; 3] {
    [-5.5, 0.0, 5.5]
}

/// Places of the small lanterns in arches of the ground floor.
fn arch_lanterns() -> Vec<Vec3> {
    let mut places = Vec::new();
    for side in [-1.0f32, 1.0] {
        for bay in [0, 3, 5, 7] {
            let x = COURT[0] * (2.0 * (bay as f32 + 0.5) / BAYS[0] as f32 - 1.0);
            places.push(Vec3::new(x, LOWER_SPRING - 0.15, side * 5.0));
        }
    }
    places
}

/// Chains: three across the court with a drop in the middle, and one over each small lantern.
pub(super) fn chains() -> Mesh {
    let mut mesh = MeshBuilder::new("chains");
    for x in crossings() {
        let half = COURT[1] - 0.22;
        let curve = |t: f32| {
            let s = t * 2.0 - 1.0;
            Vec3::new(x, HOOK - SAG * (1.0 - s * s), half * s)
        };
        chain(&mut mesh, 58, curve);
        let middle = HOOK - SAG;
        chain(&mut mesh, 6, |t| Vec3::new(x, middle - 0.06 - 0.5 * t, 0.0));
    }
    for place in arch_lanterns() {
        chain(&mut mesh, 12, |t| place + Vec3::Y * (0.33 + 1.05 * t));
    }
    mesh.finish()
}

/// Links along a curve, each a quarter turn from the last.
fn chain(mesh: &mut MeshBuilder, links: u32, curve: impl Fn(f32) -> Vec3) {
    for i in 0..links {
        let (a, b) = (curve(i as f32 / links as f32), curve((i + 1) as f32 / links as f32));
        let along = b - a;
        let flat = along.any_orthonormal_vector();
        let across = if i % 2 == 0 { flat } else { along.cross(flat).normalize() };
        mesh.ring(IRON, (a + b) * 0.5, along * 0.62, across * 0.032, 0.011, [8, 4]);
    }
}

/// Lanterns: large ones over the court, small ones in the arcades.
pub(super) fn lanterns() -> Mesh {
    let mut mesh = MeshBuilder::new("lanterns");
    for x in crossings() {
        lantern(&mut mesh, Vec3::new(x, HOOK - SAG - 1.14, 0.0), 1.0);
    }
    for place in arch_lanterns() {
        lantern(&mut mesh, place, 0.62);
    }
    mesh.finish()
}

/// Six-sided lantern hanging from its top, about a metre high at scale 1; the origin is its middle.
fn lantern(mesh: &mut MeshBuilder, centre: Vec3, scale: f32) {
    mesh.transform = Mat4::from_translation(centre) * Mat4::from_scale(Vec3::splat(scale));
    let p = Vec2::new;
    mesh.lathe(
        GLOW,
        12,
        6,
        1.0,
        &[p(0.0, -0.26), p(0.10, -0.24), p(0.15, -0.1), p(0.16, 0.06), p(0.12, 0.2), p(0.06, 0.27), p(0.0, 0.28)],
    );
    let roof = [p(0.0, 0.27), p(0.24, 0.28), p(0.25, 0.31), p(0.15, 0.40), p(0.06, 0.46), p(0.05, 0.53), p(0.0, 0.56)];
    mesh.lathe(IRON, 12, 12, 1.0, &roof);
    mesh.lathe(
        IRON,
        12,
        10,
        1.0,
        &[p(0.0, -0.40), p(0.05, -0.38), p(0.07, -0.34), p(0.21, -0.31), p(0.21, -0.27), p(0.0, -0.265)],
    );
    for i in 0..6 {
        let (s, c) = (i as f32 / 6.0 * TAU).sin_cos();
        let out = Vec3::new(c, 0.0, s);
        mesh.surface(IRON, 6, 5, Vec2::ONE, |u, v| {
            let (ts, tc) = (-u * TAU).sin_cos();
            let bulge = 0.205 + 0.03 * (v * std::f32::consts::PI).sin();
            out * (bulge + 0.012 * tc) + Vec3::new(-s, 0.0, c) * (0.012 * ts) + Vec3::Y * (-0.30 + 0.6 * v)
        });
    }
    mesh.ring(GOLD, Vec3::Y * 0.60, Vec3::X * 0.05, Vec3::Y * 0.06, 0.014, [14, 6]);
    mesh.transform = Mat4::IDENTITY;
}
