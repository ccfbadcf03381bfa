//! Points measured one after another, each kept as soon as it is finished, on a device that may be lost.

use super::points::{Labels, OpenScene, PointBuilder, SweepPoint};
use super::record::{File, Folder, Outcome, Record};
use crate::diagnostics::Diagnostic;
use crate::experiment::Experiment;
use crate::lab::{Lab, LabError};
use crate::measure::reference::{Gathered, Reference};
use crate::measure::{Frames, Wanted, Warm};
use crate::results::stats::DeviceStats;
use crate::scene::Scene;
use crate::vulkan::VulkanError;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::sync::Arc;

/// Progress of a campaign.
pub enum Progress {
    /// Points: to measure, and finished before.
    Begins {
        /// To measure.
        todo: usize,
        /// Finished before.
        before: usize,
    },
    /// Something worth knowing.
    Note(String),
    /// What is done now.
    Runs(String),
    /// A reference is being gathered.
    Gathers(Gathered),
    /// What a search has tried: one line.
    Tried(String),
    /// A point is finished: what it is, and what there is to say of it.
    Finished(String, Vec<String>),
    /// All points are finished.
    Ends,
}

/// Counts of points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Measured.
    pub done: usize,
    /// Failed.
    pub failed: usize,
}

impl Counts {
    /// Those of some records.
    pub fn of<A, T>(records: &[Record<A, T>]) -> Counts {
        let done = records.iter().filter(|r| r.done().is_some()).count();
        Counts {
            done,
            failed: records.len() - done,
        }
    }
}

/// Opens the device.
pub type Open<'a> = dyn Fn() -> Result<Lab, LabError> + 'a;

/// A device, and what measurements leave to each other.
pub struct Runner<'a> {
    open: &'a Open<'a>,
    /// The device.
    pub lab: Lab,
    /// What the measurements before have left.
    pub warm: Warm,
    points: PointBuilder<'a>,
    on_progress: &'a mut dyn FnMut(Progress),
}

/// A point of a campaign.
pub trait Job {
    /// What records say of it.
    type About: Serialize + DeserializeOwned;
    /// What is measured.
    type Measured: Serialize + DeserializeOwned;

    /// Its number.
    fn id(&self) -> &str;

    /// What it is, for people.
    fn title(&self) -> String;

    /// What its record says of it.
    ///
    /// # Errors
    /// What is wrong with its graph or scene.
    fn about(&self, runner: &mut Runner, folder: &Folder) -> Result<Self::About, LabError>;

    /// What was measured that is worth a warning.
    fn warnings(measured: &Self::Measured) -> &[String];
}

/// The record of a job.
pub type RecordOf<J> = Record<<J as Job>::About, <J as Job>::Measured>;

/// What a job has measured, with files to be kept beside its record.
pub type Taken<J> = Result<(<J as Job>::Measured, Vec<File>), LabError>;

/// The record of a job that is kept, if there is one.
pub type Kept<'a, J> = dyn FnMut(&mut Runner, &J) -> Result<Option<RecordOf<J>>, LabError> + 'a;

impl<'a> Runner<'a> {
    /// Opens the device.
    ///
    /// # Errors
    /// No device.
    pub fn open(
        open: &'a Open<'a>,
        open_scene: &'a OpenScene<'a>,
        on_progress: &'a mut dyn FnMut(Progress),
    ) -> Result<Runner<'a>, LabError> {
        let points = PointBuilder::new(open_scene);
        Ok(Runner {
            open,
            lab: open()?,
            warm: Warm::default(),
            points,
            on_progress,
        })
    }

    /// The point of an experiment.
    ///
    /// # Errors
    /// As [`PointBuilder::point`].
    pub fn point(
        &mut self,
        experiment: Experiment,
        labels: Labels,
        frames: Frames,
    ) -> Result<SweepPoint, LabError> {
        self.points
            .point(&self.lab.home, &mut self.warm, experiment, labels, frames)
    }

    /// Takes progress.
    pub fn tell(&mut self, progress: Progress) {
        (self.on_progress)(progress);
    }

    /// A reference, see [`Warm::reference`].
    ///
    /// # Errors
    /// As [`Warm::reference`].
    pub fn reference(
        &mut self,
        experiment: &Experiment,
        scene: &Arc<Scene>,
        subject: &str,
        wanted: Wanted,
    ) -> Result<Option<Arc<Reference>>, LabError> {
        let Runner {
            lab,
            warm,
            on_progress,
            ..
        } = self;
        warm.reference(lab, (experiment, scene), subject, wanted, &mut |now| {
            on_progress(Progress::Gathers(now))
        })
    }

    /// The records of some jobs, in order: those that are `kept`, and those that `measure` measures now. An error that
    /// belongs to a job is kept in its place.
    ///
    /// # Errors
    /// A folder that cannot be written to; no device; the errors of `kept`.
    pub fn run<J: Job>(
        &mut self,
        folder: &Folder,
        jobs: &[&J],
        kept: &mut Kept<J>,
        measure: &mut dyn FnMut(&mut Runner, &J) -> Taken<J>,
    ) -> Result<Vec<RecordOf<J>>, LabError> {
        let finished = jobs
            .iter()
            .map(|job| kept(self, job))
            .collect::<Result<Vec<_>, _>>()?;
        let before = finished.iter().flatten().count();
        self.tell(Progress::Begins {
            todo: jobs.len() - before,
            before,
        });
        let mut records = Vec::new();
        for (job, record) in jobs.iter().zip(finished) {
            records.push(match record {
                Some(record) => record,
                None => self.measured(folder, *job, measure)?,
            });
        }
        self.tell(Progress::Ends);
        Ok(records)
    }

    /// The record of one job: the one that is `kept`, or what `measure` measures now; see [`Runner::run`].
    ///
    /// # Errors
    /// As [`Runner::run`].
    pub fn one<J: Job>(
        &mut self,
        folder: &Folder,
        job: &J,
        kept: &mut Kept<J>,
        measure: &mut dyn FnMut(&mut Runner, &J) -> Taken<J>,
    ) -> Result<RecordOf<J>, LabError> {
        match kept(self, job)? {
            Some(record) => Ok(record),
            None => self.measured(folder, job, measure),
        }
    }

    fn measured<J: Job>(
        &mut self,
        folder: &Folder,
        job: &J,
        measure: &mut dyn FnMut(&mut Runner, &J) -> Taken<J>,
    ) -> Result<RecordOf<J>, LabError> {
        self.tell(Progress::Runs(job.title()));
        let mut result = measure(self, job);
        if self.opened_again(&result)? {
            // Often the point before it is to blame; if it is this one, it fails again.
            self.tell(Progress::Note(
                "the device was lost; it is opened again".into(),
            ));
            result = measure(self, job);
            self.opened_again(&result)?;
        }
        let (outcome, files) = match result {
            Ok((measured, files)) => (Outcome::Done(Box::new(measured)), files),
            Err(error) => (Outcome::Failed(error.to_string()), Vec::new()),
        };
        let about = job.about(self, folder)?;
        let device = DeviceStats::of(&self.lab.gpu.info);
        let record = Record {
            schema: folder.schema.into(),
            id: job.id().into(),
            about,
            device,
            outcome,
        };
        folder.write(&record, &files)?;
        let said = match &record.outcome {
            Outcome::Failed(error) => vec![format!("failed: {error}")],
            Outcome::Done(measured) => J::warnings(measured)
                .iter()
                .map(|w| format!("warning: {w}"))
                .collect(),
        };
        self.tell(Progress::Finished(job.title(), said));
        // As the next run will read it: numbers that JSON rounds in the last place are the same in all tables.
        Ok(folder.read(&record.id).unwrap_or(record))
    }

    /// Opens the device again if it was lost.
    fn opened_again<T>(&mut self, result: &Result<T, LabError>) -> Result<bool, LabError> {
        let lost = matches!(result, Err(LabError::Vulkan(VulkanError::Lost(_))));
        if lost {
            self.warm.leave_device();
            self.lab = (self.open)()?;
        }
        Ok(lost)
    }
}

/// Mistakes, each once: the same one comes back with every combination.
#[derive(Default)]
pub struct Mistakes(Vec<Diagnostic>);

impl Mistakes {
    /// Keeps the mistakes of a result; nothing of one that has them.
    ///
    /// # Errors
    /// Errors that are no mistakes of a file.
    pub fn take<T>(&mut self, result: Result<T, LabError>) -> Result<Option<T>, LabError> {
        match result {
            Ok(value) => Ok(Some(value)),
            Err(LabError::Input(list)) => {
                for diagnostic in list {
                    if !self.0.contains(&diagnostic) {
                        self.0.push(diagnostic);
                    }
                }
                Ok(None)
            }
            Err(other) => Err(other),
        }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// An error if there are any.
    ///
    /// # Errors
    /// All of them.
    pub fn none(self) -> Result<(), LabError> {
        if self.0.is_empty() {
            Ok(())
        } else {
            Err(LabError::Input(self.0))
        }
    }
}
