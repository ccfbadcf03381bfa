//! The histogram as lines.

use super::statistics::BINS;
use super::work::Done;
use egui::{Align2, Color32, Pos2, Sense, Shape, Stroke, Ui, Vec2};

const COLORS: [Color32; 4] = [
    Color32::from_rgb(235, 80, 70),
    Color32::from_rgb(90, 200, 90),
    Color32::from_rgb(90, 140, 255),
    Color32::from_rgb(190, 190, 190),
];

/// Draws it: a line a channel, logarithm of the counts upwards, the range from black to white to
/// the right.
pub fn show(ui: &mut Ui, done: &Done) {
    let (rect, response) =
        ui.allocate_exact_size(Vec2::new(ui.available_width(), 80.0), Sense::hover());
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, 0.0, ui.visuals().extreme_bg_color);
    let most = done.histogram.iter().flatten().copied().max().unwrap_or(0);
    let scale = (rect.height() - 4.0) / (f64::from(most) + 1.0).ln().max(1e-9) as f32;
    for (bins, color) in done.histogram.iter().zip(COLORS) {
        let points: Vec<Pos2> = bins
            .iter()
            .enumerate()
            .map(|(i, n)| {
                let x = rect.left() + rect.width() * (i as f32 + 0.5) / BINS as f32;
                Pos2::new(
                    x,
                    rect.bottom() - 1.0 - (f64::from(*n) + 1.0).ln() as f32 * scale,
                )
            })
            .collect();
        painter.add(Shape::line(points, Stroke::new(1.0, color)));
    }
    let weak = ui.visuals().weak_text_color();
    let font = egui::TextStyle::Small.resolve(ui.style());
    let (low, high) = (
        done.tone.low.min(done.tone.high),
        done.tone.low.max(done.tone.high),
    );
    painter.text(
        rect.left_top() + Vec2::new(2.0, 0.0),
        Align2::LEFT_TOP,
        format!("peak {most} texels"),
        font,
        weak,
    );
    let Some(at) = response.hover_pos() else {
        return;
    };
    let bin = (((at.x - rect.left()) / rect.width() * BINS as f32) as usize).min(BINS - 1);
    let value = |i: usize| low + (high - low) * i as f32 / BINS as f32;
    let counts: Vec<String> = ["R", "G", "B", "A"]
        .iter()
        .zip(&done.histogram)
        .map(|(n, h)| format!("{n} {}", h[bin]))
        .collect();
    response.on_hover_text_at_pointer(format!(
        "{} to {}\n{}",
        value(bin),
        value(bin + 1),
        counts.join("  ")
    ));
}
