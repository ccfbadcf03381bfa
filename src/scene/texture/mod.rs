//! Textures: requested by materials, decoded in parallel, with mips that suit their use.

mod content;
mod dds;
mod decode;
mod kinds;
mod ktx2;
mod mips;
mod stand_in;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::Vec4;
use indexmap::IndexMap;
use rayon::prelude::*;

use crate::diagnostics::panics::caught;

use super::progress::Progress;
use super::warnings::Warnings;
use super::{SceneError, Texture, TextureFormat};

pub(super) use content::Holes;
pub(crate) use decode::SmallPicture;
pub(super) use decode::{decode_limited, first_level_rgba};
pub(super) use kinds::with_kinds_told;
pub(crate) use kinds::{MAX_TEXTURE_KINDS, SHARED_EDGE, TextureKind, keep_their_size};
pub(super) use mips::{Filter, texture_from_rgba};

/// Largest width and height of an image file.
const MAX_FILE_SIDE: u32 = 16384;
/// Largest memory of a decoded image.
pub(super) const MAX_FILE_BYTES: u64 = 512 << 20;

/// Source of an image's bytes.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum Source {
    File(PathBuf),
    /// Embedded bytes with a name for messages.
    Bytes(String, Arc<Vec<u8>>),
    /// A missing file and the reason.
    Missing(String, String),
}

impl Source {
    pub fn name(&self) -> String {
        match self {
            Source::File(path) => path.display().to_string(),
            Source::Bytes(name, _) | Source::Missing(name, _) => name.clone(),
        }
    }
}

/// How one or two images become a texture.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum Recipe {
    /// sRGB colour; `mask` is an alpha cutoff in 1/255, and the mips preserve its coverage.
    Color { image: Source, mask: Option<u8> },
    /// sRGB colour from one image (white without it) and alpha from another.
    ColorAndMask {
        color: Option<Source>,
        alpha: Source,
        mask: u8,
    },
    /// Tangent-space normals.
    Normal { image: Source },
    /// G = roughness, B = metallic in one image.
    MetallicRoughness { image: Source },
    /// Glossiness in alpha, times a factor in 1/255; metallic is 0.
    Glossiness { image: Source, factor: u8 },
    /// Roughness and metallic from separate grey images (white without them).
    RoughnessAndMetallic {
        roughness: Option<Source>,
        metallic: Option<Source>,
    },
}

impl Recipe {
    /// The files that it reads.
    fn files(&self) -> impl Iterator<Item = &Path> {
        let sources = match self {
            Recipe::Color { image, .. }
            | Recipe::Normal { image }
            | Recipe::MetallicRoughness { image }
            | Recipe::Glossiness { image, .. } => [Some(image), None],
            Recipe::ColorAndMask { color, alpha, .. } => [color.as_ref(), Some(alpha)],
            Recipe::RoughnessAndMetallic {
                roughness,
                metallic,
            } => [roughness.as_ref(), metallic.as_ref()],
        };
        sources
            .into_iter()
            .flatten()
            .filter_map(|source| match source {
                Source::File(path) => Some(path.as_path()),
                _ => None,
            })
    }

    /// The name of its first image.
    fn name(&self) -> String {
        match self {
            Recipe::Color { image, .. }
            | Recipe::Normal { image }
            | Recipe::MetallicRoughness { image }
            | Recipe::Glossiness { image, .. } => image.name(),
            Recipe::ColorAndMask { color, alpha, .. } => color.as_ref().unwrap_or(alpha).name(),
            Recipe::RoughnessAndMetallic {
                roughness,
                metallic,
            } => roughness
                .as_ref()
                .or(metallic.as_ref())
                .map(Source::name)
                .unwrap_or_default(),
        }
    }
}

/// A warning with its kind.
pub(super) struct Notice {
    what: String,
    name: String,
}

impl Notice {
    fn of_size(name: &str, from: (u32, u32), to: (u32, u32)) -> Notice {
        let name = format!("{name}: {}x{} to {}x{}", from.0, from.1, to.0, to.1);
        Notice {
            what: "they are too large and were reduced".into(),
            name,
        }
    }

    fn of_file(file: &str, material: &str, problem: &str, instead: &str) -> Notice {
        Notice {
            what: format!("{problem}; {instead}"),
            name: format!("{file} of material {material}"),
        }
    }
}

/// Requested textures, each recipe once.
#[derive(Debug, Default)]
pub(super) struct Requests {
    /// Recipe and the first material that requests it.
    recipes: IndexMap<Recipe, String>,
}

impl Requests {
    /// The index of the recipe's future texture.
    pub fn ask(&mut self, recipe: Recipe, material: &str) -> u32 {
        let entry = self.recipes.entry(recipe);
        let index = entry.index();
        entry.or_insert_with(|| material.to_owned());
        index as u32
    }

    /// Decodes all textures. Failures become a visible placeholder and a warning.
    pub fn load(self, progress: Progress) -> Result<(Vec<Texture>, Vec<String>), SceneError> {
        self.each(progress, cook)
    }

    /// The linear mean of each texture instead. Failures are white and give a warning.
    pub fn means(self, progress: Progress) -> Result<(Vec<Vec4>, Vec<String>), SceneError> {
        self.each(progress, |recipe, material| {
            let mut warnings = Vec::new();
            let mean = decoded(recipe, &mut warnings).and_then(|texture| {
                mips::mean_color(&texture).map_err(|problem| (texture.name.clone(), problem))
            });
            let mean = mean.unwrap_or_else(|(file, problem)| {
                warnings.push(Notice::of_file(&file, material, &problem, "it is left out"));
                Vec4::ONE
            });
            (mean, warnings)
        })
    }

    /// Processes recipes in parallel and collects one warning per kind of problem.
    fn each<T: Send>(
        self,
        progress: Progress,
        make: impl Fn(&Recipe, &str) -> (T, Vec<Notice>) + Sync,
    ) -> Result<(Vec<T>, Vec<String>), SceneError> {
        let recipes: Vec<(Recipe, String)> = self.recipes.into_iter().collect();
        for file in recipes.iter().flat_map(|r| r.0.files()) {
            progress.reads(file);
        }
        let one = |(recipe, material): &(Recipe, String)| {
            if progress.stopped() {
                Err(SceneError::Cancelled)
            } else {
                Ok(make(recipe, material))
            }
        };
        let made: Vec<(T, Vec<Notice>)> = recipes.par_iter().map(one).collect::<Result<_, _>>()?;
        let (list, notices): (Vec<T>, Vec<Vec<Notice>>) = made.into_iter().unzip();
        let mut warnings = Warnings::default();
        notices
            .into_iter()
            .flatten()
            .for_each(|notice| warnings.add(notice.what, notice.name));
        Ok((list, warnings.lines("textures")))
    }
}

/// The texture, or the file and the error; decoders may panic on damaged files.
fn decoded(recipe: &Recipe, warnings: &mut Vec<Notice>) -> Result<Texture, (String, String)> {
    let mut more = Vec::new();
    let texture = caught(|| decode::cook(recipe, &mut more));
    warnings.append(&mut more);
    texture.unwrap_or_else(|problem| Err((recipe.name(), problem)))
}

fn cook(recipe: &Recipe, material: &str) -> (Texture, Vec<Notice>) {
    let mut warnings = Vec::new();
    match decoded(recipe, &mut warnings) {
        Ok(texture) => (texture, warnings),
        Err((file, problem)) => {
            warnings.push(Notice::of_file(
                &file,
                material,
                &problem,
                "a checkerboard replaces it, or its first colour on meshes without texture coordinates",
            ));
            (stand_in::checkerboard(recipe, &file), warnings)
        }
    }
}
