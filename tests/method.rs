//! The method against what is known without it: energy in a furnace, a sphere under a white sky, triangles that overlap
//! boxes, series that converge. Every number that a bound is put on is printed.

mod common;

use common::{assert_clean, experiment, floats, lab, mean, prepare, root, scene};
use conelab::experiment::{CameraChoice, Experiment, PlacedCamera};
use conelab::graph::Evaluated;
use conelab::graph::plan::plan;
use conelab::lab::{Lab, LabError, Loaded, Session, environment};
use conelab::vulkan::{DeviceInfo, Features};
use glam::Vec3;
use std::collections::BTreeSet;

/// What keeps software devices quick.
const QUICK: (&str, &str) = ("shadow_dim", "512");

/// Runs frames with validation and returns the session, whose `wanted` textures can be read.
#[track_caller]
fn frames(lab: &Lab, experiment: &Experiment, wanted: &[&str], count: usize) -> Session {
    let mut session = prepare(lab, experiment, wanted);
    session.run(count).unwrap();
    session.finish().unwrap();
    assert_eq!(session.failed_checks().unwrap(), Vec::<String>::new());
    assert_clean(lab);
    session
}

/// A Cornell box with a moving ball, a point light and a spot light, both with shadows.
fn workshop() -> String {
    root()
        .join("configs/scenes/workshop.ron")
        .to_string_lossy()
        .into_owned()
}

/// Cells that hold a voxel.
fn occupied(session: &mut Session) -> BTreeSet<[u32; 3]> {
    let texels = session.texels("voxelIndex", 0, 0).unwrap();
    let [w, h, _] = texels.extent;
    let set = texels
        .bytes
        .chunks_exact(4)
        .zip(0u32..)
        .filter(|(t, _)| **t != [0; 4]);
    set.map(|(_, i)| [i % w, i / w % h, i / w / h]).collect()
}

/// Neither black nor broken.
#[track_caller]
fn assert_picture(texels: &[[f32; 4]], what: &str) {
    assert!(
        texels.iter().flatten().all(|v| v.is_finite()),
        "{what}: not a number"
    );
    let mean = mean(texels);
    assert!(mean > 0.002, "{what}: the picture is black ({mean})");
}

#[test]
fn the_furnace_keeps_its_energy() {
    // Closed box, emission 1, albedo 0.5, light reflected once: radiance 1 + 0.5 everywhere.
    let lab = lab(root());
    let mut wrong = Vec::new();
    for (dim, voxelizer) in [
        ("32", "raster"),
        ("64", "raster"),
        ("128", "raster"),
        ("63", "raster"),
        ("63", "compute"),
        ("64", "tessellated"),
    ] {
        let settings = [
            ("voxel_dim", dim),
            ("voxelizer", voxelizer),
            ("bounces", "one"),
            QUICK,
        ];
        let mut session = frames(
            &lab,
            &experiment("furnace", (64, 48), &settings),
            &["radiance"],
            1,
        );
        let ratio = mean(&floats(&mut session, "radiance", 0)) / 1.5;
        println!("furnace, {voxelizer} at {dim}: energy ratio {ratio:.4}");
        if (ratio - 1.0).abs() > 0.03 {
            wrong.push(format!("{voxelizer} at {dim}: {ratio:.4}"));
        }
    }
    assert!(
        wrong.is_empty(),
        "energy ratios outside 1 +- 0.03: {wrong:?}"
    );
}

/// T1 and T8. Light that is reflected again and again: emission 1 and reflectance 0.5 make 1 / (1 - 0.5) = 2, never more, and
/// in a still scene it comes to rest.
#[test]
fn bounces_fill_the_furnace_and_rest() {
    let lab = lab(root());
    let mut wrong = Vec::new();
    for (dim, voxelizer) in [("32", "raster"), ("64", "raster"), ("32", "tessellated")] {
        let turns = [
            ("bounce_frames", "4"),
            ("gather_frames", "4"),
            ("pixel_rays", "4"),
            ("accumulation_rounds", "1"),
        ];
        let settings = [
            &turns[..],
            &[
                ("voxel_dim", dim),
                ("voxelizer", voxelizer),
                ("reflectance", "base"),
                QUICK,
            ],
        ];
        let e = experiment("furnace", (64, 48), &settings.concat());
        let mut session = prepare(&lab, &e, &["diffuseIndirect", "radiance"]);
        let (mut energy, mut last) = (Vec::new(), Vec::new());
        for _ in 0..160 {
            session.frame(0.0).unwrap();
            session.finish().unwrap();
            energy.push(1.0 + mean(&floats(&mut session, "diffuseIndirect", 0)));
            last.push(session.texels("radiance", 0, 0).unwrap().bytes);
        }
        println!("furnace, {voxelizer} at {dim}: {:.4?}", &energy[..10]);
        println!("    at last {:.4}", energy[159]);
        if (energy[159] / 2.0 - 1.0).abs() > 0.02 || energy.windows(2).any(|e| e[1] < e[0] * 0.999)
        {
            wrong.push(format!("{voxelizer} at {dim}: {:.4}", energy[159]));
        }
        let rests = last
            .iter()
            .rposition(|l| *l != last[159])
            .map_or(0, |i| i + 1);
        println!("    rests after {rests} frames");
        assert!(
            rests < 150,
            "{voxelizer} at {dim}: still changes after {rests} frames"
        );
    }
    assert_clean(&lab);
    assert!(
        wrong.is_empty(),
        "radiance outside 2 +- 0.04, or falling: {wrong:?}"
    );
}

/// In its first frames every voxel gathers, so that light has gone round as often as there were frames, everywhere alike.
#[test]
fn the_first_frames_have_no_voxels_that_wait() {
    let lab = lab(root());
    let settings = [
        ("voxel_dim", "32"),
        ("reflectance", "base"),
        ("gather_frames", "1"),
        ("pixel_rays", "2"),
        QUICK,
    ];
    let mut session = prepare(
        &lab,
        &experiment("furnace", (64, 48), &settings),
        &["diffuseIndirect"],
    );
    for frame in 0..8 {
        session.frame(0.0).unwrap();
        session.finish().unwrap();
        let light: Vec<f64> = floats(&mut session, "diffuseIndirect", 0)
            .iter()
            .map(|t| f64::from(t[0] + t[1] + t[2]) / 3.0)
            .collect();
        let expected = 1.0 - 0.5f64.powi(frame + 1); // 1/2 + 1/4 + ...
        let [least, most] = [f64::min, f64::max].map(|f| light.iter().copied().reduce(f).unwrap());
        println!("frame {frame}: {least:.4} to {most:.4} of {expected:.4}");
        assert!(
            least > 0.97 * expected && most < 1.03 * expected,
            "frame {frame}: {least} to {most}, not {expected}"
        );
    }
    assert_clean(&lab);
}

#[test]
fn a_picture_stores_one_image_and_each_is_the_same_alone() {
    let lab = lab(root());
    let all = [
        "radiance",
        "direct",
        "diffuseIndirect",
        "specularIndirect",
        "occlusion",
        "surfaceNormal",
    ];
    let e = experiment("cornell", (64, 48), &[("voxel_dim", "32"), QUICK]);
    let mut together = frames(&lab, &e, &all, 1);
    let made = |session: &Session| -> Vec<&str> {
        let memory: Vec<String> = session
            .program
            .memory(&session.graph)
            .into_iter()
            .map(|m| m.0)
            .collect();
        all.into_iter()
            .filter(|name| memory.iter().any(|m| m == name))
            .collect()
    };
    assert_eq!(made(&together), all);
    assert_eq!(made(&frames(&lab, &e, &["display"], 1)), ["radiance"]);
    for name in all {
        let mut alone = frames(&lab, &e, &[name], 1);
        assert_eq!(made(&alone), [name]);
        let bytes = |session: &mut Session| session.texels(name, 0, 0).unwrap().bytes;
        assert_eq!(bytes(&mut alone), bytes(&mut together), "{name}");
    }
}

#[test]
fn a_white_sphere_vanishes_under_a_white_sky() {
    let lab = lab(root());
    let mut wrong = Vec::new();
    for dim in ["32", "64"] {
        let settings = [("voxel_dim", dim), QUICK];
        let wanted = ["radiance", "occlusion", "surfaceNormal"];
        let mut session = frames(
            &lab,
            &experiment("white-sky", (64, 64), &settings),
            &wanted,
            1,
        );
        let covered: Vec<bool> = floats(&mut session, "surfaceNormal", 0)
            .iter()
            .map(|t| t[3] > 0.5)
            .collect();
        for name in ["radiance", "occlusion"] {
            let texels = floats(&mut session, name, 0);
            let sphere: Vec<[f32; 4]> = texels
                .iter()
                .zip(&covered)
                .filter(|(_, c)| **c)
                .map(|(t, _)| *t)
                .collect();
            assert!(
                sphere.len() > 500,
                "the sphere covers {} pixels",
                sphere.len()
            );
            let ratio = mean(&sphere);
            let least = sphere.iter().map(|t| t[0]).fold(f32::MAX, f32::min);
            println!("white sky at {dim}: mean {name} {ratio:.4}, least {least:.4}");
            if (ratio - 1.0).abs() > 0.01 {
                wrong.push(format!("{name} at {dim}: {ratio:.4}"));
            }
        }
    }
    assert!(wrong.is_empty(), "means outside 1 +- 0.01: {wrong:?}");
}

/// Share of `a` that is in `b`.
fn share(a: &BTreeSet<[u32; 3]>, b: &BTreeSet<[u32; 3]>) -> f64 {
    a.intersection(b).count() as f64 / a.len().max(1) as f64
}

#[test]
fn every_conservative_mode_runs_or_says_why_not() {
    let lab = lab(root());
    for mode in ["msaa", "off", "hardware", "dilate"] {
        let settings = [
            ("voxel_dim", "32"),
            ("voxelizer", "raster"),
            ("conservative", mode),
            QUICK,
        ];
        let experiment = experiment("cornell", (48, 32), &settings);
        if mode == "hardware" && !lab.gpu.info.features.conservative_rasterization {
            let result = lab.prepare(&experiment, scene("cornell"), |_| {
                Ok(vec!["radiance".into()])
            });
            let Err(LabError::Input(errors)) = result else {
                panic!("no error without the extension")
            };
            let text = errors
                .iter()
                .map(ToString::to_string)
                .collect::<Vec<_>>()
                .join("\n");
            assert!(text.contains("VK_EXT_conservative_rasterization"), "{text}");
            assert!(text.contains("conservative=msaa|off|dilate"), "{text}");
            println!(
                "skipped: {} has no VK_EXT_conservative_rasterization, which the error says",
                lab.gpu.info.name
            );
            continue;
        }
        let mut session = frames(&lab, &experiment, &["voxelIndex", "radiance"], 2);
        assert!(occupied(&mut session).len() > 2000, "{mode}");
        assert_picture(&floats(&mut session, "radiance", 0), mode);
    }
}

#[test]
fn every_merge_rule_keeps_the_colours() {
    let lab = lab(root());
    for merge in ["average", "running_average", "maximum"] {
        for voxelizer in ["raster", "tessellated"] {
            let what = format!("{merge}, {voxelizer}");
            let settings = [
                ("voxel_dim", "32"),
                ("merge", merge),
                ("voxelizer", voxelizer),
                QUICK,
            ];
            let experiment = experiment("cornell", (48, 32), &settings);
            let mut session = frames(
                &lab,
                &experiment,
                &["voxelIndex", "voxelColor", "radiance"],
                2,
            );
            let cells = occupied(&mut session);
            let colours = floats(&mut session, "voxelColor", 0);
            let in_cells: Vec<[f32; 4]> = cells
                .iter()
                .map(|[x, y, z]| colours[((z * 32 + y) * 32 + x) as usize])
                .collect();
            // The box is white, red, green: means lie between its darkest and lightest albedo.
            let mean = mean(&in_cells);
            println!("{what}: {} voxels of mean albedo {mean:.3}", cells.len());
            assert!((0.4..0.75).contains(&mean), "{what}: mean albedo {mean:.3}");
            assert!(
                in_cells.iter().filter(|c| c[0] > 2.0 * c[1]).count() > 100,
                "{what}: no red wall"
            );
            assert!(
                in_cells.iter().filter(|c| c[1] > 2.0 * c[0]).count() > 100,
                "{what}: no green wall"
            );
            assert_picture(&floats(&mut session, "radiance", 0), &what);
        }
    }
}

#[test]
fn every_warp_runs_with_every_voxelizer() {
    let lab = lab(root());
    for warp in ["none", "spline", "logistic", "perspective", "spherical"] {
        for voxelizer in ["raster", "tessellated", "compute"] {
            let what = format!("{warp}, {voxelizer}");
            let mut settings = vec![
                ("voxel_dim", "32"),
                ("warp", warp),
                ("voxelizer", voxelizer),
                QUICK,
            ];
            if warp == "perspective" || warp == "spherical" {
                // From before the box to its back wall.
                settings.extend([("warp_near", "6.0"), ("warp_far", "16.0")]);
            }
            let experiment = experiment("cornell", (48, 32), &settings);
            let mut session = frames(
                &lab,
                &experiment,
                &["voxelIndex", "radiance", "diffuseIndirect"],
                2,
            );
            let voxels = occupied(&mut session).len();
            let indirect = floats(&mut session, "diffuseIndirect", 0);
            println!(
                "{what}: {voxels} voxels, mean diffuse indirect {:.4}",
                mean(&indirect)
            );
            assert!(voxels > 500, "{what}: {voxels} voxels");
            assert_picture(&floats(&mut session, "radiance", 0), &what);
            assert_picture(&indirect, &what);
        }
    }
}

#[test]
fn the_temporal_filter_forgets_at_its_rate() {
    // A ball moves from frame 1 to frame 2 and rests: what is left of the difference shrinks by the factor each frame.
    let lab = lab(root());
    let at = |time: f64, settings: &[(&str, &str)]| {
        let settings = [&[("voxel_dim", "32"), ("bounces", "one"), QUICK], settings].concat();
        let mut experiment = experiment(&workshop(), (48, 32), &settings);
        experiment.time = time;
        prepare(&lab, &experiment, &["voxelRadiance", "radiance"])
    };
    let mut still = at(1.0, &[]);
    still.frame(0.0).unwrap();
    let still = floats(&mut still, "voxelRadiance", 0);
    let mut filtered = at(0.0, &[("temporal_factor", "0.5")]);
    let mut differences = Vec::new();
    for frame in 0..6 {
        filtered.frame(if frame == 0 { 1.0 } else { 0.0 }).unwrap();
        let now = floats(&mut filtered, "voxelRadiance", 0);
        let sum: f64 = now
            .iter()
            .zip(&still)
            .map(|(a, b)| f64::from((a[0] - b[0]).abs() + (a[3] - b[3]).abs()))
            .sum();
        differences.push(sum);
    }
    println!("differences from the unfiltered radiance: {differences:.4?}");
    assert!(
        differences[0] > 10.0,
        "the ball does not move: {differences:?}"
    );
    for pair in differences.windows(2) {
        let rate = pair[1] / pair[0];
        assert!(
            (rate - 0.5).abs() < 0.02,
            "shrinks by {rate:.3}: {differences:?}"
        );
    }
    assert_picture(&floats(&mut filtered, "radiance", 0), "temporal");
    assert_clean(&lab);
}

#[test]
fn the_volume_that_follows_the_camera_moves_by_whole_voxels() {
    let lab = lab(root());
    let mut sets = Vec::new();
    // The camera moves by less than a voxel (0.25 m), then by one.
    for x in [2.76, 2.80, 3.05] {
        let settings = [
            ("voxel_dim", "32"),
            ("volume", "camera"),
            ("volume_size", "(8, 8, 8)"),
            ("volume_snap", "voxel"),
            QUICK,
        ];
        let mut experiment = experiment("cornell", (48, 32), &settings);
        experiment.camera =
            CameraChoice::Placed(PlacedCamera::new((x, 2.73, 1.0), (2.78, 2.73, 5.0), 60.0));
        let mut session = frames(&lab, &experiment, &["voxelIndex", "radiance"], 2);
        assert_picture(&floats(&mut session, "radiance", 0), "camera volume");
        sets.push(occupied(&mut session));
    }
    assert!(sets[0].len() > 1000, "{} voxels", sets[0].len());
    assert!(
        sets[0] == sets[1],
        "a move of less than a voxel changes voxels"
    );
    let moved: BTreeSet<[u32; 3]> = sets[0]
        .iter()
        .filter(|c| c[0] > 0)
        .map(|[x, y, z]| [x - 1, *y, *z])
        .collect();
    let same = share(&moved, &sets[2]);
    println!("voxels that a move by one voxel shifts by one cell: {same:.4}");
    assert!(same > 0.999, "{same}");
}

#[test]
fn a_list_that_is_full_is_told() {
    let lab = lab(root());
    let settings = [("voxel_dim", "128"), ("voxel_capacity", "10000"), QUICK];
    let experiment = experiment("cornell", (32, 32), &settings);
    let mut session = prepare(&lab, &experiment, &["radiance"]);
    session.frame(0.0).unwrap();
    session.finish().unwrap();
    let failed = session.failed_checks().unwrap();
    assert_eq!(failed.len(), 1, "{failed:?}");
    assert!(
        failed[0].starts_with("voxels were dropped: ")
            && failed[0].contains("raise voxel_capacity"),
        "{failed:?}"
    );
    assert_clean(&lab);
}

#[test]
fn every_view_shows_something() {
    let lab = lab(root());
    let views = [
        "shaded",
        "direct",
        "diffuse",
        "specular",
        "occlusion",
        "normal",
        "depth",
    ];
    let mut all: Vec<Vec<(&str, &str)>> = views.iter().map(|v| vec![("view", *v)]).collect();
    all.extend(
        ["radiance", "color", "normal", "alpha"]
            .map(|v| vec![("view", "voxels"), ("voxel_view", v)]),
    );
    for mip in ["2", "4", "9"] {
        all.extend(["radiance", "color", "normal", "alpha"].map(|v| {
            vec![
                ("view", "voxels"),
                ("voxel_view", v),
                ("voxel_view_mip", mip),
            ]
        }));
    }
    all.push(vec![("view", "voxels"), ("voxelizer", "tessellated")]);
    all.push(vec![("density", "surfaces"), ("warp", "spline")]);
    all.push(vec![
        ("density", "voxels"),
        ("view", "voxels"),
        ("warp", "spline"),
    ]);
    for settings in all {
        let what = format!("{settings:?}");
        let settings = [&[("voxel_dim", "32"), QUICK], &settings[..]].concat();
        let mut session = frames(
            &lab,
            &experiment(&workshop(), (64, 48), &settings),
            &["display"],
            1,
        );
        assert_picture(&floats(&mut session, "display", 0), &what);
    }
}

/// A camera nearer to a wall than a voxel stands in one of the cubes, and looks out of it.
#[test]
fn cubes_are_seen_from_within_one() {
    let lab = lab(root());
    let settings = [("voxel_dim", "16"), ("view", "voxels"), QUICK];
    let mut experiment = experiment("cornell", (64, 48), &settings);
    let (low, high) = scene("cornell").bounds();
    let middle = 0.5 * (low + high);
    let eye = Vec3::new(low.x + 0.002 * (high.x - low.x), middle.y, middle.z);
    experiment.camera = CameraChoice::Placed(PlacedCamera::new(eye.into(), middle.into(), 60.0));
    let texels = floats(
        &mut frames(&lab, &experiment, &["voxelView"], 1),
        "voxelView",
        0,
    );
    let colours: BTreeSet<[u32; 3]> = texels
        .iter()
        .map(|t| [t[0], t[1], t[2]].map(f32::to_bits))
        .collect();
    println!("{} colours", colours.len());
    // One cube has as many as five, by its faces.
    assert!(colours.len() > 8, "nothing but {colours:?}");
}

#[test]
fn cubes_stand_where_their_level_has_opacity() {
    let lab = lab(root());
    for (dim, mip, mips) in [
        (32, 0, "isotropic"),
        (32, 2, "isotropic"),
        (48, 5, "isotropic"),
        (32, 3, "anisotropic"),
    ] {
        let what = format!("level {mip} of {dim}, {mips}");
        let (size, level) = (dim.to_string(), mip.to_string());
        let settings = [
            ("voxel_dim", size.as_str()),
            ("voxel_view_mip", &level),
            ("mips", mips),
        ];
        let view = [("view", "voxels"), ("voxel_view", "color"), QUICK];
        let experiment = experiment("cornell", (64, 48), &[&settings[..], &view[..]].concat());
        let wanted = [
            "display",
            "voxelCubes",
            "voxelRadiance",
            "voxelAttribute",
            "voxelColor",
        ];
        let mut session = frames(&lab, &experiment, &wanted, 1);
        let texels = floats(&mut session, "voxelRadiance", mip);
        let (cells, faces) = (dim >> mip, if mips == "anisotropic" { 6 } else { 1 });
        // A row of the texture: the cells as rays along +x find them, then along -x and so on.
        let width = texels.len() / (cells * cells);
        let face_of =
            |i: usize, face: usize| texels[i / cells * width + face * cells + i % cells][3];
        let holds = |i: usize| (0..faces).any(|face| face_of(i, face) > 0.0);
        let expected: BTreeSet<u32> = (0u32..)
            .zip(0..cells * cells * cells)
            .filter(|(_, i)| holds(*i))
            .map(|(i, _)| i)
            .collect();
        let buffer = session
            .graph
            .buffers
            .iter()
            .position(|b| b.0 == "voxelCubes")
            .unwrap();
        let bytes = session.program.read_buffer(buffer).unwrap();
        let words: Vec<u32> = bytes
            .chunks_exact(4)
            .map(|b| u32::from_ne_bytes([b[0], b[1], b[2], b[3]]))
            .collect();
        assert_eq!(
            words[..5],
            [36, expected.len() as u32, 0, 0, expected.len() as u32],
            "{what}"
        );
        let cubes: BTreeSet<u32> = words[5..5 + expected.len()].iter().copied().collect();
        println!("{what}: {} cubes", cubes.len());
        assert!(
            cubes == expected,
            "{what}: cubes are not where there is opacity"
        );
        // Filtering keeps the sum: the mean over all cells is that of the finest level.
        let mean_color = |texels: &[[f32; 4]]| {
            let sum = texels
                .iter()
                .fold(Vec3::ZERO, |sum, t| sum + Vec3::from_slice(&t[..3]));
            sum / texels.len() as f32
        };
        let (finest, shown) = (
            floats(&mut session, "voxelColor", 0),
            floats(&mut session, "voxelAttribute", mip),
        );
        let (a, b) = (mean_color(&finest), mean_color(&shown));
        assert!(
            (a - b).abs().max_element() < 0.01 * a.max_element(),
            "{what}: mean colour {a} became {b}"
        );
    }
}

#[test]
fn the_thesis_preset_renders() {
    let lab = lab(root());
    let mut experiment = Experiment::read(&root().join("configs/thesis.ron")).unwrap();
    let small = common::experiment("cornell", (64, 48), &[("voxel_dim", "64"), QUICK]);
    experiment.scene.clone_from(&small.scene);
    experiment.size = small.size;
    experiment.params.extend(small.params);
    let mut session = frames(&lab, &experiment, &["radiance", "display"], 2);
    for name in ["radiance", "display"] {
        let texels = floats(&mut session, name, 0);
        println!("thesis preset: mean {name} {:.4}", mean(&texels));
        assert_picture(&texels, name);
    }
}

#[test]
fn the_preview_shows_every_scene_on_the_plainest_device() {
    let lab = lab(root());
    for (name, _) in conelab::scene::builtin::list() {
        let mut experiment = experiment(name, (64, 48), &[]);
        experiment.graph = "preview.ron".into();
        let mut session = frames(&lab, &experiment, &["display"], 1);
        assert_picture(&floats(&mut session, "display", 0), name);
    }
    let Loaded {
        graph,
        linked,
        warnings,
    } = lab.home.load("preview.ron").unwrap();
    assert_eq!(warnings, []);
    let params = graph.params.clone();
    let device = DeviceInfo::imaginary(Features::default());
    let set = Evaluated::new(
        &graph,
        &params,
        environment(&scene("cornell"), (64, 48), &device),
    );
    plan(&set, &linked, &["display".into()], &device).unwrap();
}

/// A lamp whose plane goes through voxels: the shadow lookup there must not divide by zero.
#[test]
fn no_voxel_is_lit_by_not_a_number() {
    let lab = lab(root());
    let (experiment, scene) = (
        experiment("cornell", (16, 12), &[("voxel_dim", "128")]),
        scene("cornell"),
    );
    let (mut session, _) = lab
        .prepare(&experiment, scene, |_| Ok(vec!["voxelRadiance".into()]))
        .unwrap();
    session.frame(0.0).unwrap();
    let texels = session.texels("voxelRadiance", 0, 0).unwrap();
    let wrong = texels
        .floats()
        .iter()
        .filter(|t| t.iter().any(|v| !v.is_finite()))
        .count();
    assert_eq!(wrong, 0, "voxels whose radiance is not finite");
}
