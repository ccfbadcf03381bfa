//! What a graph says to those who look at it.

use crate::diagnostics::{Entries, Items, Loc, RawText};
use serde::Deserialize;

/// Two settings that the graph offers to put side by side.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CompareDecl {
    /// What a button says.
    pub title: String,
    /// One line.
    pub help: String,
    /// Parameters of the first.
    pub a: Entries<RawText>,
    /// Parameters of the second.
    pub b: Entries<RawText>,
}

/// Settings that the graph offers to look into its work.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ViewDecl {
    /// What a button says.
    pub title: String,
    /// One line.
    pub help: String,
    /// Parameters that it sets.
    pub set: Entries<RawText>,
}

/// Voxels that a graph makes, for comparing them with what its triangles exactly overlap.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VoxelsDecl {
    /// 3D texture whose first channel is not zero in occupied cells.
    pub occupied: Loc<String>,
    /// 3D texture of linear base colour; alpha is opacity.
    pub color: Loc<String>,
    /// 3D texture of the unit normal * 0.5 + 0.5.
    pub normal: Loc<String>,
    /// Buffer that says where the cells lie: a 32-bit word that is 1 where they are boxes, else 0; the z of the first of
    /// them in the textures; how many there are along x, y and z; then, as floats, the world coordinates (m) of their
    /// borders along x, y and z, one more than cells each.
    pub borders: Loc<String>,
    /// Ways of making them that are worth comparing.
    #[serde(default)]
    pub modes: Items<ViewDecl>,
}
