//! A plan on a device.

mod bindings;
mod incremental;
mod parts;
mod pipelines;
mod program;
mod readback;
mod record;
mod resources;
mod scene;
mod statistics;
mod swap;
mod timeline;
mod transfer;

pub use incremental::Execution;
pub use parts::{Change, Parts};
pub use program::{FrameTimes, Program};
pub use scene::{Geometry, SceneResources};
pub use statistics::{PassExecutables, StatisticsRequest};
pub use timeline::Timeline;
pub use transfer::Update;
