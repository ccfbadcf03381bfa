//! Named values: expressions that a graph declares once, for its other expressions and for shaders. Nobody sets them.

use super::expr::{Env, Var};
use super::file::{Ex, ValueDecl};
use super::load::{BUILTIN_VARIABLES, Graph, is_identifier};
use super::param::{Params, Value};
use crate::diagnostics::{At, Diagnostic, Loc, Sources};
use std::fmt::Write;

/// A named value.
#[derive(Clone, Debug)]
pub struct Named {
    /// Name in expressions and shaders.
    pub name: String,
    /// Where it is declared.
    pub at: At,
    /// Whether it is an integer, rounded down; else it is a float.
    pub whole: bool,
    /// What it is.
    pub expr: Ex,
}

/// The declared values, each after those that it reads. Names of those that are left out for a mistake go to `broken`.
pub(super) fn ordered(
    decls: Vec<(Loc<String>, Loc<ValueDecl>)>,
    params: &Params,
    sources: &Sources,
    errors: &mut Vec<Diagnostic>,
    broken: &mut Vec<String>,
) -> Vec<Named> {
    let mut open: Vec<Named> = Vec::new();
    for (name, decl) in decls {
        let (whole, expr) = match decl.value {
            ValueDecl::Float(ex) => (false, ex),
            ValueDecl::Int(ex) => (true, ex),
        };
        let named = Named { name: name.value, at: name.at, whole, expr };
        if let Some(message) = name_mistake(&named.name, params, &open) {
            errors.push(sources.error(named.at, message));
            broken.push(named.name);
        } else {
            open.push(named);
        }
    }
    let mut done: Vec<Named> = Vec::new();
    while !open.is_empty() {
        let ready = |v: &Named| !open.iter().any(|o| reads(v, &o.name));
        let (now, later): (Vec<Named>, Vec<Named>) = open.iter().cloned().partition(ready);
        if now.is_empty() {
            // All that is left reads something that is left: each is in a circle or needs one.
            for value in &later {
                errors.extend(circle(value, &later).map(|names| {
                    let way = if names.len() > 2 { format!(": {}", names.join(" needs ")) } else { String::new() };
                    sources.error(value.expr.at, format!("value '{}' needs itself{way}", value.name))
                }));
                broken.push(value.name.clone());
            }
            break;
        }
        done.extend(now);
        open = later;
    }
    done
}

fn reads(value: &Named, name: &str) -> bool {
    value.expr.value.variables().iter().any(|v| v == name)
}

fn name_mistake(name: &str, params: &Params, others: &[Named]) -> Option<String> {
    if !is_identifier(name) {
        return Some(format!(
            "'{name}' cannot be a value's name: letters, digits and underscores, starting with a lower-case letter"
        ));
    }
    let component = |p: &str| name.strip_prefix(p).is_some_and(|rest| ["_x", "_y", "_z", "_w"].contains(&rest));
    if params.index(name).is_some() || params.list.iter().any(|p| p.kind.components() > 0 && component(&p.name)) {
        return Some(format!("value '{name}' has the name of a parameter"));
    }
    if params.option_names().any(|o| o == name) {
        return Some(format!("value '{name}' has the name of an option, which expressions could not tell apart"));
    }
    if BUILTIN_VARIABLES.contains(&name) {
        return Some(format!("'{name}' is a variable that every graph has"));
    }
    others.iter().any(|o| o.name == name).then(|| format!("value '{name}' is declared twice"))
}

/// The shortest way from a value back to itself.
fn circle(value: &Named, all: &[Named]) -> Option<Vec<String>> {
    let mut ways = vec![vec![value]];
    let mut seen: Vec<&str> = Vec::new();
    while !ways.is_empty() {
        let mut longer = Vec::new();
        for way in ways {
            let Some(last) = way.last() else { continue };
            if reads(last, &value.name) {
                return Some(way.iter().map(|v| &v.name).chain([&value.name]).map(|n| format!("'{n}'")).collect());
            }
            for next in all.iter().filter(|v| reads(last, &v.name)) {
                if !seen.contains(&next.name.as_str()) {
                    seen.push(&next.name);
                    longer.push([&way[..], &[next]].concat());
                }
            }
        }
        ways = longer;
    }
    None
}

/// Adds the parameters and the named values to the variables of expressions; `env` has size and scene. The values come
/// back in the graph's order.
///
/// # Errors
/// Those without a value, and why. One that reads such a one is not told again; in their place stands 0.
pub fn fill(graph: &Graph, params: &Params, env: &mut Env) -> (Vec<Value>, Vec<Diagnostic>) {
    params.fill(env);
    let mut errors = Vec::new();
    let mut lost: Vec<&Named> = Vec::new();
    let mut values = Vec::new();
    for named in &graph.values {
        let value = evaluate(named, env).unwrap_or_else(|why| {
            if !lost.iter().any(|l| reads(named, &l.name)) {
                let message = format!("value '{}', '{}': {why}", named.name, named.expr.value.text);
                errors.push(graph.sources.error(named.expr.at, message));
            }
            lost.push(named);
            if named.whole { Value::Int(0) } else { Value::Float(0.0) }
        });
        if lost.last().is_none_or(|l| l.name != named.name) {
            let number = match value {
                Value::Int(v) => v as f64,
                Value::Float(v) => v,
                _ => continue,
            };
            env.insert(named.name.clone(), Var::Number(number));
        }
        values.push(value);
    }
    (values, errors)
}

fn evaluate(named: &Named, env: &Env) -> Result<Value, String> {
    let value = named.expr.value.eval(env)?;
    if !named.whole {
        return Ok(Value::Float(value));
    }
    let rounded = (value + 1e-9).floor();
    if rounded.abs() > f64::from(i32::MAX) {
        return Err(format!("{value} does not fit 32 bits"));
    }
    Ok(Value::Int(rounded as i64))
}

/// Their members in the uniform block of parameters.
pub(super) fn members(values: &[Named]) -> String {
    let mut text = String::new();
    for value in values {
        let _ = writeln!(text, "    {} {};", if value.whole { "int" } else { "float" }, value.name);
    }
    text
}
