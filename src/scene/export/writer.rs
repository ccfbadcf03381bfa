//! The binary buffer of a glTF file, its views and accessors, and the nodes.

use glam::Vec3;
use serde_json::{Value, json};

use crate::scene::{Mesh, Vertex};

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;

#[derive(Default)]
pub(super) struct Writer {
    pub bytes: Vec<u8>,
    pub views: Vec<Value>,
    pub accessors: Vec<Value>,
    pub nodes: Vec<Value>,
    /// Nodes without a parent.
    pub roots: Vec<usize>,
}

impl Writer {
    /// Appends bytes with 4-byte alignment and returns the index of their view.
    pub fn view(&mut self, bytes: &[u8], more: Value) -> usize {
        let mut view =
            json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() });
        if let (Some(view), Some(more)) = (view.as_object_mut(), more.as_object()) {
            view.extend(more.clone());
        }
        self.bytes.extend_from_slice(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(view);
        self.views.len() - 1
    }

    fn accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    pub fn mesh(&mut self, mesh: &Mesh) -> Value {
        // Few meshes use the second set and the colours, which are last in a vertex.
        let more = mesh.vertices.iter().any(|v| v.uv_second != [0.0; 2]) || mesh.has_colors();
        let stride = if more {
            size_of::<Vertex>()
        } else {
            std::mem::offset_of!(Vertex, uv_second)
        };
        let mut bytes = Vec::with_capacity(mesh.vertices.len() * stride);
        mesh.vertices
            .iter()
            .for_each(|v| bytes.extend_from_slice(&bytemuck::bytes_of(v)[..stride]));
        let vertices = self.view(&bytes, json!({ "byteStride": stride, "target": 34962 }));
        let positions = mesh.vertices.iter().map(|v| Vec3::from_array(v.position));
        let (low, high) = positions.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), p| {
            (l.min(p), h.max(p))
        });
        let mut attribute = |offset: usize, kind: &str| {
            self.accessors.push(
                json!({ "bufferView": vertices, "byteOffset": offset, "componentType": FLOAT,
                "type": kind, "count": mesh.vertices.len() }),
            );
            self.accessors.len() - 1
        };
        let mut attributes = json!({
            "POSITION": attribute(std::mem::offset_of!(Vertex, position), "VEC3"),
            "NORMAL": attribute(std::mem::offset_of!(Vertex, normal), "VEC3"),
            "TANGENT": attribute(std::mem::offset_of!(Vertex, tangent), "VEC4"),
            "TEXCOORD_0": attribute(std::mem::offset_of!(Vertex, uv), "VEC2"),
        });
        if more {
            attributes["TEXCOORD_1"] =
                json!(attribute(std::mem::offset_of!(Vertex, uv_second), "VEC2"));
            attributes["COLOR_0"] = json!(attribute(std::mem::offset_of!(Vertex, color), "VEC4"));
        }
        if let Some(position) = attributes["POSITION"].as_u64() {
            self.accessors[position as usize]["min"] = json!(low.to_array());
            self.accessors[position as usize]["max"] = json!(high.to_array());
        }
        let indices = self.view(
            bytemuck::cast_slice(&mesh.indices),
            json!({ "target": 34963 }),
        );
        let primitives = mesh.submeshes.iter().map(|submesh| {
            let accessor = self.accessor(
                json!({ "bufferView": indices, "byteOffset": submesh.first_index * 4,
                "componentType": UNSIGNED_INT, "type": "SCALAR", "count": submesh.index_count }),
            );
            json!({ "attributes": attributes, "indices": accessor, "material": submesh.material })
        });
        let primitives: Vec<Value> = primitives.collect();
        json!({ "name": mesh.name, "primitives": primitives })
    }

    /// Adds a node below `parent`, or to the scene.
    pub fn below(&mut self, parent: Option<usize>, node: Value) -> usize {
        let number = self.nodes.len();
        self.nodes.push(node);
        match parent.and_then(|p| self.nodes.get_mut(p)) {
            None => self.roots.push(number),
            Some(parent) => match parent.get_mut("children").and_then(Value::as_array_mut) {
                Some(children) => children.push(json!(number)),
                None => parent["children"] = json!([number]),
            },
        }
        number
    }

    /// Writes `min` and `max` of an accessor.
    pub fn limits(&mut self, accessor: usize, low: f32, high: f32) {
        self.accessors[accessor]["min"] = json!([low]);
        self.accessors[accessor]["max"] = json!([high]);
    }

    pub fn floats(&mut self, values: &[u8], kind: &str, count: usize) -> usize {
        let view = self.view(values, json!({}));
        self.accessor(
            json!({ "bufferView": view, "componentType": FLOAT, "type": kind, "count": count }),
        )
    }
}
