//! Applies an experiment's changes to the lighting of its scene.

use super::Experiment;
use super::ExperimentError;
use crate::diagnostics::{Diagnostic, Loc};
use crate::scene::{Scene, environment};
use glam::Vec3;
use std::path::Path;
use std::sync::Arc;

impl Experiment {
    /// All changes of [`Experiment::adapt_scene`] as text; equal texts give equal lighting.
    pub fn light(&self) -> String {
        let lights: Vec<String> = self
            .lights
            .iter()
            .map(|(name, l)| format!("{} {l:?}", name.value))
            .collect();
        format!(
            "{:?} {:?} {lights:?}",
            self.sky,
            self.environment.as_ref().map(|e| &e.value)
        )
    }

    /// Applies the experiment's changes to the sky and lights of the scene; idempotent.
    ///
    /// # Errors
    /// Unknown lights, invalid fields for a kind of light, with positions; an unreadable
    /// environment map.
    pub fn adapt_scene(&self, scene: &mut Scene) -> Result<(), ExperimentError> {
        let mut errors = Vec::new();
        for (name, change) in &self.lights {
            if change.removes() {
                scene.lights.retain(|l| l.name != name.value);
                continue;
            }
            let mut known = false;
            if let Some(added) = change.added(&name.value) {
                match scene.lights.iter_mut().find(|l| l.name == name.value) {
                    Some(light) => *light = added,
                    None => scene.lights.push(added),
                }
            }
            for light in scene.lights.iter_mut().filter(|l| l.name == name.value) {
                known = true;
                if let Err(message) = change.apply(light) {
                    errors.push(
                        self.sources
                            .error(name.at, format!("light '{}' {message}", name.value)),
                    );
                    break;
                }
            }
            if !known {
                errors.push(self.no_light(name, scene));
            }
        }
        if !errors.is_empty() {
            return Err(ExperimentError::Input(errors));
        }
        scene.sky = self.sky.map_or(scene.sky, Vec3::from);
        self.adapt_environment(scene)
            .map_err(|error| ExperimentError::Input(vec![error]))
    }

    fn adapt_environment(&self, scene: &mut Scene) -> Result<(), Diagnostic> {
        let Some(Loc { value: change, at }) = &self.environment else {
            return Ok(());
        };
        let has = |scene: &Scene, file: &str| {
            scene
                .environment
                .as_ref()
                .is_some_and(|e| e.file.as_deref() == Some(Path::new(file)))
        };
        if let Some(file) = change.file.as_ref().filter(|file| !has(scene, file)) {
            let read = environment::read(Path::new(file), &mut scene.warnings);
            scene.environment = Some(read.map_err(|message| self.sources.error(*at, message))?);
        }
        let Some(environment) = &mut scene.environment else {
            let message = format!("scene '{}' has no environment: name its `file`", scene.name);
            return Err(self.sources.error(*at, message));
        };
        environment.rotation = change.rotation.unwrap_or(environment.rotation);
        if change.file.is_some() || change.intensity.is_some() {
            scene.sky = self.sky.map_or(Vec3::ONE, Vec3::from) * change.intensity.unwrap_or(1.0);
        }
        Ok(())
    }

    /// Like [`Experiment::adapt_scene`] for a shared scene, which is copied only if something
    /// changes.
    pub fn adapted(&self, scene: Arc<Scene>) -> Result<Arc<Scene>, ExperimentError> {
        let name = scene.name.clone();
        let (lights, environment) = (scene.lights.clone(), scene.environment.clone());
        let mut light = Scene {
            name,
            lights,
            sky: scene.sky,
            environment,
            ..Scene::default()
        };
        self.adapt_scene(&mut light)?;
        if (&light.lights, light.sky, &light.environment)
            == (&scene.lights, scene.sky, &scene.environment)
        {
            return Ok(scene);
        }
        let mut scene = scene;
        let changed = Arc::make_mut(&mut scene);
        (changed.lights, changed.sky, changed.environment) =
            (light.lights, light.sky, light.environment);
        changed.warnings.extend(light.warnings);
        Ok(scene)
    }

    fn no_light(&self, name: &Loc<String>, scene: &Scene) -> Diagnostic {
        let message = format!("scene '{}' has no light '{}'", scene.name, name.value);
        self.sources
            .error(name.at, message)
            .nearest(&name.value, scene.lights.iter().map(|l| l.name.as_str()))
    }
}
