//! Checks of a pass that need no shader.

use super::check::{Check, files_of};
use crate::diagnostics::{At, Loc, nearest};
use crate::files::read_input_text;
use crate::graph::file::{Bind, Dispatch, PassDecl, Path, Topology};
use crate::shader::{MAX_BYTES, is_inside};
use crate::vulkan::{Format, Stage};

impl Check<'_> {
    pub(super) fn pass(&mut self, pass: &PassDecl, at: At) {
        let name = &pass.name.value;
        let kinds = [
            pass.dispatch.is_some(),
            pass.draw.is_some(),
            pass.clear.is_some(),
        ];
        match kinds.iter().filter(|k| **k).count() {
            0 => self.error(
                at,
                format!("pass '{name}' does nothing: give it dispatch, draw or clear"),
            ),
            1 => {}
            _ => self.error(
                at,
                format!(
                    "pass '{name}' does several things: dispatch, draw and clear exclude each other"
                ),
            ),
        }
        self.exprs(
            pass.conditions()
                .chain(pass.over_frames())
                .chain(&pass.repeat),
        );
        if pass.repeat.is_some() && pass.each_mip.is_some() {
            self.error(at, format!("pass '{name}' has both repeat and each_mip"));
        }
        if let Some(each) = &pass.each_mip {
            self.texture_name(&each.value.texture);
        }
        self.stages(pass, at);
        match pass.dispatch.as_ref().map(|d| &d.value) {
            Some(Dispatch::Cover(target)) if pass.bind(&target.value).is_some() => {}
            Some(Dispatch::Cover(target)) if self.graph.alias(&target.value).is_some() => {}
            Some(Dispatch::Cover(target)) => drop(self.texture_name(target)),
            Some(Dispatch::Threads(x, y, z) | Dispatch::Groups(x, y, z)) => self.exprs([x, y, z]),
            _ => {}
        }
        if let Some((command, _)) = pass.command() {
            self.indirect(command);
        }
        for (_, bind) in &pass.bind.0 {
            match self.graph.alias(&bind.value.of.value) {
                Some(alias) => alias
                    .cases
                    .iter()
                    .for_each(|case| self.bind(&case.bind.narrowed(&bind.value))),
                None => self.bind(&bind.value),
            }
        }
        for (written, read) in &pass.instead.0 {
            self.texture_name(written);
            self.texture_name(&read.value);
        }
        self.attachments(pass, at);
        if let Some(target) = &pass.clear
            && self.graph.buffer(&target.value).is_none()
            && self.texture_name(target)
            && self.is_depth(&target.value) == Some(true)
        {
            let name = &target.value;
            let message = format!(
                "'{name}' is a depth texture: clear it where it is attached, depth: (clear: 1.0)"
            );
            self.error(target.at, message);
        }
    }

    /// Whether a texture's format is a depth format; nothing if it is no format, which another
    /// check reports. A choice of formats counts as its first one.
    fn is_depth(&self, texture: &str) -> Option<bool> {
        let name = &self.graph.textures[self.graph.texture(texture)?]
            .1
            .value
            .format
            .value;
        let first = self
            .graph
            .params
            .param(name)
            .and_then(|p| p.kind.options().first());
        Format::named(first.unwrap_or(name)).map(|f| f.is_depth())
    }

    fn stages(&mut self, pass: &PassDecl, at: At) {
        let name = &pass.name.value;
        let mut stages = Vec::new();
        for shader in &pass.shaders.0 {
            let Some(stage) = Stage::of_file(&shader.value) else {
                self.error(
                    shader.at,
                    format!(
                        "'{}' is no shader: expected .vert, .tesc, .tese, .geom, .frag or .comp",
                        shader.value
                    ),
                );
                continue;
            };
            if stages.contains(&stage) {
                self.error(
                    shader.at,
                    format!("pass '{name}' has two {stage:?} shaders"),
                );
            }
            stages.push(stage);
            if !is_inside(&shader.value) {
                self.error(
                    shader.at,
                    format!(
                        "shader '{}' leads out of the folder of shaders",
                        shader.value
                    ),
                );
                continue;
            }
            let path = self.folders.shaders.join(&shader.value);
            // The compiler's own words for this are pages of built-in functions.
            if read_input_text(&path, MAX_BYTES).is_ok_and(|text| !text.contains("#version")) {
                self.error(
                    shader.at,
                    format!(
                        "shader '{}' has no line `#version 460`, which must be its first",
                        shader.value
                    ),
                );
            }
            if !path.is_file() {
                let known = files_of(&self.folders.shaders);
                let help = nearest(&shader.value, known.iter().map(String::as_str));
                self.found.help(
                    shader.at,
                    format!("no shader file '{}'", shader.value),
                    help,
                );
            }
        }
        if pass.dispatch.is_some() && stages != [Stage::Compute] {
            self.error(
                at,
                format!("pass '{name}' dispatches: it needs one .comp shader and no other"),
            );
        }
        if pass.draw.is_some()
            && (!stages.contains(&Stage::Vertex) || stages.contains(&Stage::Compute))
        {
            self.error(
                at,
                format!("pass '{name}' draws: it needs a .vert shader and no .comp"),
            );
        }
        let tessellated =
            stages.contains(&Stage::TessControl) && stages.contains(&Stage::TessEvaluation);
        if pass.draw.is_some() && (pass.topology == Topology::Patches) != tessellated {
            self.error(
                at,
                format!("pass '{name}': patches need both a .tesc and a .tese shader, and they need patches"),
            );
        }
        if pass.clear.is_some() && !pass.shaders.0.is_empty() {
            self.error(at, format!("pass '{name}' clears: it takes no shaders"));
        }
    }

    fn indirect(&mut self, path: &Loc<Path>) {
        self.member(path);
        let buffer = &path.value.buffer;
        if self
            .graph
            .buffers
            .iter()
            .any(|(name, b)| name == buffer && !b.value.indirect)
        {
            self.error(
                path.at,
                format!("buffer '{buffer}' is not declared with `indirect: true`"),
            );
        }
    }

    pub(super) fn bind(&mut self, bind: &Bind) {
        let graph = self.graph;
        let (name, at) = (&bind.of.value, bind.of.at);
        let has_history = if let Some(buffer) = graph.buffer(name) {
            if bind.mip.is_some() || bind.format.is_some() || bind.sampler.is_some() {
                self.error(
                    at,
                    format!("'{name}' is a buffer: it has no mip, format or sampler"),
                );
            }
            graph.buffers[buffer].1.value.history
        } else if self.texture_name(&bind.of)
            && let Some(texture) = graph.texture(name)
        {
            let texture = &graph.textures[texture].1.value;
            self.exprs(&bind.mip);
            let declared =
                |f: &str| texture.format.value == f || texture.views.0.iter().any(|v| v.value == f);
            if let Some(format) = bind.format.as_ref().filter(|f| !declared(&f.value)) {
                let message = format!(
                    "'{name}' is not declared to be viewed as '{}'",
                    format.value
                );
                self.found.help(
                    format.at,
                    message,
                    Some(format!("declare it: views: [\"{}\"]", format.value)),
                );
            }
            texture.history
        } else {
            return;
        };
        if bind.history && !has_history {
            self.error(at, format!("'{name}' is not declared with `history: true`"));
        }
    }

    fn attachments(&mut self, pass: &PassDecl, at: At) {
        let name = &pass.name.value;
        for target in &pass.color.0 {
            let t = &target.value;
            self.exprs(t.mip.iter().chain(&t.layer));
            if self.texture_name(&t.to) && self.is_depth(&t.to.value) == Some(true) {
                self.error(
                    t.to.at,
                    format!(
                        "'{}' is a depth texture and cannot be a colour attachment",
                        t.to.value
                    ),
                );
            }
            if self.is_volume(&t.to.value) {
                self.error(
                    t.to.at,
                    format!(
                        "'{}' is 3D and cannot be an attachment; write to it as an image",
                        t.to.value
                    ),
                );
            }
        }
        if let Some(depth) = &pass.depth {
            let t = &depth.value;
            self.exprs(t.layer.iter());
            if self.texture_name(&t.to) && self.is_depth(&t.to.value) == Some(false) {
                self.error(
                    t.to.at,
                    format!("'{}' is no depth texture (d32 or d16)", t.to.value),
                );
            }
        }
        let any = !pass.color.0.is_empty() || pass.depth.is_some();
        if any && pass.draw.is_none() {
            self.error(
                at,
                format!("pass '{name}' has attachments but draws nothing"),
            );
        }
        let raster = &pass.raster;
        if let Some(size) = &raster.size {
            self.exprs([&size.value.0, &size.value.1]);
            if any {
                self.error(
                    size.at,
                    format!("pass '{name}' has attachments: its size is theirs"),
                );
            }
        } else if pass.draw.is_some() && !any && !raster.discard {
            self.error(
                at,
                format!(
                    "pass '{name}' draws without attachments: give raster: (size: (\"w\", \"h\"))"
                ),
            );
        }
        self.exprs(raster.samples.iter());
        if raster.samples.is_some() && any {
            self.error(
                at,
                format!("pass '{name}': samples are for drawing without attachments"),
            );
        }
    }
}
