//! A frame as pictures side by side.

use super::series::Known;
use crate::lab::LabError;
use crate::metrics::colour::display;
use crate::metrics::{Kind, Linear};
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};

/// Least width of a panel, pixels. Smaller pictures are enlarged without smoothing.
const WIDTH: usize = 240;
/// White between panels, pixels.
const GAP: usize = 4;

/// Pictures of one size, displayed, and a difference.
pub(super) struct Panels {
    size: (usize, usize),
    pictures: Vec<(&'static str, Vec<[f64; 3]>)>,
    difference: Vec<f64>,
}

impl Panels {
    /// Frame before, frame, reference and difference, as radiance. With a frame before, the
    /// difference is between the changes, otherwise between the pictures.
    pub fn new(before: Option<&Linear>, x: &Linear, known: Known) -> Panels {
        let (reference, reference_before) = match known {
            Known::Reference { now, before } => (Some(&now.mean), before.map(|b| &b.mean)),
            Known::Nothing { .. } => (None, None),
        };
        let shown = |p: &Linear| -> Vec<[f64; 3]> {
            p.rgb
                .iter()
                .map(|c| c.map(|v| display(Kind::Radiance, if v.is_finite() { v } else { 0.0 })))
                .collect()
        };
        let now = shown(x);
        let mean =
            |list: &[[f64; 3]], i: usize| list.get(i).map_or(0.0, |c| (c[0] + c[1] + c[2]) / 3.0);
        let mut difference: Vec<f64> = (0..now.len()).map(|i| mean(&now, i)).collect();
        let mut pictures = Vec::new();
        let mut less = |list: &[[f64; 3]], sign: f64| {
            difference
                .iter_mut()
                .enumerate()
                .for_each(|(i, d)| *d -= sign * mean(list, i));
        };
        let reference = reference.map(shown);
        match before.map(shown) {
            Some(before) => {
                less(&before, 1.0);
                if let (Some(r), Some(old)) = (&reference, reference_before.map(shown)) {
                    less(r, 1.0);
                    less(&old, -1.0);
                }
                pictures.push(("the frame before", before));
            }
            None => less(reference.as_deref().unwrap_or(&now), 1.0),
        }
        pictures.push(("the frame", now));
        pictures.extend(reference.map(|t| ("reference", t)));
        Panels {
            size: (x.size.0 as usize, x.size.1 as usize),
            pictures,
            difference,
        }
    }

    /// Names of the panels, from the left.
    pub fn names(&self) -> Vec<String> {
        let last = if self.pictures[0].0 == "the frame before" {
            "change against the reference's"
        } else {
            "difference"
        };
        self.pictures
            .iter()
            .map(|p| p.0)
            .chain([last])
            .map(String::from)
            .collect()
    }

    /// Value of full red (brighter) and blue (darker), 1/255.
    pub fn full(&self) -> f64 {
        255.0 * self.difference.iter().map(|d| d.abs()).fold(0.0, f64::max)
    }

    /// The panels in one row, PNG.
    pub fn png(&self) -> Result<Vec<u8>, LabError> {
        let most = (self.full() / 255.0).max(1e-9);
        let signed = |d: &f64| {
            let t = (d / most).clamp(-1.0, 1.0);
            if t > 0.0 {
                [1.0, 1.0 - t, 1.0 - t]
            } else {
                [1.0 + t, 1.0 + t, 1.0]
            }
        };
        let difference: Vec<[f64; 3]> = self.difference.iter().map(signed).collect();
        let (width, height) = self.size;
        let scale = WIDTH.div_ceil(width.max(1)).max(1);
        let panels: Vec<&Vec<[f64; 3]>> = self
            .pictures
            .iter()
            .map(|p| &p.1)
            .chain([&difference])
            .collect();
        let row = panels.len() * (width * scale + GAP) - GAP;
        let mut bytes = vec![255u8; row * height * scale * 3];
        for (p, panel) in panels.iter().enumerate() {
            let left = p * (width * scale + GAP);
            for y in 0..height * scale {
                for x in 0..width * scale {
                    let texel = panel[y / scale * width + x / scale];
                    let at = 3 * (y * row + left + x);
                    for (byte, v) in bytes[at..at + 3].iter_mut().zip(texel) {
                        *byte = (v.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
                    }
                }
            }
        }
        let failed = |e: &dyn std::fmt::Display| {
            LabError::Request(format!("cannot make the worst frame's picture: {e}"))
        };
        let (w, h) = (
            u32::try_from(row).map_err(|e| failed(&e))?,
            u32::try_from(height * scale).map_err(|e| failed(&e))?,
        );
        let mut out = Vec::new();
        PngEncoder::new(&mut out)
            .write_image(&bytes, w, h, ExtendedColorType::Rgb8)
            .map_err(|e| failed(&e))?;
        Ok(out)
    }
}
