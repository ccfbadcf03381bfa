//! `conelab render`.

use super::DeviceArgs;
use crate::experiment::{CameraChoice, Experiment, PlacedCamera, check_size};
use crate::graph::load::Graph;
use crate::graph::source::{At, Loc};
use crate::lab::{Home, Lab, LabError};
use crate::{picture, stats};
use clap::Args;
use std::path::PathBuf;
use std::sync::Arc;

/// Arguments of `render`.
#[derive(Debug, Args)]
pub struct RenderArgs {
    /// Experiment file, for example configs/default.ron.
    experiment: PathBuf,
    /// Another scene: a built-in name, a scene RON, or a model file.
    #[arg(long)]
    scene: Option<String>,
    /// Another camera of the scene, or one written out: "(eye: (0, 1, 5), target: (0, 1, 0), fov_y: 60)".
    #[arg(long)]
    camera: Option<String>,
    /// Picture size.
    #[arg(long, value_name = "WxH")]
    size: Option<String>,
    /// Set a parameter; may be given many times.
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Time of the first frame, s.
    #[arg(long)]
    time: Option<f64>,
    /// Time from frame to frame, s.
    #[arg(long, default_value_t = 0.0)]
    step: f64,
    /// Frames to run and time.
    #[arg(long, default_value_t = 1)]
    frames: usize,
    /// Frames to run before timing starts.
    #[arg(long, default_value_t = 0)]
    warmup: usize,
    /// Write this texture instead of the picture.
    #[arg(long, value_name = "NAME[:MIP[:LAYER]]")]
    resource: Option<String>,
    /// Reorder the scene's triangles by this seed: results must not depend on the order.
    #[arg(long, value_name = "SEED")]
    shuffle: Option<u64>,
    /// Output file, .png or .exr.
    #[arg(short, long)]
    output: PathBuf,
    /// Write timings and settings to this JSON file.
    #[arg(long)]
    json: Option<PathBuf>,
    #[command(flatten)]
    device: DeviceArgs,
}

/// Most frames of one run.
const MAX_FRAMES: usize = 1_000_000;

/// Renders.
pub fn run(args: &RenderArgs) -> Result<(), LabError> {
    let mut experiment = Experiment::read(&args.experiment).map_err(LabError::Input)?;
    adapt(&mut experiment, args)?;
    let exr = writable(&args.output, &["png", "exr"])? == "exr";
    if let Some(json) = &args.json {
        writable(json, &["json"])?;
    }
    let home = Home::find()?;
    let mut scene = super::open_scene(&experiment.scene)?;
    if let Some(seed) = args.shuffle {
        scene = scene.shuffled(seed);
    }
    let lab = Lab::open(home, args.device.options())?;
    let resource = args.resource.as_deref().map(parse_resource).transpose()?;
    let mut shown = (String::new(), 0, 0);
    let (mut session, warnings) = lab.prepare(&experiment, Arc::new(scene), |graph| {
        shown = match resource {
            Some(r) if graph.textures.iter().any(|t| t.0 == r.0) => r,
            Some(r) => return Err(crate::lab::no_texture(graph, &r.0)),
            None => (result_name(graph, exr)?, 0, 0),
        };
        Ok(vec![shown.0.clone()])
    })?;
    for warning in warnings {
        eprintln!("{warning}");
    }
    let mut times = Vec::new();
    let (total, measured) = (args.warmup + args.frames, args.frames);
    let bar = indicatif::ProgressBar::new(total as u64);
    for _ in 0..total {
        times.extend(session.frame(args.step)?);
        bar.inc(1);
    }
    times.extend(session.finish()?);
    bar.finish_and_clear();
    let times = times.split_off(times.len() - measured);
    let failed = session.failed_checks()?;
    for message in &failed {
        eprintln!("warning: {message}");
    }
    let texels = session.texels(&shown.0, shown.1, shown.2)?;
    picture::write(&args.output, &texels)?;
    let stats = stats::collect(&lab.gpu.info, &experiment.name, &session, &times, args.warmup, failed);
    say_part!("{}", stats::table(&stats));
    say!("wrote {}", args.output.display());
    if let Some(path) = &args.json {
        let text = serde_json::to_string_pretty(&stats).map_err(|e| LabError::Request(e.to_string()))?;
        crate::files::write_whole(path, text.as_bytes())
            .map_err(|e| LabError::Request(format!("cannot write '{}': {e}", path.display())))?;
        say!("wrote {}", path.display());
    }
    drop(session);
    match lab.gpu.messages().len() {
        0 => Ok(()),
        n => Err(LabError::Request(format!("the Vulkan validation layer had {n} messages (see above)"))),
    }
}

/// Applies the command line to the experiment.
fn adapt(experiment: &mut Experiment, args: &RenderArgs) -> Result<(), LabError> {
    if let Some(scene) = &args.scene {
        experiment.scene.clone_from(scene);
    }
    if let Some(text) = &args.size {
        experiment.size = parse_size(text)?;
    }
    if let Some(text) = &args.camera {
        experiment.camera = if text.trim_start().starts_with('(') {
            let placed: PlacedCamera = crate::graph::source::options().from_str(text).map_err(|e| {
                LabError::Request(format!(
                    "--camera: {e}; expected (eye: (x, y, z), target: (x, y, z), fov_y: degrees)"
                ))
            })?;
            CameraChoice::Placed(placed)
        } else {
            CameraChoice::Named(text.clone())
        };
    }
    experiment.time = args.time.unwrap_or(experiment.time);
    if !experiment.time.is_finite() || !args.step.is_finite() {
        return Err(LabError::Request("--time and --step must be finite numbers of seconds".into()));
    }
    if args.frames == 0 || args.frames.saturating_add(args.warmup) > MAX_FRAMES {
        return Err(LabError::Request(format!("--frames must be 1 to {MAX_FRAMES}")));
    }
    // Later settings win, and messages about them point at the command line.
    let file = experiment.sources.add("--set".as_ref(), args.set.join("\n"));
    let mut offset = 0;
    for setting in &args.set {
        let Some((name, value)) = setting.split_once('=') else {
            return Err(LabError::Request(format!("--set {setting}: expected NAME=VALUE")));
        };
        experiment.params.push((Loc { value: name.trim().into(), at: At { file, offset } }, value.into()));
        offset += u32::try_from(setting.len() + 1).unwrap_or(0);
    }
    Ok(())
}

pub(super) fn parse_size(text: &str) -> Result<(u32, u32), LabError> {
    let wrong = || LabError::Request(format!("--size {text}: expected WIDTHxHEIGHT, for example 1280x720"));
    let (w, h) = text.split_once('x').ok_or_else(wrong)?;
    let size = (w.trim().parse().map_err(|_| wrong())?, h.trim().parse().map_err(|_| wrong())?);
    check_size(size).map_err(LabError::Request)?;
    Ok(size)
}

fn parse_resource(text: &str) -> Result<(String, u32, u32), LabError> {
    let mut parts = text.split(':');
    let name = parts.next().unwrap_or("").to_string();
    let mut number = |what: &str| match parts.next() {
        None => Ok(0),
        Some(n) => n.parse().map_err(|_| LabError::Request(format!("--resource {text}: '{n}' is no {what}"))),
    };
    Ok((name, number("mip")?, number("layer")?))
}

/// The ending, after checking that the folder can be written to before any work is done.
fn writable(path: &std::path::Path, endings: &[&str]) -> Result<String, LabError> {
    let ending = path.extension().and_then(|e| e.to_str()).map(str::to_lowercase).unwrap_or_default();
    if !endings.contains(&ending.as_str()) {
        let message = format!("'{}': give it a name that ends in .{}", path.display(), endings.join(" or ."));
        return Err(LabError::Request(message));
    }
    let folder = match path.parent() {
        Some(p) if !p.as_os_str().is_empty() => p,
        _ => std::path::Path::new("."),
    };
    if path.is_dir() {
        return Err(LabError::Request(format!("cannot write '{}': it is a folder", path.display())));
    }
    if folder.is_file() {
        return Err(LabError::Request(format!(
            "cannot write '{}': '{}' is no folder",
            path.display(),
            folder.display()
        )));
    }
    let try_folder = || {
        std::fs::create_dir_all(folder)?;
        tempfile::Builder::new().prefix(".conelab-").tempfile_in(folder)
    };
    match try_folder() {
        Ok(_) => Ok(ending),
        Err(e) => Err(LabError::Request(format!("cannot write '{}': {e}", path.display()))),
    }
}

fn result_name(graph: &Graph, exr: bool) -> Result<String, LabError> {
    let (name, field) = if exr { (&graph.hdr, "hdr") } else { (&graph.output, "output") };
    name.clone().ok_or_else(|| {
        LabError::Request(format!("graph '{}' has no `{field}`; name a texture with --resource", graph.name))
    })
}
