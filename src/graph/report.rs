//! A plan as text: order, lifetimes, barriers, memory, and passes left out; or as a Graphviz
//! picture.

use super::definition::{Graph, Res};
use super::effect::effective;
use super::evaluated::Evaluated;
use super::link::Linked;
use super::param::{Param, Params};
use super::plan::{Barrier, Plan, Step, Use, Work, pack, schedule};
use std::borrow::Borrow;
use std::collections::BTreeSet;
use std::fmt::Write;

/// A screen: for each pass that runs, its stage, shader files and results; then memory, and the
/// names of the others.
pub fn summary(set: &Evaluated<'_>, linked: &[Linked], plan: &Plan) -> String {
    let graph = set.graph;
    let (ran, all) = (plan.passes().len(), graph.declared_passes().count());
    let params = graph.params.offered().count();
    let head = format!("graph {}: {ran} of {all} passes run", graph.name);
    let mut out = format!("{head}, {params} parameters");
    if plan.convergence.fresh > 1 {
        let _ = write!(out, "; converges in {} frames", plan.convergence.fresh);
    }
    out.push_str("\n\n");
    let rows = rows(graph, linked, plan);
    let width = |column: usize| rows.iter().map(|r| r[column].len()).max().unwrap_or(0);
    let [a, b, c] = [0, 1, 2].map(width);
    for [stage, pass, shaders, results] in &rows {
        let line = format!("{stage:<a$}  {pass:<b$}  {shaders:<c$}  {results}");
        let _ = writeln!(out, "{}", line.trim_end());
    }
    out.push('\n');
    for settling in &plan.settling {
        let name = |i: &usize| graph.pass_name(plan.steps[*i].pass);
        let mut passes: Vec<&str> = settling.steps.iter().map(name).collect();
        passes.dedup();
        let (frames, passes) = (settling.frames, passes.join(", "));
        let _ = writeln!(out, "after {frames} still frames rest: {passes}");
    }
    let files = graph.modules.iter();
    let files = files.map(|(name, file)| (name.as_str(), file.as_str()));
    let modules = set.params.modules().chain(files);
    let mut modules: Vec<_> = modules
        .map(|(name, file)| format!("{name} {file}"))
        .collect();
    modules.sort();
    list(&mut out, "modules", &modules);
    let automatic = |p: &Param| Some(format!("{} {} {}", p.name, effective(set, p)?, p.unit));
    let automatic: Vec<String> = set.params.list.iter().filter_map(automatic).collect();
    list(&mut out, "automatic", &automatic);
    let total = bytes(plan);
    let largest = largest(graph, plan, 6);
    let largest: Vec<_> = largest
        .iter()
        .map(|(name, bytes)| format!("{name} {:.1}", mib(*bytes)))
        .collect();
    let largest = largest.join(", ");
    let share = of_common_card(total);
    let _ = writeln!(
        out,
        "memory: {:.1} MiB ({share}); the largest: {largest}",
        mib(total)
    );
    let dropped = plan.dropped.iter().map(|(pass, _)| graph.pass_name(*pass));
    let dropped: Vec<&str> = dropped.collect();
    list(&mut out, "left out (--barriers prints why)", &dropped);
    out
}

/// Bytes of all textures and buffers that a plan makes.
pub fn bytes(plan: &Plan) -> u64 {
    plan.made().map(|res| plan.bytes_of(res)).sum::<u64>() - shared(plan).1
}

/// Names and bytes of the largest textures and buffers that a plan makes.
pub fn largest<'g>(graph: &'g Graph, plan: &Plan, count: usize) -> Vec<(&'g str, u64)> {
    let made = plan.made();
    let mut memory: Vec<_> = made
        .map(|res| (graph.name_of(res), plan.bytes_of(res)))
        .collect();
    memory.sort_by_key(|(_, bytes)| std::cmp::Reverse(*bytes));
    memory.truncate(count);
    memory
}

/// Memory as a share of the commonest card's: 8 GiB, of which the desktop and the scene need some
/// too.
pub fn of_common_card(bytes: u64) -> String {
    format!(
        "{:.1} % of 8 GiB",
        bytes as f64 / (8u64 << 30) as f64 * 100.0
    )
}

/// Adds a line with a list, unless it is empty.
fn list<S: Borrow<str>>(out: &mut String, title: &str, list: &[S]) {
    if !list.is_empty() {
        let _ = writeln!(out, "{title}: {}", list.join(", "));
    }
}

fn mib(bytes: u64) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}

/// Stage, name, shader files and results of each pass that runs. The passes of a stage that clear
/// share a row.
fn rows(graph: &Graph, linked: &[Linked], plan: &Plan) -> Vec<[String; 4]> {
    let mut rows: Vec<[String; 4]> = Vec::new();
    let mut stage = "";
    let mut clears: Option<usize> = None;
    for steps in plan.steps.chunk_by(|a, b| a.pass == b.pass) {
        let Some(first) = steps.first() else { continue };
        let pass = &graph.passes[first.pass].value;
        let is_new = pass.stage() != stage;
        if is_new {
            (stage, clears) = (pass.stage(), None);
        }
        let stage = if is_new {
            stage.to_owned()
        } else {
            String::new()
        };
        let names = |wanted: fn(&Use) -> bool| {
            let names: BTreeSet<&str> = first
                .uses
                .iter()
                .filter(|u| wanted(u))
                .map(|u| graph.name_of(u.res))
                .collect();
            names.into_iter().collect::<Vec<_>>().join(" ")
        };
        let (reads, results) = (names(|u| u.read && !u.write), names(|u| u.write));
        if let Work::ClearTexture(..) | Work::ClearBuffer(..) = first.work {
            match clears {
                Some(row) => rows[row][3] += &format!(" {results}"),
                None => {
                    clears = Some(rows.len());
                    rows.push([
                        stage,
                        "(clears)".into(),
                        String::new(),
                        format!("-> {results}"),
                    ]);
                }
            }
            continue;
        }
        let times = if steps.len() > 1 {
            format!(" x{}", steps.len())
        } else {
            String::new()
        };
        let shaders: Vec<&str> = linked[first.pass]
            .stages
            .iter()
            .map(|s| s.file.as_str())
            .collect();
        rows.push([
            stage,
            format!("{}{times}", pass.name.value),
            shaders.join(" "),
            format!("{reads} -> {results}"),
        ]);
    }
    rows
}

/// Bytes of the memory that transient resources share, and how much more they had alone. Devices
/// round sizes up.
fn shared(plan: &Plan) -> (u64, u64) {
    let sizes: Vec<(u64, u64)> = plan
        .transients
        .iter()
        .map(|t| (plan.bytes_of(t.res), 1))
        .collect();
    let all = pack(&sizes, &plan.transients).1;
    (all, sizes.iter().map(|(bytes, _)| bytes).sum::<u64>() - all)
}

/// Every step in order with its barriers; sizes, formats and lifetimes of resources; passes left
/// out, with reasons.
pub fn text(graph: &Graph, linked: &[Linked], plan: &Plan) -> String {
    let (ran, all) = (plan.passes().len(), graph.declared_passes().count());
    let mut out = format!("graph {}: {ran} of {all} passes run\n\norder\n", graph.name);
    let schedule = schedule(plan);
    for (i, step) in plan.steps.iter().enumerate() {
        for barrier in &schedule.barriers[0][i] {
            let _ = writeln!(out, "       | {}", barrier_text(graph, barrier));
        }
        let (name, repeat) = (graph.pass_name(step.pass), repeat_text(plan, i));
        let _ = writeln!(out, "{i:5}  {name}{repeat}");
        let _ = writeln!(out, "       {}", work_text(graph, step));
        for u in &step.uses {
            let _ = writeln!(out, "         {}", use_text(graph, u));
        }
        for i in &step.stripped {
            let name = &linked[step.pass].bound[*i].name;
            let _ = writeln!(out, "         leaves out its stores to {name}");
        }
    }
    out.push_str("\nresources                        size                 format       MiB  lifetime (steps)\n");
    for res in plan.made() {
        let (size, format) = size_text(plan, res);
        let (name, mib) = (graph.name_of(res), mib(plan.bytes_of(res)));
        let _ = write!(out, "{name:<28} {size:>22}  {format:<10} {mib:>7.1}");
        let _ = writeln!(out, "  {}", lifetime(plan, res));
    }
    for (title, bytes) in [
        ("saved by memory that transient ones share", shared(plan).1),
        ("total", bytes(plan)),
    ] {
        let _ = writeln!(out, "{title:<62} {:>10.1}", mib(bytes));
    }
    let _ = writeln!(out, "\nleft out");
    for (pass, why) in &plan.dropped {
        let _ = writeln!(out, "  pass {}: {why}", graph.pass_name(*pass));
    }
    let made: Vec<&str> = plan.made().map(|res| graph.name_of(res)).collect();
    for name in graph.resource_names().filter(|name| !made.contains(name)) {
        let _ = writeln!(out, "  {name}: no pass that runs uses it");
    }
    out
}

fn use_text(graph: &Graph, u: &Use) -> String {
    let how = match (u.read, u.write) {
        (true, true) => "reads and writes",
        (false, true) if u.overwrite => "replaces",
        (false, true) => "writes",
        (false, false) => "asks for the size of",
        (true, false) => "reads",
    };
    let mips = match (u.res, u.mips) {
        (Res::Buffer(..), _) => String::new(),
        (_, (mip, 1)) => format!("mip {mip}"),
        (_, (first, count)) => format!("mips {first}-{}", first + count - 1),
    };
    format!("{how} {} {mips}", graph.title_of(u.res))
}

/// Size and format.
fn size_text(plan: &Plan, res: Res) -> (String, &str) {
    match res {
        Res::Texture(t, _) => {
            let p = &plan.textures[t];
            let ([x, y, z], mips) = (p.extent, p.mips);
            let size = match p.volume {
                true => format!("{x}x{y}x{z}"),
                false => format!("{x}x{y}x{} layers", p.layers),
            };
            (format!("{size}, {mips} mips"), p.format.name)
        }
        Res::Buffer(b, _) => (format!("{} bytes", plan.buffers[b].size), "buffer"),
    }
}

fn repeat_text(plan: &Plan, i: usize) -> String {
    let pass = plan.steps[i].pass;
    let count = plan.steps.iter().filter(|s| s.pass == pass).count();
    if count > 1 {
        format!(" [{}]", plan.steps[i].index)
    } else {
        String::new()
    }
}

fn work_text(graph: &Graph, step: &Step) -> String {
    let buffer = |b: &usize| graph.buffers[*b].0.as_str();
    let texture = |t: &usize| graph.textures[*t].0.as_str();
    let view = if step.viewport == [0, 0] {
        String::new()
    } else {
        format!(" at {}x{}", step.viewport[0], step.viewport[1])
    };
    let samples = if step.samples > 1 {
        format!(", {} samples", step.samples)
    } else {
        String::new()
    };
    match &step.work {
        Work::Dispatch([x, y, z]) => format!("dispatch {x}x{y}x{z} groups"),
        Work::DispatchIndirect(b, o) => format!("dispatch sized by {} at byte {o}", buffer(b)),
        Work::Scene(which) => format!("draw the scene ({which:?}){view}{samples}").to_lowercase(),
        Work::Fullscreen => format!("draw 3 vertices{view}{samples}"),
        Work::DrawIndirect(b, o) => format!("draw sized by {} at byte {o}{view}", buffer(b)),
        Work::ClearTexture(t, ..) => format!("clear {}", texture(t)),
        Work::ClearBuffer(b, v) => format!("fill {} with {v}", buffer(b)),
    }
}

fn barrier_text(graph: &Graph, b: &Barrier) -> String {
    let layouts = if b.layouts.0 == b.layouts.1 {
        String::new()
    } else {
        format!(", {:?} to {:?}", b.layouts.0, b.layouts.1)
    };
    let mips = if matches!(b.res, Res::Buffer(..)) {
        String::new()
    } else {
        format!(" mips {}+{}", b.mips.0, b.mips.1)
    };
    format!(
        "{}{mips}: {:?} to {:?}{layouts}",
        graph.title_of(b.res),
        b.src.0,
        b.dst.0
    )
}

fn lifetime(plan: &Plan, res: Res) -> String {
    let used = |step: &Step| {
        step.uses
            .iter()
            .find(|u| u.res.current() == res)
            .map(|u| u.read)
    };
    let uses = || {
        plan.steps
            .iter()
            .enumerate()
            .filter_map(|(i, step)| Some((i, used(step)?)))
    };
    match (uses().next(), uses().next_back()) {
        (Some((first, read)), Some((last, _))) => {
            let carried = if read || plan.has_history(res) {
                ", kept from frame to frame"
            } else {
                ""
            };
            format!("{first}-{last}{carried}")
        }
        _ => String::from("-"),
    }
}

/// Parameters with kinds, ranges, units and help.
pub fn params(params: &Params) -> String {
    let mut out = String::new();
    let mut group = None;
    for p in params.offered() {
        if group != Some(&p.group) {
            let _ = writeln!(
                out,
                "\n{}",
                if p.group.is_empty() {
                    "(no group)"
                } else {
                    &p.group
                }
            );
            group = Some(&p.group);
        }
        let range = p
            .range
            .map_or(String::new(), |(a, b)| format!(", {a} to {b}"));
        let unit = if p.unit.is_empty() {
            String::new()
        } else {
            format!(" {}", p.unit)
        };
        let value = params.get(&p.name).unwrap_or(&p.default);
        let default = match *value == p.default {
            true => String::new(),
            false => format!("; default: {}", p.default),
        };
        let plain = p
            .plain
            .as_ref()
            .map_or(String::new(), |v| format!("; plain: {v}"));
        let _ = writeln!(
            out,
            "  {} = {value}{unit}  ({}{range}{default}{plain})",
            p.name,
            p.expected()
        );
        let _ = writeln!(out, "      {}", p.help);
        for (option, help) in p
            .kind
            .options()
            .iter()
            .zip(&p.option_help)
            .filter(|(_, help)| !help.is_empty())
        {
            let _ = writeln!(out, "      - {option}: {help}");
        }
    }
    let fixed: Vec<String> = params
        .list
        .iter()
        .filter(|p| p.fixed)
        .map(|p| format!("{} = {}", p.name, p.default))
        .collect();
    if !fixed.is_empty() {
        let _ = writeln!(out, "\nfixed in this graph: {}", fixed.join(", "));
    }
    out
}

/// Named values with their present numbers.
pub fn values(set: &Evaluated<'_>) -> String {
    let mut out = String::new();
    if !set.values.is_empty() {
        out.push_str("\nvalues, which follow from these\n");
    }
    for (named, value) in set.graph.values.iter().zip(&set.values) {
        let _ = match &named.signs {
            Some(stage) => writeln!(
                out,
                "  {}: differs where stage '{stage}' reads other settings",
                named.name
            ),
            None => writeln!(
                out,
                "  {} = {value}  ({})",
                named.name, named.expr.value.text
            ),
        };
    }
    out
}

/// A Graphviz picture: passes as boxes, resources as ellipses.
pub fn dot(graph: &Graph, linked: &[Linked], plan: &Plan) -> String {
    let mut out = String::from(
        "digraph graph_of_passes {\n  rankdir=LR;\n  node [fontname=\"sans-serif\"];\n",
    );
    for pass in plan.passes() {
        let shaders: Vec<&str> = linked[pass]
            .stages
            .iter()
            .map(|s| s.file.as_str())
            .collect();
        let name = graph.pass_name(pass);
        let _ = writeln!(
            out,
            "  \"pass {name}\" [shape=box, label=\"{name}\\n{}\"];",
            shaders.join("\\n")
        );
    }
    let mut edges: Vec<String> = Vec::new();
    for step in &plan.steps {
        let name = graph.pass_name(step.pass);
        for u in &step.uses {
            let res = graph.title_of(u.res);
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
