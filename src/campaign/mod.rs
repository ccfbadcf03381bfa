//! Many experiments: points are measured one after another, each is kept in a record, and tables, charts and pages are
//! made of them.

pub mod ablation;
pub mod bench;
pub mod charts;
pub mod fit;
pub mod page;
pub mod points;
pub mod record;
pub mod report;
pub mod runner;
pub mod settings;
pub mod source;
pub mod stability;
pub mod sweep;
