//! Deterministic tiling noise, and random numbers.

use crate::scene::splitmix;

/// SplitMix64 random floats.
pub(in crate::scene) struct Random(pub u64);

impl Random {
    /// Uniform in 0..1.
    pub fn unit(&mut self) -> f32 {
        (splitmix(&mut self.0) >> 40) as f32 / (1u64 << 24) as f32
    }

    /// Uniform in `low..high`.
    pub fn range(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }
}

/// Random value in 0..1 of a grid point.
pub(super) fn hash(x: i32, y: i32, seed: u32) -> f32 {
    let key = (x as u32 as u64) | (y as u32 as u64) << 24 | u64::from(seed) << 48;
    // One step of the sequence, with the key multiplied by its stride first.
    Random(key.wrapping_sub(1).wrapping_mul(0x9E37_79B9_7F4A_7C15)).unit()
}

/// Tiling value noise in 0..1 with `cells` cells per side of the unit square.
pub(super) fn value(u: f32, v: f32, cells: i32, seed: u32) -> f32 {
    let (x, y) = (u * cells as f32, v * cells as f32);
    let (i, j) = (x.floor() as i32, y.floor() as i32);
    let smooth = |t: f32| t * t * (3.0 - 2.0 * t);
    let (fx, fy) = (smooth(x - x.floor()), smooth(y - y.floor()));
    let at = |dx: i32, dy: i32| hash((i + dx).rem_euclid(cells), (j + dy).rem_euclid(cells), seed);
    let low = at(0, 0) + (at(1, 0) - at(0, 0)) * fx;
    let high = at(0, 1) + (at(1, 1) - at(0, 1)) * fx;
    low + (high - low) * fy
}

/// Sum of four octaves of value noise, in 0..1.
pub(super) fn fractal(u: f32, v: f32, cells: i32, seed: u32) -> f32 {
    let octave = |i: u32| value(u, v, cells << i, seed.wrapping_add(i)) * 0.5f32.powi(i as i32);
    (0..4).map(octave).sum::<f32>() / 1.875
}
