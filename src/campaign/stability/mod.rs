//! Stability: how methods behave when camera, actors or light move, frame by frame against the
//! reference, and how they fail in pictures that do not move (docs/stability.md).

mod cameras;
mod case;
mod chart;
mod chart_spec;
mod cost;
mod failures;
mod file;
mod motion;
mod page;
mod param_track;
mod pictures;
mod plan;
mod plot;
mod record;
mod run;
mod score;
mod sequence;
mod series;
mod table;

pub(crate) use failures::{failures, sheet, table as failure_table};
pub use file::Suite;
pub(crate) use file::check;
pub use plan::Options;
pub(crate) use record::Report;
pub use run::run;
pub use score::{change, flicker, settling, step};
