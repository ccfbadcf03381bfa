//! Files from strangers, several programs at once, odd clocks and names: nothing waits for ever, is lost, or reaches out.

mod common;

use common::{conelab, fails, home, root, succeeds};
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Settings of a picture that a software device renders quickly.
const SMALL: [&str; 6] = [
    "--scene",
    "cornell",
    "--size",
    "16x12",
    "--set",
    "voxel_dim=16",
];

fn write(path: impl AsRef<Path>, content: impl AsRef<[u8]>) -> PathBuf {
    std::fs::write(&path, content).unwrap();
    path.as_ref().to_path_buf()
}

/// What a command prints, which must end long before a test would be given up.
#[track_caller]
fn ended(command: &mut Command) -> Output {
    let mut child = command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if begun.elapsed() > Duration::from_secs(60) {
            child.kill().unwrap();
            panic!("{command:?} does not end");
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    child.wait_with_output().unwrap()
}

fn text(output: &Output) -> String {
    String::from_utf8([&output.stdout[..], &output.stderr].concat()).unwrap()
}

#[track_caller]
fn has(text: &str, pieces: &[&str]) {
    pieces
        .iter()
        .for_each(|piece| assert!(text.contains(piece), "no '{piece}' in: {text}"));
}

/// A capture of the preview, small, in a home of its own.
fn captured() -> (TempDir, PathBuf) {
    let home = home();
    let experiment = "(graph: \"preview.ron\", scene: \"furnace\", size: (16, 12))";
    write(home.path().join("configs/small.ron"), experiment);
    succeeds(conelab(home.path()).args(["capture", "configs/small.ron", "--name", "one"]));
    let folder = home.path().join("captures/one");
    (home, folder)
}

#[test]
fn a_pipe_in_a_capture_is_not_waited_for() {
    let (home, capture) = captured();
    std::fs::remove_file(capture.join("stats.json")).unwrap();
    assert!(
        Command::new("mkfifo")
            .arg(capture.join("stats.json"))
            .status()
            .unwrap()
            .success()
    );
    let output = ended(conelab(home.path()).args(["replay", "captures/one"]));
    has(
        &text(&output),
        &[
            "stats.json cannot be read: it is a pipe",
            "identical: 1 images",
        ],
    );
}

#[test]
fn a_capture_of_many_frames_is_rendered_only_if_asked_for() {
    let (home, capture) = captured();
    let manifest = std::fs::read_to_string(capture.join("capture.json")).unwrap();
    let with = |frames: usize| {
        write(
            capture.join("capture.json"),
            manifest.replace("\"frames\": 1,", &format!("\"frames\": {frames},")),
        );
    };
    with(1_000_000);
    let output = ended(conelab(home.path()).args(["replay", "captures/one"]));
    assert_eq!(output.status.code(), Some(1));
    has(
        &text(&output),
        &[
            "captures/one' asks for 1000000 frames",
            "--max-frames 1000000",
        ],
    );
    with(101);
    let replay = ["replay", "captures/one", "--max-frames"];
    has(
        &text(&ended(conelab(home.path()).args(replay).arg("101"))),
        &["rendering 101 frames of 16x12 pixels\n"],
    );
    has(
        &text(&ended(conelab(home.path()).args(replay).arg("100"))),
        &["asks for 101 frames, more than 100"],
    );
}

#[test]
fn graphs_and_captures_name_no_files_outside() {
    let (home, capture) = captured();
    let secret = write(
        home.path().join("secret.ron"),
        "the first line of a secret\n",
    );
    let passes = capture.join("graph/passes");
    let graph = std::fs::read_to_string(passes.join("preview.ron")).unwrap();
    let replay = || {
        let told = text(&ended(
            conelab(home.path()).args(["replay", "captures/one"]),
        ));
        assert!(!told.contains("first line"), "{told}");
        told
    };
    let absolute = secret.to_string_lossy().into_owned();
    for include in [
        absolute.as_str(),
        "../../../../secret.ron",
        "./../../../../secret.ron",
    ] {
        let changed = graph.replacen('(', &format!("(include: [\"{include}\"],"), 1);
        write(
            passes.join("preview.ron"),
            changed.replace("include: [\"parts", "includes: [\"parts"),
        );
        has(
            &replay(),
            &[
                "passes/preview.ron:",
                include,
                "leads out of the folder of graphs",
            ],
        );
    }
    write(passes.join("preview.ron"), &graph);
    // A shader by an absolute name, and a link that no list mentions.
    let shader = write(
        home.path().join("secret.frag"),
        "the first line of a secret\n",
    );
    let named = graph
        .split("shaders: [")
        .nth(1)
        .unwrap()
        .split('"')
        .find(|n| n.ends_with(".frag"))
        .unwrap();
    write(
        passes.join("preview.ron"),
        graph.replace(named, &shader.to_string_lossy()),
    );
    has(&replay(), &["secret.frag", "leads out"]);
    write(
        passes.join("preview.ron"),
        graph.replacen('(', "(include: [\"link.ron\"],", 1),
    );
    std::os::unix::fs::symlink(&secret, passes.join("link.ron")).unwrap();
    has(
        &replay(),
        &["'graph/passes/link.ron' leads out of the capture"],
    );
}

#[test]
fn captures_taken_at_once_all_have_names() {
    let home = home();
    let experiment = "(graph: \"preview.ron\", scene: \"furnace\", size: (16, 12))";
    write(home.path().join("configs/small.ron"), experiment);
    let start = || {
        let mut command = conelab(home.path());
        command
            .env_remove("CONELAB_VALIDATION")
            .args(["capture", "configs/small.ron"]);
        command
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap()
    };
    let running: Vec<_> = (0..4).map(|_| start()).collect();
    for child in running {
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success(), "{}", text(&output));
    }
    let mut names: Vec<_> = std::fs::read_dir(home.path().join("captures"))
        .unwrap()
        .map(|e| e.unwrap().file_name())
        .collect();
    names.sort();
    assert_eq!(names, ["small", "small-2", "small-3", "small-4"]);
}

#[test]
fn references_of_one_picture_do_not_delete_each_others_sums() {
    let home = home();
    let reference = |samples: &str| {
        let mut command = conelab(home.path());
        command
            .args(["reference", "configs/rays.ron"])
            .args(&SMALL[..4])
            .args(["--spp", samples]);
        command
    };
    succeeds(&mut reference("32"));
    let folder = std::fs::read_dir(home.path().join("captures/reference"))
        .unwrap()
        .next()
        .unwrap()
        .unwrap()
        .path();
    let sums = |samples: usize| folder.join(format!("sums-{samples}.exr"));
    // The sums of another process, which has not named them yet.
    std::fs::copy(sums(32), sums(4096)).unwrap();
    succeeds(&mut reference("64"));
    assert_eq!(
        [32, 64, 4096].map(|n| sums(n).exists()),
        [false, true, true]
    );
    // Those that it names are gone, as a program of an earlier version leaves them: they are gathered again.
    std::fs::remove_file(sums(64)).unwrap();
    succeeds(&mut reference("32"));
    assert_eq!(
        [32, 64, 4096].map(|n| sums(n).exists()),
        [true, false, true]
    );
}

#[test]
fn check_finds_what_render_would_and_names_the_experiment() {
    let home = home();
    let camera =
        "(\n    graph: \"preview.ron\",\n    scene: \"cornell\",\n    camera: \"nope\",\n)";
    let files = [
        (
            "camera.ron",
            camera,
            "configs/camera.ron:4:13: error: scene 'cornell' has no camera 'nope' (known: default)",
        ),
        (
            "scene.ron",
            "(graph: \"preview.ron\", scene: \"cornel\")",
            "configs/scene.ron:1:31: error: no scene 'cornel'",
        ),
        (
            "model.ron",
            "(graph: \"preview.ron\", scene: \"gone.obj\")",
            "configs/model.ron:1:31: error: cannot read",
        ),
        (
            "graph.ron",
            "(graph: \"previw.ron\", scene: \"cornell\")",
            "configs/graph.ron:1:9: error: graph '",
        ),
        (
            "light.ron",
            "(graph: \"preview.ron\", scene: \"cornell\", lights: {\"x\": ()})",
            "configs/light.ron:1:51: ",
        ),
    ];
    for (name, content, _) in files {
        write(home.path().join("configs").join(name), content);
    }
    let paths: Vec<String> = files
        .iter()
        .map(|(name, ..)| format!("configs/{name}"))
        .collect();
    let output = conelab(home.path())
        .arg("check")
        .args(&paths)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1));
    has(&text(&output), &["checked 5 files, 5 errors"]);
    for ((_, _, message), path) in files.iter().zip(&paths) {
        has(&text(&output), &[message]);
        has(
            &fails(conelab(home.path()).args(["render", path, "-o", "x.png"])),
            &[message],
        );
    }
    // The file does not name what the command line does.
    let other = [
        "render",
        "configs/camera.ron",
        "--camera",
        "other",
        "-o",
        "x.png",
    ];
    has(
        &fails(conelab(home.path()).args(other)),
        &["error: scene 'cornell' has no camera 'other'"],
    );
}

#[test]
fn paths_that_are_not_utf8_are_opened() {
    let home = home();
    let folder = home.path().join(std::ffi::OsStr::from_bytes(b"f\xff"));
    std::fs::create_dir(&folder).unwrap();
    let name = |name: &[u8]| folder.join(std::ffi::OsStr::from_bytes(name));
    let model = write(name(b"m\xfe.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let scene = write(name(b"s\xfe.ron"), "(models: [(builtin: \"cornell\")])");
    write(name(b"plain.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let experiment = write(
        name(b"e\xfe.ron"),
        "(graph: \"preview.ron\", scene: \"plain.obj\", size: (8, 8))",
    );
    let graph = name(b"g\xfe.ron");
    std::fs::copy(home.path().join("passes/preview.ron"), &graph).unwrap();
    let checked = succeeds(
        conelab(home.path())
            .arg("check")
            .args([&scene, &experiment, &graph]),
    );
    has(&checked, &["checked 3 files, 0 errors"]);
    has(
        &succeeds(conelab(home.path()).arg("scene").arg(&model)),
        &["triangles  1"],
    );
    let render = |scene: &Path| {
        let mut command = conelab(home.path());
        command.args([
            "render",
            "configs/rays.ron",
            "--size",
            "8x8",
            "-o",
            "x.png",
            "--set",
            "voxel_dim=16",
        ]);
        succeeds(command.arg("--scene").arg(scene));
    };
    render(&model);
    render(&scene);
    succeeds(
        conelab(home.path())
            .arg("render")
            .arg(&experiment)
            .args(["-o", "x.png"]),
    );
}

#[test]
fn names_in_files_reach_no_terminal_as_commands() {
    let folder = tempfile::tempdir().unwrap();
    let evil = "\u{1b}[31mEVIL\u{1b}[2J\u{9b}2J\u{7}";
    write(
        folder.path().join("a.mtl"),
        format!("newmtl {evil}\nmap_Kd {evil}.png\nd 0.2\n"),
    );
    let model = format!(
        "mtllib a.mtl\no {evil}\nusemtl {evil}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl {evil}2\nf 1 2 3\n"
    );
    let model = write(folder.path().join("a.obj"), model);
    let scene = format!(
        "(name: \"{evil}\", models: [(file: \"a.obj\")], cameras: {{\"{evil}\": (eye: (0, 0, 1), target: (0, 0, 0), \
         fov_y: 50)}}, lights: [Point(name: \"{evil}\", color: (1, 1, 1), position: (0, 0, 1), shadow: false)])"
    );
    let scene = write(folder.path().join("s.ron"), scene);
    let odd = write(folder.path().join(format!("{evil}.ron")), "(graph: 1)");
    for (command, path) in [
        ("scene", &model),
        ("scene", &scene),
        ("check", &odd),
        ("check", &scene),
        ("render", &odd),
        ("graph", &odd),
    ] {
        let output = conelab(root()).arg(command).arg(path).output().unwrap();
        let told = text(&output);
        assert!(
            !told.chars().any(|c| c.is_control() && c != '\n'),
            "{command}: {told:?}"
        );
        assert!(
            command == "check" || told.contains("EVIL"),
            "{command}: {told}"
        );
    }
}

/// A home with a graph of one compute shader, `l.comp`.
fn shader_home(shader: &str, params: &str) -> TempDir {
    let home = home();
    let graph = format!(
        "(params: [{params}], textures: {{\"p\": (size: (\"4\", \"4\"), format: \"rgba8\")}}, output: \"p\", \
         passes: [(name: \"l\", shaders: [\"l.comp\"], dispatch: Groups(1, 1, 1))])"
    );
    write(home.path().join("passes/l.ron"), graph);
    write(
        home.path().join("configs/l.ron"),
        "(graph: \"l.ron\", scene: \"furnace\", size: (4, 4))",
    );
    let head = "#version 460\n#extension GL_GOOGLE_include_directive : require\n#include \"params.glsl\"\n\
                layout(local_size_x = 1) in;\nlayout(rgba8) uniform writeonly image2D p;\n";
    write(
        home.path().join("shaders/l.comp"),
        format!("{head}{shader}"),
    );
    home
}

/// What `graph` and `render` say, under a limit of memory that the whole program keeps far below.
fn limited(home: &Path, command: &str) -> String {
    let program = env!("CARGO_BIN_EXE_conelab");
    let mut shell = Command::new("sh");
    shell
        .args([
            "-c",
            &format!("ulimit -v 12000000; exec '{program}' {command}"),
        ])
        .current_dir(home);
    shell
        .env("CONELAB_HOME", home)
        .env("CONELAB_CACHE", home.join("cache"))
        .env("CONELAB_DEVICE", common::device());
    text(&ended(&mut shell))
}

#[test]
fn macros_that_grow_without_end_are_refused() {
    let doubled: String = (1..40)
        .map(|i| format!("#define A{i} (A{0}+A{0})\n", i - 1))
        .collect();
    let home = shader_home(
        &format!(
            "#define A0 1.0\n{doubled}void main() {{\n    imageStore(p, ivec2(0), vec4(A39));\n}}\n"
        ),
        "",
    );
    for command in [
        "graph passes/l.ron",
        "check passes/l.ron",
        "render configs/l.ron -o x.png",
    ] {
        let told = limited(home.path(), command);
        has(
            &told,
            &[
                "shaders/l.comp:47: error: macros expand to",
                "'A39'",
                "imageStore",
            ],
        );
    }
}

#[test]
fn shaders_whose_variables_take_all_memory_are_refused() {
    let main = "void main() {\n    a[gl_GlobalInvocationID.x] = 1.0;\n    imageStore(p, ivec2(0), vec4(a[N / 2]));\n}\n";
    for declaration in [
        "const int N = 1000000000; float a[N];",
        "const int N = 20000; shared float a[N][N];",
    ] {
        let main = if declaration.contains("shared") {
            main.replace("x]", "x][0]").replace("2]", "2][1]")
        } else {
            main.into()
        };
        let home = shader_home(&format!("{declaration}\n{main}"), "");
        let told = limited(home.path(), "render configs/l.ron -o x.png");
        has(
            &told,
            &[
                "l.comp: error: the variables of the shader take",
                "'a' is the largest",
                "1048576 are allowed",
            ],
        );
    }
    // A length that a parameter decides is known when the pipeline is made.
    let param =
        "Int(name: \"n\", default: 8, range: (1, 1000000000), constant: true, help: \"Length.\")";
    let home = shader_home(&format!("float a[N];\n{main}"), param);
    let told = limited(home.path(), "render configs/l.ron -o x.png");
    assert!(told.contains("wrote x.png"), "{told}");
    let told = limited(home.path(), "render configs/l.ron -o x.png --set n=4000000");
    has(
        &told,
        &[
            "the size of the shader variables of pass 'l' is 160000",
            "at most 1048576 bytes",
        ],
    );
}

/// Editors of Windows put a byte order mark before every file that they save.
#[test]
fn byte_order_marks_change_nothing() {
    let pictures = [false, true].map(|marked| {
        let home = home();
        if marked {
            mark(home.path());
        }
        let scene = "\u{feff}(models: [(builtin: \"furnace\")])";
        write(home.path().join("own.ron"), scene);
        let arguments = [
            "render",
            "configs/tour.ron",
            "--scene",
            "own.ron",
            "--size",
            "16x12",
            "-o",
            "a.png",
        ];
        succeeds(conelab(home.path()).args(arguments));
        std::fs::read(home.path().join("a.png")).unwrap()
    });
    assert_eq!(pictures[0], pictures[1]);
}

/// A byte order mark before every text of a folder.
fn mark(folder: &Path) {
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        match std::fs::read_to_string(entry.path()) {
            _ if entry.path().is_dir() => mark(&entry.path()),
            Ok(text) => drop(write(entry.path(), format!("\u{feff}{text}"))),
            Err(_) => {}
        }
    }
}

/// With a letter there, the compiler prints its tables of built-in functions: 4,550 lines.
#[test]
fn a_letter_before_the_version_is_one_error() {
    let home = home();
    let shader = home.path().join("shaders/display/display.comp");
    let original = std::fs::read_to_string(&shader).unwrap();
    write(&shader, format!("x{original}"));
    let mut command = conelab(home.path());
    let output = ended(command.args([
        "render",
        "configs/tour.ron",
        "--scene",
        "furnace",
        "--size",
        "16x12",
        "--json",
        "-",
    ]));
    assert_eq!(String::from_utf8_lossy(&output.stdout), "");
    let error = String::from_utf8_lossy(&output.stderr);
    has(
        &error,
        &[
            "display.comp:1",
            "'x' is before #version, which must come first",
        ],
    );
    assert!(error.lines().count() < 12, "{error}");
}
