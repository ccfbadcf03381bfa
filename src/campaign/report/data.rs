//! Data of the page and its charts, from the records of sweeps.

use crate::campaign::charts::file_name;
use crate::campaign::points::{labelled, total_first};
use crate::campaign::record::Outcome;
use crate::campaign::sweep::{Collected, PointRecord, Subject, parts_of};
use crate::measure::Point;
use crate::metrics::{Metric, Noise, RELMSE, within_noise};
use indexmap::IndexMap;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// Largest size of the pictures in a page, bytes.
const MAX_PICTURES: usize = 64 << 20;

#[derive(Clone, Debug, Default, Serialize)]
pub struct Dot {
    pub id: String,
    pub labels: IndexMap<String, String>,
    /// Whether all parameters are the graph's defaults.
    #[serde(skip)]
    pub preset: bool,
    /// Index of the subject in [`Data`].
    pub subject: usize,
    /// GPU time of a frame, median and 95th percentile, ms.
    pub ms: f64,
    pub p95: f64,
    /// Device memory of the graph.
    pub bytes: u64,
    /// Median of each stage, ms, in the order of the graph.
    pub stages: Vec<(String, f64)>,
    /// Scores by part and metric.
    pub scores: BTreeMap<String, BTreeMap<String, f64>>,
    /// Noise of the reference by part.
    #[serde(skip)]
    pub noise: BTreeMap<String, Noise>,
    pub warnings: Vec<String>,
    /// Its graph's name.
    pub graph: String,
    /// The experiment, to be saved and run.
    pub experiment: String,
    /// JPEG.
    #[serde(skip)]
    pub picture: Option<Vec<u8>>,
    #[serde(skip)]
    pub error_map: Option<Vec<u8>>,
}

/// A point that could not be measured.
pub struct Failed {
    pub labels: IndexMap<String, String>,
    pub key: (Subject, String),
    pub error: String,
}

/// A chart of the page; its points are drawn in this order.
pub struct Chart {
    /// File name without its ending.
    pub name: String,
    pub subject: usize,
    pub part: String,
    pub metric: &'static Metric,
    pub points: Vec<usize>,
    /// Number of the points' colours, by point, and the colours.
    pub groups: Vec<usize>,
    pub colors: Vec<String>,
    /// Places of the points with a bar, in the order of the bars.
    pub bars: Vec<usize>,
    pub svg: String,
}

/// A dot of a chart.
pub struct Scored {
    /// Index of the dot.
    pub index: usize,
    pub ms: f64,
    /// Error, 0 for a perfect picture.
    pub error: f64,
    /// Whether its relMSE is within the noise of the reference.
    pub noisy: bool,
    /// Error that the noise of the reference alone causes.
    pub noise: Option<f64>,
    /// Experiment or graph of the dot, empty if there is only one.
    pub experiment: String,
    /// Whether all parameters are the graph's defaults.
    pub preset: bool,
}

/// A dot for tests of what is made of dots.
#[cfg(test)]
pub fn dot(ms: f64, error: f64, experiment: &str) -> Scored {
    Scored {
        index: 0,
        ms,
        error,
        noisy: false,
        noise: None,
        experiment: experiment.into(),
        preset: false,
    }
}

/// Everything that is shown.
#[derive(Default)]
pub struct Data {
    pub sweeps: Vec<String>,
    pub names: Vec<String>,
    pub dots: Vec<Dot>,
    /// Scene, size and device. Only points of one subject are comparable.
    pub subjects: Vec<String>,
    /// Subject and device of each chart group.
    pub keys: Vec<(Subject, String)>,
    /// Bounces of the reference for all parts, by subject.
    pub bounces: Vec<Option<u32>>,
    /// Bounces and samples per pixel of the references, by subject.
    pub samples: Vec<Vec<(u32, u64)>>,
    /// Settings of the measurement in one line, by subject.
    pub settings: Vec<String>,
    pub parts: Vec<String>,
    /// Displayed references by subject, JPEG.
    pub references: Vec<Option<Vec<u8>>>,
    pub failed: Vec<Failed>,
    /// Points without a result.
    pub left: usize,
}

impl Dot {
    /// The dot of a record, without labels, subject and pictures.
    fn new(record: &PointRecord, point: &Point) -> Dot {
        let mut stages: IndexMap<String, f64> = IndexMap::new();
        for pass in &point.stats.passes {
            *stages.entry(pass.stage.clone()).or_default() += pass.gpu_ms.median;
        }
        Dot {
            id: record.id.clone(),
            ms: point.stats.total_gpu_ms.median,
            p95: point.stats.total_gpu_ms.p95,
            bytes: point.stats.total_bytes,
            stages: stages.into_iter().collect(),
            scores: parts_of(point),
            noise: point
                .scores
                .keys()
                .map(|part| (part.clone(), point.noise_of(part)))
                .collect(),
            warnings: point.stats.warnings.clone(),
            graph: point.stats.graph.clone(),
            experiment: record.about.experiment.clone(),
            ..Dot::default()
        }
    }

    /// Title of a dot, from some of its values.
    pub fn title(&self, names: &[&String]) -> String {
        let text = labelled(
            names
                .iter()
                .filter_map(|n| Some((*n, self.labels.get(*n)?))),
        );
        if text.is_empty() {
            self.id.chars().take(8).collect()
        } else {
            text
        }
    }
}

/// Experiment of a dot, empty if there is only one.
fn experiment_of(dot: &Dot) -> &str {
    dot.labels.get("experiment").map_or("", String::as_str)
}

impl Data {
    pub fn new(collected: &Collected) -> Data {
        let (sweeps, names) = (collected.sweeps.clone(), collected.names.clone());
        let mut data = Data {
            sweeps,
            names,
            ..Data::default()
        };
        let mut keys = Vec::new();
        let mut room = MAX_PICTURES;
        for (planned, record) in &collected.points {
            let Some(record) = record else {
                data.left += 1;
                continue;
            };
            let point = match &record.outcome {
                Outcome::Done(point) => point,
                Outcome::Failed(error) => {
                    let key = (record.about.subject.clone(), record.device.name.clone());
                    data.failed.push(Failed {
                        labels: planned.labels.clone(),
                        key,
                        error: error.clone(),
                    });
                    continue;
                }
            };
            let key = (&record.about.subject, &record.device.name);
            let subject = keys.iter().position(|k| *k == key).unwrap_or_else(|| {
                let (s, device) = key;
                let like = |k: &&(&Subject, &String)| {
                    k.0.scene == s.scene && k.0.size == s.size && k.1 == device
                };
                let number = keys.iter().filter(like).count() + 1;
                keys.push(key);
                data.add_subject(collected, (record, point), number, &mut room);
                keys.len() - 1
            });
            let mut picture = |kind| {
                let bytes = collected
                    .picture(kind, &record.id)
                    .filter(|b| b.len() <= room)?;
                room -= bytes.len();
                Some(bytes)
            };
            data.dots.push(Dot {
                labels: planned.labels.clone(),
                preset: planned.preset,
                subject,
                picture: picture("pictures"),
                error_map: picture("errors"),
                ..Dot::new(record, point)
            });
        }
        data.parts = total_first(data.dots.iter().flat_map(|d| d.scores.keys()));
        data.keys = keys
            .into_iter()
            .map(|(subject, device)| (subject.clone(), device.clone()))
            .collect();
        data
    }

    /// Adds the subject of a point. `number` counts those of one scene, size and device; `room` is
    /// what pictures may still take, bytes.
    fn add_subject(
        &mut self,
        collected: &Collected,
        (record, point): (&PointRecord, &Point),
        number: usize,
        room: &mut usize,
    ) {
        let (s, device) = (&record.about.subject, &record.device);
        let number = match number {
            1 => String::new(),
            number => format!(" ({number})"),
        };
        let (width, height) = s.size;
        self.subjects.push(format!(
            "{}{number} at {width}x{height}, {}",
            s.scene, device.name
        ));
        let text = |(bounces, n): (&u32, &u64)| format!("{n} samples a pixel of {bounces} bounces");
        let references: Vec<String> = point.references.iter().map(text).collect();
        let samples = match references.is_empty() {
            true => String::from("no reference"),
            false => format!("reference: {}", references.join("; ")),
        };
        self.samples
            .push(point.references.iter().map(|(b, n)| (*b, *n)).collect());
        let beside = |b: &&u32| point.scores.contains_key(&format!("total, {b} bounces"));
        let reference = collected.reference(record).filter(|b| b.len() <= *room);
        *room -= reference.as_ref().map_or(0, Vec::len);
        self.references.push(reference);
        self.bounces
            .push(point.references.keys().find(|b| !beside(b)).copied());
        let frames = point.stats.passes.first().map_or(0, |p| p.frames);
        let alike = collected.points.iter().filter_map(|(_, r)| r.as_ref());
        let alike = alike.filter(|r| r.about.subject == *s && r.device.name == device.name);
        let warmups = alike.filter_map(|r| Some(r.done()?.stats.warmup));
        let (least, most) = warmups.fold((usize::MAX, 0), |(a, b), n| (a.min(n), b.max(n)));
        let warmup = match least < most {
            true => format!("{least} to {most}"),
            false => most.to_string(),
        };
        self.settings.push(format!(
            "camera {}, time {} s; {}, Vulkan {}; conelab {}; {frames} frames after {warmup} of warm-up; every pass in every frame; {samples}",
            s.camera, s.time, device.driver, device.api, point.stats.version
        ));
    }

    /// The points of a subject that have a score, in order.
    pub fn scored(&self, subject: usize, part: &str, metric: &Metric) -> Vec<Scored> {
        let several = self.experiments_of_several_graphs();
        let dots = self
            .dots
            .iter()
            .enumerate()
            .filter(|d| d.1.subject == subject);
        dots.filter_map(|(index, dot)| {
            let scores = dot.scores.get(part)?;
            let error = metric.distance(*scores.get(metric.key)?);
            let noisy = within_noise(
                *scores.get(RELMSE).unwrap_or(&f64::INFINITY),
                dot.noise.get(part).map(|n| n.relmse),
            );
            let experiment = if several.contains(experiment_of(dot)) {
                &dot.graph
            } else {
                experiment_of(dot)
            };
            let experiment = experiment.to_string();
            (error.is_finite() && dot.ms > 0.0).then_some(Scored {
                index,
                ms: dot.ms,
                error,
                noisy,
                noise: dot.noise.get(part).and_then(|n| n.in_mean(metric)),
                experiment,
                preset: dot.preset,
            })
        })
        .collect()
    }

    /// Experiments with points of several graphs, which charts colour by graph.
    fn experiments_of_several_graphs(&self) -> BTreeSet<&str> {
        let mut graphs: BTreeMap<&str, &str> = BTreeMap::new();
        let of = self
            .dots
            .iter()
            .map(|dot| (experiment_of(dot), dot.graph.as_str()));
        of.filter_map(|(name, graph)| {
            (*graphs.entry(name).or_insert(graph) != graph).then_some(name)
        })
        .collect()
    }

    /// A file's name for a subject.
    pub fn name(&self, what: &str, subject: usize) -> String {
        let what = file_name(what);
        if self.subjects.len() > 1 {
            format!("{what}-{}", subject + 1)
        } else {
            what
        }
    }
}
