//! The cheapest setting that stays within a bound: a search over a few values of a few parameters.

mod run;
mod search;

pub use run::{Fitted, Goal, Request, run};
pub use search::{Found, Limits, Step, Stop, Trial, search};

use crate::campaign::settings::Axis;
use crate::experiment::Experiment;
use crate::graph::Graph;
use crate::graph::param::Params;
use crate::lab::LabError;

/// The axes that a graph declares in `fit`, neighbours among their values alike, or those that are given.
///
/// # Errors
/// An unknown parameter, a value that it does not take.
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

/// The place on the axes nearest to an experiment's own values; the first of an axis where there is no nearest.
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

/// The experiment with the values of a place on the axes.
fn at(experiment: &Experiment, axes: &[Axis], place: &[usize]) -> Experiment {
    let mut experiment = experiment.clone();
    for ((name, values), i) in axes.iter().zip(place) {
        experiment.set(name, &values[*i]);
    }
    experiment
}
