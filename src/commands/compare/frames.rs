//! Error of experiments by frame and by GPU time: how fast pictures converge.

use crate::campaign::charts::{Axis, Line, lines};
use crate::lab::{LabError, Session};
use crate::measure::comparison::{Comparison, Request, Side, compare};
use crate::metrics::{METRICS, Noise, Scores};
use crate::results::table::{Table, four_digits, number};
use std::path::{Path, PathBuf};

/// Frames when `--frames` is absent.
const FRAMES: usize = 256;
/// Metrics with charts.
const CHARTS: [(&str, &str); 2] = [("relmse", "relMSE"), ("flip", "FLIP")];

/// Scores of an experiment after some of its frames.
pub(super) struct Step {
    picture: String,
    frames: usize,
    /// GPU time of all frames so far, ms; all parts are computed.
    gpu_ms: f64,
    scores: Scores,
    /// Noise of the reference, if known.
    noise: Option<Noise>,
}

/// 1, 2, 4 and so on, and the last frame.
fn measured_frames(last: usize) -> Vec<usize> {
    let powers = std::iter::successors(Some(1), |n| Some(2 * n));
    powers.take_while(|n| *n < last).chain([last]).collect()
}

/// Scores after 1, 2, 4, ... frames.
pub(super) fn steps(
    session: &mut Session,
    picture: &str,
    reference: &Side,
    last: Option<usize>,
    part: &str,
) -> Result<Vec<Step>, LabError> {
    let (mut out, mut ran, mut gpu_ms) = (Vec::new(), 0, 0.0);
    for frames in measured_frames(last.unwrap_or(FRAMES)) {
        for _ in ran..frames {
            gpu_ms += session.frame(0.0)?.map_or(0.0, |t| t.gpu_ms);
        }
        gpu_ms += session.finish()?.iter().map(|t| t.gpu_ms).sum::<f64>();
        ran = frames;
        let side = Side::new(picture, session.parts()?);
        let request = Request {
            parts: &[part.into()],
            masks: &[],
            maps: None,
        };
        let scores = whole(compare(&[side], reference, request)?);
        out.extend(scores.map(|scores| Step {
            picture: picture.into(),
            frames,
            gpu_ms,
            scores,
            noise: reference.noise.get(part).copied(),
        }));
    }
    Ok(out)
}

/// Scores of the whole frame.
fn whole(comparison: Comparison) -> Option<Scores> {
    let part = comparison.parts.into_iter().next()?;
    part.regions.into_iter().next()?.scores.pop()?
}

/// Writes `frames.csv` and the charts. Returns what was written.
pub(super) fn write(folder: &Path, part: &str, steps: &[Step]) -> Result<Vec<PathBuf>, LabError> {
    let mut table = Table::new(steps);
    table.column("picture", |s| s.picture.clone());
    table.column("frames", |s| s.frames.to_string());
    table.column("GPU ms", |s| s.gpu_ms.to_string());
    for metric in METRICS {
        table.column(metric.key, |s| s.scores.get(metric.key).to_string());
        if let Some(of) = &metric.noise {
            table.column(format!("{} noise", metric.key), |s| {
                number(s.noise.map(of.of))
            });
        }
    }
    let mut files = vec![("frames.csv".to_string(), table.csv()?)];
    let marks: Vec<f64> = measured_frames(steps.iter().map(|s| s.frames).max().unwrap_or(1))
        .into_iter()
        .map(|n| n as f64)
        .collect();
    for (key, title) in CHARTS {
        let chart = |x: &str, of: fn(&Step) -> f64, marks| {
            let title = (format!("{title} of the part {part}"), x, title);
            chart(title, steps, |s| (of(s), s.scores.get(key)), marks)
        };
        let by_frame = chart("frames", |s| s.frames as f64, Some(&marks))?;
        let by_time = chart("GPU time of all frames, ms", |s| s.gpu_ms, None)?;
        for (name, svg) in [("frames", by_frame), ("time", by_time)] {
            files.extend(svg.map(|svg| (format!("{key}-{name}.svg"), svg)));
        }
    }
    let mut written = Vec::new();
    for (name, text) in files {
        let path = folder.join(name);
        crate::files::write_whole(&path, text.as_bytes())?;
        written.push(path);
    }
    Ok(written)
}

/// A line for each picture; `None` without two points above 0 on both axes. Titles: of the chart and of its axes.
fn chart(
    (title, x, y): (String, &str, &str),
    steps: &[Step],
    point: impl Fn(&Step) -> (f64, f64),
    marks: Option<&Vec<f64>>,
) -> Result<Option<String>, LabError> {
    let mut list: Vec<Line> = Vec::new();
    for step in steps {
        let point = point(step);
        if point.0 <= 0.0 || point.1 <= 0.0 || !point.1.is_finite() {
            continue;
        }
        match list.last_mut().filter(|l| l.name == step.picture) {
            Some(line) => line.points.push(point),
            None => list.push(Line {
                name: step.picture.clone(),
                points: vec![point],
                grey: false,
            }),
        }
    }
    let points: Vec<_> = list.iter().flat_map(|l| &l.points).copied().collect();
    let range = |values: Vec<f64>, margin: f64| {
        let (low, high) = values
            .iter()
            .fold((f64::INFINITY, 0.0f64), |(a, b), v| (a.min(*v), b.max(*v)));
        (low / margin, high * margin)
    };
    let (across, up) = (
        range(points.iter().map(|p| p.0).collect(), 1.0),
        range(points.iter().map(|p| p.1).collect(), 1.1),
    );
    if points.len() < 2 || across.0 >= across.1 {
        return Ok(None);
    }
    let mut across = Axis::log(x, across);
    if let Some(marks) = marks {
        across = across.marked(marks.clone());
    }
    lines(&title, &across, &Axis::log(y, up), &list).map(Some)
}

/// The steps as text.
pub(super) fn text(steps: &[Step]) -> String {
    let mut table = Table::new(steps);
    table.column("picture", |s| s.picture.clone());
    table.column("frames", |s| s.frames.to_string());
    table.column("GPU ms", |s| format!("{:.1}", s.gpu_ms));
    for (key, title) in CHARTS {
        table.column(title, |s| four_digits(s.scores.get(key)));
    }
    table.text()
}
