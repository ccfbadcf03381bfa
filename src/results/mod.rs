//! What a frame leaves on disk: pictures, measurements, and folders with all that made them.

pub mod capture;
pub mod picture;
pub(crate) mod stats;
pub(crate) mod table;
pub(crate) mod timers;
