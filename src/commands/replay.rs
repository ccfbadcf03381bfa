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
    /// Refuse captures with more frames than this. A capture from elsewhere may ask for a million.
    #[arg(long, value_name = "N", default_value_t = 10_000)]
    max_frames: usize,
    /// Write the new pictures to this folder.
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    #[command(flatten)]
    device: DeviceArgs,
}

/// A replay of more frames than this prints their number first.
const MANY_FRAMES: usize = 100;

/// Renders a capture again and prints the differences.
pub fn run(args: &ReplayArgs) -> Result<(), LabError> {
    let manifest = Manifest::read(&args.capture)?;
    let frames = manifest.frames;
    if frames > args.max_frames {
        return Err(LabError::Request(format!(
            "'{}' asks for {frames} frames, more than {}; give --max-frames {frames} to render them",
            args.capture.display(),
            args.max_frames
        )));
    }
    if frames > MANY_FRAMES {
        eprintln!(
            "rendering {frames} frames of {}x{} pixels",
            manifest.size[0], manifest.size[1]
        );
    }
    // Printed first: a changed folder may be the reason of an error.
    for change in changes(&args.capture, &manifest) {
        say!("{change}");
    }
    // Graph and shaders are the capture's own; the project has only the caches.
    let home = Workspace::with(args.capture.clone(), Workspace::cache());
    let lab = Lab::open(home, args.device.options())?;
    let output = args.output.as_deref();
    let result = replay(&lab, &args.capture, &manifest, super::open_scene, output)?;
    for change in &result.changes {
        say!("{change}");
    }
    for d in &result.differences {
        match &d.broken {
            Some(why) => say!("{why}"),
            None => say!(
                "{}: {} of {} texels differ, by at most {}",
                d.file,
                d.texels,
                d.of,
                d.largest
            ),
        }
    }
    if let Some(output) = &args.output {
        say!("wrote {} images to {}", result.images, output.display());
    }
    super::validated(&lab)?;
    let images = result.images;
    match result.differences.len() {
        0 => {
            say!("identical: {images} images, {} texels", result.texels);
            Ok(())
        }
        n => Err(LabError::Request(format!("{n} of {images} images differ"))),
    }
}
