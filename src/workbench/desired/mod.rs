//! What the user wants to see: the desired state, how it is edited, undone, compared and saved.

pub mod edit;
pub(crate) mod history;
pub mod request;
pub(crate) mod save;
pub(crate) mod sides;
