//! The inputs of a reference, as an experiment and as a hash.

use crate::experiment::Experiment;
use crate::files::{content_id, hex};
use crate::graph::param::{Param, Params};
use crate::lab::{LabError, Loaded, Workspace, camera_of, params_of};
use crate::results::capture::scene_hash;
use crate::scene::Scene;
use sha2::{Digest, Sha256};
use std::sync::Arc;

/// The graph that traces references.
pub const GRAPH: &str = "reference.ron";

/// Parameters that select samples without changing the expected value.
const WHICH_SAMPLES: [&str; 2] = ["samples", "first_sample"];

/// Group of the parameters that affect only the display-encoded picture.
const DISPLAY: &str = "Display";

/// The reference experiment of another one: the same scene, camera, size and time under [`GRAPH`].
/// Parameters that both graphs share keep their values, because the material model defines the
/// expected result.
///
/// # Errors
/// A graph that cannot be read; a value that the reference graph does not accept.
pub fn experiment_for(
    home: &Workspace,
    experiment: &Experiment,
    bounces: u32,
) -> Result<Experiment, LabError> {
    traced_by(
        &home.load(GRAPH).map_err(LabError::Input)?,
        experiment,
        bounces,
    )
}

/// [`experiment_for`] with a loaded reference graph.
pub(super) fn traced_by(
    loaded: &Loaded,
    experiment: &Experiment,
    bounces: u32,
) -> Result<Experiment, LabError> {
    let graph = &loaded.graph;
    let mut traced = experiment.clone();
    traced.graph = GRAPH.into();
    traced
        .params
        .retain(|(name, _)| graph.params.index(&name.value).is_some());
    traced.params.retain(|(name, _)| {
        name.value != "bounces" && !WHICH_SAMPLES.contains(&name.value.as_str())
    });
    traced.set("bounces", &bounces.to_string());
    // Reports errors now, with their position.
    params_of(graph, &traced)?;
    Ok(traced)
}

/// SHA-256 of the compiled shaders of all passes, hexadecimal.
pub(super) fn shaders(loaded: &Loaded) -> String {
    let mut hash = Sha256::new();
    for stage in loaded.linked.iter().flat_map(|link| &link.stages) {
        hash.update(bytemuck::cast_slice::<u32, u8>(&stage.words));
    }
    hex(&hash.finalize())
}

/// 16 hexadecimal digits of a hash over all inputs of the samples of an experiment of [`GRAPH`]:
/// compiled shaders, scene content, camera, size, time, parameters, and definitions of values.
pub(super) fn key(
    traced: &Experiment,
    loaded: &Loaded,
    scene: &Arc<Scene>,
) -> Result<String, LabError> {
    let mut parts: Vec<Vec<u8>> = Vec::new();
    for (number, pass) in loaded.graph.declared_passes() {
        parts.push(pass.name.value.clone().into());
        let stages = loaded
            .linked
            .get(number)
            .into_iter()
            .flat_map(|l| &l.stages);
        parts.extend(stages.map(|s| bytemuck::cast_slice(&s.words).to_vec()));
    }
    parts.push(scene_hash(scene).into());
    parts.push(format!("{:?}", camera_of(traced, scene)?).into());
    parts.push(format!("{:?} {:?}", traced.size, traced.time).into());
    let params: Params = params_of(&loaded.graph, traced)?;
    let sampled = |p: &Param| p.group != DISPLAY && !WHICH_SAMPLES.contains(&p.name.as_str());
    let values = params
        .list
        .iter()
        .zip(&params.values)
        .filter(|(p, _)| sampled(p));
    parts.extend(values.map(|(p, value)| format!("{} {value:?}", p.name).into()));
    let named = loaded.graph.values.iter();
    parts.extend(named.map(|named| format!("{} {}", named.name, named.expr.value.text).into()));
    Ok(content_id(parts, 16))
}
