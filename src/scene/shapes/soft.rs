//! Cloth, chains and leaves.

use std::f32::consts::{PI, TAU};

use glam::{Quat, Vec2, Vec3};
use serde::Deserialize;

use super::basic::Ring;
use super::{MeshBuilder, Paint};

/// Long cloth around x = 0 that hangs in folds in the plane z = 0.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Banner {
    material: Paint,
    top: f32,
    bottom: f32,
    /// Half its width.
    half: f32,
    /// Phase of the folds.
    phase: f32,
}

impl Banner {
    pub fn build(&self, mesh: &mut MeshBuilder) {
        let &Banner {
            top,
            bottom,
            half,
            phase,
            ..
        } = self;
        let material = mesh.paint(&self.material);
        mesh.surface(material, [32, 28], Vec2::ONE, |u, v| {
            let (x, drop) = (u * 2.0 - 1.0, 1.0 - v);
            // Folds grow downwards, and the hem swings slightly.
            let depth = 0.015 + 0.085 * drop.sqrt();
            let fold = (x * 3.5 * PI + phase + 0.9 * (drop * 2.5 + phase).sin()).sin();
            let swing = 0.10 * drop * drop * (x * 1.7 + phase).cos();
            let narrow = 1.0 - 0.08 * (PI * drop).sin();
            // The lower edge forms a shallow point.
            let edge = 0.28 * (1.0 - x.abs()) * drop;
            Vec3::new(
                x * half * narrow,
                bottom + (top - bottom) * v - edge,
                depth * fold + swing,
            )
        });
    }
}

/// Curtain in the plane z = 0, drawn and tied to one side.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Curtain {
    material: Paint,
    top: f32,
    bottom: f32,
    /// Height of the tie, 0 to 1.
    tie: f32,
    /// Signed position of its end.
    side: f32,
}

impl Curtain {
    pub fn build(&self, mesh: &mut MeshBuilder) {
        let &Curtain {
            top,
            bottom,
            tie,
            side,
            ..
        } = self;
        let material = mesh.paint(&self.material);
        mesh.surface(material, [28, 18], Vec2::new(0.7, 1.0), |u, v| {
            let y = bottom + (top - bottom) * v;
            // Width at this height: full at the rod, narrow at the tie, slightly wider below.
            let above = ((v - tie) / (1.0 - tie)).max(0.0);
            let below = ((tie - v) / tie).max(0.0);
            let width = 0.24 + 0.80 * above.powf(1.7) + 0.16 * below.sqrt();
            let depth = 0.035 + 0.03 * (1.0 - above);
            Vec3::new(
                side.signum() * (side.abs() - width * u),
                y,
                depth * (u * 9.0 * PI).sin(),
            )
        });
    }
}

/// Links, each rotated by 90 degrees.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Chain {
    material: Paint,
    /// Start; for a sagging chain, the middle between its ends.
    from: Vec3,
    /// Vector to its end.
    along: Vec3,
    #[serde(default)]
    sag: f32,
    links: u32,
}

impl Chain {
    pub fn build(&self, mesh: &mut MeshBuilder, at: Vec3) {
        let curve = |i: u32| {
            let t = i as f32 / self.links as f32;
            let s = if self.sag == 0.0 { t } else { t * 2.0 - 1.0 };
            at + (self.from + self.along * s - Vec3::Y * (self.sag * (1.0 - s * s)))
        };
        for i in 0..self.links {
            let (a, b) = (curve(i), curve(i + 1));
            let along = b - a;
            let flat = along.any_orthonormal_vector();
            let across = if i % 2 == 0 {
                flat
            } else {
                along.cross(flat).normalize()
            };
            let (centre, major, minor) = ((a + b) * 0.5, along * 0.62, across * 0.032);
            let material = self.material.clone();
            Ring {
                material,
                centre,
                major,
                minor,
                tube: 0.011,
                segments: [8, 4],
            }
            .build(mesh, Vec3::ZERO);
            if mesh.problem.is_some() {
                return;
            }
        }
    }
}

/// Leaves in an ellipsoid, denser near its surface.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Crown {
    material: Paint,
    count: u32,
    centre: Vec3,
    radii: Vec3,
    /// Minimum and maximum size of a leaf.
    size: (f32, f32),
}

impl Crown {
    pub fn build(&self, mesh: &mut MeshBuilder, at: Vec3) {
        let leaf = mesh.paint(&self.material);
        for _ in 0..self.count {
            let random = &mut mesh.random;
            let (turn, height) = (random.unit() * TAU, random.range(-1.0, 1.0));
            let flat = (1.0 - height * height).sqrt();
            let out = Vec3::new(flat * turn.cos(), height, flat * turn.sin());
            let place = self.centre + at + out * self.radii * random.unit().powf(0.4);
            let size = random.range(self.size.0, self.size.1);
            let along = (out
                + Vec3::new(
                    random.range(-1.0, 1.0),
                    random.range(-1.2, 0.4),
                    random.range(-1.0, 1.0),
                ))
            .normalize_or(Vec3::Y);
            let side =
                Quat::from_axis_angle(along, random.unit() * TAU) * along.any_orthonormal_vector();
            let (across, up) = (side * (0.5 * size), along * size);
            mesh.quad(
                leaf,
                [
                    place - across,
                    place + across,
                    place + across + up,
                    place - across + up,
                ],
                1,
                size,
            );
            if mesh.problem.is_some() {
                return;
            }
        }
    }
}

/// Sprigs of leaves, each a bent card with a masked texture.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Sprigs {
    material: Paint,
    grows: Grows,
}

#[derive(Clone, Copy, Debug, Deserialize)]
enum Grows {
    /// A bush of this many sprigs, rooted at the origin.
    Bush(u32),
    /// This many sprigs around a shaft of radius 0.25 m, up to a height.
    Climbing(u32, f32),
    /// Seven strands that hang toward -z or +z.
    Hanging(f32),
}

impl Sprigs {
    pub fn build(&self, mesh: &mut MeshBuilder, at: Vec3) {
        match self.grows {
            Grows::Bush(count) => self.bush(mesh, at, count),
            Grows::Climbing(count, height) => self.climb(mesh, at, count, height),
            Grows::Hanging(toward) => self.hang(mesh, at, toward.signum()),
        }
    }

    fn bush(&self, mesh: &mut MeshBuilder, foot: Vec3, count: u32) {
        let tall = mesh.random.range(0.8, 1.15);
        for _ in 0..count {
            let random = &mut mesh.random;
            let (turn, rise) = (random.unit() * TAU, random.unit());
            let out = Vec3::new(turn.cos(), 0.0, turn.sin());
            let width = 0.42 * (PI * (0.12 + 0.8 * rise)).sin();
            let root =
                foot + Vec3::Y * (0.52 + tall * rise) + out * (width * random.range(0.2, 0.9));
            let lift = random.range(0.2, 1.4) + rise * 0.6;
            let size = random.range(0.22, 0.36);
            if !self.card(mesh, root, (out + Vec3::Y * lift).normalize(), size) {
                return;
            }
        }
    }

    fn climb(&self, mesh: &mut MeshBuilder, foot: Vec3, count: u32, height: f32) {
        for i in 0..count {
            let random = &mut mesh.random;
            let t = i as f32 / count as f32;
            let turn = t * TAU * 2.3 + random.range(-0.5, 0.5);
            let out = Vec3::new(turn.cos(), 0.0, turn.sin());
            let root = foot + Vec3::Y * (0.4 + (height - 0.4) * t) + out * random.range(0.27, 0.31);
            let along = Vec3::new(-turn.sin(), random.range(-0.6, 0.9), turn.cos());
            let size = random.range(0.16, 0.26);
            if !self.card(mesh, root, (along + out * 0.45).normalize(), size) {
                return;
            }
        }
    }

    fn hang(&self, mesh: &mut MeshBuilder, top: Vec3, toward: f32) {
        for _ in 0..7 {
            let x = mesh.random.range(-0.75, 0.75);
            let length = mesh.random.range(0.7, 1.9) * (1.0 - 0.4 * x.abs());
            let count = (length * 22.0) as u32;
            let sway = mesh.random.unit() * TAU;
            for i in 0..count {
                let random = &mut mesh.random;
                let t = i as f32 / count as f32;
                let swing = 0.09 * (t * 5.0 + sway).sin();
                let depth = 0.07 + 0.22 * (t * 4.0).min(1.0) + random.range(-0.03, 0.05);
                let root = top + Vec3::new(x + swing, -length * t, toward * depth);
                let along = Vec3::new(
                    random.range(-0.8, 0.8),
                    -0.8,
                    toward * random.range(0.1, 0.8),
                );
                let size = random.range(0.15, 0.25);
                if !self.card(mesh, root, along.normalize(), size) {
                    return;
                }
            }
        }
    }

    /// A card from its root along a direction, bent slightly and rotated randomly. Returns whether
    /// there is room for more.
    fn card(&self, mesh: &mut MeshBuilder, root: Vec3, along: Vec3, size: f32) -> bool {
        let material = mesh.paint(&self.material);
        let turn = Quat::from_axis_angle(along, mesh.random.unit() * TAU);
        let side = turn * along.any_orthonormal_vector();
        let normal = side.cross(along);
        mesh.grid(material, [1, 2], |u, v| {
            let droop = 0.22 * v * v;
            let p = root + (side * (u - 0.5) + along * v - normal * droop) * size;
            let slope = (normal + along * (0.44 * v)).normalize();
            (p, slope, Vec2::new(u, 1.0 - v))
        });
        mesh.problem.is_none()
    }
}
