//! Hosts of the interface: a window, and screenshots without one.

mod frame;
pub mod screenshot;
pub mod texts;
pub mod window;
