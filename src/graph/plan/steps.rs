//! The steps of a frame: what each pass does, and every use of every subresource.

use super::data::{AttachmentPlan, BindingPlan, BufferPlan, Step, TexturePlan, Work};
use super::numbers::Numbers;
use super::sizes::format;
use super::uses::{Use, UseKind, merge};
use crate::diagnostics::{At, Loc};
use crate::graph::definition::{Graph, Res};
use crate::graph::expr::{Ex, Var};
use crate::graph::file::{DISPATCH_WORDS, DRAW_WORDS, Dispatch, Draw, PassDecl, Path};
use crate::graph::link::{Bound, BoundCase, Layouts, Linked, Target};
use crate::shader::Resource;
use crate::vulkan::{DeviceInfo, Stage, vk};

pub(super) struct Planner<'a, 'p> {
    pub numbers: Numbers<'a>,
    pub layouts: Layouts<'a>,
    pub device: &'a DeviceInfo,
    pub textures: &'p [TexturePlan],
    pub buffers: &'p [BufferPlan],
}

impl<'a> Planner<'a, '_> {
    fn graph(&self) -> &'a Graph {
        self.numbers.set.graph
    }

    pub fn steps(&mut self, number: usize, pass: &PassDecl, link: &Linked) -> Vec<Step> {
        let indices: Vec<u32> = if let Some(each) = &pass.each_mip {
            let mips = self
                .graph()
                .texture(&each.value.texture.value)
                .map_or(0, |t| self.textures[t].mips);
            (each.value.from..mips).collect()
        } else if let Some(repeat) = &pass.repeat {
            let count = self.numbers.count(repeat, 0, "repeat");
            if count > 4096 {
                self.numbers.error(
                    repeat.at,
                    format!("repeat '{}' is {count}, more than 4096", repeat.value.text),
                );
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
                self.numbers
                    .env
                    .insert("index".into(), Var::Number(f64::from(index)));
                self.numbers
                    .env
                    .insert("mip".into(), Var::Number(f64::from(index)));
            }
            steps.extend(self.step(number, pass, link, index));
        }
        self.numbers.env.remove("index");
        self.numbers.env.remove("mip");
        steps
    }

    fn step(&mut self, number: usize, pass: &PassDecl, link: &Linked, index: u32) -> Option<Step> {
        let mut step = Step {
            pass: number,
            index,
            still: pass.still,
            work: Work::Fullscreen,
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
            let case = self
                .numbers
                .case(bound.cases.iter().map(|c| c.when.as_ref()));
            step.cases.push(case);
            self.binding(i, bound, &bound.cases[case], &mut step);
        }
        self.attachments(pass, &mut step);
        step.work = self.work(pass, link, &mut step)?;
        step.uses = merge(std::mem::take(&mut step.uses));
        self.covers(pass, link, &mut step);
        Some(step)
    }

    /// One thread for each texel, each of which stores at its own place, replaces all content; so
    /// does a pass that says so.
    fn covers(&self, pass: &PassDecl, link: &Linked, step: &mut Step) {
        let (Work::Dispatch(groups), [shader]) = (&step.work, &link.stages[..]) else {
            return;
        };
        let threads: [u32; 3] =
            std::array::from_fn(|k| groups[k].saturating_mul(shader.interface.local_size[k]));
        for binding in &step.bindings {
            let texture = &self.textures[binding.texture];
            let [x, y, z] = texture.mip_extent(binding.mips.0);
            let texels = [x, y, if texture.volume { z } else { texture.layers }];
            let covered = shader
                .interface
                .covers
                .contains(&link.bound[binding.bound].binding);
            let mut axes = threads.iter().zip(texels);
            if pass.replaces || covered && axes.all(|(threads, texels)| *threads >= texels) {
                let res = Res::Texture(binding.texture, binding.history);
                let stores = |u: &&mut Use| {
                    u.res == res && u.mips == binding.mips && u.kind == UseKind::Storage
                };
                step.uses
                    .iter_mut()
                    .filter(stores)
                    .for_each(|u| u.overwrite = u.write && !u.read);
            }
        }
    }

    fn binding(&mut self, i: usize, bound: &Bound, case: &BoundCase, step: &mut Step) {
        let stage = bound.stage.sync();
        let decl = case.bind.as_ref();
        match case.target {
            Target::External(_) => {}
            Target::Buffer(b) => {
                let res = Res::Buffer(b, decl.is_some_and(|d| d.history));
                step.uses.push(match bound.resource {
                    Resource::Buffer { read, write } => {
                        Use::shader(res, (0, 1), UseKind::Buffer, stage, read, write)
                    }
                    _ => Use::uniform(res, stage),
                });
            }
            Target::Texture(t) => {
                let all = self.textures[t].mips;
                let storage = matches!(bound.resource, Resource::Storage { .. });
                let mip = decl
                    .and_then(|d| d.mip.as_ref())
                    .map(|ex| self.numbers.count(ex, 0, "mip"));
                let mips = match mip {
                    Some(m) => (m, 1),
                    None if storage => (0, 1),
                    None => (0, all),
                };
                let at = decl.map_or(self.graph().textures[t].1.at, |d| d.of.at);
                if mips.0 + mips.1 > all {
                    let name = &self.graph().textures[t].0;
                    let (what, mip) = ("mips, counted from 0, and no mip", mips.0);
                    let message = format!("'{name}' has {all} {what} {mip}");
                    return self.numbers.error(at, message);
                }
                let history = decl.is_some_and(|d| d.history);
                let view = decl.and_then(|d| d.format.as_ref());
                let view = view.and_then(|f| format(self.numbers.set.params, &f.value));
                let (kind, read, write) = match bound.resource {
                    Resource::Storage { read, write, .. } => (UseKind::Storage, read, write),
                    _ => (UseKind::Sampled, true, false),
                };
                let res = Res::Texture(t, history);
                step.uses
                    .push(Use::shader(res, mips, kind, stage, read, write));
                step.bindings.push(BindingPlan {
                    bound: i,
                    texture: t,
                    mips,
                    format: view,
                    history,
                    layout: vk::ImageLayout::UNDEFINED,
                });
            }
        }
    }

    fn attachments(&mut self, pass: &PassDecl, step: &mut Step) {
        let mut size = None;
        for t in pass.color.0.iter().map(|target| &target.value) {
            let mip = t
                .mip
                .as_ref()
                .map_or(0, |ex| self.numbers.count(ex, 0, "mip"));
            let clear = t.clear.map(|c| [c.0, c.1, c.2, c.3]);
            let (place, uses) = ((mip, t.layer.as_ref()), &mut step.uses);
            let plan = self.attachment(&t.to, place, clear, UseKind::Color, uses, &mut size);
            step.color.extend(plan.map(Some));
        }
        if let Some(t) = pass.depth.as_ref().map(|target| &target.value) {
            let clear = t.clear.map(|c| [c, 0.0, 0.0, 0.0]);
            let kind = if t.write {
                UseKind::Depth
            } else {
                UseKind::DepthRead
            };
            let (place, uses) = ((0, t.layer.as_ref()), &mut step.uses);
            step.depth = self.attachment(&t.to, place, clear, kind, uses, &mut size);
        }
        step.viewport = size.unwrap_or([1, 1]);
        if let Some(extent) = &pass.raster.size {
            step.viewport = [
                self.numbers.count(&extent.value.0, 1, "viewport"),
                self.numbers.count(&extent.value.1, 1, "viewport"),
            ];
            let limits = &self.device.limits;
            let most = limits.max_viewport_dimensions[0].min(limits.max_framebuffer_width);
            if step.viewport.iter().any(|v| *v > most) {
                let [w, h] = step.viewport;
                let name = &self.device.name;
                let message =
                    format!("viewport {w}x{h} is larger than the {most} that {name} allows");
                self.numbers.error(extent.at, message);
            }
        }
        self.samples(pass, step);
    }

    /// An attachment, of the same size as those before.
    fn samples(&mut self, pass: &PassDecl, step: &mut Step) {
        let Some(samples) = &pass.raster.samples else {
            return;
        };
        step.samples = self.numbers.count(samples, 1, "samples");
        let limits = &self.device.limits;
        let have = limits.framebuffer_no_attachments_sample_counts.as_raw();
        if !step.samples.is_power_of_two() || have & step.samples == 0 {
            let known = (0..7).map(|b| 1u32 << b).filter(|n| have & n != 0);
            let known: Vec<String> = known.map(|n| n.to_string()).collect();
            let message = format!(
                "{} has no rasterisation with {} samples; it has {}",
                self.device.name,
                step.samples,
                known.join(", ")
            );
            self.numbers.error(samples.at, message);
        }
    }

    fn attachment(
        &mut self,
        to: &Loc<String>,
        (mip, layer): (u32, Option<&Ex>),
        clear: Option<[f32; 4]>,
        kind: UseKind,
        uses: &mut Vec<Use>,
        size: &mut Option<[u32; 2]>,
    ) -> Option<AttachmentPlan> {
        let texture = self.graph().texture(&to.value)?;
        let layer = layer.map_or(0, |ex| self.numbers.count(ex, 0, "layer"));
        let t = &self.textures[texture];
        // A clear of one layer leaves the others.
        uses.push(Use::attachment(
            texture,
            mip,
            kind,
            clear.is_some() && t.layers == 1,
        ));
        let [width, height, _] = t.mip_extent(mip);
        if mip >= t.mips || layer >= t.layers {
            self.numbers
                .error(to.at, format!("mip {mip} or layer {layer} does not exist"));
        } else if let [w, h] = *size.get_or_insert([width, height])
            && [w, h] != [width, height]
        {
            self.numbers.error(
                to.at,
                format!("attachments differ in size: {w}x{h} and {width}x{height}"),
            );
        }
        Some(AttachmentPlan {
            texture,
            mip,
            layer,
            clear,
            write: kind != UseKind::DepthRead,
        })
    }

    fn work(&mut self, pass: &PassDecl, link: &Linked, step: &mut Step) -> Option<Work> {
        let local = link
            .stages
            .iter()
            .find(|s| s.stage == Stage::Compute)
            .map_or([1; 3], |s| s.interface.local_size);
        if let Some(dispatch) = &pass.dispatch {
            let threads = match &dispatch.value {
                Dispatch::Indirect(path) => {
                    let (buffer, offset) = self.command(path, DISPATCH_WORDS)?;
                    step.uses.push(Use::indirect(buffer));
                    return Some(Work::DispatchIndirect(buffer, offset));
                }
                Dispatch::Groups(x, y, z) => {
                    let groups = [x, y, z].map(|ex| self.numbers.count(ex, 1, "group count"));
                    return self.grid(dispatch.at, groups).map(Work::Dispatch);
                }
                Dispatch::Threads(x, y, z) => {
                    [x, y, z].map(|ex| self.numbers.count(ex, 1, "thread count"))
                }
                Dispatch::Cover(name) => self.covered(pass, link, step, &name.value)?,
            };
            let groups = std::array::from_fn(|i| threads[i].div_ceil(local[i].max(1)));
            return self.grid(dispatch.at, groups).map(Work::Dispatch);
        }
        if let Some(draw) = &pass.draw {
            return Some(match &draw.value {
                Draw::Scene { what } => Work::Scene(*what),
                Draw::Fullscreen => Work::Fullscreen,
                Draw::Indirect(path) => {
                    let (buffer, offset) = self.command(path, DRAW_WORDS)?;
                    step.uses.push(Use::indirect(buffer));
                    Work::DrawIndirect(buffer, offset)
                }
            });
        }
        let res = self.graph().resource(&pass.clear.as_ref()?.value)?;
        let v = pass.value.unwrap_or_default();
        let (mips, work) = match res {
            Res::Buffer(buffer, _) => (1, Work::ClearBuffer(buffer, v.0 as u32)),
            Res::Texture(texture, _) => (
                self.textures[texture].mips,
                Work::ClearTexture(texture, [v.0, v.1, v.2, v.3]),
            ),
        };
        step.uses.push(Use::clear(res, (0, mips)));
        Some(work)
    }

    /// The buffer and byte offset of a command with this number of 32-bit words.
    fn command(&mut self, path: &Loc<Path>, words: u32) -> Option<(usize, u64)> {
        let at = path.at;
        let buffer = self.graph().buffer(&path.value.buffer)?;
        let name = &self.graph().buffers[buffer].0;
        let offset = match self.layouts.command(path, words) {
            Ok(Some(offset)) => offset,
            Ok(None) => {
                self.numbers.error(
                    at,
                    format!("no shader that runs declares '{name}', so its members have no place"),
                );
                return None;
            }
            Err(found) => {
                self.numbers.find(found);
                return None;
            }
        };
        let (size, bytes) = (self.buffers[buffer].size, u64::from(words) * 4);
        if offset + bytes > size {
            self.numbers.error(
                at,
                format!("a command of {bytes} bytes at byte {offset} ends outside '{name}', which has {size} bytes"),
            );
        }
        Some((buffer, offset))
    }

    fn covered(
        &mut self,
        pass: &PassDecl,
        link: &Linked,
        step: &Step,
        name: &str,
    ) -> Option<[u32; 3]> {
        let bound = link.bound.iter().position(|b| b.name == name);
        let binding = bound.and_then(|i| step.bindings.iter().find(|b| b.bound == i));
        let (texture, mip) = match binding {
            Some(b) => (b.texture, b.mips.0),
            None => {
                let cases = self.graph().cases(pass, name);
                let case = self.numbers.case(cases.iter().map(|c| c.0.as_ref()));
                match cases.into_iter().nth(case).and_then(|c| c.1) {
                    Some(bind) => {
                        let mip = bind
                            .mip
                            .as_ref()
                            .map_or(0, |ex| self.numbers.count(ex, 0, "mip"));
                        (self.graph().texture(&bind.of.value)?, mip)
                    }
                    None => (self.graph().texture(name)?, 0),
                }
            }
        };
        Some(self.textures[texture].mip_extent(mip))
    }

    fn grid(&mut self, at: At, groups: [u32; 3]) -> Option<[u32; 3]> {
        let most = self.device.limits.max_compute_work_group_count;
        if groups.iter().zip(&most).any(|(g, m)| g > m) {
            self.numbers.error(
                at,
                format!(
                    "{groups:?} groups are more than the {most:?} that {} allows",
                    self.device.name
                ),
            );
            return None;
        }
        Some(groups)
    }
}
