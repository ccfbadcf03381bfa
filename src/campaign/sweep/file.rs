//! Sweep files: which experiments, and what is varied (docs/sweeps.md).

use super::axis::{Axis, Choice, choices};
use super::points::{MAX_POINTS, Sweep};
use super::settings::Setting;
use crate::experiment::Experiment;
use crate::graph::file::RawText;
use crate::graph::source::{Diagnostic, Entries, Items, Loc, Place, Severity, Sources};
use crate::measure::Frames;
use crate::measure::reference::ALL_BOUNCES;
use serde::Deserialize;
use std::path::Path;

/// Most frames of one point.
const MAX_FRAMES: usize = 100_000;
/// Frames when nothing is said.
const DEFAULT_FRAMES: Frames = Frames { warmup: 40, count: 20 };

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct SweepFile {
    /// Experiment files, relative to the sweep's folder.
    experiments: Items<String>,
    /// Experiments that are measured once, without the axes.
    #[serde(default)]
    beside: Items<String>,
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
        let swept = experiments(path, &parsed.experiments, &sources, &mut errors);
        let beside = experiments(path, &parsed.beside, &sources, &mut errors);
        if parsed.experiments.0.is_empty() {
            let place = Place { file: path.to_path_buf(), ..Place::default() };
            errors.push(Diagnostic::error(place, "`experiments` is empty: name at least one"));
        }
        let mut count = |value: &Option<Loc<usize>>, default: usize, least: usize| match value {
            Some(v) if v.value < least || v.value > MAX_FRAMES => {
                errors.push(sources.error(v.at, format!("frames must be {least} to {MAX_FRAMES}")));
                default
            }
            Some(v) => v.value,
            None => default,
        };
        let warmup = count(&parsed.warmup, DEFAULT_FRAMES.warmup, 0);
        let frames = Frames { warmup, count: count(&parsed.frames, DEFAULT_FRAMES.count, 1) };
        let (axes, mut names) = axes(&parsed.axes, swept.len(), &sources, &mut errors);
        if !errors.is_empty() {
            return Err(errors);
        }
        if swept.len() + beside.len() > 1 {
            names.insert(0, "experiment".into());
        }
        let mut bounces: Vec<u32> = parsed.bounces.0.iter().map(|b| b.value).collect();
        if bounces.is_empty() {
            bounces.push(ALL_BOUNCES);
        }
        Ok(Sweep {
            name: path.file_stem().map_or(String::new(), |s| s.to_string_lossy().into_owned()),
            text: text_of(&sources),
            experiments: swept,
            beside,
            names,
            frames,
            bounces,
            fixed: parsed.set.0.into_iter().map(|(name, text)| Setting::new(name, &text)).collect(),
            axes,
            folder: path.parent().unwrap_or(Path::new(".")).to_path_buf(),
        })
    }
}

fn text_of(sources: &Sources) -> String {
    sources.texts().next().map_or(String::new(), |t| t.1.to_string())
}

/// Reads experiments. The sweep's text is the last of their sources, so that settings keep their places.
fn experiments(path: &Path, names: &Items<String>, sources: &Sources, errors: &mut Vec<Diagnostic>) -> Vec<Experiment> {
    let folder = path.parent().unwrap_or(Path::new("."));
    let mut list = Vec::new();
    for name in &names.0 {
        match Experiment::read(&folder.join(&name.value)) {
            Ok(mut experiment) => {
                experiment.sources.add(path, text_of(sources));
                list.push(experiment);
            }
            // A file that cannot be read is a mistake of the sweep.
            Err(found) if found.iter().all(|d| d.place.line == 0) => {
                errors.extend(found.iter().map(|d| {
                    sources.error(name.at, format!("{}: {}", d.place.file.display(), d.message)).help(d.help.clone())
                }));
            }
            Err(found) => errors.extend(found),
        }
    }
    list
}

/// The choices of all axes, and the names of what they vary.
fn axes(
    list: &Items<Axis>,
    experiments: usize,
    sources: &Sources,
    errors: &mut Vec<Diagnostic>,
) -> (Vec<Vec<Choice>>, Vec<String>) {
    let (mut axes, mut names): (Vec<Vec<Choice>>, Vec<String>) = (Vec::new(), Vec::new());
    let mut points = experiments;
    for axis in &list.0 {
        match choices(&axis.value) {
            Ok(choices) => {
                for (name, _) in choices.first().map_or(&[][..], |c| &c.labels) {
                    if names.contains(name) {
                        errors.push(sources.error(axis.at, format!("'{name}' is varied by two axes")));
                    }
                    names.push(name.clone());
                }
                points = points.saturating_mul(choices.len());
                axes.push(choices);
            }
            Err((at, message)) => errors.push(sources.error(at.unwrap_or(axis.at), message)),
        }
        if points > MAX_POINTS {
            let message = format!("with this axis there are {points} points, more than the {MAX_POINTS} allowed");
            errors.push(sources.error(axis.at, message));
            break;
        }
    }
    (axes, names)
}
