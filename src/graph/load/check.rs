//! Checks of a graph that need no shader: names, values, expressions, sizes and formats.

use super::findings::Findings;
use super::include::Folders;
use super::params::is_identifier;
use crate::diagnostics::{At, Entries, Items, Loc, RawText, nearest};
use crate::graph::debug::DEBUG_BUFFER;
use crate::graph::definition::Graph;
use crate::graph::expr::Ex;
use crate::graph::file::{CheckDecl, CompareDecl, Path, TableDecl, ToolDecl};
use crate::graph::param::Kind;
use crate::vulkan::Format;
use std::collections::HashSet;

/// Names in a file of a graph with their places, for messages.
pub(super) struct Names {
    pub pinned: Entries<String>,
    pub modules: Entries<String>,
    pub fit: Entries<Items<RawText>>,
    pub pointer: Option<Loc<String>>,
    pub slice: Option<Loc<String>>,
    pub view_mips: Entries<String>,
}

/// The checks of a graph that was read, and the mistakes that they find.
pub(super) struct Check<'g> {
    pub(super) graph: &'g Graph,
    pub(super) folders: &'g Folders,
    pub(super) found: Findings,
    variables: HashSet<String>,
}

impl<'g> Check<'g> {
    pub(super) fn new(graph: &'g Graph, folders: &'g Folders, found: Findings) -> Check<'g> {
        let mut variables: HashSet<String> =
            graph.interface.all_variables().map(String::from).collect();
        variables.extend(graph.params.list.iter().flat_map(|p| p.variables()));
        variables.extend(graph.params.option_names().map(String::from));
        // Signatures are known only to shaders: which settings count follows from what these read.
        variables.extend(
            graph
                .values
                .iter()
                .filter(|v| v.signs.is_none())
                .map(|v| v.name.clone()),
        );
        Check {
            graph,
            folders,
            found,
            variables,
        }
    }

    /// The stages that choices are measured by.
    fn measured_stages(&mut self) {
        let stages = || self.graph.passes.iter().map(|p| p.value.stage());
        for param in &self.graph.params.list {
            for stage in param.fastest.iter().flat_map(|f| &f.stages) {
                if !stages().any(|s| s == stage) {
                    let message = format!("choice '{}': no stage '{stage}' to measure", param.name);
                    self.found.unknown(param.at, stage, message, stages());
                }
            }
        }
    }

    /// Checks everything. `results` are names of textures.
    pub(super) fn all(&mut self, names: &Names, results: &[Loc<String>]) {
        let graph = self.graph;
        self.names();
        self.pinned(&names.pinned);
        let params = graph.params.list.iter();
        self.exprs(params.flat_map(|p| p.when.iter().chain(&p.effective)));
        self.measured_stages();
        self.modules(&names.modules);
        self.named_values();
        self.textures();
        self.aliases();
        for pass in &graph.passes {
            self.pass(&pass.value, pass.at);
        }
        for name in results {
            self.texture_name(name);
        }
        for compare in &graph.compare {
            self.side(&compare.value.a);
            self.side(&compare.value.b);
        }
        for (name, list) in &names.fit.0 {
            list.value.0.iter().for_each(|v| self.setting(name, v));
        }
        for view in graph.views.iter().chain(&graph.ablation) {
            self.settings(&view.value.set);
        }
        for (_, tool) in &graph.tools {
            self.tool(&tool.value);
        }
        for item in &graph.checks {
            self.check(&item.value);
        }
        self.exprs(graph.refuse.iter().map(|r| &r.when));
        for (name, what) in [(&names.pointer, "pointer"), (&names.slice, "slice")] {
            let Some(name) = name else { continue };
            self.cursor(name, what);
        }
        for (texture, param) in &names.view_mips.0 {
            self.texture_name(texture);
            self.view_mip(param);
        }
        if let Some(caption) = &graph.caption {
            self.caption(caption);
        }
        self.tables(&graph.tables);
        self.exprs(graph.scene_expressions());
    }

    /// Names and values of parameters.
    pub(super) fn settings(&mut self, list: &Entries<RawText>) {
        list.0
            .iter()
            .for_each(|(name, text)| self.setting(name, text));
    }

    /// A side of a comparison: parameters of this graph. Another graph may be missing, as in
    /// captures.
    pub(super) fn side(&mut self, list: &Entries<RawText>) {
        if CompareDecl::graph(list).is_none() {
            self.settings(list);
        }
    }

    pub(super) fn setting(&mut self, name: &Loc<String>, text: &Loc<RawText>) {
        let mut params = self.graph.params.clone();
        let missing = self.found.partial && params.index(&name.value).is_none();
        if !missing
            && !self.found.broken.contains(&name.value)
            && let Err(message) = params.set(&name.value, &text.value.0)
        {
            self.error(name.at, message);
        }
    }

    pub(super) fn error(&mut self, at: At, message: String) {
        self.found.error(at, message);
    }

    pub(super) fn names(&mut self) {
        let graph = self.graph;
        let mut seen: HashSet<&str> = HashSet::new();
        let resources = graph
            .textures
            .iter()
            .map(|(n, t)| (n, t.at))
            .chain(graph.buffers.iter().map(|(n, b)| (n, b.at)));
        for (name, at) in resources.chain(graph.aliases.iter().map(|a| (&a.name, a.at))) {
            if !name.starts_with(|c: char| c.is_ascii_alphabetic())
                || !name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
            {
                self.error(
                    at,
                    format!(
                        "'{name}' cannot be a resource's name: letters, digits and underscores only"
                    ),
                );
            }
            if graph.interface.index(name).is_some() {
                self.error(
                    at,
                    format!("'{name}' is a resource that every scene offers; choose another name"),
                );
            }
            if !seen.insert(name) {
                self.error(at, format!("resource '{name}' is declared twice"));
            }
        }
        let mut passes: HashSet<&str> = HashSet::new();
        for name in graph.passes.iter().map(|p| &p.value.name) {
            if !passes.insert(&name.value) {
                let message = format!(
                    "two passes are named '{}'; timings could not tell them apart",
                    name.value
                );
                self.error(name.at, message);
            }
        }
    }

    /// Names and files of modules, chosen or not.
    pub(super) fn modules(&mut self, fixed: &Entries<String>) {
        for (name, _) in &fixed.0 {
            if !is_identifier(&name.value) {
                self.error(
                    name.at,
                    format!("'{}' cannot be a module's name", name.value),
                );
            }
            if self.graph.params.index(&name.value).is_some() {
                let message = format!(
                    "module '{}' is a parameter, which an option is chosen for: remove one",
                    name.value
                );
                self.error(name.at, message);
            }
        }
        // The file of a choice's option is looked up when it is set: captures hold no other.
        for (_, file) in &fixed.0 {
            if crate::shader::find(&self.folders.shaders, &file.value).is_none() {
                let folder = std::path::Path::new(&file.value)
                    .parent()
                    .unwrap_or("".as_ref());
                let known = files_of(&self.folders.shaders.join(folder));
                let known: Vec<String> = known
                    .iter()
                    .map(|f| folder.join(f).to_string_lossy().into_owned())
                    .collect();
                let help = nearest(&file.value, known.iter().map(String::as_str));
                self.found
                    .help(file.at, format!("no shader file '{}'", file.value), help);
            }
        }
    }

    pub(super) fn named_values(&mut self) {
        for named in &self.graph.values {
            self.expr(&named.expr);
            if let Some(stage) = &named.signs {
                let stages = || self.graph.passes.iter().map(|p| p.value.stage());
                if !stages().any(|s| s == stage) {
                    let message = format!(
                        "value '{}': no pass belongs to a stage '{stage}'",
                        named.name
                    );
                    self.found.unknown(named.expr.at, stage, message, stages());
                }
            }
            // A value is the same in all of a frame.
            for name in named
                .expr
                .value
                .variables()
                .iter()
                .filter(|v| ["index", "mip"].contains(&v.as_str()))
            {
                let message = format!(
                    "value '{}' reads '{name}', which differs within a frame",
                    named.name
                );
                self.error(named.expr.at, message);
            }
        }
    }

    pub(super) fn expr(&mut self, ex: &Ex) {
        let text = &ex.value.text;
        if let Some(mistake) = ex.value.mistake() {
            self.error(ex.at, format!("'{text}' is no expression: {mistake}"));
        }
        for name in ex
            .value
            .variables()
            .iter()
            .filter(|v| !self.variables.contains(*v))
        {
            let known = self.variables.iter().map(String::as_str);
            let why = match self.graph.values.iter().any(|v| v.name == *name) {
                true => format!("'{text}': '{name}' is a signature, which only shaders can read"),
                false => format!("unknown variable '{name}' in '{text}'"),
            };
            self.found.unknown(ex.at, name, why, known);
        }
        // A choice that could not be read may have had the option.
        for (message, help) in super::choices::misuses(&ex.value, &self.graph.params) {
            if ex
                .value
                .variables()
                .iter()
                .all(|v| self.found.is_unknown(v))
            {
                self.found.help(ex.at, message, help);
            }
        }
    }

    pub(super) fn exprs<'a>(&mut self, list: impl IntoIterator<Item = &'a Ex>) {
        list.into_iter().for_each(|ex| self.expr(ex));
    }

    pub(super) fn texture_name(&mut self, name: &Loc<String>) -> bool {
        let graph = self.graph;
        graph.texture(&name.value).is_some()
            || self.missing(name, "texture", graph.textures.iter().map(|t| t.0.as_str()))
    }

    pub(super) fn buffer_name(&mut self, name: &Loc<String>) -> bool {
        let graph = self.graph;
        graph.buffer(&name.value).is_some() || {
            // The buffer that no file declares is no suggestion.
            let names = graph.buffers.iter().map(|b| b.0.as_str());
            self.missing(name, "buffer", names.filter(|name| *name != DEBUG_BUFFER))
        }
    }

    /// Reports a name that stands for nothing of a kind; false.
    fn missing<'n>(
        &mut self,
        name: &Loc<String>,
        what: &str,
        known: impl Iterator<Item = &'n str>,
    ) -> bool {
        if self.graph.alias(&name.value).is_some() {
            let message = format!(
                "'{}' is an alias or sampler, which passes bind: name a {what}",
                name.value
            );
            self.error(name.at, message);
        } else {
            let message = format!("no {what} is named '{}'", name.value);
            self.found.unknown(name.at, &name.value, message, known);
        }
        false
    }

    /// Checks a parameter that selects the mip of a view.
    fn view_mip(&mut self, name: &Loc<String>) {
        let list = self.graph.params.list.iter();
        let integers = list.filter(|p| p.kind == Kind::Int);
        let known: Vec<&str> = integers.map(|p| p.name.as_str()).collect();
        if !known.contains(&name.value.as_str()) {
            let message = format!("no Int parameter is named '{}'", name.value);
            self.found.unknown(name.at, &name.value, message, known);
        }
    }

    /// Checks a parameter that the window sets.
    fn cursor(&mut self, name: &Loc<String>, what: &str) {
        let params = &self.graph.params;
        match params.param(&name.value) {
            Some(param) if param.kind == Kind::Vector(2) => {}
            Some(param) => {
                let message = format!(
                    "'{}' holds {} and cannot be the {what}: it must be a Vec2",
                    name.value,
                    param.expected(),
                );
                self.error(name.at, message);
            }
            None if !self.found.is_unknown(&name.value) => {}
            None => {
                let known = params
                    .list
                    .iter()
                    .filter(|p| p.kind == Kind::Vector(2))
                    .map(|p| p.name.as_str());
                let help = match known.clone().next() {
                    None => Some(format!(
                        "declare it: Vec2(name: \"{}\", default: (-1, -1), ...)",
                        name.value
                    )),
                    Some(_) => nearest(&name.value, known),
                };
                self.found.help(
                    name.at,
                    format!("no Vec2 parameter is named '{}'", name.value),
                    help,
                );
            }
        }
    }

    /// Names in braces are parameters.
    pub(super) fn caption(&mut self, caption: &Loc<String>) {
        let params = &self.graph.params;
        for part in caption.value.split('{').skip(1) {
            let name = part.split('}').next().unwrap_or_default();
            if params.param(name).is_none() {
                self.found.unknown(
                    caption.at,
                    name,
                    format!("no parameter is named '{name}'"),
                    params.names(),
                );
            }
        }
    }

    /// Names of pinned parameters: those of another graph too, where the graph says which.
    pub(super) fn pinned(&mut self, list: &Entries<String>) {
        let params = &self.graph.params;
        for (name, title) in &list.0 {
            let elsewhere = params
                .retired
                .iter()
                .any(|(retired, _)| *retired == name.value);
            if params.index(&name.value).is_none() && !elsewhere {
                let message = format!("no parameter '{}' to pin", name.value);
                self.found
                    .unknown(name.at, &name.value, message, params.names());
            }
            if title.value.trim().is_empty() || title.value.contains('\n') {
                self.error(
                    title.at,
                    format!("'{}' is pinned without a title of one line", name.value),
                );
            }
        }
    }

    pub(super) fn tool(&mut self, tool: &ToolDecl) {
        let graph = self.graph;
        for (_, name) in &tool.resources.0 {
            if graph.resource(&name.value).is_none() {
                self.missing(name, "texture or buffer", graph.resource_names());
            }
        }
        tool.settings
            .0
            .iter()
            .for_each(|view| self.settings(&view.value.set));
    }

    pub(super) fn check(&mut self, check: &CheckDecl) {
        self.member(&check.field);
        if let Some(texture) = &check.with {
            self.texture_name(texture);
        }
    }

    /// The buffer of a path, and that a member is named.
    pub(super) fn member(&mut self, path: &Loc<Path>) {
        let known = self.buffer_name(&Loc {
            value: path.value.buffer.clone(),
            at: path.at,
        });
        if known && path.value.member.is_empty() {
            self.error(
                path.at,
                format!("name a member of '{0}': \"{0}.member\"", path.value.buffer),
            );
        }
    }

    pub(super) fn tables(&mut self, tables: &[Loc<TableDecl>]) {
        for (i, table) in tables.iter().enumerate() {
            self.member(&table.value.list);
            if tables[..i]
                .iter()
                .any(|t| t.value.title == table.value.title)
            {
                self.error(
                    table.at,
                    format!("two tables have the title '{}'", table.value.title),
                );
            }
            for (at, message) in table.value.mistakes(table.at) {
                self.error(at, message);
            }
        }
    }

    pub(super) fn textures(&mut self) {
        for (name, texture) in &self.graph.textures {
            let t = &texture.value;
            if t.is_volume() && t.layers.is_some() {
                self.error(texture.at, format!("'{name}' is 3D and cannot have layers"));
            }
            if t.transient && t.mips.is_some() {
                self.error(
                    texture.at,
                    format!("'{name}' is transient and cannot have mips"),
                );
            }
            self.kept_or_not(name, t.history, t.transient, texture.at);
            self.exprs(t.expressions());
            self.format(&t.format, true);
            for view in &t.views.0 {
                self.format(view, false);
                let sizes = [&t.format, view].map(|f| Format::named(&f.value).map(|f| f.bytes));
                if let [Some(a), Some(b)] = sizes
                    && a != b
                {
                    let message = format!(
                        "'{name}' has texels of {a} bytes and cannot be viewed as '{}' of {b}",
                        view.value
                    );
                    self.error(view.at, message);
                }
            }
        }
        for (name, buffer) in &self.graph.buffers {
            self.kept_or_not(
                name,
                buffer.value.history,
                buffer.value.transient,
                buffer.at,
            );
            self.exprs(buffer.value.size.value.expression());
        }
    }

    fn kept_or_not(&mut self, name: &str, history: bool, transient: bool, at: At) {
        if history && transient {
            self.error(
                at,
                format!("'{name}' has a history and is transient: one or the other"),
            );
        }
    }

    pub(super) fn aliases(&mut self) {
        for alias in &self.graph.aliases {
            for case in &alias.cases {
                self.exprs(&case.when);
                match self.graph.alias(&case.bind.of.value) {
                    Some(_) => {
                        let message = format!(
                            "'{}' is an alias or sampler itself: name a texture or buffer",
                            case.bind.of.value
                        );
                        self.error(case.bind.of.at, message);
                    }
                    None => self.bind(&case.bind),
                }
            }
        }
    }

    pub(super) fn format(&mut self, name: &Loc<String>, or_choice: bool) {
        if Format::named(&name.value).is_some() || self.found.broken.contains(&name.value) {
            return;
        }
        let params = &self.graph.params;
        let options = params
            .param(&name.value)
            .filter(|_| or_choice)
            .map_or(&[][..], |p| p.kind.options());
        for option in options.iter().filter(|o| Format::named(o).is_none()) {
            self.error(
                name.at,
                format!("option '{option}' of '{}' is no format", name.value),
            );
        }
        if options.is_empty() {
            let choices = params
                .list
                .iter()
                .filter(|p| or_choice && !p.kind.options().is_empty());
            let mut known: Vec<&str> = Format::names().collect();
            known.extend(choices.map(|p| p.name.as_str()));
            self.found.unknown(
                name.at,
                &name.value,
                format!("no format is named '{}'", name.value),
                known,
            );
        }
    }

    pub(super) fn is_volume(&self, texture: &str) -> bool {
        self.graph
            .texture(texture)
            .is_some_and(|t| self.graph.textures[t].1.value.is_volume())
    }
}

pub(super) fn files_of(folder: &std::path::Path) -> Vec<String> {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return Vec::new();
    };
    entries
        .flatten()
        .filter(|e| e.path().is_file())
        .map(|e| e.file_name().to_string_lossy().into_owned())
        .collect()
}
