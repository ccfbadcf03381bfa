//! `conelab render`.

use super::adapt::{self, ExperimentArgs, parse_resource};
use super::{DeviceArgs, writable};
use crate::camera_path::CameraPath;
use crate::experiment::PlacedCamera;
use crate::graph::param::Value;
use crate::graph::run::{Execution, FrameTimes};
use crate::graph::{Graph, LightPart};
use crate::lab::{Lab, LabError, Session, Texels, Workspace};
use crate::results::timers::{Rows, Timers, stamped};
use crate::results::{picture, stats};
use clap::Args;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Arguments of `render`.
#[derive(Debug, Args)]
pub struct RenderArgs {
    #[command(flatten)]
    experiment: ExperimentArgs,
    /// Time step between frames, s.
    #[arg(long, default_value_t = 0.0)]
    step: f64,
    /// Frames to run and time; 1 when absent.
    #[arg(long)]
    frames: Option<usize>,
    /// Frames to run before timing starts. When absent: the frames that the graph needs to
    /// converge.
    #[arg(long)]
    warmup: Option<usize>,
    /// Run all passes in each frame, or only those with changed inputs. Pictures are bit-identical.
    #[arg(long, value_enum, default_value_t)]
    execution: Execution,
    /// Move the camera along this path (configs/paths) by each frame's time.
    #[arg(long, value_name = "FILE")]
    path: Option<PathBuf>,
    /// Write every frame to this folder, as frame-00000.png and so on.
    #[arg(long, value_name = "FOLDER")]
    sequence: Option<PathBuf>,
    /// Write this texture instead of the picture.
    #[arg(long, value_name = "NAME[:MIP[:LAYER]]")]
    resource: Option<String>,
    /// Shuffle the scene's triangles with this seed. Results must not depend on their order.
    #[arg(long, value_name = "SEED")]
    shuffle: Option<u64>,
    /// Output file, .png or .exr: the last frame.
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// Draw GPU times onto the pictures (.png): of stages, or of every pass.
    #[arg(long, value_enum, value_name = "ROWS")]
    timers: Option<Rows>,
    /// Write timings and settings to this JSON file; `-` prints only JSON to standard output.
    #[arg(long)]
    json: Option<PathBuf>,
    #[command(flatten)]
    device: DeviceArgs,
}

/// A file or folder, and the texture that is written to it, with mip and layer.
type Shown<'a> = (&'a PathBuf, (String, u32, u32));

/// Renders.
pub fn run(args: &RenderArgs) -> Result<(), LabError> {
    let experiment = args.experiment.read()?;
    let exr = check(args)?;
    let path = args.path.as_deref().map(super::found);
    let path = path.map(|path| CameraPath::read(&path));
    let path = path.transpose().map_err(LabError::Input)?;
    let home = Workspace::find()?;
    let mut scene = adapt::open_scene(&experiment)?;
    if let Some(seed) = args.shuffle {
        scene = scene.shuffled(seed);
    }
    let lab = Lab::open(home, args.device.options())?;
    let resource = args.resource.as_deref().map(parse_resource).transpose()?;
    let (mut shown, mut frames_of): (Option<Shown>, Option<Shown>) = (None, None);
    let (mut session, warnings) = lab.prepare(&experiment, Arc::new(scene), |graph| {
        if let Some(path) = &args.output {
            shown = Some((path, texture(graph, resource.as_ref(), exr)?));
        }
        if let Some(path) = &args.sequence {
            frames_of = Some((path, texture(graph, resource.as_ref(), false)?));
        }
        let all = shown.iter().chain(&frames_of);
        Ok(all.map(|s| s.1.0.clone()).collect())
    })?;
    for warning in warnings {
        warn!("{warning}");
    }
    if shown.is_none() && frames_of.is_none() {
        return Err(LabError::Request(
            "nothing to write: name the picture with --output, for example -o picture.png".into(),
        ));
    }
    session.set_execution(args.execution);
    let warmup = warmup(args, &session);
    let camera = |number: usize| {
        let time = experiment.time + number as f64 * args.step;
        path.as_ref().map(|path| path.at(time))
    };
    let times = frames(args, &lab, &mut session, warmup, camera, frames_of.as_ref())?;
    let failed = failed_checks(&mut session, shown.as_ref())?;
    if let Some((path, shown)) = &shown {
        let rows = args.timers.filter(|_| !exr);
        let timers = rows.map(|rows| timers(rows, &lab, &session, &times));
        write_texture(&lab, &mut session, path, shown, timers)?;
    }
    let (info, name) = (&lab.gpu.info, &experiment.name);
    let stats = stats::collect(info, name, &session, &times, warmup, failed);
    say_part!("{}", stats::table(&stats));
    if let Some((folder, _)) = &frames_of {
        let frames = args.frames.unwrap_or(1);
        say!("wrote {frames} frames to {}", folder.display());
    }
    print(&session, shown.as_ref(), exr && resource.is_none());
    if let Some(path) = &args.json {
        super::write_json(path, &stats)?;
    }
    drop(session);
    super::validated(&lab)
}

/// Checks arguments before anything is opened; whether the picture is linear.
fn check(args: &RenderArgs) -> Result<bool, LabError> {
    let (frames, given) = (args.frames.unwrap_or(1), args.warmup.unwrap_or(0));
    adapt::check_frames(frames, given, args.step)?;
    let exr = match &args.output {
        Some(output) => writable(output, &["png", "exr"])? == "exr",
        None => false,
    };
    if let Some(json) = &args.json {
        writable(json, &["json"])?;
    }
    if let Some(folder) = &args.sequence {
        without_frames(folder)?;
    }
    Ok(exr)
}

/// The texture to write: the named one, or the picture.
fn texture(
    graph: &Graph,
    resource: Option<&(String, u32, u32)>,
    exr: bool,
) -> Result<(String, u32, u32), LabError> {
    match resource {
        Some(r) if graph.texture(&r.0).is_some() => Ok(r.clone()),
        Some(r) => Err(crate::lab::no_texture(graph, &r.0)),
        None => Ok((result_name(graph, exr)?, 0, 0)),
    }
}

fn warmup(args: &RenderArgs, session: &Session) -> usize {
    let alone =
        args.frames.is_none() && args.sequence.is_none() && args.path.is_none() && args.step == 0.0;
    let converging = if alone {
        session.converging_frames()
    } else {
        1
    };
    args.warmup.unwrap_or(converging - 1)
}

/// Runs all frames, and returns the times of those after the warm-up.
fn frames(
    args: &RenderArgs,
    lab: &Lab,
    session: &mut Session,
    warmup: usize,
    camera: impl Fn(usize) -> Option<PlacedCamera>,
    frames_of: Option<&Shown>,
) -> Result<Vec<FrameTimes>, LabError> {
    let frames = args.frames.unwrap_or(1);
    let mut times = Vec::new();
    let bar = indicatif::ProgressBar::new((warmup + frames) as u64);
    session.begin_warm_up(&lab.gpu.info);
    for number in 0..warmup + frames {
        if number == warmup {
            session.set_execution(args.execution);
        }
        if let Some(camera) = camera(number) {
            session.place_camera(&camera);
        }
        times.extend(session.frame(args.step)?);
        if let (Some((folder, shown)), Some(frame)) = (frames_of, number.checked_sub(warmup)) {
            times.extend(session.finish()?);
            let file = folder.join(format!("frame-{frame:05}.png"));
            let rows = args.timers.zip(times.last());
            let timers =
                rows.map(|(rows, times)| timers(rows, lab, session, std::slice::from_ref(times)));
            write_texture(lab, session, &file, shown, timers)?;
        }
        bar.inc(1);
    }
    times.extend(session.finish()?);
    bar.finish_and_clear();
    Ok(times.split_off(times.len().saturating_sub(frames)))
}

/// Failed checks, which are printed.
fn failed_checks(session: &mut Session, shown: Option<&Shown>) -> Result<Vec<String>, LabError> {
    let mut failed = session.failed_checks()?;
    if let Some((_, (name, mip, layer))) = shown {
        failed.extend(not_finite(&session.texels(name, *mip, *layer)?, name));
    }
    for message in &failed {
        warn!("warning: {message}");
    }
    Ok(failed)
}

/// Names the picture that was written. `linear` is whether it is the linear picture.
fn print(session: &Session, shown: Option<&Shown>, linear: bool) {
    let Some((path, (name, ..))) = shown else {
        return;
    };
    if !linear {
        return say!("wrote {}", path.display());
    }
    say!("wrote {} ('{name}', linear)", path.display());
    if let Some(part) = part_asked_for(session).filter(|p| p.texture != *name) {
        warn!(
            "warning: '{name}' is the whole light; --resource {} writes '{}' alone",
            part.texture, part.name
        );
    }
}

/// A warning about texels that are not finite.
fn not_finite(texels: &Texels, name: &str) -> Option<String> {
    let count = texels
        .floats()
        .iter()
        .filter(|t| t.iter().any(|v| !v.is_finite()))
        .count();
    (count > 0).then(|| format!("'{name}' has {count} texels that are NaN or infinite"))
}

/// The part of the light that a parameter is set to show, and its texture.
fn part_asked_for(session: &Session) -> Option<LightPart> {
    let set = |part: &str| {
        session
            .params
            .values
            .iter()
            .any(|v| matches!(v, Value::Choice(option) if option == part))
    };
    session
        .graph
        .parts
        .iter()
        .find(|part| set(&part.name))
        .cloned()
}

fn write_texture(
    lab: &Lab,
    session: &mut Session,
    path: &Path,
    shown: &(String, u32, u32),
    timers: Option<Timers>,
) -> Result<(), LabError> {
    let texels = session.texels(&shown.0, shown.1, shown.2)?;
    match timers {
        Some(timers) => picture::write(path, &stamped(&lab.gpu, &texels, &timers)?),
        None => picture::write(path, &texels),
    }
}

/// The medians of frames' times, to be drawn onto a picture.
fn timers(rows: Rows, lab: &Lab, session: &Session, times: &[FrameTimes]) -> Timers {
    let passes = times
        .first()
        .map_or(&[][..], |t| &t.passes)
        .iter()
        .enumerate()
        .map(|(i, (number, _))| {
            let of = times.iter().filter_map(|t| t.passes.get(i)).map(|p| p.1);
            (*number, stats::spread(of.collect()).median)
        });
    let size = session.size().into();
    Timers::new(
        rows,
        &session.graph,
        &session.params,
        &lab.gpu.info.name,
        size,
        &passes.collect::<Vec<_>>(),
    )
}

/// Makes the folder of a sequence, unless it has frames: two sequences in one would look like one.
fn without_frames(folder: &Path) -> Result<(), LabError> {
    let fail = |why: String| {
        LabError::Request(format!(
            "cannot write frames to '{}': {why}",
            folder.display()
        ))
    };
    std::fs::create_dir_all(folder).map_err(|e| fail(e.to_string()))?;
    let is_frame = |name: &str| name.starts_with("frame-") && name.to_lowercase().ends_with(".png");
    for entry in std::fs::read_dir(folder)
        .map_err(|e| fail(e.to_string()))?
        .flatten()
    {
        let name = entry.file_name().to_string_lossy().into_owned();
        if is_frame(&name) {
            return Err(fail(format!("it has '{name}'; choose an empty folder")));
        }
    }
    Ok(())
}

fn result_name(graph: &Graph, exr: bool) -> Result<String, LabError> {
    let (name, field) = if exr {
        (&graph.hdr, "hdr")
    } else {
        (&graph.output, "output")
    };
    name.clone().ok_or_else(|| {
        LabError::Request(format!(
            "graph '{}' has no `{field}`; name a texture with --resource",
            graph.name
        ))
    })
}
