//! A plan on a device: its resources, pipelines and descriptor sets, and frames of it.

use super::bindings::{Offered, Sets, StepGpu};
use super::incremental::{Execution, Frame, Versions};
use super::parts::{Change, Parts};
use super::pipelines::{Pipelines, make_pipelines};
use super::record::Recorder;
use super::resources::{self, Resources};
use super::scene::SceneResources;
use super::timeline::{Calibration, Timeline};
use super::transfer::{Update, relayout, send};
use crate::graph::definition::Res;
use crate::graph::evaluated::Evaluated;
use crate::graph::interface::SceneInterface;
use crate::graph::link::Linked;
use crate::graph::plan::{Plan, Schedule, schedule};
use crate::vulkan::{Buffer, Commands, FrameSlot, Gpu, Image, Recording, Result, vk};
use gpu_allocator::MemoryLocation;
use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;

/// A graph that is ready to run.
pub struct Program {
    pub(super) gpu: Arc<Gpu>,
    /// What it runs.
    pub plan: Plan,
    linked: Arc<Vec<Linked>>,
    pub(super) schedule: Schedule,
    scene: SceneResources,
    pub(super) pipelines: Pipelines,
    steps: Vec<StepGpu>,
    /// Objects that the steps refer to.
    _sets: Sets,
    names: Vec<String>,
    pub(super) resources: Resources,
    /// Layouts of all images between frames.
    pub(super) resting: Vec<vk::ImageLayout>,
    /// Numbers of objects taken over from the last program.
    pub change: Change,
    params: Arc<Buffer>,
    slots: Vec<Slot>,
    pub(super) frame: u64,
    /// Frames that this program has run; the one before it may have run others.
    ran: u64,
    /// The texture that frames copy.
    pub(super) shown: Option<usize>,
    /// Whether every frame copies it to the CPU.
    pub(super) reads_back: bool,
    /// Where the next frame copies it to on the device.
    handed: Option<Arc<Buffer>>,
    /// Steps where a pass begins.
    starts: Vec<usize>,
    interface: &'static SceneInterface,
    execution: Execution,
    /// For incremental execution, and for groups that converge.
    versions: Option<Versions>,
    calibration: Calibration,
}

/// A frame in flight.
struct Slot {
    /// Commands of its last frame and their work, by parity. Dropped before the queries that they
    /// write.
    recorded: [Option<(Recorded, Recording)>; 2],
    commands: FrameSlot,
    /// When its last frame was recorded and submitted.
    cpu: [Instant; 3],
    /// Whether each of [`Program::starts`] has a timestamp.
    stamped: Vec<bool>,
    /// Where the shown texture is copied to on the CPU, and whether its last frame did.
    readback: (Option<Buffer>, bool),
    /// Where its last frame copied it to for another device.
    handed: Option<Arc<Buffer>>,
}

fn params_buffer(gpu: &Arc<Gpu>, set: &Evaluated<'_>) -> Result<Arc<Buffer>> {
    let usage = vk::BufferUsageFlags::UNIFORM_BUFFER | vk::BufferUsageFlags::TRANSFER_DST;
    let size = set.params.uniform_bytes(&set.values).len() as u64;
    Buffer::new(gpu, "params", size, usage, MemoryLocation::GpuOnly).map(Arc::new)
}

/// The first step of each run of steps of one pass.
fn starts(plan: &Plan) -> Vec<usize> {
    let is_start = |i: &usize| *i == 0 || plan.steps[*i].pass != plan.steps[i - 1].pass;
    (0..plan.steps.len()).filter(is_start).collect()
}

impl Slot {
    fn new(gpu: &Arc<Gpu>, timestamps: usize) -> Result<Slot> {
        let timestamps = u32::try_from(timestamps).unwrap_or(u32::MAX);
        Ok(Slot {
            commands: FrameSlot::new(gpu, timestamps)?,
            recorded: [None, None],
            cpu: [Instant::now(); 3],
            stamped: Vec::new(),
            readback: (None, false),
            handed: None,
        })
    }
}

/// All that decides which commands a frame has, but its parity.
#[derive(PartialEq)]
struct Recorded {
    frame: Frame,
    /// The first two frames begin with other layouts than all after them.
    first: Option<u64>,
}

/// Times of one frame that has finished.
#[derive(Clone, Debug, Default)]
pub struct FrameTimes {
    /// (pass number, milliseconds) on the GPU, in order; 0 if skipped.
    pub passes: Vec<(usize, f64)>,
    /// Numbers of the skipped passes ([`Execution::Incremental`]).
    pub skipped: Vec<usize>,
    /// First to last command of the frame on the GPU, ms.
    pub gpu_ms: f64,
    /// Recording and submitting on the CPU, ms.
    pub cpu_ms: f64,
    /// When all of it happened.
    pub timeline: Option<Timeline>,
    /// Texels of the texture chosen by [`Program::show`], mip 0 and layer 0, tightly packed.
    pub picture: Option<Vec<u8>>,
    /// The same in a buffer of the device that another device may take ([`Program::hand_over`]).
    pub handed: Option<Arc<Buffer>>,
}

/// Frames recorded ahead of the GPU.
const FRAMES_IN_FLIGHT: usize = 3;

impl Program {
    /// Makes everything that the plan needs, except what can be taken from the parts of a running
    /// program; see [`Program::swap_in`].
    ///
    /// # Errors
    /// Out of device memory; errors of the driver.
    pub fn new(
        gpu: &Arc<Gpu>,
        set: &Evaluated<'_>,
        linked: &Arc<Vec<Linked>>,
        plan: Plan,
        scene: &SceneResources,
        parts: &Parts,
    ) -> Result<Program> {
        let Evaluated { graph, params, .. } = *set;
        let schedule = schedule(&plan);
        let mut change = Change::default();
        let resources = resources::make(gpu, graph, &plan, parts, &mut change)?;
        let params_buffer = params_buffer(gpu, set)?;
        let constants = [params.constants(), scene.constants.clone()].concat();
        let made = make_pipelines(gpu, graph, linked, &plan, &constants, &parts.pipelines)?;
        (change.built, change.kept) = (made.built, made.pipelines.len() - made.built);
        let offered = Offered {
            gpu,
            graph,
            linked,
            plan: &plan,
            resources: &resources,
            scene,
            params: &params_buffer,
        };
        let mut sets = Sets::new(gpu, &plan, linked)?;
        let pipeline = |key: &Option<usize>| key.map(|k| made.pipelines[k].1.clone());
        let steps = plan.steps.iter().zip(made.keys.iter().map(pipeline));
        let steps = steps.map(|(step, pipeline)| sets.step(&offered, step, pipeline));
        let starts = starts(&plan);
        let slots = (0..FRAMES_IN_FLIGHT).map(|_| Slot::new(gpu, starts.len() + 1));
        let mut program = Program {
            gpu: gpu.clone(),
            steps: steps.collect::<Result<_>>()?,
            _sets: sets,
            names: params.passes.clone(),
            pipelines: made.pipelines,
            resting: schedule.ends[1].clone(),
            change,
            shown: None,
            reads_back: true,
            handed: None,
            plan,
            linked: linked.clone(),
            schedule,
            scene: scene.clone(),
            resources,
            params: params_buffer,
            slots: slots.collect::<Result<_>>()?,
            starts,
            frame: 0,
            ran: 0,
            interface: set.graph.interface,
            execution: Execution::Full,
            versions: None,
            calibration: Calibration::default(),
        };
        program.set_execution(Execution::Full);
        program.initialise(parts)?;
        Ok(program)
    }

    /// Gives every new image its first layout and clears it, so that first frames are like any
    /// other.
    fn initialise(&mut self, parts: &Parts) -> Result<()> {
        let dst = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
        for layout in self
            .resting
            .iter_mut()
            .filter(|l| **l == vk::ImageLayout::UNDEFINED)
        {
            *layout = dst;
        }
        // Every frame begins transient resources.
        let buffers = self
            .resources
            .buffers
            .iter()
            .zip(&self.plan.buffers)
            .filter(|(_, plan)| !plan.transient);
        let buffers: Vec<&Arc<Buffer>> = buffers
            .flat_map(|(copies, _)| copies.iter().flatten())
            .filter(|b| !parts.holds_buffer(b))
            .collect();
        let is_new = |image: &Arc<Image>, t: usize| {
            !self.plan.textures[t].transient && !parts.holds_image(image)
        };
        let images: Vec<_> = self
            .images()
            .filter(|(t, image, _)| is_new(image, *t))
            .collect();
        // A submission waits for the frames that run: nothing is submitted for nothing.
        if buffers.is_empty() && images.is_empty() {
            return Ok(());
        }
        Commands::once(&self.gpu, |commands| {
            for buffer in buffers {
                commands.fill(buffer, 0);
            }
            for (t, image, places) in images {
                commands.transition(image, vk::ImageLayout::UNDEFINED, dst);
                if self.plan.textures[t].format.is_depth() {
                    commands.clear_depth(image, dst, 1.0);
                } else {
                    commands.clear(image, dst, vk::ClearColorValue::default());
                }
                let barriers: Vec<_> = (0u32..)
                    .zip(&self.resting[places])
                    .filter(|(_, layout)| **layout != dst)
                    .map(|(mip, layout)| (&**image, relayout(image, dst, *layout, mip)))
                    .collect();
                commands.barrier(None, &barriers);
            }
            commands.full_barrier();
        })
    }

    pub(super) fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }

    /// The buffer that holds the parameters.
    pub fn params_buffer(&self) -> Arc<Buffer> {
        self.params.clone()
    }

    /// Records and submits a frame, after writing `updates` into uniform and scene buffers. Returns
    /// the times of the frame that ran in the same slot before, if one did.
    ///
    /// # Errors
    /// The device was lost.
    pub fn run(&mut self, updates: &[Update]) -> Result<Option<FrameTimes>> {
        let slot = usize::try_from(self.frame % FRAMES_IN_FLIGHT as u64).unwrap_or(0);
        let finished = self.finish(slot)?;
        let parity = usize::try_from(self.frame % 2).unwrap_or(0);
        let mut slots = std::mem::take(&mut self.slots);
        let readback = self.readback(&mut slots[slot]);
        slots[slot].handed = self.handed.take();
        let start = Instant::now();
        let frame = self.work(updates, parity == 1);
        let result = readback.and_then(|()| self.submit(&mut slots[slot], frame, updates, parity));
        slots[slot].cpu[0] = start;
        slots[slot].cpu[2] = Instant::now();
        self.slots = slots;
        if result.is_err() {
            // The effect of such a frame is unknown.
            self.versions = None;
            self.set_execution(self.execution);
        }
        result?;
        self.frame += 1;
        self.ran += 1;
        self.rest(parity);
        Ok(finished)
    }

    /// Sends what changed, and the commands of a frame behind it: those of the last one that did
    /// the same, if there is one. Recording takes most of the time of a CPU's frame.
    fn submit(
        &self,
        slot: &mut Slot,
        frame: Frame,
        updates: &[Update],
        parity: usize,
    ) -> Result<()> {
        slot.stamped = self.runs(&frame.runs);
        let Slot {
            commands,
            recorded,
            stamped,
            readback,
            handed,
            cpu,
        } = slot;
        let recorder = self.recorder();
        let recorded = &mut recorded[parity];
        let wanted = Recorded {
            frame,
            first: Some(self.ran).filter(|ran| *ran < 2),
        };
        let recording = match recorded.take() {
            Some((last, recording)) if last == wanted => recording,
            _ => Recording::new(commands, |commands| {
                recorder.record(commands, parity, &wanted.frame, stamped);
            })?,
        };
        let to_host = readback.0.as_ref().filter(|_| readback.1);
        let shown = self.shown.filter(|_| to_host.is_some() || handed.is_some());
        let copy = shown.map(|texture| {
            let recorder = &recorder;
            move |commands: &mut Commands<'_>| {
                recorder.copy_shown(commands, texture, parity, to_host, handed.as_deref())
            }
        });
        cpu[1] = Instant::now();
        commands.submit_again(&recording, |commands| send(commands, updates), copy)?;
        *recorded = Some((wanted, recording));
        Ok(())
    }

    /// All images, with their textures' numbers and where their mips are among the places.
    pub(super) fn images(&self) -> impl Iterator<Item = (usize, &Arc<Image>, Range<usize>)> {
        self.resources
            .images
            .iter()
            .enumerate()
            .flat_map(move |(t, copies)| {
                let mips = (0, self.plan.textures[t].mips);
                let places = move |copy| {
                    self.schedule
                        .places
                        .of_copy(Res::Texture(t, false), mips, copy)
                };
                copies
                    .iter()
                    .enumerate()
                    .filter_map(move |(c, image)| Some((t, image.as_ref()?, places(c))))
            })
    }

    fn recorder(&self) -> Recorder<'_> {
        Recorder {
            plan: &self.plan,
            schedule: &self.schedule,
            resources: &self.resources,
            steps: &self.steps,
            names: &self.names,
            starts: &self.starts,
            geometry: &self.scene.geometry,
            multi_draw: self.gpu.info.features.multi_draw_indirect,
            resting: &self.resting,
        }
    }

    /// From the next frame on, does all or what changes.
    pub fn set_execution(&mut self, execution: Execution) {
        self.execution = execution;
        if execution == Execution::Full && self.plan.settling.is_empty() {
            self.versions = None;
        } else if self.versions.is_none() {
            self.versions = Some(Versions::new(self.interface, &self.linked, &self.plan));
        }
    }

    /// Forgets everything that frames left, as if none had run.
    ///
    /// # Errors
    /// The device was lost.
    pub fn restart(&mut self) -> Result<Vec<FrameTimes>> {
        let finished = self.finish_all()?;
        (self.frame, self.ran, self.versions) = (0, 0, None);
        self.set_execution(self.execution);
        self.resting.clone_from(&self.schedule.ends[1]);
        self.initialise(&Parts::default())?;
        Ok(finished)
    }

    /// Whether all passes that gather over frames rest: further frames make the same picture until
    /// something changes.
    pub fn is_at_rest(&self) -> bool {
        let frames = self
            .plan
            .settling
            .iter()
            .fold(0, |sum: u32, group| sum.saturating_add(group.frames));
        let declared = frames > 0 && frames == self.plan.convergence.changed;
        declared
            && self
                .versions
                .as_ref()
                .is_some_and(|versions| versions.have_converged())
    }

    /// What frames do.
    pub fn execution(&self) -> Execution {
        self.execution
    }

    /// The work of the next frame.
    fn work(&mut self, updates: &[Update], odd: bool) -> Frame {
        let Some(versions) = &mut self.versions else {
            return Frame {
                runs: vec![true; self.plan.steps.len()],
                carries: Vec::new(),
            };
        };
        for Update { buffer, at, bytes } in updates {
            if Arc::ptr_eq(buffer, &self.params) {
                versions.update("params", None, bytes);
            }
            for (name, _) in self
                .scene
                .buffers
                .iter()
                .filter(|(_, b)| Arc::ptr_eq(b, buffer))
            {
                versions.update(name, *at, bytes);
            }
        }
        versions.frame(odd, self.execution)
    }

    /// Whether a step of each pass runs, in the order of `starts`.
    fn runs(&self, awake: &[bool]) -> Vec<bool> {
        let ends = self.starts.iter().skip(1).copied().chain([awake.len()]);
        self.starts
            .iter()
            .zip(ends)
            .map(|(start, end)| awake[*start..end].contains(&true))
            .collect()
    }

    /// Whether frames copy the shown texture to the CPU, from the next one on; they do at first.
    pub fn read_back(&mut self, reads_back: bool) {
        self.reads_back = reads_back;
    }

    /// The buffer for the next frame's copy of the shown texture, for another device. A buffer that
    /// is too small is ignored.
    pub fn hand_over(&mut self, to: Option<Arc<Buffer>>) {
        let bytes = self.shown_bytes();
        self.handed = to.filter(|b| bytes > 0 && b.size >= bytes);
    }

    /// Bytes of the shown texture; 0 without one.
    pub fn shown_bytes(&self) -> u64 {
        self.shown.map_or(0, |t| self.plan.textures[t].mip_bytes(0))
    }

    /// Copies this texture to the CPU with every frame from now on.
    pub fn show(&mut self, texture: Option<usize>) {
        self.shown = texture.filter(|t| {
            let plan = &self.plan.textures[*t];
            !plan.usage.is_empty() && !plan.transient
        });
    }

    /// Gives a slot a host buffer for the shown texture, unless it has one that fits.
    fn readback(&self, slot: &mut Slot) -> Result<()> {
        let size = self.shown_bytes();
        slot.readback.1 = self.reads_back && size > 0;
        if slot.readback.1
            && slot
                .readback
                .0
                .as_ref()
                .is_none_or(|b| b.size != size.max(16).next_multiple_of(4))
        {
            let usage = vk::BufferUsageFlags::TRANSFER_DST;
            slot.readback.0 = Some(Buffer::new(
                &self.gpu,
                "shown",
                size,
                usage,
                MemoryLocation::GpuToCpu,
            )?);
        }
        Ok(())
    }

    /// Remembers the layouts that a frame of this parity leaves behind.
    fn rest(&mut self, parity: usize) {
        for (now, end) in self.resting.iter_mut().zip(&self.schedule.ends[parity]) {
            if *end != vk::ImageLayout::UNDEFINED {
                *now = *end;
            }
        }
    }

    /// Waits until at most `unfinished` frames are unfinished and returns the times of the others,
    /// in order.
    ///
    /// # Errors
    /// The device was lost.
    pub fn finish_to(&mut self, unfinished: u64) -> Result<Vec<FrameTimes>> {
        let mut list = Vec::new();
        for age in (unfinished + 1..=FRAMES_IN_FLIGHT as u64).rev() {
            let Some(frame) = self.frame.checked_sub(age) else {
                continue;
            };
            list.extend(
                self.finish(usize::try_from(frame % FRAMES_IN_FLIGHT as u64).unwrap_or(0))?,
            );
        }
        Ok(list)
    }

    /// Waits for all frames and returns their times in order.
    ///
    /// # Errors
    /// The device was lost.
    pub fn finish_all(&mut self) -> Result<Vec<FrameTimes>> {
        self.finish_to(0)
    }

    fn finish(&mut self, slot: usize) -> Result<Option<FrameTimes>> {
        let shown = usize::try_from(self.shown_bytes()).unwrap_or(0);
        let Slot {
            commands,
            cpu,
            stamped,
            readback,
            handed,
            ..
        } = &mut self.slots[slot];
        let waiting = Instant::now();
        let Some(ticks) = commands.wait()? else {
            return Ok(None);
        };
        let timeline = Timeline {
            recorded: [cpu[0], cpu[1]],
            submitted: [cpu[1], cpu[2]],
            waited: [waiting, Instant::now()],
            gpu: self.calibration.time(&self.gpu, &ticks),
        };
        let ms = |a: u64, b: u64| self.gpu.info.ms_between(a, b);
        let passes = self
            .starts
            .iter()
            .map(|s| self.plan.steps[*s].pass)
            .zip(stamped.iter());
        let mut spans = ticks.windows(2).map(|t| ms(t[0], t[1]));
        // Devices without timestamps say nothing.
        let timed = passes.clone().filter(|_| !ticks.is_empty());
        Ok(Some(FrameTimes {
            skipped: passes.filter(|p| !p.1).map(|p| p.0).collect(),
            passes: timed
                .map(|(pass, ran)| {
                    (
                        pass,
                        if *ran {
                            spans.next().unwrap_or(0.0)
                        } else {
                            0.0
                        },
                    )
                })
                .collect(),
            gpu_ms: ticks
                .first()
                .zip(ticks.last())
                .map_or(0.0, |(a, b)| ms(*a, *b)),
            cpu_ms: cpu[2].duration_since(cpu[0]).as_secs_f64() * 1e3,
            timeline: Some(timeline),
            picture: readback
                .0
                .as_ref()
                .filter(|_| readback.1)
                .map(|b| b.bytes()[..shown.min(b.bytes().len())].to_vec()),
            handed: handed.take(),
        }))
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        // All frames in flight end before their objects are destroyed. A hung or lost device needs
        // no wait.
        for slot in &mut self.slots {
            let _ = slot.commands.wait();
        }
        self.slots.clear();
    }
}
