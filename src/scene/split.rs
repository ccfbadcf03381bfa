//! Splitting of long triangle edges, for methods that sample triangles at vertices.

use std::collections::HashMap;

use glam::{Mat3, Vec3, Vec4};
use rayon::prelude::*;

use super::{Mesh, Scene, Submesh, Vertex};

/// Splitting stops before a scene has more triangles than this.
pub const MAX_TRIANGLES: usize = 64 << 20;

impl Scene {
    /// A copy in which no triangle has an edge longer than `max_edge` metres in the world.
    ///
    /// Whether an edge is split depends only on its ends, and both sides compute the same midpoint.
    /// Triangles that share an edge therefore stay watertight, also across seams of normals and
    /// texture coordinates. A mesh with several placements is split for the largest one, in its
    /// pose at 0 s. Meshes that would exceed `MAX_TRIANGLES` stay unchanged, as does the whole
    /// scene if `max_edge` is not positive; a warning reports it.
    pub fn split_triangles(&self, max_edge: f32) -> Scene {
        let mut scene = self.clone();
        if max_edge.is_nan() || max_edge <= 0.0 {
            scene.warnings.push(format!(
                "{}: triangles not split, {max_edge} m is no edge length",
                self.name
            ));
            return scene;
        }
        let placements = |mesh: usize| -> Vec<Mat3> { self.placed_at_rest(mesh).collect() };
        let mut budget = MAX_TRIANGLES.saturating_sub(self.triangle_count());
        for i in 0..scene.meshes.len() {
            let axes = placements(i);
            let too_long = |a: Vec3, b: Vec3| {
                // In f64 and from the difference, so that both directions of an edge agree.
                let edge = b - a;
                axes.iter()
                    .any(|axes| (*axes * edge).as_dvec3().length() > f64::from(max_edge))
            };
            let before = scene.meshes[i].triangle_count();
            let limit = before + budget / axes.len().max(1);
            match split_mesh(&scene.meshes[i], &too_long, limit) {
                Some((split, halves)) => {
                    budget -= (split.triangle_count() - before) * axes.len();
                    scene.meshes[i] = split;
                    scene.deformers.iter_mut().filter(|d| d.mesh as usize == i).for_each(|d| d.halves = halves.clone());
                }
                None => scene.warnings.push(format!(
                    "mesh '{}' not split to {max_edge} m: the scene would pass {MAX_TRIANGLES} triangles. \
                     Use a longer edge",
                    scene.meshes[i].name
                )),
            }
        }
        scene
    }

    /// Lower bound of the vertex bytes of [`Scene::split_triangles`], without splitting. No
    /// triangle with edges of `max_edge` has more area than the equilateral one, and there are half
    /// as many vertices as triangles.
    pub fn least_split_bytes(&self, max_edge: f32) -> f64 {
        let largest = 0.25 * 3f64.sqrt() * f64::from(max_edge).powi(2);
        let triangles = |i: usize| {
            self.placed_at_rest(i)
                .map(|axes| area(&self.meshes[i], &axes))
                .fold(0.0, f64::max)
                / largest
        };
        (0..self.meshes.len()).map(triangles).sum::<f64>() * 0.5 * size_of::<Vertex>() as f64
    }
}

impl Scene {
    /// The axes of each instance of a mesh, at 0 s.
    fn placed_at_rest(&self, mesh: usize) -> impl Iterator<Item = Mat3> + '_ {
        let of_mesh = self
            .instances
            .iter()
            .enumerate()
            .filter(move |(_, instance)| instance.mesh as usize == mesh);
        of_mesh.map(|(i, _)| Mat3::from_mat4(self.instance_transform(i, 0.0)))
    }
}

/// World area of a mesh, m^2.
fn area(mesh: &Mesh, axes: &Mat3) -> f64 {
    let triangle = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| *axes * Vec3::from_array(mesh.vertices[i as usize].position));
        0.5 * (b - a).as_dvec3().cross((c - a).as_dvec3()).length()
    };
    mesh.indices
        .as_chunks::<3>()
        .0
        .par_iter()
        .map(triangle)
        .sum()
}

/// The mesh split round by round, and the edge that each new vertex halves; `None` above the
/// triangle limit.
fn split_mesh(
    mesh: &Mesh,
    too_long: &(impl Fn(Vec3, Vec3) -> bool + Sync),
    limit: usize,
) -> Option<(Mesh, Vec<[u32; 2]>)> {
    let (mut mesh, mut halves) = (mesh.clone(), Vec::new());
    loop {
        let marks: Vec<[bool; 3]> = mesh
            .indices
            .as_chunks::<3>()
            .0
            .par_iter()
            .map(|t| long_edges(&mesh, t, too_long))
            .collect();
        let added: usize = marks.iter().flatten().filter(|&&m| m).count();
        if added == 0 {
            return Some((mesh, halves));
        }
        if marks.len() + added > limit {
            return None;
        }
        mesh = split_once(&mesh, &marks, &mut halves);
    }
}

/// Which of the edges 0-1, 1-2 and 2-0 are too long.
fn long_edges(
    mesh: &Mesh,
    triangle: &[u32; 3],
    too_long: impl Fn(Vec3, Vec3) -> bool,
) -> [bool; 3] {
    let p = triangle.map(|i| Vec3::from_array(mesh.vertices[i as usize].position));
    [
        too_long(p[0], p[1]),
        too_long(p[1], p[2]),
        too_long(p[2], p[0]),
    ]
}

fn split_once(mesh: &Mesh, marks: &[[bool; 3]], halves: &mut Vec<[u32; 2]>) -> Mesh {
    let mut split = Mesh {
        name: mesh.name.clone(),
        vertices: mesh.vertices.clone(),
        ..Mesh::default()
    };
    let mut midpoints: HashMap<(u32, u32), u32> = HashMap::new();
    for submesh in &mesh.submeshes {
        let first_index = split.indices.len() as u32;
        let triangles = submesh.first_index as usize / 3
            ..(submesh.first_index + submesh.index_count) as usize / 3;
        for i in triangles {
            let triangle = [0, 1, 2].map(|k| mesh.indices[3 * i + k]);
            split_triangle(&mut split, &mut midpoints, triangle, marks[i]);
        }
        split.submeshes.push(Submesh {
            first_index,
            index_count: split.indices.len() as u32 - first_index,
            ..*submesh
        });
    }
    let mut ends: Vec<(u32, [u32; 2])> = midpoints
        .into_iter()
        .map(|((a, b), middle)| (middle, [a, b]))
        .collect();
    ends.sort_unstable();
    halves.extend(ends.into_iter().map(|(_, ends)| ends));
    split
}

/// Splits a triangle into 1 to 4 triangles with the same winding at its marked edges.
fn split_triangle(
    mesh: &mut Mesh,
    midpoints: &mut HashMap<(u32, u32), u32>,
    t: [u32; 3],
    marks: [bool; 3],
) {
    let count = marks.iter().filter(|&&m| m).count();
    // Rotated so that one marked edge is 0-1, or two are 0-1 and 1-2.
    let turn = match count {
        1 => marks.iter().position(|&m| m).unwrap_or(0),
        2 => (marks.iter().position(|&m| !m).unwrap_or(2) + 1) % 3,
        _ => 0,
    };
    let [a, b, c] = [t[turn], t[(turn + 1) % 3], t[(turn + 2) % 3]];
    let mut middle = |mesh: &mut Mesh, a: u32, b: u32| {
        *midpoints.entry((a.min(b), a.max(b))).or_insert_with(|| {
            let vertex = halfway(&mesh.vertices[a as usize], &mesh.vertices[b as usize]);
            mesh.vertices.push(vertex);
            mesh.vertices.len() as u32 - 1
        })
    };
    match count {
        0 => mesh.indices.extend([a, b, c]),
        1 => {
            let ab = middle(mesh, a, b);
            mesh.indices.extend([a, ab, c, ab, b, c]);
        }
        2 => {
            let (ab, bc) = (middle(mesh, a, b), middle(mesh, b, c));
            mesh.indices.extend([ab, b, bc]);
            // The median of the longer marked edge is shorter than both edges, so splitting
            // terminates.
            if length(mesh, a, b) >= length(mesh, b, c) {
                mesh.indices.extend([a, ab, c, ab, bc, c]);
            } else {
                mesh.indices.extend([a, ab, bc, a, bc, c]);
            }
        }
        _ => {
            let (ab, bc, ca) = (middle(mesh, a, b), middle(mesh, b, c), middle(mesh, c, a));
            mesh.indices
                .extend([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca]);
        }
    }
}

fn length(mesh: &Mesh, a: u32, b: u32) -> f32 {
    let position = |i: u32| Vec3::from_array(mesh.vertices[i as usize].position);
    position(a).distance(position(b))
}

pub(super) fn halfway(a: &Vertex, b: &Vertex) -> Vertex {
    let middle = |a: [f32; 3], b: [f32; 3]| (Vec3::from_array(a) + Vec3::from_array(b)) * 0.5;
    let normal = middle(a.normal, b.normal).normalize_or(Vec3::from_array(a.normal));
    let tangent =
        middle(xyz(a.tangent), xyz(b.tangent)).normalize_or(Vec3::from_array(xyz(a.tangent)));
    let between = |a: [f32; 2], b: [f32; 2]| [(a[0] + b[0]) * 0.5, (a[1] + b[1]) * 0.5];
    Vertex {
        position: middle(a.position, b.position).to_array(),
        normal: normal.to_array(),
        tangent: Vec4::from((tangent, a.tangent[3])).to_array(),
        uv: between(a.uv, b.uv),
        uv_second: between(a.uv_second, b.uv_second),
        color: ((Vec4::from_array(a.color) + Vec4::from_array(b.color)) * 0.5).to_array(),
    }
}

fn xyz([x, y, z, _]: [f32; 4]) -> [f32; 3] {
    [x, y, z]
}
