//! Variables that expressions may read besides parameters.

use super::view::{directional_view_count, shadow_view_count};
use crate::graph::expr::{Env, Var};
use crate::scene::{Scene, origin_of};
use crate::vulkan::DeviceInfo;

/// Variables of expressions that come from scene, size and device.
pub fn environment(scene: &Scene, size: (u32, u32), device: &DeviceInfo) -> Env {
    let (low, high) = scene.bounds();
    let (origin, extent) = (origin_of((low, high)), high - low);
    let (low, high) = (low - origin, high - origin);
    let lights = scene.all_lights();
    let mut env = Env::new();
    let mut put = |name: &str, value: f64| {
        env.insert(name.to_string(), Var::Number(value));
    };
    put("width", f64::from(size.0));
    put("height", f64::from(size.1));
    put("shadow_views", f64::from(shadow_view_count(&lights)));
    put(
        "directional_views",
        f64::from(directional_view_count(&lights)),
    );
    put("light_count", lights.len() as f64);
    put("triangle_count", scene.triangle_count() as f64);
    put(
        "emitting_triangle_count",
        scene.emitting_triangle_count() as f64,
    );
    put("scene_size", f64::from(extent.max_element()));
    put("seen_distance", f64::from(scene.seen_distance));
    put(
        "int64_atomics",
        f64::from(u8::from(device.features.int64_atomics)),
    );
    put("software_device", f64::from(u8::from(device.kind == "cpu")));
    for (axis, (a, b)) in ["x", "y", "z"]
        .iter()
        .zip(low.to_array().into_iter().zip(high.to_array()))
    {
        put(&format!("scene_min_{axis}"), f64::from(a));
        put(&format!("scene_max_{axis}"), f64::from(b));
    }
    env
}
