//! Kinds, values and declarations of parameters.

use crate::diagnostics::{At, nearest, options};
use crate::graph::expr::{Env, Ex, Var};
use serde::{Deserialize, Serialize};
use std::fmt;

/// The variable that is there if an option of a choice is the fastest on the device.
pub fn fastest_key(choice: &str, option: &str) -> String {
    format!("fastest {choice} {option}")
}

/// What kind of value a parameter has.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// true or false.
    Bool,
    /// A whole number.
    Int,
    /// A number.
    Float,
    /// 2 to 4 numbers.
    Vector(usize),
    /// Linear RGB.
    Colour,
    /// One of some names.
    Choice(Vec<String>),
}

impl Kind {
    /// Numbers with names of their own in expressions; 0 where the whole has one name.
    pub fn components(&self) -> usize {
        match self {
            Kind::Vector(n) => *n,
            Kind::Colour => 3,
            _ => 0,
        }
    }

    /// The names of a choice; none of all others.
    pub fn options(&self) -> &[String] {
        match self {
            Kind::Choice(options) => options,
            _ => &[],
        }
    }
}

/// A parameter's value.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Value {
    /// true or false.
    Bool(bool),
    /// A whole number.
    Int(i64),
    /// A number.
    Float(f64),
    /// Vectors and colours.
    Vector(Vec<f64>),
    /// The name of a choice's option.
    Choice(String),
}

impl Value {
    /// A whole or other number; nothing for other kinds.
    pub fn number(&self) -> Option<f64> {
        match self {
            Value::Int(v) => Some(*v as f64),
            Value::Float(v) => Some(*v),
            _ => None,
        }
    }

    /// Reads RON without the parameter: text of no other kind is the name of an option.
    pub fn read(text: &str) -> Value {
        let (text, ron) = (text.trim(), options());
        let vector = |v: &[f64]| Value::Vector(v.to_vec());
        (ron.from_str(text).map(Value::Bool))
            .or_else(|_| ron.from_str(text).map(Value::Int))
            .or_else(|_| ron.from_str(text).map(Value::Float))
            .or_else(|_| ron.from_str::<[f64; 2]>(text).map(|v| vector(&v)))
            .or_else(|_| ron.from_str::<[f64; 3]>(text).map(|v| vector(&v)))
            .or_else(|_| ron.from_str::<[f64; 4]>(text).map(|v| vector(&v)))
            .or_else(|_| ron.from_str(text).map(Value::Choice))
            .unwrap_or_else(|_| Value::Choice(text.into()))
    }

    /// As RON, as experiments write it.
    pub fn to_ron(&self) -> String {
        match self {
            Value::Choice(name) => format!("{name:?}"),
            other => other.to_string(),
        }
    }

    /// As shaders hold it, in 32-bit words: an option of a choice is its number.
    pub(in crate::graph) fn words(&self, kind: &Kind) -> Vec<u32> {
        match self {
            Value::Bool(v) => vec![u32::from(*v)],
            Value::Int(v) => vec![i32::try_from(*v).unwrap_or(0).cast_unsigned()],
            Value::Float(v) => vec![(*v as f32).to_bits()],
            Value::Vector(v) => v.iter().map(|x| (*x as f32).to_bits()).collect(),
            Value::Choice(v) => {
                let number = kind.options().iter().position(|o| o == v);
                vec![number.and_then(|n| u32::try_from(n).ok()).unwrap_or(0)]
            }
        }
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Bool(v) => write!(f, "{v}"),
            Value::Int(v) => write!(f, "{v}"),
            Value::Float(v) => write!(f, "{v:?}"),
            Value::Vector(v) => {
                let parts: Vec<String> = v.iter().map(|x| format!("{x:?}")).collect();
                write!(f, "({})", parts.join(", "))
            }
            Value::Choice(v) => write!(f, "{v}"),
        }
    }
}

/// The option of a choice that stands for the fastest of some others.
pub const AUTO: &str = "auto";

/// What [`AUTO`] of a choice stands for: the option with which some stages of a frame are fastest.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fastest {
    /// The options that are measured. Unmeasured, a GPU takes the first, a software device the
    /// last.
    pub of: Vec<String>,
    /// The stages: their times on the GPU are added.
    pub stages: Vec<String>,
}

/// A declared parameter.
#[derive(Clone, Debug)]
pub struct Param {
    /// Name in shaders and on the command line.
    pub name: String,
    /// Where it is declared.
    pub at: At,
    /// The kind of its value.
    pub kind: Kind,
    /// Default value.
    pub default: Value,
    /// Default where the parameter is declared; a graph that includes it may have another.
    pub declared: Value,
    /// Value of a plain or cheaper method, for ablations.
    pub plain: Option<Value>,
    /// Least and greatest value, of each component of a vector.
    pub range: Option<(f64, f64)>,
    /// Distance of neighbouring settings, for sliders and sweeps.
    pub step: Option<f64>,
    /// Unit, for people.
    pub unit: String,
    /// Where the panel shows it.
    pub group: String,
    /// One line.
    pub help: String,
    /// Whether it is a specialisation constant.
    pub constant: bool,
    /// When it counts at all, where shaders decide that at run time.
    pub when: Option<Ex>,
    /// What shaders take in place of the default, which stands for a choice of the graph's.
    pub effective: Option<Ex>,
    /// The meaning of a choice's option `auto`.
    pub fastest: Option<Fastest>,
    /// Lines of help for the options of a choice; empty for other kinds.
    pub option_help: Vec<String>,
    /// The shader files of a module's options; empty for other kinds.
    pub files: Vec<String>,
    /// Whether the graph keeps it at its default.
    pub fixed: bool,
}

impl Param {
    /// Whether its options are shader files. Shaders then include the file and do not name the
    /// parameter.
    pub fn is_module(&self) -> bool {
        !self.files.is_empty()
    }

    /// Whether another value needs other shaders or pipelines, and is not just a number that
    /// shaders read.
    pub fn is_compiled(&self) -> bool {
        self.constant || self.is_module()
    }

    /// Its names in expressions: its own, or one for each component.
    pub fn variables(&self) -> Vec<String> {
        match self.kind.components() {
            0 => vec![self.name.clone()],
            n => ["x", "y", "z", "w"]
                .iter()
                .take(n)
                .map(|c| format!("{}_{c}", self.name))
                .collect(),
        }
    }

    /// Its name in shaders: a constant, or a member of the uniform block.
    pub fn in_shaders(&self) -> String {
        if self.constant {
            self.name.to_uppercase()
        } else {
            format!("params.{}", self.name)
        }
    }

    /// Whether the device decides it.
    pub fn is_auto(&self, value: &Value) -> bool {
        self.fastest.is_some() && matches!(value, Value::Choice(option) if option == AUTO)
    }

    /// The option that `auto` stands for; others stand for themselves.
    pub fn resolved<'a>(&'a self, option: &'a str, env: &Env) -> &'a str {
        let Some(fastest) = self.fastest.as_ref().filter(|_| option == AUTO) else {
            return option;
        };
        let is_measured = |o: &&String| env.contains_key(&fastest_key(&self.name, o));
        let is_software = env.get("software_device") == Some(&Var::Number(1.0));
        let unmeasured = match is_software {
            true => fastest.of.last(),
            false => fastest.of.first(),
        };
        fastest
            .of
            .iter()
            .find(is_measured)
            .or(unmeasured)
            .map_or(option, |o| o)
    }

    /// Gives its variables a value. The numbers of a choice's options are among the variables
    /// already.
    pub(in crate::graph) fn put(&self, value: &Value, env: &mut Env) {
        let var = match value {
            Value::Bool(v) => Var::Bool(*v),
            Value::Int(v) => Var::Number(*v as f64),
            Value::Float(v) => Var::Number(*v),
            Value::Choice(option) => match env.get(self.resolved(option, env)) {
                Some(number) => *number,
                None => return,
            },
            Value::Vector(v) => {
                return env.extend(
                    self.variables()
                        .into_iter()
                        .zip(v.iter().map(|x| Var::Number(*x))),
                );
            }
        };
        env.insert(self.name.clone(), var);
    }

    /// Checks kind and range of a value. The error names the parameter and the expected values.
    ///
    /// # Errors
    /// The text for the user.
    pub fn check(&self, value: &Value) -> Result<(), String> {
        let name = &self.name;
        let numbers: Vec<f64> = match (&self.kind, value) {
            (Kind::Bool, Value::Bool(_)) => vec![],
            (Kind::Int, Value::Int(v)) => {
                if i32::try_from(*v).is_err() {
                    return Err(format!("'{name}': {v} does not fit 32 bits"));
                }
                vec![*v as f64]
            }
            (Kind::Float, Value::Float(v)) => vec![*v],
            (kind, Value::Vector(v)) if kind.components() > 0 && v.len() == kind.components() => {
                v.clone()
            }
            (Kind::Choice(options), Value::Choice(v)) => {
                if !options.contains(v) {
                    let hint = nearest(v, options.iter().map(String::as_str)).unwrap_or_default();
                    return Err(format!("'{name}' has no option '{v}' ({hint})"));
                }
                vec![]
            }
            _ => {
                return Err(format!(
                    "'{name}': expected {}, got {value}",
                    self.expected()
                ));
            }
        };
        if let Some(bad) = numbers.iter().find(|v| !v.is_finite()) {
            return Err(format!("'{name}': {bad} is not a finite number"));
        }
        if let Some((low, high)) = self.range
            && let Some(bad) = numbers.iter().find(|v| **v < low || **v > high)
        {
            return Err(format!("'{name}': {bad} is outside {low} to {high}"));
        }
        Ok(())
    }

    /// What its values look like, for people.
    pub fn expected(&self) -> String {
        match &self.kind {
            Kind::Bool => "true or false".into(),
            Kind::Int => "a whole number".into(),
            Kind::Float => "a number".into(),
            Kind::Vector(n) => format!("{n} numbers in parentheses"),
            Kind::Colour => "a colour (r, g, b)".into(),
            Kind::Choice(options) => format!("one of {}", options.join(", ")),
        }
    }

    /// Reads a value from text (RON; a choice's option needs no quotes).
    ///
    /// # Errors
    /// The text for the user.
    pub fn parse(&self, text: &str) -> Result<Value, String> {
        let text = text.trim();
        let wrong = || format!("'{}': expected {}, got {text}", self.name, self.expected());
        let value = self.of_kind(Value::read(text)).ok_or_else(wrong)?;
        self.accept(value)
    }

    /// The value as one of this parameter's kind, if it is in range and not fixed.
    pub fn fit(&self, value: &Value) -> Option<Value> {
        self.accept(self.of_kind(value.clone())?).ok()
    }

    fn of_kind(&self, value: Value) -> Option<Value> {
        match (&self.kind, value) {
            (Kind::Float, Value::Int(v)) => Some(Value::Float(v as f64)),
            (Kind::Choice(_), value) => Some(Value::Choice(value.to_string())),
            (Kind::Vector(_) | Kind::Colour, Value::Vector(v)) => {
                (v.len() == self.kind.components()).then_some(Value::Vector(v))
            }
            (Kind::Bool, value @ Value::Bool(_))
            | (Kind::Int, value @ Value::Int(_))
            | (Kind::Float, value @ Value::Float(_)) => Some(value),
            _ => None,
        }
    }

    fn accept(&self, value: Value) -> Result<Value, String> {
        self.check(&value)?;
        if self.fixed && value != self.default {
            return Err(format!(
                "'{}' is fixed at {} in this graph",
                self.name, self.default
            ));
        }
        Ok(value)
    }
}
