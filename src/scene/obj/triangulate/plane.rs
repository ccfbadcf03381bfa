//! Planar points in 64 bits, in which products of 32-bit coordinates are exact.

/// A projected corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Point {
    pub x: f64,
    pub y: f64,
}

/// Position of a point relative to a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Inside {
    No,
    Yes,
    /// On an edge.
    Rim,
    /// At a corner of that number.
    Corner(usize),
}

/// Projections with counter-clockwise winding. The first drops the axis of the largest area, which
/// keeps coordinates exact. The second is the polygon's own plane (Newell), in which bent polygons
/// intersect themselves less. `None` if the area is zero or not finite.
pub(super) fn project(polygon: &[[f32; 3]]) -> Option<impl Iterator<Item = Vec<Point>>> {
    let normal = newell(polygon);
    let size = normal.map(f64::abs);
    let axis = (0..3).max_by(|a, b| size[*a].total_cmp(&size[*b]))?;
    if !(size[axis] > 0.0 && size[axis].is_finite()) {
        return None;
    }
    let (mut right, mut up) = ((axis + 1) % 3, (axis + 2) % 3);
    if normal[axis] < 0.0 {
        (right, up) = (up, right);
    }
    let point = move |p: &[f32; 3]| Point {
        x: f64::from(p[right]),
        y: f64::from(p[up]),
    };
    // A shear along the normal onto the plane of the two axes preserves crossings.
    let slope = [right, up].map(|k| normal[k] / normal[axis]);
    let own = move |p: &[f32; 3]| {
        let (Point { x, y }, depth) = (point(p), f64::from(p[axis]));
        Point {
            x: x - slope[0] * depth,
            y: y - slope[1] * depth,
        }
    };
    let exact = polygon.iter().map(point).collect();
    // Both planes are equal if the normal is along the axis.
    let other = (slope != [0.0; 2]).then_some(own);
    Some(
        std::iter::once(exact).chain(
            other
                .into_iter()
                .map(|own| polygon.iter().map(own).collect()),
        ),
    )
}

/// Twice the polygon's area along each axis.
fn newell(polygon: &[[f32; 3]]) -> [f64; 3] {
    let Some(first) = polygon.first() else {
        return [0.0; 3];
    };
    // Relative to a corner, because the sum would lose precision far from the origin.
    let from = |p: &[f32; 3]| [0, 1, 2].map(|k| f64::from(p[k]) - f64::from(first[k]));
    let mut sum = [0.0; 3];
    for (i, p) in polygon.iter().enumerate() {
        let (a, b) = (from(p), from(polygon.get(i + 1).unwrap_or(first)));
        for (k, sum) in sum.iter_mut().enumerate() {
            let (x, y) = ((k + 1) % 3, (k + 2) % 3);
            *sum += a[x] * b[y] - a[y] * b[x];
        }
    }
    sum
}

/// Whether any successive corners span an area: false for points and lines.
pub(super) fn has_area(polygon: &[[f32; 3]]) -> bool {
    let mut triangles = polygon
        .windows(2)
        .filter_map(|pair| Some([*polygon.first()?, pair[0], pair[1]]));
    triangles.any(|triangle| newell(&triangle).iter().any(|a| *a != 0.0))
}

/// Twice the signed area, positive if counter-clockwise.
pub(super) fn area(points: &[Point]) -> f64 {
    let first = points.first().copied().unwrap_or(Point { x: 0.0, y: 0.0 });
    points
        .windows(2)
        .map(|pair| cross(first, pair[0], pair[1]))
        .sum()
}

/// Whether every corner turns left and the polygon winds once.
pub(super) fn is_convex(points: &[Point]) -> bool {
    let count = points.len();
    let at = |i: usize| points[i % count];
    let turns_left = (0..count).all(|i| cross(at(i), at(i + 1), at(i + 2)) > 0.0);
    let rises = |i: usize| at(i + 1).x > at(i).x || at(i + 1).x == at(i).x && at(i + 1).y > at(i).y;
    turns_left && (0..count).filter(|i| rises(*i) != rises(i + 1)).count() <= 2
}

/// Twice the signed area of a triangle, positive if counter-clockwise.
pub(super) fn cross(a: Point, b: Point, c: Point) -> f64 {
    (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x)
}

pub(super) fn inside(triangle: [Point; 3], p: Point) -> Inside {
    let [a, b, c] = triangle;
    let sides = [cross(a, b, p), cross(b, c, p), cross(c, a, p)];
    if sides.iter().any(|side| *side < 0.0) {
        return Inside::No;
    }
    match triangle.iter().position(|corner| *corner == p) {
        Some(corner) => Inside::Corner(corner),
        None if sides.contains(&0.0) => Inside::Rim,
        None => Inside::Yes,
    }
}

/// Whether an edge from a corner of the triangle towards `to` starts inside it.
pub(super) fn enters(triangle: [Point; 3], corner: usize, to: Point) -> bool {
    let [from, next, previous] = [0, 1, 2].map(|k| triangle[(corner + k) % 3]);
    cross(from, next, to) > 0.0 && cross(from, to, previous) > 0.0
}
