//! Measuring the points of a sweep, one after another.

use super::list::{PointBuilder, SweepPoint, list};
use super::points::Sweep;
use super::record::{Folder, Manifest, Outcome, POINT_SCHEMA, Record, collect, write_file};
use super::references::References;
use crate::experiment::resolved_text;
use crate::lab::{Lab, LabError, camera_of};
use crate::measure::reference::Gathered;
use crate::measure::{Frames, Warm, measure};
use crate::results::stats::DeviceStats;
use crate::scene::Scene;
use crate::vulkan::VulkanError;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Which of the points: every `of`-th, from the `number`-th on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// From 1 to `of`.
    pub number: usize,
    /// At least 1.
    pub of: usize,
}

/// How a sweep is run.
#[derive(Clone, Debug)]
pub struct Options {
    /// Where everything is kept.
    pub folder: PathBuf,
    /// Which of the points.
    pub shard: Shard,
    /// Frames of every point.
    pub frames: Frames,
    /// Measure points again that have failed.
    pub again: bool,
    /// Gather references to so many samples a pixel first; those that are cached are used as they are when absent.
    pub samples: Option<u64>,
}

/// Progress that a sweep reports while it runs.
pub enum Progress<'a> {
    /// Points of this shard: to measure, and finished before.
    Begins {
        /// To measure.
        todo: usize,
        /// Finished before.
        before: usize,
    },
    /// Something worth knowing.
    Note(String),
    /// A reference is being gathered.
    Gathers(Gathered),
    /// A point is finished.
    Finished(&'a SweepPoint, &'a Record),
}

/// Counts of a shard's points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Measured.
    pub done: usize,
    /// Failed.
    pub failed: usize,
    /// Not measured yet.
    pub left: usize,
}

/// Measures every point of the shard that is not finished. Each is kept as soon as it is finished; an error that belongs
/// to a point is kept in its place. A device that is lost is opened again.
///
/// # Errors
/// What is wrong with the sweep as a whole, before anything is measured; a folder that cannot be written to; no device.
pub fn run(
    reopen: &dyn Fn() -> Result<Lab, LabError>,
    open_scene: &dyn Fn(&str) -> Result<Scene, LabError>,
    sweep: &Sweep,
    options: &Options,
    on_progress: &mut dyn FnMut(Progress),
) -> Result<Counts, LabError> {
    let mut lab = reopen()?;
    let home = lab.home.clone();
    let mut warm = Warm::default();
    let mut builder = PointBuilder::new(&home, open_scene);
    let (points, equal) = list(&mut builder, &mut warm, sweep, options.frames)?;
    if equal > 0 {
        on_progress(Progress::Note(format!("{equal} combinations equal another one and are measured once")));
    }
    let folder = Folder(options.folder.clone());
    folder.clean();
    folder.write_manifest(&Manifest::new(sweep, options.frames, &points))?;
    let Shard { number, of } = options.shard;
    let mine: Vec<&SweepPoint> = points.iter().skip(number - 1).step_by(of).collect();
    let mut references = References::new(&sweep.bounces, options.samples);
    let mut counts = Counts::default();
    let mut todo = Vec::new();
    let mut elsewhere = 0;
    for point in mine {
        let record = folder.read(&point.id);
        let known = match references.get(&lab, &mut warm, point, on_progress) {
            Ok(known) => known,
            // A finished point is not given up for it. Others meet it again, and keep it, when their turn comes.
            Err(error) if matches!(record, Some(Record { outcome: Outcome::Done(_), .. })) => return Err(error),
            Err(_) => Vec::new(),
        };
        let samples: BTreeMap<u32, u64> = known.iter().map(|(bounces, r)| (*bounces, r.samples)).collect();
        match record.as_ref().map(|r| (&r.outcome, &r.device)) {
            // A reference that has come or grown since makes other scores.
            Some((Outcome::Done(found), device)) if found.references == samples => {
                elsewhere += usize::from(device.name != lab.gpu.info.name);
                counts.done += 1;
            }
            Some((Outcome::Failed(_), _)) if !options.again => counts.failed += 1,
            _ => todo.push(point),
        }
    }
    if elsewhere > 0 {
        on_progress(Progress::Note(format!(
            "{elsewhere} points were measured on another device; name another folder with -o to measure them here"
        )));
    }
    on_progress(Progress::Begins { todo: todo.len(), before: counts.done + counts.failed });
    for point in todo {
        let mut attempt = |lab: &Lab, warm: &mut Warm, on_progress: &mut dyn FnMut(Progress)| match &point.absent {
            Some(why) => Err(LabError::Request(why.clone())),
            None => {
                let known = references.get(lab, warm, point, on_progress)?;
                measure(lab, warm, &point.experiment, &point.scene, options.frames, &known)
            }
        };
        let mut result = attempt(&lab, &mut warm, on_progress);
        if matches!(result, Err(LabError::Vulkan(VulkanError::Lost(_)))) {
            // Often the point before it is to blame; if it is this one, it fails again.
            on_progress(Progress::Note(String::from("the device was lost; it is opened again")));
            warm.leave_device();
            lab = reopen()?;
            result = attempt(&lab, &mut warm, on_progress);
        }
        if matches!(result, Err(LabError::Vulkan(VulkanError::Lost(_)))) {
            warm.leave_device();
            lab = reopen()?;
        }
        let (outcome, measured) = match result {
            Ok(measured) => (Outcome::Done(Box::new(measured.point.clone())), Some(measured)),
            Err(error) => (Outcome::Failed(error.to_string()), None),
        };
        let record = record_of(&lab, &mut warm, options, point, outcome)?;
        folder.write(&record, measured.as_ref())?;
        match &record.outcome {
            Outcome::Done(_) => counts.done += 1,
            Outcome::Failed(_) => counts.failed += 1,
        }
        on_progress(Progress::Finished(point, &record));
    }
    let table = super::table::csv(&collect(std::slice::from_ref(&options.folder))?)?;
    write_file(&options.folder.join("sweep.csv"), table.as_bytes())?;
    Ok(counts)
}

fn record_of(
    lab: &Lab,
    warm: &mut Warm,
    options: &Options,
    point: &SweepPoint,
    outcome: Outcome,
) -> Result<Record, LabError> {
    let text = match &point.absent {
        // Camera and light are not known.
        Some(_) => String::new(),
        None => {
            let params = &warm.graph(&lab.home, &point.experiment.graph)?.graph.params;
            let camera = camera_of(&point.experiment, &point.scene)?;
            let path = options.folder.join("experiment.ron");
            resolved_text(&point.experiment, params, &camera, &point.scene, &path)?
        }
    };
    Ok(Record {
        schema: POINT_SCHEMA.into(),
        id: point.id.clone(),
        experiment: text,
        subject: point.subject.clone(),
        device: DeviceStats::of(&lab.gpu.info),
        outcome,
    })
}
