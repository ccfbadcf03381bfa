//! A sweep as a list of points.

use super::axis::Choice;
use super::settings::Setting;
use crate::experiment::Experiment;
use crate::graph::source::{At, Diagnostic, Loc};
use crate::lab::LabError;
use crate::measure::Frames;
use crate::measure::reference::ALL_BOUNCES;
use std::path::PathBuf;

/// Most points of a sweep.
pub const MAX_POINTS: usize = 20_000;

/// What [`Sweep::one_at_a_time`] varies: the scene,
pub const SCENE: &str = "scene";
/// and what is set over the experiment, `NAME=VALUE`
pub const SET: &str = "set";
/// or this where it is as it is.
pub const NOTHING: &str = "nothing";

/// The values of a point, by the names of what is varied.
pub type Labels = Vec<(String, String)>;

/// A sweep: every experiment with every combination of the axes' choices, and some experiments beside them.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// The file's stem.
    pub name: String,
    /// The file's text.
    pub text: String,
    /// The experiments; the last of their sources is the sweep's text.
    pub experiments: Vec<Experiment>,
    /// Experiments that are measured once, without the axes; they come first.
    pub beside: Vec<Experiment>,
    /// Names of what is varied, in order.
    pub names: Vec<String>,
    /// Frames of every point.
    pub frames: Frames,
    /// Bounces of the references that points are scored against: all parts against the first, the total against all.
    pub bounces: Vec<u32>,
    pub(super) fixed: Vec<Setting>,
    pub(super) axes: Vec<Vec<Choice>>,
    /// Folder of the sweep's file: scene files are looked up in it.
    pub(super) folder: PathBuf,
}

impl Sweep {
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
        let bounces = vec![ALL_BOUNCES];
        let (beside, fixed, folder) = (Vec::new(), Vec::new(), PathBuf::from("."));
        Ok(Sweep { name, text, experiments, beside, names, frames, bounces, fixed, axes: list, folder })
    }

    /// A sweep without a file: in every scene an experiment as it is, then with each of some settings alone, name and RON.
    pub fn one_at_a_time(
        mut experiment: Experiment,
        scenes: &[String],
        settings: &[(String, String)],
        frames: Frames,
        bounces: u32,
    ) -> Sweep {
        let lines = || settings.iter().map(|(name, value)| format!("{name}={value}"));
        let text = lines().collect::<Vec<_>>().join("\n");
        experiment.sources.add("the settings in turn".as_ref(), text.clone());
        let mut offset = 0;
        let mut set = vec![Choice { labels: vec![(SET.into(), NOTHING.into())], settings: Vec::new() }];
        for ((name, value), line) in settings.iter().zip(lines()) {
            let name = Loc { value: name.clone(), at: At { file: 0, offset } };
            offset += u32::try_from(line.len() + 1).unwrap_or(0);
            let settings = vec![Setting { name, text: value.clone() }];
            set.push(Choice { labels: vec![(SET.into(), line)], settings });
        }
        let scene = |name: &String| Choice {
            labels: vec![(SCENE.into(), name.clone())],
            settings: vec![Setting {
                name: Loc { value: "scene".into(), at: At { file: 0, offset: 0 } },
                text: format!("{name:?}"),
            }],
        };
        Sweep {
            name: experiment.name.clone(),
            text,
            experiments: vec![experiment],
            beside: Vec::new(),
            names: vec![SCENE.into(), SET.into()],
            frames,
            bounces: vec![bounces],
            fixed: Vec::new(),
            axes: vec![scenes.iter().map(scene).collect(), set],
            folder: PathBuf::from("."),
        }
    }

    /// How many points there are.
    pub fn len(&self) -> usize {
        self.beside.len() + self.axes.iter().map(Vec::len).product::<usize>() * self.experiments.len()
    }

    /// Whether there is nothing to measure.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One point: its experiment, and its values by the names of what is varied. The last axis varies fastest.
    ///
    /// # Errors
    /// Settings that are none, with their places.
    pub fn point(&self, index: usize) -> Result<(Experiment, Labels), Vec<Diagnostic>> {
        let (mut experiment, chosen) = match index.checked_sub(self.beside.len()) {
            None => (self.beside[index].clone(), Vec::new()),
            Some(mut rest) => {
                let mut chosen = Vec::new();
                for axis in self.axes.iter().rev() {
                    chosen.push(&axis[rest % axis.len()]);
                    rest /= axis.len();
                }
                chosen.reverse();
                (self.experiments[rest % self.experiments.len()].clone(), chosen)
            }
        };
        let mut labels = Vec::new();
        if self.experiments.len() + self.beside.len() > 1 {
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
