//! Axes of a sweep: lists, ranges, named settings, lists that go together, samples.

use crate::campaign::points::Labels;
use crate::campaign::settings::{Setting, settings};
use crate::diagnostics::{At, Entries, Items, Loc, RawText};
use crate::scene::splitmix;
use serde::Deserialize;

/// Largest number of points of a sweep.
pub(super) const MAX_POINTS: usize = 20_000;

/// An axis of the file.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) enum Axis {
    /// One setting, value by value.
    List {
        name: Loc<String>,
        values: Items<RawText>,
    },
    /// One number, from one end to the other.
    Range {
        name: Loc<String>,
        from: Loc<f64>,
        to: Loc<f64>,
        count: Loc<usize>,
        #[serde(default)]
        scale: Scale,
        /// Values are multiples of it; those that become equal are measured once.
        #[serde(default)]
        multiple_of: Option<Loc<f64>>,
    },
    /// Several settings at once under one name.
    Settings {
        name: Loc<String>,
        values: Entries<Entries<RawText>>,
    },
    /// Lists of one length, walked together.
    Together(Entries<Items<RawText>>),
    /// Random settings that cover each of their ranges evenly.
    Sample {
        count: Loc<usize>,
        #[serde(default)]
        seed: u64,
        of: Entries<Distribution>,
    },
}

/// Spacing of a range's values.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub(super) enum Scale {
    /// At equal distances.
    #[default]
    Linear,
    /// At equal ratios.
    Log,
}

/// The distribution that a sampled setting is drawn from.
#[derive(Clone, Debug, Deserialize)]
pub(super) enum Distribution {
    Uniform(f64, f64),
    /// Numbers above 0, every ratio as likely.
    Log(f64, f64),
    /// Whole numbers, both ends included.
    Whole(i64, i64),
    /// Values of a list.
    Among(Items<RawText>),
}

/// One choice of an axis.
#[derive(Clone, Debug)]
pub(super) struct Choice {
    /// Name and value of the varied setting, for labels.
    pub labels: Labels,
    pub settings: Vec<Setting>,
}

impl Choice {
    fn one(name: &Loc<String>, at: At, text: String) -> Choice {
        Choice::of(vec![Setting {
            name: Loc {
                value: name.value.clone(),
                at,
            },
            text,
        }])
    }

    /// Settings that are their own labels.
    pub(super) fn of(settings: Vec<Setting>) -> Choice {
        Choice {
            labels: settings.iter().map(label).collect(),
            settings,
        }
    }
}

/// A name without its quotes.
fn label(setting: &Setting) -> (String, String) {
    let text = setting.text.trim();
    let bare = text
        .strip_prefix('"')
        .and_then(|t| t.strip_suffix('"'))
        .unwrap_or(text);
    (setting.name.value.clone(), bare.to_string())
}

/// Place, if not the whole axis, and message.
type Wrong = (Option<At>, String);

/// The choices of an axis, in order.
pub(super) fn choices(axis: &Axis) -> Result<Vec<Choice>, Wrong> {
    let list: Vec<Choice> = match axis {
        Axis::List { name, values } => values
            .0
            .iter()
            .map(|v| Choice::one(name, v.at, v.value.0.clone()))
            .collect(),
        Axis::Range {
            name,
            from,
            to,
            count,
            scale,
            multiple_of,
        } => {
            let mut values = range(from, to, count, *scale, multiple_of.as_ref())?;
            values.dedup();
            values
                .into_iter()
                .map(|v| Choice::one(name, from.at, number(v)))
                .collect()
        }
        Axis::Settings { name, values } => {
            let choice = |(label, set): &(Loc<String>, Loc<Entries<RawText>>)| Choice {
                labels: vec![(name.value.clone(), label.value.clone())],
                settings: settings(&set.value),
            };
            values.0.iter().map(choice).collect()
        }
        Axis::Together(lists) => together(lists)?,
        Axis::Sample { count, seed, of } => {
            if count.value > MAX_POINTS {
                return Err((
                    Some(count.at),
                    format!(
                        "{} samples are more than the {MAX_POINTS} allowed",
                        count.value
                    ),
                ));
            }
            sample(count.value, *seed, of)?
        }
    };
    if list.is_empty() {
        Err((None, "this axis has no values".into()))
    } else {
        Ok(list)
    }
}

fn range(
    from: &Loc<f64>,
    to: &Loc<f64>,
    count: &Loc<usize>,
    scale: Scale,
    multiple_of: Option<&Loc<f64>>,
) -> Result<Vec<f64>, Wrong> {
    let (a, b, n) = (from.value, to.value, count.value);
    if !a.is_finite() || !b.is_finite() {
        return Err((Some(from.at), "the ends of a range must be finite".into()));
    }
    if scale == Scale::Log && (a <= 0.0 || b <= 0.0) {
        return Err((
            Some(from.at),
            "the ends of a range at equal ratios must be above 0".into(),
        ));
    }
    if n == 0 || n > MAX_POINTS {
        return Err((
            Some(count.at),
            format!("a range has 1 to {MAX_POINTS} values"),
        ));
    }
    if let Some(m) = multiple_of.filter(|m| m.value.is_nan() || m.value <= 0.0) {
        return Err((Some(m.at), "multiples must be of a number above 0".into()));
    }
    let value = |i: usize| {
        let t = if n == 1 {
            0.0
        } else {
            i as f64 / (n - 1) as f64
        };
        let v = match scale {
            Scale::Linear => a + (b - a) * t,
            Scale::Log => a * (b / a).powf(t),
        };
        multiple_of.map_or(v, |m| (v / m.value).round() * m.value)
    };
    Ok((0..n).map(value).collect())
}

fn together(lists: &Entries<Items<RawText>>) -> Result<Vec<Choice>, Wrong> {
    let length = lists.0.first().map_or(0, |l| l.1.value.0.len());
    if let Some((name, list)) = lists.0.iter().find(|l| l.1.value.0.len() != length) {
        let found = list.value.0.len();
        let message = format!(
            "'{}' has {found} values and the first list {length}: they are walked together",
            name.value
        );
        return Err((Some(list.at), message));
    }
    let choice = |i: usize| {
        let setting = |(name, list): &(Loc<String>, Loc<Items<RawText>>)| {
            Setting::new(name, &list.value.0[i])
        };
        Choice::of(lists.0.iter().map(setting).collect())
    };
    Ok((0..length).map(choice).collect())
}

fn sample(count: usize, seed: u64, of: &Entries<Distribution>) -> Result<Vec<Choice>, Wrong> {
    for (name, distribution) in &of.0 {
        let wrong = match &distribution.value {
            Distribution::Uniform(a, b) => !a.is_finite() || !b.is_finite() || a > b,
            Distribution::Log(a, b) => !a.is_finite() || !b.is_finite() || a > b || *a <= 0.0,
            Distribution::Whole(a, b) => a > b,
            Distribution::Among(list) => list.0.is_empty(),
        };
        if wrong {
            return Err((
                Some(distribution.at),
                format!("'{}': nothing can be drawn from this", name.value),
            ));
        }
    }
    let samples = latin_hypercube(count, of.0.len(), seed);
    let choice = |coordinates: Vec<f64>| {
        let setting = |((name, d), u): (&(Loc<String>, Loc<Distribution>), f64)| {
            let name = Loc {
                value: name.value.clone(),
                at: d.at,
            };
            Setting {
                name,
                text: draw(&d.value, u),
            }
        };
        Choice::of(of.0.iter().zip(coordinates).map(setting).collect())
    };
    Ok(samples.into_iter().map(choice).collect())
}

/// `count` points in the unit cube of `dimensions` dimensions: along every axis each of `count`
/// equal intervals holds one point (McKay, Beckman and Conover 1979). The same on every machine.
fn latin_hypercube(count: usize, dimensions: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut state = seed;
    let mut points = vec![Vec::with_capacity(dimensions); count];
    for _ in 0..dimensions {
        let mut order: Vec<usize> = (0..count).collect();
        for i in (1..count).rev() {
            order.swap(i, (splitmix(&mut state) % (i as u64 + 1)) as usize);
        }
        for (point, interval) in points.iter_mut().zip(order) {
            let inside = (splitmix(&mut state) >> 11) as f64 / (1u64 << 53) as f64;
            point.push((interval as f64 + inside) / count as f64);
        }
    }
    points
}

/// The value at `u` in [0, 1) of a distribution's range.
fn draw(distribution: &Distribution, u: f64) -> String {
    match distribution {
        Distribution::Uniform(a, b) => number((a + (b - a) * u).clamp(*a, *b)),
        Distribution::Log(a, b) => number((a * (b / a).powf(u)).clamp(*a, *b)),
        Distribution::Whole(a, b) => {
            let width = (*b as f64) - (*a as f64) + 1.0;
            ((*a as f64 + (width * u).floor()).min(*b as f64) as i64).to_string()
        }
        Distribution::Among(list) => {
            let i = ((list.0.len() as f64 * u) as usize).min(list.0.len() - 1);
            list.0[i].value.0.clone()
        }
    }
}

/// A number with at most five significant digits: settings are read by people too.
fn number(v: f64) -> String {
    format!("{v:.4e}").parse::<f64>().unwrap_or(v).to_string()
}
