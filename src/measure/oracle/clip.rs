//! Clipping of a triangle to a box (Sutherland and Hodgman 1974).

use glam::DVec3;

/// A corner of a clipped triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// World position (m).
    pub position: DVec3,
    /// Barycentric weights; their sum is 1.
    pub weights: DVec3,
}

/// The convex polygon of a triangle inside the box from `low` to `high`; empty if they are
/// disjoint. If they only touch, it may be a line or a point.
pub fn clip(t: [DVec3; 3], low: DVec3, high: DVec3) -> Vec<Corner> {
    let units = [DVec3::X, DVec3::Y, DVec3::Z];
    let mut polygon: Vec<Corner> = t
        .into_iter()
        .zip(units)
        .map(|(position, weights)| Corner { position, weights })
        .collect();
    let mut kept = Vec::with_capacity(9);
    for axis in 0..3 {
        for (sign, border) in [(1.0, low[axis]), (-1.0, high[axis])] {
            let depth = |c: &Corner| sign * (c.position[axis] - border);
            kept.clear();
            for (i, a) in polygon.iter().enumerate() {
                let b = &polygon[(i + 1) % polygon.len()];
                let (from, to) = (depth(a), depth(b));
                if from >= 0.0 {
                    kept.push(*a);
                }
                if (from >= 0.0) != (to >= 0.0) {
                    let s = from / (from - to);
                    kept.push(Corner {
                        position: a.position.lerp(b.position, s),
                        weights: a.weights.lerp(b.weights, s),
                    });
                }
            }
            std::mem::swap(&mut polygon, &mut kept);
        }
    }
    polygon
}
