//! Skins: the bones of vertices and of instances.

use std::collections::HashMap;

use glam::Mat4;
use ufbx::{Mesh, SkinDeformer, SkinningMethod};

use super::numbers::{affine, placement};
use crate::scene::motion::Rig;
use crate::scene::obj::shown;
use crate::scene::warnings::Warnings;
use crate::scene::{Influence, Joint};

/// Moving frame and transform of each node by number.
pub(super) type Frames = HashMap<u32, (Option<u32>, Mat4)>;

/// The skin that moves a mesh; the first of several.
pub(super) fn of(mesh: &Mesh) -> Option<&SkinDeformer> {
    mesh.skin_deformers.into_iter().next()
}

/// Adds the bone influences of a mesh's vertices to its rig, by bone number in the file.
pub(super) fn add(rig: &mut Rig, mesh: &Mesh, skin: &SkinDeformer, warnings: &mut Warnings) {
    if matches!(
        skin.skinning_method,
        SkinningMethod::DualQuaternion | SkinningMethod::BlendedDqLinear
    ) {
        warnings.add(
            "skins by dual quaternions are posed by linear blending",
            shown(&skin.element.name),
        );
    }
    if mesh.skin_deformers.len() > 1 {
        warnings.add(
            "of several skins of one mesh the first moves it",
            shown(&mesh.element.name),
        );
    }
    for vertex in &skin.vertices {
        let range = vertex.weight_begin as usize
            ..(vertex.weight_begin as usize).saturating_add(vertex.num_weights as usize);
        let weights = skin.weights.as_ref().get(range).unwrap_or_default();
        let sound = weights
            .iter()
            .filter(|w| w.weight > 0.0 && (w.weight as f32).is_finite());
        let list: Vec<Influence> = sound
            .map(|w| Influence {
                joint: w.cluster_index,
                weight: w.weight as f32,
            })
            .collect();
        rig.push(&list);
    }
}

/// The joints of a skin, for bones with nodes.
pub(super) fn joints(skin: &SkinDeformer, frames: &Frames, warnings: &mut Warnings) -> Vec<Joint> {
    let joint = |cluster: &ufbx::SkinCluster| {
        let inverse_bind = placement(&affine(&cluster.geometry_to_bone));
        let frame = cluster
            .bone_node
            .as_ref()
            .and_then(|bone| frames.get(&bone.element.typed_id));
        let (mover, transform) = frame.copied().unwrap_or_else(|| {
            warnings.add(
                "bones that are no nodes are at the origin",
                shown(&skin.element.name),
            );
            Default::default()
        });
        Joint {
            mover,
            transform,
            inverse_bind,
        }
    };
    skin.clusters.into_iter().map(joint).collect()
}
