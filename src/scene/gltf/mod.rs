//! glTF 2.0, text or binary: the node hierarchy with its meshes, lights and cameras, and rigid animation.
//!
//! Numbers of KHR_lights_punctual are taken as they are, lux as irradiance and candela as radiant intensity:
//! there is no division by 683 lm/W, as few exporters mean photometric units.

mod accessors;
mod animation;
mod buffers;
mod extensions;
mod materials;
mod means;
mod meshes;
mod nodes;
mod placing;

use std::path::Path;

use ::gltf::{Document, json};

use super::progress::Progress;
use super::{Scene, SceneError};

/// Geometry, materials, textures, lights and cameras of a glTF file; no sky.
pub(super) fn load(path: &Path, progress: Progress) -> Result<Scene, SceneError> {
    let fail = |message: String| SceneError::Model { path: path.into(), message };
    progress.step("reading", 0.0)?;
    let bytes = std::fs::read(path).map_err(|source| SceneError::Read {
        path: path.into(),
        hint: "Check the path and its permissions".into(),
        source,
    })?;
    let (document, blob) = parse(&bytes)
        .map_err(|error| fail(format!("{error}. Export it again as glTF 2.0 without compression extensions")))?;
    drop(bytes);
    check(document.as_json()).map_err(|problem| fail(format!("{problem}. Export it again")))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let buffers = buffers::load(&document, blob, folder).map_err(fail)?;

    progress.step("materials", 0.2)?;
    let mut warnings = Vec::new();
    let (materials, uv_sources, requests) = materials::read(&document, &buffers, folder, &mut warnings, progress)?;
    progress.step("meshes", 0.3)?;
    let (meshes, dropped) =
        meshes::read(&document, &buffers, &materials, &uv_sources, &mut warnings, progress).map_err(fail)?;
    progress.step("nodes", 0.6)?;
    let tracks = animation::tracks(&document, &buffers, &mut warnings).map_err(fail)?;
    let mut scene = nodes::place(&document, &tracks, &mut warnings).map_err(fail)?;
    // Warnings so far know only parts of the file; each must name the file itself.
    let name = path.display().to_string();
    scene.warnings = warnings.into_iter().map(|warning| format!("{name}: {warning}")).collect();
    scene.warnings.extend(dropped.warning(&name));
    progress.step("textures", 0.7)?;
    let (textures, texture_warnings) = requests.load(progress)?;
    scene.warnings.extend(texture_warnings);
    (scene.meshes, scene.materials, scene.textures) = (meshes, materials, textures);
    scene.instances.retain(|instance| !scene.meshes[instance.mesh as usize].submeshes.is_empty());
    Ok(scene)
}

/// The document, validated, and the binary chunk.
fn parse(bytes: &[u8]) -> Result<(Document, Option<Vec<u8>>), ::gltf::Error> {
    let ::gltf::Gltf { document, blob } = ::gltf::Gltf::from_slice_without_validation(bytes)?;
    let mut root = document.into_json();
    // The crate reads it, and does not count it among what it supports.
    root.extensions_required.retain(|name| name != "KHR_materials_specular");
    Ok((Document::from_json(root)?, blob))
}

/// What the gltf crate takes for granted after its own validation, and what a damaged file may still break.
fn check(root: &json::Root) -> Result<(), String> {
    let lights = root.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref()).map_or(&[][..], |l| &l.lights);
    for (i, light) in lights.iter().enumerate() {
        use json::extensions::scene::khr_lights_punctual::Type;
        if matches!(light.type_, json::validation::Checked::Valid(Type::Spot)) && light.spot.is_none() {
            return Err(format!("light {i} is a spot without cone angles"));
        }
    }
    for (i, node) in root.nodes.iter().enumerate() {
        let light = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
        if light.is_some_and(|light| light.light.value() >= lights.len()) {
            return Err(format!("node {i} has a light that does not exist"));
        }
    }
    for (i, camera) in root.cameras.iter().enumerate() {
        use json::camera::Type;
        let complete = match camera.type_ {
            json::validation::Checked::Valid(Type::Perspective) => camera.perspective.is_some(),
            json::validation::Checked::Valid(Type::Orthographic) => camera.orthographic.is_some(),
            json::validation::Checked::Invalid => false,
        };
        if !complete {
            return Err(format!("camera {i} lacks the numbers of its type"));
        }
    }
    for (i, animation) in root.animations.iter().enumerate() {
        if animation.channels.iter().any(|channel| channel.sampler.value() >= animation.samplers.len()) {
            return Err(format!("animation {i} has a channel whose sampler does not exist"));
        }
    }
    Ok(())
}
