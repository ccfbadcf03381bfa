//! A suite's results as comma-separated values (RFC 4180). Columns that end in ` ms` are times and differ from run to run;
//! everything else is the same on one device.

use super::record::{CaseRecord, FrameScore, Measured, PartResult, Report};
use crate::campaign::points::total_first;
use crate::campaign::table::{Table, cell, mebibytes, number};
use crate::lab::LabError;

/// A number of a part.
pub(super) type Value = fn(&PartResult) -> Option<f64>;

/// Columns of every part: title in the table, title on the page if they are there, value.
pub(super) const COLUMNS: [(&str, Option<&str>, Value); 19] = [
    ("E_t", Some("E_t"), |p| p.e),
    ("E_t noise", Some("noise"), |p| p.e_noise),
    ("pops", Some("pops"), |p| p.pops),
    ("peak jump /255", Some("jump"), |p| p.jump),
    ("flicker mean", Some("flicker"), |p| p.flicker.map(|f| f.mean)),
    ("flicker p99", Some("its p99"), |p| p.flicker.map(|f| f.p99)),
    ("flicker noise", Some("its noise"), |p| p.flicker_noise),
    ("convergence frames", Some("frames to 5 %"), |p| p.step.and_then(|s| s.frames).map(|f| f as f64)),
    ("overshoot", Some("overshoot"), |p| p.step.map(|s| s.overshoot)),
    ("settling frames", Some("settling frames"), |p| p.settling.map(|f| f as f64)),
    ("relMSE", Some("relMSE"), |p| p.scores.as_ref().map(|s| s.relmse)),
    ("relMSE noise", None, |p| p.noise),
    ("structure", Some("structure"), |p| p.scores.as_ref().map(|s| s.structure)),
    ("structure noise", None, |p| p.structure_noise),
    ("energy ratio", Some("energy"), |p| p.scores.as_ref().map(|s| s.energy_ratio)),
    ("leak", Some("leak"), |p| p.scores.as_ref().map(|s| s.leak)),
    ("dark", None, |p| p.scores.as_ref().map(|s| s.dark)),
    ("over-occlusion", None, |p| p.scores.as_ref().map(|s| s.over_occlusion)),
    ("over-occluded", Some("over-occluded"), |p| p.scores.as_ref().map(|s| s.over_occluded)),
];

/// All parts that results have.
pub(super) fn parts(report: &Report) -> Vec<String> {
    total_first(report.results.iter().filter_map(|r| r.done()).flat_map(|m| m.parts.keys()))
}

/// A row for every method in every case.
pub(super) fn rows(report: &Report) -> Result<String, LabError> {
    let mut table = Table::new(&report.results);
    let of = |value: fn(&Measured) -> String| move |r: &CaseRecord| cell(r.done().map(value));
    table.column("case", |r| r.about.case.clone());
    table.column("variant", |r| r.about.variant.clone());
    table.column("method", |r| r.about.method.clone());
    table.column("outcome", |r| if r.done().is_some() { "done" } else { "failed" }.into());
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
    table.column("worst frame", of(|m| cell(m.worst.as_ref().map(|w| w.frame))));
    table.column("voxel recall", of(|m| number(m.voxels.as_ref().and_then(|v| v.recall))));
    table.column("voxel precision", of(|m| number(m.voxels.as_ref().and_then(|v| v.precision))));
    for part in &parts(report) {
        for (title, _, value) in COLUMNS {
            table.column(format!("{part} {title}"), |r| number(r.part(part).and_then(value)));
            if title == "E_t noise" {
                let told = |r: &CaseRecord| Some(if r.part(part)?.told_apart? { "yes" } else { "no" });
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
    let list: Vec<(&CaseRecord, &str, &FrameScore)> =
        parts.flat_map(|(r, (name, part))| part.frames.iter().map(move |f| (r, name.as_str(), f))).collect();
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
