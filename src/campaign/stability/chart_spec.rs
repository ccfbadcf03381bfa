//! Chart of a suite: static error against stability, one dot per method, with costs.

use super::case::{Case, Method};
use crate::campaign::settings::Setting;
use crate::diagnostics::{At, Entries, Loc, RawText};
use serde::Deserialize;

/// Largest number of values to time for one method.
const MAX_VALUES: usize = 64;

/// Static error against stability.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CostChart {
    /// Cases for the x-axis: mean relMSE.
    pub error: Vec<String>,
    /// Cases for the y-axis: root mean square of E_t. Methods are timed in the first one.
    pub motions: Vec<String>,
    /// Part of the light. By default the graph's focus, else the total.
    #[serde(default)]
    pub part: Option<String>,
    /// Panels: titles and methods.
    #[serde(default)]
    pub groups: Entries<Vec<String>>,
    /// Methods that have to match the first method's time.
    #[serde(default)]
    pub equal_time: Option<EqualTime>,
}

/// Condition for equal times.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EqualTime {
    pub parameter: Loc<String>,
    /// Values of the parameter.
    pub values: Vec<RawText>,
    pub methods: Vec<String>,
    /// Largest deviation from the first method's time, relative to it. Tables mark larger ones.
    #[serde(default = "near")]
    pub tolerance: f64,
}

fn near() -> f64 {
    0.05
}

impl CostChart {
    /// The part of the light.
    pub fn part(&self) -> &str {
        self.part.as_deref().unwrap_or("total")
    }

    /// Checks names and numbers. Without groups, all methods form one.
    pub fn checked(mut self, methods: &[Method], cases: &[Case]) -> Result<CostChart, String> {
        if self.error.is_empty() || self.motions.is_empty() {
            return Err("a chart needs at least one case for `error` and one for `motions`".into());
        }
        if self.groups.0.is_empty() {
            let at = At::default();
            let all = methods.iter().map(|m| m.name.clone()).collect();
            self.groups.0.push((
                Loc {
                    value: String::new(),
                    at,
                },
                Loc { value: all, at },
            ));
        }
        let grouped = || self.groups.0.iter().flat_map(|g| &g.1.value);
        for name in grouped().chain(self.equal_time.iter().flat_map(|e| &e.methods)) {
            if !methods.iter().any(|m| m.name == *name) {
                return Err(format!(
                    "the chart names the method '{name}', which is none of the suite's"
                ));
            }
        }
        let first = methods.first().map(|m| &m.name);
        for name in self.error.iter().chain(&self.motions) {
            let case = cases.iter().find(|c| c.name == *name);
            let case = case.ok_or_else(|| {
                format!("the chart names the case '{name}', which is none of the suite's")
            })?;
            if let Some(m) = grouped().chain(first).find(|m| !case.is_for(m)) {
                return Err(format!(
                    "the chart needs the method '{m}' in the case '{name}', which leaves it out"
                ));
            }
        }
        if let Some(equal) = &self.equal_time {
            if let Some(first) = first.filter(|first| equal.methods.contains(first)) {
                return Err(format!(
                    "'{first}' is the suite's first method: others are made as fast as it is"
                ));
            }
            if let (Some(m), Some(first)) = (
                equal.methods.iter().find(|m| !grouped().any(|g| g == *m)),
                first,
            ) {
                return Err(format!(
                    "'{m}' is made as fast as '{first}', but in none of the chart's groups"
                ));
            }
            if equal.values.is_empty() || equal.values.len() > MAX_VALUES {
                return Err(format!("equal_time needs 1 to {MAX_VALUES} values"));
            }
            if !(0.0..=1.0).contains(&equal.tolerance) {
                return Err("the tolerance must be 0 to 1".into());
            }
        }
        Ok(self)
    }

    pub(super) fn keep(&mut self, stays: &dyn Fn(&String) -> bool) {
        self.groups
            .0
            .iter_mut()
            .for_each(|g| g.1.value.retain(stays));
        self.groups.0.retain(|g| !g.1.value.is_empty());
        self.equal_time
            .iter_mut()
            .for_each(|e| e.methods.retain(stays));
    }

    /// Settings for timing a method that has to match the first method's time.
    pub fn varied(&self, method: &str) -> Vec<Setting> {
        let own = self
            .equal_time
            .iter()
            .filter(|e| e.methods.iter().any(|m| m == method));
        let setting = |e: &EqualTime, v: &RawText| Setting {
            name: e.parameter.clone(),
            text: v.0.clone(),
        };
        own.flat_map(|e| e.values.iter().map(move |v| setting(e, v)))
            .collect()
    }

    /// The method at each of its values, or unchanged.
    pub fn variants(&self, method: &Method) -> Vec<Method> {
        let settings = self.varied(&method.name);
        let with = |s| Method {
            set: method.set.iter().chain([s]).cloned().collect(),
            ..method.clone()
        };
        if settings.is_empty() {
            vec![method.clone()]
        } else {
            settings.iter().map(with).collect()
        }
    }
}
