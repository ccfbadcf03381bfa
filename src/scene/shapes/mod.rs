//! Shapes of scene files. All faces are counter-clockwise seen from outside.
//!
//! The fields of a shape are those of the file. The builder keeps the first error and reports it at
//! the end.

mod basic;
mod building;
mod noise;
pub(super) mod patterns;
mod relief;
mod soft;
mod solid;

use glam::{Mat4, Vec2, Vec3};
use indexmap::IndexMap;
use serde::Deserialize;

use super::{Material, Mesh, Submesh, Vertex};
pub(super) use basic::{Ball, Cuboid, Cylinder, Lathe, Quad, Ring, Rod, Triangle};
pub(super) use building::{Arch, Bars, Capital, Hip, Level, Moulding, Slope, Vault};
pub(super) use noise::Random;
pub(super) use relief::{Specks, Vase};
pub(super) use soft::{Banner, Chain, Crown, Curtain, Sprigs};
pub(super) use solid::{Hollow, Solid};

/// Maximum vertices of all meshes of a scene file.
pub(super) const MAX_VERTICES: u64 = 1 << 22;

/// The name of a material, or several that a repetition cycles through.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub(super) enum Paint {
    One(String),
    Several(Vec<String>),
}

/// An error in a shape, and a name near it in the file.
#[derive(Debug)]
pub(super) struct Problem {
    pub near: String,
    pub message: String,
}

/// Collects triangles by material, transformed by `transform`.
pub(super) struct MeshBuilder<'a> {
    name: String,
    materials: &'a IndexMap<String, Material>,
    vertices: Vec<Vertex>,
    /// Remaining number of vertices.
    room: u64,
    triangles: IndexMap<u32, Vec<u32>>,
    transform: Mat4,
    /// Inverse transpose for normals under non-uniform scale.
    normals: Mat4,
    /// Index of the current repetition.
    pub number: u32,
    pub random: Random,
    pub problem: Option<Problem>,
}

impl<'a> MeshBuilder<'a> {
    pub fn new(name: &str, materials: &'a IndexMap<String, Material>, room: u64) -> Self {
        MeshBuilder {
            name: name.into(),
            materials,
            vertices: Vec::new(),
            room,
            triangles: IndexMap::new(),
            transform: Mat4::IDENTITY,
            normals: Mat4::IDENTITY,
            number: 0,
            random: Random(0),
            problem: None,
        }
    }

    /// Sets the transform of the geometry that follows.
    pub fn place(&mut self, transform: Mat4) {
        self.transform = transform;
        self.normals = transform.inverse().transpose();
    }

    pub fn finish(self) -> Result<Mesh, Problem> {
        if let Some(problem) = self.problem {
            return Err(problem);
        }
        let mut mesh = Mesh {
            name: self.name,
            vertices: self.vertices,
            ..Mesh::default()
        };
        for (material, indices) in self.triangles {
            let first_index = mesh.indices.len() as u32;
            mesh.submeshes.push(Submesh {
                first_index,
                index_count: indices.len() as u32,
                material,
            });
            mesh.indices.extend(indices);
        }
        Ok(mesh)
    }

    /// Records an error; the first one is kept.
    pub fn fail(&mut self, near: &str, message: String) {
        self.problem.get_or_insert(Problem {
            near: near.into(),
            message,
        });
    }

    /// Whether there is no error and room for `more` vertices.
    pub fn has_room(&mut self, more: u64) -> bool {
        if self.vertices.len() as u64 + more > self.room {
            self.fail(
                "",
                format!("with it there would be more than {MAX_VERTICES} vertices"),
            );
        }
        self.problem.is_none()
    }

    /// The index of a material by name.
    pub fn paint(&mut self, paint: &Paint) -> u32 {
        let name = match paint {
            Paint::One(name) => name,
            Paint::Several(names) if !names.is_empty() => {
                &names[self.number as usize % names.len()]
            }
            Paint::Several(_) => return self.no_material(""),
        };
        self.materials
            .get_index_of(name)
            .map_or_else(|| self.no_material(name), |i| i as u32)
    }

    fn no_material(&mut self, name: &str) -> u32 {
        let known: Vec<&str> = self.materials.keys().map(String::as_str).collect();
        self.fail(
            name,
            format!(
                "no material '{name}'. Materials of this file: {}",
                known.join(", ")
            ),
        );
        0
    }

    pub fn vertex(&mut self, position: Vec3, normal: Vec3, uv: Vec2) -> u32 {
        let position = self.transform.transform_point3(position);
        let normal = self.normals.transform_vector3(normal);
        self.vertices.push(Vertex {
            position: position.to_array(),
            normal: normal.normalize_or(Vec3::Y).to_array(),
            uv: uv.to_array(),
            ..Vertex::default()
        });
        self.vertices.len() as u32 - 1
    }

    pub fn triangle(&mut self, material: u32, corners: [u32; 3]) {
        self.triangles.entry(material).or_default().extend(corners);
    }

    /// Flat quad with counter-clockwise corners, subdivided `n` by `n`; uv in metres over `tile`.
    pub fn quad(&mut self, material: u32, corners: [Vec3; 4], n: u32, tile: f32) {
        let [a, b, c, d] = corners;
        let normal = (c - a).cross(d - b).normalize_or(Vec3::Y);
        let size = Vec2::new(a.distance(b), a.distance(d)) / tile;
        self.grid(material, [n, n], |u, v| {
            let position = a.lerp(b, u).lerp(d.lerp(c, u), v);
            (position, normal, Vec2::new(u, 1.0 - v) * size)
        });
    }

    /// Grid over u and v in 0..1 from positions, normals and texture coordinates. The front is
    /// where u increases to the right and v upwards.
    pub fn grid(
        &mut self,
        material: u32,
        [nu, nv]: [u32; 2],
        point: impl Fn(f32, f32) -> (Vec3, Vec3, Vec2),
    ) {
        if !self.has_room((u64::from(nu) + 1).saturating_mul(u64::from(nv) + 1)) {
            return;
        }
        let first = self.vertices.len() as u32;
        for j in 0..=nv {
            for i in 0..=nu {
                let (position, normal, uv) = point(i as f32 / nu as f32, j as f32 / nv as f32);
                self.vertex(position, normal, uv);
            }
        }
        for j in 0..nv {
            for i in 0..nu {
                let a = first + j * (nu + 1) + i;
                let (b, c, d) = (a + 1, a + nu + 2, a + nu + 1);
                self.triangle(material, [a, b, c]);
                self.triangle(material, [a, c, d]);
            }
        }
    }

    /// Smooth parametric surface over u and v in 0..1; normals are derived from derivatives.
    pub fn surface(
        &mut self,
        material: u32,
        divisions: [u32; 2],
        uv_scale: Vec2,
        point: impl Fn(f32, f32) -> Vec3,
    ) {
        const STEP: f32 = 1e-3;
        let normal_at = |u: f32, v: f32| {
            let du = point(u + STEP, v) - point(u - STEP, v);
            let dv = point(u, v + STEP) - point(u, v - STEP);
            du.cross(dv)
        };
        self.grid(material, divisions, |u, v| {
            // The derivative vanishes at a pole; a nearby point has nearly the same normal.
            let inner = v.clamp(5e-3, 1.0 - 5e-3);
            let normal = normal_at(u, v);
            let normal = if normal.length_squared() > 1e-14 {
                normal
            } else {
                normal_at(u, inner)
            };
            (
                point(u, v),
                normal.normalize_or(Vec3::Y),
                Vec2::new(u, 1.0 - v) * uv_scale,
            )
        });
    }

    /// Box with uv in metres over `tile`; `faces` selects -x, +x, -y, +y, -z, +z.
    pub fn cuboid(&mut self, material: u32, low: Vec3, high: Vec3, tile: f32, faces: [bool; 6]) {
        let p = |x: u8, y: u8, z: u8| {
            let pick = |i: u8, l: f32, h: f32| if i == 0 { l } else { h };
            Vec3::new(
                pick(x, low.x, high.x),
                pick(y, low.y, high.y),
                pick(z, low.z, high.z),
            )
        };
        let quads = [
            [p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0)],
            [p(1, 0, 1), p(1, 0, 0), p(1, 1, 0), p(1, 1, 1)],
            [p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1)],
            [p(0, 1, 1), p(1, 1, 1), p(1, 1, 0), p(0, 1, 0)],
            [p(1, 0, 0), p(0, 0, 0), p(0, 1, 0), p(1, 1, 0)],
            [p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1)],
        ];
        for (quad, _) in quads.into_iter().zip(faces).filter(|(_, wanted)| *wanted) {
            self.quad(material, quad, 1, tile);
        }
    }
}

/// Faces of a box by direction.
pub(super) const FACES: [&str; 6] = ["-x", "+x", "-y", "+y", "-z", "+z"];

fn one() -> f32 {
    1.0
}
