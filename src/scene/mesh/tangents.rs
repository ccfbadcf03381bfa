//! Tangents: MikkTSpace for normal maps, otherwise any vector orthogonal to the normal.

use super::weld_sources;
use crate::scene::{Mesh, Vertex};
use bevy_mikktspace::{Geometry, TangentSpace};
use glam::Vec3;

/// MikkTSpace tangents; vertices with conflicting tangents are split.
///
/// MikkTSpace's bitangent points along increasing v, which is down in the picture (glTF 2.0,
/// 3.8.3). Normal maps have +y up (glTF 2.0, `material.normalTexture`), so the sign is negated.
pub(super) fn generate(mesh: &mut Mesh, sources: &mut Vec<u32>, second_set: bool) {
    let corners = mesh
        .indices
        .iter()
        .map(|&i| mesh.vertices[i as usize])
        .collect();
    let mut soup = Soup {
        corners,
        second_set,
    };
    if bevy_mikktspace::generate_tangents(&mut soup).is_ok() && !soup.corners.is_empty() {
        let of_corner: Vec<u32> = mesh
            .indices
            .iter()
            .filter_map(|&i| sources.get(i as usize).copied())
            .collect();
        (mesh.vertices, mesh.indices, *sources) = weld_sources(&soup.corners, &of_corner);
    }
    repair(mesh);
}

/// Normalises tangents and their sign; replaces zero tangents.
pub(super) fn repair(mesh: &mut Mesh) {
    for vertex in &mut mesh.vertices {
        let [x, y, z, w] = vertex.tangent;
        let tangent = Vec3::new(x, y, z).normalize_or_zero();
        if tangent == Vec3::ZERO {
            vertex.tangent = any_tangent(vertex.normal);
        } else {
            vertex.tangent = tangent.extend(if w < 0.0 { -1.0 } else { 1.0 }).to_array();
        }
    }
}

/// Arbitrary orthonormal tangents.
pub(super) fn any(mesh: &mut Mesh) {
    for vertex in &mut mesh.vertices {
        vertex.tangent = any_tangent(vertex.normal);
    }
}

fn any_tangent(normal: [f32; 3]) -> [f32; 4] {
    Vec3::from_array(normal)
        .any_orthonormal_vector()
        .extend(1.0)
        .to_array()
}

struct Soup {
    corners: Vec<Vertex>,
    /// Whether the normal map uses the second set of texture coordinates.
    second_set: bool,
}

impl Geometry for Soup {
    fn num_faces(&self) -> usize {
        self.corners.len() / 3
    }
    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }
    fn position(&self, face: usize, vertex: usize) -> [f32; 3] {
        self.corners[face * 3 + vertex].position
    }
    fn normal(&self, face: usize, vertex: usize) -> [f32; 3] {
        self.corners[face * 3 + vertex].normal
    }
    fn tex_coord(&self, face: usize, vertex: usize) -> [f32; 2] {
        let corner = &self.corners[face * 3 + vertex];
        if self.second_set {
            corner.uv_second
        } else {
            corner.uv
        }
    }
    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, vertex: usize) {
        // A degenerate triangle without neighbours gets no tangent; `repair` makes one.
        self.corners[face * 3 + vertex].tangent = space.map_or([0.0; 4], |space| {
            let [x, y, z, w] = space.tangent_encoded();
            [x, y, z, -w]
        });
    }
}
