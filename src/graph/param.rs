//! Parameters: declared once in a graph, read by shaders, `--set`, experiments, panels and sweeps.

use super::expr::{Env, Var};
use super::file::Ex;
use super::value::{Named, members as members_of};
use crate::diagnostics::{Entries, Loc, nearest, options};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::fmt::Write;

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
}

impl Value {
    /// As RON, as experiments write it.
    pub fn to_ron(&self) -> String {
        match self {
            Value::Choice(name) => format!("{name:?}"),
            other => other.to_string(),
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

/// A declared parameter.
#[derive(Clone, Debug)]
pub struct Param {
    /// Name in shaders and on the command line.
    pub name: String,
    /// What it holds.
    pub kind: Kind,
    /// Value when nothing else is said.
    pub default: Value,
    /// Default where the parameter is declared; a graph that includes it may have another.
    pub declared: Value,
    /// Value of a plain or cheaper method, to tell what the parameter is worth.
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
    /// What shaders take in its place, where that is not the value itself.
    pub effective: Option<Ex>,
    /// Of a module: the shader file of each option; empty for all others.
    pub files: Vec<String>,
}

/// A declaration as it stands in a graph file.
#[derive(Clone, Debug, Deserialize)]
pub enum Decl {
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

/// Fields of a module: a choice whose options are shader files. `#include "modules/NAME.glsl"` is the file of the option
/// that is set.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModuleFields {
    /// Name.
    pub name: Loc<String>,
    /// The file of each option, in the shader folder.
    pub options: Entries<String>,
    /// Default; the first option when absent.
    pub default: Option<String>,
    /// Plain or cheaper option.
    pub plain: Option<String>,
    /// Group.
    #[serde(default)]
    pub group: String,
    /// Help.
    pub help: String,
    /// When it counts.
    pub when: Option<Ex>,
}

/// Fields of a declaration.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fields<T> {
    /// Name.
    pub name: Loc<String>,
    /// Default; a choice's first option when absent.
    pub default: Option<T>,
    /// Plain or cheaper value.
    pub plain: Option<T>,
    /// Least and greatest.
    pub range: Option<(f64, f64)>,
    /// Step.
    pub step: Option<f64>,
    /// Unit.
    #[serde(default)]
    pub unit: String,
    /// Group.
    #[serde(default)]
    pub group: String,
    /// Help.
    pub help: String,
    /// Options of a choice.
    #[serde(default)]
    pub options: Vec<Loc<String>>,
    /// Specialisation constant.
    #[serde(default)]
    pub constant: bool,
    /// When it counts, where shaders decide that at run time.
    pub when: Option<Ex>,
    /// What shaders take in its place.
    pub effective: Option<Ex>,
}

impl Decl {
    /// The parameter, or what is wrong with it.
    pub fn param(&self) -> Result<Param, String> {
        match self {
            Decl::Bool(f) => make(f, Kind::Bool, |v| Value::Bool(*v)),
            Decl::Int(f) => make(f, Kind::Int, |v| Value::Int(*v)),
            Decl::Float(f) => make(f, Kind::Float, |v| Value::Float(*v)),
            Decl::Vec2(f) => make(f, Kind::Vector(2), |v| Value::Vector(vec![v.0, v.1])),
            Decl::Vec3(f) => make(f, Kind::Vector(3), |v| Value::Vector(vec![v.0, v.1, v.2])),
            Decl::Vec4(f) => make(f, Kind::Vector(4), |v| Value::Vector(vec![v.0, v.1, v.2, v.3])),
            Decl::Colour(f) => make(f, Kind::Colour, |v| Value::Vector(vec![v.0, v.1, v.2])),
            Decl::Choice(f) => {
                let names: Vec<String> = f.options.iter().map(|o| o.value.clone()).collect();
                if names.is_empty() {
                    return Err(format!("choice '{}' has no options", f.name.value));
                }
                let first = names[0].clone();
                let mut fields = f.clone();
                fields.default = fields.default.or(Some(first));
                make(&fields, Kind::Choice(names), |v| Value::Choice(v.clone()))
            }
            Decl::Module(f) => {
                let choice = Fields {
                    name: f.name.clone(),
                    default: f.default.clone(),
                    plain: f.plain.clone(),
                    range: None,
                    step: None,
                    unit: String::new(),
                    group: f.group.clone(),
                    help: f.help.clone(),
                    options: self.options(),
                    constant: false,
                    when: f.when.clone(),
                    effective: None,
                };
                let files = f.options.0.iter().map(|(_, file)| file.value.clone()).collect();
                Decl::Choice(choice).param().map(|param| Param { files, ..param })
            }
        }
    }

    /// The options of a choice or a module, with their places.
    pub fn options(&self) -> Vec<Loc<String>> {
        match self {
            Decl::Choice(f) => f.options.clone(),
            Decl::Module(f) => f.options.0.iter().map(|(option, _)| option.clone()).collect(),
            _ => Vec::new(),
        }
    }

    /// Name, with its place.
    pub fn name(&self) -> &Loc<String> {
        match self {
            Decl::Bool(f) => &f.name,
            Decl::Int(f) => &f.name,
            Decl::Float(f) => &f.name,
            Decl::Vec2(f) => &f.name,
            Decl::Vec3(f) | Decl::Colour(f) => &f.name,
            Decl::Vec4(f) => &f.name,
            Decl::Choice(f) => &f.name,
            Decl::Module(f) => &f.name,
        }
    }
}

fn make<T>(fields: &Fields<T>, kind: Kind, value: impl Fn(&T) -> Value) -> Result<Param, String> {
    let name = &fields.name.value;
    let default = fields.default.as_ref().map(&value).ok_or(format!("parameter '{name}' has no default"))?;
    if fields.help.trim().is_empty() || fields.help.contains('\n') {
        return Err(format!("parameter '{name}' needs one line of help"));
    }
    if let Some((low, high)) = fields.range
        && (low >= high || low.is_nan() || high.is_nan())
    {
        return Err(format!("parameter '{name}': its range goes from {low} to {high}, which holds nothing"));
    }
    if fields.constant && matches!(kind, Kind::Vector(_) | Kind::Colour) {
        return Err(format!("parameter '{name}': a vector cannot be a constant"));
    }
    let param = Param {
        name: name.clone(),
        kind,
        declared: default.clone(),
        default,
        plain: fields.plain.as_ref().map(value),
        range: fields.range,
        step: fields.step,
        unit: fields.unit.clone(),
        group: fields.group.clone(),
        help: fields.help.clone(),
        constant: fields.constant,
        when: fields.when.clone(),
        effective: fields.effective.clone(),
        files: Vec::new(),
    };
    param.check(&param.default).map_err(|e| format!("default of {e}"))?;
    param.plain.iter().try_for_each(|v| param.check(v)).map_err(|e| format!("plain value of {e}"))?;
    Ok(param)
}

impl Param {
    /// Whether its options are shader files: then it stands in no shader itself.
    pub fn is_module(&self) -> bool {
        !self.files.is_empty()
    }

    /// Whether another value needs other shaders or pipelines, and is not just a number that shaders read.
    pub fn is_compiled(&self) -> bool {
        self.constant || self.is_module()
    }

    /// Whether a value is of the right kind and in range; the error names the parameter and what was expected.
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
            (Kind::Vector(n), Value::Vector(v)) if v.len() == *n => v.clone(),
            (Kind::Colour, Value::Vector(v)) if v.len() == 3 => v.clone(),
            (Kind::Choice(options), Value::Choice(v)) => {
                if !options.contains(v) {
                    let hint = nearest(v, options.iter().map(String::as_str)).unwrap_or_default();
                    return Err(format!("'{name}' has no option '{v}' ({hint})"));
                }
                vec![]
            }
            _ => return Err(format!("'{name}': expected {}, got {value}", self.expected())),
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
        let ron = options();
        let value = match &self.kind {
            Kind::Bool => Value::Bool(ron.from_str(text).map_err(|_| wrong())?),
            Kind::Int => Value::Int(ron.from_str(text).map_err(|_| wrong())?),
            Kind::Float => Value::Float(ron.from_str(text).map_err(|_| wrong())?),
            Kind::Vector(2) => {
                ron.from_str::<[f64; 2]>(text).map(|v| Value::Vector(v.to_vec())).map_err(|_| wrong())?
            }
            Kind::Vector(4) => {
                ron.from_str::<[f64; 4]>(text).map(|v| Value::Vector(v.to_vec())).map_err(|_| wrong())?
            }
            Kind::Vector(_) | Kind::Colour => {
                ron.from_str::<[f64; 3]>(text).map(|v| Value::Vector(v.to_vec())).map_err(|_| wrong())?
            }
            Kind::Choice(_) => Value::Choice(ron.from_str::<String>(text).unwrap_or_else(|_| text.to_string())),
        };
        self.check(&value)?;
        Ok(value)
    }
}

/// Parameters of a graph with their present values.
#[derive(Clone, Debug, Default)]
pub struct Params {
    /// The declarations, in order.
    pub list: Vec<Param>,
    /// The values, in the same order.
    pub values: Vec<Value>,
    /// What to write instead of a parameter, or of `parameter=option`, that is no more.
    pub retired: Vec<(String, String)>,
    /// Names of the graph's passes.
    pub passes: Vec<String>,
    /// Passes that are left out: what none but them writes is zeros.
    pub off: Vec<String>,
}

/// The name under which passes are left out, where parameters are set; no parameter has it.
pub const OFF: &str = "off";

impl Params {
    /// All at their defaults.
    pub fn new(list: Vec<Param>) -> Params {
        let values = list.iter().map(|p| p.default.clone()).collect();
        Params { list, values, ..Params::default() }
    }

    /// The module files in use: name of the module, file of its option.
    pub fn modules(&self) -> impl Iterator<Item = (&str, &str)> {
        self.list.iter().zip(&self.values).filter_map(|(param, value)| {
            let (Kind::Choice(options), Value::Choice(option)) = (&param.kind, value) else { return None };
            let number = options.iter().position(|o| o == option)?;
            Some((param.name.as_str(), param.files.get(number)?.as_str()))
        })
    }

    fn instead(&self, name: &str) -> Option<&str> {
        self.retired.iter().find(|(retired, _)| retired == name).map(|(_, instead)| instead.as_str())
    }

    /// Number of a parameter.
    pub fn index(&self, name: &str) -> Option<usize> {
        self.list.iter().position(|p| p.name == name)
    }

    /// Sets a parameter from text.
    ///
    /// # Errors
    /// Unknown name (with the nearest), wrong kind, out of range.
    pub fn set(&mut self, name: &str, text: &str) -> Result<(), String> {
        if name == OFF {
            self.off = self.passes_of(text)?;
            return Ok(());
        }
        let Some(i) = self.index(name) else {
            if let Some(instead) = self.instead(name) {
                return Err(format!("no parameter '{name}' in this graph: {instead}"));
            }
            let hint =
                nearest(name, self.list.iter().map(|p| p.name.as_str())).map_or(String::new(), |h| format!(" ({h})"));
            return Err(format!("no parameter '{name}'{hint}"));
        };
        let instead = self.instead(&format!("{name}={}", text.trim().trim_matches('"')));
        self.values[i] = self.list[i].parse(text).map_err(|e| instead.map_or(e.clone(), |i| format!("{e}: {i}")))?;
        Ok(())
    }

    /// The passes that a list in RON names, in the graph's order.
    fn passes_of(&self, text: &str) -> Result<Vec<String>, String> {
        let wrong =
            |_| format!("'{OFF}': expected a list of passes, as [\"{}\"]", self.passes.first().map_or("", |p| p));
        let named: Vec<String> = options().from_str(text.trim()).map_err(wrong)?;
        let known = |name: &&String| !self.passes.contains(name);
        if let Some(unknown) = named.iter().find(known) {
            let hint = nearest(unknown, self.passes.iter().map(String::as_str));
            return Err(format!("'{OFF}': no pass '{unknown}'{}", hint.map_or(String::new(), |h| format!(" ({h})"))));
        }
        Ok(self.passes.iter().filter(|p| named.contains(p)).cloned().collect())
    }

    /// All that is set, by name and as RON: the parameters, and the passes left out where there are some.
    pub fn texts(&self) -> impl Iterator<Item = (String, String)> {
        let off = (!self.off.is_empty()).then(|| (OFF.to_string(), format!("{:?}", self.off)));
        self.list.iter().zip(&self.values).map(|(param, value)| (param.name.clone(), value.to_ron())).chain(off)
    }

    /// The value of a parameter.
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.index(name).map(|i| &self.values[i])
    }

    /// Adds the values as expression variables; options of choices become numbers that compare equal by name.
    pub fn fill(&self, env: &mut Env) {
        let mut options: Vec<&str> = self.option_names().collect();
        options.sort_unstable();
        options.dedup();
        let code = |name: &str| 1000.0 + options.binary_search(&name).unwrap_or(usize::MAX) as f64;
        for name in &options {
            env.insert((*name).to_string(), Var::Number(code(name)));
        }
        for (param, value) in self.list.iter().zip(&self.values) {
            let name = &param.name;
            match value {
                Value::Bool(v) => drop(env.insert(name.clone(), Var::Bool(*v))),
                Value::Int(v) => drop(env.insert(name.clone(), Var::Number(*v as f64))),
                Value::Float(v) => drop(env.insert(name.clone(), Var::Number(*v))),
                Value::Choice(v) => drop(env.insert(name.clone(), Var::Number(code(v)))),
                Value::Vector(v) => {
                    for (component, x) in ["x", "y", "z", "w"].iter().zip(v) {
                        env.insert(format!("{name}_{component}"), Var::Number(*x));
                    }
                }
            }
        }
    }

    /// Names of all options of all choices.
    pub fn option_names(&self) -> impl Iterator<Item = &str> {
        self.list
            .iter()
            .flat_map(|p| match &p.kind {
                Kind::Choice(options) => options.as_slice(),
                _ => &[],
            })
            .map(String::as_str)
    }

    /// The generated include `params.glsl`: a uniform block with these named values at its end, specialisation constants,
    /// names of options.
    pub fn glsl(&self, values: &[Named]) -> String {
        let mut members = String::new();
        let mut rest = String::new();
        for (id, param) in self.list.iter().enumerate().filter(|(_, p)| !p.is_module()) {
            let upper = param.name.to_uppercase();
            let (ty, value) = glsl_value(param);
            if param.constant {
                let _ = writeln!(rest, "layout(constant_id = {id}) const {ty} {upper} = {value};");
            } else {
                let _ = writeln!(members, "    {ty} {};", param.name);
            }
            if let Kind::Choice(options) = &param.kind {
                for (i, option) in options.iter().enumerate() {
                    let _ = writeln!(rest, "const int {upper}_{} = {i};", option.to_uppercase());
                }
            }
        }
        members.push_str(&members_of(values));
        if members.is_empty() {
            members.push_str("    uint no_parameters;\n");
        }
        format!(
            "#ifndef PARAMS_GLSL\n#define PARAMS_GLSL\nlayout(std140) uniform Params {{\n{members}}} params;\n{rest}\
             layout(push_constant) uniform Pass {{ uint index; }} pass;\n#endif\n"
        )
    }

    /// The content of the uniform block (std140, OpenGL 4.6 section 7.6.2.2), with the named values of [`Params::glsl`].
    pub fn uniform_bytes(&self, values: &[Value]) -> Vec<u8> {
        let mut bytes = Vec::new();
        for (param, value) in self.list.iter().zip(&self.values).filter(|(p, _)| !p.constant && !p.is_module()) {
            let words = words(param, value);
            let align = match words.len() {
                1 => 4,
                2 => 8,
                _ => 16,
            };
            bytes.resize(bytes.len().next_multiple_of(align), 0);
            bytes.extend(words.iter().flat_map(|w| w.to_ne_bytes()));
        }
        for value in values {
            bytes.extend(scalar(value).to_ne_bytes());
        }
        bytes.resize(bytes.len().next_multiple_of(16).max(16), 0);
        bytes
    }

    /// Specialisation constants: (id, value).
    pub fn constants(&self) -> Vec<(u32, u32)> {
        (0u32..)
            .zip(self.list.iter().zip(&self.values))
            .filter(|(_, (p, _))| p.constant)
            .map(|(id, (p, v))| (id, words(p, v).first().copied().unwrap_or(0)))
            .collect()
    }
}

fn glsl_value(param: &Param) -> (&'static str, String) {
    let first = words(param, &param.default).first().copied().unwrap_or(0);
    match &param.kind {
        Kind::Bool => ("bool", (first != 0).to_string()),
        Kind::Int | Kind::Choice(_) => ("int", first.cast_signed().to_string()),
        Kind::Float => ("float", format!("{:?}", f32::from_bits(first))),
        Kind::Vector(2) => ("vec2", String::new()),
        Kind::Vector(4) => ("vec4", String::new()),
        Kind::Vector(_) | Kind::Colour => ("vec3", String::new()),
    }
}

fn words(param: &Param, value: &Value) -> Vec<u32> {
    match value {
        Value::Vector(v) => v.iter().map(|x| (*x as f32).to_bits()).collect(),
        Value::Choice(v) => match &param.kind {
            Kind::Choice(options) => vec![u32::try_from(options.iter().position(|o| o == v).unwrap_or(0)).unwrap_or(0)],
            _ => vec![0],
        },
        _ => vec![scalar(value)],
    }
}

fn scalar(value: &Value) -> u32 {
    match value {
        Value::Bool(v) => u32::from(*v),
        Value::Int(v) => i32::try_from(*v).unwrap_or(0).cast_unsigned(),
        Value::Float(v) => (*v as f32).to_bits(),
        Value::Vector(_) | Value::Choice(_) => 0,
    }
}
