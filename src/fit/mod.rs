//! The cheapest setting that stays within a bound: a search over a few values of a few parameters.

mod evaluate;
mod search;

pub use evaluate::{Evaluator, Goal, Metric, Subject};
pub use search::{Found, Limits, Step, Stop, Trial, search};

use crate::experiment::Experiment;
use crate::graph::load::Graph;
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

/// The place on the axes nearest to an experiment's own values: those that an axis does not have begin at its first.
pub fn start(axes: &[Axis], params: &Params) -> Vec<usize> {
    let place = |axis: &Axis| {
        let own = params.index(&axis.name).map(|i| &params.values[i]);
        let same = |text: &String| {
            let mut tried = params.clone();
            tried.set(&axis.name, text).is_ok() && tried.index(&axis.name).map(|i| &tried.values[i]) == own
        };
        axis.values.iter().position(same).unwrap_or(0)
    };
    axes.iter().map(place).collect()
}

/// The experiment with the values of a place on the axes.
pub fn at(experiment: &Experiment, axes: &[Axis], place: &[usize]) -> Experiment {
    let mut experiment = experiment.clone();
    for (axis, i) in axes.iter().zip(place) {
        experiment.set(&axis.name, &axis.values[*i]);
    }
    experiment
}
