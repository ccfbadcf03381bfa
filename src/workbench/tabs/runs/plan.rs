//! The options of a run, its files, and its command.

use crate::graph::param::{Kind as ParamKind, Param, Value};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Most values that are suggested for a sweep.
const VALUES: usize = 5;
/// Name of the plan's file in the run's folder.
pub(super) const FILE: &str = "run.ron";
/// Name of the experiment's file in the run's folder.
pub(super) const EXPERIMENT: &str = "experiment.ron";

/// A command that a run executes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Kind {
    #[default]
    Sweep,
    Stability,
    Bench,
    Fit,
}

impl Kind {
    pub(super) const ALL: [Kind; 4] = [Kind::Sweep, Kind::Stability, Kind::Bench, Kind::Fit];

    pub(super) fn title(self) -> &'static str {
        match self {
            Kind::Sweep => "Sweep",
            Kind::Stability => "Stability",
            Kind::Bench => "Benchmark",
            Kind::Fit => "Fit",
        }
    }

    pub(super) fn about(self) -> &'static str {
        match self {
            Kind::Sweep => "Measures time and error for each value of a parameter.",
            Kind::Stability => "Measures flicker and lag while the camera moves.",
            Kind::Bench => "Measures the GPU time of each pass, in rounds.",
            Kind::Fit => "Searches the cheapest settings within an error bound.",
        }
    }

    /// Folder under `captures`, as the command has it.
    pub(super) fn folder(self) -> &'static str {
        match self {
            Kind::Sweep => "sweeps",
            Kind::Stability => "stability",
            Kind::Bench => "bench",
            Kind::Fit => "fit",
        }
    }

    /// The table of a finished run.
    pub(super) fn table(self, folder: &Path) -> PathBuf {
        match self {
            Kind::Sweep => folder.join("sweep.csv"),
            Kind::Stability => folder.join("stability.csv"),
            Kind::Bench => folder.join("bench.csv"),
            Kind::Fit => trials(folder).join("sweep.csv"),
        }
    }

    /// The report of a finished run.
    pub(super) fn report(self, folder: &Path) -> PathBuf {
        match self {
            Kind::Sweep => folder.join("report/index.html"),
            Kind::Stability => folder.join("index.html"),
            Kind::Bench => folder.join("stages.svg"),
            Kind::Fit => trials(folder).join("report/index.html"),
        }
    }

    /// Arguments of the command that writes the report, if the run does not write it.
    pub(super) fn report_command(self, folder: &Path) -> Option<Vec<String>> {
        let points = match self {
            Kind::Sweep => folder.to_path_buf(),
            Kind::Fit => trials(folder),
            Kind::Stability | Kind::Bench => return None,
        };
        Some(vec!["report".into(), points.display().to_string()])
    }
}

/// The sweep of a search: in the run's folder, or the folder itself for a run of the command line.
fn trials(folder: &Path) -> PathBuf {
    let inside = folder.join("trials");
    match inside.is_dir() {
        true => inside,
        false => folder.to_path_buf(),
    }
}

/// What to measure of an experiment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Plan {
    pub kind: Kind,
    /// Varied parameter of a sweep.
    pub param: String,
    /// Its values as RON.
    pub values: Vec<String>,
    /// Picture size.
    pub size: (u32, u32),
    /// Measured frames of each point.
    pub frames: usize,
    /// Rounds of a benchmark.
    pub rounds: usize,
    /// Samples per pixel of the reference. 0 uses cached references only.
    pub samples: u64,
    /// Bound of a search, relMSE.
    pub max_error: f64,
}

impl Default for Plan {
    fn default() -> Plan {
        Plan {
            kind: Kind::Sweep,
            param: String::new(),
            values: Vec::new(),
            size: (0, 0),
            frames: 20,
            rounds: 5,
            samples: 256,
            max_error: 0.01,
        }
    }
}

impl Plan {
    /// The sweep's or suite's file of a run named `name`, if its command reads one. `step` is the
    /// camera's step per frame in metres.
    pub fn file(&self, name: &str, step: f32) -> Option<(String, String)> {
        let (w, h) = self.size;
        let frames = self.frames;
        let text = match self.kind {
            Kind::Sweep => format!(
                "(\n    experiments: [\"{EXPERIMENT}\"],\n    frames: {frames},\n    set: {{ \"size\": ({w}, {h}) }},\n    \
                 axes: [List(name: \"{}\", values: [{}])],\n)\n",
                self.param,
                self.values.join(", ")
            ),
            Kind::Stability => format!(
                "(\n    experiment: \"{EXPERIMENT}\",\n    frames: {frames},\n    samples: {},\n    \
                 set: {{ \"size\": ({w}, {h}) }},\n    methods: {{ \"{name}\": {{}} }},\n    cases: {{\n        \
                 \"still\": (about: \"Nothing moves.\"),\n        \
                 \"dolly\": (about: \"The camera moves forwards.\", motion: Camera(dolly: {step})),\n        \
                 \"strafe\": (about: \"The camera moves sideways.\", motion: Camera(strafe: {step})),\n        \
                 \"yaw\": (about: \"The camera turns.\", motion: Camera(yaw: 0.7)),\n    }},\n)\n",
                self.samples.max(1)
            ),
            Kind::Bench | Kind::Fit => return None,
        };
        Some((format!("{name}.ron"), text))
    }

    /// Arguments of the command that runs it in `folder`. A second call resumes it.
    pub fn command(&self, folder: &Path, name: &str) -> Vec<String> {
        let path = |file: &str| folder.join(file).display().to_string();
        let (size, frames) = (
            format!("{}x{}", self.size.0, self.size.1),
            self.frames.to_string(),
        );
        let samples = self.samples.to_string();
        let out = folder.display().to_string();
        match self.kind {
            Kind::Sweep => {
                let mut words = vec!["sweep".into(), path(&format!("{name}.ron")), "-o".into()];
                words.push(out);
                if self.samples > 0 {
                    words.extend(["--reference".into(), samples]);
                }
                words
            }
            Kind::Stability => ["stability", &path(&format!("{name}.ron")), "-o", &out]
                .map(String::from)
                .to_vec(),
            Kind::Bench => {
                let rounds = self.rounds.to_string();
                let (from, sizes) = (path(EXPERIMENT), "--sizes");
                let words = ["bench", &from, sizes, &size, "--frames", &frames];
                let rest = ["--rounds", &rounds, "-o", &out];
                words.iter().chain(&rest).map(ToString::to_string).collect()
            }
            Kind::Fit => {
                let bound = self.max_error.to_string();
                let (from, to) = (path(EXPERIMENT), path("trials.ron"));
                let words = ["fit", &from, "--max-error", &bound, "--size", &size];
                let spp = self.samples.max(1).to_string();
                let rest = ["--frames", &frames, "--spp", &spp, "-o", &to];
                words.iter().chain(&rest).map(ToString::to_string).collect()
            }
        }
    }
}

/// Values to suggest for a sweep of a parameter: all of a choice, some of a range.
pub(super) fn suggested(param: &Param, now: &Value) -> Vec<String> {
    match (&param.kind, now) {
        (_, Value::Bool(_)) => vec!["false".into(), "true".into()],
        (ParamKind::Choice(options), _) => options.clone(),
        (_, Value::Int(_) | Value::Float(_)) => numbers(param, now),
        _ => vec![now.to_ron()],
    }
}

fn numbers(param: &Param, now: &Value) -> Vec<String> {
    let finite = |(low, high): &(f64, f64)| low.is_finite() && high.is_finite();
    let Some((low, high)) = param.range.filter(finite) else {
        return vec![now.to_ron()];
    };
    let logarithmic = low > 0.0 && high / low >= 16.0;
    let step = param.step.unwrap_or(0.0);
    let mut list: Vec<String> = Vec::new();
    for i in 0..VALUES {
        let t = i as f64 / (VALUES - 1) as f64;
        let at = match logarithmic {
            true => low * (high / low).powf(t),
            false => low + t * (high - low),
        };
        let on_step = match step > 0.0 {
            true => (low + ((at - low) / step).round() * step).clamp(low, high),
            false => at,
        };
        let value = match now {
            Value::Int(_) => Value::Int(on_step.round() as i64),
            _ => Value::Float((on_step * 1e3).round() / 1e3),
        };
        let text = value.to_ron();
        if param.check(&value).is_ok() && !list.contains(&text) {
            list.push(text);
        }
    }
    list
}

/// The values of a comma-separated text as RON.
pub(super) fn read_values(param: &Param, text: &str) -> Result<Vec<String>, String> {
    let is_vector = matches!(param.default, Value::Vector(_));
    let split: Vec<&str> = match is_vector {
        true => text.split(';').collect(),
        false => text.split(',').collect(),
    };
    let words = split.into_iter().map(str::trim).filter(|w| !w.is_empty());
    let values = words.map(|word| {
        let quoted = match param.default {
            Value::Choice(_) => format!("{:?}", word.trim_matches('"')),
            _ => word.to_string(),
        };
        param.parse(&quoted).map(|value| value.to_ron())
    });
    let list = values.collect::<Result<Vec<_>, _>>()?;
    match list.is_empty() {
        true => Err("name at least one value".into()),
        false => Ok(list),
    }
}

/// The separator of values in the field.
pub(super) fn joined(param: &Param, values: &[String]) -> String {
    match param.default {
        Value::Vector(_) => values.join("; "),
        _ => values.join(", "),
    }
}
