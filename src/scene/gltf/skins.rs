//! Joints and morph targets of primitives, skins and weights of nodes.

use ::gltf::mesh::Primitive;
use ::gltf::{Node, Semantic, Skin};
use glam::{Mat4, Vec3};

use super::accessors;
use super::animation::Tracks;
use super::buffers::Buffers;
use super::nodes::Frames;
use crate::scene::motion::{Posing, Rig};
use crate::scene::warnings::Warnings;
use crate::scene::{Curve, Influence, Interpolation, Joint, Morph};

/// The influences of each vertex, from all sets. `take` reserves memory.
fn influences(
    primitive: &Primitive,
    buffers: &Buffers,
    count: usize,
    take: &mut impl FnMut(bool) -> Result<(), &'static str>,
) -> Result<Vec<Vec<Influence>>, String> {
    let mut each: Vec<Vec<Influence>> = vec![Vec::new(); count];
    for set in 0.. {
        let semantics = (
            primitive.get(&Semantic::Joints(set)),
            primitive.get(&Semantic::Weights(set)),
        );
        let (Some(joints), Some(weights)) = semantics else {
            break;
        };
        take(true)?;
        let joints = accessors::floats::<4>(&joints, buffers)?;
        let weights = accessors::floats::<4>(&weights, buffers)?;
        let (some, others) = (joints.len(), weights.len());
        if some != count || others != count {
            return Err(format!(
                "{some} joints and {others} weights for {count} vertices"
            ));
        }
        for (list, (joints, weights)) in each.iter_mut().zip(joints.into_iter().zip(weights)) {
            let all = joints.into_iter().zip(weights);
            let all = all.filter(|(_, weight)| *weight > 0.0 && weight.is_finite());
            list.extend(all.map(|(joint, weight)| Influence {
                joint: joint as u32,
                weight,
            }));
        }
    }
    Ok(each)
}

/// The rig of a primitive with `count` vertices; `None` without joints and targets. Its size is
/// subtracted from `room`.
pub(super) fn read(
    primitive: &Primitive,
    buffers: &Buffers,
    count: usize,
    room: &mut usize,
) -> Result<Option<Rig>, String> {
    let targets = primitive.morph_targets();
    if targets.len() == 0 && primitive.get(&Semantic::Joints(0)).is_none() {
        return Ok(None);
    }
    let mut take = |used: bool| match used {
        false => Ok(()),
        true => room
            .checked_sub(count)
            .map(|left| *room = left)
            .ok_or("it has more of joints and morph targets than the file holds bytes"),
    };
    let mut morphs = Vec::new();
    for target in targets {
        let mut vectors = |accessor: Option<::gltf::Accessor>| -> Result<Vec<Vec3>, String> {
            take(accessor.is_some())?;
            let list = accessor
                .map(|a| accessors::floats::<3>(&a, buffers))
                .transpose()?
                .unwrap_or_default();
            match list.is_empty() || list.len() == count {
                true => Ok(list.into_iter().map(finite).collect()),
                false => Err(format!(
                    "a morph target has {} vectors for {count} vertices",
                    list.len()
                )),
            }
        };
        let (positions, normals) = (vectors(target.positions())?, vectors(target.normals())?);
        morphs.push(Morph {
            positions,
            normals,
            tangents: vectors(target.tangents())?,
        });
    }
    let each = influences(primitive, buffers, count, &mut take)?;
    let mut rig = Rig {
        morphs,
        ..Rig::default()
    };
    each.iter().for_each(|list| rig.push(list));
    Ok(Some(rig))
}

fn finite(v: [f32; 3]) -> Vec3 {
    Vec3::from_array(v.map(|x| if x.is_finite() { x } else { 0.0 }))
}

/// The pose of an instance's mesh by its node.
pub(super) fn posing(
    (instance, node): (usize, &Node),
    rig: &Rig,
    (tracks, frames): (&Tracks, &Frames),
    buffers: &Buffers,
    warnings: &mut Warnings,
) -> Result<Posing, String> {
    let (weights, period) = match tracks.weights(node) {
        Some((curves, period)) => (curves.clone(), *period),
        None => {
            let given = node
                .weights()
                .or_else(|| node.mesh().and_then(|m| m.weights()))
                .unwrap_or_default();
            let fixed = |i| {
                Curve::new(
                    vec![0.0],
                    vec![given.get(i).copied().unwrap_or(0.0)],
                    Interpolation::Step,
                )
            };
            let curves: Option<Vec<_>> = (0..rig.morphs.len()).map(fixed).collect();
            (
                curves.ok_or_else(|| {
                    format!("node {} has weights that are not finite", node.index())
                })?,
                None,
            )
        }
    };
    let joints = match node.skin() {
        Some(skin) => joints(&skin, frames, buffers, warnings)?,
        None => Vec::new(),
    };
    if rig
        .influences
        .iter()
        .any(|i| i.joint as usize >= joints.len())
        && !joints.is_empty()
    {
        warnings.add(
            "vertices of joints that their skin does not have stay where they are",
            skin_name(node),
        );
    }
    Ok(Posing {
        instance,
        joints,
        weights,
        period,
    })
}

fn skin_name(node: &Node) -> String {
    node.name()
        .map_or_else(|| format!("node {}", node.index()), str::to_owned)
}

fn joints(
    skin: &Skin,
    frames: &Frames,
    buffers: &Buffers,
    warnings: &mut Warnings,
) -> Result<Vec<Joint>, String> {
    let name = skin
        .name()
        .map_or_else(|| format!("skin {}", skin.index()), str::to_owned);
    let inverse: Option<Vec<[f32; 16]>> = skin
        .inverse_bind_matrices()
        .map(|a| accessors::floats::<16>(&a, buffers))
        .transpose()?;
    let count = skin.joints().len();
    if inverse
        .as_ref()
        .is_some_and(|list| list.len() < count || list.iter().flatten().any(|x| !x.is_finite()))
    {
        return Err(format!(
            "{name} has fewer inverse bind matrices than joints, or some are not finite"
        ));
    }
    let joint = |(i, node): (usize, Node)| {
        let (mover, transform) = frames.get(&node.index()).copied().unwrap_or_else(|| {
            warnings.add("joints outside of the scene are at its origin", &name);
            (None, Mat4::IDENTITY)
        });
        let inverse_bind = inverse
            .as_ref()
            .map_or(Mat4::IDENTITY, |list| Mat4::from_cols_array(&list[i]));
        Joint {
            mover,
            transform,
            inverse_bind,
        }
    };
    Ok(skin.joints().enumerate().map(joint).collect())
}
