//! The page: tables, charts and worst frames. It needs no network; its pictures are files of the
//! folder.

use super::chart::Chart;
use super::plot::Plot;
use super::record::{CaseRecord, Report, picture};
use super::table::{columns, parts};
use crate::campaign::page::{figure, page as whole_page};
use crate::results::table::{Table, cell, short, shortly};
use maud::{Markup, html};
use std::collections::BTreeSet;

pub(super) const STYLE: &str = "body{font:15px/1.45 sans-serif;margin:2em auto;max-width:1150px;padding:0 1em;color:#222}\
table{border-collapse:collapse;margin:.6em 0}th,td{padding:.2em .6em;text-align:right;border-bottom:1px solid #ddd}\
th:first-child,td:first-child{text-align:left}.noise{color:#888;font-style:italic}.bad{color:#a33}\
figure{margin:1em 0}figcaption{color:#555;font-size:13px}img{max-width:100%;image-rendering:pixelated}svg{max-width:100%;height:auto}\
.wide{overflow-x:auto}h2{margin-top:2em;border-top:2px solid #ccc;padding-top:.6em}";

/// The page as HTML.
pub(super) fn page(report: &Report, charts: &[Chart], plot: Option<&Plot>) -> String {
    let title = format!("{}: stability", report.suite);
    let reference = match report.reference {
        Some((samples, bounces)) => {
            format!("path traced, {samples} samples a pixel, {bounces} bounces, one seed")
        }
        None => "none: changes are measured only where the reference does not change".into(),
    };
    let devices: BTreeSet<&str> = report
        .results
        .iter()
        .map(|r| r.device.name.as_str())
        .collect();
    let devices = devices.into_iter().collect::<Vec<_>>().join(", ");
    let parts: Vec<String> = parts(report)
        .into_iter()
        .filter(|p| report.tables.contains(p))
        .collect();
    let body = html! {
        h1 { (title) }
        p {
            "Reference: " (reference) ". Device: " (devices) ". E_t is the root mean square of a frame's change less the \
             reference's; " i.noise { "grey and slanted" } ", hollow in charts: less than 4 times the same between the two \
             halves of the reference, not told apart from its noise. Jumps are of the displayed picture, in 1/255. All \
             figures: "
            a href="stability.csv" { "stability.csv" } ", " a href="frames.csv" { "frames.csv" } ", "
            a href="stability.json" { "stability.json" } "."
        }
        @if let Some(plot) = plot { (plot.html()) }
        @for chart in charts.iter().filter(|c| c.case.is_none()) { (figure(&chart.svg)) }
        @for (case, of) in report.cases() {
            h2 { (case) }
            @if let Some(first) = of.first().map(|r| &r.about) {
                p {
                    (first.text) " Scene " (first.scene) ", " (first.motion) "; " (first.size[0]) "x" (first.size[1]) ", "
                    (first.frames) " frames after " (first.warmup) " of warm-up."
                }
            }
            @for part in &parts { (table(part, &of)) }
            @for chart in charts.iter().filter(|c| c.case.as_ref() == Some(&case)) { (figure(&chart.svg)) }
            @for r in &of { (worst(r)) }
        }
    };
    whole_page(&title, STYLE, &body)
}

/// The worst frame of a method in a case.
fn worst(record: &CaseRecord) -> Markup {
    let picture = picture(&record.id);
    html! {
        @if let Some((m, w)) = record.done().and_then(|m| Some((m, m.worst.as_ref()?))) {
            figure {
                img src=(picture) alt="";
                figcaption {
                    b { (record.about.method) } ", worst frame " (w.frame) " of " (w.part) " (" (picture) "): "
                    (w.panels.join(" | ")) "; red brighter, blue darker, full at " (short(w.full)) " / 255."
                    @if !m.warnings.is_empty() { " " (m.warnings.join("; ")) "." }
                }
            }
        }
    }
}

/// A row for each method, without empty columns.
fn table(part: &str, records: &[&CaseRecord]) -> Markup {
    let mut table = Table::new(records);
    table.column(part, |r| r.about.method.clone());
    for (_, title, value) in columns() {
        let Some(title) = title else { continue };
        let noisy = |r: &CaseRecord| {
            title == "E_t" && r.part(part).is_some_and(|p| p.told_apart == Some(false))
        };
        table.marked(title, |r| {
            (
                shortly(r.part(part).and_then(&value)),
                noisy(r).then_some("noise"),
            )
        });
    }
    table.column("voxel recall", |r| {
        shortly(r.done().and_then(|m| m.voxels.as_ref()?.recall))
    });
    table.marked("failed", |r| (cell(r.error()), Some("bad")));
    table.without_empty().html()
}
