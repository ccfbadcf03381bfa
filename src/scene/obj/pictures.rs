//! What materials become once their pictures are known: masks by alpha, and bump maps that hold normals.

use rayon::prelude::*;

use super::library::Library;
use super::lines::shown;
use super::material::Read;
use crate::scene::Texture;
use crate::scene::texture::Holes;

/// A material with the number of its library.
pub(super) type Owned = (usize, Read);

/// Decides by the content of pictures, and takes out those that no material uses any more.
pub(super) fn decide(materials: &mut [Owned], textures: &mut Vec<Texture>, libraries: &mut [Library]) {
    let (mut colors, mut bumps) = (vec![false; textures.len()], vec![false; textures.len()]);
    for (_, read) in materials.iter() {
        let mark = |marks: &mut [bool], index: Option<u32>, wanted: bool| {
            if let Some(mark) = index.and_then(|i| marks.get_mut(i as usize)) {
                *mark |= wanted;
            }
        };
        mark(&mut colors, read.material.base_color_texture, read.mask_by_alpha);
        mark(&mut bumps, read.material.normal_texture, read.is_bump);
    }
    let holes: Vec<Holes> =
        textures.par_iter().zip(&colors).map(|(t, wanted)| if *wanted { t.holes() } else { Holes::None }).collect();
    let normals: Vec<bool> = textures.par_iter().zip(&bumps).map(|(t, wanted)| !wanted || t.holds_normals()).collect();
    for (library, read) in materials.iter_mut() {
        let material = &mut read.material;
        let Some(Library { warnings, .. }) = libraries.get_mut(*library) else { continue };
        let mut warn = |what: &str| warnings.add(what, shown(&material.name));
        let of = |index: Option<u32>| index.and_then(|i| holes.get(i as usize)).copied().unwrap_or(Holes::None);
        match of(material.base_color_texture) {
            Holes::Some if read.mask_by_alpha => {
                warn("the picture of map_Kd has holes in its alpha and there is no map_d: it is a mask at 0.5");
                material.alpha_cutoff = material.alpha_cutoff.max(0.5);
            }
            Holes::All if read.mask_by_alpha => {
                warn("the alpha of map_Kd is below 0.5 everywhere: it is left out");
            }
            _ => {}
        }
        let has_heights = material.normal_texture.is_some_and(|i| !normals.get(i as usize).is_some_and(|known| *known));
        if read.is_bump && has_heights {
            warn("bump maps that hold heights are left out. Convert them to normal maps, and write 'norm FILE'");
            material.normal_texture = None;
        }
    }
    let masked = std::mem::take(textures).into_par_iter().zip(holes);
    *textures = masked.map(|(texture, holes)| if holes == Holes::Some { texture.masked() } else { texture }).collect();
    drop_unused(materials, textures);
}

fn drop_unused(materials: &mut [Owned], textures: &mut Vec<Texture>) {
    let mut used = vec![false; textures.len()];
    for index in materials.iter_mut().flat_map(|(_, read)| indices(read)) {
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
    for index in materials.iter_mut().flat_map(|(_, read)| indices(read)) {
        *index = numbers.get(*index as usize).copied().unwrap_or_default();
    }
    let mut used = used.into_iter();
    textures.retain(|_| used.next().unwrap_or_default());
}

fn indices(read: &mut Read) -> impl Iterator<Item = &mut u32> {
    let material = &mut read.material;
    let maps = [
        &mut material.base_color_texture,
        &mut material.metallic_roughness_texture,
        &mut material.normal_texture,
        &mut material.emission_texture,
    ];
    maps.into_iter().flatten()
}
