//! The texts of a frame as they are painted, to measure how legible they are.

use egui::epaint::{ClippedShape, TextShape};
use egui::{Color32, Rect, Shape};
use serde::Serialize;

/// A text of a frame.
#[derive(Debug, Serialize)]
pub struct Text {
    /// Its characters.
    pub text: String,
    /// Height of its smallest font, points.
    pub points: f32,
    /// RGBA of the glyphs, premultiplied by alpha (sRGB, 8 bits each).
    pub color: [u8; 4],
    /// The visible part: left, top, right, bottom; pixels.
    pub place: [f32; 4],
}

/// The visible texts among the shapes of a frame. `scale`: pixels a point.
pub fn texts(shapes: &[ClippedShape], scale: f32) -> Vec<Text> {
    let mut list = Vec::new();
    for shape in shapes {
        collect(&shape.shape, shape.clip_rect, scale, &mut list);
    }
    list
}

fn collect(shape: &Shape, clip: Rect, scale: f32, list: &mut Vec<Text>) {
    match shape {
        Shape::Vec(shapes) => shapes
            .iter()
            .for_each(|shape| collect(shape, clip, scale, list)),
        Shape::Text(text) => list.extend(painted(text, clip, scale)),
        _ => {}
    }
}

/// A text, if most of it is visible.
fn painted(shape: &TextShape, clip: Rect, scale: f32) -> Option<Text> {
    let whole = Rect::from_min_size(shape.pos, shape.galley.size());
    let seen = whole.intersect(clip);
    let text = shape.galley.text().trim().to_string();
    if !seen.is_positive() || seen.area() < 0.6 * whole.area() || text.is_empty() {
        return None;
    }
    let sections = &shape.galley.job.sections;
    let color = shape.override_text_color.or_else(|| {
        let color = sections.first()?.format.color;
        Some(match color == Color32::PLACEHOLDER {
            true => shape.fallback_color,
            false => color,
        })
    })?;
    let sizes = sections.iter().map(|section| section.format.font_id.size);
    Some(Text {
        text,
        points: sizes.fold(f32::INFINITY, f32::min),
        color: color.gamma_multiply(shape.opacity_factor).to_array(),
        place: [seen.min.x, seen.min.y, seen.max.x, seen.max.y].map(|v| v * scale),
    })
}
