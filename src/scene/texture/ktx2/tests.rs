//! Plain files that are built here, and universal ones that the encoder of Basis Universal wrote
//! (`tests/gltf_compressed/README.md`).

use super::*;

const ETC1S: &[u8] = include_bytes!("../../../../tests/gltf_compressed/etc1s.ktx2");
const ETC1S_ALPHA: &[u8] = include_bytes!("../../../../tests/gltf_compressed/etc1s_alpha.ktx2");
const UASTC: &[u8] = include_bytes!("../../../../tests/gltf_compressed/uastc.ktx2");
const UASTC_ZSTD: &[u8] = include_bytes!("../../../../tests/gltf_compressed/uastc_zstd.ktx2");

const ZSTANDARD: u32 = 2;

/// A file with one level and no descriptor (KTX 2.0, sections 3 and 4).
fn file(format: u32, scheme: u32, [width, height]: [u32; 2], level: &[u8]) -> Vec<u8> {
    let mut out = ktx2::MAGIC.to_vec();
    let words = [
        format, 1, width, height, 0, 0, 1, 1, scheme, 0, 0, 0, 0, 0, 0, 0, 0,
    ];
    let place = [104, level.len() as u64, level.len() as u64];
    out.extend(
        words
            .iter()
            .flat_map(|w| w.to_le_bytes())
            .chain(place.iter().flat_map(|w| w.to_le_bytes())),
    );
    out.extend(level);
    out
}

fn texels(bytes: &[u8]) -> Vec<[u8; 4]> {
    pixels(bytes).unwrap().pixels().map(|p| p.0).collect()
}

/// Four flat quarters, cut at texel 4: red and green, blue and a grey that is a quarter opaque.
#[test]
fn universal_textures_have_their_colours() {
    let colors = [
        [255, 0, 0, 255],
        [0, 255, 0, 255],
        [0, 0, 255, 255],
        [128, 128, 128, 64],
    ];
    // Endpoints of ETC1S have 5 bits, of UASTC up to 8.
    for (name, bytes, (width, height), alpha, most) in [
        ("ETC1S", ETC1S, (10, 6), false, 5),
        ("ETC1S and alpha", ETC1S_ALPHA, (8, 8), true, 5),
        ("UASTC", UASTC, (10, 6), true, 1),
        ("UASTC and Zstandard", UASTC_ZSTD, (8, 8), true, 1),
    ] {
        let image = pixels(bytes).unwrap();
        assert_eq!(image.dimensions(), (width, height), "{name}");
        for (x, y, found) in image.enumerate_pixels() {
            let mut wanted = colors[usize::from(x >= 4) + 2 * usize::from(y >= 4)];
            if !alpha {
                wanted[3] = 255;
            }
            let off = found.0.iter().zip(wanted).map(|(a, b)| a.abs_diff(b)).max();
            assert!(
                off <= Some(most),
                "{name} at {x}, {y}: {:?} for {wanted:?}",
                found.0
            );
        }
    }
}

#[test]
fn plain_formats_are_read() {
    let one = |format: Format, level: &[u8]| texels(&file(format.value(), 0, [1, 1], level))[0];
    assert_eq!(one(Format::R8G8B8A8_SRGB, &[1, 2, 3, 4]), [1, 2, 3, 4]);
    assert_eq!(one(Format::B8G8R8A8_UNORM, &[1, 2, 3, 4]), [3, 2, 1, 4]);
    assert_eq!(one(Format::R8G8B8_UNORM, &[1, 2, 3]), [1, 2, 3, 255]);
    // BC1 with the colours red and black (5:6:5), all texels the first; then with three colours,
    // all texels the fourth.
    assert_eq!(
        one(Format::BC1_RGBA_UNORM_BLOCK, &[0, 0xf8, 0, 0, 0, 0, 0, 0]),
        [255, 0, 0, 255]
    );
    let holes = [0, 0, 0, 0xf8, 255, 255, 255, 255];
    assert_eq!(one(Format::BC1_RGBA_SRGB_BLOCK, &holes), [0; 4]);
    assert_eq!(one(Format::BC1_RGB_SRGB_BLOCK, &holes), [0, 0, 0, 255]);
    // BC3: alpha of both ends, and a block of BC1.
    let block = [90, 90, 0, 0, 0, 0, 0, 0, 0, 0xf8, 0, 0, 0, 0, 0, 0];
    assert_eq!(one(Format::BC3_SRGB_BLOCK, &block), [255, 0, 0, 90]);
    // BC7, mode 6: seven bits for each end of red, green, blue and alpha, then the lowest bit of
    // each end.
    let fields = [
        (64u128, 7),
        (127, 7),
        (0, 7),
        (5, 7),
        (0, 7),
        (64, 7),
        (0, 7),
        (100, 7),
        (0, 7),
        (1, 1),
    ];
    let (block, _) = fields.iter().fold((0, 0), |(bits, at), (value, size)| {
        (bits | value << at, at + size)
    });
    assert_eq!(
        one(Format::BC7_SRGB_BLOCK, &block.to_le_bytes()),
        [255, 11, 129, 201]
    );
}

/// A frame of one raw block (RFC 8878, section 3.1).
fn frame(content: &[u8]) -> Vec<u8> {
    let size = content.len() as u8;
    let header = [
        0x28,
        0xb5,
        0x2f,
        0xfd,
        0x20,
        size,
        size << 3 | 1,
        size >> 5,
        0,
    ];
    [&header[..], content].concat()
}

#[test]
fn plain_formats_with_zstandard_are_read() {
    let content: Vec<u8> = (0..16).collect();
    let bytes = file(
        Format::R8G8B8A8_UNORM.value(),
        ZSTANDARD,
        [2, 2],
        &frame(&content),
    );
    assert_eq!(texels(&bytes).concat(), content);
    let short = file(
        Format::R8G8B8A8_UNORM.value(),
        ZSTANDARD,
        [3, 2],
        &frame(&content),
    );
    assert!(pixels(&short).unwrap_err().contains("needs 24 bytes"));
}

#[track_caller]
fn refused(piece: &str, bytes: &[u8]) {
    let told = pixels(bytes).unwrap_err();
    assert!(told.contains(piece), "no '{piece}' in: {told}");
}

#[test]
fn other_files_are_refused() {
    let rgba = Format::R8G8B8A8_UNORM.value();
    let with = |at: usize, word: u32| {
        let mut bytes = file(rgba, 0, [1, 1], &[0; 4]);
        bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
        bytes
    };
    refused(
        "R16_SFLOAT is not read",
        &with(12, Format::R16_SFLOAT.value()),
    );
    for (at, word) in [(24, 0), (28, 1), (32, 2), (36, 6)] {
        refused("no plain 2D texture", &with(at, word));
    }
    for side in [16385, u32::MAX] {
        refused("too large", &file(rgba, 0, [1, side], &[0; 4]));
    }
    // 1 GiB of RGBA.
    refused("too large", &file(rgba, 0, [16384; 2], &[0; 4]));
    refused("needs 16 bytes", &file(rgba, 0, [2, 2], &[0; 4]));
    refused("ZLIB is not read", &with(44, 3));
    refused("first level", &with(80, u32::MAX));
    // A size that no memory has.
    let mut stated = UASTC_ZSTD.to_vec();
    stated[96..104].copy_from_slice(&(1u64 << 60).to_le_bytes());
    refused("not that of its blocks", &stated);
}

/// An entry of two bytes that ends between the boundaries of entries, where the file ends too.
#[test]
fn keys_and_values_are_not_read() {
    let mut bytes = UASTC.to_vec();
    let start = bytes.len().next_multiple_of(4);
    bytes.resize(start, 0);
    bytes.extend([2, 0, 0, 0, b'k', 0]);
    bytes[56..60].copy_from_slice(&(start as u32).to_le_bytes());
    bytes[60..64].copy_from_slice(&6u32.to_le_bytes());
    assert_eq!(texels(&bytes), texels(UASTC));
}

/// Third-party decoders may panic at damaged files; none of these changes triggers a panic.
#[test]
fn damaged_files_are_refused_or_read() {
    for bytes in [ETC1S, ETC1S_ALPHA, UASTC, UASTC_ZSTD] {
        (0..bytes.len()).for_each(|cut| assert!(pixels(&bytes[..cut]).is_err(), "cut at {cut}"));
        for at in 0..bytes.len() {
            for value in [
                0,
                1,
                0x7f,
                0xff,
                bytes[at] ^ 1,
                bytes[at] ^ 0x80,
                bytes[at].wrapping_add(1),
            ] {
                let mut changed = bytes.to_vec();
                changed[at] = value;
                if let Ok(image) = pixels(&changed) {
                    assert!(image.width() <= MAX_FILE_SIDE && image.height() <= MAX_FILE_SIDE);
                }
            }
        }
    }
}
