//! Lookup of files by paths written on other machines.

use std::collections::HashMap;
use std::path::{Component, Path, PathBuf};

use crate::scene::obj::{shown, without_comment};
use crate::scene::warnings::Warnings;

/// Longer texts are not paths.
const LONGEST: usize = 4096;
/// Maximum number of searches for misplaced files; each costs several file system calls.
const SEARCHES: usize = 4096;
/// Maximum folder entries compared case-insensitively.
const ENTRIES: usize = 1 << 16;
/// Trailing folders of a foreign path that are tried.
const DEPTH: usize = 8;

/// Finds files relative to the model's folder.
pub(in crate::scene) struct Finder {
    folder: PathBuf,
    /// Cached results.
    known: HashMap<String, (PathBuf, Found)>,
    /// For each listed folder, names by their lower case.
    listed: HashMap<PathBuf, HashMap<String, String>>,
    searches: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::scene) enum Found {
    /// At the given path.
    Exact,
    /// With other case or in another folder.
    Elsewhere,
    No,
}

impl Finder {
    pub fn new(folder: &Path) -> Finder {
        Finder {
            folder: folder.into(),
            known: HashMap::new(),
            listed: HashMap::new(),
            searches: 0,
        }
    }

    /// The file of a path, or its expected location. A file with other case or in another folder
    /// gives a warning.
    pub fn find(&mut self, text: &str, warnings: &mut Warnings) -> PathBuf {
        let (path, found) = self.look(text);
        if found == Found::Elsewhere {
            warnings.add(
                "files were found under a name in another case, or in another folder",
                shown(text),
            );
        }
        path
    }

    /// [`Finder::find`] without a warning.
    pub fn look(&mut self, text: &str) -> (PathBuf, Found) {
        if let Some(known) = self.known.get(text) {
            return known.clone();
        }
        let found = self.search(text);
        self.known.insert(text.to_owned(), found.clone());
        found
    }

    fn search(&mut self, text: &str) -> (PathBuf, Found) {
        if text.len() > LONGEST {
            return (self.folder.join(shown(text)), Found::No);
        }
        let names = [path_of(text), path_of(without_comment(text))];
        for name in &names {
            let path = self.folder.join(name);
            if is_there(&path) {
                return (path, Found::Exact);
            }
        }
        self.searches += 1;
        if self.searches <= SEARCHES {
            for name in &names {
                if let Some(path) = self.elsewhere(name) {
                    return (path, Found::Elsewhere);
                }
            }
        }
        let [_, name] = names;
        (self.folder.join(name), Found::No)
    }

    /// The file with other case, or the end of its path below the model's folder.
    fn elsewhere(&mut self, name: &str) -> Option<PathBuf> {
        let is_drive = |part: &&str| part.len() == 2 && part.ends_with(':');
        let parts: Vec<&str> = name
            .split('/')
            .filter(|part| !part.is_empty() && !is_drive(part))
            .collect();
        let shortest = parts.len().saturating_sub(DEPTH).max(1);
        std::iter::once(0)
            .chain(shortest..parts.len())
            .find_map(|first| {
                let tail = parts.get(first..).filter(|tail| !tail.is_empty())?;
                self.without_case(&tail.join("/"))
            })
    }

    /// A path below the model's folder, ignoring case.
    fn without_case(&mut self, name: &str) -> Option<PathBuf> {
        let mut path = self.folder.clone();
        for part in Path::new(name).components() {
            match part {
                Component::Normal(part) if !is_there_any(&path.join(part)) => {
                    let lower = part.to_string_lossy().to_lowercase();
                    let real = self.listing(&path).get(&lower)?.clone();
                    path.push(real);
                }
                _ => path.push(part),
            }
        }
        is_there(&path).then_some(path)
    }

    fn listing(&mut self, folder: &Path) -> &HashMap<String, String> {
        self.listed.entry(folder.to_owned()).or_insert_with(|| {
            let folder = if folder.as_os_str().is_empty() {
                Path::new(".")
            } else {
                folder
            };
            let entries = std::fs::read_dir(folder)
                .into_iter()
                .flatten()
                .flatten()
                .take(ENTRIES);
            let mut names: Vec<String> = entries
                .filter_map(|entry| entry.file_name().into_string().ok())
                .collect();
            // Folder order is arbitrary: of `A` and `a`, the first by name wins.
            names.sort_unstable_by(|a, b| b.cmp(a));
            names
                .into_iter()
                .map(|name| (name.to_lowercase(), name))
                .collect()
        })
    }
}

/// A normalised path: without quotes, with forward slashes.
fn path_of(text: &str) -> String {
    let text = text.trim();
    let quoted = |q: char| {
        text.strip_prefix(q)
            .and_then(|t| t.split_once(q))
            .map(|(name, _)| name)
    };
    quoted('"')
        .or_else(|| quoted('\''))
        .unwrap_or(text)
        .replace('\\', "/")
}

/// Whether the path exists; only regular files are opened later.
fn is_there(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|found| !found.is_dir())
}

fn is_there_any(path: &Path) -> bool {
    std::fs::symlink_metadata(path).is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_found_as_other_machines_name_them() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("textures")).unwrap();
        for name in ["textures/wall.png", "my wall.png", "Roof.PNG"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let mut finder = Finder::new(folder.path());
        for (text, name, found) in [
            ("textures/wall.png", "textures/wall.png", Found::Exact),
            (".\\textures\\\\wall.png", "textures/wall.png", Found::Exact),
            ("\"my wall.png\"", "my wall.png", Found::Exact),
            ("my wall.png # x", "my wall.png", Found::Exact),
            ("Textures\\Wall.PNG", "textures/wall.png", Found::Elsewhere),
            (
                "C:\\Users\\me\\textures\\wall.png",
                "textures/wall.png",
                Found::Elsewhere,
            ),
            (
                "\\\\server\\share\\MY WALL.png",
                "my wall.png",
                Found::Elsewhere,
            ),
            ("/home/me/roof.png", "Roof.PNG", Found::Elsewhere),
            ("maps/roof.png", "Roof.PNG", Found::Elsewhere),
            ("gone.png", "gone.png", Found::No),
        ] {
            let (path, how) = finder.look(text);
            let (path, expected) = (
                path.canonicalize().ok(),
                folder.path().join(name).canonicalize().ok(),
            );
            assert_eq!((path, how), (expected, found), "{text}");
        }
        assert_eq!(finder.look(&"x".repeat(100_000)).1, Found::No);
    }
}
