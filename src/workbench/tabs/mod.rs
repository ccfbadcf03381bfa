//! The tabs: a file or folder each, with its state and its [`Tab`].

pub(crate) mod bookmarks;
pub(crate) mod chart;
pub(crate) mod gallery;
pub(crate) mod inspector;
pub(crate) mod nodes;
pub(crate) mod paths;
pub(crate) mod runs;
mod sequence;
mod shader_files;
mod shader_values;
pub(crate) mod surroundings;
pub(crate) mod tables;
pub(crate) mod times;

use super::Workbench;
use super::engine::report::Report;
use egui::{TextureId, Ui};

/// A tab. The type that implements it is the tab's state, a field of [`Tabs`].
pub(crate) trait Tab {
    const TITLE: &'static str;
    /// An icon of the font of icons.
    const ICON: &'static str;

    /// Shows the tab. `textures` are the hosts' pictures.
    fn show(workbench: &mut Workbench, ui: &mut Ui, textures: &[TextureId]);

    /// Takes in a report of the engine, before the workbench does.
    fn report(_workbench: &mut Workbench, _report: &Report) {}

    /// Takes in the messages of the tab's own threads.
    fn poll(_workbench: &mut Workbench) {}

    /// Ends a frame of the window, after the request was sent.
    fn end_frame(_workbench: &mut Workbench, _ui: &Ui) {}

    /// Whether a result is about to come.
    fn awaits(_workbench: &Workbench) -> bool {
        false
    }
}

/// The functions of a tab.
#[derive(Clone, Copy)]
pub(crate) struct Entry {
    pub(crate) title: &'static str,
    pub(crate) icon: &'static str,
    pub(crate) show: fn(&mut Workbench, &mut Ui, &[TextureId]),
    pub(crate) report: fn(&mut Workbench, &Report),
    pub(crate) poll: fn(&mut Workbench),
    pub(crate) end_frame: fn(&mut Workbench, &Ui),
    pub(crate) awaits: fn(&Workbench) -> bool,
}

impl Entry {
    const fn of<T: Tab>() -> Entry {
        Entry {
            title: T::TITLE,
            icon: T::ICON,
            show: T::show,
            report: T::report,
            poll: T::poll,
            end_frame: T::end_frame,
            awaits: T::awaits,
        }
    }
}

/// The tabs, in the order of the digits that open them.
pub(crate) const TABS: [Entry; 9] = [
    Entry::of::<surroundings::Surroundings>(),
    Entry::of::<times::Times>(),
    Entry::of::<chart::Chart>(),
    Entry::of::<nodes::Nodes>(),
    Entry::of::<inspector::Inspector>(),
    Entry::of::<tables::Tables>(),
    Entry::of::<paths::Paths>(),
    Entry::of::<gallery::Gallery>(),
    Entry::of::<runs::Runs>(),
];

/// The state of each tab.
#[derive(Default)]
pub(crate) struct Tabs {
    pub(crate) surroundings: surroundings::Surroundings,
    pub(crate) times: times::Times,
    pub(crate) chart: chart::Chart,
    pub(crate) runs: runs::Runs,
    pub(crate) nodes: nodes::Nodes,
    pub(crate) inspector: inspector::Inspector,
    pub(crate) tables: tables::Tables,
    pub(crate) paths: paths::Paths,
    pub(crate) gallery: gallery::Gallery,
}
