//! Expressions of a graph as numbers.

use crate::diagnostics::{At, Diagnostic};
use crate::graph::evaluated::Evaluated;
use crate::graph::expr::{Env, Ex};

/// What expressions are, and the mistakes that this brings up, each once.
pub(super) struct Numbers<'a> {
    pub set: &'a Evaluated<'a>,
    pub env: Env,
    pub errors: Vec<Diagnostic>,
}

impl<'a> Numbers<'a> {
    pub fn new(set: &'a Evaluated<'a>) -> Numbers<'a> {
        Numbers {
            set,
            env: set.env.clone(),
            errors: Vec::new(),
        }
    }

    pub fn error(&mut self, at: At, message: String) {
        self.find(self.set.graph.sources.error(at, message));
    }

    pub fn find(&mut self, found: Diagnostic) {
        if !self.errors.contains(&found) {
            self.errors.push(found);
        }
    }

    pub fn value(&mut self, ex: &Ex) -> f64 {
        ex.value.eval(&self.env).unwrap_or_else(|why| {
            self.error(ex.at, format!("'{}': {why}", ex.value.text));
            0.0
        })
    }

    pub fn holds(&mut self, ex: &Ex) -> bool {
        self.value(ex) != 0.0
    }

    /// A whole number of at least `low`.
    pub fn count(&mut self, ex: &Ex, low: u32, what: &str) -> u32 {
        let before = self.errors.len();
        let value = self.value(ex);
        if self.errors.len() > before {
            return low;
        }
        let rounded = (value + 1e-9).floor();
        if rounded < f64::from(low) || rounded > f64::from(i32::MAX) {
            self.error(
                ex.at,
                format!(
                    "{what} '{}' is {value}, and must be at least {low}",
                    ex.value.text
                ),
            );
            return low;
        }
        rounded as u32
    }

    /// The first case with a true condition; the last one has no condition.
    pub fn case<'e>(&mut self, conditions: impl ExactSizeIterator<Item = Option<&'e Ex>>) -> usize {
        let last = conditions.len().saturating_sub(1);
        conditions
            .enumerate()
            .find(|(_, when)| when.is_none_or(|ex| self.holds(ex)))
            .map_or(last, |(i, _)| i)
    }
}
