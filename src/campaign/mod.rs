//! Many experiments: records that are kept and gone on with, tables, pages and charts.

pub mod ablation;
pub mod bench;
pub mod fit;
pub mod report;
pub mod stability;
pub mod sweep;
