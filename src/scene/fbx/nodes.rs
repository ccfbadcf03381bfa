//! The node hierarchy, flattened: instances, lights and cameras in the world.

use glam::{DAffine3, DVec3};
use indexmap::IndexSet;
use ufbx::{Camera as From, ElementType, Node, ProjectionMode, find_prop};

use super::animation::Motion;
use super::lights;
use super::meshes::Wanted;
use super::numbers::{affine, placement};
use crate::scene::defaults::least_reach;
use crate::scene::obj::shown;
use crate::scene::warnings::Warnings;
use crate::scene::{Camera, Instance, Scene};

/// Instances, lights and cameras, and the meshes that instances name.
pub(super) fn place(
    file: &ufbx::Scene,
    motion: &mut Motion,
    warnings: &mut Warnings,
) -> Result<(Scene, Vec<Wanted>), String> {
    let mut placed = Scene::default();
    let mut wanted = IndexSet::new();
    let mut stack: Vec<(&Node, bool)> = vec![(file.root_node.as_ref(), true)];
    while let Some((node, above)) = stack.pop() {
        let visible = is_visible(node, above);
        let name = name(node);
        if !visible && (node.mesh.is_some() || node.light.is_some()) {
            warnings.add("invisible nodes are left out", &name);
        }
        let first = motion.first(node);
        if let Some(mesh) = node.mesh.as_ref().filter(|_| visible) {
            let materials = node.materials.into_iter().map(|material| material.element.typed_id).collect();
            let (mesh, _) = wanted.insert_full(Wanted { mesh: mesh.element.typed_id, materials });
            placed.instances.push(instance(node, mesh as u32, &name, motion, warnings)?);
        }
        if let Some(light) = node.light.as_ref().filter(|light| visible && light.cast_light) {
            let world = first * affine(&node.geometry_to_node);
            match lights::read(light, file.metadata.exporter, &name, &world, warnings) {
                Ok(light) => placed.lights.push(light),
                Err(why) => warnings.add(format!("lights that have {why} are left out"), &name),
            }
        }
        if let Some(from) = node.camera.as_ref() {
            match camera(from, &(first * affine(&node.geometry_to_node)), file.settings.original_unit_meters) {
                Some(view) => {
                    placed.cameras.insert(name.clone(), view);
                }
                None => warnings.add("cameras that are no usable perspective are left out", &name),
            }
        }
        if (node.light.is_some() || node.camera.is_some()) && motion.moves(node) {
            warnings.add("lights and cameras that move stay where they begin", &name);
        }
        let children = node.children.as_ref();
        // Levels of detail show the same thing; the first is the finest.
        let children = if node.attrib_type == ElementType::LodGroup && children.len() > 1 {
            warnings.add("of levels of detail the first is shown", &name);
            children.get(..1).unwrap_or_default()
        } else {
            children
        };
        stack.extend(children.iter().rev().map(|child| (child.as_ref(), visible)));
    }
    // The camera through which the author looked comes first.
    if let Some(own) = placed.cameras.get_index_of(file.settings.default_camera.as_ref()) {
        placed.cameras.move_index(own, 0);
    }
    Ok((placed, wanted.into_iter().collect()))
}

fn instance(
    node: &Node,
    mesh: u32,
    name: &str,
    motion: &mut Motion,
    warnings: &mut Warnings,
) -> Result<Instance, String> {
    let is_skinned = node.mesh.as_ref().is_some_and(|mesh| !mesh.skinned_is_local);
    let (transform, animation) = match is_skinned {
        // Bones place its vertices in the world.
        true => (DAffine3::IDENTITY, None),
        false => {
            let (frame, animation) = motion.of(node, name, warnings)?;
            (frame * affine(&node.geometry_to_node), animation)
        }
    };
    let transform = placement(&transform);
    if !transform.is_finite() {
        return Err(format!("node '{name}' has a transform that is not finite. Export it again"));
    }
    Ok(Instance { name: name.to_owned(), mesh, transform, animation })
}

/// Its own name; helpers of ufbx have that of their parent.
fn name(node: &Node) -> String {
    let own = match &node.parent {
        Some(parent) if node.is_scale_helper || node.is_geometry_transform_helper => &parent.element.name,
        _ => &node.element.name,
    };
    if own.is_empty() { format!("node {}", node.element.typed_id) } else { shown(own) }
}

fn is_visible(node: &Node, above: bool) -> bool {
    let inherits = find_prop(&node.element.props, "Visibility Inheritance").is_none_or(|prop| prop.value_int != 0);
    node.visible && (above || !inherits)
}

/// Cameras look along x.
fn camera(from: &From, world: &DAffine3, unit: f64) -> Option<Camera> {
    if from.projection_mode != ProjectionMode::Perspective {
        return None;
    }
    let eye = world.translation.as_vec3();
    let axis = |own: DVec3| world.transform_vector3(own).normalize_or(own).as_vec3();
    let (ahead, up) = (axis(DVec3::X), axis(DVec3::Y));
    let fov_y = from.field_of_view_deg.y as f32;
    let unit = if unit > 0.0 { unit } else { 1.0 };
    let (near, far) = ((from.near_plane * unit) as f32, (from.far_plane * unit) as f32);
    let usable = eye.is_finite() && fov_y > 0.0 && fov_y < 180.0 && near > 0.0 && near.is_finite() && far > near;
    let target = eye + ahead * least_reach(eye).max(1.0);
    usable.then_some(Camera { eye, target, up, fov_y, near, far })
}
