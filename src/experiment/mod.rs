//! Experiments: graph, scene, camera, size, time, lighting changes, and the parameter values that
//! differ from the defaults.

mod adapt;
mod fields;
mod places;
mod read;
mod spans;
mod write;

pub(crate) use fields::{FIELDS, Field};
pub(crate) use write::placed_text;
pub(crate) use write::resolved_text;
pub use write::write;

use crate::diagnostics::{At, DID_YOU_MEAN, Diagnostic, Loc, Sources, nearest};
use crate::files::FileError;
use crate::graph::param::Params;
use crate::scene::{Camera, LightFields, MAX_COORDINATE, environment};
use glam::Vec3;
use serde::Deserialize;

/// Error of an experiment or camera path.
#[derive(Debug, thiserror::Error)]
pub enum ExperimentError {
    /// Errors in its file, with positions.
    #[error("{}", Diagnostic::joined(.0))]
    Input(Vec<Diagnostic>),
    /// A file that cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// A request that cannot be fulfilled.
    #[error("{0}")]
    Request(String),
}

/// Camera choice of an experiment.
#[derive(Clone, Debug, PartialEq)]
pub enum CameraChoice {
    /// A camera of the scene.
    Named(String),
    /// A camera given by numbers.
    Placed(PlacedCamera),
}

/// A camera given by numbers.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct PlacedCamera {
    /// Position, m.
    pub eye: (f32, f32, f32),
    /// Look-at point (m).
    pub target: (f32, f32, f32),
    /// Up direction; need not be orthogonal to the view.
    #[serde(default = "y_up")]
    pub up: (f32, f32, f32),
    /// Vertical field of view (degrees).
    pub fov_y: f32,
    /// Distance of the near plane (m); derived from the scene's size if absent.
    #[serde(default)]
    pub near: Option<f32>,
    /// Distance of the far plane (m); unused when rendering, kept for export.
    #[serde(default)]
    pub far: Option<f32>,
}

fn y_up() -> (f32, f32, f32) {
    (0.0, 1.0, 0.0)
}

impl PlacedCamera {
    /// An upright camera with the default near plane.
    pub fn new(eye: (f32, f32, f32), target: (f32, f32, f32), fov_y: f32) -> PlacedCamera {
        PlacedCamera {
            eye,
            target,
            up: y_up(),
            fov_y,
            near: None,
            far: None,
        }
    }

    /// Checks its numbers.
    pub fn check(&self) -> Result<(), String> {
        let numbers = [self.eye, self.target, self.up].map(|v| Vec3::from(v).is_finite());
        if numbers.contains(&false) || !self.fov_y.is_finite() {
            return Err("the camera's numbers must be finite".into());
        }
        let (eye, target) = (Vec3::from(self.eye), Vec3::from(self.target));
        if eye.abs().max(target.abs()).max_element() > MAX_COORDINATE {
            return Err(format!(
                "the camera must be within {MAX_COORDINATE:e} m of the origin"
            ));
        }
        if eye == target {
            return Err("the camera's eye and target are one place".into());
        }
        let (near, far) = (
            self.near.unwrap_or(f32::MIN_POSITIVE),
            self.far.unwrap_or(f32::MAX),
        );
        if !(near > 0.0 && far > near && far.is_finite()) {
            return Err("the camera's planes must obey 0 < near < far".into());
        }
        Ok(())
    }
}

impl From<&Camera> for PlacedCamera {
    fn from(c: &Camera) -> PlacedCamera {
        PlacedCamera {
            eye: c.eye.into(),
            target: c.target.into(),
            up: c.up.into(),
            fov_y: c.fov_y,
            near: Some(c.near),
            far: Some(c.far).filter(|f| f.is_finite()),
        }
    }
}

/// Changes to the environment map; absent fields keep the scene's value.
#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct EnvironmentChange {
    /// HDR or EXR file of another environment map, with default rotation 0 and intensity 1.
    pub file: Option<String>,
    /// Rotation about y (degrees).
    pub rotation: Option<f32>,
    /// Factor of the map, not negative; multiplies the experiment's `sky`.
    pub intensity: Option<f32>,
}

impl EnvironmentChange {
    /// These changes, overridden by `over`.
    pub(crate) fn overlaid(self, over: EnvironmentChange) -> EnvironmentChange {
        EnvironmentChange {
            file: over.file.or(self.file),
            rotation: over.rotation.or(self.rotation),
            intensity: over.intensity.or(self.intensity),
        }
    }

    /// Checks its numbers.
    pub fn check(&self) -> Result<(), String> {
        environment::check(self.rotation.unwrap_or(0.0), self.intensity.unwrap_or(1.0))
    }
}

/// A reproducible rendering setup.
#[derive(Clone, Debug)]
pub struct Experiment {
    /// Name: the file's stem.
    pub name: String,
    /// Graph file in the passes folder.
    pub graph: String,
    /// Built-in name, or a path.
    pub scene: String,
    /// Camera of the picture.
    pub camera: CameraChoice,
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// Animation time (s).
    pub time: f64,
    /// Radiance of the sky, replaces the scene's.
    pub sky: Option<(f32, f32, f32)>,
    /// Changes to the environment map.
    pub environment: Option<Loc<EnvironmentChange>>,
    /// Changes to the scene's lights, by name.
    pub lights: Vec<(Loc<String>, LightFields)>,
    /// (name, value as RON), with positions.
    pub params: Vec<(Loc<String>, String)>,
    /// Sources of positions in messages.
    pub sources: Sources,
}

/// Largest side of a picture (pixels).
pub(crate) const MAX_SIZE: u32 = 16384;

/// Default picture size.
const DEFAULT_SIZE: (u32, u32) = (1280, 720);

/// Name of the default camera.
const DEFAULT_CAMERA: &str = "default";

impl Experiment {
    /// Sets a parameter to a RON value, replacing an earlier one.
    pub fn set(&mut self, name: &str, value: &str) {
        let file = self
            .sources
            .add("set by the program".as_ref(), format!("{name} = {value}"));
        self.params.push((
            Loc {
                value: name.into(),
                at: At { file, offset: 0 },
            },
            value.into(),
        ));
    }

    /// The values of all parameters: `defaults` overridden by the experiment.
    ///
    /// # Errors
    /// All unknown names and invalid values, with positions.
    pub fn params_over(&self, defaults: &Params) -> Result<Params, ExperimentError> {
        let mut params = defaults.clone();
        let mut errors = Vec::new();
        for (name, text) in &self.params {
            if let Err(message) = params.set(&name.value, text) {
                let mut error = self.sources.error(name.at, message);
                // A misspelt field looks like a parameter.
                if params.index(&name.value).is_none() && !error.message.contains(DID_YOU_MEAN) {
                    let field = nearest(&name.value, FIELDS.iter().map(|f| f.name));
                    error = error.help(field.filter(|help| help.starts_with(DID_YOU_MEAN)));
                }
                errors.push(error);
            }
        }
        if errors.is_empty() {
            Ok(params)
        } else {
            Err(ExperimentError::Input(errors))
        }
    }
}

/// Checks the size of a picture.
pub(crate) fn check_size((width, height): (u32, u32)) -> Result<(), String> {
    if width == 0 || height == 0 || width > MAX_SIZE || height > MAX_SIZE {
        return Err(format!(
            "a picture of {width}x{height} cannot be made: each side is 1 to {MAX_SIZE} pixels"
        ));
    }
    Ok(())
}

/// Longest name of an experiment or capture, bytes.
const MAX_NAME: usize = 64;

/// A name for a new file or folder: letters, digits, `-` and `_`; spaces become `-`.
///
/// # Errors
/// Empty, more than 64 bytes, or another character: the text for the user.
pub fn checked_name(name: &str) -> Result<String, ExperimentError> {
    let name = name.trim().replace(' ', "-");
    let wrong = |why: &str| ExperimentError::Request(format!("'{name}' cannot be a name: {why}"));
    if name.is_empty() {
        return Err(wrong("it is empty"));
    }
    if name.len() > MAX_NAME {
        return Err(wrong(&format!("it has more than {MAX_NAME} bytes")));
    }
    match name
        .chars()
        .find(|c| !c.is_alphanumeric() && !"-_".contains(*c))
    {
        Some(c) => Err(wrong(&format!(
            "{c:?} is not allowed; use letters, digits, - and _"
        ))),
        None => Ok(name),
    }
}
