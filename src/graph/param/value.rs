//! What a parameter holds.

use serde::Serialize;
use std::fmt;

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
