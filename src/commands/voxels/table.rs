//! The figures as text.

use super::Report;
use crate::measure::oracle::{SHAPES, Score};
use crate::results::table::Table;

pub(super) fn print(report: &Report) {
    let [x, y, z] = report.size;
    say!(
        "{}: {} triangles in {x} x {y} x {z} cells, on {}",
        report.scene,
        report.triangles,
        report.device
    );
    if let Some(score) = report.modes.iter().find_map(|m| m.score.as_ref()) {
        say!(
            "exact: {} cells, {} in the thin set, {} borderline; {} cells enclosed{}",
            score.exact,
            score.thin,
            score.borderline,
            score.enclosed,
            if score.enclosed == 0 {
                " (nothing closed: leaks say nothing)"
            } else {
                ""
            }
        );
    }
    say_part!("\n{}", scores(report));
    for mode in &report.modes {
        if mode.score.is_none() {
            let why = mode.skipped.as_deref().unwrap_or("no reason");
            say!("{}: skipped: {why}", mode.title);
        }
        for warning in &mode.warnings {
            say!("{}: warning: {warning}", mode.title);
        }
    }
    say_part!("\n{}", shapes(report));
}

fn ratio(value: Option<f64>) -> String {
    value.map_or("-".into(), |r| format!("{r:.5}"))
}

fn scores(report: &Report) -> String {
    type Cell = fn(&Score) -> String;
    fn leak(score: &Score, leaked: u64) -> String {
        match score.enclosed {
            0 => "-".into(),
            _ => leaked.to_string(),
        }
    }
    let columns: [(&str, Cell); 12] = [
        ("voxels", |s| s.voxels.to_string()),
        ("recall", |s| ratio(s.recall)),
        ("precision", |s| ratio(s.precision)),
        ("holes", |s| s.holes.to_string()),
        ("extras", |s| s.extras.to_string()),
        ("thin rec", |s| ratio(s.thin_recall)),
        ("leak 6", |s| leak(s, s.leaked_6)),
        ("leak 26", |s| leak(s, s.leaked_26)),
        ("colour", |s| format!("{:.4}", s.color_rms)),
        ("max", |s| format!("{:.3}", s.color_max)),
        ("normal deg", |s| format!("{:.2}", s.normal_mean)),
        ("opacity", |s| format!("{:+.3}", s.opacity_bias)),
    ];
    let mut table = Table::new(&report.modes);
    table.column("mode", |m| m.title.clone());
    for (title, cell) in columns {
        table.column(title, |m| m.score.as_ref().map_or("-".into(), cell));
    }
    table.text()
}

/// Recall and precision by class of shape; the first row has the number of exact cells.
fn shapes(report: &Report) -> String {
    let modes = report.modes.iter();
    let scores: Vec<(&str, &Score)> = modes
        .filter_map(|m| Some((m.title.as_str(), m.score.as_ref()?)))
        .collect();
    let exact = scores.first().map(|(_, score)| (None, *score));
    let rows: Vec<(Option<&str>, &Score)> = exact
        .into_iter()
        .chain(scores.iter().map(|(title, score)| (Some(*title), *score)))
        .collect();
    let mut table = Table::new(&rows);
    table.column("recall / precision", |r| {
        r.0.unwrap_or("exact cells").into()
    });
    for class in SHAPES {
        table.column(class, |(title, score)| match score.shapes.get(class) {
            None => String::new(),
            Some(s) if title.is_none() => s.exact.to_string(),
            Some(s) => format!("{:.5} / {}", s.recall, ratio(s.precision)),
        });
    }
    table.without_empty().text()
}
