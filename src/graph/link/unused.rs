//! Warnings for unused declarations of a graph.

use super::place::Words;
use crate::diagnostics::{At, Diagnostic, Severity};
use crate::graph::definition::Graph;
use crate::shader::module_include;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;

/// The files that a shader is made of: name, text.
pub(super) type Texts = Arc<BTreeMap<String, String>>;

/// One warning for each resource that is not among those used, and for each parameter and value
/// that neither the graph nor the shaders' texts name.
pub(super) fn unused(graph: &Graph, used: &HashSet<String>, shaders: &[Texts]) -> Vec<Diagnostic> {
    let mut wanted: HashSet<&str> = graph.outputs.iter().map(String::as_str).collect();
    wanted.extend(graph.output.as_deref());
    wanted.extend(graph.hdr.as_deref());
    wanted.extend(graph.parts.iter().map(|p| p.texture.as_str()));
    wanted.extend(
        graph
            .checks
            .iter()
            .map(|c| c.value.field.value.buffer.as_str()),
    );
    wanted.extend(
        graph
            .tables
            .iter()
            .map(|t| t.value.list.value.buffer.as_str()),
    );
    let of_tools = graph.tools.iter().flat_map(|t| &t.1.value.resources.0);
    wanted.extend(of_tools.map(|(_, name)| name.value.as_str()));
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
    let words = Words::of(
        texts
            .iter()
            .filter(|(file, _)| file.as_str() != "params.glsl")
            .map(|(_, text)| text.as_str()),
    );
    let resources = graph
        .textures
        .iter()
        .map(|t| (&t.0, t.1.at))
        .chain(graph.buffers.iter().map(|b| (&b.0, b.1.at)));
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
            warn(
                param.at,
                format!("parameter '{}' is declared and never used", param.name),
            );
        }
    }
    for value in &graph.values {
        if !variables.contains(&value.name) && !words.has(&format!("params.{}", value.name)) {
            warn(
                value.at,
                format!("value '{}' is declared and never used", value.name),
            );
        }
    }
    findings
}
