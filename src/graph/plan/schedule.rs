//! Barriers between the uses of a plan.

use super::data::{Plan, Step};
use super::places::Places;
use super::uses::{Use, begins};
use crate::graph::definition::Res;
use crate::vulkan::vk::{
    AccessFlags2 as Access, ImageLayout as Layout, PipelineStageFlags2 as Stages,
};

/// One barrier before a step.
#[derive(Clone, Debug, PartialEq)]
pub struct Barrier {
    /// Texture or buffer, with the number of its copy, 0 or 1.
    pub res: Res,
    /// First mip and their number.
    pub mips: (u32, u32),
    /// Before.
    pub src: (Stages, Access),
    /// After.
    pub dst: (Stages, Access),
    /// Layouts; equal when there is no transition.
    pub layouts: (Layout, Layout),
}

/// State of a place.
#[derive(Clone, Default)]
struct State {
    layout: Layout,
    /// The last write.
    write: (Stages, Access),
    /// Stages that read since.
    reads: Stages,
    /// Stages that have already waited for the last write.
    seen: Vec<(Stages, Access)>,
}

/// Barriers before each step, and the layouts that frames leave behind.
pub struct Schedule {
    /// `[parity][step]`: even and odd frames differ where something has a history.
    pub barriers: [Vec<Vec<Barrier>>; 2],
    /// `[parity][place]`: layouts after even and odd frames. The layouts after an odd frame are
    /// needed before the first. Buffers have none.
    pub ends: [Vec<Layout>; 2],
    /// The places.
    pub places: Places,
}

/// Derives all barriers by running the frame's uses until they repeat.
pub fn schedule(plan: &Plan) -> Schedule {
    let places = Places::new(plan);
    let mut states = vec![State::default(); places.count];
    let shared = of_shared_memory(plan);
    let mut barriers = [Vec::new(), Vec::new()];
    let mut ends = [Vec::new(), Vec::new()];
    // Two rounds find the states at the frame's border, two more record.
    for frame in 0..4 {
        let parity = frame % 2;
        let before = |step| before(plan, &places, step, parity == 1, &shared, &mut states);
        barriers[parity] = plan.steps.iter().map(before).collect();
        ends[parity] = states.iter().map(|s| s.layout).collect();
    }
    Schedule {
        barriers,
        ends,
        places,
    }
}

/// Stages that may have used the memory before a transient resource begins in it: all that use
/// transient resources.
fn of_shared_memory(plan: &Plan) -> State {
    let is_shared = |u: &&Use| plan.transients.iter().any(|t| t.res == u.res);
    let mut all = State::default();
    for u in plan.steps.iter().flat_map(|s| &s.uses).filter(is_shared) {
        all.write.0 |= u.stages;
        all.write.1 |= write_part(u.access);
    }
    all
}

fn before(
    plan: &Plan,
    places: &Places,
    step: &Step,
    odd: bool,
    shared: &State,
    states: &mut [State],
) -> Vec<Barrier> {
    let mut list: Vec<Barrier> = Vec::new();
    // Reads first: a step that takes its size from a buffer that it writes has not waited for that
    // write.
    let (writes, reads): (Vec<&Use>, Vec<&Use>) = step.uses.iter().partition(|u| u.write);
    for u in reads.into_iter().chain(writes) {
        let anew = begins(u) && plan.transients.iter().any(|t| t.res == u.res);
        let copy = plan.copy_of(u.res, odd);
        let res = match u.res {
            Res::Texture(t, _) => Res::Texture(t, copy == 1),
            Res::Buffer(b, _) => Res::Buffer(b, copy == 1),
        };
        for (mip, place) in (u.mips.0..).zip(places.of_copy(res, u.mips, copy)) {
            let state = &mut states[place];
            if anew {
                *state = shared.clone();
            }
            let Some((src, old)) = advance(state, u) else {
                continue;
            };
            let (dst, layouts) = ((u.stages, u.access), (old, u.layout));
            match list.last_mut() {
                Some(last)
                    if last.res == res
                        && last.mips.0 + last.mips.1 == mip
                        && (last.src, last.dst, last.layouts) == (src, dst, layouts) =>
                {
                    last.mips.1 += 1;
                }
                _ => list.push(Barrier {
                    res,
                    mips: (mip, 1),
                    src,
                    dst,
                    layouts,
                }),
            }
        }
    }
    list
}

/// Moves a state past a use; the barrier's source and old layout when one is needed.
fn advance(state: &mut State, u: &Use) -> Option<((Stages, Access), Layout)> {
    let old = state.layout;
    let transition = old != u.layout;
    let source = if u.write || transition {
        // Waits for the last write and for all reads since.
        let src = (state.write.0 | state.reads, state.write.1);
        state.layout = u.layout;
        if u.write {
            // Later readers must wait for this write.
            (state.write, state.reads, state.seen) =
                ((u.stages, write_part(u.access)), Stages::empty(), vec![]);
        } else {
            // A transition is a write that this use has seen.
            (state.write, state.reads) = ((u.stages, Access::empty()), u.stages);
            state.seen = vec![(u.stages, u.access)];
        }
        (src.0 != Stages::empty() || transition).then_some(src)
    } else {
        let seen = state
            .seen
            .iter()
            .any(|s| s.0.contains(u.stages) && s.1.contains(u.access));
        state.reads |= u.stages;
        // A size query needs no barrier.
        let waits = u.read && state.write.0 != Stages::empty() && !seen;
        if waits {
            state.seen.push((u.stages, u.access));
        }
        waits.then_some(state.write)
    };
    source.map(|src| (src, old))
}

fn write_part(access: Access) -> Access {
    access
        & (Access::SHADER_STORAGE_WRITE
            | Access::COLOR_ATTACHMENT_WRITE
            | Access::DEPTH_STENCIL_ATTACHMENT_WRITE
            | Access::TRANSFER_WRITE)
}
