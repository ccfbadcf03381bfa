//! The node hierarchy, flattened: instances, lights and cameras in the world.

use glam::{DAffine3, DVec3};
use indexmap::IndexSet;
use ufbx::{Camera as From, ElementType, Mesh, Node, ProjectionMode, find_prop};

use super::animation::Motion;
use super::meshes::Wanted;
use super::numbers::{affine, frame, placement};
use super::skins::{self, Frames};
use super::{blends, lights};
use crate::scene::defaults::least_reach;
use crate::scene::obj::shown;
use crate::scene::warnings::Warnings;
use crate::scene::{Camera, Instance, Scene};

/// A node to visit with its parent's frame.
struct Visit<'a> {
    node: &'a Node,
    /// The moving frame of its parent.
    mover: Option<u32>,
    /// Transform of its parent in that frame.
    above: DAffine3,
    visible: bool,
}

/// The content of the hierarchy.
pub(super) struct Placed<'a> {
    /// Instances, lights and cameras.
    pub scene: Scene,
    /// The meshes of the instances.
    pub wanted: Vec<Wanted>,
    pub frames: Frames,
    /// Instances of meshes with a skin or blend shapes.
    pub rigged: Vec<(usize, &'a Mesh)>,
}

/// Instances, lights and cameras, and the meshes of the instances.
pub(super) fn place<'a>(
    file: &'a ufbx::Scene,
    motion: &Motion,
    warnings: &mut Warnings,
) -> Result<Placed<'a>, String> {
    let (mut placed, mut frames, mut rigged) = (Scene::default(), Frames::new(), Vec::new());
    let mut wanted = IndexSet::new();
    let mut stack = vec![Visit {
        node: file.root_node.as_ref(),
        mover: None,
        above: DAffine3::IDENTITY,
        visible: true,
    }];
    while let Some(visit) = stack.pop() {
        let (node, mut mover, above) = (visit.node, visit.mover, visit.above);
        let visible = is_visible(node, visit.visible);
        let name = name(node);
        if !visible && (node.mesh.is_some() || node.light.is_some()) {
            warnings.add("invisible nodes are left out", &name);
        }
        let mut local = above * frame(&node.local_transform);
        if let Some(track) = motion.of(node) {
            mover = Some(placed.add_mover(mover, placement(&above), track));
            local = DAffine3::IDENTITY;
        }
        frames.insert(node.element.typed_id, (mover, placement(&local)));
        let here = local * affine(&node.geometry_to_node);
        if let Some(mesh) = node.mesh.as_ref().filter(|_| visible) {
            let wanted = (&mut wanted, &mut rigged);
            add_instance(&mut placed, wanted, node, mesh, &name, (mover, here))?;
        }
        let frame = (mover, here);
        add_light_and_camera(&mut placed, file, node, frame, &name, visible, warnings);
        let mut children = node.children.as_ref();
        // The children of a LOD group are alternatives; the first is the finest.
        if node.attrib_type == ElementType::LodGroup && children.len() > 1 {
            warnings.add("of levels of detail the first is shown", &name);
            children = children.get(..1).unwrap_or_default();
        }
        let below = |child: &'a ufbx::Ref<Node>| Visit {
            node: child.as_ref(),
            mover,
            above: local,
            visible,
        };
        stack.extend(children.iter().rev().map(below));
    }
    // The author's active camera comes first.
    let active = file.settings.default_camera.as_ref();
    if let Some(own) = placed.cameras.get_index_of(active) {
        placed.cameras.move_index(own, 0);
    }
    Ok(Placed {
        scene: placed,
        wanted: wanted.into_iter().collect(),
        frames,
        rigged,
    })
}

fn add_instance<'a>(
    placed: &mut Scene,
    (wanted, rigged): (&mut IndexSet<Wanted>, &mut Vec<(usize, &'a Mesh)>),
    node: &Node,
    mesh: &'a Mesh,
    name: &str,
    frame: (Option<u32>, DAffine3),
) -> Result<(), String> {
    let materials = node.materials.into_iter();
    let (number, _) = wanted.insert_full(Wanted {
        mesh: mesh.element.typed_id,
        materials: materials.map(|m| m.element.typed_id).collect(),
    });
    if skins::of(mesh).is_some() || blends::any(mesh) {
        rigged.push((placed.instances.len(), mesh));
    }
    let instance = instance(node, number as u32, name, frame)?;
    placed.instances.push(instance);
    Ok(())
}

/// Adds the light and the camera of a node.
fn add_light_and_camera(
    scene: &mut Scene,
    file: &ufbx::Scene,
    node: &Node,
    (mover, here): (Option<u32>, DAffine3),
    name: &str,
    visible: bool,
    warnings: &mut Warnings,
) {
    // Lights and cameras keep their transform at time 0.
    let moves = mover.is_some() && (node.light.is_some() || node.camera.is_some());
    let start = match moves {
        true => DAffine3::from_mat4(scene.moved(mover, placement(&here), 0.0).as_dmat4()),
        false => here,
    };
    if let Some(light) = node
        .light
        .as_ref()
        .filter(|light| visible && light.cast_light)
    {
        match lights::read(light, file.metadata.exporter, name, &start, warnings) {
            Ok(light) => scene.lights.push(light),
            Err(why) => warnings.add(format!("lights that have {why} are left out"), name),
        }
    }
    if let Some(from) = node.camera.as_ref() {
        match camera(from, &start, file.settings.original_unit_meters) {
            Some(view) => {
                scene.cameras.insert(name.to_owned(), view);
            }
            None => warnings.add("cameras that are no usable perspective are left out", name),
        }
    }
    if moves {
        warnings.add(
            "lights and cameras of moving nodes stay where they are at 0 s",
            name,
        );
    }
}

fn instance(
    node: &Node,
    mesh: u32,
    name: &str,
    (mover, here): (Option<u32>, DAffine3),
) -> Result<Instance, String> {
    // Bones place the vertices of a skin in the world.
    let is_skinned = node
        .mesh
        .as_ref()
        .is_some_and(|mesh| skins::of(mesh).is_some() || !mesh.skinned_is_local);
    let (mover, here) = if is_skinned {
        (None, DAffine3::IDENTITY)
    } else {
        (mover, here)
    };
    let transform = placement(&here);
    if !transform.is_finite() {
        return Err(format!(
            "node '{name}' has a transform that is not finite. Export it again"
        ));
    }
    Ok(Instance {
        name: name.to_owned(),
        mesh,
        transform,
        mover,
    })
}

/// Its name; helper nodes of ufbx have their parent's name.
fn name(node: &Node) -> String {
    let own = match &node.parent {
        Some(parent) if node.is_scale_helper || node.is_geometry_transform_helper => {
            &parent.element.name
        }
        _ => &node.element.name,
    };
    if own.is_empty() {
        format!("node {}", node.element.typed_id)
    } else {
        shown(own)
    }
}

fn is_visible(node: &Node, above: bool) -> bool {
    let inherits = find_prop(&node.element.props, "Visibility Inheritance")
        .is_none_or(|prop| prop.value_int != 0);
    node.visible && (above || !inherits)
}

/// FBX cameras look along +x.
fn camera(from: &From, world: &DAffine3, unit: f64) -> Option<Camera> {
    if from.projection_mode != ProjectionMode::Perspective {
        return None;
    }
    let eye = world.translation.as_vec3();
    let axis = |own: DVec3| world.transform_vector3(own).normalize_or(own).as_vec3();
    let (ahead, up) = (axis(DVec3::X), axis(DVec3::Y));
    let fov_y = from.field_of_view_deg.y as f32;
    let unit = if unit > 0.0 { unit } else { 1.0 };
    let (near, far) = (
        (from.near_plane * unit) as f32,
        (from.far_plane * unit) as f32,
    );
    let usable = eye.is_finite()
        && fov_y > 0.0
        && fov_y < 180.0
        && near > 0.0
        && near.is_finite()
        && far > near;
    let target = eye + ahead * least_reach(eye).max(1.0);
    usable.then_some(Camera {
        eye,
        target,
        up,
        fov_y,
        near,
        far,
    })
}
