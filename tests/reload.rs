//! Reload: a session takes the place of another, keeps what fits, and makes the picture that a fresh one would make.

mod common;

use common::{assert_clean, experiment, floats, lab, root, scene};
use conelab::experiment::Experiment;
use conelab::graph::run::Change;
use conelab::lab::{Lab, LabError, Session};
use conelab::scene::Scene;
use std::path::Path;
use std::sync::Arc;

/// A texture that counts frames and one that is sized by a parameter.
const GRAPH: &str = r#"(
    params: [
        Int(name: "side", default: 8, range: (1, 64), help: "Edge."),
        Int(name: "step", default: 1, range: (0, 9), help: "What a frame adds."),
    ],
    textures: {
        "count": (size: (4, 4), format: "r32f", history: true),
        "sized": (size: ("side", "side"), format: "r32f"),
    },
    passes: [
        (name: "count", shaders: ["count.comp"], dispatch: Cover("count"), bind: { "last": (of: "count", history: true) }),
        (name: "fill", shaders: ["fill.comp"], dispatch: Cover("sized")),
    ],
    outputs: ["count", "sized"],
)"#;

const COUNT: &str = "#version 460
#extension GL_GOOGLE_include_directive : require
#include \"params.glsl\"
layout(local_size_x = 4, local_size_y = 4) in;
layout(r32f) uniform readonly image2D last;
layout(r32f) uniform writeonly image2D count;
void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    imageStore(count, p, imageLoad(last, p) + float(params.step));
}";

const FILL: &str = "#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(r32f) uniform writeonly image2D sized;
void main() { imageStore(sized, ivec2(gl_GlobalInvocationID.xy), vec4(1.0)); }";

fn write(folder: &Path, name: &str, text: &str) {
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, text).unwrap();
}

struct Bench {
    folder: tempfile::TempDir,
    lab: Lab,
    scene: Arc<Scene>,
}

impl Bench {
    fn new() -> Bench {
        let folder = tempfile::tempdir().unwrap();
        write(folder.path(), "passes/graph.ron", GRAPH);
        write(folder.path(), "shaders/count.comp", COUNT);
        write(folder.path(), "shaders/fill.comp", FILL);
        let lab = lab(folder.path());
        Bench {
            folder,
            lab,
            scene: scene("triangles"),
        }
    }

    fn write(&self, name: &str, text: &str) {
        write(self.folder.path(), name, text);
    }

    fn experiment(&self, params: &str) -> Experiment {
        let text = format!(
            "(graph: \"graph.ron\", scene: \"triangles\", size: (16, 16), params: {{{params}}})"
        );
        Experiment::from_text(&self.folder.path().join("run.ron"), &text).unwrap()
    }

    fn session(&self, params: &str, old: Option<&Session>) -> Result<Session, LabError> {
        let experiment = self.experiment(params);
        let loaded = self
            .lab
            .home
            .load(&experiment.graph)
            .map_err(LabError::Input)?;
        let wanted = vec!["count".into(), "sized".into()];
        self.lab.build(
            &experiment,
            &loaded,
            self.scene.clone(),
            wanted,
            old.map(Session::reusable_parts).as_ref(),
        )
    }

    fn reload(&self, params: &str, old: &mut Session) -> Session {
        let mut new = self.session(params, Some(old)).unwrap();
        new.swap_in(old).unwrap();
        new
    }
}

fn frames(session: &mut Session, count: usize) {
    session.run(count).unwrap();
    session.finish().unwrap();
}

#[test]
fn textures_that_did_not_change_keep_their_content() {
    let bench = Bench::new();
    let mut session = bench.session("", None).unwrap();
    frames(&mut session, 3);
    assert_eq!(floats(&mut session, "count", 0)[5][0], 3.0);

    // Another shader of another pass: its pipeline is made anew, nothing else. After odd and even frames alike.
    for (round, value) in [(1, "2.0"), (2, "3.0"), (3, "4.0")] {
        bench.write(
            "shaders/fill.comp",
            &FILL.replace("vec4(1.0)", &format!("vec4({value})")),
        );
        session = bench.reload("", &mut session);
        assert_eq!(
            session.program.change,
            Change {
                kept: 1,
                built: 1,
                resized: 0
            }
        );
        frames(&mut session, 1);
        assert_eq!(floats(&mut session, "count", 0)[5][0], 3.0 + round as f32);
        assert_eq!(
            floats(&mut session, "sized", 0)[0][0].to_string(),
            value.trim_end_matches(".0")
        );
    }

    // Another size: only the texture that has it is made anew.
    session = bench.reload("\"side\": 16", &mut session);
    assert_eq!(
        session.program.change,
        Change {
            kept: 2,
            built: 0,
            resized: 1
        }
    );
    frames(&mut session, 1);
    assert_eq!(floats(&mut session, "count", 0)[5][0], 7.0);
    assert_eq!(floats(&mut session, "sized", 0).len(), 256);
    assert_clean(&bench.lab);
}

#[test]
fn a_build_that_fails_leaves_the_old_session_whole() {
    let bench = Bench::new();
    let mut session = bench.session("", None).unwrap();
    frames(&mut session, 1);
    bench.write(
        "shaders/count.comp",
        &COUNT.replace("params.step", "params.stop"),
    );
    let Err(LabError::Input(found)) = bench.session("", Some(&session)) else {
        panic!("it must not build")
    };
    assert!(
        found[0].place.file.ends_with("count.comp") && found[0].place.line == 9,
        "{found:?}"
    );
    frames(&mut session, 2);
    assert_eq!(floats(&mut session, "count", 0)[5][0], 3.0);
    assert_clean(&bench.lab);
}

#[test]
fn a_parameter_that_changes_no_plan_is_a_buffer_write() {
    let bench = Bench::new();
    let mut session = bench.session("", None).unwrap();
    frames(&mut session, 1);
    let mut params = session.params.clone();
    params.set("step", "5").unwrap();
    assert!(session.set_params(&bench.lab, &params).unwrap());
    frames(&mut session, 1);
    assert_eq!(floats(&mut session, "count", 0)[5][0], 6.0);
    params.set("side", "9").unwrap();
    assert!(
        !session.set_params(&bench.lab, &params).unwrap(),
        "another size needs other textures"
    );
}

/// A third pass that is switched on, the only one that uses a parameter and a texture.
const AGAIN: &str = "#version 460
#extension GL_GOOGLE_include_directive : require
#include \"params.glsl\"
layout(local_size_x = 8, local_size_y = 8) in;
uniform sampler2D table;
layout(r32f) uniform writeonly image2D sized;
void main() { imageStore(sized, ivec2(gl_GlobalInvocationID.xy), texelFetch(table, ivec2(0), 0) + params.more); }";

#[test]
fn a_shader_is_compiled_when_its_pass_first_runs() {
    let bench = Bench::new();
    let graph = GRAPH
        .replace("    textures: {", "    textures: {\n        \"table\": (size: (4, 4), format: \"r32f\"),")
        .replace(
            "    ],\n    textures",
            "        Bool(name: \"twice\", default: false, help: \"Fills again.\"),
        Float(name: \"more\", default: 2, range: (0, 9), help: \"With what.\"),\n    ],\n    textures",
        )
        .replace(
            "    ],\n    outputs",
            "        (name: \"again\", when: \"twice\", shaders: [\"again.comp\"], dispatch: Cover(\"sized\")),\n    ],\n    outputs",
        );
    bench.write("passes/graph.ron", &graph);
    bench.write(
        "shaders/again.comp",
        &AGAIN.replace("texelFetch", "texelFetsh"),
    );

    // A check finds the mistake; a picture that does without is not kept away, nor is what only that shader uses "unused".
    let Err(found) = bench.lab.home.load("graph.ron") else {
        panic!("it must not compile")
    };
    assert!(found[0].place.file.ends_with("again.comp"), "{found:?}");
    let once = bench.experiment("");
    let loaded = bench
        .lab
        .home
        .load_for(&once, &bench.scene, &bench.lab.gpu.info)
        .unwrap();
    assert_eq!(loaded.warnings, []);
    let wanted = || vec!["count".into(), "sized".into()];
    let build = |experiment: &Experiment, reuse: Option<&Session>| {
        bench.lab.build(
            experiment,
            &loaded,
            bench.scene.clone(),
            wanted(),
            reuse.map(Session::reusable_parts).as_ref(),
        )
    };
    let mut session = build(&once, None).unwrap();
    frames(&mut session, 1);
    assert_eq!(floats(&mut session, "sized", 0)[0][0], 1.0);

    // Switched on, it is compiled, and its mistake is reported.
    let mut params = session.params.clone();
    params.set("twice", "true").unwrap();
    assert!(
        !session.set_params(&bench.lab, &params).unwrap(),
        "it needs a shader that is not there"
    );
    let twice = bench.experiment("\"twice\": true");
    let Err(LabError::Input(found)) = build(&twice, Some(&session)) else {
        panic!("it must not build")
    };
    assert!(found[0].place.file.ends_with("again.comp"), "{found:?}");
    bench.write("shaders/again.comp", AGAIN);
    let mut next = build(&twice, Some(&session)).unwrap();
    next.swap_in(&mut session).unwrap();
    // It stores every texel: the pass that filled them before is needed no more.
    assert_eq!(
        next.program.change,
        Change {
            kept: 1,
            built: 1,
            resized: 0
        }
    );
    frames(&mut next, 1);
    assert_eq!(floats(&mut next, "sized", 0)[0][0], 2.0);
    assert_clean(&bench.lab);
}

/// What the window does all day, with the method itself: every switch of a plan, one after the other on one session.
#[test]
fn the_method_reloaded_makes_the_picture_of_a_fresh_start() {
    let lab = lab(root());
    let cornell = scene("cornell");
    let small = [
        ("voxel_dim", "32"),
        ("shadow_dim", "256"),
        ("gather_frames", "1"), // nothing of the step before is kept
    ];
    let steps: [&[(&str, &str)]; 7] = [
        &[],
        &[("voxel_dim", "48")],
        &[("opacity", "cell")],
        &[("temporal_factor", "0.8")],
        &[("view", "normal")],
        &[("warp", "spline")],
        &[],
    ];
    let mut live: Option<Session> = None;
    for step in steps {
        let experiment = experiment("cornell", (64, 48), &[&small[..], step].concat());
        let loaded = lab.home.load(&experiment.graph).unwrap();
        let wanted = vec!["display".to_string()];
        let reuse = live.as_ref().map(Session::reusable_parts);
        let mut next = lab
            .build(
                &experiment,
                &loaded,
                cornell.clone(),
                wanted.clone(),
                reuse.as_ref(),
            )
            .unwrap();
        drop(reuse);
        if let Some(old) = &mut live {
            next.swap_in(old).unwrap();
        }
        frames(&mut next, 1);
        if !step.contains(&("temporal_factor", "0.8")) {
            let mut fresh = lab
                .build(&experiment, &loaded, cornell.clone(), wanted, None)
                .unwrap();
            frames(&mut fresh, 1);
            let (a, b) = (
                next.texels("display", 0, 0).unwrap().bytes,
                fresh.texels("display", 0, 0).unwrap().bytes,
            );
            assert!(
                a == b,
                "after {step:?} the picture is not that of a fresh start"
            );
        }
        live = Some(next);
        assert_clean(&lab);
    }
}
