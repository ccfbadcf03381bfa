//! Meshes that deform: what moves their vertices, and one mesh for each skin and each set of weights.

use std::collections::HashMap;
use std::ops::Range;

use ::gltf::mesh::Primitive;
use ::gltf::{Document, Node, Semantic, Skin};
use glam::{Mat4, Vec3};

use super::accessors;
use super::animation::Tracks;
use super::buffers::Buffers;
use super::nodes::Frames;
use crate::scene::warnings::Warnings;
use crate::scene::{Curve, Deformer, Influence, Interpolation, Joint, Morph, Scene};

/// What can move the vertices of a mesh or of a primitive, by vertex.
#[derive(Clone, Debug, Default)]
pub(super) struct Rig {
    influences: Vec<Influence>,
    influenced: Vec<Range<u32>>,
    morphs: Vec<Morph>,
    /// Whether a vertex has the normal of its triangle.
    flat: Vec<bool>,
}

impl Rig {
    /// That of a primitive with so many vertices; none where nothing moves them. Takes what it holds off `room`.
    pub fn read(
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
                let list = accessor.map(|a| accessors::floats::<3>(&a, buffers)).transpose()?.unwrap_or_default();
                match list.is_empty() || list.len() == count {
                    true => Ok(list.into_iter().map(finite).collect()),
                    false => Err(format!("a morph target has {} vectors for {count} vertices", list.len())),
                }
            };
            let (positions, normals) = (vectors(target.positions())?, vectors(target.normals())?);
            morphs.push(Morph { positions, normals, tangents: vectors(target.tangents())? });
        }
        let mut each: Vec<Vec<Influence>> = vec![Vec::new(); count];
        for set in 0.. {
            let semantics = (primitive.get(&Semantic::Joints(set)), primitive.get(&Semantic::Weights(set)));
            let (Some(joints), Some(weights)) = semantics else { break };
            take(true)?;
            let (joints, weights) =
                (accessors::floats::<4>(&joints, buffers)?, accessors::floats::<4>(&weights, buffers)?);
            if joints.len() != count || weights.len() != count {
                return Err(format!("{} joints and {} weights for {count} vertices", joints.len(), weights.len()));
            }
            for (list, (joints, weights)) in each.iter_mut().zip(joints.into_iter().zip(weights)) {
                let all = joints.into_iter().zip(weights).filter(|(_, weight)| *weight > 0.0 && weight.is_finite());
                list.extend(all.map(|(joint, weight)| Influence { joint: joint as u32, weight }));
            }
        }
        let mut rig = Rig { morphs, ..Rig::default() };
        each.iter().for_each(|list| rig.push(list));
        Ok(Some(rig))
    }

    /// Adds a vertex that these move; the format asks for weights that add up to 1.
    fn push(&mut self, influences: &[Influence]) {
        let sum: f32 = influences.iter().map(|i| i.weight).sum();
        let start = self.influences.len() as u32;
        self.influences.extend(influences.iter().map(|i| Influence { weight: i.weight / sum, ..*i }));
        self.influenced.push(start..self.influences.len() as u32);
    }

    fn of(&self, vertex: usize) -> &[Influence] {
        let range = self.influenced.get(vertex).cloned().unwrap_or(0..0);
        self.influences.get(range.start as usize..range.end as usize).unwrap_or_default()
    }

    /// Adds the vertices of a primitive, each of a source in its rig, behind `before` others.
    pub fn append(&mut self, before: usize, primitive: Option<&Rig>, sources: &[u32], flat: bool) {
        // Vertices so far that nothing moves.
        self.influenced.resize(before, 0..0);
        self.flat.resize(before, false);
        self.flat.resize(before + sources.len(), flat);
        let nothing = Rig::default();
        let from = primitive.unwrap_or(&nothing);
        sources.iter().for_each(|source| self.push(from.of(*source as usize)));
        let count = self.morphs.len().max(from.morphs.len());
        self.morphs.resize(count, Morph::default());
        for (morph, from) in self.morphs.iter_mut().zip(&from.morphs) {
            for (list, from) in [
                (&mut morph.positions, &from.positions),
                (&mut morph.normals, &from.normals),
                (&mut morph.tangents, &from.tangents),
            ] {
                if !from.is_empty() {
                    list.resize(before, Vec3::ZERO);
                    list.extend(sources.iter().map(|s| from.get(*s as usize).copied().unwrap_or_default()));
                }
            }
        }
    }
}

fn finite(v: [f32; 3]) -> Vec3 {
    Vec3::from_array(v.map(|x| if x.is_finite() { x } else { 0.0 }))
}

/// Poses the meshes of these instances, and makes deformers of those that move. The scene has its meshes.
pub(super) fn attach(
    scene: &mut Scene,
    deforming: &[(usize, Node)],
    (rigs, tracks, frames): (&HashMap<usize, Rig>, &Tracks, &Frames),
    (document, buffers): (&Document, &Buffers),
    warnings: &mut Warnings,
) -> Result<(), String> {
    let mut room = super::meshes::MANY + buffers.len();
    // Each mesh is itself for the first that poses it, unless something else shows it too.
    let posing: std::collections::HashSet<usize> = deforming.iter().map(|d| d.0).collect();
    let shown = scene.instances.iter().enumerate().filter(|(i, _)| !posing.contains(i));
    let mut taken: std::collections::HashSet<u32> = shown.map(|(_, instance)| instance.mesh).collect();
    let rest: Vec<_> = scene.meshes.clone().into_iter().map(|mesh| mesh.vertices).collect();
    for (instance, node) in deforming {
        let mesh = scene.instances[*instance].mesh;
        let Some(rig) = rigs.get(&(mesh as usize)) else { continue };
        let deformer = deformer(rig, node, tracks, frames, (document, buffers), warnings)?;
        let own = if taken.insert(mesh) { mesh } else { scene.meshes.len() as u32 };
        if own != mesh {
            let copy = scene.meshes[mesh as usize].clone();
            let many =
                || format!("its skins and weights make more than {} vertices of its meshes", super::meshes::MANY);
            room = room.checked_sub(copy.vertices.len() + copy.indices.len()).ok_or_else(many)?;
            scene.meshes.push(copy);
        }
        scene.instances[*instance].mesh = own;
        let mut deformer = Deformer { mesh: own, rest: rest[mesh as usize].clone(), ..deformer };
        let moves =
            deformer.joints.iter().any(|j| j.mover.is_some()) || deformer.weights.iter().any(|w| w.times().len() > 1);
        let target = &scene.meshes[own as usize];
        let posed = deformer.posed(target, &scene.mover_frames(0.0), 0.0);
        if moves {
            deformer.bounds = scene.deformed_bounds(&deformer);
            scene.deformers.push(deformer);
        }
        scene.meshes[own as usize].vertices = posed;
    }
    Ok(())
}

fn deformer(
    rig: &Rig,
    node: &Node,
    tracks: &Tracks,
    frames: &Frames,
    (document, buffers): (&Document, &Buffers),
    warnings: &mut Warnings,
) -> Result<Deformer, String> {
    let (weights, period) = match tracks.weights(node) {
        Some((curves, period)) => (curves.clone(), *period),
        None => {
            let given = node.weights().or_else(|| node.mesh().and_then(|m| m.weights())).unwrap_or_default();
            let fixed = |i| Curve::new(vec![0.0], vec![given.get(i).copied().unwrap_or(0.0)], Interpolation::Step);
            let curves: Option<Vec<_>> = (0..rig.morphs.len()).map(fixed).collect();
            (curves.ok_or_else(|| format!("node {} has weights that are not finite", node.index()))?, None)
        }
    };
    let joints = match node.skin() {
        Some(skin) => joints(&skin, frames, (document, buffers), warnings)?,
        None => Vec::new(),
    };
    if rig.influences.iter().any(|i| i.joint as usize >= joints.len()) && !joints.is_empty() {
        warnings.add("vertices of joints that their skin does not have stay where they are", skin_name(node));
    }
    let skinned = !joints.is_empty();
    Ok(Deformer {
        morphs: rig.morphs.clone(),
        weights,
        period,
        joints,
        influences: if skinned { rig.influences.clone() } else { Vec::new() },
        influenced: if skinned { rig.influenced.clone() } else { Vec::new() },
        flat: if rig.flat.contains(&true) { rig.flat.clone() } else { Vec::new() },
        ..Deformer::default()
    })
}

fn skin_name(node: &Node) -> String {
    node.name().map_or_else(|| format!("node {}", node.index()), str::to_owned)
}

fn joints(
    skin: &Skin,
    frames: &Frames,
    (_, buffers): (&Document, &Buffers),
    warnings: &mut Warnings,
) -> Result<Vec<Joint>, String> {
    let name = skin.name().map_or_else(|| format!("skin {}", skin.index()), str::to_owned);
    let inverse: Option<Vec<[f32; 16]>> =
        skin.inverse_bind_matrices().map(|a| accessors::floats::<16>(&a, buffers)).transpose()?;
    let count = skin.joints().len();
    if inverse.as_ref().is_some_and(|list| list.len() < count || list.iter().flatten().any(|x| !x.is_finite())) {
        return Err(format!("{name} has fewer inverse bind matrices than joints, or some are not finite"));
    }
    let joint = |(i, node): (usize, Node)| {
        let (mover, transform) = frames.get(&node.index()).copied().unwrap_or_else(|| {
            warnings.add("joints outside of the scene are at its origin", &name);
            (None, Mat4::IDENTITY)
        });
        let inverse_bind = inverse.as_ref().map_or(Mat4::IDENTITY, |list| Mat4::from_cols_array(&list[i]));
        Joint { mover, transform, inverse_bind }
    };
    Ok(skin.joints().enumerate().map(joint).collect())
}
