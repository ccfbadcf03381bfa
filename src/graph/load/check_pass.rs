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
        let mistake = match kinds.iter().filter(|k| **k).count() {
            0 => Some("nothing: give it dispatch, draw or clear"),
            1 => None,
            _ => Some("several things: dispatch, draw and clear exclude each other"),
        };
        if let Some(what) = mistake {
            self.error(at, format!("pass '{name}' does {what}"));
        }
        let frames = pass.conditions().chain(pass.over_frames());
        self.exprs(frames.chain(&pass.repeat));
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
            let Some(alias) = self.graph.alias(&bind.value.of.value) else {
                self.bind(&bind.value);
                continue;
            };
            for case in &alias.cases {
                self.bind(&case.bind.narrowed(&bind.value));
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
            self.shader(name, shader, &mut stages);
        }
        let has = |stage| stages.contains(&stage);
        let (is_drawn, takes_patches) = (pass.draw.is_some(), pass.topology == Topology::Patches);
        let tessellates = has(Stage::TessControl) && has(Stage::TessEvaluation);
        if pass.dispatch.is_some() && stages != [Stage::Compute] {
            let what = "dispatches: it needs one .comp shader and no other";
            self.error(at, format!("pass '{name}' {what}"));
        }
        if is_drawn && (!has(Stage::Vertex) || has(Stage::Compute)) {
            let what = "draws: it needs a .vert shader and no .comp";
            self.error(at, format!("pass '{name}' {what}"));
        }
        if is_drawn && takes_patches != tessellates {
            let what = "patches need both a .tesc and a .tese shader, and they need patches";
            self.error(at, format!("pass '{name}': {what}"));
        }
        if pass.clear.is_some() && !pass.shaders.0.is_empty() {
            self.error(at, format!("pass '{name}' clears: it takes no shaders"));
        }
    }

    fn shader(&mut self, pass: &str, shader: &Loc<String>, stages: &mut Vec<Stage>) {
        let (at, file) = (shader.at, &shader.value);
        let Some(stage) = Stage::of_file(file) else {
            let kinds = ".vert, .tesc, .tese, .geom, .frag or .comp";
            return self.error(at, format!("'{file}' is no shader: expected {kinds}"));
        };
        if stages.contains(&stage) {
            self.error(at, format!("pass '{pass}' has two {stage:?} shaders"));
        }
        stages.push(stage);
        if !is_inside(file) {
            let what = "leads out of the folder of shaders";
            return self.error(at, format!("shader '{file}' {what}"));
        }
        let path = self.folders.shaders.join(file);
        // The compiler's own words for this are pages of built-in functions.
        if read_input_text(&path, MAX_BYTES).is_ok_and(|text| !text.contains("#version")) {
            let what = "has no line `#version 460`, which must be its first";
            self.error(at, format!("shader '{file}' {what}"));
        }
        if !path.is_file() {
            let known = files_of(&self.folders.shaders);
            let help = nearest(file, known.iter().map(String::as_str));
            self.found
                .help(at, format!("no shader file '{file}'"), help);
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
            let (to, at) = (&target.value.to.value, target.value.to.at);
            self.exprs(target.value.mip.iter().chain(&target.value.layer));
            if self.texture_name(&target.value.to) && self.is_depth(to) == Some(true) {
                let what = "is a depth texture and cannot be a colour attachment";
                self.error(at, format!("'{to}' {what}"));
            }
            if self.is_volume(to) {
                let what = "is 3D and cannot be an attachment; write to it as an image";
                self.error(at, format!("'{to}' {what}"));
            }
        }
        if let Some(depth) = &pass.depth {
            let to = &depth.value.to;
            self.exprs(depth.value.layer.iter());
            if self.texture_name(to) && self.is_depth(&to.value) == Some(false) {
                let message = format!("'{}' is no depth texture (d32 or d16)", to.value);
                self.error(to.at, message);
            }
        }
        let any = !pass.color.0.is_empty() || pass.depth.is_some();
        if any && pass.draw.is_none() {
            let what = "has attachments but draws nothing";
            self.error(at, format!("pass '{name}' {what}"));
        }
        let raster = &pass.raster;
        if let Some(size) = &raster.size {
            self.exprs([&size.value.0, &size.value.1]);
            if any {
                let what = "has attachments: its size is theirs";
                self.error(size.at, format!("pass '{name}' {what}"));
            }
        } else if pass.draw.is_some() && !any && !raster.discard {
            let what = "draws without attachments: give raster: (size: (\"w\", \"h\"))";
            self.error(at, format!("pass '{name}' {what}"));
        }
        self.exprs(raster.samples.iter());
        if raster.samples.is_some() && any {
            let what = "samples are for drawing without attachments";
            self.error(at, format!("pass '{name}': {what}"));
        }
    }
}
