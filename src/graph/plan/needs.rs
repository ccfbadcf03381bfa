//! Features that passes need and devices may lack, reported with alternatives.

use super::data::Plan;
use crate::diagnostics::Diagnostic;
use crate::graph::evaluated::Evaluated;
use crate::graph::file::PassDecl;
use crate::graph::link::{Bound, Linked};
use crate::graph::param::{Params, Value};
use crate::shader::Resource;
use crate::vulkan::{DeviceInfo, Stage};

const CLIP_DISTANCE: u32 = 32;
const FLOAT64: u32 = 10;
const INT64: u32 = 11;
const INT64_ATOMICS: u32 = 12;

/// One error for each feature that a pass of the plan needs and the device lacks.
pub(super) fn check(
    set: &Evaluated<'_>,
    linked: &[Linked],
    plan: &Plan,
    device: &DeviceInfo,
) -> Vec<Diagnostic> {
    let mut errors = Vec::new();
    for number in plan.passes() {
        let pass = &set.graph.passes[number].value;
        let link = &linked[number];
        for (needed, available, what) in needs(pass, link, device) {
            if needed && !available {
                let (name, device) = (&pass.name, &device.name);
                let choices = choices(pass, set);
                let because = because(&choices);
                let message = format!(
                    "pass '{}' needs {what}, which {device} does not have{because}",
                    name.value
                );
                let error = set.graph.sources.error(name.at, message);
                errors.push(error.help(instead(&choices)));
            }
        }
    }
    errors
}

/// Features: whether the pass needs it, whether the device has it, and its name.
fn needs(pass: &PassDecl, link: &Linked, device: &DeviceInfo) -> [(bool, bool, &'static str); 10] {
    let have = &device.features;
    let has = |stage: Stage| link.stages.iter().any(|s| s.stage == stage);
    let stores = |fragment: bool| {
        link.bound.iter().any(|b| {
            b.stage != Stage::Compute
                && (b.stage == Stage::Fragment) == fragment
                && matches!(
                    b.resource,
                    Resource::Buffer { write: true, .. } | Resource::Storage { write: true, .. }
                )
        })
    };
    let is_unformatted = |b: &Bound| matches!(b.resource, Resource::Storage { format: None, .. });
    let unformatted = link.bound.iter().any(is_unformatted);
    let uses = |capability: u32| {
        let mut stages = link.stages.iter();
        stages.any(|s| s.interface.capabilities.contains(&capability))
    };
    [
        (
            pass.raster.conservative.is_some(),
            have.conservative_rasterization,
            "conservative rasterisation (VK_EXT_conservative_rasterization)",
        ),
        (has(Stage::Geometry), have.geometry, "geometry shaders"),
        (has(Stage::TessControl), have.tessellation, "tessellation"),
        (
            stores(true),
            have.fragment_stores,
            "stores from fragment shaders",
        ),
        (
            stores(false),
            have.vertex_stores,
            "stores from vertex, tessellation or geometry shaders",
        ),
        (pass.raster.depth_clamp, have.depth_clamp, "depth clamping"),
        (
            unformatted,
            have.write_without_format,
            "writing images without a format",
        ),
        (uses(CLIP_DISTANCE), have.clip_distance, "gl_ClipDistance"),
        (
            uses(INT64) || uses(INT64_ATOMICS),
            have.int64_atomics,
            "64-bit atomics in buffers",
        ),
        // Not asked of any device: portable shaders do without.
        (uses(FLOAT64), false, "64-bit floating point in shaders"),
    ]
}

/// Choices without which a pass would not run: name, value, and the options that leave it out.
fn choices<'p>(pass: &PassDecl, set: &Evaluated<'p>) -> Vec<(&'p str, &'p Value, Vec<&'p str>)> {
    let params: &'p Params = set.params;
    let leaves_out = |i: usize, option: &String| {
        let mut changed = params.clone();
        changed.values[i] = Value::Choice(option.clone());
        let changed = Evaluated::new(set.graph, &changed, set.env.clone());
        pass.conditions()
            .any(|ex| ex.value.eval(&changed.env) == Ok(0.0))
    };
    let choices = params.list.iter().zip(&params.values).enumerate();
    choices
        .map(|(i, (param, value))| {
            let options = param.kind.options().iter();
            let options = options.filter(|o| Value::Choice((*o).clone()) != *value);
            let options = options.filter(|o| leaves_out(i, o)).map(String::as_str);
            (param.name.as_str(), value, options.collect::<Vec<_>>())
        })
        .filter(|(_, _, options)| !options.is_empty())
        .collect()
}

fn because(choices: &[(&str, &Value, Vec<&str>)]) -> String {
    let list: Vec<String> = choices
        .iter()
        .map(|(name, value, _)| format!("{name} is {value}"))
        .collect();
    if list.is_empty() {
        String::new()
    } else {
        format!(" (it runs because {})", list.join(" and "))
    }
}

fn instead(choices: &[(&str, &Value, Vec<&str>)]) -> Option<String> {
    let list: Vec<String> = choices
        .iter()
        .map(|(name, _, options)| format!("--set {name}={}", options.join("|")))
        .collect();
    (!list.is_empty()).then(|| format!("use {}", list.join(" or ")))
}
