//! Where the method is right and where it fails, with numbers: docs/trials.md has a table of them, and every row of it is
//! measured here again. A row that misses what is wanted says so there; it fails here only when it no longer says what is
//! measured. `CONELAB_BLESS=1 cargo test --test trials -- --test-threads=1` writes the table anew. On a GPU
//! (CONELAB_TEST_DEVICE) rows are printed, with finer grids where memory allows, and not compared.

mod common;

use common::figures::{self, ANY, Row, row};
use common::{assert_clean, device, experiment, lab, root};
use conelab::diagnostics::{At, Loc};
use conelab::experiment::Experiment;
use conelab::lab::{Lab, parts_of};
use conelab::measure::reference::{Goal, Reference, gather};
use conelab::metrics::{Linear, scores};
use conelab::scene::Scene;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;

#[track_caller]
fn check(trial: &str, rows: &[Row]) {
    figures::check("trials.md", trial, rows);
}

fn with(mut experiment: Experiment, name: &str, value: &str) -> Experiment {
    experiment.params.push((
        Loc {
            value: name.into(),
            at: At::default(),
        },
        value.into(),
    ));
    experiment
}

/// The parts of an experiment's light, and its reference after so many samples.
fn run(lab: &Lab, experiment: &Experiment, samples: u64) -> (BTreeMap<String, Linear>, Reference) {
    let scene = Scene::open(&experiment.scene, &|_, _| ControlFlow::Continue(())).unwrap();
    let scene = experiment.adapted(Arc::new(scene)).unwrap();
    // All rays in one frame, but where turns are asked for: of diffuse light they add up to the same bits (tests/turns.rs).
    let turns = experiment
        .params
        .iter()
        .find(|p| p.0.value == "gather_frames")
        .map(|p| p.1.clone());
    let experiment = &with(
        experiment.clone(),
        "gather_frames",
        turns.as_deref().unwrap_or("1"),
    );
    let mut wanted = Vec::new();
    let prepared = lab.prepare(experiment, scene.clone(), |graph| {
        wanted.extend(parts_of(graph).into_iter().map(|p| p.texture));
        Ok(wanted)
    });
    let (mut session, _) = prepared.unwrap_or_else(|e| panic!("{e}"));
    session
        .run(turns.map_or(1, |t| t.parse().unwrap()))
        .unwrap();
    session.finish().unwrap();
    assert_eq!(session.failed_checks().unwrap(), Vec::<String>::new());
    let parts = session.parts().unwrap();
    drop(session);
    let reference = gather(
        lab,
        experiment,
        &scene,
        1,
        Goal::Samples(samples),
        &mut |_| ControlFlow::Continue(()),
    );
    assert_clean(lab);
    (parts, reference.unwrap_or_else(|e| panic!("{e}")))
}

/// A scene of quads in a folder of its own: (material, corners) in metres, counter-clockwise from the side that is seen.
fn quads(name: &str, materials: &str, quads: &[(&str, [[f64; 3]; 4])], scene: &str) -> String {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("trials");
    std::fs::create_dir_all(&folder).unwrap();
    let mut obj = format!("mtllib {name}.mtl\n");
    for (_, corners) in quads {
        for [x, y, z] in corners {
            let _ = writeln!(obj, "v {x} {y} {z}");
        }
    }
    for (i, (material, _)) in quads.iter().enumerate() {
        let v = 4 * i + 1;
        let _ = writeln!(
            obj,
            "usemtl {material}\nf {} {} {} {}",
            v,
            v + 1,
            v + 2,
            v + 3
        );
    }
    std::fs::write(folder.join(format!("{name}.obj")), obj).unwrap();
    std::fs::write(folder.join(format!("{name}.mtl")), materials).unwrap();
    let file = folder.join(format!("{name}.ron"));
    std::fs::write(&file, scene).unwrap();
    file.to_string_lossy().into_owned()
}

/// The six sides of a box, seen from inside or from outside.
fn sides(
    material: &'static str,
    low: [f64; 3],
    high: [f64; 3],
    inside: bool,
) -> Vec<(&'static str, [[f64; 3]; 4])> {
    let at = |i: usize| {
        let pick = |axis: usize| {
            if i >> axis & 1 == 0 {
                low[axis]
            } else {
                high[axis]
            }
        };
        [pick(0), pick(1), pick(2)]
    };
    [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ]
    .into_iter()
    .map(|mut c: [usize; 4]| {
        if inside {
            c.reverse();
        }
        (material, c.map(at))
    })
    .collect()
}

const QUICK: (&str, &str) = ("shadow_dim", "1024");
/// What the references have.
const ONE_BOUNCE: (&str, &str) = ("bounces", "one");

/// T1. A closed box with albedo 0.5 and emission 1, at every voxel size. The lobe returns E of a radiance of 1, and
/// the base half of the rest, 0.5 (1 - E): diffuse light plus half of the specular light is 0.5 for every E.
#[test]
fn furnace() {
    let lab = lab(root());
    let mut rows = Vec::new();
    for dim in ["32", "64", "128"] {
        let (parts, _) = run(
            &lab,
            &experiment(
                "furnace",
                (64, 48),
                &[("voxel_dim", dim), QUICK, ONE_BOUNCE],
            ),
            32,
        );
        let light = parts["diffuse"].mean() + 0.5 * parts["specular"].mean();
        rows.push(row(
            format!("{dim} voxels"),
            "diffuse and half of specular / exact",
            light / 0.5,
            (0.98, 1.02),
        ));
    }
    check("T1 furnace", &rows);
}

/// T2. A white ball under a white sky: all of the sky reaches it.
#[test]
fn white_sky() {
    let lab = lab(root());
    let mut rows = Vec::new();
    for dim in ["32", "64"] {
        let (parts, reference) = run(
            &lab,
            &experiment(
                "white-sky",
                (64, 64),
                &[("voxel_dim", dim), QUICK, ONE_BOUNCE],
            ),
            32,
        );
        let ratio = parts["occlusion"].mean() / reference.parts["occlusion"].mean.mean();
        rows.push(row(
            format!("{dim} voxels"),
            "openness / exact",
            ratio,
            (0.99, 1.01),
        ));
    }
    check("T2 white sky", &rows);
}

/// T3. The same picture from coarse and fine voxels. At 80x60 a row of pixel centres falls between panel and ceiling.
#[test]
fn resolution() {
    let lab = lab(root());
    let mut means = Vec::new();
    let finer: &[&str] = if device() == "llvmpipe" {
        &[]
    } else {
        &["256", "512"]
    };
    let mut rows = Vec::new();
    for dim in ["32", "64", "128"].iter().chain(finer) {
        let mut set = vec![("voxel_dim", *dim), QUICK, ONE_BOUNCE];
        if finer.contains(dim) {
            set.extend([
                ("voxel_capacity", "2700000"),
                ("fragment_capacity", "64000000"),
            ]);
        }
        let (parts, reference) = run(&lab, &experiment("cornell", (100, 75), &set), 256);
        let expected = &reference.parts["diffuse"].mean;
        let most = expected
            .rgb
            .iter()
            .map(|t| t.iter().sum::<f32>())
            .fold(0.0, f32::max);
        let share = f64::from(most) / (3.0 * expected.mean() * expected.rgb.len() as f64);
        assert!(
            share < 0.005,
            "one pixel holds {share:.4} of the reference: the mean says little about the others"
        );
        let mean = parts["diffuse"].mean() / expected.mean();
        rows.push(row(
            format!("{dim} voxels"),
            "diffuse / reference",
            mean,
            (0.9, 1.1),
        ));
        means.push(mean);
    }
    let (low, high) = means
        .iter()
        .skip(1)
        .fold((ANY, -ANY), |(a, b), m| (a.min(*m), b.max(*m)));
    rows.push(row(
        "64 voxels and finer",
        "drift of the mean",
        high / low - 1.0,
        (-ANY, 0.03),
    ));
    check("T3 resolution", &rows);
}

/// T4. A wall between a lit and a dark chamber, at angles to the grid: light that comes through it, beside light that is
/// missing in the lit chamber.
#[test]
fn walls() {
    let lab = lab(root());
    let mut rows = Vec::new();
    for (voxels, thickness) in [(0.3, 0.03), (1.0, 0.1), (2.0, 0.2), (4.0, 0.4)] {
        for degrees in [0, 20, 45] {
            let mut list = sides("wall", [-2.0, -1.0, -1.0], [2.0, 1.0, 1.0], true);
            list.extend(sides(
                "wall",
                [-0.5 * thickness, -1.0, -1.0],
                [0.5 * thickness, 1.0, 1.0],
                false,
            ));
            let name = format!("chambers-{voxels}-{degrees}");
            // The lamp and both eyes turn with the chambers.
            let turn = |x: f64, y: f64, z: f64| {
                let (s, c) = f64::from(degrees).to_radians().sin_cos();
                format!("({:.6}, {y}, {:.6})", c * x + s * z, c * z - s * x)
            };
            let camera = |side: f64| {
                format!(
                    "(eye: {}, target: {}, fov_y: 70)",
                    turn(side * 1.8, 0.5, 0.8),
                    turn(side * 0.6, -0.4, -0.4)
                )
            };
            let scene = format!(
                "(models: [(file: \"{name}.obj\", transform: (rotate_deg: (0, {degrees}, 0)))], sky: (0, 0, 0), \
                 lights: [Point(name: \"lamp\", color: (2, 2, 2), position: {}, shadow: true)], \
                 cameras: {{ \"lit\": {}, \"dark\": {} }})",
                turn(1.0, 0.6, 0.0),
                camera(1.0),
                camera(-1.0)
            );
            let file = quads(&name, "newmtl wall\nKd 0.8 0.8 0.8\nPr 1\n", &list, &scene);
            let set = [
                ("voxel_dim", "64"),
                ("volume", "box"),
                ("volume_size", "(6.4, 6.4, 6.4)"),
                QUICK,
                ONE_BOUNCE,
            ];
            let of = |camera: &str| {
                let mut e = experiment(&file, (48, 36), &set);
                e.camera = conelab::experiment::CameraChoice::Named(camera.into());
                run(&lab, &e, 128)
            };
            let (lit, lit_reference) = of("lit");
            let (dark, dark_reference) = of("dark");
            assert_eq!(
                dark_reference.parts["diffuse"].mean.mean(),
                0.0,
                "the dark chamber is closed"
            );
            let bright = lit_reference.parts["diffuse"].mean.mean();
            let setting = format!("{voxels} voxels thick, {degrees} degrees");
            let leak = dark["diffuse"].mean() / bright;
            rows.push(row(
                setting.clone(),
                "leak / lit chamber",
                leak,
                (-ANY, 0.01),
            ));
            let energy = lit["diffuse"].mean() / bright;
            rows.push(row(
                setting,
                "lit chamber / reference",
                energy,
                (0.95, 1.05),
            ));
        }
    }
    check("T4 walls", &rows);
}

/// Part of the cosine-weighted hemisphere above a point that a rectangle parallel to the surface hides, one corner above
/// the point: Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", B-3. x, y: its edges over its height.
fn corner_factor(x: f64, y: f64) -> f64 {
    let (a, b) = ((1.0 + x * x).sqrt(), (1.0 + y * y).sqrt());
    (x / a * (y / a).atan() + y / b * (x / b).atan()) / std::f64::consts::TAU
}

/// T5. Under the edge of a roof: how open the floor is, against the exact fraction.
#[test]
fn edge() {
    let lab = lab(root());
    let (h, a, b): (f64, f64, f64) = (1.0, 5.0, 6.0);
    let floor = [
        [-6.0, 0.0, 6.0],
        [6.0, 0.0, 6.0],
        [6.0, 0.0, -6.0],
        [-6.0, 0.0, -6.0],
    ];
    let roof = [[-a, h, b], [0.0, h, b], [0.0, h, -b], [-a, h, -b]];
    let (eye, target): ([f64; 3], [f64; 3]) = ([3.0, 0.8, 0.0], [-1.0, 0.0, 0.0]);
    let scene = "(models: [(file: \"edge.obj\")], sky: (1, 1, 1), \
                 cameras: { \"default\": (eye: (3, 0.8, 0), target: (-1, 0, 0), fov_y: 40) })";
    let file = quads(
        "edge",
        "newmtl white\nKd 0.5 0.5 0.5\nPr 1\n",
        &[("white", floor), ("white", roof)],
        scene,
    );
    let (width, height) = (64u32, 48u32);
    let exact = |pixel: usize| {
        let (i, j) = (pixel as u32 % width, pixel as u32 / width);
        let forward = [target[0] - eye[0], target[1] - eye[1]];
        let length = (forward[0] * forward[0] + forward[1] * forward[1]).sqrt();
        let (fx, fy) = (forward[0] / length, forward[1] / length);
        let tan = 20f64.to_radians().tan();
        let x = (2.0 * (f64::from(i) + 0.5) / f64::from(width) - 1.0) * tan * f64::from(width)
            / f64::from(height);
        let y = (1.0 - 2.0 * (f64::from(j) + 0.5) / f64::from(height)) * tan;
        // Right of a viewer who looks along -x is -z; up is at right angles to the view.
        let d = [fx + y * fy, fy - y * fx, -x];
        let t = -eye[1] / d[1];
        let p = [eye[0] + t * d[0], t * d[2]];
        let floor = t > 0.0 && p[0].abs() < 4.0 && p[1].abs() < 4.0;
        let signed =
            |x: f64, y: f64| x.signum() * y.signum() * corner_factor(x.abs() / h, y.abs() / h);
        let [px, pz] = p;
        let hidden = signed(-px, b - pz) - signed(-a - px, b - pz) - signed(-px, -b - pz)
            + signed(-a - px, -b - pz);
        (floor && d[1] < 0.0).then_some(1.0 - hidden)
    };
    let error = |picture: &Linear| {
        let list: Vec<f64> = picture
            .rgb
            .iter()
            .enumerate()
            .filter_map(|(i, t)| exact(i).map(|e| (f64::from(t[0]) - e).powi(2)))
            .collect();
        assert!(list.len() > 800, "{} pixels of floor", list.len());
        (list.iter().sum::<f64>() / list.len() as f64).sqrt()
    };
    let mut rows = Vec::new();
    let sets: [(&str, &[(&str, &str)]); 4] = [
        ("rays", &[]),
        ("whole lobe", &[("trace", "lobe_rays")]),
        ("cones", &[("cone_count", "5")]),
        (
            "cones of 60 degrees",
            &[("diffuse_aperture", "60"), ("lod_offset", "0")],
        ),
    ];
    for (cones, set) in sets {
        let settings = [&[("voxel_dim", "64"), QUICK, ONE_BOUNCE], set].concat();
        let (parts, reference) = run(&lab, &experiment(&file, (width, height), &settings), 512);
        if cones == "rays" {
            rows.push(row(
                "reference, 512 samples",
                "RMS of openness",
                error(&reference.parts["occlusion"].mean),
                (-ANY, 0.03),
            ));
        }
        rows.push(row(
            format!("{cones}, 64 voxels"),
            "RMS of openness",
            error(&parts["occlusion"]),
            (-ANY, 0.08),
        ));
    }
    check("T5 edge", &rows);
}

/// T13. What the coloured walls of the Cornell box give to the white ones, indirect light only.
#[test]
fn colour_bleed() {
    let lab = lab(root());
    let (parts, reference) = run(
        &lab,
        &experiment(
            "cornell",
            (96, 72),
            &[("voxel_dim", "64"), QUICK, ONE_BOUNCE],
        ),
        512,
    );
    let expected = &reference.parts["diffuse"].mean;
    let light = &parts["diffuse"];
    let s = scores(light, expected).unwrap();
    // The floor beside each wall, in pixels of this view.
    let redness = |picture: &Linear, columns: std::ops::Range<usize>| {
        let texels = (62..68)
            .flat_map(|y| columns.clone().map(move |x| 96 * y + x))
            .map(|i| picture.rgb[i]);
        let (r, g) = texels.fold((0.0, 0.0), |(r, g), t| {
            (r + f64::from(t[0]), g + f64::from(t[1]))
        });
        r / g
    };
    let bleed = |columns: std::ops::Range<usize>| {
        redness(light, columns.clone()) / redness(expected, columns)
    };
    check(
        "T13 colour bleed",
        &[
            row(
                "64 voxels",
                "diffuse / reference",
                s.get("energy_ratio"),
                (0.9, 1.1),
            ),
            row(
                "64 voxels",
                "relMSE of diffuse",
                s.get("relmse"),
                (-ANY, 0.02),
            ),
            row(
                "64 voxels, floor at the red wall",
                "red over green / reference",
                bleed(20..28),
                (0.8, 1.25),
            ),
            row(
                "64 voxels, floor at the green wall",
                "red over green / reference",
                bleed(68..76),
                (0.8, 1.25),
            ),
        ],
    );
}

/// T15. A glowing strip mirrored in metal, from smooth to rough.
#[test]
fn specular_lobe() {
    let lab = lab(root());
    let mut rows = Vec::new();
    for roughness in ["0.1", "0.2", "0.4", "0.6", "0.8", "1.0"] {
        let floor = [
            [-2.0, 0.0, 2.0],
            [2.0, 0.0, 2.0],
            [2.0, 0.0, -2.0],
            [-2.0, 0.0, -2.0],
        ];
        let strip = [
            [-1.0, 0.4, -1.0],
            [1.0, 0.4, -1.0],
            [1.0, 0.9, -1.0],
            [-1.0, 0.9, -1.0],
        ];
        let scene = "(models: [(file: \"NAME.obj\")], sky: (0, 0, 0), \
                     cameras: { \"default\": (eye: (0, 1.2, 2.2), target: (0, 0, -0.3), fov_y: 50) })";
        let materials = format!(
            "newmtl metal\nKd 0.9 0.9 0.9\nPr {roughness}\nPm 1\nnewmtl strip\nKd 0 0 0\nKe 4 4 4\nPr 1\n"
        );
        let name = format!("strip-{roughness}");
        let scene = scene.replace("NAME", &name);
        let file = quads(
            &name,
            &materials,
            &[("metal", floor), ("strip", strip)],
            &scene,
        );
        let (parts, reference) = run(
            &lab,
            &experiment(
                &file,
                (64, 48),
                &[
                    ("voxel_dim", "128"),
                    ("gather_frames", "16"),
                    QUICK,
                    ONE_BOUNCE,
                ],
            ),
            256,
        );
        let s = scores(&parts["specular"], &reference.parts["specular"].mean).unwrap();
        let setting = format!("roughness {roughness}");
        rows.push(row(
            setting.clone(),
            "specular / reference",
            s.get("energy_ratio"),
            (0.8, 1.2),
        ));
        rows.push(row(
            setting.clone(),
            "relMSE of specular",
            s.get("relmse"),
            (-ANY, 0.1),
        ));
        let rays = experiment(
            &file,
            (64, 48),
            &[
                ("voxel_dim", "128"),
                ("trace", "lobe_rays"),
                QUICK,
                ONE_BOUNCE,
            ],
        );
        let (parts, reference) = run(&lab, &rays, 256);
        let s = scores(&parts["specular"], &reference.parts["specular"].mean).unwrap();
        rows.push(row(
            format!("{setting}, rays"),
            "specular / reference",
            s.get("energy_ratio"),
            (0.8, 1.2),
        ));
    }
    check("T15 specular lobe", &rows);
}
