//! The scene: triangles, materials, textures, lights, animation and cameras in main memory.
//!
//! Independent of the graphics API. World units are metres, y is up, the frame is right-handed,
//! front faces are counter-clockwise, and colours are linear RGB. Only base-colour and emission
//! images are sRGB.

pub mod builtin;
mod clips;
mod coordinates;
pub(crate) mod defaults;
pub(crate) mod environment;
mod error;
mod export;
mod fbx;
mod file;
mod formats;
mod gltf;
pub(crate) mod light;
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
pub(crate) use file::missing_model;
pub(crate) use formats::{SCENE_FILE, extensions, model_extensions};
pub use light::{Light, LightFields, LightKind};
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
    /// A built-in's name or a file's stem.
    pub name: String,
    /// Triangle meshes, each in its own model space.
    pub meshes: Vec<Mesh>,
    /// Materials, referenced by index.
    pub materials: Vec<Material>,
    /// Textures, referenced by index.
    pub textures: Vec<Texture>,
    /// Meshes placed in the world.
    pub instances: Vec<Instance>,
    /// Moving frames; a parent comes before its children.
    pub movers: Vec<Mover>,
    /// Deformers, at most one per mesh.
    pub deformers: Vec<Deformer>,
    /// Lights.
    pub lights: Vec<Light>,
    /// Views by name; `default` is used if a picture names none.
    pub cameras: IndexMap<String, Camera>,
    /// Uniform radiance of the sky, or the factor of the environment map.
    pub sky: Vec3,
    /// The environment map.
    pub environment: Option<Environment>,
    /// Median distance visible from the default camera when the scene was opened (m); 0 if unknown.
    pub seen_distance: f32,
    /// Whether the default camera of a model without lights is in a closed room, which the default
    /// sun and sky do not light.
    pub enclosed: bool,
    /// Deviations from the source file (missing files, dropped triangles, placeholders); each names
    /// the file.
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
    /// Unit length; w is the sign of the bitangent `cross(normal, tangent) * w`, which points up in
    /// the normal map.
    pub tangent: [f32; 4],
    /// Texture coordinates; v grows downwards.
    pub uv: [f32; 2],
    /// Second set of texture coordinates, for textures with [`Lookup::second_set`].
    pub uv_second: [f32; 2],
    /// Multiplies the base colour: linear RGB and alpha, 0 to 1.
    pub color: [f32; 4],
}

impl Default for Vertex {
    /// A white vertex; everything else is 0.
    fn default() -> Self {
        Vertex {
            color: [1.0; 4],
            ..Vertex::zeroed()
        }
    }
}

/// Indexed triangles in one model space, split into submeshes with one material each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Name from the file.
    pub name: String,
    /// In the order of the file.
    pub vertices: Vec<Vertex>,
    /// Three per triangle, counter-clockwise seen from the front.
    pub indices: Vec<u32>,
    /// Ranges that cover all indices.
    pub submeshes: Vec<Submesh>,
}

/// A range of a mesh's indices with one material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Submesh {
    /// Offset in indices.
    pub first_index: u32,
    /// Three per triangle.
    pub index_count: u32,
    /// Index into [`Scene::materials`].
    pub material: u32,
}

/// Metallic-roughness material; each texture multiplies its factor.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct Material {
    /// Name from the file.
    #[serde(skip)]
    pub name: String,
    /// Linear RGB and alpha.
    pub base_color: Vec4,
    /// 0 (dielectric) to 1 (metal).
    pub metallic: f32,
    /// Perceptual roughness, 0 to 1.
    pub roughness: f32,
    /// Index of refraction of a dielectric; 0 removes the Fresnel limit, so that `specular_color`
    /// alone decides.
    pub ior: f32,
    /// Factor of the dielectric specular reflection, 0 to 1.
    pub specular: f32,
    /// Tint of the dielectric reflection at normal incidence.
    pub specular_color: Vec3,
    /// Emitted radiance.
    pub emission: Vec3,
    /// Fragments with a lower alpha are discarded; 0 disables the mask.
    pub alpha_cutoff: f32,
    /// Whether back faces are shaded like front faces.
    pub two_sided: bool,
    /// Scales the x and y of the normal map.
    pub normal_scale: f32,
    /// sRGB colour; alpha is the mask.
    pub base_color_texture: Option<u32>,
    /// G = roughness, B = metallic.
    pub metallic_roughness_texture: Option<u32>,
    /// Tangent-space normals.
    pub normal_texture: Option<u32>,
    /// sRGB colour.
    pub emission_texture: Option<u32>,
    /// Lookups of these textures.
    #[serde(skip)]
    pub lookups: Lookups,
    /// Whether vertex colours multiply the emission too.
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
    /// Whether the mask discards the whole surface.
    pub fn is_left_out(&self) -> bool {
        self.base_color.w < self.alpha_cutoff
    }

    /// Reflectance of the dielectric part at normal incidence (xyz) and at grazing angles (w), as
    /// in KHR_materials_specular. Default: 0.04 and 1.
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

/// An image with its mip levels, ready to upload.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The file, or a name inside a model file.
    pub name: String,
    /// Texels of level 0.
    pub width: u32,
    /// Texels of level 0.
    pub height: u32,
    /// Encoding of the texels.
    pub format: TextureFormat,
    /// Level 0 first, tightly packed rows; the full chain unless the file stores a shorter one.
    pub mips: Vec<Vec<u8>>,
}

/// Texel formats. `Srgb` ones are decoded to linear when sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum TextureFormat {
    /// Four bytes, sRGB.
    Rgba8Srgb,
    /// Four bytes, linear.
    Rgba8Unorm,
    /// BC1 (DXT1): RGB and 1-bit alpha, 8 bytes per block, sRGB.
    Bc1Srgb,
    /// BC1 (DXT1): RGB and 1-bit alpha, 8 bytes per block, linear.
    Bc1Unorm,
    /// BC2 (DXT3): RGB and 4-bit alpha, sRGB.
    Bc2Srgb,
    /// BC2 (DXT3): RGB and 4-bit alpha, linear.
    Bc2Unorm,
    /// BC3 (DXT5): RGB and interpolated alpha, sRGB.
    Bc3Srgb,
    /// BC3 (DXT5): RGB and interpolated alpha, linear.
    Bc3Unorm,
    /// BC4: one channel, linear.
    Bc4Unorm,
    /// BC5: two channels, for example normals, linear.
    Bc5Unorm,
    /// BC7: RGBA, sRGB.
    Bc7Srgb,
    /// BC7: RGBA, linear.
    Bc7Unorm,
}

impl TextureFormat {
    /// Side of a block in texels and its size in bytes: (1, 4) for RGBA8, (4, 8) or (4, 16) for
    /// BCn.
    pub fn block(self) -> (u32, usize) {
        use TextureFormat::*;
        match self {
            Rgba8Srgb | Rgba8Unorm => (1, 4),
            Bc1Srgb | Bc1Unorm | Bc4Unorm => (4, 8),
            _ => (4, 16),
        }
    }

    /// Bytes of one mip level.
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

/// A placed mesh, static or moving.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// Name from the file.
    pub name: String,
    /// Index into [`Scene::meshes`].
    pub mesh: u32,
    /// From model space to the mover's frame, or to the world.
    pub transform: Mat4,
    /// Index into [`Scene::movers`]; `None` for a static instance.
    pub mover: Option<u32>,
}

/// A perspective camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// World, m.
    pub eye: Vec3,
    /// Point in the centre of the picture; world (m).
    pub target: Vec3,
    /// Up direction; need not be orthogonal to the view.
    pub up: Vec3,
    /// Vertical field of view in degrees.
    pub fov_y: f32,
    /// Distance of the near plane (m).
    pub near: f32,
    /// Distance of the far plane (m); unused when rendering, kept for export. Default: infinity.
    pub far: f32,
}
