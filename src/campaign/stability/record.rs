//! Files of a suite: `results/ID.json` for each finished method in a case, and `stability.json` for
//! all of them.

use super::score::{Change, Flicker, Step};
use crate::campaign::record::{Folder, Record};
use crate::measure::oracle::Score;
use crate::metrics::{Noise, Scores, median};
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
    /// Number, from 0 at the first measured frame.
    pub frame: usize,
    /// Against the frame before. `None` at the first frame, and if the reference's change is
    /// unknown.
    pub change: Option<Change>,
    /// E_t between the two halves of the reference.
    pub noise: Option<f64>,
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
    pub flicker: Option<Flicker>,
    /// Its mean between the halves of the references.
    pub flicker_noise: Option<f64>,
    /// Response to a switched light.
    pub step: Option<Step>,
    /// Frames from a switch or a cut until relMSE stays within 5 % of its last value.
    #[serde(default)]
    pub settling: Option<usize>,
    /// Scores of the last frame.
    pub scores: Option<Scores>,
    /// relMSE between the halves of the last reference.
    pub noise: Option<f64>,
    /// FLIP due to the noise of the last reference.
    #[serde(default)]
    pub flip_noise: Option<f64>,
    /// Structure error due to the noise of the last reference, natural log units.
    #[serde(default)]
    pub structure_noise: Option<f64>,
    pub frames: Vec<FrameScore>,
}

impl PartResult {
    /// Noise of the last reference, NaN if unknown.
    pub fn reference_noise(&self) -> Noise {
        let known = |v: Option<f64>| v.unwrap_or(f64::NAN);
        Noise {
            relmse: known(self.noise),
            flip: known(self.flip_noise),
            structure: known(self.structure_noise),
        }
    }
}

/// The frame farthest from its reference.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Worst {
    /// The part of the light.
    pub part: String,
    /// Number of the frame.
    pub frame: usize,
    /// Content of the picture's panels, from the left.
    pub panels: Vec<String>,
    /// Value of full red and blue in the difference, 1/255.
    pub full: f64,
}

/// The scores of a method in a case.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Median of the frames' time on the device, ms.
    pub frame_ms: f64,
    /// Bytes of all resources of the graph, including parts of the light that the picture does not
    /// need.
    #[serde(default)]
    pub memory_bytes: u64,
    /// Samples per pixel of the references, 0 without.
    pub samples: u64,
    /// The first frame after a switch or a cut.
    #[serde(default)]
    pub event: Option<usize>,
    pub parts: BTreeMap<String, PartResult>,
    /// Comparison of the last frame's voxels with exact ones.
    pub voxels: Option<Score>,
    /// The worst frame of the suite's part for pictures, with its picture in `pictures/ID.png`.
    pub worst: Option<Worst>,
    /// Failed checks of the graph, and missing data.
    pub warnings: Vec<String>,
}

/// A method in a case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct About {
    /// Name of the case.
    pub case: String,
    /// Name of its variant, empty if it has none.
    pub variant: String,
    /// Description of the case.
    #[serde(rename = "about")]
    pub text: String,
    pub motion: String,
    /// Name of the method.
    pub method: String,
    /// The experiment with all fields where the motion starts, as text.
    #[serde(default)]
    pub experiment: String,
    pub scene: String,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Frames before the measured ones.
    pub warmup: usize,
    pub frames: usize,
}

/// The result of a method in a case.
pub type CaseRecord = Record<About, Measured>;

/// A method at one value of the varied parameter.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// Value in RON, empty if no parameter is varied.
    pub value: String,
    /// Identifier of its work ([`super::plan::Job::work`]).
    pub work: String,
    /// Sum of a frame's passes, ms: the median of each round.
    pub ms: Vec<f64>,
    /// Times of the first method in the same rounds, ms.
    pub first_ms: Vec<f64>,
    /// Bytes of all resources of the graph.
    pub memory_bytes: u64,
    /// Error that prevented timing.
    pub failed: Option<String>,
}

/// Cost of a method.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cost {
    pub method: String,
    /// Varied parameter, empty if there is none.
    pub parameter: String,
    /// Identifier of the work ([`super::plan::Job::work`]) of the first method.
    pub first: String,
    /// Candidates by value, or the method unchanged.
    pub candidates: Vec<Candidate>,
    /// Index of the candidate with the time nearest to the first method's.
    pub chosen: Option<usize>,
}

/// `stability.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// `SCHEMA`.
    pub schema: String,
    pub version: String,
    /// Name of the suite.
    pub suite: String,
    /// Text of the suite's file.
    pub text: String,
    /// Samples per pixel and bounces of the references, `None` without.
    pub reference: Option<(u64, u32)>,
    /// Parts of the light with tables on the page. The files have all parts.
    #[serde(default)]
    pub tables: Vec<String>,
    /// The part with charts next to the total: its name, and its name within a sentence.
    #[serde(default)]
    pub focus: Option<(String, String)>,
    /// Costs of charted methods, empty without a chart.
    #[serde(default)]
    pub costs: Vec<Cost>,
    /// Results of every method in every case, in order.
    pub results: Vec<CaseRecord>,
}

impl Report {
    /// Results by title of the case.
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

    /// Ratio to the time of the first method: median of the rounds.
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
    /// Result of a part of the light.
    pub fn part(&self, name: &str) -> Option<&PartResult> {
        self.done()?.parts.get(name)
    }
}

/// Title of a case with its variant.
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
