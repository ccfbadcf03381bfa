//! Results on disk: pictures, measurements, and reproducible captures.

pub mod capture;
pub mod picture;
pub mod stats;
pub(crate) mod table;
pub(crate) mod timers;
