//! Classes of triangles with different difficulties for voxelizers.

use super::grid::Grid;
use glam::DVec3;

/// The classes; a triangle belongs to the first one that fits.
pub const SHAPES: [&str; 6] = [
    "sub-voxel",
    "obtuse",
    "needle",
    "huge",
    "axis-aligned",
    "other",
];

/// The class of a triangle, an index into [`SHAPES`].
///
/// Sub-voxel: smaller along each axis than the cell at its centroid. Obtuse: an angle above 150
/// degrees. Needle: a smallest height below 1/20 of the longest edge. Huge: at least a quarter of
/// the grid's cells along an axis. Axis-aligned: the normal is an axis within 1e-3.
pub fn shape_of(t: [DVec3; 3], grid: &Grid) -> usize {
    let edge = grid.edges_at((t[0] + t[1] + t[2]) / 3.0);
    let cells = (t[0].max(t[1]).max(t[2]) - t[0].min(t[1]).min(t[2])) / edge;
    if cells.max_element() < 1.0 {
        return 0;
    }
    let cosine = |i: usize| {
        let (a, b) = (t[(i + 1) % 3] - t[i], t[(i + 2) % 3] - t[i]);
        a.dot(b) / (a.length() * b.length()).max(f64::MIN_POSITIVE)
    };
    if (0..3).any(|i| cosine(i) < -(3.0f64.sqrt() / 2.0)) {
        return 1;
    }
    let longest = (0..3)
        .map(|i| t[i].distance_squared(t[(i + 1) % 3]))
        .fold(0.0, f64::max);
    let normal = (t[1] - t[0]).cross(t[2] - t[0]);
    if normal.length() < longest / 20.0 {
        return 2;
    }
    let size = grid.size().map(f64::from);
    if (0..3).any(|axis| cells[axis] >= size[axis] / 4.0) {
        return 3;
    }
    if normal.normalize_or_zero().abs().max_element() > 1.0 - 5e-7 {
        4
    } else {
        5
    }
}
