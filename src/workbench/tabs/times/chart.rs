//! Stacked bars, one a frame, as one mesh.

use super::history::{History, KEPT};
use crate::results::timers::color;
use egui::epaint::{Mesh, Vertex, WHITE_UV};
use egui::{Align2, Color32, FontId, Pos2, Rect, Response, Sense, Shape, Ui, Vec2};
use std::sync::Arc;

/// A chart's mesh, kept while nothing changes.
#[derive(Default)]
pub struct Chart {
    key: Option<Key>,
    mesh: Arc<Mesh>,
}

#[derive(PartialEq)]
struct Key {
    rect: Rect,
    changes: u64,
    passes: usize,
    top: f64,
    hovered: Option<String>,
}

impl Chart {
    /// Draws it; the pass under the pointer and the chart's response.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        side: usize,
        history: &History,
        top: f64,
        hovered: Option<&str>,
    ) -> Option<(String, Response)> {
        let size = Vec2::new(ui.available_width(), super::CHART);
        let (rect, response) = ui.allocate_exact_size(size, Sense::click());
        let name = ["A, frames", "B, frames"][side.min(1)];
        response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Other, true, name));
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 0.0, ui.visuals().extreme_bg_color);
        let key = Key {
            rect,
            changes: history.changes,
            passes: history.passes.len(),
            top,
            hovered: hovered.map(str::to_string),
        };
        if self.key.as_ref() != Some(&key) {
            self.mesh = Arc::new(mesh(rect, history, top, hovered));
            self.key = Some(key);
        }
        painter.add(Shape::Mesh(self.mesh.clone()));
        let weak = ui.visuals().weak_text_color();
        // A round number on the axis is no measurement.
        let tick = round_below(top / 1.05);
        let line = rect.bottom() - (f64::from(rect.height()) * tick / top.max(1e-9)) as f32;
        painter.hline(rect.x_range(), line, (0.5, weak));
        let font = FontId::proportional(11.0);
        let at = Pos2::new(rect.right() - 3.0, line + 1.0);
        painter.text(
            at,
            Align2::RIGHT_TOP,
            format!("{tick} ms"),
            font.clone(),
            weak,
        );
        let name = ["A", "B"][side.min(1)];
        painter.text(
            rect.left_top() + Vec2::splat(3.0),
            Align2::LEFT_TOP,
            name,
            font,
            ui.visuals().text_color(),
        );
        let at = response.hover_pos()?;
        let name = under(rect, history, top, at)?;
        Some((name, response))
    }
}

/// The greatest of 1, 2 and 5 times a power of ten that is not above a number.
fn round_below(x: f64) -> f64 {
    if x <= 0.0 || !x.is_finite() {
        return 0.0;
    }
    let power = 10.0_f64.powi(x.log10().floor() as i32);
    [5.0, 2.0, 1.0]
        .into_iter()
        .map(|n| n * power)
        .find(|n| *n <= x * 1.000_001)
        .unwrap_or(power)
}

/// Bottom left of the bar of frame `i`; the newest is at the right edge.
fn place(rect: Rect, count: usize, i: usize) -> (f32, f32) {
    let step = rect.width() / KEPT as f32;
    (rect.right() - step * (count - i) as f32, step)
}

fn mesh(rect: Rect, history: &History, top: f64, hovered: Option<&str>) -> Mesh {
    let mut mesh = Mesh::default();
    let scale = f64::from(rect.height()) / top.max(1e-9);
    let colors: Vec<Color32> = history
        .passes
        .iter()
        .map(|(_, name)| {
            let color = color(name);
            if hovered.is_some_and(|h| h != name) {
                color.gamma_multiply(0.35)
            } else {
                color
            }
        })
        .collect();
    for (i, frame) in history.frames.iter().enumerate() {
        let (x, width) = place(rect, history.frames.len(), i);
        let (mut low, mut high) = (0.0, 0.0);
        for ((number, _), color) in history.passes.iter().zip(&colors) {
            high += frame.pass(*number) * scale;
            // Invisible parts cost no triangles: they are added to the next part.
            if high - low < 0.4 {
                continue;
            }
            let box_ = Rect::from_min_max(
                Pos2::new(x, rect.bottom() - high as f32),
                Pos2::new(x + width, rect.bottom() - low as f32),
            );
            quad(&mut mesh, box_.intersect(rect), *color);
            low = high;
            if high > f64::from(rect.height()) {
                break;
            }
        }
    }
    mesh
}

fn quad(mesh: &mut Mesh, r: Rect, color: Color32) {
    let first = mesh.vertices.len() as u32;
    let corner = |pos: Pos2| Vertex {
        pos,
        uv: WHITE_UV,
        color,
    };
    mesh.vertices.extend(
        [
            r.left_top(),
            r.right_top(),
            r.left_bottom(),
            r.right_bottom(),
        ]
        .map(corner),
    );
    mesh.indices.extend([0, 1, 2, 2, 1, 3].map(|i| first + i));
}

/// The pass at a point.
fn under(rect: Rect, history: &History, top: f64, at: Pos2) -> Option<String> {
    let count = history.frames.len();
    let step = rect.width() / KEPT as f32;
    let back = ((rect.right() - at.x) / step).floor().max(0.0) as usize;
    let frame = history.frames.get(count.checked_sub(back + 1)?)?;
    let ms = f64::from((rect.bottom() - at.y) / rect.height()) * top;
    let mut sum = 0.0;
    let found = history.passes.iter().find(|(number, _)| {
        sum += frame.pass(*number);
        sum >= ms
    });
    found.map(|p| p.1.clone())
}

#[cfg(test)]
mod tests {
    use super::super::history::Frame;
    use super::*;
    use crate::graph::run::FrameTimes;

    #[test]
    fn bars_stand_where_the_pointer_finds_them() {
        let mut history = History::new(vec![(4, "below".into()), (7, "above".into())]);
        history.push(Frame {
            times: FrameTimes {
                gpu_ms: 3.0,
                passes: vec![(4, 1.0), (7, 2.0)],
                ..FrameTimes::default()
            },
            ..Frame::default()
        });
        let rect = Rect::from_min_size(Pos2::ZERO, Vec2::new(240.0, 100.0));
        let at = |x: f32, y: f32| under(rect, &history, 4.0, Pos2::new(x, y));
        assert_eq!(at(239.5, 90.0).as_deref(), Some("below"));
        assert_eq!(at(239.5, 40.0).as_deref(), Some("above"));
        assert_eq!((at(239.5, 10.0), at(100.0, 90.0)), (None, None));
        let mesh = mesh(rect, &history, 4.0, None);
        assert_eq!(mesh.vertices.len(), 8);
        assert_eq!(
            (mesh.vertices[0].pos, mesh.vertices[7].pos),
            (Pos2::new(239.0, 75.0), Pos2::new(240.0, 75.0))
        );
        assert_eq!(mesh.vertices[0].color, color("below"));
    }

    #[test]
    fn the_axis_has_round_numbers() {
        assert_eq!(
            [1032.67, 0.73, 2.0, 0.0].map(round_below),
            [1000.0, 0.5, 2.0, 0.0]
        );
    }
}
