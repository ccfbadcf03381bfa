//! The driver's statistics of a program's pipelines.

use super::program::Program;
use crate::vulkan::{Executable, Gpu, PipelineDesc, Result, statistics};
use rayon::prelude::*;
use std::sync::Arc;

/// The executables of a pass's pipeline.
#[derive(Clone, Debug, PartialEq)]
pub struct PassExecutables {
    /// Name of the pass.
    pub pass: String,
    /// One for each shader stage, usually, with the occupancy that its registers allow, if known.
    pub executables: Vec<(Executable, Option<f64>)>,
}

/// The pipelines of a program, to be asked about on any thread.
pub struct StatisticsRequest {
    gpu: Arc<Gpu>,
    descs: Vec<PipelineDesc>,
}

impl StatisticsRequest {
    /// Compiles each pipeline once more to read its statistics.
    ///
    /// # Errors
    /// The device does not report statistics; errors of the driver.
    pub fn run(self) -> Result<Vec<PassExecutables>> {
        let warps = self.gpu.info.warps;
        let ask = |desc: &PipelineDesc| {
            let list = statistics(&self.gpu, desc)?.into_iter();
            Ok(PassExecutables {
                pass: desc.name.clone(),
                executables: list
                    .map(|e| (e.clone(), e.occupancy_limit(warps)))
                    .collect(),
            })
        };
        self.descs.par_iter().map(ask).collect()
    }
}

impl Program {
    /// A request for the statistics of all pipelines.
    pub fn statistics(&self) -> StatisticsRequest {
        StatisticsRequest {
            gpu: self.gpu.clone(),
            descs: self.pipelines.iter().map(|p| p.0.clone()).collect(),
        }
    }
}
