//! Parameters with a plain value that the experiment does not have.

use crate::diagnostics::nearest;
use crate::graph::param::{Param, Params, Value};
use crate::lab::LabError;

/// A parameter at its plain value.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Name of the parameter.
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

/// Changes to the experiment's parameters, in the graph's order. `only` restricts them to these
/// names if it has any.
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

/// Whether the experiment's value lies beyond the plain one, as seen from the default. Example: 64
/// if 160 is the default and 128 is plain.
fn is_plainer(param: &Param, value: &Value, plain: &Value) -> bool {
    let (Some(value), Some(plain), Some(usual)) =
        (value.number(), plain.number(), param.declared.number())
    else {
        return false;
    };
    (value - plain) * (usual - plain) < 0.0
}
