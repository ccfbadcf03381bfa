//! The graph as nodes: what each pass reads and writes, what it takes, and which passes are left out.

mod layout;

use super::report::GraphInfo;
use super::{Tab, Workbench, edit};
use egui::{Align2, Color32, FontId, Pos2, Rect, Sense, Shape, Stroke, Ui, Vec2, epaint::CubicBezierShape};
use layout::{Layout, ROW, TITLE, WIDTH};
use std::sync::Arc;

/// State of this tab.
#[derive(Default)]
pub struct Nodes {
    side: usize,
    /// Name of the pass that was clicked on.
    chosen: Option<String>,
    /// The part of the layout that is seen; all that fits when it has no area.
    seen: Option<Rect>,
    made: Option<(Arc<GraphInfo>, Layout)>,
}

/// What was asked for with a pass.
enum Asked {
    Choose(String),
    Inspect(String),
}

impl Nodes {
    /// The layout of a graph, made once.
    fn layout(&mut self, info: &Arc<GraphInfo>) -> &Layout {
        self.made.take_if(|(of, _)| !Arc::ptr_eq(of, info));
        &self.made.get_or_insert_with(|| (info.clone(), Layout::new(info))).1
    }
}

impl Workbench {
    /// The graph in the viewport.
    pub(super) fn graph_view(&mut self, ui: &mut Ui) {
        let side = self.nodes.side.min(usize::from(self.desired.sides[1].is_some()));
        let Some(info) = self.sides[side].info.clone() else {
            ui.weak(self.waiting_text());
            return;
        };
        let times = self.times.medians(side);
        let chosen = self.nodes.chosen.clone();
        let mut seen = self.nodes.seen;
        let layout = self.nodes.layout(&info);
        let area = ui.available_size();
        // Not smaller than can be read: what does not fit is reached by dragging.
        let bounds = layout.bounds();
        let zoom = (area.x / bounds.width()).min(area.y / bounds.height()).clamp(0.8, 1.0);
        let mut rect = seen.unwrap_or(Rect::from_min_size(bounds.min, area / zoom));
        let mut asked = None;
        let response = egui::Scene::new().zoom_range(0.2..=2.0).show(ui, &mut rect, |ui| {
            draw(ui, &info, layout, &times, chosen.as_deref(), &mut asked);
        });
        if seen.is_some() || response.response.changed() || response.response.dragged() {
            seen = Some(rect);
        }
        if response.response.double_clicked() {
            seen = None;
        }
        self.nodes.seen = seen;
        match asked {
            Some(Asked::Choose(name)) => self.nodes.chosen = Some(name),
            Some(Asked::Inspect(texture)) => {
                self.inspector.open(side, texture);
                self.tab = Tab::Inspector;
            }
            None => {}
        }
    }

    /// What is said of the chosen pass, and what can be done with it.
    pub(super) fn graph_tab(&mut self, ui: &mut Ui) {
        let both = self.desired.sides[1].is_some();
        if both {
            ui.horizontal(|ui| {
                ui.selectable_value(&mut self.nodes.side, 0, "graph of A");
                ui.selectable_value(&mut self.nodes.side, 1, "graph of B");
            });
        } else {
            self.nodes.side = 0;
        }
        let side = self.nodes.side;
        let (Some(info), Some(mut desired)) = (self.sides[side].info.clone(), self.desired.sides[side].clone()) else {
            return;
        };
        ui.weak(
            "Columns are stages, boxes are passes with what they write. Click on a pass or on what it writes; drag and \
                 turn the wheel to move, double click to see all.",
        );
        let mut off = edit::off(&desired, &info.params);
        let before = off.clone();
        if !off.is_empty() {
            ui.separator();
            ui.colored_label(ui.visuals().warn_fg_color, format!("off: {}", off.join(", ")));
            if ui.button("all passes on").clicked() {
                off.clear();
            }
        }
        ui.separator();
        egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| match self.nodes.chosen.clone() {
            Some(name) => self.chosen_pass(ui, side, &info, &name, &mut off),
            None => drop(ui.weak("No pass is chosen")),
        });
        if off != before {
            edit::set_off(&mut desired, &off);
            self.desired.sides[side] = Some(desired);
        }
    }

    fn chosen_pass(&mut self, ui: &mut Ui, side: usize, info: &Arc<GraphInfo>, name: &str, off: &mut Vec<String>) {
        let Some(number) = info.graph.passes.iter().position(|p| p.value.name.value == name) else {
            ui.weak(format!("The graph has no pass '{name}' any more"));
            return;
        };
        let pass = &info.graph.passes[number].value;
        ui.strong(name);
        ui.label(format!("stage: {}", pass.stage()));
        if let Some((_, ms)) = self.times.medians(side).iter().find(|t| t.0 == number) {
            ui.label(format!("{ms:.3} ms (median)"));
        }
        ui.horizontal(|ui| {
            let mut on = !off.iter().any(|o| o == name);
            let about = "What only a pass that is off would write is zeros. It is saved with the experiment";
            if ui.checkbox(&mut on, "on").on_hover_text(about).changed() {
                match on {
                    true => off.retain(|o| o != name),
                    false => off.push(name.to_string()),
                }
            }
            let about = "Only this pass and what it needs; its first texture is shown in Inspect";
            if ui.button("solo").on_hover_text(about).clicked() {
                self.solo(side, info, name, off);
            }
        });
        let Some(uses) = info.uses.iter().find(|u| u.pass == number) else { return };
        for (title, list) in [("reads", &uses.reads), ("writes", &uses.writes)] {
            ui.add_space(4.0);
            ui.label(title);
            for resource in list {
                let texture = info.graph.textures.iter().position(|t| t.0 == *resource);
                let text = format!("{resource}  {}", texture.map_or(String::new(), |t| of(info, t)));
                if ui.add_enabled(texture.is_some(), egui::Button::new(text).small().frame(false)).clicked() {
                    self.inspector.open(side, resource.clone());
                    self.tab = Tab::Inspector;
                }
            }
        }
    }

    /// Leaves out every pass that a pass does not need, but those that make the picture, and shows what it writes.
    fn solo(&mut self, side: usize, info: &Arc<GraphInfo>, name: &str, off: &mut Vec<String>) {
        let layout = self.nodes.layout(info);
        let Some(node) = layout.nodes.iter().position(|n| n.name == name) else { return };
        let mut needed = layout.needed_by(node);
        // Something has to write the picture that is shown meanwhile.
        let output = info.graph.output.as_deref().unwrap_or_default();
        needed.extend(layout.nodes.iter().rposition(|n| n.writes.iter().any(|w| w == output)));
        let others = layout.nodes.iter().enumerate().filter(|(i, _)| !needed.contains(i));
        *off = others.map(|(_, n)| n.name.clone()).collect();
        let texture = |w: &&String| info.graph.textures.iter().any(|t| t.0 == **w);
        if let Some(texture) = layout.nodes[node].writes.iter().find(texture).cloned() {
            self.inspector.open(side, texture);
        }
    }
}

/// A texture's format and size.
fn of(info: &GraphInfo, texture: usize) -> String {
    let format = &info.graph.textures[texture].1.value.format.value;
    let plan = &info.textures[texture];
    let depth = if plan.volume { format!("x{}", plan.extent[2]) } else { String::new() };
    format!("{format} {}x{}{depth}", plan.extent[0], plan.extent[1])
}

fn draw(
    ui: &mut Ui,
    info: &GraphInfo,
    layout: &Layout,
    times: &[(usize, f64)],
    chosen: Option<&str>,
    asked: &mut Option<Asked>,
) {
    ui.expand_to_include_rect(layout.bounds());
    let ms = |pass: usize| times.iter().find(|t| t.0 == pass).map(|t| t.1);
    let most = times.iter().map(|t| t.1).fold(0.0, f64::max);
    let text_color = ui.visuals().text_color();
    let weak = ui.visuals().weak_text_color();
    let font = FontId::proportional(11.5);
    for column in &layout.columns {
        let total: f64 = column.passes.iter().filter_map(|p| ms(*p)).sum();
        let top = column.rect.left_top();
        let painter = ui.painter();
        painter.text(top, Align2::LEFT_TOP, &column.stage, FontId::proportional(14.0), text_color);
        let text = format!("{total:.3} ms");
        painter.text(top + Vec2::new(0.0, 17.0), Align2::LEFT_TOP, text, font.clone(), weak);
        painter.hline(column.rect.x_range(), top.y + TITLE, Stroke::new(1.0, weak.gamma_multiply(0.4)));
    }
    let touches = |i: usize| chosen.is_some_and(|c| layout.nodes[i].name == c);
    for edge in &layout.edges {
        let bright = touches(edge.from.0) || touches(edge.to);
        let color = match (bright, edge.of_last_frame) {
            (true, _) => Color32::from_rgb(240, 190, 90),
            (false, true) => Color32::from_rgba_unmultiplied(150, 110, 190, 70),
            (false, false) => Color32::from_rgba_unmultiplied(130, 150, 180, 55),
        };
        ui.painter().add(curve(layout, edge, Stroke::new(if bright { 1.8 } else { 1.0 }, color)));
    }
    for node in &layout.nodes {
        let response = ui.interact(node.rect, ui.id().with(node.pass), Sense::click());
        response
            .widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, format!("pass {}", node.name)));
        let is_chosen = chosen == Some(node.name.as_str());
        let time = ms(node.pass).unwrap_or(0.0);
        // The longer a pass takes, the warmer it is.
        let heat = if most > 0.0 { (time / most).sqrt() as f32 } else { 0.0 };
        let fill = Color32::from_gray(38).lerp_to_gamma(Color32::from_rgb(140, 66, 40), heat);
        let fill = if node.runs { fill } else { Color32::from_gray(24) };
        let edge = match (is_chosen, response.hovered()) {
            (true, _) => Stroke::new(2.0, Color32::from_rgb(240, 190, 90)),
            (_, true) => Stroke::new(1.5, text_color),
            _ => Stroke::new(1.0, Color32::from_gray(80)),
        };
        let painter = ui.painter();
        painter.rect(node.rect, 4.0, fill, edge, egui::StrokeKind::Inside);
        let clipped = painter.with_clip_rect(node.rect.shrink2(Vec2::new(5.0, 0.0)).intersect(ui.clip_rect()));
        let first = node.rect.left_top() + Vec2::new(6.0, ROW * 0.75);
        let color = if node.runs { text_color } else { weak };
        clipped.text(first, Align2::LEFT_CENTER, &node.name, font.clone(), color);
        let right = Pos2::new(node.rect.right() - 6.0, first.y);
        let said = if node.runs { format!("{time:.3}") } else { "off".into() };
        let behind = painter.layout_no_wrap(said, FontId::monospace(10.0), color);
        let place = Align2::RIGHT_CENTER.anchor_size(right, behind.size());
        painter.rect_filled(place.expand2(Vec2::new(3.0, 0.0)), 0.0, fill);
        painter.galley(place.min, behind, color);
        for (i, resource) in node.writes.iter().enumerate() {
            let row = row_of(node.rect, i);
            let texture = info.graph.textures.iter().any(|t| t.0 == *resource);
            let hit = ui.interact(row, ui.id().with((node.pass, i)), Sense::click());
            hit.widget_info(|| {
                egui::WidgetInfo::labeled(egui::WidgetType::Button, texture, format!("{} writes {resource}", node.name))
            });
            let color = if hit.hovered() && texture { text_color } else { Color32::from_gray(150) };
            let at = row.left_center() + Vec2::new(12.0, 0.0);
            let shown = ui.painter().with_clip_rect(row.intersect(ui.clip_rect()));
            shown.text(at, Align2::LEFT_CENTER, resource, FontId::proportional(10.5), color);
            if hit.clicked() {
                *asked = Some(match texture {
                    true => Asked::Inspect(resource.clone()),
                    false => Asked::Choose(node.name.clone()),
                });
            }
        }
        if response.clicked() {
            *asked = Some(Asked::Choose(node.name.clone()));
        }
    }
}

/// Where what a pass writes is named.
fn row_of(node: Rect, number: usize) -> Rect {
    let top = node.top() + ROW * (1.35 + number as f32);
    Rect::from_min_size(Pos2::new(node.left(), top), Vec2::new(WIDTH, ROW))
}

fn curve(layout: &Layout, edge: &layout::Edge, stroke: Stroke) -> Shape {
    let from = row_of(layout.nodes[edge.from.0].rect, edge.from.1).right_center();
    let to = layout.nodes[edge.to].rect.left_top() + Vec2::new(0.0, ROW * 0.75);
    let bend = Vec2::new(((to.x - from.x).abs() * 0.5).clamp(28.0, 160.0), 0.0);
    let points = [from, from + bend, to - bend, to];
    CubicBezierShape::from_points_stroke(points, false, Color32::TRANSPARENT, stroke).into()
}
