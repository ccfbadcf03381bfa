//! What the user edits: parameters of a slot.

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

/// A parameter's value in a slot: what is set, else the default.
pub fn value(slot: &SideRequest, param: &Param) -> Value {
    let set = slot.params.iter().rev().find(|(name, _)| *name == param.name);
    set.and_then(|(_, text)| param.parse(text).ok()).unwrap_or_else(|| param.default.clone())
}

/// Sets a parameter of a slot; values at the default are not kept.
pub fn set(slot: &mut SideRequest, param: &Param, value: &Value) {
    let place = slot.params.iter().position(|(name, _)| *name == param.name);
    let at_default = *value == param.default;
    match (place, at_default) {
        (Some(i), true) => drop(slot.params.remove(i)),
        (Some(i), false) => slot.params[i].1 = to_ron(value),
        (None, true) => {}
        (None, false) => slot.params.push((param.name.clone(), to_ron(value))),
    }
}
