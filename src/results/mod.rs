//! Results on disk: pictures, measurements, and reproducible captures.

pub mod capture;
pub mod picture;
pub(crate) mod stats;
pub(crate) mod table;
pub(crate) mod timers;
