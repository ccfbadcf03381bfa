//! Saving: experiments and captures.

use crate::experiment::Experiment;
use crate::lab::{Lab, LabError};
use crate::scene::{Light, Scene};
use glam::Vec3;
use std::path::PathBuf;
use std::sync::Arc;

/// Captures an experiment into `captures/NAME`.
///
/// # Errors
/// Those of rendering and writing.
pub fn capture(
    _lab: &Lab,
    _experiment: Experiment,
    _scene: &Arc<Scene>,
    _lights: Option<(Vec<Light>, Vec3)>,
    _name: &str,
    _resources: Vec<String>,
    _frames: usize,
) -> Result<PathBuf, LabError> {
    Err(LabError::Request("not merged yet".into()))
}
