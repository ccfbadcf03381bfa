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
    /// The middle of the window while the tab is open.
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

/// The open tab, and the state of each.
pub(crate) struct Tabs {
    pub(crate) open: Tab,
    pub(crate) times: times::Times,
    pub(crate) chart: chart::Chart,
    pub(crate) nodes: nodes::Nodes,
    pub(crate) inspector: inspector::Inspector,
    pub(crate) tables: tables::Tables,
    pub(crate) paths: paths::Paths,
    pub(crate) bookmarks: bookmarks::Bookmarks,
    pub(crate) gallery: gallery::Gallery,
}

impl Default for Tabs {
    fn default() -> Tabs {
        Tabs {
            open: surroundings::TAB,
            times: Default::default(),
            chart: Default::default(),
            nodes: Default::default(),
            inspector: Default::default(),
            tables: Default::default(),
            paths: Default::default(),
            bookmarks: Default::default(),
            gallery: Default::default(),
        }
    }
}
