//! A hierarchy over all triangles of a scene in one pose, for shaders that trace rays (`shaders/include/trace.glsl`).

use super::emitters::Emitters;
use crate::graph::host::DrawBlock;
use crate::vulkan::{Result, VulkanError};
use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec3, Vec3A};
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::triangle::Triangle;
use obvhs::{BvhBuildParams, aabb::Aabb};

/// A triangle as shaders see it, `BvhTriangle` (std430).
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct TriangleBlock {
    a: [f32; 3],
    draw: u32,
    b: [f32; 3],
    first_index: u32,
    c: [f32; 3],
    /// The highest bit: an alpha mask. The others: [`Emitters::number`](super::emitters::Emitters::number).
    flags: u32,
}

/// What the triangles of a scene are, whatever its pose.
pub(super) struct Soup<'a> {
    pub positions: &'a [f32],
    pub indices: &'a [u32],
    pub draws: &'a [DrawBlock],
    /// Of each mesh.
    pub first_index: &'a [u32],
    /// Whether the draw's material has an alpha mask.
    pub masked: &'a dyn Fn(&DrawBlock) -> bool,
}

/// Content of the buffers `bvhNodes` and `bvhTriangles`.
pub(super) struct Hierarchy {
    pub nodes: Vec<u8>,
    pub triangles: Vec<u8>,
}

/// Stack of the traversal in `trace.glsl`, which holds one node a level.
const MAX_DEPTH: usize = 64;

/// Bytes that the nodes and the triangles of so many triangles can take in any pose.
pub(super) fn capacity(triangles: usize) -> (usize, usize) {
    let triangles = triangles.max(1);
    (2 * triangles * size_of::<Bvh2Node>(), triangles * size_of::<TriangleBlock>())
}

/// Builds the hierarchy; `model` is the pose of an instance. Costs about a second a million triangles.
///
/// # Errors
/// A scene whose hierarchy is too deep for the shader's stack.
pub(super) fn build(
    soup: &Soup<'_>,
    emitters: &Emitters,
    model: &dyn Fn(u32) -> Mat4,
    device: &str,
) -> Result<Hierarchy> {
    let blocks = triangles(soup, emitters, model);
    let corners: Vec<Triangle> =
        blocks.iter().map(|t| Triangle { v0: Vec3A::from(t.a), v1: Vec3A::from(t.b), v2: Vec3A::from(t.c) }).collect();
    // A leaf of one, and nothing in it, where there are no triangles: the shader always reads a root.
    let (nodes, order) = if corners.is_empty() {
        (vec![Bvh2Node::new(Aabb::from_point(Vec3A::splat(f32::MAX)), 1, 0)], Vec::new())
    } else {
        let mut time = std::time::Duration::default();
        let bvh = build_bvh2(&corners, BvhBuildParams::medium_build(), &mut time);
        let depth = depth(&bvh);
        if depth > MAX_DEPTH {
            return Err(VulkanError::Limit {
                what: "the hierarchy of the scene's triangles".into(),
                asked: format!("{depth} levels"),
                limit: format!("{MAX_DEPTH} levels (many triangles in one place make it deep)"),
                device: device.into(),
            });
        }
        (bvh.nodes, bvh.primitive_indices)
    };
    let mut ordered: Vec<TriangleBlock> = order.iter().map(|i| blocks[*i as usize]).collect();
    if ordered.is_empty() {
        ordered.push(TriangleBlock::zeroed());
    }
    Ok(Hierarchy { nodes: bytemuck::cast_slice(&nodes).to_vec(), triangles: bytemuck::cast_slice(&ordered).to_vec() })
}

fn triangles(soup: &Soup<'_>, emitters: &Emitters, model: &dyn Fn(u32) -> Mat4) -> Vec<TriangleBlock> {
    let mut blocks = Vec::new();
    for (number, draw) in (0u32..).zip(soup.draws) {
        let model = model(draw.instance);
        let masked = u32::from((soup.masked)(draw)) << 31;
        let corner = |i: u32| {
            let v = 3 * soup.indices[i as usize] as usize;
            let p = Vec3::new(soup.positions[v], soup.positions[v + 1], soup.positions[v + 2]);
            model.transform_point3(p).to_array()
        };
        for first_index in (draw.first_index..draw.first_index + draw.index_count).step_by(3) {
            let [a, b, c] = [0, 1, 2].map(|k| corner(first_index + k));
            // Impossible places would spread through the boxes; such a triangle is nowhere to be hit.
            if [a, b, c].iter().flatten().all(|x| x.is_finite()) {
                blocks.push(TriangleBlock {
                    a,
                    draw: number,
                    b,
                    first_index,
                    c,
                    flags: masked | emitters.number(number, first_index),
                });
            }
        }
    }
    blocks
}

/// Levels below the root.
fn depth(bvh: &Bvh2) -> usize {
    let mut deepest = 0;
    let mut open = vec![(0usize, 0usize)];
    while let Some((node, level)) = open.pop() {
        deepest = deepest.max(level);
        if let Some(node) = bvh.nodes.get(node).filter(|n| !n.is_leaf()) {
            let first = node.first_index as usize;
            open.extend([(first, level + 1), (first + 1, level + 1)]);
        }
    }
    deepest
}
