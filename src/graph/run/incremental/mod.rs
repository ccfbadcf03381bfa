//! Incremental execution: skips steps that would write the content that their outputs hold already.
//! Pictures are equal, to the bit, to those of full execution.
//!
//! A step is one execution of a pass; a pass may have several. Every *part*, a mip of a texture or
//! a buffer, has a *version*: a hash h of the step that wrote it and of that step's inputs. Inputs
//! are the versions of the parts that it reads, and hashes of bytes from outside the graph. Equal
//! versions are equal contents (but for collisions of 64-bit hashes). A frame is first simulated on
//! versions alone. Then the steps run that write parts with new versions, and the steps that these
//! need because an input is not in memory.
//!
//! ```text
//! graph:    clear   writes A
//!           light   reads A and the lamps, writes B
//!           shade   reads B and the camera, writes C
//!
//! frame 1:  A = h(clear)    B = h(light, A, lamps)    C = h(shade, B, camera)
//!           all versions are new: all run
//! frame 2:  the camera moves, so C = h(shade, B, camera') is new: shade runs
//! frame 3:  a lamp changes, so B = h(light, A, lamps') and with it C are new: light and shade run.
//!           A has its version already: clear is skipped
//!
//! If A is transient (it shares memory with other parts and holds nothing between frames), frame 3
//! runs clear too, because light needs A.
//! ```
//!
//! Authors of graphs need to declare nothing for this. `still` and `replaces` of a pass say what its
//! shaders do not show. A step that reads the frame count, or its own output
//! of the last frame, gets a new version in every frame, so it runs in every frame. A graph may
//! declare that a *group* of such steps converges (`settles`): the group stops after that number
//! of frames in which its inputs did not change ([`converge`]).
//!
//! - [`version`]: versions, and how writes change them
//! - [`external`]: hashes of inputs from outside the graph
//! - [`dataflow`]: dependencies between steps, and the steps that have to run
//! - [`converge`]: groups of steps that stop

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
use dataflow::{Dataflow, Ready};
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
    /// Passes with output that may change. Pictures are equal, to the bit, to those of full
    /// execution.
    #[serde(alias = "changed")]
    #[value(alias = "changed")]
    Incremental,
}

/// The versions that all parts hold, and what decides about the next frame.
pub(super) struct Versions {
    /// The version that each part holds between frames.
    held: Vec<Version>,
    externals: Externals,
    /// The data flow of even frames, then of odd ones: the two copies of resources with a history
    /// swap.
    dataflow: [Dataflow; 2],
    groups: Vec<Group>,
}

/// The work of a frame.
#[derive(PartialEq, Eq)]
pub(super) struct Frame {
    /// Whether each step runs.
    pub runs: Vec<bool>,
    /// Whether each group has converged and last frame's copies of its output are copied to those
    /// of this frame. In full execution this replaces the output of the group.
    pub carries: Vec<bool>,
}

/// The result of simulating a frame on versions.
struct Simulated {
    /// The version of each part at the end of the frame.
    now: Vec<Version>,
    ready: Ready,
    /// Hashes of the inputs, by group and step of its ring ([`Group::ring`]).
    inputs: Vec<Vec<u64>>,
}

/// A hash that is the same in every run of the program.
fn hashed(value: impl Hash) -> u64 {
    HASHER.hash_one(value)
}

const HASHER: foldhash::quality::FixedState = foldhash::quality::FixedState::with_seed(0);

impl Versions {
    /// Versions of parts with unknown contents, so that every part is written once.
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

    /// New bytes of an external resource, or of its bytes from an offset on, from the next frame
    /// on.
    pub(super) fn update(&mut self, name: &str, at: Option<u64>, bytes: &[u8]) {
        self.externals.update(name, at, bytes);
    }

    /// The work of the next frame. Afterwards versions are those at its end. In full execution
    /// converged groups run too, and last frame's output replaces theirs: pictures are the same,
    /// and times are of all work.
    pub(super) fn frame(&mut self, odd: bool, execution: Execution) -> Frame {
        let flow = &self.dataflow[usize::from(odd)];
        let mut converged: Vec<bool> = self.groups.iter().map(Group::has_converged).collect();
        let simulated = loop {
            let simulated = self.simulate(flow, &converged);
            // An input of a ring step up to the group's last step restarts the group in this frame.
            // An input of a later ring step restarts it in the next. One group may be an input of
            // another, so the frame is simulated again.
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

    /// Whether every group has converged. A change before the next frame may restart one.
    pub(super) fn have_converged(&self) -> bool {
        self.groups.iter().all(Group::has_converged)
    }

    /// The steps that run and the histories that are copied, so that all parts get the versions of
    /// a simulated frame.
    fn changes(&self, flow: &Dataflow, simulated: &Simulated, converged: &[bool]) -> Frame {
        let is_new =
            |part: usize| !flow.transient[part] && simulated.now[part].id != self.held[part].id;
        let mut stopped = vec![false; flow.steps.len()];
        for (group, _) in self
            .groups
            .iter()
            .zip(converged)
            .filter(|(_, converged)| **converged)
        {
            group.steps.iter().for_each(|step| stopped[*step] = true);
        }
        let carries = |(copies, converged): (&Vec<(usize, usize)>, &bool)| {
            *converged && copies.iter().any(|(this, _)| is_new(*this))
        };
        Frame {
            runs: flow.steps_to_run(&simulated.ready, &stopped, is_new),
            carries: flow.carried.iter().zip(converged).map(carries).collect(),
        }
    }

    /// Simulates a frame in which these groups have converged.
    fn simulate(&self, flow: &Dataflow, converged: &[bool]) -> Simulated {
        let mut now = self.held.clone();
        let mut inputs = vec![Vec::new(); self.groups.len()];
        let mut ready = Vec::with_capacity(flow.steps.len());
        for (i, step) in flow.steps.iter().enumerate() {
            let is_held = |part: usize| !flow.transient[part] && now[part].id == self.held[part].id;
            ready.push(step.reads.iter().map(|read| is_held(read.part)).collect());
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
        Simulated { now, ready, inputs }
    }
}
