//! The reference against what is known without it: another renderer, energy, the law of large numbers; and that what
//! it keeps can be relied on.

mod common;

use common::{assert_clean, conelab, experiment, fails, lab, root, scene, succeeds};
use conelab::experiment::{CameraChoice, Experiment, PlacedCamera};
use conelab::lab::{Lab, Workspace};
use conelab::measure::reference::{Goal, Reference, find, gather};
use conelab::metrics::{METRICS, scores};
use conelab::scene::Scene;
use sha2::{Digest, Sha256};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

#[track_caller]
fn trace(
    lab: &Lab,
    experiment: &Experiment,
    scene: &Arc<Scene>,
    bounces: u32,
    samples: u64,
) -> Reference {
    let keep_on = &mut |_| ControlFlow::Continue(());
    let reference = gather(
        lab,
        experiment,
        scene,
        bounces,
        Goal::Samples(samples),
        keep_on,
    )
    .unwrap();
    assert_eq!(reference.samples, samples);
    assert_clean(lab);
    reference
}

fn mean(reference: &Reference, part: &str) -> f64 {
    reference.parts[part].mean.mean()
}

/// The bits of all parts.
fn bits(reference: &Reference) -> Vec<u32> {
    reference
        .parts
        .values()
        .flat_map(|p| p.mean.rgb.iter().flatten().map(|v| v.to_bits()))
        .collect()
}

/// Mean radiance by what it is: a part, or "bounce N", what turn N of the paths adds; "specular 1" of turn 1 alone.
type Means = &'static [(&'static str, f64, f64)];

/// What `python3 scripts/independent.py cornell.gltf --size 64x48 --spp 8192` says of what `conelab scene cornell
/// --export cornell.gltf` writes, with Mitsuba 3.9.1; then the relative standard error of that and of this test's own
/// samples together.
const CORNELL: Means = &[
    ("direct", 0.009895, 0.0010),
    ("occlusion", 0.492314, 0.0008),
    ("bounce 1", 0.011295, 0.0060),
    ("bounce 2", 0.005049, 0.0075),
    ("bounce 3", 0.002575, 0.0095),
];

/// The same of `atrium` with `--size 32x24 --camera=5.5,3.5,1,4.9,0.3,2.2,35 --spp 16384 --sky 0.5,0.68,0.95`: a plant
/// with alpha masks in the sun, on textured tiles with normal maps. Later bounces are left out: few bright paths from
/// the lanterns make them too noisy for a short test.
const PLANT: Means = &[
    ("direct", 0.862810, 0.0009),
    ("occlusion", 0.140000, 0.0042),
    ("bounce 1", 0.078891, 0.0060),
];

/// The same of `small-quad`, `--size 48x36 --spp 8192`: lit by a lamp of 47 x 38 cm alone, places on which both draw.
const SMALL_QUAD: Means = &[
    ("occlusion", 0.202151, 0.0043),
    ("bounce 1", 0.125489, 0.0070),
    ("bounce 2", 0.059388, 0.0170),
    ("bounce 3", 0.031495, 0.0370),
];

/// The same of `emitters`, `--size 48x36 --spp 16384`: 108 lamps of 1 to 4 cm, some on strings and some before walls.
const EMITTERS: Means = &[
    ("bounce 1", 0.054446, 0.0280),
    ("bounce 2", 0.034319, 0.0330),
];

/// The same of `sky-window`, `--size 32x24 --spp 16384 --sky sky-window.sky.exr --sun 1000`: a sky and its sun through a
/// window.
const SKY_WINDOW: Means = &[
    ("direct", 0.124361, 0.0150),
    ("occlusion", 0.062643, 0.0060),
    ("bounce 1", 0.156597, 0.0130),
    ("bounce 2", 0.097393, 0.0150),
];

/// The same of `tests/common/spot/scene.ron`, `--size 32x24 --spp 16384 --sky tests/common/spot/sky.hdr`: a ball on a
/// floor that shines, under a picture with one bright spot.
const SPOT: Means = &[
    ("occlusion", 0.901797, 0.0010),
    ("bounce 1", 0.197410, 0.0024),
    ("specular 1", 0.011787, 0.0024),
    ("bounce 2", 0.017093, 0.0120),
    ("bounce 3", 0.004486, 0.0190),
];

/// The BRDF that scripts/independent.py has: with it, light transport is compared and materials are not.
/// tests/furnace.rs judges the default one.
const PUBLISHED: (&str, &str) = ("shading_model", "cook_torrance");

/// Compares references of 1, 2, ... bounces with what was recorded.
#[track_caller]
fn assert_means(experiment: &Experiment, samples: u64, expected: Means) {
    let home = common::home();
    // That renderer's lobe has the square of the roughness as its width.
    let model = home
        .path()
        .join("shaders/modules/shading_model/cook_torrance.glsl");
    let text = std::fs::read_to_string(&model).unwrap();
    std::fs::write(
        &model,
        text.replacen("return roughness;", "return roughness * roughness;", 1),
    )
    .unwrap();
    let lab = lab(home.path());
    let scene = scene(&experiment.scene);
    let bounces = expected
        .iter()
        .filter(|m| m.0.starts_with("bounce"))
        .count() as u32;
    let traced: Vec<Reference> = (1..=bounces)
        .map(|k| trace(&lab, experiment, &scene, k, samples))
        .collect();
    let indirect = |k: usize| {
        if k == 0 {
            0.0
        } else {
            mean(&traced[k - 1], "diffuse") + mean(&traced[k - 1], "specular")
        }
    };
    let mut wrong = Vec::new();
    for (what, recorded, error) in expected {
        let found = match what
            .strip_prefix("bounce ")
            .and_then(|k| k.parse::<usize>().ok())
        {
            Some(k) => indirect(k) - indirect(k - 1),
            None => mean(&traced[0], what.strip_suffix(" 1").unwrap_or(what)),
        };
        let ratio = found / recorded;
        println!(
            "{}, {what}: {found:.6}, recorded {recorded:.6}, ratio {ratio:.4} +- {error:.4}",
            experiment.scene
        );
        if (ratio - 1.0).abs() > 0.01 + 2.0 * error {
            wrong.push(format!("{what}: {found} instead of {recorded}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

#[test]
fn cornell_has_the_light_of_every_bounce_that_an_independent_renderer_finds() {
    assert_means(
        &experiment("cornell", (64, 48), &[("pixel", "box"), PUBLISHED]),
        256,
        CORNELL,
    );
}

#[test]
fn textures_and_masks_have_the_light_that_an_independent_renderer_finds() {
    let mut plant = experiment("atrium", (32, 24), &[("pixel", "box"), PUBLISHED]);
    let camera = PlacedCamera::new((5.5, 3.5, 1.0), (4.9, 0.3, 2.2), 35.0);
    plant.camera = CameraChoice::Placed(PlacedCamera {
        near: Some(0.01),
        far: Some(100.0),
        ..camera
    });
    assert_means(&plant, 512, PLANT);
}

#[test]
fn a_lamp_lights_a_room_as_an_independent_renderer_finds() {
    assert_means(
        &experiment("small-quad", (32, 24), &[("pixel", "box"), PUBLISHED]),
        256,
        SMALL_QUAD,
    );
}

#[test]
fn many_small_lamps_light_a_room_as_an_independent_renderer_finds() {
    assert_means(
        &experiment("emitters", (32, 24), &[("pixel", "box"), PUBLISHED]),
        256,
        EMITTERS,
    );
}

#[test]
fn a_sky_lights_a_room_through_its_window_as_an_independent_renderer_finds() {
    assert_means(
        &experiment("sky-window", (32, 24), &[("pixel", "box"), PUBLISHED]),
        256,
        SKY_WINDOW,
    );
}

#[test]
fn a_bright_spot_of_the_sky_lights_a_ball_and_a_floor_as_an_independent_renderer_finds() {
    let scene = root()
        .join("tests/common/spot/scene.ron")
        .to_string_lossy()
        .into_owned();
    assert_means(
        &experiment(&scene, (32, 24), &[("pixel", "box"), PUBLISHED]),
        128,
        SPOT,
    );
}

/// `python3 scripts/independent_own.py own.gltf --size 48x36 --spp 4096` says 0.189308 +- 0.00005 of this room: Mitsuba
/// with its own lamps, integrator and materials.
#[test]
fn another_renderers_own_materials_give_the_same_light() {
    let home = common::home();
    let lab = lab(home.path());
    let path = root()
        .join("tests/common/own/scene.ron")
        .to_string_lossy()
        .into_owned();
    let own = experiment(
        &path,
        (48, 36),
        &[("pixel", "box"), ("shading_model", "single_scattering")],
    );
    let found = mean(&trace(&lab, &own, &scene(&path), 64, 128), "total");
    println!("{found:.6} of 0.189308");
    assert!((found / 0.189308 - 1.0).abs() < 0.01, "{found}");
}

#[test]
fn the_furnace_gains_what_every_bounce_must_bring() {
    // Emission 1, albedo 0.5. What is reflected specularly is at least 0 and at most its own share for the worst angle.
    let home = common::home();
    let lab = lab(home.path());
    let furnace = scene("furnace");
    let [least, most] = specular_albedo(f64::from(furnace.materials[0].roughness));
    println!("specular albedo {least:.4} to {most:.4}");
    assert!(least > 0.0 && most < 0.1, "{least} {most}");
    let series = |a: f64, bounces: u32| (1..=bounces).map(|k| a.powi(k as i32 - 1)).sum::<f64>();
    for bounces in [1, 2, 4, 32] {
        // Without learning every diffuse ray brings 1 at the first bounce: no noise.
        let learning = if bounces == 1 { "0" } else { "8" };
        let reference = trace(
            &lab,
            &experiment("furnace", (32, 24), &[PUBLISHED, ("learning", learning)]),
            &furnace,
            bounces,
            64,
        );
        let [total, diffuse, specular] =
            ["total", "diffuse", "specular"].map(|p| mean(&reference, p));
        println!(
            "{bounces} bounces: total {total:.5}, diffuse {diffuse:.5}, specular {specular:.5}"
        );
        let [low, high] = [0.5 + least, 0.5 + most].map(|a| 0.5 * series(a, bounces));
        assert!(
            diffuse > low * 0.998 && diffuse < high * 1.002,
            "{bounces}: {low} {diffuse} {high}"
        );
        assert!(
            (total - 1.0 - diffuse - specular).abs() < 1e-4 * total,
            "{bounces}: {total}"
        );
        if bounces == 1 {
            let worst = reference.parts["diffuse"]
                .mean
                .rgb
                .iter()
                .flatten()
                .map(|v| (v - 0.5).abs())
                .fold(0.0, f32::max);
            assert!(worst < 1e-5, "a pixel is off by {worst}");
            assert!(
                specular > least * 0.99 && specular < most * 1.01,
                "{least} {specular} {most}"
            );
        }
        assert_eq!(mean(&reference, "occlusion"), 0.0);
        assert_eq!(mean(&reference, "direct"), 0.0);
    }
}

/// Least and greatest share of the light that the microfacets reflect, over the angles of view: the BRDF's papers in
/// 64-bit arithmetic, summed over the hemisphere.
fn specular_albedo(roughness: f64) -> [f64; 2] {
    let (a2, k) = (roughness.powi(4), (roughness + 1.0).powi(2) / 8.0);
    let steps = 256;
    let shares = (1..=90).map(|i| {
        let nv = f64::from(i) / 90.0;
        let v = [(1.0 - nv * nv).sqrt(), nv];
        let mut sum = 0.0;
        for (j, m) in (0..steps).flat_map(|j| (0..steps).map(move |m| (j, m))) {
            let at = |i: i32| (f64::from(i) + 0.5) / f64::from(steps);
            let (nl, turn) = (at(j), std::f64::consts::TAU * at(m));
            let side = (1.0 - nl * nl).sqrt();
            let h = [v[0] + side * turn.cos(), side * turn.sin(), v[1] + nl];
            let length = h.iter().map(|c| c * c).sum::<f64>().sqrt();
            let (nh, vh) = (h[2] / length, (v[0] * h[0] + v[1] * h[2]) / length);
            let d = a2 / (std::f64::consts::PI * (nh * nh * (a2 - 1.0) + 1.0).powi(2));
            let g = nl / (nl * (1.0 - k) + k) * nv / (nv * (1.0 - k) + k);
            let f = 0.04 + 0.96 * (1.0 - vh).powi(5);
            sum += d * g * f / (4.0 * nv) * std::f64::consts::TAU / f64::from(steps * steps);
        }
        sum
    });
    shares.fold([f64::INFINITY, 0.0], |[low, high], s| {
        [low.min(s), high.max(s)]
    })
}

#[test]
fn a_white_sphere_vanishes_before_a_white_sky() {
    let home = common::home();
    let lab = lab(home.path());
    let reference = trace(
        &lab,
        &experiment("white-sky", (48, 48), &[PUBLISHED]),
        &scene("white-sky"),
        1,
        32,
    );
    let part = |name: &str| reference.parts[name].mean.rgb.clone();
    let (diffuse, total, open) = (part("diffuse"), part("total"), part("occlusion"));
    let sphere: Vec<usize> = (0..diffuse.len())
        .filter(|i| diffuse[*i][0] > 0.0)
        .collect();
    assert!(sphere.len() > 500, "{} pixels of the sphere", sphere.len());
    let over = |values: &[[f32; 3]]| {
        sphere.iter().map(|i| f64::from(values[*i][0])).sum::<f64>() / sphere.len() as f64
    };
    println!("diffuse {:.5}, openness {:.5}", over(&diffuse), over(&open));
    assert!((over(&diffuse) - 1.0).abs() < 0.01, "{}", over(&diffuse));
    assert!((over(&open) - 1.0).abs() < 0.01, "{}", over(&open));
    // Beside it there is nothing but the sky.
    assert!(
        (0..total.len())
            .filter(|i| diffuse[*i][0] == 0.0)
            .all(|i| total[i] == [1.0; 3] && open[i] == [1.0; 3])
    );
}

/// Slope of a line through equidistant points.
fn slope(y: &[f64]) -> f64 {
    let centre = (y.len() - 1) as f64 / 2.0;
    let (up, down) = y.iter().enumerate().fold((0.0, 0.0), |(up, down), (i, y)| {
        let x = i as f64 - centre;
        (up + x * y, down + x * x)
    });
    up / down
}

#[test]
fn twice_the_samples_at_least_halve_the_relmse() {
    let home = common::home();
    let lab = lab(home.path());
    let (cornell, experiment) = (scene("cornell"), experiment("cornell", (32, 24), &[]));
    let steps: Vec<Reference> = (5..=10)
        .map(|i| trace(&lab, &experiment, &cornell, 1, 1 << i))
        .collect();
    for part in ["total", "diffuse", "specular", "occlusion"] {
        let noise: Vec<f64> = steps.iter().map(|r| r.parts[part].noise.relmse).collect();
        let slope = slope(&noise.iter().map(|n| n.log2()).collect::<Vec<f64>>());
        println!("{part}: {noise:?}, slope {slope:.3}");
        assert!(
            (-2.0..=-0.9).contains(&slope),
            "{part}: slope {slope} of {noise:?}"
        );
    }
}

#[test]
fn learning_where_light_comes_from_lowers_the_noise_and_keeps_the_mean() {
    let home = common::home();
    let lab = lab(home.path());
    let with_and_without = |name: &str| {
        ["64", "0"].map(|learning| {
            let experiment = experiment(name, (48, 36), &[("learning", learning)]);
            trace(&lab, &experiment, &scene(name), 64, 64)
        })
    };
    // Light has to take two bends, and few paths find it. Few bright pixels decide relMSE.
    let [learned, cosine] = with_and_without("corridor").map(|r| r.parts["total"].noise.flip);
    println!("FLIP of noise {learned} and {cosine}");
    assert!(learned < 0.85 * cosine);
    // Noise is small enough here to compare means.
    let [learned, cosine] = with_and_without("cornell").map(|r| mean(&r, "total"));
    println!("mean {learned} and {cosine}");
    assert!((learned / cosine - 1.0).abs() < 0.01);
}

/// Gathers to a bound. Returns the reference and the samples and noise of every report.
fn trace_until(
    lab: &Lab,
    (name, experiment): (&str, &Experiment),
    bound: &str,
) -> (Reference, Vec<(u64, f64)>) {
    let mut reports = Vec::new();
    let goal = Goal::Noise(bound.parse().unwrap());
    let reference = gather(lab, experiment, &scene(name), 1, goal, &mut |now| {
        reports.push((now.samples, now.noise.unwrap()));
        ControlFlow::Continue(())
    });
    assert_clean(lab);
    (reference.unwrap(), reports)
}

#[test]
fn the_estimated_noise_is_the_error_against_many_more_samples_and_bounds_are_kept() {
    // relMSE is decided by few bright pixels.
    let cases = [
        ("cornell", "flip", 0.02, 1.25),
        ("small-quad", "flip", 0.02, 1.25),
        ("cornell", "relmse", 0.001, 2.0),
    ];
    for (name, key, limit, factor) in cases {
        let home = common::home();
        let lab = lab(home.path());
        let (one, other) = (
            experiment(name, (32, 24), &[]),
            experiment(name, (32, 24), &[("seed", "2")]),
        );
        let (found, reports) = trace_until(&lab, (name, &one), &format!("{key}={limit}"));
        let samples = 16 * found.samples;
        let converged = trace(&lab, &other, &scene(name), 1, samples);
        let [x, r] = [&found, &converged].map(|r| &r.parts["total"]);
        let metric = METRICS.iter().find(|m| m.key == key).unwrap();
        let noise = metric.of_noise(x.noise).unwrap();
        let error = scores(&x.mean, &r.mean).unwrap().get(key);
        println!(
            "{name} {key}={limit}: {} samples, estimated {noise:.5}, against {samples} samples {error:.5}",
            found.samples
        );
        assert!(noise <= limit, "{name} {key}: {noise}");
        assert!(
            error < factor * noise && error > noise / factor,
            "{name} {key}: {error}, estimated {noise}"
        );
        let (last, before) = reports.split_last().unwrap();
        assert_eq!(*last, (found.samples, noise));
        assert!(before.iter().all(|r| r.1 > limit), "{name}: {reports:?}");
    }
}

#[test]
fn a_sharper_bound_continues_from_the_samples_of_a_looser_one() {
    let (one, two) = (common::home(), common::home());
    let cornell = experiment("cornell", (24, 18), &[]);
    let case = ("cornell", &cornell);
    let (whole, _) = trace_until(&lab(one.path()), case, "flip=0.02");
    let lab = lab(two.path());
    let (loose, _) = trace_until(&lab, case, "flip=0.03");
    let (sharp, reports) = trace_until(&lab, case, "flip=0.02");
    assert!(
        loose.samples < sharp.samples,
        "{} and {}",
        loose.samples,
        sharp.samples
    );
    assert!(reports.iter().all(|r| r.0 > loose.samples), "{reports:?}");
    assert_eq!(sharp.samples, whole.samples);
    assert!(bits(&sharp) == bits(&whole));
    let (again, reports) = trace_until(&lab, case, "flip=0.03");
    assert!(reports.is_empty() && bits(&again) == bits(&sharp));
    let record = std::fs::read_to_string(sharp.folder.join("reference.json")).unwrap();
    let record: serde_json::Value = serde_json::from_str(&record).unwrap();
    let (stored, noise) = (
        record["flip_noise"].as_f64().unwrap(),
        sharp.parts["total"].noise.flip,
    );
    assert!((stored - noise).abs() < 1e-12, "{stored} and {noise}");
    // --spp ends an unreachable bound.
    let mut command = conelab(two.path());
    command.args(["reference", "configs/rays.ron", "--scene", "cornell"]);
    command.args(["--size", "24x18", "--bounces", "1", "--set", "seed=3"]);
    let said = succeeds(command.args(["--until", "flip=1e-6", "--spp", "64"]));
    assert!(said.contains("64 samples a pixel"), "{said}");
    assert!(said.contains("above 0.000001: raise --spp"), "{said}");
}

#[test]
fn samples_depend_on_the_seed_alone_and_not_on_where_a_run_was_stopped() {
    let (one, two) = (common::home(), common::home());
    let cornell = scene("cornell");
    let size = (32, 24);
    let whole = trace(
        &lab(one.path()),
        &experiment("cornell", size, &[]),
        &cornell,
        2,
        96,
    );
    let lab = lab(two.path());
    let keep_on = &mut |_| ControlFlow::Continue(());
    // Stopped by the first report of progress; what is kept then is found.
    let part = gather(
        &lab,
        &experiment("cornell", size, &[]),
        &cornell,
        2,
        Goal::Samples(96),
        &mut |_| ControlFlow::Break(()),
    );
    assert_eq!(part.unwrap().samples, 32);
    let kept = find(&lab.home, &experiment("cornell", size, &[]), &cornell, 2)
        .unwrap()
        .unwrap();
    assert_eq!(kept.samples, 32);
    assert_ne!(bits(&kept), bits(&whole));
    let mut reports = Vec::new();
    let resumed = gather(
        &lab,
        &experiment("cornell", size, &[]),
        &cornell,
        2,
        Goal::Samples(96),
        &mut |now| {
            reports.push(now.samples);
            ControlFlow::Continue(())
        },
    );
    assert_eq!(reports, [64, 96], "it goes on from where it was stopped");
    assert!(bits(&resumed.unwrap()) == bits(&whole));
    // All are there: nothing is traced, progress is silent.
    let again = gather(
        &lab,
        &experiment("cornell", size, &[]),
        &cornell,
        2,
        Goal::Samples(64),
        &mut |_| panic!("traced"),
    );
    assert!(bits(&again.unwrap()) == bits(&whole));
    let other = gather(
        &lab,
        &experiment("cornell", size, &[("seed", "2")]),
        &cornell,
        2,
        Goal::Samples(96),
        keep_on,
    )
    .unwrap();
    assert!(bits(&other) != bits(&whole));
    let ratio = mean(&other, "total") / mean(&whole, "total");
    assert!(
        (ratio - 1.0).abs() < 0.1,
        "other seed, other picture: {ratio}"
    );
}

#[test]
fn a_killed_run_loses_no_kept_sample() {
    let (home, calm) = (common::home(), common::home());
    let run = |home: &Path, samples: &str| {
        let mut command = conelab(home);
        command.args([
            "reference",
            "configs/rays.ron",
            "--scene",
            "cornell",
            "--size",
            "32x24",
            "--spp",
            samples,
        ]);
        command
    };
    succeeds(&mut run(home.path(), "64"));
    let sums = files(home.path());
    for wait in [300, 700, 1100] {
        let mut child = run(home.path(), "1000000")
            .stdout(std::process::Stdio::null())
            .stderr(std::process::Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(wait));
        child.kill().unwrap();
        child.wait().unwrap();
        assert_eq!(files(home.path()), sums, "killed after {wait} ms");
    }
    succeeds(&mut run(home.path(), "96"));
    succeeds(&mut run(calm.path(), "96"));
    assert_eq!(files(home.path()), files(calm.path()));
}

/// Files of the only reference below a home, by name with the SHA-256 of their bytes.
fn files(home: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let folder = home.join("captures/reference");
    let only = std::fs::read_dir(folder)
        .unwrap()
        .map(|f| f.unwrap().path())
        .collect::<Vec<_>>();
    assert_eq!(only.len(), 1, "{only:?}");
    let mut files: Vec<(PathBuf, Vec<u8>)> = std::fs::read_dir(&only[0])
        .unwrap()
        .map(|f| f.unwrap().path())
        .map(|f| {
            (
                f.strip_prefix(home).unwrap().to_path_buf(),
                Sha256::digest(std::fs::read(&f).unwrap()).to_vec(),
            )
        })
        .collect();
    files.sort();
    files
}

/// A scene's part, and what changes in it.
type Change = (&'static str, fn(&mut Scene));

#[test]
fn a_reference_is_found_for_what_it_was_made_of_and_for_nothing_else() {
    let home = common::home();
    let lab = lab(home.path());
    let cornell = scene("cornell");
    let plain = || experiment("cornell", (16, 12), &[]);
    let made = trace(&lab, &plain(), &cornell, 1, 32);
    let found = |home: &Workspace, experiment: &Experiment, scene: &Arc<Scene>, bounces: u32| {
        find(home, experiment, scene, bounces)
            .unwrap()
            .map(|r| bits(&r))
    };
    assert_eq!(found(&lab.home, &plain(), &cornell, 1), Some(bits(&made)));
    // What the method alone uses, and how the picture is shown, are no part of the question.
    for (name, value) in [("voxel_dim", "32"), ("exposure", "1"), ("samples", "4")] {
        let same = experiment("cornell", (16, 12), &[(name, value)]);
        assert!(found(&lab.home, &same, &cornell, 1).is_some(), "{name}");
    }
    for (name, value) in [
        ("shading_model", "cook_torrance"),
        ("shading_model", "blinn_phong"),
        ("seed", "2"),
        ("pixel", "box"),
    ] {
        let other = experiment("cornell", (16, 12), &[(name, value)]);
        assert_eq!(found(&lab.home, &other, &cornell, 1), None, "{name}");
    }
    let mut moved = plain();
    moved.camera = CameraChoice::Placed(PlacedCamera::new(
        (2.78, 2.73, -7.9),
        (2.78, 2.73, 2.8),
        39.3,
    ));
    assert_eq!(found(&lab.home, &moved, &cornell, 1), None, "camera");
    assert_eq!(
        found(
            &lab.home,
            &experiment("cornell", (12, 16), &[]),
            &cornell,
            1
        ),
        None,
        "size"
    );
    assert_eq!(found(&lab.home, &plain(), &cornell, 2), None, "bounces");
    let changes: [Change; 4] = [
        ("light", |s| s.lights[0].color.x *= 1.001),
        ("sky", |s| s.sky.z = 0.1),
        ("material", |s| s.materials[1].roughness *= 0.5),
        ("geometry", |s| s.meshes[0].vertices[0].position[1] += 0.001),
    ];
    for (what, change) in changes {
        let mut other = Scene::clone(&cornell);
        change(&mut other);
        assert_eq!(
            found(&lab.home, &plain(), &Arc::new(other), 1),
            None,
            "{what}"
        );
    }
    let shader = home.path().join("shaders/common/brdf.glsl");
    let text = std::fs::read_to_string(&shader).unwrap();
    std::fs::write(&shader, text.replace("s.albedo / PI", "s.albedo / 3.0")).unwrap();
    assert_eq!(found(&lab.home, &plain(), &cornell, 1), None, "shader");
    std::fs::write(&shader, text).unwrap();
    assert!(found(&lab.home, &plain(), &cornell, 1).is_some());
}

#[test]
fn damaged_references_are_told_and_not_trusted() {
    let home = common::home();
    let lab = lab(home.path());
    let (cornell, experiment) = (scene("cornell"), experiment("cornell", (16, 12), &[]));
    let folder = trace(&lab, &experiment, &cornell, 1, 32).folder;
    let (json, sums) = (folder.join("reference.json"), folder.join("sums-32.exr"));
    let (record, texels) = (
        std::fs::read_to_string(&json).unwrap(),
        std::fs::read(&sums).unwrap(),
    );
    let rejected = |what: &str, hint: &str| {
        let error = find(&lab.home, &experiment, &cornell, 1)
            .expect_err(what)
            .to_string();
        println!("{what}: {error}");
        assert!(
            error.contains("delete the folder") && error.contains(hint),
            "{what}: {error}"
        );
        let error = gather(
            &lab,
            &experiment,
            &cornell,
            1,
            Goal::Samples(64),
            &mut |_| ControlFlow::Continue(()),
        );
        assert!(error.is_err(), "{what}: more samples were added");
    };
    std::fs::write(&sums, &texels[..texels.len() / 2]).unwrap();
    rejected("half a file", "does not match its checksum");
    let mut flipped = texels.clone();
    let last = flipped.len() - 100;
    flipped[last] ^= 1;
    std::fs::write(&sums, &flipped).unwrap();
    rejected("one bit", "does not match its checksum");
    std::fs::write(&sums, vec![0; 4 << 20]).unwrap();
    rejected("a large file", "more than its samples take");
    // Sums that another process has replaced and deleted are none, and no mistake.
    std::fs::remove_file(&sums).unwrap();
    assert!(find(&lab.home, &experiment, &cornell, 1).unwrap().is_none());
    std::fs::write(&sums, &texels).unwrap();
    for (what, text, hint) in [
        (
            "half a record",
            record[..record.len() / 2].to_owned(),
            "reference.json",
        ),
        (
            "another schema",
            record.replace("conelab-reference-", "conelab-"),
            "not what this program wrote",
        ),
        (
            "another place",
            record.replace("sums-32.exr", "sums-/../../x"),
            "not what this program wrote",
        ),
        (
            "more samples",
            record.replace("\"samples\": 32", "\"samples\": 320"),
            "as many samples",
        ),
        (
            "another size",
            record.replace("16", "61"),
            "not what this program wrote",
        ),
    ] {
        assert_ne!(text, record, "{what}");
        std::fs::write(&json, text).unwrap();
        rejected(what, hint);
    }
    std::fs::write(&json, &record).unwrap();
    assert!(find(&lab.home, &experiment, &cornell, 1).unwrap().is_some());
    let said = {
        std::fs::write(&sums, &flipped).unwrap();
        let mut command = conelab(home.path());
        command.args([
            "reference",
            "configs/rays.ron",
            "--scene",
            "cornell",
            "--size",
            "16x12",
        ]);
        command.args(["--spp", "64", "--bounces", "1"]);
        fails(&mut command)
    };
    assert!(said.contains("delete the folder"), "{said}");
}

/// 3,000 triangles in one place, and a chain that grows by a fifth each, make a hierarchy by surface area 132 and 2,992
/// levels deep. A heap looks like one triangle, and the sky's light on it is the same.
#[test]
fn deep_hierarchies_are_traced() {
    let lab = lab(root());
    let folder = tempfile::tempdir().unwrap();
    let light = |copies: usize, chain: i32| {
        let mut text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{}", "f 1 2 3\n".repeat(copies));
        for i in 0..chain {
            // Behind the triangle, where the camera and the light of its front do not come.
            let s = 0.01 * 1.2_f64.powi(i - chain);
            text += &format!(
                "v {s} {s} -1\nv {} {s} -1\nv {s} {} -1\nf -3 -1 -2\n",
                2.0 * s,
                2.0 * s
            );
        }
        let file = folder.path().join(format!("{copies}-{chain}.obj"));
        std::fs::write(&file, text).unwrap();
        let mut experiment = experiment(file.to_str().unwrap(), (16, 12), &[]);
        experiment.camera =
            CameraChoice::Placed(PlacedCamera::new((0.3, 0.3, 2.0), (0.3, 0.3, 0.0), 20.0));
        let scene =
            Arc::new(Scene::open(&experiment.scene, &|_, _| ControlFlow::Continue(())).unwrap());
        mean(&trace(&lab, &experiment, &scene, 1, 32), "total")
    };
    let one = light(1, 0);
    assert!(one > 0.0);
    for (copies, chain) in [(3000, 0), (1, 300)] {
        let found = light(copies, chain);
        assert!(
            (found / one - 1.0).abs() < 0.02,
            "{copies} copies, a chain of {chain}: {found} and not {one}"
        );
    }
}
