//! `conelab compare`: what it says of pictures whose errors are known, and of experiments against a reference.

mod common;

use common::{conelab, fails, home, root, succeeds, table_with_times};
use conelab::metrics::Linear;
use conelab::results::picture;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

fn compare() -> Command {
    let mut command = conelab(root());
    command.arg("compare");
    command
}

/// Writes a picture of 16 x 8 pixels.
fn exr(folder: &TempDir, name: &str, rgb: impl Fn(u32, u32) -> [f32; 3]) -> PathBuf {
    let rgb = (0..128).map(|i| rgb(i % 16, i / 16)).collect();
    let path = folder.path().join(name);
    picture::write_linear(&path, &Linear::radiance((16, 8), rgb)).unwrap();
    path
}

fn png(folder: &TempDir, name: &str, grey: impl Fn(u32, u32) -> u8) -> PathBuf {
    let path = folder.path().join(name);
    image::GrayImage::from_fn(16, 8, |x, y| image::Luma([grey(x, y)]))
        .save(&path)
        .unwrap();
    path
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

/// The scores of a picture in a region of the first part.
fn score<'a>(json: &'a Value, region: &str, picture: usize) -> &'a Value {
    let regions = json["parts"][0]["regions"].as_array().unwrap();
    let found = regions.iter().find(|r| r["region"] == region);
    &found.unwrap_or_else(|| panic!("no region '{region}' in {regions:?}"))["scores"][picture]
}

#[test]
fn two_pictures_beside_a_third_each_get_their_numbers_and_the_nearer_wins() {
    let folder = tempfile::tempdir().unwrap();
    let r = exr(&folder, "r.exr", |x, _| [if x < 4 { 0.0 } else { 1.0 }; 3]);
    let a = exr(&folder, "a.exr", |x, _| [if x < 4 { 0.0 } else { 1.1 }; 3]);
    let b = exr(&folder, "b.exr", |x, y| {
        if (x, y) == (5, 5) {
            [f32::NAN; 3]
        } else {
            [if x < 4 { 0.1 } else { 1.5 }; 3]
        }
    });
    let mask = png(&folder, "left.png", |x, _| if x < 8 { 255 } else { 0 });
    let (out, maps) = (folder.path().join("c.json"), folder.path().join("maps"));
    let said = succeeds(
        compare()
            .args([&a, &b])
            .arg("--reference")
            .arg(&r)
            .args(["--mask", &format!("left half={}", mask.display()), "--json"])
            .arg(&out)
            .arg("--maps")
            .arg(&maps),
    );
    assert!(
        said.contains("B: 1 pixels are infinite or no number"),
        "{said}"
    );
    let json = json(&out);
    assert_eq!(json["schema"], "conelab-compare-1");
    let near = |v: &Value, expected: f64| {
        assert!(
            (v.as_f64().unwrap() - expected).abs() < 1e-5,
            "{v}: {expected}"
        )
    };
    near(&score(&json, "frame", 0)["relmse"], 0.75 * 0.01 / 1.01);
    near(&score(&json, "frame", 0)["energy_ratio"], 1.1);
    near(&score(&json, "frame", 1)["leak"], 0.1);
    near(&score(&json, "dark", 0)["leak"], 0.0);
    near(
        &score(&json, "left half", 0)["rmse"],
        (0.01f64 / 2.0).sqrt(),
    );
    near(&score(&json, "left half", 0)["pixels"], 64.0);
    assert_eq!(score(&json, "frame", 1)["not_finite"], 1);
    assert_eq!(json["parts"][0]["regions"][0]["better"]["relmse"], "A");
    let mut files: Vec<String> = std::fs::read_dir(&maps)
        .unwrap()
        .map(|f| f.unwrap().file_name().into_string().unwrap())
        .collect();
    files.sort();
    let of = |letter: &str| {
        [
            "flip.png",
            "hdr-flip.png",
            "luminance.png",
            "maps.exr",
            "relative-error.png",
            "structure.png",
        ]
        .map(|f| format!("{letter}-total-{f}"))
    };
    assert_eq!(files, [of("a"), of("b")].concat());
    // A is too bright on the right, as much as a tenth of what is full red, and right on the left.
    let map = image::open(maps.join("a-total-luminance.png"))
        .unwrap()
        .to_rgb8();
    assert_eq!(map.get_pixel(0, 0).0, [255; 3]);
    let [red, green, blue] = map.get_pixel(12, 4).0;
    assert!(red > green && red > blue, "{red} {green} {blue}");
}

#[test]
fn pictures_for_a_display_are_compared_as_such_and_never_with_radiance() {
    let folder = tempfile::tempdir().unwrap();
    let (a, b) = (
        png(&folder, "a.png", |_, _| 188),
        png(&folder, "b.png", |_, _| 255),
    );
    let said = succeeds(compare().args([&a, &b]));
    assert!(said.contains("(B: there is no other reference)"), "{said}");
    assert!(said.contains("are of the displayed range 0 to 1"), "{said}");
    // sRGB 188 is 0.5029 of white.
    assert!(said.contains("0.5029"), "{said}");
    let radiance = exr(&folder, "r.exr", |_, _| [1.0; 3]);
    let said = fails(compare().args([&a, &radiance]));
    assert!(
        said.contains("was made for a display and")
            && said.contains("compare an .exr with an .exr"),
        "{said}"
    );
}

#[test]
fn what_cannot_be_compared_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let a = exr(&folder, "a.exr", |_, _| [1.0; 3]);
    let said = fails(compare().arg(&a));
    assert!(
        said.contains("give a second picture or --reference"),
        "{said}"
    );
    let said = fails(compare().args([&a, &a]).args(["--part", "sheen"]));
    assert!(
        said.contains("no part 'sheen' in all pictures; they have: total"),
        "{said}"
    );
    let small = folder.path().join("small.exr");
    picture::write_linear(&small, &Linear::radiance((2, 2), vec![[1.0; 3]; 4])).unwrap();
    let said = fails(compare().args([&a, &small]));
    assert!(
        said.contains("pictures of 16x8 and 2x2 cannot be compared"),
        "{said}"
    );
    let mask = png(&folder, "mask.png", |_, _| 0);
    let said = fails(
        compare()
            .args([&small, &small])
            .args(["--mask", &format!("m={}", mask.display())]),
    );
    assert!(
        said.contains("the mask 'm' does not have the pictures' size of 2x2"),
        "{said}"
    );
    std::fs::write(folder.path().join("broken.exr"), b"v/1\x01 no more").unwrap();
    let said = fails(compare().arg(&a).arg(folder.path().join("broken.exr")));
    assert!(said.contains("broken.exr': "), "{said}");
}

/// A copy of the program's graphs and shaders, so that what is cached in it is the test's own.
const CORNELL: [&str; 4] = ["--scene", "cornell", "--size", "48x36"];
const COARSE: [&str; 4] = ["--set", "voxel_dim=32", "--set", "shadow_dim=256"];

#[test]
fn experiments_are_compared_by_part_with_each_other_or_with_the_cached_reference() {
    let home = home();
    let run = |args: &[&str]| succeeds(conelab(home.path()).args(args).args(CORNELL));
    let pair = [
        "compare",
        "configs/rays.ron",
        "configs/thesis.ron",
        "--json",
        "c.json",
    ];
    let pair = [&pair[..], &COARSE].concat();
    // Without a reference: the second is it.
    run(&pair);
    let alone = json(&home.path().join("c.json"));
    assert_eq!(alone["pictures"], serde_json::json!(["configs/rays.ron"]));
    let names: Vec<&str> = alone["parts"]
        .as_array()
        .unwrap()
        .iter()
        .map(|p| p["part"].as_str().unwrap())
        .collect();
    assert_eq!(
        names,
        ["total", "direct", "diffuse", "specular", "occlusion"]
    );
    // The same picture twice gives the same numbers, bit by bit.
    let before = std::fs::read(home.path().join("c.json")).unwrap();
    run(&pair);
    assert_eq!(std::fs::read(home.path().join("c.json")).unwrap(), before);
    let more = [
        "compare",
        "configs/rays.ron",
        "configs/thesis.ron",
        "--bounces",
        "64",
    ];
    let said = fails(conelab(home.path()).args(more).args(COARSE).args(CORNELL));
    assert!(said.contains("no cached reference of 64 bounces"), "{said}");
    // With one: both against it.
    run(&["reference", "configs/rays.ron", "--spp", "128"]);
    let said = run(&pair);
    assert!(
        said.contains("reference: path traced, 128 samples a pixel, bounces 64"),
        "{said}"
    );
    let both = json(&home.path().join("c.json"));
    let total = &both["parts"][0];
    assert!(total["noise"].as_f64().unwrap() > 0.0);
    let flip_noise = total["flip_noise"].as_f64().unwrap();
    assert!(flip_noise > 0.0 && flip_noise < 0.1, "{flip_noise}");
    let energy = |i: usize| score(&both, "frame", i)["energy_ratio"].as_f64().unwrap();
    // Voxels as coarse as these are too bright (docs/trials.md).
    assert!((energy(0) - 1.0).abs() < 0.2, "default: {}", energy(0));
    assert!(
        energy(1) > 1.05,
        "the thesis is known to be too bright: {}",
        energy(1)
    );
    assert_eq!(total["regions"][0]["better"]["energy_ratio"], "A");
    assert!(
        total["regions"]
            .as_array()
            .unwrap()
            .iter()
            .any(|r| r["region"] == "concave corners")
    );
}

/// The last step equals a comparison of its own session. Pictures from files have no steps.
#[test]
fn experiments_are_scored_by_frame() {
    let home = home();
    let run = |args: &[&str]| succeeds(conelab(home.path()).args(args).args(CORNELL));
    run(&["reference", "configs/rays.ron", "--spp", "32"]);
    let compare = [
        "compare",
        "configs/rays.ron",
        "configs/thesis.ron",
        "--frames",
        "12",
        "--json",
        "c.json",
    ];
    let by_frame = ["--by-frame", "steps"];
    run(&[&compare[..], &by_frame, &COARSE].concat());
    let rows = table_with_times(&home.path().join("steps/frames.csv"));
    let of = |picture: &str, column: &str| -> Vec<f64> {
        let rows = rows.iter().filter(|r| r["picture"] == picture);
        rows.map(|r| r[column].parse().unwrap()).collect()
    };
    let json = json(&home.path().join("c.json"));
    for (i, picture) in ["configs/rays.ron", "configs/thesis.ron"]
        .iter()
        .enumerate()
    {
        assert_eq!(of(picture, "frames"), [1.0, 2.0, 4.0, 8.0, 12.0]);
        let times = of(picture, "GPU ms");
        assert!(times.windows(2).all(|t| t[0] <= t[1]), "{times:?}");
        let last = score(&json, "frame", i)["relmse"].as_f64().unwrap();
        let step = of(picture, "relmse")[4];
        assert!(
            (step / last - 1.0).abs() < 1e-12,
            "{picture}: {step}, {last}"
        );
        let chart = home.path().join("steps/relmse-frames.svg");
        assert!(std::fs::read_to_string(chart).unwrap().contains(picture));
    }
    let errors = of("configs/rays.ron", "relmse");
    assert!(errors[4] < 0.7 * errors[0], "{errors:?}");

    let folder = tempfile::tempdir().unwrap();
    let (a, b) = ("a.exr", "b.exr");
    let pictures = [a, b].map(|name| exr(&folder, name, |_, _| [1.0; 3]));
    let said = fails(
        conelab(home.path())
            .arg("compare")
            .args(pictures)
            .args(by_frame),
    );
    assert!(said.contains("--by-frame is for experiments"), "{said}");
}

#[test]
fn a_capture_is_the_picture_that_it_holds() {
    let home = home();
    let capture = [
        &[
            "capture",
            "configs/rays.ron",
            "--name",
            "kept",
            "--resource",
            "direct",
        ][..],
        &COARSE,
    ]
    .concat();
    succeeds(conelab(home.path()).args(capture).args(CORNELL));
    let args = [
        &[
            "compare",
            "captures/kept",
            "configs/rays.ron",
            "--json",
            "c.json",
        ][..],
        &COARSE,
    ]
    .concat();
    succeeds(conelab(home.path()).args(args).args(CORNELL));
    let json = json(&home.path().join("c.json"));
    let parts = json["parts"].as_array().unwrap();
    assert_eq!(
        parts.iter().map(|p| &p["part"]).collect::<Vec<_>>(),
        ["total", "direct"]
    );
    for part in parts {
        assert_eq!(part["regions"][0]["scores"][0]["rmse"], 0.0, "{part}");
    }
}
