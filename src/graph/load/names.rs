//! Names that graphs give and names that they have already.

/// Variables that every expression may use beside parameters.
pub const BUILTIN_VARIABLES: &[&str] = &[
    "width",
    "height",
    "mip",
    "index",
    "shadow_views",
    "directional_views",
    "light_count",
    "triangle_count",
    "emitting_triangle_count",
    "scene_size",
    "seen_distance",
    "int64_atomics",
    "software_device",
    "scene_min_x",
    "scene_min_y",
    "scene_min_z",
    "scene_max_x",
    "scene_max_y",
    "scene_max_z",
];

/// Names that GLSL and expressions can use.
pub(super) fn is_identifier(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_lowercase())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        && !name.contains("__")
}
