//! What a suite leaves: `results/ID.json`, one finished method in one case each, and `stability.json`, all of them.

use super::score::{Change, Flicker, Step, median};
use crate::campaign::record::{Folder, Record};
use crate::measure::oracle::Score;
use crate::metrics::{Noise, Scores};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// Version of a result's file.
const RESULT_SCHEMA: &str = "conelab-stability-result-1";
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

impl PartResult {
    /// The noise of the last frame's reference; no number where it is not known.
    pub fn reference_noise(&self) -> Noise {
        let known = |v: Option<f64>| v.unwrap_or(f64::NAN);
        Noise {
            relmse: known(self.noise),
            structure: known(self.structure_noise),
        }
    }
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

/// A method in a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct About {
    /// Name of the case.
    pub case: String,
    /// Name of its variant, empty if it has none.
    pub variant: String,
    /// About the case, for people.
    #[serde(rename = "about")]
    pub text: String,
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
}

/// The result of a method in a case.
pub type CaseRecord = Record<About, Measured>;

/// A method at one value of the parameter.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// The value, RON; empty where nothing is varied.
    pub value: String,
    /// Identifier of its work ([`super::Job::work`]).
    pub work: String,
    /// Sum of a frame's passes, ms: the median of each round.
    pub ms: Vec<f64>,
    /// The first method's in the same rounds.
    pub first_ms: Vec<f64>,
    /// Bytes of all resources of the graph.
    pub memory_bytes: u64,
    /// Why it could not be timed.
    pub failed: Option<String>,
}

/// What a method costs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    /// The method.
    pub method: String,
    /// What is varied; empty where nothing is.
    pub parameter: String,
    /// Identifier of the work ([`super::Job::work`]) of the first method.
    pub first: String,
    /// At every value, or the method as it is.
    pub candidates: Vec<Candidate>,
    /// The one that is nearest to the first method's time.
    pub chosen: Option<usize>,
}

/// `stability.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// `SCHEMA`.
    pub schema: String,
    /// Program version.
    pub version: String,
    /// Name of the suite.
    pub suite: String,
    /// Text of the suite's file.
    pub text: String,
    /// Samples a pixel and bounces of the references; none without.
    pub reference: Option<(u64, u32)>,
    /// Parts of the light that have tables on the page; the others are in the files.
    #[serde(default)]
    pub tables: Vec<String>,
    /// The part that has charts besides the total: its name, and that within a sentence.
    #[serde(default)]
    pub focus: Option<(String, String)>,
    /// What charted methods cost; empty without a chart.
    #[serde(default)]
    pub costs: Vec<Cost>,
    /// Every method in every case, in order.
    pub results: Vec<CaseRecord>,
}

impl Report {
    /// The results case by case, by their titles.
    pub fn cases(&self) -> Vec<(String, Vec<&CaseRecord>)> {
        let mut cases: Vec<(String, Vec<&CaseRecord>)> = Vec::new();
        for record in &self.results {
            let title = record.about.title();
            match cases.iter_mut().find(|c| c.0 == title) {
                Some((_, of)) => of.push(record),
                None => cases.push((title, vec![record])),
            }
        }
        cases
    }
}

impl Candidate {
    /// Median of the rounds, ms.
    pub fn time(&self) -> Option<f64> {
        (!self.ms.is_empty()).then(|| median(self.ms.clone()))
    }

    /// Its time over that of the first method: median of the rounds' ratios.
    pub fn ratio(&self) -> Option<f64> {
        let ratios: Vec<f64> = self
            .ms
            .iter()
            .zip(&self.first_ms)
            .map(|(own, first)| own / first)
            .collect();
        (!ratios.is_empty())
            .then(|| median(ratios))
            .filter(|r| r.is_finite() && *r > 0.0)
    }
}

impl Cost {
    /// The one that was taken.
    pub fn taken(&self) -> Option<&Candidate> {
        self.candidates.get(self.chosen?)
    }
}

impl About {
    /// The case with its variant.
    pub fn title(&self) -> String {
        title(&self.case, &self.variant)
    }
}

impl CaseRecord {
    /// What was measured of a part of the light.
    pub fn part(&self, name: &str) -> Option<&PartResult> {
        self.done()?.parts.get(name)
    }
}

/// A case with its variant, for people.
pub(super) fn title(case: &str, variant: &str) -> String {
    if variant.is_empty() {
        case.into()
    } else {
        format!("{case}: {variant}")
    }
}

/// The records of a suite's folder.
pub(super) fn folder(path: &Path) -> Folder {
    Folder {
        path: path.into(),
        kind: "results",
        schema: RESULT_SCHEMA,
        most: MAX_FILE,
    }
}

/// Path of a result's picture in the folder.
pub(super) fn picture(id: &str) -> String {
    format!("pictures/{id}.png")
}
