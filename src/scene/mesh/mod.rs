//! From raw triangles of a file to valid meshes: finite, non-degenerate, with normals and tangents.

mod closed;
mod normals;
mod tangents;

use std::collections::HashMap;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

pub use closed::Side;
pub(super) use normals::{corner_angles, flat, flatten, is_creased, point_key};

use super::progress::Progress;
use super::{Material, Mesh, Vertex};

/// A mesh before repair.
#[derive(Clone, Debug, Default)]
pub(super) struct RawMesh {
    pub mesh: Mesh,
    /// For a deforming mesh, the source index of each vertex. Vertices with different sources are
    /// not merged.
    pub sources: Vec<u32>,
    pub has_normals: bool,
    pub has_tangents: bool,
}

/// Triangles removed by [`prepare_all`].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Dropped {
    pub not_finite: usize,
    pub no_area: usize,
}

impl Dropped {
    /// The warning about dropped triangles, if there are any.
    pub fn warning(&self, file: &str) -> Option<String> {
        if self.not_finite + self.no_area == 0 {
            return None;
        }
        let kinds = [
            (self.not_finite, "with NaN or infinite vertices"),
            (self.no_area, "without area"),
        ];
        let some = kinds.iter().filter(|(count, _)| *count > 0);
        let list: Vec<String> = some
            .map(|(count, what)| format!("{count} triangles {what}"))
            .collect();
        Some(format!("{file}: dropped {}", list.join(" and ")))
    }
}

/// Repairs meshes in parallel. Fails on an index out of range.
pub(super) fn prepare_all(
    raw: Vec<RawMesh>,
    materials: &[Material],
    progress: Progress,
) -> Result<(Vec<Mesh>, Dropped), String> {
    let (prepared, dropped) = prepare_rigged(raw, materials, progress)?;
    Ok((
        prepared.into_iter().map(|(mesh, _)| mesh).collect(),
        dropped,
    ))
}

/// A mesh, and the source index of each vertex if it deforms.
pub(super) type Rigged = (Mesh, Vec<u32>);

/// [`prepare_all`] with the source indices of vertices.
pub(super) fn prepare_rigged(
    raw: Vec<RawMesh>,
    materials: &[Material],
    progress: Progress,
) -> Result<(Vec<Rigged>, Dropped), String> {
    let one = |raw| {
        if progress.stopped() {
            Err(String::new())
        } else {
            prepare(raw, materials)
        }
    };
    let prepared: Result<Vec<_>, String> = raw.into_par_iter().map(one).collect();
    let mut total = Dropped::default();
    let mut meshes = Vec::new();
    for (mesh, sources, dropped) in prepared? {
        total.not_finite += dropped.not_finite;
        total.no_area += dropped.no_area;
        meshes.push((mesh, sources));
    }
    Ok((meshes, total))
}

fn prepare(raw: RawMesh, materials: &[Material]) -> Result<(Mesh, Vec<u32>, Dropped), String> {
    let RawMesh {
        mut mesh,
        mut sources,
        has_normals,
        has_tangents,
    } = raw;
    check_indices(&mesh, materials.len())?;
    // A degenerate triangle may have area in another pose.
    let deforms = !sources.is_empty();
    let dropped = drop_bad_triangles(&mut mesh, deforms);
    drop_unused_vertices(&mut mesh, &mut sources);
    clear_bad_attributes(&mut mesh);
    if has_normals {
        normals::repair(&mut mesh);
    } else {
        normals::generate(&mut mesh);
    }
    let used = mesh
        .submeshes
        .iter()
        .map(|p| &materials[p.material as usize]);
    let normal_map = used
        .filter(|m| m.normal_texture.is_some())
        .map(|m| m.lookups.normal)
        .next();
    if has_tangents {
        tangents::repair(&mut mesh);
    } else if let Some(lookup) = normal_map {
        tangents::generate(&mut mesh, &mut sources, lookup.second_set);
    } else {
        tangents::any(&mut mesh);
    }
    Ok((mesh, sources, dropped))
}

fn check_indices(mesh: &Mesh, materials: usize) -> Result<(), String> {
    let count = mesh.vertices.len();
    if let Some(bad) = mesh.indices.iter().find(|&&i| i as usize >= count) {
        return Err(format!(
            "mesh '{}' has index {bad} but only {count} vertices. The file is damaged; export it again",
            mesh.name
        ));
    }
    for submesh in &mesh.submeshes {
        if submesh.material as usize >= materials {
            return Err(format!(
                "mesh '{}' uses material {} of {materials}. The file is damaged; export it again",
                mesh.name, submesh.material
            ));
        }
    }
    Ok(())
}

/// Removes triangles that are degenerate or not finite in this pose.
pub(super) fn drop_flat(mesh: &mut Mesh) {
    drop_bad_triangles(mesh, false);
    drop_unused_vertices(mesh, &mut Vec::new());
}

/// Rewrites indices and submeshes without degenerate and non-finite triangles.
fn drop_bad_triangles(mesh: &mut Mesh, keep_flat: bool) -> Dropped {
    let mut dropped = Dropped::default();
    let mut kept = Vec::with_capacity(mesh.indices.len());
    for submesh in &mut mesh.submeshes {
        let first = kept.len();
        let range =
            submesh.first_index as usize..(submesh.first_index + submesh.index_count) as usize;
        for triangle in mesh.indices[range].as_chunks::<3>().0 {
            let corner = triangle
                .map(|i| DVec3::from_array(mesh.vertices[i as usize].position.map(f64::from)));
            if corner.iter().any(|p| !p.is_finite()) {
                dropped.not_finite += 1;
            } else if !keep_flat && !has_area(corner) {
                dropped.no_area += 1;
            } else {
                kept.extend_from_slice(triangle);
            }
        }
        submesh.first_index = first as u32;
        submesh.index_count = (kept.len() - first) as u32;
    }
    mesh.indices = kept;
    mesh.submeshes.retain(|submesh| submesh.index_count > 0);
    dropped
}

/// Whether the height exceeds 1e-9 of the longest edge (f64, so thin needles survive); false for
/// points and lines.
fn has_area(corner: [DVec3; 3]) -> bool {
    let (ab, ac, bc) = (
        corner[1] - corner[0],
        corner[2] - corner[0],
        corner[2] - corner[1],
    );
    let longest = ab
        .length_squared()
        .max(ac.length_squared())
        .max(bc.length_squared());
    ab.cross(ac).length() > 1e-9 * longest
}

/// Removes unreferenced vertices, so that bounds and uploads cover only visible geometry.
fn drop_unused_vertices(mesh: &mut Mesh, sources: &mut Vec<u32>) {
    let mut used = vec![false; mesh.vertices.len()];
    for &i in &mesh.indices {
        used[i as usize] = true;
    }
    if used.iter().all(|&u| u) {
        return;
    }
    let mut new_index = vec![0u32; used.len()];
    let mut kept = Vec::new();
    for (i, vertex) in mesh.vertices.iter().enumerate().filter(|(i, _)| used[*i]) {
        new_index[i] = kept.len() as u32;
        kept.push(*vertex);
    }
    mesh.vertices = kept;
    let mut kept = used.iter();
    sources.retain(|_| kept.next().copied().unwrap_or(true));
    for i in &mut mesh.indices {
        *i = new_index[*i as usize];
    }
}

fn clear_bad_attributes(mesh: &mut Mesh) {
    for vertex in &mut mesh.vertices {
        for uv in [&mut vertex.uv, &mut vertex.uv_second] {
            if uv.iter().any(|c| !c.is_finite()) {
                *uv = [0.0; 2];
            }
        }
        // glTF 2.0, 3.7.2.1: colours are clamped.
        vertex.color = vertex
            .color
            .map(|c| if c.is_nan() { 1.0 } else { c.clamp(0.0, 1.0) });
        if vertex.normal.iter().any(|c| !c.is_finite()) {
            vertex.normal = [0.0; 3];
        }
        if vertex.tangent.iter().any(|c| !c.is_finite()) {
            vertex.tangent = [0.0; 4];
        }
    }
}

/// Merges corners with identical bits into shared vertices.
pub(super) fn weld(corners: &[Vertex]) -> (Vec<Vertex>, Vec<u32>) {
    let (vertices, indices, _) = weld_sources(corners, &[]);
    (vertices, indices)
}

/// [`weld`] that also compares source indices (an empty list: all equal) and returns those of the
/// vertices.
pub(super) fn weld_sources(
    corners: &[Vertex],
    sources: &[u32],
) -> (Vec<Vertex>, Vec<u32>, Vec<u32>) {
    const BYTES: usize = size_of::<Vertex>();
    let mut seen: HashMap<([u8; BYTES], Option<u32>), u32> =
        HashMap::with_capacity(corners.len() / 3);
    let (mut vertices, mut kept) = (Vec::new(), Vec::new());
    let indices = corners.iter().enumerate().map(|(i, corner)| {
        let (bytes, source): ([u8; BYTES], _) = (bytemuck::cast(*corner), sources.get(i).copied());
        *seen.entry((bytes, source)).or_insert_with(|| {
            vertices.push(*corner);
            kept.extend(source);
            vertices.len() as u32 - 1
        })
    });
    let indices = indices.collect();
    (vertices, indices, kept)
}

/// Gives each corner its own vertex.
pub(super) fn unweld(raw: &mut RawMesh) {
    let RawMesh { mesh, sources, .. } = raw;
    let corners = mesh
        .indices
        .iter()
        .map(|&i| mesh.vertices.get(i as usize).copied());
    // `prepare_all` reports indices out of range.
    let Some(corners) = corners.collect::<Option<Vec<Vertex>>>() else {
        return;
    };
    *sources = mesh
        .indices
        .iter()
        .filter_map(|&i| sources.get(i as usize).copied())
        .collect();
    mesh.indices = (0..corners.len() as u32).collect();
    mesh.vertices = corners;
}

/// Unit normal of a non-degenerate triangle, from its winding.
pub(super) fn face_normal(corner: [[f32; 3]; 3]) -> Vec3 {
    let [a, b, c] = corner.map(|p| DVec3::from_array(p.map(f64::from)));
    (b - a).cross(c - a).normalize_or(DVec3::Y).as_vec3()
}
