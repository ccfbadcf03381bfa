//! The furnace test: inside a closed box of albedo a and emission e every radiance is e / (1 - a).

use glam::Vec3;

use super::shapes::MeshBuilder;
use super::{assemble, matte, view};
use crate::scene::{Material, Scene};

pub(super) fn build() -> Scene {
    let wall = Material { emission: Vec3::ONE, ..matte("wall", Vec3::splat(0.5)) };
    let mut mesh = MeshBuilder::new("walls");
    // Each wall looks inward: right x up points to the centre.
    for (right, up) in [
        (Vec3::X, Vec3::Y),
        (Vec3::Y, Vec3::X),
        (Vec3::Y, Vec3::Z),
        (Vec3::Z, Vec3::Y),
        (Vec3::Z, Vec3::X),
        (Vec3::X, Vec3::Z),
    ] {
        let back = -right.cross(up);
        mesh.quad(0, [back - right - up, back + right - up, back + right + up, back - right + up], 8, 1.0);
    }
    let mut scene = assemble("furnace", vec![wall], vec![mesh.finish()]);
    let camera = view(Vec3::new(0.2, 0.1, 0.7), Vec3::new(0.0, 0.0, -1.0), 60.0, 3.5);
    scene.cameras.insert("default".into(), camera);
    scene
}
