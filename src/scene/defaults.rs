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
    let length = extent.dot(axis);
    let target = eye - axis * if length > 0.0 { length } else { 1.0 };
    Camera { eye, target, up: Vec3::Y, fov_y: 58.3, near: near_plane(extent.length()), far: f32::INFINITY }
}

/// Distance of the near plane in a scene with the given diagonal: so small that it hides nothing. Under reversed depth
/// it costs no precision.
pub(crate) fn near_plane(diagonal: f32) -> f32 {
    (1e-5 * diagonal).clamp(1e-9, 1e-3)
}
