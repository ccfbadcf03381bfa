//! Materials as glTF files have them: what is read of each extension, and that the method and the reference show the same of
//! it, which is what a formula says.

mod common;

use base64::Engine;
use common::{assert_clean, experiment, floats, lab, mean};
use conelab::experiment::{CameraChoice, Experiment, PlacedCamera};
use conelab::lab::Lab;
use conelab::measure::reference::{Goal, gather};
use conelab::scene::{Material, Scene};
use glam::{Vec3, Vec4};
use serde_json::{Value, json};
use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tempfile::TempDir;

const SIZE: (u32, u32) = (24, 24);

/// A square that faces z, for each material one, that many metres wide and at that z; a lamp that shines along -z with
/// irradiance pi. `change` may add textures, and what else a file has.
fn squares(
    folder: &Path,
    materials: &[(Value, f32, f32)],
    change: impl FnOnce(&mut Value),
) -> PathBuf {
    let corners: [f32; 20] = [
        -0.5, -0.5, 0., 0.5, -0.5, 0., 0.5, 0.5, 0., -0.5, 0.5, 0., 0., 1., 1., 1., 1., 0., 0., 0.,
    ];
    let mut bytes: Vec<u8> = corners.iter().flat_map(|f| f.to_le_bytes()).collect();
    bytes.extend([0u8, 1, 2, 0, 2, 3]);
    let data = base64::engine::general_purpose::STANDARD.encode(&bytes);
    let count = materials.len();
    let mut nodes: Vec<Value> = materials
        .iter()
        .enumerate()
        .map(|(i, (_, width, z))| json!({ "mesh": i, "translation": [0, 0, z], "scale": [width, width, 1] }))
        .collect();
    nodes.push(json!({ "extensions": { "KHR_lights_punctual": { "light": 0 } } }));
    let mesh = |i: usize| json!({ "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "indices": 2, "material": i }] });
    let mut root = json!({
        "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": (0..=count).collect::<Vec<_>>() }],
        "nodes": nodes,
        "meshes": (0..count).map(mesh).collect::<Vec<_>>(),
        "materials": materials.iter().map(|m| &m.0).collect::<Vec<_>>(),
        "extensions": { "KHR_lights_punctual": { "lights": [{ "type": "directional", "intensity": PI }] } },
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 4, "min": [-0.5, -0.5, 0], "max": [0.5, 0.5, 0] },
            { "bufferView": 1, "componentType": 5126, "type": "VEC2", "count": 4 },
            { "bufferView": 2, "componentType": 5121, "type": "SCALAR", "count": 6 },
        ],
        "bufferViews": [
            { "buffer": 0, "byteLength": 48 }, { "buffer": 0, "byteOffset": 48, "byteLength": 32 },
            { "buffer": 0, "byteOffset": 80, "byteLength": 6 },
        ],
        "buffers": [{ "byteLength": bytes.len(), "uri": format!("data:application/octet-stream;base64,{data}") }],
    });
    change(&mut root);
    let path = folder.join("squares.gltf");
    std::fs::write(&path, root.to_string()).unwrap();
    path
}

fn open(path: &Path) -> Scene {
    Scene::open(&path.to_string_lossy(), &|_, _| ControlFlow::Continue(())).unwrap()
}

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// An image of 2 x 2 texels as a file's images and textures have it.
fn add_texture(root: &mut Value, texels: [[u8; 4]; 4]) {
    let mut png = std::io::Cursor::new(Vec::new());
    image::RgbaImage::from_raw(2, 2, texels.concat())
        .unwrap()
        .write_to(&mut png, image::ImageFormat::Png)
        .unwrap();
    let uri = base64::engine::general_purpose::STANDARD.encode(png.into_inner());
    for list in ["images", "textures"] {
        let count = root[list].as_array().map_or(0, Vec::len);
        let entry = match list {
            "images" => json!({ "uri": format!("data:image/png;base64,{uri}") }),
            _ => json!({ "source": count }),
        };
        if count == 0 {
            root[list] = json!([]);
        }
        root[list].as_array_mut().unwrap().push(entry);
    }
}

/// The only material of a file that has it on a square.
fn read(material: Value, textures: &[[[u8; 4]; 4]]) -> (Material, Vec<String>) {
    let dir = folder();
    let scene = open(&squares(dir.path(), &[(material, 1.0, 0.0)], |root| {
        textures.iter().for_each(|t| add_texture(root, *t));
    }));
    (scene.materials[0].clone(), scene.warnings)
}

fn with(extensions: Value) -> Value {
    json!({ "name": "m", "extensions": extensions })
}

#[track_caller]
fn near(a: impl Into<Vec4>, b: impl Into<Vec4>) {
    let (a, b) = (a.into(), b.into());
    assert!(a.abs_diff_eq(b, 4e-3), "{a} is not {b}");
}

#[track_caller]
fn warns(warnings: &[String], pieces: &[&str]) {
    assert_eq!(warnings.len(), 1, "{warnings:#?}");
    assert!(
        pieces.iter().all(|piece| warnings[0].contains(piece)),
        "{pieces:?} not in {warnings:?}"
    );
}

#[test]
fn dielectrics_reflect_what_index_and_specular_say() {
    let none: [String; 0] = [];
    for (extensions, f0, f90) in [
        (json!({}), Vec3::splat(0.04), 1.0),
        (
            json!({ "KHR_materials_ior": { "ior": 1.5 }, "KHR_materials_specular": {} }),
            Vec3::splat(0.04),
            1.0,
        ),
        (
            json!({ "KHR_materials_ior": { "ior": 2 } }),
            Vec3::splat(1.0 / 9.0),
            1.0,
        ),
        (
            json!({ "KHR_materials_ior": { "ior": 1 } }),
            Vec3::ZERO,
            1.0,
        ),
        (json!({ "KHR_materials_ior": { "ior": 0 } }), Vec3::ONE, 1.0),
        (
            json!({ "KHR_materials_specular": { "specularFactor": 0.25 } }),
            Vec3::splat(0.01),
            0.25,
        ),
        (
            json!({ "KHR_materials_specular": { "specularColorFactor": [1, 0.5, 0] } }),
            Vec3::new(0.04, 0.02, 0.0),
            1.0,
        ),
        // What the colour makes more than all is all; the factor comes after that.
        (
            json!({ "KHR_materials_specular": { "specularColorFactor": [50, 1, 0], "specularFactor": 0.5 } }),
            Vec3::new(0.5, 0.02, 0.0),
            0.5,
        ),
    ] {
        let (material, warnings) = read(with(extensions), &[]);
        assert_eq!(warnings, none);
        let found = material.dielectric();
        assert!(
            found.abs_diff_eq(f0.extend(f90), 1e-7),
            "{found} is not {f0} and {f90}"
        );
    }
    assert_eq!(
        Material::default().dielectric().to_array(),
        [0.04, 0.04, 0.04, 1.0],
        "to the bit"
    );
    // Textures count with their mean: alpha 128 of the one, sRGB 188 of the other.
    let textured = json!({ "KHR_materials_specular": {
        "specularTexture": { "index": 0 }, "specularColorTexture": { "index": 1 }, "specularColorFactor": [1, 1, 0.5] } });
    let stripes = [[0, 0, 0, 255], [255; 4], [0, 0, 0, 255], [255; 4]];
    let (material, warnings) = read(with(textured), &[[[9, 9, 9, 128]; 4], stripes]);
    warns(&warnings, &["'m'", "KHR_materials_specular", "mean"]);
    near(
        material.specular_color.extend(material.specular),
        [0.5, 0.5, 0.25, 0.5],
    );
}

#[test]
fn emission_has_its_strength_and_unlit_its_base_colour() {
    let lamp = json!({ "emissiveFactor": [1, 0.5, 0], "extensions": {
        "KHR_materials_emissive_strength": { "emissiveStrength": 40 } } });
    assert_eq!(read(lamp, &[]).0.emission, Vec3::new(40.0, 20.0, 0.0));
    let sign = json!({ "emissiveFactor": [1, 1, 1], "alphaMode": "MASK", "pbrMetallicRoughness": {
        "baseColorFactor": [0.5, 0.25, 1, 1], "metallicFactor": 1, "baseColorTexture": { "index": 0 } },
        "extensions": { "KHR_materials_unlit": {} } });
    let (sign, warnings) = read(sign, &[[[255; 4]; 4]]);
    assert!(warnings.is_empty());
    assert_eq!(sign.emission, Vec3::new(0.5, 0.25, 1.0));
    assert_eq!(
        (sign.base_color, sign.metallic, sign.dielectric()),
        (Vec4::W, 0.0, Vec4::ZERO)
    );
    assert!(
        sign.emission_texture.is_some() && sign.emission_texture == sign.base_color_texture,
        "the mask stays"
    );
}

#[test]
fn surfaces_that_let_light_through_are_there_or_not() {
    let glass =
        |share: f32| with(json!({ "KHR_materials_transmission": { "transmissionFactor": share } }));
    let dielectric = |mut m: Value| {
        m["pbrMetallicRoughness"] =
            json!({ "metallicFactor": 0, "baseColorFactor": [0.5, 1, 1, 1] });
        m
    };
    let (dark, warnings) = read(dielectric(glass(0.4)), &[]);
    warns(&warnings, &["'m, 0.40'", "opaque"]);
    near(dark.base_color, [0.3, 0.6, 0.6, 1.0]);
    assert!(!dark.is_left_out());
    let (clear, warnings) = read(dielectric(glass(0.9)), &[]);
    warns(&warnings, &["'m, 0.90'", "left out"]);
    assert!(clear.is_left_out());
    // Metals let nothing through; the texture's red counts with its mean.
    assert!(read(glass(1.0), &[]).1.is_empty());
    let mut frosted = dielectric(glass(1.0));
    frosted["extensions"]["KHR_materials_transmission"]["transmissionTexture"] =
        json!({ "index": 0 });
    let (frosted, _) = read(frosted, &[[[51, 255, 255, 255]; 4]]);
    near(frosted.base_color, [0.4, 0.8, 0.8, 1.0]);
    let blend = |alpha: f32| {
        let m = json!({ "name": "m", "alphaMode": "BLEND", "pbrMetallicRoughness": { "baseColorFactor": [1, 1, 1, alpha] } });
        read(m, &[])
    };
    let ((thick, mask), (thin, gone)) = (blend(0.6), blend(0.3));
    warns(&mask, &["'m'", "masks at alpha 0.5"]);
    warns(&gone, &["'m, 0.30'", "left out"]);
    assert!(!thick.is_left_out() && thin.is_left_out());
}

#[test]
fn obj_opacity_is_there_or_not() {
    let dir = folder();
    let quad = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\n";
    let mtl = "newmtl thin\nd 0.3\nnewmtl thick\nTr 0.2\nnewmtl full\nd 1\nTr 0.9\n";
    std::fs::write(dir.path().join("a.mtl"), mtl).unwrap();
    let obj = format!(
        "mtllib a.mtl\n{quad}usemtl thin\nf 1 2 3\nusemtl thick\nf 1 2 4\nusemtl full\nf 2 3 4\n"
    );
    std::fs::write(dir.path().join("a.obj"), obj).unwrap();
    let scene = open(&dir.path().join("a.obj"));
    assert_eq!(scene.triangle_count(), 2, "the thin one is left out");
    assert_eq!(scene.warnings.len(), 2, "{:?}", scene.warnings);
    for pieces in [
        ["'thin'", "0.30", "left out"],
        ["'thick'", "0.80", "opaque"],
    ] {
        assert!(
            scene
                .warnings
                .iter()
                .any(|w| pieces.iter().all(|p| w.contains(p))),
            "{pieces:?} {:?}",
            scene.warnings
        );
    }
}

#[test]
fn specular_glossiness_becomes_a_dielectric_of_that_colour() {
    let gold = with(json!({ "KHR_materials_pbrSpecularGlossiness": {
        "diffuseFactor": [0.5, 0.5, 0.5, 1], "specularFactor": [1, 0.6, 0.2], "glossinessFactor": 0.75 } }));
    let (gold, warnings) = read(gold, &[]);
    assert!(warnings.is_empty());
    near(gold.dielectric(), [1.0, 0.6, 0.2, 1.0]);
    near(gold.base_color, Vec4::W);
    assert_eq!((gold.metallic, gold.roughness), (0.0, 0.25));
    let mapped = with(json!({ "KHR_materials_pbrSpecularGlossiness": {
        "diffuseTexture": { "index": 0 }, "specularGlossinessTexture": { "index": 1 }, "glossinessFactor": 0.5 } }));
    let dir = folder();
    let scene = open(&squares(dir.path(), &[(mapped, 1.0, 0.0)], |root| {
        add_texture(root, [[255; 4]; 4]);
        add_texture(root, [[188, 188, 188, 204]; 4]);
    }));
    warns(
        &scene.warnings,
        &["'m'", "KHR_materials_pbrSpecularGlossiness", "mean"],
    );
    let mapped = &scene.materials[0];
    near(mapped.dielectric(), [0.5, 0.5, 0.5, 1.0]);
    near(mapped.base_color, [0.5, 0.5, 0.5, 1.0]);
    let texel = |t: Option<u32>| scene.textures[t.unwrap() as usize].mips[0][..4].to_vec();
    assert_eq!(texel(mapped.base_color_texture), [255; 4]);
    // Glossiness 0.8 of a half: 0.4.
    assert_eq!(
        (
            texel(mapped.metallic_roughness_texture)[1],
            mapped.roughness
        ),
        (153, 1.0)
    );
}

#[test]
fn what_is_left_out_is_told_once_and_what_is_required_is_an_error() {
    let fancy = with(json!({
        "KHR_materials_clearcoat": { "clearcoatFactor": 1 }, "KHR_materials_sheen": { "sheenColorFactor": [0, 0, 0] },
        "KHR_materials_iridescence": {} }));
    warns(
        &read(fancy, &[]).1,
        &["'m'", "KHR_materials_clearcoat", "left out"],
    );
    let dir = folder();
    let required = |extension: &str| {
        let path = squares(dir.path(), &[(json!({}), 1.0, 0.0)], |root| {
            root["extensionsUsed"] = json!([extension, "KHR_lights_punctual"]);
            root["extensionsRequired"] = json!([extension]);
        });
        Scene::open(&path.to_string_lossy(), &|_, _| ControlFlow::Continue(()))
    };
    for supported in [
        "ior",
        "specular",
        "unlit",
        "transmission",
        "pbrSpecularGlossiness",
        "emissive_strength",
    ] {
        assert!(
            required(&format!("KHR_materials_{supported}")).is_ok(),
            "{supported}"
        );
    }
    assert!(required("KHR_materials_clearcoat").is_err());
    let alone = json!({ "normalTexture": { "index": 0, "extensions": { "KHR_texture_transform": { "scale": [3, 3] } } } });
    let scene = open(&squares(dir.path(), &[(alone, 1.0, 0.0)], |root| {
        add_texture(root, [[128, 128, 255, 255]; 4])
    }));
    assert!(
        scene.warnings.is_empty() && scene.meshes[0].vertices.iter().any(|v| v.uv == [3.0, 3.0])
    );
}

#[test]
fn exported_files_have_the_same_dielectrics() {
    let dir = folder();
    let materials = [
        with(
            json!({ "KHR_materials_ior": { "ior": 1.33 }, "KHR_materials_specular": {
            "specularFactor": 0.75, "specularColorFactor": [1, 0.5, 0.25] } }),
        ),
        with(json!({ "KHR_materials_unlit": {} })),
        with(json!({})),
    ];
    let placed: Vec<(Value, f32, f32)> = materials.into_iter().map(|m| (m, 1.0, 0.0)).collect();
    let scene = open(&squares(dir.path(), &placed, |_| {}));
    let hash = |s: &Scene| conelab::results::capture::scene_hash(s);
    for file in ["a.glb", "b.gltf", "c.obj"] {
        scene.export(&dir.path().join(file)).unwrap();
        let again = open(&dir.path().join(file));
        assert_eq!(again.warnings, scene.warnings);
        for (a, b) in scene.materials.iter().zip(&again.materials) {
            assert_eq!(
                (a.dielectric(), a.emission),
                (b.dielectric(), b.emission),
                "{file}"
            );
            assert_eq!(
                (a.ior, a.specular, a.specular_color),
                (b.ior, b.specular, b.specular_color),
                "{file}"
            );
        }
    }
    let mut other = scene.clone();
    other.materials[2].ior = 1.6;
    assert_ne!(hash(&scene), hash(&other));
    assert!(
        scene.summary().contains("reflects [0.015, 0.008, 0.004]"),
        "{}",
        scene.summary()
    );
}

/// The method's picture of a part of the light, the reference's, or both.
fn views(
    scene: &Scene,
    settings: &[(&str, &str)],
    frames: usize,
) -> (Lab, Experiment, Arc<Scene>, usize) {
    let defaults = [("voxel_dim", "32"), ("shadow_dim", "256")];
    let mut e = experiment("cornell", SIZE, &[&defaults[..], settings].concat());
    e.camera = CameraChoice::Placed(PlacedCamera::new((0.0, 0.0, 2.0), (0.0, 0.0, 0.0), 20.0));
    (lab(common::root()), e, Arc::new(scene.clone()), frames)
}

/// Texels of one of the method's textures.
fn method(
    (lab, e, scene, frames): &(Lab, Experiment, Arc<Scene>, usize),
    texture: &str,
) -> Vec<[f32; 4]> {
    let (mut session, _) = lab
        .prepare(e, scene.clone(), |_| Ok(vec![texture.to_owned()]))
        .unwrap();
    session.run(*frames).unwrap();
    session.finish().unwrap();
    assert_clean(lab);
    floats(&mut session, texture, 0)
}

/// Of one part of the reference.
fn reference(
    (_, e, scene, _): &(Lab, Experiment, Arc<Scene>, usize),
    part: &str,
    samples: u64,
) -> Vec<[f32; 3]> {
    let home = common::home();
    let lab = lab(home.path());
    let found = gather(&lab, e, scene, 1, Goal::Samples(samples), &mut |_| {
        ControlFlow::Continue(())
    })
    .unwrap();
    assert_clean(&lab);
    found.parts[part].mean.rgb.clone()
}

fn centre<const N: usize>(texels: &[[f32; N]]) -> [f64; 3] {
    let middle = texels[(SIZE.0 * (SIZE.1 / 2) + SIZE.0 / 2) as usize];
    [0, 1, 2].map(|i| f64::from(middle[i]))
}

/// A square in the light of the lamp behind the camera, and the sky's radiance.
fn lit(material: Value, sky: f32) -> Scene {
    let dir = folder();
    let mut scene = open(&squares(dir.path(), &[(material, 1.0, 0.0)], |_| {}));
    scene.sky = Vec3::splat(sky);
    scene
}

#[test]
fn specular_light_is_what_the_formula_says() {
    // Seen and lit along the normal: D F / 4 of GGX with alpha 1/4, times irradiance pi.
    let lobe = 1.0 / (PI * 0.25f64.powi(4)) * 0.25f64.powi(2) / 4.0 * PI;
    // Light that is scattered more than once, and what is left to the diffuse base.
    let single = common::ggx::directional_albedo(1.0, 0.5);
    let surface = |metallic: f32, color: [f32; 3], extensions: Value| {
        json!({ "pbrMetallicRoughness": { "baseColorFactor": [color[0], color[1], color[2], 1], "metallicFactor": metallic,
            "roughnessFactor": 0.5 }, "extensions": extensions })
    };
    let black = [0.0; 3];
    let ior = json!({ "KHR_materials_ior": { "ior": 2 } });
    for (what, material, albedo, f0) in [
        ("default", surface(0.0, black, json!({})), 0.0, [0.04; 3]),
        (
            "ior 2",
            surface(0.0, black, ior.clone()),
            0.0,
            [1.0 / 9.0; 3],
        ),
        (
            "ior 2, half a metal",
            surface(0.5, [0.5; 3], ior),
            0.25,
            [0.5 / 9.0 + 0.25; 3],
        ),
        (
            "specular",
            surface(
                0.0,
                black,
                json!({ "KHR_materials_specular": {
                "specularFactor": 0.5, "specularColorFactor": [10, 5, 1] } }),
            ),
            0.0,
            [0.2, 0.1, 0.02],
        ),
    ] {
        let scene = lit(material, 0.0);
        let expected = f0.map(|f| {
            let multiple = 1.0 + f * (1.0 / (single.0 + single.1) - 1.0);
            albedo * (1.0 - (f * single.0 + single.1) * multiple) + lobe * f * multiple
        });
        let mut found = vec![(
            "reference",
            centre(&reference(&views(&scene, &[], 1), "direct", 4)),
        )];
        for gbuffer in ["raster", "compute"] {
            found.push((
                gbuffer,
                centre(&method(
                    &views(&scene, &[("gbuffer", gbuffer)], 1),
                    "direct",
                )),
            ));
        }
        for (by, found) in found {
            println!("{what}, {by}: {found:.4?} of {expected:.4?}");
            let far = found
                .iter()
                .zip(&expected)
                .any(|(a, b)| (a - b).abs() > 0.004 * b + 1e-4);
            assert!(!far, "{what}, {by}: {found:?} is not {expected:?}");
        }
    }
}

#[test]
fn reflected_sky_is_the_same_in_method_and_reference() {
    let mut last = 0.0;
    for (what, extensions) in [
        ("default", json!({})),
        ("ior 2", json!({ "KHR_materials_ior": { "ior": 2 } })),
        (
            "ior 0, specular 0.5",
            json!({ "KHR_materials_ior": { "ior": 0 }, "KHR_materials_specular": { "specularFactor": 0.5 } }),
        ),
    ] {
        let surface = json!({ "pbrMetallicRoughness": {
            "baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0, "roughnessFactor": 0.5 }, "extensions": extensions });
        let views = views(&lit(surface, 1.0), &[], 20);
        let cones = mean(&method(&views, "specularIndirect"));
        let traced = reference(&views, "specular", 256);
        let traced =
            traced.iter().flatten().map(|v| f64::from(*v)).sum::<f64>() / (3 * traced.len()) as f64;
        println!("{what}: {cones:.4}, traced {traced:.4}");
        assert!(
            (cones / traced - 1.0).abs() < 0.03,
            "{what}: {cones} and {traced}"
        );
        assert!(traced > 1.5 * last, "{what}: {traced} after {last}");
        last = traced;
    }
}

#[test]
fn unlit_surfaces_have_their_base_colour_in_any_light() {
    let color = [0.75, 0.25, 0.0625];
    let sign = json!({ "pbrMetallicRoughness": { "baseColorFactor": [color[0], color[1], color[2], 1] },
        "extensions": { "KHR_materials_unlit": {} } });
    let mut views = views(&lit(sign, 1.0), &[], 2);
    // Nearly edge-on, where everything else mirrors.
    views.1.camera = CameraChoice::Placed(PlacedCamera::new((1.0, 0.0, 0.1), (0.0, 0.0, 0.0), 2.0));
    let (shown, traced) = (
        centre(&method(&views, "radiance")),
        centre(&reference(&views, "total", 4)),
    );
    println!("{shown:?}, traced {traced:?}");
    assert_eq!(shown, color.map(f64::from));
    assert_eq!(traced, color.map(f64::from));
}

#[test]
fn a_clear_pane_before_a_lamp_hides_nothing() {
    let lamp = json!({ "emissiveFactor": [1, 0.5, 0.25], "pbrMetallicRoughness": { "metallicFactor": 0 } });
    let pane = json!({ "extensions": { "KHR_materials_transmission": { "transmissionFactor": 1 } },
        "pbrMetallicRoughness": { "metallicFactor": 0 } });
    let dir = folder();
    let scene = |list: &[(Value, f32, f32)]| {
        let mut scene = open(&squares(dir.path(), list, |_| {}));
        scene.sky = Vec3::ZERO;
        scene
    };
    let open = scene(&[(lamp.clone(), 1.0, 0.0)]);
    let mut masked = scene(&[(lamp.clone(), 1.0, 0.0), (json!({}), 0.8, 0.5)]);
    masked.materials[1] = Material {
        base_color: Vec4::ZERO,
        alpha_cutoff: 0.5,
        ..Material::default()
    };
    let closed = scene(&[(lamp, 1.0, 0.0), (pane, 0.8, 0.5)]);
    let picture = |scene: &Scene| {
        let views = views(scene, &[], 2);
        (
            centre(&method(&views, "radiance")),
            centre(&reference(&views, "total", 4)),
        )
    };
    let expected = picture(&open);
    assert!(expected.0[0] > 1.0, "the lamp is seen, in light");
    assert_eq!(picture(&closed), expected);
    // What a file does not have, a scene may: a mask that cuts everything out.
    let masked = picture(&masked);
    assert!(
        (0..3).all(|i| (masked.0[i] / expected.0[i] - 1.0).abs() < 0.01),
        "{masked:?} {expected:?}"
    );
    assert_eq!(masked.1, expected.1);
}
