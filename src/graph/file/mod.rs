//! The fields of a graph file.

mod pass;
mod resource;
mod section;
mod table;
mod whole;

pub use pass::*;
pub use resource::*;
pub use section::*;
pub use table::{ColumnDecl, TableDecl};
pub use whole::{GraphFile, Retired};
