//! The interface of a scene to every graph: named resources and variables of expressions, each
//! stated once, here. [`SceneGpu`](super::SceneGpu) fills them in; `shaders/common/scene.glsl`
//! declares the structs.

pub(super) mod blocks;

use super::view::{area_light_count, directional_view_count, shadow_view_count};
use crate::diagnostics::Diagnostic;
use crate::graph::Graph;
use crate::graph::expr::{Env, Var};
use crate::graph::interface::{External, ExternalKind, SceneInterface};
use crate::graph::load::Folders;
use crate::scene::{Light, Scene, origin_of};
use crate::vulkan::DeviceInfo;
use blocks::{
    CameraBlock, DrawBlock, EmitterBlock, InstanceBlock, LightBlock, MaterialBlock, SceneInfoBlock,
    ShadowBlock,
};
use glam::Vec3;
use std::mem::offset_of;
use std::path::Path;
use std::sync::LazyLock;

/// Names of the arrays that material textures are spread over.
pub(super) const MATERIAL_TEXTURES: [&str; 12] = [
    "materialTexture0",
    "materialTexture1",
    "materialTexture2",
    "materialTexture3",
    "materialTexture4",
    "materialTexture5",
    "materialTexture6",
    "materialTexture7",
    "materialTexture8",
    "materialTexture9",
    "materialTexture10",
    "materialTexture11",
];

static SCENE: LazyLock<SceneInterface> = LazyLock::new(|| {
    let storage = |name| External::new(name, ExternalKind::Storage);
    let on_request = |name| External {
        on_request: true,
        ..storage(name)
    };
    let moving = |external| External {
        moves: true,
        ..external
    };
    let textures = |name| External::new(name, ExternalKind::TextureArray);
    let mut resources = vec![
        External {
            counters: offset_of!(CameraBlock, frame)..offset_of!(CameraBlock, delta_time),
            ..External::uniform("camera", CameraBlock::layout())
        },
        External::uniform("sceneInfo", SceneInfoBlock::layout()),
        External::list("lights", LightBlock::layout()),
        External::list("shadowViews", ShadowBlock::layout()),
        External::list("materials", MaterialBlock::layout()),
        storage("dielectrics"),
        moving(External::list("instances", InstanceBlock::layout())),
        External::list("draws", DrawBlock::layout()),
        moving(storage("positions")),
        moving(storage("attributes")),
        storage("indices"),
        storage("triangles"),
        External::list("emitters", EmitterBlock::layout()),
        on_request("bvhNodes"),
        on_request("bvhTriangles"),
        on_request("skyTexels"),
        textures("skyTexture"),
    ];
    resources.extend(MATERIAL_TEXTURES.map(textures));
    SceneInterface::new(resources, VARIABLES.iter().map(|v| v.0).collect())
});

/// What variables follow from. Bounds are relative to the origin of the shaders' world [m].
struct Facts<'a> {
    scene: &'a Scene,
    device: &'a DeviceInfo,
    size: (u32, u32),
    lights: Vec<Light>,
    low: Vec3,
    high: Vec3,
    extent: Vec3,
}

/// A variable: its name and its value.
type Variable = (&'static str, fn(&Facts<'_>) -> f64);

const VARIABLES: &[Variable] = &[
    ("width", |f| f.size.0.into()),
    ("height", |f| f.size.1.into()),
    ("shadow_views", |f| shadow_view_count(&f.lights).into()),
    ("directional_views", |f| {
        directional_view_count(&f.lights).into()
    }),
    ("light_count", |f| f.lights.len() as f64),
    ("area_lights", |f| area_light_count(&f.lights).into()),
    ("triangle_count", |f| f.scene.triangle_count() as f64),
    ("moving_instances", |f| {
        let moving = f.scene.instances.iter().filter(|i| i.mover.is_some());
        moving.count() as f64
    }),
    ("moving_triangles", |f| {
        f.scene.moving_triangle_count() as f64
    }),
    ("emitting_triangle_count", |f| {
        f.scene.emitting_triangle_count() as f64
    }),
    ("scene_size", |f| f.extent.max_element().into()),
    ("seen_distance", |f| f.scene.seen_distance.into()),
    ("int64_atomics", |f| {
        u8::from(f.device.features.int64_atomics).into()
    }),
    ("software_device", |f| {
        u8::from(f.device.kind == "cpu").into()
    }),
    ("scene_min_x", |f| f.low.x.into()),
    ("scene_min_y", |f| f.low.y.into()),
    ("scene_min_z", |f| f.low.z.into()),
    ("scene_max_x", |f| f.high.x.into()),
    ("scene_max_y", |f| f.high.y.into()),
    ("scene_max_z", |f| f.high.z.into()),
];

/// Variables of expressions that follow from scene, picture size and device.
pub fn environment(scene: &Scene, size: (u32, u32), device: &DeviceInfo) -> Env {
    let (low, high) = scene.bounds();
    let origin = origin_of((low, high));
    let lights = scene.all_lights();
    let extent = high - low;
    let (low, high) = (low - origin, high - origin);
    let facts = Facts {
        scene,
        device,
        size,
        lights,
        low,
        high,
        extent,
    };
    let value = |(name, of): &Variable| (name.to_string(), Var::Number(of(&facts)));
    let fastest = super::fastest::variables(device);
    VARIABLES.iter().map(value).chain(fastest).collect()
}

/// Reads a graph and its includes, for scenes.
///
/// # Errors
/// All mistakes of all files.
pub fn load(path: &Path, folders: &Folders) -> Result<Graph, Vec<Diagnostic>> {
    crate::graph::load::load(path, folders, &SCENE)
}
