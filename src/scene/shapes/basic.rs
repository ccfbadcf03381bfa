//! Boxes, quads, spheres and surfaces of revolution.

use std::f32::consts::TAU;

use glam::{Vec2, Vec3};
use serde::Deserialize;

use super::{FACES, MeshBuilder, Paint, one};

/// Box between two corners.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Cuboid {
    pub material: Paint,
    pub low: Vec3,
    pub high: Vec3,
    /// Omitted faces, by direction.
    #[serde(default)]
    open: Vec<String>,
    /// Metres per unit of the texture coordinates, here and below.
    #[serde(default = "one")]
    tile: f32,
    /// Only the upright faces, seen from inside, each subdivided 8 times.
    #[serde(default)]
    inside: bool,
}

impl Cuboid {
    pub fn build(&self, mesh: &mut MeshBuilder, at: Vec3) {
        let material = mesh.paint(&self.material);
        let (low, high) = (self.low + at, self.high + at);
        if let Some(face) = self
            .open
            .iter()
            .find(|face| !FACES.contains(&face.as_str()))
        {
            mesh.fail(
                face,
                format!(
                    "a box has no face '{face}': it is one of {}",
                    FACES.join(", ")
                ),
            );
        }
        if !self.inside {
            return mesh.cuboid(
                material,
                low,
                high,
                self.tile,
                FACES.map(|face| !self.open.iter().any(|o| o == face)),
            );
        }
        let ring = [
            (low.x, low.z),
            (high.x, low.z),
            (high.x, high.z),
            (low.x, high.z),
        ];
        for i in 0..4 {
            let ((ax, az), (bx, bz)) = (ring[i], ring[(i + 1) % 4]);
            let corners = [
                (ax, low.y, az),
                (bx, low.y, bz),
                (bx, high.y, bz),
                (ax, high.y, az),
            ];
            mesh.quad(material, corners.map(Vec3::from), 8, self.tile);
        }
    }
}

/// Flat quad, corners counter-clockwise from its front.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Quad {
    material: Paint,
    corners: [Vec3; 4],
    /// Subdivisions per edge.
    #[serde(default = "undivided")]
    divisions: u32,
    #[serde(default = "one")]
    tile: f32,
}

fn undivided() -> u32 {
    1
}

impl Quad {
    pub fn build(&self, mesh: &mut MeshBuilder, at: Vec3) {
        let material = mesh.paint(&self.material);
        mesh.quad(
            material,
            self.corners.map(|corner| corner + at),
            self.divisions,
            self.tile,
        );
    }
}

/// Flat triangle, corners counter-clockwise from its front.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Triangle {
    material: Paint,
    corners: [Vec3; 3],
    #[serde(default)]
    uvs: [Vec2; 3],
}

impl Triangle {
    pub fn build(&self, mesh: &mut MeshBuilder, at: Vec3) {
        let material = mesh.paint(&self.material);
        flat_triangle(
            mesh,
            material,
            self.corners.map(|corner| corner + at),
            self.uvs,
        );
    }
}

pub(super) fn flat_triangle(
    mesh: &mut MeshBuilder,
    material: u32,
    corners: [Vec3; 3],
    uvs: [Vec2; 3],
) {
    let normal = (corners[1] - corners[0])
        .cross(corners[2] - corners[0])
        .normalize_or(Vec3::Y);
    if mesh.has_room(3) {
        let corners = [0, 1, 2].map(|i| mesh.vertex(corners[i], normal, uvs[i]));
        mesh.triangle(material, corners);
    }
}

/// Sphere as a subdivided icosahedron: 20 * 4^level triangles of nearly equal size.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Ball {
    material: Paint,
    #[serde(default)]
    centre: Vec3,
    radius: f32,
    level: u32,
}

impl Ball {
    pub fn build(&self, mesh: &mut MeshBuilder, at: Vec3) {
        let material = mesh.paint(&self.material);
        if mesh.has_room(60u64.saturating_mul(4u64.saturating_pow(self.level))) {
            for face in icosahedron() {
                self.face(mesh, material, self.centre + at, face, self.level);
            }
        }
    }

    fn face(
        &self,
        mesh: &mut MeshBuilder,
        material: u32,
        centre: Vec3,
        face: [Vec3; 3],
        level: u32,
    ) {
        let [a, b, c] = face;
        if level == 0 {
            let uv = |n: Vec3| {
                Vec2::new(
                    n.z.atan2(n.x) / TAU + 0.5,
                    n.y.clamp(-1.0, 1.0).acos() / (0.5 * TAU),
                )
            };
            let corners = face.map(|n| mesh.vertex(centre + n * self.radius, n, uv(n)));
            return mesh.triangle(material, corners);
        }
        let (ab, bc, ca) = (
            (a + b).normalize(),
            (b + c).normalize(),
            (c + a).normalize(),
        );
        for face in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
            self.face(mesh, material, centre, face, level - 1);
        }
    }
}

fn icosahedron() -> [[Vec3; 3]; 20] {
    let g = (1.0 + 5.0f32.sqrt()) / 2.0;
    let rectangle = |turn: fn(f32, f32) -> Vec3| {
        [(-1.0, g), (1.0, g), (-1.0, -g), (1.0, -g)].map(|(a, b)| turn(a, b))
    };
    let corners = [
        rectangle(|a, b| Vec3::new(a, b, 0.0)),
        rectangle(|a, b| Vec3::new(0.0, a, b)),
        rectangle(|a, b| Vec3::new(b, 0.0, a)),
    ];
    let p: Vec<Vec3> = corners.into_iter().flatten().map(Vec3::normalize).collect();
    const FACES: [[usize; 3]; 20] = [
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    FACES.map(|face| face.map(|i| p[i]))
}

/// Surface of revolution around y from (radius, height) points, bottom to top. u is the angle in
/// units of 360 degrees; v is in metres over `tile`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Lathe {
    material: Paint,
    profile: Vec<Vec2>,
    sides: u32,
    /// Subdivisions along the profile.
    rows: u32,
    #[serde(default = "one")]
    tile: f32,
}

impl Lathe {
    pub fn build(&self, mesh: &mut MeshBuilder) {
        let (material, profile) = (mesh.paint(&self.material), &self.profile);
        let length: f32 = profile.windows(2).map(|w| w[0].distance(w[1])).sum();
        let widest = profile.iter().map(|p| p.x).fold(0.0, f32::max);
        let turns = (TAU * widest / self.tile).round().max(1.0);
        mesh.surface(
            material,
            [self.sides, self.rows],
            Vec2::new(turns, length / self.tile),
            |u, v| {
                let (below, above, t) = span(profile, v);
                let p = below.lerp(above, t);
                let angle = -u * TAU;
                Vec3::new(p.x * angle.cos(), p.y, p.x * angle.sin())
            },
        );
    }
}

/// The segment at `v` in 0..1 of all segments, and the position within it.
pub(super) fn span(points: &[Vec2], v: f32) -> (Vec2, Vec2, f32) {
    let spans = points.len().saturating_sub(1) as f32;
    let x = (v * spans).clamp(0.0, spans);
    let i = (x as usize).min(points.len().saturating_sub(2));
    let [from, to] = [i, i + 1].map(|i| points.get(i).copied().unwrap_or_default());
    (from, to, x - i as f32)
}

/// Closed cylinder around y with its base at the origin. Corners at the seam are bit-identical.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Cylinder {
    material: Paint,
    radius: f32,
    height: f32,
    sides: u32,
    /// Subdivisions between its two flat ends.
    rows: u32,
}

impl Cylinder {
    pub fn build(&self, mesh: &mut MeshBuilder) {
        let &Cylinder {
            radius,
            height,
            sides,
            rows,
            ..
        } = self;
        let material = mesh.paint(&self.material);
        let out = |u: f32| {
            let side = (u * sides as f32).round() as u32 % sides.max(1);
            let (s, c) = (side as f32 / sides as f32 * -TAU).sin_cos();
            Vec3::new(c, 0.0, s)
        };
        mesh.grid(material, [sides, rows], |u, v| {
            (
                out(u) * radius + Vec3::Y * (v * height),
                out(u),
                Vec2::new(u, 1.0 - v),
            )
        });
        if !mesh.has_room(4 * u64::from(sides) + 2) {
            return;
        }
        for (y, normal) in [(0.0, Vec3::NEG_Y), (height, Vec3::Y)] {
            let middle = mesh.vertex(Vec3::Y * y, normal, Vec2::splat(0.5));
            for i in 0..sides {
                let [a, b] = [i, i + 1].map(|i| {
                    let out = out(i as f32 / sides as f32);
                    mesh.vertex(
                        out * radius + Vec3::Y * y,
                        normal,
                        0.5 + 0.5 * Vec2::new(out.x, out.z),
                    )
                });
                mesh.triangle(
                    material,
                    if y > 0.0 {
                        [middle, a, b]
                    } else {
                        [middle, b, a]
                    },
                );
            }
        }
    }
}

/// A circle of radius `tube` swept along the ellipse spanned by `major` and `minor`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Ring {
    pub material: Paint,
    #[serde(default)]
    pub centre: Vec3,
    pub major: Vec3,
    pub minor: Vec3,
    pub tube: f32,
    pub segments: [u32; 2],
}

impl Ring {
    pub fn build(&self, mesh: &mut MeshBuilder, at: Vec3) {
        let &Ring {
            major, minor, tube, ..
        } = self;
        let (material, centre) = (mesh.paint(&self.material), self.centre + at);
        let axis = major.cross(minor).normalize_or(Vec3::Y);
        mesh.surface(material, self.segments, Vec2::new(4.0, 1.0), |u, v| {
            let (s, c) = (u * TAU).sin_cos();
            // The normal of the ellipse, so that thin links do not intersect themselves.
            let out = (major * (c / major.length_squared()) + minor * (s / minor.length_squared()))
                .normalize();
            let (height, width) = (v * TAU).sin_cos();
            centre + major * c + minor * s + out * (tube * width) + axis * (tube * height)
        });
    }
}

/// Open cylinder; `axis` has unit length, and it extends `half` metres both ways.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Rod {
    pub material: Paint,
    #[serde(default)]
    pub centre: Vec3,
    pub axis: Vec3,
    pub half: f32,
    pub radius: f32,
}

impl Rod {
    pub fn build(&self, mesh: &mut MeshBuilder, at: Vec3) {
        let &Rod {
            axis, half, radius, ..
        } = self;
        let (material, centre) = (mesh.paint(&self.material), self.centre + at);
        let side = axis.any_orthonormal_vector();
        let other = axis.cross(side);
        mesh.surface(material, [10, 2], Vec2::ONE, |u, v| {
            let (s, c) = (u * TAU).sin_cos();
            centre + axis * ((v * 2.0 - 1.0) * half) + (side * c + other * s) * radius
        });
    }
}
