//! What is kept: experiments that are written, captures and their replay, camera paths; also when the program is killed.

mod common;

use common::{conelab, device, fails, lab, root, scene, succeeds};
use conelab::camera_path::{self, CameraPath, Key};
use conelab::diagnostics::{At, Loc};
use conelab::experiment::{CameraChoice, Experiment, PlacedCamera, checked_name, write};
use conelab::graph::load::Folders;
use conelab::graph::param::{Kind, Params};
use conelab::lab::load;
use conelab::results::capture;
use conelab::scene::LightFields;
use conelab::workbench::desired::request::{RenderRequest, SideRequest};
use glam::{Mat4, Vec3};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A project with one small graph, which has a parameter of every kind.
struct Project(TempDir);

const GRAPH: &str = r#"(
    params: [
        Bool(name: "on", default: true, help: "On."),
        Int(name: "count", default: 3, range: (0, 1000), help: "Count."),
        Float(name: "level", default: 0.5, range: (0.0, 1.0), help: "Level."),
        Vec2(name: "pair", default: (0, 1), help: "Two."),
        Vec4(name: "four", default: (0, 1, 2, 3), help: "Four."),
        Colour(name: "tint", default: (1, 1, 1), help: "Tint."),
        Choice(name: "mode", options: ["plain", "odd"], help: "Mode."),
    ],
    textures: { "image": (size: ("width", "height"), format: "rgba8"), "light": (size: ("width", "height"), format: "rgba32f") },
    output: "image",
    hdr: "light",
    passes: [(name: "fill", shaders: ["fill.comp"], dispatch: Cover("image"))],
)"#;

const FILL: &str = "#version 460
#extension GL_GOOGLE_include_directive : require
#include \"params.glsl\"
#include \"scene.glsl\"
#include \"wave.glsl\"
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba8) uniform writeonly image2D image;
layout(rgba32f) uniform writeonly image2D light;
void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    vec3 c = wave(vec2(p)) * params.tint * (params.on ? params.level : 1.0) + scene.sky * 0.01;
    c += 0.001 * vec3(params.pair, params.four.x + float(params.count) + float(params.mode));
    imageStore(image, p, vec4(c, 1.0));
    imageStore(light, p, vec4(c * 4.0 + camera.position * 0.1 + camera.time, 1.0));
}";

const WAVE: &str = "vec3 wave(vec2 p) { return 0.5 + 0.5 * sin(p.xyx * 0.3); }\n";

impl Project {
    fn new() -> Project {
        let project = Project(tempfile::tempdir().unwrap());
        project.write("passes/graph.ron", GRAPH);
        project.write(
            "shaders/fill.comp",
            &FILL.replace("scene.sky", "sceneInfo.sky"),
        );
        project.write("shaders/wave.glsl", WAVE);
        let include = std::fs::read_to_string(root().join("shaders/common/scene.glsl")).unwrap();
        project.write("shaders/scene.glsl", &include);
        project.write(
            "configs/run.ron",
            "(graph: \"graph.ron\", scene: \"furnace\", size: (64, 64))",
        );
        project
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) -> PathBuf {
        std::fs::create_dir_all(self.path(name).parent().unwrap()).unwrap();
        std::fs::write(self.path(name), text).unwrap();
        self.path(name)
    }

    fn text(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    #[track_caller]
    fn edit(&self, name: &str, old: &str, new: &str) {
        let text = self.text(name);
        assert_eq!(
            text.matches(old).count(),
            1,
            "'{old}' stands once in {name}"
        );
        self.write(name, &text.replace(old, new));
    }

    fn defaults(&self) -> Params {
        let folders = Folders {
            passes: self.path("passes"),
            shaders: self.path("shaders"),
        };
        load(&self.path("passes/graph.ron"), &folders)
            .unwrap()
            .params
    }

    fn experiment(&self) -> Experiment {
        Experiment::read(&self.path("configs/run.ron")).unwrap()
    }

    fn command(&self, args: &[&str]) -> Command {
        let mut command = conelab(self.0.path());
        command.args(args);
        command
    }

    /// Names in a folder, hidden ones too.
    fn names(&self, folder: &str) -> Vec<String> {
        let entries = std::fs::read_dir(self.path(folder)).unwrap();
        let mut names: Vec<String> = entries
            .map(|e| e.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    /// A command's text without the name of the project.
    fn tidy(&self, text: &str) -> String {
        text.replace(&format!("{}/", self.0.path().display()), "")
    }
}

fn named(name: &str) -> Loc<String> {
    Loc {
        value: name.into(),
        at: At::default(),
    }
}

fn set(experiment: &mut Experiment, name: &str, value: &str) {
    experiment.params.push((named(name), value.into()));
}

// Experiments.

#[test]
fn a_side_of_the_window_keeps_what_an_experiment_sets() {
    let project = Project::new();
    let (defaults, mut experiment) = (project.defaults(), project.experiment());
    for (name, value) in [
        ("on", "false"),
        ("count", "7"),
        ("level", "1"),
        ("pair", "(2, 3)"),
        ("four", "(1, 2, 3, 4.5)"),
        ("tint", "(1, 0.5, 0)"),
        ("mode", "odd"),
        ("off", "[\"fill\"]"),
    ] {
        set(&mut experiment, name, value);
    }
    let mut params = defaults.clone();
    assert!(SideRequest::of(&experiment).apply(&mut params));
    let wanted = experiment.params_over(&defaults).unwrap();
    assert_eq!((params.values, params.off), (wanted.values, wanted.off));
    // The graph may be read again later, with a place for these.
    for (name, value) in [("later", "[1, 2]"), ("level", "bright"), ("off", "fill")] {
        set(&mut experiment, name, value);
    }
    let side = SideRequest::of(&experiment);
    assert!(!side.apply(&mut defaults.clone()));
    let again = RenderRequest::default().experiment(&side);
    assert_eq!(SideRequest::of(&again), side);
    let why = again.params_over(&defaults).unwrap_err().to_string();
    for part in [
        "no parameter 'later'",
        "'level': expected a number",
        "'off': expected a list of passes",
    ] {
        assert!(why.contains(part), "{why}");
    }
}

/// Any values of the graph's parameters, each at its default or not.
fn values(params: &Params) -> impl Strategy<Value = Vec<Option<String>>> + use<> {
    let one = params.list.iter().map(|p| {
        let low_high = p.range.unwrap_or((-1e6, 1e6));
        let number = low_high.0..=low_high.1;
        let vector = |n| {
            prop::collection::vec(number.clone(), n)
                .prop_map(|v| format!("{v:?}").replace('[', "(").replace(']', ")"))
        };
        let text = match &p.kind {
            Kind::Bool => any::<bool>().prop_map(|v| v.to_string()).boxed(),
            Kind::Int => (low_high.0 as i64..=low_high.1 as i64)
                .prop_map(|v| v.to_string())
                .boxed(),
            Kind::Float => number.prop_map(|v| format!("{v:?}")).boxed(),
            Kind::Vector(n) => vector(*n).boxed(),
            Kind::Colour => vector(3).boxed(),
            Kind::Choice(options) => prop::sample::select(options.clone()).boxed(),
        };
        prop::option::of(text)
    });
    one.collect::<Vec<_>>()
}

/// Camera, sky and light, given or not, and the time.
type Extras = (
    Option<PlacedCamera>,
    Option<(f32, f32, f32)>,
    Option<LightFields>,
    f64,
);

fn extras() -> impl Strategy<Value = Extras> {
    let vector = || (-1e4f32..1e4, -1e4f32..1e4, -1e4f32..1e4);
    let colour = || (0f32..1e4, 0f32..1e4, 0f32..1e4);
    let camera =
        (vector(), vector(), vector(), 1f32..170.0).prop_map(|(eye, target, up, fov_y)| {
            PlacedCamera {
                up,
                ..PlacedCamera::new(eye, target, fov_y)
            }
        });
    let light =
        (prop::option::of(colour()), prop::option::of(0f64..80.0)).prop_map(|(color, inner)| {
            let color = color.map(|c| format!("color: {c:?}"));
            let inner = inner.map(|i| format!("inner: {i:?}"));
            let fields: Vec<String> = [color, inner].into_iter().flatten().collect();
            ron::from_str(&format!("({})", fields.join(", "))).unwrap()
        });
    (
        prop::option::of(camera),
        prop::option::of(colour()),
        prop::option::of(light),
        prop::sample::select(vec![0.0, 1.5]),
    )
}

#[test]
fn experiments_that_are_written_are_read_as_they_were() {
    let project = Project::new();
    let defaults = project.defaults();
    let target = project.path("configs/written.ron");
    let mut runner = TestRunner::new(Config {
        cases: 200,
        failure_persistence: None,
        ..Config::default()
    });
    let case = (values(&defaults), extras());
    runner
        .run(&case, |(values, (camera, sky, light, time))| {
            let mut experiment = project.experiment();
            for (param, value) in defaults.list.iter().zip(&values) {
                if let Some(value) = value {
                    set(&mut experiment, &param.name, value);
                }
            }
            if let Some(camera) = camera {
                experiment.camera = CameraChoice::Placed(camera);
            }
            (experiment.sky, experiment.time) = (sky, time);
            experiment
                .lights
                .extend(light.clone().map(|l| (named("a \"lamp\" \\ of\n mine"), l)));
            // The file of the case before is there: this is an edit of it, with whatever it held.
            write(&experiment, &defaults, &target, true).unwrap();
            let found = Experiment::read(&target).unwrap();
            let wanted = experiment.params_over(&defaults).unwrap();
            prop_assert_eq!(
                &found.params_over(&defaults).unwrap().values,
                &wanted.values
            );
            prop_assert_eq!(
                (&found.camera, found.sky, found.time),
                (&experiment.camera, sky, time)
            );
            prop_assert_eq!(found.lights.first().map(|l| l.1.clone()), light);
            prop_assert_eq!(
                (&found.graph, &found.scene, found.size),
                (&experiment.graph, &experiment.scene, (64, 64))
            );
            // A file of its own holds what differs, and no more.
            let other = project.path("configs/other.ron");
            let _ = std::fs::remove_file(&other);
            write(&experiment, &defaults, &other, false).unwrap();
            let differing = wanted
                .values
                .iter()
                .zip(&defaults.values)
                .filter(|(a, b)| a != b)
                .count();
            prop_assert_eq!(Experiment::read(&other).unwrap().params.len(), differing);
            Ok(())
        })
        .unwrap();
    assert_eq!(
        project.names("configs"),
        ["other.ron", "run.ron", "written.ron"]
    );
}

#[test]
fn an_edit_keeps_the_comments() {
    let project = Project::new();
    let defaults = project.defaults();
    let old = r#"// What this is about: (not "a": field).
(
    graph: "graph.ron", /* which (graph) */ scene: "furnace",
    size: (64, 64), // small
    time: 2.0, // late
    params: {
        // The first.
        "level": 0.25, // a quarter
        "count": 3, // the default, said aloud
        "on": false, // goes
        // The last.
        "mode": "odd"
    },
)
// The end.
"#;
    let path = project.write("configs/mine.ron", old);
    let mut experiment = Experiment::read(&path).unwrap();
    for (name, value) in [("level", "0.75"), ("on", "true"), ("pair", "(1, 2)")] {
        set(&mut experiment, name, value);
    }
    (experiment.time, experiment.sky) = (0.0, Some((0.5, 0.0, 1.0)));
    write(&experiment, &defaults, &path, true).unwrap();
    let new = r#"// What this is about: (not "a": field).
(
    graph: "graph.ron", /* which (graph) */ scene: "furnace",
    size: (64, 64), // small
    time: 0.0, // late
    params: {
        // The first.
        "level": 0.75, // a quarter
        "count": 3, // the default, said aloud
        // The last.
        "mode": "odd",
        "pair": (1.0, 2.0),
    },
    sky: (0.5, 0.0, 1.0),
)
// The end.
"#;
    assert_eq!(project.text("configs/mine.ron"), new);
    // Nothing to change, nothing changed.
    write(&Experiment::read(&path).unwrap(), &defaults, &path, true).unwrap();
    assert_eq!(project.text("configs/mine.ron"), new);
    // Settings of the method keep every line.
    let fine = "(\n    graph: \"rays.ron\", // plain\n    scene: \"atrium\",\n    params: {\n        // Fine.\n        \"voxel_dim\": 256,\n    },\n)\n";
    let copy = project.write("configs/fine.ron", fine);
    let folders = Folders {
        passes: root().join("passes"),
        shaders: root().join("shaders"),
    };
    let vct = load(&root().join("passes/rays.ron"), &folders)
        .unwrap()
        .params;
    let mut experiment = Experiment::read(&copy).unwrap();
    set(&mut experiment, "voxel_dim", "64");
    write(&experiment, &vct, &copy, true).unwrap();
    assert_eq!(
        project.text("configs/fine.ron"),
        fine.replace("\"voxel_dim\": 256", "\"voxel_dim\": 64")
    );
}

#[test]
fn saving_replaces_nothing_unasked_and_leaves_out_defaults() {
    let project = Project::new();
    let save = |more: &[&str]| {
        let mut command = project.command(&["save", "configs/run.ron", "--name", "my run"]);
        command.args(more);
        command
    };
    let said = succeeds(&mut save(&[
        "--set",
        "level=0.25",
        "--set",
        "count=3",
        "--time",
        "1",
    ]));
    assert_eq!(said, "wrote configs/my-run.ron\n");
    let text = "(\n    graph: \"graph.ron\",\n    scene: \"furnace\",\n    camera: \"default\",\n    size: (64, 64),\n    \
                time: 1.0,\n    params: {\n        \"level\": 0.25,\n    },\n)\n";
    assert_eq!(project.text("configs/my-run.ron"), text);
    let refused = "error: 'configs/my-run.ron' exists: choose another name, or ask for it to be overwritten\n";
    assert_eq!(project.tidy(&fails(&mut save(&[]))), refused);
    assert_eq!(project.text("configs/my-run.ron"), text);
    succeeds(&mut save(&["--overwrite", "--set", "level=0.125"]));
    assert!(
        project
            .text("configs/my-run.ron")
            .contains("\"level\": 0.125,")
    );
    let said = fails(&mut save(&["--overwrite", "--set", "levle=1"]));
    assert!(
        said.contains("no parameter 'levle' (did you mean 'level'?)"),
        "{said}"
    );
    for name in [
        "",
        "a/b",
        "..",
        ".hidden",
        "a\0",
        "ä\u{202e}b",
        &"x".repeat(65),
    ] {
        assert!(checked_name(name).is_err(), "{name:?}");
    }
    assert_eq!(checked_name(" größer 2_b-c ").unwrap(), "größer-2_b-c");
    assert_eq!(project.names("configs"), ["my-run.ron", "run.ron"]);
}

#[test]
fn a_scene_of_the_project_is_named_from_the_experiment() {
    let project = Project::new();
    let file = project.write(
        "configs/scenes/box.ron",
        "(models: [(builtin: \"furnace\")])",
    );
    let mut experiment = project.experiment();
    experiment.scene = file.to_str().unwrap().into();
    let path = project.path("configs/deep/er.ron");
    write(&experiment, &project.defaults(), &path, false).unwrap();
    assert!(
        project
            .text("configs/deep/er.ron")
            .contains("scene: \"../scenes/box.ron\"")
    );
    let found = Experiment::read(&path).unwrap();
    assert_eq!(
        Path::new(&found.scene).canonicalize().unwrap(),
        file.canonicalize().unwrap()
    );
}

#[test]
fn an_experiment_adds_removes_and_switches_lights() {
    let project = Project::new();
    let read = |lights: &str| {
        let text = format!("(graph: \"graph.ron\", scene: \"cornell\", lights: {{ {lights} }})");
        Experiment::read(&project.write("configs/lit.ron", &text))
    };
    let lit = |lights: &str, times: usize| {
        let mut lit = (*scene("cornell")).clone();
        (0..times).for_each(|_| read(lights).unwrap().adapt_scene(&mut lit).unwrap());
        lit.lights
    };
    let lamp = scene("cornell").lights[0].clone();

    let added = "\"spot 1\": (add: \"Spot\", color: (1, 2, 3), inner: 10, shadow: false)";
    let lights = lit(added, 1);
    assert_eq!((lights.len(), &lights[0]), (2, &lamp));
    assert_eq!(
        (lights[1].name.as_str(), lights[1].shadow),
        ("spot 1", false)
    );
    assert_eq!(lights[1].color, Vec3::new(1.0, 2.0, 3.0));
    assert_eq!(lit(added, 2), lights, "twice is the same as once");

    let off = lit("\"lamp\": (on: false)", 1);
    assert!(!off[0].on && off[0].color == lamp.color);
    let others = lit(&format!("\"lamp\": (remove: true), {added}"), 2);
    assert_eq!(others, lights[1..]);

    let message = |lights: &str| {
        let list = read(lights).unwrap_err();
        list.iter().map(|d| d.message.clone()).collect::<String>()
    };
    assert!(message("\"a\": (add: \"Bulb\")").contains("Bulb"));
    let both = message("\"lamp\": (remove: true, on: false)");
    assert!(both.contains("a removed light has no fields"), "{both}");
}

#[test]
fn an_experiment_changes_the_light_of_its_scene() {
    let project = Project::new();
    let read = |text: &str| {
        let text = format!("(\n    graph: \"graph.ron\", scene: \"cornell\",\n{text})");
        Experiment::read(&project.write("configs/lit.ron", &text))
    };
    let lamp = |change: &str| read(&format!("    lights: {{ \"lamp\": ({change}) }},\n"));
    let mut box_scene = (*scene("cornell")).clone();
    let before = box_scene.clone();
    let experiment = lamp("color: (1, 2, 3), direction: (0, -2, 0), outer: 45").unwrap();
    experiment.adapt_scene(&mut box_scene).unwrap();
    let light = &box_scene.lights[0];
    assert_eq!(
        (light.color, light.direction),
        (Vec3::new(1.0, 2.0, 3.0), Vec3::NEG_Y)
    );
    assert_eq!(light.position, before.lights[0].position);
    assert!(
        matches!(light.kind, conelab::scene::LightKind::Spot { outer, .. } if outer == 45f32.to_radians())
    );
    read("    sky: (1, 2, 3),\n")
        .unwrap()
        .adapt_scene(&mut box_scene)
        .unwrap();
    assert_eq!(box_scene.sky, Vec3::new(1.0, 2.0, 3.0));

    let message = |found: Result<Experiment, Vec<conelab::diagnostics::Diagnostic>>| match found {
        Err(list) => project.tidy(
            &list
                .iter()
                .map(ToString::to_string)
                .collect::<Vec<_>>()
                .join("\n"),
        ),
        Ok(e) => project.tidy(&e.adapt_scene(&mut before.clone()).unwrap_err().to_string()),
    };
    let first = |text: String| text.lines().next().unwrap().to_string();
    let light = |change| first(message(lamp(change)));
    let place = "configs/lit.ron:3:";
    assert_eq!(
        light("color: (1, -2, 3)"),
        format!("{place}23: error: light 'lamp': its color must be finite and not negative")
    );
    assert_eq!(
        light("direction: (0, 0, 0)"),
        format!("{place}23: error: light 'lamp': its direction must be finite and not zero")
    );
    assert_eq!(
        light("position: (inf, 0, 0)"),
        format!("{place}23: error: light 'lamp': its position must be within 1e9 m of the origin")
    );
    assert_eq!(
        light("outer: 90"),
        format!("{place}23: error: light 'lamp': its outer must be 0.001 to 89 deg")
    );
    assert_eq!(
        light("radius: 1"),
        format!("{place}15: error: light 'lamp' is a spot light, which has no `radius`")
    );
    assert_eq!(
        light("inner: 80"),
        format!(
            "{place}15: error: light 'lamp' needs an inner angle that is less than its outer one"
        )
    );
    assert_eq!(
        light("colour: (1, 1, 1)"),
        format!("{place}24: error: unknown field 'colour'")
    );
    assert_eq!(
        first(message(read("    sky: (0, NaN, 0),\n"))),
        format!("{place}10: error: the sky's radiance must be finite and not negative")
    );
    assert_eq!(
        first(message(read("    time: inf,\n"))),
        format!("{place}11: error: the time must be a finite number of seconds")
    );
    let unknown = message(read("    lights: { \"lmap\": () },\n"));
    assert!(
        unknown.starts_with(&format!(
            "{place}15: error: scene 'cornell' has no light 'lmap'"
        )),
        "{unknown}"
    );
    assert!(
        unknown.ends_with("= help: did you mean 'lamp'?"),
        "{unknown}"
    );
}

// Captures.

#[test]
fn a_capture_is_replayed_texel_by_texel() {
    let project = Project::new();
    let said = succeeds(&mut project.command(&[
        "capture",
        "configs/run.ron",
        "--name",
        "one",
        "--set",
        "tint=(1, 0.5, 0.25)",
        "--frames",
        "3",
        "--step",
        "0.1",
        "--resource",
        "light",
    ]));
    assert_eq!(said, "wrote captures/one\n");
    let here = project.path("captures/one");
    let manifest = capture::Manifest::read(&here).unwrap();
    let files: Vec<&str> = manifest.files.keys().map(String::as_str).collect();
    let expected = [
        "experiment.ron",
        "graph/passes/graph.ron",
        "graph/shaders/fill.comp",
        "graph/shaders/scene.glsl",
        "graph/shaders/wave.glsl",
        "picture.exr",
        "picture.png",
        "resources/light.exr",
        "stats.json",
    ];
    assert_eq!(files, expected);
    assert_eq!(project.text("captures/one/graph/shaders/wave.glsl"), WAVE);
    assert_eq!(
        (manifest.frames, manifest.step, manifest.size),
        (3, 0.1, [64, 64])
    );
    assert_eq!(
        (manifest.scene.spec.as_str(), manifest.scene.sha256.len()),
        ("furnace", 64)
    );
    let when = manifest.when.as_bytes();
    assert!(
        when.len() == 20 && when[10] == b'T' && when[19] == b'Z',
        "{}",
        manifest.when
    );
    let resolved = Experiment::read(&here.join("experiment.ron")).unwrap();
    assert_eq!(
        resolved.params.len(),
        project.defaults().list.len(),
        "every parameter is written out"
    );
    assert!(matches!(resolved.camera, CameraChoice::Placed(_)) && resolved.sky.is_some());
    let stats: serde_json::Value =
        serde_json::from_str(&project.text("captures/one/stats.json")).unwrap();
    assert_eq!(
        (&stats["schema"], &stats["experiment"]),
        (&"conelab-stats-1".into(), &"run".into())
    );

    // The project does not matter any more, nor where the capture is.
    project.edit("shaders/wave.glsl", "0.3", "0.7");
    project.edit("passes/graph.ron", "default: 0.5", "default: 0.25");
    let elsewhere = tempfile::tempdir().unwrap();
    std::fs::rename(&here, elsewhere.path().join("moved")).unwrap();
    let replay = |args: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_conelab"));
        command
            .env("CONELAB_CACHE", common::cache())
            .current_dir(elsewhere.path());
        command
            .env("CONELAB_DEVICE", device())
            .env("CONELAB_VALIDATION", "true")
            .args(["replay", "moved"])
            .args(args);
        command
    };
    assert_eq!(
        succeeds(&mut replay(&["-o", "again"])),
        "wrote 3 images to again\nidentical: 3 images, 12288 texels\n"
    );
    let picture = |name: &str| std::fs::read(elsewhere.path().join(name)).unwrap();
    assert_eq!(picture("again/picture.png"), picture("moved/picture.png"));

    // A shader that was changed is named, and what it did is counted.
    let shader = elsewhere.path().join("moved/graph/shaders/wave.glsl");
    std::fs::write(&shader, WAVE.replace("0.3", "0.4")).unwrap();
    std::fs::write(elsewhere.path().join("moved/graph/shaders/extra.glsl"), "").unwrap();
    let output = replay(&[]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8(output.stdout).unwrap();
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(
        lines[0],
        "graph/shaders/wave.glsl has changed since the capture"
    );
    assert_eq!(
        lines[1],
        "graph/shaders/extra.glsl has been added since the capture"
    );
    assert!(
        lines[2].starts_with("picture.png: ")
            && lines[2].contains(" of 4096 texels differ, by at most "),
        "{said}"
    );
    assert_eq!(lines.len(), 5, "{said}");
    assert_eq!(
        String::from_utf8(output.stderr).unwrap(),
        "error: 3 of 3 images differ\n"
    );
    std::fs::write(&shader, WAVE).unwrap();

    // So is another device, and a picture that is no more.
    let bytes = picture("moved/capture.json");
    let text = String::from_utf8(bytes)
        .unwrap()
        .replace(&manifest.device, "Voodoo");
    std::fs::write(elsewhere.path().join("moved/capture.json"), text).unwrap();
    std::fs::write(elsewhere.path().join("moved/picture.exr"), "gone").unwrap();
    let output = replay(&[]).output().unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(
        said.contains("device: was Voodoo") && said.contains("'moved/picture.exr': "),
        "{said}"
    );
    assert_eq!(
        String::from_utf8(output.stderr).unwrap(),
        "error: 1 of 3 images differ\n"
    );
}

#[test]
fn the_method_is_captured_and_replayed() {
    let folder = tempfile::tempdir().unwrap();
    let lab = lab(root());
    let mut experiment = common::experiment(
        "cornell",
        (48, 32),
        &[
            ("voxel_dim", "32"),
            ("shadow_dim", "256"),
            ("cone_count", "5"),
        ],
    );
    experiment
        .lights
        .push((named("lamp"), ron::from_str("(color: (9, 8, 7))").unwrap()));
    let what = capture::What {
        resources: vec![capture::Resource {
            name: "voxelRadiance".into(),
            mip: 1,
            layer: 0,
        }],
        ..capture::What::default()
    };
    let path = capture::take(
        &lab,
        &experiment,
        scene("cornell"),
        &what,
        folder.path(),
        "box",
    )
    .unwrap();
    let message = capture::take(
        &lab,
        &experiment,
        scene("cornell"),
        &what,
        folder.path(),
        "box",
    )
    .unwrap_err()
    .to_string();
    assert!(
        message.ends_with("box': there is a capture of that name; choose another"),
        "{message}"
    );
    assert_eq!(capture::free_name(folder.path(), "box"), "box-2");
    let none = capture::What {
        frames: Some(0),
        ..capture::What::default()
    };
    let message = capture::take(
        &lab,
        &experiment,
        scene("cornell"),
        &none,
        folder.path(),
        "none",
    )
    .unwrap_err()
    .to_string();
    assert_eq!(message, "frames must be 1 to 1000000, and the step finite");
    let manifest = capture::Manifest::read(&path).unwrap();
    let open = |name: &str| Ok((*scene(name)).clone());
    let result = capture::replay(&lab, &path, &manifest, open, None).unwrap();
    assert_eq!(
        (result.images, &result.differences, &result.changes),
        (3, &vec![], &vec![])
    );
    assert!(capture::changes(&path, &manifest).is_empty());
    // The picture is the one that `render` makes of the named camera.
    let mut session = common::prepare(&lab, &experiment_lit(&experiment), &["display"]);
    session.frame(0.0).unwrap();
    let texels = session.texels("display", 0, 0).unwrap();
    let unlit = conelab::results::picture::rgb8(&texels);
    let kept = conelab::results::picture::read(&path.join("picture.png"), (48, 32)).unwrap();
    assert_ne!(
        unlit.iter().map(|v| f32::from(*v)).collect::<Vec<_>>(),
        kept,
        "the lamp was changed"
    );
    drop(session);
    let lit = experiment.adapted(scene("cornell")).unwrap();
    let (mut session, _) = lab
        .prepare(&experiment, lit, |_| Ok(vec!["display".into()]))
        .unwrap();
    assert!(manifest.frames > 8, "its light has settled");
    (0..manifest.frames).for_each(|_| _ = session.frame(0.0).unwrap());
    let lit = conelab::results::picture::rgb8(&session.texels("display", 0, 0).unwrap());
    assert_eq!(lit.iter().map(|v| f32::from(*v)).collect::<Vec<_>>(), kept);
    drop(session);
    // Another scene is another hash.
    let other = |_: &str| {
        let mut other = (*scene("cornell")).clone();
        other.materials[0].roughness *= 0.5;
        Ok(other)
    };
    let changes = capture::replay(&lab, &path, &manifest, other, None)
        .unwrap()
        .changes;
    assert!(
        changes.len() == 1 && changes[0].starts_with("scene: was "),
        "{changes:?}"
    );
    common::assert_clean(&lab);
}

/// The experiment without its changes to the light.
fn experiment_lit(experiment: &Experiment) -> Experiment {
    Experiment {
        lights: Vec::new(),
        ..experiment.clone()
    }
}

#[test]
fn damaged_captures_are_told_and_listed() {
    let project = Project::new();
    succeeds(&mut project.command(&["capture", "configs/run.ron"]));
    succeeds(&mut project.command(&["capture", "configs/run.ron"]));
    assert_eq!(project.names("captures"), ["run", "run-2"]);
    project.write("captures/tour/picture.txt", "no capture");
    project.write("captures/.x.partial-4294967295-a/experiment.ron", "");
    let folder = project.path("captures");
    let list = capture::list(&folder);
    assert_eq!(
        list.iter().map(|s| s.name.as_str()).collect::<Vec<_>>(),
        ["run", "run-2"]
    );
    assert!(
        list.iter()
            .all(|s| s.manifest.is_ok() && s.picture.is_some())
    );

    let whole = project.text("captures/run/capture.json");
    let outside = project.write("secret.png", "outside");
    let broken = |text: &str| {
        project.write("captures/run/capture.json", text);
        let message = project.tidy(&fails(&mut project.command(&["replay", "captures/run"])));
        let list = capture::list(&folder);
        assert_eq!(list.len(), 2);
        let listed = list[0].manifest.as_ref().unwrap_err();
        assert!(
            message.contains(project.tidy(listed).as_str()),
            "{message} is not {listed}"
        );
        message
    };
    for cut in [0, 1, whole.len() / 2, whole.len() - 3] {
        assert!(
            broken(&whole[..cut])
                .starts_with("error: 'captures/run/capture.json': it is damaged: "),
            "{cut}"
        );
    }
    assert!(
        broken(&whole.replace("capture-1", "capture-9"))
            .contains("its schema is 'conelab-capture-9'")
    );
    assert!(
        broken(&whole.replace("\"frames\": 1", "\"frames\": 99999999999"))
            .contains("frames must be 1 to 1000000")
    );
    assert!(
        broken(&whole.replace("\"picture.png\"", "\"../../secret.png\""))
            .contains("leads out of the capture")
    );
    let absolute = format!("\"{}\"", outside.display());
    assert!(
        broken(&whole.replace("\"picture.png\"", &absolute)).contains("leads out of the capture")
    );
    std::fs::remove_file(project.path("captures/run/picture.png")).unwrap();
    std::os::unix::fs::symlink(&outside, project.path("captures/run/picture.png")).unwrap();
    assert!(broken(&whole).contains("leads out of the capture"));
    std::fs::remove_file(project.path("captures/run/picture.png")).unwrap();
    project.write("captures/run/capture.json", &whole);
    assert!(
        capture::list(&folder)[0]
            .manifest
            .as_ref()
            .unwrap_err()
            .ends_with("the file 'picture.png' is missing")
    );
    // A texture that the graph does not have.
    project.write(
        "captures/run-2/capture.json",
        &whole.replace("\"texture\": \"image\"", "\"texture\": \"imago\""),
    );
    let message = fails(&mut project.command(&["replay", "captures/run-2"]));
    assert!(
        message.contains("no texture 'imago' (did you mean 'image'?)"),
        "{message}"
    );
    project.write(
        "captures/run-2/experiment.ron",
        "(graph: \"../../../passes/graph.ron\", scene: \"furnace\")",
    );
    let message = fails(&mut project.command(&["replay", "captures/run-2"]));
    assert!(
        message.contains("its graph must be a bare file name"),
        "{message}"
    );
    let message = project.tidy(&fails(&mut project.command(&[
        "capture",
        "configs/run.ron",
        "--name",
        "a/b",
    ])));
    assert!(
        message.contains("'a/b' cannot be a name: '/' is not allowed"),
        "{message}"
    );
    let message = project.tidy(&fails(&mut project.command(&[
        "capture",
        "configs/run.ron",
        "--resource",
        "lihgt",
    ])));
    assert!(
        message.contains("no texture 'lihgt' (did you mean 'light'?)"),
        "{message}"
    );
    assert_eq!(
        project.names("captures"),
        ["run", "run-2", "tour"],
        "nothing is left of what failed"
    );
}

/// Waits until something is so, or the program has ended.
fn wait_for(child: &mut Child, ready: impl Fn() -> bool) {
    while !ready() && child.try_wait().unwrap().is_none() {
        std::thread::sleep(Duration::from_micros(200));
    }
}

/// Starts a command, waits until `ready`, then a while, and kills it. Whether it was still running.
fn kill(command: &mut Command, ready: impl Fn() -> bool, wait: Duration) -> bool {
    let mut child = command
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    wait_for(&mut child, ready);
    std::thread::sleep(wait);
    let running = child.try_wait().unwrap().is_none();
    child.kill().unwrap();
    child.wait().unwrap();
    running
}

#[test]
fn a_killed_program_leaves_everything_whole() {
    const KILLS: u32 = 50;
    let project = Project::new();
    let folder = project.path("captures");
    let quick = |args: &[&str]| {
        let mut command = project.command(args);
        command.env_remove("CONELAB_VALIDATION");
        command
    };
    succeeds(&mut quick(&[
        "capture",
        "configs/run.ron",
        "--name",
        "warm",
    ]));
    let start = Instant::now();
    succeeds(&mut quick(&[
        "capture",
        "configs/run.ron",
        "--name",
        "first",
    ]));
    let mut whole = start.elapsed();
    let is_partial = |name: &String| name.contains(".partial-");
    let writes = |name: &str| {
        project
            .names("captures")
            .iter()
            .any(|n| n.starts_with(&format!(".{name}.partial-")))
    };
    let mut second = quick(&["capture", "configs/run.ron", "--name", "second"])
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    wait_for(&mut second, || writes("second"));
    let start = Instant::now();
    assert!(second.wait().unwrap().success());
    let mut writing = start.elapsed();
    let mut kept: BTreeMap<String, Vec<u8>> = BTreeMap::new();
    let (mut killed, mut halves) = (0, 0);
    for i in 0..KILLS {
        let name = format!("kill{i}");
        let mut command = quick(&["capture", "configs/run.ron", "--name", &name]);
        // Every other one is killed while it writes, the others at any time.
        let share = f64::from(i) / f64::from(KILLS) * 1.1;
        let any_time = i % 2 == 0;
        let lasts = if any_time { &mut whole } else { &mut writing };
        let running = kill(
            &mut command,
            || any_time || writes(&name),
            lasts.mul_f64(share),
        );
        killed += u32::from(running);
        if !running {
            // What was measured on a busier machine, or with the program's end in it, is too long here.
            *lasts = lasts.mul_f64(0.7);
        }
        halves += u32::from(writes(&name));
        for summary in capture::list(&folder) {
            let manifest = summary.manifest.unwrap_or_else(|e| panic!("kill {i}: {e}"));
            assert_eq!(
                capture::changes(&summary.folder, &manifest),
                [""; 0],
                "kill {i}: {}",
                summary.name
            );
            let bytes = std::fs::read(summary.folder.join("capture.json")).unwrap();
            assert!(
                *kept.entry(summary.name).or_insert(bytes.clone()) == bytes,
                "kill {i}: an earlier one changed"
            );
        }
        assert_eq!(
            capture::list(&folder).len(),
            kept.len(),
            "kill {i}: an earlier one is gone"
        );
    }
    assert!(
        killed > KILLS / 4 && halves > 0 && kept.len() > 2,
        "{killed} killed, {halves} halves, {} kept",
        kept.len()
    );
    // One that is being made is left alone.
    let mine = project.write(
        &format!("captures/.mine.partial-{}-x/f", std::process::id()),
        "",
    );
    capture::sweep_partials(&folder);
    assert_eq!(
        project
            .names("captures")
            .iter()
            .filter(|n| is_partial(n))
            .count(),
        1
    );
    std::fs::remove_dir_all(mine.parent().unwrap()).unwrap();

    let level = || {
        Experiment::read(&project.path("configs/kept.ron"))
            .unwrap()
            .params[0]
            .1
            .clone()
    };
    let save = |i: u32| {
        let value = format!("level=0.{:03}", i + 1);
        let mut command = quick(&["save", "configs/run.ron", "--name", "kept", "--overwrite"]);
        command.args(["--set", &value]);
        command
    };
    let start = Instant::now();
    succeeds(&mut save(0));
    let whole = start.elapsed();
    let run = project.text("configs/run.ron");
    let mut last = level();
    let mut killed = 0;
    for i in 1..=KILLS {
        killed += u32::from(kill(
            &mut save(i),
            || true,
            whole.mul_f64(f64::from(i) / f64::from(KILLS) * 1.1),
        ));
        let now = level();
        assert!(
            now == last || now.parse() == Ok(f64::from(i + 1) / 1000.0),
            "save {i}: {now}"
        );
        last = now;
        assert_eq!(project.text("configs/run.ron"), run);
    }
    assert!(killed > 0);
}

// Camera paths.

fn key(time: f64, eye: (f32, f32, f32)) -> Key {
    Key::new(
        time,
        &PlacedCamera::new(eye, (eye.0 + 1.0, 0.0, -3.0), 40.0 + eye.1),
    )
}

fn bent(repeat: bool) -> CameraPath {
    let keys = vec![
        key(0.0, (0.0, 1.0, 0.0)),
        key(0.5, (4.0, 2.0, 1.0)),
        key(3.0, (5.0, 9.0, -2.0)),
        key(3.1, (5.5, 1.0, -2.0)),
        key(6.0, (0.0, 1.0, 0.0)),
    ];
    CameraPath { repeat, keys }
}

#[test]
fn a_path_goes_through_its_keys_without_a_jump() {
    let eye = |path: &CameraPath, time: f64| Vec3::from(path.at(time).eye);
    for repeat in [false, true] {
        let path = bent(repeat);
        for k in &path.keys[..4] {
            let camera = path.at(k.time);
            assert_eq!(
                (camera.eye, camera.target, camera.up, camera.fov_y),
                (k.eye, k.target, k.up, k.fov_y)
            );
        }
        // The speed has no jump either: the curve bends, but nowhere breaks.
        let h = 1e-4;
        let speed = |time: f64| (eye(&path, time + h) - eye(&path, time)) / h as f32;
        for i in -100..800 {
            let time = f64::from(i) * 0.01;
            assert!(
                eye(&path, time).distance(eye(&path, time + 1e-5)) < 0.01,
                "at {time} s"
            );
        }
        for k in &path.keys[1..4] {
            assert!(
                speed(k.time - 2.0 * h).distance(speed(k.time + h)) < 2.0,
                "at {} s",
                k.time
            );
        }
    }
    let path = bent(false);
    assert_eq!((path.at(-5.0), path.at(99.0)), (path.at(0.0), path.at(6.0)));
    let round = bent(true);
    assert!(
        eye(&round, 1.0).distance(eye(&round, 13.0)) < 1e-4
            && eye(&round, -1.0).distance(eye(&round, 5.0)) < 1e-4
    );
    // Keys on a line at a steady pace: the path is the line, at that pace.
    let line = CameraPath {
        repeat: false,
        keys: (0..4)
            .map(|i| key(f64::from(i), (i as f32, 0.0, 0.0)))
            .collect(),
    };
    for i in 0..=30 {
        let time = f64::from(i) * 0.1;
        assert!((f64::from(eye(&line, time).x) - time).abs() < 1e-5);
    }
    let one = CameraPath {
        repeat: true,
        keys: vec![key(2.0, (1.0, 2.0, 3.0))],
    };
    assert_eq!(one.at(7.0).eye, (1.0, 2.0, 3.0));
}

#[test]
fn paths_are_edited_written_and_read() {
    let project = Project::new();
    let mut path = bent(false);
    assert_eq!(
        camera_path::insert(&mut path, key(1.0, (9.0, 9.0, 9.0))).unwrap(),
        2
    );
    assert_eq!(camera_path::move_key(&mut path, 2, 7.0).unwrap(), 5);
    let before = path.clone();
    assert!(
        camera_path::insert(&mut path, key(3.0, (0.0, 0.0, 0.0)))
            .unwrap_err()
            .to_string()
            .contains("a key at 3 s")
    );
    assert!(
        camera_path::move_key(&mut path, 0, 3.0).is_err()
            && camera_path::move_key(&mut path, 9, 3.0).is_err()
    );
    assert!(camera_path::move_key(&mut path, 0, f64::NAN).is_err());
    assert_eq!(path, before);
    assert_eq!(
        camera_path::remove(&mut path, 5).unwrap().eye,
        (9.0, 9.0, 9.0)
    );
    assert_eq!(
        (camera_path::remove(&mut path, 5), &path),
        (None, &bent(false))
    );

    path.keys[1].up = (0.0, 0.5, 0.5);
    let file = project.path("configs/paths/bent.ron");
    camera_path::write(&path, &file, false).unwrap();
    assert_eq!(CameraPath::read(&file).unwrap(), path);
    let message = camera_path::write(&bent(true), &file, false)
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("it exists; choose another name"),
        "{message}"
    );
    camera_path::write(&bent(true), &file, true).unwrap();
    assert_eq!(CameraPath::read(&file).unwrap(), bent(true));
    assert!(camera_path::write(&CameraPath::default(), &file, true).is_err());
    assert_eq!(CameraPath::read(&file).unwrap(), bent(true));

    let message = |keys: &str| {
        let file = project.write("configs/paths/wrong.ron", &format!("(keys: [\n{keys}\n])"));
        let list = CameraPath::read(&file).unwrap_err();
        project.tidy(
            &list
                .iter()
                .map(ToString::to_string)
                .collect::<Vec<_>>()
                .join("\n"),
        )
    };
    let key = |time: &str, more: &str| {
        format!("(time: {time}, eye: (0, 0, 1), target: (0, 0, 0){more}),")
    };
    let two = |a: &str, b: &str| {
        message(&format!(
            "{}\n{}",
            key(a, ", fov_y: 60"),
            key(b, ", fov_y: 60")
        ))
    };
    assert!(
        two("1", "1")
            .starts_with("configs/paths/wrong.ron:3:1: error: a key's time must be greater than")
    );
    assert!(
        two("1", "inf")
            .starts_with("configs/paths/wrong.ron:3:1: error: a key's numbers must be finite")
    );
    assert!(message(&key("0", "")).starts_with("configs/paths/wrong.ron:2:"));
    assert!(message(&key("0", ", fov_y: 180")).contains("fov_y must be 1 to 170 degrees"));
    assert!(message("").contains("a path has 1 to 100000 keys, this one has 0"));
}

#[test]
fn a_sequence_is_written_once_and_follows_the_path() {
    let project = Project::new();
    camera_path::write(&bent(false), &project.path("configs/paths/bent.ron"), false).unwrap();
    let sequence = |more: &[&str]| {
        let mut command = project.command(&[
            "render",
            "configs/run.ron",
            "--path",
            "configs/paths/bent.ron",
        ]);
        command.args(["--frames", "4", "--step", "0.25"]).args(more);
        command
    };
    let said = succeeds(&mut sequence(&[
        "--sequence",
        "film",
        "--resource",
        "light",
        "-o",
        "last.exr",
        "--json",
        "s.json",
    ]));
    assert!(
        said.ends_with("wrote 4 frames to film\nwrote last.exr\nwrote s.json\n"),
        "{said}"
    );
    let frames = [
        "frame-00000.png",
        "frame-00001.png",
        "frame-00002.png",
        "frame-00003.png",
    ];
    assert_eq!(project.names("film"), frames);
    let stats: serde_json::Value = serde_json::from_str(&project.text("s.json")).unwrap();
    assert_eq!(stats["passes"][0]["frames"], 4);
    // The shader puts the camera's place into the light: that of the fourth frame, at 0.75 s.
    let found = conelab::results::picture::read(&project.path("last.exr"), (64, 64)).unwrap();
    succeeds(
        project
            .command(&[
                "render",
                "configs/run.ron",
                "--resource",
                "light",
                "-o",
                "still.exr",
                "--time",
                "0.75",
                "--camera",
            ])
            .arg(still(&bent(false).at(0.75))),
    );
    let still = conelab::results::picture::read(&project.path("still.exr"), (64, 64)).unwrap();
    assert_eq!(found, still);
    let message = fails(&mut sequence(&["--sequence", "film"]));
    assert_eq!(
        message,
        "error: cannot write frames to 'film': it has 'frame-00000.png'; choose an empty folder\n"
    );
    let neither = sequence(&[]).output().unwrap();
    assert!(
        String::from_utf8_lossy(&neither.stderr).contains("--output"),
        "one of them is needed"
    );
}

fn still(camera: &PlacedCamera) -> String {
    format!(
        "(eye: {:?}, target: {:?}, up: {:?}, fov_y: {:?})",
        camera.eye, camera.target, camera.up, camera.fov_y
    )
}

/// Whether the way from `a` to `b` meets a triangle (Möller and Trumbore 1997).
fn meets(a: Vec3, b: Vec3, [p, q, r]: [Vec3; 3]) -> bool {
    let (way, e1, e2) = (b - a, q - p, r - p);
    let h = way.cross(e2);
    let det = e1.dot(h);
    if det.abs() < 1e-12 {
        return false;
    }
    let s = (a - p) / det;
    let (u, k) = (s.dot(h), s.cross(e1));
    let (v, t) = (way.dot(k), e2.dot(k));
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && (0.0..=1.0).contains(&t)
}

#[test]
fn the_walk_through_the_atrium_meets_no_wall() {
    let path = CameraPath::read(&root().join("configs/paths/atrium.ron")).unwrap();
    let atrium = scene("atrium");
    let length = path.keys.last().unwrap().time;
    let points: Vec<Vec3> = (0..=230)
        .map(|i| path.at(f64::from(i) / 230.0 * length).eye.into())
        .collect();
    let (low, high) = points
        .iter()
        .fold((Vec3::MAX, Vec3::MIN), |(l, h), p| (l.min(*p), h.max(*p)));
    let mut near = Vec::new();
    for instance in atrium.instances.iter().filter(|i| i.mover.is_none()) {
        let mesh = &atrium.meshes[instance.mesh as usize];
        let at = |i: u32| {
            (instance.transform as Mat4).transform_point3(mesh.vertices[i as usize].position.into())
        };
        for t in mesh.indices.chunks_exact(3) {
            let t = [at(t[0]), at(t[1]), at(t[2])];
            let (l, h) = (t[0].min(t[1]).min(t[2]), t[0].max(t[1]).max(t[2]));
            if l.cmple(high + 0.3).all() && h.cmpge(low - 0.3).all() {
                near.push(t);
            }
        }
    }
    for (i, pair) in points.windows(2).enumerate() {
        // Room to all sides: the near plane and half a head.
        for d in [
            Vec3::ZERO,
            Vec3::X,
            Vec3::NEG_X,
            Vec3::Y,
            Vec3::NEG_Y,
            Vec3::Z,
            Vec3::NEG_Z,
        ] {
            let to = pair[1] + 0.2 * d;
            assert!(
                !near.iter().any(|t| meets(pair[0], to, *t)),
                "step {i} from {} to {to}",
                pair[0]
            );
        }
    }
}

#[test]
fn times_are_drawn_into_a_corner_of_pictures_and_nowhere_else() {
    let home = tempfile::tempdir().unwrap();
    for folder in ["passes", "shaders"] {
        std::os::unix::fs::symlink(common::root().join(folder), home.path().join(folder)).unwrap();
    }
    let small = r#"(graph: "preview.ron", scene: "cornell", size: (320, 240))"#;
    std::fs::create_dir(home.path().join("configs")).unwrap();
    std::fs::write(home.path().join("configs/small.ron"), small).unwrap();
    let open = |name: &str| image::open(home.path().join(name)).unwrap().to_rgb8();
    let render = |name: &str, more: &[&str]| {
        succeeds(
            conelab(home.path())
                .args(["render", "configs/small.ron", "-o", name])
                .args(more),
        );
        open(name)
    };
    let plain = render("plain.png", &[]);
    let timed = render("timed.png", &["--timers", "passes"]);
    assert_eq!(plain.dimensions(), timed.dimensions());
    // A line for the device, one for the size, the total, two passes.
    let panel = |x: u32, y: u32| x < 236 && y < 5 * 15 + 12;
    let differs = plain
        .enumerate_pixels()
        .filter(|(x, y, p)| timed.get_pixel(*x, *y) != *p);
    let places: Vec<(u32, u32)> = differs.map(|(x, y, _)| (x, y)).collect();
    assert!(places.len() > 1000, "{} pixels", places.len());
    assert!(
        places.iter().all(|(x, y)| panel(*x, *y)),
        "{:?}",
        places.iter().find(|(x, y)| !panel(*x, *y))
    );

    succeeds(conelab(home.path()).args([
        "capture",
        "configs/small.ron",
        "--name",
        "kept",
        "--timers",
        "stages",
    ]));
    let kept = open("captures/kept/timers.png");
    assert_eq!(open("captures/kept/picture.png"), plain);
    assert!(kept != plain && kept.get_pixel(300, 200) == plain.get_pixel(300, 200));
    let said = succeeds(conelab(home.path()).args(["replay", "captures/kept"]));
    assert!(said.contains("identical"), "{said}");
    succeeds(
        conelab(home.path())
            .args([
                "render",
                "configs/small.ron",
                "--sequence",
                "frames",
                "--frames",
                "2",
            ])
            .args(["--timers", "stages"]),
    );
    assert!(open("frames/frame-00001.png") != plain);
}
