//! Flood fill from outside a volume, to find cells enclosed by a closed surface.

use super::grid::Grid;

/// Connectivity of cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Neighbours {
    /// Cells that share a face.
    Six,
    /// Cells that share a face, edge or corner.
    TwentySix,
}

/// For each cell by index, whether it is reachable from outside the grid without crossing
/// `blocked`.
pub fn flood(grid: &Grid, blocked: &[bool], neighbours: Neighbours) -> Vec<bool> {
    let size = grid.size().map(|n| n as i32);
    let steps: Vec<[i32; 3]> = (0..27i32)
        .map(|i| [i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1])
        .filter(|s| match s.iter().map(|d| d.abs()).sum::<i32>() {
            0 => false,
            1 => true,
            _ => neighbours == Neighbours::TwentySix,
        })
        .collect();
    let mut reached = vec![false; blocked.len()];
    let mut front: Vec<[i32; 3]> = Vec::new();
    let number = |[x, y, z]: [i32; 3]| (x + size[0] * (y + size[1] * z)) as usize;
    for z in 0..size[2] {
        for y in 0..size[1] {
            let whole = [0, size[2] - 1].contains(&z) || [0, size[1] - 1].contains(&y);
            let step = if whole { 1 } else { (size[0] - 1).max(1) };
            for x in (0..size[0]).step_by(step as usize) {
                let i = number([x, y, z]);
                if !blocked[i] {
                    reached[i] = true;
                    front.push([x, y, z]);
                }
            }
        }
    }
    // Breadth first, so that the front stays as small as a surface.
    let mut next = Vec::new();
    while !front.is_empty() {
        for cell in front.drain(..) {
            for step in &steps {
                let to: [i32; 3] = std::array::from_fn(|i| cell[i] + step[i]);
                if !(0..3).all(|i| (0..size[i]).contains(&to[i])) {
                    continue;
                }
                let i = number(to);
                if !blocked[i] && !reached[i] {
                    reached[i] = true;
                    next.push(to);
                }
            }
        }
        std::mem::swap(&mut front, &mut next);
    }
    reached
}
