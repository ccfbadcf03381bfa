//! Triangle-box overlap test.

use glam::DVec3;

/// Relative change of a box that makes an overlap borderline if the decision changes.
const MARGIN: f64 = 1e-5;

/// Overlap of a triangle and a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Overlap {
    /// Not even a cell wider by 1e-5 of its edge on each side overlaps.
    Outside,
    /// Undecided: rounding may decide either way.
    Borderline,
    /// Even a cell narrower by 1e-5 of its edge on each side overlaps.
    Inside,
}

/// A candidate separating axis with the triangle's extent along it.
#[derive(Clone, Copy)]
struct Axis {
    direction: DVec3,
    low: f64,
    high: f64,
}

/// The 13 candidate axes that separate a triangle from a box: three of the box, the triangle's
/// normal, and the cross products of their edges (Akenine-Moeller 2001, Fast 3D Triangle-Box
/// Overlap Testing).
pub struct Axes {
    /// x, y, z, the normal, then each triangle edge's cross products with x, y and z.
    axes: [Axis; 13],
}

impl Axes {
    /// Prepares a triangle in world coordinates (m).
    pub fn new(t: [DVec3; 3]) -> Axes {
        let edges = [t[1] - t[0], t[2] - t[1], t[0] - t[2]];
        let units = [DVec3::X, DVec3::Y, DVec3::Z];
        let longest = edges
            .map(DVec3::length_squared)
            .into_iter()
            .fold(0.0, f64::max);
        let mut directions = [DVec3::ZERO; 13];
        directions[..3].copy_from_slice(&units);
        let normal = edges[0].cross(-edges[2]);
        // Directions that vanish by cancellation are noise and must not separate; a zero vector
        // never does.
        if normal.length_squared() > 1e-24 * longest * longest {
            directions[3] = normal;
        }
        for (i, direction) in directions[4..].iter_mut().enumerate() {
            let edge = edges[i / 3];
            let cross = units[i % 3].cross(edge);
            if cross.length_squared() > 1e-24 * edge.length_squared() {
                *direction = cross;
            }
        }
        Axes {
            axes: directions.map(|direction| {
                let p = t.map(|v| v.dot(direction));
                Axis {
                    direction,
                    low: p[0].min(p[1]).min(p[2]),
                    high: p[0].max(p[1]).max(p[2]),
                }
            }),
        }
    }

    /// The triangle's normal, not normalised.
    pub fn normal(&self) -> DVec3 {
        self.axes[3].direction
    }

    /// Tests a box given by its centre and half edges (m).
    ///
    /// First for the conservative, 26-separating set: all boxes that the triangle overlaps. Then
    /// for the thin, 6-separating set: those in which the triangle may cross a line between the
    /// centres of opposite faces (Schwarz and Seidel 2010, Section 4.2: the plane, and the edges in
    /// the projection along the dominant axis).
    pub fn overlap(&self, centre: DVec3, half: DVec3) -> (Overlap, Overlap) {
        let conservative = decide(self.axes.iter(), centre, |a| {
            (a.direction.abs() * half).element_sum()
        });
        if conservative == Overlap::Outside {
            return (Overlap::Outside, Overlap::Outside);
        }
        let across = (self.normal().abs() * half).to_array();
        let dominant = (0..3).fold(0, |best, i| if across[i] > across[best] { i } else { best });
        let used = self
            .axes
            .iter()
            .enumerate()
            .filter(|(i, _)| *i < 4 || (*i - 4) % 3 == dominant)
            .map(|(_, a)| a);
        (
            conservative,
            conservative.min(decide(used, centre, |a| {
                (a.direction.abs() * half).max_element()
            })),
        )
    }
}

fn decide<'a>(
    axes: impl Iterator<Item = &'a Axis>,
    centre: DVec3,
    reach: impl Fn(&Axis) -> f64,
) -> Overlap {
    let mut found = Overlap::Inside;
    for axis in axes {
        let at = centre.dot(axis.direction);
        let apart = (axis.low - at).max(at - axis.high);
        let reach = reach(axis);
        // Half an edge grows by MARGIN of the edge.
        if apart > reach * (1.0 + 2.0 * MARGIN) {
            return Overlap::Outside;
        }
        if apart > reach * (1.0 - 2.0 * MARGIN) {
            found = Overlap::Borderline;
        }
    }
    found
}
