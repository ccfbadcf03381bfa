//! Which parameters have a plain value that the experiment does not have already.

use crate::diagnostics::nearest;
use crate::graph::param::{Param, Params, Value};
use crate::lab::LabError;

/// A parameter at its plain value.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// The parameter.
    pub name: String,
    /// Its value in the experiment.
    pub from: Value,
    /// Its plain value.
    pub to: Value,
}

impl Change {
    /// The setting, `NAME=VALUE`.
    pub fn setting(&self) -> String {
        format!("{}={}", self.name, self.to)
    }
}

/// The changes that an experiment's parameters offer, in the graph's order; of these names alone where there are any.
///
/// # Errors
/// A name that is no parameter, or offers no change; no change at all.
pub fn changes(params: &Params, only: &[String]) -> Result<Vec<Change>, LabError> {
    let all: Vec<Change> = params
        .list
        .iter()
        .zip(&params.values)
        .filter_map(|(p, v)| change(p, v))
        .collect();
    for name in only {
        if all.iter().any(|c| c.name == *name) {
            continue;
        }
        return Err(LabError::Request(
            match params.param(name).map(|p| &p.plain) {
                Some(Some(plain)) => {
                    format!("'{name}' is at its plain value ({plain}) already, or plainer")
                }
                Some(None) => format!("'{name}' has no plain value in its graph"),
                None => {
                    let hint = nearest(name, params.list.iter().map(|p| p.name.as_str()));
                    format!(
                        "no parameter '{name}'{}",
                        hint.map_or(String::new(), |h| format!(" ({h})"))
                    )
                }
            },
        ));
    }
    let chosen: Vec<Change> = all
        .into_iter()
        .filter(|c| only.is_empty() || only.contains(&c.name))
        .collect();
    if chosen.is_empty() {
        return Err(LabError::Request(
            "no parameter has a plain value that the experiment does not have".into(),
        ));
    }
    Ok(chosen)
}

fn change(param: &Param, value: &Value) -> Option<Change> {
    let worth =
        |plain: &&Value| !param.fixed && *plain != value && !is_plainer(param, value, plain);
    let plain = param.plain.as_ref().filter(worth)?;
    Some(Change {
        name: param.name.clone(),
        from: value.clone(),
        to: plain.clone(),
    })
}

/// Whether a number lies beyond the plain one, seen from the default where the parameter is declared: a grid of 64 where
/// 160 is usual and 128 plain.
fn is_plainer(param: &Param, value: &Value, plain: &Value) -> bool {
    let (Some(value), Some(plain), Some(usual)) =
        (value.number(), plain.number(), param.declared.number())
    else {
        return false;
    };
    (value - plain) * (usual - plain) < 0.0
}
