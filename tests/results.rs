//! The tables of docs/results.md say what docs/recorded holds, which `scripts/record.sh` measured, and what the graphs
//! declare: no number in them is typed by hand. `CONELAB_BLESS=1 cargo test --release --test results` writes them anew.

mod common;

use common::root;
use conelab::lab::Workspace;
use conelab::lab::load;
use std::collections::BTreeMap;
use std::fmt::Write;

/// A record: command, device, commit, and lines by the names of their columns.
struct Record {
    said: String,
    lines: Vec<BTreeMap<String, String>>,
}

fn record(name: &str) -> Record {
    let path = root()
        .join("docs/recorded")
        .join(name)
        .with_extension("csv");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let head: Vec<&str> = text.lines().map_while(|l| l.strip_prefix("# ")).collect();
    let [command, device, commit] = head[..] else {
        panic!("{}: no command, device and commit", path.display())
    };
    let mut reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let names: Vec<String> = reader
        .headers()
        .unwrap()
        .iter()
        .map(str::to_string)
        .collect();
    // Of two columns of one name the later holds what was measured.
    let line = |r: csv::StringRecord| {
        names
            .iter()
            .cloned()
            .zip(r.iter().map(str::to_string))
            .collect()
    };
    let lines = reader.records().map(|r| line(r.unwrap())).collect();
    Record {
        said: format!("{device}, {commit}: `{command}`"),
        lines,
    }
}

/// A table in Markdown: the head, and lines of cells.
fn table(head: &[&str], lines: &[Vec<String>]) -> String {
    let mut out = format!("| {} |\n|{}\n", head.join(" | "), "---|".repeat(head.len()));
    for line in lines {
        let _ = writeln!(out, "| {} |", line.join(" | "));
    }
    out
}

fn number(line: &BTreeMap<String, String>, column: &str) -> f64 {
    line.get(column)
        .and_then(|v| v.parse().ok())
        .unwrap_or(f64::NAN)
}

/// A path as its file's stem, all else as it is.
fn short(value: &str) -> String {
    let stem = value.trim_matches('"').rsplit('/').next().unwrap_or(value);
    stem.strip_suffix(".ron").unwrap_or(stem).to_string()
}

/// The line of a benchmark's slow frames.
const SLOW: &str = "total, 95th percentile";

/// A benchmark: a line for each stage, a column for each configuration; medians, ms.
fn times(name: &str) -> String {
    let record = record(name);
    let known = [
        "experiment",
        "width",
        "height",
        "kind",
        "name",
        "min ms",
        "median ms",
        "p95 ms",
        "error",
    ];
    let axes: Vec<&String> = record.lines[0]
        .keys()
        .filter(|k| !known.contains(&k.as_str()))
        .collect();
    let differs = |column: &str| {
        record
            .lines
            .iter()
            .any(|l| l[column] != record.lines[0][column])
    };
    let title = |line: &BTreeMap<String, String>| {
        let mut parts: Vec<String> = axes.iter().map(|a| short(&line[*a])).collect();
        if differs("experiment") {
            parts.insert(0, line["experiment"].clone());
        }
        if differs("width") {
            parts.push(format!("{}x{}", line["width"], line["height"]));
        }
        parts.join(" ")
    };
    let (mut columns, mut rows): (Vec<String>, Vec<String>) = (Vec::new(), Vec::new());
    let mut cells: BTreeMap<(String, String), f64> = BTreeMap::new();
    let mut slowest: Vec<String> = vec![SLOW.into()];
    for line in record.lines.iter().filter(|l| l["kind"] != "pass") {
        let (column, row) = (title(line), line["name"].clone());
        if !columns.contains(&column) {
            columns.push(column.clone());
        }
        if !rows.contains(&row) {
            rows.push(row.clone());
        }
        if row == "total" {
            slowest.push(format!("{:.2}", number(line, "p95 ms")));
        }
        cells.insert((row, column), number(line, "median ms"));
    }
    // Stages of a few hundredths in all columns, one by one, say nothing.
    let weighs = |row: &&String| {
        columns.iter().any(|c| {
            cells
                .get(&((*row).clone(), c.clone()))
                .is_some_and(|ms| *ms >= 0.05)
        })
    };
    rows.retain(|row| row != "total");
    let mut lines: Vec<Vec<String>> = Vec::new();
    let shown = |row: &String| {
        let cell = |c: &String| {
            cells
                .get(&(row.clone(), c.clone()))
                .map_or(String::new(), |ms| format!("{ms:.2}"))
        };
        std::iter::once(row.clone())
            .chain(columns.iter().map(cell))
            .collect()
    };
    lines.extend(rows.iter().filter(weighs).map(shown));
    let small = rows.iter().filter(|r| !weighs(r)).count();
    let rest = |c: &String| -> f64 {
        rows.iter()
            .filter(|r| !weighs(r))
            .filter_map(|r| cells.get(&(r.clone(), c.clone())))
            .sum()
    };
    if small > 0 {
        let sums = columns.iter().map(|c| format!("{:.2}", rest(c)));
        lines.push(
            std::iter::once(format!("{small} more"))
                .chain(sums)
                .collect(),
        );
    }
    lines.push(shown(&"total".to_string()));
    lines.push(slowest);
    let head: Vec<&str> = std::iter::once("ms")
        .chain(columns.iter().map(String::as_str))
        .collect();
    format!("*{}*\n\n{}", record.said, table(&head, &lines))
}

/// A record that is JSON, and what is said above its table.
fn json(name: &str) -> (String, serde_json::Value) {
    let path = root()
        .join("docs/recorded")
        .join(name)
        .with_extension("json");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let all: serde_json::Value = serde_json::from_str(&text).unwrap();
    let (command, commit) = (
        all["command"].as_str().unwrap(),
        all["commit"].as_str().unwrap(),
    );
    let record = all["record"].clone();
    let device = match &record["device"] {
        serde_json::Value::String(name) => name.clone(),
        device => format!(
            "{}, {}",
            device["name"].as_str().unwrap(),
            device["driver"].as_str().unwrap()
        ),
    };
    (format!("*{device}, {commit}: `{command}`*"), record)
}

/// Incremental execution while something moves: what the passes that run take, by stage.
fn moving(name: &str) -> String {
    let (said, record) = json(name);
    let (mut stages, mut skipped): (Vec<(String, f64)>, usize) = (Vec::new(), 0);
    for pass in record["passes"].as_array().unwrap() {
        let (stage, ms) = (
            pass["stage"].as_str().unwrap(),
            pass["gpu_ms"]["median"].as_f64().unwrap(),
        );
        skipped += usize::from(pass["skipped"].as_u64() == pass["frames"].as_u64());
        match stages.iter_mut().find(|s| s.0 == stage) {
            Some(of) => of.1 += ms,
            None => stages.push((stage.into(), ms)),
        }
    }
    let total = record["total_gpu_ms"]["median"].as_f64().unwrap();
    let small: f64 = stages.iter().filter(|s| s.1 < 0.03).map(|s| s.1).sum();
    stages.retain(|s| s.1 >= 0.03);
    stages.extend([
        ("what takes less than 0.03".into(), small),
        ("total".into(), total),
    ]);
    let lines: Vec<Vec<String>> = stages
        .iter()
        .map(|(stage, ms)| vec![stage.clone(), format!("{ms:.2}")])
        .collect();
    let passes = record["passes"].as_array().unwrap().len();
    format!(
        "{said}\n\n{}\n{skipped} of {passes} passes are skipped in all of these frames.\n",
        table(&["stage", "ms"], &lines)
    )
}

/// FLIP of the reference's noise, marked if it is more than a quarter of the method's FLIP.
fn noise_cell(flip: f64, noise: f64) -> String {
    match noise {
        noise if noise.is_nan() => "unknown".into(),
        noise if noise <= 0.25 * flip => format!("{noise:.4}"),
        noise => format!("**{noise:.4}, above 1/4**"),
    }
}

#[test]
fn noise_above_a_quarter_of_the_flip_is_marked() {
    assert_eq!(noise_cell(0.1, 0.025), "0.0250");
    assert_eq!(noise_cell(0.1, 0.026), "**0.0260, above 1/4**");
    assert_eq!(noise_cell(0.1, f64::NAN), "unknown");
}

/// The three methods in every scene, the worst of rays first.
fn scenes() -> String {
    let record = record("scenes");
    let done = |experiment: &str| -> BTreeMap<String, &BTreeMap<String, String>> {
        let lines = record
            .lines
            .iter()
            .filter(|l| l["outcome"] == "done" && l["experiment"] == experiment);
        lines.map(|l| (l["scene"].clone(), l)).collect()
    };
    let methods = ["rays", "cones", "thesis"].map(done);
    let mut names: Vec<&String> = methods[0].keys().collect();
    names.sort_by(|a, b| {
        number(methods[0][*b], "total flip").total_cmp(&number(methods[0][*a], "total flip"))
    });
    let columns: [(&str, usize); 5] = [
        ("total energy_ratio", 2),
        ("total flip", 3),
        ("total relmse", 4),
        ("total, 1 bounces relmse", 4),
        ("total median ms", 2),
    ];
    let noise = |name: &String| number(methods[0][name], "total flip noise");
    let is_noise_known = names.iter().any(|name| noise(name).is_finite());
    let line = |name: &&String| {
        let cell = |(column, digits): (&str, usize)| {
            let of = methods
                .each_ref()
                .map(|m| m.get(*name).map_or(f64::NAN, |l| number(l, column)));
            of.map(|x| format!("{x:.digits$}")).join(" / ")
        };
        let noise = noise_cell(number(methods[0][*name], "total flip"), noise(name));
        std::iter::once((*name).clone())
            .chain(columns.map(cell))
            .chain(is_noise_known.then_some(noise))
            .collect()
    };
    let lines: Vec<Vec<String>> = names.iter().map(line).collect();
    let mut head = vec![
        "scene",
        "energy",
        "FLIP",
        "relMSE",
        "relMSE, one bounce",
        "ms",
    ];
    if is_noise_known {
        head.push("FLIP of the reference's noise");
    }
    format!(
        "*{}*\n\nEach cell: rays / cones / thesis.\n\n{}",
        record.said,
        table(&head, &lines)
    )
}

/// The thesis in every scene with its preset, with the exposure and steps of the lowest FLIP, and the FLIP of the other presets.
fn exposures() -> String {
    type Line = BTreeMap<String, String>;
    let (record, scenes) = (record("exposures"), record("scenes"));
    let done: Vec<&Line> = record
        .lines
        .iter()
        .filter(|l| l["outcome"] == "done")
        .collect();
    let mut names: Vec<&String> = done.iter().map(|l| &l["scene"]).collect();
    names.dedup();
    let line = |name: &String| {
        let all = || done.iter().copied().filter(|l| l["scene"] == *name);
        let preset = all()
            .find(|l| l["injection_exposure"] == "0" && l["diffuse_steps"] == "32")
            .unwrap();
        let best = |column: &str| {
            all()
                .min_by(|a, b| number(a, column).total_cmp(&number(b, column)))
                .unwrap()
        };
        let other = |method: &str| {
            let fits = |l: &&Line| {
                l["experiment"] == method && l["scene"] == *name && l["outcome"] == "done"
            };
            scenes
                .lines
                .iter()
                .find(fits)
                .map_or(f64::NAN, |l| number(l, "total flip"))
        };
        let found = best("total flip");
        let exposure = if found["injection_exposure"] == "0" {
            "preset"
        } else {
            &found["injection_exposure"]
        };
        let (one, energy) = ("total, 1 bounces flip", "total energy_ratio");
        vec![
            name.clone(),
            format!(
                "{:.3} ({:.2})",
                number(preset, "total flip"),
                number(preset, energy)
            ),
            format!(
                "{:.3} ({:.2})",
                number(found, "total flip"),
                number(found, energy)
            ),
            format!("{exposure}, {}", found["diffuse_steps"]),
            format!("{:.3}, {:.3}", number(preset, one), number(best(one), one)),
            format!("{:.3}, {:.3}", other("rays"), other("cones")),
        ]
    };
    let lines: Vec<Vec<String>> = names.into_iter().map(line).collect();
    let head = [
        "scene",
        "preset: FLIP (energy)",
        "best: FLIP (energy)",
        "exposure, steps",
        "one bounce: preset, best",
        "rays, cones",
    ];
    format!("*{}*\n\n{}", record.said, table(&head, &lines))
}

/// Rays to emitters: what they bring and cost.
fn lamps() -> String {
    let record = record("lamps");
    let mut names: Vec<String> = Vec::new();
    for line in &record.lines {
        if !names.contains(&line["scene"]) {
            names.push(line["scene"].clone());
        }
    }
    let settings = [("0", "0"), ("2", "4"), ("8", "4")];
    let line = |name: &String| {
        let of = |(pixel, voxel): (&str, &str)| {
            let fits = |l: &&BTreeMap<String, String>| {
                l["scene"] == *name
                    && l["emitter_rays"] == pixel
                    && l["bounce_emitter_rays"] == voxel
            };
            record.lines.iter().find(fits).unwrap()
        };
        let cell = |(column, digits): (&str, usize)| {
            settings
                .map(|s| format!("{:.digits$}", number(of(s), column)))
                .join(", ")
        };
        let cells = [
            ("total median ms", 2),
            ("total relmse", 4),
            ("total flip", 3),
            ("total energy_ratio", 2),
        ]
        .map(cell);
        std::iter::once(name.clone()).chain(cells).collect()
    };
    let lines: Vec<Vec<String>> = names.iter().map(line).collect();
    format!(
        "*{}*\n\n{}",
        record.said,
        table(&["scene", "ms", "relMSE", "FLIP", "energy"], &lines)
    )
}

/// Voxels of Sponza against the exact test.
fn voxels() -> String {
    let (said, record) = json("voxels");
    let mut lines = Vec::new();
    for mode in record["modes"].as_array().unwrap() {
        let score = &mode["score"];
        let Some(recall) = score["recall"].as_f64() else {
            continue;
        };
        let whole = |name: &str| score[name].as_u64().unwrap().to_string();
        lines.push(vec![
            mode["title"].as_str().unwrap().to_string(),
            format!("{recall:.3}"),
            whole("holes"),
            whole("extras"),
            whole("leaked_6"),
            whole("leaked_26"),
        ]);
    }
    let first = &record["modes"][0]["score"];
    let head = [
        "",
        "touched cells that are set",
        "missing",
        "set and not touched",
        "enclosed cells that a flood reaches through faces",
        "through corners too",
    ];
    format!(
        "{said}\n\n{} cells are touched, {} lie enclosed.\n\n{}",
        first["exact"],
        first["enclosed"],
        table(&head, &lines)
    )
}

/// Defaults of the parameters that both methods have and declare differently, and what one has alone.
fn presets() -> String {
    let home = Workspace::with(root().to_path_buf(), None);
    let params = |graph: &str| {
        load(&home.graph_path(graph), &home.folders())
            .unwrap()
            .params
            .list
    };
    let (ours, thesis) = (params("rays.ron"), params("thesis.ron"));
    let mut lines = Vec::new();
    for p in &ours {
        if let Some(t) = thesis
            .iter()
            .find(|t| t.name == p.name && t.default != p.default)
        {
            lines.push(vec![
                format!("`{}`", p.name),
                p.default.to_string(),
                t.default.to_string(),
            ]);
        }
    }
    let alone = |a: &[conelab::graph::param::Param], b: &[conelab::graph::param::Param]| {
        let names = a
            .iter()
            .filter(|p| b.iter().all(|o| o.name != p.name))
            .map(|p| format!("`{}`", p.name));
        names.collect::<Vec<_>>().join(", ")
    };
    format!(
        "{}\nOnly `rays.ron` has {}; only `thesis.ron` has {}.\n",
        table(&["parameter", "`rays.ron`", "`thesis.ron`"], &lines),
        alone(&ours, &thesis),
        alone(&thesis, &ours)
    )
}

/// Presets of the families, as the sweep names them.
const FAMILIES: [&str; 8] = [
    "rays",
    "cones",
    "thesis",
    "ddgi",
    "ssgi",
    "ssgi and rays",
    "rsm",
    "lpv",
];

/// The name of a scene, without its file's folder and ending.
fn scene_name(text: &str) -> &str {
    let name = text.rsplit('/').next().unwrap_or(text);
    name.trim_end_matches(".ron")
}

/// Values in the order in which they first come.
fn in_order<'r>(values: impl Iterator<Item = &'r str>) -> Vec<&'r str> {
    let mut list: Vec<&str> = Vec::new();
    for value in values {
        if !list.contains(&value) {
            list.push(value);
        }
    }
    list
}

/// FLIP of each family's preset in every scene, and what the reference's noise alone has.
fn families() -> String {
    let record = record("families");
    let scenes = in_order(record.lines.iter().map(|l| l["scene"].as_str()));
    let cell = |method: &str, scene: &str, column: &str| {
        let is = |l: &&BTreeMap<String, String>| l["method"] == method && l["scene"] == scene;
        let line = record.lines.iter().find(is).unwrap();
        format!("{:.3}", number(line, column))
    };
    let row = |title: &str, method: &str, column: &str| -> Vec<String> {
        let cells = scenes.iter().map(|scene| cell(method, scene, column));
        std::iter::once(title.into()).chain(cells).collect()
    };
    let mut lines: Vec<Vec<String>> = FAMILIES
        .iter()
        .map(|name| row(name, name, "total flip"))
        .collect();
    lines.push(row("noise of the reference", "rays", "total flip noise"));
    let mut head = vec![""];
    head.extend(scenes.iter().map(|s| scene_name(s)));
    format!("*{}*\n\n{}", record.said, table(&head, &lines))
}

/// What families reach in equal time, and what an equal error costs them.
fn fronts() -> String {
    const ASKED: [(&str, &str, &str); 3] = [
        ("flip within ms", "1", "FLIP within 1 ms"),
        ("flip within ms", "2", "FLIP within 2 ms"),
        ("ms within flip", "0.1", "ms within a FLIP of 0.1"),
    ];
    let record = record("fronts");
    let subjects = in_order(record.lines.iter().map(|l| l["subject"].as_str()));
    let names = in_order(record.lines.iter().map(|l| l["family"].as_str()));
    let mut out = format!("*{}*\n", record.said);
    for (asked, limit, title) in ASKED {
        let cell = |family: &str, subject: &str| {
            let is = |l: &&BTreeMap<String, String>| {
                l["family"] == family
                    && l["subject"] == subject
                    && l["asked"] == asked
                    && l["limit"] == limit
            };
            let found = record.lines.iter().find(is).map_or("", |l| &l["value"]);
            found
                .parse::<f64>()
                .map_or("-".into(), |v| format!("{v:.2}"))
        };
        let line = |family: &&str| -> Vec<String> {
            let cells = subjects.iter().map(|subject| cell(family, subject));
            std::iter::once((*family).into()).chain(cells).collect()
        };
        let lines: Vec<Vec<String>> = names.iter().map(line).collect();
        let mut head = vec![title];
        head.extend(subjects.iter().map(|s| s.split(' ').next().unwrap()));
        let _ = write!(out, "\n{}", table(&head, &lines));
    }
    out
}

/// Times of a frame of the families' presets.
fn methods() -> String {
    let record = record("methods");
    let totals = || record.lines.iter().filter(|l| l["kind"] == "total");
    let scenes = in_order(totals().map(|l| l["scene"].as_str()));
    let names = in_order(totals().map(|l| l["experiment"].as_str()));
    let cell = |name: &str, scene: &str| {
        let is = |l: &&BTreeMap<String, String>| l["experiment"] == name && l["scene"] == scene;
        let line = totals().find(is).unwrap();
        format!(
            "{:.2} ({:.2})",
            number(line, "median ms"),
            number(line, "p95 ms")
        )
    };
    let line = |name: &&str| -> Vec<String> {
        let cells = scenes.iter().map(|scene| cell(name, scene));
        std::iter::once((*name).into()).chain(cells).collect()
    };
    let lines: Vec<Vec<String>> = names.iter().map(line).collect();
    let mut head = vec!["ms, median (p95)"];
    head.extend(scenes.iter().map(|s| scene_name(s)));
    format!("*{}*\n\n{}", record.said, table(&head, &lines))
}

/// Error of changes of each family while something moves, and frames until a switched lamp is there.
fn steadiness() -> String {
    let record = record("steadiness");
    let cases = in_order(record.lines.iter().map(|l| l["case"].as_str()));
    let names = in_order(record.lines.iter().map(|l| l["method"].as_str()));
    let of = |name: &str, case: &str| {
        let is = |l: &&BTreeMap<String, String>| l["method"] == name && l["case"] == case;
        record.lines.iter().find(is).unwrap()
    };
    let line = |name: &&str| -> Vec<String> {
        let changes = cases
            .iter()
            .map(|case| format!("{:.2}", 1000.0 * number(of(name, case), "diffuse E_t")));
        let late = &of(name, "switch")["diffuse convergence frames"];
        let late = if late.is_empty() { "never" } else { late }.to_string();
        std::iter::once((*name).into())
            .chain(changes)
            .chain([late])
            .collect()
    };
    let lines: Vec<Vec<String>> = names.iter().map(line).collect();
    let mut head = vec!["1000 E_t of diffuse light"];
    head.extend(&cases);
    head.push("frames to converge after the switch");
    format!("*{}*\n\n{}", record.said, table(&head, &lines))
}

/// FLIP of each preset in each scene of a record.
fn gallery(name: &str, method: &str) -> String {
    const PRESETS: [&str; 8] = [
        "rays",
        "cones",
        "thesis",
        "ddgi",
        "ssgi and rays",
        "ssgi",
        "lpv",
        "rsm",
    ];
    let record = record(name);
    let scenes = in_order(record.lines.iter().map(|l| l["scene"].as_str()));
    let of = |preset: &str, scene: &str| {
        let is = |l: &&BTreeMap<String, String>| l[method] == preset && l["scene"] == scene;
        record.lines.iter().find(is)
    };
    let presets: Vec<&str> = PRESETS
        .into_iter()
        .filter(|p| scenes.iter().any(|s| of(p, s).is_some()))
        .collect();
    let line = |scene: &&str| -> Vec<String> {
        let score = |preset: &&str| {
            of(preset, scene).map_or("-".into(), |l| format!("{:.3}", number(l, "total flip")))
        };
        std::iter::once(format!("`{}`", scene_name(scene)))
            .chain(presets.iter().map(score))
            .collect()
    };
    let lines: Vec<Vec<String>> = scenes.iter().map(line).collect();
    let mut head = vec!["scene"];
    head.extend(&presets);
    format!("*{}*\n\n{}", record.said, table(&head, &lines))
}

/// Scene of the README's strip of pictures: a test scene.
const STRIP: &str = "sky-window";

/// Error and time of the pictures in the README's strip.
fn strip() -> String {
    let record = record("scenes");
    let names = ["thesis", "cones", "rays"];
    let of = |name: &str, column: &str| {
        let is = |l: &&BTreeMap<String, String>| l["experiment"] == name && l["scene"] == STRIP;
        number(record.lines.iter().find(is).unwrap(), column)
    };
    let row = |title: &str, column: &str, last: &str| -> Vec<String> {
        let cells = names.iter().map(|name| format!("{:.2}", of(name, column)));
        std::iter::once(title.into())
            .chain(cells)
            .chain([last.into()])
            .collect()
    };
    let lines = [
        row("FLIP, 0 is equal", "total flip", "reference"),
        row("ms a frame", "total median ms", "1024 samples"),
    ];
    let head = ["", "thesis", "narrow cones", "rays", "path tracer"];
    let said = format!(
        "The test scene `{STRIP}` at 480x270, against all bounces. {}",
        record.said
    );
    format!("{}\n*{said}*\n", table(&head, &lines))
}

fn block(name: &str) -> String {
    match name {
        "moving" | "actors" => moving(name),
        "scenes" => scenes(),
        "lamps" => lamps(),
        "exposures" => exposures(),
        "voxels" => voxels(),
        "presets" => presets(),
        "families" => families(),
        "fronts" => fronts(),
        "methods" => methods(),
        "steadiness" => steadiness(),
        "strip" => strip(),
        "gallery" => gallery("scenes", "experiment"),
        "gallery families" => gallery("families", "method"),
        times_of => times(times_of),
    }
}

/// The share by which the default's light deviates in scenes with lamps of about a voxel, percent.
fn lamps_off_by() -> (f64, f64) {
    const LAMPS: [&str; 5] = [
        "small-quad",
        "ceiling-panel",
        "neon-tube",
        "lampshade",
        "emitters",
    ];
    let record = record("scenes");
    let default = record
        .lines
        .iter()
        .filter(|l| l["experiment"] == "rays" && LAMPS.contains(&l["scene"].as_str()));
    let off: Vec<f64> = default
        .map(|l| 100.0 * (number(l, "total energy_ratio") - 1.0))
        .collect();
    assert_eq!(off.len(), LAMPS.len());
    (
        off.iter().copied().fold(f64::INFINITY, f64::min),
        off.into_iter().fold(f64::NEG_INFINITY, f64::max),
    )
}

#[test]
fn figures_of_the_readme_are_those_recorded() {
    let text = std::fs::read_to_string(root().join("README.md")).unwrap();
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let bench = record("rays");
    let of = |name: &str| {
        let is = |l: &&BTreeMap<String, String>| {
            l["experiment"] == "rays"
                && l["voxel_dim"] == "160"
                && l["name"] == name
                && l["kind"] != "pass"
        };
        number(bench.lines.iter().find(is).unwrap(), "median ms")
    };
    let words = bench.said.strip_prefix("NVIDIA ").unwrap();
    let (chip, _) = words.split_once([',', ' ']).unwrap();
    let moving = json("moving").1["total_gpu_ms"]["median"].as_f64().unwrap();
    let modes = json("voxels").1["modes"].as_array().unwrap().clone();
    let tessellated = modes.iter().find(|m| m["title"] == "tessellated").unwrap();
    let missed = 100.0 * (1.0 - tessellated["score"]["recall"].as_f64().unwrap());
    let (low, high) = lamps_off_by();
    for figure in [
        format!("is off by {low:+.0} to {high:+.0} %"),
        format!(
            "takes {:.1} ms (1920x1080, 160^3, {chip}), {moving:.1} ms if only the camera moves",
            of("total"),
        ),
        format!("miss {missed:.1} % of the cells that triangles overlap in Sponza (128^3)"),
    ] {
        assert!(
            text.contains(&figure),
            "README.md does not have '{figure}', which docs/recorded says"
        );
    }
}

#[test]
fn tables_say_what_was_recorded() {
    for (page, least) in [
        ("docs/results.md", 8),
        ("docs/families.md", 4),
        ("README.md", 1),
        ("docs/gallery.md", 2),
    ] {
        let path = root().join(page);
        let text = std::fs::read_to_string(&path).unwrap();
        let (mut out, mut skips, mut blocks) = (String::new(), false, 0);
        for line in text.lines() {
            if line == "<!-- end -->" {
                skips = false;
            }
            if !skips {
                let _ = writeln!(out, "{line}");
            }
            if let Some(name) = line
                .strip_prefix("<!-- recorded: ")
                .and_then(|l| l.strip_suffix(" -->"))
            {
                let _ = write!(out, "\n{}\n", block(name));
                (skips, blocks) = (true, blocks + 1);
            }
        }
        assert!(!skips, "a table of {page} has no end");
        assert!(blocks >= least, "{page} has {blocks} tables");
        if std::env::var_os("CONELAB_BLESS").is_some() {
            std::fs::write(&path, out).unwrap();
        } else {
            assert!(
                out == text,
                "{page} does not say what docs/recorded holds: CONELAB_BLESS=1 writes it anew"
            );
        }
    }
}
