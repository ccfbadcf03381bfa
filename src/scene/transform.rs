//! Origin of the shaders' world, and triangle counts.

use glam::Vec3;

use super::{Mesh, Scene};

impl Scene {
    /// Origin of the shaders' world in scene coordinates. It is 0 unless the scene is too far away
    /// for accurate 32-bit coordinates. Then it is near the middle of the scene, on a grid that
    /// keeps the coordinates exact.
    pub fn origin(&self) -> Vec3 {
        origin_of(self.bounds())
    }

    /// Triangles of all instances; a mesh placed twice counts twice.
    pub fn triangle_count(&self) -> usize {
        let of_mesh = |i: u32| self.meshes.get(i as usize).map_or(0, Mesh::triangle_count);
        self.instances
            .iter()
            .map(|instance| of_mesh(instance.mesh))
            .sum()
    }

    /// Emissive triangles of all instances.
    pub(crate) fn emitting_triangle_count(&self) -> usize {
        let emits = |m: u32| {
            self.materials
                .get(m as usize)
                .is_some_and(|m| m.emission != Vec3::ZERO)
        };
        let submeshes = |i: u32| {
            self.meshes
                .get(i as usize)
                .into_iter()
                .flat_map(|mesh| &mesh.submeshes)
        };
        let of_mesh = |i: u32| {
            submeshes(i)
                .filter(|s| emits(s.material))
                .map(|s| s.index_count as usize / 3)
                .sum::<usize>()
        };
        self.instances
            .iter()
            .map(|instance| of_mesh(instance.mesh))
            .sum()
    }
}

/// [`Scene::origin`] for given bounds.
pub(crate) fn origin_of((low, high): (Vec3, Vec3)) -> Vec3 {
    let (centre, diagonal) = ((low + high) * 0.5, (high - low).length());
    if !(diagonal > 0.0 && centre.length() > 8.0 * diagonal) {
        return Vec3::ZERO;
    }
    let step = diagonal.log2().floor().exp2();
    (centre / step).round() * step
}

impl Mesh {
    /// Triangles of the mesh.
    pub fn triangle_count(&self) -> usize {
        self.submeshes
            .iter()
            .map(|submesh| submesh.index_count as usize / 3)
            .sum()
    }
}
