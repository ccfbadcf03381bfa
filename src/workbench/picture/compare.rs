//! A and B side by side: how the two are shown, and how far they are apart.

use crate::metrics::colour::srgb_to_linear;
use crate::metrics::maps::magma;
use rayon::prelude::*;
use std::sync::Arc;

/// How A and B are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// A left and B right of a line that can be moved.
    #[default]
    Split,
    /// One of them; a key changes which.
    Flip,
    /// Side by side.
    Side,
    /// Absolute difference of the display values.
    Difference,
    /// Perceived difference, FLIP (Andersson et al. 2020).
    Perceived,
}

/// Names of the modes.
pub const MODES: [(Mode, &str); 5] = [
    (Mode::Split, "split"),
    (Mode::Flip, "toggle"),
    (Mode::Side, "side by side"),
    (Mode::Difference, "difference"),
    (Mode::Perceived, "FLIP error"),
];

impl Mode {
    /// The mode after this one; the first after the last.
    pub fn next(self) -> Mode {
        let at = MODES.iter().position(|(mode, _)| *mode == self);
        MODES[at.map_or(0, |at| (at + 1) % MODES.len())].0
    }
}

/// A picture to compare: 8-bit RGBA.
#[derive(Clone)]
pub struct Shown {
    /// Width and height.
    pub size: [u32; 2],
    /// Pixels.
    pub bytes: Arc<Vec<u8>>,
}

/// A map of differences and its statistics.
pub struct Map {
    /// RGBA.
    pub bytes: Arc<Vec<u8>>,
    /// Width and height.
    pub size: [u32; 2],
    /// Mean over the picture: of the absolute difference (0 to 255), or of FLIP (0 to 1).
    pub mean: f64,
    /// Largest.
    pub max: f64,
    /// Pixels that differ at all.
    pub differing: usize,
}

/// Absolute difference of each channel, multiplied by `gain` to be seen.
pub fn difference(a: &Shown, b: &Shown, gain: u32) -> Option<Map> {
    if a.size != b.size || a.bytes.len() != b.bytes.len() {
        return None;
    }
    let mut bytes = vec![255; a.bytes.len()];
    let rows = a.size[0].max(1) as usize * 4;
    let parts: Vec<(u64, u8, usize)> = bytes
        .par_chunks_mut(rows)
        .zip(a.bytes.par_chunks(rows).zip(b.bytes.par_chunks(rows)))
        .map(|(out, (a, b))| {
            let (mut sum, mut max, mut differing) = (0, 0, 0);
            for ((out, a), b) in out
                .chunks_exact_mut(4)
                .zip(a.chunks_exact(4))
                .zip(b.chunks_exact(4))
            {
                let mut any = false;
                for c in 0..3 {
                    let d = a[c].abs_diff(b[c]);
                    sum += u64::from(d);
                    max = max.max(d);
                    any |= d != 0;
                    out[c] = u8::try_from(u32::from(d).saturating_mul(gain)).unwrap_or(255);
                }
                differing += usize::from(any);
            }
            (sum, max, differing)
        })
        .collect();
    let count = (a.bytes.len() / 4 * 3).max(1);
    Some(Map {
        size: a.size,
        mean: parts.iter().map(|p| p.0).sum::<u64>() as f64 / count as f64,
        max: f64::from(parts.iter().map(|p| p.1).max().unwrap_or(0)),
        differing: parts.iter().map(|p| p.2).sum(),
        bytes: Arc::new(bytes),
    })
}

/// A and B in one picture: A left and B right of a line, side by side, or the one that is shown.
pub fn joined(a: &Shown, b: &Shown, mode: Mode, split: f32, flipped: bool) -> Shown {
    let row = |s: &Shown, y: u32| {
        let width = 4 * s.size[0] as usize;
        let start = y as usize * width;
        s.bytes.get(start..start + width).unwrap_or(&[]).to_vec()
    };
    match mode {
        Mode::Side if a.size[1] == b.size[1] => {
            let bytes = (0..a.size[1])
                .flat_map(|y| [row(a, y), row(b, y)].concat())
                .collect();
            Shown {
                size: [a.size[0] + b.size[0], a.size[1]],
                bytes: Arc::new(bytes),
            }
        }
        Mode::Split if a.size == b.size => {
            let line = 4 * (split.clamp(0.0, 1.0) * a.size[0] as f32).round() as usize;
            let bytes = (0..a.size[1])
                .flat_map(|y| [&row(a, y)[..line], &row(b, y)[line..]].concat())
                .collect();
            Shown {
                size: a.size,
                bytes: Arc::new(bytes),
            }
        }
        Mode::Flip if flipped => b.clone(),
        _ => a.clone(),
    }
}

/// FLIP of the two pictures, A as the reference, in the colours of the magma map.
pub fn flip(a: &Shown, b: &Shown) -> Option<Map> {
    if a.size != b.size || a.bytes.len() != b.bytes.len() || a.size.contains(&0) {
        return None;
    }
    let linear = |s: &Shown| -> Vec<[f32; 3]> {
        let pixels = s.bytes.par_chunks_exact(4);
        pixels
            .map(|p| [p[0], p[1], p[2]].map(|v| srgb_to_linear(f32::from(v) / 255.0)))
            .collect()
    };
    let values = crate::metrics::flip::flip(&linear(b), &linear(a), a.size[0] as usize);
    let colour = |v: &f32| {
        let [r, g, b] = magma(f64::from(*v));
        [r, g, b, 255]
    };
    Some(Map {
        size: a.size,
        mean: values.iter().map(|v| f64::from(*v)).sum::<f64>() / values.len().max(1) as f64,
        max: values.iter().copied().map(f64::from).fold(0.0, f64::max),
        differing: values.iter().filter(|v| **v > 0.0).count(),
        bytes: Arc::new(values.par_iter().flat_map_iter(colour).collect()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(pixels: &[[u8; 4]]) -> Shown {
        Shown {
            size: [pixels.len() as u32, 1],
            bytes: Arc::new(pixels.concat()),
        }
    }

    #[test]
    fn equal_pictures_differ_nowhere() {
        let a = shown(&[[10, 20, 30, 255], [0, 0, 0, 255]]);
        let map = difference(&a, &a, 1).unwrap();
        assert_eq!((map.mean, map.max, map.differing), (0.0, 0.0, 0));
        let map = flip(&a, &a).unwrap();
        assert_eq!((map.mean, map.differing), (0.0, 0));
    }

    #[test]
    fn pictures_are_joined_as_they_are_compared() {
        let a = shown(&[[1; 4], [2; 4], [3; 4], [4; 4]]);
        let b = shown(&[[5; 4], [6; 4], [7; 4], [8; 4]]);
        let first = |s: Shown| {
            (
                s.size,
                s.bytes.iter().step_by(4).copied().collect::<Vec<u8>>(),
            )
        };
        assert_eq!(
            first(joined(&a, &b, Mode::Split, 0.25, false)),
            ([4, 1], vec![1, 6, 7, 8])
        );
        assert_eq!(
            first(joined(&a, &b, Mode::Side, 0.5, false)),
            ([8, 1], vec![1, 2, 3, 4, 5, 6, 7, 8])
        );
        assert_eq!(
            first(joined(&a, &b, Mode::Flip, 0.5, true)),
            ([4, 1], vec![5, 6, 7, 8])
        );
    }

    #[test]
    fn the_difference_is_absolute_and_scaled_only_for_the_eye() {
        let a = shown(&[[10, 20, 30, 255], [5, 5, 5, 255]]);
        let b = shown(&[[13, 20, 26, 255], [5, 5, 5, 255]]);
        let map = difference(&a, &b, 10).unwrap();
        assert_eq!((map.max, map.differing), (4.0, 1));
        assert!((map.mean - 7.0 / 6.0).abs() < 1e-9);
        assert_eq!(map.bytes[..4], [30, 0, 40, 255]);
        assert!(difference(&a, &shown(&[[0; 4]]), 1).is_none());
    }
}
