//! Least error of each family of methods in equal time, and least time within an equal error.

use super::data::{Data, Scored};
use super::scatter::groups;
use crate::lab::LabError;
use crate::metrics::{METRICS, Metric};
use crate::results::table::{Table, short};
use maud::{Markup, html};

/// Metric and light component of the tables.
const METRIC: &str = "flip";
const PART: &str = "total";
/// Error limits.
const ERRORS: [f64; 5] = [0.02, 0.04, 0.06, 0.1, 0.15];
/// Range of the time limits, as powers of 2 [ms].
const TIMES: (i32, i32) = (-3, 10);

/// A scene and its families.
pub struct Equal {
    subjects: Vec<SubjectTable>,
}

struct SubjectTable {
    title: String,
    times: Vec<f64>,
    rows: Vec<Family>,
}

struct Family {
    name: String,
    /// Least error within each time; `None` if no point is as fast.
    errors: Vec<Option<f64>>,
    /// Least time within each of [`ERRORS`], ms; `None` if no point is as good.
    times: Vec<Option<f64>>,
}

fn least(values: impl Iterator<Item = f64>) -> Option<f64> {
    values.min_by(f64::total_cmp)
}

impl Family {
    fn new(name: &str, dots: &[Scored], times: &[f64]) -> Family {
        let own = || dots.iter().filter(|d| d.experiment == name);
        let within = |t: &f64| least(own().filter(|d| d.ms <= *t).map(|d| d.error));
        let price = |e: &f64| least(own().filter(|d| d.error <= *e).map(|d| d.ms));
        Family {
            name: name.into(),
            errors: times.iter().map(within).collect(),
            times: ERRORS.iter().map(price).collect(),
        }
    }
}

impl Equal {
    /// `None` where there is one family, or no score.
    pub fn of(data: &Data) -> Option<Equal> {
        let metric: &Metric = METRICS.iter().find(|m| m.key == METRIC)?;
        let mut subjects = Vec::new();
        for (subject, title) in data.subjects.iter().enumerate() {
            let dots = data.scored(subject, PART, metric);
            let names = groups(&dots);
            if names.len() < 2 {
                continue;
            }
            let fastest = least(dots.iter().map(|d| d.ms))?;
            let slowest = dots.iter().map(|d| d.ms).max_by(f64::total_cmp)?;
            // Powers of two from the first that a point meets to the first that all meet.
            let all = (TIMES.0..=TIMES.1).map(|power| f64::from(power).exp2());
            let times: Vec<f64> = all
                .filter(|t| *t >= fastest && *t < 2.0 * slowest)
                .collect();
            let rows = names.iter().map(|name| Family::new(name, &dots, &times));
            subjects.push(SubjectTable {
                title: title.clone(),
                rows: rows.collect(),
                times,
            });
        }
        (!subjects.is_empty()).then_some(Equal { subjects })
    }

    /// Section of the page.
    pub fn html(&self) -> Markup {
        let shown = |v: &Option<f64>| v.map_or("-".into(), short);
        html! {
            h2 { "Equal time, equal error" }
            p {
                "FLIP of the total that the best setting of each family reaches in so many milliseconds, and the milliseconds \
                 of its fastest setting within a FLIP. -: none of its settings is as fast or as good."
            }
            @for subject in &self.subjects {
                h3 { (subject.title) }
                table.equal {
                    tr {
                        th {}
                        @for t in &subject.times { th { (short(*t)) " ms" } }
                        @for e in ERRORS { th { "FLIP " (e) } }
                    }
                    @for row in &subject.rows {
                        tr {
                            th { (row.name) }
                            @for v in &row.errors { td { (shown(v)) } }
                            @for v in &row.times { td { (shown(v)) @if v.is_some() { " ms" } } }
                        }
                    }
                }
            }
        }
    }

    /// As comma-separated values (RFC 4180), a line for each scene, family and question.
    pub fn csv(&self) -> Result<String, LabError> {
        let mut lines: Vec<[String; 5]> = Vec::new();
        for subject in &self.subjects {
            for row in &subject.rows {
                let mut line = |asked: &str, limit: f64, value: Option<f64>| {
                    let value = value.map_or(String::new(), |v| v.to_string());
                    let limit = limit.to_string();
                    lines.push([
                        subject.title.clone(),
                        row.name.clone(),
                        asked.into(),
                        limit,
                        value,
                    ]);
                };
                for (t, v) in subject.times.iter().zip(&row.errors) {
                    line("flip within ms", *t, *v);
                }
                for (e, v) in ERRORS.iter().zip(&row.times) {
                    line("ms within flip", *e, *v);
                }
            }
        }
        let mut table = Table::new(&lines);
        for (i, name) in ["subject", "family", "asked", "limit", "value"]
            .into_iter()
            .enumerate()
        {
            table.column(name, move |l| l[i].clone());
        }
        table.csv()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::report::data::dot;

    #[test]
    fn a_family_is_as_good_as_its_best_setting() {
        let dots = [
            dot(1.0, 0.12, "a"),
            dot(3.0, 0.05, "a"),
            dot(3.5, 0.09, "a"),
            dot(0.4, 0.2, "b"),
        ];
        let a = Family::new("a", &dots, &[0.5, 1.0, 4.0]);
        assert_eq!(a.errors, [None, Some(0.12), Some(0.05)]);
        // Within FLIP 0.02, 0.04, 0.06, 0.1 and 0.15.
        assert_eq!(a.times, [None, None, Some(3.0), Some(3.0), Some(1.0)]);
        let b = Family::new("b", &dots, &[0.5, 1.0, 4.0]);
        assert_eq!(b.errors, [Some(0.2); 3]);
        assert_eq!(b.times, [None; 5]);
    }
}
