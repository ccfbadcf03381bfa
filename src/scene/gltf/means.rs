//! Textures that materials reduce to their mean: a material has one specular colour and one
//! transmission.

use std::collections::HashMap;

use ::gltf::{Document, Material, texture};
use glam::Vec4;

use crate::scene::SceneError;
use crate::scene::progress::Progress;
use crate::scene::texture::{Recipe, Requests, Source};
use crate::scene::warnings::Warnings;

/// Linear means by image and by whether it holds colours.
#[derive(Debug, Default)]
pub(super) struct Means(HashMap<(usize, bool), Vec4>);

impl Means {
    /// Decodes the required images. Failures count as white and give a warning.
    pub fn load(
        document: &Document,
        images: &[Source],
        warnings: &mut Warnings,
        progress: Progress,
    ) -> Result<Means, SceneError> {
        let mut requests = Requests::default();
        let mut indices = HashMap::new();
        for material in document.materials() {
            let name = name(&material);
            for (info, color) in asked(&material) {
                let i = info.texture().source().index();
                let image = images[i].clone();
                let recipe = if color {
                    Recipe::Color { image, mask: None }
                } else {
                    Recipe::MetallicRoughness { image }
                };
                indices.insert((i, color), requests.ask(recipe, &name));
            }
        }
        let (means, more) = requests.means(progress)?;
        more.into_iter().for_each(|line| warnings.add(line, ""));
        Ok(Means(
            indices
                .into_iter()
                .map(|(key, i)| (key, means[i as usize]))
                .collect(),
        ))
    }

    /// Mean of a colour texture with linear alpha; white without a texture.
    pub fn color(&self, info: Option<&texture::Info>) -> Vec4 {
        self.of(info, true)
    }

    pub fn data(&self, info: Option<&texture::Info>) -> Vec4 {
        self.of(info, false)
    }

    fn of(&self, info: Option<&texture::Info>, color: bool) -> Vec4 {
        let key = info.map(|info| (info.texture().source().index(), color));
        key.and_then(|key| self.0.get(&key))
            .copied()
            .unwrap_or(Vec4::ONE)
    }
}

/// Required textures, and whether they hold colours.
fn asked<'a>(material: &Material<'a>) -> Vec<(texture::Info<'a>, bool)> {
    let specular = material.specular();
    let colors = [
        specular.as_ref().and_then(|s| s.specular_texture()),
        specular.as_ref().and_then(|s| s.specular_color_texture()),
        material
            .pbr_specular_glossiness()
            .and_then(|s| s.specular_glossiness_texture()),
    ];
    let data = material
        .transmission()
        .and_then(|t| t.transmission_texture());
    colors
        .into_iter()
        .flatten()
        .map(|info| (info, true))
        .chain(data.map(|info| (info, false)))
        .collect()
}

/// The name of a material, or a number.
pub(super) fn name(material: &Material) -> String {
    let index = material.index().unwrap_or_default();
    material
        .name()
        .map_or_else(|| format!("material {index}"), str::to_owned)
}
