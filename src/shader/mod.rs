//! GLSL to SPIR-V at run time, with includes, a cache on disk, and reflection by name.

mod access;
mod compile;
pub mod layout;
mod reflect;
mod strip;

pub(crate) use compile::MAX_BYTES;
pub use compile::{Compiled, Generated, ShaderCompiler, Source, find, module_include};
pub use layout::Layout;
pub use reflect::{Binding, Interface, Resource, Shape};
pub use strip::{strip_images, strip_outputs};
