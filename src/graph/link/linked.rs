//! Passes with their shaders.

use crate::graph::expr::Ex;
use crate::graph::file::Bind;
use crate::shader::{Compiled, Layout, Resource};
use crate::vulkan::Stage;
use std::sync::Arc;

/// What a shader's name was found to be.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// Index in [`EXTERNALS`](crate::graph::externals::EXTERNALS).
    External(usize),
    /// Index of a buffer.
    Buffer(usize),
    /// Index of a texture.
    Texture(usize),
}

/// One binding of one stage.
#[derive(Clone, Debug)]
pub struct Bound {
    /// Stage.
    pub stage: Stage,
    /// Binding number.
    pub binding: u32,
    /// Name in the shader.
    pub name: String,
    /// What the shader expects.
    pub resource: Resource,
    /// How the block of a buffer lies in memory.
    pub layout: Option<Arc<Layout>>,
    /// Bytes of a uniform block that may be read; none: all of them.
    pub reads: Option<Vec<(u32, u32)>>,
    /// What it is: one, or several of an alias, of which the first whose condition holds counts.
    pub cases: Vec<BoundCase>,
}

/// What a binding is, under a condition.
#[derive(Clone, Debug)]
pub struct BoundCase {
    /// The condition; none in the last case.
    pub when: Option<Ex>,
    /// What it is.
    pub target: Target,
    /// What the pass or an alias says of it: where it is renamed or narrowed.
    pub bind: Option<Bind>,
}

/// A pass with its shaders.
#[derive(Clone, Debug, Default)]
pub struct Linked {
    /// Compiled stages, in pipeline order.
    pub stages: Vec<Compiled>,
    /// All bindings.
    pub bound: Vec<Bound>,
}
