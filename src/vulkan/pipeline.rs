//! Pipelines, layouts and descriptor sets. Each pipeline has one descriptor set, number 0.

use super::{Buffer, Gpu, Result, Sampler, View, VulkanError, vk};
use serde::Deserialize;

use std::ffi::CString;
use std::sync::Arc;

/// Shader stages in pipeline order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Stage {
    /// `.vert`
    Vertex,
    /// `.tesc`
    TessControl,
    /// `.tese`
    TessEvaluation,
    /// `.geom`
    Geometry,
    /// `.frag`
    Fragment,
    /// `.comp`
    Compute,
}

impl Stage {
    /// All stages with their file extensions.
    pub const ALL: [(Stage, &'static str); 6] = [
        (Stage::Vertex, "vert"),
        (Stage::TessControl, "tesc"),
        (Stage::TessEvaluation, "tese"),
        (Stage::Geometry, "geom"),
        (Stage::Fragment, "frag"),
        (Stage::Compute, "comp"),
    ];

    /// The stage of a file name's extension.
    pub(crate) fn of_file(name: &str) -> Option<Stage> {
        let extension = name.rsplit_once('.')?.1;
        Stage::ALL
            .iter()
            .find(|(_, e)| *e == extension)
            .map(|(s, _)| *s)
    }

    fn flag(self) -> vk::ShaderStageFlags {
        match self {
            Stage::Vertex => vk::ShaderStageFlags::VERTEX,
            Stage::TessControl => vk::ShaderStageFlags::TESSELLATION_CONTROL,
            Stage::TessEvaluation => vk::ShaderStageFlags::TESSELLATION_EVALUATION,
            Stage::Geometry => vk::ShaderStageFlags::GEOMETRY,
            Stage::Fragment => vk::ShaderStageFlags::FRAGMENT,
            Stage::Compute => vk::ShaderStageFlags::COMPUTE,
        }
    }

    /// The stage as a synchronization2 flag.
    pub fn sync(self) -> vk::PipelineStageFlags2 {
        match self {
            Stage::Vertex => vk::PipelineStageFlags2::VERTEX_SHADER,
            Stage::TessControl => vk::PipelineStageFlags2::TESSELLATION_CONTROL_SHADER,
            Stage::TessEvaluation => vk::PipelineStageFlags2::TESSELLATION_EVALUATION_SHADER,
            Stage::Geometry => vk::PipelineStageFlags2::GEOMETRY_SHADER,
            Stage::Fragment => vk::PipelineStageFlags2::FRAGMENT_SHADER,
            Stage::Compute => vk::PipelineStageFlags2::COMPUTE_SHADER,
        }
    }
}

/// A 32-bit specialisation constant.
pub type SpecValue = u32;

/// One stage of a pipeline; SPIR-V with the bindings of the pipeline's list.
#[derive(Clone, Debug, PartialEq)]
pub struct StageDesc {
    /// Stage of the shader.
    pub stage: Stage,
    pub spirv: Arc<Vec<u32>>,
    pub constants: Vec<(u32, SpecValue)>,
}

/// A binding of the descriptor set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BindingDesc {
    pub binding: u32,
    pub kind: vk::DescriptorType,
    /// The stage that uses it.
    pub stage: Stage,
}

/// Attachment formats; an unused colour is `UNDEFINED`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Attachments {
    /// Colour formats by location.
    pub color: Vec<vk::Format>,
    pub depth: Option<vk::Format>,
}

/// Blend operation of a colour attachment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Blend {
    /// Replaces the destination.
    #[default]
    Off,
    /// Over, by the source's alpha.
    Alpha,
    /// Sum.
    Add,
    /// Minimum.
    Min,
    /// Maximum.
    Max,
}

impl Blend {
    fn state(self) -> vk::PipelineColorBlendAttachmentState {
        let (src, dst) = match self {
            Blend::Off => (vk::BlendFactor::ONE, vk::BlendFactor::ZERO),
            Blend::Alpha => (
                vk::BlendFactor::SRC_ALPHA,
                vk::BlendFactor::ONE_MINUS_SRC_ALPHA,
            ),
            Blend::Add | Blend::Min | Blend::Max => (vk::BlendFactor::ONE, vk::BlendFactor::ONE),
        };
        let op = match self {
            Blend::Min => vk::BlendOp::MIN,
            Blend::Max => vk::BlendOp::MAX,
            _ => vk::BlendOp::ADD,
        };
        vk::PipelineColorBlendAttachmentState::default()
            .blend_enable(self != Blend::Off)
            .src_color_blend_factor(src)
            .dst_color_blend_factor(dst)
            .src_alpha_blend_factor(vk::BlendFactor::ONE)
            .dst_alpha_blend_factor(dst)
            .color_blend_op(op)
            .alpha_blend_op(op)
            .color_write_mask(vk::ColorComponentFlags::RGBA)
    }
}

/// Fixed-function state of a raster pipeline.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawState {
    pub topology: vk::PrimitiveTopology,
    /// Culled faces (counter-clockwise is front).
    pub cull: vk::CullModeFlags,
    /// Depth test; disabled if absent.
    pub depth_test: Option<vk::CompareOp>,
    /// Whether depth is written.
    pub depth_write: bool,
    /// Clamps depth instead of clipping.
    pub depth_clamp: bool,
    /// Sample count of attachment-less rasterisation; 1 otherwise.
    pub samples: u32,
    /// Overestimating conservative rasterisation.
    pub conservative: bool,
    /// Disables rasterisation.
    pub discard: bool,
    /// Blending per colour attachment.
    pub blend: Vec<Blend>,
}

/// Description of a pipeline.
#[derive(Clone, Debug, PartialEq)]
pub struct PipelineDesc {
    pub name: String,
    pub stages: Vec<StageDesc>,
    /// Bindings of the shaders.
    pub bindings: Vec<BindingDesc>,
    /// Size of the push constants of all stages (bytes).
    pub push_bytes: u32,
    /// Raster state; `None` for a compute pipeline.
    pub draw: Option<(DrawState, Attachments)>,
}

/// Flags of a pipeline, and the cache for it.
type How = (vk::PipelineCreateFlags, vk::PipelineCache);

/// A pipeline with its layout.
pub struct Pipeline {
    gpu: Arc<Gpu>,
    pub(super) handle: vk::Pipeline,
    pub(super) layout: vk::PipelineLayout,
    set_layout: vk::DescriptorSetLayout,
    pub(super) point: vk::PipelineBindPoint,
    pub(super) push_stages: vk::ShaderStageFlags,
}

impl Pipeline {
    /// Makes the layout of bindings and push constants.
    fn make_layout(&mut self, desc: &PipelineDesc) -> Result<()> {
        let binding = |b: &BindingDesc| {
            vk::DescriptorSetLayoutBinding::default()
                .binding(b.binding)
                .descriptor_type(b.kind)
                .descriptor_count(1)
                .stage_flags(b.stage.flag())
        };
        let bindings: Vec<_> = desc.bindings.iter().map(binding).collect();
        let at = |what: &str| VulkanError::at(format!("{what} of pass '{}'", desc.name));
        let device = &self.gpu.device;
        // SAFETY: the structures outlive the creation calls; `drop` destroys the handles, null or
        // not.
        unsafe {
            let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            let layout = device.create_descriptor_set_layout(&info, None);
            self.set_layout = layout.map_err(at("create the bindings"))?;
            let sets = [self.set_layout];
            let ranges = [vk::PushConstantRange::default()
                .stage_flags(self.push_stages)
                .size(desc.push_bytes)];
            let mut info = vk::PipelineLayoutCreateInfo::default().set_layouts(&sets);
            if desc.push_bytes > 0 {
                info = info.push_constant_ranges(&ranges);
            }
            let layout = device.create_pipeline_layout(&info, None);
            self.layout = layout.map_err(at("create the layout"))?;
        }
        Ok(())
    }

    /// Makes a pipeline.
    pub fn new(gpu: &Arc<Gpu>, desc: &PipelineDesc) -> Result<Pipeline> {
        let how = (vk::PipelineCreateFlags::empty(), gpu.pipeline_cache);
        Pipeline::create(gpu, desc, how)
    }

    /// Makes a pipeline with statistics, past the pipeline cache.
    pub(super) fn capturing(gpu: &Arc<Gpu>, desc: &PipelineDesc) -> Result<Pipeline> {
        let flags = vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR;
        Pipeline::create(gpu, desc, (flags, vk::PipelineCache::null()))
    }

    fn create(gpu: &Arc<Gpu>, desc: &PipelineDesc, how: How) -> Result<Pipeline> {
        let flags = desc.stages.iter().map(|s| s.stage.flag());
        let push_stages = flags.fold(vk::ShaderStageFlags::empty(), |a, flag| a | flag);
        let at = |what: &str| VulkanError::at(format!("{what} of pass '{}'", desc.name));
        let mut pipeline = Pipeline {
            gpu: gpu.clone(),
            handle: vk::Pipeline::null(),
            layout: vk::PipelineLayout::null(),
            set_layout: vk::DescriptorSetLayout::null(),
            point: match desc.draw {
                Some(_) => vk::PipelineBindPoint::GRAPHICS,
                None => vk::PipelineBindPoint::COMPUTE,
            },
            push_stages,
        };
        pipeline.make_layout(desc)?;
        let modules = Modules::new(gpu, desc)?;
        let constants: Vec<(Vec<vk::SpecializationMapEntry>, Vec<u8>)> =
            desc.stages.iter().map(pack_constants).collect();
        let special = vk::SpecializationInfo::default();
        let specials = constants.iter();
        let specials: Vec<_> = specials
            .map(|(entries, data)| special.map_entries(entries).data(data))
            .collect();
        let entry = CString::from(c"main");
        let stages = desc.stages.iter().zip(&modules.handles).zip(&specials);
        let stages = stages.map(|((stage, module), special)| {
            vk::PipelineShaderStageCreateInfo::default()
                .stage(stage.stage.flag())
                .module(*module)
                .name(&entry)
                .specialization_info(special)
        });
        let (layout, stages) = (pipeline.layout, stages.collect::<Vec<_>>());
        let handle = match &desc.draw {
            None => compute(gpu, layout, &stages, how),
            Some((state, attachments)) => graphics(gpu, layout, &stages, (state, attachments), how),
        };
        pipeline.handle = handle.map_err(at("create the pipeline"))?;
        gpu.name(pipeline.handle, &desc.name);
        Ok(pipeline)
    }
}

/// Shader modules, destroyed after pipeline creation.
struct Modules<'a> {
    gpu: &'a Gpu,
    handles: Vec<vk::ShaderModule>,
}

impl<'a> Modules<'a> {
    fn new(gpu: &'a Gpu, desc: &PipelineDesc) -> Result<Modules<'a>> {
        let mut modules = Modules {
            gpu,
            handles: Vec::new(),
        };
        for stage in &desc.stages {
            let info = vk::ShaderModuleCreateInfo::default().code(&stage.spirv);
            // SAFETY: the words come from shaderc or from a cache file with a valid checksum.
            let handle = unsafe { gpu.device.create_shader_module(&info, None) }.map_err(
                VulkanError::at(format!("load a shader of pass '{}'", desc.name)),
            )?;
            modules.handles.push(handle);
        }
        Ok(modules)
    }
}

impl Drop for Modules<'_> {
    fn drop(&mut self) {
        for handle in &self.handles {
            // SAFETY: pipelines do not need their modules after creation.
            unsafe { self.gpu.device.destroy_shader_module(*handle, None) };
        }
    }
}

fn pack_constants(stage: &StageDesc) -> (Vec<vk::SpecializationMapEntry>, Vec<u8>) {
    let entries = (0u32..)
        .zip(&stage.constants)
        .map(|(i, (id, _))| {
            vk::SpecializationMapEntry::default()
                .constant_id(*id)
                .offset(i * 4)
                .size(4)
        })
        .collect();
    (
        entries,
        stage
            .constants
            .iter()
            .flat_map(|(_, v)| v.to_ne_bytes())
            .collect(),
    )
}

fn compute(
    gpu: &Gpu,
    layout: vk::PipelineLayout,
    stages: &[vk::PipelineShaderStageCreateInfo<'_>],
    (flags, cache): How,
) -> std::result::Result<vk::Pipeline, vk::Result> {
    let Some(stage) = stages.first() else {
        return Err(vk::Result::ERROR_UNKNOWN);
    };
    let info = [vk::ComputePipelineCreateInfo::default()
        .flags(flags)
        .layout(layout)
        .stage(*stage)];
    // SAFETY: layout and module are alive.
    let made = unsafe { gpu.device.create_compute_pipelines(cache, &info, None) };
    made.map(|p| p[0]).map_err(|(_, code)| code)
}

impl DrawState {
    fn raster(&self) -> vk::PipelineRasterizationStateCreateInfo<'static> {
        vk::PipelineRasterizationStateCreateInfo::default()
            .polygon_mode(vk::PolygonMode::FILL)
            .cull_mode(self.cull)
            .front_face(vk::FrontFace::COUNTER_CLOCKWISE)
            .depth_clamp_enable(self.depth_clamp)
            .rasterizer_discard_enable(self.discard)
            .line_width(1.0)
    }
}

fn graphics(
    gpu: &Gpu,
    layout: vk::PipelineLayout,
    stages: &[vk::PipelineShaderStageCreateInfo<'_>],
    (state, attachments): (&DrawState, &Attachments),
    (flags, cache): How,
) -> std::result::Result<vk::Pipeline, vk::Result> {
    let vertex = vk::PipelineVertexInputStateCreateInfo::default();
    let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(state.topology);
    let tessellation = vk::PipelineTessellationStateCreateInfo::default().patch_control_points(3);
    let viewport = vk::PipelineViewportStateCreateInfo::default()
        .viewport_count(1)
        .scissor_count(1);
    let mut conservative = vk::PipelineRasterizationConservativeStateCreateInfoEXT::default()
        .conservative_rasterization_mode(vk::ConservativeRasterizationModeEXT::OVERESTIMATE);
    let mut raster = state.raster();
    if state.conservative {
        raster = raster.push_next(&mut conservative);
    }
    let multisample = vk::PipelineMultisampleStateCreateInfo::default()
        .rasterization_samples(vk::SampleCountFlags::from_raw(state.samples));
    let depth = vk::PipelineDepthStencilStateCreateInfo::default()
        .depth_test_enable(state.depth_test.is_some())
        .depth_write_enable(state.depth_write)
        .depth_compare_op(state.depth_test.unwrap_or(vk::CompareOp::ALWAYS));
    // Unused attachments have no blend state.
    let blends = state.blend.iter().zip(&attachments.color);
    let blends = blends.map(|(blend, format)| match *format {
        vk::Format::UNDEFINED => vk::PipelineColorBlendAttachmentState::default(),
        _ => blend.state(),
    });
    let blends: Vec<_> = blends.collect();
    let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
    let dynamic_states = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
    let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic_states);
    let mut rendering = vk::PipelineRenderingCreateInfo::default()
        .color_attachment_formats(&attachments.color)
        .depth_attachment_format(attachments.depth.unwrap_or(vk::Format::UNDEFINED));
    let info = [vk::GraphicsPipelineCreateInfo::default()
        .flags(flags)
        .stages(stages)
        .vertex_input_state(&vertex)
        .input_assembly_state(&assembly)
        .tessellation_state(&tessellation)
        .viewport_state(&viewport)
        .rasterization_state(&raster)
        .multisample_state(&multisample)
        .depth_stencil_state(&depth)
        .color_blend_state(&blend)
        .dynamic_state(&dynamic)
        .layout(layout)
        .push_next(&mut rendering)];
    // SAFETY: layout and modules are alive; all state outlives the call.
    let made = unsafe { gpu.device.create_graphics_pipelines(cache, &info, None) };
    made.map(|p| p[0]).map_err(|(_, code)| code)
}

impl Drop for Pipeline {
    fn drop(&mut self) {
        if self.gpu.is_hung() {
            return;
        }
        // SAFETY: owners drop pipelines only after the frames that use them; null handles are
        // ignored.
        unsafe {
            self.gpu.device.destroy_pipeline(self.handle, None);
            self.gpu.device.destroy_pipeline_layout(self.layout, None);
            self.gpu
                .device
                .destroy_descriptor_set_layout(self.set_layout, None);
        }
    }
}

/// A pool of descriptor sets that are freed together.
pub struct DescriptorPool {
    gpu: Arc<Gpu>,
    handle: vk::DescriptorPool,
}

/// A descriptor set, valid as long as its pool.
#[derive(Clone, Copy)]
pub struct DescriptorSet(pub(super) vk::DescriptorSet);

/// The value of a binding.
pub enum DescriptorWrite<'a> {
    Buffer(&'a Buffer),
    /// A sampled image in a layout.
    Sampled(&'a View, &'a Sampler, vk::ImageLayout),
    Storage(&'a View),
}

impl DescriptorPool {
    /// A pool for `sets` sets of these binding types.
    pub fn new(gpu: &Arc<Gpu>, sets: u32, kinds: &[vk::DescriptorType]) -> Result<DescriptorPool> {
        let count = |kind: vk::DescriptorType| {
            let n = kinds.iter().filter(|k| **k == kind).count();
            vk::DescriptorPoolSize {
                ty: kind,
                descriptor_count: u32::try_from(n).unwrap_or(u32::MAX).max(1),
            }
        };
        let sizes = [
            count(vk::DescriptorType::UNIFORM_BUFFER),
            count(vk::DescriptorType::STORAGE_BUFFER),
            count(vk::DescriptorType::STORAGE_IMAGE),
            count(vk::DescriptorType::COMBINED_IMAGE_SAMPLER),
        ];
        let info = vk::DescriptorPoolCreateInfo::default()
            .max_sets(sets.max(1))
            .pool_sizes(&sizes);
        // SAFETY: a plain creation; destroyed in `drop`.
        let handle = unsafe { gpu.device.create_descriptor_pool(&info, None) }
            .map_err(VulkanError::at("create a descriptor pool"))?;
        Ok(DescriptorPool {
            gpu: gpu.clone(),
            handle,
        })
    }

    /// A descriptor set of the pipeline with these values.
    ///
    /// # Errors
    /// The pool is full.
    pub fn set(
        &self,
        pipeline: &Pipeline,
        writes: &[(u32, vk::DescriptorType, DescriptorWrite<'_>)],
    ) -> Result<DescriptorSet> {
        let layouts = [pipeline.set_layout];
        let info = vk::DescriptorSetAllocateInfo::default()
            .descriptor_pool(self.handle)
            .set_layouts(&layouts);
        // SAFETY: pool and layout are alive.
        let set = unsafe { self.gpu.device.allocate_descriptor_sets(&info) }
            .map_err(VulkanError::at("allocate a descriptor set"))?[0];
        let buffers: Vec<[vk::DescriptorBufferInfo; 1]> = writes
            .iter()
            .map(|(_, _, w)| match w {
                DescriptorWrite::Buffer(b) => [vk::DescriptorBufferInfo::default()
                    .buffer(b.handle)
                    .range(vk::WHOLE_SIZE)],
                _ => [vk::DescriptorBufferInfo::default()],
            })
            .collect();
        let images: Vec<[vk::DescriptorImageInfo; 1]> = writes
            .iter()
            .map(|(_, _, w)| match w {
                DescriptorWrite::Sampled(view, sampler, layout) => {
                    [vk::DescriptorImageInfo::default()
                        .image_view(view.handle)
                        .sampler(sampler.handle)
                        .image_layout(*layout)]
                }
                DescriptorWrite::Storage(view) => [vk::DescriptorImageInfo::default()
                    .image_view(view.handle)
                    .image_layout(vk::ImageLayout::GENERAL)],
                DescriptorWrite::Buffer(_) => [vk::DescriptorImageInfo::default()],
            })
            .collect();
        let list: Vec<_> = writes
            .iter()
            .enumerate()
            .map(|(i, (binding, kind, write))| {
                let out = vk::WriteDescriptorSet::default()
                    .dst_set(set)
                    .dst_binding(*binding)
                    .descriptor_type(*kind);
                match write {
                    DescriptorWrite::Buffer(_) => out.buffer_info(&buffers[i]),
                    _ => out.image_info(&images[i]),
                }
            })
            .collect();
        // SAFETY: the set is new and not in a command buffer; owners keep the resources alive while
        // frames use it.
        unsafe { self.gpu.device.update_descriptor_sets(&list, &[]) };
        Ok(DescriptorSet(set))
    }
}

impl Drop for DescriptorPool {
    fn drop(&mut self) {
        if self.gpu.is_hung() {
            return;
        }
        // SAFETY: owners drop pools only after the frames that use their sets have finished.
        unsafe { self.gpu.device.destroy_descriptor_pool(self.handle, None) };
    }
}
