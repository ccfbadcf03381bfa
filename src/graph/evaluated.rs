//! A graph with a value for all that its expressions read.

use super::definition::{Graph, Named};
use super::expr::{Env, Var};
use super::param::{Param, Params, Value};
use crate::diagnostics::Diagnostic;
use std::collections::BTreeMap;

/// A graph with its parameters set, in a scene, at a size, on a device.
#[derive(Clone, Debug)]
pub struct Evaluated<'g> {
    /// The graph.
    pub graph: &'g Graph,
    /// Values of its parameters.
    pub params: &'g Params,
    /// Variables of expressions: the parameters, the named values, and those of scene, size and
    /// device.
    pub env: Env,
    /// The named values, in the graph's order; 0 where one has no value.
    pub values: Vec<Value>,
    /// Errors of values. A value that depends on one with an error is not reported again.
    pub errors: Vec<Diagnostic>,
}

impl<'g> Evaluated<'g> {
    /// With these parameters; `env` has the variables of scene, size and device.
    pub fn new(graph: &'g Graph, params: &'g Params, mut env: Env) -> Evaluated<'g> {
        params.fill(&mut env);
        let (mut errors, mut values) = (Vec::new(), Vec::new());
        let mut lost: Vec<&Named> = Vec::new();
        for named in &graph.values {
            match named.number(&env) {
                Ok(number) => {
                    env.insert(named.name.clone(), Var::Number(number));
                    values.push(named.value(number));
                }
                Err(why) => {
                    if !lost.iter().any(|l| named.reads(&l.name)) {
                        let message =
                            format!("value '{}', '{}': {why}", named.name, named.expr.value.text);
                        errors.push(graph.sources.error(named.expr.at, message));
                    }
                    lost.push(named);
                    values.push(named.value(0.0));
                }
            }
        }
        Evaluated {
            graph,
            params,
            env,
            values,
            errors,
        }
    }

    /// The options that `auto` stands for, by choice.
    pub fn chosen(&self) -> BTreeMap<String, String> {
        let option = |(param, value): (&Param, &Value)| match value {
            Value::Choice(option) if param.is_auto(value) => Some((
                param.name.clone(),
                param.resolved(option, &self.env).to_string(),
            )),
            _ => None,
        };
        let params = self.params.list.iter().zip(&self.params.values);
        params.filter_map(option).collect()
    }
}
