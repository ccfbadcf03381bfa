//! Exact voxelization on the processor, in f64: what a voxelizer's cells are compared with.
//!
//! A cell is *exact* when a triangle overlaps it. Whether it does is decided by separating axes (Akenine-Moeller 2001);
//! cells within 1e-5 of their edge of the decision are *borderline* and count neither for nor against a voxelizer.
mod clip;
mod compare;
mod cubes;
mod exact;
mod fill;
mod grid;
mod overlap;
mod read;
mod shape;
mod surface;
mod triangle;

pub use clip::{Corner, clip};
pub use compare::{Comparison, Score, ShapeScore, compare};
pub use cubes::cubes;
pub use exact::{Cell, exact};
pub use fill::{Neighbours, flood};
pub use grid::Grid;
pub use overlap::{Axes, Overlap};
pub use read::{Voxel, grid, makes_voxels, mistake, modes, read, wanted};
pub use shape::{SHAPES, shape_of};
pub use surface::Surfaces;
pub use triangle::{Triangle, triangles_of};
