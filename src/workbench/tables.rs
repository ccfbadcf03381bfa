//! Buffers of the graph as tables.

use super::Workbench;
use egui::Ui;

/// State of this tab.
#[derive(Default)]
pub struct Tables {}

impl Tables {
    /// Takes in the content of a table's buffer.
    pub fn note(&mut self, _table: usize, _bytes: Vec<u8>) {}
}

impl Workbench {
    /// The tab.
    pub(super) fn tables_tab(&mut self, ui: &mut Ui) {
        ui.weak("nothing here yet");
    }
}
