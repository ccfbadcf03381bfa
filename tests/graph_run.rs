//! Graphs that have nothing to do with voxels, each checked against the same computation on the CPU. The validation layer
//! watches every frame, synchronization included.

mod common;

use common::{assert_clean, conelab, floats, prepare, succeeds, words};
use conelab::experiment::Experiment;
use conelab::graph::table::{Cell, decode};
use conelab::lab::{Lab, Session};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use std::fmt::Write;
use std::path::PathBuf;
use tempfile::TempDir;

/// A home of its own for one graph, and a device for it.
struct Bench(TempDir);

/// A shader with the usual first lines.
fn glsl(text: &str) -> String {
    format!("#version 460\n#extension GL_GOOGLE_include_directive : require\n{text}")
}

/// One triangle over the picture.
const FULL: &str = "void main() {
    gl_Position = vec4(vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2) * 2.0 - 1.0, 0.0, 1.0);
}";

impl Bench {
    fn new(graph: &str, shaders: &[(&str, &str)]) -> Bench {
        let bench = Bench(tempfile::tempdir().unwrap());
        bench.write("passes/graph.ron", graph);
        bench.write(
            "configs/run.ron",
            "(graph: \"graph.ron\", scene: \"triangles\", size: (32, 24))",
        );
        for (name, text) in shaders {
            bench.write(&format!("shaders/{name}"), &glsl(text));
        }
        let scene =
            std::fs::read_to_string(common::root().join("shaders/common/scene.glsl")).unwrap();
        bench.write("shaders/scene.glsl", &scene);
        bench
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        std::fs::create_dir_all(self.path(name).parent().unwrap()).unwrap();
        std::fs::write(self.path(name), text).unwrap();
    }

    /// Replaces the only `old` of a file.
    #[track_caller]
    fn edit(&self, name: &str, old: &str, new: &str) {
        let text = std::fs::read_to_string(self.path(name)).unwrap();
        assert_eq!(
            text.matches(old).count(),
            1,
            "'{old}' stands once in {name}"
        );
        self.write(name, &text.replace(old, new));
    }

    fn lab(&self) -> Lab {
        common::lab(self.0.path())
    }

    /// Runs frames that leave `wanted` to be read.
    #[track_caller]
    fn run(&self, lab: &Lab, wanted: &[&str], frames: usize) -> Session {
        let experiment = Experiment::read(&self.path("configs/run.ron")).unwrap();
        let mut session = prepare(lab, &experiment, wanted);
        session.run(frames).unwrap();
        session.finish().unwrap();
        assert_clean(lab);
        session
    }
}

#[test]
fn what_only_a_pass_that_is_off_writes_is_zeros() {
    let bench = Bench::new(
        r#"(
            textures: {
                "first": (size: (8, 8), format: "r32f", transient: true),
                "doubled": (size: (8, 8), format: "r32f", transient: true),
                "doubledAgain": (size: (8, 8), format: "r32f", transient: true),
                "second": (size: (8, 8), format: "r32f"),
                "sum": (size: (8, 8), format: "r32f"),
            },
            passes: [
                (name: "make first", shaders: ["first.comp"], dispatch: Cover("first")),
                (name: "double first", shaders: ["double.comp"], dispatch: Cover("doubled"), instead: { "doubled": "first" }),
                (name: "double again", shaders: ["double.comp"], dispatch: Cover("doubledAgain"), instead: { "doubledAgain": "doubled" },
                    bind: { "first": (of: "doubled"), "doubled": (of: "doubledAgain") }),
                (name: "make second", shaders: ["second.comp"], dispatch: Cover("second")),
                (name: "add", shaders: ["add.comp"], dispatch: Cover("sum")),
            ],
            outputs: ["sum"],
        )"#,
        &[
            ("first.comp", &store("first", "3.0")),
            ("second.comp", &store("second", "4.0")),
            (
                "double.comp",
                "layout(local_size_x = 8, local_size_y = 8) in;
                uniform sampler2D first;
                layout(r32f) uniform writeonly image2D doubled;
                void main() {
                    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
                    imageStore(doubled, p, 2.0 * texelFetch(first, p, 0));
                }",
            ),
            (
                "add.comp",
                "layout(local_size_x = 8, local_size_y = 8) in;
                layout(r32f) uniform readonly image2D doubledAgain;
                layout(r32f) uniform readonly image2D second;
                layout(r32f) uniform writeonly image2D sum;
                void main() {
                    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
                    imageStore(sum, p, imageLoad(doubledAgain, p) + imageLoad(second, p));
                }",
            ),
        ],
    );
    let lab = bench.lab();
    let sum = |off: &str| {
        let params = if off.is_empty() {
            String::new()
        } else {
            format!(", params: {{ \"off\": {off} }}")
        };
        bench.write(
            "configs/run.ron",
            &format!("(graph: \"graph.ron\", scene: \"triangles\", size: (32, 24){params})"),
        );
        let mut session = bench.run(&lab, &["sum"], 2);
        let found = reds(&mut session, "sum", 0);
        assert!(found.iter().all(|v| *v == found[0]), "{found:?}");
        found[0]
    };
    assert_eq!(sum(""), 16.0);
    assert_eq!(sum(r#"["make first"]"#), 4.0);
    assert_eq!(sum(r#"["make second"]"#), 12.0);
    // A pass may say what is read in place of what it writes.
    assert_eq!(sum(r#"["double first"]"#), 10.0);
    assert_eq!(sum(r#"["double again", "make second"]"#), 6.0);
    assert_eq!(sum(r#"["double first", "double again"]"#), 7.0);
    assert_eq!(sum(r#"["double first", "make first"]"#), 4.0);
    assert_eq!(sum(r#"["make second", "make first"]"#), 0.0);
    assert_eq!(sum("[]"), 16.0);

    // The command line names what it does not know, and says what has no writer left.
    let plan = |off: &str| {
        let mut command = conelab(bench.0.path());
        command
            .args(["graph", "passes/graph.ron", "--want", "sum", "--set"])
            .arg(format!("off={off}"));
        command
    };
    assert!(
        succeeds(&mut plan(r#"["make first"]"#)).contains("(--barriers prints why): make first")
    );
    let said = common::fails(&mut plan(r#"["make frist"]"#));
    assert!(
        said.contains("no pass 'make frist'") && said.contains("make first"),
        "{said}"
    );
    let said = common::fails(&mut plan(r#"["add"]"#));
    assert!(
        said.contains("nothing writes 'sum' when these passes are off: add"),
        "{said}"
    );
    assert!(common::fails(&mut plan("add")).contains("expected a list of passes"));
}

/// A shader that fills a texture of one channel.
fn store(name: &str, value: &str) -> String {
    format!(
        "layout(local_size_x = 8, local_size_y = 8) in;
        layout(r32f) uniform writeonly image2D {name};
        void main() {{ imageStore({name}, ivec2(gl_GlobalInvocationID.xy), vec4({value})); }}"
    )
}

/// The first channel of a texture's mip.
#[track_caller]
fn reds(session: &mut Session, name: &str, mip: u32) -> Vec<f32> {
    floats(session, name, mip).iter().map(|t| t[0]).collect()
}

#[test]
fn reaction_and_diffusion_over_frames() {
    // Gray and Scott 1984: two reactants in a texture that keeps its last frame.
    let bench = Bench::new(
        r#"(
            params: [
                Float(name: "feed", default: 0.037, range: (0.0, 0.1), help: "Inflow of u."),
                Float(name: "kill", default: 0.06, range: (0.0, 0.1), help: "Outflow of v."),
            ],
            textures: { "state": (size: (32, 32), format: "rg32f", history: true) },
            passes: [
                (name: "react", shaders: ["react.comp"], dispatch: Cover("state"),
                    bind: { "last": (of: "state", history: true) }),
            ],
        )"#,
        &[(
            "react.comp",
            "#include \"params.glsl\"
            #include \"scene.glsl\"
            layout(local_size_x = 8, local_size_y = 8) in;
            layout(rg32f) uniform readonly image2D last;
            layout(rg32f) uniform writeonly image2D state;
            vec2 at(ivec2 p) { return imageLoad(last, p & 31).xy; }
            void main() {
                ivec2 p = ivec2(gl_GlobalInvocationID.xy);
                if (camera.frame == 0) {
                    bool inside = all(greaterThanEqual(p, ivec2(12))) && all(lessThan(p, ivec2(20)));
                    imageStore(state, p, vec4(1.0, inside ? 1.0 : 0.0, 0.0, 0.0));
                    return;
                }
                vec2 c = at(p);
                vec2 around = at(p + ivec2(1, 0)) + at(p - ivec2(1, 0)) + at(p + ivec2(0, 1)) + at(p - ivec2(0, 1)) - 4.0 * c;
                float rate = c.x * c.y * c.y;
                c += vec2(0.2, 0.1) * around + vec2(params.feed * (1.0 - c.x) - rate, rate - (params.feed + params.kill) * c.y);
                imageStore(state, p, vec4(c, 0.0, 0.0));
            }",
        )],
    );
    let lab = bench.lab();
    for frames in [1, 2, 21] {
        let mut session = bench.run(&lab, &["state"], frames);
        let found = floats(&mut session, "state", 0);
        let expected = react(frames - 1);
        let worst = found
            .iter()
            .zip(&expected)
            .map(|(f, e)| (f[0] - e[0]).abs().max((f[1] - e[1]).abs()))
            .fold(0.0, f32::max);
        assert!(worst < 1e-4, "{worst} after {frames} frames");
    }
}

fn react(steps: usize) -> Vec<[f32; 2]> {
    let inside = |i: usize| (12..20).contains(&(i % 32)) && (12..20).contains(&(i / 32));
    let mut state: Vec<[f32; 2]> = (0..1024)
        .map(|i| [1.0, if inside(i) { 1.0 } else { 0.0 }])
        .collect();
    for _ in 0..steps {
        let last = state.clone();
        let at = |x: usize, y: usize| last[y % 32 * 32 + x % 32];
        for (i, c) in state.iter_mut().enumerate() {
            let (x, y) = (i % 32, i / 32);
            let near = [at(x + 1, y), at(x + 31, y), at(x, y + 1), at(x, y + 31)];
            let around: [f32; 2] =
                std::array::from_fn(|k| near.iter().map(|n| n[k]).sum::<f32>() - 4.0 * c[k]);
            let rate = c[0] * c[1] * c[1];
            *c = [
                c[0] + 0.2 * around[0] + 0.037 * (1.0 - c[0]) - rate,
                c[1] + 0.1 * around[1] + rate - (0.037 + 0.06) * c[1],
            ];
        }
    }
    state
}

/// Blur, pyramid, histogram, a list and its indirect dispatch, a view of another format, copies and clears.
const IMAGES: &str = r#"(
    params: [
        Int(name: "edge", default: 64, range: (16, 256), help: "Edge of the images."),
        Float(name: "bright", default: 0.75, range: (0.0, 1.0), help: "Least value of a bright texel."),
    ],
    textures: {
        "source": (size: ("edge", "edge"), format: "r32f"),
        "wide": (size: ("edge", "edge"), format: "r32f"),
        "blurred": (size: ("edge", "edge"), format: "r32f", sampler: (filter: nearest)),
        "pyramid": (size: ("edge", "edge"), format: "r32f", mips: "log2(edge) + 1"),
        "base": (size: ("edge", "edge"), format: "r32f", sampler: (filter: nearest)),
        "packed": (size: ("edge / 4", "edge / 4"), format: "rgba8", views: ["r32ui"]),
        "unpacked": (size: ("edge / 4", "edge / 4"), format: "rgba32f"),
        "marked": (size: ("edge", "edge"), format: "r32ui"),
        "kept": (size: ("edge", "edge"), format: "r32ui"),
    },
    buffers: {
        "histogram": (size: "16 * 4"),
        "list": (size: "16 + edge * edge * 4", indirect: true),
    },
    passes: [
        (name: "source", shaders: ["source.comp"], dispatch: Cover("source")),
        (name: "blur x", shaders: ["blur_x.comp"], dispatch: Cover("wide")),
        (name: "blur y", shaders: ["blur_y.comp"], dispatch: Cover("blurred")),
        (name: "pyramid base", shaders: ["base.comp"], dispatch: Cover("base")),
        (name: "pyramid begin", shaders: ["begin.comp"], dispatch: Cover("pyramid")),
        (name: "pyramid", each_mip: (texture: "pyramid", from: 1), shaders: ["half.comp"], dispatch: Cover("dst"),
            bind: { "src": (of: "pyramid", mip: "mip - 1"), "dst": (of: "pyramid", mip: "mip") }),
        (name: "no counts", clear: "histogram", value: (3, 0, 0, 0)),
        (name: "count", shaders: ["count.comp"], dispatch: Cover("source")),
        (name: "no list", clear: "list"),
        (name: "collect", shaders: ["collect.comp"], dispatch: Cover("source")),
        (name: "size", shaders: ["size.comp"], dispatch: Groups(1, 1, 1)),
        (name: "no marks", clear: "marked", value: (7, 0, 0, 0)),
        (name: "mark", shaders: ["mark.comp"], dispatch: Indirect("list.groups")),
        (name: "keep marks", shaders: ["keep.comp"], dispatch: Cover("kept")),
        (name: "nothing packed", clear: "packed"),
        (name: "pack", shaders: ["pack.comp"], dispatch: Cover("source"),
            bind: { "packed": (of: "packed", as: "r32ui") }),
        (name: "unpack", shaders: ["unpack.comp"], dispatch: Cover("unpacked")),
    ],
)"#;

const IMAGE_SHADERS: &[(&str, &str)] = &[
    (
        "base.comp",
        "layout(local_size_x = 8, local_size_y = 8) in;
        uniform sampler2D blurred;
        uniform writeonly image2D base;
        void main() {
            ivec2 p = ivec2(gl_GlobalInvocationID.xy);
            imageStore(base, p, texelFetch(blurred, p, 0));
        }",
    ),
    (
        "keep.comp",
        "layout(local_size_x = 8, local_size_y = 8) in;
        uniform usampler2D marked;
        uniform writeonly uimage2D kept;
        void main() {
            ivec2 p = ivec2(gl_GlobalInvocationID.xy);
            imageStore(kept, p, texelFetch(marked, p, 0));
        }",
    ),
    (
        "source.comp",
        "layout(local_size_x = 8, local_size_y = 8) in;
        uniform writeonly image2D source;
        void main() {
            uvec2 p = gl_GlobalInvocationID.xy;
            imageStore(source, ivec2(p), vec4(float((p.x * 7 + p.y * p.y * 13) % 32) / 32.0));
        }",
    ),
    (
        "blur_x.comp",
        "layout(local_size_x = 64) in;
        uniform sampler2D source;
        uniform writeonly image2D wide;
        void main() {
            ivec2 p = ivec2(gl_GlobalInvocationID.xy);
            int last = textureSize(source, 0).x - 1;
            float a = texelFetch(source, ivec2(max(p.x - 1, 0), p.y), 0).r, b = texelFetch(source, p, 0).r;
            imageStore(wide, p, vec4(0.25 * (a + 2.0 * b + texelFetch(source, ivec2(min(p.x + 1, last), p.y), 0).r)));
        }",
    ),
    (
        "blur_y.comp",
        "layout(local_size_x = 1, local_size_y = 64) in;
        layout(r32f) uniform readonly image2D wide;
        uniform writeonly image2D blurred;
        void main() {
            ivec2 p = ivec2(gl_GlobalInvocationID.xy);
            int last = imageSize(wide).y - 1;
            float a = imageLoad(wide, ivec2(p.x, max(p.y - 1, 0))).r, b = imageLoad(wide, p).r;
            imageStore(blurred, p, vec4(0.25 * (a + 2.0 * b + imageLoad(wide, ivec2(p.x, min(p.y + 1, last))).r)));
        }",
    ),
    (
        "begin.comp",
        "layout(local_size_x = 8, local_size_y = 8) in;
        uniform sampler2D base;
        uniform writeonly image2D pyramid;
        void main() {
            ivec2 p = ivec2(gl_GlobalInvocationID.xy);
            imageStore(pyramid, p, textureLod(base, (vec2(p) + 0.5) / vec2(imageSize(pyramid)), 0.0));
        }",
    ),
    (
        "half.comp",
        "layout(local_size_x = 8, local_size_y = 8) in;
        uniform sampler2D src;
        uniform writeonly image2D dst;
        void main() {
            ivec2 p = ivec2(gl_GlobalInvocationID.xy);
            if (any(greaterThanEqual(p, imageSize(dst)))) return;
            float sum = 0.0;
            for (int i = 0; i < 4; i++) sum += texelFetch(src, 2 * p + ivec2(i & 1, i >> 1), 0).r;
            imageStore(dst, p, vec4(0.25 * sum));
        }",
    ),
    (
        "count.comp",
        "layout(local_size_x = 8, local_size_y = 8) in;
        uniform sampler2D source;
        layout(std430) buffer Histogram { uint bins[16]; } histogram;
        void main() {
            float value = texelFetch(source, ivec2(gl_GlobalInvocationID.xy), 0).r;
            atomicAdd(histogram.bins[min(uint(value * 16.0), 15u)], 1u);
        }",
    ),
    (
        "collect.comp",
        "#include \"params.glsl\"
        layout(local_size_x = 8, local_size_y = 8) in;
        uniform sampler2D source;
        layout(std430) buffer List { uvec3 groups; uint count; uint texels[]; } list;
        void main() {
            uvec2 p = gl_GlobalInvocationID.xy;
            if (texelFetch(source, ivec2(p), 0).r >= params.bright) list.texels[atomicAdd(list.count, 1u)] = p.x | p.y << 16;
        }",
    ),
    (
        "size.comp",
        "layout(std430) buffer List { uvec3 groups; uint count; uint texels[]; } list;
        void main() { list.groups = uvec3((list.count + 31u) / 32u, 1u, 1u); }",
    ),
    (
        "mark.comp",
        "layout(local_size_x = 32) in;
        layout(std430) readonly buffer List { uvec3 groups; uint count; uint texels[]; } list;
        layout(r32ui) uniform uimage2D marked;
        void main() {
            if (gl_GlobalInvocationID.x >= list.count) return;
            uint texel = list.texels[gl_GlobalInvocationID.x];
            ivec2 p = ivec2(texel & 0xffffu, texel >> 16);
            imageStore(marked, p, imageLoad(marked, p) + 1u);
        }",
    ),
    (
        "pack.comp",
        "layout(local_size_x = 8, local_size_y = 8) in;
        uniform sampler2D source;
        layout(r32ui) uniform uimage2D packed;
        void main() {
            ivec2 p = ivec2(gl_GlobalInvocationID.xy);
            uint value = packUnorm4x8(vec4(p & 3, 4, 4.0 * texelFetch(source, p, 0).r) / 4.0);
            if (imageLoad(packed, p / 4).r < value) imageAtomicMax(packed, p / 4, value);
        }",
    ),
    (
        "unpack.comp",
        "layout(local_size_x = 8, local_size_y = 8) in;
        uniform sampler2D packed;
        uniform writeonly image2D unpacked;
        void main() {
            ivec2 p = ivec2(gl_GlobalInvocationID.xy);
            imageStore(unpacked, p, texelFetch(packed, p, 0));
        }",
    ),
];

#[test]
fn blur_pyramid_histogram_lists_and_views() {
    const N: usize = 64;
    let bench = Bench::new(IMAGES, IMAGE_SHADERS);
    let lab = bench.lab();
    let wanted = [
        "pyramid",
        "histogram",
        "kept",
        "list",
        "unpacked",
        "blurred",
    ];
    // The fourth frame is like the first: whatever frames leave behind is overwritten.
    let mut session = bench.run(&lab, &wanted, 4);

    let source: Vec<f32> = (0..N * N)
        .map(|i| ((i % N * 7 + (i / N) * (i / N) * 13) % 32) as f32 / 32.0)
        .collect();
    let blur = |image: &[f32], step: &dyn Fn(usize, isize) -> usize| -> Vec<f32> {
        (0..N * N)
            .map(|i| 0.25 * (image[step(i, -1)] + 2.0 * image[i] + image[step(i, 1)]))
            .collect()
    };
    let wide = blur(&source, &|i, d| {
        i / N * N + (i % N).saturating_add_signed(d).min(N - 1)
    });
    let blurred = blur(&wide, &|i, d| {
        (i / N).saturating_add_signed(d).min(N - 1) * N + i % N
    });
    assert!(reds(&mut session, "blurred", 0) == blurred, "blur");

    let mut level = blurred;
    for mip in 0..=6 {
        let n = N >> mip;
        assert!(reds(&mut session, "pyramid", mip) == level, "mip {mip}");
        level = (0..n / 2 * (n / 2))
            .map(|i| {
                let at = 2 * (i / (n / 2)) * n + 2 * (i % (n / 2));
                0.25 * (level[at] + level[at + 1] + level[at + n] + level[at + n + 1])
            })
            .collect();
    }

    let mut bins = vec![3; 16];
    for value in &source {
        bins[(value * 16.0) as usize] += 1;
    }
    assert_eq!(words(&mut session, "histogram"), bins);

    let bright: Vec<usize> = (0..N * N).filter(|i| source[*i] >= 0.75).collect();
    let list = words(&mut session, "list");
    assert_eq!(
        list[..4],
        [bright.len().div_ceil(32) as u32, 1, 1, bright.len() as u32]
    );
    let mut texels: Vec<usize> = list[4..4 + bright.len()]
        .iter()
        .map(|t| (t >> 16) as usize * N + (t & 0xffff) as usize)
        .collect();
    texels.sort_unstable();
    assert_eq!(texels, bright);
    let marks: Vec<f32> = source
        .iter()
        .map(|v| if *v >= 0.75 { 8.0 } else { 7.0 })
        .collect();
    assert!(reds(&mut session, "kept", 0) == marks, "marks");

    let round = |v: f32| (v * 255.0).round() as u32;
    for (i, texel) in floats(&mut session, "unpacked", 0).iter().enumerate() {
        let pack = |k: usize| {
            let (x, y) = (i % 16 * 4 + k % 4, i / 16 * 4 + k / 4);
            let value = [
                (x & 3) as f32 / 4.0,
                (y & 3) as f32 / 4.0,
                1.0,
                source[y * N + x],
            ];
            value.iter().rev().fold(0, |word, v| word << 8 | round(*v))
        };
        let most = (0..16).map(pack).max().unwrap();
        let found = texel.iter().rev().fold(0, |word, v| word << 8 | round(*v));
        assert_eq!(found, most, "block {i}");
    }
}

#[test]
fn what_nobody_needs_is_neither_run_nor_made() {
    let bench = Bench::new(IMAGES, IMAGE_SHADERS);
    let lab = bench.lab();
    let ran = |session: &Session| -> Vec<String> {
        let mut list: Vec<String> = session
            .program
            .plan
            .steps
            .iter()
            .map(|s| session.graph.passes[s.pass].value.name.value.clone())
            .collect();
        list.dedup();
        list
    };
    let made = |session: &Session| -> Vec<(String, u64)> { session.program.memory(&session.graph) };
    let session = bench.run(&lab, &["histogram"], 1);
    assert_eq!(ran(&session), ["source", "no counts", "count"]);
    let names: Vec<String> = made(&session).into_iter().map(|m| m.0).collect();
    assert_eq!(names, ["source", "histogram"]);
    let session = bench.run(&lab, &["kept"], 1);
    assert_eq!(
        ran(&session),
        [
            "source",
            "no list",
            "collect",
            "size",
            "no marks",
            "mark",
            "keep marks"
        ]
    );
    let source = made(&session).iter().find(|m| m.0 == "source").unwrap().1;
    assert!(
        (64 * 64 * 4..64 * 64 * 8).contains(&source),
        "{source} bytes"
    );
    let session = bench.run(&lab, &["packed"], 1);
    assert_eq!(ran(&session), ["source", "nothing packed", "pack"]);
}

#[test]
fn stores_that_nobody_needs_are_taken_out_of_compute_shaders() {
    // Three images that are only written, one that keeps what it held, and one whose size decides what is done.
    let bench = Bench::new(
        r#"(
            textures: {
                "first": (size: (16, 8), format: "rgba32f"),
                "second": (size: (16, 8), format: "rgba32f"),
                "sized": (size: (16, 8), format: "rgba32f"),
                "sum": (size: (16, 8), format: "r32f", history: true),
                "left": (size: (16, 8), format: "rgba32f"),
            },
            buffers: { "count": (size: 4) },
            passes: [
                (name: "forget", clear: "count"),
                (name: "ground", clear: "left", value: (7, 7, 7, 7)),
                (name: "many", shaders: ["many.comp"], dispatch: Cover("first"), bind: { "before": (of: "sum", history: true) }),
                (name: "again", shaders: ["again.comp"], dispatch: Cover("second")),
            ],
            outputs: ["first", "second", "sized", "sum", "left"],
        )"#,
        &[
            (
                "many.comp",
                "layout(local_size_x = 8, local_size_y = 8) in;
                uniform writeonly image2D first;
                uniform writeonly image2D second;
                layout(rgba32f) uniform image2D sized;
                layout(r32f) uniform image2D sum;
                layout(rgba32f) uniform image2D left;
                uniform sampler2D before;
                layout(std430) buffer Count { uint n; } count;
                void main() {
                    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
                    if (any(greaterThanEqual(p, imageSize(sized)))) return;
                    atomicAdd(count.n, 1u);
                    imageStore(first, p, vec4(1.0, p, 0.5));
                    imageStore(second, p, vec4(2.0, p, 0.5));
                    for (int i = 0; i < 2; i++) imageStore(sized, p, vec4(3.0 + i, p, 0.5));
                    imageStore(sum, p, texelFetch(before, p, 0) + 1.0);
                    if (p.x < 8) imageStore(left, p, vec4(5.0));
                }",
            ),
            (
                "again.comp",
                "layout(local_size_x = 8, local_size_y = 8) in;
                uniform sampler2D first;
                layout(rgba32f) uniform image2D second;
                void main() {
                    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
                    imageStore(second, p, imageLoad(second, p) + texelFetch(first, p, 0));
                }",
            ),
        ],
    );
    let lab = bench.lab();
    let made = |session: &Session| -> Vec<String> {
        session
            .program
            .memory(&session.graph)
            .into_iter()
            .map(|m| m.0)
            .collect()
    };
    // The image that is asked for its size is there and stays as it was; the sum of the frame before is read.
    let mut session = bench.run(&lab, &["count"], 1);
    assert_eq!(made(&session), ["sized", "sum", "count"]);
    assert_eq!(words(&mut session, "count"), [16 * 8]);
    assert_eq!(reds(&mut session, "sized", 0), [0.0; 128]);
    let mut session = bench.run(&lab, &["first"], 1);
    assert_eq!(made(&session), ["first", "sized", "sum", "count"]);
    assert_eq!(floats(&mut session, "first", 0)[17], [1.0, 1.0, 1.0, 0.5]);
    // A later pass needs both.
    let mut session = bench.run(&lab, &["second"], 1);
    assert_eq!(made(&session), ["first", "second", "sized", "sum", "count"]);
    assert_eq!(floats(&mut session, "second", 0)[17], [3.0, 2.0, 2.0, 1.0]);
    let mut session = bench.run(&lab, &["sized"], 1);
    assert_eq!(made(&session), ["sized", "sum", "count"]);
    assert_eq!(reds(&mut session, "sized", 0), [4.0; 128]);
    // What this frame stores is what the next one reads.
    let mut session = bench.run(&lab, &["sum"], 5);
    assert_eq!(made(&session), ["sized", "sum", "count"]);
    assert_eq!(reds(&mut session, "sum", 0), [5.0; 128]);
    // A part is stored; the rest is what was there.
    let mut session = bench.run(&lab, &["left"], 2);
    assert_eq!(made(&session), ["sized", "sum", "left", "count"]);
    let expected: Vec<f32> = (0..128)
        .map(|i| if i % 16 < 8 { 5.0 } else { 7.0 })
        .collect();
    assert_eq!(reds(&mut session, "left", 0), expected);
    // All together are the same.
    let mut session = bench.run(&lab, &["first", "second", "sized", "sum", "left"], 5);
    assert_eq!(reds(&mut session, "sum", 0), [5.0; 128]);
    assert_eq!(reds(&mut session, "left", 0), expected);
    assert_eq!(floats(&mut session, "second", 0)[17], [3.0, 2.0, 2.0, 1.0]);
}

#[test]
fn pixels_of_a_triangle_by_samples() {
    // A triangle drawn without attachments: with several samples a fragment runs where any of them is inside.
    let bench = Bench::new(
        r#"(
            params: [Int(name: "sample_count", default: 1, range: (1, 16), help: "Samples a pixel.")],
            buffers: { "hits": (size: "32 * 32 * 4") },
            passes: [
                (name: "no hits", clear: "hits"),
                (name: "draw", shaders: ["corner.vert", "hit.frag"], draw: Fullscreen,
                    raster: (size: (32, 32), samples: "sample_count")),
            ],
        )"#,
        &[
            (
                "corner.vert",
                "const vec2 corners[3] = vec2[](vec2(3.3, 2.1), vec2(29.7, 11.4), vec2(8.2, 30.6));
                void main() { gl_Position = vec4(corners[gl_VertexIndex] / 16.0 - 1.0, 0.0, 1.0); }",
            ),
            (
                "hit.frag",
                "layout(std430) buffer Hits { uint n[]; } hits;
                void main() { uvec2 p = uvec2(gl_FragCoord.xy); atomicAdd(hits.n[p.y * 32 + p.x], 1u); }",
            ),
        ],
    );
    let lab = bench.lab();
    let corners = [[3.3f32, 2.1], [29.7, 11.4], [8.2, 30.6]];
    let inside = |x: f32, y: f32| {
        (0..3).all(|i| {
            let ([ax, ay], [bx, by]) = (corners[i], corners[(i + 1) % 3]);
            (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0.0
        })
    };
    // Vulkan's standard sample locations, in sixteenths.
    let four = [[6, 2], [14, 6], [2, 10], [10, 14]];
    for (samples, places) in [(1, &[[8, 8]][..]), (4, &four[..])] {
        bench.write(
            "configs/run.ron",
            &format!("(graph: \"graph.ron\", scene: \"triangles\", size: (32, 24), params: {{ \"sample_count\": {samples} }})"),
        );
        let found = words(&mut bench.run(&lab, &["hits"], 2), "hits");
        let expected: Vec<u32> = (0..1024)
            .map(|i| {
                let (x, y) = ((i % 32) as f32, (i / 32) as f32);
                u32::from(
                    places
                        .iter()
                        .any(|[a, b]| inside(x + *a as f32 / 16.0, y + *b as f32 / 16.0)),
                )
            })
            .collect();
        // A sample on an edge may fall either way.
        let different = found.iter().zip(&expected).filter(|(a, b)| a != b).count();
        assert!(
            different <= 2,
            "{samples} samples: {different} of {} pixels differ",
            expected.iter().sum::<u32>()
        );
    }
}

#[test]
fn raster_stages_targets_and_blending() {
    let bench = Bench::new(
        r#"(
            textures: {
                "gradient": (size: ("width", "height"), format: "rgba32f"),
                "sum": (size: ("width", "height"), format: "rgba16f"),
                "quads": (size: ("width", "height"), format: "r8"),
                "plain": (size: ("width", "height"), format: "r32f"),
                "curved": (size: ("width", "height"), format: "r32f"),
                "near": (size: ("width", "height"), format: "d32", sampler: (compare: less)),
                "lit": (size: ("width", "height"), format: "r32f"),
                "layers": (size: (8, 8), format: "r32f", layers: "3", mips: "2"),
                "stack": (size: (8, 8), format: "r32f", layers: "3"),
            },
            buffers: { "points": (size: 16) },
            passes: [
                (name: "gradient", shaders: ["full.vert", "gradient.frag"], draw: Fullscreen, color: [(to: "gradient")]),
                (name: "sum begin", clear: "sum", value: (1, 0, 0, 0)),
                (name: "sum", repeat: 3, shaders: ["full.vert", "index.frag"], draw: Fullscreen, color: [(to: "sum", blend: add)]),
                (name: "quads", topology: points, shaders: ["point.vert", "quad.geom", "one.frag"], draw: Fullscreen,
                    color: [(to: "quads", clear: (0, 0, 0, 0))]),
                (name: "plain", shaders: ["triangle.vert", "one.frag"], draw: Fullscreen, color: [(to: "plain", clear: (0, 0, 0, 0))]),
                (name: "curved", topology: patches, shaders: ["triangle.vert", "split.tesc", "flat.tese", "one.frag"],
                    draw: Fullscreen, color: [(to: "curved", clear: (0, 0, 0, 0))]),
                (name: "no points", clear: "points"),
                (name: "points", topology: patches, shaders: ["triangle.vert", "split.tesc", "count.tese"], draw: Fullscreen,
                    raster: (discard: true)),
                (name: "near", shaders: ["half.vert"], draw: Fullscreen, depth: (to: "near", clear: 1.0)),
                (name: "lit", shaders: ["full.vert", "lit.frag"], draw: Fullscreen, color: [(to: "lit")]),
                (name: "layers", repeat: 3, shaders: ["full.vert", "layer.frag"], draw: Fullscreen,
                    color: [(to: "layers", layer: "index", mip: 1)]),
                (name: "stack", shaders: ["stack.comp"], dispatch: Threads(8, 8, 3)),
            ],
        )"#,
        &[
            ("full.vert", FULL),
            (
                "gradient.frag",
                "layout(location = 0) out vec4 color; void main() { color = vec4(gl_FragCoord.xy, 0.5, 1.0); }",
            ),
            (
                "index.frag",
                "#include \"params.glsl\"
                layout(location = 0) out vec4 color; void main() { color = vec4(1.0, pass.index, 0.0, 0.25); }",
            ),
            (
                "point.vert",
                "void main() { gl_Position = vec4(float(gl_VertexIndex), 0.0, 0.0, 1.0); gl_PointSize = 1.0; }",
            ),
            (
                "quad.geom",
                "layout(points) in;
                layout(triangle_strip, max_vertices = 4) out;
                void main() {
                    for (int i = 0; i < 4; i++) {
                        vec2 pixel = vec2(4.0 * gl_in[0].gl_Position.x, 3.0) + vec2(i & 1, i >> 1) * vec2(2.0, 5.0);
                        gl_Position = vec4(pixel / vec2(16.0, 12.0) - 1.0, 0.0, 1.0);
                        EmitVertex();
                    }
                }",
            ),
            ("one.frag", "layout(location = 0) out float color; void main() { color = 1.0; }"),
            (
                "triangle.vert",
                "const vec2 corners[3] = vec2[](vec2(-0.9, -0.8), vec2(0.8, -0.3), vec2(-0.2, 0.9));
                void main() { gl_Position = vec4(corners[gl_VertexIndex], 0.0, 1.0); }",
            ),
            (
                "split.tesc",
                "layout(vertices = 3) out;
                void main() {
                    gl_out[gl_InvocationID].gl_Position = gl_in[gl_InvocationID].gl_Position;
                    gl_TessLevelOuter = float[](4.0, 4.0, 4.0, 0.0);
                    gl_TessLevelInner = float[](4.0, 0.0);
                }",
            ),
            (
                "flat.tese",
                "layout(triangles, equal_spacing, ccw) in;
                void main() {
                    gl_Position = gl_TessCoord.x * gl_in[0].gl_Position + gl_TessCoord.y * gl_in[1].gl_Position
                        + gl_TessCoord.z * gl_in[2].gl_Position;
                }",
            ),
            (
                "count.tese",
                "layout(triangles, equal_spacing, point_mode) in;
                layout(std430) buffer Points { uint n; uint corners[3]; } points;
                void main() {
                    atomicAdd(points.n, 1u);
                    for (int i = 0; i < 3; i++) if (gl_TessCoord[i] == 1.0) atomicAdd(points.corners[i], 1u);
                    gl_Position = vec4(0.0);
                }",
            ),
            (
                "half.vert",
                "void main() {
                    vec2 corner = vec2[](vec2(0, -4), vec2(0, 4), vec2(-4, 0))[gl_VertexIndex];
                    gl_Position = vec4(corner, 0.25, 1.0);
                }",
            ),
            (
                "lit.frag",
                "uniform sampler2DShadow near;
                layout(location = 0) out float lit;
                void main() { lit = texture(near, vec3(gl_FragCoord.xy / vec2(32.0, 24.0), 0.5)); }",
            ),
            (
                "layer.frag",
                "#include \"params.glsl\"
                layout(location = 0) out float color; void main() { color = 10.0 + float(pass.index); }",
            ),
            (
                "stack.comp",
                "layout(local_size_x = 4, local_size_y = 4) in;
                uniform sampler2DArray layers;
                uniform writeonly image2DArray stack;
                void main() {
                    ivec3 p = ivec3(gl_GlobalInvocationID);
                    imageStore(stack, p, texelFetch(layers, ivec3(p.xy / 2, p.z), 1) + float(p.x));
                }",
            ),
        ],
    );
    let lab = bench.lab();
    let wanted = [
        "gradient", "sum", "quads", "plain", "curved", "points", "lit", "stack",
    ];
    let mut session = bench.run(&lab, &wanted, 5);
    let at = |i: usize| (i % 32, i / 32);
    for (i, t) in floats(&mut session, "gradient", 0).iter().enumerate() {
        assert_eq!(*t, [at(i).0 as f32 + 0.5, at(i).1 as f32 + 0.5, 0.5, 1.0]);
    }
    assert!(
        floats(&mut session, "sum", 0)
            .iter()
            .all(|t| *t == [4.0, 3.0, 0.0, 0.75]),
        "sums of three draws over a clear"
    );
    for (i, v) in reds(&mut session, "quads", 0).iter().enumerate() {
        let (x, y) = at(i);
        assert_eq!(
            *v,
            f32::from(u8::from(x < 12 && x % 4 < 2 && (3..8).contains(&y))),
            "quads at {x}, {y}"
        );
    }
    let plain = reds(&mut session, "plain", 0);
    let split = reds(&mut session, "curved", 0);
    let covered = plain.iter().sum::<f32>();
    let different = plain.iter().zip(&split).filter(|(a, b)| a != b).count();
    assert!(
        covered > 200.0 && different <= 4,
        "{different} of {covered} pixels differ when the triangle is split"
    );
    // Level 4: rings of 12, 6 and 1 points (Vulkan specification, "Triangle Tessellation"), each corner once.
    assert_eq!(words(&mut session, "points"), [19, 1, 1, 1]);
    for (i, v) in reds(&mut session, "lit", 0).iter().enumerate() {
        assert_eq!(
            *v,
            if at(i).0 < 16 { 0.0 } else { 1.0 },
            "depth comparison at {:?}",
            at(i)
        );
    }
    for layer in 0..3 {
        let texels = session.texels("stack", 0, layer).unwrap().floats();
        let expected: Vec<f32> = (0..64)
            .map(|i| 10.0 + layer as f32 + (i % 8) as f32)
            .collect();
        assert_eq!(
            texels.iter().map(|t| t[0]).collect::<Vec<_>>(),
            expected,
            "layer {layer}"
        );
    }
    assert_clean(&lab);
}

#[test]
fn an_image_that_only_atomics_touch_is_written() {
    let bench = Bench::new(
        r#"(
            textures: { "count": (size: (4, 4), format: "r32ui") },
            passes: [
                (name: "no counts", clear: "count"),
                (name: "count", shaders: ["count.comp"], dispatch: Groups(10, 1, 1)),
            ],
        )"#,
        &[(
            "count.comp",
            "layout(local_size_x = 16) in;
            layout(r32ui) uniform uimage2D count;
            void main() { imageAtomicAdd(count, ivec2(gl_LocalInvocationID.x & 3, gl_LocalInvocationID.x >> 2), 1u); }",
        )],
    );
    let lab = bench.lab();
    assert_eq!(
        reds(&mut bench.run(&lab, &["count"], 3), "count", 0),
        [10.0; 16]
    );
}

#[test]
fn hazards_of_every_kind_over_many_frames() {
    // Each pass depends on the one before through the same buffer or texture: read after write, write after read, write
    // after write; one lost write shows in the sum.
    let bench = Bench::new(
        r#"(
            textures: { "t": (size: (8, 8), format: "r32f", history: true), "u": (size: (8, 8), format: "r32f") },
            buffers: { "b": (size: 256), "log": (size: 256) },
            passes: [
                (name: "b to t", shaders: ["b_to_t.comp"], dispatch: Groups(1, 1, 1)),
                (name: "t to u", shaders: ["t_to_u.comp"], dispatch: Groups(1, 1, 1)),
                (name: "u to b", shaders: ["u_to_b.comp"], dispatch: Groups(1, 1, 1), bind: { "past": (of: "t", history: true) }),
                (name: "keep b", shaders: ["keep_b.comp"], dispatch: Groups(1, 1, 1)),
                (name: "t again", shaders: ["t_again.comp"], dispatch: Groups(1, 1, 1)),
                (name: "draw u", shaders: ["full.vert", "add.frag"], draw: Fullscreen, color: [(to: "u", blend: add)]),
            ],
        )"#,
        &[
            ("full.vert", FULL),
            (
                "b_to_t.comp",
                "layout(local_size_x = 8, local_size_y = 8) in;
                layout(std430) readonly buffer B { uint n[]; } b;
                uniform writeonly image2D t;
                void main() { imageStore(t, ivec2(gl_LocalInvocationID.xy), vec4(b.n[gl_LocalInvocationIndex] + 1u)); }",
            ),
            (
                "t_to_u.comp",
                "layout(local_size_x = 8, local_size_y = 8) in;
                uniform sampler2D t;
                uniform writeonly image2D u;
                void main() {
                    ivec2 p = ivec2(gl_LocalInvocationID.xy);
                    imageStore(u, p, texelFetch(t, p, 0));
                }",
            ),
            (
                "keep_b.comp",
                "layout(local_size_x = 64) in;
                layout(std430) readonly buffer B { uint n[]; } b;
                layout(std430) writeonly buffer Log { uint n[]; } log;
                void main() { log.n[gl_LocalInvocationIndex] = b.n[gl_LocalInvocationIndex]; }",
            ),
            (
                "u_to_b.comp",
                "layout(local_size_x = 8, local_size_y = 8) in;
                uniform sampler2D u;
                uniform sampler2D past;
                layout(std430) buffer B { uint n[]; } b;
                void main() {
                    ivec2 p = ivec2(gl_LocalInvocationID.xy);
                    b.n[gl_LocalInvocationIndex] = uint(texelFetch(u, p, 0).r + texelFetch(past, p, 0).r * 0.5);
                }",
            ),
            (
                "t_again.comp",
                "layout(local_size_x = 8, local_size_y = 8) in;
                layout(r32f) uniform image2D t;
                void main() { ivec2 p = ivec2(gl_LocalInvocationID.xy); imageStore(t, p, vec4(2.0)); }",
            ),
            (
                "add.frag",
                "layout(location = 0) out vec4 color; void main() { color = vec4(100.0); }",
            ),
        ],
    );
    let lab = bench.lab();
    let mut session = bench.run(&lab, &["log", "u", "t"], 40);
    // b' = (b + 1) + past / 2, with past = 0 in the first frame and 2 in all others.
    assert_eq!(words(&mut session, "log"), [40 + 39; 64]);
    assert_eq!(reds(&mut session, "t", 0), [2.0; 64]);
    assert_eq!(reds(&mut session, "u", 0), [78.0 + 1.0 + 100.0 - 1.0; 64]);
}

#[test]
fn what_is_transient_shares_memory_and_changes_nothing() {
    // A chain through buffers, images and attachments, each needed until the next but one is there.
    let graph = r#"(
        params: [
            Float(name: "first", default: 1, range: (0, 100), help: "Added at the start."),
            Float(name: "last", default: 0, range: (0, 100), help: "Added at the end."),
        ],
        textures: {
            "t": (size: (64, 64), format: "r32f", transient: true),
            "drawn": (size: (64, 64), format: "r32f", transient: true),
            "copied": (size: (64, 64), format: "r32f", transient: true),
        },
        buffers: {
            "a": (size: 16384, transient: true),
            "b": (size: 16384, transient: true),
            "result": (size: 16384),
        },
        passes: [
            (name: "start", shaders: ["start.comp"], dispatch: Groups(64, 1, 1)),
            (name: "a to t", shaders: ["a_to_t.comp"], dispatch: Cover("t")),
            (name: "draw", shaders: ["full.vert", "draw.frag"], draw: Fullscreen, color: [(to: "drawn", clear: (0, 0, 0, 0))]),
            (name: "copy", shaders: ["copy.comp"], dispatch: Cover("copied")),
            (name: "drawn to b", shaders: ["drawn_to_b.comp"], dispatch: Groups(64, 1, 1)),
            (name: "a anew", clear: "a"),
            (name: "a again", shaders: ["a_again.comp"], dispatch: Groups(64, 1, 1)),
            (name: "sum", shaders: ["sum.comp"], dispatch: Groups(64, 1, 1)),
        ],
    )"#;
    let line = "layout(local_size_x = 64) in;\n#include \"params.glsl\"\nuint i() { return gl_GlobalInvocationID.x; }\n";
    let buffer = |kind: &str, block: &str, name: &str| {
        format!("layout(std430) {kind} buffer {block} {{ float list[]; }} {name};\n")
    };
    let shaders = [
        ("full.vert", FULL.to_string()),
        (
            "start.comp",
            format!(
                "{line}{}void main() {{ a.list[i()] = float(i()) + params.first; }}",
                buffer("writeonly", "A", "a")
            ),
        ),
        (
            "copy.comp",
            "layout(local_size_x = 8, local_size_y = 8) in;
            uniform sampler2D drawn;
            uniform writeonly image2D copied;
            void main() {
                ivec2 p = ivec2(gl_GlobalInvocationID.xy);
                imageStore(copied, p, texelFetch(drawn, p, 0));
            }"
            .to_string(),
        ),
        (
            "a_to_t.comp",
            format!(
                "layout(local_size_x = 8, local_size_y = 8) in;\n{}uniform writeonly image2D t;\nvoid main() {{
                    uvec2 p = gl_GlobalInvocationID.xy;
                    imageStore(t, ivec2(p), vec4(a.list[64u * p.y + p.x] + 1.0));
                }}",
                buffer("readonly", "A", "a")
            ),
        ),
        (
            "draw.frag",
            "uniform sampler2D t; layout(location = 0) out float red;
            void main() { red = texelFetch(t, ivec2(gl_FragCoord.xy), 0).r + 1.0; }"
                .to_string(),
        ),
        (
            "drawn_to_b.comp",
            format!(
                "{line}{}uniform sampler2D drawn;
                void main() {{ b.list[i()] = texelFetch(drawn, ivec2(i() & 63u, i() >> 6), 0).r + 1.0; }}",
                buffer("writeonly", "B", "b")
            ),
        ),
        (
            "a_again.comp",
            format!(
                "{line}{}{}void main() {{ a.list[i()] = 10.0 * b.list[i()]; }}",
                buffer("writeonly", "A", "a"),
                buffer("readonly", "B", "b")
            ),
        ),
        (
            "sum.comp",
            format!(
                "{line}{}{}{}uniform sampler2D copied;
                void main() {{
                    float red = texelFetch(copied, ivec2(i() & 63u, i() >> 6), 0).r;
                    result.list[i()] = a.list[i()] + b.list[i()] + red + params.last;
                }}",
                buffer("readonly", "A", "a"),
                buffer("readonly", "B", "b"),
                buffer("writeonly", "Result", "result")
            ),
        ),
    ];
    let shaders: Vec<(&str, &str)> = shaders
        .iter()
        .map(|(name, text)| (*name, text.as_str()))
        .collect();
    let bench = Bench::new(graph, &shaders);
    let lab = bench.lab();
    let expected = |first: f32, last: f32| -> Vec<u32> {
        let of = |i: u16| 12.0 * (f32::from(i) + first) + 35.0 + last;
        (0..4096).map(|i| of(i).to_bits()).collect()
    };
    let bytes = |s: &Session| s.program.memory(&s.graph).iter().map(|m| m.1).sum::<u64>();

    let mut session = bench.run(&lab, &["result"], 5);
    assert_eq!(words(&mut session, "result"), expected(1.0, 0.0));
    let alone = bench.run(&lab, &["result", "t", "drawn", "copied", "a", "b"], 1);
    println!("{} bytes, alone {}", bytes(&session), bytes(&alone));
    assert!(
        bytes(&session) + 2 * 16384 <= bytes(&alone),
        "at most three of the five at a time"
    );
    assert!(
        session
            .texels("t", 0, 0)
            .unwrap_err()
            .to_string()
            .contains("'t' is transient")
    );

    // A skipped pass leaves nothing in them: it runs again for a pass that reads.
    session.set_execution(conelab::graph::run::Execution::Incremental);
    let mut params = session.params.clone();
    for (frame, (name, value)) in [
        ("last", "1"),
        ("last", "2"),
        ("first", "7"),
        ("last", "2"),
        ("last", "3"),
    ]
    .iter()
    .enumerate()
    {
        params.set(name, value).unwrap();
        assert!(session.set_params(&lab, &params).unwrap());
        session.frame(0.0).unwrap();
        let times = session.finish().unwrap();
        let (first, last) = (
            [1.0, 1.0, 7.0, 7.0, 7.0][frame],
            [1.0, 2.0, 2.0, 2.0, 3.0][frame],
        );
        assert_eq!(
            words(&mut session, "result"),
            expected(first, last),
            "frame {frame}"
        );
        let skipped = times.last().unwrap().skipped.len();
        assert_eq!(skipped, if frame == 3 { 8 } else { 0 }, "frame {frame}");
    }

    // A program made from the parts of another takes the memory over, and one that wants more does not.
    for wanted in [&["result"][..], &["result", "t"]] {
        let experiment = Experiment::read(&bench.path("configs/run.ron")).unwrap();
        let loaded = lab
            .home
            .load_for(&experiment, &session.scene, &lab.gpu.info)
            .unwrap();
        let list = wanted.iter().map(|w| String::from(*w)).collect();
        let parts = session.reusable_parts();
        let mut next = lab
            .build(
                &experiment,
                &loaded,
                session.scene.clone(),
                list,
                Some(&parts),
            )
            .unwrap();
        assert_eq!(
            next.program.change.resized,
            if wanted.len() == 1 { 0 } else { 5 }
        );
        next.swap_in(&mut session).unwrap();
        next.frame(0.0).unwrap();
        next.finish().unwrap();
        assert_eq!(words(&mut next, "result"), expected(1.0, 0.0));
        session = next;
    }
    let t: Vec<f32> = (0..4096u16).map(|i| f32::from(i) + 2.0).collect();
    assert_eq!(reds(&mut session, "t", 0), t);
    assert_clean(&lab);
}

#[test]
fn a_constant_parameter_is_a_specialisation_constant() {
    let bench = Bench::new(
        r#"(
            params: [
                Int(name: "taps", default: 3, range: (1, 9), constant: true, help: "Loop count."),
                Choice(name: "mode", options: ["sum", "product"], constant: true, help: "What is done."),
                Bool(name: "negate", default: false, constant: true, help: "Sign."),
                Float(name: "scale", default: 2, range: (0, 10), constant: true, help: "Factor."),
                Float(name: "offset", default: 0, range: (0, 10), help: "Not constant."),
            ],
            buffers: { "result": (size: 16) },
            passes: [(name: "run", shaders: ["run.comp"], dispatch: Groups(1, 1, 1))],
        )"#,
        &[(
            "run.comp",
            "#include \"params.glsl\"
            layout(std430) writeonly buffer Result { float value; } result;
            void main() {
                float values[TAPS];
                float total = MODE == MODE_SUM ? 0.0 : 1.0;
                for (int i = 0; i < TAPS; i++) {
                    values[i] = float(i + 1);
                    total = MODE == MODE_SUM ? total + values[i] : total * values[i];
                }
                result.value = (NEGATE ? -1.0 : 1.0) * SCALE * total + params.offset;
            }",
        )],
    );
    let lab = bench.lab();
    for (settings, expected) in [
        ("", 12.0),
        ("\"taps\": 5", 30.0),
        ("\"taps\": 4, \"mode\": \"product\", \"scale\": 0.5", 12.0),
        ("\"negate\": true, \"offset\": 1.0", -11.0),
    ] {
        bench.write(
            "configs/run.ron",
            &format!("(graph: \"graph.ron\", scene: \"triangles\", size: (8, 8), params: {{ {settings} }})"),
        );
        let found = f32::from_bits(words(&mut bench.run(&lab, &["result"], 1), "result")[0]);
        assert_eq!(found, expected, "{settings}");
    }
}

#[test]
fn a_pass_a_texture_and_a_parameter_take_no_rust() {
    let bench = Bench::new(
        r#"(
            params: [Float(name: "level", default: 0.25, range: (0.0, 1.0), help: "Grey.")],
            textures: { "picture": (size: ("width", "height"), format: "rgba8") },
            passes: [
                (name: "fill", shaders: ["fill.comp"], dispatch: Cover("picture")),
            ],
            output: "picture",
        )"#,
        &[(
            "fill.comp",
            "#include \"params.glsl\"
            layout(local_size_x = 8, local_size_y = 8) in;
            uniform writeonly image2D picture;
            void main() { imageStore(picture, ivec2(gl_GlobalInvocationID.xy), vec4(params.level)); }",
        )],
    );
    let render = |settings: &[&str]| {
        let mut command = conelab(bench.0.path());
        command.args([
            "render",
            "configs/run.ron",
            "-o",
            "out.png",
            "--json",
            "out.json",
        ]);
        command.args(settings.iter().flat_map(|s| ["--set", s]));
        succeeds(&mut command);
        let stats: serde_json::Value =
            serde_json::from_slice(&std::fs::read(bench.path("out.json")).unwrap()).unwrap();
        let picture = image::open(bench.path("out.png")).unwrap().to_rgb8();
        (picture.get_pixel(10, 10).0, stats)
    };
    let names = |list: &serde_json::Value| -> Vec<String> {
        list.as_array()
            .unwrap()
            .iter()
            .map(|p| p["name"].as_str().unwrap().to_string())
            .collect()
    };
    let (pixel, stats) = render(&[]);
    assert_eq!(pixel, [64; 3]);
    assert_eq!(names(&stats["passes"]), ["fill"]);
    assert_eq!(stats["params"], serde_json::json!({ "level": 0.25 }));

    // A tint: one parameter, one texture, one pass, one shader.
    bench.edit(
        "passes/graph.ron",
        "help: \"Grey.\")]",
        "help: \"Grey.\"),\n Colour(name: \"tint\", default: (1, 0.5, 0), help: \"Hue.\")]",
    );
    bench.edit("passes/graph.ron", "textures: {", "textures: { \"grey\": (size: (\"width\", \"height\"), format: \"rgba8\"), \"unused\": (size: (512, 512), format: \"rgba8\"),");
    bench.edit("passes/graph.ron", "dispatch: Cover(\"picture\")),", "dispatch: Cover(\"grey\"), bind: { \"picture\": (of: \"grey\") }),\n (name: \"tint\", shaders: [\"full.vert\", \"tint.frag\"], draw: Fullscreen, color: [(to: \"picture\")]),\n (name: \"idle\", shaders: [\"fill.comp\"], dispatch: Cover(\"unused\"), bind: { \"picture\": (of: \"unused\") }),");
    bench.write("shaders/full.vert", &glsl(FULL));
    bench.write(
        "shaders/tint.frag",
        &glsl(
            "#include \"params.glsl\"
            uniform sampler2D grey;
            layout(location = 0) out vec4 color;
            void main() { color = texelFetch(grey, ivec2(gl_FragCoord.xy), 0) * vec4(params.tint, 1.0); }",
        ),
    );
    let (pixel, stats) = render(&["level=1"]);
    // Half may be stored as 127 or 128 (Vulkan, section 3.10.1).
    assert!(
        pixel[0] == 255 && (127..=128).contains(&pixel[1]) && pixel[2] == 0,
        "{pixel:?}"
    );
    assert_eq!(names(&stats["passes"]), ["fill", "tint"]);
    assert_eq!(
        stats["params"],
        serde_json::json!({ "level": 1.0, "tint": [1.0, 0.5, 0.0] })
    );
    // What nobody needs takes no memory.
    let made: Vec<&str> = stats["bytes"]
        .as_object()
        .unwrap()
        .keys()
        .map(String::as_str)
        .collect();
    assert_eq!(made, ["grey", "picture"]);
    let (pixel, stats) = render(&["level=1", "tint=(0, 1, 0.25)"]);
    assert_eq!(pixel, [0, 255, 64]);
    assert_eq!(stats["params"]["tint"], serde_json::json!([0.0, 1.0, 0.25]));
}

/// A parameter of some kind with a value: its RON kind, the value as RON, and the words a shader must see.
fn parameter() -> impl Strategy<Value = (&'static str, String, Vec<u32>)> {
    let float = || (-1000i32..1000).prop_map(|v| v as f32 / 8.0);
    let vector = |kind: &'static str, n: usize| {
        prop::collection::vec(float(), n).prop_map(move |v| {
            let text: Vec<String> = v.iter().map(|x| format!("{x:?}")).collect();
            (
                kind,
                format!("({})", text.join(", ")),
                v.iter().map(|x| x.to_bits()).collect(),
            )
        })
    };
    prop_oneof![
        any::<bool>().prop_map(|v| ("Bool", v.to_string(), vec![u32::from(v)])),
        any::<i32>().prop_map(|v| ("Int", v.to_string(), vec![v.cast_unsigned()])),
        float().prop_map(|v| ("Float", format!("{v:?}"), vec![v.to_bits()])),
        vector("Vec2", 2),
        vector("Vec3", 3),
        vector("Vec4", 4),
        vector("Colour", 3),
        (0u32..3).prop_map(|v| ("Choice", format!("option{v}"), vec![v])),
    ]
}

/// What a shader reads of these parameters, in this order, when an experiment sets them.
fn read_by_shader(lab: &Lab, bench: &Bench, list: &[(&str, String, Vec<u32>)]) -> Vec<u32> {
    let (mut decls, mut set, mut reads, mut n) = (String::new(), String::new(), String::new(), 0);
    for (i, (kind, value, words)) in list.iter().enumerate() {
        let default = match *kind {
            "Bool" => "default: false",
            "Int" => "default: 0",
            "Float" => "default: 0",
            "Vec2" => "default: (0, 0)",
            "Vec4" => "default: (0, 0, 0, 0)",
            "Choice" => "options: [\"option0\", \"option1\", \"option2\"]",
            _ => "default: (0, 0, 0)",
        };
        writeln!(
            decls,
            "{kind}(name: \"p{i}\", {default}, help: \"Number {i}.\"),"
        )
        .unwrap();
        let quote = if *kind == "Choice" { "\"" } else { "" };
        writeln!(set, "\"p{i}\": {quote}{value}{quote},").unwrap();
        for c in 0..words.len() {
            let read = match *kind {
                "Bool" => format!("uint(params.p{i})"),
                "Int" | "Choice" => format!("uint(params.p{i})"),
                "Float" => format!("floatBitsToUint(params.p{i})"),
                _ => format!("floatBitsToUint(params.p{i}[{c}])"),
            };
            writeln!(reads, "seen.words[{n}] = {read};").unwrap();
            n += 1;
        }
    }
    bench.write(
        "passes/graph.ron",
        &format!(
            "(params: [{decls}], buffers: {{ \"seen\": (size: \"{n} * 4\") }},
            passes: [(name: \"read\", shaders: [\"read.comp\"], dispatch: Groups(1, 1, 1))])"
        ),
    );
    bench.write(
        "shaders/read.comp",
        &glsl(&format!(
            "#include \"params.glsl\"\nlayout(std430) writeonly buffer Seen {{ uint words[]; }} seen;\nvoid main() {{ {reads} }}"
        )),
    );
    bench.write(
        "configs/run.ron",
        &format!("(graph: \"graph.ron\", scene: \"triangles\", size: (8, 8), params: {{ {set} }})"),
    );
    words(&mut bench.run(lab, &["seen"], 1), "seen")
}

#[test]
fn shaders_see_parameters_of_every_kind() {
    let bench = Bench::new("()", &[]);
    let lab = bench.lab();
    // One of each, in an order that needs padding before and after.
    let f = f32::to_bits;
    let each = [
        ("Bool", "true".to_string(), vec![1]),
        (
            "Vec3",
            "(1.0, 2.0, 3.0)".to_string(),
            vec![f(1.0), f(2.0), f(3.0)],
        ),
        ("Float", "0.5".to_string(), vec![f(0.5)]),
        ("Vec2", "(-1.0, 7.0)".to_string(), vec![f(-1.0), f(7.0)]),
        ("Int", "-3".to_string(), vec![(-3i32).cast_unsigned()]),
        (
            "Vec4",
            "(4.0, 5.0, 6.0, 7.0)".to_string(),
            vec![f(4.0), f(5.0), f(6.0), f(7.0)],
        ),
        ("Choice", "option2".to_string(), vec![2]),
        (
            "Colour",
            "(0.25, 0.5, 0.75)".to_string(),
            vec![f(0.25), f(0.5), f(0.75)],
        ),
        ("Bool", "false".to_string(), vec![0]),
    ];
    let expected: Vec<u32> = each.iter().flat_map(|p| p.2.clone()).collect();
    assert_eq!(read_by_shader(&lab, &bench, &each), expected);

    // Any sequence (std140: scalars at 4, vec2 at 8, vec3 and vec4 at 16 bytes).
    let mut runner = TestRunner::new(Config {
        cases: 32,
        failure_persistence: None,
        ..Config::default()
    });
    runner
        .run(&prop::collection::vec(parameter(), 1..14), |list| {
            let expected: Vec<u32> = list.iter().flat_map(|p| p.2.clone()).collect();
            prop_assert_eq!(read_by_shader(&lab, &bench, &list), expected);
            Ok(())
        })
        .unwrap();
}

#[test]
fn named_values_reach_expressions_and_shaders() {
    let bench = Bench::new(
        r#"(
            include: ["rest.ron"],
            params: [
                Int(name: "cells", default: 5, range: (1, 64), help: "Cells."),
                Float(name: "level", default: 1.0, range: (0.0, 9.0), help: "Read by a value alone."),
                Vec3(name: "place", default: (1, 2, 3), help: "Moves what comes after it in the block."),
            ],
            values: {
                "bytes": Int("16 * blocks"),
                "blocks": Int("cells * 1.5"),
                "third": Float("level / 3"),
            },
            buffers: { "found": (size: "bytes") },
            passes: [
                (name: "tell", when: "blocks > 3", shaders: ["tell.comp"], dispatch: Groups("blocks", 1, 1)),
                (name: "never", when: "blocks > 100", shaders: ["tell.comp"], dispatch: Groups("blocks", 1, 1)),
            ],
        )"#,
        &[(
            "tell.comp",
            "#include \"params.glsl\"
            layout(local_size_x = 1) in;
            layout(std430) writeonly buffer Found { uvec4 list[]; } found;
            void main() {
                uint i = gl_GlobalInvocationID.x;
                found.list[i] = uvec4(i, params.blocks, floatBitsToUint(params.third), floatBitsToUint(params.width_3));
            }",
        )],
    );
    // Another file reads the values of this one, and this one's shader those of the other.
    bench.write(
        "passes/rest.ron",
        r#"(values: { "width_3": Float("width + blocks * place_z") })"#,
    );
    let lab = bench.lab();
    let mut session = bench.run(&lab, &["found"], 1);
    let expected = |third: f32| -> Vec<u32> {
        (0..7)
            .flat_map(|i| [i, 7, third.to_bits(), (32.0f32 + 7.0 * 3.0).to_bits()])
            .collect()
    };
    assert_eq!(
        words(&mut session, "found"),
        expected(1.0 / 3.0),
        "5 * 1.5, rounded down, is 7"
    );

    // What only shaders see is a write to a buffer; a size is another session.
    let mut params = session.params.clone();
    params.set("level", "6.0").unwrap();
    assert!(
        session.set_params(&lab, &params).unwrap(),
        "no session is made for a number"
    );
    session.frame(0.0).unwrap();
    session.finish().unwrap();
    assert_eq!(words(&mut session, "found"), expected(2.0));
    params.set("cells", "6").unwrap();
    assert!(
        !session.set_params(&lab, &params).unwrap(),
        "9 blocks need a longer buffer"
    );
    assert_clean(&lab);
    assert!(
        params
            .set("blocks", "3")
            .unwrap_err()
            .contains("no parameter 'blocks'"),
        "nobody sets a value"
    );
}

#[test]
fn clears_and_stores_of_a_part_keep_the_rest() {
    let bench = Bench::new(
        r#"(
            textures: {
                "stack": (size: (4, 4), format: "rgba8", layers: "3"),
                "sum": (size: (4, 4), format: "r32f", mips: "2"),
            },
            buffers: { "short": (size: 64), "long": (size: 128) },
            passes: [
                (name: "each layer", repeat: "3", shaders: ["full.vert", "one.frag"], draw: Fullscreen,
                    color: [(to: "stack", layer: "index", clear: (0, 0, 0, 0))]),
                (name: "fill long", clear: "long", value: (7, 0, 0, 0)),
                (name: "fill short", clear: "short", value: (5, 0, 0, 0)),
                (name: "copy", shaders: ["copy.comp"], dispatch: Groups(1, 1, 1)),
                (name: "add", shaders: ["add.comp"], dispatch: Cover("sum")),
            ],
        )"#,
        &[
            ("full.vert", FULL),
            ("one.frag", "layout(location = 0) out vec4 color; void main() { color = vec4(1.0); }"),
            (
                "copy.comp",
                "layout(local_size_x = 16) in;
                layout(std430) readonly buffer Short { uint words[]; } short_buffer;
                layout(std430) writeonly buffer Long { uint words[]; } long_buffer;
                void main() { long_buffer.words[gl_LocalInvocationIndex] = short_buffer.words[gl_LocalInvocationIndex]; }",
            ),
            (
                "add.comp",
                "layout(local_size_x = 4, local_size_y = 4) in;
                uniform sampler2DArray stack;
                layout(std430) readonly buffer Long { uint words[]; } long_buffer;
                layout(r32f) uniform writeonly image2D sum;
                void main() {
                    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
                    float s = 0.0;
                    for (int i = 0; i < 3; i++) s += texelFetch(stack, ivec3(p, i), 0).r;
                    imageStore(sum, p, vec4(s + float(long_buffer.words[0] + long_buffer.words[31])));
                }",
            ),
        ],
    );
    bench.write(
        "passes/graph.ron",
        &std::fs::read_to_string(bench.path("passes/graph.ron"))
            .unwrap()
            .replace("dispatch: Cover(\"sum\")", "dispatch: Cover(\"sum\"), bind: { \"long_buffer\": (of: \"long\") }")
            .replace(
                "dispatch: Groups(1, 1, 1))",
                "dispatch: Groups(1, 1, 1), bind: { \"long_buffer\": (of: \"long\"), \"short_buffer\": (of: \"short\") })",
            ),
    );
    let lab = bench.lab();
    let mut session = bench.run(&lab, &["sum"], 2);
    assert_eq!(reds(&mut session, "sum", 0), [3.0 + 5.0 + 7.0; 16]);
    // No pass touches this level: it holds the zeros it was made with.
    assert_eq!(reds(&mut session, "sum", 1), [0.0; 4]);
}

#[test]
fn a_session_that_is_dropped_waits_for_its_frames() {
    let bench = Bench::new(IMAGES, IMAGE_SHADERS);
    let lab = bench.lab();
    let mut session = bench.run(&lab, &["histogram"], 1);
    session.frame(0.0).unwrap();
    session.frame(0.0).unwrap();
    drop(session);
    assert_eq!(lab.gpu.messages(), Vec::<String>::new());
}

#[test]
fn a_table_is_filled_only_for_who_asks() {
    let bench = Bench::new(
        r#"(
            params: [Vec2(name: "spot", default: (-1.0, -1.0), help: "Pixel under the pointer.")],
            textures: { "picture": (size: ("width", "height"), format: "rgba8") },
            buffers: { "rows": (size: "16 + 16 * 8") },
            passes: [
                (name: "count", shaders: ["count.comp"], dispatch: Groups(1, 1, 1)),
                (name: "paint", clear: "picture", value: (1, 0, 0, 1)),
            ],
            pointer: "spot",
            tables: [(list: "rows.list", rows: "rows.count", title: "Squares", help: "Numbers.", columns: [
                (name: "square"), (name: "place", unit: "px"), (name: "half", of: "half_number"),
            ])],
            output: "picture",
        )"#,
        &[(
            "count.comp",
            "#include \"params.glsl\"
            layout(local_size_x = 8) in;
            struct Row { vec2 place; float half_number; uint square; };
            layout(std430) writeonly buffer Rows { uvec2 head; uint count; Row list[8]; } rows;
            void main() {
                uint i = gl_LocalInvocationID.x;
                rows.head = uvec2(0);
                rows.count = 3;
                rows.list[i] = Row(params.spot + float(i), 0.5 * float(i), i * i);
            }",
        )],
    );
    let lab = bench.lab();
    let session = bench.run(&lab, &["picture"], 1);
    assert_eq!(session.graph.pointer.as_deref(), Some("spot"));
    assert!(
        !session.program.plan.buffers[0].used,
        "the table's buffer is made though nobody asked for it"
    );
    assert_eq!(
        session.program.plan.dropped.len(),
        1,
        "{:?}",
        session.program.plan.dropped
    );

    let mut session = bench.run(&lab, &["picture", "rows"], 1);
    let bytes = session.program.read_buffer(0).unwrap();
    let row = |square, x, half| {
        vec![
            Cell::Uint(square),
            Cell::Vector(vec![x, x]),
            Cell::Float(half),
        ]
    };
    assert_eq!(
        decode(&session.table(0).unwrap(), &bytes),
        [row(0, -1.0, 0.0), row(1, 0.0, 0.5), row(4, 1.0, 1.0)]
    );
}

#[test]
fn members_of_buffers_by_name() {
    // Sizes of dispatch, draw and buffers, a check and a table.
    let common = "struct Row { vec2 place; float half_number; uint square; };
        layout(std430) buffer Rows {
            uint spare;
            uvec3 groups;
            uint vertices, instances, first_vertex, first_instance;
            uint lost;
            uvec2 found;
            Row list[];
        } rows;";
    let fixed = "struct Point { vec3 at; float weight; };
        layout(std430) buffer Points { Point points[3]; vec4 last; } points;";
    let bench = Bench::new(
        r#"(
            params: [Int(name: "count", default: 5, range: (1, 100), help: "Rows.")],
            textures: { "picture": (size: ("width", "height"), format: "rgba8") },
            buffers: { "rows": (size: Struct(of: "2 * count"), indirect: true), "points": (size: Struct) },
            passes: [
                (name: "size", shaders: ["size.comp"], dispatch: Groups(1, 1, 1)),
                (name: "fill", shaders: ["fill.comp"], dispatch: Indirect("rows.groups")),
                (name: "paint", shaders: ["full.vert", "paint.frag"], draw: Indirect("rows.vertices"),
                    color: [(to: "picture", clear: (0, 0, 0, 0))]),
            ],
            checks: [(field: "rows.lost", message: "rows were lost"), (field: "rows.found.y", message: "too many")],
            tables: [(rows: "rows.found.x", list: "rows.list", title: "Squares", help: "Numbers.", columns: [
                (name: "square"), (name: "where", of: "place", unit: "px"), (name: "height", of: "place.y"), (name: "half", of: "half_number"),
            ])],
            output: "picture",
        )"#,
        &[
            (
                "size.comp",
                &format!(
                    "#include \"params.glsl\"\n{common}\n{fixed}
                    void main() {{
                        rows.groups = uvec3(params.count, 2, 1);
                        rows.vertices = 3; rows.instances = 1; rows.first_vertex = 0; rows.first_instance = 0;
                        rows.lost = rows.list.length() - 2 * params.count;
                        rows.found = uvec2(3, params.count > 50 ? 7 : 0);
                        points.last = vec4(points.points[2].weight);
                    }}"
                ),
            ),
            (
                "fill.comp",
                &format!(
                    "{common}
                    void main() {{
                        uint i = gl_WorkGroupID.x + gl_NumWorkGroups.x * gl_WorkGroupID.y;
                        rows.list[i] = Row(vec2(i, -1.0), 0.5 * float(i), i * i);
                    }}"
                ),
            ),
            ("full.vert", FULL),
            ("paint.frag", "layout(location = 0) out vec4 color; void main() { color = vec4(1.0); }"),
        ],
    );
    let lab = bench.lab();
    let mut session = bench.run(&lab, &["picture", "rows", "points"], 1);
    let sizes: Vec<u64> = session
        .program
        .plan
        .buffers
        .iter()
        .filter(|b| b.used)
        .map(|b| b.size)
        .collect();
    assert_eq!(sizes, [56 + 10 * 16, 3 * 16 + 16]);
    assert_eq!(reds(&mut session, "picture", 0), [1.0; 32 * 24]);
    let bytes = session.buffer("rows").unwrap();
    let row = |i: u16| {
        let x = f32::from(i);
        vec![
            Cell::Uint(u32::from(i * i)),
            Cell::Vector(vec![x, -1.0]),
            Cell::Float(-1.0),
            Cell::Float(0.5 * x),
        ]
    };
    assert_eq!(
        decode(&session.table(0).unwrap(), &bytes),
        [row(0), row(1), row(2)]
    );
    // All that was asked for was filled: the word behind the head of the last row is nine squared.
    assert_eq!(words(&mut session, "rows")[(56 + 9 * 16 + 12) / 4], 81);
    assert_eq!(session.failed_checks().unwrap(), Vec::<String>::new());
    bench.edit(
        "configs/run.ron",
        "size: (32, 24)",
        "size: (32, 24), params: { \"count\": 60 }",
    );
    let mut session = bench.run(&lab, &["picture"], 1);
    assert_eq!(session.failed_checks().unwrap(), ["too many (7)"]);
}

#[test]
fn groups_share_a_stage_and_a_condition() {
    let bench = Bench::new(
        r#"(
            params: [
                Bool(name: "outer", default: true, help: "All of the group."),
                Int(name: "inner", default: 1, range: (0, 2), help: "Some of it."),
            ],
            buffers: { "sums": (size: Struct) },
            passes: [
                (name: "forget", clear: "sums"),
                (stage: "group", when: "outer", passes: [
                    (name: "a", repeat: 1, shaders: ["add.comp"], dispatch: Groups(1, 1, 1)),
                    (when: "inner > 0", passes: [
                        (name: "b", repeat: "2 * inner", shaders: ["add.comp"], dispatch: Groups(1, 1, 1)),
                        (name: "c", when: "inner == 2", stage: "own", shaders: ["add.comp"], dispatch: Groups(100, 1, 1)),
                    ]),
                ]),
                (name: "d", shaders: ["add.comp"], dispatch: Groups(1000, 1, 1)),
            ],
        )"#,
        &[(
            "add.comp",
            "layout(std430) buffer Sums { uint sum; } sums; void main() { atomicAdd(sums.sum, 1u); }",
        )],
    );
    let lab = bench.lab();
    let run = "size: (32, 24)";
    let mut last = run.to_string();
    for (outer, inner, sum) in [
        (true, 1, 1003),
        (true, 0, 1001),
        (true, 2, 1105),
        (false, 2, 1000),
    ] {
        let next = format!("{run}, params: {{ \"outer\": {outer}, \"inner\": {inner} }}");
        bench.edit("configs/run.ron", &last, &next);
        last = next;
        let mut session = bench.run(&lab, &["sums"], 1);
        assert_eq!(
            words(&mut session, "sums"),
            [sum],
            "outer {outer}, inner {inner}"
        );
        let stages: Vec<&str> = session
            .graph
            .passes
            .iter()
            .map(|p| p.value.stage())
            .collect();
        // The first one clears what shaders show, and runs only if one does.
        let expected = ["debug clear", "forget", "group", "group", "own", "d"];
        assert_eq!(stages, expected);
    }
}

#[test]
fn a_name_stands_for_what_its_condition_says() {
    // One pass writes, one reads, whichever of two textures and mips it is; a third reads it sampled otherwise.
    let bench = Bench::new(
        r#"(
            include: ["shared.ron"],
            params: [Choice(name: "target", options: ["large", "level", "small"], help: "What is written.")],
            textures: {
                "large": (size: (32, 16), format: "r32f", mips: 2),
                "small": (size: (8, 8), format: "r32f"),
            },
            buffers: { "found": (size: Struct), "spare": (size: Struct) },
            aliases: {
                "chosen": [
                    (when: "target == large", of: "large"),
                    (when: "target == level", of: "large", mip: "1"),
                    (of: "small"),
                ],
                "result": [(when: "target == small", of: "spare"), (of: "found")],
            },
            samplers: { "blurred": (of: "small", address: border_one) },
            passes: [
                (name: "ground", clear: "small", value: (0.5, 0, 0, 0)),
                (name: "write", shaders: ["write.comp"], dispatch: Cover("chosen")),
                (name: "sum", shaders: ["sum.comp"], dispatch: Groups(1, 1, 1), bind: { "source": (of: "chosen") }),
            ],
        )"#,
        &[
            (
                "write.comp",
                "uniform writeonly image2D chosen;
                void main() { imageStore(chosen, ivec2(gl_GlobalInvocationID.xy), vec4(gl_GlobalInvocationID.x)); }",
            ),
            (
                "sum.comp",
                "uniform sampler2D source;
                uniform sampler2D blurred;
                uniform sampler2D sharp;
                layout(std430) buffer Result { uvec2 size; float corner; float outside; float clamped; } result;
                void main() {
                    result.size = uvec2(textureSize(source, 0));
                    result.corner = texelFetch(source, ivec2(3, 2), 0).r;
                    result.outside = textureLod(blurred, vec2(-1.0), 0.0).r;
                    result.clamped = textureLod(sharp, vec2(-1.0), 0.0).r;
                }",
            ),
        ],
    );
    // The including file's `blurred` replaces this one; `sharp` stays.
    bench.write(
        "passes/shared.ron",
        "(samplers: { \"blurred\": (of: \"small\"), \"sharp\": (of: \"small\", filter: nearest) })",
    );
    let lab = bench.lab();
    let run = "size: (32, 24)";
    let mut last = run.to_string();
    let expected: [(&str, &str, [u32; 2], &[&str]); 3] = [
        ("large", "found", [32, 16], &["large", "small", "found"]),
        ("level", "found", [16, 8], &["large", "small", "found"]),
        ("small", "spare", [8, 8], &["small", "spare"]),
    ];
    for (target, buffer, size, made) in expected {
        let next = format!("{run}, params: {{ \"target\": \"{target}\" }}");
        bench.edit("configs/run.ron", &last, &next);
        last = next;
        let mut session = bench.run(&lab, &[buffer], 1);
        let found = words(&mut session, buffer);
        assert_eq!(found[..2], size, "{target}");
        assert_eq!(f32::from_bits(found[2]), 3.0, "{target}");
        assert_eq!(f32::from_bits(found[3]), 1.0, "{target}: outside is one");
        let corner = if target == "small" { 0.0 } else { 0.5 };
        assert_eq!(
            f32::from_bits(found[4]),
            corner,
            "{target}: outside is the edge"
        );
        let names: Vec<String> = session
            .program
            .memory(&session.graph)
            .into_iter()
            .map(|m| m.0)
            .collect();
        assert_eq!(names, made, "{target}");
    }
}

#[test]
fn what_is_left_out_is_the_default() {
    let bench = Bench::new(
        r#"(
            textures: {
                "said": (size: ("width", "height"), format: "rgba16f"),
                "unsaid": (size: Screen, format: "rgba16f"),
                "saidDepth": (size: ("width", "height"), format: "d32", sampler: (filter: linear, address: clamp)),
                "unsaidDepth": (size: Like("unsaid"), format: "d32"),
                "volume": (size: (4, 5, 6), format: "r8", mips: 2),
                "alike": (size: Like("cousin"), format: "r8"),
                "cousin": (size: Like("volume"), format: "r8"),
            },
            passes: [
                (name: "said", shaders: ["scene.vert", "scene.frag"], draw: Scene(what: all), topology: triangles,
                    color: [(to: "said", clear: (0, 0, 0, 0), mip: "0", layer: "0", blend: off)],
                    depth: (to: "saidDepth", clear: 1.0, test: less, write: true),
                    raster: (cull: none, depth_clamp: false, discard: false)),
                (name: "unsaid", shaders: ["scene.vert", "scene.frag"], draw: Scene,
                    color: [(to: "unsaid", clear: (0, 0, 0, 0))], depth: (to: "unsaidDepth", clear: 1)),
                (name: "clear", clear: "alike"),
            ],
        )"#,
        &[
            (
                "scene.vert",
                "#include \"scene.glsl\"
                layout(location = 0) out vec3 at;
                void main() {
                    at = toWorld(draws.draws[gl_InstanceIndex].instance, loadPosition(gl_VertexIndex));
                    gl_Position = camera.view_projection * vec4(at, 1.0);
                }",
            ),
            (
                "scene.frag",
                "layout(location = 0) in vec3 at; layout(location = 0) out vec4 color; void main() { color = vec4(at, 1.0); }",
            ),
        ],
    );
    let lab = bench.lab();
    let mut session = bench.run(
        &lab,
        &["said", "unsaid", "saidDepth", "unsaidDepth", "alike"],
        1,
    );
    let mut bytes = |name: &str| session.texels(name, 0, 0).unwrap().bytes;
    let said = bytes("said");
    assert!(said.iter().any(|b| *b != 0), "the scene is in the picture");
    assert_eq!(bytes("unsaid"), said);
    assert_eq!(bytes("unsaidDepth"), bytes("saidDepth"));
    let alike = session
        .graph
        .textures
        .iter()
        .position(|t| t.0 == "alike")
        .unwrap();
    let plan = &session.program.plan.textures[alike];
    assert_eq!((plan.extent, plan.volume, plan.mips), ([4, 5, 6], true, 1));
}

#[test]
fn the_example_of_the_documentation_runs() {
    let text = std::fs::read_to_string(common::root().join("docs/graph.md")).unwrap();
    let example = text.split("## A complete example").nth(1).unwrap();
    let home = common::home();
    // Each file is a block behind a line with its name: `passes/sketch.ron`:
    let mut files = 0;
    let blocks: Vec<&str> = example.split("\n```").collect();
    for pair in blocks.windows(2) {
        let name = pair[0]
            .lines()
            .last()
            .and_then(|line| line.strip_prefix('`')?.strip_suffix("`:"));
        let Some((name, (_, body))) = name.zip(pair[1].split_once('\n')) else {
            continue;
        };
        std::fs::write(home.path().join(name), body).unwrap();
        files += 1;
    }
    assert_eq!(files, 7);
    succeeds(conelab(home.path()).args(["check", "passes/sketch.ron", "configs/sketch.ron"]));
    let small = ["--set", "shadow_dim=256", "--size", "64x48"];
    let mut pictures = Vec::new();
    for (name, more) in [
        ("sketch", &[][..]),
        (
            "steady",
            &["--set", "steady=true", "--frames", "3", "--step", "0.1"],
        ),
    ] {
        let file = home.path().join(format!("{name}.png"));
        succeeds(
            conelab(home.path())
                .args(["render", "configs/sketch.ron", "-o"])
                .arg(&file)
                .args(small)
                .args(more),
        );
        pictures.push(std::fs::read(file).unwrap());
    }
    assert_ne!(pictures[0], pictures[1]);
}
