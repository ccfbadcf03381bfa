//! `conelab view`.

use super::DeviceArgs;
use super::adapt::Changes;
use crate::graph::run::Execution;
use crate::lab::{LabError, Workspace};
use crate::vulkan::GpuOptions;
use crate::workbench::Options;
use crate::workbench::hosts::window::{self, WindowOptions};
use clap::Parser;
use std::path::PathBuf;

/// Arguments of `view`.
#[derive(Debug, Parser)]
pub struct ViewArgs {
    /// Experiment file; configs/cones.ron when absent.
    experiment: Option<PathBuf>,
    #[command(flatten)]
    changes: Changes,
    /// Whether a frame runs all passes, or only those with changed inputs.
    #[arg(long, value_enum, default_value_t)]
    execution: Execution,
    /// Size of the window.
    #[arg(long, value_name = "WxH", default_value = "1600x900")]
    window: String,
    /// The device that paints the window, if it is not the one that renders.
    #[arg(long, value_name = "DEVICE")]
    window_device: Option<String>,
    /// Write what happens to this file, one JSON object a line, for scripts.
    #[arg(long, value_name = "FILE")]
    events: Option<PathBuf>,
    #[command(flatten)]
    device: DeviceArgs,
}

/// Opens the window.
pub fn run(args: &ViewArgs) -> Result<(), LabError> {
    let home = Workspace::find()?;
    let gpu = args.device.options();
    let window = WindowOptions {
        gpu: GpuOptions {
            device: args.window_device.clone().or(gpu.device.clone()),
            ..gpu.clone()
        },
        size: super::adapt::parse_size(&args.window)?,
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
    };
    window::run(options, window)
}
