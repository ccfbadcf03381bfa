//! The sky as an environment map.

mod clear_sky;
mod file;
mod level;
mod sun;

use super::{Light, Material, Scene, SceneError};
use glam::{Quat, Vec3};
use std::f32::consts::{PI, TAU};
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub(super) use clear_sky::{ClearSky, clear_sky};
pub(crate) use file::read;
pub(crate) use level::Level;
use sun::Sun;

/// Name of the light extracted from the sun of an environment map.
pub const SUN: &str = "sun of the sky";

/// An environment map with its rotation.
#[derive(Clone, Debug)]
pub struct Environment {
    /// The source file, if any.
    pub file: Option<PathBuf>,
    pub picture: Arc<SkyPicture>,
    /// Rotation about y (degrees); at 90 the middle of the picture points towards -x.
    pub rotation: f32,
}

/// Equirectangular radiance with y up: the middle points to -z, +x is to its right, and the first
/// row is around +y.
#[derive(Clone, Debug, PartialEq)]
pub struct SkyPicture {
    pub(crate) level: Level,
    pub(crate) sun: Option<Sun>,
}

impl PartialEq for Environment {
    fn eq(&self, other: &Environment) -> bool {
        let same_picture =
            Arc::ptr_eq(&self.picture, &other.picture) || self.picture == other.picture;
        (&self.file, self.rotation) == (&other.file, other.rotation) && same_picture
    }
}

impl SkyPicture {
    /// A picture of linear RGB, row by row.
    pub(crate) fn new(level: Level) -> SkyPicture {
        SkyPicture {
            sun: sun::find(&level),
            level,
        }
    }

    /// Width and height in texels.
    pub fn size(&self) -> (u32, u32) {
        (self.level.width, self.level.height)
    }

    /// Texels, row by row.
    pub fn texels(&self) -> &[[f32; 3]] {
        &self.level.texels
    }
}

impl Environment {
    /// An environment without a source file.
    pub(crate) fn of(picture: SkyPicture) -> Environment {
        Environment {
            file: None,
            picture: Arc::new(picture),
            rotation: 0.0,
        }
    }

    /// The file's name for display.
    pub fn name(&self) -> String {
        self.file
            .as_ref()
            .map_or("the scene's own".into(), |path| path.display().to_string())
    }

    /// The sun of the map as a light, with radiance scaled by `factor`.
    pub fn sun(&self, factor: Vec3, rotation: f32) -> Option<Light> {
        let sun = self.picture.sun.as_ref()?;
        Some(Light {
            name: SUN.into(),
            color: sun.irradiance * factor,
            direction: -(Quat::from_rotation_y(rotation.to_radians()) * sun.direction).normalize(),
            ..Light::default()
        })
    }
}

impl Scene {
    /// The scene with another environment map; an empty path keeps the current one.
    pub fn under(mut self, file: &Path) -> Result<Scene, SceneError> {
        if !file.as_os_str().is_empty() {
            let read = file::read(file, &mut self.warnings)
                .map_err(|message| SceneError::Environment { message })?;
            (self.environment, self.sky) = (Some(read), Vec3::ONE);
        }
        Ok(self)
    }

    /// Whether its default camera sees no light: neither lights nor sky nor materials emit, or it is
    /// in a closed room without lights.
    pub fn is_unlit(&self) -> bool {
        let dark = |light: &Light| light.emitted() == Vec3::ZERO;
        let emits = |material: &Material| material.emission != Vec3::ZERO;
        let is_black = self.sky == Vec3::ZERO && self.lights.iter().all(dark);
        self.enclosed || is_black && !self.materials.iter().any(emits)
    }

    /// The scene's lights, then the sun of its environment map.
    pub fn all_lights(&self) -> Vec<Light> {
        let sun = self
            .environment
            .as_ref()
            .and_then(|e| e.sun(self.sky, e.rotation));
        self.lights.iter().cloned().chain(sun).collect()
    }
}

/// The direction at picture coordinates in 0..1.
fn direction(u: f32, v: f32) -> Vec3 {
    let (azimuth, polar) = ((u - 0.5) * TAU, v * PI);
    Vec3::new(
        azimuth.sin() * polar.sin(),
        polar.cos(),
        -azimuth.cos() * polar.sin(),
    )
}

/// Checks the numbers of an environment.
pub(crate) fn check(rotation: f32, intensity: f32) -> Result<(), String> {
    if !rotation.is_finite() || rotation.abs() > 36_000.0 {
        return Err("the environment's rotation must be a number of degrees, at most 36000".into());
    }
    if !(intensity.is_finite() && intensity >= 0.0) {
        return Err("the environment's intensity must be finite and 0 or more".into());
    }
    Ok(())
}
