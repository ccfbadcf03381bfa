//! What a point sets: parameters of the graph, and fields of the experiment.

use crate::diagnostics::{At, Diagnostic, Entries, Loc, RawText, options};
use crate::experiment::{CameraChoice, EnvironmentChange, Experiment, check_size, in_folder, scene_path};
use crate::lab::LabError;
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

/// Fields of an experiment that are set by name; every other name is a parameter's.
pub const FIELDS: [&str; 7] = ["graph", "scene", "camera", "size", "time", "sky", "environment"];

/// Settings as they stand in a file.
pub fn settings(list: &Entries<RawText>) -> Vec<Setting> {
    list.0.iter().map(|(name, value)| Setting::new(name, value)).collect()
}

/// Names and values as the lines of a text that stands for a file in messages, and as settings with their places in it.
pub fn lines<'t>(list: impl IntoIterator<Item = (&'t str, &'t str)>, between: &str) -> (String, Vec<Setting>) {
    let (mut text, mut settings) = (String::new(), Vec::new());
    for (name, value) in list {
        let at = At { file: 0, offset: u32::try_from(text.len()).unwrap_or(0) };
        settings.push(Setting { name: Loc { value: name.into(), at }, text: value.into() });
        text += &format!("{name}{between}{value}\n");
    }
    (text.trim_end_matches('\n').into(), settings)
}

/// Changes an experiment by settings that stand in the last of its sources; gives their mistakes. Parameters are checked
/// with their graph.
pub fn apply<'s>(
    experiment: &mut Experiment,
    settings: impl IntoIterator<Item = &'s Setting>,
    folder: &Path,
) -> Vec<Diagnostic> {
    let file = last_source(experiment);
    let mut errors = Vec::new();
    for setting in settings {
        if let Err(message) = setting.apply(experiment, file, folder) {
            errors.push(experiment.sources.error(At { file, offset: setting.name.at.offset }, message));
        }
    }
    errors
}

/// Sets parameters that stand in the last of an experiment's sources, whatever their names are.
pub fn set_params<'s>(experiment: &mut Experiment, settings: impl IntoIterator<Item = &'s Setting>) {
    let file = last_source(experiment);
    settings.into_iter().for_each(|s| s.set_param(experiment, file));
}

fn last_source(experiment: &Experiment) -> u32 {
    u32::try_from(experiment.sources.paths().count().saturating_sub(1)).unwrap_or(0)
}

/// What an option of the command line names and what it gives it: `NAME=VALUE`, or as `form` says.
///
/// # Errors
/// The text has no name and value.
pub fn named<'t>(option: &str, text: &'t str, form: &str) -> Result<(&'t str, &'t str), LabError> {
    let parts = text.split_once('=').map(|(name, value)| (name.trim(), value));
    parts.ok_or_else(|| LabError::Request(format!("{option} {text}: expected {form}")))
}

/// Values between commas; those inside brackets belong to a value.
pub fn values(text: &str) -> Vec<String> {
    let mut depth = 0;
    let between = |c: char| {
        depth += i32::from(matches!(c, '(' | '[')) - i32::from(matches!(c, ')' | ']'));
        c == ',' && depth == 0
    };
    text.split(between).map(|v| v.trim().to_string()).collect()
}

impl Setting {
    /// Mistakes are shown where the value stands.
    pub fn new(name: &Loc<String>, value: &Loc<RawText>) -> Setting {
        Setting { name: Loc { value: name.value.clone(), at: value.at }, text: value.value.0.clone() }
    }

    fn apply(&self, experiment: &mut Experiment, file: u32, folder: &Path) -> Result<(), String> {
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
            _ => self.set_param(experiment, file),
        }
        Ok(())
    }

    fn set_param(&self, experiment: &mut Experiment, file: u32) {
        let at = At { file, offset: self.name.at.offset };
        experiment.params.push((Loc { value: self.name.value.clone(), at }, self.text.clone()));
    }

    fn read<T: DeserializeOwned>(&self, expected: &str) -> Result<T, String> {
        let text = &self.text;
        options().from_str(text).map_err(|_| format!("'{}': expected {expected}, got {text}", self.name.value))
    }
}
