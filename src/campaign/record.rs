//! What a campaign keeps of each point: a record named by all that its result depends on, in a folder that runs, shards
//! and other machines share. Folders may come from anywhere and are not trusted.

use crate::files::{read_input, write_lasting};
use crate::lab::LabError;
use crate::results::stats::DeviceStats;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The result of a point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome<T> {
    /// Measured.
    Done(Box<T>),
    /// The error.
    Failed(String),
}

/// A finished point: `A` says what it is of, `T` is what was measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record<A, T> {
    /// Version of the file.
    pub schema: String,
    /// Number of the point: 32 hexadecimal digits of all that its result depends on.
    pub id: String,
    /// What it is of.
    #[serde(flatten)]
    pub about: A,
    /// The device.
    pub device: DeviceStats,
    /// Result of the point.
    pub outcome: Outcome<T>,
}

impl<A, T> Record<A, T> {
    /// What was measured.
    pub fn done(&self) -> Option<&T> {
        match &self.outcome {
            Outcome::Done(measured) => Some(measured),
            Outcome::Failed(_) => None,
        }
    }

    /// The first line of the error, if it failed.
    pub fn error(&self) -> Option<&str> {
        match &self.outcome {
            Outcome::Done(_) => None,
            Outcome::Failed(error) => Some(first_line(error)),
        }
    }
}

/// A folder of records, `KIND/ID.json`, with other files beside them.
#[derive(Clone, Debug)]
pub struct Folder {
    /// Its path.
    pub path: PathBuf,
    /// Name of the folder with the records.
    pub kind: &'static str,
    /// Version of the records.
    pub schema: &'static str,
    /// Largest file of a record, bytes.
    pub most: u64,
}

impl Folder {
    fn record(&self, id: &str) -> PathBuf {
        self.path.join(self.kind).join(format!("{id}.json"))
    }

    /// The record of a point, if it is finished. A damaged one, or one of another version, is not: it is measured again.
    pub fn read<A: DeserializeOwned, T: DeserializeOwned>(&self, id: &str) -> Option<Record<A, T>> {
        let record = read_json::<Record<A, T>>(&self.record(id), self.most).ok()?;
        (record.schema == self.schema && record.id == id).then_some(record)
    }

    /// Keeps a point: first its files, by their paths in the folder, so that a point that is there is whole.
    ///
    /// # Errors
    /// A folder that cannot be written to.
    pub fn write<A: Serialize, T: Serialize>(
        &self,
        record: &Record<A, T>,
        files: &[File],
    ) -> Result<(), LabError> {
        write_files(&self.path, files)?;
        write_file(&self.record(&record.id), &json(record)?)
    }

    /// Removes what runs that were killed left half written in some folders. Other shards may be writing there: only
    /// what is an hour old.
    pub fn clean(&self, folders: &[&str]) {
        let old = |e: &std::fs::DirEntry| {
            let age = e
                .metadata()
                .and_then(|m| m.modified())
                .ok()
                .and_then(|t| t.elapsed().ok());
            e.file_name().to_string_lossy().starts_with(".conelab-")
                && age.is_some_and(|a| a.as_secs() > 3600)
        };
        for folder in folders {
            let entries = std::fs::read_dir(self.path.join(folder))
                .into_iter()
                .flatten()
                .flatten();
            for entry in entries.filter(old) {
                // What cannot be deleted only takes room.
                let _ = std::fs::remove_file(entry.path());
            }
        }
    }
}

/// A file: its path in a folder, and its bytes.
pub type File = (String, Vec<u8>);

/// Writes files to a folder.
///
/// # Errors
/// A folder that cannot be written to.
pub fn write_files(folder: &Path, files: &[File]) -> Result<(), LabError> {
    files
        .iter()
        .try_for_each(|(name, bytes)| write_file(&folder.join(name), bytes))
}

/// Writes a file, whole and lasting.
///
/// # Errors
/// As [`write_lasting`].
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), LabError> {
    Ok(write_lasting(path, bytes)?)
}

/// A value as JSON, for a file.
///
/// # Errors
/// A value that JSON does not have.
pub fn json(value: &impl Serialize) -> Result<Vec<u8>, LabError> {
    let mut bytes = serde_json::to_vec_pretty(value).map_err(LabError::making("JSON"))?;
    bytes.push(b'\n');
    Ok(bytes)
}

/// Reads a JSON file of at most so many bytes.
///
/// # Errors
/// What is wrong with it.
pub fn read_json<T: DeserializeOwned>(path: &Path, most: u64) -> Result<T, String> {
    let bytes = read_input(path, most).map_err(|e| format!("cannot read it: {e}"))?;
    serde_json::from_slice(&bytes).map_err(|e| format!("it is damaged: {e}"))
}

/// What people are told of an error in a table.
pub fn first_line(text: &str) -> &str {
    text.lines().next().unwrap_or_default()
}
