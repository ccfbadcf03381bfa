//! The figures as text.

use super::Report;
use crate::measure::oracle::SHAPES;

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
    say!(
        "\n{:<20}{:>9}{:>9}{:>10}{:>9}{:>8}{:>9}{:>9}{:>9}{:>9}{:>8}{:>10}{:>9}",
        "mode",
        "voxels",
        "recall",
        "precision",
        "holes",
        "extras",
        "thin rec",
        "leak 6",
        "leak 26",
        "colour",
        "max",
        "normal deg",
        "opacity"
    );
    let part = |r: Option<f64>| r.map_or("-".into(), |r| format!("{r:.5}"));
    for mode in &report.modes {
        match (&mode.score, &mode.skipped) {
            (Some(s), _) => {
                let leak = |n: u64| {
                    if s.enclosed == 0 {
                        "-".to_string()
                    } else {
                        n.to_string()
                    }
                };
                say!(
                    "{:<20}{:>9}{:>9}{:>10}{:>9}{:>8}{:>9}{:>9}{:>9}{:>9.4}{:>8.3}{:>10.2}{:>+9.3}",
                    mode.title,
                    s.voxels,
                    part(s.recall),
                    part(s.precision),
                    s.holes,
                    s.extras,
                    part(s.thin_recall),
                    leak(s.leaked_6),
                    leak(s.leaked_26),
                    s.color_rms,
                    s.color_max,
                    s.normal_mean,
                    s.opacity_bias
                );
            }
            (None, why) => say!(
                "{:<20}skipped: {}",
                mode.title,
                why.as_deref().unwrap_or("no reason")
            ),
        }
        for warning in &mode.warnings {
            say!("  warning: {warning}");
        }
    }
    shapes(report);
}

/// Recall / precision by class.
fn shapes(report: &Report) {
    let there = |name: &&&str| {
        report
            .modes
            .iter()
            .filter_map(|m| m.score.as_ref())
            .any(|s| s.shapes.contains_key(**name))
    };
    let classes: Vec<&&str> = SHAPES.iter().filter(there).collect();
    let mut line = format!("\n{:<20}", "recall / precision");
    for class in &classes {
        line += &format!("{class:>20}");
    }
    say!("{line}");
    let mut cells = format!("{:<20}", "exact cells");
    if let Some(score) = report.modes.iter().find_map(|m| m.score.as_ref()) {
        for class in &classes {
            cells += &format!("{:>20}", score.shapes.get(**class).map_or(0, |s| s.exact));
        }
        say!("{cells}");
    }
    for mode in &report.modes {
        let Some(score) = &mode.score else { continue };
        let mut line = format!("{:<20}", mode.title);
        for class in &classes {
            line += &match score.shapes.get(**class) {
                Some(s) => {
                    let precision = s.precision.map_or("-".into(), |p| format!("{p:.5}"));
                    format!("{:>20}", format!("{:.5} / {precision}", s.recall))
                }
                None => format!("{:>20}", "-"),
            };
        }
        say!("{line}");
    }
}
