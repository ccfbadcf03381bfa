//! Reading experiments.

use super::{
    CameraChoice, DEFAULT_CAMERA, DEFAULT_SIZE, EnvironmentChange, Experiment, PlacedCamera,
    check_size,
};
use crate::diagnostics::{Diagnostic, Entries, Loc, RawText, Severity, Sources};
use crate::files::{path_of, spec_of};
use crate::scene::LightFields;
use glam::Vec3;
use serde::Deserialize;
use serde::de::{Deserializer, MapAccess, Visitor, value::MapAccessDeserializer};
use std::path::Path;

impl<'de> Deserialize<'de> for CameraChoice {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct V;
        impl<'de> Visitor<'de> for V {
            type Value = CameraChoice;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(
                    "a camera's name, or (eye: (x, y, z), target: (x, y, z), fov_y: degrees)",
                )
            }
            fn visit_str<E>(self, name: &str) -> Result<CameraChoice, E> {
                Ok(CameraChoice::Named(name.into()))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<CameraChoice, A::Error> {
                PlacedCamera::deserialize(MapAccessDeserializer::new(map)).map(CameraChoice::Placed)
            }
        }
        deserializer.deserialize_any(V)
    }
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ExperimentFile {
    graph: Loc<String>,
    scene: Loc<String>,
    #[serde(default)]
    camera: Option<Loc<CameraChoice>>,
    #[serde(default)]
    size: Option<Loc<(u32, u32)>>,
    #[serde(default)]
    time: Option<Loc<f64>>,
    #[serde(default)]
    sky: Option<Loc<(f32, f32, f32)>>,
    #[serde(default)]
    environment: Option<Loc<EnvironmentChange>>,
    #[serde(default)]
    lights: Entries<LightFields>,
    #[serde(default)]
    params: Entries<RawText>,
}

impl Experiment {
    /// Reads an experiment. Relative scene paths are relative to its folder.
    pub fn read(path: &Path) -> Result<Experiment, Vec<Diagnostic>> {
        let mut sources = Sources::default();
        let file = sources.read(path).map_err(|e| {
            vec![e.help(Some(
                "give the path of an experiment, for example configs/rays.ron".into(),
            ))]
        })?;
        parse(path, sources, file)
    }

    /// Parses an experiment from text, as if it were the file `path`.
    pub fn from_text(path: &Path, text: &str) -> Result<Experiment, Vec<Diagnostic>> {
        let mut sources = Sources::default();
        let file = sources.add(path, text.to_string());
        parse(path, sources, file)
    }
}

fn parse(path: &Path, sources: Sources, file: u32) -> Result<Experiment, Vec<Diagnostic>> {
    let mut errors = Vec::new();
    let parsed = sources.parse::<ExperimentFile>(file, &mut errors, &mut Vec::new());
    let Some(parsed) = parsed.filter(|_| !errors.iter().any(|e| e.severity == Severity::Error))
    else {
        return Err(errors);
    };
    let size = parsed.size.as_ref().map_or(DEFAULT_SIZE, |s| s.value);
    if let Err(message) = check_size(size) {
        let at = parsed.size.as_ref().map_or(parsed.graph.at, |s| s.at);
        errors.push(sources.error(at, message));
    }
    let wrong = [
        parsed.time.as_ref().map(|t| (t.at, check_time(t.value))),
        parsed.sky.as_ref().map(|s| (s.at, check_sky(s.value))),
        parsed.environment.as_ref().map(|e| (e.at, e.value.check())),
    ];
    errors.extend(
        wrong
            .into_iter()
            .flatten()
            .filter_map(|(at, check)| Some(sources.error(at, check.err()?))),
    );
    for (name, change) in &parsed.lights.0 {
        if let Err(message) = change.value.check() {
            errors.push(sources.error(change.at, format!("light '{}': {message}", name.value)));
        }
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    let folder = path.parent().unwrap_or(Path::new("."));
    Ok(Experiment {
        name: path
            .file_stem()
            .map_or(String::new(), |s| s.to_string_lossy().into_owned()),
        graph: parsed.graph.value,
        scene: scene_path(folder, &parsed.scene.value),
        camera: parsed
            .camera
            .map_or(CameraChoice::Named(DEFAULT_CAMERA.into()), |c| c.value),
        size,
        time: parsed.time.map_or(0.0, |t| t.value),
        sky: parsed.sky.map(|s| s.value),
        environment: parsed.environment.map(|Loc { value, at }| Loc {
            value: in_folder(folder, value),
            at,
        }),
        lights: parsed
            .lights
            .0
            .into_iter()
            .map(|(name, change)| (name, change.value))
            .collect(),
        params: parsed
            .params
            .0
            .into_iter()
            .map(|(name, value)| (name, value.value.0))
            .collect(),
        sources,
    })
}

pub(super) fn check_time(time: f64) -> Result<(), String> {
    if time.is_finite() {
        Ok(())
    } else {
        Err("the time must be a finite number of seconds".into())
    }
}

pub(super) fn check_sky(sky: (f32, f32, f32)) -> Result<(), String> {
    if is_colour(sky) {
        Ok(())
    } else {
        Err("the sky's radiance must be finite and not negative".into())
    }
}

fn is_colour(c: (f32, f32, f32)) -> bool {
    let c = Vec3::from(c);
    c.is_finite() && c.min_element() >= 0.0
}

/// The same change with its file looked up next to the experiment first.
pub(super) fn in_folder(folder: &Path, change: EnvironmentChange) -> EnvironmentChange {
    EnvironmentChange {
        file: change.file.map(|file| scene_path(folder, &file)),
        ..change
    }
}

/// Built-in names are kept; files are looked up next to the experiment first.
pub(super) fn scene_path(folder: &Path, scene: &str) -> String {
    let beside = folder.join(path_of(scene));
    if scene.contains('.') && beside.is_file() {
        spec_of(&beside)
    } else {
        scene.to_string()
    }
}
