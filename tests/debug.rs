//! Values and conditions of shaders that `shaders/common/debug.glsl` records, in graphs with a known answer.

mod common;

use common::{assert_clean, conelab, floats, prepare, succeeds};
use conelab::experiment::Experiment;
use conelab::lab::{Session, Workspace};
use conelab::vulkan::Stage;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

const COMPUTE: &str = "#version 460
#extension GL_GOOGLE_include_directive : require
#include \"params.glsl\"
#include \"common/debug.glsl\"
layout(local_size_x = 8, local_size_y = 8) in;
uniform writeonly image2D picture;
void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, imageSize(picture)))) return;
    show(\"half\", vec2(at) * 0.5);
    show(\"sum\", at.x + at.y); show(\"product\", uint(at.x * at.y));
    show(\"even\", (at.x & 1) == 0);
    show(\"negative\", ivec3(-at, -7));
    check(\"below the diagonal\", at.x <= at.y);
    check(\"never fails\", at.x < 1000);
    imageStore(picture, at, vec4(at.x, at.y, 0, 1));
}
";

const FRAGMENT: &str = "#version 460
#extension GL_GOOGLE_include_directive : require
#include \"params.glsl\"
#include \"common/debug.glsl\"
layout(location = 0) out vec4 drawn;
void main() {
    vec2 at = floor(gl_FragCoord.xy);
    show(\"position\", vec4(at, 0.25, 1.0));
    check(\"left of 20\", at.x < 20.0);
    drawn = vec4(at, 0.0, 1.0);
}
";

const FULL: &str = "#version 460
void main() {
    gl_Position = vec4(vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2) * 2.0 - 1.0, 0.0, 1.0);
}
";

const VOLUME: &str = "#version 460
#extension GL_GOOGLE_include_directive : require
#include \"params.glsl\"
#include \"common/debug.glsl\"
layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
uniform writeonly image3D cells;
void main() {
    ivec3 cell = ivec3(gl_GlobalInvocationID);
    debugIf(cell == ivec3(3, 2, 5));
    show(\"cell\", cell);
    check(\"lower half\", cell.z < 4 || cell.x < 6);
    imageStore(cells, cell, vec4(cell, 1));
}
";

const GRAPH: &str = r#"(
    params: [ Vec2(name: "cursor", default: (-1.0, -1.0), help: "Pixel."), Int(name: "unused", default: 1, help: "None.") ],
    textures: {
        "picture": (size: Screen, format: "rgba32f"),
        "drawn": (size: Screen, format: "rgba32f"),
        "cells": (size: (8, 8, 8), format: "rgba32f"),
    },
    passes: [
        (name: "compute", shaders: ["compute.comp"], dispatch: Cover("picture")),
        (name: "draw", shaders: ["full.vert", "draw.frag"], draw: Fullscreen, color: [(to: "drawn")]),
        (name: "volume", shaders: ["volume.comp"], dispatch: Cover("cells")),
    ],
    outputs: ["picture", "drawn", "cells"],
    pointer: "cursor",
)"#;

fn write(home: &Path, name: &str, text: &str) {
    let path = home.join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, text).unwrap();
}

/// A home with these shaders, and the pixel that is clicked on.
fn home(cursor: &str) -> TempDir {
    let home = tempfile::tempdir().unwrap();
    let debug = std::fs::read_to_string(common::root().join("shaders/common/debug.glsl")).unwrap();
    let run = format!(
        "(graph: \"graph.ron\", scene: \"triangles\", size: (32, 24), params: {{ \"cursor\": {cursor} }})"
    );
    for (name, text) in [
        ("passes/graph.ron", GRAPH),
        ("configs/run.ron", &run),
        ("shaders/compute.comp", COMPUTE),
        ("shaders/draw.frag", FRAGMENT),
        ("shaders/full.vert", FULL),
        ("shaders/volume.comp", VOLUME),
        ("shaders/common/debug.glsl", &debug),
    ] {
        write(home.path(), name, text);
    }
    home
}

fn run(home: &Path, wanted: &[&str]) -> Session {
    let lab = common::lab(home);
    let experiment = Experiment::read(&home.join("configs/run.ron")).unwrap();
    let mut session = prepare(&lab, &experiment, wanted);
    // Each frame records its own values.
    session.run(3).unwrap();
    assert_clean(&lab);
    session
}

#[test]
fn values_of_the_clicked_pixel_are_those_of_its_formula() {
    let home = home("(21, 13)");
    let mut session = run(home.path(), &["picture", "drawn", "cells"]);
    let debug = session.debug().unwrap().unwrap();
    let line =
        |text: &str, part: &str| 1 + text.lines().position(|l| l.contains(part)).unwrap() as u32;
    let expected = [
        (
            "half",
            "10.5 6.5",
            "compute",
            "compute.comp",
            line(COMPUTE, "\"half\""),
        ),
        (
            "sum",
            "34",
            "compute",
            "compute.comp",
            line(COMPUTE, "\"sum\""),
        ),
        (
            "product",
            "273",
            "compute",
            "compute.comp",
            line(COMPUTE, "\"sum\""),
        ),
        (
            "even",
            "false",
            "compute",
            "compute.comp",
            line(COMPUTE, "\"even\""),
        ),
        (
            "negative",
            "-21 -13 -7",
            "compute",
            "compute.comp",
            line(COMPUTE, "\"negative\""),
        ),
        (
            "position",
            "21 13 0.25 1",
            "draw",
            "draw.frag",
            line(FRAGMENT, "\"position\""),
        ),
        (
            "cell",
            "3 2 5",
            "volume",
            "volume.comp",
            line(VOLUME, "\"cell\""),
        ),
    ];
    let found: Vec<_> = debug
        .values
        .iter()
        .map(|r| {
            (
                r.name.as_str(),
                r.value.as_str(),
                r.pass.as_str(),
                r.file.as_str(),
                r.line,
            )
        })
        .collect();
    assert_eq!(found, expected);
    assert_eq!(debug.lost, 0);
    // The shaders write the same results as without calls.
    let texel = floats(&mut session, "picture", 0)[13 * 32 + 21];
    assert_eq!(texel, [21.0, 13.0, 0.0, 1.0]);
}

#[test]
fn failures_are_counted_and_the_first_place_is_known() {
    let home = home("(-1, -1)");
    let mut session = run(home.path(), &["picture", "drawn", "cells"]);
    let debug = session.debug().unwrap().unwrap();
    // Nothing is pointed at; the cell is selected by a condition of its own.
    let shown: Vec<_> = debug.values.iter().map(|r| r.name.as_str()).collect();
    assert_eq!(shown, ["cell"]);
    let found: Vec<_> = debug
        .failed
        .iter()
        .map(|r| (r.name.as_str(), r.value.as_str(), r.pass.as_str()))
        .collect();
    // Of 32 x 24: row y has 31 - y pixels right of the diagonal.
    let below: usize = (0..24).map(|y| 31 - y).sum();
    assert_eq!(
        found,
        [
            (
                "below the diagonal",
                format!("failed {below} times, first at 1 0").as_str(),
                "compute"
            ),
            (
                "left of 20",
                format!("failed {} times, first at 20 0", 12 * 24).as_str(),
                "draw"
            ),
            (
                "lower half",
                format!("failed {} times, first at 6 0 4", 4 * 8 * 2).as_str(),
                "volume"
            ),
        ]
    );
    assert_eq!(session.failed_checks().unwrap().len(), 3);
    // The command prints them.
    let picture = home.path().join("p.exr");
    let output = conelab(home.path())
        .args(["render", "configs/run.ron", "--resource", "picture", "-o"])
        .arg(&picture)
        .output()
        .unwrap();
    let printed = String::from_utf8_lossy(&output.stderr);
    let warning = format!(
        "warning: check 'below the diagonal' failed {below} times, first at 1 0 (pass 'compute', compute.comp:"
    );
    assert!(
        output.status.success() && printed.contains(&warning),
        "{printed}"
    );
    // A pass with unused output stays out, though it records.
    assert!(!printed.contains("left of 20"), "{printed}");
}

/// Without calls nothing is recorded: there is no buffer, and the instructions are those of a shader without the include.
#[test]
fn an_include_without_calls_costs_nothing() {
    let home = home("(21, 13)");
    let without_calls = |text: &str| {
        let kept = |line: &&str| {
            !["show(", "check(", "debugIf("]
                .iter()
                .any(|w| line.contains(w))
        };
        text.lines()
            .filter(kept)
            .map(|l| format!("{l}\n"))
            .collect::<String>()
    };
    let shaders = [
        ("compute.comp", COMPUTE),
        ("draw.frag", FRAGMENT),
        ("volume.comp", VOLUME),
    ];
    let words = |of: &dyn Fn(&str) -> String| {
        for (name, text) in shaders {
            write(home.path(), &format!("shaders/{name}"), &of(text));
        }
        let workspace = Workspace::with(home.path().to_path_buf(), None);
        let loaded = workspace.load("graph.ron").unwrap();
        let stages = loaded.linked.iter().flat_map(|l| l.stages.clone());
        stages
            .filter(|s| s.stage != Stage::Vertex)
            .map(|s| code(&s.words))
            .collect::<Vec<_>>()
    };
    let with = words(&without_calls);
    let without =
        words(&|text| without_calls(text).replace("#include \"common/debug.glsl\"\n", ""));
    assert_eq!(with.len(), 3);
    assert!(with == without);
    for (name, text) in shaders {
        write(
            home.path(),
            &format!("shaders/{name}"),
            &without_calls(text),
        );
    }
    let mut session = run(home.path(), &["picture", "drawn", "cells"]);
    assert_eq!(session.debug().unwrap(), None);
    let made = session.program.memory(&session.graph);
    assert!(made.iter().all(|m| m.0 != "debugRecord"), "{made:?}");
}

/// Opcode and length of the instructions of a module, without its source and names for debuggers. The compiler numbers
/// results otherwise.
fn code(words: &[u32]) -> Vec<u32> {
    let mut list = Vec::new();
    let mut rest = &words[5..];
    while let Some(first) = rest.first() {
        // OpSourceContinued, OpSource, OpSourceExtension, OpName, OpMemberName, OpString, OpLine, OpNoLine,
        // OpModuleProcessed.
        if ![2, 3, 4, 5, 6, 7, 8, 317, 330].contains(&(first & 0xffff)) {
            list.push(*first);
        }
        rest = &rest[(first >> 16) as usize..];
    }
    list
}

/// The output of a failing check.
fn failure(command: &mut Command) -> String {
    let output = command.output().unwrap();
    assert!(!output.status.success());
    [output.stdout, output.stderr]
        .map(|o| String::from_utf8_lossy(&o).into_owned())
        .concat()
}

#[test]
fn a_misuse_names_file_and_line() {
    let home = home("(21, 13)");
    let check = || {
        let mut command = conelab(home.path());
        command.args(["check", "passes/graph.ron"]);
        command
    };
    succeeds(&mut check());
    let shader = |call: &str| {
        let text = COMPUTE.replace("show(\"half\", vec2(at) * 0.5);", call);
        write(home.path(), "shaders/compute.comp", &text);
    };
    shader("show(at.x, 3);");
    let said = failure(&mut check());
    assert!(
        said.contains(
            "compute.comp:10: error: the first argument of 'show' must be a name in quotes"
        ),
        "{said}"
    );
    // Lines of the compiler's own messages are exact behind names.
    shader("show(\"half\", vec2(at) * 0.5); wrong;");
    let said = failure(&mut check());
    assert!(said.contains("compute.comp:10: error: 'wrong'"), "{said}");
}
