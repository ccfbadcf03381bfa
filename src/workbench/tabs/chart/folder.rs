//! A sweep's folder, read on a thread.

use crate::campaign::report::Data;
use crate::campaign::sweep::{Subject, collect};
use crate::lab::LabError;
use crate::workbench::background::{Background, Wake};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Folders under `captures/sweeps` that hold a sweep, by name.
pub fn list(captures: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(captures.join("sweeps"))
        .into_iter()
        .flatten()
        .flatten();
    let mut list: Vec<PathBuf> = entries
        .map(|e| e.path())
        .filter(|p| p.join("sweep.json").is_file())
        .collect();
    list.sort();
    list
}

/// The folder's name.
pub fn name(folder: &Path) -> String {
    folder
        .file_name()
        .map_or(String::new(), |n| n.to_string_lossy().into_owned())
}

/// A folder that is read or has been.
pub struct Folder {
    /// Path of the folder.
    pub path: PathBuf,
    /// Its points, or why they cannot be read; nothing while they are read.
    pub data: Option<Result<Arc<Data>, String>>,
    work: Background<(), Result<Data, LabError>>,
}

impl Folder {
    /// Begins to read a folder.
    pub fn open(path: PathBuf, wake: &Wake) -> Folder {
        let mut folder = Folder {
            path,
            data: None,
            work: Background::default(),
        };
        folder.read(wake);
        folder
    }

    /// Reads the folder again. The old data stays until then.
    pub fn read(&mut self, wake: &Wake) {
        let folder = self.path.clone();
        let read = move || collect(&[folder]).map(|c| Data::new(&c));
        self.work.start((), wake, read);
    }

    /// Takes in the data. Returns whether it came now.
    pub fn take(&mut self) -> bool {
        let Some(((), data)) = self.work.take() else {
            return false;
        };
        self.data = Some(data.and_then(|data| data.map(Arc::new).map_err(|e| e.to_string())));
        true
    }
}

/// Differences between a picture and a subject in words; empty if they can be compared.
pub fn differences(now: &Subject, device: &str, subject: &(Subject, String)) -> Vec<&'static str> {
    let there = &subject.0;
    let list = [
        ("scene", now.scene != there.scene),
        (
            "light or geometry",
            now.scene == there.scene && now.sha256 != there.sha256,
        ),
        ("camera", now.camera != there.camera),
        ("size", now.size != there.size),
        ("time", now.time != there.time),
        ("device", device != subject.1),
    ];
    list.into_iter().filter(|d| d.1).map(|d| d.0).collect()
}
