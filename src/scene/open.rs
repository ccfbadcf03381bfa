//! Opening a scene by whatever names it: a built-in, a scene file or a model file.

use std::path::Path;

use super::{Scene, SceneError, builtin, defaults, file, gltf, obj};

impl Scene {
    /// Opens a built-in scene by name, a scene file (.ron) or a model (.obj, .gltf, .glb).
    ///
    /// A model without lights gets a sun and a sky, one without cameras a camera `default`. `progress` is told
    /// what is being done and the share done, 0 to 1.
    pub fn open(spec: &str, progress: &dyn Fn(&str, f32)) -> Result<Scene, SceneError> {
        if let Some(build) = builtin::find(spec) {
            progress(spec, 0.0);
            let scene = build();
            progress(spec, 1.0);
            return Ok(scene);
        }
        let path = Path::new(spec);
        if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("ron")) {
            return file::load(path, progress);
        }
        if path.extension().is_none() && !path.exists() {
            return Err(SceneError::NotFound { spec: spec.into(), hint: builtin::hint(spec) });
        }
        let mut scene = load_model(path, progress)?;
        if scene.lights.is_empty() {
            scene.lights.push(defaults::sun());
        }
        scene.sky = defaults::SKY;
        if !scene.cameras.contains_key("default") {
            let camera = defaults::camera(&scene);
            scene.cameras.shift_insert(0, "default".into(), camera);
        }
        Ok(scene)
    }
}

/// A model with what its file says and no more.
pub(super) fn load_model(path: &Path, progress: &dyn Fn(&str, f32)) -> Result<Scene, SceneError> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let mut scene = match extension.as_str() {
        "obj" => obj::load(path, progress)?,
        "gltf" | "glb" => gltf::load(path, progress)?,
        _ => {
            let hint = "the file's extension must be .ron, .obj, .gltf or .glb; convert other formats to glTF";
            return Err(SceneError::NotFound { spec: path.display().to_string(), hint: hint.into() });
        }
    };
    scene.name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    Ok(scene)
}
