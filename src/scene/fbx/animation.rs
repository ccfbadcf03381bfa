//! Node motion from the first animation, baked by ufbx to linearly interpolated keys.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DQuat, Quat, Vec3};
use ufbx::{BakeOpts, BakedNode, BakedVec3, Node, bake_anim};

use super::file::memory;
use super::numbers::vector;
use crate::scene::clips;
use crate::scene::obj::shown;
use crate::scene::warnings::Warnings;
use crate::scene::{Curve, Interpolation, Rest, Track};

/// Tracks of nodes and weights of blend shapes.
#[derive(Default)]
pub(super) struct Motion {
    /// Keyed by the number of the node.
    tracks: HashMap<u32, Arc<Track>>,
    /// Keyed by the element of the channel.
    weights: HashMap<u32, Curve<f32>>,
    /// Period of all tracks (s).
    pub period: Option<f32>,
}

impl Motion {
    /// Bakes the first animation, or the one named `clip`. The length of the file in bytes limits
    /// the memory.
    pub fn read(
        file: &ufbx::Scene,
        bytes: usize,
        clip: Option<&str>,
        warnings: &mut Warnings,
    ) -> Result<Motion, String> {
        let stacks = file.anim_stacks.into_iter();
        let names: Vec<String> = stacks.map(|stack| shown(&stack.element.name)).collect();
        let chosen = clip.map(|clip| clips::number(clip, &names));
        let chosen = chosen.transpose()?.unwrap_or(0);
        let Some(first) = file.anim_stacks.into_iter().nth(chosen) else {
            return Ok(Motion::default());
        };
        for (_, name) in names.iter().enumerate().filter(|(i, _)| *i != chosen) {
            warnings.add(clips::LEFT_OUT, name);
        }
        let (temp_allocator, result_allocator) = (memory(bytes), memory(bytes));
        let options = BakeOpts {
            temp_allocator,
            result_allocator,
            trim_start_time: true,
            ..BakeOpts::default()
        };
        let baked = bake_anim(file, &first.anim, options).map_err(|error| {
            let why = error.description.to_lowercase();
            format!("its animation cannot be read ({why})")
        })?;
        let moves =
            |n: &&BakedNode| !(n.constant_translation && n.constant_rotation && n.constant_scale);
        let moving: Vec<&BakedNode> = baked.nodes.iter().filter(moves).collect();
        let weights = weights(&baked)?;
        // All tracks share the longest period.
        let last = moving.iter().map(|n| last_key(n)).fold(0.0, f64::max) as f32;
        let last = weights
            .values()
            .filter_map(|curve| curve.times().last().copied())
            .fold(last, f32::max);
        let period = Some(last).filter(|last| *last > 0.0 && last.is_finite());
        let mut tracks = HashMap::new();
        for baked in moving {
            let Some(node) = file.nodes.as_ref().get(baked.typed_id as usize) else {
                continue;
            };
            let track = track(node, baked, period).ok_or_else(|| {
                let name = shown(&node.element.name);
                format!("node '{name}' has a motion that is not finite. Export it again")
            })?;
            tracks.insert(baked.typed_id, Arc::new(track));
        }
        Ok(Motion {
            tracks,
            weights,
            period,
        })
    }

    /// The weight of a channel over time, if it changes.
    pub fn weights(&self, channel: &ufbx::BlendChannel) -> Option<&Curve<f32>> {
        self.weights.get(&channel.element.element_id)
    }

    /// The track of a node in its parent's frame, if it moves.
    pub fn of(&self, node: &Node) -> Option<Arc<Track>> {
        self.tracks.get(&node.element.typed_id).cloned()
    }
}

/// Weights of animated blend channels, scaled to 0..1.
fn weights(baked: &ufbx::BakedAnim) -> Result<HashMap<u32, Curve<f32>>, String> {
    let mut found = HashMap::new();
    for element in &baked.elements {
        let percent = element
            .props
            .iter()
            .find(|p| p.name.as_ref() == "DeformPercent" && !p.constant_value);
        let Some(percent) = percent.filter(|p| !p.keys.is_empty()) else {
            continue;
        };
        let times = percent.keys.iter().map(|k| k.time as f32).collect();
        let values = percent
            .keys
            .iter()
            .map(|k| (k.value.x / 100.0) as f32)
            .collect();
        let curve = Curve::new(times, values, Interpolation::Linear);
        let curve =
            curve.ok_or("a blend shape has weights that are not finite. Export it again")?;
        found.insert(element.element_id, curve);
    }
    Ok(found)
}

fn last_key(node: &BakedNode) -> f64 {
    let vectors = [&node.translation_keys, &node.scale_keys]
        .into_iter()
        .filter_map(|keys| keys.last().map(|k| k.time));
    vectors
        .chain(node.rotation_keys.last().map(|k| k.time))
        .filter(|t| t.is_finite())
        .fold(0.0, f64::max)
}

/// `None` if a number is not finite.
fn track(node: &Node, baked: &BakedNode, period: Option<f32>) -> Option<Track> {
    let rest = &node.local_transform;
    let rest = Rest {
        translation: vector(rest.translation).as_vec3(),
        rotation: rotation(rest.rotation),
        scale: vector(rest.scale).as_vec3(),
    };
    let vectors = |keys: &[BakedVec3]| {
        let times = keys.iter().map(|k| k.time as f32).collect();
        let values: Vec<Vec3> = keys.iter().map(|k| vector(k.value).as_vec3()).collect();
        Curve::new(times, values, Interpolation::Linear)
    };
    let curve = |keys: &[BakedVec3]| {
        if keys.is_empty() {
            Some(None)
        } else {
            vectors(keys).map(Some)
        }
    };
    let rotations: Vec<Quat> = baked
        .rotation_keys
        .iter()
        .map(|k| rotation(k.value))
        .collect();
    let times: Vec<f32> = baked.rotation_keys.iter().map(|k| k.time as f32).collect();
    let turns = match times.is_empty() {
        true => None,
        false => Some(Curve::new(times, rotations, Interpolation::Linear)?),
    };
    Some(Track {
        translation: curve(&baked.translation_keys)?,
        rotation: turns,
        scale: curve(&baked.scale_keys)?,
        rest,
        period,
    })
}

/// A quaternion of zero length becomes the identity.
fn rotation(q: ufbx::Quat) -> Quat {
    let q = DQuat::from_xyzw(q.x, q.y, q.z, q.w);
    let sound = q.is_finite() && q.length_squared() > 0.0;
    if sound {
        q.normalize().as_quat().normalize()
    } else {
        Quat::IDENTITY
    }
}
