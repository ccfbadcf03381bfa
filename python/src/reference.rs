//! Path-traced references.

use crate::memory::Memory;
use conelab::measure::reference::{Reference as Traced, ReferencePart};
use conelab::metrics::Kind;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::{PyResult, pyclass, pymethods};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A reference with its parts.
#[pyclass(frozen, module = "conelab._conelab")]
pub struct Reference(pub Arc<Traced>);

impl Reference {
    fn of(&self, part: &str) -> PyResult<&ReferencePart> {
        let found = self.0.parts.get(part);
        found.ok_or_else(|| PyKeyError::new_err(part.to_string()))
    }
}

/// The word for a kind of picture.
pub fn word(kind: Kind) -> &'static str {
    match kind {
        Kind::Direct => "direct",
        Kind::Radiance => "radiance",
        Kind::Openness => "openness",
        Kind::Displayed => "displayed",
    }
}

#[pymethods]
impl Reference {
    #[getter]
    fn samples(&self) -> u64 {
        self.0.samples
    }

    #[getter]
    fn folder(&self) -> String {
        self.0.folder.to_string_lossy().into_owned()
    }

    /// Names of the parts with their kinds.
    fn parts(&self) -> Vec<(String, &'static str)> {
        let parts = self.0.parts.iter();
        parts
            .map(|(name, p)| (name.clone(), word(p.mean.kind)))
            .collect()
    }

    /// The mean of a part, shared.
    fn mean(&self, part: &str) -> PyResult<Memory> {
        Ok(Memory::shared(self.0.clone(), &self.of(part)?.mean))
    }

    /// Noise of a part: relMSE between its halves, FLIP and structure error of its mean.
    fn noise(&self, part: &str) -> PyResult<BTreeMap<&'static str, f64>> {
        let noise = self.of(part)?.noise;
        Ok(BTreeMap::from([
            ("relmse", noise.relmse),
            ("flip", noise.flip),
            ("structure", noise.structure),
        ]))
    }
}
