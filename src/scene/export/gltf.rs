//! glTF 2.0 with one buffer: interleaved vertices as in memory, then indices, motion and PNG
//! images.

use crate::files::FileError;
use std::path::Path;

use glam::{Mat3, Quat, Vec3};
use serde_json::{Map, Value, json};

use super::textures::Textures;
use super::writer::Writer;
use super::{images, motion, write_file};
use crate::scene::{Camera, Light, LightKind, Material, Mesh, Scene, SceneError};

/// Writes a .glb, or a .gltf with a .bin.
pub(super) fn write(scene: &Scene, path: &Path, binary: bool) -> Result<(), SceneError> {
    let mut writer = Writer::default();
    let images = scene.textures.iter().map(|texture| {
        let view = writer.view(&images::rgba_png(texture, path)?, json!({}));
        Ok(json!({ "bufferView": view, "mimeType": "image/png", "name": texture.name }))
    });
    let images = images.collect::<Result<Vec<Value>, SceneError>>()?;
    // glTF forbids meshes without triangles.
    let mut written = vec![None; scene.meshes.len()];
    let mut meshes = Vec::new();
    for (i, mesh) in scene
        .meshes
        .iter()
        .enumerate()
        .filter(|(_, mesh)| mesh.triangle_count() > 0)
    {
        written[i] = Some(meshes.len());
        meshes.push(writer.mesh(mesh));
    }
    let (movers, animations) = motion::movers(&mut writer, scene);
    let lights = place(&mut writer, scene, &movers, &written);
    let of_lights = LIGHTS.into_iter().zip(&lights);
    let of_lights = of_lights.filter(|(_, list)| !list.is_empty());
    let of_lights: Map<String, Value> = of_lights
        .map(|(name, list)| (name.into(), json!({ "lights": list })))
        .collect();
    let mut textures = Textures::default();
    let colored = scene.meshes.iter().any(Mesh::has_colors);
    let mut root = json!({
        "asset": { "version": "2.0", "generator": "conelab" },
        "scene": 0,
        "scenes": [{ "name": scene.name, "nodes": writer.roots }],
        "nodes": writer.nodes,
        "meshes": meshes,
        "materials": scene.materials.iter().map(|m| material(m, colored, &mut textures)).collect::<Vec<_>>(),
        "textures": textures.list(),
        "samplers": textures.samplers(),
        "images": images,
        "cameras": scene.cameras.iter().map(|(name, c)| lens(name, c)).collect::<Vec<_>>(),
        "accessors": writer.accessors,
        "bufferViews": writer.views,
        "extensionsUsed": extensions_used(scene, of_lights.keys()),
        "extensions": of_lights,
        "animations": animations,
    });
    // glTF forbids empty arrays.
    if let Some(root) = root.as_object_mut() {
        root.retain(|_, value| value.as_array().is_none_or(|array| !array.is_empty()));
    }
    save(root, writer.bytes, path, binary)
}

/// Adds nodes of instances, lights and cameras, and returns the lights by extension. `meshes` are
/// the numbers of the written ones.
fn place(
    writer: &mut Writer,
    scene: &Scene,
    movers: &[Option<usize>],
    meshes: &[Option<usize>],
) -> [Vec<Value>; 2] {
    for instance in &scene.instances {
        let Some(mesh) = meshes[instance.mesh as usize] else {
            continue;
        };
        let matrix = instance.transform.to_cols_array();
        let node = json!({ "name": instance.name, "mesh": mesh, "matrix": matrix });
        let mover = instance.mover.and_then(|m| movers.get(m as usize));
        writer.below(mover.copied().flatten(), node);
    }
    let lights = lights(scene, writer);
    for (i, (name, camera)) in scene.cameras.iter().enumerate() {
        writer.below(None, camera_node(name, i, camera));
    }
    lights
}

fn save(mut root: Value, bytes: Vec<u8>, path: &Path, binary: bool) -> Result<(), SceneError> {
    let length = u32::try_from(bytes.len()).map_err(|_| {
        FileError::write(
            path,
            "a glTF buffer cannot be larger than 4 GiB; export as .obj",
        )
    })?;
    if !binary {
        let side = path.with_extension("bin");
        let name = side
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .replace('%', "%25")
            .replace(' ', "%20");
        if length > 0 {
            root["buffers"] = json!([{ "byteLength": length, "uri": name }]);
            write_file(&side, &bytes)?;
        }
        return write_file(path, format!("{root:#}").as_bytes());
    }
    if length > 0 {
        root["buffers"] = json!([{ "byteLength": length }]);
    }
    let mut text = root.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let total = 12 + 8 + text.len() + if length > 0 { 8 + bytes.len() } else { 0 };
    let mut file = Vec::with_capacity(total);
    file.extend(b"glTF");
    file.extend(2u32.to_le_bytes());
    file.extend((total as u32).to_le_bytes());
    file.extend((text.len() as u32).to_le_bytes());
    file.extend(b"JSON");
    file.extend(text);
    if length > 0 {
        file.extend(length.to_le_bytes());
        file.extend(b"BIN\0");
        file.extend(bytes);
    }
    write_file(path, &file)
}

fn extensions_used<'a>(scene: &Scene, of_lights: impl Iterator<Item = &'a String>) -> Vec<&'a str> {
    let plain = Material::default();
    let mut used = vec!["KHR_materials_emissive_strength"];
    let some = |differs: &dyn Fn(&Material) -> bool| scene.materials.iter().any(differs);
    used.extend(of_lights.map(String::as_str));
    used.extend(some(&|m| m.ior != plain.ior).then_some("KHR_materials_ior"));
    used.extend(some(&|m| has_specular(m)).then_some("KHR_materials_specular"));
    let colored = scene.meshes.iter().any(Mesh::has_colors);
    used.extend((colored && some(&|m| m.tinted_emission)).then_some("KHR_materials_unlit"));
    used
}

fn has_specular(material: &Material) -> bool {
    let plain = Material::default();
    (material.specular, material.specular_color) != (plain.specular, plain.specular_color)
}

fn material(material: &Material, colored: bool, textures: &mut Textures) -> Value {
    let lookups = material.lookups;
    let strength = material.emission.max_element().max(1.0);
    let mut value = json!({
        "name": material.name,
        "doubleSided": material.two_sided,
        "alphaMode": if material.alpha_cutoff > 0.0 { "MASK" } else { "OPAQUE" },
        "emissiveFactor": (material.emission / strength).to_array(),
        "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": strength } },
        "pbrMetallicRoughness": {
            "baseColorFactor": material.base_color.to_array(),
            "metallicFactor": material.metallic,
            "roughnessFactor": material.roughness,
        },
    });
    if material.ior != Material::default().ior {
        value["extensions"]["KHR_materials_ior"] = json!({ "ior": material.ior });
    }
    if has_specular(material) {
        value["extensions"]["KHR_materials_specular"] = json!({
            "specularFactor": material.specular, "specularColorFactor": material.specular_color.to_array(),
        });
    }
    if material.alpha_cutoff > 0.0 {
        value["alphaCutoff"] = json!(material.alpha_cutoff);
    }
    if let Some(index) = material.base_color_texture {
        value["pbrMetallicRoughness"]["baseColorTexture"] =
            textures.reference(index, lookups.base_color);
    }
    if let Some(index) = material.metallic_roughness_texture {
        value["pbrMetallicRoughness"]["metallicRoughnessTexture"] =
            textures.reference(index, lookups.metallic_roughness);
    }
    if let Some(index) = material.normal_texture {
        value["normalTexture"] = textures.reference(index, lookups.normal);
        value["normalTexture"]["scale"] = json!(material.normal_scale);
    }
    if let Some(index) = material.emission_texture {
        value["emissiveTexture"] = textures.reference(index, lookups.emission);
    }
    if colored && material.tinted_emission {
        return unlit(material, value);
    }
    value
}

/// KHR_materials_unlit: in glTF, vertex colours multiply the emission of unlit materials only.
fn unlit(material: &Material, mut value: Value) -> Value {
    let pbr = &mut value["pbrMetallicRoughness"];
    pbr["baseColorFactor"] = json!(material.emission.extend(material.base_color.w).to_array());
    let texture = value
        .as_object_mut()
        .and_then(|fields| fields.remove("emissiveTexture"));
    if let Some(texture) = texture {
        value["pbrMetallicRoughness"]["baseColorTexture"] = texture;
    }
    value["emissiveFactor"] = json!([0, 0, 0]);
    value["extensions"] = json!({ "KHR_materials_unlit": {} });
    value
}

/// The extensions for lights without and with an extent.
const LIGHTS: [&str; 2] = ["KHR_lights_punctual", "EXT_lights_area"];

/// A light, and which of [`LIGHTS`] it is of.
fn light(light: &Light) -> (usize, Value) {
    // glTF colours must not exceed 1; the rest becomes the intensity.
    let intensity = light.color.max_element().max(f32::MIN_POSITIVE);
    let color = (light.color / intensity).to_array();
    let mut value = json!({ "name": light.name, "color": color, "intensity": intensity });
    let (extension, kind) = match light.kind {
        LightKind::Directional => (0, "directional"),
        LightKind::Point => (0, "point"),
        LightKind::Spot { inner, outer } => {
            value["spot"] = json!({ "innerConeAngle": inner, "outerConeAngle": outer });
            (0, "spot")
        }
        LightKind::Rectangle { width, height } => {
            value["size"] = height.into();
            value["rect"] = json!({ "aspect": width / height });
            (1, "rect")
        }
        LightKind::Disc { radius } => {
            value["size"] = (2.0 * radius).into();
            (1, "disk")
        }
    };
    value["type"] = kind.into();
    (extension, value)
}

/// Lights by extension, and their nodes.
fn lights(scene: &Scene, writer: &mut Writer) -> [Vec<Value>; 2] {
    let mut lists = [Vec::new(), Vec::new()];
    for one in scene.lights.iter().filter(|light| light.on) {
        let (extension, value) = light(one);
        let turn = match one.kind {
            LightKind::Rectangle { .. } => {
                let (side, top) = one.half_extents();
                let axes = [side.normalize(), top.normalize(), -one.direction];
                Quat::from_mat3(&Mat3::from_cols(axes[0], axes[1], axes[2]))
            }
            _ => Quat::from_rotation_arc(Vec3::NEG_Z, one.direction),
        };
        let node = json!({
            "name": one.name, "translation": one.position.to_array(), "rotation": turn.to_array(),
            "extensions": { LIGHTS[extension]: { "light": lists[extension].len() } },
        });
        writer.below(None, node);
        lists[extension].push(value);
    }
    lists
}

fn camera_node(name: &str, index: usize, camera: &Camera) -> Value {
    let back = (camera.eye - camera.target).normalize_or(Vec3::Z);
    let right = camera
        .up
        .cross(back)
        .normalize_or(back.any_orthonormal_vector());
    let turn = Quat::from_mat3(&Mat3::from_cols(right, back.cross(right), back));
    json!({ "name": name, "camera": index, "translation": camera.eye.to_array(), "rotation": turn.to_array() })
}

fn lens(name: &str, camera: &Camera) -> Value {
    let mut perspective = json!({ "yfov": camera.fov_y.to_radians(), "znear": camera.near });
    if camera.far.is_finite() {
        perspective["zfar"] = camera.far.into();
    }
    json!({ "name": name, "type": "perspective", "perspective": perspective })
}
