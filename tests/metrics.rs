//! The metrics: values worked out by hand, what must hold for any picture, and NVIDIA's own FLIP evaluator.

use conelab::metrics::{Compared, Kind, Linear, Scores, colour, scores};
use exr::prelude::{
    Encoding, Image, Layer, LayerAttributes, SpecificChannels, Vec2, WritableImage,
};
use proptest::prelude::*;
use std::path::Path;

fn picture(size: (u32, u32), rgb: impl Fn(u32, u32) -> [f32; 3]) -> Linear {
    let at = |i: u32| rgb(i % size.0, i / size.0);
    Linear::radiance(size, (0..size.0 * size.1).map(at).collect())
}

fn flat(v: f32) -> Linear {
    picture((8, 4), |_, _| [v; 3])
}

#[track_caller]
fn close(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-6 * b.abs().max(1e-3), "{a} is not {b}");
}

#[test]
fn two_flat_pictures_score_what_the_definitions_say() {
    let s = scores(&flat(1.5), &flat(1.0)).unwrap();
    close(s.get("relmse"), 0.25 / 1.01);
    close(s.get("rmse"), 0.5);
    close(s.get("energy_ratio"), 1.5);
    close(s.get("smape"), 0.5 / 2.51);
    assert_eq!(
        (
            s.get("leak"),
            s.get("dark"),
            s.get("over_occlusion"),
            s.get("over_occluded")
        ),
        (0.0, 0.0, 0.0, 0.0)
    );
    assert_eq!((s.pixels, s.not_finite), (32, 0));
}

#[test]
fn channels_weigh_the_same() {
    let r = picture((1, 1), |_, _| [1.0, 2.0, 0.0]);
    let x = picture((1, 1), |_, _| [1.0, 1.0, 0.3]);
    let s = scores(&x, &r).unwrap();
    close(s.get("relmse"), (1.0 / 4.01 + 0.09 / 0.01) / 3.0);
    close(s.get("rmse"), ((1.0 + 0.09) / 3.0f64).sqrt());
    close(s.get("energy_ratio"), 2.3 / 3.0);
    close(s.get("smape"), (1.0 / 3.01 + 0.3 / 0.31) / 3.0);
}

#[test]
fn light_behind_a_wall_is_leak_and_a_lit_wall_gone_black_is_over_occlusion() {
    // A quarter of the reference is dark; another quarter of the picture has lost its light.
    let r = picture((4, 1), |x, _| if x == 0 { [0.0; 3] } else { [1.0; 3] });
    let x = picture((4, 1), |x, _| {
        [[0.2; 3], [0.001; 3], [1.0; 3], [1.0; 3]][x as usize]
    });
    let s = scores(&x, &r).unwrap();
    close(s.get("leak"), 0.2);
    close(s.get("dark"), 0.25);
    close(s.get("over_occlusion"), 1.0);
    close(s.get("over_occluded"), 0.25);
    // The mask of the first half: what is dark is still said by the whole frame.
    let compared = Compared::new(&x, &r).unwrap();
    let half = compared.scores(Some(&[true, true, false, false])).unwrap();
    close(half.get("leak"), 0.2);
    close(half.get("dark"), 0.5);
    assert_eq!(half.pixels, 2);
    assert_eq!(compared.scores(Some(&[false; 4])), None);
}

#[test]
fn numbers_that_are_none_are_counted_and_spoil_nothing_but_flip() {
    let mut x = flat(1.5);
    x.rgb[9][1] = f32::NAN;
    x.rgb[20][0] = f32::INFINITY;
    let (clean, s) = (
        scores(&flat(1.5), &flat(1.0)).unwrap(),
        scores(&x, &flat(1.0)).unwrap(),
    );
    assert_eq!((s.pixels, s.not_finite), (32, 2));
    close(s.get("relmse"), clean.get("relmse"));
    close(s.get("energy_ratio"), clean.get("energy_ratio"));
    assert!(
        s.get("flip") > clean.get("flip")
            && s.get("flip").is_finite()
            && s.get("hdr_flip") > clean.get("hdr_flip")
            && s.get("hdr_flip").is_finite()
    );
    let none = scores(&flat(f32::NAN), &flat(1.0)).unwrap_err().to_string();
    assert_eq!(none, "no pixel is a finite number in both pictures");
}

#[test]
fn a_black_reference_gives_no_ratio_and_json_says_so() {
    let s = scores(&flat(1.0), &flat(0.0)).unwrap();
    assert!(s.get("energy_ratio").is_nan());
    close(s.get("relmse"), 100.0);
    close(s.get("leak"), 1.0);
    assert!(s.get("hdr_flip") > 0.5 && s.get("hdr_flip") <= 1.0);
    assert!(s.get("structure").is_nan());
    let text = serde_json::to_string(&s).unwrap();
    assert!(text.contains("\"energy_ratio\":null"), "{text}");
    let back: Scores = serde_json::from_str(&text).unwrap();
    assert!(
        back.get("energy_ratio").is_nan()
            && back.get("structure").is_nan()
            && back.get("relmse") == s.get("relmse")
    );
}

#[test]
fn pictures_that_do_not_fit_are_refused() {
    let other = picture((4, 8), |_, _| [1.0; 3]);
    let said = scores(&flat(1.0), &other).unwrap_err().to_string();
    assert_eq!(
        said,
        "pictures of 8x4 and 4x8 cannot be compared; render both at one size"
    );
    let short = Linear::radiance((8, 4), vec![[1.0; 3]; 31]);
    assert!(scores(&short, &flat(1.0)).is_err());
    let none = Linear::radiance((0, 0), Vec::new());
    assert!(scores(&none, &none).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn a_picture_equals_itself_and_scales_as_it_should(seed in any::<u32>(), scale in 0.01f32..50.0) {
        let r = picture((24, 16), |x, y| [noise(seed, x, y, 0), noise(seed, x, y, 1), noise(seed, x, y, 2)]);
        let s = scores(&r, &r).unwrap();
        prop_assert_eq!((s.get("relmse"), s.get("rmse"), s.get("energy_ratio"), s.get("smape")), (0.0, 0.0, 1.0, 0.0));
        prop_assert_eq!((s.get("flip"), s.get("hdr_flip"), s.get("structure")), (0.0, 0.0, 0.0));
        let x = picture((24, 16), |x, y| r.rgb[(y * 24 + x) as usize].map(|v| v * scale));
        let (there, back) = (scores(&x, &r).unwrap(), scores(&r, &x).unwrap());
        prop_assert!((there.get("energy_ratio") - f64::from(scale)).abs() < 1e-5 * f64::from(scale));
        prop_assert!((there.get("energy_ratio") * back.get("energy_ratio") - 1.0).abs() < 1e-5);
        prop_assert!((there.get("smape") - back.get("smape")).abs() < 1e-12);
        prop_assert!((there.get("rmse") - back.get("rmse")).abs() < 1e-12);
        for v in [there.get("flip"), there.get("hdr_flip"), there.get("smape")] {
            prop_assert!((0.0..=1.0).contains(&v));
        }
    }
}

/// Noise of the comparisons, 0 to 1, the same on every machine.
fn noise(seed: u32, x: u32, y: u32, channel: u32) -> f32 {
    f32::from(hash(seed, x, y, channel)) / 255.0
}

fn hash(seed: u32, x: u32, y: u32, channel: u32) -> u8 {
    let mut h = seed
        ^ x.wrapping_mul(0x9e37_79b1)
        ^ y.wrapping_mul(0x85eb_ca77)
        ^ channel.wrapping_mul(0xc2b2_ae3d);
    for _ in 0..3 {
        h = (h ^ (h >> 15)).wrapping_mul(0x2c1b_3c6d);
    }
    (h >> 24) as u8
}

const SIZE: (u32, u32) = (96, 64);

/// The pictures that NVIDIA's evaluator was given: name, mean FLIP it printed, reference, test. Bytes are sRGB.
///
/// Values by `flip` 1.7 (`pip install flip-evaluator==1.7`), from the files of
/// `cargo test --test metrics -- --ignored write_the_pictures`, in their folder:
/// `flip -r NAME.reference.png -t NAME.test.png -v 2 -nexm -nerm` and the same with `.exr`.
type Bytes = fn(u32, u32) -> [u8; 3];
const DISPLAYED: [(&str, f64, Bytes, Bytes); 4] = [
    ("shifted-bars", 0.589200, |x, _| bars(x), |x, _| bars(x + 2)),
    ("noisy-ramp", 0.289076, ramp, |x, y| {
        let c = ramp(x, y);
        [0, 1, 2].map(|i| c[i].saturating_add(hash(7, x, y, i as u32) / 8))
    }),
    ("other-hues", 0.881181, ramp, |x, y| {
        let [r, g, b] = ramp(x, y);
        [g, b, r]
    }),
    ("lost-points", 0.066635, points, |_, _| [40, 60, 80]),
];

type Floats = fn(u32, u32) -> [f32; 3];
const RADIANCE: [(&str, f64, Floats, Floats); 4] = [
    ("darker-sky", 0.315285, sky, |x, y| {
        sky(x, y).map(|v| v * 0.75)
    }),
    ("fireflies", 0.124355, room, |x, y| {
        if hash(3, x, y, 0) > 250 {
            [40.0; 3]
        } else {
            room(x, y)
        }
    }),
    ("leaking-wall", 0.323474, room, |x, y| {
        room(x, y).map(|v| v + if x < 32 { 0.03 } else { 0.0 })
    }),
    ("mostly-black", 0.947335, lamp, |x, y| {
        lamp(x, y).map(|v| 1.5 * v + 0.001)
    }),
];

fn bars(x: u32) -> [u8; 3] {
    if (x / 8).is_multiple_of(2) {
        [230, 200, 160]
    } else {
        [30, 40, 70]
    }
}

fn ramp(x: u32, y: u32) -> [u8; 3] {
    [(2 * x) as u8, (3 * y) as u8, (255 - x - y) as u8]
}

fn points(x: u32, y: u32) -> [u8; 3] {
    if x % 12 == 5 && y % 12 == 5 {
        [255, 240, 200]
    } else {
        [40, 60, 80]
    }
}

/// Brightness doubles every twelve pixels; the sun is a thousand times brighter.
fn sky(x: u32, y: u32) -> [f32; 3] {
    if x >= 60 && y >= 10 && (x - 60).pow(2) + (y - 10).pow(2) < 9 {
        return [900.0, 800.0, 600.0];
    }
    let v = (1u32 << (x / 12)) as f32 / 64.0;
    [0.5 * v, 0.75 * v, v + y as f32 / 256.0]
}

/// Three walls, one almost unlit, with some texture.
fn room(x: u32, y: u32) -> [f32; 3] {
    let texture = 0.75 + noise(11, x / 4, y / 4, 0) / 4.0;
    [[0.004, 0.003, 0.002], [0.5, 0.125, 0.0625], [2.0, 2.5, 3.0]][(x / 32) as usize]
        .map(|v: f32| v * texture)
}

fn lamp(x: u32, y: u32) -> [f32; 3] {
    if (40..56).contains(&x) && (24..40).contains(&y) {
        [12.0, 9.0, 5.0]
    } else {
        [0.0; 3]
    }
}

fn decoded(rgb: Bytes) -> Linear {
    let light = picture(SIZE, |x, y| {
        rgb(x, y).map(|v| colour::srgb_to_linear(f32::from(v) / 255.0))
    });
    Linear {
        kind: Kind::Displayed,
        ..light
    }
}

#[test]
fn flip_is_that_of_the_evaluator() {
    for (name, expected, reference, test) in DISPLAYED {
        let (x, r) = (decoded(test), decoded(reference));
        let found = Compared::new(&x, &r)
            .unwrap()
            .scores(None)
            .unwrap()
            .get("flip");
        assert!(
            (found - expected).abs() < 1e-3,
            "{name}: {found}, the evaluator says {expected}"
        );
    }
}

#[test]
fn hdr_flip_is_that_of_the_evaluator() {
    for (name, expected, reference, test) in RADIANCE {
        let found = scores(&picture(SIZE, test), &picture(SIZE, reference))
            .unwrap()
            .get("hdr_flip");
        assert!(
            (found - expected).abs() < 1e-3,
            "{name}: {found}, the evaluator says {expected}"
        );
    }
}

#[test]
#[ignore = "writes the pictures for NVIDIA's evaluator to target/tmp/flip"]
fn write_the_pictures() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("flip");
    std::fs::create_dir_all(&folder).unwrap();
    for (name, _, reference, test) in DISPLAYED {
        for (which, rgb) in [("reference", reference), ("test", test)] {
            let image = image::RgbImage::from_fn(SIZE.0, SIZE.1, |x, y| image::Rgb(rgb(x, y)));
            image
                .save(folder.join(format!("{name}.{which}.png")))
                .unwrap();
        }
    }
    for (name, _, reference, test) in RADIANCE {
        for (which, rgb) in [("reference", reference), ("test", test)] {
            let channels = SpecificChannels::rgb(|at: Vec2<usize>| {
                <(f32, f32, f32)>::from(rgb(at.0 as u32, at.1 as u32))
            });
            let size = (SIZE.0 as usize, SIZE.1 as usize);
            // The evaluator's reader crashes on tiles: rows, uncompressed.
            let layer = Layer::new(
                size,
                LayerAttributes::default(),
                Encoding::UNCOMPRESSED,
                channels,
            );
            Image::from_layer(layer)
                .write()
                .to_file(folder.join(format!("{name}.{which}.exr")))
                .unwrap();
        }
    }
}
