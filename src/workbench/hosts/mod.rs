//! Hosts of the interface: a window, and screenshots without one.

pub mod screenshot;
pub mod texts;
pub mod window;
