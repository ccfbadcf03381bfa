//! Parameters of a graph's files, and their defaults.

use super::findings::Findings;
use crate::diagnostics::{Entries, Items, Loc, RawText};
use crate::graph::interface::SceneInterface;
use crate::graph::param::{Decl, OFF, Param};

/// Names that GLSL and expressions can use.
pub(super) fn is_identifier(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_lowercase())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        && !name.contains("__")
}

const IDENTIFIER: &str = "letters, digits and underscores, starting with a lower-case letter";

/// Parameters without mistakes. Names of the others are recorded as broken.
pub(super) fn declared(
    decls: &[Loc<Decl>],
    interface: &SceneInterface,
    found: &mut Findings,
) -> Vec<Param> {
    let mut list: Vec<Param> = Vec::new();
    for Loc { value: decl, at } in decls {
        let Loc {
            value: name,
            at: named_at,
        } = &decl.name;
        if !is_identifier(name) {
            let message = format!("'{name}' cannot be a parameter's name");
            found.help(*named_at, message, Some(IDENTIFIER.into()));
        } else if list.iter().any(|p| p.name == *name) {
            found.error(*named_at, format!("parameter '{name}' is declared twice"));
        } else if name == OFF {
            found.error(
                *named_at,
                format!("'{OFF}' is what passes are left out by: no parameter has that name"),
            );
        } else if interface.has_variable(name) {
            found.error(
                *named_at,
                format!("'{name}' is a variable that every graph has"),
            );
        } else {
            match &decl.param {
                Ok(param) => list.push(param.clone()),
                Err(message) => {
                    found.error(*at, message);
                    found.broken.push(name.clone());
                    found
                        .broken
                        .extend(decl.options.iter().map(|o| o.value.clone()));
                }
            }
        }
    }
    for options in decls.iter().map(|d| &d.value.options) {
        for (i, Loc { value: option, at }) in options.iter().enumerate() {
            if options[..i].iter().any(|o| o.value == *option) {
                found.error(*at, format!("option '{option}' stands twice"));
            } else if !is_identifier(option) {
                found.help(
                    *at,
                    format!("'{option}' cannot be an option's name"),
                    Some(IDENTIFIER.into()),
                );
            } else if list.iter().any(|p| p.name == *option) || interface.has_variable(option) {
                let has = "has the name of a parameter or variable, which expressions could not tell apart";
                found.error(*at, format!("option '{option}' {has}"));
            }
        }
    }
    list
}

/// Fixes parameters at their defaults.
pub(super) fn fix(list: &mut [Param], names: &Items<String>, found: &mut Findings) {
    for Loc { value: name, at } in &names.0 {
        match list.iter_mut().find(|p| p.name == *name) {
            Some(param) => param.fixed = true,
            None => {
                let message = format!("no parameter '{name}' to fix");
                found.unknown(*at, name, message, list.iter().map(|p| p.name.as_str()));
            }
        }
    }
}

/// Changes defaults, the later one last.
pub(super) fn set_defaults(list: &mut [Param], defaults: &Entries<RawText>, found: &mut Findings) {
    for (name, text) in &defaults.0 {
        match list.iter_mut().find(|p| p.name == name.value) {
            Some(param) => match param.parse(&text.value.0) {
                Ok(value) => param.default = value,
                Err(message) => found.error(text.at, format!("default of {message}")),
            },
            None => {
                let message = format!("no parameter '{}' to give a default to", name.value);
                found.unknown(
                    name.at,
                    &name.value,
                    message,
                    list.iter().map(|p| p.name.as_str()),
                );
            }
        }
    }
}
