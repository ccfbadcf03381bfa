//! glTF 2.0, text or binary: the node hierarchy with its meshes, lights and cameras, animation,
//! skins and morph targets.
//!
//! KHR_lights_punctual is read in radiometric units: lux as irradiance and candela as radiant
//! intensity. Values are not divided by 683 lm/W, because few exporters write photometric units.
//! Probably photometric intensities give a warning, and `lights_scale` of a scene file scales them.

mod accessors;
mod animation;
mod buffers;
mod container;
mod document;
mod extensions;
mod instancing;
mod lights;
mod materials;
mod means;
mod meshes;
mod meshopt;
mod nodes;
mod placing;
mod skins;
mod supported;

use std::path::Path;

use super::error::read_model;
use super::motion::attach;
use super::progress::Progress;
use super::{Scene, SceneError};
use buffers::Buffers;
use document::Checks;
pub(super) use lights::SCALE;

/// Geometry, materials, textures, lights and cameras of a glTF file; no sky.
///
/// `clip` names the animation that takes precedence over all others.
pub(super) fn load(
    path: &Path,
    clip: Option<&str>,
    progress: Progress,
) -> Result<Scene, SceneError> {
    let fail = SceneError::model(path);
    progress.step("reading", 0.0)?;
    let bytes = read_model(path, buffers::MAX_BYTES)?;
    let Checks {
        document,
        blob,
        unreadable,
        mut warnings,
    } = document::read(&bytes).map_err(&fail)?;
    drop(bytes);
    let folder = path.parent().unwrap_or(Path::new(""));
    let buffers = Buffers::load(&document, blob, unreadable, folder, progress);

    progress.step("materials", 0.2)?;
    let (materials, uv_sources, requests) =
        materials::read(&document, &buffers, folder, &mut warnings, progress)?;
    progress.step("meshes", 0.3)?;
    let read = meshes::read(
        &document,
        &buffers,
        &materials,
        &uv_sources,
        &mut warnings,
        progress,
    );
    let (meshes, rigs, dropped) = read.map_err(&fail)?;
    progress.step("nodes", 0.6)?;
    let tracks = animation::tracks(&document, &buffers, clip, &mut warnings).map_err(&fail)?;
    let placed = nodes::place(&document, &buffers, &tracks, &rigs, &mut warnings).map_err(&fail)?;
    let (mut scene, frames) = (placed.scene, placed.frames);
    scene.meshes = meshes;
    let mut posings = Vec::new();
    for (instance, node) in &placed.deforming {
        let Some(rig) = rigs.get(&(scene.instances[*instance].mesh as usize)) else {
            continue;
        };
        let (shown, motion) = ((*instance, node), (&tracks, &frames));
        let posing = skins::posing(shown, rig, motion, &buffers, &mut warnings);
        posings.push(posing.map_err(&fail)?);
    }
    attach(&mut scene, posings, &rigs, meshes::MANY + buffers.len()).map_err(&fail)?;
    lights::warn_of_units(&document, &scene.lights, &mut warnings);
    // The warnings name parts of the file; each must name the file itself.
    let name = path.display().to_string();
    scene.warnings = warnings.lines(&name);
    scene.warnings.extend(dropped.warning(&name));
    progress.step("textures", 0.7)?;
    let (textures, texture_warnings) = requests.load(progress)?;
    scene.warnings.extend(texture_warnings);
    (scene.materials, scene.textures) = (materials, textures);
    scene
        .instances
        .retain(|instance| !scene.meshes[instance.mesh as usize].submeshes.is_empty());
    Ok(scene)
}
