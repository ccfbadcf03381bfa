//! Filters of decoded attributes (appendix B of the extension). Invalid streams give arbitrary
//! numbers.

/// Octahedral unit vectors: four signed numbers of one or two bytes each.
pub(super) fn octahedral(bytes: &mut [u8], stride: usize) {
    let decode = |[x, y, one, w]: [f32; 4], most: f32| {
        let (x, y) = (x / one, y / one);
        let z = 1.0 - x.abs() - y.abs();
        let folded = z.min(0.0);
        let (x, y) = (x - folded.copysign(x), y - folded.copysign(y));
        let scale = most / (x * x + y * y + z * z).sqrt();
        [
            (x * scale).round(),
            (y * scale).round(),
            (z * scale).round(),
            w,
        ]
    };
    match stride {
        4 => {
            for element in bytes.as_chunks_mut::<4>().0 {
                *element =
                    decode(element.map(|b| f32::from(b as i8)), 127.0).map(|v| v as i8 as u8);
            }
        }
        _ => words(bytes, |element| {
            decode(element.map(|w| f32::from(w as i16)), 32767.0).map(|v| v as i16 as u16)
        }),
    }
}

/// Quaternions without their largest component.
pub(super) fn quaternion(bytes: &mut [u8]) {
    words(bytes, |element| {
        let [x, y, z, one] = element.map(|w| w as i16);
        let scale = std::f32::consts::FRAC_1_SQRT_2 / f32::from(one | 3);
        let [x, y, z] = [x, y, z].map(|v| f32::from(v) * scale);
        let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
        let mut out = [w, x, y, z].map(|v| (v * 32767.0).round() as i16 as u16);
        out.rotate_right(usize::from(one as u16 & 3));
        out
    });
}

/// Floats from a 24-bit mantissa and an 8-bit exponent.
pub(super) fn exponential(bytes: &mut [u8]) {
    for number in bytes.as_chunks_mut::<4>().0 {
        let packed = i32::from_le_bytes(*number);
        let (exponent, mantissa) = (packed >> 24, packed << 8 >> 8);
        // Both factors and their product are exact in 64 bits.
        *number = ((2f64.powi(exponent) * f64::from(mantissa)) as f32).to_le_bytes();
    }
}

/// Colours from luma, two chroma channels and alpha; the top bit of alpha marks the precision.
pub(super) fn color(bytes: &mut [u8], stride: usize) {
    let decode = |[y, orange, green, alpha]: [i32; 4], most: f32| {
        let bits = 32 - alpha.leading_zeros();
        let full = (1 << bits) - 1;
        let a = alpha & (full >> 1);
        let scale = most / full as f32;
        [
            y + orange - green,
            y + green,
            y - orange - green,
            a << 1 | a & 1,
        ]
        .map(|v| (v as f32 * scale).round())
    };
    match stride {
        4 => {
            for element in bytes.as_chunks_mut::<4>().0 {
                let [y, orange, green, alpha] = *element;
                let signed = |b: u8| i32::from(b as i8);
                let input = [
                    i32::from(y),
                    signed(orange),
                    signed(green),
                    i32::from(alpha),
                ];
                *element = decode(input, 255.0).map(|v| v as u8);
            }
        }
        _ => words(bytes, |[y, orange, green, alpha]| {
            let signed = |w: u16| i32::from(w as i16);
            let input = [
                i32::from(y),
                signed(orange),
                signed(green),
                i32::from(alpha),
            ];
            decode(input, 65535.0).map(|v| v as u16)
        }),
    }
}

/// Maps each group of four 16-bit numbers.
fn words(bytes: &mut [u8], change: impl Fn([u16; 4]) -> [u16; 4]) {
    for element in bytes.as_chunks_mut::<8>().0 {
        let [a, b, c, d] = change(std::array::from_fn(|i| {
            u16::from_le_bytes([element[2 * i], element[2 * i + 1]])
        }));
        let ([a, b], [c, d], [e, f], [g, h]) = (
            a.to_le_bytes(),
            b.to_le_bytes(),
            c.to_le_bytes(),
            d.to_le_bytes(),
        );
        *element = [a, b, c, d, e, f, g, h];
    }
}
