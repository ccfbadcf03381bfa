//! What can be told of a pass without its shaders.

use super::alias::narrowed;
use super::check::{Check, files_of};
use super::file::{Command, Dispatch, Draw, PassDecl};
use super::load::Graph;
use super::param::Kind;
use crate::diagnostics::{At, Loc};
use crate::vulkan::{Format, Stage};

impl Check<'_> {
    pub(super) fn pass(&mut self, pass: &PassDecl, at: At) {
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
        self.exprs(pass.conditions().chain(&pass.settles).chain(&pass.repeat).chain(&pass.mip));
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

    pub(super) fn is_depth(&self, texture: &str) -> bool {
        let found = self.graph.textures.iter().find(|t| t.0 == texture);
        found.and_then(|t| Format::named(&t.1.value.format.value)).is_some_and(|f| f.is_depth())
    }

    pub(super) fn copy(&mut self, copy: &super::file::CopyDecl) {
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

    pub(super) fn stages(&mut self, pass: &PassDecl, at: At) {
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
            if crate::files::read_input_text(&path, crate::shader::MAX_BYTES)
                .is_ok_and(|text| !text.contains("#version"))
            {
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

    pub(super) fn indirect(&mut self, command: &Command) {
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

    pub(super) fn bind(&mut self, bind: &super::file::Bind) {
        let history = |declared: bool, this: &mut Self| {
            if bind.history && !declared {
                this.error(bind.of.at, format!("'{}' is not declared with `history: true`", bind.of.value));
            }
        };
        if let Some((_, buffer)) = self.graph.buffers.iter().find(|b| b.0 == bind.of.value) {
            history(buffer.value.history, self);
            if bind.mip.is_some() || bind.layer.is_some() || bind.format.is_some() || bind.sampler.is_some() {
                self.error(
                    bind.of.at,
                    format!("'{}' is a buffer: it has no mip, layer, format or sampler", bind.of.value),
                );
            }
            return;
        }
        if !self.texture_name(&bind.of) {
            return;
        }
        self.exprs(bind.mip.iter().chain(&bind.layer));
        let Some((_, texture)) = self.graph.textures.iter().find(|t| t.0 == bind.of.value) else { return };
        history(texture.value.history, self);
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

    pub(super) fn attachments(&mut self, pass: &PassDecl, at: At) {
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
