//! Where shaders have their origin, and how many triangles there are.

use glam::Vec3;

use super::{Mesh, Scene};

impl Scene {
    /// Where the world of shaders begins, seen from the scene's: at its own origin, unless the scene lies so far from it that
    /// 32-bit coordinates would be coarse for its size. Then near its middle, in steps that round nothing of what is there.
    pub fn origin(&self) -> Vec3 {
        origin_of(self.bounds())
    }

    /// Triangles over all instances (a mesh placed twice counts twice).
    pub fn triangle_count(&self) -> usize {
        let of_mesh = |i: u32| self.meshes.get(i as usize).map_or(0, Mesh::triangle_count);
        self.instances
            .iter()
            .map(|instance| of_mesh(instance.mesh))
            .sum()
    }

    /// How many of them emit light.
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

/// [`Scene::origin`] of a scene with these bounds.
pub(crate) fn origin_of((low, high): (Vec3, Vec3)) -> Vec3 {
    let (centre, diagonal) = ((low + high) * 0.5, (high - low).length());
    if !(diagonal > 0.0 && centre.length() > 8.0 * diagonal) {
        return Vec3::ZERO;
    }
    let step = diagonal.log2().floor().exp2();
    (centre / step).round() * step
}

impl Mesh {
    /// Triangles of the mesh itself.
    pub fn triangle_count(&self) -> usize {
        self.submeshes
            .iter()
            .map(|submesh| submesh.index_count as usize / 3)
            .sum()
    }
}
