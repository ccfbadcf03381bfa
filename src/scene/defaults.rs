//! What a bare model file gets, so that opening it shows a lit picture.

use glam::Vec3;

use super::{Camera, Light, LightKind, Scene};

/// Radiance of the sky over a model file.
pub(super) const SKY: Vec3 = Vec3::new(0.6, 0.8, 1.0);

/// The slightly warm sun over a model file, coming in steeply.
pub(super) fn sun() -> Light {
    Light {
        name: "sun".into(),
        kind: LightKind::Directional,
        color: Vec3::new(10.0, 9.6, 8.8),
        position: Vec3::ZERO,
        direction: Vec3::new(-0.38, -0.88, 0.2).normalize(),
        shadow: true,
    }
}

/// A level view along the longest horizontal axis, from inside its positive end.
pub(super) fn camera(scene: &Scene) -> Camera {
    let (low, high) = scene.bounds();
    let (centre, extent) = ((low + high) * 0.5, high - low);
    let axis = if extent.x >= extent.z { Vec3::X } else { Vec3::Z };
    let mut eye = centre + axis * (0.32 * extent.dot(axis));
    eye.y = low.y + 0.2 * extent.y;
    let (near, far) = clip_planes(extent.length());
    Camera { eye, target: eye - axis * extent.dot(axis).max(1.0), up: Vec3::Y, fov_y: 58.3, near, far }
}

/// Near and far distances that suit a scene with the given diagonal.
pub(super) fn clip_planes(diagonal: f32) -> (f32, f32) {
    let near = (0.001 * diagonal).max(0.01);
    (near, (2.0 * diagonal).max(near * 100.0))
}
