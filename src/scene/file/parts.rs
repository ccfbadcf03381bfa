//! Declarations of a scene file: parts of meshes, repetitions and instances.

use std::f32::consts::TAU;

use glam::{Mat4, Vec3};
use serde::Deserialize;

use super::placement::{Moves, Placed};
use crate::scene::shapes::*;

/// Positions of one repetition, and of all instances.
pub(super) const MAX_PLACES: u32 = 1 << 16;

/// A part of a mesh.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) enum Part {
    Arch(Arch),
    Banner(Banner),
    Bars(Bars),
    Box(Cuboid),
    Capital(Capital),
    Chain(Chain),
    Crown(Crown),
    Curtain(Curtain),
    Cylinder(Cylinder),
    Hip(Hip),
    /// Only inside a solid.
    Hollow(Hollow),
    Lathe(Lathe),
    Level(Level),
    Moulding(Moulding),
    Quad(Quad),
    Ring(Ring),
    Rod(Rod),
    Slope(Slope),
    Specks(Specks),
    Sphere(Ball),
    Sprigs(Sprigs),
    Triangle(Triangle),
    Vase(Vase),
    Vault(Vault),
    /// Watertight union and difference of boxes, in order.
    Solid(Vec<Part>),
    /// The parts of a named group.
    Group(String),
    /// Restarts the random numbers for the parts that follow.
    Seed(u64),
    Repeat(Repeat),
}

/// Parts at several positions.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Repeat {
    #[serde(default)]
    pub(super) at: Places,
    /// Rotation at each position: degrees about x, then y, then z; multiples of 90 about y are
    /// exact.
    #[serde(default)]
    pub(super) rotate_deg: Option<Vec3>,
    #[serde(default)]
    pub(super) quarters: Option<u8>,
    #[serde(default)]
    pub(super) scale: Option<Vec3>,
    /// Increment per position of the index that selects materials and seeds.
    #[serde(default = "one")]
    pub(super) counts: u32,
    pub(super) parts: Vec<Part>,
}

fn one() -> u32 {
    1
}

impl Repeat {
    /// Rotation and scale at each position; `None` if the file gives neither.
    pub(super) fn transform(&self) -> Option<Mat4> {
        if self.rotate_deg.is_none() && self.quarters.is_none() && self.scale.is_none() {
            return None;
        }
        let [x, y, z] = self
            .rotate_deg
            .unwrap_or_default()
            .to_array()
            .map(f32::to_radians);
        let turned = Mat4::from_rotation_z(z) * Mat4::from_rotation_y(y) * Mat4::from_rotation_x(x);
        let (side, back) = [
            (Vec3::X, Vec3::Z),
            (-Vec3::Z, Vec3::X),
            (-Vec3::X, -Vec3::Z),
            (Vec3::Z, -Vec3::X),
        ][usize::from(self.quarters.unwrap_or_default() % 4)];
        let quarters = Mat4::from_cols(
            side.extend(0.0),
            Vec3::Y.extend(0.0),
            back.extend(0.0),
            glam::Vec4::W,
        );
        Some(turned * quarters * Mat4::from_scale(self.scale.unwrap_or(Vec3::ONE)))
    }
}

/// Positions of a repetition.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) enum Places {
    At(Vec<Vec3>),
    /// Steps and their counts; the last axis varies fastest.
    Grid {
        from: Vec3,
        steps: Vec<(Vec3, u32)>,
    },
    /// Evenly from end to end.
    Line {
        from: Vec3,
        to: Vec3,
        count: u32,
    },
    /// Around y, with x pointing outwards.
    Circle {
        radius: f32,
        count: u32,
    },
}

impl Default for Places {
    fn default() -> Self {
        Places::At(vec![Vec3::ZERO])
    }
}

impl Places {
    /// Rotations about y (radians) and positions.
    pub(super) fn list(&self) -> Result<Vec<(f32, Vec3)>, String> {
        let count = match self {
            Places::At(list) => list.len() as u64,
            Places::Grid { steps, .. } => {
                steps.iter().fold(1u64, |n, s| n.saturating_mul(s.1.into()))
            }
            Places::Line { count, .. } | Places::Circle { count, .. } => u64::from(*count),
        };
        if count > u64::from(MAX_PLACES) {
            return Err(format!(
                "a repetition has {count} places, and {MAX_PLACES} are the most"
            ));
        }
        let place = |i: u32| match self {
            Places::At(list) => (0.0, list[i as usize]),
            Places::Grid { from, steps } => {
                let mut left = i;
                let mut numbers = Vec::new();
                for (_, count) in steps.iter().rev() {
                    numbers.push((left % count) as f32);
                    left /= count;
                }
                (
                    0.0,
                    steps
                        .iter()
                        .zip(numbers.iter().rev())
                        .fold(*from, |p, (step, n)| p + step.0 * *n),
                )
            }
            Places::Line { from, to, count } => (
                0.0,
                *from + (*to - *from) * i as f32 / (count - 1).max(1) as f32,
            ),
            Places::Circle { radius, count } => {
                let turn = i as f32 / *count as f32 * TAU;
                (
                    turn,
                    Mat4::from_rotation_y(turn).transform_point3(Vec3::X * *radius),
                )
            }
        };
        Ok((0..count as u32).map(place).collect())
    }
}

/// Placements of a mesh that occurs more than once or moves.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InstanceEntry {
    /// Cycled over the positions.
    pub(super) meshes: Vec<String>,
    /// Replaces the mesh's name.
    #[serde(default)]
    pub(super) name: Option<String>,
    #[serde(default)]
    pub(super) transform: Placed,
    #[serde(default)]
    pub(super) animation: Option<Moves>,
    /// Positions in the frame of the transform, each moved; several instances get numbered names.
    #[serde(default)]
    pub(super) at: Option<Places>,
}
