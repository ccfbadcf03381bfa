//! Layouts of textures at each step, and the usage flags that follow from all steps.

use super::data::{Plan, Step};
use super::uses::UseKind;
use crate::diagnostics::Diagnostic;
use crate::graph::definition::{Graph, Res};
use crate::vulkan::vk::{self, ImageLayout as Layout};

/// Gives every use its layout and every texture its usage flags.
///
/// A texture that is a storage image anywhere stays in GENERAL for storage and sampling: changing
/// layouts of 3D images between dispatches buys nothing on the devices known to us.
pub fn layouts(graph: &Graph, plan: &mut Plan, errors: &mut Vec<Diagnostic>) {
    let mut stored = vec![false; plan.textures.len()];
    for u in plan.steps.iter().flat_map(|s| &s.uses) {
        if let (UseKind::Storage, Res::Texture(t, _)) = (u.kind, u.res) {
            stored[t] = true;
        }
    }
    for step in &mut plan.steps {
        for u in &mut step.uses {
            let t = match u.res {
                Res::Texture(t, _) => t,
                Res::Buffer(b, _) => {
                    plan.buffers[b].used = true;
                    continue;
                }
            };
            let (layout, usage) = match u.kind {
                UseKind::Storage => (Layout::GENERAL, vk::ImageUsageFlags::STORAGE),
                UseKind::Sampled if stored[t] => (Layout::GENERAL, vk::ImageUsageFlags::SAMPLED),
                UseKind::Color => (
                    Layout::COLOR_ATTACHMENT_OPTIMAL,
                    vk::ImageUsageFlags::COLOR_ATTACHMENT,
                ),
                UseKind::Depth => (
                    Layout::DEPTH_ATTACHMENT_OPTIMAL,
                    vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT,
                ),
                UseKind::DepthRead => (
                    Layout::DEPTH_READ_ONLY_OPTIMAL,
                    vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT,
                ),
                UseKind::Clear if stored[t] => (Layout::GENERAL, vk::ImageUsageFlags::TRANSFER_DST),
                UseKind::Clear => (
                    Layout::TRANSFER_DST_OPTIMAL,
                    vk::ImageUsageFlags::TRANSFER_DST,
                ),
                _ => (
                    Layout::SHADER_READ_ONLY_OPTIMAL,
                    vk::ImageUsageFlags::SAMPLED,
                ),
            };
            u.layout = layout;
            // Every texture can be cleared at creation and read back.
            plan.textures[t].usage |=
                usage | vk::ImageUsageFlags::TRANSFER_SRC | vk::ImageUsageFlags::TRANSFER_DST;
        }
        conflicts(graph, step, errors);
        for binding in &mut step.bindings {
            binding.layout = if stored[binding.texture] {
                Layout::GENERAL
            } else {
                Layout::SHADER_READ_ONLY_OPTIMAL
            };
        }
    }
}

/// A step that needs one mip in two layouts cannot run.
fn conflicts(graph: &Graph, step: &Step, errors: &mut Vec<Diagnostic>) {
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
