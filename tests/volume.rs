//! Volumes of several blocks and volumes that move: cascades, curved blocks with a uniform one behind, boxes that follow
//! the camera, scrolling, the filter over time. Every number that a bound is put on is printed.

mod common;

use common::{assert_clean, experiment, floats, lab, mean, prepare, root, scene};
use conelab::experiment::{CameraChoice, Experiment, PlacedCamera};
use conelab::graph::param::Params;
use conelab::lab::{Lab, Session, params_of};
use conelab::measure::oracle;
use conelab::metrics::Kind;
use conelab::metrics::colour::display;
use glam::{DVec3, Vec3};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

const QUICK: (&str, &str) = ("shadow_dim", "512");
/// Light that voxels reflect to each other takes frames to settle.
const NO_BOUNCES: (&str, &str) = ("bounces", "one");
/// A word of the buffer voxelCounter (shaders/voxels/voxels.glsl).
const FRAGMENTS: usize = 2;
const VOXELS: [&str; 4] = ["voxelIndex", "voxelColor", "voxelNormal", "voxelBorders"];

/// One frame, or more, that drop nothing.
#[track_caller]
fn frames(lab: &Lab, experiment: &Experiment, wanted: &[&str], count: usize) -> Session {
    let mut session = prepare(lab, experiment, wanted);
    run(&mut session, count);
    assert_clean(lab);
    session
}

#[track_caller]
fn run(session: &mut Session, count: usize) {
    session.run(count).unwrap();
    session.finish().unwrap();
    assert_eq!(session.failed_checks().unwrap(), Vec::<String>::new());
}

/// With a graph whose volume can be moved under the picture.
fn moved(mut e: Experiment) -> Experiment {
    e.graph = match e.graph.as_str() {
        "rays.ron" | "cones.ron" => common::graph_with(&[("volume_offset", "")]),
        "temporal.ron" => common::graph_with(&[("volume_offset", ""), ("temporal_cut", "")]),
        other => other.into(),
    };
    e
}

/// In the middle of the Cornell box, towards its back wall.
fn inside(mut e: Experiment) -> Experiment {
    e = moved(e);
    e.camera = CameraChoice::Placed(PlacedCamera::new((2.7, 2.5, 1.0), (2.9, 2.4, 5.0), 70.0));
    e
}

/// Moves what the volume follows, under a picture that stands still.
fn offset(lab: &Lab, session: &mut Session, e: &Experiment, by: [f64; 3]) {
    let mut params: Params = params_of(&session.graph, e).unwrap();
    params
        .set(
            "volume_offset",
            &format!("({}, {}, {})", by[0], by[1], by[2]),
        )
        .unwrap();
    session.set_params(lab, &params).unwrap();
}

const KINDS: [(&str, &[(&str, &str)]); 6] = [
    ("uniform", &[]),
    ("two cascades", &[("cascades", "2")]),
    ("three cascades", &[("cascades", "3")]),
    (
        "perspective",
        &[
            ("warp", "perspective"),
            ("warp_near", "0.3"),
            ("warp_far", "6"),
        ],
    ),
    (
        "spherical",
        &[
            ("warp", "spherical"),
            ("warp_near", "0.3"),
            ("warp_far", "6"),
        ],
    ),
    (
        "perspective and two cascades",
        &[
            ("warp", "perspective"),
            ("warp_near", "0.3"),
            ("warp_far", "6"),
            ("cascades", "2"),
        ],
    ),
];

/// T1 and T2: as much light as there is, through every kind of volume.
#[test]
fn every_volume_keeps_the_energy() {
    let lab = lab(root());
    let mut wrong = Vec::new();
    for (kind, settings) in KINDS {
        for voxelizer in ["raster", "tessellated", "compute"] {
            let settings = [
                settings,
                &[
                    ("voxel_dim", "48"),
                    ("voxelizer", voxelizer),
                    NO_BOUNCES,
                    QUICK,
                ],
            ]
            .concat();
            let mut furnace = frames(
                &lab,
                &experiment("furnace", (48, 36), &settings),
                &["radiance"],
                1,
            );
            let energy = mean(&floats(&mut furnace, "radiance", 0)) / 1.5;
            let mut sky = frames(
                &lab,
                &experiment("white-sky", (48, 48), &settings),
                &["occlusion", "depth"],
                1,
            );
            let (open, depth) = (
                floats(&mut sky, "occlusion", 0),
                floats(&mut sky, "depth", 0),
            );
            let ball: Vec<[f32; 4]> = open
                .iter()
                .zip(&depth)
                .filter(|(_, d)| d[0] > 0.0)
                .map(|(o, _)| *o)
                .collect();
            let openness = mean(&ball);
            println!("{kind}, {voxelizer}: furnace {energy:.4}, white sky {openness:.4}");
            if (energy - 1.0).abs() > 0.02 || (openness - 1.0).abs() > 0.02 {
                wrong.push(format!("{kind}, {voxelizer}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// Blocks of boxes against exact overlap. The tessellator fills all of them at once, thinned where it is too dense.
#[test]
fn every_block_is_filled() {
    let lab = lab(root());
    let scene = scene("cornell");
    let mut wrong = Vec::new();
    for (kind, settings) in &KINDS[1..] {
        for (voxelizer, least) in [("raster", 0.999), ("tessellated", 0.92), ("compute", 1.0)] {
            let curved = usize::from(settings[0].0 == "warp");
            let cascades = settings
                .iter()
                .find(|s| s.0 == "cascades")
                .map_or(1, |s| s.1.parse::<usize>().unwrap());
            for block in curved..curved + cascades {
                let number = block.to_string();
                let set = [
                    *settings,
                    &[
                        ("voxel_dim", "48"),
                        ("voxelizer", voxelizer),
                        ("voxel_view_cascade", &number),
                        QUICK,
                    ],
                ]
                .concat();
                let mut session = frames(
                    &lab,
                    &inside(experiment("cornell", (16, 16), &set)),
                    &VOXELS,
                    1,
                );
                let (grid, voxels) = oracle::read(&mut session).unwrap();
                let cells = oracle::exact(
                    &oracle::triangles_of(&scene, 0.0),
                    &oracle::Surfaces::new(&scene),
                    &grid,
                );
                let score = oracle::compare(&grid, &cells, &voxels).score;
                let (Some(recall), Some(precision)) = (score.recall, score.precision) else {
                    println!("{kind}, block {block}: nothing of the scene lies in it");
                    continue;
                };
                println!(
                    "{kind}, {voxelizer}, block {block}: {} voxels, recall {recall:.4}, precision {precision:.4}",
                    voxels.len()
                );
                if recall < least || precision < 0.995 {
                    wrong.push(format!("{kind}, {voxelizer}, block {block}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// Where a curved block has a point, as a test writes it down: the thesis's frustum with depth in equal steps (Section
/// 4.6.2), and spheres with distance in equal factors.
fn curved(warp: &str, eye: DVec3, toward: DVec3, fov_y: f64, aspect: f64, p: DVec3) -> DVec3 {
    let (near, far) = (0.3, 6.0);
    let d = p - eye;
    if warp == "spherical" {
        let r = d.length();
        return DVec3::new(
            d.z.atan2(d.x) / (2.0 * PI) + 0.5,
            (d.y / r).acos() / PI,
            (r / near).ln() / (far / near).ln(),
        );
    }
    let right = toward.cross(DVec3::Y).normalize();
    let down = toward.cross(right);
    let (w, half) = (d.dot(toward), (0.5 * fov_y).tan());
    let (x, y) = (d.dot(right) / (w * half * aspect), d.dot(down) / (w * half));
    DVec3::new(
        0.5 * x + 0.5,
        0.5 * y + 0.5,
        if w > 0.0 {
            (w - near) / (far - near)
        } else {
            -1.0
        },
    )
}

/// Curved cells against points spread densely over all triangles: every cell that some of them fall in is asked for.
#[test]
fn curved_blocks_are_filled() {
    let lab = lab(root());
    let scene = scene("cornell");
    let (dim, mut wrong) = (48u32, Vec::new());
    for warp in ["perspective", "spherical"] {
        for voxelizer in ["raster", "tessellated", "compute"] {
            let set = [
                ("voxel_dim", "48"),
                ("warp", warp),
                ("warp_near", "0.3"),
                ("warp_far", "6"),
                ("voxelizer", voxelizer),
                ("volume_snap", "off"),
                QUICK,
            ];
            let mut e = inside(experiment("cornell", (64, 48), &set));
            let (eye, target) = (DVec3::new(2.7, 2.5, 1.0), DVec3::new(2.9, 2.4, 5.0));
            e.camera =
                CameraChoice::Placed(PlacedCamera::new((2.7, 2.5, 1.0), (2.9, 2.4, 5.0), 70.0));
            let mut session = frames(&lab, &e, &["voxelIndex"], 1);
            let texels = session.texels("voxelIndex", 0, 0).unwrap();
            let set: Vec<bool> = texels
                .bytes
                .chunks_exact(4)
                .take((dim * dim * dim) as usize)
                .map(|t| *t != [0; 4])
                .collect();
            // Points a fifth of the smallest cell apart would be very many: 3,000,000 in all, by an additive recurrence.
            let triangles = oracle::triangles_of(&scene, 0.0);
            let area = |t: &oracle::Triangle| {
                0.5 * (t.corners[1] - t.corners[0])
                    .cross(t.corners[2] - t.corners[0])
                    .length()
            };
            let whole: f64 = triangles.iter().map(area).sum();
            let mut hits: BTreeMap<usize, u32> = BTreeMap::new();
            for t in &triangles {
                for i in 0..(3e6 * area(t) / whole) as u32 {
                    let (mut a, mut b) = (
                        (f64::from(i) * 0.754_877_666).fract(),
                        (f64::from(i) * 0.569_840_291).fract(),
                    );
                    if a + b > 1.0 {
                        (a, b) = (1.0 - a, 1.0 - b);
                    }
                    let p = t.corners[0]
                        + a * (t.corners[1] - t.corners[0])
                        + b * (t.corners[2] - t.corners[0]);
                    let u = curved(
                        warp,
                        eye,
                        (target - eye).normalize(),
                        70f64.to_radians(),
                        64.0 / 48.0,
                        p,
                    ) * f64::from(dim);
                    if u.cmpge(DVec3::ZERO).all() && u.cmplt(DVec3::splat(f64::from(dim))).all() {
                        let cell = u.as_uvec3();
                        *hits
                            .entry((cell.x + dim * (cell.y + dim * cell.z)) as usize)
                            .or_default() += 1;
                    }
                }
            }
            // A cell that a triangle only grazes holds few points, and a voxelizer by points may miss it too.
            let found = hits.keys().filter(|c| set[**c]).count() as f64 / hits.len() as f64;
            let all: u32 = hits.values().sum();
            let area =
                hits.iter().filter(|h| set[*h.0]).map(|h| h.1).sum::<u32>() as f64 / f64::from(all);
            let voxels = set.iter().filter(|s| **s).count();
            let right = set
                .iter()
                .enumerate()
                .filter(|(i, s)| **s && hits.contains_key(i))
                .count() as f64
                / voxels as f64;
            println!(
                "{warp}, {voxelizer}: {voxels} voxels, recall {found:.4}, of the surface {area:.4}, hit by a sample {right:.4}"
            );
            if area < 0.98 || right < 0.97 {
                wrong.push(format!("{warp}, {voxelizer}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// The voxels of the last frame by cell, and what colour they have.
fn voxels(session: &mut Session, blocks: usize) -> BTreeMap<usize, [f32; 4]> {
    let texels = session.texels("voxelIndex", 0, 0).unwrap();
    assert_eq!(
        texels.extent[2] as usize,
        blocks * texels.extent[0] as usize
    );
    let set: BTreeSet<usize> = texels
        .bytes
        .chunks_exact(4)
        .enumerate()
        .filter(|(_, t)| **t != [0; 4])
        .map(|(i, _)| i)
        .collect();
    let colour = floats(session, "voxelColor", 0);
    set.into_iter().map(|i| (i, colour[i])).collect()
}

/// A volume that scrolls ends where one does that is voxelized anew: after steps along every axis, farther than itself,
/// and where something in the scene moved.
#[test]
fn scrolling_ends_where_voxelizing_anew_does() {
    let lab = lab(root());
    let steps = [
        [0.0; 3],
        [-0.9, 0.0, 0.0],
        [-0.9, -0.6, -0.8],
        [0.1, 0.2, -1.5],
        [40.0, 0.0, 0.0],
        [0.0, 0.0, 0.0],
        [0.0, 0.3, 0.0],
    ];
    for (voxelizer, cascades) in [
        ("raster", "1"),
        ("tessellated", "1"),
        ("compute", "1"),
        ("raster", "2"),
        ("tessellated", "2"),
        ("compute", "2"),
    ] {
        let set = [
            ("voxel_dim", "32"),
            ("volume", "camera"),
            ("volume_size", "(4, 4, 4)"),
            ("volume_snap", "voxel"),
            ("voxelizer", voxelizer),
            ("cascades", cascades),
            QUICK,
        ];
        let e = experiment(
            "moving-box",
            (16, 12),
            &[&set[..], &[("volume_scroll", "false")]].concat(),
        );
        let scrolling = experiment(
            "moving-box",
            (16, 12),
            &[&set[..], &[("volume_scroll", "true")]].concat(),
        );
        let mut kept = prepare(
            &lab,
            &scrolling,
            &["voxelIndex", "voxelColor", "voxelCounter"],
        );
        for (i, step) in steps.iter().enumerate() {
            // The box of the scene moves in step 5 and rests in step 6.
            let time = if i < 5 { 0.0 } else { 0.5 };
            kept.set_time(time);
            offset(&lab, &mut kept, &scrolling, *step);
            run(&mut kept, 1);
            let mut anew = prepare(&lab, &e, &["voxelIndex", "voxelColor"]);
            anew.set_time(time);
            offset(&lab, &mut anew, &e, *step);
            run(&mut anew, 1);
            let blocks = cascades.parse().unwrap();
            let (a, b) = (voxels(&mut kept, blocks), voxels(&mut anew, blocks));
            let same = a
                .iter()
                .filter(|(cell, colour)| {
                    b.get(cell)
                        .is_some_and(|c| (0..4).all(|k| (c[k] - colour[k]).abs() < 0.02))
                })
                .count();
            let mut word = |buffer: &str, i: usize| {
                let bytes = kept.buffer(buffer).unwrap();
                u32::from_ne_bytes([0, 1, 2, 3].map(|b| bytes[4 * i + b]))
            };
            let (slots_kept, fragments) =
                (word("scrolledCounter", 0), word("voxelCounter", FRAGMENTS));
            println!(
                "{voxelizer}, {cascades} blocks, step {i}: {} voxels, {} anew, {same} alike; {} kept, {} fragments",
                a.len(),
                b.len(),
                slots_kept,
                fragments
            );
            // Where a triangle's edge runs along a cell's border rounding decides, and it is another after a step. The
            // tessellator's points in a coarse block depend on where the finer one lies.
            let least = if (voxelizer, cascades) == ("tessellated", "2") {
                0.99
            } else {
                0.998
            };
            assert!(
                same as f64 >= least * a.len().max(b.len()) as f64,
                "step {i}"
            );
            let kept_share = f64::from(slots_kept) / a.len().max(1) as f64;
            match i {
                0 | 4 | 5 => assert_eq!(
                    slots_kept, 0,
                    "step {i}: nothing of the last frame is right here"
                ),
                1..=3 => assert!(kept_share > 0.3 && fragments > 0, "step {i}: {kept_share}"),
                _ => assert!(kept_share > 0.5, "step {i}: {kept_share}"),
            }
        }
        run(&mut kept, 1);
        let counter = kept.buffer("voxelCounter").unwrap();
        assert_eq!(
            counter[4 * FRAGMENTS..][..4],
            [0; 4],
            "nothing moved: no fragments"
        );
    }
    assert_clean(&lab);
}

/// What changed besides the volume's place is seen too: settings of the list and of the warp, steps far below a cell, a
/// warped box that moves, another scene.
#[test]
fn scrolling_sees_every_change() {
    let lab = lab(root());
    let base = [
        ("voxel_dim", "32"),
        ("volume", "camera"),
        ("volume_size", "(4, 4, 4)"),
        ("volume_snap", "off"),
        QUICK,
    ];
    type Settings<'a> = [(&'a str, &'a str)];
    // The first settings, then the second, over the base; frames of the second.
    let cases: [(&str, &Settings, &Settings, usize); 6] = [
        ("capacity", &[], &[("voxel_capacity", "1400000")], 1),
        ("reflection", &[], &[("shading_model", "cook_torrance")], 1),
        (
            "slope",
            &[("warp", "spline")],
            &[("warp", "spline"), ("warp_alpha", "0.6")],
            1,
        ),
        (
            "warped box",
            &[("warp", "spline")],
            &[("warp", "spline"), ("volume_offset", "(-0.5, 0, -0.5)")],
            1,
        ),
        ("far", &[], &[("volume_offset", "(-0.5, 0, -0.5)")], 1),
        (
            "steps of 0.3 % of a cell",
            &[],
            &[("volume_offset", "(-0.12, 0, 0)")],
            320,
        ),
    ];
    for (name, before, after, frames) in cases {
        let with = |settings: &Settings, scroll| {
            experiment(
                "moving-box",
                (16, 12),
                &[&base[..], settings, &[("volume_scroll", scroll)]].concat(),
            )
        };
        let mut kept = prepare(&lab, &with(before, "true"), &["voxelIndex", "voxelColor"]);
        run(&mut kept, 2);
        let wanted = with(after, "true");
        let mut params = params_of(&kept.graph, &wanted).unwrap();
        for i in 1..=frames {
            if frames > 1 {
                let x = -0.12 * i as f64 / frames as f64;
                params
                    .set("volume_offset", &format!("({x}, 0, 0)"))
                    .unwrap();
            }
            if !kept.set_params(&lab, &params).unwrap() {
                let loaded = lab
                    .home
                    .load_for(&wanted, &kept.scene, &lab.gpu.info)
                    .unwrap();
                let names = ["voxelIndex", "voxelColor"].map(String::from).to_vec();
                let mut next = lab
                    .build(
                        &wanted,
                        &loaded,
                        kept.scene.clone(),
                        names,
                        Some(&kept.reusable_parts()),
                    )
                    .unwrap();
                next.swap_in(&mut kept).unwrap();
                kept = next;
            }
            run(&mut kept, 1);
        }
        let mut anew = prepare(&lab, &with(after, "false"), &["voxelIndex", "voxelColor"]);
        run(&mut anew, 1);
        let (a, b) = (voxels(&mut kept, 1), voxels(&mut anew, 1));
        let near = |a: &[f32; 4], b: &[f32; 4]| (0..4).all(|k| (a[k] - b[k]).abs() < 0.01);
        let same = a
            .iter()
            .filter(|(cell, colour)| b.get(cell).is_some_and(|c| near(c, colour)))
            .count();
        println!("{name}: {} voxels, {} anew, {same} alike", a.len(), b.len());
        assert!(same as f64 >= 0.99 * a.len().max(b.len()) as f64, "{name}");
    }
    assert_clean(&lab);
}

/// T6. The volume follows a camera that moves by a tenth of a voxel a frame, under a picture that stands still: what
/// changes is the volume's doing. Largest change of the shown picture, of 255.
#[test]
fn a_snapped_volume_stands_still() {
    let lab = lab(root());
    let jump = |settings: &[(&str, &str)], from: f64| {
        // Frames until what voxels reflect to each other has settled.
        let settle = if settings.contains(&NO_BOUNCES) {
            0
        } else {
            320
        };
        let set = [
            settings,
            &[
                ("voxel_dim", "48"),
                ("gather_frames", "1"),
                // A mean goes on while the camera moves.
                ("accumulation_rounds", "1"),
                ("cone_count", "2"),
                ("emitter_rays", "0"),
                QUICK,
            ],
        ]
        .concat();
        let e = inside(experiment("cornell", (48, 36), &set));
        let mut session = prepare(&lab, &e, &["radiance"]);
        offset(&lab, &mut session, &e, [from, 0.0, 0.0]);
        run(&mut session, settle);
        let (mut last, mut largest, mut sum) = (None::<Vec<[f32; 4]>>, 0.0f64, 0.0);
        for i in 0..16 {
            offset(
                &lab,
                &mut session,
                &e,
                [
                    from + 0.0167 * f64::from(i),
                    0.007 * f64::from(i),
                    0.011 * f64::from(i),
                ],
            );
            run(&mut session, 1);
            let now = floats(&mut session, "radiance", 0);
            if let Some(last) = last {
                let changes = now.iter().flatten().zip(last.iter().flatten());
                for (a, b) in changes {
                    let change =
                        255.0 * (display(Kind::Radiance, *a) - display(Kind::Radiance, *b)).abs();
                    largest = largest.max(change);
                    sum += change / (15.0 * 4.0 * now.len() as f64);
                }
            }
            last = Some(now);
        }
        (largest, sum)
    };
    // Holds all of the scene before and after its step.
    let camera = [("volume", "camera"), ("volume_size", "(12, 12, 12)")];
    let of = |snap: &'static str, more: &[(&'static str, &'static str)]| {
        [&camera[..], &[("volume_snap", snap)], more].concat()
    };
    let (mut found, mut crossed) = (BTreeMap::new(), BTreeMap::new());
    for (name, settings) in [
        ("scene", vec![NO_BOUNCES]),
        ("scene, all bounces", vec![]),
        ("camera, by levels", of("level", &[NO_BOUNCES])),
        ("camera, by levels, all bounces", of("level", &[])),
        ("camera, by voxels", of("voxel", &[NO_BOUNCES])),
        ("camera, not snapped", of("off", &[NO_BOUNCES])),
        (
            "two cascades, by levels",
            vec![("cascades", "2"), NO_BOUNCES],
        ),
        (
            "two cascades, by voxels",
            vec![("cascades", "2"), ("volume_snap", "voxel"), NO_BOUNCES],
        ),
        (
            "spherical, snapped",
            vec![
                ("warp", "spherical"),
                ("warp_near", "0.3"),
                ("warp_far", "6"),
                NO_BOUNCES,
            ],
        ),
        (
            "spherical, not snapped",
            vec![
                ("warp", "spherical"),
                ("warp_near", "0.3"),
                ("warp_far", "6"),
                ("volume_snap", "off"),
                NO_BOUNCES,
            ],
        ),
        (
            "perspective",
            vec![
                ("warp", "perspective"),
                ("warp_near", "0.3"),
                ("warp_far", "6"),
                NO_BOUNCES,
            ],
        ),
    ] {
        // The box moves by 2 m, its coarsest cell, where the camera has gone 0.3 m.
        let (peak, mean) = jump(&settings, 0.0);
        let (crossing, mean_crossing) = jump(&settings, 0.2);
        println!(
            "{name}: peak jump {peak:.2} / 255, mean {mean:.4}; across a step {crossing:.2}, {mean_crossing:.4}"
        );
        found.insert(name, peak);
        crossed.insert(name, crossing);
    }
    assert_clean(&lab);
    for bounces in ["", ", all bounces"] {
        assert_eq!(found[format!("scene{bounces}").as_str()], 0.0);
        let name = format!("camera, by levels{bounces}");
        assert!(
            found[name.as_str()] < 0.01 && crossed[name.as_str()] < 2.0,
            "a snapped volume jumps"
        );
    }
    assert!(found["two cascades, by levels"] < 10.0, "cascades pop");
    assert!(
        found["camera, not snapped"] > 4.0,
        "without snapping nothing is worse"
    );
}

/// T8. The filter over time adds no light, however long it runs, at rest or on the move.
#[test]
fn the_temporal_filter_gains_nothing() {
    let lab = lab(root());
    let camera = [
        ("volume", "camera"),
        ("volume_size", "(8, 8, 8)"),
        ("volume_snap", "voxel"),
    ];
    let set = [&camera[..], &[("voxel_dim", "32"), NO_BOUNCES, QUICK]].concat();
    let e = inside(experiment("cornell", (24, 18), &set));
    let filtered = inside(experiment(
        "cornell",
        (24, 18),
        &[
            &set[..],
            &[("temporal_factor", "0.95"), ("temporal_cut", "100")],
        ]
        .concat(),
    ));
    let mut plain = frames(&lab, &e, &["voxelRadiance"], 1);
    let unfiltered = mean(&floats(&mut plain, "voxelRadiance", 0));
    let mut session = prepare(&lab, &filtered, &["voxelRadiance"]);
    run(&mut session, 200);
    let still = mean(&floats(&mut session, "voxelRadiance", 0)) / unfiltered;
    for i in 0..200 {
        let angle = f64::from(i) * 0.37;
        offset(
            &lab,
            &mut session,
            &filtered,
            [0.6 * angle.sin(), 0.0, 0.6 * angle.cos() - 0.6],
        );
        run(&mut session, 1);
    }
    offset(&lab, &mut session, &filtered, [0.0; 3]);
    run(&mut session, 1);
    let moved = mean(&floats(&mut session, "voxelRadiance", 0)) / unfiltered;
    println!(
        "radiance against no filter: after 200 frames {still:.4}, after 200 more on the move {moved:.4}"
    );
    assert!(
        (still - 1.0).abs() < 0.002 && moved < 1.002 && moved > 0.9,
        "the filter gains or loses light"
    );
    assert_clean(&lab);
}

/// A camera that jumps leaves nothing of the past behind; one that walks keeps it.
#[test]
fn a_cut_resets_the_temporal_filter() {
    let lab = lab(root());
    let set = [
        ("voxel_dim", "32"),
        ("volume", "camera"),
        ("volume_size", "(8, 8, 8)"),
        NO_BOUNCES,
        QUICK,
    ];
    let e = inside(experiment(
        "cornell",
        (24, 18),
        &[&set[..], &[("temporal_cut", "1.0")]].concat(),
    ));
    let plain = inside(experiment("cornell", (24, 18), &set));
    let mut dark = scene("cornell").lights.clone();
    dark.iter_mut().for_each(|l| l.color *= 0.1);
    // Light falls to a tenth in the frame in which the camera goes: what is brighter is the past.
    let after = |e: &Experiment, by: [f64; 3]| {
        let mut session = prepare(&lab, e, &["voxelRadiance"]);
        run(&mut session, 3);
        assert!(session.set_lights(&dark, Vec3::ZERO));
        offset(&lab, &mut session, e, by);
        run(&mut session, 1);
        mean(&floats(&mut session, "voxelRadiance", 0))
    };
    let (step, jump) = ([0.3, 0.0, 0.0], [0.0, 0.0, 1.5]);
    let (walk, cut) = (
        after(&e, step) / after(&plain, step),
        after(&e, jump) / after(&plain, jump),
    );
    println!("radiance against no filter: after a step {walk:.3}, after a cut {cut:.3}");
    assert!(walk > 1.5, "a step forgets"); // the lamp itself glows on
    assert!((cut - 1.0).abs() < 1e-3, "a cut remembers");
    assert_clean(&lab);
}

/// T9. No seam where one cascade ends: steps of the diffuse light between neighbouring pixels, against those of a uniform
/// volume as fine as the inner cascade, for pairs on both sides of its border and for all others.
#[test]
fn cascades_meet_without_a_seam() {
    let lab = lab(root());
    let size = (160u32, 120u32);
    let picture = |settings: &[(&str, &str)]| {
        let e = inside(experiment("cornell", size, &[settings, &[QUICK]].concat()));
        let mut session = frames(
            &lab,
            &e,
            &[
                "diffuseIndirect",
                "gbufferDistance",
                "surfaceNormal",
                "volume",
            ],
            1,
        );
        let light: Vec<f64> = floats(&mut session, "diffuseIndirect", 0)
            .iter()
            .map(|t| f64::from(t[0] + t[1] + t[2]))
            .collect();
        (light, session)
    };
    let (fine, _) = picture(&[("voxel_dim", "96")]);
    let (coarse, _) = picture(&[("voxel_dim", "48")]);
    let (cascades, mut session) = picture(&[("voxel_dim", "48"), ("cascades", "2")]);
    let words = session.buffer("volume").unwrap();
    let vector = |at: usize| {
        DVec3::from_array([0, 1, 2].map(|i| {
            f64::from(f32::from_ne_bytes(
                [0, 1, 2, 3].map(|b| words[4 * (at + i) + b]),
            ))
        }))
    };
    let (low, edge) = (vector(0), vector(4));
    let (distance, normal) = (
        floats(&mut session, "gbufferDistance", 0),
        floats(&mut session, "surfaceNormal", 0),
    );
    let (eye, target) = (DVec3::new(2.7, 2.5, 1.0), DVec3::new(2.9, 2.4, 5.0));
    let toward = (target - eye).normalize();
    let right = toward.cross(DVec3::Y).normalize();
    let down = toward.cross(right);
    let half = 35f64.to_radians().tan();
    let place = |i: usize| {
        let (x, y) = (
            (i as u32 % size.0) as f64 + 0.5,
            (i as u32 / size.0) as f64 + 0.5,
        );
        let (x, y) = (
            2.0 * x / f64::from(size.0) - 1.0,
            2.0 * y / f64::from(size.1) - 1.0,
        );
        let ray =
            toward + right * (x * half * f64::from(size.0) / f64::from(size.1)) + down * (y * half);
        eye + ray.normalize() * f64::from(distance[i][0])
    };
    let within = |p: DVec3| p.cmpgt(low).all() && p.cmplt(low + edge).all();
    let steps = |light: &[f64], across: bool| {
        let (mut sum, mut count) = (0.0, 0);
        for i in (0..light.len() - 1).filter(|i| *i as u32 % size.0 + 1 < size.0) {
            let one_surface = (0..3).all(|k| (normal[i][k] - normal[i + 1][k]).abs() < 0.01)
                && (distance[i][0] - distance[i + 1][0]).abs() < 0.05;
            let lit = [i, i + 1].iter().all(|j| light[*j] > 0.0 && fine[*j] > 0.0);
            if !one_surface
                || !lit
                || distance[i][0] <= 0.0
                || (within(place(i)) != within(place(i + 1))) != across
            {
                continue;
            }
            let ratio = |j: usize| (light[j] / fine[j]).ln();
            sum += (ratio(i) - ratio(i + 1)).abs();
            count += 1;
        }
        (sum / f64::from(count), count)
    };
    let ((seam, pairs), (rest, _)) = (steps(&cascades, true), steps(&cascades, false));
    let ((seam_coarse, _), (rest_coarse, _)) = (steps(&coarse, true), steps(&coarse, false));
    println!(
        "cascades: steps of {:.3} % across the border ({pairs} pairs), {:.3} % elsewhere",
        100.0 * seam,
        100.0 * rest
    );
    println!(
        "coarse volume: {:.3} % there, {:.3} % elsewhere",
        100.0 * seam_coarse,
        100.0 * rest_coarse
    );
    assert!(pairs > 50, "the border is not in the picture");
    // What rays meet next to their surface is one cascade's or the other's, without a blend.
    assert!(seam < 1.6 * rest && seam < 0.03, "a seam of {seam}");
    assert_clean(&lab);
}

/// The boxes of a scene with the default settings, finest first: corner and edge [m].
fn boxes(lab: &Lab, name: &str) -> Vec<(Vec3, f32)> {
    let e = experiment(name, (32, 18), &[("voxel_dim", "32"), NO_BOUNCES, QUICK]);
    let mut session = frames(lab, &e, &["volume"], 1);
    let bytes = session.buffer("volume").unwrap();
    let words: Vec<f32> = bytes
        .as_chunks::<4>()
        .0
        .iter()
        .map(|b| f32::from_ne_bytes(*b))
        .collect();
    // shaders/volume/volume.glsl: six maps, each begins with its corner, a word, its edges.
    words
        .chunks(words.len() / 6)
        .map(|m| (Vec3::new(m[0], m[1], m[2]), m[4]))
        .take_while(|m| m.1 > 0.0)
        .collect()
}

/// The volume places itself: a room on a ground of 220 m, or of 200 km, has cells of its own, the scene is inside the last box,
/// and a scene that is no larger than what is seen of it has one.
#[test]
fn the_volume_places_itself() {
    let lab = lab(root());
    for (name, room, many) in [
        ("cornell", 5.6, 1),
        ("huge-ground", 12.0, 3),
        ("plain", 20.0, 4),
    ] {
        let scene = scene(name);
        let (low, high) = scene.bounds();
        let found = boxes(&lab, name);
        println!("{name}: {found:?}");
        assert_eq!(found.len(), many, "{name}");
        assert!(
            found[0].1 < 2.0 * room,
            "{name}: cells of {} m",
            found[0].1 / 32.0
        );
        let origin = scene.origin();
        for (i, (corner, edge)) in found.iter().enumerate() {
            let is_last = i + 1 == many;
            let (a, b) = (*corner + origin, *corner + origin + *edge);
            assert!(
                !is_last || a.cmple(low).all() && b.cmpge(high).all(),
                "{name}: the scene is not inside"
            );
            let eye = scene.cameras["default"].eye;
            assert!(
                name == "cornell" || a.cmple(eye).all() && b.cmpge(eye).all(),
                "{name}: the camera is not in box {i}"
            );
        }
    }
    assert_clean(&lab);
}

/// A lamp that is smaller than a voxel is as bright as it is: the same light from coarse voxels and from fine ones.
#[test]
fn a_small_lamp_stays_small() {
    let lab = lab(root());
    let light = |dim: &str| {
        let e = experiment(
            "small-quad",
            (64, 48),
            &[("voxel_dim", dim), NO_BOUNCES, QUICK],
        );
        mean(&floats(
            &mut frames(&lab, &e, &["diffuseIndirect"], 1),
            "diffuseIndirect",
            0,
        ))
    };
    let (coarse, fine) = (light("16"), light("128"));
    println!("light of a small lamp: {coarse:.4} with voxels of 15 cm, {fine:.4} with 2 cm");
    assert!((coarse / fine - 1.0).abs() < 0.2, "{coarse} against {fine}");
    assert_clean(&lab);
}
