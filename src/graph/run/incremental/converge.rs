//! Convergence groups: steps that accumulate over frames and stop after a declared number of frames
//! without a change.

use super::dataflow::Dataflow;
use crate::graph::plan::Settling;

/// A group and its state.
pub(super) struct Group {
    /// Its steps, in order.
    pub steps: Vec<usize>,
    /// These and all steps through which their output returns to them, in order.
    pub ring: Vec<usize>,
    /// By part: whether the ring writes it. These parts change while the group accumulates, so they
    /// are no input.
    pub own: Vec<bool>,
    /// By step of the ring: a hash of its inputs in the last frame, except own parts and frame
    /// counters.
    inputs: Vec<u64>,
    /// Frames since these inputs changed.
    frames: u32,
    /// Frames without a change until the group stops.
    needed: u32,
}

impl Group {
    /// A group that has not run.
    pub fn new(group: &Settling, dataflow: &[Dataflow; 2]) -> Group {
        let mut own = vec![false; dataflow[0].transient.len()];
        for flow in dataflow {
            let writes = group.ring.iter().flat_map(|step| &flow.steps[*step].writes);
            writes.for_each(|write| own[write.to.part] = true);
        }
        Group {
            steps: group.steps.clone(),
            ring: group.ring.clone(),
            own,
            inputs: Vec::new(),
            frames: 0,
            needed: group.frames,
        }
    }

    /// Whether it has stopped, unless its inputs differ in the next frame.
    pub fn has_converged(&self) -> bool {
        self.frames >= self.needed
    }

    /// Whether these inputs differ from the last frame's, up to the last step of the group itself.
    pub fn differs(&self, inputs: &[u64]) -> bool {
        let before = self
            .ring
            .iter()
            .take_while(|step| Some(*step) <= self.steps.last())
            .count();
        inputs[..before] != self.inputs[..before]
    }

    /// Counts a frame with these inputs.
    pub fn count(&mut self, inputs: Vec<u64>) {
        self.frames = if self.inputs == inputs {
            self.frames.saturating_add(1)
        } else {
            0
        };
        self.inputs = inputs;
    }
}
