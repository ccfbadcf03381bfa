//! Wrong graphs, shaders and experiments: each test makes one mistake in files that are right, and compares everything
//! that is said about it.

use conelab::diagnostics::Diagnostic;
use conelab::experiment::Experiment;
use conelab::graph::Evaluated;
use conelab::graph::plan::plan;
use conelab::lab::{LabError, Loaded, Workspace, any_device, environment, params_of};
use conelab::scene::Scene;
use conelab::vulkan::DeviceInfo;
use insta::assert_snapshot;
use std::path::PathBuf;
use std::sync::Arc;
use tempfile::TempDir;

const GRAPH: &str = r#"(
    include: ["shared.ron"],
    params: [
        Int(name: "cells", default: 64, range: (16, 512), help: "Edge of the grid."),
        Choice(name: "method", options: ["fast", "exact"], help: "How fragments are found."),
        Choice(name: "grid_format", options: ["rgba8", "rgba16f"], help: "Texels of the grid."),
        Bool(name: "bright", default: false, help: "Twice the light."),
    ],
    textures: {
        "grid": (size: ("cells", "cells", "cells"), format: "grid_format", mips: "log2(cells) + 1"),
        "count": (size: ("cells", "cells"), format: "r32ui", views: ["r32i"]),
        "picture": (size: ("width", "height"), format: "rgba16f", history: true),
        "depth": (size: ("width", "height"), format: "d32"),
    },
    buffers: {
        "work": (size: "cells * 16", indirect: true),
    },
    passes: [
        (name: "prepare", shaders: ["prepare.comp"], dispatch: Groups(1, 1, 1)),
        (name: "fill", shaders: ["fill.comp"], dispatch: Indirect("work.groups")),
        (name: "reduce", each_mip: (texture: "grid", from: 1), shaders: ["reduce.comp"], dispatch: Cover("dst"),
            bind: { "src": (of: "grid", mip: "mip - 1"), "dst": (of: "grid", mip: "mip") }),
        (name: "scatter", shaders: ["full.vert", "scatter.frag"], draw: Fullscreen,
            raster: (size: ("cells", "cells"), samples: "4")),
        (name: "paint", when: "method == fast", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
            bind: { "last": (of: "picture", history: true) },
            color: [(to: "picture", clear: (0, 0, 0, 1))], depth: (to: "depth", clear: 1.0)),
    ],
    output: "picture",
)
"#;

const SHARED: &str = r#"(
    params: [
        Float(name: "level", default: 0.5, range: (0.0, 1.0), help: "Brightness."),
    ],
)
"#;

const RUN: &str = r#"(
    graph: "graph.ron",
    scene: "triangles",
    size: (64, 48),
    params: {
        "level": 0.25,
    },
)
"#;

const PREPARE: &str = "#version 460
layout(std430) writeonly buffer Work { uvec3 groups; uint words[]; } work;
void main() { work.words[0] = work.words.length(); }
";

const FILL: &str = "#version 460
#extension GL_GOOGLE_include_directive : require
#include \"light.glsl\"
layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
uniform writeonly image3D grid;
void main() { imageStore(grid, ivec3(gl_GlobalInvocationID), light()); }
";

const LIGHT: &str = "#include \"params.glsl\"
vec4 light() {
    return vec4(params.level * (params.bright ? 2.0 : 1.0));
}
";

const REDUCE: &str = "#version 460
layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
uniform sampler3D src;
uniform writeonly image3D dst;
void main() { imageStore(dst, ivec3(gl_GlobalInvocationID), texelFetch(src, ivec3(gl_GlobalInvocationID) * 2, 0)); }
";

const FULL: &str = "#version 460
void main() { gl_Position = vec4(vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2) * 2.0 - 1.0, 0.0, 1.0); }
";

const SCATTER: &str = "#version 460
layout(r32ui) uniform uimage2D count;
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (imageLoad(count, pixel).r < 100u) imageAtomicAdd(count, pixel, 1u);
}
";

const PAINT: &str = "#version 460
uniform sampler3D grid;
uniform usampler2D count;
uniform sampler2D last;
layout(location = 0) out vec4 color;
void main() {
    color = texelFetch(grid, ivec3(0), 0) * float(texelFetch(count, ivec2(0), 0).r) + texelFetch(last, ivec2(0), 0);
}
";

/// A folder with files that are right, and a device that has everything.
struct Bench {
    folder: TempDir,
    device: DeviceInfo,
}

fn bench() -> Bench {
    let mut bench = Bench {
        folder: tempfile::tempdir().unwrap(),
        device: any_device(),
    };
    bench.device.name = String::from("Test GPU");
    for (name, text) in [
        ("passes/graph.ron", GRAPH),
        ("passes/shared.ron", SHARED),
        ("configs/run.ron", RUN),
        ("shaders/prepare.comp", PREPARE),
        ("shaders/fill.comp", FILL),
        ("shaders/light.glsl", LIGHT),
        ("shaders/reduce.comp", REDUCE),
        ("shaders/full.vert", FULL),
        ("shaders/scatter.frag", SCATTER),
        ("shaders/paint.frag", PAINT),
    ] {
        bench.write(name, text);
    }
    bench
}

impl Bench {
    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }

    /// Replaces the only `old` of a file.
    #[track_caller]
    fn edit(self, name: &str, old: &str, new: &str) -> Bench {
        let text = std::fs::read_to_string(self.path(name)).unwrap();
        assert_eq!(
            text.matches(old).count(),
            1,
            "'{old}' stands once in {name}"
        );
        self.write(name, &text.replace(old, new));
        self
    }

    fn add(self, name: &str, text: &str) -> Bench {
        self.write(name, text);
        self
    }

    /// Everything said between reading the experiment and having the plan of a frame.
    fn findings(&self) -> String {
        let list = self.check().unwrap_or_else(|errors| errors);
        let text = list
            .iter()
            .map(ToString::to_string)
            .collect::<Vec<_>>()
            .join("\n");
        text.replace(&format!("{}/", self.folder.path().display()), "")
    }

    fn check(&self) -> Result<Vec<Diagnostic>, Vec<Diagnostic>> {
        let home = Workspace::with(self.folder.path().to_path_buf(), None);
        let experiment = Experiment::read(&self.path("configs/run.ron"))?;
        let Loaded {
            graph,
            linked,
            warnings,
        } = home.load(&experiment.graph)?;
        if let Some(mistake) = conelab::measure::oracle::mistake(&graph) {
            return Err(vec![mistake]);
        }
        let params = params_of(&graph, &experiment).map_err(|e| match e {
            LabError::Input(list) => list,
            other => panic!("{other}"),
        })?;
        let scene = Scene::open(&experiment.scene, &|_, _| {
            std::ops::ControlFlow::Continue(())
        })
        .unwrap();
        let set = Evaluated::new(
            &graph,
            &params,
            environment(&scene, experiment.size, &self.device),
        );
        let wanted: Vec<String> = graph.output.iter().chain(&graph.outputs).cloned().collect();
        plan(&set, &linked, &wanted, &self.device)?;
        Ok(warnings)
    }
}

/// One mistake in the graph.
#[track_caller]
fn graph(old: &str, new: &str) -> String {
    bench().edit("passes/graph.ron", old, new).findings()
}

#[test]
fn a_graph_pins_what_it_declares() {
    let said = graph(
        "    output: \"picture\",",
        "    output: \"picture\",\n    pinned: { \"cels\": \"Cells\", \"level\": \"\" },",
    );
    assert!(
        said.contains("no parameter 'cels' to pin") && said.contains("did you mean 'cells'?"),
        "{said}"
    );
    assert!(said.contains("'level' is pinned without a title"), "{said}");
    let edit = (
        "Float(name: \"level\", ",
        "Float(name: \"level\", when: \"methd == fast\", ",
    );
    let said = bench().edit("passes/shared.ron", edit.0, edit.1).findings();
    assert!(
        said.contains("unknown variable 'methd'") && said.contains("did you mean 'method'?"),
        "{said}"
    );
}

#[test]
fn a_graph_is_read_again_when_one_of_its_files_has_changed() {
    let bench = bench().edit(
        "passes/graph.ron",
        "    output:",
        "    modules: { \"lamp\": \"light.glsl\" },\n    output:",
    );
    let home = Workspace::with(bench.folder.path().to_path_buf(), None);
    let read = || home.read("graph.ron");
    let first = read().unwrap();
    assert!(Arc::ptr_eq(&first, &read().unwrap()), "nothing has changed");
    // A shader is no part of it, but whether the file of a module is there.
    let bench = bench.edit("shaders/light.glsl", "2.0", "3.0");
    assert!(
        Arc::ptr_eq(&first, &read().unwrap()),
        "a shader has changed"
    );
    let bench = bench.edit("passes/shared.ron", "default: 0.5", "default: 0.75");
    let second = read().unwrap();
    assert_eq!(
        [&first, &second].map(|g| g.params.get("level").unwrap().to_string()),
        ["0.5", "0.75"]
    );
    let gone = bench.path("shaders/light.glsl");
    std::fs::rename(&gone, gone.with_extension("gone")).unwrap();
    assert!(
        read().unwrap_err()[0]
            .message
            .contains("no shader file 'light.glsl'")
    );
    std::fs::rename(gone.with_extension("gone"), &gone).unwrap();
    std::fs::remove_file(bench.path("passes/shared.ron")).unwrap();
    assert!(read().is_err(), "an include is gone");
}

#[test]
fn a_part_of_the_light_is_a_texture_or_says_more() {
    let parts = |text: &str| {
        graph(
            "    output: \"picture\",",
            &format!("    output: \"picture\",\n    parts: {{ {text} }},"),
        )
    };
    assert_eq!(
        parts(
            "\"total\": \"picture\", \"lamp\": (texture: \"picture\", kind: direct, focus: true)"
        ),
        ""
    );
    let said = parts("\"total\": (texture: \"pictur\"), \"lamp\": \"depht\"");
    assert!(
        said.contains("graph.ron:30:33") && said.contains("did you mean 'picture'?"),
        "{said}"
    );
    assert!(
        said.contains("graph.ron:30:52") && said.contains("did you mean 'depth'?"),
        "{said}"
    );
    let said = parts("\"total\": (texture: \"picture\", kind: opennes)");
    assert!(
        said.contains("unknown name 'opennes'") && said.contains("did you mean 'openness'?"),
        "{said}"
    );
    let said = parts("\"total\": (kind: direct)");
    assert!(said.contains("field 'texture' is missing"), "{said}");
}

/// One mistake in a shader.
#[track_caller]
fn shader(name: &str, old: &str, new: &str) -> String {
    bench()
        .edit(&format!("shaders/{name}"), old, new)
        .findings()
}

/// One mistake in the experiment.
#[track_caller]
fn experiment(old: &str, new: &str) -> String {
    bench().edit("configs/run.ron", old, new).findings()
}

#[test]
fn the_files_are_right() {
    assert_eq!(bench().findings(), "");
}

#[test]
fn text_that_is_no_ron() {
    // A comma is missing after the first pass; a bracket at the end; a file that is not text at all.
    assert_snapshot!(graph("dispatch: Groups(1, 1, 1)),", "dispatch: Groups(1, 1, 1))"), @r#"
    passes/graph.ron:20:9: error: expected a comma
        |         (name: "fill", shaders: ["fill.comp"], dispatch: Indirect("work.groups")),
        = help: one is missing before this, or a whole number has a point
    "#);
    assert_snapshot!(graph("output: \"picture\",\n)", "output: \"picture\",\n"), @r#"
    passes/graph.ron:29:23: error: Unexpected end of RON
        |     output: "picture",
    "#);
    assert_snapshot!(graph("output: \"picture\",", "output: picture,"), @r"
    passes/graph.ron:29:13: error: Expected string
        |     output: picture,
    ");
    assert_snapshot!(graph("range: (16, 512), help: \"Edge", "range: (16, 512), help: \"Edge\\q"), @r#"
    passes/graph.ron:4:66: error: Unknown escape character
        |         Int(name: "cells", default: 64, range: (16, 512), help: "Edge\q of the grid."),
    "#);
    let bench = bench();
    std::fs::write(bench.path("passes/graph.ron"), [0xff, 0xfe, 0x00]).unwrap();
    assert_snapshot!(bench.findings(), @"passes/graph.ron: error: cannot read it: it is not UTF-8 text");
}

#[test]
fn a_file_that_cannot_be_read_takes_no_other_with_it() {
    // A bracket too few, and everything that the file declares is missing where it is used.
    let texts = SHARED.replace(
        "    params: [",
        "    textures: { \"shared\": (size: (4, 4), format: \"rgba8\") },\n    params: [",
    );
    let texts = texts.replace("(0.0, 1.0), help", "(0.0, 1.0, help");
    let broken = bench()
        .add("passes/shared.ron", &texts)
        .edit(
            "passes/graph.ron",
            "\"cells * 16\"",
            "\"cells * 16 * level\"",
        )
        .edit(
            "passes/graph.ron",
            "bind: { \"src\": (of: \"grid\"",
            "bind: { \"src\": (of: \"shared\"",
        )
        .edit("passes/graph.ron", "to: \"depth\"", "to: \"shared\"");
    assert_snapshot!(broken.findings(), @r#"
    passes/shared.ron:4:66: error: expected a comma
        |         Float(name: "level", default: 0.5, range: (0.0, 1.0, help: "Brightness."),
        = help: one is missing before this, or a whole number has a point
    "#);
    // Not there at all. What is wrong beside it is still told.
    let missing = bench()
        .edit("passes/graph.ron", "shared.ron", "share.ron")
        .edit("passes/graph.ron", "clear: 1.0", "clear: (1, 0)");
    assert_snapshot!(missing.findings(), @r#"
    passes/graph.ron:2:15: error: cannot read it: No such file or directory (os error 2)
        |     include: ["share.ron"],
        = help: did you mean 'shared.ron'?
    passes/graph.ron:27:87: error: Expected float
        |             color: [(to: "picture", clear: (0, 0, 0, 1))], depth: (to: "depth", clear: (1, 0))),
    "#);
}

#[test]
fn fields_and_variants_that_do_not_exist() {
    assert_snapshot!(graph("output: \"picture\"", "outptu: \"picture\""), @r#"
    passes/graph.ron:29:5: error: unknown field 'outptu'
        |     outptu: "picture",
        = help: did you mean 'output'?
    "#);
    assert_snapshot!(graph("shaders: [\"fill.comp\"], ", "shader: [\"fill.comp\"], "), @r#"
    passes/graph.ron:20:24: error: unknown field 'shader'
        |         (name: "fill", shader: ["fill.comp"], dispatch: Indirect("work.groups")),
        = help: did you mean 'shaders'?
    "#);
    assert_snapshot!(graph("samples: \"4\"", "sample: \"4\""), @r#"
    passes/graph.ron:24:48: error: unknown field 'sample'
        |             raster: (size: ("cells", "cells"), sample: "4")),
        = help: did you mean 'samples'?
    "#);
    assert_snapshot!(graph("dispatch: Groups(1, 1, 1)", "dispatch: Group(1, 1, 1)"), @r#"
    passes/graph.ron:19:64: error: unknown name 'Group'
        |         (name: "prepare", shaders: ["prepare.comp"], dispatch: Group(1, 1, 1)),
        = help: did you mean 'Groups'?
    "#);
    assert_snapshot!(graph("Bool(name: \"bright\"", "Boolean(name: \"bright\""), @r#"
    passes/graph.ron:7:9: error: unknown name 'Boolean'
        |         Boolean(name: "bright", default: false, help: "Twice the light."),
        = help: did you mean 'Bool'?
    "#);
    assert_snapshot!(graph("format: \"d32\"", "format: \"d32\", sampler: (filter: bilinear)"), @r#"
    passes/graph.ron:13:79: error: unknown name 'bilinear'
        |         "depth": (size: ("width", "height"), format: "d32", sampler: (filter: bilinear)),
        = help: did you mean 'linear'?
    "#);
}

#[test]
fn values_of_the_wrong_kind() {
    assert_snapshot!(graph("\"depth\": (size: (\"width\", \"height\")", "\"depth\": (size: \"width\""), @r#"
    passes/graph.ron:13:26: error: expected two sizes (width, height) or three (width, height, depth)
        |         "depth": (size: "width", format: "d32"),
    "#);
    assert_snapshot!(graph("format: \"rgba16f\", history: true", "format: \"rgba16f\", history: \"yes\""), @r#"
    passes/graph.ron:12:75: error: Expected boolean
        |         "picture": (size: ("width", "height"), format: "rgba16f", history: "yes"),
    "#);
    assert_snapshot!(graph("clear: 1.0", "clear: (1, 0)"), @r#"
    passes/graph.ron:27:87: error: Expected float
        |             color: [(to: "picture", clear: (0, 0, 0, 1))], depth: (to: "depth", clear: (1, 0))),
    "#);
    assert_snapshot!(graph("bind: { \"last\": (of: \"picture\", history: true) }", "bind: { \"last\": \"picture\" }"), @r#"
    passes/graph.ron:26:29: error: Expected opening `(` for struct `Bind`
        |             bind: { "last": "picture" },
    "#);
    assert_snapshot!(graph("(name: \"prepare\", ", "("), @r#"
    passes/graph.ron:19:62: error: field 'name' is missing
        |         (shaders: ["prepare.comp"], dispatch: Groups(1, 1, 1)),
    "#);
}

#[test]
fn names_that_nothing_has() {
    assert_snapshot!(graph("to: \"depth\"", "to: \"detph\""), @r#"
    passes/graph.ron:27:72: error: no texture is named 'detph'
        |             color: [(to: "picture", clear: (0, 0, 0, 1))], depth: (to: "detph", clear: 1.0)),
        = help: did you mean 'depth'?
    "#);
    assert_snapshot!(graph("Indirect(\"work.groups\")", "Indirect(\"wrok.groups\")"), @r#"
    passes/graph.ron:20:67: error: no buffer is named 'wrok'
        |         (name: "fill", shaders: ["fill.comp"], dispatch: Indirect("wrok.groups")),
        = help: did you mean 'work'?
    "#);
    assert_snapshot!(graph("mips: \"log2(cells) + 1\"", "mips: \"log2(cell) + 1\""), @r#"
    passes/graph.ron:10:82: error: unknown variable 'cell' in 'log2(cell) + 1'
        |         "grid": (size: ("cells", "cells", "cells"), format: "grid_format", mips: "log2(cell) + 1"),
        = help: did you mean 'cells'?
    "#);
    assert_snapshot!(graph("when: \"method == fast\"", "when: \"method == fats\""), @r#"
    passes/graph.ron:25:31: error: unknown variable 'fats' in 'method == fats'
        |         (name: "paint", when: "method == fats", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
        = help: did you mean 'fast'?
    "#);
    assert_snapshot!(graph("[\"full.vert\", \"paint.frag\"]", "[\"full.vert\", \"pant.frag\"]"), @r#"
    passes/graph.ron:25:72: error: no shader file 'pant.frag'
        |         (name: "paint", when: "method == fast", shaders: ["full.vert", "pant.frag"], draw: Fullscreen,
        = help: did you mean 'paint.frag'?
    "#);
    assert_snapshot!(graph("[\"full.vert\", \"paint.frag\"]", "[\"full.vert\", \"paint.fragment\"]"), @r#"
    passes/graph.ron:25:72: error: 'paint.fragment' is no shader: expected .vert, .tesc, .tese, .geom, .frag or .comp
        |         (name: "paint", when: "method == fast", shaders: ["full.vert", "paint.fragment"], draw: Fullscreen,
    "#);
    assert_snapshot!(graph("format: \"rgba16f\", history", "format: \"rgb16f\", history"), @r#"
    passes/graph.ron:12:56: error: no format is named 'rgb16f'
        |         "picture": (size: ("width", "height"), format: "rgb16f", history: true),
        = help: did you mean 'rgba16f'?
    "#);
    assert_snapshot!(graph("format: \"r32ui\", views", "format: \"method\", views"), @r#"
    passes/graph.ron:11:53: error: option 'fast' of 'method' is no format
        |         "count": (size: ("cells", "cells"), format: "method", views: ["r32i"]),
    passes/graph.ron:11:53: error: option 'exact' of 'method' is no format
        |         "count": (size: ("cells", "cells"), format: "method", views: ["r32i"]),
    "#);
    assert_snapshot!(graph("output: \"picture\"", "output: \"pictures\""), @r#"
    passes/graph.ron:29:13: error: no texture is named 'pictures'
        |     output: "pictures",
        = help: did you mean 'picture'?
    "#);
    assert_snapshot!(graph("each_mip: (texture: \"grid\"", "each_mip: (texture: \"grids\""), @r#"
    passes/graph.ron:21:46: error: no texture is named 'grids'
        |         (name: "reduce", each_mip: (texture: "grids", from: 1), shaders: ["reduce.comp"], dispatch: Cover("dst"),
        = help: did you mean 'grid'?
    "#);
    assert_snapshot!(graph("Cover(\"dst\")", "Cover(\"dts\")"), @r#"
    passes/graph.ron:21:106: error: no texture is named 'dts'
        |         (name: "reduce", each_mip: (texture: "grid", from: 1), shaders: ["reduce.comp"], dispatch: Cover("dts"),
        = help: known: count, depth, grid, picture
    "#);
}

#[test]
fn expressions() {
    assert_snapshot!(graph("\"cells * 16\"", "\"cells * \""), @r#"
    passes/graph.ron:16:24: error: 'cells * ' is no expression: Script is incomplete (line 1, position 9)
        |         "work": (size: "cells * ", indirect: true),
    "#);
    assert_snapshot!(graph("\"cells * 16\"", "\"pow(cells, 2)\""), @r#"
    passes/graph.ron:16:24: error: 'pow(cells, 2)': Function not found: pow (f64, i64) (line 1, position 1)
        |         "work": (size: "pow(cells, 2)", indirect: true),
    "#);
    assert_snapshot!(graph("\"cells * 16\"", "\"cells * mip\""), @r#"
    passes/graph.ron:16:24: error: 'cells * mip': 'mip' has no value here
        |         "work": (size: "cells * mip", indirect: true),
    "#);
    assert_snapshot!(graph("\"cells * 16\"", "\"cells * (1 / 2)\""), @r#"
    passes/graph.ron:16:24: error: buffer 'work' is 0 bytes; Test GPU allows 4 to 4294967295
        |         "work": (size: "cells * (1 / 2)", indirect: true),
    "#);
    // Comparisons of different kinds would be false without a word.
    assert_snapshot!(graph("when: \"method == fast\"", "when: \"bright == 1\""), @r#"
    passes/graph.ron:25:31: error: 'bright == 1': Runtime error: true or false is no number: write `flag` or `!flag` (line 1, position 8)
        |         (name: "paint", when: "bright == 1", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
    "#);
    assert_snapshot!(graph("when: \"method == fast\"", "when: \"method == 'fast'\""), @r#"
    passes/graph.ron:25:31: error: 'method == 'fast'' is no expression: Invalid character: 'fast' (line 1, position 11)
        |         (name: "paint", when: "method == 'fast'", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
    "#);
    assert_snapshot!(graph("when: \"method == fast\"", "when: \"method == `fast`\""), @r#"
    passes/graph.ron:25:31: error: 'method == `fast`': Runtime error: options stand without quotes: choice == option (line 1, position 8)
        |         (name: "paint", when: "method == `fast`", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
    "#);
    assert_snapshot!(graph("when: \"method == fast\"", "when: \"method = fast\""), @r#"
    passes/graph.ron:25:31: error: 'method = fast' is no expression: Unexpected '=' (line 1, position 8)
        |         (name: "paint", when: "method = fast", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
    "#);
    assert_snapshot!(graph("when: \"method == fast\"", "when: \"cells && bright\""), @r#"
    passes/graph.ron:25:31: error: 'cells && bright': Data type incorrect: f64 (expecting bool) (line 1, position 1)
        |         (name: "paint", when: "cells && bright", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
    "#);
}

#[test]
fn choices_in_expressions() {
    let when = |text: &str| {
        let other = "help: \"How fragments are found.\"),\n        Choice(name: \"order\", options: [\"rows\", \"slices\"], help: \"Which first.\")";
        let bench = bench().edit(
            "passes/graph.ron",
            "help: \"How fragments are found.\")",
            other,
        );
        bench
            .edit(
                "passes/graph.ron",
                "when: \"method == fast\"",
                &format!("when: \"{text}\""),
            )
            .findings()
    };
    assert_eq!(when("method == fast && order != slices"), "");
    assert_eq!(
        when("exact != method && order == select(bright, rows, slices)"),
        ""
    );
    // An option of another choice: such a comparison never holds.
    assert_snapshot!(when("method == slices"), @r#"
    passes/graph.ron:26:31: error: 'method' has no option 'slices', in 'method == slices'
        |         (name: "paint", when: "method == slices", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
        = help: known: exact, fast; 'slices' is an option of 'order'
    "#);
    assert_snapshot!(when("cells > 4 && !(order != select(bright, rows, fast))"), @r#"
    passes/graph.ron:26:31: error: 'order' has no option 'fast', in 'cells > 4 && !(order != select(bright, rows, fast))'
        |         (name: "paint", when: "cells > 4 && !(order != select(bright, rows, fast))", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
        = help: known: rows, slices; 'fast' is an option of 'method'
    "#);
    // Two choices, two options, a number, a truth value.
    assert_snapshot!(when("method == order"), @r#"
    passes/graph.ron:26:31: error: 'method' and 'order' are two choices, which never compare, in 'method == order'
        |         (name: "paint", when: "method == order", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
        = help: compare a choice with its options: method == fast
    "#);
    assert_snapshot!(when("fast == exact"), @r#"
    passes/graph.ron:26:31: error: 'fast' is an option of 'method', compared with another option, in 'fast == exact'
        |         (name: "paint", when: "fast == exact", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
        = help: compare a choice with its options: method == fast
    "#);
    assert_snapshot!(when("method == 1"), @r#"
    passes/graph.ron:26:31: error: 'method' is a choice, no number, in 'method == 1'
        |         (name: "paint", when: "method == 1", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
        = help: compare a choice with its options: method == fast
    "#);
    assert_snapshot!(when("rows != bright"), @r#"
    passes/graph.ron:26:31: error: 'rows' is an option of 'order', no number, in 'rows != bright'
        |         (name: "paint", when: "rows != bright", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
        = help: compare a choice with its options: order == rows
    "#);
    // Where a number or a truth value belongs.
    assert_snapshot!(when("method"), @r#"
    passes/graph.ron:26:31: error: 'method' is a choice, no number, in 'method'
        |         (name: "paint", when: "method", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
        = help: compare a choice with its options: method == fast
    "#);
    assert_snapshot!(when("bright || max(cells, exact) > 2"), @r#"
    passes/graph.ron:26:31: error: 'exact' is an option of 'method', no number, in 'bright || max(cells, exact) > 2'
        |         (name: "paint", when: "bright || max(cells, exact) > 2", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
        = help: compare a choice with its options: method == exact
    "#);
    assert_snapshot!(when("select(bright, method, 1) > 0"), @r#"
    passes/graph.ron:26:31: error: 'method' is a choice, no number, in 'select(bright, method, 1) > 0'
        |         (name: "paint", when: "select(bright, method, 1) > 0", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
        = help: compare a choice with its options: method == fast
    "#);
    // A choice that could not be read is told, and nothing about who uses it.
    assert_snapshot!(graph("options: [\"fast\", \"exact\"], help", "options: [\"fast\", \"exact\"], halp"), @r#"
    passes/graph.ron:5:60: error: unknown field 'halp'
        |         Choice(name: "method", options: ["fast", "exact"], halp: "How fragments are found."),
        = help: did you mean 'help'?
    "#);
}

/// Named values in the graph, one of which is used.
#[track_caller]
fn values(text: &str) -> String {
    let bench = bench().edit(
        "passes/graph.ron",
        "    textures: {",
        &format!("    values: {{ {text} }},\n    textures: {{"),
    );
    bench
        .edit("passes/graph.ron", "\"cells * 16\"", "\"bytes\"")
        .findings()
}

#[test]
fn named_values() {
    assert_eq!(
        values(r#""bytes": Int("row * 16"), "row": Float("cells / 2")"#),
        ""
    );
    // Circles: of one, of two beside one that only needs them.
    assert_snapshot!(values(r#""bytes": Int("max(bytes, 16)")"#), @r#"
    passes/graph.ron:9:28: error: value 'bytes' needs itself
        |     values: { "bytes": Int("max(bytes, 16)") },
    "#);
    assert_snapshot!(values(r#""bytes": Int("row * 4"), "row": Int("column + 1"), "column": Int("row + cells")"#), @r#"
    passes/graph.ron:9:51: error: value 'row' needs itself: 'row' needs 'column' needs 'row'
        |     values: { "bytes": Int("row * 4"), "row": Int("column + 1"), "column": Int("row + cells") },
    passes/graph.ron:9:80: error: value 'column' needs itself: 'column' needs 'row' needs 'column'
        |     values: { "bytes": Int("row * 4"), "row": Int("column + 1"), "column": Int("row + cells") },
    "#);
    // Names that are taken, or none.
    assert_snapshot!(values(r#""bytes": Int("16"), "cells": Int("2"), "fast": Int("3"), "width": Int("4")"#), @r#"
    passes/graph.ron:9:35: error: value 'cells' has the name of a parameter
        |     values: { "bytes": Int("16"), "cells": Int("2"), "fast": Int("3"), "width": Int("4") },
    passes/graph.ron:9:54: error: value 'fast' has the name of an option, which expressions could not tell apart
        |     values: { "bytes": Int("16"), "cells": Int("2"), "fast": Int("3"), "width": Int("4") },
    passes/graph.ron:9:72: error: 'width' is a variable that every graph has
        |     values: { "bytes": Int("16"), "cells": Int("2"), "fast": Int("3"), "width": Int("4") },
    "#);
    assert_snapshot!(values(r#""bytes": Int("16"), "Row": Int("2"), "bytes": Int("8")"#), @r#"
    passes/graph.ron:9:35: error: 'Row' cannot be a value's name: letters, digits and underscores, starting with a lower-case letter
        |     values: { "bytes": Int("16"), "Row": Int("2"), "bytes": Int("8") },
    passes/graph.ron:9:52: error: 'bytes' stands twice
        |     values: { "bytes": Int("16"), "Row": Int("2"), "bytes": Int("8") },
    "#);
    assert_snapshot!(values(r#""bytes": Int("16 * half"), "half": Float("1 / 2.0")"#), @r#"
    passes/graph.ron:9:42: error: 'half' cannot be a value's name: GLSL refuses `float half;`
        |     values: { "bytes": Int("16 * half"), "half": Float("1 / 2.0") },
    "#);
    // What they read and what comes out.
    assert_snapshot!(values(r#""bytes": Int("cell * 16")"#), @r#"
    passes/graph.ron:9:28: error: unknown variable 'cell' in 'cell * 16'
        |     values: { "bytes": Int("cell * 16") },
        = help: did you mean 'cells'?
    "#);
    assert_snapshot!(values(r#""bytes": Int("16 * (mip + 1)")"#), @r#"
    passes/graph.ron:9:28: error: value 'bytes' reads 'mip', which differs within a frame
        |     values: { "bytes": Int("16 * (mip + 1)") },
    "#);
    assert_snapshot!(values(r#""bytes": Int("row * 16"), "row": Float("cells / 0.0")"#), @r#"
    passes/graph.ron:9:54: error: value 'row', 'cells / 0.0': the result is inf
        |     values: { "bytes": Int("row * 16"), "row": Float("cells / 0.0") },
    "#);
    assert_snapshot!(values(r#""bytes": Int("cells * 1e9")"#), @r#"
    passes/graph.ron:9:28: error: value 'bytes', 'cells * 1e9': 64000000000 does not fit 32 bits
        |     values: { "bytes": Int("cells * 1e9") },
    "#);
    assert_snapshot!(values(r#""bytes": Int("16"), "row": Float("cells")"#), @r#"
    passes/graph.ron:9:35: warning: value 'row' is declared and never used
        |     values: { "bytes": Int("16"), "row": Float("cells") },
    "#);
    // Kinds that there are not.
    assert_snapshot!(values(r#""bytes": Bool("bright")"#), @r#"
    passes/graph.ron:9:24: error: unknown name 'Bool'
        |     values: { "bytes": Bool("bright") },
        = help: known: Float, Int, Signature
    "#);
    assert_snapshot!(values(r#""bytes": "cells * 8""#), @r#"
    passes/graph.ron:9:24: error: Expected identifier
        |     values: { "bytes": "cells * 8" },
    "#);
}

#[test]
fn two_things_of_one_name() {
    assert_snapshot!(graph("\"count\": (size", "\"grid\": (size"), @r#"
    passes/graph.ron:11:9: error: 'grid' stands twice
        |         "grid": (size: ("cells", "cells"), format: "r32ui", views: ["r32i"]),
    "#);
    assert_snapshot!(graph("\"work\": (size", "\"depth\": (size"), @r#"
    passes/graph.ron:16:9: error: resource 'depth' is declared twice
        |         "depth": (size: "cells * 16", indirect: true),
    passes/graph.ron:20:67: error: no buffer is named 'work'
        |         (name: "fill", shaders: ["fill.comp"], dispatch: Indirect("work.groups")),
        = help: known: depth
    "#);
    assert_snapshot!(graph("name: \"bright\"", "name: \"cells\""), @r#"
    passes/graph.ron:7:20: error: parameter 'cells' is declared twice
        |         Bool(name: "cells", default: false, help: "Twice the light."),
    "#);
    assert_snapshot!(graph("name: \"bright\"", "name: \"level\""), @r#"
    passes/graph.ron:7:20: error: parameter 'level' is declared twice
        |         Bool(name: "level", default: false, help: "Twice the light."),
    "#);
    assert_snapshot!(graph("name: \"reduce\"", "name: \"fill\""), @r#"
    passes/graph.ron:21:16: error: two passes are named 'fill'; timings could not tell them apart
        |         (name: "fill", each_mip: (texture: "grid", from: 1), shaders: ["reduce.comp"], dispatch: Cover("dst"),
    "#);
    assert_snapshot!(graph("\"work\": (size", "\"camera\": (size"), @r#"
    passes/graph.ron:16:9: error: 'camera' is a resource that every scene offers; choose another name
        |         "camera": (size: "cells * 16", indirect: true),
    passes/graph.ron:20:67: error: no buffer is named 'work'
        |         (name: "fill", shaders: ["fill.comp"], dispatch: Indirect("work.groups")),
        = help: known: camera
    "#);
    assert_snapshot!(graph("\"dst\": (of: \"grid\", mip: \"mip\")", "\"src\": (of: \"grid\", mip: \"mip\")"), @r#"
    passes/graph.ron:21:106: error: no texture is named 'dst'
        |         (name: "reduce", each_mip: (texture: "grid", from: 1), shaders: ["reduce.comp"], dispatch: Cover("dst"),
        = help: known: count, depth, grid, picture
    passes/graph.ron:22:58: error: 'src' stands twice
        |             bind: { "src": (of: "grid", mip: "mip - 1"), "src": (of: "grid", mip: "mip") }),
    "#);
    assert_snapshot!(graph("options: [\"fast\", \"exact\"]", "options: [\"fast\", \"fast\"]"), @r#"
    passes/graph.ron:5:50: error: option 'fast' stands twice
        |         Choice(name: "method", options: ["fast", "fast"], help: "How fragments are found."),
    "#);
}

#[test]
fn parameters() {
    assert_snapshot!(graph("default: 64", "default: 1024"), @r#"
    passes/graph.ron:4:9: error: default of 'cells': 1024 is outside 16 to 512
        |         Int(name: "cells", default: 1024, range: (16, 512), help: "Edge of the grid."),
    "#);
    assert_snapshot!(graph("default: 64", "default: 64, plain: 8"), @r#"
    passes/graph.ron:4:9: error: plain value of 'cells': 8 is outside 16 to 512
        |         Int(name: "cells", default: 64, plain: 8, range: (16, 512), help: "Edge of the grid."),
    "#);
    assert_snapshot!(graph("default: 64, ", ""), @r#"
    passes/graph.ron:4:9: error: parameter 'cells' has no default
        |         Int(name: "cells", range: (16, 512), help: "Edge of the grid."),
    "#);
    assert_snapshot!(graph("default: 64", "default: 64.5"), @r#"
    passes/graph.ron:4:39: error: expected a comma
        |         Int(name: "cells", default: 64.5, range: (16, 512), help: "Edge of the grid."),
        = help: one is missing before this, or a whole number has a point
    "#);
    assert_snapshot!(graph("range: (16, 512)", "range: (512, 16)"), @r#"
    passes/graph.ron:4:9: error: parameter 'cells': its range goes from 512 to 16, which holds nothing
        |         Int(name: "cells", default: 64, range: (512, 16), help: "Edge of the grid."),
    "#);
    assert_snapshot!(graph("options: [\"fast\", \"exact\"]", "default: \"slow\", options: [\"fast\", \"exact\"]"), @r#"
    passes/graph.ron:5:9: error: default of 'method' has no option 'slow' (known: exact, fast)
        |         Choice(name: "method", default: "slow", options: ["fast", "exact"], help: "How fragments are found."),
    "#);
    assert_snapshot!(graph("options: [\"fast\", \"exact\"]", "options: [\"fast\", \"cells\"]"), @r#"
    passes/graph.ron:5:50: error: option 'cells' has the name of a parameter or variable, which expressions could not tell apart
        |         Choice(name: "method", options: ["fast", "cells"], help: "How fragments are found."),
    "#);
    assert_snapshot!(graph("options: [\"fast\", \"exact\"]", "options: [\"fast\", \"very exact\"]"), @r#"
    passes/graph.ron:5:50: error: 'very exact' cannot be an option's name
        |         Choice(name: "method", options: ["fast", "very exact"], help: "How fragments are found."),
        = help: letters, digits and underscores, starting with a lower-case letter
    "#);
    assert_snapshot!(graph("options: [\"fast\", \"exact\"], ", ""), @r#"
    passes/graph.ron:5:9: error: choice 'method' has no options
        |         Choice(name: "method", help: "How fragments are found."),
    passes/graph.ron:25:31: error: unknown variable 'fast' in 'method == fast'
        |         (name: "paint", when: "method == fast", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
    "#);
    assert_snapshot!(graph(", help: \"Edge of the grid.\"", ""), @r#"
    passes/graph.ron:4:57: error: field 'help' is missing
        |         Int(name: "cells", default: 64, range: (16, 512)),
    "#);
    assert_snapshot!(graph("help: \"Edge of the grid.\"", "help: \" \""), @r#"
    passes/graph.ron:4:9: error: parameter 'cells' needs one line of help
        |         Int(name: "cells", default: 64, range: (16, 512), help: " "),
    "#);
    assert_snapshot!(graph("name: \"bright\"", "name: \"is-bright\""), @r#"
    passes/graph.ron:7:20: error: 'is-bright' cannot be a parameter's name
        |         Bool(name: "is-bright", default: false, help: "Twice the light."),
        = help: letters, digits and underscores, starting with a lower-case letter
    "#);
    assert_snapshot!(graph("name: \"bright\"", "name: \"width\""), @r#"
    passes/graph.ron:7:20: error: 'width' is a variable that every graph has
        |         Bool(name: "width", default: false, help: "Twice the light."),
    "#);
    assert_snapshot!(graph("name: \"bright\"", "name: \"sample\""), @r#"
    passes/graph.ron:7:20: error: 'sample' cannot be a parameter's name: GLSL refuses `bool sample;`
        |         Bool(name: "sample", default: false, help: "Twice the light."),
    "#);
    assert_snapshot!(
        graph("Bool(name: \"bright\", default: false", "Vec3(name: \"bright\", constant: true, default: (0, 0, 0)"),
        @r#"
        passes/graph.ron:7:9: error: parameter 'bright': a vector cannot be a constant
            |         Vec3(name: "bright", constant: true, default: (0, 0, 0), help: "Twice the light."),
        "#
    );
}

#[test]
fn passes_of_two_kinds_and_of_none() {
    assert_snapshot!(graph("shaders: [\"prepare.comp\"], dispatch: Groups(1, 1, 1)", "stage: \"later\""), @r#"
    passes/graph.ron:19:9: error: pass 'prepare' does nothing: give it dispatch, draw or clear
        |         (name: "prepare", stage: "later"),
    "#);
    assert_snapshot!(graph("dispatch: Groups(1, 1, 1)", "dispatch: Groups(1, 1, 1), clear: \"work\""), @r#"
    passes/graph.ron:19:9: error: pass 'prepare' does several things: dispatch, draw and clear exclude each other
        |         (name: "prepare", shaders: ["prepare.comp"], dispatch: Groups(1, 1, 1), clear: "work"),
    passes/graph.ron:19:9: error: pass 'prepare' clears: it takes no shaders
        |         (name: "prepare", shaders: ["prepare.comp"], dispatch: Groups(1, 1, 1), clear: "work"),
    "#);
    assert_snapshot!(graph("shaders: [\"prepare.comp\"], ", ""), @r#"
    passes/graph.ron:19:9: error: pass 'prepare' dispatches: it needs one .comp shader and no other
        |         (name: "prepare", dispatch: Groups(1, 1, 1)),
    "#);
    assert_snapshot!(graph("[\"prepare.comp\"]", "[\"full.vert\"]"), @r#"
    passes/graph.ron:19:9: error: pass 'prepare' dispatches: it needs one .comp shader and no other
        |         (name: "prepare", shaders: ["full.vert"], dispatch: Groups(1, 1, 1)),
    "#);
    assert_snapshot!(graph("[\"full.vert\", \"scatter.frag\"]", "[\"scatter.frag\"]"), @r#"
    passes/graph.ron:23:9: error: pass 'scatter' draws: it needs a .vert shader and no .comp
        |         (name: "scatter", shaders: ["scatter.frag"], draw: Fullscreen,
    "#);
    assert_snapshot!(graph("[\"full.vert\", \"scatter.frag\"]", "[\"full.vert\", \"scatter.frag\", \"paint.frag\"]"), @r#"
    passes/graph.ron:23:66: error: pass 'scatter' has two Fragment shaders
        |         (name: "scatter", shaders: ["full.vert", "scatter.frag", "paint.frag"], draw: Fullscreen,
    "#);
    assert_snapshot!(graph("(name: \"scatter\", ", "(name: \"scatter\", topology: patches, "), @r#"
    passes/graph.ron:23:9: error: pass 'scatter': patches need both a .tesc and a .tese shader, and they need patches
        |         (name: "scatter", topology: patches, shaders: ["full.vert", "scatter.frag"], draw: Fullscreen,
    "#);
    assert_snapshot!(graph("each_mip: (texture: \"grid\", from: 1)", "each_mip: (texture: \"grid\", from: 1), repeat: 2"), @r#"
    passes/graph.ron:21:9: error: pass 'reduce' has both repeat and each_mip
        |         (name: "reduce", each_mip: (texture: "grid", from: 1), repeat: 2, shaders: ["reduce.comp"], dispatch: Cover("dst"),
    "#);
}

#[test]
fn attachments() {
    assert_snapshot!(graph("(to: \"picture\", clear", "(to: \"depth\", clear"), @r#"
    passes/graph.ron:27:26: error: 'depth' is a depth texture and cannot be a colour attachment
        |             color: [(to: "depth", clear: (0, 0, 0, 1))], depth: (to: "depth", clear: 1.0)),
    "#);
    assert_snapshot!(graph("depth: (to: \"depth\"", "depth: (to: \"picture\""), @r#"
    passes/graph.ron:27:72: error: 'picture' is no depth texture (d32 or d16)
        |             color: [(to: "picture", clear: (0, 0, 0, 1))], depth: (to: "picture", clear: 1.0)),
    "#);
    assert_snapshot!(graph("\"depth\": (size: (\"width\", \"height\")", "\"depth\": (size: (\"width\", \"height / 2\")"), @r#"
    passes/graph.ron:27:72: error: attachments differ in size: 64x48 and 64x24
        |             color: [(to: "picture", clear: (0, 0, 0, 1))], depth: (to: "depth", clear: 1.0)),
    "#);
    assert_snapshot!(graph("clear: (0, 0, 0, 1))]", "clear: (0, 0, 0, 1), mip: 1)]"), @r#"
    passes/graph.ron:27:26: error: mip 1 or layer 0 does not exist
        |             color: [(to: "picture", clear: (0, 0, 0, 1), mip: 1)], depth: (to: "depth", clear: 1.0)),
    "#);
    assert_snapshot!(graph("(to: \"picture\", clear", "(to: \"grid\", clear"), @r#"
    passes/graph.ron:27:26: error: 'grid' is 3D and cannot be an attachment; write to it as an image
        |             color: [(to: "grid", clear: (0, 0, 0, 1))], depth: (to: "depth", clear: 1.0)),
    "#);
    assert_snapshot!(graph("raster: (size: (\"cells\", \"cells\"), samples: \"4\")", "raster: ()"), @r#"
    passes/graph.ron:23:9: error: pass 'scatter' draws without attachments: give raster: (size: ("w", "h"))
        |         (name: "scatter", shaders: ["full.vert", "scatter.frag"], draw: Fullscreen,
    "#);
    assert_snapshot!(graph("depth: (to: \"depth\", clear: 1.0)", "raster: (samples: 4)"), @r#"
    passes/graph.ron:25:9: error: pass 'paint': samples are for drawing without attachments
        |         (name: "paint", when: "method == fast", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
    "#);
    assert_snapshot!(graph("depth: (to: \"depth\", clear: 1.0)", "raster: (size: (64, 64))"), @r#"
    passes/graph.ron:27:75: error: pass 'paint' has attachments: its size is theirs
        |             color: [(to: "picture", clear: (0, 0, 0, 1))], raster: (size: (64, 64))),
    "#);
    assert_snapshot!(
        graph("\"last\": (of: \"picture\", history: true)", "\"last\": (of: \"picture\")"),
        @r#"
        passes/graph.ron:25:16: error: pass 'paint' uses 'picture' in two ways at once (Sampled and Color)
            |         (name: "paint", when: "method == fast", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
        "#
    );
}

#[test]
fn what_must_be_declared_first() {
    assert_snapshot!(graph(", indirect: true", ""), @r#"
    passes/graph.ron:20:67: error: buffer 'work' is not declared with `indirect: true`
        |         (name: "fill", shaders: ["fill.comp"], dispatch: Indirect("work.groups")),
    "#);
    assert_snapshot!(graph("format: \"rgba16f\", history: true", "format: \"rgba16f\""), @r#"
    passes/graph.ron:26:34: error: 'picture' is not declared with `history: true`
        |             bind: { "last": (of: "picture", history: true) },
    "#);
    assert_snapshot!(
        graph("bind: { \"last\"", "bind: { \"count\": (of: \"count\", as: \"rgba8\"), \"last\""),
        @r#"
        passes/graph.ron:26:48: error: 'count' is not declared to be viewed as 'rgba8'
            |             bind: { "count": (of: "count", as: "rgba8"), "last": (of: "picture", history: true) },
            = help: declare it: views: ["rgba8"]
        "#
    );
    assert_snapshot!(graph("views: [\"r32i\"]", "views: [\"rg32f\"]"), @r#"
    passes/graph.ron:11:70: error: 'count' has texels of 4 bytes and cannot be viewed as 'rg32f' of 8
        |         "count": (size: ("cells", "cells"), format: "r32ui", views: ["rg32f"]),
    "#);
    assert_snapshot!(graph("\"work\": (size: \"cells * 16\"", "\"work\": (size: 8"), @r#"
    passes/graph.ron:20:67: error: a command of 12 bytes at byte 0 ends outside 'work', which has 8 bytes
        |         (name: "fill", shaders: ["fill.comp"], dispatch: Indirect("work.groups")),
    "#);
}

#[test]
fn includes_of_graphs() {
    assert_snapshot!(
        bench().edit("passes/shared.ron", "(\n    params", "(\n    include: [\"graph.ron\"],\n    params").findings(),
        @r#"
        passes/shared.ron:2:15: error: 'passes/graph.ron' includes itself: graph.ron > shared.ron > graph.ron
            |     include: ["graph.ron"],
        "#
    );
    assert_snapshot!(graph("\"shared.ron\"", "\"share.ron\""), @r#"
    passes/graph.ron:2:15: error: cannot read it: No such file or directory (os error 2)
        |     include: ["share.ron"],
        = help: did you mean 'shared.ron'?
    "#);
    // A mistake in an included file is told with that file's name.
    assert_snapshot!(bench().edit("passes/shared.ron", "default: 0.5", "default: 5").findings(), @r#"
    passes/shared.ron:3:9: error: default of 'level': 5 is outside 0 to 1
        |         Float(name: "level", default: 5, range: (0.0, 1.0), help: "Brightness."),
    "#);
}

#[test]
fn texts_of_shaders() {
    assert_snapshot!(shader("fill.comp", "light());", "light()"), @r"
    shaders/fill.comp:6: error: '' :  syntax error, unexpected RIGHT_BRACE, expecting RIGHT_PAREN or COMMA
        | void main() { imageStore(grid, ivec3(gl_GlobalInvocationID), light() }
    ");
    assert_snapshot!(shader("light.glsl", "params.level *", "params.levle *"), @r"
    shaders/light.glsl:3: error: 'levle' : no such field in structure 'params'
        | return vec4(params.levle * (params.bright ? 2.0 : 1.0));
        = help: did you mean 'level'?
    ");
    assert_snapshot!(shader("light.glsl", "vec4 light", "vec3 light"), @r"
    shaders/light.glsl:3: error: 'return' : cannot convert return value to function return type
        | return vec4(params.level * (params.bright ? 2.0 : 1.0));
    shaders/fill.comp:6: error: 'imageStore' : no matching overloaded function found
        | void main() { imageStore(grid, ivec3(gl_GlobalInvocationID), light()); }
    ");
    assert_snapshot!(shader("fill.comp", "light.glsl", "lihgt.glsl"), @r#"
    shaders/fill.comp:3: error: '#include' : no such include; did you mean 'light.glsl'? for header name: lihgt.glsl
        | #include "lihgt.glsl"
    "#);
    assert_snapshot!(shader("fill.comp", "#extension GL_GOOGLE_include_directive : require\n", ""), @"");
    assert_snapshot!(shader("prepare.comp", "#version 460\n", ""), @r#"
    passes/graph.ron:19:37: error: shader 'prepare.comp' has no line `#version 460`, which must be its first
        |         (name: "prepare", shaders: ["prepare.comp"], dispatch: Groups(1, 1, 1)),
    "#);
    assert_snapshot!(shader("light.glsl", "#include", "#include \"light.glsl\"\n#include"), @r#"
    shaders/light.glsl:1: error: '#include' : too many includes (4096 at most, 32 of them nested): light.glsl > light.glsl > light.glsl > light.glsl > ... > light.glsl > light.glsl > light.glsl for header name: light.glsl
        | #include "light.glsl"
    "#);
    assert_snapshot!(shader("prepare.comp", "void main()", "void other()"), @r"
    shaders/prepare.comp: error: compilation error:
    prepare.comp: error: Linking compute stage: Missing entry point: Each stage requires one entry point
    ");
    // The same mistake in an include of two shaders is told once.
    assert_snapshot!(
        bench()
            .edit("shaders/reduce.comp", "#version 460", "#version 460\n#extension GL_GOOGLE_include_directive : require\n#include \"light.glsl\"")
            .edit("shaders/light.glsl", "return vec4(", "return vec5(")
            .findings(),
        @r"
    shaders/light.glsl:3: error: 'vec5' : no matching overloaded function found
        | return vec5(params.level * (params.bright ? 2.0 : 1.0));
        = help: did you mean 'vec4'?
    "
    );
}

#[test]
fn an_unknown_name_in_a_shader_is_one_error_with_the_name_that_is_meant() {
    const LEVEL: &str = "params.level * (params.bright ? 2.0 : 1.0)";
    let light = |new: &str| shader("light.glsl", LEVEL, new);
    // A function, of a file and of GLSL; the vector has too few values then.
    assert_snapshot!(shader("fill.comp", "light()", "lihgt()"), @r"
    shaders/fill.comp:6: error: 'lihgt' : no matching overloaded function found
        | void main() { imageStore(grid, ivec3(gl_GlobalInvocationID), lihgt()); }
        = help: did you mean 'light'?
    ");
    assert_snapshot!(light("vec2(0.0), clmap(params.level, 0.0, 1.0)"), @r"
    shaders/light.glsl:3: error: 'clmap' : no matching overloaded function found
        | return vec4(vec2(0.0), clmap(params.level, 0.0, 1.0));
        = help: did you mean 'clamp'?
    ");
    // A variable, a parameter without its block, and a built-in one.
    assert_snapshot!(shader("fill.comp", "imageStore(grid, ivec3(gl_GlobalInvocationID)", "imageStore(gird, ivec3(gl_GlobalInvocatoinID)"), @r"
    shaders/fill.comp:6: error: 'gird' : undeclared identifier
        | void main() { imageStore(gird, ivec3(gl_GlobalInvocatoinID), light()); }
        = help: did you mean 'grid'?
    shaders/fill.comp:6: error: 'gl_GlobalInvocatoinID' : undeclared identifier
        | void main() { imageStore(gird, ivec3(gl_GlobalInvocatoinID), light()); }
        = help: did you mean 'gl_GlobalInvocationID'?
    ");
    assert_snapshot!(light("levle"), @r"
    shaders/light.glsl:3: error: 'levle' : undeclared identifier
        | return vec4(levle);
        = help: did you mean 'params.level'?
    ");
    // The statement spans lines, and a later one uses the unknown variable.
    assert_snapshot!(shader("light.glsl", "    return", "    float a = max(\n        brigth,\n        vec2(1));\n    vec3 b = brigth.xyz;\n    return"), @r"
    shaders/light.glsl:4: error: 'brigth' : undeclared identifier
        | brigth,
        = help: did you mean 'params.bright'?
    ");
    // A second mistake stays.
    assert_snapshot!(shader("light.glsl", "    return", "    vec3 a = nonesuch(1.0) + vec2(1);\n    vec3 b = vec2(2);\n    return"), @r"
    shaders/light.glsl:3: error: 'nonesuch' : no matching overloaded function found
        | vec3 a = nonesuch(1.0) + vec2(1);
    shaders/light.glsl:4: error: '=' :  cannot convert from ' const 2-component vector of float' to ' temp highp 3-component vector of float'
        | vec3 b = vec2(2);
    ");
}

#[test]
fn what_shaders_bind() {
    assert_snapshot!(shader("fill.comp", "image3D grid;\nvoid main() { imageStore(grid", "image3D gird;\nvoid main() { imageStore(gird"), @r"
    shaders/fill.comp:5: error: 'gird' is an image3D without a format that neither the graph nor the scene declares (pass 'fill')
        | uniform writeonly image3D gird;
        = help: did you mean 'grid'?
    ");
    assert_snapshot!(shader("fill.comp", "image3D grid;\nvoid main() { imageStore(grid", "image3D elsewhere;\nvoid main() { imageStore(elsewhere"), @r#"
    shaders/fill.comp:5: error: 'elsewhere' is an image3D without a format that neither the graph nor the scene declares (pass 'fill')
        | uniform writeonly image3D elsewhere;
        = help: declare it in the graph, or rename it: bind: {"elsewhere": (of: "...")}
    "#);
    assert_snapshot!(
        shader("paint.frag", "uniform sampler3D grid;", "uniform sampler2D grid;\n#define ivec3 ivec2"),
        @r"
        shaders/paint.frag:2: error: 'grid' is 3D, and the shader declares a sampler2D (pass 'paint')
            | uniform sampler2D grid;
            = help: declare it as 3D
        "
    );
    assert_snapshot!(
        shader("scatter.frag", "layout(r32ui) uniform uimage2D count;", "layout(r32i) uniform iimage2D count;\n#define imageAtomicAdd(a, b, c) imageAtomicAdd(a, b, int(c))"),
        @r"
        shaders/scatter.frag:2: error: 'count' has format r32ui, and the shader declares r32i (pass 'scatter')
            | layout(r32i) uniform iimage2D count;
            = help: write layout(r32ui), or bind it as another declared view
        "
    );
    assert_snapshot!(shader("fill.comp", "uniform writeonly image3D", "layout(rgba8) uniform writeonly image3D"), @r"
    shaders/fill.comp:5: error: 'grid' has format grid_format, and the shader declares rgba8 (pass 'fill')
        | layout(rgba8) uniform writeonly image3D grid;
        = help: its format is a choice: write to a `writeonly` image without a format, and read by sampler
    ");
    assert_snapshot!(shader("paint.frag", "usampler2D count", "sampler2D count"), @r"
    shaders/paint.frag:3: error: 'count' has format r32ui, and the shader declares a sampler2D (pass 'paint')
        | uniform sampler2D count;
        = help: declare a usampler
    ");
    assert_snapshot!(shader("paint.frag", "uniform sampler2D last", "uniform usampler2D last"), @r"
    shaders/paint.frag:4: error: 'picture' has format rgba16f, and the shader declares a usampler2D (pass 'paint')
        | uniform usampler2D last;
        = help: declare a sampler
    ");
    assert_snapshot!(
        bench()
            .edit("shaders/paint.frag", "uniform sampler2D last;", "uniform sampler2DShadow last;")
            .edit("shaders/paint.frag", "texelFetch(last, ivec2(0), 0)", "texture(last, vec3(0))")
            .findings(),
        @r"
        shaders/paint.frag:4: error: the sampler of 'picture' does not fit: the shader declares a sampler2DShadow (pass 'paint')
            | uniform sampler2DShadow last;
            = help: bind it with sampler: (compare: less_or_equal)
        "
    );
    assert_snapshot!(
        graph("history: true) }", "history: true, sampler: (compare: less)) }"),
        @r"
        shaders/paint.frag:4: error: the sampler of 'picture' does not fit: the shader declares a sampler2D (pass 'paint')
            | uniform sampler2D last;
            = help: declare a Shadow sampler, or bind it with a sampler that does not compare
        "
    );
    assert_snapshot!(
        bench().add("shaders/prepare.comp", &PREPARE.replace("work", "count")).findings(),
        @r#"
    shaders/prepare.comp:2: error: 'count' is a texture, and the shader declares a buffer that it writes (pass 'prepare')
        | layout(std430) writeonly buffer Work { uvec3 groups; uint words[]; } count;
    passes/graph.ron:20:67: error: no shader declares 'work', so its members have no place
        |         (name: "fill", shaders: ["fill.comp"], dispatch: Indirect("work.groups")),
    "#
    );
    assert_snapshot!(
        bench()
            .edit("shaders/fill.comp", "uniform writeonly image3D grid;", "uniform writeonly image3D grid;\nlayout(std430) buffer Lights { uint n; } lights;")
            .edit("shaders/fill.comp", "{ imageStore", "{ lights.n = 1; imageStore")
            .findings(),
        @r"
        shaders/fill.comp:6: error: 'lights' is a read-only buffer of the scene, and the shader declares a buffer that it writes (pass 'fill')
            | layout(std430) buffer Lights { uint n; } lights;
        "
    );
    assert_snapshot!(shader("paint.frag", "uniform sampler2D last;", "uniform sampler2D last[2];\n#define last last[0]"), @"shaders/paint.frag: error: 'last' is an array of resources; bind them one by one, with names of their own");
}

#[test]
fn outputs_of_fragment_shaders() {
    assert_snapshot!(
        bench()
            .edit("shaders/paint.frag", "out vec4 color;", "out vec4 color;\nlayout(location = 1) out vec4 extra;")
            .edit("shaders/paint.frag", "    color =", "    extra = vec4(1);\n    color =")
            .findings(),
        @r#"
        passes/graph.ron:25:16: error: 'paint.frag' writes location 1, but pass 'paint' declares 1 colour attachments
            |         (name: "paint", when: "method == fast", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
        "#
    );
    assert_snapshot!(graph("clear: (0, 0, 0, 1))]", "clear: (0, 0, 0, 1)), (to: \"count\")]"), @r#"
    passes/graph.ron:27:59: error: pass 'paint' declares 'count' as colour 1, but 'paint.frag' does not write that location
        |             color: [(to: "picture", clear: (0, 0, 0, 1)), (to: "count")], depth: (to: "depth", clear: 1.0)),
    "#);
    assert_snapshot!(graph("[\"full.vert\", \"paint.frag\"]", "[\"full.vert\"]"), @r#"
    passes/graph.ron:26:21: error: no shader of pass 'paint' uses the name 'last'
        |             bind: { "last": (of: "picture", history: true) },
    passes/graph.ron:27:21: error: pass 'paint' has colour attachments and no .frag shader that writes them
        |             color: [(to: "picture", clear: (0, 0, 0, 1))], depth: (to: "depth", clear: 1.0)),
    "#);
}

#[test]
fn keys_of_bind_that_no_shader_uses() {
    assert_snapshot!(graph("\"src\": (of", "\"srcs\": (of"), @r#"
    shaders/reduce.comp:3: error: 'src' is a sampler3D that neither the graph nor the scene declares (pass 'reduce')
        | uniform sampler3D src;
        = help: did you mean 'srcs'?
    passes/graph.ron:22:21: error: no shader of pass 'reduce' uses the name 'srcs'
        |             bind: { "srcs": (of: "grid", mip: "mip - 1"), "dst": (of: "grid", mip: "mip") }),
        = help: did you mean 'src'?
    "#);
    assert_snapshot!(graph("\"last\": (of", "\"previous\": (of"), @r#"
    shaders/paint.frag:4: error: 'last' is a sampler2D that neither the graph nor the scene declares (pass 'paint')
        | uniform sampler2D last;
        = help: declare it in the graph, or rename it: bind: {"last": (of: "...")}
    passes/graph.ron:26:21: error: no shader of pass 'paint' uses the name 'previous'
        |             bind: { "previous": (of: "picture", history: true) },
        = help: known: count, grid, last
    "#);
    assert_snapshot!(graph("bind: { \"src\": (of: \"grid\", mip: \"mip - 1\")", "bind: { \"src\": (of: \"work\", mip: \"mip - 1\")"), @r#"
    passes/graph.ron:22:33: error: 'work' is a buffer: it has no mip, format or sampler
        |             bind: { "src": (of: "work", mip: "mip - 1"), "dst": (of: "grid", mip: "mip") }),
    "#);
}

#[test]
fn declared_and_never_used() {
    assert_snapshot!(
        graph("buffers: {", "buffers: {\n        \"spare\": (size: 64),"),
        @r#"
        passes/graph.ron:16:9: warning: 'spare' is declared and never used
            |         "spare": (size: 64),
        "#
    );
    assert_snapshot!(
        graph("textures: {", "textures: {\n        \"spare\": (size: (8, 8), format: \"r8\"),"),
        @r#"
        passes/graph.ron:10:9: warning: 'spare' is declared and never used
            |         "spare": (size: (8, 8), format: "r8"),
        "#
    );
    assert_snapshot!(
        graph("params: [", "params: [\n        Float(name: \"spare\", default: 1, help: \"Nothing.\"),"),
        @r#"
        passes/graph.ron:4:21: warning: parameter 'spare' is declared and never used
            |         Float(name: "spare", default: 1, help: "Nothing."),
        "#
    );
    // A longer name that begins the same way is not a use.
    assert_snapshot!(
        graph("params: [", "params: [\n        Float(name: \"lev\", default: 1, help: \"Nothing.\"),"),
        @r#"
        passes/graph.ron:4:21: warning: parameter 'lev' is declared and never used
            |         Float(name: "lev", default: 1, help: "Nothing."),
        "#
    );
}

#[test]
fn sizes() {
    assert_snapshot!(graph("mips: \"log2(cells) + 1\"", "mips: \"log2(cells) + 2\""), @r#"
    passes/graph.ron:10:9: error: 'grid' has 8 mips; [64, 64, 64] texels allow 7
        |         "grid": (size: ("cells", "cells", "cells"), format: "grid_format", mips: "log2(cells) + 2"),
    "#);
    assert_snapshot!(graph("\"count\": (size: (\"cells\", \"cells\")", "\"count\": (size: (\"cells - 64\", \"cells\")"), @r#"
    passes/graph.ron:11:26: error: size 'cells - 64' is 0, and must be at least 1
        |         "count": (size: ("cells - 64", "cells"), format: "r32ui", views: ["r32i"]),
    "#);
    assert_snapshot!(graph("\"count\": (size: (\"cells\", \"cells\")", "\"count\": (size: (\"cells\", \"0 - cells\")"), @r#"
    passes/graph.ron:11:35: error: size '0 - cells' is -64, and must be at least 1
        |         "count": (size: ("cells", "0 - cells"), format: "r32ui", views: ["r32i"]),
    "#);
    assert_snapshot!(graph("\"count\": (size: (\"cells\", \"cells\")", "\"count\": (size: (\"cells * 1000\", \"cells\")"), @r#"
    passes/graph.ron:11:26: error: 'count' is 64000 texels long; Test GPU allows 16384
        |         "count": (size: ("cells * 1000", "cells"), format: "r32ui", views: ["r32i"]),
    "#);
    assert_snapshot!(graph("\"grid\": (size: (\"cells\", ", "\"grid\": (size: (\"cells * 100\", "), @r#"
    passes/graph.ron:10:25: error: 'grid' is 6400 texels long; Test GPU allows 4096
        |         "grid": (size: ("cells * 100", "cells", "cells"), format: "grid_format", mips: "log2(cells) + 1"),
    "#);
    assert_snapshot!(graph("views: [\"r32i\"]", "views: [\"r32i\"], layers: 2"), @r"
    shaders/scatter.frag:2: error: 'count' is 2DArray, and the shader declares an image2D of format r32ui (pass 'scatter')
        | layout(r32ui) uniform uimage2D count;
        = help: declare it as 2DArray
    shaders/paint.frag:3: error: 'count' is 2DArray, and the shader declares a usampler2D (pass 'paint')
        | uniform usampler2D count;
        = help: declare it as 2DArray
    ");
    assert_snapshot!(graph("\"grid\": (size", "\"grid\": (layers: 2, size"), @r#"
    passes/graph.ron:10:9: error: 'grid' is 3D and cannot have layers
        |         "grid": (layers: 2, size: ("cells", "cells", "cells"), format: "grid_format", mips: "log2(cells) + 1"),
    "#);
    assert_snapshot!(graph("\"cells * 16\"", "\"cells * 100000000\""), @r#"
    passes/graph.ron:16:24: error: buffer 'work' is 6400000000 bytes; Test GPU allows 4 to 4294967295
        |         "work": (size: "cells * 100000000", indirect: true),
    "#);
    assert_snapshot!(graph("\"cells * 16\"", "0"), @r#"
    passes/graph.ron:16:24: error: buffer 'work' is 0 bytes; Test GPU allows 4 to 4294967295
        |         "work": (size: 0, indirect: true),
    "#);
    assert_snapshot!(graph("samples: \"4\"", "samples: \"3\""), @r#"
    passes/graph.ron:24:57: error: Test GPU has no rasterisation with 3 samples; it has 1, 2, 4, 8, 16
        |             raster: (size: ("cells", "cells"), samples: "3")),
    "#);
    assert_snapshot!(graph("raster: (size: (\"cells\", \"cells\")", "raster: (size: (\"cells * 1000\", \"cells\")"), @r#"
    passes/graph.ron:24:28: error: viewport 64000x64 is larger than the 16384 that Test GPU allows
        |             raster: (size: ("cells * 1000", "cells"), samples: "4")),
    "#);
    assert_snapshot!(graph("mip: \"mip - 1\"", "mip: \"mip + 1\""), @r#"
    passes/graph.ron:22:33: error: 'grid' has 7 mips, counted from 0, and no mip 7
        |             bind: { "src": (of: "grid", mip: "mip + 1"), "dst": (of: "grid", mip: "mip") }),
    "#);
    assert_snapshot!(graph("Groups(1, 1, 1)", "Groups(100000, 1, 1)"), @r#"
    passes/graph.ron:19:64: error: [100000, 1, 1] groups are more than the [65535, 65535, 65535] that Test GPU allows
        |         (name: "prepare", shaders: ["prepare.comp"], dispatch: Groups(100000, 1, 1)),
    "#);
    assert_snapshot!(graph("each_mip: (texture: \"grid\", from: 1)", "repeat: \"cells * 100\""), @r#"
    passes/graph.ron:21:34: error: repeat 'cells * 100' is 6400, more than 4096
        |         (name: "reduce", repeat: "cells * 100", shaders: ["reduce.comp"], dispatch: Cover("dst"),
    "#);
}

#[test]
fn what_no_device_can_do() {
    // Depth is cleared where it is attached; sRGB is no storage format.
    assert_snapshot!(graph("shaders: [\"prepare.comp\"], dispatch: Groups(1, 1, 1)", "clear: \"depth\""), @r#"
    passes/graph.ron:19:34: error: 'depth' is a depth texture: clear it where it is attached, depth: (clear: 1.0)
        |         (name: "prepare", clear: "depth"),
    "#);
    assert_snapshot!(
        bench()
            .edit("passes/graph.ron", "options: [\"rgba8\", \"rgba16f\"]", "options: [\"rgba8_srgb\", \"rgba16f\"]")
            .findings(),
        @r"
        shaders/fill.comp:5: error: 'grid' is sRGB-encoded, which a storage image cannot be (pass 'fill')
            | uniform writeonly image3D grid;
        shaders/reduce.comp:4: error: 'grid' is sRGB-encoded, which a storage image cannot be (pass 'reduce')
            | uniform writeonly image3D dst;
        "
    );
}

#[test]
fn what_this_device_lacks() {
    let conservative = || {
        bench()
            .edit(
                "passes/graph.ron",
                "(name: \"scatter\", ",
                "(name: \"scatter\", when: \"method == exact\", ",
            )
            .edit("passes/graph.ron", "when: \"method == fast\", ", "")
            .edit(
                "passes/graph.ron",
                "samples: \"4\"",
                "conservative: overestimate",
            )
            .edit(
                "configs/run.ron",
                "\"level\": 0.25,",
                "\"method\": \"exact\",",
            )
    };
    assert_snapshot!(conservative().findings(), @"");
    let mut without = conservative();
    without.device.name = String::from("Software rasteriser");
    without.device.features.conservative_rasterization = false;
    assert_snapshot!(without.findings(), @r#"
    passes/graph.ron:23:16: error: pass 'scatter' needs conservative rasterisation (VK_EXT_conservative_rasterization), which Software rasteriser does not have (it runs because method is exact)
        |         (name: "scatter", when: "method == exact", shaders: ["full.vert", "scatter.frag"], draw: Fullscreen,
        = help: use --set method=fast
    "#);
    // Not asked for, not missed.
    let without = without.edit("configs/run.ron", "\"exact\"", "\"fast\"");
    assert_snapshot!(without.findings(), @"");

    let mut without = bench();
    without.device.features.fragment_stores = false;
    without.device.features.write_without_format = false;
    assert_snapshot!(without.findings(), @r#"
    passes/graph.ron:20:16: error: pass 'fill' needs writing images without a format, which Test GPU does not have
        |         (name: "fill", shaders: ["fill.comp"], dispatch: Indirect("work.groups")),
    passes/graph.ron:21:16: error: pass 'reduce' needs writing images without a format, which Test GPU does not have
        |         (name: "reduce", each_mip: (texture: "grid", from: 1), shaders: ["reduce.comp"], dispatch: Cover("dst"),
    passes/graph.ron:23:16: error: pass 'scatter' needs stores from fragment shaders, which Test GPU does not have
        |         (name: "scatter", shaders: ["full.vert", "scatter.frag"], draw: Fullscreen,
    "#);

    // A buffer without a qualifier is read as long as nothing stores into it.
    let reads = |statement: &str| {
        let buffer =
            "layout(std430) buffer Work { uvec3 groups; uint words[]; } work;\nvoid main() { ";
        let mut bench = bench().edit(
            "shaders/full.vert",
            "void main() { ",
            &format!("{buffer}{statement} "),
        );
        bench.device.features.vertex_stores = false;
        bench.findings()
    };
    assert_eq!(reads("if (work.words[gl_VertexIndex] == 7u) return;"), "");
    assert_snapshot!(reads("if (atomicMax(work.words[gl_VertexIndex], 1u) == 7u) return;"), @r#"
    passes/graph.ron:23:16: error: pass 'scatter' needs stores from vertex, tessellation or geometry shaders, which Test GPU does not have
        |         (name: "scatter", shaders: ["full.vert", "scatter.frag"], draw: Fullscreen,
    passes/graph.ron:25:16: error: pass 'paint' needs stores from vertex, tessellation or geometry shaders, which Test GPU does not have (it runs because method is fast)
        |         (name: "paint", when: "method == fast", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
        = help: use --set method=exact
    "#);
}

#[test]
fn experiments() {
    assert_snapshot!(experiment("\"graph.ron\"", "\"graphs.ron\""), @r"
    passes/graphs.ron: error: cannot read it: No such file or directory (os error 2)
        = help: did you mean 'graph.ron'?
    ");
    assert_snapshot!(experiment("graph: \"graph.ron\",", ""), @r"
    configs/run.ron:8:1: error: field 'graph' is missing
        | )
    ");
    assert_snapshot!(experiment("scene:", "scenes:"), @r#"
    configs/run.ron:3:5: error: unknown field 'scenes'
        |     scenes: "triangles",
        = help: did you mean 'scene'?
    "#);
    assert_snapshot!(experiment("\"level\"", "\"levle\""), @r#"
    configs/run.ron:6:9: error: no parameter 'levle' (did you mean 'level'?)
        |         "levle": 0.25,
    "#);
    assert_snapshot!(experiment("0.25", "1.25"), @r#"
    configs/run.ron:6:9: error: 'level': 1.25 is outside 0 to 1
        |         "level": 1.25,
    "#);
    assert_snapshot!(experiment("0.25", "\"bright\""), @r#"
    configs/run.ron:6:9: error: 'level': expected a number, got "bright"
        |         "level": "bright",
    "#);
    assert_snapshot!(experiment("\"level\": 0.25", "\"method\": \"exakt\""), @r#"
    configs/run.ron:6:9: error: 'method' has no option 'exakt' (did you mean 'exact'?)
        |         "method": "exakt",
    "#);
    assert_snapshot!(experiment("\"level\": 0.25", "\"cells\": 64.5"), @r#"
    configs/run.ron:6:9: error: 'cells': expected a whole number, got 64.5
        |         "cells": 64.5,
    "#);
    assert_snapshot!(experiment("\"level\": 0.25", "\"level\": 0.25, \"level\": 0.5"), @r#"
    configs/run.ron:6:24: error: 'level' stands twice
        |         "level": 0.25, "level": 0.5,
    "#);
    assert_snapshot!(experiment("(64, 48)", "(64, 0)"), @r"
    configs/run.ron:4:11: error: a picture of 64x0 cannot be made: each side is 1 to 16384 pixels
        |     size: (64, 0),
    ");
    assert_snapshot!(experiment("(64, 48)", "(64, -48)"), @r"
    configs/run.ron:4:17: error: Integer is out of bounds
        |     size: (64, -48),
    ");
    assert_snapshot!(experiment("(64, 48)", "(64, 48), camera: (eye: (0, 0, 1), target: (0, 0, 0))"), @r"
    configs/run.ron:4:63: error: field 'fov_y' is missing
        |     size: (64, 48), camera: (eye: (0, 0, 1), target: (0, 0, 0)),
    ");
    let missing = bench();
    std::fs::remove_file(missing.path("configs/run.ron")).unwrap();
    assert_snapshot!(missing.findings(), @r"
    configs/run.ron: error: cannot read it: No such file or directory (os error 2)
        = help: give the path of an experiment, for example configs/rays.ron
    ");
}

#[test]
fn several_mistakes_are_told_at_once() {
    let graph = bench()
        .edit("passes/shared.ron", "default: 0.5", "default: 5")
        .edit("passes/graph.ron", "format: \"d32\"", "format: \"d24\"")
        .edit("passes/graph.ron", "raster: (size", "rater: (size")
        .edit("passes/graph.ron", "method == fast", "method == fats")
        .edit(
            "passes/graph.ron",
            "\"work\": (size: \"cells",
            "\"work\": (size: \"cell",
        );
    assert_snapshot!(graph.findings(), @r#"
    passes/graph.ron:13:54: error: no format is named 'd24'
        |         "depth": (size: ("width", "height"), format: "d24"),
    passes/graph.ron:16:24: error: unknown variable 'cell' in 'cell * 16'
        |         "work": (size: "cell * 16", indirect: true),
        = help: did you mean 'cells'?
    passes/graph.ron:24:13: error: unknown field 'rater'
        |             rater: (size: ("cells", "cells"), samples: "4")),
        = help: did you mean 'raster'?
    passes/graph.ron:25:31: error: unknown variable 'fats' in 'method == fats'
        |         (name: "paint", when: "method == fats", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
        = help: did you mean 'fast'?
    passes/shared.ron:3:9: error: default of 'level': 5 is outside 0 to 1
        |         Float(name: "level", default: 5, range: (0.0, 1.0), help: "Brightness."),
    "#);
    let shaders = bench()
        .edit("shaders/fill.comp", "light()", "ligth()")
        .edit("shaders/reduce.comp", "sampler3D", "sampler4D")
        .edit("shaders/paint.frag", "* float(", "* flaot(");
    assert_snapshot!(shaders.findings(), @r"
    shaders/fill.comp:6: error: 'ligth' : no matching overloaded function found
        | void main() { imageStore(grid, ivec3(gl_GlobalInvocationID), ligth()); }
        = help: did you mean 'light'?
    shaders/paint.frag:7: error: 'flaot' : no matching overloaded function found
        | color = texelFetch(grid, ivec3(0), 0) * flaot(texelFetch(count, ivec2(0), 0).r) + texelFetch(last, ivec2(0), 0);
        = help: did you mean 'float'?
    shaders/reduce.comp:3: error: '' :  syntax error, unexpected IDENTIFIER, expecting LEFT_BRACE or COMMA or SEMICOLON
        | uniform sampler4D src;
    ");
    let links = bench()
        .edit(
            "shaders/reduce.comp",
            "uniform sampler3D src;",
            "uniform sampler3D source;\n#define src source",
        )
        .edit("shaders/paint.frag", "usampler2D count", "sampler2D count")
        .edit("passes/graph.ron", "\"last\": (of", "\"past\": (of");
    assert_snapshot!(links.findings(), @r#"
    shaders/reduce.comp:3: error: 'source' is a sampler3D that neither the graph nor the scene declares (pass 'reduce')
        | uniform sampler3D source;
        = help: did you mean 'src'?
    passes/graph.ron:22:21: error: no shader of pass 'reduce' uses the name 'src'
        |             bind: { "src": (of: "grid", mip: "mip - 1"), "dst": (of: "grid", mip: "mip") }),
        = help: did you mean 'source'?
    shaders/paint.frag:3: error: 'count' has format r32ui, and the shader declares a sampler2D (pass 'paint')
        | uniform sampler2D count;
        = help: declare a usampler
    shaders/paint.frag:4: error: 'last' is a sampler2D that neither the graph nor the scene declares (pass 'paint')
        | uniform sampler2D last;
        = help: did you mean 'past'?
    passes/graph.ron:26:21: error: no shader of pass 'paint' uses the name 'past'
        |             bind: { "past": (of: "picture", history: true) },
        = help: did you mean 'last'?
    "#);
    let settings = bench().edit(
        "configs/run.ron",
        "\"level\": 0.25",
        "\"levle\": 1, \"cells\": 3, \"method\": \"exact\"",
    );
    assert_snapshot!(settings.findings(), @r#"
    configs/run.ron:6:9: error: no parameter 'levle' (did you mean 'level'?)
        |         "levle": 1, "cells": 3, "method": "exact",
    configs/run.ron:6:21: error: 'cells': 3 is outside 16 to 512
        |         "levle": 1, "cells": 3, "method": "exact",
    "#);
}

#[test]
fn what_a_shader_may_not_decide() {
    assert_snapshot!(shader("fill.comp", "uniform writeonly image3D grid", "layout(set = 1, binding = 0) uniform writeonly image3D grid"), @"shaders/fill.comp: error: 'grid' has a set or binding of its own; leave out layout(set, binding)");
    assert_snapshot!(shader("prepare.comp", "void main() {", "layout(push_constant) uniform P { vec4 a; vec4 b; } p;\nvoid main() { if (p.b.x > 0.0) return;"), @"shaders/prepare.comp: error: the only push constant is pass.index of params.glsl");
    assert_snapshot!(shader("fill.comp", "imageStore(grid, ivec3(gl_GlobalInvocationID), light())", "double d = double(light().x) * 3.0LF; imageStore(grid, ivec3(gl_GlobalInvocationID), vec4(float(d)))"), @r#"
    passes/graph.ron:20:16: error: pass 'fill' needs 64-bit floating point in shaders, which Test GPU does not have
        |         (name: "fill", shaders: ["fill.comp"], dispatch: Indirect("work.groups")),
    "#);
    // One mip is sampled and stored to at once.
    assert_snapshot!(graph("\"src\": (of: \"grid\", mip: \"mip - 1\")", "\"src\": (of: \"grid\", mip: \"mip\")"), @r#"
    passes/graph.ron:21:16: error: pass 'reduce' uses 'grid' in two ways at once (Storage and Sampled)
        |         (name: "reduce", each_mip: (texture: "grid", from: 1), shaders: ["reduce.comp"], dispatch: Cover("dst"),
    "#);
}

#[test]
fn pointers_that_point_nowhere() {
    assert_snapshot!(graph("output: \"picture\"", "pointer: \"cursor\", output: \"picture\""), @r#"
    passes/graph.ron:29:14: error: no Vec2 parameter is named 'cursor'
        |     pointer: "cursor", output: "picture",
        = help: declare it: Vec2(name: "cursor", default: (-1, -1), ...)
    "#);
    assert_snapshot!(graph("output: \"picture\"", "pointer: \"cells\", output: \"picture\""), @r#"
    passes/graph.ron:29:14: error: 'cells' holds a whole number and cannot be the pointer: it must be a Vec2
        |     pointer: "cells", output: "picture",
    "#);
    let two = "Vec2(name: \"cursor\", default: (-1, -1), help: \"Pixel.\"),\n        Bool(name: \"bright\"";
    let bench = bench().edit("passes/graph.ron", "Bool(name: \"bright\"", two);
    let bench = bench.edit(
        "passes/graph.ron",
        "output: \"picture\"",
        "pointer: \"cruser\", output: \"picture\"",
    );
    assert_snapshot!(bench.findings(), @r#"
    passes/graph.ron:30:14: error: no Vec2 parameter is named 'cruser'
        |     pointer: "cruser", output: "picture",
        = help: did you mean 'cursor'?
    "#);
}

#[test]
fn mips_of_views_that_are_not_there() {
    let mips = |entry: &str| {
        let new = format!("view_mips: {{ {entry} }}, output: \"picture\"");
        graph("output: \"picture\"", &new)
    };
    assert_eq!(mips(r#""grid": "cells""#), "");
    assert_snapshot!(mips(r#""gird": "cells""#), @r#"
    passes/graph.ron:29:18: error: no texture is named 'gird'
        |     view_mips: { "gird": "cells" }, output: "picture",
        = help: did you mean 'grid'?
    "#);
    assert_snapshot!(mips(r#""grid": "cell""#), @r#"
    passes/graph.ron:29:26: error: no Int parameter is named 'cell'
        |     view_mips: { "grid": "cell" }, output: "picture",
        = help: did you mean 'cells'?
    "#);
    assert_snapshot!(mips(r#""grid": "bright""#), @r#"
    passes/graph.ron:29:26: error: no Int parameter is named 'bright'
        |     view_mips: { "grid": "bright" }, output: "picture",
        = help: known: cells
    "#);
}

#[test]
fn views_that_set_what_there_is_not() {
    let view = |set: &str| {
        let view =
            format!("views: [(title: \"fast\", help: \"The fast one.\", set: {{ {set} }})],");
        graph(
            "output: \"picture\",",
            &format!("{view}\n    output: \"picture\","),
        )
    };
    assert_eq!(view("\"method\": \"exact\", \"bright\": true"), "");
    let place = "passes/graph.ron:29:59: error: ";
    for (set, said) in [
        ("\"metod\": \"exact\"", "metod"),
        ("\"method\": \"slow\"", "slow"),
        ("\"cells\": 8", "cells"),
        ("\"bright\": 1", "bright"),
    ] {
        let errors = view(set);
        assert!(
            errors.starts_with(place) && errors.contains(said),
            "{errors}"
        );
    }
    let unknown = graph(
        "output: \"picture\",",
        "views: [(title: \"t\", help: \"h\", sets: {})], output: \"picture\",",
    );
    assert!(unknown.contains("'sets'"), "{unknown}");
}

#[test]
fn comparisons_of_what_is_not_there() {
    let with = |a: &str| {
        let compare = format!(
            "compare: [(title: \"T\", help: \"h\", a: {{ {a} }}, b: {{}})],\n    output: \"picture\","
        );
        graph("output: \"picture\",", &compare)
    };
    let found = with("\"nothing\": 1");
    assert!(
        found.contains("passes/graph.ron:29:") && found.contains("no parameter 'nothing'"),
        "{found}"
    );
    assert_eq!(
        with(""),
        "",
        "a comparison of the same settings is no mistake"
    );
}

#[test]
fn voxels_that_are_not_there() {
    let with = |resources: &str, settings: &str| {
        let tool = format!("\"voxels\": (resources: {{ {resources} }}, settings: [{settings}])");
        graph(
            "output: \"picture\",",
            &format!("tools: {{ {tool} }},\n    output: \"picture\","),
        )
    };
    let all = |occupied: &str, borders: &str| {
        format!(
            r#""occupied": "{occupied}", "color": "grid", "normal": "grid", "borders": "{borders}""#
        )
    };
    // Names are checked with the graph, what they mean by the tool.
    let found = with(r#""color": "gird", "borders": "wrok""#, "");
    for message in ["'gird'", "'grid'", "'wrok'", "'work'"] {
        assert!(found.contains(message), "{message} in {found}");
    }
    for (resources, message) in [
        (all("count", "work"), "'count' is no 3D texture"),
        (all("grid", "grid"), "'grid' is no buffer"),
        (
            String::from(r#""occupied": "grid""#),
            "no resource 'borders'",
        ),
    ] {
        let found = with(&resources, "");
        assert!(
            found.contains("passes/graph.ron:29:") && found.contains(message),
            "{message} in {found}"
        );
    }
    let mode = |set: &str| {
        with(
            &all("grid", "work"),
            &format!("(title: \"T\", help: \"h\", set: {{ {set} }})"),
        )
    };
    let found = mode("\"method\": slow");
    assert!(
        found.contains("passes/graph.ron:29:") && found.contains("slow"),
        "{found}"
    );
    assert_eq!(mode("\"method\": exact"), "");
}

#[test]
fn members_that_are_not_there() {
    let block = "buffer Work { uvec3 groups; uint count; uint four[4]; vec2 place; uint one, two, three; uint words[]; } work;";
    let right = |bench: Bench| {
        bench.edit(
            "shaders/prepare.comp",
            "buffer Work { uvec3 groups; uint words[]; } work;",
            block,
        )
    };
    let with = |old: &str, new: &str| right(bench()).edit("passes/graph.ron", old, new).findings();
    let dispatch = |path: &str| with("Indirect(\"work.groups\")", &format!("Indirect({path})"));
    assert_eq!(dispatch("\"work.groups\""), "");
    assert_eq!(dispatch("\"work.one\""), "");
    assert_snapshot!(dispatch("\"work\""), @r#"
    passes/graph.ron:20:67: error: name a member of 'work': "work.member"
        |         (name: "fill", shaders: ["fill.comp"], dispatch: Indirect("work")),
    "#);
    assert_snapshot!(dispatch("\"work.groups\", 16"), @r#"
    passes/graph.ron:20:84: error: expected one value
        |         (name: "fill", shaders: ["fill.comp"], dispatch: Indirect("work.groups", 16)),
    "#);
    assert_snapshot!(dispatch("\"wrok.groups\""), @r#"
    passes/graph.ron:20:67: error: no buffer is named 'wrok'
        |         (name: "fill", shaders: ["fill.comp"], dispatch: Indirect("wrok.groups")),
        = help: did you mean 'work'?
    "#);
    assert_snapshot!(dispatch("\"work.group\""), @r#"
    passes/graph.ron:20:67: error: 'work' has no member 'group'
        |         (name: "fill", shaders: ["fill.comp"], dispatch: Indirect("work.group")),
        = help: did you mean 'groups'?
    "#);
    assert_snapshot!(dispatch("\"work.groups.u\""), @r#"
    passes/graph.ron:20:67: error: 'work.groups' has no member 'u'
        |         (name: "fill", shaders: ["fill.comp"], dispatch: Indirect("work.groups.u")),
        = help: known: x, y, z
    "#);
    assert_snapshot!(dispatch("\"work.four[4]\""), @r#"
    passes/graph.ron:20:67: error: 'work' has no member 'four[4]'
        |         (name: "fill", shaders: ["fill.comp"], dispatch: Indirect("work.four[4]")),
        = help: did you mean 'four[3]'?
    "#);
    assert_snapshot!(dispatch("\"work.place\""), @r#"
    passes/graph.ron:20:67: error: 'work.place' is of type vec2; a dispatch takes its groups from a uvec3 or 3 uints
        |         (name: "fill", shaders: ["fill.comp"], dispatch: Indirect("work.place")),
    "#);
    assert_snapshot!(dispatch("\"work.count\""), @r#"
    passes/graph.ron:20:67: error: 'work.count' is of type uint; a dispatch takes its groups from a uvec3 or 3 uints
        |         (name: "fill", shaders: ["fill.comp"], dispatch: Indirect("work.count")),
    "#);
    // A draw needs four.
    let draw = |path: &str| {
        with(
            "draw: Fullscreen,\n            raster",
            &format!("draw: Indirect({path}),\n            raster"),
        )
    };
    assert_eq!(draw("\"work.four\""), "");
    assert_snapshot!(draw("\"work.groups\""), @r#"
    passes/graph.ron:23:82: error: 'work.groups' is of type uvec3; a draw takes its counts from a uvec4 or 4 uints
        |         (name: "scatter", shaders: ["full.vert", "scatter.frag"], draw: Indirect("work.groups"),
    "#);
    // Checks.
    let check = |text: &str| {
        with(
            "output: \"picture\",",
            &format!("checks: [({text}, message: \"m\")],\n    output: \"picture\","),
        )
    };
    assert_eq!(check("field: \"work.four[3]\""), "");
    assert_snapshot!(check("field: \"work.place.x\""), @r#"
    passes/graph.ron:29:22: error: 'work.place.x' is of type float; a check needs a uint or an int
        |     checks: [(field: "work.place.x", message: "m")],
    "#);
    assert_snapshot!(check("field: \"work\""), @r#"
    passes/graph.ron:29:22: error: name a member of 'work': "work.member"
        |     checks: [(field: "work", message: "m")],
    "#);
    // Sizes.
    let size = |text: &str| with("\"cells * 16\"", text);
    assert_eq!(size("Struct(of: \"cells * 2\")"), "");
    assert_snapshot!(size("Struct"), @r#"
    passes/graph.ron:16:24: error: 'work' ends in 'words[]', whose length is the buffer's
        |         "work": (size: Struct, indirect: true),
        = help: say how many: Struct(of: "...")
    "#);
    assert_snapshot!(size("Struct(off: \"cells * 2\")"), @r#"
    passes/graph.ron:16:31: error: unknown field 'off'
        |         "work": (size: Struct(off: "cells * 2"), indirect: true),
        = help: did you mean 'of'?
    "#);
    assert_snapshot!(size("Strict"), @r#"
    passes/graph.ron:16:24: error: unknown name 'Strict'
        |         "work": (size: Strict, indirect: true),
        = help: did you mean 'Struct'?
    "#);
    assert_snapshot!(size("Struct(of: \"cells - 64\")"), @r#"
    passes/graph.ron:16:35: error: count 'cells - 64' is 0, and must be at least 1
        |         "work": (size: Struct(of: "cells - 64"), indirect: true),
    "#);
    let fixed = right(bench()).edit(
        "shaders/prepare.comp",
        " uint words[]; }",
        " uint words[7]; }",
    );
    assert_eq!(
        fixed
            .edit("passes/graph.ron", "\"cells * 16\"", "Struct")
            .findings(),
        ""
    );
    let fixed = right(bench()).edit(
        "shaders/prepare.comp",
        " uint words[]; }",
        " uint words[7]; }",
    );
    assert_snapshot!(fixed.edit("passes/graph.ron", "\"cells * 16\"", "Struct(of: 4)").findings(), @r#"
    passes/graph.ron:16:24: error: 'work' does not end in an array without a length: `Struct` is its size
        |         "work": (size: Struct(of: 4), indirect: true),
    "#);
    // Nobody declares it.
    let unknown =
        "\"work\": (size: \"cells * 16\", indirect: true),\n        \"other\": (size: Struct),";
    assert_snapshot!(with("\"work\": (size: \"cells * 16\", indirect: true),", unknown), @r#"
    passes/graph.ron:17:25: error: no shader declares 'other', so its struct has no size
        |         "other": (size: Struct),
    passes/graph.ron:17:9: warning: 'other' is declared and never used
        |         "other": (size: Struct),
    "#);
    // Two shaders that disagree.
    let twice = right(bench())
        .edit(
            "shaders/fill.comp",
            "uniform writeonly",
            "layout(std430) buffer Work {\n    uvec3 groups;\n    uint number;\n} work;\nuniform writeonly",
        )
        .edit("shaders/fill.comp", "{ imageStore", "{ if (work.number == 7u) return; imageStore");
    assert_snapshot!(twice.findings(), @r"
    shaders/fill.comp:8: error: 'work' is declared otherwise than in shaders/prepare.comp:2
        | } work;
        = help: here `uint number` at byte 12, there `uint count` at byte 12
    ");
    // As long as nothing names a member, they may see it as they like.
    assert_eq!(
        twice
            .edit(
                "passes/graph.ron",
                "Indirect(\"work.groups\")",
                "Groups(1, 1, 1)"
            )
            .findings(),
        ""
    );
}

#[test]
fn tables_that_cannot_be_read() {
    let block = "struct Row { vec3 place; uint number; uvec2 pair; };
layout(std430) writeonly buffer Work { uvec3 groups; uint count; Row list[8]; Row one; uint words[]; } work;";
    let table = |old: &str, new: &str| {
        let right = "(rows: \"work.count\", list: \"work.list\", title: \"Work\", help: \"Rows.\",
            columns: [
                (name: \"number\"),
                (name: \"where\", of: \"place\", unit: \"m\"),
            ])";
        assert_eq!(
            right.matches(old).count(),
            1,
            "'{old}' stands once in the table"
        );
        bench()
            .edit(
                "shaders/prepare.comp",
                "layout(std430) writeonly buffer Work { uvec3 groups; uint words[]; } work;",
                block,
            )
            .edit(
                "passes/graph.ron",
                "output: \"picture\",",
                &format!(
                    "tables: [{}],\n    output: \"picture\",",
                    right.replace(old, new)
                ),
            )
            .findings()
    };
    assert_eq!(table("title", "title"), "");
    assert_eq!(
        table("\"work.list\"", "\"work.words\"")
            .matches("a row has no member")
            .count(),
        1
    );
    assert_snapshot!(table("\"work.list\"", "\"work.lost\""), @r#"
    passes/graph.ron:29:41: error: 'work' has no member 'lost'
        |     tables: [(rows: "work.count", list: "work.lost", title: "Work", help: "Rows.",
        = help: did you mean 'list'?
    "#);
    assert_snapshot!(table("\"work.list\"", "\"work.one\""), @r#"
    passes/graph.ron:29:41: error: 'work.one' is of type struct { place, number, pair }; the rows of a table are an array's
        |     tables: [(rows: "work.count", list: "work.one", title: "Work", help: "Rows.",
    "#);
    assert_snapshot!(table("\"work.list\"", "\"work\""), @r#"
    passes/graph.ron:29:41: error: name a member of 'work': "work.member"
        |     tables: [(rows: "work.count", list: "work", title: "Work", help: "Rows.",
    "#);
    assert_snapshot!(table("\"work.count\"", "\"work.one.place\""), @r#"
    passes/graph.ron:29:21: error: 'work.one.place' is of type vec3; rows are counted by a uint
        |     tables: [(rows: "work.one.place", list: "work.list", title: "Work", help: "Rows.",
    "#);
    assert_snapshot!(table("\"work.count\"", "\"wrok.count\""), @r#"
    passes/graph.ron:29:21: error: 'wrok.count' is not in 'work', which holds the rows
        |     tables: [(rows: "wrok.count", list: "work.list", title: "Work", help: "Rows.",
    "#);
    assert_snapshot!(table("\"place\"", "\"palce\""), @r#"
    passes/graph.ron:32:17: error: column 'where': a row has no member 'palce'
        |                 (name: "where", of: "palce", unit: "m"),
        = help: did you mean 'place'?
    "#);
    assert_snapshot!(table("\"place\"", "\"pair\""), @r#"
    passes/graph.ron:32:17: error: column 'where': 'pair' is of type uvec2, which no table shows
        |                 (name: "where", of: "pair", unit: "m"),
        = help: tables show uint, int, float, vec2, vec3 and vec4
    "#);
    assert_snapshot!(table("\"work.list\"", "\"wrok.list\""), @r#"
    passes/graph.ron:29:21: error: 'work.count' is not in 'wrok', which holds the rows
        |     tables: [(rows: "work.count", list: "wrok.list", title: "Work", help: "Rows.",
    passes/graph.ron:29:41: error: no buffer is named 'wrok'
        |     tables: [(rows: "work.count", list: "wrok.list", title: "Work", help: "Rows.",
        = help: did you mean 'work'?
    "#);
    assert_snapshot!(table("\"where\"", "\"number\""), @r#"
    passes/graph.ron:32:17: error: two columns of 'Work' are named 'number'
        |                 (name: "number", of: "place", unit: "m"),
    "#);
    assert_snapshot!(table("\"Rows.\"", "\"\""), @r#"
    passes/graph.ron:29:14: error: table 'Work' needs one line of help
        |     tables: [(rows: "work.count", list: "work.list", title: "Work", help: "",
    "#);
    let words = |more: &str| {
        let list = "(list: \"work.words\", rows: \"work.groups.x\", title: \"T\", help: \"h\", columns: [(name: \"n\")])";
        graph(
            "output: \"picture\",",
            &format!("tables: [{list}{more}],\n    output: \"picture\","),
        )
    };
    assert_eq!(words(""), "");
    assert_snapshot!(words(", (list: \"work.words\", rows: \"work.groups.y\", title: \"T\", help: \"h\", columns: [])"), @r#"
    passes/graph.ron:29:106: error: two tables have the title 'T'
        |     tables: [(list: "work.words", rows: "work.groups.x", title: "T", help: "h", columns: [(name: "n")]), (list: "work.words", rows: "work.groups.y", title: "T", help: "h", columns: [])],
    passes/graph.ron:29:106: error: table 'T' has no columns
        |     tables: [(list: "work.words", rows: "work.groups.x", title: "T", help: "h", columns: [(name: "n")]), (list: "work.words", rows: "work.groups.y", title: "T", help: "h", columns: [])],
    "#);
}

#[test]
fn groups_of_passes() {
    let fill = "(name: \"fill\", shaders: [\"fill.comp\"], dispatch: Indirect(\"work.groups\")),";
    let group = |text: &str| graph(fill, &text.replace("FILL", fill));
    assert_eq!(
        group("(stage: \"s\", when: \"method == fast\", passes: [FILL]),"),
        ""
    );
    assert_eq!(
        group("(passes: [(passes: [FILL]), (when: \"bright\", passes: [])]),"),
        ""
    );
    assert_snapshot!(group("(name: \"s\", passes: [FILL]),"), @r#"
    passes/graph.ron:20:10: error: unknown field 'name'
        |         (name: "s", passes: [(name: "fill", shaders: ["fill.comp"], dispatch: Indirect("work.groups")),]),
        = help: known: converges, passes, settles, stage, when
    "#);
    assert_snapshot!(group("(when: \"method == rows\", passes: [FILL]),"), @r#"
    passes/graph.ron:20:16: error: unknown variable 'rows' in 'method == rows'
        |         (when: "method == rows", passes: [(name: "fill", shaders: ["fill.comp"], dispatch: Indirect("work.groups")),]),
    "#);
    // One wrong pass is told, and the others are there.
    assert_snapshot!(group("(when: \"bright\", passes: [(name: \"prepare\", clear: \"work\"), (nam: \"x\"), FILL]),"), @r#"
    passes/graph.ron:20:42: error: two passes are named 'prepare'; timings could not tell them apart
        |         (when: "bright", passes: [(name: "prepare", clear: "work"), (nam: "x"), (name: "fill", shaders: ["fill.comp"], dispatch: Indirect("work.groups")),]),
    passes/graph.ron:20:70: error: unknown field 'nam'
        |         (when: "bright", passes: [(name: "prepare", clear: "work"), (nam: "x"), (name: "fill", shaders: ["fill.comp"], dispatch: Indirect("work.groups")),]),
        = help: did you mean 'name'?
    "#);
}

#[test]
fn what_settles() {
    let settles = |pass: &str, frames: &str| {
        graph(
            &format!("(name: \"{pass}\","),
            &format!("(name: \"{pass}\", settles: \"{frames}\","),
        )
    };
    assert_eq!(settles("paint", "cells / 16"), "");
    assert_snapshot!(settles("paint", "cells - 64"), @r#"
    passes/graph.ron:25:34: error: settles 'cells - 64' is 0, and must be at least 1
        |         (name: "paint", settles: "cells - 64", when: "method == fast", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
    "#);
    assert_snapshot!(settles("paint", "frames"), @r#"
    passes/graph.ron:25:34: error: unknown variable 'frames' in 'frames'
        |         (name: "paint", settles: "frames", when: "method == fast", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
    "#);
    assert_snapshot!(settles("fill", "4"), @r#"
    passes/graph.ron:21:16: error: 'grid' is written by pass 'fill' too, which settles
        |         (name: "reduce", each_mip: (texture: "grid", from: 1), shaders: ["reduce.comp"], dispatch: Cover("dst"),
    "#);
    assert_snapshot!(settles("scatter", "4"), @r#"
    passes/graph.ron:25:16: error: 'count' is read here and written by pass 'scatter', which settles: give it a history, so that it is kept
        |         (name: "paint", when: "method == fast", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
    "#);
    // Two passes rest together, and another reads what they keep before both are through.
    let raster = "draw: Fullscreen, raster: (size: (\"cells\", \"cells\"), samples: \"4\")),";
    let scatter = |name: &str| {
        format!("(name: \"{name}\", shaders: [\"full.vert\", \"scatter.frag\"], {raster}")
    };
    let group = format!(
        "    passes: [(settles: \"4\", passes: [{} {}])],\n)",
        scatter("scatter"),
        scatter("again")
    );
    let old = GRAPH
        .lines()
        .position(|l| l.contains("\"scatter\""))
        .unwrap();
    let old: String = GRAPH
        .lines()
        .skip(old)
        .take(2)
        .map(|l| format!("{l}\n"))
        .collect();
    let between = bench()
        .edit(
            "passes/graph.ron",
            "views: [\"r32i\"]),",
            "views: [\"r32i\"], history: true),",
        )
        .edit("passes/graph.ron", &old, "")
        .edit(
            "passes/shared.ron",
            "    ],\n)",
            &format!("    ],\n{group}"),
        )
        .edit(
            "passes/graph.ron",
            "(name: \"paint\",",
            "(name: \"paint\", after: \"scatter\",",
        );
    assert_snapshot!(between.findings(), @r#"
    passes/graph.ron:23:16: error: 'count' is read here before pass 'again', which settles, is through
        |         (name: "paint", after: "scatter", when: "method == fast", shaders: ["full.vert", "paint.frag"], draw: Fullscreen,
    "#);
}

#[test]
fn what_is_transient() {
    let transient = |old: &str| graph(&format!("{old}),"), &format!("{old}, transient: true),"));
    assert_eq!(
        transient("\"work\": (size: \"cells * 16\", indirect: true"),
        ""
    );
    assert_eq!(transient("format: \"d32\""), "");
    assert_snapshot!(transient("format: \"r32ui\", views: [\"r32i\"]"), @r#"
    passes/graph.ron:23:16: error: 'count' is transient, and pass 'scatter' reads it before it is written
        |         (name: "scatter", shaders: ["full.vert", "scatter.frag"], draw: Fullscreen,
    "#);
    assert_snapshot!(transient("format: \"rgba16f\", history: true"), @r#"
    passes/graph.ron:12:9: error: 'picture' has a history and is transient: one or the other
        |         "picture": (size: ("width", "height"), format: "rgba16f", history: true, transient: true),
    "#);
    assert_snapshot!(transient("mips: \"log2(cells) + 1\""), @r#"
    passes/graph.ron:10:9: error: 'grid' is transient and cannot have mips
        |         "grid": (size: ("cells", "cells", "cells"), format: "grid_format", mips: "log2(cells) + 1", transient: true),
    "#);
}

#[test]
fn aliases_and_samplers() {
    let with = |section: &str, text: &str| {
        let section = format!("    {section}: {{ {text} }},\n    textures: {{");
        bench()
            .edit("passes/graph.ron", "    textures: {", &section)
            .edit(
                "shaders/paint.frag",
                "uniform sampler2D last;",
                "uniform sampler2D ghost;",
            )
            .edit(
                "shaders/paint.frag",
                "texelFetch(last,",
                "texelFetch(ghost,",
            )
            .edit(
                "passes/graph.ron",
                "            bind: { \"last\": (of: \"picture\", history: true) },\n",
                "",
            )
            .findings()
    };
    let alias = |text: &str| with("aliases", text);
    let sampler = |text: &str| with("samplers", text);
    let right = "\"ghost\": [(when: \"bright\", of: \"picture\", history: true), (of: \"picture\", history: true)]";
    assert_eq!(alias(right), "");
    assert_snapshot!(alias("\"ghost\": [(when: \"bright\", of: \"picture\", history: true)]"), @r#"
    passes/graph.ron:9:33: error: the last case of 'ghost' has a condition: what if none holds?
        |     aliases: { "ghost": [(when: "bright", of: "picture", history: true)] },
    "#);
    assert_snapshot!(alias("\"ghost\": [(of: \"picture\", history: true), (of: \"picture\", history: true)]"), @r#"
    passes/graph.ron:9:26: error: a case of 'ghost' without `when` hides those behind it
        |     aliases: { "ghost": [(of: "picture", history: true), (of: "picture", history: true)] },
    "#);
    assert_snapshot!(alias("\"ghost\": []"), @r#"
    passes/graph.ron:9:25: error: alias 'ghost' stands for nothing
        |     aliases: { "ghost": [] },
    "#);
    assert_snapshot!(alias(&right.replace("bright", "bride")), @r#"
    passes/graph.ron:9:33: error: unknown variable 'bride' in 'bride'
        |     aliases: { "ghost": [(when: "bride", of: "picture", history: true), (of: "picture", history: true)] },
    "#);
    assert_snapshot!(alias(&right.replace("\"picture\"", "\"pictures\"")), @r#"
    passes/graph.ron:9:47: error: no texture is named 'pictures'
        |     aliases: { "ghost": [(when: "bright", of: "pictures", history: true), (of: "pictures", history: true)] },
        = help: did you mean 'picture'?
    passes/graph.ron:9:80: error: no texture is named 'pictures'
        |     aliases: { "ghost": [(when: "bright", of: "pictures", history: true), (of: "pictures", history: true)] },
        = help: did you mean 'picture'?
    "#);
    // Each case must fit the shader.
    assert_snapshot!(alias("\"ghost\": [(when: \"bright\", of: \"grid\"), (of: \"picture\", history: true)]"), @r"
    shaders/paint.frag:4: error: 'grid' is 3D, and the shader declares a sampler2D (pass 'paint')
        | uniform sampler2D ghost;
        = help: declare it as 3D
    ");
    assert_snapshot!(alias("\"ghost\": [(when: \"bright\", of: \"work\", mip: 1), (of: \"depth\", history: true)]"), @r#"
    passes/graph.ron:9:47: error: 'work' is a buffer: it has no mip, format or sampler
        |     aliases: { "ghost": [(when: "bright", of: "work", mip: 1), (of: "depth", history: true)] },
    passes/graph.ron:9:69: error: 'depth' is not declared with `history: true`
        |     aliases: { "ghost": [(when: "bright", of: "work", mip: 1), (of: "depth", history: true)] },
    "#);
    // Names that are taken, used twice, or not at all.
    assert_snapshot!(alias(&format!("{right}, \"count\": [(of: \"picture\")]")), @r#"
    passes/graph.ron:9:107: error: resource 'count' is declared twice
        |     aliases: { "ghost": [(when: "bright", of: "picture", history: true), (of: "picture", history: true)], "count": [(of: "picture")] },
    "#);
    assert_snapshot!(alias(&format!("{right}, {right}")), @r#"
    passes/graph.ron:9:107: error: 'ghost' stands twice
        |     aliases: { "ghost": [(when: "bright", of: "picture", history: true), (of: "picture", history: true)], "ghost": [(when: "bright", of: "picture", history: true), (of: "picture", history: true)] },
    "#);
    assert_snapshot!(alias(&format!("{right}, \"spare\": [(of: \"ghost\")]")), @r#"
    passes/graph.ron:9:122: error: 'ghost' is an alias or sampler itself: name a texture or buffer
        |     aliases: { "ghost": [(when: "bright", of: "picture", history: true), (of: "picture", history: true)], "spare": [(of: "ghost")] },
    "#);
    assert_snapshot!(alias(&format!("{right} }}, samplers: {{ \"ghost\": (of: \"picture\")")), @r#"
    passes/graph.ron:9:121: error: 'ghost' is an alias and a sampler
        |     aliases: { "ghost": [(when: "bright", of: "picture", history: true), (of: "picture", history: true)] }, samplers: { "ghost": (of: "picture") },
    "#);
    assert_snapshot!(alias(&format!("{right}, \"spare\": [(of: \"picture\")]")), @r#"
    passes/graph.ron:9:107: warning: 'spare' is declared and never used
        |     aliases: { "ghost": [(when: "bright", of: "picture", history: true), (of: "picture", history: true)], "spare": [(of: "picture")] },
    "#);
    // Samplers.
    assert_snapshot!(sampler("\"ghost\": (of: \"depth\", compare: less)"), @r"
    shaders/paint.frag:4: error: the sampler of 'depth' does not fit: the shader declares a sampler2D (pass 'paint')
        | uniform sampler2D ghost;
        = help: declare a Shadow sampler, or bind it with a sampler that does not compare
    ");
    assert_snapshot!(sampler("\"ghost\": (of: \"dept\", compares: less)"), @r#"
    passes/graph.ron:9:39: error: unknown field 'compares'
        |     samplers: { "ghost": (of: "dept", compares: less) },
        = help: did you mean 'compare'?
    "#);
    // Where only a texture will do.
    let target = bench()
        .edit(
            "passes/graph.ron",
            "    textures: {",
            &format!("    aliases: {{ {right} }},\n    textures: {{"),
        )
        .edit(
            "passes/graph.ron",
            "color: [(to: \"picture\"",
            "color: [(to: \"ghost\"",
        );
    assert_snapshot!(target.findings(), @r#"
    passes/graph.ron:28:26: error: 'ghost' is an alias or sampler, which passes bind: name a texture
        |             color: [(to: "ghost", clear: (0, 0, 0, 1))], depth: (to: "depth", clear: 1.0)),
    "#);
}

#[test]
fn sizes_by_a_word() {
    let size = |text: &str| {
        graph(
            "\"depth\": (size: (\"width\", \"height\")",
            &format!("\"depth\": (size: {text}"),
        )
    };
    assert_eq!(size("Screen"), "");
    assert_eq!(size("Like(\"picture\")"), "");
    assert_snapshot!(size("Scren"), @r#"
    passes/graph.ron:13:25: error: unknown name 'Scren'
        |         "depth": (size: Scren, format: "d32"),
        = help: did you mean 'Screen'?
    "#);
    assert_snapshot!(size("Like(picture)"), @r#"
    passes/graph.ron:13:30: error: Expected string
        |         "depth": (size: Like(picture), format: "d32"),
    "#);
    assert_snapshot!(size("Like(\"pictures\")"), @r#"
    passes/graph.ron:13:30: error: no texture is named 'pictures'
        |         "depth": (size: Like("pictures"), format: "d32"),
        = help: did you mean 'picture'?
    "#);
    assert_snapshot!(size("Like(\"depth\")"), @r#"
    passes/graph.ron:13:9: error: 'depth' is as large as itself
        |         "depth": (size: Like("depth"), format: "d32"),
    "#);
    assert_snapshot!(size("Like(\"grid\")"), @r#"
    passes/graph.ron:27:72: error: attachments differ in size: 64x48 and 64x64
        |             color: [(to: "picture", clear: (0, 0, 0, 1))], depth: (to: "depth", clear: 1.0)),
    "#);
}

#[test]
fn structs_of_the_scene_that_the_program_fills_otherwise() {
    let declares = |block: &str, used: &str| {
        bench()
            .edit(
                "shaders/fill.comp",
                "uniform writeonly image3D grid;",
                &format!("uniform writeonly image3D grid;\n{block}"),
            )
            .edit(
                "shaders/fill.comp",
                "{ imageStore",
                &format!("{{ if ({used} == 7u) return; imageStore"),
            )
            .findings()
    };
    let light = |members: &str, used: &str| {
        let lights = "layout(std430) readonly buffer Lights { Light lights[]; } lights;";
        declares(
            &format!("struct Light {{\n{members}\n}};\n{lights}"),
            &format!("lights.lights[0].{used}"),
        )
    };
    // A prefix is enough, and names are free where they are not the program's.
    assert_eq!(
        declares(
            "uniform Camera { mat4 view; mat4 lens; } camera;",
            "uint(camera.view[0].x)"
        ),
        ""
    );
    assert_eq!(
        declares(
            "readonly buffer Draws { uint words[]; } draws;",
            "draws.words[3]"
        ),
        ""
    );
    let right = "vec3 place;\nuint kind;\nvec4 rest[4];";
    assert_eq!(light(right, "kind"), "");
    assert_snapshot!(light("uint kind;\nvec3 position;\nvec4 rest[3];", "kind"), @r"
    shaders/fill.comp:7: error: 'kind' of 'lights' is at byte 12, and the shader declares it at 0
        | uint kind;
    ");
    assert_snapshot!(light("vec3 position;\nuint kind;", "kind"), @r"
    shaders/fill.comp:10: error: an element of 'lights' has 80 bytes, and the shader declares 16
        | layout(std430) readonly buffer Lights { Light lights[]; } lights;
    ");
    assert_snapshot!(light(&right.replace("uint kind", "int kind"), "kind"), @r"
    shaders/fill.comp:8: error: 'kind' of 'lights' is of type uint, and the shader declares int
        | int kind;
    ");
    assert_snapshot!(declares("uniform Camera { mat4 view[6]; vec4 more; } camera;", "uint(camera.more.x)"), @r"
    shaders/fill.comp:6: error: 'view' of 'camera' is of type mat4, and the shader declares mat4[6]
        | uniform Camera { mat4 view[6]; vec4 more; } camera;
    ");
}
