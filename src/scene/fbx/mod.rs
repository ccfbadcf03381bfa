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

use crate::files::read_input;

use super::mesh::prepare_rigged;
use super::motion::{Posing, Rig, Rigs, attach};
use super::phong::{Finder, decide, grey};
use super::progress::Progress;
use super::texture::Requests;
use super::warnings::Warnings;
use super::{Scene, SceneError};
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
    let fail = |message: String| SceneError::Model {
        path: path.into(),
        message,
    };
    progress.step("reading", 0.0)?;
    let bytes = read_input(path, MAX_BYTES).map_err(|source| SceneError::Read {
        path: path.into(),
        hint: "Check the path and its permissions".into(),
        source,
    })?;
    let length = bytes.len();
    let file = file::read(&bytes, progress).map_err(fail)?;
    drop(bytes);
    let name = path.display().to_string();
    let mut warnings = Warnings::default();
    unread::warn(&file, &mut warnings);

    progress.step("materials", 0.3)?;
    let mut requests = Requests::default();
    let mut pictures = Pictures::new(
        &name,
        Finder::new(path.parent().unwrap_or(Path::new(""))),
        &mut requests,
    );
    let mut materials = materials::read(&file, &mut pictures, &mut warnings);
    progress.step("nodes", 0.4)?;
    let motion = Motion::read(&file, length, clip, &mut warnings).map_err(fail)?;
    let placed = nodes::place(&file, &motion, &mut warnings).map_err(fail)?;
    let nodes::Placed {
        mut scene,
        wanted,
        frames,
        rigged,
    } = placed;
    progress.step("textures", 0.5)?;
    let (mut textures, texture_warnings) = requests.load(progress)?;
    let asked = materials.iter_mut().map(|read| &mut read.asked).collect();
    decide(asked, &mut textures, &materials::WORDS, |_, name, what| {
        warnings.add(what, name)
    });

    progress.step("meshes", 0.7)?;
    let (raw, read_rigs, used) =
        meshes::read(&file, &wanted, &materials, length, &mut warnings, progress).map_err(fail)?;
    let has_colors = raw.iter().any(|raw| raw.mesh.has_colors());
    scene.materials = materials
        .into_iter()
        .map(|read| read.asked.material)
        .collect();
    if used {
        scene.materials.push(grey(has_colors));
    }
    let (prepared, dropped) = prepare_rigged(raw, &scene.materials, progress).map_err(fail)?;
    let mut rigs = Rigs::new();
    for (i, (mesh, sources)) in prepared.into_iter().enumerate() {
        if let Some(read) = read_rigs.get(&i) {
            let mut rig = Rig::default();
            rig.append(0, Some(read), &sources, false);
            rigs.insert(i, rig);
        }
        scene.meshes.push(mesh);
    }
    let mut posings = Vec::new();
    for (instance, mesh) in rigged {
        let joints = skins::of(mesh)
            .map(|skin| skins::joints(skin, &frames, &mut warnings))
            .unwrap_or_default();
        let weights = blends::weights(mesh, &motion).ok_or_else(|| {
            fail("a blend shape has weights that are not finite. Export it again".into())
        })?;
        posings.push(Posing {
            instance,
            joints,
            weights,
            period: motion.period,
        });
    }
    attach(&mut scene, posings, &rigs, meshes::MANY + length).map_err(fail)?;
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
