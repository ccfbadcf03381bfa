//! Decisions that need decoded textures: masks by alpha, and bump maps that hold normals.

use rayon::prelude::*;

use crate::scene::texture::Holes;
use crate::scene::{Material, Texture};

/// A material with pending decisions.
#[derive(Clone, Debug)]
pub(in crate::scene) struct Asked {
    pub material: Material,
    /// Whether the base colour's alpha may be a mask, because the file has no other.
    pub mask_by_alpha: bool,
    /// Whether the normal map may hold heights.
    pub is_bump: bool,
}

/// Format-specific wording of warnings.
pub(in crate::scene) struct Words {
    pub holes: &'static str,
    pub all_clear: &'static str,
    pub heights: &'static str,
}

/// Decides by the content of textures and removes unused ones. `warn` receives a material's index
/// and name, and a sentence.
pub(in crate::scene) fn decide(
    mut materials: Vec<&mut Asked>,
    textures: &mut Vec<Texture>,
    words: &Words,
    mut warn: impl FnMut(usize, &str, &str),
) {
    let (mut colors, mut bumps) = (vec![false; textures.len()], vec![false; textures.len()]);
    for asked in &materials {
        let mark = |marks: &mut [bool], index: Option<u32>, wanted: bool| {
            if let Some(mark) = index.and_then(|i| marks.get_mut(i as usize)) {
                *mark |= wanted;
            }
        };
        let material = &asked.material;
        mark(
            &mut colors,
            material.base_color_texture,
            asked.mask_by_alpha,
        );
        mark(&mut bumps, material.normal_texture, asked.is_bump);
    }
    let holes: Vec<Holes> = textures
        .par_iter()
        .zip(&colors)
        .map(|(t, wanted)| if *wanted { t.holes() } else { Holes::None })
        .collect();
    let normals: Vec<bool> = textures
        .par_iter()
        .zip(&bumps)
        .map(|(t, wanted)| !wanted || t.holds_normals())
        .collect();
    let known = &holes;
    for (number, asked) in materials.iter_mut().enumerate() {
        let material = &mut asked.material;
        let holes = material.base_color_texture;
        let holes = holes.and_then(|i| known.get(i as usize));
        match holes.copied().unwrap_or(Holes::None) {
            Holes::Some if asked.mask_by_alpha => {
                warn(number, &material.name, words.holes);
                material.alpha_cutoff = material.alpha_cutoff.max(0.5);
            }
            Holes::All if asked.mask_by_alpha => warn(number, &material.name, words.all_clear),
            _ => {}
        }
        let has_heights = material
            .normal_texture
            .is_some_and(|i| !normals.get(i as usize).is_some_and(|known| *known));
        if asked.is_bump && has_heights {
            warn(number, &material.name, words.heights);
            material.normal_texture = None;
        }
    }
    let masked = std::mem::take(textures).into_par_iter().zip(holes);
    let masked = masked.map(|(texture, holes)| match holes {
        Holes::Some => texture.masked(),
        _ => texture,
    });
    *textures = masked.collect();
    drop_unused(&mut materials, textures);
}

fn drop_unused(materials: &mut [&mut Asked], textures: &mut Vec<Texture>) {
    let mut used = vec![false; textures.len()];
    for index in materials.iter_mut().flat_map(|asked| indices(asked)) {
        if let Some(used) = used.get_mut(*index as usize) {
            *used = true;
        }
    }
    let mut kept = 0;
    let numbers: Vec<u32> = used
        .iter()
        .map(|used| {
            kept += u32::from(*used);
            kept.saturating_sub(1)
        })
        .collect();
    for index in materials.iter_mut().flat_map(|asked| indices(asked)) {
        *index = numbers.get(*index as usize).copied().unwrap_or_default();
    }
    let mut used = used.into_iter();
    textures.retain(|_| used.next().unwrap_or_default());
}

fn indices(asked: &mut Asked) -> impl Iterator<Item = &mut u32> {
    let material = &mut asked.material;
    let maps = [
        &mut material.base_color_texture,
        &mut material.metallic_roughness_texture,
        &mut material.normal_texture,
        &mut material.emission_texture,
    ];
    maps.into_iter().flatten()
}
