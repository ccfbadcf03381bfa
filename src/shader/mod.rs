//! GLSL to SPIR-V at run time, with includes, a cache on disk, and reflection by name.

mod access;
mod compile;
pub mod layout;
mod macros;
mod reflect;
mod sizes;
mod strip;

pub use compile::{Compiled, Generated, ShaderCompiler, Source, find, module_include, read_module};
pub(crate) use compile::{MAX_BYTES, is_inside};
pub use layout::Layout;
pub use reflect::{Binding, Interface, Resource, Shape};
pub use sizes::{MAX_BYTES as MAX_VARIABLE_BYTES, TooLarge, check_sizes};
pub use strip::{strip_images, strip_outputs};
