//! Passes that accumulate over frames. The passes of a `settles` stop together after its number of
//! frames without a change, and keep their result. Their inputs, except their own output, decide
//! what counts as a change.

use super::converge::Declared;
use super::data::{Plan, Settling, Step};
use super::uses::{Use, parts};
use crate::diagnostics::{At, Diagnostic};
use crate::graph::debug::DEBUG_BUFFER;
use crate::graph::definition::{Graph, Res};
use std::collections::{BTreeMap, BTreeSet};

/// The groups of steps that converge; `frames` has the place and the count of each pass's
/// declaration.
///
/// # Errors
/// Passes among them that meddle with what others write, or read it where it may be missing.
pub(super) fn find(
    graph: &Graph,
    plan: &Plan,
    frames: &Declared,
) -> Result<Vec<Settling>, Vec<Diagnostic>> {
    let steps = &plan.steps;
    let mut groups: BTreeMap<At, (u32, Vec<usize>)> = BTreeMap::new();
    for (i, step) in steps.iter().enumerate() {
        if let Some((at, frames)) = frames.get(&step.pass) {
            groups.entry(*at).or_insert((*frames, Vec::new())).1.push(i);
        }
    }
    let errors: Vec<Diagnostic> = groups
        .values()
        .filter_map(|(_, own)| meddler(graph, plan, own))
        .collect();
    if !errors.is_empty() {
        return Err(errors);
    }
    let settling = |(frames, own): (u32, Vec<usize>)| {
        let mut kept = Vec::new();
        for u in written(steps, &own).filter(|u| plan.has_history(u.res)) {
            if !kept.contains(&u.res) {
                kept.push(u.res);
            }
        }
        Settling {
            frames,
            ring: ring(steps, &own, debug(graph)),
            kept,
            steps: own,
        }
    };
    Ok(groups.into_values().map(settling).collect())
}

/// The buffer of shown values. Passes that share it do not depend on one another.
fn debug(graph: &Graph) -> Option<Res> {
    graph.buffer(DEBUG_BUFFER).map(|b| Res::Buffer(b, false))
}

fn written<'a>(steps: &'a [Step], own: &[usize]) -> impl Iterator<Item = &'a Use> {
    own.iter().flat_map(|i| &steps[*i].uses).filter(|u| u.write)
}

/// The first other pass that writes a group's output, reads it before the group's last step, or
/// reads output without a history.
fn meddler(graph: &Graph, plan: &Plan, own: &[usize]) -> Option<Diagnostic> {
    let steps = &plan.steps;
    let (first, last) = (own.first()?, own.last()?);
    let name = |i: usize| &graph.passes[steps[i].pass].value.name;
    for (i, step) in steps.iter().enumerate().filter(|(i, _)| !own.contains(i)) {
        for u in &step.uses {
            let shared = |w: &&Use| w.res == u.res && Some(w.res) != debug(graph);
            let Some(theirs) = written(steps, own).find(shared) else {
                continue;
            };
            let what = graph.title_of(u.res);
            let message = match theirs {
                _ if u.write => format!(
                    "'{what}' is written by pass '{}' too, which settles",
                    name(*first).value
                ),
                _ if (*first..=*last).contains(&i) => {
                    format!(
                        "'{what}' is read here before pass '{}', which settles, is through",
                        name(*last).value
                    )
                }
                _ if !plan.has_history(u.res) => format!(
                    "'{what}' is read here and written by pass '{}', which settles: give it a history, so that it is kept",
                    name(*first).value
                ),
                _ => continue,
            };
            return Some(graph.sources.error(name(i).at, message));
        }
    }
    None
}

/// Steps that depend on some of `own`, over frames too, and on which those depend.
fn ring(steps: &[Step], own: &[usize], debug: Option<Res>) -> Vec<usize> {
    // Both copies of a resource with a history: it is read in this frame or in the next.
    let touched = |i: usize, how: fn(&Use) -> bool| -> BTreeSet<_> {
        steps[i]
            .uses
            .iter()
            .filter(|u| how(u) && Some(u.res) != debug)
            .flat_map(parts)
            .collect()
    };
    let reads: Vec<BTreeSet<_>> = (0..steps.len()).map(|i| touched(i, |u| u.read)).collect();
    let writes: Vec<BTreeSet<_>> = (0..steps.len()).map(|i| touched(i, |u| u.write)).collect();
    let reached = |from: &[BTreeSet<_>], to: &[BTreeSet<_>]| {
        let mut list: BTreeSet<usize> = own.iter().copied().collect();
        let mut parts: BTreeSet<_> = own.iter().flat_map(|i| &from[*i]).copied().collect();
        while let Some(next) =
            (0..steps.len()).find(|i| !list.contains(i) && !to[*i].is_disjoint(&parts))
        {
            list.insert(next);
            parts.extend(&from[next]);
        }
        list
    };
    reached(&writes, &reads)
        .intersection(&reached(&reads, &writes))
        .copied()
        .collect()
}
