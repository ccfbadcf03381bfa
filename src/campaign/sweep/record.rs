//! Files of a sweep: `sweep.json` with the list of all points, the same in every shard,
//! `points/ID.json` for each finished point, `pictures/ID.jpg` and `errors/ID.jpg`.

use crate::campaign::points::{DIGITS, Subject, SweepPoint};
use crate::campaign::record::{Folder, Record, json, read_json, write_file};
use crate::files::{FileError, content_id, read_input};
use crate::lab::LabError;
use crate::measure::{Frames, Point};
use indexmap::{IndexMap, IndexSet};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Version of `sweep.json`.
pub const MANIFEST_SCHEMA: &str = "conelab-sweep-1";
/// Version of a point's file.
const POINT_SCHEMA: &str = "conelab-point-1";
/// Largest `sweep.json`, bytes.
const MAX_MANIFEST: u64 = 256 << 20;
/// Largest file of a point or picture, bytes.
const MAX_FILE: u64 = 4 << 20;

/// `sweep.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// `MANIFEST_SCHEMA`.
    pub schema: String,
    pub name: String,
    /// Text of the sweep's file.
    pub text: String,
    /// Names of the varied settings.
    pub names: Vec<String>,
    /// Frames of every point.
    pub frames: Frames,
    /// Every point, in order.
    pub points: Vec<ManifestPoint>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ManifestPoint {
    /// Identifier, see [`SweepPoint::id`].
    pub id: String,
    /// Values by the names of the varied settings.
    pub labels: IndexMap<String, String>,
    /// Whether all parameters are the graph's defaults.
    #[serde(default)]
    pub preset: bool,
}

/// Description of a finished point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct About {
    /// The experiment with all fields and without defaults, as text; empty if the scene is not on
    /// the machine.
    pub experiment: String,
    /// Image content. Points with the same subject are comparable.
    pub subject: Subject,
}

pub type PointRecord = Record<About, Point>;

/// Records of a sweep's folder.
pub fn points_in(path: &Path) -> Folder {
    Folder {
        path: path.into(),
        kind: "points",
        schema: POINT_SCHEMA,
        most: MAX_FILE,
    }
}

/// Path of a picture in the folder, of kind `pictures` or `errors`.
pub(super) fn jpeg(kind: &str, name: &str) -> String {
    format!("{kind}/{name}.jpg")
}

/// Path of the displayed reference of a subject.
pub(super) fn reference(subject: &Subject) -> String {
    jpeg("references", &content_id([format!("{subject:?}")], DIGITS))
}

impl ManifestPoint {
    /// The entry of a point.
    pub fn of(point: &SweepPoint) -> ManifestPoint {
        ManifestPoint {
            id: point.id.clone(),
            labels: point.labels.iter().cloned().collect(),
            preset: point.experiment.params.is_empty(),
        }
    }
}

impl Manifest {
    /// A list of points.
    pub fn new(
        name: String,
        text: String,
        names: Vec<String>,
        frames: Frames,
        points: Vec<ManifestPoint>,
    ) -> Manifest {
        Manifest {
            schema: MANIFEST_SCHEMA.into(),
            name,
            text,
            names,
            frames,
            points,
        }
    }

    fn file(folder: &Path) -> PathBuf {
        folder.join("sweep.json")
    }

    /// Writes the list to its folder.
    pub fn write(&self, folder: &Path) -> Result<(), LabError> {
        write_file(&Manifest::file(folder), &json(self)?)
    }

    fn read(folder: &Path) -> Result<Manifest, LabError> {
        let file = Manifest::file(folder);
        let wrong = |why: String| LabError::from(FileError::content(&file, why));
        let manifest: Manifest = read_json(&file, MAX_MANIFEST)
            .map_err(|e| wrong(format!("{e}; give the folder that `conelab sweep` wrote")))?;
        if manifest.schema != MANIFEST_SCHEMA {
            return Err(wrong(format!(
                "its schema is '{}', this program reads '{MANIFEST_SCHEMA}'",
                manifest.schema
            )));
        }
        let fits = |p: &&ManifestPoint| {
            p.id.len() == DIGITS && p.id.bytes().all(|b| b.is_ascii_hexdigit())
        };
        match manifest.points.iter().find(|p| !fits(p)) {
            Some(bad) => Err(wrong(format!("'{}' is no number of a point", bad.id))),
            None => Ok(manifest),
        }
    }
}

/// Points of several folders: shards of one sweep, or different sweeps.
#[derive(Clone, Debug, Default)]
pub struct Collected {
    /// Names of the sweeps.
    pub sweeps: Vec<String>,
    /// Names of all varied settings.
    pub names: Vec<String>,
    /// All points in order without duplicates, with the record of finished ones.
    pub points: Vec<(ManifestPoint, Option<PointRecord>)>,
    /// Folder of each finished point, by identifier.
    folders: HashMap<String, PathBuf>,
}

impl Collected {
    /// The picture of a point, or its error map (`errors`), JPEG.
    pub fn picture(&self, kind: &str, id: &str) -> Option<Vec<u8>> {
        read_input(&self.folders.get(id)?.join(jpeg(kind, id)), MAX_FILE).ok()
    }

    /// The displayed reference of a point, JPEG.
    pub fn reference(&self, record: &PointRecord) -> Option<Vec<u8>> {
        read_input(
            &self
                .folders
                .get(&record.id)?
                .join(reference(&record.about.subject)),
            MAX_FILE,
        )
        .ok()
    }
}

/// Reads folders of sweeps. A point in several folders is taken from the first that has it without
/// an error.
pub fn collect(folders: &[PathBuf]) -> Result<Collected, LabError> {
    let mut out = Collected::default();
    let (mut sweeps, mut names) = (IndexSet::new(), IndexSet::new());
    let mut at: HashMap<String, usize> = HashMap::new();
    for path in folders {
        let manifest = Manifest::read(path)?;
        sweeps.insert(manifest.name);
        names.extend(manifest.names);
        let folder = points_in(path);
        for point in manifest.points {
            let id = point.id.clone();
            let i = *at.entry(id.clone()).or_insert_with(|| {
                out.points.push((point, None));
                out.points.len() - 1
            });
            let have = &out.points[i].1;
            if have.as_ref().is_some_and(|r| r.done().is_some()) {
                continue;
            }
            if let Some(record) = folder
                .read(&id)
                .filter(|r: &PointRecord| have.is_none() || r.done().is_some())
            {
                out.folders.insert(id, path.clone());
                out.points[i].1 = Some(record);
            }
        }
    }
    (out.sweeps, out.names) = (sweeps.into_iter().collect(), names.into_iter().collect());
    Ok(out)
}
