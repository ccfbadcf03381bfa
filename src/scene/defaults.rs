//! Defaults for model files without lights, sky or cameras, so that opening one shows a lit
//! picture.

use glam::Vec3;

use super::{Camera, Light, Scene};

/// Radiance of the sky over a model file without lights.
pub(super) const SKY: Vec3 = Vec3::new(0.6, 0.8, 1.0);

/// Radiance of the sky over a model: none if it has lights of its own.
pub(super) fn sky_over(model: &Scene) -> Vec3 {
    if model.lights.is_empty() {
        SKY
    } else {
        Vec3::ZERO
    }
}

/// Vertical field of view of default cameras (degrees).
const FOV_Y: f32 = 58.3;

/// The slightly warm sun over a model file, coming in steeply.
pub(super) fn sun() -> Light {
    Light {
        name: "sun".into(),
        color: Vec3::new(10.0, 9.6, 8.8),
        direction: Vec3::new(-0.38, -0.88, 0.2).normalize(),
        ..Light::default()
    }
}

/// At most a third of the picture may be nearer than this fraction of the way to the target: one
/// object must not hide the scene.
const NEAR: f32 = 0.1;

/// A level view along the longest horizontal axis, from inside its positive end. If that position
/// is inside an object or sees nothing, other positions follow. A position costs at most 0.1 s, and
/// the first one is nearly always free.
pub(super) fn camera(scene: &Scene) -> Camera {
    if let Some(front) = front(scene) {
        return front;
    }
    let mut best = (f32::NEG_INFINITY, place(scene, 0, PLACES[0]));
    for place in PLACES
        .iter()
        .flat_map(|p| [place(scene, 0, *p), place(scene, 1, *p)])
    {
        let seen = scene.seen_by(&place);
        let reach = (place.target - place.eye).length();
        let [far, near] = [seen.median, seen.near].map(|d| d.unwrap_or(0.0) / reach);
        if seen.hits >= 0.25 && seen.backs <= 0.6 * seen.hits && far >= 0.15 && near >= NEAR {
            return place;
        }
        if far.min(2.0 * near) > best.0 {
            best = (far.min(2.0 * near), place);
        }
    }
    best.1
}

/// A model thinner than this fraction of its diagonal is flat.
const FLAT: f32 = 1e-3;

/// A view of a whole flat model from the side with fewer back faces; `None` for other models.
fn front(scene: &Scene) -> Option<Camera> {
    let (low, high) = scene.bounds();
    let (centre, extent) = ((low + high) * 0.5, high - low);
    let diagonal = extent.length();
    let axis = [Vec3::Z, Vec3::X, Vec3::Y]
        .into_iter()
        .find(|axis| extent.dot(*axis) < FLAT * diagonal)?;
    let up = if axis == Vec3::Y {
        Vec3::NEG_Z
    } else {
        Vec3::Y
    };
    let from = |side: f32| {
        // Pictures are at least as wide as high.
        let away = 0.55 * extent.max_element() / (0.5 * FOV_Y).to_radians().tan();
        let eye = centre + axis * (side * away);
        Camera {
            eye,
            target: centre,
            up,
            fov_y: FOV_Y,
            near: near_plane(diagonal),
            far: f32::INFINITY,
        }
    };
    let (ahead, behind) = (from(1.0), from(-1.0));
    Some(
        if scene.seen_by(&behind).backs < scene.seen_by(&ahead).backs {
            behind
        } else {
            ahead
        },
    )
}

/// Candidate camera positions as fractions of the scene's extent: along the axis from the middle,
/// and above the ground. The last one is outside, for single objects.
const PLACES: [(f32, f32); 8] = [
    (0.32, 0.2),
    (-0.32, 0.2),
    (0.32, 0.5),
    (-0.32, 0.5),
    (0.46, 0.5),
    (-0.46, 0.5),
    (0.1, 0.5),
    (1.2, 0.5),
];

/// A camera along the longer horizontal axis, or along the other one.
fn place(scene: &Scene, which: usize, (along, above): (f32, f32)) -> Camera {
    let (low, high) = scene.bounds();
    let (centre, extent) = ((low + high) * 0.5, high - low);
    let axis = if (extent.x >= extent.z) == (which == 0) {
        Vec3::X
    } else {
        Vec3::Z
    };
    let length = extent.dot(axis);
    let mut eye = centre + axis * (along * length);
    eye.y = low.y + above * extent.y;
    let reach = if length > 0.0 { length } else { 1.0 };
    let target = eye - axis * along.signum() * reach.max(least_reach(eye));
    Camera {
        eye,
        target,
        up: Vec3::Y,
        fov_y: FOV_Y,
        near: near_plane(extent.length()),
        far: f32::INFINITY,
    }
}

/// Smallest distance to a target that 32-bit floats resolve at this eye position.
pub(super) fn least_reach(eye: Vec3) -> f32 {
    4.0 * f32::EPSILON * eye.abs().max_element()
}

/// Distance of the near plane for a scene diagonal: small enough to clip nothing. With reversed
/// depth it costs no precision.
pub(crate) fn near_plane(diagonal: f32) -> f32 {
    (1e-5 * diagonal).clamp(1e-9, 1e-3)
}
