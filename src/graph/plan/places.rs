//! A number for each piece of content: a mip of a copy of a texture, or a copy of a buffer.

use super::data::Plan;
use crate::graph::definition::Res;
use std::ops::Range;

/// The places of a plan.
pub struct Places {
    /// First numbers of the two copies of each texture. Buffers follow.
    textures: Vec<[usize; 2]>,
    buffers: usize,
    /// How many there are.
    pub count: usize,
}

impl Places {
    /// Places of all textures and buffers, used or not.
    pub fn new(plan: &Plan) -> Places {
        let mut count = 0;
        let mut next = |places: usize| {
            count += places;
            count - places
        };
        let textures = plan
            .textures
            .iter()
            .map(|t| [next(t.mips as usize), next(t.mips as usize)])
            .collect();
        let buffers = next(2 * plan.buffers.len());
        Places {
            textures,
            buffers,
            count,
        }
    }

    /// The places of mips of a copy; a buffer has one mip.
    pub fn of_copy(&self, res: Res, mips: (u32, u32), copy: usize) -> Range<usize> {
        let first = match res {
            Res::Texture(t, _) => self.textures[t][copy],
            Res::Buffer(b, _) => self.buffers + 2 * b + copy,
        };
        first + mips.0 as usize..first + (mips.0 + mips.1) as usize
    }

    /// The places of mips of a resource in even or odd frames.
    pub fn of(&self, plan: &Plan, res: Res, mips: (u32, u32), odd: bool) -> Range<usize> {
        self.of_copy(res, mips, plan.copy_of(res, odd))
    }
}
