//! Meshes from the faces of an OBJ file: one per object, with a submesh per run of one material.

use std::collections::HashMap;

use foldhash::fast::RandomState;

use super::faces::{Corner, NONE};
use super::geometry::{Geometry, Piece, Smoothing};
use super::maps::Placement;
use super::material::{Surface, surface_of};
use super::smoothing::{self, Group};
use super::triangulate::triangulate;
use crate::metrics::colour::srgb_to_linear;
use crate::scene::mesh::RawMesh;
use crate::scene::progress::Progress;
use crate::scene::warnings::Warnings;
use crate::scene::{Mesh, Submesh, Vertex};

/// Meshes of all pieces in file order. `surfaces` has one entry per used name and a last one for
/// faces without a material.
pub(super) fn build(
    geometry: &Geometry,
    surfaces: &[Surface],
    warnings: &mut Warnings,
    progress: Progress,
) -> Result<Vec<RawMesh>, String> {
    let mut meshes = Vec::new();
    let mut open: Option<Builder> = None;
    for (number, piece) in geometry.pieces.iter().enumerate() {
        if progress.stopped() {
            return Err(String::new());
        }
        let surface = surface_of(surfaces, piece.material);
        if surface.left_out {
            continue;
        }
        if open
            .as_ref()
            .is_some_and(|builder| builder.mesh.name != piece.object)
        {
            meshes.extend(open.take().map(Builder::finish));
        }
        let builder = open.get_or_insert_with(|| Builder::new(piece));
        let end = geometry
            .pieces
            .get(number + 1)
            .map_or(geometry.faces.len(), |next| next.first_face);
        builder.add(geometry, piece.first_face..end, &surface, warnings)?;
    }
    meshes.extend(open.map(Builder::finish));
    Ok(meshes)
}

struct Builder {
    mesh: Mesh,
    /// One per triangle.
    groups: Vec<Group>,
    has_normals: bool,
    lacks_normals: bool,
    /// Vertices by the indices of their corner and the placement of the material's textures.
    vertices: HashMap<(Corner, [u32; 4]), u32, RandomState>,
}

impl Builder {
    fn new(piece: &Piece) -> Builder {
        Builder {
            mesh: Mesh {
                name: piece.object.clone(),
                ..Mesh::default()
            },
            groups: Vec::new(),
            has_normals: false,
            lacks_normals: false,
            vertices: HashMap::default(),
        }
    }

    fn add(
        &mut self,
        geometry: &Geometry,
        faces: std::ops::Range<usize>,
        surface: &Surface,
        warnings: &mut Warnings,
    ) -> Result<(), String> {
        let first_index = self.mesh.indices.len();
        let (mut polygon, mut triangles) = (Vec::new(), Vec::new());
        for number in faces {
            let corners = geometry.corners_of(number);
            polygon.clear();
            polygon.extend(
                corners
                    .iter()
                    .map(|c| geometry.positions[c.position as usize]),
            );
            triangles.clear();
            let face = &geometry.faces[number];
            if triangulate(&polygon, &mut triangles).rough {
                let line = face.line;
                warnings.add(
                    "faces cross or touch themselves: their triangles may overlap",
                    format_args!("line {line}"),
                );
            }
            let group = match face.smoothing {
                Smoothing::Angle => Group::Angle,
                Smoothing::Off => Group::Face(number as u32),
                Smoothing::Group(group) => Group::Number(group),
            };
            self.groups
                .resize(self.groups.len() + triangles.len(), group);
            for corner in triangles.as_flattened() {
                let index = self.vertex(geometry, corners[*corner as usize], &surface.placement)?;
                self.mesh.indices.push(index);
            }
        }
        let index_count = self.mesh.indices.len() - first_index;
        let number =
            |n: usize| u32::try_from(n).map_err(|_| "it has more than 2^32 indices in one object");
        self.mesh.submeshes.push(Submesh {
            first_index: number(first_index)?,
            index_count: number(index_count)?,
            material: surface.material,
        });
        Ok(())
    }

    fn vertex(
        &mut self,
        geometry: &Geometry,
        corner: Corner,
        placement: &Placement,
    ) -> Result<u32, String> {
        let next = u32::try_from(self.mesh.vertices.len())
            .map_err(|_| "it has more than 2^32 vertices")?;
        let index = *self
            .vertices
            .entry((corner, placement.bits()))
            .or_insert(next);
        if index == next {
            self.has_normals |= corner.normal != NONE;
            self.lacks_normals |= corner.normal == NONE;
            let uv = geometry
                .uvs
                .get(corner.uv as usize)
                .map_or([0.0; 2], |uv| placement.of(*uv));
            self.mesh.vertices.push(Vertex {
                position: geometry.positions[corner.position as usize],
                normal: geometry
                    .normals
                    .get(corner.normal as usize)
                    .copied()
                    .unwrap_or_default(),
                uv,
                color: geometry
                    .colors
                    .get(corner.position as usize)
                    .map_or([1.0; 4], linear),
                ..Vertex::default()
            });
        }
        Ok(index)
    }

    fn finish(self) -> RawMesh {
        let Builder {
            mut mesh,
            groups,
            mut has_normals,
            lacks_normals,
            ..
        } = self;
        let grouped = groups.iter().any(|group| *group != Group::Angle);
        if lacks_normals && (has_normals || grouped) {
            smoothing::complete(&mut mesh, &groups);
            has_normals = true;
        }
        RawMesh {
            mesh,
            sources: Vec::new(),
            has_normals,
            has_tangents: false,
        }
    }
}

/// A vertex colour in linear RGB; programs write sRGB.
fn linear(srgb: &[f32; 3]) -> [f32; 4] {
    let [r, g, b] = srgb.map(|c| {
        if c.is_finite() {
            srgb_to_linear(c.clamp(0.0, 1.0))
        } else {
            1.0
        }
    });
    [r, g, b, 1.0]
}
