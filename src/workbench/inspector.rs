//! Looks into any texture of the graph.

use super::Workbench;
use super::wish::Look;
use crate::lab::Texels;
use egui::Ui;

/// State of this tab.
#[derive(Default)]
pub struct Inspector {}

impl Inspector {
    /// Chooses a texture.
    pub fn open(&mut self, _slot: usize, _texture: String) {}

    /// Takes in the texels that were asked for.
    pub fn note(&mut self, _look: Look, _texels: Texels) {}
}

impl Workbench {
    /// The tab.
    pub(super) fn inspector_tab(&mut self, ui: &mut Ui) {
        ui.weak("nothing here yet");
    }
}
