//! Passes with their shaders.

use crate::graph::expr::Ex;
use crate::graph::file::Bind;
use crate::shader::{Compiled, Layout, Resource};
use crate::vulkan::Stage;
use std::sync::Arc;

/// The resource of a shader's name.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// Index in the scene's [interface](crate::graph::interface::SceneInterface).
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
    /// The declaration in the shader.
    pub resource: Resource,
    /// Memory layout of a buffer's block.
    pub layout: Option<Arc<Layout>>,
    /// Bytes of a uniform block that may be read; none: all of them.
    pub reads: Option<Vec<(u32, u32)>>,
    /// Its resource, or the cases of an alias. The first one with a true condition applies.
    pub cases: Vec<BoundCase>,
}

/// A conditional case of a binding.
#[derive(Clone, Debug)]
pub struct BoundCase {
    /// The condition; none in the last case.
    pub when: Option<Ex>,
    /// The resource.
    pub target: Target,
    /// The `bind` of the pass, or the alias, that renames or narrows it.
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
