//! Every metric, described once: tables, charts, verdicts and options read it here.

use super::means::{self, Mask};
use super::{Compared, NOISE_FACTOR};
use serde::de::Error;
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::BTreeMap;
use std::fmt;

/// A number that says how far a picture is from a reference. Means are over pixels and channels, except where luminance is
/// named; pixels that are infinite or no number in either picture are left out of all but those of FLIP, where they count
/// as 1.
pub struct Metric {
    /// Its name in JSON, in files and on the command line.
    pub key: &'static str,
    /// Its name for people.
    pub title: &'static str,
    /// Its name where there is little room; nothing if tables for people leave it out.
    pub head: Option<&'static str>,
    /// Definition, x the picture and r the reference, with unit or range.
    pub help: &'static str,
    /// Where a picture is best.
    pub best: Best,
    /// Whether tables of a few metrics have it.
    pub brief: bool,
    /// How much of it the reference's noise makes, where that is known.
    pub noise: Option<OfNoise>,
    pub(super) of: fn(&Compared, Mask) -> f64,
}

/// Where a picture is best by a metric.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Best {
    /// At 0; there is nothing below.
    Zero,
    /// At 1; a ratio is as far from it as its inverse.
    One,
    /// Nowhere: pictures are not compared by it.
    Nowhere,
}

/// Noise floor of a reference, from the means of its even and of its odd samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// relMSE of one mean against the other. The mean of all samples is four times better.
    pub relmse: f64,
    /// Structure error of the mean of all samples ([`super::structure_noise`]), natural log units.
    pub structure: f64,
}

/// What a reference's noise is to a metric.
pub struct OfNoise {
    /// How it is told.
    pub of: fn(Noise) -> f64,
    /// So many times it is what a picture without error has.
    pub perfect: f64,
    /// Differences below so many times it are none.
    pub none: f64,
}

/// Key of the metric whose noise stands for that of a picture.
pub const RELMSE: &str = "relmse";

/// All metrics, in the order in which they are shown. `over_occlusion` says not which of two pictures is better: it is the
/// mean over other pixels for each.
pub static METRICS: &[Metric] = &[
    Metric {
        brief: true,
        noise: Some(OfNoise {
            of: |n| n.relmse,
            perfect: 0.25,
            none: NOISE_FACTOR,
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

/// An error that few tables have and whose noise is not known.
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
    /// The metric of a key.
    pub fn of(key: &str) -> Option<&'static Metric> {
        METRICS.iter().find(|m| m.key == key)
    }

    /// Metrics by which pictures are compared.
    pub fn ranking() -> impl Iterator<Item = &'static Metric> {
        METRICS.iter().filter(|m| m.best != Best::Nowhere)
    }

    /// Those of short tables.
    pub fn few() -> impl Iterator<Item = &'static Metric> {
        METRICS.iter().filter(|m| m.brief)
    }

    /// Its name in tables.
    pub fn short(&self) -> &'static str {
        self.head.unwrap_or(self.title)
    }

    /// How far a value is from the best one.
    pub fn distance(&self, value: f64) -> f64 {
        if self.best == Best::One {
            value.ln().abs()
        } else {
            value
        }
    }

    /// Name of its distance on axes.
    pub fn axis(&self) -> String {
        if self.best == Best::One {
            format!("|ln {}|", self.title)
        } else {
            self.title.into()
        }
    }

    /// Whether a distance, or a difference of two, is not told from the noise of the reference.
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

/// How far a picture is from a reference by every metric; in JSON an object of their keys, `pixels` and `not_finite`.
#[derive(Clone, Debug, PartialEq)]
pub struct Scores {
    /// In the order of [`METRICS`].
    values: Vec<f64>,
    /// Pixels.
    pub pixels: u64,
    /// Pixels that are infinite or no number in either picture.
    pub not_finite: u64,
}

impl Scores {
    /// By these metrics; by others it is no number. Nothing without a finite pixel.
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

    /// The value of a metric; no number where it has none, or there is no such metric.
    pub fn get(&self, key: &str) -> f64 {
        self.values()
            .find(|v| v.0.key == key)
            .map_or(f64::NAN, |v| v.1)
    }

    /// All metrics and their values.
    pub fn values(&self) -> impl Iterator<Item = (&'static Metric, f64)> {
        METRICS.iter().zip(self.values.iter().copied())
    }

    /// Everything that is a number, by its name in JSON.
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
    /// A metric that is `null`, or missing because the file is older than it, is no number.
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
