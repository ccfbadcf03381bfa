//! Which parameters have a plain value that the experiment does not have already.

use crate::graph::param::{Param, Params, Value};
use crate::graph::source::nearest;
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
    let all: Vec<Change> = params.list.iter().zip(&params.values).filter_map(|(p, v)| change(p, v)).collect();
    for name in only {
        if all.iter().any(|c| c.name == *name) {
            continue;
        }
        return Err(LabError::Request(match params.index(name).map(|i| &params.list[i].plain) {
            Some(Some(plain)) => format!("'{name}' is at its plain value ({plain}) already, or plainer"),
            Some(None) => format!("'{name}' has no plain value in its graph"),
            None => {
                let hint = nearest(name, params.list.iter().map(|p| p.name.as_str()));
                format!("no parameter '{name}'{}", hint.map_or(String::new(), |h| format!(" ({h})")))
            }
        }));
    }
    let chosen: Vec<Change> = all.into_iter().filter(|c| only.is_empty() || only.contains(&c.name)).collect();
    if chosen.is_empty() {
        return Err(LabError::Request("no parameter has a plain value that the experiment does not have".into()));
    }
    Ok(chosen)
}

fn change(param: &Param, value: &Value) -> Option<Change> {
    let plain = param.plain.as_ref().filter(|plain| *plain != value && !is_plainer(param, value, plain))?;
    Some(Change { name: param.name.clone(), from: value.clone(), to: plain.clone() })
}

/// Whether a number lies beyond the plain one, seen from the default where the parameter is declared: a grid of 64 where
/// 160 is usual and 128 plain.
fn is_plainer(param: &Param, value: &Value, plain: &Value) -> bool {
    let (Some(value), Some(plain), Some(usual)) = (value.number(), plain.number(), param.declared.number()) else {
        return false;
    };
    (value - plain) * (usual - plain) < 0.0
}

#[cfg(test)]
mod tests {
    use super::changes;
    use crate::graph::param::{Decl, Params, Value};

    fn params(decls: &[&str]) -> Params {
        let param = |d: &&str| crate::graph::source::options().from_str::<Decl>(d).unwrap().param().unwrap();
        Params::new(decls.iter().map(param).collect())
    }

    #[test]
    fn what_is_plain_already_or_plainer_is_left_out() {
        let mut params = params(&[
            r#"Int(name: "grid", default: 160, plain: 128, help: "h")"#,
            r#"Float(name: "step", default: 1.0, plain: 1.5, help: "h")"#,
            r#"Float(name: "shift", default: 0.0, plain: 0.0, help: "h")"#,
            r#"Bool(name: "turn", default: false, plain: false, help: "h")"#,
            r#"Choice(name: "filter", options: ["wide", "near"], plain: "near", help: "h")"#,
            r#"Int(name: "count", default: 3, help: "h")"#,
        ]);
        let named =
            |params: &_| -> Vec<String> { changes(params, &[]).unwrap().iter().map(super::Change::setting).collect() };
        assert_eq!(named(&params), ["grid=128", "step=1.5", "filter=near"]);
        for (name, value) in [("grid", "64"), ("step", "2.0"), ("shift", "-1.0"), ("turn", "true"), ("filter", "near")]
        {
            params.set(name, value).unwrap();
        }
        assert_eq!(named(&params), ["shift=0.0", "turn=false"]);
        // A graph whose own default is plainer than what is declared.
        let grid = params.index("grid").unwrap();
        (params.list[grid].default, params.values[grid]) = (Value::Int(32), Value::Int(32));
        assert_eq!(named(&params), ["shift=0.0", "turn=false"]);
        assert!(changes(&params, &["grid".into()]).unwrap_err().to_string().contains("plain value (128) already"));
        assert!(changes(&params, &["count".into()]).unwrap_err().to_string().contains("has no plain value"));
    }
}
