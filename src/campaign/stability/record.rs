//! What a suite leaves: `results/ID.json`, one finished method in one case each, and `stability.json`, all of them. Folders
//! may come from anywhere and are not trusted.

use super::cost::Cost;
use super::score::{Change, Flicker, Step};
use crate::files::write_lasting;
use crate::lab::LabError;
use crate::measure::oracle::Score;
use crate::metrics::Scores;
use crate::results::stats::DeviceStats;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Version of a result's file.
pub const RESULT_SCHEMA: &str = "conelab-stability-result-1";
/// Version of `stability.json`.
pub const SCHEMA: &str = "conelab-stability-1";
/// Largest file of a result, bytes: 10,000 frames of five parts.
const MAX_FILE: u64 = 64 << 20;

/// A part of the light at a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrameScore {
    /// From 0, the first measured one.
    pub frame: usize,
    /// Against the frame before; none at the first, and where the reference's change is not known.
    pub change: Option<Change>,
    /// E_t between the two halves of the reference.
    pub noise: Option<f64>,
    /// Mean luminance.
    pub mean: Option<f64>,
    /// Mean luminance of the reference.
    pub reference_mean: Option<f64>,
    /// relMSE against the reference.
    pub relmse: Option<f64>,
}

/// A part of the light over all frames.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PartResult {
    /// Root of the mean square of the frames' E_t.
    pub e: Option<f64>,
    /// E_t between the halves of the references.
    pub e_noise: Option<f64>,
    /// Whether `e` is at least four times `e_noise`.
    pub told_apart: Option<bool>,
    /// The largest 99.9th percentile of a frame.
    pub pops: Option<f64>,
    /// The largest displayed jump of a frame, 1/255.
    pub jump: Option<f64>,
    /// Flicker index.
    pub flicker: Option<Flicker>,
    /// Its mean between the halves of the references.
    pub flicker_noise: Option<f64>,
    /// What follows a switched light.
    pub step: Option<Step>,
    /// Frames from a switch or a cut until relMSE stays within 5 % of its last value.
    #[serde(default)]
    pub settling: Option<usize>,
    /// The last frame against its reference.
    pub scores: Option<Scores>,
    /// relMSE between the halves of that reference.
    pub noise: Option<f64>,
    /// Structure error that the noise of that reference alone gives, natural log units.
    #[serde(default)]
    pub structure_noise: Option<f64>,
    /// Frame by frame.
    pub frames: Vec<FrameScore>,
}

/// The frame that is farthest from its reference.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Worst {
    /// The part of the light.
    pub part: String,
    /// Number of the frame.
    pub frame: usize,
    /// What the panels of its picture show, from the left.
    pub panels: Vec<String>,
    /// What full red and blue of the difference stand for, 1/255.
    pub full: f64,
}

/// The scores of a method in a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Median of the frames' time on the device, ms.
    pub frame_ms: f64,
    /// Bytes of all resources of the graph, with the parts of the light that a picture alone does not need.
    #[serde(default)]
    pub memory_bytes: u64,
    /// Samples a pixel of the references; 0 without.
    pub samples: u64,
    /// The first frame after a switch or a cut.
    #[serde(default)]
    pub event: Option<usize>,
    /// By part.
    pub parts: BTreeMap<String, PartResult>,
    /// Voxels of the last frame against exact ones.
    pub voxels: Option<Score>,
    /// The farthest frame of the suite's part for pictures; its picture is `pictures/ID.png`.
    pub worst: Option<Worst>,
    /// What the graph's checks said, and what could not be had.
    pub warnings: Vec<String>,
}

/// The result of a method in a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Measured.
    Done(Box<Measured>),
    /// Why not.
    Failed(String),
}

/// A method in a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// [`RESULT_SCHEMA`].
    pub schema: String,
    /// See [`super::Job::id`].
    pub id: String,
    /// Name of the case.
    pub case: String,
    /// Name of its variant, empty if it has none.
    pub variant: String,
    /// About the case, for people.
    pub about: String,
    /// What moves.
    pub motion: String,
    /// Name of the method.
    pub method: String,
    /// Scene.
    pub scene: String,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Frames before the measured ones.
    pub warmup: usize,
    /// Frames measured.
    pub frames: usize,
    /// Device.
    pub device: DeviceStats,
    /// Result of the method in the case.
    pub outcome: Outcome,
}

/// `stability.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// [`SCHEMA`].
    pub schema: String,
    /// Program version.
    pub version: String,
    /// Name of the suite.
    pub suite: String,
    /// Text of the suite's file.
    pub text: String,
    /// Samples a pixel and bounces of the references; none without.
    pub reference: Option<(u64, u32)>,
    /// What charted methods cost; empty without a chart.
    #[serde(default)]
    pub costs: Vec<Cost>,
    /// Every method in every case, in order.
    pub results: Vec<Record>,
}

impl Record {
    /// The scores, if there are any.
    pub fn measured(&self) -> Option<&Measured> {
        match &self.outcome {
            Outcome::Done(measured) => Some(measured),
            Outcome::Failed(_) => None,
        }
    }

    /// The case with its variant.
    pub fn title(&self) -> String {
        if self.variant.is_empty() { self.case.clone() } else { format!("{}: {}", self.case, self.variant) }
    }
}

/// A folder of results.
pub(super) struct Folder(pub PathBuf);

impl Folder {
    fn result(&self, id: &str) -> PathBuf {
        self.0.join("results").join(format!("{id}.json"))
    }

    pub fn picture(&self, id: &str) -> PathBuf {
        self.0.join("pictures").join(format!("{id}.png"))
    }

    /// A result that is there, whole, and measured; anything else is measured again.
    pub fn read(&self, id: &str) -> Option<Record> {
        let path = self.result(id);
        let bytes = crate::files::read_input(&path, MAX_FILE).ok()?;
        let record: Record = serde_json::from_slice(&bytes).ok()?;
        let fits = record.schema == RESULT_SCHEMA && record.id == id;
        let whole = record.measured().is_some_and(|m| m.worst.is_none() || self.picture(id).is_file());
        (fits && whole).then_some(record)
    }

    /// Keeps a result, its picture first, so that a result that is there is whole.
    pub fn write(&self, record: &Record, picture: Option<&[u8]>) -> Result<(), LabError> {
        if let Some(bytes) = picture {
            lasting(&self.picture(&record.id), bytes)?;
        }
        lasting(&self.result(&record.id), &json(record)?)
    }
}

pub(super) fn json(value: &impl Serialize) -> Result<Vec<u8>, LabError> {
    let mut bytes = serde_json::to_vec_pretty(value).map_err(|e| LabError::Request(e.to_string()))?;
    bytes.push(b'\n');
    Ok(bytes)
}

pub(super) fn lasting(path: &Path, bytes: &[u8]) -> Result<(), LabError> {
    write_lasting(path, bytes).map_err(|e| LabError::Request(format!("cannot write '{}': {e}", path.display())))
}
