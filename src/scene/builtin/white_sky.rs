//! The white-sky test: a convex white object under a white sky has the sky's radiance.

use glam::Vec3;

use super::shapes::MeshBuilder;
use super::{assemble, matte, view};
use crate::scene::Scene;

pub(super) fn build() -> Scene {
    let mut mesh = MeshBuilder::new("sphere");
    mesh.icosphere(0, Vec3::ZERO, 1.0, 4);
    let mut scene = assemble("white-sky", vec![matte("white", Vec3::ONE)], vec![mesh.finish()]);
    scene.sky = Vec3::ONE;
    scene.cameras.insert("default".into(), view(Vec3::new(0.0, 0.0, 3.5), Vec3::ZERO, 45.0, 3.5));
    scene
}
