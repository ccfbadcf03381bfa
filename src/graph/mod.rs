//! The pass graph: parameters, textures, buffers and passes, read from RON. It knows the names and
//! settings of tools, and nothing of the method.

mod debug;
mod debug_record;
mod definition;
pub mod effect;
mod evaluated;
pub mod expr;
pub mod file;
pub mod interface;
pub mod link;
pub mod load;
pub mod outline;
pub mod param;
pub mod plan;
pub mod report;
pub mod run;
mod signature;
pub mod table;

pub use debug_record::{Debug, DebugRow};
pub use definition::{Alias, AliasCase, Graph, LightPart, Named, Res};
pub use evaluated::Evaluated;
pub use signature::signed;
