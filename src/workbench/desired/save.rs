//! Saving: experiments and captures, as the window's state says.

use super::lights::HEADLIGHT;
use super::request::{LightState, RenderRequest, SideRequest};
use crate::diagnostics::{At, Loc};
use crate::experiment::{CameraChoice, EnvironmentChange, Experiment};
use crate::graph::Graph;
use crate::lab::{Lab, LabError};
use crate::results::capture::{self, Resource, What};
use crate::results::timers::Rows;
use crate::scene::{Light, LightFields, Scene};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A side as an experiment, with its differences from the scene's light.
pub fn experiment(
    desired: &RenderRequest,
    side: &SideRequest,
    name: &str,
    time: f64,
    scene: Option<&Scene>,
) -> Experiment {
    let mut experiment = Experiment {
        name: name.into(),
        time,
        ..desired.experiment(side)
    };
    let at = At::default();
    let file = Some(desired.environment.clone()).filter(|file| !file.is_empty());
    let mut picture = EnvironmentChange {
        file,
        ..EnvironmentChange::default()
    };
    if let (
        Some(LightState {
            lights,
            sky,
            rotation,
            without_headlight,
        }),
        Some(scene),
    ) = (&desired.lights, scene)
    {
        experiment.sky = (*sky != scene.sky).then(|| (*sky).into());
        picture.rotation = scene
            .environment
            .as_ref()
            .filter(|e| e.rotation != *rotation)
            .map(|_| *rotation);
        experiment.lights = light_changes(lights, &scene.lights);
        if *without_headlight {
            let (value, at) = (HEADLIGHT.to_string(), At::default());
            let removal = (Loc { value, at }, LightFields::removal());
            experiment.lights.push(removal);
        }
    }
    experiment.environment =
        (picture != EnvironmentChange::default()).then_some(Loc { value: picture, at });
    experiment
}

/// The changes that lead from the scene's own lights to these.
fn light_changes(lights: &[Light], own: &[Light]) -> Vec<(Loc<String>, LightFields)> {
    let by_name = |list: &[Light], name: &str| list.iter().find(|l| l.name == name).cloned();
    let kept = own.iter().filter_map(|own| {
        let change = match by_name(lights, &own.name) {
            None => LightFields::removal(),
            Some(light) if light == *own => return None,
            Some(light) if light.kind.index() == own.kind.index() => {
                light.fields().changed(&own.fields())
            }
            Some(light) => light.addition(),
        };
        Some((own.name.clone(), change))
    });
    let added = lights.iter().filter_map(|light| {
        let is_new = by_name(own, &light.name).is_none();
        is_new.then(|| (light.name.clone(), light.addition()))
    });
    let at = At::default();
    let changes = kept.chain(added);
    changes
        .map(|(value, change)| (Loc { value, at }, change))
        .collect()
}

/// A side without the probed pixel and the slice: those are states of the window.
pub fn without_cursors(side: &SideRequest, graph: Option<&Graph>) -> SideRequest {
    let mut side = side.clone();
    let is_cursor = |name: &str| graph.is_some_and(|g| g.cursors().any(|c| c == name));
    side.params.retain(|(name, _)| !is_cursor(name));
    side
}

/// Like [`experiment`], seen from where the camera's path is at that time.
pub fn still(
    desired: &RenderRequest,
    side: &SideRequest,
    name: &str,
    time: f64,
    scene: &Scene,
) -> Experiment {
    let mut still = experiment(desired, side, name, time, Some(scene));
    if let Some(path) = &desired.path {
        still.camera = CameraChoice::Placed(path.at(time));
    }
    still
}

/// Lights and sky of a scene as an experiment has them, if they are not the scene's own.
///
/// # Errors
/// The experiment changes a light that the scene does not have.
pub fn lights(experiment: &Experiment, scene: &Arc<Scene>) -> Result<Option<LightState>, LabError> {
    if experiment.sky.is_none() && experiment.environment.is_none() && experiment.lights.is_empty()
    {
        return Ok(None);
    }
    let is_headlight = |name: &str| name == HEADLIGHT;
    let mut changes = experiment.lights.iter();
    let lights = LightState {
        without_headlight: changes.any(|(name, c)| is_headlight(&name.value) && c.removes())
            && !scene.lights.iter().any(|light| is_headlight(&light.name)),
        ..LightState::of(&*experiment.adapted(scene.clone())?)
    };
    Ok(Some(lights).filter(|lights| *lights != LightState::of(scene)))
}

/// Captures an experiment into `folder/NAME`, or the next name that is free.
///
/// # Errors
/// The errors of rendering and writing.
pub fn take(
    lab: &Lab,
    experiment: &Experiment,
    scene: Arc<Scene>,
    folder: &Path,
    resources: Vec<String>,
    timers: Rows,
) -> Result<PathBuf, LabError> {
    let resources = resources
        .into_iter()
        .map(|name| Resource {
            name,
            mip: 0,
            layer: 0,
        })
        .collect();
    let what = What {
        resources,
        timers,
        numbered: true,
        ..What::default()
    };
    capture::take(lab, experiment, scene, &what, folder, &experiment.name)
}
