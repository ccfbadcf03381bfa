//! What each parameter of a method is worth: the experiment with one parameter after the other at its plain value
//! (`docs/sweeps.md`).

mod plain;
mod row;
mod text;

pub use plain::{Change, changes};
pub use row::{Delta, ErrorChange, Row, Verdict, rows};
pub use text::{csv, markdown};
