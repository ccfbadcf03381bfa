//! The parts of a picture's light, as pictures of their own.

use super::{LabError, Session};
use crate::graph::Graph;
use crate::metrics::Linear;
use std::collections::BTreeMap;

/// The (part, texture) pairs of a graph; one without parts has its linear picture as `total`.
pub fn parts_of(graph: &Graph) -> Vec<(String, String)> {
    match &graph.hdr {
        Some(hdr) if graph.parts.is_empty() => vec![("total".into(), hdr.clone())],
        _ => graph.parts.clone(),
    }
}

impl Session {
    /// The parts of the last frame's light. Only those are there whose textures were `wanted` and that the present
    /// parameters make.
    ///
    /// # Errors
    /// The device was lost.
    pub fn parts(&mut self) -> Result<BTreeMap<String, Linear>, LabError> {
        let mut parts = BTreeMap::new();
        for (part, texture) in parts_of(&self.graph) {
            let index = self.graph.texture(&texture);
            let made = index.is_some_and(|i| !self.program.plan.textures[i].usage.is_empty());
            if made && self.wanted.contains(&texture) {
                parts.insert(part, self.texels(&texture, 0, 0)?.linear());
            }
        }
        Ok(parts)
    }
}
