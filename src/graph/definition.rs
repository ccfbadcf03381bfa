//! A graph that was read and checked, and where things are in it.

use super::debug::CLEAR;
use super::expr::{Env, Ex};
use super::file::{
    Bind, BufferDecl, CheckDecl, CompareDecl, PassDecl, RefuseDecl, SceneNeeds, TableDecl,
    TextureDecl, ToolDecl, ViewDecl,
};
use super::interface::SceneInterface;
use super::param::{Params, Value};
use crate::diagnostics::{At, Loc, Sources};
use crate::metrics::Kind;

/// A graph that was read and checked.
#[derive(Debug)]
pub struct Graph {
    /// Its name: the file's stem.
    pub name: String,
    /// What every scene offers to it.
    pub interface: &'static SceneInterface,
    /// Parameters at their defaults.
    pub params: Params,
    /// Parameters that the panel shows first: name, title. One that is retired is shown with what
    /// to write instead.
    pub pinned: Vec<(String, String)>,
    /// Groups of parameters in the order of the panel; others follow.
    pub groups: Vec<String>,
    /// Modules without a choice: name, file in the shader folder.
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
    /// Contributions to the linear picture. Graphs are compared by the parts that both have.
    pub parts: Vec<LightPart>,
    /// Needs of the geometry.
    pub scene: Option<Loc<SceneNeeds>>,
    /// Words that must be zero.
    pub checks: Vec<Loc<CheckDecl>>,
    /// Settings that make no sense together.
    pub refuse: Vec<RefuseDecl>,
    /// Caption of pictures; see [`Graph::caption`].
    pub(super) caption: Option<Loc<String>>,
    /// The `Vec2` parameter that a click on the picture sets: pixels from the picture's top left
    /// corner, negative where nothing is pointed at.
    pub pointer: Option<String>,
    /// The `Vec2` parameter that is the inspected slice of a volume: axis, and position from 0 to 1;
    /// negative where none is.
    pub slice: Option<String>,
    /// Textures with the `Int` parameter that selects their mip in views.
    pub view_mips: Vec<(String, String)>,
    /// Buffers that may be read as tables, on request.
    pub tables: Vec<Loc<TableDecl>>,
    /// Settings worth comparing.
    pub compare: Vec<Loc<CompareDecl>>,
    /// Settings that show something worth looking into.
    pub views: Vec<Loc<ViewDecl>>,
    /// Parameters that trade time for quality, and the values worth trying, neighbours alike.
    pub fit: Vec<(String, Vec<String>)>,
    /// Settings from the ideal to the method as it is set: what each step adds is a part of its
    /// error.
    pub ablation: Vec<Loc<ViewDecl>>,
    /// Settings of tools, by their names.
    pub tools: Vec<(String, Loc<ToolDecl>)>,
    /// The files it came from.
    pub sources: Sources,
}

/// A named value: an expression that a graph declares once, for its other expressions and for
/// shaders.
#[derive(Clone, Debug)]
pub struct Named {
    /// Name in expressions and shaders.
    pub name: String,
    /// Where it is declared.
    pub at: At,
    /// Whether it is an integer, rounded down; else it is a float.
    pub whole: bool,
    /// Its expression; 0 for a signature.
    pub expr: Ex,
    /// The stage that it represents, if it is a signature.
    pub signs: Option<String>,
}

impl Named {
    /// Whether it reads a variable.
    pub(super) fn reads(&self, name: &str) -> bool {
        self.expr.value.variables().iter().any(|v| v == name)
    }

    /// Its number with these variables, or the error.
    pub(super) fn number(&self, env: &Env) -> Result<f64, String> {
        let value = self.expr.value.eval(env)?;
        let rounded = (value + 1e-9).floor();
        match self.whole {
            true if rounded.abs() > f64::from(i32::MAX) => {
                Err(format!("{value} does not fit 32 bits"))
            }
            true => Ok(rounded),
            false => Ok(value),
        }
    }

    /// A number as its value.
    pub(super) fn value(&self, number: f64) -> Value {
        if self.whole {
            Value::Int(number as i64)
        } else {
            Value::Float(number)
        }
    }
}

/// A name that shaders bind and that stands for something else: one of several resources, or a
/// texture sampled in its own way.
#[derive(Clone, Debug)]
pub struct Alias {
    /// The name.
    pub name: String,
    /// Where it is declared.
    pub at: At,
    /// Its cases. The first one with a true condition applies.
    pub cases: Vec<AliasCase>,
}

/// A conditional binding of a name.
#[derive(Clone, Debug)]
pub struct AliasCase {
    /// The condition; none in the last case.
    pub when: Option<Ex>,
    /// The resource, as in a pass's `bind`.
    pub bind: Bind,
}

/// A resource of the graph, by its number among the textures or buffers; `true` is last frame's
/// copy.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Res {
    /// A texture.
    Texture(usize, bool),
    /// A buffer.
    Buffer(usize, bool),
}

impl Res {
    /// The same of this frame.
    pub fn current(self) -> Res {
        match self {
            Res::Texture(t, _) => Res::Texture(t, false),
            Res::Buffer(b, _) => Res::Buffer(b, false),
        }
    }
}

/// A part of the light.
#[derive(Clone, Debug, PartialEq)]
pub struct LightPart {
    /// Its name, the same in all graphs that have it.
    pub name: String,
    /// Its texture.
    pub texture: String,
    /// What its numbers are.
    pub kind: Kind,
    /// Its name within a sentence.
    pub title: String,
    /// Whether it is what methods are looked at for.
    pub focus: bool,
}

impl Graph {
    /// Number of a texture.
    pub fn texture(&self, name: &str) -> Option<usize> {
        self.textures.iter().position(|t| t.0 == name)
    }

    /// Number of a buffer.
    pub fn buffer(&self, name: &str) -> Option<usize> {
        self.buffers.iter().position(|b| b.0 == name)
    }

    /// A texture or buffer.
    pub fn resource(&self, name: &str) -> Option<Res> {
        let texture = self.texture(name).map(|t| Res::Texture(t, false));
        texture.or_else(|| self.buffer(name).map(|b| Res::Buffer(b, false)))
    }

    /// Names of all textures, then of all buffers.
    pub fn resource_names(&self) -> impl Iterator<Item = &str> {
        self.textures
            .iter()
            .map(|t| t.0.as_str())
            .chain(self.buffers.iter().map(|b| b.0.as_str()))
    }

    /// The name of a resource, whichever frame's.
    pub fn name_of(&self, res: Res) -> &str {
        match res {
            Res::Texture(t, _) => &self.textures[t].0,
            Res::Buffer(b, _) => &self.buffers[b].0,
        }
    }

    /// A resource for people.
    pub(super) fn title_of(&self, res: Res) -> String {
        let last = res != res.current();
        format!(
            "{}{}",
            self.name_of(res),
            if last { " (last frame)" } else { "" }
        )
    }

    /// Parameters that show something over the picture: states of the window, not of an experiment.
    pub fn cursors(&self) -> impl Iterator<Item = &str> {
        self.pointer.iter().chain(&self.slice).map(String::as_str)
    }

    /// The passes that files declare, with their numbers: all but the one that clears what shaders
    /// show.
    pub fn declared_passes(&self) -> impl Iterator<Item = (usize, &PassDecl)> {
        let passes = self.passes.iter().map(|pass| &pass.value).enumerate();
        passes.filter(|(_, pass)| pass.name.value != CLEAR)
    }

    /// The name of a pass.
    pub fn pass_name(&self, pass: usize) -> &str {
        &self.passes[pass].value.name.value
    }

    /// The caption with these values of the parameters.
    pub fn caption(&self, params: &Params) -> Option<String> {
        let mut text = self.caption.as_ref()?.value.clone();
        for (param, value) in params.list.iter().zip(&params.values) {
            text = text.replace(&format!("{{{}}}", param.name), &value.to_string());
        }
        Some(text)
    }

    /// Buffers of the checks that are made where these resources are wanted.
    pub fn checked_with(&self, wanted: &[String]) -> Vec<String> {
        let made = |c: &&CheckDecl| {
            c.with
                .as_ref()
                .is_none_or(|texture| wanted.contains(&texture.value))
        };
        self.checks
            .iter()
            .map(|c| &c.value)
            .filter(made)
            .map(|c| c.field.value.buffer.clone())
            .collect()
    }

    /// The settings of a tool.
    pub fn tool(&self, name: &str) -> Option<&Loc<ToolDecl>> {
        self.tools.iter().find(|t| t.0 == name).map(|t| &t.1)
    }

    /// The alias or named sampler of that name.
    pub fn alias(&self, name: &str) -> Option<&Alias> {
        self.aliases.iter().find(|a| a.name == name)
    }

    /// The bindings of a name in a pass, by condition: itself, the pass's `bind`, or the cases of
    /// an alias.
    pub(super) fn cases(&self, pass: &PassDecl, name: &str) -> Vec<(Option<Ex>, Option<Bind>)> {
        let own = pass.bind(name);
        match self.alias(own.map_or(name, |b| b.of.value.as_str())) {
            None => vec![(None, own.cloned())],
            Some(alias) => {
                let narrowed =
                    |case: &AliasCase| own.map_or(case.bind.clone(), |own| case.bind.narrowed(own));
                alias
                    .cases
                    .iter()
                    .map(|case| (case.when.clone(), Some(narrowed(case))))
                    .collect()
            }
        }
    }

    /// Expressions of the aliases.
    pub(super) fn alias_expressions(&self) -> impl Iterator<Item = &Ex> {
        let cases = self.aliases.iter().flat_map(|a| &a.cases);
        cases.flat_map(|c| c.when.iter().chain(&c.bind.mip))
    }

    /// Expressions of the requirements on the scene.
    pub(super) fn scene_expressions(&self) -> impl Iterator<Item = &Ex> {
        self.scene
            .iter()
            .flat_map(|s| std::iter::once(&s.value.max_edge).chain(&s.value.when))
    }

    /// All expressions.
    pub(super) fn expressions(&self) -> impl Iterator<Item = &Ex> {
        let textures = self.textures.iter().flat_map(|t| t.1.value.expressions());
        let buffers = self
            .buffers
            .iter()
            .flat_map(|b| b.1.value.size.value.expression());
        let params = self
            .params
            .list
            .iter()
            .flat_map(|p| p.when.iter().chain(&p.effective));
        let values = self
            .values
            .iter()
            .map(|v| &v.expr)
            .chain(self.refuse.iter().map(|r| &r.when));
        let passes = self.passes.iter().flat_map(|p| p.value.expressions());
        let resources = textures
            .chain(buffers)
            .chain(params)
            .chain(self.scene_expressions());
        resources
            .chain(values)
            .chain(self.alias_expressions())
            .chain(passes)
    }
}
