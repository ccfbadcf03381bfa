//! Sweep files: which experiments, and what is varied (docs/sweeps.md).

use super::axis::{Axis, Choice, choices};
use super::settings::Setting;
use crate::experiment::Experiment;
use crate::graph::file::RawText;
use crate::graph::source::{At, Diagnostic, Entries, Items, Loc, Severity, Sources};
use crate::lab::LabError;
use crate::measure::Frames;
use serde::Deserialize;
use std::path::Path;

/// Most points of a sweep.
pub const MAX_POINTS: usize = 20_000;
/// What voxel cones gather.
const DEFAULT_BOUNCES: [u32; 1] = [1];
/// Most frames of one point.
const MAX_FRAMES: usize = 100_000;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct SweepFile {
    /// Experiment files, relative to the sweep's folder.
    experiments: Items<String>,
    #[serde(default)]
    warmup: Option<Loc<usize>>,
    #[serde(default)]
    frames: Option<Loc<usize>>,
    /// Bounces of the references that points are scored against.
    #[serde(default)]
    bounces: Items<u32>,
    /// What every point sets.
    #[serde(default)]
    set: Entries<RawText>,
    #[serde(default)]
    axes: Items<Axis>,
}

/// The values of a point, by the names of what is varied.
pub type Labels = Vec<(String, String)>;

/// A sweep: every experiment with every combination of the axes' choices.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// The file's stem.
    pub name: String,
    /// The file's text.
    pub text: String,
    /// The experiments; their sources hold the sweep's text too, at [`Sweep::source`].
    pub experiments: Vec<Experiment>,
    /// Names of what is varied, in order.
    pub names: Vec<String>,
    /// Frames of every point.
    pub frames: Frames,
    /// Bounces of the references that points are scored against: all parts against the first, the total against all.
    pub bounces: Vec<u32>,
    pub(super) fixed: Vec<Setting>,
    pub(super) axes: Vec<Vec<Choice>>,
    /// Folder of the sweep's file: scene files are looked up in it.
    pub(super) folder: std::path::PathBuf,
}

impl Sweep {
    /// Reads a sweep and the experiments it names.
    ///
    /// # Errors
    /// All mistakes of the file and of the experiments.
    pub fn read(path: &Path) -> Result<Sweep, Vec<Diagnostic>> {
        let mut sources = Sources::default();
        let file = sources
            .read(path)
            .map_err(|e| vec![e.help(Some("give the path of a sweep, for example configs/sweeps/cones.ron".into()))])?;
        let mut errors = Vec::new();
        let parsed = sources.parse::<SweepFile>(file, &mut errors, &mut Vec::new());
        let Some(parsed) = parsed.filter(|_| !errors.iter().any(|e| e.severity == Severity::Error)) else {
            return Err(errors);
        };
        let folder = path.parent().unwrap_or(Path::new("."));
        let text = sources.texts().next().map_or(String::new(), |t| t.1.to_string());
        let mut experiments = Vec::new();
        for name in &parsed.experiments.0 {
            match Experiment::read(&folder.join(&name.value)) {
                Ok(mut experiment) => {
                    // Settings keep their places in the sweep: their file gets the number that follows the experiment's.
                    experiment.sources.add(path, text.clone());
                    experiments.push(experiment);
                }
                Err(list) if list.iter().all(|d| d.place.line == 0) => {
                    errors.extend(list.iter().map(|d| sources.error(name.at, d.to_string())));
                }
                Err(list) => errors.extend(list),
            }
        }
        if parsed.experiments.0.is_empty() {
            errors.push(Diagnostic::error(
                crate::graph::source::Place { file: path.to_path_buf(), ..Default::default() },
                "`experiments` is empty: name at least one",
            ));
        }
        let mut count = |value: &Option<Loc<usize>>, default: usize, least: usize| match value {
            Some(v) if v.value < least || v.value > MAX_FRAMES => {
                errors.push(sources.error(v.at, format!("frames must be {least} to {MAX_FRAMES}")));
                default
            }
            Some(v) => v.value,
            None => default,
        };
        let frames = Frames { warmup: count(&parsed.warmup, 10, 0), count: count(&parsed.frames, 50, 1) };
        let mut bounces: Vec<u32> = parsed.bounces.0.iter().map(|b| b.value).collect();
        if bounces.is_empty() {
            bounces = DEFAULT_BOUNCES.to_vec();
        }
        let fixed: Vec<Setting> = parsed.set.0.into_iter().map(|(name, text)| Setting::new(name, &text)).collect();
        let mut axes: Vec<Vec<Choice>> = Vec::new();
        let mut names: Vec<String> = Vec::new();
        let mut points = experiments.len();
        for axis in &parsed.axes.0 {
            match choices(&axis.value) {
                Ok(list) => {
                    for (name, _) in list.first().map_or(&[][..], |c| &c.labels) {
                        if names.contains(name) {
                            errors.push(sources.error(axis.at, format!("'{name}' is varied by two axes")));
                        }
                        names.push(name.clone());
                    }
                    points = points.saturating_mul(list.len());
                    axes.push(list);
                }
                Err((at, message)) => errors.push(sources.error(at.unwrap_or(axis.at), message)),
            }
            if points > MAX_POINTS {
                errors.push(sources.error(
                    axis.at,
                    format!("with this axis there are {points} points, more than the {MAX_POINTS} allowed"),
                ));
                break;
            }
        }
        if !errors.is_empty() {
            return Err(errors);
        }
        if experiments.len() > 1 {
            names.insert(0, "experiment".into());
        }
        Ok(Sweep {
            name: path.file_stem().map_or(String::new(), |s| s.to_string_lossy().into_owned()),
            text,
            experiments,
            names,
            frames,
            bounces,
            fixed,
            axes,
            folder: folder.to_path_buf(),
        })
    }

    /// A sweep without a file: every experiment with every combination of settings, each with its values as RON.
    ///
    /// # Errors
    /// A setting without values; more than [`MAX_POINTS`] combinations.
    pub fn of(
        mut experiments: Vec<Experiment>,
        axes: &[(String, Vec<String>)],
        frames: Frames,
    ) -> Result<Sweep, LabError> {
        // Messages about values point at the line of their setting.
        let lines: Vec<String> = axes.iter().map(|(name, values)| format!("{name}={}", values.join(","))).collect();
        let text = lines.join("\n");
        for experiment in &mut experiments {
            experiment.sources.add("--axis".as_ref(), text.clone());
        }
        let mut offset = 0;
        let mut list = Vec::new();
        for ((name, values), line) in axes.iter().zip(&lines) {
            if values.is_empty() {
                return Err(LabError::Request(format!("'{name}' has no values")));
            }
            let at = At { file: 0, offset };
            let name = Loc { value: name.clone(), at };
            list.push(values.iter().map(|v| Choice::one(&name, at, v.clone())).collect::<Vec<_>>());
            offset += u32::try_from(line.len() + 1).unwrap_or(0);
        }
        let points = list.iter().fold(experiments.len(), |n, l| n.saturating_mul(l.len()));
        if points > MAX_POINTS {
            return Err(LabError::Request(format!("{points} combinations are more than the {MAX_POINTS} allowed")));
        }
        let names = axes.iter().map(|a| a.0.clone());
        let names = (experiments.len() > 1).then(|| "experiment".to_string()).into_iter().chain(names).collect();
        let name = experiments.first().map_or(String::new(), |e| e.name.clone());
        let bounces = DEFAULT_BOUNCES.to_vec();
        Ok(Sweep { name, text, experiments, names, frames, bounces, fixed: Vec::new(), axes: list, folder: ".".into() })
    }

    /// How many combinations there are.
    pub fn len(&self) -> usize {
        self.axes.iter().map(Vec::len).product::<usize>() * self.experiments.len()
    }

    /// Whether there is nothing to measure.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One combination: its experiment, and its values by the names of what is varied. The last axis varies fastest.
    ///
    /// # Errors
    /// Settings that are none, with their places.
    pub fn point(&self, index: usize) -> Result<(Experiment, Labels), Vec<Diagnostic>> {
        let mut rest = index;
        let mut chosen = Vec::new();
        for axis in self.axes.iter().rev() {
            chosen.push(&axis[rest % axis.len()]);
            rest /= axis.len();
        }
        chosen.reverse();
        let mut experiment = self.experiments[rest % self.experiments.len()].clone();
        let mut labels = Vec::new();
        if self.experiments.len() > 1 {
            labels.push(("experiment".to_string(), experiment.name.clone()));
        }
        labels.extend(chosen.iter().flat_map(|c| c.labels.clone()));
        let file = u32::try_from(experiment.sources.paths().count().saturating_sub(1)).unwrap_or(0);
        let mut errors = Vec::new();
        for setting in self.fixed.iter().chain(chosen.iter().flat_map(|c| &c.settings)) {
            if let Err(message) = setting.apply(&mut experiment, file, &self.folder) {
                let at = At { file, offset: setting.name.at.offset };
                errors.push(experiment.sources.error(at, message));
            }
        }
        if errors.is_empty() { Ok((experiment, labels)) } else { Err(errors) }
    }
}
