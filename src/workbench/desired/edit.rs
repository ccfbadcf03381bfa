//! Edits of a side's parameters.

use super::request::SideRequest;
use crate::graph::param::{OFF, Param, Params, Value};

/// The parameters that differ from their defaults.
pub fn changed(params: &Params) -> Vec<(String, String)> {
    let pairs = params.list.iter().zip(&params.values);
    pairs
        .filter(|(p, v)| p.default != **v)
        .map(|(p, v)| (p.name.clone(), v.to_ron()))
        .collect()
}

/// A parameter's value in a side: as set, else the default.
pub fn value(side: &SideRequest, param: &Param) -> Value {
    let set = side
        .params
        .iter()
        .rev()
        .find(|(name, _)| *name == param.name);
    set.and_then(|(_, text)| param.parse(text).ok())
        .unwrap_or_else(|| param.default.clone())
}

/// The passes that a side leaves out.
pub fn off(side: &SideRequest, params: &Params) -> Vec<String> {
    let Some((_, text)) = side.params.iter().rev().find(|(name, _)| name == OFF) else {
        return Vec::new();
    };
    let mut params = params.clone();
    params.off.clear();
    // The build reports passes that the graph no longer has.
    let _ = params.set(OFF, text);
    params.off
}

/// Leaves out these passes of a side and no others.
pub fn set_off(side: &mut SideRequest, off: &[String]) {
    side.params.retain(|(name, _)| name != OFF);
    if !off.is_empty() {
        side.params.push((OFF.into(), format!("{off:?}")));
    }
}

/// Sets a parameter of a side; values at the default are not kept.
pub fn set(side: &mut SideRequest, param: &Param, value: &Value) {
    let place = side.params.iter().position(|(name, _)| *name == param.name);
    let at_default = *value == param.default;
    match (place, at_default) {
        (Some(i), true) => drop(side.params.remove(i)),
        (Some(i), false) => side.params[i].1 = value.to_ron(),
        (None, true) => {}
        (None, false) => side.params.push((param.name.clone(), value.to_ron())),
    }
}
