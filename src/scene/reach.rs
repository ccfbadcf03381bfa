//! The distances that a camera sees; they decide where a voxel volume needs small voxels.

use super::{Camera, Scene};
use glam::{Vec3, Vec3A};
use obvhs::{ray::Ray, triangle::Triangle};

/// Rays across a picture of 16:9, by row and column.
const RAYS: (usize, usize) = (6, 10);
/// Triangles that are tested; larger scenes are subsampled evenly. Costs at most 0.1 s.
const TRIANGLES: usize = 1 << 20;

/// Visibility from a camera, by a few rays across its picture.
pub(super) struct Seen {
    /// Fraction of rays that hit a surface.
    pub hits: f32,
    /// Fraction of rays that hit a back face.
    pub backs: f32,
    /// Median distance of the hits (m); `None` without hits.
    pub median: Option<f32>,
    /// Distance of the nearest third of the hits (m); `None` without hits.
    pub near: Option<f32>,
}

impl Scene {
    /// Sets [`Scene::seen_distance`] from the camera `default`, or from the first one.
    pub(super) fn with_seen_distance(mut self) -> Scene {
        let camera = self
            .cameras
            .get("default")
            .or_else(|| self.cameras.values().next());
        self.seen_distance = camera.and_then(|c| self.seen_by(c).median).unwrap_or(0.0);
        self
    }

    /// Whether rays from a point hit a surface in every direction.
    pub(super) fn encloses(&self, eye: Vec3) -> bool {
        let axes = [Vec3::X, Vec3::Y, Vec3::Z].into_iter();
        axes.flat_map(|axis| [axis, -axis]).all(|axis| {
            let camera = Camera {
                eye,
                target: eye + axis * super::defaults::least_reach(eye).max(1.0),
                up: axis.any_orthonormal_vector(),
                fov_y: 90.0,
                near: 1e-3,
                far: f32::INFINITY,
            };
            self.seen_by(&camera).hits == 1.0
        })
    }

    /// Traces a few rays from a camera in the scene's first pose.
    pub(super) fn seen_by(&self, camera: &Camera) -> Seen {
        let rays = rays(camera);
        let mut nearest = vec![(f32::INFINITY, false); rays.len()];
        let stride = self.triangle_count().div_ceil(TRIANGLES).max(1);
        let mut number = 0;
        for (i, instance) in self.instances.iter().enumerate() {
            let Some(mesh) = self.meshes.get(instance.mesh as usize) else {
                continue;
            };
            let world = self.instance_transform(i, 0.0);
            let turned = world.determinant().signum();
            for corners in mesh.indices.chunks_exact(3) {
                number += 1;
                if number % stride != 0 {
                    continue;
                }
                let Some([v0, v1, v2]) = corners_of(mesh, corners)
                    .map(|t| t.map(|p| Vec3A::from(world.transform_point3(p) - camera.eye)))
                else {
                    continue;
                };
                let triangle = Triangle { v0, v1, v2 };
                for (ray, nearest) in rays.iter().zip(&mut nearest) {
                    let distance = triangle.intersect(ray);
                    if distance < nearest.0 {
                        let normal = (v1 - v0).cross(v2 - v0) * turned;
                        *nearest = (distance, normal.dot(ray.direction) > 0.0);
                    }
                }
            }
        }
        nearest.retain(|hit| hit.0.is_finite());
        nearest.sort_by(|a, b| a.0.total_cmp(&b.0));
        let share = |count: usize| count as f32 / rays.len() as f32;
        Seen {
            hits: share(nearest.len()),
            backs: share(nearest.iter().filter(|hit| hit.1).count()),
            median: nearest.get(nearest.len() / 2).map(|hit| hit.0),
            near: nearest.get(nearest.len() / 3).map(|hit| hit.0),
        }
    }
}

fn corners_of(mesh: &super::Mesh, indices: &[u32]) -> Option<[Vec3; 3]> {
    let corner = |k: usize| {
        mesh.vertices
            .get(indices[k] as usize)
            .map(|v| Vec3::from(v.position))
    };
    Some([corner(0)?, corner(1)?, corner(2)?])
}

/// Rays from the camera, which is the origin.
fn rays(camera: &Camera) -> Vec<Ray> {
    let ahead = (camera.target - camera.eye)
        .try_normalize()
        .unwrap_or(Vec3::NEG_Z);
    let right = ahead
        .cross(camera.up)
        .try_normalize()
        .unwrap_or_else(|| ahead.any_orthonormal_vector());
    let half = (0.5 * camera.fov_y.clamp(1.0, 170.0).to_radians()).tan();
    let (up, right) = (right.cross(ahead) * half, right * half * 16.0 / 9.0);
    let middle = |i: usize, n: usize| (2 * i + 1) as f32 / n as f32 - 1.0;
    (0..RAYS.0 * RAYS.1)
        .map(|i| {
            (ahead + up * middle(i / RAYS.1, RAYS.0) + right * middle(i % RAYS.1, RAYS.1))
                .normalize()
        })
        .map(|d| Ray::new_inf(Vec3A::ZERO, Vec3A::from(d)))
        .collect()
}
