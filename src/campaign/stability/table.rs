//! Results of a suite as comma-separated values (RFC 4180). Columns that end in ` ms` are times and
//! differ between runs. All others are the same on one device.

use super::record::{CaseRecord, FrameScore, Measured, PartResult, Report};
use crate::campaign::points::total_first;
use crate::lab::LabError;
use crate::metrics::{Best, METRICS};
use crate::results::table::{Table, cell, mebibytes, number};

pub(super) type Value = Box<dyn Fn(&PartResult) -> Option<f64>>;

/// A column of every part: title in the table, title on the page if it is shown there, value.
pub(super) type Column = (String, Option<&'static str>, Value);

type Of = fn(&PartResult) -> Option<f64>;

/// Columns of changes: title in the table, title on the page, value.
const CHANGES: [(&str, &str, Of); 10] = [
    ("E_t", "E_t", |p| p.e),
    ("E_t noise", "noise", |p| p.e_noise),
    ("pops", "pops", |p| p.pops),
    ("peak jump /255", "jump", |p| p.jump),
    ("flicker mean", "flicker", |p| p.flicker.map(|f| f.mean)),
    ("flicker p99", "its p99", |p| p.flicker.map(|f| f.p99)),
    ("flicker noise", "its noise", |p| p.flicker_noise),
    ("convergence frames", "frames to 5 %", |p| {
        p.step.and_then(|s| s.frames).map(|f| f as f64)
    }),
    ("overshoot", "overshoot", |p| p.step.map(|s| s.overshoot)),
    ("settling frames", "settling frames", |p| {
        p.settling.map(|f| f as f64)
    }),
];

/// Columns of every part: changes, then scores of the last frame.
pub(super) fn columns() -> Vec<Column> {
    let mut list: Vec<Column> = CHANGES
        .iter()
        .map(|(title, page, v)| (String::from(*title), Some(*page), Box::new(*v) as _))
        .collect();
    for metric in METRICS {
        let page = (metric.best != Best::Nowhere).then_some(metric.title);
        list.push((
            metric.title.into(),
            page,
            Box::new(|p| p.scores.as_ref().map(|s| s.get(metric.key))),
        ));
        if let Some(of) = &metric.noise {
            list.push((
                format!("{} noise", metric.title),
                None,
                Box::new(|p| Some((of.of)(p.reference_noise()))),
            ));
        }
    }
    list
}

/// All parts of the results.
pub(super) fn parts(report: &Report) -> Vec<String> {
    total_first(
        report
            .results
            .iter()
            .filter_map(|r| r.done())
            .flat_map(|m| m.parts.keys()),
    )
}

/// A row for every method in every case.
pub(super) fn rows(report: &Report) -> Result<String, LabError> {
    let mut table = Table::new(&report.results);
    let of = |value: fn(&Measured) -> String| move |r: &CaseRecord| cell(r.done().map(value));
    table.column("case", |r| r.about.case.clone());
    table.column("variant", |r| r.about.variant.clone());
    table.column("method", |r| r.about.method.clone());
    table.column("outcome", |r| {
        if r.done().is_some() { "done" } else { "failed" }.into()
    });
    table.column("error", |r| cell(r.error()));
    table.column("scene", |r| r.about.scene.clone());
    table.column("motion", |r| r.about.motion.clone());
    table.column("width", |r| r.about.size[0].to_string());
    table.column("height", |r| r.about.size[1].to_string());
    table.column("warmup", |r| r.about.warmup.to_string());
    table.column("frames", |r| r.about.frames.to_string());
    table.column("device", |r| r.device.name.clone());
    table.column("driver", |r| r.device.driver.clone());
    table.column("reference samples", of(|m| m.samples.to_string()));
    table.column("warnings", of(|m| m.warnings.join("; ")));
    table.column("frame ms", of(|m| m.frame_ms.to_string()));
    table.column("memory MiB", of(|m| mebibytes(m.memory_bytes)));
    table.column(
        "worst frame",
        of(|m| cell(m.worst.as_ref().map(|w| w.frame))),
    );
    table.column(
        "voxel recall",
        of(|m| number(m.voxels.as_ref().and_then(|v| v.recall))),
    );
    table.column(
        "voxel precision",
        of(|m| number(m.voxels.as_ref().and_then(|v| v.precision))),
    );
    for part in &parts(report) {
        for (title, _, value) in columns() {
            table.column(format!("{part} {title}"), |r| {
                number(r.part(part).and_then(&value))
            });
            if title == "E_t noise" {
                let told = |r: &CaseRecord| {
                    Some(if r.part(part)?.told_apart? {
                        "yes"
                    } else {
                        "no"
                    })
                };
                table.column(format!("{part} told apart"), |r| cell(told(r)));
            }
        }
    }
    table.csv()
}

/// A row for every frame of every part.
pub(super) fn frames(report: &Report) -> Result<String, LabError> {
    let parts = report
        .results
        .iter()
        .filter_map(|r| Some((r, r.done()?)))
        .flat_map(|(r, m)| m.parts.iter().map(move |p| (r, p)));
    let list: Vec<(&CaseRecord, &str, &FrameScore)> = parts
        .flat_map(|(r, (name, part))| part.frames.iter().map(move |f| (r, name.as_str(), f)))
        .collect();
    let mut table = Table::new(&list);
    table.column("case", |r| r.0.about.case.clone());
    table.column("variant", |r| r.0.about.variant.clone());
    table.column("method", |r| r.0.about.method.clone());
    table.column("frame", |r| r.2.frame.to_string());
    table.column("part", |r| r.1.to_string());
    table.column("E_t", |r| number(r.2.change.map(|c| c.rms)));
    table.column("E_t noise", |r| number(r.2.noise));
    table.column("99.9th percentile", |r| number(r.2.change.map(|c| c.p999)));
    table.column("peak jump /255", |r| number(r.2.change.map(|c| c.jump)));
    table.column("mean luminance", |r| number(r.2.mean));
    table.column("reference mean luminance", |r| number(r.2.reference_mean));
    table.column("relMSE", |r| number(r.2.relmse));
    table.csv()
}
