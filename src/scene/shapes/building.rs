//! Parts of buildings: floors, arches, vaults, mouldings, capitals and roofs.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};
use serde::Deserialize;

use super::basic::span;
use super::{MeshBuilder, Paint};

/// Horizontal rectangle facing up, subdivided every `tile` metres, with world-space texture
/// coordinates.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Level {
    material: Paint,
    x: [f32; 2],
    z: [f32; 2],
    y: f32,
    tile: f32,
}

impl Level {
    pub fn build(&self, mesh: &mut MeshBuilder) {
        let &Level { x, z, y, tile, .. } = self;
        let material = mesh.paint(&self.material);
        let divisions = |r: [f32; 2]| ((r[1] - r[0]) / tile).ceil() as u32;
        mesh.grid(material, [divisions(x), divisions(z)], |u, v| {
            let p = Vec3::new(x[0] + (x[1] - x[0]) * u, y, z[1] + (z[0] - z[1]) * v);
            (p, Vec3::Y, Vec2::new(p.x, p.z) / tile)
        });
    }
}

/// Wall along x over an elliptical arch that springs at y = 0. The front is -z, where a moulding
/// frames the opening.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Arch {
    material: Paint,
    /// Material of the soffit and the moulding.
    trim: Paint,
    /// Half the wall's length, and its height.
    half: f32,
    top: f32,
    /// Half the opening's width, and its height.
    opening: f32,
    rise: f32,
    /// Half the wall's thickness.
    thick: f32,
    /// Profile of the moulding: distances from the opening's edge and in front of the wall.
    moulding: Vec<Vec2>,
}

impl Arch {
    pub fn build(&self, mesh: &mut MeshBuilder) {
        const SEGMENTS: u32 = 24;
        let &Arch {
            half,
            top,
            opening,
            rise,
            thick,
            ..
        } = self;
        let (trim, material) = (mesh.paint(&self.trim), mesh.paint(&self.material));
        let curve = |t: f32| {
            Vec2::new(
                opening * (PI * (1.0 - t)).cos(),
                rise * (PI * t).sin().max(0.0),
            )
        };
        // Soffit, seen from below.
        mesh.surface(trim, [SEGMENTS, 1], Vec2::new(3.0, 0.5), |u, v| {
            curve(u).extend((v * 2.0 - 1.0) * thick)
        });
        for side in [-1.0f32, 1.0] {
            // From the arch to the top, and the strips above the columns.
            let point = |x: f32, y: f32| {
                (
                    Vec3::new(x, y, side * thick),
                    Vec3::Z * side,
                    Vec2::new(x, top - y) * 0.5,
                )
            };
            let flip = |u: f32| if side > 0.0 { u } else { 1.0 - u };
            mesh.grid(material, [SEGMENTS, 1], |u, v| {
                let p = curve(flip(u));
                point(p.x, p.y + (top - p.y) * v)
            });
            for (from, to) in [(-half, -opening), (opening, half)] {
                mesh.grid(material, [1, 1], |u, v| {
                    point(from + (to - from) * flip(u), top * v)
                });
            }
        }
        let spans = self.moulding.len().saturating_sub(1) as u32;
        if spans > 0 {
            mesh.surface(trim, [SEGMENTS, spans], Vec2::new(4.0, 0.3), |u, v| {
                let (from, to, t) = span(&self.moulding, v);
                let out = from + (to - from) * t;
                let angle = PI * u;
                Vec2::new(
                    (opening + out.x) * angle.cos(),
                    (rise + out.x) * angle.sin(),
                )
                .extend(-thick - out.y)
            });
        }
    }
}

/// Groin vault that springs at y = 0. The ceiling is the higher of two crossing barrels, so each
/// half is a web between two diagonals.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Vault {
    material: Paint,
    /// Half its extent along x and z.
    half: Vec2,
    rise: f32,
}

impl Vault {
    pub fn build(&self, mesh: &mut MeshBuilder) {
        let &Vault { half, rise, .. } = self;
        let material = mesh.paint(&self.material);
        let height = |x: f32| rise * (1.0 - x * x).max(0.0).sqrt();
        for side in [-1.0f32, 1.0] {
            // Webs at the two edges across z, then those across x. Their fronts face down.
            mesh.surface(material, [10, 6], Vec2::ONE, |u, v| {
                let (s, t) = ((u * 2.0 - 1.0) * side, v);
                Vec3::new(s * t * half.x, height(s * t), side * t * half.y)
            });
            mesh.surface(material, [10, 6], Vec2::ONE, |u, v| {
                let (s, t) = ((1.0 - u * 2.0) * side, v);
                Vec3::new(side * t * half.x, height(s * t), s * t * half.y)
            });
        }
    }
}

/// Profile of (z, y) swept along x; the mitred ends extend by z.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Moulding {
    material: Paint,
    /// Half its length at z = 0.
    half: f32,
    section: Vec<Vec2>,
}

impl Moulding {
    pub fn build(&self, mesh: &mut MeshBuilder) {
        let material = mesh.paint(&self.material);
        for span in self.section.windows(2) {
            let at = |side: f32, p: Vec2| Vec3::new(side * (self.half + p.x), p.y, p.x);
            mesh.quad(
                material,
                [
                    at(1.0, span[0]),
                    at(-1.0, span[0]),
                    at(-1.0, span[1]),
                    at(1.0, span[1]),
                ],
                1,
                1.0,
            );
        }
    }
}

/// Bell of a capital around y with two rows of eight leaves in relief.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Capital {
    material: Paint,
    /// Radius of the column, and height at which the bell begins.
    radius: f32,
    foot: f32,
}

impl Capital {
    pub fn build(&self, mesh: &mut MeshBuilder) {
        let &Capital {
            radius: r, foot, ..
        } = self;
        let material = mesh.paint(&self.material);
        mesh.surface(material, [48, 10], Vec2::new(2.0, 0.5), |u, v| {
            let angle = -u * 2.0 * PI;
            let bell = 0.86 + 0.55 * v * v;
            let row = (v * 2.0).floor();
            let curl = (PI * (v * 2.0 - row).clamp(0.0, 1.0)).sin() * 0.20;
            let leaf = (4.0 * angle + row * PI * 0.5).sin().abs();
            let radius = r * (bell + curl * leaf);
            Vec3::new(
                radius * angle.cos(),
                foot + 1.68 * r * v,
                radius * angle.sin(),
            )
        });
    }
}

/// Roof slope with waves.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Slope {
    material: Paint,
    /// Left and right ends of the eaves, then of the ridge.
    eaves: [Vec3; 2],
    ridge: [Vec3; 2],
    /// Approximate wavelength.
    wave: f32,
}

impl Slope {
    pub fn build(&self, mesh: &mut MeshBuilder) {
        let ([low_a, low_b], [high_a, high_b]) = (self.eaves, self.ridge);
        let material = mesh.paint(&self.material);
        let width = high_a.distance(high_b);
        let waves = (width / self.wave).round();
        let along = (low_b - low_a).normalize();
        let middle = (high_a + high_b) * 0.5;
        mesh.surface(
            material,
            [(waves as u32).saturating_mul(6), 5],
            Vec2::ONE,
            |u, v| {
                // Tiles run straight up the slope, so the wave depends on the position along the
                // eaves, not on u.
                let p = low_a.lerp(low_b, u).lerp(high_a.lerp(high_b, u), v);
                let phase = (p - middle).dot(along) / width * waves * TAU;
                p + Vec3::Y * (0.05 * phase.cos() + 0.05)
            },
        );
    }
}

/// Half-round tiles along the line where two slopes meet.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Hip {
    material: Paint,
    low: Vec3,
    high: Vec3,
}

impl Hip {
    pub fn build(&self, mesh: &mut MeshBuilder) {
        let (low, high) = (self.low, self.high);
        let material = mesh.paint(&self.material);
        let along = (high - low).normalize();
        let side = along.cross(Vec3::Y).normalize();
        let up = side.cross(along);
        mesh.surface(material, [10, 16], Vec2::new(0.5, 4.0), |u, v| {
            let (s, c) = ((u * 1.4 - 0.2) * PI).sin_cos();
            low.lerp(high, v) + side * (0.16 * c) + up * (0.13 * s + 0.04)
        });
    }
}

/// Upright bars around y that bulge outwards.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Bars {
    material: Paint,
    count: u32,
    /// Radius of the circle of their ends, of the bulge, and of a bar.
    radius: f32,
    bulge: f32,
    thick: f32,
    /// Height of the lower ends, and length.
    foot: f32,
    height: f32,
}

impl Bars {
    pub fn build(&self, mesh: &mut MeshBuilder) {
        let material = mesh.paint(&self.material);
        for i in 0..self.count {
            let (s, c) = (i as f32 / self.count as f32 * TAU).sin_cos();
            let out = Vec3::new(c, 0.0, s);
            mesh.surface(material, [6, 5], Vec2::ONE, |u, v| {
                let (ts, tc) = (-u * TAU).sin_cos();
                let bulge = self.radius + self.bulge * (v * PI).sin();
                out * (bulge + self.thick * tc)
                    + Vec3::new(-s, 0.0, c) * (self.thick * ts)
                    + Vec3::Y * (self.foot + self.height * v)
            });
            if mesh.problem.is_some() {
                return;
            }
        }
    }
}
