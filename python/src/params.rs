//! Parameters of a graph as JSON.

use conelab::graph::param::{Kind, Param, Params, Value};
use serde_json::json;

/// The declarations with their present values, in the order of the graph. `fixed` ones are left out.
pub fn json(params: &Params) -> String {
    let all = params.list.iter().zip(&params.values);
    let all = all.filter(|(p, _)| !p.fixed).map(|(p, v)| entry(p, v));
    serde_json::Value::from_iter(all).to_string()
}

fn entry(p: &Param, value: &Value) -> serde_json::Value {
    let kind = match &p.kind {
        Kind::Bool => "bool",
        Kind::Int => "int",
        Kind::Float => "float",
        Kind::Vector(2) => "vec2",
        Kind::Vector(3) => "vec3",
        Kind::Vector(_) => "vec4",
        Kind::Colour => "colour",
        Kind::Choice(_) => "choice",
    };
    json!({
        "name": p.name, "kind": kind, "value": value, "default": p.default, "range": p.range, "step": p.step,
        "unit": p.unit, "group": p.group, "help": p.help, "options": p.kind.options(), "option_help": p.option_help,
        "compiled": p.is_compiled(),
    })
}
