//! Frames of the interface, for each host: a new layout, or the last one with new pictures.

use crate::vulkan::{Painter, Pixels, VulkanError};
use crate::workbench::{NewPixels, PICTURES, Workbench};
use egui::epaint::textures::TexturesDelta;
use egui::epaint::{ClippedPrimitive, ClippedShape};
use std::time::{Duration, Instant};

/// A layout serves for this long while pictures stream in: it costs far more than painting does, and
/// numbers that change faster cannot be read.
pub const LAYOUT_INTERVAL: Duration = Duration::from_millis(33);

/// The last layout, in triangles.
#[derive(Default)]
pub struct Frame {
    primitives: Vec<ClippedPrimitive>,
    scale: f32,
    laid_out: Option<Instant>,
    /// Width and height of the pictures as last painted.
    sizes: [Option<[u32; 2]>; PICTURES],
}

impl Frame {
    /// Takes the shapes of a new layout.
    pub fn lay_out(&mut self, context: &egui::Context, shapes: Vec<ClippedShape>, scale: f32) {
        self.primitives = context.tessellate(shapes, scale);
        self.scale = scale;
        self.laid_out = Some(Instant::now());
    }

    /// Something other than new pictures came: the next frame needs a new layout.
    pub fn outdate(&mut self) {
        self.laid_out = None;
    }

    /// How long the layout serves on, if all that is new are pictures of the sizes it was made for.
    pub fn serves(&self, new: &[NewPixels]) -> Option<Duration> {
        let fits = |p: &NewPixels| self.sizes.get(p.picture) == Some(&Some(p.size));
        let left = LAYOUT_INTERVAL.checked_sub(self.laid_out?.elapsed())?;
        (!new.is_empty() && new.iter().all(fits)).then_some(left)
    }

    /// Paints the layout with the workbench's new pictures.
    ///
    /// # Errors
    /// The device was lost; out of memory.
    pub fn paint(
        &mut self,
        painter: &mut Painter,
        size: (u32, u32),
        textures: TexturesDelta,
        workbench: &mut Workbench,
    ) -> Result<(), VulkanError> {
        let new = workbench.pixels();
        let pixels: Vec<Pixels<'_>> = new.iter().filter_map(NewPixels::source).collect();
        let painted = painter.paint(size, self.scale, textures, &self.primitives, &pixels)?;
        drop(pixels);
        if painted {
            for p in new {
                if let Some(kept) = self.sizes.get_mut(p.picture) {
                    *kept = Some(p.size);
                }
            }
            workbench.painted();
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(picture: usize, size: [u32; 2]) -> NewPixels {
        NewPixels {
            picture,
            size,
            bytes: None,
            shared: None,
        }
    }

    #[test]
    fn a_layout_serves_for_pictures_that_it_knows_alone() {
        let mut frame = Frame::default();
        let known = || picture(0, [8, 4]);
        assert_eq!(frame.serves(&[known()]), None);
        let context = egui::Context::default();
        let _ = context.run_ui(egui::RawInput::default(), |_| {});
        frame.lay_out(&context, Vec::new(), 1.0);
        frame.sizes[0] = Some([8, 4]);
        assert!(frame.serves(&[known()]).is_some());
        assert_eq!(frame.serves(&[]), None, "nothing new: an input, or time");
        assert_eq!(frame.serves(&[picture(0, [8, 5])]), None, "another size");
        assert_eq!(
            frame.serves(&[known(), picture(1, [8, 4])]),
            None,
            "a picture that was not shown"
        );
        frame.outdate();
        assert_eq!(frame.serves(&[known()]), None, "an input");
        frame.laid_out = Instant::now().checked_sub(LAYOUT_INTERVAL);
        assert_eq!(frame.serves(&[known()]), None, "too old");
    }
}
