//! A frame's plan: sizes, then steps, then the removal of unused ones.

use super::data::{BufferPlan, Convergence, Plan, Step, TexturePlan};
use super::numbers::Numbers;
use super::steps::Planner;
use super::uses::{Use, UseKind, merge};
use super::{converge, layout, live, needs, settle, sizes, transient};
use crate::diagnostics::{At, Diagnostic, Place};
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
    refuse(&mut numbers);
    let mut textures = sizes::textures(&mut numbers, wanted, device);
    if !numbers.errors.is_empty() {
        return Err(numbers.errors);
    }
    let mut buffers = sizes::buffers(&mut numbers, &layouts, wanted, device);
    let mut planner = Planner {
        numbers,
        layouts,
        device,
        textures: &textures,
        buffers: &buffers,
    };
    let mut ran = run(&mut planner, linked);
    let mut numbers = planner.numbers;
    let mut steps = std::mem::take(&mut ran.steps);
    leave_out(
        &ran,
        wanted,
        &mut numbers,
        (&mut textures, &mut buffers),
        &mut steps,
    );
    written_anew(&textures, &buffers, &mut steps);
    let max_edge = max_edge(&mut numbers);
    if !numbers.errors.is_empty() {
        return Err(numbers.errors);
    }
    let mut plan = Plan {
        textures,
        buffers,
        steps,
        settling: Vec::new(),
        convergence: Convergence::default(),
        transients: Vec::new(),
        missing: ran.missing,
        dropped: ran.dropped,
        max_edge,
    };
    live::prune(graph, linked, &mut plan, wanted);
    finish(plan, (set, linked), device, (&ran.settles, &ran.converges))
}

fn refuse(numbers: &mut Numbers<'_>) {
    for refused in &numbers.set.graph.refuse {
        if numbers.holds(&refused.when) {
            numbers.error(refused.when.at, refused.message.clone());
        }
    }
}

/// A number of frames by pass, with its place.
type Declared = BTreeMap<usize, (At, u32)>;

/// The passes that run, and those that are left out.
#[derive(Default)]
struct Ran {
    steps: Vec<Step>,
    dropped: Vec<(usize, String)>,
    settles: Declared,
    converges: Declared,
    /// Results of passes that are off.
    missing: Vec<Res>,
    /// A texture that a pass which is off writes, and the one that is read instead.
    instead: Vec<(usize, usize)>,
}

fn run(planner: &mut Planner<'_, '_>, linked: &[Linked]) -> Ran {
    let mut ran = Ran::default();
    let graph = planner.numbers.set.graph;
    for (number, (pass, link)) in graph.passes.iter().zip(linked).enumerate() {
        let mut conditions = pass.value.conditions();
        if let Some(when) = conditions.find(|when| !planner.numbers.holds(when)) {
            ran.dropped
                .push((number, format!("needs {}", when.value.text)));
            continue;
        }
        let planned = planner.steps(number, &pass.value, link);
        if planner
            .numbers
            .set
            .params
            .off
            .contains(&pass.value.name.value)
        {
            let uses = planned.into_iter().flat_map(|s| s.uses);
            ran.missing.extend(uses.filter(|u| u.write).map(|u| u.res));
            let texture = |name: &str| graph.texture(name);
            let pairs = pass.value.instead.0.iter();
            ran.instead.extend(
                pairs.filter_map(|(of, read)| {
                    Some((texture(&of.value)?, texture(&read.value.value)?))
                }),
            );
            ran.dropped.push((number, "it is off".into()));
            continue;
        }
        ran.steps.extend(planned);
        if let Some(ex) = &pass.value.settles {
            ran.settles
                .insert(number, (ex.at, planner.numbers.count(ex, 1, "settles")));
        }
        if let Some(ex) = &pass.value.converges {
            ran.converges
                .insert(number, (ex.at, planner.numbers.count(ex, 1, "converges")));
        }
    }
    ran
}

/// Adds layouts, convergence and memory to the plan.
fn finish(
    mut plan: Plan,
    (set, linked): (&Evaluated<'_>, &[Linked]),
    device: &DeviceInfo,
    (settles, converges): (&Declared, &Declared),
) -> Result<Plan, Vec<Diagnostic>> {
    let graph = set.graph;
    let mut errors = Vec::new();
    layout::layouts(graph, &mut plan, &mut errors);
    plan.convergence = converge::frames(&plan, settles, converges);
    match settle::find(graph, &plan, settles) {
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

/// Replaces or empties what passes that are off write.
fn leave_out(
    ran: &Ran,
    wanted: &[String],
    numbers: &mut Numbers<'_>,
    (textures, buffers): (&mut [TexturePlan], &mut [BufferPlan]),
    steps: &mut [Step],
) {
    // Backwards: with two filters off, a reader of the second reads the input of the first.
    for (of, read) in ran.instead.iter().rev() {
        read_instead(textures, steps, *of, *read);
    }
    for res in &ran.missing {
        match *res {
            Res::Texture(t, _) => textures[t].transient = false,
            Res::Buffer(b, _) => buffers[b].transient = false,
        }
        let error = nobody_writes(numbers.set, wanted, steps, *res);
        numbers.errors.extend(error);
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
