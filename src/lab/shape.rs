//! The triangles of a scene in a pose, as shaders and rays read them.

use super::attributes::{self, Attributes};
use super::interface::blocks::DrawBlock;
use crate::scene::{Scene, Vertex};
use glam::Vec3;
use std::borrow::Cow;
use std::collections::HashMap;

/// Vertices and indices of all meshes one after another, and the draws.
pub(super) struct Shape {
    /// Three numbers for each vertex [m, local].
    pub positions: Vec<f32>,
    pub attributes: Vec<Attributes>,
    pub indices: Vec<u32>,
    /// First index of each mesh.
    pub first_index: Vec<u32>,
    /// One for each part of each instance. Opaque ones come first.
    pub draws: Vec<DrawBlock>,
    /// Number of opaque draws.
    pub opaque: usize,
    /// Whether each draw moves or deforms.
    pub moves: Vec<bool>,
}

impl Shape {
    /// The triangles of a scene with these vertices.
    pub fn new(scene: &Scene, posed: &[Cow<'_, [Vertex]>]) -> Shape {
        let mut shape = Shape {
            positions: Vec::new(),
            attributes: Vec::new(),
            indices: Vec::new(),
            first_index: Vec::new(),
            draws: Vec::new(),
            opaque: 0,
            moves: Vec::new(),
        };
        for (mesh, vertices) in scene.meshes.iter().zip(posed) {
            let base = count(shape.positions.len() / 3);
            shape.first_index.push(count(shape.indices.len()));
            shape
                .positions
                .extend(vertices.iter().flat_map(|v| v.position));
            shape.attributes.extend(vertices.iter().map(attributes::of));
            shape.indices.extend(mesh.indices.iter().map(|i| base + i));
        }
        shape.draws = draws(scene, &shape.first_index);
        let moves = scene.is_animated();
        let of = |d: &DrawBlock| scene.instances.get(d.instance as usize).is_some_and(&moves);
        shape.moves = shape.draws.iter().map(of).collect();
        shape.opaque = shape.draws.iter().filter(|d| !is_masked(scene, d)).count();
        shape
    }

    /// The triangles at 0 s.
    pub fn at_rest(scene: &Scene) -> Shape {
        Shape::new(scene, &scene.posed_meshes(0.0))
    }

    /// Number of triangles.
    pub fn triangle_count(&self) -> u32 {
        count(self.draws.iter().map(|d| d.index_count as usize / 3).sum())
    }

    /// Number of triangles that never move; [`Shape::triangles`] begins with them.
    pub fn still_triangles(&self) -> u32 {
        let still = self
            .draws
            .iter()
            .zip(&self.moves)
            .filter(|(_, moves)| !**moves);
        count(still.map(|(d, _)| d.index_count as usize / 3).sum())
    }

    /// Indirect commands (VkDrawIndexedIndirectCommand), one for each draw. The instance number
    /// tells shaders which draw it is.
    pub fn commands(&self) -> Vec<[u32; 5]> {
        let command = |(i, d): (u32, &DrawBlock)| [d.index_count, 1, d.first_index, 0, i];
        (0..).zip(&self.draws).map(command).collect()
    }

    fn position(&self, index: u32) -> Vec3 {
        Vec3::from_slice(&self.positions[3 * self.indices[index as usize] as usize..][..3])
    }

    /// Positions and attributes of a triangle's vertices, in bits.
    fn content(&self, first: u32) -> [[u32; 15]; 3] {
        std::array::from_fn(|k| {
            let vertex = self.indices[first as usize + k] as usize;
            let position = &self.positions[3 * vertex..3 * vertex + 3];
            let mut words = [0; 15];
            let numbers = position.iter().chain(&self.attributes[vertex]);
            words
                .iter_mut()
                .zip(numbers)
                .for_each(|(word, n)| *word = n.to_bits());
            words
        })
    }

    /// (draw, first of its indices) of every triangle, draw by draw: first those that never move.
    /// Neighbours in space are
    /// neighbours in the list. The order depends on the content of triangles alone, because it
    /// decides which of two coincident ones is visible.
    pub fn triangles(&self) -> Vec<[u32; 2]> {
        // Instances of one mesh have the same triangles.
        let mut sorted: HashMap<(u32, u32), Vec<u32>> = HashMap::new();
        let mut list = Vec::new();
        let mut draws: Vec<(u32, &DrawBlock)> = (0..).zip(&self.draws).collect();
        draws.sort_by_key(|(number, _)| self.moves[*number as usize]);
        for (number, draw) in draws {
            let key = (draw.first_index, draw.index_count);
            let order = sorted.entry(key).or_insert_with(|| self.sorted(draw));
            list.extend(order.iter().map(|first| [number, *first]));
        }
        list
    }

    /// First indices of a draw's triangles in Morton order.
    fn sorted(&self, draw: &DrawBlock) -> Vec<u32> {
        let firsts = (draw.first_index..draw.first_index + draw.index_count).step_by(3);
        let middle = |first: u32| {
            let [a, b, c] = [0, 1, 2].map(|k| self.position(first + k));
            (a + b + c) / 3.0
        };
        let (mut low, mut high) = (Vec3::splat(f32::MAX), Vec3::splat(f32::MIN));
        for p in firsts.clone().map(middle) {
            (low, high) = (low.min(p), high.max(p));
        }
        let scale = 1023.0 / (high - low).max(Vec3::splat(f32::MIN_POSITIVE));
        let key = |first: u32| (morton((middle(first) - low) * scale), first);
        let mut keyed: Vec<(u32, u32)> = firsts.map(key).collect();
        let content = |first: u32| self.content(first);
        keyed.sort_by(|a, b| a.0.cmp(&b.0).then_with(|| content(a.1).cmp(&content(b.1))));
        keyed.into_iter().map(|(_, first)| first).collect()
    }
}

/// A count as shaders hold it.
pub(super) fn count(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}

fn is_masked(scene: &Scene, draw: &DrawBlock) -> bool {
    scene
        .materials
        .get(draw.material as usize)
        .is_some_and(|m| m.alpha_cutoff > 0.0)
}

fn draws(scene: &Scene, first_index: &[u32]) -> Vec<DrawBlock> {
    let mut list = Vec::new();
    for (i, instance) in (0u32..).zip(&scene.instances) {
        let Some(mesh) = scene.meshes.get(instance.mesh as usize) else {
            continue;
        };
        for submesh in mesh.submeshes.iter().filter(|p| p.index_count > 0) {
            list.push(DrawBlock {
                instance: i,
                material: submesh.material,
                first_index: first_index[instance.mesh as usize] + submesh.first_index,
                index_count: submesh.index_count,
            });
        }
    }
    list.sort_by_key(|d| is_masked(scene, d));
    list
}

/// Interleaves the bits of three numbers below 1024: neighbours in space have neighbouring codes
/// (Morton 1966).
fn morton(p: Vec3) -> u32 {
    let spread = |v: f32| (0..10).fold(0, |word, bit| word | (v as u32 >> bit & 1) << (3 * bit));
    spread(p.x) | spread(p.y) << 1 | spread(p.z) << 2
}
