//! glTF files at the edges of the format: what it leaves to defaults is read, what it forbids is told.
//!
//! CONELAB_GLTF_FILES names a folder of other people's files, for example that of the Khronos validator's own tests:
//! those beside a report without errors should open, and none may take the program down.

use conelab::scene::{Scene, SceneError};
use serde_json::{Value, json};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

fn open(path: &Path) -> Result<Scene, SceneError> {
    let begun = Instant::now();
    let opened = Scene::open(&path.to_string_lossy(), &|_, _| ControlFlow::Continue(()));
    assert!(
        begun.elapsed() < Duration::from_secs(30),
        "{} took {:?}",
        path.display(),
        begun.elapsed()
    );
    opened
}

/// Positions of a triangle, three indices, and a place and a position that differs.
fn bytes() -> Vec<u8> {
    let floats = [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let mut bytes: Vec<u8> = floats.iter().flat_map(|f| f.to_le_bytes()).collect();
    bytes.extend([0, 0, 1, 0, 2, 0, 2, 0].map(|b: u8| b));
    bytes.extend([0.0f32, 4.0, 0.0].iter().flat_map(|f| f.to_le_bytes()));
    bytes
}

/// A file with one triangle.
fn triangle() -> Value {
    json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1, "material": 0 }] }],
        "materials": [{}],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3, "min": [0, 0, 0], "max": [1, 1, 0] },
            { "bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": 3 },
        ],
        "bufferViews": [
            { "buffer": 0, "byteLength": 36 },
            { "buffer": 0, "byteOffset": 36, "byteLength": 6 },
            { "buffer": 0, "byteOffset": 40, "byteLength": 2 },
            { "buffer": 0, "byteOffset": 44, "byteLength": 12 },
        ],
        "buffers": [{ "uri": "a.bin", "byteLength": 56 }],
    })
}

/// Adds to a list of the file.
fn push(file: &mut Value, list: &str, value: Value) {
    file.pointer_mut(list)
        .unwrap()
        .as_array_mut()
        .unwrap()
        .push(value);
}

/// The file after a change, opened.
fn changed(change: impl Fn(&mut Value)) -> Result<Scene, String> {
    let folder = tempfile::tempdir().unwrap();
    let mut file = triangle();
    change(&mut file);
    std::fs::write(folder.path().join("a.bin"), bytes()).unwrap();
    let path = folder.path().join("a.gltf");
    std::fs::write(&path, file.to_string()).unwrap();
    open(&path).map_err(|e| e.to_string())
}

#[track_caller]
fn opens(change: impl Fn(&mut Value)) -> Scene {
    changed(change).unwrap()
}

#[track_caller]
fn refused(piece: &str, change: impl Fn(&mut Value)) {
    let told = changed(change)
        .err()
        .unwrap_or_else(|| panic!("it opened; expected '{piece}'"));
    assert!(
        told.contains(piece) && told.contains("a.gltf"),
        "no '{piece}' in: {told}"
    );
}

#[test]
fn what_the_format_leaves_to_defaults_is_read() {
    assert_eq!(opens(|_| {}).triangle_count(), 1);
    // Zeros, of which sparse values make a triangle.
    let scene = opens(|f| {
        f["accessors"][0] = json!({ "componentType": 5126, "type": "VEC3", "count": 3, "min": [0, 0, 0], "max": [0, 0, 0] });
        f["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(0);
    });
    assert_eq!(scene.triangle_count(), 0, "all of it is in one place");
    let scene = opens(|f| {
        f["accessors"][0]["sparse"] = json!({ "count": 1, "indices": { "bufferView": 2, "componentType": 5123 },
            "values": { "bufferView": 3 } });
    });
    assert_eq!(scene.bounds().1.y, 4.0);
    // Whole numbers with a point.
    let scene = opens(|f| {
        f["accessors"][0]["count"] = json!(3.0);
        f["nodes"][0]["mesh"] = json!(0.0);
        f["scene"] = json!(0.0);
    });
    assert_eq!(scene.triangle_count(), 1);
    // What extensions would say.
    let scene = opens(|f| {
        f["textures"] = json!([{}]);
        f["materials"][0] =
            json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } });
        f["animations"] = json!([{ "samplers": [{ "input": 1, "output": 0 }],
            "channels": [{ "sampler": 0, "target": { "path": "translation" } },
                { "sampler": 0, "target": { "path": "pointer" } }] }]);
        push(f, "/buffers", json!({ "byteLength": 8 }));
        push(
            f,
            "/accessors",
            json!({ "componentType": 5126, "type": "VEC17", "count": 1 }),
        );
        push(f, "/meshes/0/primitives", json!({ "attributes": {} }));
    });
    let warnings = scene.warnings.join("\n");
    for piece in [
        "checkerboard",
        "channels of animations that move no node",
        "without positions",
    ] {
        assert!(warnings.contains(piece), "no '{piece}' in: {warnings}");
    }
    assert_eq!(
        opens(|f| drop(f["scenes"][0].as_object_mut().unwrap().remove("nodes"))).triangle_count(),
        0
    );
}

#[test]
fn quantized_meshes_are_read() {
    let quantized = |normalized: bool| {
        opens(|f| {
            f["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
            f["extensionsUsed"] = json!(["KHR_mesh_quantization"]);
            // Three corners of 16-bit whole numbers, four apart.
            let corners: Vec<u8> = [0i16, 0, 0, 0, 127, 0, 0, 0, 0, 127, 0, 0]
                .iter()
                .flat_map(|v| v.to_le_bytes())
                .collect();
            let text: String = corners.iter().map(|b| format!("%{b:02x}")).collect();
            let uri = format!("data:application/octet-stream,{text}");
            push(f, "/buffers", json!({ "byteLength": 24, "uri": uri }));
            f["bufferViews"][0] = json!({ "buffer": 1, "byteLength": 24, "byteStride": 8 });
            f["accessors"][0] = json!({ "bufferView": 0, "componentType": 5122, "type": "VEC3", "count": 3,
                "normalized": normalized, "min": [0, 0, 0], "max": [127, 127, 0] });
            f["nodes"][0]["scale"] = json!([2, 2, 2]);
        })
    };
    assert_eq!(quantized(false).bounds().1.x, 254.0);
    assert!((quantized(true).bounds().1.x - 254.0 / 32767.0).abs() < 1e-6);
}

#[test]
fn mistakes_name_the_file_and_the_part() {
    refused("accessor 9", |f| {
        f["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(9)
    });
    refused("accessor 9", |f| {
        f["meshes"][0]["primitives"][0]["indices"] = json!(9)
    });
    refused("2.1", |f| f["asset"]["minVersion"] = json!("2.1"));
    refused("1.0", |f| f["asset"]["version"] = json!("1.0"));
    refused("asset", |f| {
        drop(f.as_object_mut().unwrap().remove("asset"))
    });
    refused("neither a uri", |f| {
        drop(f["buffers"][0].as_object_mut().unwrap().remove("uri"))
    });
    refused("past the end", |f| {
        f["accessors"][0]["count"] = json!(4_000_000_000u32)
    });
    refused("a type that glTF does not have", |f| {
        f["accessors"][0]["type"] = json!("VEC17")
    });
    refused("many more vertices", |f| {
        let zeros = json!({ "componentType": 5126, "type": "VEC3", "count": 4_000_000, "min": [0, 0, 0], "max": [0, 0, 0] });
        push(f, "/accessors", zeros);
        let primitive = json!({ "attributes": { "POSITION": 2 }, "material": 0 });
        f["meshes"][0]["primitives"] = json!(vec![primitive; 30]);
    });
}

#[test]
fn compressed_views_keep_their_word() {
    let compressed = |count: u64, more: Value| {
        move |f: &mut Value| {
            let mut layout = json!({ "buffer": 0, "byteOffset": 0, "byteLength": 56, "byteStride": 12, "count": count,
                "mode": "ATTRIBUTES" });
            layout
                .as_object_mut()
                .unwrap()
                .extend(more.as_object().unwrap().clone());
            f["bufferViews"][0]["extensions"] = json!({ "EXT_meshopt_compression": layout });
        }
    };
    refused(
        "buffer view 0: its compressed data has the unknown header 0x0",
        compressed(3, json!({})),
    );
    refused(
        "many more bytes than the file holds",
        compressed(1 << 40, json!({})),
    );
    refused(
        "many more bytes than the file holds",
        compressed(u64::MAX, json!({})),
    );
    refused(
        "past the end of its buffer",
        compressed(3, json!({ "byteOffset": 8 })),
    );
    refused(
        "buffer view 0: its compression mode x is not known",
        compressed(3, json!({ "mode": "x" })),
    );
    refused("no valid `count`", compressed(3, json!({ "count": -1 })));
    refused(
        "do not fit Attributes",
        compressed(3, json!({ "byteStride": 6 })),
    );
    refused("only stands for compressed views", |f| {
        f["buffers"][0]["extensions"] = json!({ "EXT_meshopt_compression": { "fallback": true } });
    });
    // Nothing uses the view.
    let damaged = opens(|f| {
        compressed(3, json!({}))(f);
        push(f, "/bufferViews", json!({ "buffer": 0, "byteLength": 36 }));
        f["accessors"][0]["bufferView"] = json!(4);
    });
    assert_eq!(damaged.triangle_count(), 1);
    // The header byte of attributes, and no stream behind it: it decodes to as much as is asked for, or to nothing.
    refused("decodes to 0 bytes of 36", |f| {
        f["buffers"][0] =
            json!({ "byteLength": 56, "uri": format!("data:,%a0{}", "0".repeat(55)) });
        compressed(0, json!({ "byteLength": 33 }))(f);
    });
}

/// A container of chunks, with a length that may be wrong.
fn container(chunks: &[(&[u8; 4], &[u8])], extra: i32) -> Vec<u8> {
    let mut out = Vec::new();
    for (kind, content) in chunks {
        out.extend((content.len() as u32).to_le_bytes());
        out.extend(*kind);
        out.extend(*content);
    }
    let length = (out.len() as i32 + 12 + extra) as u32;
    [
        b"glTF".as_slice(),
        &2u32.to_le_bytes(),
        &length.to_le_bytes(),
        &out,
    ]
    .concat()
}

#[test]
fn containers_are_whole_or_told() {
    let mut file = triangle();
    file["buffers"][0].as_object_mut().unwrap().remove("uri");
    let (text, blob) = (file.to_string().into_bytes(), bytes());
    let folder = tempfile::tempdir().unwrap();
    let opened = |bytes: Vec<u8>| {
        let path = folder.path().join("a.glb");
        std::fs::write(&path, bytes).unwrap();
        open(&path)
            .map(|s| s.triangle_count())
            .map_err(|e| e.to_string())
    };
    let chunks: [(&[u8; 4], &[u8]); 2] = [(b"JSON", &text), (b"BIN\0", &blob)];
    assert_eq!(opened(container(&chunks, 0)), Ok(1));
    assert_eq!(
        opened([container(&chunks, 0), b"trailing".to_vec()].concat()),
        Ok(1)
    );
    assert_eq!(
        opened(container(
            &[(b"JSON", &text), (b"XYZW", b"1234"), (b"BIN\0", &blob)],
            0
        )),
        Ok(1)
    );
    let whole = container(&chunks, 0);
    for cut in [4, 11, 12, 19, 25, whole.len() - 1] {
        let told = opened(whole[..cut].to_vec()).unwrap_err();
        assert!(told.contains("cut short"), "{cut}: {told}");
    }
    assert!(
        opened(container(&chunks, -3))
            .unwrap_err()
            .contains("past its end")
    );
    assert!(
        opened(container(&chunks[1..], 0))
            .unwrap_err()
            .contains("no JSON chunk")
    );
}

#[test]
fn other_peoples_files() {
    let Some(folder) = std::env::var_os("CONELAB_GLTF_FILES") else {
        eprintln!("skipped: CONELAB_GLTF_FILES names no folder of glTF files");
        return;
    };
    let mut files = Vec::new();
    let mut folders = vec![PathBuf::from(folder)];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap().flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "gltf" || e == "glb") {
                files.push(path);
            }
        }
    }
    files.sort();
    assert!(!files.is_empty(), "no glTF files");
    let (mut valid, mut opened, mut refused) = (0, 0, Vec::new());
    for path in &files {
        let result = open(path);
        let report = std::fs::read(path.with_added_extension("report.json"));
        let report: Option<Value> = report
            .ok()
            .and_then(|text| serde_json::from_slice(&text).ok());
        if report.is_some_and(|r| r["issues"]["numErrors"] == 0) {
            valid += 1;
            match result {
                Ok(_) => opened += 1,
                Err(e) => refused.push(e.to_string()),
            }
        }
    }
    eprintln!(
        "{} files, {valid} valid, {opened} of them open:\n{}",
        files.len(),
        refused.join("\n")
    );
    // Files may need data or a version that is not there.
    assert!(
        refused.iter().all(|e| e.contains("requires")
            || e.contains("version")
            || e.contains("neither a uri"))
    );
}
