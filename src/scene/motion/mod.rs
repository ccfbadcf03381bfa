//! Motion: a hierarchy of moving frames, and meshes that they deform.

mod bounds;
mod curve;
mod deform;
mod rig;

use std::collections::HashSet;
use std::sync::Arc;

use glam::{Mat4, Quat, Vec3};

pub use curve::Value;
pub(crate) use curve::{Curve, Interpolation};
pub use deform::Deformer;
pub(crate) use deform::{Influence, Joint, Morph};
pub(in crate::scene) use rig::{Posing, Rig, Rigs, attach};

use super::{Instance, Scene};

/// A moving frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Mover {
    /// Index of its parent in [`Scene::movers`], lower than its own; `None` for the world.
    pub parent: Option<u32>,
    /// Static transform in the parent's frame, before the motion.
    pub placed: Mat4,
    /// Motion in that frame.
    pub track: Arc<Track>,
}

/// Animated scale, then rotation, then translation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Track {
    /// Translation (m).
    pub translation: Option<Curve<Vec3>>,
    /// Rotation as unit quaternions.
    pub rotation: Option<Curve<Quat>>,
    /// Scale, before the rotation.
    pub scale: Option<Curve<Vec3>>,
    /// Values of absent curves.
    pub rest: Rest,
    /// Period (s); `None` holds the last key.
    pub period: Option<f32>,
}

/// A static pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rest {
    /// Translation (m).
    pub translation: Vec3,
    /// Rotation, unit length.
    pub rotation: Quat,
    /// Scale, before the rotation.
    pub scale: Vec3,
}

impl Default for Rest {
    fn default() -> Self {
        Rest {
            translation: Vec3::ZERO,
            rotation: Quat::IDENTITY,
            scale: Vec3::ONE,
        }
    }
}

/// A rigid pose at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Keyframe {
    /// Time (s).
    pub time: f32,
    /// Translation (m).
    pub translation: Vec3,
    /// Rotation about the origin, before the translation.
    pub rotation: Quat,
}

impl Track {
    /// Rigid motion; `repeat` loops after the last keyframe. Invalid keyframes give no motion.
    pub fn rigid(keys: &[Keyframe], repeat: bool) -> Track {
        let times: Vec<f32> = keys.iter().map(|k| k.time).collect();
        let last = times.last().copied().filter(|last| repeat && *last > 0.0);
        let line = Interpolation::Linear;
        Track {
            translation: Curve::new(
                times.clone(),
                keys.iter().map(|k| k.translation).collect(),
                line,
            ),
            rotation: Curve::new(times, keys.iter().map(|k| k.rotation).collect(), line),
            period: last,
            ..Track::default()
        }
    }

    /// Times of all keys, sorted, without duplicates.
    pub fn times(&self) -> Vec<f32> {
        let translation = self.translation.iter().flat_map(Curve::times);
        let rotation = self.rotation.iter().flat_map(Curve::times);
        let scale = self.scale.iter().flat_map(Curve::times);
        sorted(translation.chain(rotation).chain(scale).copied().collect())
    }

    /// Its transform at a time in seconds.
    pub fn at(&self, time: f32) -> Mat4 {
        let time = wrapped(time, self.period);
        let scale = self.scale.as_ref().map_or(self.rest.scale, |c| c.at(time));
        let rotation = self
            .rotation
            .as_ref()
            .map_or(self.rest.rotation, |c| c.at(time));
        let translation = self
            .translation
            .as_ref()
            .map_or(self.rest.translation, |c| c.at(time));
        Mat4::from_scale_rotation_translation(scale, rotation, translation)
    }
}

/// A time reduced to the period.
fn wrapped(time: f32, period: Option<f32>) -> f32 {
    period
        .filter(|p| *p > 0.0 && time.is_finite())
        .map_or(time, |period| time.rem_euclid(period))
}

fn sorted(mut times: Vec<f32>) -> Vec<f32> {
    times.sort_by(f32::total_cmp);
    times.dedup();
    times
}

impl Scene {
    pub(crate) fn moves(&self) -> bool {
        !self.deformers.is_empty() || self.instances.iter().any(|i| i.mover.is_some())
    }

    /// Instances that move or deform.
    pub fn animated(&self) -> impl Iterator<Item = &Instance> {
        let is_animated = self.is_animated();
        self.instances.iter().filter(move |i| is_animated(i))
    }

    /// Tells whether an instance moves or deforms.
    pub(crate) fn is_animated(&self) -> impl Fn(&Instance) -> bool + use<> {
        let deforming: HashSet<u32> = self.deformers.iter().map(|d| d.mesh).collect();
        move |i| i.mover.is_some() || deforming.contains(&i.mesh)
    }

    /// Triangles of instances that move or deform.
    pub fn moving_triangle_count(&self) -> usize {
        let meshes = self
            .animated()
            .filter_map(|i| self.meshes.get(i.mesh as usize));
        let submeshes = meshes.flat_map(|m| &m.submeshes);
        submeshes.map(|s| s.index_count as usize / 3).sum()
    }

    /// Adds a mover and returns its index.
    pub(in crate::scene) fn add_mover(
        &mut self,
        parent: Option<u32>,
        placed: Mat4,
        track: Arc<Track>,
    ) -> u32 {
        self.movers.push(Mover {
            parent,
            placed,
            track,
        });
        self.movers.len() as u32 - 1
    }

    /// World transforms of all movers at a time in seconds.
    pub fn mover_frames(&self, time: f32) -> Vec<Mat4> {
        let mut frames: Vec<Mat4> = Vec::with_capacity(self.movers.len());
        for mover in &self.movers {
            let parent = mover
                .parent
                .and_then(|p| frames.get(p as usize))
                .copied()
                .unwrap_or(Mat4::IDENTITY);
            frames.push(parent * mover.placed * mover.track.at(time));
        }
        frames
    }

    /// Model to world at a time in seconds; the identity for an unknown instance.
    pub fn instance_transform(&self, instance: usize, time: f32) -> Mat4 {
        let Some(instance) = self.instances.get(instance) else {
            return Mat4::IDENTITY;
        };
        self.moved(instance.mover, instance.transform, time)
    }

    /// The transform from a mover's frame to the world at a time in seconds, times `local`.
    pub(in crate::scene) fn moved(&self, mover: Option<u32>, local: Mat4, time: f32) -> Mat4 {
        let (mut world, mut next) = (local, mover);
        while let Some((number, mover)) = next.and_then(|n| Some((n, self.movers.get(n as usize)?)))
        {
            world = mover.placed * mover.track.at(time) * world;
            next = mover.parent.filter(|p| *p < number);
        }
        world
    }
}

/// World transform of `local` in a mover's frame; `local` itself without a mover.
pub(crate) fn in_world(frames: &[Mat4], mover: Option<u32>, local: Mat4) -> Mat4 {
    mover
        .and_then(|m| frames.get(m as usize))
        .map_or(local, |frame| *frame * local)
}
