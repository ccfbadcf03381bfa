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
            return self.error(from, self.circle(path));
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
            Err(e) => return self.unreadable(path, from, e),
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
            let mut components = Path::new(&name.value).components();
            if components.all(|c| matches!(c, Component::Normal(_))) {
                self.file(&self.folders.passes.join(&name.value), Some(name.at));
                continue;
            }
            let file = &name.value;
            let message = format!("the include '{file}' leads out of the folder of graphs");
            self.found.partial = true;
            self.error(Some(name.at), message);
        }
        self.stack.pop();
        self.files.push(parsed);
    }

    fn circle(&self, path: &Path) -> String {
        let mut circle: Vec<String> = self.stack.iter().map(|p| file_name(p)).collect();
        let start = self.stack.iter().position(|p| p == path);
        circle.drain(..start.unwrap_or(0));
        let circle = circle.join(" > ");
        format!(
            "'{}' includes itself: {circle} > {}",
            path.display(),
            file_name(path)
        )
    }

    /// Reports a file that cannot be read, with what to include instead.
    fn unreadable(&mut self, path: &Path, from: Option<At>, error: Diagnostic) {
        let name = file_name(path);
        let is_missing = !path.exists();
        let known = match is_missing {
            true => ron_files(&self.folders.passes),
            false => Vec::new(),
        };
        let message = error.message.clone();
        let found = from.map_or(error, |at| self.found.sources.error(at, message));
        let mut retired = self.retired.iter();
        let instead = retired.find(|(graph, _)| *graph == name && is_missing);
        self.found.errors.push(match instead {
            Some((_, instead)) => found.help(Some(instead.clone())),
            None => found.nearest(&name, known.iter().map(String::as_str)),
        });
        self.found.partial = true;
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

fn file_name(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
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
