//! The fixed named resources that a scene offers to every graph. The graph knows their names and kinds, not what they
//! mean; `shaders/common/scene.glsl` declares their layouts.

/// Kind of an external resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExternalKind {
    /// A uniform block.
    Uniform,
    /// A read-only storage buffer.
    Storage,
    /// A sampled 2D array.
    TextureArray,
}

/// A resource that exists outside the graph.
#[derive(Clone, Copy, Debug)]
pub struct External {
    /// Name in shaders.
    pub name: &'static str,
    /// Kind.
    pub kind: ExternalKind,
}

const fn external(name: &'static str, kind: ExternalKind) -> External {
    External { name, kind }
}

/// Number of arrays that material textures are spread over.
pub const MATERIAL_ARRAYS: usize = 12;

/// The resources that a scene has only for graphs that name them: a hierarchy over all triangles, for rays, and the sky as
/// they draw directions from it.
pub const RAY_RESOURCES: [&str; 3] = ["bvhNodes", "bvhTriangles", "skyTexels"];

use ExternalKind::{Storage, TextureArray, Uniform};

/// All of them.
pub const EXTERNALS: &[External] = &[
    external("params", Uniform),
    external("camera", Uniform),
    external("sceneInfo", Uniform),
    external("lights", Storage),
    external("shadowViews", Storage),
    external("materials", Storage),
    external("dielectrics", Storage),
    external("instances", Storage),
    external("draws", Storage),
    external("positions", Storage),
    external("attributes", Storage),
    external("indices", Storage),
    external("triangles", Storage),
    external("emitters", Storage),
    external("bvhNodes", Storage),
    external("bvhTriangles", Storage),
    external("skyTexels", Storage),
    external("skyTexture", TextureArray),
    external("materialTexture0", TextureArray),
    external("materialTexture1", TextureArray),
    external("materialTexture2", TextureArray),
    external("materialTexture3", TextureArray),
    external("materialTexture4", TextureArray),
    external("materialTexture5", TextureArray),
    external("materialTexture6", TextureArray),
    external("materialTexture7", TextureArray),
    external("materialTexture8", TextureArray),
    external("materialTexture9", TextureArray),
    external("materialTexture10", TextureArray),
    external("materialTexture11", TextureArray),
];
