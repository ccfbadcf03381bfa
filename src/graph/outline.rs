//! A plan in JSON: passes that run, their resources, and sizes.

use super::definition::Graph;
use super::param::{Params, Value};
use super::plan::{Plan, Use};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// Version of the schema.
pub const SCHEMA: &str = "conelab-graph-1";

/// What `conelab graph --json` writes.
#[derive(Clone, Debug, Serialize)]
pub struct Outline {
    /// [`SCHEMA`].
    pub schema: &'static str,
    /// The graph's name.
    pub graph: String,
    /// All parameters.
    pub params: BTreeMap<String, Value>,
    /// Passes that run, in order.
    pub passes: Vec<PassOutline>,
    /// Textures that are made.
    pub textures: Vec<TextureOutline>,
    /// Buffers that are made.
    pub buffers: Vec<BufferOutline>,
    /// Passes that do not run, and why.
    pub left_out: BTreeMap<String, String>,
}

/// A pass.
#[derive(Clone, Debug, Serialize)]
pub struct PassOutline {
    /// Name.
    pub name: String,
    /// Stage.
    pub stage: String,
    /// How often it runs in a frame.
    pub steps: usize,
    /// Resources that it reads.
    pub reads: BTreeSet<String>,
    /// Resources that it writes.
    pub writes: BTreeSet<String>,
}

/// A texture.
#[derive(Clone, Debug, Serialize)]
pub struct TextureOutline {
    /// Name.
    pub name: String,
    /// Width, height, depth in texels.
    pub extent: [u32; 3],
    /// Format.
    pub format: &'static str,
    /// Mips.
    pub mips: u32,
    /// Layers.
    pub layers: u32,
    /// Whether it holds nothing between frames, and may share memory.
    pub transient: bool,
    /// Whether a second copy holds last frame's content.
    pub history: bool,
    /// Bytes of all copies.
    pub bytes: u64,
}

/// A buffer.
#[derive(Clone, Debug, Serialize)]
pub struct BufferOutline {
    /// Name.
    pub name: String,
    /// Whether it holds nothing between frames, and may share memory.
    pub transient: bool,
    /// Whether a second copy holds last frame's content.
    pub history: bool,
    /// Bytes of all copies.
    pub bytes: u64,
}

/// The outline of a plan with these parameters.
pub fn outline(graph: &Graph, params: &Params, plan: &Plan) -> Outline {
    let passes = plan.steps.chunk_by(|a, b| a.pass == b.pass).map(|steps| {
        let pass = &graph.passes[steps[0].pass].value;
        let uses = || steps.iter().flat_map(|s| &s.uses);
        let name = |u: &Use| graph.title_of(u.res);
        PassOutline {
            name: pass.name.value.clone(),
            stage: pass.stage().into(),
            steps: steps.len(),
            reads: uses().filter(|u| u.read).map(name).collect(),
            writes: uses().filter(|u| u.write).map(name).collect(),
        }
    });
    let textures = plan
        .textures
        .iter()
        .enumerate()
        .filter(|(_, p)| !p.usage.is_empty())
        .map(|(t, p)| TextureOutline {
            name: graph.textures[t].0.clone(),
            extent: p.extent,
            format: p.format.name,
            mips: p.mips,
            layers: p.layers,
            transient: p.transient,
            history: p.history,
            bytes: p.bytes(),
        });
    let buffers = plan
        .buffers
        .iter()
        .zip(&graph.buffers)
        .filter(|(p, _)| p.used)
        .map(|(p, b)| BufferOutline {
            name: b.0.clone(),
            transient: p.transient,
            history: p.history,
            bytes: p.bytes(),
        });
    let left_out = plan
        .dropped
        .iter()
        .map(|(pass, why)| (graph.pass_name(*pass).to_string(), why.clone()));
    Outline {
        schema: SCHEMA,
        graph: graph.name.clone(),
        params: params
            .names()
            .map(String::from)
            .zip(params.values.iter().cloned())
            .collect(),
        passes: passes.collect(),
        textures: textures.collect(),
        buffers: buffers.collect(),
        left_out: left_out.collect(),
    }
}
