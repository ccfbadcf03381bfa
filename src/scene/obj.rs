//! Wavefront OBJ with MTL, and the keys that other programs add for metallic-roughness materials.

mod faces;
mod geometry;
mod library;
mod lines;
mod maps;
mod material;
mod meshes;
mod smoothing;
mod triangulate;

use std::collections::HashMap;
use std::path::Path;

use glam::Mat4;
use indexmap::IndexSet;

use super::error::read_model;
use super::mesh::prepare_all;
use super::phong::{Finder, decide, grey};
use super::progress::Progress;
use super::texture::Requests;
use super::warnings::Warnings;
use super::{Instance, Material, Mesh, Scene, SceneError};
use geometry::Piece;
use library::Library;
use lines::decode;
pub(super) use lines::{shown, without_comment};
use material::{Pictures, Read, Surface, surface_of};

/// Files larger than this are refused.
const MAX_BYTES: u64 = 4 << 30;

fn shown_once((mesh, of): (u32, &Mesh)) -> Instance {
    Instance {
        name: of.name.clone(),
        mesh,
        transform: Mat4::IDENTITY,
        mover: None,
    }
}

/// Geometry, materials and textures of an OBJ file; no lights, cameras or sky.
pub(super) fn load(path: &Path, progress: Progress) -> Result<Scene, SceneError> {
    let fail = SceneError::model(path);
    progress.step("reading", 0.0)?;
    let bytes = read_model(path, MAX_BYTES)?;
    let mut warnings = Warnings::default();
    let geometry = geometry::read(&decode(bytes), &mut warnings, progress).map_err(&fail)?;

    progress.step("materials", 0.4)?;
    let mut finder = Finder::new(path.parent().unwrap_or(Path::new("")));
    let mut libraries = library::load(&geometry.libraries, &mut finder, &mut warnings, progress);
    let mut requests = Requests::default();
    let mut materials = read_materials(&mut libraries, &mut finder, &mut requests);
    progress.step("textures", 0.5)?;
    let (mut textures, texture_warnings) = requests.load(progress)?;
    let owners: Vec<usize> = materials.iter().map(|(library, _)| *library).collect();
    let asked = materials.iter_mut().map(|(_, read)| &mut read.asked);
    let warn = |number: usize, name: &str, what: &str| {
        let owner = owners.get(number);
        if let Some(library) = owner.and_then(|owner| libraries.get_mut(*owner)) {
            library.warnings.add(what, shown(name));
        }
    };
    decide(asked.collect(), &mut textures, &material::WORDS, warn);

    progress.step("meshes", 0.7)?;
    let surfaces = surfaces(&geometry.used, &libraries, &materials, &mut warnings);
    let materials = materials.into_iter();
    let mut materials: Vec<Material> = materials.map(|(_, read)| read.asked.material).collect();
    let material = |piece: &Piece| surface_of(&surfaces, piece.material).material as usize;
    if geometry
        .pieces
        .iter()
        .any(|piece| material(piece) == materials.len())
    {
        materials.push(grey(!geometry.colors.is_empty()));
    }
    let raw = meshes::build(&geometry, &surfaces, &mut warnings, progress).map_err(&fail)?;
    drop(geometry);
    let (meshes, dropped) = prepare_all(raw, &materials, progress).map_err(&fail)?;

    let file = path.display().to_string();
    let mut told = warnings.lines(&file);
    told.extend(dropped.warning(&file));
    let of_libraries = libraries.iter();
    told.extend(of_libraries.flat_map(|l| l.warnings.lines(l.path.display())));
    told.extend(texture_warnings);
    let meshes = meshes.into_iter();
    let meshes: Vec<Mesh> = meshes.filter(|mesh| !mesh.submeshes.is_empty()).collect();
    Ok(Scene {
        instances: (0..).zip(&meshes).map(shown_once).collect(),
        meshes,
        materials,
        textures,
        warnings: told,
        ..Scene::default()
    })
}

/// A material with the index of its library.
type Owned = (usize, Read);

/// The materials of all libraries, in order.
fn read_materials(
    libraries: &mut [Library],
    finder: &mut Finder,
    requests: &mut Requests,
) -> Vec<Owned> {
    let mut materials = Vec::new();
    for (number, library) in libraries.iter_mut().enumerate() {
        let mut pictures = Pictures { finder, requests };
        for definition in &library.materials {
            materials.push((
                number,
                material::read(definition, &mut pictures, &mut library.warnings),
            ));
        }
    }
    materials
}

/// The surface of each used name; the last one is for faces without a material.
fn surfaces(
    used: &IndexSet<String>,
    libraries: &[Library],
    materials: &[Owned],
    warnings: &mut Warnings,
) -> Vec<Surface> {
    let mut by_name: HashMap<&str, usize> = HashMap::new();
    let mut next = 0;
    for library in libraries {
        // Within a library the last definition of a name wins; among libraries, the first one.
        let mut own: HashMap<&str, usize> = HashMap::new();
        for (index, definition) in (next..).zip(&library.materials) {
            own.insert(&definition.name, index);
        }
        // Text after a name is a comment or a part of the name.
        for (index, definition) in (next..).zip(&library.materials) {
            own.entry(&definition.whole).or_insert(index);
        }
        next += library.materials.len();
        for (name, index) in own {
            by_name.entry(name).or_insert(index);
        }
    }
    let none = Surface {
        material: materials.len() as u32,
        ..Surface::default()
    };
    let of = |name: &String| {
        let found = by_name
            .get(name.as_str())
            .or_else(|| by_name.get(without_comment(name)));
        let Some((index, (_, read))) =
            found.and_then(|index| Some((*index, materials.get(*index)?)))
        else {
            warnings.add("materials that no library defines are grey", shown(name));
            return none;
        };
        Surface {
            material: index as u32,
            placement: read.placement,
            left_out: read.asked.material.is_left_out(),
        }
    };
    used.iter().map(of).chain([none]).collect()
}
