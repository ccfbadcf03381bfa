//! The pass graph: parameters, textures, buffers and passes, read from RON. Of tools it knows their names and what
//! graphs tell them; of the method nothing.

mod definition;
pub mod effect;
mod evaluated;
pub mod expr;
pub mod externals;
pub mod file;
pub(crate) mod host;
pub mod link;
pub mod load;
pub mod outline;
pub mod param;
pub mod plan;
pub mod report;
pub mod run;
mod signature;
pub mod table;

pub use definition::{Alias, AliasCase, Graph, LightPart, Named, Res};
pub use evaluated::Evaluated;
pub use signature::signed;
