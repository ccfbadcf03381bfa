//! Shapes of a scene file: materials, textures, meshes with repeated parts, and their placement.

use std::f32::consts::TAU;

use glam::{Mat4, Vec3};
use indexmap::IndexMap;
use serde::Deserialize;

use super::format::{Moves, Placed, SceneFile};
use crate::scene::mesh::{Dropped, RawMesh, prepare_all};
use crate::scene::progress::Progress;
use crate::scene::shapes::*;
use crate::scene::{Instance, MAX_COORDINATE, Material, Mover, Scene};

/// Parts and positions visited for all meshes.
const MAX_PARTS: u32 = 1 << 18;
/// Solid work (cells times boxes) equivalent to one part; limits a file to about 2 s.
const SOLID_WORK: usize = 1 << 9;
/// Maximum nesting of groups and repetitions.
const MAX_DEPTH: u32 = 16;
/// Positions of one repetition, and of all instances.
const MAX_PLACES: u32 = 1 << 16;
/// Procedural textures per file.
const MAX_TEXTURES: usize = 64;

/// A part of a mesh.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) enum Part {
    Arch(Arch),
    Banner(Banner),
    Bars(Bars),
    Box(Cuboid),
    Capital(Capital),
    Chain(Chain),
    Crown(Crown),
    Curtain(Curtain),
    Cylinder(Cylinder),
    Hip(Hip),
    /// Only inside a solid.
    Hollow(Hollow),
    Lathe(Lathe),
    Level(Level),
    Moulding(Moulding),
    Quad(Quad),
    Ring(Ring),
    Rod(Rod),
    Slope(Slope),
    Specks(Specks),
    Sphere(Ball),
    Sprigs(Sprigs),
    Triangle(Triangle),
    Vase(Vase),
    Vault(Vault),
    /// Watertight union and difference of boxes, in order.
    Solid(Vec<Part>),
    /// The parts of a named group.
    Group(String),
    /// Restarts the random numbers for the parts that follow.
    Seed(u64),
    Repeat(Repeat),
}

/// Parts at several positions.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Repeat {
    #[serde(default)]
    at: Places,
    /// Rotation at each position: degrees about x, then y, then z; multiples of 90 about y are
    /// exact.
    #[serde(default)]
    rotate_deg: Option<Vec3>,
    #[serde(default)]
    quarters: Option<u8>,
    #[serde(default)]
    scale: Option<Vec3>,
    /// Increment per position of the index that selects materials and seeds.
    #[serde(default = "one")]
    counts: u32,
    parts: Vec<Part>,
}

fn one() -> u32 {
    1
}

/// Positions of a repetition.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) enum Places {
    At(Vec<Vec3>),
    /// Steps and their counts; the last axis varies fastest.
    Grid {
        from: Vec3,
        steps: Vec<(Vec3, u32)>,
    },
    /// Evenly from end to end.
    Line {
        from: Vec3,
        to: Vec3,
        count: u32,
    },
    /// Around y, with x pointing outwards.
    Circle {
        radius: f32,
        count: u32,
    },
}

impl Default for Places {
    fn default() -> Self {
        Places::At(vec![Vec3::ZERO])
    }
}

impl Places {
    /// Rotations about y [radians] and positions.
    fn list(&self) -> Result<Vec<(f32, Vec3)>, String> {
        let count = match self {
            Places::At(list) => list.len() as u64,
            Places::Grid { steps, .. } => {
                steps.iter().fold(1u64, |n, s| n.saturating_mul(s.1.into()))
            }
            Places::Line { count, .. } | Places::Circle { count, .. } => u64::from(*count),
        };
        if count > u64::from(MAX_PLACES) {
            return Err(format!(
                "a repetition has {count} places, and {MAX_PLACES} are the most"
            ));
        }
        let place = |i: u32| match self {
            Places::At(list) => (0.0, list[i as usize]),
            Places::Grid { from, steps } => {
                let mut left = i;
                let mut numbers = Vec::new();
                for (_, count) in steps.iter().rev() {
                    numbers.push((left % count) as f32);
                    left /= count;
                }
                (
                    0.0,
                    steps
                        .iter()
                        .zip(numbers.iter().rev())
                        .fold(*from, |p, (step, n)| p + step.0 * *n),
                )
            }
            Places::Line { from, to, count } => (
                0.0,
                *from + (*to - *from) * i as f32 / (count - 1).max(1) as f32,
            ),
            Places::Circle { radius, count } => {
                let turn = i as f32 / *count as f32 * TAU;
                (
                    turn,
                    Mat4::from_rotation_y(turn).transform_point3(Vec3::X * *radius),
                )
            }
        };
        Ok((0..count as u32).map(place).collect())
    }
}

/// Placements of a mesh that occurs more than once or moves.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct InstanceEntry {
    /// Cycled over the positions.
    meshes: Vec<String>,
    /// Replaces the mesh's name.
    #[serde(default)]
    name: Option<String>,
    #[serde(default)]
    transform: Placed,
    #[serde(default)]
    animation: Option<Moves>,
    /// Positions in the frame of the transform, each moved; several instances get numbered names.
    #[serde(default)]
    at: Option<Places>,
}

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
    entries.retain(|(_, name)| {
        !file
            .instances
            .iter()
            .any(|e| e.meshes.iter().any(|m| m == name))
    });
    scene
        .instances
        .extend(entries.into_iter().map(|(mesh, name)| Instance {
            name: name.into(),
            mesh,
            transform: Mat4::IDENTITY,
            mover: None,
        }));
    for entry in &file.instances {
        let near = entry.meshes.first().map_or("", String::as_str);
        let wrong = |message: String| Problem {
            near: near.into(),
            message,
        };
        let transform = entry.transform.0;
        let mover = entry.animation.clone().map(|moves| {
            scene.movers.push(Mover {
                parent: None,
                placed: Mat4::IDENTITY,
                track: moves.0,
            });
            scene.movers.len() as u32 - 1
        });
        let places = entry.at.clone().unwrap_or_default().list().map_err(wrong)?;
        if scene.instances.len() + places.len() * entry.meshes.len() > MAX_PLACES as usize {
            return Err(wrong(format!("more than {MAX_PLACES} instances")));
        }
        for (i, (turn, at)) in places.into_iter().enumerate() {
            for name in &entry.meshes {
                let no_mesh = || wrong(format!("no mesh '{name}' is in this file's meshes"));
                let mesh = file.meshes.get_index_of(name).ok_or_else(no_mesh)? as u32;
                let shown = entry.name.as_ref().unwrap_or(name);
                let name = if entry.at.is_some() {
                    format!("{shown} {}", i + 1)
                } else {
                    shown.clone()
                };
                let moved = if turn == 0.0 {
                    transform
                } else {
                    transform * Mat4::from_rotation_y(turn)
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
                (Part::Box(shape), _) => shape.build(mesh, at),
                (Part::Chain(shape), _) => shape.build(mesh, at),
                (Part::Crown(shape), _) => shape.build(mesh, at),
                (Part::Quad(shape), _) => shape.build(mesh, at),
                (Part::Ring(shape), _) => shape.build(mesh, at),
                (Part::Rod(shape), _) => shape.build(mesh, at),
                (Part::Specks(shape), _) => shape.build(mesh, at),
                (Part::Sphere(shape), _) => shape.build(mesh, at),
                (Part::Sprigs(shape), _) => shape.build(mesh, at),
                (Part::Triangle(shape), _) => shape.build(mesh, at),
                (around_origin, _) => {
                    mesh.place(frame * Mat4::from_translation(at));
                    match around_origin {
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
        let still =
            repeat.rotate_deg.is_none() && repeat.quarters.is_none() && repeat.scale.is_none();
        if solid.is_some() && !(still && places.iter().all(|(turn, _)| *turn == 0.0)) {
            return mesh.fail("", "parts of a solid cannot be rotated or scaled".into());
        }
        let [x, y, z] = repeat
            .rotate_deg
            .unwrap_or_default()
            .to_array()
            .map(f32::to_radians);
        let turned = Mat4::from_rotation_z(z) * Mat4::from_rotation_y(y) * Mat4::from_rotation_x(x);
        let (side, back) = [
            (Vec3::X, Vec3::Z),
            (-Vec3::Z, Vec3::X),
            (-Vec3::X, -Vec3::Z),
            (Vec3::Z, -Vec3::X),
        ][usize::from(repeat.quarters.unwrap_or_default() % 4)];
        let quarters = Mat4::from_cols(
            side.extend(0.0),
            Vec3::Y.extend(0.0),
            back.extend(0.0),
            glam::Vec4::W,
        );
        let own = turned * quarters * Mat4::from_scale(repeat.scale.unwrap_or(Vec3::ONE));
        let number = mesh.number;
        for (i, (turn, place)) in (0u32..).zip(places) {
            mesh.number = number.wrapping_add(i.wrapping_mul(repeat.counts));
            let inside = solid.as_deref_mut();
            if still && turn == 0.0 {
                self.parts(&repeat.parts, mesh, inside, frame, at + place, depth);
            } else {
                let moved = Mat4::from_translation(at + place) * Mat4::from_rotation_y(turn);
                self.parts(
                    &repeat.parts,
                    mesh,
                    inside,
                    frame * (moved * own),
                    Vec3::ZERO,
                    depth,
                );
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
