//! `conelab report`.

use crate::campaign::report::write;
use crate::campaign::sweep::collect;
use crate::lab::LabError;
use crate::metrics::{METRICS, Metric, RELMSE};
use clap::Args;
use std::path::PathBuf;

/// Arguments of `report`.
#[derive(Debug, Args)]
pub struct ReportArgs {
    /// Folders of sweeps: shards of one sweep, or several sweeps to compare.
    #[arg(required = true)]
    folders: Vec<PathBuf>,
    /// Output folder of page, charts and table; `report` in the first folder when absent.
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    /// Error metrics to chart.
    #[arg(long, value_delimiter = ',', default_values = [RELMSE, "hdr_flip"], value_parser = super::metric_of(METRICS.iter()))]
    metric: Vec<&'static Metric>,
}

/// Writes a report.
pub fn run(args: &ReportArgs) -> Result<(), LabError> {
    let collected = collect(&args.folders)?;
    let folder = match (&args.output, args.folders.first()) {
        (Some(folder), _) => folder.clone(),
        (None, Some(first)) => first.join("report"),
        (None, None) => return Err(LabError::Request("name a sweep's folder".into())),
    };
    let files = write(&collected, &args.metric, &folder)?;
    for file in &files {
        say!("wrote {}", super::shown(file).display());
    }
    let measured = collected.points.iter().filter(|p| p.1.is_some()).count();
    say!(
        "{measured} of {} points are finished",
        collected.points.len()
    );
    Ok(())
}
