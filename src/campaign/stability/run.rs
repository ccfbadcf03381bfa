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
use crate::campaign::runner::{Counts, OnProgress, Open, Runner};
use crate::lab::{LabError, focus_of, parts_of};
use crate::metrics::Kind;

/// Runs the open cases of a suite, then writes its tables, charts and page. Errors of a method in a
/// case are recorded; the next run tries these again.
pub fn run(
    open: &Open,
    open_scene: &OpenScene,
    suite: &Suite,
    options: &Options,
    on_progress: &mut OnProgress<'_>,
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
    let tracing = options.reference.then_some(Tracing {
        samples: options.samples.unwrap_or(suite.samples),
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
    let jobs: Vec<&Job> = jobs.iter().collect();
    let results = runner.run(&folder, &jobs, &mut kept, &mut measured)?;
    let counts = Counts::of(&results);
    let Runner { lab, warm, .. } = &mut runner;
    let graph = &warm.graph(&lab.home, &suite.experiment.graph)?.graph;
    let focus = focus_of(graph).map(|p| (p.name.clone(), p.title.clone()));
    let tables = parts_of(graph).into_iter();
    let tables = tables.filter(|p| p.kind == Kind::Radiance).map(|p| p.name);
    let report = Report {
        schema: SCHEMA.into(),
        version: env!("CARGO_PKG_VERSION").into(),
        suite: suite.name.clone(),
        text: suite.text.clone(),
        reference: tracing.map(|t| (t.samples, t.bounces)),
        tables: tables.collect(),
        focus,
        costs,
        results,
    };
    write(&report, suite.chart.clone(), options)?;
    Ok((counts, report))
}

/// Tables, JSON, charts and the page.
fn write(report: &Report, spec: Option<CostChart>, options: &Options) -> Result<(), LabError> {
    let spec = spec.map(|mut chart| {
        chart.part = chart.part.or_else(|| report.focus.clone().map(|f| f.0));
        chart
    });
    let charts = chart::charts(report)?;
    let plot = spec.as_ref().map(|spec| Plot::new(report, spec));
    let plot = plot.transpose()?;
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
