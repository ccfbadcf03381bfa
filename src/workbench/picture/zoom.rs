//! Zoom and pan of the picture on the screen, without the camera; and the pixel under the pointer.

use crate::metrics::colour::srgb_to_linear;
use crate::workbench::engine::report::PictureReport;
use egui::{Align2, Color32, FontId, Pos2, Rect, Response, Ui, Vec2};

/// Zoom and pan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zoom {
    /// Times the size that fits.
    factor: f32,
    /// Place of the picture, 0 to 1, at the middle of the viewport.
    centre: Vec2,
}

impl Default for Zoom {
    fn default() -> Zoom {
        Zoom {
            factor: 1.0,
            centre: Vec2::splat(0.5),
        }
    }
}

impl Zoom {
    /// Whether it shows the picture as it fits.
    pub fn is_whole(&self) -> bool {
        self.factor == 1.0
    }

    /// Where the picture is, which would fit into `fitting`; texels from twice their size on have
    /// whole sizes.
    pub fn place(&self, fitting: Rect, width: u32, scale: f32) -> Rect {
        if self.is_whole() {
            return fitting;
        }
        let texel = fitting.width() * scale / width.max(1) as f32 * self.factor;
        let texel = if texel >= 2.0 { texel.round() } else { texel };
        let size =
            fitting.size() * (texel * width.max(1) as f32 / (fitting.width() * scale).max(1.0));
        let min = fitting.center() - size * self.centre;
        Rect::from_min_size((min.to_vec2() * scale).round().to_pos2() / scale, size)
    }

    /// Ctrl and the wheel change the size about the pointer, Ctrl and a drag move, a double click
    /// shows all. Whether the mouse is taken from the camera.
    pub fn steer(&mut self, ui: &Ui, response: &Response, shown: Rect) -> bool {
        if response.double_clicked() && !self.is_whole() {
            *self = Zoom::default();
            return true;
        }
        let factor = if response.hovered() {
            ui.input(egui::InputState::zoom_delta)
        } else {
            1.0
        };
        if let Some(at) = response.hover_pos().filter(|_| factor != 1.0) {
            let under = (at - shown.min) / shown.size();
            let before = self.factor;
            self.factor = (self.factor * factor).clamp(1.0, 64.0);
            if self.factor == 1.0 {
                *self = Zoom::default();
            } else {
                // The point under the pointer stays there.
                let grown = self.factor / before;
                self.centre = under + (self.centre - under) / grown;
            }
        }
        let held = ui.input(|i| i.modifiers.command);
        if held && response.dragged() {
            self.centre -= response.drag_delta() / shown.size();
        }
        self.centre = self.centre.clamp(Vec2::ZERO, Vec2::splat(1.0));
        held || factor != 1.0
    }
}

/// Place and display values of a pixel.
pub fn pixel_text(picture: &PictureReport, at: Vec2) -> Option<String> {
    let [width, height] = picture.size;
    if at.x < 0.0 || at.y < 0.0 || at.x >= width as f32 || at.y >= height as f32 {
        return None;
    }
    let (x, y) = (at.x as usize, at.y as usize);
    let first = 4 * (y * width as usize + x);
    let rgb = picture.bytes.as_ref()?.get(first..first + 3)?;
    let linear = rgb
        .iter()
        .map(|v| format!("{:.3}", linear(*v)))
        .collect::<Vec<_>>()
        .join(" ");
    Some(format!(
        "{x}, {y}   {} {} {}   {linear}",
        rgb[0], rgb[1], rgb[2]
    ))
}

/// The light that the screen gives for a value, 0 to 1 (sRGB, IEC 61966-2-1).
fn linear(value: u8) -> f32 {
    srgb_to_linear(f32::from(value) / 255.0)
}

/// A line of text on dark ground at the lower left of `area`.
pub fn foot(painter: &egui::Painter, area: Rect, text: String) {
    let galley = painter.layout_no_wrap(text, FontId::monospace(13.0), Color32::WHITE);
    let rect =
        Align2::LEFT_BOTTOM.anchor_size(area.left_bottom(), galley.size() + Vec2::splat(6.0));
    painter.rect_filled(rect, 2.0, Color32::from_black_alpha(225));
    painter.galley(rect.min + Vec2::splat(3.0), galley, Color32::WHITE);
}

/// The pixel of a picture at a point of the screen.
pub fn pixel_at(shown: Rect, size: [u32; 2], at: Pos2) -> Vec2 {
    (at - shown.min) / shown.size() * Vec2::new(size[0] as f32, size[1] as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::run::FrameTimes;
    use std::sync::Arc;

    #[test]
    fn zoomed_texels_have_whole_sizes_and_the_middle_stays() {
        let fitting = Rect::from_min_size(Pos2::new(10.0, 20.0), Vec2::new(320.0, 240.0));
        assert_eq!(Zoom::default().place(fitting, 160, 1.0), fitting);
        let zoom = Zoom {
            factor: 1.6,
            ..Zoom::default()
        };
        let place = zoom.place(fitting, 160, 1.0);
        assert_eq!((place.width(), place.height()), (480.0, 360.0));
        assert_eq!(place.center(), fitting.center());
    }

    #[test]
    fn a_pixel_says_its_place_and_its_values() {
        let picture = PictureReport {
            side: 0,
            request: 0,
            revision: 0,
            preview: false,
            frame: 0,
            time: 0.0,
            size: [2, 1],
            finished: std::time::Instant::now(),
            left: 0,
            asked: 0,
            bytes: Some(Arc::new(vec![0, 0, 0, 255, 255, 188, 0, 255])),
            shared: None,
            times: FrameTimes::default(),
        };
        let text = pixel_text(&picture, Vec2::new(1.5, 0.5));
        assert_eq!(
            text.as_deref(),
            Some("1, 0   255 188 0   1.000 0.503 0.000")
        );
        assert_eq!(pixel_text(&picture, Vec2::new(2.0, 0.0)), None);
    }
}
