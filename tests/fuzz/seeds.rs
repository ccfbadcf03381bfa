//! Whole files of every kind, to be mutated.

use super::common::model_file::{Model, bending};
use super::common::root;
use conelab::graph::link::generated;
use conelab::graph::load::Folders;
use conelab::lab::load;
use conelab::metrics::Linear;
use conelab::scene::Scene;
use conelab::shader::{ShaderCompiler, Source};
use conelab::vulkan::Stage;
use ddsfile::{AlphaMode, D3D10ResourceDimension, Dds, DxgiFormat, NewDxgiParams};
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, WritableImage,
};
use image::{DynamicImage, ImageFormat, Rgb32FImage, RgbaImage};
use sha2::{Digest, Sha256};
use std::io::Cursor;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::LazyLock;

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
    Reference,
    Module,
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

const FILES: [(Kind, &str, &str); 51] = [
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
    (Kind::Scene, "small.obj", "t.ktx2"),
    (Kind::Scene, "lit.gltf", "lit.gltf"),
    (Kind::Scene, "lit.gltf", "t.ktx2"),
    (Kind::Scene, "etc1s.gltf", "etc1s_alpha.ktx2"),
    (Kind::Scene, "uastc.gltf", "uastc_zstd.ktx2"),
    (Kind::Scene, "ext.glb", "ext.glb"),
    (Kind::Scene, "khr.glb", "khr.glb"),
    (Kind::Scene, "room.gltf", "room.gltf"),
    (Kind::Scene, "room.gltf", "room.bin"),
    (Kind::Scene, "moving.gltf", "moving.gltf"),
    (Kind::Scene, "moving.gltf", "moving.bin"),
    (Kind::Scene, "skin.gltf", "skin.gltf"),
    (Kind::Scene, "room.glb", "room.glb"),
    (Kind::Scene, "blender.fbx", "blender.fbx"),
    (Kind::Scene, "text.fbx", "text.fbx"),
    (Kind::Scene, "scene.ron", "scene.ron"),
    (Kind::Scene, "sky.ron", "sky.ron"),
    (Kind::Scene, "sky.ron", "sky.hdr"),
    (Kind::Scene, "sky2.ron", "sky.exr"),
    (Kind::Graph, "rays.ron", "rays.ron"),
    (Kind::Graph, "thesis.ron", "thesis.ron"),
    (Kind::Graph, "reference.ron", "reference.ron"),
    (Kind::Graph, "warps.ron", "warps.ron"),
    (Kind::Experiment, "default.ron", "default.ron"),
    (Kind::Sweep, "cones.ron", "cones.ron"),
    (Kind::Suite, "motion.ron", "motion.ron"),
    (Kind::Path, "atrium.ron", "atrium.ron"),
    (
        Kind::Capture,
        "capture/capture.json",
        "capture/capture.json",
    ),
    (
        Kind::Capture,
        "capture/capture.json",
        "capture/experiment.ron",
    ),
    (
        Kind::Capture,
        "capture/capture.json",
        "capture/graph/passes/graph.ron",
    ),
    (
        Kind::Capture,
        "capture/capture.json",
        "capture/graph/shaders/fill.comp",
    ),
    (
        Kind::Reference,
        "reference/reference.json",
        "reference/reference.json",
    ),
    (
        Kind::Reference,
        "reference/reference.json",
        "reference/sums-32.exr",
    ),
    (Kind::Module, "module.spv", "module.spv"),
    (Kind::Points, "points/sweep.json", "points/sweep.json"),
    (
        Kind::Points,
        "points/sweep.json",
        "points/points/0123456789abcdef0123456789abcdef.json",
    ),
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
        Seed {
            kind,
            opened,
            mutated,
            bytes,
        }
    };
    FILES.into_iter().map(seed).collect()
}

/// Writes the files into a folder.
pub fn write(folder: &Path) {
    let put = |name: &str, bytes: &[u8]| std::fs::write(folder.join(name), bytes).unwrap();
    let builtin = |name: &str| Scene::open(name, &|_, _| ControlFlow::Continue(())).unwrap();
    let (room, moving) = (builtin("cornell"), builtin("moving-box"));
    ["room.obj", "room.gltf", "room.glb"]
        .iter()
        .for_each(|name| drop(room.export(&folder.join(name)).unwrap()));
    moving.export(&folder.join("moving.gltf")).unwrap();
    let mut skin = Model::new();
    bending(&mut skin, false);
    skin.write(folder, "skin.gltf");
    std::fs::copy(
        root().join("tests/fbx_files/blender.fbx"),
        folder.join("blender.fbx"),
    )
    .unwrap();
    put("text.fbx", super::fbx::room().as_bytes());
    put("small.obj", SMALL_OBJ.as_bytes());
    put("small.mtl", SMALL_MTL.as_bytes());
    let picture = DynamicImage::ImageRgba8(RgbaImage::from_fn(8, 8, |x, y| {
        image::Rgba([
            x as u8 * 30,
            y as u8 * 30,
            128,
            if (x + y) % 3 == 0 { 0 } else { 255 },
        ])
    }));
    for (name, format) in [
        ("t.png", ImageFormat::Png),
        ("t.tga", ImageFormat::Tga),
        ("t.bmp", ImageFormat::Bmp),
    ] {
        put(name, &encoded(&picture, format));
    }
    put(
        "t.jpg",
        &encoded(
            &DynamicImage::ImageRgb8(picture.to_rgb8()),
            ImageFormat::Jpeg,
        ),
    );
    put("bc1.dds", &dds(DxgiFormat::BC1_UNorm));
    put("bc7.dds", &dds(DxgiFormat::BC7_UNorm_sRGB));
    put("plain.dds", &dds(DxgiFormat::R8G8B8A8_UNorm));
    let sky = Rgb32FImage::from_fn(16, 8, |x, y| image::Rgb([x as f32, y as f32 * 0.5, 1.0]));
    put(
        "sky.hdr",
        &encoded(&DynamicImage::ImageRgb32F(sky.clone()), ImageFormat::Hdr),
    );
    let linear = Linear::radiance((16, 8), sky.pixels().map(|p| p.0).collect());
    conelab::results::picture::write_linear(&folder.join("sky.exr"), &linear).unwrap();
    put("scene.ron", SCENE.as_bytes());
    put("sky.ron", b"(models: [(builtin: \"cornell\")], environment: (file: \"sky.hdr\", rotation: 30, intensity: 2))");
    put(
        "sky2.ron",
        b"(models: [(builtin: \"cornell\")], environment: (file: \"sky.exr\", rotation: 30, intensity: 2))",
    );
    for (name, from) in [
        ("rays.ron", "passes/rays.ron"),
        ("thesis.ron", "passes/thesis.ron"),
        ("reference.ron", "passes/reference.ron"),
        ("warps.ron", "passes/warps.ron"),
        ("default.ron", "configs/rays.ron"),
        ("cones.ron", "configs/sweeps/cones.ron"),
        ("motion.ron", "configs/stability/motion.ron"),
        ("atrium.ron", "configs/paths/atrium.ron"),
    ] {
        // What they name lies beside the originals.
        let text = std::fs::read_to_string(root().join(from)).unwrap();
        let beside = text.replace("\"../", &format!("\"{}/", root().join("configs").display()));
        put(name, beside.as_bytes());
    }
    let times = std::fs::read_dir(root().join("configs/times"))
        .unwrap()
        .flatten()
        .next()
        .unwrap();
    std::fs::copy(times.path(), folder.join("times.json")).unwrap();
    let folders = [
        "capture/graph/passes",
        "capture/graph/shaders",
        "points/points",
        "reference",
    ];
    folders
        .iter()
        .for_each(|name| std::fs::create_dir_all(folder.join(name)).unwrap());
    put("capture/capture.json", CAPTURE.as_bytes());
    put("capture/picture.png", &encoded(&picture, ImageFormat::Png));
    put(
        "capture/experiment.ron",
        b"(graph: \"graph.ron\", scene: \"furnace\", size: (8, 8), params: {\"level\": 0.25})",
    );
    put("capture/graph/passes/graph.ron", GRAPH.as_bytes());
    put("capture/graph/shaders/fill.comp", FILL.as_bytes());
    put("points/sweep.json", POINTS.as_bytes());
    put(
        "points/points/0123456789abcdef0123456789abcdef.json",
        POINT.as_bytes(),
    );
    put("t.ktx2", &ktx2());
    put("lit.gltf", LIT.as_bytes());
    put(
        "etc1s.gltf",
        LIT.replace("t.ktx2", "etc1s_alpha.ktx2").as_bytes(),
    );
    put(
        "uastc.gltf",
        LIT.replace("t.ktx2", "uastc_zstd.ktx2").as_bytes(),
    );
    for name in ["etc1s_alpha.ktx2", "uastc_zstd.ktx2", "ext.glb", "khr.glb"] {
        std::fs::copy(
            root().join("tests/gltf_compressed").join(name),
            folder.join(name),
        )
        .unwrap();
    }
    let (sums, record) = reference();
    put("reference/sums-32.exr", &sums);
    put("reference/reference.json", record.as_bytes());
    put("module.spv", &MODULE);
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
    file.data
        .iter_mut()
        .enumerate()
        .for_each(|(i, byte)| *byte = i as u8);
    let mut bytes = Vec::new();
    file.write(&mut bytes).unwrap();
    bytes
}

/// Size of the reference's pictures.
pub const REFERENCE: (u32, u32) = (4, 3);

/// The sums of a reference, and what names them.
fn reference() -> (Vec<u8>, String) {
    let size = (REFERENCE.0 as usize, REFERENCE.1 as usize);
    let mut layers = exr::prelude::SmallVec::new();
    for layer in PARTS
        .iter()
        .flat_map(|part| [format!("{part}.0"), format!("{part}.1")])
    {
        let values =
            |i: usize| FlatSamples::F32(vec![if i == 3 { 16.0 } else { i as f32 + 0.5 }; 12]);
        let list = [("R", 0), ("G", 1), ("B", 2), ("A", 3)]
            .map(|(name, i)| AnyChannel::new(name, values(i)));
        let channels = AnyChannels::sort(list.into_iter().collect());
        layers.push(Layer::new(
            size,
            LayerAttributes::named(layer.as_str()),
            Encoding::FAST_LOSSLESS,
            channels,
        ));
    }
    let mut out = Cursor::new(Vec::new());
    let window = exr::meta::header::ImageAttributes::with_size(size);
    Image::from_layers(window, layers)
        .write()
        .non_parallel()
        .to_buffered(&mut out)
        .unwrap();
    let bytes = out.into_inner();
    let sha256: String = Sha256::digest(&bytes)
        .iter()
        .map(|b| format!("{b:02x}"))
        .collect();
    let record = format!(
        "{{\"schema\":\"conelab-reference-2\",\"sums\":\"sums-32.exr\",\"sha256\":\"{sha256}\",\"samples\":32,\
         \"size\":[4,3],\"noise\":{{}},\"experiment\":\"e\",\"scene\":\"s\",\"params\":{{\"seed\":\"1\"}},\
         \"device\":\"d\",\"driver\":\"e\"}}"
    );
    (bytes, record)
}

/// A KTX2 file of 4x4 texels with one level (KTX 2.0, sections 3 and 4).
fn ktx2() -> Vec<u8> {
    let mut out = b"\xabKTX 20\xbb\r\n\x1a\n".to_vec();
    // R8G8B8A8, size, layers, faces, levels, no compression; index of the descriptor, no key and no global data; a level.
    let words = [
        37u32, 1, 4, 4, 0, 0, 1, 1, 0, 104, 4, 0, 0, 0, 0, 0, 0, 108, 0, 64, 0, 64, 0, 4,
    ];
    out.extend(words.iter().flat_map(|w| w.to_le_bytes()));
    out.resize(108 + 64, 128);
    out
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
    Spot(color: (5, 5, 5), position: (0, 2, 0), direction: (0, -1, 0), inner_deg: 20, outer_deg: 40, shadow: true), \
    Rectangle(color: (2, 2, 2), position: (1, 2, 0), direction: (0, -1, 0), up: (1, 0, 0), width: 1, height: 0.5, \
    shadow: true), Disc(color: (2, 2, 2), position: (1, 2, 0), direction: (0, -1, 0), radius: 0.5, shadow: false)], \
    sky: (0.2, 0.3, 0.4), cameras: {\"default\": (eye: (0.5, 1.8, 6), target: (0, 1, 0), fov_y: 50, near: 0.1, far: 50)})";

const CAPTURE: &str = r#"{"schema":"conelab-capture-1","version":"0.1.0","device":"d","driver":"e","when":"2026-01-01T00:00:00Z",
    "experiment":"small","graph":"graph.ron","scene":{"spec":"furnace","name":"furnace","sha256":"00"},"size":[8,8],
    "frames":1,"step":0.0,"images":[{"file":"picture.png","texture":"image","mip":0,"layer":0}],
    "files":{"picture.png":"00","experiment.ron":"00","graph/passes/graph.ron":"00","graph/shaders/fill.comp":"00"}}"#;

const GRAPH: &str = r#"(
    params: [
        Float(name: "level", default: 0.5, range: (0.0, 1.0), help: "Level."),
        Choice(name: "mode", options: ["plain", "odd"], help: "Mode."),
    ],
    textures: { "image": (size: ("width", "height"), format: "rgba8") },
    output: "image",
    passes: [(name: "fill", when: "mode == plain", shaders: ["fill.comp"], dispatch: Cover("image"))],
)"#;

const FILL: &str = "#version 460\n#extension GL_GOOGLE_include_directive : require\n#include \"params.glsl\"\n\
    layout(local_size_x = 8, local_size_y = 8) in;\nlayout(rgba8) uniform writeonly image2D image;\n\
    void main() { imageStore(image, ivec2(gl_GlobalInvocationID.xy), vec4(params.level)); }\n";

/// Parts of the graph of references.
const PARTS: [&str; 5] = ["diffuse", "direct", "occlusion", "specular", "total"];

/// A shader as the cache keeps it.
static MODULE: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let folders = Folders {
        passes: root().join("passes"),
        shaders: root().join("shaders"),
    };
    let graph = load(&folders.passes.join("preview.ron"), &folders).unwrap();
    let source = Source {
        file: "preview/preview.frag".into(),
        stage: Stage::Fragment,
    };
    let compiled = ShaderCompiler::new(&folders.shaders, None)
        .compile(&source, &generated(&graph, &graph.params));
    compiled
        .unwrap()
        .words
        .iter()
        .flat_map(|w| w.to_le_bytes())
        .collect()
});

/// A triangle with a texture of another format, a spot and a camera.
const LIT: &str = r#"{"asset":{"version":"2.0"},"extensionsUsed":["KHR_lights_punctual","EXT_lights_area","KHR_texture_basisu"],"scene":0,
    "scenes":[{"nodes":[0,1,2,3,4]}],"nodes":[{"mesh":0,"scale":[1,2,1]},{"camera":0,"translation":[0.2,0.3,4]},
    {"translation":[0,0,3],"extensions":{"KHR_lights_punctual":{"light":0}}},
    {"rotation":[0,0,0,1],"scale":[2,1,1],"extensions":{"EXT_lights_area":{"light":0}}},
    {"extensions":{"EXT_lights_area":{"light":1}}}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
    "materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,1,1],"metallicFactor":0.5,"roughnessFactor":0.5,
    "baseColorTexture":{"index":0}},"normalTexture":{"index":0,"scale":0.5},"emissiveFactor":[0.1,0.2,0.3],
    "alphaMode":"MASK","alphaCutoff":0.5,"extensions":{"KHR_materials_ior":{"ior":1.4}}}],
    "textures":[{"source":0,"extensions":{"KHR_texture_basisu":{"source":0}}}],"images":[{"uri":"t.ktx2"}],
    "cameras":[{"type":"perspective","perspective":{"yfov":0.8,"znear":0.1,"zfar":50.0}}],
    "accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3,"min":[0,0,0],"max":[1,1,0]}],
    "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,
    "uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
    "extensions":{"EXT_lights_area":{"lights":[{"type":"rect","size":1.5,"rect":{"aspect":2.0}},{"type":"disk",
    "color":[1,0.5,0.25],"intensity":20.0}]},"KHR_lights_punctual":{"lights":[{"type":"spot","color":[1,0.5,0.25],"intensity":20.0,
    "spot":{"innerConeAngle":0.3,"outerConeAngle":0.6}}]}}}"#;

const POINT: &str = r#"{"schema":"conelab-point-1","id":"0123456789abcdef0123456789abcdef","experiment":"(graph: \"g\")",
    "subject":{"scene":"s","sha256":"00","camera":"c","size":[8,8],"time":"0.0"},
    "device":{"name":"d","driver":"e","api":"1.3","kind":"cpu"},"outcome":{"failed":"no such scene"}}"#;

const POINTS: &str = r#"{"schema":"conelab-sweep-1","name":"cones","text":"","names":["cone_count"],
    "frames":{"warmup":1,"count":1},"points":[{"id":"0123456789abcdef0123456789abcdef","labels":{"cone_count":"5"}},
    {"id":"fedcba9876543210fedcba9876543210","labels":{"cone_count":"9"}}]}"#;
