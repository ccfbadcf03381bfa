//! The thesis to the letter: Listing 4.1 (Freed 2018, Section 4.5.2), transcribed for the processor, against what the cone
//! probe says the thesis graph's shader did.

mod common;

use common::{assert_clean, experiment, floats, lab, prepare, root};
use conelab::experiment::Experiment;
use conelab::graph::table::{Cell, decode};
use conelab::lab::Session;
use glam::{DVec3, DVec4};

const DIM: usize = 64;
const LEVELS: u32 = 6;
/// Of the thesis: samples a diffuse cone, and its bias and height in voxels.
const STEPS: usize = 32;
const APERTURE: f64 = 45.0;

/// A sample as the probe tells it.
struct Row {
    cone: u32,
    distance: f64,
    position: DVec3,
    level: f64,
    opacity: f64,
    alpha: f64,
    radiance: DVec3,
}

fn rows(session: &mut Session) -> Vec<Row> {
    let table = session.table(0).unwrap();
    let buffer = session
        .graph
        .buffers
        .iter()
        .position(|b| b.0 == "coneSamples")
        .unwrap();
    let cells = decode(&table, &session.program.read_buffer(buffer).unwrap());
    let column = |name: &str| table.columns.iter().position(|c| c.name == name).unwrap();
    let number = |row: &[Cell], name: &str| match row[column(name)] {
        Cell::Uint(v) => f64::from(v),
        Cell::Float(v) => f64::from(v),
        _ => panic!("{name} is no number"),
    };
    let vector = |row: &[Cell], name: &str| match &row[column(name)] {
        Cell::Vector(v) => DVec3::new(v[0].into(), v[1].into(), v[2].into()),
        _ => panic!("{name} is no vector"),
    };
    let read = |row: &Vec<Cell>| Row {
        cone: number(row, "cone") as u32,
        distance: number(row, "distance"),
        position: vector(row, "position"),
        level: number(row, "level"),
        opacity: number(row, "opacity"),
        alpha: number(row, "alpha"),
        radiance: vector(row, "radiance"),
    };
    cells.iter().map(read).collect()
}

/// The radiance texture, level by level, as `textureLod` reads it: trilinear, clamped, blended between levels.
struct Texture(Vec<Vec<[f32; 4]>>);

impl Texture {
    fn texel(&self, level: usize, cell: [i64; 3]) -> DVec4 {
        let dim = (DIM >> level) as i64;
        let [x, y, z] = cell.map(|c| c.clamp(0, dim - 1) as usize);
        let t = self.0[level][(z * dim as usize + y) * dim as usize + x];
        DVec4::new(t[0].into(), t[1].into(), t[2].into(), t[3].into())
    }

    fn trilinear(&self, level: usize, u: DVec3) -> DVec4 {
        let at = u * (DIM >> level) as f64 - 0.5;
        let (low, f) = (at.floor(), at - at.floor());
        let mut sum = DVec4::ZERO;
        for i in 0..8 {
            let corner = DVec3::new((i & 1).into(), (i >> 1 & 1).into(), (i >> 2).into());
            let w = (corner * f + (1.0 - corner) * (1.0 - f))
                .to_array()
                .iter()
                .product::<f64>();
            let cell = (low + corner).to_array().map(|c| c as i64);
            sum += w * self.texel(level, cell);
        }
        sum
    }

    fn sample(&self, u: DVec3, lod: f64) -> DVec4 {
        let lod = lod.clamp(0.0, f64::from(LEVELS - 1));
        let level = lod.floor() as usize;
        let next = (level + 1).min(LEVELS as usize - 1);
        self.trilinear(level, u)
            .lerp(self.trilinear(next, u), lod - lod.floor())
    }
}

/// A step of Listing 4.1: height of the cone in voxels, level, what was sampled, what was left of the cone before.
struct Step {
    height: f64,
    lod: f64,
    sampled: DVec4,
    before: f64,
}

/// Listing 4.1, in texture space as there: lines 10 to 33.
fn trace_cone(
    texture: &Texture,
    start: DVec3,
    direction: DVec3,
    steps: usize,
    cone_angle: f64,
) -> Vec<Step> {
    let (mut alpha, mut cone_height) = (0.0, 1.0);
    let scale = 1.0 / DIM as f64;
    let mut list = Vec::new();
    for _ in 0..steps {
        if alpha >= 0.95 {
            break;
        }
        let cone_radius = cone_height * (cone_angle / 2.0).tan();
        let lod = (2.0 * cone_radius).max(1.0).log2();
        let position = start + cone_height * direction * scale;
        if position.min_element() < 0.0 || position.max_element() > 1.0 {
            break; // the listing reads the border's zeros from here on
        }
        let sampled = texture.sample(position, lod);
        let a = 1.0 - alpha;
        list.push(Step {
            height: cone_height,
            lod,
            sampled,
            before: a,
        });
        alpha += a * sampled.w;
        cone_height += cone_radius;
    }
    list
}

#[test]
fn the_thesis_graph_traces_listing_4_1() {
    let lab = lab(root());
    let mut compared = 0;
    for (at, wall) in [
        ([32u32, 44u32], "floor"),
        ([14, 24], "left wall"),
        ([32, 20], "back wall"),
    ] {
        let dim = DIM.to_string();
        let probe = format!("({}.5, {}.5)", at[0], at[1]);
        let mut e = experiment(
            "cornell",
            (64, 48),
            &[
                ("voxel_dim", &dim),
                ("shadow_dim", "512"),
                ("probe", &probe),
            ],
        );
        e.graph = "thesis.ron".into();
        let mut session = prepare(
            &lab,
            &e,
            &["coneSamples", "voxelRadiance", "surfaceNormal", "volume"],
        );
        session.frame(0.0).unwrap();
        session.finish().unwrap();
        assert_clean(&lab);
        let texture = Texture(
            (0..LEVELS)
                .map(|level| floats(&mut session, "voxelRadiance", level))
                .collect(),
        );
        let rows = rows(&mut session);
        let words = |session: &mut Session, name: &str| -> Vec<f64> {
            let bytes = session.buffer(name).unwrap();
            bytes
                .as_chunks::<4>()
                .0
                .iter()
                .map(|b| f32::from_ne_bytes(*b).into())
                .collect()
        };
        let vec = |w: &[f64]| DVec3::new(w[0], w[1], w[2]);
        let (samples, volume) = (
            words(&mut session, "coneSamples"),
            words(&mut session, "volume"),
        );
        let (surface, origin) = (vec(&samples[4..]), vec(&samples[8..]));
        let (minimum, size) = (vec(&volume[0..]), vec(&volume[4..]));
        let cell = size.x / DIM as f64;
        let pixel = floats(&mut session, "surfaceNormal", 0)[(at[1] * 64 + at[0]) as usize];
        let normal = DVec3::new(pixel[0].into(), pixel[1].into(), pixel[2].into()) * 2.0 - 1.0;
        // Line 12: a voxel along the shading normal, which has eight bits here.
        assert!(
            (origin - surface).abs_diff_eq(normal.normalize() * cell, 0.02 * cell),
            "{wall}: starts at {origin}"
        );

        // Five cones: one on the normal, four at 45 degrees to it and at right angles to each other.
        let cones: Vec<Vec<&Row>> = (1..6)
            .map(|n| rows.iter().filter(|r| r.cone == n).collect())
            .collect();
        assert!(
            rows.iter().all(|r| r.cone < 6),
            "{wall}: more than five diffuse cones and a specular one"
        );
        let directions: Vec<DVec3> = cones
            .iter()
            .map(|c| (c[0].position - origin).normalize())
            .collect();
        assert!(directions[0].dot(normal.normalize()) > 0.9999, "{wall}");
        for (i, d) in directions.iter().enumerate().skip(1) {
            assert!(
                (d.dot(directions[0]) - 45f64.to_radians().cos()).abs() < 1e-4,
                "{wall}: cone {i} is tilted by {d}"
            );
            let next = directions[if i == 4 { 1 } else { i + 1 }];
            assert!(
                (d.dot(next) - 0.5).abs() < 1e-4,
                "{wall}: cones {i} and the next are not a quarter turn apart"
            );
        }

        for (number, cone) in cones.iter().enumerate() {
            let start = (origin - minimum) / size;
            let steps = trace_cone(
                &texture,
                start,
                directions[number],
                STEPS,
                APERTURE.to_radians(),
            );
            let what = format!("{wall}, cone {}", number + 1);
            // Eight-bit filtering may end a cone that is nearly opaque a step sooner or later.
            assert!(
                steps.len().abs_diff(cone.len()) <= 1 && !cone.is_empty(),
                "{what}: {} of {}",
                cone.len(),
                steps.len()
            );
            for (i, (row, step)) in cone.iter().zip(&steps).enumerate() {
                let near = |name: &str, is: f64, wanted: f64, within: f64| {
                    assert!(
                        (is - wanted).abs() <= within,
                        "{what}, sample {i}: {name} {is}, the listing has {wanted}"
                    );
                };
                near(
                    "height",
                    row.distance / cell,
                    step.height,
                    1e-3 * step.height,
                );
                near(
                    "level",
                    row.level,
                    step.lod.min(f64::from(LEVELS - 1)),
                    1e-3,
                ); // the texture has no coarser one
                // Hardware blends eight-bit texels with weights of eight bits.
                near("opacity", row.opacity, step.sampled.w, 0.02);
                near("alpha", row.alpha, step.before * step.sampled.w, 0.04);
                near(
                    "radiance",
                    row.radiance.y,
                    step.before * step.sampled.y,
                    0.04,
                );
                compared += 1;
            }
        }
    }
    println!("{compared} samples as Listing 4.1 has them");
    assert!(compared > 60, "{compared} samples");
}

#[test]
fn the_exposure_of_injection_scales_what_lights_inject_and_leaves_emission() {
    let lab = lab(root());
    let diffuse = |scene: &str, exposure: &str| {
        let settings = [
            ("voxel_dim", "32"),
            ("radiance_format", "rgba16f"),
            ("injection_exposure", exposure),
        ];
        let experiment = Experiment {
            graph: "thesis.ron".into(),
            ..experiment(scene, (32, 24), &settings)
        };
        let mut session = prepare(&lab, &experiment, &["diffuseIndirect"]);
        session.frame(0.0).unwrap();
        session.finish().unwrap();
        floats(&mut session, "diffuseIndirect", 0)
    };
    // A power of two scales half floats exactly, except those below 6e-5.
    let (one, four) = (diffuse("blinds", "1.0"), diffuse("blinds", "4.0"));
    assert!(one.iter().any(|t| t[0] > 0.01), "no indirect light");
    for (i, (a, b)) in one.iter().zip(&four).enumerate() {
        for k in 0..3 {
            assert!(
                (4.0 * a[k] - b[k]).abs() <= 2e-3 * b[k].abs() + 1e-6,
                "pixel {i}: {a:?} and {b:?}"
            );
        }
    }
    let (one, four) = (diffuse("emitters", "1.0"), diffuse("emitters", "4.0"));
    let [a, b] = [&one, &four].map(|texels| common::mean(texels));
    assert!(
        a > 0.0 && (a / b - 1.0).abs() < 0.01,
        "emission changes with the exposure, {a} and {b}"
    );
    assert_clean(&lab);
}
