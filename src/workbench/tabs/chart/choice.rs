//! What of a sweep is charted.

use super::folder::Folder;
use crate::campaign::report::{Data, Scored, pareto};
use crate::measure::reference::ALL_BOUNCES;
use crate::metrics::{METRICS, Metric};
use std::path::PathBuf;
use std::sync::Arc;

/// A subject, part and metric.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// Number of the subject in the folder's data.
    pub subject: usize,
    /// Part of the light; `PART, N bounces` for a further reference of a sweep.
    pub part: String,
    /// Metric.
    pub metric: &'static Metric,
}

impl Default for Choice {
    fn default() -> Choice {
        Choice {
            subject: 0,
            part: "total".into(),
            metric: &METRICS[0],
        }
    }
}

impl Choice {
    /// The graph's name of the part, and the bounces that it is compared at.
    pub fn part_and_bounces(&self, data: Option<&Data>) -> (String, u32) {
        let named = self.part.split_once(", ").and_then(|(part, bounces)| {
            Some((
                part.to_string(),
                bounces.strip_suffix(" bounces")?.parse().ok()?,
            ))
        });
        let first = data.and_then(|d| *d.bounces.get(self.subject)?);
        named.unwrap_or_else(|| (self.part.clone(), first.unwrap_or(ALL_BOUNCES)))
    }
}

/// The dots of a choice; worked out once.
#[derive(Default)]
pub struct Chosen {
    of: Option<(PathBuf, Choice)>,
    /// Points that have a score.
    pub dots: Vec<Scored>,
    /// Places in `dots` of the Pareto front, by time.
    pub front: Vec<usize>,
    /// Whether each dot is on it.
    pub on_front: Vec<bool>,
}

impl Chosen {
    /// Looks whether the choice is another one.
    pub fn refresh(&mut self, folder: Option<&Folder>, choice: &Choice) -> Option<Arc<Data>> {
        let data = folder.and_then(|f| f.data.as_ref()?.as_ref().ok().cloned());
        let of = folder
            .filter(|_| data.is_some())
            .map(|f| (f.path.clone(), choice.clone()));
        if of != self.of {
            self.of = of;
            self.dots = data.as_ref().map_or(Vec::new(), |d| {
                d.scored(choice.subject, &choice.part, choice.metric)
            });
            self.front = pareto(
                &self
                    .dots
                    .iter()
                    .map(|d| (d.ms, d.error))
                    .collect::<Vec<_>>(),
            );
            self.on_front = vec![false; self.dots.len()];
            self.front.iter().for_each(|i| self.on_front[*i] = true);
        }
        data
    }

    /// Works it out again, though the choice is the same.
    pub fn forget(&mut self) {
        self.of = None;
    }
}
