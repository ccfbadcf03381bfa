//! The buffer `attributes` (`shaders/common/scene.glsl`): for each vertex its normal and u, tangent
//! and sign, v, packed colour, and second set of texture coordinates.

use crate::scene::{Lookups, Scene, Vertex};
use glam::{Vec3, Vec4};
use std::collections::HashSet;

/// Floats of a vertex.
pub(super) type Attributes = [f32; 12];

/// The attributes of a vertex except its position.
pub(super) fn of(v: &Vertex) -> Attributes {
    let ([nx, ny, nz], [tx, ty, tz, tw], [u, w]) = (v.normal, v.tangent, v.uv);
    let ([u2, w2], color) = (v.uv_second, f32::from_bits(pack_color(v.color)));
    [nx, ny, nz, u, tx, ty, tz, tw, w, color, u2, w2]
}

/// Both sets of texture coordinates.
pub(super) fn uv_of(a: &Attributes) -> Vec4 {
    Vec4::new(a[3], a[8], a[10], a[11])
}

/// Linear colour as shaders unpack it.
pub(super) fn color_of(a: &Attributes) -> Vec4 {
    let [r, g, b, alpha] = a[9]
        .to_bits()
        .to_le_bytes()
        .map(|byte| f32::from(byte) / 255.0);
    let root = Vec3::new(r, g, b);
    (root * root).extend(alpha)
}

/// One byte per channel. Red, green and blue are stored as square roots, because linear bytes are
/// too coarse near black.
pub(super) fn pack_color([r, g, b, alpha]: [f32; 4]) -> u32 {
    u32::from_le_bytes([r.sqrt(), g.sqrt(), b.sqrt(), alpha].map(|c| (c * 255.0).round() as u8))
}

/// Materials of triangles with coloured vertices.
pub(super) fn colored_materials(scene: &Scene) -> HashSet<u32> {
    let mut found = HashSet::new();
    for mesh in scene.meshes.iter().filter(|mesh| mesh.has_colors()) {
        for submesh in &mesh.submeshes {
            let range =
                submesh.first_index as usize..(submesh.first_index + submesh.index_count) as usize;
            let mut vertices = mesh.indices[range]
                .iter()
                .filter_map(|i| mesh.vertices.get(*i as usize));
            if vertices.any(|v| v.color != [1.0; 4]) {
                found.insert(submesh.material);
            }
        }
    }
    found
}

/// Specialisation constants of `common/scene.glsl`: whether there are colours, and whether any
/// lookup needs more than the sampler and the first set. Software devices execute code behind
/// branches that nothing takes.
pub(super) fn constants(scene: &Scene, colored: &HashSet<u32>) -> Vec<(u32, u32)> {
    const COLORS: u32 = 2040;
    const LOOKUPS: u32 = 2041;
    let lookups = scene
        .materials
        .iter()
        .any(|m| m.lookups != Lookups::default());
    vec![
        (COLORS, u32::from(!colored.is_empty())),
        (LOOKUPS, u32::from(lookups)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_survive_packing() {
        for i in 0..=1000u16 {
            let c = f32::from(i) / 1000.0;
            let mut attributes = [0.0; 12];
            attributes[9] = f32::from_bits(pack_color([c, 1.0, 0.0, c]));
            let found = color_of(&attributes);
            assert!(
                (found.x - c).abs() <= c.sqrt() / 255.0 + 4e-6 && (found.w - c).abs() < 0.002,
                "{c}: {found}"
            );
            assert_eq!((found.y, found.z), (1.0, 0.0));
        }
    }
}
