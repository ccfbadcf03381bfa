//! Detection of closed parts of a mesh; their back faces are never visible from outside.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use glam::Vec3;

use crate::scene::Mesh;

/// A side of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The side from which its corners are counter-clockwise.
    Front,
    /// The side from which its corners are clockwise.
    Back,
}

impl Mesh {
    /// For each triangle, its outer side if it belongs to a closed part with a diagonal of at most
    /// `longest` (model space). Vertices at equal positions are merged; neighbours may have
    /// opposite windings.
    pub fn outsides(&self, longest: f32) -> Vec<Option<Side>> {
        let triangles = self.indices.as_chunks::<3>().0;
        let neighbours = self.neighbours();
        let mut outsides = vec![None; triangles.len()];
        let mut seen = vec![false; triangles.len()];
        for start in 0..triangles.len() {
            if seen[start] {
                continue;
            }
            // A connected part; the flag tells whether a triangle has the winding of the first one.
            let mut part = vec![(start, true)];
            let mut turns: HashMap<usize, bool> = HashMap::from([(start, true)]);
            let (mut closed, mut at) = (true, 0);
            while let Some((triangle, turn)) = part.get(at).copied() {
                at += 1;
                seen[triangle] = true;
                for neighbour in &neighbours[triangle] {
                    let Some((other, alike)) = neighbour else {
                        closed = false;
                        continue;
                    };
                    let wanted = turn == *alike;
                    match turns.entry(*other) {
                        Entry::Occupied(known) => closed &= *known.get() == wanted,
                        Entry::Vacant(entry) => {
                            entry.insert(wanted);
                            part.push((*other, wanted));
                        }
                    }
                }
            }
            let corners = |t: usize| {
                triangles[t].map(|i| {
                    self.vertices
                        .get(i as usize)
                        .map_or(Vec3::ZERO, |v| v.position.into())
                })
            };
            let mut bounds = (Vec3::INFINITY, Vec3::NEG_INFINITY);
            let mut volume = 0.0; // six times that, positive where the first one's front is outside
            for (triangle, turn) in &part {
                let [a, b, c] = corners(*triangle);
                bounds = (bounds.0.min(a).min(b).min(c), bounds.1.max(a).max(b).max(c));
                let own = a.as_dvec3().dot(b.as_dvec3().cross(c.as_dvec3()));
                volume += if *turn { own } else { -own };
            }
            if closed && volume != 0.0 && (bounds.1 - bounds.0).length() <= longest {
                for (triangle, turn) in part {
                    outsides[triangle] = Some(if turn == (volume > 0.0) {
                        Side::Front
                    } else {
                        Side::Back
                    });
                }
            }
        }
        outsides
    }

    /// For each edge of each triangle: the neighbour, if exactly one triangle shares the edge, and
    /// whether both have the same winding.
    fn neighbours(&self) -> Vec<[Option<(usize, bool)>; 3]> {
        let mut places: HashMap<[u32; 3], usize> = HashMap::new();
        let welded: Vec<usize> = self
            .vertices
            .iter()
            .map(|v| {
                let next = places.len();
                *places
                    .entry(v.position.map(|x| (x + 0.0).to_bits()))
                    .or_insert(next)
            })
            .collect();
        let edges_of = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| welded.get(i as usize).copied().unwrap_or(0));
            [(a, b), (b, c), (c, a)]
        };
        let triangles = self.indices.as_chunks::<3>().0;
        // Triangles of each edge, and whether each runs from the smaller index.
        let mut edges: HashMap<(usize, usize), Vec<(usize, bool)>> = HashMap::new();
        for (number, triangle) in triangles.iter().enumerate() {
            for (from, to) in edges_of(triangle) {
                edges
                    .entry((from.min(to), from.max(to)))
                    .or_default()
                    .push((number, from < to));
            }
        }
        let across = |number: usize, (from, to): (usize, usize)| match edges
            .get(&(from.min(to), from.max(to)))?
            .as_slice()
        {
            [(one, a), (two, b)] if one != two => {
                Some((if *one == number { *two } else { *one }, a != b))
            }
            _ => None,
        };
        let of = |(number, triangle)| edges_of(triangle).map(|edge| across(number, edge));
        triangles.iter().enumerate().map(of).collect()
    }
}
