//! Recorded times: times of some configurations on one device, with the settings to measure them
//! again (docs/sweeps.md).

use super::{Bench, Times};
use crate::campaign::points::{Labels, SweepPoint};
use crate::campaign::record::read_json;
use crate::campaign::runner::Mistakes;
use crate::campaign::settings::{apply, lines};
use crate::diagnostics::Diagnostic;
use crate::experiment::{Experiment, FIELDS};
use crate::files::FileError;
use crate::lab::{LabError, Workspace};
use crate::measure::{Frames, Warm};
use crate::results::stats::DeviceStats;
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Version of the file.
pub const RECORD_SCHEMA: &str = "conelab-times-1";
/// Largest file, bytes.
const MAX_BYTES: u64 = 4 << 20;
const MAX_CONFIGURATIONS: usize = 1000;
/// Largest number of rounds, and of frames in a round.
const MAX_FRAMES: usize = 100_000;

/// Times of configurations on one device.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Version of the file.
    pub schema: String,
    pub(crate) version: String,
    pub(crate) device: DeviceStats,
    pub(crate) rounds: usize,
    /// Frames of every turn.
    pub frames: Frames,
    pub(crate) configurations: Vec<Recorded>,
}

/// A configuration and its times.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Recorded {
    /// Experiment file, relative to the program's folder or absolute. The record stays valid if a
    /// parameter is renamed in file and graph.
    pub experiment: String,
    /// Settings over the experiment: name and RON. They always contain scene, camera, size and
    /// time.
    pub settings: IndexMap<String, String>,
    /// SHA-256 of the scene's content.
    pub scene_sha256: String,
    /// All parameters, to print those that differ today.
    pub params: BTreeMap<String, String>,
    /// Median of the whole frame in every round, ms.
    pub total: Vec<f64>,
    /// Median of every stage in every round, ms, in the order of the graph.
    pub stages: IndexMap<String, Vec<f64>>,
}

/// File of a device's record: `path` itself if it ends in `.json`, else a file in the folder
/// `path`.
pub fn record_file(path: &Path, device: &str) -> PathBuf {
    if path.extension().is_some_and(|e| e == "json") {
        return path.to_path_buf();
    }
    let letters: String = device
        .to_lowercase()
        .chars()
        .map(|c| if c.is_alphanumeric() { c } else { ' ' })
        .collect();
    path.join(letters.split_whitespace().collect::<Vec<_>>().join("-") + ".json")
}

/// Checks that the experiments, graphs and parameters of a record are valid. Scenes are not opened.
pub fn check_record(home: &Workspace, path: &Path) -> Result<(), LabError> {
    let mut warm = Warm::default();
    let mut mistakes = Mistakes::default();
    for recorded in Record::read(path)?.configurations {
        let experiment = recorded.experiment(home).map_err(LabError::Input);
        mistakes.take(experiment.and_then(|experiment| warm.check(home, &experiment)))?;
    }
    mistakes.none()
}

impl Record {
    /// The record of a benchmark and its measured `points`.
    pub(crate) fn of(
        bench: &Bench,
        points: &[SweepPoint],
        home: &Workspace,
    ) -> Result<Record, LabError> {
        let mut configurations = Vec::new();
        for (configuration, point) in bench.configurations.iter().zip(points) {
            let Some(times) = &configuration.times else {
                return Err(LabError::Request(
                    "nothing was recorded, as a configuration failed".into(),
                ));
            };
            if times.rounds.iter().any(|ms| *ms <= 0.0) {
                return Err(LabError::Request(
                    "nothing was recorded: this device measures no times".into(),
                ));
            }
            configurations.push(Recorded::of(point, times, home));
        }
        Ok(Record {
            schema: RECORD_SCHEMA.into(),
            version: env!("CARGO_PKG_VERSION").into(),
            device: bench.device.clone(),
            rounds: bench.rounds,
            frames: bench.frames,
            configurations,
        })
    }

    /// Reads and checks a record.
    pub fn read(path: &Path) -> Result<Record, LabError> {
        let wrong = |why: String| LabError::from(FileError::content(path, why));
        let record: Record = read_json(path, MAX_BYTES).map_err(|e| {
            wrong(format!(
                "{e}; give a file that `conelab bench ... --record FILE` wrote"
            ))
        })?;
        record.check().map_err(wrong)?;
        Ok(record)
    }

    fn check(&self) -> Result<(), String> {
        if self.schema != RECORD_SCHEMA {
            return Err(format!(
                "its schema is '{}', this program reads '{RECORD_SCHEMA}'",
                self.schema
            ));
        }
        let Frames { warmup, count } = self.frames;
        let most = self.rounds.max(count).max(warmup);
        if self.rounds == 0 || count == 0 || most > MAX_FRAMES {
            return Err(format!(
                "rounds and frames must be 1 to {MAX_FRAMES}, and no more of warm-up"
            ));
        }
        if self.configurations.is_empty() || self.configurations.len() > MAX_CONFIGURATIONS {
            let found = self.configurations.len();
            return Err(format!(
                "it has {found} configurations and not 1 to {MAX_CONFIGURATIONS}"
            ));
        }
        let (name, driver) = (&self.device.name, &self.device.driver);
        let texts = self
            .configurations
            .iter()
            .flat_map(Recorded::texts)
            .chain([name, driver]);
        if let Some(text) = texts.into_iter().find(|t| t.chars().any(char::is_control)) {
            return Err(format!("{text:?} has characters that cannot be printed"));
        }
        self.configurations
            .iter()
            .enumerate()
            .try_for_each(|(i, c)| {
                c.check()
                    .map_err(|why| format!("configuration {}: {why}", i + 1))
            })
    }

    /// Checks that its times are comparable with those of a device.
    pub fn check_device(&self, device: &DeviceStats) -> Result<(), LabError> {
        if self.device.name == device.name {
            return Ok(());
        }
        Err(LabError::Request(format!(
            "the record is of '{}' and this device is '{}': times of different devices cannot be compared. Choose the \
             device with --device, or record times of this one with `conelab bench EXPERIMENT... --record FILE`",
            self.device.name, device.name
        )))
    }
}

impl Recorded {
    fn of(point: &SweepPoint, times: &Times, home: &Workspace) -> Recorded {
        let SweepPoint {
            experiment,
            subject,
            ..
        } = point;
        let file = experiment.sources.paths().next().unwrap_or(Path::new(""));
        let scene = match Path::new(&experiment.scene).is_file() {
            true => from_root(home, Path::new(&experiment.scene)),
            false => experiment.scene.clone(),
        };
        // Settings as in a file of the program's folder: complete camera and scene, and the graph
        // if it was set.
        let (path, mut settings) = (home.root.join("record"), IndexMap::new());
        for field in FIELDS.iter().filter(|f| f.name != "graph") {
            let text = match field.name {
                "scene" => format!("{scene:?}"),
                "camera" => subject.camera.clone(),
                _ => field.text(experiment, &path),
            };
            if !text.is_empty() {
                settings.insert(field.name.to_string(), text);
            }
        }
        if point.labels.iter().any(|(name, _)| name == "graph") {
            settings.insert("graph".into(), format!("{:?}", experiment.graph));
        }
        // Values that differ from the experiment's file come from the command line.
        let set = experiment
            .params
            .iter()
            .filter(|(name, _)| name.at.file > 0);
        settings.extend(set.map(|(name, text)| (name.value.clone(), text.clone())));
        let rounded = |list: &[f64]| {
            list.iter()
                .map(|ms| (ms * 1e4).round() / 1e4)
                .collect::<Vec<f64>>()
        };
        Recorded {
            experiment: from_root(home, file),
            settings,
            scene_sha256: subject.sha256.clone(),
            params: times
                .stats
                .params
                .iter()
                .map(|(name, value)| (name.clone(), plain(value)))
                .collect(),
            total: rounded(&times.rounds),
            stages: times
                .stage_rounds
                .iter()
                .map(|(name, rounds)| (name.clone(), rounded(rounds)))
                .collect(),
        }
    }

    fn check(&self) -> Result<(), String> {
        let lists = self.stages.iter().map(|(name, list)| (name.as_str(), list));
        for (name, list) in lists.chain([("total", &self.total)]) {
            if list.is_empty() {
                return Err(format!("'{name}' has no times"));
            }
            if let Some(ms) = list.iter().find(|ms| !ms.is_finite() || **ms < 0.0) {
                return Err(format!(
                    "'{name}' took {ms} ms: times must be finite and not negative"
                ));
            }
        }
        match self.total.iter().find(|ms| **ms == 0.0) {
            Some(_) => Err("'total' took 0 ms".into()),
            None => Ok(()),
        }
    }

    /// All texts that may be printed.
    fn texts(&self) -> impl Iterator<Item = &String> {
        let settings = self.settings.iter().flat_map(|(name, value)| [name, value]);
        let params = self.params.iter().flat_map(|(name, value)| [name, value]);
        settings
            .chain(params)
            .chain(self.stages.keys())
            .chain([&self.experiment, &self.scene_sha256])
    }

    /// Experiment, scene, size and other settings as a title.
    pub fn title(&self) -> String {
        let said = |name: &str| self.settings.get(name).map(|t| t.trim_matches('"'));
        let mut parts = vec![stem(&self.experiment)];
        parts.extend(said("scene").map(stem));
        parts.extend(said("size").map(|s| s.replace(['(', ')', ' '], "").replace(',', "x")));
        let others = self
            .settings
            .iter()
            .filter(|(name, _)| !FIXED.contains(&name.as_str()));
        parts.extend(others.map(|(name, value)| format!("{name} {value}")));
        parts.join(", ")
    }

    /// Values by name, for tables.
    pub fn labels(&self) -> Labels {
        let shown = self
            .settings
            .iter()
            .filter(|(name, _)| *name != "camera" && *name != "time");
        let shown = shown.map(|(name, value)| (name.clone(), value.trim_matches('"').to_string()));
        [("experiment".to_string(), stem(&self.experiment))]
            .into_iter()
            .chain(shown)
            .collect()
    }

    /// File of the experiment.
    pub fn file(&self, home: &Workspace) -> PathBuf {
        home.root.join(&self.experiment)
    }

    /// The experiment with today's file.
    pub fn experiment(&self, home: &Workspace) -> Result<Experiment, Vec<Diagnostic>> {
        let mut experiment = Experiment::read(&self.file(home))?;
        let (text, settings) = lines(
            self.settings
                .iter()
                .map(|(name, text)| (name.as_str(), text.as_str())),
            ": ",
        );
        experiment
            .sources
            .add(format!("settings of {}", self.title()).as_ref(), text);
        let errors = apply(&mut experiment, &settings, &home.root);
        if errors.is_empty() {
            Ok(experiment)
        } else {
            Err(errors)
        }
    }
}

/// Settings that every configuration has.
const FIXED: [&str; 4] = ["scene", "camera", "size", "time"];

/// Path for a record, relative to the program's folder if the file is inside it, so that records
/// hold in every checkout.
fn from_root(home: &Workspace, file: &Path) -> String {
    let whole = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    let (root, file) = (whole(&home.root), whole(file));
    file.strip_prefix(root)
        .unwrap_or(&file)
        .to_string_lossy()
        .into_owned()
}

fn stem(path: &str) -> String {
    Path::new(path)
        .file_stem()
        .map_or(path.to_string(), |s| s.to_string_lossy().into_owned())
}

/// A value as text, names without quotes.
pub(super) fn plain(value: &serde_json::Value) -> String {
    value
        .as_str()
        .map_or_else(|| value.to_string(), String::from)
}
