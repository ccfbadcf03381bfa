//! A comparison as text.

use super::{Comparison, PartComparison, RegionComparison};
use crate::metrics::{METRICS, Metric, Scores};
use crate::results::table::{Table, four_digits};
use std::fmt::Write as _;

const LETTERS: [&str; 2] = ["A", "B"];

/// The comparison as a table: a block per component, a row per region and picture.
pub fn table(comparison: &Comparison) -> String {
    let mut out = String::new();
    for (letter, name) in LETTERS.iter().zip(&comparison.pictures) {
        let _ = writeln!(out, "{letter}: {name}");
    }
    let _ = writeln!(out, "reference: {}", comparison.reference);
    if comparison.displayed {
        let _ = writeln!(
            out,
            "Pictures for a display: all numbers, HDR-FLIP too, are of the displayed range 0 to 1."
        );
    }
    for part in &comparison.parts {
        block(&mut out, part, &comparison.pictures);
    }
    out
}

fn block(out: &mut String, part: &PartComparison, pictures: &[String]) {
    let lines: Vec<Line> = part.regions.iter().flat_map(lines).collect();
    let mut table = Table::new(&lines);
    table.column(&part.part, |l| l.0.clone());
    table.column("", |l| l.1.into());
    for (i, (_, head)) in columns().enumerate() {
        table.column(head, |l| l.2.get(i).cloned().unwrap_or("-".into()));
    }
    let _ = write!(out, "\n{}", table.text());
    if let (Some(relmse), Some(flip), Some(structure)) =
        (part.noise, part.flip_noise, part.structure_noise)
    {
        let [relmse, flip, structure] = [relmse, flip, structure].map(four_digits);
        let _ = writeln!(
            out,
            "  noise of the reference: relMSE {relmse}, FLIP {flip}, structure {structure}"
        );
    }
    let frame = part.regions.first();
    for (i, (letter, name)) in LETTERS.iter().zip(pictures).enumerate() {
        let scores = frame.and_then(|f| f.scores.get(i)?.as_ref());
        if let Some(bad) = scores.map(|s| s.not_finite).filter(|n| *n > 0) {
            let _ = writeln!(
                out,
                "  {letter}: {bad} pixels are infinite or no number there or in the reference ({name})"
            );
        }
        if frame.is_some_and(|f| f.within_noise.get(i) == Some(&true)) {
            let _ = writeln!(
                out,
                "  {letter} is indistinguishable from the reference: relMSE is below 4 times its noise"
            );
        }
    }
}

/// Region, letter of the picture, and scores. There are no scores without a finite pixel.
type Line = (String, &'static str, Vec<String>);

fn lines(region: &RegionComparison) -> Vec<Line> {
    let mut title = match region.share {
        1.0 => region.region.clone(),
        share => format!("{} ({:.1} %)", region.region, 100.0 * share),
    };
    let mut lines: Vec<Line> = Vec::new();
    for (letter, scores) in LETTERS.iter().zip(&region.scores) {
        let cells = |s: &Scores| columns().map(|(m, _)| four_digits(s.get(m.key))).collect();
        let cells = scores.as_ref().map_or(Vec::new(), cells);
        lines.push((std::mem::take(&mut title), letter, cells));
    }
    if !region.better.is_empty() {
        let verdict = |(metric, _): (&Metric, _)| match region.better.get(metric.key) {
            Some(verdict) => verdict.to_string(),
            None => String::new(),
        };
        lines.push(("  better".into(), "", columns().map(verdict).collect()));
    }
    lines
}

/// The metrics with a column, and its heading.
fn columns() -> impl Iterator<Item = (&'static Metric, &'static str)> {
    METRICS.iter().filter_map(|m| Some((m, m.head?)))
}
