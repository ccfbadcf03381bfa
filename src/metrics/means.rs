//! Computation of each metric from two pictures. Sums run over rows, then over row sums in order,
//! so that the bits do not depend on the number of threads.

use super::colour::luminance;
use super::{Compared, is_finite};
use rayon::prelude::*;

/// Offset that keeps relative errors of dark pixels finite: squared radiance in relMSE, radiance in
/// SMAPE.
const EPSILON: f64 = 1e-2;

/// Selects pixels; all of them if `None`.
pub(super) type Mask<'m> = Option<&'m [bool]>;

/// Squared difference of a channel, relative to the squared reference.
pub(super) fn relative_square(x: f32, y: f32, r: f32) -> f64 {
    let (x, y, r) = (f64::from(x), f64::from(y), f64::from(r));
    (x - y) * (x - y) / (r * r + EPSILON)
}

pub(super) fn relmse(c: &Compared, mask: Mask) -> f64 {
    over_channels(c, mask, |x, r| relative_square(x, r, r))
}

pub(super) fn rmse(c: &Compared, mask: Mask) -> f64 {
    over_channels(c, mask, |x, r| {
        (f64::from(x) - f64::from(r)) * (f64::from(x) - f64::from(r))
    })
    .sqrt()
}

pub(super) fn smape(c: &Compared, mask: Mask) -> f64 {
    over_channels(c, mask, |x, r| {
        let (x, r) = (f64::from(x), f64::from(r));
        (x - r).abs() / (x.abs() + r.abs() + EPSILON)
    })
}

pub(super) fn energy_ratio(c: &Compared, mask: Mask) -> f64 {
    let [test, reference] = over_finite(c, mask, |x, r, [test, reference]| {
        x.iter().for_each(|v| *test += f64::from(*v));
        r.iter().for_each(|v| *reference += f64::from(*v));
    });
    if reference == 0.0 {
        f64::NAN
    } else {
        test / reference
    }
}

pub(super) fn flip(c: &Compared, mask: Mask) -> f64 {
    over_map(c, mask, c.flip())
}

pub(super) fn hdr_flip(c: &Compared, mask: Mask) -> f64 {
    over_map(c, mask, c.hdr_flip())
}

pub(super) fn structure(c: &Compared, mask: Mask) -> f64 {
    c.structure().mean(mask)
}

pub(super) fn leak(c: &Compared, mask: Mask) -> f64 {
    light_where(c, mask, |x, r| is_dark(c, r).then_some(x))
}

pub(super) fn dark(c: &Compared, mask: Mask) -> f64 {
    share_where(c, mask, |_, r| is_dark(c, r))
}

pub(super) fn over_occlusion(c: &Compared, mask: Mask) -> f64 {
    light_where(c, mask, |x, r| is_lost(c, x, r).then_some(r))
}

pub(super) fn over_occluded(c: &Compared, mask: Mask) -> f64 {
    share_where(c, mask, |x, r| is_lost(c, x, r))
}

fn is_dark(c: &Compared, pixel: [f32; 3]) -> bool {
    luminance(pixel) <= c.dark
}

fn is_lost(c: &Compared, x: [f32; 3], r: [f32; 3]) -> bool {
    is_dark(c, x) && !is_dark(c, r)
}

/// Sums over the pixels of a mask; `add` receives the pixel index.
pub(super) fn sums<const N: usize>(
    c: &Compared,
    mask: Mask,
    add: impl Fn(usize, &mut [f64; N]) + Sync,
) -> [f64; N] {
    let (width, height) = (c.test.size.0 as usize, c.test.size.1 as usize);
    let row = |y: usize| {
        let mut sums = [0.0; N];
        let pixels =
            (y * width..(y + 1) * width).filter(|i| mask.is_none_or(|m| m.get(*i) == Some(&true)));
        pixels.for_each(|i| add(i, &mut sums));
        sums
    };
    let rows: Vec<[f64; N]> = (0..height).into_par_iter().map(row).collect();
    rows.iter().fold([0.0; N], |all, row| {
        std::array::from_fn(|i| all[i] + row[i])
    })
}

/// Sums over the pixels of a mask that are finite in both pictures; `add` receives both values.
fn over_finite<const N: usize>(
    c: &Compared,
    mask: Mask,
    add: impl Fn([f32; 3], [f32; 3], &mut [f64; N]) + Sync,
) -> [f64; N] {
    sums(c, mask, |i, sums| {
        let (x, r) = (c.test.rgb[i], c.reference.rgb[i]);
        if is_finite(x, r) {
            add(x, r, sums);
        }
    })
}

fn over_channels(c: &Compared, mask: Mask, value: impl Fn(f32, f32) -> f64 + Sync) -> f64 {
    let [sum, count] = over_finite(c, mask, |x, r, [sum, count]| {
        for (x, r) in x.iter().zip(&r) {
            *sum += value(*x, *r);
            *count += 1.0;
        }
    });
    sum / count
}

fn over_map(c: &Compared, mask: Mask, map: &[f32]) -> f64 {
    let [sum, count] = sums(c, mask, |i, [sum, count]| {
        *sum += f64::from(map[i]);
        *count += 1.0;
    });
    sum / count
}

/// Mean of `light` over the pixels for which it returns a value; 0 without any.
fn light_where(
    c: &Compared,
    mask: Mask,
    light: impl Fn([f32; 3], [f32; 3]) -> Option<[f32; 3]> + Sync,
) -> f64 {
    let [sum, count] = over_finite(c, mask, |x, r, [sum, count]| {
        if let Some(light) = light(x, r) {
            *sum += light.iter().map(|v| f64::from(*v)).sum::<f64>();
            *count += 1.0;
        }
    });
    sum / (3.0 * count.max(1.0))
}

/// Fraction of pixels that satisfy `is`, 0 to 1.
fn share_where(c: &Compared, mask: Mask, is: impl Fn([f32; 3], [f32; 3]) -> bool + Sync) -> f64 {
    let [sum, count] = over_finite(c, mask, |x, r, [sum, count]| {
        *sum += f64::from(u8::from(is(x, r)));
        *count += 1.0;
    });
    sum / count
}
