//! Scenes: every format loads, every kind of bad input is reported as such, nothing is lost on the way.

mod common;

use std::cell::Cell;
use std::collections::HashMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Instant;

use common::triangles::{meets, world};
use conelab::scene::{Light, LightKind, Mesh, Scene, SceneError, Side, TextureFormat, builtin};
use glam::{DVec3, Mat4, Vec3};
use proptest::prelude::*;
use tempfile::TempDir;

const QUAD: &str =
    "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";

fn open(spec: impl AsRef<Path>) -> Result<Scene, SceneError> {
    Scene::open(&spec.as_ref().to_string_lossy(), &|_, _| {
        ControlFlow::Continue(())
    })
}

#[test]
fn opening_ends_when_it_is_told_to() {
    let folder = folder();
    let atrium = open("atrium").unwrap();
    for model in ["atrium.glb", "atrium.obj"] {
        atrium.export(&folder.path().join(model)).unwrap();
    }
    let path = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    for spec in [path("atrium.glb"), path("atrium.obj"), "atrium".into()] {
        // Before anything, and in the middle of it: each takes longer than the 20 ms between calls.
        for calls in [1, 2] {
            let (count, asked) = (Cell::new(0), Cell::new(None));
            let result = Scene::open(&spec, &|what, done| {
                assert!(
                    !what.is_empty() && (0.0..=1.0).contains(&done),
                    "{what} {done}"
                );
                count.set(count.get() + 1);
                if count.get() < calls {
                    return ControlFlow::Continue(());
                }
                asked.set(Some(Instant::now()));
                ControlFlow::Break(())
            });
            assert!(
                matches!(result, Err(SceneError::Cancelled)),
                "{spec}, call {calls}"
            );
            assert_eq!(count.get(), calls, "{spec}: asked again after the end");
            assert!(
                asked.get().unwrap().elapsed().as_millis() < 500,
                "{spec}, call {calls}"
            );
        }
    }
}

fn write(folder: &TempDir, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(&path, content).unwrap();
    path
}

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

fn image(folder: &TempDir, name: &str, w: u32, h: u32, texel: impl Fn(u32, u32) -> [u8; 4]) {
    let path = folder.path().join(name);
    let rgba = image::RgbaImage::from_fn(w, h, |x, y| image::Rgba(texel(x, y)));
    if name.ends_with("jpg") {
        image::DynamicImage::ImageRgba8(rgba)
            .into_rgb8()
            .save(path)
            .unwrap();
    } else {
        rgba.save(path).unwrap();
    }
}

/// The message of an error, which must contain all the given pieces.
#[track_caller]
fn assert_error(result: Result<Scene, SceneError>, pieces: &[&str]) {
    let message = result.expect_err("an error").to_string();
    for piece in pieces {
        assert!(message.contains(piece), "'{piece}' is not in: {message}");
    }
}

#[track_caller]
fn assert_warning(scene: &Scene, pieces: &[&str]) {
    let fits = |warning: &&String| pieces.iter().all(|piece| warning.contains(piece));
    assert!(
        scene.warnings.iter().any(|w| fits(&w)),
        "{pieces:?} not in {:#?}",
        scene.warnings
    );
}

/// World corners of all triangles, in the order of the file.
fn triangles(scene: &Scene) -> Vec<[Vec3; 3]> {
    let mut all = Vec::new();
    for (i, instance) in scene.instances.iter().enumerate() {
        let (mesh, world) = (
            &scene.meshes[instance.mesh as usize],
            scene.instance_transform(i, 0.0),
        );
        for t in mesh.indices.as_chunks::<3>().0 {
            all.push(t.map(|i| world.transform_point3(mesh.vertices[i as usize].position.into())));
        }
    }
    all
}

fn area(scene: &Scene) -> f64 {
    let of = |t: &[Vec3; 3]| {
        let [a, b, c] = t.map(|p| p.as_dvec3());
        (b - a).cross(c - a).length() * 0.5
    };
    triangles(scene).iter().map(of).sum()
}

#[track_caller]
fn assert_near(a: Vec3, b: Vec3, tolerance: f32) {
    assert!(a.abs_diff_eq(b, tolerance), "{a} is not {b}");
}

#[track_caller]
fn assert_same_scene(a: &Scene, b: &Scene) {
    assert_eq!(a.triangle_count(), b.triangle_count());
    assert_near(a.bounds().0, b.bounds().0, 1e-3);
    assert_near(a.bounds().1, b.bounds().1, 1e-3);
    assert_eq!(a.materials.len(), b.materials.len());
    for (m, n) in a.materials.iter().zip(&b.materials) {
        assert_eq!(m.name, n.name);
        assert!(m.base_color.abs_diff_eq(n.base_color, 1e-5), "{m:?} {n:?}");
        assert!(m.emission.abs_diff_eq(n.emission, 1e-4), "{m:?} {n:?}");
        assert_eq!(
            (m.metallic, m.roughness, m.two_sided),
            (n.metallic, n.roughness, n.two_sided),
            "{}",
            m.name
        );
        assert_eq!(m.alpha_cutoff, n.alpha_cutoff, "{}", m.name);
        let maps = |x: &conelab::scene::Material| {
            [
                x.base_color_texture,
                x.metallic_roughness_texture,
                x.normal_texture,
                x.emission_texture,
            ]
        };
        for (s, t) in maps(m).into_iter().zip(maps(n)) {
            let (Some(s), Some(t)) = (s, t) else {
                assert_eq!(s.is_some(), t.is_some(), "{}", m.name);
                continue;
            };
            let (s, t) = (&a.textures[s as usize], &b.textures[t as usize]);
            assert_eq!(
                (s.width, s.height, s.format),
                (t.width, t.height, t.format),
                "{}",
                m.name
            );
            // Red of a metallic-roughness image means nothing; the rest must be the same.
            let far = |(x, y): (&[u8; 4], &[u8; 4])| x[1..] != y[1..];
            let pairs = s.mips[0]
                .as_chunks::<4>()
                .0
                .iter()
                .zip(t.mips[0].as_chunks::<4>().0);
            assert_eq!(pairs.filter(|&p| far(p)).count(), 0, "texels of {}", m.name);
        }
    }
}

#[test]
fn obj_with_every_kind_of_map() {
    let dir = folder();
    image(&dir, "color.png", 8, 4, |x, _| [x as u8 * 30, 100, 50, 255]);
    image(&dir, "mask.png", 8, 4, |x, _| {
        [if x < 4 { 255 } else { 0 }, 0, 0, 255]
    });
    image(&dir, "rough.png", 4, 4, |_, _| [64, 64, 64, 255]);
    image(&dir, "metal.bmp", 4, 4, |_, _| [200, 200, 200, 255]);
    image(&dir, "wall_normal.tga", 4, 4, |_, _| [128, 128, 255, 255]);
    image(&dir, "glow.jpg", 4, 4, |_, _| [255, 255, 255, 255]);
    let mtl = "newmtl full\nKd 0.5 0.6 0.7\nPr 0.25\nPm 0.75\nKe 2 3 4\nmap_Kd -bm 0.5 color.png\nmap_d mask.png\n\
               map_Pr rough.png\nmap_Pm metal.bmp\nmap_Bump wall_normal.tga\nmap_Ke glow.jpg\nnewmtl old\nNs 198\n";
    write(&dir, "a.mtl", mtl);
    let obj = format!("mtllib a.mtl\no one\nusemtl full\n{QUAD}o two\nusemtl old\nf 1/1 2/2 3/3\n");
    let scene = open(write(&dir, "a.obj", obj)).unwrap();
    assert_eq!(scene.warnings, Vec::<String>::new());
    assert_eq!((scene.triangle_count(), scene.meshes.len()), (3, 2));
    assert_eq!(scene.bounds(), (Vec3::ZERO, Vec3::new(2.0, 1.0, 0.0)));
    let (full, old) = (&scene.materials[0], &scene.materials[1]);
    assert_eq!(
        (full.roughness, full.metallic, full.alpha_cutoff),
        (0.25, 0.75, 0.5)
    );
    assert_eq!(full.emission, Vec3::new(2.0, 3.0, 4.0));
    assert_eq!(old.roughness, (2.0f32 / 200.0).sqrt());
    let texture = |index: Option<u32>| &scene.textures[index.unwrap() as usize];
    let color = texture(full.base_color_texture);
    assert_eq!(
        (color.width, color.height, color.format),
        (8, 4, TextureFormat::Rgba8Srgb)
    );
    assert_eq!(
        (color.mips[0][3], color.mips[0][31]),
        (255, 0),
        "the mask is the colour's alpha"
    );
    let rough_metal = texture(full.metallic_roughness_texture);
    assert_eq!((rough_metal.mips[0][1], rough_metal.mips[0][2]), (64, 200));
    assert_eq!(
        texture(full.normal_texture).format,
        TextureFormat::Rgba8Unorm
    );
    assert_eq!(
        texture(full.emission_texture).format,
        TextureFormat::Rgba8Srgb
    );
    // A bare model is lit and seen.
    assert_eq!(scene.lights.len(), 1);
    assert!(scene.lights[0].shadow && scene.cameras.contains_key("default") && scene.sky.x > 0.0);
    let tangent = scene.meshes[0].vertices[0].tangent;
    assert_near(Vec3::new(tangent[0], tangent[1], tangent[2]), Vec3::X, 1e-5);
    assert!(scene.summary().contains("full") && scene.summary().contains("mask at 0.50"));
}

#[test]
fn smooth_normals_stop_at_creases() {
    let dir = folder();
    // Two faces that meet at 30 degrees and a third at 90.
    let obj = "v 0 0 0\nv 0 0 1\nv 1 0 0\nv -0.866 -0.5 0\nv 0 -1 0\nf 1 2 3\nf 2 1 4\nf 1 3 5\n";
    let scene = open(write(&dir, "crease.obj", obj)).unwrap();
    let normals: Vec<Vec3> = scene.meshes[0]
        .vertices
        .iter()
        .filter(|v| v.position == [0.0; 3])
        .map(|v| v.normal.into())
        .collect();
    assert_eq!(
        normals.len(),
        2,
        "the flat pair shares one vertex, the crease has its own: {normals:?}"
    );
    assert!(
        normals.iter().any(|n| n.y > 0.9 && n.x < -0.1),
        "{normals:?}"
    );
    assert!(normals.iter().any(|n| n.z.abs() > 0.999), "{normals:?}");
}

#[test]
fn missing_and_corrupt_textures_have_stand_ins() {
    let dir = folder();
    write(&dir, "bad.png", b"\x89PNG\r\n\x1a\nbroken");
    write(
        &dir,
        "a.mtl",
        "newmtl gone\nmap_Kd nowhere.png\nnewmtl broken\nmap_Kd bad.png\n",
    );
    let scene = open(write(
        &dir,
        "a.obj",
        format!("mtllib a.mtl\nusemtl gone\n{QUAD}usemtl broken\nf 1 2 3\n"),
    ))
    .unwrap();
    assert_warning(&scene, &["nowhere.png of material gone", "does not exist"]);
    assert_warning(&scene, &["bad.png of material broken", "damaged"]);
    for texture in &scene.textures {
        assert_eq!((texture.width, texture.height), (8, 8));
        assert_eq!(texture.mips[0][..8], [255, 0, 255, 255, 0, 0, 0, 255]);
    }
}

#[test]
fn hostile_images_are_refused() {
    let dir = folder();
    // A PNG header that claims 20000 x 20000 texels.
    let mut png = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x4e\x20\0\0\x4e\x20\x08\x06\0\0\0".to_vec();
    png.extend([0x12, 0x34, 0x56, 0x78]);
    write(&dir, "bomb.png", png);
    write(&dir, "short.dds", b"DDS \x7c\0\0\0");
    write(
        &dir,
        "a.mtl",
        "newmtl m\nmap_Kd bomb.png\nnewmtl n\nmap_Kd short.dds\n",
    );
    let scene = open(write(
        &dir,
        "a.obj",
        format!("mtllib a.mtl\nusemtl m\n{QUAD}"),
    ))
    .unwrap();
    assert_warning(&scene, &["bomb.png", "checkerboard"]);
    assert_warning(&scene, &["short.dds", "DDS header"]);
}

#[test]
fn large_textures_are_reduced() {
    let dir = folder();
    image(&dir, "wide.png", 5000, 10, |_, _| [10, 20, 30, 255]);
    write(&dir, "a.mtl", "newmtl m\nmap_Kd wide.png\n");
    let scene = open(write(
        &dir,
        "a.obj",
        format!("mtllib a.mtl\nusemtl m\n{QUAD}"),
    ))
    .unwrap();
    assert_warning(&scene, &["wide.png", "5000x10", "4096x8"]);
    assert_eq!(scene.textures[0].mips[0][..4], [10, 20, 30, 255]);
}

/// A box as OBJ, its sides towards the outside.
fn obj_box(low: Vec3, high: Vec3, first: usize) -> String {
    let corner =
        |i: usize| Vec3::select(glam::BVec3::new(i & 1 > 0, i & 2 > 0, i & 4 > 0), high, low);
    let mut text: String = (0..8)
        .map(corner)
        .map(|c| format!("v {} {} {}\n", c.x, c.y, c.z))
        .collect();
    for side in [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ] {
        text += &format!("f {}\n", side.map(|i| (i + first).to_string()).join(" "));
    }
    text
}

#[test]
fn a_model_without_a_camera_is_not_seen_from_inside_of_something() {
    let folder = folder();
    // Inside out, a box is a room.
    let room = obj_box(Vec3::new(5.0, 3.0, 4.0), Vec3::new(-5.0, 0.0, -4.0), 1);
    let usual = open(write(&folder, "room.obj", &room)).unwrap().cameras["default"].eye;
    let (low, high) = (
        usual - Vec3::new(0.8, 0.5, 0.8),
        usual + Vec3::new(0.8, 1.0, 0.8),
    );
    let block = obj_box(low, high, 9);
    let blocked = open(write(&folder, "blocked.obj", format!("{room}{block}"))).unwrap();
    let eye = blocked.cameras["default"].eye;
    assert!(
        eye.cmplt(low).any() || eye.cmpgt(high).any(),
        "{eye} is inside of the box from {low} to {high}"
    );
    assert!(
        eye.abs().cmplt(Vec3::new(5.0, 3.0, 4.0)).all(),
        "{eye} has left the room"
    );
    let body = open(write(
        &folder,
        "body.obj",
        obj_box(Vec3::ZERO, Vec3::ONE, 1),
    ))
    .unwrap();
    let Vec3 { x, z, .. } = body.cameras["default"].eye;
    assert!(
        !(0.0..=1.0).contains(&x) || !(0.0..=1.0).contains(&z),
        "a single body is seen from outside"
    );
}

#[test]
fn a_model_is_not_hidden_by_a_box_close_to_its_camera() {
    let folder = folder();
    let room = obj_box(Vec3::new(5.0, 3.0, 4.0), Vec3::new(-5.0, 0.0, -4.0), 1);
    let usual = open(write(&folder, "room.obj", &room)).unwrap().cameras["default"].eye;
    // It fills half of the picture that looks along -x.
    let (low, high) = (
        Vec3::new(usual.x - 1.0, 0.0, usual.z),
        Vec3::new(usual.x - 0.5, 3.0, usual.z + 3.0),
    );
    let block = obj_box(low, high, 9);
    let blocked = open(write(&folder, "blocked.obj", format!("{room}{block}"))).unwrap();
    assert_ne!(blocked.cameras["default"].eye, usual);
}

#[test]
fn bad_triangles_are_dropped_and_counted() {
    let dir = folder();
    let obj = format!("{QUAD}v nan 0 0\nv 3 3 3\nf 1 2 5\nf 1 1 2\nf 1 6 6\n");
    let scene = open(write(&dir, "bad.obj", obj)).unwrap();
    assert_eq!(scene.triangle_count(), 2);
    assert_eq!(
        scene.bounds().1,
        Vec3::new(2.0, 1.0, 0.0),
        "dropped vertices do not count"
    );
    assert_warning(
        &scene,
        &[
            "bad.obj",
            "1 triangles with NaN",
            "2 triangles without area",
        ],
    );
    assert_eq!(scene.warnings.len(), 1);
}

#[test]
fn bad_models_are_errors_with_advice() {
    let dir = folder();
    assert_error(
        open(dir.path().join("none.obj")),
        &["none.obj", "Check the path"],
    );
    assert_error(
        open(write(&dir, "index.obj", "v 0 0 0\nf 1 2 3\n")),
        &["index.obj", "line 2", "Export it again"],
    );
    assert_error(
        open(write(&dir, "text.obj", "v a b c\n")),
        &["text.obj", "position", "line 1"],
    );
    assert_error(
        open(write(&dir, "a.fbx", "")),
        &["a.fbx", "it is no FBX file", "export it again"],
    );
    assert_error(
        open(write(&dir, "a.blend", "")),
        &["a.blend", "convert other formats to glTF"],
    );
    assert_error(
        open("cornel"),
        &["cornel", "did you mean 'cornell'?", "furnace"],
    );
    assert_error(
        open(write(&dir, "cut.glb", b"glTF\x02\0\0\0\xff\0\0\0")),
        &["cut.glb", "Export it again"],
    );
    assert_error(
        open(write(&dir, "empty.gltf", "{}")),
        &["empty.gltf", "Export it again"],
    );
    let scene = open(write(
        &dir,
        "lib.obj",
        format!("mtllib none.mtl\nusemtl x\n{QUAD}"),
    ))
    .unwrap();
    assert_warning(&scene, &["none.mtl", "grey"]);
}

#[test]
fn empty_scenes_are_legal() {
    let dir = folder();
    let scene = open(write(&dir, "empty.obj", "# nothing\n")).unwrap();
    assert_eq!(
        (scene.triangle_count(), scene.bounds()),
        (0, (Vec3::ZERO, Vec3::ZERO))
    );
    let scene = open(write(&dir, "empty.ron", "(sky: (1, 1, 1))")).unwrap();
    assert_eq!(scene.sky, Vec3::ONE);
    assert!(scene.cameras.contains_key("default"));
}

/// A glTF triangle in a buffer of 9 floats, with replaceable parts.
fn gltf(folder: &TempDir, change: impl Fn(&mut serde_json::Value)) -> PathBuf {
    let corners: [f32; 9] = [0., 0., 0., 1., 0., 0., 0., 1., 0.];
    write(
        folder,
        "t ri.bin",
        corners
            .iter()
            .flat_map(|f| f.to_le_bytes())
            .collect::<Vec<u8>>(),
    );
    let mut root = serde_json::json!({
        "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }],
        "nodes": [
            { "name": "top", "translation": [10, 0, 0], "scale": [2, 2, 2], "children": [1, 2, 3] },
            { "name": "leaf", "mesh": 0, "translation": [0, 1, 0] },
            { "name": "lamp", "extensions": { "KHR_lights_punctual": { "light": 0 } } },
            { "name": "eye", "camera": 0 },
        ],
        "meshes": [{ "name": "tri", "primitives": [{ "attributes": { "POSITION": 0 }, "material": 0 }] }],
        "materials": [{ "name": "m", "emissiveFactor": [0.5, 0.25, 0.0],
            "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 8 } } }],
        "cameras": [{ "type": "perspective", "perspective": { "yfov": 1.0, "znear": 0.1, "zfar": 50 } }],
        "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_emissive_strength"],
        "extensions": { "KHR_lights_punctual": { "lights": [
            { "type": "spot", "color": [1, 0.5, 0], "intensity": 6, "spot": { "innerConeAngle": 0.1, "outerConeAngle": 0.4 } }] } },
        "accessors": [{ "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3,
            "min": [0, 0, 0], "max": [1, 1, 0] }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
        "buffers": [{ "byteLength": 36, "uri": "t%20ri.bin" }],
    });
    change(&mut root);
    write(folder, "t.gltf", root.to_string())
}

#[test]
fn gltf_hierarchy_lights_and_cameras() {
    let dir = folder();
    let scene = open(gltf(&dir, |_| {})).unwrap();
    assert_eq!(scene.warnings, Vec::<String>::new());
    assert_eq!(
        scene.bounds(),
        (Vec3::new(10.0, 2.0, 0.0), Vec3::new(12.0, 4.0, 0.0))
    );
    assert_eq!(scene.materials[0].emission, Vec3::new(4.0, 2.0, 0.0));
    assert_eq!(scene.lights.len(), 1, "a model with lights gets no sun");
    assert_eq!(scene.lights[0].color, Vec3::new(6.0, 3.0, 0.0));
    assert_eq!(
        scene.lights[0].kind,
        LightKind::Spot {
            inner: 0.1,
            outer: 0.4
        }
    );
    assert_near(scene.lights[0].direction, Vec3::NEG_Z, 1e-6);
    assert_near(scene.cameras["eye"].eye, Vec3::new(10.0, 0.0, 0.0), 1e-6);
    assert!(scene.cameras.contains_key("default"));
}

#[test]
fn gltf_embedded_data_and_texture_transform() {
    let dir = folder();
    let scene = open(gltf(&dir, |root| {
        // Three corners as base64, and an image that is not there.
        root["buffers"][0]["uri"] = "data:application/octet-stream;base64,\
            AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"
            .into();
        root["images"] = serde_json::json!([{ "uri": "no.png" }]);
        root["textures"] = serde_json::json!([{ "source": 0 }]);
        root["materials"][0]["pbrMetallicRoughness"] = serde_json::json!({ "baseColorTexture": { "index": 0,
            "extensions": { "KHR_texture_transform": { "offset": [0.5, 0], "scale": [3, 3] } } } });
        root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 1.into();
        let uv = serde_json::json!({ "bufferView": 0, "componentType": 5126, "type": "VEC2", "count": 3 });
        root["accessors"].as_array_mut().unwrap().push(uv);
    }))
    .unwrap();
    assert_eq!(scene.triangle_count(), 1);
    assert_warning(&scene, &["no.png of material m"]);
    let uvs: Vec<[f32; 2]> = scene.meshes[0].vertices.iter().map(|v| v.uv).collect();
    assert!(
        uvs.contains(&[0.5, 3.0]) && uvs.contains(&[0.5, 0.0]),
        "{uvs:?}"
    );
}

#[test]
fn damaged_gltf_is_an_error() {
    let dir = folder();
    type Change = fn(&mut serde_json::Value);
    let cases: [(Change, &str); 9] = [
        (
            |r| r["accessors"][0]["bufferView"] = 99.into(),
            "accessors[0].bufferView: index out of bounds",
        ),
        (|r| r["buffers"][0]["uri"] = "gone.bin".into(), "gone.bin"),
        (|r| r["buffers"][0]["byteLength"] = 99.into(), "cut short"),
        (
            |r| r["accessors"][0]["count"] = 4.into(),
            "reaches past the end",
        ),
        (
            |r| r["bufferViews"][0]["byteOffset"] = 30.into(),
            "reaches past the end",
        ),
        (
            |r| r["nodes"][1]["children"] = serde_json::json!([0]),
            "own ancestor",
        ),
        (
            |r| {
                r["extensions"]["KHR_lights_punctual"]["lights"][0]["spot"] =
                    serde_json::Value::Null
            },
            "spot",
        ),
        (
            |r| r["cameras"][0]["type"] = "orthographic".into(),
            "camera 0",
        ),
        (
            |r| {
                r["meshes"][0]["primitives"][0]["indices"] = 1.into();
                let indices = serde_json::json!({ "bufferView": 0, "componentType": 5125, "type": "SCALAR", "count": 6 });
                r["accessors"].as_array_mut().unwrap().push(indices);
            },
            "index",
        ),
    ];
    for (change, piece) in cases {
        assert_error(open(gltf(&dir, change)), &["t.gltf", piece]);
    }
}

#[test]
fn dds_keeps_blocks_and_stored_mips() {
    use ddsfile::{AlphaMode, D3D10ResourceDimension, Dds, DxgiFormat, NewDxgiParams};
    let dir = folder();
    let dds = |name: &str, format: DxgiFormat, size: u32, mips: u32, cut: usize| {
        let mut file = Dds::new_dxgi(NewDxgiParams {
            height: size,
            width: size,
            depth: None,
            format,
            mipmap_levels: Some(mips),
            array_layers: None,
            caps2: None,
            is_cubemap: false,
            resource_dimension: D3D10ResourceDimension::Texture2D,
            alpha_mode: AlphaMode::Straight,
        })
        .unwrap();
        file.data
            .iter_mut()
            .enumerate()
            .for_each(|(i, byte)| *byte = i as u8);
        let mut bytes = Vec::new();
        file.write(&mut bytes).unwrap();
        bytes.truncate(bytes.len() - cut);
        write(&dir, name, bytes);
    };
    dds("bc1.dds", DxgiFormat::BC1_UNorm, 16, 3, 0);
    dds("bc7.dds", DxgiFormat::BC7_UNorm_sRGB, 8, 1, 0);
    dds("bc5.dds", DxgiFormat::BC5_UNorm, 8, 4, 0);
    dds("plain.dds", DxgiFormat::R8G8B8A8_UNorm, 4, 1, 0);
    dds("cut.dds", DxgiFormat::BC3_UNorm, 16, 3, 20);
    let names = ["bc1", "bc7", "plain", "cut"];
    let mut mtl: String = names
        .iter()
        .map(|n| format!("newmtl {n}\nmap_Kd {n}.dds\n"))
        .collect();
    mtl.push_str("newmtl bc5\nnorm bc5.dds\n");
    write(&dir, "a.mtl", mtl);
    let scene = open(write(
        &dir,
        "a.obj",
        format!("mtllib a.mtl\nusemtl bc1\n{QUAD}"),
    ))
    .unwrap();
    let found: Vec<_> = scene
        .textures
        .iter()
        .map(|t| (t.format, t.mips.len()))
        .collect();
    use TextureFormat::*;
    let expected = [
        (Bc1Srgb, 3),
        (Bc7Srgb, 1),
        (Rgba8Srgb, 3),
        (Rgba8Srgb, 4),
        (Bc5Unorm, 4),
    ];
    assert_eq!(found, expected);
    assert_eq!(
        scene.textures[0]
            .mips
            .iter()
            .map(Vec::len)
            .collect::<Vec<_>>(),
        [128, 32, 8]
    );
    assert_eq!(scene.textures[2].mips[0][..4], [0, 1, 2, 3]);
    assert_warning(&scene, &["cut.dds", "ends inside mip level"]);
}

#[test]
fn mips_are_linear_light_unit_normals_and_full_coverage() {
    let dir = folder();
    // Black and white columns: the mean light is 0.5, which is 188 in sRGB.
    image(&dir, "stripes.png", 6, 5, |x, _| {
        if x % 2 == 0 { [0, 0, 0, 255] } else { [255; 4] }
    });
    // Soft grass: one texel in four passes the cutoff, half are empty and red.
    let blade = |x: u32, y: u32| {
        let mixed = x.wrapping_mul(374_761_393) ^ y.wrapping_mul(668_265_263);
        let chance = (mixed ^ (mixed >> 13)).wrapping_mul(1_274_126_177) >> 24;
        if chance < 128 {
            [0, 200, 0, 192 - chance as u8]
        } else {
            [255, 0, 0, 0]
        }
    };
    image(&dir, "grass.png", 64, 64, blade);
    image(&dir, "n.png", 4, 4, |x, _| {
        if x % 2 == 0 {
            [255, 128, 128, 255]
        } else {
            [128, 255, 128, 255]
        }
    });
    write(
        &dir,
        "a.mtl",
        "newmtl m\nmap_Kd stripes.png\nnorm n.png\nnewmtl g\nmap_Kd grass.png\nmap_d grass.png\n",
    );
    let scene = open(write(
        &dir,
        "a.obj",
        format!("mtllib a.mtl\nusemtl m\n{QUAD}"),
    ))
    .unwrap();
    let texture = |name: &str| {
        scene
            .textures
            .iter()
            .find(|t| t.name.ends_with(name))
            .unwrap()
    };
    let stripes = texture("stripes.png");
    assert_eq!(
        stripes.mips.iter().map(Vec::len).collect::<Vec<_>>(),
        [6 * 5 * 4, 3 * 2 * 4, 4]
    );
    assert_eq!(stripes.mips[1][0], 188);
    assert_eq!(stripes.mips[2][0], 188);
    let grass = texture("grass.png");
    let opaque = |level: &Vec<u8>| {
        let texels = level.as_chunks::<4>().0;
        texels.iter().filter(|t| t[3] >= 128).count() as f32 / texels.len() as f32
    };
    for level in &grass.mips[1..4] {
        assert!(
            (opaque(level) - opaque(&grass.mips[0])).abs() < 0.06,
            "coverage {}",
            opaque(level)
        );
    }
    assert!(
        grass.mips[2].as_chunks::<4>().0.iter().all(|t| t[0] < 8),
        "the hidden red does not bleed in"
    );
    for t in texture("n.png").mips[1].as_chunks::<4>().0 {
        let n = Vec3::new(t[0].into(), t[1].into(), t[2].into()) / 127.5 - 1.0;
        assert!((n.length() - 1.0).abs() < 0.02, "{n}");
    }
}

#[test]
fn built_in_scenes_are_sound() {
    for (name, _) in builtin::list() {
        let scene = open(name).unwrap();
        assert_eq!(scene.warnings, Vec::<String>::new(), "{name}");
        assert!(
            scene.cameras.contains_key("default") && scene.triangle_count() > 0,
            "{name}"
        );
        for mesh in &scene.meshes {
            for v in &mesh.vertices {
                let (n, t) = (
                    Vec3::from(v.normal),
                    Vec3::new(v.tangent[0], v.tangent[1], v.tangent[2]),
                );
                assert!(
                    (n.length() - 1.0).abs() < 1e-3 && (t.length() - 1.0).abs() < 1e-3,
                    "{name} {}",
                    mesh.name
                );
            }
        }
        let again = open(name).unwrap();
        assert!(
            again.meshes == scene.meshes && again.textures == scene.textures,
            "{name} differs when built again"
        );
    }
}

#[test]
fn built_in_scenes_are_seen_and_lit() {
    for (name, _) in builtin::list() {
        let scene = open(name).unwrap();
        let triangles = world(&scene);
        for [a, b, c] in &triangles {
            assert!(a.is_finite() && b.is_finite() && c.is_finite(), "{name}");
            let longest = a
                .distance_squared(*b)
                .max(b.distance_squared(*c))
                .max(c.distance_squared(*a));
            assert!(
                (b - a).cross(c - a).length() > 1e-9 * longest,
                "{name}: a triangle without area"
            );
        }
        for (camera, c) in &scene.cameras {
            assert!(
                c.eye.is_finite() && c.target.is_finite() && c.eye != c.target,
                "{name} {camera}"
            );
            assert!(
                0.0 < c.near && c.near < c.far && (5.0..150.0).contains(&c.fov_y),
                "{name} {camera}"
            );
            let (eye, ahead) = (c.eye.as_dvec3(), (c.target - c.eye).as_dvec3().normalize());
            let right = ahead.cross(c.up.as_dvec3()).normalize()
                * f64::from(0.5 * c.fov_y.to_radians()).tan();
            let seen = f64::from(c.near)..f64::from(c.far);
            // Straight ahead, half way to the picture's left and right edge, and to its lower one.
            let below = right.cross(ahead) * -0.5;
            let rays = [
                ahead,
                ahead - 0.5 * right,
                ahead + 0.5 * right,
                ahead + below,
            ];
            let nearest = |ray: DVec3| {
                triangles
                    .iter()
                    .filter_map(|t| meets(eye, ray, *t))
                    .fold(f64::INFINITY, f64::min)
            };
            assert!(
                rays.iter().any(|ray| seen.contains(&nearest(*ray))),
                "{name} {camera} sees nothing in {seen:?}"
            );
        }
        for m in &scene.materials {
            let color = m.base_color.truncate();
            assert!(
                color.min_element() >= 0.0 && color.max_element() <= 1.0,
                "{name} {}",
                m.name
            );
            assert!(
                m.emission.is_finite() && m.emission.min_element() >= 0.0,
                "{name} {}",
                m.name
            );
            assert!(
                (0.0..=1.0).contains(&m.roughness) && (0.0..=1.0).contains(&m.metallic),
                "{name} {}",
                m.name
            );
        }
        for light in &scene.lights {
            assert!(
                (light.direction.length() - 1.0).abs() < 1e-3 && light.color.min_element() > 0.0,
                "{name}"
            );
        }
        let glows = scene.materials.iter().any(|m| m.emission != Vec3::ZERO);
        assert!(
            glows || scene.sky != Vec3::ZERO || !scene.lights.is_empty(),
            "{name} is dark"
        );
    }
}

/// The mesh of walls is closed: each edge is walked as often in one direction as in the other. So no ray leaves a
/// room but by an opening.
#[test]
fn walls_of_built_in_rooms_have_no_cracks() {
    for (name, walls) in [
        ("small-quad", "room"),
        ("emitters", "room"),
        ("ceiling-panel", "room"),
        ("neon-tube", "room"),
        ("neon-tube", "tube"),
        ("lampshade", "room"),
        ("lampshade", "bulbs"),
        ("huge-ground", "shell"),
        ("far-away", "shell"),
        ("pocket", "room"),
        ("blinds", "room"),
        ("door-ajar", "rooms"),
        ("corridor", "corridor"),
        ("street", "house 1"),
        ("gloss", "room"),
    ] {
        let scene = open(name).unwrap();
        let mesh = scene.meshes.iter().find(|m| m.name == walls).unwrap();
        let mut edges: HashMap<[[u32; 3]; 2], i32> = HashMap::new();
        let corner = |i: u32| {
            (Vec3::from(mesh.vertices[i as usize].position) + 0.0)
                .to_array()
                .map(f32::to_bits)
        };
        // A balcony's plates are bodies of their own: closed as well.
        for t in mesh.indices.as_chunks::<3>().0 {
            for (a, b) in
                [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])].map(|(a, b)| (corner(a), corner(b)))
            {
                *edges.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
            }
        }
        let open = edges.values().filter(|n| **n != 0).count();
        assert_eq!(open, 0, "{name}: open edges among {}", edges.len());
    }
}

/// What closed lamps hold, counted from their faces' fronts, is their volume: they glow outward.
#[test]
fn lamps_glow_outward() {
    for (name, lamp, volume) in [
        (
            "neon-tube",
            "tube",
            std::f32::consts::PI * 0.013 * 0.013 * 1.2,
        ),
        (
            "neon-tube",
            "red tube",
            std::f32::consts::PI * 0.013 * 0.013 * 1.2,
        ),
        (
            "lampshade",
            "bulbs",
            2.0 * std::f32::consts::PI * 4.0 / 3.0 * 0.03 * 0.03 * 0.03,
        ),
    ] {
        let scene = open(name).unwrap();
        let mesh = scene.meshes.iter().find(|m| m.name == lamp).unwrap();
        let corner = |i: u32| {
            Vec3::from(mesh.vertices[i as usize].position) - Vec3::from(mesh.vertices[0].position)
        };
        let held = |t: &[u32; 3]| corner(t[0]).dot(corner(t[1]).cross(corner(t[2]))) / 6.0;
        let held: f32 = mesh.indices.as_chunks::<3>().0.iter().map(held).sum();
        assert!(
            (0.93..1.0).contains(&(held / volume)),
            "{name}: {lamp} holds {held} of {volume}"
        );
    }
}

/// One mesh of shapes.
fn shapes(folder: &TempDir, parts: &str) -> Mesh {
    let text = format!("(materials: {{\"a\": ()}}, meshes: {{\"m\": [{parts}]}})");
    open(write(folder, "shapes.ron", text))
        .unwrap()
        .meshes
        .remove(0)
}

#[test]
fn balls_and_boxes_have_an_outside_and_sheets_have_none() {
    let dir = folder();
    let ball = shapes(&dir, "Sphere(material: \"a\", radius: 0.5, level: 1)");
    let all = |mesh: &Mesh, side: Option<Side>| mesh.outsides(10.0).iter().all(|s| *s == side);
    assert!(all(&ball, Some(Side::Front)));
    assert!(ball.outsides(1.0).iter().all(Option::is_none), "too large");
    let mut turned = ball.clone();
    turned
        .indices
        .as_chunks_mut::<3>()
        .0
        .iter_mut()
        .for_each(|t| t.swap(0, 1));
    assert!(all(&turned, Some(Side::Back)));
    let mut mixed = ball.clone();
    mixed
        .indices
        .as_chunks_mut::<3>()
        .0
        .iter_mut()
        .step_by(3)
        .for_each(|t| t.swap(0, 1));
    let turned = (0..)
        .zip(mixed.outsides(10.0))
        .map(|(i, s)| (i % 3 == 0, s == Some(Side::Back)));
    assert!(
        turned.into_iter().all(|(turned, back)| turned == back),
        "neighbours turn either way"
    );
    let mut opened = ball.clone();
    opened.indices.truncate(opened.indices.len() - 3);
    assert!(all(&opened, None));
    let cuboid = "Box(material: \"a\", low: (0, 0, 0), high: (1, 1, 1)";
    assert!(all(&shapes(&dir, &format!("{cuboid})")), Some(Side::Front)));
    assert!(all(
        &shapes(&dir, &format!("{cuboid}, open: [\"-y\"])")),
        None
    ));
}

/// Triangles, vertices, instances and materials of the built-in scenes: one that changes must say so here.
#[test]
fn built_in_scenes_keep_their_size() {
    let row = |name| {
        let scene = open(name).unwrap();
        let vertices: usize = scene.meshes.iter().map(|m| m.vertices.len()).sum();
        format!(
            "{name} {} {vertices} {} {}",
            scene.triangle_count(),
            scene.instances.len(),
            scene.materials.len()
        )
    };
    insta::assert_snapshot!(builtin::list().map(|(name, _)| row(name)).collect::<Vec<_>>().join("\n"), @r"
    atrium 265240 165735 59 19
    cornell 32 64 8 4
    furnace 768 486 1 1
    white-sky 5120 15360 1 1
    thin-walls 258 341 14 3
    triangles 4135 12405 5 5
    moving-box 108 99 4 3
    blade 108 99 4 3
    small-quad 114 228 4 4
    emitters 4610 13540 4 9
    ceiling-panel 1028 2056 4 7
    neon-tube 772 1030 6 8
    lampshade 1976 3418 5 7
    huge-ground 4174 4540 33 7
    far-away 4174 4540 33 7
    pocket 144 288 2 5
    plain 494 990 2 4
    blinds 866 1732 3 5
    door-ajar 394 788 3 5
    corridor 456 912 2 5
    street 18038 36076 9 9
    gloss 13072 34200 3 10
    foliage 29964 15961 12 4
    sky-window 314 628 2 5
    vases 1025312 525874 3 7
    ");
}

#[test]
fn shapes_repeat_and_stand_where_they_are_put() {
    let scene =
        open(Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/scenes/shapes.ron")).unwrap();
    assert_eq!(scene.warnings, Vec::<String>::new());
    let names: Vec<&str> = scene.instances.iter().map(|i| i.name.as_str()).collect();
    assert_eq!(names, ["room", "balls", "stool 1", "stool 2", "stool 3"]);
    assert_eq!(
        scene
            .materials
            .iter()
            .map(|m| m.name.as_str())
            .collect::<Vec<_>>(),
        ["plaster", "wood", "red", "blue"]
    );
    // Six balls in two colours by turns, around the middle.
    let balls = &scene.meshes[1];
    assert_eq!((balls.triangle_count(), balls.submeshes.len()), (6 * 80, 2));
    let far = balls
        .vertices
        .iter()
        .map(|v| Vec3::from(v.position).with_y(0.0).length())
        .fold(0.0, f32::max);
    assert!((far - 1.35).abs() < 0.01, "{far}");
    assert!(
        scene.instances[4]
            .transform
            .w_axis
            .abs_diff_eq(glam::Vec4::new(1.5, 0.0, 1.4, 1.0), 1e-6)
    );
}

#[test]
fn errors_in_shapes_have_a_place_and_limits_hold() {
    let dir = folder();
    let error = |parts: &str, pieces: &[&str]| {
        let text = format!(
            "(\n materials: {{\"a\": ()}},\n meshes: {{\n  \"m\": [\n   {parts}\n  ],\n }},\n)"
        );
        assert_error(open(write(&dir, "x.ron", text)), pieces);
    };
    error(
        "Bx(material: \"a\")",
        &["x.ron:5:", "unknown kind 'Bx'", "did you mean 'Box'?"],
    );
    error(
        "Sphere(material: \"a\", radus: 1)",
        &["x.ron:5:", "did you mean 'radius'?"],
    );
    error(
        "Sphere(material: \"red\", radius: 1, level: 1)",
        &["x.ron:5:21", "no material 'red'", "a"],
    );
    error("Group(\"g\")", &["x.ron:5:", "no group 'g'"]);
    error(
        "Box(material: \"a\", low: (0, 0, 0), high: (1, 1, 1), open: [\"up\"])",
        &["x.ron:5:", "'up'", "+y"],
    );
    error(
        "Sphere(material: \"a\", radius: 1, level: 40)",
        &["x.ron:4:3", "mesh 'm'", "vertices"],
    );
    error(
        "Lathe(material: \"a\", profile: [], sides: 4294967295, rows: 4294967295)",
        &["x.ron:4:3", "vertices"],
    );
    error(
        "Repeat(at: Circle(radius: 1, count: 4294967295), parts: [])",
        &["x.ron:4:3", "places"],
    );
    error(
        "Solid([Sphere(material: \"a\", radius: 1, level: 1)])",
        &["x.ron:4:3", "boxes and hollows"],
    );
    error("Solid([])", &["x.ron:4:3", "at least one box"]);
    let deep = (0..20).fold(String::new(), |inner, _| {
        format!("Repeat(parts: [{inner}])")
    });
    error(&deep, &["x.ron:4:3", "inside of"]);
    let many = "Repeat(at: Grid(from: (0, 0, 0), steps: [((1, 0, 0), 60000)]), parts: [Seed(1), Seed(2), Seed(3), Seed(4), Seed(5)])";
    error(many, &["x.ron:4:3", "parts"]);
    error(
        "Box(material: \"a\", low: (0, 0, 0), high: (1e30, 1, 1))",
        &["x.ron:", "units and scale"],
    );
    let nested = (0..8).fold(String::new(), |inner, _| {
        format!("Repeat(at: Grid(from: (0, 0, 0), steps: [((1, 0, 0), 60000)]), parts: [{inner}])")
    });
    error(&nested, &["x.ron:4:3", "parts"]);
    // Each solid is small enough, and all of them would take half an hour.
    let boxes: String = (0..30).fold(String::new(), |text, i| {
        format!("{text}Box(material: \"a\", low: ({i}, {i}, {i}), high: ({i}.5, {i}.6, {i}.7)), ")
    });
    let since = Instant::now();
    error(
        &format!(
            "Repeat(at: Grid(from: (0, 0, 0), steps: [((99, 0, 0), 8000)]), parts: [Solid([{boxes}])])"
        ),
        &["x.ron:4:3", "a solid counts by its cells"],
    );
    assert!(since.elapsed().as_secs() < 10, "{:?}", since.elapsed());
    let ball = "[Sphere(material: \"a\", radius: 1, level: 7)]";
    let text = format!(
        "(materials: {{\"a\": ()}}, meshes: {{\"m\": {ball}, \"n\": {ball}, \"o\": {ball}, \"p\": {ball}, \"q\": {ball}}})"
    );
    assert_error(open(write(&dir, "x.ron", text)), &["mesh 'q'", "vertices"]);
    let entry = "(meshes: [\"m\"], at: Circle(radius: 1, count: 60000))";
    let text = format!("(meshes: {{\"m\": []}}, instances: [{entry}, {entry}])");
    assert_error(open(write(&dir, "x.ron", text)), &["x.ron:1:", "instances"]);
    let text = "(groups: {\"g\": [Group(\"g\")]}, meshes: {\"m\": [Group(\"g\")]})";
    assert_error(
        open(write(&dir, "x.ron", text)),
        &["x.ron:1:", "groups inside of"],
    );
    let text = "(materials: {\"a\": (base_color_texture: 0)})";
    assert_error(
        open(write(&dir, "x.ron", text)),
        &["x.ron:1:", "material 'a'", "texture 0 of 0"],
    );
    let text = "(instances: [(meshes: [\"gone\"])])";
    assert_error(
        open(write(&dir, "x.ron", text)),
        &["x.ron:1:", "no mesh 'gone'"],
    );
}

#[test]
fn rooms_look_inward_and_solids_outward() {
    for (name, inward) in [("furnace", true), ("white-sky", false)] {
        for [a, b, c] in triangles(&open(name).unwrap()) {
            let outward = (b - a).cross(c - a).dot(a + b + c) > 0.0;
            assert_ne!(outward, inward, "{name}");
        }
    }
    let furnace = open("furnace").unwrap();
    assert!(furnace.lights.is_empty() && furnace.sky == Vec3::ZERO);
    assert_eq!(furnace.materials[0].emission, Vec3::ONE);
}

#[test]
fn atrium_is_rich_and_moves() {
    let scene = open("atrium").unwrap();
    assert!(scene.triangle_count() >= 60_000);
    let (low, high) = scene.bounds();
    assert!(
        (high - low).abs_diff_eq(Vec3::new(30.0, 12.0, 14.0), 1.0),
        "{}",
        high - low
    );
    assert!(scene.cameras.len() >= 3);
    assert!(scene.materials.iter().any(|m| m.alpha_cutoff > 0.0));
    assert!(scene.materials.iter().any(|m| m.metallic > 0.5));
    assert!(scene.materials.iter().any(|m| m.emission != Vec3::ZERO));
    assert!(scene.materials.iter().any(|m| m.normal_texture.is_some()));
    let actor = scene
        .instances
        .iter()
        .position(|i| i.mover.is_some())
        .unwrap();
    let (start, later) = (
        scene.instance_transform(actor, 0.0),
        scene.instance_transform(actor, 3.0),
    );
    assert!(!start.abs_diff_eq(later, 1e-3));
    assert!(
        start.abs_diff_eq(scene.instance_transform(actor, 12.0), 1e-4),
        "it repeats"
    );
}

#[test]
fn scene_file_composes() {
    let dir = folder();
    write(&dir, "models/quad.obj", QUAD);
    let text = r#"(
        name: "both",
        models: [
            (file: "models/quad.obj", transform: (translate: (5, 0, 0), rotate_deg: (0, 90, 0), scale: (2, 2, 2)),
             animation: (keyframes: [(time: 0), (time: 4, translate: (0, 8, 0), rotate_deg: (0, 360, 0))], repeat: true)),
            (builtin: "cornell"),
        ],
        lights: [
            Point(color: (1, 2, 3), position: (0, 1, 0), shadow: false),
            Spot(name: "s", color: (1, 1, 1), position: (0, 9, 0), direction: (0, -2, 0), inner_deg: 10, outer_deg: 20,
                 shadow: true),
            Directional(color: (1, 1, 1), direction: (0, -1, 0), shadow: true),
        ],
        cameras: { "wide": (eye: (0, 0, 9), target: (0, 0, 0), fov_y: 60) },
    )"#;
    let scene = open(write(&dir, "both.ron", text)).unwrap();
    assert_eq!(
        (
            scene.name.as_str(),
            scene.triangle_count(),
            scene.lights.len()
        ),
        ("both", 34, 4),
        "the box brings a lamp of its own"
    );
    assert_eq!(
        scene.cameras.keys().collect::<Vec<_>>(),
        ["wide", "default"]
    );
    assert_near(scene.lights[2].direction, Vec3::NEG_Y, 1e-6);
    // Rotated about y: the quad's x becomes -z.
    let at = |time: f32| {
        scene
            .instance_transform(0, time)
            .transform_point3(Vec3::new(2.0, 0.0, 0.0))
    };
    assert_near(at(0.0), Vec3::new(5.0, 0.0, -4.0), 1e-4);
    assert_near(at(2.0), Vec3::new(-5.0, 4.0, 4.0), 1e-3);
    assert_near(at(6.0), at(2.0), 1e-3);
    let (low, high) = scene.bounds();
    assert!(
        high.y >= 9.9 && low.x <= -5.0,
        "bounds hold all poses: {low} {high}"
    );
}

#[test]
fn scene_file_errors_have_a_place_and_a_hint() {
    let dir = folder();
    let error =
        |text: &str, pieces: &[&str]| assert_error(open(write(&dir, "x.ron", text)), pieces);
    error(
        "(\n  model: [],\n)",
        &[
            "x.ron:2:",
            "unknown field 'model'",
            "did you mean 'models'?",
        ],
    );
    error(
        "(models: [\n(builtin: \"atrum\")])",
        &["x.ron:2:", "did you mean 'atrium'?"],
    );
    error(
        "(models: [(file: \"a.obj\", builtin: \"atrium\")])",
        &["either a file or a builtin"],
    );
    error(
        "(models: [\n\n  (file: \"gone.obj\")])",
        &["x.ron:3:10", "gone.obj", "CONELAB_SCENES"],
    );
    error(
        "(lights: [Pint(color: (1,1,1))])",
        &["x.ron:1:", "did you mean 'Point'?"],
    );
    error(
        "(lights: [Point(color: (1,1,1), position: (0,0,0), shadw: true)])",
        &["did you mean 'shadow'?"],
    );
    error(
        "(lights: [Directional(color: (1,1,1), direction: (0,0,0), shadow: true)])",
        &["not zero"],
    );
    error(
        "(lights: [Point(color: (1,1,1), position: (0,0,0), direction: (0,1,0), shadow: true)])",
        &["point light", "no `direction`"],
    );
    error(
        "(lights: [Disc(color: (1,1,1), position: (0,0,0), direction: (0,1,0), shadow: true)])",
        &["radius"],
    );
    error(
        "(lights: [Disc(color: (1,1,1), position: (0,0,0), direction: (0,1,0), radius: 0, shadow: true)])",
        &["its radius must be 0.0001 to 1000000 m"],
    );
    error(
        "(cameras: {\"a\": (eye: (0,0,0), target: (0,1,0), fov_y: 60)})",
        &["up vector"],
    );
    error(
        "(cameras: {\"a\": (eye: (0,0,0), target: (1,1,0), fov_y: 0)})",
        &["between 1 and 170"],
    );
    error(
        "(models: [(builtin: \"cornell\", transform: (scale: (0, 1, 1)))])",
        &["scale above 0"],
    );
    error(
        "(models: [(builtin: \"cornell\", animation: (keyframes: [(time: 1), (time: 1)]))])",
        &["times that rise"],
    );
    error(
        "(\n  sky: (0.5, -1, 0.5),\n)",
        &["x.ron:2:", "finite and 0 or more"],
    );
    error("(models: [", &["x.ron:1:"]);
    assert_error(
        open(dir.path().join("none.ron")),
        &["none.ron", "Check the path"],
    );
}

#[test]
fn scene_folders_are_searched() {
    let dir = folder();
    write(&dir, "store/deep/quad.obj", QUAD);
    let file = write(
        &dir,
        "scenes/x.ron",
        "(models: [(file: \"deep/quad.obj\")])",
    );
    if let Ok(file) = std::env::var("CONELAB_TEST_SCENE") {
        assert_eq!(open(file).unwrap().triangle_count(), 2);
        return;
    }
    // The environment of this process is shared by all tests, so another one looks.
    let status = std::process::Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "scene_folders_are_searched"])
        .env("CONELAB_TEST_SCENE", file)
        .env(
            "CONELAB_SCENES",
            format!("/nowhere:{}", dir.path().join("store").display()),
        )
        .output()
        .unwrap();
    assert!(
        status.status.success(),
        "{}",
        String::from_utf8_lossy(&status.stdout)
    );
}

#[test]
fn shipped_scene_files_are_valid() {
    let configs = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/scenes");
    let workshop = open(configs.join("workshop.ron")).unwrap();
    assert!(workshop.instances.iter().any(|i| i.mover.is_some()));
    assert!(
        workshop
            .lights
            .iter()
            .any(|l| matches!(l.kind, LightKind::Spot { .. }))
    );
    assert!(workshop.lights.iter().any(|l| l.kind == LightKind::Point));
    for name in ["sponza", "living-room"] {
        // Without the model, only the model may be missing.
        if let Err(error) = open(configs.join(format!("{name}.ron"))) {
            assert!(
                error.to_string().contains(&format!("{name}/{name}.obj")),
                "{error}"
            );
        }
    }
}

#[test]
fn atrium_survives_obj_and_glb() {
    let dir = folder();
    let scene = open("atrium").unwrap();
    for file in ["atrium.obj", "atrium.glb"] {
        let path = dir.path().join(file);
        scene.export(&path).unwrap();
        let again = open(&path).unwrap();
        assert_eq!(again.warnings, Vec::<String>::new());
        // OBJ texts move corners by a rounding: nothing may vanish, though.
        assert_same_scene(&scene, &again);
        assert!((area(&again) / area(&scene) - 1.0).abs() < 1e-4);
    }
}

#[test]
fn a_picture_of_the_sky_is_written_beside_a_gltf_file() {
    let dir = folder();
    let scene = open("sky-window").unwrap();
    scene.export(&dir.path().join("w.gltf")).unwrap();
    let plain = open(dir.path().join("w.gltf")).unwrap();
    assert!(plain.environment.is_none());
    let again = plain.under(&dir.path().join("w.sky.exr")).unwrap();
    let [before, after] =
        [&scene, &again].map(|s| s.environment.as_ref().unwrap().picture.texels());
    assert!(before == after && again.sky == scene.sky);
    open("cornell")
        .unwrap()
        .export(&dir.path().join("c.gltf"))
        .unwrap();
    assert!(!dir.path().join("c.sky.exr").exists());
}

#[test]
fn glb_and_gltf_keep_lights_cameras_and_motion() {
    let dir = folder();
    let configs = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/scenes");
    let mut scene = open(configs.join("workshop.ron")).unwrap();
    for (name, kind) in [
        (
            "panel",
            LightKind::Rectangle {
                width: 1.5,
                height: 0.25,
            },
        ),
        ("disc", LightKind::Disc { radius: 0.75 }),
    ] {
        scene.lights.push(Light {
            name: name.into(),
            kind,
            color: Vec3::new(3.0, 2.0, 1.0),
            direction: Vec3::new(0.6, 0.0, 0.8),
            up: Vec3::new(0.0, -1.0, 0.0),
            position: Vec3::new(1.0, 2.0, 3.0),
            ..Light::default()
        });
    }
    for file in ["w.glb", "w 2.gltf"] {
        let path = dir.path().join(file);
        scene.export(&path).unwrap();
        let again = open(&path).unwrap();
        assert_same_scene(&scene, &again);
        assert_eq!(scene.lights.len(), again.lights.len());
        for (a, b) in scene.lights.iter().zip(&again.lights) {
            // Extents grow with the node, and its rotation is rounded.
            let rounded = match b.kind {
                LightKind::Rectangle { width, height } => LightKind::Rectangle {
                    width: (width * 1e4).round() / 1e4,
                    height: (height * 1e4).round() / 1e4,
                },
                LightKind::Disc { radius } => LightKind::Disc {
                    radius: (radius * 1e4).round() / 1e4,
                },
                kind => kind,
            };
            assert_eq!((&a.name, a.kind), (&b.name, rounded));
            assert_near(a.color, b.color, 1e-4);
            assert_near(a.position, b.position, 1e-5);
            let directed = a.kind != LightKind::Point;
            assert!(!directed || a.direction.abs_diff_eq(b.direction, 1e-5));
            if matches!(a.kind, LightKind::Rectangle { .. }) {
                assert_near(a.up, b.up, 1e-5);
            }
        }
        for (name, a) in &scene.cameras {
            let b = &again.cameras[name];
            assert_near(a.eye, b.eye, 1e-5);
            assert_near(
                (a.target - a.eye).normalize(),
                (b.target - b.eye).normalize(),
                1e-4,
            );
            assert!((a.fov_y - b.fov_y).abs() < 1e-3 && a.near == b.near && a.far == b.far);
        }
        let moving = |s: &Scene| s.instances.iter().position(|i| i.mover.is_some()).unwrap();
        for time in [0.0, 0.7, 1.9, 3.3] {
            let a: Mat4 = scene.instance_transform(moving(&scene), time);
            assert!(
                a.abs_diff_eq(again.instance_transform(moving(&again), time), 1e-4),
                "at {time} s"
            );
        }
    }
    let leftovers = std::fs::read_dir(dir.path()).unwrap().filter(|e| {
        let name = e.as_ref().unwrap().file_name();
        !["w.glb", "w 2.gltf", "w 2.bin"].contains(&name.to_string_lossy().as_ref())
    });
    assert_eq!(leftovers.count(), 0, "no temporary files stay");
}

#[test]
fn export_errors_name_the_file() {
    let dir = folder();
    let scene = open("cornell").unwrap();
    let message = scene
        .export(&dir.path().join("a.ply"))
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("a.ply") && message.contains(".glb"),
        "{message}"
    );
    write(&dir, "file", "");
    let message = scene
        .export(&dir.path().join("file/a.obj"))
        .unwrap_err()
        .to_string();
    assert!(message.contains("writable"), "{message}");
}

fn longest_edge(scene: &Scene) -> f32 {
    let of = |t: [Vec3; 3]| {
        t[0].distance(t[1])
            .max(t[1].distance(t[2]))
            .max(t[2].distance(t[0]))
    };
    triangles(scene).into_iter().map(of).fold(0.0, f32::max)
}

/// Edges that only one triangle has, by position: in a closed surface there are none.
fn open_edges(scene: &Scene) -> usize {
    let mut edges: HashMap<[[u32; 3]; 2], i32> = HashMap::new();
    for t in triangles(scene) {
        let keys = t.map(|p| p.to_array().map(|c| (c + 0.0).to_bits()));
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            let (a, b) = (keys[a], keys[b]);
            *edges.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
        }
    }
    edges.values().filter(|&&count| count != 0).count()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn splitting_keeps_the_surface(edge in 0.05f32..1.5) {
        for name in ["white-sky", "furnace"] {
            let scene = open(name).unwrap();
            let split = scene.split_triangles(edge);
            prop_assert!(longest_edge(&split) <= edge * 1.0001);
            prop_assert!((area(&split) / area(&scene) - 1.0).abs() < 1e-4);
            prop_assert_eq!(split.bounds(), scene.bounds());
            prop_assert_eq!(open_edges(&split), 0);
        }
    }
}

#[test]
fn splitting_measures_in_the_world_and_has_limits() {
    let dir = folder();
    write(&dir, "quad.obj", QUAD);
    let text = "(models: [(file: \"quad.obj\", transform: (scale: (10, 1, 1)))])";
    let scene = open(write(&dir, "x.ron", text)).unwrap();
    let split = scene.split_triangles(0.5);
    assert!(longest_edge(&split) <= 0.5 && longest_edge(&split) > 0.2);
    assert!((area(&split) - 20.0).abs() < 1e-3);
    let uv_of = |s: &Scene| {
        s.meshes[0]
            .vertices
            .iter()
            .map(|v| v.position[0] - 2.0 * v.uv[0])
            .fold(0.0, f32::max)
    };
    assert!(
        uv_of(&split).abs() < 1e-5,
        "texture coordinates are interpolated"
    );
    for edge in [1e-6, 0.0, f32::NAN] {
        let same = scene.split_triangles(edge);
        assert_eq!(same.triangle_count(), 2);
        assert_warning(&same, &["not split"]);
    }
    // What it takes at least is known before, and never more than what it takes.
    for (scene, edge) in [
        (&scene, 0.5),
        (&scene, 0.05),
        (&open("triangles").unwrap(), 0.1),
    ] {
        let split = scene.split_triangles(edge);
        let bytes = split
            .meshes
            .iter()
            .map(|m| size_of_val(m.vertices.as_slice()))
            .sum::<usize>() as f64;
        let least = scene.least_split_bytes(edge);
        assert!(
            least <= bytes && least > 0.05 * bytes,
            "{least} of {bytes} at {edge}"
        );
    }
    let needles = open("triangles").unwrap().split_triangles(0.1);
    assert!(longest_edge(&needles) <= 0.1001);
}

#[test]
fn shuffling_permutes_triangles_inside_parts() {
    let scene = open("triangles").unwrap();
    let (shuffled, other) = (scene.shuffled(1), scene.shuffled(2));
    assert_ne!(scene.meshes, shuffled.meshes);
    assert_ne!(other.meshes, shuffled.meshes);
    assert_eq!(scene.shuffled(1).meshes, shuffled.meshes);
    for (a, b) in scene.meshes.iter().zip(&shuffled.meshes) {
        assert_eq!((&a.vertices, &a.submeshes), (&b.vertices, &b.submeshes));
        for submesh in &a.submeshes {
            let range =
                submesh.first_index as usize..(submesh.first_index + submesh.index_count) as usize;
            let sorted = |indices: &[u32]| {
                let mut triangles = indices.as_chunks::<3>().0.to_vec();
                triangles.sort();
                triangles
            };
            assert_eq!(sorted(&a.indices[range.clone()]), sorted(&b.indices[range]));
        }
    }
}

#[test]
fn real_scenes_where_present() {
    let shared = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/scenes");
    for (name, count, low, high) in [
        (
            "sponza",
            66_445,
            [-17.40276, -0.90669, -7.79851],
            [17.41724, 15.65331, 7.80149],
        ),
        (
            "living-room",
            143_163,
            [-0.51343, -0.00306, -3.63538],
            [5.12268, 2.87914, 0.59284],
        ),
    ] {
        let path = shared.join(name).join(format!("{name}.obj"));
        if !path.exists() {
            continue;
        }
        let scene = open(&path).unwrap();
        let dropped = count - scene.triangle_count();
        assert!(dropped < 200, "{name}: {dropped} of {count} dropped");
        assert_eq!(
            scene.warnings.len(),
            usize::from(dropped > 0),
            "{:?}",
            scene.warnings
        );
        assert_near(scene.bounds().0, Vec3::from(low), 1e-3);
        assert_near(scene.bounds().1, Vec3::from(high), 1e-3);
        assert_eq!(
            scene
                .materials
                .iter()
                .filter(|m| m.name != "default")
                .count(),
            19
        );
        let masked = scene
            .materials
            .iter()
            .filter(|m| m.alpha_cutoff > 0.0)
            .count();
        assert_eq!(masked, usize::from(name == "living-room"));
        let centre: DVec3 = triangles(&scene)
            .iter()
            .map(|t| (t[0] + t[1] + t[2]).as_dvec3())
            .sum();
        assert!(centre.is_finite());
    }
}

/// A single quad is what people try first. Its front is seen, whichever way it faces.
#[test]
fn flat_models_open_with_their_front_in_view() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("flat.obj");
    let (x, y, z) = (Vec3::X, Vec3::Y, Vec3::Z);
    for (right, up) in [(x, y), (-x, y), (z, y), (-z, y), (x, -z), (x, z)] {
        let corners = [-right - up, right - up, right + up, up - right];
        let lines: String = corners
            .iter()
            .map(|c| format!("v {} {} {}\n", c.x + 3.0, c.y, c.z))
            .collect();
        std::fs::write(&path, lines + "f 1 2 3 4\n").unwrap();
        let scene = Scene::open(&path.to_string_lossy(), &|_, _| {
            std::ops::ControlFlow::Continue(())
        })
        .unwrap();
        let (_, camera) = scene.cameras.first().unwrap();
        let to_eye = (camera.eye - camera.target).normalize();
        assert!(
            to_eye.dot(right.cross(up)) > 0.99,
            "{right} {up}: seen from {to_eye}"
        );
        // All of the quad, whose half edge is a metre.
        let away = (camera.eye - camera.target).length();
        assert!(
            away * (0.5 * camera.fov_y).to_radians().tan() > 1.0,
            "{right} {up}: {away} m"
        );
    }
}

#[test]
fn every_light_has_a_name_of_its_own() {
    let folder = folder();
    let light = |name: &str| {
        format!("Point(name: \"{name}\", color: (1, 1, 1), position: (0, 1, 0), shadow: false)")
    };
    let lights = ["lamp", "lamp", "lamp 2", "lamp"].map(light).join(", ");
    let lit = open(write(&folder, "lit.ron", format!("(lights: [{lights}])"))).unwrap();
    let names: Vec<&str> = lit.lights.iter().map(|l| l.name.as_str()).collect();
    assert_eq!(names, ["lamp", "lamp 2", "lamp 2 3", "lamp 4"]);
}
