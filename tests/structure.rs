//! The structure error, on pictures whose answer is known.

use conelab::metrics::{Compared, Linear, relmse, scores, structure, structure_noise};

/// Half of a difference of this size counts; see `docs/metrics.md`.
const HALF: f64 = 0.1;
/// Width and height of the pictures, pixels, and of what they have in blocks.
const SIDE: u32 = 64;
const BLOCKS: f64 = 32.0;
/// Pairs of neighbouring blocks.
const PAIRS: f64 = 2.0 * BLOCKS * (BLOCKS - 1.0);

fn picture(light: impl Fn(u32, u32) -> f32) -> Linear {
    let rgb = (0..SIDE * SIDE)
        .map(|i| [light(i % SIDE, i / SIDE); 3])
        .collect();
    Linear::radiance((SIDE, SIDE), rgb)
}

fn counted(difference: f64) -> f64 {
    difference * difference / (difference.abs() + HALF)
}

#[track_caller]
fn close(a: f64, b: f64) {
    assert!((a - b).abs() <= 1e-5 * b.abs().max(1e-5), "{a} is not {b}");
}

/// 0 to 1, without order, the same on every machine.
fn random(x: u32, y: u32, seed: u32) -> f32 {
    let mut h = seed ^ x.wrapping_mul(0x9e37_79b1) ^ y.wrapping_mul(0x85eb_ca77);
    for _ in 0..3 {
        h = (h ^ (h >> 15)).wrapping_mul(0x2c1b_3c6d);
    }
    (h >> 8) as f32 / (1 << 24) as f32
}

/// Tiles of several pixels whose albedo is 0.1 to 0.9.
fn texture(x: u32, y: u32) -> f32 {
    0.1 + 0.8 * random(x / 6, y / 6, 1)
}

fn dark_square(x: u32, y: u32) -> bool {
    (24..40).contains(&x) && (24..40).contains(&y)
}

#[test]
fn a_step_counts_by_its_ratio_and_the_length_of_its_edge() {
    let flat = picture(|_, _| 1.0);
    for ratio in [0.0f32, 0.5, 0.9, 1.1, 3.0] {
        // The edge is between blocks, over the height of the frame: one pair a row of blocks.
        let step = structure(&picture(|x, _| if x < 20 { 1.0 } else { ratio }), &flat).unwrap();
        let log = ((f64::from(ratio) + 0.01) / 1.01).ln();
        close(step, counted(log) * BLOCKS / PAIRS);
    }
    // The same edge in both is no error; where the reference alone has it, as much as where the picture has.
    let edge = picture(|x, _| if x < 20 { 1.0 } else { 0.5 });
    close(structure(&edge, &edge).unwrap(), 0.0);
    let dark: f64 = 0.01 * (20.0 + 44.0 * 0.5) / 64.0;
    close(
        structure(&flat, &edge).unwrap(),
        counted(((0.5 + dark) / (1.0 + dark)).ln()) * BLOCKS / PAIRS,
    );
}

#[test]
fn a_constant_factor_and_a_texture_of_both_pictures_go_out() {
    let light =
        |x: u32, y: u32| 1.0 + (x as f32 / 20.0).sin() * 0.5 + (y as f32 / 25.0).cos() * 0.3;
    let textured = picture(|x, y| light(x, y) * texture(x, y));
    let twice = picture(|x, y| 2.0 * light(x, y) * texture(x, y));
    let factor = structure(&twice, &textured).unwrap();
    assert!(factor < 1e-3, "{factor}");
    // A blotch scores the same, or nearly, whether the walls have a texture or not.
    let blotch = |x, y| if dark_square(x, y) { 0.3 } else { 1.0 };
    let plain = structure(&picture(|x, y| light(x, y) * blotch(x, y)), &picture(light)).unwrap();
    let under = structure(
        &picture(|x, y| light(x, y) * texture(x, y) * blotch(x, y)),
        &textured,
    )
    .unwrap();
    assert!((under / plain - 1.0).abs() < 0.05, "{under} {plain}");
}

#[test]
fn of_errors_of_one_relmse_blotches_with_hard_edges_score_most() {
    let flat = picture(|_, _| 1.0);
    let hard = picture(|x, y| if dark_square(x, y) { 0.4 } else { 1.0 });
    let error = relmse(&hard, &flat).unwrap();
    // Each of these is scaled until its relMSE is that of the blotch.
    let same = |shape: &dyn Fn(u32, u32) -> f32| {
        let root = |scale: f32| {
            relmse(&picture(|x, y| 1.0 - scale * shape(x, y)), &flat)
                .unwrap()
                .sqrt()
        };
        let scale = (error.sqrt() / root(1.0)) as f32;
        picture(|x, y| 1.0 - scale * shape(x, y))
    };
    let offset = same(&|_, _| 1.0);
    let slope = same(&|x, _| x as f32);
    let soft = same(&|x, y| {
        let (dx, dy) = (x as f32 - 31.5, y as f32 - 31.5);
        (-(dx * dx + dy * dy) / 500.0).exp()
    });
    let score = |x: &Linear| structure(x, &flat).unwrap();
    for (name, other, least) in [
        ("offset", offset, 1e4),
        ("slope", slope, 10.0),
        ("soft blotch", soft, 5.0),
    ] {
        close(relmse(&other, &flat).unwrap(), error);
        assert!(
            score(&hard) > least * score(&other),
            "{name}: {} and {}",
            score(&hard),
            score(&other)
        );
    }
}

#[test]
fn what_noise_alone_scores_follows_from_two_halves_of_the_samples() {
    let light = |x: u32| 1.0 + x as f32 / 64.0;
    let half = |seed| picture(|x, y| light(x) * (0.9 + 0.2 * random(x, y, seed)));
    let (even, odd, truth) = (half(1), half(2), picture(|x, _| light(x)));
    let mean = picture(|x, y| {
        let i = (y * SIDE + x) as usize;
        (even.rgb[i][0] + odd.rgb[i][0]) / 2.0
    });
    let (floor, found) = (
        structure_noise(&even, &odd).unwrap(),
        structure(&truth, &mean).unwrap(),
    );
    assert!((floor / found - 1.0).abs() < 0.1, "{floor} {found}");
    // Far below the edges of a blotch.
    let blotch = picture(|x, y| light(x) * if dark_square(x, y) { 0.3 } else { 1.0 });
    assert!(structure(&blotch, &mean).unwrap() > 3.0 * floor);
}

#[test]
fn regions_count_the_pairs_whose_blocks_are_both_inside() {
    let (flat, edge) = (
        picture(|_, _| 1.0),
        picture(|x, _| if x < 20 { 1.0 } else { 0.5 }),
    );
    let compared = Compared::new(&edge, &flat).unwrap();
    let of = |inside: &dyn Fn(u32, u32) -> bool| {
        let mask: Vec<bool> = (0..SIDE * SIDE)
            .map(|i| inside(i % SIDE, i / SIDE))
            .collect();
        compared.scores(Some(&mask)).unwrap().get("structure")
    };
    // Ten columns of blocks, whose right ones end at the edge: none of its pairs.
    close(of(&|x, _| x < 20), 0.0);
    // One column more, of which half of the pixels are enough, has them all: 32 of 10 * 32 + 11 * 31.
    let all = counted((0.51f64 / 1.01).ln()) * 32.0;
    for end in [21, 22] {
        close(of(&|x, _| x < end), all / (10.0 * 32.0 + 11.0 * 31.0));
    }
    assert!(of(&|x, y| (x, y) == (0, 0)).is_nan());
}

#[test]
fn pixels_that_are_no_number_are_left_out_and_odd_sizes_have_smaller_blocks() {
    let odd = |edit: &dyn Fn(u32, u32) -> f32| {
        let rgb = (0..7 * 5).map(|i| [edit(i % 7, i / 7); 3]).collect();
        Linear::radiance((7, 5), rgb)
    };
    // The last column of blocks, one pixel wide, is dark: 3 of 3 * 3 + 4 * 2 pairs.
    let flat = odd(&|_, _| 1.0);
    let dark = odd(&|x, _| if x == 6 { 0.5 } else { 1.0 });
    close(
        structure(&dark, &flat).unwrap(),
        counted((0.51f64 / 1.01).ln()) * 3.0 / 17.0,
    );
    // One pixel of a block is missing: the others speak for it. All are: its two pairs are missing.
    let holed = odd(&|x, y| {
        if (x, y) == (0, 0) {
            f32::NAN
        } else {
            dark.rgb[(y * 7 + x) as usize][0]
        }
    });
    close(
        structure(&holed, &flat).unwrap(),
        structure(&dark, &flat).unwrap(),
    );
    let gone = odd(&|x, y| {
        if x < 2 && y < 2 {
            f32::INFINITY
        } else {
            dark.rgb[(y * 7 + x) as usize][0]
        }
    });
    close(
        structure(&gone, &flat).unwrap(),
        counted((0.51f64 / 1.01).ln()) * 3.0 / 15.0,
    );
}

#[test]
fn bits_do_not_depend_on_the_number_of_threads() {
    let (x, r) = (
        picture(|x, y| random(x, y, 3)),
        picture(|x, y| random(x, y, 4)),
    );
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| scores(&x, &r).unwrap().get("structure").to_bits())
    };
    assert_eq!(with(1), with(5));
}
