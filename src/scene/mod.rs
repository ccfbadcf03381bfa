//! The scene: triangles, materials, textures, lights, animation and cameras, all in main memory.
//!
//! Knows no graphics interface. World units are metres, y is up, the frame is right-handed, front faces
//! are counter-clockwise, and colours are linear RGB (only base-colour and emission images are sRGB).

pub mod builtin;
mod clips;
mod coordinates;
pub(crate) mod defaults;
pub(crate) mod environment;
mod error;
mod export;
mod fbx;
mod file;
mod gltf;
mod limits;
mod lookup;
mod mesh;
mod motion;
mod obj;
mod open;
mod phong;
mod progress;
mod reach;
mod resample;
mod shapes;
mod shuffle;
mod split;
mod summary;
mod texture;
mod transform;
mod warnings;

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec3, Vec4};
use indexmap::IndexMap;
use serde::Deserialize;

pub use environment::SUN;
pub(crate) use environment::{Environment, SkyPicture};
pub use error::SceneError;
pub(crate) use limits::MAX_COORDINATE;
pub use lookup::{Lookup, Lookups, Wrap};
pub use mesh::Side;
pub(crate) use motion::in_world;
pub(crate) use motion::{Curve, Influence, Interpolation, Joint, Morph, Rest};
pub use motion::{Deformer, Keyframe, Mover, Track, Value};
pub(crate) use shuffle::splitmix;
pub(crate) use texture::{
    MAX_TEXTURE_KINDS, SHARED_EDGE, SmallPicture, TextureKind, keep_their_size,
};
pub(crate) use transform::origin_of;

/// Everything that is rendered, and from where.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// What the scene was opened as: a built-in's name or a file's stem.
    pub name: String,
    /// Triangles, each mesh in a space of its own.
    pub meshes: Vec<Mesh>,
    /// What submeshes are made of, by number.
    pub materials: Vec<Material>,
    /// What materials refer to, by number.
    pub textures: Vec<Texture>,
    /// Where meshes stand.
    pub instances: Vec<Instance>,
    /// Frames that move, those that others are in first.
    pub movers: Vec<Mover>,
    /// Meshes whose vertices move; at most one a mesh.
    pub deformers: Vec<Deformer>,
    /// Lights without extent.
    pub lights: Vec<Light>,
    /// Views by name; `default` is the one of a picture that names none.
    pub cameras: IndexMap<String, Camera>,
    /// Radiance of the sky: the same in every direction, or times that of the environment's picture.
    pub sky: Vec3,
    /// The sky as a picture.
    pub environment: Option<Environment>,
    /// The median distance of what the scene's own camera sees, when it was opened, m; 0: not known.
    pub seen_distance: f32,
    /// What is not as its author meant it (missing files, dropped triangles, stand-ins); each names the file.
    pub warnings: Vec<String>,
}

/// A vertex, in model space.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Vertex {
    /// Model space, m.
    pub position: [f32; 3],
    /// Unit length.
    pub normal: [f32; 3],
    /// Unit length; w is the sign of the bitangent `cross(normal, tangent) * w`, which points up in the normal map.
    pub tangent: [f32; 4],
    /// Where in textures; v grows downwards.
    pub uv: [f32; 2],
    /// Second set, for textures with [`Lookup::second_set`].
    pub uv_second: [f32; 2],
    /// Multiplies the base colour: linear RGB and alpha, 0 to 1.
    pub color: [f32; 4],
}

impl Default for Vertex {
    /// White, all else 0.
    fn default() -> Self {
        Vertex {
            color: [1.0; 4],
            ..Vertex::zeroed()
        }
    }
}

/// Indexed triangles in one model space, split into submeshes of one material each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// As the file calls it.
    pub name: String,
    /// In the order of the file.
    pub vertices: Vec<Vertex>,
    /// Three a triangle, counter-clockwise from its front.
    pub indices: Vec<u32>,
    /// Runs that cover all indices.
    pub submeshes: Vec<Submesh>,
}

/// A run of a mesh's indices that has one material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Submesh {
    /// Where it begins, in indices.
    pub first_index: u32,
    /// Three times its triangles.
    pub index_count: u32,
    /// A number in [`Scene::materials`].
    pub material: u32,
}

/// Metallic-roughness material; every texture multiplies the factor beside it.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct Material {
    /// As the file calls it.
    #[serde(skip)]
    pub name: String,
    /// Linear RGB and alpha.
    pub base_color: Vec4,
    /// 0 for what is no metal, to 1.
    pub metallic: f32,
    /// Perceptual roughness, 0 to 1.
    pub roughness: f32,
    /// Index of refraction of what is no metal; 0: it reflects all that `specular_color` lets it.
    pub ior: f32,
    /// Scales what it reflects specularly, 0 to 1, metals apart.
    pub specular: f32,
    /// Colours that at normal incidence.
    pub specular_color: Vec3,
    /// Emitted radiance.
    pub emission: Vec3,
    /// A fragment whose alpha is below this is not there; 0 = opaque, no mask.
    pub alpha_cutoff: f32,
    /// Whether its back is lit as its front is.
    pub two_sided: bool,
    /// Scales the x and y of the normal map.
    pub normal_scale: f32,
    /// RGB is decoded from sRGB; alpha is for the mask.
    pub base_color_texture: Option<u32>,
    /// G = roughness, B = metallic.
    pub metallic_roughness_texture: Option<u32>,
    /// In the space of the tangents.
    pub normal_texture: Option<u32>,
    /// RGB, decoded from sRGB.
    pub emission_texture: Option<u32>,
    /// How those are looked up.
    #[serde(skip)]
    pub lookups: Lookups,
    /// Whether the colour of vertices multiplies the emission too.
    #[serde(skip)]
    pub tinted_emission: bool,
}

impl Default for Material {
    fn default() -> Self {
        Material {
            name: "default".into(),
            base_color: Vec4::new(0.8, 0.8, 0.8, 1.0),
            metallic: 0.0,
            roughness: 1.0,
            ior: 1.5,
            specular: 1.0,
            specular_color: Vec3::ONE,
            emission: Vec3::ZERO,
            alpha_cutoff: 0.0,
            two_sided: false,
            normal_scale: 1.0,
            base_color_texture: None,
            metallic_roughness_texture: None,
            normal_texture: None,
            emission_texture: None,
            lookups: Lookups::default(),
            tinted_emission: false,
        }
    }
}

impl Mesh {
    /// Whether any vertex has a colour.
    pub(crate) fn has_colors(&self) -> bool {
        self.vertices.iter().any(|v| v.color != [1.0; 4])
    }
}

impl Material {
    /// Whether its mask cuts everything out.
    pub fn is_left_out(&self) -> bool {
        self.base_color.w < self.alpha_cutoff
    }

    /// Reflectance of the dielectric part at normal incidence, and in w at grazing angles (KHR_materials_specular); 0.04 and
    /// 1 unless the author says otherwise.
    pub fn dielectric(&self) -> Vec4 {
        let n = f64::from(self.ior);
        let from_index = if n == 0.0 {
            1.0
        } else {
            ((n - 1.0) / (n + 1.0)).powi(2) as f32
        };
        ((from_index * self.specular_color).min(Vec3::ONE) * self.specular).extend(self.specular)
    }
}

/// An image with its mip levels, ready for upload.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The file, or what it is in one.
    pub name: String,
    /// Texels of level 0.
    pub width: u32,
    /// Texels of level 0.
    pub height: u32,
    /// What its bytes are.
    pub format: TextureFormat,
    /// Level 0 first, tightly packed rows; the full chain unless the file stored a shorter one.
    pub mips: Vec<Vec<u8>>,
}

/// Texel formats. `Srgb` ones are decoded to linear when sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum TextureFormat {
    /// Four bytes, sRGB.
    Rgba8Srgb,
    /// Four bytes, linear.
    Rgba8Unorm,
    /// BC1 (DXT1): RGB and a bit of alpha in 8 bytes a block, sRGB.
    Bc1Srgb,
    /// BC1 (DXT1): RGB and a bit of alpha in 8 bytes a block, linear.
    Bc1Unorm,
    /// BC2 (DXT3): RGB and four bits of alpha, sRGB.
    Bc2Srgb,
    /// BC2 (DXT3): RGB and four bits of alpha, linear.
    Bc2Unorm,
    /// BC3 (DXT5): RGB and smooth alpha, sRGB.
    Bc3Srgb,
    /// BC3 (DXT5): RGB and smooth alpha, linear.
    Bc3Unorm,
    /// BC4: one channel, linear.
    Bc4Unorm,
    /// BC5: two channels, as of normals, linear.
    Bc5Unorm,
    /// BC7: RGBA, sRGB.
    Bc7Srgb,
    /// BC7: RGBA, linear.
    Bc7Unorm,
}

impl TextureFormat {
    /// Edge of a block in texels and its size in bytes: (1, 4) for RGBA8, (4, 8) or (4, 16) for BCn.
    pub fn block(self) -> (u32, usize) {
        use TextureFormat::*;
        match self {
            Rgba8Srgb | Rgba8Unorm => (1, 4),
            Bc1Srgb | Bc1Unorm | Bc4Unorm => (4, 8),
            _ => (4, 16),
        }
    }

    /// Bytes of one level of the given size.
    pub fn level_bytes(self, width: u32, height: u32) -> usize {
        let (edge, bytes) = self.block();
        width.div_ceil(edge) as usize * height.div_ceil(edge) as usize * bytes
    }

    /// Whether sampling decodes sRGB.
    pub fn is_srgb(self) -> bool {
        use TextureFormat::*;
        matches!(self, Rgba8Srgb | Bc1Srgb | Bc2Srgb | Bc3Srgb | Bc7Srgb)
    }
}

/// A mesh placed in the world, at rest or moving.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// As the file calls it.
    pub name: String,
    /// A number in [`Scene::meshes`].
    pub mesh: u32,
    /// From the model into the frame that it moves with, or into the world.
    pub transform: Mat4,
    /// A number in [`Scene::movers`]: what it moves with, if it moves.
    pub mover: Option<u32>,
}

/// Where a light's energy comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// A sun: parallel rays.
    Directional,
    /// A lamp that shines evenly in all directions.
    Point,
    /// Half-angles in radians: full strength inside `inner`, none outside `outer`.
    Spot {
        /// Radians.
        inner: f32,
        /// Radians, above `inner`.
        outer: f32,
    },
}

/// A light without extent. Emitting surfaces are materials instead.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// By which experiments change it.
    pub name: String,
    /// Sun, lamp or spot.
    pub kind: LightKind,
    /// Irradiance on a facing surface (W/m^2) for a directional light, radiant intensity (W/sr) otherwise.
    pub color: Vec3,
    /// World, m; without meaning for a directional light.
    pub position: Vec3,
    /// Unit length, the way the light travels.
    pub direction: Vec3,
    /// Whether it has a shadow map.
    pub shadow: bool,
}

/// A perspective view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// World, m.
    pub eye: Vec3,
    /// What is in the middle of the picture; world, m.
    pub target: Vec3,
    /// What is up in the picture; need not be at right angles to the view.
    pub up: Vec3,
    /// Vertical field of view in degrees.
    pub fov_y: f32,
    /// What is nearer is cut off.
    pub near: f32,
    /// Cuts off nothing; files have it. Infinite where nobody has said it.
    pub far: f32,
}
