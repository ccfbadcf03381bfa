//! Adding a model to a scene: indices are shifted, everything is placed.

use glam::Mat4;

use super::ModelEntry;
use crate::scene::{Instance, Scene};

/// Adds a model, placed and moved as its entry says.
pub(super) fn add(scene: &mut Scene, model: Scene, entry: &ModelEntry) {
    let first_mesh = scene.meshes.len() as u32;
    let first_material = scene.materials.len() as u32;
    let first_texture = scene.textures.len() as u32;
    let frame = entry.transform;
    scene.textures.extend(model.textures);
    scene.warnings.extend(model.warnings);
    for mut material in model.materials {
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
    for mut mesh in model.meshes {
        mesh.submeshes.iter_mut().for_each(|submesh| submesh.material += first_material);
        scene.meshes.push(mesh);
    }
    for mut instance in model.instances {
        instance.mesh += first_mesh;
        place(&mut instance, entry, &model.name, &mut scene.warnings);
        scene.instances.push(instance);
    }
    for mut light in model.lights.into_iter().filter(|_| entry.lights) {
        light.position = frame.transform_point3(light.position);
        light.direction = frame.transform_vector3(light.direction).normalize_or(light.direction);
        scene.lights.push(light);
    }
    for (name, mut camera) in model.cameras.into_iter().filter(|_| entry.cameras) {
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
