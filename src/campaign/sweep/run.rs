//! Measuring the points of a sweep, one after another.

use super::list::list;
use super::points::Sweep;
use super::record::{
    About, Manifest, ManifestPoint, PointRecord, collect, jpeg, points_in, reference,
};
use crate::campaign::points::{OpenScene, SweepPoint, labelled};
use crate::campaign::record::{File, Folder, write_file};
use crate::campaign::runner::{Counts, Job, OnProgress, Open, Progress, Runner, Taken};
use crate::lab::LabError;
use crate::measure::reference::{Goal, Reference};
use crate::measure::{Frames, Point, Scored, Wanted, measure};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A share of the points: every `of`-th, from `number` on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// From 1 to `of`.
    pub number: usize,
    /// At least 1.
    pub of: usize,
}

impl Shard {
    /// All points.
    pub const ALL: Shard = Shard { number: 1, of: 1 };
}

/// Options of a run.
#[derive(Clone, Debug)]
pub struct Options {
    /// Folder of the results.
    pub folder: PathBuf,
    /// Share of the points.
    pub shard: Shard,
    /// Frames of every point.
    pub frames: Frames,
    /// Whether failed points are measured again.
    pub again: bool,
    /// Gather references to this goal first. `None` uses cached references only.
    pub goal: Option<Goal>,
}

impl Job for SweepPoint {
    type About = About;
    type Measured = Point;

    fn id(&self) -> &str {
        &self.id
    }

    fn title(&self) -> String {
        format!(
            "{} ({})",
            self.id,
            labelled(self.labels.iter().map(|(name, value)| (name, value)))
        )
    }

    fn about(&self, runner: &mut Runner, folder: &Folder) -> Result<About, LabError> {
        let experiment = match &self.absent {
            // Camera and light are unknown.
            Some(_) => String::new(),
            None => runner.resolved(&self.experiment, &self.scene, &folder.path)?,
        };
        Ok(About {
            experiment,
            subject: self.subject.clone(),
        })
    }

    fn warnings(point: &Point) -> &[String] {
        &point.stats.warnings
    }
}

/// Measures every open point of the shard. Each point is recorded at once, errors of a point too. A
/// lost device is opened again.
pub fn run(
    open: &Open,
    open_scene: &OpenScene,
    sweep: &Sweep,
    options: &Options,
    on_progress: &mut OnProgress<'_>,
) -> Result<Counts, LabError> {
    let mut runner = Runner::open(open, open_scene, on_progress)?;
    let (points, equal) = list(&mut runner, sweep, options.frames)?;
    if equal > 0 {
        runner.tell(Progress::Note(format!(
            "{equal} combinations equal another one and are measured once"
        )))?;
    }
    let folder = points_in(&options.folder);
    folder.clean(&["points", "pictures", "errors", "references"]);
    let (name, text, names) = (sweep.name.clone(), sweep.text.clone(), sweep.names.clone());
    let listed = points.iter().map(ManifestPoint::of).collect();
    Manifest::new(name, text, names, options.frames, listed).write(&options.folder)?;
    let Shard { number, of } = options.shard;
    let mine: Vec<&SweepPoint> = points.iter().skip(number - 1).step_by(of).collect();
    let Options { frames, goal, .. } = *options;
    let measuring = Measuring {
        frames,
        bounces: &sweep.bounces,
        goal,
        scored: Scored::All,
    };
    let mut elsewhere = 0;
    let mut kept = |runner: &mut Runner, point: &SweepPoint| {
        let record = measuring
            .kept(runner, &folder, point)?
            .filter(|r| r.done().is_some() || !options.again);
        let measured = record.as_ref().filter(|r| r.done().is_some());
        elsewhere +=
            usize::from(measured.is_some_and(|r| r.device.name != runner.lab.gpu.info.name));
        Ok(record)
    };
    let mut measured = |runner: &mut Runner, point: &SweepPoint| measuring.measured(runner, point);
    let records = runner.run(&folder, &mine, &mut kept, &mut measured)?;
    if elsewhere > 0 {
        let message = "points were measured on another device; name another folder with -o to measure them here";
        runner.tell(Progress::Note(format!("{elsewhere} {message}")))?;
    }
    write_table(&options.folder)?;
    Ok(Counts::of(&records))
}

/// Writes the table of a folder.
pub fn write_table(folder: &Path) -> Result<(), LabError> {
    let table = super::table::csv(&collect(&[folder.into()])?)?;
    write_file(&folder.join("sweep.csv"), table.as_bytes())
}

/// How points are measured.
pub struct Measuring<'a> {
    /// Frames of every point.
    pub frames: Frames,
    /// Bounces of the references.
    pub bounces: &'a [u32],
    /// Gather references to this goal first. `None` uses cached references only.
    pub goal: Option<Goal>,
    /// Scores of the points.
    pub scored: Scored<'a>,
}

impl Measuring<'_> {
    /// The record of a finished point that is scored against the current references.
    pub fn kept(
        &self,
        runner: &mut Runner,
        folder: &Folder,
        point: &SweepPoint,
    ) -> Result<Option<PointRecord>, LabError> {
        let record: Option<PointRecord> = folder.read(&point.id);
        let known = match self.references(runner, point) {
            Ok(known) => known,
            // A finished point stays. Points without a record report the error.
            Err(error) if record.as_ref().is_some_and(|r| r.done().is_some()) => return Err(error),
            Err(_) => Vec::new(),
        };
        let samples: BTreeMap<u32, u64> = known
            .iter()
            .map(|(bounces, r)| (*bounces, r.samples))
            .collect();
        // New or larger references change the scores.
        Ok(record.filter(|r| r.done().is_none_or(|found| found.references == samples)))
    }

    pub fn measured(&self, runner: &mut Runner, point: &SweepPoint) -> Taken<SweepPoint> {
        if let Some(why) = &point.absent {
            return Err(LabError::Request(why.clone()));
        }
        let known = self.references(runner, point)?;
        let Runner { lab, warm, .. } = runner;
        let found = measure(
            lab,
            warm,
            &point.experiment,
            &point.scene,
            self.frames,
            &known,
            self.scored,
        )?;
        let files: [(String, Option<Vec<u8>>); 3] = [
            (jpeg("pictures", &point.id), found.picture),
            (jpeg("errors", &point.id), found.error_map),
            (reference(&point.subject), found.reference),
        ];
        let files: Vec<File> = files
            .into_iter()
            .filter_map(|(name, bytes)| Some((name, bytes?)))
            .collect();
        Ok((found.point, files))
    }

    /// The available references of a point, by bounces.
    pub fn references(
        &self,
        runner: &mut Runner,
        point: &SweepPoint,
    ) -> Result<Vec<(u32, Arc<Reference>)>, LabError> {
        let mut list = Vec::new();
        for bounces in self.bounces.iter().filter(|_| point.absent.is_none()) {
            let wanted = Wanted {
                bounces: *bounces,
                goal: self.goal,
                seed: None,
            };
            let found = runner.reference(
                &point.experiment,
                &point.scene,
                &format!("{:?}", point.subject),
                wanted,
            )?;
            list.extend(found.map(|r| (*bounces, r)));
        }
        Ok(list)
    }
}
