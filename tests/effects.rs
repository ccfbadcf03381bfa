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
    let home = Workspace { root: common::root().to_path_buf(), cache: Some(common::cache()) };
    let text = format!("(graph: \"{graph}\", scene: \"cornell\", size: (64, 48), params: {{ {params} }})");
    let experiment = Experiment::from_text("effects.ron".as_ref(), &text).unwrap();
    let (scene, device) = (common::scene("cornell"), any_device());
    let loaded = home.load_for(&experiment, &scene, &device).unwrap();
    let params = params_of(&loaded.graph, &experiment).unwrap();
    let set = Evaluated::new(&loaded.graph, &params, environment(&scene, experiment.size, &device));
    let wanted = vec![loaded.graph.output.clone().unwrap()];
    let plan = plan(&set, &loaded.linked, &wanted, &device).unwrap();
    let mut passes: Vec<usize> = plan.steps.iter().map(|s| s.pass).collect();
    passes.dedup();
    let written = plan.steps.iter().flat_map(|s| &s.uses).filter(|u| u.write).map(|u| match u.res {
        Res::Texture(t, _) => loaded.graph.textures[t].0.as_str(),
        Res::Buffer(b, _) => loaded.graph.buffers[b].0.as_str(),
    });
    let running = Running { set: &set, linked: &loaded.linked, passes: &passes, written: written.collect() };
    let aperture = params.list.iter().find(|p| p.name == "diffuse_aperture").unwrap();
    let taken = effective(&set, aperture);
    (idle(&running, &ShaderCompiler::new(&home.folders().shaders, home.cache.as_deref())), taken)
}

#[test]
fn what_changes_nothing_is_told_with_the_choice_that_it_waits_for() {
    let (idle, taken) = found("vct.ron", "");
    let needs = |name: &str| idle.get(name).map_or(Vec::new(), |r| r.needs.clone());
    println!("{idle:#?}");
    for name in ["cone_count", "diffuse_aperture", "diffuse_steps", "bias", "lod_offset"] {
        assert!(needs(name).contains(&("trace".into(), "cones".into())), "{name}: {:?}", idle.get(name));
    }
    assert_eq!(idle["volume_center"].text, "where volume == box");
    assert_eq!(idle["shadow_format"].text, "where shadow_map is raster");
    for name in ["exposure", "voxel_dim", "trace", "pixel_cones", "volume", "tone_map", "bounces"] {
        assert!(!idle.contains_key(name), "{name}: {:?}", idle.get(name));
    }
    assert_eq!(taken, None, "rays have no aperture");

    let (idle, taken) = found("vct.ron", "\"trace\": cones, \"volume\": box");
    for name in ["cone_count", "diffuse_aperture", "diffuse_steps", "bias", "lod_offset", "volume_center"] {
        assert!(!idle.contains_key(name), "{name}: {:?}", idle.get(name));
    }
    assert_eq!(taken, Some(78.0));

    let (idle, taken) = found("vct.ron", "\"trace\": cones, \"cone_set\": six60");
    let text = &idle["cone_count"].text;
    assert!(text.starts_with("where cone_set is wide or fitted, or where trace is "), "{text}");
    assert_eq!(taken, Some(60.0));
}

#[test]
fn a_warps_parameters_wait_for_the_warp() {
    let (idle, _) = found("warps.ron", "");
    println!("{idle:#?}");
    assert_eq!(idle["warp_alpha"].needs, [("warp".to_string(), "spline".to_string())]);
    assert_eq!(idle["warp_steepness"].text, "where warp is logistic");
    assert_eq!(idle["warp_near"].text, "where warp == perspective || warp == spherical");
    assert!(!idle.contains_key("warp"));
    let (idle, _) = found("warps.ron", "\"warp\": spline");
    assert!(!idle.contains_key("warp_alpha") && idle.contains_key("warp_steepness"), "{idle:?}");
}

#[test]
fn the_default_graphs_pin_what_was_asked_for_in_that_order() {
    let home = Workspace { root: common::root().to_path_buf(), cache: None };
    let asked =
        ["trace", "cone_count", "diffuse_aperture", "diffuse_steps", "bias", "lod_offset", "warp_alpha", "warp"];
    for graph in ["vct.ron", "warps.ron", "temporal.ron"] {
        let graph = conelab::graph::load::load(&home.graph_path(graph), &home.folders()).unwrap();
        assert_eq!(graph.pinned.iter().map(|p| p.0.as_str()).collect::<Vec<_>>(), asked);
        let titles: Vec<&str> = graph.pinned.iter().map(|p| p.1.as_str()).collect();
        assert_eq!(titles[..4], ["Light by", "Cone count", "Aperture", "Steps"]);
    }
}
