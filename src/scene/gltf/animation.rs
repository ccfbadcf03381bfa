//! Translation and rotation tracks of nodes. Scales, weights and skins stay at rest, with a warning.

use std::collections::HashMap;

use ::gltf::Document;
use ::gltf::animation::{Interpolation, Property};
use glam::{Quat, Vec3, Vec4};

use super::accessors;
use super::buffers::Buffers;
use crate::scene::warnings::Warnings;

/// A sampled curve: times in order, one value each.
#[derive(Clone, Debug)]
pub(super) struct Curve<T> {
    times: Vec<f32>,
    values: Vec<T>,
}

/// The motion of one node, in its parent's frame; a missing curve is the node's rest pose.
#[derive(Clone, Debug, Default)]
pub(super) struct Track {
    pub translation: Option<Curve<Vec3>>,
    pub rotation: Option<Curve<Quat>>,
}

impl<T: Copy> Curve<T> {
    fn at(&self, time: f32, mix: impl Fn(T, T, f32) -> T) -> T {
        let next = self.times.partition_point(|&t| t <= time);
        let (a, b) = (next.saturating_sub(1), next.min(self.times.len() - 1));
        let span = self.times[b] - self.times[a];
        let s = if span > 0.0 { ((time - self.times[a]) / span).clamp(0.0, 1.0) } else { 0.0 };
        mix(self.values[a], self.values[b], s)
    }
}

impl Track {
    /// All times at which either curve has a key.
    pub fn times(&self) -> Vec<f32> {
        let mut times: Vec<f32> = self.translation.iter().flat_map(|c| c.times.iter().copied()).collect();
        times.extend(self.rotation.iter().flat_map(|c| c.times.iter().copied()));
        times.sort_by(f32::total_cmp);
        times.dedup();
        times
    }

    /// Translation and rotation at a time, with the rest pose where there is no curve.
    pub fn at(&self, time: f32, rest: (Vec3, Quat)) -> (Vec3, Quat) {
        let translation = self.translation.as_ref().map_or(rest.0, |c| c.at(time, |a, b, s| a.lerp(b, s)));
        let rotation = self.rotation.as_ref().map_or(rest.1, |c| c.at(time, |a, b, s| a.slerp(b, s)));
        (translation, rotation)
    }
}

/// The tracks of all animated nodes, by node index. A node that two animations move follows the first.
pub(super) fn tracks(
    document: &Document,
    buffers: &Buffers,
    warnings: &mut Warnings,
) -> Result<HashMap<usize, Track>, String> {
    let mut tracks: HashMap<usize, Track> = HashMap::new();
    for animation in document.animations() {
        for channel in animation.channels() {
            let node = channel.target().node();
            let called = node.name().map_or_else(|| format!("node {}", node.index()), str::to_owned);
            let sampler = channel.sampler();
            let name = format!("the animation of '{called}'");
            let times: Vec<f32> = accessors::floats::<1>(&sampler.input(), buffers)?.into_iter().map(|[t]| t).collect();
            if times.is_empty() || !times.is_sorted() || times.iter().any(|t| !t.is_finite()) {
                return Err(format!("{name} has no times or times out of order"));
            }
            let interpolation = sampler.interpolation();
            if interpolation == Interpolation::CubicSpline {
                warnings.add("cubic splines of animations are played as straight lines", &called);
            }
            let track = tracks.entry(node.index()).or_default();
            match channel.target().property() {
                Property::Translation if track.translation.is_none() => {
                    let values = accessors::floats::<3>(&sampler.output(), buffers)?;
                    track.translation = Some(curve(&name, times, values, interpolation, Vec3::from_array)?);
                }
                Property::Rotation if track.rotation.is_none() => {
                    let values = accessors::floats::<4>(&sampler.output(), buffers)?;
                    // Numbers near the largest have no finite length, and all of zero turn nothing.
                    let unit = |q: [f32; 4]| {
                        let q = Vec4::from_array(q);
                        (q / q.abs().max_element()).try_normalize().map_or(Quat::IDENTITY, Quat::from_vec4)
                    };
                    track.rotation = Some(curve(&name, times, values, interpolation, unit)?);
                }
                Property::Translation | Property::Rotation => {
                    warnings.add("of several animations of one node the first is played", &called);
                }
                Property::Scale => warnings.add("animations of scale are left out: motion is rigid", &called),
                Property::MorphTargetWeights => warnings.add("animations of morph weights are left out", &called),
            }
        }
    }
    tracks.retain(|_, track| track.translation.is_some() || track.rotation.is_some());
    Ok(tracks)
}

fn curve<const N: usize, T: Copy>(
    name: &str,
    times: Vec<f32>,
    values: Vec<[f32; N]>,
    interpolation: Interpolation,
    convert: impl Fn([f32; N]) -> T,
) -> Result<Curve<T>, String> {
    let per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    if values.len() != times.len() * per_key || values.iter().flatten().any(|v| !v.is_finite()) {
        return Err(format!("{name} has {} values for {} times, or some are not finite", values.len(), times.len()));
    }
    // A cubic key is an in-tangent, the value and an out-tangent.
    let mut curve = Curve { values: values.chunks(per_key).map(|k| convert(k[per_key / 2])).collect(), times };
    if interpolation == Interpolation::Step {
        hold(&mut curve);
    }
    Ok(curve)
}

/// Steps as lines: each value is repeated just before the next key.
fn hold<T: Copy>(curve: &mut Curve<T>) {
    let (mut times, mut values) = (Vec::new(), Vec::new());
    for (i, (&time, &value)) in curve.times.iter().zip(&curve.values).enumerate() {
        times.push(time);
        values.push(value);
        if let Some(&next) = curve.times.get(i + 1) {
            times.push(next.next_down().max(time));
            values.push(value);
        }
    }
    *curve = Curve { times, values };
}
