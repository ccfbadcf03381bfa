//! The node hierarchy, flattened: instances, lights and cameras in the world.

use std::collections::HashMap;

use ::gltf::camera::Projection;
use ::gltf::{Document, Node};
use glam::{Mat4, Quat, Vec3};

use super::animation::Track;
use super::buffers::Buffers;
use super::instancing::{self, MAX_INSTANCES};
use super::lights;
use crate::scene::defaults::least_reach;
use crate::scene::warnings::Warnings;
use crate::scene::{Animation, Camera, Instance, Keyframe, Scene};

/// A node to visit: what is above it.
struct Visit<'a> {
    node: Node<'a>,
    parent: Mat4,
    /// The nearest moving node above (or here) and what lies between it and this node's parent.
    moving: Option<Moving>,
    visible: bool,
}

#[derive(Clone)]
struct Moving {
    animation: Animation,
    below: Mat4,
}

/// Keyframes of all instances: each below a moving node has a copy.
const MAX_KEYFRAMES: usize = 1 << 22;

/// Instances, lights and cameras of the default scene (of the first, where none is the default).
pub(super) fn place(
    document: &Document,
    buffers: &Buffers,
    tracks: &HashMap<usize, Track>,
    warnings: &mut Warnings,
) -> Result<Scene, String> {
    let mut placed = Scene::default();
    let Some(root) = document.default_scene().or_else(|| document.scenes().next()) else {
        warnings.add("the file has no scene", "");
        return Ok(placed);
    };
    let mut seen = vec![false; document.nodes().count()];
    let top = |node| Visit { node, parent: Mat4::IDENTITY, moving: None, visible: true };
    let mut stack: Vec<Visit> = root.nodes().map(top).collect();
    stack.reverse();
    let mut keyframes = 0;
    while let Some(visit) = stack.pop() {
        let node = &visit.node;
        if std::mem::replace(&mut seen[node.index()], true) {
            return Err(format!("node {} is its own ancestor or has two parents. Export it again", node.index()));
        }
        let name = node.name().map_or_else(|| format!("node {}", node.index()), str::to_owned);
        let local = Mat4::from_cols_array_2d(&node.transform().matrix());
        if !local.is_finite() {
            return Err(format!("node '{name}' has a transform that is not finite. Export it again"));
        }
        let world = visit.parent * local;
        let moving = match (tracks.get(&node.index()), visit.moving) {
            (Some(_), Some(above)) => {
                warnings.add("motion inside of moving nodes is left out", &name);
                Some(Moving { below: above.below * local, ..above })
            }
            (None, Some(above)) => Some(Moving { below: above.below * local, ..above }),
            (Some(track), None) => start_moving(node, visit.parent, track).or_else(|| {
                warnings.add("nodes that move inside of unevenly scaled ones stay at rest", &name);
                None
            }),
            (None, None) => None,
        };
        if node.skin().is_some() {
            warnings.add("skins stay in their bind pose", &name);
        }
        let visible = visit.visible && is_visible(node);
        if !visible && (node.mesh().is_some() || node.light().is_some()) {
            warnings.add("invisible nodes (KHR_node_visibility) are left out", &name);
        }
        if let Some(mesh) = node.mesh().filter(|_| visible) {
            let (transform, animation) = match &moving {
                Some(moving) => (moving.below, Some(moving.animation.clone())),
                None => (world, None),
            };
            let keys = animation.as_ref().map_or(&[][..], |a: &Animation| &a.keyframes);
            if !keys.iter().all(|k| k.translation.is_finite() && k.rotation.is_finite()) {
                return Err(format!("node '{name}' has a motion that is not finite. Export it again"));
            }
            let places = instancing::places(node, document, buffers).map_err(|why| format!("node '{name}': {why}"))?;
            let copies = places.as_ref().map_or(1, Vec::len);
            keyframes += keys.len().saturating_mul(copies);
            if keyframes > MAX_KEYFRAMES || placed.instances.len() + copies > MAX_INSTANCES {
                let most = format!("{MAX_INSTANCES} instances, or its moving ones more than {MAX_KEYFRAMES} keyframes");
                return Err(format!("it has more than {most}"));
            }
            let mesh = mesh.index() as u32;
            match places {
                None => placed.instances.push(Instance { name: name.clone(), mesh, transform, animation }),
                Some(places) => placed.instances.extend((1..).zip(places).map(|(i, place)| Instance {
                    name: format!("{name} {i}"),
                    mesh,
                    transform: transform * place,
                    animation: animation.clone(),
                })),
            }
        }
        if let Some(light) = node.light().filter(|_| visible) {
            match lights::read(&light, &name, world, warnings) {
                Ok(light) => placed.lights.push(light),
                Err(why) => warnings.add(format!("lights that have {why} are left out"), &name),
            }
        }
        if let Some(camera) = node.camera() {
            match read_camera(&camera.projection(), world) {
                Some(view) => {
                    placed.cameras.insert(camera.name().unwrap_or(&name).to_owned(), view);
                }
                None => warnings.add("cameras that are no usable perspective are left out", &name),
            }
        }
        let children: Vec<Visit> =
            node.children().map(|node| Visit { node, parent: world, moving: moving.clone(), visible }).collect();
        stack.extend(children.into_iter().rev());
    }
    Ok(placed)
}

/// The rigid motion of a node in the world; none below an uneven scale.
fn start_moving(node: &Node, parent: Mat4, track: &Track) -> Option<Moving> {
    let (translation, rotation, scale) = node.transform().decomposed();
    let rest = (Vec3::from_array(translation), Quat::from_array(rotation));
    let pose = |time: f32| {
        let (translation, rotation) = track.at(time, rest);
        Keyframe { time, translation, rotation }
    };
    let own = Animation { keyframes: track.times().into_iter().map(pose).collect(), repeat: true };
    let (animation, size) = own.seen_from(parent)?;
    Some(Moving { animation, below: Mat4::from_scale(Vec3::from_array(scale) * size) })
}

/// KHR_node_visibility.
fn is_visible(node: &Node) -> bool {
    let extension = node.extension_value("KHR_node_visibility");
    extension.and_then(|e| e.get("visible")).and_then(serde_json::Value::as_bool).unwrap_or(true)
}

fn read_camera(projection: &Projection, world: Mat4) -> Option<Camera> {
    let Projection::Perspective(lens) = projection else {
        return None;
    };
    let eye = world.w_axis.truncate();
    let fov_y = lens.yfov().to_degrees();
    let (near, far) = (lens.znear(), lens.zfar().unwrap_or(f32::INFINITY));
    let usable = fov_y > 0.0 && fov_y < 180.0 && near > 0.0 && near.is_finite() && far > near;
    usable.then(|| Camera {
        eye,
        target: eye + world.transform_vector3(Vec3::NEG_Z).normalize_or(Vec3::NEG_Z) * least_reach(eye).max(1.0),
        up: world.transform_vector3(Vec3::Y).normalize_or(Vec3::Y),
        fov_y,
        near,
        far,
    })
}
