//! Records of points, in a folder that runs, shards and machines share. A record is named by the
//! hash of everything that its result depends on. Folders may come from anywhere and are not
//! trusted.

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
    Done(Box<T>),
    /// Text of the error.
    Failed(String),
}

/// A finished point: `A` describes it, `T` has its measurements.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record<A, T> {
    /// Version of the file.
    pub schema: String,
    /// Identifier of the point: 32 hexadecimal digits.
    pub id: String,
    /// Description of the point.
    #[serde(flatten)]
    pub about: A,
    pub device: DeviceStats,
    pub outcome: Outcome<T>,
}

impl<A, T> Record<A, T> {
    /// The measurements, `None` if the point failed.
    pub fn done(&self) -> Option<&T> {
        match &self.outcome {
            Outcome::Done(measured) => Some(measured),
            Outcome::Failed(_) => None,
        }
    }

    /// First line of the error.
    pub fn error(&self) -> Option<&str> {
        match &self.outcome {
            Outcome::Done(_) => None,
            Outcome::Failed(error) => Some(first_line(error)),
        }
    }
}

/// A folder of records, `KIND/ID.json`, and other files.
#[derive(Clone, Debug)]
pub struct Folder {
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

    /// The record of a finished point. Damaged records and other versions are ignored, so that the
    /// point is measured again.
    pub fn read<A: DeserializeOwned, T: DeserializeOwned>(&self, id: &str) -> Option<Record<A, T>> {
        let record = read_json::<Record<A, T>>(&self.record(id), self.most).ok()?;
        (record.schema == self.schema && record.id == id).then_some(record)
    }

    /// Writes a record. Its files are written first, so that a point with a record is complete.
    pub fn write<A: Serialize, T: Serialize>(
        &self,
        record: &Record<A, T>,
        files: &[File],
    ) -> Result<(), LabError> {
        write_files(&self.path, files)?;
        write_file(&self.record(&record.id), &json(record)?)
    }

    /// Removes partial files of killed runs. Other shards may be writing, so files younger than an
    /// hour stay.
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
                // Files that cannot be deleted do no harm.
                let _ = std::fs::remove_file(entry.path());
            }
        }
    }
}

/// Path in a folder, and content.
pub type File = (String, Vec<u8>);

pub fn write_files(folder: &Path, files: &[File]) -> Result<(), LabError> {
    files
        .iter()
        .try_for_each(|(name, bytes)| write_file(&folder.join(name), bytes))
}

/// Writes a file completely and durably.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), LabError> {
    Ok(write_lasting(path, bytes)?)
}

/// The value as JSON for a file.
pub fn json(value: &impl Serialize) -> Result<Vec<u8>, LabError> {
    let mut bytes = serde_json::to_vec_pretty(value).map_err(LabError::making("JSON"))?;
    bytes.push(b'\n');
    Ok(bytes)
}

/// Reads a JSON file of at most `most` bytes.
pub fn read_json<T: DeserializeOwned>(path: &Path, most: u64) -> Result<T, String> {
    let bytes = read_input(path, most).map_err(|e| format!("cannot read it: {e}"))?;
    serde_json::from_slice(&bytes).map_err(|e| format!("it is damaged: {e}"))
}

/// First line of an error, for tables.
pub fn first_line(text: &str) -> &str {
    text.lines().next().unwrap_or_default()
}
