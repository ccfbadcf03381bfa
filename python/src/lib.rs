//! The native half of the Python package `conelab`: a thin user of the lab, its measurements and its campaigns. Names,
//! defaults and everything about notebooks is in `python/conelab`.
#![allow(
    missing_docs,
    reason = "documented for users in python/conelab, the only user of this module"
)]

mod campaign;
mod errors;
mod experiment;
mod functions;
mod lab;
mod memory;
mod owned;
mod params;
mod progress;
mod reference;

use pyo3::prelude::pymodule;

#[pymodule]
mod _conelab {
    #[pymodule_export]
    use super::campaign::{run_bench, run_fit, run_stability, run_sweep};
    #[pymodule_export]
    use super::experiment::Experiment;
    #[pymodule_export]
    use super::functions::{
        compare, devices, displayed, error_maps, graph_params, magma, metrics, png, read_picture,
        scenes, version, write_picture,
    };
    #[pymodule_export]
    use super::lab::Lab;
    #[pymodule_export]
    use super::memory::Memory;
    #[pymodule_export]
    use super::reference::Reference;
}
