//! A scene's triangles in the world.

use crate::scene::Scene;
use glam::{DVec3, Mat3, Vec3, Vec4};

/// A triangle in the world.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    /// Corners (m).
    pub corners: [DVec3; 3],
    /// Shading normals, unit length.
    pub normals: [Vec3; 3],
    /// Both sets of texture coordinates.
    pub uv: [Vec4; 3],
    /// Vertex colours.
    pub colors: [Vec4; 3],
    /// Index of the scene's material.
    pub material: u32,
}

/// All triangles of a scene at a time (s), instance by instance, in the shaders' world. Corners are
/// rounded to f32, as on the device.
pub fn triangles_of(scene: &Scene, time: f64) -> Vec<Triangle> {
    let origin = scene.origin().extend(0.0);
    let mut list = Vec::with_capacity(scene.triangle_count());
    let meshes = scene.posed_meshes(time as f32);
    for (i, instance) in scene.instances.iter().enumerate() {
        let number = instance.mesh as usize;
        let (Some(mesh), Some(vertices)) = (scene.meshes.get(number), meshes.get(number)) else {
            continue;
        };
        let mut model = scene.instance_transform(i, time as f32);
        model.w_axis -= origin;
        let turn = Mat3::from_mat4(model).inverse().transpose();
        for submesh in &mesh.submeshes {
            let indices = &mesh.indices[submesh.first_index as usize
                ..(submesh.first_index + submesh.index_count) as usize];
            list.extend(indices.as_chunks::<3>().0.iter().map(|t| {
                let v = t.map(|i| vertices[i as usize]);
                Triangle {
                    corners: v.map(|v| model.transform_point3(v.position.into()).as_dvec3()),
                    normals: v.map(|v| (turn * Vec3::from_array(v.normal)).normalize_or_zero()),
                    uv: v.map(|v| Vec4::new(v.uv[0], v.uv[1], v.uv_second[0], v.uv_second[1])),
                    colors: v.map(|v| v.color.into()),
                    material: submesh.material,
                }
            }));
        }
    }
    list
}
