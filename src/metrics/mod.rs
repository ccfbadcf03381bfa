//! Errors of a picture against a reference: numbers and maps, on linear radiance. Definitions are
//! in `docs/metrics.md`.

pub mod colour;
pub(crate) mod flip;
pub(crate) mod hdr_flip;
pub mod maps;
mod means;
mod noise;
mod rank;
pub mod region;
mod structure;
mod table;

pub use noise::Noise;
pub(crate) use rank::{median, percentile};
pub use structure::{structure, structure_noise};
pub use table::Best;
pub(crate) use table::RELMSE;
pub use table::{METRICS, Metric, Scores};

use hdr_flip::Exposures;
use serde::Deserialize;
use std::sync::OnceLock;
use structure::Structure;

/// Maximum number of pixels (8192 x 8192); FLIP uses about 120 bytes per pixel.
pub(crate) const MAX_PIXELS: u64 = 1 << 26;

/// Pixels up to this fraction of the reference's mean luminance are dark.
pub(crate) const DARK: f64 = 0.01;

/// Reason why pictures cannot be compared.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct MetricError(pub String);

/// A picture in linear RGB.
#[derive(Clone, Debug, PartialEq)]
pub struct Linear {
    /// Width and height, pixels.
    pub size: (u32, u32),
    /// Radiance or another part, row by row from the top; `width * height` texels.
    pub rgb: Vec<[f32; 3]>,
    /// Meaning of the values.
    pub kind: Kind,
}

impl Linear {
    /// A picture of radiance.
    pub fn radiance(size: (u32, u32), rgb: Vec<[f32; 3]>) -> Linear {
        Linear {
            size,
            rgb,
            kind: Kind::Radiance,
        }
    }

    /// Mean over pixels and channels.
    pub fn mean(&self) -> f64 {
        self.rgb
            .iter()
            .flatten()
            .map(|v| f64::from(*v))
            .sum::<f64>()
            / (3 * self.rgb.len().max(1)) as f64
    }
}

/// relMSE alone: mean (x - r)^2 / (r^2 + 0.01). NaN where a pixel is no number.
///
/// # Errors
/// Pictures of different sizes, without pixels, or of more than `MAX_PIXELS`.
pub fn relmse(test: &Linear, reference: &Linear) -> Result<f64, MetricError> {
    relative_distance(test, reference, reference)
}

/// mean (x - y)^2 / (r^2 + 0.01): the distance of x from y, normalised as in relMSE.
pub(crate) fn relative_distance(
    x: &Linear,
    y: &Linear,
    reference: &Linear,
) -> Result<f64, MetricError> {
    check(x, reference)?;
    check(y, reference)?;
    let texels = x
        .rgb
        .iter()
        .flatten()
        .zip(y.rgb.iter().flatten())
        .zip(reference.rgb.iter().flatten());
    let sum: f64 = texels
        .map(|((x, y), r)| means::relative_square(*x, *y, *r))
        .sum();
    Ok(sum / (3 * x.rgb.len()) as f64)
}

/// Meaning of a picture's values, in the display order of light components. It decides how FLIP
/// displays them and which regions are derived from them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Radiance received directly from lights.
    Direct,
    /// Radiance of any range, displayed by c / (1 + c), the program's default.
    #[default]
    Radiance,
    /// Unoccluded fraction of the hemisphere, 0 to 1, displayed unchanged.
    Openness,
    /// Display-referred values in 0..1, displayed unchanged.
    Displayed,
}

impl Kind {
    /// The displayed linear value of a non-negative value, 0 to 1.
    pub fn shown(self, v: f32) -> f32 {
        match self {
            Kind::Direct | Kind::Radiance => v / (1.0 + v),
            Kind::Openness | Kind::Displayed => v.min(1.0),
        }
    }
}

/// Errors of a radiance picture against a reference, over the whole frame.
///
/// # Errors
/// Different or empty sizes; more than `MAX_PIXELS`; no pixel that is finite in both.
pub fn scores(test: &Linear, reference: &Linear) -> Result<Scores, MetricError> {
    let compared = Compared::new(test, reference)?;
    compared.scores(None).ok_or_else(no_number)
}

/// Significance threshold for differences, in multiples of the reference's noise.
pub(crate) const NOISE_FACTOR: f64 = 4.0;

/// Whether a relMSE, or a difference of two, is below four times the noise.
pub(crate) fn within_noise(relmse: f64, noise: Option<f64>) -> bool {
    noise.is_some_and(|n| relmse.abs() < NOISE_FACTOR * n)
}

/// A picture and its reference. Expensive maps are computed on first use and cached.
pub struct Compared<'a> {
    test: &'a Linear,
    reference: &'a Linear,
    /// Luminance up to which a pixel is dark (`DARK`).
    pub dark: f64,
    flip: OnceLock<Vec<f32>>,
    hdr_flip: OnceLock<(Exposures, Vec<f32>)>,
    structure: OnceLock<Structure>,
}

impl<'a> Compared<'a> {
    /// Prepares a comparison; both pictures are interpreted as the reference's kind.
    ///
    /// # Errors
    /// Pictures of different sizes, without pixels, or of more than `MAX_PIXELS`.
    pub fn new(test: &'a Linear, reference: &'a Linear) -> Result<Compared<'a>, MetricError> {
        check(test, reference)?;
        let dark = dark(test, reference);
        let (flip, hdr_flip, structure) = (OnceLock::new(), OnceLock::new(), OnceLock::new());
        Ok(Compared {
            test,
            reference,
            dark,
            flip,
            hdr_flip,
            structure,
        })
    }

    /// The scores over the pixels of a mask, or over all of them; `None` if no pixel is finite in
    /// both. The threshold of dark pixels does not depend on the mask.
    pub fn scores(&self, mask: Option<&[bool]>) -> Option<Scores> {
        Scores::new(self, mask, &|_| true)
    }

    /// The scores of one metric over all pixels, without the cost of the others.
    pub(crate) fn scores_by(&self, metric: &Metric) -> Option<Scores> {
        Scores::new(self, None, &|m| m == metric)
    }

    /// One metric over all pixels, without the time that others take.
    ///
    /// # Errors
    /// No pixel is a number in both pictures.
    pub fn score(&self, metric: &Metric) -> Result<f64, MetricError> {
        if (0..self.test.rgb.len()).any(|i| self.is_finite(i)) {
            Ok((metric.of)(self, None))
        } else {
            Err(no_number())
        }
    }

    /// FLIP of every pixel, 0 to 1. Takes almost 1 s per megapixel on one core.
    pub fn flip(&self) -> &[f32] {
        self.flip.get_or_init(|| {
            let show = |picture: &Linear| -> Vec<[f32; 3]> {
                self.visible(picture)
                    .iter()
                    .map(|c| c.map(|v| self.reference.kind.shown(v)))
                    .collect()
            };
            self.marked(flip::flip(
                &show(self.test),
                &show(self.reference),
                self.width(),
            ))
        })
    }

    /// HDR-FLIP of every pixel, 0 to 1. Costs one FLIP per exposure.
    pub fn hdr_flip(&self) -> &[f32] {
        &self.exposed().1
    }

    /// The exposures of HDR-FLIP.
    pub fn exposures(&self) -> Exposures {
        self.exposed().0
    }

    fn exposed(&self) -> &(Exposures, Vec<f32>) {
        self.hdr_flip.get_or_init(|| {
            let (x, r) = (self.visible(self.test), self.visible(self.reference));
            let exposures = hdr_flip::exposures(&r);
            (
                exposures,
                self.marked(hdr_flip::hdr_flip(&x, &r, self.width(), exposures)),
            )
        })
    }

    fn structure(&self) -> &Structure {
        self.structure
            .get_or_init(|| Structure::new(self.test, self.reference, self.dark, 1.0))
    }

    fn width(&self) -> usize {
        self.test.size.0 as usize
    }

    fn is_finite(&self, i: usize) -> bool {
        is_finite(self.test.rgb[i], self.reference.rgb[i])
    }

    /// The input of FLIP: non-finite pixels are replaced, because its filters would spread them,
    /// and negative values are clamped.
    fn visible(&self, picture: &Linear) -> Vec<[f32; 3]> {
        let pixels = picture.rgb.iter().enumerate();
        pixels
            .map(|(i, c)| {
                if self.is_finite(i) {
                    c.map(|v| v.max(0.0))
                } else {
                    [0.0; 3]
                }
            })
            .collect()
    }

    /// A map in which non-finite pixels count as 1.
    fn marked(&self, mut map: Vec<f32>) -> Vec<f32> {
        map.iter_mut()
            .enumerate()
            .filter(|(i, _)| !self.is_finite(*i))
            .for_each(|(_, v)| *v = 1.0);
        map
    }
}

fn no_number() -> MetricError {
    MetricError("no pixel is a finite number in both pictures".into())
}

/// Threshold of dark pixels: [`DARK`] times the mean over the reference's pixels that are finite in
/// both.
fn dark(test: &Linear, reference: &Linear) -> f64 {
    let finite = || {
        test.rgb
            .iter()
            .zip(&reference.rgb)
            .filter(|(x, r)| is_finite(**x, **r))
            .map(|pair| pair.1)
    };
    let sum: f64 = finite()
        .map(|c| colour::luminance(c.map(|v| v.max(0.0))))
        .sum();
    DARK * sum / finite().count().max(1) as f64
}

fn is_finite(x: [f32; 3], r: [f32; 3]) -> bool {
    x.iter().chain(&r).all(|v| v.is_finite())
}

fn check(test: &Linear, reference: &Linear) -> Result<(), MetricError> {
    let [(w, h), (rw, rh)] = [test.size, reference.size];
    if (w, h) != (rw, rh) {
        return Err(MetricError(format!(
            "pictures of {w}x{h} and {rw}x{rh} cannot be compared; render both at one size"
        )));
    }
    let pixels = u64::from(w) * u64::from(h);
    if pixels == 0 || pixels > MAX_PIXELS {
        return Err(MetricError(format!(
            "a picture of {w}x{h} cannot be compared: 1 to {MAX_PIXELS} pixels can"
        )));
    }
    if [test, reference]
        .iter()
        .any(|p| p.rgb.len() as u64 != pixels)
    {
        return Err(MetricError(format!(
            "a picture of {w}x{h} must have {pixels} texels"
        )));
    }
    Ok(())
}
