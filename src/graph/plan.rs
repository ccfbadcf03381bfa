//! What runs in a frame: expressions evaluated, passes that nobody needs left out, every use of every subresource listed.

use super::expr::{Env, Var};
use super::file::{BufferSize, Command, Dispatch, Draw, Ex, PassDecl, Which};
use super::layouts::{DISPATCH_WORDS, DRAW_WORDS, Layouts};
use super::link::{Bound, BoundCase, Linked, Target};
use super::load::Graph;
use super::param::{Params, Value};
use super::settle::Settling;
use super::transient::Transient;
use super::usage::{Res, Use, UseKind, merge};
use crate::diagnostics::{At, Diagnostic};
use crate::shader::Resource;
use crate::vulkan::{DeviceInfo, Format, Stage, vk};
use std::collections::BTreeMap;

/// Outside facts that a plan depends on.
#[derive(Clone, Debug)]
pub struct PlanInput<'a> {
    /// Parameter values.
    pub params: &'a Params,
    /// Variables beside parameters (sizes, counts of the scene).
    pub env: Env,
    /// Resources that must hold their result at the end of the frame.
    pub wanted: Vec<String>,
    /// The device.
    pub device: &'a DeviceInfo,
}

/// A texture as it is made.
#[derive(Clone, Debug, PartialEq)]
pub struct TexturePlan {
    /// Width, height, depth.
    pub extent: [u32; 3],
    /// 3D.
    pub volume: bool,
    /// Layers.
    pub layers: u32,
    /// Mips.
    pub mips: u32,
    /// Format.
    pub format: Format,
    /// Usage derived from the steps; empty when no step uses it and it is not made.
    pub usage: vk::ImageUsageFlags,
    /// Two copies, this frame's and last frame's.
    pub history: bool,
    /// Holds nothing between frames.
    pub transient: bool,
}

impl TexturePlan {
    /// Bytes of one layer of a mip, tightly packed.
    pub fn mip_bytes(&self, mip: u32) -> u64 {
        let texels: u64 = self.extent.iter().map(|n| u64::from((n >> mip).max(1))).product();
        texels * u64::from(self.format.bytes)
    }
}

/// A buffer as it is made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BufferPlan {
    /// Bytes.
    pub size: u64,
    /// Whether any step uses it.
    pub used: bool,
    /// Two copies, this frame's and last frame's.
    pub history: bool,
    /// Holds nothing between frames.
    pub transient: bool,
}

impl BufferPlan {
    /// Bytes of all copies.
    pub fn bytes(&self) -> u64 {
        self.size * (1 + u64::from(self.history))
    }
}

/// The work of a step.
#[derive(Clone, Debug, PartialEq)]
pub enum Work {
    /// Compute groups.
    Dispatch([u32; 3]),
    /// Compute groups from a buffer.
    DispatchIndirect(usize, u64),
    /// The scene's triangles.
    Scene(Which),
    /// Vertices.
    Vertices(u32),
    /// Vertices from a buffer.
    DrawIndirect(usize, u64),
    /// Clear mips of a texture.
    ClearTexture(usize, (u32, u32), [f64; 4]),
    /// Fill a buffer.
    ClearBuffer(usize, u32),
    /// Copy a texture.
    CopyTexture(usize, usize),
    /// Copy a buffer.
    CopyBuffer(usize, usize),
}

/// An attachment of a step.
#[derive(Clone, Debug, PartialEq)]
pub struct AttachmentPlan {
    /// Texture.
    pub texture: usize,
    /// Mip.
    pub mip: u32,
    /// Layer.
    pub layer: u32,
    /// Clear value.
    pub clear: Option<[f32; 4]>,
    /// Whether it is written (depth).
    pub write: bool,
}

/// The texture behind a binding, evaluated.
#[derive(Clone, Debug, PartialEq)]
pub struct BindingPlan {
    /// Index in the pass's bindings.
    pub bound: usize,
    /// The texture.
    pub texture: usize,
    /// First mip and their number.
    pub mips: (u32, u32),
    /// First layer and their number.
    pub layers: (u32, u32),
    /// View format.
    pub format: Option<Format>,
    /// Last frame's copy.
    pub history: bool,
    /// Layout at the time of the step.
    pub layout: vk::ImageLayout,
}

/// One execution of a pass.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// Pass number in the graph.
    pub pass: usize,
    /// Repeat index or mip.
    pub index: u32,
    /// What it does.
    pub work: Work,
    /// Which case of each of the pass's bindings holds.
    pub cases: Vec<usize>,
    /// Textures behind its bindings.
    pub bindings: Vec<BindingPlan>,
    /// Bindings, by index in the pass's bindings, whose stores nobody needs: they are taken out of the shader. Those that
    /// are not among `bindings` either are not bound at all.
    pub stripped: Vec<usize>,
    /// Colour attachments; those nobody needs are `None`.
    pub color: Vec<Option<AttachmentPlan>>,
    /// Depth attachment.
    pub depth: Option<AttachmentPlan>,
    /// Viewport.
    pub viewport: [u32; 2],
    /// Samples without attachments.
    pub samples: u32,
    /// Every use of a resource.
    pub uses: Vec<Use>,
}

/// A frame's plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Textures, as in the graph.
    pub textures: Vec<TexturePlan>,
    /// Buffers, as in the graph.
    pub buffers: Vec<BufferPlan>,
    /// Steps in order.
    pub steps: Vec<Step>,
    /// Those that gather over frames.
    pub settling: Vec<Settling>,
    /// What shares memory.
    pub transients: Vec<Transient>,
    /// What passes write that are off: it begins with zeros, whatever another program left in it.
    pub missing: Vec<Res>,
    /// Passes left out, and why.
    pub dropped: Vec<(usize, String)>,
    /// Edge length above which triangles must be split, if needed.
    pub max_edge: Option<f64>,
}

/// All expressions of a graph.
pub fn all_expressions(graph: &Graph) -> impl Iterator<Item = &Ex> {
    let textures = graph.textures.iter().flat_map(|(_, t)| {
        let t = &t.value;
        t.size.0.iter().chain(&t.mips).chain(&t.layers)
    });
    let buffers = graph.buffers.iter().flat_map(|(_, b)| b.value.size.value.expression());
    let scene = graph.scene.iter().flat_map(|s| std::iter::once(&s.value.max_edge).chain(&s.value.when));
    let values = graph.values.iter().map(|v| &v.expr).chain(graph.refuse.iter().map(|r| &r.when));
    let cases = graph.aliases.iter().flat_map(|a| &a.cases);
    let aliases = cases.flat_map(|c| c.when.iter().chain(&c.bind.mip).chain(&c.bind.layer));
    let params = graph.params.list.iter().flat_map(|p| p.when.iter().chain(&p.effective));
    textures
        .chain(buffers)
        .chain(params)
        .chain(scene)
        .chain(values)
        .chain(aliases)
        .chain(graph.passes.iter().flat_map(|p| pass_expressions(&p.value)))
}

pub(super) fn pass_expressions(pass: &PassDecl) -> Vec<&Ex> {
    let mut list: Vec<&Ex> = pass.conditions().chain(&pass.settles).chain(&pass.repeat).chain(&pass.mip).collect();
    if let Some(Dispatch::Threads(x, y, z) | Dispatch::Groups(x, y, z)) = pass.dispatch.as_ref().map(|d| &d.value) {
        list.extend([x, y, z]);
    }
    if let Some(Draw::Vertices(n)) = pass.draw.as_ref().map(|d| &d.value) {
        list.push(n);
    }
    for (_, bind) in &pass.bind.0 {
        list.extend(bind.value.mip.iter().chain(&bind.value.layer));
    }
    for target in &pass.color.0 {
        list.extend(target.value.mip.iter().chain(&target.value.layer));
    }
    list.extend(pass.depth.iter().flat_map(|d| &d.value.layer));
    if let Some(size) = &pass.raster.size {
        list.extend([&size.value.0, &size.value.1]);
    }
    list.extend(&pass.raster.samples);
    list
}

/// Plans a frame.
///
/// # Errors
/// Sizes that make no sense or that the device cannot make, features that it lacks.
pub fn plan(graph: &Graph, linked: &[Linked], input: &PlanInput<'_>) -> Result<Plan, Vec<Diagnostic>> {
    let layouts = Layouts::new(graph, linked);
    let (env, errors, textures) = (input.env.clone(), Vec::new(), Vec::new());
    let mut planner = Planner { graph, layouts, input, env, errors, textures, buffers: Vec::new() };
    planner.errors = super::value::fill(graph, input.params, &mut planner.env).1;
    if !planner.errors.is_empty() {
        return Err(planner.errors);
    }
    planner.refuse();
    planner.sizes();
    if !planner.errors.is_empty() {
        return Err(planner.errors);
    }
    planner.buffers = planner.buffers();
    let mut dropped = Vec::new();
    let mut steps = Vec::new();
    let mut settles = BTreeMap::new();
    // What passes write that are left out.
    let mut missing: Vec<Res> = Vec::new();
    for (number, (pass, link)) in graph.passes.iter().zip(linked).enumerate() {
        if let Some(when) = pass.value.conditions().find(|when| !planner.condition(when)) {
            dropped.push((number, format!("{} is false", when.value.text)));
            continue;
        }
        if input.params.off.contains(&pass.value.name.value) {
            let uses = planner.steps(number, &pass.value, link).into_iter().flat_map(|s| s.uses);
            missing.extend(uses.filter(|u| u.write).map(|u| u.res));
            dropped.push((number, "it is off".into()));
            continue;
        }
        steps.extend(planner.steps(number, &pass.value, link));
        if let Some(ex) = &pass.value.settles {
            settles.insert(number, (ex.at, planner.count(ex, 1, "settles")));
        }
    }
    planner.without(&missing, &steps);
    written_anew(&planner.textures, &planner.buffers, &mut steps);
    planner.checks();
    let max_edge = planner.max_edge();
    if !planner.errors.is_empty() {
        return Err(planner.errors);
    }
    let mut errors = Vec::new();
    let (textures, buffers) = (planner.textures, planner.buffers);
    let (settling, transients) = (Vec::new(), Vec::new());
    let mut plan = Plan { textures, buffers, steps, settling, transients, missing, dropped, max_edge };
    super::live::prune(graph, linked, &mut plan, &input.wanted);
    super::usage::layouts(graph, &mut plan, &mut errors);
    match super::settle::find(graph, &plan.steps, (&plan.textures, &plan.buffers), &settles) {
        Ok(settling) => plan.settling = settling,
        Err(found) => errors.extend(found),
    }
    match super::transient::find(graph, &plan.steps, &plan.textures, &plan.buffers) {
        Ok(transients) => plan.transients = transients,
        Err(found) => errors.extend(found),
    }
    let features = super::needs::check(graph, linked, &plan, input);
    errors.extend(features);
    if errors.is_empty() { Ok(plan) } else { Err(errors) }
}

/// In what has a history nothing is left of two frames ago, in what is transient nothing at all, by their declarations: who
/// stores first replaces everything.
fn written_anew(textures: &[TexturePlan], buffers: &[BufferPlan], steps: &mut [Step]) {
    let begun = (0..buffers.len()).filter(|b| buffers[*b].history || buffers[*b].transient);
    let buffers = begun.map(|b| (Res::Buffer(b, false), 0));
    let kept = textures.iter().enumerate().filter(|(_, texture)| texture.history || texture.transient);
    let mips = kept.flat_map(|(t, texture)| (0..texture.mips).map(move |mip| (Res::Texture(t, false), mip)));
    for (res, mip) in buffers.chain(mips) {
        let this = |u: &&mut Use| u.res == res && u.mips == (mip, 1);
        if let Some(first) = steps.iter_mut().flat_map(|s| &mut s.uses).filter(this).find(|u| u.write) {
            first.overwrite |= !first.read;
        }
    }
}

struct Planner<'a> {
    graph: &'a Graph,
    layouts: Layouts<'a>,
    input: &'a PlanInput<'a>,
    env: Env,
    errors: Vec<Diagnostic>,
    textures: Vec<TexturePlan>,
    buffers: Vec<BufferPlan>,
}

impl Planner<'_> {
    fn error(&mut self, at: At, message: String) {
        let found = self.graph.sources.error(at, message);
        if !self.errors.contains(&found) {
            self.errors.push(found);
        }
    }

    fn value(&mut self, ex: &Ex) -> f64 {
        ex.value.eval(&self.env).unwrap_or_else(|why| {
            self.error(ex.at, format!("'{}': {why}", ex.value.text));
            0.0
        })
    }

    fn condition(&mut self, ex: &Ex) -> bool {
        self.value(ex) != 0.0
    }

    /// A whole number of at least `low`.
    fn count(&mut self, ex: &Ex, low: u32, what: &str) -> u32 {
        let before = self.errors.len();
        let value = self.value(ex);
        if self.errors.len() > before {
            return low;
        }
        let rounded = (value + 1e-9).floor();
        if rounded < f64::from(low) || rounded > f64::from(i32::MAX) {
            self.error(ex.at, format!("{what} '{}' is {value}, and must be at least {low}", ex.value.text));
            return low;
        }
        rounded as u32
    }

    fn format(&self, name: &str) -> Option<Format> {
        Format::named(name).or_else(|| match self.input.params.get(name) {
            Some(Value::Choice(option)) => Format::named(option),
            _ => None,
        })
    }

    fn sizes(&mut self) {
        for (name, texture) in &self.graph.textures {
            let t = &texture.value;
            let mut extent = [1; 3];
            for (slot, ex) in extent.iter_mut().zip(&t.size.0) {
                *slot = self.count(ex, 1, "size");
            }
            let mips = t.mips.as_ref().map_or(1, |ex| self.count(ex, 1, "mip count"));
            let layers = t.layers.as_ref().map_or(1, |ex| self.count(ex, 1, "layer count"));
            let most = 32 - extent.iter().max().unwrap_or(&1).leading_zeros();
            if mips > most {
                self.error(texture.at, format!("'{name}' has {mips} mips; {extent:?} texels allow {most}"));
            }
            let limits = &self.input.device.limits;
            let side = if t.size.0.len() == 3 { limits.max_image_dimension3_d } else { limits.max_image_dimension2_d };
            for (n, ex) in extent.iter().zip(&t.size.0) {
                if *n > side {
                    let message = format!("'{name}' is {n} texels long; {} allows {side}", self.input.device.name);
                    self.error(ex.at, message);
                }
            }
            let most_layers = limits.max_image_array_layers;
            if layers > most_layers {
                let message = format!("'{name}' has {layers} layers; {} allows {most_layers}", self.input.device.name);
                self.error(texture.at, message);
            }
            let Some(format) = self.format(&t.format.value) else {
                self.error(t.format.at, format!("'{}' is no format", t.format.value));
                continue;
            };
            self.textures.push(TexturePlan {
                extent,
                volume: t.size.0.len() == 3,
                layers,
                mips: mips.min(most),
                format,
                usage: vk::ImageUsageFlags::empty(),
                history: t.history,
                transient: t.transient && !self.input.wanted.contains(name),
            });
        }
    }

    fn buffers(&mut self) -> Vec<BufferPlan> {
        let graph = self.graph;
        graph
            .buffers
            .iter()
            .map(|(name, buffer)| {
                let before = self.errors.len();
                let bytes = self.bytes(name, &buffer.value.size.value);
                let limit = self.input.device.limits.max_storage_buffer_range;
                if self.errors.len() == before && !(4.0..=f64::from(limit)).contains(&bytes) {
                    self.error(
                        buffer.value.size.at,
                        format!("buffer '{name}' is {bytes} bytes; {} allows 4 to {limit}", self.input.device.name),
                    );
                }
                // One whose size was told as wrong holds everything.
                let size = if self.errors.len() == before { bytes as u64 } else { u64::MAX };
                let transient = buffer.value.transient && !self.input.wanted.contains(name);
                BufferPlan { size, used: false, history: buffer.value.history, transient }
            })
            .collect()
    }

    fn bytes(&mut self, name: &str, size: &BufferSize) -> f64 {
        match size {
            BufferSize::Bytes(ex) => self.value(ex),
            BufferSize::Struct(count) => {
                // Mistakes were told with the shaders. Where none declares it, none reads it.
                let size = self.layouts.struct_size(name, count.is_some()).ok().flatten();
                let elements = count.as_ref().map_or(0, |ex| self.count(ex, 1, "count"));
                size.map_or(4.0, |(bytes, stride)| f64::from(bytes) + f64::from(stride) * f64::from(elements)).max(4.0)
            }
        }
    }

    fn refuse(&mut self) {
        for refused in &self.graph.refuse {
            if self.condition(&refused.when) {
                self.error(refused.when.at, refused.message.clone());
            }
        }
    }

    /// What passes that are off would have begun anew holds zeros in their place, and the picture has to come from somewhere.
    fn without(&mut self, missing: &[Res], steps: &[Step]) {
        for res in missing {
            match *res {
                Res::Texture(t, _) => self.textures[t].transient = false,
                Res::Buffer(b, _) => self.buffers[b].transient = false,
            }
            let name = super::report::resource_name(self.graph, *res);
            let written = steps.iter().flat_map(|s| &s.uses).any(|u| u.write && u.res == *res);
            if !written && self.input.wanted.contains(&name) {
                let writes =
                    format!("nothing writes '{name}' when these passes are off: {}", self.input.params.off.join(", "));
                self.errors.push(Diagnostic::error(crate::diagnostics::Place::default(), writes));
            }
        }
    }

    fn checks(&mut self) {
        for check in &self.graph.checks {
            let size = self.buffer(check.buffer()).map_or(0, |b| self.buffers[b].size);
            if let (Some(buffer), Some(word)) = (&check.buffer, check.word)
                && (u64::from(word) + 1) * 4 > size
            {
                self.error(buffer.at, format!("'{}' has {size} bytes and no word {word}", buffer.value));
            }
        }
    }

    fn max_edge(&mut self) -> Option<f64> {
        if self.env.get("triangle_count") == Some(&Var::Number(0.0)) {
            return None;
        }
        let needs = &self.graph.scene.as_ref()?.value;
        if let Some(when) = &needs.when
            && !self.condition(when)
        {
            return None;
        }
        let edge = self.value(&needs.max_edge);
        if edge <= 0.0 && self.errors.is_empty() {
            self.error(needs.max_edge.at, format!("max_edge '{}' is {edge} m", needs.max_edge.value.text));
        }
        Some(edge)
    }

    fn texture(&self, name: &str) -> Option<usize> {
        self.graph.textures.iter().position(|t| t.0 == name)
    }

    fn buffer(&self, name: &str) -> Option<usize> {
        self.graph.buffers.iter().position(|b| b.0 == name)
    }

    fn steps(&mut self, number: usize, pass: &PassDecl, link: &Linked) -> Vec<Step> {
        let indices: Vec<u32> = if let Some(each) = &pass.each_mip {
            let mips = self.texture(&each.value.texture.value).map_or(0, |t| self.textures[t].mips);
            (each.value.from..mips).collect()
        } else if let Some(repeat) = &pass.repeat {
            let count = self.count(repeat, 0, "repeat");
            if count > 4096 {
                self.error(repeat.at, format!("repeat '{}' is {count}, more than 4096", repeat.value.text));
                return Vec::new();
            }
            (0..count).collect()
        } else {
            vec![0]
        };
        let repeats = pass.each_mip.is_some() || pass.repeat.is_some();
        let mut steps = Vec::new();
        for index in indices {
            if repeats {
                self.env.insert("index".into(), Var::Number(f64::from(index)));
                self.env.insert("mip".into(), Var::Number(f64::from(index)));
            }
            steps.extend(self.step(number, pass, link, index));
        }
        self.env.remove("index");
        self.env.remove("mip");
        steps
    }

    fn step(&mut self, number: usize, pass: &PassDecl, link: &Linked, index: u32) -> Option<Step> {
        let mut step = Step {
            pass: number,
            index,
            work: Work::Vertices(0),
            cases: Vec::new(),
            bindings: Vec::new(),
            stripped: Vec::new(),
            color: Vec::new(),
            depth: None,
            viewport: [0; 2],
            samples: 1,
            uses: Vec::new(),
        };
        for (i, bound) in link.bound.iter().enumerate() {
            let case = self.case(bound.cases.iter().map(|c| c.when.as_ref()));
            step.cases.push(case);
            self.binding(i, bound, &bound.cases[case], &mut step);
        }
        self.attachments(pass, &mut step);
        step.work = self.work(pass, link, &mut step)?;
        step.uses = merge(std::mem::take(&mut step.uses));
        self.covers(link, &mut step);
        Some(step)
    }

    /// Where every thread stores at its own place, and there are as many as texels, nothing is left of what was there.
    fn covers(&self, link: &Linked, step: &mut Step) {
        let (Work::Dispatch(groups), [shader]) = (&step.work, &link.stages[..]) else { return };
        let threads: [u32; 3] = std::array::from_fn(|k| groups[k].saturating_mul(shader.interface.local_size[k]));
        for binding in &step.bindings {
            let texture = &self.textures[binding.texture];
            let [x, y, z] = texture.extent.map(|n| (n >> binding.mips.0).max(1));
            let texels = [x, y, if texture.volume { z } else { binding.layers.1 }];
            let covered = shader.interface.covers.contains(&link.bound[binding.bound].binding)
                && binding.layers.1 == texture.layers;
            if covered && threads.iter().zip(texels).all(|(threads, texels)| *threads >= texels) {
                let res = Res::Texture(binding.texture, binding.history);
                let stores = |u: &&mut Use| u.res == res && u.mips == binding.mips && u.kind == UseKind::Storage;
                step.uses.iter_mut().filter(stores).for_each(|u| u.overwrite = u.write && !u.read);
            }
        }
    }

    /// The first case whose condition holds; the last one has none.
    fn case<'e>(&mut self, conditions: impl ExactSizeIterator<Item = Option<&'e Ex>>) -> usize {
        let last = conditions.len().saturating_sub(1);
        conditions.enumerate().find(|(_, when)| when.is_none_or(|ex| self.condition(ex))).map_or(last, |(i, _)| i)
    }

    fn binding(&mut self, i: usize, bound: &Bound, case: &BoundCase, step: &mut Step) {
        let stage = bound.stage.sync();
        let decl = case.bind.as_ref();
        match case.target {
            Target::External(_) => {}
            Target::Buffer(b) => {
                let (read, write) = match bound.resource {
                    Resource::Buffer { read, write } => (read, write),
                    _ => (true, false),
                };
                let history = decl.is_some_and(|d| d.history);
                step.uses.push(Use::buffer(b, history, stage, read, write, bound.resource == Resource::Uniform));
            }
            Target::Texture(t) => {
                let all = (self.textures[t].mips, self.textures[t].layers);
                let storage = matches!(bound.resource, Resource::Storage { .. });
                let mip = decl.and_then(|d| d.mip.as_ref()).map(|ex| self.count(ex, 0, "mip"));
                let layer = decl.and_then(|d| d.layer.as_ref()).map(|ex| self.count(ex, 0, "layer"));
                let mips = match mip {
                    Some(m) => (m, 1),
                    None if storage => (0, 1),
                    None => (0, all.0),
                };
                let layers = layer.map_or((0, all.1), |l| (l, 1));
                let at = decl.map_or(self.graph.textures[t].1.at, |d| d.of.at);
                if mips.0 + mips.1 > all.0 || layers.0 + layers.1 > all.1 {
                    let name = &self.graph.textures[t].0;
                    self.error(
                        at,
                        format!(
                            "mip {} or layer {} of '{name}' does not exist: it has {} mips and {} layers",
                            mips.0, layers.0, all.0, all.1
                        ),
                    );
                    return;
                }
                let history = decl.is_some_and(|d| d.history);
                let view = decl.and_then(|d| d.format.as_ref()).and_then(|f| self.format(&f.value));
                let (kind, read, write) = match bound.resource {
                    Resource::Storage { read, write, .. } => (UseKind::Storage, read, write),
                    _ => (UseKind::Sampled, true, false),
                };
                step.uses.push(Use::texture(t, history, mips, stage, kind, read, write));
                step.bindings.push(BindingPlan {
                    bound: i,
                    texture: t,
                    mips,
                    layers,
                    format: view,
                    history,
                    layout: vk::ImageLayout::UNDEFINED,
                });
            }
        }
    }

    fn attachments(&mut self, pass: &PassDecl, step: &mut Step) {
        let mut size: Option<[u32; 2]> = None;
        for target in &pass.color.0 {
            let t = &target.value;
            let Some(texture) = self.texture(&t.to.value) else { continue };
            let mip = t.mip.as_ref().map_or(0, |ex| self.count(ex, 0, "mip"));
            let layer = t.layer.as_ref().map_or(0, |ex| self.count(ex, 0, "layer"));
            let plan =
                AttachmentPlan { texture, mip, layer, clear: t.clear.map(|c| [c.0, c.1, c.2, c.3]), write: true };
            // A clear of one layer leaves the others.
            let whole = t.clear.is_some() && self.textures[texture].layers == 1;
            step.uses.push(Use::attachment(texture, mip, UseKind::Color, !whole, true, whole));
            self.attachment_size(t.to.at, &plan, &mut size);
            step.color.push(Some(plan));
        }
        if let Some(target) = &pass.depth {
            let t = &target.value;
            if let Some(texture) = self.texture(&t.to.value) {
                let layer = t.layer.as_ref().map_or(0, |ex| self.count(ex, 0, "layer"));
                let clear = t.clear.map(|c| [c, 0.0, 0.0, 0.0]);
                let plan = AttachmentPlan { texture, mip: 0, layer, clear, write: t.write };
                let kind = if t.write { UseKind::Depth } else { UseKind::DepthRead };
                // A clear of one layer leaves the others.
                let whole = clear.is_some() && self.textures[texture].layers == 1;
                step.uses.push(Use::attachment(texture, 0, kind, clear.is_none() || !whole, t.write, whole));
                self.attachment_size(t.to.at, &plan, &mut size);
                step.depth = Some(plan);
            }
        }
        step.viewport = size.unwrap_or([1, 1]);
        if let Some(extent) = &pass.raster.size {
            step.viewport = [self.count(&extent.value.0, 1, "viewport"), self.count(&extent.value.1, 1, "viewport")];
            let limits = &self.input.device.limits;
            let most = limits.max_viewport_dimensions[0].min(limits.max_framebuffer_width);
            if step.viewport.iter().any(|v| *v > most) {
                let [w, h] = step.viewport;
                self.error(
                    extent.at,
                    format!("viewport {w}x{h} is larger than the {most} that {} allows", self.input.device.name),
                );
            }
        }
        if let Some(samples) = &pass.raster.samples {
            step.samples = self.count(samples, 1, "samples");
            let have = self.input.device.limits.framebuffer_no_attachments_sample_counts.as_raw();
            if !step.samples.is_power_of_two() || have & step.samples == 0 {
                let known: Vec<String> =
                    (0..7).map(|b| 1u32 << b).filter(|n| have & n != 0).map(|n| n.to_string()).collect();
                let message = format!(
                    "{} has no rasterisation with {} samples; it has {}",
                    self.input.device.name,
                    step.samples,
                    known.join(", ")
                );
                self.error(samples.at, message);
            }
        }
    }

    fn attachment_size(&mut self, at: At, plan: &AttachmentPlan, size: &mut Option<[u32; 2]>) {
        let t = &self.textures[plan.texture];
        if plan.mip >= t.mips || plan.layer >= t.layers {
            let message = format!("mip {} or layer {} does not exist", plan.mip, plan.layer);
            self.error(at, message);
            return;
        }
        let this = [(t.extent[0] >> plan.mip).max(1), (t.extent[1] >> plan.mip).max(1)];
        match size {
            None => *size = Some(this),
            Some(other) if *other != this => {
                let message =
                    format!("attachments differ in size: {}x{} and {}x{}", other[0], other[1], this[0], this[1]);
                self.error(at, message);
            }
            Some(_) => {}
        }
    }

    fn work(&mut self, pass: &PassDecl, link: &Linked, step: &mut Step) -> Option<Work> {
        let local = link.stages.iter().find(|s| s.stage == Stage::Compute).map_or([1; 3], |s| s.interface.local_size);
        if let Some(dispatch) = &pass.dispatch {
            let threads = match &dispatch.value {
                Dispatch::Indirect(command) => {
                    let (buffer, offset) = self.command(command, DISPATCH_WORDS)?;
                    step.uses.push(Use::indirect(buffer));
                    return Some(Work::DispatchIndirect(buffer, offset));
                }
                Dispatch::Groups(x, y, z) => {
                    let groups = [x, y, z].map(|ex| self.count(ex, 1, "group count"));
                    return self.grid(dispatch.at, groups).map(Work::Dispatch);
                }
                Dispatch::Threads(x, y, z) => [x, y, z].map(|ex| self.count(ex, 1, "thread count")),
                Dispatch::Cover(name) => self.covered(pass, link, step, &name.value)?,
            };
            let groups = std::array::from_fn(|i| threads[i].div_ceil(local[i].max(1)));
            return self.grid(dispatch.at, groups).map(Work::Dispatch);
        }
        if let Some(draw) = &pass.draw {
            return Some(match &draw.value {
                Draw::Scene { what } => Work::Scene(*what),
                Draw::Fullscreen => Work::Vertices(3),
                Draw::Vertices(n) => Work::Vertices(self.count(n, 0, "vertex count")),
                Draw::Indirect(command) => {
                    let (buffer, offset) = self.command(command, DRAW_WORDS)?;
                    step.uses.push(Use::indirect(buffer));
                    Work::DrawIndirect(buffer, offset)
                }
            });
        }
        if let Some(target) = &pass.clear {
            let v = pass.value.unwrap_or_default();
            if let Some(buffer) = self.buffer(&target.value) {
                step.uses.push(Use::transfer(Res::Buffer(buffer, false), (0, 1), false, true));
                return Some(Work::ClearBuffer(buffer, v.0 as u32));
            }
            let texture = self.texture(&target.value)?;
            let mips = match &pass.mip {
                Some(ex) => (self.count(ex, 0, "mip"), 1),
                None => (0, self.textures[texture].mips),
            };
            step.uses.push(Use::transfer(Res::Texture(texture, false), mips, false, true));
            return Some(Work::ClearTexture(texture, mips, [v.0, v.1, v.2, v.3]));
        }
        let copy = &pass.copy.as_ref()?.value;
        if let (Some(from), Some(to)) = (self.buffer(&copy.from.value), self.buffer(&copy.to.value)) {
            step.uses.push(Use::transfer(Res::Buffer(from, false), (0, 1), true, false));
            // Of a longer target what it held stays needed.
            let longer = self.buffers[to].size > self.buffers[from].size;
            let target = Use::transfer(Res::Buffer(to, false), (0, 1), longer, true);
            step.uses.push(Use { overwrite: !longer, ..target });
            return Some(Work::CopyBuffer(from, to));
        }
        let (from, to) = (self.texture(&copy.from.value)?, self.texture(&copy.to.value)?);
        let (a, b) = (&self.textures[from], &self.textures[to]);
        if (a.extent, a.layers, a.mips, a.format.bytes) != (b.extent, b.layers, b.mips, b.format.bytes) {
            let message = format!("'{}' and '{}' differ in size, mips or texel size", copy.from.value, copy.to.value);
            self.error(copy.from.at, message);
        }
        let mips = (0, self.textures[from].mips);
        step.uses.push(Use::transfer(Res::Texture(from, false), mips, true, false));
        step.uses.push(Use::transfer(Res::Texture(to, false), mips, false, true));
        Some(Work::CopyTexture(from, to))
    }

    /// The buffer and byte of a command of so many 32-bit words, which lies in it.
    fn command(&mut self, command: &Command, words: u32) -> Option<(usize, u64)> {
        let at = command.path.at;
        let buffer = self.buffer(&command.path.value.buffer)?;
        let name = &self.graph.buffers[buffer].0;
        let offset = match self.layouts.command(command, words) {
            Ok(Some(offset)) => offset,
            Ok(None) => {
                self.error(at, format!("no shader that runs declares '{name}', so its members have no place"));
                return None;
            }
            Err(found) => {
                self.errors.push(found);
                return None;
            }
        };
        let (size, bytes) = (self.buffers[buffer].size, u64::from(words) * 4);
        if !offset.is_multiple_of(4) {
            self.error(at, format!("a command begins at a multiple of 4 bytes, which {offset} is not"));
        } else if offset.checked_add(bytes).is_none_or(|end| end > size) {
            self.error(
                at,
                format!("a command of {bytes} bytes at byte {offset} ends outside '{name}', which has {size} bytes"),
            );
        }
        Some((buffer, offset))
    }

    fn covered(&mut self, pass: &PassDecl, link: &Linked, step: &Step, name: &str) -> Option<[u32; 3]> {
        let bound = link.bound.iter().position(|b| b.name == name);
        let binding = bound.and_then(|i| step.bindings.iter().find(|b| b.bound == i));
        let (texture, mip) = match binding {
            Some(b) => (b.texture, b.mips.0),
            None => {
                let cases = self.graph.cases(pass, name);
                let case = self.case(cases.iter().map(|c| c.0.as_ref()));
                match cases.into_iter().nth(case).and_then(|c| c.1) {
                    Some(bind) => {
                        let mip = bind.mip.as_ref().map_or(0, |ex| self.count(ex, 0, "mip"));
                        (self.texture(&bind.of.value)?, mip)
                    }
                    None => (self.texture(name)?, 0),
                }
            }
        };
        Some(self.textures[texture].extent.map(|n| n.checked_shr(mip).unwrap_or(0).max(1)))
    }

    fn grid(&mut self, at: At, groups: [u32; 3]) -> Option<[u32; 3]> {
        let most = self.input.device.limits.max_compute_work_group_count;
        if groups.iter().zip(&most).any(|(g, m)| g > m) {
            self.error(
                at,
                format!("{groups:?} groups are more than the {most:?} that {} allows", self.input.device.name),
            );
            return None;
        }
        Some(groups)
    }
}
