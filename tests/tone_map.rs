//! Tone maps against their published formulas, evaluated with 64 bits.

mod common;

use common::{assert_clean, floats, prepare};
use conelab::experiment::Experiment;
use std::fmt::Write;

/// The longest list of colours that the shader takes.
const WIDTH: usize = 512;

/// Greys and saturated colours from 2^-14 to 2^10, black, and values around the limits of formulas.
fn colours() -> Vec<[f32; 3]> {
    let mut list = vec![
        [0.0; 3],
        [0.18; 3],
        [0.08; 3],
        [0.0801, 0.5, 0.8],
        [0.8, 0.7, 0.6],
        [0.81, 0.7, 0.6],
        [0.0, 0.0, 0.76],
    ];
    for exponent in -14..=10 {
        let v = f32::from(exponent as i16).exp2();
        for scale in [
            [1.0, 1.0, 1.0],
            [1.0, 0.25, 0.0],
            [0.125, 1.0, 0.5],
            [0.0, 0.0, 1.0],
            [0.7, 0.8, 0.9],
        ] {
            list.push(scale.map(|s: f32| s * v));
        }
    }
    list
}

/// The colours after the shader of an option, 32-bit floats.
fn shaded(option: &str, colours: &[[f32; 3]]) -> Vec<[f32; 4]> {
    assert!(colours.len() <= WIDTH);
    let home = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        let path = home.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    };
    for name in ["passes/parts/tone.ron", "shaders/display/display.comp"] {
        let text = std::fs::read_to_string(common::root().join(name)).unwrap();
        write(name, &text);
    }
    common::copy(
        &common::root().join("shaders/modules/tone_map"),
        &home.path().join("shaders/modules/tone_map"),
    );
    let mut list = String::new();
    for [r, g, b] in colours {
        let comma = if list.is_empty() { "" } else { ", " };
        write!(list, "{comma}vec3({r:?}, {g:?}, {b:?})").unwrap();
    }
    write(
        "passes/graph.ron",
        r#"(
            include: ["parts/tone.ron"],
            textures: { "source": (size: Screen, format: "rgba32f"), "toned": (size: Screen, format: "rgba32f") },
            passes: [
                (name: "tone", shaders: ["tone.comp"], dispatch: Cover("source")),
                (name: "display", shaders: ["display/display.comp"], dispatch: Cover("display")),
            ],
            output: "display",
            outputs: ["toned"],
        )"#,
    );
    write(
        "configs/run.ron",
        &format!(
            "(graph: \"graph.ron\", scene: \"triangles\", size: ({WIDTH}, 1), params: {{ \"tone_map\": \"{option}\" }})"
        ),
    );
    write(
        "shaders/tone.comp",
        &format!(
            "#version 460
#extension GL_GOOGLE_include_directive : require
#include \"params.glsl\"
#include \"modules/tone_map.glsl\"
layout(local_size_x = 64) in;
uniform writeonly image2D source;
uniform writeonly image2D toned;
const vec3 COLOURS[] = vec3[]({list});
void main() {{
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    vec3 c = at.x < COLOURS.length() ? COLOURS[at.x] : vec3(0.0);
    imageStore(source, at, vec4(c, 1.0));
    imageStore(toned, at, vec4(toneMap(c), 1.0));
}}"
        ),
    );
    let lab = common::lab(home.path());
    let experiment = Experiment::read(&home.path().join("configs/run.ron")).unwrap();
    let mut session = prepare(&lab, &experiment, &["display", "toned"]);
    session.run(1).unwrap();
    assert_clean(&lab);
    let toned = floats(&mut session, "toned", 0);
    let shown = floats(&mut session, "display", 0);
    for ((toned, shown), c) in toned.iter().zip(&shown).zip(colours) {
        for (toned, shown) in toned.iter().zip(shown).take(3) {
            assert!((0.0..=1.0).contains(toned), "{option} of {c:?}: {toned}");
            let encoded = match *toned {
                t if t <= 0.003_130_8 => 12.92 * t,
                t => 1.055 * t.powf(1.0 / 2.4) - 0.055,
            };
            // Half a step of the 8-bit picture, and the driver's rounding.
            assert!(
                (encoded - shown).abs() <= 0.51 / 255.0,
                "{option} of {c:?}: the picture has {shown} instead of {encoded}"
            );
        }
    }
    toned
}

/// Compares an option with its formula.
#[track_caller]
fn agrees(option: &str, tolerance: f64, formula: impl Fn([f64; 3]) -> [f64; 3]) {
    let colours = colours();
    let mut largest = 0.0_f64;
    for (c, found) in colours.iter().zip(shaded(option, &colours)) {
        for (expected, found) in formula(c.map(f64::from)).into_iter().zip(found) {
            let difference = (expected - f64::from(found)).abs();
            assert!(
                difference <= tolerance,
                "{option} of {c:?}: {found} instead of {expected}"
            );
            largest = largest.max(difference);
        }
    }
    println!("{option}: largest difference {largest:.1e}");
}

#[test]
fn curves_for_each_channel_are_their_formulas() {
    agrees("reinhard", 1e-6, |c| c.map(|v| v / (1.0 + v)));
    agrees("none", 0.0, |c| c.map(|v| v.clamp(0.0, 1.0)));
    agrees("aces", 1e-6, |c| {
        c.map(|v| (v * (2.51 * v + 0.03) / (v * (2.43 * v + 0.59) + 0.14)).clamp(0.0, 1.0))
    });
}

/// The specification of Khronos PBR Neutral, term by term.
fn pbr_neutral(c: [f64; 3]) -> [f64; 3] {
    let (f90, ks, kd) = (0.04, 0.8 - 0.04, 0.15);
    let x = c.into_iter().fold(f64::INFINITY, f64::min);
    let f = if x <= 2.0 * f90 {
        x - x.powi(2) / (4.0 * f90)
    } else {
        f90
    };
    let p = c.into_iter().map(|v| v - f).fold(0.0, f64::max);
    if p <= ks {
        return c.map(|v| v - f);
    }
    let pn = 1.0 - (1.0 - ks).powi(2) / (p + 1.0 - 2.0 * ks);
    let g = 1.0 / (kd * (p - pn) + 1.0);
    c.map(|v| (v - f) * pn / p * g + pn * (1.0 - g))
}

#[test]
fn pbr_neutral_is_its_specification() {
    agrees("pbr_neutral", 1e-6, pbr_neutral);
}

/// Purpose of the map: a base colour that reflects white light of irradiance pi, and 0.04 from the dielectric's
/// surface, is shown as it is.
#[test]
fn pbr_neutral_shows_base_colours_as_they_are() {
    let base: [[f32; 3]; 4] = [
        [0.1, 0.2, 0.3],
        [0.5; 3],
        [0.04, 0.04, 0.76],
        [0.7, 0.05, 0.4],
    ];
    let lit = base.map(|c| c.map(|v| v + 0.04));
    for (base, shown) in base.iter().zip(shaded("pbr_neutral", &lit)) {
        for (base, shown) in base.iter().zip(shown) {
            assert!((base - shown).abs() < 1e-6, "{base} became {shown}");
        }
    }
}

/// The curve of AgX in the closed form with expanded constants (github.com/bWFuanVzYWth/AgX).
fn agx_curve(x: f64) -> f64 {
    let d = x - 20.0 / 33.0;
    if d < 0.0 {
        let a = 476_063.0 / 8000.0;
        return 0.5 + 2.0 * d / (1.0 - a * d.powi(3)).cbrt();
    }
    let a = 69.862_789_134_555_39;
    0.5 + 2.0 * d / (1.0 + a * d.powf(3.25)).powf(1.0 / 3.25)
}

fn agx(c: [f64; 3]) -> [f64; 3] {
    // Rows of the inset, and of its inverse as published with six digits.
    let inset = [
        [0.842_479_062_253_094, 0.078_433_6, 0.079_223_745_147_764_3],
        [
            0.042_328_242_261_012_3,
            0.878_468_636_469_772,
            0.079_166_127_460_543_4,
        ],
        [0.042_375_654_905_705_1, 0.078_433_6, 0.879_142_973_793_104],
    ];
    let outset = [
        [
            1.196_879_005_120_17,
            -0.098_020_881_140_136_8,
            -0.099_029_744_079_720_5,
        ],
        [
            -0.052_896_851_757_456_2,
            1.151_903_129_904_17,
            -0.098_961_176_844_843_3,
        ],
        [
            -0.052_971_635_514_443_8,
            -0.098_043_450_117_124_1,
            1.151_073_672_641_16,
        ],
    ];
    let times = |m: [[f64; 3]; 3], v: [f64; 3]| m.map(|r| r[0] * v[0] + r[1] * v[1] + r[2] * v[2]);
    let (low, high) = (-12.473_931_188_332_41, 4.026_068_811_667_588);
    let curve = |v: f64| agx_curve((v.max(1e-300).log2().clamp(low, high) - low) / (high - low));
    times(outset, times(inset, c).map(curve)).map(|v| v.clamp(0.0, 1.0).powf(2.2))
}

/// 2e-5 is 1/200 of a step of an 8-bit picture.
#[test]
fn agx_is_its_formula() {
    agrees("agx", 2e-5, agx);
    // Middle grey is half of the encoded range, black and white are its ends. Rows of the published inset add
    // up to 1 within 1.7e-4.
    let found = shaded("agx", &[[0.18; 3], [0.0; 3], [1000.0; 3], [10.0, 0.0, 0.0]]);
    let half = 0.5_f32.powf(2.2);
    for (found, expected) in found.iter().zip([half, 0.0, 1.0]) {
        assert!(
            found[..3].iter().all(|v| (v - expected).abs() < 5e-4),
            "{found:?} instead of {expected}"
        );
    }
    // Bright red turns towards white.
    assert!(
        found[3][1] > 0.1 && found[3][1] < found[3][0],
        "{:?}",
        found[3]
    );
}
