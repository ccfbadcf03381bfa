//! The chart that a suite asks for: a dot for each method, static error against stability, with what it costs.

use super::file::{Case, Method};
use crate::campaign::sweep::Setting;
use crate::graph::file::RawText;
use crate::graph::source::{Entries, Loc};
use serde::Deserialize;

/// Most values that are timed for one method.
const MAX_VALUES: usize = 64;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ChartFile {
    error: Vec<String>,
    motions: Vec<String>,
    #[serde(default = "diffuse")]
    part: String,
    #[serde(default)]
    groups: Entries<Vec<String>>,
    #[serde(default)]
    equal_time: Option<EqualTimeFile>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct EqualTimeFile {
    parameter: Loc<String>,
    values: Vec<RawText>,
    methods: Vec<String>,
    #[serde(default = "near")]
    tolerance: f64,
}

fn diffuse() -> String {
    "diffuse".into()
}

fn near() -> f64 {
    0.05
}

/// Static error against stability.
#[derive(Clone, Debug)]
pub struct CostChart {
    /// Cases whose mean relMSE goes to the right.
    pub error: Vec<String>,
    /// Cases whose root mean square of E_t goes up. Methods are timed in the first of them.
    pub motions: Vec<String>,
    /// The part of the light.
    pub part: String,
    /// Panels: titles and methods.
    pub groups: Vec<(String, Vec<String>)>,
    /// Methods that are made as fast as the suite's first.
    pub equal_time: Option<EqualTime>,
}

/// What makes methods as fast as the suite's first one.
#[derive(Clone, Debug)]
pub struct EqualTime {
    /// One parameter at each of its values.
    pub settings: Vec<Setting>,
    /// The methods.
    pub methods: Vec<String>,
    /// How far a time may be from the first's, part of it, before tables say so.
    pub tolerance: f64,
}

impl ChartFile {
    /// Checks names and numbers.
    ///
    /// # Errors
    /// The text for the user.
    pub fn spec(&self, methods: &[Method], cases: &[Case]) -> Result<CostChart, String> {
        if self.error.is_empty() || self.motions.is_empty() {
            return Err("a chart needs at least one case for `error` and one for `motions`".into());
        }
        let groups: Vec<(String, Vec<String>)> = match self.groups.0.is_empty() {
            true => vec![(String::new(), methods.iter().map(|m| m.name.clone()).collect())],
            false => self.groups.0.iter().map(|(name, list)| (name.value.clone(), list.value.clone())).collect(),
        };
        let varied = self.equal_time.iter().flat_map(|e| &e.methods);
        for name in groups.iter().flat_map(|g| &g.1).chain(varied.clone()) {
            if !methods.iter().any(|m| m.name == *name) {
                return Err(format!("the chart names the method '{name}', which is none of the suite's"));
            }
        }
        for name in self.error.iter().chain(&self.motions) {
            let case = cases.iter().find(|c| c.name == *name);
            let case =
                case.ok_or_else(|| format!("the chart names the case '{name}', which is none of the suite's"))?;
            let all = groups.iter().flat_map(|g| &g.1).chain(methods.first().map(|m| &m.name));
            if let Some(m) = all.into_iter().find(|m| !case.methods.is_empty() && !case.methods.contains(m)) {
                return Err(format!("the chart needs the method '{m}' in the case '{name}', which leaves it out"));
            }
        }
        let Some(equal) = &self.equal_time else {
            return Ok(CostChart { groups, equal_time: None, ..self.plain() });
        };
        let first = methods.first().map_or("", |m| m.name.as_str());
        if equal.methods.iter().any(|m| m == first) {
            return Err(format!("'{first}' is the suite's first method: others are made as fast as it is"));
        }
        if let Some(m) = equal.methods.iter().find(|m| !groups.iter().any(|g| g.1.contains(m))) {
            return Err(format!("'{m}' is made as fast as '{first}', but in none of the chart's groups"));
        }
        if equal.values.is_empty() || equal.values.len() > MAX_VALUES {
            return Err(format!("equal_time needs 1 to {MAX_VALUES} values"));
        }
        if !(0.0..=1.0).contains(&equal.tolerance) {
            return Err("the tolerance must be 0 to 1".into());
        }
        let setting = |v: &RawText| Setting { name: equal.parameter.clone(), text: v.0.clone() };
        let settings = equal.values.iter().map(setting).collect();
        let equal_time = EqualTime { settings, methods: equal.methods.clone(), tolerance: equal.tolerance };
        Ok(CostChart { groups, equal_time: Some(equal_time), ..self.plain() })
    }

    fn plain(&self) -> CostChart {
        CostChart {
            error: self.error.clone(),
            motions: self.motions.clone(),
            part: self.part.clone(),
            groups: Vec::new(),
            equal_time: None,
        }
    }
}

impl CostChart {
    /// The values of a method, if it is one of those that are made as fast as the first.
    pub fn varied(&self, method: &str) -> &[Setting] {
        let own = self.equal_time.as_ref().filter(|e| e.methods.iter().any(|m| m == method));
        own.map_or(&[], |e| &e.settings)
    }

    /// A method at each of its values, or as it is.
    pub fn variants(&self, method: &Method) -> Vec<Method> {
        let settings = self.varied(&method.name);
        let with = |s| Method { set: method.set.iter().chain([s]).cloned().collect(), ..method.clone() };
        if settings.is_empty() { vec![method.clone()] } else { settings.iter().map(with).collect() }
    }
}
