//! Named values of a graph's files, in an order in which they can be evaluated.

use super::findings::Findings;
use super::params::is_identifier;
use crate::diagnostics::Loc;
use crate::graph::definition::Named;
use crate::graph::expr::Expr;
use crate::graph::file::ValueDecl;
use crate::graph::interface::SceneInterface;
use crate::graph::param::Params;

/// The declared values, each after those that it reads. Names of those that are left out for a
/// mistake go to `broken`.
pub(super) fn ordered(
    decls: Vec<(Loc<String>, Loc<ValueDecl>)>,
    params: &Params,
    interface: &SceneInterface,
    found: &mut Findings,
) -> Vec<Named> {
    let mut open: Vec<Named> = Vec::new();
    for (name, decl) in decls {
        let (whole, expr, signs) = match decl.value {
            ValueDecl::Float(ex) => (false, ex, None),
            ValueDecl::Int(ex) => (true, ex, None),
            ValueDecl::Signature(stage) => (
                true,
                Loc {
                    value: Expr::new("0"),
                    at: stage.at,
                },
                Some(stage.value),
            ),
        };
        let named = Named {
            name: name.value,
            at: name.at,
            whole,
            expr,
            signs,
        };
        if let Some(message) = name_mistake(&named.name, params, interface, &open) {
            found.error(named.at, message);
            found.broken.push(named.name);
        } else {
            open.push(named);
        }
    }
    let mut done: Vec<Named> = Vec::new();
    while !open.is_empty() {
        let ready = |v: &Named| !open.iter().any(|o| v.reads(&o.name));
        let (now, later): (Vec<Named>, Vec<Named>) = open.iter().cloned().partition(ready);
        if now.is_empty() {
            // All that is left reads something that is left: each is in a circle or needs one.
            for value in &later {
                if let Some(names) = circle(value, &later) {
                    let mut message = format!("value '{}' needs itself", value.name);
                    if names.len() > 2 {
                        message += &format!(": {}", names.join(" needs "));
                    }
                    found.error(value.expr.at, message);
                }
                found.broken.push(value.name.clone());
            }
            break;
        }
        done.extend(now);
        open = later;
    }
    done
}

fn name_mistake(
    name: &str,
    params: &Params,
    interface: &SceneInterface,
    others: &[Named],
) -> Option<String> {
    if !is_identifier(name) {
        return Some(format!(
            "'{name}' cannot be a value's name: letters, digits and underscores, starting with a lower-case letter"
        ));
    }
    if params
        .list
        .iter()
        .any(|p| p.name == name || p.variables().iter().any(|v| v == name))
    {
        return Some(format!("value '{name}' has the name of a parameter"));
    }
    if params.option_names().any(|o| o == name) {
        return Some(format!(
            "value '{name}' has the name of an option, which expressions could not tell apart"
        ));
    }
    if interface.has_variable(name) {
        return Some(format!("'{name}' is a variable that every graph has"));
    }
    others
        .iter()
        .any(|o| o.name == name)
        .then(|| format!("value '{name}' is declared twice"))
}

/// The shortest way from a value back to itself.
fn circle(value: &Named, all: &[Named]) -> Option<Vec<String>> {
    let mut ways = vec![vec![value]];
    let mut seen: Vec<&str> = Vec::new();
    while !ways.is_empty() {
        let mut longer = Vec::new();
        for way in ways {
            let Some(last) = way.last() else { continue };
            if last.reads(&value.name) {
                return Some(
                    way.iter()
                        .map(|v| &v.name)
                        .chain([&value.name])
                        .map(|n| format!("'{n}'"))
                        .collect(),
                );
            }
            for next in all.iter().filter(|v| last.reads(&v.name)) {
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
