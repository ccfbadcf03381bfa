//! The real places of a file: its events come from the folders of these places.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Links that lead to one another before the rest is not followed.
const MAX_LINKS: usize = 16;
/// Folders below one that are searched for links.
const MAX_FOLDERS: usize = 4096;

/// An absolute path in a folder without links; the file itself may be one.
pub(super) fn absolute(file: &Path) -> PathBuf {
    let path = std::path::absolute(file).unwrap_or_else(|_| file.into());
    let folder = path.parent().and_then(|p| p.canonicalize().ok());
    match (folder, path.file_name()) {
        (Some(folder), Some(name)) => folder.join(name),
        _ => path,
    }
}

/// A file and, where it is a link, every file on the way to its target: each of them may be
/// replaced.
pub(super) fn places(file: &Path) -> BTreeSet<PathBuf> {
    let mut all = BTreeSet::new();
    let mut next = absolute(file);
    while all.len() < MAX_LINKS && all.insert(next.clone()) {
        let Ok(target) = std::fs::read_link(&next) else {
            break;
        };
        next = absolute(&next.parent().unwrap_or(Path::new("/")).join(target));
    }
    all
}

/// The links to files in a folder and below it.
pub(super) fn links_below(folder: &Path) -> Vec<PathBuf> {
    let (mut links, mut folders, mut next) = (Vec::new(), vec![folder.to_path_buf()], 0);
    while let Some(folder) = folders.get(next).filter(|_| next < MAX_FOLDERS).cloned() {
        next += 1;
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            match entry.file_type() {
                Ok(kind) if kind.is_dir() => folders.push(entry.path()),
                // The watcher follows links to folders by itself.
                Ok(kind) if kind.is_symlink() && entry.path().is_file() => links.push(entry.path()),
                _ => {}
            }
        }
    }
    links
}
