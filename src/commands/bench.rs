//! `conelab bench`.

use super::DeviceArgs;
use super::adapt::{check_frames, parse_size};
use crate::bench::{bench, charts, csv, text};
use crate::experiment::Experiment;
use crate::lab::{Home, Lab, LabError};
use crate::measure::{Frames, Warm};
use crate::sweep::{Lister, Sweep, list, write_file};
use clap::Args;
use std::path::PathBuf;

/// Arguments of `bench`.
#[derive(Debug, Args)]
pub struct BenchArgs {
    /// Experiment files.
    #[arg(required = true)]
    experiments: Vec<PathBuf>,
    /// Another scene: a built-in name, a scene RON, or a model file.
    #[arg(long)]
    scene: Option<String>,
    /// Picture sizes: 720p, 900p, 1080p, 1440p, 2160p or WIDTHxHEIGHT; the experiments' own when absent.
    #[arg(long, value_delimiter = ',')]
    sizes: Vec<String>,
    /// Set a parameter in every configuration; may be given many times.
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// A setting and its values; may be given many times. The first makes the columns of the tables.
    #[arg(long, value_name = "NAME=V1,V2")]
    axis: Vec<String>,
    /// How often every configuration has its turn.
    #[arg(long, default_value_t = 5)]
    rounds: usize,
    /// Frames of every turn.
    #[arg(long, default_value_t = 40)]
    frames: usize,
    /// Frames before those of every turn; on a GPU more, until it has worked for 100 ms.
    #[arg(long, default_value_t = 10)]
    warmup: usize,
    /// Where bench.json, bench.csv and the charts go; captures/bench/NAME when absent.
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    #[command(flatten)]
    device: DeviceArgs,
}

/// Measures and prints tables; an error if a configuration failed.
pub fn run(args: &BenchArgs) -> Result<(), LabError> {
    check_frames(args.frames, args.warmup, 0.0)?;
    check_frames(args.rounds, 0, 0.0).map_err(|_| LabError::Request("--rounds must be 1 to 1000000".into()))?;
    let frames = Frames { warmup: args.warmup, count: args.frames };
    let mut experiments = Vec::new();
    for path in &args.experiments {
        let mut experiment = Experiment::read(path).map_err(LabError::Input)?;
        experiment.scene = args.scene.clone().unwrap_or(experiment.scene);
        experiments.push(experiment);
    }
    let mut axes = Vec::new();
    if !args.sizes.is_empty() {
        let sizes = args.sizes.iter().map(|s| size(s).map(|(w, h)| format!("({w}, {h})")));
        axes.push(("size".to_string(), sizes.collect::<Result<Vec<_>, _>>()?));
    }
    let settings = args.axis.iter().map(|a| ("--axis", a, "NAME=VALUE,VALUE"));
    for (option, text, form) in settings.chain(args.set.iter().map(|s| ("--set", s, "NAME=VALUE"))) {
        let wrong = || LabError::Request(format!("{option} {text}: expected {form}"));
        let (name, values) = text.split_once('=').ok_or_else(wrong)?;
        axes.push((name.trim().to_string(), split(values)));
    }
    let sweep = Sweep::of(experiments, &axes, frames)?;
    let home = Home::find()?;
    let folder = args.output.clone().unwrap_or_else(|| home.root.join("captures/bench").join(&sweep.name));
    let lab = Lab::open(home.clone(), args.device.options())?;
    let mut warm = Warm::default();
    let (points, _) = list(&mut Lister::new(&home, &super::open_scene), &mut warm, &sweep, frames)?;
    let bar = indicatif::ProgressBar::new((points.len() * args.rounds) as u64).with_style(
        indicatif::ProgressStyle::with_template("{pos}/{len} {bar:30} {elapsed} so far, {eta} left")
            .unwrap_or_else(|_| indicatif::ProgressStyle::default_bar()),
    );
    let result = bench(&lab, &mut warm, sweep.names.clone(), &points, args.rounds, frames, &|| bar.inc(1))?;
    bar.finish_and_clear();
    say_part!("{}", text(&result));
    let json = serde_json::to_vec_pretty(&result).map_err(|e| LabError::Request(e.to_string()))?;
    let mut files = vec![("bench.json".to_string(), json), ("bench.csv".to_string(), csv(&result)?.into_bytes())];
    files.extend(charts(&result)?.into_iter().map(|(name, svg)| (format!("{name}.svg"), svg.into_bytes())));
    for (name, bytes) in &files {
        write_file(&folder.join(name), bytes)?;
    }
    say!("wrote {} files to {}", files.len(), super::shown(&folder).display());
    super::validated(&lab)?;
    match result.configurations.iter().filter(|c| c.error.is_some()).count() {
        0 => Ok(()),
        n => Err(LabError::Request(format!("{n} configurations failed"))),
    }
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

/// Values between commas; those inside brackets belong to a value.
fn split(text: &str) -> Vec<String> {
    let (mut values, mut depth) = (vec![String::new()], 0usize);
    for c in text.chars() {
        match c {
            '(' | '[' => depth += 1,
            ')' | ']' => depth = depth.saturating_sub(1),
            _ => {}
        }
        match (c, depth, values.last_mut()) {
            (',', 0, _) => values.push(String::new()),
            (c, _, Some(last)) => last.push(c),
            (_, _, None) => {}
        }
    }
    values
}
