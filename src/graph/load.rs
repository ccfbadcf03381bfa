//! Reading a graph with its includes, and checking everything that needs no shader.

use super::alias::{Alias, narrowed};
use super::expr::Expr;
use super::file::{
    BufferDecl, CheckDecl, Command, CompareDecl, Dispatch, Draw, Ex, GraphFile, PassDecl, RawText, SceneNeeds,
    TextureDecl, ViewDecl, VoxelsDecl, ungrouped,
};
use super::param::{Kind, Param, Params};
use super::source::{At, Diagnostic, Loc, Place, Severity, Sources};
use super::table::TableDecl;
use super::value::{Named, ordered};
use crate::vulkan::{Format, Stage};
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

/// Where graphs and shaders are found.
#[derive(Clone, Debug)]
pub struct Folders {
    /// Graphs.
    pub passes: PathBuf,
    /// Shaders, with `include/` inside.
    pub shaders: PathBuf,
}

/// A graph that was read and checked.
#[derive(Debug)]
pub struct Graph {
    /// Its name: the file's stem.
    pub name: String,
    /// Parameters at their defaults.
    pub params: Params,
    /// Where each parameter is declared.
    pub params_at: Vec<At>,
    /// Modules that nobody chooses: name, file in the shader folder.
    pub modules: Vec<(String, String)>,
    /// Named values, each after those that it reads.
    pub values: Vec<Named>,
    /// Textures by name.
    pub textures: Vec<(String, Loc<TextureDecl>)>,
    /// Buffers by name.
    pub buffers: Vec<(String, Loc<BufferDecl>)>,
    /// Names that stand for textures or buffers, and textures sampled under a name of their own.
    pub aliases: Vec<Alias>,
    /// Passes in order.
    pub passes: Vec<Loc<PassDecl>>,
    /// The display-encoded picture.
    pub output: Option<String>,
    /// The linear picture.
    pub hdr: Option<String>,
    /// Further results.
    pub outputs: Vec<String>,
    /// Contributions to the linear picture: part, texture. Graphs are compared by the parts that both have.
    pub parts: Vec<(String, String)>,
    /// Needs of the geometry.
    pub scene: Option<Loc<SceneNeeds>>,
    /// Words that must be zero.
    pub checks: Vec<CheckDecl>,
    /// The `Vec2` parameter that a click on the picture sets: pixels from the picture's top left corner, negative
    /// where nothing is pointed at.
    pub pointer: Option<String>,
    /// Buffers that may be read as tables; wanted only by who asks for them.
    pub tables: Vec<Loc<TableDecl>>,
    /// Settings worth comparing.
    pub compare: Vec<Loc<CompareDecl>>,
    /// Settings that show something worth looking into.
    pub views: Vec<Loc<ViewDecl>>,
    /// Parameters that trade time for quality, and the values worth trying, neighbours alike.
    pub fit: Vec<(String, Vec<String>)>,
    /// Settings from the ideal to the method as it is set: what each step adds is a part of its error.
    pub ablation: Vec<Loc<ViewDecl>>,
    /// The voxels that it makes.
    pub voxels: Option<Loc<VoxelsDecl>>,
    /// The files it came from.
    pub sources: Sources,
}

/// Variables that every expression may use beside parameters.
pub const BUILTIN_VARIABLES: &[&str] = &[
    "width",
    "height",
    "mip",
    "index",
    "shadow_views",
    "light_count",
    "triangle_count",
    "scene_size",
    "scene_min_x",
    "scene_min_y",
    "scene_min_z",
    "scene_max_x",
    "scene_max_y",
    "scene_max_z",
];

/// Reads `path` and what it includes.
///
/// # Errors
/// All mistakes of all files.
pub fn load(path: &Path, folders: &Folders) -> Result<Graph, Vec<Diagnostic>> {
    let mut sources = Sources::default();
    let mut errors = Vec::new();
    let mut files = Vec::new();
    let mut broken = Vec::new();
    let whole = include(path, None, folders, &mut sources, &mut files, &mut Vec::new(), &mut errors, &mut broken);
    let mut graph = Graph {
        name: path.file_stem().map_or(String::new(), |s| s.to_string_lossy().into_owned()),
        params: Params::default(),
        params_at: Vec::new(),
        modules: Vec::new(),
        values: Vec::new(),
        textures: Vec::new(),
        buffers: Vec::new(),
        aliases: Vec::new(),
        passes: Vec::new(),
        output: None,
        hdr: None,
        outputs: Vec::new(),
        parts: Vec::new(),
        scene: None,
        checks: Vec::new(),
        pointer: None,
        tables: Vec::new(),
        compare: Vec::new(),
        views: Vec::new(),
        ablation: Vec::new(),
        voxels: None,
        fit: Vec::new(),
        sources,
    };
    let mut wanted = Vec::new();
    let mut decls = Vec::new();
    let mut values = Vec::new();
    let mut checks = Vec::new();
    let mut pointer = None;
    let mut tables = Vec::new();
    let mut fit: Vec<(Loc<String>, Loc<RawText>)> = Vec::new();
    let mut defaults: Vec<(Loc<String>, Loc<RawText>)> = Vec::new();
    let mut modules: Vec<(Loc<String>, Loc<String>)> = Vec::new();
    let mut retired = Vec::new();
    for file in files {
        // A parameter takes the place of the module that an included file has set once and for all.
        modules.retain(|(name, _)| !file.params.0.iter().any(|p| p.value.name().value == name.value));
        for (name, path) in file.modules.0 {
            modules.retain(|(other, _)| other.value != name.value);
            modules.push((name, path));
        }
        defaults.extend(file.defaults.0);
        retired.extend(file.retired.0.into_iter().map(|(name, instead)| (name.value, instead.value)));
        // A value or parameter of an including file takes the place of an included one's value.
        values.retain(|(name, _): &(Loc<String>, _)| {
            !file.values.0.iter().any(|(other, _)| other.value == name.value)
                && !file.params.0.iter().any(|p| p.value.name().value == name.value)
        });
        decls.extend(file.params.0);
        values.extend(file.values.0);
        graph.textures.extend(file.textures.0.into_iter().map(|(k, v)| (k.value, Loc { at: k.at, value: v.value })));
        graph.buffers.extend(file.buffers.0.into_iter().map(|(k, v)| (k.value, Loc { at: k.at, value: v.value })));
        errors.extend(super::alias::join(&mut graph.aliases, file.aliases, file.samplers, &graph.sources));
        for pass in ungrouped(file.passes) {
            insert_pass(&mut graph.passes, pass, &graph.sources, whole, &broken, &mut errors);
        }
        graph.scene = file.scene.or(graph.scene);
        checks.extend(file.checks.0);
        graph.compare.extend(file.compare.0);
        graph.views.extend(file.views.0);
        graph.ablation.extend(file.ablation.0);
        graph.voxels = file.voxels.or(graph.voxels);
        for (name, values) in file.fit.0 {
            let texts = values.value.0.iter().map(|v| v.value.0.clone()).collect();
            graph.fit.push((name.value.clone(), texts));
            fit.extend(values.value.0.into_iter().map(|v| (name.clone(), v)));
        }
        pointer = file.pointer.or(pointer);
        tables.extend(file.tables.0);
        for (slot, name) in [(&mut graph.output, file.output), (&mut graph.hdr, file.hdr)] {
            if let Some(name) = name {
                *slot = Some(name.value.clone());
                wanted.push(name);
            }
        }
        graph.outputs.extend(file.outputs.0.iter().map(|o| o.value.clone()));
        wanted.extend(file.outputs.0);
        graph.parts.extend(file.parts.0.iter().map(|(part, texture)| (part.value.clone(), texture.value.clone())));
        wanted.extend(file.parts.0.into_iter().map(|p| p.1));
    }
    sizes_of_others(&mut graph, whole, &broken, &mut errors);
    let mut list = check_params(&decls, &graph.sources, &mut errors, &mut broken);
    graph.params_at = list.iter().map(|p| declared_at(&decls, &p.name)).collect();
    set_defaults(&mut list, &defaults, &graph.sources, whole, &broken, &mut errors);
    graph.params = Params { retired, ..Params::new(list) };
    graph.values = ordered(values, &graph.params, &graph.sources, &mut errors, &mut broken);
    let mut check = Check { graph: &graph, folders, errors, broken, whole, variables: HashSet::new() };
    check.names();
    check.modules(&modules);
    check.named_values();
    check.textures();
    check.aliases();
    for pass in &graph.passes {
        check.pass(&pass.value, pass.at);
    }
    for name in &wanted {
        check.texture_name(name);
    }
    for compare in &graph.compare {
        check.values(compare.value.a.0.iter().chain(&compare.value.b.0));
    }
    check.values(fit.iter());
    for view in graph.views.iter().chain(&graph.ablation) {
        check.values(view.value.set.0.iter());
    }
    if let Some(voxels) = &graph.voxels {
        check.voxels(&voxels.value);
    }
    for item in &checks {
        check.check(&item.value, item.at);
    }
    if let Some(name) = &pointer {
        check.pointer(name);
    }
    check.tables(&tables);
    if let Some(needs) = &graph.scene {
        check.expr(&needs.value.max_edge);
        check.exprs(needs.value.when.as_ref());
    }
    let mut errors = check.errors;
    graph.modules = modules.into_iter().map(|(name, file)| (name.value, file.value)).collect();
    graph.checks = checks.into_iter().map(|c| c.value).collect();
    graph.pointer = pointer.map(|p| p.value);
    graph.tables = tables;
    if errors.iter().any(|e| e.severity == Severity::Error) {
        errors.sort_by(|a, b| a.place.cmp(&b.place));
        errors.dedup();
        return Err(errors);
    }
    Ok(graph)
}

/// Reads a file and what it includes; whether all of it could be read.
#[expect(clippy::too_many_arguments, reason = "one recursive walk that fills several lists")]
fn include(
    path: &Path,
    from: Option<At>,
    folders: &Folders,
    sources: &mut Sources,
    files: &mut Vec<GraphFile>,
    stack: &mut Vec<PathBuf>,
    errors: &mut Vec<Diagnostic>,
    broken: &mut Vec<String>,
) -> bool {
    if sources.paths().any(|p| p == path) && !stack.iter().any(|p| p == path) {
        return true;
    }
    if stack.iter().any(|p| p == path) {
        let message = format!("'{}' includes itself", path.display());
        errors.push(from.map_or(Diagnostic::error(Place::default(), message.clone()), |at| sources.error(at, message)));
        return true;
    }
    let file = match sources.read(path) {
        Ok(file) => file,
        Err(e) => {
            let known = if path.exists() { Vec::new() } else { ron_files(&folders.passes) };
            let name = path.file_name().map_or(String::new(), |n| n.to_string_lossy().into_owned());
            let found = match from {
                Some(at) => sources.error(at, e.message),
                None => e,
            };
            errors.push(found.nearest(&name, known.iter().map(String::as_str)));
            return false;
        }
    };
    let Some(parsed) = sources.parse::<GraphFile>(file, errors, broken) else { return false };
    stack.push(path.to_path_buf());
    let mut whole = true;
    for name in &parsed.include.0 {
        let path = folders.passes.join(&name.value);
        whole &= include(&path, Some(name.at), folders, sources, files, stack, errors, broken);
    }
    stack.pop();
    files.push(parsed);
    whole
}

fn ron_files(folder: &Path) -> Vec<String> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    entries.flatten().map(|e| e.file_name().to_string_lossy().into_owned()).filter(|n| n.ends_with(".ron")).collect()
}

fn check_params(
    decls: &[Loc<super::param::Decl>],
    sources: &Sources,
    errors: &mut Vec<Diagnostic>,
    broken: &mut Vec<String>,
) -> Vec<Param> {
    let mut list: Vec<Param> = Vec::new();
    for decl in decls {
        let name = decl.value.name();
        if !is_identifier(&name.value) {
            errors.push(
                sources
                    .error(name.at, format!("'{}' cannot be a parameter's name", name.value))
                    .help(Some("letters, digits and underscores, starting with a lower-case letter".into())),
            );
            continue;
        }
        if list.iter().any(|p| p.name == name.value) {
            errors.push(sources.error(name.at, format!("parameter '{}' is declared twice", name.value)));
            continue;
        }
        if BUILTIN_VARIABLES.contains(&name.value.as_str()) {
            errors.push(sources.error(name.at, format!("'{}' is a variable that every graph has", name.value)));
            continue;
        }
        match decl.value.param() {
            Ok(param) => list.push(param),
            Err(message) => {
                errors.push(sources.error(decl.at, message));
                broken.push(name.value.clone());
                broken.extend(decl.value.options().into_iter().map(|o| o.value));
            }
        }
    }
    let names: HashSet<&str> = list.iter().map(|p| p.name.as_str()).collect();
    for decl in decls {
        let options = decl.value.options();
        for (i, option) in options.iter().enumerate() {
            if options[..i].iter().any(|o| o.value == option.value) {
                errors.push(sources.error(option.at, format!("option '{}' stands twice", option.value)));
            } else if !is_identifier(&option.value) {
                errors.push(
                    sources
                        .error(option.at, format!("'{}' cannot be an option's name", option.value))
                        .help(Some("letters, digits and underscores, starting with a lower-case letter".into())),
                );
            } else if names.contains(option.value.as_str()) || BUILTIN_VARIABLES.contains(&option.value.as_str()) {
                errors.push(sources.error(
                    option.at,
                    format!(
                        "option '{}' has the name of a parameter or variable, which expressions could not tell apart",
                        option.value
                    ),
                ));
            }
        }
    }
    list
}

/// Gives the textures that are as large as another its size.
fn sizes_of_others(graph: &mut Graph, whole: bool, broken: &[String], errors: &mut Vec<Diagnostic>) {
    let sizes: Vec<(String, super::file::Size)> =
        graph.textures.iter().map(|(name, t)| (name.clone(), t.value.size.clone())).collect();
    let size_of = |name: &str| sizes.iter().find(|s| s.0 == name).map(|s| &s.1);
    for (name, texture) in &mut graph.textures {
        let mut at = texture.value.size.1.clone();
        // As many steps as there are textures: more go in a circle.
        for _ in 0..=sizes.len() {
            let Some(other) = &at else { break };
            let Some(found) = size_of(&other.value) else { break };
            texture.value.size.0.clone_from(&found.0);
            at.clone_from(&found.1);
        }
        match (at, &texture.value.size.1) {
            (Some(other), Some(_)) if size_of(&other.value).is_some() => {
                errors.push(graph.sources.error(texture.at, format!("'{name}' is as large as itself")));
            }
            (Some(other), _) if whole && !broken.contains(&other.value) => {
                let found = graph.sources.error(other.at, format!("no texture is named '{}'", other.value));
                errors.push(found.nearest(&other.value, sizes.iter().map(|s| s.0.as_str())));
            }
            _ => {}
        }
    }
}

fn declared_at(decls: &[Loc<super::param::Decl>], name: &str) -> At {
    decls.iter().find(|d| d.value.name().value == name).map_or(At::default(), |d| d.value.name().at)
}

/// Adds a pass at the end, or after the one that it names.
fn insert_pass(
    passes: &mut Vec<Loc<PassDecl>>,
    pass: Loc<PassDecl>,
    sources: &Sources,
    whole: bool,
    broken: &[String],
    errors: &mut Vec<Diagnostic>,
) {
    let Some(after) = pass.value.after.clone() else { return passes.push(pass) };
    match passes.iter().position(|p| p.value.name.value == after.value) {
        Some(i) => passes.insert(i + 1, pass),
        None if whole && !broken.contains(&after.value) => {
            let found = sources.error(after.at, format!("no pass '{}' stands before this one", after.value));
            errors.push(found.nearest(&after.value, passes.iter().map(|p| p.value.name.value.as_str())));
        }
        None => passes.push(pass),
    }
}

/// Changes defaults, the later one last.
fn set_defaults(
    list: &mut [Param],
    defaults: &[(Loc<String>, Loc<RawText>)],
    sources: &Sources,
    whole: bool,
    broken: &[String],
    errors: &mut Vec<Diagnostic>,
) {
    for (name, text) in defaults {
        match list.iter_mut().find(|p| p.name == name.value) {
            Some(param) => match param.parse(&text.value.0) {
                Ok(value) => param.default = value,
                Err(message) => errors.push(sources.error(text.at, format!("default of {message}"))),
            },
            None if whole && !broken.contains(&name.value) => {
                let known = list.iter().map(|p| p.name.as_str());
                let found = sources.error(name.at, format!("no parameter '{}' to give a default to", name.value));
                errors.push(found.nearest(&name.value, known));
            }
            None => {}
        }
    }
}

/// Names that GLSL and expressions can use.
pub(super) fn is_identifier(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_lowercase())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        && !name.contains("__")
}

struct Check<'g> {
    graph: &'g Graph,
    folders: &'g Folders,
    errors: Vec<Diagnostic>,
    /// Names in items that could not be read: not reported again where they are used.
    broken: Vec<String>,
    /// Whether every file could be read. If not, any unknown name may be one of those in the others.
    whole: bool,
    variables: HashSet<String>,
}

impl Check<'_> {
    /// Whether a name that is not known is a mistake of its own, and not what is left of one that was reported.
    fn is_unknown(&self, name: &str) -> bool {
        self.whole && !self.broken.iter().any(|b| b == name)
    }

    /// Names and values of parameters.
    fn values<'v>(&mut self, list: impl Iterator<Item = &'v (Loc<String>, Loc<RawText>)>) {
        for (name, text) in list {
            let mut params = self.graph.params.clone();
            let missing = !self.whole && params.index(&name.value).is_none();
            if !missing
                && !self.broken.contains(&name.value)
                && let Err(message) = params.set(&name.value, &text.value.0)
            {
                self.errors.push(self.graph.sources.error(name.at, message));
            }
        }
    }

    fn error(&mut self, at: At, message: String) {
        self.errors.push(self.graph.sources.error(at, message));
    }

    fn names(&mut self) {
        let graph = self.graph;
        self.variables = BUILTIN_VARIABLES.iter().map(|v| (*v).to_string()).collect();
        for param in &graph.params.list {
            let components = param.kind.components();
            if components == 0 {
                self.variables.insert(param.name.clone());
            }
            for c in ["x", "y", "z", "w"].iter().take(components) {
                self.variables.insert(format!("{}_{c}", param.name));
            }
        }
        self.variables.extend(graph.params.option_names().map(String::from));
        self.variables.extend(graph.values.iter().map(|v| v.name.clone()));
        let mut seen: HashMap<&str, ()> = HashMap::new();
        let resources =
            graph.textures.iter().map(|(n, t)| (n, t.at)).chain(graph.buffers.iter().map(|(n, b)| (n, b.at)));
        for (name, at) in resources.chain(graph.aliases.iter().map(|a| (&a.name, a.at))) {
            if !name.starts_with(|c: char| c.is_ascii_alphabetic())
                || !name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
            {
                self.error(at, format!("'{name}' cannot be a resource's name: letters, digits and underscores only"));
            }
            if super::externals::EXTERNALS.iter().any(|e| e.name == *name) {
                self.error(at, format!("'{name}' is a resource that every scene offers; choose another name"));
            }
            if seen.insert(name, ()).is_some() {
                self.error(at, format!("resource '{name}' is declared twice"));
            }
        }
        let mut passes: HashSet<&str> = HashSet::new();
        for pass in &graph.passes {
            let name = &pass.value.name;
            if !passes.insert(&name.value) {
                self.error(
                    name.at,
                    format!("two passes are named '{}'; timings could not tell them apart", name.value),
                );
            }
        }
    }

    /// Names and files of modules, chosen or not.
    fn modules(&mut self, fixed: &[(Loc<String>, Loc<String>)]) {
        for (name, _) in fixed {
            if !is_identifier(&name.value) {
                self.error(name.at, format!("'{}' cannot be a module's name", name.value));
            }
            if self.graph.params.index(&name.value).is_some() {
                let message =
                    format!("module '{}' is a parameter, which an option is chosen for: remove one", name.value);
                self.error(name.at, message);
            }
        }
        // Of a choice, each option's file is looked for when it is set: a capture holds no other.
        for (_, file) in fixed {
            if crate::shader::find(&self.folders.shaders, &file.value).is_none() {
                let found = self.graph.sources.error(file.at, format!("no shader file '{}'", file.value));
                let folder = Path::new(&file.value).parent().unwrap_or(Path::new(""));
                let known = files_of(&self.folders.shaders.join(folder));
                let known: Vec<String> = known.iter().map(|f| folder.join(f).to_string_lossy().into_owned()).collect();
                self.errors.push(found.nearest(&file.value, known.iter().map(String::as_str)));
            }
        }
    }

    fn named_values(&mut self) {
        for named in &self.graph.values {
            self.expr(&named.expr);
            // A value is the same in all of a frame.
            for name in named.expr.value.variables().iter().filter(|v| ["index", "mip"].contains(&v.as_str())) {
                let message = format!("value '{}' reads '{name}', which differs within a frame", named.name);
                self.error(named.expr.at, message);
            }
        }
    }

    fn expr(&mut self, ex: &Ex) {
        if let Some(mistake) = ex.value.mistake() {
            self.error(ex.at, format!("'{}' is no expression: {mistake}", ex.value.text));
        }
        for name in unknown(&ex.value, &self.variables) {
            if !self.is_unknown(&name) {
                continue;
            }
            let found = self.graph.sources.error(ex.at, format!("unknown variable '{name}' in '{}'", ex.value.text));
            self.errors.push(found.nearest(&name, self.variables.iter().map(String::as_str)));
        }
        // A choice that could not be read may have had the option.
        for (message, help) in super::choices::misuses(&ex.value, &self.graph.params) {
            if self.whole && !ex.value.variables().iter().any(|v| self.broken.contains(v)) {
                self.errors.push(self.graph.sources.error(ex.at, message).help(help));
            }
        }
    }

    fn exprs<'a>(&mut self, list: impl IntoIterator<Item = &'a Ex>) {
        for ex in list {
            self.expr(ex);
        }
    }

    fn texture_name(&mut self, name: &Loc<String>) -> bool {
        self.resource(
            name,
            "texture",
            |g, n| g.textures.iter().any(|t| t.0 == n),
            |g| g.textures.iter().map(|t| t.0.as_str()).collect(),
        )
    }

    fn buffer_name(&mut self, name: &Loc<String>) -> bool {
        self.resource(
            name,
            "buffer",
            |g, n| g.buffers.iter().any(|t| t.0 == n),
            |g| g.buffers.iter().map(|t| t.0.as_str()).collect(),
        )
    }

    fn resource(
        &mut self,
        name: &Loc<String>,
        what: &str,
        exists: impl Fn(&Graph, &str) -> bool,
        known: impl Fn(&Graph) -> Vec<&str>,
    ) -> bool {
        if exists(self.graph, &name.value) {
            return true;
        }
        if self.graph.alias(&name.value).is_some() {
            let message = format!("'{}' is an alias or sampler, which passes bind: name a {what}", name.value);
            self.error(name.at, message);
            return false;
        }
        if !self.is_unknown(&name.value) {
            return false;
        }
        let found = self.graph.sources.error(name.at, format!("no {what} is named '{}'", name.value));
        self.errors.push(found.nearest(&name.value, known(self.graph)));
        false
    }

    fn pointer(&mut self, name: &Loc<String>) {
        let params = &self.graph.params.list;
        match params.iter().find(|p| p.name == name.value) {
            Some(param) if param.kind == Kind::Vector(2) => {}
            Some(param) => {
                let message =
                    format!("'{}' holds {} and cannot be the pointer: it must be a Vec2", name.value, param.expected());
                self.error(name.at, message);
            }
            None if !self.is_unknown(&name.value) => {}
            None => {
                let known: Vec<&str> =
                    params.iter().filter(|p| p.kind == Kind::Vector(2)).map(|p| p.name.as_str()).collect();
                let found = self.graph.sources.error(name.at, format!("no Vec2 parameter is named '{}'", name.value));
                self.errors.push(if known.is_empty() {
                    found.help(Some(format!("declare it: Vec2(name: \"{}\", default: (-1, -1), ...)", name.value)))
                } else {
                    found.nearest(&name.value, known)
                });
            }
        }
    }

    fn voxels(&mut self, voxels: &VoxelsDecl) {
        for name in [&voxels.occupied, &voxels.color, &voxels.normal] {
            let known = self.texture_name(name);
            let texture = self.graph.textures.iter().find(|t| t.0 == name.value);
            if known && texture.is_some_and(|t| t.1.value.size.0.len() != 3) {
                self.error(name.at, format!("'{}' is 2D: voxels are in 3D textures", name.value));
            }
        }
        self.buffer_name(&voxels.borders);
        for mode in &voxels.modes.0 {
            self.values(mode.value.set.0.iter());
        }
    }

    fn check(&mut self, check: &CheckDecl, at: At) {
        match (&check.field, &check.buffer, check.word) {
            (Some(field), None, None) => self.member(field),
            (None, Some(buffer), Some(_)) => drop(self.buffer_name(buffer)),
            _ => self.error(at, String::from("a check needs either field, or buffer and word")),
        }
    }

    /// The buffer of a path, and that a member is named.
    fn member(&mut self, path: &Loc<super::file::Path>) {
        let known = self.buffer_name(&Loc { value: path.value.buffer.clone(), at: path.at });
        if known && path.value.member.is_empty() {
            self.error(path.at, format!("name a member of '{0}': \"{0}.member\"", path.value.buffer));
        }
    }

    fn tables(&mut self, tables: &[Loc<TableDecl>]) {
        for (i, table) in tables.iter().enumerate() {
            if let Some(name) = &table.value.buffer {
                self.buffer_name(name);
            }
            for path in table.value.paths() {
                self.member(path);
            }
            if tables[..i].iter().any(|t| t.value.title == table.value.title) {
                self.error(table.at, format!("two tables have the title '{}'", table.value.title));
            }
            for (at, message) in table.value.mistakes(table.at) {
                self.error(at, message);
            }
        }
    }

    fn textures(&mut self) {
        for (name, texture) in &self.graph.textures {
            let t = &texture.value;
            if t.size.0.len() == 3 && t.layers.is_some() {
                self.error(texture.at, format!("'{name}' is 3D and cannot have layers"));
            }
            self.exprs(t.size.0.iter().chain(&t.mips).chain(&t.layers));
            self.format(&t.format, true);
            for view in &t.views.0 {
                self.format(view, false);
                let sizes = [&t.format, view].map(|f| Format::named(&f.value).map(|f| f.bytes));
                if let [Some(a), Some(b)] = sizes
                    && a != b
                {
                    let message =
                        format!("'{name}' has texels of {a} bytes and cannot be viewed as '{}' of {b}", view.value);
                    self.error(view.at, message);
                }
            }
        }
        for (_, buffer) in &self.graph.buffers {
            self.exprs(buffer.value.size.value.expression());
        }
    }

    fn aliases(&mut self) {
        for alias in &self.graph.aliases {
            for case in &alias.cases {
                self.exprs(&case.when);
                match self.graph.alias(&case.bind.of.value) {
                    Some(_) => {
                        let message =
                            format!("'{}' is an alias or sampler itself: name a texture or buffer", case.bind.of.value);
                        self.error(case.bind.of.at, message);
                    }
                    None => self.bind(&case.bind),
                }
            }
        }
    }

    fn format(&mut self, name: &Loc<String>, or_choice: bool) {
        if Format::named(&name.value).is_some() || self.broken.contains(&name.value) {
            return;
        }
        let choice = self.graph.params.list.iter().find(|p| p.name == name.value).map(|p| &p.kind);
        if let (true, Some(Kind::Choice(options))) = (or_choice, choice) {
            for option in options {
                if Format::named(option).is_none() {
                    self.error(name.at, format!("option '{option}' of '{}' is no format", name.value));
                }
            }
            return;
        }
        if !self.whole {
            return;
        }
        let choices = self.graph.params.list.iter().filter(|p| or_choice && matches!(p.kind, Kind::Choice(_)));
        let mut known: Vec<&str> = Format::names().collect();
        known.extend(choices.map(|p| p.name.as_str()));
        let found = self.graph.sources.error(name.at, format!("no format is named '{}'", name.value));
        self.errors.push(found.nearest(&name.value, known));
    }

    fn pass(&mut self, pass: &PassDecl, at: At) {
        let name = &pass.name.value;
        let kinds = [pass.dispatch.is_some(), pass.draw.is_some(), pass.clear.is_some(), pass.copy.is_some()];
        match kinds.iter().filter(|k| **k).count() {
            0 => self.error(at, format!("pass '{name}' does nothing: give it dispatch, draw, clear or copy")),
            1 => {}
            _ => self.error(
                at,
                format!("pass '{name}' does several things: dispatch, draw, clear and copy exclude each other"),
            ),
        }
        self.exprs(pass.conditions().chain(&pass.repeat).chain(&pass.mip));
        if pass.repeat.is_some() && pass.each_mip.is_some() {
            self.error(at, format!("pass '{name}' has both repeat and each_mip"));
        }
        if let Some(each) = &pass.each_mip {
            self.texture_name(&each.value.texture);
        }
        self.stages(pass, at);
        match pass.dispatch.as_ref().map(|d| &d.value) {
            Some(Dispatch::Cover(target)) if pass.bind.0.iter().any(|(key, _)| key.value == target.value) => {}
            Some(Dispatch::Cover(target)) if self.graph.alias(&target.value).is_some() => {}
            Some(Dispatch::Cover(target)) => drop(self.texture_name(target)),
            Some(Dispatch::Threads(x, y, z) | Dispatch::Groups(x, y, z)) => self.exprs([x, y, z]),
            Some(Dispatch::Indirect(command)) => self.indirect(command),
            None => {}
        }
        match pass.draw.as_ref().map(|d| &d.value) {
            Some(Draw::Vertices(n)) => self.expr(n),
            Some(Draw::Indirect(command)) => self.indirect(command),
            _ => {}
        }
        for (_, bind) in &pass.bind.0 {
            match self.graph.alias(&bind.value.of.value) {
                Some(alias) => alias.cases.iter().for_each(|case| self.bind(&narrowed(&case.bind, &bind.value))),
                None => self.bind(&bind.value),
            }
        }
        self.attachments(pass, at);
        if let Some(target) = &pass.clear {
            let buffer = self.graph.buffers.iter().any(|b| b.0 == target.value);
            if !buffer && self.texture_name(target) && self.is_depth(&target.value) {
                let message = format!(
                    "'{}' is a depth texture: clear it where it is attached, depth: (clear: 1.0)",
                    target.value
                );
                self.error(target.at, message);
            }
        }
        if let Some(copy) = &pass.copy {
            self.copy(&copy.value);
        }
    }

    fn is_depth(&self, texture: &str) -> bool {
        let found = self.graph.textures.iter().find(|t| t.0 == texture);
        found.and_then(|t| Format::named(&t.1.value.format.value)).is_some_and(|f| f.is_depth())
    }

    fn copy(&mut self, copy: &super::file::CopyDecl) {
        if copy.from.value == copy.to.value {
            self.error(copy.to.at, format!("'{}' is copied to itself", copy.to.value));
        }
        let is_buffer = |n: &str| self.graph.buffers.iter().any(|b| b.0 == n);
        match (is_buffer(&copy.from.value), is_buffer(&copy.to.value)) {
            (true, true) => {}
            (true, false) => drop(self.buffer_name(&copy.to)),
            (false, true) => drop(self.buffer_name(&copy.from)),
            (false, false) => {
                self.texture_name(&copy.from);
                self.texture_name(&copy.to);
            }
        }
    }

    fn stages(&mut self, pass: &PassDecl, at: At) {
        let name = &pass.name.value;
        let mut stages = Vec::new();
        for shader in &pass.shaders.0 {
            let Some(stage) = Stage::of_file(&shader.value) else {
                self.error(
                    shader.at,
                    format!("'{}' is no shader: expected .vert, .tesc, .tese, .geom, .frag or .comp", shader.value),
                );
                continue;
            };
            if stages.contains(&stage) {
                self.error(shader.at, format!("pass '{name}' has two {stage:?} shaders"));
            }
            stages.push(stage);
            let path = self.folders.shaders.join(&shader.value);
            // The compiler's own words for this are pages of built-in functions.
            if std::fs::read_to_string(&path).is_ok_and(|text| !text.contains("#version")) {
                self.error(
                    shader.at,
                    format!("shader '{}' has no line `#version 460`, which must be its first", shader.value),
                );
            }
            if !path.is_file() {
                let known = files_of(&self.folders.shaders);
                let found = self.graph.sources.error(shader.at, format!("no shader file '{}'", shader.value));
                self.errors.push(found.nearest(&shader.value, known.iter().map(String::as_str)));
            }
        }
        if pass.dispatch.is_some() && stages != [Stage::Compute] {
            self.error(at, format!("pass '{name}' dispatches: it needs one .comp shader and no other"));
        }
        if pass.draw.is_some() && (!stages.contains(&Stage::Vertex) || stages.contains(&Stage::Compute)) {
            self.error(at, format!("pass '{name}' draws: it needs a .vert shader and no .comp"));
        }
        let tessellated = stages.contains(&Stage::TessControl) && stages.contains(&Stage::TessEvaluation);
        if pass.draw.is_some() && (pass.topology == super::file::Topology::Patches) != tessellated {
            self.error(
                at,
                format!("pass '{name}': patches need both a .tesc and a .tese shader, and they need patches"),
            );
        }
        if (pass.clear.is_some() || pass.copy.is_some()) && !pass.shaders.0.is_empty() {
            self.error(at, format!("pass '{name}' clears or copies: it takes no shaders"));
        }
    }

    fn indirect(&mut self, command: &Command) {
        let (path, at) = (&command.path.value, command.path.at);
        if self.buffer_name(&Loc { value: path.buffer.clone(), at }) {
            let declared = self.graph.buffers.iter().any(|(n, b)| *n == path.buffer && b.value.indirect);
            if !declared {
                self.error(at, format!("buffer '{}' is not declared with `indirect: true`", path.buffer));
            }
            if path.member.is_empty() == command.offset.is_none() {
                let message = format!("say where: Indirect(\"{0}.member\"), or Indirect(\"{0}\", byte)", path.buffer);
                self.error(at, message);
            }
        }
    }

    fn bind(&mut self, bind: &super::file::Bind) {
        let buffer = self.graph.buffers.iter().any(|b| b.0 == bind.of.value);
        if buffer {
            if bind.mip.is_some()
                || bind.layer.is_some()
                || bind.format.is_some()
                || bind.history
                || bind.sampler.is_some()
            {
                self.error(
                    bind.of.at,
                    format!("'{}' is a buffer: it has no mip, layer, format, history or sampler", bind.of.value),
                );
            }
            return;
        }
        if !self.texture_name(&bind.of) {
            return;
        }
        self.exprs(bind.mip.iter().chain(&bind.layer));
        let Some((_, texture)) = self.graph.textures.iter().find(|t| t.0 == bind.of.value) else { return };
        if bind.history && !texture.value.history {
            self.error(bind.of.at, format!("'{}' is not declared with `history: true`", bind.of.value));
        }
        if let Some(format) = &bind.format {
            let known: Vec<&str> = texture.value.views.0.iter().map(|v| v.value.as_str()).collect();
            if !known.contains(&format.value.as_str()) && texture.value.format.value != format.value {
                let found = self.graph.sources.error(
                    format.at,
                    format!("'{}' is not declared to be viewed as '{}'", bind.of.value, format.value),
                );
                self.errors.push(found.help(Some(format!("declare it: views: [\"{}\"]", format.value))));
            }
        }
    }

    fn attachments(&mut self, pass: &PassDecl, at: At) {
        let name = &pass.name.value;
        // A choice of formats is of its first one's kind; an unknown format was told where it stands.
        let depth_format = |g: &Graph, n: &str| {
            let name = &g.textures.iter().find(|t| t.0 == n)?.1.value.format.value;
            let choice = g.params.list.iter().find(|p| p.name == *name);
            let first = match choice.map(|p| &p.kind) {
                Some(Kind::Choice(options)) => options.first()?,
                _ => name,
            };
            Format::named(first).map(|f| f.is_depth())
        };
        let volume = |g: &Graph, n: &str| g.textures.iter().any(|t| t.0 == n && t.1.value.size.0.len() == 3);
        for target in &pass.color.0 {
            let t = &target.value;
            self.exprs(t.mip.iter().chain(&t.layer));
            if self.texture_name(&t.to) && depth_format(self.graph, &t.to.value) == Some(true) {
                self.error(t.to.at, format!("'{}' is a depth texture and cannot be a colour attachment", t.to.value));
            }
            if volume(self.graph, &t.to.value) {
                self.error(
                    t.to.at,
                    format!("'{}' is 3D and cannot be an attachment; write to it as an image", t.to.value),
                );
            }
        }
        if let Some(depth) = &pass.depth {
            let t = &depth.value;
            self.exprs(t.layer.iter());
            if self.texture_name(&t.to) && depth_format(self.graph, &t.to.value) == Some(false) {
                self.error(t.to.at, format!("'{}' is no depth texture (d32 or d16)", t.to.value));
            }
        }
        let any = !pass.color.0.is_empty() || pass.depth.is_some();
        if any && pass.draw.is_none() {
            self.error(at, format!("pass '{name}' has attachments but draws nothing"));
        }
        let raster = &pass.raster;
        if let Some(size) = &raster.size {
            self.exprs([&size.value.0, &size.value.1]);
            if any {
                self.error(size.at, format!("pass '{name}' has attachments: its size is theirs"));
            }
        } else if pass.draw.is_some() && !any && !raster.discard {
            self.error(at, format!("pass '{name}' draws without attachments: give raster: (size: (\"w\", \"h\"))"));
        }
        self.exprs(raster.samples.iter());
        if raster.samples.is_some() && any {
            self.error(at, format!("pass '{name}': samples are for drawing without attachments"));
        }
    }
}

fn unknown(expr: &Expr, variables: &HashSet<String>) -> Vec<String> {
    expr.variables().iter().filter(|v| !variables.contains(*v)).cloned().collect()
}

fn files_of(folder: &Path) -> Vec<String> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    entries.flatten().filter(|e| e.path().is_file()).map(|e| e.file_name().to_string_lossy().into_owned()).collect()
}
