//! What can be told of a graph without its shaders: names, values, expressions, sizes and formats.

use super::expr::Expr;
use super::file::{CheckDecl, Ex, VoxelsDecl};
use super::load::{BUILTIN_VARIABLES, Folders, Graph, is_identifier};
use super::param::Kind;
use super::table::TableDecl;
use crate::diagnostics::{At, Diagnostic, Loc, RawText};
use crate::vulkan::Format;
use std::collections::{HashMap, HashSet};
use std::path::Path;

/// The checks of a graph that was read, and the mistakes that they find.
pub(super) struct Check<'g> {
    pub(super) graph: &'g Graph,
    pub(super) folders: &'g Folders,
    pub(super) errors: Vec<Diagnostic>,
    /// Names in items that could not be read: not reported again where they are used.
    pub(super) broken: Vec<String>,
    /// Whether every file could be read. If not, any unknown name may be one of those in the others.
    pub(super) whole: bool,
    pub(super) variables: HashSet<String>,
}

impl Check<'_> {
    /// Whether a name that is not known is a mistake of its own, and not what is left of one that was reported.
    pub(super) fn is_unknown(&self, name: &str) -> bool {
        self.whole && !self.broken.iter().any(|b| b == name)
    }

    /// Names and values of parameters.
    pub(super) fn values<'v>(&mut self, list: impl Iterator<Item = &'v (Loc<String>, Loc<RawText>)>) {
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

    pub(super) fn error(&mut self, at: At, message: String) {
        self.errors.push(self.graph.sources.error(at, message));
    }

    pub(super) fn names(&mut self) {
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
    pub(super) fn modules(&mut self, fixed: &[(Loc<String>, Loc<String>)]) {
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

    pub(super) fn named_values(&mut self) {
        for named in &self.graph.values {
            self.expr(&named.expr);
            // A value is the same in all of a frame.
            for name in named.expr.value.variables().iter().filter(|v| ["index", "mip"].contains(&v.as_str())) {
                let message = format!("value '{}' reads '{name}', which differs within a frame", named.name);
                self.error(named.expr.at, message);
            }
        }
    }

    pub(super) fn expr(&mut self, ex: &Ex) {
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

    pub(super) fn exprs<'a>(&mut self, list: impl IntoIterator<Item = &'a Ex>) {
        for ex in list {
            self.expr(ex);
        }
    }

    pub(super) fn texture_name(&mut self, name: &Loc<String>) -> bool {
        self.resource(
            name,
            "texture",
            |g, n| g.textures.iter().any(|t| t.0 == n),
            |g| g.textures.iter().map(|t| t.0.as_str()).collect(),
        )
    }

    pub(super) fn buffer_name(&mut self, name: &Loc<String>) -> bool {
        self.resource(
            name,
            "buffer",
            |g, n| g.buffers.iter().any(|t| t.0 == n),
            |g| g.buffers.iter().map(|t| t.0.as_str()).collect(),
        )
    }

    pub(super) fn resource(
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

    pub(super) fn pointer(&mut self, name: &Loc<String>) {
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

    /// Names in braces are parameters.
    pub(super) fn caption(&mut self, caption: &Loc<String>) {
        for part in caption.value.split('{').skip(1) {
            let name = part.split('}').next().unwrap_or_default();
            if !self.graph.params.list.iter().any(|p| p.name == name) && self.is_unknown(name) {
                let found = self.graph.sources.error(caption.at, format!("no parameter is named '{name}'"));
                let known: Vec<&str> = self.graph.params.list.iter().map(|p| p.name.as_str()).collect();
                self.errors.push(found.nearest(name, known));
            }
        }
    }

    /// Names of pinned parameters: those of another graph too, where the graph says which.
    pub(super) fn pinned(&mut self, list: &[(Loc<String>, Loc<String>)]) {
        let params = &self.graph.params;
        for (name, title) in list {
            let elsewhere = params.retired.iter().any(|(retired, _)| *retired == name.value);
            if params.index(&name.value).is_none() && !elsewhere && self.is_unknown(&name.value) {
                let known = params.list.iter().map(|p| p.name.as_str());
                let found = self.graph.sources.error(name.at, format!("no parameter '{}' to pin", name.value));
                self.errors.push(found.nearest(&name.value, known));
            }
            if title.value.trim().is_empty() || title.value.contains('\n') {
                self.error(title.at, format!("'{}' is pinned without a title of one line", name.value));
            }
        }
    }

    pub(super) fn voxels(&mut self, voxels: &VoxelsDecl) {
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

    pub(super) fn check(&mut self, check: &CheckDecl, at: At) {
        match (&check.field, &check.buffer, check.word) {
            (Some(field), None, None) => self.member(field),
            (None, Some(buffer), Some(_)) => drop(self.buffer_name(buffer)),
            _ => self.error(at, String::from("a check needs either field, or buffer and word")),
        }
        if let Some(texture) = &check.with {
            self.texture_name(texture);
        }
    }

    /// The buffer of a path, and that a member is named.
    pub(super) fn member(&mut self, path: &Loc<super::file::Path>) {
        let known = self.buffer_name(&Loc { value: path.value.buffer.clone(), at: path.at });
        if known && path.value.member.is_empty() {
            self.error(path.at, format!("name a member of '{0}': \"{0}.member\"", path.value.buffer));
        }
    }

    pub(super) fn tables(&mut self, tables: &[Loc<TableDecl>]) {
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

    pub(super) fn textures(&mut self) {
        for (name, texture) in &self.graph.textures {
            let t = &texture.value;
            if t.size.0.len() == 3 && t.layers.is_some() {
                self.error(texture.at, format!("'{name}' is 3D and cannot have layers"));
            }
            if t.transient && t.mips.is_some() {
                self.error(texture.at, format!("'{name}' is transient and cannot have mips"));
            }
            self.kept_or_not(name, t.history, t.transient, texture.at);
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
        for (name, buffer) in &self.graph.buffers {
            self.kept_or_not(name, buffer.value.history, buffer.value.transient, buffer.at);
            self.exprs(buffer.value.size.value.expression());
        }
    }

    fn kept_or_not(&mut self, name: &str, history: bool, transient: bool, at: At) {
        if history && transient {
            self.error(at, format!("'{name}' has a history and is transient: one or the other"));
        }
    }

    pub(super) fn aliases(&mut self) {
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

    pub(super) fn format(&mut self, name: &Loc<String>, or_choice: bool) {
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
}

fn unknown(expr: &Expr, variables: &HashSet<String>) -> Vec<String> {
    expr.variables().iter().filter(|v| !variables.contains(*v)).cloned().collect()
}

pub(super) fn files_of(folder: &Path) -> Vec<String> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    entries.flatten().filter(|e| e.path().is_file()).map(|e| e.file_name().to_string_lossy().into_owned()).collect()
}
