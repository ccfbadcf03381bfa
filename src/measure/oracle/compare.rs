//! Comparison of a voxelizer's cells with the exact ones.

use super::exact::Cell;
use super::fill::{Neighbours, flood};
use super::grid::Grid;
use super::overlap::Overlap;
use super::read::Voxel;
use super::shape::SHAPES;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Scores of a comparison; V is the voxelizer's set, E the exact one, both without borderline
/// cells.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// Cells of the voxelizer, including borderline ones.
    pub voxels: u64,
    /// Exact cells: |E|.
    pub exact: u64,
    /// Borderline cells, which rounding decides.
    pub(crate) borderline: u64,
    /// Missed cells: |E \ V|.
    pub holes: u64,
    /// Excess cells: |V \ E|.
    pub extras: u64,
    /// |V & E| / |E|; `None` if E is empty.
    pub recall: Option<f64>,
    /// |V & E| / |V|; `None` if V is empty.
    pub precision: Option<f64>,
    /// Cells of the thin set.
    pub thin: u64,
    /// Fraction of the thin set that V contains.
    pub thin_recall: Option<f64>,
    /// Cells enclosed by the exact surfaces; if 0, the next two fields are meaningless.
    pub enclosed: u64,
    /// Enclosed cells that a path from outside through faces reaches past V.
    pub leaked_6: u64,
    /// Enclosed cells that a path through faces, edges and corners reaches.
    pub leaked_26: u64,
    /// RMS difference of a linear base colour's channel over V & E.
    pub color_rms: f64,
    /// Largest difference of a channel.
    pub(crate) color_max: f64,
    /// Mean angle between normals (degrees), where the exact normals are longer than 0.5.
    pub(crate) normal_mean: f64,
    /// Mean difference of opacity and exact coverage.
    pub(crate) opacity_bias: f64,
    /// RMS difference of opacity and exact coverage.
    pub(crate) opacity_rms: f64,
    /// The scores by class of triangle.
    pub shapes: BTreeMap<String, ShapeScore>,
}

/// Scores of the cells that triangles of a class overlap, possibly with others.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ShapeScore {
    pub exact: u64,
    /// Missed cells.
    pub holes: u64,
    /// Excess cells next to such a cell (26 neighbours).
    pub extras: u64,
    /// Found cells relative to the exact ones.
    pub recall: f64,
    /// Found cells relative to found and excess ones.
    pub precision: Option<f64>,
    /// RMS difference of a linear base colour's channel.
    pub color_rms: f64,
}

/// Scores, and cells by index.
#[derive(Clone, Debug, Default)]
pub struct Comparison {
    pub score: Score,
    /// Cells in both sets, and borderline cells of the voxelizer.
    pub right: Vec<u32>,
    /// Exact cells that the voxelizer misses.
    pub holes: Vec<u32>,
    /// Cells of the voxelizer that no triangle overlaps.
    pub extras: Vec<u32>,
}

/// The items with set bits.
fn among<T>(list: &mut [T], bits: u8) -> impl Iterator<Item = &mut T> {
    let set = move |(i, _): &(usize, &mut T)| bits >> i & 1 != 0;
    list.iter_mut()
        .enumerate()
        .filter(set)
        .map(|(_, item)| item)
}

/// Compares a voxelizer's cells with the exact ones; both sorted by index.
pub fn compare(grid: &Grid, exact: &[Cell], voxels: &[Voxel]) -> Comparison {
    let mut out = Comparison::default();
    let mut errors = Errors::default();
    let mut shapes: [(ShapeScore, Errors); SHAPES.len()] = Default::default();
    let (mut thin_found, mut found) = (0, 0);
    let mut rest = voxels.iter().peekable();
    for cell in exact {
        while let Some(voxel) = rest.next_if(|v| v.number < cell.number) {
            out.extras.push(voxel.number);
        }
        let voxel = rest.next_if(|v| v.number == cell.number);
        if cell.thin == Overlap::Inside {
            out.score.thin += 1;
            thin_found += u64::from(voxel.is_some());
        }
        out.right.extend(voxel.map(|v| v.number));
        if cell.overlap == Overlap::Borderline {
            out.score.borderline += 1;
            continue;
        }
        out.score.exact += 1;
        match voxel {
            Some(voxel) => {
                found += 1;
                errors.add(cell, voxel);
            }
            None => out.holes.push(cell.number),
        }
        for (shape, errors) in among(&mut shapes, cell.shapes) {
            shape.exact += 1;
            match voxel {
                Some(voxel) => errors.add(cell, voxel),
                None => shape.holes += 1,
            }
        }
    }
    out.extras.extend(rest.map(|v| v.number));
    for extra in &out.extras {
        let near = shapes_near(grid, exact, *extra);
        among(&mut shapes, near).for_each(|(shape, _)| shape.extras += 1);
    }
    let score = &mut out.score;
    score.voxels = voxels.len() as u64;
    score.holes = out.holes.len() as u64;
    score.extras = out.extras.len() as u64;
    score.recall = ratio(found, score.exact);
    score.precision = ratio(found, found + score.extras);
    score.thin_recall = ratio(thin_found, score.thin);
    errors.finish(score);
    for (name, (mut shape, errors)) in SHAPES.iter().zip(shapes).filter(|(_, s)| s.0.exact > 0) {
        let found = shape.exact - shape.holes;
        shape.recall = found as f64 / shape.exact as f64;
        shape.precision = ratio(found, found + shape.extras);
        shape.color_rms = errors.color_rms();
        score.shapes.insert((*name).to_string(), shape);
    }
    (score.enclosed, score.leaked_6, score.leaked_26) = leaks(grid, exact, voxels);
    out
}

fn ratio(part: u64, whole: u64) -> Option<f64> {
    (whole > 0).then(|| part as f64 / whole as f64)
}

/// Sums over cells in both sets.
#[derive(Default)]
struct Errors {
    cells: u64,
    color: f64,
    color_max: f64,
    normals: u64,
    angle: f64,
    opacity: f64,
    opacity_squared: f64,
}

impl Errors {
    fn add(&mut self, cell: &Cell, voxel: &Voxel) {
        self.cells += 1;
        let color = (voxel.color - cell.color).as_dvec3();
        self.color += color.length_squared();
        self.color_max = self.color_max.max(color.abs().max_element());
        let exact = cell.normal.as_dvec3();
        if exact.length() > 0.5 && voxel.normal != glam::Vec3::ZERO {
            let cosine = exact.normalize().dot(voxel.normal.as_dvec3());
            self.normals += 1;
            self.angle += cosine.clamp(-1.0, 1.0).acos().to_degrees();
        }
        let opacity = f64::from(voxel.opacity - cell.coverage);
        self.opacity += opacity;
        self.opacity_squared += opacity * opacity;
    }

    fn color_rms(&self) -> f64 {
        (self.color / (3 * self.cells).max(1) as f64).sqrt()
    }

    fn finish(&self, score: &mut Score) {
        let cells = self.cells.max(1) as f64;
        score.color_rms = self.color_rms();
        score.color_max = self.color_max;
        score.normal_mean = self.angle / self.normals.max(1) as f64;
        score.opacity_bias = self.opacity / cells;
        score.opacity_rms = (self.opacity_squared / cells).sqrt();
    }
}

/// The classes of triangles in the cells around a cell.
fn shapes_near(grid: &Grid, exact: &[Cell], number: u32) -> u8 {
    let [x, y, z] = grid.place(number);
    let size = grid.size();
    let mut set = 0;
    for z in z.saturating_sub(1)..(z + 2).min(size[2]) {
        for y in y.saturating_sub(1)..(y + 2).min(size[1]) {
            for x in x.saturating_sub(1)..(x + 2).min(size[0]) {
                let number = grid.number([x, y, z]);
                if let Ok(i) = exact.binary_search_by_key(&number, |c| c.number) {
                    set |= exact[i].shapes;
                }
            }
        }
    }
    set
}

/// Enclosed cells of the exact surfaces, and how many of them a flood fill from outside reaches
/// past the voxels: through faces, and through edges and corners too.
fn leaks(grid: &Grid, exact: &[Cell], voxels: &[Voxel]) -> (u64, u64, u64) {
    let set = |numbers: &mut dyn Iterator<Item = u32>| {
        let mut blocked = vec![false; grid.count()];
        numbers.for_each(|n| blocked[n as usize] = true);
        blocked
    };
    // Borderline cells block the fill, because a gap would open closed surfaces.
    let surface = set(&mut exact.iter().map(|c| c.number));
    let outside = flood(grid, &surface, Neighbours::TwentySix);
    let inside: Vec<usize> = (0..grid.count())
        .filter(|i| !surface[*i] && !outside[*i])
        .collect();
    if inside.is_empty() {
        return (0, 0, 0);
    }
    let blocked = set(&mut voxels.iter().map(|v| v.number));
    let reached = |neighbours| {
        let reached = flood(grid, &blocked, neighbours);
        inside.iter().filter(|i| reached[**i]).count() as u64
    };
    (
        inside.len() as u64,
        reached(Neighbours::Six),
        reached(Neighbours::TwentySix),
    )
}
