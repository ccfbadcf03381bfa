//! `conelab ablate`.

mod steps;

use super::DeviceArgs;
use super::adapt::{self, ExperimentArgs};
use super::sweep::run_with_bar;
use crate::campaign::ablation::{changes, csv, markdown, rows};
use crate::campaign::record::write_files;
use crate::campaign::sweep::{Options, Shard, Sweep};
use crate::lab::{LabError, Workspace, focus_of, params_of};
use crate::measure::Frames;
use crate::measure::reference::{ALL_BOUNCES, Goal};
use clap::Args;
use std::path::PathBuf;

/// Arguments of `ablate`.
#[derive(Debug, Args)]
pub struct AblateArgs {
    #[command(flatten)]
    experiment: ExperimentArgs,
    /// Scenes to measure in: built-in names, scene RONs or model files; the experiment's own when
    /// absent.
    #[arg(long, value_name = "SCENE,...", value_delimiter = ',', conflicts_with_all = ["scene", "steps"])]
    scenes: Vec<String>,
    /// Change only these parameters; all that have a plain value when absent.
    #[arg(
        long,
        value_name = "NAME,...",
        value_delimiter = ',',
        conflicts_with = "steps"
    )]
    only: Vec<String>,
    /// Runs of the unchanged experiment. Their spread is the noise of times.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u32).range(2..=100), conflicts_with = "steps")]
    runs: u32,
    /// Warm-up frames before the timed ones (extended to 100 ms on GPUs).
    #[arg(long, default_value_t = 10, conflicts_with = "steps")]
    warmup: usize,
    /// Folder of the results; captures/ablations/NAME when absent. Finished points in it are not
    /// measured again.
    #[arg(short, long, value_name = "FOLDER", conflicts_with = "steps")]
    output: Option<PathBuf>,
    /// Run the graph's own steps from an ideal to the method instead, and print what each adds to
    /// the error.
    #[arg(long)]
    steps: bool,
    /// Samples per pixel of the references, if cached ones have fewer.
    #[arg(long, default_value_t = 256)]
    spp: u64,
    /// Bounces of the references.
    #[arg(long, default_value_t = ALL_BOUNCES)]
    bounces: u32,
    /// Frames to time; 50 when absent. With --steps, frames of each step; as many as it needs to
    /// converge when absent.
    #[arg(long)]
    frames: Option<usize>,
    /// With --steps: write the numbers to this JSON file.
    #[arg(long, requires = "steps")]
    json: Option<PathBuf>,
    /// With --steps: write the picture of every step and part, as EXR, to this folder.
    #[arg(long, value_name = "FOLDER", requires = "steps")]
    pictures: Option<PathBuf>,
    #[command(flatten)]
    device: DeviceArgs,
}

/// Prints the effect of each parameter, or the error that each step of the graph's ablation adds.
pub fn run(args: &AblateArgs) -> Result<(), LabError> {
    if args.steps {
        steps::run(args)
    } else {
        parameters(args)
    }
}

fn parameters(args: &AblateArgs) -> Result<(), LabError> {
    let experiment = args.experiment.read()?;
    let frames = Frames {
        warmup: args.warmup,
        count: args.frames.unwrap_or(50),
    };
    adapt::check_frames(frames.count, frames.warmup, 0.0)?;
    let home = Workspace::find()?;
    let graph = home.load_of(&experiment).map_err(LabError::Input)?.graph;
    let changes = changes(&params_of(&graph, &experiment)?, &args.only)?;
    let mut scenes = args.scenes.clone();
    if scenes.is_empty() {
        scenes.push(experiment.scene.clone());
    }
    let own = || home.captures.join("ablations").join(&experiment.name);
    let folder = args.output.clone().unwrap_or_else(own);

    // Points of one number have one result: repetitions are sweeps of their own.
    let mut folders = vec![folder.clone()];
    folders.extend((2..=args.runs).map(|run| folder.join(format!("unchanged-{run}"))));
    let mut failed = 0;
    for (number, folder) in folders.iter().enumerate() {
        let changes = if number == 0 { &changes[..] } else { &[] };
        let settings = changes.iter().map(|c| (c.name.clone(), c.to.to_string()));
        let settings: Vec<(String, String)> = settings.collect();
        let sweep =
            Sweep::one_at_a_time(experiment.clone(), &scenes, &settings, frames, args.bounces);
        let options = Options {
            folder: folder.clone(),
            shard: Shard::ALL,
            frames,
            again: false,
            goal: Some(Goal::Samples(args.spp)),
        };
        failed += run_with_bar(&home, &args.device, &sweep, &options)?.failed;
    }

    let mut parts = vec!["total".to_string()];
    parts.extend(focus_of(&graph).map(|p| p.name.clone()));
    let rows = rows(&folders, &scenes, &changes, &parts)?;
    let table = markdown(&rows);
    let (name, list, runs) = (&experiment.name, scenes.join(", "), args.runs);
    let ((width, height), bounces, count) = (experiment.size, args.bounces, frames.count);
    let text = format!(
        "# {name}: each parameter at its plain value\n\nScenes: {list}; {bounces} bounces; {width}x{height}; {count} frames; {runs} runs.\n\n{table}"
    );
    let files = [
        ("ablation.md".into(), text.into()),
        ("ablation.csv".into(), csv(&rows)?.into()),
    ];
    write_files(&folder, &files)?;
    say!("{table}\nwrote {}", super::shown(&folder).display());
    match failed {
        0 => Ok(()),
        n => Err(LabError::Request(format!(
            "{n} points failed: their errors are in sweep.csv"
        ))),
    }
}
