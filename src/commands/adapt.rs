//! What several commands let the command line change of an experiment.

use crate::campaign::settings::named;
use crate::diagnostics::excerpt::excerpt;
use crate::diagnostics::{At, Loc};
use crate::experiment::{CameraChoice, EnvironmentChange, Experiment, PlacedCamera, check_size};
use crate::lab::LabError;
use crate::scene::Scene;
use clap::Args;
use std::path::{Path, PathBuf};

/// An experiment with changes.
#[derive(Debug, Args)]
pub struct ExperimentArgs {
    /// Experiment file, for example configs/rays.ron.
    experiment: PathBuf,
    #[command(flatten)]
    changes: Changes,
}

/// Changes of the command line to an experiment.
#[derive(Clone, Debug, Default, PartialEq, Args)]
pub struct Changes {
    /// Scene to use: a built-in name, a scene file (.ron) or a model.
    #[arg(long, value_parser = super::spec())]
    scene: Option<String>,
    /// Camera: a name in the scene, or one written out: "(eye: (0, 1, 5), target: (0, 1, 0), fov_y:
    /// 60)".
    #[arg(long)]
    camera: Option<String>,
    /// Picture size.
    #[arg(long, value_name = "WxH")]
    size: Option<String>,
    /// Set a parameter (repeatable).
    #[arg(long, value_name = "NAME=VALUE")]
    pub set: Vec<String>,
    /// Sky: an equirectangular .hdr or .exr file.
    #[arg(long, value_name = "FILE")]
    environment: Option<String>,
    /// Rotation of the sky's picture about y, degrees.
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    sky_rotation: Option<f32>,
    /// Time of the first frame, s.
    #[arg(long)]
    time: Option<f64>,
}

impl ExperimentArgs {
    /// The experiment with the command line's changes.
    pub fn read(&self) -> Result<Experiment, LabError> {
        self.changes.read(&self.experiment)
    }
}

impl Changes {
    /// Whether nothing is changed.
    pub fn is_empty(&self) -> bool {
        *self == Changes::default()
    }

    /// The picture's size, if the command line gives one.
    pub fn size(&self) -> Result<Option<(u32, u32)>, LabError> {
        self.size.as_deref().map(parse_size).transpose()
    }

    /// The experiment of a file, changed.
    pub fn read(&self, file: &Path) -> Result<Experiment, LabError> {
        let mut experiment = Experiment::read(&super::found(file)).map_err(LabError::Input)?;
        if let Some(scene) = &self.scene {
            experiment.scene.clone_from(scene);
        }
        experiment.size = self.size()?.unwrap_or(experiment.size);
        if let Some(text) = &self.camera {
            experiment.camera = parse_camera(text)?;
        }
        experiment.time = self.time.unwrap_or(experiment.time);
        if !experiment.time.is_finite() {
            return Err(LabError::Request(
                "--time must be a finite number of seconds".into(),
            ));
        }
        if self.environment.is_some() || self.sky_rotation.is_some() {
            let over = EnvironmentChange {
                file: self.environment.clone(),
                rotation: self.sky_rotation,
                intensity: None,
            };
            over.check().map_err(LabError::Request)?;
            let at = At {
                file: experiment
                    .sources
                    .add("--environment".as_ref(), String::new()),
                offset: 0,
            };
            let before = experiment
                .environment
                .take()
                .map(|e| e.value)
                .unwrap_or_default();
            experiment.environment = Some(Loc {
                value: before.overlaid(over),
                at,
            });
        }
        // Later settings win, and messages about them point at the command line.
        for setting in &self.set {
            let file = experiment.sources.add(
                format!("--set {}", excerpt(setting, 80)).as_ref(),
                setting.clone(),
            );
            let (name, value) = named("--set", setting, "NAME=VALUE")?;
            experiment.params.push((
                Loc {
                    value: name.into(),
                    at: At { file, offset: 0 },
                },
                value.into(),
            ));
        }
        Ok(experiment)
    }
}

/// The experiment's scene as its file describes it.
pub fn open_unlit(experiment: &Experiment) -> Result<Scene, LabError> {
    super::open_scene(&experiment.scene).map_err(|error| match error {
        LabError::Scene(error) => LabError::of_scene(experiment, error),
        other => other,
    })
}

/// The experiment's scene, lit as the experiment says.
pub fn open_scene(experiment: &Experiment) -> Result<Scene, LabError> {
    let mut scene = open_unlit(experiment)?;
    let told = scene.warnings.len();
    experiment.adapt_scene(&mut scene)?;
    for warning in scene.warnings.iter().skip(told) {
        warn!("warning: {warning}");
    }
    Ok(scene)
}

/// A picture's size, `WIDTHxHEIGHT`.
pub fn parse_size(text: &str) -> Result<(u32, u32), LabError> {
    let wrong = || {
        LabError::Request(format!(
            "--size {text}: expected WIDTHxHEIGHT, for example 1280x720"
        ))
    };
    let (w, h) = text.split_once('x').ok_or_else(wrong)?;
    let size = (
        w.trim().parse().map_err(|_| wrong())?,
        h.trim().parse().map_err(|_| wrong())?,
    );
    check_size(size).map_err(LabError::Request)?;
    Ok(size)
}

fn parse_camera(text: &str) -> Result<CameraChoice, LabError> {
    if !text.trim_start().starts_with('(') {
        return Ok(CameraChoice::Named(text.into()));
    }
    let placed: PlacedCamera = crate::diagnostics::options().from_str(text).map_err(|e| {
        LabError::Request(format!(
            "--camera: {e}; expected (eye: (x, y, z), target: (x, y, z), fov_y: degrees)"
        ))
    })?;
    Ok(CameraChoice::Placed(placed))
}

/// A texture with its mip and layer, `NAME[:MIP[:LAYER]]`.
pub fn parse_resource(text: &str) -> Result<(String, u32, u32), LabError> {
    let mut parts = text.split(':');
    let name = parts.next().unwrap_or("").to_string();
    let mut number = |what: &str| match parts.next() {
        None => Ok(0),
        Some(n) => n
            .parse()
            .map_err(|_| LabError::Request(format!("--resource {text}: '{n}' is no {what}"))),
    };
    Ok((name, number("mip")?, number("layer")?))
}

/// Most frames of one run.
const MAX_FRAMES: usize = 1_000_000;

/// Checks the number of frames and the step between them.
pub fn check_frames(frames: usize, warmup: usize, step: f64) -> Result<(), LabError> {
    if !step.is_finite() {
        return Err(LabError::Request(
            "--step must be a finite number of seconds".into(),
        ));
    }
    if frames == 0 || frames.saturating_add(warmup) > MAX_FRAMES {
        return Err(LabError::Request(format!(
            "--frames must be 1 to {MAX_FRAMES}"
        )));
    }
    Ok(())
}
