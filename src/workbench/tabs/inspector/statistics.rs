//! Statistics and histogram of a texture's values.

use super::image::{Channel, Decoded, Tone};
use rayon::prelude::*;

/// Bins of a histogram.
pub const BINS: usize = 128;

/// Least, greatest and mean of the finite values of a channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Values {
    /// Least.
    pub min: f32,
    /// Greatest.
    pub max: f32,
    /// Sum.
    sum: f64,
    /// Finite values.
    pub count: usize,
    /// Values that are not a number.
    pub nan: usize,
    /// Infinite values.
    pub infinite: usize,
}

const NOTHING: Values = Values {
    min: f32::INFINITY,
    max: f32::NEG_INFINITY,
    sum: 0.0,
    count: 0,
    nan: 0,
    infinite: 0,
};

impl Values {
    /// Mean of the finite values.
    pub fn mean(&self) -> f64 {
        self.sum / self.count.max(1) as f64
    }

    fn add(&mut self, v: f32) {
        if v.is_nan() {
            self.nan += 1;
        } else if v.is_infinite() {
            self.infinite += 1;
        } else {
            self.min = self.min.min(v);
            self.max = self.max.max(v);
            self.sum += f64::from(v);
            self.count += 1;
        }
    }

    fn join(&self, other: &Values) -> Values {
        Values {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
            sum: self.sum + other.sum,
            count: self.count + other.count,
            nan: self.nan + other.nan,
            infinite: self.infinite + other.infinite,
        }
    }
}

/// Statistics of every channel that the format has.
pub fn values(d: &Decoded) -> Vec<Values> {
    let count = (d.format.count as usize).min(4);
    let parts: Vec<[Values; 4]> = d
        .floats
        .par_chunks(1 << 14)
        .map(|chunk| {
            let mut part = [NOTHING; 4];
            for v in chunk {
                for (part, v) in part.iter_mut().zip(v).take(count) {
                    part.add(*v);
                }
            }
            part
        })
        .collect();
    (0..count)
        .map(|i| parts.iter().fold(NOTHING, |all, part| all.join(&part[i])))
        .collect()
}

/// Histogram of each channel from low to high, without values outside.
pub fn histogram(d: &Decoded, low: f32, high: f32) -> Vec<[u32; BINS]> {
    let count = (d.format.count as usize).min(4);
    let (low, high) = (low.min(high), low.max(high));
    let scale = BINS as f32 / (high - low).max(f32::MIN_POSITIVE);
    let parts: Vec<Vec<[u32; BINS]>> = d
        .floats
        .par_chunks(1 << 16)
        .map(|chunk| {
            let mut bins = vec![[0; BINS]; count];
            for v in chunk {
                for (bins, v) in bins.iter_mut().zip(v) {
                    if (low..=high).contains(v) {
                        bins[(((v - low) * scale) as usize).min(BINS - 1)] += 1;
                    }
                }
            }
            bins
        })
        .collect();
    let mut all = vec![[0; BINS]; count];
    for part in parts {
        for (all, part) in all.iter_mut().flatten().zip(part.iter().flatten()) {
            *all += part;
        }
    }
    all
}

/// First and last value of the histogram: all finite values that are shown, and the range.
pub fn span(tone: &Tone, values: &[Values]) -> [f32; 2] {
    let all = fit(tone, values);
    let low = all.low.min(all.high).min(tone.low).min(tone.high);
    let high = all.low.max(all.high).max(tone.low).max(tone.high);
    [low, high]
}

/// The range of the finite values that are shown.
pub fn fit(tone: &Tone, values: &[Values]) -> Tone {
    let shown: Vec<&Values> = match tone.channel {
        Channel::One(i) => values.iter().skip(i).take(1).collect(),
        _ => values.iter().take(3).collect(),
    };
    let low = shown.iter().map(|v| v.min).fold(f32::INFINITY, f32::min);
    let high = shown
        .iter()
        .map(|v| v.max)
        .fold(f32::NEG_INFINITY, f32::max);
    match low <= high {
        // Texels that are all the same are shown white, zeros black.
        true if low == high => Tone {
            low: low.min(0.0),
            high: if high > 0.0 { high } else { 1.0 },
            ..*tone
        },
        true => Tone { low, high, ..*tone },
        false => *tone,
    }
}

#[cfg(test)]
mod tests {
    use super::super::image::tests::{decoded, floats};
    use super::*;

    #[test]
    fn what_is_not_finite_is_counted_and_left_out() {
        let d = floats(&[
            [1.0, f32::NAN, f32::INFINITY, 0.0],
            [3.0, f32::NAN, -2.0, 0.0],
            [2.0, 5.0, f32::NEG_INFINITY, 0.0],
        ]);
        let v = values(&d);
        assert_eq!(
            (v[0].min, v[0].max, v[0].mean(), v[0].nan, v[0].infinite),
            (1.0, 3.0, 2.0, 0, 0)
        );
        assert_eq!(
            (v[1].min, v[1].max, v[1].mean(), v[1].nan, v[1].infinite),
            (5.0, 5.0, 5.0, 2, 0)
        );
        assert_eq!(
            (v[2].min, v[2].max, v[2].count, v[2].nan, v[2].infinite),
            (-2.0, -2.0, 1, 0, 2)
        );
        assert_eq!(values(&decoded("rg8", [1, 1], vec![0, 255])).len(), 2);
    }

    #[test]
    fn a_histogram_counts_what_lies_in_the_range() {
        let list: Vec<[f32; 4]> = (0..256)
            .map(|i| [i as f32, 256.0, f32::NAN, -1.0])
            .collect();
        let h = histogram(&floats(&list), 0.0, 256.0);
        assert!(h[0].iter().all(|n| *n == 2));
        assert_eq!((h[1][BINS - 1], h[1].iter().sum::<u32>()), (256, 256));
        assert_eq!((h[2].iter().sum::<u32>(), h[3].iter().sum::<u32>()), (0, 0));
        assert_eq!(
            histogram(&floats(&list), 0.0, 127.0)[0].iter().sum::<u32>(),
            128
        );
        assert_eq!(
            histogram(&floats(&list), 5.0, 5.0)[0].iter().sum::<u32>(),
            1
        );
    }

    #[test]
    fn the_range_fits_what_is_shown() {
        let v = values(&floats(&[
            [1.0, -2.0, 3.0, 9.0],
            [0.5, f32::INFINITY, f32::NAN, 7.0],
        ]));
        let fitted = fit(&Tone::default(), &v);
        assert_eq!((fitted.low, fitted.high), (-2.0, 3.0));
        let alpha = fit(
            &Tone {
                channel: Channel::One(3),
                ..Tone::default()
            },
            &v,
        );
        assert_eq!((alpha.low, alpha.high), (7.0, 9.0));
        let same = fit(&Tone::default(), &values(&floats(&[[4.0; 4]])));
        assert_eq!((same.low, same.high), (0.0, 4.0));
        let none = fit(&Tone::default(), &values(&floats(&[[f32::NAN; 4]])));
        assert_eq!((none.low, none.high), (0.0, 1.0));
    }
}
