//! `conelab voxels`.

use super::adapt::{self, ExperimentArgs};
use super::{DeviceArgs, writable};
use crate::experiment::{CameraChoice, Experiment};
use crate::lab::{Lab, LabError, Loaded, Workspace, camera_of};
use crate::measure::oracle::{self, Cell, Comparison, Grid, Score, Surfaces, Triangle};
use crate::results::picture;
use crate::scene::Scene;
use clap::Args;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::sync::Arc;

mod table;

/// Arguments of `voxels`.
#[derive(Debug, Args)]
pub struct VoxelsArgs {
    #[command(flatten)]
    experiment: ExperimentArgs,
    /// Compare all voxelizers that the graph declares, not only the experiment's own.
    #[arg(long)]
    all: bool,
    /// Write the numbers to this JSON file.
    #[arg(long)]
    json: Option<PathBuf>,
    /// Write cubes to this folder: a picture and a model (.glb) for each mode. Missing voxels are
    /// red, extra ones blue, correct ones grey.
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    #[command(flatten)]
    device: DeviceArgs,
}

/// Version of what `--json` writes.
const SCHEMA: &str = "conelab-voxels-1";

/// A way of making voxels, and what came of it: figures, or why there are none.
#[derive(Default, Serialize)]
struct Mode {
    title: String,
    /// Parameters that differ from the experiment's.
    set: Settings,
    score: Option<Score>,
    skipped: Option<String>,
    /// Failed checks of the graph, such as full queues.
    warnings: Vec<String>,
}

/// What `--json` writes.
#[derive(Serialize)]
struct Report {
    schema: &'static str,
    version: &'static str,
    experiment: String,
    scene: String,
    device: String,
    triangles: usize,
    /// Cells along x, y and z.
    size: [u32; 3],
    modes: Vec<Mode>,
}

/// The exact cells of a grid; made once for the modes that share it.
struct Exact {
    grid: Grid,
    cells: Vec<Cell>,
}

/// Compares voxels with the exact ones.
pub fn run(args: &VoxelsArgs) -> Result<(), LabError> {
    let experiment = args.experiment.read()?;
    if let Some(json) = &args.json {
        writable(json, &["json"])?;
    }
    let home = Workspace::find()?;
    let loaded = home.load_of(&experiment).map_err(LabError::Input)?;
    let wanted = oracle::wanted(&loaded.graph)?;
    let scene = Arc::new(adapt::open_scene(&experiment)?);
    let triangles = oracle::triangles_of(&scene, experiment.time);
    let surfaces = Surfaces::new(&scene);
    let lab = Lab::open(home, args.device.options())?;
    let mut last = None;
    let mut modes = Vec::new();
    for (title, set) in modes_of(&loaded, args.all)? {
        let mut changed = experiment.clone();
        for (name, value) in &set {
            changed.set(name, value);
        }
        let mut mode = Mode {
            title,
            set,
            ..Mode::default()
        };
        match voxels_of(&lab, &changed, &loaded, &scene, &wanted) {
            Ok((grid, voxels, warnings)) => {
                let exact = exact_of(&mut last, grid, &triangles, &surfaces);
                let found = oracle::compare(&exact.grid, &exact.cells, &voxels);
                if let Some(folder) = &args.output {
                    let stem = file_stem(folder, &mode.title);
                    draw(&lab, &experiment, &scene, &exact.grid, &found, &stem)?;
                }
                mode.warnings = warnings;
                mode.score = Some(found.score);
            }
            // One of many that this device cannot run is reported; the only one is an error.
            Err(LabError::Input(why)) if args.all => {
                let why: Vec<&str> = why.iter().map(|d| d.message.as_str()).collect();
                mode.skipped = Some(why.join("; "));
            }
            Err(error) => return Err(error),
        }
        modes.push(mode);
    }
    let report = Report {
        schema: SCHEMA,
        version: env!("CARGO_PKG_VERSION"),
        experiment: experiment.name.clone(),
        scene: scene.name.clone(),
        device: lab.gpu.info.name.clone(),
        triangles: triangles.len(),
        size: last.as_ref().map_or([0; 3], |t| t.grid.size()),
        modes,
    };
    table::print(&report);
    if let Some(path) = &args.json {
        super::write_json(path, &report)?;
    }
    super::validated(&lab)
}

/// Parameters and values in RON.
type Settings = Vec<(String, String)>;

/// Titles and settings: the experiment's own, or those that the graph declares.
fn modes_of(loaded: &Loaded, all: bool) -> Result<Vec<(String, Settings)>, LabError> {
    if !all {
        return Ok(vec![("as set".into(), Vec::new())]);
    }
    let modes = oracle::modes(&loaded.graph).map(|m| {
        let set = m
            .set
            .0
            .iter()
            .map(|(name, value)| (name.value.clone(), value.value.0.clone()));
        (m.title.clone(), set.collect())
    });
    let modes: Vec<_> = modes.collect();
    if modes.is_empty() {
        return Err(LabError::Request(format!(
            "graph '{}' tells the tool `voxels` no settings: leave out --all",
            loaded.graph.name
        )));
    }
    Ok(modes)
}

/// The voxels of one frame, their grid, and failed checks of the graph.
fn voxels_of(
    lab: &Lab,
    experiment: &Experiment,
    loaded: &Loaded,
    scene: &Arc<Scene>,
    wanted: &[String],
) -> Result<(Grid, Vec<oracle::Voxel>, Vec<String>), LabError> {
    let mut session = lab.build(experiment, loaded, scene.clone(), wanted.to_vec(), None)?;
    session.run(1)?;
    let warnings = session.failed_checks()?;
    let (grid, voxels) = oracle::read(&mut session)?;
    Ok((grid, voxels, warnings))
}

fn exact_of<'t>(
    last: &'t mut Option<Exact>,
    grid: Grid,
    triangles: &[Triangle],
    surfaces: &Surfaces<'_>,
) -> &'t Exact {
    let kept = last.take().filter(|t| t.grid == grid);
    last.insert(kept.unwrap_or_else(|| Exact {
        cells: oracle::exact(triangles, surfaces, &grid),
        grid,
    }))
}

fn file_stem(folder: &Path, title: &str) -> PathBuf {
    folder.join(title.replace(|c: char| !c.is_ascii_alphanumeric(), "-"))
}

/// Writes the cubes as a model, and their picture from the experiment's camera.
fn draw(
    lab: &Lab,
    experiment: &Experiment,
    scene: &Scene,
    grid: &Grid,
    found: &Comparison,
    stem: &Path,
) -> Result<(), LabError> {
    if found.right.is_empty() && found.holes.is_empty() && found.extras.is_empty() {
        say!("nothing to draw: no cell holds anything");
        return Ok(());
    }
    let cubes = oracle::cubes(grid, found, scene).map_err(LabError::Request)?;
    let (png, glb) = (stem.with_extension("png"), stem.with_extension("glb"));
    for path in [&png, &glb] {
        writable(path, &["png", "glb"])?;
    }
    cubes.export(&glb)?;
    let mut view = experiment.clone();
    view.camera = CameraChoice::Placed(camera_of(experiment, scene)?);
    view.graph = "preview.ron".into();
    view.params.clear();
    let mut output = String::new();
    let (mut session, _) = lab.prepare(&view, Arc::new(cubes), |graph| {
        output = graph
            .output
            .clone()
            .ok_or_else(|| LabError::Request("graph 'preview' has no `output`".into()))?;
        Ok(vec![output.clone()])
    })?;
    session.run(1)?;
    picture::write(&png, &session.texels(&output, 0, 0)?)?;
    say!("wrote {} and {}", png.display(), glb.display());
    Ok(())
}
