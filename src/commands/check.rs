//! `conelab check`.

use crate::campaign::bench::check_record;
use crate::campaign::{stability, sweep};
use crate::diagnostics::{Diagnostic, Severity, Sources};
use crate::experiment::Experiment;
use crate::files::{read_input_text, spec_of};
use crate::graph::file::GraphFile;
use crate::lab::{LabError, Workspace, camera_of, params_of};
use crate::measure::oracle;
use crate::scene::{Scene, SceneError};
use clap::Args;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Arguments of `check`.
#[derive(Debug, Args)]
pub struct CheckArgs {
    /// Files to check; all graphs, experiments and scenes of the program when none is given.
    files: Vec<PathBuf>,
}

/// Kind of a RON file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// A pass graph.
    Graph,
    /// An experiment.
    Experiment,
    /// A scene.
    Scene,
    /// A camera path.
    Path,
    /// A sweep.
    Sweep,
    /// A suite of stability.
    Stability,
    /// Recorded times, JSON.
    Times,
}

/// RON files larger than this are refused, whatever they are.
const MAX_BYTES: u64 = 4 << 20;

/// The kind of a file, by the names of its first fields: experiments name a graph, scenes have
/// models or lights, camera paths have keys, sweeps name experiments, suites of stability name
/// methods. Recorded times end in `.json`.
pub fn kind(path: &Path) -> FileKind {
    if path.extension().is_some_and(|e| e == "json") {
        return FileKind::Times;
    }
    let text = read_input_text(path, MAX_BYTES).unwrap_or_default();
    let has = |field: &str| {
        text.lines().any(|l| {
            l.trim_start()
                .trim_start_matches('(')
                .trim_start()
                .starts_with(&format!("{field}:"))
        })
    };
    if has("graph") {
        FileKind::Experiment
    } else if has("experiments") {
        FileKind::Sweep
    } else if has("methods") {
        FileKind::Stability
    } else if has("models") || has("lights") || has("cameras") {
        FileKind::Scene
    } else if has("keys") {
        FileKind::Path
    } else {
        FileKind::Graph
    }
}

fn files_of(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut list: Vec<PathBuf> = std::fs::read_dir(folder)
        .map(|entries| {
            entries
                .flatten()
                .map(|e| e.path())
                .filter(|p| p.extension().is_some_and(|e| e == ending))
                .collect()
        })
        .unwrap_or_default();
    list.sort();
    list
}

/// The program's own files. What graphs include is checked there, where it has no picture of its
/// own.
fn own_files(home: &Workspace) -> Vec<PathBuf> {
    let graphs = files_of(&home.root.join("passes"), "ron");
    let (mut included, mut whole): (Vec<PathBuf>, Vec<PathBuf>) = (Vec::new(), Vec::new());
    for path in &graphs {
        let mut sources = Sources::default();
        let Ok(file) = sources.read(path) else {
            continue;
        };
        if let Some(graph) = sources.parse::<GraphFile>(file, &mut Vec::new(), &mut Vec::new()) {
            included.extend(
                graph
                    .include
                    .0
                    .iter()
                    .map(|i| home.root.join("passes").join(&i.value)),
            );
            whole.extend(graph.output.map(|_| path.clone()));
        }
    }
    let mut files: Vec<PathBuf> = graphs
        .into_iter()
        .filter(|g| whole.contains(g) || !included.contains(g))
        .collect();
    files.extend(
        [
            "configs",
            "configs/scenes",
            "configs/paths",
            "configs/sweeps",
            "configs/stability",
        ]
        .iter()
        .flat_map(|f| files_of(&home.root.join(f), "ron")),
    );
    files.extend(files_of(&home.root.join("configs/times"), "json"));
    files
}

/// Checks files; every finding is printed.
pub fn run(args: &CheckArgs) -> Result<(), LabError> {
    let home = Workspace::find()?;
    let mut files: Vec<PathBuf> = args.files.iter().map(|file| super::found(file)).collect();
    let all = files.is_empty();
    if all {
        files = own_files(&home);
    }
    let (mut wrong, mut scenes) = (0, BTreeMap::new());
    for file in &files {
        let name = spec_of(file);
        let checked = match kind(file) {
            FileKind::Graph => Ok(check_graph(&home, &name)),
            FileKind::Path => crate::camera_path::CameraPath::read(file)
                .map_err(LabError::Input)
                .map(|_| Vec::new()),
            FileKind::Experiment => check_experiment(&home, file, &mut scenes).map(|()| Vec::new()),
            FileKind::Sweep => sweep::check(&home, file).map(|()| Vec::new()),
            FileKind::Stability => stability::check(&home, file).map(|()| Vec::new()),
            FileKind::Times => check_record(&home, file).map(|()| Vec::new()),
            FileKind::Scene => open(&name).map(|_| Vec::new()).map_err(LabError::Scene),
        };
        let findings = match checked {
            Ok(findings) | Err(LabError::Input(findings)) => findings,
            // Models are not part of the repository. A model that the command line names must
            // exist.
            Err(LabError::Scene(SceneError::NoModel { message, .. })) if all => {
                say!("{}: not checked: {message}", file.display());
                Vec::new()
            }
            Err(e) => {
                wrong += 1;
                say!("{e}");
                Vec::new()
            }
        };
        let errors = findings
            .iter()
            .filter(|f| f.severity == Severity::Error)
            .count();
        wrong += errors;
        for finding in &findings {
            say!("{finding}");
        }
    }
    say!("checked {} files, {wrong} errors", files.len());
    if wrong > 0 {
        Err(LabError::Request(format!("{wrong} errors")))
    } else {
        Ok(())
    }
}

fn check_graph(home: &Workspace, name: &str) -> Vec<Diagnostic> {
    let mut findings = home.check(name);
    findings.extend(
        home.read(name)
            .ok()
            .and_then(|graph| oracle::mistake(&graph)),
    );
    findings
}

/// Checks an experiment without a device. `scenes` caches the opened scenes.
fn check_experiment(
    home: &Workspace,
    file: &Path,
    scenes: &mut BTreeMap<String, Arc<Scene>>,
) -> Result<(), LabError> {
    let experiment = Experiment::read(file).map_err(LabError::Input)?;
    let graph = home.load_of(&experiment).map_err(LabError::Input)?.graph;
    params_of(&graph, &experiment)?;
    let scene = match scenes.get(&experiment.scene) {
        Some(scene) => scene.clone(),
        None => Arc::new(
            open(&experiment.scene).map_err(|error| LabError::of_scene(&experiment, error))?,
        ),
    };
    scenes.insert(experiment.scene.clone(), scene.clone());
    camera_of(&experiment, &*experiment.adapted(scene)?)?;
    Ok(())
}

fn open(name: &str) -> Result<Scene, SceneError> {
    Scene::open(&super::scene_file(name), &|_, _| ControlFlow::Continue(()))
}
