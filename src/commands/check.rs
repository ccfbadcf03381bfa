//! `conelab check`.

use crate::campaign::bench::check_record;
use crate::campaign::{stability, sweep};
use crate::diagnostics::{Diagnostic, Severity, Sources};
use crate::experiment::Experiment;
use crate::files::read_input_text;
use crate::graph::file::GraphFile;
use crate::lab::{LabError, Workspace, params_of};
use crate::measure::oracle;
use crate::scene::SceneError;
use clap::Args;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Arguments of `check`.
#[derive(Debug, Args)]
pub struct CheckArgs {
    /// Files to check; all graphs, experiments and scenes of the program when none is given.
    files: Vec<PathBuf>,
}

/// What a RON file is.
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

/// What a file is, by the names of its first fields: experiments name a graph, scenes hold models or lights,
/// camera paths hold keys, sweeps name experiments, suites of stability name methods. Recorded times end in `.json`.
pub fn kind(path: &str) -> FileKind {
    if path.ends_with(".json") {
        return FileKind::Times;
    }
    let text = read_input_text(path.as_ref(), MAX_BYTES).unwrap_or_default();
    let has = |field: &str| {
        text.lines().any(|l| l.trim_start().trim_start_matches('(').trim_start().starts_with(&format!("{field}:")))
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
            entries.flatten().map(|e| e.path()).filter(|p| p.extension().is_some_and(|e| e == ending)).collect()
        })
        .unwrap_or_default();
    list.sort();
    list
}

/// The program's own files. What graphs include is checked there, where it has no picture of its own.
fn own_files(home: &Workspace) -> Vec<PathBuf> {
    let graphs = files_of(&home.root.join("passes"), "ron");
    let (mut included, mut whole): (Vec<PathBuf>, Vec<PathBuf>) = (Vec::new(), Vec::new());
    for path in &graphs {
        let mut sources = Sources::default();
        let Ok(file) = sources.read(path) else { continue };
        if let Some(graph) = sources.parse::<GraphFile>(file, &mut Vec::new(), &mut Vec::new()) {
            included.extend(graph.include.0.iter().map(|i| home.root.join("passes").join(&i.value)));
            whole.extend(graph.output.map(|_| path.clone()));
        }
    }
    let mut files: Vec<PathBuf> = graphs.into_iter().filter(|g| whole.contains(g) || !included.contains(g)).collect();
    files.extend(
        ["configs", "configs/scenes", "configs/paths", "configs/sweeps", "configs/stability"]
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
    let mut wrong = 0;
    for file in &files {
        let name = file.to_string_lossy();
        let findings = match kind(&name) {
            FileKind::Graph => check_graph(&home, &name),
            FileKind::Path => crate::camera_path::CameraPath::read(file).err().unwrap_or_default(),
            FileKind::Experiment => check_experiment(&home, file),
            campaign @ (FileKind::Sweep | FileKind::Stability | FileKind::Times) => {
                let checked = match campaign {
                    FileKind::Sweep => sweep::check(&home, file),
                    FileKind::Stability => stability::check(&home, file),
                    _ => check_record(&home, file),
                };
                match checked {
                    Err(LabError::Input(errors)) => errors,
                    Err(e) => {
                        wrong += 1;
                        say!("{e}");
                        Vec::new()
                    }
                    Ok(()) => Vec::new(),
                }
            }
            FileKind::Scene => {
                match crate::scene::Scene::open(&name, &|_, _| ControlFlow::Continue(())) {
                    // Models are no part of the program; asked for by name, they must be there.
                    Err(SceneError::NoModel { message, .. }) if all => {
                        say!("{name}: not checked: {message}");
                    }
                    Err(e) => {
                        wrong += 1;
                        say!("{e}");
                    }
                    Ok(_) => {}
                }
                Vec::new()
            }
        };
        let errors = findings.iter().filter(|f| f.severity == Severity::Error).count();
        wrong += errors;
        for finding in &findings {
            say!("{finding}");
        }
    }
    say!("checked {} files, {wrong} errors", files.len());
    if wrong > 0 { Err(LabError::Request(format!("{wrong} errors"))) } else { Ok(()) }
}

fn check_graph(home: &Workspace, name: &str) -> Vec<Diagnostic> {
    let mut findings = home.check(name);
    findings.extend(home.read(name).ok().and_then(|graph| oracle::mistake(&graph)));
    findings
}

fn check_experiment(home: &Workspace, file: &Path) -> Vec<Diagnostic> {
    let experiment = match Experiment::read(file) {
        Ok(e) => e,
        Err(errors) => return errors,
    };
    let graph = match home.load(&experiment.graph) {
        Ok(loaded) => loaded.graph,
        Err(errors) => return errors,
    };
    match params_of(&graph, &experiment) {
        Err(LabError::Input(errors)) => errors,
        _ => Vec::new(),
    }
}
