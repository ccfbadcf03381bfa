//! `conelab stability`.

use super::DeviceArgs;
use super::adapt::parse_size;
use super::campaign_bar::bar;
use crate::campaign::record::write_file;
use crate::campaign::stability::{
    Options, Report, Suite, failure_table, failures, run as run_suite, sheet,
};
use crate::lab::{Lab, LabError, Workspace};
use crate::metrics::RELMSE;
use crate::results::table::short;
use clap::Args;
use std::path::PathBuf;

/// Arguments of `stability`.
#[derive(Debug, Args)]
pub struct StabilityArgs {
    /// Suite file, for example configs/stability/motion.ron.
    suite: PathBuf,
    /// Folder of the results; captures/stability/NAME when absent. Finished cases in it are not
    /// measured again.
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    /// Set a parameter of every method with a graph that has it; can be repeated.
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Picture size, instead of the suite's.
    #[arg(long, value_name = "WxH")]
    size: Option<String>,
    /// Frames of cases without their own number, instead of the suite's.
    #[arg(long)]
    frames: Option<usize>,
    /// Samples per pixel of each frame's reference, instead of the suite's; rounded up to a multiple of 32.
    #[arg(long, value_name = "SAMPLES")]
    spp: Option<u64>,
    /// Trace no references: only static cases are scored.
    #[arg(long)]
    no_reference: bool,
    /// Only these cases.
    #[arg(long, value_name = "CASE", value_delimiter = ',')]
    only: Vec<String>,
    /// Only these methods, and the suite's first one.
    #[arg(long, value_name = "METHOD", value_delimiter = ',')]
    methods: Vec<String>,
    /// Write a page with the worst cases of each method, and print them as a Markdown table.
    #[arg(long, value_name = "FILE.html")]
    sheet: Option<PathBuf>,
    #[command(flatten)]
    device: DeviceArgs,
}

/// Prints a line for each result.
fn print(report: &Report) {
    for r in &report.results {
        let Some(total) = r.part("total") else {
            continue;
        };
        let number = |v: Option<f64>| v.map_or("-".into(), short);
        let noise = match total.told_apart {
            Some(false) => " (within noise)",
            _ => "",
        };
        say!(
            "{:32} {:24} E_t {}{noise}, jump {}/255, flicker {}, relMSE {}",
            r.about.title(),
            r.about.method,
            number(total.e),
            number(total.jump),
            number(total.flicker.map(|f| f.mean)),
            number(total.scores.as_ref().map(|s| s.get(RELMSE)))
        );
    }
}

/// Runs a suite; an error if a method failed in a case.
pub fn run(args: &StabilityArgs) -> Result<(), LabError> {
    let mut suite = Suite::read(&super::found(&args.suite)).map_err(LabError::Input)?;
    if !args.methods.is_empty() {
        suite.keep(&args.methods).map_err(LabError::Request)?;
    }
    let size = args.size.as_deref().map(parse_size).transpose()?;
    if let Some(frames) = args.frames {
        super::adapt::check_frames(frames, 0, 0.0)?;
    }
    if args.spp.is_some_and(|n| n == 0 || n > 1 << 20) {
        return Err(LabError::Request("--spp must be 1 to 1048576".into()));
    }
    if let Some(sheet) = &args.sheet {
        super::writable(sheet, &["html"])?;
    }
    let home = Workspace::find()?;
    let folder = args
        .output
        .clone()
        .unwrap_or_else(|| home.captures.join("stability").join(&suite.name));
    let options = Options {
        folder,
        size,
        set: args.set.clone(),
        frames: args.frames,
        samples: args.spp,
        reference: !args.no_reference,
        only: args.only.clone(),
    };
    let reopen = || Lab::open(home.clone(), args.device.options());
    let (counts, report) = run_suite(&reopen, &super::open_scene, &suite, &options, &mut bar(""))?;
    print(&report);
    say!(
        "wrote {}",
        super::shown(&options.folder.join("index.html")).display()
    );
    if let Some(path) = &args.sheet {
        let list = failures(&report);
        let page = sheet(&suite.name, &list, &options.folder)?;
        write_file(path, page.as_bytes())?;
        say!("\n{}wrote {}", failure_table(&list), path.display());
    }
    say!("{} done, {} failed", counts.done, counts.failed);
    match counts.failed {
        0 => Ok(()),
        n => Err(LabError::Request(format!(
            "{n} failed: their errors are in stability.csv"
        ))),
    }
}
