//! Mistakes in the files of a graph, and names that they may have hidden.

use crate::diagnostics::{At, Diagnostic, Sources};

/// Findings so far.
#[derive(Default)]
pub(super) struct Findings {
    pub sources: Sources,
    pub errors: Vec<Diagnostic>,
    /// Names in items that could not be read: not reported again where they are used.
    pub broken: Vec<String>,
    /// Whether some file could not be read. Then any unknown name may be one of those in it.
    pub partial: bool,
}

impl Findings {
    pub fn error(&mut self, at: At, message: impl Into<String>) {
        self.help(at, message, None);
    }

    pub fn help(&mut self, at: At, message: impl Into<String>, help: Option<String>) {
        self.errors.push(self.sources.error(at, message).help(help));
    }

    /// Whether an unknown name is a mistake of its own, and not a consequence of a reported one.
    pub fn is_unknown(&self, name: &str) -> bool {
        !self.partial && !self.broken.iter().any(|b| b == name)
    }

    /// An error for a name that is not known, with the nearest of those that are.
    pub fn unknown<'n>(
        &mut self,
        at: At,
        name: &str,
        message: impl Into<String>,
        known: impl IntoIterator<Item = &'n str>,
    ) {
        if self.is_unknown(name) {
            self.errors
                .push(self.sources.error(at, message).nearest(name, known));
        }
    }
}
