//! How far a voxelizer's cells are from the exact ones.

use super::exact::Cell;
use super::fill::{Neighbours, flood};
use super::grid::Grid;
use super::overlap::Overlap;
use super::read::Voxel;
use super::shape::SHAPES;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Figures of a comparison; V is the voxelizer's set, E the exact one, both without borderline cells.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Score {
    /// Cells of the voxelizer, borderline ones too.
    pub voxels: u64,
    /// |E|.
    pub exact: u64,
    /// Cells too near to say.
    pub(crate) borderline: u64,
    /// |E \ V|.
    pub holes: u64,
    /// |V \ E|.
    pub extras: u64,
    /// |V & E| / |E|; none where E is empty.
    pub recall: Option<f64>,
    /// |V & E| / |V|; none where V is empty.
    pub precision: Option<f64>,
    /// Cells of the thin set.
    pub thin: u64,
    /// The part of the thin set that V has.
    pub thin_recall: Option<f64>,
    /// Cells that the exact surfaces enclose; 0 where nothing is closed, and then the next two say nothing.
    pub enclosed: u64,
    /// Cells of them that a path from outside through faces reaches past V.
    pub leaked_6: u64,
    /// Cells of them that a path through faces, edges and corners reaches.
    pub leaked_26: u64,
    /// Over V & E: root of the mean squared difference of a linear base colour's channel, and the largest.
    pub color_rms: f64,
    /// The largest difference of a channel.
    pub(crate) color_max: f64,
    /// Mean angle between normals where the exact ones agree by more than half, degrees.
    pub(crate) normal_mean: f64,
    /// Mean of opacity less exact coverage.
    pub(crate) opacity_bias: f64,
    /// Root mean square of the same.
    pub(crate) opacity_rms: f64,
    /// The scores by class of triangle.
    pub shapes: BTreeMap<String, ShapeScore>,
}

/// Figures of the cells that triangles of a class overlap; others may overlap them too.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ShapeScore {
    pub exact: u64,
    /// Cells that the voxelizer misses.
    pub holes: u64,
    /// Extras beside (26 neighbours) such a cell.
    pub extras: u64,
    /// Found of the exact ones.
    pub recall: f64,
    /// Found over found and extras.
    pub precision: Option<f64>,
    /// Root mean square difference of a linear base colour's channel.
    pub color_rms: f64,
}

/// The figures, and cells by number.
#[derive(Clone, Debug)]
pub struct Comparison {
    pub score: Score,
    /// In both sets, or borderline and in the voxelizer's.
    pub right: Vec<u32>,
    /// Exact ones that the voxelizer misses.
    pub holes: Vec<u32>,
    /// The voxelizer's that no triangle overlaps.
    pub extras: Vec<u32>,
}

/// Compares a voxelizer's cells with the exact ones; both in order of numbers.
pub fn compare(grid: &Grid, exact: &[Cell], voxels: &[Voxel]) -> Comparison {
    let mut out = Comparison {
        score: Score::default(),
        right: Vec::new(),
        holes: Vec::new(),
        extras: Vec::new(),
    };
    let mut errors = Errors::default();
    let mut shapes: [(ShapeScore, Errors); SHAPES.len()] = Default::default();
    let mut thin_found = 0;
    let mut found = 0;
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
        for (_, (shape, errors)) in shapes
            .iter_mut()
            .enumerate()
            .filter(|(i, _)| cell.shapes >> i & 1 != 0)
        {
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
        for (_, (shape, _)) in shapes
            .iter_mut()
            .enumerate()
            .filter(|(i, _)| near >> i & 1 != 0)
        {
            shape.extras += 1;
        }
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

/// Sums over cells that are in both sets.
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

/// The classes of triangles in the cells around one.
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

/// Cells that the exact surfaces enclose, and how many of them a fill from outside reaches past the voxels: through faces,
/// and through edges and corners too.
fn leaks(grid: &Grid, exact: &[Cell], voxels: &[Voxel]) -> (u64, u64, u64) {
    let set = |numbers: &mut dyn Iterator<Item = u32>| {
        let mut blocked = vec![false; grid.count()];
        numbers.for_each(|n| blocked[n as usize] = true);
        blocked
    };
    // Borderline cells block here: else one of them would open what the triangles close.
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
