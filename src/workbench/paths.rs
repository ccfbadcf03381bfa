//! Camera paths and image sequences.

use super::Workbench;
use egui::Ui;

/// State of this tab.
#[derive(Default)]
pub struct Paths {}

impl Workbench {
    /// The tab.
    pub(super) fn paths_tab(&mut self, ui: &mut Ui) {
        ui.weak("nothing here yet");
    }
}
