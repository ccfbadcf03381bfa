//! Positions of an experiment's fields in its file, for errors found when the fields are used.

use super::{Experiment, Field, spans};
use crate::diagnostics::{At, Diagnostic};
use std::path::Path;

impl Experiment {
    /// An error at the line of a field; `None` if the file does not set the field, or if something
    /// else, such as the command line, overrides it.
    pub(crate) fn error_in(&self, field: &str, message: impl Into<String>) -> Option<Diagnostic> {
        Some(self.sources.error(self.place_of(field)?, message))
    }

    fn place_of(&self, field: &str) -> Option<At> {
        let (path, text) = self.sources.texts().next()?;
        let entry = spans::body(text, 0)?
            .entries
            .into_iter()
            .find(|e| e.key == field)?;
        let at = At {
            file: 0,
            offset: u32::try_from(entry.value.start).ok()?,
        };
        let (field, mut written) = (Field::of(field)?, self.clone());
        let value = text.get(entry.value)?;
        field
            .set(
                &mut written,
                value,
                path.parent().unwrap_or(Path::new(".")),
                at,
            )
            .ok()?;
        (field.same)(&written, self).then_some(at)
    }
}
