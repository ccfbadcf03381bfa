//! The references of a sweep's points.

use super::list::SweepPoint;
use super::run::Progress;
use crate::lab::{Lab, LabError};
use crate::measure::Warm;
use crate::measure::reference::{GRAPH, Goal, Reference, find, gather};
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::Arc;

/// Most references in memory: one of 1920x1080 takes about 125 MB.
const MAX_REFERENCES: usize = 8;

/// References by number of bounces, each read, or gathered, once.
pub(super) struct References<'s> {
    bounces: &'s [u32],
    /// Samples a pixel that are gathered first.
    samples: Option<u64>,
    found: BTreeMap<String, Vec<(u32, Arc<Reference>)>>,
}

impl<'s> References<'s> {
    pub fn new(bounces: &'s [u32], samples: Option<u64>) -> References<'s> {
        References { bounces, samples, found: BTreeMap::new() }
    }

    /// The references that a point is scored against, as far as there are any.
    pub fn get(
        &mut self,
        lab: &Lab,
        warm: &mut Warm,
        point: &SweepPoint,
        on_progress: &mut dyn FnMut(Progress),
    ) -> Result<Vec<(u32, Arc<Reference>)>, LabError> {
        if point.absent.is_some() {
            return Ok(Vec::new());
        }
        let key = key(lab, warm, point)?;
        if let Some(found) = self.found.get(&key) {
            return Ok(found.clone());
        }
        if self.found.len() >= MAX_REFERENCES {
            self.found.clear();
        }
        let mut list = Vec::new();
        for bounces in self.bounces {
            let found = match self.samples {
                Some(samples) => {
                    Some(gather(lab, &point.experiment, &point.scene, *bounces, Goal::Samples(samples), &mut |now| {
                        on_progress(Progress::Gathers(now));
                        ControlFlow::Continue(())
                    })?)
                }
                None => find(&lab.home, &point.experiment, &point.scene, *bounces)?,
            };
            list.extend(found.map(|r| (*bounces, Arc::new(r))));
        }
        self.found.insert(key, list.clone());
        Ok(list)
    }
}

/// What the reference of a point depends on: what is looked at, and the parameters that its graph shares with that of
/// references.
fn key(lab: &Lab, warm: &mut Warm, point: &SweepPoint) -> Result<String, LabError> {
    let shared = warm.graph(&lab.home, GRAPH)?.graph.params.clone();
    let own = &warm.graph(&lab.home, &point.experiment.graph)?.graph.params;
    let params = point.experiment.params_over(own)?;
    let values = params.list.iter().zip(&params.values).filter(|(p, _)| shared.index(&p.name).is_some());
    let values: Vec<String> = values.map(|(p, v)| format!("{}={v}", p.name)).collect();
    Ok(format!("{:?} {}", point.subject, values.join(" ")))
}
