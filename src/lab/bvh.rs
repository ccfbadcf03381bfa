//! A hierarchy over all triangles of a scene in one pose, for shaders that trace rays
//! (`shaders/reference/intersect.glsl`).

use super::emitters::Emitters;
use super::shape::Shape;
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
    /// The highest bit: an alpha mask. The others:
    /// [`Emitters::number`](super::emitters::Emitters::number).
    flags: u32,
}

/// Content of the buffers `bvhNodes` and `bvhTriangles`.
pub(super) struct Hierarchy {
    pub nodes: Vec<u8>,
    pub triangles: Vec<u8>,
}

/// Stack of the traversal in `trace.glsl`, which holds one node a level.
const MAX_DEPTH: usize = 64;

/// Upper limits of the bytes of nodes and triangles in any pose, for a number of triangles.
pub(super) fn capacity(triangles: usize) -> (usize, usize) {
    let triangles = triangles.max(1);
    (
        2 * triangles * size_of::<Bvh2Node>(),
        triangles * size_of::<TriangleBlock>(),
    )
}

/// Builds the hierarchy; `model` is the pose of an instance. Costs about a second a million
/// triangles.
pub(super) fn build(shape: &Shape, emitters: &Emitters, model: &dyn Fn(u32) -> Mat4) -> Hierarchy {
    let blocks = triangles(shape, emitters, model);
    let corners: Vec<Triangle> = blocks
        .iter()
        .map(|t| Triangle {
            v0: Vec3A::from(t.a),
            v1: Vec3A::from(t.b),
            v2: Vec3A::from(t.c),
        })
        .collect();
    // A leaf of one, and nothing in it, where there are no triangles: the shader always reads a
    // root.
    let (nodes, order) = if corners.is_empty() {
        (
            vec![Bvh2Node::new(
                Aabb::from_point(Vec3A::splat(f32::MAX)),
                1,
                0,
            )],
            Vec::new(),
        )
    } else {
        let mut time = std::time::Duration::default();
        let bvh = build_bvh2(&corners, BvhBuildParams::medium_build(), &mut time);
        match depth(&bvh.nodes) > MAX_DEPTH {
            true => evened(&bvh, &corners),
            false => (bvh.nodes, bvh.primitive_indices),
        }
    };
    let mut ordered: Vec<TriangleBlock> = order.iter().map(|i| blocks[*i as usize]).collect();
    if ordered.is_empty() {
        ordered.push(TriangleBlock::zeroed());
    }
    Hierarchy {
        nodes: bytemuck::cast_slice(&nodes).to_vec(),
        triangles: bytemuck::cast_slice(&ordered).to_vec(),
    }
}

fn triangles(
    shape: &Shape,
    emitters: &Emitters,
    model: &dyn Fn(u32) -> Mat4,
) -> Vec<TriangleBlock> {
    let mut blocks = Vec::new();
    for (number, draw) in (0u32..).zip(&shape.draws) {
        let model = model(draw.instance);
        let masked = u32::from(number as usize >= shape.opaque) << 31;
        let corner = |i: u32| {
            let v = 3 * shape.indices[i as usize] as usize;
            let p = Vec3::new(
                shape.positions[v],
                shape.positions[v + 1],
                shape.positions[v + 2],
            );
            model.transform_point3(p).to_array()
        };
        for first_index in (draw.first_index..draw.first_index + draw.index_count).step_by(3) {
            let [a, b, c] = [0, 1, 2].map(|k| corner(first_index + k));
            // Impossible places would spread through the boxes; such a triangle is nowhere to be
            // hit.
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

/// Nodes of this level are roots of balanced trees, if they are not leaves. With the levels of 2^28
/// triangles below, that is less than [`MAX_DEPTH`].
const EVEN_FROM: usize = 32;

/// The same triangles in a tree that the shader's stack holds: chains of ever larger triangles, and
/// many triangles in one place, make a hierarchy by surface area deep. Below [`EVEN_FROM`] levels
/// triangles are halved by their middles, which costs rays that come there some more boxes.
fn evened(bvh: &Bvh2, corners: &[Triangle]) -> (Vec<Bvh2Node>, Vec<u32>) {
    let (mut nodes, mut order) = (vec![Bvh2Node::default()], Vec::with_capacity(corners.len()));
    let mut open = vec![(0, 0, 0)];
    while let Some((old, new, level)) = open.pop() {
        let node: &Bvh2Node = &bvh.nodes[old];
        if !node.is_leaf() && level < EVEN_FROM {
            let (first, pair) = (node.first_index as usize, nodes.len());
            nodes.resize(pair + 2, Bvh2Node::default());
            nodes[new] = Bvh2Node::new(*node.aabb(), 0, pair as u32);
            open.extend([(first, pair, level + 1), (first + 1, pair + 1, level + 1)]);
        } else {
            balanced(&mut below(bvh, old), corners, new, &mut nodes, &mut order);
        }
    }
    (nodes, order)
}

/// The triangles below a node.
fn below(bvh: &Bvh2, node: usize) -> Vec<u32> {
    let (mut list, mut open) = (Vec::new(), vec![node]);
    while let Some(node) = open.pop().map(|n| &bvh.nodes[n]) {
        let first = node.first_index as usize;
        match node.is_leaf() {
            true => list.extend(&bvh.primitive_indices[first..first + node.prim_count as usize]),
            false => open.extend([first, first + 1]),
        }
    }
    list
}

/// Triangles that a leaf of a balanced tree holds.
const LEAF: usize = 2;

/// Puts a balanced tree of these triangles at a node.
fn balanced(
    list: &mut [u32],
    corners: &[Triangle],
    at: usize,
    nodes: &mut Vec<Bvh2Node>,
    order: &mut Vec<u32>,
) {
    let mut open = vec![(list, at)];
    while let Some((list, at)) = open.pop() {
        let (mut all, mut middles) = (Aabb::empty(), Aabb::empty());
        for i in list.iter() {
            let own = corners[*i as usize].aabb();
            all.extend(own.min).extend(own.max);
            middles.extend(own.center());
        }
        if list.len() <= LEAF {
            nodes[at] = Bvh2Node::new(all, list.len() as u32, order.len() as u32);
            order.extend_from_slice(list);
            continue;
        }
        let axis = middles.largest_axis();
        let key = |i: &u32| corners[*i as usize].aabb().center()[axis];
        let half = list.len() / 2;
        // Numbers decide between equal middles, so that the tree is the same every time.
        list.select_nth_unstable_by(half, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
        let pair = nodes.len();
        nodes.resize(pair + 2, Bvh2Node::default());
        nodes[at] = Bvh2Node::new(all, 0, pair as u32);
        let (low, high) = list.split_at_mut(half);
        open.extend([(low, pair), (high, pair + 1)]);
    }
}

/// Levels below the root.
fn depth(nodes: &[Bvh2Node]) -> usize {
    let mut deepest = 0;
    let mut open = vec![(0usize, 0usize)];
    while let Some((node, level)) = open.pop() {
        deepest = deepest.max(level);
        if let Some(node) = nodes.get(node).filter(|n| !n.is_leaf()) {
            let first = node.first_index as usize;
            open.extend([(first, level + 1), (first + 1, level + 1)]);
        }
    }
    deepest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that each triangle is in one leaf, and inside the boxes of all nodes above it.
    fn check(nodes: &[Bvh2Node], order: &[u32], corners: &[Triangle]) {
        let mut seen = vec![0; corners.len()];
        let mut open = vec![(0usize, Vec::new())];
        while let Some((at, mut above)) = open.pop() {
            let node = &nodes[at];
            above.push(*node.aabb());
            let first = node.first_index as usize;
            if !node.is_leaf() {
                open.extend([(first, above.clone()), (first + 1, above)]);
                continue;
            }
            for i in &order[first..first + node.prim_count as usize] {
                seen[*i as usize] += 1;
                let t = &corners[*i as usize];
                assert!(
                    above
                        .iter()
                        .all(|b| [t.v0, t.v1, t.v2].iter().all(|v| b.contains_point(*v)))
                );
            }
        }
        assert!(seen.iter().all(|count| *count == 1), "{seen:?}");
    }

    /// Triangles that grow by a fifth each: a split by surface area takes one at a time off.
    #[test]
    fn chains_and_heaps_fit_the_stack() {
        let chain = (0..400).map(|i| {
            let size = 1.2_f32.powi(i - 200);
            [Vec3A::ZERO, Vec3A::X, Vec3A::Y].map(|v| (v + Vec3A::splat(1.0)) * size)
        });
        let heap = (0..5000).map(|_| [Vec3A::ZERO, Vec3A::X, Vec3A::Y]);
        for triangles in [chain.collect::<Vec<_>>(), heap.collect()] {
            let corners: Vec<Triangle> = triangles
                .into_iter()
                .map(|[v0, v1, v2]| Triangle { v0, v1, v2 })
                .collect();
            let mut time = std::time::Duration::default();
            let bvh = build_bvh2(&corners, BvhBuildParams::medium_build(), &mut time);
            let (nodes, order) = evened(&bvh, &corners);
            println!("{} levels, evened {}", depth(&bvh.nodes), depth(&nodes));
            assert!(depth(&nodes) <= MAX_DEPTH);
            assert!(nodes.len() < 2 * corners.len());
            check(&nodes, &order, &corners);
        }
    }
}
