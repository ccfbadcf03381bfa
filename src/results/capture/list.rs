//! Lists captures, and removes incomplete ones of killed programs.

use super::{EXPERIMENT, MANIFEST, Manifest};
use std::path::{Path, PathBuf};

/// A capture in a list.
#[derive(Clone, Debug)]
pub struct Summary {
    /// Name: that of its folder.
    pub name: String,
    /// Folder of the capture.
    pub folder: PathBuf,
    /// Its manifest, or the error of reading it.
    pub manifest: Result<Manifest, String>,
    /// The picture to display.
    pub picture: Option<PathBuf>,
}

/// The captures in a folder by name, including damaged ones. Incomplete captures and other folders
/// are skipped.
pub fn list(folder: &Path) -> Vec<Summary> {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return Vec::new();
    };
    let mut list: Vec<Summary> = entries
        .flatten()
        .filter_map(|e| summary(&e.path()))
        .collect();
    list.sort_by(|a, b| a.name.cmp(&b.name));
    list
}

fn summary(folder: &Path) -> Option<Summary> {
    let name = folder.file_name()?.to_string_lossy().into_owned();
    let has = |file: &str| folder.join(file).is_file();
    if name.starts_with('.') || !(has(MANIFEST) || has(EXPERIMENT)) {
        return None;
    }
    let manifest = Manifest::read(folder)
        .map_err(|e| e.to_string())
        .and_then(|manifest| match manifest.files.keys().find(|f| !has(f)) {
            Some(missing) => Err(format!(
                "'{}': the file '{missing}' is missing",
                folder.display()
            )),
            None => Ok(manifest),
        });
    let picture = Some(folder.join("picture.png")).filter(|p| p.is_file());
    Some(Summary {
        name,
        folder: folder.to_path_buf(),
        manifest,
        picture,
    })
}

/// Removes incomplete captures of programs that no longer run, and returns their number. Removes
/// nothing if running programs are unknown (no `/proc`).
pub fn sweep_partials(folder: &Path) -> usize {
    let processes = Path::new("/proc");
    if !processes.join("self").exists() {
        return 0;
    }
    let Ok(entries) = std::fs::read_dir(folder) else {
        return 0;
    };
    let left = entries.flatten().filter(|entry| {
        let name = entry.file_name().to_string_lossy().into_owned();
        let is_folder = entry.file_type().is_ok_and(|t| t.is_dir());
        is_folder && partial_of(&name).is_some_and(|pid| !processes.join(pid.to_string()).exists())
    });
    left.filter(|entry| std::fs::remove_dir_all(entry.path()).is_ok())
        .count()
}

/// The process that makes, or made, the incomplete capture in a folder of this name.
fn partial_of(name: &str) -> Option<u32> {
    let (_, rest) = name.strip_prefix('.')?.split_once(".partial-")?;
    rest.split_once('-')?.0.parse().ok()
}
