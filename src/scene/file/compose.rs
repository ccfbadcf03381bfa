//! Adding models to a scene: indices are shifted and everything is placed.

use glam::{Mat4, Vec3};

use super::format::ModelEntry;
use crate::scene::{Environment, Instance, Mover, Scene};

/// Maximum number of moving frames in a scene; each placement of a model has its own.
const MAX_MOVERS: usize = 1 << 20;

/// A model with its meshes, materials and textures moved to the scene. It can be placed many times.
pub(super) struct Added {
    /// Instances, lights and cameras, with mesh indices of the scene.
    pub model: Scene,
    /// Its bounds before placement.
    pub bounds: (Vec3, Vec3),
}

impl Added {
    /// Radiance and environment map of the model's sky.
    pub fn sky(&self) -> (Vec3, Option<Environment>) {
        (self.model.sky, self.model.environment.clone())
    }
}

/// Moves meshes, materials, textures and warnings of a model into a scene.
pub(super) fn add(scene: &mut Scene, mut model: Scene) -> Added {
    let bounds = model.bounds();
    let first_mesh = scene.meshes.len() as u32;
    let first_material = scene.materials.len() as u32;
    let first_texture = scene.textures.len() as u32;
    scene.textures.append(&mut model.textures);
    scene.warnings.append(&mut model.warnings);
    for mut material in std::mem::take(&mut model.materials) {
        for texture in [
            &mut material.base_color_texture,
            &mut material.metallic_roughness_texture,
            &mut material.normal_texture,
            &mut material.emission_texture,
        ] {
            *texture = texture.map(|index| index + first_texture);
        }
        scene.materials.push(material);
    }
    for mut mesh in std::mem::take(&mut model.meshes) {
        mesh.submeshes
            .iter_mut()
            .for_each(|submesh| submesh.material += first_material);
        scene.meshes.push(mesh);
    }
    model
        .instances
        .iter_mut()
        .for_each(|instance| instance.mesh += first_mesh);
    let mut deformers = std::mem::take(&mut model.deformers);
    if !deformers.is_empty() {
        // Skins follow frames in the model's space, independent of its placement.
        let first = add_movers(scene, &model.movers, None, Mat4::IDENTITY);
        for deformer in &mut deformers {
            deformer.mesh += first_mesh;
            deformer
                .joints
                .iter_mut()
                .for_each(|joint| joint.mover = joint.mover.map(|m| m + first));
        }
        scene.deformers.append(&mut deformers);
    }
    Added { model, bounds }
}

/// Adds instances, lights and cameras of a model with the placement and motion of its entry.
pub(super) fn add_placed(scene: &mut Scene, model: &Scene, entry: &ModelEntry) {
    let frame = entry.transform;
    let track = entry.motion.clone();
    let own = track.map(|track| scene.add_mover(None, Mat4::IDENTITY, track));
    let moves = model.instances.iter().any(|i| i.mover.is_some());
    let fits = scene.movers.len() + model.movers.len() <= MAX_MOVERS;
    if moves && !fits {
        scene.warnings.push(format!(
            "{}: it stands still, because there are more than {MAX_MOVERS} moving nodes",
            model.name
        ));
    }
    let first = (moves && fits).then(|| add_movers(scene, &model.movers, own, frame));
    scene
        .instances
        .extend(model.instances.iter().enumerate().map(|(i, instance)| {
            let placed = |transform| Instance {
                transform,
                mover: own,
                ..instance.clone()
            };
            match (instance.mover, first) {
                (Some(mover), Some(first)) => Instance {
                    mover: Some(mover + first),
                    ..instance.clone()
                },
                (Some(_), None) => placed(frame * model.instance_transform(i, 0.0)),
                (None, _) => placed(frame * instance.transform),
            }
        }));
    for mut light in model.lights.iter().filter(|_| entry.lights).cloned() {
        light.transform(&frame);
        if !light.has_sound_extents() {
            let (model, name) = (&model.name, &light.name);
            let text =
                format!("{model}: light '{name}' is left out: its size is too small or large");
            scene.warnings.push(text);
            continue;
        }
        light.color *= entry.lights_scale.unwrap_or(1.0);
        scene.lights.push(light);
    }
    for (name, camera) in model.cameras.iter().filter(|_| entry.cameras) {
        let mut camera = *camera;
        camera.eye = frame.transform_point3(camera.eye);
        camera.target = frame.transform_point3(camera.target);
        camera.up = frame.transform_vector3(camera.up).normalize_or(camera.up);
        // The first camera keeps its name; later ones get the model's name as a prefix.
        let name = match scene.cameras.contains_key(name) {
            true => format!("{} {name}", model.name),
            false => name.clone(),
        };
        scene.cameras.insert(name, camera);
    }
}

/// Adds a model's movers and returns the index of the first. Root movers get the parent `parent`
/// and the placement `frame`.
fn add_movers(scene: &mut Scene, movers: &[Mover], parent: Option<u32>, frame: Mat4) -> u32 {
    let first = scene.movers.len() as u32;
    scene
        .movers
        .extend(movers.iter().map(|mover| match mover.parent {
            Some(above) => Mover {
                parent: Some(above + first),
                ..mover.clone()
            },
            None => Mover {
                parent,
                placed: frame * mover.placed,
                track: mover.track.clone(),
            },
        }));
    first
}
