//! Named fields of an experiment, the common table for writing, editing and comparing experiments.

use super::read::{check_sky, check_time, in_folder, scene_path};
use super::write::{
    camera_text, environment_in, quoted, same_environment, same_scene, scene_text, vector,
};
use super::{
    CameraChoice, DEFAULT_CAMERA, DEFAULT_SIZE, EnvironmentChange, Experiment, check_size,
};
use crate::diagnostics::{At, Loc, options};
use serde::de::DeserializeOwned;
use std::path::Path;

/// A field of an experiment.
pub struct Field {
    /// Name in files.
    pub name: &'static str,
    set: fn(&mut Experiment, &Given) -> Result<(), String>,
    text: fn(&Experiment, &Path) -> String,
    /// Whether the field has its default.
    pub(super) absent: fn(&Experiment) -> bool,
    /// Whether two experiments agree in this field.
    pub same: fn(&Experiment, &Experiment) -> bool,
}

/// All fields; every other setting is a graph parameter.
pub static FIELDS: &[Field] = &[
    Field {
        name: "graph",
        set: |e, v| v.read("the name of a graph").map(|graph| e.graph = graph),
        text: |e, _| quoted(&e.graph),
        absent: |_| false,
        same: |a, b| a.graph == b.graph,
    },
    Field {
        name: "scene",
        set: |e, v| {
            v.read("a scene's name or file")
                .map(|scene: String| e.scene = scene_path(v.folder, &scene))
        },
        text: |e, path| quoted(&scene_text(&e.scene, path)),
        absent: |_| false,
        same: |a, b| same_scene(&a.scene, &b.scene),
    },
    Field {
        name: "camera",
        set: |e, v| {
            v.read("a camera's name, or a camera written out")
                .map(|camera| e.camera = camera)
        },
        text: |e, _| camera_text(&e.camera),
        absent: |e| e.camera == CameraChoice::Named(DEFAULT_CAMERA.into()),
        same: |a, b| a.camera == b.camera,
    },
    Field {
        name: "size",
        set: |e, v| {
            e.size = v.read("(width, height)")?;
            check_size(e.size)
        },
        text: |e, _| format!("({}, {})", e.size.0, e.size.1),
        absent: |e| e.size == DEFAULT_SIZE,
        same: |a, b| a.size == b.size,
    },
    Field {
        name: "time",
        set: |e, v| {
            e.time = v.read("a number of seconds")?;
            check_time(e.time)
        },
        text: |e, _| format!("{:?}", e.time),
        absent: |e| e.time == 0.0,
        same: |a, b| a.time == b.time,
    },
    Field {
        name: "sky",
        set: |e, v| {
            let sky = v.read("(r, g, b)")?;
            e.sky = Some(sky);
            check_sky(sky)
        },
        text: |e, _| e.sky.map_or(String::new(), vector),
        absent: |e| e.sky.is_none(),
        same: |a, b| a.sky == b.sky,
    },
    Field {
        name: "environment",
        set: |e, v| {
            let change: EnvironmentChange =
                v.read("(file: \"sky.hdr\", rotation: degrees, intensity: 1)")?;
            change.check()?;
            let before = e.environment.take().map(|e| e.value).unwrap_or_default();
            e.environment = Some(Loc {
                value: before.overlaid(in_folder(v.folder, change)),
                at: v.at,
            });
            Ok(())
        },
        text: environment_in,
        absent: |e| e.environment.is_none(),
        same: same_environment,
    },
];

/// A value in RON, its position, and the folder for relative paths.
struct Given<'g> {
    name: &'static str,
    text: &'g str,
    folder: &'g Path,
    at: At,
}

impl Given<'_> {
    fn read<T: DeserializeOwned>(&self, expected: &str) -> Result<T, String> {
        let Given { name, text, .. } = self;
        options()
            .from_str(text)
            .map_err(|_| format!("'{name}': expected {expected}, got {text}"))
    }
}

impl Field {
    /// The field with this name.
    pub fn of(name: &str) -> Option<&'static Field> {
        FIELDS.iter().find(|f| f.name == name)
    }

    /// The value as RON in the file `path`; empty if not set.
    pub fn text(&self, experiment: &Experiment, path: &Path) -> String {
        (self.text)(experiment, path)
    }

    /// Sets the value from RON at the position `at` of the experiment's sources.
    ///
    /// # Errors
    /// The value is invalid for the field.
    pub fn set(
        &self,
        experiment: &mut Experiment,
        text: &str,
        folder: &Path,
        at: At,
    ) -> Result<(), String> {
        (self.set)(
            experiment,
            &Given {
                name: self.name,
                text,
                folder,
                at,
            },
        )
    }
}
