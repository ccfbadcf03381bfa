//! Runs a suite: every method in every case. Each result is recorded at once.

use super::chart_spec::CostChart;
use super::file::Suite;
use super::plan::{Job, Options, plan};
use super::plot::Plot;
use super::record::{CaseRecord, Report, SCHEMA, folder, picture};
use super::sequence::{Tracing, measure};
use super::{chart, cost, page, table};
use crate::campaign::points::OpenScene;
use crate::campaign::record::{json, write_files};
use crate::campaign::runner::{Counts, Open, Progress, Runner};
use crate::lab::{LabError, focus_of, parts_of};
use crate::metrics::Kind;

/// Runs the open cases of a suite, then writes its tables, charts and page. Errors of a method in a
/// case are recorded; the next run tries these again.
pub fn run(
    open: &Open,
    open_scene: &OpenScene,
    suite: &Suite,
    options: &Options,
    on_progress: &mut dyn FnMut(Progress),
) -> Result<(Counts, Report), LabError> {
    let mut runner = Runner::open(open, open_scene, on_progress)?;
    let mut jobs = plan(&mut runner, suite, options)?;
    let mut costs = Vec::new();
    if let Some(chart) = &suite.chart {
        costs = cost::costs(&mut runner, suite, chart, options)?;
        let chosen = cost::chosen(suite, chart, &costs);
        jobs = plan(&mut runner, &chosen, options)?;
    }
    let folder = folder(&options.folder);
    let samples = options.samples.unwrap_or(suite.samples);
    let tracing = options.reference.then_some(Tracing {
        samples,
        bounces: suite.bounces,
        seed: suite.seed,
    });
    // Failed cases run again, and cases without their picture.
    let mut kept = |_: &mut Runner, job: &Job| {
        let whole = |r: &CaseRecord| {
            r.done()
                .is_some_and(|m| m.worst.is_none() || folder.path.join(picture(&r.id)).is_file())
        };
        Ok(folder.read(&job.id).filter(whole))
    };
    let mut measured =
        |runner: &mut Runner, job: &Job| measure(runner, job, tracing, &suite.pictures);
    let results = runner.run(
        &folder,
        &jobs.iter().collect::<Vec<_>>(),
        &mut kept,
        &mut measured,
    )?;
    let counts = Counts::of(&results);
    let graph = &runner
        .warm
        .graph(&runner.lab.home, &suite.experiment.graph)?
        .graph;
    let focus = focus_of(graph).map(|p| (p.name.clone(), p.title.clone()));
    let tables = parts_of(graph)
        .into_iter()
        .filter(|p| p.kind == Kind::Radiance)
        .map(|p| p.name)
        .collect();
    let report = Report {
        schema: SCHEMA.into(),
        version: env!("CARGO_PKG_VERSION").into(),
        suite: suite.name.clone(),
        text: suite.text.clone(),
        reference: options.reference.then_some((samples, suite.bounces)),
        tables,
        focus,
        costs,
        results,
    };
    let chart = suite.chart.clone().map(|mut chart| {
        chart.part = chart.part.or_else(|| report.focus.clone().map(|f| f.0));
        chart
    });
    write(&report, chart.as_ref(), options)?;
    Ok((counts, report))
}

/// Tables, JSON, charts and the page.
fn write(report: &Report, spec: Option<&CostChart>, options: &Options) -> Result<(), LabError> {
    let charts = chart::charts(report)?;
    let plot = spec.map(|spec| Plot::new(report, spec)).transpose()?;
    let mut files = vec![
        ("stability.json".to_string(), json(report)?),
        ("stability.csv".into(), table::rows(report)?.into_bytes()),
        ("frames.csv".into(), table::frames(report)?.into_bytes()),
    ];
    files.extend(
        charts
            .iter()
            .map(|c| (format!("charts/{}.svg", c.name), c.svg.clone().into_bytes())),
    );
    if let Some(plot) = &plot {
        files.push(("cost.csv".into(), plot.csv()?.into_bytes()));
        files.extend(
            plot.svg
                .iter()
                .map(|svg| ("charts/cost.svg".into(), svg.clone().into_bytes())),
        );
    }
    files.push((
        "index.html".into(),
        page::page(report, &charts, plot.as_ref()).into_bytes(),
    ));
    write_files(&options.folder, &files)
}
