//! Regions of a picture, because a mean over the whole frame hides where a method fails.

use super::colour::luminance;
use super::{DARK, Kind, Linear};
use std::collections::BTreeMap;

/// A set of pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// Name of the region.
    pub name: String,
    /// Whether each pixel belongs to the region, row by row from the top.
    pub mask: Vec<bool>,
}

/// Openness below which a pixel is concave (corners, under objects).
const CONCAVE: f64 = 0.5;
/// Openness above which a pixel is open.
const OPEN: f64 = 0.9;
/// Multiple of the mean luminance from which a pixel is bright.
const BRIGHT: f64 = 4.0;

impl Region {
    /// Pixels of a mask picture with a luminance of at least 0.5.
    pub fn painted(name: &str, mask: &Linear) -> Region {
        Region {
            name: name.into(),
            mask: mask.rgb.iter().map(|c| luminance(*c) >= 0.5).collect(),
        }
    }

    /// Fraction of the frame, 0 to 1.
    pub fn share(&self) -> f64 {
        self.mask.iter().filter(|m| **m).count() as f64 / self.mask.len().max(1) as f64
    }
}

/// The regions derived from a reference's components. Empty regions and those with missing
/// components are omitted.
///
/// | Region | Pixels of the reference |
/// |---|---|
/// | `dark` | luminance of `total` at most 0.01 of its mean: behind walls, in deep shadow |
/// | `bright` | luminance of `total` at least 4 times its mean |
/// | `indirect only` | luminance of direct light at most 0.01 of its mean, but `total` not dark |
/// | `concave corners` | openness below 0.5 |
/// | `open` | openness at least 0.9 |
pub fn regions(reference: &BTreeMap<String, Linear>) -> Vec<Region> {
    let of_kind = |kind: Kind| reference.values().find(|p| p.kind == kind);
    let luminances = |part: Option<&Linear>| -> Option<(Vec<f64>, f64)> {
        let values: Vec<f64> = part?.rgb.iter().map(|c| luminance(*c)).collect();
        let finite: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        let mean = finite.iter().sum::<f64>() / finite.len().max(1) as f64;
        Some((values, mean))
    };
    let mut list = Vec::new();
    let mut add = |name: &str, mask: Vec<bool>| {
        if mask.contains(&true) {
            list.push(Region {
                name: name.into(),
                mask,
            });
        }
    };
    if let Some((total, mean)) = luminances(reference.get("total")) {
        add("dark", total.iter().map(|v| *v <= DARK * mean).collect());
        add(
            "bright",
            total
                .iter()
                .map(|v| *v >= BRIGHT * mean && *v > 0.0)
                .collect(),
        );
        if let Some((direct, direct_mean)) =
            luminances(of_kind(Kind::Direct)).filter(|d| d.0.len() == total.len())
        {
            let pairs = direct.iter().zip(&total);
            add(
                "indirect only",
                pairs
                    .map(|(d, t)| *d <= DARK * direct_mean && *t > DARK * mean)
                    .collect(),
            );
        }
    }
    if let Some((openness, _)) = luminances(of_kind(Kind::Openness)) {
        add(
            "concave corners",
            openness.iter().map(|v| *v < CONCAVE).collect(),
        );
        add("open", openness.iter().map(|v| *v >= OPEN).collect());
    }
    list
}
