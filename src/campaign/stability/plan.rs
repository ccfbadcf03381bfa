//! Jobs of a suite: every method in every case, with the identifier of everything that a result
//! depends on.

use super::cameras::Cameras;
use super::case::{Case, Method};
use super::file::Suite;
use super::motion::FrameState;
use super::param_track::ParamTrack;
use super::record::{About, Measured, title};
use crate::campaign::points::DIGITS;
use crate::campaign::record::Folder;
use crate::campaign::runner::{self, Mistakes, Runner};
use crate::campaign::settings::{Setting, lines, named, set_params};
use crate::experiment::{Experiment, check_size};
use crate::files::content_id;
use crate::graph::Graph;
use crate::lab::{LabError, camera_of, parts_of};
use crate::measure::{Frames, reference};
use crate::results::capture::scene_hash;
use crate::scene::Scene;
use std::path::PathBuf;
use std::sync::Arc;

/// Largest number of values in memory: pixels times frames times parts, 4 bytes each, and the same
/// for the references.
const MAX_VALUES: u64 = 1 << 28;

/// Options of a run.
#[derive(Clone, Debug)]
pub struct Options {
    /// Folder of the results.
    pub folder: PathBuf,
    /// Another size of the pictures.
    pub size: Option<(u32, u32)>,
    /// Settings over all others, NAME=VALUE. Graphs without such a parameter skip it.
    pub set: Vec<String>,
    /// Frames of cases without a fixed number.
    pub frames: Option<usize>,
    /// Samples a pixel of the references, instead of the suite's.
    pub samples: Option<u64>,
    /// Whether there are references.
    pub reference: bool,
    /// Names of the cases to run, all if empty.
    pub only: Vec<String>,
}

/// A method in a case.
#[derive(Clone)]
pub struct Job {
    /// 32 hexadecimal digits: SHA-256 of graph, shaders, parameters, scene, camera, size, time,
    /// motion, frames, samples and device.
    pub id: String,
    /// The same hash without names and references.
    pub work: String,
    pub method: String,
    pub case: Case,
    pub experiment: Experiment,
    /// The scene with the experiment's light.
    pub scene: Arc<Scene>,
    /// SHA-256 of its content.
    pub scene_hash: String,
    /// Camera, time and light before the motion starts.
    pub start: FrameState,
    /// Cameras that do not continue from the start.
    pub cameras: Option<Cameras>,
    /// The parameter that moves.
    pub track: Option<ParamTrack>,
    /// Whether the graph of references has the parameter too, so that the reference moves with it.
    pub reference_moves: bool,
    pub frames: usize,
}

/// Everything that a suite runs, case by case.
pub fn plan(runner: &mut Runner, suite: &Suite, options: &Options) -> Result<Vec<Job>, LabError> {
    if let Some(name) = options
        .only
        .iter()
        .find(|n| !suite.cases.iter().any(|c| c.name == **n))
    {
        let mut known: Vec<&str> = suite.cases.iter().map(|c| c.name.as_str()).collect();
        known.dedup();
        return Err(LabError::Request(format!(
            "--only {name}: the suite's cases are {}",
            known.join(", ")
        )));
    }
    // The shaders of the reference are part of the result.
    let shaders = if options.reference {
        reference::shaders(&runner.lab.home)?
    } else {
        String::new()
    };
    let mut jobs: Vec<Job> = Vec::new();
    let mut mistakes = Mistakes::default();
    let wanted = |c: &&Case| options.only.is_empty() || options.only.contains(&c.name);
    for case in suite.cases.iter().filter(wanted) {
        for method in suite.methods.iter().filter(|m| case.is_for(&m.name)) {
            let job = job(runner, suite, options, (method, case, &shaders));
            jobs.extend(mistakes.take(job)?);
        }
    }
    mistakes.none()?;
    Ok(jobs)
}

fn job(
    runner: &mut Runner,
    suite: &Suite,
    options: &Options,
    (method, case, shaders): (&Method, &Case, &str),
) -> Result<Job, LabError> {
    let (experiment, graph) = experiment(runner, suite, options, (method, case))?;
    let name = title(&case.name, &case.variant);
    let wrong = |why: String| LabError::Request(format!("case '{name}': {why}"));
    let asked = options.frames.filter(|_| !case.own_frames);
    let frames = asked.unwrap_or(case.frames);
    check_parts(suite, &graph, experiment.size, frames).map_err(wrong)?;
    let counts = Frames {
        warmup: case.warmup,
        count: frames,
    };
    let point = runner.point(experiment, Vec::new(), counts)?;
    case.motion.check(&point.scene).map_err(wrong)?;
    let params = point.experiment.params_over(&graph.params)?;
    let track = ParamTrack::of(&case.motion, &params, case.warmup, frames).map_err(wrong)?;
    let mut reference_moves = false;
    if let Some(track) = &track {
        let Runner { lab, warm, .. } = runner;
        let shared = warm.graph(&lab.home, reference::GRAPH)?;
        reference_moves = shared.graph.params.index(&track.name).is_some();
    }
    let late = |at: &usize| frames.saturating_sub(2) < *at;
    if let Some(at) = case.motion.event().filter(late) {
        return Err(wrong(format!(
            "what happens at frame {at} needs two frames more, there are {frames}"
        )));
    }
    let cameras = Cameras::of(&case.motion, &point.experiment, &point.scene, &suite.folder)?;
    let (scene_hash, scene) = match case.motion.scaled_scene(&point.scene) {
        Some(staged) => (scene_hash(&staged), Arc::new(staged)),
        None => (point.subject.sha256.clone(), point.scene.clone()),
    };
    let start = FrameState {
        camera: camera_of(&point.experiment, &scene)?,
        time: point.experiment.time,
        lights: scene.lights.clone(),
        setting: None,
    };
    let (id, work) = ids(runner, suite, options, (method, case, shaders), point.id);
    Ok(Job {
        id,
        work,
        method: method.name.clone(),
        case: case.clone(),
        experiment: point.experiment,
        scene,
        scene_hash,
        start,
        cameras,
        track,
        reference_moves,
        frames,
    })
}

/// The experiment of a method in a case with the settings of the options, and its graph.
fn experiment(
    runner: &mut Runner,
    suite: &Suite,
    options: &Options,
    (method, case): (&Method, &Case),
) -> Result<(Experiment, Arc<Graph>), LabError> {
    let Runner { lab, warm, .. } = runner;
    let mut params = |graph: &str| {
        warm.graph(&lab.home, graph)
            .ok()
            .map(|l| l.graph.params.clone())
    };
    let mut experiment = suite
        .experiment(method, case, &mut params)
        .map_err(LabError::Input)?;
    let graph = warm.graph(&lab.home, &experiment.graph)?.graph.clone();
    let other = experiment.graph != suite.experiment.graph;
    let set: Vec<(&str, &str)> = options
        .set
        .iter()
        .map(|s| named("--set", s, "NAME=VALUE"))
        .collect::<Result<_, LabError>>()?;
    let (text, settings) = lines(set, "=");
    experiment.sources.add("--set".as_ref(), text);
    let has = |s: &&Setting| !other || graph.params.index(&s.name.value).is_some();
    set_params(&mut experiment, settings.iter().filter(has));
    experiment.size = options.size.unwrap_or(experiment.size);
    check_size(experiment.size).map_err(LabError::Request)?;
    Ok((experiment, graph))
}

/// Checks the parts of the light and the number of values.
fn check_parts(
    suite: &Suite,
    graph: &Graph,
    (width, height): (u32, u32),
    frames: usize,
) -> Result<(), String> {
    let names: Vec<String> = parts_of(graph).into_iter().map(|p| p.name).collect();
    let parts = names.len() as u64;
    let values = u64::from(width) * u64::from(height) * frames as u64 * parts;
    if values > MAX_VALUES {
        return Err(format!(
            "{frames} frames of {width}x{height} and {parts} parts are too many to keep; ask for fewer with --frames, or a smaller --size"
        ));
    }
    if parts == 0 {
        return Err(format!(
            "graph '{}' has neither `parts` nor `hdr`",
            graph.name
        ));
    }
    if !names.contains(&suite.pictures) {
        let (part, known) = (&suite.pictures, names.join(", "));
        return Err(format!(
            "no pictures of '{part}': the parts of graph '{}' are {known}",
            graph.name
        ));
    }
    Ok(())
}

/// [`Job::id`] and [`Job::work`].
fn ids(
    runner: &Runner,
    suite: &Suite,
    options: &Options,
    (method, case, shaders): (&Method, &Case, &str),
    point: String,
) -> (String, String) {
    let samples = options
        .reference
        .then(|| options.samples.unwrap_or(suite.samples));
    let device = &runner.lab.gpu.info;
    let device = format!("{} {} {}", device.name, device.driver, device.api);
    let work = content_id([point, format!("{:?}", case.motion), device], DIGITS);
    let asked = format!(
        "{samples:?} {} {} {} {} {shaders}",
        suite.bounces, suite.seed, case.voxels, suite.pictures
    );
    // Equal jobs with different names are two rows.
    let names = format!("{:?} {:?} {:?}", method.name, case.name, case.variant);
    (content_id([&work, &asked, &names], DIGITS), work)
}

impl runner::Job for Job {
    type About = About;
    type Measured = Measured;

    fn id(&self) -> &str {
        &self.id
    }

    fn title(&self) -> String {
        format!(
            "{}, {}",
            title(&self.case.name, &self.case.variant),
            self.method
        )
    }

    fn about(&self, runner: &mut Runner, folder: &Folder) -> Result<About, LabError> {
        Ok(About {
            experiment: runner.resolved(&self.experiment, &self.scene, &folder.path)?,
            case: self.case.name.clone(),
            variant: self.case.variant.clone(),
            text: self.case.about.clone(),
            motion: self.case.motion.describe(),
            method: self.method.clone(),
            scene: self.scene.name.clone(),
            size: self.experiment.size.into(),
            warmup: self.case.warmup,
            frames: self.frames,
        })
    }

    fn warnings(measured: &Measured) -> &[String] {
        &measured.warnings
    }
}

impl Job {
    /// State of frame `number`, see [`super::motion::Motion::frame_state`].
    pub fn frame_state(&self, number: i64, cell: f32) -> FrameState {
        let setting = self
            .track
            .as_ref()
            .filter(|_| self.reference_moves)
            .map(|m| (m.name.clone(), m.at(number)));
        let state = self.case.motion.frame_state(&self.start, number, cell);
        let camera = self
            .cameras
            .as_ref()
            .map_or(state.camera, |c| c.at(&self.start.camera, number));
        FrameState {
            camera,
            setting,
            ..state
        }
    }
}
