//! Shapes of a scene file: materials, textures, meshes with repeated parts, and their placement.

use glam::{Mat4, Vec3};
use indexmap::IndexMap;

use super::format::SceneFile;
use super::parts::{MAX_PLACES, Part, Repeat};
use crate::scene::mesh::{Dropped, RawMesh, prepare_all};
use crate::scene::progress::Progress;
use crate::scene::shapes::*;
use crate::scene::{Instance, MAX_COORDINATE, Material, Scene};

/// Parts and positions visited for all meshes.
const MAX_PARTS: u32 = 1 << 18;
/// Solid work (cells times boxes) equivalent to one part; limits a file to about 2 s.
const SOLID_WORK: usize = 1 << 9;
/// Maximum nesting of groups and repetitions.
const MAX_DEPTH: u32 = 16;
/// Procedural textures per file.
const MAX_TEXTURES: usize = 64;

/// Builds the materials, textures, meshes and instances that a scene file defines itself.
pub(super) fn build(file: &SceneFile, progress: Progress) -> Result<Scene, Problem> {
    let wrong = |near: &str, message: String| Problem {
        near: near.into(),
        message,
    };
    let mut scene = Scene::default();
    for (name, material) in &file.materials {
        check_material(material, file.textures.len())
            .map_err(|m| wrong(name, format!("material '{name}': {m}")))?;
        scene.materials.push(Material {
            name: name.clone(),
            ..material.clone()
        });
    }
    if file.textures.len() > MAX_TEXTURES {
        return Err(wrong("", format!("more than {MAX_TEXTURES} textures")));
    }
    scene.textures = file.textures.iter().map(patterns::Picture::draw).collect();
    let mut raw = Vec::new();
    let mut room = MAX_VERTICES;
    let mut walk = Walk {
        groups: &file.groups,
        left: MAX_PARTS,
        progress,
    };
    for (name, parts) in &file.meshes {
        let mut mesh = MeshBuilder::new(name, &file.materials, room);
        walk.parts(parts, &mut mesh, None, Mat4::IDENTITY, Vec3::ZERO, 0);
        let mesh = mesh.finish().map_err(|p| match p.near.is_empty() {
            true => wrong(name, format!("mesh '{name}': {}", p.message)),
            false => p,
        })?;
        room -= mesh.vertices.len() as u64;
        raw.push(RawMesh {
            mesh,
            sources: Vec::new(),
            has_normals: true,
            has_tangents: false,
        });
    }
    let dropped;
    (scene.meshes, dropped) =
        prepare_all(raw, &scene.materials, progress).map_err(|m| wrong("", m))?;
    // Surfaces of revolution have degenerate triangles at the poles.
    scene.warnings.extend(
        Dropped {
            no_area: 0,
            ..dropped
        }
        .warning("meshes of shapes"),
    );
    place_all(file, &mut scene)?;
    Ok(scene)
}

fn place_all(file: &SceneFile, scene: &mut Scene) -> Result<(), Problem> {
    // Meshes without a placement are instantiated once, as built.
    let mut entries: Vec<(u32, &str)> = (0..).zip(file.meshes.keys().map(String::as_str)).collect();
    let placed = file.instances.iter().flat_map(|e| &e.meshes);
    entries.retain(|(_, name)| !placed.clone().any(|m| m == name));
    let as_built = |(mesh, name): (u32, &str)| Instance {
        name: name.into(),
        mesh,
        transform: Mat4::IDENTITY,
        mover: None,
    };
    scene.instances.extend(entries.into_iter().map(as_built));
    for entry in &file.instances {
        let near = entry.meshes.first().map_or("", String::as_str);
        let wrong = |message: String| Problem {
            near: near.into(),
            message,
        };
        let transform = entry.transform.0;
        let moves = entry.animation.clone();
        let mover = moves.map(|moves| scene.add_mover(None, Mat4::IDENTITY, moves.0));
        let places = entry.at.clone().unwrap_or_default().list().map_err(wrong)?;
        if scene.instances.len() + places.len() * entry.meshes.len() > MAX_PLACES as usize {
            return Err(wrong(format!("more than {MAX_PLACES} instances")));
        }
        for (i, (turn, at)) in places.into_iter().enumerate() {
            for name in &entry.meshes {
                let no_mesh = || wrong(format!("no mesh '{name}' is in this file's meshes"));
                let mesh = file.meshes.get_index_of(name).ok_or_else(no_mesh)? as u32;
                let shown = entry.name.as_ref().unwrap_or(name);
                let name = match entry.at {
                    Some(_) => format!("{shown} {}", i + 1),
                    None => shown.clone(),
                };
                let moved = match turn == 0.0 {
                    true => transform,
                    false => transform * Mat4::from_rotation_y(turn),
                };
                let transform = Mat4 {
                    w_axis: (transform.transform_point3(at)).extend(1.0),
                    ..moved
                };
                scene.instances.push(Instance {
                    name,
                    mesh,
                    transform,
                    mover,
                });
            }
        }
    }
    Ok(())
}

/// Traverses parts, groups and repetitions.
struct Walk<'a> {
    groups: &'a IndexMap<String, Vec<Part>>,
    left: u32,
    progress: Progress<'a>,
}

impl Walk<'_> {
    /// Adds parts under a transform; boxes inside a solid are added to it.
    fn parts(
        &mut self,
        parts: &[Part],
        mesh: &mut MeshBuilder,
        mut solid: Option<&mut Solid>,
        frame: Mat4,
        at: Vec3,
        depth: u32,
    ) {
        for part in parts {
            self.left = self.left.saturating_sub(1);
            if self.left == 0 || depth > MAX_DEPTH || self.progress.stopped() {
                let limits = format!(
                    "more than {MAX_PARTS} parts (a solid counts by its cells), or groups inside of {MAX_DEPTH} others"
                );
                mesh.fail("", limits);
            }
            if mesh.problem.is_some() {
                return;
            }
            mesh.place(frame);
            match (part, solid.as_deref_mut()) {
                (Part::Group(name), inside) => match self.groups.get(name) {
                    Some(group) => self.parts(group, mesh, inside, frame, at, depth + 1),
                    None => mesh.fail(name, format!("no group '{name}' is in this file's groups")),
                },
                (Part::Repeat(repeat), inside) => {
                    self.repeat(repeat, mesh, inside, frame, at, depth + 1)
                }
                (Part::Box(shape), Some(solid)) => {
                    solid.fill(shape.low + at, shape.high + at, mesh.paint(&shape.material))
                }
                (Part::Hollow(shape), Some(solid)) => shape.carve(solid, mesh, at),
                (_, Some(_)) => mesh.fail("", "a solid is of boxes and hollows alone".into()),
                (Part::Hollow(_), None) => {
                    mesh.fail("", "a hollow is a part of a solid alone".into())
                }
                (Part::Solid(parts), None) => {
                    let mut solid = Solid::default();
                    self.parts(parts, mesh, Some(&mut solid), frame, at, depth + 1);
                    self.left = self
                        .left
                        .saturating_sub((solid.build(mesh) / SOLID_WORK) as u32);
                }
                (Part::Seed(seed), _) => mesh.random = Random(*seed),
                (shape, _) => add_shape(shape, mesh, frame, at),
            }
        }
    }

    fn repeat(
        &mut self,
        repeat: &Repeat,
        mesh: &mut MeshBuilder,
        mut solid: Option<&mut Solid>,
        frame: Mat4,
        at: Vec3,
        depth: u32,
    ) {
        let places = repeat.at.list().unwrap_or_else(|message| {
            mesh.fail("", message);
            Vec::new()
        });
        self.left = self.left.saturating_sub(places.len() as u32);
        let own = repeat.transform();
        if solid.is_some() && (own.is_some() || places.iter().any(|(turn, _)| *turn != 0.0)) {
            return mesh.fail("", "parts of a solid cannot be rotated or scaled".into());
        }
        let number = mesh.number;
        for (i, (turn, place)) in (0u32..).zip(places) {
            mesh.number = number.wrapping_add(i.wrapping_mul(repeat.counts));
            let inside = solid.as_deref_mut();
            if own.is_none() && turn == 0.0 {
                self.parts(&repeat.parts, mesh, inside, frame, at + place, depth);
            } else {
                let moved = Mat4::from_translation(at + place) * Mat4::from_rotation_y(turn);
                let frame = frame * (moved * own.unwrap_or(Mat4::IDENTITY));
                self.parts(&repeat.parts, mesh, inside, frame, Vec3::ZERO, depth);
            }
        }
        mesh.number = number;
    }
}

fn check_material(material: &Material, textures: usize) -> Result<(), String> {
    let colors = [
        material.base_color.truncate(),
        material.specular_color,
        material.emission,
    ];
    let shares = [
        material.metallic,
        material.roughness,
        material.specular,
        material.alpha_cutoff,
        material.base_color.w,
    ];
    let share = |v: &f32| (0.0..=1.0).contains(v);
    if !shares.iter().all(share) || !colors[0].to_array().iter().all(share) {
        return Err(
            "base_color, metallic, roughness, specular and alpha_cutoff are from 0 to 1".into(),
        );
    }
    if !colors
        .iter()
        .all(|c| c.min_element() >= 0.0 && c.max_element() <= 1e12)
        || !(0.0..=1e6).contains(&material.ior)
    {
        return Err("colours, emission and ior must be finite and 0 or more".into());
    }
    if material.normal_scale.abs() > MAX_COORDINATE || !material.normal_scale.is_finite() {
        return Err("normal_scale must be finite".into());
    }
    let maps = [
        material.base_color_texture,
        material.metallic_roughness_texture,
        material.normal_texture,
        material.emission_texture,
    ];
    match maps.into_iter().flatten().find(|i| *i as usize >= textures) {
        Some(i) => Err(format!(
            "texture {i} of {textures} does not exist (the first is 0)"
        )),
        None => Ok(()),
    }
}

/// Adds a shape at a position under a transform.
fn add_shape(part: &Part, mesh: &mut MeshBuilder, frame: Mat4, at: Vec3) {
    match part {
        Part::Box(shape) => return shape.build(mesh, at),
        Part::Chain(shape) => return shape.build(mesh, at),
        Part::Crown(shape) => return shape.build(mesh, at),
        Part::Quad(shape) => return shape.build(mesh, at),
        Part::Ring(shape) => return shape.build(mesh, at),
        Part::Rod(shape) => return shape.build(mesh, at),
        Part::Specks(shape) => return shape.build(mesh, at),
        Part::Sphere(shape) => return shape.build(mesh, at),
        Part::Sprigs(shape) => return shape.build(mesh, at),
        Part::Triangle(shape) => return shape.build(mesh, at),
        _ => {}
    }
    // The other shapes are built around the origin.
    mesh.place(frame * Mat4::from_translation(at));
    match part {
        Part::Arch(shape) => shape.build(mesh),
        Part::Banner(shape) => shape.build(mesh),
        Part::Bars(shape) => shape.build(mesh),
        Part::Capital(shape) => shape.build(mesh),
        Part::Curtain(shape) => shape.build(mesh),
        Part::Cylinder(shape) => shape.build(mesh),
        Part::Hip(shape) => shape.build(mesh),
        Part::Lathe(shape) => shape.build(mesh),
        Part::Level(shape) => shape.build(mesh),
        Part::Moulding(shape) => shape.build(mesh),
        Part::Slope(shape) => shape.build(mesh),
        Part::Vase(shape) => shape.build(mesh),
        Part::Vault(shape) => shape.build(mesh),
        _ => {}
    }
}
