//! An experiment that runs.

use crate::errors::{exception, finding, raised};
use crate::lab::Lab;
use crate::memory::Memory;
use crate::owned::Owned;
use crate::params;
use crate::progress::Reporter;
use crate::reference::{Reference, word};
use conelab::campaign::settings::{apply, lines};
use conelab::diagnostics::SETTINGS;
use conelab::experiment::{Experiment as Setup, write};
use conelab::graph::run::{Execution, FrameTimes};
use conelab::graph::table::CellKind;
use conelab::graph::{outline, report};
use conelab::lab::{
    Lab as Opened, LabError, Loaded, ReusableParts, Session, Texels, Workspace, camera_of,
    no_texture, params_of, parts_of,
};
use conelab::measure::reference::{ALL_BOUNCES, Goal, NoiseBound, gather};
use conelab::results::stats;
use conelab::scene::Scene;
use pyo3::Bound;
use pyo3::prelude::{Py, PyAny, PyResult, Python, pyclass, pymethods};
use pyo3::types::PyDict;
use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// An experiment that runs on a lab's device.
#[pyclass(frozen, module = "conelab._conelab")]
pub struct Experiment {
    lab: Py<Lab>,
    own: Owned<State>,
}

struct State {
    setup: Setup,
    /// Folders of its graph and shaders: the lab's, or a copy with edits.
    home: Workspace,
    /// The scene as its file describes it.
    unlit: Arc<Scene>,
    /// The scene with the experiment's light.
    scene: Arc<Scene>,
    loaded: Loaded,
    /// Textures that frames keep besides the picture.
    kept: BTreeSet<String>,
    session: Option<Session>,
    /// Pipelines and scene of the last session.
    left: Option<ReusableParts>,
    last: Option<Run>,
}

/// Frames that ran.
#[derive(Clone, Default)]
struct Run {
    frames: Option<usize>,
    warmup: Option<usize>,
    step: f64,
    execution: Execution,
    times: Vec<FrameTimes>,
    /// Frames before the timed ones.
    warmed: usize,
    warnings: Vec<String>,
}

type Tick<'a> = &'a mut dyn FnMut(usize, usize) -> ControlFlow<()>;

impl State {
    /// On the device, with everything that is to be read kept.
    fn session(&mut self, lab: &Opened) -> Result<&mut Session, LabError> {
        let session = match self.session.take() {
            Some(session) => session,
            None => {
                let lab = Opened {
                    home: self.home.clone(),
                    gpu: lab.gpu.clone(),
                };
                let results = self
                    .loaded
                    .graph
                    .output
                    .iter()
                    .chain(&self.loaded.graph.hdr);
                let wanted = results.chain(&self.kept).cloned().collect();
                let scene = self.scene.clone();
                self.loaded = lab
                    .home
                    .complete(&self.loaded, &self.setup, &scene, &lab.gpu.info)
                    .map_err(LabError::Input)?;
                lab.build(&self.setup, &self.loaded, scene, wanted, self.left.as_ref())?
            }
        };
        self.left = None;
        Ok(self.session.insert(session))
    }

    /// Leaves the session, except for parts that the next one can use.
    fn leave(&mut self) {
        self.left = self.session.take().map(|s| s.share()).or(self.left.take());
    }

    /// Forgets everything of a lost device.
    fn forget(&mut self) {
        (self.session, self.left) = (None, None);
    }

    /// Runs frames: the picture's first ones, or those after the last.
    fn run(
        &mut self,
        lab: &Opened,
        mut run: Run,
        restart: bool,
        tick: Tick,
    ) -> Result<(), LabError> {
        let session = self.session(lab)?;
        session.set_execution(run.execution);
        if restart {
            session.restart()?;
        }
        let alone = run.frames.is_none() && run.step == 0.0;
        let converging = if alone && restart {
            session.converging_frames()
        } else {
            1
        };
        let (frames, warmup) = (
            run.frames.unwrap_or(1),
            run.warmup.unwrap_or(converging - 1),
        );
        let all = frames + warmup;
        session.begin_warm_up(&lab.gpu.info);
        for number in 0..all {
            if number == warmup {
                session.set_execution(run.execution);
            }
            run.times.extend(session.frame(run.step)?);
            if tick(number + 1, all).is_break() {
                session.finish()?;
                return Err(LabError::Stopped);
            }
        }
        run.times.extend(session.finish()?);
        run.times = run.times.split_off(run.times.len().saturating_sub(frames));
        (run.warmed, run.warnings) = (warmup, session.failed_checks()?);
        self.last = Some(run);
        Ok(())
    }

    /// A session with a picture that keeps these textures: frames run again if they did not keep them.
    fn with(
        &mut self,
        lab: &Opened,
        textures: &[String],
        tick: Tick,
    ) -> Result<&mut Session, LabError> {
        let lacks = |session: &Session| textures.iter().any(|t| !session.keeps(t));
        let rebuild = self.session.as_ref().is_some_and(lacks);
        self.kept.extend(textures.iter().cloned());
        if rebuild {
            self.leave();
        }
        if rebuild || self.session.is_none() || self.last.is_none() {
            let again = self.last.take().unwrap_or_default();
            let run = Run {
                times: Vec::new(),
                ..again
            };
            self.run(lab, run, true, tick)?;
        }
        self.session(lab)
    }

    fn texels(
        &mut self,
        lab: &Opened,
        (name, mip, layer): (&str, u32, u32),
        slice: Option<(usize, u32)>,
        tick: Tick,
    ) -> Result<Texels, LabError> {
        if self.loaded.graph.texture(name).is_none() {
            return Err(no_texture(&self.loaded.graph, name));
        }
        let session = self.with(lab, &[name.to_string()], tick)?;
        match slice {
            Some((axis, at)) => session.slice(name, mip, layer, axis, at),
            None => session.texels(name, mip, layer),
        }
    }

    /// Takes other settings, and keeps the session if it can run them.
    fn change(
        &mut self,
        lab: &Opened,
        setup: Setup,
        loaded: Loaded,
        unlit: Arc<Scene>,
    ) -> Result<(), LabError> {
        let params = params_of(&loaded.graph, &setup)?;
        let scene = setup.adapted(unlit.clone())?;
        let camera = camera_of(&setup, &scene)?;
        // Before anything is changed: an error leaves the experiment as it was.
        let info = &lab.gpu.info;
        let complete = self.home.complete(&loaded, &setup, &scene, info);
        let complete = complete.map_err(LabError::Input)?;
        let same_light = (&scene.lights, scene.sky, &scene.environment)
            == (&self.scene.lights, self.scene.sky, &self.scene.environment);
        let same = Arc::ptr_eq(&unlit, &self.unlit)
            && same_light
            && Arc::ptr_eq(&loaded.graph, &self.loaded.graph)
            && setup.size == self.setup.size;
        let lab = Opened {
            home: self.home.clone(),
            gpu: lab.gpu.clone(),
        };
        if let Some(session) = &mut self.session {
            let kept = same && session.set_params(&lab, &params)?;
            if kept {
                session.place_camera(&camera);
                session.set_time(setup.time);
            } else {
                self.leave();
            }
        }
        if !same {
            self.scene = scene;
        }
        (self.setup, self.loaded, self.unlit) = (setup, complete, unlit);
        // What frames left is of the settings before.
        self.last = None;
        Ok(())
    }
}

/// Settings of an experiment as RON, over those before. `folder` is for relative paths.
pub fn settled(
    setup: &Setup,
    settings: &[(String, String)],
    folder: &Path,
) -> Result<Setup, LabError> {
    let mut setup = setup.clone();
    let replaced = |name: &str| settings.iter().any(|s| s.0 == name);
    setup.params.retain(|p| !replaced(&p.0.value));
    let pairs = settings
        .iter()
        .map(|(name, value)| (name.as_str(), value.as_str()));
    let (text, list) = lines(pairs, " = ");
    setup.sources.add(SETTINGS.as_ref(), text);
    let errors = apply(&mut setup, &list, folder);
    if errors.is_empty() {
        Ok(setup)
    } else {
        Err(LabError::Input(errors))
    }
}

impl Experiment {
    /// The experiment for campaigns, which read graphs and shaders from the lab's folders.
    pub fn setup(&self) -> PyResult<Setup> {
        let state = self.own.lock()?;
        if state.home.root != self.lab.get().opened()?.home.root {
            let message = "this experiment has edited sources, and campaigns measure those of the Lab: \
                           write them with save_sources, and open a Lab with that home";
            return Err(raised("RequestError", message));
        }
        Ok(state.setup.clone())
    }

    /// Calls with the state and the lab, without the GIL; a lost device leaves nothing on it.
    fn call<T: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut State, &Opened) -> Result<T, LabError> + Send,
    ) -> PyResult<T> {
        let lab = self.lab.get();
        let mut guard = self.own.lock()?;
        let state = &mut *guard;
        let opened = lab.opened()?;
        let result = py.detach(|| work(state, &opened));
        if matches!(&result, Err(LabError::Vulkan(_))) {
            state.forget();
        }
        lab.done(&opened, result)
    }

    /// [`Experiment::call`] for work that takes a while.
    fn report<T: Send>(
        &self,
        py: Python<'_>,
        callback: Option<Bound<'_, PyAny>>,
        work: impl FnOnce(&mut State, &Opened, Tick) -> Result<T, LabError> + Send,
    ) -> PyResult<T> {
        let mut reporter = Reporter::new(callback);
        let result = self.call(py, |state, lab| {
            let mut tick = |done, of| reporter.count("frames", done, of);
            work(state, lab, &mut tick)
        });
        reporter.end(result)
    }
}

#[pymethods]
impl Experiment {
    /// Opens an experiment: its file or its text, and settings over it, as RON.
    #[staticmethod]
    #[pyo3(signature = (lab, file, text, settings, keep, progress))]
    fn open(
        py: Python<'_>,
        lab: Py<Lab>,
        file: PathBuf,
        text: Option<&str>,
        settings: Vec<(String, String)>,
        keep: Vec<String>,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Experiment> {
        let opened = lab.get().opened()?;
        let read = match text {
            Some(text) => Setup::from_text(&file, text),
            None => Setup::read(&file),
        };
        let setup = read.map_err(|list| exception(LabError::Input(list)))?;
        let setup = settled(&setup, &settings, Path::new(".")).map_err(exception)?;
        let home = opened.home.clone();
        // Scenes take longer to read than graphs: wrong names come first.
        let graph = home.read_of(&setup).map_err(LabError::Input);
        let known = graph.and_then(|graph| params_of(&graph, &setup));
        known.map_err(exception)?;
        let mut reporter = Reporter::new(progress);
        let unlit = lab.get().scene(&setup, &mut reporter, py);
        let unlit = reporter.end(unlit)?;
        let made = py.detach(|| {
            let scene = setup.adapted(unlit.clone())?;
            let loaded = home
                .load_for(&setup, &scene, &opened.gpu.info)
                .map_err(LabError::Input)?;
            params_of(&loaded.graph, &setup)?;
            camera_of(&setup, &scene)?;
            if let Some(name) = keep
                .iter()
                .find(|name| loaded.graph.texture(name).is_none())
            {
                return Err(no_texture(&loaded.graph, name));
            }
            Ok(State {
                setup,
                home,
                unlit,
                scene,
                loaded,
                kept: keep.into_iter().collect(),
                session: None,
                left: None,
                last: None,
            })
        });
        let own = Owned::new("experiment", lab.get().noticed(made)?);
        Ok(Experiment { lab, own })
    }

    /// Leaves the device's memory.
    fn close(&self) -> PyResult<()> {
        self.own.lock()?.forget();
        Ok(())
    }

    /// Warnings about the scene and the graph.
    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<(Vec<String>, Vec<Bound<'py, PyDict>>)> {
        let state = self.own.lock()?;
        let graph = state.loaded.warnings.iter().map(|w| finding(py, w));
        Ok((
            state.scene.warnings.clone(),
            graph.collect::<PyResult<_>>()?,
        ))
    }

    /// Changes settings, all or none.
    #[pyo3(signature = (settings, progress))]
    fn set(
        &self,
        py: Python<'_>,
        settings: Vec<(String, String)>,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let changed = |name: &str| settings.iter().any(|s| s.0 == name);
        let (before, unlit) = {
            let state = self.own.lock()?;
            (state.setup.clone(), state.unlit.clone())
        };
        let setup = settled(&before, &settings, Path::new(".")).map_err(exception)?;
        let unlit = if changed("scene") {
            let mut reporter = Reporter::new(progress);
            let scene = self.lab.get().scene(&setup, &mut reporter, py);
            reporter.end(scene)?
        } else {
            unlit
        };
        let other_graph = changed("graph");
        self.call(py, move |state, lab| {
            let loaded = match other_graph {
                true => state
                    .home
                    .load_for(&setup, &unlit, &lab.gpu.info)
                    .map_err(LabError::Input)?,
                false => state.loaded.clone(),
            };
            state.change(lab, setup, loaded, unlit)
        })
    }

    /// The lights of this text of an experiment (`lights: {...}`), over those of the scene.
    fn set_lights(&self, py: Python<'_>, lights: &str) -> PyResult<()> {
        let text = format!("(graph: \"\", scene: \"\", lights: {lights})");
        let read = Setup::from_text(SETTINGS.as_ref(), &text);
        let read = read.map_err(|list| exception(LabError::Input(list)))?;
        self.call(py, move |state, lab| {
            let mut setup = state.setup.clone();
            setup.lights = read.lights;
            setup.sources = read.sources;
            state.change(lab, setup, state.loaded.clone(), state.unlit.clone())
        })
    }

    /// Runs frames; the measurements as JSON (docs/stats.md).
    #[pyo3(signature = (frames, warmup, step, restart, incremental, progress))]
    #[expect(clippy::too_many_arguments, reason = "the options of a render")]
    fn render(
        &self,
        py: Python<'_>,
        frames: Option<usize>,
        warmup: Option<usize>,
        step: f64,
        restart: bool,
        incremental: bool,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<String> {
        if frames == Some(0) || !step.is_finite() {
            return Err(raised(
                "RequestError",
                "frames must be 1 or more, and step a finite number of seconds",
            ));
        }
        self.report(py, progress, |state, lab, tick| {
            let run = Run {
                frames,
                warmup,
                step,
                execution: match incremental {
                    true => Execution::Incremental,
                    false => Execution::Full,
                },
                ..Run::default()
            };
            state.run(lab, run, restart, tick)?;
            statistics(state, lab)
        })
    }

    /// Runs one frame after the last one and waits for nothing.
    fn frame(&self, py: Python<'_>, step: f64) -> PyResult<()> {
        self.call(py, |state, lab| state.session(lab)?.frame(step).map(drop))
    }

    /// Texels of a mip and layer, or of a slice of a volume: (axis, number).
    #[pyo3(signature = (name, mip, layer, slice, progress))]
    fn texture(
        &self,
        py: Python<'_>,
        name: &str,
        mip: u32,
        layer: u32,
        slice: Option<(usize, u32)>,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<(Memory, &'static str)> {
        let texels = self.report(py, progress, |state, lab, tick| {
            state.texels(lab, (name, mip, layer), slice, tick)
        })?;
        let format = texels.format.name;
        Ok((Memory::of_texels(texels), format))
    }

    /// Names of the graph's results: displayed, linear.
    fn results(&self) -> PyResult<(Option<String>, Option<String>)> {
        let state = self.own.lock()?;
        Ok((
            state.loaded.graph.output.clone(),
            state.loaded.graph.hdr.clone(),
        ))
    }

    /// Bytes of a buffer, as 32-bit words.
    fn buffer(&self, py: Python<'_>, name: &str) -> PyResult<Memory> {
        let bytes = self.call(py, |state, lab| state.session(lab)?.buffer(name))?;
        let count = bytes.len();
        Ok(Memory::new(bytes, "u1", vec![count]))
    }

    /// Names and buffers of the graph's tables.
    fn tables(&self) -> PyResult<Vec<String>> {
        let state = self.own.lock()?;
        Ok(state
            .loaded
            .graph
            .tables
            .iter()
            .map(|t| t.value.title.clone())
            .collect())
    }

    /// A table: its buffer's bytes, first row, bytes of a row, number of rows, and columns as (name, offset, type, unit).
    #[expect(clippy::type_complexity, reason = "Python takes it apart at once")]
    fn table(
        &self,
        py: Python<'_>,
        name: &str,
    ) -> PyResult<(
        Memory,
        u32,
        u32,
        u32,
        Vec<(String, u32, &'static str, String)>,
    )> {
        let (bytes, table) = self.call(py, |state, lab| {
            let graph = state.loaded.graph.clone();
            let number = graph.tables.iter().position(|t| t.value.title == name);
            let number = number.ok_or_else(|| LabError::Request(format!("no table '{name}'")))?;
            let buffer = graph.tables[number].value.list.value.buffer.clone();
            let session = state.session(lab)?;
            let table = session.table(number);
            let table = table.ok_or_else(|| {
                LabError::Request(format!(
                    "'{name}' is not made with these parameters: no pass that runs uses it"
                ))
            })?;
            Ok((session.buffer(&buffer)?, table))
        })?;
        let row = table.rows as usize * 4;
        let rows = bytes
            .get(row..row + 4)
            .map_or(0, |b| u32::from_ne_bytes([b[0], b[1], b[2], b[3]]));
        let room = bytes.len().saturating_sub(table.start as usize) / table.stride.max(1) as usize;
        let columns = table.columns.iter().map(|c| {
            let kind = match c.kind {
                CellKind::Uint => "u4",
                CellKind::Int => "i4",
                CellKind::Float => "f4",
                CellKind::Vec2 => "2f4",
                CellKind::Vec3 => "3f4",
                CellKind::Vec4 => "4f4",
            };
            (c.name.clone(), c.at, kind, c.unit.clone())
        });
        let (columns, count) = (columns.collect(), bytes.len());
        let rows = rows.min(u32::try_from(room).unwrap_or(u32::MAX));
        Ok((
            Memory::new(bytes, "u1", vec![count]),
            table.start,
            table.stride,
            rows,
            columns,
        ))
    }

    /// The light's parts of the last picture: name, kind, pixels.
    #[pyo3(signature = (progress))]
    fn parts(
        &self,
        py: Python<'_>,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Vec<(String, &'static str, Memory)>> {
        let parts = self.report(py, progress, |state, lab, tick| {
            let graph = &state.loaded.graph;
            let textures: Vec<String> = parts_of(graph).into_iter().map(|p| p.texture).collect();
            if textures.is_empty() {
                let name = &graph.name;
                let message = format!(
                    "graph '{name}' has neither `parts` nor `hdr`: there is nothing to compare"
                );
                return Err(LabError::Request(message));
            }
            state.with(lab, &textures, tick)?.parts()
        })?;
        let part = |(name, light)| {
            let light: conelab::metrics::Linear = light;
            (name, word(light.kind), Memory::of_linear(light))
        };
        Ok(parts.into_iter().map(part).collect())
    }

    /// The path-traced reference of what the experiment sees.
    #[pyo3(signature = (spp, until, bounces, progress))]
    fn reference(
        &self,
        py: Python<'_>,
        spp: Option<u64>,
        until: Option<&str>,
        bounces: Option<u32>,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Reference> {
        let bound = until.map(str::parse::<NoiseBound>).transpose();
        let bound = bound.map_err(|why| raised("RequestError", format!("until: {why}")))?;
        if spp.is_some_and(|n| !(1..=1 << 24).contains(&n)) {
            return Err(raised("RequestError", "spp must be 1 to 16777216"));
        }
        let goal = match bound {
            Some(bound) => Goal::Noise(NoiseBound {
                most: spp.unwrap_or(bound.most),
                ..bound
            }),
            None => Goal::Samples(spp.unwrap_or(Goal::DEFAULT_SAMPLES)),
        };
        let mut reporter = Reporter::new(progress);
        let result = self.call(py, |state, lab| {
            let bounces = bounces.unwrap_or(ALL_BOUNCES);
            gather(lab, &state.setup, &state.scene, bounces, goal, &mut |now| {
                reporter.count("samples", now.samples as usize, now.goal as usize)
            })
        });
        let reference = reporter.end(result)?;
        Ok(Reference(Arc::new(reference)))
    }

    /// Parameters as JSON, with their present values.
    fn params(&self) -> PyResult<String> {
        let state = self.own.lock()?;
        let params = params_of(&state.loaded.graph, &state.setup).map_err(exception)?;
        Ok(params::json(&params))
    }

    /// The plan as JSON (`conelab graph --json`), and as text with every barrier.
    fn graph(&self, py: Python<'_>) -> PyResult<(String, String)> {
        self.call(py, |state, lab| {
            let session = state.session(lab)?;
            let (graph, plan) = (&session.graph, &session.program.plan);
            let json = serde_json::to_string(&outline::outline(graph, &session.params, plan));
            let json = json.map_err(LabError::making("JSON"))?;
            Ok((json, report::text(graph, &session.linked, plan)))
        })
    }

    /// Name, graph, scene, width and height, time.
    #[expect(clippy::type_complexity, reason = "Python takes it apart at once")]
    fn about(&self) -> PyResult<(String, String, String, (u32, u32), f64)> {
        let state = self.own.lock()?;
        let s = &state.setup;
        Ok((
            s.name.clone(),
            s.graph.clone(),
            s.scene.clone(),
            s.size,
            s.time,
        ))
    }

    /// The camera: eye, target, up, vertical field of view in degrees.
    #[expect(clippy::type_complexity, reason = "Python takes it apart at once")]
    fn camera(&self) -> PyResult<((f32, f32, f32), (f32, f32, f32), (f32, f32, f32), f32)> {
        let state = self.own.lock()?;
        let c = camera_of(&state.setup, &state.scene).map_err(exception)?;
        Ok((c.eye, c.target, c.up, c.fov_y))
    }

    /// Names of the scene's cameras, lights, and its bounds: least and greatest corner, m.
    #[expect(clippy::type_complexity, reason = "Python takes it apart at once")]
    fn scene(&self) -> PyResult<(Vec<String>, Vec<String>, [f32; 3], [f32; 3])> {
        let state = self.own.lock()?;
        let (least, most) = state.scene.bounds();
        Ok((
            state.scene.cameras.keys().cloned().collect(),
            state.scene.lights.iter().map(|l| l.name.clone()).collect(),
            least.to_array(),
            most.to_array(),
        ))
    }

    /// Writes the experiment to a file, without the graph's defaults.
    fn save(&self, path: PathBuf, overwrite: bool) -> PyResult<()> {
        let state = self.own.lock()?;
        let written = write(&state.setup, &state.loaded.graph.params, &path, overwrite);
        written.map(drop).map_err(|error| exception(error.into()))
    }

    /// Writes the scene with the experiment's light to an .obj, .gltf or .glb file; what the format cannot hold.
    fn export_scene(&self, py: Python<'_>, path: PathBuf) -> PyResult<Vec<String>> {
        let state = self.own.lock()?;
        let scene = &state.scene;
        let written = py.detach(|| scene.export(&path));
        written.map_err(|error| exception(error.into()))
    }

    /// Takes graph and shaders from another folder, or from the lab's: all or nothing.
    #[pyo3(signature = (root))]
    fn rebase(&self, py: Python<'_>, root: Option<PathBuf>) -> PyResult<()> {
        self.call(py, move |state, lab| {
            let before = state.home.clone();
            let home = Workspace {
                root: root.unwrap_or_else(|| lab.home.root.clone()),
                ..lab.home.clone()
            };
            let (setup, info) = (&state.setup, &lab.gpu.info);
            let loaded = home
                .load_for(setup, &state.scene, info)
                .map_err(LabError::Input)?;
            state.home = home;
            // Equal parameters would keep a session with the shaders before the edit.
            state.leave();
            let changed = state.change(lab, state.setup.clone(), loaded, state.unlit.clone());
            if changed.is_err() {
                state.home = before;
            }
            changed
        })
    }

    /// The folder of its graph and shaders.
    #[getter]
    fn root(&self) -> PyResult<PathBuf> {
        Ok(self.own.lock()?.home.root.clone())
    }
}

/// Measurements of the last frames, as JSON.
fn statistics(state: &mut State, lab: &Opened) -> Result<String, LabError> {
    let run = state.last.clone().unwrap_or_default();
    let (name, info) = (state.setup.name.clone(), lab.gpu.info.clone());
    let session = state.session(lab)?;
    let stats = stats::collect(&info, &name, session, &run.times, run.warmed, run.warnings);
    serde_json::to_string(&stats).map_err(LabError::making("JSON"))
}
