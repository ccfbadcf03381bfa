//! Reload: a program hands over what its new program can use as it is, so that an edit costs what
//! it changes.

use super::parts::Parts;
use super::program::Program;
use super::resources::{Resources, named};
use super::transfer::relayout;
use crate::graph::definition::Graph;
use crate::vulkan::{Commands, Image, Result, vk};
use std::sync::Arc;

impl Program {
    /// Objects that a new program can take over. The program may run while the new one is made.
    pub fn parts(&self, graph: &Graph) -> Parts {
        let Resources {
            images,
            buffers,
            shared_bytes,
        } = &self.resources;
        let images = graph
            .textures
            .iter()
            .zip(images)
            .filter(|(_, i)| i[0].is_some());
        let buffers = graph
            .buffers
            .iter()
            .zip(buffers)
            .zip(&self.plan.buffers)
            .filter(|((_, b), _)| b[0].is_some());
        Parts {
            pipelines: self.pipelines.clone(),
            images: images.map(|(t, i)| (t.0.clone(), i.clone())).collect(),
            buffers: buffers
                .map(|((b, made), plan)| (b.0.clone(), (plan.size, made.clone())))
                .collect(),
            transients: named(graph, &self.plan),
            shared_bytes: *shared_bytes,
        }
    }

    /// Takes the place of the program that this one was made from: waits for its frames, goes on
    /// with its count of frames (so that last frame's copies stay the same) and brings images into
    /// the layouts of its own frames.
    ///
    /// # Errors
    /// The device was lost.
    pub fn swap_in(&mut self, old: &mut Program) -> Result<()> {
        old.finish_all()?;
        self.frame = old.frame;
        self.set_execution(old.execution());
        let before = usize::try_from((self.frame + 1) % 2).unwrap_or(0);
        let mut wanted = self.schedule.ends[before].clone();
        let mut barriers = Vec::new();
        // Transient resources begin from any layout.
        for (_, image, places) in self
            .images()
            .filter(|(t, ..)| !self.plan.textures[*t].transient)
        {
            let from = old
                .layouts_of(image)
                .unwrap_or(&self.resting[places.clone()]);
            for (mip, (from, to)) in (0u32..).zip(from.iter().zip(&mut wanted[places])) {
                if *to == vk::ImageLayout::UNDEFINED {
                    *to = *from;
                } else if to != from {
                    barriers.push((&**image, relayout(image, *from, *to, mip)));
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
        self.images()
            .find(|(_, i, _)| Arc::ptr_eq(i, image))
            .map(|(.., places)| &self.resting[places])
    }
}
