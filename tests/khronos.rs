//! Khronos' sample models, rebuilt small: each row is a model and the property that the sample tests, as numbers that
//! follow from the specification (glTF 2.0 and its extensions).

mod common;

use common::model_file::*;
use conelab::scene::{LightKind, Lookup, Lookups, Scene, Texture, TextureFormat, Vertex, Wrap};
use glam::{Vec2, Vec3, Vec4};
use serde_json::{Value, json};
use std::f32::consts::FRAC_PI_2;

/// A name, what builds the model, and what must hold of it.
type Row = (&'static str, fn(&mut Model), fn(&Scene));

const ROWS: &[Row] = &[
    ("TriangleWithoutNormals", bent, |s| {
        // Two faces that meet at 40 degrees: three corners each have the normal of their face.
        let normals: Vec<Vec3> = corner_normals(s);
        let tilted = Vec3::new(40f32.to_radians().sin(), 0.0, 40f32.to_radians().cos());
        for (i, normal) in normals.iter().enumerate() {
            near(*normal, if i < 3 { Vec3::Z } else { tilted }, 1e-5);
        }
    }),
    (
        "NormalsGiven",
        |m| {
            let mesh = m.square(json!({ "NORMAL": null }), None);
            let leaning = m.floats(&[[0.6, 0.0, 0.8]; 6]);
            m.root["meshes"][mesh]["primitives"][0]["attributes"]["NORMAL"] = json!(leaning);
            m.node(json!({ "mesh": mesh }));
        },
        |s| {
            corner_normals(s)
                .into_iter()
                .for_each(|n| near(n, Vec3::new(0.6, 0.0, 0.8), 1e-6))
        },
    ),
    (
        "NoMaterial",
        |m| placed_square(m, None, json!({})),
        |s| {
            let material = &s.materials[s.meshes[0].submeshes[0].material as usize];
            assert_eq!(
                (material.metallic, material.roughness, material.base_color),
                (1.0, 1.0, Vec4::ONE)
            );
        },
    ),
    (
        "AlphaBlendModeTest",
        |m| {
            for material in [
                json!({ "alphaMode": "OPAQUE", "alphaCutoff": 0.75 }),
                json!({ "alphaMode": "BLEND" }),
                json!({ "alphaMode": "MASK", "alphaCutoff": 0.25 }),
                json!({ "alphaMode": "MASK" }),
                json!({ "alphaMode": "MASK", "alphaCutoff": 0.75 }),
                json!({ "alphaMode": "MASK", "alphaCutoff": 1e39 }),
            ] {
                let material = m.material(material);
                placed_square(m, Some(material), json!({}));
            }
        },
        |s| {
            let cutoffs: Vec<f32> = s.materials.iter().map(|m| m.alpha_cutoff).collect();
            // Numbers beyond the largest one stay finite: an export must be able to write them.
            assert_eq!(cutoffs, [0.0, 0.5, 0.25, 0.5, 0.75, 2.0]);
            warned(s, "blend are shown as masks", 1);
        },
    ),
    (
        "AlphaCutoffAboveOne",
        |m| {
            let material = m.material(json!({ "alphaMode": "MASK", "alphaCutoff": 2 }));
            placed_square(m, Some(material), json!({}));
        },
        |s| {
            assert_eq!(s.triangle_count(), 0);
            warned(s, "alphaCutoff above 1", 1);
        },
    ),
    (
        "UnlitTest",
        |m| {
            let unlit = json!({ "pbrMetallicRoughness": { "baseColorFactor": [1, 0.2, 0.1, 1] },
                "extensions": { "KHR_materials_unlit": {} } });
            let material = m.material(unlit);
            placed_square(m, Some(material), json!({}));
        },
        |s| {
            let material = &s.materials[0];
            assert_eq!(
                (material.emission, material.base_color.truncate()),
                (Vec3::new(1.0, 0.2, 0.1), Vec3::ZERO)
            );
            assert_eq!(material.specular, 0.0);
        },
    ),
    (
        "EmissiveStrengthTest",
        |m| {
            for strength in [1, 2, 4, 8, 16] {
                let material = m.material(json!({ "emissiveFactor": [0.1, 0.5, 0.9],
                    "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": strength } } }));
                placed_square(m, Some(material), json!({}));
            }
        },
        |s| {
            for (i, material) in s.materials.iter().enumerate() {
                near(
                    material.emission,
                    Vec3::new(0.1, 0.5, 0.9) * f32::from(1u8 << i),
                    1e-5,
                );
            }
        },
    ),
    (
        "CompareIor",
        |m| {
            let material =
                m.material(json!({ "extensions": { "KHR_materials_ior": { "ior": 2 } } }));
            placed_square(m, Some(material), json!({}));
        },
        |s| assert!((s.materials[0].dielectric().x - 1.0 / 9.0).abs() < 1e-6),
    ),
    (
        "NegativeScaleTest",
        |m| placed_square(m, None, json!({ "scale": [-1, 1, 1] })),
        |s| {
            let node = s.instances[0].transform;
            assert!((node.determinant() + 1.0).abs() < 1e-6);
            near(
                node.transform_point3(Vec3::new(0.25, 0.5, 0.0)),
                Vec3::new(-0.25, 0.5, 0.0),
                1e-6,
            );
        },
    ),
    (
        "OrientationTest",
        |m| {
            // A quarter about y by a quaternion, below a quarter about x by a matrix.
            let half = FRAC_PI_2.sin() / 2f32.sqrt();
            let mesh = m.square(json!({}), None);
            let child = m.push(
                "nodes",
                json!({ "mesh": mesh, "rotation": [0, half, 0, half], "translation": [1, 2, 3], "scale": [2, 2, 2] }),
            );
            m.node(json!({ "children": [child], "matrix": [1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1] }));
        },
        |s| {
            // x goes to -z about y, scaled and moved to (1, 2, 1); (x, y, z) goes to (x, -z, y) about x.
            near(
                s.instances[0].transform.transform_point3(Vec3::X),
                Vec3::new(1.0, -1.0, 2.0),
                1e-5,
            );
            near(
                s.instances[0].transform.transform_point3(Vec3::Z),
                Vec3::new(3.0, -3.0, 2.0),
                1e-5,
            );
        },
    ),
    (
        "BoxInterleaved",
        |m| {
            let rows: Vec<u8> = SQUARE
                .iter()
                .flat_map(|p| [*p, [0.0, 0.6, 0.8]].concat())
                .flat_map(|f: f32| f.to_le_bytes())
                .collect();
            let view = m.view(&rows);
            m.root["bufferViews"][view]["byteStride"] = json!(24);
            let accessor = |offset: usize| {
                json!({ "bufferView": view, "byteOffset": offset, "componentType": FLOAT,
                "type": "VEC3", "count": 6, "min": [-1, -1, 0], "max": [1, 1, 0] })
            };
            let (positions, normals) = (
                m.push("accessors", accessor(0)),
                m.push("accessors", accessor(12)),
            );
            let mesh = m.mesh(json!({ "POSITION": positions, "NORMAL": normals }), None);
            m.node(json!({ "mesh": mesh }));
        },
        |s| {
            assert_eq!(
                s.bounds(),
                (Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, 1.0, 0.0))
            );
            corner_normals(s)
                .into_iter()
                .for_each(|n| near(n, Vec3::new(0.0, 0.6, 0.8), 1e-6));
        },
    ),
    (
        "MeshPrimitiveModes",
        |m| {
            // Points, lines, a strip and a fan over four corners of a square of area 4.
            let corners = [[-1., -1., 0.], [1., -1., 0.], [-1., 1., 0.], [1., 1., 0.]];
            let fan = [corners[0], corners[1], corners[3], corners[2]];
            let (strip, fan) = (m.floats(&corners), m.floats(&fan));
            for (mode, positions) in [(0, strip), (1, strip), (5, strip), (6, fan)] {
                let mesh = m.mesh(json!({ "POSITION": positions }), None);
                m.root["meshes"][mesh]["primitives"][0]["mode"] = json!(mode);
                m.node(json!({ "mesh": mesh }));
            }
        },
        |s| {
            assert!((area(s) - 8.0).abs() < 1e-5, "{}", area(s));
            corner_normals(s)
                .into_iter()
                .for_each(|n| near(n, Vec3::Z, 1e-6));
            warned(s, "points and lines are left out ('mesh 0', 'mesh 1')", 1);
        },
    ),
    (
        "SimpleSparseAccessor",
        |m| {
            let positions = m.floats(&SQUARE);
            let (place, value) = (
                m.view(&[4, 0]),
                m.view(&[2.0f32, 3.0, 0.0].map(f32::to_le_bytes).concat()),
            );
            m.root["accessors"][positions]["sparse"] = json!({ "count": 1,
                "indices": { "bufferView": place, "componentType": U16 }, "values": { "bufferView": value } });
            let mesh = m.mesh(json!({ "POSITION": positions }), None);
            m.node(json!({ "mesh": mesh }));
        },
        |s| assert_eq!(s.bounds().1, Vec3::new(2.0, 3.0, 0.0)),
    ),
    (
        "PositionWithoutBounds",
        |m| {
            placed_square(m, None, json!({}));
            for accessor in m.root["accessors"].as_array_mut().unwrap() {
                accessor
                    .as_object_mut()
                    .unwrap()
                    .retain(|key, _| key != "min" && key != "max");
            }
        },
        |s| {
            assert_eq!(
                s.bounds(),
                (Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, 1.0, 0.0))
            )
        },
    ),
    (
        "SimpleInstancing",
        |m| {
            let places: Vec<[f32; 3]> = (0..125u8)
                .map(|i| [i % 5, i / 5 % 5, i / 25].map(|k| f32::from(k) * 3.0))
                .collect();
            let translation = m.floats(&places);
            placed_square(m, None, instanced(json!({ "TRANSLATION": translation })));
        },
        |s| {
            assert_eq!((s.instances.len(), s.triangle_count()), (125, 250));
            near(
                s.instances[124].transform.transform_point3(Vec3::ZERO),
                Vec3::splat(12.0),
                1e-6,
            );
            assert_eq!(s.warnings, [""; 0]);
        },
    ),
    (
        "InstancingOfAllKinds",
        |m| {
            // A quarter about z in bytes and in 16 bits, and no turn.
            let (byte, short) = (
                (0.5f32.sqrt() * 127.0).round() as i8,
                (0.5f32.sqrt() * 32767.0).round() as i16,
            );
            let bytes: Vec<u8> = [0, 0, byte, byte, 0, 0, 0, 127]
                .iter()
                .map(|v: &i8| *v as u8)
                .collect();
            let shorts: Vec<u8> = [0, 0, short, short, 0, 0, 0, i16::MAX]
                .iter()
                .flat_map(|v: &i16| v.to_le_bytes())
                .collect();
            let translation = m.floats(&[[5., 0., 0.], [0., 7., 0.]]);
            let scale = m.floats(&[[2., 3., 4.], [1., 1., 1.]]);
            for (component, bytes) in [(I8, bytes), (I16, shorts)] {
                let rotation = m.raw(component, "VEC4", 2, &bytes, json!({ "normalized": true }));
                let attributes =
                    json!({ "TRANSLATION": translation, "ROTATION": rotation, "SCALE": scale });
                let mut node = instanced(attributes);
                node["translation"] = json!([0, 0, 1]);
                placed_square(m, None, node);
            }
        },
        |s| {
            assert_eq!(s.instances.len(), 4);
            for i in [0, 2] {
                let turned = s.instances[i].transform;
                near(
                    turned.transform_point3(Vec3::X),
                    Vec3::new(5.0, 2.0, 1.0),
                    1e-4,
                );
                near(
                    turned.transform_point3(Vec3::Y),
                    Vec3::new(2.0, 0.0, 1.0),
                    1e-4,
                );
                near(
                    s.instances[i + 1].transform.transform_point3(Vec3::X),
                    Vec3::new(1.0, 7.0, 1.0),
                    1e-4,
                );
            }
        },
    ),
    (
        "NodeVisibility",
        |m| {
            let hidden = || json!({ "KHR_node_visibility": { "visible": false } });
            let light = lamp(m, json!({ "type": "point", "intensity": 3 }));
            let camera = camera(m);
            let mesh = m.square(json!({}), None);
            let seen = json!({ "KHR_node_visibility": { "visible": true } });
            let child = m.push(
                "nodes",
                json!({ "mesh": mesh, "extensions": seen, "translation": [9, 0, 0] }),
            );
            let lamp = m.push(
                "nodes",
                json!({ "extensions": { "KHR_lights_punctual": { "light": light } } }),
            );
            m.node(json!({ "mesh": mesh, "extensions": hidden(), "children": [child, lamp], "camera": camera }));
            m.node(json!({ "mesh": mesh, "translation": [0, 0, 5] }));
        },
        |s| {
            assert_eq!(s.instances.len(), 1);
            assert_eq!(s.bounds().0, Vec3::new(-1.0, -1.0, 5.0));
            // The lamp went, so the scene has its own; cameras of invisible nodes stay.
            assert!(
                s.lights
                    .iter()
                    .all(|light| light.kind == LightKind::Directional)
                    && s.cameras.len() == 2
            );
            warned(s, "invisible nodes (KHR_node_visibility) are left out", 1);
        },
    ),
    (
        "MaterialsVariantsShoe",
        |m| {
            m.root["extensionsRequired"] = json!(["KHR_materials_variants"]);
            m.root["extensionsUsed"] = json!(["KHR_materials_variants"]);
            m.root["extensions"]["KHR_materials_variants"] =
                json!({ "variants": [{ "name": "Street" }, { "name": "Beach" }] });
            let (red, blue) = (paint(m, [1., 0., 0., 1.]), paint(m, [0., 0., 1., 1.]));
            placed_square(m, Some(red), json!({}));
            m.root["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"] =
                json!({ "mappings": [{ "material": blue, "variants": [0, 1] }] });
        },
        |s| {
            let material = &s.materials[s.meshes[0].submeshes[0].material as usize];
            assert_eq!(material.base_color, Vec4::new(1.0, 0.0, 0.0, 1.0));
            warned(s, "'Street', 'Beach'", 1);
        },
    ),
    (
        "UnusedTextureOfNoImage",
        |m| {
            m.push("textures", json!({ "source": 7 }));
            placed_square(m, None, json!({}));
        },
        |s| assert_eq!((s.textures.len(), s.warnings.len()), (0, 0)),
    ),
    (
        "UsedTextureOfNoImage",
        |m| {
            let texture = m.push("textures", json!({ "source": 7 }));
            let material = m.material(
                json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": texture } } }),
            );
            placed_square(m, Some(material), json!({}));
        },
        |s| {
            assert_eq!(s.textures.len(), 1);
            warned(s, "checkerboard", 1);
        },
    ),
    (
        "WebP",
        |m| {
            let webp = encoded(
                2,
                1,
                &[[255, 0, 0, 255], [0, 128, 255, 255]],
                image::ImageFormat::WebP,
            );
            let image = m.push("images", json!({ "uri": data_uri(&webp) }));
            m.root["extensionsRequired"] = json!(["EXT_texture_webp"]);
            let texture = m.push(
                "textures",
                json!({ "extensions": { "EXT_texture_webp": { "source": image } } }),
            );
            let material = m.material(
                json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": texture } } }),
            );
            placed_square(m, Some(material), json!({}));
        },
        |s| {
            assert_eq!(s.textures[0].mips[0], [255, 0, 0, 255, 0, 128, 255, 255]);
            assert_eq!(s.warnings, [""; 0]);
        },
    ),
    (
        "LightsPunctualLamp",
        |m| {
            let light = lamp(
                m,
                json!({ "type": "spot", "intensity": 10, "color": [1, 0.5, 0.25],
                "spot": { "innerConeAngle": 0.2, "outerConeAngle": 0.4 } }),
            );
            m.node(json!({ "extensions": { "KHR_lights_punctual": { "light": light } }, "translation": [1, 2, 3] }));
            placed_square(m, None, json!({}));
        },
        |s| {
            let light = &s.lights[0];
            assert_eq!(
                (s.lights.len(), light.color),
                (1, Vec3::new(10.0, 5.0, 2.5))
            );
            assert_eq!(
                (light.position, light.direction),
                (Vec3::new(1.0, 2.0, 3.0), Vec3::NEG_Z)
            );
            assert_eq!(
                light.kind,
                LightKind::Spot {
                    inner: 0.2,
                    outer: 0.4
                }
            );
            // It is the only light: there is no sky.
            assert_eq!((s.sky, s.warnings.len()), (Vec3::ZERO, 0));
        },
    ),
    // The example of the draft, and a scaled node: sizes grow by its largest scale.
    (
        "LightsArea",
        |m| {
            m.root["extensionsUsed"] = json!(["EXT_lights_area"]);
            m.root["extensions"] = json!({ "EXT_lights_area": { "lights": [
                { "color": [1, 1, 1], "intensity": 100, "type": "rect", "size": 1, "rect": { "aspect": 2 } },
                { "color": [1, 0.5, 0.25], "intensity": 8, "type": "disk", "size": 1.5 },
                { "type": "sphere" }, { "type": "disk", "size": 0 },
            ] } });
            let half = 0.5f64.sqrt();
            for (light, more) in [
                (
                    0,
                    json!({ "rotation": [-half, 0, 0, half], "translation": [1, 2, 3] }),
                ),
                (1, json!({ "scale": [1, -2, 0.5] })),
                (2, json!({})),
                (3, json!({})),
                (4, json!({})),
                (1, json!({ "scale": [0, 0, 0] })),
            ] {
                let mut node = more;
                node["extensions"] = json!({ "EXT_lights_area": { "light": light } });
                m.node(node);
            }
            placed_square(m, None, json!({}));
        },
        |s| {
            let [panel, disc] = &s.lights[..] else {
                panic!("{:?}", s.lights);
            };
            let kind = LightKind::Rectangle {
                width: 2.0,
                height: 1.0,
            };
            assert_eq!((panel.kind, panel.color), (kind, Vec3::splat(100.0)));
            assert!(panel.direction.abs_diff_eq(Vec3::NEG_Y, 1e-6));
            assert!(panel.up.abs_diff_eq(Vec3::NEG_Z, 1e-6));
            assert_eq!(panel.position, Vec3::new(1.0, 2.0, 3.0));
            let kind = LightKind::Disc { radius: 1.5 };
            assert_eq!((disc.kind, disc.color), (kind, Vec3::new(8.0, 4.0, 2.0)));
            warned(
                s,
                "lights that have a shape other than rect and disk are left out",
                1,
            );
            warned(
                s,
                "lights that have a size that is not above 0 are left out",
                1,
            );
            warned(
                s,
                "lights that have no description in the file are left out",
                1,
            );
            warned(s, "a size that is not 0.0001 to 1000000 m", 1);
        },
    ),
    (
        "NegativeIntensity",
        |m| {
            let light = lamp(m, json!({ "type": "point", "intensity": -5 }));
            m.node(json!({ "extensions": { "KHR_lights_punctual": { "light": light } } }));
            placed_square(m, None, json!({}));
        },
        |s| {
            assert_eq!((s.lights.len(), s.lights[0].color), (1, Vec3::ZERO));
            warned(
                s,
                "negative colours and intensities of lights count as 0",
                1,
            );
        },
    ),
    (
        "PhotometricLamps",
        |m| {
            for intensity in [68300, 2] {
                let light = lamp(m, json!({ "type": "point", "intensity": intensity }));
                m.node(json!({ "name": "bulb", "extensions": { "KHR_lights_punctual": { "light": light } } }));
            }
            placed_square(m, None, json!({}));
        },
        |s| warned(s, "lights_scale", 1),
    ),
    (
        "BlenderLamps",
        |m| {
            m.root["asset"]["generator"] = json!("Khronos glTF Blender I/O v4.0.44");
            let light = lamp(m, json!({ "type": "point", "intensity": 54 }));
            m.node(json!({ "extensions": { "KHR_lights_punctual": { "light": light } } }));
            placed_square(m, None, json!({}));
        },
        |s| warned(s, "Blender writes intensities", 1),
    ),
    (
        "Cameras",
        |m| {
            let camera = camera(m);
            m.node(json!({ "name": "view", "camera": camera, "translation": [0, 1, 4] }));
            placed_square(m, None, json!({}));
        },
        |s| {
            let own = &s.cameras["default"];
            assert_eq!((own.eye, own.near), (Vec3::new(0.0, 1.0, 4.0), 0.5));
            near((own.target - own.eye).normalize(), Vec3::NEG_Z, 1e-6);
            assert!((own.fov_y - 40.0).abs() < 1e-4 && s.cameras["view"].eye == own.eye);
        },
    ),
    (
        "ChannelsByTheThousand",
        |m| {
            placed_square(m, None, json!({}));
            let (times, values) = (
                m.floats(&[[0.0], [1.0]]),
                m.floats(&[[1., 1., 1.], [2., 2., 2.]]),
            );
            let channel = json!({ "sampler": 0, "target": { "node": 0, "path": "scale" } });
            m.push(
                "animations",
                json!({ "samplers": [{ "input": times, "output": values }], "channels": vec![channel; 1305] }),
            );
        },
        |s| {
            // 1,305 channels of one node's scale are one motion, and nothing to be told.
            assert_eq!((s.movers.len(), &s.warnings), (1, &vec![]));
            near(
                s.instance_transform(0, 0.5).transform_point3(Vec3::X),
                Vec3::X * 1.5,
                1e-5,
            );
        },
    ),
    (
        "ThirteenSizes",
        |m| {
            for size in 1..=13u32 {
                let texture = m.texture(size, 1, &vec![[9, 9, 9, 255]; size as usize], json!({}));
                let material = m.material(
                    json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": texture } } }),
                );
                placed_square(m, Some(material), json!({}));
            }
        },
        |s| {
            // The ten largest keep their size.
            assert_eq!(s.warnings.len(), 1, "{:?}", s.warnings);
            warned(s, "3 textures of rare sizes are scaled to 512 x 512", 1);
        },
    ),
    (
        "UnknownExtensions",
        |m| {
            m.root["extensionsUsed"] = json!(["ACME_fog", "KHR_lights_punctual", "ACME_fog"]);
            placed_square(m, None, json!({}));
        },
        |s| {
            assert_eq!(s.warnings.len(), 1, "{:?}", s.warnings);
            warned(s, "it uses ACME_fog, which is left out", 1);
        },
    ),
    (
        "TextureSettingsTest",
        |m| {
            for (s, t, mag) in [
                (10497, 33071, 9729),
                (33648, 10497, 9728),
                (33071, 33648, 9729),
            ] {
                let sampler = json!({ "wrapS": s, "wrapT": t, "magFilter": mag });
                let texture = m.texture(1, 1, &[[9, 9, 9, 255]], sampler);
                let material = m.material(json!({ "pbrMetallicRoughness": {
                    "baseColorTexture": { "index": texture }, "metallicRoughnessTexture": { "index": texture } },
                    "normalTexture": { "index": texture }, "emissiveTexture": { "index": texture } }));
                placed_square(m, Some(material), json!({}));
            }
        },
        |s| {
            use Wrap::*;
            let wraps = [
                ([Repeat, Clamp], false),
                ([Mirror, Repeat], true),
                ([Clamp, Mirror], false),
            ];
            for (material, (wrap, nearest)) in s.materials.iter().zip(wraps) {
                let Lookups {
                    base_color,
                    metallic_roughness,
                    normal,
                    emission,
                } = material.lookups;
                for lookup in [base_color, metallic_roughness, normal, emission] {
                    assert_eq!(
                        lookup,
                        Lookup {
                            wrap,
                            nearest,
                            second_set: false
                        }
                    );
                }
            }
            assert_eq!(s.warnings, [""; 0]);
        },
    ),
    (
        "VertexColorTest",
        |m| {
            // Bytes with alpha, 16 bits without, floats beyond 1; and a second colour.
            let bytes = [[255, 0, 51, 102]; 6].concat();
            let shorts: Vec<u8> = [[65535u16, 0, 13107]; 6]
                .concat()
                .into_iter()
                .flat_map(u16::to_le_bytes)
                .collect();
            let (normalized, more) = (json!({ "normalized": true }), m.floats(&[[1., 0., 0.]; 6]));
            let colors = [
                m.raw(U8, "VEC4", 6, &bytes, normalized.clone()),
                m.raw(U16, "VEC3", 6, &shorts, normalized),
                m.floats(&[[2.0, -1.0, 0.2]; 6]),
            ];
            for colors in colors {
                let mesh = m.square(json!({ "COLOR_0": colors, "COLOR_1": more }), None);
                m.node(json!({ "mesh": mesh }));
            }
        },
        |s| {
            for (mesh, alpha) in s.meshes.iter().zip([0.4, 1.0, 1.0]) {
                for vertex in &mesh.vertices {
                    let off = Vec4::from(vertex.color) - Vec4::new(1.0, 0.0, 0.2, alpha);
                    assert!(off.abs().max_element() < 1e-6, "{vertex:?}");
                }
            }
            warned(
                s,
                "COLOR_1 and further colours of vertices are left out ('mesh 0', 'mesh 1', 'mesh 2')",
                1,
            );
        },
    ),
    (
        "MultiUVTest",
        |m| {
            // Occlusion apart, two of three textures on the second set.
            let texture = m.texture(1, 1, &[[9, 9, 9, 255]], json!({}));
            let material = m.material(json!({
                "pbrMetallicRoughness": { "baseColorTexture": { "index": texture, "texCoord": 1 },
                    "metallicRoughnessTexture": { "index": texture } },
                "emissiveTexture": { "index": texture, "texCoord": 1 } }));
            let second = m.floats(&SQUARE_UV.map(|[u, v]| [u + 10.0, v]));
            let mesh = m.square(json!({ "TEXCOORD_1": second }), Some(material));
            m.node(json!({ "mesh": mesh }));
        },
        |s| {
            let Lookups {
                base_color,
                metallic_roughness,
                emission,
                ..
            } = s.materials[0].lookups;
            let place = |lookup: Lookup| {
                let vertex = &s.meshes[0].vertices[s.meshes[0].indices[0] as usize];
                lookup.place(Vec4::new(
                    vertex.uv[0],
                    vertex.uv[1],
                    vertex.uv_second[0],
                    vertex.uv_second[1],
                ))
            };
            assert_eq!(
                [base_color, metallic_roughness, emission].map(place),
                [
                    Vec2::new(10.0, 1.0),
                    Vec2::new(0.0, 1.0),
                    Vec2::new(10.0, 1.0)
                ]
            );
            assert_eq!(s.warnings, [""; 0]);
        },
    ),
    (
        "TextureTransformMultiTest",
        |m| {
            // The extension's own example: half a turn to the right about the origin, and a picture of a fifth.
            let texture = m.texture(1, 1, &[[9, 9, 9, 255]], json!({}));
            let transform = json!({ "KHR_texture_transform":
                { "offset": [0, 1], "rotation": FRAC_PI_2, "scale": [0.5, 0.5] } });
            let material = m.material(json!({
                "pbrMetallicRoughness": { "baseColorTexture": { "index": texture, "extensions": transform } },
                "normalTexture": { "index": texture } }));
            placed_square(m, Some(material), json!({}));
        },
        |s| {
            let Lookups {
                base_color, normal, ..
            } = s.materials[0].lookups;
            assert_ne!(base_color.second_set, normal.second_set);
            for vertex in &s.meshes[0].vertices {
                let sets = Vec4::new(
                    vertex.uv[0],
                    vertex.uv[1],
                    vertex.uv_second[0],
                    vertex.uv_second[1],
                );
                // [x, y] of the square is at u = (x + 1) / 2, v = (1 - y) / 2; turned, (u, v) goes to (v, 1 - u) / 2 + (0, 0.5).
                let (u, v) = (
                    (vertex.position[0] + 1.0) * 0.5,
                    (1.0 - vertex.position[1]) * 0.5,
                );
                assert!(normal.place(sets).distance(Vec2::new(u, v)) < 1e-6);
                assert!(
                    base_color
                        .place(sets)
                        .distance(Vec2::new(0.5 * v, 1.0 - 0.5 * u))
                        < 1e-6,
                    "{vertex:?}"
                );
            }
            assert_eq!(s.warnings, [""; 0]);
        },
    ),
    (
        "ThreeKindsOfCoordinates",
        |m| {
            let texture = m.texture(1, 1, &[[9, 9, 9, 255]], json!({}));
            let scaled = |s: u32| json!({ "index": texture, "extensions": { "KHR_texture_transform": { "scale": [s, s] } } });
            let material = m.material(json!({
                "pbrMetallicRoughness": { "baseColorTexture": scaled(2), "metallicRoughnessTexture": scaled(3) },
                "normalTexture": scaled(4), "emissiveTexture": scaled(4) }));
            placed_square(m, Some(material), json!({}));
        },
        |s| {
            let Lookups {
                base_color,
                metallic_roughness,
                normal,
                emission,
            } = s.materials[0].lookups;
            let seconds =
                [base_color, metallic_roughness, normal, emission].map(|lookup| lookup.second_set);
            assert_eq!(seconds, [true, false, false, false]);
            let far = s.meshes[0]
                .vertices
                .iter()
                .map(|v| [v.uv[0], v.uv_second[0]].map(|u| u as i32));
            assert_eq!(far.max(), Some([4, 2]));
            warned(s, "more than two kinds of coordinates", 1);
        },
    ),
    (
        "SpecularTest",
        |m| {
            let material = m.material(json!({ "extensions": { "KHR_materials_specular": {
                "specularFactor": 0.5, "specularColorFactor": [1, 0.5, 0.25] } } }));
            placed_square(m, Some(material), json!({}));
        },
        |s| {
            let reflected = s.materials[0].dielectric();
            near(reflected.truncate(), 0.02 * Vec3::new(1.0, 0.5, 0.25), 1e-6);
            assert!((reflected.w - 0.5).abs() < 1e-6, "{reflected}");
        },
    ),
    (
        "TransmissionTest",
        |m| {
            for share in [0.25, 0.75] {
                let material = m.material(
                    json!({ "pbrMetallicRoughness": { "metallicFactor": 0 }, "extensions": {
                    "KHR_materials_transmission": { "transmissionFactor": share } } }),
                );
                placed_square(m, Some(material), json!({}));
            }
        },
        |s| {
            near(
                s.materials[0].base_color.truncate(),
                Vec3::splat(0.75),
                1e-6,
            );
            assert!(s.materials[1].is_left_out());
            assert_eq!(s.triangle_count(), 2);
            warned(s, "KHR_materials_transmission", 2);
        },
    ),
    (
        "SpecGlossVsMetalRough",
        |m| {
            let material = m.material(json!({ "extensions": { "KHR_materials_pbrSpecularGlossiness": {
                "diffuseFactor": [0.8, 0.4, 0.2, 1], "specularFactor": [0.25, 0.125, 0.25], "glossinessFactor": 0.75 } } }));
            placed_square(m, Some(material), json!({}));
        },
        |s| {
            let material = &s.materials[0];
            near(
                material.base_color.truncate(),
                0.75 * Vec3::new(0.8, 0.4, 0.2),
                1e-5,
            );
            near(
                material.dielectric().truncate(),
                Vec3::new(0.25, 0.125, 0.25),
                1e-3,
            );
            assert_eq!((material.metallic, material.roughness), (0.0, 0.25));
        },
    ),
    (
        "ClearCoatTest",
        |m| {
            for factor in [0.0, 0.5, 1.0] {
                let material = m
                    .material(json!({ "name": format!("coat {factor}"), "extensions": {
                    "KHR_materials_clearcoat": { "clearcoatFactor": factor } } }));
                placed_square(m, Some(material), json!({}));
            }
        },
        |s| {
            warned(s, "KHR_materials_clearcoat", 1);
            warned(s, "'coat 0.5', 'coat 1'", 1);
        },
    ),
    (
        "MetalRoughSpheres",
        |m| {
            let texture = m.texture(1, 1, &[[0, 102, 51, 255]], json!({}));
            let material = m.material(
                json!({ "pbrMetallicRoughness": { "metallicFactor": 0.5, "roughnessFactor": 0.25,
                "metallicRoughnessTexture": { "index": texture } } }),
            );
            placed_square(m, Some(material), json!({}));
        },
        |s| {
            let material = &s.materials[0];
            assert_eq!((material.metallic, material.roughness), (0.5, 0.25));
            let texture = &s.textures[material.metallic_roughness_texture.unwrap() as usize];
            assert_eq!(
                (&texture.mips[0][1..3], texture.format.is_srgb()),
                (&[102, 51][..], false)
            );
        },
    ),
    (
        "NormalTangentTest",
        |m| {
            let texture = m.texture(1, 1, &[[128, 218, 218, 255]], json!({}));
            let material = m.material(json!({ "normalTexture": { "index": texture } }));
            placed_square(m, Some(material), json!({}));
        },
        |s| {
            // u goes to +x and the picture's top to +y: cross(normal, tangent) * w is +y.
            for vertex in &s.meshes[0].vertices {
                near(Vec4::from(vertex.tangent).truncate(), Vec3::X, 1e-5);
                assert_eq!(vertex.tangent[3], 1.0);
            }
        },
    ),
    (
        "BoxAnimated",
        |m| {
            let (times, values) = (
                m.floats(&[[1.0], [3.0]]),
                m.floats(&[[0., 0., 0.], [2., 0., 4.]]),
            );
            moving(m, json!({ "input": times, "output": values }));
        },
        |s| {
            for (time, place) in [
                (0.0, [0., 0., 0.]),
                (1.0, [0., 0., 0.]),
                (2.0, [1., 0., 2.]),
                (2.5, [1.5, 0., 3.]),
            ] {
                near(
                    s.instance_transform(0, time).transform_point3(Vec3::ZERO),
                    place.into(),
                    1e-4,
                );
            }
        },
    ),
    (
        "InterpolationTest",
        |m| {
            let (times, values) = (
                m.floats(&[[0.0], [2.0], [4.0]]),
                m.floats(&[[0., 0., 0.], [2., 0., 4.], [0., 6., 0.]]),
            );
            moving(
                m,
                json!({ "input": times, "output": values, "interpolation": "STEP" }),
            );
        },
        |s| {
            for (time, place) in [
                (0.5, [0., 0., 0.]),
                (1.9, [0., 0., 0.]),
                (2.1, [2., 0., 4.]),
                (3.9, [2., 0., 4.]),
            ] {
                near(
                    s.instance_transform(0, time).transform_point3(Vec3::ZERO),
                    place.into(),
                    1e-4,
                );
            }
        },
    ),
    (
        "CubicSpline",
        |m| {
            // x^3 from 1 to 3, whose slopes are 3 x^2.
            let key = |x: f32| {
                [
                    [3. * x * x, 0., 0.],
                    [x * x * x, 0., 0.],
                    [3. * x * x, 0., 0.],
                ]
            };
            let values = m.floats(&[key(1.0), key(3.0)].concat());
            let times = m.floats(&[[1.0], [3.0]]);
            moving(
                m,
                json!({ "input": times, "output": values, "interpolation": "CUBICSPLINE" }),
            );
        },
        |s| {
            for time in [1.0f32, 1.5, 2.0, 2.9] {
                let place = s.instance_transform(0, time).transform_point3(Vec3::ZERO);
                near(place, Vec3::X * time.powi(3), 1e-3);
            }
        },
    ),
    (
        "BoxAnimated, nested",
        |m| {
            // A wheel that turns on a cart that rolls, below a node that doubles and mirrors.
            let mesh = m.square(json!({}), None);
            let wheel = m.push(
                "nodes",
                json!({ "mesh": mesh, "translation": [0, 1, 0], "name": "wheel" }),
            );
            let cart = m.push("nodes", json!({ "children": [wheel] }));
            m.node(json!({ "children": [cart], "scale": [-2, 2, 2] }));
            let half = std::f32::consts::FRAC_1_SQRT_2;
            let times = m.floats(&[[0.0], [2.0]]);
            let rolls = m.floats(&[[0., 0., 0.], [4., 0., 0.]]);
            let turns = m.floats(&[[0., 0., 0., 1.], [0., 0., half, half]]);
            let channel = |sampler: usize, node: usize, path: &str| json!({ "sampler": sampler, "target": { "node": node, "path": path } });
            let channels = [
                channel(0, cart, "translation"),
                channel(1, wheel, "rotation"),
            ];
            let sampler = |output: usize| json!({ "input": times, "output": output });
            m.push(
                "animations",
                json!({ "samplers": [sampler(rolls), sampler(turns)], "channels": channels }),
            );
        },
        |s| {
            assert_eq!(s.warnings, [""; 0]);
            for (time, angle) in [(0.0f32, 0.0f32), (1.0, 45.0), (1.5, 67.5)] {
                let turned = glam::Vec2::from_angle(angle.to_radians());
                let place = Vec3::new(2.0 * time + turned.x, 1.0 + turned.y, 0.0)
                    * Vec3::new(-2.0, 2.0, 2.0);
                near(
                    s.instance_transform(0, time).transform_point3(Vec3::X),
                    place,
                    1e-4,
                );
            }
            // At 2 s it starts over: the wheel's lower left corner has come to 4 + 1, 1 - 1 just before.
            let (low, high) = s.bounds();
            near(
                low,
                Vec3::new(-2.0 * 5.0, 2.0 * (1.0 - std::f32::consts::SQRT_2), 0.0),
                2e-2,
            );
            near(
                high,
                Vec3::new(2.0, 2.0 * (1.0 + std::f32::consts::SQRT_2), 0.0),
                2e-2,
            );
        },
    ),
    (
        "SimpleSkin",
        |m| bending(m, false),
        |s| {
            assert_eq!(
                (s.warnings.len(), s.deformers.len(), s.movers.len()),
                (0, 1, 1)
            );
            // The lower end stays, the upper one turns about (0, 1, 0), the middle takes the mean of both.
            for (time, angle) in [(0.0f32, 0.0f32), (0.5, 45.0), (0.75, 67.5)] {
                let turn = |x: f32, y: f32| {
                    let [c, s] = [angle.to_radians().cos(), angle.to_radians().sin()];
                    Vec3::new(c * x - s * y, 1.0 + s * x + c * y, 0.0)
                };
                let posed = posed(s, time);
                let expected = [
                    Vec3::new(-0.5, 0.0, 0.0),
                    Vec3::new(0.5, 0.0, 0.0),
                    (Vec3::new(0.5, 1.0, 0.0) + turn(0.5, 0.0)) * 0.5,
                    turn(0.5, 1.0),
                    turn(-0.5, 1.0),
                ];
                expected
                    .iter()
                    .zip(&posed)
                    .for_each(|(e, p)| near(p.position.into(), *e, 1e-5));
                posed
                    .iter()
                    .for_each(|v| near(v.normal.into(), Vec3::Z, 1e-5));
            }
            // Where the node stands counts for nothing (3.7.3.3): it is at (7, 8, 9).
            let (low, high) = s.bounds();
            // The corners turn about (0, 1, 0), and as far as they are from there they come; a hundredth is added.
            let far = 1.25f32.sqrt();
            near(low, Vec3::new(-far, 0.0, 0.0), 0.03);
            near(high, Vec3::new(0.5, 1.0 + far, 0.0), 0.03);
        },
    ),
    (
        "SimpleSkin at rest",
        |m| bending(m, true),
        |s| {
            // Nothing moves: the mesh is posed once, turned by 90 degrees.
            assert_eq!(
                (s.warnings.len(), s.deformers.len(), s.movers.len()),
                (0, 0, 0)
            );
            let top = s.meshes[s.instances[0].mesh as usize].vertices[3];
            near(top.position.into(), Vec3::new(-1.0, 1.5, 0.0), 1e-5);
        },
    ),
    (
        "RecursiveSkeletons",
        |m| {
            // Two skins of one mesh, whose joints stand at different places.
            let joints = m.raw(U8, "VEC4", 6, &[0u8; 24], json!({}));
            let weights = m.floats(&[[1., 0., 0., 0.]; 6]);
            let mesh = m.square(json!({ "JOINTS_0": joints, "WEIGHTS_0": weights }), None);
            for place in [[1, 0, 0], [0, 5, 0]] {
                let joint = m.node(json!({ "translation": place }));
                let skin = m.push("skins", json!({ "joints": [joint] }));
                m.node(json!({ "mesh": mesh, "skin": skin }));
            }
        },
        |s| {
            assert_eq!((s.instances.len(), s.warnings.len()), (2, 0));
            let first = |i: usize| s.meshes[s.instances[i].mesh as usize].vertices[0].position;
            near(first(0).into(), Vec3::new(0.0, -1.0, 0.0), 1e-6);
            near(first(1).into(), Vec3::new(-1.0, 4.0, 0.0), 1e-6);
        },
    ),
    (
        "RiggedSimple, eight joints a vertex",
        |m| {
            let joint = |m: &mut Model, x: f32| m.node(json!({ "translation": [x, 0, 0] }));
            let joints: Vec<usize> = (0..8).map(|i| joint(m, i as f32)).collect();
            let sets = [[0u8, 1, 2, 3], [4, 5, 6, 7]]
                .map(|set| m.raw(U8, "VEC4", 6, &set.repeat(6), json!({})));
            // Of bytes, and of a sum that is not 1.
            let quarter = m.raw(U8, "VEC4", 6, &[51u8; 24], json!({ "normalized": true }));
            let mesh = m.square(
                json!({ "JOINTS_0": sets[0], "WEIGHTS_0": quarter, "JOINTS_1": sets[1], "WEIGHTS_1": quarter }),
                None,
            );
            let skin = m.push("skins", json!({ "joints": joints }));
            m.node(json!({ "mesh": mesh, "skin": skin }));
        },
        |s| {
            // The mean of eight joints at 0 to 7.
            let vertices = &s.meshes[s.instances[0].mesh as usize].vertices;
            near(vertices[0].position.into(), Vec3::new(2.5, -1.0, 0.0), 1e-5);
        },
    ),
    (
        "SimpleMorph",
        |m| {
            let mesh = morphed(m, json!([0.0, 0.5]));
            let node = m.node(json!({ "mesh": mesh }));
            let (times, values) = (
                m.floats(&[[0.0], [2.0]]),
                m.floats(&[[0.0], [0.5], [1.0], [0.5]]),
            );
            let channel = json!({ "sampler": 0, "target": { "node": node, "path": "weights" } });
            let sampler = json!({ "input": times, "output": values });
            m.push(
                "animations",
                json!({ "samplers": [sampler], "channels": [channel] }),
            );
        },
        |s| {
            assert_eq!((s.warnings.len(), s.deformers.len()), (0, 1));
            for time in [0.0f32, 0.5, 1.5] {
                let vertex = posed(s, time)[2];
                near(
                    vertex.position.into(),
                    Vec3::new(1.0, 1.0, 3.0 * time * 0.5 + 0.5),
                    1e-5,
                );
            }
        },
    ),
    (
        "MorphStressTest, weights at rest",
        |m| {
            let mesh = morphed(m, json!([1.0, 0.0]));
            m.node(json!({ "mesh": mesh }));
            m.node(json!({ "mesh": mesh, "weights": [0.5, 2.0], "translation": [10, 0, 0] }));
        },
        |s| {
            assert_eq!(
                (s.warnings.len(), s.deformers.len(), s.meshes.len()),
                (0, 0, 2)
            );
            let corner = |i: usize| s.meshes[s.instances[i].mesh as usize].vertices[2].position;
            assert_eq!([corner(0), corner(1)], [[1.0, 1.0, 3.0], [1.0, 1.0, 3.5]]);
            near(
                s.instance_transform(1, 0.0).transform_point3(Vec3::ZERO),
                Vec3::X * 10.0,
                0.0,
            );
        },
    ),
    (
        "MorphPrimitivesTest, without normals",
        |m| {
            // A corner of the square goes up: normals are those of the bent triangles.
            let positions = m.floats(&SQUARE);
            let mut up = [[0f32; 3]; 6];
            up[5] = [0.0, 0.0, 2.0];
            let target = m.floats(&up);
            let primitive = json!({ "attributes": { "POSITION": positions }, "targets": [{ "POSITION": target }] });
            let mesh = m.push(
                "meshes",
                json!({ "primitives": [primitive], "weights": [1] }),
            );
            m.node(json!({ "mesh": mesh }));
        },
        |s| {
            // The second triangle from (-1, -1, 0): to (1, 1, 0) and to (-1, 1, 2).
            let bent = Vec3::new(2.0, 2.0, 0.0)
                .cross(Vec3::new(0.0, 2.0, 2.0))
                .normalize();
            let expected = |i| if i < 3 { Vec3::Z } else { bent };
            corner_normals(s)
                .iter()
                .enumerate()
                .for_each(|(i, n)| near(*n, expected(i), 1e-5));
        },
    ),
    (
        "Several clips of one skeleton",
        |m| {
            placed_square(m, None, json!({}));
            let times = m.floats(&[[0.0], [1.0]]);
            let (walk, run) = (
                m.floats(&[[0., 0., 0.], [1., 0., 0.]]),
                m.floats(&[[0., 0., 0.], [9., 0., 0.]]),
            );
            for (name, output) in [("walk", walk), ("run", run)] {
                let channel =
                    json!({ "sampler": 0, "target": { "node": 0, "path": "translation" } });
                let sampler = json!({ "input": times, "output": output });
                m.push(
                    "animations",
                    json!({ "name": name, "samplers": [sampler], "channels": [channel] }),
                );
            }
        },
        |s| {
            warned(
                s,
                "of several animations of one node the first is played. `clip: \"NAME\"`",
                1,
            );
            warned(s, "('run')", 1);
            near(
                s.instance_transform(0, 0.5).transform_point3(Vec3::ZERO),
                Vec3::X * 0.5,
                1e-6,
            );
        },
    ),
    (
        "DirectionalLight",
        |m| {
            let light = lamp(
                m,
                json!({ "type": "directional", "intensity": 3, "color": [1, 0.5, 0.25] }),
            );
            // A quarter about x turns -z to -y.
            let half = (FRAC_PI_2 / 2.0).sin();
            m.node(
                json!({ "extensions": { "KHR_lights_punctual": { "light": light } }, "rotation": [-half, 0, 0, half] }),
            );
            placed_square(m, None, json!({}));
        },
        |s| {
            let light = &s.lights[0];
            assert_eq!(
                (light.kind, light.color),
                (LightKind::Directional, Vec3::new(3.0, 1.5, 0.75))
            );
            near(light.direction, Vec3::NEG_Y, 1e-5);
        },
    ),
    (
        "AnimatedMorphCubeQuantized",
        |m| {
            m.root["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
            m.root["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
            let corner = |p: &[f32; 3]| [p[0] as i16 * 32767, p[1] as i16 * 32767, 0, 0];
            let bytes: Vec<u8> = SQUARE
                .iter()
                .flat_map(corner)
                .flat_map(i16::to_le_bytes)
                .collect();
            let bounds = json!({ "normalized": true, "min": [-1, -1, 0], "max": [1, 1, 0] });
            let positions = m.raw(I16, "VEC3", 6, &bytes, bounds);
            let view = m.root["accessors"][positions]["bufferView"]
                .as_u64()
                .unwrap() as usize;
            m.root["bufferViews"][view]["byteStride"] = json!(8);
            let mesh = m.mesh(json!({ "POSITION": positions }), None);
            m.node(json!({ "mesh": mesh, "scale": [2, 2, 2] }));
        },
        |s| {
            assert_eq!(
                s.bounds(),
                (Vec3::new(-2.0, -2.0, 0.0), Vec3::new(2.0, 2.0, 0.0))
            )
        },
    ),
    (
        "MeshoptCubeTest",
        |m| {
            compressed_square(m, "EXT_meshopt_compression");
            m.root["extensionsRequired"] =
                json!(["EXT_meshopt_compression", "KHR_mesh_quantization"]);
        },
        square_is_whole,
    ),
    (
        "MeshoptCubeTestKHR",
        |m| compressed_square(m, "KHR_meshopt_compression"),
        square_is_whole,
    ),
    (
        "StainedGlassLamp",
        |m| {
            // A texture with another one for readers without the extension.
            let texture = m.texture(1, 1, &[[9; 4]], json!({}));
            universal_texture(m, texture, "etc1s_alpha.ktx2");
            let material = m.material(
                json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": texture } } }),
            );
            placed_square(m, Some(material), json!({}));
        },
        |s| {
            let texture = &s.textures[0];
            assert_eq!(
                (texture.width, texture.height, texture.mips.len()),
                (8, 8, 4)
            );
            assert_eq!(
                (texture.format, s.warnings.len()),
                (TextureFormat::Rgba8Srgb, 0),
                "{:?}",
                s.warnings
            );
            texel_is(texture, 0, [255, 0, 0, 255], 5);
            texel_is(texture, 63, [128, 128, 128, 64], 5);
        },
    ),
    (
        "FlightHelmetKTX",
        |m| {
            let texture = m.push("textures", json!({}));
            universal_texture(m, texture, "uastc.ktx2");
            m.root["extensionsRequired"] = json!(["KHR_texture_basisu"]);
            let material = m.material(json!({ "normalTexture": { "index": texture } }));
            placed_square(m, Some(material), json!({}));
        },
        |s| {
            assert_eq!(
                (s.textures[0].format, s.warnings.len()),
                (TextureFormat::Rgba8Unorm, 0),
                "{:?}",
                s.warnings
            );
            texel_is(&s.textures[0], 4, [0, 255, 0, 255], 1);
        },
    ),
    (
        "MultipleScenes",
        |m| {
            placed_square(m, None, json!({}));
            let mesh = m.square(json!({}), None);
            let other = m.push("nodes", json!({ "mesh": mesh, "translation": [5, 0, 0] }));
            m.push("scenes", json!({ "nodes": [other] }));
            m.root["scene"] = json!(1);
        },
        |s| {
            assert_eq!(
                s.bounds(),
                (Vec3::new(4.0, -1.0, 0.0), Vec3::new(6.0, 1.0, 0.0))
            )
        },
    ),
];

#[test]
fn models_have_the_properties_that_the_samples_test() {
    let mut wrong = Vec::new();
    for (name, build, check) in ROWS {
        let mut model = Model::new();
        build(&mut model);
        let held = std::panic::catch_unwind(|| match model.open() {
            Ok(scene) => check(&scene),
            Err(why) => panic!("it does not open: {why}"),
        });
        if let Err(panic) = held {
            let text = panic.downcast_ref::<String>().cloned();
            wrong.push(format!(
                "{name}: {}",
                text.or(panic.downcast_ref::<&str>().map(ToString::to_string))
                    .unwrap()
            ));
        }
    }
    assert!(
        wrong.is_empty(),
        "{} of {} rows:\n{}",
        wrong.len(),
        ROWS.len(),
        wrong.join("\n")
    );
}

#[test]
fn refusals_name_a_way_on() {
    for (extension, way) in [
        (
            "KHR_draco_mesh_compression",
            "npx @gltf-transform/cli copy IN.glb OUT.glb",
        ),
        (
            "KHR_materials_clearcoat",
            "remove the name from `extensionsRequired`",
        ),
    ] {
        let mut model = Model::new();
        placed_square(&mut model, None, json!({}));
        model.root["extensionsRequired"] = json!([extension]);
        let told = model.open().unwrap_err();
        assert!(
            told.contains(extension) && told.contains(way) && !told.contains("without compression"),
            "{told}"
        );
    }
}

#[test]
fn scene_files_scale_the_lamps_of_models() {
    let mut model = Model::new();
    let light = lamp(&mut model, json!({ "type": "point", "intensity": 6830 }));
    model.node(json!({ "extensions": { "KHR_lights_punctual": { "light": light } } }));
    placed_square(&mut model, None, json!({}));
    let folder = tempfile::tempdir().unwrap();
    model.write(folder.path(), "m.gltf");
    let path = folder.path().join("s.ron");
    let scene = |entry: &str| {
        std::fs::write(&path, format!("(models: [(file: \"m.gltf\", {entry})])")).unwrap();
        open(&path)
    };
    let scaled = scene("lights_scale: 0.001").unwrap();
    near(scaled.lights[0].color, Vec3::splat(6.83), 1e-5);
    assert_eq!(
        (scaled.sky, scaled.warnings.len()),
        (Vec3::ZERO, 0),
        "{:?}",
        scaled.warnings
    );
    warned(&scene("").unwrap(), "lights_scale", 1);
    assert!(
        scene("lights_scale: -1")
            .unwrap_err()
            .contains("lights_scale is from 0")
    );
}

/// A small file may name one list of keys very often, and nest its nodes.
#[test]
fn animations_do_not_grow_without_bound() {
    let refused = |keys: usize, nodes: usize, piece: &str| {
        let mut m = Model::new();
        let times: Vec<[f32; 1]> = (0..keys).map(|i| [i as f32]).collect();
        let (times, values) = (m.floats(&times), m.floats(&vec![[1.0, 0.0, 0.0]; keys]));
        for i in 0..nodes {
            m.push(
                "nodes",
                if i == 0 {
                    json!({})
                } else {
                    json!({ "children": [i - 1] })
                },
            );
        }
        m.root["scenes"][0]["nodes"] = json!([nodes - 1]);
        let channel = |node: usize| json!({ "sampler": 0, "target": { "node": node, "path": "translation" } });
        let channels: Vec<Value> = (0..nodes).map(channel).collect();
        m.push(
            "animations",
            json!({ "samplers": [{ "input": times, "output": values }], "channels": channels }),
        );
        let folder = tempfile::tempdir().unwrap();
        let error = open(&m.write(folder.path(), "m.gltf")).unwrap_err();
        assert!(error.contains(piece), "{error}");
    };
    refused(70_000, 64, "more than 4194304 keys");
    refused(2, 300, "moves in more than 256 moving nodes");
}

#[test]
fn scene_files_choose_the_clips_of_models() {
    let mut model = Model::new();
    placed_square(&mut model, None, json!({}));
    let times = model.floats(&[[0.0], [1.0]]);
    for (name, end) in [("walk", 1.0), ("run", 9.0)] {
        let output = model.floats(&[[0.0, 0.0, 0.0], [end, 0.0, 0.0]]);
        let channel = json!({ "sampler": 0, "target": { "node": 0, "path": "translation" } });
        let sampler = json!({ "input": times, "output": output });
        model.push(
            "animations",
            json!({ "name": name, "samplers": [sampler], "channels": [channel] }),
        );
    }
    let folder = tempfile::tempdir().unwrap();
    model.write(folder.path(), "m.gltf");
    std::fs::write(
        folder.path().join("m.obj"),
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    )
    .unwrap();
    let path = folder.path().join("s.ron");
    let scene = |models: &str| {
        std::fs::write(&path, format!("(models: [{models}])")).unwrap();
        open(&path)
    };
    let both = scene("(file: \"m.gltf\", clip: \"run\"), (file: \"m.gltf\")").unwrap();
    let place = |i| both.instance_transform(i, 0.5).transform_point3(Vec3::ZERO);
    near(place(0), Vec3::X * 4.5, 1e-6);
    near(place(1), Vec3::X * 0.5, 1e-6);
    for (models, pieces) in [
        (
            "(file: \"m.gltf\", clip: \"runn\")",
            &["m.gltf", "no clip 'runn'", "did you mean 'run'?"][..],
        ),
        (
            "(file: \"m.obj\", clip: \"run\")",
            &["m.obj", "OBJ files have no clips"],
        ),
        (
            "(builtin: \"cornell\", clip: \"run\")",
            &["`clip` is of models from files"],
        ),
    ] {
        let error = scene(models).unwrap_err();
        assert!(pieces.iter().all(|piece| error.contains(piece)), "{error}");
    }
}

/// A square of whole numbers from -100 to 100, in streams by meshoptimizer's encoder.
fn compressed_square(m: &mut Model, extension: &str) {
    m.push(
        "buffers",
        json!({ "byteLength": 84, "extensions": { extension: { "fallback": true } } }),
    );
    let mut view = |offset: usize, stride: usize, mode: &str, filter: &str, stream: &str| {
        let bytes: Vec<u8> = (0..stream.len() / 2)
            .map(|i| u8::from_str_radix(&stream[2 * i..2 * i + 2], 16).unwrap())
            .collect();
        let view = m.view(&bytes);
        let from = m.root["bufferViews"][view]["byteOffset"].clone();
        let layout = json!({ "buffer": 0, "byteOffset": from, "byteLength": bytes.len(), "byteStride": stride, "count": 6,
            "mode": mode, "filter": filter });
        m.root["bufferViews"][view] = json!({ "buffer": 1, "byteOffset": offset, "byteLength": 6 * stride, "extensions": { extension: layout } });
        if mode == "ATTRIBUTES" {
            m.root["bufferViews"][view]["byteStride"] = json!(stride);
        }
        view
    };
    let positions = "a00133f000006f706f700121900000010fc000006f706f0109800000000000000000000000000000000000000000000000000000\
                     000000009cff9cff00000000";
    let positions = view(0, 8, "ATTRIBUTES", "NONE", positions);
    let normals = "a0000000000000000000000000000000000000000000000000000000000000000000007f00";
    let normals = view(48, 4, "ATTRIBUTES", "OCTAHEDRAL", normals);
    let indices = view(
        72,
        2,
        "TRIANGLES",
        "NONE",
        "e1f00f0a007687566778a9866589689801690000",
    );
    let accessor = |view: usize, component: u32, kind: &str, more: Value| {
        let mut accessor =
            json!({ "bufferView": view, "componentType": component, "type": kind, "count": 6 });
        accessor
            .as_object_mut()
            .unwrap()
            .extend(more.as_object().unwrap().clone());
        accessor
    };
    let bounds = json!({ "min": [-100, -100, 0], "max": [100, 100, 0] });
    let positions = m.push("accessors", accessor(positions, I16, "VEC3", bounds));
    let normals = m.push(
        "accessors",
        accessor(normals, I8, "VEC3", json!({ "normalized": true })),
    );
    let indices = m.push("accessors", accessor(indices, U16, "SCALAR", json!({})));
    let mesh = m.mesh(json!({ "POSITION": positions, "NORMAL": normals }), None);
    m.root["meshes"][mesh]["primitives"][0]["indices"] = json!(indices);
    m.node(json!({ "mesh": mesh, "scale": [0.05, 0.05, 0.05] }));
}

fn square_is_whole(s: &Scene) {
    assert_eq!(
        (s.triangle_count(), s.warnings.len()),
        (2, 0),
        "{:?}",
        s.warnings
    );
    near(s.bounds().0, Vec3::new(-5.0, -5.0, 0.0), 1e-5);
    near(s.bounds().1, Vec3::new(5.0, 5.0, 0.0), 1e-5);
    corner_normals(s)
        .into_iter()
        .for_each(|n| near(n, Vec3::Z, 1e-6));
}

/// Gives a texture a universal image of `tests/gltf_compressed`: red, green, blue and grey quarters.
fn universal_texture(m: &mut Model, texture: usize, file: &str) {
    let bytes = std::fs::read(common::root().join("tests/gltf_compressed").join(file)).unwrap();
    let image = m.push(
        "images",
        json!({ "uri": data_uri(&bytes), "mimeType": "image/ktx2" }),
    );
    m.root["extensionsUsed"] = json!(["KHR_texture_basisu"]);
    m.root["textures"][texture]["extensions"] =
        json!({ "KHR_texture_basisu": { "source": image } });
}

#[track_caller]
fn texel_is(texture: &Texture, place: usize, wanted: [u8; 4], most: u8) {
    let found = &texture.mips[0][4 * place..4 * place + 4];
    let off = found
        .iter()
        .zip(wanted)
        .map(|(a, b)| a.abs_diff(b))
        .max()
        .unwrap();
    assert!(off <= most, "{found:?} for {wanted:?}");
}

#[track_caller]
fn near(a: Vec3, b: Vec3, tolerance: f32) {
    assert!(a.distance(b) <= tolerance, "{a} is not {b}");
}

/// Counts the warnings with a piece of text.
#[track_caller]
fn warned(scene: &Scene, piece: &str, lines: usize) {
    let count = scene.warnings.iter().filter(|w| w.contains(piece)).count();
    assert_eq!(count, lines, "'{piece}' in {:#?}", scene.warnings);
}

/// Normals of all corners of all meshes.
fn corner_normals(scene: &Scene) -> Vec<Vec3> {
    let corners = scene.meshes.iter().flat_map(|m| {
        m.indices
            .iter()
            .map(|i| m.vertices[*i as usize].normal.into())
    });
    corners.collect()
}

/// Area of all triangles, each mesh once.
fn area(scene: &Scene) -> f32 {
    let triangle = |p: [Vec3; 3]| 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).length();
    let of = |m: &conelab::scene::Mesh| -> f32 {
        m.indices
            .chunks(3)
            .map(|t| triangle([0, 1, 2].map(|k| m.vertices[t[k] as usize].position.into())))
            .sum()
    };
    scene.meshes.iter().map(of).sum()
}

/// A node with the square.
fn placed_square(m: &mut Model, material: Option<usize>, mut node: Value) {
    node["mesh"] = json!(m.square(json!({}), material));
    m.node(node);
}

/// Vertices of the first instance's mesh at a time.
fn posed(scene: &Scene, time: f32) -> Vec<Vertex> {
    scene.posed_meshes(time)[scene.instances[0].mesh as usize].to_vec()
}

/// The square with two targets, which lift it by 3 and by 1.
fn morphed(m: &mut Model, weights: Value) -> usize {
    let mesh = m.square(json!({}), None);
    let targets = [3.0, 1.0].map(|z| json!({ "POSITION": m.floats(&[[0., 0., z]; 6]) }));
    m.root["meshes"][mesh]["primitives"][0]["targets"] = json!(targets);
    m.root["meshes"][mesh]["weights"] = weights;
    mesh
}

/// The square on a node; a sampler moves the node.
fn moving(m: &mut Model, sampler: Value) {
    placed_square(m, None, json!({}));
    let channel = json!({ "sampler": 0, "target": { "node": 0, "path": "translation" } });
    m.push(
        "animations",
        json!({ "samplers": [sampler], "channels": [channel] }),
    );
}

fn paint(m: &mut Model, color: [f32; 4]) -> usize {
    m.material(json!({ "pbrMetallicRoughness": { "baseColorFactor": color } }))
}

fn instanced(attributes: Value) -> Value {
    json!({ "extensions": { "EXT_mesh_gpu_instancing": { "attributes": attributes } } })
}

fn lamp(m: &mut Model, light: Value) -> usize {
    let lights = &mut m.root["extensions"]["KHR_lights_punctual"]["lights"];
    if lights.is_null() {
        *lights = json!([]);
    }
    lights.as_array_mut().unwrap().push(light);
    lights.as_array().unwrap().len() - 1
}

fn camera(m: &mut Model) -> usize {
    let lens = json!({ "yfov": 40f32.to_radians(), "znear": 0.5 });
    m.push(
        "cameras",
        json!({ "type": "perspective", "perspective": lens }),
    )
}

/// Two triangles that share an edge, without normals.
fn bent(m: &mut Model) {
    let (sin, cos) = 40f32.to_radians().sin_cos();
    let positions = m.floats(&[[0., 0., 0.], [0., 1., 0.], [-1., 0., 0.], [cos, 0., -sin]]);
    let indices = m.raw(U8, "SCALAR", 6, &[0, 1, 2, 0, 3, 1], json!({}));
    let mesh = m.mesh(json!({ "POSITION": positions }), None);
    m.root["meshes"][mesh]["primitives"][0]["indices"] = json!(indices);
    m.node(json!({ "mesh": mesh }));
}
