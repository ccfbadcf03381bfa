//! Incremental execution: skips steps that would write what their outputs hold already, with
//! pictures equal to the bit.
//!
//! Every part, a mip of a texture or a buffer, has a *version*: a hash of the step that wrote it
//! and of that step's inputs. The inputs are versions of parts and hashes of external bytes, so
//! equal versions are equal contents. A frame is first simulated on versions alone. Then only steps
//! with new versions of their outputs run.
//!
//! ```text
//! graph:    clear   writes A
//!           light   reads A and the lamps, writes B
//!           shade   reads B and the camera, writes C
//! frame 1:  A = h(clear)   B = h(light, A, lamps)   C = h(shade, B, camera)         all new: all run
//! frame 2:  the camera moves: A, B as before        C = h(shade, B, camera') new    shade runs
//! frame 3:  a lamp changes: B = h(light, A, lamps') new, so C is new                light and shade run
//!           clear: A holds version h(clear) still                                   skipped
//! frame 4:  if A shares memory with other parts, it holds nothing between frames    clear runs if light does
//! ```
//!
//! Nothing is declared for this. A step that reads the frame count, or its own output, gets a new
//! version in every frame, unless its group has converged ([`converge`]).
//!
//! - [`version`]: versions, and how writes change them
//! - [`external`]: hashes of inputs from outside the graph
//! - [`dataflow`]: dependencies between steps, and the steps that have to run
//! - [`converge`]: groups of steps that stop after a number of frames without a change

mod converge;
mod dataflow;
mod external;
#[cfg(test)]
mod tests;
mod version;

use crate::graph::interface::SceneInterface;
use crate::graph::link::Linked;
use crate::graph::plan::{Places, Plan};
use converge::Group;
use dataflow::{Dataflow, Held};
use external::Externals;
use std::hash::{BuildHasher, Hash};
use version::Version;

/// Which passes a frame runs.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    serde::Serialize,
    serde::Deserialize,
    clap::ValueEnum,
)]
#[serde(rename_all = "snake_case")]
pub enum Execution {
    /// All.
    #[default]
    #[serde(alias = "all")]
    #[value(alias = "all")]
    Full,
    /// Passes with output that would change; pictures are equal to the bit.
    #[serde(alias = "changed")]
    #[value(alias = "changed")]
    Incremental,
}

/// Versions of all parts, from frame to frame.
pub(super) struct Versions {
    held: Vec<Version>,
    externals: Externals,
    /// In even and in odd frames, which swap the copies of resources with a history.
    dataflow: [Dataflow; 2],
    groups: Vec<Group>,
}

/// The work of a frame.
#[derive(PartialEq, Eq)]
pub(super) struct Frame {
    /// By step.
    pub runs: Vec<bool>,
    /// By convergence group: whether it has converged and copies its history to this frame.
    pub carries: Vec<bool>,
}

/// A frame simulated on versions.
struct Simulated {
    now: Vec<Version>,
    held: Held,
    /// Hashes of the inputs, by group and step of its ring.
    inputs: Vec<Vec<u64>>,
}

/// A hash that is the same in every run of the program.
fn hashed(value: impl Hash) -> u64 {
    HASHER.hash_one(value)
}

const HASHER: foldhash::quality::FixedState = foldhash::quality::FixedState::with_seed(0);

impl Versions {
    /// Versions of parts with unknown contents: every step runs once.
    pub(super) fn new(
        interface: &'static SceneInterface,
        linked: &[Linked],
        plan: &Plan,
    ) -> Versions {
        let places = Places::new(plan);
        let (externals, read_by) = Externals::new(interface, linked, plan);
        let dataflow = [false, true].map(|odd| Dataflow::new(plan, &read_by, &places, odd));
        let groups = plan
            .settling
            .iter()
            .map(|group| Group::new(group, &dataflow))
            .collect();
        Versions::of(externals, dataflow, groups)
    }

    fn of(externals: Externals, dataflow: [Dataflow; 2], groups: Vec<Group>) -> Versions {
        let unknown = |part| Version::unknown(hashed(("unknown", part)));
        let held = (0..dataflow[0].transient.len()).map(unknown).collect();
        Versions {
            held,
            externals,
            dataflow,
            groups,
        }
    }

    /// New bytes of an external resource, or of its part at an offset, from the next frame on.
    pub(super) fn update(&mut self, name: &str, at: Option<u64>, bytes: &[u8]) {
        self.externals.update(name, at, bytes);
    }

    /// The work of the next frame. Afterwards versions are those at its end. In full execution
    /// converged groups run too, and their output is discarded: pictures are the same, and times
    /// are of all work.
    pub(super) fn frame(&mut self, odd: bool, execution: Execution) -> Frame {
        let flow = &self.dataflow[usize::from(odd)];
        let mut converged: Vec<bool> = self.groups.iter().map(Group::has_converged).collect();
        let simulated = loop {
            let simulated = self.simulate(flow, &converged);
            // A change before the group's last step restarts it in this frame, a later one in the
            // next.
            let restarts =
                |k: &usize| converged[*k] && self.groups[*k].differs(&simulated.inputs[*k]);
            let restarted: Vec<usize> = (0..converged.len()).filter(restarts).collect();
            if restarted.is_empty() {
                break simulated;
            }
            restarted.iter().for_each(|k| converged[*k] = false);
        };
        let frame = match execution {
            Execution::Full => Frame {
                runs: vec![true; flow.steps.len()],
                carries: converged,
            },
            Execution::Incremental => self.changes(flow, &simulated, &converged),
        };
        for (group, inputs) in self.groups.iter_mut().zip(simulated.inputs) {
            group.count(inputs);
        }
        self.held = simulated.now;
        frame
    }

    /// Whether every group has converged, unless something changes before the next frame.
    pub(super) fn have_converged(&self) -> bool {
        self.groups.iter().all(Group::has_converged)
    }

    /// The steps and copies that lead to the versions of a simulated frame.
    fn changes(&self, flow: &Dataflow, simulated: &Simulated, converged: &[bool]) -> Frame {
        let is_new =
            |part: usize| !flow.transient[part] && simulated.now[part].id != self.held[part].id;
        let mut skipped = vec![false; flow.steps.len()];
        for (group, _) in self
            .groups
            .iter()
            .zip(converged)
            .filter(|(_, converged)| **converged)
        {
            group.steps.iter().for_each(|step| skipped[*step] = true);
        }
        let carries = |(copies, converged): (&Vec<(usize, usize)>, &bool)| {
            *converged && copies.iter().any(|(this, _)| is_new(*this))
        };
        Frame {
            runs: flow.steps_to_run(&simulated.held, &skipped, is_new),
            carries: flow.carried.iter().zip(converged).map(carries).collect(),
        }
    }

    /// The versions at the end of a frame in which these groups have converged.
    fn simulate(&self, flow: &Dataflow, converged: &[bool]) -> Simulated {
        let mut now = self.held.clone();
        let mut inputs = vec![Vec::new(); self.groups.len()];
        let mut held = Vec::with_capacity(flow.steps.len());
        for (i, step) in flow.steps.iter().enumerate() {
            let is_held = |part: usize| !flow.transient[part] && now[part].id == self.held[part].id;
            held.push(step.reads.iter().map(|read| is_held(read.part)).collect());
            for (group, inputs) in self.groups.iter().zip(&mut inputs) {
                if group.ring.binary_search(&i).is_ok() {
                    let others = step.reads.iter().filter(|read| !group.own[read.part]);
                    let versions = others.map(|read| now[read.part].id);
                    inputs.push(self.externals.hashed_without_counters(step, versions));
                }
            }
            let mut is_skipped = false;
            for (k, group) in self
                .groups
                .iter()
                .enumerate()
                .filter(|(k, _)| converged[*k])
            {
                is_skipped |= group.steps.contains(&i);
                if group.steps.last() == Some(&i) {
                    flow.carried[k]
                        .iter()
                        .for_each(|(this, last)| now[*this] = now[*last].clone());
                }
            }
            if !is_skipped {
                let versions = step.reads.iter().map(|read| now[read.part].id);
                let input = hashed((i, self.externals.hashed(step, versions)));
                for write in &step.writes {
                    now[write.to.part].write(hashed((input, write.target)), write.replaces);
                }
            }
        }
        Simulated { now, held, inputs }
    }
}
