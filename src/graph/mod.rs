//! The pass graph: parameters, textures, buffers and passes, read from RON. It knows no voxels.
pub mod expr;
pub mod externals;
pub mod file;
pub mod link;
mod live;
pub mod load;
mod needs;
pub mod param;
mod pipelines;
pub mod plan;
pub mod report;
pub mod run;
pub mod runs;
pub mod source;
pub mod successor;
pub mod table;
mod unused;
pub mod usage;
