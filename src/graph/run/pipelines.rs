//! Vulkan state from a graph's declarations: pipelines with their fixed state, descriptors,
//! samplers, clear values.

use crate::graph::definition::Graph;
use crate::graph::file::{AddressMode, Compare, Cull, FilterMode, PassDecl, SamplerDecl, Topology};
use crate::graph::link::{Linked, Target};
use crate::graph::plan::{Plan, Step};
use crate::shader::{MAX_VARIABLE_BYTES, Resource, check_sizes, strip_images, strip_outputs};
use crate::vulkan::{
    Attachments, BindingDesc, DrawState, Gpu, Pipeline, PipelineDesc, Result, SamplerDesc, Stage,
    StageDesc, VulkanError, format::Channels, vk,
};
use rayon::prelude::*;
use std::sync::Arc;

pub(super) fn descriptor_type(resource: &Resource) -> vk::DescriptorType {
    match resource {
        Resource::Uniform => vk::DescriptorType::UNIFORM_BUFFER,
        Resource::Buffer { .. } => vk::DescriptorType::STORAGE_BUFFER,
        Resource::Sampled { .. } => vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
        Resource::Storage { .. } => vk::DescriptorType::STORAGE_IMAGE,
    }
}

/// Pipelines by their descriptions.
pub(super) type Pipelines = Vec<(PipelineDesc, Arc<Pipeline>)>;

/// The pipelines of a plan, and which of them each step uses.
pub(super) struct Made {
    pub pipelines: Pipelines,
    pub keys: Vec<Option<usize>>,
    /// Number of new pipelines.
    pub built: usize,
}

/// Makes pipelines in parallel, and reuses those with a description in `kept`.
pub(super) fn make_pipelines(
    gpu: &Arc<Gpu>,
    graph: &Graph,
    linked: &[Linked],
    plan: &Plan,
    constants: &[(u32, u32)],
    kept: &[(PipelineDesc, Arc<Pipeline>)],
) -> Result<Made> {
    let mut descs: Vec<(&Step, PipelineDesc)> = Vec::new();
    let mut keys = Vec::new();
    for step in &plan.steps {
        let link = &linked[step.pass];
        if link.stages.is_empty() {
            keys.push(None);
            continue;
        }
        let pass = &graph.passes[step.pass].value;
        let draw = pass.draw.is_some().then(|| draw_state(pass, step, plan));
        let same = |s: &Step| s.pass == step.pass && s.stripped == step.stripped;
        let known = descs.iter().position(|(s, d)| same(s) && d.draw == draw);
        keys.push(Some(known.unwrap_or_else(|| {
            descs.push((step, pipeline_desc(pass, link, step, constants, draw)));
            descs.len() - 1
        })));
    }
    descs
        .iter()
        .try_for_each(|(_, desc)| check_variables(desc))?;
    let pipelines: Vec<(bool, (PipelineDesc, Arc<Pipeline>))> = descs
        .into_par_iter()
        .map(|(_, desc)| match kept.iter().find(|(d, _)| *d == desc) {
            Some((_, pipeline)) => Ok((false, (desc, pipeline.clone()))),
            None => Pipeline::new(gpu, &desc).map(|made| (true, (desc, Arc::new(made)))),
        })
        .collect::<Result<_>>()?;
    let built = pipelines.iter().filter(|p| p.0).count();
    Ok(Made {
        pipelines: pipelines.into_iter().map(|p| p.1).collect(),
        keys,
        built,
    })
}

/// Checks the variables of a pipeline's shaders with the values of constants, on which lengths of
/// arrays may depend.
fn check_variables(desc: &PipelineDesc) -> Result<()> {
    let checked = desc
        .stages
        .iter()
        .try_for_each(|stage| check_sizes(&stage.spirv, &stage.constants));
    checked.map_err(|large| VulkanError::Limit {
        what: format!("the size of the shader variables of pass '{}'", desc.name),
        asked: format!("{} bytes", large.bytes),
        limit: format!("{MAX_VARIABLE_BYTES} bytes"),
        device: "conelab".into(),
    })
}

fn pipeline_desc(
    pass: &PassDecl,
    link: &Linked,
    step: &Step,
    constants: &[(u32, u32)],
    draw: Option<(DrawState, Attachments)>,
) -> PipelineDesc {
    let stripped: Vec<u32> = step
        .stripped
        .iter()
        .map(|i| link.bound[*i].binding)
        .collect();
    // A texture without a binding in the step is one that the stripped shader does not know.
    let bound = link.bound.iter().enumerate().filter(|(i, b)| {
        let texture = matches!(b.cases[step.cases[*i]].target, Target::Texture(_));
        !texture || step.bindings.iter().any(|plan| plan.bound == *i)
    });
    let stages: Vec<StageDesc> = link
        .stages
        .iter()
        .map(|s| StageDesc {
            stage: s.stage,
            spirv: match &draw {
                Some((_, attachments)) if s.stage == Stage::Fragment => {
                    needed_outputs(&s.words, attachments)
                }
                None if !stripped.is_empty() => Arc::new(strip_images(&s.words, &stripped)),
                _ => s.words.clone(),
            },
            constants: constants
                .iter()
                .filter(|(id, _)| s.interface.constants.contains(id))
                .copied()
                .collect(),
        })
        .collect();
    PipelineDesc {
        name: pass.name.value.clone(),
        bindings: bound
            .map(|(_, b)| BindingDesc {
                binding: b.binding,
                kind: descriptor_type(&b.resource),
                stage: b.stage,
            })
            .collect(),
        push_bytes: if link.stages.iter().any(|s| s.interface.push) {
            4
        } else {
            0
        },
        stages,
        draw,
    }
}

/// The fragment shader without the outputs of attachments that are left out.
fn needed_outputs(words: &Arc<Vec<u32>>, attachments: &Attachments) -> Arc<Vec<u32>> {
    let unneeded: Vec<u32> = (0u32..)
        .zip(&attachments.color)
        .filter(|(_, format)| **format == vk::Format::UNDEFINED)
        .map(|(location, _)| location)
        .collect();
    if unneeded.is_empty() {
        words.clone()
    } else {
        Arc::new(strip_outputs(words, &unneeded))
    }
}

fn draw_state(pass: &PassDecl, step: &Step, plan: &Plan) -> (DrawState, Attachments) {
    let raster = &pass.raster;
    let attachments = Attachments {
        color: step
            .color
            .iter()
            .map(|c| {
                c.as_ref().map_or(vk::Format::UNDEFINED, |a| {
                    plan.textures[a.texture].format.vk
                })
            })
            .collect(),
        depth: step
            .depth
            .as_ref()
            .map(|d| plan.textures[d.texture].format.vk),
    };
    let state = DrawState {
        topology: match pass.topology {
            Topology::Triangles => vk::PrimitiveTopology::TRIANGLE_LIST,
            Topology::Points => vk::PrimitiveTopology::POINT_LIST,
            Topology::Lines => vk::PrimitiveTopology::LINE_LIST,
            Topology::Patches => vk::PrimitiveTopology::PATCH_LIST,
        },
        cull: match raster.cull {
            Cull::None => vk::CullModeFlags::NONE,
            Cull::Back => vk::CullModeFlags::BACK,
            Cull::Front => vk::CullModeFlags::FRONT,
        },
        depth_test: pass
            .depth
            .as_ref()
            .map(|d| compare(d.value.test.unwrap_or(Compare::Less))),
        depth_write: pass.depth.as_ref().is_some_and(|d| d.value.write),
        depth_clamp: raster.depth_clamp,
        samples: step.samples,
        conservative: raster.conservative.is_some(),
        discard: raster.discard,
        blend: pass.color.0.iter().map(|c| c.value.blend).collect(),
    };
    (state, attachments)
}

fn compare(c: Compare) -> vk::CompareOp {
    match c {
        Compare::Never => vk::CompareOp::NEVER,
        Compare::Less => vk::CompareOp::LESS,
        Compare::Equal => vk::CompareOp::EQUAL,
        Compare::LessOrEqual => vk::CompareOp::LESS_OR_EQUAL,
        Compare::Greater => vk::CompareOp::GREATER,
        Compare::NotEqual => vk::CompareOp::NOT_EQUAL,
        Compare::GreaterOrEqual => vk::CompareOp::GREATER_OR_EQUAL,
        Compare::Always => vk::CompareOp::ALWAYS,
    }
}

pub(super) fn sampler_desc(s: &SamplerDecl, mips: bool, integer: bool) -> SamplerDesc {
    let linear = s.filter == FilterMode::Linear && !integer;
    let mip_linear = mips && !integer && s.mip_filter.unwrap_or(s.filter) == FilterMode::Linear;
    SamplerDesc {
        filter: if linear {
            vk::Filter::LINEAR
        } else {
            vk::Filter::NEAREST
        },
        mip_filter: if mip_linear {
            vk::SamplerMipmapMode::LINEAR
        } else {
            vk::SamplerMipmapMode::NEAREST
        },
        address: match s.address {
            AddressMode::Clamp => vk::SamplerAddressMode::CLAMP_TO_EDGE,
            AddressMode::Repeat => vk::SamplerAddressMode::REPEAT,
            AddressMode::Mirror => vk::SamplerAddressMode::MIRRORED_REPEAT,
            AddressMode::BorderZero | AddressMode::BorderOne => {
                vk::SamplerAddressMode::CLAMP_TO_BORDER
            }
        },
        border: match (s.address == AddressMode::BorderOne, integer) {
            (true, false) => vk::BorderColor::FLOAT_OPAQUE_WHITE,
            (false, false) => vk::BorderColor::FLOAT_TRANSPARENT_BLACK,
            (true, true) => vk::BorderColor::INT_OPAQUE_WHITE,
            (false, true) => vk::BorderColor::INT_TRANSPARENT_BLACK,
        },
        compare: s.compare.map(compare),
        anisotropic: false,
    }
}

pub(super) fn clear_value(channels: Channels, value: [f64; 4]) -> vk::ClearColorValue {
    match channels {
        Channels::Uint => vk::ClearColorValue {
            uint32: value.map(|v| v as u32),
        },
        Channels::Int => vk::ClearColorValue {
            int32: value.map(|v| v as i32),
        },
        _ => vk::ClearColorValue {
            float32: value.map(|v| v as f32),
        },
    }
}
