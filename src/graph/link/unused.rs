//! Warnings for unused declarations of a graph.

use super::place::Words;
use crate::diagnostics::{At, Diagnostic, Severity};
use crate::graph::debug::DEBUG_BUFFER;
use crate::graph::definition::Graph;
use crate::shader::module_include;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;

/// The files that a shader is made of: name, text.
pub(super) type Texts = Arc<BTreeMap<String, String>>;

/// One warning for each resource that is not among those used, and for each parameter and value
/// that neither the graph nor the shaders' texts name.
pub(super) fn unused(graph: &Graph, used: &HashSet<String>, shaders: &[Texts]) -> Vec<Diagnostic> {
    let wanted = wanted(graph);
    let mut findings = Vec::new();
    let mut warn = |at: At, message: String| {
        let d = graph.sources.error(at, message);
        findings.push(Diagnostic {
            severity: Severity::Warning,
            ..d
        });
    };
    // A file is the same in all shaders that include it.
    let texts: HashMap<&String, &String> = shaders.iter().flat_map(|t| t.iter()).collect();
    let written = texts.iter().filter(|t| t.0.as_str() != "params.glsl");
    let words = Words::of(written.map(|(_, text)| text.as_str()));
    let textures = graph.textures.iter().map(|t| (&t.0, t.1.at));
    let resources = textures.chain(graph.buffers.iter().map(|b| (&b.0, b.1.at)));
    // One option of a module may read what another does not.
    let aliases = graph
        .aliases
        .iter()
        .filter(|a| !words.has(&a.name))
        .map(|a| (&a.name, a.at));
    for (name, at) in resources.chain(aliases) {
        if !used.contains(name) && !wanted.contains(name.as_str()) {
            warn(at, format!("'{name}' is declared and never used"));
        }
    }
    let variables: HashSet<&String> = graph
        .expressions()
        .flat_map(|e| e.value.variables())
        .collect();
    for param in &graph.params.list {
        let in_graph = param.variables().iter().any(|v| variables.contains(v));
        let as_format = graph
            .textures
            .iter()
            .any(|t| t.1.value.format.value == param.name);
        let included = param.is_module()
            && shaders
                .iter()
                .any(|t| t.contains_key(&module_include(&param.name)));
        if !in_graph && !as_format && !included && !words.has(&param.in_shaders()) {
            let name = &param.name;
            warn(
                param.at,
                format!("parameter '{name}' is declared and never used"),
            );
        }
    }
    for value in &graph.values {
        if !variables.contains(&value.name) && !words.has(&format!("params.{}", value.name)) {
            let name = &value.name;
            warn(
                value.at,
                format!("value '{name}' is declared and never used"),
            );
        }
    }
    findings
}

/// Resources that are results, or that checks, tables and tools read.
fn wanted(graph: &Graph) -> HashSet<&str> {
    let outputs = graph.outputs.iter().chain(&graph.output).chain(&graph.hdr);
    let parts = graph.parts.iter().map(|p| &p.texture);
    let checks = graph.checks.iter().map(|c| &c.value.field.value.buffer);
    let tables = graph.tables.iter().map(|t| &t.value.list.value.buffer);
    let of_tools = graph.tools.iter().flat_map(|t| &t.1.value.resources.0);
    let of_tools = of_tools.map(|(_, name)| &name.value);
    let names = outputs.chain(parts).chain(checks).chain(tables);
    let names = names.chain(of_tools).map(String::as_str);
    names.chain([DEBUG_BUFFER]).collect()
}
