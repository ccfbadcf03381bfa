//! glTF files that tests build: one buffer that grows, pictures as data URIs.

use base64::Engine;
use conelab::scene::Scene;
use serde_json::{Value, json};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Component types.
pub const I8: u32 = 5120;
pub const U8: u32 = 5121;
pub const I16: u32 = 5122;
pub const U16: u32 = 5123;
pub const FLOAT: u32 = 5126;

/// Corners of the square from (-1, -1) to (1, 1) in z = 0, as two triangles; its texture coordinates have v downwards.
pub const SQUARE: [[f32; 3]; 6] = [
    [-1., -1., 0.],
    [1., -1., 0.],
    [1., 1., 0.],
    [-1., -1., 0.],
    [1., 1., 0.],
    [-1., 1., 0.],
];
pub const SQUARE_UV: [[f32; 2]; 6] = [[0., 1.], [1., 1.], [1., 0.], [0., 1.], [1., 0.], [0., 0.]];

pub fn data_uri(bytes: &[u8]) -> String {
    format!(
        "data:application/octet-stream;base64,{}",
        base64::engine::general_purpose::STANDARD.encode(bytes)
    )
}

pub fn png(width: u32, height: u32, rgba: &[[u8; 4]]) -> Vec<u8> {
    encoded(width, height, rgba, image::ImageFormat::Png)
}

pub fn encoded(width: u32, height: u32, rgba: &[[u8; 4]], format: image::ImageFormat) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let image = image::RgbaImage::from_raw(width, height, rgba.concat()).unwrap();
    image.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

pub struct Model {
    pub root: Value,
    bytes: Vec<u8>,
}

impl Model {
    pub fn new() -> Model {
        let root =
            json!({ "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [] }] });
        Model {
            root,
            bytes: Vec::new(),
        }
    }

    /// Adds to a list of the file.
    pub fn push(&mut self, list: &str, value: Value) -> usize {
        let lists = self.root.as_object_mut().unwrap();
        let list = lists
            .entry(list)
            .or_insert(json!([]))
            .as_array_mut()
            .unwrap();
        list.push(value);
        list.len() - 1
    }

    /// A view of the first buffer. Buffers that are pushed come after it.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        let view =
            json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.push("bufferViews", view)
    }

    /// An accessor of bytes that are its elements, and what else it says.
    pub fn raw(
        &mut self,
        component: u32,
        kind: &str,
        count: usize,
        bytes: &[u8],
        more: Value,
    ) -> usize {
        let view = self.view(bytes);
        let mut accessor =
            json!({ "bufferView": view, "componentType": component, "type": kind, "count": count });
        accessor
            .as_object_mut()
            .unwrap()
            .extend(more.as_object().unwrap().clone());
        self.push("accessors", accessor)
    }

    pub fn floats<const N: usize>(&mut self, values: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = values
            .iter()
            .flatten()
            .flat_map(|f| f.to_le_bytes())
            .collect();
        let of = |choose: fn(f32, f32) -> f32| -> Vec<f32> {
            (0..N)
                .map(|i| values.iter().map(|v| v[i]).reduce(choose).unwrap())
                .collect()
        };
        let bounds = json!({ "min": of(f32::min), "max": of(f32::max) });
        let kind = if N == 1 {
            "SCALAR".into()
        } else {
            format!("VEC{N}")
        };
        self.raw(FLOAT, &kind, values.len(), &bytes, bounds)
    }

    pub fn material(&mut self, material: Value) -> usize {
        self.push("materials", material)
    }

    /// A texture of texels in rows from the top.
    pub fn texture(&mut self, width: u32, height: u32, rgba: &[[u8; 4]], sampler: Value) -> usize {
        let image = self.push(
            "images",
            json!({ "uri": data_uri(&png(width, height, rgba)) }),
        );
        let sampler = self.push("samplers", sampler);
        self.push("textures", json!({ "source": image, "sampler": sampler }))
    }

    /// A mesh of one primitive.
    pub fn mesh(&mut self, attributes: Value, material: Option<usize>) -> usize {
        let mut primitive = json!({ "attributes": attributes });
        if let Some(material) = material {
            primitive["material"] = json!(material);
        }
        self.push("meshes", json!({ "primitives": [primitive] }))
    }

    /// The square as a mesh with normals, texture coordinates and more attributes.
    pub fn square(&mut self, more: Value, material: Option<usize>) -> usize {
        let positions = self.floats(&SQUARE);
        let normals = self.floats(&[[0., 0., 1.]; 6]);
        let uvs = self.floats(&SQUARE_UV);
        let mut attributes = json!({ "POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs });
        attributes
            .as_object_mut()
            .unwrap()
            .extend(more.as_object().unwrap().clone());
        self.mesh(attributes, material)
    }

    /// A node at the top of the scene.
    pub fn node(&mut self, node: Value) -> usize {
        let node = self.push("nodes", node);
        self.root["scenes"][0]["nodes"]
            .as_array_mut()
            .unwrap()
            .push(json!(node));
        node
    }

    /// Writes the file and gives its path.
    pub fn write(&self, folder: &Path, name: &str) -> PathBuf {
        let mut root = self.root.clone();
        if !self.bytes.is_empty() {
            let first = json!({ "byteLength": self.bytes.len(), "uri": data_uri(&self.bytes) });
            let others = self
                .root
                .get("buffers")
                .and_then(Value::as_array)
                .into_iter()
                .flatten();
            root["buffers"] = std::iter::once(&first).chain(others).cloned().collect();
        }
        let path = folder.join(name);
        std::fs::write(&path, root.to_string()).unwrap();
        path
    }

    pub fn open(&self) -> Result<Scene, String> {
        let folder = tempfile::tempdir().unwrap();
        open(&self.write(folder.path(), "m.gltf"))
    }
}

pub fn open(path: &Path) -> Result<Scene, String> {
    Scene::open(&path.to_string_lossy(), &|_, _| ControlFlow::Continue(()))
        .map_err(|e| e.to_string())
}

/// A strip from y 0 to 2 on two joints, the upper of which turns by 90 degrees in a second, or has turned already.
pub fn bending(m: &mut Model, at_rest: bool) {
    let positions = m.floats(&[
        [-0.5, 0., 0.],
        [0.5, 0., 0.],
        [0.5, 1., 0.],
        [0.5, 2., 0.],
        [-0.5, 2., 0.],
    ]);
    let normals = m.floats(&[[0., 0., 1.]; 5]);
    let (low, both, high) = ([1., 0., 0., 0.], [0.5, 0.5, 0., 0.], [0., 1., 0., 0.]);
    let weights = m.floats(&[low, low, both, high, high]);
    let joints = m.raw(U8, "VEC4", 5, &[0u8, 1, 0, 0].repeat(5), json!({}));
    let attributes = json!({ "POSITION": positions, "NORMAL": normals, "JOINTS_0": joints, "WEIGHTS_0": weights });
    let indices = m.raw(U8, "SCALAR", 9, &[0, 1, 2, 0, 2, 4, 2, 3, 4], json!({}));
    let primitive = json!({ "attributes": attributes, "indices": indices });
    let mesh = m.push("meshes", json!({ "primitives": [primitive] }));
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let turned = if at_rest {
        [0., 0., half, half]
    } else {
        [0., 0., 0., 1.]
    };
    let upper = m.push(
        "nodes",
        json!({ "translation": [0, 1, 0], "rotation": turned }),
    );
    let lower = m.node(json!({ "children": [upper] }));
    let down = |y: f32| {
        [
            1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., y, 0., 1f32,
        ]
    };
    let bytes: Vec<u8> = [down(0.0), down(-1.0)]
        .concat()
        .iter()
        .flat_map(|f| f.to_le_bytes())
        .collect();
    let inverse = m.raw(FLOAT, "MAT4", 2, &bytes, json!({}));
    let skin = m.push(
        "skins",
        json!({ "joints": [lower, upper], "inverseBindMatrices": inverse }),
    );
    m.node(json!({ "mesh": mesh, "skin": skin, "translation": [7, 8, 9] }));
    if !at_rest {
        let (times, values) = (
            m.floats(&[[0.0], [1.0]]),
            m.floats(&[[0., 0., 0., 1.], [0., 0., half, half]]),
        );
        let channel = json!({ "sampler": 0, "target": { "node": upper, "path": "rotation" } });
        let sampler = json!({ "input": times, "output": values });
        m.push(
            "animations",
            json!({ "samplers": [sampler], "channels": [channel] }),
        );
    }
}
