//! Edits of a side's parameters.

use super::request::SideRequest;
use crate::graph::param::{Param, Value};

/// A parameter's value in a side: as set, else the default.
pub fn value(side: &SideRequest, param: &Param) -> Value {
    let mut set = side.params.iter().rev();
    set.find(|(name, _)| *name == param.name)
        .and_then(|(_, value)| param.fit(value))
        .unwrap_or_else(|| param.default.clone())
}

/// Sets a parameter of a side; values at the default are not kept.
pub fn set(side: &mut SideRequest, param: &Param, value: &Value) {
    let set = (*value != param.default).then(|| value.clone());
    put(side, &param.name, set);
}

/// Sets a value of a side, or removes it.
pub fn put(side: &mut SideRequest, name: &str, value: Option<Value>) {
    let place = side.params.iter().position(|(known, _)| known == name);
    match (place, value) {
        (Some(i), Some(value)) => side.params[i].1 = value,
        (Some(i), None) => drop(side.params.remove(i)),
        (None, Some(value)) => side.params.push((name.into(), value)),
        (None, None) => {}
    }
}
