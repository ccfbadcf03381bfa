//! EXT_mesh_gpu_instancing: many transforms for one node's mesh.

use ::gltf::{Accessor, Document, Node};
use glam::{Mat4, Quat, Vec3, Vec4};
use serde_json::Value;

use super::accessors;
use super::buffers::Buffers;

/// Total instances of all nodes.
pub(super) const MAX_INSTANCES: usize = 1 << 20;

/// An attribute of instances, if there is one.
fn accessor<'a>(
    document: &'a Document,
    attributes: Option<&Value>,
    name: &str,
) -> Result<Option<Accessor<'a>>, String> {
    let Some(index) = attributes.and_then(|a| a.get(name)) else {
        return Ok(None);
    };
    let index = index.as_u64().and_then(|i| usize::try_from(i).ok());
    match index.and_then(|i| document.accessors().nth(i)) {
        Some(accessor) if accessor.count() <= MAX_INSTANCES => Ok(Some(accessor)),
        Some(accessor) => {
            let count = accessor.count();
            Err(format!("{count} instances are more than {MAX_INSTANCES}"))
        }
        None => Err(format!(
            "its {name} of EXT_mesh_gpu_instancing has no accessor"
        )),
    }
}

/// Instance transforms in the space of the node; `None` without the extension.
pub(super) fn places(
    node: &Node,
    document: &Document,
    buffers: &Buffers,
) -> Result<Option<Vec<Mat4>>, String> {
    let Some(extension) = node.extension_value("EXT_mesh_gpu_instancing") else {
        return Ok(None);
    };
    let attributes = extension.get("attributes");
    let accessor = |name: &str| accessor(document, attributes, name);
    let vectors = |name: &str| {
        accessor(name)?
            .map(|a| accessors::floats::<3>(&a, buffers))
            .transpose()
    };
    let (translations, scales) = (vectors("TRANSLATION")?, vectors("SCALE")?);
    let rotations = accessor("ROTATION")?
        .map(|a| accessors::floats::<4>(&a, buffers))
        .transpose()?;
    let counts = [
        translations.as_ref().map(Vec::len),
        rotations.as_ref().map(Vec::len),
        scales.as_ref().map(Vec::len),
    ];
    let mut counts = counts.into_iter().flatten();
    let Some(count) = counts.next() else {
        return Ok(Some(Vec::new()));
    };
    if counts.any(|other| other != count) {
        return Err("its attributes of EXT_mesh_gpu_instancing have different counts".into());
    }
    let place = |i: usize| {
        let vector = |list: &Option<Vec<[f32; 3]>>, default: Vec3| {
            list.as_ref()
                .map_or(default, |list| Vec3::from_array(list[i]))
        };
        let (translation, scale) = (
            vector(&translations, Vec3::ZERO),
            vector(&scales, Vec3::ONE),
        );
        let rotation = rotations.as_ref().map(|r| Vec4::from_array(r[i]));
        let rotation = rotation.and_then(Vec4::try_normalize);
        let rotation = rotation.map_or(Quat::IDENTITY, Quat::from_vec4);
        Mat4::from_scale_rotation_translation(scale, rotation, translation)
    };
    let places: Vec<Mat4> = (0..count).map(place).collect();
    match places.iter().all(Mat4::is_finite) {
        true => Ok(Some(places)),
        false => {
            Err("an instance of EXT_mesh_gpu_instancing has a place that is not finite".into())
        }
    }
}
