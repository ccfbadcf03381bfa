//! Running a suite: every method in every case, one after another, each kept as soon as it is finished.

use super::chart_spec::CostChart;
use super::file::Suite;
use super::motion::{FrameState, Motion};
use super::pictures::Panels;
use super::plan::{Job, Options, plan};
use super::plot::Plot;
use super::record::{Folder, Measured, Outcome, RESULT_SCHEMA, Record, Report, SCHEMA, Worst, json, lasting};
use super::references::{FrameReference, References, Tracing};
use super::series::{Known, PartSeries};
use super::{chart, cost, page, table};
use crate::campaign::sweep::PointBuilder;
use crate::graph::param::Value;
use crate::lab::{Lab, LabError, ReusableParts, Session, parts_of};
use crate::measure::Warm;
use crate::measure::oracle::{self, Surfaces};
use crate::measure::reference::Gathered;
use crate::metrics::Linear;
use crate::results::stats::DeviceStats;
use crate::scene::{Light, Scene};
use crate::vulkan::VulkanError;
use glam::DVec3;
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

/// Progress that a suite reports while it runs.
pub enum Progress<'a> {
    /// Methods in cases: to measure, and finished before.
    Begins {
        /// To measure.
        todo: usize,
        /// Finished before.
        before: usize,
    },
    /// A method is timed for the chart of costs.
    Times {
        /// Name of the method.
        method: &'a str,
        /// Measurements before it.
        done: usize,
        /// And in all.
        of: usize,
    },
    /// A method in a case begins.
    Runs(&'a Job),
    /// A reference is being traced.
    Gathers(Gathered),
    /// A method in a case is finished.
    Finished(&'a Record),
}

/// Counts of a suite's results.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Measured.
    pub done: usize,
    /// Failed.
    pub failed: usize,
}

/// Runs what is not finished of a suite, and writes tables, charts and the page of all of it. An error that belongs to a
/// method in a case is kept in its place; it is tried again by the next run.
///
/// # Errors
/// What is wrong with the suite as a whole, before anything is measured; a folder that cannot be written to; no device.
pub fn run(
    reopen: &dyn Fn() -> Result<Lab, LabError>,
    open_scene: &dyn Fn(&str) -> Result<Scene, LabError>,
    suite: &Suite,
    options: &Options,
    on_progress: &mut dyn FnMut(Progress),
) -> Result<(Counts, Report), LabError> {
    let mut lab = reopen()?;
    let mut warm = Warm::default();
    let home = lab.home.clone();
    // Opens each scene once for all plans.
    let mut builder = PointBuilder::new(&home, open_scene);
    let mut jobs = plan(&home, &lab.gpu.info, &mut builder, &mut warm, suite, options)?;
    let mut costs = Vec::new();
    if let Some(chart) = &suite.chart {
        costs = cost::costs(&lab, &mut builder, &mut warm, (suite, chart), options, on_progress)?;
        let chosen = cost::chosen(suite, chart, &costs);
        jobs = plan(&home, &lab.gpu.info, &mut builder, &mut warm, &chosen, options)?;
    }
    let folder = Folder(options.folder.clone());
    let samples = options.samples.unwrap_or(suite.samples);
    let tracing = Tracing { samples, bounces: suite.bounces, seed: suite.seed };
    let (reference, pictures) = (options.reference, suite.pictures.clone());
    let mut runner = Runner { references: References::new(tracing), shared: HashMap::new(), reference, pictures };
    let finished: Vec<Option<Record>> = jobs.iter().map(|j| folder.read(&j.id)).collect();
    let before = finished.iter().flatten().count();
    on_progress(Progress::Begins { todo: jobs.len() - before, before });
    let mut results = Vec::new();
    let mut counts = Counts::default();
    for (job, kept) in jobs.iter().zip(finished) {
        let record = match kept {
            Some(record) => record,
            None => {
                on_progress(Progress::Runs(job));
                let result = runner.measure(&lab, &mut warm, job, on_progress);
                if matches!(result, Err(LabError::Vulkan(VulkanError::Lost(_)))) {
                    warm.leave_device();
                    lab = reopen()?;
                    runner = Runner { references: References::new(tracing), shared: HashMap::new(), ..runner };
                }
                let (outcome, picture) = match result {
                    Ok((measured, picture)) => (Outcome::Done(Box::new(measured)), picture),
                    Err(error) => (Outcome::Failed(error.to_string()), None),
                };
                let record = record_of(&lab, job, outcome);
                folder.write(&record, picture.as_deref())?;
                on_progress(Progress::Finished(&record));
                // As the next run will read it: numbers that JSON rounds in the last place are the same in all tables.
                folder.read(&record.id).unwrap_or(record)
            }
        };
        match record.outcome {
            Outcome::Done(_) => counts.done += 1,
            Outcome::Failed(_) => counts.failed += 1,
        }
        results.push(record);
    }
    let report = Report {
        schema: SCHEMA.into(),
        version: env!("CARGO_PKG_VERSION").into(),
        suite: suite.name.clone(),
        text: suite.text.clone(),
        reference: options.reference.then_some((samples, suite.bounces)),
        costs,
        results,
    };
    write(&report, suite.chart.as_ref(), options)?;
    Ok((counts, report))
}

/// Tables, JSON, charts and the page.
fn write(report: &Report, spec: Option<&CostChart>, options: &Options) -> Result<(), LabError> {
    let charts = chart::charts(report)?;
    let plot = spec.map(|spec| Plot::new(report, spec)).transpose()?;
    let mut files = vec![
        ("stability.json".to_string(), json(report)?),
        ("stability.csv".into(), table::rows(report)?.into_bytes()),
        ("frames.csv".into(), table::frames(report)?.into_bytes()),
    ];
    files.extend(charts.iter().map(|c| (format!("charts/{}.svg", c.name), c.svg.clone().into_bytes())));
    if let Some(plot) = &plot {
        files.push(("cost.csv".into(), plot.csv()?.into_bytes()));
        files.extend(plot.svg.iter().map(|svg| ("charts/cost.svg".into(), svg.clone().into_bytes())));
    }
    files.push(("index.html".into(), page::page(report, &charts, plot.as_ref()).into_bytes()));
    files.iter().try_for_each(|(name, bytes)| lasting(&options.folder.join(name), bytes))
}

fn record_of(lab: &Lab, job: &Job, outcome: Outcome) -> Record {
    Record {
        schema: RESULT_SCHEMA.into(),
        id: job.id.clone(),
        case: job.case.name.clone(),
        variant: job.case.variant.clone(),
        about: job.case.about.clone(),
        motion: job.case.motion.describe(),
        method: job.method.clone(),
        scene: job.scene.name.clone(),
        size: job.experiment.size.into(),
        warmup: job.case.warmup,
        frames: job.frames,
        device: DeviceStats::of(&lab.gpu.info),
        outcome,
    }
}

/// What one method in a case leaves to the next: references, and each method's pipelines.
struct Runner {
    references: References,
    shared: HashMap<String, ReusableParts>,
    reference: bool,
    /// The part whose worst frames are kept.
    pictures: String,
}

/// A frame that may be the worst.
struct Bad {
    frame: usize,
    bad: f64,
    panels: Panels,
}

impl Runner {
    fn measure(
        &mut self,
        lab: &Lab,
        warm: &mut Warm,
        job: &Job,
        on_progress: &mut dyn FnMut(Progress),
    ) -> Result<(Measured, Option<Vec<u8>>), LabError> {
        let loaded = warm.graph(&lab.home, &job.experiment.graph)?.clone();
        let motion = &job.case.motion;
        let mut wanted: Vec<String> = parts_of(&loaded.graph).into_iter().map(|p| p.1).collect();
        if job.case.voxels && loaded.graph.voxels.is_some() || motion.in_voxels() {
            wanted.extend(oracle::wanted(&loaded.graph)?);
        }
        let reuse = self.shared.get(&job.method);
        let mut session = lab.build(&job.experiment, &loaded, job.scene.clone(), wanted, reuse)?;
        let cell = cell_of(&mut session, job)?;
        let (mut times, mut warnings) = (Vec::new(), Vec::new());
        let mut series: BTreeMap<String, PartSeries> = BTreeMap::new();
        let mut worst: Option<Bad> = None;
        let mut samples = 0;
        let mut lights = job.scene.lights.clone();
        let mut before: Option<(FrameState, Option<Arc<FrameReference>>)> = None;
        let warmup = i64::try_from(job.case.warmup).unwrap_or(0);
        let frames = i64::try_from(job.frames).unwrap_or(1);
        for number in -warmup..frames {
            let state = place(lab, &mut session, job, number, cell, &mut lights)?;
            times.extend(session.frame(motion.delta())?);
            let Ok(frame) = usize::try_from(number) else { continue };
            times.extend(session.finish()?);
            for message in session.failed_checks()? {
                if !warnings.contains(&message) {
                    warnings.push(message);
                }
            }
            let changed = before.as_ref().is_none_or(|b| b.0 != state);
            let reference = match (&before, self.reference) {
                (_, false) => None,
                (Some((_, Some(reference))), true) if !changed => Some(reference.clone()),
                _ => Some(self.references.get(lab, warm, job, &state, &mut |now| on_progress(Progress::Gathers(now)))?),
            };
            if let Some(reference) = &reference {
                if frame > 0 && reference.samples != samples {
                    let unequal =
                        "references have different numbers of samples, some were kept with more: noise is larger";
                    if !warnings.iter().any(|w| w == unequal) {
                        warnings.push(unequal.into());
                    }
                }
                samples = reference.samples;
            }
            let earlier = before.as_ref().and_then(|b| b.1.as_ref());
            for (part, x) in session.parts()? {
                let lost = x.rgb.iter().filter(|c| !c.iter().all(|v| v.is_finite())).count();
                let note = format!("pixels of '{part}' are no number and left out of its scores");
                if lost > 0 && !warnings.iter().any(|w| w.ends_with(&note)) {
                    warnings.push(format!("frame {frame}, perhaps others too: {lost} {note}"));
                }
                let known = known(&part, reference.as_deref(), earlier.map(|t| &**t), changed);
                let own = series.entry(part.clone()).or_insert_with(|| PartSeries::new(&part));
                let shown = (part == self.pictures).then(|| Panels::of(own.before(), &x, known));
                let bad = own.add(x, known, number + 1 == frames);
                if let (Some(panels), Some(bad)) = (shown, bad.or((frame == 0).then_some(0.0)))
                    && worst.as_ref().is_none_or(|w| bad > w.bad || w.frame == 0)
                {
                    worst = Some(Bad { frame, bad, panels });
                }
            }
            before = Some((state, reference));
        }
        let times: Vec<f64> = times.iter().skip(job.case.warmup).map(|t| t.gpu_ms).collect();
        let last = before.map_or(job.start.time, |b| b.0.time);
        let voxels = voxels(&mut session, job, last, &mut warnings)?;
        self.shared.insert(job.method.clone(), session.share());
        let (event, switched) = (motion.event(), matches!(motion, Motion::Switch { .. }));
        let memory_bytes = session.program.memory(&session.graph).iter().map(|m| m.1).sum();
        let parts = series.into_iter().map(|(name, s)| (name, s.finish(event, switched))).collect();
        let picture = worst.as_ref().map(|w| w.panels.png()).transpose()?;
        let worst = worst.map(|w| Worst {
            part: self.pictures.clone(),
            frame: w.frame,
            full: w.panels.full(),
            panels: w.panels.names(),
        });
        let frame_ms = median(times);
        Ok((Measured { frame_ms, memory_bytes, samples, event, parts, voxels, worst, warnings }, picture))
    }
}

/// Sets a parameter for the next frame.
fn set(lab: &Lab, session: &mut Session, name: &str, value: Value) -> Result<(), LabError> {
    let mut params = session.params.clone();
    if let Some(index) = params.index(name) {
        params.values[index] = value;
    }
    match session.set_params(lab, &params)? {
        true => Ok(()),
        false => Err(LabError::Request(format!(
            "'{name}' decides about passes or sizes of textures: only what shaders read can move"
        ))),
    }
}

/// What is known of a part's reference; `earlier` is that of the frame before.
fn known<'a>(
    part: &str,
    reference: Option<&'a FrameReference>,
    earlier: Option<&'a FrameReference>,
    changed: bool,
) -> Known<'a> {
    let of = |t: Option<&'a FrameReference>| t.and_then(|t| t.parts.get(part));
    match (of(reference), of(earlier)) {
        (Some(now), before) => Known::Reference { now, before: before.filter(|_| changed) },
        (None, _) => Known::Nothing { changed },
    }
}

/// The least edge of the method's cell at the camera, m, if its motion asks for it.
pub(super) fn cell_of(session: &mut Session, job: &Job) -> Result<f32, LabError> {
    if !job.case.motion.in_voxels() {
        return Ok(0.0);
    }
    session.place_camera(&job.start.camera);
    session.frame(0.0)?;
    session.finish()?;
    let (x, y, z) = job.start.camera.eye;
    let edges = oracle::grid(session)?.edges_at(DVec3::new(x.into(), y.into(), z.into()));
    Ok(edges.min_element() as f32)
}

/// Makes frame `number` of a job the session's next one. `lights` are those that the session has.
pub(super) fn place(
    lab: &Lab,
    session: &mut Session,
    job: &Job,
    number: i64,
    cell: f32,
    lights: &mut Vec<Light>,
) -> Result<FrameState, LabError> {
    let state = job.frame_state(number, cell);
    if let Some(track) = &job.track {
        set(lab, session, &track.name, track.at(number))?;
    }
    session.place_camera(&state.camera);
    session.set_time(state.time);
    if state.lights != *lights {
        if !session.set_lights(&state.lights, job.scene.sky) {
            return Err(LabError::Request("a light that moves must keep its kind and its shadow".into()));
        }
        lights.clone_from(&state.lights);
    }
    Ok(state)
}

/// The voxels of the last frame against exact ones, if the case asks for it and the method can.
fn voxels(
    session: &mut Session,
    job: &Job,
    time: f64,
    warnings: &mut Vec<String>,
) -> Result<Option<oracle::Score>, LabError> {
    if !job.case.voxels || session.graph.voxels.is_none() {
        return Ok(None);
    }
    match oracle::read(session) {
        Ok((grid, voxels)) => {
            let triangles = oracle::triangles_of(&job.scene, time);
            let cells = oracle::exact(&triangles, &Surfaces::new(&job.scene), &grid);
            Ok(Some(oracle::compare(&grid, &cells, &voxels).score))
        }
        Err(LabError::Request(why)) => {
            warnings.push(format!("voxels not compared: {why}"));
            Ok(None)
        }
        Err(other) => Err(other),
    }
}

pub(super) fn median(mut list: Vec<f64>) -> f64 {
    list.sort_by(f64::total_cmp);
    list.get(list.len() / 2).copied().unwrap_or(0.0)
}

impl Panels {
    /// The pictures of a frame: before, now, the reference, and how the change differs from the reference's; of a first
    /// frame, how the picture differs.
    fn of(before: Option<&Linear>, x: &Linear, known: Known) -> Panels {
        let (reference, reference_before) = match known {
            Known::Reference { now, before } => (Some(&now.mean), before.map(|b| &b.mean)),
            Known::Nothing { .. } => (None, None),
        };
        Panels::new(before, x, reference, reference_before)
    }
}
