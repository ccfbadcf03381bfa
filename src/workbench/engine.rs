//! The engine: a thread with a device of its own, which renders what the window wishes for.
//!
//! The window has a second device. That costs a copy of each picture through main memory (8 MB at 1080p, about a
//! millisecond each way) and buys that the window answers while a frame takes seconds, and that a shader which hangs
//! or kills its device takes nothing else with it.

use super::builder::{self, Done, Job, Key};
use super::judge::{self, Case, Judged, Question};
use super::keep;
use super::report::{DeviceReport, Outline, PictureReport, Report};
use super::wish::{Look, SlotWish, Wish};
use crate::graph::run::FrameTimes;
use crate::graph::source::{Diagnostic, Place};
use crate::graph::usage::Res;
use crate::lab::{Home, Lab, LabError, Loaded, Session, params_of};
use crate::scene::{Scene, SceneError};
use crate::vulkan::{GpuOptions, VulkanError};
use crossbeam_channel::{Receiver, Sender, select, unbounded};
use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// What the window asks of the engine, beside its wish.
pub enum Order {
    /// The wish changed.
    Look,
    /// Save what slot A or B shows, under a name; with these resources.
    Capture(usize, String, Vec<String>),
    /// Say how far what slot A or B shows is from its reference.
    Judge(usize, Question),
    /// Render so many more frames of what is shown, to measure.
    Frames(u32),
    /// Stop the loading of a scene.
    CancelLoading,
    /// Capture a frame with RenderDoc.
    RenderDoc,
    /// Open the device anew.
    Restart,
    /// End.
    Quit,
}

/// The window's end of an engine.
pub struct Engine {
    wish: Arc<Mutex<Wish>>,
    orders: Sender<Order>,
    /// News.
    pub reports: Receiver<Report>,
    thread: Option<std::thread::JoinHandle<Vec<String>>>,
}

impl Engine {
    /// Starts the engine; `wake` is called after each report.
    pub fn start(home: Home, options: GpuOptions, wake: Arc<dyn Fn() + Send + Sync>) -> Engine {
        let wish = Arc::new(Mutex::new(Wish::default()));
        let (orders, inbox) = unbounded();
        let (outbox, reports) = unbounded();
        let out = Out { reports: outbox, wake };
        let shared = wish.clone();
        let thread = std::thread::spawn(move || run(home, options, &shared, &inbox, &out));
        Engine { wish, orders, reports, thread: Some(thread) }
    }

    /// Works towards this from now on.
    pub fn wish(&self, wish: Wish) {
        *self.wish.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = wish;
        self.order(Order::Look);
    }

    /// Gives an order.
    pub fn order(&self, order: Order) {
        // An engine that has ended needs no orders.
        let _ = self.orders.send(order);
    }

    /// Ends the engine: waits for the frame in work, at most so long. Returns the validation messages of its device.
    pub fn stop(mut self, patience: Duration) -> Vec<String> {
        self.order(Order::Quit);
        let until = Instant::now() + patience;
        let Some(thread) = self.thread.take() else { return Vec::new() };
        while !thread.is_finished() && Instant::now() < until {
            std::thread::sleep(Duration::from_millis(5));
        }
        // A shader that never ends cannot be waited for; the thread ends with the program.
        if thread.is_finished() { thread.join().unwrap_or_default() } else { Vec::new() }
    }
}

#[derive(Clone)]
struct Out {
    reports: Sender<Report>,
    wake: Arc<dyn Fn() + Send + Sync>,
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
    wish: u64,
    time: f64,
    frame: u64,
}

#[derive(Default)]
struct Slot {
    session: Option<Box<Session>>,
    loaded: Option<Loaded>,
    /// What the session was built from.
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
    /// The last wish that the session, or the failure to build one, answers.
    answered: u64,
    /// Frames still to render before the slot rests.
    due: u32,
    lights: bool,
    checked: Option<Key>,
    looked: Option<Look>,
}

struct Run<'a> {
    lab: Lab,
    out: &'a Out,
    wish: Wish,
    slots: [Slot; 2],
    jobs: Sender<Job>,
    cases: Sender<Case>,
    scene: Option<Arc<Scene>>,
    /// What was loaded: name, revision; and how many scenes were.
    scene_key: Option<(String, u64)>,
    scene_number: u64,
    loading: Option<Arc<AtomicBool>>,
    loaded: Sender<Result<Arc<Scene>, SceneError>>,
    clock: Clocked,
    turn: usize,
    renderdoc: bool,
    last_look: Instant,
}

/// Time as it goes.
struct Clocked {
    now: f64,
    last: Instant,
    steps: u64,
    jumps: u64,
}

fn run(home: Home, options: GpuOptions, wish: &Mutex<Wish>, inbox: &Receiver<Order>, out: &Out) -> Vec<String> {
    let mut messages = Vec::new();
    loop {
        match session(home.clone(), &options, wish, inbox, out, &mut messages) {
            Ok(End::Quit) => return messages,
            Ok(End::Restart) => {}
            Err(e) => {
                out.send(Report::Trouble(format!("{e}. Change a shader or a value, or press Restart device")));
                // What was wished for must not be tried again unchanged: it may kill the device each time.
                for order in inbox {
                    match order {
                        Order::Quit => return messages,
                        Order::Restart | Order::Look => break,
                        _ => {}
                    }
                }
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
    home: Home,
    options: &GpuOptions,
    wish: &Mutex<Wish>,
    inbox: &Receiver<Order>,
    out: &Out,
    messages: &mut Vec<String>,
) -> Result<End, LabError> {
    let lab = Lab::open(home, options.clone())?;
    let gpu = lab.gpu.clone();
    out.send(Report::Device(DeviceReport { name: gpu.info.name.clone(), driver: gpu.info.driver.clone() }));
    let (jobs, job_box) = unbounded();
    let (done_out, done) = unbounded();
    let (loaded_out, loaded) = unbounded();
    let builder = std::thread::spawn(move || builder::run(&job_box, &done_out));
    let (cases, case_box) = unbounded();
    let told = out.clone();
    let judge = std::thread::spawn(move || judge::run(&case_box, &|report| told.send(report)));
    let mut run = Run {
        lab,
        out,
        wish: Wish::default(),
        slots: Default::default(),
        jobs,
        cases,
        scene: None,
        scene_key: None,
        scene_number: 0,
        loading: None,
        loaded: loaded_out,
        clock: Clocked { now: 0.0, last: Instant::now(), steps: 0, jumps: 0 },
        turn: 0,
        renderdoc: false,
        last_look: Instant::now(),
    };
    run.change(wish.lock().unwrap_or_else(std::sync::PoisonError::into_inner).clone())?;
    let result = loop {
        let (idle, awaits) = (!run.busy(), run.awaits_build());
        let mut orders: Vec<Order> = Vec::new();
        let mut builds: Vec<Done> = Vec::new();
        let mut scenes = Vec::new();
        if idle {
            select! {
                recv(inbox) -> order => orders.push(order.unwrap_or(Order::Quit)),
                recv(done) -> d => builds.extend(d),
                recv(loaded) -> l => scenes.extend(l),
            }
        } else if awaits {
            select! {
                recv(inbox) -> order => orders.push(order.unwrap_or(Order::Quit)),
                recv(done) -> d => builds.extend(d),
                default(Duration::from_millis(10)) => {}
            }
        }
        orders.extend(inbox.try_iter());
        builds.extend(done.try_iter());
        scenes.extend(loaded.try_iter());
        if orders.iter().any(|o| matches!(o, Order::Quit)) {
            break Ok(End::Quit);
        }
        if orders.iter().any(|o| matches!(o, Order::Restart)) {
            break Ok(End::Restart);
        }
        let step = run.handle(orders, builds, scenes, wish).and_then(|()| run.render());
        if let Err(e) = step {
            break Err(e);
        }
    };
    if let Some(cancel) = &run.loading {
        cancel.store(true, Ordering::Relaxed);
    }
    drop(run);
    // Builds in work hold the device; what they send goes nowhere.
    while !(builder.is_finished() && judge.is_finished()) {
        let _ = done.recv_timeout(Duration::from_millis(10));
    }
    messages.extend(gpu.messages());
    result
}

impl Run<'_> {
    fn busy(&self) -> bool {
        self.slots.iter().any(|s| s.session.is_some() && s.due > 0)
    }

    /// Whether a build is about to be done, so that beginning a long frame of what it replaces would only delay it.
    fn awaits_build(&self) -> bool {
        let soon = |since: Instant| since.elapsed() < PATIENCE;
        self.slots.iter().any(|s| s.last_ms > LONG && s.building.is_some_and(soon))
    }

    fn handle(
        &mut self,
        orders: Vec<Order>,
        builds: Vec<Done>,
        scenes: Vec<Result<Arc<Scene>, SceneError>>,
        wish: &Mutex<Wish>,
    ) -> Result<(), LabError> {
        for scene in scenes {
            self.scene_came(scene)?;
        }
        for done in builds {
            self.built(done)?;
        }
        for order in orders {
            match order {
                Order::CancelLoading => {
                    if let Some(cancel) = &self.loading {
                        cancel.store(true, Ordering::Relaxed);
                    }
                }
                Order::Capture(slot, name, resources) => self.capture(slot, name, resources),
                Order::Judge(slot, question) => self.judge(slot, question),
                Order::Frames(count) => self.disturb(count),
                Order::RenderDoc => {
                    self.renderdoc = true;
                    self.disturb(1);
                }
                Order::Look | Order::Quit | Order::Restart => {}
            }
        }
        let latest = wish.lock().unwrap_or_else(std::sync::PoisonError::into_inner).clone();
        if latest.number != self.wish.number {
            self.change(latest)?;
        }
        Ok(())
    }

    /// Works through a new wish.
    fn change(&mut self, wish: Wish) -> Result<(), LabError> {
        let old = std::mem::replace(&mut self.wish, wish);
        if self.wish.clock.jumps != self.clock.jumps {
            self.clock.jumps = self.wish.clock.jumps;
            self.clock.now = self.wish.clock.at;
        }
        if self.wish.clock.playing && !old.clock.playing {
            self.clock.last = Instant::now();
        }
        if self.wish.lights != old.lights {
            for slot in &mut self.slots {
                slot.lights = true;
            }
        }
        // Files, parameters and sizes disturb a slot when what they lead to has been built.
        let seen = |w: &Wish| (w.camera, w.clock, w.continuous, w.look.clone(), w.table);
        if seen(&self.wish) != seen(&old) || self.wish.lights != old.lights || self.wish.path != old.path {
            self.disturb(1);
        }
        for i in 0..2 {
            if self.wish.slots[i].is_none() {
                self.slots[i] = Slot { building: self.slots[i].building, ..Slot::default() };
            }
        }
        self.load_scene();
        for i in 0..2 {
            self.approach(i)?;
        }
        Ok(())
    }

    /// Frames are due: as many as it takes until those with a memory have settled.
    fn disturb(&mut self, least: u32) {
        for slot in &mut self.slots {
            let settle = if slot.session.as_ref().is_some_and(|s| remembers(s)) { SETTLE } else { 1 };
            slot.due = slot.due.max(least.max(settle));
        }
    }

    fn load_scene(&mut self) {
        let key = (self.wish.scene.clone(), self.wish.scene_revision);
        if key.0.is_empty() || self.scene_key.as_ref() == Some(&key) {
            return;
        }
        self.scene_key = Some(key.clone());
        if let Some(cancel) = self.loading.take() {
            cancel.store(true, Ordering::Relaxed);
        }
        let cancel = Arc::new(AtomicBool::new(false));
        self.loading = Some(cancel.clone());
        let (out, loaded) = (self.out.clone(), self.loaded.clone());
        out.send(Report::Loading(key.0.clone(), 0.0));
        std::thread::spawn(move || {
            let last = Mutex::new(Instant::now());
            let scene = Scene::open(&key.0, &|what, part| {
                if cancel.load(Ordering::Relaxed) {
                    return ControlFlow::Break(());
                }
                // The window need not hear of every texture.
                if let Ok(mut last) = last.lock()
                    && last.elapsed() > Duration::from_millis(30)
                {
                    *last = Instant::now();
                    out.send(Report::Loading(what.to_string(), part));
                }
                ControlFlow::Continue(())
            });
            // A load that was replaced by another has nobody to tell.
            if !cancel.load(Ordering::Relaxed) || matches!(scene, Err(SceneError::Cancelled)) {
                let _ = loaded.send(scene.map(Arc::new));
            }
        });
    }

    fn scene_came(&mut self, scene: Result<Arc<Scene>, SceneError>) -> Result<(), LabError> {
        match scene {
            Ok(scene) => {
                self.loading = None;
                self.scene = Some(scene.clone());
                self.scene_number += 1;
                self.out.send(Report::Loaded(scene));
                for i in 0..2 {
                    self.approach(i)?;
                }
            }
            Err(SceneError::Cancelled) => {
                // Cancelled for another scene, the other is being loaded by now.
                if self.loading.as_ref().is_some_and(|c| c.load(Ordering::Relaxed)) {
                    self.loading = None;
                    self.out.send(Report::LoadFailed("loading was cancelled".into()));
                }
            }
            Err(e) => {
                self.loading = None;
                self.out.send(Report::LoadFailed(e.to_string()));
            }
        }
        Ok(())
    }

    fn key(&self, slot: &SlotWish, number: usize) -> Key {
        let mut wanted = Vec::new();
        if let Some(look) = self.wish.look.as_ref().filter(|l| l.slot == number) {
            wanted.push(look.texture.clone());
        }
        if number == 0
            && let (Some(table), Some(loaded)) = (self.wish.table, &self.slots[0].loaded)
            && let Some(table) = loaded.graph.tables.get(table)
        {
            wanted.push(table.buffer.value.clone());
        }
        Key {
            graph: slot.graph.clone(),
            params: slot.params.clone(),
            size: self.wish.size,
            revision: self.wish.revision,
            scene: self.scene_number,
            wanted,
        }
    }

    /// Brings a slot nearer to what is wished for: sets values, or starts a build.
    fn approach(&mut self, number: usize) -> Result<(), LabError> {
        let Some(wish) = self.wish.slots[number].clone() else { return Ok(()) };
        let Some(scene) = self.scene.clone() else { return Ok(()) };
        if self.wish.size.0 == 0 || self.wish.size.1 == 0 {
            return Ok(());
        }
        let key = self.key(&wish, number);
        let experiment = self.wish.experiment(&wish);
        let slot = &mut self.slots[number];
        if slot.key.as_ref() == Some(&key) {
            // What failed meanwhile is taken back.
            slot.failed = None;
            slot.answered = self.wish.number;
            return Ok(());
        }
        if slot.failed.as_ref() == Some(&key) {
            slot.answered = self.wish.number;
            return Ok(());
        }
        let same_files = |k: &Key| k.graph == key.graph && k.revision == key.revision;
        if let (Some(session), Some(old), Some(loaded)) = (&mut slot.session, &slot.key, &slot.loaded)
            && !slot.preview
            && same_files(old)
            && (old.size, old.scene, &old.wanted) == (key.size, key.scene, &key.wanted)
        {
            let set = params_of(&loaded.graph, &experiment)
                .and_then(|params| Ok(session.set_params(&self.lab, &params)?.then_some(params)));
            match set {
                Ok(Some(params)) => {
                    slot.key = Some(key);
                    slot.failed = None;
                    slot.answered = self.wish.number;
                    self.out.send(Report::Set { slot: number, params });
                    self.disturb(1);
                    return Ok(());
                }
                Ok(None) => {}
                Err(error) => {
                    self.fail(number, key, error)?;
                    return Ok(());
                }
            }
        }
        // B starts with what it can share with A, and the other way round.
        let beside = self.slots[1 - number].session.as_ref().filter(|_| self.slots[number].session.is_none());
        let lent = beside.map(|s| s.lend());
        let preview_exists = self.lab.home.folders().passes.join("preview.ron").is_file();
        let slot = &mut self.slots[number];
        if slot.building.is_some() {
            return Ok(());
        }
        // The first picture of all comes from a graph of two small shaders.
        let preview = slot.session.is_none() && number == 0 && preview_exists;
        let mut experiment = experiment;
        if preview {
            experiment.graph = "preview.ron".into();
            experiment.params.clear();
        }
        let loaded = slot.loaded.clone().filter(|_| !slot.preview && slot.key.as_ref().is_some_and(same_files));
        let seed = slot.session.as_ref().map(|s| s.seed()).or(lent);
        slot.building = Some(Instant::now());
        let lab = self.lab.clone();
        let _ = self.jobs.send(Job { slot: number, key, experiment, scene, seed, loaded, preview, lab });
        Ok(())
    }

    fn built(&mut self, done: Done) -> Result<(), LabError> {
        let number = done.slot;
        self.slots[number].building = None;
        if self.wish.slots[number].is_none() {
            return Ok(());
        }
        match done.result {
            Ok((mut session, loaded)) => {
                let slot = &mut self.slots[number];
                if let Some(mut old) = slot.session.take() {
                    let finished = old.finish()?;
                    self.tell(number, finished);
                    session.succeed(&mut old)?;
                }
                let slot = &mut self.slots[number];
                slot.preview = done.preview;
                slot.lights = true;
                slot.looked = None;
                slot.failed = None;
                let outline = outline(&session, &loaded);
                let change = session.program.change;
                slot.session = Some(session);
                slot.loaded = Some(loaded);
                if done.preview {
                    slot.key = None;
                } else {
                    slot.key = Some(done.key.clone());
                    let ms = done.start.elapsed().as_secs_f64() * 1e3;
                    let revision = done.key.revision;
                    let objects = Arc::strong_count(&self.lab.gpu);
                    let outline = Arc::new(outline);
                    self.out.send(Report::Built { slot: number, outline, change, ms, revision, objects });
                }
                self.disturb(1);
            }
            Err(error) if done.preview => {
                // Whatever is wrong will be said by the graph itself; here is none to fall back to.
                self.out.send(Report::Trouble(format!("no preview: {error}")));
                let key = self.wish.slots[number].clone().map(|w| self.key(&w, number));
                self.slots[number].failed = None;
                if let (Some(key), Some(scene), Some(wish)) = (key, self.scene.clone(), &self.wish.slots[number]) {
                    let experiment = self.wish.experiment(wish);
                    self.slots[number].building = Some(Instant::now());
                    let (seed, loaded, lab) = (None, None, self.lab.clone());
                    let job = Job { slot: number, key, experiment, scene, seed, loaded, preview: false, lab };
                    let _ = self.jobs.send(job);
                }
                return Ok(());
            }
            Err(error) => self.fail(number, done.key, error)?,
        }
        self.approach(number)
    }

    /// Says what is wrong; what ran runs on. Only a lost device is an error of the engine.
    fn fail(&mut self, number: usize, key: Key, error: LabError) -> Result<(), LabError> {
        if let LabError::Vulkan(VulkanError::Lost(_)) = error {
            return Err(error);
        }
        let revision = key.revision;
        self.slots[number].failed = Some(key);
        let diagnostics = match error {
            LabError::Input(list) => list,
            other => vec![Diagnostic::error(Place::default(), other.to_string())],
        };
        self.out.send(Report::Failed { slot: number, diagnostics, revision });
        Ok(())
    }

    /// Renders what is due, A and B in turns, so that neither always finds the clocks raised by the other.
    fn render(&mut self) -> Result<(), LabError> {
        if self.awaits_build() {
            return Ok(());
        }
        let stepping = self.tick();
        let rest = !(self.wish.continuous || stepping);
        self.turn += 1;
        for i in 0..2 {
            let number = (i + self.turn) % 2;
            if self.slots[number].session.is_some() && self.slots[number].due > 0 {
                self.frame(number, rest)?;
            }
        }
        Ok(())
    }

    /// Moves time on; whether it goes.
    fn tick(&mut self) -> bool {
        let clock = self.wish.clock;
        let real = self.clock.last.elapsed().as_secs_f64();
        self.clock.last = Instant::now();
        let mut goes = false;
        if clock.playing {
            self.clock.now += clock.step.unwrap_or(real);
            goes = true;
        }
        if clock.steps != self.clock.steps {
            self.clock.now += clock.step.unwrap_or(1.0 / 60.0) * clock.steps.saturating_sub(self.clock.steps) as f64;
            self.clock.steps = clock.steps;
            self.disturb(1);
        }
        goes
    }

    fn frame(&mut self, number: usize, rest: bool) -> Result<(), LabError> {
        let software = self.lab.gpu.info.kind == "cpu";
        let slot = &mut self.slots[number];
        let Some(session) = &mut slot.session else { return Ok(()) };
        if let Some(camera) = &self.wish.camera {
            session.set_camera(camera);
        }
        if let Some(path) = &self.wish.path {
            session.look(&path.at(self.clock.now));
        }
        if std::mem::take(&mut slot.lights) {
            let own = session.scene.clone();
            let (lights, sky) = self.wish.lights.as_ref().map_or((&own.lights, own.sky), |(l, s)| (l, *s));
            session.set_lights(lights, sky);
        }
        session.set_time(self.clock.now);
        slot.frame += 1;
        slot.submitted.push_back(Submitted { wish: slot.answered, time: self.clock.now, frame: slot.frame });
        let renderdoc = std::mem::take(&mut self.renderdoc).then(super::renderdoc::begin);
        let delta = if self.wish.clock.playing { self.wish.clock.step.unwrap_or(0.0) } else { 0.0 };
        let mut finished: Vec<FrameTimes> = session.frame(delta)?.into_iter().collect();
        slot.due -= 1;
        if !rest {
            slot.due = slot.due.max(1);
        }
        // Long frames gain nothing from another one ahead, and an edit would wait for it; a still picture must not wait
        // for the next change.
        let ahead = u64::from(!(software || slot.last_ms > LONG || slot.due == 0 || renderdoc.is_some()));
        finished.extend(session.program.finish_to(ahead)?);
        if let Some(begun) = renderdoc {
            self.out.send(Report::Trouble(super::renderdoc::end(begun)));
        }
        self.tell(number, finished);
        self.look(number)?;
        self.check(number)
    }

    fn tell(&mut self, number: usize, finished: Vec<FrameTimes>) {
        let slot = &mut self.slots[number];
        for times in finished {
            let Some(submitted) = slot.submitted.pop_front() else { continue };
            slot.last_ms = times.gpu_ms;
            let Some(bytes) = times.picture else { continue };
            let size = slot.session.as_ref().map_or(self.wish.size, |s| s.size());
            self.out.send(Report::Picture(PictureReport {
                slot: number,
                wish: submitted.wish,
                revision: slot.key.as_ref().map_or(0, |k| k.revision),
                preview: slot.preview,
                frame: submitted.frame,
                time: submitted.time,
                size: [size.0, size.1],
                bytes: Arc::new(bytes),
                passes: times.passes,
                gpu_ms: times.gpu_ms,
                cpu_ms: times.cpu_ms,
            }));
        }
    }

    /// Reads what the inspector and the table show: at once when still, else some times a second.
    fn look(&mut self, number: usize) -> Result<(), LabError> {
        let slot = &mut self.slots[number];
        let Some(session) = slot.session.as_mut().filter(|_| !slot.preview) else { return Ok(()) };
        let now = slot.due == 0 || self.last_look.elapsed() > Duration::from_millis(150);
        let look = self.wish.look.as_ref().filter(|l| l.slot == number);
        if !now || (look.is_none() && self.wish.table.is_none()) {
            return Ok(());
        }
        self.last_look = Instant::now();
        if let Some(look) = look {
            match session.slice(&look.texture, look.mip, look.layer, look.axis, look.slice) {
                Ok(texels) => {
                    slot.looked = Some(look.clone());
                    self.out.send(Report::Texels(look.clone(), Box::new(texels)));
                }
                Err(LabError::Vulkan(e)) => return Err(e.into()),
                // Not made with these parameters: a build that makes it is on its way, or the window says so.
                Err(_) => {}
            }
        }
        if number == 0
            && let Some(table) = self.wish.table
            && let Some(name) = session.graph.tables.get(table).map(|t| t.buffer.value.clone())
        {
            let bytes = session.buffer(&name)?;
            self.out.send(Report::Table(table, bytes));
        }
        Ok(())
    }

    /// Asks the graph's checks once for each build.
    fn check(&mut self, number: usize) -> Result<(), LabError> {
        let slot = &mut self.slots[number];
        if slot.due > 0 || slot.preview || slot.checked == slot.key {
            return Ok(());
        }
        slot.checked.clone_from(&slot.key);
        if let Some(session) = &mut slot.session {
            let failed = session.failed_checks()?;
            self.out.send(Report::Checks(number, failed));
        }
        Ok(())
    }

    /// Hands what a slot shows to the judge. What is not there yet is asked for again.
    fn judge(&mut self, number: usize, question: Question) {
        let (Some(wish), Some(scene)) = (&self.wish.slots[number], &self.scene) else { return };
        let slot = &self.slots[number];
        let shown = slot.session.as_ref().filter(|_| slot.key.as_ref() == Some(&self.key(wish, number)));
        let (Some(session), Some(loaded)) = (shown, &slot.loaded) else {
            let result = Err("what is asked for is not shown".into());
            self.out.send(Report::Judged(Judged { slot: number, wish: self.wish.number, question, result }));
            return;
        };
        let case = Case {
            slot: number,
            wish: slot.answered,
            revision: self.wish.revision,
            question,
            lab: self.lab.clone(),
            loaded: loaded.clone(),
            seed: session.lend(),
            experiment: keep::still(&self.wish, wish, "judged", self.clock.now, scene),
            scene: scene.clone(),
            lights: self.wish.lights.clone(),
            frames: if remembers(session) { SETTLE } else { 1 },
        };
        let _ = self.cases.send(case);
    }

    /// Captures on a thread of its own, from a fresh start, so that a replay can give the same bits.
    fn capture(&mut self, number: usize, name: String, resources: Vec<String>) {
        let (Some(wish), Some(scene)) = (self.wish.slots[number].clone(), self.scene.clone()) else { return };
        let experiment = keep::experiment(&self.wish, &wish, &name, self.clock.now, Some(&scene));
        let settle = self.slots[number].session.as_ref().is_some_and(|s| remembers(s));
        let frames = if settle { SETTLE as usize } else { 1 };
        let (lab, out) = (self.lab.clone(), self.out.clone());
        let folder = lab.home.root.join("captures");
        std::thread::spawn(move || {
            let result = keep::take(&lab, &experiment, scene, &folder, resources, frames);
            out.send(Report::Captured(result.map_err(|e| e.to_string())));
        });
    }
}

/// A frame as long as this is worth waiting for, ms.
const LONG: f64 = 4.0;

/// How long frames wait for a build.
const PATIENCE: Duration = Duration::from_millis(300);

/// Frames until what is gathered over time has settled.
const SETTLE: u32 = 16;

/// Whether a frame uses what the frame before left.
fn remembers(session: &Session) -> bool {
    session.program.plan.textures.iter().any(|t| t.history && !t.usage.is_empty())
}

fn outline(session: &Session, loaded: &Loaded) -> Outline {
    let plan = &session.program.plan;
    let mut passes: Vec<usize> = Vec::new();
    let mut writes: Vec<(usize, Vec<String>)> = Vec::new();
    for step in &plan.steps {
        if !passes.contains(&step.pass) {
            passes.push(step.pass);
            writes.push((step.pass, Vec::new()));
        }
        for u in step.uses.iter().filter(|u| u.write) {
            let name = match u.res {
                Res::Texture(t, _) => session.graph.textures[t].0.clone(),
                Res::Buffer(b) => session.graph.buffers[b].0.clone(),
            };
            if let Some((_, list)) = writes.iter_mut().find(|w| w.0 == step.pass)
                && !list.contains(&name)
            {
                list.push(name);
            }
        }
    }
    Outline {
        graph: loaded.graph.clone(),
        params: session.params.clone(),
        textures: plan.textures.clone(),
        memory: session.program.memory(&session.graph),
        scene_bytes: session.scene_bytes(),
        passes,
        writes,
        warnings: loaded.warnings.clone(),
    }
}
