//! Which parts of a mesh are closed, so that nobody outside sees the insides of their triangles.

use std::collections::HashMap;

use glam::Vec3;

use crate::scene::Mesh;

/// A connected part of a mesh.
#[derive(Clone, Copy, Debug)]
struct Part {
    low: Vec3,
    high: Vec3,
    /// Six times the volume that its triangles enclose, positive where their fronts are outside.
    volume: f64,
    closed: bool,
}

/// A side of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// From where its corners turn counter-clockwise.
    Front,
    Back,
}

impl Mesh {
    /// For each triangle of the mesh, the side of it that is outside, if it is of a closed part whose diagonal is at most so long
    /// (model space). Vertices in one place are one.
    pub fn outsides(&self, longest: f32) -> Vec<Option<Side>> {
        let mut places: HashMap<[u32; 3], usize> = HashMap::new();
        let welded: Vec<usize> = self
            .vertices
            .iter()
            .map(|v| {
                let next = places.len();
                *places.entry(v.position.map(|x| (x + 0.0).to_bits())).or_insert(next)
            })
            .collect();
        let triangles = self.indices.as_chunks::<3>().0;
        let corners = |t: &[u32; 3]| t.map(|i| welded.get(i as usize).copied().unwrap_or(0));
        let mut roots: Vec<usize> = (0..places.len().max(1)).collect();
        // How often an edge is there, and as many times less as it runs the other way.
        let mut edges: HashMap<(usize, usize), (u32, i32)> = HashMap::new();
        for [a, b, c] in triangles.iter().map(corners) {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let edge = edges.entry((from.min(to), from.max(to))).or_default();
                *edge = (edge.0 + 1, edge.1 + if from < to { 1 } else { -1 });
                let (x, y) = (root(&mut roots, from), root(&mut roots, to));
                roots[x.max(y)] = x.min(y);
            }
        }
        let empty = Part { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY, volume: 0.0, closed: true };
        let mut parts: HashMap<usize, Part> = HashMap::new();
        for triangle in triangles {
            let part = parts.entry(root(&mut roots, corners(triangle)[0])).or_insert(empty);
            let [a, b, c] = triangle.map(|i| self.vertices.get(i as usize).map_or(Vec3::ZERO, |v| v.position.into()));
            (part.low, part.high) = (part.low.min(a).min(b).min(c), part.high.max(a).max(b).max(c));
            part.volume += a.as_dvec3().dot(b.as_dvec3().cross(c.as_dvec3()));
        }
        for ((from, _), _) in edges.iter().filter(|(_, count)| **count != (2, 0)) {
            if let Some(part) = parts.get_mut(&root(&mut roots, *from)) {
                part.closed = false;
            }
        }
        let outside = |part: &Part| {
            let small = part.closed && part.volume != 0.0 && (part.high - part.low).length() <= longest;
            small.then_some(if part.volume > 0.0 { Side::Front } else { Side::Back })
        };
        triangles.iter().map(|t| outside(parts.get(&root(&mut roots, corners(t)[0])).unwrap_or(&empty))).collect()
    }
}

fn root(roots: &mut [usize], of: usize) -> usize {
    let mut at = of;
    while roots[at] != at {
        roots[at] = roots[roots[at]];
        at = roots[at];
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::builtin::shapes::{MeshBuilder, STANDING};

    #[test]
    fn balls_and_boxes_have_an_outside_and_sheets_have_none() {
        let mut builder = MeshBuilder::new("shapes");
        builder.icosphere(0, Vec3::ZERO, 0.5, 1);
        let ball = builder.finish();
        assert!(ball.outsides(10.0).iter().all(|s| *s == Some(Side::Front)));
        assert!(ball.outsides(1.0).iter().all(Option::is_none), "too large");
        let mut turned = ball.clone();
        turned.indices.as_chunks_mut::<3>().0.iter_mut().for_each(|t| t.swap(0, 1));
        assert!(turned.outsides(10.0).iter().all(|s| *s == Some(Side::Back)));
        let mut opened = ball.clone();
        opened.indices.truncate(opened.indices.len() - 3);
        assert!(opened.outsides(10.0).iter().all(Option::is_none));
        let mut builder = MeshBuilder::new("box");
        builder.cuboid(0, Vec3::ZERO, Vec3::ONE, 1.0, [true; 6]);
        assert!(builder.finish().outsides(10.0).iter().all(|s| *s == Some(Side::Front)));
        let mut builder = MeshBuilder::new("without its bottom");
        builder.cuboid(0, Vec3::ZERO, Vec3::ONE, 1.0, STANDING);
        assert!(builder.finish().outsides(10.0).iter().all(Option::is_none));
    }
}
