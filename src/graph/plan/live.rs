//! Removes unused passes, attachments, stores to images, and textures.

use super::data::{BindingPlan, Plan, Step, Work};
use super::uses::{Part, Use, UseKind, parts};
use crate::graph::debug::{CLEAR, DEBUG_BUFFER};
use crate::graph::definition::{Graph, Res};
use crate::graph::link::Linked;
use crate::shader::Resource;
use crate::vulkan::vk::AccessFlags2;
use std::collections::BTreeSet;

/// Keeps the steps that the wanted resources depend on, over frames too, and records why the others
/// are left out.
///
/// Stores of shaders count as partial, so earlier content stays needed. Clears replace everything.
pub(super) fn prune(graph: &Graph, linked: &[Linked], plan: &mut Plan, wanted: &[String]) {
    let mut at_end: BTreeSet<Part> = BTreeSet::new();
    for name in wanted {
        let Some(res) = graph.resource(name) else {
            continue;
        };
        let mips = if let Res::Texture(t, _) = res {
            plan.textures[t].mips
        } else {
            1
        };
        at_end.extend((0..mips).map(|mip| (res, mip)));
    }
    let debug = graph.buffer(DEBUG_BUFFER).map(|b| Res::Buffer(b, false));
    // A read before the first write needs the content at the end of the last frame: repeat until
    // nothing is added.
    let kept = loop {
        let (kept, at_start, history) = backward(&plan.steps, &at_end, debug);
        let before = at_end.len();
        at_end.extend(at_start);
        at_end.extend(history);
        if at_end.len() == before {
            break kept;
        }
    };
    let mut steps = Vec::new();
    let mut unneeded: Vec<usize> = Vec::new();
    for (mut step, keep) in std::mem::take(&mut plan.steps).into_iter().zip(kept) {
        match keep {
            Some(needed) => {
                for image in &needed.unneeded_images {
                    leave_out(&linked[step.pass], &mut step, image);
                }
                for (slot, needed) in step.color.iter_mut().zip(needed.color) {
                    if !needed && let Some(target) = slot.take() {
                        let gone = |u: &Use| {
                            u.res == Res::Texture(target.texture, false)
                                && u.mips.0 == target.mip
                                && u.kind == UseKind::Color
                        };
                        step.uses.retain(|u| !gone(u));
                    }
                }
                steps.push(step);
            }
            None if !unneeded.contains(&step.pass) => unneeded.push(step.pass),
            None => {}
        }
    }
    plan.steps = steps;
    for pass in unneeded {
        let hidden = graph.pass_name(pass) == CLEAR;
        if !hidden && !plan.steps.iter().any(|s| s.pass == pass) {
            plan.dropped
                .push((pass, String::from("its output is unused")));
        }
    }
    plan.dropped.sort_unstable();
}

/// Removes the stores to an image from a step. The binding stays if the shader queries the size.
fn leave_out(link: &Linked, step: &mut Step, image: &Use) {
    let mut sized = false;
    let stored = |b: &BindingPlan| {
        Res::Texture(b.texture, b.history) == image.res
            && b.mips == image.mips
            && matches!(link.bound[b.bound].resource, Resource::Storage { .. })
    };
    for binding in std::mem::take(&mut step.bindings) {
        let is_stored = stored(&binding);
        if is_stored {
            step.stripped.push(binding.bound);
        }
        let asked = matches!(
            link.bound[binding.bound].resource,
            Resource::Storage { sized: true, .. }
        );
        sized |= is_stored && asked;
        if !is_stored || asked {
            step.bindings.push(binding);
        }
    }
    if sized {
        for u in step.uses.iter_mut().filter(|u| *u == image) {
            (u.write, u.access) = (false, AccessFlags2::empty());
        }
    } else {
        step.uses.retain(|u| u != image);
    }
}

/// Needed outputs of a step.
#[derive(Clone)]
struct Needed {
    /// Whether each colour attachment is.
    color: Vec<bool>,
    /// Images that a compute shader writes without use.
    unneeded_images: Vec<Use>,
}

/// Needed outputs of each step, from the last one on; `None` if it can go. Also the content needed
/// at the start, and as history.
fn backward(
    steps: &[Step],
    at_end: &BTreeSet<Part>,
    debug: Option<Res>,
) -> (Vec<Option<Needed>>, BTreeSet<Part>, BTreeSet<Part>) {
    let mut live = at_end.clone();
    let mut history = BTreeSet::new();
    let mut kept: Vec<Option<Needed>> = vec![None; steps.len()];
    for (i, step) in steps.iter().enumerate().rev() {
        let for_nobody = |u: &Use| parts(u).all(|p| !live.contains(&p));
        // Shown values keep no pass alive, but their clear.
        let records = |u: &Use| Some(u.res) == debug && u.kind != UseKind::Clear;
        let needed = step
            .uses
            .iter()
            .any(|u| u.write && !records(u) && !for_nobody(u));
        if !needed {
            continue;
        }
        let color: Vec<bool> = step
            .color
            .iter()
            .map(|slot| {
                slot.as_ref()
                    .is_some_and(|t| live.contains(&(Res::Texture(t.texture, false), t.mip)))
            })
            .collect();
        let dispatch = matches!(step.work, Work::Dispatch(_) | Work::DispatchIndirect(..));
        let only_stored = |u: &Use| dispatch && u.kind == UseKind::Storage && u.write && !u.read;
        let unneeded_images: Vec<Use> = step
            .uses
            .iter()
            .filter(|u| only_stored(u) && for_nobody(u))
            .cloned()
            .collect();
        let unneeded_color = |u: &Use| u.kind == UseKind::Color && for_nobody(u);
        let uses: Vec<&Use> = step.uses.iter().filter(|u| !unneeded_color(u)).collect();
        for u in uses.iter().filter(|u| u.overwrite) {
            for part in parts(u) {
                live.remove(&part);
            }
        }
        for u in uses.iter().filter(|u| u.read) {
            let target = if u.res != u.res.current() {
                &mut history
            } else {
                &mut live
            };
            target.extend(parts(u));
        }
        kept[i] = Some(Needed {
            color,
            unneeded_images,
        });
    }
    (kept, live, history)
}
