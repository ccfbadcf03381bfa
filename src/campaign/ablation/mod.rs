//! Ablation: effect of each parameter of a method, with one parameter after the other at its plain
//! value (`docs/sweeps.md`).

mod plain;
mod row;
mod text;

pub use plain::{Change, changes};
pub(crate) use row::rows;
pub(crate) use text::{csv, markdown};
