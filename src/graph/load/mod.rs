//! Reading a graph with its includes.

mod check;
mod check_pass;
mod choices;
mod findings;
mod include;
mod join;
mod params;
mod values;

pub use include::Folders;

use super::definition::{Alias, Graph, LightPart};
use super::file::{GraphFile, PartItem, PassDecl, Retired, ungrouped};
use super::interface::SceneInterface;
use super::param::Params;
use crate::diagnostics::{Diagnostic, Entries, Items, Loc, RawText, Severity, Sources};
use check::{Check, Names};
use findings::Findings;
use std::mem::take;
use std::path::Path;

/// Reads `path` and its includes, for scenes with this interface.
///
/// # Errors
/// All mistakes of all files.
pub fn load(
    path: &Path,
    folders: &Folders,
    interface: &'static SceneInterface,
) -> Result<Graph, Vec<Diagnostic>> {
    let mut include = include::Include::new(folders);
    let retired = include.retired();
    include.file(path, None);
    let (files, mut found) = (include.files, include.found);
    let mut joined = joined(files, &mut found);
    super::debug::declare(&mut joined.file, &mut joined.passes);
    let mut file = joined.file;
    join::leave_out_fixed(&mut file);
    let mut textures = by_name(take(&mut file.textures));
    join::sizes_of_others(&mut textures, &mut found);
    let params = parameters(&file, &joined.passes, &retired, interface, &mut found);
    let names = Names {
        pinned: file.pinned,
        modules: file.modules,
        fit: file.fit,
        pointer: file.pointer,
        slice: file.slice,
        view_mips: file.view_mips,
    };
    let stem = path.file_stem().unwrap_or_default();
    let graph = Graph {
        name: stem.to_string_lossy().into_owned(),
        interface,
        values: values::ordered(file.values.0, &params, interface, &mut found),
        params,
        pinned: texts(&names.pinned),
        modules: texts(&names.modules),
        groups: file.groups.0.into_iter().map(|g| g.value).collect(),
        textures,
        buffers: by_name(file.buffers),
        aliases: joined.aliases,
        passes: joined.passes,
        output: file.output.map(|name| name.value),
        hdr: file.hdr.map(|name| name.value),
        outputs: file.outputs.0.into_iter().map(|name| name.value).collect(),
        parts: file.parts.0.into_iter().map(part).collect(),
        scene: file.scene,
        checks: file.checks.0,
        refuse: file.refuse.0.into_iter().map(|r| r.value).collect(),
        caption: file.caption,
        pointer: names.pointer.as_ref().map(|name| name.value.clone()),
        slice: names.slice.as_ref().map(|name| name.value.clone()),
        view_mips: texts(&names.view_mips),
        tables: file.tables.0,
        compare: file.compare.0,
        views: file.views.0,
        fit: names.fit.0.iter().map(fit).collect(),
        ablation: file.ablation.0,
        tools: by_name(file.tools),
        // They are needed for messages until the end.
        sources: Sources::default(),
    };
    let mut check = Check::new(&graph, folders, found);
    check.all(&names, &joined.results);
    let found = check.found;
    finish(graph, found)
}

fn parameters(
    file: &GraphFile,
    passes: &[Loc<PassDecl>],
    retired: &Retired,
    interface: &SceneInterface,
    found: &mut Findings,
) -> Params {
    let mut list = params::declared(&file.params.0, interface, found);
    params::set_defaults(&mut list, &file.defaults, found);
    params::fix(&mut list, &file.fixed, found);
    Params {
        retired: [texts(&retired.parameters), texts(&file.retired)].concat(),
        passes: passes.iter().map(|p| p.value.name.value.clone()).collect(),
        ..Params::new(list)
    }
}

/// The graph with its sources, or its mistakes.
fn finish(mut graph: Graph, found: Findings) -> Result<Graph, Vec<Diagnostic>> {
    graph.sources = found.sources;
    let mut errors = found.errors;
    if !errors.iter().any(|e| e.severity == Severity::Error) {
        return Ok(graph);
    }
    errors.sort_by(|a, b| a.place.cmp(&b.place));
    errors.dedup();
    Err(errors)
}

/// The files of a graph as one.
#[derive(Default)]
struct Joined {
    file: GraphFile,
    aliases: Vec<Alias>,
    passes: Vec<Loc<PassDecl>>,
    /// Textures that are results of some file.
    results: Vec<Loc<String>>,
}

fn joined(files: Vec<GraphFile>, found: &mut Findings) -> Joined {
    let mut all = Joined::default();
    for mut more in files {
        let (aliases, samplers) = (take(&mut more.aliases), take(&mut more.samplers));
        join::add_aliases(&mut all.aliases, aliases, samplers, found);
        for pass in ungrouped(take(&mut more.passes)) {
            join::insert_pass(&mut all.passes, pass, found);
        }
        let parts = more.parts.0.iter().map(|(_, part)| &part.value.0.texture);
        let results = more.output.iter().chain(&more.hdr);
        let results = results.chain(&more.outputs.0).chain(parts);
        all.results.extend(results.cloned());
        join::add(&mut all.file, more);
    }
    all
}

impl Graph {
    /// Whether [`load`] would read the same again: its files, and those of the modules that it
    /// names, are there as they were.
    pub fn is_current(&self, folders: &Folders) -> bool {
        let is_there = |file: &String| crate::shader::find(&folders.shaders, file).is_some();
        self.modules.iter().all(|(_, file)| is_there(file)) && self.sources.are_current()
    }
}

fn texts(list: &Entries<String>) -> Vec<(String, String)> {
    list.0
        .iter()
        .map(|(name, text)| (name.value.clone(), text.value.clone()))
        .collect()
}

fn fit((name, list): &(Loc<String>, Loc<Items<RawText>>)) -> (String, Vec<String>) {
    let values = list.value.0.iter().map(|text| text.value.0.clone());
    (name.value.clone(), values.collect())
}

/// Items by name, each with the place of its name.
fn by_name<T>(list: Entries<T>) -> Vec<(String, Loc<T>)> {
    list.0
        .into_iter()
        .map(|(name, item)| {
            (
                name.value,
                Loc {
                    at: name.at,
                    value: item.value,
                },
            )
        })
        .collect()
}

fn part(
    (
        name,
        Loc {
            value: PartItem(part),
            ..
        },
    ): (Loc<String>, Loc<PartItem>),
) -> LightPart {
    LightPart {
        texture: part.texture.value,
        kind: part.kind,
        title: part.title.unwrap_or_else(|| name.value.clone()),
        focus: part.focus,
        name: name.value,
    }
}
