//! What the user edits: parameters of a side.

use super::request::SideRequest;
use crate::graph::param::{Param, Params, Value};

/// A value as RON, as experiments write it.
pub fn to_ron(value: &Value) -> String {
    match value {
        Value::Choice(name) => format!("\"{name}\""),
        other => other.to_string(),
    }
}

/// The parameters that differ from their defaults.
pub fn changed(params: &Params) -> Vec<(String, String)> {
    let pairs = params.list.iter().zip(&params.values);
    pairs.filter(|(p, v)| p.default != **v).map(|(p, v)| (p.name.clone(), to_ron(v))).collect()
}

/// A parameter's value in a side: what is set, else the default.
pub fn value(side: &SideRequest, param: &Param) -> Value {
    let set = side.params.iter().rev().find(|(name, _)| *name == param.name);
    set.and_then(|(_, text)| param.parse(text).ok()).unwrap_or_else(|| param.default.clone())
}

/// Sets a parameter of a side; values at the default are not kept.
pub fn set(side: &mut SideRequest, param: &Param, value: &Value) {
    let place = side.params.iter().position(|(name, _)| *name == param.name);
    let at_default = *value == param.default;
    match (place, at_default) {
        (Some(i), true) => drop(side.params.remove(i)),
        (Some(i), false) => side.params[i].1 = to_ron(value),
        (None, true) => {}
        (None, false) => side.params.push((param.name.clone(), to_ron(value))),
    }
}
