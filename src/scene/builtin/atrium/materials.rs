//! Materials of the atrium, by number, and their images.

use glam::Vec3;

use crate::scene::builtin::{matte, patterns};
use crate::scene::{Material, Texture};

pub(super) const FLOOR: u32 = 0;
pub(super) const ASHLAR: u32 = 1;
pub(super) const BRICK: u32 = 2;
pub(super) const TRIM: u32 = 3;
pub(super) const MARBLE: u32 = 4;
pub(super) const ROOF: u32 = 5;
pub(super) const WOOD: u32 = 6;
pub(super) const PLASTER: u32 = 7;
pub(super) const RED: u32 = 8;
pub(super) const GREEN: u32 = 9;
pub(super) const BLUE: u32 = 10;
pub(super) const IRON: u32 = 11;
pub(super) const GOLD: u32 = 12;
pub(super) const LEAVES: u32 = 13;
pub(super) const POT: u32 = 14;
pub(super) const GLOW: u32 = 15;
pub(super) const WATER: u32 = 16;
pub(super) const SOIL: u32 = 17;
pub(super) const COPPER: u32 = 18;

/// All materials in the order of their numbers, and all textures.
pub(super) fn all() -> (Vec<Material>, Vec<Texture>) {
    let mut textures = Vec::new();
    let mut add = |texture: Texture| {
        textures.push(texture);
        Some(textures.len() as u32 - 1)
    };
    let textured = |name: &str, image: Option<u32>, roughness: f32| Material {
        base_color_texture: image,
        roughness,
        ..matte(name, Vec3::ONE)
    };
    let metal = |name: &str, color: Vec3, roughness: f32| Material { metallic: 1.0, roughness, ..matte(name, color) };
    let mut cloth = |name: &str, color: Vec3| Material {
        two_sided: true,
        ..textured(name, add(patterns::color(name, 512, |u, v| patterns::cloth(u, v, color))), 0.9)
    };
    let (red, green, blue) = (
        cloth("red cloth", Vec3::new(0.80, 0.07, 0.06)),
        cloth("green cloth", Vec3::new(0.08, 0.56, 0.16)),
        cloth("blue cloth", Vec3::new(0.09, 0.20, 0.74)),
    );
    let materials = vec![
        Material {
            normal_texture: add(patterns::normals("floor normals", 512, 2.0, patterns::floor_height)),
            metallic_roughness_texture: add(patterns::roughness("floor roughness", 512, patterns::floor_roughness)),
            ..textured("floor tiles", add(patterns::color("floor tiles", 512, patterns::floor_tile)), 1.0)
        },
        Material {
            normal_texture: add(patterns::normals("ashlar normals", 512, 2.0, patterns::ashlar_height)),
            ..textured("ashlar", add(patterns::color("ashlar", 512, patterns::ashlar)), 0.85)
        },
        Material {
            normal_texture: add(patterns::normals("brick normals", 512, 1.0, patterns::brick_height)),
            ..textured("brick", add(patterns::color("brick", 512, patterns::brick)), 0.9)
        },
        matte("limestone trim", Vec3::new(0.72, 0.65, 0.54)),
        textured("marble", add(patterns::color("marble", 256, patterns::marble)), 0.45),
        textured("roof tiles", add(patterns::color("roof tiles", 256, patterns::terracotta)), 0.85),
        textured("wood", add(patterns::color("wood", 512, patterns::wood)), 0.6),
        matte("plaster", Vec3::new(0.80, 0.74, 0.64)),
        red,
        green,
        blue,
        metal("iron", Vec3::new(0.22, 0.21, 0.20), 0.45),
        metal("gold", Vec3::new(1.0, 0.76, 0.33), 0.18),
        Material {
            alpha_cutoff: 0.5,
            two_sided: true,
            ..textured("leaves", add(patterns::masked("leaves", 256, patterns::leaves)), 0.7)
        },
        matte("terracotta", Vec3::new(0.46, 0.19, 0.10)),
        Material { emission: Vec3::new(30.0, 17.0, 6.5), ..matte("lantern glass", Vec3::new(0.8, 0.7, 0.5)) },
        Material { roughness: 0.05, ..matte("water", Vec3::new(0.02, 0.06, 0.07)) },
        matte("soil", Vec3::new(0.06, 0.04, 0.03)),
        metal("copper", Vec3::new(0.95, 0.55, 0.38), 0.32),
    ];
    (materials, textures)
}
