//! Experiments: graph, scene, camera, size, time and the parameter values that differ from the defaults.

use crate::graph::source::{Diagnostic, Entries, Loc, Severity, Sources};
use serde::Deserialize;
use serde::de::{Deserializer, MapAccess, Visitor, value::MapAccessDeserializer};
use std::path::{Path, PathBuf};

/// Where a picture is taken from.
#[derive(Clone, Debug, PartialEq)]
pub enum CameraChoice {
    /// A camera of the scene.
    Named(String),
    /// Written out.
    Placed(PlacedCamera),
}

/// A camera written out.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct PlacedCamera {
    /// Position, m.
    pub eye: (f32, f32, f32),
    /// The point it looks at, m.
    pub target: (f32, f32, f32),
    /// Vertical field of view, degrees.
    pub fov_y: f32,
}

impl<'de> Deserialize<'de> for CameraChoice {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct V;
        impl<'de> Visitor<'de> for V {
            type Value = CameraChoice;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a camera's name, or (eye: (x, y, z), target: (x, y, z), fov_y: degrees)")
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

/// A RON value kept as text, to be read by the parameter it is for.
#[derive(Clone, Debug)]
struct RawText(String);

impl<'de> Deserialize<'de> for RawText {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let raw = <&'de ron::value::RawValue>::deserialize(deserializer)?;
        Ok(RawText(raw.trim().get_ron().to_string()))
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
    time: f64,
    #[serde(default)]
    params: Entries<RawText>,
}

/// An experiment.
#[derive(Clone, Debug)]
pub struct Experiment {
    /// Name: the file's stem.
    pub name: String,
    /// Graph file in the passes folder.
    pub graph: String,
    /// Built-in name, or a path.
    pub scene: String,
    /// Camera.
    pub camera: CameraChoice,
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// Seconds.
    pub time: f64,
    /// (name, value as RON, where it stands).
    pub params: Vec<(Loc<String>, String)>,
    /// The file, for messages.
    pub sources: Sources,
}

/// Largest picture, pixels a side.
pub const MAX_SIZE: u32 = 16384;

impl Experiment {
    /// Reads an experiment. Relative scene paths are relative to its folder.
    ///
    /// # Errors
    /// All mistakes of the file.
    pub fn read(path: &Path) -> Result<Experiment, Vec<Diagnostic>> {
        let mut sources = Sources::default();
        let file = sources.read(path).map_err(|e| {
            vec![e.help(Some("give the path of an experiment, for example configs/default.ron".into()))]
        })?;
        let mut errors = Vec::new();
        let parsed = sources.parse::<ExperimentFile>(file, &mut errors, &mut Vec::new());
        let Some(parsed) = parsed.filter(|_| !errors.iter().any(|e| e.severity == Severity::Error)) else {
            return Err(errors);
        };
        let size = parsed.size.as_ref().map_or((1280, 720), |s| s.value);
        if let Err(message) = check_size(size) {
            let at = parsed.size.as_ref().map_or(parsed.graph.at, |s| s.at);
            return Err(vec![sources.error(at, message)]);
        }
        let folder = path.parent().unwrap_or(Path::new("."));
        Ok(Experiment {
            name: path.file_stem().map_or(String::new(), |s| s.to_string_lossy().into_owned()),
            graph: parsed.graph.value,
            scene: scene_path(folder, &parsed.scene.value),
            camera: parsed.camera.map_or(CameraChoice::Named("default".into()), |c| c.value),
            size,
            time: parsed.time,
            params: parsed.params.0.into_iter().map(|(name, value)| (name, value.value.0)).collect(),
            sources,
        })
    }
}

/// Whether pictures of that size can be made.
///
/// # Errors
/// The text for the user.
pub fn check_size((width, height): (u32, u32)) -> Result<(), String> {
    if width == 0 || height == 0 || width > MAX_SIZE || height > MAX_SIZE {
        return Err(format!("a picture of {width}x{height} cannot be made: each side is 1 to {MAX_SIZE} pixels"));
    }
    Ok(())
}

/// Names stay; files are looked up beside the experiment first.
fn scene_path(folder: &Path, scene: &str) -> String {
    let beside: PathBuf = folder.join(scene);
    if scene.contains('.') && beside.is_file() { beside.to_string_lossy().into_owned() } else { scene.to_string() }
}
