//! Warnings for what a graph declares and nobody uses.

use super::file::CheckDecl;
use super::load::Graph;
use crate::diagnostics::{At, Diagnostic, Severity};
use crate::shader::module_include;
use std::collections::{BTreeMap, HashSet};
use std::sync::Arc;

/// The files that a shader is made of: name, text.
pub(super) type Texts = Arc<BTreeMap<String, String>>;

/// One warning for each resource that is not among those used, and for each parameter and value that neither the graph nor
/// the shaders' texts name.
pub(super) fn unused(graph: &Graph, used: &HashSet<String>, shaders: &[Texts]) -> Vec<Diagnostic> {
    let mut wanted: HashSet<&str> = graph.outputs.iter().map(String::as_str).collect();
    wanted.extend(graph.output.as_deref());
    wanted.extend(graph.hdr.as_deref());
    wanted.extend(graph.parts.iter().map(|p| p.texture.as_str()));
    wanted.extend(graph.checks.iter().map(CheckDecl::buffer));
    wanted.extend(graph.tables.iter().map(|t| t.value.buffer()));
    for voxels in graph.voxels.iter().map(|v| &v.value) {
        let names = [&voxels.occupied, &voxels.color, &voxels.normal, &voxels.borders];
        wanted.extend(names.map(|n| n.value.as_str()));
    }
    let mut findings = Vec::new();
    let mut warn = |at: At, message: String| {
        let d = graph.sources.error(at, message);
        findings.push(Diagnostic { severity: Severity::Warning, ..d });
    };
    let texts: HashSet<&String> =
        shaders.iter().flat_map(|t| t.iter()).filter(|(f, _)| *f != "params.glsl").map(|(_, t)| t).collect();
    let in_texts = |in_shader: &str| {
        let end = |rest: &str| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_');
        let names = |text: &str| text.match_indices(in_shader).any(|(at, _)| end(&text[at + in_shader.len()..]));
        texts.iter().any(|t| names(t))
    };
    let resources = graph.textures.iter().map(|t| (&t.0, t.1.at)).chain(graph.buffers.iter().map(|b| (&b.0, b.1.at)));
    // One option of a module may read what another does not.
    let aliases = graph.aliases.iter().filter(|a| !in_texts(&a.name)).map(|a| (&a.name, a.at));
    for (name, at) in resources.chain(aliases) {
        if !used.contains(name) && !wanted.contains(name.as_str()) {
            warn(at, format!("'{name}' is declared and never used"));
        }
    }
    for (i, param) in graph.params.list.iter().enumerate() {
        let in_shader = if param.constant { param.name.to_uppercase() } else { format!("params.{}", param.name) };
        let in_graph = super::plan::all_expressions(graph).any(|e| {
            e.value
                .variables()
                .iter()
                .any(|v| *v == param.name || v.strip_prefix(&param.name).is_some_and(|r| r.starts_with('_')))
        });
        let as_format = graph.textures.iter().any(|t| t.1.value.format.value == param.name);
        let included = param.is_module() && shaders.iter().any(|t| t.contains_key(&module_include(&param.name)));
        if !in_graph && !as_format && !included && !in_texts(&in_shader) {
            let at = graph.params_at.get(i).copied().unwrap_or_default();
            warn(at, format!("parameter '{}' is declared and never used", param.name));
        }
    }
    for value in &graph.values {
        let in_graph = super::plan::all_expressions(graph).any(|e| e.value.variables().contains(&value.name));
        if !in_graph && !in_texts(&format!("params.{}", value.name)) {
            warn(value.at, format!("value '{}' is declared and never used", value.name));
        }
    }
    findings
}
