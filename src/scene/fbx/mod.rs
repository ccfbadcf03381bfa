//! FBX, binary or text, of all versions that ufbx reads: nodes with meshes, materials, lights and
//! cameras, and motion.
//!
//! Files declare their unit and axes; everything is converted to metres with y up. Light
//! intensities have no unit in FBX: a hundredth of the number is taken as W/m^2 or W/sr, for any
//! unit of length. Blender writes watts, so its lamps are divided by 4 pi, as in its glTF exporter.
//! `lights_scale` of a scene file scales them.

mod animation;
mod blends;
mod file;
mod lights;
mod materials;
mod meshes;
mod nodes;
mod numbers;
mod pictures;
mod skins;
mod unread;

use std::path::Path;

use super::error::read_model;
use super::mesh::prepare_rigged;
use super::motion::{Posing, Rig, Rigs, attach};
use super::phong::{Finder, decide, grey};
use super::progress::Progress;
use super::texture::Requests;
use super::warnings::Warnings;
use super::{Mesh, Scene, SceneError};
use animation::Motion;
use pictures::Pictures;

/// Files larger than this are refused.
const MAX_BYTES: u64 = 4 << 30;

/// Geometry, materials, textures, lights and cameras of an FBX file; no sky.
///
/// `clip` names the animation to play instead of the first.
pub(super) fn load(
    path: &Path,
    clip: Option<&str>,
    progress: Progress,
) -> Result<Scene, SceneError> {
    let fail = SceneError::model(path);
    progress.step("reading", 0.0)?;
    let bytes = read_model(path, MAX_BYTES)?;
    let length = bytes.len();
    let file = file::read(&bytes, progress).map_err(&fail)?;
    drop(bytes);
    let name = path.display().to_string();
    let mut warnings = Warnings::default();
    unread::warn(&file, &mut warnings);

    progress.step("materials", 0.3)?;
    let mut requests = Requests::default();
    let finder = Finder::new(path.parent().unwrap_or(Path::new("")));
    let mut pictures = Pictures::new(&name, finder, &mut requests);
    let mut materials = materials::read(&file, &mut pictures, &mut warnings);
    progress.step("nodes", 0.4)?;
    let motion = Motion::read(&file, length, clip, &mut warnings).map_err(&fail)?;
    let nodes::Placed {
        mut scene,
        wanted,
        frames,
        rigged,
    } = nodes::place(&file, &motion, &mut warnings).map_err(&fail)?;
    progress.step("textures", 0.5)?;
    let (mut textures, texture_warnings) = requests.load(progress)?;
    let asked = materials.iter_mut().map(|read| &mut read.asked).collect();
    decide(asked, &mut textures, &materials::WORDS, |_, name, what| {
        warnings.add(what, name)
    });

    progress.step("meshes", 0.7)?;
    let (raw, read_rigs, used) =
        meshes::read(&file, &wanted, &materials, length, &mut warnings, progress).map_err(&fail)?;
    let has_colors = raw.iter().any(|raw| raw.mesh.has_colors());
    let materials = materials.into_iter();
    scene.materials = materials.map(|read| read.asked.material).collect();
    if used {
        scene.materials.push(grey(has_colors));
    }
    let (prepared, dropped) = prepare_rigged(raw, &scene.materials, progress).map_err(&fail)?;
    let rigs = welded(prepared, &read_rigs, &mut scene.meshes);
    let posings = posings(rigged, &frames, &motion, &mut warnings).map_err(&fail)?;
    attach(&mut scene, posings, &rigs, meshes::MANY + length).map_err(&fail)?;
    scene.warnings = warnings.lines(&name);
    scene.warnings.extend(dropped.warning(&name));
    scene.warnings.extend(texture_warnings);
    scene.textures = textures;
    scene.instances.retain(|i| {
        scene
            .meshes
            .get(i.mesh as usize)
            .is_some_and(|mesh| !mesh.submeshes.is_empty())
    });
    Ok(scene)
}

/// Adds welded meshes, and returns their rigs.
fn welded(prepared: Vec<(Mesh, Vec<u32>)>, read: &Rigs, meshes: &mut Vec<Mesh>) -> Rigs {
    let mut rigs = Rigs::new();
    for (i, (mesh, sources)) in prepared.into_iter().enumerate() {
        if let Some(read) = read.get(&i) {
            let mut rig = Rig::default();
            rig.append(0, Some(read), &sources, false);
            rigs.insert(i, rig);
        }
        meshes.push(mesh);
    }
    rigs
}

/// The poses of instances that deform.
fn posings(
    rigged: Vec<(usize, &ufbx::Mesh)>,
    frames: &skins::Frames,
    motion: &Motion,
    warnings: &mut Warnings,
) -> Result<Vec<Posing>, String> {
    let mut posings = Vec::new();
    for (instance, mesh) in rigged {
        let joints = skins::of(mesh)
            .map(|skin| skins::joints(skin, frames, warnings))
            .unwrap_or_default();
        let weights = blends::weights(mesh, motion)
            .ok_or("a blend shape has weights that are not finite. Export it again")?;
        posings.push(Posing {
            instance,
            joints,
            weights,
            period: motion.period,
        });
    }
    Ok(posings)
}
