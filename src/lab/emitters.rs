//! Emitting triangles as shaders draw places on them (`shaders/lights/emitters.glsl`).

use super::attributes::{color_of, uv_of};
use super::interface::blocks::{EmitterBlock, InstanceBlock};
use super::shape::Shape;
use crate::scene::{Lookup, Material, Scene, Side, SmallPicture};
use glam::{Mat4, Vec2, Vec3, Vec4};
use std::collections::{HashMap, HashSet};

/// More emitting triangles than these are met by rays alone: 64 bytes each.
const MOST_EMITTERS: usize = 1 << 20;

/// Ratio of an emitter's largest radiance to the mean of all surfaces up to which rays find it as
/// well as emitter samples do.
const UNEVEN: f64 = 4.0;

/// Fraction of the scene's diagonal above which a closed emitter may enclose the scene, so that
/// both sides emit.
const LARGEST_LAMP: f32 = 0.25;

/// Most parts of a textured triangle's edge. Each of its parts has one radiance.
const MOST_PARTS: u32 = 8;

/// Parts of an edge if the corners of the triangle have different colours.
const TINTED_PARTS: u32 = 4;

/// Texels of an emission texture along an edge of a part.
const TEXELS: u32 = 128;

/// A triangle that emits, by parts of one radiance.
#[derive(Clone, Debug)]
struct Emitter {
    /// Draw and first index.
    key: (u32, u32),
    instance: u32,
    /// Model space.
    corners: [Vec3; 3],
    /// The only one that is seen.
    outside: Option<Side>,
    /// Parts of an edge; there are as many as its square, in the order of [`part_corners`].
    parts: u32,
    radiance: Vec<Vec3>,
}

/// All of a scene, whatever its pose.
#[derive(Clone, Debug, Default)]
pub(super) struct Emitters {
    /// Area of all triangles, also of those that emit nothing [m^2].
    surface: f64,
    list: Vec<Emitter>,
    /// Number of the first part, and count of parts along an edge, by draw and first index.
    numbers: HashMap<(u32, u32), (u32, u32)>,
}

impl Emitters {
    /// Numbers the parts by what triangles hold: no file's order shows.
    fn number_parts(&mut self) {
        let content = |e: &Emitter| {
            let bits = |v: &Vec3| v.to_array().map(f32::to_bits);
            let radiance: Vec<_> = e.radiance.iter().map(bits).collect();
            (e.instance, e.corners.each_ref().map(bits), radiance)
        };
        self.list.sort_by_cached_key(content);
        let mut next = 0;
        for emitter in &self.list {
            self.numbers.insert(emitter.key, (next, emitter.parts));
            next += emitter.parts * emitter.parts;
        }
    }

    /// Parts of all emitting triangles; none if there are more than [`MOST_EMITTERS`].
    pub(super) fn new(scene: &Scene, shape: &Shape) -> Emitters {
        let (mut pictures, mut outsides) = (HashMap::new(), HashMap::<_, Vec<Option<Side>>>::new());
        let (low, high) = scene.bounds();
        let (mut found, mut count) = (Emitters::default(), 0u32);
        for (number, draw) in (0u32..).zip(&shape.draws) {
            let Some(material) = scene.materials.get(draw.material as usize) else {
                continue;
            };
            let model = scene.instance_transform(draw.instance as usize, 0.0);
            let triangles = (draw.first_index..draw.first_index + draw.index_count).step_by(3);
            let triangles = triangles.map(|first| {
                let vertices = [0, 1, 2].map(|k| shape.indices[(first + k) as usize] as usize);
                let corner = |v: usize| Vec3::from_slice(&shape.positions[3 * v..3 * v + 3]);
                (first, vertices, vertices.map(corner))
            });
            for (_, _, corners) in triangles.clone() {
                let [a, b, c] = corners.map(|c| model.transform_point3(c));
                let area = 0.5 * f64::from((b - a).cross(c - a).length());
                found.surface += if area.is_finite() { area } else { 0.0 };
            }
            if material.emission == Vec3::ZERO {
                continue;
            }
            let Some(mesh) = scene.instances.get(draw.instance as usize).map(|i| i.mesh) else {
                continue;
            };
            let outside = outsides.entry(mesh).or_insert_with(|| {
                let scale = model.to_scale_rotation_translation().0.abs().max_element();
                let longest = LARGEST_LAMP * (high - low).length() / scale;
                let mesh = scene.meshes.get(mesh as usize);
                mesh.map_or_else(Vec::new, |m| m.outsides(longest))
            });
            let shine = Shine::new(scene, material, &mut pictures);
            for (first, vertices, corners) in triangles {
                let uvs = vertices.map(|v| uv_of(&shape.attributes[v]));
                let tints = vertices.map(|v| color_of(&shape.attributes[v]));
                let parts = shine.parts(uvs, tints);
                let mean = |part| {
                    let uvs = part_corners(uvs, parts, part);
                    shine.mean(uvs, part_corners(tints, parts, part))
                };
                let radiance = (0..parts * parts).map(mean).collect();
                count += parts * parts;
                if count as usize > MOST_EMITTERS {
                    return Emitters::default();
                }
                let triangle = (first - shape.first_index[mesh as usize]) as usize / 3;
                found.list.push(Emitter {
                    key: (number, first),
                    instance: draw.instance,
                    corners,
                    outside: outside.get(triangle).copied().flatten(),
                    parts,
                    radiance,
                });
            }
        }
        found.number_parts();
        found
    }

    /// Where a triangle's parts are in the buffer, for rays that hit it: the number of the first
    /// and one, and from bit 24 on the parts of an edge; 0 of one that emits nothing.
    pub(super) fn number(&self, draw: u32, first_index: u32) -> u32 {
        self.numbers
            .get(&(draw, first_index))
            .map_or(0, |(number, parts)| (number + 1) | (parts << 24))
    }

    /// Whether any of them moves or changes its shape.
    pub(super) fn move_in(&self, scene: &Scene) -> bool {
        let deforming: HashSet<u32> = scene.deformers.iter().map(|d| d.mesh).collect();
        let moves = |e: &Emitter| {
            let instance = scene.instances.get(e.instance as usize);
            instance.is_some_and(|i| i.mover.is_some() || deforming.contains(&i.mesh))
        };
        self.list.iter().any(moves)
    }

    /// Content of the buffer `emitters` in the pose of these instances, with corners from positions
    /// and indices where vertices have moved.
    pub(super) fn buffer(
        &self,
        instances: &[InstanceBlock],
        posed: Option<(&[f32], &[u32])>,
    ) -> Vec<u8> {
        let mut blocks = Vec::new();
        for emitter in &self.list {
            let model = instances.get(emitter.instance as usize);
            let model = model.map_or(Mat4::IDENTITY, |b| Mat4::from_cols_array(&b.model));
            let moved = posed
                .and_then(|posed| corners_at(posed, emitter.key.1))
                .unwrap_or(emitter.corners);
            let corners = moved.map(|c| model.transform_point3(c));
            let front = emitter
                .outside
                .map(|side| (side == Side::Front) == (model.determinant() > 0.0));
            for (part, radiance) in (0u32..).zip(&emitter.radiance) {
                let [a, b, c] = part_corners(corners, emitter.parts, part);
                blocks.push(EmitterBlock {
                    a: a.to_array(),
                    to_b: (b - a).to_array(),
                    to_c: (c - a).to_array(),
                    radiance: radiance.to_array(),
                    chance: 0.0,
                    other: 0,
                    sides: front.map_or(0, |front| if front { 1 } else { 2 }),
                    density: 0.0,
                });
            }
        }
        let power: Vec<f64> = blocks.iter().map(power_of).collect();
        let all: f64 = power.iter().sum();
        let brightest = blocks
            .iter()
            .map(|b| f64::from(luminance(b.radiance.into())))
            .fold(0.0, f64::max);
        let known = all > 0.0 && all.is_finite() && brightest * self.surface > UNEVEN * all;
        if known {
            choose(&mut blocks, &power, all);
        }
        let count = if known {
            u32::try_from(blocks.len()).unwrap_or(0)
        } else {
            0
        };
        let head = [count, (all as f32).to_bits(), 0, 0];
        // There is always one to bind.
        blocks.resize(blocks.len().max(1), bytemuck::Zeroable::zeroed());
        [
            bytemuck::cast_slice::<u32, u8>(&head),
            bytemuck::cast_slice(&blocks),
        ]
        .concat()
    }
}

/// The corners of the triangle with these indices.
fn corners_at((positions, indices): (&[f32], &[u32]), first: u32) -> Option<[Vec3; 3]> {
    let corners = indices.get(first as usize..)?.first_chunk::<3>()?;
    let corner = |i: u32| {
        positions
            .get(3 * i as usize..)?
            .first_chunk::<3>()
            .copied()
            .map(Vec3::from)
    };
    let [a, b, c] = corners.map(corner);
    Some([a?, b?, c?])
}

/// Luminance times area.
fn power_of(block: &EmitterBlock) -> f64 {
    let area = 0.5 * f64::from(Vec3::from(block.to_b).cross(block.to_c.into()).length());
    let power = area * f64::from(luminance(block.radiance.into()));
    if power.is_finite() { power } else { 0.0 }
}

/// As `luminance` of `lights/emitters.glsl`.
fn luminance(c: Vec3) -> f32 {
    c.dot(Vec3::new(0.2126, 0.7152, 0.0722))
}

/// Each is drawn as often as its power says, by one lookup (Walker 1977; Vose 1991), and a place on
/// it by area.
fn choose(blocks: &mut [EmitterBlock], power: &[f64], all: f64) {
    let mut share: Vec<f64> = power.iter().map(|p| p / all * power.len() as f64).collect();
    let (mut small, mut large): (Vec<usize>, Vec<usize>) =
        (0..share.len()).partition(|i| share[*i] < 1.0);
    for (block, power) in blocks.iter_mut().zip(power) {
        (block.chance, block.density) = (
            1.0,
            if *power > 0.0 {
                luminance(block.radiance.into()) / all as f32
            } else {
                0.0
            },
        );
    }
    while let (Some(i), Some(k)) = (small.pop(), large.last().copied()) {
        (blocks[i].chance, blocks[i].other) = (share[i] as f32, u32::try_from(k).unwrap_or(0));
        share[k] -= 1.0 - share[i];
        if share[k] < 1.0 {
            large.pop();
            small.push(k);
        }
    }
    // What rounding has left below 1 is of those that have no power at all.
    blocks
        .iter_mut()
        .zip(power)
        .filter(|(b, p)| **p == 0.0 && b.chance == 1.0)
        .for_each(|(b, _)| b.chance = 0.0);
}

/// Emission of a material, by place.
struct Shine {
    emission: Vec3,
    /// Times the colour of the vertices.
    tinted: bool,
    colors: Option<(SmallPicture, Lookup)>,
    /// Alpha below the cutoff is a hole: of the picture, times that of the vertices.
    masked: bool,
    mask: Option<(SmallPicture, Lookup)>,
    cutoff: f32,
}

impl Shine {
    /// `pictures` has small pictures by texture.
    fn new(
        scene: &Scene,
        material: &Material,
        pictures: &mut HashMap<u32, Option<SmallPicture>>,
    ) -> Shine {
        let small = |t: u32| scene.textures.get(t as usize).and_then(|t| t.small(TEXELS));
        let mut picture = |t: Option<u32>, lookup: Lookup| {
            let picture = t.and_then(|t| pictures.entry(t).or_insert_with(|| small(t)).clone());
            picture.map(|picture| (picture, lookup))
        };
        let (masked, lookups) = (material.alpha_cutoff > 0.0, material.lookups);
        Shine {
            emission: material.emission,
            tinted: material.tinted_emission,
            colors: picture(material.emission_texture, lookups.emission),
            masked,
            mask: picture(
                material.base_color_texture.filter(|_| masked),
                lookups.base_color,
            ),
            cutoff: material.alpha_cutoff / material.base_color.w.max(1e-6),
        }
    }

    /// Parts of a triangle's edge, so that each has one radiance.
    fn parts(&self, uvs: [Vec4; 3], tints: [Vec4; 3]) -> u32 {
        let pictures = [&self.colors, &self.mask].into_iter().flatten();
        let finest = pictures
            .map(|(picture, lookup)| parts_of(picture, uvs.map(|uv| lookup.set(uv))))
            .max()
            .unwrap_or(1);
        let varies = tints
            .iter()
            .any(|tint| (*tint - tints[0]).abs().max_element() > 0.02);
        if varies && (self.tinted || self.masked) {
            finest.max(TINTED_PARTS)
        } else {
            finest
        }
    }

    fn at(&self, uv: Vec4, tint: Vec4) -> Vec3 {
        let read = |from: &Option<(SmallPicture, Lookup)>| {
            from.as_ref()
                .map(|(picture, lookup)| picture.at(lookup.place(uv)))
        };
        let color = read(&self.colors).map_or(Vec3::ONE, Vec4::truncate)
            * if self.tinted {
                tint.truncate()
            } else {
                Vec3::ONE
            };
        let hole =
            self.masked && read(&self.mask).map_or(1.0, |texel| texel.w) * tint.w < self.cutoff;
        if hole {
            Vec3::ZERO
        } else {
            self.emission * color
        }
    }

    /// Mean over a triangle.
    fn mean(&self, uvs: [Vec4; 3], tints: [Vec4; 3]) -> Vec3 {
        if self.colors.is_none() && !self.masked && !self.tinted {
            return self.emission;
        }
        const EDGE: u32 = 6;
        let parts = EDGE * EDGE;
        let middle =
            |corners: [Vec4; 3], part| part_corners(corners, EDGE, part).iter().sum::<Vec4>() / 3.0;
        (0..parts)
            .map(|part| self.at(middle(uvs, part), middle(tints, part)))
            .sum::<Vec3>()
            / parts as f32
    }
}

/// Number of parts along an edge that a triangle's texture needs.
fn parts_of(picture: &SmallPicture, uvs: [Vec2; 3]) -> u32 {
    let size = Vec2::new(picture.width as f32, picture.height as f32);
    let longest = [(0, 1), (1, 2), (2, 0)]
        .map(|(i, k)| ((uvs[i] - uvs[k]) * size).length())
        .into_iter()
        .fold(0.0, f32::max);
    if longest.is_finite() {
        (longest.ceil() as u32).clamp(1, MOST_PARTS)
    } else {
        1
    }
}

/// Corners of a part of a triangle with `parts` parts along an edge. Parts are counted row by row
/// from the edge of `a` and `b`. Parts with the orientation of the triangle alternate with mirrored
/// ones.
fn part_corners<V>(corners: [V; 3], parts: u32, part: u32) -> [V; 3]
where
    V: Copy
        + std::ops::Add<Output = V>
        + std::ops::Sub<Output = V>
        + std::ops::Mul<f32, Output = V>,
{
    let row = (0..parts)
        .rev()
        .find(|j| j * (2 * parts - j) <= part)
        .unwrap_or(0);
    let within = part - row * (2 * parts - row);
    let at = |i: u32, j: u32| {
        let [b, c] = [i, j].map(|n| n as f32 / parts as f32);
        corners[0] + (corners[1] - corners[0]) * b + (corners[2] - corners[0]) * c
    };
    let i = within / 2;
    if within.is_multiple_of(2) {
        [at(i, row), at(i + 1, row), at(i, row + 1)]
    } else {
        [at(i + 1, row + 1), at(i, row + 1), at(i + 1, row)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_cover_their_triangle_and_are_numbered_as_shaders_number_them() {
        let corners = [Vec2::ZERO, Vec2::X, Vec2::Y];
        for parts in 1..=MOST_PARTS {
            let mut area = 0.0;
            for part in 0..parts * parts {
                let [a, b, c] = part_corners(corners, parts, part);
                area += 0.5 * (b - a).perp_dot(c - a);
                let place = (a + b + c) / 3.0 * parts as f32;
                let (i, j) = (place.x.floor(), place.y.floor());
                let upper = (place.x - i) + (place.y - j) > 1.0;
                let (i, j) = (i as u32, j as u32);
                assert_eq!(part, j * (2 * parts - j) + 2 * i + u32::from(upper));
            }
            assert!((area - 0.5).abs() < 1e-5, "{parts}: {area}");
        }
    }

    #[test]
    fn emitters_are_drawn_by_their_power() {
        let block = |edge: f32, radiance: f32| EmitterBlock {
            to_b: [edge, 0.0, 0.0],
            to_c: [0.0, edge, 0.0],
            radiance: [radiance; 3],
            ..bytemuck::Zeroable::zeroed()
        };
        let mut blocks = [
            block(1.0, 3.0),
            block(2.0, 0.0),
            block(0.5, 1.0),
            block(1.0, 100.0),
            block(0.0, 5.0),
        ];
        let power: Vec<f64> = blocks.iter().map(power_of).collect();
        let all = power.iter().sum::<f64>();
        choose(&mut blocks, &power, all);
        let mut drawn = [0.0; 5];
        for (i, b) in blocks.iter().enumerate() {
            drawn[i] += f64::from(b.chance) / 5.0;
            drawn[b.other as usize] += f64::from(1.0 - b.chance) / 5.0;
        }
        for (i, (drawn, power)) in drawn.iter().zip(&power).enumerate() {
            assert!(
                (drawn - power / all).abs() < 1e-6,
                "{i}: {drawn}, {}",
                power / all
            );
        }
    }
}
