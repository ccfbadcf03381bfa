//! A plan on a device: resources, pipelines, descriptor sets, and the recording of frames.

use super::externals::EXTERNALS;
use super::file::Which;
use super::hot_reload::{Change, Parts};
use super::link::{Linked, Target, bound_shape};
use super::load::Graph;
use super::param::{Params, Value};
use super::pipelines::{Pipelines, clear_value, descriptor_pool, descriptor_type, make_pipelines, sampler_desc};
use super::plan::{Plan, Step, Work};
use super::resources::{self, Resources};
use super::sleep::{Contents, Frame};
use super::usage::{Barrier, Layouts, Res, Schedule, schedule};
use crate::shader::{Resource, Shape};
use crate::vulkan::{
    Buffer, Commands, DescriptorPool, DescriptorSet, DescriptorWrite, FrameSlot, Gpu, Image, Pipeline, Recording,
    Result, Sampler, SamplerDesc, View, ViewDesc, VulkanError, format::Channels, vk,
};
use gpu_allocator::MemoryLocation;
use std::collections::HashMap;
use std::sync::Arc;
use std::time::Instant;

/// The scene's triangles as drawn: the masked draws follow the opaque ones.
#[derive(Clone)]
pub struct Geometry {
    /// 32-bit indices.
    pub indices: Arc<Buffer>,
    /// One indexed draw command (20 bytes) a draw.
    pub commands: Arc<Buffer>,
    /// (first index, index count) of each draw.
    pub draws: Vec<(u32, u32)>,
    /// How many of them have no alpha mask.
    pub opaque: u32,
}

/// The scene's resources by the names of [`EXTERNALS`].
#[derive(Clone)]
pub struct SceneResources {
    /// Buffers.
    pub buffers: HashMap<&'static str, Arc<Buffer>>,
    /// Material texture arrays.
    pub textures: HashMap<&'static str, Arc<View>>,
    /// How those are sampled.
    pub sampler: Arc<Sampler>,
    /// What is drawn.
    pub geometry: Geometry,
}

/// A graph that is ready to run.
pub struct Program {
    gpu: Arc<Gpu>,
    /// What it runs.
    pub plan: Plan,
    linked: Arc<Vec<Linked>>,
    pub(super) schedule: Schedule,
    scene: SceneResources,
    pub(super) pipelines: Pipelines,
    steps: Vec<StepGpu>,
    pool: DescriptorPool,
    samplers: HashMap<SamplerDesc, Sampler>,
    /// Views that the sets refer to.
    views: Vec<View>,
    names: Vec<String>,
    pub(super) images: Vec<[Option<Arc<Image>>; 2]>,
    pub(super) buffers: Vec<[Option<Arc<Buffer>>; 2]>,
    /// Bytes of the memory that transient ones share.
    pub(super) shared_bytes: u64,
    /// Layouts of all images between frames.
    pub(super) resting: Layouts,
    /// What was taken over from the program before.
    pub change: Change,
    params: Arc<Buffer>,
    slots: Vec<Slot>,
    pub(super) frame: u64,
    /// Frames that this program has run; the one before it may have run others.
    ran: u64,
    /// The texture that frames are asked for.
    shown: Option<usize>,
    /// Whether every frame copies it to the CPU.
    pub(super) reads_back: bool,
    /// Where the next frame copies it to on the device.
    handed: Option<Arc<Buffer>>,
    /// Steps where a pass begins.
    starts: Vec<usize>,
    /// What frames do.
    pub(super) redo: Redo,
    /// What there is, where only what changes is done or something settles.
    contents: Option<Contents>,
}

/// What a frame does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize, clap::ValueEnum)]
#[serde(rename_all = "snake_case")]
pub enum Redo {
    /// All passes run.
    #[default]
    All,
    /// Passes run whose outcome would be another than what is there: with the same content, to the bit.
    Changed,
}

/// A frame in flight.
struct Slot {
    /// By parity, the commands of its last frame, and what they do. Dropped before the queries that they write.
    recorded: [Option<(Recorded, Recording)>; 2],
    commands: FrameSlot,
    cpu_ms: f64,
    /// Whether each of [`Program::starts`] has a timestamp.
    stamped: Vec<bool>,
    /// Where the shown texture is copied to on the CPU, and whether its last frame did.
    readback: (Option<Buffer>, bool),
    /// Where its last frame copied it to for another device.
    handed: Option<Arc<Buffer>>,
}

/// All that decides which commands a frame has, but its parity.
#[derive(PartialEq)]
struct Recorded {
    frame: Frame,
    /// The first two frames begin with other layouts than all after them.
    first: Option<u64>,
}

struct StepGpu {
    pipeline: Option<Arc<Pipeline>>,
    push: bool,
    sets: [Option<DescriptorSet>; 2],
    color: [Vec<Option<View>>; 2],
    depth: [Option<View>; 2],
}

/// Times of one frame that has finished.
#[derive(Clone, Debug, Default)]
pub struct FrameTimes {
    /// (pass number, milliseconds) on the GPU, in order; 0 for those that slept.
    pub passes: Vec<(usize, f64)>,
    /// Numbers of the passes that slept ([`Redo::Changed`]).
    pub asleep: Vec<usize>,
    /// First to last command of the frame on the GPU, ms.
    pub gpu_ms: f64,
    /// Recording and submitting on the CPU, ms.
    pub cpu_ms: f64,
    /// Texels of the texture chosen by [`Program::show`], mip 0 and layer 0, tightly packed.
    pub picture: Option<Vec<u8>>,
    /// The same in a buffer of the device that another device may take ([`Program::hand_over`]).
    pub handed: Option<Arc<Buffer>>,
}

/// Frames recorded ahead of the GPU.
const FRAMES_IN_FLIGHT: usize = 3;

impl Program {
    /// Makes everything that the plan needs, except what can be taken from the parts of a running program; see
    /// [`Program::swap_in`].
    ///
    /// # Errors
    /// Out of device memory, and what the driver refuses.
    pub fn new(
        gpu: &Arc<Gpu>,
        graph: &Graph,
        linked: &Arc<Vec<Linked>>,
        plan: Plan,
        params: &Params,
        scene: &SceneResources,
        parts: &Parts,
    ) -> Result<Program> {
        let schedule = schedule(&plan);
        let mut change = Change::default();
        let Resources { images, buffers, shared_bytes } = resources::make(gpu, graph, &plan, parts, &mut change)?;
        let usage = vk::BufferUsageFlags::UNIFORM_BUFFER | vk::BufferUsageFlags::TRANSFER_DST;
        let size = params.uniform_bytes(&vec![Value::Int(0); graph.values.len()]).len() as u64;
        let params_buffer = Arc::new(Buffer::new(gpu, "params", size, usage, MemoryLocation::GpuOnly)?);
        let made = make_pipelines(gpu, graph, linked, &plan, params, &parts.pipelines)?;
        change.built = made.built;
        change.kept = made.pipelines.len() - made.built;
        let resting = schedule.ends[1].clone();
        let mut program = Program {
            gpu: gpu.clone(),
            pool: descriptor_pool(gpu, &plan, linked)?,
            samplers: HashMap::new(),
            views: Vec::new(),
            names: graph.passes.iter().map(|p| p.value.name.value.clone()).collect(),
            pipelines: made.pipelines,
            resting,
            change,
            shown: None,
            reads_back: true,
            handed: None,
            steps: Vec::new(),
            starts: (0..plan.steps.len())
                .filter(|i| *i == 0 || plan.steps[*i].pass != plan.steps[i - 1].pass)
                .collect(),
            plan,
            linked: linked.clone(),
            schedule,
            scene: scene.clone(),
            images,
            buffers,
            shared_bytes,
            params: params_buffer,
            slots: Vec::new(),
            frame: 0,
            ran: 0,
            redo: Redo::All,
            contents: None,
        };
        program.set_redo(Redo::All);
        let timestamps = u32::try_from(program.starts.len() + 1).unwrap_or(u32::MAX);
        for _ in 0..FRAMES_IN_FLIGHT {
            program.slots.push(Slot {
                commands: FrameSlot::new(gpu, timestamps)?,
                recorded: [None, None],
                cpu_ms: 0.0,
                stamped: Vec::new(),
                readback: (None, false),
                handed: None,
            });
        }
        for (i, key) in made.keys.iter().enumerate() {
            let pipeline = key.map(|k| program.pipelines[k].1.clone());
            let step = program.step(graph, linked, i, pipeline)?;
            program.steps.push(step);
        }
        program.initialise(parts)?;
        Ok(program)
    }

    /// Gives every new image its first layout and zeroes what is new, so that first frames are like any other.
    fn initialise(&mut self, parts: &Parts) -> Result<()> {
        let dst = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
        for layout in self.resting.iter_mut().flatten().flatten().filter(|l| **l == vk::ImageLayout::UNDEFINED) {
            *layout = dst;
        }
        // What is transient is begun by every frame.
        let buffers = self.buffers.iter().zip(&self.plan.buffers).filter(|(_, plan)| !plan.transient);
        let buffers: Vec<&Arc<Buffer>> =
            buffers.flat_map(|(copies, _)| copies.iter().flatten()).filter(|b| !parts.holds_buffer(b)).collect();
        let mut images = Vec::new();
        for (t, copies) in self.images.iter().enumerate().filter(|(t, _)| !self.plan.textures[*t].transient) {
            for (image, layouts) in copies.iter().zip(&self.resting[t]) {
                images.extend(image.as_ref().filter(|i| !parts.holds_image(i)).map(|image| (t, image, layouts)));
            }
        }
        // A submission waits for the frames that run: nothing is submitted for nothing.
        if buffers.is_empty() && images.is_empty() {
            return Ok(());
        }
        Commands::once(&self.gpu, |commands| {
            for buffer in buffers {
                commands.fill(buffer, 0);
            }
            for (t, image, layouts) in images {
                commands.transition(image, vk::ImageLayout::UNDEFINED, dst);
                if self.plan.textures[t].format.is_depth() {
                    commands.clear_depth(image, dst, 1.0);
                } else {
                    commands.clear(image, dst, vk::ClearColorValue::default(), (0, vk::REMAINING_MIP_LEVELS));
                }
                let barriers: Vec<_> = (0u32..)
                    .zip(layouts)
                    .filter(|(_, layout)| **layout != dst)
                    .map(|(mip, layout)| (&**image, relayout(image, dst, *layout, mip)))
                    .collect();
                commands.barrier(None, &barriers);
            }
            commands.full_barrier();
        })
    }

    fn step(
        &mut self,
        graph: &Graph,
        linked: &[Linked],
        index: usize,
        pipeline: Option<Arc<Pipeline>>,
    ) -> Result<StepGpu> {
        let step = self.plan.steps[index].clone();
        let link = &linked[step.pass];
        let mut out = StepGpu {
            pipeline: pipeline.clone(),
            push: link.stages.iter().any(|s| s.interface.push),
            sets: [None, None],
            color: [Vec::new(), Vec::new()],
            depth: [None, None],
        };
        for parity in 0..2 {
            out.color[parity] = step
                .color
                .iter()
                .map(|slot| slot.as_ref().map(|a| self.attachment(a, parity)).transpose())
                .collect::<Result<_>>()?;
            out.depth[parity] = step.depth.as_ref().map(|a| self.attachment(a, parity)).transpose()?;
            if let Some(pipeline) = &pipeline
                && !link.bound.is_empty()
            {
                let set = self.set(graph, link, &step, pipeline, parity)?;
                out.sets[parity] = Some(set);
            }
        }
        Ok(out)
    }

    fn image(&self, texture: usize, history: bool, parity: usize) -> Result<&Arc<Image>> {
        let copy = usize::from(self.plan.textures[texture].history && (history != (parity == 1)));
        self.images[texture][copy].as_ref().ok_or_else(|| VulkanError::Code {
            what: format!("find texture {texture} of the plan"),
            code: vk::Result::ERROR_UNKNOWN,
        })
    }

    fn buffer(&self, buffer: usize, history: bool, parity: usize) -> Option<&Arc<Buffer>> {
        let copy = usize::from(self.plan.buffers[buffer].history && (history != (parity == 1)));
        self.buffers[buffer][copy].as_ref()
    }

    fn attachment(&self, plan: &super::plan::AttachmentPlan, parity: usize) -> Result<View> {
        let format = self.plan.textures[plan.texture].format;
        let desc = ViewDesc {
            kind: vk::ImageViewType::TYPE_2D,
            format: format.vk,
            aspect: format.aspect(),
            mips: (plan.mip, 1),
            layers: (plan.layer, 1),
            usage: if format.is_depth() {
                vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT
            } else {
                vk::ImageUsageFlags::COLOR_ATTACHMENT
            },
        };
        View::new(self.image(plan.texture, false, parity)?, &desc)
    }

    fn set(
        &mut self,
        graph: &Graph,
        link: &Linked,
        step: &Step,
        pipeline: &Pipeline,
        parity: usize,
    ) -> Result<DescriptorSet> {
        let mut views: Vec<Option<View>> = Vec::new();
        let mut samplers: Vec<Option<SamplerDesc>> = Vec::new();
        for (i, bound) in link.bound.iter().enumerate() {
            // Images whose stores were taken out of the shader have no binding.
            let binding = step.bindings.iter().find(|b| b.bound == i);
            let case = &bound.cases[step.cases[i]];
            let (Target::Texture(t), Some(plan)) = (&case.target, binding) else {
                views.push(None);
                samplers.push(None);
                continue;
            };
            let t = *t;
            let decl = case.bind.as_ref();
            let texture = &graph.textures[t].1.value;
            let format = plan.format.unwrap_or(self.plan.textures[t].format);
            let desc = ViewDesc {
                kind: match bound_shape(texture, decl) {
                    Shape::D2 => vk::ImageViewType::TYPE_2D,
                    Shape::D2Array => vk::ImageViewType::TYPE_2D_ARRAY,
                    Shape::D3 => vk::ImageViewType::TYPE_3D,
                },
                format: format.vk,
                aspect: format.aspect(),
                mips: plan.mips,
                layers: plan.layers,
                usage: match bound.resource {
                    Resource::Storage { .. } => vk::ImageUsageFlags::STORAGE,
                    _ => vk::ImageUsageFlags::SAMPLED,
                },
            };
            views.push(Some(View::new(self.image(t, plan.history, parity)?, &desc)?));
            let sampler = decl.and_then(|d| d.sampler).or(texture.sampler).unwrap_or_default();
            let integer = matches!(format.channels, Channels::Uint | Channels::Int);
            let desc = sampler_desc(&sampler, self.plan.textures[t].mips > 1, integer);
            if let std::collections::hash_map::Entry::Vacant(slot) = self.samplers.entry(desc) {
                slot.insert(Sampler::new(&self.gpu, &desc)?);
            }
            samplers.push(Some(desc));
        }
        let mut writes = Vec::new();
        for (i, bound) in link.bound.iter().enumerate() {
            let kind = descriptor_type(&bound.resource);
            let case = &bound.cases[step.cases[i]];
            let write = match case.target {
                Target::External(e) => self.external(EXTERNALS[e].name)?,
                Target::Buffer(b) => match self.buffer(b, case.bind.as_ref().is_some_and(|d| d.history), parity) {
                    Some(buffer) => DescriptorWrite::Buffer(buffer),
                    None => continue,
                },
                Target::Texture(_) => {
                    let (Some(view), Some(plan)) = (&views[i], step.bindings.iter().find(|b| b.bound == i)) else {
                        continue;
                    };
                    match samplers[i].and_then(|d| self.samplers.get(&d)) {
                        Some(sampler) if matches!(bound.resource, Resource::Sampled { .. }) => {
                            DescriptorWrite::Sampled(view, sampler, plan.layout)
                        }
                        _ => DescriptorWrite::Storage(view),
                    }
                }
            };
            writes.push((bound.binding, kind, write));
        }
        let set = self.pool.set(pipeline, &writes)?;
        drop(writes);
        self.views.extend(views.into_iter().flatten());
        Ok(set)
    }

    fn external(&self, name: &str) -> Result<DescriptorWrite<'_>> {
        if name == "params" {
            return Ok(DescriptorWrite::Buffer(&self.params));
        }
        if let Some(buffer) = self.scene.buffers.get(name) {
            return Ok(DescriptorWrite::Buffer(buffer));
        }
        match self.scene.textures.get(name) {
            Some(view) => {
                Ok(DescriptorWrite::Sampled(view, &self.scene.sampler, vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL))
            }
            None => {
                Err(VulkanError::Code { what: format!("find the scene's '{name}'"), code: vk::Result::ERROR_UNKNOWN })
            }
        }
    }

    pub(super) fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }

    /// The buffer that holds the parameters.
    pub fn params_buffer(&self) -> Arc<Buffer> {
        self.params.clone()
    }

    /// Records and submits a frame, after writing `updates` into uniform and scene buffers. Returns the times of the
    /// frame that ran in the same slot before, if one did.
    ///
    /// # Errors
    /// The device was lost.
    pub fn run(&mut self, updates: &[(Arc<Buffer>, Vec<u8>)]) -> Result<Option<FrameTimes>> {
        let slot = usize::try_from(self.frame % FRAMES_IN_FLIGHT as u64).unwrap_or(0);
        let finished = self.finish(slot)?;
        let parity = usize::try_from(self.frame % 2).unwrap_or(0);
        let mut slots = std::mem::take(&mut self.slots);
        let readback = self.readback(&mut slots[slot]);
        slots[slot].handed = self.handed.take();
        let start = Instant::now();
        let frame = self.work(updates, parity == 1);
        let result = readback.and_then(|()| self.submit(&mut slots[slot], frame, updates, parity));
        slots[slot].cpu_ms = start.elapsed().as_secs_f64() * 1e3;
        self.slots = slots;
        if result.is_err() {
            // Nobody knows what such a frame has done.
            self.contents = None;
            self.set_redo(self.redo);
        }
        result?;
        self.frame += 1;
        self.ran += 1;
        self.rest(parity);
        Ok(finished)
    }

    /// Sends what changed, and the commands of a frame behind it: those of the last one that did the same, if there is one.
    /// Recording takes most of the time of a CPU's frame.
    fn submit(&self, slot: &mut Slot, frame: Frame, updates: &[(Arc<Buffer>, Vec<u8>)], parity: usize) -> Result<()> {
        slot.stamped = self.runs(&frame.awake);
        let Slot { commands, recorded, stamped, readback, handed, .. } = slot;
        let recorded = &mut recorded[parity];
        let wanted = Recorded { frame, first: Some(self.ran).filter(|ran| *ran < 2) };
        let recording = match recorded.take() {
            Some((last, recording)) if last == wanted => recording,
            _ => Recording::new(commands, |commands| {
                self.record(commands, parity, &wanted.frame, stamped);
            })?,
        };
        let to_host = readback.0.as_ref().filter(|_| readback.1);
        let copies = to_host.is_some() || handed.is_some();
        let copy = |commands: &mut Commands<'_>| self.copy_shown(commands, parity, to_host, handed.as_deref());
        commands.submit_again(&recording, |commands| send(commands, updates), copies.then_some(copy))?;
        *recorded = Some((wanted, recording));
        Ok(())
    }

    /// From the next frame on, does all or what changes.
    pub fn set_redo(&mut self, redo: Redo) {
        self.redo = redo;
        if redo == Redo::All && self.plan.settling.is_empty() {
            self.contents = None;
        } else if self.contents.is_none() {
            self.contents = Some(Contents::new(&self.linked, &self.plan));
        }
    }

    /// What frames do.
    pub fn redo(&self) -> Redo {
        self.redo
    }

    /// What the next frame does.
    fn work(&mut self, updates: &[(Arc<Buffer>, Vec<u8>)], odd: bool) -> Frame {
        let Some(contents) = &mut self.contents else {
            return Frame { awake: vec![true; self.plan.steps.len()], keeping: Vec::new() };
        };
        for (buffer, bytes) in updates {
            if Arc::ptr_eq(buffer, &self.params) {
                contents.update("params", bytes);
            }
            for (name, _) in self.scene.buffers.iter().filter(|(_, b)| Arc::ptr_eq(b, buffer)) {
                contents.update(name, bytes);
            }
        }
        contents.frame(&self.plan, odd, self.redo)
    }

    /// Whether a step of each pass runs, in the order of `starts`.
    fn runs(&self, awake: &[bool]) -> Vec<bool> {
        let ends = self.starts.iter().skip(1).copied().chain([awake.len()]);
        self.starts.iter().zip(ends).map(|(start, end)| awake[*start..end].contains(&true)).collect()
    }

    /// Whether frames copy the shown texture to the CPU, from the next one on; they do at first.
    pub fn read_back(&mut self, reads_back: bool) {
        self.reads_back = reads_back;
    }

    /// Where the next frame copies the shown texture to, for another device; what is too small for it is left alone.
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
        if slot.readback.1 && slot.readback.0.as_ref().is_none_or(|b| b.size != size.max(16).next_multiple_of(4)) {
            let usage = vk::BufferUsageFlags::TRANSFER_DST;
            slot.readback.0 = Some(Buffer::new(&self.gpu, "shown", size, usage, MemoryLocation::GpuToCpu)?);
        }
        Ok(())
    }

    /// Remembers the layouts that a frame of this parity leaves behind.
    fn rest(&mut self, parity: usize) {
        for (now, end) in
            self.resting.iter_mut().flatten().flatten().zip(self.schedule.ends[parity].iter().flatten().flatten())
        {
            if *end != vk::ImageLayout::UNDEFINED {
                *now = *end;
            }
        }
    }

    /// Waits until at most so many frames are unfinished and returns the times of the others, in order.
    ///
    /// # Errors
    /// The device was lost.
    pub fn finish_to(&mut self, unfinished: u64) -> Result<Vec<FrameTimes>> {
        let mut list = Vec::new();
        for age in (unfinished + 1..=FRAMES_IN_FLIGHT as u64).rev() {
            let Some(frame) = self.frame.checked_sub(age) else { continue };
            list.extend(self.finish(usize::try_from(frame % FRAMES_IN_FLIGHT as u64).unwrap_or(0))?);
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
        let Slot { commands, cpu_ms, stamped, readback, handed, .. } = &mut self.slots[slot];
        let Some(ticks) = commands.wait()? else { return Ok(None) };
        let ms = |a: u64, b: u64| b.saturating_sub(a) as f64 * self.gpu.info.timestamp_ns * 1e-6;
        let passes = self.starts.iter().map(|s| self.plan.steps[*s].pass).zip(stamped.iter());
        let mut spans = ticks.windows(2).map(|t| ms(t[0], t[1]));
        // Devices without timestamps say nothing.
        let timed = passes.clone().filter(|_| !ticks.is_empty());
        Ok(Some(FrameTimes {
            asleep: passes.filter(|p| !p.1).map(|p| p.0).collect(),
            passes: timed.map(|(pass, ran)| (pass, if *ran { spans.next().unwrap_or(0.0) } else { 0.0 })).collect(),
            gpu_ms: ticks.first().zip(ticks.last()).map_or(0.0, |(a, b)| ms(*a, *b)),
            cpu_ms: *cpu_ms,
            picture: readback
                .0
                .as_ref()
                .filter(|_| readback.1)
                .map(|b| b.bytes()[..shown.min(b.bytes().len())].to_vec()),
            handed: handed.take(),
        }))
    }

    fn record(&self, commands: &mut Commands<'_>, parity: usize, frame: &Frame, stamped: &[bool]) {
        let mut labelled = false;
        for (i, step) in self.plan.steps.iter().enumerate() {
            if self.starts.binary_search(&i).is_ok_and(|start| stamped[start]) {
                if labelled {
                    commands.end_label();
                }
                commands.timestamp();
                commands.begin_label(&self.names[step.pass]);
                labelled = true;
            }
            // Those of steps that sleep too: layouts and waits are then as in any other frame.
            self.barriers(commands, &self.schedule.barriers[parity][i]);
            if frame.awake[i] {
                self.record_step(commands, step, &self.steps[i], parity);
            }
            for (group, _) in self.plan.settling.iter().zip(&frame.keeping).filter(|(_, keeps)| **keeps) {
                if group.steps.last() == Some(&i) {
                    self.keep(commands, &group.kept, i, parity);
                }
            }
        }
        if labelled {
            commands.end_label();
        }
        commands.timestamp();
    }

    /// Copies the shown texture behind a frame of that parity: to the CPU, for another device.
    fn copy_shown(
        &self,
        commands: &mut Commands<'_>,
        parity: usize,
        to_host: Option<&Buffer>,
        handed: Option<&Buffer>,
    ) {
        let Some(texture) = self.shown else { return };
        let copy = usize::from(self.plan.textures[texture].history && parity == 1);
        let Some(image) = &self.images[texture][copy] else { return };
        let layout = match self.schedule.ends[parity][texture][copy][0] {
            vk::ImageLayout::UNDEFINED => self.resting[texture][copy][0],
            layout => layout,
        };
        for to in to_host.into_iter().chain(handed) {
            copy_out(commands, image, layout, (0, 0), None, to);
        }
        if let Some(buffer) = handed {
            commands.hand_over(buffer);
        }
    }

    /// Brings what the frame before left into this frame's copies, after a step. Rare, or thrown away: it waits for all.
    fn keep(&self, commands: &mut Commands<'_>, kept: &[Res], step: usize, parity: usize) {
        let (src, dst) = (vk::ImageLayout::TRANSFER_SRC_OPTIMAL, vk::ImageLayout::TRANSFER_DST_OPTIMAL);
        commands.full_barrier();
        for res in kept {
            match *res {
                Res::Buffer(b, _) => {
                    if let (Some(last), Some(new)) = (self.buffer(b, true, parity), self.buffer(b, false, parity)) {
                        commands.copy_buffer(last, new, new.size);
                    }
                }
                Res::Texture(t, _) => {
                    let (Ok(last), Ok(new)) = (self.image(t, true, parity), self.image(t, false, parity)) else {
                        continue;
                    };
                    let layouts = |history: bool, mip: u32| self.layout_after(step, t, (history, mip), parity);
                    let mips = 0..self.plan.textures[t].mips;
                    let there: Vec<_> =
                        mips.clone().map(|mip| (layouts(true, mip), layouts(false, mip), mip)).collect();
                    for (of_last, of_new, mip) in &there {
                        commands.barrier(None, &[(&**last, relayout(last, *of_last, src, *mip))]);
                        commands.barrier(None, &[(&**new, relayout(new, *of_new, dst, *mip))]);
                    }
                    commands.copy_image(last, src, new, dst);
                    for (of_last, of_new, mip) in &there {
                        commands.barrier(None, &[(&**last, relayout(last, src, *of_last, *mip))]);
                        commands.barrier(None, &[(&**new, relayout(new, dst, *of_new, *mip))]);
                    }
                }
            }
        }
        commands.full_barrier();
    }

    /// The layout of a mip of a texture's copy between a step and the next.
    fn layout_after(&self, step: usize, t: usize, (history, mip): (bool, u32), parity: usize) -> vk::ImageLayout {
        let mut before = self.plan.steps[..=step].iter().rev().flat_map(|s| &s.uses);
        let used = before.find(|u| u.res == Res::Texture(t, history) && (u.mips.0..u.mips.0 + u.mips.1).contains(&mip));
        let copy = usize::from(self.plan.textures[t].history && (history != (parity == 1)));
        used.map_or(self.resting[t][copy][mip as usize], |u| u.layout)
    }

    fn barriers(&self, commands: &mut Commands<'_>, list: &[Barrier]) {
        if list.is_empty() {
            return;
        }
        // Buffers join one memory barrier; images have one each, for the mips in question.
        let mut memory: Option<vk::MemoryBarrier2<'static>> = None;
        let mut images = Vec::new();
        for b in list {
            match b.res {
                Res::Buffer(..) => {
                    let m = memory.get_or_insert_default();
                    m.src_stage_mask |= b.src.0;
                    m.src_access_mask |= b.src.1;
                    m.dst_stage_mask |= b.dst.0;
                    m.dst_access_mask |= b.dst.1;
                }
                Res::Texture(t, copy) => {
                    let Some(image) = &self.images[t][usize::from(copy)] else { continue };
                    let barrier = vk::ImageMemoryBarrier2::default()
                        .src_stage_mask(b.src.0)
                        .src_access_mask(b.src.1)
                        .dst_stage_mask(b.dst.0)
                        .dst_access_mask(b.dst.1)
                        .old_layout(b.layouts.0)
                        .new_layout(b.layouts.1)
                        .subresource_range(
                            vk::ImageSubresourceRange::default()
                                .aspect_mask(self.plan.textures[t].format.aspect())
                                .base_mip_level(b.mips.0)
                                .level_count(b.mips.1)
                                .layer_count(vk::REMAINING_ARRAY_LAYERS),
                        );
                    images.push((&**image, barrier));
                }
            }
        }
        commands.barrier(memory, &images);
    }

    fn record_step(&self, commands: &mut Commands<'_>, step: &Step, gpu: &StepGpu, parity: usize) {
        let raster = matches!(step.work, Work::Scene(_) | Work::Vertices(_) | Work::DrawIndirect(..));
        if raster {
            let color: Vec<_> = step
                .color
                .iter()
                .zip(&gpu.color[parity])
                .map(|(plan, view)| Some((view.as_ref()?, plan.as_ref()?.clear)))
                .collect();
            let depth = step.depth.as_ref().zip(gpu.depth[parity].as_ref());
            let depth = depth.map(|(plan, view)| (view, plan.clear.map(|c| c[0]), plan.write));
            commands.begin_rendering(step.viewport, &color, depth);
        }
        if let Some(pipeline) = &gpu.pipeline {
            commands.bind(pipeline, gpu.sets[parity]);
            if gpu.push {
                commands.push(pipeline, &step.index.to_ne_bytes());
            }
        }
        match &step.work {
            Work::Dispatch(groups) => commands.dispatch(*groups),
            Work::DispatchIndirect(b, offset) => {
                if let Some(buffer) = self.buffer(*b, false, parity) {
                    commands.dispatch_indirect(buffer, *offset);
                }
            }
            Work::Scene(which) => self.draw_scene(commands, *which),
            Work::Vertices(n) => commands.draw(*n, 1),
            Work::DrawIndirect(b, offset) => {
                if let Some(buffer) = self.buffer(*b, false, parity) {
                    commands.draw_indirect(buffer, *offset);
                }
            }
            Work::ClearTexture(t, mips, value) => {
                if let (Ok(image), Some(u)) = (self.image(*t, false, parity), step.uses.first()) {
                    commands.clear(image, u.layout, clear_value(self.plan.textures[*t].format.channels, *value), *mips);
                }
            }
            Work::ClearBuffer(b, value) => {
                if let Some(buffer) = self.buffer(*b, false, parity) {
                    commands.fill(buffer, *value);
                }
            }
            Work::CopyTexture(a, b) => {
                if let (Ok(from), Ok(to)) = (self.image(*a, false, parity), self.image(*b, false, parity)) {
                    let layout = |t: usize| {
                        let found = step.uses.iter().find(|u| u.res == Res::Texture(t, false));
                        found.map_or(vk::ImageLayout::GENERAL, |u| u.layout)
                    };
                    commands.copy_image(from, layout(*a), to, layout(*b));
                }
            }
            Work::CopyBuffer(a, b) => {
                if let (Some(from), Some(to)) = (self.buffer(*a, false, parity), self.buffer(*b, false, parity)) {
                    commands.copy_buffer(from, to, from.size.min(to.size));
                }
            }
        }
        if raster {
            commands.end_rendering();
        }
    }

    fn draw_scene(&self, commands: &mut Commands<'_>, which: Which) {
        let g = &self.scene.geometry;
        let total = u32::try_from(g.draws.len()).unwrap_or(u32::MAX);
        let (first, count) = match which {
            Which::All => (0, total),
            Which::Opaque => (0, g.opaque),
            Which::Masked => (g.opaque, total - g.opaque),
        };
        if count == 0 {
            return;
        }
        commands.bind_indices(&g.indices);
        if self.gpu.info.features.multi_draw_indirect {
            commands.draw_indexed_indirect(&g.commands, u64::from(first) * 20, count);
        } else {
            for draw in first..first + count {
                let (first_index, index_count) = g.draws[draw as usize];
                commands.draw_indexed(index_count, first_index, draw);
            }
        }
    }

    /// Copies one mip and layer of a texture, or a (first texel, extent) box of it, to the CPU: tightly packed texels.
    ///
    /// # Errors
    /// The device was lost, out of memory.
    pub fn read_texture(
        &mut self,
        texture: usize,
        mip: u32,
        layer: u32,
        part: Option<([u32; 3], [u32; 3])>,
    ) -> Result<Vec<u8>> {
        self.finish_all()?;
        let parity = usize::try_from((self.frame + 1) % 2).unwrap_or(0);
        let plan = &self.plan.textures[texture];
        let copy = if plan.history { parity } else { 0 };
        let image = self.image(texture, false, parity)?.clone();
        let layout = self.resting[texture][copy][mip as usize];
        let extent = part.map_or(image.mip_extent(mip), |p| p.1);
        let size = extent.iter().map(|n| u64::from(*n)).product::<u64>() * u64::from(plan.format.bytes);
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let target = Buffer::new(&self.gpu, "readback", size, usage, MemoryLocation::GpuToCpu)?;
        Commands::once(&self.gpu, |commands| copy_out(commands, &image, layout, (mip, layer), part, &target))?;
        Ok(target.bytes()[..usize::try_from(size).unwrap_or(0)].to_vec())
    }

    /// Texels of the shown texture as the last frame left them; none without one.
    ///
    /// # Errors
    /// The device was lost, out of memory.
    pub fn shown_texels(&mut self) -> Result<Option<Vec<u8>>> {
        self.shown.map(|texture| self.read_texture(texture, 0, 0, None)).transpose()
    }

    /// Copies a buffer to the CPU.
    ///
    /// # Errors
    /// The device was lost, out of memory.
    pub fn read_buffer(&mut self, buffer: usize) -> Result<Vec<u8>> {
        self.finish_all()?;
        let parity = usize::try_from((self.frame + 1) % 2).unwrap_or(0);
        let Some(from) = self.buffer(buffer, false, parity).cloned() else { return Ok(Vec::new()) };
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let target = Buffer::new(&self.gpu, "readback", from.size, usage, MemoryLocation::GpuToCpu)?;
        Commands::once(&self.gpu, |commands| {
            commands.full_barrier();
            commands.copy_buffer(&from, &target, from.size);
            commands.full_barrier();
        })?;
        Ok(target.bytes()[..usize::try_from(self.plan.buffers[buffer].size).unwrap_or(0)].to_vec())
    }

    /// (name, bytes on the device) of every resource made; what transient ones share is one of them.
    pub fn memory(&self, graph: &Graph) -> Vec<(String, u64)> {
        let textures = graph.textures.iter().zip(&self.images).zip(&self.plan.textures).filter(|(_, p)| !p.transient);
        let textures =
            textures.map(|((t, copies), _)| (t.0.clone(), copies.iter().flatten().map(|i| i.bytes).sum::<u64>()));
        let buffers = graph.buffers.iter().zip(&self.buffers).zip(&self.plan.buffers).filter(|(_, p)| !p.transient);
        let buffers =
            buffers.map(|((b, copies), _)| (b.0.clone(), copies.iter().flatten().map(|m| m.size).sum::<u64>()));
        let shared = (String::from("shared by transient ones"), self.shared_bytes);
        textures.chain(buffers).chain([shared]).filter(|(_, bytes)| *bytes > 0).collect()
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        // All frames in flight end before anything that one of them uses is destroyed. Of a hung or lost device there is
        // nothing to wait for.
        for slot in &mut self.slots {
            let _ = slot.commands.wait();
        }
        self.slots.clear();
    }
}

/// Writes new content into buffers, after all that reads the old one and before all that reads the new one.
fn send(commands: &mut Commands<'_>, updates: &[(Arc<Buffer>, Vec<u8>)]) {
    use vk::{AccessFlags2 as Access, PipelineStageFlags2 as Stages};
    if !updates.is_empty() {
        let barrier = |src, src_access, dst, dst_access| {
            vk::MemoryBarrier2::default()
                .src_stage_mask(src)
                .src_access_mask(src_access)
                .dst_stage_mask(dst)
                .dst_access_mask(dst_access)
        };
        let (all, copy) = (Stages::ALL_COMMANDS, Stages::ALL_TRANSFER);
        commands.barrier(Some(barrier(all, Access::empty(), copy, Access::TRANSFER_WRITE)), &[]);
        for (buffer, bytes) in updates {
            commands.update(buffer, bytes);
        }
        commands.barrier(Some(barrier(copy, Access::TRANSFER_WRITE, all, Access::MEMORY_READ)), &[]);
    }
}

/// Copies a (mip, layer) of an image that rests in a layout, and leaves it there.
fn copy_out(
    commands: &mut Commands<'_>,
    image: &Image,
    layout: vk::ImageLayout,
    (mip, layer): (u32, u32),
    part: Option<([u32; 3], [u32; 3])>,
    to: &Buffer,
) {
    let src = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
    commands.barrier(None, &[(image, relayout(image, layout, src, mip))]);
    commands.read_image(image, src, mip, layer, part, to);
    commands.barrier(None, &[(image, relayout(image, src, layout, mip))]);
    commands.full_barrier();
}

pub(super) fn relayout(
    image: &Image,
    from: vk::ImageLayout,
    to: vk::ImageLayout,
    mip: u32,
) -> vk::ImageMemoryBarrier2<'static> {
    let all = vk::PipelineStageFlags2::ALL_COMMANDS;
    let access = vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE;
    vk::ImageMemoryBarrier2::default()
        .src_stage_mask(all)
        .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
        .dst_stage_mask(all)
        .dst_access_mask(access)
        .old_layout(from)
        .new_layout(to)
        .subresource_range(
            vk::ImageSubresourceRange::default()
                .aspect_mask(image.aspect())
                .base_mip_level(mip)
                .level_count(1)
                .layer_count(vk::REMAINING_ARRAY_LAYERS),
        )
}
