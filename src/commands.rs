//! The command line.

/// Like `eprintln!`, without the control characters that a file's names may hold.
macro_rules! warn {
    ($($text:tt)*) => { eprintln!("{}", $crate::diagnostics::excerpt::harmless(&format!($($text)*))) };
}

/// Like `println!`, without the control characters that a file's names may hold;
/// [`output::written`] tells whether it could be printed.
macro_rules! say {
    ($($text:tt)*) => { $crate::commands::output::put(format_args!("{}\n", format_args!($($text)*))) };
}

/// Like `print!`, in the same way.
macro_rules! say_part {
    ($($text:tt)*) => { $crate::commands::output::put(format_args!($($text)*)) };
}

mod ablate;
mod adapt;
mod bench;
mod campaign_bar;
mod capture;
mod check;
mod compare;
mod fit;
mod graph;
mod output;
mod reference;
mod render;
mod replay;
mod report;
mod save;
mod screenshot;
mod stability;
mod sweep;
mod view;
mod voxels;

use crate::diagnostics::excerpt::excerpt;
use crate::files::{FileError, path_of, spec_of};
use crate::lab::{Lab, LabError, Workspace, fastest, recalled};
use crate::metrics::Metric;
use crate::vulkan::{GpuOptions, list_devices};
use clap::builder::{OsStringValueParser, PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, CommandFactory, Parser, Subcommand};
use output::{is_json_output, write_json, written};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Reads a metric by its key.
fn metric_of(
    list: impl Iterator<Item = &'static Metric>,
) -> impl TypedValueParser<Value = &'static Metric> {
    let keys = list.map(|m| PossibleValue::new(m.key).help(m.help));
    PossibleValuesParser::new(keys).try_map(|key| Metric::of(&key).ok_or("no such metric"))
}

/// A research workbench for voxel cone tracing.
#[derive(Debug, Parser)]
#[command(name = "conelab", version, about)]
pub struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Open the workbench in a window (the same as no command at all).
    View(view::ViewArgs),
    /// Render the workbench to a picture, without a window.
    Screenshot(screenshot::ScreenshotArgs),
    /// Render an experiment to a picture, and its timings to JSON.
    Render(render::RenderArgs),
    /// Render an experiment and save pictures, sources, settings and measurements to captures/NAME.
    Capture(capture::CaptureArgs),
    /// Render a capture again from its own sources and compare every texel; exit 1 on any
    /// difference.
    Replay(replay::ReplayArgs),
    /// Time configurations round by round and print tables of their stages and totals, or compare
    /// with recorded times. Exit 1 if one failed or became slower.
    Bench(bench::BenchArgs),
    /// Measure every combination of a sweep file. Resumable. Exit 1 if points failed.
    Sweep(sweep::SweepArgs),
    /// Measure temporal stability against the reference while camera, objects or lights move. Resumable. Exit 1 if a case failed.
    Stability(stability::StabilityArgs),
    /// Write a page with charts and a table of sweeps: error against time.
    Report(report::ReportArgs),
    /// Compare pictures or experiments with a reference: table, JSON, maps of the error.
    Compare(compare::CompareArgs),
    /// Save an experiment under a new name, with only the differences from the graph's defaults.
    Save(save::SaveArgs),
    /// Path-trace a reference for an experiment, into captures/reference.
    Reference(reference::ReferenceArgs),
    /// Find the cheapest setting of an experiment that stays within an error, or the best within a
    /// time.
    Fit(fit::FitArgs),
    /// Print the error that voxels, cones and filtering each add to an experiment.
    #[command(alias = "split")]
    Ablate(ablate::AblateArgs),
    /// Compare an experiment's voxels with the exact overlap of its triangles.
    Voxels(voxels::VoxelsArgs),
    /// Print the passes of a graph that run, with their shader files and results.
    Graph(graph::GraphArgs),
    /// Print a scene's counts, bounds, materials and missing files, or write it to another format.
    Scene(SceneArgs),
    /// Check graphs, shaders, experiments and scenes without a window; exit 1 on any error.
    Check(check::CheckArgs),
    /// List the Vulkan devices, and what `auto` stands for on each.
    Devices(DevicesArgs),
    /// Print the completion script of a shell.
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
}

/// Reads a name or a path of any bytes.
fn spec() -> impl TypedValueParser<Value = String> {
    OsStringValueParser::new().map(|path| spec_of(path.as_ref()))
}

/// Which device.
#[derive(Debug, Args)]
struct DeviceArgs {
    /// Part of a device's name, or its number in `conelab devices`.
    #[arg(long, env = "CONELAB_DEVICE")]
    device: Option<String>,
    /// Optional features that are not used even if the device has them: geometry, int64_atomics and others
    /// (repeatable, or separated by commas). An unknown name lists all.
    #[arg(
        long,
        env = "CONELAB_WITHOUT",
        value_name = "FEATURE",
        value_delimiter = ','
    )]
    without: Vec<String>,
    /// Memory that a graph may use, GiB; the device's when absent. Graphs that need more are refused.
    #[arg(long, env = "CONELAB_MEMORY", value_name = "GIB", value_parser = gibibytes)]
    memory: Option<u64>,
    /// Enable the Vulkan validation layer; any message is an error.
    #[arg(long, env = "CONELAB_VALIDATION")]
    validate: bool,
    /// Seconds that a frame may take before the device counts as hung (ten times as long on a
    /// software device); default: 20 in the window, no limit otherwise.
    #[arg(long, env = "CONELAB_HANG_AFTER", value_name = "SECONDS", value_parser = seconds)]
    hang_after: Option<Duration>,
}

/// Bytes from GiB.
fn gibibytes(text: &str) -> Result<u64, String> {
    let gib = text.parse().ok().filter(|g: &f64| *g > 0.0 && *g < 1e6);
    gib.map(|g| (g * (1u64 << 30) as f64) as u64)
        .ok_or_else(|| "must be a number of GiB above 0".into())
}

/// A span of time from seconds, at least a millisecond.
fn seconds(text: &str) -> Result<Duration, String> {
    let span = text
        .parse()
        .ok()
        .and_then(|s: f64| Duration::try_from_secs_f64(s).ok());
    span.filter(|s| s.as_millis() > 0)
        .ok_or_else(|| "must be a number of seconds above 0".into())
}

impl DeviceArgs {
    fn options(&self) -> GpuOptions {
        GpuOptions {
            device: self.device.clone(),
            validation: self.validate,
            without: self.without.clone(),
            memory: self.memory,
            patience: self.hang_after,
            ..GpuOptions::default()
        }
    }
}

#[derive(Debug, Args)]
struct SceneArgs {
    #[arg(value_parser = spec(), help = format!("A built-in scene's name, or a {} file", crate::scene::extensions()))]
    scene: String,
    /// Write the scene to this file (.obj, .gltf or .glb) instead of describing it.
    #[arg(long)]
    export: Option<PathBuf>,
    /// Write the description as JSON to this file; `-` is standard output.
    #[arg(long)]
    json: Option<PathBuf>,
}

/// Runs a command; the error is for the user.
pub fn run(cli: Cli) -> Result<(), LabError> {
    run_command(cli).and_then(|()| written())
}

/// The message of an error. Diagnostics print as they are; other errors get an "error:" prefix.
pub fn told(error: &LabError) -> String {
    match error {
        LabError::Input(_) => error.to_string(),
        other => format!("error: {}", excerpt(&other.to_string(), MAX_MESSAGE)),
    }
}

/// Characters of a message that may quote a file.
const MAX_MESSAGE: usize = 4000;

fn run_command(cli: Cli) -> Result<(), LabError> {
    let Some(command) = cli.command else {
        return view::run(&view::ViewArgs::parse_from(["view"]));
    };
    match command {
        Command::View(args) => view::run(&args),
        Command::Screenshot(args) => screenshot::run(&args),
        Command::Render(args) => render::run(&args),
        Command::Capture(args) => capture::run(&args),
        Command::Replay(args) => replay::run(&args),
        Command::Sweep(args) => sweep::run(&args),
        Command::Stability(args) => stability::run(&args),
        Command::Bench(args) => bench::run(&args),
        Command::Report(args) => report::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Save(args) => save::run(&args),
        Command::Reference(args) => reference::run(&args),
        Command::Fit(args) => fit::run(&args),
        Command::Ablate(args) => ablate::run(&args),
        Command::Voxels(args) => voxels::run(&args),
        Command::Graph(args) => graph::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Scene(args) => scene(&args),
        Command::Devices(args) => devices(&args),
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "conelab", &mut script);
            say_part!("{}", String::from_utf8_lossy(&script));
            Ok(())
        }
    }
}

/// Opens a scene with a progress bar.
fn open_scene(name: &str) -> Result<crate::scene::Scene, LabError> {
    let bar = indicatif::ProgressBar::new(1000).with_style(
        indicatif::ProgressStyle::with_template("{msg:40} {bar:30} {percent}%")
            .unwrap_or_else(|_| indicatif::ProgressStyle::default_bar()),
    );
    let scene = crate::scene::Scene::open(&scene_file(name), &|what, part| {
        bar.set_message(excerpt(what, 40));
        bar.set_position((part.clamp(0.0, 1.0) * 1000.0) as u64);
        std::ops::ControlFlow::Continue(())
    });
    bar.finish_and_clear();
    let scene = scene?;
    for warning in &scene.warnings {
        warn!("warning: {warning}");
    }
    Ok(scene)
}

/// A scene as the command line or an experiment names it: a built-in's name, or a file here or in
/// the program's folder.
fn scene_file(name: &str) -> String {
    if name.contains('.') {
        spec_of(&found(&path_of(name)))
    } else {
        name.into()
    }
}

/// A path as short as it can be said here.
fn shown(path: &std::path::Path) -> PathBuf {
    let here = std::env::current_dir().ok();
    here.and_then(|h| path.strip_prefix(h).ok())
        .unwrap_or(path)
        .to_path_buf()
}

/// A file that the command line names: as it is, or in the program's folder where it is not here.
fn found(path: &Path) -> PathBuf {
    if path.is_absolute() || path.exists() {
        return path.to_path_buf();
    }
    let at_home = Workspace::find()
        .ok()
        .map(|home| home.root.join(path))
        .filter(|p| p.exists());
    at_home.unwrap_or_else(|| path.to_path_buf())
}

/// The experiment that a window opens: the named one, or the one that comes first.
fn opened(path: Option<&Path>, home: &Workspace) -> PathBuf {
    path.map_or_else(|| home.root.join("configs/cones.ron"), found)
}

/// The ending, after checking that the folder can be written to before any work is done.
fn writable(path: &Path, endings: &[&str]) -> Result<String, LabError> {
    if endings == ["json"] && is_json_output(path) {
        return Ok("json".into());
    }
    let ending = crate::files::ending(path);
    if !endings.contains(&ending.as_str()) {
        let why = format!("give it a name that ends in .{}", endings.join(" or ."));
        return Err(FileError::content(path, why).into());
    }
    let folder = match path.parent() {
        Some(p) if !p.as_os_str().is_empty() => p,
        _ => Path::new("."),
    };
    if path.is_dir() {
        return Err(FileError::write(path, "it is a folder").into());
    }
    if folder.is_file() {
        return Err(FileError::write(path, format!("'{}' is no folder", folder.display())).into());
    }
    let try_folder = || {
        std::fs::create_dir_all(folder)?;
        tempfile::Builder::new()
            .prefix(".conelab-")
            .tempfile_in(folder)
    };
    match try_folder() {
        Ok(_) => Ok(ending),
        Err(why) => Err(FileError::Write {
            path: path.into(),
            why,
        }
        .into()),
    }
}

/// Every message of the validation layer is an error.
fn validated(lab: &Lab) -> Result<(), LabError> {
    LabError::of_messages(lab.gpu.messages().len())
}

fn scene(args: &SceneArgs) -> Result<(), LabError> {
    let scene = open_scene(&args.scene)?;
    match &args.export {
        Some(path) => {
            for warning in scene.export(path)? {
                warn!("warning: {warning}");
            }
            say!("wrote {}", path.display());
        }
        None if args.json.is_none() => say_part!("{}", scene.summary()),
        None => {}
    }
    if let Some(path) = &args.json {
        output::write_json(path, &scene.description())?;
    }
    Ok(())
}

/// Arguments of `conelab devices`.
#[derive(Debug, Args)]
struct DevicesArgs {
    /// Measure again which options `auto` stands for: with this graph in the scene atrium at 1920x1080.
    #[arg(long, value_name = "GRAPH", num_args = 0..=1, default_missing_value = "rays.ron")]
    measure: Option<String>,
    #[command(flatten)]
    device: DeviceArgs,
}

fn devices(args: &DevicesArgs) -> Result<(), LabError> {
    if let Some(graph) = &args.measure {
        let lab = Lab::open(Workspace::find()?, args.device.options())?;
        lab.measure(graph)?;
    }
    for (number, (info, refused)) in list_devices()?.iter().enumerate() {
        say!(
            "{number}: {} ({}, {}), Vulkan {}",
            info.name,
            info.kind,
            info.driver,
            info.api
        );
        match refused {
            Some(why) => say!("   cannot be used: {why}"),
            None => {
                let f = &info.features;
                let list = [
                    ("geometry shaders", f.geometry),
                    ("tessellation", f.tessellation),
                    ("stores in fragment shaders", f.fragment_stores),
                    ("stores in vertex stages", f.vertex_stores),
                    ("conservative rasterisation", f.conservative_rasterization),
                    ("64-bit atomics", f.int64_atomics),
                    ("BC textures", f.bc),
                    ("timestamps", info.timestamp_ns > 0.0),
                    ("calibrated timestamps", info.calibrates()),
                    ("pipeline statistics", f.pipeline_statistics),
                ];
                for (name, has) in list {
                    say!("   {} {name}", if has { "yes" } else { "no " });
                }
                say!(
                    "   {:.1} GiB of device memory",
                    info.heap as f64 / (1u64 << 30) as f64
                );
                for (choice, times) in recalled(info, Workspace::cache().as_deref()) {
                    let list: Vec<String> = times
                        .iter()
                        .map(|(o, ms)| format!("{o} {ms:.3} ms"))
                        .collect();
                    if let Some(option) = fastest(&times) {
                        say!("   {choice} auto: {option} ({})", list.join(", "));
                    }
                }
            }
        }
    }
    Ok(())
}
