//! From a file's bytes to a document that the gltf crate can traverse without panics.
//!
//! The crate is stricter than the specification, so defaults of the format are written out first.

use std::collections::HashSet;

use ::gltf::Document;
use ::gltf::json::validation::{Checked, Error, Validate};
use ::gltf::json::{Path, Root};
use serde_json::{Map, Value, json};

use super::container::split;
use super::supported;
use crate::scene::warnings::Warnings;

/// A checked document.
pub(super) struct Checks {
    pub document: Document,
    pub blob: Option<Vec<u8>>,
    /// Accessors of a type that the format does not define; using one is an error.
    pub unreadable: HashSet<usize>,
    pub warnings: Warnings,
}

/// Parses a file, text or binary.
pub(super) fn read(bytes: &[u8]) -> Result<Checks, String> {
    let again = |problem: String| format!("{problem}. Export it again as glTF 2.0");
    let (value, blob) = parse(bytes).map_err(again)?;
    supported::check_required(&value)?;
    checked(value, blob).map_err(again)
}

fn parse(bytes: &[u8]) -> Result<(Value, Option<Vec<u8>>), String> {
    let (text, blob) = split(bytes)?;
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
    let value: Value = serde_json::from_slice(text).map_err(|e| format!("it is no JSON: {e}"))?;
    check_version(&value)?;
    Ok((value, blob))
}

fn checked(mut value: Value, blob: Option<Vec<u8>>) -> Result<Checks, String> {
    let mut warnings = Warnings::default();
    supported::warn_of_used(&value, &mut warnings);
    write_out(&mut value, &mut warnings);
    let root: Root = serde_json::from_value(value).map_err(|e| e.to_string())?;
    check(&root)?;
    let unreadable = validate(&root)?;
    Ok(Checks {
        document: Document::from_json_without_validation(root),
        blob,
        unreadable,
        warnings,
    })
}

fn check_version(value: &Value) -> Result<(), String> {
    let asset = value
        .get("asset")
        .ok_or("it has no `asset`, which every glTF file has")?;
    let version = |key: &str| asset.get(key).and_then(Value::as_str);
    let needed = version("minVersion")
        .or(version("version"))
        .unwrap_or_default();
    match needed.split_once('.').map_or(needed, |v| v.0) {
        "2" if version("minVersion").is_none_or(|v| v == "2.0") => Ok(()),
        _ => Err(format!("it is of version '{needed}', and 2.0 is read")),
    }
}

/// The items of a list in a document; none if it has no such list.
fn items<'a>(root: &'a mut Map<String, Value>, list: &str) -> impl Iterator<Item = &'a mut Value> {
    let list = root.get_mut(list).and_then(Value::as_array_mut);
    list.into_iter().flatten()
}

/// Writes out defaults of the format that the crate requires.
fn write_out(value: &mut Value, warnings: &mut Warnings) {
    whole_numbers(value);
    let Some(root) = value.as_object_mut() else {
        return;
    };
    root.remove("extensionsRequired");
    let scenes = items(root, "scenes").filter_map(Value::as_object_mut);
    for scene in scenes {
        scene.entry("nodes").or_insert(json!([]));
    }
    for (i, animation) in items(root, "animations").enumerate() {
        let Some(channels) = animation.get_mut("channels").and_then(Value::as_array_mut) else {
            continue;
        };
        let before = channels.len();
        channels.retain(|channel| channel.get("target").is_none_or(moves_a_node));
        for _ in channels.len()..before {
            let what = "channels of animations that move no node are left out";
            warnings.add(what, format!("animation {i}"));
        }
    }
    let mut images = items(root, "images").count();
    let known = images as u64;
    let mut absent = Vec::new();
    for (i, texture) in items(root, "textures").enumerate() {
        let exists = |source: &Value| source.as_u64().is_some_and(|source| source < known);
        let Some(texture) = texture.as_object_mut() else {
            continue;
        };
        let extensions = texture.get("extensions");
        let other = |name: &str| {
            extensions
                .and_then(|e| e.get(name)?.get("source"))
                .filter(|s| exists(s))
                .cloned()
        };
        let own = || texture.get("source").filter(|s| exists(s)).cloned();
        let others = || other("MSFT_texture_dds").or_else(|| other("EXT_texture_webp"));
        let source = other("KHR_texture_basisu").or_else(own).or_else(others).unwrap_or_else(|| {
            absent.push(json!({ "name": format!("of texture {i}, which names none that can be read,") }));
            images += 1;
            json!(images - 1)
        });
        texture.insert("source".into(), source);
    }
    if !absent.is_empty()
        && let Some(list) = root.entry("images").or_insert(json!([])).as_array_mut()
    {
        list.append(&mut absent);
    }
}

/// Whether a channel targets a node; without one, an extension names the target.
fn moves_a_node(target: &Value) -> bool {
    let path = target
        .get("path")
        .and_then(Value::as_str)
        .unwrap_or_default();
    target.get("node").is_some() && ["translation", "rotation", "scale", "weights"].contains(&path)
}

/// JSON does not distinguish 1.0 from 1; converts whole floats to integers.
fn whole_numbers(value: &mut Value) {
    match value {
        Value::Array(list) => list.iter_mut().for_each(whole_numbers),
        Value::Object(fields) => fields
            .iter_mut()
            .filter(|(key, _)| *key != "extras")
            .for_each(|(_, v)| whole_numbers(v)),
        Value::Number(number) if number.is_f64() => {
            let float = number.as_f64().unwrap_or(0.5);
            let whole = float.fract() == 0.0
                && float.abs() < 1e15
                && !(float == 0.0 && float.is_sign_negative());
            if whole {
                *value = json!(float as i64);
            }
        }
        _ => {}
    }
}

/// The crate's validation, minus the cases that the format allows; returns accessors of unknown
/// type.
fn validate(root: &Root) -> Result<HashSet<usize>, String> {
    let mut unreadable = HashSet::new();
    let mut wrong = Vec::new();
    root.validate(root, Path::new, &mut |path, error| {
        let path = path();
        let path = path.as_str();
        let accessor = path
            .strip_prefix("accessors[")
            .and_then(|rest| rest.split_once("]."));
        match (error, accessor) {
            (Error::Missing, Some((_, "bufferView"))) => {}
            (Error::Missing, _) if path.ends_with("attributes[\"POSITION\"]") => {}
            // Missing bounds are computed.
            _ if [".min", ".max"].iter().any(|end| path.ends_with(end)) => {}
            (Error::Invalid, Some((number, "type" | "componentType"))) => {
                unreadable.extend(number.parse::<usize>());
            }
            _ => wrong.push(format!("{path}: {}", error.to_string().to_lowercase())),
        }
    });
    match wrong.len() {
        0 => Ok(unreadable),
        n => {
            wrong.truncate(4);
            let more = if n > 4 {
                format!(" and {} more mistakes", n - 4)
            } else {
                String::new()
            };
            Err(format!("{}{more}", wrong.join(", ")))
        }
    }
}

/// Additional checks where the crate's validation is incomplete or panics.
fn check(root: &Root) -> Result<(), String> {
    for (i, mesh) in root.meshes.iter().enumerate() {
        for primitive in &mesh.primitives {
            let targets = primitive.targets.iter().flatten();
            let moved =
                targets.flat_map(|t| [t.positions, t.normals, t.tangents].into_iter().flatten());
            let used = primitive.attributes.values().copied();
            let mut used = used.chain(primitive.indices).chain(moved);
            if let Some(index) = used.find(|index| index.value() >= root.accessors.len()) {
                return Err(format!(
                    "mesh {i} uses accessor {}, which does not exist",
                    index.value()
                ));
            }
        }
    }
    let lights = root
        .extensions
        .as_ref()
        .and_then(|e| e.khr_lights_punctual.as_ref())
        .map_or(&[][..], |l| &l.lights);
    for (i, light) in lights.iter().enumerate() {
        use ::gltf::json::extensions::scene::khr_lights_punctual::Type;
        if matches!(light.type_, Checked::Valid(Type::Spot)) && light.spot.is_none() {
            return Err(format!("light {i} is a spot without cone angles"));
        }
    }
    for (i, node) in root.nodes.iter().enumerate() {
        let light = node
            .extensions
            .as_ref()
            .and_then(|e| e.khr_lights_punctual.as_ref());
        if light.is_some_and(|light| light.light.value() >= lights.len()) {
            return Err(format!("node {i} has a light that does not exist"));
        }
    }
    for (i, camera) in root.cameras.iter().enumerate() {
        use ::gltf::json::camera::Type;
        let complete = match camera.type_ {
            Checked::Valid(Type::Perspective) => camera.perspective.is_some(),
            Checked::Valid(Type::Orthographic) => camera.orthographic.is_some(),
            Checked::Invalid => false,
        };
        if !complete {
            return Err(format!("camera {i} lacks the numbers of its type"));
        }
    }
    for (i, animation) in root.animations.iter().enumerate() {
        let count = animation.samplers.len();
        let mut channels = animation.channels.iter();
        if channels.any(|channel| channel.sampler.value() >= count) {
            return Err(format!(
                "animation {i} has a channel whose sampler does not exist"
            ));
        }
    }
    Ok(())
}
