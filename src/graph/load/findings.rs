//! Mistakes in the files of a graph, and what they may have hidden.

use crate::diagnostics::{At, Diagnostic, Sources};

/// What was found so far.
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

    /// Whether a name that is not known is a mistake of its own, and not what is left of one that was reported.
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
