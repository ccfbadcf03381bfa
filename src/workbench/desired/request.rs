//! The desired state of the window. The engine always works towards the latest request.

use crate::camera_path::CameraPath;
use crate::diagnostics::{At, Loc, Sources, options};
use crate::experiment::{CameraChoice, Experiment, PlacedCamera};
use crate::graph::param::{OFF, Params, Value};
use crate::graph::run::Execution;
use crate::lab::Session;
use crate::scene::{Camera, Light, Scene};
use crate::vulkan::DeviceId;
use crate::workbench::read_back::ReadBack;
use glam::Vec3;

/// A graph with the parameters that are not at their defaults.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SideRequest {
    /// Graph file in the passes folder.
    pub graph: String,
    /// (name, value).
    pub params: Vec<(String, Value)>,
    /// Passes that are left out.
    pub off: Vec<String>,
}

impl SideRequest {
    /// The side of an experiment.
    pub fn of(experiment: &Experiment) -> SideRequest {
        let mut side = SideRequest {
            graph: experiment.graph.clone(),
            ..SideRequest::default()
        };
        for (name, text) in &experiment.params {
            match options().from_str(text) {
                Ok(off) if name.value == OFF => side.off = off,
                // The build reports a list of passes that cannot be read.
                _ => side.params.push((name.value.clone(), Value::read(text))),
            }
        }
        side
    }

    /// Sets the values in a graph's parameters. False if one of them has no place there.
    pub fn apply(&self, params: &mut Params) -> bool {
        let mut fits = self.off.iter().all(|pass| params.passes.contains(pass));
        for (name, value) in &self.params {
            let place = params.index(name);
            match place.and_then(|i| Some((i, params.list[i].fit(value)?))) {
                Some((i, value)) => params.values[i] = value,
                None => fits = false,
            }
        }
        let off = params.passes.iter().filter(|pass| self.off.contains(pass));
        params.off = off.cloned().collect();
        fits
    }

    /// The values as an experiment has them.
    fn texts(&self) -> Vec<(&str, String)> {
        let off = (!self.off.is_empty()).then(|| (OFF, format!("{:?}", self.off)));
        let values = self.params.iter().map(|(n, v)| (n.as_str(), v.to_ron()));
        values.chain(off).collect()
    }
}

/// The course of the scene's time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Clock {
    /// Whether time goes on.
    pub playing: bool,
    /// Seconds from frame to frame; real time when absent.
    pub step: Option<f64>,
    /// Number of requested single steps.
    pub steps: u64,
    /// Time to start from, s, taken when `jumps` grows.
    pub at: f64,
    /// Number of jumps in time.
    pub jumps: u64,
}

/// The mip, layer or slice of a texture that the inspector reads back.
#[derive(Clone, Debug, PartialEq)]
pub struct InspectTarget {
    /// 0 or 1.
    pub side: usize,
    /// Name of the texture.
    pub texture: String,
    /// Mip level.
    pub mip: u32,
    /// Array layer of a 2D texture.
    pub layer: u32,
    /// Axis across which a 3D texture is cut: 0 x, 1 y, 2 z.
    pub axis: usize,
    /// Texel along that axis.
    pub slice: u32,
}

/// What of a scene's light changes while it is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct LightState {
    /// The scene's lights.
    pub lights: Vec<Light>,
    /// Radiance of the sky, or what its picture is multiplied by.
    pub sky: Vec3,
    /// Rotation of the sky's picture about y, degrees.
    pub rotation: f32,
    /// Whether the headlight of an unlit scene was removed.
    pub without_headlight: bool,
}

impl LightState {
    /// As the scene has it.
    pub fn of(scene: &Scene) -> LightState {
        let rotation = scene.environment.as_ref().map_or(0.0, |e| e.rotation);
        LightState {
            lights: scene.lights.clone(),
            sky: scene.sky,
            rotation,
            without_headlight: false,
        }
    }

    /// Lights a session from its next frame on; false where it would take a new one.
    pub fn light(&self, session: &mut Session) -> bool {
        let follows = session.set_lights(&self.lights, self.sky);
        if follows {
            session.turn_sky(self.rotation);
        }
        follows
    }
}

/// All inputs of the picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RenderRequest {
    /// A and, when compared, B.
    pub sides: [Option<SideRequest>; 2],
    /// Built-in name or path of the scene.
    pub scene: String,
    /// File of a picture of the sky in place of the scene's own; empty: none.
    pub environment: String,
    /// Light that differs from the scene's own.
    pub lights: Option<LightState>,
    /// The camera; the scene's own until it is known.
    pub camera: Option<Camera>,
    /// A path that the camera follows in the scene's time.
    pub path: Option<CameraPath>,
    /// Picture size.
    pub size: (u32, u32),
    /// Time.
    pub clock: Clock,
    /// Render on when nothing changes, to measure.
    pub continuous: bool,
    /// What frames do.
    pub execution: Execution,
    /// Number of changes of graph and shader files.
    pub revision: u64,
    /// Number of changes of the scene's files.
    pub scene_revision: u64,
    /// The resources that the visible panes show.
    pub read_back: Vec<ReadBack>,
    /// The device that paints the pictures; with one of the same kind they stay in its memory.
    pub window: Option<DeviceId>,
    /// Whether every picture is wanted in main memory; the last one before a rest comes there all
    /// the same.
    pub bytes: bool,
}

impl RenderRequest {
    /// The scene and the picture of its sky.
    pub fn source(&self) -> (&str, &str) {
        (&self.scene, &self.environment)
    }

    /// The experiment of a side, as a session is made from it.
    pub fn experiment(&self, side: &SideRequest) -> Experiment {
        let mut sources = Sources::default();
        let texts = side.texts();
        let lines: Vec<String> = texts.iter().map(|(n, v)| format!("{n}: {v}")).collect();
        let file = sources.add("the panel".as_ref(), lines.join("\n"));
        let mut offset = 0;
        let mut params = Vec::new();
        for ((name, text), line) in texts.into_iter().zip(lines) {
            let (value, at) = (name.to_string(), At { file, offset });
            params.push((Loc { value, at }, text));
            offset += u32::try_from(line.len() + 1).unwrap_or(0);
        }
        Experiment {
            name: "workbench".into(),
            graph: side.graph.clone(),
            scene: self.scene.clone(),
            camera: self
                .camera
                .map_or(CameraChoice::Named("default".into()), |c| {
                    CameraChoice::Placed(PlacedCamera::from(&c))
                }),
            size: self.size,
            time: self.clock.at,
            sky: None,
            environment: None,
            lights: Vec::new(),
            params,
            sources,
        }
    }
}
