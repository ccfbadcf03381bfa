//! The node hierarchy, flattened: instances, lights and cameras in the world.

use std::collections::HashMap;
use std::f32::consts::FRAC_PI_2;

use ::gltf::camera::Projection;
use ::gltf::khr_lights_punctual::Kind;
use ::gltf::{Document, Node};
use glam::{Mat4, Quat, Vec3};

use super::animation::Track;
use crate::scene::defaults::least_reach;
use crate::scene::{Animation, Camera, Instance, Keyframe, Light, LightKind, Scene};

/// A node to visit: what is above it.
struct Visit<'a> {
    node: Node<'a>,
    parent: Mat4,
    /// The nearest moving node above (or here) and what lies between it and this node's parent.
    moving: Option<Moving>,
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
    tracks: &HashMap<usize, Track>,
    warnings: &mut Vec<String>,
) -> Result<Scene, String> {
    let mut placed = Scene::default();
    let Some(root) = document.default_scene().or_else(|| document.scenes().next()) else {
        warnings.push("the file has no scene".into());
        return Ok(placed);
    };
    let mut seen = vec![false; document.nodes().count()];
    let mut stack: Vec<Visit> = root.nodes().map(|node| Visit { node, parent: Mat4::IDENTITY, moving: None }).collect();
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
                warnings.push(format!("node '{name}' moves inside a moving node; its own motion is left out"));
                Some(Moving { below: above.below * local, ..above })
            }
            (None, Some(above)) => Some(Moving { below: above.below * local, ..above }),
            (Some(track), None) => start_moving(node, visit.parent, track).or_else(|| {
                warnings.push(format!("node '{name}' moves inside an unevenly scaled node; it stays at rest"));
                None
            }),
            (None, None) => None,
        };
        if node.skin().is_some() {
            warnings.push(format!("node '{name}' has a skin, which stays in its bind pose"));
        }
        if let Some(mesh) = node.mesh() {
            let (transform, animation) = match &moving {
                Some(moving) => (moving.below, Some(moving.animation.clone())),
                None => (world, None),
            };
            let keys = animation.as_ref().map_or(&[][..], |a: &Animation| &a.keyframes);
            if !keys.iter().all(|k| k.translation.is_finite() && k.rotation.is_finite()) {
                return Err(format!("node '{name}' has a motion that is not finite. Export it again"));
            }
            keyframes += keys.len();
            if keyframes > MAX_KEYFRAMES {
                return Err(format!("its moving meshes have more than {MAX_KEYFRAMES} keyframes in all"));
            }
            placed.instances.push(Instance { name: name.clone(), mesh: mesh.index() as u32, transform, animation });
        }
        if let Some(light) = node.light() {
            match read_light(&light, &name, world) {
                Ok(light) => placed.lights.push(light),
                Err(why) => warnings.push(format!("light '{name}' {why}; it is left out")),
            }
        }
        if let Some(camera) = node.camera() {
            match read_camera(&camera.projection(), world) {
                Some(view) => {
                    placed.cameras.insert(camera.name().unwrap_or(&name).to_owned(), view);
                }
                None => warnings.push(format!("camera '{name}' is not a usable perspective; it is left out")),
            }
        }
        let children: Vec<Visit> =
            node.children().map(|node| Visit { node, parent: world, moving: moving.clone() }).collect();
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

fn read_light(light: &::gltf::khr_lights_punctual::Light, name: &str, world: Mat4) -> Result<Light, &'static str> {
    let color = Vec3::from_array(light.color()) * light.intensity();
    if !color.is_finite() || color.min_element() < 0.0 {
        return Err("has a colour or intensity that is negative or too large");
    }
    let kind = match light.kind() {
        Kind::Directional => LightKind::Directional,
        Kind::Point => LightKind::Point,
        Kind::Spot { inner_cone_angle, outer_cone_angle } => {
            let in_order = 0.0 <= inner_cone_angle && inner_cone_angle <= outer_cone_angle;
            if !in_order || outer_cone_angle > FRAC_PI_2 + 1e-6 {
                return Err("has cone angles that do not obey 0 <= inner <= outer <= 90 degrees");
            }
            LightKind::Spot { inner: inner_cone_angle, outer: outer_cone_angle.min(FRAC_PI_2) }
        }
    };
    Ok(Light {
        name: light.name().unwrap_or(name).to_owned(),
        kind,
        color,
        position: world.w_axis.truncate(),
        direction: world.transform_vector3(Vec3::NEG_Z).normalize_or(Vec3::NEG_Y),
        shadow: true,
    })
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
