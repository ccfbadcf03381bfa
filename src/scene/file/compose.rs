//! Adding models to a scene: indices are shifted, everything is placed.

use glam::{Mat4, Vec3};

use super::ModelEntry;
use crate::scene::{Environment, Instance, Scene};

/// A model whose meshes, materials and textures a scene has: it can be placed many times.
pub(super) struct Added {
    /// Instances, lights and cameras, with the scene's numbers of meshes.
    pub model: Scene,
    /// Its extent before it is placed.
    pub bounds: (Vec3, Vec3),
}

impl Added {
    /// Radiance and picture of the model's own sky.
    pub fn sky(&self) -> (Vec3, Option<Environment>) {
        (self.model.sky, self.model.environment.clone())
    }
}

/// Moves what a model has of meshes, materials, textures and warnings into a scene.
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
        mesh.submeshes.iter_mut().for_each(|submesh| submesh.material += first_material);
        scene.meshes.push(mesh);
    }
    model.instances.iter_mut().for_each(|instance| instance.mesh += first_mesh);
    Added { model, bounds }
}

/// Adds instances, lights and cameras of a model, placed and moved as its entry says.
pub(super) fn add_placed(scene: &mut Scene, model: &Scene, entry: &ModelEntry) {
    let frame = entry.transform;
    for mut instance in model.instances.iter().cloned() {
        place(&mut instance, entry, &model.name, &mut scene.warnings);
        scene.instances.push(instance);
    }
    for mut light in model.lights.iter().filter(|_| entry.lights).cloned() {
        light.position = frame.transform_point3(light.position);
        light.direction = frame.transform_vector3(light.direction).normalize_or(light.direction);
        light.color *= entry.lights_scale.unwrap_or(1.0);
        scene.lights.push(light);
    }
    for (name, mut camera) in model.cameras.iter().filter(|_| entry.cameras).map(|(n, c)| (n.clone(), *c)) {
        camera.eye = frame.transform_point3(camera.eye);
        camera.target = frame.transform_point3(camera.target);
        camera.up = frame.transform_vector3(camera.up).normalize_or(camera.up);
        // The first of a name keeps it; later ones say which model they are of.
        let taken = scene.cameras.contains_key(&name);
        scene.cameras.insert(if taken { format!("{} {name}", model.name) } else { name }, camera);
    }
}

fn place(instance: &mut Instance, entry: &ModelEntry, model: &str, warnings: &mut Vec<String>) {
    let frame = entry.transform;
    let Some(own) = instance.animation.take() else {
        instance.transform = frame * instance.transform;
        instance.animation = entry.animation.clone();
        return;
    };
    let placed = if entry.animation.is_none() { own.seen_from(frame) } else { None };
    match placed {
        Some((animation, size)) => {
            instance.animation = Some(animation);
            instance.transform = Mat4::from_scale(glam::Vec3::splat(size)) * instance.transform;
        }
        None => {
            let why = "inside a moving or unevenly scaled model cannot be kept";
            warnings.push(format!("{model}: the motion of '{}' {why}; it stays at its first pose", instance.name));
            instance.transform = frame * own.at(0.0) * instance.transform;
            instance.animation = entry.animation.clone();
        }
    }
}
