//! Textures and colours pixel by pixel: wrap modes, filters, both sets of coordinates and colours of vertices are those of the
//! specification, by formulas, in everything that shades.

mod common;

use common::model_file::{Model, U8, U16};
use common::{assert_clean, experiment, floats, home, lab, root};
use conelab::experiment::{CameraChoice, Experiment, PlacedCamera};
use conelab::measure::reference::{Goal, gather};
use conelab::scene::{Instance, Light, Material, Mesh, Scene, Submesh, Vertex};
use glam::{DVec2, DVec3, Mat4, Vec3, Vec4};
use serde_json::{Value, json};
use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::Arc;

/// Squares of a picture, and pixels of one. A texel is four pixels wide, so that no pixel's centre is on a texel's edge.
const COLUMNS: usize = 4;
const ROWS: usize = 5;
const CELL: usize = 48;

const REPEAT: u32 = 10497;
const CLAMP: u32 = 33071;
const MIRROR: u32 = 33648;
const NEAREST: u32 = 9728;
const LINEAR: u32 = 9729;

/// Colour of a square by place, -1 to 1 to the right and up.
type Expected = Box<dyn Fn(DVec2) -> DVec3>;

/// Texels of 4 x 4, from the top: no two are alike, and most are far apart.
fn texels() -> Vec<[u8; 4]> {
    (0..16u32)
        .map(|i| {
            [
                (i * 67 + 30) % 256,
                (i * 149 + 200) % 256,
                (i * 211 + 90) % 256,
                255,
            ]
            .map(|v| v as u8)
        })
        .collect()
}

fn linear(byte: u8) -> f64 {
    let c = f64::from(byte) / 255.0;
    if c <= 0.04045 {
        c / 12.92
    } else {
        ((c + 0.055) / 1.055).powf(2.4)
    }
}

/// A texel beyond the picture (Vulkan 1.3, 16.8 Wrapping Operation).
fn wrapped(i: i64, mode: u32) -> i64 {
    match mode {
        CLAMP => i.clamp(0, 3),
        MIRROR => {
            let n = i.rem_euclid(8);
            if n < 4 { n } else { 7 - n }
        }
        _ => i.rem_euclid(4),
    }
}

/// The texture at coordinates, magnified (Vulkan 1.3, 16.9.3).
fn looked_up(uv: DVec2, wrap: [u32; 2], filter: u32) -> DVec3 {
    let texel = |i: i64, j: i64| {
        let [r, g, b, _] = texels()[(wrapped(j, wrap[1]) * 4 + wrapped(i, wrap[0])) as usize];
        DVec3::new(linear(r), linear(g), linear(b))
    };
    let at = uv * 4.0;
    if filter == NEAREST {
        return texel(at.x.floor() as i64, at.y.floor() as i64);
    }
    let (low, part) = ((at - 0.5).floor(), (at - 0.5).fract_gl());
    let (i, j) = (low.x as i64, low.y as i64);
    let row = |j: i64| texel(i, j).lerp(texel(i + 1, j), part.x);
    row(j).lerp(row(j + 1), part.y)
}

/// Texture coordinates of a place: three repetitions, the picture in the middle.
fn coordinates(at: DVec2) -> DVec2 {
    0.5 + DVec2::new(1.5, -1.5) * at
}

/// A file of squares, each with its material and expected colours.
struct Squares {
    model: Model,
    expected: Vec<Expected>,
}

impl Squares {
    fn texture(&mut self, wrap: [u32; 2], filter: u32) -> usize {
        self.model.texture(
            4,
            4,
            &texels(),
            json!({ "wrapS": wrap[0], "wrapT": wrap[1], "magFilter": filter }),
        )
    }

    /// Adds a square with more attributes. Its second set of coordinates is half of the first.
    fn add(&mut self, material: Value, more: Value, expected: impl Fn(DVec2) -> DVec3 + 'static) {
        let m = &mut self.model;
        let corners = [
            [-1., -1.],
            [1., -1.],
            [1., 1.],
            [-1., -1.],
            [1., 1.],
            [-1., 1.],
        ]
        .map(|[x, y]| DVec2::new(x, y));
        let uv = |scale: f64| corners.map(|c| (coordinates(c) * scale).as_vec2().to_array());
        let number = self.expected.len();
        let (column, row) = (number % COLUMNS, number / COLUMNS);
        let mut attributes = json!({
            "POSITION": m.floats(&corners.map(|c| c.as_vec2().extend(0.0).to_array())),
            "NORMAL": m.floats(&[[0., 0., 1.]; 6]),
            "TEXCOORD_0": m.floats(&uv(1.0)),
            "TEXCOORD_1": m.floats(&uv(0.5)),
        });
        attributes
            .as_object_mut()
            .unwrap()
            .extend(more.as_object().unwrap().clone());
        let material = m.material(material);
        let mesh = m.mesh(attributes, Some(material));
        m.node(json!({ "mesh": mesh, "translation": [2 * column, 2 * row, 0] }));
        self.expected.push(Box::new(expected));
    }

    /// COLOR_0 by corner.
    fn colors(
        &mut self,
        component: u32,
        channels: usize,
        color: impl Fn(DVec2) -> [f64; 4],
    ) -> Value {
        let corners = [
            [-1., -1.],
            [1., -1.],
            [1., 1.],
            [-1., -1.],
            [1., 1.],
            [-1., 1.],
        ]
        .map(|[x, y]| DVec2::new(x, y));
        let mut bytes = Vec::new();
        for value in corners.iter().flat_map(|c| color(*c)[..channels].to_vec()) {
            match component {
                U8 => bytes.push((value * 255.0).round() as u8),
                U16 => bytes.extend(((value * 65535.0).round() as u16).to_le_bytes()),
                _ => bytes.extend((value as f32).to_le_bytes()),
            }
        }
        let kind = format!("VEC{channels}");
        let normalized = json!({ "normalized": component == U8 || component == U16 });
        json!({ "COLOR_0": self.model.raw(component, &kind, 6, &bytes, normalized) })
    }
}

fn unlit(pbr: Value) -> Value {
    json!({ "pbrMetallicRoughness": pbr, "extensions": { "KHR_materials_unlit": {} } })
}

/// Without a lobe, so that the sun's light is the base colour.
fn matte(pbr: Value) -> Value {
    json!({ "pbrMetallicRoughness": pbr, "extensions": { "KHR_materials_specular": { "specularFactor": 0 } } })
}

/// A colour that changes evenly over a square, and so over both of its triangles.
fn even(at: DVec2) -> [f64; 4] {
    [
        0.5 + 0.4 * at.x,
        0.5 - 0.3 * at.y,
        0.3 + 0.1 * at.x + 0.1 * at.y,
        0.5 + 0.5 * at.x,
    ]
}

fn color_of(at: DVec2) -> DVec3 {
    DVec3::from_slice(&even(at)[..3])
}

fn squares() -> Squares {
    let mut s = Squares {
        model: Model::new(),
        expected: Vec::new(),
    };
    for u in [REPEAT, CLAMP, MIRROR] {
        for v in [REPEAT, CLAMP, MIRROR] {
            let texture = s.texture([u, v], LINEAR);
            let material = unlit(json!({ "baseColorTexture": { "index": texture } }));
            s.add(material, json!({}), move |at| {
                looked_up(coordinates(at), [u, v], LINEAR)
            });
        }
    }
    for wrap in [[REPEAT, REPEAT], [MIRROR, CLAMP]] {
        let texture = s.texture(wrap, NEAREST);
        let material = unlit(json!({ "baseColorTexture": { "index": texture } }));
        s.add(material, json!({}), move |at| {
            looked_up(coordinates(at), wrap, NEAREST)
        });
    }
    // Unlit and lit colours of vertices, of every type.
    let colors = s.colors(common::model_file::FLOAT, 3, even);
    s.add(
        unlit(json!({ "baseColorFactor": [0.8, 1, 1, 1] })),
        colors,
        |at| color_of(at) * DVec3::new(0.8, 1.0, 1.0),
    );
    let colors = s.colors(U8, 4, even);
    s.add(
        matte(json!({ "metallicFactor": 0, "baseColorFactor": [1, 0.5, 1, 1] })),
        colors,
        |at| color_of(at) * DVec3::new(1.0, 0.5, 1.0),
    );
    let (colors, texture) = (s.colors(U16, 4, even), s.texture([CLAMP, REPEAT], NEAREST));
    let pbr = json!({ "metallicFactor": 0, "baseColorTexture": { "index": texture } });
    s.add(matte(pbr), colors, |at| {
        color_of(at) * looked_up(coordinates(at), [CLAMP, REPEAT], NEAREST)
    });
    let colors = s.colors(U16, 3, even);
    s.add(unlit(json!({})), colors, color_of);
    // The second set, alone with a transform, and next to the first.
    let texture = s.texture([CLAMP, MIRROR], LINEAR);
    let transform = json!({ "KHR_texture_transform": { "scale": [2, 4], "offset": [0.25, -0.5] } });
    let reference = json!({ "index": texture, "texCoord": 1, "extensions": transform });
    s.add(
        unlit(json!({ "baseColorTexture": reference })),
        json!({}),
        |at| {
            looked_up(
                coordinates(at) * DVec2::new(1.0, 2.0) + DVec2::new(0.25, -0.5),
                [CLAMP, MIRROR],
                LINEAR,
            )
        },
    );
    let (base, glow) = (
        s.texture([REPEAT, REPEAT], LINEAR),
        s.texture([REPEAT, CLAMP], LINEAR),
    );
    let mut material = matte(
        json!({ "baseColorFactor": [0, 0, 0, 1], "baseColorTexture": { "index": base }, "metallicFactor": 0 }),
    );
    material["emissiveFactor"] = json!([1, 1, 1]);
    material["emissiveTexture"] = json!({ "index": glow, "texCoord": 1 });
    s.add(material, json!({}), |at| {
        looked_up(coordinates(at) * 0.5, [REPEAT, CLAMP], LINEAR)
    });
    let (base, glow) = (
        s.texture([REPEAT, REPEAT], LINEAR),
        s.texture([MIRROR, MIRROR], LINEAR),
    );
    let mut material =
        matte(json!({ "metallicFactor": 0, "baseColorTexture": { "index": base, "texCoord": 1 } }));
    material["emissiveFactor"] = json!([0, 0, 0]);
    material["emissiveTexture"] = json!({ "index": glow });
    s.add(material, json!({}), |at| {
        looked_up(coordinates(at) * 0.5, [REPEAT, REPEAT], LINEAR)
    });
    // A mask by the alpha of vertices: half of it is there.
    let colors = s.colors(U8, 4, even);
    let mut masked = unlit(json!({}));
    masked["alphaMode"] = json!("MASK");
    s.add(masked, colors, |at| {
        if at.x < 0.0 {
            DVec3::ZERO
        } else {
            color_of(at)
        }
    });
    s
}

fn opened() -> (Scene, Vec<Expected>) {
    let Squares { model, expected } = squares();
    let mut scene = model.open().unwrap();
    assert_eq!(scene.warnings, [""; 0]);
    (scene.lights, scene.sky) = (vec![sun()], Vec3::ZERO);
    (scene, expected)
}

/// From the front, with irradiance pi: lit surfaces are as bright as their base colour.
fn sun() -> Light {
    Light {
        name: "sun".into(),
        color: Vec3::splat(PI as f32),
        direction: Vec3::NEG_Z,
        shadow: false,
        ..Light::default()
    }
}

/// Squares and pixels meet: the picture holds all squares and nothing else.
fn viewed(settings: &[(&str, &str)]) -> Experiment {
    let mut e = experiment(
        "cornell",
        ((CELL * COLUMNS) as u32, (CELL * ROWS) as u32),
        settings,
    );
    let (x, y) = (COLUMNS as f32 - 1.0, ROWS as f32 - 1.0);
    let fov = 10.0f32;
    let far = ROWS as f32 / (0.5 * fov).to_radians().tan();
    e.camera = CameraChoice::Placed(PlacedCamera::new((x, y, far), (x, y, 0.0), fov));
    e
}

enum How {
    Method(&'static [(&'static str, &'static str)]),
    Reference,
}

/// Everything that shades: G-buffers that are rasterised and computed, shading in fragments, the reference.
const SHADERS: [(&str, How); 4] = [
    ("rasterised G-buffer", How::Method(&[("gbuffer", "raster")])),
    ("computed G-buffer", How::Method(&[("gbuffer", "compute")])),
    ("forward shading", How::Method(&[("merge", "average")])),
    ("reference", How::Reference),
];

/// Emitted and directly reflected radiance.
fn seen(scene: &Scene, how: &How) -> Vec<[f32; 3]> {
    let scene = Arc::new(scene.clone());
    match how {
        How::Method(settings) => {
            let lab = lab(root());
            let e = viewed(&[&[("voxel_dim", "16"), ("shadow_dim", "256")][..], settings].concat());
            let wanted = ["radiance", "diffuseIndirect", "specularIndirect"].map(String::from);
            let (mut session, _) = lab.prepare(&e, scene, |_| Ok(wanted.to_vec())).unwrap();
            session.frame(0.0).unwrap();
            session.finish().unwrap();
            assert_clean(&lab);
            let [all, diffuse, specular] = wanted.map(|w| floats(&mut session, &w, 0));
            let mut rest = diffuse.iter().zip(&specular);
            let emitted = all.iter().map(|t| {
                rest.next()
                    .map(|(d, s)| [0, 1, 2].map(|i| t[i] - d[i] - s[i]))
                    .unwrap()
            });
            emitted.collect()
        }
        How::Reference => {
            let home = home();
            let lab = lab(home.path());
            let goal = Goal::Samples(16);
            let found = gather(&lab, &viewed(&[]), &scene, 1, goal, &mut |_| {
                ControlFlow::Continue(())
            })
            .unwrap();
            assert_clean(&lab);
            let [all, diffuse, specular] =
                ["total", "diffuse", "specular"].map(|part| &found.parts[part].mean.rgb);
            let rest = diffuse.iter().zip(specular);
            all.iter()
                .zip(rest)
                .map(|(t, (d, s))| [0, 1, 2].map(|i| t[i] - d[i] - s[i]))
                .collect()
        }
    }
}

#[test]
fn every_pixel_of_a_texture_or_colour_is_what_the_specification_says() {
    let (scene, expected) = opened();
    let folder = tempfile::tempdir().unwrap();
    let exported = folder.path().join("again.glb");
    assert_eq!(scene.export(&exported).unwrap(), [""; 0]);
    let mut again = common::model_file::open(&exported).unwrap();
    (again.lights, again.sky) = (vec![sun()], Vec3::ZERO);
    let mut wrong = Vec::new();
    for (scene, shaders) in [(&scene, &SHADERS[..]), (&again, &SHADERS[1..2])] {
        for (name, how) in shaders {
            let picture = seen(scene, how);
            for (number, expected) in expected.iter().enumerate() {
                let (column, row) = (number % COLUMNS, ROWS - 1 - number / COLUMNS);
                let (mut worst, mut place) = (0.0f64, (0, 0));
                for (x, y) in (0..CELL * CELL).map(|i| (i % CELL, i / CELL)) {
                    let at = (DVec2::new(x as f64, y as f64) + 0.5) / CELL as f64 * 2.0 - 1.0;
                    let wanted = expected(DVec2::new(at.x, -at.y));
                    let found = picture[(row * CELL + y) * CELL * COLUMNS + column * CELL + x];
                    let off = (DVec3::from(found.map(f64::from)) - wanted)
                        .abs()
                        .max_element();
                    if off > worst {
                        (worst, place) = (off, (x, y));
                    }
                }
                println!("{name}, square {number}: {worst:.4}");
                if worst > 0.012 {
                    wrong.push(format!(
                        "{name}, square {number}: off by {worst:.3} at {place:?}"
                    ));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A square with these colours at its ends, 1 m above a floor.
fn under_a_coloured_lamp(colors: [Vec4; 2], floor: f32) -> Scene {
    let square = |edge: f32, material: u32, colors: [Vec4; 2]| {
        let at = |x: f32, z: f32| Vertex {
            position: [(x - 0.5) * edge, 0.0, (z - 0.5) * edge],
            normal: [0.0, 1.0, 0.0],
            tangent: [1.0, 0.0, 0.0, 1.0],
            color: colors[0].lerp(colors[1], x).to_array(),
            ..Vertex::default()
        };
        Mesh {
            name: "square".into(),
            vertices: vec![at(0.0, 0.0), at(0.0, 1.0), at(1.0, 1.0), at(1.0, 0.0)],
            indices: vec![0, 1, 2, 0, 2, 3],
            submeshes: vec![Submesh {
                first_index: 0,
                index_count: 6,
                material,
            }],
        }
    };
    let grey = Material {
        base_color: Vec4::new(0.5, 0.5, 0.5, 1.0),
        specular: 0.0,
        ..Material::default()
    };
    let lamp = Material {
        emission: Vec3::splat(7.0),
        base_color: Vec4::W,
        tinted_emission: true,
        specular: 0.0,
        ..Material::default()
    };
    let place = |mesh: u32, height: f32| Instance {
        name: format!("square {mesh}"),
        mesh,
        transform: Mat4::from_translation(Vec3::Y * height),
        mover: None,
    };
    Scene {
        name: "lamp".into(),
        meshes: vec![square(floor, 0, [Vec4::ONE; 2]), square(1.0, 1, colors)],
        materials: vec![grey, lamp],
        instances: vec![place(0, 0.0), place(1, 1.0)],
        ..Scene::default()
    }
}

const TINT: Vec4 = Vec4::new(0.8, 0.4, 0.1, 1.0);

/// From one side to the other it grows from 0 to twice the tint's half; over the middle the mean is the half.
const LAMPS: [(&str, [Vec4; 2], f64); 2] = [
    ("even", [TINT, TINT], 1.0),
    ("growing", [Vec4::new(0.0, 0.0, 0.0, 1.0), TINT], 0.5),
];

#[test]
fn coloured_lamps_light_the_floor_by_their_form_factor() {
    // Siegel and Howell, C-11, for an edge of 1 m at 1 m.
    let root = 1.25f64.sqrt();
    let form = 4.0 / PI * 0.5 / root * (0.5 / root).atan();
    for (name, colors, share) in LAMPS {
        let home = home();
        let lab = lab(home.path());
        let mut look = experiment("lamp", (16, 12), &[]);
        look.camera =
            CameraChoice::Placed(PlacedCamera::new((0.0, 0.3, 0.3), (0.0, 0.0, 0.0), 1.0));
        let scene = Arc::new(under_a_coloured_lamp(colors, 200.0));
        let found = gather(&lab, &look, &scene, 1, Goal::Samples(256), &mut |_| {
            ControlFlow::Continue(())
        })
        .unwrap();
        assert_clean(&lab);
        let texels = &found.parts["diffuse"].mean.rgb;
        for channel in 0..3 {
            let mean =
                texels.iter().map(|t| f64::from(t[channel])).sum::<f64>() / texels.len() as f64;
            let expected = 0.5 * 7.0 * f64::from(TINT[channel]) * share * form;
            println!("{name}, channel {channel}: {mean:.5}, expected {expected:.5}");
            assert!(
                (mean / expected - 1.0).abs() < 0.02,
                "{name}, channel {channel}: {mean}, not {expected}"
            );
        }
    }
}

#[test]
fn voxels_have_the_colours_of_vertices() {
    for (name, colors, _) in LAMPS {
        let scene = Arc::new(under_a_coloured_lamp(colors, 4.0));
        for voxelizer in ["compute", "raster", "tessellated"] {
            let lab = lab(root());
            let mut e = experiment(
                "lamp",
                (16, 12),
                &[("voxelizer", voxelizer), ("voxel_dim", "32")],
            );
            e.camera =
                CameraChoice::Placed(PlacedCamera::new((0.0, 0.3, 0.3), (0.0, 0.0, 0.0), 20.0));
            let (mut session, _) = lab
                .prepare(&e, scene.clone(), |_| Ok(vec!["diffuseIndirect".into()]))
                .unwrap();
            session.run(16).unwrap();
            session.finish().unwrap();
            assert_clean(&lab);
            let texels = floats(&mut session, "diffuseIndirect", 0);
            let sum: Vec3 = texels.iter().map(|t| Vec3::from_slice(&t[..3])).sum();
            // Grey floor: the light has the tint of the lamp.
            let (found, expected) = (sum / sum.x, TINT.truncate() / TINT.x);
            println!("{name}, {voxelizer}: {found:.3}, expected {expected:.3}");
            assert!(
                sum.x > 0.0 && found.distance(expected) < 0.02,
                "{name}, {voxelizer}: {found}, not {expected}"
            );
        }
    }
}
