//! Vertex deformation by morph targets, then by skins (glTF 2.0, 3.7.2.2 and 3.7.3).

use std::ops::Range;

use glam::{Mat3, Mat4, Vec3, Vec4};
use rayon::prelude::*;

use super::curve::Curve;
use super::{in_world, wrapped};
use crate::scene::mesh::face_normal;
use crate::scene::split::halfway;
use crate::scene::{Mesh, Scene, Vertex};

/// Deformation of a mesh. Meshes in [`Scene::meshes`] are stored in the pose at 0 s.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Deformer {
    /// Index into [`Scene::meshes`].
    pub mesh: u32,
    /// Undeformed position, normal and tangent of the first vertices.
    pub rest: Vec<Vertex>,
    /// Morph targets.
    pub(crate) morphs: Vec<Morph>,
    /// The weight of each morph over time.
    pub weights: Vec<Curve<f32>>,
    /// Period of the weights (s).
    pub period: Option<f32>,
    /// The joints of the skin; empty without a skin.
    pub joints: Vec<Joint>,
    /// The influences of all vertices, in vertex order.
    pub(crate) influences: Vec<Influence>,
    /// The influences of each vertex, as a range of `influences`.
    pub(crate) influenced: Vec<Range<u32>>,
    /// Whether each vertex uses its triangle's normal in every pose. Empty: none does.
    pub flat: Vec<bool>,
    /// For each vertex after those of `rest`, the ends of the edge that it halves; both come
    /// earlier.
    pub halves: Vec<[u32; 2]>,
    /// Bounds over all poses.
    pub bounds: (Vec3, Vec3),
}

/// Per-vertex offsets of a morph target; empty lists are zero.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Morph {
    /// Offsets of positions (m).
    pub positions: Vec<Vec3>,
    /// Offsets of normals, added before normalisation.
    pub normals: Vec<Vec3>,
    /// Offsets of tangents, added before normalisation.
    pub tangents: Vec<Vec3>,
}

/// A joint of a skin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// The mover that it follows.
    pub mover: Option<u32>,
    /// Its transform in that mover's frame.
    pub transform: Mat4,
    /// From the undeformed mesh to the joint.
    pub inverse_bind: Mat4,
}

/// A joint's influence on a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Influence {
    /// Index into [`Deformer::joints`].
    pub joint: u32,
    /// The weights of a vertex sum to 1.
    pub weight: f32,
}

/// Morph weights and joint matrices at a time.
struct Pose {
    weights: Vec<f32>,
    joints: Vec<Mat4>,
}

impl Scene {
    /// The vertices of all meshes at a time in seconds, with deformations applied.
    pub fn posed_meshes(&self, time: f32) -> Vec<std::borrow::Cow<'_, [Vertex]>> {
        let mut meshes: Vec<_> = self
            .meshes
            .iter()
            .map(|m| std::borrow::Cow::Borrowed(m.vertices.as_slice()))
            .collect();
        if self.deformers.is_empty() {
            return meshes;
        }
        let frames = self.mover_frames(time);
        for deformer in &self.deformers {
            let number = deformer.mesh as usize;
            if let (Some(posed), Some(mesh)) = (meshes.get_mut(number), self.meshes.get(number)) {
                *posed = deformer.posed(mesh, &frames, time).into();
            }
        }
        meshes
    }
}

impl Deformer {
    /// The deformed vertices of its mesh at a time in seconds.
    pub(in crate::scene) fn posed(&self, mesh: &Mesh, frames: &[Mat4], time: f32) -> Vec<Vertex> {
        let mut vertices = mesh.vertices.clone();
        let pose = self.pose(frames, time);
        let own = vertices.len().min(self.rest.len());
        vertices[..own]
            .par_iter_mut()
            .enumerate()
            .for_each(|(i, vertex)| self.place(i, vertex, &pose));
        for (i, [a, b]) in (self.rest.len()..).zip(&self.halves) {
            if let (Some(a), Some(b)) = (vertices.get(*a as usize), vertices.get(*b as usize)) {
                let middle = halfway(a, b);
                if let Some(vertex) = vertices.get_mut(i) {
                    *vertex = middle;
                }
            }
        }
        if !self.flat.is_empty() {
            for triangle in mesh
                .indices
                .as_chunks::<3>()
                .0
                .iter()
                .filter(|t| self.is_flat(t[0]))
            {
                let normal =
                    face_normal(triangle.map(|i| vertices[i as usize].position)).to_array();
                triangle
                    .iter()
                    .for_each(|i| vertices[*i as usize].normal = normal);
            }
        }
        vertices
    }

    fn is_flat(&self, vertex: u32) -> bool {
        let mut vertex = vertex as usize;
        // A halved vertex comes after its two ends.
        while let Some([first, _]) = vertex
            .checked_sub(self.rest.len())
            .and_then(|half| self.halves.get(half))
        {
            if *first as usize >= vertex {
                return false;
            }
            vertex = *first as usize;
        }
        self.flat.get(vertex).copied().unwrap_or(false)
    }

    fn pose(&self, frames: &[Mat4], time: f32) -> Pose {
        let time = wrapped(time, self.period);
        let joint = |j: &Joint| in_world(frames, j.mover, j.transform) * j.inverse_bind;
        Pose {
            weights: self.weights.iter().map(|curve| curve.at(time)).collect(),
            joints: self.joints.iter().map(joint).collect(),
        }
    }

    fn place(&self, i: usize, vertex: &mut Vertex, pose: &Pose) {
        let rest = &self.rest[i];
        let mut position = Vec3::from_array(rest.position);
        let mut normal = Vec3::from_array(rest.normal);
        let [x, y, z, sign] = rest.tangent;
        let mut tangent = Vec3::new(x, y, z);
        for (morph, weight) in self
            .morphs
            .iter()
            .zip(&pose.weights)
            .filter(|(_, w)| **w != 0.0)
        {
            let add = |sum: &mut Vec3, list: &[Vec3]| {
                *sum += list.get(i).copied().unwrap_or(Vec3::ZERO) * *weight
            };
            add(&mut position, &morph.positions);
            add(&mut normal, &morph.normals);
            add(&mut tangent, &morph.tangents);
        }
        let influences = self.influenced.get(i).cloned().unwrap_or(0..0);
        let influences = self
            .influences
            .get(influences.start as usize..influences.end as usize)
            .unwrap_or_default();
        if !influences.is_empty() {
            let mut skin = Mat4::ZERO;
            for influence in influences {
                let joint = pose
                    .joints
                    .get(influence.joint as usize)
                    .copied()
                    .unwrap_or(Mat4::IDENTITY);
                skin += joint * influence.weight;
            }
            position = skin.transform_point3(position);
            let axes = Mat3::from_mat4(skin);
            normal = cofactors(&axes) * normal;
            tangent = axes * tangent;
        }
        vertex.position = position.to_array();
        vertex.normal = normal.try_normalize().map_or(rest.normal, |n| n.to_array());
        let tangent =
            tangent.normalize_or(Vec3::from_array(vertex.normal).any_orthonormal_vector());
        vertex.tangent = Vec4::from((tangent, sign)).to_array();
    }
}

/// The cofactor matrix, which transforms normals: the inverse transpose up to a positive factor,
/// defined for singular matrices too.
fn cofactors(m: &Mat3) -> Mat3 {
    let (x, y, z) = (m.x_axis, m.y_axis, m.z_axis);
    let all = Mat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    if m.determinant() < 0.0 {
        all * -1.0
    } else {
        all
    }
}
