//! `conelab capture`.

use super::DeviceArgs;
use super::adapt::{self, ExperimentArgs, parse_resource};
use crate::experiment::checked_name;
use crate::lab::{Lab, LabError, Workspace};
use crate::results::capture::{Resource, What, sweep_partials, take};
use crate::results::timers::Rows;
use clap::Args;
use std::sync::Arc;

/// Arguments of `capture`.
#[derive(Debug, Args)]
pub struct CaptureArgs {
    #[command(flatten)]
    experiment: ExperimentArgs,
    /// Name of the capture. Without it: the experiment's name, with a number if another capture has
    /// that name.
    #[arg(long)]
    name: Option<String>,
    /// Also save this texture (repeatable).
    #[arg(long, value_name = "NAME[:MIP[:LAYER]]")]
    resource: Vec<String>,
    /// Frames to run; the last is captured. When absent: the frames that the graph needs to
    /// converge, or one with --step.
    #[arg(long)]
    frames: Option<usize>,
    /// Time step between frames, s.
    #[arg(long, default_value_t = 0.0)]
    step: f64,
    /// Also save the picture with GPU times drawn on it: of stages, or of all passes.
    #[arg(long, value_enum, value_name = "ROWS")]
    timers: Option<Rows>,
    #[command(flatten)]
    device: DeviceArgs,
}

/// Takes a capture.
pub fn run(args: &CaptureArgs) -> Result<(), LabError> {
    let experiment = args.experiment.read()?;
    adapt::check_frames(args.frames.unwrap_or(1), 0, args.step)?;
    let resources = args.resource.iter().map(|text| {
        let (name, mip, layer) = parse_resource(text)?;
        Ok(Resource { name, mip, layer })
    });
    let what = What {
        resources: resources.collect::<Result<_, LabError>>()?,
        frames: args.frames,
        step: args.step,
        timers: args.timers.unwrap_or_default(),
        numbered: args.name.is_none(),
    };
    let home = Workspace::find()?;
    let folder = home.captures.clone();
    let name = checked_name(args.name.as_ref().unwrap_or(&experiment.name))?;
    sweep_partials(&folder);
    let scene = adapt::open_scene(&experiment)?;
    let lab = Lab::open(home, args.device.options())?;
    let path = take(&lab, &experiment, Arc::new(scene), &what, &folder, &name)?;
    say!("wrote {}", super::shown(&path).display());
    super::validated(&lab)
}
