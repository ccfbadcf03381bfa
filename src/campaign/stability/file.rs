//! Suite files: methods and motions (docs/stability.md).

use super::case::{Case, Method};
use super::chart_spec::CostChart;
use super::motion::Motion;
use crate::camera_path::CameraPath;
use crate::campaign::runner::Mistakes;
use crate::campaign::settings::{Setting, apply, settings};
use crate::campaign::source::Source;
use crate::diagnostics::{Diagnostic, Entries, Loc, RawText};
use crate::experiment::{Experiment, Field};
use crate::graph::param::Params;
use crate::lab::{LabError, Workspace};
use crate::measure::Warm;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// Largest number of frames of a case, and of its warm-up.
const MAX_FRAMES: usize = 10_000;
/// Largest number of methods times cases.
const MAX_JOBS: usize = 2000;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct SuiteFile {
    experiment: Loc<String>,
    #[serde(default)]
    warmup: Option<Loc<usize>>,
    #[serde(default)]
    frames: Option<Loc<usize>>,
    #[serde(default)]
    samples: Option<Loc<u64>>,
    #[serde(default)]
    bounces: Option<Loc<u32>>,
    #[serde(default)]
    seed: Option<u32>,
    #[serde(default)]
    set: Entries<RawText>,
    #[serde(default)]
    chart: Option<Loc<CostChart>>,
    #[serde(default = "total")]
    pictures: String,
    methods: Entries<Entries<RawText>>,
    cases: Entries<CaseFile>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct CaseFile {
    #[serde(default)]
    about: String,
    #[serde(default)]
    set: Entries<RawText>,
    #[serde(default)]
    motion: Motion,
    #[serde(default)]
    warmup: Option<Loc<usize>>,
    #[serde(default)]
    frames: Option<Loc<usize>>,
    #[serde(default)]
    methods: Vec<String>,
    #[serde(default)]
    voxels: bool,
    #[serde(default)]
    variants: Entries<Entries<RawText>>,
}

/// A suite of methods and cases.
#[derive(Clone, Debug)]
pub struct Suite {
    /// The file's stem.
    pub name: String,
    /// The file's text.
    pub text: String,
    /// The experiment before any change. The last of its sources is the suite's text.
    pub experiment: Experiment,
    /// Samples per pixel of the references.
    pub samples: u64,
    pub(crate) bounces: u32,
    /// Seed of the references, one for all frames.
    pub seed: u32,
    pub(crate) set: Vec<Setting>,
    /// The methods, in order.
    pub methods: Vec<Method>,
    /// The cases, in order.
    pub cases: Vec<Case>,
    /// Part of the light in the pictures of worst frames.
    pub pictures: String,
    /// Chart of the costs.
    pub chart: Option<CostChart>,
    pub(crate) folder: PathBuf,
}

fn total() -> String {
    "total".into()
}

impl Suite {
    /// Removes all methods except these and the first.
    pub fn keep(&mut self, names: &[String]) -> Result<(), String> {
        let known: Vec<&str> = self.methods.iter().map(|m| m.name.as_str()).collect();
        if let Some(name) = names.iter().find(|n| !known.contains(&n.as_str())) {
            return Err(format!(
                "--methods {name}: the suite's methods are {}",
                known.join(", ")
            ));
        }
        let first = self.methods.first().map(|m| m.name.clone());
        let stays = |name: &String| names.contains(name) || first.as_ref() == Some(name);
        self.methods.retain(|m| stays(&m.name));
        self.cases
            .retain(|c| c.methods.is_empty() || c.methods.iter().any(stays));
        for case in &mut self.cases {
            case.methods.retain(stays);
        }
        self.chart.iter_mut().for_each(|chart| chart.keep(&stays));
        Ok(())
    }

    /// Reads a suite and its experiment.
    pub fn read(path: &Path) -> Result<Suite, Vec<Diagnostic>> {
        let (file, mut source) = Source::read::<SuiteFile>(
            path,
            "give the path of a suite, for example configs/stability/motion.ron",
        )?;
        let warmup = source.number("frames", &file.warmup, 8, (0, MAX_FRAMES));
        let frames = source.number("frames", &file.frames, 24, (1, MAX_FRAMES));
        let method = |(name, set): &(Loc<String>, Loc<Entries<RawText>>)| Method {
            name: name.value.clone(),
            set: settings(&set.value),
        };
        let methods: Vec<Method> = file.methods.0.iter().map(method).collect();
        let cases = cases(&file.cases.0, &methods, (warmup, frames), &mut source);
        let samples = source.number("samples", &file.samples, 64, (1, 1 << 20));
        let bounces = source.number("bounces", &file.bounces, 1, (1, 64));
        if methods.is_empty() || cases.is_empty() || methods.len() * cases.len() > MAX_JOBS {
            let message = format!(
                "a suite has at least one method and one case, and at most {MAX_JOBS} pairs of them"
            );
            source.wrong(file.experiment.at, message);
        }
        let chart = file.chart.and_then(|c| {
            c.value
                .checked(&methods, &cases)
                .map_err(|why| source.wrong(c.at, why))
                .ok()
        });
        let experiment = source.experiment(&file.experiment);
        let Some(experiment) = experiment.filter(|_| source.errors.is_empty()) else {
            return Err(source.errors);
        };
        Ok(Suite {
            name: source.name(),
            text: source.text(),
            experiment,
            samples,
            bounces,
            seed: file.seed.unwrap_or(1),
            set: settings(&file.set),
            methods,
            cases,
            pictures: file.pictures,
            chart,
            folder: source.folder(),
        })
    }

    /// The experiment of a method in a case, with the settings of suite, method and case.
    /// Parameters of the suite and of cases apply only to graphs that have them; `known` returns
    /// the parameters of a graph.
    pub fn experiment(
        &self,
        method: &Method,
        case: &Case,
        known: &mut dyn FnMut(&str) -> Option<Params>,
    ) -> Result<Experiment, Vec<Diagnostic>> {
        let mut experiment = self.experiment.clone();
        experiment.name = method.name.clone();
        let all = || self.set.iter().chain(&method.set).chain(&case.set);
        // The graph decides which parameters exist, so it comes first.
        let own_graph = all().rfind(|s| s.name.value == "graph");
        let mut errors = apply(&mut experiment, own_graph, &self.folder);
        let other = experiment.graph != self.experiment.graph;
        let params = if other {
            known(&experiment.graph)
        } else {
            None
        };
        let has = |name: &str| params.as_ref().is_none_or(|p| p.index(name).is_some());
        if other {
            experiment.params.retain(|(name, _)| has(&name.value));
        }
        let own = |s: &Setting| method.set.iter().any(|m| std::ptr::eq(m, s));
        let fits =
            |s: &&Setting| Field::of(&s.name.value).is_some() || own(s) || has(&s.name.value);
        let others = all().filter(|s| s.name.value != "graph").filter(fits);
        errors.extend(apply(&mut experiment, others, &self.folder));
        if errors.is_empty() {
            Ok(experiment)
        } else {
            Err(errors)
        }
    }
}

/// The cases with their variants. `warmup` and `frames` are those of the suite.
fn cases(
    list: &[(Loc<String>, Loc<CaseFile>)],
    methods: &[Method],
    (warmup, frames): (usize, usize),
    source: &mut Source,
) -> Vec<Case> {
    let mut cases = Vec::new();
    for (name, case) in list {
        let c = &case.value;
        let own = Case {
            name: name.value.clone(),
            variant: String::new(),
            about: c.about.clone(),
            set: settings(&c.set),
            motion: c.motion.clone(),
            warmup: source.number("frames", &c.warmup, warmup, (0, MAX_FRAMES)),
            frames: source.number("frames", &c.frames, frames, (1, MAX_FRAMES)),
            own_frames: c.frames.is_some(),
            methods: c.methods.clone(),
            voxels: c.voxels,
        };
        let unknown = |m: &&String| !methods.iter().any(|k| k.name == **m);
        if let Some(m) = c.methods.iter().find(unknown) {
            let message = format!(
                "case '{}' names the method '{m}', which is none of the suite's",
                name.value
            );
            source.wrong(case.at, message);
        }
        let variant = |(label, set): &(Loc<String>, Loc<Entries<RawText>>)| {
            let set = own.set.iter().cloned().chain(settings(&set.value));
            Case {
                variant: label.value.clone(),
                set: set.collect(),
                ..own.clone()
            }
        };
        match c.variants.0.is_empty() {
            true => cases.push(own),
            false => cases.extend(c.variants.0.iter().map(variant)),
        }
    }
    cases
}

/// Checks a suite without opening its scenes: experiment, graphs, and the parameters of every
/// method in every case.
pub fn check(home: &Workspace, path: &Path) -> Result<(), LabError> {
    let suite = Suite::read(path).map_err(LabError::Input)?;
    let mut warm = Warm::default();
    let mut mistakes = Mistakes::default();
    let chart = suite.chart.as_ref();
    let variants = |m: &Method| chart.map_or_else(|| vec![m.clone()], |c| c.variants(m));
    let methods: Vec<Method> = suite.methods.iter().flat_map(variants).collect();
    for (method, case) in methods
        .iter()
        .flat_map(|m| suite.cases.iter().map(move |c| (m, c)))
    {
        if case.is_for(&method.name) {
            let mut params =
                |name: &str| warm.graph(home, name).ok().map(|l| l.graph.params.clone());
            let experiment = suite
                .experiment(method, case, &mut params)
                .map_err(LabError::Input);
            mistakes.take(experiment.and_then(|experiment| warm.check(home, &experiment)))?;
        }
    }
    for case in &suite.cases {
        if let Motion::Path { file, .. } = &case.motion {
            mistakes.take(CameraPath::read(&suite.folder.join(file)).map_err(LabError::Input))?;
        }
    }
    mistakes.none()
}
