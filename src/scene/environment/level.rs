//! Pictures of all directions, and their means over larger texels.

use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Linear RGB of all directions.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Level {
    pub width: u32,
    pub height: u32,
    /// Row by row.
    pub texels: Vec<[f32; 3]>,
}

impl Level {
    /// Solid angle of a texel in a row (sr).
    pub fn solid_angle(&self, row: u32) -> f64 {
        let edge = |row: u32| (PI * f64::from(row) / f64::from(self.height)).cos();
        TAU / f64::from(self.width) * (edge(row) - edge(row + 1))
    }

    /// The same picture with at most as many texels, each the mean over the directions that it
    /// covers.
    pub fn reduced(&self, width: u32, height: u32) -> Level {
        let (columns, rows) = (covered(self.width, width), covered(self.height, height));
        let row = |covers: &Vec<(u32, f64, f64)>| {
            let mean = |columns: &Vec<(u32, f64, f64)>| {
                let (mut sum, mut weights) = ([0.0f64; 3], 0.0);
                for &(y, top, bottom) in covers {
                    // Solid angle is proportional to the cosine of the polar angle, so a part of a
                    // row is the difference at its edges.
                    let edge = |y: f64| (PI * y / f64::from(self.height)).cos();
                    let tall = edge(top) - edge(bottom);
                    for &(x, left, right) in columns {
                        let weight = tall * (right - left);
                        let texel = self.texels[(y * self.width + x) as usize];
                        (0..3).for_each(|i| sum[i] += weight * f64::from(texel[i]));
                        weights += weight;
                    }
                }
                sum.map(|s| (s / weights) as f32)
            };
            columns.iter().map(mean).collect::<Vec<_>>()
        };
        Level {
            width,
            height,
            texels: rows.par_iter().flat_map_iter(row).collect(),
        }
    }

    /// This level and all coarser ones, down to one texel.
    pub fn chain(self) -> Vec<Level> {
        let mut levels = vec![self];
        while let Some(last) = levels.last().filter(|l| l.width > 1 || l.height > 1) {
            let coarser = last.reduced((last.width / 2).max(1), (last.height / 2).max(1));
            levels.push(coarser);
        }
        levels
    }
}

/// For each of `to` equal intervals over `from` texels: the overlapped texels with the start and
/// end of the overlap.
fn covered(from: u32, to: u32) -> Vec<Vec<(u32, f64, f64)>> {
    let size = f64::from(from) / f64::from(to);
    let part = |i: u32| {
        let (start, end) = (f64::from(i) * size, f64::from(i + 1) * size);
        let texels = start as u32..(end.ceil() as u32).min(from);
        let inside = |x: u32| (x, start.max(f64::from(x)), end.min(f64::from(x) + 1.0));
        texels.map(inside).filter(|(_, a, b)| b > a).collect()
    };
    (0..to).map(part).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mean(level: &Level) -> f64 {
        let value = |(i, c): (usize, &[f32; 3])| {
            level.solid_angle(i as u32 / level.width) * f64::from(c[1])
        };
        level.texels.iter().enumerate().map(value).sum::<f64>() / (4.0 * PI)
    }

    #[test]
    fn every_level_has_the_mean_over_all_directions() {
        for (width, height) in [(64, 32), (37, 19), (5, 1), (1, 1)] {
            let texel = |i: u32| [0.0, ((i * 7919) % 101 + 1) as f32, 1.0];
            let level = Level {
                width,
                height,
                texels: (0..width * height).map(texel).collect(),
            };
            let expected = mean(&level);
            let levels = level.chain();
            let [.., last] = &levels[..] else {
                panic!("no levels")
            };
            assert_eq!((last.width, last.height), (1, 1));
            for level in &levels {
                assert!(
                    (mean(level) / expected - 1.0).abs() < 1e-5,
                    "{}x{}",
                    level.width,
                    level.height
                );
                assert!(
                    level
                        .texels
                        .iter()
                        .all(|t| t[0] == 0.0 && (t[2] - 1.0).abs() < 1e-6)
                );
            }
        }
    }
}
