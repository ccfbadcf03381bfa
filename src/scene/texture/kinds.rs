//! Kinds of textures: devices have few arrays, and the layers of an array share a kind.

use std::collections::BTreeMap;

use crate::scene::{Scene, Texture, TextureFormat};

/// Maximum number of kinds that keep their size.
pub const MAX_TEXTURE_KINDS: usize = 12;

/// Side of the shared arrays for textures of rare kinds (texels).
pub const SHARED_EDGE: u32 = 512;

/// Width, height, levels and format shared by the layers of an array.
pub type TextureKind = (u32, u32, u32, TextureFormat);

impl Texture {
    pub(crate) fn kind(&self) -> TextureKind {
        (
            self.width,
            self.height,
            u32::try_from(self.mips.len()).unwrap_or(1),
            self.format,
        )
    }
}

/// Whether each texture keeps its size. If there are too many kinds, those with the most texels do;
/// two arrays, for colours and for data, take the rest.
pub fn keep_their_size(kinds: &[TextureKind]) -> Vec<bool> {
    let mut texels: BTreeMap<TextureKind, u64> = BTreeMap::new();
    for kind in kinds {
        *texels.entry(*kind).or_default() += u64::from(kind.0) * u64::from(kind.1);
    }
    if texels.len() <= MAX_TEXTURE_KINDS {
        return vec![true; kinds.len()];
    }
    let mut by_size: Vec<(u64, TextureKind)> =
        texels.into_iter().map(|(kind, n)| (n, kind)).collect();
    by_size.sort_unstable_by(|a, b| b.cmp(a));
    let kept: Vec<TextureKind> = by_size
        .iter()
        .take(MAX_TEXTURE_KINDS - 2)
        .map(|(_, kind)| *kind)
        .collect();
    kinds.iter().map(|kind| kept.contains(kind)).collect()
}

/// Adds a warning about textures that are resized.
pub(in crate::scene) fn with_kinds_told(mut scene: Scene) -> Scene {
    let kinds: Vec<TextureKind> = scene.textures.iter().map(Texture::kind).collect();
    let keep = keep_their_size(&kinds);
    let names: Vec<&str> = scene
        .textures
        .iter()
        .zip(&keep)
        .filter(|(_, keep)| !**keep)
        .map(|(t, _)| t.name.as_str())
        .collect();
    if let Some(first) = names.first() {
        let count = names.len();
        scene.warnings.push(format!(
            "{}: {count} textures of rare sizes are scaled to {SHARED_EDGE} x {SHARED_EDGE}, because there are more than \
             {MAX_TEXTURE_KINDS} sizes and formats (the first is '{first}'). Give textures common sizes",
            scene.name
        ));
    }
    scene
}
