//! Opening a scene by name: a built-in, a scene file or a model file.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::{Arc, mpsc};
use std::time::Duration;

use glam::Vec3;

use crate::files::{ending, path_of};

use super::formats::{SCENE_FILE, load_model};
use super::limits::with_size_told;
use super::progress::{Progress, Watch};
use super::texture::with_kinds_told;
use super::{Scene, SceneError, builtin, defaults, file};

/// Interval between calls of the callback while a scene loads.
const ASK: Duration = Duration::from_millis(20);

impl Scene {
    /// Opens a built-in scene, a scene file (.ron) or a model file by name. A path that may not be
    /// UTF-8 is escaped by [`crate::files::spec_of`].
    ///
    /// A model without lights gets a sun and a sky; a model with lights has a black sky. The
    /// model's first camera becomes the camera `default`; a model without cameras gets one. The
    /// calling thread calls `progress` about 50 times a second with the current step and the
    /// completed fraction, 0 to 1. If it returns `Break`, the opening ends at once with
    /// [`SceneError::Cancelled`].
    pub fn open(
        spec: &str,
        progress: &dyn Fn(&str, f32) -> ControlFlow<()>,
    ) -> Result<Scene, SceneError> {
        Scene::open_with_files(spec, progress).0
    }

    /// [`Scene::open`], and the sorted list of files that were read or looked up. The list is also
    /// complete for a scene that failed to open, so that a change of any of them can be watched.
    pub(crate) fn open_with_files(
        spec: &str,
        progress: &dyn Fn(&str, f32) -> ControlFlow<()>,
    ) -> (Result<Scene, SceneError>, Vec<PathBuf>) {
        let watch = Arc::new(Watch::new(spec));
        let scene = open_watched(spec, &watch, progress);
        (scene, watch.files())
    }
}

fn open_watched(
    spec: &str,
    watch: &Arc<Watch>,
    progress: &dyn Fn(&str, f32) -> ControlFlow<()>,
) -> Result<Scene, SceneError> {
    // Decoders and parsers cannot be interrupted, so they run on another thread. After a
    // cancellation the current step ends unnoticed and the next one does not begin.
    let (send, result) = mpsc::channel();
    let worker = std::thread::spawn({
        let (spec, watch) = (spec.to_owned(), watch.clone());
        move || drop(send.send(load(&spec, Progress::new(&watch))))
    });
    loop {
        let (what, done) = watch.now();
        if progress(&what, done).is_break() {
            watch.stop();
            return Err(SceneError::Cancelled);
        }
        match result.recv_timeout(ASK) {
            Ok(loaded) => {
                return loaded
                    .map(with_size_told)
                    .map(with_kinds_told)
                    .map(with_light_names)
                    .map(Scene::with_seen_distance);
            }
            Err(mpsc::RecvTimeoutError::Timeout) => {}
            Err(mpsc::RecvTimeoutError::Disconnected) => break,
        }
    }
    // The worker ended without a result.
    match worker.join() {
        Err(panic) => std::panic::resume_unwind(panic),
        Ok(()) => Err(SceneError::Cancelled),
    }
}

/// Gives every light a name of its own, by which experiments change it.
fn with_light_names(mut scene: Scene) -> Scene {
    for i in 0..scene.lights.len() {
        let (before, rest) = scene.lights.split_at_mut(i);
        let is_free = |name: &String| !name.is_empty() && before.iter().all(|l| l.name != *name);
        let name = rest[0].name.clone();
        let stem = if name.is_empty() { "light" } else { &name };
        let numbered = (i + 1..).map(|number| format!("{stem} {number}"));
        let mut names = std::iter::once(name.clone()).chain(numbered);
        rest[0].name = names.find(is_free).unwrap_or_default();
    }
    scene
}

/// Opens a scene by name, on the worker thread.
fn load(spec: &str, progress: Progress) -> Result<Scene, SceneError> {
    if builtin::is_one(spec) {
        return file::open_builtin(spec, progress);
    }
    let path = &path_of(spec);
    progress.reads(path);
    if ending(path) == SCENE_FILE {
        return file::load(path, progress);
    }
    if path.extension().is_none() && !path.exists() {
        return Err(SceneError::NotFound {
            spec: spec.into(),
            hint: builtin::hint(spec),
        });
    }
    let mut scene = load_model(path, None, progress)?;
    scene.sky = defaults::sky_over(&scene);
    let is_bare = scene.lights.is_empty();
    if is_bare {
        scene.lights.push(defaults::sun());
    }
    if !scene.cameras.contains_key("default") {
        let own = scene.cameras.values().next().copied();
        let camera = own.unwrap_or_else(|| defaults::camera(&scene));
        scene.cameras.shift_insert(0, "default".into(), camera);
    }
    let is_dark = is_bare && scene.materials.iter().all(|m| m.emission == Vec3::ZERO);
    scene.enclosed = is_dark && scene.encloses(scene.cameras["default"].eye);
    Ok(scene)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fmt::Write;
    use std::time::Instant;

    #[test]
    fn all_files_of_a_scene_are_named_though_it_fails() {
        let folder = tempfile::tempdir().unwrap();
        let write =
            |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
        write("a.ron", "(models: [(file: \"a.obj\"), (file: \"b.gltf\")])");
        write(
            "a.obj",
            "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n",
        );
        write("a.mtl", "newmtl m\nmap_Kd gone.png\n");
        let buffers = "\"buffers\": [{\"uri\": \"b.bin\", \"byteLength\": 4}]";
        write(
            "b.gltf",
            &format!("{{\"asset\": {{\"version\": \"2.0\"}}, {buffers}, \"meshes\": 7}}"),
        );
        let open = || {
            Scene::open_with_files(folder.path().join("a.ron").to_str().unwrap(), &|_, _| {
                ControlFlow::Continue(())
            })
        };
        let names = |files: Vec<PathBuf>| -> Vec<String> {
            files
                .iter()
                .map(|f| f.file_name().unwrap().to_string_lossy().into_owned())
                .collect()
        };
        let (scene, files) = open();
        assert!(scene.is_err());
        assert_eq!(
            names(files),
            ["a.mtl", "a.obj", "a.ron", "b.gltf", "gone.png"]
        );
        write(
            "b.gltf",
            &format!("{{\"asset\": {{\"version\": \"2.0\"}}, {buffers}}}"),
        );
        let (scene, files) = open();
        assert!(scene.is_ok(), "{:?}", scene.err());
        assert_eq!(
            names(files),
            ["a.mtl", "a.obj", "a.ron", "b.bin", "b.gltf", "gone.png"]
        );
    }

    #[test]
    fn work_that_nobody_waits_for_ends_early() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("large.obj");
        let mut text = "v 0 0 1\nv 0 1 0\n".to_owned();
        for i in 0..700_000 {
            let _ = writeln!(text, "v {} {} {}\nf -1 -2 -3", i % 100, i % 7, i / 100);
        }
        std::fs::write(&path, text).unwrap();
        let spec = path.to_string_lossy().into_owned();
        let watch = Watch::new(&spec);
        std::thread::scope(|scope| {
            let worker = scope.spawn(|| load(&spec, Progress::new(&watch)));
            std::thread::sleep(Duration::from_millis(40));
            assert!(
                !worker.is_finished(),
                "the model is too small for this test"
            );
            assert_eq!(watch.now().0, "reading");
            watch.stop();
            let stopped = Instant::now();
            assert!(worker.join().unwrap().is_err());
            assert!(
                stopped.elapsed() < Duration::from_millis(500),
                "{:?}",
                stopped.elapsed()
            );
        });
    }
}
