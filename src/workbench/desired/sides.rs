//! A and B: beginning and end of a comparison, and their differences.

use super::edit;
use super::request::SideRequest;
use crate::graph::param::Value;
use crate::workbench::{Workbench, short};

/// A before a comparison, and as the comparison changed it.
pub(crate) type Alone = Option<(SideRequest, SideRequest)>;

/// Most parameters that are named.
const NAMED: usize = 2;

impl Workbench {
    /// A side with another graph: it keeps the settings that the graph has too.
    pub(crate) fn with_graph(&self, side: &SideRequest, graph: &str) -> SideRequest {
        let mut side = SideRequest {
            graph: graph.into(),
            ..side.clone()
        };
        if let Ok(graph) = self.setup.home.read(graph) {
            let fits = |(name, value): &(String, Value)| {
                let param = graph.params.param(name);
                param.is_some_and(|p| p.fit(value).is_some())
            };
            side.params.retain(fits);
            side.off.retain(|pass| graph.params.passes.contains(pass));
        }
        side
    }

    /// Shows two sides next to each other.
    pub(crate) fn compare_sides(&mut self, sides: [Option<SideRequest>; 2]) {
        let now = self.desired.sides[0].clone();
        // A comparison that follows another ends with the state before the first.
        let first = self
            .alone
            .take()
            .filter(|(_, made)| self.desired.sides[1].is_some() && now.as_ref() == Some(made));
        let before = first.map(|(before, _)| before).or(now);
        self.alone = before.zip(sides[0].clone());
        self.desired.sides = sides;
        self.panel.side = 1;
    }

    /// Shows A alone: as it was before the comparison, unless it was edited since.
    pub(crate) fn end_comparison(&mut self) {
        self.desired.sides[1] = None;
        if let Some((before, made)) = self.alone.take()
            && self.desired.sides[0].as_ref() == Some(&made)
        {
            self.desired.sides[0] = Some(before);
        }
    }

    /// The differences of A and B, a few words each; empty if they are equal, or without B.
    pub(crate) fn sides_in_words(&self) -> [String; 2] {
        let [Some(a), Some(b)] = &self.desired.sides else {
            return Default::default();
        };
        if a.graph != b.graph {
            return [a, b].map(|side| short(&side.graph));
        }
        let Some(info) = &self.sides[0].info else {
            return Default::default();
        };
        let mut words = [Vec::new(), Vec::new()];
        let off = [(&a.off, &b.off), (&b.off, &a.off)];
        for (words, (own, other)) in words.iter_mut().zip(off) {
            for (with, in_one, in_two) in [("without", own, other), ("with", other, own)] {
                let passes = in_one.iter().filter(|pass| !in_two.contains(pass));
                let passes: Vec<&str> = passes.map(String::as_str).collect();
                words.extend((!passes.is_empty()).then(|| format!("{with} {}", passes.join(", "))));
            }
        }
        let mut seen: Vec<&str> = Vec::new();
        let mut more = false;
        for (name, _) in a.params.iter().chain(&b.params) {
            let Some(param) = info.graph.params.param(name) else {
                continue;
            };
            let values = [a, b].map(|side| edit::value(side, param));
            if seen.contains(&name.as_str()) || values[0] == values[1] {
                continue;
            }
            seen.push(name);
            more |= words[0].len() >= NAMED;
            for (words, value) in words.iter_mut().zip(&values) {
                if words.len() < NAMED {
                    words.push(format!("{name} {value}"));
                }
            }
        }
        words.map(|w| format!("{}{}", w.join(", "), if more { ", …" } else { "" }))
    }
}
