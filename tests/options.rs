//! Every parameter of every graph: each option of a choice, and another number than the default, builds, renders without a
//! message of the validation layer, and changes what its group says; the default, written out, changes nothing.

mod common;

use common::{assert_clean, lab, root};
use conelab::diagnostics::{At, Loc};
use conelab::experiment::Experiment;
use conelab::graph::param::{Kind, Param, Value};
use conelab::lab::load;
use conelab::lab::{Lab, LabError, Workspace};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// What a group of the panel is about: one of these textures differs where a parameter of it does.
fn textures(group: &str) -> &'static [&'static str] {
    match group {
        "Shadows" => &["shadowMap", "direct"],
        "Volume" => &["voxelColor", "voxelRadiance"],
        "Voxels" => &["voxelColor", "voxelNormal"],
        "Radiance" => &["voxelRadiance", "diffuseIndirect"],
        "Shading" => &["direct"],
        "Diffuse cones" | "Tracing" => &["diffuseIndirect"],
        "Rays" => &["diffuseIndirect", "specularIndirect"],
        "Specular cone" => &["specularIndirect"],
        "Display" | "Probe" => &["display"],
        other => panic!("no texture is known for the group '{other}'"),
    }
}

/// What a choice needs beside it to matter at all.
fn context(name: &str) -> &'static [(&'static str, &'static str)] {
    match name {
        "volume_snap" => &[("volume", "camera"), ("volume_size", "(24, 24, 24)")],
        "warp_viewport" => &[
            ("warp", "spline"),
            ("voxelizer", "raster"),
            ("conservative", "off"),
            ("warp_alpha", "0.05"),
        ],
        "fallback" => &[
            ("warp", "perspective"),
            ("warp_near", "1.0"),
            ("warp_far", "6.0"),
        ],
        "warp" => &[
            ("warp_alpha", "0.25"),
            ("warp_near", "1.0"),
            ("warp_far", "6.0"),
        ],
        "voxel_view" | "density" => &[("view", "voxels")],
        "conservative" => &[("voxelizer", "raster")],
        "trace" => &[("exact_rays", "8")],
        "tess_levels" | "tess_rate" => &[("voxelizer", "tessellated")],
        "volume_center" | "volume_size" => &[("volume", "box")],
        "volume_ahead" => &[
            ("volume", "camera"),
            ("volume_size", "(48, 48, 48)"),
            ("volume_snap", "voxel"),
            ("cascades", "2"),
        ],
        "volume_offset" => &[
            ("volume", "camera"),
            ("volume_size", "(24, 24, 24)"),
            ("volume_snap", "voxel"),
        ],
        "volume_turn" => &[
            ("warp", "perspective"),
            ("warp_near", "1.0"),
            ("warp_far", "40"),
        ],
        "warp_alpha" => &[("warp", "spline")],
        "warp_steepness" => &[("warp", "logistic")],
        "warp_near" | "warp_far" => &[("warp", "perspective")],
        "density_axis" => &[
            ("view", "voxels"),
            ("density", "surfaces"),
            ("warp", "logistic"),
        ],
        "voxel_view_cascade" => &[("view", "voxels"), ("cascades", "2")],
        "voxel_view_mip" => &[("view", "voxels")],
        "exact_rays" => &[("trace", "cone_rays")],
        _ => &[],
    }
}

/// Parameters that are for speed or memory, not for the picture.
const SAME_PICTURE: [&str; 6] = [
    "volume_scroll",
    "gbuffer",
    "shadow_map",
    "voxelizer",
    "voxel_capacity",
    "fragment_capacity",
];

/// What two frames of a still picture do not show, and the test that does.
const ELSEWHERE: [(&str, &str); 23] = [
    ("accumulation_rounds", "turns.rs"),
    ("bounce_frames", "turns.rs"),
    ("gather_rest", "turns.rs"),
    ("temporal_cut", "volume.rs"),
    ("rsm_dim", "families.rs"),
    ("rsm_samples", "families.rs"),
    ("rsm_radius", "families.rs"),
    ("rsm_spacing", "families.rs"),
    ("reflections", "families.rs"),
    ("lpv_dim", "families.rs"),
    ("lpv_cascades", "families.rs"),
    ("lpv_steps", "families.rs"),
    ("lpv_blocking", "families.rs"),
    ("probe_rows", "families.rs"),
    ("probe_rays", "families.rs"),
    ("probe_hysteresis", "families.rs"),
    ("probe_bias", "families.rs"),
    ("probe_moves", "families.rs"),
    ("ssgi_slices", "families.rs"),
    ("ssgi_steps", "families.rs"),
    ("ssgi_radius", "families.rs"),
    ("ssgi_thickness", "families.rs"),
    ("screen_miss", "families.rs"),
];

/// What depends on the order in which fragments come, which no two frames of a GPU share.
const BY_ORDER: [&str; 1] = ["merge=running_average"];

/// Scenes in which choices matter: a box with a ball, and metal of roughness 0.3 under a lamp.
struct Scenes {
    folder: TempDir,
}

impl Scenes {
    fn new() -> Scenes {
        let folder = tempfile::tempdir().unwrap();
        let model = root().join("configs/stability/scenes/strip-rough.obj");
        let metal = format!(
            "(models: [(file: {model:?})], lights: [Point(name: \"lamp\", color: (9, 9, 9), position: (0.3, 1.5, 0.5), shadow: true)],\n\
             cameras: {{ \"default\": (eye: (0, 1.2, 2.2), target: (0, 0, -0.3), fov_y: 50) }})"
        );
        std::fs::write(folder.path().join("metal.ron"), metal).unwrap();
        Scenes { folder }
    }

    fn of(&self, name: &str) -> PathBuf {
        match name {
            "specular_steps" | "triangle_rays" => self.folder.path().join("metal.ron"),
            "shadow_maps" => "plain".into(),
            _ => root().join("configs/scenes/workshop.ron"),
        }
    }
}

fn run(
    lab: &Lab,
    graph: &str,
    scene: &Path,
    settings: &[(&str, &str)],
    wanted: &[&str],
) -> Result<BTreeMap<String, Vec<u8>>, LabError> {
    let mut e = Experiment::read(&root().join("configs/rays.ron")).unwrap();
    e.graph = graph.into();
    e.scene = scene.to_string_lossy().into_owned();
    e.size = (32, 24);
    let params = load(&lab.home.graph_path(graph), &lab.home.folders())
        .unwrap()
        .params;
    let base = BASE.iter().filter(|(name, _)| params.index(name).is_some());
    for (name, value) in base.chain(settings) {
        e.params.push((
            Loc {
                value: (*name).to_string(),
                at: At::default(),
            },
            (*value).to_string(),
        ));
    }
    let scene = common::scene(&e.scene);
    let all = wanted
        .iter()
        .chain(&["display"])
        .map(|w| (*w).to_string())
        .collect();
    let (mut session, _) = lab.prepare(&e, scene, |_| Ok(all))?;
    for _ in 0..2 {
        session.frame(0.0)?; // what voxels reflect to each other is seen in the second
    }
    session.finish()?;
    assert_clean(lab);
    let made = |name: &&&str| {
        let index = session.graph.textures.iter().position(|t| t.0 == **name);
        index.is_some_and(|i| !session.program.plan.textures[i].usage.is_empty())
    };
    let names: Vec<&str> = wanted.iter().filter(made).copied().collect();
    names
        .into_iter()
        .map(|name| Ok((name.to_string(), session.texels(name, 0, 0)?.bytes)))
        .collect()
}

/// Of numbers of pictures as small as these.
const BASE: [(&str, &str); 2] = [("voxel_dim", "32"), ("shadow_dim", "256")];

/// The value of a parameter where nothing is said.
fn unset(param: &Param) -> String {
    let base = BASE.iter().find(|(name, _)| *name == param.name);
    base.map_or_else(
        || param.default.to_string(),
        |(_, value)| (*value).to_string(),
    )
}

/// The options of a choice or a flag; of numbers the default and another.
fn options(param: &Param) -> Vec<String> {
    let other = match (&param.kind, param.name.as_str()) {
        (Kind::Choice(options), _) => return options.clone(),
        (Kind::Bool, _) => return vec!["false".into(), "true".into()],
        (_, "shadow_dim") => "512".into(),
        (_, "voxel_dim") => "48".into(),
        (_, "voxel_samples") => "1".into(),
        (_, "cascades" | "diffuse_steps" | "specular_steps") => "2".into(),
        (_, "shadow_maps") => if number(&param.default) == 2.0 {
            "1"
        } else {
            "2"
        }
        .into(),
        (_, "volume_offset") => "(1.5, 0, 0.5)".into(),
        (_, "volume_turn") => "30".into(),
        (_, "probe") => "(16, 12)".into(),
        (_, "slice") => "(2, 0.5)".into(),
        (_, "volume_size") => "(8, 8, 8)".into(),
        // The scene has no sun: 0 is 1 there.
        (_, "injection_exposure") => "3".into(),
        (Kind::Int | Kind::Float, _) => between(param, number(&param.default)).to_string(),
        (Kind::Vector(_) | Kind::Colour, _) => match &param.default {
            Value::Vector(v) => {
                Value::Vector(v.iter().map(|x| between(param, *x)).collect()).to_string()
            }
            other => panic!("{} has the default {other}", param.name),
        },
    };
    vec![unset(param), other]
}

fn number(value: &Value) -> f64 {
    match value {
        Value::Int(i) => *i as f64,
        Value::Float(f) => *f,
        other => panic!("{other} is no number"),
    }
}

/// A number of the range, some way from the default.
fn between(param: &Param, default: f64) -> f64 {
    let (low, high) = param.range.unwrap_or((0.0, 1.0));
    let high = high.min(default.abs().mul_add(8.0, 2.0));
    let far = if high - default > default - low {
        high
    } else {
        low
    };
    let value = default + (far - default) / 2.0;
    if matches!(param.kind, Kind::Int) {
        value.round()
    } else {
        value
    }
}

#[test]
fn every_option_has_a_line_of_help() {
    let home = Workspace::with(root().to_path_buf(), None);
    for graph in [
        "rays.ron",
        "cones.ron",
        "warps.ron",
        "temporal.ron",
        "thesis.ron",
        "ddgi.ron",
        "ssgi.ron",
        "ssgi_rays.ron",
        "rsm.ron",
        "lpv.ron",
        "reference.ron",
    ] {
        for param in load(&home.graph_path(graph), &home.folders())
            .unwrap()
            .params
            .list
        {
            let lines = param
                .option_help
                .iter()
                .filter(|help| !help.is_empty())
                .count();
            assert_eq!(lines, param.kind.options().len(), "{graph}: {}", param.name);
        }
    }
}

#[test]
fn every_option_builds_renders_and_changes_what_its_group_says() {
    let (lab, scenes) = (lab(root()), Scenes::new());
    let home = Workspace::with(root().to_path_buf(), None);
    let params = |graph: &str| {
        load(&home.graph_path(graph), &home.folders())
            .unwrap()
            .params
            .list
    };
    let (mut options_run, mut wrong, mut tried) = (0, Vec::new(), BTreeSet::new());
    for graph in [
        "rays.ron",
        "cones.ron",
        "warps.ron",
        "temporal.ron",
        "thesis.ron",
        "ddgi.ron",
        "ssgi.ron",
        "ssgi_rays.ron",
        "rsm.ron",
        "lpv.ron",
    ] {
        for param in params(graph) {
            // The graphs of corrected methods are made of the same parts: each parameter is tried once.
            if graph != "thesis.ron" && !tried.insert(param.name.clone()) {
                continue;
            }
            if let Some((name, file)) = ELSEWHERE.iter().find(|e| e.0 == param.name) {
                let test = std::fs::read_to_string(root().join("tests").join(file)).unwrap();
                assert!(test.contains(name), "tests/{file} does not try {name}");
                continue;
            }
            // The running average depends on the order in which fragments come.
            let exact: &[(&str, &str)] = if graph == "thesis.ron" && param.name != "merge" {
                &[("merge", "average")]
            } else {
                &[]
            };
            let (mut context, wanted) = (
                [context(&param.name), exact].concat(),
                textures(&param.group),
            );
            context.retain(|(name, _)| params(graph).iter().any(|p| p.name == *name));
            let before = run(&lab, graph, &scenes.of(&param.name), &context, wanted).unwrap();
            assert!(
                !before.is_empty(),
                "{graph}: nothing of {wanted:?} is made for '{}'",
                param.name
            );
            for option in options(&param) {
                let what = format!("{graph}, {}={option}", param.name);
                let found = match run(
                    &lab,
                    graph,
                    &scenes.of(&param.name),
                    &[&context[..], &[(&param.name, &option)]].concat(),
                    wanted,
                ) {
                    Ok(found) => found,
                    Err(LabError::Input(errors))
                        if errors.iter().all(|e| e.message.contains("does not have")) =>
                    {
                        println!("{what}: skipped, {}", errors[0].message);
                        continue;
                    }
                    Err(e) => {
                        wrong.push(format!("{what}: {e}"));
                        continue;
                    }
                };
                options_run += 1;
                if BY_ORDER.contains(&format!("{}={option}", param.name).as_str()) {
                    continue;
                }
                let default = unset(&param) == option;
                if default != (found == before) && !SAME_PICTURE.contains(&param.name.as_str()) {
                    wrong.push(format!(
                        "{what}: {}",
                        if default {
                            "the default changes the picture"
                        } else {
                            "nothing changes"
                        }
                    ));
                }
            }
        }
    }
    println!("{options_run} options");
    assert!(options_run > 60, "{options_run} options");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
