//! The content of a texture as numbers.

use crate::metrics::Linear;
use crate::vulkan::Format;
use crate::vulkan::format::Channels;

/// The texels of one mip and layer of a texture.
#[derive(Clone, Debug)]
pub struct Texels {
    /// Width, height, depth.
    pub extent: [u32; 3],
    /// Format.
    pub format: Format,
    /// Tightly packed.
    pub bytes: Vec<u8>,
}

impl Texels {
    /// Floats, four a texel, missing channels 0 and missing alpha 1. Slices of volumes follow one
    /// another downwards.
    pub fn floats(&self) -> Vec<[f32; 4]> {
        let f = self.format;
        if f.name == "rgba32f" {
            return bytemuck::pod_collect_to_vec(&self.bytes);
        }
        let bytes = f.bytes as usize;
        self.bytes
            .chunks_exact(bytes)
            .map(|t| decode(f.name, f.channels, f.count, t))
            .collect()
    }

    /// Linear RGB; a texture of one channel is grey.
    pub fn linear(&self) -> Linear {
        let grey = self.format.count == 1;
        let rgb = self
            .floats()
            .iter()
            .map(|t| if grey { [t[0]; 3] } else { [t[0], t[1], t[2]] })
            .collect();
        Linear::radiance(self.flat_size(), rgb)
    }

    /// Width and height of a picture of these texels: slices of a volume are put below one another.
    pub fn flat_size(&self) -> (u32, u32) {
        let [width, height, depth] = self.extent;
        (width, height * depth)
    }
}

fn decode(name: &str, channels: Channels, count: u32, t: &[u8]) -> [f32; 4] {
    let mut out = [0.0, 0.0, 0.0, 1.0];
    let word = |i: usize| u32::from_ne_bytes([t[4 * i], t[4 * i + 1], t[4 * i + 2], t[4 * i + 3]]);
    let half = |i: usize| u16::from_ne_bytes([t[2 * i], t[2 * i + 1]]);
    for (i, slot) in out.iter_mut().enumerate().take(count as usize) {
        *slot = match (name, channels) {
            ("r11g11b10f", _) => small_float(word(0), i),
            ("rgb10a2", _) => {
                let bits = if i == 3 { 3.0 } else { 1023.0 };
                ((word(0) >> (10 * i)) & if i == 3 { 3 } else { 1023 }) as f32 / bits
            }
            ("rgba16" | "d16", _) => f32::from(half(i)) / 65535.0,
            ("r16ui", _) => f32::from(half(i)),
            ("rgba8ui" | "r8ui", _) => f32::from(t[i]),
            (_, Channels::Uint) => word(i) as f32,
            (_, Channels::Int) => word(i).cast_signed() as f32,
            (n, _) if n.contains("16f") => half::f16::from_bits(half(i)).to_f32(),
            (n, _) if n.contains('8') => f32::from(t[i]) / 255.0,
            _ => f32::from_bits(word(i)),
        };
    }
    out
}

/// One channel of B10G11R11_UFLOAT (Vulkan specification, "Unsigned 11-Bit Floating-Point
/// Numbers").
fn small_float(word: u32, channel: usize) -> f32 {
    let (bits, mantissa_bits) = match channel {
        0 => (word & 0x7ff, 6),
        1 => ((word >> 11) & 0x7ff, 6),
        _ => (word >> 22, 5),
    };
    let exponent = bits >> mantissa_bits;
    let mantissa = (bits & ((1 << mantissa_bits) - 1)) as f32 / (1u32 << mantissa_bits) as f32;
    match exponent {
        0 => mantissa * 2f32.powi(-14),
        31 if mantissa == 0.0 => f32::INFINITY,
        31 => f32::NAN,
        e => (1.0 + mantissa) * 2f32.powi(e.cast_signed() - 15),
    }
}
