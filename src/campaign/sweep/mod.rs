//! Sweeps: an experiment with everything that is varied about it, measured point by point into a folder that can be
//! continued, split over machines and merged (docs/sweeps.md).

mod axis;
mod file;
mod list;
mod points;
mod record;
mod run;
mod table;

pub use super::points::Subject;
pub use list::{check, list};
pub use points::{NOTHING, SCENE, SET, Sweep};
pub use record::{About, Collected, Manifest, ManifestPoint, PointRecord, collect, points_in};
pub use run::{Measuring, Options, Shard, run, write_table};
pub use table::{csv, parts_of};
