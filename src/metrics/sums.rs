//! The means, from sums over rows: in one order whatever the number of threads, so that results are the same bit by bit.

use super::colour::luminance;
use super::{Compared, Scores, is_finite};
use rayon::prelude::*;

/// Keeps relative errors of dark pixels finite: squared radiance in relMSE, radiance in SMAPE.
const EPSILON: f64 = 1e-2;

/// Sums over pixels; those of radiance over their channels too.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    pixels: u64,
    finite: u64,
    dark: u64,
    over_occluded: u64,
    relative: f64,
    square: f64,
    test: f64,
    reference: f64,
    symmetric: f64,
    leak: f64,
    over_occlusion: f64,
    flip: f64,
    hdr_flip: f64,
}

/// Squared distance of two values of a channel, relative to the reference's square.
pub(super) fn relative_square(x: f32, y: f32, r: f32) -> f64 {
    let (x, y, r) = (f64::from(x), f64::from(y), f64::from(r));
    (x - y) * (x - y) / (r * r + EPSILON)
}

pub(super) fn sum(compared: &Compared, mask: Option<&[bool]>) -> Sums {
    let width = compared.test.size.0 as usize;
    let height = compared.test.size.1 as usize;
    let rows: Vec<Sums> = (0..height)
        .into_par_iter()
        .map(|y| {
            let mut sums = Sums::default();
            let row = y * width..(y + 1) * width;
            for i in row.filter(|i| mask.is_none_or(|m| m.get(*i).copied().unwrap_or(false))) {
                sums.add(compared, i);
            }
            sums
        })
        .collect();
    rows.iter().fold(Sums::default(), |all, row| all.plus(row))
}

impl Sums {
    fn add(&mut self, compared: &Compared, i: usize) {
        let (x, r) = (compared.test.rgb[i], compared.reference.rgb[i]);
        self.pixels += 1;
        self.flip += f64::from(compared.flip[i]);
        self.hdr_flip += f64::from(compared.hdr_flip[i]);
        if !is_finite(x, r) {
            return;
        }
        self.finite += 1;
        for (&x32, &r32) in x.iter().zip(&r) {
            let (x, r) = (f64::from(x32), f64::from(r32));
            self.relative += relative_square(x32, r32, r32);
            self.square += (x - r) * (x - r);
            self.test += x;
            self.reference += r;
            self.symmetric += (x - r).abs() / (x.abs() + r.abs() + EPSILON);
        }
        let total = |c: [f32; 3]| c.iter().map(|v| f64::from(*v)).sum::<f64>();
        if luminance(r) <= compared.dark {
            self.dark += 1;
            self.leak += total(x);
        } else if luminance(x) <= compared.dark {
            self.over_occluded += 1;
            self.over_occlusion += total(r);
        }
    }

    fn plus(self, other: &Sums) -> Sums {
        Sums {
            pixels: self.pixels + other.pixels,
            finite: self.finite + other.finite,
            dark: self.dark + other.dark,
            over_occluded: self.over_occluded + other.over_occluded,
            relative: self.relative + other.relative,
            square: self.square + other.square,
            test: self.test + other.test,
            reference: self.reference + other.reference,
            symmetric: self.symmetric + other.symmetric,
            leak: self.leak + other.leak,
            over_occlusion: self.over_occlusion + other.over_occlusion,
            flip: self.flip + other.flip,
            hdr_flip: self.hdr_flip + other.hdr_flip,
        }
    }

    /// Nothing without a finite pixel.
    pub(super) fn scores(&self, structure: f64) -> Option<Scores> {
        if self.finite == 0 {
            return None;
        }
        let channels = (3 * self.finite) as f64;
        let over = |sum: f64, pixels: u64| sum / (3 * pixels.max(1)) as f64;
        let share = |pixels: u64| pixels as f64 / self.finite as f64;
        let energy_ratio = if self.reference == 0.0 { f64::NAN } else { self.test / self.reference };
        Some(Scores {
            relmse: self.relative / channels,
            rmse: (self.square / channels).sqrt(),
            energy_ratio,
            smape: self.symmetric / channels,
            flip: self.flip / self.pixels as f64,
            hdr_flip: self.hdr_flip / self.pixels as f64,
            leak: over(self.leak, self.dark),
            dark: share(self.dark),
            over_occlusion: over(self.over_occlusion, self.over_occluded),
            over_occluded: share(self.over_occluded),
            structure,
            pixels: self.pixels,
            not_finite: self.pixels - self.finite,
        })
    }
}
