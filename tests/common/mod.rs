//! What several tests share: the program itself, a device with validation, pictures as numbers.
#![allow(dead_code, reason = "each test uses a part")]

pub mod closed_meshes;
pub mod figures;
pub mod ggx;
pub mod model_file;
pub mod triangles;

use conelab::experiment::Experiment;
use conelab::lab::{Lab, Session, Workspace};
use conelab::scene::Scene;
use conelab::vulkan::GpuOptions;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::Arc;
use tempfile::TempDir;

/// The repository.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The device that tests run on: the software one, unless CONELAB_TEST_DEVICE names another.
pub fn device() -> String {
    std::env::var("CONELAB_TEST_DEVICE").unwrap_or("llvmpipe".into())
}

/// Whether that is the software one: some bounds hold for its rasteriser alone.
pub fn on_software() -> bool {
    device() == "llvmpipe"
}

/// A number that the environment gives, as for longer runs of what is drawn at random.
pub fn number(name: &str) -> Option<usize> {
    std::env::var(name).ok().map(|text| {
        text.parse()
            .unwrap_or_else(|_| panic!("{name}: '{text}' is no number"))
    })
}

/// Compiled shaders and pipelines, kept between the tests of one build.
pub fn cache() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("cache")
}

/// The program, on the folders of `home`, with a software device and the validation layer.
pub fn conelab(home: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_conelab"));
    command
        .env("CONELAB_HOME", home)
        .env("CONELAB_CACHE", cache())
        .current_dir(home);
    command
        .env("CONELAB_DEVICE", device())
        .env("CONELAB_VALIDATION", "true");
    command
}

/// Standard output of a command that succeeds.
#[track_caller]
pub fn succeeds(command: &mut Command) -> String {
    let output = command.output().unwrap();
    let (ok, out, err) = text(&output);
    // A program that was killed, or crashed, says nothing itself.
    assert!(ok, "{command:?} ended with {}\n{out}{err}", output.status);
    out
}

/// Standard error of a command that fails with exit code 1.
#[track_caller]
pub fn fails(command: &mut Command) -> String {
    let output = command.output().unwrap();
    let (_, out, err) = text(&output);
    assert_eq!(
        output.status.code(),
        Some(1),
        "{command:?} ended with {}\n{out}{err}",
        output.status
    );
    err
}

fn text(output: &Output) -> (bool, String, String) {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (
        output.status.success(),
        text(&output.stdout),
        text(&output.stderr),
    )
}

/// A software device with the validation layer.
pub fn lab(home: &Path) -> Lab {
    lab_without(home, &[])
}

/// The same, used as if it lacked these features.
pub fn lab_without(home: &Path, masks: &[&str]) -> Lab {
    let home = Workspace::with(home.to_path_buf(), Some(cache()));
    let options = GpuOptions {
        device: Some(device()),
        validation: true,
        without: masks.iter().map(|m| (*m).to_string()).collect(),
        ..GpuOptions::default()
    };
    Lab::open(home, options).unwrap()
}

/// A built-in scene.
pub fn scene(name: &str) -> Arc<Scene> {
    Arc::new(Scene::open(name, &|_, _| std::ops::ControlFlow::Continue(())).unwrap())
}

/// The plainest of the repository's graphs that has all of these parameters.
#[track_caller]
pub fn graph_with(params: &[(&str, &str)]) -> String {
    let home = Workspace::with(root().to_path_buf(), None);
    let has_all = |name: &String| {
        let graph = conelab::lab::load(&home.graph_path(name), &home.folders()).unwrap();
        params
            .iter()
            .all(|(name, _)| graph.params.index(name).is_some())
    };
    let own = |name: &str| {
        root()
            .join("tests/common")
            .join(name)
            .to_string_lossy()
            .into_owned()
    };
    let (base, both) = (own("base_color.ron"), own("warps_temporal.ron"));
    let graphs = [
        "rays.ron",
        "cones.ron",
        "warps.ron",
        "temporal.ron",
        "thesis.ron",
        "reference.ron",
        &base,
        &both,
    ]
    .map(String::from);
    graphs
        .into_iter()
        .find(has_all)
        .unwrap_or_else(|| panic!("no graph has all of {params:?}"))
}

/// An experiment of the repository's method: scene, size and what differs from the defaults.
pub fn experiment(scene: &str, size: (u32, u32), params: &[(&str, &str)]) -> Experiment {
    let mut experiment = Experiment::read(&root().join("configs/rays.ron")).unwrap();
    experiment.graph = graph_with(params);
    experiment.scene = scene.into();
    experiment.size = size;
    for (name, value) in params {
        let name = conelab::diagnostics::Loc {
            value: (*name).to_string(),
            at: Default::default(),
        };
        experiment.params.push((name, (*value).to_string()));
    }
    experiment
}

/// A session that keeps the content of `wanted`.
#[track_caller]
pub fn prepare(lab: &Lab, experiment: &Experiment, wanted: &[&str]) -> Session {
    let wanted = wanted.iter().map(|w| (*w).to_string()).collect();
    match lab.prepare(experiment, scene(&experiment.scene), |_| Ok(wanted)) {
        Ok((session, _)) => session,
        Err(e) => panic!("{e}"),
    }
}

/// Every message of the validation layer is a failure.
#[track_caller]
pub fn assert_clean(lab: &Lab) {
    let messages = lab.gpu.messages();
    assert!(messages.is_empty(), "{}", messages.join("\n"));
}

/// Texels of a texture, four floats each.
#[track_caller]
pub fn floats(session: &mut Session, name: &str, mip: u32) -> Vec<[f32; 4]> {
    session.texels(name, mip, 0).unwrap().floats()
}

/// The 32-bit words of a buffer.
#[track_caller]
pub fn words(session: &mut Session, name: &str) -> Vec<u32> {
    let bytes = session.buffer(name).unwrap();
    let words = bytes.chunks_exact(4);
    words
        .map(|b| u32::from_ne_bytes([b[0], b[1], b[2], b[3]]))
        .collect()
}

/// Mean of the red, green and blue of some texels.
pub fn mean(texels: &[[f32; 4]]) -> f64 {
    texels
        .iter()
        .flat_map(|t| &t[..3])
        .map(|v| f64::from(*v))
        .sum::<f64>()
        / (3 * texels.len()) as f64
}

/// A table without what differs from run to run: a line for each row, by column.
pub fn table(path: &Path) -> Vec<BTreeMap<String, String>> {
    let mut rows = table_with_times(path);
    rows.iter_mut()
        .for_each(|row| row.retain(|name, _| !name.ends_with(" ms")));
    rows
}

/// Rows of a CSV file by the names of its columns.
pub fn table_with_times(path: &Path) -> Vec<BTreeMap<String, String>> {
    csv::Reader::from_path(path)
        .unwrap()
        .deserialize()
        .map(Result::unwrap)
        .collect()
}

/// A copy of the repository's graphs, shaders and experiments, for what a test writes.
pub fn home() -> TempDir {
    let home = tempfile::tempdir().unwrap();
    for folder in ["passes", "shaders", "configs"] {
        copy(&root().join(folder), &home.path().join(folder));
    }
    home
}

/// Copies a folder with all that is in it.
pub fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap().flatten() {
        match entry.file_type().unwrap().is_dir() {
            true => copy(&entry.path(), &to.join(entry.file_name())),
            false => drop(std::fs::copy(entry.path(), to.join(entry.file_name())).unwrap()),
        }
    }
}
