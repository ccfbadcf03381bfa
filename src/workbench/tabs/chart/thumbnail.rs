//! Details of the dot under the pointer, with its picture.

use crate::campaign::report::Dot;
use crate::workbench::background::{Background, Wake};
use egui::{ColorImage, Response, TextureHandle};

/// The picture of the last dot that was pointed at.
#[derive(Default)]
pub struct Thumbnail {
    /// Number of the dot.
    of: String,
    texture: Option<TextureHandle>,
    work: Background<String, Option<ColorImage>>,
}

impl Thumbnail {
    /// Shows a dot at the pointer: picture, parameters, time, error.
    pub fn show(&mut self, chart: &Response, dot: &Dot, title: &str, error: f64, wake: &Wake) {
        while let Some((id, image)) = self.work.take() {
            if let Some(image) = image.ok().flatten().filter(|_| id == self.of) {
                self.texture = Some(chart.ctx.load_texture(
                    "dot",
                    image,
                    egui::TextureOptions::LINEAR,
                ));
            }
        }
        if self.of != dot.id {
            self.of.clone_from(&dot.id);
            self.texture = None;
            if let Some(bytes) = dot.picture.clone() {
                self.work
                    .start(dot.id.clone(), wake, move || decoded(&bytes));
            }
        }
        let texture = self.texture.clone();
        // Next to the chart: at the pointer it would cover other dots.
        chart.clone().on_hover_ui(|ui| {
            if let Some(texture) = &texture {
                ui.image((texture.id(), texture.size_vec2()));
            }
            ui.strong(format!("{:.3} ms, {title} {error:.4e}", dot.ms));
            for (name, value) in &dot.labels {
                ui.label(format!("{name}: {value}"));
            }
            for warning in &dot.warnings {
                ui.weak(warning);
            }
            ui.weak("click to load it");
        });
    }
}

/// A picture that comes from a file: bounded.
fn decoded(bytes: &[u8]) -> Option<ColorImage> {
    let mut reader = image::ImageReader::new(std::io::Cursor::new(bytes))
        .with_guessed_format()
        .ok()?;
    let mut limits = image::Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(4096), Some(4096));
    reader.limits(limits);
    let image = reader.decode().ok()?.thumbnail(256, 256).to_rgba8();
    Some(ColorImage::from_rgba_unmultiplied(
        [image.width() as usize, image.height() as usize],
        &image,
    ))
}
