//! The points of a sweep, each with the number of everything that its result depends on.

use super::points::{Labels, Sweep};
use super::record::Subject;
use crate::experiment::{Experiment, placed_text};
use crate::graph::source::Diagnostic;
use crate::lab::{LabError, Loaded, Workspace, camera_of};
use crate::measure::{Frames, Warm};
use crate::results::capture::{id_of, scene_hash};
use crate::scene::{Scene, SceneError};
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, HashMap};
use std::path::Path;
use std::sync::Arc;

/// A point that is to be measured.
#[derive(Clone)]
pub struct SweepPoint {
    /// 32 hexadecimal digits: SHA-256 of graph, shaders, parameters, scene, camera, size, time and frames. Points of
    /// one number have one result, up to times.
    pub id: String,
    /// The experiment that is run.
    pub experiment: Experiment,
    /// The scene, lit as the experiment says; an empty one where it is absent.
    pub scene: Arc<Scene>,
    /// Why the scene is not on this machine, or cannot be read: the point cannot be measured here.
    pub absent: Option<String>,
    /// Scene, camera, size and time of the picture.
    pub subject: Subject,
    /// Its values, by the names of what is varied.
    pub labels: Labels,
}

/// Makes points; scenes and graphs are opened and hashed once for all of them.
pub struct PointBuilder<'a> {
    home: &'a Workspace,
    open: &'a dyn Fn(&str) -> Result<Scene, LabError>,
    scenes: HashMap<String, Arc<Scene>>,
    /// Scenes under changed light, by scene and light.
    lit: HashMap<String, (Arc<Scene>, String)>,
    graphs: HashMap<String, String>,
}

impl<'a> PointBuilder<'a> {
    /// `open` opens a scene by name or path.
    pub fn new(home: &'a Workspace, open: &'a dyn Fn(&str) -> Result<Scene, LabError>) -> PointBuilder<'a> {
        PointBuilder { home, open, scenes: HashMap::new(), lit: HashMap::new(), graphs: HashMap::new() }
    }

    /// The point of an experiment.
    ///
    /// # Errors
    /// Graph, shaders, parameters, scene or camera that cannot be had.
    pub fn point(
        &mut self,
        warm: &mut Warm,
        experiment: Experiment,
        labels: Labels,
        frames: Frames,
    ) -> Result<SweepPoint, LabError> {
        let loaded = warm.graph(self.home, &experiment.graph)?;
        let graph = self.graphs.entry(experiment.graph.clone()).or_insert_with(|| graph_hash(loaded)).clone();
        let params = experiment.params_over(&loaded.graph.params)?;
        let (scene, sha256) = self.scene(&experiment)?;
        let camera = camera_of(&experiment, &scene)?;
        let values = params.list.iter().zip(&params.values).map(|(p, v)| format!("{}={v}", p.name));
        let subject = Subject {
            scene: scene.name.clone(),
            sha256,
            camera: placed_text(&camera),
            size: experiment.size,
            time: format!("{:?}", experiment.time),
        };
        let facts = [
            format!("conelab {}", env!("CARGO_PKG_VERSION")),
            graph,
            subject.sha256.clone(),
            subject.camera.clone(),
            format!("{}x{} at {} s", subject.size.0, subject.size.1, subject.time),
            format!("{} + {} frames", frames.warmup, frames.count),
        ];
        let id = id_of(facts.into_iter().chain(values));
        Ok(SweepPoint { id, experiment, scene, absent: None, subject, labels })
    }

    /// The scene under the experiment's light, with its hash.
    fn scene(&mut self, experiment: &Experiment) -> Result<(Arc<Scene>, String), LabError> {
        let lights: Vec<String> = experiment.lights.iter().map(|(name, l)| format!("{} {l:?}", name.value)).collect();
        let environment = experiment.environment.as_ref().map(|e| &e.value);
        let key = format!("{:?} {:?} {environment:?} {:?}", experiment.scene, experiment.sky, lights);
        if let Some(found) = self.lit.get(&key) {
            return Ok(found.clone());
        }
        let plain = match self.scenes.get(&experiment.scene) {
            Some(scene) => scene.clone(),
            None => {
                let scene = Arc::new((self.open)(&experiment.scene)?);
                self.scenes.insert(experiment.scene.clone(), scene.clone());
                scene
            }
        };
        let scene = experiment.adapted(plain)?;
        let hash = scene_hash(&scene);
        self.lit.insert(key, (scene.clone(), hash.clone()));
        Ok((scene, hash))
    }
}

/// A point whose model is not on this machine, or cannot be read. Where it can, the point has another number, by the scene's
/// content.
fn absent(experiment: Experiment, labels: Labels, why: &SceneError) -> SweepPoint {
    let name = Path::new(&experiment.scene).file_stem().map_or(String::new(), |s| s.to_string_lossy().into_owned());
    let (size, time) = (experiment.size, format!("{:?}", experiment.time));
    let subject = Subject { scene: name, sha256: String::new(), camera: String::new(), size, time };
    let values = labels.iter().map(|(name, value)| format!("{name}={value}"));
    let id = id_of(["absent".to_string(), format!("{subject:?}")].into_iter().chain(values));
    SweepPoint { id, experiment, scene: Arc::default(), absent: Some(why.to_string()), subject, labels }
}

/// All points of a sweep in order, without those that another one equals; and how many those are. A model that is not
/// on this machine, or damaged, makes its points absent, and no error: suites name scenes that not everybody has.
///
/// # Errors
/// Everything that is wrong with the sweep's settings: nothing is measured then.
pub fn list(
    builder: &mut PointBuilder,
    warm: &mut Warm,
    sweep: &Sweep,
    frames: Frames,
) -> Result<(Vec<SweepPoint>, usize), LabError> {
    let mut points: Vec<SweepPoint> = Vec::new();
    let mut known = std::collections::HashSet::new();
    let mut errors: Vec<Diagnostic> = Vec::new();
    for index in 0..sweep.len() {
        let point = sweep.point(index).map_err(LabError::Input).and_then(|(experiment, labels)| {
            match builder.point(warm, experiment.clone(), labels.clone(), frames) {
                Err(LabError::Scene(
                    why @ (SceneError::NoModel { .. } | SceneError::Model { .. } | SceneError::SceneFile { .. }),
                )) => Ok(absent(experiment, labels, &why)),
                other => other,
            }
        });
        match point {
            Ok(point) if known.insert(point.id.clone()) => points.push(point),
            Ok(_) => {}
            Err(LabError::Input(list)) => add_new(&mut errors, list),
            Err(other) => return Err(other),
        }
        if errors.len() >= 20 {
            break;
        }
    }
    if !errors.is_empty() {
        return Err(LabError::Input(errors));
    }
    let equal = sweep.len() - points.len();
    Ok((points, equal))
}

/// Checks a sweep without opening its scenes: experiments, graphs, and the parameters of every point.
///
/// # Errors
/// All mistakes, each once.
pub fn check(home: &Workspace, path: &Path) -> Result<(), Vec<Diagnostic>> {
    let sweep = Sweep::read(path)?;
    let mut warm = Warm::default();
    let mut errors: Vec<Diagnostic> = Vec::new();
    for index in 0..sweep.len() {
        let checked = sweep.point(index).map_err(LabError::Input).and_then(|(experiment, _)| {
            let graph = &warm.graph(home, &experiment.graph)?.graph;
            experiment.params_over(&graph.params)
        });
        if let Err(LabError::Input(list)) = checked {
            add_new(&mut errors, list);
        }
    }
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}

/// The same mistake comes back with every combination: it is reported once.
fn add_new(errors: &mut Vec<Diagnostic>, list: Vec<Diagnostic>) {
    for diagnostic in list {
        if !errors.contains(&diagnostic) {
            errors.push(diagnostic);
        }
    }
}

/// SHA-256 over the text of a graph's files and of its shaders with their includes; where they lie is left out.
fn graph_hash(loaded: &Loaded) -> String {
    let mut texts: BTreeMap<(String, &str), ()> = BTreeMap::new();
    for (path, text) in loaded.graph.sources.texts() {
        let name = path.file_name().map_or(String::new(), |n| n.to_string_lossy().into_owned());
        texts.insert((name, text), ());
    }
    for (name, text) in loaded.linked.iter().flat_map(|l| &l.stages).flat_map(|s| s.texts.iter()) {
        texts.insert((name.clone(), text.as_str()), ());
    }
    let mut hash = Sha256::new();
    for (name, text) in texts.into_keys() {
        for part in [name.as_str(), text] {
            hash.update((part.len() as u64).to_le_bytes());
            hash.update(part);
        }
    }
    crate::results::capture::hex(&hash.finalize())
}
