//! Report of sweeps: one page that needs no network, charts as SVG, and a table.

mod data;
mod equal;
mod page;
mod pareto;
mod scatter;
mod scenes;

pub(crate) use data::{Data, Dot, Scored};
pub use pareto::pareto;

use super::charts::{Bar, bars, color, hex};
use super::record::{File, write_files};
use super::sweep::{Collected, csv};
use crate::lab::LabError;
use crate::metrics::{METRICS, Metric};
use data::Chart;
use std::path::{Path, PathBuf};

/// Largest number of bars in the chart of passes.
const MAX_BARS: usize = 40;

/// Writes `index.html`, `points.csv` and the charts to a folder: error against time for every part
/// of the light and every metric, and the passes of the points on the Pareto front of the total.
/// Where there are several scenes, also a table of them, with `scenes.csv`; where there are several
/// experiments, what each reaches in equal time, with `fronts.csv`.
pub(crate) fn write(
    collected: &Collected,
    metrics: &[&'static Metric],
    folder: &Path,
) -> Result<Vec<PathBuf>, LabError> {
    let data = Data::new(collected);
    if data.dots.is_empty() {
        let n = collected.points.len();
        return Err(LabError::Request(format!(
            "none of the {n} points is measured yet: run `conelab sweep` first"
        )));
    }
    let charts = charts(&data, metrics)?;
    let table = csv(collected)?;
    let passes: Vec<(String, String)> = (0..data.subjects.len())
        .map(|s| Ok((data.name("passes", s), passes(&data, s)?)))
        .collect::<Result<_, LabError>>()?;
    let scenes = scenes::Scenes::of(&data);
    let equal = equal::Equal::of(&data);
    let mut files: Vec<File> = vec![("points.csv".into(), table.clone().into_bytes())];
    let charted = charts
        .iter()
        .map(|c| (&c.name, &c.svg))
        .chain(passes.iter().map(|(name, svg)| (name, svg)));
    files.extend(charted.map(|(name, svg)| (format!("{name}.svg"), svg.clone().into_bytes())));
    if let Some(scenes) = &scenes {
        files.push(("scenes.csv".into(), scenes.csv(&data)?.into_bytes()));
    }
    if let Some(equal) = &equal {
        files.push(("fronts.csv".into(), equal.csv()?.into_bytes()));
    }
    let tables = (scenes.as_ref(), equal.as_ref());
    let page = page::page(&data, &charts, &passes, &table, tables)?;
    files.push(("index.html".into(), page.into_bytes()));
    write_files(folder, &files)?;
    Ok(files.into_iter().map(|f| folder.join(f.0)).collect())
}

/// One chart for each subject, part and metric that points have.
fn charts(data: &Data, metrics: &[&'static Metric]) -> Result<Vec<Chart>, LabError> {
    let mut out = Vec::new();
    for (subject, title) in data.subjects.iter().enumerate() {
        for part in &data.parts {
            for &metric in metrics {
                let dots = data.scored(subject, part, metric);
                if dots.is_empty() {
                    continue;
                }
                let name = data.name(&format!("{part}-{}", metric.key), subject);
                let svg = scatter::scatter(&format!("{title}: {part}"), &metric.axis(), &dots)?;
                let points = dots.iter().map(|d| d.index).collect();
                let names = scatter::groups(&dots);
                let group = |d: &Scored| names.iter().position(|n| *n == d.experiment);
                let groups = dots.iter().map(|d| group(d).unwrap_or(0)).collect();
                out.push(Chart {
                    name,
                    subject,
                    part: part.clone(),
                    metric,
                    points,
                    groups,
                    bars: scatter::bars(&dots).map(|(i, _)| i).collect(),
                    colors: (0..names.len()).map(|i| hex(color(i))).collect(),
                    svg,
                });
            }
        }
    }
    Ok(out)
}

/// Stacked bars of the points on the Pareto front of the total's relMSE, or of all points without
/// scores.
fn passes(data: &Data, subject: usize) -> Result<String, LabError> {
    let scored = data.scored(subject, "total", &METRICS[0]);
    let pairs: Vec<(f64, f64)> = scored.iter().map(|d| (d.ms, d.error)).collect();
    let mut chosen: Vec<usize> = pareto(&pairs)
        .into_iter()
        .map(|i| scored[i].index)
        .collect();
    let what = if chosen.is_empty() {
        "fastest points"
    } else {
        "points on the Pareto front of the total"
    };
    if chosen.is_empty() {
        chosen = (0..data.dots.len())
            .filter(|i| data.dots[*i].subject == subject)
            .collect();
    }
    chosen.sort_by(|a, b| data.dots[*a].ms.total_cmp(&data.dots[*b].ms));
    chosen.truncate(MAX_BARS);
    // Values that all dots share are left out.
    let value = |i: usize, name: &String| data.dots[i].labels.get(name);
    let differs = |name: &&String| {
        chosen
            .iter()
            .any(|i| value(*i, name) != value(chosen[0], name))
    };
    let names: Vec<&String> = data.names.iter().filter(differs).collect();
    let dots = chosen.iter().map(|i| &data.dots[*i]);
    let rows = dots.map(|d| Bar {
        label: d.title(&names),
        parts: d.stages.clone(),
        hollow: false,
    });
    let title = format!(
        "{}: {what}, ms of each stage (medians)",
        data.subjects[subject]
    );
    bars(
        &title,
        " ms",
        |ms| format!("{ms:.3}"),
        &rows.collect::<Vec<_>>(),
    )
}
