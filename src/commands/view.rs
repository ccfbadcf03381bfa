//! `conelab view`.

use super::DeviceArgs;
use super::adapt::Changes;
use crate::graph::run::Execution;
use crate::lab::{LabError, Workspace};
use crate::vulkan::GpuOptions;
use crate::workbench::Options;
use crate::workbench::hosts::window::{self, WindowOptions};
use crate::workbench::session::Restore;
use clap::Parser;
use std::path::PathBuf;

/// Arguments of `view`.
#[derive(Debug, Parser)]
pub struct ViewArgs {
    /// Experiment file. Default: the last session, then configs/cones.ron.
    experiment: Option<PathBuf>,
    #[command(flatten)]
    changes: Changes,
    /// Run all passes in each frame, or only those with changed inputs.
    #[arg(long, value_enum, default_value_t)]
    execution: Execution,
    /// Size of the window. Default: the last session's, then 85 % of the monitor's width and height.
    #[arg(long, value_name = "WxH")]
    window: Option<String>,
    /// The device that paints the window, if it is not the one that renders.
    #[arg(long, value_name = "DEVICE")]
    window_device: Option<String>,
    /// Write events to this file, one JSON object per line, for scripts.
    #[arg(long, value_name = "FILE")]
    events: Option<PathBuf>,
    #[command(flatten)]
    device: DeviceArgs,
}

/// Opens the window.
pub fn run(args: &ViewArgs) -> Result<(), LabError> {
    let home = Workspace::find()?;
    let gpu = args.device.options();
    let size = args.window.as_deref();
    let size = size.map(super::adapt::parse_size).transpose()?;
    let window = WindowOptions {
        gpu: GpuOptions {
            device: args.window_device.clone().or(gpu.device.clone()),
            ..gpu.clone()
        },
        size: size.or(crate::workbench::session::window(&home.captures).size),
    };
    let file = super::opened(args.experiment.as_deref(), &home);
    let options = Options {
        experiment: args.changes.read(&file)?,
        file,
        size: args.changes.size()?,
        home,
        gpu,
        execution: args.execution,
        events: args.events.clone(),
        restore: match args.experiment.is_none() && args.changes.is_empty() {
            true => Restore::Experiment,
            false => Restore::Layout,
        },
    };
    window::run(options, window)
}
