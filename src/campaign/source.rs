//! Reading the files of campaigns: sweeps and suites.

use crate::diagnostics::{At, Diagnostic, Loc, Severity, Sources};
use crate::experiment::Experiment;
use serde::de::DeserializeOwned;
use std::fmt::Display;
use std::path::{Path, PathBuf};

/// A file and its mistakes.
pub struct Source {
    path: PathBuf,
    sources: Sources,
    pub errors: Vec<Diagnostic>,
}

impl Source {
    /// Reads a file. `help` suggests a path if there is none.
    pub fn read<T: DeserializeOwned>(
        path: &Path,
        help: &str,
    ) -> Result<(T, Source), Vec<Diagnostic>> {
        let mut sources = Sources::default();
        let file = sources
            .read(path)
            .map_err(|e| vec![e.help(Some(help.into()))])?;
        let mut errors = Vec::new();
        let parsed = sources.parse::<T>(file, &mut errors, &mut Vec::new());
        match parsed.filter(|_| !errors.iter().any(|e| e.severity == Severity::Error)) {
            Some(parsed) => Ok((
                parsed,
                Source {
                    path: path.into(),
                    sources,
                    errors,
                },
            )),
            None => Err(errors),
        }
    }

    pub fn name(&self) -> String {
        self.path
            .file_stem()
            .map_or(String::new(), |s| s.to_string_lossy().into_owned())
    }

    pub fn text(&self) -> String {
        self.sources
            .texts()
            .next()
            .map_or(String::new(), |t| t.1.to_string())
    }

    /// Folder of the file, for relative paths.
    pub fn folder(&self) -> PathBuf {
        self.path.parent().unwrap_or(Path::new(".")).to_path_buf()
    }

    pub fn wrong(&mut self, at: At, message: impl Into<String>) {
        self.errors.push(self.sources.error(at, message));
    }

    /// A number within limits.
    pub fn number<T: Copy + PartialOrd + Display>(
        &mut self,
        name: &str,
        value: &Option<Loc<T>>,
        default: T,
        (least, most): (T, T),
    ) -> T {
        match value {
            Some(v) if v.value < least || v.value > most => {
                self.wrong(v.at, format!("{name} must be {least} to {most}"));
                default
            }
            Some(v) => v.value,
            None => default,
        }
    }

    /// Reads an experiment that the file names. The file becomes the last of its sources, so that
    /// settings keep their places.
    pub fn experiment(&mut self, name: &Loc<String>) -> Option<Experiment> {
        match Experiment::read(&self.folder().join(&name.value)) {
            Ok(mut experiment) => {
                experiment.sources.add(&self.path, self.text());
                return Some(experiment);
            }
            // A missing file is a mistake of the file that names it.
            Err(found) if found.iter().all(|d| d.place.line == 0) => {
                for d in found {
                    let message = format!("{}: {}", d.place.file.display(), d.message);
                    self.errors
                        .push(self.sources.error(name.at, message).help(d.help));
                }
            }
            Err(found) => self.errors.extend(found),
        }
        None
    }
}
