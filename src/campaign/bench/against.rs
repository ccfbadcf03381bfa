//! Comparison of a benchmark with recorded times.
//!
//! Other programs, heat and rising clocks only add time. So the minimum of the rounds' medians is
//! compared. Timestamps of very short stages jitter by more than a tenth, so a stage must also lose
//! [`FLOOR_MS`]. If recorded rounds scatter, its best round must exceed the recorded median.

use super::record::{Record, Recorded, plain};
use super::{Bench, Times};
use crate::results::stats::{DeviceStats, spread};
use crate::results::table::Table;
use std::fmt::Write;

/// Smallest change of a stage that counts, ms.
pub const FLOOR_MS: f64 = 0.02;

/// Most settings that are named one by one.
const MAX_NAMED: usize = 8;

/// A stage's time compared with the recorded one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Within the tolerance.
    Same,
    /// Slower by more than the tolerance.
    Slower,
    /// Faster by more than the tolerance.
    Faster,
    /// Slower by more than the tolerance, but so were half of the recorded rounds.
    Noisy,
    /// Not in the record.
    New,
    /// Only in the record.
    Gone,
}

/// One stage, or the whole frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Name of the stage; `total`.
    pub stage: String,
    /// Least of the rounds' medians, ms.
    pub recorded: Option<f64>,
    /// The time measured today.
    pub now: Option<f64>,
    /// The comparison of the two.
    pub verdict: Verdict,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Compared {
    /// Title of the configuration.
    pub title: String,
    /// Stages in the order of today's graph, then missing ones, then the total.
    pub rows: Vec<Row>,
    /// Other differences from the recording.
    pub notes: Vec<String>,
}

/// Compares times with recorded ones. `sha256` is the hash of today's scene.
pub fn compare(recorded: &Recorded, times: &Times, sha256: &str, tolerance: f64) -> Compared {
    let row = |stage: &str, before: Option<&Vec<f64>>, now: Option<&Vec<f64>>| Row {
        stage: stage.into(),
        recorded: before.map(|list| least(list)),
        now: now.map(|list| least(list)),
        verdict: match (before, now) {
            (Some(before), Some(now)) => judge(before, now, tolerance),
            (None, _) => Verdict::New,
            (_, None) => Verdict::Gone,
        },
    };
    let mut rows: Vec<Row> = times
        .stage_rounds
        .iter()
        .map(|(stage, now)| row(stage, recorded.stages.get(stage), Some(now)))
        .collect();
    let gone = recorded
        .stages
        .iter()
        .filter(|(stage, _)| !times.stage_rounds.contains_key(*stage));
    rows.extend(gone.map(|(stage, before)| row(stage, Some(before), None)));
    rows.push(row("total", Some(&recorded.total), Some(&times.rounds)));
    Compared {
        title: recorded.title(),
        rows,
        notes: notes(recorded, times, sha256),
    }
}

/// Compares medians of rounds with recorded ones, ms. `tolerance` is relative to the recorded time.
pub fn judge(recorded: &[f64], now: &[f64], tolerance: f64) -> Verdict {
    let (before, after) = (least(recorded), least(now));
    let beyond = |a: f64, b: f64| b > a * (1.0 + tolerance) && b - a > FLOOR_MS;
    if beyond(before, after) {
        let middle = spread(recorded.to_vec()).median;
        return if after > middle {
            Verdict::Slower
        } else {
            Verdict::Noisy
        };
    }
    if beyond(after, before) {
        Verdict::Faster
    } else {
        Verdict::Same
    }
}

fn least(list: &[f64]) -> f64 {
    list.iter().copied().fold(f64::INFINITY, f64::min)
}

fn notes(recorded: &Recorded, times: &Times, sha256: &str) -> Vec<String> {
    let mut notes = Vec::new();
    if recorded.scene_sha256 != sha256 {
        notes.push("the scene is not the recorded one: its content differs".to_string());
    }
    let differing =
        recorded
            .params
            .iter()
            .filter_map(|(name, before)| match times.stats.params.get(name) {
                None => Some(format!("{name} (was {before}) is gone")),
                Some(now) if plain(now) != *before => {
                    Some(format!("{name} was {before}, is {}", plain(now)))
                }
                Some(_) => None,
            });
    let differing: Vec<String> = differing.collect();
    notes.extend(differing.iter().take(MAX_NAMED).cloned());
    if differing.len() > MAX_NAMED {
        notes.push(format!(
            "{} more parameters differ",
            differing.len() - MAX_NAMED
        ));
    }
    notes
}

pub fn against_text(record: &Record, bench: &Bench, compared: &[Compared]) -> String {
    let DeviceStats { name, driver, .. } = &bench.device;
    let mut out = format!(
        "{name} ({driver}), {} rounds of {} frames after at least {} of warm-up; GPU ms, least of the rounds' medians\n",
        bench.rounds, bench.frames.count, bench.frames.warmup
    );
    if record.device.driver != *driver {
        let _ = writeln!(
            out,
            "note: the driver was {}, is {driver}",
            record.device.driver
        );
    }
    for Compared { title, rows, notes } in compared {
        let ms = |value: Option<f64>| value.map_or("-".into(), |ms| format!("{ms:.3}"));
        let mut table = Table::new(rows);
        table.column("stage", |r| r.stage.clone());
        table.column("recorded", |r| ms(r.recorded));
        table.column("now", |r| ms(r.now));
        table.column("ratio", |r| {
            r.ratio().map_or("-".into(), |r| format!("{r:.2}"))
        });
        table.column("", |r| word(r.verdict).into());
        let _ = write!(out, "\n{title}\n{}", table.text());
        for note in notes {
            let _ = writeln!(out, "note: {note}");
        }
    }
    out
}

fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Same => "",
        Verdict::Slower => "slower",
        Verdict::Faster => "faster",
        Verdict::Noisy => "slower, but the recorded rounds scatter as far",
        Verdict::New => "new",
        Verdict::Gone => "gone",
    }
}

impl Row {
    /// Today's time relative to the recorded one.
    pub fn ratio(&self) -> Option<f64> {
        self.recorded
            .zip(self.now)
            .filter(|(before, _)| *before > 0.0)
            .map(|(before, now)| now / before)
    }
}

/// The slower stages by configuration in one line, `None` without any.
pub fn slower(compared: &[Compared]) -> Option<String> {
    let line = |row: &Row| match row.ratio() {
        Some(ratio) => format!("{} {ratio:.2} times", row.stage),
        None => row.stage.clone(),
    };
    let of = |c: &Compared| {
        let list: Vec<String> = c
            .rows
            .iter()
            .filter(|r| r.verdict == Verdict::Slower)
            .map(line)
            .collect();
        (!list.is_empty()).then(|| format!("{} ({})", list.join(", "), c.title))
    };
    let list: Vec<String> = compared.iter().filter_map(of).collect();
    (!list.is_empty()).then(|| list.join("; "))
}

/// A share as a percentage.
pub fn percent(part: f64) -> String {
    format!("{} %", (part * 1e4).round() / 100.0)
}
