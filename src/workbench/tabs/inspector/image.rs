//! Texels as a picture, and the values behind it.

use crate::lab::Texels;
use crate::vulkan::Format;
use crate::vulkan::format::Channels;
use crate::workbench::desired::request::InspectTarget;
use rayon::prelude::*;

/// What of a texel is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Channel {
    /// Three channels as colour.
    #[default]
    Rgb,
    /// One channel as grey: 0 R to 3 A.
    One(usize),
    /// Luminance of linear sRGB primaries (Rec. ITU-R BT.709) as grey.
    Luminance,
}

/// How values become grey levels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tone {
    /// Channels that are shown.
    pub channel: Channel,
    /// Value that is black.
    pub low: f32,
    /// Value that is white, before the exposure.
    pub high: f32,
    /// Brightness times 2^stops, after the range.
    pub stops: f32,
    /// No transfer function; else that of sRGB, for linear values.
    pub raw: bool,
    /// Texels that are marked.
    pub marks: Marks,
    /// Whether colours, premultiplied by alpha, lie over a checkerboard.
    pub checkerboard: bool,
}

/// Texels that are marked by a colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Marks {
    /// A channel is below zero.
    pub negative: bool,
    /// A channel is above white.
    pub clipped: bool,
}

impl Default for Tone {
    fn default() -> Self {
        Tone {
            channel: Channel::Rgb,
            low: 0.0,
            high: 1.0,
            stops: 0.0,
            raw: false,
            marks: Marks::default(),
            checkerboard: false,
        }
    }
}

/// Texels that were read.
pub struct Decoded {
    /// The texture, mip, layer and slice that the texels are from.
    pub target: InspectTarget,
    /// Width and height.
    pub size: [u32; 2],
    /// Format.
    pub format: Format,
    /// As floats; missing channels 0, missing alpha 1.
    pub floats: Vec<[f32; 4]>,
    /// As they were.
    pub bytes: Vec<u8>,
}

/// Texels that are not a number.
const NAN: [u8; 4] = [255, 0, 255, 255];
/// Infinite texels.
const INFINITE: [u8; 4] = [0, 255, 255, 255];
/// Texels below zero, where these are marked.
pub const NEGATIVE: [u8; 4] = [40, 90, 255, 255];
/// Texels above white, where these are marked.
pub const CLIPPED: [u8; 4] = [255, 60, 40, 255];
/// Grey levels of the checkerboard, 0 to 1.
const SQUARES: [f32; 2] = [0.32, 0.46];
/// Edge of a square, texels.
const SQUARE: usize = 4;

impl Decoded {
    /// Decodes.
    pub fn new(target: InspectTarget, texels: Texels) -> Decoded {
        let floats = texels.floats();
        let [width, height, depth] = texels.extent;
        Decoded {
            target,
            size: [width, height * depth],
            format: texels.format,
            floats,
            bytes: texels.bytes,
        }
    }

    /// RGBA, 8 bits each; NaN is magenta, infinity cyan.
    pub fn image(&self, tone: &Tone) -> Vec<u8> {
        let mut out = vec![0; self.floats.len() * 4];
        let width = self.size[0].max(1) as usize;
        out.par_chunks_mut(4 * width)
            .zip(self.floats.par_chunks(width))
            .enumerate()
            .for_each(|(y, (out, floats))| {
                for (x, (out, v)) in out.chunks_exact_mut(4).zip(floats).enumerate() {
                    let square = SQUARES[(x / SQUARE + y / SQUARE) % 2];
                    out.copy_from_slice(&pixel(v, tone, self.format.count, square));
                }
            });
        out
    }

    /// Texels with a shown channel below zero, and above white.
    pub fn marked(&self, tone: &Tone) -> [usize; 2] {
        let white = tone.low + (tone.high - tone.low) * (-tone.stops).exp2();
        let count = |v: &[f32; 4]| {
            let shown = chosen(v, tone.channel, self.format.count);
            let clipped = match tone.low <= tone.high {
                true => shown.iter().any(|x| *x > white),
                false => shown.iter().any(|x| *x < white),
            };
            [
                usize::from(shown.iter().any(|x| *x < 0.0)),
                usize::from(clipped),
            ]
        };
        let sum = |a: [usize; 2], b: [usize; 2]| [a[0] + b[0], a[1] + b[1]];
        self.floats.par_iter().map(count).reduce(|| [0, 0], sum)
    }

    /// The channels at a texel, as exactly as they are stored.
    pub fn values(&self, x: u32, y: u32) -> Vec<String> {
        if x >= self.size[0] || y >= self.size[1] {
            return Vec::new();
        }
        let index = y as usize * self.size[0] as usize + x as usize;
        let (f, count) = (self.format, self.format.count as usize);
        let bytes = f.bytes as usize;
        let (Some(raw), Some(floats)) = (
            self.bytes.get(index * bytes..(index + 1) * bytes),
            self.floats.get(index),
        ) else {
            return Vec::new();
        };
        let whole = |i: usize| -> u32 {
            let width = bytes / count.max(1);
            let part = &raw[i * width..(i + 1) * width];
            part.iter().rev().fold(0, |v, b| v << 8 | u32::from(*b))
        };
        (0..count.min(4))
            .map(|i| match f.channels {
                Channels::Uint => whole(i).to_string(),
                Channels::Int => whole(i).cast_signed().to_string(),
                _ if f.name.starts_with("rgba8")
                    || matches!(f.name, "r8" | "rg8" | "rgba16" | "d16") =>
                {
                    format!("{} ({})", floats[i], whole(i))
                }
                _ => floats[i].to_string(),
            })
            .collect()
    }
}

/// The texels of a slice in the orientation of the world: y goes up. Seen along x, z goes to the
/// right.
pub fn upright(texels: Texels, axis: usize) -> Texels {
    let [width, height, _] = texels.extent.map(|n| n as usize);
    let size = texels.format.bytes as usize;
    let (out_width, out_height) = if axis == 0 {
        (height, width)
    } else {
        (width, height)
    };
    if axis == 1 || texels.bytes.len() != width * height * size {
        return texels;
    }
    let mut bytes = Vec::with_capacity(texels.bytes.len());
    for row in 0..out_height {
        let y = out_height - 1 - row;
        for column in 0..out_width {
            let index = if axis == 0 {
                column * width + y
            } else {
                y * width + column
            };
            bytes.extend_from_slice(&texels.bytes[index * size..(index + 1) * size]);
        }
    }
    Texels {
        extent: [out_width as u32, out_height as u32, 1],
        bytes,
        ..texels
    }
}

/// Position in the texture of a texel of the picture, which is `height` texels high: two numbers,
/// three for a volume.
pub fn texel(target: &InspectTarget, volume: bool, height: u32, x: u32, y: u32) -> Vec<u32> {
    let up = height.saturating_sub(y + 1);
    match (volume, target.axis) {
        (false, _) => vec![x, y],
        (true, 0) => vec![target.slice, up, x],
        (true, 1) => vec![x, target.slice, y],
        (true, _) => vec![x, up, target.slice],
    }
}

/// The channels of a texel that are shown, grey three times.
fn chosen(v: &[f32; 4], channel: Channel, count: u32) -> [f32; 3] {
    match channel {
        Channel::Rgb if count == 1 => [v[0]; 3],
        Channel::Rgb => [v[0], v[1], v[2]],
        Channel::One(i) => [v[i.min(3)]; 3],
        Channel::Luminance => [0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2]; 3],
    }
}

/// A texel as RGBA. `square`: grey of the checkerboard there.
fn pixel(v: &[f32; 4], tone: &Tone, count: u32, square: f32) -> [u8; 4] {
    let shown = chosen(v, tone.channel, count);
    if shown.iter().any(|x| x.is_nan()) {
        return NAN;
    }
    if shown.iter().any(|x| x.is_infinite()) {
        return INFINITE;
    }
    let range = tone.high - tone.low;
    // A range of nothing is a threshold.
    let scale = if range == 0.0 {
        f32::MAX
    } else {
        tone.stops.exp2() / range
    };
    if tone.marks.negative && shown.iter().any(|x| *x < 0.0) {
        return NEGATIVE;
    }
    if tone.marks.clipped && shown.iter().any(|x| (x - tone.low) * scale > 1.0) {
        return CLIPPED;
    }
    let behind = match tone.checkerboard && count == 4 && tone.channel == Channel::Rgb {
        true => square * (1.0 - v[3].clamp(0.0, 1.0)),
        false => 0.0,
    };
    let level = |x: f32| {
        let x = ((x - tone.low) * scale).clamp(0.0, 1.0);
        let x = if tone.raw { x } else { encode(x) };
        ((x + behind).min(1.0) * 255.0 + 0.5) as u8
    };
    [level(shown[0]), level(shown[1]), level(shown[2]), 255]
}

/// The transfer function of sRGB (IEC 61966-2-1).
fn encode(x: f32) -> f32 {
    if x <= 0.003_130_8 {
        12.92 * x
    } else {
        1.055 * x.powf(1.0 / 2.4) - 0.055
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub fn decoded(name: &str, size: [u32; 2], bytes: Vec<u8>) -> Decoded {
        let target = InspectTarget {
            side: 0,
            texture: "t".into(),
            mip: 0,
            layer: 0,
            axis: 2,
            slice: 0,
        };
        let format = Format::named(name).unwrap();
        Decoded::new(
            target,
            Texels {
                extent: [size[0], size[1], 1],
                format,
                bytes,
            },
        )
    }

    pub fn floats(list: &[[f32; 4]]) -> Decoded {
        let bytes = list
            .iter()
            .flatten()
            .flat_map(|v| v.to_ne_bytes())
            .collect();
        decoded("rgba32f", [list.len() as u32, 1], bytes)
    }

    fn tone(channel: Channel, low: f32, high: f32, stops: f32) -> Tone {
        Tone {
            channel,
            low,
            high,
            stops,
            raw: true,
            ..Tone::default()
        }
    }

    #[test]
    fn marks_and_the_checkerboard() {
        let d = floats(&[
            [-0.1, 0.5, 0.5, 1.0],
            [0.5, 1.1, 0.5, 1.0],
            [0.0, 0.0, 0.0, 0.0],
            [0.5, 0.5, 0.5, 1.0],
            [0.0, 0.0, 0.0, 0.0],
        ]);
        let marks = Marks {
            negative: true,
            clipped: true,
        };
        let shown = Tone {
            marks,
            checkerboard: true,
            ..tone(Channel::Rgb, 0.0, 1.0, 0.0)
        };
        let grey = |square: f32| (square * 255.0 + 0.5) as u8;
        let [dark, bright] = SQUARES.map(|s| [grey(s), grey(s), grey(s), 255]);
        let expected = [NEGATIVE, CLIPPED, dark, [128, 128, 128, 255], bright].concat();
        assert_eq!(d.image(&shown), expected);
        // Alpha alone, and opaque formats, have no checkerboard.
        let alpha = Tone {
            channel: Channel::One(3),
            ..shown
        };
        assert_eq!(d.image(&alpha)[8..12], [0, 0, 0, 255]);
    }

    #[test]
    fn what_is_no_number_is_seen() {
        let d = floats(&[
            [f32::NAN, 0.0, 0.0, 1.0],
            [0.0, f32::NEG_INFINITY, 0.0, 1.0],
            [0.0, 0.0, 0.0, f32::NAN],
        ]);
        let image = d.image(&Tone::default());
        assert_eq!(image, [NAN, INFINITE, [0, 0, 0, 255]].concat());
        let image = d.image(&tone(Channel::One(3), 0.0, 1.0, 0.0));
        assert_eq!(image, [[255; 4], [255; 4], NAN].concat());
    }

    #[test]
    fn range_and_exposure() {
        let d = floats(&[[2.0, 3.0, 4.0, 0.0], [1.0, 2.5, 9.0, 0.0]]);
        assert_eq!(
            d.image(&tone(Channel::Rgb, 2.0, 4.0, 0.0)),
            [0, 128, 255, 255, 0, 64, 255, 255]
        );
        assert_eq!(
            d.image(&tone(Channel::Rgb, 2.0, 4.0, 1.0)),
            [0, 255, 255, 255, 0, 128, 255, 255]
        );
        assert_eq!(
            d.image(&tone(Channel::One(1), 2.0, 4.0, -1.0))[..4],
            [64, 64, 64, 255]
        );
        // A range turned around shows the negative.
        assert_eq!(
            d.image(&tone(Channel::Rgb, 4.0, 2.0, 0.0))[..3],
            [255, 128, 0]
        );
        assert_eq!(
            d.image(&tone(Channel::Rgb, 3.0, 3.0, 0.0))[..3],
            [0, 0, 255]
        );
        let half = floats(&[[0.214_041_14; 4]]);
        assert_eq!(half.image(&Tone::default())[..3], [128; 3]);
        assert_eq!(
            half.image(&Tone {
                channel: Channel::Luminance,
                ..Tone::default()
            })[..3],
            [128; 3]
        );
    }

    #[test]
    fn integers_stay_integers() {
        let word = (1 << 24) + 1_u32;
        let d = decoded(
            "r32ui",
            [2, 1],
            [word, u32::MAX]
                .iter()
                .flat_map(|v| v.to_ne_bytes())
                .collect(),
        );
        assert_eq!(
            (d.values(0, 0), d.values(1, 0)),
            (vec!["16777217".to_string()], vec!["4294967295".to_string()])
        );
        let d = decoded("r32i", [1, 1], (-5_i32).to_ne_bytes().to_vec());
        assert_eq!(d.values(0, 0), ["-5"]);
        let d = decoded("rgba8ui", [1, 1], vec![1, 2, 3, 255]);
        assert_eq!(d.values(0, 0), ["1", "2", "3", "255"]);
        let d = decoded("r16ui", [1, 1], 513_u16.to_ne_bytes().to_vec());
        assert_eq!(
            (d.values(0, 0), d.values(1, 0).len(), d.values(0, 1).len()),
            (vec!["513".to_string()], 0, 0)
        );
        assert_eq!(
            decoded("rg8", [1, 1], vec![255, 0]).values(0, 0),
            ["1 (255)", "0 (0)"]
        );
    }

    #[test]
    fn a_slice_knows_where_it_lies() {
        let target = |axis| InspectTarget {
            side: 0,
            texture: "t".into(),
            mip: 0,
            layer: 0,
            axis,
            slice: 9,
        };
        assert_eq!(texel(&target(0), true, 8, 1, 2), [9, 5, 1]);
        assert_eq!(texel(&target(1), true, 8, 1, 2), [1, 9, 2]);
        assert_eq!(texel(&target(2), true, 8, 1, 2), [1, 5, 9]);
        assert_eq!(texel(&target(0), false, 8, 1, 2), [1, 2]);
    }

    #[test]
    fn slices_stand_upright() {
        let format = Format::named("r8").unwrap();
        // Two wide, three high: the value is 10 times the row, and the column.
        let slice = || Texels {
            extent: [2, 3, 1],
            format,
            bytes: vec![0, 1, 10, 11, 20, 21],
        };
        let front = upright(slice(), 2);
        assert_eq!(
            (front.extent, front.bytes),
            ([2, 3, 1], vec![20, 21, 10, 11, 0, 1])
        );
        // Along x columns were y and rows z: the largest y is on top, z goes to the right.
        let side = upright(slice(), 0);
        assert_eq!(
            (side.extent, side.bytes),
            ([3, 2, 1], vec![1, 11, 21, 0, 10, 20])
        );
        assert_eq!(upright(slice(), 1).bytes, slice().bytes);
    }
}
