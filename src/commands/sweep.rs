//! `conelab sweep`.

use super::DeviceArgs;
use super::campaign_bar::bar;
use crate::campaign::runner::Counts;
use crate::campaign::sweep::{Options, Shard, Sweep, run as run_sweep};
use crate::lab::{Lab, LabError, Workspace};
use crate::measure::Frames;
use crate::measure::reference::Goal;
use clap::Args;
use std::path::PathBuf;

/// Arguments of `sweep`.
#[derive(Debug, Args)]
pub struct SweepArgs {
    /// Sweep file, for example configs/sweeps/cones.ron.
    sweep: PathBuf,
    /// Folder of the points; captures/sweeps/NAME when absent. Finished points in it are not
    /// measured again.
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    /// Measure only every N-th point from the I-th on, so that several machines share the work.
    #[arg(long, value_name = "I/N")]
    shard: Option<String>,
    /// Frames of every point, instead of the file's.
    #[arg(long)]
    frames: Option<usize>,
    /// Warm-up frames per point, instead of the file's (extended to 100 ms on GPUs).
    #[arg(long)]
    warmup: Option<usize>,
    /// First path-trace the references of the points to this number of samples per pixel, or until their noise is at most a bound, for example flip=0.01. Without it, cached references are used as they are.
    #[arg(long, value_name = "SAMPLES|METRIC=ERROR")]
    reference: Option<Goal>,
    /// Measure failed points again.
    #[arg(long)]
    again: bool,
    #[command(flatten)]
    device: DeviceArgs,
}

/// Runs a sweep; an error if points failed.
pub fn run(args: &SweepArgs) -> Result<(), LabError> {
    let sweep = Sweep::read(&super::found(&args.sweep)).map_err(LabError::Input)?;
    let shard = args.shard.as_deref().map_or(Ok(Shard::ALL), parse_shard)?;
    let frames = Frames {
        warmup: args.warmup.unwrap_or(sweep.frames.warmup),
        count: args.frames.unwrap_or(sweep.frames.count),
    };
    super::adapt::check_frames(frames.count, frames.warmup, 0.0)?;
    let home = Workspace::find()?;
    let folder = args
        .output
        .clone()
        .unwrap_or_else(|| home.captures.join("sweeps").join(&sweep.name));
    let options = Options {
        folder,
        shard,
        frames,
        again: args.again,
        goal: args.reference,
    };
    let Counts { done, failed } = run_with_bar(&home, &args.device, &sweep, &options)?;
    let of = if shard.of > 1 {
        format!("shard {}/{}: ", shard.number, shard.of)
    } else {
        String::new()
    };
    say!("wrote {}", super::shown(&options.folder).display());
    say!(
        "{of}{} points: {done} done, {failed} failed, 0 left",
        done + failed
    );
    match failed {
        0 => Ok(()),
        n => Err(LabError::Request(format!(
            "{n} points failed: their errors are in sweep.csv; --again measures them again"
        ))),
    }
}

/// Measures a sweep's points with a progress bar.
pub fn run_with_bar(
    home: &Workspace,
    device: &DeviceArgs,
    sweep: &Sweep,
    options: &Options,
) -> Result<Counts, LabError> {
    let reopen = || Lab::open(home.clone(), device.options());
    run_sweep(
        &reopen,
        &super::open_scene,
        sweep,
        options,
        &mut bar("points "),
    )
}

fn parse_shard(text: &str) -> Result<Shard, LabError> {
    let wrong = || {
        LabError::Request(format!(
            "--shard {text}: expected I/N with I from 1 to N, for example 3/16"
        ))
    };
    let (number, of) = text.split_once('/').ok_or_else(wrong)?;
    let shard = Shard {
        number: number.parse().map_err(|_| wrong())?,
        of: of.parse().map_err(|_| wrong())?,
    };
    if shard.number == 0 || shard.number > shard.of {
        Err(wrong())
    } else {
        Ok(shard)
    }
}
