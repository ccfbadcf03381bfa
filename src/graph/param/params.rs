//! The parameters of a graph with their present values.

use super::kinds::{Kind, Param, Value};
use crate::diagnostics::{nearest, options};
use crate::graph::expr::{Env, Var};
use std::fmt::Write;

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
        Params {
            list,
            values,
            ..Params::default()
        }
    }

    /// Parameters that may be set.
    pub fn offered(&self) -> impl Iterator<Item = &Param> {
        self.list.iter().filter(|p| !p.fixed)
    }

    /// Each with its value.
    fn pairs(&self) -> impl Iterator<Item = (&Param, &Value)> {
        self.list.iter().zip(&self.values)
    }

    /// The module files in use: name of the module, file of its option.
    pub fn modules(&self) -> impl Iterator<Item = (&str, &str)> {
        self.pairs().filter_map(|(param, value)| {
            let Value::Choice(option) = value else {
                return None;
            };
            let number = param.kind.options().iter().position(|o| o == option)?;
            Some((param.name.as_str(), param.files.get(number)?.as_str()))
        })
    }

    fn instead(&self, name: &str) -> Option<&str> {
        self.retired
            .iter()
            .find(|(retired, _)| retired == name)
            .map(|(_, instead)| instead.as_str())
    }

    /// Number of a parameter.
    pub fn index(&self, name: &str) -> Option<usize> {
        self.list.iter().position(|p| p.name == name)
    }

    /// The parameter of that name.
    pub fn param(&self, name: &str) -> Option<&Param> {
        self.list.iter().find(|p| p.name == name)
    }

    /// The value of a parameter.
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.index(name).map(|i| &self.values[i])
    }

    /// Names of all parameters.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.list.iter().map(|p| p.name.as_str())
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
            let hint = nearest(name, self.names()).map_or(String::new(), |h| format!(" ({h})"));
            return Err(format!("no parameter '{name}'{hint}"));
        };
        let instead = self.instead(&format!("{name}={}", text.trim().trim_matches('"')));
        self.values[i] = self.list[i]
            .parse(text)
            .map_err(|e| instead.map_or(e.clone(), |i| format!("{e}: {i}")))?;
        Ok(())
    }

    /// The passes that a list in RON names, in the graph's order.
    fn passes_of(&self, text: &str) -> Result<Vec<String>, String> {
        let wrong = |_| {
            format!(
                "'{OFF}': expected a list of passes, as [\"{}\"]",
                self.passes.first().map_or("", |p| p)
            )
        };
        let named: Vec<String> = options().from_str(text.trim()).map_err(wrong)?;
        let unknown = |name: &&String| !self.passes.contains(name);
        if let Some(unknown) = named.iter().find(unknown) {
            let hint = nearest(unknown, self.passes.iter().map(String::as_str));
            return Err(format!(
                "'{OFF}': no pass '{unknown}'{}",
                hint.map_or(String::new(), |h| format!(" ({h})"))
            ));
        }
        Ok(self
            .passes
            .iter()
            .filter(|p| named.contains(p))
            .cloned()
            .collect())
    }

    /// All that is set, by name and as RON: the parameters, and the passes left out where there are
    /// some.
    pub fn texts(&self) -> impl Iterator<Item = (String, String)> {
        let off = (!self.off.is_empty()).then(|| (OFF.to_string(), format!("{:?}", self.off)));
        self.pairs()
            .map(|(param, value)| (param.name.clone(), value.to_ron()))
            .chain(off)
    }

    /// Adds the values as expression variables; options of choices become numbers that compare
    /// equal by name.
    pub fn fill(&self, env: &mut Env) {
        let mut options: Vec<&str> = self.option_names().collect();
        options.sort_unstable();
        options.dedup();
        env.extend(
            (1000u32..)
                .zip(options)
                .map(|(number, name)| (name.into(), Var::Number(number.into()))),
        );
        self.pairs()
            .for_each(|(param, value)| param.put(value, env));
    }

    /// Names of all options of all choices.
    pub fn option_names(&self) -> impl Iterator<Item = &str> {
        self.list
            .iter()
            .flat_map(|p| p.kind.options())
            .map(String::as_str)
    }

    /// The generated include `params.glsl`: a uniform block that ends with these members,
    /// specialisation constants, names of options.
    pub fn glsl(&self, values: &str) -> String {
        let (mut members, mut rest) = (String::new(), String::new());
        for (id, param) in self.list.iter().enumerate().filter(|(_, p)| !p.is_module()) {
            let upper = param.name.to_uppercase();
            let first = param
                .default
                .words(&param.kind)
                .first()
                .copied()
                .unwrap_or(0);
            // Vectors are no constants.
            let (ty, constant) = match &param.kind {
                Kind::Bool => ("bool", (first != 0).to_string()),
                Kind::Int | Kind::Choice(_) => ("int", first.cast_signed().to_string()),
                Kind::Float => ("float", format!("{:?}", f32::from_bits(first))),
                Kind::Vector(2) => ("vec2", String::new()),
                Kind::Vector(4) => ("vec4", String::new()),
                Kind::Vector(_) | Kind::Colour => ("vec3", String::new()),
            };
            let _ = match param.constant {
                true => writeln!(
                    rest,
                    "layout(constant_id = {id}) const {ty} {upper} = {constant};"
                ),
                false => writeln!(members, "    {ty} {};", param.name),
            };
            for (i, option) in param.kind.options().iter().enumerate() {
                let _ = writeln!(rest, "const int {upper}_{} = {i};", option.to_uppercase());
            }
        }
        members.push_str(values);
        if members.is_empty() {
            members.push_str("    uint no_parameters;\n");
        }
        format!(
            "#ifndef PARAMS_GLSL\n#define PARAMS_GLSL\nlayout(std140) uniform Params {{\n{members}}} params;\n{rest}\
             layout(push_constant) uniform Pass {{ uint index; }} pass;\n#endif\n"
        )
    }

    /// The content of the uniform block (std140, OpenGL 4.6 section 7.6.2.2), with these numbers at
    /// its end.
    pub fn uniform_bytes(&self, values: &[Value]) -> Vec<u8> {
        let mut bytes = Vec::new();
        for (param, value) in self.pairs().filter(|(p, _)| !p.is_compiled()) {
            let words = value.words(&param.kind);
            let align = match words.len() {
                1 => 4,
                2 => 8,
                _ => 16,
            };
            bytes.resize(bytes.len().next_multiple_of(align), 0);
            bytes.extend(words.iter().flat_map(|w| w.to_ne_bytes()));
        }
        bytes.extend(
            values
                .iter()
                .flat_map(|v| v.words(&Kind::Float))
                .flat_map(u32::to_ne_bytes),
        );
        bytes.resize(bytes.len().next_multiple_of(16).max(16), 0);
        bytes
    }

    /// Specialisation constants: (id, value).
    pub fn constants(&self) -> Vec<(u32, u32)> {
        let words = |(p, v): (&Param, &Value)| v.words(&p.kind).first().copied().unwrap_or(0);
        (0u32..)
            .zip(self.pairs())
            .filter(|(_, pair)| pair.0.constant)
            .map(|(id, pair)| (id, words(pair)))
            .collect()
    }
}
