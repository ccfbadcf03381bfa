//! The picture in the middle of the window: display, camera, comparison and overlays.

pub mod compare;
pub(super) mod difference;
pub(crate) mod gizmo;
pub(crate) mod motion;
mod overlay;
pub(crate) mod view;
pub(crate) mod zoom;
