//! The program's folders, and graphs read from them.

use super::interface::load;
use super::{LabError, environment, params_of};
use crate::diagnostics::{Diagnostic, Place};
use crate::experiment::Experiment;
use crate::files::path_of;
use crate::graph::link::{Linked, link};
use crate::graph::link::{Runs, runs};
use crate::graph::load::Folders;
use crate::graph::param::{Params, Value};
use crate::graph::{Evaluated, Graph};
use crate::scene::Scene;
use crate::shader::ShaderCompiler;
use crate::vulkan::DeviceInfo;
use rayon::prelude::{IntoParallelRefIterator, ParallelExtend, ParallelIterator};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// A graph with its shaders compiled and checked: all, or those of the passes that run.
#[derive(Clone)]
pub struct Loaded {
    /// The graph.
    pub graph: Arc<Graph>,
    /// The shaders of its passes.
    pub linked: Arc<Vec<Linked>>,
    /// Warnings.
    pub warnings: Vec<Diagnostic>,
}

/// The last graph of each root and path, in this program: an edit of a shader reads none again.
static LAST: Mutex<BTreeMap<(PathBuf, PathBuf), Arc<Graph>>> = Mutex::new(BTreeMap::new());

/// Where the program's own folders are.
#[derive(Clone, Debug)]
pub struct Workspace {
    /// The folder with `passes`, `shaders` and `configs`.
    pub root: PathBuf,
    /// Folder of references, and of whatever else is made: `captures` in the root.
    pub captures: PathBuf,
    /// Folder for compiled shaders and pipelines.
    pub cache: Option<PathBuf>,
}

impl Workspace {
    /// Finds the folders: `CONELAB_HOME`, else upwards from the working folder, else next to the
    /// program, else `share/conelab` of the prefix that the program is installed in, else the
    /// sources that it was built from, as after `cargo install --path .`.
    ///
    /// # Errors
    /// None of them has the folders.
    pub fn find() -> Result<Workspace, LabError> {
        let program = std::env::current_exe().ok();
        let shared = program.and_then(|p| Some(p.parent()?.parent()?.join("share/conelab")));
        let built_from = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
        Workspace::find_or(shared.filter(|p| has_sources(p)).or(Some(built_from)))
    }

    /// [`Workspace::find`], and `last` if nothing else has the folders. Captures are in
    /// `CONELAB_CAPTURES`, else in the root, or in the working folder if the root is `last`: that
    /// may be a folder of the system.
    ///
    /// # Errors
    /// None of them has the folders.
    pub fn find_or(last: Option<PathBuf>) -> Result<Workspace, LabError> {
        let named = std::env::var_os("CONELAB_HOME").map(PathBuf::from);
        let working = std::env::current_dir().ok();
        let program = std::env::current_exe().ok();
        let upwards = working
            .iter()
            .flat_map(|p| p.ancestors())
            .chain(program.iter().flat_map(|p| p.ancestors()));
        let root = match &named {
            Some(path) if has_sources(path) => Some(path.clone()),
            Some(path) => {
                let message = format!(
                    "CONELAB_HOME is '{}', which has no passes and shaders folders",
                    path.display()
                );
                return Err(LabError::Request(message));
            }
            None => upwards
                .into_iter()
                .find(|p| has_sources(p))
                .map(Path::to_path_buf),
        };
        let last = last.filter(|p| has_sources(p));
        let installed = root.is_none();
        let Some(root) = root.or(last) else {
            return Err(LabError::Request(
                "cannot find the folders passes and shaders: run it in conelab's folder, or set CONELAB_HOME".into(),
            ));
        };
        let captures = std::env::var_os("CONELAB_CAPTURES").map(PathBuf::from);
        let captures = captures.or_else(|| installed.then(|| "captures".into()));
        let mut found = Workspace::at(root)?;
        if let Some(folder) = captures {
            found.captures = std::path::absolute(&folder).unwrap_or(folder);
        }
        Ok(found)
    }

    /// Folders that are known.
    pub fn with(root: PathBuf, cache: Option<PathBuf>) -> Workspace {
        Workspace {
            captures: root.join("captures"),
            root,
            cache,
        }
    }

    /// The folders in `root`.
    ///
    /// # Errors
    /// It has no `passes` or no `shaders`.
    pub fn at(root: PathBuf) -> Result<Workspace, LabError> {
        if !has_sources(&root) {
            let message = format!("'{}' has no passes and shaders folders", root.display());
            return Err(LabError::Request(message));
        }
        Ok(Workspace::with(root, Workspace::cache()))
    }

    /// The folder for compiled shaders and pipelines.
    pub fn cache() -> Option<PathBuf> {
        std::env::var_os("CONELAB_CACHE")
            .map(PathBuf::from)
            .or_else(|| {
                std::env::var_os("XDG_CACHE_HOME").map(|p| PathBuf::from(p).join("conelab"))
            })
            .or_else(|| std::env::var_os("HOME").map(|p| PathBuf::from(p).join(".cache/conelab")))
    }

    /// Folders of graphs and shaders.
    pub fn folders(&self) -> Folders {
        Folders {
            passes: self.root.join("passes"),
            shaders: self.root.join("shaders"),
        }
    }

    /// The file of a graph: a bare name is looked up among the graphs, a path from here, then from
    /// the program's folder.
    pub fn graph_path(&self, name: &str) -> PathBuf {
        let given = path_of(name);
        if given.is_file() {
            return given;
        }
        let bare = given.components().count() == 1;
        let at_home = if bare {
            self.root.join("passes").join(&given)
        } else {
            self.root.join(&given)
        };
        if bare || at_home.is_file() {
            at_home
        } else {
            given
        }
    }

    /// Everything that is wrong with a graph and its shaders, or worth knowing, whichever option
    /// its modules are set to; needs no device.
    pub fn check(&self, name: &str) -> Vec<Diagnostic> {
        let graph = match self.read(name) {
            Ok(graph) => graph,
            Err(errors) => return errors,
        };
        let mut findings: Vec<Diagnostic> = Vec::new();
        let mut settings = vec![graph.params.clone()];
        for param in graph.params.offered().filter(|p| p.is_module()) {
            for option in param
                .kind
                .options()
                .iter()
                .filter(|o| Value::Choice((*o).clone()) != param.default)
            {
                let mut params = graph.params.clone();
                findings.extend(
                    params
                        .set(&param.name, option)
                        .err()
                        .map(|e| Diagnostic::error(Place::default(), e)),
                );
                settings.push(params);
            }
        }
        let found = |params: &Params| match self.link(&graph, &Runs::all(&graph, params)) {
            Ok((_, warnings)) => warnings,
            Err(errors) => errors,
        };
        // The first setting fills the cache: the others differ in a few shaders each.
        let (first, others) = settings.split_at(1);
        let mut all: Vec<Vec<Diagnostic>> = first.iter().map(found).collect();
        all.par_extend(others.par_iter().map(found));
        for finding in all.into_iter().flatten() {
            if !findings.contains(&finding) {
                findings.push(finding);
            }
        }
        findings
    }

    /// All shaders of a graph, of the files that these parameters choose.
    ///
    /// # Errors
    /// All mistakes in them.
    pub fn linked(&self, graph: &Graph, params: &Params) -> Result<Vec<Linked>, Vec<Diagnostic>> {
        Ok(self.link(graph, &Runs::all(graph, params))?.0)
    }

    /// A graph with all of its shaders compiled and checked, and warnings; needs no device.
    ///
    /// # Errors
    /// All mistakes.
    pub fn load(&self, name: &str) -> Result<Loaded, Vec<Diagnostic>> {
        let graph = self.read(name)?;
        let (linked, warnings) = self.link(&graph, &Runs::all(&graph, &graph.params))?;
        Ok(Loaded {
            graph,
            linked: Arc::new(linked),
            warnings,
        })
    }

    /// [`Workspace::load`] of an experiment's graph.
    ///
    /// # Errors
    /// As [`Workspace::load`]; a missing graph is an error at the experiment's line.
    pub fn load_of(&self, experiment: &Experiment) -> Result<Loaded, Vec<Diagnostic>> {
        self.read_of(experiment)?;
        self.load(&experiment.graph)
    }

    /// [`Workspace::load`] with only the shaders of passes that an experiment runs in a scene.
    /// Other shaders cost no time and their mistakes do not prevent a picture.
    /// [`Workspace::complete`] compiles the rest.
    ///
    /// # Errors
    /// All mistakes in the graph and in these shaders.
    pub fn load_for(
        &self,
        experiment: &Experiment,
        scene: &Scene,
        device: &DeviceInfo,
    ) -> Result<Loaded, Vec<Diagnostic>> {
        let graph = self.read_of(experiment)?;
        let (linked, warnings) = self.link(&graph, &runs_of(&graph, experiment, scene, device))?;
        Ok(Loaded {
            graph,
            linked: Arc::new(linked),
            warnings,
        })
    }

    /// A graph with the shaders that an experiment runs; as it is, if it has them.
    ///
    /// # Errors
    /// All mistakes in these shaders.
    pub fn complete(
        &self,
        loaded: &Loaded,
        experiment: &Experiment,
        scene: &Scene,
        device: &DeviceInfo,
    ) -> Result<Loaded, Vec<Diagnostic>> {
        self.with_shaders(loaded, &runs_of(&loaded.graph, experiment, scene, device))
    }

    /// A graph with the shaders of all passes that run; as it is, if it has them.
    pub(super) fn with_shaders(
        &self,
        loaded: &Loaded,
        runs: &Runs,
    ) -> Result<Loaded, Vec<Diagnostic>> {
        if runs.are_linked(&loaded.graph, &loaded.linked) {
            return Ok(loaded.clone());
        }
        let (linked, warnings) = self.link(&loaded.graph, runs)?;
        Ok(Loaded {
            graph: loaded.graph.clone(),
            linked: Arc::new(linked),
            warnings,
        })
    }

    /// A graph without its shaders; the last one of that name, if its files are as they were.
    ///
    /// # Errors
    /// All mistakes of its files.
    pub fn read(&self, name: &str) -> Result<Arc<Graph>, Vec<Diagnostic>> {
        let (path, folders) = (self.graph_path(name), self.folders());
        let key = (self.root.clone(), path.clone());
        let known = || LAST.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(graph) = known().get(&key).filter(|graph| graph.is_current(&folders)) {
            return Ok(graph.clone());
        }
        let graph = Arc::new(load(&path, &folders)?);
        known().insert(key, graph.clone());
        Ok(graph)
    }

    /// [`Workspace::read`] of an experiment's graph.
    ///
    /// # Errors
    /// As [`Workspace::read`]; a missing graph is an error at the experiment's line.
    pub fn read_of(&self, experiment: &Experiment) -> Result<Arc<Graph>, Vec<Diagnostic>> {
        self.read(&experiment.graph).map_err(|errors| {
            let path = self.graph_path(&experiment.graph);
            if path.exists() {
                return errors;
            }
            let located = |e: Diagnostic| {
                let found = experiment.error_in(
                    "graph",
                    format!("graph '{}': {}", path.display(), e.message),
                );
                found.map_or(e.clone(), |found| found.help(e.help))
            };
            errors.into_iter().map(located).collect()
        })
    }

    fn link(
        &self,
        graph: &Graph,
        runs: &Runs,
    ) -> Result<(Vec<Linked>, Vec<Diagnostic>), Vec<Diagnostic>> {
        let shaders = self.folders().shaders;
        link(
            graph,
            &ShaderCompiler::new(&shaders, self.cache.as_deref()),
            &shaders,
            runs,
        )
    }
}

fn has_sources(root: &Path) -> bool {
    root.join("passes").is_dir() && root.join("shaders").is_dir()
}

/// The passes that an experiment runs; all if its parameters have mistakes, which another check
/// reports.
fn runs_of(graph: &Graph, experiment: &Experiment, scene: &Scene, device: &DeviceInfo) -> Runs {
    params_of(graph, experiment).map_or_else(
        |_| Runs::all(graph, &graph.params),
        |params| {
            runs(&Evaluated::new(
                graph,
                &params,
                environment(scene, experiment.size, device),
            ))
        },
    )
}
