//! The program as people and scripts run it: what it writes, what it says when it cannot, what it leaves behind.

mod common;

use common::{conelab, copy, device, fails, home, root, succeeds};
use exr::prelude::read_first_rgba_layer_from_file;
use insta::assert_snapshot;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// Settings that a software device renders in about a second.
const SMALL: &[&str] = &[
    "--size",
    "96x64",
    "--set",
    "voxel_dim=32",
    "--set",
    "shadow_dim=512",
];

struct Out(TempDir);

impl Out {
    fn new() -> Out {
        Out(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        std::fs::write(self.path(name), content).unwrap();
        self.path(name)
    }

    fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<String> = entries
            .map(|e| e.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    /// A command's text without the names of folders.
    fn tidy(&self, text: &str) -> String {
        text.replace(&format!("{}/", self.0.path().display()), "OUT/")
            .replace(&format!("{}/", root().display()), "")
    }
}

/// `conelab render configs/rays.ron`, small, of a built-in scene.
fn render(scene: &str, output: &Path) -> Command {
    let mut command = conelab(root());
    command
        .args(["render", "configs/rays.ron", "--scene", scene])
        .args(SMALL)
        .arg("-o")
        .arg(output);
    command
}

/// The same with nothing set.
fn plain(output: &Path) -> Command {
    let mut command = conelab(root());
    command
        .args(["render", "configs/rays.ron", "-o"])
        .arg(output);
    command
}

/// Width, height and texels of an EXR.
fn read_exr(path: &Path) -> (usize, usize, Vec<[f32; 4]>) {
    let image = read_first_rgba_layer_from_file(
        path,
        |size, _| (size, vec![[0.0; 4]; size.area()]),
        |(size, texels): &mut (exr::math::Vec2<usize>, Vec<[f32; 4]>),
         at,
         (r, g, b, a): (f32, f32, f32, f32)| {
            texels[at.y() * size.width() + at.x()] = [r, g, b, a];
        },
    )
    .unwrap();
    let (size, texels) = image.layer_data.channel_data.pixels;
    (size.width(), size.height(), texels)
}

#[test]
fn render_writes_a_png_and_its_measurements() {
    let out = Out::new();
    let said = succeeds(
        render("cornell", &out.path("box.png"))
            .arg("--json")
            .arg(out.path("box.json"))
            .args(["--warmup", "1", "--frames", "3"]),
    );
    assert!(
        said.contains("GPU ms") && said.contains("shading") && said.contains("memory of the graph"),
        "{said}"
    );
    assert!(
        out.tidy(&said)
            .ends_with("wrote OUT/box.png\nwrote OUT/box.json\n"),
        "{said}"
    );
    assert_eq!(out.names(), ["box.json", "box.png"]);

    let picture = image::open(out.path("box.png")).unwrap();
    assert_eq!(
        (picture.width(), picture.height(), picture.color()),
        (96, 64, image::ColorType::Rgb8)
    );
    let mean = picture
        .to_rgb8()
        .as_raw()
        .iter()
        .map(|v| f64::from(*v))
        .sum::<f64>()
        / (96.0 * 64.0 * 3.0);
    assert!(
        (5.0..200.0).contains(&mean),
        "mean brightness {mean} of 255"
    );

    let stats: serde_json::Value =
        serde_json::from_slice(&std::fs::read(out.path("box.json")).unwrap()).unwrap();
    let fields: Vec<&str> = stats
        .as_object()
        .unwrap()
        .keys()
        .map(String::as_str)
        .collect();
    let documented = [
        "auto",
        "bytes",
        "cpu_ms",
        "device",
        "execution",
        "experiment",
        "graph",
        "params",
        "passes",
        "scene",
        "scene_bytes",
        "schema",
        "size",
        "total_bytes",
        "total_gpu_ms",
        "triangles",
        "version",
        "warmup",
        "warnings",
    ];
    assert_eq!(fields, documented);
    assert_eq!(stats["schema"], "conelab-stats-1");
    assert_eq!(stats["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(
        (&stats["experiment"], &stats["graph"], &stats["scene"]),
        (&"rays".into(), &"rays".into(), &"cornell".into())
    );
    assert_eq!(stats["size"], serde_json::json!([96, 64]));
    assert_eq!(stats["warmup"], 1);
    assert_eq!(stats["warnings"], serde_json::json!([]));
    assert!(
        ["cpu", "integrated", "discrete", "virtual"]
            .iter()
            .any(|k| stats["device"]["kind"] == *k)
    );
    assert!(
        ["name", "driver", "api"]
            .iter()
            .all(|f| stats["device"][f].as_str().is_some_and(|s| !s.is_empty()))
    );
    // Every parameter is there, in its own JSON type.
    assert_eq!(stats["params"]["voxel_dim"], 32);
    assert_eq!(stats["params"]["volume_ahead"], 0.25);
    assert_eq!(stats["params"]["voxelizer"], "auto");
    assert_eq!(
        stats["params"]["volume_size"],
        serde_json::json!([32.0, 32.0, 32.0])
    );
    for pass in stats["passes"].as_array().unwrap() {
        assert_eq!(pass["frames"], 3, "{pass}");
        let [min, median, p95] =
            ["min", "median", "p95"].map(|f| pass["gpu_ms"][f].as_f64().unwrap());
        assert!(0.0 <= min && min <= median && median <= p95, "{pass}");
    }
    let sum: u64 = stats["bytes"]
        .as_object()
        .unwrap()
        .values()
        .map(|b| b.as_u64().unwrap())
        .sum();
    assert_eq!(stats["total_bytes"], sum);
    assert!(stats["bytes"]["voxelBricks"].as_u64().unwrap() >= 2 * 32 * 32 * 16);
    assert!(stats["triangles"].as_u64().unwrap() > 0 && stats["scene_bytes"].as_u64().unwrap() > 0);
}

#[test]
fn the_same_command_gives_the_same_bytes() {
    let voxelizers = ["raster", "tessellated", "compute"];
    for (scene, voxelizer) in voxelizers
        .iter()
        .flat_map(|v| [("cornell", v), ("triangles", v)])
    {
        let out = Out::new();
        let one = |name: &str, more: &[&str]| {
            let set = ["--frames", "6", "--set", &format!("voxelizer={voxelizer}")];
            succeeds(render(scene, &out.path(name)).args(set).args(more));
            std::fs::read(out.path(name)).unwrap()
        };
        let first = one("a.exr", &[]);
        let (width, height, texels) = read_exr(&out.path("a.exr"));
        assert_eq!((width, height), (96, 64));
        assert!(
            texels.iter().flatten().all(|v| v.is_finite()),
            "{scene}, {voxelizer}"
        );
        assert!(
            texels.iter().any(|t| t[0] > 0.05),
            "{scene}, {voxelizer}: black"
        );
        assert!(
            one("b.exr", &[]) == first,
            "{scene}, {voxelizer}: two runs differ"
        );
        // Sums of integers do not depend on the order of the triangles.
        assert!(
            one("c.exr", &["--shuffle", "7"]) == first,
            "{scene}, {voxelizer}: the order of triangles shows"
        );
    }
}

/// Light that goes from voxel to voxel takes frames: what nobody counts is rendered until it is there.
#[test]
fn a_picture_is_of_settled_light() {
    let home = tempfile::tempdir().unwrap();
    let path = |name: &str| home.path().join(name);
    let mean = |name: &str| {
        let (_, _, texels) = read_exr(&path(name));
        texels
            .iter()
            .map(|t| f64::from(t[0] + t[1] + t[2]))
            .sum::<f64>()
            / texels.len() as f64
    };
    succeeds(&mut render("cornell", &path("settled.exr")));
    succeeds(render("cornell", &path("first.exr")).args(["--frames", "1"]));
    succeeds(render("cornell", &path("late.exr")).args(["--frames", "100"]));
    let (settled, first, late) = (mean("settled.exr"), mean("first.exr"), mean("late.exr"));
    println!(
        "first frame {:.4}, settled {:.4} of the light after 100 frames",
        first / late,
        settled / late
    );
    assert!(first < 0.97 * late && (settled / late - 1.0).abs() < 0.01);
}

/// Triangles of 200 km in pieces of some voxels would take gigabytes: that is known before any is split.
#[test]
fn what_splitting_would_take_is_told_before_it_is_done() {
    let out = Out::new();
    let said = fails(
        render("plain", &out.0.path().join("a.png")).args(["--set", "voxelizer=tessellated"]),
    );
    assert!(said.contains("MB of vertices or more"), "{said}");
}

#[test]
fn resources_come_as_they_are() {
    let out = Out::new();
    // Slices of a volume lie below one another: mip 2 of 32^3 is 8 wide and 8 * 8 high.
    let mut mip = conelab(root());
    mip.args(["render", "configs/cones.ron", "--scene", "cornell"])
        .args(SMALL)
        .arg("-o")
        .arg(out.path("mip.exr"));
    succeeds(mip.args(["--resource", "voxelRadiance:2", "--set", "mips=isotropic"]));
    let (width, height, texels) = read_exr(&out.path("mip.exr"));
    assert_eq!((width, height), (8, 64));
    assert!(texels.iter().any(|t| t[3] > 0.0) && texels.iter().flatten().all(|v| v.is_finite()));
    succeeds(render("cornell", &out.path("normal.png")).args(["--resource", "surfaceNormal"]));
    assert_eq!(image::open(out.path("normal.png")).unwrap().width(), 96);
}

#[test]
fn wrong_arguments_are_told_and_leave_nothing() {
    let out = Out::new();
    let png = out.path("x.png");
    let error_of = |more: &[&str]| out.tidy(&fails(plain(&png).args(more)));
    assert_snapshot!(error_of(&["--set", "voxel_dmi=64"]), @"--set voxel_dmi=64: error: no parameter 'voxel_dmi' (did you mean 'voxel_dim'?)");
    assert_snapshot!(error_of(&["--set", "voxel_dim"]), @"error: --set voxel_dim: expected NAME=VALUE");
    assert_snapshot!(error_of(&["--set", "voxel_dim=9000"]), @"--set voxel_dim=9000: error: 'voxel_dim': 9000 is outside 16 to 512");
    assert_snapshot!(error_of(&["--set", "voxelizer=tesselated"]), @"--set voxelizer=tesselated: error: 'voxelizer' has no option 'tesselated' (did you mean 'tessellated'?)");
    assert_snapshot!(error_of(&["--set", "volume_size=(1, 2)"]), @"--set volume_size=(1, 2): error: 'volume_size': expected 3 numbers in parentheses, got (1, 2)");
    assert_snapshot!(error_of(&["--set", "voxel_dmi=64", "--set", "exposure=x"]), @r"
    --set voxel_dmi=64: error: no parameter 'voxel_dmi' (did you mean 'voxel_dim'?)
    --set exposure=x: error: 'exposure': expected a number, got x
    ");
    assert_snapshot!(error_of(&["--size", "0x64"]), @"error: a picture of 0x64 cannot be made: each side is 1 to 16384 pixels");
    assert_snapshot!(error_of(&["--size", "64"]), @"error: --size 64: expected WIDTHxHEIGHT, for example 1280x720");
    assert_snapshot!(error_of(&["--size", "64x-1"]), @"error: --size 64x-1: expected WIDTHxHEIGHT, for example 1280x720");
    assert_snapshot!(error_of(&["--size", "100000x64"]), @"error: a picture of 100000x64 cannot be made: each side is 1 to 16384 pixels");
    assert_snapshot!(error_of(&["--frames", "0"]), @"error: --frames must be 1 to 1000000");
    assert_snapshot!(error_of(&["--scene", "cornel"]), @"error: no scene 'cornel': did you mean 'cornell'? Built-in scenes: atrium, cornell, furnace, white-sky, thin-walls, triangles, moving-box, blade, small-quad, emitters, ceiling-panel, neon-tube, lampshade, huge-ground, far-away, pocket, plain, blinds, door-ajar, corridor, street, gloss, foliage, sky-window, vases; otherwise give a .ron, .obj, .gltf, .glb or .fbx file");
    assert_snapshot!(error_of(&["--scene", "missing/model.gltf"]), @"error: cannot read missing/model.gltf: No such file or directory (os error 2). Check the path and its permissions");
    assert_snapshot!(error_of(&["--camera", "side", "--scene", "cornell"]), @"error: scene 'cornell' has no camera 'side' (known: default)");
    assert_snapshot!(error_of(&["--scene", "cornell", "--camera", "(eye: (0, 0, 1), target: (0, 0, 0))"]), @"error: --camera: 1:35: Unexpected missing field named `fov_y` in `PlacedCamera`; expected (eye: (x, y, z), target: (x, y, z), fov_y: degrees)");
    let resource =
        |name: &str| out.tidy(&fails(render("cornell", &png).args(["--resource", name])));
    assert_snapshot!(resource("voxelRadience"), @"error: no texture 'voxelRadience' (did you mean 'voxelRadiance'?)");
    assert_snapshot!(resource("voxelRadiance:9"), @"error: 'voxelRadiance' has 1 mips and 1 layers; there is no mip 9, layer 0");
    assert_snapshot!(resource("voxelRadiance:x"), @"error: --resource voxelRadiance:x: 'x' is no mip");
    assert_snapshot!(resource("inspected"), @"error: 'inspected' is not made with these parameters: no pass that runs uses it");
    assert_snapshot!(error_of(&["--device", "Voodoo"]).split(": found").next().unwrap(), @"error: no Vulkan 1.3 device named 'Voodoo'");
    assert!(out.names().is_empty(), "{:?}", out.names());
}

#[test]
fn files_that_are_missing_or_broken() {
    let out = Out::new();
    let png = out.path("x.png");
    let experiment = |path: &Path| {
        out.tidy(&fails(
            conelab(root()).arg("render").arg(path).arg("-o").arg(&png),
        ))
    };
    assert_snapshot!(experiment(&out.path("missing.ron")), @r"
    OUT/missing.ron: error: cannot read it: No such file or directory (os error 2)
        = help: give the path of an experiment, for example configs/rays.ron
    ");
    assert_snapshot!(experiment(&out.write("empty.ron", "")), @"OUT/empty.ron:1:1: error: Expected opening `(` for struct `ExperimentFile`");
    assert_snapshot!(experiment(&out.write("other.ron", "(graph: \"rasy.ron\", scene: \"cornell\")")), @r#"
    OUT/other.ron:1:9: error: graph 'passes/rasy.ron': cannot read it: No such file or directory (os error 2)
        | (graph: "rasy.ron", scene: "cornell")
        = help: did you mean 'rays.ron'?
    "#);
    let scene = |name: &str, content: &[u8]| {
        let path = out.write(name, content);
        out.tidy(&fails(&mut render(path.to_str().unwrap(), &png)))
    };
    assert_snapshot!(scene("broken.gltf", b"{ \"asset\": { \"version\": \"2.0\" }, "), @"error: cannot load the model OUT/broken.gltf: it is no JSON: EOF while parsing a value at line 1 column 33. Export it again as glTF 2.0");
    assert_snapshot!(scene("broken.glb", &[0x67, 0x6c, 0x54, 0x46, 2, 0, 0, 0, 255, 255, 255, 255]), @"error: cannot load the model OUT/broken.glb: it has 12 bytes of 4294967295: it is cut short. Export it again as glTF 2.0");
    assert_snapshot!(scene("broken.obj", b"v 0 0 0\nv 1 0 0\nf 1 2 7\n"), @"error: cannot load the model OUT/broken.obj: line 3: a face names vertex 7 of 2. Export it again");
    assert_snapshot!(scene("picture.bmp", b"BM"), @"error: no scene 'OUT/picture.bmp': the file's extension must be .ron, .obj, .gltf, .glb or .fbx; convert other formats to glTF");
    let mut home = conelab(root());
    home.env("CONELAB_HOME", out.0.path())
        .args(["render", "configs/rays.ron", "-o"])
        .arg(&png);
    assert_snapshot!(out.tidy(&fails(&mut home)).replace(out.0.path().to_str().unwrap(), "OUT"), @"error: CONELAB_HOME is 'OUT', which has no passes and shaders folders");
    assert!(!png.exists());
}

#[test]
fn outputs_that_cannot_be_written() {
    let out = Out::new();
    let file = out.write("file", "");
    std::fs::create_dir(out.path("folder.png")).unwrap();
    let error_of = |path: &Path| out.tidy(&fails(&mut render("cornell", path)));
    assert_snapshot!(error_of(&file.join("x.png")), @"error: cannot write 'OUT/file/x.png': 'OUT/file' is no folder");
    assert_snapshot!(error_of(&out.path("x.jpg")), @"error: 'OUT/x.jpg': give it a name that ends in .png or .exr");
    assert_snapshot!(error_of(&out.path("x")), @"error: 'OUT/x': give it a name that ends in .png or .exr");
    assert_snapshot!(error_of(&out.path("folder.png")), @"error: cannot write 'OUT/folder.png': it is a folder");
    let json = file.join("x.json");
    assert_snapshot!(out.tidy(&fails(render("cornell", &out.path("x.png")).arg("--json").arg(json))), @"error: cannot write 'OUT/file/x.json': 'OUT/file' is no folder");
    assert_eq!(out.names(), ["file", "folder.png"]);
    assert_eq!(
        std::fs::read_dir(out.path("folder.png")).unwrap().count(),
        0
    );
}

#[test]
fn what_is_wrong_is_told_before_what_is_missing() {
    let without = |more: &[&str]| {
        fails(
            conelab(root())
                .args(["render", "configs/rays.ron"])
                .args(SMALL)
                .args(more),
        )
    };
    assert_snapshot!(without(&["--scene", "cornell", "--set", "exposrue=1"]), @"--set exposrue=1: error: no parameter 'exposrue' (did you mean 'exposure'?)");
    assert_snapshot!(without(&["--scene", "gone.obj"]), @"error: cannot read gone.obj: No such file or directory (os error 2). Check the path and its permissions");
    assert_snapshot!(without(&["--scene", "cornell"]), @"error: nothing to write: name the picture with --output, for example -o picture.png");
}

#[test]
fn standard_output_is_json_alone_or_an_error_when_full() {
    let graph = ["graph", "passes/rays.ron", "--size", "64x48", "--json", "-"];
    let outline: serde_json::Value =
        serde_json::from_str(&succeeds(conelab(root()).args(graph))).unwrap();
    assert_eq!(
        (&outline["schema"], &outline["graph"]),
        (&"conelab-graph-1".into(), &"rays".into())
    );
    assert_eq!(outline["params"]["voxel_dim"], 160);
    let list = |name: &str| outline[name].as_array().unwrap().clone();
    let picture = list("textures")
        .into_iter()
        .find(|t| t["name"] == "display")
        .unwrap();
    assert_eq!(
        (&picture["extent"], &picture["bytes"]),
        (&serde_json::json!([64, 48, 1]), &(64 * 48 * 4).into())
    );
    assert!(list("passes").iter().any(|p| p["name"] == "display"
        && p["writes"] == serde_json::json!(["display", "pictureErrors"])));

    let out = Out::new();
    let stats =
        succeeds(render("cornell", &out.path("x.png")).args(["--frames", "1", "--json", "-"]));
    assert_eq!(
        serde_json::from_str::<serde_json::Value>(&stats).unwrap()["scene"],
        "cornell"
    );
    for command in [&["scene", "cornell"][..], &graph, &["completions", "bash"]] {
        let full = std::fs::File::create("/dev/full").unwrap();
        let told = fails(conelab(root()).args(command).stdout(full));
        assert_eq!(
            told,
            "error: cannot write to standard output: No space left on device (os error 28)\n"
        );
    }
    for shell in ["bash", "zsh", "fish"] {
        let script = succeeds(conelab(root()).args(["completions", shell]));
        assert!(
            script.contains("conelab") && script.contains("stability"),
            "{shell}: {script}"
        );
    }
}

#[cfg(unix)]
#[test]
fn files_are_for_whom_the_umask_says() {
    use std::os::unix::fs::PermissionsExt;
    let out = Out::new();
    for (mask, mode) in [("022", 0o644), ("027", 0o640), ("077", 0o600)] {
        let file = out.path(&format!("{mask}.json"));
        let graph = format!(
            "umask {mask}; exec '{}' graph passes/rays.ron --json '{}'",
            env!("CARGO_BIN_EXE_conelab"),
            file.display()
        );
        let done = std::process::Command::new("sh")
            .args(["-c", &graph])
            .current_dir(root())
            .output()
            .unwrap();
        assert!(
            done.status.success(),
            "{}",
            String::from_utf8_lossy(&done.stderr)
        );
        let found = std::fs::metadata(&file).unwrap().permissions().mode() & 0o777;
        assert_eq!(found, mode, "umask {mask}: {found:o}");
    }
}

#[test]
fn files_of_the_program_are_found_from_anywhere() {
    let out = Out::new();
    let from_elsewhere =
        |args: &[&str]| succeeds(conelab(root()).current_dir(out.0.path()).args(args));
    assert!(
        from_elsewhere(&["check", "configs/rays.ron", "passes/rays.ron"])
            .starts_with("checked 2 files, 0 errors")
    );
    assert!(from_elsewhere(&["graph", "passes/rays.ron"]).starts_with("graph rays: "));
    assert!(from_elsewhere(&["graph", "configs/thesis.ron"]).starts_with("graph thesis: "));
    let mut render = conelab(root());
    render.current_dir(out.0.path()).args([
        "render",
        "configs/rays.ron",
        "--scene",
        "cornell",
        "-o",
        "x.exr",
    ]);
    let output = render
        .args(SMALL)
        .args(["--frames", "1", "--set", "view=direct"])
        .output()
        .unwrap();
    let (said, told) = (
        String::from_utf8(output.stdout).unwrap(),
        String::from_utf8(output.stderr).unwrap(),
    );
    assert!(
        said.ends_with("wrote x.exr ('radiance', linear)\n"),
        "{said}"
    );
    assert!(
        told.contains(
            "warning: 'radiance' is the whole light; --resource direct writes 'direct' alone"
        ),
        "{told}"
    );
}

#[test]
fn a_failure_keeps_the_old_picture() {
    let out = Out::new();
    let old = out.write("x.png", "old");
    fails(render("cornell", &old).args(["--set", "nothing=1"]));
    assert_eq!(std::fs::read(&old).unwrap(), b"old");
    succeeds(&mut render("cornell", &old));
    assert!(image::open(&old).is_ok());
    assert_eq!(out.names(), ["x.png"]);
}

/// With room for what Sponza has there, all on threads. All bricks alone would take 100 MiB more.
#[test]
fn voxels_of_512_across_fit_into_800_mib() {
    let set = |name: &str, value: &str| ["--set".to_owned(), format!("{name}={value}")];
    let threads = ["voxelizer", "shadow_map", "gbuffer"].map(|name| set(name, "compute"));
    let sizes = [
        ("voxel_dim", "512"),
        ("voxel_capacity", "1700000"),
        ("fragment_capacity", "3000000"),
    ];
    let sizes = sizes.map(|(name, value)| set(name, value));
    let args = [
        "graph",
        "configs/rays.ron",
        "--size",
        "1920x1080",
        "--barriers",
        "--scene",
    ];
    let settings: Vec<&String> = threads.iter().chain(&sizes).flatten().collect();
    // In the atrium actors move: what stays has a shadow map of its own, of 64 MiB, and motion vectors take 16.
    for (scene, most) in [("cornell", 800.0), ("atrium", 864.0)] {
        let mut command = conelab(root());
        let text = succeeds(command.args(args).arg(scene).args(&settings));
        let mib = |what: &str| -> f64 {
            let line = text
                .lines()
                .find(|l| l.starts_with(what))
                .unwrap_or_else(|| panic!("no '{what}' in\n{text}"));
            line.split_whitespace().last().unwrap().parse().unwrap()
        };
        assert!((500.0..most).contains(&mib("total ")), "{text}");
        assert!(mib("saved by memory") > 100.0, "{text}");
    }
}

#[test]
fn graph_explains_itself() {
    let graph = |args: &[&str]| succeeds(conelab(root()).arg("graph").args(args));
    // A screen of 60 lines.
    for (name, stages) in [
        ("rays", 8),
        ("cones", 9),
        ("thesis", 7),
        ("warps", 9),
        ("temporal", 9),
    ] {
        let text = graph(&[&format!("passes/{name}.ron")]);
        assert!(
            text.starts_with(&format!("graph {name}: ")) && text.lines().count() <= 60,
            "{text}"
        );
        let rows = || text.lines().skip(2).take_while(|l| !l.is_empty());
        assert!(
            rows().filter(|l| !l.starts_with(' ')).count() == stages,
            "{text}"
        );
        assert!(rows().all(|l| l.contains(" -> ")), "{text}");
    }
    let wide = graph(&[
        "passes/cones.ron",
        "--set",
        "opacity=layers",
        "--set",
        "diffuse_aperture=0",
    ]);
    let row = wide
        .lines()
        .find(|l| l.contains("inject/clear.comp"))
        .unwrap();
    assert!(
        row.ends_with("  volume voxelBlocks voxelBricks -> voxelRadiance"),
        "{row}"
    );
    assert!(
        wide.contains("opacity modules/opacity/layers.glsl")
            && wide.contains("diffuse_aperture 6 deg"),
        "{wide}"
    );
    let layers = graph(&["passes/cones.ron", "--set", "mips=isotropic"]);
    assert!(
        layers.contains("filter/isotropic.comp") && !layers.contains("filter/anisotropic.comp"),
        "{layers}"
    );

    let text = graph(&["passes/rays.ron", "--size", "64x48", "--barriers"]);
    assert!(text.starts_with("graph rays: "), "{text}");
    for part in [
        "\norder\n",
        "  shading\n",
        "reads surfels",
        "\nresources ",
        "voxelColor",
        "\nleft out\n",
    ] {
        assert!(text.contains(part), "'{part}' is not in\n{text}");
    }
    assert!(
        text.contains("voxelize tessellated: needs tessellates == 1"),
        "{text}"
    );
    let other = graph(&[
        "configs/rays.ron",
        "--set",
        "voxelizer=tessellated",
        "--barriers",
    ]);
    assert!(
        !other.contains("voxelize tessellated: needs tessellates == 1"),
        "{other}"
    );

    let dot = graph(&["passes/rays.ron", "--dot"]);
    assert!(dot.starts_with("digraph ") && dot.ends_with("}\n"), "{dot}");
    assert!(
        dot.contains("\"pass inject\" -> \"sideRadiance\";"),
        "{dot}"
    );

    // An experiment's own values are printed.
    let params = graph(&["configs/tour.ron", "--params", "--set", "exposure=1"]);
    for value in [
        "  voxel_dim = 64 voxels  (a whole number, 16 to 512; default: 160;",
        "  exposure = 1.0 stops",
    ] {
        assert!(params.contains(value), "{params}");
    }
    let params = graph(&["passes/rays.ron", "--params"]);
    assert!(
        params.contains("  voxel_dim = 160 voxels  (a whole number, 16 to 512; plain: 128)\n      Edge of the volume"),
        "{params}"
    );
    assert!(
        params.contains(
            "  voxelizer = auto  (one of auto, compute, raster, tessellated; plain: raster)\n"
        ),
        "{params}"
    );
    let set = [
        "passes/warps.ron",
        "--params",
        "--set",
        "warp=spline",
        "--set",
        "warp_alpha=0.5",
    ];
    let values = graph(&set);
    assert!(
        values.contains("\n  warp_slope = 1.25  (select("),
        "{values}"
    );

    let out = Out::new();
    assert_snapshot!(out.tidy(&fails(conelab(root()).args(["graph", "rasy.ron"]))), @r"
    passes/rasy.ron: error: cannot read it: No such file or directory (os error 2)
        = help: did you mean 'rays.ron'?
    ");
    assert_snapshot!(out.tidy(&fails(conelab(root()).args(["graph", "passes/cones.ron", "--set", "bais=1"]))), @"error: no parameter 'bais' (did you mean 'bias'?)");
    assert_snapshot!(out.tidy(&fails(conelab(root()).args(["graph", "passes/rays.ron", "--want", "depht"]))), @"error: no resource 'depht' (did you mean 'depth'?)");
}

#[test]
fn check_finds_nothing_here_and_every_mistake_in_a_broken_copy() {
    // Scenes whose models are kept elsewhere are no part of the repository: graphs and experiments are.
    let files = || {
        let mut command = conelab(root());
        command.args([
            "check",
            "passes/rays.ron",
            "passes/preview.ron",
            "configs/rays.ron",
            "configs/thesis.ron",
            "configs/scenes/workshop.ron",
        ]);
        command
    };
    assert_eq!(succeeds(&mut files()), "checked 5 files, 0 errors\n");

    let out = Out::new();
    for folder in ["passes", "shaders", "configs"] {
        copy(&root().join(folder), &out.path(folder));
    }
    let edit = |name: &str, old: &str, new: &str| {
        let text = std::fs::read_to_string(out.path(name)).unwrap();
        assert!(text.contains(old), "{name}");
        std::fs::write(out.path(name), text.replacen(old, new, 1)).unwrap();
    };
    edit(
        "configs/thesis.ron",
        "params: {}",
        "params: { \"voxel_dim\": 8 }",
    );
    let mut command = files();
    command
        .env("CONELAB_HOME", out.0.path())
        .current_dir(out.0.path());
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert_snapshot!(out.tidy(&String::from_utf8_lossy(&output.stdout)), @r#"
    configs/thesis.ron:7:15: error: 'voxel_dim': 8 is outside 16 to 512
        |     params: { "voxel_dim": 8 },
    checked 5 files, 1 errors
    "#);
    edit("shaders/surfels/trace.glsl", "vec4", "vec5");
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(
        said.contains("shaders/surfels/trace.glsl:") && said.contains("vec5"),
        "{said}"
    );
}

#[test]
fn check_of_everything_succeeds() {
    assert!(succeeds(conelab(root()).arg("check")).ends_with(" 0 errors\n"));
}

#[test]
fn devices_are_listed() {
    let text = succeeds(conelab(root()).arg("devices"));
    assert!(
        text.contains(&device()) && text.contains("Vulkan 1.") && text.contains("yes tessellation"),
        "{text}"
    );
}

#[test]
fn a_scene_is_described_as_json() {
    let home = home();
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl nowhere\nf 1 2 3\n";
    std::fs::write(home.path().join("one.obj"), text).unwrap();
    let out = succeeds(conelab(home.path()).args(["scene", "one.obj", "--json", "-"]));
    let scene: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!(scene["triangles"], 1);
    assert_eq!(
        scene["bounds"],
        serde_json::json!([[0.0, 0.0, 0.0], [1.0, 1.0, 0.0]])
    );
    assert!(
        scene["warnings"]
            .as_array()
            .unwrap()
            .iter()
            .any(|w| w.as_str().unwrap().contains("nowhere")),
        "{out}"
    );
}
