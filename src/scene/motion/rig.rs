//! Joints and morph targets by vertex while a file is read, and the deformers that come of them.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use glam::Vec3;

use super::{Curve, Deformer, Influence, Joint, Morph};
use crate::scene::mesh::drop_flat;
use crate::scene::{Mesh, Scene};

/// Joints and morph targets of the vertices of a mesh or of a part.
#[derive(Clone, Debug, Default)]
pub(in crate::scene) struct Rig {
    pub influences: Vec<Influence>,
    pub influenced: Vec<Range<u32>>,
    pub morphs: Vec<Morph>,
    /// Whether a vertex has the normal of its triangle.
    pub flat: Vec<bool>,
}

/// The rigs of meshes that deform, by the number of the mesh.
pub(in crate::scene) type Rigs = HashMap<usize, Rig>;

/// The pose of an instance's mesh over time.
pub(in crate::scene) struct Posing {
    /// A number in [`Scene::instances`].
    pub instance: usize,
    /// None: there is no skin.
    pub joints: Vec<Joint>,
    /// One for each morph.
    pub weights: Vec<Curve<f32>>,
    /// Seconds after which weights start over.
    pub period: Option<f32>,
}

impl Rig {
    /// Adds a vertex that these move; the format asks for weights that add up to 1.
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

    /// Adds the vertices of a primitive, each of a source in its rig, behind `before` others.
    pub fn append(&mut self, before: usize, primitive: Option<&Rig>, sources: &[u32], flat: bool) {
        // The vertices before may have no rig.
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

/// Poses the meshes of instances, and makes deformers of those that move. The scene has its meshes, which `rigs` are of.
/// Copies of meshes take no more than `room` vertices and indices.
pub(in crate::scene) fn attach(
    scene: &mut Scene,
    posings: Vec<Posing>,
    rigs: &Rigs,
    mut room: usize,
) -> Result<(), String> {
    // Each mesh is itself for the first that poses it, unless something else shows it too.
    let posing: HashSet<usize> = posings.iter().map(|p| p.instance).collect();
    let shown = scene
        .instances
        .iter()
        .enumerate()
        .filter(|(i, _)| !posing.contains(i));
    let mut taken: HashSet<u32> = shown.map(|(_, instance)| instance.mesh).collect();
    let mut read: HashMap<u32, Mesh> = HashMap::new();
    let frames = scene.mover_frames(0.0);
    for Posing {
        instance,
        joints,
        weights,
        period,
    } in posings
    {
        let mesh = scene.instances[instance].mesh;
        let Some(rig) = rigs.get(&(mesh as usize)) else {
            continue;
        };
        let own = if taken.insert(mesh) {
            mesh
        } else {
            scene.meshes.len() as u32
        };
        // The mesh in its place may have been posed.
        let rest = read
            .entry(mesh)
            .or_insert_with(|| scene.meshes[mesh as usize].clone());
        if own != mesh {
            let left = room.checked_sub(rest.vertices.len() + rest.indices.len());
            room = left.ok_or("its skins and weights make very many copies of its meshes")?;
            scene.meshes.push(rest.clone());
        }
        let rest = rest.vertices.clone();
        scene.instances[instance].mesh = own;
        let skinned = !joints.is_empty();
        let mut deformer = Deformer {
            mesh: own,
            rest,
            morphs: rig.morphs.clone(),
            weights,
            period,
            joints,
            influences: if skinned {
                rig.influences.clone()
            } else {
                Vec::new()
            },
            influenced: if skinned {
                rig.influenced.clone()
            } else {
                Vec::new()
            },
            flat: if rig.flat.contains(&true) {
                rig.flat.clone()
            } else {
                Vec::new()
            },
            ..Deformer::default()
        };
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
