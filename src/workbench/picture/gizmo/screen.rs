//! Points of the world on the screen, and the way back.

use crate::scene::Camera;
use egui::{Pos2, Rect, Vec2};
use glam::Vec3;

/// A camera and the place of its picture on the screen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Screen {
    pub eye: Vec3,
    pub forward: Vec3,
    pub right: Vec3,
    pub up: Vec3,
    /// Tangents of half the horizontal and vertical fields of view.
    tangents: Vec2,
    rect: Rect,
}

impl Screen {
    pub fn new(camera: &Camera, rect: Rect) -> Screen {
        let forward = (camera.target - camera.eye).normalize_or(Vec3::NEG_Z);
        let side = forward.cross(camera.up);
        let right = match side.length() < 1e-4 {
            true => forward.cross(forward.any_orthonormal_vector()),
            false => side.normalize(),
        };
        let tangent = (0.5 * camera.fov_y.clamp(1.0, 170.0).to_radians()).tan();
        let aspect = rect.width() / rect.height().max(1.0);
        Screen {
            eye: camera.eye,
            forward,
            right,
            up: right.cross(forward),
            tangents: Vec2::new(tangent * aspect, tangent),
            rect,
        }
    }

    /// Where a point is on the screen; `None` behind the camera.
    pub fn project(&self, point: Vec3) -> Option<Pos2> {
        let offset = point - self.eye;
        let depth = offset.dot(self.forward);
        let at = Vec2::new(offset.dot(self.right), -offset.dot(self.up)) / (depth * self.tangents);
        (depth > 1e-4 * offset.length()).then(|| self.rect.center() + 0.5 * at * self.rect.size())
    }

    /// Direction of the ray through a point of the screen, unit length.
    pub fn ray(&self, at: Pos2) -> Vec3 {
        let at = 2.0 * (at - self.rect.center()) / self.rect.size() * self.tangents;
        (self.forward + self.right * at.x - self.up * at.y).normalize()
    }

    /// Metres a point of the screen, at the depth of a point of the world.
    pub fn metres(&self, point: Vec3) -> f32 {
        let depth = (point - self.eye).dot(self.forward).max(1e-6);
        2.0 * depth * self.tangents.y / self.rect.height().max(1.0)
    }

    /// Distance from `origin` along `axis` (unit length) to the point that is nearest to the ray
    /// through `at`. `None` if the axis points at the eye.
    pub fn along(&self, at: Pos2, origin: Vec3, axis: Vec3) -> Option<f32> {
        let (ray, offset) = (self.ray(at), origin - self.eye);
        let across = axis.dot(ray);
        let sine = 1.0 - across * across;
        (sine > 1e-4).then(|| (across * ray.dot(offset) - axis.dot(offset)) / sine)
    }

    /// The point under `at` in the plane through `point` that is parallel to the screen.
    pub fn in_plane(&self, at: Pos2, point: Vec3) -> Vec3 {
        let ray = self.ray(at);
        self.eye + ray * ((point - self.eye).dot(self.forward) / ray.dot(self.forward))
    }

    /// The direction from the centre of a sphere to its point under `at`, in front of the centre or
    /// behind it; to the rim outside of the sphere.
    pub fn on_sphere(&self, at: Pos2, centre: Vec3, radius: f32, behind: bool) -> Vec3 {
        let ray = self.ray(at);
        let middle = (centre - self.eye).dot(ray);
        let nearest = self.eye + ray * middle - centre;
        let half = (radius * radius - nearest.length_squared()).max(0.0).sqrt();
        let sign = if behind { 1.0 } else { -1.0 };
        (nearest + ray * (sign * half)).normalize_or(self.forward)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn screen() -> Screen {
        let camera = Camera {
            eye: Vec3::new(1.0, 2.0, 5.0),
            target: Vec3::new(0.5, 1.0, 0.0),
            up: Vec3::Y,
            fov_y: 50.0,
            near: 0.1,
            far: 100.0,
        };
        Screen::new(
            &camera,
            Rect::from_min_max([10.0, 20.0].into(), [330.0, 260.0].into()),
        )
    }

    #[test]
    fn rays_go_through_the_points_that_are_projected() {
        let screen = screen();
        for point in [
            Vec3::ZERO,
            Vec3::new(-1.0, 2.0, 1.0),
            Vec3::new(2.0, 0.3, -4.0),
        ] {
            let at = screen.project(point).unwrap();
            let expected = (point - screen.eye).normalize();
            assert!(screen.ray(at).distance(expected) < 1e-5);
            assert!(screen.in_plane(at, point).distance(point) < 1e-4);
        }
        let behind = screen.eye - 2.0 * screen.forward;
        assert_eq!(screen.project(behind), None);
    }

    #[test]
    fn a_point_on_an_axis_is_found_again() {
        let screen = screen();
        let origin = Vec3::new(0.2, 1.0, -1.0);
        for axis in [Vec3::X, Vec3::Y, Vec3::new(0.6, 0.0, 0.8)] {
            let at = screen.project(origin + 0.7 * axis).unwrap();
            assert!((screen.along(at, origin, axis).unwrap() - 0.7).abs() < 1e-4);
        }
        assert_eq!(
            screen.along(Pos2::ZERO, origin, screen.ray(Pos2::ZERO)),
            None
        );
    }

    #[test]
    fn a_direction_is_found_again_on_both_sides_of_its_sphere() {
        let screen = screen();
        let centre = Vec3::new(0.2, 1.0, -1.0);
        for direction in [Vec3::Y, Vec3::Z, Vec3::NEG_Z] {
            let at = screen.project(centre + 0.3 * direction).unwrap();
            let near = screen.on_sphere(at, centre, 0.3, false);
            let far = screen.on_sphere(at, centre, 0.3, true);
            let error = near.distance(direction).min(far.distance(direction));
            assert!(error < 1e-3, "{direction}: {near} {far}");
        }
    }
}
