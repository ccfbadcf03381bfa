//! Saving experiments, captures, and the gallery of captures.

use super::Workbench;
use egui::Ui;

/// State of this tab.
#[derive(Default)]
pub struct Gallery {}

impl Workbench {
    /// The tab.
    pub(super) fn gallery_tab(&mut self, ui: &mut Ui) {
        ui.weak("nothing here yet");
    }
}
