//! Devices without optional features: each one is masked on a device that has it.

mod common;

use common::{assert_clean, experiment, floats, home, lab, lab_without, mean, scene};
use conelab::lab::{Lab, LabError};

/// All stages by threads, as on a GPU by default.
const THREADS: [(&str, &str); 3] = [
    ("shadow_map", "compute"),
    ("gbuffer", "compute"),
    ("voxelizer", "compute"),
];

/// The picture after some frames.
fn picture(lab: &Lab, settings: &[(&str, &str)]) -> Result<Vec<[f32; 4]>, LabError> {
    let small = [("voxel_dim", "32"), ("shadow_dim", "256")];
    let look = experiment("cornell", (64, 48), &[&small[..], settings].concat());
    let wanted = vec!["radiance".to_owned()];
    let (mut session, _) = lab.prepare(&look, scene("cornell"), |_| Ok(wanted))?;
    session.run(20)?;
    Ok(floats(&mut session, "radiance", 0))
}

/// The largest difference of a pixel's channel, and that of the means, both relative to the mean.
fn difference(a: &[[f32; 4]], b: &[[f32; 4]]) -> (f64, f64) {
    let most = a
        .iter()
        .zip(b)
        .flat_map(|(a, b)| (0..3).map(|c| (a[c] - b[c]).abs()));
    let most = f64::from(most.fold(0.0, f32::max));
    (most / mean(b), (mean(a) / mean(b) - 1.0).abs())
}

#[test]
fn the_default_method_needs_none_of_these() {
    let home = home();
    let whole = picture(&lab(home.path()), &THREADS).unwrap();
    let masks = [
        "anisotropy",
        "bc",
        "calibrated_timestamps",
        "clip_distance",
        "conservative_rasterization",
        "depth_clamp",
        "fragment_stores",
        "full_index",
        "geometry",
        "independent_blend",
        "multi_draw_indirect",
        "pipeline_statistics",
        "shares_memory",
        "tessellation",
        "timestamps",
        "vertex_stores",
    ];
    let lab = lab_without(home.path(), &masks);
    let masked = picture(&lab, &THREADS).unwrap();
    assert!(
        masked == whole,
        "without all of these the picture is another one"
    );
    assert_clean(&lab);
}

/// Without atomics of 64 bits the rasteriser finds what pixels see.
#[test]
fn the_rasteriser_stands_in_for_atomics() {
    let home = home();
    let whole = picture(&lab(home.path()), &THREADS).unwrap();
    let lab = lab_without(home.path(), &["int64_atomics"]);
    let masked = picture(&lab, &THREADS).unwrap();
    let (most, means) = difference(&masked, &whole);
    println!("without int64_atomics: a pixel differs by {most:.4}, the mean by {means:.5}");
    assert!(means < 0.005, "{means}");
    assert_clean(&lab);
}

/// A pass that cannot run names the feature that is missing, and a setting that helps.
#[test]
fn refusals_name_the_feature_and_a_way_out() {
    let home = home();
    for (mask, settings, says, instead) in [
        (
            "tessellation",
            &[("voxelizer", "tessellated")][..],
            "tessellation",
            "--set voxelizer=",
        ),
        (
            "geometry",
            &[("voxelizer", "raster"), ("conservative", "dilate")],
            "geometry shaders",
            "--set ",
        ),
        (
            "depth_clamp",
            &[("shadow_map", "raster")],
            "depth clamping",
            "--set shadow_map=",
        ),
        (
            "write_without_format",
            &THREADS,
            "writing images without a format",
            "",
        ),
    ] {
        let lab = lab_without(home.path(), &[mask]);
        let said = match picture(&lab, settings) {
            Err(e) => e.to_string(),
            Ok(_) => panic!("runs without {mask}"),
        };
        println!("without {mask}: {said}");
        assert!(said.contains(says) && said.contains(instead), "{said}");
        assert_clean(&lab);
    }
}

#[test]
fn unknown_masks_list_the_known_ones() {
    let mut command = common::conelab(common::root());
    command.args(["render", "configs/rays.ron", "--frames", "1", "-o", "x.png"]);
    command.env("CONELAB_WITHOUT", "geometry,ray_tracing");
    let said = common::fails(&mut command);
    assert!(
        said.contains("no optional feature 'ray_tracing'") && said.contains("int64_atomics"),
        "{said}"
    );
}

/// 256^3 voxels do not fit into 0.2 GiB, and the offered number of voxels does.
#[test]
fn graphs_that_do_not_fit_say_what_would() {
    let home = home();
    let run = |set: &[&str], memory: &str| {
        let mut command = common::conelab(common::root());
        command.args([
            "render",
            "configs/rays.ron",
            "--scene",
            "cornell",
            "--size",
            "64x48",
        ]);
        command.args(["--set", "shadow_dim=256", "--frames", "1", "-o"]);
        command.arg(home.path().join("x.png"));
        set.iter().for_each(|s| {
            command.args(["--set", s]);
        });
        command.env("CONELAB_MEMORY", memory);
        command
    };
    let said = common::fails(&mut run(&["voxel_dim=256"], "0.2"));
    println!("{said}");
    assert!(said.contains("has 0.20 GiB of memory"), "{said}");
    let offered = said.split("--set voxel_dim=").nth(1).expect("an offer");
    let offered: String = offered.chars().take_while(char::is_ascii_digit).collect();
    let value: u32 = offered.parse().unwrap();
    assert!((16..256).contains(&value), "{value}");
    common::succeeds(&mut run(&[&format!("voxel_dim={value}")], "0.2"));
}
