//! Bounds of moving meshes.

use std::collections::{BTreeSet, HashMap};

use glam::{Mat4, Vec3};

use super::{Deformer, Mover, Track, sorted};
use crate::scene::{Instance, Mesh, Scene};

/// Poses sampled between two keys.
const POSES_PER_INTERVAL: usize = 16;
/// Poses sampled per instance.
const MAX_POSES: usize = 4096;
/// Poses sampled for all instances together.
const ALL_POSES: usize = 1 << 20;
/// Above this number of points times poses, the corners of the bounding box are transformed instead
/// (conservative).
const EXACT_WORK: usize = 20_000_000;
/// Relative margin around a deforming mesh, which may be larger between the sampled poses.
const MARGIN: f32 = 0.01;

/// Lower and upper corner.
type Box3 = (Vec3, Vec3);

const NOTHING: Box3 = (Vec3::INFINITY, Vec3::NEG_INFINITY);

impl Scene {
    /// World bounds over all poses; (0, 0) for a scene without triangles.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        let deformers: HashMap<u32, &Deformer> =
            self.deformers.iter().map(|d| (d.mesh, d)).collect();
        let moving = self.instances.iter().filter(|i| i.mover.is_some()).count();
        let most = (ALL_POSES / moving.max(1)).clamp(64, MAX_POSES);
        let each = self
            .instances
            .iter()
            .map(|i| self.bounds_of(i, deformers.get(&i.mesh).copied(), most));
        let (low, high) = each.fold(NOTHING, around);
        if low.x <= high.x {
            (low, high)
        } else {
            (Vec3::ZERO, Vec3::ZERO)
        }
    }

    fn bounds_of(&self, instance: &Instance, deformer: Option<&Deformer>, most: usize) -> Box3 {
        let Some(mesh) = self.meshes.get(instance.mesh as usize) else {
            return NOTHING;
        };
        let mut points = Points::of(mesh, deformer);
        let mut local = instance.transform;
        // Movers with the same period are sampled together. Movers above with another period
        // transform the resulting box.
        for moves in self.chain(instance.mover) {
            let tracks: Vec<&Track> = moves.iter().map(|m| &*m.track).collect();
            let times = sample_times(&tracks, most);
            let pose = |t: f32| {
                moves
                    .iter()
                    .fold(local, |below, m| m.placed * m.track.at(t) * below)
            };
            points = Points::Box(points.moved(times.into_iter().map(pose)));
            local = Mat4::IDENTITY;
        }
        points.moved([local].into_iter())
    }

    /// The movers of the joints and their ancestors, each once.
    fn above(&self, deformer: &Deformer) -> BTreeSet<u32> {
        let mut found = BTreeSet::new();
        for joint in &deformer.joints {
            let mut next = joint.mover;
            while let Some(number) = next.filter(|n| found.insert(*n)) {
                let parent = self.movers.get(number as usize).and_then(|m| m.parent);
                next = parent.filter(|p| *p < number);
            }
        }
        found
    }

    /// The ancestors of a mover in runs of equal periods, innermost first.
    fn chain(&self, innermost: Option<u32>) -> Vec<Vec<&Mover>> {
        let mut runs: Vec<Vec<&Mover>> = Vec::new();
        let mut next = innermost;
        while let Some((number, mover)) = next.and_then(|n| Some((n, self.movers.get(n as usize)?)))
        {
            match runs
                .last_mut()
                .filter(|run| run.iter().all(|m| m.track.period == mover.track.period))
            {
                Some(run) => run.push(mover),
                None => runs.push(vec![mover]),
            }
            next = mover.parent.filter(|p| *p < number);
        }
        runs
    }

    /// Model-space bounds of a mesh over all poses of its deformer.
    pub(in crate::scene) fn deformed_bounds(&self, deformer: &Deformer) -> (Vec3, Vec3) {
        let Some(mesh) = self.meshes.get(deformer.mesh as usize) else {
            return (Vec3::ZERO, Vec3::ZERO);
        };
        let tracks = self
            .above(deformer)
            .into_iter()
            .filter_map(|m| self.movers.get(m as usize))
            .map(|m| &*m.track);
        let weights = deformer
            .weights
            .iter()
            .flat_map(|curve| curve.times().iter().copied());
        let times = sorted(tracks.flat_map(Track::times).chain(weights).collect());
        let mut times = between(&times, MAX_POSES);
        // As many poses as the work limit allows, evenly spaced.
        let most =
            (EXACT_WORK / (mesh.vertices.len() + self.movers.len()).max(1)).clamp(16, MAX_POSES);
        let step = times.len().div_ceil(most).max(1);
        times = times.into_iter().step_by(step).chain([0.0]).collect();
        let pose = |time: f32| {
            let vertices = deformer.posed(mesh, &self.mover_frames(time), time);
            vertices
                .iter()
                .map(|v| Vec3::from_array(v.position))
                .fold(NOTHING, |b, p| around(b, (p, p)))
        };
        let (low, high) = times.into_iter().map(pose).fold(NOTHING, around);
        if low.x > high.x {
            return (Vec3::ZERO, Vec3::ZERO);
        }
        let margin = (high - low) * MARGIN;
        (low - margin, high + margin)
    }
}

/// Points to bound.
enum Points<'a> {
    Mesh(&'a Mesh),
    Box(Box3),
}

impl<'a> Points<'a> {
    fn of(mesh: &'a Mesh, deformer: Option<&Deformer>) -> Points<'a> {
        deformer.map_or(Points::Mesh(mesh), |d| Points::Box(d.bounds))
    }

    fn moved(&self, poses: impl ExactSizeIterator<Item = Mat4>) -> Box3 {
        let points = match self {
            Points::Mesh(mesh) => {
                let all = mesh.vertices.iter().map(|v| Vec3::from_array(v.position));
                match mesh.vertices.len().saturating_mul(poses.len()) <= EXACT_WORK {
                    true => all.collect(),
                    false => corners(all.fold(NOTHING, |b, p| around(b, (p, p)))),
                }
            }
            Points::Box(b) => corners(*b),
        };
        let of_pose = |pose: Mat4| {
            points
                .iter()
                .map(|p| pose.transform_point3(*p))
                .fold(NOTHING, |b, p| around(b, (p, p)))
        };
        poses.map(of_pose).fold(NOTHING, around)
    }
}

fn around(a: Box3, b: Box3) -> Box3 {
    (a.0.min(b.0), a.1.max(b.1))
}

fn corners((low, high): Box3) -> Vec<Vec3> {
    if low.x > high.x {
        return Vec::new();
    }
    let pick = |i: u32, axis: u32| if i & axis != 0 { high } else { low };
    (0..8)
        .map(|i| Vec3::new(pick(i, 1).x, pick(i, 2).y, pick(i, 4).z))
        .collect()
}

fn sample_times(tracks: &[&Track], most: usize) -> Vec<f32> {
    between(
        &sorted(tracks.iter().flat_map(|t| t.times()).collect()),
        most,
    )
}

/// Key times and times between them; many keys are subsampled.
fn between(keys: &[f32], most: usize) -> Vec<f32> {
    let Some(last) = keys.last() else {
        return vec![0.0];
    };
    let intervals = keys.len() - 1;
    let each = (most / intervals.max(1)).clamp(1, POSES_PER_INTERVAL);
    let step = intervals.div_ceil(most).max(1);
    let pairs = keys.windows(2).step_by(step);
    let inner =
        pairs.flat_map(|k| (0..each).map(move |i| k[0] + (k[1] - k[0]) * i as f32 / each as f32));
    // At the end of a period the track wraps to its start, so the last key is sampled just before
    // it.
    inner
        .chain([last.next_down().max(keys[0]), *last])
        .collect()
}
