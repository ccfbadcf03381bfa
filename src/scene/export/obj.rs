//! Wavefront OBJ, with the keys of the metallic-roughness extension in the MTL.

use std::fmt::Write;
use std::path::Path;

use glam::{Mat3, Mat4, Vec3};

use super::{images, unique_names, write_file};
use crate::scene::{Material, Mesh, Scene, SceneError};

/// Writes `path`, the .mtl with the same stem, and PNG files in a folder `<stem>_textures`.
pub(super) fn write(scene: &Scene, path: &Path) -> Result<(), SceneError> {
    let materials = unique_names(
        scene
            .materials
            .iter()
            .map(|material| material.name.as_str()),
    );
    let stem = path
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let mut mtl = String::new();
    for (material, name) in scene.materials.iter().zip(&materials) {
        write_material(&mut mtl, scene, material, name, path, &stem)?;
    }
    write_file(&path.with_extension("mtl"), mtl.as_bytes())?;

    let mut obj = format!("mtllib {stem}.mtl\n");
    let names = unique_names(
        scene
            .instances
            .iter()
            .map(|instance| instance.name.as_str()),
    );
    let mut first_vertex = 1;
    for (i, (instance, name)) in scene.instances.iter().zip(&names).enumerate() {
        let mesh = &scene.meshes[instance.mesh as usize];
        // Writing into a string cannot fail.
        let _ = write_instance(
            &mut obj,
            &scene.instance_transform(i, 0.0),
            mesh,
            name,
            &materials,
            first_vertex,
        );
        first_vertex += mesh.vertices.len();
    }
    write_file(path, obj.as_bytes())
}

fn write_instance(
    out: &mut String,
    world: &Mat4,
    mesh: &Mesh,
    name: &str,
    materials: &[String],
    first_vertex: usize,
) -> std::fmt::Result {
    let axes = Mat3::from_mat4(*world);
    let normals = axes.inverse().transpose();
    writeln!(out, "o {name}")?;
    for vertex in &mesh.vertices {
        let p = world.transform_point3(Vec3::from_array(vertex.position));
        writeln!(out, "v {} {} {}", p.x, p.y, p.z)?;
    }
    for vertex in &mesh.vertices {
        writeln!(out, "vt {} {}", vertex.uv[0], 1.0 - vertex.uv[1])?;
    }
    for vertex in &mesh.vertices {
        let n = (normals * Vec3::from_array(vertex.normal)).normalize_or(Vec3::Y);
        writeln!(out, "vn {} {} {}", n.x, n.y, n.z)?;
    }
    // A mirroring transform flips the winding. The file has no transforms, so the corners are
    // reversed instead.
    let order = if axes.determinant() < 0.0 {
        [0, 2, 1]
    } else {
        [0, 1, 2]
    };
    for submesh in &mesh.submeshes {
        writeln!(out, "usemtl {}", materials[submesh.material as usize])?;
        let range =
            submesh.first_index as usize..(submesh.first_index + submesh.index_count) as usize;
        for triangle in mesh.indices[range].as_chunks::<3>().0 {
            let [a, b, c] = order.map(|k| triangle[k] as usize + first_vertex);
            writeln!(out, "f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}")?;
        }
    }
    Ok(())
}

fn write_material(
    out: &mut String,
    scene: &Scene,
    material: &Material,
    name: &str,
    path: &Path,
    stem: &str,
) -> Result<(), SceneError> {
    let texture = |index: Option<u32>| index.map(|i| (i, &scene.textures[i as usize]));
    let folder = format!("{stem}_textures");
    let save = |file: String, png: Vec<u8>| -> Result<String, SceneError> {
        let entry = format!("{folder}/{file}");
        write_file(&path.with_file_name(&folder).join(file), &png)?;
        Ok(entry)
    };
    let mut maps = Vec::new();
    let plain = Material::default();
    let (index, specular, color) = (material.ior, material.specular, material.specular_color);
    if (index, specular, color) != (plain.ior, plain.specular, plain.specular_color) {
        let [r, g, b] = color.to_array();
        maps.push(format!(
            "ior {index}\nspecular {specular}\nspecular_color {r} {g} {b}"
        ));
    }
    if let Some((i, image)) = texture(material.base_color_texture) {
        let entry = save(format!("{i}_color.png"), images::rgba_png(image, path)?)?;
        if material.alpha_cutoff > 0.0 {
            maps.push(format!("map_d {entry}"));
        }
        // Readers use a map as it is if its colour is 0.
        if material.base_color.truncate() != Vec3::ZERO {
            maps.push(format!("map_Kd {entry}"));
        }
    }
    if let Some((i, image)) = texture(material.metallic_roughness_texture) {
        let grey = |channel| images::grey_png(image, channel, path);
        let roughness = save(format!("{i}_roughness.png"), grey(1)?)?;
        let metallic = save(format!("{i}_metallic.png"), grey(2)?)?;
        maps.push(format!("map_Pr {roughness}\nmap_Pm {metallic}"));
    }
    if let Some((i, image)) = texture(material.normal_texture) {
        let entry = save(format!("{i}_normal.png"), images::rgba_png(image, path)?)?;
        let scale = material.normal_scale;
        maps.push(format!("norm {entry}\nnormal_scale {scale}"));
    }
    let shines = material.emission != Vec3::ZERO;
    if let Some((i, image)) = texture(material.emission_texture).filter(|_| shines) {
        let entry = save(format!("{i}_emission.png"), images::rgba_png(image, path)?)?;
        maps.push(format!("map_Ke {entry}"));
    }
    let ([r, g, b, a], e) = (material.base_color.to_array(), material.emission);
    // `two_sided`, `alpha_cutoff`, `ior` and `specular` are extensions of conelab; other programs
    // skip unknown keys.
    let (rough, metal, cutoff) = (material.roughness, material.metallic, material.alpha_cutoff);
    let ([x, y, z], sides, maps) = (e.to_array(), u8::from(material.two_sided), maps.join("\n"));
    *out += &format!("newmtl {name}\nKd {r} {g} {b}\nd {a}\nKs 0 0 0\nPr {rough}\nPm {metal}\n");
    *out += &format!("Ke {x} {y} {z}\ntwo_sided {sides}\nalpha_cutoff {cutoff}\n{maps}\n\n");
    Ok(())
}
