//! A plan for people: order, lifetimes, barriers, memory, and what was left out; or a Graphviz picture.

use super::link::Linked;
use super::load::Graph;
use super::param::{Params, Value};
use super::plan::{Plan, Step, Work};
use super::transient::{Transient, pack};
use super::usage::{Barrier, Res, schedule};
use std::fmt::Write;

pub(super) fn resource_name(graph: &Graph, res: Res) -> String {
    match res {
        Res::Texture(t, false) => graph.textures[t].0.clone(),
        Res::Texture(t, true) => format!("{} (last frame)", graph.textures[t].0),
        Res::Buffer(b, false) => graph.buffers[b].0.clone(),
        Res::Buffer(b, true) => format!("{} (last frame)", graph.buffers[b].0),
    }
}

pub(super) fn texture_bytes(plan: &Plan, t: usize) -> u64 {
    let p = &plan.textures[t];
    let mips = (0..p.mips).map(|m| p.extent.iter().map(|n| u64::from((n >> m).max(1))).product::<u64>()).sum::<u64>();
    mips * u64::from(p.layers) * u64::from(p.format.bytes) * (1 + u64::from(p.history))
}

/// What runs, stage by stage: work, what it reads and what it writes; memory; what was left out and why.
pub fn summary(graph: &Graph, plan: &Plan) -> String {
    let mut out = String::new();
    let (ran, all, params) = (ran(plan).len(), graph.passes.len(), graph.params.list.len());
    let _ = writeln!(out, "graph {}: {ran} of {all} passes run, {params} parameters", graph.name);
    let mut stage = "";
    for steps in plan.steps.chunk_by(|a, b| a.pass == b.pass) {
        let Some(first) = steps.first() else { continue };
        let pass = &graph.passes[first.pass].value;
        if pass.stage() != stage {
            stage = pass.stage();
            let _ = writeln!(out, "\n{stage}");
        }
        let times = if steps.len() > 1 { format!(" x{}", steps.len()) } else { String::new() };
        let named = |written: bool| {
            let uses = first.uses.iter().filter(|u| if written { u.write } else { u.read && !u.write });
            let mut names: Vec<String> = uses.map(|u| resource_name(graph, u.res)).collect();
            names.sort();
            names.dedup();
            names.join(" ")
        };
        let head = format!("  {}{times}: {}", pass.name.value, work_text(graph, first));
        let _ = match first.work {
            // It says what it writes.
            Work::ClearTexture(..) | Work::ClearBuffer(..) => writeln!(out, "{head}"),
            _ => writeln!(out, "{head}\n      {} -> {}", named(false), named(true)),
        };
    }
    for settling in &plan.settling {
        let mut passes: Vec<&str> =
            settling.steps.iter().map(|i| graph.passes[plan.steps[*i].pass].value.name.value.as_str()).collect();
        passes.dedup();
        let _ = writeln!(out, "after {} still frames rest: {}", settling.frames, passes.join(", "));
    }
    let _ = writeln!(out, "\nmemory, MiB");
    let textures = plan.textures.iter().enumerate().filter(|(_, p)| !p.usage.is_empty());
    let star = |name: &str, transient: bool| format!("{name}{}", if transient { "*" } else { "" });
    let textures = textures.map(|(t, p)| (star(&graph.textures[t].0, p.transient), texture_bytes(plan, t)));
    let buffers = plan.buffers.iter().enumerate().filter(|(_, p)| p.used);
    let buffers = buffers.map(|(b, p)| (star(&graph.buffers[b].0, p.transient), p.bytes()));
    let mut memory: Vec<(String, u64)> = textures.chain(buffers).collect();
    memory.sort_by_key(|(_, bytes)| std::cmp::Reverse(*bytes));
    let mib = |bytes: u64| bytes as f64 / f64::from(1 << 20);
    // What is smaller than a tenth is not worth a word.
    let (large, small): (Vec<_>, Vec<_>) = memory.iter().partition(|(_, bytes)| mib(*bytes) >= 0.1);
    let items: Vec<String> = large.iter().map(|(name, bytes)| format!("{name} {:.1}", mib(*bytes))).collect();
    let (shared, saved) = shared(plan);
    let total = mib(memory.iter().map(|(_, bytes)| bytes).sum::<u64>() - saved);
    let stars = match saved {
        0 => String::new(),
        _ => format!("; transient ones (*) share {:.1}, which saves {:.1}", mib(shared), mib(saved)),
    };
    let _ = writeln!(out, "  {}, {} smaller ones; {total:.1} in all{stars}", items.join(", "), small.len());
    let _ = writeln!(out, "\nleft out");
    for (pass, why) in &plan.dropped {
        let _ = writeln!(out, "  {}: {why}", graph.passes[*pass].value.name.value);
    }
    out
}

/// Bytes of the memory that transient resources share, and how much more they had alone. Devices round sizes up.
fn shared(plan: &Plan) -> (u64, u64) {
    let bytes = |t: &Transient| match t.res {
        Res::Texture(t, _) => texture_bytes(plan, t),
        Res::Buffer(b, _) => plan.buffers[b].bytes(),
    };
    let sizes: Vec<(u64, u64)> = plan.transients.iter().map(|t| (bytes(t), 1)).collect();
    let all = pack(&sizes, &plan.transients).1;
    (all, sizes.iter().map(|(bytes, _)| bytes).sum::<u64>() - all)
}

/// Every step in order with its barriers; sizes, formats and lifetimes of resources; what was left out and why.
pub fn text(graph: &Graph, linked: &[Linked], plan: &Plan) -> String {
    let mut out = String::new();
    let _ = writeln!(out, "graph {}: {} of {} passes run\n", graph.name, ran(plan).len(), graph.passes.len());
    let schedule = schedule(plan);
    let _ = writeln!(out, "order");
    for (i, step) in plan.steps.iter().enumerate() {
        for barrier in &schedule.barriers[0][i] {
            let _ = writeln!(out, "       | {}", barrier_text(graph, barrier));
        }
        let _ = writeln!(out, "{i:5}  {}{}", graph.passes[step.pass].value.name.value, repeat_text(plan, i));
        let _ = writeln!(out, "       {}", work_text(graph, step));
        for u in &step.uses {
            let how = match (u.read, u.write) {
                (true, true) => "reads and writes",
                (false, true) if u.overwrite => "replaces",
                (false, true) => "writes",
                (false, false) => "asks for the size of",
                (true, false) => "reads",
            };
            let mips = if u.mips.1 == 1 {
                format!("mip {}", u.mips.0)
            } else {
                format!("mips {}-{}", u.mips.0, u.mips.0 + u.mips.1 - 1)
            };
            let mips = if matches!(u.res, Res::Texture(..)) { mips } else { String::new() };
            let _ = writeln!(out, "         {how} {} {mips}", resource_name(graph, u.res));
        }
        for i in &step.stripped {
            let _ = writeln!(out, "         leaves out its stores to {}", linked[step.pass].bound[*i].name);
        }
    }
    let _ = writeln!(out, "\nresources                        size                 format       MiB  lifetime (steps)");
    let mut total = 0;
    for (t, p) in plan.textures.iter().enumerate().filter(|(_, p)| !p.usage.is_empty()) {
        let bytes = texture_bytes(plan, t);
        total += bytes;
        let [x, y, z] = p.extent;
        let size = if p.volume { format!("{x}x{y}x{z}") } else { format!("{x}x{y}x{} layers", p.layers) };
        let size = format!("{size}, {} mips", p.mips);
        let _ = writeln!(
            out,
            "{:<28} {:>22}  {:<10} {:>7.1}  {}",
            graph.textures[t].0,
            size,
            p.format.name,
            bytes as f64 / 1048576.0,
            lifetime(plan, |r| matches!(r, Res::Texture(x, _) if x == t), p.history)
        );
    }
    for (b, p) in plan.buffers.iter().enumerate().filter(|(_, p)| p.used) {
        total += p.bytes();
        let _ = writeln!(
            out,
            "{:<28} {:>22}  {:<10} {:>7.1}  {}",
            graph.buffers[b].0,
            format!("{} bytes", p.size),
            "buffer",
            p.bytes() as f64 / 1048576.0,
            lifetime(plan, |r| matches!(r, Res::Buffer(x, _) if x == b), p.history)
        );
    }
    let saved = shared(plan).1;
    let _ = writeln!(out, "{:<62} {:>10.1}", "saved by memory that transient ones share", saved as f64 / 1048576.0);
    let _ = writeln!(out, "{:<62} {:>10.1}", "total", (total - saved) as f64 / 1048576.0);
    let unmade: Vec<&str> = graph
        .textures
        .iter()
        .zip(&plan.textures)
        .filter(|(_, p)| p.usage.is_empty())
        .map(|(t, _)| t.0.as_str())
        .chain(graph.buffers.iter().zip(&plan.buffers).filter(|(_, p)| !p.used).map(|(b, _)| b.0.as_str()))
        .collect();
    let _ = writeln!(out, "\nleft out");
    for (pass, why) in &plan.dropped {
        let _ = writeln!(out, "  pass {}: {why}", graph.passes[*pass].value.name.value);
    }
    for name in unmade {
        let _ = writeln!(out, "  {name}: no pass that runs uses it");
    }
    out
}

fn ran(plan: &Plan) -> Vec<usize> {
    let mut list: Vec<usize> = plan.steps.iter().map(|s| s.pass).collect();
    list.dedup();
    list
}

fn repeat_text(plan: &Plan, i: usize) -> String {
    let pass = plan.steps[i].pass;
    let count = plan.steps.iter().filter(|s| s.pass == pass).count();
    if count > 1 { format!(" [{}]", plan.steps[i].index) } else { String::new() }
}

fn work_text(graph: &Graph, step: &Step) -> String {
    let buffer = |b: &usize| graph.buffers[*b].0.as_str();
    let texture = |t: &usize| graph.textures[*t].0.as_str();
    let view =
        if step.viewport == [0, 0] { String::new() } else { format!(" at {}x{}", step.viewport[0], step.viewport[1]) };
    let samples = if step.samples > 1 { format!(", {} samples", step.samples) } else { String::new() };
    match &step.work {
        Work::Dispatch([x, y, z]) => format!("dispatch {x}x{y}x{z} groups"),
        Work::DispatchIndirect(b, o) => format!("dispatch sized by {} at byte {o}", buffer(b)),
        Work::Scene(which) => format!("draw the scene ({which:?}){view}{samples}").to_lowercase(),
        Work::Vertices(n) => format!("draw {n} vertices{view}{samples}"),
        Work::DrawIndirect(b, o) => format!("draw sized by {} at byte {o}{view}", buffer(b)),
        Work::ClearTexture(t, ..) => format!("clear {}", texture(t)),
        Work::ClearBuffer(b, v) => format!("fill {} with {v}", buffer(b)),
        Work::CopyTexture(a, b) => format!("copy {} to {}", texture(a), texture(b)),
        Work::CopyBuffer(a, b) => format!("copy {} to {}", buffer(a), buffer(b)),
    }
}

fn barrier_text(graph: &Graph, b: &Barrier) -> String {
    let layouts =
        if b.layouts.0 == b.layouts.1 { String::new() } else { format!(", {:?} to {:?}", b.layouts.0, b.layouts.1) };
    let mips =
        if matches!(b.res, Res::Buffer(..)) { String::new() } else { format!(" mips {}+{}", b.mips.0, b.mips.1) };
    format!("{}{mips}: {:?} to {:?}{layouts}", resource_name(graph, b.res), b.src.0, b.dst.0)
}

fn lifetime(plan: &Plan, is: impl Fn(Res) -> bool, history: bool) -> String {
    let uses: Vec<(usize, bool)> = plan
        .steps
        .iter()
        .enumerate()
        .filter_map(|(i, s)| s.uses.iter().find(|u| is(u.res)).map(|u| (i, u.read)))
        .collect();
    match (uses.first(), uses.last()) {
        (Some((first, read)), Some((last, _))) => {
            let carried = if *read || history { ", kept from frame to frame" } else { "" };
            format!("{first}-{last}{carried}")
        }
        _ => String::from("-"),
    }
}

/// Parameters with kinds, ranges, units and help.
pub fn params(params: &Params) -> String {
    let mut out = String::new();
    let mut group = None;
    for p in &params.list {
        if group != Some(&p.group) {
            let _ = writeln!(out, "\n{}", if p.group.is_empty() { "(no group)" } else { &p.group });
            group = Some(&p.group);
        }
        let range = p.range.map_or(String::new(), |(a, b)| format!(", {a} to {b}"));
        let unit = if p.unit.is_empty() { String::new() } else { format!(" {}", p.unit) };
        let plain = p.plain.as_ref().map_or(String::new(), |v| format!("; plain: {v}"));
        let _ = writeln!(out, "  {} = {}{unit}  ({}{range}{plain})", p.name, p.default, p.expected());
        let _ = writeln!(out, "      {}", p.help);
    }
    out
}

/// Named values with what they are now.
pub fn values(graph: &Graph, values: &[Value]) -> String {
    let mut out = String::new();
    if !values.is_empty() {
        out.push_str("\nvalues, which follow from these\n");
    }
    for (named, value) in graph.values.iter().zip(values) {
        let _ = writeln!(out, "  {} = {value}  ({})", named.name, named.expr.value.text);
    }
    out
}

/// A Graphviz picture: passes as boxes, resources as ellipses.
pub fn dot(graph: &Graph, linked: &[Linked], plan: &Plan) -> String {
    let mut out = String::from("digraph graph_of_passes {\n  rankdir=LR;\n  node [fontname=\"sans-serif\"];\n");
    for pass in ran(plan) {
        let shaders: Vec<&str> = linked[pass].stages.iter().map(|s| s.file.as_str()).collect();
        let name = &graph.passes[pass].value.name.value;
        let _ = writeln!(out, "  \"pass {name}\" [shape=box, label=\"{name}\\n{}\"];", shaders.join("\\n"));
    }
    let mut edges: Vec<String> = Vec::new();
    for step in &plan.steps {
        let name = &graph.passes[step.pass].value.name.value;
        for u in &step.uses {
            let res = resource_name(graph, u.res);
            if u.read {
                edges.push(format!("  \"{res}\" -> \"pass {name}\";"));
            }
            if u.write {
                edges.push(format!("  \"pass {name}\" -> \"{res}\";"));
            }
        }
    }
    edges.sort();
    edges.dedup();
    out.push_str(&edges.join("\n"));
    out.push_str("\n}\n");
    out
}
