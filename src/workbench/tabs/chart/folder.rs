//! A sweep's folder, read on a thread.

use crate::campaign::report::Data;
use crate::campaign::sweep::{Subject, collect};
use crate::lab::LabError;
use crossbeam_channel::{Receiver, unbounded};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Folders under `captures/sweeps` that hold a sweep, by name.
pub fn list(root: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(root.join("captures/sweeps"))
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
    coming: Receiver<Result<Data, LabError>>,
}

impl Folder {
    /// Begins to read a folder.
    pub fn open(path: PathBuf, wake: Arc<dyn Fn() + Send + Sync>) -> Folder {
        let (out, coming) = unbounded();
        let folder = path.clone();
        std::thread::spawn(move || {
            let _ = out.send(collect(&[folder]).map(|c| Data::new(&c)));
            wake();
        });
        Folder {
            path,
            data: None,
            coming,
        }
    }

    /// Takes in what was read; whether that was now.
    pub fn take(&mut self) -> bool {
        let Ok(data) = self.coming.try_recv() else {
            return false;
        };
        self.data = Some(data.map(Arc::new).map_err(|e| e.to_string()));
        true
    }
}

/// What a picture and a subject do not have in common, for people; empty if they can be compared.
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
