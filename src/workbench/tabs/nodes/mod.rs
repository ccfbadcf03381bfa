//! The graph as nodes: reads, writes and times of passes, and passes left out.

mod layout;

use super::Tab;
use super::tables::Tables;
use crate::diagnostics::Loc;
use crate::graph::file::TableDecl;
use crate::workbench::Workbench;
use crate::workbench::desired::edit;
use crate::workbench::dock::Pane;
use crate::workbench::engine::report::{GraphInfo, PassUses};
use crate::workbench::panel::control::named;
use crate::workbench::panel::folded;
use crate::workbench::theme;
use egui::{
    Align2, Color32, FontId, Pos2, Rect, Sense, Shape, Stroke, TextureId, Ui, Vec2,
    epaint::CubicBezierShape,
};
use layout::{Layout, ROW, TITLE, WIDTH};
use std::sync::Arc;

/// State of this tab.
#[derive(Default)]
pub struct Nodes {
    side: usize,
    /// Name of the pass that was clicked on.
    chosen: Option<String>,
    /// Whether it is to be brought to the middle.
    go: bool,
    /// Search text for names of passes and of their outputs.
    search: String,
    /// The part of the layout that is seen; all when absent.
    seen: Option<Seen>,
    /// Where it is drawn, points.
    area: Vec2,
    made: Option<(Arc<GraphInfo>, Vec2, Layout)>,
}

/// Smallest text, points.
const LEAST: f32 = 12.0;

/// The least zoom at which rows have text. Below it, a click anywhere on a pass opens the pass.
const READABLE: f32 = LEAST / 13.0;

/// A part of the layout.
#[derive(Clone, Copy)]
struct Seen {
    /// Points of the screen a point of the layout.
    zoom: f32,
    /// The point at the upper left.
    corner: Pos2,
}

impl Seen {
    fn whole(bounds: Rect, area: Rect) -> Seen {
        let fit = (area.width() / bounds.width()).min(area.height() / bounds.height());
        Seen {
            zoom: fit.clamp(0.1, 1.0),
            corner: bounds.min,
        }
    }
}

/// The part that is seen after dragging, zooming, or going to a point.
fn steered(
    ui: &Ui,
    response: &egui::Response,
    mut seen: Option<Seen>,
    whole: Seen,
    go: Option<Pos2>,
) -> Option<Seen> {
    let area = response.rect;
    let mut now = seen.unwrap_or(whole);
    if let Some(center) = go {
        // Large enough to be read.
        now.zoom = now.zoom.max(1.0);
        now.corner = center - 0.5 * area.size() / now.zoom;
        seen = Some(now);
    }
    if response.dragged() {
        now.corner -= response.drag_delta() / now.zoom;
        seen = Some(now);
    }
    let wheel = match response.contains_pointer() {
        true => ui.input(|i| i.smooth_scroll_delta().y),
        false => 0.0,
    };
    if let (Some(at), true) = (response.hover_pos(), wheel != 0.0) {
        let zoom = stepped(now.zoom * (wheel * 0.01).exp()).clamp(0.2, 2.0);
        now.corner += (at - area.min) * (1.0 / now.zoom - 1.0 / zoom);
        now.zoom = zoom;
        seen = Some(now);
    }
    seen.filter(|_| !response.double_clicked())
}

/// The chosen action on a pass.
enum Asked {
    Choose(String),
    Inspect(String),
}

impl Tab for Nodes {
    const TITLE: &'static str = "Graph";
    const ICON: &'static str = egui_phosphor::regular::TREE_STRUCTURE;

    fn show(workbench: &mut Workbench, ui: &mut Ui, _: &[TextureId]) {
        workbench.graph_tab(ui);
    }
}

impl Nodes {
    /// The layout of a graph, made once.
    fn layout(&mut self, info: &Arc<GraphInfo>) -> &Layout {
        let area = self.area;
        self.made
            .take_if(|(of, size, _)| !Arc::ptr_eq(of, info) || *size != area);
        &self
            .made
            .get_or_insert_with(|| (info.clone(), area, Layout::new(info, area)))
            .2
    }

    /// Chooses a pass, and brings it to the middle.
    pub fn find(&mut self, side: usize, name: &str) {
        (self.side, self.chosen, self.go) = (side, Some(name.to_string()), true);
    }
}

impl Workbench {
    /// The pane of nodes.
    pub(crate) fn graph_view(&mut self, ui: &mut Ui) {
        let side = self
            .tabs
            .nodes
            .side
            .min(usize::from(self.desired.sides[1].is_some()));
        let Some(info) = self.sides[side].info.clone() else {
            ui.weak(self.waiting_text());
            return;
        };
        let times = self
            .tabs
            .times
            .means(ui.ctx(), side, self.desired.sides[1].is_some());
        let nodes = &mut self.tabs.nodes;
        let chosen = nodes.chosen.clone();
        let response = ui.allocate_response(ui.available_size(), Sense::click_and_drag());
        let area = response.rect;
        ui.painter()
            .rect_filled(area, 0.0, ui.visuals().extreme_bg_color);
        nodes.area = area.size();
        let (seen, go) = (nodes.seen, std::mem::take(&mut nodes.go));
        let layout = nodes.layout(&info);
        let node = layout
            .nodes
            .iter()
            .find(|n| Some(&n.name) == chosen.as_ref());
        let go = node.filter(|_| go).map(|n| n.rect.center());
        let whole = Seen::whole(layout.bounds(), area);
        let seen = steered(ui, &response, seen, whole, go);
        let mut canvas = Canvas {
            ui,
            area,
            seen: seen.unwrap_or(whole),
            asked: None,
        };
        canvas.draw(&info, layout, &times.passes, chosen.as_deref());
        let asked = canvas.asked;
        self.tabs.nodes.seen = seen;
        match asked {
            Some(Asked::Choose(name)) => self.tabs.nodes.chosen = Some(name),
            Some(Asked::Inspect(texture)) => self.inspect(side, texture),
            None => {}
        }
    }

    /// Details of the chosen pass, and actions on it.
    fn graph_tab(&mut self, ui: &mut Ui) {
        let both = self.desired.sides[1].is_some();
        if both {
            ui.horizontal(|ui| {
                ui.selectable_value(&mut self.tabs.nodes.side, 0, "graph of A");
                ui.selectable_value(&mut self.tabs.nodes.side, 1, "graph of B");
            });
        } else {
            self.tabs.nodes.side = 0;
        }
        let side = self.tabs.nodes.side;
        let (Some(info), Some(desired)) =
            (self.sides[side].info.clone(), &self.desired.sides[side])
        else {
            return;
        };
        let mut off = desired.off.clone();
        self.graph_bar(ui);
        passes_off(ui, &info, &mut off);
        ui.separator();
        let mut needed = None;
        egui::ScrollArea::vertical()
            .auto_shrink(false)
            .show(ui, |ui| {
                let nodes = &self.tabs.nodes;
                let name = nodes.chosen.clone();
                match name.filter(|_| nodes.search.is_empty()) {
                    Some(name) => needed = self.chosen_pass(ui, side, &info, &name, &mut off),
                    None => self.pass_list(ui, side, &info),
                }
            });
        let Some(desired) = &mut self.desired.sides[side] else {
            return;
        };
        if let Some((name, option)) = needed
            && let Some(param) = info.graph.params.param(&name)
            && let Ok(value) = param.parse(&option)
        {
            edit::set(desired, param, &value);
        }
        desired.off = off;
    }

    /// What of the graph is seen.
    fn graph_bar(&mut self, ui: &mut Ui) {
        let nodes = &mut self.tabs.nodes;
        ui.horizontal(|ui| {
            let width = ui.available_width() - 150.0;
            let field =
                egui::TextEdit::singleline(&mut nodes.search).hint_text("find a pass, a texture");
            let field = ui.add(field.desired_width(width.max(60.0)));
            named(&field, egui::WidgetType::TextEdit, "find a pass, a texture");
            if ui
                .add_enabled(nodes.chosen.is_some(), egui::Button::new("list").small())
                .clicked()
            {
                nodes.chosen = None;
            }
            if ui
                .small_button("Fit graph")
                .on_hover_text("Show the whole graph. A double click does the same")
                .clicked()
            {
                nodes.seen = None;
            }
        });
        if self.dock.shows(&Pane::Nodes) {
            ui.weak(
                "Columns are stages; boxes are passes with their outputs; warmer = slower. \
                 Click a pass or a texture to open it. Drag to pan, use the wheel to zoom.",
            );
        } else if ui.button("Show the nodes").clicked() {
            self.dock.open(Pane::Nodes);
        }
    }

    /// All passes, or those that match the search: with their time, or the reason why they do not
    /// run.
    fn pass_list(&mut self, ui: &mut Ui, side: usize, info: &Arc<GraphInfo>) {
        let needle = folded(&self.tabs.nodes.search);
        let times = self
            .tabs
            .times
            .means(ui.ctx(), side, self.desired.sides[1].is_some());
        let mut found = None;
        for (number, pass) in info.graph.declared_passes() {
            let name = &pass.name.value;
            let uses = info.uses.iter().filter(|u| u.pass == number);
            let mut names = uses.flat_map(|u| &u.writes).chain([name]);
            if !names.any(|name| folded(name).contains(&needle)) {
                continue;
            }
            let runs = info.passes.contains(&number);
            let ms = times.passes.iter().find(|t| t.0 == number);
            let why = info.left_out.iter().find(|l| l.0 == number);
            let text = egui::RichText::new(match ms {
                Some((_, ms)) if runs => format!("{name}  {ms:.3} ms"),
                None if runs => name.clone(),
                _ => format!("{name}  ({})", why.map_or("not built yet", |l| &l.1)),
            });
            let text = if runs { text } else { text.weak() };
            let row = ui.add(egui::Button::new(text).small().frame(false));
            let label = format!("find pass {name}");
            named(&row, egui::WidgetType::Button, &label);
            if row.clicked() {
                found = Some(name.clone());
            }
        }
        if let Some(name) = found {
            self.tabs.nodes.search.clear();
            self.tabs.nodes.find(side, &name);
        }
    }

    /// Describes a pass. On request, a choice with which a pass that waits for a condition would
    /// run.
    fn chosen_pass(
        &mut self,
        ui: &mut Ui,
        side: usize,
        info: &Arc<GraphInfo>,
        name: &str,
        off: &mut Vec<String>,
    ) -> Option<(String, String)> {
        let Some(number) = info
            .graph
            .passes
            .iter()
            .position(|p| p.value.name.value == name)
        else {
            ui.weak(format!("The graph has no pass '{name}' any more"));
            return None;
        };
        let pass = &info.graph.passes[number].value;
        ui.strong(name);
        ui.label(format!("stage: {}", pass.stage()));
        if let Some((_, ms)) = self
            .tabs
            .times
            .means(ui.ctx(), side, self.desired.sides[1].is_some())
            .passes
            .iter()
            .find(|t| t.0 == number)
        {
            ui.label(format!("{ms:.3} ms (mean)"));
        }
        let why_not = info.left_out.iter().find(|(pass, _)| *pass == number);
        let needed = why_not.and_then(|(_, why)| self.needs(ui, side, name, why));
        self.pass_switches(ui, side, info, name, off);
        if let Some(uses) = info.uses.iter().find(|u| u.pass == number) {
            self.pass_resources(ui, side, info, uses);
        }
        self.shader_files(ui, info, number);
        needed
    }

    /// The reason why a pass does not run. On request, a choice with which it would.
    fn needs(&self, ui: &mut Ui, side: usize, name: &str, why: &str) -> Option<(String, String)> {
        ui.colored_label(ui.visuals().warn_fg_color, format!("does not run: {why}"));
        let found = self.effects.of(side)?;
        let needs = found.resting.get(name)?;
        ui.horizontal_wrapped(|ui| {
            let clicked = |(param, option): &&(String, String)| {
                ui.small_button(format!("{param} = {option}"))
                    .on_hover_text("It runs with this")
                    .clicked()
            };
            needs.iter().filter(clicked).last().cloned()
        })
        .inner
    }

    fn pass_switches(
        &mut self,
        ui: &mut Ui,
        side: usize,
        info: &Arc<GraphInfo>,
        name: &str,
        off: &mut Vec<String>,
    ) {
        ui.horizontal(|ui| {
            let mut on = !off.iter().any(|o| o == name);
            let about = "When off, its outputs fall back to the pass's `instead`, or to zero. Saved with the experiment";
            if ui.checkbox(&mut on, "on").on_hover_text(about).changed() {
                match on {
                    true => off.retain(|o| o != name),
                    false => off.push(name.to_string()),
                }
            }
            let about = "A with this pass, B without it, over the picture";
            if ui.button("Compare with/without").on_hover_text(about).clicked() {
                self.with_and_without(side, name);
            }
            let about = "Runs only this pass and the passes that it needs. Inspect shows its first texture";
            if ui.button("Isolate").on_hover_text(about).clicked() {
                self.solo(side, info, name, off);
            }
        });
    }

    /// Resources of a pass. A click on a texture opens it.
    fn pass_resources(&mut self, ui: &mut Ui, side: usize, info: &GraphInfo, uses: &PassUses) {
        for (title, list) in [("reads", &uses.reads), ("writes", &uses.writes)] {
            ui.add_space(4.0);
            ui.label(title);
            for resource in list {
                let texture = info.graph.texture(resource);
                let is_of = |t: &Loc<TableDecl>| t.value.list.value.buffer == *resource;
                let table = info.graph.tables.iter().position(is_of);
                let about = texture.map_or("buffer".into(), |t| of(info, t));
                if texture.is_none() && table.is_none() {
                    ui.weak(format!("{resource}  {about}"))
                        .on_hover_text("No table of the graph shows this buffer");
                    continue;
                }
                let button = egui::Button::new(format!("{resource}  {about}")).small();
                let row = ui.add(button.frame(false));
                match table {
                    _ if !row.clicked() => {}
                    None => self.inspect(side, resource.clone()),
                    Some(table) => {
                        self.tabs.tables.choose(table);
                        self.dock.open_tab::<Tables>();
                    }
                }
            }
        }
    }

    /// Compares the picture with the same picture without a pass.
    fn with_and_without(&mut self, side: usize, name: &str) {
        let Some(base) = &self.desired.sides[side] else {
            return;
        };
        let mut with = base.clone();
        with.off.retain(|o| o != name);
        let mut without = with.clone();
        without.off.push(name.to_string());
        self.compare_sides([Some(with), Some(without)]);
        self.dock.open(Pane::Picture);
    }

    /// Turns off every pass that a pass does not need, except those of the picture, and shows its
    /// output.
    fn solo(&mut self, side: usize, info: &Arc<GraphInfo>, name: &str, off: &mut Vec<String>) {
        let layout = self.tabs.nodes.layout(info);
        let Some(node) = layout.nodes.iter().position(|n| n.name == name) else {
            return;
        };
        let mut needed = layout.needed_by(node);
        // Something has to write the picture that is shown meanwhile.
        let output = info.graph.output.as_deref().unwrap_or_default();
        needed.extend(
            layout
                .nodes
                .iter()
                .rposition(|n| n.writes.iter().any(|w| w == output)),
        );
        let others = layout
            .nodes
            .iter()
            .enumerate()
            .filter(|(i, _)| !needed.contains(i));
        *off = others.map(|(_, n)| n.name.clone()).collect();
        let texture = |w: &&String| info.graph.texture(w).is_some();
        if let Some(texture) = layout.nodes[node].writes.iter().find(texture).cloned() {
            self.tabs.inspector.open(side, texture);
        }
    }
}

/// The passes that are off, with a button that turns them on.
fn passes_off(ui: &mut Ui, info: &GraphInfo, off: &mut Vec<String>) {
    if off.is_empty() {
        return;
    }
    let warn = ui.visuals().warn_fg_color;
    ui.colored_label(warn, format!("off: {}", off.join(", ")));
    for (name, readers) in zeros(info) {
        ui.colored_label(warn, format!("{name} is zero now; {readers} read it"));
    }
    if ui.button("all passes on").clicked() {
        off.clear();
    }
}

/// What passes that are off would have written, and who reads it.
fn zeros(info: &GraphInfo) -> Vec<(&str, String)> {
    let of = |name: &String| {
        let reads = info.uses.iter().filter(|u| u.reads.contains(name));
        let names: Vec<&str> = reads.map(|u| info.graph.pass_name(u.pass)).collect();
        (!names.is_empty()).then(|| names.join(", "))
    };
    info.empty
        .iter()
        .filter_map(|name| Some((name.as_str(), of(name)?)))
        .collect()
}

/// A texture's format and size.
fn of(info: &GraphInfo, texture: usize) -> String {
    let plan = &info.textures[texture];
    let format = plan.format.name;
    let depth = if plan.volume {
        format!("x{}", plan.extent[2])
    } else {
        String::new()
    };
    format!("{format} {}x{}{depth}", plan.extent[0], plan.extent[1])
}

/// Zooms in steps, so that letters are not rasterised in every size between.
fn stepped(zoom: f32) -> f32 {
    2f32.powf((zoom.max(1e-3).log2() * 6.0).round() / 6.0)
}

/// The part of the viewport that the graph is drawn in.
struct Canvas<'u> {
    ui: &'u mut Ui,
    area: Rect,
    seen: Seen,
    asked: Option<Asked>,
}

impl Canvas<'_> {
    fn at(&self, point: Pos2) -> Pos2 {
        self.area.min + (point - self.seen.corner) * self.seen.zoom
    }

    fn place(&self, rect: Rect) -> Rect {
        Rect::from_min_max(self.at(rect.min), self.at(rect.max))
    }

    fn painter(&self, clip: Rect) -> egui::Painter {
        self.ui.painter().with_clip_rect(clip.intersect(self.area))
    }

    fn text(&self, clip: Rect, at: Pos2, anchor: Align2, text: &str, points: f32, color: Color32) {
        let points = points * self.seen.zoom;
        if points >= LEAST {
            let font = FontId::proportional(points);
            self.painter(clip)
                .text(self.at(at), anchor, text, font, color);
        }
    }

    /// A text that stays legible however small the graph is drawn.
    fn name(&self, clip: Rect, at: Pos2, anchor: Align2, text: &str, points: f32, color: Color32) {
        let font = FontId::proportional((points * self.seen.zoom).max(LEAST));
        self.painter(clip)
            .text(self.at(at), anchor, text, font, color);
    }

    /// A part that can be clicked on, with a name for scripts and screen readers.
    fn button(
        &self,
        rect: Rect,
        id: impl egui::AsIdSalt,
        enabled: bool,
        name: String,
    ) -> Option<egui::Response> {
        let rect = self.place(rect).intersect(self.area);
        if !rect.is_positive() {
            return None;
        }
        let response = self
            .ui
            .interact(rect, self.ui.id().with(id), Sense::click());
        response
            .widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, enabled, &name));
        Some(response)
    }

    fn draw(
        &mut self,
        info: &GraphInfo,
        layout: &Layout,
        times: &[(usize, f64)],
        chosen: Option<&str>,
    ) {
        let ms = |pass: usize| times.iter().find(|t| t.0 == pass).map(|t| t.1);
        let most = times.iter().map(|t| t.1).fold(0.0, f64::max);
        for column in &layout.columns {
            let total = column.passes.iter().filter_map(|p| ms(*p)).sum();
            self.column(column, total);
        }
        let roles = theme::roles(self.ui);
        let touches = |i: usize| chosen.is_some_and(|c| layout.nodes[i].name == c);
        for edge in &layout.edges {
            let bright = touches(edge.from.0) || touches(edge.to);
            let color = match (bright, edge.of_last_frame) {
                (true, _) => roles.accent,
                (false, true) => Color32::from_rgba_unmultiplied(150, 110, 190, 110),
                (false, false) => roles.secondary.gamma_multiply(0.3),
            };
            let stroke = Stroke::new(if bright { 1.8 } else { 1.0 }, color);
            self.painter(self.area)
                .add(self.curve(layout, edge, stroke));
        }
        for node in &layout.nodes {
            let time = ms(node.pass).unwrap_or(0.0);
            // The longer a pass takes, the warmer it is.
            let heat = if most > 0.0 {
                (time / most).sqrt() as f32
            } else {
                0.0
            };
            self.node(info, node, time, heat, chosen == Some(node.name.as_str()));
        }
    }

    /// The title of a column: its stage, and the time of its passes [ms].
    fn column(&self, column: &layout::Column, total: f64) {
        let visuals = self.ui.visuals();
        let (strong, weak) = (visuals.text_color(), visuals.weak_text_color());
        let top = column.rect.left_top();
        let (at, below) = (Align2::LEFT_TOP, top + Vec2::new(0.0, 17.0));
        self.name(self.area, top, at, &column.stage, 14.0, strong);
        self.text(self.area, below, at, &format!("{total:.3} ms"), 13.0, weak);
        let line = top + Vec2::new(0.0, TITLE);
        let line = self.place(Rect::from_min_max(line, column.rect.right_top()));
        let stroke = Stroke::new(1.0, weak.gamma_multiply(0.4));
        self.painter(self.area)
            .hline(line.x_range(), line.top(), stroke);
    }

    fn node(
        &mut self,
        info: &GraphInfo,
        node: &layout::Node,
        time: f64,
        heat: f32,
        is_chosen: bool,
    ) {
        let name = format!("pass {}", node.name);
        let Some(response) = self.button(node.rect, node.pass, true, name) else {
            return;
        };
        let visuals = self.ui.visuals();
        let (strong, weak) = (visuals.text_color(), visuals.weak_text_color());
        let roles = theme::roles(self.ui);
        let warm = roles.button.lerp_to_gamma(roles.hot, heat);
        let (fill, color, said) = match node.runs {
            true => (warm, strong, format!("{time:.3}")),
            false => (roles.panel, weak, "off".into()),
        };
        let edge = match (is_chosen, response.hovered()) {
            (true, _) => Stroke::new(2.0, roles.accent),
            (_, true) => Stroke::new(1.5, strong),
            _ => Stroke::new(1.0, roles.line),
        };
        let rect = self.place(node.rect);
        let (round, inside) = (4.0 * self.seen.zoom, egui::StrokeKind::Inside);
        self.painter(self.area)
            .rect(rect, round, fill, edge, inside);
        let first = node.rect.left_top() + Vec2::new(6.0, ROW * 0.75);
        let right = Pos2::new(node.rect.right() - 6.0, first.y);
        // Names give way to times, where these are shown.
        let times = if self.seen.zoom >= READABLE {
            42.0
        } else {
            0.0
        };
        let names = self.place(node.rect.with_max_x(right.x - times));
        self.name(names, first, Align2::LEFT_CENTER, &node.name, 13.0, color);
        self.text(rect, right, Align2::RIGHT_CENTER, &said, 13.0, color);
        for number in 0..node.writes.len() {
            self.output(info, node, number);
        }
        if response.clicked() {
            self.asked = Some(Asked::Choose(node.name.clone()));
        }
    }

    /// The row of a resource that a node writes.
    fn output(&mut self, info: &GraphInfo, node: &layout::Node, number: usize) {
        let resource = &node.writes[number];
        let row = row_of(node.rect, number);
        let texture = info.graph.texture(resource).is_some();
        let name = format!("{} writes {resource}", node.name);
        let hit = (self.seen.zoom >= READABLE)
            .then(|| self.button(row, (node.pass, number), texture, name))
            .flatten();
        // Every row can be on a warm ground, where only the text's colour has enough contrast.
        let color = match texture && hit.as_ref().is_some_and(egui::Response::hovered) {
            true => self.ui.visuals().hyperlink_color,
            false => self.ui.visuals().text_color(),
        };
        let at = row.left_center() + Vec2::new(12.0, 0.0);
        self.text(
            self.place(row),
            at,
            Align2::LEFT_CENTER,
            resource,
            13.0,
            color,
        );
        if hit.is_some_and(|h| h.clicked()) {
            self.asked = Some(match texture {
                true => Asked::Inspect(resource.clone()),
                false => Asked::Choose(node.name.clone()),
            });
        }
    }

    fn curve(&self, layout: &Layout, edge: &layout::Edge, stroke: Stroke) -> Shape {
        let from = self.at(row_of(layout.nodes[edge.from.0].rect, edge.from.1).right_center());
        let to = self.at(layout.nodes[edge.to].rect.left_top() + Vec2::new(0.0, ROW * 0.75));
        let bend = Vec2::new(((to.x - from.x).abs() * 0.5).clamp(28.0, 160.0), 0.0);
        let points = [from, from + bend, to - bend, to];
        CubicBezierShape::from_points_stroke(points, false, Color32::TRANSPARENT, stroke).into()
    }
}

/// Position of the name of an output.
fn row_of(node: Rect, number: usize) -> Rect {
    let top = node.top() + ROW * (1.35 + number as f32);
    Rect::from_min_size(Pos2::new(node.left(), top), Vec2::new(WIDTH, ROW))
}
