//! The number of frames in which a picture converges. Groups of passes that accumulate over frames
//! declare their count (`settles`, `converges`); a group starts from the result of the group before
//! it, so the counts are summed.

use super::data::{Convergence, Plan};
use crate::diagnostics::At;
use crate::graph::definition::Res;
use std::collections::BTreeMap;

/// Frames for a texture with a history if the pass that reads it declares nothing.
const UNDECLARED: u32 = 32;

/// Frames that passes declare, by pass number: the place of the expression, which a group shares,
/// and its value.
pub(super) type Declared = BTreeMap<usize, (At, u32)>;

/// The frames until the steps of a plan have converged.
pub(super) fn frames(plan: &Plan, settles: &Declared, converges: &Declared) -> Convergence {
    let (mut fresh, mut changed, mut undeclared) = (BTreeMap::new(), BTreeMap::new(), 1);
    for step in &plan.steps {
        let (rests, ends) = (settles.get(&step.pass), converges.get(&step.pass));
        let reads_history = || {
            step.uses
                .iter()
                .any(|u| matches!(u.res, Res::Texture(_, true)))
        };
        match (ends.or(rests), rests.or(ends)) {
            (Some(first), Some(later)) => {
                fresh.insert(first.0, first.1);
                changed.insert(later.0, later.1);
            }
            _ if reads_history() => undeclared = UNDECLARED,
            _ => {}
        }
    }
    let sum = |groups: BTreeMap<At, u32>| {
        groups
            .into_values()
            .fold(0, u32::saturating_add)
            .max(undeclared)
    };
    Convergence {
        fresh: sum(fresh),
        changed: sum(changed),
    }
}
