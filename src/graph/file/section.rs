//! Small sections of a graph file.

use super::path::Path;
use crate::diagnostics::Loc;
use crate::graph::expr::Ex;
use serde::Deserialize;

/// What a name stands for.
#[derive(Clone, Debug, Deserialize)]
pub enum ValueDecl {
    /// A number.
    Float(Ex),
    /// A whole number.
    Int(Ex),
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

/// A word of a buffer that must be zero: `field`, or `buffer` and `word`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CheckDecl {
    /// The member of a buffer's block, `buffer.member`.
    pub field: Option<Loc<Path>>,
    /// The buffer.
    pub buffer: Option<Loc<String>>,
    /// Index of the 32-bit word.
    pub word: Option<u32>,
    /// A texture: the check is made where it is wanted. Always where nothing is said.
    pub with: Option<Loc<String>>,
    /// What it means when it is not zero, and what to do.
    pub message: String,
}

impl CheckDecl {
    /// The buffer.
    pub fn buffer(&self) -> &str {
        self.field.as_ref().map_or_else(|| self.buffer.as_ref().map_or("", |b| &b.value), |f| &f.value.buffer)
    }
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
