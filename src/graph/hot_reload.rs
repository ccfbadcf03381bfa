//! Reload: a program hands over what its new program can use as it is, so that an edit costs what it changes.

use super::pipelines::Pipelines;
use super::resources::named;
use super::run::{Program, relayout};
use super::transient::Transient;
use super::usage::Layouts;
use crate::vulkan::{Buffer, Commands, Image, ImageDesc, Result, vk};
use std::collections::HashMap;
use std::sync::Arc;

/// A buffer's one or two copies.
type Copies = [Option<Arc<Buffer>>; 2];

/// What a running program has made, to make another from while it runs on.
#[derive(Clone, Default)]
pub struct Parts {
    pub(super) pipelines: Pipelines,
    images: HashMap<String, [Option<Arc<Image>>; 2]>,
    /// By name, with the size asked for.
    buffers: HashMap<String, (u64, Copies)>,
    /// Names of those that share memory, with when they do.
    transients: Vec<(String, Transient)>,
    /// Bytes of that memory.
    shared_bytes: u64,
}

/// What a new program took over and what it had to make.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Change {
    /// Pipelines taken over.
    pub kept: usize,
    /// Pipelines made.
    pub built: usize,
    /// Textures and buffers that were there and had to be made anew.
    pub resized: usize,
}

impl Parts {
    /// The same without textures and buffers.
    pub fn pipelines_only(&self) -> Parts {
        Parts { pipelines: self.pipelines.clone(), ..Parts::default() }
    }

    /// The image of that name and copy, if it is just as described and has memory of its own.
    pub(super) fn image(&self, name: &str, copy: usize, desc: &ImageDesc) -> Option<Arc<Image>> {
        let image = self.images.get(name).filter(|_| !self.is_transient(name))?[copy].clone();
        image.filter(|i| i.desc == *desc)
    }

    /// The buffer of that name and copy, if it is of that size and has memory of its own.
    pub(super) fn buffer(&self, name: &str, copy: usize, size: u64) -> Option<Arc<Buffer>> {
        self.buffers.get(name).filter(|b| b.0 == size && !self.is_transient(name)).and_then(|b| b.1[copy].clone())
    }

    /// A transient image.
    pub(super) fn shared_image(&self, name: &str, desc: &ImageDesc) -> Option<Arc<Image>> {
        self.images.get(name)?[0].clone().filter(|i| i.desc == *desc)
    }

    /// A transient buffer.
    pub(super) fn shared_buffer(&self, name: &str, size: u64) -> Option<Arc<Buffer>> {
        self.buffers.get(name).filter(|b| b.0 == size).and_then(|b| b.1[0].clone())
    }

    fn is_transient(&self, name: &str) -> bool {
        self.transients.iter().any(|t| t.0 == name)
    }

    /// Whether there was a resource of that name, whatever its size.
    pub(super) fn had(&self, name: &str) -> bool {
        self.images.contains_key(name) || self.buffers.contains_key(name)
    }

    /// Bytes of the memory that these and no others share at these times.
    pub(super) fn shared_by(&self, transients: &[(String, Transient)]) -> Option<u64> {
        let there = self.transients.iter().map(|(name, t)| (name, &t.spans));
        there.eq(transients.iter().map(|(name, t)| (name, &t.spans))).then_some(self.shared_bytes)
    }

    pub(super) fn holds_image(&self, image: &Arc<Image>) -> bool {
        self.images.values().flatten().flatten().any(|i| Arc::ptr_eq(i, image))
    }

    pub(super) fn holds_buffer(&self, buffer: &Arc<Buffer>) -> bool {
        self.buffers.values().flat_map(|(_, copies)| copies.iter().flatten()).any(|b| Arc::ptr_eq(b, buffer))
    }
}

impl Program {
    /// What a new program can take over. The program may run on while the new program is made.
    pub fn parts(&self, graph: &super::load::Graph) -> Parts {
        let images = graph.textures.iter().zip(&self.images).filter(|(_, i)| i[0].is_some());
        let buffers =
            graph.buffers.iter().zip(&self.buffers).zip(&self.plan.buffers).filter(|((_, b), _)| b[0].is_some());
        Parts {
            pipelines: self.pipelines.clone(),
            images: images.map(|(t, i)| (t.0.clone(), i.clone())).collect(),
            buffers: buffers.map(|((b, made), plan)| (b.0.clone(), (plan.size, made.clone()))).collect(),
            transients: named(graph, &self.plan),
            shared_bytes: self.shared_bytes,
        }
    }

    /// Takes the place of the program that this one was made from: waits for its frames, goes on with its count of
    /// frames (so that what was last frame's stays last frame's) and brings images into the layouts of its own frames.
    ///
    /// # Errors
    /// The device was lost.
    pub fn swap_in(&mut self, old: &mut Program) -> Result<()> {
        old.finish_all()?;
        self.frame = old.frame;
        self.set_redo(old.redo);
        let before = usize::try_from((self.frame + 1) % 2).unwrap_or(0);
        let mut wanted: Layouts = self.schedule.ends[before].clone();
        let mut from = self.resting.clone();
        for (t, copies) in self.images.iter().enumerate() {
            for (c, image) in copies.iter().enumerate() {
                let Some(image) = image else { continue };
                if let Some(layouts) = old.layouts_of(image) {
                    from[t][c].clone_from_slice(layouts);
                }
            }
        }
        let mut barriers = Vec::new();
        for (t, copies) in self.images.iter().enumerate() {
            for (c, image) in copies.iter().enumerate() {
                // What is transient is taken out of any layout where it begins.
                let Some(image) = image.as_ref().filter(|_| !self.plan.textures[t].transient) else { continue };
                for (mip, (from, to)) in (0u32..).zip(from[t][c].iter().zip(&mut wanted[t][c])) {
                    if *to == vk::ImageLayout::UNDEFINED {
                        *to = *from;
                    } else if to != from {
                        barriers.push((&**image, relayout(image, *from, *to, mip)));
                    }
                }
            }
        }
        if !barriers.is_empty() {
            Commands::once(self.gpu(), |commands| {
                commands.barrier(None, &barriers);
                commands.full_barrier();
            })?;
        }
        self.resting = wanted;
        Ok(())
    }

    /// The layouts in which an image of this program rests, by mip.
    fn layouts_of(&self, image: &Arc<Image>) -> Option<&[vk::ImageLayout]> {
        let copies = self.images.iter().zip(&self.resting);
        copies
            .flat_map(|(images, layouts)| images.iter().zip(layouts))
            .find(|(i, _)| i.as_ref().is_some_and(|i| Arc::ptr_eq(i, image)))
            .map(|(_, layouts)| layouts.as_slice())
    }
}
