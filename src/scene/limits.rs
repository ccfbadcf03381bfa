//! Limits on the extent of a scene.

use glam::{Mat4, Vec3};

use super::Scene;

/// Largest absolute coordinate (m): products of four coordinates still fit 32-bit floats.
pub const MAX_COORDINATE: f32 = 1e9;

/// Smallest scene diagonal (m): offsets against rounding reach this size, and smaller scenes lose
/// light.
const MIN_DIAGONAL: f32 = 1e-4;

/// Adds a warning to a scene that is too small.
pub(super) fn with_size_told(mut scene: Scene) -> Scene {
    let (low, high) = scene.bounds();
    let diagonal = (high - low).length();
    if diagonal < MIN_DIAGONAL && scene.triangle_count() > 0 {
        scene.warnings.push(format!(
            "{}: it is {diagonal:.1e} m across, and below {MIN_DIAGONAL:e} m light is lost. Check its units, or scale it up",
            scene.name
        ));
    }
    scene
}

/// Checks that a scene, transformed by `frame`, stays within [`MAX_COORDINATE`].
pub(super) fn check_extent(scene: &Scene, frame: Mat4) -> Result<(), String> {
    check_placed(scene, scene.bounds(), frame)
}

/// [`check_extent`] with known bounds.
pub(super) fn check_placed(
    scene: &Scene,
    (low, high): (Vec3, Vec3),
    frame: Mat4,
) -> Result<(), String> {
    let fits = |point: Vec3| frame.transform_point3(point).abs().max_element() <= MAX_COORDINATE;
    let far = |what: &str| {
        Err(format!(
            "{what} more than {MAX_COORDINATE:e} m from the origin: it cannot be rendered. Check its units and scale"
        ))
    };
    if let Some(instance) = scene
        .instances
        .iter()
        .find(|instance| !instance.transform.is_finite())
    {
        return Err(format!(
            "'{}' has a placement that is not finite",
            instance.name
        ));
    }
    let corner = |i: usize| {
        Vec3::new(
            [low, high][i & 1].x,
            [low, high][i >> 1 & 1].y,
            [low, high][i >> 2].z,
        )
    };
    if !(0..8).map(corner).all(fits) {
        return far(&format!(
            "its triangles reach {:.1e} m,",
            low.abs().max(high.abs()).max_element()
        ));
    }
    if let Some(light) = scene.lights.iter().find(|light| !fits(light.position)) {
        return far(&format!("its light '{}' is", light.name));
    }
    match scene
        .cameras
        .iter()
        .find(|(_, camera)| !fits(camera.eye) || !fits(camera.target))
    {
        Some((name, _)) => far(&format!("its camera '{name}' is")),
        None => Ok(()),
    }
}
