//! Runs jobs one by one, records each result at once, and opens a lost device again.

use super::points::{Labels, OpenScene, PointBuilder, SweepPoint};
use super::record::{File, Folder, Outcome, Record};
use crate::diagnostics::Diagnostic;
use crate::experiment::{Experiment, resolved_text};
use crate::lab::{Lab, LabError, camera_of};
use crate::measure::reference::{Gathered, Reference};
use crate::measure::{Frames, Wanted, Warm};
use crate::results::stats::DeviceStats;
use crate::scene::Scene;
use crate::vulkan::VulkanError;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

/// Progress of a campaign.
pub enum Progress {
    /// Number of points to measure, and of those that are already finished.
    Begins {
        /// Points to measure.
        todo: usize,
        /// Points that are finished.
        before: usize,
    },
    /// A line for the user.
    Note(String),
    /// Title of the point that is measured now.
    Runs(String),
    /// Progress of a reference.
    Gathers(Gathered),
    /// One line about a trial of a search.
    Tried(String),
    /// A point is finished: its title and its notes.
    Finished(String, Vec<String>),
    /// All points are finished.
    Ends,
}

/// Takes progress. `Break` ends the campaign with [`LabError::Stopped`]; finished points are kept.
pub type OnProgress<'a> = dyn FnMut(Progress) -> ControlFlow<()> + 'a;

/// Numbers of points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Points with measurements.
    pub done: usize,
    /// Points with errors.
    pub failed: usize,
}

impl Counts {
    /// Counts the outcomes of records.
    pub fn of<A, T>(records: &[Record<A, T>]) -> Counts {
        let done = records.iter().filter(|r| r.done().is_some()).count();
        Counts {
            done,
            failed: records.len() - done,
        }
    }
}

/// Opens a device.
pub type Open<'a> = dyn Fn() -> Result<Lab, LabError> + 'a;

/// A device with caches for the next measurements.
pub struct Runner<'a> {
    open: &'a Open<'a>,
    /// The device.
    pub lab: Lab,
    /// Caches of earlier measurements.
    pub warm: Warm,
    points: PointBuilder<'a>,
    on_progress: &'a mut OnProgress<'a>,
}

/// A point of a campaign.
pub trait Job {
    /// Description of the point in its record.
    type About: Serialize + DeserializeOwned;
    /// Measurements of a job.
    type Measured: Serialize + DeserializeOwned;

    /// Identifier of the point, and name of its record.
    fn id(&self) -> &str;

    /// Title for people.
    fn title(&self) -> String;

    /// Description for the record.
    fn about(&self, runner: &mut Runner, folder: &Folder) -> Result<Self::About, LabError>;

    /// Warnings of a measurement.
    fn warnings(measured: &Self::Measured) -> &[String];
}

/// The record of a job.
pub type RecordOf<J> = Record<<J as Job>::About, <J as Job>::Measured>;

/// Measurements of a job, with files for the folder.
pub type Taken<J> = Result<(<J as Job>::Measured, Vec<File>), LabError>;

/// Returns the valid record of a job, if there is one.
pub type Kept<'a, J> = dyn FnMut(&mut Runner, &J) -> Result<Option<RecordOf<J>>, LabError> + 'a;

impl<'a> Runner<'a> {
    /// Opens a device.
    ///
    /// # Errors
    /// There is none.
    pub fn open(
        open: &'a Open<'a>,
        open_scene: &'a OpenScene<'a>,
        on_progress: &'a mut OnProgress<'a>,
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
    /// Mistakes in the experiment or its graph; a scene that cannot be opened.
    pub fn point(
        &mut self,
        experiment: Experiment,
        labels: Labels,
        frames: Frames,
    ) -> Result<SweepPoint, LabError> {
        self.points
            .point(&self.lab.home, &mut self.warm, experiment, labels, frames)
    }

    /// Tells progress.
    ///
    /// # Errors
    /// The callback ends the campaign.
    pub fn tell(&mut self, progress: Progress) -> Result<(), LabError> {
        match (self.on_progress)(progress) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(LabError::Stopped),
        }
    }

    /// An experiment as text with all fields and without defaults, as if it were a file of this
    /// folder.
    ///
    /// # Errors
    /// Mistakes in the experiment or its graph.
    pub fn resolved(
        &mut self,
        experiment: &Experiment,
        scene: &Scene,
        folder: &Path,
    ) -> Result<String, LabError> {
        let graph = self.warm.graph(&self.lab.home, &experiment.graph)?;
        let (params, camera) = (&graph.graph.params, camera_of(experiment, scene)?);
        let file = folder.join("experiment.ron");
        Ok(resolved_text(experiment, params, &camera, scene, &file)?)
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

    /// Records of jobs, in order. `kept` returns existing records, `measure` measures the others.
    /// An error of a job becomes its record.
    ///
    /// # Errors
    /// A folder that cannot be written to; a device that cannot be opened again; the callback for
    /// progress ends the campaign.
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
        })?;
        let mut records = Vec::new();
        for (job, record) in jobs.iter().zip(finished) {
            records.push(match record {
                Some(record) => record,
                None => self.measured(folder, *job, measure)?,
            });
        }
        self.tell(Progress::Ends)?;
        Ok(records)
    }

    /// Record of one job, see [`Runner::run`].
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
        self.tell(Progress::Runs(job.title()))?;
        let mut result = measure(self, job);
        if self.opened_again(&result)? {
            // The previous point is often the cause. If it is this one, it fails again.
            self.tell(Progress::Note(
                "the device was lost; it is opened again".into(),
            ))?;
            result = measure(self, job);
            self.opened_again(&result)?;
        }
        let (outcome, files) = match result {
            Ok((measured, files)) => (Outcome::Done(Box::new(measured)), files),
            Err(LabError::Stopped) => return Err(LabError::Stopped),
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
        self.tell(Progress::Finished(job.title(), said))?;
        // Reads the record back, so that rounded numbers are the same in all tables.
        Ok(folder.read(&record.id).unwrap_or(record))
    }

    /// Opens a lost device again.
    fn opened_again<T>(&mut self, result: &Result<T, LabError>) -> Result<bool, LabError> {
        let lost = matches!(result, Err(LabError::Vulkan(VulkanError::Lost(_))));
        if lost {
            self.warm.leave_device();
            self.lab = (self.open)()?;
        }
        Ok(lost)
    }
}

/// Mistakes without duplicates; every combination repeats them.
#[derive(Default)]
pub(crate) struct Mistakes(Vec<Diagnostic>);

impl Mistakes {
    /// Takes a result. `None` if it has mistakes, which are kept.
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

    pub fn count(&self) -> usize {
        self.0.len()
    }

    /// An error with all mistakes, if there are any.
    pub fn none(self) -> Result<(), LabError> {
        if self.0.is_empty() {
            Ok(())
        } else {
            Err(LabError::Input(self.0))
        }
    }
}
