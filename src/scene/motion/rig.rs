//! Per-vertex joints and morph targets during loading, and the deformers made of them.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use glam::Vec3;

use super::{Curve, Deformer, Influence, Joint, Morph};
use crate::scene::mesh::drop_flat;
use crate::scene::{Mesh, Scene, Vertex};

/// Joints and morph targets of a mesh or primitive.
#[derive(Clone, Debug, Default)]
pub(in crate::scene) struct Rig {
    pub influences: Vec<Influence>,
    pub influenced: Vec<Range<u32>>,
    pub morphs: Vec<Morph>,
    /// Whether a vertex uses its triangle's normal.
    pub flat: Vec<bool>,
}

/// Rigs of deforming meshes by mesh index.
pub(in crate::scene) type Rigs = HashMap<usize, Rig>;

/// Animated joints and weights of an instance's mesh.
pub(in crate::scene) struct Posing {
    /// Index into [`Scene::instances`].
    pub instance: usize,
    /// The joints; empty without a skin.
    pub joints: Vec<Joint>,
    /// One curve per morph.
    pub weights: Vec<Curve<f32>>,
    /// Period of the weights (s).
    pub period: Option<f32>,
}

impl Rig {
    /// Adds a vertex with its influences; weights are normalised, as the format requires.
    pub fn push(&mut self, influences: &[Influence]) {
        let sum: f32 = influences.iter().map(|i| i.weight).sum();
        let start = self.influences.len() as u32;
        self.influences.extend(influences.iter().map(|i| Influence {
            weight: i.weight / sum,
            ..*i
        }));
        self.influenced.push(start..self.influences.len() as u32);
    }

    fn of(&self, vertex: usize) -> &[Influence] {
        let range = self.influenced.get(vertex).cloned().unwrap_or(0..0);
        self.influences
            .get(range.start as usize..range.end as usize)
            .unwrap_or_default()
    }

    /// Appends the vertices of a primitive by their sources in its rig, after `before` others.
    pub fn append(&mut self, before: usize, primitive: Option<&Rig>, sources: &[u32], flat: bool) {
        // Earlier vertices may have no rig.
        self.influenced.resize(before, 0..0);
        self.flat.resize(before, false);
        self.flat.resize(before + sources.len(), flat);
        let nothing = Rig::default();
        let from = primitive.unwrap_or(&nothing);
        sources
            .iter()
            .for_each(|source| self.push(from.of(*source as usize)));
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
                    list.extend(
                        sources
                            .iter()
                            .map(|s| from.get(*s as usize).copied().unwrap_or_default()),
                    );
                }
            }
        }
    }
}

fn if_needed<T: Clone>(is_needed: bool, list: &[T]) -> Vec<T> {
    if is_needed { list.to_vec() } else { Vec::new() }
}

impl Rig {
    /// Lists that are not needed stay empty.
    fn deformer(&self, mesh: u32, rest: Vec<Vertex>, posing: Posing) -> Deformer {
        let is_skinned = !posing.joints.is_empty();
        let is_flat = self.flat.contains(&true);
        Deformer {
            mesh,
            rest,
            morphs: self.morphs.clone(),
            weights: posing.weights,
            period: posing.period,
            joints: posing.joints,
            influences: if_needed(is_skinned, &self.influences),
            influenced: if_needed(is_skinned, &self.influenced),
            flat: if_needed(is_flat, &self.flat),
            ..Deformer::default()
        }
    }
}

/// Poses the meshes of instances and creates deformers for those that move. `rigs` is indexed by
/// the scene's meshes. Copies of meshes use at most `room` vertices and indices.
pub(in crate::scene) fn attach(
    scene: &mut Scene,
    posings: Vec<Posing>,
    rigs: &Rigs,
    mut room: usize,
) -> Result<(), String> {
    // The first posing of a mesh reuses it, unless another instance shows it too.
    let posing: HashSet<usize> = posings.iter().map(|p| p.instance).collect();
    let instances = scene.instances.iter().enumerate();
    let shown = instances.filter(|(i, _)| !posing.contains(i));
    let mut taken: HashSet<u32> = shown.map(|(_, instance)| instance.mesh).collect();
    let mut read: HashMap<u32, Mesh> = HashMap::new();
    let frames = scene.mover_frames(0.0);
    for posing in posings {
        let mesh = scene.instances[posing.instance].mesh;
        let Some(rig) = rigs.get(&(mesh as usize)) else {
            continue;
        };
        let own = match taken.insert(mesh) {
            true => mesh,
            false => scene.meshes.len() as u32,
        };
        // The mesh may already be posed.
        let rest = read.entry(mesh);
        let rest = rest.or_insert_with(|| scene.meshes[mesh as usize].clone());
        if own != mesh {
            let left = room.checked_sub(rest.vertices.len() + rest.indices.len());
            room = left.ok_or("its skins and weights make very many copies of its meshes")?;
            scene.meshes.push(rest.clone());
        }
        let rest = rest.vertices.clone();
        scene.instances[posing.instance].mesh = own;
        let mut deformer = rig.deformer(own, rest, posing);
        let moves = deformer.joints.iter().any(|j| j.mover.is_some())
            || deformer.weights.iter().any(|w| w.times().len() > 1);
        let posed = deformer.posed(&scene.meshes[own as usize], &frames, 0.0);
        if moves {
            deformer.bounds = scene.deformed_bounds(&deformer);
            scene.deformers.push(deformer);
        }
        let mesh = &mut scene.meshes[own as usize];
        mesh.vertices = posed;
        if !moves {
            drop_flat(mesh);
        }
    }
    Ok(())
}
