//! Search for the cheapest setting within a bound, over a few values of a few parameters.

mod run;
mod search;

pub use run::{Fitted, Goal, LEAST_GAIN, Request, run};
pub use search::Found;
pub use search::{Limits, Stop, Trial, search};

use crate::campaign::settings::Axis;
use crate::experiment::Experiment;
use crate::graph::Graph;
use crate::graph::param::Params;
use crate::lab::LabError;

/// The given axes, or those that a graph declares in `fit`. Neighbouring values should be alike.
pub fn axes(graph: &Graph, given: &[Axis]) -> Result<Vec<Axis>, LabError> {
    let axes = if given.is_empty() {
        graph.fit.clone()
    } else {
        given.to_vec()
    };
    if axes.is_empty() {
        let message = format!(
            "graph '{}' has no `fit`: say what to vary with --vary NAME=VALUE,VALUE",
            graph.name
        );
        return Err(LabError::Request(message));
    }
    for (name, values) in &axes {
        let mut params = graph.params.clone();
        for value in values {
            params.set(name, value).map_err(LabError::Request)?;
        }
    }
    Ok(axes)
}

/// Indices of the values nearest to the experiment's own ones; 0 on axes without a nearest.
fn start(axes: &[Axis], params: &Params) -> Vec<usize> {
    let place = |(name, values): &Axis| {
        let own = params.get(name)?;
        let distance = |text: &String| {
            let mut tried = params.clone();
            tried.set(name, text).ok()?;
            let value = &tried.values[tried.index(name)?];
            if value == own {
                Some(0.0)
            } else {
                Some((value.number()? - own.number()?).abs())
            }
        };
        let near = values
            .iter()
            .enumerate()
            .filter_map(|(i, v)| Some((i, distance(v)?)));
        near.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(i, _)| i)
    };
    axes.iter().map(|axis| place(axis).unwrap_or(0)).collect()
}

/// The experiment with the values at these indices.
fn at(experiment: &Experiment, axes: &[Axis], place: &[usize]) -> Experiment {
    let mut experiment = experiment.clone();
    for ((name, values), i) in axes.iter().zip(place) {
        experiment.set(name, &values[*i]);
    }
    experiment
}
