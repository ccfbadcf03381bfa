//! Reads the voxels of a session, as its graph declares them.

use super::grid::Grid;
use crate::diagnostics::Diagnostic;
use crate::graph::Graph;
use crate::graph::file::ViewDecl;
use crate::lab::{LabError, Session, Texels};
use glam::Vec3;

/// A filled cell of a voxelizer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Voxel {
    /// Index in the grid.
    pub number: u32,
    /// Linear base colour.
    pub color: Vec3,
    /// Opacity, 0 to 1.
    pub opacity: f32,
    /// Unit normal, or 0 without one.
    pub normal: Vec3,
}

/// Name of the graph's tool entry that declares its voxels; [`resources`] lists its fields.
const TOOL: &str = "voxels";

/// Names of the resources that hold a graph's voxels.
#[derive(Clone, Debug)]
struct Resources {
    /// 3D texture with a nonzero first channel in occupied cells.
    occupied: String,
    /// 3D texture of linear base colour; alpha is opacity.
    color: String,
    /// 3D texture of the unit normal * 0.5 + 0.5.
    normal: String,
    /// Buffer of the cell borders. First a 32-bit word that is 1 if cells are boxes, else 0; the z
    /// of the first cell in the textures; and the number of cells along x, y and z. Then, as
    /// floats, the world coordinates of the borders along x, y and z (m), one more than cells each.
    borders: String,
}

/// The voxel resources of a graph; `None` if it makes no voxels.
fn resources(graph: &Graph) -> Result<Option<Resources>, Diagnostic> {
    let Some(tool) = graph.tool(TOOL) else {
        return Ok(None);
    };
    let named = |role: &str| {
        let missing = || {
            graph.sources.error(
                tool.at,
                format!("'{TOOL}' names no resource '{role}' (docs/graph.md)"),
            )
        };
        tool.value.resource(role).ok_or_else(missing)
    };
    let volume = |role: &str| {
        let name = named(role)?;
        let volume = graph
            .texture(&name.value)
            .is_some_and(|t| graph.textures[t].1.value.is_volume());
        let wrong = || {
            graph.sources.error(
                name.at,
                format!("'{}' is no 3D texture, as voxels are", name.value),
            )
        };
        volume.then(|| name.value.clone()).ok_or_else(wrong)
    };
    let borders = named("borders")?;
    if graph.buffer(&borders.value).is_none() {
        let message = format!(
            "'{}' is no buffer, as the cells' borders are",
            borders.value
        );
        return Err(graph.sources.error(borders.at, message));
    }
    let borders = borders.value.clone();
    Ok(Some(Resources {
        occupied: volume("occupied")?,
        color: volume("color")?,
        normal: volume("normal")?,
        borders,
    }))
}

fn declared(graph: &Graph) -> Result<Resources, LabError> {
    resources(graph)
        .map_err(|wrong| LabError::Input(vec![wrong]))?
        .ok_or_else(|| {
            LabError::Request(format!(
                "graph '{}' makes no voxels (docs/graph.md), so there is nothing to check",
                graph.name
            ))
        })
}

/// Whether a graph makes voxels that can be compared.
pub fn makes_voxels(graph: &Graph) -> bool {
    graph.tool(TOOL).is_some()
}

/// The error in a graph's declaration of its voxels.
pub fn mistake(graph: &Graph) -> Option<Diagnostic> {
    resources(graph).err()
}

/// Voxelization settings that a graph suggests for comparison.
pub fn modes(graph: &Graph) -> impl Iterator<Item = &ViewDecl> {
    graph
        .tool(TOOL)
        .into_iter()
        .flat_map(|tool| &tool.value.settings.0)
        .map(|mode| &mode.value)
}

/// Resources that a session must keep for [`read`].
///
/// # Errors
/// The graph makes no voxels.
pub fn wanted(graph: &Graph) -> Result<Vec<String>, LabError> {
    let v = declared(graph)?;
    Ok(vec![v.occupied, v.color, v.normal, v.borders])
}

/// The grid and the voxels of the last frame, sorted by index.
///
/// # Errors
/// The graph makes no voxels; the cells are not boxes; the device was lost.
pub fn read(session: &mut Session) -> Result<(Grid, Vec<Voxel>), LabError> {
    let v = declared(&session.graph)?;
    let occupied = session.texels(&v.occupied, 0, 0)?;
    let (grid, first) = grid_in(session, &v, occupied.extent)?;
    let bytes = occupied.format.bytes as usize;
    let [x, y, z] = grid.size().map(|n| n as usize);
    let before = first as usize * x * y;
    let texels = occupied
        .bytes
        .chunks_exact(bytes)
        .skip(before)
        .take(x * y * z);
    let numbers: Vec<u32> = texels
        .zip(0u32..)
        .filter(|(texel, _)| texel.iter().any(|b| *b != 0))
        .map(|(_, i)| i)
        .collect();
    drop(occupied);
    let color = texels_at(session, &v.color, before, &numbers)?;
    let normal = texels_at(session, &v.normal, before, &numbers)?;
    let voxels = numbers
        .iter()
        .zip(color.iter().zip(&normal))
        .map(|(number, (color, normal))| Voxel {
            number: *number,
            color: Vec3::new(color[0], color[1], color[2]),
            opacity: color[3],
            normal: (Vec3::new(normal[0], normal[1], normal[2]) * 2.0 - 1.0).normalize_or_zero(),
        });
    let voxels = voxels.collect();
    Ok((grid, voxels))
}

/// The grid of the last frame.
pub fn grid(session: &mut Session) -> Result<Grid, LabError> {
    let v = declared(&session.graph)?;
    let index = session.graph.texture(&v.occupied);
    let extent = index.map_or([0; 3], |i| session.program.plan.textures[i].extent);
    Ok(grid_in(session, &v, extent)?.0)
}

/// The grid, and the z of its first cell in the textures.
fn grid_in(session: &mut Session, v: &Resources, cells: [u32; 3]) -> Result<(Grid, u32), LabError> {
    let borders = session.buffer(&v.borders)?;
    grid_of(&borders, cells).map_err(LabError::Request)
}

/// Texels by index from `before` on. Only these are converted to floats, because a whole volume can
/// take gigabytes.
fn texels_at(
    session: &mut Session,
    name: &str,
    before: usize,
    numbers: &[u32],
) -> Result<Vec<[f32; 4]>, LabError> {
    let all = session.texels(name, 0, 0)?;
    let size = all.format.bytes as usize;
    let place = |n: &u32| (before + *n as usize) * size;
    let bytes = numbers
        .iter()
        .filter_map(|n| all.bytes.get(place(n)..place(n) + size))
        .flatten();
    let some = Texels {
        extent: [numbers.len() as u32, 1, 1],
        format: all.format,
        bytes: bytes.copied().collect(),
    };
    Ok(some.floats())
}

/// The grid that a buffer of borders describes; see [`Resources::borders`].
fn grid_of(bytes: &[u8], texture: [u32; 3]) -> Result<(Grid, u32), String> {
    let words: Vec<u32> = bytes
        .as_chunks::<4>()
        .0
        .iter()
        .map(|w| u32::from_ne_bytes(*w))
        .collect();
    let ([boxes, first, x, y, z], mut rest) = words
        .split_first_chunk::<5>()
        .ok_or("the buffer of the cells' borders is too short")?;
    if *boxes == 0 {
        return Err(
            "the cells are curved, no boxes: the oracle knows boxes only. Choose another warp, or another cascade \
                    of the volume"
                .into(),
        );
    }
    if [*x, *y] != [texture[0], texture[1]]
        || first.checked_add(*z).is_none_or(|end| end > texture[2])
    {
        return Err(format!(
            "the cells' borders are of {x} x {y} x {z} cells from z = {first} on, the textures have {texture:?}"
        ));
    }
    let mut borders = [const { Vec::new() }; 3];
    for (list, cells) in borders.iter_mut().zip([x, y, z]) {
        let count = *cells as usize + 1;
        let (these, others) = rest
            .split_at_checked(count)
            .ok_or("the buffer of the cells' borders is too short")?;
        list.extend(these.iter().map(|w| f64::from(f32::from_bits(*w))));
        rest = others;
    }
    Ok((Grid::new(borders)?, *first))
}
