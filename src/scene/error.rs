//! Errors of scenes, each with a remedy.

use crate::files::{FileError, read_input};
use std::path::{Path, PathBuf};

/// An error that ends the opening or writing of a scene.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "the messages name the fields")]
pub enum SceneError {
    /// The name is neither a built-in scene nor a file.
    #[error("no scene '{spec}': {hint}")]
    NotFound { spec: String, hint: String },
    /// A file could not be read.
    #[error("cannot read {}: {source}. {hint}", path.display())]
    Read {
        path: PathBuf,
        hint: String,
        source: std::io::Error,
    },
    /// The `progress` callback cancelled the opening.
    #[error("the opening of the scene was cancelled")]
    Cancelled,
    /// A model file is damaged or does not match its extension.
    #[error("cannot load the model {}: {message}", path.display())]
    Model { path: PathBuf, message: String },
    /// A scene file has an error at a known place.
    #[error("{}:{line}:{column}: {message}", path.display())]
    SceneFile {
        path: PathBuf,
        line: usize,
        column: usize,
        message: String,
    },
    /// A scene file names a model that does not exist on this machine.
    #[error("{}:{line}:{column}: {message}", path.display())]
    NoModel {
        path: PathBuf,
        line: usize,
        column: usize,
        message: String,
    },
    /// An environment map cannot be read; the message names its file.
    #[error("{message}")]
    Environment { message: String },
    /// A file could not be written.
    #[error("{0}. Check that the folder exists, is writable and has space")]
    Write(#[from] FileError),
    /// No exporter supports the extension.
    #[error("cannot export to {}: the extension must be .obj, .gltf or .glb", path.display())]
    ExportFormat { path: PathBuf },
}

impl SceneError {
    /// A model that cannot be loaded.
    pub(super) fn model(path: &Path) -> impl Fn(String) -> SceneError {
        move |message| SceneError::Model {
            path: path.into(),
            message,
        }
    }
}

/// The bytes of a model file of at most `most` bytes.
pub(super) fn read_model(path: &Path, most: u64) -> Result<Vec<u8>, SceneError> {
    read_input(path, most).map_err(|source| SceneError::Read {
        path: path.into(),
        hint: "Check the path and its permissions".into(),
        source,
    })
}
