//! Scene files (RON): models, shapes, lights, sky and cameras.

mod build;
mod compose;
mod format;
mod parts;
mod placement;

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::path::{Path, PathBuf};

use glam::{Mat4, Vec3};
use ron::extensions::Extensions;

use crate::diagnostics::TOO_DEEP;
use crate::diagnostics::excerpt::excerpt;
use crate::files::read_input_text;

use super::limits::{check_extent, check_placed};
use super::progress::Progress;
use super::shapes::Problem;
use super::{Environment, Scene, SceneError, builtin, defaults, environment, formats, gltf};
use compose::Added;
use format::{EnvironmentEntry, ModelEntry, SceneFile, SkyOf};

/// Scene files larger than this are refused.
const MAX_BYTES: u64 = 4 << 20;

/// Maximum length of an error message that quotes the file.
const MAX_MESSAGE: usize = 400;

/// Opens a scene file and all files that it names.
pub(super) fn load(path: &Path, progress: Progress) -> Result<Scene, SceneError> {
    let text = read_input_text(path, MAX_BYTES).map_err(|source| SceneError::Read {
        path: path.into(),
        hint: "Check the path; scene files are UTF-8 text".into(),
        source,
    })?;
    read(&text, path, progress)
}

/// Opens a built-in scene by name.
pub(super) fn open_builtin(name: &str, progress: Progress) -> Result<Scene, SceneError> {
    let Some(text) = builtin::text(name) else {
        return Err(SceneError::NotFound {
            spec: name.into(),
            hint: builtin::hint(name),
        });
    };
    progress.step(name, 0.0)?;
    read(text, Path::new(&format!("{name}.ron")), progress)
}

/// Parses a scene file. `path` resolves relative paths and appears in messages.
fn read(text: &str, path: &Path, progress: Progress) -> Result<Scene, SceneError> {
    let file = parse(text, path)?;
    let name = path
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let mut scene = Scene {
        name: file.name.clone().unwrap_or(name),
        ..Scene::default()
    };
    let first_sky = add_models(&mut scene, &file, path, text, progress)?;
    progress
        .share(file.models.len(), file.models.len() + 1)
        .step(&scene.name, 0.0)?;
    let own = build::build(&file, progress);
    let own = own.map_err(|Problem { near, message }| match progress.stopped() {
        true => SceneError::Cancelled,
        false => in_file(path, text, &near, message),
    })?;
    check_extent(&own, Mat4::IDENTITY).map_err(|message| in_file(path, text, "", message))?;
    let own = compose::add(&mut scene, own).model;
    compose::add_placed(&mut scene, &own, &ModelEntry::default());
    match &file.environment {
        Some(entry) => {
            scene.environment = Some(open_environment(
                entry,
                path,
                text,
                &mut scene.warnings,
                progress,
            )?);
            scene.sky = file.sky.map_or(Vec3::ONE, |s| s.0) * entry.intensity;
        }
        // A sky radiance in the file replaces the first model's sky and environment map.
        None => {
            let (sky, picture) = first_sky.unwrap_or((defaults::SKY, None));
            scene.environment = picture.filter(|_| file.sky.is_none());
            scene.sky = file.sky.map_or(sky, |s| s.0);
        }
    }
    for light in &file.lights {
        let mut light = light.clone();
        if light.name.is_empty() {
            light.name = format!("light {}", scene.lights.len());
        }
        scene.lights.push(light);
    }
    let (low, high) = scene.bounds();
    let near = defaults::near_plane((high - low).length());
    for (name, camera) in file.cameras.into_iter().rev() {
        scene.cameras.shift_insert(0, name, camera.to_camera(near));
    }
    if scene.cameras.is_empty() {
        let camera = defaults::camera(&scene);
        scene.cameras.insert("default".into(), camera);
    }
    Ok(scene)
}

/// Adds the models of a scene file. Returns the sky of the first one.
fn add_models(
    scene: &mut Scene,
    file: &SceneFile,
    path: &Path,
    text: &str,
    progress: Progress,
) -> Result<Option<(Vec3, Option<Environment>)>, SceneError> {
    let mut first_sky = None;
    // Each model is read once; its placements share meshes.
    let mut added: BTreeMap<(bool, &str, Option<&str>), Added> = BTreeMap::new();
    for (i, entry) in file.models.iter().enumerate() {
        let named = entry
            .builtin
            .as_deref()
            .or(entry.file.as_deref())
            .unwrap_or_default();
        let share = progress.share(i, file.models.len() + 1);
        let known = match added.entry((entry.builtin.is_some(), named, entry.clip.as_deref())) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(new) => {
                new.insert(compose::add(scene, load_model(entry, path, text, share)?))
            }
        };
        if i == 0 {
            first_sky = Some(known.sky());
        }
        check_placed(&known.model, known.bounds, entry.transform).map_err(|message| {
            in_file(path, text, named, format!("'{named}', placed: {message}"))
        })?;
        compose::add_placed(scene, &known.model, entry);
    }
    Ok(first_sky)
}

fn open_environment(
    entry: &EnvironmentEntry,
    scene_file: &Path,
    text: &str,
    warnings: &mut Vec<String>,
    progress: Progress,
) -> Result<Environment, SceneError> {
    let file = match &entry.of {
        SkyOf::File(file) => file,
        SkyOf::Clear(sky) => {
            let sky = environment::clear_sky(sky).map_err(|m| in_file(scene_file, text, "", m))?;
            return Ok(Environment {
                rotation: entry.rotation,
                ..sky
            });
        }
    };
    let candidates = places(file, scene_file);
    // If the file does not exist, the error names the first candidate.
    let found = candidates
        .iter()
        .find(|candidate| candidate.is_file())
        .or(candidates.first());
    found.into_iter().for_each(|f| progress.reads(f));
    let opened = environment::read(found.map_or(Path::new(""), PathBuf::as_path), warnings);
    let environment = opened.map_err(|message| in_file(scene_file, text, file, message))?;
    Ok(Environment {
        rotation: entry.rotation,
        ..environment
    })
}

fn load_model(
    entry: &ModelEntry,
    scene_file: &Path,
    text: &str,
    progress: Progress,
) -> Result<Scene, SceneError> {
    if let Some(name) = &entry.builtin {
        return open_builtin(name, progress);
    }
    let file = entry.file.as_deref().unwrap_or_default();
    let found = model_file(file, scene_file).map_err(|message| {
        let candidates = places(file, scene_file);
        candidates.iter().for_each(|c| progress.reads(c));
        let (line, column) = position_of(text, file);
        SceneError::NoModel {
            path: scene_file.into(),
            line,
            column,
            message,
        }
    })?;
    let mut model = formats::load_model(&found, entry.clip.as_deref(), progress)?;
    if entry.lights {
        model.sky = defaults::sky_over(&model);
    } else {
        model.sky = defaults::SKY;
    }
    if entry.lights_scale.is_some() || !entry.lights {
        model
            .warnings
            .retain(|warning| !warning.contains(gltf::SCALE));
    }
    Ok(model)
}

/// The message about the first model file of a scene file that does not exist. `None` if all exist
/// or the scene file cannot be read.
pub(crate) fn missing_model(scene_file: &Path) -> Option<String> {
    let text = read_input_text(scene_file, MAX_BYTES).ok()?;
    let models = parse(&text, scene_file).ok()?.models;
    let mut files = models.iter().filter_map(|entry| entry.file.as_deref());
    files.find_map(|file| model_file(file, scene_file).err())
}

/// Path of a model that a scene file names.
fn model_file(file: &str, scene_file: &Path) -> Result<PathBuf, String> {
    let candidates = places(file, scene_file);
    let found = candidates.iter().find(|candidate| candidate.is_file());
    found.cloned().ok_or_else(|| {
        let tried: Vec<String> = candidates.iter().map(|c| c.display().to_string()).collect();
        format!(
            "model '{file}' not found; looked in: {}. Correct the path, or set CONELAB_SCENES to the folder that holds it",
            tried.join(", ")
        )
    })
}

/// Candidate paths of a file: the scene file's folder, then the folders of CONELAB_SCENES.
fn places(file: &str, scene_file: &Path) -> Vec<PathBuf> {
    let mut places = vec![scene_file.parent().unwrap_or(Path::new("")).join(file)];
    let folders = std::env::var_os("CONELAB_SCENES").unwrap_or_default();
    places.extend(
        std::env::split_paths(&folders)
            .filter(|f| !f.as_os_str().is_empty())
            .map(|f| f.join(file)),
    );
    places
}

/// An error at the position of a quoted string of the scene file.
fn in_file(path: &Path, text: &str, near: &str, message: String) -> SceneError {
    let (line, column) = position_of(text, near);
    SceneError::SceneFile {
        path: path.into(),
        line,
        column,
        message: excerpt(&message, MAX_MESSAGE),
    }
}

/// Line and column of a quoted string, from 1; (1, 1) if it does not occur verbatim.
fn position_of(text: &str, string: &str) -> (usize, usize) {
    let Some(offset) = text.find(&format!("\"{string}\"")) else {
        return (1, 1);
    };
    let before = &text[..offset];
    let column = before
        .rsplit('\n')
        .next()
        .unwrap_or_default()
        .chars()
        .count()
        + 1;
    (before.matches('\n').count() + 1, column)
}

fn parse(text: &str, path: &Path) -> Result<SceneFile, SceneError> {
    let options = ron::Options::default()
        .with_default_extension(Extensions::IMPLICIT_SOME | Extensions::UNWRAP_VARIANT_NEWTYPES);
    options
        .from_str(text)
        .map_err(|error| SceneError::SceneFile {
            path: path.into(),
            line: error.span.start.line,
            column: error.span.start.col,
            message: excerpt(&describe(&error.code), MAX_MESSAGE),
        })
}

/// The parser's message, with the nearest known name for an unknown one.
fn describe(error: &ron::Error) -> String {
    let (kind, found, expected) = match error {
        ron::Error::NoSuchStructField {
            found, expected, ..
        } => ("field", found, *expected),
        ron::Error::NoSuchEnumVariant {
            found, expected, ..
        } => ("kind", found, *expected),
        ron::Error::ExceededRecursionLimit => return TOO_DEEP.into(),
        other => return other.to_string(),
    };
    let score =
        |known: &&&str| strsim::damerau_levenshtein(&known.to_lowercase(), &found.to_lowercase());
    let hint = match expected.iter().min_by_key(score) {
        Some(nearest) if score(&nearest) <= 3 => format!("did you mean '{nearest}'? "),
        _ => String::new(),
    };
    format!(
        "unknown {kind} '{found}': {hint}Known here: {}",
        expected.join(", ")
    )
}
