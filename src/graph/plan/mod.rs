//! Plans a frame from a graph and its shaders.

mod compile;
mod converge;
mod data;
mod layout;
mod live;
mod needs;
mod numbers;
mod places;
mod schedule;
mod settle;
mod sizes;
mod steps;
mod transient;
mod uses;

pub use compile::plan;
pub use data::{
    AttachmentPlan, BindingPlan, BufferPlan, Convergence, Plan, Settling, Step, TexturePlan,
    Transient, Work,
};
pub use places::Places;
pub use schedule::{Barrier, Schedule, schedule};
pub use transient::pack;
pub use uses::{Use, UseKind};
