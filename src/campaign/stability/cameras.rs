//! Cameras that do not continue from the experiment's: a cut, or a path from a file.

use super::motion::Motion;
use crate::camera_path::CameraPath;
use crate::experiment::{Experiment, PlacedCamera};
use crate::lab::{LabError, camera_of};
use crate::scene::Scene;
use std::path::Path;

/// Cameras of a motion with its own ones.
#[derive(Clone, Debug)]
pub enum Cameras {
    /// Another camera from one frame on.
    Cut {
        /// The camera after the cut.
        to: PlacedCamera,
        /// The first frame of that camera.
        at: usize,
    },
    Path {
        path: CameraPath,
        /// Time of the path at frame 0, s.
        from: f64,
        /// Time from frame to frame, s.
        step: f64,
    },
}

impl Cameras {
    /// Cameras of a cut or a path, `None` for other motions.
    pub fn of(
        motion: &Motion,
        experiment: &Experiment,
        scene: &Scene,
        folder: &Path,
    ) -> Result<Option<Cameras>, LabError> {
        Ok(match motion {
            Motion::Cut { to, at } => {
                let there = Experiment {
                    camera: to.clone(),
                    ..experiment.clone()
                };
                Some(Cameras::Cut {
                    to: camera_of(&there, scene)?,
                    at: *at,
                })
            }
            Motion::Path { file, from, step } => {
                let path = CameraPath::read(&folder.join(file)).map_err(LabError::Input)?;
                Some(Cameras::Path {
                    path,
                    from: *from,
                    step: *step,
                })
            }
            _ => None,
        })
    }

    /// Camera of a frame; `start` is the experiment's.
    pub fn at(&self, start: &PlacedCamera, number: i64) -> PlacedCamera {
        match self {
            Cameras::Cut { to, at } => {
                if number < *at as i64 {
                    *start
                } else {
                    *to
                }
            }
            Cameras::Path { path, from, step } => path.at(from + number as f64 * step),
        }
    }
}
