//! conelab: a research workbench for voxel cone tracing.
//!
//! Knowledge flows one way: [`vulkan`], [`shader`], [`graph`] know no scene; [`scene`] knows no device; [`lab`] joins
//! them to run an [`experiment`]; the commands and the [`workbench`] are thin users of the lab.
pub mod camera_path;
pub mod campaign;
pub mod commands;
pub mod diagnostics;
pub mod experiment;
pub mod files;
pub mod graph;
pub mod lab;
pub mod measure;
pub mod metrics;
pub mod results;
pub mod scene;
pub mod shader;
pub mod vulkan;
pub mod workbench;
