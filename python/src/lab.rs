//! A device with the program's folders.

use crate::errors::{exception, raised};
use crate::owned::Owned;
use crate::progress::Reporter;
use conelab::experiment::Experiment as Setup;
use conelab::lab::{Lab as Opened, LabError, Workspace};
use conelab::scene::{Scene, SceneError};
use conelab::vulkan::{Faults, GpuOptions, VulkanError};
use pyo3::prelude::{PyResult, Python, pyclass, pymethods};
use std::collections::{BTreeMap, HashMap};
use std::path::PathBuf;
use std::sync::{Arc, Weak};
use std::time::Duration;

/// A device with the program's folders, for one thread.
#[pyclass(frozen, module = "conelab._conelab")]
pub struct Lab(Owned<State>);

struct State {
    home: Workspace,
    options: GpuOptions,
    /// Nothing once closed.
    opened: Option<Opened>,
    /// Whether the device was lost: it is opened again when it is needed.
    lost: bool,
    /// Scenes that experiments use, as their files describe them.
    scenes: HashMap<String, Weak<Scene>>,
}

impl Lab {
    /// The lab, on a device that works.
    pub fn opened(&self) -> PyResult<Opened> {
        let mut state = self.0.lock()?;
        if state.lost {
            let again = Opened::open(state.home.clone(), state.options.clone());
            state.opened = Some(again.map_err(exception)?);
            state.lost = false;
        }
        let opened = state.opened.clone();
        opened.ok_or_else(|| raised("RequestError", "the Lab is closed: make another one"))
    }

    /// Remembers that an error says that the device is lost.
    pub fn noticed<T>(&self, result: Result<T, LabError>) -> PyResult<T> {
        if let Err(LabError::Vulkan(VulkanError::Lost(_) | VulkanError::Hung(_))) = &result {
            self.lost()?;
        }
        result.map_err(exception)
    }

    /// What the device was opened with.
    pub fn options(&self) -> PyResult<(Workspace, GpuOptions)> {
        let state = self.0.lock()?;
        Ok((state.home.clone(), state.options.clone()))
    }

    /// The device was lost: the next use opens it again.
    pub fn lost(&self) -> PyResult<()> {
        self.0.lock()?.lost = true;
        Ok(())
    }

    /// Ends a call: an error, or messages of the validation layer, become exceptions.
    pub fn done<T>(&self, lab: &Opened, result: Result<T, LabError>) -> PyResult<T> {
        let value = self.noticed(result)?;
        let messages = lab.gpu.messages();
        if messages.is_empty() {
            return Ok(value);
        }
        Err(raised("ValidationError", messages.join("\n")))
    }

    /// The scene of an experiment without the experiment's changes to its light.
    pub fn scene(
        &self,
        setup: &Setup,
        reporter: &mut Reporter,
        py: Python<'_>,
    ) -> PyResult<Arc<Scene>> {
        let mut state = self.0.lock()?;
        if let Some(scene) = state.scenes.get(&setup.scene).and_then(Weak::upgrade) {
            return Ok(scene);
        }
        let reporter = std::sync::Mutex::new(reporter);
        let progress = |what: &str, part: f32| match reporter.try_lock() {
            Ok(mut reporter) => {
                reporter.count(what, (part.clamp(0.0, 1.0) * 1000.0) as usize, 1000)
            }
            Err(_) => std::ops::ControlFlow::Continue(()),
        };
        let opened = py.detach(|| Scene::open(&setup.scene, &progress));
        let scene = opened.map_err(|error| exception(LabError::of_scene(setup, error)))?;
        let scene = Arc::new(scene);
        state
            .scenes
            .insert(setup.scene.clone(), Arc::downgrade(&scene));
        Ok(scene)
    }
}

#[pymethods]
impl Lab {
    #[new]
    #[pyo3(signature = (device, home, fallback, captures, validate, without, memory, hang_after))]
    #[expect(clippy::too_many_arguments, reason = "the options of a device")]
    fn new(
        py: Python<'_>,
        device: Option<String>,
        home: Option<PathBuf>,
        fallback: Option<PathBuf>,
        captures: Option<PathBuf>,
        validate: bool,
        without: Vec<String>,
        memory: Option<f64>,
        hang_after: Option<f64>,
    ) -> PyResult<Lab> {
        let found = match home {
            Some(root) => Workspace::at(root),
            None => Workspace::find_or(fallback),
        };
        let mut home = found.map_err(exception)?;
        home.captures = captures.unwrap_or(home.captures);
        let above_zero = |name: &str, v: Option<f64>| match v.filter(|v| !(*v > 0.0 && *v < 1e6)) {
            Some(v) => Err(raised(
                "RequestError",
                format!("{name} is {v}: it must be above 0"),
            )),
            None => Ok(()),
        };
        above_zero("memory", memory)?;
        above_zero("hang_after", hang_after)?;
        let options = GpuOptions {
            device,
            validation: validate,
            without,
            memory: memory.map(|gib| (gib * f64::from(1 << 30)) as u64),
            patience: hang_after.map(Duration::from_secs_f64),
            faults: Some(Arc::new(Faults::default())),
            ..GpuOptions::default()
        };
        let opened = py
            .detach(|| Opened::open(home.clone(), options.clone()))
            .map_err(exception)?;
        Ok(Lab(Owned::new(
            "Lab",
            State {
                home,
                options,
                opened: Some(opened),
                lost: false,
                scenes: HashMap::new(),
            },
        )))
    }

    /// Leaves the device. Experiments of the lab can no longer be used.
    fn close(&self) -> PyResult<()> {
        let mut state = self.0.lock()?;
        (state.opened, state.lost) = (None, false);
        state.scenes.clear();
        Ok(())
    }

    /// The folders: of graphs, shaders and experiments; of what is made.
    #[getter]
    fn folders(&self) -> PyResult<(PathBuf, PathBuf)> {
        let state = self.0.lock()?;
        Ok((state.home.root.clone(), state.home.captures.clone()))
    }

    /// Name, kind, driver and API version of the device.
    fn device(&self) -> PyResult<BTreeMap<&'static str, String>> {
        let info = &self.opened()?.gpu.info;
        Ok(BTreeMap::from([
            ("name", info.name.clone()),
            ("kind", info.kind.to_string()),
            ("driver", info.driver.clone()),
            ("api", info.api.to_string()),
        ]))
    }

    /// Makes the next wait for the device report that it is lost: for tests.
    fn lose_device(&self) -> PyResult<()> {
        if let Some(faults) = &self.0.lock()?.options.faults {
            faults.lose();
        }
        Ok(())
    }
}

/// A scene for campaigns.
pub fn open_scene(name: &str) -> Result<Scene, LabError> {
    let open = Scene::open(name, &|_, _| std::ops::ControlFlow::Continue(()));
    open.map_err(|error: SceneError| LabError::Scene(error))
}
