//! The cells that a scene's triangles exactly overlap, with their content.

use super::clip::{Corner, clip};
use super::grid::Grid;
use super::overlap::{Axes, Overlap};
use super::shape::shape_of;
use super::surface::Surfaces;
use super::triangle::Triangle;
use glam::{DVec3, Vec3, Vec4};
use rayon::prelude::*;
use std::ops::Range;

/// Layers of cells per parallel task, which bounds the memory of triangle-cell pairs.
const LAYERS: u32 = 4;

/// A cell that triangles overlap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Index in the grid.
    pub number: u32,
    /// Whether any triangle overlaps it. Also borderline if an alpha mask is undecided.
    pub overlap: Overlap,
    /// Overlap with the thin set.
    pub thin: Overlap,
    /// Bit i: a triangle of class `SHAPES[i]` overlaps it.
    pub shapes: u8,
    /// Area-weighted mean base colour of the triangles inside, linear.
    pub color: Vec3,
    /// Area-weighted mean shading normal of the triangles inside; shorter than 1 if they disagree.
    pub normal: Vec3,
    /// Covered fraction of a face along the axis of the largest coverage: the sum of the projected
    /// areas, regardless of mutual occlusion, at most 1.
    pub coverage: f32,
}

/// Overlap of one triangle and one cell.
struct Hit {
    number: u32,
    overlap: Overlap,
    thin: Overlap,
    shape: u8,
    area: f64,
    /// Sums weighted by area.
    color: DVec3,
    normal: DVec3,
    /// Projected area along x, y and z, relative to the cell's face.
    hidden: DVec3,
}

/// Every cell that is not outside all triangles, sorted by index. Parallel over layers; the result
/// does not depend on the number of threads. Memory: 60 bytes per cell, plus a few layers per
/// thread.
pub fn exact(triangles: &[Triangle], surfaces: &Surfaces<'_>, grid: &Grid) -> Vec<Cell> {
    let shapes: Vec<u8> = triangles
        .par_iter()
        .map(|t| shape_of(t.corners, grid) as u8)
        .collect();
    let depth = grid.size()[2];
    let slabs: Vec<Vec<Cell>> = (0..depth.div_ceil(LAYERS))
        .into_par_iter()
        .map(|slab| {
            let layers = slab * LAYERS..((slab + 1) * LAYERS).min(depth);
            let mut hits = Vec::new();
            for (t, shape) in triangles.iter().zip(&shapes) {
                add_hits(t, *shape, surfaces, grid, &layers, &mut hits);
            }
            // A stable sort keeps the order of triangles, so that the sums are reproducible.
            hits.sort_by_key(|h| h.number);
            hits.chunk_by(|a, b| a.number == b.number)
                .map(cell_of)
                .collect()
        })
        .collect();
    slabs.concat()
}

fn add_hits(
    t: &Triangle,
    shape: u8,
    surfaces: &Surfaces<'_>,
    grid: &Grid,
    layers: &Range<u32>,
    hits: &mut Vec<Hit>,
) {
    let low = t.corners[0].min(t.corners[1]).min(t.corners[2]);
    let high = t.corners[0].max(t.corners[1]).max(t.corners[2]);
    let [xs, ys, zs] = [0, 1, 2].map(|axis| grid.touched(axis, low[axis], high[axis]));
    let zs = zs.start.max(layers.start)..zs.end.min(layers.end);
    if xs.is_empty() || ys.is_empty() || zs.is_empty() {
        return;
    }
    let axes = Axes::new(t.corners);
    let normal = axes.normal();
    for z in zs {
        for y in ys.clone() {
            // A row is crossed at the plane; cells farther away need no test.
            for x in crossed(grid, t.corners[0], normal, xs.clone(), y, z) {
                let (low, high) = grid.corners([x, y, z]);
                let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
                let (overlap, thin) = axes.overlap(centre, half);
                if overlap == Overlap::Outside {
                    continue;
                }
                let hit = Hit {
                    number: grid.number([x, y, z]),
                    overlap,
                    thin,
                    shape,
                    area: 0.0,
                    color: DVec3::ZERO,
                    normal: DVec3::ZERO,
                    hidden: DVec3::ZERO,
                };
                hits.extend(filled(hit, t, surfaces, (low, high)));
            }
        }
    }
}

/// The cells of a row that the plane through `p` crosses, with one more on each side.
fn crossed(grid: &Grid, p: DVec3, normal: DVec3, xs: Range<u32>, y: u32, z: u32) -> Range<u32> {
    let (low, high) = grid.corners([xs.start, y, z]);
    let along = normal.x * 1e6;
    if along.abs() <= normal.y.abs().max(normal.z.abs()) {
        return xs;
    }
    let at = |y: f64, z: f64| p.x - (normal.y * (y - p.y) + normal.z * (z - p.z)) / normal.x;
    let ends = [
        at(low.y, low.z),
        at(high.y, low.z),
        at(low.y, high.z),
        at(high.y, high.z),
    ];
    let (first, last) = ends
        .iter()
        .fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(*x), h.max(*x)));
    let found = grid.touched(0, first, last);
    found.start.max(xs.start)..found.end.min(xs.end)
}

/// The hit with the colour, normal and area of the triangle inside the cell; `None` if its mask is
/// transparent.
fn filled(
    mut hit: Hit,
    t: &Triangle,
    surfaces: &Surfaces<'_>,
    (low, high): (DVec3, DVec3),
) -> Option<Hit> {
    let mut polygon = clip(t.corners, low, high);
    let touches = polygon.is_empty();
    if touches {
        // Only the boundary is touched: use the triangle's centroid.
        let position = (t.corners[0] + t.corners[1] + t.corners[2]) / 3.0;
        polygon.push(Corner {
            position,
            weights: DVec3::splat(1.0 / 3.0),
        });
    }
    let n = (t.corners[1] - t.corners[0]).cross(t.corners[2] - t.corners[0]);
    let direction = n.normalize_or_zero();
    let [a, b, c] = t.uv;
    let [u, v, w] = t.uv.map(|uv| surfaces.set(t.material, uv));
    // Texels per square metre of the triangle.
    let density =
        (v - u).perp_dot(w - u).abs() * surfaces.texels(t.material) / n.length().max(1e-30) as f32;
    let cutoff = surfaces.cutoff(t.material);
    let (mut there, mut gone) = (0.0, 0.0);
    for (weights, area) in samples(&polygon, direction, density > 0.0) {
        let w = weights.as_vec3();
        let uv: Vec4 = a * w.x + b * w.y + c * w.z;
        let tint = t.colors[0] * w.x + t.colors[1] * w.y + t.colors[2] * w.z;
        let base = tint
            * surfaces.base_color(
                t.material,
                uv,
                0.5 * (area as f32 * density).max(1e-6).log2(),
            );
        if base.w < cutoff {
            gone += area;
            continue;
        }
        there += area;
        hit.color += area * base.truncate().clamp(Vec3::ZERO, Vec3::ONE).as_dvec3();
        let shading = t.normals[0] * w.x + t.normals[1] * w.y + t.normals[2] * w.z;
        hit.normal += area * shading.normalize_or_zero().as_dvec3();
    }
    if there == 0.0 {
        return None;
    }
    if gone > 0.0 {
        hit.overlap = hit.overlap.min(Overlap::Borderline);
        hit.thin = hit.thin.min(Overlap::Borderline);
    }
    hit.area = there;
    if !touches {
        let edge = high - low;
        let faces = DVec3::new(edge.y * edge.z, edge.z * edge.x, edge.x * edge.y);
        hit.hidden = there * direction.abs() / faces;
    }
    Some(hit)
}

/// Sample positions on a clipped triangle as barycentric weights, and their areas (m^2): centroids
/// of a fan, each split in four for textures. A minimum area is used for touching triangles.
fn samples(polygon: &[Corner], direction: DVec3, textured: bool) -> Vec<(DVec3, f64)> {
    const TRACE: f64 = 1e-18;
    let mut list = Vec::new();
    for i in 1..polygon.len().saturating_sub(1) {
        let [p, q, r] = [polygon[0], polygon[i], polygon[i + 1]];
        let area = 0.5
            * (q.position - p.position)
                .cross(r.position - p.position)
                .dot(direction)
                .abs();
        let middle = |a: DVec3, b: DVec3, c: DVec3| (a + b + c) / 3.0;
        let (p, q, r) = (p.weights, q.weights, r.weights);
        if !textured {
            list.push((middle(p, q, r), area.max(TRACE)));
            continue;
        }
        let (pq, qr, rp) = (0.5 * (p + q), 0.5 * (q + r), 0.5 * (r + p));
        for [a, b, c] in [[p, pq, rp], [pq, q, qr], [rp, qr, r], [pq, qr, rp]] {
            list.push((middle(a, b, c), (0.25 * area).max(TRACE)));
        }
    }
    if list.is_empty() {
        list.extend(polygon.first().map(|c| (c.weights, TRACE)));
    }
    list
}

fn cell_of(hits: &[Hit]) -> Cell {
    let area: f64 = hits.iter().map(|h| h.area).sum();
    Cell {
        number: hits[0].number,
        overlap: hits
            .iter()
            .map(|h| h.overlap)
            .max()
            .unwrap_or(Overlap::Outside),
        thin: hits
            .iter()
            .map(|h| h.thin)
            .max()
            .unwrap_or(Overlap::Outside),
        shapes: hits.iter().fold(0, |set, h| set | 1 << h.shape),
        color: (hits.iter().map(|h| h.color).sum::<DVec3>() / area).as_vec3(),
        normal: (hits.iter().map(|h| h.normal).sum::<DVec3>() / area).as_vec3(),
        coverage: hits
            .iter()
            .map(|h| h.hidden)
            .sum::<DVec3>()
            .max_element()
            .min(1.0) as f32,
    }
}
