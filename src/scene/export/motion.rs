//! Moving nodes of a glTF file. Each mover becomes two nodes: the static placement and, below it,
//! the animated node.

use glam::Mat4;
use serde_json::{Value, json};

use super::writer::Writer;
use crate::scene::{Curve, Interpolation, Mover, Scene, Track};

/// Channels with one period: a glTF animation lasts as long as its longest channel.
#[derive(Default)]
struct Clip {
    period: Option<f32>,
    channels: Vec<Value>,
    samplers: Vec<Value>,
}

impl Clip {
    fn json(&self) -> Value {
        json!({ "channels": self.channels, "samplers": self.samplers })
    }
}

/// The animated node of each mover that an instance uses, and the animations.
pub(super) fn movers(writer: &mut Writer, scene: &Scene) -> (Vec<Option<usize>>, Vec<Value>) {
    let mut names: Vec<Option<&str>> = vec![None; scene.movers.len()];
    for instance in &scene.instances {
        let mut next = instance.mover.map(|m| m as usize);
        while let Some((number, mover)) = next.and_then(|n| Some((n, scene.movers.get(n)?))) {
            names[number].get_or_insert(&instance.name);
            next = mover.parent.map(|p| p as usize).filter(|p| *p < number);
        }
    }
    let mut nodes: Vec<Option<usize>> = vec![None; scene.movers.len()];
    let mut clips = Vec::new();
    for (number, (mover, name)) in scene.movers.iter().zip(names).enumerate() {
        let Some(name) = name else { continue };
        let mut parent = mover
            .parent
            .and_then(|p| nodes.get(p as usize).copied().flatten());
        if mover.placed != Mat4::IDENTITY {
            parent = Some(writer.below(parent, json!({ "matrix": mover.placed.to_cols_array() })));
        }
        nodes[number] = Some(moving(writer, &mut clips, parent, name, mover));
    }
    (nodes, clips.iter().map(Clip::json).collect())
}

fn moving(
    writer: &mut Writer,
    clips: &mut Vec<Clip>,
    parent: Option<usize>,
    name: &str,
    mover: &Mover,
) -> usize {
    let Track {
        translation,
        rotation,
        scale,
        period,
        ..
    } = &*mover.track;
    let (size, turn, place) = mover.track.at(0.0).to_scale_rotation_translation();
    let node = writer.below(
        parent,
        json!({ "name": format!("{name} motion"), "translation": place.to_array(), "rotation": turn.to_array(),
            "scale": size.to_array() }),
    );
    let clip = clips
        .iter()
        .position(|clip| clip.period == *period)
        .unwrap_or_else(|| {
            clips.push(Clip {
                period: *period,
                ..Clip::default()
            });
            clips.len() - 1
        });
    let clip = &mut clips[clip];
    channel(writer, clip, (node, "translation"), translation, |v| {
        v.to_array().to_vec()
    });
    channel(writer, clip, (node, "rotation"), rotation, |q| {
        q.to_array().to_vec()
    });
    channel(writer, clip, (node, "scale"), scale, |v| {
        v.to_array().to_vec()
    });
    node
}

fn channel<T: crate::scene::Value>(
    writer: &mut Writer,
    clip: &mut Clip,
    (node, path): (usize, &str),
    curve: &Option<Curve<T>>,
    numbers: impl Fn(T) -> Vec<f32>,
) {
    let Some(curve) = curve else { return };
    let times = curve.times();
    let values: Vec<f32> = curve.values().iter().flat_map(|v| numbers(*v)).collect();
    let kind = if path == "rotation" { "VEC4" } else { "VEC3" };
    let input = writer.floats(bytemuck::cast_slice(times), "SCALAR", times.len());
    writer.limits(input, times[0], times[times.len() - 1]);
    let output = writer.floats(bytemuck::cast_slice(&values), kind, curve.values().len());
    let interpolation = match curve.interpolation() {
        Interpolation::Step => "STEP",
        Interpolation::Linear => "LINEAR",
        Interpolation::Cubic => "CUBICSPLINE",
    };
    clip.channels
        .push(json!({ "sampler": clip.samplers.len(), "target": { "node": node, "path": path } }));
    clip.samplers
        .push(json!({ "input": input, "output": output, "interpolation": interpolation }));
}
