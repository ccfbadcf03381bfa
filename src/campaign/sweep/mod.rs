//! Sweeps: an experiment with everything that is varied about it, measured point by point into a folder that can be
//! continued, split over machines and merged (docs/sweeps.md).

mod axis;
mod file;
mod list;
mod points;
mod record;
mod references;
mod run;
mod sample;
mod settings;
mod table;

pub use list::{PointBuilder, SweepPoint, check, list};
pub use points::{Labels, MAX_POINTS, NOTHING, SCENE, SET, Sweep};
pub use record::{Collected, Manifest, ManifestPoint, Outcome, Record, Subject, collect};
pub(crate) use record::{read_json, write_file};
pub use run::{Counts, Options, Progress, Shard, run};
pub use settings::Setting;
pub(crate) use table::csv_text;
pub use table::{csv, numbers, parts_of};
