//! Parameters: declared once in a graph, read by shaders, `--set`, experiments, panels and sweeps.

mod decl;
mod kinds;
mod params;

pub use decl::Decl;
pub use kinds::{AUTO, Fastest, Kind, Param, Value, fastest_key};
pub use params::{OFF, Params};
