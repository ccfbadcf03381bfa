//! `capture.json`: the description of a capture. Its content is not trusted.

use super::{EXPERIMENT, MANIFEST, SOURCES, failed};
use crate::experiment::check_size;
use crate::files::{check_input, hex};
use crate::lab::LabError;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fs::FileType;
use std::io::Read;
use std::path::{Component, Path};

/// Version of the schema.
pub const SCHEMA: &str = "conelab-capture-1";

/// Largest manifest, bytes.
const MAX_BYTES: u64 = 4 << 20;
/// Maximum files of a capture.
const MAX_FILES: usize = 10_000;
/// Maximum frames of a replay.
const MAX_FRAMES: usize = 1_000_000;

/// The scene of a capture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneRecord {
    /// Built-in name, or path as given.
    pub spec: String,
    pub name: String,
    /// SHA-256 of its content ([`super::scene_hash`]).
    pub sha256: String,
}

/// A picture of a capture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Image {
    /// Path in the capture, `.png` or `.exr`.
    pub file: String,
    /// Texture of the graph.
    pub texture: String,
    pub mip: u32,
    pub layer: u32,
}

/// The content of `capture.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// [`SCHEMA`].
    pub(crate) schema: String,
    pub(crate) version: String,
    /// Name of the device.
    pub device: String,
    /// Driver and its version.
    pub driver: String,
    /// Time of capture, RFC 3339, UTC.
    pub when: String,
    /// Name of the experiment.
    pub experiment: String,
    /// Name of the graph's file.
    pub graph: String,
    /// The rendered scene.
    pub scene: SceneRecord,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Rendered frames; the pictures show the last one.
    pub frames: usize,
    /// Time step between frames (s).
    pub step: f64,
    pub(crate) images: Vec<Image>,
    /// SHA-256 of every other file, by path in the capture.
    pub files: BTreeMap<String, String>,
}

impl Manifest {
    /// Reads and checks a capture's manifest.
    ///
    /// # Errors
    /// A missing or invalid manifest; a size out of bounds; a path outside the folder.
    pub fn read(folder: &Path) -> Result<Manifest, LabError> {
        let path = folder.join(MANIFEST);
        let text = crate::files::read_input_text(&path, MAX_BYTES)
            .map_err(|e| failed(&path, format!("cannot read it: {e}")))?;
        let manifest: Manifest = serde_json::from_str(&text)
            .map_err(|e| failed(&path, format!("it is damaged: {e}")))?;
        manifest.check(folder).map_err(|e| failed(&path, e))?;
        Ok(manifest)
    }

    fn check(&self, folder: &Path) -> Result<(), String> {
        if self.schema != SCHEMA {
            return Err(format!(
                "its schema is '{}', this program reads '{SCHEMA}'",
                self.schema
            ));
        }
        check_size((self.size[0], self.size[1]))?;
        check_frames(self.frames, self.step)?;
        if self.files.len() > MAX_FILES || self.images.is_empty() || self.images.len() > MAX_FILES {
            return Err(format!(
                "it must name 1 to {MAX_FILES} pictures and at most {MAX_FILES} files"
            ));
        }
        for file in self.files.keys() {
            inside(folder, file)?;
        }
        // Graphs and shaders include further files, which need not be listed.
        for link in below(&folder.join(SOURCES), &|kind| kind.is_symlink()).unwrap_or_default() {
            inside(folder, &format!("{SOURCES}/{link}"))?;
        }
        for image in &self.images {
            if !self.files.contains_key(&image.file) {
                return Err(format!(
                    "it has no checksum of the picture '{}'",
                    image.file
                ));
            }
            if !image.file.ends_with(".png") && !image.file.ends_with(".exr") {
                return Err(format!(
                    "the picture '{}' is neither .png nor .exr",
                    image.file
                ));
            }
        }
        if !self.files.contains_key(EXPERIMENT) {
            return Err(format!("it names no {EXPERIMENT}"));
        }
        Ok(())
    }
}

/// Checks the number of frames and the time step of a capture.
pub(super) fn check_frames(frames: usize, step: f64) -> Result<(), String> {
    if frames == 0 || frames > MAX_FRAMES || !step.is_finite() {
        return Err(format!(
            "frames must be 1 to {MAX_FRAMES}, and the step finite"
        ));
    }
    Ok(())
}

/// Checks that a path stays in the folder after resolving links.
fn inside(folder: &Path, file: &str) -> Result<(), String> {
    let path = Path::new(file);
    let plain = !file.is_empty() && path.components().all(|c| matches!(c, Component::Normal(_)));
    let leads_out = || match (folder.join(path).canonicalize(), folder.canonicalize()) {
        (Ok(file), Ok(folder)) => !file.starts_with(folder),
        _ => false,
    };
    if !plain || leads_out() {
        return Err(format!("the path '{file}' leads out of the capture"));
    }
    Ok(())
}

/// SHA-256 of a regular file, hexadecimal. A pipe in an untrusted capture would block forever.
pub(super) fn hash_file(path: &Path) -> std::io::Result<String> {
    check_input(path, u64::MAX)?;
    let mut file = std::fs::File::open(path)?;
    let mut hash = Sha256::new();
    let mut part = vec![0; 1 << 16];
    loop {
        match file.read(&mut part)? {
            0 => return Ok(hex(&hash.finalize())),
            n => hash.update(&part[..n]),
        }
    }
}

/// All files below a folder by relative path, without links.
pub(super) fn files_below(folder: &Path) -> std::io::Result<Vec<String>> {
    below(folder, &|kind| kind.is_file())
}

/// Entries of some kind below a folder by relative path; links are not followed.
fn below(folder: &Path, wanted: &dyn Fn(FileType) -> bool) -> std::io::Result<Vec<String>> {
    let mut list = Vec::new();
    let mut open = vec![String::new()];
    while let Some(at) = open.pop() {
        for entry in std::fs::read_dir(folder.join(&at))? {
            let entry = entry?;
            let name = entry.file_name().to_string_lossy().into_owned();
            let path = if at.is_empty() {
                name
            } else {
                format!("{at}/{name}")
            };
            let kind = entry.file_type()?;
            if kind.is_dir() {
                open.push(path);
            } else if wanted(kind) {
                list.push(path);
            }
        }
    }
    list.sort();
    Ok(list)
}
