//! Gathers a reference on a thread and a device of its own, while the workbench goes on.

use crate::experiment::Experiment;
use crate::lab::{Lab, LabError, Workspace};
use crate::measure::reference::{Gathered, Goal, gather};
use crate::scene::Scene;
use crate::vulkan::GpuOptions;
use crate::workbench::background::Wake;
use crossbeam_channel::{Receiver, unbounded};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// A reference that is to be gathered.
pub struct Job {
    /// Folders.
    pub home: Workspace,
    /// The device.
    pub gpu: GpuOptions,
    /// The experiment of the reference.
    pub experiment: Experiment,
    /// The scene with its own light.
    pub scene: Arc<Scene>,
    /// Bounces.
    pub bounces: u32,
    /// Samples of every pixel.
    pub samples: u64,
}

/// A reference in the making.
pub struct Gather {
    /// How far it is; nothing before the first samples.
    pub state: Option<Gathered>,
    /// Samples at the first report, and its time.
    first: Option<(u64, Instant)>,
    /// Whether it was asked to stop.
    pub cancelled: bool,
    cancel: Arc<AtomicBool>,
    messages: Receiver<Message>,
    thread: Option<std::thread::JoinHandle<Vec<String>>>,
}

enum Message {
    Progress(Gathered),
    Done(Result<u64, LabError>),
}

impl Gather {
    /// Begins.
    pub fn start(job: Job, wake: Wake) -> Gather {
        let (out, messages) = unbounded();
        let cancel = Arc::new(AtomicBool::new(false));
        let stop = cancel.clone();
        let thread = std::thread::spawn(move || {
            let progress = |now: Gathered| {
                let _ = out.send(Message::Progress(now));
                wake();
                if stop.load(Ordering::Relaxed) {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            };
            let (result, messages) = work(job, progress);
            let _ = out.send(Message::Done(result));
            wake();
            messages
        });
        Gather {
            state: None,
            first: None,
            cancelled: false,
            cancel,
            messages,
            thread: Some(thread),
        }
    }

    /// Tells it to stop; whole blocks of samples are kept.
    pub fn cancel(&mut self) {
        self.cancelled = true;
        self.cancel.store(true, Ordering::Relaxed);
    }

    /// Remaining time at the present speed.
    pub fn left(&self) -> Option<Duration> {
        let (now, (first, since)) = (self.state?, self.first?);
        let done = now.samples.checked_sub(first).filter(|done| *done > 0)?;
        Some(
            since
                .elapsed()
                .mul_f64(now.goal.saturating_sub(now.samples) as f64 / done as f64),
        )
    }

    /// Takes in the messages; the samples, or what went wrong, once it has ended.
    pub fn take(&mut self) -> Option<Result<u64, LabError>> {
        for message in self.messages.try_iter() {
            match message {
                Message::Progress(now) => {
                    self.first.get_or_insert((now.samples, Instant::now()));
                    self.state = Some(now);
                }
                Message::Done(result) => return Some(result),
            }
        }
        None
    }

    /// Ends it, waiting at most so long. Returns the validation messages of its device.
    pub fn stop(mut self, patience: Duration) -> Vec<String> {
        self.cancel();
        let until = Instant::now() + patience;
        let Some(thread) = self.thread.take() else {
            return Vec::new();
        };
        while !thread.is_finished() && Instant::now() < until {
            std::thread::sleep(Duration::from_millis(5));
        }
        // As the engine: a frame that never ends cannot be waited for.
        if thread.is_finished() {
            thread.join().unwrap_or_default()
        } else {
            Vec::new()
        }
    }
}

fn work(
    job: Job,
    mut progress: impl FnMut(Gathered) -> ControlFlow<()>,
) -> (Result<u64, LabError>, Vec<String>) {
    let lab = match Lab::open(job.home, job.gpu) {
        Ok(lab) => lab,
        Err(e) => return (Err(e), Vec::new()),
    };
    let lit = job.experiment.adapted(job.scene);
    let goal = Goal::Samples(job.samples);
    let result = lit.map_err(LabError::from).and_then(|scene| {
        gather(
            &lab,
            &job.experiment,
            &scene,
            job.bounces,
            goal,
            &mut progress,
        )
    });
    (result.map(|r| r.samples), lab.gpu.messages())
}
