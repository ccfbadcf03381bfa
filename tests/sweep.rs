//! Sweeps and benchmarks as people and clusters run them: killed, continued, split, with points that fail.

mod common;

use common::{conelab, fails, home, succeeds, table, table_with_times};
use conelab::campaign::sweep::Sweep;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::{Duration, Instant};

/// A sweep of cornell that a software device measures in tens of milliseconds a point.
fn sweep_file(home: &Path, axes: &str) -> PathBuf {
    let path = home.join("small.ron");
    let text = format!(
        "(experiments: [\"configs/cones.ron\"], warmup: 1, frames: 3,\n\
         set: {{ \"scene\": \"cornell\", \"size\": (64, 48), \"shadow_dim\": 256, \"voxel_dim\": 16, \"bounces\": \"one\" }},\naxes: [\n{axes}\n])"
    );
    std::fs::write(&path, text).unwrap();
    path
}

fn sweep(home: &Path, file: &Path, folder: &Path, more: &[&str]) -> std::process::Command {
    let mut command = conelab(home);
    command
        .arg("sweep")
        .arg(file)
        .arg("-o")
        .arg(folder)
        .args(more);
    command
}

/// The files of a folder with their bytes; those that are still being written have other names.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let list = std::fs::read_dir(folder)
        .into_iter()
        .flatten()
        .map(|e| e.unwrap().file_name());
    let names = list
        .map(|n| n.to_string_lossy().into_owned())
        .filter(|n| !n.starts_with('.'));
    names
        .map(|n| (n.clone(), std::fs::read(folder.join(&n)).unwrap()))
        .collect()
}

/// Kills of a run: more with CONELAB_TEST_KILLS.
fn kills() -> usize {
    std::env::var("CONELAB_TEST_KILLS")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(5)
}

#[test]
fn a_sweep_that_is_killed_again_and_again_ends_as_one_that_is_not() {
    let home = home();
    let count = 5 * kills();
    let axes = format!(
        "List(name: \"voxel_dim\", values: [16, 24]), Range(name: \"bias\", from: 0.5, to: 2, count: {count})"
    );
    let file = sweep_file(home.path(), &axes);
    let (whole, killed) = (home.path().join("whole"), home.path().join("killed"));
    let begin = Instant::now();
    let said = succeeds(&mut sweep(home.path(), &file, &whole, &[]));
    assert!(
        said.ends_with(&format!(
            "{} points: {} done, 0 failed, 0 left\n",
            2 * count,
            2 * count
        )),
        "{said}"
    );
    let a_point = begin.elapsed() / (2 * u32::try_from(count).unwrap());

    let points = killed.join("points");
    let mut kept = BTreeMap::new();
    for kill in 0..kills() {
        let mut command = sweep(home.path(), &file, &killed, &[]);
        let mut child = command
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let deadline = Instant::now() + Duration::from_secs(120);
        while files(&points).len() <= kept.len() && child.try_wait().unwrap().is_none() {
            assert!(
                Instant::now() < deadline,
                "no point is finished within two minutes"
            );
            std::thread::sleep(Duration::from_millis(2));
        }
        // Anywhere within the next two points: times that share no period with theirs.
        std::thread::sleep(a_point.mul_f64(2.0 * (kill as f64 * 0.618).fract()));
        assert!(
            child.try_wait().unwrap().is_none(),
            "the sweep ended before it was killed: it needs more points"
        );
        child.kill().unwrap();
        child.wait().unwrap();
        let now = files(&points);
        for (name, bytes) in &kept {
            assert!(
                now.get(name) == Some(bytes),
                "the finished point {name} was lost or measured again"
            );
        }
        kept = now;
    }
    let said = succeeds(&mut sweep(home.path(), &file, &killed, &[]));
    assert!(said.contains("points already done"), "{said}");
    let (expected, found) = (
        table(&whole.join("sweep.csv")),
        table(&killed.join("sweep.csv")),
    );
    assert_eq!(expected.len(), 2 * count);
    assert_eq!(found, expected);
    assert_eq!(files(&points).len(), 2 * count, "every point is there once");
    assert!(
        files(&killed.join("pictures")) == files(&whole.join("pictures")),
        "pictures differ"
    );
}

#[test]
fn a_search_that_is_killed_goes_on_and_ends_at_the_cheapest_of_what_it_tried() {
    let home = home();
    let bound = 0.2;
    let fit = |limit: &str| {
        let mut command = conelab(home.path());
        let fixed = "fit configs/cones.ron --scene cornell --size 64x48 --spp 16 --frames 3 --warmup 1 -o found.ron";
        let set =
            "--set shadow_dim=256 --set bounces=one --set voxelizer=raster --set warp_near=40";
        // A frustum that ends before it begins is refused.
        let vary = "--vary voxel_dim=16,24,32,48 --vary opacity=layers,coverage --vary warp=spline,perspective";
        command
            .args(format!("{fixed} {set} {vary} {limit}").split(' '))
            .current_dir(home.path());
        command
    };
    let limit = format!("--max-error {bound}");
    let mut child = fit(&limit)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let folder = home.path().join("found");
    let deadline = Instant::now() + Duration::from_secs(120);
    while files(&folder.join("points")).len() < 3 {
        assert!(
            child.try_wait().unwrap().is_none() && Instant::now() < deadline,
            "no three points to keep"
        );
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let kept = files(&folder.join("points"));

    let said = succeeds(&mut fit(&limit));
    let now = files(&folder.join("points"));
    assert!(
        kept.iter()
            .all(|(name, bytes)| now.get(name) == Some(bytes)),
        "what was tried was tried again"
    );
    let rows = table_with_times(&folder.join("sweep.csv"));
    assert!(
        said.contains(&format!("{} of 16 settings tried", rows.len())),
        "{said}"
    );
    let failed = rows.iter().filter(|r| r["outcome"] == "failed");
    assert!(
        failed.clone().count() > 0 && failed.clone().all(|r| r["warp"] == "perspective"),
        "{said}"
    );
    assert!(
        said.contains("cannot be run: ") && said.contains("warp=perspective"),
        "{said}"
    );

    // Of two goals each has the best of what it tried, and the second measures nothing again.
    let number = |row: &BTreeMap<String, String>, name: &str| row[name].parse::<f64>().unwrap();
    let best = |rows: &[BTreeMap<String, String>], bounded: &str, limit: f64, small: &str| {
        let within = rows
            .iter()
            .filter(|r| r["outcome"] == "done" && number(r, bounded) <= limit);
        within
            .map(|r| number(r, small))
            .min_by(f64::total_cmp)
            .unwrap()
    };
    let fastest = best(&rows, "total relmse", bound, "total median ms");
    assert!(
        said.contains(&format!("{fastest:.3} ms, relMSE")),
        "{fastest} in {said}"
    );
    let text = std::fs::read_to_string(home.path().join("found.ron")).unwrap();
    assert!(
        text.starts_with(&format!("// {fastest:.3} ms, relMSE")),
        "{text}"
    );
    let ms = 1.5 * fastest;
    let said = succeeds(&mut fit(&format!("--max-ms {ms}")));
    let least = best(
        &table_with_times(&folder.join("sweep.csv")),
        "total median ms",
        ms,
        "total relmse",
    );
    assert!(
        said.contains(&format!("relMSE {least:.4e} of the total")),
        "{least:.4e} in {said}"
    );
    let last = files(&folder.join("points"));
    assert!(
        now.iter()
            .all(|(name, bytes)| last.get(name) == Some(bytes)),
        "what was tried was tried again"
    );
    let page = succeeds(conelab(home.path()).arg("report").arg(&folder));
    assert!(page.contains("points are finished"), "{page}");
}

#[test]
fn points_that_fail_or_warn_are_recorded_and_the_rest_goes_on() {
    let home = home();
    // A frustum that ends before it begins is refused; room for 10000 fragments is too little for 64 voxels.
    let axes = "Settings(name: \"case\", values: { \"refused\": { \"warp\": \"perspective\", \"warp_near\": 40 }, \"good\": {}, \
                \"overflow\": { \"voxel_dim\": 64, \"fragment_capacity\": 10000 } })";
    let file = sweep_file(home.path(), axes);
    let folder = home.path().join("out");
    let said = fails(&mut sweep(home.path(), &file, &folder, &[]));
    assert!(said.contains("must be above warp_near"), "{said}");
    let rows = table(&folder.join("sweep.csv"));
    let column = |name: &str| rows.iter().map(|r| r[name].as_str()).collect::<Vec<_>>();
    assert_eq!(column("case"), ["refused", "good", "overflow"]);
    assert_eq!(column("outcome"), ["failed", "done", "done"]);
    assert!(
        rows[0]["error"].contains("must be above warp_near"),
        "{:?}",
        rows[0]
    );
    assert_eq!(rows[1]["warnings"], "");
    assert!(
        rows[2]["warnings"].contains("voxels were dropped"),
        "{:?}",
        rows[2]
    );
    // What has failed is not tried again unless that is asked for.
    let before = files(&folder.join("points"));
    assert!(
        !fails(&mut sweep(home.path(), &file, &folder, &[])).contains("must be above warp_near")
    );
    assert!(
        files(&folder.join("points")) == before,
        "finished points were measured again"
    );
    let said = fails(&mut sweep(home.path(), &file, &folder, &["--again"]));
    assert!(said.contains("must be above warp_near"), "{said}");
}

#[test]
fn scenes_that_are_not_on_the_machine_fail_alone() {
    let home = home();
    std::fs::write(
        home.path().join("gone.ron"),
        "(models: [(file: \"nowhere/gone.obj\")])",
    )
    .unwrap();
    let file = sweep_file(
        home.path(),
        "List(name: \"scene\", values: [\"gone.ron\", \"white-sky\"])",
    );
    let folder = home.path().join("out");
    let said = fails(&mut sweep(
        home.path(),
        &file,
        &folder,
        &["--reference", "32"],
    ));
    assert!(
        said.contains("set CONELAB_SCENES") && said.contains("1 points failed"),
        "{said}"
    );
    let rows = table(&folder.join("sweep.csv"));
    assert_eq!(
        rows.iter()
            .map(|r| r["outcome"].as_str())
            .collect::<Vec<_>>(),
        ["failed", "done"]
    );
    assert!(
        rows[0]["error"].contains("model 'nowhere/gone.obj' not found; looked in"),
        "{:?}",
        rows[0]
    );
    // Where the model has come since, the point is another one and is measured.
    let quad = "v -1 0 -3\nv 1 0 -3\nv 1 1 -3\nv -1 1 -3\nf 1 2 3 4\n";
    std::fs::create_dir(home.path().join("nowhere")).unwrap();
    std::fs::write(home.path().join("nowhere/gone.obj"), quad).unwrap();
    let said = succeeds(&mut sweep(home.path(), &file, &folder, &[]));
    assert!(said.contains("2 points: 2 done, 0 failed"), "{said}");
}

/// Charts mark the points whose parameters are all the defaults of their graph. The scene is absent, so that nothing is rendered.
#[test]
fn presets_are_the_points_without_a_parameter() {
    let home = home();
    let absent = "(models: [(file: \"nowhere/gone.obj\")])";
    std::fs::write(home.path().join("gone.ron"), absent).unwrap();
    let path = home.path().join("presets.ron");
    let text = "(experiments: [\"configs/rays.ron\"], set: { \"scene\": \"gone.ron\", \"size\": (64, 36) },\n\
                axes: [Settings(name: \"method\", values: { \"rays\": {}, \"coarse\": { \"voxel_dim\": 64 }, \"cones\": { \"graph\": \"cones.ron\" } })])";
    std::fs::write(&path, text).unwrap();
    let folder = home.path().join("out");
    fails(&mut sweep(home.path(), &path, &folder, &[]));
    let list: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.join("sweep.json")).unwrap()).unwrap();
    let presets: Vec<_> = (0..3)
        .map(|i| list["points"][i]["preset"].as_bool())
        .collect();
    assert_eq!(presets, [Some(true), Some(false), Some(true)]);
}

#[test]
fn a_report_of_several_scenes_has_them_in_a_table_worst_first() {
    let home = home();
    std::fs::write(
        home.path().join("gone.ron"),
        "(models: [(file: \"nowhere/gone.obj\")])",
    )
    .unwrap();
    let path = home.path().join("scenes.ron");
    let text = "(experiments: [\"configs/rays.ron\", \"configs/thesis.ron\"], warmup: 1, frames: 1, bounces: [4, 1],\n\
                set: { \"size\": (64, 36), \"shadow_dim\": 256, \"voxel_dim\": 16 },\n\
                axes: [List(name: \"scene\", values: [\"white-sky\", \"gone.ron\", \"cornell\"])])";
    std::fs::write(&path, text).unwrap();
    let folder = home.path().join("out");
    fails(&mut sweep(
        home.path(),
        &path,
        &folder,
        &["--reference", "64"],
    ));
    let wrote = succeeds(conelab(home.path()).arg("report").arg(&folder));
    assert!(wrote.contains("scenes.csv"), "{wrote}");
    let rows = table(&folder.join("report/scenes.csv"));
    let told: Vec<[&str; 3]> = rows
        .iter()
        .map(|r| ["scene", "method", "bounces"].map(|c| r[c].as_str()))
        .collect();
    let expected = ["cornell", "white-sky"].into_iter().flat_map(|scene| {
        [
            ("rays", "4"),
            ("rays", "1"),
            ("thesis", "4"),
            ("thesis", "1"),
        ]
        .map(|(method, b)| [scene, method, b])
    });
    let gone = [["gone", "rays", ""], ["gone", "thesis", ""]];
    assert_eq!(told, expected.chain(gone).collect::<Vec<_>>());
    // The scores are those of the sweep's table, each against its own reference.
    let all = table(&folder.join("sweep.csv"));
    for row in rows.iter().filter(|r| r["error"].is_empty()) {
        let point = all
            .iter()
            .find(|p| p["scene"] == row["scene"] && p["experiment"] == row["method"])
            .unwrap();
        let part = if row["bounces"] == "4" {
            "total"
        } else {
            "total, 1 bounces"
        };
        for metric in ["energy_ratio", "relmse", "flip"] {
            assert_eq!(row[metric], point[&format!("{part} {metric}")], "{row:?}");
        }
    }
    let page = std::fs::read_to_string(folder.join("report/index.html")).unwrap();
    let begin = page.find("<table id=\"scenes\">").unwrap();
    let shown = &page[begin..page.find("<div id=\"controls\">").unwrap()];
    let places =
        ["cornell", "white-sky", "gone"].map(|name| shown.find(&format!(">{name}<br>")).unwrap());
    assert!(places.is_sorted(), "{places:?}");
    // Of each of the two scenes the reference, and a picture and a map of the error for each method.
    assert_eq!(
        shown
            .matches("<img alt=\"reference\" src=\"data:image/jpeg;base64,")
            .count(),
        2
    );
    assert_eq!(shown.matches("data-kind=\"picture\"").count(), 4);
    assert_eq!(shown.matches("data-kind=\"error_map\"").count(), 4);
    assert_eq!(shown.matches("failed: ").count(), 2);
}

#[test]
fn shards_merge_to_the_whole_in_one_page_without_a_network() {
    let home = home();
    let file = sweep_file(
        home.path(),
        "List(name: \"voxel_dim\", values: [16, 24, 32]), List(name: \"opacity\", values: [\"coverage\", \"layers\"])",
    );
    let whole = home.path().join("whole");
    succeeds(&mut sweep(home.path(), &file, &whole, &[]));
    let shards: Vec<PathBuf> = (1..=4)
        .map(|i| home.path().join(format!("shard-{i}")))
        .collect();
    for (i, folder) in shards.iter().enumerate() {
        let said = succeeds(&mut sweep(
            home.path(),
            &file,
            folder,
            &["--shard", &format!("{}/4", i + 1)],
        ));
        let mine = if i < 2 { 2 } else { 1 };
        assert!(
            said.contains(&format!("shard {}/4: {mine} points: {mine} done", i + 1)),
            "{said}"
        );
    }
    let report = home.path().join("report");
    succeeds(
        conelab(home.path())
            .arg("report")
            .args(&shards)
            .arg("-o")
            .arg(&report),
    );
    let expected = table(&whole.join("sweep.csv"));
    assert_eq!(table(&report.join("points.csv")), expected);
    let page = std::fs::read_to_string(report.join("index.html")).unwrap();
    assert!(
        expected.iter().all(|row| page.contains(&row["id"])),
        "a point is not on the page"
    );
    for outside in ["src=\"http", "href=\"http", "url(", "@import", "fetch("] {
        assert!(!page.contains(outside), "the page needs {outside}");
    }
    assert!(page.contains("data:image/jpeg;base64,"), "no pictures");
}

#[test]
fn points_are_scored_against_references_and_measured_again_when_there_is_one() {
    let home = home();
    let file = sweep_file(
        home.path(),
        "List(name: \"size\", values: [(48, 36)]), List(name: \"diffuse_steps\", values: [128, 1]), List(name: \"diffuse_aperture\", values: [40]), List(name: \"lod_offset\", values: [0])",
    );
    let folder = home.path().join("out");
    succeeds(&mut sweep(home.path(), &file, &folder, &[]));
    assert!(!table(&folder.join("sweep.csv"))[0].contains_key("total relmse"));
    let refused = fails(conelab(home.path()).args(["report", "nowhere"]));
    assert!(
        refused.contains("give the folder that `conelab sweep` wrote"),
        "{refused}"
    );

    succeeds(&mut sweep(
        home.path(),
        &file,
        &folder,
        &["--reference", "64"],
    ));
    let rows = table(&folder.join("sweep.csv"));
    let score = |row: usize, column: &str| rows[row][column].parse::<f64>().unwrap();
    for part in ["total", "direct", "diffuse", "specular", "occlusion"] {
        assert!(score(0, &format!("{part} relmse")).is_finite());
    }
    // Cones of one sample are far from the reference, and change direct light in nothing.
    assert!(
        score(1, "diffuse hdr_flip") > 1.3 * score(0, "diffuse hdr_flip"),
        "{rows:?}"
    );
    assert!(
        score(1, "total hdr_flip") > 1.3 * score(0, "total hdr_flip"),
        "{rows:?}"
    );
    assert_eq!(rows[0]["direct relmse"], rows[1]["direct relmse"]);
    assert_eq!(rows[0]["reference samples, 64 bounces"], "64");
    assert_eq!(rows[0]["experiment"], "cones");

    let wrote = succeeds(conelab(home.path()).arg("report").arg(&folder));
    let chart = std::fs::read_to_string(folder.join("report/total-relmse.svg")).unwrap();
    assert_eq!(chart.matches("<circle").count(), 2, "{chart}");
    assert!(wrote.contains("diffuse-hdr-flip.svg"), "{wrote}");
}

#[test]
fn axes_are_walked_in_the_order_of_the_file() {
    let home = home();
    let file = sweep_file(
        home.path(),
        "Together({ \"bias\": [1, 2], \"diffuse_aperture\": [3, 4] }),\n\
         Range(name: \"voxel_dim\", from: 16, to: 64, count: 3, scale: log),\n\
         Sample(count: 4, seed: 7, of: { \"lod_offset\": Uniform(-2, 0), \"cone_count\": Whole(4, 7) })",
    );
    let sweep = Sweep::read(&file).unwrap();
    assert_eq!(sweep.len(), 2 * 3 * 4);
    assert_eq!(
        sweep.names,
        [
            "bias",
            "diffuse_aperture",
            "voxel_dim",
            "lod_offset",
            "cone_count"
        ]
    );
    let values = |index: usize| -> Vec<String> {
        sweep
            .point(index)
            .unwrap()
            .1
            .into_iter()
            .map(|l| l.1)
            .collect()
    };
    assert_eq!(values(0)[..3], ["1", "3", "16"]);
    assert_eq!(values(4)[..3], ["1", "3", "32"]);
    assert_eq!(values(12)[..3], ["2", "4", "16"]);
    // Four whole numbers, four samples: each is drawn once.
    let mut counts: Vec<String> = (0..4).map(|i| values(i)[4].clone()).collect();
    counts.sort();
    assert_eq!(counts, ["4", "5", "6", "7"]);
    let quarters: std::collections::BTreeSet<i64> = (0..4)
        .map(|i| (values(i)[3].parse::<f64>().unwrap() * 2.0).floor() as i64)
        .collect();
    assert_eq!(quarters.len(), 4);
    // The point's settings are the experiment's, over what the file sets for all.
    let (experiment, _) = sweep.point(23).unwrap();
    let last = |name: &str| {
        experiment
            .params
            .iter()
            .rev()
            .find(|p| p.0.value == name)
            .unwrap()
            .1
            .clone()
    };
    assert_eq!(
        (last("voxel_dim"), last("bias"), last("shadow_dim")),
        ("64".into(), "2".into(), "256".into())
    );
    // What stands beside comes first, once, and moves nothing else.
    let text = std::fs::read_to_string(&file).unwrap();
    std::fs::write(
        &file,
        text.replace("warmup: 1", "beside: [\"configs/thesis.ron\"], warmup: 1"),
    )
    .unwrap();
    let more = Sweep::read(&file).unwrap();
    assert_eq!((more.len(), more.names[0].as_str()), (25, "experiment"));
    assert_eq!(
        more.point(0).unwrap().1,
        [("experiment".to_string(), "thesis".to_string())]
    );
    assert_eq!(more.point(24).unwrap().1[1..], sweep.point(23).unwrap().1);
}

#[test]
fn mistakes_of_a_sweep_are_told_with_their_place_before_anything_is_measured() {
    let home = home();
    for (axes, message) in [
        (
            "List(name: \"voxel_dmi\", values: [16])",
            "small.ron:4:34: error: no parameter 'voxel_dmi' (did you mean 'voxel_dim'?)",
        ),
        (
            "List(name: \"voxel_dim\", values: [16, 1])",
            "small.ron:4:38: error: 'voxel_dim': 1 is outside 16 to 512",
        ),
        (
            "List(name: \"size\", values: [(64)])",
            "small.ron:4:29: error: 'size': expected (width, height), got (64)",
        ),
        (
            "List(name: \"bias\", value: [1])",
            "small.ron:4:20: error: unknown field 'value'",
        ),
        (
            "List(name: \"bias\", values: [])",
            "error: this axis has no values",
        ),
        (
            "Range(name: \"bias\", from: 0, to: 1, count: 900000)",
            "small.ron:4:44: error: a range has 1 to 20000 values",
        ),
        (
            "Together({ \"bias\": [1], \"diffuse_aperture\": [1, 2] })",
            "they are walked together",
        ),
        (
            "Sample(count: 3, of: { \"bias\": Log(0, 1) })",
            "small.ron:4:32: error: 'bias': nothing can be drawn from this",
        ),
        (
            "List(name: \"bias\", values: [1]), List(name: \"bias\", values: [2])",
            "'bias' is varied by two axes",
        ),
        (
            "List(name: \"camera\", values: [\"nope\"])",
            "has no camera 'nope'",
        ),
    ] {
        let file = sweep_file(home.path(), axes);
        let said = fails(&mut sweep(
            home.path(),
            &file,
            &home.path().join("out"),
            &[],
        ));
        assert!(said.contains(message), "{axes}:\n{said}");
        assert!(!home.path().join("out").exists(), "{axes}");
        // A camera is known with its scene only.
        if !axes.contains("camera") {
            let output = conelab(home.path())
                .arg("check")
                .arg(&file)
                .output()
                .unwrap();
            assert!(
                String::from_utf8_lossy(&output.stdout).contains(message),
                "{axes}: `check` does not say so"
            );
        }
    }
}

#[test]
fn a_benchmark_prints_stages_by_grid_and_totals_by_size() {
    let home = home();
    let out = home.path().join("bench");
    let mut command = conelab(home.path());
    command.args([
        "bench",
        "configs/rays.ron",
        "--scene",
        "cornell",
        "--sizes",
        "48x32,64x48",
    ]);
    command.args([
        "--axis",
        "voxel_dim=16,32",
        "--axis",
        "voxelizer=raster,tessellated",
        "--set",
        "shadow_dim=256",
    ]);
    // Else where there is a GPU threads draw, in other stages.
    command.args(["--set", "shadow_map=raster", "--set", "gbuffer=raster"]);
    command
        .args(["--rounds", "2", "--frames", "3", "--warmup", "1", "-o"])
        .arg(&out);
    let said = succeeds(&mut command);
    let first = |line: &&str| line.split("  ").next().unwrap_or("").to_string();
    let stages: Vec<String> = said
        .lines()
        .skip(4)
        .take(9)
        .collect::<Vec<_>>()
        .iter()
        .map(first)
        .collect();
    let expected = [
        "shadow map",
        "voxelize",
        "bounces",
        "radiance injection",
        "depth prepass",
        "G-buffer",
        "final shading",
        "display",
        "total",
    ];
    assert_eq!(stages, expected, "{said}");
    let totals: Vec<String> = said
        .lines()
        .skip_while(|l| *l != "total")
        .skip(2)
        .take(4)
        .collect::<Vec<_>>()
        .iter()
        .map(first)
        .collect();
    let rows = [
        "48x32 voxelizer raster",
        "48x32 voxelizer tessellated",
        "64x48 voxelizer raster",
        "64x48 voxelizer tessellated",
    ];
    assert_eq!(totals, rows, "{said}");
    let text = std::fs::read_to_string(out.join("bench.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    let configurations = json["configurations"].as_array().unwrap();
    assert_eq!(configurations.len(), 8);
    for c in configurations {
        let times = &c["times"];
        assert_eq!(times["rounds"].as_array().unwrap().len(), 2);
        // Stages leave nothing of the frame out: the least of each add up to no more than the least of the whole.
        let sum: f64 = times["stages"]
            .as_object()
            .unwrap()
            .values()
            .map(|s| s["min"].as_f64().unwrap())
            .sum();
        let total = times["stats"]["total_gpu_ms"]["min"].as_f64().unwrap();
        assert!(
            sum > 0.3 * total && sum <= total * 1.0001,
            "{sum} of {total}"
        );
    }
    for file in ["bench.csv", "stages.svg", "stage-voxelize.svg"] {
        assert!(out.join(file).is_file(), "no {file}");
    }
}

/// Records times of two small configurations, and reads them back as JSON.
fn recorded(home: &Path) -> (PathBuf, serde_json::Value) {
    let mut command = conelab(home);
    command.args([
        "bench",
        "configs/rays.ron",
        "configs/thesis.ron",
        "--scene",
        "cornell",
        "--sizes",
        "64x48",
    ]);
    command.args([
        "--set",
        "voxel_dim=32",
        "--set",
        "shadow_dim=256",
        "--rounds",
        "2",
        "--frames",
        "2",
    ]);
    command.args(["--warmup", "1", "-o", "out", "--record", "times"]);
    let said = succeeds(&mut command);
    let names: Vec<String> = files(&home.join("times")).into_keys().collect();
    assert!(names.len() == 1 && names[0].ends_with(".json"), "{names:?}");
    assert!(
        said.ends_with(&format!(
            "recorded 2 configurations in times/{}\n",
            names[0]
        )),
        "{said}"
    );
    let path = home.join("times").join(&names[0]);
    let json = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
    (path, json)
}

fn against(home: &Path, record: &Path, more: &[&str]) -> std::process::Command {
    let mut command = conelab(home);
    command
        .arg("bench")
        .args(more)
        .arg("--against")
        .arg(record)
        .args(["-o", "out"]);
    command
}

/// Divides every number of a list.
fn divide(list: &mut serde_json::Value, by: f64) {
    for ms in list.as_array_mut().unwrap() {
        *ms = (ms.as_f64().unwrap() / by).into();
    }
}

#[test]
fn recorded_times_are_measured_again_and_what_became_slower_fails() {
    let home = home();
    let (_, json) = recorded(home.path());
    let edited = home.path().join("edited.json");
    let write = |json: &serde_json::Value| std::fs::write(&edited, json.to_string()).unwrap();

    // A program beside itself: a folder finds the device's file; the tolerance is for machines that do other things.
    let said = succeeds(&mut against(
        home.path(),
        &home.path().join("times"),
        &["--tolerance", "20"],
    ));
    for title in ["rays", "thesis"] {
        assert!(
            said.contains(&format!(
                "\n{title}, cornell, 64x48, voxel_dim 32, shadow_dim 256\n"
            )),
            "{said}"
        );
    }
    assert_eq!(
        said.lines().filter(|l| l.starts_with("total ")).count(),
        2,
        "{said}"
    );
    assert!(
        said.ends_with("no stage is more than 2000 % slower\n"),
        "{said}"
    );
    // Its bench.json is that of the recorded configurations.
    let out: serde_json::Value =
        serde_json::from_slice(&std::fs::read(home.path().join("out/bench.json")).unwrap())
            .unwrap();
    for (recorded, now) in json["configurations"]
        .as_array()
        .unwrap()
        .iter()
        .zip(out["configurations"].as_array().unwrap())
    {
        let names =
            |v: &serde_json::Value| v.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
        assert_eq!(names(&recorded["stages"]), names(&now["times"]["stages"]));
        for (name, value) in recorded["params"].as_object().unwrap() {
            let now = &now["times"]["stats"]["params"][name];
            assert_eq!(
                value.as_str().unwrap(),
                now.as_str().map_or(now.to_string(), String::from),
                "{name}"
            );
        }
    }

    // One stage that was recorded a hundred times faster; the other configuration is not named.
    let mut fast = json.clone();
    divide(
        &mut fast["configurations"][1]["stages"]["final shading"],
        100.0,
    );
    write(&fast);
    let said = fails(&mut against(home.path(), &edited, &["--tolerance", "20"]));
    // The progress is before it.
    let said = said.get(said.find("error: ").unwrap()..).unwrap();
    let expected = "error: more than 2000 % slower than recorded: final shading ";
    assert!(
        said.starts_with(expected) && said.contains("(thesis, cornell"),
        "{said}"
    );
    assert!(!said.contains("total") && !said.contains("rays"), "{said}");
    // Only the experiment that is named is measured.
    succeeds(&mut against(
        home.path(),
        &edited,
        &["configs/rays.ron", "--tolerance", "20"],
    ));
    let said = fails(&mut against(home.path(), &edited, &["configs/nothing.ron"]));
    assert!(
        said.contains("the record has no times of 'configs/nothing.ron'"),
        "{said}"
    );

    // Stages with other names: the total is compared still. Settings, scene and driver that differ are named.
    let mut renamed = json.clone();
    renamed["device"]["driver"] = "another".into();
    let first = &mut renamed["configurations"][0];
    first["stages"] = serde_json::json!({ "everything": [1.0, 1.0] });
    first["params"]["exposure"] = "3.0".into();
    first["scene_sha256"] = "0".into();
    divide(&mut first["total"], 100.0);
    write(&renamed);
    let output = against(home.path(), &edited, &["--tolerance", "20"])
        .output()
        .unwrap();
    let (out, err) = (
        String::from_utf8(output.stdout).unwrap(),
        String::from_utf8(output.stderr).unwrap(),
    );
    assert_eq!(output.status.code(), Some(1), "{out}{err}");
    assert!(err.contains("slower than recorded: total "), "{err}");
    let ends = |name: &str, end: &str| out.lines().any(|l| l.starts_with(name) && l.ends_with(end));
    assert!(
        ends("everything ", " gone") && ends("final shading ", " new"),
        "{out}"
    );
    for note in [
        "the driver was another, is ",
        "exposure was 3.0, is ",
        "the scene is not the recorded one",
    ] {
        assert!(out.contains(&format!("note: {note}")), "{note}:\n{out}");
    }
}

#[test]
fn a_record_that_does_not_fit_says_why() {
    let home = home();
    let (path, json) = recorded(home.path());
    let edited = home.path().join("edited.json");
    let edit = |pointer: &str, value: serde_json::Value| {
        let mut json = json.clone();
        *json.pointer_mut(pointer).unwrap() = value;
        json.to_string()
    };
    let whole = std::fs::read_to_string(&path).unwrap();
    let many = vec![json["configurations"][0].clone(); 1001];
    let cases = [
        (
            edit("/device/name", "NVIDIA H100".into()),
            "the record is of 'NVIDIA H100' and this device is '",
        ),
        (
            edit("/schema", "conelab-times-9".into()),
            "its schema is 'conelab-times-9'",
        ),
        (edit("/rounds", 0.into()), "rounds and frames must be 1 to"),
        (
            edit("/frames/count", 4_000_000_000_u64.into()),
            "rounds and frames must be 1 to",
        ),
        (
            edit("/frames/warmup", u64::MAX.into()),
            "rounds and frames must be 1 to",
        ),
        (
            edit("/configurations", serde_json::json!([])),
            "it has 0 configurations",
        ),
        (
            edit("/configurations", many.into()),
            "it has 1001 configurations",
        ),
        (
            edit("/configurations/0/total", serde_json::json!([])),
            "configuration 1: 'total' has no times",
        ),
        (
            edit("/configurations/0/total/0", 0.into()),
            "configuration 1: 'total' took 0 ms",
        ),
        (
            edit("/configurations/1/stages/display/0", (-1).into()),
            "configuration 2: 'display' took -1 ms",
        ),
        (
            edit("/configurations/0/experiment", "\u{1b}[2J".into()),
            "characters that cannot be printed",
        ),
        (whole.replacen("[", "[1e999,", 1), "it is damaged: "),
        (whole[..whole.len() / 2].to_string(), "it is damaged: EOF"),
        ("[".repeat(100_000), "it is damaged: "),
        (" ".repeat(5 << 20), "bytes are more than the"),
    ];
    for (text, message) in cases {
        std::fs::write(&edited, &text).unwrap();
        let said = fails(&mut against(home.path(), &edited, &[]));
        assert!(
            said.contains(message),
            "{}\n{said}",
            &text[..text.len().min(300)]
        );
    }
    let said = fails(&mut against(home.path(), &home.path().join("nowhere"), &[]));
    assert!(
        said.contains("nothing to compare") && said.contains("--record"),
        "{said}"
    );

    // What no longer fits is named, what fits is compared, and the run fails.
    let mut unknown = json.clone();
    unknown["configurations"][0]["settings"]["voxel_dimm"] = "32".into();
    std::fs::write(&edited, unknown.to_string()).unwrap();
    let output = against(home.path(), &edited, &["--tolerance", "20"])
        .output()
        .unwrap();
    let (out, err) = (
        String::from_utf8(output.stdout).unwrap(),
        String::from_utf8(output.stderr).unwrap(),
    );
    assert_eq!(output.status.code(), Some(1), "{out}{err}");
    assert!(out.contains("\nthesis, cornell, 64x48"), "{out}");
    assert!(
        out.contains("cannot be measured again: rays, cornell, 64x48"),
        "{out}"
    );
    assert!(
        out.contains("error: no parameter 'voxel_dimm' (did you mean 'voxel_dim'?)"),
        "{out}"
    );
    assert!(
        err.contains("1 configurations cannot be measured again"),
        "{err}"
    );
    // The check needs no device for that.
    let check = |path: &Path| {
        let output = conelab(home.path())
            .arg("check")
            .arg(path)
            .output()
            .unwrap();
        (
            output.status.success(),
            String::from_utf8(output.stdout).unwrap(),
        )
    };
    let (ok, said) = check(&edited);
    assert!(
        !ok && said.contains("error: no parameter 'voxel_dimm'") && said.ends_with(" 1 errors\n"),
        "{said}"
    );
    assert!(check(&path).0);

    // A scene that is not on this machine is named and is no failure; nothing but such scenes is one.
    let mut missing = json.clone();
    let scene = r#"(models: [(file: "nowhere/nothing.obj")])"#;
    std::fs::write(home.path().join("missing.ron"), scene).unwrap();
    missing["configurations"][0]["settings"]["scene"] = "\"missing.ron\"".into();
    std::fs::write(&edited, missing.to_string()).unwrap();
    let said = succeeds(&mut against(home.path(), &edited, &["--tolerance", "20"]));
    assert!(
        said.contains("skipped: rays, missing, 64x48") && said.contains("set CONELAB_SCENES"),
        "{said}"
    );
    let said = fails(&mut against(home.path(), &edited, &["configs/rays.ron"]));
    assert!(said.contains("nothing of '"), "{said}");
}
