//! The panes of the window, which can be resized, and dragged by their tabs to other places.

use super::Workbench;
use super::tabs::{Entry, TABS, Tab};
use super::theme;
use egui::{Color32, Rect, Response, Sense, Stroke, TextureId, Ui, Visuals, WidgetText, vec2};
use egui_tiles::{
    Behavior, Container, Linear, LinearDir, SimplificationOptions, TabState, Tabs, Tile, TileId,
    Tiles, Tree, UiResponse,
};
use serde::{Deserialize, Serialize};

/// A pane of the window.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum Pane {
    /// The parameters of A or B.
    Parameters,
    /// The rendered picture.
    Picture,
    /// The inspected texture.
    Texture,
    /// The graph as nodes.
    Nodes,
    /// A tab, by its title.
    Tab(String),
}

/// Panes of the stack of tabs in the middle.
const MIDDLE: [Pane; 3] = [Pane::Picture, Pane::Texture, Pane::Nodes];

/// Shares of the width: parameters, middle, tabs. The picture has more than 55 %.
const SHARES: [f32; 3] = [0.205, 0.56, 0.235];

/// Titles of the tabs in the upper of two stacks at the right.
const UPPER: [&str; 4] = ["Scene", "Graph", "Inspect", "Tables"];

/// Titles of the tabs in the middle: they need its width.
const WIDE: [&str; 1] = ["Runs"];

/// Where the panes are.
pub(crate) struct Dock {
    tree: Tree<Pane>,
    /// Panes that the last frame showed.
    shown: Vec<Pane>,
    /// Panes to bring to the front.
    wanted: Vec<Pane>,
    /// Place of the pane of the middle that is shown, points.
    pub middle: Rect,
}

impl Default for Dock {
    fn default() -> Dock {
        Dock::new(default_tree())
    }
}

impl Dock {
    fn new(tree: Tree<Pane>) -> Dock {
        Dock {
            tree,
            shown: Vec::new(),
            wanted: Vec::new(),
            middle: Rect::ZERO,
        }
    }

    /// Brings a pane to the front of its stack, in the next frame.
    pub fn open(&mut self, pane: Pane) {
        self.wanted.push(pane);
    }

    /// Brings a tab to the front of its stack, in the next frame.
    pub fn open_tab<T: Tab>(&mut self) {
        self.open(Pane::Tab(T::TITLE.into()));
    }

    /// Whether a pane is seen.
    pub fn shows(&self, pane: &Pane) -> bool {
        self.shown.contains(pane)
    }

    /// Whether a tab is seen.
    pub fn shows_tab<T: Tab>(&self) -> bool {
        let is_it = |pane: &Pane| matches!(pane, Pane::Tab(title) if title == T::TITLE);
        self.shown.iter().any(is_it)
    }

    /// Puts all panes back to where they were at first.
    pub fn reset(&mut self) {
        *self = Dock::default();
    }

    /// The layout, to be saved.
    pub fn tree(&self) -> &Tree<Pane> {
        &self.tree
    }

    /// Takes a saved layout, if it has the panes of this version.
    pub fn restore(&mut self, tree: Tree<Pane>) {
        let panes = |tree: &Tree<Pane>| {
            let list = tree.tiles.tiles().filter_map(|tile| match tile {
                Tile::Pane(pane) => Some(format!("{pane:?}")),
                Tile::Container(_) => None,
            });
            let mut list: Vec<String> = list.collect();
            list.sort();
            list
        };
        if panes(&tree) == panes(&self.tree) {
            *self = Dock::new(tree);
        }
    }
}

fn default_tree() -> Tree<Pane> {
    let mut tiles = Tiles::default();
    let parameters = tiles.insert_pane(Pane::Parameters);
    let wide = WIDE.map(|title| Pane::Tab(title.into()));
    let middle = MIDDLE.into_iter().chain(wide);
    let middle: Vec<TileId> = middle.map(|pane| tiles.insert_pane(pane)).collect();
    let middle = tiles.insert_tab_tile(middle);
    let mut stack = |upper: bool| {
        let of = TABS
            .iter()
            .filter(|tab| !WIDE.contains(&tab.title) && UPPER.contains(&tab.title) == upper);
        let tabs: Vec<TileId> = of
            .map(|tab| tiles.insert_pane(Pane::Tab(tab.title.into())))
            .collect();
        tiles.insert_tab_tile(tabs)
    };
    let stacks = vec![stack(true), stack(false)];
    let right = tiles.insert_vertical_tile(stacks);
    let columns = [parameters, middle, right];
    let mut row = Linear::new(LinearDir::Horizontal, columns.to_vec());
    for (column, share) in columns.into_iter().zip(SHARES) {
        row.shares.set_share(column, share);
    }
    let root = tiles.insert_container(Container::Linear(row));
    Tree::new("dock", root, tiles)
}

impl Workbench {
    /// Shows all panes.
    pub(super) fn dock(&mut self, ui: &mut Ui, textures: &[TextureId]) {
        // What no pane shows need not be read back.
        self.desired.read_back.clear();
        let mut tree = std::mem::replace(&mut self.dock.tree, Tree::empty("dock"));
        for pane in std::mem::take(&mut self.dock.wanted) {
            tree.make_active(|_, tile| matches!(tile, Tile::Pane(p) if *p == pane));
        }
        let active = tree.active_tiles();
        let panes = active.iter().filter_map(|id| tree.tiles.get_pane(id));
        self.dock.shown = panes.cloned().collect();
        let mut panes = Panes {
            workbench: self,
            textures,
        };
        tree.ui(&mut panes, ui);
        self.dock.tree = tree;
    }
}

/// Shows the content of tiles.
struct Panes<'a> {
    workbench: &'a mut Workbench,
    textures: &'a [TextureId],
}

fn entry(title: &str) -> Option<&'static Entry> {
    TABS.iter().find(|tab| tab.title == title)
}

fn name(pane: &Pane) -> &str {
    match pane {
        Pane::Parameters => "Parameters",
        Pane::Picture => "Picture",
        Pane::Texture => "Texture",
        Pane::Nodes => "Nodes",
        Pane::Tab(title) => title,
    }
}

impl Behavior<Pane> for Panes<'_> {
    fn pane_ui(&mut self, ui: &mut Ui, _: TileId, pane: &mut Pane) -> UiResponse {
        let fill = ui.visuals().panel_fill;
        ui.painter().rect_filled(ui.max_rect(), 0.0, fill);
        if MIDDLE.contains(pane) {
            self.workbench.dock.middle = ui.max_rect();
        }
        let (workbench, textures) = (&mut *self.workbench, self.textures);
        let margin = egui::Frame::new().inner_margin(egui::Margin::symmetric(8, 6));
        match pane {
            Pane::Picture => workbench.picture(ui, textures),
            Pane::Texture => workbench.inspected(ui, textures),
            Pane::Nodes => workbench.graph_view(ui),
            Pane::Parameters => drop(margin.show(ui, |ui| workbench.parameters(ui))),
            Pane::Tab(title) => {
                if let Some(tab) = entry(title) {
                    margin.show(ui, |ui| (tab.show)(workbench, ui, textures));
                }
            }
        }
        UiResponse::None
    }

    fn tab_title_for_pane(&mut self, pane: &Pane) -> WidgetText {
        name(pane).into()
    }

    fn tab_ui(
        &mut self,
        tiles: &mut Tiles<Pane>,
        ui: &mut Ui,
        id: egui::Id,
        tile: TileId,
        state: &TabState,
    ) -> Response {
        let title = tiles.get_pane(&tile).map_or("", name).to_string();
        let icon = entry(&title).map_or("", |tab| tab.icon);
        let font = egui::TextStyle::Button.resolve(ui.style());
        let color = self.tab_text_color(ui.visuals(), tiles, tile, state);
        let text = format!("{icon} {title}");
        let galley = ui
            .painter()
            .layout_no_wrap(text.trim_start().into(), font, color);
        let size = vec2(galley.size().x + 12.0, ui.available_height());
        let (_, rect) = ui.allocate_space(size);
        let response = ui.interact(rect, id, Sense::click_and_drag());
        response.widget_info(|| {
            egui::WidgetInfo::selected(egui::WidgetType::Button, true, state.active, &title)
        });
        if ui.is_rect_visible(rect) && !state.is_being_dragged {
            let fill = self.tab_bg_color(ui.visuals(), tiles, tile, state);
            ui.painter().rect_filled(rect, 0.0, fill);
            if state.active {
                let line = Stroke::new(2.0, theme::roles(ui).accent);
                ui.painter().hline(rect.x_range(), rect.top() + 1.0, line);
            }
            let at = rect.center() - galley.size() / 2.0;
            ui.painter().galley(at, galley, color);
        }
        response.on_hover_text("Drag to place it elsewhere")
    }

    fn top_bar_right_ui(
        &mut self,
        tiles: &Tiles<Pane>,
        ui: &mut Ui,
        _: TileId,
        tabs: &Tabs,
        _: &mut f32,
    ) {
        let shown = tabs.active.and_then(|id| tiles.get_pane(&id));
        if shown == Some(&Pane::Picture) {
            self.workbench.picture_state(ui);
        }
    }

    fn tab_bar_height(&self, _: &egui::Style) -> f32 {
        28.0
    }

    fn gap_width(&self, _: &egui::Style) -> f32 {
        4.0
    }

    fn min_size(&self) -> f32 {
        120.0
    }

    fn simplification_options(&self) -> SimplificationOptions {
        SimplificationOptions {
            all_panes_must_have_tabs: false,
            ..SimplificationOptions::default()
        }
    }

    fn tab_bar_color(&self, visuals: &Visuals) -> Color32 {
        visuals.extreme_bg_color
    }

    fn tab_text_color(
        &self,
        visuals: &Visuals,
        _: &Tiles<Pane>,
        _: TileId,
        state: &TabState,
    ) -> Color32 {
        match state.active {
            true => visuals.text_color(),
            false => visuals.weak_text_color(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_tab_has_a_place_and_saved_layouts_of_other_versions_are_left() {
        let mut dock = Dock::default();
        let count = |tree: &Tree<Pane>| {
            let tiles = tree.tiles.tiles();
            tiles.filter(|tile| matches!(tile, Tile::Pane(_))).count()
        };
        assert_eq!(count(dock.tree()), TABS.len() + MIDDLE.len() + 1);
        for title in UPPER.into_iter().chain(WIDE) {
            assert!(entry(title).is_some(), "{title}");
        }
        let text = ron::to_string(dock.tree()).unwrap();
        dock.restore(ron::from_str(&text).unwrap());
        assert_eq!(count(dock.tree()), TABS.len() + MIDDLE.len() + 1);
        // A pane fewer than this version has.
        let mut tiles = Tiles::default();
        let root = tiles.insert_pane(Pane::Picture);
        dock.restore(Tree::new("dock", root, tiles));
        assert_eq!(count(dock.tree()), TABS.len() + MIDDLE.len() + 1);
    }

    #[test]
    fn the_picture_has_more_than_55_percent_of_the_width() {
        assert!(SHARES[1] / SHARES.iter().sum::<f32>() > 0.55);
    }
}
