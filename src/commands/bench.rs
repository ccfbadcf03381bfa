//! `conelab bench`.

use super::DeviceArgs;
use super::adapt::{check_frames, parse_size};
use super::campaign_bar::bar;
use crate::campaign::bench::{
    Bench, Compared, Record, Recorded, against_text, bench, compare, of_sweep, percent,
    record_file, slower, text, write,
};
use crate::campaign::points::SweepPoint;
use crate::campaign::record::{json, write_file};
use crate::campaign::runner::Runner;
use crate::campaign::settings::axis;
use crate::campaign::sweep::Sweep;
use crate::experiment::Experiment;
use crate::lab::{Lab, LabError, Workspace};
use crate::measure::Frames;
use crate::results::stats::DeviceStats;
use crate::scene::SceneError;
use clap::Args;
use indexmap::IndexSet;
use std::path::{Path, PathBuf};

/// Arguments of `bench`.
#[derive(Debug, Args)]
pub struct BenchArgs {
    /// Experiment files. With --against: only these experiments of the record; all when absent.
    #[arg(required_unless_present = "against")]
    experiments: Vec<PathBuf>,
    /// Scene to use: a built-in name, a scene file (.ron) or a model.
    #[arg(long)]
    scene: Option<String>,
    /// Picture sizes: 720p, 900p, 1080p, 1440p, 2160p or WIDTHxHEIGHT; the experiments' own when
    /// absent.
    #[arg(long, value_delimiter = ',')]
    sizes: Vec<String>,
    /// Set a parameter in every configuration (repeatable).
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Vary a parameter (repeatable). The first one becomes the columns.
    #[arg(long, value_name = "NAME=V1,V2")]
    axis: Vec<String>,
    /// Number of rounds. Default: 5, or as recorded.
    #[arg(long)]
    rounds: Option<usize>,
    /// Frames per round. Default: 40, or as recorded.
    #[arg(long)]
    frames: Option<usize>,
    /// Warm-up frames per round (extended to 100 ms on GPUs). Default: 128, on software devices 10, or as recorded.
    #[arg(long)]
    warmup: Option<usize>,
    /// Record the times of this device: a .json file, or a folder with one file for each device.
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Measure the configurations of this record again, and compare; exit 1 if a stage became
    /// slower.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["scene", "sizes", "set", "axis", "record"])]
    against: Option<PathBuf>,
    /// Accepted slowdown of a stage, as a fraction of its recorded time.
    #[arg(long, default_value_t = 0.1, requires = "against")]
    tolerance: f64,
    /// Output folder of bench.json, bench.csv and the charts; captures/bench/NAME when absent.
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    #[command(flatten)]
    device: DeviceArgs,
}

/// Default rounds and frames.
const ROUNDS: usize = 5;
const FRAMES: Frames = Frames {
    warmup: 10,
    count: 40,
};

/// Measures and prints tables; an error if a configuration failed, or became slower than recorded.
pub fn run(args: &BenchArgs) -> Result<(), LabError> {
    if !(args.tolerance.is_finite() && args.tolerance >= 0.0) {
        return Err(LabError::Request(
            "--tolerance must be 0 or more, for example 0.1 for 10 %".into(),
        ));
    }
    match &args.against {
        Some(path) => run_against(args, path),
        None => run_asked(args),
    }
}

/// Measures the configurations of the command line.
fn run_asked(args: &BenchArgs) -> Result<(), LabError> {
    let (rounds, frames) = counts(args, ROUNDS, FRAMES)?;
    let sweep = sweep_of(args, frames)?;
    let (home, mut bar) = (Workspace::find()?, bar("measurements "));
    let open = || Lab::open(home.clone(), args.device.options());
    let mut runner = Runner::open(&open, &super::open_scene, &mut bar)?;
    let record = args
        .record
        .as_deref()
        .map(|path| record_file(path, &runner.lab.gpu.info.name));
    record
        .as_ref()
        .map(|path| super::writable(path, &["json"]))
        .transpose()?;
    let folder = folder(args, &home, &sweep.name);
    let (result, points) = of_sweep(&mut runner, &sweep, rounds, args.warmup, &folder)?;
    say_part!("{}", text(&result));
    keep(&folder, &result)?;
    super::validated(&runner.lab)?;
    let failed = result
        .configurations
        .iter()
        .filter(|c| c.error.is_some())
        .count();
    if failed > 0 {
        return Err(LabError::Request(format!("{failed} configurations failed")));
    }
    if let Some(path) = record {
        write_file(&path, &json(&Record::of(&result, &points, &home)?)?)?;
        say!(
            "recorded {} configurations in {}",
            points.len(),
            super::shown(&path).display()
        );
    }
    Ok(())
}

/// Measures the configurations of a record of this device.
fn run_against(args: &BenchArgs, path: &Path) -> Result<(), LabError> {
    let (home, mut bar) = (Workspace::find()?, bar("measurements "));
    let open = || Lab::open(home.clone(), args.device.options());
    let mut runner = Runner::open(&open, &super::open_scene, &mut bar)?;
    let device = DeviceStats::of(&runner.lab.gpu.info);
    let path = record_file(path, &device.name);
    if !path.exists() {
        let (file, device) = (path.display(), &device.name);
        return Err(LabError::Request(format!(
            "there is no '{file}', so nothing to compare '{device}' with: record its times with `conelab bench \
             EXPERIMENT... --record {file}` at a state of the program that is fast enough"
        )));
    }
    let record = Record::read(&path)?;
    record.check_device(&device)?;
    let (rounds, frames) = counts(args, record.rounds, record.frames)?;
    let chosen = chosen(args, &home, &record)?;
    let Again {
        found,
        skipped,
        mut broken,
    } = again(&mut runner, chosen, frames);
    let (recorded, points): (Vec<&Recorded>, Vec<SweepPoint>) = found.into_iter().unzip();
    let names = points.iter().flat_map(|p| &p.labels);
    let names: IndexSet<String> = names.map(|l| l.0.clone()).collect();
    let names = names.into_iter().collect();
    let result = bench(&mut runner, names, &points, rounds, frames)?;
    let mut compared: Vec<Compared> = Vec::new();
    for ((recorded, point), now) in recorded.iter().zip(&points).zip(&result.configurations) {
        match &now.times {
            Some(times) => {
                let (scene, tolerance) = (&point.subject.sha256, args.tolerance);
                compared.push(compare(recorded, times, scene, tolerance));
            }
            None => broken.push((recorded.title(), now.error.clone().unwrap_or_default())),
        }
    }
    say_part!("{}", against_text(&record, &result, &compared));
    for (title, why) in &skipped {
        say!("\nskipped: {title}\n{why}");
    }
    for (title, why) in &broken {
        say!("\ncannot be measured again: {title}\n{why}");
    }
    if compared.is_empty() {
        return Err(LabError::Request(format!(
            "nothing of '{}' could be measured again (see above)",
            path.display()
        )));
    }
    let stem = path
        .file_stem()
        .map_or("against".into(), |s| s.to_string_lossy());
    keep(&folder(args, &home, &stem), &result)?;
    super::validated(&runner.lab)?;
    verdict(args.tolerance, broken.len(), &compared)
}

/// Rounds and frames: those of the command line, else these.
fn counts(args: &BenchArgs, rounds: usize, frames: Frames) -> Result<(usize, Frames), LabError> {
    let rounds = args.rounds.unwrap_or(rounds);
    let frames = Frames {
        warmup: args.warmup.unwrap_or(frames.warmup),
        count: args.frames.unwrap_or(frames.count),
    };
    check_frames(frames.count, frames.warmup, 0.0)?;
    check_frames(rounds, 0, 0.0)
        .map_err(|_| LabError::Request("--rounds must be 1 to 1000000".into()))?;
    Ok((rounds, frames))
}

/// Every experiment with every combination of varied settings.
fn sweep_of(args: &BenchArgs, frames: Frames) -> Result<Sweep, LabError> {
    let mut experiments = Vec::new();
    for path in &args.experiments {
        let mut experiment = Experiment::read(&super::found(path)).map_err(LabError::Input)?;
        experiment.scene = args.scene.clone().unwrap_or(experiment.scene);
        experiments.push(experiment);
    }
    let mut axes = Vec::new();
    if !args.sizes.is_empty() {
        let sizes = args
            .sizes
            .iter()
            .map(|s| size(s).map(|(w, h)| format!("({w}, {h})")));
        axes.push(("size".to_string(), sizes.collect::<Result<Vec<_>, _>>()?));
    }
    let settings = args.axis.iter().map(|a| ("--axis", a, "NAME=VALUE,VALUE"));
    for (option, text, form) in settings.chain(args.set.iter().map(|s| ("--set", s, "NAME=VALUE")))
    {
        axes.push(axis(option, text, form)?);
    }
    Sweep::of(experiments, &axes, frames, "--axis")
}

/// The configurations of a record for the experiments of the command line; all without any.
/// An error if a configuration cannot be measured again or is slower.
fn verdict(tolerance: f64, broken: usize, compared: &[Compared]) -> Result<(), LabError> {
    let most = percent(tolerance);
    let mut wrong: Vec<String> = Vec::new();
    if broken > 0 {
        wrong.push(format!(
            "{broken} configurations cannot be measured again: record new times"
        ));
    }
    let slower = slower(compared);
    wrong.extend(slower.map(|list| format!("more than {most} slower than recorded: {list}")));
    if !wrong.is_empty() {
        return Err(LabError::Request(wrong.join("\n")));
    }
    say!("no stage is more than {most} slower");
    Ok(())
}

fn chosen<'r>(
    args: &BenchArgs,
    home: &Workspace,
    record: &'r Record,
) -> Result<Vec<&'r Recorded>, LabError> {
    let same = |path: &Path, recorded: &Recorded| {
        let real = super::found(path).canonicalize();
        real.is_ok_and(|real| {
            recorded
                .file(home)
                .canonicalize()
                .is_ok_and(|file| file == real)
        })
    };
    for path in &args.experiments {
        if !record.configurations.iter().any(|c| same(path, c)) {
            let mut files: Vec<&str> = record
                .configurations
                .iter()
                .map(|c| c.experiment.as_str())
                .collect();
            files.dedup();
            let message = format!(
                "the record has no times of '{}'; it has {}",
                path.display(),
                files.join(", ")
            );
            return Err(LabError::Request(message));
        }
    }
    let named = |c: &&Recorded| {
        args.experiments.is_empty() || args.experiments.iter().any(|path| same(path, c))
    };
    Ok(record.configurations.iter().filter(named).collect())
}

/// What can be measured of a record, and what cannot: title and reason.
#[derive(Default)]
struct Again<'r> {
    found: Vec<(&'r Recorded, SweepPoint)>,
    /// Their scene's files are not on this machine.
    skipped: Vec<(String, String)>,
    /// They no longer fit the program.
    broken: Vec<(String, String)>,
}

fn again<'r>(runner: &mut Runner, chosen: Vec<&'r Recorded>, frames: Frames) -> Again<'r> {
    let mut out = Again::default();
    for recorded in chosen {
        let point = recorded
            .experiment(&runner.lab.home)
            .map_err(LabError::Input)
            .and_then(|experiment| runner.point(experiment, recorded.labels(), frames));
        match point {
            Ok(point) => out.found.push((recorded, point)),
            Err(LabError::Scene(why @ (SceneError::NoModel { .. } | SceneError::Read { .. }))) => {
                out.skipped.push((recorded.title(), why.to_string()));
            }
            Err(why) => out.broken.push((recorded.title(), why.to_string())),
        }
    }
    out
}

/// Folder of the numbers and charts.
fn folder(args: &BenchArgs, home: &Workspace, name: &str) -> PathBuf {
    let own = || home.captures.join("bench").join(name);
    args.output.clone().unwrap_or_else(own)
}

/// Writes numbers and charts.
fn keep(folder: &Path, result: &Bench) -> Result<(), LabError> {
    let files = write(folder, result)?;
    let folder = super::shown(folder);
    say!("wrote {files} files to {}", folder.display());
    Ok(())
}

/// A picture's size by its usual name, or written out.
fn size(text: &str) -> Result<(u32, u32), LabError> {
    match text {
        "720p" => Ok((1280, 720)),
        "900p" => Ok((1600, 900)),
        "1080p" => Ok((1920, 1080)),
        "1440p" => Ok((2560, 1440)),
        "2160p" => Ok((3840, 2160)),
        other => parse_size(other),
    }
}
