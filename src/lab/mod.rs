//! The lab: a device with a loaded scene and graph. It turns an experiment into frames.

mod attributes;
mod bvh;
mod dielectrics;
mod emitters;
mod fastest;
mod interface;
mod lighting;
mod materials;
mod memory;
mod parts;
mod scene;
mod session;
mod shape;
mod sky;
mod texels;
mod view;
mod workspace;

pub use fastest::{Measured, fastest, recalled};
pub use interface::{environment, load};
pub use parts::{focus_of, parts_of};
pub use scene::SceneGpu;
pub(crate) use session::light_counts;
pub use texels::Texels;
use view::FrameCounters;
pub use view::Viewpoint;
pub use workspace::{Loaded, Workspace};

use crate::diagnostics::{Diagnostic, nearest};
use crate::experiment::{CameraChoice, Experiment, ExperimentError, PlacedCamera};
use crate::files::FileError;
use crate::graph::expr::Env;
use crate::graph::link::{Linked, Target, runs};
use crate::graph::param::{Params, Value};
use crate::graph::plan::{Plan, plan};
use crate::graph::run::{Parts, Program, Update};
use crate::graph::{Evaluated, Graph, report, signed};
use crate::metrics::MetricError;
use crate::scene::{Scene, SceneError};
use crate::vulkan::{ClockExtension, DeviceInfo, Features, Gpu, GpuOptions, VulkanError};
use glam::Vec3;
use std::sync::Arc;

/// What can go wrong between an experiment and its picture.
#[derive(Debug, thiserror::Error)]
pub enum LabError {
    /// Mistakes in graphs, shaders or experiments, with their places.
    #[error("{}", Diagnostic::joined(.0))]
    Input(Vec<Diagnostic>),
    /// A scene that cannot be opened.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The device.
    #[error(transparent)]
    Vulkan(#[from] VulkanError),
    /// Pictures that cannot be compared.
    #[error(transparent)]
    Metric(#[from] MetricError),
    /// A file.
    #[error(transparent)]
    File(#[from] FileError),
    /// What cannot be put into its form, by a fault of the program: a picture, a table, JSON.
    #[error("cannot make {what}: {why}")]
    Make {
        /// What.
        what: String,
        /// Why not.
        why: String,
    },
    /// The validation layer printed messages; their number.
    #[error("the Vulkan validation layer had {0} messages (see above)")]
    Validation(usize),
    /// A callback for progress ended the work. Finished parts are kept.
    #[error("stopped; finished parts are kept")]
    Stopped,
    /// Any other request that cannot be fulfilled.
    #[error("{0}")]
    Request(String),
}

impl From<ExperimentError> for LabError {
    fn from(error: ExperimentError) -> LabError {
        match error {
            ExperimentError::Input(list) => LabError::Input(list),
            ExperimentError::File(error) => LabError::File(error),
            ExperimentError::Request(text) => LabError::Request(text),
        }
    }
}

impl LabError {
    /// The error of an encoder as an error of making something.
    pub fn making<E: std::fmt::Display>(what: impl Into<String>) -> impl FnOnce(E) -> LabError {
        let what = what.into();
        move |why| LabError::Make {
            what,
            why: why.to_string(),
        }
    }

    /// The error of an experiment's scene. If the scene is missing, the place is the experiment's
    /// line.
    pub fn of_scene(experiment: &Experiment, error: SceneError) -> LabError {
        let found = match &error {
            SceneError::NotFound { .. } | SceneError::Read { .. } => {
                experiment.error_in("scene", error.to_string())
            }
            _ => None,
        };
        found.map_or(LabError::Scene(error), |found| LabError::Input(vec![found]))
    }

    /// An error where the validation layer had messages.
    ///
    /// # Errors
    /// More than none.
    pub fn of_messages(count: usize) -> Result<(), LabError> {
        if count == 0 {
            Ok(())
        } else {
            Err(LabError::Validation(count))
        }
    }
}

/// A device that runs experiments.
#[derive(Clone)]
pub struct Lab {
    /// The program's folders.
    pub home: Workspace,
    /// The device.
    pub gpu: Arc<Gpu>,
}

/// Parts of a session that another one can be built from: pipelines, textures, buffers, the scene
/// on the device.
pub struct ReusableParts {
    parts: Parts,
    scene: Arc<Scene>,
    max_edge: Option<f64>,
    scene_gpu: SceneGpu,
    /// Whether the session renders on while the other one is used.
    shared: bool,
}

/// A graph on a scene, ready to make frames.
pub struct Session {
    /// The graph.
    pub graph: Arc<Graph>,
    /// Its passes with their shaders.
    pub linked: Arc<Vec<Linked>>,
    wanted: Vec<String>,
    /// Scene, size and device, as expressions see them.
    pub surroundings: Env,
    /// Present parameter values.
    pub params: Params,
    /// The graph's named values with these.
    values: Vec<Value>,
    /// The running passes.
    pub program: Program,
    /// The scene.
    pub scene: Arc<Scene>,
    scene_gpu: SceneGpu,
    light_updates: Vec<Update>,
    viewpoint: Viewpoint,
    bounds: (Vec3, Vec3),
    size: (u32, u32),
    time: f64,
    counters: FrameCounters,
    sent_params: bool,
}

impl Lab {
    /// Opens a device.
    ///
    /// # Errors
    /// No device, no folders.
    pub fn open(home: Workspace, options: GpuOptions) -> Result<Lab, LabError> {
        let options = GpuOptions {
            cache: home.cache.clone(),
            ..options
        };
        let gpu = Gpu::open(&options)?;
        recalled(&gpu.info, home.cache.as_deref());
        Ok(Lab { home, gpu })
    }

    /// Loads everything for an experiment. `wanted`: resources that will be read back.
    ///
    /// # Errors
    /// Everything that can be wrong with graph, shaders, parameters, scene, camera or device.
    pub fn prepare(
        &self,
        experiment: &Experiment,
        scene: Arc<Scene>,
        wanted: impl FnOnce(&Graph) -> Result<Vec<String>, LabError>,
    ) -> Result<(Session, Vec<Diagnostic>), LabError> {
        let loaded = self
            .home
            .load_for(experiment, &scene, &self.gpu.info)
            .map_err(LabError::Input)?;
        let warnings = loaded.warnings.clone();
        let wanted = wanted(&loaded.graph)?;
        Ok((
            self.build(experiment, &loaded, scene, wanted, None)?,
            warnings,
        ))
    }

    /// The scene on the device, with triangles split at edges longer than `max_edge`.
    fn scene_gpu(
        &self,
        scene: &Arc<Scene>,
        max_edge: Option<f64>,
        rays: bool,
        reuse: Option<&ReusableParts>,
    ) -> Result<SceneGpu, LabError> {
        let split = match reuse {
            Some(reuse) if reuse.shared => return Ok(reuse.scene_gpu.fork(&self.gpu)?),
            Some(reuse) => return Ok(reuse.scene_gpu.clone()),
            None => {
                let limit = self.gpu.info.limits.max_storage_buffer_range;
                let split = max_edge.map(|edge| split(scene, edge as f32, limit));
                split.transpose()?.map(Arc::new)
            }
        };
        let whole = split.unwrap_or_else(|| scene.clone());
        Ok(SceneGpu::new(&self.gpu, whole, scene.origin(), rays)?)
    }

    /// Makes a session, from parts of one in use where they fit; see [`Session::swap_in`]. Shaders
    /// that `loaded` lacks and the experiment runs are compiled.
    ///
    /// # Errors
    /// As [`Lab::prepare`].
    pub fn build(
        &self,
        experiment: &Experiment,
        loaded: &Loaded,
        scene: Arc<Scene>,
        mut wanted: Vec<String>,
        reuse: Option<&ReusableParts>,
    ) -> Result<Session, LabError> {
        let graph = loaded.graph.clone();
        let params = params_of(&graph, experiment)?;
        self.find_fastest(experiment, loaded, &params);
        let surroundings = environment(&scene, experiment.size, &self.gpu.info);
        let set = Evaluated::new(&graph, &params, surroundings.clone());
        let Loaded { linked, .. } = self
            .home
            .with_shaders(loaded, &runs(&set))
            .map_err(LabError::Input)?;
        wanted.extend(graph.checked_with(&wanted));
        let viewpoint = viewpoint_of(experiment, &scene)?;
        let planned = plan(&set, &linked, &wanted, &self.gpu.info).map_err(LabError::Input)?;
        let replan = |params: &Params| {
            let set = Evaluated::new(&graph, params, surroundings.clone());
            let Loaded { linked, .. } = self.home.with_shaders(loaded, &runs(&set)).ok()?;
            let plan = plan(&set, &linked, &wanted, &self.gpu.info).ok()?;
            Some(report::bytes(&plan))
        };
        memory::check((&graph, &params), &planned, &self.gpu.info, &replan)?;
        let rays = traces_rays(&graph, &linked, &planned);
        let fits = |s: &&ReusableParts| {
            Arc::ptr_eq(&s.scene, &scene)
                && s.max_edge == planned.max_edge
                && (s.scene_gpu.has_rays() || !rays)
        };
        let scene_gpu = self.scene_gpu(&scene, planned.max_edge, rays, reuse.filter(fits))?;
        // What textures and buffers hold is of their scene: of another one only the pipelines are
        // taken.
        let parts = match reuse {
            Some(reuse) if Arc::ptr_eq(&reuse.scene, &scene) => reuse.parts.clone(),
            Some(reuse) => reuse.parts.pipelines_only(),
            None => Parts::default(),
        };
        let values = signed(&set, &linked, &planned);
        let program = Program::new(
            &self.gpu,
            &set,
            &linked,
            planned,
            &scene_gpu.resources,
            &parts,
        )?;
        Ok(Session {
            values,
            graph,
            linked,
            wanted,
            surroundings,
            params,
            program,
            bounds: scene.bounds(),
            scene,
            scene_gpu,
            light_updates: Vec::new(),
            viewpoint,
            size: experiment.size,
            time: experiment.time,
            counters: FrameCounters::default(),
            sent_params: false,
        })
    }
}

/// Whether a pass that runs binds a resource that scenes have on request only: those that rays
/// need.
fn traces_rays(graph: &Graph, linked: &[Linked], plan: &Plan) -> bool {
    let bound = plan.steps.iter().flat_map(|s| &linked[s.pass].bound);
    let is_requested = |target: &Target| matches!(target, Target::External(e) if graph.interface.resources[*e].on_request);
    bound
        .flat_map(|b| &b.cases)
        .any(|c| is_requested(&c.target))
}

/// The parameters of an experiment: defaults, then its settings.
///
/// # Errors
/// Unknown names and wrong values, all of them, with their places.
pub fn params_of(graph: &Graph, experiment: &Experiment) -> Result<Params, LabError> {
    Ok(experiment.params_over(&graph.params)?)
}

/// The camera of an experiment in its scene.
///
/// # Errors
/// No camera of that name; numbers that are no camera.
pub fn camera_of(experiment: &Experiment, scene: &Scene) -> Result<PlacedCamera, LabError> {
    viewpoint_of(experiment, scene).map(|v| PlacedCamera::from(&v.camera))
}

/// The camera of an experiment in a scene.
///
/// # Errors
/// The scene has no camera of that name; numbers that are not finite.
pub fn viewpoint_of(experiment: &Experiment, scene: &Scene) -> Result<Viewpoint, LabError> {
    match &experiment.camera {
        CameraChoice::Named(name) => match scene.cameras.get(name).or_else(|| {
            // Scenes without a camera of the default name are seen from their first.
            (name == "default")
                .then(|| scene.cameras.values().next())
                .flatten()
        }) {
            Some(camera) => Ok(Viewpoint::new(camera)),
            None if scene.cameras.is_empty() => Ok(Viewpoint::around(scene)),
            None => {
                let hint =
                    nearest(name, scene.cameras.keys().map(String::as_str)).unwrap_or_default();
                let message = format!("scene '{}' has no camera '{name}' ({hint})", scene.name);
                Err(match experiment.error_in("camera", &message) {
                    Some(found) => LabError::Input(vec![found]),
                    None => LabError::Request(message),
                })
            }
        },
        CameraChoice::Placed(placed) => {
            placed.check().map_err(LabError::Request)?;
            Ok(Viewpoint::placed(placed, scene))
        }
    }
}

/// The error for a texture that the graph does not have.
pub fn no_texture(graph: &Graph, name: &str) -> LabError {
    let hint = nearest(name, graph.textures.iter().map(|t| t.0.as_str()));
    LabError::Request(format!(
        "no texture '{name}'{}",
        hint.map_or(String::new(), |h| format!(" ({h})"))
    ))
}

/// The scene with triangles no longer than `edge`, unless the device cannot hold their vertices:
/// splitting takes long.
fn split(scene: &Scene, edge: f32, limit: u32) -> Result<Scene, LabError> {
    let bytes = scene.least_split_bytes(edge);
    if bytes > f64::from(limit) {
        return Err(LabError::Request(format!(
            "{}: triangles with edges of at most {edge} m, as the graph asks for, take {:.0} MB of vertices or more, and \
             this device's largest buffer has {:.0} MB. Ask for longer ones, or take a smaller scene",
            scene.name,
            bytes / 1e6,
            f64::from(limit) / 1e6
        )));
    }
    Ok(scene.split_triangles(edge))
}

/// A device with every feature, for checks that need none of their own.
pub fn any_device() -> DeviceInfo {
    let all = Features {
        pipeline_statistics: true,
        clock: ClockExtension::None,
        shares_memory: true,
        portability: false,
        conservative_rasterization: true,
        geometry: true,
        tessellation: true,
        fragment_stores: true,
        vertex_stores: true,
        clip_distance: true,
        depth_clamp: true,
        bc: true,
        anisotropy: true,
        write_without_format: true,
        multi_draw_indirect: true,
        independent_blend: true,
        full_index: true,
        int64_atomics: true,
    };
    DeviceInfo::imaginary(all)
}
