//! Walls with real thickness: boxes filled and hollowed out on one grid, so that what is closed has no cracks.

use glam::Vec3;

use super::shapes::MeshBuilder;

/// Cuts closer than this are one, so that rounding makes no slivers (m).
const SAME_CUT: f32 = 1e-4;

/// Materials of a hollow's faces by their normals -x, +x, -y, +y, -z, +z.
pub(super) type Lining = [u32; 6];

/// A lining by what it is in a room.
pub(super) fn lining(floor: u32, walls: u32, ceiling: u32) -> Lining {
    [walls, walls, ceiling, floor, walls, walls]
}

/// What the inside of a box is made of.
#[derive(Clone, Copy)]
enum Stuff {
    Solid(u32),
    Hollow(Lining),
}

/// Boxes in the order in which they are filled or hollowed out: the last one that holds a point says what is there.
#[derive(Default)]
pub(super) struct Solid {
    boxes: Vec<(Vec3, Vec3, Stuff)>,
}

impl Solid {
    pub fn fill(&mut self, low: Vec3, high: Vec3, material: u32) {
        self.boxes.push((low, high, Stuff::Solid(material)));
    }

    /// Faces that this lays bare get the lining's materials.
    pub fn carve(&mut self, low: Vec3, high: Vec3, lining: Lining) {
        self.boxes.push((low, high, Stuff::Hollow(lining)));
    }

    /// Adds the surface: the faces between cells of the grid that are solid and those that are not.
    pub fn build(&self, mesh: &mut MeshBuilder) {
        let cuts = [0, 1, 2].map(|axis| self.cuts(axis));
        let corner = |cell: [usize; 3]| Vec3::from_array([0, 1, 2].map(|axis| cuts[axis][cell[axis]]));
        let stuff = |cell: [usize; 3]| {
            // The last cut ends the grid; one below the first wraps around to far beyond the last.
            let inside = (0..3).all(|axis| cell[axis] < cuts[axis].len() - 1);
            inside.then(|| self.at((corner(cell) + corner(cell.map(|i| i + 1))) * 0.5)).flatten()
        };
        let [nx, ny, nz] = [0, 1, 2].map(|axis| cuts[axis].len() - 1);
        for cell in (0..nx * ny * nz).map(|i| [i % nx, i / nx % ny, i / nx / ny]) {
            let Some(Stuff::Solid(material)) = stuff(cell) else {
                continue;
            };
            for face in 0..6 {
                let mut beside = cell;
                beside[face / 2] = if face % 2 == 0 { cell[face / 2].wrapping_sub(1) } else { cell[face / 2] + 1 };
                let material = match stuff(beside) {
                    Some(Stuff::Solid(_)) => continue,
                    Some(Stuff::Hollow(lining)) => lining[face],
                    None => material,
                };
                let only = [0, 1, 2, 3, 4, 5].map(|i| i == face);
                mesh.cuboid(material, corner(cell), corner(cell.map(|i| i + 1)), 1.0, only);
            }
        }
    }

    /// Coordinates at which a box begins or ends, in order.
    fn cuts(&self, axis: usize) -> Vec<f32> {
        let mut cuts: Vec<f32> = self.boxes.iter().flat_map(|(low, high, _)| [low[axis], high[axis]]).collect();
        cuts.sort_by(f32::total_cmp);
        cuts.dedup_by(|b, a| *b - *a < SAME_CUT);
        cuts
    }

    fn at(&self, point: Vec3) -> Option<Stuff> {
        let holds = |low: Vec3, high: Vec3| low.cmplt(point).all() && point.cmplt(high).all();
        self.boxes.iter().rev().find(|(low, high, _)| holds(*low, *high)).map(|entry| entry.2)
    }
}
