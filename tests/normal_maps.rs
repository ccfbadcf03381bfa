//! Normal maps against the real geometry that they stand for: a map that leans up must look like slats that lean up,
//! however its picture lies on the surface, whatever mirrors the node, and whether or not the file has tangents.

mod common;

use base64::Engine;
use common::{assert_clean, experiment, lab, root};
use conelab::experiment::{CameraChoice, Experiment, PlacedCamera};
use conelab::measure::reference::{Goal, gather};
use conelab::scene::{Light, Scene};
use glam::{Vec2, Vec3};
use serde_json::{Value, json};
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

/// The eight ways to lay a square picture on a square: where its right and its down point, x to the right and y up.
const LAYINGS: [(Vec2, Vec2); 8] = [
    (Vec2::X, Vec2::NEG_Y),
    (Vec2::Y, Vec2::X),
    (Vec2::NEG_X, Vec2::Y),
    (Vec2::NEG_Y, Vec2::NEG_X),
    (Vec2::NEG_X, Vec2::NEG_Y),
    (Vec2::Y, Vec2::NEG_X),
    (Vec2::X, Vec2::Y),
    (Vec2::NEG_Y, Vec2::X),
];

/// How nodes are mirrored.
const MIRRORS: [Vec3; 4] = [
    Vec3::ONE,
    Vec3::new(-1.0, 1.0, 1.0),
    Vec3::new(1.0, -1.0, 1.0),
    Vec3::new(1.0, 1.0, -1.0),
];

/// Metres from case to case; a square has one.
const PITCH: f32 = 1.25;

/// Corners of a square around the origin.
const CORNERS: [Vec2; 4] = [
    Vec2::new(-0.5, -0.5),
    Vec2::new(0.5, -0.5),
    Vec2::new(0.5, 0.5),
    Vec2::new(-0.5, 0.5),
];

/// The texture coordinate of a point under a laying; v grows down the picture.
fn uv(at: Vec2, (right, down): (Vec2, Vec2)) -> Vec2 {
    Vec2::new(at.dot(right), at.dot(down)) + 0.5
}

/// The texel of a map that leans half a right angle towards +y of the surface under a laying. Red grows to the
/// picture's right and green to its top (glTF 2.0, `material.normalTexture`).
fn texel((right, down): (Vec2, Vec2)) -> [u8; 3] {
    let lean = Vec3::new(Vec2::Y.dot(right), Vec2::Y.dot(-down), 1.0).normalize();
    (lean * 127.5 + 127.5).round().to_array().map(|v| v as u8)
}

fn png(texel: [u8; 3]) -> Vec<u8> {
    let mut png = std::io::Cursor::new(Vec::new());
    image::RgbImage::from_raw(1, 1, texel.to_vec())
        .unwrap()
        .write_to(&mut png, image::ImageFormat::Png)
        .unwrap();
    png.into_inner()
}

fn data_uri(bytes: &[u8]) -> String {
    format!(
        "data:application/octet-stream;base64,{}",
        base64::engine::general_purpose::STANDARD.encode(bytes)
    )
}

/// A glTF file that grows.
struct File {
    root: Value,
    bytes: Vec<u8>,
}

impl File {
    fn new() -> File {
        let root = json!({ "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [] }], "nodes": [], "meshes": [],
            "materials": [], "accessors": [], "bufferViews": [], "images": [], "textures": [] });
        File {
            root,
            bytes: Vec::new(),
        }
    }

    fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.root[list].as_array_mut().unwrap();
        list.push(value);
        list.len() - 1
    }

    fn accessor<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = values
            .iter()
            .flatten()
            .flat_map(|f| f.to_le_bytes())
            .collect();
        let view =
            json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        self.bytes.extend(bytes);
        let view = self.push("bufferViews", view);
        let of = |choose: fn(f32, f32) -> f32| -> Vec<f32> {
            (0..N)
                .map(|i| values.iter().map(|v| v[i]).reduce(choose).unwrap())
                .collect()
        };
        let (low, high) = (of(f32::min), of(f32::max));
        self.push(
            "accessors",
            json!({ "bufferView": view, "componentType": 5126, "type": format!("VEC{N}"),
            "count": values.len(), "min": low, "max": high }),
        )
    }

    fn material(&mut self, map: Option<[u8; 3]>, scale: f32) -> usize {
        let mut material = json!({ "pbrMetallicRoughness": { "metallicFactor": 0 } });
        if let Some(texel) = map {
            let image = self.push("images", json!({ "uri": data_uri(&png(texel)) }));
            let texture = self.push("textures", json!({ "source": image }));
            material["normalTexture"] = json!({ "index": texture, "scale": scale });
        }
        self.push("materials", material)
    }

    /// Quads of four corners each.
    fn mesh(
        &mut self,
        quads: &[[Vec3; 4]],
        normal: Vec3,
        uvs: Option<[Vec2; 4]>,
        tangent: Option<[f32; 4]>,
        material: usize,
    ) -> usize {
        let corners: Vec<[f32; 3]> = quads
            .iter()
            .flat_map(|q| [0, 1, 2, 0, 2, 3].map(|i| q[i].to_array()))
            .collect();
        let mut attributes = json!({ "POSITION": self.accessor(&corners), "NORMAL": self.accessor(&vec![normal.to_array(); corners.len()]) });
        if let Some(uvs) = uvs {
            attributes["TEXCOORD_0"] =
                json!(self.accessor(&[0, 1, 2, 0, 2, 3].map(|i| uvs[i].to_array())));
        }
        if let Some(tangent) = tangent {
            attributes["TANGENT"] = json!(self.accessor(&[tangent; 6]));
        }
        self.push(
            "meshes",
            json!({ "primitives": [{ "attributes": attributes, "material": material }] }),
        )
    }

    fn place(&mut self, mesh: usize, at: Vec3, scale: Vec3) {
        let node = self.push(
            "nodes",
            json!({ "mesh": mesh, "translation": at.to_array(), "scale": scale.to_array() }),
        );
        self.root["scenes"][0]["nodes"]
            .as_array_mut()
            .unwrap()
            .push(json!(node));
    }

    fn write(mut self, path: &Path) {
        self.root["buffers"] =
            json!([{ "byteLength": self.bytes.len(), "uri": data_uri(&self.bytes) }]);
        std::fs::write(path, self.root.to_string()).unwrap();
    }
}

/// Eight slats that lean up by half a right angle, a square as seen from +z.
fn slats() -> Vec<[Vec3; 4]> {
    let slat = |i: i32| {
        let low = -0.5 + i as f32 / 8.0;
        [
            (-0.5, low, 0.125),
            (0.5, low, 0.125),
            (0.5, low + 0.125, 0.0),
            (-0.5, low + 0.125, 0.0),
        ]
        .map(Vec3::from)
    };
    (0..8).map(slat).collect()
}

fn flat() -> [Vec3; 4] {
    CORNERS.map(|c| c.extend(0.0))
}

/// The tangent of a laying, by the specification: the picture's right, and the sign that makes
/// `cross(normal, tangent) * w` its top.
fn tangent((right, down): (Vec2, Vec2)) -> [f32; 4] {
    let bitangent = Vec3::Z.cross(right.extend(0.0));
    right
        .extend(0.0)
        .extend(bitangent.dot(-down.extend(0.0)).signum())
        .to_array()
}

/// What stands at a column and a row: rows are mirrors; columns are the slats, and then the layings, without tangents and
/// with.
const COLUMNS: usize = 1 + 2 * LAYINGS.len();

fn place_of(column: usize, row: usize) -> Vec3 {
    Vec3::new(PITCH * column as f32, PITCH * row as f32, 0.0)
}

/// The scene of all glTF cases.
fn gltf_cases(path: &Path) {
    let mut file = File::new();
    let plain = file.material(None, 1.0);
    let real = file.mesh(
        &slats(),
        Vec3::new(0.0, 1.0, 1.0).normalize(),
        None,
        None,
        plain,
    );
    let mut meshes = vec![real];
    for given in [false, true] {
        for laying in LAYINGS {
            let material = file.material(Some(texel(laying)), 1.0);
            let uvs = CORNERS.map(|c| uv(c, laying));
            meshes.push(file.mesh(
                &[flat()],
                Vec3::Z,
                Some(uvs),
                given.then(|| tangent(laying)),
                material,
            ));
        }
    }
    for (row, mirror) in MIRRORS.iter().enumerate() {
        for (column, mesh) in meshes.iter().enumerate() {
            file.place(*mesh, place_of(column, row), *mirror);
        }
    }
    file.write(path);
}

/// The light of every case, `light[row][column]`, by the sun from above or below; `how` says what renders.
enum How<'a> {
    Method(&'a [(&'a str, &'a str)]),
    Reference,
}

/// Pixels of a case in both directions.
const CELL: u32 = 8;

fn sun(direction: Vec3) -> Light {
    let color = Vec3::splat(std::f32::consts::PI);
    Light {
        name: "sun".into(),
        color,
        direction: direction.normalize(),
        shadow: false,
        ..Light::default()
    }
}

/// From far away, so that all cases of a column are seen at nearly one angle.
fn viewed(columns: usize, rows: usize, settings: &[(&str, &str)]) -> Experiment {
    let mut e = experiment(
        "cornell",
        (CELL * columns as u32, CELL * rows as u32),
        settings,
    );
    let centre = 0.5 * PITCH * Vec3::new(columns as f32 - 1.0, rows as f32 - 1.0, 0.0);
    let fov = 2.0_f32;
    let far = 0.5 * PITCH * rows as f32 / (0.5 * fov).to_radians().tan();
    let (x, y) = (centre.x, centre.y);
    e.camera = CameraChoice::Placed(PlacedCamera::new((x, y, far), (x, y, 0.0), fov));
    e
}

/// The direct light in the middle of each case, row by row from below.
fn direct(scene: &Scene, columns: usize, rows: usize, how: &How) -> Vec<Vec<f32>> {
    let lab = lab(root());
    let scene = Arc::new(scene.clone());
    let texels: Vec<f32> = match how {
        How::Method(settings) => {
            let base = [("voxel_dim", "16"), ("shadow_dim", "256")];
            let e = viewed(columns, rows, &[&base[..], settings].concat());
            let (mut session, _) = lab
                .prepare(&e, scene, |_| Ok(vec!["direct".into()]))
                .unwrap();
            session.frame(0.0).unwrap();
            session.finish().unwrap();
            common::floats(&mut session, "direct", 0)
                .iter()
                .map(|t| t[0])
                .collect()
        }
        How::Reference => {
            let home = common::home();
            let e = viewed(columns, rows, &[]);
            let lab = common::lab(home.path());
            let found = gather(&lab, &e, &scene, 1, Goal::Samples(32), &mut |_| {
                ControlFlow::Continue(())
            })
            .unwrap();
            found.parts["direct"]
                .mean
                .rgb
                .iter()
                .map(|t| t[0])
                .collect()
        }
    };
    assert_clean(&lab);
    let width = CELL as usize * columns;
    let middle = |column: usize, row: usize| {
        let y = CELL as usize * (rows - 1 - row) + CELL as usize / 2;
        texels[y * width + CELL as usize * column + CELL as usize / 2]
    };
    (0..rows)
        .map(|row| (0..columns).map(|column| middle(column, row)).collect())
        .collect()
}

const ABOVE: Vec3 = Vec3::new(0.0, -0.96, -0.28);
const BELOW: Vec3 = Vec3::new(0.0, 0.96, -0.28);

fn open(path: &Path) -> Scene {
    let mut scene =
        Scene::open(&path.to_string_lossy(), &|_, _| ControlFlow::Continue(())).unwrap();
    scene.sky = Vec3::ZERO;
    scene
}

/// Everything that shades: the rasterised and the computed G-buffer, shading in fragments, the reference.
const SHADERS: [(&str, How); 4] = [
    ("rasterised G-buffer", How::Method(&[("gbuffer", "raster")])),
    ("computed G-buffer", How::Method(&[("gbuffer", "compute")])),
    ("forward shading", How::Method(&[("merge", "average")])),
    ("reference", How::Reference),
];

#[test]
fn a_map_that_leans_up_looks_like_slats_that_lean_up() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("cases.gltf");
    gltf_cases(&path);
    // Written and read once more, as .glb: an export keeps the sign.
    let exported = dir.path().join("exported.glb");
    open(&path).export(&exported).unwrap();
    for (file, shaders) in [(&path, &SHADERS[..]), (&exported, &SHADERS[..1])] {
        for (light, direction) in [("above", ABOVE), ("below", BELOW)] {
            let mut scene = open(file);
            scene.lights = vec![sun(direction)];
            for (name, how) in shaders {
                let found = direct(&scene, COLUMNS, MIRRORS.len(), how);
                for (row, mirror) in found.iter().zip(MIRRORS) {
                    // Mirrored in y or z, slats as seen from +z lean down.
                    let lit = (light == "above") == (mirror.y * mirror.z > 0.0);
                    assert_eq!(
                        row[0] > 0.5,
                        lit,
                        "{name}, light from {light}, slats mirrored by {mirror}: {}",
                        row[0]
                    );
                    for (column, value) in row.iter().enumerate().skip(1) {
                        let what = format!(
                            "{name}, light from {light}, mirrored by {mirror}, case {column}"
                        );
                        assert!(
                            (value - row[0]).abs() < 0.02,
                            "{what}: {value} and not {}",
                            row[0]
                        );
                    }
                }
            }
        }
    }
}

/// OBJ files have no tangents, and v grows up the picture.
#[test]
fn maps_of_obj_files_lean_as_their_pictures_do() {
    let dir = tempfile::tempdir().unwrap();
    let mut mtl = "newmtl plain\n".to_owned();
    let mut obj = "mtllib cases.mtl\nvn 0 0.70710678 0.70710678\nvn 0 0 1\n".to_owned();
    let mut corners = 0;
    let mut quad =
        |obj: &mut String, quad: [Vec3; 4], uvs: [Vec2; 4], normal: u32, column: usize| {
            for (p, t) in quad.iter().zip(uvs) {
                let at = *p + place_of(column, 0);
                obj.push_str(&format!(
                    "v {} {} {}\nvt {} {}\n",
                    at.x,
                    at.y,
                    at.z,
                    t.x,
                    1.0 - t.y
                ));
            }
            let corner = |i: u32| format!("{0}/{0}/{normal}", corners + i);
            obj.push_str(&format!(
                "f {} {} {} {}\n",
                corner(1),
                corner(2),
                corner(3),
                corner(4)
            ));
            corners += 4;
        };
    obj.push_str("usemtl plain\n");
    slats()
        .iter()
        .for_each(|slat| quad(&mut obj, *slat, CORNERS, 1, 0));
    for (i, entry) in ["norm", "map_Bump -bm 1.0"].iter().enumerate() {
        for (j, laying) in LAYINGS.iter().enumerate() {
            let column = 1 + i * LAYINGS.len() + j;
            std::fs::write(
                dir.path().join(format!("{column}_normal.png")),
                png(texel(*laying)),
            )
            .unwrap();
            mtl.push_str(&format!("newmtl m{column}\n{entry} {column}_normal.png\n"));
            obj.push_str(&format!("usemtl m{column}\n"));
            quad(&mut obj, flat(), CORNERS.map(|c| uv(c, *laying)), 2, column);
        }
    }
    std::fs::write(dir.path().join("cases.mtl"), mtl).unwrap();
    std::fs::write(dir.path().join("cases.obj"), obj).unwrap();
    for (direction, lit) in [(ABOVE, true), (BELOW, false)] {
        let mut scene = open(&dir.path().join("cases.obj"));
        scene.lights = vec![sun(direction)];
        let found = &direct(&scene, COLUMNS, 1, &SHADERS[0].1)[0];
        assert_eq!(found[0] > 0.5, lit, "slats: {}", found[0]);
        for (column, value) in found.iter().enumerate().skip(1) {
            assert!(
                (value - found[0]).abs() < 0.02,
                "case {column}: {value} and not {}",
                found[0]
            );
        }
    }
}

/// `normalTexture.scale` multiplies x and y before the normal is normalised (glTF 2.0, normalTextureInfo.scale).
#[test]
fn scales_of_normal_maps_are_those_of_the_specification() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("scales.gltf");
    let scales = [0.0_f32, 0.25, 0.5, 1.0, 1.4, 2.0, 4.0];
    let mut file = File::new();
    for (column, scale) in scales.iter().enumerate() {
        let material = file.material(Some(texel(LAYINGS[0])), *scale);
        let mesh = file.mesh(
            &[flat()],
            Vec3::Z,
            Some(CORNERS.map(|c| uv(c, LAYINGS[0]))),
            None,
            material,
        );
        file.place(mesh, place_of(column, 0), Vec3::ONE);
    }
    file.write(&path);
    let mut scene = open(&path);
    scene.lights = vec![sun(Vec3::NEG_Z)];
    // Without a lobe direct light is albedo times the cosine.
    scene
        .materials
        .iter_mut()
        .for_each(|m| (m.specular, m.base_color) = (0.0, glam::Vec4::ONE));
    for (name, how) in SHADERS {
        for (value, scale) in direct(&scene, scales.len(), 1, &how)[0].iter().zip(scales) {
            let cosine = 1.0 / (1.0 + scale * scale).sqrt();
            assert!(
                (value - cosine).abs() < 0.01,
                "{name}, scale {scale}: {value} and not {cosine}"
            );
        }
    }
}
