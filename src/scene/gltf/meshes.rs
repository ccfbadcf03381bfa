//! Meshes: each primitive is read and repaired on its own, then becomes a submesh.

use ::gltf::accessor::Dimensions;
use ::gltf::mesh::{Mode, Primitive};
use ::gltf::{Document, Semantic};
use glam::Vec2;
use rayon::prelude::*;

use super::accessors;
use super::buffers::Buffers;
use super::placing::{UvSource, UvSources};
use super::skins;
use crate::scene::mesh::{Dropped, RawMesh, Rigged, flat, flatten, prepare_rigged, unweld};
use crate::scene::motion::{Rig, Rigs};
use crate::scene::progress::Progress;
use crate::scene::warnings::Warnings;
use crate::scene::{Material, Mesh, Submesh, Vertex};

/// Vertices and indices that any file may have.
pub(super) const MANY: usize = 1 << 24;

/// The meshes of the file in order, and the rigs of those that deform.
pub(super) fn read(
    document: &Document,
    buffers: &Buffers,
    materials: &[Material],
    uv_sources: &[UvSources],
    warnings: &mut Warnings,
    progress: Progress,
) -> Result<(Vec<Mesh>, Rigs, Dropped), String> {
    let (mut primitive_rigs, mut owners) = (Vec::new(), Vec::new());
    let (mut primitives, mut meshes) = (Vec::new(), Vec::new());
    // Primitives may share vertices, so a small file could otherwise fill the memory.
    let mut room = MANY + buffers.len();
    for mesh in document.meshes() {
        let own = || format!("mesh {}", mesh.index());
        let name = mesh.name().map_or_else(own, str::to_owned);
        for primitive in mesh.primitives() {
            if progress.stopped() {
                return Err(String::new());
            }
            let default = document.materials().len();
            let material = primitive.material().index().unwrap_or(default);
            if materials[material].is_left_out() || !is_surface(&primitive, &name, warnings) {
                continue;
            }
            let read = read_primitive(&primitive, buffers, &name, material, &uv_sources[material]);
            let mut raw = read.map_err(|problem| format!("mesh '{name}': {problem}"))?;
            room = room.checked_sub(raw.mesh.vertices.len() + raw.mesh.indices.len()).ok_or_else(|| {
                format!("mesh '{name}': with it there are many more vertices than the file holds bytes")
            })?;
            let rig = skins::read(&primitive, buffers, raw.mesh.vertices.len(), &mut room);
            let rig = rig.map_err(|problem| format!("mesh '{name}': {problem}"))?;
            if rig.is_some() {
                raw.sources = (0..raw.mesh.vertices.len() as u32).collect();
            }
            let flat = !raw.has_normals;
            primitive_rigs.push((rig, flat));
            primitives.push(raw);
            owners.push(mesh.index());
            if primitive.get(&Semantic::Colors(1)).is_some() {
                let what = "COLOR_1 and further colours of vertices are left out";
                warnings.add(what, &name);
            }
        }
        meshes.push(Mesh {
            name,
            ..Mesh::default()
        });
    }
    primitives
        .par_iter_mut()
        .filter(|raw| !raw.has_normals)
        .for_each(shade_flat);
    let (prepared, dropped) = prepare_rigged(primitives, materials, progress)?;
    let prepared = owners.into_iter().zip(prepared).zip(primitive_rigs);
    let rigs = join(&mut meshes, prepared)?;
    Ok((meshes, rigs, dropped))
}

fn append(mesh: &mut Mesh, primitive: Mesh) -> Result<(), String> {
    let base = u32::try_from(mesh.vertices.len())
        .map_err(|_| format!("mesh '{}' is too large", mesh.name))?;
    let first = mesh.indices.len() as u32;
    mesh.indices
        .extend(primitive.indices.iter().map(|i| i.saturating_add(base)));
    mesh.vertices.extend(primitive.vertices);
    mesh.submeshes
        .extend(primitive.submeshes.iter().map(|submesh| Submesh {
            first_index: submesh.first_index + first,
            ..*submesh
        }));
    Ok(())
}

/// glTF 2.0, 3.7.2.1: meshes without normals are flat-shaded.
fn shade_flat(raw: &mut RawMesh) {
    match raw.sources.is_empty() {
        true => flat(&mut raw.mesh),
        // Triangles that are coplanar in this pose may not be in another one.
        false => {
            unweld(raw);
            flatten(&mut raw.mesh.vertices);
        }
    }
    raw.has_normals = true;
}

/// Whether a primitive has triangles.
fn is_surface(primitive: &Primitive, name: &str, warnings: &mut Warnings) -> bool {
    let points = matches!(
        primitive.mode(),
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip
    );
    if points || primitive.get(&Semantic::Positions).is_none() {
        let what = match points {
            true => "points and lines",
            false => "primitives without positions",
        };
        warnings.add(format!("{what} are left out"), name);
        return false;
    }
    true
}

/// Adds primitives to their meshes, and returns the rigs of these.
fn join(
    meshes: &mut [Mesh],
    prepared: impl Iterator<Item = ((usize, Rigged), (Option<Rig>, bool))>,
) -> Result<Rigs, String> {
    let mut rigs = Rigs::new();
    for ((owner, (primitive, sources)), (rig, flat)) in prepared {
        let before = meshes[owner].vertices.len();
        let sources = match rig {
            Some(_) => sources,
            None => vec![0; primitive.vertices.len()],
        };
        if rig.is_some() || rigs.contains_key(&owner) {
            let flat = flat && rig.is_some();
            let all = rigs.entry(owner).or_default();
            all.append(before, rig.as_ref(), &sources, flat);
        }
        append(&mut meshes[owner], primitive)?;
    }
    Ok(rigs)
}

/// Sets an attribute of all vertices, if there is one.
fn set<T>(
    vertices: &mut [Vertex],
    values: Option<Vec<T>>,
    what: &str,
    set: impl Fn(&mut Vertex, T),
) -> Result<(), String> {
    let Some(values) = values else { return Ok(()) };
    let (found, count) = (values.len(), vertices.len());
    if found != count {
        return Err(format!("{found} {what} for {count} positions"));
    }
    vertices
        .iter_mut()
        .zip(values)
        .for_each(|(v, value)| set(v, value));
    Ok(())
}

fn read_primitive(
    primitive: &Primitive,
    buffers: &Buffers,
    name: &str,
    material: usize,
    uv_sources: &UvSources,
) -> Result<RawMesh, String> {
    let positions = primitive
        .get(&Semantic::Positions)
        .ok_or("a primitive has no positions")?;
    let positions = accessors::floats::<3>(&positions, buffers)?;
    let vertex = |position| Vertex {
        position,
        ..Vertex::default()
    };
    let mut vertices: Vec<Vertex> = positions.into_iter().map(vertex).collect();
    let normals = primitive.get(&Semantic::Normals);
    let normals = normals
        .map(|a| accessors::floats::<3>(&a, buffers))
        .transpose()?;
    let tangents = primitive.get(&Semantic::Tangents);
    let tangents = tangents
        .map(|a| accessors::floats::<4>(&a, buffers))
        .transpose()?;
    let (has_normals, has_tangents) = (normals.is_some(), tangents.is_some());
    set(&mut vertices, normals, "normals", |v, n| v.normal = n)?;
    set(&mut vertices, tangents, "tangents", |v, t| v.tangent = t)?;
    let uvs = texture_coordinates(primitive, buffers, &uv_sources.first)?;
    set(&mut vertices, uvs, "texture coordinates", |v, uv| v.uv = uv)?;
    let second = uv_sources.second.as_ref();
    let second = second.map(|source| texture_coordinates(primitive, buffers, source));
    let uvs = second.transpose()?.flatten();
    set(&mut vertices, uvs, "texture coordinates", |v, uv| {
        v.uv_second = uv
    })?;
    let colors = colors(primitive, buffers)?;
    set(&mut vertices, colors, "colours", |v, color| v.color = color)?;
    let indices = match primitive.indices() {
        Some(accessor) => accessors::indices(&accessor, buffers)?,
        None => (0..vertices.len() as u32).collect(),
    };
    let indices = triangles(primitive.mode(), indices);
    let submesh = Submesh {
        first_index: 0,
        index_count: indices.len() as u32,
        material: material as u32,
    };
    // Tangents without normals are ignored.
    Ok(RawMesh {
        mesh: Mesh {
            name: name.into(),
            vertices,
            indices,
            submeshes: vec![submesh],
        },
        sources: Vec::new(),
        has_normals,
        has_tangents: has_normals && has_tangents,
    })
}

/// Transformed texture coordinates of a set; `None` if the primitive lacks it.
fn texture_coordinates(
    primitive: &Primitive,
    buffers: &Buffers,
    source: &UvSource,
) -> Result<Option<Vec<[f32; 2]>>, String> {
    let Some(accessor) = primitive.get(&Semantic::TexCoords(source.set)) else {
        return Ok(None);
    };
    let placed = |uv| {
        source
            .transform
            .transform_point2(Vec2::from_array(uv))
            .to_array()
    };
    Ok(Some(
        accessors::floats::<2>(&accessor, buffers)?
            .into_iter()
            .map(placed)
            .collect(),
    ))
}

/// COLOR_0, linear.
fn colors(primitive: &Primitive, buffers: &Buffers) -> Result<Option<Vec<[f32; 4]>>, String> {
    let Some(accessor) = primitive.get(&Semantic::Colors(0)) else {
        return Ok(None);
    };
    Ok(Some(match accessor.dimensions() {
        Dimensions::Vec3 => accessors::floats::<3>(&accessor, buffers)?
            .into_iter()
            .map(|[r, g, b]| [r, g, b, 1.0])
            .collect(),
        _ => accessors::floats::<4>(&accessor, buffers)?,
    }))
}

/// Strips and fans as separate triangles with the same winding.
fn triangles(mode: Mode, indices: Vec<u32>) -> Vec<u32> {
    match mode {
        Mode::TriangleStrip => {
            let triangle = |(i, w): (usize, &[u32])| {
                if i % 2 == 0 {
                    [w[0], w[1], w[2]]
                } else {
                    [w[1], w[0], w[2]]
                }
            };
            indices.windows(3).enumerate().flat_map(triangle).collect()
        }
        Mode::TriangleFan => {
            let hub = indices.first().copied().unwrap_or_default();
            indices
                .get(1..)
                .unwrap_or_default()
                .windows(2)
                .flat_map(|w| [hub, w[0], w[1]])
                .collect()
        }
        _ => {
            let mut indices = indices;
            indices.truncate(indices.len() / 3 * 3);
            indices
        }
    }
}
