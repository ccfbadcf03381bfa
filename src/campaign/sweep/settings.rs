//! One thing that a point sets: a parameter of the graph, or a field of the experiment.

use crate::experiment::{CameraChoice, EnvironmentChange, Experiment, check_size, in_folder, scene_path};
use crate::graph::file::RawText;
use crate::graph::source::{At, Loc, options};
use serde::de::DeserializeOwned;
use std::path::Path;

/// Name and value as RON.
#[derive(Clone, Debug)]
pub struct Setting {
    /// graph, scene, camera, size, time, sky, environment, or a parameter.
    pub name: Loc<String>,
    /// RON.
    pub text: String,
}

impl Setting {
    pub(crate) fn new(name: Loc<String>, value: &Loc<RawText>) -> Setting {
        // Mistakes are shown where the value stands.
        Setting { name: Loc { value: name.value, at: value.at }, text: value.value.0.clone() }
    }

    /// Changes the experiment. `file` is the number of the sweep's text in the experiment's sources.
    ///
    /// # Errors
    /// The text for the user, for fields of the experiment; parameters are checked with their graph.
    pub fn apply(&self, experiment: &mut Experiment, file: u32, folder: &Path) -> Result<(), String> {
        let name = self.name.value.as_str();
        match name {
            "graph" => experiment.graph = self.read("the name of a graph")?,
            "scene" => experiment.scene = scene_path(folder, &self.read::<String>("a scene's name or file")?),
            "camera" => experiment.camera = self.read::<CameraChoice>("a camera's name, or a camera written out")?,
            "size" => {
                experiment.size = self.read("(width, height)")?;
                check_size(experiment.size)?;
            }
            "time" => {
                experiment.time = self.read("a number of seconds")?;
                if !experiment.time.is_finite() {
                    return Err("the time must be a finite number of seconds".into());
                }
            }
            "sky" => {
                let sky: (f32, f32, f32) = self.read("(r, g, b)")?;
                if [sky.0, sky.1, sky.2].iter().any(|v| !v.is_finite() || *v < 0.0) {
                    return Err("the sky's radiance must be finite and not negative".into());
                }
                experiment.sky = Some(sky);
            }
            "environment" => {
                let change = self.read::<EnvironmentChange>("(file: \"sky.hdr\", rotation: degrees, intensity: 1)")?;
                change.check()?;
                let before = experiment.environment.take().map(|e| e.value).unwrap_or_default();
                let value = before.overlaid(in_folder(folder, change));
                experiment.environment = Some(Loc { value, at: At { file, offset: self.name.at.offset } });
            }
            _ => {
                let at = At { file, offset: self.name.at.offset };
                experiment.params.push((Loc { value: name.into(), at }, self.text.clone()));
            }
        }
        Ok(())
    }

    fn read<T: DeserializeOwned>(&self, expected: &str) -> Result<T, String> {
        let text = &self.text;
        options().from_str(text).map_err(|_| format!("'{}': expected {expected}, got {text}", self.name.value))
    }
}
