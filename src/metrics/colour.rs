//! Luminance, sRGB, and the colour spaces of FLIP. RGB is linear with the sRGB primaries; white is D65.

use super::Kind;

/// Relative luminance of linear RGB (ITU-R BT.709).
pub fn luminance(rgb: [f32; 3]) -> f64 {
    0.2126 * f64::from(rgb[0]) + 0.7152 * f64::from(rgb[1]) + 0.0722 * f64::from(rgb[2])
}

/// Decodes an sRGB value in 0..1 (IEC 61966-2-1).
pub fn srgb_to_linear(v: f32) -> f32 {
    if v <= 0.04045 {
        v / 12.92
    } else {
        ((v + 0.055) / 1.055).powf(2.4)
    }
}

/// Encodes a linear value in 0..1 as sRGB (IEC 61966-2-1).
pub(crate) fn linear_to_srgb(v: f64) -> f64 {
    if v <= 0.003_130_8 {
        12.92 * v
    } else {
        1.055 * v.powf(1.0 / 2.4) - 0.055
    }
}

/// The displayed value of a channel, 0 to 1: radiance is mapped by c / (1 + c), values in 0..1 are
/// kept ([`Kind`]). The result is sRGB-encoded (IEC 61966-2-1) and not rounded.
pub fn display(kind: Kind, c: f32) -> f64 {
    let c = f64::from(c.max(0.0));
    let shown = if matches!(kind, Kind::Direct | Kind::Radiance) {
        c / (1.0 + c)
    } else {
        c.min(1.0)
    };
    linear_to_srgb(shown)
}

/// The white point's XYZ is normalised to 1: all spaces here are relative to it.
const TO_XYZ: [[f32; 3]; 3] = [
    [0.412_386_56, 0.357_591_5, 0.180_450_49],
    [0.212_636_82, 0.715_183, 0.072_180_2],
    [0.019_330_62, 0.119_197_16, 0.950_372_6],
];

const FROM_XYZ: [[f32; 3]; 3] = [
    [3.241_003_3, -1.537_398_9, -0.498_615_86],
    [-0.969_224_33, 1.875_930_1, 0.041_554_224],
    [0.055_639_423, -0.204_011_2, 1.057_149],
];

const WHITE: [f32; 3] = [0.950_428_55, 1.0, 1.088_900_4];

fn times(m: &[[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// XYZ relative to the white point.
fn relative_xyz(rgb: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = times(&TO_XYZ, rgb);
    [x / WHITE[0], y / WHITE[1], z / WHITE[2]]
}

/// The linearised L\*a\*b\* in which FLIP filters: luminance, red-green, blue-yellow (Andersson et
/// al. 2020, section 4.1).
pub(crate) fn ycxcz(rgb: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = relative_xyz(rgb);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// The inverse of [`ycxcz`].
pub(crate) fn from_ycxcz([y, cx, cz]: [f32; 3]) -> [f32; 3] {
    let y = (y + 16.0) / 116.0;
    times(
        &FROM_XYZ,
        [
            (y + cx / 500.0) * WHITE[0],
            y * WHITE[1],
            (y - cz / 200.0) * WHITE[2],
        ],
    )
}

/// CIE L\*a\*b\* with the Hunt effect: chroma decreases with lightness (Andersson et al. 2020,
/// section 4.1.2).
pub(crate) fn hunt_lab(rgb: [f32; 3]) -> [f32; 3] {
    const DELTA: f32 = 6.0 / 29.0;
    let f = |t: f32| {
        if t > DELTA * DELTA * DELTA {
            t.cbrt()
        } else {
            t / (3.0 * DELTA * DELTA) + 4.0 / 29.0
        }
    };
    let [x, y, z] = relative_xyz(rgb).map(f);
    let lightness = 116.0 * y - 16.0;
    [
        lightness,
        0.01 * lightness * 500.0 * (x - y),
        0.01 * lightness * 200.0 * (y - z),
    ]
}
