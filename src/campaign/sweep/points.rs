//! A sweep as a list of points.

use super::axis::{Choice, MAX_POINTS};
use crate::campaign::points::Labels;
use crate::campaign::settings::{Axis, Setting, apply, lines};
use crate::diagnostics::Diagnostic;
use crate::experiment::Experiment;
use crate::lab::LabError;
use crate::measure::Frames;
use crate::measure::reference::ALL_BOUNCES;
use std::path::PathBuf;

/// Name of the varied scene in [`Sweep::one_at_a_time`].
pub const SCENE: &str = "scene";
/// Name of the varied setting, `NAME=VALUE`.
pub const SET: &str = "set";
/// Value of [`SET`] for the unchanged experiment.
pub const NOTHING: &str = "nothing";

/// A sweep: every experiment with every combination of the axes' choices, and single experiments.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// The file's stem.
    pub name: String,
    /// The file's text.
    pub text: String,
    /// The experiments. The last of their sources is the sweep's text.
    pub experiments: Vec<Experiment>,
    /// Experiments that are measured once without the axes. They come first.
    pub beside: Vec<Experiment>,
    /// Names of the varied settings, in order.
    pub names: Vec<String>,
    /// Frames of every point.
    pub frames: Frames,
    /// Bounces of the references. All parts are scored against the first, the total against all.
    pub bounces: Vec<u32>,
    pub(super) fixed: Vec<Setting>,
    pub(super) axes: Vec<Vec<Choice>>,
    /// Folder of the sweep's file, for relative paths.
    pub(super) folder: PathBuf,
}

impl Sweep {
    /// A sweep without a file: every experiment with every combination of settings. `source` stands for a file in
    /// messages about the axes.
    pub fn of(
        mut experiments: Vec<Experiment>,
        axes: &[Axis],
        frames: Frames,
        source: &str,
    ) -> Result<Sweep, LabError> {
        if let Some((name, _)) = axes.iter().find(|a| a.1.is_empty()) {
            return Err(LabError::Request(format!("'{name}' has no values")));
        }
        // Places of messages are the lines of the settings.
        let joined: Vec<String> = axes.iter().map(|(_, values)| values.join(",")).collect();
        let (text, settings) = lines(
            axes.iter()
                .zip(&joined)
                .map(|(a, list)| (a.0.as_str(), list.as_str())),
            "=",
        );
        for experiment in &mut experiments {
            experiment.sources.add(source.as_ref(), text.clone());
        }
        let choice = |s: &Setting, value: &String| {
            Choice::of(vec![Setting {
                text: value.clone(),
                ..s.clone()
            }])
        };
        let axis = |(s, a): (&Setting, &Axis)| a.1.iter().map(|v| choice(s, v)).collect();
        let list: Vec<Vec<Choice>> = settings.iter().zip(axes).map(axis).collect();
        let points = list
            .iter()
            .fold(experiments.len(), |n, l| n.saturating_mul(l.len()));
        if points > MAX_POINTS {
            return Err(LabError::Request(format!(
                "{points} combinations are more than the {MAX_POINTS} allowed"
            )));
        }
        let names = axes.iter().map(|a| a.0.clone());
        let names = (experiments.len() > 1)
            .then(|| "experiment".to_string())
            .into_iter()
            .chain(names)
            .collect();
        let name = experiments
            .first()
            .map_or(String::new(), |e| e.name.clone());
        let bounces = vec![ALL_BOUNCES];
        let (beside, fixed, folder) = (Vec::new(), Vec::new(), PathBuf::from("."));
        Ok(Sweep {
            name,
            text,
            experiments,
            beside,
            names,
            frames,
            bounces,
            fixed,
            axes: list,
            folder,
        })
    }

    /// A sweep without a file: an experiment in every scene, unchanged and with each setting alone.
    pub fn one_at_a_time(
        mut experiment: Experiment,
        scenes: &[String],
        settings: &[(String, String)],
        frames: Frames,
        bounces: u32,
    ) -> Sweep {
        let (text, settings) = lines(
            settings
                .iter()
                .map(|(name, value)| (name.as_str(), value.as_str())),
            "=",
        );
        experiment
            .sources
            .add("the varied settings".as_ref(), text.clone());
        let choice = |name: &str, label: String, settings| Choice {
            labels: vec![(name.into(), label)],
            settings,
        };
        let mut set = vec![choice(SET, NOTHING.into(), Vec::new())];
        set.extend(
            settings
                .into_iter()
                .map(|s| choice(SET, format!("{}={}", s.name.value, s.text), vec![s])),
        );
        let scene = |name: &String| {
            choice(
                SCENE,
                name.clone(),
                lines([(SCENE, format!("{name:?}").as_str())], "=").1,
            )
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

    /// Number of points.
    pub fn len(&self) -> usize {
        self.beside.len()
            + self.axes.iter().map(Vec::len).product::<usize>() * self.experiments.len()
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One point: its experiment and the values of its varied settings. The last axis varies
    /// fastest.
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
                (
                    self.experiments[rest % self.experiments.len()].clone(),
                    chosen,
                )
            }
        };
        let mut labels = Vec::new();
        if self.experiments.len() + self.beside.len() > 1 {
            labels.push(("experiment".to_string(), experiment.name.clone()));
        }
        labels.extend(chosen.iter().flat_map(|c| c.labels.clone()));
        let settings = self
            .fixed
            .iter()
            .chain(chosen.iter().flat_map(|c| &c.settings));
        let errors = apply(&mut experiment, settings, &self.folder);
        if errors.is_empty() {
            Ok((experiment, labels))
        } else {
            Err(errors)
        }
    }
}
