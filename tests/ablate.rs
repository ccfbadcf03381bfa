//! `conelab ablate`: what is changed, what comes out, and that it goes on where it stopped.

mod common;

use common::{conelab, fails, home, succeeds, table};
use std::path::Path;
use std::process::Command;
use std::time::SystemTime;

/// A folder with the program's graphs and shaders, so that references are the test's own.
/// Cornell in 64x36 pixels and 32 voxels.
fn ablate(home: &Path, more: &[&str]) -> Command {
    let mut command = conelab(home);
    command.args([
        "ablate",
        "configs/cones.ron",
        "--size",
        "64x36",
        "--spp",
        "32",
    ]);
    command
        .args(["--set", "voxel_dim=32", "--set", "shadow_dim=256"])
        .args(more);
    command
}

const SHORT: [&str; 8] = [
    "--scenes", "cornell", "--frames", "2", "--warmup", "1", "--runs", "2",
];

#[test]
fn each_parameter_is_changed_alone_and_finished_points_stay() {
    let home = home();
    let folder = home.path().join("worth");
    let run = || {
        let mut command = ablate(home.path(), &SHORT);
        succeeds(
            command
                .args(["--only", "cone_count,mips", "-o"])
                .arg(&folder),
        )
    };
    let said = run();
    assert!(
        said.contains("| mips       | anisotropic | isotropic |"),
        "{said}"
    );
    let rows = table(&folder.join("ablation.csv"));
    let of = |name: &str, part: &str, quantity: &str, column: &str| -> f64 {
        let is = |r: &&std::collections::BTreeMap<String, String>| {
            r["parameter"] == name && r["part"] == part && r["quantity"] == quantity
        };
        rows.iter()
            .find(is)
            .unwrap_or_else(|| panic!("{name} {part} {quantity}"))[column]
            .parse()
            .unwrap()
    };
    // Time, memory and four errors of two parts, for each of two parameters.
    assert_eq!(rows.len(), 2 * (2 + 4 * 2));
    // Fewer cones make other light, and take no memory.
    for metric in ["relmse", "flip", "structure", "energy_ratio"] {
        assert!(
            of("cone_count", "diffuse", metric, "change") != 0.0,
            "{metric}"
        );
        assert!(
            of("cone_count", "total", metric, "change") != 0.0,
            "{metric}"
        );
        assert!(
            of("cone_count", "total", metric, "unchanged") > 0.0,
            "{metric}"
        );
    }
    assert_eq!(of("cone_count", "", "bytes", "change"), 0.0);
    assert!(
        of("mips", "", "bytes", "change") < -0.01,
        "five of six directions of the filtered levels are gone"
    );
    assert!(
        of("mips", "diffuse", "structure", "noise") > 0.01,
        "32 samples are noisy"
    );

    let points = |of: &Path| -> Vec<SystemTime> {
        let list = std::fs::read_dir(of.join("points")).unwrap();
        list.map(|f| f.unwrap().metadata().unwrap().modified().unwrap())
            .collect()
    };
    let (whole, again) = (points(&folder), points(&folder.join("unchanged-2")));
    assert_eq!((whole.len(), again.len()), (3, 1));
    // The same table, after what is said of points that are there.
    assert!(run().ends_with(&said));
    assert_eq!(
        (points(&folder), points(&folder.join("unchanged-2"))),
        (whole, again)
    );
}

#[test]
fn parameters_that_cannot_be_changed_are_told_apart() {
    let home = home();
    let said = |name: &str| fails(ablate(home.path(), &SHORT).args(["--only", name]));
    assert!(
        said("voxel_dim").contains("'voxel_dim' is at its plain value (128) already, or plainer")
    );
    assert!(said("bias").contains("'bias' has no plain value in its graph"));
    assert!(
        said("cone_cuont").contains("no parameter 'cone_cuont' (did you mean 'cone_count'?)"),
        "{}",
        said("cone_cuont")
    );
}

#[test]
fn the_steps_of_a_graph_are_there_as_well() {
    let home = home();
    let said = succeeds(&mut ablate(
        home.path(),
        &["--steps", "--scene", "cornell", "--set", "exact_rays=4"],
    ));
    assert!(
        said.contains("in brackets the error that the step adds") && said.contains("diffuse"),
        "{said}"
    );
}
