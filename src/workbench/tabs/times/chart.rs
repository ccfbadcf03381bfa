//! The frame graph: one stacked bar per frame, as one mesh.

use super::history::{History, KEPT};
use super::table::digits;
use crate::results::timers::color;
use egui::epaint::{Mesh, Vertex, WHITE_UV};
use egui::{Align2, Color32, Pos2, Rect, Response, Sense, Shape, TextStyle, Ui, Vec2};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Height of a mark on a bar that is cut off, points.
const CUT: f32 = 3.0;
/// Width of the labels on the right, in characters.
const LABELS: f32 = 11.0;

/// Longest time that new frames wait for their bars: a mesh takes about a millisecond of the CPU.
const AGE: Duration = Duration::from_millis(100);
/// Parts of a bar lower than this are added to the next part, points.
const LEAST: f64 = 1.0;

/// A chart's mesh, kept while nothing changes.
#[derive(Default)]
pub struct Chart {
    key: Option<(Key, Instant)>,
    mesh: Arc<Mesh>,
}

#[derive(PartialEq)]
struct Key {
    rect: Rect,
    changes: u64,
    passes: usize,
    top: f64,
    hovered: Option<String>,
    cut: Color32,
}

impl Key {
    /// Whether nothing but newer frames separates two charts.
    fn differs_by_frames(&self, other: &Key) -> bool {
        let view = |key: &Key| (key.rect, key.passes, key.hovered.clone(), key.cut);
        view(self) == view(other)
    }
}

/// How a chart is drawn.
pub struct Look<'a> {
    /// 0 is A, 1 is B.
    pub side: usize,
    pub height: f32,
    /// Time at the upper edge, ms.
    pub top: f64,
    /// Number of the held frame.
    pub held: Option<u64>,
    /// Name of the highlighted pass.
    pub hovered: Option<&'a str>,
}

/// The frame and pass under the pointer.
pub struct Pointed {
    pub frame: u64,
    pub pass: Option<String>,
}

/// The time at the upper edge, ms: slightly above the 95th percentile, so that one slow frame does
/// not flatten the others.
pub fn top(p95: f64) -> f64 {
    p95.max(1e-3) * 1.15
}

impl Chart {
    pub fn show(
        &mut self,
        ui: &mut Ui,
        history: &History,
        look: &Look<'_>,
    ) -> (Response, Option<Pointed>) {
        let size = Vec2::new(ui.available_width(), look.height);
        let (rect, response) = ui.allocate_exact_size(size, Sense::click());
        let name = ["A, frames", "B, frames"][look.side.min(1)];
        response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Other, true, name));
        let font = TextStyle::Small.resolve(ui.style());
        let font = egui::FontId::new(font.size.max(12.0), font.family);
        let mut bars = rect;
        bars.max.x -= LABELS * 0.55 * font.size;
        let painter = ui.painter_at(rect);
        painter.rect_filled(bars, 0.0, ui.visuals().extreme_bg_color);
        let cut = ui.visuals().warn_fg_color;
        let key = Key {
            rect: bars,
            changes: history.changes,
            passes: history.passes.len(),
            top: look.top,
            hovered: look.hovered.map(str::to_string),
            cut,
        };
        match &self.key {
            Some((made, _)) if *made == key => {}
            Some((made, at)) if made.differs_by_frames(&key) && at.elapsed() < AGE => {
                ui.ctx().request_repaint_after(AGE);
            }
            _ => {
                self.mesh = Arc::new(mesh(bars, history, look.top, look.hovered, cut));
                self.key = Some((key, Instant::now()));
            }
        }
        painter.add(Shape::Mesh(self.mesh.clone()));
        let (text, weak) = (ui.visuals().text_color(), ui.visuals().weak_text_color());
        let line = ui
            .text_style_height(&TextStyle::Small)
            .max(1.35 * font.size);
        let (median, p95) = history.level();
        if !history.frames.is_empty() {
            let labels = [
                ("p95", p95, Align2::LEFT_BOTTOM),
                ("med", median, Align2::LEFT_TOP),
            ];
            for (name, ms, align) in labels {
                let part = (ms / look.top.max(1e-9)).min(1.0);
                let y = bars.bottom() - bars.height() * part as f32;
                painter.hline(bars.x_range(), y, (1.0, weak));
                let y = y.clamp(rect.top() + line, rect.bottom() - line);
                let at = Pos2::new(bars.right() + 3.0, y);
                painter.text(
                    at,
                    align,
                    format!("{name} {}", digits(ms)),
                    font.clone(),
                    text,
                );
            }
        }
        let name = ["A", "B"][look.side.min(1)].to_string();
        let name = painter.layout_no_wrap(name, font, text);
        let at = rect.left_top() + Vec2::splat(3.0);
        let ground = Rect::from_min_size(at, name.size()).expand(1.0);
        painter.rect_filled(ground, 2.0, ui.visuals().extreme_bg_color);
        painter.galley(at, name, text);
        if let Some(index) = look.held.and_then(|n| n.checked_sub(history.first)) {
            let (x, step) = place(bars, history.frames.len(), index as usize);
            let column = Rect::from_x_y_ranges(x..=x + step, bars.y_range());
            let stroke = ui.visuals().selection.stroke;
            painter.rect_stroke(column.expand(1.0), 0.0, stroke, egui::StrokeKind::Outside);
        }
        let pointed = response
            .hover_pos()
            .and_then(|at| under(bars, history, look.top, at));
        (response, pointed)
    }
}

/// Number of bars that fit: a short history has wider bars.
fn slots(count: usize) -> usize {
    [KEPT / 4, KEPT / 2]
        .into_iter()
        .find(|n| count <= *n)
        .unwrap_or(KEPT)
}

/// Left edge of the bar of frame `i` and the width of a bar; the newest is at the right edge.
fn place(rect: Rect, count: usize, i: usize) -> (f32, f32) {
    let step = rect.width() / slots(count) as f32;
    (rect.right() - step * count.saturating_sub(i) as f32, step)
}

fn mesh(rect: Rect, history: &History, top: f64, hovered: Option<&str>, cut: Color32) -> Mesh {
    let mut mesh = Mesh::default();
    let height = f64::from(rect.height());
    let scale = height / top.max(1e-9);
    let shade = |name: &str| match hovered.is_some_and(|h| h != name) {
        true => color(name).gamma_multiply(0.35),
        false => color(name),
    };
    let colors: Vec<Color32> = history.passes.iter().map(|p| shade(&p.name)).collect();
    for (i, frame) in history.frames.iter().enumerate() {
        let (x, width) = place(rect, history.frames.len(), i);
        let (mut low, mut high) = (0.0, 0.0);
        let mut part = |from: f64, to: f64, color: Color32| {
            let corner = |x: f32, y: f64| Pos2::new(x, rect.bottom() - y as f32);
            let part = Rect::from_min_max(corner(x, to), corner(x + width, from));
            quad(&mut mesh, part.intersect(rect), color);
        };
        for (pass, color) in history.passes.iter().zip(&colors) {
            high += frame.pass(pass.number) * scale;
            // Invisible parts cost no triangles: they are added to the next part.
            if high - low < LEAST {
                continue;
            }
            part(low, high, *color);
            low = high;
            if high > height {
                break;
            }
        }
        if frame.times.gpu_ms > top {
            part(height - f64::from(CUT), height, cut);
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

/// The frame and pass at a point.
fn under(rect: Rect, history: &History, top: f64, at: Pos2) -> Option<Pointed> {
    if !rect.contains(at) {
        return None;
    }
    let step = rect.width() / slots(history.frames.len()) as f32;
    let back = ((rect.right() - at.x) / step).floor().max(0.0) as usize;
    let index = history.frames.len().checked_sub(back + 1)?;
    let frame = history.frames.get(index)?;
    let ms = f64::from((rect.bottom() - at.y) / rect.height()) * top;
    let mut sum = 0.0;
    let found = history.passes.iter().find(|pass| {
        sum += frame.pass(pass.number);
        sum >= ms
    });
    Some(Pointed {
        frame: history.first + index as u64,
        pass: found.map(|p| p.name.clone()),
    })
}

#[cfg(test)]
mod tests {
    use super::super::history::tests::{frame, pass};
    use super::*;

    const AREA: Rect = Rect {
        min: Pos2::ZERO,
        max: Pos2::new(240.0, 100.0),
    };

    #[test]
    fn bars_stand_where_the_pointer_finds_them() {
        let mut history = History::new(vec![pass(0, "below", ""), pass(1, "above", "")]);
        history.push(frame(&[1.0, 2.0]));
        history.first = 7;
        let at = |x: f32, y: f32| under(AREA, &history, 4.0, Pos2::new(x, y));
        let named = |x: f32, y: f32| at(x, y).map(|p| (p.frame, p.pass));
        assert_eq!(named(239.5, 90.0), Some((7, Some("below".into()))));
        assert_eq!(named(239.5, 40.0), Some((7, Some("above".into()))));
        assert_eq!(named(239.5, 10.0), Some((7, None)));
        assert!(at(100.0, 90.0).is_none() && at(260.0, 90.0).is_none());
        let mesh = mesh(AREA, &history, 4.0, None, Color32::RED);
        assert_eq!(mesh.vertices.len(), 8);
        assert_eq!(
            (mesh.vertices[0].pos, mesh.vertices[7].pos),
            (Pos2::new(236.0, 75.0), Pos2::new(240.0, 75.0))
        );
        assert_eq!(mesh.vertices[0].color, color("below"));
    }

    #[test]
    fn a_spike_is_cut_off_with_a_mark() {
        let mut history = History::new(vec![pass(0, "one", "")]);
        for ms in [2.0, 2.0, 90.0, 2.0] {
            history.push(frame(&[ms]));
        }
        let mesh = mesh(AREA, &history, 4.0, None, Color32::RED);
        let marks = mesh.vertices.iter().filter(|v| v.color == Color32::RED);
        let places: Vec<Pos2> = marks.map(|v| v.pos).collect();
        assert_eq!(places[0], Pos2::new(232.0, 0.0));
        assert_eq!(places[3], Pos2::new(236.0, CUT));
        assert_eq!([1, 60, 61, 240].map(slots), [60, 60, 120, 240]);
        assert_eq!(places.len(), 4, "one frame of four");
    }
}
