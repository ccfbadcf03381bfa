//! Shaders against the graph: looks up every name that a shader binds, and compares declarations.

use super::fit::resolve;
use super::layouts::{Declared, Layouts};
use super::linked::{Bound, BoundCase, Linked, Target};
use super::members::mistakes;
use super::place::{Words, at_declaration, at_member, has_word};
use super::runs::Runs;
use super::unused::{Texts, unused};
use crate::diagnostics::{At, Diagnostic, Severity};
use crate::graph::definition::Graph;
use crate::graph::file::PassDecl;
use crate::shader::{Binding, Compiled, Generated, ShaderCompiler, Source};
use crate::vulkan::Stage;
use rayon::prelude::*;
use std::collections::{BTreeMap, HashSet};
use std::path::Path;
use std::sync::Arc;

/// Compiles the shaders of a graph's passes that run, in parallel, and links them; the others stay
/// empty. Warnings come with a good result too.
///
/// # Errors
/// All mistakes of these shaders.
pub fn link(
    graph: &Graph,
    compiler: &ShaderCompiler,
    shaders: &Path,
    runs: &Runs,
) -> Result<(Vec<Linked>, Vec<Diagnostic>), Vec<Diagnostic>> {
    let generated = &runs.generated;
    let mut linker = Linker {
        graph,
        shaders,
        findings: Vec::new(),
        used: HashSet::new(),
    };
    let compiled = linker.compile(compiler, runs);
    if !linker.findings.is_empty() {
        return Err(linker.findings);
    }
    let mut texts: Vec<Texts> = compiled.values().map(|c| c.texts.clone()).collect();
    let mut linked = Vec::new();
    // Files that are not compiled: those of passes that rest, and of all options of modules.
    let mut resting: Vec<&String> = graph.params.list.iter().flat_map(|p| &p.files).collect();
    for (i, pass) in graph.passes.iter().enumerate() {
        linker.mark_used(&pass.value);
        linked.push(if runs.has(i) {
            linker.pass(&pass.value, &compiled)
        } else {
            resting.extend(pass.value.shaders.0.iter().map(|s| &s.value));
            Linked::default()
        });
    }
    texts.extend(linker.resting(&resting, compiler, generated));
    let all = (0..graph.passes.len()).all(|i| runs.has(i));
    let place =
        |d: &Declared<'_>, message: String| at_declaration(shaders, d.shader, d.name, message);
    let members = mistakes(&Layouts::new(graph, &linked), all, place);
    let Linker {
        mut findings,
        mut used,
        ..
    } = linker;
    // An alias that is used uses all that it may stand for.
    for alias in graph
        .aliases
        .iter()
        .filter(|a| used.contains(&a.name))
        .collect::<Vec<_>>()
    {
        used.extend(alias.cases.iter().map(|case| case.bind.of.value.clone()));
    }
    findings.extend(members);
    findings.extend(unused(graph, &used, &texts));
    if findings.iter().any(|f| f.severity == Severity::Error) {
        Err(findings)
    } else {
        Ok((linked, findings))
    }
}

/// A mistake in the generated `params.glsl` is in the name of a parameter or value, and reported at
/// its declaration.
fn where_declared(graph: &Graph, found: Diagnostic) -> Diagnostic {
    let line = found.source.as_deref().unwrap_or("");
    let is_name = |name: &str| has_word(line, name) || has_word(line, &name.to_uppercase());
    let params = graph
        .params
        .list
        .iter()
        .map(|p| (p.name.as_str(), p.at, "parameter"));
    let mut declared = params.chain(
        graph
            .values
            .iter()
            .map(|v| (v.name.as_str(), v.at, "value")),
    );
    match declared.find(|(name, ..)| is_name(name)) {
        Some((name, at, what)) if found.place.file.starts_with("params.glsl (generated)") => {
            graph.sources.error(
                at,
                format!("'{name}' cannot be a {what}'s name: GLSL refuses `{line}`"),
            )
        }
        _ => found,
    }
}

struct Linker<'g> {
    graph: &'g Graph,
    shaders: &'g Path,
    findings: Vec<Diagnostic>,
    used: HashSet<String>,
}

impl<'g> Linker<'g> {
    fn error(&mut self, at: At, message: String) {
        self.findings.push(self.graph.sources.error(at, message));
    }

    /// Each mistake once, however many passes share the shader.
    fn find(&mut self, found: Diagnostic) {
        if !self.findings.contains(&found) {
            self.findings.push(found);
        }
    }

    /// The shaders of all passes that run, by file.
    fn compile(&mut self, compiler: &ShaderCompiler, runs: &Runs) -> BTreeMap<&'g str, Compiled> {
        let passes = self
            .graph
            .passes
            .iter()
            .enumerate()
            .filter(|(i, _)| runs.has(*i));
        let shaders = passes
            .flat_map(|(_, pass)| &pass.value.shaders.0)
            .map(|s| s.value.as_str());
        let files: BTreeMap<&str, Stage> = shaders
            .filter_map(|file| Some((file, Stage::of_file(file)?)))
            .collect();
        let compile = |(file, stage): (&&'g str, &Stage)| {
            (
                *file,
                compiler.compile(
                    &Source {
                        file: (*file).to_string(),
                        stage: *stage,
                    },
                    &runs.generated,
                ),
            )
        };
        let results: Vec<_> = files.par_iter().map(compile).collect();
        let mut compiled = BTreeMap::new();
        for (file, result) in results {
            match result {
                Ok(shader) => drop(compiled.insert(file, shader)),
                Err(list) => list
                    .into_iter()
                    .for_each(|d| self.find(where_declared(self.graph, d))),
            }
        }
        compiled
    }

    fn pass(&mut self, pass: &PassDecl, compiled: &BTreeMap<&str, Compiled>) -> Linked {
        let mut stages: Vec<Compiled> = pass
            .shaders
            .0
            .iter()
            .filter_map(|s| compiled.get(s.value.as_str()).cloned())
            .collect();
        stages.sort_by_key(|s| s.stage);
        let mut bound = Vec::new();
        for shader in &stages {
            bound.extend(
                shader
                    .interface
                    .bindings
                    .iter()
                    .filter_map(|binding| self.binding(pass, shader, binding)),
            );
        }
        let names: Vec<&str> = stages
            .iter()
            .flat_map(|s| s.interface.bindings.iter().map(|b| b.name.as_str()))
            .collect();
        for key in pass
            .bind
            .0
            .iter()
            .map(|(key, _)| key)
            .filter(|key| !names.contains(&key.value.as_str()))
        {
            if !stages.is_empty() {
                let message = format!(
                    "no shader of pass '{}' uses the name '{}'",
                    pass.name.value, key.value
                );
                let found = self.graph.sources.error(key.at, message);
                self.findings
                    .push(found.nearest(&key.value, names.iter().copied()));
            }
        }
        self.outputs(pass, &stages);
        Linked { stages, bound }
    }

    /// A shader's binding, if all its cases exist and fit.
    fn binding(&mut self, pass: &PassDecl, shader: &Compiled, binding: &Binding) -> Option<Bound> {
        let name = &binding.name;
        if pass.bind(name).is_none() {
            self.used.insert(name.clone());
        }
        // All of them are looked at: each must fit.
        let mut cases = Vec::new();
        let mut all = true;
        for (when, bind) in self.graph.cases(pass, name) {
            self.used.extend(bind.as_ref().map(|b| b.of.value.clone()));
            match resolve(self.graph, pass, name, bind.as_ref(), &binding.resource) {
                Ok(target) => cases.push(BoundCase { when, target, bind }),
                Err((message, help)) => {
                    let message = format!("{message} (pass '{}')", pass.name.value);
                    self.find(at_declaration(self.shaders, shader, name, message).help(help));
                    all = false;
                }
            }
        }
        if !all {
            return None;
        }
        self.host(shader, binding, &cases);
        Some(Bound {
            stage: shader.stage,
            binding: binding.binding,
            name: name.clone(),
            resource: binding.resource.clone(),
            layout: binding.layout.clone(),
            reads: binding.reads.clone(),
            cases,
        })
    }

    /// What shader files that are not compiled would use, as far as their texts tell; returns
    /// these.
    fn resting(
        &mut self,
        files: &[&String],
        compiler: &ShaderCompiler,
        generated: &Generated,
    ) -> Vec<Texts> {
        // Compilation reports unreadable files.
        let read = |file: &&String| Some(Arc::new(compiler.texts(file, generated).ok()?));
        let texts: Vec<Texts> = files.iter().filter_map(read).collect();
        let files: BTreeMap<&String, &String> = texts.iter().flat_map(|t| t.iter()).collect();
        let words = Words::of(files.values().map(|text| text.as_str()));
        let names = self
            .graph
            .resource_names()
            .chain(self.graph.aliases.iter().map(|a| a.name.as_str()));
        self.used
            .extend(names.filter(|name| words.has(name)).map(String::from));
        texts
    }

    /// Resources that a pass uses without its shaders.
    fn mark_used(&mut self, pass: &PassDecl) {
        let names = pass
            .color
            .0
            .iter()
            .map(|c| &c.value.to)
            .chain(pass.depth.iter().map(|d| &d.value.to));
        let names = names.chain(&pass.clear);
        let names = names
            .chain(pass.bind.0.iter().map(|(_, bind)| &bind.value.of))
            .map(|name| &name.value);
        let names = names.chain(pass.command().map(|(path, _)| &path.value.buffer));
        self.used.extend(names.cloned());
    }

    fn outputs(&mut self, pass: &PassDecl, stages: &[Compiled]) {
        let name = &pass.name.value;
        let Some(fragment) = stages.iter().find(|s| s.stage == Stage::Fragment) else {
            if let Some(target) = pass.color.0.first() {
                let message = format!(
                    "pass '{name}' has colour attachments and no .frag shader that writes them"
                );
                self.error(target.at, message);
            }
            return;
        };
        let (file, outputs, declared) = (
            &fragment.file,
            &fragment.interface.outputs,
            pass.color.0.len(),
        );
        for location in outputs.iter().filter(|o| **o as usize >= declared) {
            let message = format!(
                "'{file}' writes location {location}, but pass '{name}' declares {declared} colour attachments"
            );
            self.error(pass.name.at, message);
        }
        for (location, target) in pass.color.0.iter().enumerate() {
            if !outputs.iter().any(|o| *o as usize == location) {
                let to = &target.value.to.value;
                let message = format!(
                    "pass '{name}' declares '{to}' as colour {location}, but '{file}' does not write that location"
                );
                self.error(target.at, message);
            }
        }
    }

    /// Compares a shader's declarations of scene structs with those of the program.
    fn host(&mut self, shader: &Compiled, binding: &Binding, cases: &[BoundCase]) {
        for case in cases {
            let (Target::External(i), Some(layout)) = (&case.target, &binding.layout) else {
                continue;
            };
            if let Some((message, member)) = self.graph.interface.resources[*i].mismatch(layout) {
                self.find(match member {
                    Some(member) => {
                        at_member(self.shaders, shader, &binding.name, &member, message)
                    }
                    None => at_declaration(self.shaders, shader, &binding.name, message),
                });
            }
        }
    }
}
