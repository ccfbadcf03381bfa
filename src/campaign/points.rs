//! The points of campaigns, each with the number of everything that its result depends on.

use crate::experiment::{Experiment, placed_text};
use crate::files::content_id;
use crate::lab::{LabError, Loaded, Workspace, camera_of};
use crate::measure::{Frames, Warm};
use crate::results::capture::scene_hash;
use crate::scene::Scene;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;

/// The values of a point, by the names of what is varied.
pub type Labels = Vec<(String, String)>;

/// Values with their names, for people; an experiment's name says enough.
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

/// Parts of the light, each once: the total, then what it is made of by name.
pub fn total_first<'p>(parts: impl Iterator<Item = &'p String>) -> Vec<String> {
    let parts: BTreeSet<(bool, &String)> = parts.map(|p| (p != "total", p)).collect();
    parts.into_iter().map(|p| p.1.clone()).collect()
}

/// Digits of a point's number.
pub const DIGITS: usize = 32;

/// A picture, whatever method makes it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Subject {
    /// The scene's name.
    pub scene: String,
    /// SHA-256 of its content, light included.
    pub sha256: String,
    /// The camera, written out.
    pub camera: String,
    /// Width and height, pixels.
    pub size: (u32, u32),
    /// Seconds, written out.
    pub time: String,
}

impl Subject {
    /// What an experiment looks at in a scene of that content.
    ///
    /// # Errors
    /// A camera that the scene does not have.
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

/// Opens a scene by name or path.
pub type OpenScene<'a> = dyn Fn(&str) -> Result<Scene, LabError> + 'a;

/// Makes points; scenes and graphs are opened and hashed once for all of them.
pub struct PointBuilder<'a> {
    open: &'a OpenScene<'a>,
    scenes: HashMap<String, Arc<Scene>>,
    /// Scenes under changed light, by scene and light.
    lit: HashMap<String, (Arc<Scene>, String)>,
    graphs: HashMap<String, String>,
}

impl<'a> PointBuilder<'a> {
    /// Without any scene yet.
    pub fn new(open: &'a OpenScene<'a>) -> PointBuilder<'a> {
        PointBuilder {
            open,
            scenes: HashMap::new(),
            lit: HashMap::new(),
            graphs: HashMap::new(),
        }
    }

    /// The point of an experiment.
    ///
    /// # Errors
    /// Graph, shaders, parameters, scene or camera that cannot be had.
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

    /// The scene under the experiment's light, with its hash.
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

/// SHA-256 over the text of a graph's files and of its shaders with their includes; where they lie is left out.
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
