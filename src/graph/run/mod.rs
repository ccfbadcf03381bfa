//! A plan on a device.

mod bindings;
mod parts;
mod pipelines;
mod program;
mod readback;
mod record;
mod resources;
mod scene;
mod sleep;
mod swap;
mod transfer;

pub use parts::{Change, Parts};
pub use program::{FrameTimes, Program};
pub use scene::{Geometry, SceneResources};
pub use sleep::Redo;
pub use transfer::Update;
