//! Exact voxelization on the CPU in f64, the reference for voxelizers.
//!
//! A cell is *exact* if a triangle overlaps it, by the separating axis test (Akenine-Moeller 2001).
//! Cells within 1e-5 of their edge of the decision are *borderline* and count neither for nor
//! against a voxelizer.
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
pub(crate) use compare::Comparison;
pub use compare::{Score, compare};
pub use cubes::cubes;
pub use exact::{Cell, exact};
pub use fill::{Neighbours, flood};
pub use grid::Grid;
pub use overlap::{Axes, Overlap};
pub(crate) use read::{Voxel, makes_voxels};
pub use read::{grid, mistake, modes, read, wanted};
pub(crate) use shape::SHAPES;
pub use surface::Surfaces;
pub use triangle::{Triangle, triangles_of};
