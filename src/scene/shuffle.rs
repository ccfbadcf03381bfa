//! Triangles in random order, to test that a result does not depend on the order.

use super::Scene;

impl Scene {
    /// A copy with shuffled triangles within each submesh; the vertices of a triangle keep their
    /// order.
    pub fn shuffled(&self, seed: u64) -> Scene {
        let mut scene = self.clone();
        let mut state = seed;
        for mesh in &mut scene.meshes {
            for submesh in &mesh.submeshes {
                let range = submesh.first_index as usize
                    ..(submesh.first_index + submesh.index_count) as usize;
                let triangles = mesh.indices[range].as_chunks_mut::<3>().0;
                // Fisher-Yates shuffle.
                for i in (1..triangles.len()).rev() {
                    triangles.swap(i, (splitmix(&mut state) % (i as u64 + 1)) as usize);
                }
            }
        }
        scene
    }
}

/// Next number of the SplitMix64 sequence (Steele et al. 2014), identical on every machine.
pub(crate) fn splitmix(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}
