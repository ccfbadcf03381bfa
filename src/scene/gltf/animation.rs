//! Tracks of nodes and morph target weights.

use std::collections::HashMap;
use std::sync::Arc;

use ::gltf::animation::{self, Animation, Channel, Property};
use ::gltf::{Document, Node};
use glam::{Quat, Vec3, Vec4};

use super::accessors;
use super::buffers::Buffers;
use crate::scene::clips;
use crate::scene::warnings::Warnings;
use crate::scene::{Curve, Interpolation, Rest, Track, Value};

/// Total keys of all channels; channels may share one list of times, so a small file could have
/// many.
const MAX_KEYS: usize = 1 << 22;

/// The motion of a document, by node.
#[derive(Default)]
pub(super) struct Tracks {
    nodes: HashMap<usize, Track>,
    /// A curve per morph target, and the period.
    weights: HashMap<usize, (Vec<Curve<f32>>, Option<f32>)>,
    /// Total keys read.
    keys: usize,
}

impl Tracks {
    /// The track of a node, if it moves.
    pub fn of(&self, node: &Node) -> Option<Arc<Track>> {
        let track = self.nodes.get(&node.index())?.clone();
        let (translation, rotation, scale) = node.transform().decomposed();
        let rest = Rest {
            translation: translation.into(),
            rotation: Quat::from_array(rotation),
            scale: scale.into(),
        };
        Some(Arc::new(Track { rest, ..track }))
    }

    /// The animated morph weights of a node.
    pub fn weights(&self, node: &Node) -> Option<&(Vec<Curve<f32>>, Option<f32>)> {
        self.weights.get(&node.index())
    }
}

/// All animations that target different nodes than earlier ones. Others are alternatives: the first
/// is played, or the one named `clip`.
pub(super) fn tracks(
    document: &Document,
    buffers: &Buffers,
    clip: Option<&str>,
    warnings: &mut Warnings,
) -> Result<Tracks, String> {
    let mut tracks = Tracks::default();
    let name = |a: &Animation| {
        a.name()
            .map_or_else(|| format!("animation {}", a.index()), str::to_owned)
    };
    let names: Vec<String> = document.animations().map(|a| name(&a)).collect();
    let chosen = clip.map(|clip| clips::number(clip, &names)).transpose()?;
    let mut animations: Vec<Animation> = document.animations().collect();
    // Ties keep their order, because the sort is stable.
    animations.sort_by_key(|a| Some(a.index()) != chosen);
    for animation in animations {
        let called = name(&animation);
        if animation.channels().any(|c| tracks.moves(&c)) {
            warnings.add(clips::LEFT_OUT, &called);
            continue;
        }
        let period = period(&animation, buffers)?;
        for channel in animation.channels() {
            tracks.add(&channel, period, buffers)?;
        }
    }
    Ok(tracks)
}

/// The time of the last key; all channels share it as their period.
fn period(animation: &Animation, buffers: &Buffers) -> Result<Option<f32>, String> {
    let mut last = 0f32;
    for sampler in animation.samplers() {
        let times = accessors::floats::<1>(&sampler.input(), buffers)?;
        last = times
            .iter()
            .map(|[t]| *t)
            .filter(|t| t.is_finite())
            .fold(last, f32::max);
    }
    Ok((last > 0.0).then_some(last))
}

impl Tracks {
    fn moves(&self, channel: &Channel) -> bool {
        let node = channel.target().node().index();
        let track = self.nodes.get(&node);
        match channel.target().property() {
            Property::Translation => track.is_some_and(|t| t.translation.is_some()),
            Property::Rotation => track.is_some_and(|t| t.rotation.is_some()),
            Property::Scale => track.is_some_and(|t| t.scale.is_some()),
            Property::MorphTargetWeights => self.weights.contains_key(&node),
        }
    }

    fn add(
        &mut self,
        channel: &Channel,
        period: Option<f32>,
        buffers: &Buffers,
    ) -> Result<(), String> {
        let (node, sampler) = (channel.target().node(), channel.sampler());
        let name = format!("the animation of node {}", node.index());
        let times: Vec<f32> = accessors::floats::<1>(&sampler.input(), buffers)?
            .into_iter()
            .map(|[t]| t)
            .collect();
        // Weights have one value per target and key.
        let targets = node
            .mesh()
            .and_then(|m| m.primitives().map(|p| p.morph_targets().len()).max())
            .unwrap_or(0);
        let is_weights = channel.target().property() == Property::MorphTargetWeights;
        let lists = if is_weights { targets } else { 1 };
        self.keys = self.keys.saturating_add(times.len().saturating_mul(lists));
        if self.keys > MAX_KEYS {
            return Err(format!("its animations have more than {MAX_KEYS} keys"));
        }
        let keys = Keys {
            name,
            times,
            interpolation: sampler.interpolation(),
        };
        let output = sampler.output();
        if is_weights {
            let values = accessors::floats::<1>(&output, buffers)?
                .into_iter()
                .map(|[w]| w)
                .collect();
            self.weights
                .insert(node.index(), (keys.weights(values, targets)?, period));
            return Ok(());
        }
        let track = self.nodes.entry(node.index()).or_default();
        track.period = period;
        match channel.target().property() {
            Property::Translation => {
                track.translation =
                    Some(keys.curve(accessors::floats::<3>(&output, buffers)?, Vec3::from_array)?);
            }
            Property::Scale => {
                track.scale =
                    Some(keys.curve(accessors::floats::<3>(&output, buffers)?, Vec3::from_array)?);
            }
            _ => track.rotation = Some(keys.rotation(accessors::floats::<4>(&output, buffers)?)?),
        }
        Ok(())
    }
}

struct Keys {
    name: String,
    times: Vec<f32>,
    interpolation: animation::Interpolation,
}

impl Keys {
    fn curve<T: Value, N>(
        self,
        values: Vec<N>,
        convert: impl Fn(N) -> T,
    ) -> Result<Curve<T>, String> {
        let Keys {
            name,
            times,
            interpolation,
        } = self;
        let interpolation = match interpolation {
            animation::Interpolation::Step => Interpolation::Step,
            animation::Interpolation::Linear => Interpolation::Linear,
            animation::Interpolation::CubicSpline => Interpolation::Cubic,
        };
        let counts = format!("{} values for {} times", values.len(), times.len());
        let values = values.into_iter().map(convert).collect();
        Curve::new(times, values, interpolation).ok_or_else(|| {
            format!("{name} has {counts}, times out of order, or numbers that are not finite")
        })
    }

    fn rotation(self, values: Vec<[f32; 4]>) -> Result<Curve<Quat>, String> {
        // Tangents of cubic curves are not unit quaternions.
        let cubic = self.interpolation == animation::Interpolation::CubicSpline;
        self.curve(
            values,
            |q| if cubic { Quat::from_array(q) } else { unit(q) },
        )
    }

    /// One curve per target, from values stored key by key.
    fn weights(self, values: Vec<f32>, targets: usize) -> Result<Vec<Curve<f32>>, String> {
        let of_target = |target: usize| {
            let values: Vec<f32> = values
                .iter()
                .skip(target)
                .step_by(targets)
                .copied()
                .collect();
            let Keys {
                name,
                times,
                interpolation,
            } = &self;
            Keys {
                name: name.clone(),
                times: times.clone(),
                interpolation: *interpolation,
            }
            .curve(values, |w| w)
        };
        (0..targets).map(of_target).collect()
    }
}

/// Normalises a quaternion, without overflow of its length. Zero gives the identity; non-finite
/// values are returned as they are.
fn unit(q: [f32; 4]) -> Quat {
    let q = Vec4::from_array(q);
    if !q.is_finite() {
        return Quat::from_vec4(q);
    }
    (q / q.abs().max_element())
        .try_normalize()
        .map_or(Quat::IDENTITY, Quat::from_vec4)
}
