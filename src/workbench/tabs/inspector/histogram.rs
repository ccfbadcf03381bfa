//! The histogram as lines, with handles for black and white.

use super::image::Tone;
use super::statistics::BINS;
use super::work::Done;
use crate::workbench::panel::control::named;
use crate::workbench::theme;
use egui::{Align2, Color32, Pos2, Rect, Sense, Shape, Stroke, Ui, Vec2};

const COLORS: [Color32; 4] = [
    Color32::from_rgb(235, 80, 70),
    Color32::from_rgb(90, 200, 90),
    Color32::from_rgb(90, 140, 255),
    Color32::from_rgb(190, 190, 190),
];

/// Draws it: a line a channel, the logarithm of the counts upwards. Drags of the two handles change
/// the values that are black and white.
pub fn show(ui: &mut Ui, done: &Done, tone: &mut Tone) {
    let (rect, response) =
        ui.allocate_exact_size(Vec2::new(ui.available_width(), 88.0), Sense::hover());
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, 0.0, ui.visuals().extreme_bg_color);
    let most = done.histogram.iter().flatten().copied().max().unwrap_or(0);
    let scale = (rect.height() - 18.0) / (f64::from(most) + 1.0).ln().max(1e-9) as f32;
    for (bins, color) in done.histogram.iter().zip(COLORS) {
        let points: Vec<Pos2> = bins
            .iter()
            .enumerate()
            .map(|(i, n)| {
                let x = rect.left() + rect.width() * (i as f32 + 0.5) / BINS as f32;
                let up = (f64::from(*n) + 1.0).ln() as f32 * scale;
                Pos2::new(x, rect.bottom() - 1.0 - up)
            })
            .collect();
        painter.add(Shape::line(points, Stroke::new(1.0, color)));
    }
    let font = egui::TextStyle::Small.resolve(ui.style());
    let corner = rect.left_top() + Vec2::new(6.0, 0.0);
    let text = format!("peak {most} texels");
    let weak = ui.visuals().weak_text_color();
    painter.text(corner, Align2::LEFT_TOP, text, font, weak);
    let [low, high] = done.span;
    if let Some(at) = response.hover_pos() {
        let part = ((at.x - rect.left()) / rect.width()).clamp(0.0, 1.0);
        let bin = ((part * BINS as f32) as usize).min(BINS - 1);
        let value = |i: usize| low + (high - low) * i as f32 / BINS as f32;
        let names = ["R", "G", "B", "A"].iter().zip(&done.histogram);
        let counts: Vec<String> = names.map(|(n, h)| format!("{n} {}", h[bin])).collect();
        let (from, to) = (value(bin), value(bin + 1));
        response.on_hover_text_at_pointer(format!("{from} to {to}\n{}", counts.join("  ")));
    }
    let black = handle(ui, rect, done.span, &mut tone.low, "black");
    let white = handle(ui, rect, done.span, &mut tone.high, "white");
    let accent = theme::roles(ui).accent;
    let range = Rect::from_x_y_ranges(black.min(white)..=black.max(white), rect.y_range());
    painter.rect_filled(range, 0.0, accent.gamma_multiply(0.12));
    for x in [black, white] {
        painter.vline(x, rect.y_range(), Stroke::new(2.0, accent));
    }
}

/// Half the width of a handle, points.
const GRIP: f32 = 5.0;

/// A vertical line that can be dragged; where it is.
fn handle(ui: &Ui, rect: Rect, [low, high]: [f32; 2], value: &mut f32, name: &str) -> f32 {
    let width = (high - low).max(f32::MIN_POSITIVE);
    let inside = rect.x_range().shrink(1.0);
    let place = |value: f32| inside.clamp(rect.left() + rect.width() * (value - low) / width);
    let x = place(*value);
    let grip = Rect::from_x_y_ranges(x - GRIP..=x + GRIP, rect.y_range());
    let response = ui.interact(grip, ui.id().with(("histogram", name)), Sense::drag());
    named(
        &response,
        egui::WidgetType::Slider,
        &format!("histogram {name}"),
    );
    if let Some(at) = response
        .interact_pointer_pos()
        .filter(|_| response.dragged())
    {
        *value = low + width * ((at.x - rect.left()) / rect.width()).clamp(0.0, 1.0);
    }
    let cursor = egui::CursorIcon::ResizeHorizontal;
    response
        .on_hover_cursor(cursor)
        .on_hover_text(format!("Drag: the value that is {name}"));
    place(*value)
}
