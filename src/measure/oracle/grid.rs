//! The grid of a volume's cells.

use glam::DVec3;
use std::ops::Range;

/// Maximum cells along an axis: cell indices fit 30 bits.
const MAX_CELLS: usize = 1024;

/// A rectilinear grid; spacing may vary.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// World coordinates of the cell borders along x, y and z, increasing, one more than cells (m).
    borders: [Vec<f64>; 3],
}

impl Grid {
    /// A grid from its borders.
    ///
    /// # Errors
    /// Fewer than 1 or more than 1024 cells along an axis; borders that do not increase or are not
    /// finite.
    pub fn new(borders: [Vec<f64>; 3]) -> Result<Grid, String> {
        for (axis, list) in ["x", "y", "z"].iter().zip(&borders) {
            if !(2..=MAX_CELLS + 1).contains(&list.len()) {
                let cells = list.len().saturating_sub(1);
                return Err(format!(
                    "{cells} cells along {axis}; the oracle takes 1 to {MAX_CELLS}"
                ));
            }
            if !list.iter().all(|b| b.is_finite()) || !list.windows(2).all(|w| w[0] < w[1]) {
                return Err(format!(
                    "the cells' borders along {axis} do not rise, or are no numbers"
                ));
            }
        }
        Ok(Grid { borders })
    }

    /// Cells along x, y and z.
    pub fn size(&self) -> [u32; 3] {
        [0, 1, 2].map(|axis| self.borders[axis].len() as u32 - 1)
    }

    /// Total number of cells.
    pub fn count(&self) -> usize {
        self.size().iter().map(|n| *n as usize).product()
    }

    /// The index of a cell: x + width * (y + height * z).
    pub fn number(&self, [x, y, z]: [u32; 3]) -> u32 {
        let [width, height, _] = self.size();
        x + width * (y + height * z)
    }

    /// The coordinates of a cell by index.
    pub fn place(&self, number: u32) -> [u32; 3] {
        let [width, height, _] = self.size();
        [
            number % width,
            number / width % height,
            number / width / height,
        ]
    }

    /// Lowest and highest corner of a cell (m).
    pub fn corners(&self, cell: [u32; 3]) -> (DVec3, DVec3) {
        let at = |i: u32| [0, 1, 2].map(|axis| self.borders[axis][(cell[axis] + i) as usize]);
        (DVec3::from_array(at(0)), DVec3::from_array(at(1)))
    }

    /// Cells along an axis that [low, high] touches (m), plus one on each side against rounding.
    pub fn touched(&self, axis: usize, low: f64, high: f64) -> Range<u32> {
        let borders = &self.borders[axis];
        let last = borders.len() - 1;
        let first = borders.partition_point(|b| *b < low).saturating_sub(2);
        let end = (borders.partition_point(|b| *b <= high) + 1).min(last);
        if high < borders[0] || low > borders[last] {
            0..0
        } else {
            first as u32..end as u32
        }
    }

    /// Edge lengths of the cell at a point, or of the nearest cell (m).
    pub(crate) fn edges_at(&self, p: DVec3) -> DVec3 {
        let edge = |axis: usize| {
            let borders = &self.borders[axis];
            let i = borders
                .partition_point(|b| *b <= p[axis])
                .clamp(1, borders.len() - 1);
            borders[i] - borders[i - 1]
        };
        DVec3::new(edge(0), edge(1), edge(2))
    }
}
