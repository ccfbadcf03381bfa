//! Families of methods in experiments with known answers, and what their graphs are made of. docs/families.md has the
//! table of them, and every row of it is measured here again, on the software device:
//! `CONELAB_BLESS=1 cargo test --test families -- --test-threads=1` writes it anew.

mod common;

use common::figures::{ANY, Row, check, row};
use common::{assert_clean, lab, prepare, root, words};
use conelab::diagnostics::{At, Loc};
use conelab::experiment::{CameraChoice, Experiment};
use conelab::lab::{Lab, parts_of};
use conelab::measure::reference::{Goal, gather};
use conelab::metrics::Linear;
use conelab::scene::Scene;
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Graphs, and settings that suit a software device.
const FAMILIES: [(&str, &[(&str, &str)]); 8] = [
    ("rays", &[("voxel_dim", "64")]),
    ("cones", &[("voxel_dim", "64")]),
    ("thesis", &[("voxel_dim", "64")]),
    ("ddgi", &[("voxel_dim", "64"), ("probe_rows", "12")]),
    ("ssgi", &[]),
    ("ssgi_rays", &[("voxel_dim", "64")]),
    ("rsm", &[("rsm_spacing", "1")]),
    ("lpv", &[]),
];

fn experiment(family: &str, set: &[(&str, &str)], scene: &str, size: (u32, u32)) -> Experiment {
    let mut e =
        Experiment::read(&root().join("configs").join(family).with_extension("ron")).unwrap();
    e.scene = scene.into();
    e.size = size;
    for (name, value) in set.iter().chain(&[("shadow_dim", "1024")]) {
        let name = Loc {
            value: (*name).into(),
            at: At::default(),
        };
        e.params.push((name, (*value).into()));
    }
    e
}

fn opened(e: &Experiment) -> Arc<Scene> {
    let scene = Scene::open(&e.scene, &|_, _| ControlFlow::Continue(())).unwrap();
    e.adapted(Arc::new(scene)).unwrap()
}

/// The parts of an experiment's light once it has converged.
fn converged(lab: &Lab, e: &Experiment) -> BTreeMap<String, Linear> {
    let prepared = lab.prepare(e, opened(e), |graph| {
        Ok(parts_of(graph).into_iter().map(|p| p.texture).collect())
    });
    let (mut session, _) = prepared.unwrap_or_else(|e| panic!("{e}"));
    session.run(session.converging_frames().max(1)).unwrap();
    session.finish().unwrap();
    assert_eq!(session.failed_checks().unwrap(), Vec::<String>::new());
    let parts = session.parts().unwrap();
    drop(session);
    assert_clean(lab);
    parts
}

fn reference(lab: &Lab, e: &Experiment, bounces: u32, samples: u64) -> BTreeMap<String, Linear> {
    let found = gather(
        lab,
        e,
        &opened(e),
        bounces,
        Goal::Samples(samples),
        &mut |_| ControlFlow::Continue(()),
    );
    let parts = found.unwrap_or_else(|e| panic!("{e}")).parts;
    parts
        .into_iter()
        .map(|(name, part)| (name, part.mean))
        .collect()
}

/// A scene file of its own.
fn scene(name: &str, text: &str) -> String {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("families");
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join(format!("{name}.ron"));
    std::fs::write(&file, text).unwrap();
    file.to_string_lossy().into_owned()
}

/// One row for each family.
fn rows(
    figure: &'static str,
    wanted: (f64, f64),
    families: &[(&str, &[(&str, &str)])],
    value: impl Fn(&str, &[(&str, &str)]) -> f64,
) -> Vec<Row> {
    families
        .iter()
        .map(|(name, set)| row(*name, figure, value(name, set), wanted))
        .collect()
}

/// Share of the cosine-weighted hemisphere above `p` with normal `n` that a polygon covers (Lambert 1760): counter-clockwise
/// as seen from `p`, all of it above the horizon.
fn form_factor(p: [f64; 3], n: [f64; 3], corners: &[[f64; 3]]) -> f64 {
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ]
    };
    let unit = |a: [f64; 3]| a.map(|v| v / dot(a, a).sqrt());
    let towards: Vec<[f64; 3]> = corners
        .iter()
        .map(|c| unit([c[0] - p[0], c[1] - p[1], c[2] - p[2]]))
        .collect();
    let edges = (0..towards.len()).map(|i| {
        let (a, b) = (towards[i], towards[(i + 1) % towards.len()]);
        dot(a, b).clamp(-1.0, 1.0).acos() * dot(unit(cross(a, b)), n)
    });
    (edges.sum::<f64>() / TAU).abs()
}

/// A floor under a sun at the zenith, and a wall that the sun does not reach.
const CORNER: &str = "(materials: { \"floor\": (base_color: (0.8, 0.8, 0.8, 1.0), specular: 0.0),
                       \"wall\": (base_color: (0.1, 0.1, 0.1, 1.0), specular: 0.0) },
          meshes: { \"corner\": [
              Quad(material: \"floor\", corners: ((-2, 0, 3), (2, 0, 3), (2, 0, 0), (-2, 0, 0))),
              Quad(material: \"wall\", corners: ((-2, 0, 0), (2, 0, 0), (2, 2, 0), (-2, 2, 0)))] },
          lights: [Directional(name: \"sun\", color: (3, 3, 3), direction: (0, -1, 0), shadow: true)],
          sky: (0, 0, 0),
          cameras: { \"default\": (eye: (0, 1.2, 5), target: (0, 1.2, 0), fov_y: 40),
                     \"above\": (eye: (0, 4, 6), target: (0, 0.4, 1), fov_y: 45) })";

/// R1. A floor of albedo 0.8 under a sun at the zenith lights a dark wall, which the sun does not reach: its light is the
/// floor's radiance times the share of its hemisphere that the floor covers. The view is square to the wall.
#[test]
fn corner() {
    let lab = lab(root());
    let file = scene("corner", CORNER);
    let (width, height) = (64usize, 48usize);
    // Pixels of the wall, 30 cm from its edges, and their exact light.
    let half = 5.0 * 20f64.to_radians().tan();
    let mut wall = Vec::new();
    for i in 0..width * height {
        let x = (2.0 * ((i % width) as f64 + 0.5) / width as f64 - 1.0) * half * width as f64
            / height as f64;
        let y = 1.2 + (1.0 - 2.0 * ((i / width) as f64 + 0.5) / height as f64) * half;
        if x.abs() < 1.7 && (0.3..1.7).contains(&y) {
            let floor = [
                [-2.0, 0.0, 0.0],
                [2.0, 0.0, 0.0],
                [2.0, 0.0, 3.0],
                [-2.0, 0.0, 3.0],
            ];
            let share = form_factor([x, y, 0.0], [0.0, 0.0, 1.0], &floor);
            wall.push((i, 0.1 * 0.8 * 3.0 / PI * share));
        }
    }
    assert!(wall.len() > 400, "{} pixels of the wall", wall.len());
    let ratio = |light: &Linear| {
        let sum: f64 = wall.iter().map(|(i, _)| f64::from(light.rgb[*i][1])).sum();
        sum / wall.iter().map(|w| w.1).sum::<f64>()
    };
    let size = (width as u32, height as u32);
    let one = reference(&lab, &experiment("rays", &[], &file, size), 1, 256);
    let exact = ratio(&one["diffuse"]);
    assert!(
        (exact - 1.0).abs() < 0.01,
        "the reference is {exact} of the closed form"
    );
    let of = |name: &str, set: &[(&str, &str)]| {
        ratio(&converged(&lab, &experiment(name, set, &file, size))["diffuse"])
    };
    let mut list = rows("diffuse / exact", (0.95, 1.05), &FAMILIES, of);
    let whole = [
        ("rsm_spacing", "1"),
        ("rsm_radius", "1.5"),
        ("rsm_samples", "4096"),
    ];
    let found = of("rsm", &whole);
    list.push(row(
        "rsm, whole map",
        "diffuse / exact",
        found,
        (0.95, 1.05),
    ));
    // The camera sees all of the floor, and the wall's light is that of the reference.
    let all = [("ssgi_slices", "16"), ("ssgi_steps", "128")];
    let mut above = experiment("ssgi", &all, &file, size);
    above.camera = CameraChoice::Named("above".into());
    let expected = reference(&lab, &above, 1, 256);
    let light = &converged(&lab, &above)["diffuse"];
    let (mut found, mut exact) = (0.0, 0.0);
    for (i, texel) in expected["diffuse"].rgb.iter().enumerate() {
        let is_wall = expected["direct"].rgb[i][1] == 0.0 && texel[1] > 0.0;
        if is_wall {
            found += f64::from(light.rgb[i][1]);
            exact += f64::from(texel[1]);
        }
    }
    let title = "ssgi, the floor in view";
    list.push(row(
        title,
        "diffuse / reference",
        found / exact,
        (0.95, 1.05),
    ));
    check("families.md", "R1 corner", &list);
}

/// R2. A closed box of albedo 0.5 with walls that emit 1 (T1 of docs/trials.md): with all bounces its light is 2 everywhere,
/// of which surfaces reflect 1.
#[test]
fn furnace() {
    let lab = lab(root());
    check(
        "families.md",
        "R2 furnace",
        &rows("reflected / exact", (0.98, 1.02), &FAMILIES, |name, set| {
            let parts = converged(&lab, &experiment(name, set, "furnace", (48, 36)));
            parts["diffuse"].mean() + 0.5 * parts["specular"].mean()
        }),
    );
}

/// R3. A wall of 3 cm between a lit and a dark chamber, at 20 degrees to the axes: what comes through, in terms of the light of
/// the lit chamber.
#[test]
fn leak() {
    let lab = lab(root());
    let turn = |x: f64, y: f64, z: f64| {
        let (s, c) = 20f64.to_radians().sin_cos();
        format!("({:.6}, {y}, {:.6})", c * x + s * z, c * z - s * x)
    };
    let camera = |side: f64| {
        let (eye, target) = (turn(side * 1.8, 0.5, 0.8), turn(side * 0.6, -0.4, -0.4));
        format!("(eye: {eye}, target: {target}, fov_y: 70)")
    };
    let file = scene(
        "leak",
        &format!(
            "(materials: {{ \"wall\": (base_color: (0.8, 0.8, 0.8, 1.0), specular: 0.0) }},
              meshes: {{ \"chambers\": [
                  Solid([
                      Box(material: \"wall\", low: (-2.2, -1.2, -1.2), high: (2.2, 1.2, 1.2)),
                      Hollow(material: \"wall\", low: (-2, -1, -1), high: (2, 1, 1)),
                      Box(material: \"wall\", low: (-0.015, -1.1, -1.1), high: (0.015, 1.1, 1.1))])] }},
              instances: [(meshes: [\"chambers\"], transform: (rotate_deg: (0, 20, 0)))],
              lights: [Point(name: \"lamp\", color: (2, 2, 2), position: {}, shadow: true)],
              sky: (0, 0, 0),
              cameras: {{ \"lit\": {}, \"dark\": {} }})",
            turn(1.0, 0.6, 0.0),
            camera(1.0),
            camera(-1.0)
        ),
    );
    let at = |name: &str, set: &[(&str, &str)], camera: &str| {
        let mut e = experiment(name, set, &file, (48, 36));
        e.camera = CameraChoice::Named(camera.into());
        e
    };
    let lit = reference(&lab, &at("rays", &[], "lit"), 64, 64)["diffuse"].mean();
    check(
        "families.md",
        "R3 leak",
        &rows(
            "dark chamber / lit chamber",
            (-ANY, 0.01),
            &FAMILIES,
            |name, set| converged(&lab, &at(name, set, "dark"))["diffuse"].mean() / lit,
        ),
    );
}

/// R4. The Cornell box, all bounces: light of the whole picture.
#[test]
fn energy() {
    let lab = lab(root());
    let size = (64, 48);
    let expected = reference(&lab, &experiment("rays", &[], "cornell", size), 64, 256);
    let expected = expected["diffuse"].mean();
    check(
        "families.md",
        "R4 energy",
        &rows(
            "diffuse / reference",
            (0.95, 1.05),
            &FAMILIES,
            |name, set| {
                converged(&lab, &experiment(name, set, "cornell", size))["diffuse"].mean()
                    / expected
            },
        ),
    );
}

/// R5. Openness of the floor beside a roof, whose edge makes a soft step (T5 of docs/trials.md). The families that know no
/// openness are left out.
#[test]
fn edge() {
    let lab = lab(root());
    let file = scene(
        "edge",
        "(materials: { \"white\": (base_color: (0.5, 0.5, 0.5, 1.0), specular: 0.0) },
          meshes: { \"edge\": [
              Quad(material: \"white\", corners: ((-6, 0, 6), (6, 0, 6), (6, 0, -6), (-6, 0, -6))),
              Quad(material: \"white\", corners: ((-5, 1, 6), (0, 1, 6), (0, 1, -6), (-5, 1, -6)))] },
          sky: (1, 1, 1),
          cameras: { \"default\": (eye: (3, 0.8, 0), target: (-1, 0, 0), fov_y: 40) })",
    );
    let size = (64, 48);
    let expected = &reference(&lab, &experiment("rays", &[], &file, size), 1, 1024)["occlusion"];
    let open = FAMILIES
        .iter()
        .filter(|f| !["rsm", "lpv"].contains(&f.0))
        .copied();
    let open: Vec<_> = open.collect();
    check(
        "families.md",
        "R5 edge",
        &rows("RMS of openness", (-ANY, 0.08), &open, |name, set| {
            let light = &converged(&lab, &experiment(name, set, &file, size))["occlusion"];
            let squares = light.rgb.iter().zip(&expected.rgb);
            let sum: f64 = squares.map(|(a, b)| f64::from(a[0] - b[0]).powi(2)).sum();
            (sum / light.rgb.len() as f64).sqrt()
        }),
    );
}

/// Directions that fill the sphere evenly.
fn directions(count: usize) -> impl Iterator<Item = [f64; 3]> {
    (0..count).map(move |i| {
        let z = 1.0 - (2.0 * i as f64 + 1.0) / count as f64;
        let turn = TAU * (i as f64 * 0.618_033_988_749_895).fract();
        let side = (1.0 - z * z).sqrt();
        [side * turn.cos(), side * turn.sin(), z]
    })
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Real spherical harmonics of bands 0 and 1.
fn harmonics(d: [f64; 3]) -> [f64; 4] {
    let band = (3.0 / (4.0 * PI)).sqrt();
    [(0.25 / PI).sqrt(), band * d[0], band * d[1], band * d[2]]
}

const AXES: [[f64; 3]; 6] = [
    [1.0, 0.0, 0.0],
    [-1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, -1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.0, 0.0, -1.0],
];

/// The scheme of Kaplanyan and Dachsbacher 2010 without blockers, on the CPU, with lobes and solid angles by numerical
/// integration: what the graph injects, propagated, is what the graph sums.
#[test]
fn light_propagates_as_in_a_simulation_of_its_own() {
    const N: i32 = 8;
    const STEPS: usize = 5;
    const SAMPLES: usize = 200_000;
    let lab = lab(root());
    let file = scene("corner", CORNER);
    let set = [
        ("lpv_dim", "8"),
        ("lpv_steps", "5"),
        ("lpv_blocking", "off"),
        ("rsm_dim", "64"),
    ];
    let e = experiment("lpv", &set, &file, (32, 24));
    let mut session = prepare(&lab, &e, &["radiance"]);
    session.frame(0.0).unwrap();
    session.finish().unwrap();
    let injected = words(&mut session, "lpvInjected");
    let sums = words(&mut session, "lpvSums");
    drop(session);
    assert_clean(&lab);
    let cells = (N * N * N) as usize;
    assert_eq!((injected.len(), sums.len()), (24 * cells, 12 * cells));
    let number = |i: usize| {
        let bits = u64::from(injected[2 * i]) | u64::from(injected[2 * i + 1]) << 32;
        bits as i64 as f64 / 65536.0
    };
    // Red of each cell.
    let mut wave: Vec<[f64; 4]> = (0..cells)
        .map(|c| [0, 1, 2, 3].map(|i| number(12 * c + i)))
        .collect();
    assert!(wave.iter().any(|c| c[0] > 0.0), "nothing is injected");

    let lobe = |n: [f64; 3]| {
        let mut sum = [0.0; 4];
        for d in directions(SAMPLES) {
            let (y, cosine) = (harmonics(d), dot(d, n).max(0.0));
            for i in 0..4 {
                sum[i] += 4.0 * PI / SAMPLES as f64 * cosine * y[i];
            }
        }
        sum
    };
    let lobes = AXES.map(lobe);
    // Solid angles of the far face and of a side face of the neighbour along +x.
    let (mut far, mut side) = (0.0, 0.0);
    for d in directions(SAMPLES).filter(|d| d[0] > 0.0) {
        let (entry, exit) = (d.map(|v| 0.5 * v / d[0]), d.map(|v| 1.5 * v / d[0]));
        let inside = |p: [f64; 3]| p[1].abs() < 0.5 && p[2].abs() < 0.5;
        if !inside(entry) {
            continue;
        }
        if inside(exit) {
            far += 4.0 * PI / SAMPLES as f64;
        } else {
            side += PI / SAMPLES as f64;
        }
    }
    let index = |c: [i32; 3]| {
        let inside = c.iter().all(|v| (0..N).contains(v));
        inside.then(|| (c[0] + N * (c[1] + N * c[2])) as usize)
    };
    let mut expected = vec![[0.0; 4]; cells];
    for _ in 0..STEPS {
        let mut next = vec![[0.0; 4]; cells];
        for c in 0..cells as i32 {
            let cell = [c % N, c / N % N, c / (N * N)];
            for (i, along) in AXES.iter().enumerate() {
                let from = [0, 1, 2].map(|k| cell[k] - along[k] as i32);
                let Some(source) = index(from).map(|s| wave[s]) else {
                    continue;
                };
                for (f, face) in AXES.iter().enumerate().filter(|(f, _)| *f != (i ^ 1)) {
                    let to = [0, 1, 2].map(|k| along[k] + 0.5 * face[k]);
                    let y = harmonics(to.map(|v| v / dot(to, to).sqrt()));
                    let intensity: f64 = (0..4).map(|k| source[k] * y[k]).sum();
                    let flux = intensity.max(0.0) * if f == i { far } else { side };
                    for k in 0..4 {
                        next[c as usize][k] += flux / PI * lobes[f][k];
                    }
                }
            }
        }
        for (sum, light) in expected.iter_mut().zip(&next) {
            (0..4).for_each(|k| sum[k] += light[k]);
        }
        wave = next;
    }
    let (mut difference, mut whole) = (0.0, 0.0);
    for (c, expected) in expected.iter().enumerate() {
        for (k, expected) in expected.iter().enumerate() {
            let found = f64::from(f32::from_bits(sums[12 * c + k]));
            difference += (found - expected).abs();
            whole += expected.abs();
        }
    }
    assert!(
        whole > 0.0 && difference < 0.005 * whole,
        "{difference} of {whole}"
    );
}

/// Parameters of the families, another value than the default, and a scene where it matters.
const OTHERS: [(&str, &str, &str, &str); 20] = [
    ("rsm", "rsm_dim", "128", "cornell"),
    ("rsm", "rsm_samples", "32", "cornell"),
    ("rsm", "rsm_radius", "0.1", "cornell"),
    ("rsm", "rsm_spacing", "1", "cornell"),
    ("rsm", "reflections", "none", "cornell"),
    ("lpv", "lpv_dim", "16", "cornell"),
    ("lpv", "lpv_cascades", "2", "cornell"),
    ("lpv", "lpv_steps", "4", "cornell"),
    ("lpv", "lpv_blocking", "off", "cornell"),
    ("ddgi", "probe_rows", "4", "cornell"),
    ("ddgi", "probe_rays", "32", "cornell"),
    ("ddgi", "probe_hysteresis", "0.0", "cornell"),
    ("ddgi", "probe_bias", "1.0", "cornell"),
    ("ddgi", "probe_moves", "off", "cornell"),
    ("ssgi", "ssgi_slices", "1", "cornell"),
    ("ssgi", "ssgi_steps", "4", "cornell"),
    ("ssgi", "ssgi_radius", "0.2", "cornell"),
    ("ssgi", "ssgi_thickness", "0.01", "cornell"),
    ("ssgi", "screen_miss", "dark", "sky-window"),
    ("ssgi_rays", "ssgi_thickness", "0.2", "cornell"),
];

/// tests/options.rs renders one frame, in which most families have no light yet.
#[test]
fn every_parameter_of_a_family_changes_its_light() {
    let lab = lab(root());
    let light = |family: &str, set: &[(&str, &str)], scene: &str| {
        let small: &[(&str, &str)] = match family {
            "ddgi" => &[("voxel_dim", "32"), ("probe_rows", "6")],
            "ssgi_rays" => &[("voxel_dim", "32")],
            _ => &[],
        };
        let e = experiment(family, &[small, set].concat(), scene, (40, 30));
        let mut session = prepare(&lab, &e, &["radiance"]);
        session.run(4).unwrap();
        session.finish().unwrap();
        session.texels("radiance", 0, 0).unwrap().bytes
    };
    let mut same = Vec::new();
    for (family, name, value, scene) in OTHERS {
        if light(family, &[], scene) == light(family, &[(name, value)], scene) {
            same.push((family, name));
        }
    }
    assert!(same.is_empty(), "{same:?}");
    assert_clean(&lab);
}

/// Lines of code of a shader, or of all in a folder: neither blank nor a comment.
fn lines(path: &Path) -> usize {
    if path.is_dir() {
        let files = std::fs::read_dir(path).unwrap();
        return files.map(|f| lines(&f.unwrap().path())).sum();
    }
    let text = std::fs::read_to_string(path).unwrap();
    let code = |l: &&str| !l.trim().is_empty() && !l.trim().starts_with("//");
    text.lines().filter(code).count()
}

#[test]
fn a_family_takes_at_most_300_lines_of_shaders() {
    let page = std::fs::read_to_string(root().join("docs/families.md")).unwrap();
    for (graph, paths) in [
        ("rsm", &["rsm"][..]),
        ("lpv", &["lpv", "rsm/map.vert", "rsm/map.frag"]),
        ("ddgi", &["ddgi"]),
        ("ssgi", &["ssgi", "modules/screen_miss"]),
    ] {
        let lines: usize = paths
            .iter()
            .map(|p| lines(&root().join("shaders").join(p)))
            .sum();
        println!("{graph}: {lines}");
        let row = format!("| `{graph}.ron` |");
        let row = page.lines().find(|l| l.starts_with(&row)).unwrap();
        assert!(
            row.contains(&format!("| {lines} |")),
            "{row} but {lines} lines"
        );
        assert!((50..=300).contains(&lines), "{graph}: {lines} lines");
    }
}
