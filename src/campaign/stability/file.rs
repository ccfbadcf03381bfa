//! Suite files: methods, and what moves (docs/stability.md).

use super::chart_spec::{ChartFile, CostChart};
use super::motion::Motion;
use crate::camera_path::CameraPath;
use crate::campaign::sweep::Setting;
use crate::experiment::Experiment;
use crate::graph::file::RawText;
use crate::graph::param::Params;
use crate::graph::source::{Diagnostic, Entries, Loc, Severity, Sources};
use crate::lab::Workspace;
use serde::Deserialize;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Most frames of a case, and most before them.
pub(super) const MAX_FRAMES: usize = 10_000;
/// Most methods times cases.
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
    chart: Option<Loc<ChartFile>>,
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

/// A method: what it sets over the suite's experiment.
#[derive(Clone, Debug)]
pub struct Method {
    /// Name of the method.
    pub name: String,
    /// Settings of the method.
    pub set: Vec<Setting>,
}

/// Something that methods are looked at in.
#[derive(Clone, Debug)]
pub struct Case {
    /// Name of the case.
    pub name: String,
    /// Name of the variant, if the case has some.
    pub variant: String,
    /// For people.
    pub about: String,
    /// What it sets over the method.
    pub set: Vec<Setting>,
    /// What moves.
    pub motion: Motion,
    /// Frames that run, moving, before the first measured one.
    pub warmup: usize,
    /// Frames measured, when nothing else is asked for.
    pub frames: usize,
    /// Whether more or fewer frames may be asked for: a case with its own number knows what it needs.
    pub own_frames: bool,
    /// Names of the methods that it is for; all when empty.
    pub methods: Vec<String>,
    /// Whether its voxels are compared with exact ones.
    pub voxels: bool,
}

/// A suite.
#[derive(Clone, Debug)]
pub struct Suite {
    /// The file's stem.
    pub name: String,
    /// The file's text.
    pub text: String,
    /// What methods and cases change; the last of its sources is the suite's text.
    pub experiment: Experiment,
    /// Samples a pixel of the references.
    pub samples: u64,
    /// Their bounces.
    pub bounces: u32,
    /// Their seed, one for all frames.
    pub seed: u32,
    /// What everything sets.
    pub set: Vec<Setting>,
    /// The methods, in order.
    pub methods: Vec<Method>,
    /// The cases, in order.
    pub cases: Vec<Case>,
    /// The part of the light whose worst frames are kept as pictures.
    pub pictures: String,
    /// The chart of costs, besides the cases.
    pub chart: Option<CostChart>,
    /// Folder of the file.
    pub folder: PathBuf,
}

fn total() -> String {
    "total".into()
}

fn settings(list: &Entries<RawText>) -> Vec<Setting> {
    list.0.iter().map(|(name, value)| Setting::new(name.clone(), value)).collect()
}

impl Suite {
    /// Leaves out all methods but these and the first.
    ///
    /// # Errors
    /// A name that is none of the suite's methods; the text for the user.
    pub fn keep(&mut self, names: &[String]) -> Result<(), String> {
        let known: Vec<&str> = self.methods.iter().map(|m| m.name.as_str()).collect();
        if let Some(name) = names.iter().find(|n| !known.contains(&n.as_str())) {
            return Err(format!("--methods {name}: the suite's methods are {}", known.join(", ")));
        }
        let first = self.methods.first().map(|m| m.name.clone());
        let stays = |name: &String| names.contains(name) || first.as_ref() == Some(name);
        self.methods.retain(|m| stays(&m.name));
        self.cases.retain(|c| c.methods.is_empty() || c.methods.iter().any(stays));
        for case in &mut self.cases {
            case.methods.retain(stays);
        }
        if let Some(chart) = &mut self.chart {
            chart.groups.iter_mut().for_each(|g| g.1.retain(stays));
            chart.groups.retain(|g| !g.1.is_empty());
            chart.equal_time.iter_mut().for_each(|e| e.methods.retain(stays));
        }
        Ok(())
    }

    /// Reads a suite and its experiment.
    ///
    /// # Errors
    /// All mistakes of the file and of the experiment.
    pub fn read(path: &Path) -> Result<Suite, Vec<Diagnostic>> {
        let mut sources = Sources::default();
        let file = sources.read(path).map_err(|e| {
            vec![e.help(Some("give the path of a suite, for example configs/stability/motion.ron".into()))]
        })?;
        let mut errors = Vec::new();
        let parsed = sources.parse::<SuiteFile>(file, &mut errors, &mut Vec::new());
        let Some(parsed) = parsed.filter(|_| !errors.iter().any(|e| e.severity == Severity::Error)) else {
            return Err(errors);
        };
        let text = sources.texts().next().map_or(String::new(), |t| t.1.to_string());
        let folder = path.parent().unwrap_or(Path::new(".")).to_path_buf();
        let mut number = |value: &Option<Loc<usize>>, default: usize, least: usize| match value {
            Some(v) if v.value < least || v.value > MAX_FRAMES => {
                errors.push(sources.error(v.at, format!("frames must be {least} to {MAX_FRAMES}")));
                default
            }
            Some(v) => v.value,
            None => default,
        };
        let warmup = number(&parsed.warmup, 8, 0);
        let frames = number(&parsed.frames, 24, 1);
        let methods: Vec<Method> = parsed.methods.0.iter().map(method).collect();
        let mut cases = Vec::new();
        for (name, case) in &parsed.cases.0 {
            let c = &case.value;
            let own = Case {
                name: name.value.clone(),
                variant: String::new(),
                about: c.about.clone(),
                set: settings(&c.set),
                motion: c.motion.clone(),
                warmup: number(&c.warmup, warmup, 0),
                frames: number(&c.frames, frames, 1),
                own_frames: c.frames.is_some(),
                methods: c.methods.clone(),
                voxels: c.voxels,
            };
            let variant = |(label, set): &(Loc<String>, Loc<Entries<RawText>>)| {
                let set = own.set.iter().cloned().chain(settings(&set.value)).collect();
                Case { variant: label.value.clone(), set, ..own.clone() }
            };
            match c.variants.0.is_empty() {
                true => cases.push(own),
                false => cases.extend(c.variants.0.iter().map(variant)),
            }
        }
        for (name, case) in &parsed.cases.0 {
            if let Some(m) = case.value.methods.iter().find(|m| !methods.iter().any(|k| k.name == **m)) {
                let message = format!("case '{}' names the method '{m}', which is none of the suite's", name.value);
                errors.push(sources.error(case.at, message));
            }
        }
        if let Some(s) = parsed.samples.as_ref().filter(|s| s.value == 0 || s.value > 1 << 20) {
            errors.push(sources.error(s.at, "samples must be 1 to 1048576"));
        }
        if let Some(b) = parsed.bounces.as_ref().filter(|b| b.value == 0 || b.value > 64) {
            errors.push(sources.error(b.at, "bounces must be 1 to 64"));
        }
        if methods.is_empty() || cases.is_empty() || methods.len() * cases.len() > MAX_JOBS {
            let message = format!("a suite has at least one method and one case, and at most {MAX_JOBS} pairs of them");
            errors.push(sources.error(parsed.experiment.at, message));
        }
        let chart = parsed
            .chart
            .as_ref()
            .and_then(|c| c.value.spec(&methods, &cases).map_err(|why| errors.push(sources.error(c.at, why))).ok());
        let experiment = match Experiment::read(&folder.join(&parsed.experiment.value)) {
            Ok(experiment) => Some(experiment),
            Err(found) if found.iter().all(|d| d.place.line == 0) => {
                errors.extend(found.iter().map(|d| {
                    sources
                        .error(parsed.experiment.at, format!("{}: {}", d.place.file.display(), d.message))
                        .help(d.help.clone())
                }));
                None
            }
            Err(found) => {
                errors.extend(found);
                None
            }
        };
        let Some(mut experiment) = experiment.filter(|_| errors.is_empty()) else { return Err(errors) };
        experiment.sources.add(path, text.clone());
        Ok(Suite {
            name: path.file_stem().map_or(String::new(), |s| s.to_string_lossy().into_owned()),
            text,
            experiment,
            samples: parsed.samples.map_or(64, |s| s.value),
            bounces: parsed.bounces.map_or(1, |b| b.value),
            seed: parsed.seed.unwrap_or(1),
            set: settings(&parsed.set),
            methods,
            cases,
            pictures: parsed.pictures,
            chart,
            folder,
        })
    }

    /// The experiment of a method in a case: the suite's settings, the method's, the case's. Parameters of the suite and of
    /// cases are for the methods whose graphs have them; `known` says which a graph has.
    ///
    /// # Errors
    /// Settings that are none, with their places.
    pub fn experiment(
        &self,
        method: &Method,
        case: &Case,
        known: &mut dyn FnMut(&str) -> Option<Params>,
    ) -> Result<Experiment, Vec<Diagnostic>> {
        let mut experiment = self.experiment.clone();
        experiment.name = method.name.clone();
        let file = u32::try_from(experiment.sources.paths().count().saturating_sub(1)).unwrap_or(0);
        let all = || self.set.iter().chain(&method.set).chain(&case.set);
        let mut errors = Vec::new();
        let mut apply = |setting: &Setting, experiment: &mut Experiment| {
            if let Err(message) = setting.apply(experiment, file, &self.folder) {
                let at = crate::graph::source::At { file, offset: setting.name.at.offset };
                errors.push(experiment.sources.error(at, message));
            }
        };
        // The graph first: it says which parameters there are.
        let own_graph = all().rfind(|s| s.name.value == "graph");
        own_graph.into_iter().for_each(|s| apply(s, &mut experiment));
        let other = experiment.graph != self.experiment.graph;
        let params = if other { known(&experiment.graph) } else { None };
        let has = |name: &str| params.as_ref().is_none_or(|p| p.index(name).is_some());
        if other {
            experiment.params.retain(|(name, _)| has(&name.value));
        }
        for setting in self.set.iter().chain(&method.set).chain(&case.set).filter(|s| s.name.value != "graph") {
            let field =
                ["scene", "camera", "size", "time", "sky", "environment"].contains(&setting.name.value.as_str());
            let own = method.set.iter().any(|s| std::ptr::eq(s, setting));
            if field || own || has(&setting.name.value) {
                apply(setting, &mut experiment);
            }
        }
        if errors.is_empty() { Ok(experiment) } else { Err(errors) }
    }
}

fn method((name, set): &(Loc<String>, Loc<Entries<RawText>>)) -> Method {
    Method { name: name.value.clone(), set: settings(&set.value) }
}

/// Checks a suite without opening its scenes: experiment, graphs, and the parameters of every method in every case.
///
/// # Errors
/// All mistakes, each once.
pub fn check(home: &Workspace, path: &Path) -> Result<(), Vec<Diagnostic>> {
    let suite = Suite::read(path)?;
    let mut graphs: HashMap<String, Result<Params, Vec<Diagnostic>>> = HashMap::new();
    let mut errors: Vec<Diagnostic> = Vec::new();
    let chart = suite.chart.as_ref();
    let methods: Vec<Method> =
        suite.methods.iter().flat_map(|m| chart.map_or_else(|| vec![m.clone()], |c| c.variants(m))).collect();
    // Variants of a method for a chart's equal time bear its name and more.
    let runs = |method: &Method, case: &Case| {
        case.methods.is_empty() || case.methods.iter().any(|m| method.name.starts_with(m))
    };
    let pairs = methods.iter().flat_map(|m| suite.cases.iter().map(move |c| (m, c)));
    for (method, case) in pairs.filter(|(m, c)| runs(m, c)) {
        let mut params = |name: &str| {
            let found = graphs.entry(name.into()).or_insert_with(|| home.graph(name).map(|g| g.0.params));
            found.clone()
        };
        let found = suite.experiment(method, case, &mut |name| params(name).ok()).and_then(|experiment| {
            let defaults = params(&experiment.graph)?;
            match experiment.params_over(&defaults) {
                Err(crate::lab::LabError::Input(list)) => Err(list),
                _ => Ok(()),
            }
        });
        for diagnostic in found.err().unwrap_or_default() {
            if !errors.contains(&diagnostic) {
                errors.push(diagnostic);
            }
        }
    }
    for case in &suite.cases {
        if let Motion::Path { file, .. } = &case.motion {
            let found = CameraPath::read(&suite.folder.join(file)).err().unwrap_or_default();
            errors.extend(found.into_iter().filter(|d| !errors.contains(d)).collect::<Vec<_>>());
        }
    }
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}
