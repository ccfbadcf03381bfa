//! A frame's plan: sizes, then steps, then the removal of unused ones.

use super::data::{BufferPlan, Convergence, Plan, Step, TexturePlan};
use super::numbers::Numbers;
use super::steps::Planner;
use super::uses::{Use, UseKind, merge};
use super::{converge, layout, live, needs, settle, sizes, transient};
use crate::diagnostics::{Diagnostic, Place};
use crate::graph::definition::Res;
use crate::graph::evaluated::Evaluated;
use crate::graph::expr::Var;
use crate::graph::link::{Layouts, Linked};
use crate::vulkan::DeviceInfo;
use std::collections::BTreeMap;

/// Plans a frame. `wanted` are resources that must hold their result at its end.
///
/// # Errors
/// Sizes that make no sense or that the device cannot make, features that it lacks.
pub fn plan(
    set: &Evaluated<'_>,
    linked: &[Linked],
    wanted: &[String],
    device: &DeviceInfo,
) -> Result<Plan, Vec<Diagnostic>> {
    if !set.errors.is_empty() {
        return Err(set.errors.clone());
    }
    let graph = set.graph;
    let layouts = Layouts::new(graph, linked);
    let mut numbers = Numbers::new(set);
    for refused in &graph.refuse {
        if numbers.holds(&refused.when) {
            numbers.error(refused.when.at, refused.message.clone());
        }
    }
    let mut textures = sizes::textures(&mut numbers, wanted, device);
    if !numbers.errors.is_empty() {
        return Err(numbers.errors);
    }
    let mut buffers = sizes::buffers(&mut numbers, &layouts, wanted, device);
    let (mut steps, mut dropped) = (Vec::new(), Vec::new());
    let (mut settles, mut converges) = (BTreeMap::new(), BTreeMap::new());
    // What passes write that are left out.
    let mut missing: Vec<Res> = Vec::new();
    let mut instead: Vec<(usize, usize)> = Vec::new();
    let mut planner = Planner {
        numbers,
        layouts,
        device,
        textures: &textures,
        buffers: &buffers,
    };
    for (number, (pass, link)) in graph.passes.iter().zip(linked).enumerate() {
        if let Some(when) = pass
            .value
            .conditions()
            .find(|when| !planner.numbers.holds(when))
        {
            dropped.push((number, format!("{} is false", when.value.text)));
            continue;
        }
        let planned = planner.steps(number, &pass.value, link);
        if set.params.off.contains(&pass.value.name.value) {
            let uses = planned.into_iter().flat_map(|s| s.uses);
            missing.extend(uses.filter(|u| u.write).map(|u| u.res));
            let texture = |name: &str| graph.texture(name);
            let pairs = pass.value.instead.0.iter();
            instead.extend(
                pairs.filter_map(|(of, read)| {
                    Some((texture(&of.value)?, texture(&read.value.value)?))
                }),
            );
            dropped.push((number, "it is off".into()));
            continue;
        }
        steps.extend(planned);
        if let Some(ex) = &pass.value.settles {
            settles.insert(number, (ex.at, planner.numbers.count(ex, 1, "settles")));
        }
        if let Some(ex) = &pass.value.converges {
            converges.insert(number, (ex.at, planner.numbers.count(ex, 1, "converges")));
        }
    }
    let mut numbers = planner.numbers;
    // Backwards: with two filters off, a reader of the second reads the input of the first.
    for (of, read) in instead.into_iter().rev() {
        read_instead(&textures, &mut steps, of, read);
    }
    for res in &missing {
        match *res {
            Res::Texture(t, _) => textures[t].transient = false,
            Res::Buffer(b, _) => buffers[b].transient = false,
        }
        numbers
            .errors
            .extend(nobody_writes(set, wanted, &steps, *res));
    }
    written_anew(&textures, &buffers, &mut steps);
    let max_edge = max_edge(&mut numbers);
    if !numbers.errors.is_empty() {
        return Err(numbers.errors);
    }
    let (settling, convergence, transients) = (Vec::new(), Convergence::default(), Vec::new());
    let mut plan = Plan {
        textures,
        buffers,
        steps,
        settling,
        convergence,
        transients,
        missing,
        dropped,
        max_edge,
    };
    let mut errors = Vec::new();
    live::prune(graph, linked, &mut plan, wanted);
    layout::layouts(graph, &mut plan, &mut errors);
    plan.convergence = converge::frames(&plan, &settles, &converges);
    match settle::find(graph, &plan, &settles) {
        Ok(settling) => plan.settling = settling,
        Err(found) => errors.extend(found),
    }
    match transient::find(graph, &plan) {
        Ok(transients) => plan.transients = transients,
        Err(found) => errors.extend(found),
    }
    errors.extend(needs::check(set, linked, &plan, device));
    if errors.is_empty() {
        Ok(plan)
    } else {
        Err(errors)
    }
}

/// Resources that only passes which are off write hold zeros. The picture itself needs a writer.
fn nobody_writes(
    set: &Evaluated<'_>,
    wanted: &[String],
    steps: &[Step],
    res: Res,
) -> Option<Diagnostic> {
    let name = set.graph.title_of(res);
    let written = steps
        .iter()
        .flat_map(|s| &s.uses)
        .any(|u| u.write && u.res == res);
    (!written && wanted.contains(&name)).then(|| {
        let off = set.params.off.join(", ");
        Diagnostic::error(
            Place::default(),
            format!("nothing writes '{name}' when these passes are off: {off}"),
        )
    })
}

/// Has steps read one texture in place of another, if it can be bound where that one is.
fn read_instead(textures: &[TexturePlan], steps: &mut [Step], of: usize, read: usize) {
    let shape = |t: usize| {
        (
            textures[t].extent,
            textures[t].layers,
            textures[t].mips,
            textures[t].format.name,
        )
    };
    if shape(of) != shape(read) || textures[of].volume != textures[read].volume {
        return;
    }
    let (of, by) = (Res::Texture(of, false), read);
    for step in steps {
        let plain = |u: &Use| !u.write && matches!(u.kind, UseKind::Sampled | UseKind::Storage);
        // Passes that add to it keep its content.
        if step.uses.iter().any(|u| u.res == of && !plain(u)) {
            continue;
        }
        for binding in step
            .bindings
            .iter_mut()
            .filter(|b| Res::Texture(b.texture, b.history) == of)
        {
            binding.texture = by;
        }
        for u in step.uses.iter_mut().filter(|u| u.res == of) {
            u.res = Res::Texture(by, false);
        }
        step.uses = merge(std::mem::take(&mut step.uses));
    }
}

/// The first store to a resource with a history, or to a transient one, replaces everything: by
/// their declarations, no older content is left.
fn written_anew(textures: &[TexturePlan], buffers: &[BufferPlan], steps: &mut [Step]) {
    let begun = (0..buffers.len()).filter(|b| buffers[*b].history || buffers[*b].transient);
    let buffers = begun.map(|b| (Res::Buffer(b, false), 0));
    let kept = textures
        .iter()
        .enumerate()
        .filter(|(_, texture)| texture.history || texture.transient);
    let mips = kept
        .flat_map(|(t, texture)| (0..texture.mips).map(move |mip| (Res::Texture(t, false), mip)));
    for (res, mip) in buffers.chain(mips) {
        let this = |u: &&mut Use| u.res == res && u.mips == (mip, 1);
        if let Some(first) = steps
            .iter_mut()
            .flat_map(|s| &mut s.uses)
            .filter(this)
            .find(|u| u.write)
        {
            first.overwrite |= !first.read;
        }
    }
}

fn max_edge(numbers: &mut Numbers<'_>) -> Option<f64> {
    let needs = &numbers.set.graph.scene.as_ref()?.value;
    let empty = numbers.env.get("triangle_count") == Some(&Var::Number(0.0));
    if empty || needs.when.as_ref().is_some_and(|when| !numbers.holds(when)) {
        return None;
    }
    let edge = numbers.value(&needs.max_edge);
    if edge <= 0.0 && numbers.errors.is_empty() {
        numbers.error(
            needs.max_edge.at,
            format!("max_edge '{}' is {edge} m", needs.max_edge.value.text),
        );
    }
    Some(edge)
}
