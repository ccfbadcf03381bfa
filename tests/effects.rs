//! Which parameters have an effect with some settings, and what the panel shows first.

mod common;

use conelab::experiment::Experiment;
use conelab::graph::effect::{Reason, Running, effective, idle};
use conelab::graph::plan::plan;
use conelab::graph::{Evaluated, Res};
use conelab::lab::{Workspace, any_device, environment, params_of};
use conelab::shader::ShaderCompiler;
use std::collections::BTreeMap;

/// The parameters of a graph that change nothing with these settings, and what shaders take for an aperture of 0.
fn found(graph: &str, params: &str) -> (BTreeMap<String, Reason>, Option<f64>) {
    let home = Workspace::with(common::root().to_path_buf(), Some(common::cache()));
    let text =
        format!("(graph: \"{graph}\", scene: \"cornell\", size: (64, 48), params: {{ {params} }})");
    let experiment = Experiment::from_text("effects.ron".as_ref(), &text).unwrap();
    let (scene, device) = (common::scene("cornell"), any_device());
    let loaded = home.load_for(&experiment, &scene, &device).unwrap();
    let params = params_of(&loaded.graph, &experiment).unwrap();
    let set = Evaluated::new(
        &loaded.graph,
        &params,
        environment(&scene, experiment.size, &device),
    );
    let wanted = vec![loaded.graph.output.clone().unwrap()];
    let plan = plan(&set, &loaded.linked, &wanted, &device).unwrap();
    let mut passes: Vec<usize> = plan.steps.iter().map(|s| s.pass).collect();
    passes.dedup();
    let written = plan
        .steps
        .iter()
        .flat_map(|s| &s.uses)
        .filter(|u| u.write)
        .map(|u| match u.res {
            Res::Texture(t, _) => loaded.graph.textures[t].0.as_str(),
            Res::Buffer(b, _) => loaded.graph.buffers[b].0.as_str(),
        });
    let running = Running {
        set: &set,
        linked: &loaded.linked,
        passes: &passes,
        written: written.collect(),
    };
    let aperture = params.list.iter().find(|p| p.name == "diffuse_aperture");
    let taken = aperture.and_then(|a| effective(&set, a));
    (
        idle(
            &running,
            &ShaderCompiler::new(&home.folders().shaders, home.cache.as_deref()),
        ),
        taken,
    )
}

#[test]
fn what_changes_nothing_is_told_with_the_choice_that_it_waits_for() {
    // The pinned parameters have an effect with the graph's defaults.
    let (idle, taken) = found("cones.ron", "");
    println!("{idle:#?}");
    for name in [
        "cone_count",
        "diffuse_aperture",
        "diffuse_steps",
        "bias",
        "lod_offset",
        "warp",
        "warp_alpha",
    ] {
        assert!(!idle.contains_key(name), "{name}: {:?}", idle.get(name));
    }
    assert_eq!(idle["volume_center"].text, "if volume == box");
    for name in [
        "exposure",
        "voxel_dim",
        "trace",
        "volume",
        "tone_map",
        "bounces",
    ] {
        assert!(!idle.contains_key(name), "{name}: {:?}", idle.get(name));
    }
    assert_eq!(taken, Some(6.0));

    let (idle, taken) = found(
        "cones.ron",
        "\"trace\": lobe_rays, \"volume\": box, \"diffuse_aperture\": 60",
    );
    let needs = idle
        .get("diffuse_aperture")
        .map_or(Vec::new(), |r| r.needs.clone());
    assert!(
        needs.contains(&("trace".into(), "cones".into())),
        "{:?}",
        idle.get("diffuse_aperture")
    );
    assert!(!idle.contains_key("volume_center"));
    assert_eq!(taken, None, "a set value is used");

    let (idle, _) = found("rays.ron", "");
    for name in [
        "pixel_rays",
        "gather_frames",
        "bounce_directions",
        "bounce_frames",
    ] {
        assert!(!idle.contains_key(name), "{name}: {:?}", idle.get(name));
    }
}

#[test]
fn a_warps_parameters_wait_for_the_warp() {
    let (idle, _) = found("cones.ron", "\"warp\": none");
    println!("{idle:#?}");
    assert!(
        idle["warp_alpha"]
            .needs
            .contains(&("warp".to_string(), "spline".to_string()))
    );
    assert_eq!(
        idle["warp_near"].text,
        "if warp == perspective || warp == spherical"
    );
    assert!(!idle.contains_key("warp"));
    let (idle, _) = found("warps.ron", "\"warp\": spline");
    assert!(
        !idle.contains_key("warp_alpha") && idle.contains_key("warp_steepness"),
        "{idle:?}"
    );
}

#[test]
fn the_graph_that_opens_first_pins_what_was_asked_for_in_that_order() {
    let home = Workspace::with(common::root().to_path_buf(), None);
    let first = Experiment::read(&home.root.join("configs/cones.ron")).unwrap();
    let asked = [
        ("cone_count", "Cone count"),
        ("diffuse_aperture", "Aperture"),
        ("diffuse_steps", "Steps"),
        ("bias", "Bias"),
        ("lod_offset", "LOD offset"),
        ("warp", "Warp"),
        ("warp_alpha", "Warp alpha"),
    ];
    for graph in [first.graph.as_str(), "warps.ron", "temporal.ron"] {
        let graph = conelab::lab::load(&home.graph_path(graph), &home.folders()).unwrap();
        let pinned: Vec<_> = graph
            .pinned
            .iter()
            .map(|p| (p.0.as_str(), p.1.as_str()))
            .collect();
        assert_eq!(pinned, asked);
    }
}

/// Each control that is shown first, turned alone in the graph's own defaults, makes another picture.
#[test]
fn every_pinned_parameter_changes_the_picture() {
    let lab = common::lab(common::root());
    let home = Workspace::with(common::root().to_path_buf(), None);
    for (graph, turned) in [
        (
            "cones.ron",
            &[
                ("cone_count", "3"),
                ("diffuse_aperture", "50"),
                ("diffuse_steps", "4"),
                ("bias", "2"),
                ("lod_offset", "0"),
                ("warp", "perspective"),
                ("warp_alpha", "0.25"),
            ][..],
        ),
        (
            "rays.ron",
            &[
                ("voxel_dim", "48"),
                ("pixel_rays", "4"),
                ("gather_frames", "2"),
                ("bounce_directions", "4"),
            ],
        ),
        (
            "thesis.ron",
            &[
                ("diffuse_aperture", "60"),
                ("diffuse_steps", "4"),
                ("bias", "2"),
                ("lod_offset", "-1"),
            ],
        ),
    ] {
        let pinned = conelab::lab::load(&home.graph_path(graph), &home.folders())
            .unwrap()
            .pinned;
        let names: Vec<&str> = pinned.iter().map(|p| p.0.as_str()).collect();
        assert_eq!(names, turned.iter().map(|t| t.0).collect::<Vec<_>>());
        let picture = |set: &[(&str, &str)]| {
            let small = [("voxel_dim", "32"), ("shadow_dim", "256")];
            let mut experiment =
                common::experiment("cornell", (48, 36), &[&small[..], set].concat());
            experiment.graph = graph.into();
            let mut session = common::prepare(&lab, &experiment, &["display"]);
            session.run(3).unwrap();
            session.finish().unwrap();
            session.texels("display", 0, 0).unwrap().bytes
        };
        let unturned = picture(&[]);
        for (name, value) in turned {
            assert!(
                picture(&[(name, value)]) != unturned,
                "{graph}: {name} = {value} shows the same picture"
            );
        }
    }
    common::assert_clean(&lab);
}
