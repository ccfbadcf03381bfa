//! The voxels of a session, as its graph declares them.

use super::grid::Grid;
use crate::graph::Graph;
use crate::graph::file::VoxelsDecl;
use crate::lab::{LabError, Session, Texels};
use glam::Vec3;

/// A cell that a voxelizer filled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Voxel {
    /// Its number in the grid.
    pub number: u32,
    /// Linear base colour.
    pub color: Vec3,
    /// 0 to 1.
    pub opacity: f32,
    /// Unit length, or 0 where there is none.
    pub normal: Vec3,
}

fn declared(graph: &Graph) -> Result<&VoxelsDecl, LabError> {
    graph.voxels.as_ref().map(|v| &v.value).ok_or_else(|| {
        LabError::Request(format!(
            "graph '{}' declares no `voxels` (docs/graph.md), so there is nothing to check",
            graph.name
        ))
    })
}

/// What a session must keep for [`read`].
///
/// # Errors
/// The graph declares no voxels.
pub fn wanted(graph: &Graph) -> Result<Vec<String>, LabError> {
    let v = declared(graph)?;
    Ok([&v.occupied, &v.color, &v.normal, &v.borders].map(|n| n.value.clone()).to_vec())
}

/// The grid and the voxels of the last frame, in order of numbers.
///
/// # Errors
/// The graph declares no voxels; cells that are no boxes; the device was lost.
pub fn read(session: &mut Session) -> Result<(Grid, Vec<Voxel>), LabError> {
    let v = declared(&session.graph)?.clone();
    let occupied = session.texels(&v.occupied.value, 0, 0)?;
    let (grid, first) = grid_in(session, &v, occupied.extent)?;
    let bytes = occupied.format.bytes as usize;
    let [x, y, z] = grid.size().map(|n| n as usize);
    let before = first as usize * x * y;
    let texels = occupied.bytes.chunks_exact(bytes).skip(before).take(x * y * z);
    let numbers: Vec<u32> =
        texels.zip(0u32..).filter(|(texel, _)| texel.iter().any(|b| *b != 0)).map(|(_, i)| i).collect();
    drop(occupied);
    let color = texels_at(session, &v.color.value, before, &numbers)?;
    let normal = texels_at(session, &v.normal.value, before, &numbers)?;
    let voxels = numbers.iter().zip(color.iter().zip(&normal)).map(|(number, (color, normal))| Voxel {
        number: *number,
        color: Vec3::new(color[0], color[1], color[2]),
        opacity: color[3],
        normal: (Vec3::new(normal[0], normal[1], normal[2]) * 2.0 - 1.0).normalize_or_zero(),
    });
    let voxels = voxels.collect();
    Ok((grid, voxels))
}

/// Where the cells of the last frame lie.
///
/// # Errors
/// As [`read`].
pub fn grid(session: &mut Session) -> Result<Grid, LabError> {
    let v = declared(&session.graph)?.clone();
    let index = session.graph.texture(&v.occupied.value);
    let extent = index.map_or([0; 3], |i| session.program.plan.textures[i].extent);
    Ok(grid_in(session, &v, extent)?.0)
}

/// The grid, and the z of its first cell in the textures.
fn grid_in(session: &mut Session, v: &VoxelsDecl, cells: [u32; 3]) -> Result<(Grid, u32), LabError> {
    let borders = session.buffer(&v.borders.value)?;
    grid_of(&borders, cells).map_err(LabError::Request)
}

/// Texels by number, counted from texel `before`. Only those are turned into floats: a whole volume of them can take gigabytes.
fn texels_at(session: &mut Session, name: &str, before: usize, numbers: &[u32]) -> Result<Vec<[f32; 4]>, LabError> {
    let all = session.texels(name, 0, 0)?;
    let size = all.format.bytes as usize;
    let place = |n: &u32| (before + *n as usize) * size;
    let bytes = numbers.iter().filter_map(|n| all.bytes.get(place(n)..place(n) + size)).flatten();
    let some = Texels { extent: [numbers.len() as u32, 1, 1], format: all.format, bytes: bytes.copied().collect() };
    Ok(some.floats())
}

/// The grid that a buffer of borders describes; see [`VoxelsDecl::borders`].
fn grid_of(bytes: &[u8], texture: [u32; 3]) -> Result<(Grid, u32), String> {
    let words: Vec<u32> = bytes.as_chunks::<4>().0.iter().map(|w| u32::from_ne_bytes(*w)).collect();
    let ([boxes, first, x, y, z], mut rest) =
        words.split_first_chunk::<5>().ok_or("the buffer of the cells' borders is too short")?;
    if *boxes == 0 {
        return Err(
            "the cells are curved, no boxes: the oracle knows boxes only. Choose another warp, or another cascade \
                    of the volume"
                .into(),
        );
    }
    if [*x, *y] != [texture[0], texture[1]] || first.checked_add(*z).is_none_or(|end| end > texture[2]) {
        return Err(format!(
            "the cells' borders are of {x} x {y} x {z} cells from z = {first} on, the textures have {texture:?}"
        ));
    }
    let mut borders = [const { Vec::new() }; 3];
    for (list, cells) in borders.iter_mut().zip([x, y, z]) {
        let count = *cells as usize + 1;
        let (these, others) = rest.split_at_checked(count).ok_or("the buffer of the cells' borders is too short")?;
        list.extend(these.iter().map(|w| f64::from(f32::from_bits(*w))));
        rest = others;
    }
    Ok((Grid::new(borders)?, *first))
}
