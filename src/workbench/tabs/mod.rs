//! The tabs of the right panel: a file or folder each, which says title and content in its `TAB`.

pub(crate) mod bookmarks;
pub(crate) mod chart;
pub(crate) mod gallery;
pub(crate) mod inspector;
pub(crate) mod nodes;
pub(crate) mod paths;
mod sequence;
pub(crate) mod surroundings;
pub(crate) mod tables;
pub(crate) mod times;

use super::Workbench;
use egui::{TextureId, Ui};

/// A part of the interface; it may show the hosts' pictures.
type Show = fn(&mut Workbench, &mut Ui, &[TextureId]);

/// A tab of the right panel.
#[derive(Clone, Copy)]
pub(crate) struct Tab {
    pub(crate) title: &'static str,
    pub(crate) show: Show,
    /// What stands in the middle of the window while the tab is open.
    pub(crate) middle: Show,
}

impl Tab {
    const fn new(title: &'static str, show: Show) -> Tab {
        Tab {
            title,
            show,
            middle: |workbench, ui, textures| workbench.picture(ui, textures),
        }
    }

    pub(crate) fn is(self, other: Tab) -> bool {
        self.title == other.title
    }
}

/// The tabs, in order.
pub(crate) const TABS: [Tab; 8] = [
    surroundings::TAB,
    times::TAB,
    chart::TAB,
    nodes::TAB,
    inspector::TAB,
    tables::TAB,
    paths::TAB,
    gallery::TAB,
];
