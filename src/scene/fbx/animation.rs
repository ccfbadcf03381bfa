//! Motion of nodes by the first animation: baked to keys, and combined over all nodes above an instance.

use std::collections::HashMap;

use glam::{DAffine3, DMat3, DQuat};
use ufbx::{BakeOpts, BakedAnimRoot, BakedNode, Node, bake_anim, evaluate_baked_quat, evaluate_baked_vec3};

use super::file::memory;
use super::numbers::{affine, frame, placed};
use crate::scene::obj::shown;
use crate::scene::warnings::Warnings;
use crate::scene::{Animation, Keyframe};

/// Keyframes of all instances: each below a moving node has its own.
const MAX_KEYFRAMES: usize = 1 << 22;
/// Frames of nodes that are combined for all keyframes.
const MAX_FRAMES: usize = 1 << 25;

/// The animation of a file.
pub(super) struct Motion {
    baked: Option<BakedAnimRoot>,
    /// Numbers of nodes, and where each is in the list.
    numbers: HashMap<u32, usize>,
    /// Keyframes and frames that may still be made.
    room: (usize, usize),
}

impl Motion {
    /// Bakes the first animation. The file's length in bytes limits the memory.
    pub fn read(file: &ufbx::Scene, bytes: usize, warnings: &mut Warnings) -> Result<Motion, String> {
        let mut stacks = file.anim_stacks.into_iter();
        let first = stacks.next();
        for other in stacks {
            warnings.add("of several animations the first is played", shown(&other.element.name));
        }
        let bake = |stack: &ufbx::AnimStack| {
            let (temp_allocator, result_allocator) = (memory(bytes), memory(bytes));
            let options = BakeOpts { temp_allocator, result_allocator, trim_start_time: true, ..BakeOpts::default() };
            bake_anim(file, &stack.anim, options)
                .map_err(|error| format!("its animation cannot be read ({})", error.description.to_lowercase()))
        };
        let baked = first.map(bake).transpose()?;
        let nodes = baked.as_ref().map_or(&[][..], |baked| baked.nodes.as_ref());
        let numbers = nodes.iter().enumerate().map(|(i, node)| (node.typed_id, i)).collect();
        Ok(Motion { baked, numbers, room: (MAX_KEYFRAMES, MAX_FRAMES) })
    }

    fn track(&self, node: &Node) -> Option<&BakedNode> {
        let number = self.numbers.get(&node.element.typed_id)?;
        self.baked.as_ref()?.nodes.as_ref().get(*number)
    }

    /// Where a node is in its parent at a time.
    fn local(&self, node: &Node, time: f64) -> DAffine3 {
        let Some(track) = self.track(node) else { return frame(&node.local_transform) };
        let rest = &node.local_transform;
        let vector = |keys: &[ufbx::BakedVec3], rest| match keys {
            [] => rest,
            keys => evaluate_baked_vec3(keys, time),
        };
        let rotation = match track.rotation_keys.as_ref() {
            [] => rest.rotation,
            keys => evaluate_baked_quat(keys, time),
        };
        placed(vector(&track.translation_keys, rest.translation), rotation, vector(&track.scale_keys, rest.scale))
    }

    /// Where a node is in the world at a time.
    fn world(&self, node: &Node, time: f64) -> DAffine3 {
        above(node).fold(DAffine3::IDENTITY, |below, node| self.local(node, time) * below)
    }

    /// Where a node is when the animation begins, or at rest.
    pub fn first(&self, node: &Node) -> DAffine3 {
        let has_track = above(node).any(|node| self.track(node).is_some());
        if has_track { self.world(node, 0.0) } else { affine(&node.node_to_world) }
    }

    /// Whether a node or one above it has keys.
    pub fn moves(&self, node: &Node) -> bool {
        !self.times(node).is_empty()
    }

    /// All times at which a node or one above it has a key, in order.
    fn times(&self, node: &Node) -> Vec<f64> {
        let mut times = Vec::new();
        for track in above(node).filter_map(|node| self.track(node)) {
            let moving = |keys: &[ufbx::BakedVec3], times: &mut Vec<f64>| times.extend(keys.iter().map(|k| k.time));
            if !track.constant_translation {
                moving(&track.translation_keys, &mut times);
            }
            if !track.constant_scale {
                moving(&track.scale_keys, &mut times);
            }
            if !track.constant_rotation {
                times.extend(track.rotation_keys.iter().map(|k| k.time));
            }
        }
        times.retain(|time| (*time as f32).is_finite());
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// The frame of a node and the rigid motion that is applied after it.
    pub fn of(
        &mut self,
        node: &Node,
        name: &str,
        warnings: &mut Warnings,
    ) -> Result<(DAffine3, Option<Animation>), String> {
        let first = self.first(node);
        let times = self.times(node);
        if times.is_empty() {
            return Ok((first, None));
        }
        let (keyframes, frames) = self.room;
        let left =
            (keyframes.checked_sub(times.len()), frames.checked_sub(times.len().saturating_mul(above(node).count())));
        let (Some(keyframes), Some(frames)) = left else {
            return Err(format!("its motion has more than {MAX_KEYFRAMES} keyframes, or very deep nodes"));
        };
        self.room = (keyframes, frames);
        let Some((turn, shape)) = split(&first.matrix3) else {
            warnings.add("nodes that move from a scale of 0 stay there", name);
            return Ok((first, None));
        };
        let mut is_rigid = true;
        let mut keyframes = Vec::new();
        for time in times {
            let world = self.world(node, time);
            let by = world.matrix3 * shape.inverse();
            let even = (by.transpose() * by).abs_diff_eq(DMat3::IDENTITY, 1e-3);
            is_rigid &= even;
            let rotation = split(&by).map_or(turn, |(turn, _)| turn);
            let (translation, rotation) = (world.translation.as_vec3(), rotation.as_quat().normalize());
            if !translation.is_finite() || !rotation.is_finite() {
                return Err(format!("node '{name}' has a motion that is not finite. Export it again"));
            }
            keyframes.push(Keyframe { time: time as f32, translation, rotation });
        }
        if !is_rigid {
            warnings.add("animations of scale are left out: motion is rigid", name);
        }
        let frame = DAffine3::from_mat3(shape);
        Ok((frame, Some(Animation { keyframes, repeat: true })))
    }
}

/// A node and those above it, to the root.
fn above(node: &Node) -> impl Iterator<Item = &Node> {
    std::iter::successors(Some(node), |node| node.parent.as_ref().map(|parent| parent.as_ref()))
}

/// A rotation times a shape, which may be mirrored; none without a volume.
fn split(m: &DMat3) -> Option<(DQuat, DMat3)> {
    let x = m.x_axis.try_normalize()?;
    let y = (m.y_axis - x * x.dot(m.y_axis)).try_normalize()?;
    let turn = DQuat::from_mat3(&DMat3::from_cols(x, y, x.cross(y)));
    let shape = DMat3::from_quat(turn.inverse()) * *m;
    (shape.determinant() != 0.0 && shape.inverse().is_finite()).then_some((turn, shape))
}
