//! The engine: a thread with a device of its own, which renders the window's requests.
//!
//! The window has a second device. So it answers while a frame takes seconds, and a shader which
//! hangs or kills its device takes nothing else with it. Pictures stay in the memory of the
//! physical device where both are on the same one and it can share memory; else each goes through
//! main memory (8 MB at 1080p, about a millisecond each way).

mod background;
mod builder;
mod converge;
pub mod error_worker;
mod frames;
pub(crate) mod guard;
mod pictures;
mod pulse;
mod reconcile;
mod renderdoc;
pub mod report;
mod scenes;

use crate::diagnostics::panics::said;
use crate::lab::{Lab, LabError, Loaded, Session, Workspace};
use crate::results::timers::Rows;
use crate::scene::{Scene, SceneError};
use crate::vulkan::GpuOptions;
use crate::workbench::background::Wake;
use crate::workbench::desired::request::RenderRequest;
use builder::{Done, Job, Key};
use converge::Need;
use crossbeam_channel::{Receiver, Sender, select, unbounded};
use error_worker::{ErrorQuery, ErrorRequest};
use pulse::Pulse;
use report::{DeviceReport, Report};
use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Orders of the window to the engine, in addition to the desired state.
pub enum Order {
    /// The desired state changed.
    Reconcile,
    /// Save what side A or B shows, under a name; with these resources, and with times on the
    /// picture.
    Capture(usize, String, Vec<String>, Rows),
    /// Measure the error of what side A or B shows against its reference.
    MeasureError(usize, ErrorQuery),
    /// Ask the driver about the pipelines of side A or B.
    PipelineStatistics(usize),
    /// Render this number of further frames of the same picture, to measure.
    Frames(u32),
    /// Stop the loading of a scene.
    CancelLoading,
    /// Capture a frame with RenderDoc.
    RenderDoc,
    /// Restart the device.
    Restart,
    /// End.
    Quit,
}

/// A request, and how many there were.
type Numbered = (u64, RenderRequest);

/// The window's end of an engine.
pub struct Engine {
    desired: Arc<Mutex<Numbered>>,
    orders: Sender<Order>,
    /// Messages from the engine.
    pub reports: Receiver<Report>,
    thread: Option<std::thread::JoinHandle<Vec<String>>>,
    pulse: Arc<Pulse>,
}

impl Engine {
    /// Starts the engine; `wake` is called after each report.
    pub fn start(home: Workspace, options: GpuOptions, wake: Wake) -> Engine {
        Engine::begin(home, options, wake, None)
    }

    /// Starts an engine in the place of one that failed. It waits for a change of what is
    /// requested, or to be restarted: the same again would fail again.
    pub fn replace(
        home: Workspace,
        options: GpuOptions,
        wake: Wake,
        failed: (u64, RenderRequest),
    ) -> Engine {
        Engine::begin(home, options, wake, Some(failed))
    }

    fn begin(home: Workspace, options: GpuOptions, wake: Wake, failed: Option<Numbered>) -> Engine {
        let waits = failed.is_some();
        let patience = Some(options.patience.unwrap_or(FRAME_PATIENCE));
        let options = GpuOptions {
            patience,
            ..options
        };
        let pulse = Arc::new(Pulse::new(options.patience));
        let heart = pulse.clone();
        let desired = Arc::new(Mutex::new(failed.unwrap_or_default()));
        let (orders, inbox) = unbounded();
        let (outbox, reports) = unbounded();
        let out = Out {
            reports: outbox,
            wake,
        };
        let shared = desired.clone();
        let thread =
            std::thread::spawn(move || run(home, options, &shared, &inbox, &out, &heart, waits));
        Engine {
            desired,
            orders,
            reports,
            thread: Some(thread),
            pulse,
        }
    }

    /// Why the engine is no longer there to render: its thread has ended, or stands still in the
    /// driver.
    pub fn failure(&mut self) -> Option<String> {
        if self
            .thread
            .as_ref()
            .is_some_and(std::thread::JoinHandle::is_finished)
        {
            let ended = self.thread.take().map(std::thread::JoinHandle::join);
            let said = ended
                .and_then(Result::err)
                .map_or(String::new(), |p| format!(": {}", said(p.as_ref())));
            return Some(format!("the renderer crashed{said}"));
        }
        let silent = self.pulse.silent()?;
        Some(format!(
            "the renderer has not answered for {:.0} s: the driver is not responding",
            silent.as_secs_f64()
        ))
    }

    /// Whether something is expected of the engine, so that [`Engine::failure`] is worth asking.
    pub fn works(&self) -> bool {
        self.pulse.beats()
    }

    /// Works towards this from now on. Requests are numbered in their order: what answers one says
    /// its number.
    pub fn request(&self, number: u64, request: RenderRequest) {
        let mut desired = self.desired.lock().unwrap_or_else(PoisonError::into_inner);
        *desired = (number, request);
        drop(desired);
        self.order(Order::Reconcile);
    }

    /// Gives an order.
    pub fn order(&self, order: Order) {
        // An engine that has ended needs no orders.
        let _ = self.orders.send(order);
    }

    /// Ends the engine: waits for the frame in work, at most so long. Returns the validation
    /// messages of its device.
    pub fn stop(mut self, patience: Duration) -> Vec<String> {
        self.order(Order::Quit);
        let until = Instant::now() + patience;
        let Some(thread) = self.thread.take() else {
            return Vec::new();
        };
        while !thread.is_finished() && Instant::now() < until {
            std::thread::sleep(Duration::from_millis(5));
        }
        // A shader that never ends cannot be waited for; the thread ends with the program.
        if thread.is_finished() {
            thread.join().unwrap_or_default()
        } else {
            Vec::new()
        }
    }
}

#[derive(Clone)]
struct Out {
    reports: Sender<Report>,
    wake: Wake,
}

impl Out {
    fn send(&self, report: Report) {
        if self.reports.send(report).is_ok() {
            (self.wake)();
        }
    }
}

/// A frame that was submitted.
struct Submitted {
    request: u64,
    time: f64,
    frame: u64,
    size: (u32, u32),
}

#[derive(Default)]
struct Side {
    session: Option<Box<Session>>,
    loaded: Option<Loaded>,
    /// The inputs of the session.
    key: Option<Key>,
    /// What could not be built.
    failed: Option<Key>,
    preview: bool,
    /// When the build in work began.
    building: Option<Instant>,
    submitted: VecDeque<Submitted>,
    frame: u64,
    /// GPU time of the last frame known, ms.
    last_ms: f64,
    /// The last request that the session, or the failure to build one, answers.
    answered: u64,
    /// Frames still to render.
    frames_left: u32,
    /// The last ones of these, which refine a picture that has converged.
    refining: u32,
    /// Frames among these that are rendered even if the picture has converged.
    least_left: u32,
    /// Remaining frames at the last request.
    frames_asked: u32,
    /// Whether no frame has run since its histories were empty.
    fresh: bool,
    lights: bool,
    checked: Option<Key>,
    /// Pictures for the window's device.
    ring: pictures::Ring,
    /// The last frame reported, if its pixels are not in main memory yet.
    owes: Option<u64>,
}

struct Run<'a> {
    lab: Lab,
    out: &'a Out,
    desired: RenderRequest,
    /// Number of the desired state.
    number: u64,
    sides: [Side; 2],
    jobs: Sender<Job>,
    error_requests: Sender<ErrorRequest>,
    scene: Option<Arc<Scene>>,
    /// Name and revision of the loaded scene, and the number of loads.
    scene_key: Option<(String, String, u64)>,
    /// The same of the scene that is there.
    loaded_key: Option<(String, String, u64)>,
    scene_number: u64,
    /// A scene with another number of lights, and the number of the scene that it is made from.
    lit: Option<(u64, Arc<Scene>)>,
    loading: Option<Arc<AtomicBool>>,
    loaded: Sender<SceneResult>,
    clock: Clocked,
    turn: usize,
    /// Whether A and B restart together once both show their requests.
    restarts: bool,
    renderdoc: bool,
    last_read_back: Instant,
    last_thumbnails: Instant,
    last_rendered: Instant,
    /// Whether the next frame had to wait for the window.
    waited: bool,
}

/// Time as it goes.
struct Clocked {
    now: f64,
    last: Instant,
    steps: u64,
    jumps: u64,
}

fn run(
    home: Workspace,
    options: GpuOptions,
    desired: &Mutex<Numbered>,
    inbox: &Receiver<Order>,
    out: &Out,
    pulse: &Pulse,
    mut waits: bool,
) -> Vec<String> {
    let mut messages = Vec::new();
    loop {
        if std::mem::take(&mut waits) {
            pulse.rest();
            // An unchanged request must not be tried again: it may kill the device each time.
            for order in inbox {
                match order {
                    Order::Quit => return messages,
                    Order::Restart | Order::Reconcile => break,
                    _ => {}
                }
            }
        }
        pulse.beat();
        match session(
            home.clone(),
            &options,
            desired,
            inbox,
            (out, pulse),
            &mut messages,
        ) {
            Ok(End::Quit) => return messages,
            Ok(End::Restart) => {}
            Err(e) => {
                out.send(Report::DeviceFailed(format!(
                    "{e}. Change a shader or a value, or press Restart device"
                )));
                waits = true;
            }
        }
    }
}

/// Why a device was closed.
enum End {
    Quit,
    Restart,
}

/// One life of a device.
fn session(
    home: Workspace,
    options: &GpuOptions,
    desired: &Mutex<Numbered>,
    inbox: &Receiver<Order>,
    (out, pulse): (&Out, &Pulse),
    messages: &mut Vec<String>,
) -> Result<End, LabError> {
    let lab = Lab::open(home, options.clone())?;
    let gpu = lab.gpu.clone();
    pulse.frames_take(gpu.patience());
    out.send(Report::Device(DeviceReport {
        name: gpu.info.name.clone(),
        driver: gpu.info.driver.clone(),
    }));
    let (jobs, job_box) = unbounded();
    let (done_out, done) = unbounded();
    let (loaded_out, loaded) = unbounded();
    let builder = std::thread::spawn(move || builder::run(&job_box, &done_out));
    let (error_requests, error_inbox) = unbounded();
    let results = out.clone();
    let worker =
        std::thread::spawn(move || error_worker::run(&error_inbox, &|report| results.send(report)));
    let inboxes = Inboxes {
        orders: inbox,
        builds: done,
        scenes: loaded,
    };
    let mut run = Run::new(lab, out, jobs, error_requests, loaded_out);
    run.change(latest(desired))?;
    let result = loop {
        let inputs = inboxes.take(&run, pulse);
        if inputs.orders.iter().any(|o| matches!(o, Order::Quit)) {
            break Ok(End::Quit);
        }
        if inputs.orders.iter().any(|o| matches!(o, Order::Restart)) {
            break Ok(End::Restart);
        }
        let step = match inputs.rests {
            true => run.pay_pixels(),
            false => run.handle(inputs, desired).and_then(|()| run.render()),
        };
        if let Err(e) = step {
            break Err(e);
        }
    };
    if let Some(cancel) = &run.loading {
        cancel.store(true, Ordering::Relaxed);
    }
    drop(run);
    // Running builds hold the device, and their results are dropped. They keep a device that hangs.
    while !(builder.is_finished() && worker.is_finished() || gpu.is_hung()) {
        pulse.beat();
        let _ = inboxes.builds.recv_timeout(Duration::from_millis(10));
    }
    messages.extend(gpu.messages());
    result
}

/// The latest request.
fn latest(desired: &Mutex<Numbered>) -> Numbered {
    let desired = desired.lock();
    desired.unwrap_or_else(PoisonError::into_inner).clone()
}

type SceneResult = Result<Arc<Scene>, SceneError>;

/// The inboxes of the engine's thread.
struct Inboxes<'a> {
    orders: &'a Receiver<Order>,
    builds: Receiver<Done>,
    scenes: Receiver<SceneResult>,
}

/// Messages of other threads.
#[derive(Default)]
struct Inputs {
    orders: Vec<Order>,
    builds: Vec<Done>,
    scenes: Vec<SceneResult>,
    /// Whether there was none for a while.
    rests: bool,
}

impl Inboxes<'_> {
    /// Takes all messages. Waits for one if there is nothing to render.
    fn take(&self, run: &Run<'_>, pulse: &Pulse) -> Inputs {
        let mut inputs = Inputs::default();
        let Inputs {
            orders,
            builds,
            scenes,
            rests,
        } = &mut inputs;
        if !run.busy() {
            pulse.rest();
            let wait = match run.owes_pixels() {
                true => crossbeam_channel::after(REST),
                false => crossbeam_channel::never(),
            };
            select! {
                recv(self.orders) -> order => orders.push(order.unwrap_or(Order::Quit)),
                recv(self.builds) -> done => builds.extend(done),
                recv(self.scenes) -> scene => scenes.extend(scene),
                recv(wait) -> _ => *rests = true,
            }
        } else if run.awaits_build() {
            select! {
                recv(self.orders) -> order => orders.push(order.unwrap_or(Order::Quit)),
                recv(self.builds) -> done => builds.extend(done),
                default(Duration::from_millis(10)) => {}
            }
        }
        pulse.beat();
        orders.extend(self.orders.try_iter());
        builds.extend(self.builds.try_iter());
        scenes.extend(self.scenes.try_iter());
        inputs
    }
}

impl<'a> Run<'a> {
    fn new(
        lab: Lab,
        out: &'a Out,
        jobs: Sender<Job>,
        error_requests: Sender<ErrorRequest>,
        loaded: Sender<SceneResult>,
    ) -> Run<'a> {
        Run {
            lab,
            out,
            desired: RenderRequest::default(),
            number: 0,
            sides: Default::default(),
            jobs,
            error_requests,
            scene: None,
            scene_key: None,
            loaded_key: None,
            scene_number: 0,
            lit: None,
            loading: None,
            loaded,
            clock: Clocked {
                now: 0.0,
                last: Instant::now(),
                steps: 0,
                jumps: 0,
            },
            turn: 0,
            restarts: false,
            renderdoc: false,
            last_read_back: Instant::now(),
            last_thumbnails: Instant::now(),
            last_rendered: Instant::now(),
            waited: false,
        }
    }
}

impl Run<'_> {
    fn busy(&self) -> bool {
        self.sides
            .iter()
            .any(|s| s.session.is_some() && s.frames_left > 0)
    }

    /// Whether a build is about to finish, so that a long frame of the old session would only delay
    /// it.
    fn awaits_build(&self) -> bool {
        let soon = |since: Instant| since.elapsed() < PATIENCE;
        self.sides
            .iter()
            .any(|s| s.last_ms > LONG && s.building.is_some_and(soon))
    }

    fn handle(&mut self, inputs: Inputs, desired: &Mutex<Numbered>) -> Result<(), LabError> {
        for scene in inputs.scenes {
            self.scene_came(scene)?;
        }
        for done in inputs.builds {
            self.built(done)?;
        }
        for order in inputs.orders {
            match order {
                Order::CancelLoading => {
                    if let Some(cancel) = &self.loading {
                        cancel.store(true, Ordering::Relaxed);
                    }
                }
                Order::Capture(side, name, resources, timers) => {
                    self.capture(side, name, resources, timers)
                }
                Order::MeasureError(side, query) => self.measure_error(side, query),
                Order::PipelineStatistics(side) => self.pipeline_statistics(side),
                Order::Frames(count) => self.request_frames(Need::Frames(count)),
                Order::RenderDoc => {
                    self.renderdoc = true;
                    self.request_frames(Need::Frames(1));
                }
                Order::Reconcile | Order::Quit | Order::Restart => {}
            }
        }
        let latest = latest(desired);
        if latest.0 != self.number {
            self.change(latest)?;
        }
        Ok(())
    }

    /// Asks the driver about a side's pipelines on a thread of its own: compiling may take seconds.
    fn pipeline_statistics(&self, side: usize) {
        let Some(session) = &self.sides[side].session else {
            return;
        };
        let (request, out) = (session.program.statistics(), self.out.clone());
        std::thread::spawn(move || {
            let result = guard::guarded(|| request.run());
            let result = result.and_then(|asked| asked.map_err(|e| e.to_string()));
            out.send(Report::Statistics(side, result));
        });
    }

    /// Takes in a new request.
    fn change(&mut self, (number, desired): Numbered) -> Result<(), LabError> {
        self.number = number;
        let old = std::mem::replace(&mut self.desired, desired);
        if self.desired.clock.jumps != self.clock.jumps {
            self.clock.jumps = self.desired.clock.jumps;
            self.clock.now = self.desired.clock.at;
        }
        if self.desired.clock.playing && !old.clock.playing {
            self.clock.last = Instant::now();
        }
        if self.desired.lights != old.lights {
            for side in &mut self.sides {
                side.lights = true;
            }
        }
        let unseen_sides = RenderRequest {
            sides: old.sides.clone(),
            ..RenderRequest::default()
        };
        // Files, parameters and sizes ask for frames when what they lead to has been built. While
        // another scene is loaded, and when it cannot be, the one before answers.
        let new = &self.desired;
        let unseen = RenderRequest {
            sides: new.sides.clone(),
            size: new.size,
            revision: new.revision,
            scene_revision: new.scene_revision,
            window: new.window,
            bytes: new.bytes,
            ..old
        };
        let need = Need::between(&unseen, &self.desired);
        let pairs = |request: &RenderRequest| match &request.sides {
            [Some(a), Some(b)] => Some(a == b),
            _ => None,
        };
        let (before, now) = (pairs(&unseen_sides), pairs(&self.desired));
        self.restarts |=
            now.is_some() && (before.is_none() || now == Some(true) && before == Some(false));
        if let Some(need) = need {
            self.request_frames(need);
        }
        for i in 0..2 {
            if self.desired.sides[i].is_none() {
                self.sides[i] = Side {
                    building: self.sides[i].building,
                    ..Side::default()
                };
            }
        }
        self.load_scene();
        for i in 0..2 {
            self.reconcile(i)?;
        }
        Ok(())
    }
}

/// How long a frame may take before the device counts as hung, unless the options say otherwise.
const FRAME_PATIENCE: Duration = Duration::from_secs(20);

/// A frame as long as this is worth waiting for, ms.
const LONG: f64 = 4.0;

/// How long nothing is to be done before the last picture is brought into main memory.
const REST: Duration = Duration::from_millis(60);

/// How long frames wait for a build.
const PATIENCE: Duration = Duration::from_millis(300);
