//! Writes experiments: only differences from the defaults, keeping the comments of a replaced file.

use super::ExperimentError;
use super::spans::{self, Body, Edits};
use super::{CameraChoice, EnvironmentChange, Experiment, FIELDS, PlacedCamera};
use crate::diagnostics::{At, Diagnostic, Loc};
use crate::files::FileError;
use crate::graph::param::Params;
use crate::scene::{LightFields, Scene};
use std::path::{Component, Path, PathBuf};

/// Writes an experiment to `path`: graph, scene, camera, size, explicit time and lighting, and the
/// parameters that differ from `defaults`. The text is read back before the file is replaced. An
/// existing file is edited in place: comments and unchanged lines stay, changed values are
/// replaced, and values that became defaults are removed with their lines.
///
/// # Errors
/// An existing file (without `overwrite`), unknown parameters, values that cannot be read back, no
/// permission. The old file is unchanged then.
pub fn write(
    experiment: &Experiment,
    defaults: &Params,
    path: &Path,
    overwrite: bool,
) -> Result<(), ExperimentError> {
    if !overwrite && path.exists() {
        return Err(exists(path));
    }
    let params = experiment.params_over(defaults)?;
    // Scene files are named relative to this folder and looked up from it when the text is read
    // back.
    let folder = path.parent().unwrap_or(Path::new("."));
    std::fs::create_dir_all(folder).map_err(|why| FileError::Write {
        path: path.into(),
        why,
    })?;
    let unchanged: Vec<(String, String)> = defaults.texts().collect();
    let list = params
        .texts()
        .filter(|text| !unchanged.contains(text))
        .collect();
    let wanted = Wanted {
        experiment,
        path,
        params: list,
        values: &params,
    };
    let right = |text: &str| read_back(experiment, &params, defaults, path, text);
    let edited = if overwrite {
        edited(&wanted, defaults).filter(|text| right(text).is_ok())
    } else {
        None
    };
    let text = edited.unwrap_or_else(|| fresh(&wanted));
    right(&text)?;
    let written = if overwrite {
        crate::files::write_whole(path, text.as_bytes())
    } else {
        crate::files::write_new(path, text.as_bytes())
    };
    written.map_err(|e| if e.is_there() { exists(path) } else { e.into() })
}

/// The text of an experiment that does not depend on defaults: every parameter, the camera, the sky
/// and the lights are written. The file `path` determines how a scene file is named.
///
/// # Errors
/// Unknown parameters; values that cannot be read back.
pub fn resolved_text(
    experiment: &Experiment,
    defaults: &Params,
    camera: &PlacedCamera,
    scene: &Scene,
    path: &Path,
) -> Result<String, ExperimentError> {
    let params = experiment.params_over(defaults)?;
    let mut resolved = experiment.clone();
    resolved.camera = CameraChoice::Placed(*camera);
    resolved.sky = Some(scene.sky.into());
    resolved.environment = scene.environment.as_ref().map(|environment| {
        let file = experiment
            .environment
            .as_ref()
            .and_then(|e| e.value.file.clone());
        // The intensity is a factor of the sky.
        let value = EnvironmentChange {
            file,
            rotation: Some(environment.rotation),
            intensity: None,
        };
        Loc {
            value,
            at: At::default(),
        }
    });
    resolved.lights = resolved_lights(experiment, scene);
    let wanted = Wanted {
        experiment: &resolved,
        path,
        params: params.texts().collect(),
        values: &params,
    };
    let text = fresh(&wanted);
    read_back(&resolved, &params, defaults, path, &text)?;
    Ok(text)
}

/// Every light of a scene, and the removals that led to it.
fn resolved_lights(experiment: &Experiment, scene: &Scene) -> Vec<(Loc<String>, LightFields)> {
    let changes = experiment.lights.iter();
    let removed = changes.clone().filter(|c| c.1.removes()).cloned();
    let is_added = |name: &str| {
        let mut changes = changes.clone().rev();
        changes.any(|(n, c)| n.value == name && c.added(name).is_some())
    };
    // A change affects all lights with its name, so only unique names can be written.
    let single = |name: &str| {
        !name.is_empty() && scene.lights.iter().filter(|l| l.name == name).count() == 1
    };
    let lights = scene.lights.iter().filter(|l| single(&l.name)).map(|l| {
        let change = if is_added(&l.name) {
            l.addition()
        } else {
            l.fields()
        };
        let (value, at) = (l.name.clone(), At::default());
        (Loc { value, at }, change)
    });
    removed.chain(lights).collect()
}

fn exists(path: &Path) -> ExperimentError {
    ExperimentError::Request(format!(
        "'{}' exists: choose another name, or ask for it to be overwritten",
        path.display()
    ))
}

/// The expected content of a text.
struct Wanted<'e> {
    experiment: &'e Experiment,
    path: &'e Path,
    params: Vec<(String, String)>,
    values: &'e Params,
}

/// Checks that a text reproduces an experiment.
fn read_back(
    experiment: &Experiment,
    params: &Params,
    defaults: &Params,
    path: &Path,
    text: &str,
) -> Result<(), ExperimentError> {
    let wrong = |why: String| {
        ExperimentError::Request(format!(
            "'{}' cannot be written: it would not read back as it is: {why}",
            path.display()
        ))
    };
    let first_message =
        |list: &[Diagnostic]| list.first().map_or(String::new(), |d| d.message.clone());
    let found = Experiment::from_text(path, text).map_err(|e| wrong(first_message(&e)))?;
    let values = match found.params_over(defaults) {
        Ok(params) => (params.values, params.off),
        Err(ExperimentError::Input(list)) => return Err(wrong(first_message(&list))),
        Err(e) => return Err(e),
    };
    let maps = [
        ("lights", changes(&found) == changes(experiment)),
        (
            "params",
            values == (params.values.clone(), params.off.clone()),
        ),
    ];
    let fields = FIELDS
        .iter()
        .map(|f| (f.name, (f.same)(&found, experiment)));
    match fields.chain(maps).find(|c| !c.1) {
        Some((field, _)) => Err(wrong(format!("`{field}` differs"))),
        None => Ok(()),
    }
}

/// Changes by name, after those that add lights: the order of the scene's lights depends on these.
fn changes(experiment: &Experiment) -> Vec<(&str, &LightFields)> {
    let changes = experiment.lights.iter();
    let changes = changes.map(|(name, change)| (name.value.as_str(), change));
    let (added, mut others): (Vec<_>, Vec<_>) = changes.partition(|(n, c)| c.added(n).is_some());
    others.sort_by_key(|l| l.0);
    [added, others].concat()
}

pub(super) fn same_environment(a: &Experiment, b: &Experiment) -> bool {
    let change = |e: &Experiment| {
        e.environment
            .as_ref()
            .map(|e| e.value.clone())
            .unwrap_or_default()
    };
    let (a, b) = (change(a), change(b));
    let same_file = match (&a.file, &b.file) {
        (Some(a), Some(b)) => same_scene(a, b),
        (a, b) => a == b,
    };
    same_file && (a.rotation, a.intensity) == (b.rotation, b.intensity)
}

pub(super) fn same_scene(a: &str, b: &str) -> bool {
    let real = |name: &str| Path::new(name).canonicalize().ok();
    a == b || real(a).is_some_and(|found| real(b) == Some(found))
}

/// Name of a scene in the file `path`: project files relative to its folder, everything else
/// unchanged.
pub(super) fn scene_text(scene: &str, path: &Path) -> String {
    let relative = || {
        let file = Path::new(scene)
            .canonicalize()
            .ok()
            .filter(|p| p.is_file())?;
        let folder = std::path::absolute(path)
            .ok()?
            .parent()?
            .canonicalize()
            .ok()?;
        let project = folder
            .ancestors()
            .find(|p| p.join("passes").is_dir() && p.join("shaders").is_dir())?;
        file.starts_with(project)
            .then(|| between(&folder, &file))?
            .to_str()
            .map(String::from)
    };
    relative().unwrap_or_else(|| scene.to_string())
}

/// The environment in the file `path`; empty if not set. Files outside the project get an absolute
/// path, so that they are found from everywhere.
pub(super) fn environment_in(experiment: &Experiment, path: &Path) -> String {
    let Some(Loc { value: change, .. }) = &experiment.environment else {
        return String::new();
    };
    let file = change.file.as_ref().map(|file| {
        let text = scene_text(file, path);
        let whole = Path::new(file)
            .canonicalize()
            .ok()
            .filter(|_| text == *file);
        whole
            .and_then(|p| p.to_str().map(String::from))
            .unwrap_or(text)
    });
    environment_text(&EnvironmentChange {
        file,
        ..change.clone()
    })
}

/// An environment as RON.
fn environment_text(change: &EnvironmentChange) -> String {
    let file = change
        .file
        .as_ref()
        .map(|file| format!("file: {}", quoted(file)));
    let numbers = [
        ("rotation", change.rotation),
        ("intensity", change.intensity),
    ];
    let numbers = numbers
        .iter()
        .filter_map(|(n, v)| v.map(|v| format!("{n}: {v:?}")));
    format!(
        "({})",
        file.into_iter()
            .chain(numbers)
            .collect::<Vec<_>>()
            .join(", ")
    )
}

/// The relative path from a folder to a file, both absolute.
fn between(folder: &Path, file: &Path) -> PathBuf {
    let common = folder
        .components()
        .zip(file.components())
        .take_while(|(a, b)| a == b)
        .count();
    let up = folder
        .components()
        .skip(common)
        .map(|_| Component::ParentDir);
    up.chain(file.components().skip(common)).collect()
}

pub(super) fn quoted(text: &str) -> String {
    format!("{text:?}")
}

pub(super) fn vector((x, y, z): (f32, f32, f32)) -> String {
    format!("({x:?}, {y:?}, {z:?})")
}

/// A placed camera as RON.
pub(crate) fn placed_text(c: &PlacedCamera) -> String {
    let mut out = format!("(eye: {}, target: {}", vector(c.eye), vector(c.target));
    if c.up != super::y_up() {
        out += &format!(", up: {}", vector(c.up));
    }
    out += &format!(", fov_y: {:?}", c.fov_y);
    for (name, value) in [("near", c.near), ("far", c.far)] {
        out += &value.map_or(String::new(), |v| format!(", {name}: {v:?}"));
    }
    out + ")"
}

pub(super) fn camera_text(camera: &CameraChoice) -> String {
    match camera {
        CameraChoice::Named(name) => quoted(name),
        CameraChoice::Placed(placed) => placed_text(placed),
    }
}

impl Wanted<'_> {
    fn lights(&self) -> Vec<(String, String)> {
        self.experiment
            .lights
            .iter()
            .map(|(name, change)| (name.value.clone(), change.to_text()))
            .collect()
    }
}

fn fresh(wanted: &Wanted) -> String {
    let mut out = String::from("(\n");
    for field in FIELDS {
        // Camera and size are always written, so that readers need not look up the defaults.
        if !(field.absent)(wanted.experiment) || ["camera", "size"].contains(&field.name) {
            out += &format!(
                "    {}: {},\n",
                field.name,
                field.text(wanted.experiment, wanted.path)
            );
        }
    }
    let lights = wanted.lights();
    if !lights.is_empty() {
        out += &format!(
            "    {},\n",
            map_text("lights", &lights).replace('\n', "\n    ")
        );
    }
    out += &format!(
        "    {},\n)\n",
        map_text("params", &wanted.params).replace('\n', "\n    ")
    );
    out
}

fn map_text(name: &str, entries: &[(String, String)]) -> String {
    if entries.is_empty() {
        return format!("{name}: {{}}");
    }
    let lines: Vec<String> = entries
        .iter()
        .map(|(k, v)| format!("    {}: {v},\n", quoted(k)))
        .collect();
    format!("{name}: {{\n{}}}", lines.concat())
}

/// The text of the file at `path` with changed values edited in place. `None` if it is not an
/// experiment or has a form that [`spans`] does not support.
fn edited(wanted: &Wanted, defaults: &Params) -> Option<String> {
    let old = Experiment::read(wanted.path).ok()?;
    let text = std::fs::read_to_string(wanted.path).ok()?;
    let body = spans::body(&text, 0)?;
    let mut edits = Edits::new();
    let mut lines = Vec::new();
    let mut keeps_last = true;
    for field in FIELDS {
        let (name, new) = (field.name, field.text(wanted.experiment, wanted.path));
        match body.entries.iter().enumerate().find(|(_, e)| e.key == name) {
            Some(_) if (field.same)(&old, wanted.experiment) => {}
            Some((i, entry)) if new.is_empty() => {
                keeps_last &= i + 1 < body.entries.len();
                edits.push(spans::remove(&text, entry));
            }
            Some((_, entry)) => edits.push((entry.value.clone(), new)),
            None if (field.absent)(wanted.experiment) => {}
            None => lines.push(format!("{name}: {new},")),
        }
    }
    let same_param = |name: &str, old: &str, new: &str| {
        let param = defaults.param(name);
        param.is_some_and(|p| p.parse(old).is_ok_and(|v| Ok(v) == p.parse(new)))
    };
    let same_light = |name: &str, _: &str, new: &str| {
        old.lights
            .iter()
            .any(|(n, change)| n.value == name && change.to_text() == new)
    };
    // Explicit defaults of the author are kept while they remain valid.
    let mut params = wanted.params.clone();
    for (name, text) in &old.params {
        let param = defaults
            .index(&name.value)
            .map(|i| (&defaults.list[i], &wanted.values.values[i]));
        let is_true = param.is_some_and(|(p, now)| p.parse(text).as_ref() == Ok(now));
        if is_true && !params.iter().any(|p| p.0 == name.value) {
            params.push((name.value.clone(), text.clone()));
        }
    }
    let lights = wanted.lights();
    let maps = [
        ("lights", &lights, &same_light as &Same),
        ("params", &params, &same_param as &Same),
    ];
    for (name, entries, same) in maps {
        match body.entries.iter().find(|e| e.key == name) {
            Some(entry) => {
                let inner = spans::body(&text, entry.value.start)?;
                edit_map(&text, &inner, entries, same, &mut edits);
            }
            None if entries.is_empty() => {}
            None => lines.push(map_text(name, entries) + ","),
        }
    }
    spans::append(&text, &body, keeps_last, &lines, &mut edits);
    Some(spans::apply(&text, edits))
}

/// Whether an entry (name, old text, new text) says the same.
type Same<'a> = dyn Fn(&str, &str, &str) -> bool + 'a;

fn edit_map(text: &str, body: &Body, wanted: &[(String, String)], same: &Same, edits: &mut Edits) {
    let mut keeps_last = false;
    for entry in &body.entries {
        let new = wanted.iter().find(|(name, _)| *name == entry.key);
        keeps_last = new.is_some();
        match new {
            None => edits.push(spans::remove(text, entry)),
            Some((name, new)) if !same(name, &text[entry.value.clone()], new) => {
                edits.push((entry.value.clone(), new.clone()));
            }
            Some(_) => {}
        }
    }
    let added = wanted
        .iter()
        .filter(|(name, _)| !body.entries.iter().any(|e| e.key == *name));
    let lines: Vec<String> = added
        .map(|(name, value)| format!("{}: {value},", quoted(name)))
        .collect();
    spans::append(text, body, keeps_last, &lines, edits);
}
