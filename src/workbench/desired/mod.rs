//! The desired state: editing, undo, comparison and saving.

pub mod edit;
pub(crate) mod history;
pub(crate) mod lights;
pub mod request;
pub(crate) mod save;
pub(crate) mod sides;
