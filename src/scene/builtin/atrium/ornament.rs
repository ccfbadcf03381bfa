//! The fountain in the middle of the court and the armillary sphere that floats above it.

use glam::{Quat, Vec2, Vec3};

use super::materials::{COPPER, GOLD, MARBLE, TRIM, WATER};
use crate::scene::Mesh;
use crate::scene::builtin::shapes::MeshBuilder;

/// Basin on two steps, water, and a bowl on a stem.
pub(super) fn fountain() -> Mesh {
    let mut mesh = MeshBuilder::new("fountain");
    let p = Vec2::new;
    let step = [p(2.05, 0.0), p(2.05, 0.11), p(2.03, 0.13), p(1.2, 0.13)];
    mesh.lathe(TRIM, 48, 9, 1.0, &step);
    let basin = [
        p(1.62, 0.12),
        p(1.62, 0.22),
        p(1.55, 0.27),
        p(1.50, 0.34),
        p(1.52, 0.50),
        p(1.60, 0.60),
        p(1.68, 0.64),
        p(1.68, 0.70),
        p(1.64, 0.73),
        p(1.44, 0.73),
        p(1.40, 0.70),
        p(1.38, 0.60),
        p(1.34, 0.42),
        p(1.25, 0.34),
    ];
    mesh.lathe(MARBLE, 48, 26, 1.5, &basin);
    mesh.lathe(WATER, 48, 2, 1.0, &[p(1.37, 0.58), p(0.7, 0.583), p(0.0, 0.58)]);
    let stem = [
        p(0.42, 0.40),
        p(0.40, 0.66),
        p(0.24, 0.74),
        p(0.15, 0.84),
        p(0.13, 1.0),
        p(0.17, 1.12),
        p(0.14, 1.20),
        p(0.22, 1.27),
        p(0.46, 1.34),
        p(0.66, 1.44),
        p(0.74, 1.54),
        p(0.74, 1.58),
        p(0.69, 1.585),
        p(0.60, 1.50),
        p(0.40, 1.45),
        p(0.12, 1.44),
    ];
    mesh.lathe(MARBLE, 36, 30, 1.0, &stem);
    mesh.lathe(WATER, 36, 1, 1.0, &[p(0.645, 1.535), p(0.0, 1.535)]);
    mesh.lathe(
        COPPER,
        18,
        10,
        1.0,
        &[p(0.10, 1.42), p(0.10, 1.6), p(0.05, 1.66), p(0.09, 1.72), p(0.03, 1.80), p(0.0, 1.84)],
    );
    mesh.finish()
}

/// A gold globe inside of three rings, around the origin.
pub(super) fn armillary() -> Mesh {
    let mut mesh = MeshBuilder::new("armillary sphere");
    mesh.icosphere(GOLD, Vec3::ZERO, 0.30, 4);
    for (tilt, radius, material) in [(0.0f32, 0.52, COPPER), (1.05, 0.47, GOLD), (2.1, 0.42, COPPER)] {
        let turn = Quat::from_rotation_x(0.41) * Quat::from_rotation_z(tilt);
        mesh.ring(material, Vec3::ZERO, turn * Vec3::X * radius, turn * Vec3::Z * radius, 0.022, [64, 8]);
    }
    let axis = Quat::from_rotation_x(0.41) * Vec3::Y;
    let side = axis.any_orthonormal_vector();
    let other = axis.cross(side);
    mesh.surface(GOLD, 10, 2, Vec2::ONE, |u, v| {
        let (s, c) = (-u * std::f32::consts::TAU).sin_cos();
        axis * ((v * 2.0 - 1.0) * 0.66) + (side * c - other * s) * 0.014
    });
    for end in [-1.0f32, 1.0] {
        mesh.icosphere(COPPER, axis * (0.67 * end), 0.04, 2);
    }
    mesh.finish()
}
