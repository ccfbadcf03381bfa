//! Path-traced references: the pictures of `passes/reference.ron`, gathered progressively and
//! stored under a hash of their inputs.

mod gather;
mod goal;
mod key;
mod store;

pub use gather::Gathered;
pub(crate) use gather::Tracer;
pub use gather::gather;
pub use goal::{Goal, NoiseBound};
pub use key::GRAPH;
pub(crate) use key::experiment_for;

use crate::experiment::Experiment;
use crate::graph::Graph;
use crate::lab::{LabError, Workspace};
use crate::metrics::{Linear, Noise};
use crate::scene::Scene;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Default path length of references (bounces), enough for all light that matters.
pub const ALL_BOUNCES: u32 = 64;

/// A reference picture with its light components.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Width and height, pixels.
    pub size: (u32, u32),
    /// Samples per pixel.
    pub samples: u64,
    /// Light components by graph name.
    pub parts: BTreeMap<String, ReferencePart>,
    /// Folder of the reference.
    pub folder: PathBuf,
}

impl Reference {
    /// Memory of the pictures (bytes).
    pub fn bytes(&self) -> usize {
        let pictures = |p: &ReferencePart| if p.halves.is_some() { 3 } else { 1 };
        self.parts
            .values()
            .map(|p| pictures(p) * std::mem::size_of_val(&p.mean.rgb[..]))
            .sum()
    }
}

/// A light component of a reference.
#[derive(Clone, Debug)]
pub struct ReferencePart {
    /// Mean of all samples.
    pub mean: Linear,
    /// Noise of the reference itself.
    pub noise: Noise,
    /// Means of the even and the odd samples, if made by `Tracer::gather`; they need twice the
    /// memory again.
    pub halves: Option<[Linear; 2]>,
}

/// Hash of the reference graph's shaders, 64 hexadecimal digits.
pub fn shaders(home: &Workspace) -> Result<String, LabError> {
    let loaded = home.load(GRAPH).map_err(LabError::Input)?;
    Ok(key::shaders(&loaded))
}

/// The reference of an experiment with this number of bounces, if it has been gathered. `scene` has
/// the experiment's lighting.
pub fn find(
    home: &Workspace,
    experiment: &Experiment,
    scene: &Arc<Scene>,
    bounces: u32,
) -> Result<Option<Reference>, LabError> {
    let traced = experiment_for(home, experiment, bounces)?;
    let loaded = home.load(&traced.graph).map_err(LabError::Input)?;
    let key = key::key(&traced, &loaded, scene)?;
    read(
        &home.captures.join("reference").join(&key),
        traced.size,
        &loaded.graph,
    )
}

/// The reference in a folder, if its sums exist.
///
/// # Errors
/// Files that are damaged, or of another size or graph.
pub fn read(folder: &Path, size: (u32, u32), graph: &Graph) -> Result<Option<Reference>, LabError> {
    let sums = store::read(folder, size, graph)?;
    sums.map(|sums| sums.reference(graph, folder, false))
        .transpose()
}
