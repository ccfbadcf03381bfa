//! Normals from smoothing groups, for corners without normals.

use std::collections::HashMap;

use glam::Vec3;

use crate::scene::mesh::{corner_angles, face_normal, is_creased, point_key, weld};
use crate::scene::{Mesh, Vertex};

/// Points with more corners get flat normals under angle-based smoothing, which takes quadratic
/// time.
const MAX_VALENCE: usize = 256;

/// Triangles of one group are smoothed together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Group {
    /// Triangles that meet below the crease angle.
    Angle,
    /// Triangles of one face.
    Face(u32),
    /// Triangles of one smoothing group.
    Number(u32),
}

/// Replaces zero normals by the angle-weighted mean over the triangles of the group at that point.
/// `groups` has one entry per triangle.
pub(super) fn complete(mesh: &mut Mesh, groups: &[Group]) {
    let mut corners: Vec<Vertex> = mesh
        .indices
        .iter()
        .map(|i| mesh.vertices[*i as usize])
        .collect();
    let triangles = corners.as_chunks::<3>().0;
    let faces: Vec<Vec3> = triangles
        .iter()
        .map(|t| face_normal(t.map(|v| v.position)))
        .collect();
    // The normal of a degenerate triangle is arbitrary, so its weight is 0.
    let weights: Vec<f32> = triangles.iter().flat_map(weights).collect();
    let mut at_point: HashMap<[u32; 3], Vec<u32>> = HashMap::new();
    for (i, corner) in corners.iter().enumerate() {
        at_point
            .entry(point_key(corner.position))
            .or_default()
            .push(i as u32);
    }
    let group_of = |i: u32| groups[i as usize / 3];
    let weighted = |i: u32| faces[i as usize / 3] * weights[i as usize];
    for point in at_point.values_mut() {
        point.sort_by_key(|i| group_of(*i));
        for together in point.chunk_by(|a, b| group_of(*a) == group_of(*b)) {
            let all: Vec3 = together.iter().map(|i| weighted(*i)).sum();
            for &i in together
                .iter()
                .filter(|i| corners[**i as usize].normal == [0.0; 3])
                .collect::<Vec<_>>()
            {
                let own = faces[i as usize / 3];
                let near = |j: &&u32| !is_creased(faces[**j as usize / 3], own);
                let sum = match group_of(i) {
                    Group::Angle if together.len() > MAX_VALENCE => own,
                    Group::Angle => together.iter().filter(near).map(|j| weighted(*j)).sum(),
                    Group::Face(_) | Group::Number(_) => all,
                };
                corners[i as usize].normal = sum.normalize_or(own).to_array();
            }
        }
    }
    (mesh.vertices, mesh.indices) = weld(&corners);
}

/// The corner angles of a triangle, or zeros if it is degenerate.
fn weights(triangle: &[Vertex; 3]) -> [f32; 3] {
    let [a, b, c] = triangle.map(|v| Vec3::from_array(v.position));
    let angles = corner_angles(triangle);
    let has_area =
        (b - a).cross(c - a).length_squared() > 0.0 && angles.iter().all(|angle| angle.is_finite());
    if has_area { angles } else { [0.0; 3] }
}
