//! Buffers for pictures that the window's device takes from the engine's, without a way through
//! main memory.

use crate::vulkan::{Buffer, Gpu};
use std::sync::Arc;

/// So many are enough for the frames ahead, a report that waits, and the window's two frames. More
/// is a window that does not keep up: pictures are left out for it.
const MOST: usize = 8;

/// The buffers of a side. A buffer without another holder is free.
#[derive(Default)]
pub(super) struct Ring(Vec<Arc<Buffer>>);

impl Ring {
    /// A free buffer of this size; none if all are in use, or the device has no memory for it.
    pub(super) fn free(&mut self, gpu: &Arc<Gpu>, bytes: u64) -> Option<Arc<Buffer>> {
        let size = bytes.max(16).next_multiple_of(4);
        self.0.retain(|b| b.size == size);
        if let Some(free) = self.0.iter().find(|b| Arc::strong_count(b) == 1) {
            return Some(free.clone());
        }
        if self.0.len() >= MOST {
            return None;
        }
        let made = Arc::new(Buffer::shareable(gpu, "picture for the window", bytes).ok()?);
        self.0.push(made.clone());
        Some(made)
    }
}
