//! `conelab compare`.

mod frames;
mod sides;

use super::adapt::Changes;
use super::{DeviceArgs, writable};
use crate::campaign::settings::named;
use crate::lab::LabError;
use crate::measure::comparison::{Request, Side, compare, table};
use crate::measure::reference::ALL_BOUNCES;
use crate::metrics::MetricError;
use crate::metrics::maps::MapFile;
use crate::metrics::region::Region;
use crate::results::picture;
use clap::Args;
use sides::Sources;
use std::path::{Path, PathBuf};

/// Arguments of `compare`.
#[derive(Debug, Args)]
pub struct CompareArgs {
    /// A picture (.exr, .hdr, .png), an experiment (.ron), which is rendered, or the folder of a
    /// capture.
    a: PathBuf,
    /// Second input. Without --reference, and if A has no cached reference, it is the reference of
    /// A.
    b: Option<PathBuf>,
    /// Reference of both: a picture, an experiment, a capture, `auto` for the cached reference of A
    /// if A is an experiment and has one, or `none`.
    #[arg(long, default_value = "auto")]
    reference: PathBuf,
    /// Use the cached reference with this number of bounces; an error if there is none.
    #[arg(long)]
    bounces: Option<u32>,
    /// Compare only this light component (repeatable).
    #[arg(long)]
    part: Vec<String>,
    /// Score the white pixels of this mask separately (repeatable).
    #[arg(long, value_name = "NAME=FILE")]
    mask: Vec<String>,
    /// Frames of an experiment to run; the last is compared. When absent: the frames that its graph
    /// needs to converge.
    #[arg(long)]
    frames: Option<usize>,
    /// Write all scores to this JSON file.
    #[arg(long)]
    json: Option<PathBuf>,
    /// Write maps of the error to this folder, PNG and EXR.
    #[arg(long, value_name = "FOLDER")]
    maps: Option<PathBuf>,
    /// Score experiments after 1, 2, 4, ... frames, up to --frames (256 when absent), and write
    /// charts of the error against frames and GPU time to this folder.
    #[arg(long, value_name = "FOLDER")]
    by_frame: Option<PathBuf>,
    #[command(flatten)]
    changes: Changes,
    #[command(flatten)]
    device: DeviceArgs,
}

/// Compares.
pub fn run(args: &CompareArgs) -> Result<(), LabError> {
    super::adapt::check_frames(args.frames.unwrap_or(1), 0, 0.0)?;
    if let Some(json) = &args.json {
        writable(json, &["json"])?;
    }
    let masks = args
        .mask
        .iter()
        .map(|m| mask(m))
        .collect::<Result<Vec<_>, _>>()?;
    let mut sources = Sources::new(&args.changes, &args.device, args.frames);
    let a = sources.side(&args.a, true)?;
    let b = args.b.as_ref().map(|b| sources.side(b, true)).transpose()?;
    let given = match args.reference.to_str() {
        // An experiment is the reference of a picture from another program.
        Some("auto") if args.a.extension().is_some_and(|e| e == "ron") => {
            sources.cached(args.bounces.unwrap_or(ALL_BOUNCES))?
        }
        Some("auto") => None,
        Some("none") => None,
        _ => Some(sources.side(&args.reference, false)?),
    };
    if let (Some(n), None) = (args.bounces, &given) {
        let message = format!(
            "A has no cached reference of {n} bounces; `conelab reference --bounces {n}` makes one"
        );
        return Err(LabError::Request(message));
    }
    let (pictures, reference) = roles(a, b, given)?;
    let mut written = Vec::new();
    let mut keep = |i: usize, part: &str, files: Vec<MapFile>| match &args.maps {
        Some(folder) => write_maps(folder, i, part, files, &mut written),
        None => Ok(()),
    };
    let request = Request {
        parts: &args.part,
        masks: &masks,
        maps: args.maps.is_some().then_some(&mut keep as &mut _),
    };
    let comparison = compare(&pictures, &reference, request)?;
    say_part!("{}", table(&comparison));
    for line in &written {
        say!("{line}");
    }
    if let Some(path) = &args.json {
        super::write_json(path, &comparison)?;
    }
    if let Some(folder) = &args.by_frame {
        by_frame(args, &mut sources, &reference, (pictures.len(), folder))?;
    }
    sources.validated()
}

/// Scores the first experiments by frame.
fn by_frame(
    args: &CompareArgs,
    sources: &mut Sources,
    reference: &Side,
    (pictures, folder): (usize, &Path),
) -> Result<(), LabError> {
    let part = args.part.first().map_or("total", String::as_str);
    let mut steps = Vec::new();
    for path in std::iter::once(&args.a).chain(&args.b).take(pictures) {
        if path.extension().is_some_and(|e| e == "ron") {
            let (mut session, ..) = sources.session(path, true)?;
            let name = super::shown(path).display().to_string();
            steps.extend(frames::steps(
                &mut session,
                &name,
                reference,
                args.frames,
                part,
            )?);
        }
    }
    if steps.is_empty() {
        return Err(LabError::Request(
            "--by-frame is for experiments (.ron): pictures and captures have one frame".into(),
        ));
    }
    say_part!("\n{}", frames::text(&steps));
    for path in frames::write(folder, part, &steps)? {
        say!("wrote {}", path.display());
    }
    Ok(())
}

/// The compared sides and the reference. Without a reference, A is compared with B.
fn roles(a: Side, b: Option<Side>, reference: Option<Side>) -> Result<(Vec<Side>, Side), LabError> {
    match (b, reference) {
        (b, Some(reference)) => Ok((std::iter::once(a).chain(b).collect(), reference)),
        (Some(mut b), None) => {
            b.name.push_str(" (B: there is no other reference)");
            Ok((vec![a], b))
        }
        (None, None) => Err(LabError::Request(
            "there is nothing to compare with: give a second picture or --reference; `conelab reference` makes one"
                .into(),
        )),
    }
}

/// A region painted in a file, `NAME=FILE`.
fn mask(text: &str) -> Result<Region, LabError> {
    let (name, file) = named("--mask", text, "NAME=FILE")?;
    Ok(Region::painted(
        name,
        &picture::read_linear(Path::new(file))?,
    ))
}

fn write_maps(
    folder: &Path,
    picture: usize,
    part: &str,
    files: Vec<MapFile>,
    written: &mut Vec<String>,
) -> Result<(), MetricError> {
    let letter = if picture == 0 { "a" } else { "b" };
    for file in files {
        let path = folder.join(format!("{letter}-{part}-{}", file.name));
        crate::files::write_whole(&path, &file.bytes).map_err(|e| MetricError(e.to_string()))?;
        written.push(format!("wrote {} ({})", path.display(), file.scale));
    }
    Ok(())
}
