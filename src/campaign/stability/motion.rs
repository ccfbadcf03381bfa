//! Motions, and the state of a scene at each frame.

use crate::diagnostics::RawText;
use crate::experiment::{CameraChoice, PlacedCamera};
use crate::graph::param::Value;
use crate::scene::{Light, Scene};
use glam::{Mat4, Quat, Vec3};
use serde::Deserialize;

/// Change from frame to frame.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Motion {
    #[default]
    Still,
    /// The camera, by these steps per frame.
    Camera {
        #[serde(default)]
        dolly: f32,
        #[serde(default)]
        strafe: f32,
        #[serde(default)]
        rise: f32,
        /// To the left, degrees.
        #[serde(default)]
        yaw: f32,
        #[serde(default)]
        pitch: f32,
        /// Unit of the lengths.
        #[serde(default)]
        unit: Unit,
    },
    /// Animated instances of the scene.
    Actors {
        /// Time from frame to frame, s.
        step: f64,
        /// Size of animated meshes, along their own axes.
        #[serde(default = "one")]
        scale: (f32, f32, f32),
    },
    /// A light, by these steps per frame.
    Light {
        /// Name of the light.
        name: String,
        /// Shift in m, for lights with a position.
        #[serde(default)]
        shift: (f32, f32, f32),
        /// Rotation about the y axis in degrees, for lights with a direction.
        #[serde(default)]
        turn: f32,
    },
    Switch {
        /// Name of the light.
        name: String,
        /// The first frame of the new light, counted from the first measured one, at least 1.
        at: usize,
        /// Factor of the scene's colour before the switch.
        from: f32,
        /// Factor of the scene's colour from then on.
        to: f32,
    },
    /// The camera jumps to another one.
    Cut {
        /// A camera of the scene, or a new one.
        to: CameraChoice,
        /// Its first frame, counted from the first measured one, at least 1.
        at: usize,
    },
    /// The camera along a path, instead of the experiment's.
    Path {
        /// File of the path, relative to the suite.
        file: String,
        /// Time of the path at the first measured frame, s.
        #[serde(default)]
        from: f64,
        /// Time from frame to frame, s.
        step: f64,
    },
    /// A parameter of the method's graph.
    Parameter {
        name: String,
        /// Step of a number or vector per frame.
        #[serde(default)]
        step: Option<RawText>,
        /// Values of the measured frames instead of a step. The first also holds before them, the
        /// last after them.
        #[serde(default)]
        values: Vec<RawText>,
    },
}

fn one() -> (f32, f32, f32) {
    (1.0, 1.0, 1.0)
}

/// Unit of a camera's lengths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Unit {
    #[default]
    Metres,
    /// Edges of the method's level-0 cell at the camera. The graph must declare its `voxels`.
    Voxels,
}

/// State of the scene at a frame: two frames with equal states have the same reference.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameState {
    pub camera: PlacedCamera,
    /// Time of the scene, s.
    pub time: f64,
    /// The scene's lights.
    pub lights: Vec<Light>,
    /// A moving parameter that the graph of references has too.
    pub setting: Option<(String, Value)>,
}

impl Motion {
    /// Checks the numbers, also against the scene.
    pub fn check(&self, scene: &Scene) -> Result<(), String> {
        let numbers: Vec<f64> = match self {
            Motion::Cut { at: 0, .. } => return Err("a cut has a frame `at` of 1 or more".into()),
            Motion::Path { from, step, .. } => vec![*from, *step],
            // The graph checks values of parameters, the scene checks cameras.
            Motion::Still | Motion::Parameter { .. } | Motion::Cut { .. } => vec![],
            Motion::Camera {
                dolly,
                strafe,
                rise,
                yaw,
                pitch,
                ..
            } => [dolly, strafe, rise, yaw, pitch]
                .map(|v| f64::from(*v))
                .to_vec(),
            Motion::Actors { step, scale } => {
                if scale.0 <= 0.0 || scale.1 <= 0.0 || scale.2 <= 0.0 {
                    return Err("the actors' scale must be above 0".into());
                }
                vec![*step, scale.0.into(), scale.1.into(), scale.2.into()]
            }
            Motion::Light { shift, turn, .. } => {
                [shift.0, shift.1, shift.2, *turn].map(f64::from).to_vec()
            }
            Motion::Switch { at, from, to, .. } => {
                if *at == 0 || *from < 0.0 || *to < 0.0 {
                    return Err(
                        "a switch has a frame `at` of 1 or more, and parts of 0 or more".into(),
                    );
                }
                vec![f64::from(*from), f64::from(*to)]
            }
        };
        if !numbers.iter().all(|n| n.is_finite() && n.abs() <= 1e6) {
            return Err("its numbers must be finite, and at most a million".into());
        }
        match self {
            Motion::Light { name, .. } | Motion::Switch { name, .. }
                if !scene.lights.iter().any(|l| l.name == *name) =>
            {
                let known: Vec<&str> = scene.lights.iter().map(|l| l.name.as_str()).collect();
                Err(format!(
                    "scene '{}' has no light '{name}'; it has {}",
                    scene.name,
                    known.join(", ")
                ))
            }
            Motion::Actors { .. } if !scene.moves() => {
                Err(format!("nothing is animated in scene '{}'", scene.name))
            }
            _ => Ok(()),
        }
    }

    /// The scene with its actors at the size of the motion.
    pub fn scaled_scene(&self, scene: &Scene) -> Option<Scene> {
        let Motion::Actors { scale, .. } = self else {
            return None;
        };
        if *scale == one() {
            return None;
        }
        let mut scene = scene.clone();
        for instance in scene.instances.iter_mut().filter(|i| i.mover.is_some()) {
            instance.transform *= Mat4::from_scale((*scale).into());
        }
        Some(scene)
    }

    /// Whether the motion needs the cell edge.
    pub fn in_voxels(&self) -> bool {
        matches!(
            self,
            Motion::Camera {
                unit: Unit::Voxels,
                ..
            }
        )
    }

    /// The first frame after a sudden change, counted from the first measured one.
    pub fn event(&self) -> Option<usize> {
        match self {
            Motion::Switch { at, .. } | Motion::Cut { at, .. } => Some(*at),
            _ => None,
        }
    }

    /// Time step of the method, s.
    pub fn delta(&self) -> f64 {
        if let Motion::Actors { step, .. } = self {
            *step
        } else {
            0.0
        }
    }

    /// State of frame `number`. Frame 0 is the first measured one; frames before it are negative
    /// and move too. `cell` is the edge of a cell, m.
    pub fn frame_state(&self, start: &FrameState, number: i64, cell: f32) -> FrameState {
        let n = number as f32;
        let mut state = start.clone();
        if number == 0 && !matches!(self, Motion::Switch { .. }) {
            // Exactly equal, so that cases with the same start share a reference.
            return state;
        }
        match self {
            Motion::Still | Motion::Parameter { .. } | Motion::Cut { .. } | Motion::Path { .. } => {
            }
            Motion::Camera {
                dolly,
                strafe,
                rise,
                yaw,
                pitch,
                unit,
            } => {
                let length = n * if *unit == Unit::Voxels { cell } else { 1.0 };
                let (eye, up) = (Vec3::from(start.camera.eye), Vec3::from(start.camera.up));
                let view = Vec3::from(start.camera.target) - eye;
                let forward = view.try_normalize().unwrap_or(Vec3::NEG_Z);
                let right = forward
                    .cross(up)
                    .try_normalize()
                    .unwrap_or(forward.any_orthonormal_vector());
                let above = right.cross(forward);
                let eye = eye + (forward * *dolly + right * *strafe + above * *rise) * length;
                let turn = Quat::from_axis_angle(above, (n * yaw).to_radians())
                    * Quat::from_axis_angle(right, (n * pitch).to_radians());
                state.camera.eye = eye.into();
                state.camera.target = (eye + turn * view).into();
            }
            Motion::Actors { step, .. } => state.time = start.time + number as f64 * step,
            Motion::Light { name, shift, turn } => {
                for light in state.lights.iter_mut().filter(|l| l.name == *name) {
                    light.position += Vec3::from(*shift) * n;
                    let turned = Quat::from_rotation_y((n * turn).to_radians()) * light.direction;
                    light.direction = if *turn == 0.0 {
                        light.direction
                    } else {
                        turned.normalize_or(light.direction)
                    };
                }
            }
            Motion::Switch { name, at, from, to } => {
                let part = if number < *at as i64 { *from } else { *to };
                for light in state.lights.iter_mut().filter(|l| l.name == *name) {
                    light.color *= part;
                }
            }
        }
        state
    }

    /// Short description of the motion.
    pub fn describe(&self) -> String {
        match self {
            Motion::Still => "still".into(),
            Motion::Camera {
                dolly,
                strafe,
                rise,
                yaw,
                pitch,
                unit,
            } => {
                let is_voxels = *unit == Unit::Voxels;
                let length = if is_voxels { "voxels" } else { "m" };
                let parts = [
                    ("dolly", dolly, length),
                    ("strafe", strafe, length),
                    ("rise", rise, length),
                    ("yaw", yaw, "degrees"),
                    ("pitch", pitch, "degrees"),
                ];
                let moved = parts.iter().filter(|p| *p.1 != 0.0);
                let text = |(name, v, unit): &(&str, &f32, &str)| format!("{name} {v} {unit}");
                let list: Vec<String> = moved.map(text).collect();
                format!("camera: {} a frame", list.join(", "))
            }
            Motion::Actors { step, scale } if *scale == one() => {
                format!("actors: {step} s a frame")
            }
            Motion::Actors {
                step,
                scale: (x, y, z),
            } => format!("actors of {x} x {y} x {z}: {step} s a frame"),
            Motion::Light { name, shift, turn } => {
                let (x, y, z) = shift;
                format!("light '{name}': ({x}, {y}, {z}) m and {turn} degrees a frame")
            }
            Motion::Switch { name, at, from, to } => {
                format!("light '{name}': {from} to {to} at frame {at}")
            }
            Motion::Cut {
                to: CameraChoice::Named(name),
                at,
            } => format!("cut to camera '{name}' at frame {at}"),
            Motion::Cut { at, .. } => format!("cut to another camera at frame {at}"),
            Motion::Path { file, from, step } => {
                format!("camera along {file} from {from} s, {step} s a frame")
            }
            Motion::Parameter {
                name,
                step: Some(step),
                ..
            } => format!("parameter '{name}': {} a frame", step.0),
            Motion::Parameter { name, values, .. } => {
                let list: Vec<&str> = values.iter().map(|v| v.0.as_str()).collect();
                format!("parameter '{name}': {}", list.join(", "))
            }
        }
    }
}
