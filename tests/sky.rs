//! Pictures of the sky: against what is known without them, against each other, and from files that are not to be trusted.

mod common;

use common::{assert_clean, experiment, lab, root, scene};
use conelab::diagnostics::{At, Loc};
use conelab::experiment::{EnvironmentChange, Experiment, write};
use conelab::graph::run::Execution;
use conelab::lab::{Lab, Session};
use conelab::measure::reference::{Goal, Reference, gather};
use conelab::results::capture::scene_hash;
use conelab::scene::{SUN, Scene, SceneError};
use glam::{DVec3, Vec3};
use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use tempfile::TempDir;

/// Width and height of the test's pictures.
const SIZE: (u32, u32) = (128, 64);

/// To the middle of a texel, by the documented orientation.
fn direction(x: u32, y: u32) -> DVec3 {
    let azimuth = (f64::from(x) + 0.5) / f64::from(SIZE.0) * TAU - PI;
    let polar = (f64::from(y) + 0.5) / f64::from(SIZE.1) * PI;
    DVec3::new(
        azimuth.sin() * polar.sin(),
        polar.cos(),
        -azimuth.cos() * polar.sin(),
    )
}

fn solid_angle(y: u32) -> f64 {
    let edge = |y: u32| (f64::from(y) / f64::from(SIZE.1) * PI).cos();
    TAU / f64::from(SIZE.0) * (edge(y) - edge(y + 1))
}

type Picture<'a> = &'a dyn Fn(u32, u32) -> [f32; 3];

fn save(path: &Path, picture: Picture) {
    let texels = (0..SIZE.1).flat_map(|y| (0..SIZE.0).flat_map(move |x| picture(x, y)));
    image::Rgb32FImage::from_raw(SIZE.0, SIZE.1, texels.collect())
        .unwrap()
        .save(path)
        .unwrap();
}

fn open(path: &Path) -> Result<Scene, SceneError> {
    Scene::open(&path.to_string_lossy(), &|_, _| ControlFlow::Continue(()))
}

/// A scene file under a picture, opened.
#[track_caller]
fn under(folder: &TempDir, models: &str, more: &str, picture: Picture) -> Arc<Scene> {
    save(&folder.path().join("sky.exr"), picture);
    let path = folder.path().join("scene.ron");
    let camera = "cameras: { \"default\": (eye: (1.5, 3.5, 3), target: (0, 0.3, 0), fov_y: 40) }";
    std::fs::write(
        &path,
        format!("(models: [{models}], environment: (file: \"sky.exr\"{more}), {camera})"),
    )
    .unwrap();
    let scene = open(&path).unwrap();
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    Arc::new(scene)
}

/// A floor of 40 x 40 m; with a box on it.
fn floor(folder: &TempDir, boxed: bool) -> String {
    let mut text = String::from("v -20 0 -20\nv 20 0 -20\nv 20 0 20\nv -20 0 20\nf 4 3 2 1\n");
    if boxed {
        text = text.replace("20", "4");
        text += "v -0.4 0 -0.4\nv 0.4 0 -0.4\nv 0.4 0 0.4\nv -0.4 0 0.4\n";
        text += "v -0.4 0.8 -0.4\nv 0.4 0.8 -0.4\nv 0.4 0.8 0.4\nv -0.4 0.8 0.4\n";
        text += "f 12 11 10 9\nf 5 6 10 9\nf 6 7 11 10\nf 7 8 12 11\nf 8 5 9 12\n";
    }
    std::fs::write(folder.path().join("floor.obj"), text).unwrap();
    "(file: \"floor.obj\")".into()
}

/// Of the method, where nothing is kept from frame to frame.
fn session(lab: &Lab, scene: &Arc<Scene>) -> Session {
    let settings = [
        ("voxel_dim", "32"),
        ("shadow_dim", "512"),
        ("bounces", "one"),
        ("gather_frames", "1"),
        ("pixel_rays", "4"),
    ];
    let wanted = ["radiance", "direct"].map(String::from).to_vec();
    lab.prepare(
        &experiment(&scene.name, (48, 36), &settings),
        scene.clone(),
        |_| Ok(wanted),
    )
    .unwrap()
    .0
}

/// A texture after one more frame.
#[track_caller]
fn texture(lab: &Lab, session: &mut Session, name: &str) -> Vec<[f32; 4]> {
    session.frame(0.0).unwrap();
    session.finish().unwrap();
    assert_clean(lab);
    common::floats(session, name, 0)
}

#[track_caller]
fn assert_near(a: &[[f32; 4]], b: &[[f32; 4]], bound: f32) {
    let off = |(a, b): (&[f32; 4], &[f32; 4])| {
        (0..3)
            .map(|i| (a[i] - b[i]).abs() / (0.05 + b[i]))
            .fold(0.0, f32::max)
    };
    let worst = a.iter().zip(b).map(off).fold(0.0, f32::max);
    assert!(a.len() == b.len() && worst < bound, "{worst}");
}

#[track_caller]
fn trace(lab: &Lab, scene: &Arc<Scene>, bounces: u32, samples: u64) -> Reference {
    let keep_on = &mut |_| ControlFlow::Continue(());
    let experiment = experiment(&scene.name, (48, 36), &[]);
    let reference = gather(
        lab,
        &experiment,
        scene,
        bounces,
        Goal::Samples(samples),
        keep_on,
    )
    .unwrap();
    assert_clean(lab);
    reference
}

#[test]
fn a_picture_of_one_colour_is_a_uniform_sky() {
    let (lab, folder) = (lab(root()), tempfile::tempdir().unwrap());
    let ball = "(builtin: \"white-sky\", cameras: false)";
    let pictured = under(&folder, ball, ", intensity: 0.5, rotation: 30", &|_, _| {
        [2.0, 1.0, 0.5]
    });
    assert!(pictured.all_lights().is_empty());
    let mut plain = Scene::clone(&pictured);
    (plain.environment, plain.sky) = (None, Vec3::new(1.0, 0.5, 0.25));
    let plain = Arc::new(plain);
    let [a, b] =
        [&pictured, &plain].map(|scene| texture(&lab, &mut session(&lab, scene), "radiance"));
    assert_near(&a, &b, 2e-3);
    let mean = |scene: &Arc<Scene>| trace(&lab, scene, 2, 16).parts["total"].mean.mean();
    let (a, b) = (mean(&pictured), mean(&plain));
    assert!((a / b - 1.0).abs() < 0.005, "{a} {b}");
}

/// Bright and dark patches, and a sun.
fn patches(x: u32, y: u32) -> [f32; 3] {
    if (x, y) == (40, 14) {
        return [3e5, 2.5e5, 2e5];
    }
    let wave = |a: f32, b: f32| {
        1.2 + (x as f32 * TAU as f32 / SIZE.0 as f32 * a + b).sin() * (y as f32 * 0.1).sin()
    };
    [wave(1.0, 0.0), wave(2.0, 1.0), wave(3.0, 2.0)]
}

#[test]
fn a_turned_picture_is_a_picture_shifted() {
    let (lab, folder) = (lab(root()), tempfile::tempdir().unwrap());
    let floor = floor(&folder, true);
    let turned = under(&folder, &floor, ", rotation: 90", &patches);
    let shifted = under(&folder, &floor, "", &|x, y| {
        patches((x + SIZE.0 / 4) % SIZE.0, y)
    });
    let [a, b] = [&turned, &shifted].map(|s| s.all_lights());
    assert_eq!((a.len(), a[0].name.as_str()), (1, SUN));
    assert!(
        a[0].direction.distance(b[0].direction) < 1e-5 && a[0].color.distance(b[0].color) < 1e-3,
        "{a:?} {b:?}"
    );
    assert!(scene_hash(&turned) != scene_hash(&shifted));
    let expected = texture(&lab, &mut session(&lab, &shifted), "radiance");
    assert_near(
        &texture(&lab, &mut session(&lab, &turned), "radiance"),
        &expected,
        0.02,
    );
    // Frames are skipped until the sky turns.
    let straight = under(&folder, &floor, "", &patches);
    let mut live = session(&lab, &straight);
    live.set_execution(Execution::Incremental);
    let first = texture(&lab, &mut live, "radiance");
    assert!(texture(&lab, &mut live, "radiance") == first);
    live.turn_sky(90.0);
    assert!(
        texture(&lab, &mut live, "radiance")
            == texture(&lab, &mut session(&lab, &turned), "radiance")
    );
    live.turn_sky(0.0);
    assert!(texture(&lab, &mut live, "radiance") == first);
}

/// Mean over the picture, and standard deviation over the mean from pixel to pixel.
fn spread(values: impl Iterator<Item = f32>) -> (f64, f64) {
    let list: Vec<f64> = values.map(f64::from).collect();
    let mean = list.iter().sum::<f64>() / list.len() as f64;
    let variance = list.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / list.len() as f64;
    (mean, variance.sqrt() / mean)
}

#[test]
fn the_reference_has_the_irradiance_of_small_bright_spots_with_little_noise() {
    let (lab, folder) = (lab(root()), tempfile::tempdir().unwrap());
    let floor = floor(&folder, false);
    // Two texels of 8192 bring most of the light. The brighter one is a sun, whose light arrives directly.
    let (sun, other) = ((100, 20), (30, 24));
    let spots = |x: u32, y: u32| {
        [if (x, y) == sun {
            1100.0
        } else if (x, y) == other {
            1000.0
        } else {
            0.01
        }; 3]
    };
    let mut scene = under(&folder, &floor, ", rotation: 10", &spots);
    // Without a lobe the floor reflects albedo times irradiance over pi.
    Arc::make_mut(&mut scene)
        .materials
        .iter_mut()
        .for_each(|m| m.specular = 0.0);
    assert_eq!(scene.all_lights().len(), 1);
    let of = |(x, y): (u32, u32), l: f64| l * solid_angle(y) * direction(x, y).y.max(0.0);
    let albedo = f64::from(scene.materials[0].base_color.x);
    let reference = trace(&lab, &scene, 1, 64);
    for (part, irradiance) in [
        ("diffuse", of(other, 999.99) + 0.01 * PI),
        ("direct", of(sun, 1099.99)),
    ] {
        let (found, noise) = spread(reference.parts[part].mean.rgb.iter().map(|p| p[0]));
        let expected = albedo * irradiance / PI;
        println!("{part}: {found:.5}, by the texels {expected:.5}, noise {noise:.4}");
        // What arrives directly is reflected by the specular lobe too.
        let most = if part == "direct" { 1.1 } else { 1.01 };
        assert!(
            found > 0.99 * expected && found < most * expected,
            "{part}: {found} {expected}"
        );
        // Rays that know nothing of a spot meet it once in some thousand times: at 64 samples their noise is above 5.
        assert!(noise < 0.2, "{part}: {noise}");
    }
}

#[test]
fn the_sun_of_a_picture_casts_shadows_and_the_method_has_the_energy_of_the_reference() {
    let (lab, folder) = (lab(root()), tempfile::tempdir().unwrap());
    let floor = floor(&folder, true);
    let scene = under(&folder, &floor, ", rotation: 200, intensity: 0.2", &patches);
    let mut method = session(&lab, &scene);
    let direct = texture(&lab, &mut method, "direct");
    let shaded = direct.iter().filter(|p| p[3] > 0.0 && p[0] == 0.0).count();
    let lit = direct.iter().filter(|p| p[0] > 0.1).count();
    let reference = trace(&lab, &scene, 1, 64);
    let rays = &reference.parts["direct"].mean.rgb;
    let dark = direct
        .iter()
        .zip(rays)
        .filter(|(p, r)| p[3] > 0.0 && r[0] == 0.0)
        .count();
    println!("{lit} lit and {shaded} shaded pixels, {dark} by rays");
    assert!(
        lit > 100 && dark > 10 && shaded.abs_diff(dark) * 4 <= dark,
        "{lit} {shaded} {dark}"
    );
    let total = common::floats(&mut method, "radiance", 0);
    for (name, found) in [
        ("direct", common::mean(&direct)),
        ("total", common::mean(&total)),
    ] {
        let ratio = found / reference.parts[name].mean.mean();
        println!("{name}: energy {ratio:.4}");
        assert!((ratio - 1.0).abs() < 0.04, "{name}: {ratio}");
    }
}

#[test]
fn files_that_are_no_sky_are_told_and_impossible_radiance_is_black() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let scene_of = |picture: &str| {
        std::fs::write(
            path("scene.ron"),
            format!("(\n    environment: (file: \"{picture}\"),\n)"),
        )
        .unwrap();
        open(&path("scene.ron"))
    };
    let wrong = |picture: &str, expected: &str| {
        let message = scene_of(picture).unwrap_err().to_string();
        assert!(
            message.contains("scene.ron:2:") && message.contains(picture),
            "{message}"
        );
        assert!(message.contains(expected), "{message}");
    };
    save(&path("good.exr"), &patches);
    let good = std::fs::read(path("good.exr")).unwrap();
    wrong("none.hdr", "file not found");
    for (name, bytes) in [("text.hdr", &b"a sky"[..]), ("empty.exr", &[])] {
        std::fs::write(path(name), bytes).unwrap();
        wrong(name, "not a Radiance HDR or OpenEXR picture");
    }
    for length in [20, 200, good.len() / 2] {
        std::fs::write(path("cut.exr"), &good[..length]).unwrap();
        wrong("cut.exr", "damaged");
    }
    for size in [
        "-Y 100000 +X 100000",
        "-Y 16384 +X 16384",
        "-Y 0 +X 5",
        "-Y 64 +X 128",
    ] {
        std::fs::write(
            path("huge.hdr"),
            format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n{size}\n"),
        )
        .unwrap();
        wrong("huge.hdr", "");
    }
    image::Rgb32FImage::from_raw(
        2,
        2,
        vec![
            f32::NAN,
            -1.0,
            1.0,
            f32::INFINITY,
            2.0,
            1e30,
            0.0,
            0.0,
            0.0,
            3.0,
            4.0,
            5.0,
        ],
    )
    .unwrap()
    .save(path("odd.exr"))
    .unwrap();
    let scene = scene_of("odd.exr").unwrap();
    println!("{:?}", scene.warnings);
    assert!(scene.warnings.len() == 2 && scene.warnings.iter().all(|w| w.contains("odd.exr")));
    let texels = scene.environment.as_ref().unwrap().picture.texels();
    assert!(
        texels[0] == [0.0, 0.0, 1.0] && texels[1][0] == 0.0 && texels[3] == [3.0, 4.0, 5.0],
        "{texels:?}"
    );
    image::Rgb32FImage::new(4200, 20)
        .save(path("wide.hdr"))
        .unwrap();
    assert_eq!(
        scene_of("wide.hdr")
            .unwrap()
            .environment
            .unwrap()
            .picture
            .size(),
        (4096, 20)
    );
}

#[test]
fn experiments_change_the_picture_and_are_written_with_it() {
    let folder = tempfile::tempdir().unwrap();
    save(&folder.path().join("sky.exr"), &patches);
    let path = folder.path().join("run.ron");
    let read = |more: &str| {
        Experiment::from_text(
            &path,
            &format!("(graph: \"rays.ron\", scene: \"white-sky\",\n    {more}\n)"),
        )
    };
    let changed =
        read("sky: (1, 2, 3), environment: (file: \"sky.exr\", rotation: -90, intensity: 2),")
            .unwrap();
    let lit = changed.adapted(scene("white-sky")).unwrap();
    let environment = lit.environment.as_ref().unwrap();
    assert_eq!(
        (lit.sky, environment.rotation, environment.picture.size()),
        (Vec3::new(2.0, 4.0, 6.0), -90.0, SIZE)
    );
    // Once more is no more; and rotation or intensity alone keep the rest.
    assert!(Arc::ptr_eq(&changed.adapted(lit.clone()).unwrap(), &lit));
    let turned = read("environment: (rotation: 45),")
        .unwrap()
        .adapted(lit.clone())
        .unwrap();
    assert_eq!(
        (turned.sky, turned.environment.as_ref().unwrap().rotation),
        (lit.sky, 45.0)
    );
    let dimmed = read("environment: (intensity: 0.5),")
        .unwrap()
        .adapted(lit.clone())
        .unwrap();
    assert_eq!(
        (dimmed.sky, dimmed.environment.as_ref().unwrap().rotation),
        (Vec3::splat(0.5), -90.0)
    );
    let hashes = [&lit, &turned, &dimmed].map(|s| scene_hash(s));
    assert!(hashes[0] != hashes[1] && hashes[0] != hashes[2]);
    // Written, also to another folder, and read back.
    let defaults = conelab::lab::Workspace::with(root().to_path_buf(), None)
        .read("rays.ron")
        .unwrap()
        .params
        .clone();
    for to in [
        folder.path().join("again.ron"),
        folder.path().join("deep/again.ron"),
    ] {
        write(&changed, &defaults, &to, false).unwrap();
        let found = Experiment::read(&to).unwrap();
        assert_eq!(
            found
                .adapted(scene("white-sky"))
                .unwrap()
                .environment
                .as_ref()
                .unwrap()
                .picture,
            environment.picture
        );
        // Edited in place.
        let value = EnvironmentChange {
            rotation: Some(10.0),
            ..found.environment.clone().unwrap().value
        };
        let edited = Experiment {
            environment: Some(Loc {
                value,
                at: At::default(),
            }),
            ..found
        };
        write(&edited, &defaults, &to, true).unwrap();
        assert_eq!(
            Experiment::read(&to).unwrap().environment.unwrap().value,
            edited.environment.unwrap().value
        );
    }
    let message = |more: &str| {
        let read = read(more).map_err(|e| e[0].to_string());
        read.and_then(|e| e.adapted(scene("white-sky")).map_err(|e| e.to_string()))
            .map(|_| ())
            .unwrap_err()
    };
    for (more, expected) in [
        (
            "environment: (intensity: -1),",
            "intensity must be finite and 0 or more",
        ),
        (
            "environment: (rotation: NaN),",
            "rotation must be a number of degrees",
        ),
        (
            "environment: (rotation: 5),",
            "scene 'white-sky' has no environment",
        ),
        ("environment: (file: \"none.exr\"),", "file not found"),
    ] {
        let message = message(more);
        assert!(
            message.contains("run.ron:2:") && message.contains(expected),
            "{message}"
        );
    }
}
