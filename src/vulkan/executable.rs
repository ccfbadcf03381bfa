//! The driver's statistics of compiled pipelines (`VK_KHR_pipeline_executable_properties`).
//!
//! A pipeline is compiled once more to be asked: capturing statistics may cost time, and a pipeline
//! with them may miss the driver's cache. The pipelines in use are not touched.

use super::gpu::text;
use super::{Gpu, Pipeline, PipelineDesc, Result, VulkanError, vk};
use std::sync::Arc;

/// A part of a pipeline that the driver compiled, usually a shader stage.
#[derive(Clone, Debug, PartialEq)]
pub struct Executable {
    /// Name in the driver's words.
    pub name: String,
    /// Invocations per subgroup; 0 if the driver does not fix it.
    pub subgroup_size: u32,
    /// Statistics in the driver's order.
    pub statistics: Vec<Statistic>,
}

/// A statistic of an executable.
#[derive(Clone, Debug, PartialEq)]
pub struct Statistic {
    /// Name in the driver's words.
    pub name: String,
    /// Explanation in the driver's words.
    pub description: String,
    /// Value; 0 or 1 for a yes or no.
    pub value: f64,
}

/// Number of 32-bit registers per multiprocessor for compute capability 5.0 and later, and the unit
/// in which a warp gets them (CUDA C++ Programming Guide, "Technical Specifications per Compute
/// Capability"; CUDA Occupancy Calculator).
const REGISTERS: u32 = 65_536;
const REGISTER_UNIT: u32 = 256;
/// Warps are allocated in this unit, one for each quarter of a multiprocessor (same source).
const WARP_UNIT: u32 = 4;

impl Executable {
    /// The share of a multiprocessor's warps that registers allow to be resident. `None` without the
    /// device's number of warps per multiprocessor or NVIDIA's register count. Shared memory and
    /// workgroup sizes may limit occupancy further.
    pub fn occupancy_limit(&self, warps: Option<u32>) -> Option<f64> {
        let is_count = |s: &&Statistic| s.name == "Register Count";
        let registers = self.statistics.iter().find(is_count)?.value;
        let most = warps.filter(|n| *n > 0)?;
        let of_a_warp = (registers.clamp(1.0, 255.0) as u32 * 32).next_multiple_of(REGISTER_UNIT);
        let fit = REGISTERS / of_a_warp / WARP_UNIT * WARP_UNIT;
        Some(f64::from(fit.min(most)) / f64::from(most))
    }
}

/// Compiles a pipeline again, with statistics.
///
/// # Errors
/// The device does not report statistics; errors of the driver.
pub fn statistics(gpu: &Arc<Gpu>, desc: &PipelineDesc) -> Result<Vec<Executable>> {
    let Some(api) = &gpu.executables else {
        return Err(VulkanError::Unsupported {
            what: "pipeline statistics (VK_KHR_pipeline_executable_properties)",
            device: gpu.info.name.clone(),
        });
    };
    let pipeline = Pipeline::capturing(gpu, desc)?;
    let at = || VulkanError::at(format!("read statistics of pass '{}'", desc.name));
    let info = vk::PipelineInfoKHR::default().pipeline(pipeline.handle);
    // SAFETY: the pipeline is alive and was created with statistics; its index is below the number
    // of its executables; the member of the union is the one that the format names.
    unsafe {
        let list = api.get_pipeline_executable_properties(&info);
        let list = list.map_err(at())?;
        let mut executables = Vec::with_capacity(list.len());
        for (index, properties) in (0..).zip(&list) {
            let info = vk::PipelineExecutableInfoKHR::default()
                .pipeline(pipeline.handle)
                .executable_index(index);
            let statistics = api.get_pipeline_executable_statistics(&info);
            let statistic = |s: &vk::PipelineExecutableStatisticKHR<'_>| Statistic {
                name: text(&s.name),
                description: text(&s.description),
                value: match s.format {
                    vk::PipelineExecutableStatisticFormatKHR::BOOL32 => f64::from(s.value.b32),
                    vk::PipelineExecutableStatisticFormatKHR::INT64 => s.value.i64 as f64,
                    vk::PipelineExecutableStatisticFormatKHR::UINT64 => s.value.u64 as f64,
                    _ => s.value.f64,
                },
            };
            executables.push(Executable {
                name: text(&properties.name),
                subgroup_size: properties.subgroup_size,
                statistics: statistics.map_err(at())?.iter().map(statistic).collect(),
            });
        }
        Ok(executables)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn registers_limit_how_many_warps_are_resident() {
        let executable = |registers: f64| Executable {
            name: "Compute Shader".into(),
            subgroup_size: 32,
            statistics: vec![Statistic {
                name: "Register Count".into(),
                description: String::new(),
                value: registers,
            }],
        };
        let limit = |registers| executable(registers).occupancy_limit(Some(64));
        // Values of the CUDA Occupancy Calculator for compute capability 9.0.
        assert_eq!(
            [32.0, 40.0, 64.0, 168.0, 255.0].map(limit),
            [1.0, 0.75, 0.5, 0.1875, 0.125].map(Some)
        );
        assert_eq!(executable(32.0).occupancy_limit(None), None);
        let other = Executable {
            statistics: Vec::new(),
            ..executable(1.0)
        };
        assert_eq!(other.occupancy_limit(Some(64)), None);
    }
}
