//! Stability: the definitions on sequences with known answers, and methods whose behaviour is known.

mod common;

use common::{conelab, fails, home, root, succeeds, table};
use conelab::campaign::stability::{Suite, change, flicker, settling, step};
use conelab::metrics::colour::display;
use conelab::metrics::{Kind, Linear};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

fn grey(values: &[f32]) -> Linear {
    Linear::radiance(
        (values.len() as u32, 1),
        values.iter().map(|v| [*v; 3]).collect(),
    )
}

/// A sequence of one pixel as `flicker` takes it: differences to its first frame, and its area.
fn index_of(sequence: &[f32]) -> f64 {
    let differences: Vec<Vec<f32>> = sequence.iter().map(|v| vec![v - sequence[0]]).collect();
    let area = sequence.iter().map(|v| f64::from(*v)).sum();
    flicker(&differences, &[area]).mean
}

/// A constant does not flicker; a sine of amplitude a around 1 has a / pi of its area above the mean; light that is on in
/// one frame of n has 1 - 1/n there.
#[test]
fn flicker_index() {
    assert_eq!(index_of(&[0.3; 24]), 0.0);
    let sine = |a: f32| {
        (0..240)
            .map(|i| 1.0 + a * (std::f32::consts::TAU * i as f32 / 24.0).sin())
            .collect::<Vec<_>>()
    };
    for a in [0.1, 0.5, 1.0] {
        // 24 frames a period: the sum stands for the integral to 1 %.
        assert!(
            (index_of(&sine(a)) - f64::from(a) / std::f64::consts::PI).abs() < 0.01 * f64::from(a)
        );
    }
    assert!((index_of(&[0.0, 0.0, 0.0, 8.0]) - 0.75).abs() < 1e-12);
    assert_eq!(index_of(&[0.0; 8]), 0.0, "black does not flicker");
}

/// What the reference does is no error; a pop in a few pixels is in the percentile and the jump, hardly in the mean.
#[test]
fn change_of_a_frame() {
    let (a, b) = (grey(&[0.1, 0.2, 0.3]), grey(&[0.2, 0.4, 0.1]));
    let none = change([&a, &b], Some([&a, &b]));
    assert_eq!((none.rms, none.p999, none.jump), (0.0, 0.0, 0.0));
    // The reference rises by 1 everywhere, the method in one of four pixels only: errors 0, 1, 1, 1.
    let (x0, x1) = (grey(&[0.0; 4]), grey(&[1.0, 0.0, 0.0, 0.0]));
    let (r0, r1) = (grey(&[0.0; 4]), grey(&[1.0; 4]));
    let c = change([&x0, &x1], Some([&r0, &r1]));
    assert!((c.rms - 0.75f64.sqrt()).abs() < 1e-12 && (c.p999 - 1.0).abs() < 1e-12);
    // 1 is shown as 1/2, which sRGB encodes as 0.7354.
    assert!((c.jump - 255.0 * 0.735_357).abs() < 0.01, "{}", c.jump);
    assert!((display(Kind::Displayed, 1.0) - 1.0).abs() < 1e-9);
    // One pixel in 500 pops.
    let (calm, mut pop) = (vec![0.5; 500], vec![0.5; 500]);
    pop[77] = 1.5;
    let c = change([&grey(&calm), &grey(&pop)], None);
    assert!((c.p999 - 1.0).abs() < 1e-6 && (c.rms - (1.0f64 / 500.0).sqrt()).abs() < 1e-6);
}

/// A step that decays by a factor arrives after log(0.05) / log(factor) frames; one that overshoots says by how much.
#[test]
fn step_response() {
    for factor in [0.0f64, 0.5, 0.8, 0.9] {
        let mut signal = vec![2.0; 3];
        signal.extend((1..200).map(|k| 5.0 - 3.0 * factor.powi(k)));
        let found = step(&signal, 3).unwrap();
        let expected = if factor == 0.0 {
            1
        } else {
            (0.05f64.ln() / factor.ln()).ceil() as usize
        };
        assert_eq!(
            (found.frames, found.overshoot < 1e-6),
            (Some(expected), true),
            "factor {factor}"
        );
    }
    let over = step(&[0.0, 0.0, 6.0, 5.5, 5.0, 5.0, 5.0], 2).unwrap();
    assert_eq!(
        (over.frames, (over.overshoot - 0.2).abs() < 1e-12),
        (Some(3), true)
    );
    let falls = step(&[4.0, -1.0, 0.0, 0.0], 1).unwrap();
    assert_eq!((falls.frames, falls.overshoot), (Some(2), 0.25));
    assert_eq!(
        step(&[0.0, 1.0, 2.0, 3.0, 4.0], 1).unwrap().frames,
        None,
        "it has not arrived"
    );
    assert!(step(&[1.0, 1.0, 1.0], 1).is_none(), "nothing changed");
}

/// A folder with the program's graphs and shaders, so that references and captures are the test's own.
/// A suite on small voxels of the room with the moving box.
fn suite(home: &Path, methods: &str, cases: &str) -> PathBuf {
    let path = home.join("small.ron");
    let text = format!(
        "(experiment: \"configs/rays.ron\", warmup: 3, frames: 4, samples: 32,\n\
         set: {{ \"graph\": \"warps.ron\", \"scene\": \"moving-box\", \"size\": (32, 24), \"voxel_dim\": 32, \"shadow_dim\": 256, \"bounces\": \"one\", \"gather_frames\": 1, \"cone_count\": 2 }},\n\
         methods: {{\n{methods}\n}},\ncases: {{\n{cases}\n}})"
    );
    std::fs::write(&path, text).unwrap();
    path
}

/// Gives a suite a chart.
fn chart(file: &Path, text: &str) {
    let suite = std::fs::read_to_string(file).unwrap();
    std::fs::write(
        file,
        suite.replacen("methods:", &format!("chart: ({text}),\nmethods:"), 1),
    )
    .unwrap();
}

fn stability(home: &Path, file: &Path, folder: &str, more: &[&str]) -> Command {
    let mut command = conelab(home);
    command
        .arg("stability")
        .arg(file)
        .arg("-o")
        .arg(home.join(folder))
        .args(more);
    command
}

/// A column of a method in a case.
#[track_caller]
fn value(
    table: &[BTreeMap<String, String>],
    case: &str,
    method: &str,
    column: &str,
) -> Option<f64> {
    let row = table
        .iter()
        .find(|r| r["case"] == case && r["method"] == method)
        .unwrap();
    row.get(column)
        .unwrap_or_else(|| panic!("no column '{column}'"))
        .parse()
        .ok()
}

/// Where nothing moves, nothing changes: to the bit, in every part, with and without filters over time.
#[test]
fn a_still_scene_is_still() {
    let home = home();
    let methods = "\"uniform\": {}, \"temporal\": { \"graph\": \"temporal.ron\" }, \"tracking\": { \"volume\": \"camera\", \
                   \"volume_size\": (10, 10, 10) }, \"tessellated\": { \"voxelizer\": \"tessellated\" }, \"turns\": { \"gather_frames\": 4 }";
    let file = suite(
        home.path(),
        methods,
        "\"still\": (), \"yaw\": (motion: Camera(yaw: 1))",
    );
    succeeds(&mut stability(
        home.path(),
        &file,
        "out",
        &["--no-reference"],
    ));
    let table = table(&home.path().join("out/stability.csv"));
    for method in ["uniform", "temporal", "tracking", "tessellated", "turns"] {
        for part in ["total", "direct", "diffuse", "specular", "occlusion"] {
            for column in [
                "E_t",
                "pops",
                "peak jump /255",
                "flicker mean",
                "flicker p99",
            ] {
                assert_eq!(
                    value(&table, "still", method, &format!("{part} {column}")),
                    Some(0.0),
                    "{method} {part}"
                );
            }
        }
        // Without a reference nobody knows how a moving camera's picture should change.
        assert_eq!(value(&table, "yaw", method, "total E_t"), None);
        assert_eq!(value(&table, "yaw", method, "total flicker mean"), None);
    }
}

/// A path tracer with other random numbers as the method: two pictures of s samples each differ by 2/s, the two halves of
/// one by 4/s of a sample's variance, so E_t is 0.71 of the noise that is reported, and not told apart from it.
#[test]
fn the_reference_as_a_method_is_at_its_own_noise() {
    let home = home();
    let methods = "\"path tracer\": { \"graph\": \"reference.ron\", \"samples\": 64, \"bounces\": 1, \"seed\": 7 }";
    let file = suite(
        home.path(),
        methods,
        "\"yaw\": (warmup: 0, motion: Camera(yaw: 0.5)), \"box\": (warmup: 0, motion: Actors(step: 0.1))",
    );
    // There the number of bounces has the name of the method's choice.
    std::fs::write(
        &file,
        std::fs::read_to_string(&file)
            .unwrap()
            .replace(", \"bounces\": \"one\"", ""),
    )
    .unwrap();
    succeeds(&mut stability(home.path(), &file, "out", &["--spp", "64"]));
    let table = table(&home.path().join("out/stability.csv"));
    for case in ["yaw", "box"] {
        let of = |column: &str| value(&table, case, "path tracer", column).unwrap();
        let ratio = of("diffuse E_t") / of("diffuse E_t noise");
        assert!(
            (0.5..1.0).contains(&ratio),
            "{case}: E_t is {ratio} of the noise"
        );
        assert!(
            of("direct E_t") < 1e-6,
            "direct light of lights without extent has no noise"
        );
        let row = table.iter().find(|r| r["case"] == case).unwrap();
        assert_eq!(row["diffuse told apart"], "no");
        assert!(of("diffuse flicker mean") < of("diffuse flicker noise"));
    }
}

/// T11: a lamp is switched on. Without a filter the voxels follow at once; with one that keeps a part f of the frame before,
/// 5 % are left after log(0.05) / log(f) frames.
#[test]
fn a_switched_light_arrives_as_late_as_the_filter_says() {
    let home = home();
    let methods = "\"none\": {}, \"turns\": { \"gather_frames\": 8 }, \"half\": { \"graph\": \"temporal.ron\", \"temporal_factor\": 0.5 }, \"slow\": { \"graph\": \"temporal.ron\", \"temporal_factor\": 0.8 }";
    let cases = "\"on\": (frames: 40, motion: Switch(name: \"lamp\", at: 1, from: 0, to: 1)), \
                 \"off\": (frames: 40, motion: Switch(name: \"lamp\", at: 1, from: 1, to: 0.2))";
    let file = suite(home.path(), methods, cases);
    succeeds(&mut stability(
        home.path(),
        &file,
        "out",
        &["--no-reference"],
    ));
    let table = table(&home.path().join("out/stability.csv"));
    for case in ["on", "off"] {
        for (method, factor) in [("none", 0.0f64), ("half", 0.5), ("slow", 0.8)] {
            let expected = if factor == 0.0 {
                1.0
            } else {
                (0.05f64.ln() / factor.ln()).ceil()
            };
            assert_eq!(
                value(&table, case, method, "diffuse convergence frames"),
                Some(expected),
                "{case} {method}"
            );
            assert!(value(&table, case, method, "diffuse overshoot").unwrap() < 0.01);
            assert_eq!(
                value(&table, case, method, "direct convergence frames"),
                Some(1.0),
                "the filter is for voxels"
            );
        }
        // In turns of eight frames an eighth of the pixels follows each frame: seven leave more than 5 %. The
        // filter prefers those that have followed.
        let frames = value(&table, case, "turns", "diffuse convergence frames").unwrap();
        assert!(frames < 8.0, "{case} in turns: {frames}");
    }
}

/// After a cut an error that falls by a factor to its last value has settled when 5 % of that are left of the rest.
#[test]
fn settling_frames() {
    let mut errors = vec![9.0; 3];
    errors.extend((1..200).map(|k| 0.5 + 4.0 * 0.8f64.powi(k)));
    // 4 f^k <= 0.05 * 0.5
    assert_eq!(
        settling(&errors, 3),
        Some((0.05f64 * 0.5 / 4.0).log(0.8).ceil() as usize)
    );
    assert_eq!(settling(&[7.0, 1.0, 1.0, 1.0], 1), Some(1));
    assert_eq!(
        settling(&[7.0, 1.0, 0.9, 1.0, 1.0], 1),
        Some(3),
        "below is not settled either"
    );
    assert_eq!(
        settling(&[7.0, 4.0, 3.0, 2.0], 1),
        None,
        "it has not arrived"
    );
    assert_eq!(
        settling(&[7.0, f64::NAN, 1.0, 1.0], 1),
        None,
        "nobody knows"
    );
    assert_eq!(settling(&[7.0, 0.0, 0.0], 1), Some(1));
}

/// The camera jumps: a volume around the whole scene does not notice; one that follows has other cells, and with a filter
/// over time what it kept of those before fades. After the cut all frames share one reference, so two
/// pictures are all it needs.
#[test]
fn a_cut_and_a_path() {
    let home = home();
    let path = home.path().join("turn.ron");
    std::fs::write(&path, "(keys: [(time: 0, eye: (0, 1.5, 2.5), target: (0, 1, 0), fov_y: 60), (time: 1, eye: (1, 1.5, 2.5), target: (0, 1, 0), fov_y: 60)])").unwrap();
    let methods = "\"uniform\": {}, \"filtered\": { \"volume\": \"camera\", \"volume_size\": (10, 10, 10), \"volume_snap\": \"off\", \"graph\": \"temporal.ron\" }";
    let to = "(eye: (0.9, 1.4, 1.9), target: (0, 1, -1), fov_y: 60)";
    let cases = format!(
        "\"cut\": (warmup: 2, frames: 40, motion: Cut(to: {to}, at: 2)), \
         \"path\": (warmup: 0, frames: 3, motion: Path(file: \"turn.ron\", from: 0.5, step: 0.5))"
    );
    let file = suite(home.path(), methods, &cases);
    succeeds(&mut stability(home.path(), &file, "out", &[]));
    let references = std::fs::read_dir(home.path().join("captures/reference"))
        .unwrap()
        .count();
    // The path ends after a second, at its last key: two of its three frames are one picture.
    assert_eq!(references, 2 + 2);
    let results = table(&home.path().join("out/stability.csv"));
    assert_eq!(
        value(&results, "cut", "uniform", "diffuse settling frames"),
        Some(1.0)
    );
    assert_eq!(
        value(&results, "cut", "uniform", "diffuse convergence frames"),
        None,
        "another view is no step"
    );
    assert_eq!(
        value(&results, "path", "uniform", "diffuse settling frames"),
        None
    );
    let frames = table(&home.path().join("out/frames.csv"));
    let change = |method: &str, frame: &str| {
        let is = |r: &&BTreeMap<String, String>| {
            [&*r["case"], &*r["method"], &*r["part"], &*r["frame"]]
                == ["cut", method, "diffuse", frame]
        };
        frames.iter().find(is).unwrap()["E_t"]
            .parse::<f64>()
            .unwrap()
    };
    // The third frame is the first after the cut.
    assert_eq!(change("uniform", "3"), 0.0);
    let faded = ["3", "24"].map(|frame| change("filtered", frame));
    // 18.9 on an NVIDIA H200.
    let least = if common::on_software() { 20.0 } else { 15.0 };
    assert!(
        faded[0] > least * faded[1],
        "what was kept does not fade: {faded:?}"
    );
    let changes: Vec<f64> = frames
        .iter()
        .filter(|r| r["case"] == "path" && r["method"] == "uniform" && r["part"] == "total")
        .filter_map(|r| r["reference mean luminance"].parse().ok())
        .collect();
    assert!(
        changes[0] != changes[1] && changes[1] == changes[2],
        "{changes:?}"
    );
}

/// What moves makes references of its own, and what stands still shares them: 2 frames each of camera, actor and light that
/// begin alike are 4 pictures.
#[test]
fn references_know_what_moved() {
    let home = home();
    let cases = "\"camera\": (motion: Camera(strafe: 0.1)), \"actor\": (motion: Actors(step: 0.2)), \
                 \"light\": (motion: Light(name: \"lamp\", shift: (0, -0.1, 0))), \"still\": ()";
    let file = suite(
        home.path(),
        "\"uniform\": {}, \"warped\": { \"warp\": \"spline\" }",
        cases,
    );
    succeeds(&mut stability(
        home.path(),
        &file,
        "out",
        &["--frames", "2"],
    ));
    let kept = || {
        std::fs::read_dir(home.path().join("captures/reference"))
            .unwrap()
            .count()
    };
    assert_eq!(kept(), 4);
    let page = std::fs::read_to_string(home.path().join("out/index.html")).unwrap();
    let pictures: Vec<_> = std::fs::read_dir(home.path().join("out/pictures"))
        .unwrap()
        .map(|e| e.unwrap().file_name())
        .collect();
    assert_eq!(pictures.len(), 8);
    assert!(
        pictures
            .iter()
            .all(|p| page.contains(&*p.to_string_lossy())),
        "every worst frame is named in the page"
    );
}

/// A volume that moves while pixels stand still: there the reference's change is 0 to the bit and no reference is
/// needed. One that snaps to its own cells (31 cm) stands still until it crosses half of one; one that does not pops in
/// every frame.
#[test]
fn a_parameter_moves() {
    let home = home();
    // Filtered levels see where cells lie; exact surfels move by whole cells unseen.
    let volume = "\"volume\": \"camera\", \"volume_size\": (10, 10, 10), \"diffuse_aperture\": 40, \"lod_offset\": 0";
    let methods = format!(
        "\"snapped\": {{ {volume}, \"volume_snap\": \"voxel\" }}, \"free\": {{ {volume}, \"volume_snap\": \"off\" }}"
    );
    let cases = "\"volume\": (warmup: 0, frames: 12, motion: Parameter(name: \"volume_offset\", step: (0.03, 0, 0))), \
                 \"back\": (warmup: 2, frames: 3, motion: Parameter(name: \"volume_offset\", values: [(0, 0, 0), (0.5, 0, 0), (0, 0, 0)])), \
                 \"raised\": (frames: 3, motion: Parameter(name: \"bias\", values: [1, 4, 4]))";
    let file = suite(home.path(), &methods, cases);
    succeeds(&mut stability(
        home.path(),
        &file,
        "out",
        &["--no-reference"],
    ));
    let frames = table(&home.path().join("out/frames.csv"));
    let of = |case: &str, method: &str, column: &str| -> Vec<f64> {
        let own = frames
            .iter()
            .filter(|r| r["case"] == case && r["method"] == method && r["part"] == "diffuse");
        own.filter_map(|r| r[column].parse().ok()).collect()
    };
    let jumps = of("volume", "snapped", "peak jump /255");
    assert_eq!(jumps.len(), 11, "changes are known without a reference");
    // 33 cm on the way: past one border, or two.
    let moved = jumps.iter().filter(|j| **j > 0.0).count();
    assert!((1..=2).contains(&moved), "{jumps:?}");
    assert!(
        of("volume", "free", "peak jump /255")
            .iter()
            .all(|j| *j > 0.0)
    );
    for method in ["snapped", "free"] {
        let back = of("back", method, "mean luminance");
        assert!(
            back[0] == back[2] && back[0] != back[1],
            "{method} is where it was: {back:?}"
        );
        let raised = of("raised", method, "mean luminance");
        assert!(
            raised[1] != raised[0] && raised[1] == raised[2],
            "{method}: {raised:?}"
        );
    }
}

/// A parameter that references have too moves the reference.
#[test]
fn a_parameter_that_references_have_too() {
    let home = home();
    let edit = |file: &str, old: &str, new: &str| {
        let path = home.path().join(file);
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.contains(old), "{file}");
        std::fs::write(path, text.replacen(old, new, 1)).unwrap();
    };
    let declared = "params: [\n        Float(name: \"mirrored\", default: 1.0, help: \"Scales reflectance.\"),";
    edit("passes/parts/surface.ron", "params: [", declared);
    edit(
        "shaders/common/brdf.glsl",
        "vec3 f0 = mix(",
        "vec3 f0 = params.mirrored * mix(",
    );
    let cases = "\"lobe\": (warmup: 0, frames: 3, motion: Parameter(name: \"mirrored\", values: [1, 0.5, 0.5]))";
    let file = suite(
        home.path(),
        "\"a\": { \"scene\": \"configs/stability/scenes/metal-rough.ron\" }",
        cases,
    );
    succeeds(&mut stability(home.path(), &file, "out", &[]));
    let references = std::fs::read_dir(home.path().join("captures/reference"))
        .unwrap()
        .count();
    assert_eq!(references, 2);
    let frames = table(&home.path().join("out/frames.csv"));
    let own = frames.iter().filter(|r| r["part"] == "specular");
    let reference: Vec<&str> = own
        .map(|r| r["reference mean luminance"].as_str())
        .collect();
    assert!(
        reference[0] != reference[1] && reference[1] == reference[2],
        "{reference:?}"
    );
    // Without references nobody knows the reference's change.
    succeeds(&mut stability(
        home.path(),
        &file,
        "none",
        &["--no-reference"],
    ));
    assert_eq!(
        value(
            &table(&home.path().join("none/stability.csv")),
            "lobe",
            "a",
            "total E_t"
        ),
        None
    );
}

/// Two panels: methods as they are, and one whose voxels were made so many that it is as fast as the first. A
/// second run measures nothing and says the same.
#[test]
fn equal_cost() {
    let home = home();
    let methods =
        "\"first\": {}, \"large\": { \"voxel_dim\": 64 }, \"fitted\": { \"warp\": \"spline\" }";
    let file = suite(
        home.path(),
        methods,
        "\"still\": (), \"strafe\": (motion: Camera(strafe: 0.1)), \"yaw\": (motion: Camera(yaw: 2))",
    );
    chart(
        &file,
        "error: [\"still\"], motions: [\"strafe\", \"yaw\"], \
         groups: { \"as they are\": [\"first\", \"large\"], \"equal time\": [\"first\", \"fitted\"] }, \
         equal_time: (parameter: \"voxel_dim\", values: [16, 48, 96], methods: [\"fitted\"])",
    );
    succeeds(&mut stability(home.path(), &file, "out", &[]));
    let out = |name: &str| std::fs::read_to_string(home.path().join("out").join(name)).unwrap();
    let costs = table(&home.path().join("out/cost.csv"));
    let results = table(&home.path().join("out/stability.csv"));
    let groups: Vec<&str> = costs.iter().map(|r| r["group"].as_str()).collect();
    assert_eq!(
        groups,
        ["as they are", "as they are", "equal time", "equal time"]
    );
    let cell = |method: &str, column: &str| {
        costs.iter().find(|r| r["method"] == method).unwrap()[column].clone()
    };
    let number = |method: &str, column: &str| cell(method, column).parse::<f64>().unwrap();
    // The chart's values are those of the cases.
    assert_eq!(
        number("large", "diffuse relMSE"),
        value(&results, "still", "large", "diffuse relMSE").unwrap()
    );
    let moving = ["strafe", "yaw"].map(|c| value(&results, c, "large", "diffuse E_t").unwrap());
    assert!(
        (number("large", "diffuse E_t") - ((moving[0].powi(2) + moving[1].powi(2)) / 2.0).sqrt())
            .abs()
            < 1e-12
    );
    // Queues of threads, which draw on hardware, are as large for any grid.
    let times = if common::on_software() { 4.0 } else { 1.0 };
    assert!(number("large", "memory MiB") > times * number("first", "memory MiB"));
    assert!(
        value(&results, "still", "large", "memory MiB").unwrap() >= number("large", "memory MiB")
    );
    // The two values next to the first method's time were timed, the nearer was taken, and the cases ran with it.
    let json: serde_json::Value = serde_json::from_str(&out("stability.json")).unwrap();
    let fitted = json["costs"]
        .as_array()
        .unwrap()
        .iter()
        .find(|c| c["method"] == "fitted")
        .unwrap();
    let median = |list: &serde_json::Value, first: &serde_json::Value| {
        let pairs = list
            .as_array()
            .unwrap()
            .iter()
            .zip(first.as_array().unwrap());
        let mut ratios: Vec<f64> = pairs
            .map(|(a, b)| a.as_f64().unwrap() / b.as_f64().unwrap())
            .collect();
        ratios.sort_by(f64::total_cmp);
        ratios[ratios.len() / 2]
    };
    let candidates = fitted["candidates"].as_array().unwrap();
    let timed: Vec<usize> = (0..3)
        .filter(|i| !candidates[*i]["ms"].as_array().unwrap().is_empty())
        .collect();
    assert!(timed == [0, 1] || timed == [1, 2], "{timed:?}");
    let off = |i: usize| {
        median(&candidates[i]["ms"], &candidates[i]["first_ms"])
            .ln()
            .abs()
    };
    let chosen = fitted["chosen"].as_u64().unwrap() as usize;
    assert!(
        timed.contains(&chosen) && timed.iter().all(|i| off(*i) >= off(chosen)),
        "{timed:?}, chosen {chosen}"
    );
    assert_eq!(
        cell("fitted", "setting"),
        format!("voxel_dim = {}", [16, 48, 96][chosen])
    );
    let sizes = [16u64, 48, 96]
        .map(|d| d.pow(3))
        .into_iter()
        .collect::<Vec<_>>();
    let memory = |i: usize| candidates[i]["memory_bytes"].as_u64().unwrap();
    let (a, b) = (timed[0], timed[1]);
    assert!(
        memory(b) - memory(a) > 4 * (sizes[b] - sizes[a]),
        "bytes grow with the voxels"
    );
    let svg = out("charts/cost.svg");
    assert!(
        ["as they are", "equal time", "first", "large", "fitted"]
            .iter()
            .all(|t| svg.contains(t))
    );
    assert!(out("index.html").contains(&svg) && out("index.html").contains("What stability costs"));
    // What was chosen is taken again.
    let before = ["cost.json", "cost.csv", "charts/cost.svg", "stability.json"].map(out);
    let message = succeeds(&mut stability(home.path(), &file, "out", &[]));
    assert!(message.contains("9 done, 0 failed"), "{message}");
    assert_eq!(
        before,
        ["cost.json", "cost.csv", "charts/cost.svg", "stability.json"].map(out)
    );
}

/// Killed as soon as something is finished and started again: what was finished stays, and the tables are those of a run
/// that was left alone.
#[test]
fn killed_and_continued() {
    let home = home();
    let methods =
        "\"a\": {}, \"b\": { \"graph\": \"temporal.ron\" }, \"c\": { \"warp\": \"spline\" }";
    let cases = "\"still\": (), \"yaw\": (motion: Camera(yaw: 0.5)), \"on\": (frames: 6, motion: Switch(name: \"lamp\", at: 1, from: 0, to: 1))";
    let file = suite(home.path(), methods, cases);
    let results = home.path().join("out/results");
    let finished = || -> BTreeMap<String, Vec<u8>> {
        let entries = std::fs::read_dir(&results).into_iter().flatten().flatten();
        let named = entries
            .map(|e| e.file_name().to_string_lossy().into_owned())
            .filter(|n| !n.starts_with('.'));
        named
            .map(|n| (n.clone(), std::fs::read(results.join(&n)).unwrap()))
            .collect()
    };
    let mut child = stability(home.path(), &file, "out", &[])
        .stderr(Stdio::null())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    while finished().len() < 2 && begun.elapsed() < Duration::from_secs(300) {
        std::thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let before = finished();
    assert!(
        (2..9).contains(&before.len()),
        "{} of 9 were finished",
        before.len()
    );
    let message = succeeds(&mut stability(home.path(), &file, "out", &[]));
    assert!(
        message.contains(&format!("{} already done", before.len())),
        "{message}"
    );
    let after = finished();
    assert_eq!(after.len(), 9);
    assert!(
        before.iter().all(|(name, bytes)| after[name] == *bytes),
        "what was finished is kept as it was"
    );
    succeeds(&mut stability(home.path(), &file, "whole", &[]));
    for name in ["stability.csv", "frames.csv"] {
        assert_eq!(
            table(&home.path().join("out").join(name)),
            table(&home.path().join("whole").join(name))
        );
    }
}

/// One page with the worst cases of each method: pictures, names and numbers.
#[test]
fn a_sheet_of_failures() {
    let home = home();
    let methods = "\"fine\": {}, \"coarse\": { \"voxel_dim\": 16 }";
    let cases = "\"still\": (frames: 1, variants: { \"lit\": {}, \"dark\": { \"sky\": (0, 0, 0) } }), \"strafe\": (motion: Camera(strafe: 0.2))";
    let file = suite(home.path(), methods, cases);
    let text = std::fs::read_to_string(&file).unwrap();
    std::fs::write(
        &file,
        text.replacen("methods:", "pictures: \"diffuse\", methods:", 1),
    )
    .unwrap();
    let sheet = home.path().join("failures.html");
    let message = succeeds(&mut stability(
        home.path(),
        &file,
        "out",
        &["--sheet", sheet.to_str().unwrap()],
    ));
    let page = std::fs::read_to_string(&sheet).unwrap();
    assert_eq!(page.matches("src=\"data:image/png;base64,").count(), 4);
    let rows: Vec<Vec<&str>> = message
        .lines()
        .filter(|l| l.starts_with("| "))
        .skip(1)
        .map(|l| l.split(" | ").collect())
        .collect();
    let names: Vec<(&str, &str)> = rows.iter().map(|r| (r[0].trim_end(), &r[2][..5])).collect();
    assert_eq!(
        names,
        [
            ("| fine", "relMS"),
            ("| fine", "E_t o"),
            ("| coarse", "relMS"),
            ("| coarse", "E_t o")
        ]
    );
    // The number is the largest of the method's cases of one frame.
    let results = table(&home.path().join("out/stability.csv"));
    let errors = results
        .iter()
        .filter(|r| r["method"] == "coarse" && r["case"] == "still");
    let worst = errors
        .max_by(|a, b| {
            a["diffuse relMSE"]
                .parse::<f64>()
                .unwrap()
                .total_cmp(&b["diffuse relMSE"].parse().unwrap())
        })
        .unwrap();
    assert_eq!(
        rows[2][1].trim_end(),
        format!("still: {}", worst["variant"])
    );
    for row in &rows {
        let (metric, number) = row[2].split_once(" of diffuse ").unwrap();
        let number = number.split(',').next().unwrap().trim();
        let figure = format!(": {metric} of diffuse {number} (noise ");
        let method = format!(
            "<b>{}</b>, {}",
            row[0].trim_matches(['|', ' ']),
            row[1].trim()
        );
        assert!(page.contains(&format!("{method}{figure}")), "{row:?}");
    }
    let wrong = fails(&mut stability(
        home.path(),
        &file,
        "out",
        &["--sheet", "failures.jpg"],
    ));
    assert!(wrong.contains(".html"), "{wrong}");
}

/// The shipped suites are right and run, small: every motion with three methods, every method where nothing moves and where what
/// it follows turns, and two of the failures are as the physics says. The courtyard's is too long for a software device.
#[test]
fn shipped_suites() {
    let home = home();
    for name in ["motion", "edges", "failures", "cost", "atrium"] {
        let path = root().join(format!("configs/stability/{name}.ron"));
        assert!(Suite::read(&path).unwrap().cases.len() >= 4);
        succeeds(conelab(home.path()).arg("check").arg(path));
    }
    let small = [
        "--size",
        "24x18",
        "--frames",
        "2",
        "--spp",
        "32",
        "--set",
        "voxel_dim=24",
        "--set",
        "shadow_dim=256",
    ];
    let small = [
        &small[..],
        &["--set", "bounces=one", "--set", "gather_frames=1"],
    ]
    .concat();
    // All rays in each frame: only the temporal filter, which must rest where nothing moves, needs many before those measured.
    let all = |suite: &str, more: &[&str]| {
        let text =
            std::fs::read_to_string(root().join(format!("configs/stability/{suite}.ron"))).unwrap();
        let at_root = |text: String, name: &str| {
            text.replace(
                &format!("../{name}"),
                &root().join("configs").join(name).to_string_lossy(),
            )
        };
        let text = at_root(at_root(text, "rays.ron"), "cones.ron");
        let (head, cases) = text.split_once("cases: {").unwrap();
        let head = ["warmup: 110,", "warmup: 40,"]
            .iter()
            .fold(head.to_string(), |t, w| t.replace(w, "warmup: 2,"));
        let file = home.path().join(format!("{suite}.ron"));
        let cases = cases.replace("\"still\": (", "\"still\": (warmup: 32, ");
        std::fs::write(&file, format!("{head}cases: {{{cases}")).unwrap();
        succeeds(&mut stability(
            home.path(),
            &file,
            suite,
            &[&small[..], more].concat(),
        ));
        let rows = table(&home.path().join(suite).join("stability.csv"));
        assert!(
            rows.iter().all(|r| r["error"].is_empty()),
            "{suite}: {rows:?}"
        );
        rows
    };
    all("motion", &["--methods", "tracking,temporal"]);
    let motion = all("motion", &["--only", "still,turn"]);
    let number = |r: &BTreeMap<String, String>, column: &str| r[column].parse::<f64>().unwrap();
    // A mean goes on where each frame samples other places of a pixel.
    let rests =
        |r: &&BTreeMap<String, String>| r["case"] == "still" && r["method"] != "anti-aliased rays";
    for row in motion.iter().filter(rests) {
        assert_eq!(
            number(row, "total E_t"),
            0.0,
            "{}: nothing moves",
            row["method"]
        );
    }
    // Pixels stand still there, so that no reference's noise is in the numbers.
    let turned = |method: &str| {
        number(
            motion
                .iter()
                .find(|r| r["case"] == "turn" && r["method"] == method)
                .unwrap(),
            "diffuse E_t",
        )
    };
    let changes = ["spherical warp", "perspective warp"].map(turned);
    assert!(
        changes[0] < changes[1],
        "cells that do not turn with the camera flicker less: {changes:?}"
    );

    let file = root().join("configs/stability/failures.ron");
    let more = [
        "--size",
        "40x30",
        "--spp",
        "32",
        "--set",
        "voxel_dim=32",
        "--only",
        "volume off the scene,thin walls",
    ];
    succeeds(&mut stability(home.path(), &file, "out", &more));
    let table = table(&home.path().join("out/stability.csv"));
    let nothing = table.iter().find(|r| r["variant"] == "nothing").unwrap();
    // The lamps' own light, which nothing hides there.
    let left = number(nothing, "diffuse energy ratio");
    assert!(
        left < 0.2,
        "a volume without the scene has no light to give but that of lamps: {left}"
    );
    assert_eq!(
        nothing["direct relMSE"],
        table.iter().find(|r| r["variant"] == "half").unwrap()["direct relMSE"]
    );
    for row in table.iter().filter(|r| r["case"] == "thin walls") {
        let recall: f64 = row["voxel recall"].parse().unwrap();
        let least = if row["method"] == "tessellated" {
            0.9
        } else {
            1.0
        };
        assert!(recall >= least, "{}: recall {recall}", row["method"]);
    }
}

/// Mistakes are reported before anything is measured.
#[test]
fn mistakes() {
    let home = home();
    let message = |methods: &str, cases: &str, more: &[&str]| {
        let file = suite(home.path(), methods, cases);
        fails(&mut stability(home.path(), &file, "out", more))
    };
    let has = |text: String, part: &str| assert!(text.contains(part), "{text}");
    has(
        message("\"a\": {}", "\"x\": (motion: Light(name: \"sun\"))", &[]),
        "has no light 'sun'; it has lamp",
    );
    has(
        message(
            "\"a\": {}",
            "\"x\": (set: { \"scene\": \"cornell\" }, motion: Actors(step: 0.1))",
            &[],
        ),
        "nothing is animated",
    );
    has(
        message("\"a\": {}", "\"x\": ()", &["--only", "y"]),
        "the suite's cases are x",
    );
    has(
        message("\"a\": { \"voxel_dimm\": 3 }", "\"x\": ()", &[]),
        "voxel_dim",
    );
    has(
        message("\"a\": {}", "\"x\": (methods: [\"b\"])", &[]),
        "none of the suite's",
    );
    has(
        message("\"a\": {}", "\"x\": (motion: Camera(dolley: 1))", &[]),
        "dolley",
    );
    has(
        message(
            "\"a\": {}",
            "\"x\": (motion: Switch(name: \"lamp\", at: 9, from: 0, to: 1))",
            &[],
        ),
        "needs two frames more, there are 4",
    );
    let moves = |text: &str| {
        message(
            "\"a\": {}",
            &format!("\"x\": (motion: Parameter(name: {text}))"),
            &[],
        )
    };
    has(moves("\"volume_ofset\", step: (1, 0, 0)"), "volume_offset");
    has(moves("\"volume_offset\", step: 1"), "expected 3 numbers");
    has(moves("\"volume_offset\""), "either a `step` or `values`");
    has(moves("\"volume\", step: 1"), "no option '1'");
    has(moves("\"bias\", step: 3"), "outside 0 to 8");
    has(
        moves("\"warp\", values: [\"none\"]"),
        "compiled into the shaders",
    );
    let charts = |text: &str| {
        let file = suite(
            home.path(),
            "\"a\": {}, \"b\": {}",
            "\"x\": (methods: [\"a\"]), \"y\": ()",
        );
        chart(&file, text);
        fails(&mut stability(home.path(), &file, "out", &[]))
    };
    has(
        charts("error: [\"z\"], motions: [\"y\"]"),
        "the case 'z', which is none",
    );
    has(
        charts("error: [\"x\"], motions: [\"y\"]"),
        "the method 'b' in the case 'x'",
    );
    has(
        charts("error: [\"y\"], motions: []"),
        "at least one case for `error`",
    );
    has(
        charts("error: [\"y\"], motions: [\"y\"], groups: { \"g\": [\"c\"] }"),
        "the method 'c'",
    );
    let equal = |text: &str| {
        charts(&format!(
            "error: [\"y\"], motions: [\"y\"], equal_time: (parameter: {text})"
        ))
    };
    has(
        equal("\"voxel_dim\", values: [32], methods: [\"a\"]"),
        "'a' is the suite's first method",
    );
    has(
        equal("\"voxel_dimm\", values: [32], methods: [\"b\"]"),
        "voxel_dim",
    );
    has(
        equal("\"voxel_dim\", values: [3], methods: [\"b\"]"),
        "outside 16 to 512",
    );
    has(
        message(
            "\"a\": {}",
            "\"x\": (motion: Cut(to: \"behind\", at: 1))",
            &[],
        ),
        "no camera 'behind'",
    );
    has(
        message(
            "\"a\": {}",
            "\"x\": (motion: Cut(to: \"default\", at: 0))",
            &[],
        ),
        "`at` of 1 or more",
    );
    has(
        message(
            "\"a\": {}",
            "\"x\": (motion: Path(file: \"none.ron\", step: 1))",
            &[],
        ),
        "none.ron",
    );
    let file = suite(home.path(), "\"a\": {}", "\"x\": ()");
    let text = std::fs::read_to_string(&file).unwrap();
    std::fs::write(
        &file,
        text.replacen("methods:", "pictures: \"glow\", methods:", 1),
    )
    .unwrap();
    has(
        fails(&mut stability(home.path(), &file, "out", &[])),
        "no pictures of 'glow'",
    );
    has(message("", "\"x\": ()", &[]), "at least one method");
    assert!(!home.path().join("out").exists(), "nothing was written");
}
