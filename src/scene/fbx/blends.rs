//! Blend shapes: vertex offsets and weights over time.

use glam::Vec3;
use ufbx::{BlendKeyframe, BlendShape, Mesh};

use super::animation::Motion;
use super::numbers::vector;
use crate::scene::{Curve, Interpolation, Morph};

/// A shape for each keyframe of each channel, in file order.
fn keyframes(mesh: &Mesh) -> impl Iterator<Item = (&ufbx::BlendChannel, &BlendKeyframe)> {
    let channels = mesh
        .blend_deformers
        .into_iter()
        .flat_map(|deformer| deformer.channels.into_iter());
    channels.flat_map(|channel| channel.keyframes.iter().map(move |key| (channel, key)))
}

/// Whether a mesh has blend shapes.
pub(super) fn any(mesh: &Mesh) -> bool {
    keyframes(mesh).next().is_some()
}

/// Offsets for each vertex of the file. Their number is subtracted from `room`.
pub(super) fn morphs(mesh: &Mesh, room: &mut usize) -> Result<Vec<Morph>, String> {
    let rest = Smooth::of(mesh, None);
    let morph = |(_, key): (_, &BlendKeyframe)| {
        let left = room.checked_sub(2 * mesh.vertices.len());
        *room = left.ok_or("its blend shapes hold many more vertices than the file holds bytes")?;
        let shape: &BlendShape = &key.shape;
        let mut positions = vec![Vec3::ZERO; mesh.vertices.len()];
        for (vertex, offset) in shape
            .offset_vertices
            .iter()
            .zip(shape.position_offsets.iter())
        {
            let offset = vector(*offset).as_vec3();
            if let Some(sum) = positions
                .get_mut(*vertex as usize)
                .filter(|_| offset.is_finite())
            {
                *sum += offset;
            }
        }
        let moved = Smooth::of(mesh, Some(&positions));
        let normals = rest
            .0
            .iter()
            .zip(&moved.0)
            .map(|(rest, moved)| moved.normalize_or_zero() - rest.normalize_or_zero());
        Ok(Morph {
            normals: normals.collect(),
            positions,
            tangents: Vec::new(),
        })
    };
    keyframes(mesh).map(morph).collect()
}

/// The weight of each shape over time. Channels with several shapes keep their static weights.
pub(super) fn weights(mesh: &Mesh, motion: &Motion) -> Option<Vec<Curve<f32>>> {
    let weight = |(channel, key): (&ufbx::BlendChannel, &BlendKeyframe)| {
        let alone = channel.keyframes.len() == 1 && key.target_weight != 0.0;
        let curve = motion
            .weights(channel)
            .filter(|_| alone)
            .and_then(|c| c.scaled(1.0 / key.target_weight as f32));
        let constant = || {
            Curve::new(
                vec![0.0],
                vec![key.effective_weight as f32],
                Interpolation::Step,
            )
        };
        curve.or_else(constant)
    };
    keyframes(mesh).map(weight).collect()
}

/// Sum of the area-weighted face normals at each vertex. The change of this sum under a shape is
/// applied to the normals of the file, because few files have normals for shapes.
struct Smooth(Vec<Vec3>);

impl Smooth {
    fn of(mesh: &Mesh, moved: Option<&[Vec3]>) -> Smooth {
        let place = |vertex: u32| {
            let at = mesh
                .vertices
                .as_ref()
                .get(vertex as usize)
                .map_or(Vec3::ZERO, |v| vector(*v).as_vec3());
            at + moved
                .and_then(|m| m.get(vertex as usize))
                .copied()
                .unwrap_or(Vec3::ZERO)
        };
        let mut sums = vec![Vec3::ZERO; mesh.vertices.len()];
        for face in &mesh.faces {
            let first = face.index_begin as usize;
            let Some(corners) = mesh
                .vertex_indices
                .as_ref()
                .get(first..first + face.num_indices as usize)
            else {
                continue;
            };
            let Some((hub, rest)) = corners.split_first() else {
                continue;
            };
            let fan = rest
                .windows(2)
                .map(|w| (place(w[0]) - place(*hub)).cross(place(w[1]) - place(*hub)));
            let normal: Vec3 = fan.sum();
            for vertex in corners {
                if let Some(sum) = sums
                    .get_mut(*vertex as usize)
                    .filter(|_| normal.is_finite())
                {
                    *sum += normal;
                }
            }
        }
        Smooth(sums)
    }
}
