//! Sweep files: experiments and varied settings (docs/sweeps.md).

use super::axis::{Axis, Choice, MAX_POINTS, choices};
use super::points::Sweep;
use crate::campaign::settings::settings;
use crate::campaign::source::Source;
use crate::diagnostics::{Diagnostic, Entries, Items, Loc, Place, RawText};
use crate::experiment::Experiment;
use crate::measure::Frames;
use crate::measure::reference::ALL_BOUNCES;
use serde::Deserialize;
use std::path::Path;

/// Most frames of one point.
const MAX_FRAMES: usize = 100_000;
/// Frames of a point where a sweep does not say.
pub const DEFAULT_FRAMES: Frames = Frames {
    warmup: 40,
    count: 20,
};

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
    /// Settings of every point.
    #[serde(default)]
    set: Entries<RawText>,
    #[serde(default)]
    axes: Items<Axis>,
}

impl Sweep {
    /// Reads a sweep and the experiments it names.
    pub fn read(path: &Path) -> Result<Sweep, Vec<Diagnostic>> {
        let (file, mut source) = Source::read::<SweepFile>(
            path,
            "give the path of a sweep, for example configs/sweeps/cones.ron",
        )?;
        let mut read = |list: &Items<String>| -> Vec<Experiment> {
            let list = list.0.iter();
            list.filter_map(|e| source.experiment(e)).collect()
        };
        let (experiments, beside) = (read(&file.experiments), read(&file.beside));
        if file.experiments.0.is_empty() {
            let place = Place {
                file: path.to_path_buf(),
                ..Place::default()
            };
            source.errors.push(Diagnostic::error(
                place,
                "`experiments` is empty: name at least one",
            ));
        }
        let mut frames =
            |value, default, least| source.number("frames", value, default, (least, MAX_FRAMES));
        let frames = Frames {
            warmup: frames(&file.warmup, DEFAULT_FRAMES.warmup, 0),
            count: frames(&file.frames, DEFAULT_FRAMES.count, 1),
        };
        let (axes, mut names) = axes(&file.axes, experiments.len(), &mut source);
        if !source.errors.is_empty() {
            return Err(source.errors);
        }
        if experiments.len() + beside.len() > 1 {
            names.insert(0, "experiment".into());
        }
        let mut bounces: Vec<u32> = file.bounces.0.iter().map(|b| b.value).collect();
        if bounces.is_empty() {
            bounces.push(ALL_BOUNCES);
        }
        Ok(Sweep {
            name: source.name(),
            text: source.text(),
            experiments,
            beside,
            names,
            frames,
            bounces,
            fixed: settings(&file.set),
            axes,
            folder: source.folder(),
        })
    }
}

/// Choices of all axes, and names of the varied settings.
fn axes(
    list: &Items<Axis>,
    experiments: usize,
    source: &mut Source,
) -> (Vec<Vec<Choice>>, Vec<String>) {
    let (mut axes, mut names): (Vec<Vec<Choice>>, Vec<String>) = (Vec::new(), Vec::new());
    let mut points = experiments;
    for axis in &list.0 {
        match choices(&axis.value) {
            Ok(choices) => {
                for (name, _) in choices.first().map_or(&[][..], |c| &c.labels) {
                    if names.contains(name) {
                        source.wrong(axis.at, format!("'{name}' is varied by two axes"));
                    }
                    names.push(name.clone());
                }
                points = points.saturating_mul(choices.len());
                axes.push(choices);
            }
            Err((at, message)) => source.wrong(at.unwrap_or(axis.at), message),
        }
        if points > MAX_POINTS {
            let message = format!(
                "with this axis there are {points} points, more than the {MAX_POINTS} allowed"
            );
            source.wrong(axis.at, message);
            break;
        }
    }
    (axes, names)
}
