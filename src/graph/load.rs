//! Reading a graph with its includes.

use super::alias::Alias;
use super::check::Check;
use super::file::{
    BufferDecl, CheckDecl, CompareDecl, GraphFile, PassDecl, RefuseDecl, SceneNeeds, TextureDecl, ViewDecl, VoxelsDecl,
    ungrouped,
};
use super::param::{OFF, Param, Params};
use super::table::TableDecl;
use super::value::{Named, ordered};
use crate::diagnostics::excerpt::chain;
use crate::diagnostics::{At, Diagnostic, Loc, Place, RawText, Severity, Sources};
use std::collections::HashSet;
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
    /// Parameters that the panel shows first: name, title. One that is retired is shown with what to write instead.
    pub pinned: Vec<(String, String)>,
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
    /// Settings that make no sense together.
    pub refuse: Vec<RefuseDecl>,
    /// What a picture is said to be made with; see [`Graph::caption`].
    caption: Option<Loc<String>>,
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

impl Graph {
    /// What a picture is said to be made with, with these values of the parameters.
    pub fn caption(&self, params: &Params) -> Option<String> {
        let mut text = self.caption.as_ref()?.value.clone();
        for (param, value) in params.list.iter().zip(&params.values) {
            text = text.replace(&format!("{{{}}}", param.name), &value.to_string());
        }
        Some(text)
    }

    /// Buffers of the checks that are made where these resources are wanted.
    pub fn checked_with(&self, wanted: &[String]) -> Vec<String> {
        let made = |c: &&CheckDecl| c.with.as_ref().is_none_or(|texture| wanted.contains(&texture.value));
        self.checks.iter().filter(made).map(|c| c.buffer().to_string()).collect()
    }
}

/// Variables that every expression may use beside parameters.
pub const BUILTIN_VARIABLES: &[&str] = &[
    "width",
    "height",
    "mip",
    "index",
    "shadow_views",
    "directional_views",
    "light_count",
    "triangle_count",
    "emitting_triangle_count",
    "scene_size",
    "seen_distance",
    "int64_atomics",
    "software_device",
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
        pinned: Vec::new(),
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
        refuse: Vec::new(),
        caption: None,
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
    let mut pinned: Vec<(Loc<String>, Loc<String>)> = Vec::new();
    for file in files {
        // A parameter takes the place of the module that an included file has set once and for all.
        modules.retain(|(name, _)| !file.params.0.iter().any(|p| p.value.name().value == name.value));
        for (name, path) in file.modules.0 {
            modules.retain(|(other, _)| other.value != name.value);
            modules.push((name, path));
        }
        defaults.extend(file.defaults.0);
        for (name, title) in file.pinned.0 {
            match pinned.iter_mut().find(|p| p.0.value == name.value) {
                Some(known) => known.1 = title,
                None => pinned.push((name, title)),
            }
        }
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
        graph.refuse.extend(file.refuse.0.into_iter().map(|r| r.value));
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
        graph.caption = file.caption.or(graph.caption);
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
    let passes = graph.passes.iter().map(|p| p.value.name.value.clone()).collect();
    graph.params = Params { retired, passes, ..Params::new(list) };
    graph.values = ordered(values, &graph.params, &graph.sources, &mut errors, &mut broken);
    let mut check = Check { graph: &graph, folders, errors, broken, whole, variables: HashSet::new() };
    check.names();
    check.pinned(&pinned);
    check.exprs(graph.params.list.iter().flat_map(|p| p.when.iter().chain(&p.effective)));
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
    check.exprs(graph.refuse.iter().map(|r| &r.when));
    if let Some(name) = &pointer {
        check.pointer(name);
    }
    if let Some(caption) = &graph.caption {
        check.caption(caption);
    }
    check.tables(&tables);
    if let Some(needs) = &graph.scene {
        check.expr(&needs.value.max_edge);
        check.exprs(needs.value.when.as_ref());
    }
    let mut errors = check.errors;
    graph.pinned = pinned.into_iter().map(|(name, title)| (name.value, title.value)).collect();
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

/// Files that a graph may have.
const MAX_FILES: usize = 256;
/// How deep includes may be nested.
const MAX_DEPTH: usize = 32;

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
        let name = |p: &Path| p.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let circle: Vec<String> = stack.iter().skip_while(|p| *p != path).map(|p| name(p)).collect();
        let message = format!("'{}' includes itself: {} > {}", path.display(), circle.join(" > "), name(path));
        errors.push(from.map_or(Diagnostic::error(Place::default(), message.clone()), |at| sources.error(at, message)));
        return true;
    }
    if stack.len() >= MAX_DEPTH || sources.paths().count() >= MAX_FILES {
        let names: Vec<String> = stack.iter().map(|p| p.display().to_string()).collect();
        let message = format!("a graph has at most {MAX_FILES} files, {MAX_DEPTH} deep: {}", chain(&names));
        errors.push(from.map_or(Diagnostic::error(Place::default(), message.clone()), |at| sources.error(at, message)));
        return false;
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
        if name.value == OFF {
            errors.push(
                sources.error(name.at, format!("'{OFF}' is what passes are left out by: no parameter has that name")),
            );
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
