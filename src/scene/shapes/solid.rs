//! Watertight walls: boxes are added to and subtracted from a common grid.

use glam::Vec3;
use indexmap::IndexMap;
use serde::Deserialize;

use super::{FACES, MeshBuilder, Paint};

/// Cuts closer than this are merged, so that rounding makes no slivers (m).
const SAME_CUT: f32 = 1e-4;

/// Maximum grid cells times boxes of one solid.
const MAX_WORK: usize = 1 << 24;

/// Materials of the faces of a subtracted box by normal: -x, +x, -y, +y, -z, +z.
type Lining = [u32; 6];

/// A subtracted box.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Hollow {
    /// Material of the exposed faces.
    material: Paint,
    low: Vec3,
    high: Vec3,
    /// Overrides by face direction: "+y" is the floor of a room.
    #[serde(default)]
    faces: IndexMap<String, Paint>,
}

impl Hollow {
    pub fn carve(&self, solid: &mut Solid, mesh: &mut MeshBuilder, at: Vec3) {
        if let Some(face) = self
            .faces
            .keys()
            .find(|face| !FACES.contains(&face.as_str()))
        {
            mesh.fail(
                face,
                format!(
                    "a hollow has no face '{face}': it is one of {}",
                    FACES.join(", ")
                ),
            );
        }
        let lining = FACES.map(|face| mesh.paint(self.faces.get(face).unwrap_or(&self.material)));
        solid
            .boxes
            .push((self.low + at, self.high + at, Stuff::Hollow(lining)));
    }
}

/// Content of a box.
#[derive(Clone, Copy)]
enum Stuff {
    Solid(u32),
    Hollow(Lining),
}

/// Boxes in order; the last one that contains a point decides.
#[derive(Default)]
pub(in crate::scene) struct Solid {
    boxes: Vec<(Vec3, Vec3, Stuff)>,
}

impl Solid {
    pub fn fill(&mut self, low: Vec3, high: Vec3, material: u32) {
        self.boxes.push((low, high, Stuff::Solid(material)));
    }

    /// Adds the surface between solid and empty grid cells. Returns the work in cells times boxes.
    pub fn build(&self, mesh: &mut MeshBuilder) -> usize {
        let cuts = [0, 1, 2].map(|axis| self.cuts(axis));
        let work = cuts.iter().fold(self.boxes.len(), |work, cuts| {
            work.saturating_mul(cuts.len())
        });
        if self.boxes.is_empty() || work > MAX_WORK {
            mesh.fail("", format!("a solid needs at least one box, and its cells times boxes be at most {MAX_WORK}"));
            return 0;
        }
        let corner =
            |cell: [usize; 3]| Vec3::from_array([0, 1, 2].map(|axis| cuts[axis][cell[axis]]));
        let stuff = |cell: [usize; 3]| {
            // The last cut ends the grid; an index below the first wraps far beyond the last.
            let inside = (0..3).all(|axis| cell[axis] < cuts[axis].len() - 1);
            inside
                .then(|| self.at((corner(cell) + corner(cell.map(|i| i + 1))) * 0.5))
                .flatten()
        };
        let [nx, ny, nz] = [0, 1, 2].map(|axis| cuts[axis].len() - 1);
        for cell in (0..nx * ny * nz).map(|i| [i % nx, i / nx % ny, i / nx / ny]) {
            let Some(Stuff::Solid(material)) = stuff(cell) else {
                continue;
            };
            for face in 0..6 {
                let mut beside = cell;
                beside[face / 2] = if face % 2 == 0 {
                    cell[face / 2].wrapping_sub(1)
                } else {
                    cell[face / 2] + 1
                };
                let material = match stuff(beside) {
                    Some(Stuff::Solid(_)) => continue,
                    Some(Stuff::Hollow(lining)) => lining[face],
                    None => material,
                };
                let only = [0, 1, 2, 3, 4, 5].map(|i| i == face);
                mesh.cuboid(
                    material,
                    corner(cell),
                    corner(cell.map(|i| i + 1)),
                    1.0,
                    only,
                );
            }
        }
        work
    }

    /// Sorted coordinates of box faces along an axis.
    fn cuts(&self, axis: usize) -> Vec<f32> {
        let mut cuts: Vec<f32> = self
            .boxes
            .iter()
            .flat_map(|(low, high, _)| [low[axis], high[axis]])
            .collect();
        cuts.sort_by(f32::total_cmp);
        cuts.dedup_by(|b, a| *b - *a < SAME_CUT);
        cuts
    }

    fn at(&self, point: Vec3) -> Option<Stuff> {
        let holds = |low: Vec3, high: Vec3| low.cmplt(point).all() && point.cmplt(high).all();
        self.boxes
            .iter()
            .rev()
            .find(|(low, high, _)| holds(*low, *high))
            .map(|entry| entry.2)
    }
}
