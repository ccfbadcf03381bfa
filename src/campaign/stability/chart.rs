//! Charts of a suite, SVG.

use super::record::{CaseRecord, FrameScore, PartResult, Report};
use crate::campaign::charts::{Axis, Bar, Line, bars, file_name, lines};
use crate::lab::LabError;
use crate::metrics::RELMSE;
use crate::results::table::short;

pub(super) struct Chart {
    /// File name without its ending.
    pub name: String,
    /// Case of the chart, `None` for the whole suite.
    pub case: Option<String>,
    pub svg: String,
}

/// Bars over all results: part, name, title, value.
type Bars<'r> = (&'r str, String, String, fn(&PartResult) -> Option<f64>);

fn all_bars<'r>(focus: Option<(&'r str, &'r str)>) -> Vec<Bars<'r>> {
    let mut list: Vec<Bars> = vec![(
        "total",
        "all E_t".into(),
        "E_t of the total, radiance".into(),
        |p| p.e,
    )];
    if let Some((part, title)) = focus {
        let flicker = format!("Flicker index of {title}, mean over pixels");
        list.push((
            part,
            format!("all E_t of {part}"),
            format!("E_t of {title}, radiance"),
            |p| p.e,
        ));
        list.push((part, format!("all flicker of {part}"), flicker, |p| {
            p.flicker.map(|f| f.mean)
        }));
    }
    let error = "relMSE of the total, last frame".into();
    list.push(("total", "all relMSE".into(), error, |p| {
        p.scores.as_ref().map(|s| s.get(RELMSE))
    }));
    list
}

/// E_t of each case by frame, the error after a switch or a cut, the response to a switched light,
/// and bars over all results.
pub(super) fn charts(report: &Report) -> Result<Vec<Chart>, LabError> {
    let mut out = Vec::new();
    let focus = report.focus.as_ref().map(|f| (f.0.as_str(), f.1.as_str()));
    for (part, name, title, value) in all_bars(focus) {
        let bar = |r: &CaseRecord| {
            let part = r.part(part)?;
            let hollow = title.starts_with("E_t") && part.told_apart == Some(false);
            let method = r.about.method.clone();
            Some(Bar {
                label: format!("{}, {method}", r.about.title()),
                parts: vec![(method, value(part)?)],
                hollow,
            })
        };
        let list: Vec<Bar> = report.results.iter().filter_map(bar).collect();
        if list.iter().any(|b| b.parts[0].1 > 0.0) {
            out.push(Chart {
                name: file_name(&name),
                case: None,
                svg: bars(&title, "", short, &list)?,
            });
        }
    }
    for (case, of) in report.cases() {
        case_charts(&case, &of, focus, &mut out)?;
    }
    Ok(out)
}

/// The charts of one case over its frames.
fn case_charts(
    case: &str,
    of: &[&CaseRecord],
    focus: Option<(&str, &str)>,
    out: &mut Vec<Chart>,
) -> Result<(), LabError> {
    let over_frames = |value: Score, part: &str| over_frames(of, value, part);
    // The reference is the same for all methods, so the first one's is taken.
    let grey = |lines: Vec<Line>, name: &str| {
        lines.into_iter().next().map(|l| Line {
            name: name.into(),
            grey: true,
            ..l
        })
    };
    let mut add = |name: &str, what: &str, unit: &str, lines: Vec<Line>| {
        let title = format!("{case}: {what}");
        let svg = frames_chart(&title, unit, &lines)?;
        let chart = |svg| Chart {
            name: file_name(&format!("{case} {name}")),
            case: Some(case.into()),
            svg,
        };
        out.extend(svg.map(chart));
        Ok::<(), LabError>(())
    };
    for part in std::iter::once("total").chain(focus.map(|f| f.0)) {
        let mut lines = over_frames(|f| f.change.map(|c| c.rms), part);
        lines.extend(grey(
            over_frames(|f| f.noise, part),
            "noise of the reference",
        ));
        let what = format!("E_t of {part}");
        add(&what, &what, "radiance", lines)?;
    }
    let Some((part, title)) = focus else {
        return Ok(());
    };
    let measured = || of.iter().filter_map(|r| r.done());
    if measured().any(|m| m.event.is_some()) {
        let lines = over_frames(|f| f.relmse, part);
        add("error", &format!("relMSE of {title}"), "relMSE", lines)?;
    }
    if measured().any(|m| m.parts.values().any(|p| p.step.is_some())) {
        let mut lines = over_frames(|f| f.mean, part);
        lines.extend(grey(over_frames(|f| f.reference_mean, part), "reference"));
        let what = format!("mean luminance of {title}");
        add("response", &what, "radiance", lines)?;
    }
    Ok(())
}

/// A score of a frame.
type Score = fn(&FrameScore) -> Option<f64>;

/// A line for each result that has several scores of a part.
fn over_frames(of: &[&CaseRecord], value: Score, part: &str) -> Vec<Line> {
    let line = |r: &&CaseRecord| {
        let point = |f: &FrameScore| Some((f.frame as f64, value(f)?));
        let points: Vec<_> = r.part(part)?.frames.iter().filter_map(point).collect();
        (points.len() > 1).then(|| Line {
            name: r.about.method.clone(),
            points,
            grey: false,
        })
    };
    of.iter().filter_map(line).collect()
}

/// Values by frame, `None` if all are 0.
fn frames_chart(title: &str, unit: &str, list: &[Line]) -> Result<Option<String>, LabError> {
    let points = || list.iter().flat_map(|l| &l.points);
    let most = points().map(|p| p.1).fold(0.0, f64::max);
    if most <= 0.0 {
        return Ok(None);
    }
    let (first, last) = points().fold((f64::INFINITY, 0.0f64), |(a, b), p| {
        (a.min(p.0), b.max(p.0))
    });
    let x = Axis::linear("frame", (first, last.max(first + 1.0)));
    lines(title, &x, &Axis::linear(unit, (0.0, most * 1.08)), list).map(Some)
}
