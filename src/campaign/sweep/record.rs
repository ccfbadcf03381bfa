//! What a sweep's folder holds: `sweep.json`, the list of all points, the same in every shard; `points/ID.json`, one
//! finished point each; `pictures/ID.jpg` and `errors/ID.jpg`. Folders may come from anywhere and are not trusted.

use super::list::SweepPoint;
use crate::files::{read_input, write_whole};
use crate::lab::LabError;
use crate::measure::{Frames, Measured, Point};
use crate::results::stats::DeviceStats;
use indexmap::IndexMap;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Version of `sweep.json`.
pub const MANIFEST_SCHEMA: &str = "conelab-sweep-1";
/// Version of a point's file.
pub const POINT_SCHEMA: &str = "conelab-point-1";
/// Largest `sweep.json`, bytes.
const MAX_MANIFEST: u64 = 256 << 20;
/// Largest file of a point or picture, bytes.
const MAX_FILE: u64 = 4 << 20;

/// `sweep.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// [`MANIFEST_SCHEMA`].
    pub schema: String,
    /// Name of the sweep.
    pub name: String,
    /// The sweep's file, for people.
    pub text: String,
    /// Names of what is varied.
    pub names: Vec<String>,
    /// Frames of every point.
    pub frames: Frames,
    /// Every point, in order.
    pub points: Vec<ManifestPoint>,
}

/// A point of the list.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ManifestPoint {
    /// Its number, see [`SweepPoint::id`].
    pub id: String,
    /// Its values, by the names of what is varied.
    pub labels: IndexMap<String, String>,
}

/// A finished point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// [`POINT_SCHEMA`].
    pub schema: String,
    /// Number of the point.
    pub id: String,
    /// The experiment with nothing left to defaults, as it would stand in a file of the sweep's folder; empty where the
    /// scene is not on the machine.
    pub experiment: String,
    /// What is looked at: points of one subject can be compared.
    pub subject: Subject,
    /// The device.
    pub device: DeviceStats,
    /// Result of the point.
    pub outcome: Outcome,
}

/// A picture, whatever method makes it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Subject {
    /// The scene's name.
    pub scene: String,
    /// SHA-256 of its content, light included.
    pub sha256: String,
    /// The camera, written out.
    pub camera: String,
    /// Width and height, pixels.
    pub size: (u32, u32),
    /// Seconds, written out.
    pub time: String,
}

impl Subject {
    /// 32 hexadecimal digits that name it.
    fn key(&self) -> String {
        crate::results::capture::id_of([format!("{self:?}")])
    }
}

/// The result of a point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Measured.
    Done(Box<Point>),
    /// The error.
    Failed(String),
}

/// A sweep's folder.
pub(super) struct Folder(pub PathBuf);

impl Folder {
    fn point(&self, id: &str) -> PathBuf {
        self.0.join("points").join(format!("{id}.json"))
    }

    /// The record of a point, if it is finished. A damaged one is not: it is measured again.
    pub fn read(&self, id: &str) -> Option<Record> {
        read_json::<Record>(&self.point(id), MAX_FILE).ok().filter(|r| r.schema == POINT_SCHEMA && r.id == id)
    }

    /// Keeps a point: its pictures first, so that a point that is there is whole.
    pub fn write(&self, record: &Record, pictures: Option<&Measured>) -> Result<(), LabError> {
        let picture = pictures.and_then(|m| m.picture.as_deref()).map(|bytes| ("pictures", bytes));
        let error_map = pictures.and_then(|m| m.error_map.as_deref()).map(|bytes| ("errors", bytes));
        for (kind, bytes) in picture.into_iter().chain(error_map) {
            write_file(&jpeg(&self.0, kind, &record.id), bytes)?;
        }
        if let Some(bytes) = pictures.and_then(|m| m.reference.as_deref()) {
            write_file(&jpeg(&self.0, "references", &record.subject.key()), bytes)?;
        }
        write_file(&self.point(&record.id), &json(record)?)
    }

    /// Removes what runs that were killed left half written. Other shards may be writing here: only what is an hour old.
    pub fn clean(&self) {
        let old = |e: &std::fs::DirEntry| {
            let age = e.metadata().and_then(|m| m.modified()).ok().and_then(|t| t.elapsed().ok());
            e.file_name().to_string_lossy().starts_with(".conelab-") && age.is_some_and(|a| a.as_secs() > 3600)
        };
        for kind in ["points", "pictures", "errors", "references"] {
            let entries = std::fs::read_dir(self.0.join(kind)).into_iter().flatten().flatten();
            for entry in entries.filter(old) {
                // What cannot be deleted only takes room.
                let _ = std::fs::remove_file(entry.path());
            }
        }
    }

    pub fn write_manifest(&self, manifest: &Manifest) -> Result<(), LabError> {
        write_file(&self.0.join("sweep.json"), &json(manifest)?)
    }
}

impl Manifest {
    pub(super) fn new(sweep: &super::Sweep, frames: Frames, points: &[SweepPoint]) -> Manifest {
        let point = |p: &SweepPoint| ManifestPoint { id: p.id.clone(), labels: p.labels.iter().cloned().collect() };
        Manifest {
            schema: MANIFEST_SCHEMA.into(),
            name: sweep.name.clone(),
            text: sweep.text.clone(),
            names: sweep.names.clone(),
            frames,
            points: points.iter().map(point).collect(),
        }
    }
}

/// What some folders hold together: shards of one sweep, or sweeps that are looked at side by side.
#[derive(Clone, Debug, Default)]
pub struct Collected {
    /// Names of the sweeps.
    pub sweeps: Vec<String>,
    /// Names of everything that is varied.
    pub names: Vec<String>,
    /// Every point of every list, in order, once; with its record where it is finished.
    pub points: Vec<(ManifestPoint, Option<Record>)>,
    /// Folder of each finished point, by its number.
    folders: HashMap<String, PathBuf>,
}

impl Collected {
    /// The picture of a point, or where its light differs from the reference (`errors`): JPEG.
    pub fn picture(&self, kind: &str, id: &str) -> Option<Vec<u8>> {
        small_file(&jpeg(self.folders.get(id)?, kind, id))
    }

    /// The reference that a point was scored against, displayed: JPEG.
    pub fn reference(&self, record: &Record) -> Option<Vec<u8>> {
        small_file(&jpeg(self.folders.get(&record.id)?, "references", &record.subject.key()))
    }
}

fn jpeg(folder: &Path, kind: &str, name: &str) -> PathBuf {
    folder.join(kind).join(format!("{name}.jpg"))
}

fn small_file(path: &Path) -> Option<Vec<u8>> {
    read_input(path, MAX_FILE).ok()
}

/// Reads folders of sweeps. A point that several hold is taken from the first in which it was measured without an error.
///
/// # Errors
/// A folder without a list of points, or with a damaged one.
pub fn collect(folders: &[PathBuf]) -> Result<Collected, LabError> {
    let mut out = Collected::default();
    let mut at: HashMap<String, usize> = HashMap::new();
    for path in folders {
        let file = path.join("sweep.json");
        let wrong = |why: String| LabError::Request(format!("'{}': {why}", file.display()));
        let manifest: Manifest = read_json(&file, MAX_MANIFEST)
            .map_err(|e| wrong(format!("{e}; give the folder that `conelab sweep` wrote")))?;
        if manifest.schema != MANIFEST_SCHEMA {
            return Err(wrong(format!("its schema is '{}', this program reads '{MANIFEST_SCHEMA}'", manifest.schema)));
        }
        if let Some(bad) =
            manifest.points.iter().find(|p| p.id.len() != 32 || !p.id.bytes().all(|b| b.is_ascii_hexdigit()))
        {
            return Err(wrong(format!("'{}' is no number of a point", bad.id)));
        }
        if !out.sweeps.contains(&manifest.name) {
            out.sweeps.push(manifest.name);
        }
        for name in manifest.names {
            if !out.names.contains(&name) {
                out.names.push(name);
            }
        }
        let folder = Folder(path.clone());
        for point in manifest.points {
            let id = point.id.clone();
            let i = *at.entry(id.clone()).or_insert_with(|| {
                out.points.push((point, None));
                out.points.len() - 1
            });
            let have = &out.points[i].1;
            let measured = |r: &Record| matches!(r.outcome, Outcome::Done(_));
            if have.as_ref().is_some_and(measured) {
                continue;
            }
            if let Some(record) = folder.read(&id).filter(|r| have.is_none() || measured(r)) {
                out.folders.insert(id, path.clone());
                out.points[i].1 = Some(record);
            }
        }
    }
    Ok(out)
}

/// Reads a JSON file of at most so many bytes; the error is what is wrong with it.
pub(crate) fn read_json<T: DeserializeOwned>(path: &Path, most: u64) -> Result<T, String> {
    let bytes = read_input(path, most).map_err(|e| format!("cannot read it: {e}"))?;
    serde_json::from_slice(&bytes).map_err(|e| format!("it is damaged: {e}"))
}

fn json(value: &impl Serialize) -> Result<Vec<u8>, LabError> {
    let mut bytes = serde_json::to_vec_pretty(value).map_err(|e| LabError::Request(e.to_string()))?;
    bytes.push(b'\n');
    Ok(bytes)
}

pub(crate) fn write_file(path: &Path, bytes: &[u8]) -> Result<(), LabError> {
    write_whole(path, bytes).map_err(|e| LabError::Request(format!("cannot write '{}': {e}", path.display())))
}
