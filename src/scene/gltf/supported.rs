//! Supported extensions, and messages about the others.

use serde_json::Value;

use crate::scene::warnings::Warnings;

/// Extensions that a file may require.
const READ: [&str; 19] = [
    "EXT_lights_area",
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    // The default materials of a file with variants are ordinary ones.
    "KHR_materials_variants",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_node_visibility",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    // Metadata without visual effect.
    "KHR_xmp_json_ld",
    "MSFT_texture_dds",
];

/// Optional compressions with the command that removes each; their uncompressed fallback is read.
const COMPRESSED: [(&str, &str); 1] = [(
    "KHR_draco_mesh_compression",
    "Convert it with glTF Transform: npx @gltf-transform/cli copy IN.glb OUT.glb",
)];

/// Maximum number of lines about unsupported extensions.
const LINES: usize = 20;

/// Fails on a required, unsupported extension and suggests a remedy.
pub(super) fn check_required(file: &Value) -> Result<(), String> {
    let missing: Vec<&str> = names(file, "extensionsRequired")
        .filter(|name| !READ.contains(name))
        .collect();
    let way = |name: &&str| {
        COMPRESSED
            .iter()
            .find(|(known, _)| known == name)
            .map(|(_, way)| *way)
    };
    let mut ways: Vec<&str> = missing.iter().filter_map(way).collect();
    ways.dedup();
    let left = missing.iter().any(|name| way(name).is_none());
    if left {
        ways.push("To open it without, remove the name from `extensionsRequired` in the file");
    }
    match missing.as_slice() {
        [] => Ok(()),
        list => Err(format!(
            "it requires {}, which is not read. {}",
            list.join(" and "),
            ways.join(". ")
        )),
    }
}

/// Warns about used, unsupported extensions. [`super::extensions`] handles those of materials.
pub(super) fn warn_of_used(file: &Value, warnings: &mut Warnings) {
    let quiet = |name: &&str| {
        READ.contains(name)
            || COMPRESSED.iter().any(|(known, _)| known == name)
            || name.starts_with("KHR_materials_")
    };
    let mut unread: Vec<&str> = names(file, "extensionsUsed")
        .filter(|name| !quiet(name))
        .collect();
    unread.sort_unstable();
    unread.dedup();
    for name in unread.iter().take(LINES) {
        warnings.add(format!("it uses {name}, which is left out"), "");
    }
    if let Some(more) = unread.len().checked_sub(LINES + 1) {
        warnings.add(
            format!("it uses {} more extensions, which are left out", more + 1),
            "",
        );
    }
    let variants = file
        .pointer("/extensions/KHR_materials_variants/variants")
        .and_then(Value::as_array);
    for variant in variants.into_iter().flatten() {
        let name = variant
            .get("name")
            .and_then(Value::as_str)
            .unwrap_or_default();
        warnings.add(
            "variants of materials are left out: the default materials are shown",
            name,
        );
    }
}

fn names<'a>(file: &'a Value, list: &str) -> impl Iterator<Item = &'a str> {
    file.get(list)
        .and_then(Value::as_array)
        .into_iter()
        .flatten()
        .filter_map(Value::as_str)
}
