//! Samplers.

use super::{Gpu, Result, VulkanError, vk};
use std::sync::Arc;

/// Filter and address mode of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SamplerDesc {
    /// Texel filter.
    pub filter: vk::Filter,
    pub mip_filter: vk::SamplerMipmapMode,
    /// Address mode outside [0, 1].
    pub address: vk::SamplerAddressMode,
    /// Border colour for a border address mode.
    pub border: vk::BorderColor,
    /// Depth comparison for shadow samplers.
    pub compare: Option<vk::CompareOp>,
    /// Anisotropic filtering, limited by the device and 16.
    pub anisotropic: bool,
}

pub struct Sampler {
    gpu: Arc<Gpu>,
    pub(super) handle: vk::Sampler,
}

impl Sampler {
    /// Makes a sampler.
    pub fn new(gpu: &Arc<Gpu>, desc: &SamplerDesc) -> Result<Sampler> {
        let anisotropic = desc.anisotropic && gpu.info.features.anisotropy;
        let info = vk::SamplerCreateInfo::default()
            .mag_filter(desc.filter)
            .min_filter(desc.filter)
            .mipmap_mode(desc.mip_filter)
            .address_mode_u(desc.address)
            .address_mode_v(desc.address)
            .address_mode_w(desc.address)
            .border_color(desc.border)
            .anisotropy_enable(anisotropic)
            .max_anisotropy(if anisotropic {
                gpu.info.limits.max_sampler_anisotropy.min(16.0)
            } else {
                1.0
            })
            .compare_enable(desc.compare.is_some())
            .compare_op(desc.compare.unwrap_or(vk::CompareOp::ALWAYS))
            .max_lod(vk::LOD_CLAMP_NONE);
        // SAFETY: a plain creation; destroyed in `drop`.
        let handle = unsafe { gpu.device.create_sampler(&info, None) }
            .map_err(VulkanError::at("create a sampler"))?;
        Ok(Sampler {
            gpu: gpu.clone(),
            handle,
        })
    }
}

impl Drop for Sampler {
    fn drop(&mut self) {
        if self.gpu.is_hung() {
            return;
        }
        // SAFETY: owners drop samplers only after the frames that use them have finished.
        unsafe { self.gpu.device.destroy_sampler(self.handle, None) };
    }
}
