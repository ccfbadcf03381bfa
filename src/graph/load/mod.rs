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

use super::definition::{Graph, LightPart};
use super::file::{GraphFile, PartItem, ungrouped};
use super::interface::SceneInterface;
use super::param::Params;
use crate::diagnostics::{Diagnostic, Entries, Items, Loc, RawText, Severity, Sources};
use check::Check;
use findings::Findings;
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
    let mut file = GraphFile::default();
    let (mut aliases, mut passes) = (Vec::new(), Vec::new());
    // Textures that are results of some file.
    let mut results = Vec::new();
    for mut more in files {
        join::add_aliases(
            &mut aliases,
            std::mem::take(&mut more.aliases),
            std::mem::take(&mut more.samplers),
            &mut found,
        );
        for pass in ungrouped(std::mem::take(&mut more.passes)) {
            join::insert_pass(&mut passes, pass, &mut found);
        }
        let parts = more.parts.0.iter().map(|(_, part)| &part.value.0.texture);
        results.extend(
            more.output
                .iter()
                .chain(&more.hdr)
                .chain(&more.outputs.0)
                .chain(parts)
                .cloned(),
        );
        join::add(&mut file, more);
    }
    join::leave_out_fixed(&mut file);
    let mut textures = by_name(file.textures);
    join::sizes_of_others(&mut textures, &mut found);
    let mut list = params::declared(&file.params.0, interface, &mut found);
    params::set_defaults(&mut list, &file.defaults, &mut found);
    params::fix(&mut list, &file.fixed, &mut found);
    let pass_names = passes.iter().map(|p| p.value.name.value.clone()).collect();
    let retired = [texts(&retired.parameters), texts(&file.retired)].concat();
    let params = Params {
        retired,
        passes: pass_names,
        ..Params::new(list)
    };
    let mut graph = Graph {
        name: path
            .file_stem()
            .map_or(String::new(), |s| s.to_string_lossy().into_owned()),
        interface,
        values: values::ordered(file.values.0, &params, interface, &mut found),
        params,
        pinned: texts(&file.pinned),
        modules: texts(&file.modules),
        textures,
        buffers: by_name(file.buffers),
        aliases,
        passes,
        output: file.output.map(|name| name.value),
        hdr: file.hdr.map(|name| name.value),
        outputs: file.outputs.0.into_iter().map(|name| name.value).collect(),
        parts: file.parts.0.into_iter().map(part).collect(),
        scene: file.scene,
        checks: file.checks.0,
        refuse: file.refuse.0.into_iter().map(|r| r.value).collect(),
        caption: file.caption,
        pointer: file.pointer.as_ref().map(|name| name.value.clone()),
        tables: file.tables.0,
        compare: file.compare.0,
        views: file.views.0,
        fit: file
            .fit
            .0
            .iter()
            .map(|(name, list)| (name.value.clone(), raw(&list.value)))
            .collect(),
        ablation: file.ablation.0,
        tools: by_name(file.tools),
        // They are needed for messages until the end.
        sources: Sources::default(),
    };
    let mut check = Check::new(&graph, folders, found);
    check.names();
    check.pinned(&file.pinned);
    check.exprs(
        graph
            .params
            .list
            .iter()
            .flat_map(|p| p.when.iter().chain(&p.effective)),
    );
    check.modules(&file.modules);
    check.named_values();
    check.textures();
    check.aliases();
    for pass in &graph.passes {
        check.pass(&pass.value, pass.at);
    }
    for name in &results {
        check.texture_name(name);
    }
    for compare in &graph.compare {
        check.side(&compare.value.a);
        check.side(&compare.value.b);
    }
    for (name, list) in &file.fit.0 {
        list.value
            .0
            .iter()
            .for_each(|value| check.setting(name, value));
    }
    for view in graph.views.iter().chain(&graph.ablation) {
        check.settings(&view.value.set);
    }
    for (_, tool) in &graph.tools {
        check.tool(&tool.value);
    }
    for item in &graph.checks {
        check.check(&item.value);
    }
    check.exprs(graph.refuse.iter().map(|r| &r.when));
    if let Some(name) = &file.pointer {
        check.pointer(name);
    }
    if let Some(caption) = &graph.caption {
        check.caption(caption);
    }
    check.tables(&graph.tables);
    check.exprs(graph.scene_expressions());
    let Findings {
        sources,
        mut errors,
        ..
    } = check.found;
    graph.sources = sources;
    if errors.iter().any(|e| e.severity == Severity::Error) {
        errors.sort_by(|a, b| a.place.cmp(&b.place));
        errors.dedup();
        return Err(errors);
    }
    Ok(graph)
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

fn raw(list: &Items<RawText>) -> Vec<String> {
    list.0.iter().map(|text| text.value.0.clone()).collect()
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
