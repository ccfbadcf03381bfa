//! Many experiments: points are measured one after another, each is kept in a record, and tables,
//! charts and pages are made of them.

pub mod ablation;
pub mod bench;
pub(crate) mod charts;
pub mod fit;
pub(crate) mod page;
pub(crate) mod points;
pub(crate) mod record;
pub mod report;
pub mod runner;
pub mod settings;
pub(crate) mod source;
pub mod stability;
pub mod sweep;
