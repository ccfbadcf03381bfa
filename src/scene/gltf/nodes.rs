//! The node hierarchy, flattened: instances, lights and cameras in the world.

use std::collections::HashMap;
use std::sync::Arc;

use ::gltf::camera::Projection;
use ::gltf::{Document, Node};
use glam::{Mat4, Vec3};

use super::animation::Tracks;
use super::buffers::Buffers;
use super::instancing::{self, MAX_INSTANCES};
use super::lights;
use crate::scene::defaults::least_reach;
use crate::scene::motion::Rigs;
use crate::scene::warnings::Warnings;
use crate::scene::{Camera, Instance, Scene, Track};

/// A node to visit with its parent's frame.
struct Visit<'a> {
    node: Node<'a>,
    /// The moving frame of its parent.
    mover: Option<u32>,
    /// Transform of its parent in that frame.
    above: Mat4,
    visible: bool,
}

/// Maximum depth of nested moving nodes; the cost of an instance's pose is proportional to it.
const MAX_DEPTH: usize = 256;

/// Moving frame and transform of each node by number.
pub(super) type Frames = HashMap<usize, (Option<u32>, Mat4)>;

/// The content of the hierarchy, without meshes.
#[derive(Default)]
pub(super) struct Placed<'a> {
    pub scene: Scene,
    pub frames: Frames,
    /// Nesting depth of each mover, including itself.
    depths: Vec<usize>,
    /// Instances of nodes with a skin or morph targets.
    pub deforming: Vec<(usize, Node<'a>)>,
}

impl Placed<'_> {
    /// Adds a moving node and returns the index of its mover.
    fn add_mover(
        &mut self,
        parent: Option<u32>,
        placed: Mat4,
        track: Arc<Track>,
        name: &str,
    ) -> Result<u32, String> {
        let depth = parent
            .and_then(|m| self.depths.get(m as usize))
            .map_or(1, |depth| depth + 1);
        if depth > MAX_DEPTH {
            return Err(format!(
                "node '{name}' moves in more than {MAX_DEPTH} moving nodes"
            ));
        }
        self.depths.push(depth);
        Ok(self.scene.add_mover(parent, placed, track))
    }
}

/// Instances, lights and cameras of the default scene, or of the first one.
pub(super) fn place<'a>(
    document: &'a Document,
    buffers: &Buffers,
    tracks: &Tracks,
    rigs: &Rigs,
    warnings: &mut Warnings,
) -> Result<Placed<'a>, String> {
    let mut placed = Placed::default();
    let root = document.default_scene();
    let Some(root) = root.or_else(|| document.scenes().next()) else {
        warnings.add("the file has no scene", "");
        return Ok(placed);
    };
    let mut seen = vec![false; document.nodes().count()];
    let top = |node| Visit {
        node,
        mover: None,
        above: Mat4::IDENTITY,
        visible: true,
    };
    let mut stack: Vec<Visit> = root.nodes().map(top).collect();
    stack.reverse();
    while let Some(visit) = stack.pop() {
        let (node, mut mover, above) = (visit.node, visit.mover, visit.above);
        if std::mem::replace(&mut seen[node.index()], true) {
            let what = "is its own ancestor or has two parents. Export it again";
            return Err(format!("node {} {what}", node.index()));
        }
        let own = || format!("node {}", node.index());
        let name = node.name().map_or_else(own, str::to_owned);
        let mut local = above * Mat4::from_cols_array_2d(&node.transform().matrix());
        if !local.is_finite() {
            let what = "has a transform that is not finite. Export it again";
            return Err(format!("node '{name}' {what}"));
        }
        if let Some(track) = tracks.of(&node) {
            mover = Some(placed.add_mover(mover, above, track, &name)?);
            local = Mat4::IDENTITY;
        }
        placed.frames.insert(node.index(), (mover, local));
        let visible = visit.visible && is_visible(&node);
        let frame = (mover, local);
        if !visible && (node.mesh().is_some() || lights::has_one(&node)) {
            warnings.add("invisible nodes (KHR_node_visibility) are left out", &name);
        }
        if visible {
            add_instances(&mut placed, &node, frame, &name, rigs, (document, buffers))?;
        }
        add_light_and_camera(
            &mut placed.scene,
            document,
            &node,
            frame,
            &name,
            visible,
            warnings,
        );
        let below = |node| Visit {
            node,
            mover,
            above: local,
            visible,
        };
        let children: Vec<Visit> = node.children().map(below).collect();
        stack.extend(children.into_iter().rev());
    }
    Ok(placed)
}

/// Adds the light and the camera of a node.
fn add_light_and_camera(
    scene: &mut Scene,
    document: &Document,
    node: &Node,
    (mover, local): (Option<u32>, Mat4),
    name: &str,
    visible: bool,
    warnings: &mut Warnings,
) {
    // Lights and cameras keep their transform at time 0.
    let moves = mover.is_some() && (lights::has_one(node) || node.camera().is_some());
    if moves {
        warnings.add(
            "lights and cameras of moving nodes stay where they are at 0 s",
            name,
        );
    }
    let start = if moves {
        scene.moved(mover, local, 0.0)
    } else {
        local
    };
    match lights::of_node(node, document, name, start, warnings).filter(|_| visible) {
        Some(Ok(light)) => scene.lights.push(light),
        Some(Err(why)) => warnings.add(format!("lights that have {why} are left out"), name),
        None => {}
    }
    if let Some(camera) = node.camera() {
        match read_camera(&camera.projection(), start) {
            Some(view) => {
                scene
                    .cameras
                    .insert(camera.name().unwrap_or(name).to_owned(), view);
            }
            None => warnings.add("cameras that are no usable perspective are left out", name),
        }
    }
}

/// Instances of a node's mesh, in a moving frame or in the world.
fn add_instances<'a>(
    placed: &mut Placed<'a>,
    node: &Node<'a>,
    (mut mover, mut transform): (Option<u32>, Mat4),
    name: &str,
    rigs: &Rigs,
    (document, buffers): (&Document, &Buffers),
) -> Result<(), String> {
    let Some(mesh) = node.mesh() else {
        return Ok(());
    };
    let places = instancing::places(node, document, buffers)
        .map_err(|why| format!("node '{name}': {why}"))?;
    let instances = &mut placed.scene.instances;
    if instances.len() + places.as_ref().map_or(1, Vec::len) > MAX_INSTANCES {
        return Err(format!("it has more than {MAX_INSTANCES} instances"));
    }
    let first = instances.len();
    // glTF 2.0, 3.7.3.3: skinned meshes are placed by their joints alone.
    if node.skin().is_some() && rigs.contains_key(&mesh.index()) {
        (mover, transform) = (None, Mat4::IDENTITY);
    }
    let mesh = mesh.index() as u32;
    let instance = |name, transform| Instance {
        name,
        mesh,
        transform,
        mover,
    };
    match places {
        None => instances.push(instance(name.into(), transform)),
        Some(places) => instances.extend(
            (1..)
                .zip(places)
                .map(|(i, place)| instance(format!("{name} {i}"), transform * place)),
        ),
    }
    if rigs.contains_key(&(mesh as usize)) {
        placed
            .deforming
            .extend((first..placed.scene.instances.len()).map(|i| (i, node.clone())));
    }
    Ok(())
}

/// KHR_node_visibility.
fn is_visible(node: &Node) -> bool {
    let extension = node.extension_value("KHR_node_visibility");
    extension
        .and_then(|e| e.get("visible"))
        .and_then(serde_json::Value::as_bool)
        .unwrap_or(true)
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
        target: eye
            + world
                .transform_vector3(Vec3::NEG_Z)
                .normalize_or(Vec3::NEG_Z)
                * least_reach(eye).max(1.0),
        up: world.transform_vector3(Vec3::Y).normalize_or(Vec3::Y),
        fov_y,
        near,
        far,
    })
}
