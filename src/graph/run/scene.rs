//! A scene's resources for the passes of a graph.

use crate::vulkan::{Buffer, Sampler, View};
use std::collections::HashMap;
use std::sync::Arc;

/// The scene's triangles as drawn: the masked draws follow the opaque ones.
#[derive(Clone)]
pub struct Geometry {
    /// 32-bit indices.
    pub indices: Arc<Buffer>,
    /// One indexed draw command (20 bytes) a draw.
    pub commands: Arc<Buffer>,
    /// (first index, index count) of each draw.
    pub draws: Vec<(u32, u32)>,
    /// How many of them have no alpha mask.
    pub opaque: u32,
}

/// The scene's resources by the names of its [interface](crate::graph::interface::SceneInterface).
#[derive(Clone)]
pub struct SceneResources {
    /// Buffers.
    pub buffers: HashMap<&'static str, Arc<Buffer>>,
    /// Material texture arrays.
    pub textures: HashMap<&'static str, Arc<View>>,
    /// How those are sampled.
    pub sampler: Arc<Sampler>,
    /// The draws.
    pub geometry: Geometry,
    /// Specialisation constants (id, value) by which shaders leave out code that the scene does not
    /// need.
    pub constants: Vec<(u32, u32)>,
}
