//! Meshes: one for each pair of a mesh in the file and the material list of its nodes.

use glam::DVec2;
use ufbx::{Mesh as From, VertexVec2};

use super::materials::Read;
use super::pictures::UvSource;
use super::{blends, skins};
use crate::metrics::colour::srgb_to_linear;
use crate::scene::mesh::{RawMesh, weld_sources};
use crate::scene::motion::{Rig, Rigs};
use crate::scene::progress::Progress;
use crate::scene::warnings::Warnings;
use crate::scene::{Mesh, Submesh, Vertex};

/// Corners that any file may have.
pub(super) const MANY: usize = 1 << 24;

/// A mesh of the file with the materials of its parts.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Wanted {
    /// Index of the mesh in the file.
    pub mesh: u32,
    /// Indices of materials in the file, one per part.
    pub materials: Vec<u32>,
}

/// The meshes in order, their rigs, and whether any part lacks a material. Parts without one use
/// the index after the last material of the file.
pub(super) fn read(
    file: &ufbx::Scene,
    wanted: &[Wanted],
    materials: &[Read],
    bytes: usize,
    warnings: &mut Warnings,
    progress: Progress,
) -> Result<(Vec<RawMesh>, Rigs, bool), String> {
    // Nodes may share meshes, so a small file could otherwise fill the memory. Counted before any is read: what
    // is refused costs no time.
    let mut room = MANY + bytes;
    for item in wanted {
        let from = of(file, item)?;
        let left = room.checked_sub(from.num_triangles.saturating_mul(3));
        room = left.ok_or_else(|| {
            let why = "with it there are many more corners than the file holds bytes";
            format!("mesh '{}': {why}", name(from))
        })?;
    }
    let mut used = false;
    let (mut meshes, mut rigs) = (Vec::new(), Rigs::new());
    for item in wanted {
        if progress.stopped() {
            return Err(String::new());
        }
        let from = of(file, item)?;
        let skin = skins::of(from);
        let is_rigged = skin.is_some() || blends::any(from);
        if is_rigged {
            let mut rig = Rig {
                morphs: blends::morphs(from, &mut room)?,
                ..Rig::default()
            };
            if let Some(skin) = skin {
                skins::add(&mut rig, from, skin, warnings);
            }
            rigs.insert(meshes.len(), rig);
        }
        let mut reader = Reader {
            from,
            is_rigged,
            corners: Vec::new(),
            sources: Vec::new(),
            triangles: vec![0; from.max_face_triangles * 3],
        };
        let submeshes = reader.parts(item, materials, &mut used)?;
        let (vertices, indices, sources) = weld_sources(&reader.corners, &reader.sources);
        meshes.push(RawMesh {
            mesh: Mesh {
                name: name(from),
                vertices,
                indices,
                submeshes,
            },
            sources,
            has_normals: true,
            has_tangents: false,
        });
    }
    Ok((meshes, rigs, used))
}

fn of<'a>(file: &'a ufbx::Scene, item: &Wanted) -> Result<&'a From, String> {
    let meshes = file.meshes.as_ref();
    let mesh = meshes.get(item.mesh as usize).ok_or_else(damaged)?;
    Ok(mesh)
}

/// Its name, or the name of its first node.
fn name(from: &From) -> String {
    let own = from.element.name.as_ref();
    let node = from
        .element
        .instances
        .into_iter()
        .next()
        .map(|node| node.element.name.as_ref());
    if own.is_empty() {
        node.unwrap_or_default().to_owned()
    } else {
        own.to_owned()
    }
}

fn damaged() -> String {
    "its faces name vertices that do not exist. The file is damaged; export it again".into()
}

struct Reader<'a> {
    from: &'a From,
    /// Whether skins or blend shapes deform it.
    is_rigged: bool,
    /// Three per triangle.
    corners: Vec<Vertex>,
    /// The source vertex of each corner, if the mesh is rigged.
    sources: Vec<u32>,
    /// Triangle indices of one face.
    triangles: Vec<u32>,
}

impl Reader<'_> {
    /// Adds all faces; `used` becomes true if a part has no material.
    fn parts(
        &mut self,
        item: &Wanted,
        materials: &[Read],
        used: &mut bool,
    ) -> Result<Vec<Submesh>, String> {
        let mut submeshes = Vec::new();
        for (part, faces) in self.from.material_parts.iter().enumerate() {
            let material = item.materials.get(part);
            let material = material.map_or(materials.len(), |m| *m as usize);
            let read = materials.get(material);
            let left_out = read.is_some_and(|read| read.asked.material.is_left_out());
            if left_out || faces.num_triangles == 0 {
                continue;
            }
            *used |= read.is_none();
            let first = self.corners.len();
            self.add(&faces.face_indices, read).ok_or_else(damaged)?;
            submeshes.push(Submesh {
                first_index: first as u32,
                index_count: (self.corners.len() - first) as u32,
                material: material as u32,
            });
        }
        Ok(submeshes)
    }

    /// Adds faces of one material; `None` if a face is invalid.
    fn add(&mut self, faces: &[u32], material: Option<&Read>) -> Option<()> {
        let no_sources = Default::default();
        let sources = material.map_or(&no_sources, |read| &read.uv);
        let first = set(self.from, Some(&sources.first));
        let second = set(self.from, sources.second.as_ref());
        for number in faces {
            let face = *self.from.faces.as_ref().get(*number as usize)?;
            if face.num_indices < 3 {
                continue;
            }
            let count = self.from.triangulate_face(&mut self.triangles, face) as usize * 3;
            for i in 0..count {
                let index = *self.triangles.get(i)? as usize;
                let mut vertex = self.corner(index)?;
                vertex.uv = first.map_or(Some([0.0; 2]), |set| set.at(index))?;
                vertex.uv_second = second.map_or(Some([0.0; 2]), |set| set.at(index))?;
                self.corners.push(vertex);
            }
        }
        Some(())
    }
}

impl Reader<'_> {
    /// Position, normal and colour of a corner.
    fn corner(&mut self, index: usize) -> Option<Vertex> {
        let from = self.from;
        let color = color(from, index)?;
        if !self.is_rigged {
            let normal = if from.skinned_normal.exists {
                vector_at(&from.skinned_normal, index)?
            } else {
                [0.0; 3]
            };
            return Some(Vertex {
                position: vector_at(&from.skinned_position, index)?,
                normal,
                color,
                ..Vertex::default()
            });
        }
        let vertex = *from.vertex_indices.as_ref().get(index)?;
        self.sources.push(vertex);
        let position = vector_at(&from.vertex_position, index)?;
        let normal = if from.vertex_normal.exists {
            vector_at(&from.vertex_normal, index)?
        } else {
            [0.0; 3]
        };
        Some(Vertex {
            position,
            normal,
            color,
            ..Vertex::default()
        })
    }
}

/// The named coordinate set, or the first one.
fn set<'a>(from: &'a From, source: Option<&'a UvSource>) -> Option<Set<'a>> {
    let source = source?;
    let sets = from.uv_sets.as_ref();
    let set = sets
        .iter()
        .find(|set| set.name == source.set.as_str())
        .or(sets.first())?;
    Some(Set {
        values: &set.vertex_uv,
        source,
    })
}

/// Texture coordinates of a mesh with a texture's transform.
#[derive(Clone, Copy)]
struct Set<'a> {
    values: &'a VertexVec2,
    source: &'a UvSource,
}

impl Set<'_> {
    /// FBX has its origin at the lower left of the picture, scenes at the upper left.
    fn at(&self, corner: usize) -> Option<[f32; 2]> {
        let index = *self.values.indices.as_ref().get(corner)?;
        let uv = self.values.values.as_ref().get(index as usize)?;
        let placed = self
            .source
            .transform
            .transform_point2(DVec2::new(uv.x, uv.y));
        Some([placed.x as f32, (1.0 - placed.y) as f32])
    }
}

fn vector_at(list: &ufbx::VertexVec3, index: usize) -> Option<[f32; 3]> {
    let value = list
        .values
        .as_ref()
        .get(*list.indices.as_ref().get(index)? as usize)?;
    Some([value.x as f32, value.y as f32, value.z as f32])
}

/// The colour of a corner; white by default.
fn color(from: &From, index: usize) -> Option<[f32; 4]> {
    let colors = &from.vertex_color;
    Some(if colors.exists {
        let value = colors
            .values
            .as_ref()
            .get(*colors.indices.as_ref().get(index)? as usize)?;
        // Most programs write sRGB.
        let [r, g, b] =
            [value.x, value.y, value.z].map(|c| srgb_to_linear((c as f32).clamp(0.0, 1.0)));
        [r, g, b, value.w as f32]
    } else {
        [1.0; 4]
    })
}
