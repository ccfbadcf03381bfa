//! The structure error: edges in the lighting that the reference does not have, or has elsewhere.
//!
//! Both pictures are converted to log luminance, in which differences between neighbours are
//! ratios. Albedo textures, common to both pictures, and a constant factor cancel. The remainder is
//! the slope of log(picture / reference).

use super::colour::luminance;
use super::{Linear, MetricError, check, dark, is_finite};
use rayon::prelude::*;

/// Side of the blocks with averaged luminance (pixels): four pixels halve the noise.
const BLOCK: usize = 2;

/// Difference with weight one half (natural log units), a step of 10 %. Larger differences count
/// nearly fully, smaller ones quadratically. The plain mean would be the total variation. It rates
/// a ramp over many blocks like an edge of the same height, and accumulates faint noise over the
/// frame.
const HALF: f64 = 0.1;

/// Error of each pair of neighbouring blocks (natural log units); NaN if a block has no finite
/// pixel.
pub(super) struct Structure {
    /// Width and height of the picture, pixels.
    size: (usize, usize),
    columns: usize,
    /// Between a block and its right neighbour, row by row.
    right: Vec<f32>,
    /// Between a block and the one below it.
    below: Vec<f32>,
}

/// The structure error alone.
///
/// # Errors
/// Pictures of different sizes, without pixels, or of more than `MAX_PIXELS`.
pub fn structure(test: &Linear, reference: &Linear) -> Result<f64, MetricError> {
    check(test, reference)?;
    Ok(Structure::new(test, reference, dark(test, reference), 1.0).mean(None))
}

/// The structure error caused by the reference's noise alone, from the means of two halves of its
/// samples. Half the difference of the halves is distributed like the error of their mean.
pub fn structure_noise(even: &Linear, odd: &Linear) -> Result<f64, MetricError> {
    check(even, odd)?;
    Ok(Structure::new(even, odd, dark(even, odd), 0.5).mean(None))
}

fn counted(difference: f64) -> f64 {
    let size = difference.abs();
    size * size / (size + HALF)
}

impl Structure {
    /// `dark` is added to the luminance before the logarithm; `factor` scales all differences.
    pub(super) fn new(test: &Linear, reference: &Linear, dark: f64, factor: f64) -> Structure {
        let size = (test.size.0 as usize, test.size.1 as usize);
        let columns = size.0.div_ceil(BLOCK);
        let (x, r) = (
            logarithms(test, reference, test, dark),
            logarithms(test, reference, reference, dark),
        );
        let pair = |a: usize, b: usize| counted(factor * ((x[b] - x[a]) - (r[b] - r[a]))) as f32;
        let all = || (0..x.len()).into_par_iter();
        let right = all()
            .map(|i| {
                if (i + 1) % columns == 0 {
                    f32::NAN
                } else {
                    pair(i, i + 1)
                }
            })
            .collect();
        let below = all()
            .map(|i| {
                if i + columns < x.len() {
                    pair(i, i + columns)
                } else {
                    f32::NAN
                }
            })
            .collect();
        Structure {
            size,
            columns,
            right,
            below,
        }
    }

    /// Mean over the pairs of blocks that have at least half of their pixels in the mask, or over
    /// all pairs; NaN without a pair.
    pub(super) fn mean(&self, mask: Option<&[bool]>) -> f64 {
        let within = mask.map(|mask| self.blocks(mask));
        let is_in = |block: usize| within.as_ref().is_none_or(|list| list[block]);
        let row = |first: usize| {
            let mut sums = (0.0, 0u64);
            for i in (first..first + self.columns).filter(|i| is_in(*i)) {
                for (value, other) in [(self.right[i], i + 1), (self.below[i], i + self.columns)] {
                    if !value.is_nan() && is_in(other) {
                        sums = (sums.0 + f64::from(value), sums.1 + 1);
                    }
                }
            }
            sums
        };
        // Row sums in order, so that the bits do not depend on the number of threads.
        let rows: Vec<(f64, u64)> = (0..self.right.len() / self.columns)
            .into_par_iter()
            .map(|y| row(y * self.columns))
            .collect();
        let (sum, pairs) = rows
            .iter()
            .fold((0.0, 0), |all, row| (all.0 + row.0, all.1 + row.1));
        sum / pairs as f64
    }

    /// For each pixel the mean over the pairs of its block.
    pub(super) fn map(&self) -> Vec<f32> {
        let block = |i: usize| {
            let left = if i.is_multiple_of(self.columns) {
                f32::NAN
            } else {
                self.right[i - 1]
            };
            let above = i
                .checked_sub(self.columns)
                .map_or(f32::NAN, |above| self.below[above]);
            let all = [self.right[i], self.below[i], left, above];
            let pairs = || all.iter().filter(|v| !v.is_nan());
            pairs().sum::<f32>() / pairs().count() as f32
        };
        let blocks: Vec<f32> = (0..self.right.len()).into_par_iter().map(block).collect();
        let (width, height) = self.size;
        (0..width * height)
            .map(|i| blocks[i / width / BLOCK * self.columns + i % width / BLOCK])
            .collect()
    }

    /// Whether at least half of each block's pixels are in a mask.
    fn blocks(&self, mask: &[bool]) -> Vec<bool> {
        let inside = |block: usize| {
            let pixels = || pixels(block, self.size.0, mask.len());
            2 * pixels().filter(|i| mask[*i]).count() >= pixels().count()
        };
        (0..self.right.len()).map(inside).collect()
    }
}

/// The pixel indices of a block; blocks at the right and lower border may be smaller.
fn pixels(block: usize, width: usize, count: usize) -> impl Iterator<Item = usize> {
    let columns = width.div_ceil(BLOCK);
    let (left, top) = (block % columns * BLOCK, block / columns * BLOCK);
    let rows = (top..top + BLOCK)
        .map(move |y| y * width)
        .take_while(move |row| *row < count);
    rows.flat_map(move |row| (row + left)..(row + (left + BLOCK).min(width)))
}

/// log(Y + dark) of each block of `picture`. Y is the non-negative mean luminance of the pixels
/// that are finite in both pictures; NaN without one.
fn logarithms(test: &Linear, reference: &Linear, picture: &Linear, dark: f64) -> Vec<f64> {
    let (width, height) = (picture.size.0 as usize, picture.size.1 as usize);
    let block = |block: usize| {
        let finite = || {
            let all = pixels(block, width, picture.rgb.len());
            all.filter(|i| is_finite(test.rgb[*i], reference.rgb[*i]))
        };
        let sum: f64 = finite().map(|i| luminance(picture.rgb[i])).sum();
        let mean = sum.max(0.0) / finite().count() as f64;
        if dark > 0.0 {
            (mean + dark).ln()
        } else {
            f64::NAN
        }
    };
    (0..width.div_ceil(BLOCK) * height.div_ceil(BLOCK))
        .into_par_iter()
        .map(block)
        .collect()
}
