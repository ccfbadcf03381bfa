//! Uses of subresources, the layouts and usage flags that follow from them, and the barriers between them.

use super::load::Graph;
use super::plan::Plan;
use super::transient::begins;
use crate::diagnostics::Diagnostic;
use crate::vulkan::vk;
use vk::{AccessFlags2 as Access, ImageLayout as Layout, PipelineStageFlags2 as Stages};

/// A resource of the graph; `true` is last frame's copy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Res {
    /// A texture.
    Texture(usize, bool),
    /// A buffer.
    Buffer(usize, bool),
}

/// How a texture is used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UseKind {
    /// Sampled in a shader.
    Sampled,
    /// Storage image.
    Storage,
    /// Colour attachment.
    Color,
    /// Depth attachment that is written.
    Depth,
    /// Depth attachment that is only tested.
    DepthRead,
    /// Clear or copy.
    Transfer,
    /// A buffer in a shader.
    Buffer,
    /// Sizes of a dispatch or draw.
    Indirect,
}

/// One use in one step.
#[derive(Clone, Debug, PartialEq)]
pub struct Use {
    /// What.
    pub res: Res,
    /// First mip and their number; (0, 1) for buffers.
    pub mips: (u32, u32),
    /// How.
    pub kind: UseKind,
    /// Stages.
    pub stages: Stages,
    /// Accesses.
    pub access: Access,
    /// Layout.
    pub layout: Layout,
    /// Reads what was there.
    pub read: bool,
    /// Writes.
    pub write: bool,
    /// Replaces everything that was there.
    pub overwrite: bool,
}

const DEPTH_STAGES: Stages =
    Stages::from_raw(Stages::EARLY_FRAGMENT_TESTS.as_raw() | Stages::LATE_FRAGMENT_TESTS.as_raw());

impl Use {
    fn new(res: Res, mips: (u32, u32), kind: UseKind, stages: Stages, access: Access) -> Use {
        Use { res, mips, kind, stages, access, layout: Layout::UNDEFINED, read: true, write: false, overwrite: false }
    }

    /// A buffer in a shader.
    pub fn buffer(buffer: usize, history: bool, stages: Stages, read: bool, write: bool, uniform: bool) -> Use {
        let mut access = Access::empty();
        if read {
            access |= if uniform { Access::UNIFORM_READ } else { Access::SHADER_STORAGE_READ };
        }
        if write {
            access |= Access::SHADER_STORAGE_WRITE;
        }
        Use { read, write, ..Use::new(Res::Buffer(buffer, history), (0, 1), UseKind::Buffer, stages, access) }
    }

    /// A texture in a shader.
    pub fn texture(
        texture: usize,
        history: bool,
        mips: (u32, u32),
        stages: Stages,
        kind: UseKind,
        read: bool,
        write: bool,
    ) -> Use {
        let mut access = Access::empty();
        if kind == UseKind::Sampled {
            access |= Access::SHADER_SAMPLED_READ;
        } else {
            if read {
                access |= Access::SHADER_STORAGE_READ;
            }
            if write {
                access |= Access::SHADER_STORAGE_WRITE;
            }
        }
        Use { read, write, ..Use::new(Res::Texture(texture, history), mips, kind, stages, access) }
    }

    /// An attachment.
    pub fn attachment(texture: usize, mip: u32, kind: UseKind, read: bool, write: bool, overwrite: bool) -> Use {
        let (stages, access) = match kind {
            UseKind::Color => (
                Stages::COLOR_ATTACHMENT_OUTPUT,
                Access::COLOR_ATTACHMENT_WRITE
                    | if overwrite { Access::empty() } else { Access::COLOR_ATTACHMENT_READ },
            ),
            UseKind::Depth => {
                (DEPTH_STAGES, Access::DEPTH_STENCIL_ATTACHMENT_READ | Access::DEPTH_STENCIL_ATTACHMENT_WRITE)
            }
            _ => (DEPTH_STAGES, Access::DEPTH_STENCIL_ATTACHMENT_READ),
        };
        Use { read, write, overwrite, ..Use::new(Res::Texture(texture, false), (mip, 1), kind, stages, access) }
    }

    /// A clear (which overwrites) or one side of a copy.
    pub fn transfer(res: Res, mips: (u32, u32), read: bool, write: bool) -> Use {
        let access = if write { Access::TRANSFER_WRITE } else { Access::TRANSFER_READ };
        Use { read, write, overwrite: write, ..Use::new(res, mips, UseKind::Transfer, Stages::ALL_TRANSFER, access) }
    }

    /// Sizes of a dispatch or draw.
    pub fn indirect(buffer: usize) -> Use {
        let access = Access::INDIRECT_COMMAND_READ;
        Use::new(Res::Buffer(buffer, false), (0, 1), UseKind::Indirect, Stages::DRAW_INDIRECT, access)
    }
}

/// Joins uses of the same subresources of the same kind (several stages, several names).
pub fn merge(uses: Vec<Use>) -> Vec<Use> {
    let mut list: Vec<Use> = Vec::new();
    for u in uses {
        match list.iter_mut().find(|o| o.res == u.res && o.mips == u.mips && o.kind == u.kind) {
            Some(other) => {
                other.stages |= u.stages;
                other.access |= u.access;
                other.read |= u.read;
                other.write |= u.write;
                other.overwrite |= u.overwrite;
            }
            None => list.push(u),
        }
    }
    list
}

/// Gives every use its layout and every texture its usage flags.
///
/// A texture that is a storage image anywhere stays in GENERAL for storage and sampling: changing layouts of 3D images
/// between dispatches buys nothing on the devices known to us.
pub fn layouts(graph: &Graph, plan: &mut Plan, errors: &mut Vec<Diagnostic>) {
    let stored: Vec<bool> = (0..plan.textures.len())
        .map(|t| {
            let is = |u: &Use| matches!(u.res, Res::Texture(x, _) if x == t) && u.kind == UseKind::Storage;
            plan.steps.iter().any(|s| s.uses.iter().any(is))
        })
        .collect();
    for step in &mut plan.steps {
        // Clears stay in GENERAL too; for copies the validation layer insists on the layouts made for them.
        let copy = matches!(step.work, super::plan::Work::CopyTexture(..));
        for u in &mut step.uses {
            let Res::Texture(t, _) = u.res else { continue };
            let (layout, usage) = match u.kind {
                UseKind::Storage => (Layout::GENERAL, vk::ImageUsageFlags::STORAGE),
                UseKind::Sampled if stored[t] => (Layout::GENERAL, vk::ImageUsageFlags::SAMPLED),
                UseKind::Color => (Layout::COLOR_ATTACHMENT_OPTIMAL, vk::ImageUsageFlags::COLOR_ATTACHMENT),
                UseKind::Depth => (Layout::DEPTH_ATTACHMENT_OPTIMAL, vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT),
                UseKind::DepthRead => (Layout::DEPTH_READ_ONLY_OPTIMAL, vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT),
                UseKind::Transfer if stored[t] && !copy => (Layout::GENERAL, vk::ImageUsageFlags::TRANSFER_DST),
                UseKind::Transfer if u.write => (Layout::TRANSFER_DST_OPTIMAL, vk::ImageUsageFlags::TRANSFER_DST),
                UseKind::Transfer => (Layout::TRANSFER_SRC_OPTIMAL, vk::ImageUsageFlags::TRANSFER_SRC),
                _ => (Layout::SHADER_READ_ONLY_OPTIMAL, vk::ImageUsageFlags::SAMPLED),
            };
            u.layout = layout;
            // Every texture can be cleared at creation and read back.
            plan.textures[t].usage |= usage | vk::ImageUsageFlags::TRANSFER_SRC | vk::ImageUsageFlags::TRANSFER_DST;
        }
        conflicts(graph, step, errors);
        for binding in &mut step.bindings {
            binding.layout = if stored[binding.texture] { Layout::GENERAL } else { Layout::SHADER_READ_ONLY_OPTIMAL };
        }
        for u in &step.uses {
            if let Res::Buffer(b, _) = u.res {
                plan.buffers[b].used = true;
            }
        }
    }
}

/// A step that needs one mip in two layouts cannot run.
fn conflicts(graph: &Graph, step: &super::plan::Step, errors: &mut Vec<Diagnostic>) {
    for (i, a) in step.uses.iter().enumerate() {
        for b in &step.uses[i + 1..] {
            let overlap = a.mips.0 < b.mips.0 + b.mips.1 && b.mips.0 < a.mips.0 + a.mips.1;
            if a.res == b.res
                && overlap
                && (a.layout != b.layout || a.write || b.write)
                && let Res::Texture(t, _) = a.res
            {
                let pass = &graph.passes[step.pass].value;
                let message = format!(
                    "pass '{}' uses '{}' in two ways at once ({:?} and {:?})",
                    pass.name.value, graph.textures[t].0, a.kind, b.kind
                );
                let found = graph.sources.error(pass.name.at, message);
                if !errors.contains(&found) {
                    errors.push(found);
                }
            }
        }
    }
}

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

/// State of one mip of one copy, or of one copy of a buffer.
#[derive(Clone, Default)]
struct State {
    layout: Layout,
    /// The last write.
    write: (Stages, Access),
    /// Stages that read since.
    reads: Stages,
    /// Who has already waited for the last write.
    seen: Vec<(Stages, Access)>,
}

/// Layouts of all mips: `[texture][copy][mip]`.
pub type Layouts = Vec<[Vec<Layout>; 2]>;

/// Barriers before each step, and the layouts that frames leave behind.
pub struct Schedule {
    /// `[parity][step]`: even and odd frames differ where something has a history.
    pub barriers: [Vec<Vec<Barrier>>; 2],
    /// `[parity]`: after even and odd frames. Those after an odd frame must hold before the first.
    pub ends: [Layouts; 2],
}

/// Derives all barriers by running the frame's uses until they repeat.
pub fn schedule(plan: &Plan) -> Schedule {
    let mut textures: Vec<[Vec<State>; 2]> =
        plan.textures.iter().map(|t| std::array::from_fn(|_| vec![State::default(); t.mips as usize])).collect();
    let mut buffers = vec![<[State; 2]>::default(); plan.buffers.len()];
    let shared = of_shared_memory(plan);
    let mut barriers = [Vec::new(), Vec::new()];
    let mut ends = [Vec::new(), Vec::new()];
    // Two rounds settle the states at the frame's border, two more record.
    for frame in 0..4 {
        let parity = frame % 2;
        barriers[parity] = plan
            .steps
            .iter()
            .map(|step| before(plan, step, parity == 1, &shared, &mut textures, &mut buffers))
            .collect();
        ends[parity] = textures
            .iter()
            .map(|copies| std::array::from_fn(|c| copies[c].iter().map(|s| s.layout).collect()))
            .collect();
    }
    Schedule { barriers, ends }
}

/// Who may have used memory before a transient resource begins in it: whoever uses transients at all.
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
    step: &super::plan::Step,
    odd: bool,
    shared: &State,
    textures: &mut [[Vec<State>; 2]],
    buffers: &mut [[State; 2]],
) -> Vec<Barrier> {
    let mut list: Vec<Barrier> = Vec::new();
    // Reads first: a step that takes its size from a buffer that it writes has not waited for that write.
    let (writes, reads): (Vec<&Use>, Vec<&Use>) = step.uses.iter().partition(|u| u.write);
    for u in reads.into_iter().chain(writes) {
        let anew = begins(u) && plan.transients.iter().any(|t| t.res == u.res);
        match u.res {
            // With history, odd frames write the second copy and read the first.
            Res::Buffer(b, history) => {
                let copy = usize::from(plan.buffers[b].history && (history != odd));
                if anew {
                    buffers[b][copy] = shared.clone();
                }
                if let Some((src, _)) = advance(&mut buffers[b][copy], u) {
                    list.push(Barrier {
                        res: Res::Buffer(b, copy == 1),
                        mips: (0, 1),
                        src,
                        dst: (u.stages, u.access),
                        layouts: (Layout::UNDEFINED, Layout::UNDEFINED),
                    });
                }
            }
            Res::Texture(t, history) => {
                let copy = usize::from(plan.textures[t].history && (history != odd));
                for mip in u.mips.0..u.mips.0 + u.mips.1 {
                    if anew {
                        textures[t][copy][mip as usize] = shared.clone();
                    }
                    let Some((src, old)) = advance(&mut textures[t][copy][mip as usize], u) else { continue };
                    let barrier = Barrier {
                        res: Res::Texture(t, copy == 1),
                        mips: (mip, 1),
                        src,
                        dst: (u.stages, u.access),
                        layouts: (old, u.layout),
                    };
                    match list.last_mut() {
                        Some(last)
                            if last.res == barrier.res
                                && last.mips.0 + last.mips.1 == mip
                                && (last.src, last.dst, last.layouts) == (src, barrier.dst, barrier.layouts) =>
                        {
                            last.mips.1 += 1;
                        }
                        _ => list.push(barrier),
                    }
                }
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
            (state.write, state.reads, state.seen) = ((u.stages, write_part(u.access)), Stages::empty(), vec![]);
        } else {
            // A transition is a write that this use has seen.
            (state.write, state.reads) = ((u.stages, Access::empty()), u.stages);
            state.seen = vec![(u.stages, u.access)];
        }
        (src.0 != Stages::empty() || transition).then_some(src)
    } else {
        let seen = state.seen.iter().any(|s| s.0.contains(u.stages) && s.1.contains(u.access));
        state.reads |= u.stages;
        // One that is only asked for its size waits for nobody.
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
