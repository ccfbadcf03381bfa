//! Motion: frames, each in the frame of its parent, and meshes with vertices that follow frames.

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

/// A frame that moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Mover {
    /// A lower number in [`Scene::movers`]: the frame that this one moves in; the world where absent.
    pub parent: Option<u32>,
    /// Where it is in that, before it moves.
    pub placed: Mat4,
    /// How it moves.
    pub track: Arc<Track>,
}

/// Motion in a frame: scale, then rotation, then translation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Track {
    /// m.
    pub translation: Option<Curve<Vec3>>,
    /// Unit quaternions.
    pub rotation: Option<Curve<Quat>>,
    /// Along the axes before the rotation.
    pub scale: Option<Curve<Vec3>>,
    /// In place of curves that are absent.
    pub rest: Rest,
    /// Seconds after which it starts over; where absent, it stays at its last key.
    pub period: Option<f32>,
}

/// The pose of a frame that does not move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rest {
    /// m.
    pub translation: Vec3,
    /// Unit length.
    pub rotation: Quat,
    /// Along the axes before the rotation.
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
    /// Seconds.
    pub time: f32,
    /// m.
    pub translation: Vec3,
    /// Around the origin, before the translation.
    pub rotation: Quat,
}

impl Track {
    /// The motion of a rigid body; `repeat`: it starts over after the last keyframe. Keyframes that are no curve do not move.
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

    /// Times of keys, each once, in order.
    pub fn times(&self) -> Vec<f32> {
        let translation = self.translation.iter().flat_map(Curve::times);
        let rotation = self.rotation.iter().flat_map(Curve::times);
        let scale = self.scale.iter().flat_map(Curve::times);
        sorted(translation.chain(rotation).chain(scale).copied().collect())
    }

    /// Its frame at a time in seconds.
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

/// A time within a period.
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

    /// Instances that move or change their shape.
    pub fn animated(&self) -> impl Iterator<Item = &Instance> {
        let deforming: HashSet<u32> = self.deformers.iter().map(|d| d.mesh).collect();
        self.instances
            .iter()
            .filter(move |i| i.mover.is_some() || deforming.contains(&i.mesh))
    }

    /// All movers' frames in the world at a time in seconds.
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

    /// Model to world at a time in seconds; nothing moves an instance that is not there.
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

/// A transform in the frame of a mover as a transform in the world; without a mover it is in the world already.
pub(crate) fn in_world(frames: &[Mat4], mover: Option<u32>, local: Mat4) -> Mat4 {
    mover
        .and_then(|m| frames.get(m as usize))
        .map_or(local, |frame| *frame * local)
}
