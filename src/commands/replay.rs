//! `conelab replay`.

use super::DeviceArgs;
use crate::lab::{Lab, LabError, Workspace};
use crate::results::capture::{Manifest, changes, replay};
use clap::Args;
use std::path::PathBuf;

/// Arguments of `replay`.
#[derive(Debug, Args)]
pub struct ReplayArgs {
    /// Folder of a capture, for example captures/default.
    capture: PathBuf,
    /// Write the new pictures to this folder.
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    #[command(flatten)]
    device: DeviceArgs,
}

/// Renders a capture again and says what differs.
pub fn run(args: &ReplayArgs) -> Result<(), LabError> {
    let manifest = Manifest::read(&args.capture)?;
    // Told first: what has changed in the folder may be why it cannot be rendered.
    for change in changes(&args.capture, &manifest) {
        say!("{change}");
    }
    // Graph and shaders are the capture's own; the project has only the caches.
    let home = Workspace { root: args.capture.clone(), cache: Workspace::cache() };
    let lab = Lab::open(home, args.device.options())?;
    let result = replay(&lab, &args.capture, &manifest, super::open_scene, args.output.as_deref())?;
    for change in &result.changes {
        say!("{change}");
    }
    for d in &result.differences {
        match &d.broken {
            Some(why) => say!("{why}"),
            None => say!("{}: {} of {} texels differ, by at most {}", d.file, d.texels, d.of, d.largest),
        }
    }
    if let Some(output) = &args.output {
        say!("wrote {} images to {}", result.images, output.display());
    }
    super::validated(&lab)?;
    match result.differences.len() {
        0 => {
            say!("identical: {} images, {} texels", result.images, result.texels);
            Ok(())
        }
        n => Err(LabError::Request(format!("{n} of {} images differ", result.images))),
    }
}
