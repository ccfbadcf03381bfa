//! A hash of a scene's content.

use crate::files::hex;
use crate::scene::{Lookups, Material, Scene, Vertex};
use sha2::{Digest, Sha256};
use std::mem::offset_of;

/// SHA-256 over the visible content of a scene: geometry, materials, textures, placement, motion,
/// lights, sky. Names, cameras and warnings are ignored.
pub fn scene_hash(scene: &Scene) -> String {
    let mut hash = Hash(Sha256::new());
    hash.count(scene.meshes.len());
    for mesh in &scene.meshes {
        let mut bytes = Vec::with_capacity(mesh.vertices.len() * PLAIN);
        mesh.vertices
            .iter()
            .for_each(|v| bytes.extend_from_slice(&bytemuck::bytes_of(v)[..PLAIN]));
        hash.bytes(&bytes);
        hash.words(&mesh.indices);
        let parts: Vec<u32> = mesh
            .submeshes
            .iter()
            .flat_map(|p| [p.first_index, p.index_count, p.material])
            .collect();
        hash.words(&parts);
    }
    hash.count(scene.materials.len());
    for m in &scene.materials {
        hash.floats(&m.base_color.to_array());
        hash.floats(&m.emission.to_array());
        hash.floats(&[m.metallic, m.roughness, m.alpha_cutoff, m.normal_scale]);
        hash.words(&[u32::from(m.two_sided)]);
        let textures = [
            m.base_color_texture,
            m.metallic_roughness_texture,
            m.normal_texture,
            m.emission_texture,
        ];
        hash.words(&textures.map(|t| t.unwrap_or(u32::MAX)));
    }
    hash.count(scene.textures.len());
    for texture in &scene.textures {
        hash.words(&[texture.width, texture.height]);
        hash.bytes(format!("{:?}", texture.format).as_bytes());
        hash.count(texture.mips.len());
        texture.mips.iter().for_each(|mip| hash.bytes(mip));
    }
    hash.count(scene.instances.len());
    for instance in &scene.instances {
        hash.words(&[instance.mesh]);
        hash.floats(&instance.transform.to_cols_array());
        // Keeps the hash of static scenes stable: an older format had motion here.
        hash.words(&[0]);
        hash.count(0);
    }
    hash.count(scene.lights.len());
    for light in &scene.lights {
        let kind = u32::try_from(light.kind.index()).unwrap_or(u32::MAX);
        hash.words(&[kind, u32::from(light.shadow)]);
        hash.floats(&light.kind.numbers());
        [light.color, light.position, light.direction]
            .iter()
            .for_each(|v| hash.floats(&v.to_array()));
        if let Some(up) = light.fields().up() {
            hash.floats(&up.to_array());
        }
    }
    // Only values that differ from the default, so that hashes of older scenes stay valid.
    for (i, _) in (0u32..).zip(&scene.lights).filter(|(_, l)| !l.on) {
        hash.words(&[i]);
    }
    let plain = Material::default().dielectric();
    for (i, m) in (0u32..)
        .zip(&scene.materials)
        .filter(|(_, m)| m.dielectric() != plain)
    {
        hash.words(&[i]);
        hash.floats(&m.dielectric().to_array());
    }
    // Only values that differ from the default, as above.
    for (i, mesh) in (0u32..).zip(&scene.meshes) {
        if mesh
            .vertices
            .iter()
            .any(|v| (v.color, v.uv_second) != (Vertex::default().color, [0.0; 2]))
        {
            hash.words(&[i]);
            let more = |v: &Vertex| [v.uv_second.as_slice(), &v.color].concat();
            hash.floats(&mesh.vertices.iter().flat_map(more).collect::<Vec<f32>>());
        }
    }
    for (i, m) in (0u32..).zip(&scene.materials) {
        if m.lookups != Lookups::default() || m.tinted_emission {
            hash.words(&[i, u32::from(m.tinted_emission)]);
            hash.bytes(format!("{:?}", m.lookups).as_bytes());
        }
    }
    hash_motion(scene, &mut hash);
    hash.floats(&scene.sky.to_array());
    // Scenes without an environment map keep their older hash.
    if let Some(environment) = &scene.environment {
        let (width, height) = environment.picture.size();
        hash.words(&[width, height]);
        hash.bytes(bytemuck::cast_slice(environment.picture.texels()));
        hash.floats(&[environment.rotation]);
    }
    hex(&hash.0.finalize())
}

/// Hashes nothing for static scenes.
fn hash_motion(scene: &Scene, hash: &mut Hash) {
    for (i, instance) in (0u32..).zip(&scene.instances) {
        if let Some(mover) = instance.mover {
            hash.words(&[i, mover]);
        }
    }
    for mover in &scene.movers {
        hash.words(&[mover.parent.unwrap_or(u32::MAX)]);
        hash.floats(&mover.placed.to_cols_array());
        hash.bytes(format!("{:?}", mover.track).as_bytes());
    }
    for d in &scene.deformers {
        hash.words(&[d.mesh]);
        hash.bytes(&d.flat.iter().map(|f| u8::from(*f)).collect::<Vec<u8>>());
        for v in &d.rest {
            hash.floats(&[v.position.as_slice(), &v.normal, &v.tangent].concat());
        }
        let vectors = d
            .morphs
            .iter()
            .flat_map(|m| [&m.positions, &m.normals, &m.tangents])
            .flatten();
        hash.floats(&vectors.flat_map(|v| v.to_array()).collect::<Vec<f32>>());
        hash.bytes(format!("{:?} {:?} {:?}", d.weights, d.period, d.joints).as_bytes());
        hash.words(
            &d.influences
                .iter()
                .flat_map(|i| [i.joint, i.weight.to_bits()])
                .collect::<Vec<u32>>(),
        );
        hash.words(
            &d.influenced
                .iter()
                .flat_map(|r| [r.start, r.end])
                .collect::<Vec<u32>>(),
        );
    }
}

/// Size of a vertex up to the second coordinate set and colour, which most scenes do not have
/// (bytes).
const PLAIN: usize = offset_of!(Vertex, uv_second);

/// Every list is preceded by its length, so that different scenes cannot give the same bytes.
struct Hash(Sha256);

impl Hash {
    fn count(&mut self, n: usize) {
        self.0.update((n as u64).to_le_bytes());
    }

    fn bytes(&mut self, bytes: &[u8]) {
        self.count(bytes.len());
        self.0.update(bytes);
    }

    fn words(&mut self, words: &[u32]) {
        self.bytes(bytemuck::cast_slice(words));
    }

    fn floats(&mut self, floats: &[f32]) {
        self.bytes(bytemuck::cast_slice(floats));
    }
}
