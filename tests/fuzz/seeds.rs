//! Whole files of every kind, to be mutated.

use super::common::root;
use conelab::metrics::Linear;
use conelab::scene::Scene;
use ddsfile::{AlphaMode, D3D10ResourceDimension, Dds, DxgiFormat, NewDxgiParams};
use image::{DynamicImage, ImageFormat, Rgb32FImage, RgbaImage};
use std::io::Cursor;
use std::ops::ControlFlow;
use std::path::Path;

/// Who reads a file.
#[derive(Clone, Copy)]
pub enum Kind {
    Scene,
    Graph,
    Experiment,
    Sweep,
    Suite,
    Path,
    Capture,
    Points,
    Times,
    Picture,
}

/// A file that is mutated, and the one that is opened and names it, or is it.
pub struct Seed {
    pub kind: Kind,
    pub opened: &'static str,
    pub mutated: &'static str,
    pub bytes: Vec<u8>,
}

const FILES: [(Kind, &str, &str); 34] = [
    (Kind::Scene, "room.obj", "room.obj"),
    (Kind::Scene, "room.obj", "room.mtl"),
    (Kind::Scene, "small.obj", "small.obj"),
    (Kind::Scene, "small.obj", "small.mtl"),
    (Kind::Scene, "small.obj", "t.png"),
    (Kind::Scene, "small.obj", "t.jpg"),
    (Kind::Scene, "small.obj", "t.tga"),
    (Kind::Scene, "small.obj", "t.bmp"),
    (Kind::Scene, "small.obj", "bc1.dds"),
    (Kind::Scene, "small.obj", "bc7.dds"),
    (Kind::Scene, "small.obj", "plain.dds"),
    (Kind::Scene, "room.gltf", "room.gltf"),
    (Kind::Scene, "room.gltf", "room.bin"),
    (Kind::Scene, "moving.gltf", "moving.gltf"),
    (Kind::Scene, "moving.gltf", "moving.bin"),
    (Kind::Scene, "room.glb", "room.glb"),
    (Kind::Scene, "scene.ron", "scene.ron"),
    (Kind::Scene, "sky.ron", "sky.ron"),
    (Kind::Scene, "sky.ron", "sky.hdr"),
    (Kind::Scene, "sky2.ron", "sky.exr"),
    (Kind::Graph, "vct.ron", "vct.ron"),
    (Kind::Graph, "thesis.ron", "thesis.ron"),
    (Kind::Graph, "reference.ron", "reference.ron"),
    (Kind::Graph, "warps.ron", "warps.ron"),
    (Kind::Experiment, "default.ron", "default.ron"),
    (Kind::Sweep, "cones.ron", "cones.ron"),
    (Kind::Suite, "motion.ron", "motion.ron"),
    (Kind::Path, "atrium.ron", "atrium.ron"),
    (Kind::Capture, "capture/capture.json", "capture/capture.json"),
    (Kind::Points, "points/sweep.json", "points/sweep.json"),
    (Kind::Times, "times.json", "times.json"),
    (Kind::Picture, "sky.exr", "sky.exr"),
    (Kind::Picture, "sky.hdr", "sky.hdr"),
    (Kind::Picture, "t.png", "t.png"),
];

/// All of them.
pub fn all() -> Vec<Seed> {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path());
    let seed = |(kind, opened, mutated): (Kind, &'static str, &'static str)| {
        let bytes = std::fs::read(folder.path().join(mutated)).unwrap();
        Seed { kind, opened, mutated, bytes }
    };
    FILES.into_iter().map(seed).collect()
}

/// Writes the files into a folder.
pub fn write(folder: &Path) {
    let put = |name: &str, bytes: &[u8]| std::fs::write(folder.join(name), bytes).unwrap();
    let builtin = |name: &str| Scene::open(name, &|_, _| ControlFlow::Continue(())).unwrap();
    let (room, moving) = (builtin("cornell"), builtin("moving-box"));
    ["room.obj", "room.gltf", "room.glb"].iter().for_each(|name| room.export(&folder.join(name)).unwrap());
    moving.export(&folder.join("moving.gltf")).unwrap();
    put("small.obj", SMALL_OBJ.as_bytes());
    put("small.mtl", SMALL_MTL.as_bytes());
    let picture = DynamicImage::ImageRgba8(RgbaImage::from_fn(8, 8, |x, y| {
        image::Rgba([x as u8 * 30, y as u8 * 30, 128, if (x + y) % 3 == 0 { 0 } else { 255 }])
    }));
    for (name, format) in [("t.png", ImageFormat::Png), ("t.tga", ImageFormat::Tga), ("t.bmp", ImageFormat::Bmp)] {
        put(name, &encoded(&picture, format));
    }
    put("t.jpg", &encoded(&DynamicImage::ImageRgb8(picture.to_rgb8()), ImageFormat::Jpeg));
    put("bc1.dds", &dds(DxgiFormat::BC1_UNorm));
    put("bc7.dds", &dds(DxgiFormat::BC7_UNorm_sRGB));
    put("plain.dds", &dds(DxgiFormat::R8G8B8A8_UNorm));
    let sky = Rgb32FImage::from_fn(16, 8, |x, y| image::Rgb([x as f32, y as f32 * 0.5, 1.0]));
    put("sky.hdr", &encoded(&DynamicImage::ImageRgb32F(sky.clone()), ImageFormat::Hdr));
    let linear = Linear::radiance((16, 8), sky.pixels().map(|p| p.0).collect());
    conelab::results::picture::write_linear(&folder.join("sky.exr"), &linear).unwrap();
    put("scene.ron", SCENE.as_bytes());
    put("sky.ron", b"(models: [(builtin: \"cornell\")], environment: (file: \"sky.hdr\", rotation: 30, intensity: 2))");
    put(
        "sky2.ron",
        b"(models: [(builtin: \"cornell\")], environment: (file: \"sky.exr\", rotation: 30, intensity: 2))",
    );
    for (name, from) in [
        ("vct.ron", "passes/vct.ron"),
        ("thesis.ron", "passes/thesis.ron"),
        ("reference.ron", "passes/reference.ron"),
        ("warps.ron", "passes/warps.ron"),
        ("default.ron", "configs/default.ron"),
        ("cones.ron", "configs/sweeps/cones.ron"),
        ("motion.ron", "configs/stability/motion.ron"),
        ("atrium.ron", "configs/paths/atrium.ron"),
    ] {
        // What they name lies beside the originals.
        let text = std::fs::read_to_string(root().join(from)).unwrap();
        let beside = text.replace("\"../", &format!("\"{}/", root().join("configs").display()));
        put(name, beside.as_bytes());
    }
    let times = std::fs::read_dir(root().join("configs/times")).unwrap().flatten().next().unwrap();
    std::fs::copy(times.path(), folder.join("times.json")).unwrap();
    ["capture", "points"].iter().for_each(|name| std::fs::create_dir_all(folder.join(name)).unwrap());
    put("capture/capture.json", CAPTURE.as_bytes());
    put("points/sweep.json", POINTS.as_bytes());
}

fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut out = Cursor::new(Vec::new());
    image.write_to(&mut out, format).unwrap();
    out.into_inner()
}

fn dds(format: DxgiFormat) -> Vec<u8> {
    let mut file = Dds::new_dxgi(NewDxgiParams {
        height: 8,
        width: 8,
        depth: None,
        format,
        mipmap_levels: Some(2),
        array_layers: None,
        caps2: None,
        is_cubemap: false,
        resource_dimension: D3D10ResourceDimension::Texture2D,
        alpha_mode: AlphaMode::Straight,
    })
    .unwrap();
    file.data.iter_mut().enumerate().for_each(|(i, byte)| *byte = i as u8);
    let mut bytes = Vec::new();
    file.write(&mut bytes).unwrap();
    bytes
}

const SMALL_OBJ: &str = "mtllib small.mtl room.mtl\no a\nv 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0 1 0.5 0.2\nvt 0 0\nvt 1 0\nvt 1 1\n\
    vn 0 0 1\ns 1\ng b\nusemtl m\nf 1/1/1 2/2/1 3/3/1\nusemtl n\nf -4/1 -2/2 -1/3\nl 1 2\np 1\nusemtl o\nf 1 2 3 4\n\
    usemtl p\nf 4//1 3//1 1//1\n";

const SMALL_MTL: &str = "newmtl m\nKa 0.1 0.1 0.1\nKd 0.5 0.25 1\nKs 0.1 0.1 0.1\nNs 10\nd 1\nillum 2\nmap_Kd -s 1 1 1 t.png\n\
    map_d t.tga\nnewmtl n\nKd 0.3\nTr 0.2\nmap_Kd bc1.dds\nmap_Pr t.jpg\nmap_Pm t.bmp\nPm 0.5\nPr 0.3\nKe 1 2 3\n\
    newmtl o\nKd 1 1 1\nmap_Kd bc7.dds\nbump -bm 1 wall_n.png\nnewmtl p\nKd 1 1 1\nmap_Kd plain.dds\nnorm t.png\nior 1.4\n";

const SCENE: &str = "(name: \"x\", models: [(file: \"small.obj\", transform: (translate: (1, 2, 3), rotate_deg: (0, 45, 0), \
    scale: (2, 2, 2)), animation: (keyframes: [(time: 0), (time: 2, translate: (0, 1, 0), rotate_deg: (0, 360, 0))], \
    repeat: true)), (builtin: \"cornell\", lights: false)], lights: [Directional(name: \"sun\", color: (3, 3, 3), \
    direction: (-0.4, -1, -0.5), shadow: true), Point(color: (1, 1, 1), position: (0, 1, 0), shadow: false), \
    Spot(color: (5, 5, 5), position: (0, 2, 0), direction: (0, -1, 0), inner_deg: 20, outer_deg: 40, shadow: true)], \
    sky: (0.2, 0.3, 0.4), cameras: {\"default\": (eye: (0.5, 1.8, 6), target: (0, 1, 0), fov_y: 50, near: 0.1, far: 50)})";

const CAPTURE: &str = r#"{"schema":"conelab-capture-1","version":"0.1.0","device":"d","driver":"e","when":"2026-01-01T00:00:00Z",
    "experiment":"default","graph":"vct.ron","scene":{"spec":"cornell","name":"cornell","sha256":"00"},"size":[96,64],
    "frames":1,"step":0.0,"images":[{"file":"display.png","texture":"display","mip":0,"layer":0}],
    "files":{"display.png":"00","experiment.ron":"00","passes/vct.ron":"00"}}"#;

const POINTS: &str = r#"{"schema":"conelab-sweep-1","name":"cones","text":"","names":["cone_count"],
    "frames":{"warmup":1,"count":1},"points":[{"id":"0123456789abcdef0123456789abcdef","labels":{"cone_count":"5"}},
    {"id":"fedcba9876543210fedcba9876543210","labels":{"cone_count":"9"}}]}"#;
