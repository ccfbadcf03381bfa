//! A suite's results as comma-separated values (RFC 4180). Columns that end in ` ms` are times and differ from run to run;
//! everything else is the same on one device.

use super::record::{Measured, Outcome, PartResult, Report};
use crate::campaign::sweep::csv_text;
use crate::lab::LabError;

type Column = (&'static str, fn(&PartResult) -> String);

/// Columns of every part.
const COLUMNS: [Column; 20] = [
    ("E_t", |p| text(p.e)),
    ("E_t noise", |p| text(p.e_noise)),
    ("told apart", |p| p.told_apart.map_or("", |t| if t { "yes" } else { "no" }).into()),
    ("pops", |p| text(p.pops)),
    ("peak jump /255", |p| text(p.jump)),
    ("flicker mean", |p| text(p.flicker.map(|f| f.mean))),
    ("flicker p99", |p| text(p.flicker.map(|f| f.p99))),
    ("flicker noise", |p| text(p.flicker_noise)),
    ("convergence frames", |p| p.step.and_then(|s| s.frames).map_or(String::new(), |f| f.to_string())),
    ("overshoot", |p| text(p.step.map(|s| s.overshoot))),
    ("settling frames", |p| p.settling.map_or(String::new(), |f| f.to_string())),
    ("relMSE", |p| text(p.scores.as_ref().map(|s| s.relmse))),
    ("relMSE noise", |p| text(p.noise)),
    ("structure", |p| text(p.scores.as_ref().map(|s| s.structure))),
    ("structure noise", |p| text(p.structure_noise)),
    ("energy ratio", |p| text(p.scores.as_ref().map(|s| s.energy_ratio))),
    ("leak", |p| text(p.scores.as_ref().map(|s| s.leak))),
    ("dark", |p| text(p.scores.as_ref().map(|s| s.dark))),
    ("over-occlusion", |p| text(p.scores.as_ref().map(|s| s.over_occlusion))),
    ("over-occluded", |p| text(p.scores.as_ref().map(|s| s.over_occluded))),
];

pub(super) fn text(v: Option<f64>) -> String {
    v.filter(|v| v.is_finite()).map_or(String::new(), |v| v.to_string())
}

/// Bytes in MiB, to a hundredth.
pub(super) fn mebibytes(bytes: u64) -> String {
    format!("{:.2}", bytes as f64 / f64::from(1 << 20))
}

/// All parts that results have: the total, then the others.
pub(super) fn parts(report: &Report) -> Vec<String> {
    let measured = report.results.iter().filter_map(|r| r.measured());
    let mut parts: Vec<String> = measured.flat_map(|m| m.parts.keys().cloned()).collect();
    parts.sort_by_key(|p| (p != "total", p.clone()));
    parts.dedup();
    parts
}

/// A row for every method in every case.
pub(super) fn rows(report: &Report) -> Result<String, LabError> {
    let parts = parts(report);
    let mut header: Vec<String> = [
        "case",
        "variant",
        "method",
        "outcome",
        "error",
        "scene",
        "motion",
        "width",
        "height",
        "warmup",
        "frames",
        "device",
        "driver",
        "reference samples",
        "warnings",
        "frame ms",
        "memory MiB",
        "worst frame",
        "voxel recall",
        "voxel precision",
    ]
    .map(String::from)
    .to_vec();
    header.extend(parts.iter().flat_map(|p| COLUMNS.iter().map(move |c| format!("{p} {}", c.0))));
    let mut lines = vec![header];
    for r in &report.results {
        let m = r.measured();
        let of = |f: &dyn Fn(&Measured) -> String| m.map(f).unwrap_or_default();
        let error = match &r.outcome {
            Outcome::Failed(e) => e.lines().next().unwrap_or_default().to_string(),
            Outcome::Done(_) => String::new(),
        };
        let mut row = vec![
            r.case.clone(),
            r.variant.clone(),
            r.method.clone(),
            if m.is_some() { "done".into() } else { "failed".into() },
            error,
            r.scene.clone(),
            r.motion.clone(),
            r.size[0].to_string(),
            r.size[1].to_string(),
            r.warmup.to_string(),
            r.frames.to_string(),
            r.device.name.clone(),
            r.device.driver.clone(),
            of(&|m| m.samples.to_string()),
            of(&|m| m.warnings.join("; ")),
            of(&|m| m.frame_ms.to_string()),
            of(&|m| mebibytes(m.memory_bytes)),
            of(&|m| m.worst.as_ref().map_or(String::new(), |w| w.frame.to_string())),
            of(&|m| text(m.voxels.as_ref().and_then(|v| v.recall))),
            of(&|m| text(m.voxels.as_ref().and_then(|v| v.precision))),
        ];
        for part in &parts {
            let part = m.and_then(|m| m.parts.get(part));
            row.extend(COLUMNS.iter().map(|c| part.map_or(String::new(), c.1)));
        }
        lines.push(row);
    }
    csv_text(&lines)
}

/// A row for every frame of every part.
pub(super) fn frames(report: &Report) -> Result<String, LabError> {
    let header = [
        "case",
        "variant",
        "method",
        "frame",
        "part",
        "E_t",
        "E_t noise",
        "99.9th percentile",
        "peak jump /255",
        "mean luminance",
        "reference mean luminance",
        "relMSE",
    ];
    let mut lines = vec![header.map(String::from).to_vec()];
    for (r, m) in report.results.iter().filter_map(|r| Some((r, r.measured()?))) {
        for (name, part) in &m.parts {
            for f in &part.frames {
                let change = |v: fn(&super::Change) -> f64| text(f.change.as_ref().map(v));
                lines.push(vec![
                    r.case.clone(),
                    r.variant.clone(),
                    r.method.clone(),
                    f.frame.to_string(),
                    name.clone(),
                    change(|c| c.rms),
                    text(f.noise),
                    change(|c| c.p999),
                    change(|c| c.jump),
                    text(f.mean),
                    text(f.reference_mean),
                    text(f.relmse),
                ]);
            }
        }
    }
    csv_text(&lines)
}
