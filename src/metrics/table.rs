//! The table of metrics, used by tables, charts, verdicts and options.

use super::means::{self, Mask};
use super::{Compared, NOISE_FACTOR, Noise};
use serde::de::Error;
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::BTreeMap;
use std::fmt;

/// An error of a picture against a reference. Means are over pixels and channels, except where
/// luminance is named. Pixels that are not finite in either picture are ignored, except in FLIP,
/// where they count as 1.
pub struct Metric {
    /// Name in JSON, in files and on the command line.
    pub key: &'static str,
    /// Display name.
    pub title: &'static str,
    /// Short name for table columns; `None` leaves it out of tables.
    pub head: Option<&'static str>,
    /// Definition, x the picture and r the reference, with unit or range.
    pub help: &'static str,
    /// The best value.
    pub best: Best,
    /// Whether short tables include it.
    pub brief: bool,
    /// Expected effect of the reference's noise, if known.
    pub noise: Option<OfNoise>,
    pub(super) of: fn(&Compared, Mask) -> f64,
}

/// The best value of a metric.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Best {
    /// 0, the minimum.
    Zero,
    /// 1; a ratio is as bad as its inverse.
    One,
    /// None: not used to compare pictures.
    Nowhere,
}

/// Effect of a reference's noise on a metric.
pub struct OfNoise {
    /// Noise estimate of the metric.
    pub of: fn(Noise) -> f64,
    /// Expected value of a perfect picture, in multiples of the noise.
    pub perfect: f64,
    /// Significance threshold of differences, in multiples of the noise.
    pub none: f64,
    /// The noise of n samples falls as n^-order. Only estimates of the remaining work use it.
    pub order: f64,
}

/// Key of the metric that represents the noise of a picture.
pub const RELMSE: &str = "relmse";

/// All metrics in display order. `over_occlusion` does not rank two pictures, because it averages
/// different pixels for each.
pub static METRICS: &[Metric] = &[
    Metric {
        brief: true,
        noise: Some(OfNoise {
            of: |n| n.relmse,
            perfect: 0.25,
            none: NOISE_FACTOR,
            order: 1.0,
        }),
        ..metric(
            RELMSE,
            "relMSE",
            "mean (x - r)^2 / (r^2 + 0.01)",
            means::relmse,
        )
    },
    metric(
        "rmse",
        "RMSE",
        "root of mean (x - r)^2, radiance",
        means::rmse,
    ),
    Metric {
        head: Some("energy"),
        best: Best::One,
        brief: true,
        ..metric(
            "energy_ratio",
            "energy ratio",
            "mean x / mean r; none where r is black",
            means::energy_ratio,
        )
    },
    metric(
        "smape",
        "SMAPE",
        "mean |x - r| / (|x| + |r| + 0.01), 0 to 1",
        means::smape,
    ),
    Metric {
        brief: true,
        noise: Some(OfNoise {
            of: |n| n.flip,
            perfect: 1.0,
            none: 1.0,
            order: 0.3,
        }),
        ..metric(
            "flip",
            "FLIP",
            "mean FLIP of the displayed picture, 0 to 1",
            means::flip,
        )
    },
    metric(
        "hdr_flip",
        "HDR-FLIP",
        "mean of the largest FLIP over all exposures, 0 to 1",
        means::hdr_flip,
    ),
    Metric {
        brief: true,
        noise: Some(OfNoise {
            of: |n| n.structure,
            perfect: 1.0,
            none: 1.0,
            order: 0.7,
        }),
        ..metric(
            "structure",
            "structure",
            "edges that r does not have, natural log units",
            means::structure,
        )
    },
    metric(
        "leak",
        "leak",
        "mean x where r is dark, radiance",
        means::leak,
    ),
    Metric {
        head: None,
        best: Best::Nowhere,
        ..metric(
            "dark",
            "dark",
            "part of the pixels where r is dark, 0 to 1",
            means::dark,
        )
    },
    Metric {
        head: Some("over-occl."),
        best: Best::Nowhere,
        ..metric(
            "over_occlusion",
            "over-occlusion",
            "mean r where x alone is dark, radiance",
            means::over_occlusion,
        )
    },
    Metric {
        head: Some("of pixels"),
        ..metric(
            "over_occluded",
            "over-occluded",
            "part of the pixels where x alone is dark, 0 to 1",
            means::over_occluded,
        )
    },
];

/// A metric outside short tables and without a known noise.
const fn metric(
    key: &'static str,
    title: &'static str,
    help: &'static str,
    of: fn(&Compared, Mask) -> f64,
) -> Metric {
    Metric {
        key,
        title,
        head: Some(title),
        help,
        best: Best::Zero,
        brief: false,
        noise: None,
        of,
    }
}

impl Metric {
    /// The metric with this key.
    pub fn of(key: &str) -> Option<&'static Metric> {
        METRICS.iter().find(|m| m.key == key)
    }

    /// Metrics that rank pictures.
    pub fn ranking() -> impl Iterator<Item = &'static Metric> {
        METRICS.iter().filter(|m| m.best != Best::Nowhere)
    }

    /// Metrics of short tables.
    pub fn few() -> impl Iterator<Item = &'static Metric> {
        METRICS.iter().filter(|m| m.brief)
    }

    /// Name for table columns.
    pub fn short(&self) -> &'static str {
        self.head.unwrap_or(self.title)
    }

    /// Distance of a value from the best one.
    pub fn distance(&self, value: f64) -> f64 {
        if self.best == Best::One {
            value.ln().abs()
        } else {
            value
        }
    }

    /// Axis label of its distance.
    pub fn axis(&self) -> String {
        if self.best == Best::One {
            format!("|ln {}|", self.title)
        } else {
            self.title.into()
        }
    }

    /// Expected value of a picture without errors, due to the reference's noise; `None` if the
    /// metric's noise is unknown.
    pub fn of_noise(&self, noise: Noise) -> Option<f64> {
        self.noise.as_ref().map(|of| of.perfect * (of.of)(noise))
    }

    /// Whether a distance, or a difference of two, is within the noise of the reference.
    pub fn within(&self, distance: f64, noise: Noise) -> bool {
        self.noise
            .as_ref()
            .is_some_and(|of| distance.abs() < of.none * (of.of)(noise))
    }
}

impl PartialEq for Metric {
    fn eq(&self, other: &Metric) -> bool {
        self.key == other.key
    }
}

impl fmt::Debug for Metric {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.key)
    }
}

/// Values of every metric; serialised as an object by key, with `pixels` and `not_finite`.
#[derive(Clone, Debug, PartialEq)]
pub struct Scores {
    /// In the order of [`METRICS`].
    values: Vec<f64>,
    /// Compared pixels.
    pub pixels: u64,
    /// Pixels that are not finite in either picture.
    pub not_finite: u64,
}

impl Scores {
    /// Computes these metrics; the others are NaN. `None` without a finite pixel.
    pub(super) fn new(
        compared: &Compared,
        mask: Mask,
        wanted: &dyn Fn(&Metric) -> bool,
    ) -> Option<Scores> {
        let [pixels, finite] = means::sums(compared, mask, |i, [pixels, finite]| {
            *pixels += 1.0;
            *finite += f64::from(u8::from(compared.is_finite(i)));
        });
        let value = |m: &Metric| {
            if wanted(m) {
                (m.of)(compared, mask)
            } else {
                f64::NAN
            }
        };
        let values = || METRICS.iter().map(value).collect();
        (finite > 0.0).then(|| Scores {
            values: values(),
            pixels: pixels as u64,
            not_finite: (pixels - finite) as u64,
        })
    }

    /// The value of a metric; NaN if it has none or the key is unknown.
    pub fn get(&self, key: &str) -> f64 {
        self.values()
            .find(|v| v.0.key == key)
            .map_or(f64::NAN, |v| v.1)
    }

    /// All metrics and their values.
    pub fn values(&self) -> impl Iterator<Item = (&'static Metric, f64)> {
        METRICS.iter().zip(self.values.iter().copied())
    }

    /// All finite values, by their JSON name.
    pub fn numbers(&self) -> BTreeMap<String, f64> {
        let values = self
            .values()
            .map(|(m, v)| (m.key, v))
            .filter(|(_, v)| v.is_finite());
        let counts = [
            ("pixels", self.pixels as f64),
            ("not_finite", self.not_finite as f64),
        ];
        values
            .chain(counts)
            .map(|(key, value)| (key.into(), value))
            .collect()
    }
}

impl Serialize for Scores {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(METRICS.len() + 2))?;
        self.values()
            .try_for_each(|(metric, value)| map.serialize_entry(metric.key, &value))?;
        map.serialize_entry("pixels", &self.pixels)?;
        map.serialize_entry("not_finite", &self.not_finite)?;
        map.end()
    }
}

impl<'de> Deserialize<'de> for Scores {
    /// A metric that is `null`, or missing in an older file, becomes NaN.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Scores, D::Error> {
        let found = BTreeMap::<String, Option<f64>>::deserialize(deserializer)?;
        let value = |key: &str| found.get(key).copied().flatten();
        let count = |key: &'static str| {
            value(key)
                .map(|n| n as u64)
                .ok_or_else(|| D::Error::missing_field(key))
        };
        Ok(Scores {
            values: METRICS
                .iter()
                .map(|m| value(m.key).unwrap_or(f64::NAN))
                .collect(),
            pixels: count("pixels")?,
            not_finite: count("not_finite")?,
        })
    }
}
