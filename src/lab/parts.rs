//! The parts of a picture's light, as pictures of their own.

use super::{LabError, Session};
use crate::graph::{Graph, LightPart};
use crate::metrics::{Kind, Linear};
use std::collections::BTreeMap;

/// The parts of a graph; one without parts has its linear picture as `total`.
pub fn parts_of(graph: &Graph) -> Vec<LightPart> {
    match &graph.hdr {
        Some(hdr) if graph.parts.is_empty() => vec![LightPart {
            name: "total".into(),
            texture: hdr.clone(),
            kind: Kind::Radiance,
            title: "total".into(),
            focus: false,
        }],
        _ => graph.parts.clone(),
    }
}

/// The part that methods are looked at for, besides the total.
pub fn focus_of(graph: &Graph) -> Option<&LightPart> {
    graph.parts.iter().find(|p| p.focus)
}

impl Session {
    /// The light components of the last frame: those with `wanted` textures that the present
    /// parameters make.
    ///
    /// # Errors
    /// The device was lost.
    pub fn parts(&mut self) -> Result<BTreeMap<String, Linear>, LabError> {
        let mut parts = BTreeMap::new();
        for LightPart {
            name,
            texture,
            kind,
            ..
        } in parts_of(&self.graph)
        {
            let index = self.graph.texture(&texture);
            let made = index.is_some_and(|i| !self.program.plan.textures[i].usage.is_empty());
            if made && self.wanted.contains(&texture) {
                parts.insert(
                    name,
                    Linear {
                        kind,
                        ..self.texels(&texture, 0, 0)?.linear()
                    },
                );
            }
        }
        Ok(parts)
    }
}
