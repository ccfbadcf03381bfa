//! Reading a graph's file and those that it includes.

use super::findings::Findings;
use crate::diagnostics::excerpt::chain;
use crate::diagnostics::{At, Diagnostic, Place};
use crate::graph::file::{GraphFile, Retired};
use std::path::{Component, Path, PathBuf};

/// Where graphs and shaders are found.
#[derive(Clone, Debug)]
pub struct Folders {
    /// Graphs.
    pub passes: PathBuf,
    /// Shaders.
    pub shaders: PathBuf,
}

/// Files that a graph may have.
const MAX_FILES: usize = 256;
/// How deep includes may be nested.
const MAX_DEPTH: usize = 32;

pub(super) struct Include<'f> {
    pub folders: &'f Folders,
    pub found: Findings,
    /// Files that were read, each after its includes.
    pub files: Vec<GraphFile>,
    /// Files being read, each included by the one before.
    stack: Vec<PathBuf>,
    /// What to write instead of a graph's name that is no more.
    retired: Vec<(String, String)>,
}

/// The file of names that are no more, in the folder of graphs.
const RETIRED: &str = "retired.ron";

impl<'f> Include<'f> {
    pub fn new(folders: &'f Folders) -> Include<'f> {
        Include {
            folders,
            found: Findings::default(),
            files: Vec::new(),
            stack: Vec::new(),
            retired: Vec::new(),
        }
    }

    /// Reads the names that are no more; none where the folder has no such file.
    pub fn retired(&mut self) -> Retired {
        let Findings {
            sources,
            errors,
            broken,
            ..
        } = &mut self.found;
        let file = sources.read(&self.folders.passes.join(RETIRED)).ok();
        let retired: Retired = file
            .and_then(|f| sources.parse(f, errors, broken))
            .unwrap_or_default();
        self.retired = super::texts(&retired.graphs);
        retired
    }

    /// Reads a file, included from there.
    pub fn file(&mut self, path: &Path, from: Option<At>) {
        let in_circle = self.stack.iter().any(|p| p == path);
        if self.found.sources.paths().any(|p| p == path) && !in_circle {
            return;
        }
        if in_circle {
            let name = |p: &Path| {
                p.file_name()
                    .unwrap_or_default()
                    .to_string_lossy()
                    .into_owned()
            };
            let circle: Vec<String> = self
                .stack
                .iter()
                .skip_while(|p| *p != path)
                .map(|p| name(p))
                .collect();
            let message = format!(
                "'{}' includes itself: {} > {}",
                path.display(),
                circle.join(" > "),
                name(path)
            );
            return self.error(from, message);
        }
        if self.stack.len() >= MAX_DEPTH || self.found.sources.paths().count() >= MAX_FILES {
            let names: Vec<String> = self.stack.iter().map(|p| p.display().to_string()).collect();
            self.found.partial = true;
            let message = format!(
                "a graph has at most {MAX_FILES} files, {MAX_DEPTH} deep: {}",
                chain(&names)
            );
            return self.error(from, message);
        }
        let file = match self.found.sources.read(path) {
            Ok(file) => file,
            Err(e) => {
                let known = if path.exists() {
                    Vec::new()
                } else {
                    ron_files(&self.folders.passes)
                };
                let name = path
                    .file_name()
                    .map_or(String::new(), |n| n.to_string_lossy().into_owned());
                let found = from.map_or(e.clone(), |at| self.found.sources.error(at, e.message));
                let instead = self
                    .retired
                    .iter()
                    .find(|(graph, _)| *graph == name && !path.exists());
                self.found.errors.push(match instead {
                    Some((_, instead)) => found.help(Some(instead.clone())),
                    None => found.nearest(&name, known.iter().map(String::as_str)),
                });
                self.found.partial = true;
                return;
            }
        };
        let Findings {
            sources,
            errors,
            broken,
            ..
        } = &mut self.found;
        let Some(parsed) = sources.parse::<GraphFile>(file, errors, broken) else {
            self.found.partial = true;
            return;
        };
        self.stack.push(path.to_path_buf());
        for name in &parsed.include.0 {
            // A capture's graph comes from strangers: it may not quote files from elsewhere.
            match Path::new(&name.value)
                .components()
                .all(|c| matches!(c, Component::Normal(_)))
            {
                true => self.file(&self.folders.passes.join(&name.value), Some(name.at)),
                false => {
                    let message = format!(
                        "the include '{}' leads out of the folder of graphs",
                        name.value
                    );
                    self.found.partial = true;
                    self.error(Some(name.at), message);
                }
            }
        }
        self.stack.pop();
        self.files.push(parsed);
    }

    fn error(&mut self, from: Option<At>, message: String) {
        match from {
            Some(at) => self.found.error(at, message),
            None => self
                .found
                .errors
                .push(Diagnostic::error(Place::default(), message)),
        }
    }
}

fn ron_files(folder: &Path) -> Vec<String> {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return Vec::new();
    };
    entries
        .flatten()
        .map(|e| e.file_name().to_string_lossy().into_owned())
        .filter(|n| n.ends_with(".ron") && n != RETIRED)
        .collect()
}
