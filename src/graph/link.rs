//! Shaders against the graph: every name a shader binds is looked up, and what it expects is compared with what is there.

use super::externals::{EXTERNALS, ExternalKind};
use super::file::{Bind, Ex, PassDecl, TextureDecl};
use super::layouts::{Declared, Layouts};
use super::load::Graph;
use super::param::Kind;
use super::runs::Runs;
use super::unused::{Texts, unused};
use crate::diagnostics::{Diagnostic, Place, Severity};
use crate::shader::{Binding, Compiled, Generated, Layout, Resource, ShaderCompiler, Shape, Source};
use crate::vulkan::Stage;
use crate::vulkan::format::{Channels, Format};
use rayon::prelude::*;
use std::collections::{BTreeMap, HashSet};
use std::path::Path;
use std::sync::Arc;

/// What a shader's name was found to be.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// Index in [`EXTERNALS`].
    External(usize),
    /// Index of a buffer.
    Buffer(usize),
    /// Index of a texture.
    Texture(usize),
}

/// One binding of one stage.
#[derive(Clone, Debug)]
pub struct Bound {
    /// Stage.
    pub stage: Stage,
    /// Binding number.
    pub binding: u32,
    /// Name in the shader.
    pub name: String,
    /// What the shader expects.
    pub resource: Resource,
    /// How the block of a buffer lies in memory.
    pub layout: Option<Arc<Layout>>,
    /// Bytes of a uniform block that may be read; none: all of them.
    pub reads: Option<Vec<(u32, u32)>>,
    /// What it is: one, or several of an alias, of which the first whose condition holds counts.
    pub cases: Vec<BoundCase>,
}

/// What a binding is, under a condition.
#[derive(Clone, Debug)]
pub struct BoundCase {
    /// The condition; none in the last case.
    pub when: Option<Ex>,
    /// What it is.
    pub target: Target,
    /// What the pass or an alias says of it: where it is renamed or narrowed.
    pub bind: Option<Bind>,
}

/// A pass with its shaders.
#[derive(Clone, Debug, Default)]
pub struct Linked {
    /// Compiled stages, in pipeline order.
    pub stages: Vec<Compiled>,
    /// All bindings.
    pub bound: Vec<Bound>,
}

/// Compiles the shaders of a graph's passes that run, in parallel, and links them; the others stay empty. Warnings come
/// with a good result too.
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
    let mut files: BTreeMap<&str, Stage> = BTreeMap::new();
    for (_, pass) in graph.passes.iter().enumerate().filter(|(i, _)| runs.has(*i)) {
        for shader in &pass.value.shaders.0 {
            if let Some(stage) = Stage::of_file(&shader.value) {
                files.insert(&shader.value, stage);
            }
        }
    }
    let results: Vec<_> = files
        .par_iter()
        .map(|(file, stage)| (*file, compiler.compile(&Source { file: (*file).to_string(), stage: *stage }, generated)))
        .collect();
    let mut findings = Vec::new();
    let mut compiled = BTreeMap::new();
    for (file, result) in results {
        match result {
            Ok(shader) => drop(compiled.insert(file, shader)),
            Err(list) => {
                for found in list.into_iter().map(|d| where_declared(graph, d)) {
                    if !findings.contains(&found) {
                        findings.push(found);
                    }
                }
            }
        }
    }
    if !findings.is_empty() {
        return Err(findings);
    }
    let mut linker = Linker { graph, shaders, findings, used: HashSet::new() };
    let mut texts: Vec<Texts> = compiled.values().map(|c| c.texts.clone()).collect();
    let mut linked = Vec::new();
    for (i, pass) in graph.passes.iter().enumerate() {
        linked.push(if runs.has(i) {
            linker.pass(&pass.value, &compiled)
        } else {
            texts.extend(linker.resting(&pass.value, compiler, generated));
            Linked::default()
        });
    }
    texts.extend(linker.options(compiler, generated));
    let all = (0..graph.passes.len()).all(|i| runs.has(i));
    let place = |d: &Declared<'_>, message: String| linker.at_declaration(d.shader, d.name, message);
    let members = Layouts::new(graph, &linked).mistakes(all, place);
    let Linker { mut findings, mut used, .. } = linker;
    // An alias that is used uses all that it may stand for.
    for alias in graph.aliases.iter().filter(|a| used.contains(&a.name)).collect::<Vec<_>>() {
        used.extend(alias.cases.iter().map(|case| case.bind.of.value.clone()));
    }
    findings.extend(members);
    findings.extend(unused(graph, &used, &texts));
    if findings.iter().any(|f| f.severity == Severity::Error) { Err(findings) } else { Ok((linked, findings)) }
}

/// A mistake in the generated `params.glsl` is one in the name of a parameter or value: told where that is declared.
fn where_declared(graph: &Graph, found: Diagnostic) -> Diagnostic {
    let line = found.source.as_deref().unwrap_or("");
    let is_name = |name: &str| {
        line.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == name || word == name.to_uppercase())
    };
    match graph.params.list.iter().position(|p| is_name(&p.name)) {
        Some(i) if found.place.file.starts_with("params.glsl (generated)") => {
            let name = &graph.params.list[i].name;
            let at = graph.params_at.get(i).copied().unwrap_or_default();
            graph.sources.error(at, format!("'{name}' cannot be a parameter's name: GLSL refuses `{line}`"))
        }
        _ => match graph.values.iter().find(|v| is_name(&v.name)) {
            Some(v) if found.place.file.starts_with("params.glsl (generated)") => {
                graph.sources.error(v.at, format!("'{}' cannot be a value's name: GLSL refuses `{line}`", v.name))
            }
            _ => found,
        },
    }
}

struct Linker<'g> {
    graph: &'g Graph,
    shaders: &'g Path,
    findings: Vec<Diagnostic>,
    used: HashSet<String>,
}

impl Linker<'_> {
    fn pass(&mut self, pass: &PassDecl, compiled: &BTreeMap<&str, Compiled>) -> Linked {
        let mut stages: Vec<Compiled> =
            pass.shaders.0.iter().filter_map(|s| compiled.get(s.value.as_str()).cloned()).collect();
        stages.sort_by_key(|s| s.stage);
        let mut bound = Vec::new();
        for shader in &stages {
            for binding in &shader.interface.bindings {
                if !pass.bind.0.iter().any(|(key, _)| key.value == binding.name) {
                    self.used.insert(binding.name.clone());
                }
                let cases = self.graph.cases(pass, &binding.name).into_iter();
                // All of them are looked at: each must fit.
                let cases: Vec<Option<BoundCase>> = cases
                    .map(|(when, bind)| {
                        let target = self.resolve(pass, shader, &binding.name, bind.as_ref(), &binding.resource)?;
                        Some(BoundCase { when, target, bind })
                    })
                    .collect();
                if let Some(cases) = cases.into_iter().collect::<Option<Vec<_>>>() {
                    self.host(shader, binding, &cases);
                    bound.push(Bound {
                        stage: shader.stage,
                        binding: binding.binding,
                        name: binding.name.clone(),
                        resource: binding.resource.clone(),
                        layout: binding.layout.clone(),
                        reads: binding.reads.clone(),
                        cases,
                    });
                }
            }
        }
        for (key, _) in &pass.bind.0 {
            let names: Vec<&str> =
                stages.iter().flat_map(|s| s.interface.bindings.iter().map(|b| b.name.as_str())).collect();
            if !names.contains(&key.value.as_str()) && !stages.is_empty() {
                let found = self
                    .graph
                    .sources
                    .error(key.at, format!("no shader of pass '{}' uses the name '{}'", pass.name.value, key.value));
                self.findings.push(found.nearest(&key.value, names));
            }
        }
        self.used.extend(pass.bind.0.iter().map(|(_, bind)| bind.value.of.value.clone()));
        self.outputs(pass, &stages);
        self.mark_used(pass);
        Linked { stages, bound }
    }

    /// What a pass that does not run would use, as far as the texts of its shaders tell; returns these.
    fn resting(&mut self, pass: &PassDecl, compiler: &ShaderCompiler, generated: &Generated) -> Vec<Texts> {
        self.mark_used(pass);
        self.used.extend(pass.bind.0.iter().map(|(_, bind)| bind.value.of.value.clone()));
        // What cannot be read is told when the pass runs.
        let files = pass.shaders.0.iter();
        let texts: Vec<Texts> =
            files.filter_map(|s| Some(Arc::new(compiler.texts(&s.value, generated).ok()?))).collect();
        self.mark_named(&texts);
        texts
    }

    /// What the files of all options of modules would use; returns their texts.
    fn options(&mut self, compiler: &ShaderCompiler, generated: &Generated) -> Vec<Texts> {
        let files = self.graph.params.list.iter().flat_map(|p| &p.files);
        let texts: Vec<Texts> = files.filter_map(|f| Some(Arc::new(compiler.texts(f, generated).ok()?))).collect();
        self.mark_named(&texts);
        texts
    }

    fn mark_named(&mut self, texts: &[Texts]) {
        let graph = self.graph;
        let names = graph.textures.iter().map(|t| &t.0).chain(graph.buffers.iter().map(|b| &b.0));
        let names = names.chain(graph.aliases.iter().map(|a| &a.name));
        let named = names.filter(|name| texts.iter().flat_map(|t| t.values()).any(|text| has_word(text, name)));
        self.used.extend(named.cloned());
    }

    fn mark_used(&mut self, pass: &PassDecl) {
        let names = pass.color.0.iter().map(|c| &c.value.to).chain(pass.depth.iter().map(|d| &d.value.to));
        let names = names.chain(&pass.clear).chain(pass.copy.iter().flat_map(|c| [&c.value.from, &c.value.to]));
        self.used.extend(names.map(|n| n.value.clone()));
        for indirect in [
            pass.dispatch.as_ref().and_then(|d| match &d.value {
                super::file::Dispatch::Indirect(command) => Some(&command.path.value.buffer),
                _ => None,
            }),
            pass.draw.as_ref().and_then(|d| match &d.value {
                super::file::Draw::Indirect(command) => Some(&command.path.value.buffer),
                _ => None,
            }),
        ] {
            self.used.extend(indirect.cloned());
        }
    }

    fn outputs(&mut self, pass: &PassDecl, stages: &[Compiled]) {
        let Some(fragment) = stages.iter().find(|s| s.stage == Stage::Fragment) else {
            if let Some(target) = pass.color.0.first() {
                let message =
                    format!("pass '{}' has colour attachments and no .frag shader that writes them", pass.name.value);
                self.findings.push(self.graph.sources.error(target.at, message));
            }
            return;
        };
        let declared = pass.color.0.len();
        for location in &fragment.interface.outputs {
            if *location as usize >= declared {
                let message = format!(
                    "'{}' writes location {location}, but pass '{}' declares {declared} colour attachments",
                    fragment.file, pass.name.value
                );
                self.findings.push(self.graph.sources.error(pass.name.at, message));
            }
        }
        for (location, target) in pass.color.0.iter().enumerate() {
            if !fragment.interface.outputs.iter().any(|o| *o as usize == location) {
                let message = format!(
                    "pass '{}' declares '{}' as colour {location}, but '{}' does not write that location",
                    pass.name.value, target.value.to.value, fragment.file
                );
                self.findings.push(self.graph.sources.error(target.at, message));
            }
        }
    }

    /// What a shader declares of the scene's structs against what the program fills.
    fn host(&mut self, shader: &Compiled, binding: &Binding, cases: &[BoundCase]) {
        for case in cases {
            let (Target::External(i), Some(layout)) = (&case.target, &binding.layout) else { continue };
            if let Some((message, member)) = super::host::mismatch(EXTERNALS[*i].name, layout) {
                let found = match member {
                    Some(member) => self.at_member(shader, &binding.name, &member, message),
                    None => self.at_declaration(shader, &binding.name, message),
                };
                if !self.findings.contains(&found) {
                    self.findings.push(found);
                }
            }
        }
    }

    /// An error at the line of a member, `type member;`, before the line where a shader declares its block; there, where
    /// the member has no line of its own.
    fn at_member(&self, shader: &Compiled, name: &str, member: &str, message: String) -> Diagnostic {
        let block = self.at_declaration(shader, name, message);
        let declares = |line: &str| {
            let word = line.split_whitespace().nth(1).unwrap_or("");
            word.strip_prefix(member).is_some_and(|rest| rest.starts_with([';', '[', ',']))
        };
        let text = shader.texts.iter().find(|(file, _)| block.place.file.ends_with(file.as_str())).map(|(_, t)| t);
        let lines = (1u32..).zip(text.map_or("", String::as_str).lines());
        match lines.take_while(|(n, _)| *n <= block.place.line).filter(|(_, line)| declares(line)).last() {
            Some((line, source)) => {
                Diagnostic { place: Place { line, ..block.place }, source: Some(source.trim().into()), ..block }
            }
            None => block,
        }
    }

    /// An error at the line where a shader declares a name.
    fn at_declaration(&self, shader: &Compiled, name: &str, message: String) -> Diagnostic {
        // The declaration stands after `uniform` or `buffer`, or closes a block: `} name;`.
        let declares = |line: &str| {
            has_word(line, name)
                && (line.contains("uniform") || line.contains("buffer") || line.trim_start().starts_with('}'))
        };
        let main = std::iter::once(&shader.file).chain(shader.texts.keys());
        for file in main {
            let Some(text) = shader.texts.get(file) else { continue };
            if let Some((number, line)) = (1u32..).zip(text.lines()).find(|(_, l)| declares(l)) {
                let path = crate::shader::find(self.shaders, file).unwrap_or_else(|| self.shaders.join(file));
                let place = Place { file: path, line: number, column: 0 };
                return Diagnostic { source: Some(line.trim().into()), ..Diagnostic::error(place, message) };
            }
        }
        Diagnostic::error(Place { file: self.shaders.join(&shader.file), ..Place::default() }, message)
    }

    fn resolve(
        &mut self,
        pass: &PassDecl,
        shader: &Compiled,
        name: &str,
        decl: Option<&Bind>,
        resource: &Resource,
    ) -> Option<Target> {
        let resource_name = decl.map_or(name, |d| d.of.value.as_str());
        self.used.insert(resource_name.to_string());
        let external = EXTERNALS.iter().position(|e| e.name == resource_name);
        let buffer = self.graph.buffers.iter().position(|b| b.0 == resource_name);
        let texture = self.graph.textures.iter().position(|t| t.0 == resource_name);
        let fail = |linker: &mut Self, message: String, help: Option<String>| {
            let message = format!("{message} (pass '{}')", pass.name.value);
            let found = linker.at_declaration(shader, name, message).help(help);
            if !linker.findings.contains(&found) {
                linker.findings.push(found);
            }
            None
        };
        match (external, buffer, texture) {
            (Some(i), _, _) => {
                let fits = match EXTERNALS[i].kind {
                    ExternalKind::Uniform => *resource == Resource::Uniform,
                    ExternalKind::Storage => matches!(resource, Resource::Buffer { write: false, .. }),
                    ExternalKind::TextureArray => {
                        matches!(resource, Resource::Sampled { shape: Shape::D2Array, compare: false, integer: false })
                    }
                };
                if !fits {
                    let expected = match EXTERNALS[i].kind {
                        ExternalKind::Uniform => "a uniform block",
                        ExternalKind::Storage => "a read-only buffer",
                        ExternalKind::TextureArray => "a sampler2DArray",
                    };
                    return fail(
                        self,
                        format!("'{name}' is {expected} of the scene, and the shader declares {}", describe(resource)),
                        None,
                    );
                }
                Some(Target::External(i))
            }
            (_, Some(i), _) => match resource {
                Resource::Buffer { write: true, .. } if decl.is_some_and(|d| d.history) => {
                    fail(self, format!("the history of '{resource_name}' is read-only"), None)
                }
                Resource::Buffer { .. } | Resource::Uniform => Some(Target::Buffer(i)),
                other => fail(
                    self,
                    format!("'{resource_name}' is a buffer of the graph, and the shader declares {}", describe(other)),
                    None,
                ),
            },
            (_, _, Some(i)) => {
                let texture = &self.graph.textures[i].1.value;
                match mismatch(self.graph, resource_name, texture, decl, resource) {
                    Some((message, help)) => fail(self, message, help),
                    None => Some(Target::Texture(i)),
                }
            }
            _ => {
                let known = self.graph.textures.iter().map(|t| t.0.as_str());
                let known = known.chain(self.graph.buffers.iter().map(|b| b.0.as_str()));
                let known = known.chain(self.graph.aliases.iter().map(|a| a.name.as_str()));
                let known =
                    known.chain(EXTERNALS.iter().map(|e| e.name)).chain(pass.bind.0.iter().map(|b| b.0.value.as_str()));
                let help = crate::diagnostics::nearest(name, known);
                fail(
                    self,
                    format!("'{name}' is {} that neither the graph nor the scene declares", describe(resource)),
                    help.or(Some(format!(
                        "declare it in the graph, or rename it: bind: {{\"{name}\": (of: \"...\")}}"
                    ))),
                )
            }
        }
    }
}

/// Whether a name stands in a text, and not inside a longer one.
pub(super) fn has_word(text: &str, name: &str) -> bool {
    text.match_indices(name).any(|(i, _)| {
        let edge = |c: Option<char>| c.is_none_or(|c| !c.is_alphanumeric() && c != '_');
        edge(text[..i].chars().next_back()) && edge(text[i + name.len()..].chars().next())
    })
}

/// What a shader declares, in words.
pub fn describe(resource: &Resource) -> String {
    match resource {
        Resource::Uniform => "a uniform block".into(),
        Resource::Buffer { write: true, .. } => "a buffer that it writes".into(),
        Resource::Buffer { .. } => "a buffer".into(),
        Resource::Sampled { shape, compare, integer } => format!(
            "a {}sampler{}{}",
            if *integer { "u" } else { "" },
            shape.name(),
            if *compare { "Shadow" } else { "" }
        ),
        Resource::Storage { shape, format, .. } => {
            let format = format.map_or(String::from("without a format"), |f| format!("of format {f}"));
            format!("an image{} {format}", shape.name())
        }
    }
}

/// Shape of a texture as a binding sees it.
pub fn bound_shape(texture: &TextureDecl, decl: Option<&Bind>) -> Shape {
    match (texture.size.0.len(), &texture.layers, decl.and_then(|d| d.layer.as_ref())) {
        (3, ..) => Shape::D3,
        (_, Some(_), None) => Shape::D2Array,
        _ => Shape::D2,
    }
}

/// Why a texture does not fit what a shader declares, and what would.
fn mismatch(
    graph: &Graph,
    name: &str,
    texture: &TextureDecl,
    decl: Option<&Bind>,
    resource: &Resource,
) -> Option<(String, Option<String>)> {
    let (shape, wanted) = match resource {
        Resource::Sampled { shape, .. } | Resource::Storage { shape, .. } => (*shape, bound_shape(texture, decl)),
        other => return Some((format!("'{name}' is a texture, and the shader declares {}", describe(other)), None)),
    };
    if shape != wanted {
        return Some((
            format!("'{name}' is {}, and the shader declares {}", wanted.name(), describe(resource)),
            Some(format!("declare it as {}", wanted.name())),
        ));
    }
    let view = decl.and_then(|d| d.format.as_ref()).map_or(texture.format.value.as_str(), |f| f.value.as_str());
    let formats: Vec<Format> = match Format::named(view) {
        Some(f) => vec![f],
        None => match graph.params.list.iter().find(|p| p.name == view).map(|p| &p.kind) {
            Some(Kind::Choice(options)) => options.iter().filter_map(|o| Format::named(o)).collect(),
            _ => vec![],
        },
    };
    match resource {
        Resource::Storage { format, read, write, .. } => {
            if formats.iter().any(|f| f.is_depth()) {
                return Some((format!("'{name}' is a depth texture, which cannot be a storage image"), None));
            }
            if formats.iter().any(|f| f.name.ends_with("_srgb")) {
                return Some((format!("'{name}' is sRGB-encoded, which a storage image cannot be"), None));
            }
            if *write && decl.is_some_and(|d| d.history) {
                return Some((format!("the history of '{name}' is read-only"), None));
            }
            match format {
                Some(declared) if formats.iter().any(|f| f.name != *declared) => Some((
                    format!("'{name}' has format {view}, and the shader declares {declared}"),
                    Some(if formats.len() == 1 {
                        format!("write layout({view}), or bind it as another declared view")
                    } else {
                        "its format is a choice: write to a `writeonly` image without a format, and read by sampler"
                            .into()
                    }),
                )),
                None if *read => Some((
                    format!("'{name}' is read as an image without a format"),
                    Some(format!("write layout({view}), or mark it writeonly")),
                )),
                _ => None,
            }
        }
        Resource::Sampled { compare, integer, .. } => {
            let wants = formats.iter().any(|f| matches!(f.channels, Channels::Uint | Channels::Int));
            if wants != *integer {
                let better = if wants { "a usampler" } else { "a sampler" };
                return Some((
                    format!("'{name}' has format {view}, and the shader declares {}", describe(resource)),
                    Some(format!("declare {better}")),
                ));
            }
            let sampler = decl.and_then(|d| d.sampler).or(texture.sampler);
            let compares = sampler.is_some_and(|s| s.compare.is_some());
            if compares != *compare {
                let help = if *compare {
                    "bind it with sampler: (compare: less_or_equal)"
                } else {
                    "declare a Shadow sampler, or bind it with a sampler that does not compare"
                };
                return Some((
                    format!("the sampler of '{name}' does not fit: the shader declares {}", describe(resource)),
                    Some(help.into()),
                ));
            }
            None
        }
        _ => None,
    }
}
