//! The scene: triangles, materials, textures, lights, animation and cameras, all in main memory.
//!
//! Knows no graphics interface. World units are metres, y is up, the frame is right-handed, front faces
//! are counter-clockwise, and colours are linear RGB (only base-colour and emission images are sRGB).

pub mod builtin;
pub(crate) mod defaults;
pub(crate) mod environment;
mod error;
mod export;
mod file;
mod gltf;
mod limits;
mod mesh;
mod obj;
mod open;
mod progress;
mod reach;
mod resample;
mod shapes;
mod shuffle;
mod split;
mod summary;
mod texture;
mod transform;

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Quat, Vec3, Vec4};
use indexmap::IndexMap;
use serde::Deserialize;

pub use environment::{Environment, SUN, SkyPicture};
pub use error::SceneError;
pub use limits::MAX_COORDINATE;
pub use mesh::Side;
pub(crate) use shuffle::splitmix;
pub use split::MAX_TRIANGLES;
pub use texture::SmallPicture;
pub(crate) use transform::origin_of;

/// Everything that is rendered, and from where.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// What the scene was opened as: a built-in's name or a file's stem.
    pub name: String,
    pub meshes: Vec<Mesh>,
    pub materials: Vec<Material>,
    pub textures: Vec<Texture>,
    pub instances: Vec<Instance>,
    pub lights: Vec<Light>,
    pub cameras: IndexMap<String, Camera>,
    /// Radiance of the sky: the same in every direction, or times that of the environment's picture.
    pub sky: Vec3,
    /// The sky as a picture.
    pub environment: Option<Environment>,
    /// The median distance of what the scene's own camera sees, when it was opened [m]; 0: not known.
    pub seen_distance: f32,
    /// What is not as its author meant it (missing files, dropped triangles, stand-ins); each names the file.
    pub warnings: Vec<String>,
}

/// A vertex as it is uploaded: 48 bytes, model space.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Vertex {
    pub position: [f32; 3],
    /// Unit length.
    pub normal: [f32; 3],
    /// Unit length; w is the sign of the bitangent, `cross(normal, tangent) * w` (MikkTSpace).
    pub tangent: [f32; 4],
    pub uv: [f32; 2],
}

/// Indexed triangles in one model space, split into submeshes of one material each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    pub name: String,
    pub vertices: Vec<Vertex>,
    pub indices: Vec<u32>,
    pub submeshes: Vec<Submesh>,
}

/// A run of a mesh's indices that has one material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Submesh {
    pub first_index: u32,
    pub index_count: u32,
    pub material: u32,
}

/// Metallic-roughness material; every texture multiplies the factor beside it.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct Material {
    #[serde(skip)]
    pub name: String,
    /// Linear RGB and alpha.
    pub base_color: Vec4,
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
    pub two_sided: bool,
    /// Scales the x and y of the normal map.
    pub normal_scale: f32,
    pub base_color_texture: Option<u32>,
    /// G = roughness, B = metallic.
    pub metallic_roughness_texture: Option<u32>,
    pub normal_texture: Option<u32>,
    pub emission_texture: Option<u32>,
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
        }
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
        let from_index = if n == 0.0 { 1.0 } else { ((n - 1.0) / (n + 1.0)).powi(2) as f32 };
        ((from_index * self.specular_color).min(Vec3::ONE) * self.specular).extend(self.specular)
    }
}

/// An image with its mip levels, ready for upload.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    pub name: String,
    pub width: u32,
    pub height: u32,
    pub format: TextureFormat,
    /// Level 0 first, tightly packed rows; the full chain unless the file stored a shorter one.
    pub mips: Vec<Vec<u8>>,
}

/// Texel formats. `Srgb` ones are decoded to linear when sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum TextureFormat {
    Rgba8Srgb,
    Rgba8Unorm,
    Bc1Srgb,
    Bc1Unorm,
    Bc2Srgb,
    Bc2Unorm,
    Bc3Srgb,
    Bc3Unorm,
    Bc4Unorm,
    Bc5Unorm,
    Bc7Srgb,
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
    pub name: String,
    pub mesh: u32,
    pub transform: Mat4,
    pub animation: Option<Animation>,
}

/// Motion of a rigid body, applied after (to the left of) the instance's transform.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Animation {
    /// In order of time; translation is interpolated linearly, rotation spherically.
    pub keyframes: Vec<Keyframe>,
    /// Start over after the last keyframe; otherwise stay there.
    pub repeat: bool,
}

/// A pose at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keyframe {
    /// Seconds.
    pub time: f32,
    pub translation: Vec3,
    pub rotation: Quat,
}

/// Where a light's energy comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    Directional,
    Point,
    /// Half-angles in radians: full strength inside `inner`, none outside `outer`.
    Spot {
        inner: f32,
        outer: f32,
    },
}

/// A light without extent. Emitting surfaces are materials instead.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    pub name: String,
    pub kind: LightKind,
    /// Irradiance on a facing surface (W/m^2) for a directional light, radiant intensity (W/sr) otherwise.
    pub color: Vec3,
    pub position: Vec3,
    /// Unit length, the way the light travels.
    pub direction: Vec3,
    pub shadow: bool,
}

/// A perspective view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    pub eye: Vec3,
    pub target: Vec3,
    pub up: Vec3,
    /// Vertical field of view in degrees.
    pub fov_y: f32,
    /// What is nearer is cut off.
    pub near: f32,
    /// Cuts off nothing; files have it. Infinite where nobody has said it.
    pub far: f32,
}
