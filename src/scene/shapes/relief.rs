//! Finely tessellated surfaces.

use std::f32::consts::TAU;

use glam::{Vec2, Vec3};
use serde::Deserialize;

use super::basic::flat_triangle;
use super::noise::fractal;
use super::{MeshBuilder, Paint};

/// Vase around y with its base at the origin, with twisted flutes and grain.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Vase {
    material: Paint,
    /// Radii from foot to lip, evenly spaced and interpolated smoothly.
    radii: Vec<f32>,
    height: f32,
    /// Depth of the flutes, their number, and their twist (radians of a flute's wave).
    flutes: (f32, f32, f32),
    /// Amplitude of the grain.
    grain: f32,
    /// The index of the repetition is added.
    #[serde(default)]
    seed: u32,
    sides: u32,
    rows: u32,
}

impl Vase {
    pub fn build(&self, mesh: &mut MeshBuilder) {
        let (material, seed) = (
            mesh.paint(&self.material),
            self.seed.wrapping_add(mesh.number),
        );
        let (depth, count, winding) = self.flutes;
        let spans = self.radii.len().saturating_sub(1);
        mesh.surface(material, [self.sides, self.rows], Vec2::ONE, |u, v| {
            let x = (v * spans as f32).clamp(0.0, spans as f32);
            let i = (x as usize).min(spans.saturating_sub(1));
            let t = x - i as f32;
            let [below, above] = [i, i + 1].map(|i| self.radii.get(i).copied().unwrap_or_default());
            let radius = below + (above - below) * t * t * (3.0 - 2.0 * t);
            let angle = -u * TAU;
            let flutes = depth * (count * angle + winding * v).cos();
            let grain = self.grain * fractal(u, 0.5 * v, 8, seed);
            let r = radius + flutes + grain;
            Vec3::new(r * angle.cos(), self.height * v, r * angle.sin())
        });
    }
}

/// Small triangles distributed over a sphere.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Specks {
    material: Paint,
    centre: Vec3,
    radius: f32,
    /// Length of the two equal sides.
    size: f32,
    count: u32,
}

impl Specks {
    pub fn build(&self, mesh: &mut MeshBuilder, at: Vec3) {
        let material = mesh.paint(&self.material);
        for _ in 0..self.count {
            let random = &mut mesh.random;
            let y = random.range(-1.0, 1.0);
            let (s, c) = (random.unit() * TAU).sin_cos();
            let out = Vec3::new(c * (1.0 - y * y).sqrt(), y, s * (1.0 - y * y).sqrt());
            let side = out.any_orthonormal_vector();
            let up = out.cross(side);
            let at = self.centre + at + out * self.radius;
            flat_triangle(
                mesh,
                material,
                [at, at + side * self.size, at + up * self.size],
                [Vec2::ZERO; 3],
            );
            if mesh.problem.is_some() {
                return;
            }
        }
    }
}
