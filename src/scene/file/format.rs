//! Structure of a scene file. Values are checked during parsing, so that errors have a line and a
//! column.

use std::sync::Arc;

use glam::{Mat4, Vec3};
use indexmap::IndexMap;
use serde::Deserialize;

use super::parts::{InstanceEntry, Part};
use super::placement::{Moves, Placed};
use crate::scene::environment::{ClearSky, check as check_environment};
use crate::scene::shapes::patterns::Picture;
use crate::scene::{Camera, Light, MAX_COORDINATE, Material, Track, builtin};

/// A whole scene file.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct SceneFile {
    pub name: Option<String>,
    pub models: Vec<ModelEntry>,
    pub lights: Vec<Light>,
    /// Radiance of the sky; defaults to that of the first model.
    pub sky: Option<Sky>,
    /// Environment map, multiplied by the radiance.
    pub environment: Option<EnvironmentEntry>,
    pub cameras: IndexMap<String, CameraEntry>,
    pub materials: IndexMap<String, Material>,
    pub textures: Vec<Picture>,
    /// Named lists of parts, for meshes and other groups.
    pub groups: IndexMap<String, Vec<Part>>,
    pub meshes: IndexMap<String, Vec<Part>>,
    /// Placements; a mesh without any is placed as it was built.
    pub instances: Vec<InstanceEntry>,
}

/// Radiance of the sky.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(try_from = "Vec3")]
pub(super) struct Sky(pub Vec3);

impl TryFrom<Vec3> for Sky {
    type Error = String;

    fn try_from(sky: Vec3) -> Result<Self, String> {
        if sky.is_finite() && sky.min_element() >= 0.0 {
            Ok(Sky(sky))
        } else {
            Err("the sky's radiance must be finite and 0 or more".into())
        }
    }
}

/// Source of an environment map.
#[derive(Clone, Debug)]
pub(super) enum SkyOf {
    File(String),
    Clear(ClearSky),
}

/// An environment map.
#[derive(Clone, Debug, Deserialize)]
#[serde(try_from = "EnvironmentFields")]
pub(super) struct EnvironmentEntry {
    pub of: SkyOf,
    /// Rotation about y (degrees).
    pub rotation: f32,
    pub intensity: f32,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct EnvironmentFields {
    #[serde(default)]
    file: Option<String>,
    #[serde(default)]
    clear_sky: Option<ClearSky>,
    #[serde(default)]
    rotation: f32,
    #[serde(default = "whole")]
    intensity: f32,
}

fn whole() -> f32 {
    1.0
}

impl TryFrom<EnvironmentFields> for EnvironmentEntry {
    type Error = String;

    fn try_from(fields: EnvironmentFields) -> Result<Self, String> {
        let EnvironmentFields {
            file,
            clear_sky,
            rotation,
            intensity,
        } = fields;
        check_environment(rotation, intensity)?;
        let of = match (file, clear_sky) {
            (Some(file), None) => SkyOf::File(file),
            (None, Some(sky)) => SkyOf::Clear(sky),
            _ => return Err("an environment needs either a file or a clear_sky".into()),
        };
        Ok(EnvironmentEntry {
            of,
            rotation,
            intensity,
        })
    }
}

/// A model with its placement.
#[derive(Debug, Deserialize)]
#[serde(try_from = "ModelFields")]
pub(super) struct ModelEntry {
    pub file: Option<String>,
    pub builtin: Option<String>,
    /// The animation to play instead of the first.
    pub clip: Option<String>,
    pub transform: Mat4,
    pub motion: Option<Arc<Track>>,
    pub lights: bool,
    pub lights_scale: Option<f32>,
    pub cameras: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ModelFields {
    #[serde(default)]
    file: Option<String>,
    #[serde(default)]
    builtin: Option<String>,
    #[serde(default)]
    clip: Option<String>,
    #[serde(default)]
    transform: Placed,
    #[serde(default)]
    animation: Option<Moves>,
    /// Whether to import the model's lights.
    #[serde(default = "yes")]
    lights: bool,
    /// Factor of the model's light colours, for example 1/683 for photometric units.
    #[serde(default)]
    lights_scale: Option<f32>,
    /// Whether to import the model's cameras.
    #[serde(default = "yes")]
    cameras: bool,
}

fn yes() -> bool {
    true
}

impl Default for ModelEntry {
    /// The identity placement with lights and cameras.
    fn default() -> Self {
        ModelEntry {
            file: None,
            builtin: None,
            clip: None,
            transform: Mat4::IDENTITY,
            motion: None,
            lights: true,
            lights_scale: None,
            cameras: true,
        }
    }
}

impl TryFrom<ModelFields> for ModelEntry {
    type Error = String;

    fn try_from(fields: ModelFields) -> Result<Self, String> {
        match (&fields.file, &fields.builtin) {
            (Some(_), None) => {}
            (None, Some(name)) if builtin::is_one(name) && fields.clip.is_none() => {}
            (None, Some(name)) if builtin::is_one(name) => {
                return Err("`clip` is of models from files".into());
            }
            (None, Some(name)) => {
                return Err(format!("unknown builtin '{name}': {}", builtin::hint(name)));
            }
            _ => return Err("a model needs either a file or a builtin".into()),
        }
        if fields
            .lights_scale
            .is_some_and(|scale| !(0.0..=1e6).contains(&scale))
        {
            return Err("lights_scale is from 0 to 1e6".into());
        }
        Ok(ModelEntry {
            transform: fields.transform.0,
            motion: fields.animation.map(|moves| moves.0),
            file: fields.file,
            builtin: fields.builtin,
            clip: fields.clip,
            lights: fields.lights,
            lights_scale: fields.lights_scale,
            cameras: fields.cameras,
        })
    }
}

#[derive(Debug, Deserialize)]
#[serde(try_from = "CameraFields")]
pub(super) struct CameraEntry(CameraFields);

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct CameraFields {
    eye: Vec3,
    target: Vec3,
    #[serde(default = "y_up")]
    up: Vec3,
    /// Degrees.
    fov_y: f32,
    #[serde(default)]
    near: Option<f32>,
    #[serde(default)]
    far: Option<f32>,
}

fn y_up() -> Vec3 {
    Vec3::Y
}

impl TryFrom<CameraFields> for CameraEntry {
    type Error = String;

    fn try_from(camera: CameraFields) -> Result<Self, String> {
        let forward = camera.target - camera.eye;
        let near = [camera.eye, camera.target].map(|p| p.abs().max_element() <= MAX_COORDINATE);
        if near != [true; 2] {
            return Err(format!(
                "a camera must be within {MAX_COORDINATE:e} m of the origin"
            ));
        }
        if forward == Vec3::ZERO {
            let size = camera.eye.abs().max_element();
            let step = size.next_up() - size;
            return Err(format!(
                "a camera's eye and target are one place: coordinates there are {step:e} m apart"
            ));
        }
        if !forward.cross(camera.up).is_finite() || forward.cross(camera.up).length_squared() == 0.0
        {
            return Err("a camera must look somewhere other than along its up vector".into());
        }
        if !(camera.fov_y >= 1.0 && camera.fov_y <= 170.0) {
            return Err("a camera's fov_y must be between 1 and 170 degrees".into());
        }
        let near = camera.near.unwrap_or(f32::MIN_POSITIVE);
        if !(near > 0.0 && camera.far.unwrap_or(f32::MAX) > near) {
            return Err("a camera's near must be above 0 and its far above near".into());
        }
        Ok(CameraEntry(camera))
    }
}

impl CameraEntry {
    /// The camera; `near` is used if it has no near plane.
    pub fn to_camera(&self, near: f32) -> Camera {
        let CameraFields {
            eye,
            target,
            up,
            fov_y,
            ..
        } = self.0;
        let far = self.0.far.unwrap_or(f32::INFINITY);
        Camera {
            eye,
            target,
            up: up.normalize_or(Vec3::Y),
            fov_y,
            near: self.0.near.unwrap_or(near.min(far * 0.5)),
            far,
        }
    }
}
