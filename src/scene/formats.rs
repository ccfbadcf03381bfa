//! Model file formats. A new format is a reader and a row of [`FORMATS`].

use std::path::Path;

use glam::Mat4;

use crate::diagnostics::panics::caught;
use crate::files::ending;

use super::limits::check_extent;
use super::progress::Progress;
use super::{Material, Scene, SceneError, fbx, gltf, obj};

/// Extension of scene files, which combine models and shapes.
pub(crate) const SCENE_FILE: &str = "ron";

/// A format of model files.
struct ModelFormat {
    name: &'static str,
    /// Extensions in lower case.
    extensions: &'static [&'static str],
    /// Reads geometry, materials, lights, cameras and motion. The reader records every file that
    /// it opens or looks up by [`Progress::reads`], so that changes of them reload the scene.
    read: Reader,
}

enum Reader {
    Static(fn(&Path, Progress) -> Result<Scene, SceneError>),
    /// The second argument names the animation to play instead of the first.
    Animated(fn(&Path, Option<&str>, Progress) -> Result<Scene, SceneError>),
}

/// All formats of model files, in the order of messages.
const FORMATS: &[ModelFormat] = &[
    ModelFormat {
        name: "OBJ",
        extensions: &["obj"],
        read: Reader::Static(obj::load),
    },
    ModelFormat {
        name: "glTF",
        extensions: &["gltf", "glb"],
        read: Reader::Animated(gltf::load),
    },
    ModelFormat {
        name: "FBX",
        extensions: &["fbx"],
        read: Reader::Animated(fbx::load),
    },
];

/// The extensions of all models, without dots.
pub(crate) fn model_extensions() -> impl Iterator<Item = &'static str> {
    FORMATS.iter().flat_map(|f| f.extensions.iter().copied())
}

/// The extensions of scene files and models for messages: ".ron, .obj or .glb".
pub(crate) fn extensions() -> String {
    let mut list: Vec<String> = std::iter::once(SCENE_FILE)
        .chain(model_extensions())
        .map(|extension| format!(".{extension}"))
        .collect();
    let last = list.pop().unwrap_or_default();
    format!("{} or {last}", list.join(", "))
}

/// The content of a model file without defaults; `clip` names the animation to play instead of the
/// first.
pub(super) fn load_model(
    path: &Path,
    clip: Option<&str>,
    progress: Progress,
) -> Result<Scene, SceneError> {
    let fail = SceneError::model(path);
    progress.reads(path);
    let extension = ending(path);
    let Some(format) = FORMATS
        .iter()
        .find(|format| format.extensions.contains(&extension.as_str()))
    else {
        return Err(SceneError::NotFound {
            spec: path.display().to_string(),
            hint: format!(
                "the file's extension must be {}; convert other formats to glTF",
                extensions()
            ),
        });
    };
    let read = || match (&format.read, clip) {
        (Reader::Static(read), None) => read(path, progress),
        (Reader::Static(_), Some(_)) => Err(fail(format!(
            "{} files have no clips. Leave `clip` out",
            format.name
        ))),
        (Reader::Animated(read), clip) => read(path, clip, progress),
    };
    let mut scene = caught(read).unwrap_or_else(|message| {
        Err(fail(format!(
            "{message}. The file is damaged; export it again"
        )))
    })?;
    check_extent(&scene, Mat4::IDENTITY).map_err(fail)?;
    // Materials that discard everything already have a warning.
    if scene.triangle_count() == 0 && !scene.materials.iter().any(Material::is_left_out) {
        scene.warnings.push(format!(
            "{}: no triangles: there is nothing to see",
            path.display()
        ));
    }
    scene.name = path
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    Ok(scene)
}
