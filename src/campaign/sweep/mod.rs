//! Sweeps: an experiment with everything that is varied about it, measured point by point into a
//! folder that can be continued, split over machines and merged (docs/sweeps.md).

mod axis;
mod file;
mod list;
mod points;
mod record;
mod run;
mod table;

pub(crate) use super::points::Subject;
pub use file::DEFAULT_FRAMES;
pub(crate) use list::{check, list};
pub use points::Sweep;
pub(crate) use points::{NOTHING, SCENE, SET};
pub use record::collect;
pub(crate) use record::{Collected, Manifest, ManifestPoint, PointRecord, points_in};
pub(crate) use run::{Measuring, write_table};
pub use run::{Options, Shard, run};
pub(crate) use table::{csv, parts_of};
