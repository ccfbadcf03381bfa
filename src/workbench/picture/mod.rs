//! The picture in the middle of the window: how it is shown, moved, compared, and what is written on it.

pub mod compare;
mod difference;
pub(crate) mod motion;
mod overlay;
pub(crate) mod view;
pub(crate) mod zoom;
