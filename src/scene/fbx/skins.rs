//! Skins: what moves the vertices of meshes, and the bones of instances.

use std::collections::HashMap;

use ufbx::{Mesh, SkinDeformer, SkinningMethod, get_blend_vertex_offset};

use super::nodes::Frames;
use super::numbers::{affine, placement, vector};
use crate::scene::motion::Rig;
use crate::scene::obj::shown;
use crate::scene::warnings::Warnings;
use crate::scene::{Influence, Joint};

/// The skin that moves a mesh; of several the first.
pub(super) fn of(mesh: &Mesh) -> Option<&SkinDeformer> {
    mesh.skin_deformers.into_iter().next()
}

/// A rig of a mesh's vertices, by their numbers in the file.
pub(super) fn rig(mesh: &Mesh, skin: &SkinDeformer, warnings: &mut Warnings) -> Rig {
    if matches!(skin.skinning_method, SkinningMethod::DualQuaternion | SkinningMethod::BlendedDqLinear) {
        warnings.add("skins by dual quaternions are posed by linear blending", shown(&skin.element.name));
    }
    if mesh.skin_deformers.len() > 1 {
        warnings.add("of several skins of one mesh the first moves it", shown(&mesh.element.name));
    }
    let mut rig = Rig::default();
    for vertex in &skin.vertices {
        let range =
            vertex.weight_begin as usize..(vertex.weight_begin as usize).saturating_add(vertex.num_weights as usize);
        let weights = skin.weights.as_ref().get(range).unwrap_or_default();
        let sound = weights.iter().filter(|w| w.weight > 0.0 && (w.weight as f32).is_finite());
        let list: Vec<Influence> =
            sound.map(|w| Influence { joint: w.cluster_index, weight: w.weight as f32 }).collect();
        rig.push(&list);
    }
    rig
}

/// The bones of a skin, where nodes have them.
pub(super) fn joints(skin: &SkinDeformer, frames: &Frames, warnings: &mut Warnings) -> Vec<Joint> {
    let joint = |cluster: &ufbx::SkinCluster| {
        let inverse_bind = placement(&affine(&cluster.geometry_to_bone));
        let frame = cluster.bone_node.as_ref().and_then(|bone| frames.get(&bone.element.typed_id));
        let (mover, transform) = frame.copied().unwrap_or_else(|| {
            warnings.add("bones that are no nodes are at the origin", shown(&skin.element.name));
            Default::default()
        });
        Joint { mover, transform, inverse_bind }
    };
    skin.clusters.into_iter().map(joint).collect()
}

/// Where the vertices of a mesh are before its skin moves them: with the weights of its blend shapes in the file.
pub(super) fn rest(mesh: &Mesh) -> HashMap<u32, [f64; 3]> {
    let mut moved = HashMap::new();
    for blend in &mesh.blend_deformers {
        for vertex in 0..mesh.vertices.len() as u32 {
            let offset = vector(get_blend_vertex_offset(blend, vertex as usize));
            if offset.is_finite() && offset != glam::DVec3::ZERO {
                let sum: &mut [f64; 3] = moved.entry(vertex).or_default();
                sum.iter_mut().zip(offset.to_array()).for_each(|(sum, add)| *sum += add);
            }
        }
    }
    moved
}
