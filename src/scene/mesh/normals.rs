//! Generation of missing normals and repair of invalid ones.

use std::collections::HashMap;

use glam::Vec3;

use super::{face_normal, weld};
use crate::scene::{Mesh, Vertex};

/// Cosine of the crease angle: faces that meet at a larger angle stay sharp.
const CREASE_COSINE: f32 = 0.5;
/// Points with more corners get flat normals, because smoothing takes quadratic time in the
/// valence.
const MAX_VALENCE: usize = 256;

/// Normalises normals; zero normals are replaced by a face normal.
pub(super) fn repair(mesh: &mut Mesh) {
    let mut missing = false;
    for vertex in &mut mesh.vertices {
        let normal = Vec3::from_array(vertex.normal).normalize_or_zero();
        vertex.normal = normal.to_array();
        missing |= normal == Vec3::ZERO;
    }
    if !missing {
        return;
    }
    for triangle in mesh.indices.as_chunks::<3>().0 {
        let normal = face_normal(triangle.map(|i| mesh.vertices[i as usize].position));
        for &i in triangle {
            let vertex = &mut mesh.vertices[i as usize];
            if vertex.normal == [0.0; 3] {
                vertex.normal = normal.to_array();
            }
        }
    }
}

/// Gives every corner its face normal. [`super::prepare_all`] reports indices out of range.
pub(in crate::scene) fn flat(mesh: &mut Mesh) {
    let corners = mesh
        .indices
        .iter()
        .map(|&i| mesh.vertices.get(i as usize).copied());
    let Some(mut corners) = corners.collect::<Option<Vec<Vertex>>>() else {
        return;
    };
    flatten(&mut corners);
    (mesh.vertices, mesh.indices) = weld(&corners);
}

/// Gives three corners each their face normal.
pub(in crate::scene) fn flatten(corners: &mut [Vertex]) {
    for triangle in corners.as_chunks_mut::<3>().0 {
        let normal = face_normal(triangle.map(|v| v.position)).to_array();
        triangle
            .iter_mut()
            .for_each(|corner| corner.normal = normal);
    }
}

/// Smooth normals weighted by corner angle, over faces that meet at 60 degrees or less.
pub(super) fn generate(mesh: &mut Mesh) {
    let mut corners: Vec<Vertex> = mesh
        .indices
        .iter()
        .map(|&i| mesh.vertices[i as usize])
        .collect();
    let faces: Vec<Vec3> = corners
        .as_chunks::<3>()
        .0
        .iter()
        .map(|t| face_normal(t.map(|v| v.position)))
        .collect();
    let angles: Vec<f32> = corners
        .as_chunks::<3>()
        .0
        .iter()
        .flat_map(corner_angles)
        .collect();
    let mut at_point: HashMap<[u32; 3], Vec<u32>> = HashMap::with_capacity(mesh.vertices.len());
    for (i, corner) in corners.iter().enumerate() {
        at_point
            .entry(point_key(corner.position))
            .or_default()
            .push(i as u32);
    }
    for group in at_point.values() {
        for &i in group {
            let own = faces[i as usize / 3];
            let near = |j: &&u32| !is_creased(faces[**j as usize / 3], own);
            let sum: Vec3 = match group.len() > MAX_VALENCE {
                true => own,
                false => group
                    .iter()
                    .filter(near)
                    .map(|&j| faces[j as usize / 3] * angles[j as usize])
                    .sum(),
            };
            corners[i as usize].normal = sum.normalize_or(own).to_array();
        }
    }
    (mesh.vertices, mesh.indices) = weld(&corners);
}

/// Whether the edge between two faces is sharp, from their normals.
pub(in crate::scene) fn is_creased(one: Vec3, other: Vec3) -> bool {
    one.dot(other) < CREASE_COSINE
}

/// Equal positions have equal keys; adding zero folds -0 into +0.
pub(in crate::scene) fn point_key(position: [f32; 3]) -> [u32; 3] {
    position.map(|c| (c + 0.0).to_bits())
}

/// Corner angles of a triangle (radians).
pub(in crate::scene) fn corner_angles(triangle: &[Vertex; 3]) -> [f32; 3] {
    let p = triangle.map(|v| Vec3::from_array(v.position));
    let angle = |i: usize| {
        let (u, v) = (p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]);
        u.normalize_or_zero()
            .dot(v.normalize_or_zero())
            .clamp(-1.0, 1.0)
            .acos()
    };
    [angle(0), angle(1), angle(2)]
}
