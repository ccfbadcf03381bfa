//! Procedural textures. Colours are sRGB in 0..1; textures tile unless stated otherwise.

use glam::{Vec2, Vec3, Vec4};
use serde::Deserialize;

use super::noise::{fractal, hash, value};
use crate::scene::texture::{Filter, texture_from_rgba};
use crate::scene::{Texture, TextureFormat};

/// Largest side of a procedural texture.
const MAX_SIZE: u32 = 2048;

/// A procedural texture.
#[derive(Debug, Deserialize)]
#[serde(try_from = "PictureFields")]
pub(in crate::scene) struct Picture(PictureFields);

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct PictureFields {
    name: String,
    /// Width and height in texels.
    size: u32,
    pattern: Pattern,
}

/// The pattern. Normal maps use its height field over a square of the given size (m).
#[derive(Clone, Copy, Debug, Deserialize)]
enum Pattern {
    Ashlar,
    AshlarNormals(f32),
    Brick,
    BrickNormals(f32),
    FloorTiles,
    FloorNormals(f32),
    FloorRoughness,
    Marble,
    RoofTiles,
    Wood,
    Cloth(Vec3),
    /// With alpha, for a cutoff of 0.5.
    Leaves,
}

impl TryFrom<PictureFields> for Picture {
    type Error = String;

    fn try_from(fields: PictureFields) -> Result<Self, String> {
        match fields.size {
            1..=MAX_SIZE => Ok(Picture(fields)),
            size => Err(format!(
                "a texture of {size} texels: it must have from 1 to {MAX_SIZE} a side"
            )),
        }
    }
}

impl Picture {
    pub fn draw(&self) -> Texture {
        let PictureFields {
            name,
            size,
            pattern,
        } = &self.0;
        let color = |texel: fn(f32, f32) -> Vec3| {
            srgb(name, *size, Filter::Plain, |u, v| texel(u, v).extend(1.0))
        };
        match *pattern {
            Pattern::Ashlar => color(ashlar),
            Pattern::AshlarNormals(extent) => normals(name, *size, extent, ashlar_height),
            Pattern::Brick => color(brick),
            Pattern::BrickNormals(extent) => normals(name, *size, extent, brick_height),
            Pattern::FloorTiles => color(floor_tile),
            Pattern::FloorNormals(extent) => normals(name, *size, extent, floor_height),
            Pattern::FloorRoughness => {
                let rgba = texels(*size, |u, v| {
                    Vec4::new(1.0, floor_roughness(u, v), 0.0, 1.0)
                });
                texture_from_rgba(
                    name,
                    *size,
                    *size,
                    rgba,
                    TextureFormat::Rgba8Unorm,
                    Filter::Plain,
                )
            }
            Pattern::Marble => color(marble),
            Pattern::RoofTiles => color(terracotta),
            Pattern::Wood => color(wood),
            Pattern::Cloth(of) => srgb(name, *size, Filter::Plain, |u, v| {
                cloth(u, v, of).extend(1.0)
            }),
            Pattern::Leaves => srgb(name, *size, Filter::Masked(0.5), leaves),
        }
    }
}

fn srgb(name: &str, size: u32, filter: Filter, texel: impl Fn(f32, f32) -> Vec4) -> Texture {
    texture_from_rgba(
        name,
        size,
        size,
        texels(size, texel),
        TextureFormat::Rgba8Srgb,
        filter,
    )
}

/// A normal map from heights in metres over a square of `extent` metres.
fn normals(name: &str, size: u32, extent: f32, height: fn(f32, f32) -> f32) -> Texture {
    let step = 1.0 / size as f32;
    let rgba = texels(size, |u, v| {
        let du = height((u + step).fract(), v) - height((u - step + 1.0).fract(), v);
        let dv = height(u, (v + step).fract()) - height(u, (v - step + 1.0).fract());
        // Green points up while v points down.
        let slope = Vec2::new(-du, dv) / (2.0 * step * extent);
        (slope.extend(1.0).normalize() * 0.5 + 0.5).extend(1.0)
    });
    texture_from_rgba(
        name,
        size,
        size,
        rgba,
        TextureFormat::Rgba8Unorm,
        Filter::Normal,
    )
}

fn texels(size: u32, texel: impl Fn(f32, f32) -> Vec4) -> Vec<u8> {
    let centre = |i: u32| (i as f32 + 0.5) / size as f32;
    let byte = |c: f32| (c.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
    let mut rgba = Vec::with_capacity(size as usize * size as usize * 4);
    for y in 0..size {
        for x in 0..size {
            rgba.extend(texel(centre(x), centre(y)).to_array().map(byte));
        }
    }
    rgba
}

/// A position in a wall of blocks: the block's random number and the depth inside it, 0 in the
/// joint.
struct Block {
    random: f32,
    depth: f32,
}

/// Running bond of `rows` by `columns` blocks; the joint width is in tiles.
fn masonry(u: f32, v: f32, rows: i32, columns: i32, joint: f32) -> Block {
    let y = v * rows as f32;
    let row = y.floor() as i32;
    let x = u * columns as f32 + if row % 2 == 0 { 0.0 } else { 0.5 };
    let column = (x.floor() as i32).rem_euclid(columns);
    let (fx, fy) = (x - x.floor(), y - y.floor());
    let edge_x = fx.min(1.0 - fx) / columns as f32;
    let edge_y = fy.min(1.0 - fy) / rows as f32;
    let depth = ((edge_x.min(edge_y) - joint) / joint).clamp(0.0, 1.0);
    Block {
        random: hash(column, row, 7),
        depth,
    }
}

/// Warm limestone blocks.
fn ashlar(u: f32, v: f32) -> Vec3 {
    let block = masonry(u, v, 4, 2, 0.004);
    let grain = fractal(u, v, 12, 3);
    let stain = fractal(u, v, 3, 21);
    let stone = Vec3::new(0.86, 0.80, 0.70) * (0.86 + 0.14 * block.random + 0.10 * (grain - 0.5));
    let stone = stone.lerp(Vec3::new(0.72, 0.64, 0.53), (stain - 0.45).clamp(0.0, 1.0));
    Vec3::new(0.55, 0.50, 0.43).lerp(stone, block.depth)
}

/// Heights of [`ashlar`] in metres.
fn ashlar_height(u: f32, v: f32) -> f32 {
    0.010 * masonry(u, v, 4, 2, 0.004).depth + 0.006 * fractal(u, v, 16, 3)
}

/// Red-brown bricks.
fn brick(u: f32, v: f32) -> Vec3 {
    let block = masonry(u, v, 12, 4, 0.006);
    let grain = fractal(u, v, 24, 5);
    let dark = Vec3::new(0.50, 0.27, 0.20);
    let light = Vec3::new(0.74, 0.46, 0.34);
    let clay = dark.lerp(light, block.random) * (0.85 + 0.3 * (grain - 0.5));
    Vec3::new(0.72, 0.68, 0.61).lerp(clay, block.depth)
}

/// Heights of [`brick`] in metres.
fn brick_height(u: f32, v: f32) -> f32 {
    let block = masonry(u, v, 12, 4, 0.006);
    0.008 * block.depth * (0.8 + 0.2 * block.random) + 0.004 * fractal(u, v, 32, 5)
}

/// Chequered marble tiles, 4 by 4, with thin grout.
fn floor_tile(u: f32, v: f32) -> Vec3 {
    let (i, j, depth) = tile(u, v);
    let vein = vein(u, v, 31 + (i + j) as u32 % 2);
    let light = Vec3::new(0.88, 0.84, 0.77) - Vec3::splat(0.14) * vein;
    let dark = Vec3::new(0.50, 0.32, 0.25) + Vec3::splat(0.16) * vein;
    let stone = if (i + j) % 2 == 0 { light } else { dark } * (0.92 + 0.12 * hash(i, j, 9));
    Vec3::new(0.45, 0.42, 0.38).lerp(stone, depth)
}

/// Heights of [`floor_tile`] in metres.
fn floor_height(u: f32, v: f32) -> f32 {
    0.004 * tile(u, v).2
}

/// Roughness of [`floor_tile`]: polished stone, rough grout.
fn floor_roughness(u: f32, v: f32) -> f32 {
    let (i, j, depth) = tile(u, v);
    let polished = 0.22 + 0.16 * hash(i, j, 11) + 0.2 * (fractal(u, v, 8, 40) - 0.4).max(0.0);
    0.9 + (polished - 0.9) * depth
}

fn tile(u: f32, v: f32) -> (i32, i32, f32) {
    let (x, y) = (u * 4.0, v * 4.0);
    let (fx, fy) = (x - x.floor(), y - y.floor());
    let edge = fx.min(1.0 - fx).min(fy).min(1.0 - fy);
    (
        x.floor() as i32,
        y.floor() as i32,
        ((edge - 0.012) / 0.012).clamp(0.0, 1.0),
    )
}

/// Thin dark lines along a contour of the noise.
fn vein(u: f32, v: f32, seed: u32) -> f32 {
    let warped = fractal(u, v, 4, seed);
    (1.0 - (warped - 0.5).abs() * 14.0).clamp(0.0, 1.0)
}

/// Pale marble with grey veins.
fn marble(u: f32, v: f32) -> Vec3 {
    let base = Vec3::new(0.92, 0.89, 0.83) * (0.94 + 0.1 * (fractal(u, v, 6, 50) - 0.5));
    base.lerp(Vec3::new(0.66, 0.62, 0.57), 0.55 * vein(u, v, 51))
}

/// Terracotta with weathering.
fn terracotta(u: f32, v: f32) -> Vec3 {
    let course = (v * 8.0).fract();
    let random = hash((u * 8.0) as i32, (v * 8.0) as i32, 60);
    let clay = Vec3::new(0.62, 0.33, 0.22).lerp(Vec3::new(0.78, 0.48, 0.33), random);
    clay * (0.8 + 0.3 * fractal(u, v, 16, 61)) * if course < 0.08 { 0.6 } else { 1.0 }
}

/// Dark planks along v.
fn wood(u: f32, v: f32) -> Vec3 {
    let plank = (u * 6.0).floor() as i32;
    let edge = (u * 6.0).fract();
    let grain = value(u, v * 0.12, 96, 70 + plank as u32) * 0.6 + fractal(u, v, 8, 71) * 0.4;
    let tone = Vec3::new(0.34, 0.21, 0.12).lerp(Vec3::new(0.52, 0.35, 0.21), grain);
    tone * (0.85 + 0.3 * hash(plank, 0, 72))
        * if !(0.03..=0.97).contains(&edge) {
            0.45
        } else {
            1.0
        }
}

/// Woven cloth with lozenges; has hems over the whole texture, so it does not tile.
fn cloth(u: f32, v: f32, color: Vec3) -> Vec3 {
    let gold = Vec3::new(0.86, 0.66, 0.28);
    let weave = 0.94 + 0.06 * ((u * 400.0).sin() * (v * 400.0).sin());
    let (x, y) = ((u * 6.0).fract() - 0.5, (v * 12.0).fract() - 0.5);
    let lozenge = x.abs() + y.abs();
    let flower = (x * x + y * y).sqrt() - 0.10 - 0.05 * (4.0 * y.atan2(x)).cos();
    let figure = (lozenge < 0.40 && lozenge > 0.34) || flower < 0.0;
    let ground = if figure { color * 0.72 } else { color };
    let hem = !(0.035..=0.965).contains(&u) || v > 0.955 || (v > 0.90 && v < 0.93) || v < 0.02;
    (if hem { gold } else { ground }) * weave
}

/// A sprig of seven pointed leaves on a stem; transparent around it, does not tile.
fn leaves(u: f32, v: f32) -> Vec4 {
    let p = Vec2::new(u - 0.5, 1.0 - v);
    let stem_x = 0.03 * (p.y * 7.0).sin();
    let mut color = Vec3::new(0.20, 0.32, 0.10);
    let mut alpha: f32 = if (p.x - stem_x).abs() < 0.012 && p.y < 0.85 {
        1.0
    } else {
        0.0
    };
    for i in 0..7 {
        let height = 0.10 + 0.115 * i as f32;
        let side = if i == 6 { 0.0 } else { [1.0, -1.0][i % 2] };
        let root = Vec2::new(0.03 * (height * 7.0).sin(), height);
        let along = Vec2::new(side * 0.85, if i == 6 { 1.0 } else { 0.5 }).normalize();
        let q = Vec2::new((p - root).dot(along), (p - root).perp_dot(along));
        let length = 0.40 - 0.028 * i as f32;
        let t = q.x / length;
        if !(0.0..1.0).contains(&t) {
            continue;
        }
        let width = 0.13 * (t * (1.0 - t)).sqrt() * (1.25 - 0.6 * t);
        if q.y.abs() < width {
            let rib = 1.0 - (q.y.abs() / 0.006).min(1.0);
            let tone = 0.75 + 0.4 * hash(i as i32, 0, 80) + 0.12 * (fractal(u, v, 16, 81) - 0.5);
            color = Vec3::new(0.30, 0.50, 0.16) * tone + Vec3::new(0.10, 0.12, 0.04) * rib;
            alpha = 1.0;
        }
    }
    color.extend(alpha)
}
