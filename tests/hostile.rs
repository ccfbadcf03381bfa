//! Files that nobody would write on purpose: each is told by name, quickly, and nothing panics or hangs.

mod common;

use common::{conelab, fails, home, root};
use conelab::scene::{Scene, SceneError};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use tempfile::TempDir;

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// A copy of the program's folders.
fn write(folder: &TempDir, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
    std::fs::write(folder.path().join(name), content).unwrap();
    folder.path().join(name)
}

fn open(path: impl AsRef<Path>) -> Result<Scene, SceneError> {
    let begun = Instant::now();
    let opened = Scene::open(&path.as_ref().to_string_lossy(), &|_, _| {
        ControlFlow::Continue(())
    });
    // Work that grows with the square of these files takes minutes; a busy machine takes seconds.
    assert!(
        begun.elapsed() < Duration::from_secs(30),
        "{} took {:?}",
        path.as_ref().display(),
        begun.elapsed()
    );
    opened
}

#[track_caller]
fn tells(text: &str, pieces: &[&str]) {
    pieces
        .iter()
        .for_each(|piece| assert!(text.contains(piece), "no '{piece}' in: {text}"));
}

#[track_caller]
fn error(path: impl AsRef<Path>, pieces: &[&str]) {
    tells(&open(path).expect_err("it opened").to_string(), pieces);
}

/// A triangle with the material of one MTL line, and the scene's warnings in one text.
fn with_material(line: &str) -> (Scene, String) {
    let folder = folder();
    write(&folder, "a.mtl", format!("newmtl a\n{line}\n"));
    let scene = open(write(&folder, "a.obj", format!("mtllib a.mtl\n{TRIANGLE}"))).unwrap();
    let warnings = scene.warnings.join("\n");
    (scene, warnings)
}

#[test]
fn a_colour_of_one_number_is_grey_and_of_two_is_left_out() {
    let (scene, warnings) = with_material("Kd 0.5");
    assert_eq!(
        (
            scene.materials[0].base_color.truncate().to_array(),
            warnings.as_str()
        ),
        ([0.5; 3], "")
    );
    for line in [
        "Kd 0.5 0.5",
        "Ke 1 2",
        "Ks",
        "Kd nan 0 0",
        "Kd 0 inf 0",
        "Ke -1 0 0",
        "Kd red",
        "Ns x",
        "map_Kd",
    ] {
        let (_, warnings) = with_material(line);
        tells(&warnings, &["a.mtl: ", "left out ('line 2')"]);
    }
    let (scene, warnings) = with_material("Kd 1e5 0.5 0");
    assert_eq!(
        scene.materials[0].base_color.truncate().to_array(),
        [1.0, 0.5, 0.0]
    );
    tells(&warnings, &["a.mtl: ", "more than arrives", "('line 2')"]);
}

#[test]
fn materials_that_no_library_defines_are_named() {
    let folder = folder();
    write(&folder, "page.mtl", "<html>404 not found</html>\n");
    for text in [format!("mtllib page.mtl\n{TRIANGLE}"), TRIANGLE.into()] {
        let scene = open(write(&folder, "a.obj", text)).unwrap();
        tells(
            &scene.warnings.join("\n"),
            &["a.obj: materials that no library defines are grey ('a')"],
        );
    }
    let many: String = (0..20).map(|i| format!("usemtl m{i}\nf 1 2 3\n")).collect();
    let warnings = open(write(&folder, "many.obj", format!("{TRIANGLE}{many}")))
        .unwrap()
        .warnings
        .join("\n");
    tells(
        &warnings,
        &["no library defines are grey (21 times: 'a', 'm0', 'm1', ...)"],
    );
    write(&folder, "a.mtl", "newmtl a\nKd 1 0 0\n");
    let scene = open(write(
        &folder,
        "known.obj",
        format!("mtllib a.mtl\n{TRIANGLE}"),
    ))
    .unwrap();
    assert_eq!(scene.warnings, [""; 0]);
}

#[test]
fn cameras_look_somewhere_and_lights_are_numbers() {
    let folder = folder();
    let gltf = |x: &str, outer: &str, strength: &str| {
        gltf_with_buffer("a.bin").replacen("\"nodes\":[0]", "\"nodes\":[0,1,2]", 1).replacen(
            "\"nodes\":[{\"mesh\":0}],",
            &format!(
                "\"nodes\":[{{\"mesh\":0,\"translation\":[{x},0,0]}},{{\"camera\":0,\"translation\":[{x},0,9]}},\
                 {{\"extensions\":{{\"KHR_lights_punctual\":{{\"light\":0}}}}}}],\"cameras\":[{{\"type\":\"perspective\",\
                 \"perspective\":{{\"yfov\":0.8,\"znear\":0.1}}}}],\"extensionsUsed\":[\"KHR_lights_punctual\"],\
                 \"extensions\":{{\"KHR_lights_punctual\":{{\"lights\":[{{\"type\":\"spot\",\"intensity\":{strength},\
                 \"spot\":{{\"innerConeAngle\":0.1,\"outerConeAngle\":{outer}}}}}]}}}},"
            ),
            1,
        )
    };
    let corners: [f32; 9] = [0.0, 0.0, 0.0, 1e3, 0.0, 0.0, 0.0, 1e3, 0.0];
    write(
        &folder,
        "a.bin",
        corners
            .iter()
            .flat_map(|v| v.to_le_bytes())
            .collect::<Vec<u8>>(),
    );
    // One metre beside 100,000 km is no distance for 32-bit numbers.
    let far = open(write(&folder, "far.gltf", gltf("1e8", "0.5", "1"))).unwrap();
    assert_eq!(
        (far.cameras.len(), far.warnings.len()),
        (2, 0),
        "{:?}",
        far.warnings
    );
    assert!(
        far.cameras
            .values()
            .all(|c| (c.target - c.eye).try_normalize().is_some()),
        "{:?}",
        far.cameras
    );
    for (outer, strength, told) in [
        (
            "1e39",
            "1",
            "cone angles that do not obey 0 <= inner <= outer <= 90 degrees",
        ),
        ("0.05", "1", "cone angles"),
        ("0.5", "1e39", "intensity that is too large"),
        (
            "0.5",
            "-1",
            "negative colours and intensities of lights count as 0",
        ),
    ] {
        let scene = open(write(&folder, "light.gltf", gltf("0", outer, strength))).unwrap();
        tells(&scene.warnings.join("\n"), &["'node 2'", told]);
        let export = folder.path().join("export.gltf");
        scene.export(&export).unwrap();
        let text = std::fs::read_to_string(export).unwrap();
        assert!(!text.contains("null") && scene.lights.len() == 1, "{text}");
    }
}

#[test]
fn a_model_in_many_places_is_read_once() {
    let folder = folder();
    write(&folder, "a.obj", TRIANGLE);
    let at = |i: usize| format!("transform: (translate: ({}, 0, 0))", i * 30);
    let models: String = (0..12)
        .map(|i| format!("(builtin: \"atrium\", {0}, lights: false, cameras: false), (file: \"a.obj\", {0}),", at(i)))
        .collect();
    let path = write(&folder, "many.ron", format!("(models: [{models}])"));
    let opened = |name: &str| Scene::open(name, &|_, _| ControlFlow::Continue(())).unwrap();
    let (scene, one) = (opened(&path.to_string_lossy()), opened("atrium"));
    assert_eq!(scene.meshes.len(), one.meshes.len() + 1);
    assert_eq!(scene.instances.len(), 12 * (one.instances.len() + 1));
    assert_eq!(
        (scene.textures.len(), scene.materials.len()),
        (one.textures.len(), one.materials.len() + 1)
    );
    assert!(scene.bounds().1.x > 11.0 * 30.0);
}

#[test]
fn messages_speak_of_files_and_name_only_what_happened() {
    let folder = folder();
    let deep = format!(
        "(meshes: {{\"a\": {}{}}})",
        "[Solid(".repeat(1000),
        ")]".repeat(1000)
    );
    error(
        write(&folder, "deep.ron", &deep),
        &["deep.ron:1:", "brackets are nested too deeply"],
    );
    let experiment = write(
        &folder,
        "e.ron",
        format!("(graph: {}{})", "[".repeat(1000), "]".repeat(1000)),
    );
    let told = conelab(root())
        .arg("check")
        .arg(experiment)
        .output()
        .unwrap();
    let told = String::from_utf8(told.stdout).unwrap();
    assert!(
        told.contains("brackets are nested too deeply") && !told.contains("serde"),
        "{told}"
    );
    let flat = TRIANGLE.replace("v 0 1 0", "v 2 0 0") + "v 0 1 0\nf 1 2 4\n";
    let warnings = open(write(&folder, "flat.obj", flat))
        .unwrap()
        .warnings
        .join("\n");
    tells(&warnings, &["flat.obj: dropped 1 triangles without area"]);
    assert!(!warnings.contains("NaN"), "{warnings}");
}

#[test]
fn one_line_may_name_several_material_libraries() {
    let folder = folder();
    write(&folder, "a.mtl", "newmtl a\nKd 1 0 0\n");
    write(&folder, "b.mtl", "newmtl b\nKd 0 1 0\n");
    write(&folder, "two words.mtl", "newmtl a\nKd 0 0 1\n");
    let scene = open(write(
        &folder,
        "two.obj",
        format!("mtllib a.mtl b.mtl\n{TRIANGLE}usemtl b\nf 1 3 2\n"),
    ))
    .unwrap();
    let colors: Vec<[f32; 4]> = scene
        .materials
        .iter()
        .map(|m| m.base_color.to_array())
        .collect();
    assert_eq!(
        colors,
        [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0]],
        "{:?}",
        scene.warnings
    );
    let scene = open(write(
        &folder,
        "spaces.obj",
        format!("mtllib two words.mtl\n{TRIANGLE}"),
    ))
    .unwrap();
    assert_eq!(
        (scene.materials[0].base_color.z, scene.warnings.len()),
        (1.0, 0),
        "{:?}",
        scene.warnings
    );
}

#[test]
fn a_model_without_triangles_has_a_warning_and_one_of_another_format_an_error() {
    let folder = folder();
    let noise: Vec<u8> = (0..5000u32)
        .map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8)
        .collect();
    let warnings = open(write(&folder, "empty.obj", ""))
        .unwrap()
        .warnings
        .join("\n");
    tells(&warnings, &["empty.obj", "no triangles"]);
    for (name, content) in [
        ("junk.obj", noise.as_slice()),
        ("text.obj", b"hello world\n"),
    ] {
        error(
            write(&folder, name, content),
            &[name, "it holds nothing of the OBJ format"],
        );
    }
}

/// A polygon of 200,000 corners with crossing edges, and lines of a megabyte.
#[test]
fn hostile_polygons_and_lines_end() {
    let folder = folder();
    let scatter = |i: u32| i.wrapping_mul(2_654_435_761) >> 16;
    let vertices: String = (0..1000)
        .map(|i| format!("v {} {} 0\n", scatter(i), scatter(i + 5000)))
        .collect();
    let corners: String = (0..200_000)
        .map(|i| format!(" {}", scatter(i) % 1000 + 1))
        .collect();
    let scene = open(write(
        &folder,
        "polygon.obj",
        format!("{vertices}f{corners}\n"),
    ))
    .unwrap();
    assert!(scene.triangle_count() > 1000, "{}", scene.triangle_count());
    tells(
        &scene.warnings.join("\n"),
        &["polygon.obj: faces cross or touch themselves"],
    );
    let lines = format!(
        "{TRIANGLE}f 1 2 3{}\n{}",
        " \\\n1 2 3".repeat(100_000),
        "#".repeat(1 << 20)
    );
    assert!(open(write(&folder, "lines.obj", lines)).is_ok());
    let names = format!(
        "mtllib {}\nusemtl {}\n{TRIANGLE}",
        "x/".repeat(1 << 20),
        "y".repeat(1 << 20)
    );
    let warnings = open(write(&folder, "names.obj", names))
        .unwrap()
        .warnings
        .join("\n");
    assert!(
        warnings.len() < 1000,
        "{} bytes of warnings",
        warnings.len()
    );
}

#[test]
fn only_regular_files_are_opened() {
    let folder = folder();
    let fifo = folder.path().join("pipe.obj");
    assert!(
        std::process::Command::new("mkfifo")
            .arg(&fifo)
            .status()
            .unwrap()
            .success()
    );
    let link =
        |to: &str, name: &str| std::os::unix::fs::symlink(to, folder.path().join(name)).unwrap();
    link("/dev/zero", "zero.bin");
    link("/dev/zero", "zero.mtl");
    link("/dev/zero", "zero.png");
    link("/dev/zero", "zero.gltf");
    link("/dev/zero", "zero.ron");
    link("pipe.obj", "pipe.hdr");
    error(&fifo, &["pipe.obj", "no regular file"]);
    error(
        folder.path().join("zero.gltf"),
        &["zero.gltf", "no regular file"],
    );
    error(
        folder.path().join("zero.ron"),
        &["zero.ron", "no regular file"],
    );
    for uri in [
        "/dev/zero",
        "zero.bin",
        "../../../../../../dev/zero",
        "file:///dev/zero",
    ] {
        error(
            write(&folder, "a.gltf", gltf_with_buffer(uri)),
            &["a.gltf", "zero", "no regular file"],
        );
    }
    error(
        write(&folder, "sky.ron", "(environment: (file: \"pipe.hdr\"))"),
        &["pipe.hdr", "sky.ron"],
    );
    let text = format!("mtllib zero.mtl\n{TRIANGLE}");
    tells(
        &open(write(&folder, "m.obj", text))
            .unwrap()
            .warnings
            .join("\n"),
        &["zero.mtl", "no regular file"],
    );
    write(&folder, "t.mtl", "newmtl a\nmap_Kd zero.png\n");
    let text = format!("mtllib t.mtl\n{TRIANGLE}");
    tells(
        &open(write(&folder, "t.obj", text))
            .unwrap()
            .warnings
            .join("\n"),
        &["zero.png", "no regular file"],
    );
    for command in ["check", "render", "graph"] {
        let begun = Instant::now();
        fails(
            conelab(root())
                .args([command])
                .arg(folder.path().join("zero.ron")),
        );
        assert!(begun.elapsed() < Duration::from_secs(30));
    }
}

/// A triangle in a buffer at a URI.
fn gltf_with_buffer(uri: &str) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":3,"min":[0,0,0],"max":[1,1,1]}}],
        "bufferViews":[{{"buffer":0,"byteLength":36}}],"buffers":[{{"uri":"{uri}","byteLength":36}}]}}"#
    )
}

#[test]
fn absurd_sizes_are_told_before_work_begins() {
    let folder = folder();
    let far = TRIANGLE.replace('1', "3e38");
    error(
        write(&folder, "far.obj", far.replace("f 3e38", "f 1")),
        &["far.obj", "units and scale"],
    );
    write(&folder, "a.obj", TRIANGLE);
    for (entry, pieces) in [
        (
            "models: [(file: \"a.obj\", transform: (scale: (1e18, 1, 1)))]",
            &["s.ron:1:", "1e9"][..],
        ),
        (
            "models: [(file: \"a.obj\", transform: (translate: (0, 3e38, 1)))]",
            &["s.ron:1:", "1e9"],
        ),
        (
            "models: [(builtin: \"huge-ground\", transform: (scale: (1e8, 1e8, 1e8)))]",
            &["huge-ground", "units and scale"],
        ),
        ("sky: (-1, 0, 0)", &["s.ron:1:", "0 or more"]),
        (
            "cameras: {\"c\": (eye: (0, 0, 1e30), target: (0, 0, 0), fov_y: 50)}",
            &["s.ron:1:", "origin"],
        ),
        (
            "cameras: {\"c\": (eye: (1e8, 0, 1), target: (1e8, 0, 0.5), fov_y: 50, near: 2, far: 1)}",
            &["near"],
        ),
        (
            "cameras: {\"c\": (eye: (0, 1e8, 0), target: (0, 100000001, 0), fov_y: 50)}",
            &["one place", "8e0 m apart"],
        ),
        (
            "lights: [Point(color: (1, 1, 1), position: (1e20, 0, 0), shadow: true)]",
            &["s.ron:1:", "origin"],
        ),
    ] {
        error(write(&folder, "s.ron", format!("({entry})")), pieces);
    }
}

#[test]
fn scenes_too_small_for_light_are_told() {
    let folder = folder();
    for (scale, warnings) in [("1e-3", 0), ("1e-6", 1)] {
        let text = format!(
            "(models: [(builtin: \"cornell\", transform: (scale: ({scale}, {scale}, {scale})))])"
        );
        let scene = open(write(&folder, "small.ron", text)).unwrap();
        assert_eq!(
            scene
                .warnings
                .iter()
                .filter(|w| w.contains("light is lost"))
                .count(),
            warnings,
            "{scale}"
        );
    }
}

#[test]
fn messages_quote_a_short_part_of_a_line() {
    let folder = folder();
    let long = "x".repeat(200_000);
    for (name, text) in [
        (
            "long.ron",
            format!("(graph: \"rays.ron\", scene: \"cornell\", {long}: 1)"),
        ),
        (
            "nul.ron",
            format!("(graph: \"rays.ron\",\0\0\x1b[31m scene: cornell, {long})"),
        ),
        ("scene.ron", format!("(models: [], {long}: 1)")),
        (
            "passes.ron",
            format!("(textures: {{ \"{long}\": (size: Scren) }}, output: \"{long}\")"),
        ),
    ] {
        let path = write(&folder, name, text);
        for command in ["check", "graph", "scene"] {
            let output = conelab(root()).arg(command).arg(&path).output().unwrap();
            let text = [output.stdout, output.stderr].concat();
            assert!(
                text.len() < 20_000,
                "{command} {name}: {} bytes",
                text.len()
            );
            assert!(
                !text.iter().any(|b| b.is_ascii_control() && *b != b'\n'),
                "{command} {name}"
            );
        }
    }
}

#[test]
fn includes_that_grow_with_a_power_or_go_in_a_circle_end_at_once() {
    let home = home();
    let at = |name: &str| home.path().join(name);
    for i in 0..40 {
        let next = format!("#include \"x{}.glsl\"\n", i + 1);
        std::fs::write(at(&format!("shaders/x{i}.glsl")), next.repeat(2)).unwrap();
    }
    std::fs::write(at("shaders/x40.glsl"), "\n").unwrap();
    let shader = "#version 460\n#extension GL_GOOGLE_include_directive : require\n#include \"x0.glsl\"\n\
                  layout(local_size_x = 4) in;\nvoid main() {}\n";
    std::fs::write(at("shaders/l.comp"), shader).unwrap();
    let graph = "(textures: {\"p\": (size: (\"4\", \"4\"), format: \"rgba8\")}, output: \"p\", \
                 passes: [(name: \"l\", shaders: [\"l.comp\"], dispatch: Groups(1, 1, 1))])";
    std::fs::write(at("passes/l.ron"), graph).unwrap();
    for i in 0..40 {
        std::fs::write(
            at(&format!("passes/r{i}.ron")),
            format!("(include: [\"r{}.ron\"])", i + 1),
        )
        .unwrap();
    }
    std::fs::write(at("passes/r40.ron"), "()").unwrap();
    let cycle = std::fs::read_to_string(at("passes/parts/tone.ron")).unwrap();
    std::fs::write(
        at("passes/parts/tone.ron"),
        cycle.replacen('(', "(include: [\"parts/display.ron\"],", 1),
    )
    .unwrap();
    for (file, pieces) in [
        ("passes/l.ron", &["x0.glsl > x1.glsl > x2.glsl"][..]),
        ("passes/r0.ron", &["32 deep", "r0.ron > ", "r1.ron > "]),
        (
            "passes/rays.ron",
            &["display.ron > picture.ron > tone.ron > display.ron"],
        ),
    ] {
        let begun = Instant::now();
        let output = conelab(home.path()).args(["check", file]).output().unwrap();
        assert!(
            begun.elapsed() < Duration::from_secs(60),
            "{file}: {:?}",
            begun.elapsed()
        );
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        assert_eq!(output.status.code(), Some(1), "{text}");
        assert_eq!(
            text.matches("x0.glsl > x1.glsl > x2.glsl").count(),
            usize::from(file.ends_with("l.ron")),
            "{text}"
        );
        tells(&text, pieces);
    }
}

#[test]
fn a_damaged_scene_is_one_failed_point_of_a_sweep() {
    let (home, out) = (home(), folder());
    write(&home, "b.gltf", gltf_with_buffer("gone.bin"));
    let sweep = "(experiments: [\"configs/rays.ron\"], warmup: 0, frames: 1, \
                 set: {\"size\": (24, 16), \"voxel_dim\": 16, \"shadow_dim\": 256}, \
                 axes: [List(name: \"scene\", values: [\"b.gltf\", \"cornell\"])])";
    let sweep = write(&home, "s.ron", sweep);
    let told = fails(
        conelab(home.path())
            .arg("sweep")
            .arg(sweep)
            .arg("-o")
            .arg(out.path()),
    );
    tells(&told, &["1 points failed"]);
    let table = std::fs::read_to_string(out.path().join("sweep.csv")).unwrap();
    tells(&table, &["gone.bin", "cornell"]);
    assert_eq!(
        std::fs::read_dir(out.path().join("points"))
            .unwrap()
            .count(),
        2
    );
}

#[test]
fn some_vertices_may_have_colours() {
    let folder = folder();
    let text = TRIANGLE.replacen("v 1 0 0\n", "v 1 0 0 1.0 0.5 0.2\n", 1);
    let scene = open(write(&folder, "a.obj", text)).unwrap();
    assert_eq!((scene.triangle_count(), scene.bounds().1.x), (1, 1.0));
}

#[test]
fn texels_of_the_picture_that_are_no_numbers_are_counted() {
    let home = home();
    let shader = home.path().join("shaders/shade/deferred.glsl");
    let text = std::fs::read_to_string(&shader).unwrap();
    // A mistake in a shader, in one row of the picture.
    let wrong = "if (pixel.y == 5) total.g = uintBitsToFloat(pixel.x < 10 ? 0x7fc00000u : 0x7f800000u);\n    ";
    let store = "imageStore(sampledRadiance, pixel, vec4(total, 1.0));";
    assert!(text.contains(store));
    std::fs::write(&shader, text.replace(store, &format!("{wrong}{store}"))).unwrap();
    let render = |more: &[&str]| {
        let mut command = conelab(home.path());
        command.args([
            "render",
            "configs/rays.ron",
            "--scene",
            "cornell",
            "--size",
            "48x32",
            "--frames",
            "1",
        ]);
        command
            .args([
                "--set",
                "voxel_dim=32",
                "--set",
                "shadow_dim=512",
                "--json",
                "-",
            ])
            .args(more)
            .output()
            .unwrap()
    };
    for (output, told) in [
        (
            "x.png",
            "texels of the picture are NaN or overflow its format (48)",
        ),
        ("x.exr", "'radiance' has 48 texels that are NaN or infinite"),
    ] {
        let rendered = render(&["-o", output]);
        tells(
            &String::from_utf8(rendered.stderr).unwrap(),
            &[&format!("warning: {told}\n")],
        );
        let stats: serde_json::Value = serde_json::from_slice(&rendered.stdout).unwrap();
        assert_eq!(stats["warnings"], serde_json::json!([told]));
    }
    let normals = render(&["-o", "n.png", "--set", "view=normal"]);
    let stats: serde_json::Value = serde_json::from_slice(&normals.stdout).unwrap();
    assert_eq!(stats["warnings"], serde_json::json!([]));
}
