//! Declarations of parameters in a graph file.

use super::kinds::{AUTO, Fastest, Kind, Param, Value};
use crate::diagnostics::{Entries, Loc};
use crate::graph::expr::Ex;
use serde::Deserialize;

/// A declaration, read.
#[derive(Clone, Debug, Deserialize)]
#[serde(from = "Kinds")]
pub struct Decl {
    /// The parameter's name, with its place.
    pub name: Loc<String>,
    /// The options of a choice or a module, with their places.
    pub options: Vec<Loc<String>>,
    /// The parameter, or its mistake.
    pub param: Result<Param, String>,
}

/// The words that a declaration begins with.
#[derive(Deserialize)]
enum Kinds {
    /// true or false.
    Bool(Fields<bool>),
    /// A whole number.
    Int(Fields<i64>),
    /// A number.
    Float(Fields<f64>),
    /// Two numbers.
    Vec2(Fields<(f64, f64)>),
    /// Three numbers.
    Vec3(Fields<(f64, f64, f64)>),
    /// Four numbers.
    Vec4(Fields<(f64, f64, f64, f64)>),
    /// Linear RGB.
    Colour(Fields<(f64, f64, f64)>),
    /// One of some names.
    Choice(Fields<String>),
    /// One of some shader files, by name.
    Module(ModuleFields),
}

/// Fields of a module, a choice of shader files. `#include "modules/NAME.glsl"` is the file of the
/// option that is set.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ModuleFields {
    name: Loc<String>,
    /// The file of each option, in the shader folder.
    options: Entries<String>,
    /// The first option when absent.
    default: Option<String>,
    plain: Option<String>,
    #[serde(default)]
    group: String,
    help: String,
    /// One line for each option.
    option_help: Option<Entries<String>>,
    when: Option<Ex>,
}

/// Fields of a declaration, as in [`Param`].
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Fields<T> {
    name: Loc<String>,
    /// A choice's first option when absent.
    default: Option<T>,
    plain: Option<T>,
    range: Option<(f64, f64)>,
    step: Option<f64>,
    #[serde(default)]
    unit: String,
    #[serde(default)]
    group: String,
    help: String,
    #[serde(default)]
    options: Vec<Loc<String>>,
    /// One line for each option.
    option_help: Option<Entries<String>>,
    #[serde(default)]
    constant: bool,
    when: Option<Ex>,
    effective: Option<Ex>,
    /// For choices with the option `auto`.
    fastest: Option<Fastest>,
}

impl From<Kinds> for Decl {
    fn from(kinds: Kinds) -> Decl {
        match kinds {
            Kinds::Bool(f) => f.decl(Kind::Bool, Value::Bool),
            Kinds::Int(f) => f.decl(Kind::Int, Value::Int),
            Kinds::Float(f) => f.decl(Kind::Float, Value::Float),
            Kinds::Vec2(f) => f.decl(Kind::Vector(2), |v| Value::Vector(vec![v.0, v.1])),
            Kinds::Vec3(f) => f.decl(Kind::Vector(3), |v| Value::Vector(vec![v.0, v.1, v.2])),
            Kinds::Vec4(f) => f.decl(Kind::Vector(4), |v| Value::Vector(vec![v.0, v.1, v.2, v.3])),
            Kinds::Colour(f) => f.decl(Kind::Colour, |v| Value::Vector(vec![v.0, v.1, v.2])),
            Kinds::Choice(f) => f.choice(Vec::new()),
            Kinds::Module(f) => {
                let (options, files): (Vec<_>, Vec<_>) = f.options.0.into_iter().unzip();
                let choice = Fields {
                    name: f.name,
                    default: f.default,
                    plain: f.plain,
                    range: None,
                    step: None,
                    unit: String::new(),
                    group: f.group,
                    help: f.help,
                    options,
                    option_help: f.option_help,
                    constant: false,
                    when: f.when,
                    effective: None,
                    fastest: None,
                };
                choice.choice(files.into_iter().map(|file| file.value).collect())
            }
        }
    }
}

impl Fields<String> {
    /// A choice; of shader files, where there are some.
    fn choice(mut self, files: Vec<String>) -> Decl {
        let names: Vec<String> = self.options.iter().map(|o| o.value.clone()).collect();
        let Some(first) = names.first().cloned() else {
            let param = Err(format!("choice '{}' has no options", self.name.value));
            return Decl {
                name: self.name,
                options: self.options,
                param,
            };
        };
        self.default.get_or_insert(first);
        let decl = self.decl(Kind::Choice(names), Value::Choice);
        Decl {
            param: decl.param.map(|param| Param { files, ..param }),
            ..decl
        }
    }
}

impl<T> Fields<T> {
    fn decl(self, kind: Kind, value: impl Fn(T) -> Value) -> Decl {
        let (name, options) = (self.name.clone(), self.options.clone());
        Decl {
            name,
            options,
            param: self.param(kind, value),
        }
    }

    fn param(self, kind: Kind, value: impl Fn(T) -> Value) -> Result<Param, String> {
        let Loc { value: name, at } = self.name;
        let default = self
            .default
            .map(&value)
            .ok_or(format!("parameter '{name}' has no default"))?;
        if self.help.trim().is_empty() || self.help.contains('\n') {
            return Err(format!("parameter '{name}' needs one line of help"));
        }
        if let Some((low, high)) = self.range
            && (low >= high || low.is_nan() || high.is_nan())
        {
            return Err(format!(
                "parameter '{name}': its range goes from {low} to {high}, which holds nothing"
            ));
        }
        if self.constant && kind.components() > 0 {
            return Err(format!("parameter '{name}': a vector cannot be a constant"));
        }
        if let Some(fastest) = &self.fastest {
            check_fastest(&name, kind.options(), fastest)?;
        }
        let option_help = option_help(&name, kind.options(), self.option_help)?;
        let param = Param {
            name,
            at,
            kind,
            declared: default.clone(),
            default,
            plain: self.plain.map(value),
            range: self.range,
            step: self.step,
            unit: self.unit,
            group: self.group,
            help: self.help,
            constant: self.constant,
            when: self.when,
            effective: self.effective,
            fastest: self.fastest,
            option_help,
            files: Vec::new(),
            fixed: false,
        };
        param
            .check(&param.default)
            .map_err(|e| format!("default of {e}"))?;
        param
            .plain
            .iter()
            .try_for_each(|v| param.check(v))
            .map_err(|e| format!("plain value of {e}"))?;
        Ok(param)
    }
}

fn check_fastest(name: &str, options: &[String], fastest: &Fastest) -> Result<(), String> {
    let known = |option: &str| options.iter().any(|o| o == option);
    if !known(AUTO) {
        return Err(format!(
            "parameter '{name}' has fastest, but no option '{AUTO}' that stands for it"
        ));
    }
    if let Some(other) = fastest.of.iter().find(|o| !known(o) || *o == AUTO) {
        return Err(format!(
            "choice '{name}': '{other}' cannot be the fastest, because it is none of its other options"
        ));
    }
    if fastest.of.len() < 2 || fastest.stages.is_empty() {
        return Err(format!(
            "choice '{name}': fastest needs two options or more, and the stages to measure"
        ));
    }
    Ok(())
}

/// The line of help of each option, in the order of the options; empty for one without.
fn option_help(
    name: &str,
    options: &[String],
    help: Option<Entries<String>>,
) -> Result<Vec<String>, String> {
    let Some(Entries(list)) = help else {
        return Ok(Vec::new());
    };
    if let Some((other, _)) = list
        .iter()
        .find(|(option, _)| !options.contains(&option.value))
    {
        return Err(format!(
            "choice '{name}' has help for '{}', which is none of its options",
            other.value
        ));
    }
    let line = |option: &String| {
        let text = list
            .iter()
            .find(|(of, _)| of.value == *option)
            .map_or("", |(_, text)| text.value.as_str());
        match text.contains('\n') {
            true => Err(format!(
                "choice '{name}' has more than one line of help for '{option}'"
            )),
            false => Ok(text.to_string()),
        }
    };
    options.iter().map(line).collect()
}
