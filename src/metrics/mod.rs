//! How far a picture is from a reference: numbers and maps, on linear radiance. `docs/metrics.md` has every definition.

pub mod colour;
pub mod flip;
pub mod hdr_flip;
pub mod maps;
pub mod region;
mod structure;
mod sums;

pub use structure::{structure, structure_noise};

use hdr_flip::{Exposures, exposures, hdr_flip};
use serde::{Deserialize, Deserializer, Serialize};
use structure::Structure;

/// Most pixels of a picture that is compared (8192 x 8192); FLIP takes about 120 bytes for each.
pub const MAX_PIXELS: u64 = 1 << 26;

/// A pixel is dark where its luminance is at most this part of the reference's mean luminance.
pub const DARK: f64 = 0.01;

/// Why pictures cannot be compared.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct MetricError(pub String);

/// A picture in linear RGB.
#[derive(Clone, Debug, PartialEq)]
pub struct Linear {
    /// Width and height, pixels.
    pub size: (u32, u32),
    /// Radiance, or whatever a part holds; rows from the top, `width * height` texels.
    pub rgb: Vec<[f32; 3]>,
}

impl Linear {
    /// Mean over pixels and channels.
    pub fn mean(&self) -> f64 {
        self.rgb.iter().flatten().map(|v| f64::from(*v)).sum::<f64>() / (3 * self.rgb.len().max(1)) as f64
    }
}

/// relMSE alone: mean (x - r)^2 / (r^2 + 0.01). NaN where a pixel is no number.
///
/// # Errors
/// Pictures of different sizes, without pixels, or of more than [`MAX_PIXELS`].
pub fn relmse(test: &Linear, reference: &Linear) -> Result<f64, MetricError> {
    relative_distance(test, reference, reference)
}

/// mean (x - y)^2 / (r^2 + 0.01): how far x is from y in the measure of relMSE.
///
/// # Errors
/// As [`relmse`].
pub fn relative_distance(x: &Linear, y: &Linear, reference: &Linear) -> Result<f64, MetricError> {
    check(x, reference)?;
    check(y, reference)?;
    let texels = x.rgb.iter().flatten().zip(y.rgb.iter().flatten()).zip(reference.rgb.iter().flatten());
    let sum: f64 = texels.map(|((x, y), r)| sums::relative_square(*x, *y, *r)).sum();
    Ok(sum / (3 * x.rgb.len()) as f64)
}

/// What a picture's numbers are, which says how FLIP shows it to its observer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// Radiance of any range: shown by c / (1 + c), which is how the program shows pictures by default.
    #[default]
    Radiance,
    /// 0 to 1, shown as it is: pictures that were made for a display, and openness.
    Displayed,
}

impl Kind {
    /// The kind of a lighting part that a graph declares.
    pub fn of_part(part: &str) -> Kind {
        if part == "occlusion" { Kind::Displayed } else { Kind::Radiance }
    }
}

/// How far a picture is from a reference. Means are over pixels and channels, except where luminance is named. Pixels
/// that are infinite or no number in either picture are left out of all means but those of FLIP, where they count as 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scores {
    /// mean (x - r)^2 / (r^2 + 0.01), of squared radiance over squared radiance.
    pub relmse: f64,
    /// Root of mean (x - r)^2, radiance.
    pub rmse: f64,
    /// mean x / mean r; no number (null in JSON) where the reference's mean is 0.
    #[serde(deserialize_with = "null_is_no_number")]
    pub energy_ratio: f64,
    /// mean |x - r| / (|x| + |r| + 0.01), 0 to 1.
    pub smape: f64,
    /// Mean FLIP of the displayed picture, 0 to 1.
    pub flip: f64,
    /// Mean HDR-FLIP, 0 to 1.
    pub hdr_flip: f64,
    /// Mean radiance of the picture where the reference is dark ([`DARK`]); 0 where it is dark nowhere.
    pub leak: f64,
    /// Part of the pixels where the reference is dark, 0 to 1.
    pub dark: f64,
    /// Mean radiance of the reference where the picture is dark and the reference is not; 0 where that is nowhere.
    pub over_occlusion: f64,
    /// Part of the pixels where the picture is dark and the reference is not, 0 to 1.
    pub over_occluded: f64,
    /// Mean over pairs of neighbouring blocks of how far the pictures' steps of log luminance differ, natural log units;
    /// no number (null in JSON) where the reference is black, or no block has a neighbour.
    #[serde(default = "no_number", deserialize_with = "null_is_no_number")]
    pub structure: f64,
    /// Pixels.
    pub pixels: u64,
    /// Pixels that are infinite or no number in either picture.
    pub not_finite: u64,
}

fn no_number() -> f64 {
    f64::NAN
}

fn null_is_no_number<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or_else(no_number))
}

/// How far a picture of radiance is from a reference, over the whole frame.
///
/// # Errors
/// Pictures of different sizes, without pixels, of more than [`MAX_PIXELS`], or without one pixel that is a number in
/// both.
pub fn scores(test: &Linear, reference: &Linear) -> Result<Scores, MetricError> {
    let compared = Compared::new(test, reference, Kind::Radiance)?;
    compared.scores(None).ok_or_else(|| MetricError("no pixel is a finite number in both pictures".into()))
}

/// A picture against a reference, with the maps that cost time.
pub struct Compared<'a> {
    test: &'a Linear,
    reference: &'a Linear,
    /// Luminance up to which a pixel is dark ([`DARK`]).
    pub dark: f64,
    /// FLIP of every pixel, 0 to 1.
    pub flip: Vec<f32>,
    /// HDR-FLIP of every pixel, 0 to 1.
    pub hdr_flip: Vec<f32>,
    /// What HDR-FLIP looked at.
    pub exposures: Exposures,
    structure: Structure,
}

impl<'a> Compared<'a> {
    /// Compares. A map of FLIP takes most of a second for a megapixel on one core, and one is needed for each exposure.
    ///
    /// # Errors
    /// Pictures of different sizes, without pixels, or of more than [`MAX_PIXELS`].
    pub fn new(test: &'a Linear, reference: &'a Linear, kind: Kind) -> Result<Compared<'a>, MetricError> {
        check(test, reference)?;
        let finite: Vec<bool> = test.rgb.iter().zip(&reference.rgb).map(|(x, r)| is_finite(*x, *r)).collect();
        // One wrong pixel would reach all that the filters of FLIP see around it; light is never negative to an eye.
        let visible = |picture: &Linear| -> Vec<[f32; 3]> {
            let pixels = picture.rgb.iter().zip(&finite);
            pixels.map(|(c, finite)| if *finite { c.map(|v| v.max(0.0)) } else { [0.0; 3] }).collect()
        };
        let (x, r) = (visible(test), visible(reference));
        let show = |picture: &[[f32; 3]]| -> Vec<[f32; 3]> {
            let display = |v: f32| if kind == Kind::Radiance { v / (1.0 + v) } else { v.min(1.0) };
            picture.iter().map(|c| c.map(display)).collect()
        };
        let width = test.size.0 as usize;
        let exposures = exposures(&r);
        let mut flip = flip::flip(&show(&x), &show(&r), width);
        let mut hdr_flip = hdr_flip(&x, &r, width, exposures);
        for (i, _) in finite.iter().enumerate().filter(|f| !f.1) {
            (flip[i], hdr_flip[i]) = (1.0, 1.0);
        }
        let dark = dark(test, reference);
        let structure = Structure::new(test, reference, dark, 1.0);
        Ok(Compared { test, reference, dark, flip, hdr_flip, exposures, structure })
    }

    /// The scores over the pixels of a mask, or over all of them; nothing where none of them is a number in both.
    /// What is dark does not depend on the mask.
    pub fn scores(&self, mask: Option<&[bool]>) -> Option<Scores> {
        sums::sum(self, mask).scores(self.structure.mean(mask))
    }
}

/// Luminance up to which a pixel is dark: [`DARK`] of the mean over the reference's pixels that are finite in both.
fn dark(test: &Linear, reference: &Linear) -> f64 {
    let finite = || test.rgb.iter().zip(&reference.rgb).filter(|(x, r)| is_finite(**x, **r)).map(|pair| pair.1);
    let sum: f64 = finite().map(|c| colour::luminance(c.map(|v| v.max(0.0)))).sum();
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
        return Err(MetricError(format!("a picture of {w}x{h} cannot be compared: 1 to {MAX_PIXELS} pixels can")));
    }
    if [test, reference].iter().any(|p| p.rgb.len() as u64 != pixels) {
        return Err(MetricError(format!("a picture of {w}x{h} must have {pixels} texels")));
    }
    Ok(())
}
