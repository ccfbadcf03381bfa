//! What stands in a graph file, field by field.

mod pass;
mod path;
mod resource;
mod section;
mod table;
mod tools;
mod whole;

pub use pass::*;
pub use path::{Command, Path};
pub use resource::*;
pub use section::*;
pub use table::{CellKind, ColumnDecl, RowCount, TableDecl};
pub use tools::{CompareDecl, ViewDecl, VoxelsDecl};
pub use whole::GraphFile;
