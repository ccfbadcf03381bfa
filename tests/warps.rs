//! Warps: what the shaders say about cells against formulas, finite differences and the exact cells, on the device itself.

mod common;

use common::closed_meshes::{placed, torus};
use common::{assert_clean, floats, lab, prepare, root, scene};
use conelab::diagnostics::{At, Loc};
use conelab::experiment::{Experiment, PlacedCamera};
use conelab::graph::table::{Cell, decode};
use conelab::lab::{Lab, Session};
use conelab::measure::oracle::{Score, Surfaces, compare, exact, read, triangles_of};
use conelab::scene::{Material, Scene};
use glam::{DMat3, DVec3, Quat, Vec3};
use std::sync::Arc;
use tempfile::TempDir;

/// An experiment of the graph that measures warps.
fn experiment(scene: &str, size: (u32, u32), settings: &[(&str, &str)]) -> Experiment {
    let graph = common::graph_with(&[settings, &[("volume_offset", "")]].concat());
    Experiment {
        graph,
        ..common::experiment(scene, size, settings)
    }
}

/// What is known of a warp besides its shader.
enum Shape {
    /// A function of each axis of a box (thesis, Section 4.6).
    Box(fn(f64) -> f64),
    /// The view frustum, depth linear in metres.
    Frustum,
    /// Azimuth, angle from the vertical, logarithm of the distance.
    Sphere,
}

struct Warp {
    title: &'static str,
    set: &'static [(&'static str, &'static str)],
    shape: Shape,
}

const WARPS: [Warp; 9] = [
    Warp {
        title: "none",
        set: &[],
        shape: Shape::Box(|x| x),
    },
    Warp {
        title: "spline 0.05",
        set: &[SPLINE, ("warp_alpha", "0.05")],
        shape: Shape::Box(|x| spline(0.05, x)),
    },
    Warp {
        title: "spline 0.25",
        set: &[SPLINE, ("warp_alpha", "0.25")],
        shape: Shape::Box(|x| spline(0.25, x)),
    },
    Warp {
        title: "spline 1",
        set: &[SPLINE, ("warp_alpha", "1.0")],
        shape: Shape::Box(|x| spline(1.0, x)),
    },
    Warp {
        title: "logistic 0.5",
        set: &[LOGISTIC, ("warp_steepness", "0.5")],
        shape: Shape::Box(|x| logistic(0.5, x)),
    },
    Warp {
        title: "logistic 8",
        set: &[LOGISTIC, ("warp_steepness", "8.0")],
        shape: Shape::Box(|x| logistic(8.0, x)),
    },
    Warp {
        title: "logistic 20",
        set: &[LOGISTIC, ("warp_steepness", "20.0")],
        shape: Shape::Box(|x| logistic(20.0, x)),
    },
    Warp {
        title: "perspective",
        set: &[("warp", "perspective")],
        shape: Shape::Frustum,
    },
    Warp {
        title: "spherical",
        set: &[("warp", "spherical")],
        shape: Shape::Sphere,
    },
];

const SPLINE: (&str, &str) = ("warp", "spline");
const LOGISTIC: (&str, &str) = ("warp", "logistic");

/// The cubic from 0 to 1 with slope alpha at both ends.
fn spline(alpha: f64, x: f64) -> f64 {
    alpha * x + (3.0 - 3.0 * alpha) * x * x + (2.0 * alpha - 2.0) * x * x * x
}

/// The logistic function of that steepness around 1/2, stretched so that 0 and 1 stay where they are.
fn logistic(steepness: f64, x: f64) -> f64 {
    let raw = |x: f64| 1.0 / (1.0 + (-steepness * (x - 0.5)).exp());
    (raw(x) - raw(0.0)) / (raw(1.0) - raw(0.0))
}

/// A volume that follows the camera, wherever it is: 6 m along every edge.
const SIZE: f64 = 6.0;
const BASE: [(&str, &str); 6] = [
    ("voxel_dim", "32"),
    ("volume", "camera"),
    ("volume_snap", "off"),
    ("volume_size", "(6, 6, 6)"),
    ("shadow_dim", "256"),
    ("warp_near", "0.5"),
];
const FAR: f64 = 30.0;

/// Random points, and points of the line along each axis.
const POINTS: usize = 100_000;
const LINE: usize = 4096;

/// The method with one pass more, which writes what `volume.glsl` says about points.
const GRAPH: &str = r#"(
    include: ["warps.ron"],
    params: [
        Vec3(name: "density_at", default: (0.5, 0.5, 0.5), help: "Places along x, from 0 to 1, whose density colours are asked for."),
    ],
    buffers: { "mapping": (size: "100000 * 192 + 4096 * 3 * 32 + 27 * 48 + 3 * 16") },
    passes: [ (name: "map points", shaders: ["map_points.comp"], dispatch: Threads("100000", "1", "1")) ],
)"#;

const MAP_POINTS: &str = "#version 460
#extension GL_GOOGLE_include_directive : require
#include \"params.glsl\"
#include \"common/scene.glsl\"
#include \"common/random.glsl\"
#include \"volume/volume.glsl\"
#include \"display/density.glsl\"
layout(local_size_x = 64) in;
struct Row { vec4 there, back, at, image, again, a0, a1, a2, d0, d1, d2, inside; };
struct Step { vec4 at, image; };
struct End { vec4 at, image, past; };
layout(std430) writeonly buffer Mapping { Row rows[100000]; Step line[3 * 4096]; End ends[27]; vec4 density[3]; } mapping;
const float STEP = 0.01; // m

vec3 forward(vec3 p) { return worldToVolume(volume.maps[0], p); }
vec3 world(vec3 u) { return volumeToWorld(volume.maps[0], u); }

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= 100000u) return;
    Random random = Random(uvec4(i, 7u, 0u, 1u));
    vec3 u = next4(random).xyz, r = next4(random).xyz;
    // Everywhere in the world's part, not only where cells are dense.
    vec3 p = CURVED ? world(r) : mix(world(vec3(0.0)), world(vec3(1.0)), r);
    vec3 image = forward(p);
    mat3 axes = cellAxes(volume.maps[0], p);
    vec3 d[3], inside = vec3(1.0);
    for (int a = 0; a < 3; a++) {
        vec3 before = p, after = p;
        before[a] -= STEP;
        after[a] += STEP;
        d[a] = (forward(after) - forward(before)) / (after[a] - before[a]);
        if (!inVolume(forward(before)) || !inVolume(forward(after))) inside = vec3(0.0);
    }
    // Not where spheres have their seam and their poles.
    if (CURVED_SEAM && (abs(image.x - 0.5) > 0.45 || abs(image.y - 0.5) > 0.35)) inside = vec3(0.0);
    mapping.rows[i] = Row(vec4(u, 0.0), vec4(forward(world(u)), 0.0), vec4(p, 0.0), vec4(image, 0.0), vec4(world(image), 0.0),
        vec4(axes[0], 0.0), vec4(axes[1], 0.0), vec4(axes[2], 0.0), vec4(d[0], 0.0), vec4(d[1], 0.0), vec4(d[2], 0.0), vec4(inside, 0.0));
    if (i < 3u * 4096u) {
        vec3 at = vec3(0.3, 0.6, 0.4);
        at[i / 4096u] = float(i % 4096u) / 4095.0;
        mapping.line[i] = Step(vec4(world(at), 0.0), vec4(forward(world(at)), 0.0));
    }
    if (i < 27u) {
        vec3 end = 0.5 * vec3(i % 3u, i / 3u % 3u, i / 9u);
        vec3 middle = world(vec3(0.5)), at = world(end);
        mapping.ends[i] = End(vec4(at, 0.0), vec4(forward(at), 0.0), vec4(forward(middle + 1.02 * (at - middle)), 0.0));
    }
    if (i < 3u) {
        vec3 at = world(vec3(0.5));
        at.x = mix(world(vec3(0.0)).x, world(vec3(1.0)).x, params.density_at[i]);
        mapping.density[i] = vec4(densityColor(volume.maps[0], at), 0.0);
    }
}
";

fn home() -> TempDir {
    let home = common::home();
    std::fs::write(home.path().join("passes/mapping.ron"), GRAPH).unwrap();
    std::fs::write(home.path().join("shaders/map_points.comp"), MAP_POINTS).unwrap();
    home
}

/// A session that writes the mapping of the volume.
fn mapping_session(lab: &Lab, settings: &[(&str, &str)]) -> Session {
    let mut experiment = experiment("cornell", (16, 16), &BASE);
    experiment.graph = "mapping.ron".into();
    experiment
        .params
        .extend(settings.iter().map(|(name, value)| {
            (
                Loc {
                    value: (*name).to_string(),
                    at: At::default(),
                },
                (*value).to_string(),
            )
        }));
    prepare(lab, &experiment, &["mapping"])
}

/// What the shader wrote, by kind: rows of so many vectors.
struct Mapping {
    rows: Vec<[DVec3; 12]>,
    lines: Vec<[DVec3; 2]>,
    ends: Vec<[DVec3; 3]>,
    density: Vec<DVec3>,
}

fn mapping(lab: &Lab, session: &mut Session) -> Mapping {
    session.frame(0.0).unwrap();
    session.finish().unwrap();
    assert_clean(lab);
    let bytes = session.buffer("mapping").unwrap();
    let numbers: Vec<f64> = bytes
        .as_chunks::<4>()
        .0
        .iter()
        .map(|b| f64::from(f32::from_ne_bytes(*b)))
        .collect();
    assert!(
        numbers.iter().all(|n| n.is_finite()),
        "every point has a place"
    );
    let vectors: Vec<DVec3> = numbers
        .as_chunks::<4>()
        .0
        .iter()
        .map(|v| DVec3::new(v[0], v[1], v[2]))
        .collect();
    let (rows, rest) = vectors.split_at(12 * POINTS);
    let (lines, rest) = rest.split_at(2 * 3 * LINE);
    let (ends, density) = rest.split_at(3 * 27);
    Mapping {
        rows: rows.as_chunks().0.to_vec(),
        lines: lines.as_chunks().0.to_vec(),
        ends: ends.as_chunks().0.to_vec(),
        density: density.to_vec(),
    }
}

fn cameras() -> [PlacedCamera; 3] {
    [
        PlacedCamera::new((2.78, 2.73, 7.0), (2.78, 2.73, 0.0), 40.0),
        PlacedCamera::new((0.5, 4.0, 1.0), (5.0, 0.2, 3.0), 75.0),
        PlacedCamera::new((-8.0, 9.0, -11.0), (3.0, 2.0, 2.0), 20.0),
    ]
}

/// Where a point of the volume lies in the world, from settings and camera alone.
fn place(warp: &Warp, camera: &PlacedCamera, u: DVec3) -> DVec3 {
    let vector = |v: (f32, f32, f32)| DVec3::new(v.0.into(), v.1.into(), v.2.into());
    let (eye, target) = (vector(camera.eye), vector(camera.target));
    match warp.shape {
        // Only of the ends and the middle, which no such warp moves.
        Shape::Box(_) => eye + SIZE * (u - 0.5),
        Shape::Frustum => {
            let ahead = (target - eye).normalize();
            let right = ahead.cross(DVec3::Y).normalize();
            let half = (f64::from(camera.fov_y).to_radians() * 0.5).tan(); // the picture is square
            let across = (2.0 * u.x - 1.0) * right + (2.0 * u.y - 1.0) * ahead.cross(right);
            eye + (0.5 + (FAR - 0.5) * u.z) * (ahead + half * across)
        }
        Shape::Sphere => {
            let (around, down) = (
                2.0 * std::f64::consts::PI * (u.x - 0.5),
                std::f64::consts::PI * u.y,
            );
            let way = DVec3::new(
                down.sin() * around.cos(),
                down.cos(),
                down.sin() * around.sin(),
            );
            eye + 0.5 * (FAR / 0.5).powf(u.z) * way
        }
    }
}

#[test]
fn every_warp_is_a_bijection() {
    let home = home();
    let lab = lab(home.path());
    for warp in &WARPS {
        let mut session = mapping_session(&lab, warp.set);
        for camera in cameras() {
            session.place_camera(&camera);
            let mapping = mapping(&lab, &mut session);
            let title = format!("{} from {:?}", warp.title, camera.eye);
            let size = if matches!(warp.shape, Shape::Box(_)) {
                SIZE
            } else {
                FAR
            };

            let mut worst = (0.0f64, 0.0f64, 0.0f64, 0.0f64);
            for [u, back, p, image, again, a0, a1, a2, ..] in &mapping.rows {
                let mut off = (*back - *u).abs();
                if let Shape::Sphere = warp.shape {
                    // The first azimuth is the last, and towards the poles it is less and less of a way.
                    off.x = off.x.min(1.0 - off.x) * (std::f64::consts::PI * u.y).sin();
                }
                worst.0 = worst.0.max(off.max_element());
                let away = (*p - *again).abs().max_element() / size;
                worst.1 = worst.1.max(away);
                // No formula gets nearer than half a float's step in the volume, in the world (and those of the world).
                let metres = 32.0 * a0.length().max(a1.length()).max(a2.length());
                let step = metres / size * f64::from(f32::EPSILON) * 0.25 + 5e-7;
                worst.2 = worst.2.max(away / step.max(1e-5));
                if let Shape::Box(w) = &warp.shape {
                    let eye = place(warp, &camera, DVec3::splat(0.5));
                    let x = (*p - eye) / SIZE + 0.5;
                    worst.3 = worst.3.max(
                        (*image - DVec3::new(w(x.x), w(x.y), w(x.z)))
                            .abs()
                            .max_element(),
                    );
                }
            }
            println!(
                "{title}: volume and back {:.1e}, world and back {:.1e} of the volume's size, formula {:.1e}",
                worst.0, worst.1, worst.3
            );
            assert!(
                worst.0 <= 1e-5,
                "{title}: to the world and back {}",
                worst.0
            );
            assert!(
                worst.2 <= 1.0,
                "{title}: to the volume and back {}, {} of what floats allow",
                worst.1,
                worst.2
            );
            assert!(worst.3 <= 1e-5, "{title}: {} from the formula", worst.3);

            for (axis, line) in mapping.lines.as_chunks::<LINE>().0.iter().enumerate() {
                let whole = line[LINE - 1][0] - line[0][0];
                let circle = matches!(warp.shape, Shape::Sphere) && axis < 2;
                let rises = |w: &[[DVec3; 2]]| {
                    (circle || (w[1][0] - w[0][0]).dot(whole) > 0.0)
                        && w[1][1][axis] >= w[0][1][axis]
                };
                // Around the whole circle back to where it begins.
                let line = if circle {
                    &line[1..LINE - 1]
                } else {
                    &line[..]
                };
                assert!(
                    line.windows(2).all(rises),
                    "{title}: not monotonic along axis {axis}"
                );
            }
            for (i, [at, image, past]) in mapping.ends.iter().enumerate() {
                let end = 0.5 * DVec3::new((i % 3) as f64, (i / 3 % 3) as f64, (i / 9) as f64);
                let off = at.distance(place(warp, &camera, end)) / size;
                assert!(
                    off < 2e-6,
                    "{title}: {end} lies at {at}, {off} of the size off"
                );
                if let Shape::Sphere = warp.shape {
                    assert!(
                        (image.z - end.z).abs() <= 1e-5,
                        "{title}: {end} comes back as {image}"
                    );
                    continue;
                }
                assert!(
                    (*image - end).abs().max_element() <= 1e-5,
                    "{title}: {end} comes back as {image}"
                );
                let outside = past.min_element() < 0.0 || past.max_element() > 1.0;
                assert!(
                    outside || end == DVec3::splat(0.5),
                    "{title}: past {end} is {past}, inside"
                );
            }
        }
    }
}

#[test]
fn cells_are_as_long_as_finite_differences_say() {
    let home = home();
    let lab = lab(home.path());
    for warp in &WARPS {
        let mapping = mapping(&lab, &mut mapping_session(&lab, warp.set));
        let (mut worst, mut rows) = (0.0f64, 0);
        for [.., a0, a1, a2, d0, d1, d2, inside] in &mapping.rows {
            if inside.x == 0.0 {
                continue;
            }
            rows += 1;
            // How the place in the volume changes along x, y and z: what the cells' edges say, and differences over 2 cm.
            let analytic = (DMat3::from_cols(*a0, *a1, *a2) * 32.0).inverse();
            let differences = DMat3::from_cols(*d0, *d1, *d2);
            for axis in 0..3 {
                let (a, d) = (analytic.row(axis), differences.row(axis));
                // 32 bits leave about 1e-7 of the volume on each side of a difference.
                worst = worst.max(a.distance(d) / (0.003 * a.length() + 2e-5));
            }
        }
        println!(
            "{}: {rows} points, {worst:.2} of what is allowed",
            warp.title
        );
        assert!(rows > 50_000, "{}: {rows} points", warp.title);
        assert!(
            worst < 1.0,
            "{}: cells and differences disagree, {worst} of what is allowed",
            warp.title
        );
    }
}

#[test]
fn density_is_told_by_hue() {
    let home = home();
    let lab = lab(home.path());
    let slope = |x: f64| (logistic(20.0, x + 1e-6) - logistic(20.0, x - 1e-6)) / 2e-6;
    // From 5 in the middle down to nearly 0 at the border.
    let at = |wanted: f64| {
        let (mut low, mut high) = (0.5, 1.0);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if slope(middle) > wanted {
                low = middle
            } else {
                high = middle
            }
        }
        low
    };
    let places = [2.0, 1.0, 0.5].map(at);
    let asked = format!("({}, {}, {})", places[0], places[1], places[2]);
    let mut session = mapping_session(
        &lab,
        &[LOGISTIC, ("warp_steepness", "20.0"), ("density_at", &asked)],
    );
    let found = mapping(&lab, &mut session).density;
    println!("slope 2, 1, 1/2 at {asked}: {found:?}");
    for (colour, expected) in found.iter().zip([DVec3::Z, DVec3::Y, DVec3::X]) {
        assert!(
            colour.abs_diff_eq(expected, 0.01),
            "{colour} is not {expected}"
        );
    }

    // In the picture: green alone without a warp; with one, bluer in the middle than at the sides.
    let view = |warp: &str| -> Vec<[f32; 4]> {
        let box_ = [
            ("volume", "box"),
            ("volume_center", "(2.78, 2.74, 2.8)"),
            ("volume_size", "(6, 6, 6)"),
        ];
        let settings = [
            &box_[..],
            &[("voxel_dim", "32"), ("density", "surfaces"), ("warp", warp)],
        ]
        .concat();
        let mut session = prepare(
            &lab,
            &experiment("cornell", (32, 32), &settings),
            &["inspected"],
        );
        session.frame(0.0).unwrap();
        session.finish().unwrap();
        floats(&mut session, "inspected", 0)
    };
    let hues = |texels: &[[f32; 4]], x: std::ops::Range<usize>| {
        let inside = texels
            .iter()
            .enumerate()
            .filter(|(i, t)| x.contains(&(i % 32)) && t[0] + t[1] + t[2] > 0.0);
        let sum = inside
            .map(|(_, t)| Vec3::new(t[0], t[1], t[2]) / (t[0] + t[1] + t[2]))
            .sum::<Vec3>();
        sum / (sum.x + sum.y + sum.z)
    };
    let even = view("none");
    assert!(
        hues(&even, 0..32).abs_diff_eq(Vec3::Y, 1e-3),
        "{}",
        hues(&even, 0..32)
    );
    let warped = view("spline");
    let (middle, side) = (hues(&warped, 14..18), hues(&warped, 2..5));
    println!("spline: {middle:.2} in the middle of the picture, {side:.2} at its side");
    assert!(
        middle.z > 0.3 && middle.x < 0.05 && side.x > 0.3 && side.z < 0.05,
        "{middle} {side}"
    );
}

/// The voxels of a frame against the exact cells.
fn score(lab: &Lab, scene: &Arc<Scene>, settings: &[(&str, &str)]) -> Score {
    let experiment = experiment("cornell", (16, 16), settings);
    let (mut session, _) = lab
        .prepare(&experiment, scene.clone(), conelab::measure::oracle::wanted)
        .unwrap();
    session.frame(0.0).unwrap();
    session.finish().unwrap();
    assert_eq!(
        session.failed_checks().unwrap(),
        Vec::<String>::new(),
        "{settings:?}"
    );
    let (grid, voxels) = read(&mut session).unwrap();
    compare(
        &grid,
        &exact(&triangles_of(scene, 0.0), &Surfaces::new(scene), &grid),
        &voxels,
    )
    .score
}

const OFF: [(&str, &str); 2] = [("voxelizer", "raster"), ("conservative", "off")];

#[test]
fn no_warp_loses_voxels() {
    let lab = lab(root());
    let paint = vec![Material {
        base_color: [0.7, 0.4, 0.1, 1.0].into(),
        two_sided: true,
        ..Material::default()
    }];
    let mut torus = placed(torus(24, 12), paint, Vec::new());
    torus.instances[0].transform =
        glam::Mat4::from_quat(Quat::from_xyzw(0.3, -0.5, 0.2, 0.8).normalize());
    let scenes = [
        ("cornell", scene("cornell")),
        ("turned torus", Arc::new(torus)),
    ];
    let modes = [
        ("off", OFF),
        ("msaa", [("voxelizer", "raster"), ("conservative", "msaa")]),
        (
            "dilate",
            [("voxelizer", "raster"), ("conservative", "dilate")],
        ),
        (
            "tessellated",
            [("voxelizer", "tessellated"), ("tess_rate", "1.0")],
        ),
        (
            "compute",
            [("voxelizer", "compute"), ("conservative", "off")],
        ),
    ];
    let base = [("voxel_dim", "48"), ("shadow_dim", "256")];
    for (name, scene) in &scenes {
        let recall = |set: &[(&str, &str)]| {
            let score = score(&lab, scene, &[&base[..], set].concat());
            (score.recall.unwrap(), score.thin_recall.unwrap())
        };
        for (mode, set) in modes {
            let [even, spline, logistic] = ["none", "spline", "logistic"]
                .map(|warp| recall(&[&set[..], &[("warp", warp)]].concat()));
            println!(
                "{name}, {mode}: recall and thin recall {even:.4?} without a warp, spline {spline:.4?}, logistic {logistic:.4?}"
            );
            // Where cells are dense more of them lie on the box's turned blocks, and of those the points miss some that are
            // cut at a corner: but none that is needed to block a way through faces.
            let blocks = |thin: f64| (*name, mode) == ("cornell", "tessellated") && thin >= even.1;
            for (all, thin) in [spline, logistic] {
                let slack = if blocks(thin) { 0.005 } else { 0.001 };
                assert!(all >= even.0 - slack, "{name}, {mode}: a warp loses voxels");
            }
        }
        // The thesis's cracks (Figure 4.10): pixels of the grid where cells are denser.
        for warp in ["spline", "logistic"] {
            let [scaled, grid] = ["scaled", "grid"].map(|viewport| {
                recall(&[&OFF[..], &[("warp", warp), ("warp_viewport", viewport)]].concat()).0
            });
            println!(
                "{name}, {warp}: recall {scaled:.4} with the scaled viewport, {grid:.4} with the grid's"
            );
            assert!(
                grid < scaled - 0.2,
                "{name}, {warp}: no cracks, {grid} against {scaled}"
            );
        }
    }
    assert_clean(&lab);
}

#[test]
fn the_list_of_fragments_is_long_enough_for_every_slope() {
    let lab = lab(root());
    let base = [("voxel_dim", "64"), ("shadow_dim", "256")];
    let volume = [
        ("volume", "box"),
        ("volume_center", "(2.78, 2.74, 2.8)"),
        ("volume_size", "(6, 6, 6)"),
    ];
    let warps = [
        ("none", vec![]),
        ("spline 0.05", vec![SPLINE, ("warp_alpha", "0.05")]),
        ("logistic 8", vec![LOGISTIC, ("warp_steepness", "8.0")]),
        ("logistic 20", vec![LOGISTIC, ("warp_steepness", "20.0")]),
        ("perspective", vec![("warp", "perspective")]),
    ];
    let modes = [
        (
            "off",
            vec![("voxelizer", "raster"), ("conservative", "off")],
        ),
        (
            "msaa",
            vec![("voxelizer", "raster"), ("conservative", "msaa")],
        ),
        (
            "dilate",
            vec![("voxelizer", "raster"), ("conservative", "dilate")],
        ),
        ("tessellated", vec![("voxelizer", "tessellated")]),
        (
            "tessellated x2",
            vec![("voxelizer", "tessellated"), ("tess_rate", "2.0")],
        ),
    ];
    let mut full = Vec::new();
    for ((warp, set), (mode, how)) in warps.iter().flat_map(|w| modes.iter().map(move |m| (w, m))) {
        let settings = [&base[..], &volume, set, how].concat();
        let mut session = prepare(
            &lab,
            &experiment("cornell", (16, 16), &settings),
            &["voxelColor"],
        );
        session.frame(0.0).unwrap();
        session.finish().unwrap();
        let words: Vec<u32> = session
            .buffer("voxelCounter")
            .unwrap()
            .as_chunks::<4>()
            .0
            .iter()
            .map(|b| u32::from_ne_bytes(*b))
            .collect();
        let list = session.program.plan.buffers[session
            .graph
            .buffers
            .iter()
            .position(|b| b.0 == "voxelFragments")
            .unwrap()]
        .size
            / 16;
        let fragments = words[2]; // shaders/voxels/voxels.glsl
        println!("{warp}, {mode}: {fragments} fragments in a list of {list}");
        assert!(fragments > 0, "{warp}, {mode}");
        full.extend(
            session
                .failed_checks()
                .unwrap()
                .iter()
                .map(|f| format!("{warp}, {mode}: {f}")),
        );
    }
    assert_eq!(full, Vec::<String>::new());
    assert_clean(&lab);
}

#[test]
fn cones_go_by_the_cells_around_them() {
    let lab = lab(root());
    let settings = [
        ("voxel_dim", "64"),
        ("shadow_dim", "512"),
        ("volume", "box"),
        ("volume_center", "(2.78, 2.74, 2.8)"),
        ("volume_size", "(6, 6, 6)"),
        ("warp", "spline"),
        ("warp_alpha", "0.25"),
        // Levels alone, by the cone alone, and cones so thin that they stay fine for long.
        ("lod_offset", "0"),
        ("emitter_rays", "0"),
        ("gather_frames", "1"),
        ("diffuse_aperture", "4.0"),
        ("probe", "(32.5, 44.5)"),
    ];
    let mut session = prepare(
        &lab,
        &experiment("cornell", (64, 48), &settings),
        &["coneSamples"],
    );
    session.frame(0.0).unwrap();
    session.finish().unwrap();
    let table = session.table(0).unwrap();
    let rows = decode(&table, &session.buffer("coneSamples").unwrap());
    let column = |name: &str| table.columns.iter().position(|c| c.name == name).unwrap();
    let number = |row: &[Cell], name: &str| match row[column(name)] {
        Cell::Uint(v) => f64::from(v),
        Cell::Float(v) => f64::from(v),
        _ => panic!("{name}"),
    };
    let position = |row: &[Cell]| match &row[column("position")] {
        Cell::Vector(v) => DVec3::new(v[0].into(), v[1].into(), v[2].into()),
        _ => panic!("position"),
    };
    // Cells crossed on a metre of a direction, by the spline alone.
    let local = |p: DVec3, d: DVec3| {
        let slope = |x: f64| (spline(0.25, x + 1e-6) - spline(0.25, x - 1e-6)) / 2e-6;
        let x = (p - DVec3::new(2.78, 2.74, 2.8)) / 6.0 + 0.5;
        1.0 / (d * DVec3::new(slope(x.x), slope(x.y), slope(x.z)) * 64.0 / 6.0).length()
    };
    // They start a local cell above the floor.
    let bytes = session.buffer("coneSamples").unwrap();
    let words: Vec<f32> = bytes.as_chunks::<4>().0[..12]
        .iter()
        .map(|b| f32::from_ne_bytes(*b))
        .collect();
    let (surface, origin) = (
        Vec3::from_slice(&words[4..7]).as_dvec3(),
        Vec3::from_slice(&words[8..11]).as_dvec3(),
    );
    let above = local(surface, DVec3::Y);
    assert!(
        (origin - surface).abs_diff_eq(DVec3::Y * above, 0.01 * above),
        "from {surface} to {origin}, not {above} up"
    );
    let (mut empty, mut cells) = (0, Vec::new());
    for pair in rows.windows(2) {
        let [row, next] = [&pair[0], &pair[1]];
        if number(row, "cone") != number(next, "cone") {
            continue;
        }
        let (p, d) = (position(row), (position(next) - position(row)).normalize());
        let cell = local(p, d);
        let at = format!(
            "cone {}, sample {}",
            number(row, "cone"),
            number(row, "sample")
        );
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 0.01;
        // Narrow cones read whole levels. Cones above 12 degrees read none that contains the floor they leave: a
        // lookup reaches 1.5 cells to each side.
        let mut level = (2.0 * number(row, "radius") / cell).max(1.0).log2();
        if number(row, "radius") > 0.105 * p.distance(origin) {
            let height = p.y - surface.y;
            level = level.min(
                (height / (1.5 * local(p, DVec3::Y).max(above)))
                    .max(1.0)
                    .log2()
                    .floor(),
            );
        }
        assert!(
            (number(row, "level") - level.min(6.0)).abs() < 0.52,
            "{at}: level {}, not {level}",
            number(row, "level")
        );
        let coarse = cell * number(row, "level").exp2();
        assert!(
            near(number(row, "cell"), coarse),
            "{at}: a cell of {} m, not {coarse}",
            number(row, "cell")
        );
        // Steps are one and a half cells, and twice as long in empty space.
        let (step, twice) = (number(row, "step"), number(row, "opacity") == 0.0);
        assert!(
            near(step, 1.5 * coarse) || twice && near(step, 3.0 * coarse),
            "{at}: a step of {step} m in {coarse} m"
        );
        assert!(
            near(p.distance(position(next)), step),
            "{at}: the next sample is elsewhere"
        );
        if number(row, "opacity") < 1e-5 {
            empty += 1;
            cells.push(cell);
            continue;
        }
        // Opacity is that of a step, in cells.
        let before = number(row, "transmittance") + number(row, "alpha");
        let taken =
            (number(row, "opacity") * number(row, "step") / number(row, "cell")).min(before);
        assert!(
            (number(row, "alpha") - taken).abs() < 2e-3,
            "{at}: takes {}, not {taken}",
            number(row, "alpha")
        );
    }
    cells.sort_by(f64::total_cmp);
    println!(
        "{empty} samples in empty space, in cells of {:.3} to {:.3} m",
        cells[0],
        cells[empty - 1]
    );
    assert!(
        empty > 20 && cells[empty - 1] > 1.4 * cells[0],
        "{empty} samples, all in cells of one size"
    );
    assert_clean(&lab);
}

#[test]
fn curved_cells_that_end_before_they_begin_are_refused() {
    let lab = lab(root());
    for (warp, refused) in [("perspective", true), ("spherical", true), ("none", false)] {
        let settings = [
            ("warp", warp),
            ("warp_near", "5"),
            ("warp_far", "5"),
            ("voxel_dim", "16"),
        ];
        let experiment = experiment("cornell", (16, 16), &settings);
        let error = lab
            .prepare(&experiment, scene("cornell"), |_| Ok(Vec::new()))
            .err()
            .map(|e| e.to_string());
        let told = error
            .as_deref()
            .is_some_and(|e| e.contains("passes/parts/warp.ron:") && e.contains("above warp_near"));
        assert_eq!(told, refused, "{warp}: {error:?}");
        assert!(refused || error.is_none(), "{warp}: {error:?}");
    }
}
