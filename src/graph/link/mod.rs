//! Shaders of a graph: compiled, reflected, and bound by name.

mod fit;
mod layouts;
mod linked;
mod linker;
mod members;
mod place;
mod runs;
mod unused;

pub use fit::bound_shape;
pub use layouts::Layouts;
pub use linked::{Bound, BoundCase, Linked, Target};
pub use linker::link;
pub use members::table;
pub use place::has_word;
pub use runs::{Runs, generated, runs};
