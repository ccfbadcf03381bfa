//! Streams from the encoder of meshoptimizer 1.3 (npm), compared with known values.

use super::*;
use serde_json::json;

fn hex(text: &str) -> Vec<u8> {
    text.as_bytes()
        .chunks(2)
        .map(|c| u8::from_str_radix(std::str::from_utf8(c).unwrap(), 16).unwrap())
        .collect()
}

fn compressed(mode: &str, filter: &str, stride: usize, count: usize) -> Compressed {
    let fields = json!({ "buffer": 0, "byteLength": 0, "byteStride": stride, "count": count, "mode": mode, "filter": filter });
    parse(&fields).unwrap()
}

fn decoded(mode: &str, filter: &str, stride: usize, count: usize, stream: &str) -> Vec<u8> {
    compressed(mode, filter, stride, count)
        .decode(&hex(stream))
        .unwrap()
}

/// Signed numbers of one or two bytes each, as shares of the largest.
fn signed(bytes: &[u8], size: usize) -> Vec<f32> {
    match size {
        1 => bytes.iter().map(|&b| f32::from(b as i8) / 127.0).collect(),
        _ => bytes
            .as_chunks::<2>()
            .0
            .iter()
            .map(|&b| f32::from(i16::from_le_bytes(b)) / 32767.0)
            .collect(),
    }
}

#[track_caller]
fn near(found: &[f32], wanted: &[f32], most: f32) {
    assert_eq!(found.len(), wanted.len());
    let off = found
        .iter()
        .zip(wanted)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f32::max);
    assert!(off <= most, "{off}: {found:?} for {wanted:?}");
}

/// Elements of 2, 2, 4 and 4 bytes: 7 i, 1000 - 3 i, the float i / 2, and a constant.
const MIXED: [&str; 2] = [
    "a02a0eeeeeeeeeeeeeeeeeeeeeeeeeeeeeeeeeeeeeee0000000010002000002a0555555555555555555555555555555555555555000000\
     000000002f0000ff8080404040402020202020202020101010101010101010101010101010f8888888000000001005308000007e800000\
     000000000000000000000000000000000000000000000000000000e8030000000000ff00ff",
    "a19968aa2a0eeeeeeeeeeeeeeeeeeeeeeeeeeeeeeeeeeeeeee000000002a05555555555555555555555555555555555555550000000001\
     12000f1f1a0ffff8f8f4c4f4c4c02010f018381cf262e262f262e2627c1edddd00003e0307030000000000000000000000e80300000000\
     00ff00ff016200",
];

/// Numbers of four bytes: i / 16, rounded down. More than one block.
const LONG: [&str; 2] = [
    "a0545555558000000080000000800000008000000080000000800000008000000080000000800000008000000080000000800000008000\
     00008000000080000000000000000000000000000000555555558000000080000000800000008000000080000000800000008000000080\
     00000080000000800000008000000080000000800000008000000080000000800000000000000000000000000000005505800000008000\
     00008000000080000000800000008000000000000000000000000000000000000000000000000000000000000000000000000000000000\
     00",
    "a1a854555555010002010002010002010002010002010002010002010002010002010002010002010002010002010002010002a9000000\
     00010002010002010002010002010002010002010002010002010002010002010002010002010002010002010002010002a90000010002\
     010002010002010002010002010002000000000000000000000000000000000000000000000000",
];

const GRID: &str =
    "e1fe1e100e100e100ece1e160e150e140ece1e140e140e140e0f0a007687566778a9866589689801690000";

#[test]
fn attributes_of_both_versions_are_exact() {
    let element = |i: u16| {
        let float = f32::from(i) / 2.0;
        [
            &(7 * i).to_le_bytes()[..],
            &(1000 - 3 * i).to_le_bytes(),
            &float.to_le_bytes(),
            &[0, 255, 0, 255],
        ]
        .concat()
    };
    let mixed: Vec<u8> = (0..40).flat_map(element).collect();
    let long: Vec<u8> = (0..600u32).flat_map(|i| (i / 16).to_le_bytes()).collect();
    for version in 0..2 {
        assert_eq!(
            decoded("ATTRIBUTES", "NONE", 12, 40, MIXED[version]),
            mixed,
            "version {version}"
        );
        assert_eq!(
            decoded("ATTRIBUTES", "NONE", 4, 600, LONG[version]),
            long,
            "version {version}"
        );
    }
}

/// The example of appendix A: deltas of four bits, two of them larger than that.
#[test]
fn the_example_of_the_specification() {
    let group = "175ff0bc77a9210034b5";
    // Version 0; the other three bytes of an element do not change.
    let stream = format!("a002{group}000000{}", "00".repeat(32));
    let bytes = decoded("ATTRIBUTES", "NONE", 4, 16, &stream);
    let firsts: Vec<i8> = bytes.iter().step_by(4).map(|&b| b as i8).collect();
    let deltas = [-1i8, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0];
    let mut sum = 0i8;
    let wanted: Vec<i8> = deltas
        .iter()
        .map(|d| {
            sum = sum.wrapping_add(*d);
            sum
        })
        .collect();
    assert_eq!(firsts, wanted);
}

#[test]
fn triangles_and_indices_are_exact() {
    let place = |x: u32, y: u32| y * 5 + x;
    let cell = |(x, y)| {
        let [a, b, c, d] = [
            place(x, y),
            place(x + 1, y),
            place(x, y + 1),
            place(x + 1, y + 1),
        ];
        [[a, b, c], [b, d, c]]
    };
    let grid: Vec<[u32; 3]> = (0..3)
        .flat_map(|y| (0..4).map(move |x| (x, y)))
        .flat_map(cell)
        .collect();
    let four = |bytes: Vec<u8>| -> Vec<u32> {
        bytes
            .as_chunks()
            .0
            .iter()
            .map(|b| u32::from_le_bytes(*b))
            .collect()
    };
    let two = |bytes: Vec<u8>| -> Vec<u32> {
        bytes
            .as_chunks()
            .0
            .iter()
            .map(|b| u32::from(u16::from_le_bytes(*b)))
            .collect()
    };
    assert_eq!(
        turned(&four(decoded("TRIANGLES", "NONE", 4, 72, GRID))),
        grid
    );
    assert_eq!(
        turned(&two(decoded("TRIANGLES", "NONE", 2, 72, GRID))),
        grid
    );
    let loose = "e1fff013ffff0ab6ee6db9ee6d65dac508007687566778a9866589689801690000";
    let wanted = [[3, 5, 900_000], [0, 1, 2], [1, 3, 2], [5, 900_000, 70_000]];
    assert_eq!(
        turned(&four(decoded("TRIANGLES", "NONE", 4, 12, loose))),
        wanted
    );
    let sequence = "d100a11f04050405b88b119b1f0b00000000";
    assert_eq!(
        four(decoded("INDICES", "NONE", 4, 9, sequence)),
        [0, 1000, 1, 1001, 2, 1002, 70_000, 3, 0]
    );
}

/// Triangles rotated to their lowest index: encoders may rotate them but keep the winding.
fn turned(indices: &[u32]) -> Vec<[u32; 3]> {
    let turn = |&[a, b, c]: &[u32; 3]| match a.min(b).min(c) {
        low if low == a => [a, b, c],
        low if low == b => [b, c, a],
        _ => [c, a, b],
    };
    indices.as_chunks().0.iter().map(turn).collect()
}

#[test]
fn unit_vectors_and_rotations() {
    let vectors = [
        1., 0., 0., 1., -1., 0., 0., -1., 0., 1., 0., 1., 0., -1., 0., 1., 0., 0., 1., 1., 0., 0.,
        -1., -1., 0.6, 0., -0.8, 1., 0.48, -0.6, 0.64, 1.,
    ];
    let bytes = "a0013c33000004fefeb7010fff0000fe04fefe6be900013c3c000004030403000000000000000000000000000000000000000000000000\
     000000007f007f7f";
    near(
        &signed(&decoded("ATTRIBUTES", "OCTAHEDRAL", 4, 8, bytes), 1),
        &vectors,
        0.012,
    );
    let words = "a001341300000478013c3300001d100e0901075f000004d9b7010fff00000e1d100e050d0000013c3c0000040304030124240000000000\
     000000000000000000000000000000000000000000ff070000ff07ff7f";
    near(
        &signed(&decoded("ATTRIBUTES", "OCTAHEDRAL", 8, 8, words), 2),
        &vectors,
        0.0008,
    );

    let half = std::f32::consts::FRAC_1_SQRT_2;
    // The largest component is positive, because a quaternion and its negative are the same
    // rotation.
    let rotations = [
        0., 0., 0., 1., 1., 0., 0., 0., 0., half, 0., half, 0.5, 0.5, 0.5, 0.5, 0.6, 0., 0.8, 0.,
        0., 0.8, 0., -0.6,
    ];
    let stream = "a00103c00000fbfc0103c00000b4b30107f00000f9346f010ff00000fe49244e0103c00000fbfc0103c00000b4b30139d0000005040000\
     0000000000000000000000000000000000000000000000000000000000ff7f";
    near(
        &signed(&decoded("ATTRIBUTES", "QUATERNION", 8, 6, stream), 2),
        &rotations,
        0.0001,
    );
}

#[test]
fn floats_and_colours() {
    let stream = "a00100ff0000ffff72d2013fff0000407f803ce3c60901061800000131ff0000ca140f87ec000000000000000000000000000000000000\
     000000000000000000000000008e";
    let floats = decoded("ATTRIBUTES", "EXPONENTIAL", 4, 8, stream);
    for (bytes, wanted) in floats
        .as_chunks::<4>()
        .0
        .iter()
        .zip([0f32, 1.0, -1.0, 0.5, 1000.0, -3.25, 1e-20, 3e15])
    {
        let found = f32::from_le_bytes(*bytes);
        // 15 bits, one of them the sign.
        assert!(
            (found - wanted).abs() <= wanted.abs() / 16384.0,
            "{found} for {wanted}"
        );
    }
    let colors = [
        0., 0., 0., 0., 1., 1., 1., 1., 1., 0., 0., 1., 0., 1., 0., 0.5, 0., 0., 1., 1., 0.2, 0.4,
        0.6, 0.8,
    ];
    let stream = "a1ff0001827e7d4c0000fefdfd9800007d83828000fe007d7e31000000000000000000000000000000000000000000008000";
    let bytes = decoded("ATTRIBUTES", "COLOR", 4, 6, stream);
    assert_eq!(bytes[..8], [0, 0, 0, 0, 255, 255, 255, 255]);
    near(
        &bytes
            .iter()
            .map(|&b| f32::from(b) / 255.0)
            .collect::<Vec<_>>(),
        &colors,
        0.009,
    );
    let stream = "a1ffff0001020102cc001e1506050400000102026700000e0d0f080000020302000000071615080001000201ce000e0005060100000000\
     0000000000000000000000000000000000080000";
    let words = decoded("ATTRIBUTES", "COLOR", 8, 6, stream);
    let words = words
        .as_chunks::<2>()
        .0
        .iter()
        .map(|&w| f32::from(u16::from_le_bytes(w)) / 65535.0);
    near(&words.collect::<Vec<_>>(), &colors, 0.0006);
}

/// A truncated or extended stream is refused. One with a changed byte is refused or has the right
/// size.
#[test]
fn damaged_streams_are_refused() {
    let cases = [
        ("ATTRIBUTES", 12, 40, MIXED[0]),
        ("ATTRIBUTES", 12, 40, MIXED[1]),
        ("ATTRIBUTES", 4, 600, LONG[1]),
        ("TRIANGLES", 4, 72, GRID),
        ("INDICES", 2, 9, "d100a11f04050405b88b119b1f0b00000000"),
    ];
    for (mode, stride, count, stream) in cases {
        let (view, stream) = (compressed(mode, "NONE", stride, count), hex(stream));
        (0..stream.len())
            .for_each(|cut| assert!(view.decode(&stream[..cut]).is_err(), "{mode} cut at {cut}"));
        assert!(
            view.decode(&[&stream[..], &[0]].concat()).is_err(),
            "{mode} with a byte more"
        );
        for at in 0..stream.len() {
            for value in [0, 0x7f, 0xff, stream[at] ^ 1, stream[at] ^ 0x80] {
                let mut changed = stream.clone();
                changed[at] = value;
                if let Ok(bytes) = view.decode(&changed) {
                    assert_eq!(bytes.len(), stride * count);
                }
            }
        }
        // An impossible count ends at the last byte.
        for count in [count * 3, 3 << 40, usize::MAX / 512 / 3 * 3] {
            assert!(
                compressed(mode, "NONE", stride, count)
                    .decode(&stream)
                    .is_err(),
                "{mode}, {count}"
            );
        }
    }
}

/// Filters take any bytes.
#[test]
fn filters_take_what_no_encoder_writes() {
    let bytes: Vec<u8> = (0..=255)
        .chain((0..=255).rev())
        .chain([0; 8])
        .chain([255; 8])
        .collect();
    for stride in [4, 8] {
        filters::octahedral(&mut bytes.clone(), stride);
        filters::color(&mut bytes.clone(), stride);
    }
    filters::quaternion(&mut bytes.clone());
    filters::exponential(&mut bytes.clone());
}

#[test]
fn layouts_follow_the_rules() {
    let ok = |mode: &str, filter: &str, stride: usize, count: usize| {
        parse(
            &json!({ "buffer": 0, "byteLength": 1, "byteStride": stride, "count": count, "mode": mode, "filter": filter }),
        )
    };
    for (mode, filter, stride, count) in [
        ("ATTRIBUTES", "NONE", 6, 1),
        ("ATTRIBUTES", "NONE", 0, 1),
        ("ATTRIBUTES", "NONE", 260, 1),
        ("ATTRIBUTES", "OCTAHEDRAL", 12, 1),
        ("ATTRIBUTES", "QUATERNION", 4, 1),
        ("ATTRIBUTES", "COLOR", 12, 1),
        ("ATTRIBUTES", "SEPIA", 4, 1),
        ("TRIANGLES", "NONE", 4, 4),
        ("TRIANGLES", "NONE", 8, 3),
        ("INDICES", "EXPONENTIAL", 4, 3),
        ("MESHLETS", "NONE", 4, 3),
    ] {
        assert!(
            ok(mode, filter, stride, count).is_err(),
            "{mode} {filter} {stride} {count}"
        );
    }
    assert!(ok("ATTRIBUTES", "EXPONENTIAL", 256, 1).is_ok());
    assert!(parse(&json!({})).is_err());
}
