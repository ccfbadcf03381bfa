//! The commands of a frame.

use super::bindings::StepGpu;
use super::incremental::Frame;
use super::pipelines::clear_value;
use super::resources::Resources;
use super::scene::Geometry;
use super::transfer::{copy_out, image_barrier, relayout};
use crate::graph::definition::Res;
use crate::graph::file::Which;
use crate::graph::plan::{Barrier, Plan, Schedule, Step, Work};
use crate::vulkan::{Buffer, Commands, vk};

/// What frames are recorded from.
pub(super) struct Recorder<'a> {
    pub plan: &'a Plan,
    pub schedule: &'a Schedule,
    pub resources: &'a Resources,
    pub steps: &'a [StepGpu],
    /// Names of the graph's passes.
    pub names: &'a [String],
    /// Steps where a pass begins.
    pub starts: &'a [usize],
    pub geometry: &'a Geometry,
    /// Whether the device draws many in one command.
    pub multi_draw: bool,
    /// Layouts of all images between frames.
    pub resting: &'a [vk::ImageLayout],
}

impl Recorder<'_> {
    pub fn record(
        &self,
        commands: &mut Commands<'_>,
        parity: usize,
        frame: &Frame,
        stamped: &[bool],
    ) {
        let mut labelled = false;
        for (i, step) in self.plan.steps.iter().enumerate() {
            if self
                .starts
                .binary_search(&i)
                .is_ok_and(|start| stamped[start])
            {
                if labelled {
                    commands.end_label();
                }
                commands.timestamp();
                commands.begin_label(&self.names[step.pass]);
                labelled = true;
            }
            // Skipped steps keep their barriers, so that layouts and waits are the same in every
            // frame.
            self.barriers(commands, &self.schedule.barriers[parity][i]);
            if frame.runs[i] {
                self.record_step(commands, step, &self.steps[i], parity);
            }
            for (group, _) in self
                .plan
                .settling
                .iter()
                .zip(&frame.carries)
                .filter(|(_, carries)| **carries)
            {
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
    pub fn copy_shown(
        &self,
        commands: &mut Commands<'_>,
        texture: usize,
        parity: usize,
        to_host: Option<&Buffer>,
        handed: Option<&Buffer>,
    ) {
        let Ok(image) = self.resources.image(self.plan, texture, false, parity) else {
            return;
        };
        let place = self.place(texture, (false, 0), parity);
        let layout = match self.schedule.ends[parity][place] {
            vk::ImageLayout::UNDEFINED => self.resting[place],
            layout => layout,
        };
        for to in to_host.into_iter().chain(handed) {
            copy_out(commands, image, layout, (0, 0), None, to);
        }
        if let Some(buffer) = handed {
            commands.hand_over(buffer);
        }
    }

    /// Copies the last frame's content into this frame's copies, after a step. It waits for
    /// everything, because it is rare.
    fn keep(&self, commands: &mut Commands<'_>, kept: &[Res], step: usize, parity: usize) {
        let (src, dst) = (
            vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
            vk::ImageLayout::TRANSFER_DST_OPTIMAL,
        );
        commands.full_barrier();
        for res in kept {
            match *res {
                Res::Buffer(b, _) => {
                    let buffer = |last: bool| self.resources.buffer(self.plan, b, last, parity);
                    if let (Some(last), Some(new)) = (buffer(true), buffer(false)) {
                        commands.copy_buffer(last, new, new.size);
                    }
                }
                Res::Texture(t, _) => {
                    let image = |last: bool| self.resources.image(self.plan, t, last, parity);
                    let (Ok(last), Ok(new)) = (image(true), image(false)) else {
                        continue;
                    };
                    let layouts = |history: bool, mip: u32| {
                        self.layout_after(step, t, (history, mip), parity)
                    };
                    let mips = 0..self.plan.textures[t].mips;
                    let there: Vec<_> = mips
                        .clone()
                        .map(|mip| (layouts(true, mip), layouts(false, mip), mip))
                        .collect();
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
    fn layout_after(
        &self,
        step: usize,
        t: usize,
        (history, mip): (bool, u32),
        parity: usize,
    ) -> vk::ImageLayout {
        let mut before = self.plan.steps[..=step].iter().rev().flat_map(|s| &s.uses);
        let used = before.find(|u| {
            u.res == Res::Texture(t, history) && (u.mips.0..u.mips.0 + u.mips.1).contains(&mip)
        });
        used.map_or(self.resting[self.place(t, (history, mip), parity)], |u| {
            u.layout
        })
    }

    fn place(&self, texture: usize, (last, mip): (bool, u32), parity: usize) -> usize {
        self.schedule
            .places
            .of(
                self.plan,
                Res::Texture(texture, last),
                (mip, 1),
                parity == 1,
            )
            .start
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
                    let Some(image) = &self.resources.images[t][usize::from(copy)] else {
                        continue;
                    };
                    images.push((
                        &**image,
                        image_barrier(image, b.mips, b.src, b.dst, b.layouts),
                    ));
                }
            }
        }
        commands.barrier(memory, &images);
    }

    fn record_step(&self, commands: &mut Commands<'_>, step: &Step, gpu: &StepGpu, parity: usize) {
        let raster = matches!(
            step.work,
            Work::Scene(_) | Work::Fullscreen | Work::DrawIndirect(..)
        );
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
        let buffer = |b: usize| self.resources.buffer(self.plan, b, false, parity);
        let image = |t: usize| self.resources.image(self.plan, t, false, parity);
        let layout = |t: usize| {
            let found = step.uses.iter().find(|u| u.res == Res::Texture(t, false));
            found.map_or(vk::ImageLayout::GENERAL, |u| u.layout)
        };
        match step.work {
            Work::Dispatch(groups) => commands.dispatch(groups),
            Work::DispatchIndirect(b, offset) => {
                if let Some(buffer) = buffer(b) {
                    commands.dispatch_indirect(buffer, offset);
                }
            }
            Work::Scene(which) => self.draw_scene(commands, which),
            Work::Fullscreen => commands.draw(3, 1),
            Work::DrawIndirect(b, offset) => {
                if let Some(buffer) = buffer(b) {
                    commands.draw_indirect(buffer, offset);
                }
            }
            Work::ClearTexture(t, value) => {
                if let Ok(image) = image(t) {
                    let value = clear_value(self.plan.textures[t].format.channels, value);
                    commands.clear(image, layout(t), value);
                }
            }
            Work::ClearBuffer(b, value) => {
                if let Some(buffer) = buffer(b) {
                    commands.fill(buffer, value);
                }
            }
        }
        if raster {
            commands.end_rendering();
        }
    }

    fn draw_scene(&self, commands: &mut Commands<'_>, which: Which) {
        let g = self.geometry;
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
        if self.multi_draw {
            commands.draw_indexed_indirect(&g.commands, u64::from(first) * 20, count);
        } else {
            for draw in first..first + count {
                let (first_index, index_count) = g.draws[draw as usize];
                commands.draw_indexed(index_count, first_index, draw);
            }
        }
    }
}
