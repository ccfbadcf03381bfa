//! Warnings about content that is dropped.

use ufbx::{ElementType, Material, MaterialMap, ShaderType};

use crate::scene::obj::shown;
use crate::scene::warnings::Warnings;

/// Warns about each kind of dropped element, with names.
pub(super) fn warn(file: &ufbx::Scene, warnings: &mut Warnings) {
    for element in &file.elements {
        let what = match element.type_ {
            ElementType::NurbsCurve | ElementType::LineCurve => "curves are left out",
            ElementType::NurbsSurface | ElementType::NurbsTrimSurface => {
                "NURBS surfaces are left out. Convert them to polygons"
            }
            ElementType::ProceduralGeometry => {
                "procedural geometry is left out. Convert it to polygons"
            }
            ElementType::CacheDeformer => "geometry caches are left out: their meshes stay at rest",
            ElementType::BlendChannel if has_steps(element) => {
                "blend shapes with shapes in between stay at the weights of the file"
            }
            ElementType::StereoCamera | ElementType::CameraSwitcher => {
                "stereo cameras and camera switchers are left out"
            }
            ElementType::Constraint => {
                "constraints are left out: nodes stay where the file has them"
            }
            _ => continue,
        };
        warnings.add(what, shown(&element.name));
    }
    for warning in &file.metadata.warnings {
        warnings.add(
            format!(
                "the file has mistakes that were corrected ({})",
                warning.description.to_lowercase()
            ),
            "",
        );
    }
}

/// Whether a channel blends several shapes by its weight.
fn has_steps(element: &ufbx::Element) -> bool {
    ufbx::as_blend_channel(element).is_some_and(|channel| channel.keyframes.len() > 1)
}

/// Warns about an unknown material model and dropped maps or layers.
pub(super) fn warn_of_material(from: &Material, is_phong: bool, warnings: &mut Warnings) {
    let name = shown(&from.element.name);
    if matches!(
        from.shader_type,
        ShaderType::Unknown | ShaderType::ShaderfxGraph
    ) {
        let kind = shown(&from.shading_model_name);
        let kind = if kind.is_empty() {
            "no name".into()
        } else {
            format!("'{kind}'")
        };
        let what = format!(
            "materials of a kind that is not known ({kind}) have only their common colours and maps"
        );
        warnings.add(what, &name);
    }
    let (pbr, fbx) = (&from.pbr, &from.fbx);
    let has_map = |map: &MaterialMap| map.texture_enabled && map.texture.is_some();
    let is_on = |map: &MaterialMap| !is_phong && map.has_value && map.value_vec4.x > 0.0;
    let exponent = is_phong && has_map(&fbx.specular_exponent);
    let left_out = [
        (
            has_map(&pbr.specular_color) || has_map(&pbr.specular_factor),
            "maps of the specular colour are",
        ),
        (exponent, "maps of the specular exponent are"),
        (has_map(&pbr.glossiness), "maps of the glossiness are"),
        (
            has_map(&pbr.ambient_occlusion),
            "maps of ambient occlusion are",
        ),
        (has_map(&fbx.reflection_color), "maps of reflections are"),
        (
            has_map(&fbx.displacement) || has_map(&pbr.displacement_map),
            "displacement maps are",
        ),
        (is_on(&pbr.coat_factor), "coats are"),
        (is_on(&pbr.sheen_factor), "sheen is"),
        (is_on(&pbr.transmission_factor), "transmission is"),
        (is_on(&pbr.subsurface_factor), "subsurface scattering is"),
        (is_on(&pbr.thin_film_factor), "thin film is"),
    ];
    for (_, what) in left_out.iter().filter(|(there, _)| *there) {
        warnings.add(format!("{what} left out"), &name);
    }
}
