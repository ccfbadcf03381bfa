//! GPU and CPU time per pass, memory per resource, and their export.

use super::Workbench;
use super::report::PictureReport;
use egui::Ui;

/// State of this tab.
#[derive(Default)]
pub struct Times {}

impl Times {
    /// Takes in the times of a frame.
    pub fn note(&mut self, _picture: &PictureReport) {}
}

impl Workbench {
    /// The tab.
    pub(super) fn times_tab(&mut self, ui: &mut Ui) {
        ui.weak("nothing here yet");
    }
}
