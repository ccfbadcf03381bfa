//! Parameters: declared once in a graph, read by shaders, `--set`, experiments, panels and sweeps.

mod decl;
mod one;
mod params;
mod value;

pub use decl::Decl;
pub use one::Param;
pub use params::{OFF, Params};
pub use value::{Kind, Value};
