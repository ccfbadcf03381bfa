//! Runtime compilation of GLSL to SPIR-V with includes, a disk cache, and reflection by name.

mod access;
mod compile;
mod debug;
pub(crate) mod layout;
mod macros;
mod messages;
mod names;
mod reflect;
mod sizes;
mod spirv;
mod strip;

pub(crate) use compile::{Compiled, Generated, find, module_include};
pub(crate) use compile::{MAX_BYTES, is_inside};
pub use compile::{ShaderCompiler, Source, read_module};
pub(crate) use debug::{DebugName, debug_names};
pub(crate) use layout::Layout;
pub(crate) use reflect::Binding;
pub use reflect::{Resource, Shape};
pub(crate) use sizes::MAX_BYTES as MAX_VARIABLE_BYTES;
pub use sizes::check_sizes;
pub(crate) use strip::strip_images;
pub use strip::strip_outputs;
