//! The page: tables, charts and the worst frames. It needs no network; pictures lie beside it.

use super::chart::Chart;
use super::plot::Plot;
use super::record::{Measured, Outcome, PartResult, Record, Report};
use super::table::parts;
use crate::campaign::report::{escaped, short};
use std::fmt::Write;

const STYLE: &str = "body{font:15px/1.45 sans-serif;margin:2em auto;max-width:1150px;padding:0 1em;color:#222}\
table{border-collapse:collapse;margin:.6em 0}th,td{padding:.2em .6em;text-align:right;border-bottom:1px solid #ddd}\
th:first-child,td:first-child{text-align:left}.noise{color:#888;font-style:italic}.bad{color:#a33}\
figure{margin:1em 0}figcaption{color:#555;font-size:13px}img{max-width:100%;image-rendering:pixelated}svg{max-width:100%;height:auto}\
.wide{overflow-x:auto}h2{margin-top:2em;border-top:2px solid #ccc;padding-top:.6em}";

/// The page as HTML.
pub(super) fn page(report: &Report, charts: &[Chart], plot: Option<&Plot>) -> String {
    let title = escaped(&report.suite);
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{title}: stability</title>\n\
         <meta name=\"viewport\" content=\"width=device-width\"><style>{STYLE}</style></head>\n<body>\n\
         <h1>{title}: stability</h1>\n"
    );
    let reference = match report.reference {
        Some((samples, bounces)) => format!("path traced, {samples} samples a pixel, {bounces} bounces, one seed"),
        None => "none: changes are measured only where the reference does not change".into(),
    };
    let devices: std::collections::BTreeSet<&str> = report.results.iter().map(|r| r.device.name.as_str()).collect();
    let devices = devices.into_iter().collect::<Vec<_>>().join(", ");
    let _ = writeln!(
        out,
        "<p>Reference: {reference}. Device: {}. E_t is the root mean square of a frame's change less the reference's; \
         <i class=\"noise\">grey and slanted</i>, hollow in charts: less than 4 times the same between the two halves of \
         the reference, not told apart from its noise. Jumps are of the displayed picture, in 1/255. All figures: \
         <a href=\"stability.csv\">stability.csv</a>, <a href=\"frames.csv\">frames.csv</a>, \
         <a href=\"stability.json\">stability.json</a>.</p>",
        escaped(&devices)
    );
    out += &plot.map_or(String::new(), Plot::html);
    let figure = |out: &mut String, chart: &Chart| {
        let _ = writeln!(out, "<figure>{}</figure>", chart.svg);
    };
    charts.iter().filter(|c| c.case.is_none()).for_each(|c| figure(&mut out, c));
    let parts = parts(report);
    let mut cases: Vec<String> = report.results.iter().map(Record::title).collect();
    cases.dedup();
    for case in &cases {
        let of: Vec<&Record> = report.results.iter().filter(|r| r.title() == *case).collect();
        let Some(first) = of.first() else { continue };
        let _ = writeln!(
            out,
            "<h2>{}</h2>\n<p>{} Scene {}, {}; {}x{}, {} frames after {} of warm-up.</p>",
            escaped(case),
            escaped(&first.about),
            escaped(&first.scene),
            escaped(&first.motion),
            first.size[0],
            first.size[1],
            first.frames,
            first.warmup
        );
        for part in parts.iter().filter(|p| ["total", "diffuse", "specular"].contains(&p.as_str())) {
            table(&mut out, part, &of);
        }
        charts.iter().filter(|c| c.case.as_ref() == Some(case)).for_each(|c| figure(&mut out, c));
        for r in &of {
            if let Some((m, w)) = r.measured().and_then(|m| Some((m, m.worst.as_ref()?))) {
                let warnings =
                    if m.warnings.is_empty() { String::new() } else { format!(" {}.", m.warnings.join("; ")) };
                let _ = writeln!(
                    out,
                    "<figure><img src=\"pictures/{0}.png\" alt=\"\"><figcaption><b>{1}</b>, worst frame {2} of {6} \
                     (pictures/{0}.png): {3}; red brighter, blue darker, full at {4} / 255.{5}</figcaption></figure>",
                    r.id,
                    escaped(&r.method),
                    w.frame,
                    escaped(&w.panels.join(" | ")),
                    short(w.full),
                    escaped(&warnings),
                    escaped(&w.part)
                );
            }
        }
    }
    out += "</body></html>\n";
    out
}

type Column = (&'static str, fn(&Measured, &PartResult) -> Option<f64>);

const COLUMNS: [Column; 16] = [
    ("E_t", |_, p| p.e),
    ("noise", |_, p| p.e_noise),
    ("pops", |_, p| p.pops),
    ("jump", |_, p| p.jump),
    ("flicker", |_, p| p.flicker.filter(|_| p.frames.len() > 1).map(|f| f.mean)),
    ("its p99", |_, p| p.flicker.filter(|_| p.frames.len() > 1).map(|f| f.p99)),
    ("its noise", |_, p| p.flicker_noise),
    ("frames to 5 %", |_, p| p.step.and_then(|s| s.frames).map(|f| f as f64)),
    ("overshoot", |_, p| p.step.map(|s| s.overshoot)),
    ("settling frames", |_, p| p.settling.map(|f| f as f64)),
    ("relMSE", |_, p| p.scores.as_ref().map(|s| s.relmse)),
    ("structure", |_, p| p.scores.as_ref().map(|s| s.structure)),
    ("energy", |_, p| p.scores.as_ref().map(|s| s.energy_ratio)),
    ("leak", |_, p| p.scores.as_ref().map(|s| s.leak)),
    ("over-occluded", |_, p| p.scores.as_ref().map(|s| s.over_occluded)),
    ("voxel recall", |m, _| m.voxels.as_ref().and_then(|v| v.recall)),
];

/// A row for each method; columns that nobody has are left out.
fn table(out: &mut String, part: &str, records: &[&Record]) {
    let found = |r: &Record, c: &Column| {
        let m = r.measured()?;
        (c.1)(m, m.parts.get(part)?).filter(|v| v.is_finite())
    };
    let columns: Vec<&Column> = COLUMNS.iter().filter(|c| records.iter().any(|r| found(r, c).is_some())).collect();
    let _ = write!(out, "<div class=\"wide\"><table><tr><th>{}</th>", escaped(part));
    columns.iter().for_each(|c| {
        let _ = write!(out, "<th>{}</th>", c.0);
    });
    *out += "</tr>\n";
    for r in records {
        let _ = write!(out, "<tr><td>{}</td>", escaped(&r.method));
        if let Outcome::Failed(why) = &r.outcome {
            let why = why.lines().next().unwrap_or_default();
            let _ = write!(out, "<td class=\"bad\" colspan=\"{}\">{}</td>", columns.len(), escaped(why));
        }
        for c in columns.iter().filter(|_| r.measured().is_some()) {
            let mark = c.0 == "E_t"
                && r.measured().and_then(|m| m.parts.get(part)).is_some_and(|p| p.told_apart == Some(false));
            let class = if mark { " class=\"noise\"" } else { "" };
            let _ = write!(out, "<td{class}>{}</td>", found(r, c).map_or(String::new(), short));
        }
        *out += "</tr>\n";
    }
    *out += "</table></div>\n";
}
