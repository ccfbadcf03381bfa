//! Objects that a program hands over to its replacement, so that an edit costs only its changes.

use super::pipelines::Pipelines;
use crate::graph::plan::Transient;
use crate::vulkan::{Buffer, Image, ImageDesc};
use std::collections::HashMap;
use std::sync::Arc;

/// One copy of a resource, two with a history, none if it is not made.
pub(super) type Copies<T> = [Option<Arc<T>>; 2];

/// Objects of a running program, for another program that reuses them.
#[derive(Clone, Default)]
pub struct Parts {
    pub(super) pipelines: Pipelines,
    pub(super) images: HashMap<String, Copies<Image>>,
    /// Buffers by name, with the requested size.
    pub(super) buffers: HashMap<String, (u64, Copies<Buffer>)>,
    /// Names of those that share memory, with when they do.
    pub(super) transients: Vec<(String, Transient)>,
    /// Bytes of that memory.
    pub(super) shared_bytes: u64,
}

/// Numbers of objects that a new program took over and made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Change {
    /// Pipelines taken over.
    pub kept: usize,
    /// Pipelines made.
    pub built: usize,
    /// Textures and buffers that existed and had to be replaced.
    pub resized: usize,
}

impl Parts {
    /// The same without textures and buffers.
    pub fn pipelines_only(&self) -> Parts {
        Parts {
            pipelines: self.pipelines.clone(),
            ..Parts::default()
        }
    }

    /// The image of that name and copy, if it is just as described.
    pub(super) fn image(&self, name: &str, copy: usize, desc: &ImageDesc) -> Option<Arc<Image>> {
        self.images.get(name)?[copy]
            .clone()
            .filter(|i| i.desc == *desc)
    }

    /// The buffer of that name and copy, if it is of that size.
    pub(super) fn buffer(&self, name: &str, copy: usize, size: u64) -> Option<Arc<Buffer>> {
        self.buffers.get(name).filter(|b| b.0 == size)?.1[copy].clone()
    }

    /// Whether it shares its memory with others.
    pub(super) fn is_shared(&self, name: &str) -> bool {
        self.transients.iter().any(|t| t.0 == name)
    }

    /// Whether there was a resource of that name, whatever its size.
    pub(super) fn had(&self, name: &str) -> bool {
        self.images.contains_key(name) || self.buffers.contains_key(name)
    }

    /// Bytes of the memory that these and no others share at these times.
    pub(super) fn shared_by(&self, transients: &[(String, Transient)]) -> Option<u64> {
        let there = self.transients.iter().map(|(name, t)| (name, &t.spans));
        there
            .eq(transients.iter().map(|(name, t)| (name, &t.spans)))
            .then_some(self.shared_bytes)
    }

    pub(super) fn holds_image(&self, image: &Arc<Image>) -> bool {
        self.images
            .values()
            .flatten()
            .flatten()
            .any(|i| Arc::ptr_eq(i, image))
    }

    pub(super) fn holds_buffer(&self, buffer: &Arc<Buffer>) -> bool {
        self.buffers
            .values()
            .flat_map(|(_, copies)| copies.iter().flatten())
            .any(|b| Arc::ptr_eq(b, buffer))
    }
}
