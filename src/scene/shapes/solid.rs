//! Walls with real thickness: boxes filled and hollowed out on one grid, so that what is closed has no cracks.

use glam::Vec3;
use indexmap::IndexMap;
use serde::Deserialize;

use super::{FACES, MeshBuilder, Paint};

/// Cuts closer than this are one, so that rounding makes no slivers (m).
const SAME_CUT: f32 = 1e-4;

/// Cells of the grid, times boxes: of one solid.
const MAX_WORK: usize = 1 << 24;

/// Materials of a hollow's faces by their normals -x, +x, -y, +y, -z, +z.
type Lining = [u32; 6];

/// A box that is hollowed out.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct Hollow {
    /// Of the faces that it lays bare.
    material: Paint,
    low: Vec3,
    high: Vec3,
    /// Other materials, by the way that a face looks: "+y" is the floor of a room.
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

/// What the inside of a box is made of.
#[derive(Clone, Copy)]
enum Stuff {
    Solid(u32),
    Hollow(Lining),
}

/// Boxes in the order in which they are filled or hollowed out: the last one that holds a point says what is there.
#[derive(Default)]
pub(in crate::scene) struct Solid {
    boxes: Vec<(Vec3, Vec3, Stuff)>,
}

impl Solid {
    pub fn fill(&mut self, low: Vec3, high: Vec3, material: u32) {
        self.boxes.push((low, high, Stuff::Solid(material)));
    }

    /// Adds the surface: the faces between cells of the grid that are solid and those that are not. Returns what it took,
    /// in cells times boxes.
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
            // The last cut ends the grid; one below the first wraps around to far beyond the last.
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

    /// Coordinates at which a box begins or ends, in order.
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
