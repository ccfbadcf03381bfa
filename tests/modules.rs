//! Modules: an opacity model is added as docs/method.md says, with the texts that stand there; and what the parts of
//! graphs may say of one another.

mod common;

use common::{
    assert_clean, conelab, experiment, fails, floats, lab, mean, prepare, root, scene, succeeds,
};
use conelab::experiment::Experiment;
use conelab::graph::load::Folders;
use conelab::graph::param::Value;
use conelab::graph::plan::plan;
use conelab::graph::run::Change;
use conelab::graph::{Evaluated, Graph, signed};
use conelab::lab::load;
use conelab::lab::{Lab, Session, Workspace, any_device, environment};
use insta::assert_snapshot;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// What the page says.
struct Page {
    /// The new shader, from the repository's root.
    shader: PathBuf,
    glsl: String,
    /// The graph file that names it.
    graph: PathBuf,
    line: String,
    /// The option's name.
    option: String,
}

fn page() -> Page {
    let text = std::fs::read_to_string(root().join("docs/method.md")).unwrap();
    let section = text
        .split("\n## ")
        .find(|s| s.starts_with("Adding an opacity model\n"))
        .expect("the section is there");
    let quoted = |start: &str| {
        let from = section
            .find(&format!("`{start}"))
            .unwrap_or_else(|| panic!("`{start}...` stands in the section"));
        PathBuf::from(section[from + 1..].split('`').next().unwrap())
    };
    let block = |language: &str| {
        let fence = format!("\n```{language}\n");
        assert_eq!(
            section.matches(&fence).count(),
            1,
            "one block of {language}"
        );
        section
            .split(&fence)
            .nth(1)
            .unwrap()
            .split("```")
            .next()
            .unwrap()
            .to_string()
    };
    let shader = quoted("shaders/modules/opacity/");
    let option = shader.file_stem().unwrap().to_string_lossy().into_owned();
    Page {
        glsl: block("glsl"),
        line: block("ron"),
        graph: quoted("passes/"),
        shader,
        option,
    }
}

/// A copy of the method with the page's model in it: one file, one line.
fn home_with_model(page: &Page) -> TempDir {
    let home = common::home();
    assert!(
        !home.path().join(&page.shader).exists(),
        "{} is a new file",
        page.shader.display()
    );
    std::fs::write(home.path().join(&page.shader), &page.glsl).unwrap();
    assert_eq!(page.line.lines().count(), 1, "one line");
    edit(home.path(), &page.graph, |text| {
        let module = text.find("Module(name: \"opacity\"").unwrap();
        let options = module + text[module..].find("options: {\n").unwrap() + "options: {\n".len();
        let end = options
            + text[options..]
                .lines()
                .take_while(|l| !l.trim().starts_with('}'))
                .map(|l| l.len() + 1)
                .sum::<usize>();
        format!("{}{}{}", &text[..end], page.line, &text[end..])
    });
    home
}

fn edit(home: &Path, file: &Path, change: impl FnOnce(String) -> String) {
    let text = std::fs::read_to_string(home.join(file)).unwrap();
    std::fs::write(home.join(file), change(text)).unwrap();
}

/// A small picture of a built-in scene.
fn small(opacity: &str) -> Experiment {
    let experiment = experiment(
        "cornell",
        (48, 36),
        &[
            ("voxel_dim", "32"),
            ("shadow_dim", "256"),
            ("bounces", "one"),
            ("gather_frames", "1"),
            ("emitter_rays", "0"),
            ("cone_count", "3"),
            ("diffuse_aperture", "40"),
            ("lod_offset", "0"),
            ("opacity", opacity),
        ],
    );
    assert_eq!(experiment.graph, "cones.ron");
    experiment
}

/// The same on the command line, of the folders of `home`.
fn command(home: &Path, name: &str) -> Command {
    let mut command = conelab(home);
    command.args([
        name,
        "configs/cones.ron",
        "--scene",
        "cornell",
        "--size",
        "48x36",
    ]);
    command.args(["--set", "voxel_dim=32", "--set", "shadow_dim=256"]);
    command.args(["--set", "diffuse_aperture=40", "--set", "lod_offset=0"]);
    command
}

const WANTED: [&str; 3] = ["display", "radiance", "occlusion"];

fn pictures(session: &mut Session) -> [Vec<u8>; 3] {
    session.frame(0.0).unwrap();
    session.finish().unwrap();
    WANTED.map(|name| session.texels(name, 0, 0).unwrap().bytes)
}

/// The pictures of an option by the files in `folder`, and how open its surfaces are.
fn render(gpu: &Lab, folder: &Path, opacity: &str) -> ([Vec<u8>; 3], f64) {
    let lab = at(gpu, folder);
    let mut session = prepare(&lab, &small(opacity), &WANTED);
    let pictures = pictures(&mut session);
    assert_clean(&lab);
    (pictures, mean(&floats(&mut session, "occlusion", 0)))
}

/// The same device on other folders.
fn at(lab: &Lab, folder: &Path) -> Lab {
    Lab {
        home: Workspace::with(folder.to_path_buf(), lab.home.cache.clone()),
        gpu: lab.gpu.clone(),
    }
}

/// All files of a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path());
    entries
        .flat_map(|path| {
            if path.is_dir() {
                files(&path)
            } else {
                vec![path]
            }
        })
        .collect()
}

/// Groups of 8 to 64 threads that a device runs together change no result, because no shader can see them.
#[test]
fn no_shader_sees_the_size_of_subgroups() {
    let shaders = files(&root().join("shaders"));
    assert!(shaders.len() > 150, "{} files", shaders.len());
    for path in shaders {
        let text = std::fs::read_to_string(&path).unwrap();
        let seen = ["subgroup", "gl_Subgroup", "_ballot", "shader_group_vote"];
        let found = seen.iter().find(|word| text.contains(**word));
        assert!(found.is_none(), "{}: {found:?}", path.display());
    }
}

#[test]
fn the_page_names_files_and_settings_that_are_there() {
    let page = page();
    let home = home_with_model(&page);
    let text = std::fs::read_to_string(root().join("docs/method.md")).unwrap();
    let prose: String = text.split("\n```").step_by(2).collect();
    let files = [
        files(&home.path().join("shaders")),
        files(&home.path().join("passes")),
    ]
    .concat();
    let folders = Workspace::with(home.path().to_path_buf(), None).folders();
    let graph = |name: &str| load(&folders.passes.join(name), &folders).unwrap().params;
    let graphs = [
        "rays.ron",
        "cones.ron",
        "thesis.ron",
        "warps.ron",
        "temporal.ron",
    ]
    .map(graph);
    let (mut found, mut missing) = (0, Vec::new());
    for word in prose
        .split('`')
        .skip(1)
        .step_by(2)
        .filter(|w| !w.contains([' ', '(', '*', '>']))
    {
        let there = match (word.split_once('='), Path::new(word).extension()) {
            (Some((name, value)), _) => graphs.iter().any(|g| g.clone().set(name, value).is_ok()),
            // Made by the program.
            _ if word == "modules/opacity.glsl" => true,
            (_, Some(e)) if e != "rs" => files.iter().any(|f| f.ends_with(word)),
            _ if word.ends_with('/') => [".", "shaders", "passes"]
                .iter()
                .any(|f| home.path().join(f).join(word).is_dir()),
            _ => continue,
        };
        found += 1;
        if !there {
            missing.push(word);
        }
    }
    assert_eq!(missing, Vec::<&str>::new());
    assert!(found > 100, "{found} names of files and settings");
}

#[test]
fn a_model_is_one_file_and_one_line() {
    let page = page();
    let home = home_with_model(&page);
    // The page promises the graphs that include the file too.
    for graph in ["rays.ron", "warps.ron", "temporal.ron"] {
        let said = succeeds(
            conelab(home.path())
                .arg("check")
                .arg(Path::new("passes").join(graph)),
        );
        assert_eq!(said, "checked 1 files, 0 errors\n", "{graph}");
    }

    let gpu = lab(home.path());
    let (made, open) = render(&gpu, home.path(), &page.option);
    let (coverage, coverage_open) = render(&gpu, home.path(), "coverage");
    let (layers, _) = render(&gpu, home.path(), "layers");
    let (before, _) = render(&gpu, root(), "coverage");
    assert!(
        before == coverage,
        "a model that is not chosen changes nothing"
    );
    for (i, name) in WANTED.iter().enumerate() {
        assert!(
            made[i] != coverage[i] && made[i] != layers[i],
            "{name} is of the new model"
        );
    }
    // Surfaces that hide one another hide less of a cone.
    println!("openness: {open:.4}, by coverage {coverage_open:.4}");
    assert!(
        open > coverage_open + 0.005,
        "{open} against {coverage_open}"
    );
}

#[test]
fn a_mistake_in_a_model_is_told_and_keeps_nobody_from_rendering_with_another() {
    let page = page();
    let home = home_with_model(&page);
    let gpu = lab(home.path());
    for file in [
        &page.shader,
        Path::new("shaders/modules/opacity/layers.glsl"),
    ] {
        let text = std::fs::read_to_string(home.path().join(file)).unwrap();
        std::fs::write(home.path().join(file), format!("{text}float broken = ;\n")).unwrap();
        let place = format!(
            "{}:{}: error",
            home.path().join(file).display(),
            text.lines().count() + 1
        );

        let output = conelab(home.path())
            .args(["check", "passes/cones.ron"])
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stdout);
        assert_eq!(output.status.code(), Some(1), "{said}");
        assert_eq!(said.matches(&place).count(), 1, "{place}\n{said}");
        assert!(said.ends_with("checked 1 files, 1 errors\n"), "{said}");
        let option = file.file_stem().unwrap().to_string_lossy();
        let said = fails(command(home.path(), "render").args([
            "--set",
            &format!("opacity={option}"),
            "-o",
            "a.png",
        ]));
        assert!(said.contains(&place), "{place}\n{said}");

        assert!(render(&gpu, home.path(), "coverage").0 == render(&gpu, root(), "coverage").0);
        std::fs::write(home.path().join(file), text).unwrap();
    }
    // A line for a file that is not there.
    std::fs::remove_file(home.path().join(&page.shader)).unwrap();
    let output = conelab(home.path())
        .args(["check", "passes/cones.ron"])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(1), "{said}");
    let file = page
        .shader
        .strip_prefix("shaders")
        .unwrap()
        .to_string_lossy();
    assert!(said.contains(&*file), "{said}");
    assert!(render(&gpu, home.path(), "coverage").0 == render(&gpu, root(), "coverage").0);
}

#[test]
fn a_live_session_builds_only_what_includes_the_model() {
    let page = page();
    let home = home_with_model(&page);
    let lab = lab(home.path());
    let cornell = scene("cornell");
    let build = |option: &str, old: Option<&Session>| {
        let experiment = small(option);
        let loaded = lab
            .home
            .load_for(&experiment, &cornell, &lab.gpu.info)
            .unwrap();
        let wanted = WANTED.map(String::from).to_vec();
        let reuse = old.map(Session::reusable_parts);
        lab.build(
            &experiment,
            &loaded,
            cornell.clone(),
            wanted,
            reuse.as_ref(),
        )
        .unwrap()
    };
    let replace = |old: &mut Session, option: &str| {
        let mut next = build(option, Some(old));
        next.swap_in(old).unwrap();
        next
    };
    let mut session = build("coverage", None);
    let first = session.program.change;
    assert!(first.kept == 0 && first.built > 8, "{first:?}");
    let coverage = pictures(&mut session);

    // Another option: shading alone includes it.
    let one = Change {
        kept: first.built - 1,
        built: 1,
        resized: 0,
    };
    session = replace(&mut session, &page.option);
    assert_eq!(session.program.change, one);
    let made = pictures(&mut session);
    assert!(made != coverage && made == pictures(&mut build(&page.option, None)));

    // An edit of its file.
    edit(home.path(), &page.shader, |text| {
        assert_eq!(text.matches("exp(-a").count(), 1);
        text.replace("exp(-a", "exp(-2.0 * a")
    });
    session = replace(&mut session, &page.option);
    assert_eq!(session.program.change, one);
    assert!(pictures(&mut session) != made);

    // An edit of a file that is not chosen.
    edit(
        home.path(),
        Path::new("shaders/modules/opacity/layers.glsl"),
        |text| text + "// another\n",
    );
    session = replace(&mut session, &page.option);
    assert_eq!(
        session.program.change,
        Change {
            kept: first.built,
            built: 0,
            resized: 0
        }
    );

    // And back.
    session = replace(&mut session, "coverage");
    assert_eq!(session.program.change, one);
    assert!(pictures(&mut session) == coverage);
    assert_clean(&lab);
}

#[test]
fn what_is_no_more_says_what_to_write_instead() {
    let folders = Workspace::with(root().to_path_buf(), None).folders();
    let graph = load(&folders.passes.join("rays.ron"), &folders).unwrap();
    let instead = |name: &str| {
        graph
            .params
            .retired
            .iter()
            .find(|r| r.0 == name)
            .unwrap()
            .1
            .clone()
    };
    let out = tempfile::tempdir().unwrap();
    for (setting, retired, word) in [
        ("directional=false", "directional", "mips"),
        ("opacity=stored", "opacity=stored", "thesis.ron"),
    ] {
        let said = fails(
            command(root(), "render")
                .args(["--set", setting, "-o"])
                .arg(out.path().join("a.png")),
        );
        let text = instead(retired);
        assert!(
            text.contains(word) && said.contains(&text),
            "{setting}: {said}"
        );
    }
    assert!(
        std::fs::read_dir(out.path()).unwrap().next().is_none(),
        "nothing was rendered"
    );
}

#[test]
fn a_capture_replays_and_can_be_varied() {
    let page = page();
    let home = home_with_model(&page);
    succeeds(command(home.path(), "capture").args(["--name", "kept"]));
    let kept = home.path().join("captures/kept");
    let files = std::fs::read_dir(kept.join("graph/shaders/modules/opacity")).unwrap();
    let files: BTreeSet<String> = files
        .map(|f| f.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    let own = format!("{}.glsl", page.option);
    assert_eq!(
        files,
        BTreeSet::from(["cell.glsl", "coverage.glsl", "layers.glsl", &own].map(String::from))
    );

    // What the project holds does not matter any more.
    std::fs::remove_dir_all(home.path().join("shaders/modules")).unwrap();
    let said = succeeds(conelab(home.path()).args(["replay", "captures/kept"]));
    assert!(said.contains("identical: 2 images"), "{said}");

    // Another option, by the capture's own files, is what the method makes with it.
    let (graph, picture) = (kept.join("graph"), home.path().join("varied.exr"));
    let mut varied = conelab(&graph);
    varied.arg("render").arg(kept.join("experiment.ron")).args([
        "--set",
        &format!("opacity={}", page.option),
        "-o",
    ]);
    succeeds(varied.arg(&picture));
    let [varied, coverage] =
        [&picture, &kept.join("picture.exr")].map(|p| std::fs::read(p).unwrap());
    assert!(varied != coverage);
    let fresh = home_with_model(&page);
    let again = fresh.path().join("again.exr");
    succeeds(
        command(fresh.path(), "render")
            .args(["--set", &format!("opacity={}", page.option), "-o"])
            .arg(&again),
    );
    assert!(varied == std::fs::read(again).unwrap());
}

/// Graphs that need no device.
struct Bench(TempDir);

/// What others build on.
const BASE: &str = r#"(
    params: [
        Int(name: "size", default: 8, range: (1, 64), help: "Edge."),
        Choice(name: "filter", options: ["box", "tent"], help: "Kernel."),
        Choice(name: "grid", options: ["even", "warped"], help: "Cells."),
        Bool(name: "steady", default: false, help: "Blends."),
    ],
    values: { "edge": Int("2 * size"), "area": Int("edge * edge") },
    textures: { "picture": (size: ("area", 1), format: "r32f") },
    passes: [
        (name: "fill", clear: "picture"),
        (name: "finish", clear: "picture"),
    ],
    output: "picture",
)"#;

impl Bench {
    /// `graph.ron`, which includes the base and says `text`.
    fn new(text: &str) -> Bench {
        let bench = Bench(tempfile::tempdir().unwrap());
        bench.write("passes/base.ron", BASE);
        bench.write(
            "passes/graph.ron",
            &format!("(\n    include: [\"base.ron\"],\n{text}\n)"),
        );
        bench.write(
            "shaders/modules/plain.glsl",
            "float plain() { return 1.0; }\n",
        );
        bench
    }

    fn write(&self, name: &str, text: &str) {
        let path = self.0.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }

    fn load(&self) -> Result<Graph, String> {
        let folders = Folders {
            passes: self.0.path().join("passes"),
            shaders: self.0.path().join("shaders"),
        };
        load(&folders.passes.join("graph.ron"), &folders).map_err(|errors| {
            let text = errors
                .iter()
                .map(ToString::to_string)
                .collect::<Vec<_>>()
                .join("\n");
            text.replace(&format!("{}/", self.0.path().display()), "")
        })
    }
}

#[track_caller]
fn graph(text: &str) -> Graph {
    Bench::new(text)
        .load()
        .unwrap_or_else(|errors| panic!("{errors}"))
}

#[track_caller]
fn mistakes(text: &str) -> String {
    Bench::new(text).load().expect_err("it has a mistake")
}

#[test]
fn defaults_are_of_parameters_that_are_there() {
    assert_eq!(
        graph("    defaults: { \"size\": 16 },").params.get("size"),
        Some(&Value::Int(16))
    );
    assert_snapshot!(mistakes("    defaults: { \"sise\": 16 },"), @r#"
    passes/graph.ron:3:17: error: no parameter 'sise' to give a default to
        |     defaults: { "sise": 16 },
        = help: did you mean 'size'?
    "#);
    assert_snapshot!(mistakes("    defaults: { \"size\": 65 },"), @r#"
    passes/graph.ron:3:25: error: default of 'size': 65 is outside 1 to 64
        |     defaults: { "size": 65 },
    "#);
}

/// A fixed parameter is in expressions and shaders still; nothing that the graph offers would set it.
#[test]
fn a_fixed_parameter_keeps_its_default() {
    let more = r#"    defaults: { "size": 16 },
    fixed: ["size"],
    views: [
        (title: "fine", help: "Fine.", set: { "size": 32 }),
        (title: "bright", help: "Bright.", set: { "steady": true }),
    ],
    fit: { "size": [8, 16], "grid": ["even"] },"#;
    let fixed = graph(more);
    assert_eq!(value(&fixed, "area", &[]), Value::Int(1024));
    let mut params = fixed.params.clone();
    params.set("size", "16").unwrap();
    assert_eq!(
        params.set("size", "8").unwrap_err(),
        "'size' is fixed at 16 in this graph"
    );
    assert!(params.offered().all(|p| p.name != "size"));
    assert_eq!(
        fixed
            .views
            .iter()
            .map(|v| v.value.title.as_str())
            .collect::<Vec<_>>(),
        ["bright"]
    );
    assert_eq!(
        fixed
            .fit
            .iter()
            .map(|axis| axis.0.as_str())
            .collect::<Vec<_>>(),
        ["grid"]
    );
    assert_snapshot!(mistakes("    fixed: [\"sise\"],"), @r#"
    passes/graph.ron:3:13: error: no parameter 'sise' to fix
        |     fixed: ["sise"],
        = help: did you mean 'size'?
    "#);
}

#[test]
fn the_shipped_graphs_offer_at_most_46_parameters() {
    let workspace = Workspace::with(common::root().to_path_buf(), None);
    for name in [
        "cones.ron",
        "rays.ron",
        "thesis.ron",
        "warps.ron",
        "temporal.ron",
        "ddgi.ron",
        "ssgi.ron",
        "ssgi_rays.ron",
        "rsm.ron",
        "lpv.ron",
    ] {
        let graph = workspace.load(name).unwrap().graph;
        // The probe and the slice are set in the window, by a click and by the inspector.
        let is_cursor = |name: &str| graph.cursors().any(|cursor| cursor == name);
        let offered = graph.params.offered().filter(|p| !is_cursor(&p.name));
        let count = offered.count();
        assert!(count <= 46, "{name} has {count}");
    }
}

#[test]
fn a_module_is_fixed_or_chosen() {
    const CHOSEN: &str = r#"    params: [
        Module(name: "kernel", help: "Which.", options: { "plain": "modules/plain.glsl" }),
    ],"#;
    const FIXED: &str = r#"    modules: { "kernel": "modules/plain.glsl" },"#;
    assert_eq!(
        graph(FIXED).modules,
        [("kernel".to_string(), "modules/plain.glsl".to_string())]
    );
    assert_snapshot!(mistakes(&format!("{CHOSEN}\n{FIXED}")), @r#"
    passes/graph.ron:6:16: error: module 'kernel' is a parameter, which an option is chosen for: remove one
        |     modules: { "kernel": "modules/plain.glsl" },
    "#);
    assert_snapshot!(mistakes(&FIXED.replace("plain.glsl", "plane.glsl")), @r#"
    passes/graph.ron:3:26: error: no shader file 'modules/plane.glsl'
        |     modules: { "kernel": "modules/plane.glsl" },
        = help: did you mean 'modules/plain.glsl'?
    "#);

    // What an included file has fixed, an including one may offer.
    let bench = Bench::new(CHOSEN);
    bench.write(
        "passes/base.ron",
        &BASE.replace("    values: {", &format!("{FIXED}\n    values: {{")),
    );
    let graph = bench.load().unwrap();
    assert!(
        graph.modules.is_empty()
            && graph.params.get("kernel") == Some(&Value::Choice("plain".into()))
    );
}

#[test]
fn a_pass_stands_behind_one_that_is_there() {
    let pass = |after: &str| {
        format!("    passes: [(name: \"between\", after: \"{after}\", clear: \"picture\")],")
    };
    let names: Vec<String> = graph(&pass("fill"))
        .declared_passes()
        .map(|(_, pass)| pass.name.value.clone())
        .collect();
    assert_eq!(names, ["fill", "between", "finish"]);
    assert_snapshot!(mistakes(&pass("fil")), @r#"
    passes/graph.ron:3:39: error: no earlier pass is named 'fil'
        |     passes: [(name: "between", after: "fil", clear: "picture")],
        = help: did you mean 'fill'?
    "#);
}

/// A named value of a graph with these settings.
fn value(graph: &Graph, name: &str, settings: &[(&str, &str)]) -> Value {
    let mut params = graph.params.clone();
    for (name, value) in settings {
        params.set(name, value).unwrap();
    }
    let set = Evaluated::new(
        graph,
        &params,
        environment(&scene("triangles"), (64, 48), &any_device()),
    );
    let index = graph.values.iter().position(|v| v.name == name).unwrap();
    set.values[index].clone()
}

#[test]
fn a_value_of_an_including_file_replaces_the_included_one() {
    assert_eq!(value(&graph(""), "area", &[]), Value::Int(256));
    // What reads it, there too, reads the new one.
    let replaced = graph("    values: { \"edge\": Int(\"3 * size\") },");
    assert_eq!(
        [value(&replaced, "edge", &[]), value(&replaced, "area", &[])],
        [Value::Int(24), Value::Int(576)]
    );
    // Twice in one file is a mistake still.
    assert_snapshot!(mistakes("    values: { \"edge\": Int(1), \"edge\": Int(2) },"), @r#"
    passes/graph.ron:3:31: error: 'edge' stands twice
        |     values: { "edge": Int(1), "edge": Int(2) },
    "#);
}

/// The signature of the voxels of a shipped graph with these settings, and with files of its shaders edited first.
fn voxel_signature(home: &Workspace, graph: &Graph, settings: &[(&str, &str)]) -> Value {
    let mut params = graph.params.clone();
    settings
        .iter()
        .for_each(|(name, value)| params.set(name, value).unwrap());
    let set = Evaluated::new(
        graph,
        &params,
        environment(&scene("cornell"), (64, 48), &any_device()),
    );
    let linked = home.linked(graph, &params).unwrap();
    let plan = plan(&set, &linked, &["display".into()], &any_device()).unwrap();
    let index = graph
        .values
        .iter()
        .position(|v| v.name == "voxel_signature")
        .unwrap();
    signed(&set, &linked, &plan)[index].clone()
}

/// Voxels that scroll are reused where the signature is the same: settings that voxels depend on change it, those of cones,
/// pictures and the position of the volume do not.
#[test]
fn a_signature_differs_where_its_stage_reads_other_settings() {
    let home = common::home();
    let workspace = Workspace::with(home.path().to_path_buf(), Some(common::cache()));
    let graph = workspace.load("warps.ron").unwrap().graph;
    let base = [
        ("volume_scroll", "true"),
        ("warp", "spline"),
        ("voxelizer", "raster"),
        ("conservative", "msaa"),
    ];
    let with = |settings: &[(&str, &str)]| {
        voxel_signature(&workspace, &graph, &[&base[..], settings].concat())
    };
    let signature = with(&[]);
    assert!(
        matches!(signature, Value::Int(1..=0x7fff_ffff)),
        "{signature:?}"
    );
    assert_eq!(with(&[]), signature);
    let mut found = BTreeSet::from([signature.to_string()]);
    for (name, value) in [
        ("voxel_dim", "64"),
        ("voxel_capacity", "1400000"),
        ("voxelizer", "compute"),
        ("voxelizer", "tessellated"),
        ("conservative", "dilate"),
        ("conservative", "off"),
        ("warp", "logistic"),
        ("warp_alpha", "0.5"),
        ("warp_viewport", "grid"),
        ("cascades", "2"),
        ("shading_model", "cook_torrance"),
    ] {
        assert!(
            found.insert(with(&[(name, value)]).to_string()),
            "{name}={value} has the signature of another setting"
        );
    }
    for (name, value) in [
        ("volume_offset", "(1, 2, 3)"),
        ("cone_count", "3"),
        ("diffuse_steps", "20"),
        ("exposure", "2"),
        ("shadow_dim", "512"),
        ("bounces", "one"),
    ] {
        assert_eq!(with(&[(name, value)]), signature, "{name}={value}");
    }
    // An edit of a shader is another setting.
    edit(
        home.path(),
        Path::new("shaders/voxels/merge.comp"),
        |text| text.replacen("void main() {", "void main() {\n    memoryBarrier();", 1),
    );
    assert_ne!(with(&[]), signature);
}

#[test]
fn a_signature_is_of_a_stage_that_is_there_and_is_read_by_shaders_only() {
    assert_snapshot!(mistakes("    values: { \"made\": Signature(\"fil\") },"), @r#"
    passes/graph.ron:3:33: error: value 'made': no pass belongs to a stage 'fil'
        |     values: { "made": Signature("fil") },
        = help: did you mean 'fill'?
    "#);
    assert_snapshot!(mistakes("    values: { \"made\": Signature(\"fill\"), \"twice\": Int(\"2 * made\") },"), @r#"
    passes/graph.ron:3:55: error: '2 * made': 'made' is a signature, which only shaders can read
        |     values: { "made": Signature("fill"), "twice": Int("2 * made") },
    "#);
}
