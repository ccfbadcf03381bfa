//! Points of campaigns. The identifier of a point hashes everything that its result depends on.

use crate::experiment::{Experiment, placed_text};
use crate::files::content_id;
use crate::lab::{LabError, Loaded, Workspace, camera_of};
use crate::measure::{Frames, Warm};
use crate::results::capture::scene_hash;
use crate::scene::Scene;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;

/// Names and values of the varied settings.
pub type Labels = Vec<(String, String)>;

/// Names and values as text. The value of `experiment` has no name.
pub fn labelled<'l>(labels: impl IntoIterator<Item = (&'l String, &'l String)>) -> String {
    let label = |(n, v): (&String, &String)| {
        if n == "experiment" {
            v.clone()
        } else {
            format!("{n} {v}")
        }
    };
    labels.into_iter().map(label).collect::<Vec<_>>().join(", ")
}

/// Parts of the light, each once: the total first, the others by name.
pub fn total_first<'p>(parts: impl Iterator<Item = &'p String>) -> Vec<String> {
    let parts: BTreeSet<(bool, &String)> = parts.map(|p| (p != "total", p)).collect();
    parts.into_iter().map(|p| p.1.clone()).collect()
}

/// Digits of an identifier.
pub const DIGITS: usize = 32;

/// The image content, for every method.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Subject {
    /// The scene's name.
    pub scene: String,
    /// SHA-256 of the scene, light included.
    pub sha256: String,
    pub camera: String,
    /// Width and height, pixels.
    pub size: (u32, u32),
    /// Time as text, s.
    pub time: String,
}

impl Subject {
    /// The subject of an experiment, for a scene with this SHA-256.
    pub fn of(experiment: &Experiment, scene: &Scene, sha256: String) -> Result<Subject, LabError> {
        let camera = placed_text(&camera_of(experiment, scene)?);
        let (size, time) = (experiment.size, format!("{:?}", experiment.time));
        Ok(Subject {
            scene: scene.name.clone(),
            sha256,
            camera,
            size,
            time,
        })
    }
}

/// A point to measure.
#[derive(Clone)]
pub struct SweepPoint {
    /// 32 hexadecimal digits: SHA-256 of graph, shaders, parameters, scene, camera, size, time and
    /// frames. Points with the same identifier have the same result, except times.
    pub id: String,
    pub experiment: Experiment,
    /// The scene with the experiment's light, empty if it is absent.
    pub scene: Arc<Scene>,
    /// Reason that the scene cannot be opened on this machine.
    pub absent: Option<String>,
    /// Scene, camera, size and time of the picture.
    pub subject: Subject,
    /// Values of the varied settings.
    pub labels: Labels,
}

/// Opens a scene by name or path.
pub type OpenScene<'a> = dyn Fn(&str) -> Result<Scene, LabError> + 'a;

/// Creates points. Opens and hashes each scene and graph once.
pub struct PointBuilder<'a> {
    open: &'a OpenScene<'a>,
    scenes: HashMap<String, Arc<Scene>>,
    /// Scenes with changed light, by scene and light.
    lit: HashMap<String, (Arc<Scene>, String)>,
    graphs: HashMap<String, String>,
}

impl<'a> PointBuilder<'a> {
    pub fn new(open: &'a OpenScene<'a>) -> PointBuilder<'a> {
        PointBuilder {
            open,
            scenes: HashMap::new(),
            lit: HashMap::new(),
            graphs: HashMap::new(),
        }
    }

    /// Creates the point of an experiment.
    pub fn point(
        &mut self,
        home: &Workspace,
        warm: &mut Warm,
        experiment: Experiment,
        labels: Labels,
        frames: Frames,
    ) -> Result<SweepPoint, LabError> {
        let loaded = warm.graph(home, &experiment.graph)?;
        let graph = self
            .graphs
            .entry(experiment.graph.clone())
            .or_insert_with(|| graph_hash(loaded))
            .clone();
        let params = experiment.params_over(&loaded.graph.params)?;
        let (scene, sha256) = self.scene(&experiment)?;
        let values = params
            .list
            .iter()
            .zip(&params.values)
            .map(|(p, v)| format!("{}={v}", p.name));
        let subject = Subject::of(&experiment, &scene, sha256)?;
        let facts = [
            format!("conelab {}", env!("CARGO_PKG_VERSION")),
            graph,
            subject.sha256.clone(),
            subject.camera.clone(),
            format!(
                "{}x{} at {} s",
                subject.size.0, subject.size.1, subject.time
            ),
            format!("{} + {} frames", frames.warmup, frames.count),
        ];
        let id = content_id(facts.into_iter().chain(values), DIGITS);
        Ok(SweepPoint {
            id,
            experiment,
            scene,
            absent: None,
            subject,
            labels,
        })
    }

    /// The scene with the experiment's light, and its hash.
    fn scene(&mut self, experiment: &Experiment) -> Result<(Arc<Scene>, String), LabError> {
        let key = format!("{:?} {}", experiment.scene, experiment.light());
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

/// SHA-256 over the text of a graph's files and of its shaders with their includes, without their
/// paths.
fn graph_hash(loaded: &Loaded) -> String {
    let mut texts: BTreeSet<(String, &str)> = BTreeSet::new();
    for (path, text) in loaded.graph.sources.texts() {
        texts.insert((
            path.file_name()
                .map_or(String::new(), |n| n.to_string_lossy().into_owned()),
            text,
        ));
    }
    for (name, text) in loaded
        .linked
        .iter()
        .flat_map(|l| &l.stages)
        .flat_map(|s| s.texts.iter())
    {
        texts.insert((name.clone(), text.as_str()));
    }
    content_id(
        texts.iter().flat_map(|(name, text)| [name.as_str(), text]),
        64,
    )
}
