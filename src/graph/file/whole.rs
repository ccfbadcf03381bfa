//! A graph file.

use super::pass::PassItem;
use super::resource::{AliasDecl, BufferDecl, NamedSampler, TextureDecl};
use super::section::{
    CheckDecl, CompareDecl, PartItem, RefuseDecl, SceneNeeds, ToolDecl, ValueDecl, ViewDecl,
};
use super::table::TableDecl;
use crate::diagnostics::{Entries, Items, Loc, RawText};
use crate::graph::param::Decl;
use serde::Deserialize;

/// A graph file.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GraphFile {
    /// Files read before this one.
    pub include: Items<String>,
    /// Parameters.
    pub params: Items<Decl>,
    /// Other defaults for parameters of included files.
    pub defaults: Entries<RawText>,
    /// Parameters of included files that keep their default and cannot be set.
    pub fixed: Items<String>,
    /// Parameters that the panel shows first: name, title in plain words.
    pub pinned: Entries<String>,
    /// Groups of parameters, in the order in which the panel shows them; others follow.
    pub groups: Items<String>,
    /// Modules without a choice: name, file in the shader folder.
    pub modules: Entries<String>,
    /// Parameters that are no more, as in [`Retired`]: graphs in older captures carry their own
    /// list.
    pub retired: Entries<String>,
    /// Expressions by name, for other expressions and shaders.
    pub values: Entries<ValueDecl>,
    /// Textures by name.
    pub textures: Entries<TextureDecl>,
    /// Buffers by name.
    pub buffers: Entries<BufferDecl>,
    /// Names that shaders bind, each for the first of its cases that holds.
    pub aliases: Entries<Vec<Loc<AliasDecl>>>,
    /// Names that shaders bind, each for a texture sampled in its own way.
    pub samplers: Entries<NamedSampler>,
    /// Passes and groups of them, in order.
    pub passes: Items<PassItem>,
    /// The display-encoded picture.
    pub output: Option<Loc<String>>,
    /// The linear picture.
    pub hdr: Option<Loc<String>>,
    /// Further results that may be requested.
    pub outputs: Items<String>,
    /// Contributions to the linear picture that other graphs have too.
    pub parts: Entries<PartItem>,
    /// Requirements on the scene's geometry.
    pub scene: Option<Loc<SceneNeeds>>,
    /// Words of buffers that must be zero after a frame.
    pub checks: Items<CheckDecl>,
    /// Settings that make no sense together.
    pub refuse: Items<RefuseDecl>,
    /// Caption of pictures, one line. `{NAME}` is the value of a parameter.
    pub caption: Option<Loc<String>>,
    /// The `Vec2` parameter that a click on the picture sets.
    pub pointer: Option<Loc<String>>,
    /// The `Vec2` parameter that is the inspected slice of a volume.
    pub slice: Option<Loc<String>>,
    /// `Int` parameters that select the mip of a texture in views, by texture.
    pub view_mips: Entries<String>,
    /// Buffers that may be read as tables.
    pub tables: Items<TableDecl>,
    /// Settings worth comparing.
    pub compare: Items<CompareDecl>,
    /// Settings that show something worth looking into.
    pub views: Items<ViewDecl>,
    /// Parameters that cost time and quality, and the values worth trying.
    pub fit: Entries<Items<RawText>>,
    /// Settings from the ideal to the method: what each step costs is the method's error, split.
    pub ablation: Items<ViewDecl>,
    /// Settings of tools, by their names.
    pub tools: Entries<ToolDecl>,
}

/// What to write instead of names that are no more: the file `retired.ron` in the folder of graphs.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Retired {
    /// Replacement by file name of the graph.
    pub graphs: Entries<String>,
    /// Replacement by name of the parameter, or by `parameter=option`.
    pub parameters: Entries<String>,
}
