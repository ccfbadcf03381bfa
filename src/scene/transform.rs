//! Where instances are at a time, and how much space the scene takes.

use glam::{Mat3, Mat4, Quat, Vec3};

use super::{Animation, Keyframe, Mesh, Scene};

/// Poses looked at between two keyframes when bounds are taken.
const POSES_PER_INTERVAL: usize = 16;
/// Above this many vertices times poses, bounds use the corners of the mesh's box instead (larger, never smaller).
const EXACT_BOUNDS_WORK: usize = 20_000_000;

impl Scene {
    /// The box around everything in the world, over all animated poses; (0, 0) for a scene without triangles.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        let mut low = Vec3::INFINITY;
        let mut high = Vec3::NEG_INFINITY;
        for instance in &self.instances {
            let Some(mesh) = self.meshes.get(instance.mesh as usize) else {
                continue;
            };
            let poses = match &instance.animation {
                None => vec![Mat4::IDENTITY],
                Some(animation) => animation.poses(),
            };
            let points = representative_points(mesh, poses.len());
            for pose in poses {
                let world = pose * instance.transform;
                for &point in &points {
                    let position = world.transform_point3(point);
                    low = low.min(position);
                    high = high.max(position);
                }
            }
        }
        if low.x <= high.x { (low, high) } else { (Vec3::ZERO, Vec3::ZERO) }
    }

    /// Where the world of shaders begins, seen from the scene's: at its own origin, unless the scene lies so far from it that
    /// 32-bit coordinates would be coarse for its size. Then near its middle, in steps that round nothing of what is there.
    pub fn origin(&self) -> Vec3 {
        origin_of(self.bounds())
    }

    /// Model to world at a time in seconds. Panics when there is no such instance.
    pub fn instance_transform(&self, instance: usize, time: f32) -> Mat4 {
        let instance = &self.instances[instance];
        match &instance.animation {
            Some(animation) => animation.at(time) * instance.transform,
            None => instance.transform,
        }
    }

    /// Triangles over all instances (a mesh placed twice counts twice).
    pub fn triangle_count(&self) -> usize {
        let of_mesh = |i: u32| self.meshes.get(i as usize).map_or(0, Mesh::triangle_count);
        self.instances.iter().map(|instance| of_mesh(instance.mesh)).sum()
    }

    /// How many of them emit light.
    pub fn emitting_triangle_count(&self) -> usize {
        let emits = |m: u32| self.materials.get(m as usize).is_some_and(|m| m.emission != Vec3::ZERO);
        let submeshes = |i: u32| self.meshes.get(i as usize).into_iter().flat_map(|mesh| &mesh.submeshes);
        let of_mesh =
            |i: u32| submeshes(i).filter(|s| emits(s.material)).map(|s| s.index_count as usize / 3).sum::<usize>();
        self.instances.iter().map(|instance| of_mesh(instance.mesh)).sum()
    }
}

/// [`Scene::origin`] of a scene with these bounds.
pub(crate) fn origin_of((low, high): (Vec3, Vec3)) -> Vec3 {
    let (centre, diagonal) = ((low + high) * 0.5, (high - low).length());
    if !(diagonal > 0.0 && centre.length() > 8.0 * diagonal) {
        return Vec3::ZERO;
    }
    let step = diagonal.log2().floor().exp2();
    (centre / step).round() * step
}

impl Mesh {
    /// Triangles of the mesh itself.
    pub fn triangle_count(&self) -> usize {
        self.submeshes.iter().map(|submesh| submesh.index_count as usize / 3).sum()
    }
}

impl Animation {
    /// The rigid motion at a time in seconds.
    pub fn at(&self, time: f32) -> Mat4 {
        let Some(last) = self.keyframes.last() else {
            return Mat4::IDENTITY;
        };
        let wraps = self.repeat && last.time > 0.0 && time.is_finite();
        let time = if wraps { time.rem_euclid(last.time) } else { time };
        let next = self.keyframes.partition_point(|key| key.time <= time);
        let a = &self.keyframes[next.saturating_sub(1)];
        let b = &self.keyframes[next.min(self.keyframes.len() - 1)];
        let span = b.time - a.time;
        let s = if span > 0.0 { ((time - a.time) / span).clamp(0.0, 1.0) } else { 0.0 };
        let rotation: Quat = a.rotation.slerp(b.rotation, s);
        Mat4::from_rotation_translation(rotation, a.translation.lerp(b.translation, s))
    }

    /// The same motion inside a placed frame, and the frame's scale, which goes to the right of the motion.
    /// None where the frame is scaled unevenly or mirrored: such a scale does not commute with a rotation.
    pub(super) fn seen_from(&self, frame: Mat4) -> Option<(Animation, f32)> {
        let axes = Mat3::from_mat4(frame);
        let size = axes.determinant().cbrt();
        let turn = axes * (1.0 / size);
        let even = size > 0.0 && (turn.transpose() * turn).abs_diff_eq(Mat3::IDENTITY, 1e-3);
        if !even {
            return None;
        }
        let turn = Quat::from_mat3(&turn).normalize();
        let origin = frame.w_axis.truncate();
        let keyframes = self.keyframes.iter().map(|key| Keyframe {
            time: key.time,
            translation: origin + turn * (key.translation * size),
            rotation: turn * key.rotation,
        });
        Some((Animation { keyframes: keyframes.collect(), repeat: self.repeat }, size))
    }

    fn poses(&self) -> Vec<Mat4> {
        let mut poses: Vec<Mat4> = Vec::new();
        for pair in self.keyframes.windows(2) {
            for i in 0..POSES_PER_INTERVAL {
                let s = i as f32 / POSES_PER_INTERVAL as f32;
                let rotation = pair[0].rotation.slerp(pair[1].rotation, s);
                let translation = pair[0].translation.lerp(pair[1].translation, s);
                poses.push(Mat4::from_rotation_translation(rotation, translation));
            }
        }
        let last = self.keyframes.last();
        poses.push(last.map_or(Mat4::IDENTITY, |key| Mat4::from_rotation_translation(key.rotation, key.translation)));
        poses
    }
}

fn representative_points(mesh: &Mesh, poses: usize) -> Vec<Vec3> {
    let positions = mesh.vertices.iter().map(|v| Vec3::from_array(v.position));
    if mesh.vertices.len().saturating_mul(poses) <= EXACT_BOUNDS_WORK {
        return positions.collect();
    }
    let (low, high) = positions.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
    let pick = |i: u32, axis: u32| if i & axis != 0 { high } else { low };
    (0..8).map(|i| Vec3::new(pick(i, 1).x, pick(i, 2).y, pick(i, 4).z)).collect()
}
