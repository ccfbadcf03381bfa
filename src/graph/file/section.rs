//! Small sections of a graph file.

use super::resource::Path;
use crate::diagnostics::{Entries, Items, Loc, RawText, nested};
use crate::graph::expr::Ex;
use crate::metrics::Kind;
use serde::Deserialize;

/// The meaning of a named value.
#[derive(Clone, Debug, Deserialize)]
pub enum ValueDecl {
    /// A number.
    Float(Ex),
    /// A whole number.
    Int(Ex),
    /// A whole number that differs where the passes of this stage read other settings.
    Signature(Loc<String>),
}

/// A part of the light, or the name of its texture alone.
#[derive(Debug)]
pub struct PartItem(pub PartDecl);

/// A part of the light.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PartDecl {
    /// Its texture.
    pub texture: Loc<String>,
    /// What its numbers are.
    #[serde(default)]
    pub kind: Kind,
    /// Its name within a sentence.
    pub title: Option<String>,
    /// Whether it is what methods are looked at for: it has charts and short tables as the total
    /// has.
    #[serde(default)]
    pub focus: bool,
}

impl<'de> Deserialize<'de> for PartItem {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let raw = <&'de ron::value::RawValue>::deserialize(deserializer)?;
        if raw.trim().get_ron().starts_with('(') {
            return nested(raw).map(PartItem);
        }
        let texture = nested(raw)?;
        Ok(PartItem(PartDecl {
            texture,
            kind: Kind::default(),
            title: None,
            focus: false,
        }))
    }
}

/// Geometry prepared for the graph.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneNeeds {
    /// World length (m) above which triangle edges are split at load.
    pub max_edge: Ex,
    /// When that is needed.
    pub when: Option<Ex>,
}

/// A 32-bit whole number in a buffer that must be zero.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CheckDecl {
    /// The member of a buffer's block, `buffer.member`.
    pub field: Loc<Path>,
    /// A texture: the check runs only if it is requested. Without one it always runs.
    pub with: Option<Loc<String>>,
    /// The cause if it is not zero, and the remedy.
    pub message: String,
}

/// Settings that make no sense together.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RefuseDecl {
    /// When they do not.
    pub when: Ex,
    /// Why not, and what to do.
    pub message: String,
}

/// Two settings that the graph offers to put side by side.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CompareDecl {
    /// Text of the button.
    pub title: String,
    /// One line.
    pub help: String,
    /// Parameters of the first; `graph` names another graph's file.
    pub a: Entries<RawText>,
    /// Parameters of the second.
    pub b: Entries<RawText>,
}

/// The name under which a side of a comparison names its graph; no parameter has it.
const GRAPH: &str = "graph";

impl CompareDecl {
    /// The graph that a side names.
    pub fn graph(side: &Entries<RawText>) -> Option<String> {
        let (_, text) = side.0.iter().find(|(name, _)| name.value == GRAPH)?;
        crate::diagnostics::options().from_str(&text.value.0).ok()
    }
}

/// Settings that the graph offers to look into its work.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewDecl {
    /// Text of the button.
    pub title: String,
    /// One line.
    pub help: String,
    /// Parameters that it sets.
    pub set: Entries<RawText>,
}

/// Settings for the tool of that name, which interprets them.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ToolDecl {
    /// Textures and buffers by their role in the tool.
    #[serde(default)]
    pub resources: Entries<String>,
    /// Settings that it may go through.
    #[serde(default)]
    pub settings: Items<ViewDecl>,
}

impl ToolDecl {
    /// The texture or buffer that is this to the tool.
    pub fn resource(&self, role: &str) -> Option<&Loc<String>> {
        self.resources
            .0
            .iter()
            .find(|(name, _)| name.value == role)
            .map(|(_, resource)| resource)
    }
}
