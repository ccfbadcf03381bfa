//! A scene's triangles and rays among them, in 64 bits, so that neither 4 mm nor 200 km lose what matters.

use conelab::scene::Scene;
use glam::{DVec3, Vec3};

/// Where a ray meets a triangle, from its origin in units of its direction (Moeller and Trumbore).
pub fn meets(origin: DVec3, direction: DVec3, [a, b, c]: [DVec3; 3]) -> Option<f64> {
    let (ab, ac) = (b - a, c - a);
    let p = direction.cross(ac);
    let determinant = ab.dot(p);
    let (t, q) = (origin - a, (origin - a).cross(ab));
    let (u, v) = (t.dot(p) / determinant, direction.dot(q) / determinant);
    let distance = ac.dot(q) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0).then_some(distance)
}

/// All triangles in the world.
pub fn world(scene: &Scene) -> Vec<[DVec3; 3]> {
    let mut list = Vec::new();
    for (i, instance) in scene.instances.iter().enumerate() {
        let place = scene.instance_transform(i, 0.0).as_dmat4();
        let mesh = &scene.meshes[instance.mesh as usize];
        let corner = |i: &u32| {
            place.transform_point3(Vec3::from(mesh.vertices[*i as usize].position).as_dvec3())
        };
        list.extend(
            mesh.indices
                .as_chunks::<3>()
                .0
                .iter()
                .map(|t| t.each_ref().map(corner)),
        );
    }
    list
}
