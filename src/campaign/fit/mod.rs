//! The cheapest setting that stays within a bound: a search over a few values of a few parameters.

mod evaluate;
mod model;
mod search;

pub use evaluate::{Evaluator, Goal, Metric, Subject};
pub use search::{Found, Limits, Step, Stop, Trial, search};

use crate::experiment::Experiment;
use crate::graph::Graph;
use crate::graph::param::Params;
use crate::lab::LabError;

/// A parameter that may be varied, and the values to choose from in the order in which neighbours are alike.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The parameter.
    pub name: String,
    /// Values as RON, at least one.
    pub values: Vec<String>,
}

/// The axes that a graph declares in `fit`, replaced and joined by `given`.
///
/// # Errors
/// An unknown parameter, a value that it does not take.
pub fn axes(graph: &Graph, given: &[Axis]) -> Result<Vec<Axis>, LabError> {
    let mut axes: Vec<Axis> = Vec::new();
    if given.is_empty() {
        axes.extend(graph.fit.iter().map(|(name, values)| Axis { name: name.clone(), values: values.clone() }));
    }
    axes.extend_from_slice(given);
    if axes.is_empty() {
        let message = format!("graph '{}' has no `fit`: say what to vary with --vary NAME=VALUE,VALUE", graph.name);
        return Err(LabError::Request(message));
    }
    for axis in &axes {
        let mut params = graph.params.clone();
        for value in &axis.values {
            params.set(&axis.name, value).map_err(LabError::Request)?;
        }
    }
    Ok(axes)
}

/// The place on the axes nearest to an experiment's own values; the first of an axis where there is no nearest.
pub fn start(axes: &[Axis], params: &Params) -> Vec<usize> {
    let place = |axis: &Axis| {
        let own = params.get(&axis.name)?;
        let distance = |text: &String| {
            let mut tried = params.clone();
            tried.set(&axis.name, text).ok()?;
            let value = &tried.values[tried.index(&axis.name)?];
            if value == own { Some(0.0) } else { Some((value.number()? - own.number()?).abs()) }
        };
        let near = axis.values.iter().enumerate().filter_map(|(i, v)| Some((i, distance(v)?)));
        near.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(i, _)| i)
    };
    axes.iter().map(|axis| place(axis).unwrap_or(0)).collect()
}

/// The experiment with the values of a place on the axes.
pub fn at(experiment: &Experiment, axes: &[Axis], place: &[usize]) -> Experiment {
    let mut experiment = experiment.clone();
    for (axis, i) in axes.iter().zip(place) {
        experiment.set(&axis.name, &axis.values[*i]);
    }
    experiment
}
