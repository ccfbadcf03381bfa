//! Classification of textures by their texels, for formats without a declared kind.

use rayon::prelude::*;

use super::{Filter, Texture, TextureFormat, first_level_rgba, texture_from_rgba};

/// Maximum texels sampled for the classification.
const SAMPLES: usize = 1 << 16;

/// Texels with an alpha below 0.5.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::scene) enum Holes {
    None,
    Some,
    /// All of them, so that the alpha was unintended.
    All,
}

impl Texture {
    /// Whether the texture holds normals rather than heights: it is coloured, and texels are about
    /// unit length.
    pub(in crate::scene) fn holds_normals(&self) -> bool {
        if matches!(
            self.format,
            TextureFormat::Bc4Unorm | TextureFormat::Bc5Unorm
        ) {
            return self.format == TextureFormat::Bc5Unorm;
        }
        let Ok(rgba) = first_level_rgba(self) else {
            return false;
        };
        let texels = rgba.as_chunks::<4>().0;
        let step = texels.len().div_ceil(SAMPLES).max(1);
        let (mut count, mut grey, mut unit) = (0, 0, 0);
        for &[r, g, b, _] in texels.iter().step_by(step) {
            count += 1;
            grey += usize::from(r.abs_diff(g).max(g.abs_diff(b)) < 12);
            let [x, y, z] = [r, g, b].map(|c| f32::from(c) / 127.5 - 1.0);
            let length = (x * x + y * y + z * z).sqrt();
            unit += usize::from(z > 0.0 && (0.7..1.35).contains(&length));
        }
        // Compression and scaling shorten some normals; a few grey texels may have unit length.
        2 * grey < count && 4 * unit > 3 * count
    }

    /// Whether the alpha has holes.
    pub(in crate::scene) fn holes(&self) -> Holes {
        if matches!(
            self.format,
            TextureFormat::Bc4Unorm | TextureFormat::Bc5Unorm
        ) {
            return Holes::None;
        }
        let Ok(rgba) = first_level_rgba(self) else {
            return Holes::None;
        };
        let texels = rgba.as_chunks::<4>().0;
        match texels
            .par_iter()
            .with_min_len(1 << 14)
            .filter(|texel| texel[3] < 128)
            .count()
        {
            0 => Holes::None,
            all if all == texels.len() => Holes::All,
            _ => Holes::Some,
        }
    }

    /// With mips that preserve alpha coverage at 0.5. Stored mips of compressed textures are kept.
    pub(in crate::scene) fn masked(self) -> Texture {
        match self.format {
            TextureFormat::Rgba8Srgb | TextureFormat::Rgba8Unorm => {
                let Texture {
                    name,
                    width,
                    height,
                    format,
                    mips,
                } = self;
                let level = mips.into_iter().next().unwrap_or_default();
                texture_from_rgba(&name, width, height, level, format, Filter::Masked(0.5))
            }
            _ => self,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(texel: impl Fn(u32) -> [u8; 4]) -> Texture {
        texture_from_rgba(
            "a",
            16,
            16,
            (0..256).flat_map(texel).collect(),
            TextureFormat::Rgba8Unorm,
            Filter::Plain,
        )
    }

    fn rough(i: u32) -> [u8; 4] {
        let (x, y) = ((i as f32).sin() * 0.6, (i as f32 * 0.7).cos() * 0.6);
        let [x, y, z] =
            [x, y, (1.0 - x * x - y * y).sqrt()].map(|c| (c * 127.5 + 127.5).round() as u8);
        [x, y, z, 255]
    }

    #[test]
    fn normals_are_known_by_their_length_and_colour() {
        type Texel = fn(u32) -> [u8; 4];
        let cases: [(&str, Texel, bool); 9] = [
            ("flat", |_| [128, 128, 255, 255], true),
            ("rough", rough, true),
            ("leans by 45 degrees", |_| [128, 218, 218, 255], true),
            (
                "blue is constant",
                |i| [(100 + i % 56) as u8, (90 + i % 64) as u8, 255, 255],
                true,
            ),
            ("black", |_| [0, 0, 0, 255], false),
            ("white", |_| [255; 4], false),
            ("heights", |i| [i as u8, i as u8, i as u8, 255], false),
            ("grey of unit length", |_| [201, 201, 201, 255], false),
            ("bricks", |i| [150 + (i % 40) as u8, 70, 50, 255], false),
        ];
        for (name, texel, expected) in cases {
            assert_eq!(picture(texel).holds_normals(), expected, "{name}");
        }
    }

    #[test]
    fn holes_are_texels_below_half() {
        assert_eq!(
            picture(|i| [9, 9, 9, if i > 3 { 255 } else { 127 }]).holes(),
            Holes::Some
        );
        assert_eq!(picture(|_| [9, 9, 9, 128]).holes(), Holes::None);
        assert_eq!(picture(|_| [9, 9, 9, 0]).holes(), Holes::All);
    }
}
