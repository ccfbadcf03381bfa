//! Leaves out what nobody needs: passes, attachments, textures.

use super::load::Graph;
use super::plan::{Plan, Step};
use super::usage::{Res, Use};
use std::collections::BTreeSet;

/// A subresource: (is a buffer, index, mip). The history of a texture is needed as its content at the end of a frame.
type Part = (bool, usize, u32);

fn parts(u: &Use) -> impl Iterator<Item = Part> + use<> {
    let (buffer, index) = match u.res {
        Res::Texture(t, _) => (false, t),
        Res::Buffer(b) => (true, b),
    };
    (u.mips.0..u.mips.0 + u.mips.1).map(move |mip| (buffer, index, mip))
}

fn is_history(u: &Use) -> bool {
    matches!(u.res, Res::Texture(_, true))
}

/// Keeps the steps that the wanted resources depend on, over frames too, and tells why the others were left out.
///
/// Stores of shaders count as partial, so what they write stays needed before them; clears replace everything.
pub(super) fn prune(graph: &Graph, plan: &mut Plan, wanted: &[String]) {
    let mut at_end: BTreeSet<Part> = BTreeSet::new();
    for name in wanted {
        if let Some(t) = graph.textures.iter().position(|x| x.0 == *name) {
            at_end.extend((0..plan.textures[t].mips).map(|mip| (false, t, mip)));
        } else if let Some(b) = graph.buffers.iter().position(|x| x.0 == *name) {
            at_end.insert((true, b, 0));
        }
    }
    // What a frame reads before writing it must be right at the end of the frame before: repeat until nothing is added.
    let kept = loop {
        let (kept, at_start, history) = backward(&plan.steps, &at_end);
        let before = at_end.len();
        at_end.extend(at_start);
        at_end.extend(history);
        if at_end.len() == before {
            break kept;
        }
    };
    let mut steps = Vec::new();
    let mut unneeded: Vec<usize> = Vec::new();
    for (step, keep) in std::mem::take(&mut plan.steps).into_iter().zip(kept) {
        match keep {
            Some(color) => {
                let mut step = step;
                for (slot, needed) in step.color.iter_mut().zip(color) {
                    if !needed && let Some(target) = slot.take() {
                        let gone = |u: &Use| {
                            u.res == Res::Texture(target.texture, false)
                                && u.mips.0 == target.mip
                                && u.kind == super::usage::UseKind::Color
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
        if !plan.steps.iter().any(|s| s.pass == pass) {
            plan.dropped.push((pass, String::from("nobody needs what it writes")));
        }
    }
    plan.dropped.sort_unstable();
}

/// For each step from the last: `None` when it can go, else which colour attachments are needed; and what must be there
/// at the start, and as history.
fn backward(steps: &[Step], at_end: &BTreeSet<Part>) -> (Vec<Option<Vec<bool>>>, BTreeSet<Part>, BTreeSet<Part>) {
    let mut live = at_end.clone();
    let mut history = BTreeSet::new();
    let mut kept: Vec<Option<Vec<bool>>> = vec![None; steps.len()];
    for (i, step) in steps.iter().enumerate().rev() {
        let needed = step.uses.iter().any(|u| u.write && parts(u).any(|p| live.contains(&p)));
        if !needed {
            continue;
        }
        let color: Vec<bool> = step
            .color
            .iter()
            .map(|slot| slot.as_ref().is_some_and(|t| live.contains(&(false, t.texture, t.mip))))
            .collect();
        let unneeded_color = |u: &Use| u.kind == super::usage::UseKind::Color && parts(u).all(|p| !live.contains(&p));
        let uses: Vec<&Use> = step.uses.iter().filter(|u| !unneeded_color(u)).collect();
        for u in uses.iter().filter(|u| u.overwrite) {
            for part in parts(u) {
                live.remove(&part);
            }
        }
        for u in uses.iter().filter(|u| u.read) {
            let target = if is_history(u) { &mut history } else { &mut live };
            target.extend(parts(u));
        }
        kept[i] = Some(color);
    }
    (kept, live, history)
}
