//! Bindings of a plan's steps: pipelines, attachments, descriptor sets.

use super::pipelines::{descriptor_type, sampler_desc};
use super::resources::Resources;
use super::scene::SceneResources;
use crate::graph::definition::Graph;
use crate::graph::link::{Bound, BoundCase, Linked, Target, bound_shape};
use crate::graph::plan::{AttachmentPlan, BindingPlan, Plan, Step};
use crate::shader::{Resource, Shape};
use crate::vulkan::{
    Buffer, DescriptorPool, DescriptorSet, DescriptorWrite, Gpu, Pipeline, Result, Sampler,
    SamplerDesc, View, ViewDesc, VulkanError, format::Channels, vk,
};
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::Arc;

/// Bindings of a step; attachments and sets in even and in odd frames.
pub(super) struct StepGpu {
    pub pipeline: Option<Arc<Pipeline>>,
    /// Whether its shaders read the step's index.
    pub push: bool,
    pub sets: [Option<DescriptorSet>; 2],
    pub color: [Vec<Option<View>>; 2],
    pub depth: [Option<View>; 2],
}

/// What there is to be bound.
pub(super) struct Offered<'a> {
    pub gpu: &'a Arc<Gpu>,
    pub graph: &'a Graph,
    pub linked: &'a [Linked],
    pub plan: &'a Plan,
    pub resources: &'a Resources,
    pub scene: &'a SceneResources,
    /// The block of parameters.
    pub params: &'a Buffer,
}

/// The descriptor sets of a program, and the objects in them.
pub(super) struct Sets {
    pool: DescriptorPool,
    samplers: HashMap<SamplerDesc, Sampler>,
    views: Vec<View>,
}

impl Sets {
    /// None yet, with room for those of a plan.
    pub fn new(gpu: &Arc<Gpu>, plan: &Plan, linked: &[Linked]) -> Result<Sets> {
        let bound = plan.steps.iter().flat_map(|s| &linked[s.pass].bound);
        let kinds: Vec<_> = bound
            .map(|b| descriptor_type(&b.resource))
            .flat_map(|k| [k, k])
            .collect();
        let pool = DescriptorPool::new(
            gpu,
            u32::try_from(plan.steps.len() * 2).unwrap_or(u32::MAX),
            &kinds,
        )?;
        Ok(Sets {
            pool,
            samplers: HashMap::new(),
            views: Vec::new(),
        })
    }

    pub fn step(
        &mut self,
        offered: &Offered<'_>,
        step: &Step,
        pipeline: Option<Arc<Pipeline>>,
    ) -> Result<StepGpu> {
        let link = &offered.linked[step.pass];
        let mut out = StepGpu {
            push: link.stages.iter().any(|s| s.interface.push),
            sets: [None, None],
            color: [Vec::new(), Vec::new()],
            depth: [None, None],
            pipeline,
        };
        for parity in 0..2 {
            let view = |slot: &Option<AttachmentPlan>| {
                slot.as_ref()
                    .map(|a| offered.attachment(a, parity))
                    .transpose()
            };
            out.color[parity] = step.color.iter().map(view).collect::<Result<_>>()?;
            out.depth[parity] = view(&step.depth)?;
            if let Some(pipeline) = out.pipeline.as_ref().filter(|_| !link.bound.is_empty()) {
                out.sets[parity] = Some(self.set(offered, link, step, pipeline, parity)?);
            }
        }
        Ok(out)
    }

    fn set(
        &mut self,
        offered: &Offered<'_>,
        link: &Linked,
        step: &Step,
        pipeline: &Pipeline,
        parity: usize,
    ) -> Result<DescriptorSet> {
        let bound = || {
            link.bound
                .iter()
                .zip(&step.cases)
                .map(|(bound, case)| (bound, &bound.cases[*case]))
        };
        let mut textures = Vec::new();
        for (i, (bound, case)) in bound().enumerate() {
            // Images without stores, which were removed from the shader, have no binding.
            let plan = step.bindings.iter().find(|b| b.bound == i);
            textures.push(
                plan.map(|plan| self.texture(offered, bound, case, plan, parity))
                    .transpose()?,
            );
        }
        let mut writes = Vec::new();
        for ((bound, case), texture) in bound().zip(&textures) {
            let write = match (&case.target, texture) {
                (Target::External(e), _) => {
                    offered.external(offered.graph.interface.resources[*e].name)?
                }
                (Target::Buffer(b), _) => {
                    let last = case.bind.as_ref().is_some_and(|d| d.history);
                    match offered.resources.buffer(offered.plan, *b, last, parity) {
                        Some(buffer) => DescriptorWrite::Buffer(buffer),
                        None => continue,
                    }
                }
                (Target::Texture(_), Some((view, sampler, layout))) => {
                    match self.samplers.get(sampler) {
                        Some(sampler) if matches!(bound.resource, Resource::Sampled { .. }) => {
                            DescriptorWrite::Sampled(view, sampler, *layout)
                        }
                        _ => DescriptorWrite::Storage(view),
                    }
                }
                (Target::Texture(_), None) => continue,
            };
            writes.push((bound.binding, descriptor_type(&bound.resource), write));
        }
        let set = self.pool.set(pipeline, &writes)?;
        drop(writes);
        self.views
            .extend(textures.into_iter().flatten().map(|(view, ..)| view));
        Ok(set)
    }

    /// A texture as a binding sees it, and how it is sampled.
    fn texture(
        &mut self,
        offered: &Offered<'_>,
        bound: &Bound,
        case: &BoundCase,
        plan: &BindingPlan,
        parity: usize,
    ) -> Result<(View, SamplerDesc, vk::ImageLayout)> {
        let (texture, planned) = (
            &offered.graph.textures[plan.texture].1.value,
            &offered.plan.textures[plan.texture],
        );
        let format = plan.format.unwrap_or(planned.format);
        let desc = ViewDesc {
            kind: match bound_shape(texture) {
                Shape::D2 => vk::ImageViewType::TYPE_2D,
                Shape::D2Array => vk::ImageViewType::TYPE_2D_ARRAY,
                Shape::D3 => vk::ImageViewType::TYPE_3D,
            },
            format: format.vk,
            aspect: format.aspect(),
            mips: plan.mips,
            layers: (0, planned.layers),
            usage: match bound.resource {
                Resource::Storage { .. } => vk::ImageUsageFlags::STORAGE,
                _ => vk::ImageUsageFlags::SAMPLED,
            },
        };
        let view = View::new(
            offered
                .resources
                .image(offered.plan, plan.texture, plan.history, parity)?,
            &desc,
        )?;
        let sampler = case
            .bind
            .as_ref()
            .and_then(|d| d.sampler)
            .or(texture.sampler)
            .unwrap_or_default();
        let integer = matches!(format.channels, Channels::Uint | Channels::Int);
        let desc = sampler_desc(&sampler, planned.mips > 1, integer);
        if let Entry::Vacant(slot) = self.samplers.entry(desc) {
            slot.insert(Sampler::new(offered.gpu, &desc)?);
        }
        Ok((view, desc, plan.layout))
    }
}

impl Offered<'_> {
    fn attachment(&self, attachment: &AttachmentPlan, parity: usize) -> Result<View> {
        let format = self.plan.textures[attachment.texture].format;
        let desc = ViewDesc {
            kind: vk::ImageViewType::TYPE_2D,
            format: format.vk,
            aspect: format.aspect(),
            mips: (attachment.mip, 1),
            layers: (attachment.layer, 1),
            usage: match format.is_depth() {
                true => vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT,
                false => vk::ImageUsageFlags::COLOR_ATTACHMENT,
            },
        };
        View::new(
            self.resources
                .image(self.plan, attachment.texture, false, parity)?,
            &desc,
        )
    }

    fn external(&self, name: &str) -> Result<DescriptorWrite<'_>> {
        if name == "params" {
            return Ok(DescriptorWrite::Buffer(self.params));
        }
        if let Some(buffer) = self.scene.buffers.get(name) {
            return Ok(DescriptorWrite::Buffer(buffer));
        }
        let view = self
            .scene
            .textures
            .get(name)
            .ok_or_else(|| VulkanError::Code {
                what: format!("find the scene's '{name}'"),
                code: vk::Result::ERROR_UNKNOWN,
            })?;
        Ok(DescriptorWrite::Sampled(
            view,
            &self.scene.sampler,
            vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
        ))
    }
}
