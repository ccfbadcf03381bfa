//! Hashes of what steps read from outside the graph: uniform blocks by the bytes that shaders can
//! read, buffers whole.

use super::dataflow::StepFlow;
use super::{HASHER, hashed};
use crate::graph::interface::{ExternalKind, SceneInterface};
use crate::graph::link::{Linked, Target};
use crate::graph::plan::{Plan, Step};
use crate::shader::Resource;
use std::collections::BTreeSet;
use std::hash::{BuildHasher, Hash, Hasher};

/// External resources as steps read them.
pub(super) struct Externals {
    interface: &'static SceneInterface,
    /// Every distinct way to read one.
    reads: Vec<Read>,
    /// The hash of each read's bytes, and of the same bytes with frame counters at zero.
    hashes: Vec<[u64; 2]>,
    /// The last bytes of each uniform block, a hash of those of each buffer; empty before
    /// the first.
    contents: Vec<Vec<u8>>,
}

/// A step's read of a resource.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
struct Read {
    resource: usize,
    /// Byte ranges of a uniform block; everything if absent.
    bytes: Option<Vec<(u32, u32)>>,
}

impl Externals {
    /// Resources without content, and for each step the reads that it makes.
    pub fn new(
        interface: &'static SceneInterface,
        linked: &[Linked],
        plan: &Plan,
    ) -> (Externals, Vec<Vec<usize>>) {
        let by_step: Vec<BTreeSet<Read>> = plan
            .steps
            .iter()
            .map(|step| reads_of(step, &linked[step.pass], interface))
            .collect();
        let all: BTreeSet<Read> = by_step.iter().flatten().cloned().collect();
        let reads: Vec<Read> = all.into_iter().collect();
        let index = |read: &Read| reads.binary_search(read).unwrap_or(0);
        let by_step = by_step
            .iter()
            .map(|list| list.iter().map(index).collect())
            .collect();
        let externals = Externals {
            hashes: vec![[0; 2]; reads.len()],
            contents: vec![Vec::new(); interface.resources.len()],
            reads,
            interface,
        };
        (externals, by_step)
    }

    #[cfg(test)]
    pub fn of(reads: usize) -> Externals {
        let interface = Box::leak(Box::default());
        Externals {
            interface,
            reads: Vec::new(),
            hashes: vec![[0; 2]; reads],
            contents: Vec::new(),
        }
    }

    #[cfg(test)]
    pub fn set(&mut self, inputs: &[u64]) {
        self.hashes = inputs.iter().map(|input| [*input; 2]).collect();
    }

    /// New bytes of a resource, or of its part at an offset.
    pub fn update(&mut self, name: &str, at: Option<u64>, bytes: &[u8]) {
        let Some(index) = self.interface.index(name) else {
            return;
        };
        let resource = &self.interface.resources[index];
        self.contents[index] = match at {
            // The other parts are unknown here, so the old hash stays part of the new one. The same
            // bytes sent again therefore count as a change.
            Some(at) => hashed((&self.contents[index], at, bytes))
                .to_ne_bytes()
                .to_vec(),
            None if resource.kind == ExternalKind::Uniform => bytes.to_vec(),
            None => hashed(bytes).to_ne_bytes().to_vec(),
        };
        let content = &self.contents[index];
        let mut uncounted = content.clone();
        if let Some(counters) = uncounted.get_mut(resource.counters.clone()) {
            counters.fill(0);
        }
        for (read, hashes) in self.reads.iter().zip(&mut self.hashes) {
            if read.resource == index {
                *hashes = [read.hash_of(content), read.hash_of(&uncounted)];
            }
        }
    }

    /// A hash of a step's inputs: its external reads, and these versions.
    pub fn hashed(&self, step: &StepFlow, versions: impl Iterator<Item = u64>) -> u64 {
        self.inputs(step, versions, 0)
    }

    /// The same with frame counters at zero.
    pub fn hashed_without_counters(
        &self,
        step: &StepFlow,
        versions: impl Iterator<Item = u64>,
    ) -> u64 {
        self.inputs(step, versions, 1)
    }

    fn inputs(&self, step: &StepFlow, versions: impl Iterator<Item = u64>, which: usize) -> u64 {
        let mut hasher = HASHER.build_hasher();
        step.externals
            .iter()
            .for_each(|read| self.hashes[*read][which].hash(&mut hasher));
        versions.for_each(|version| version.hash(&mut hasher));
        hasher.finish()
    }
}

fn reads_of(step: &Step, link: &Linked, interface: &SceneInterface) -> BTreeSet<Read> {
    let mut reads = BTreeSet::new();
    for (bound, case) in link.bound.iter().zip(&step.cases) {
        if let Target::External(resource) = bound.cases[*case].target
            && !(step.still && interface.resources[resource].moves)
        {
            let bytes = bound
                .reads
                .clone()
                .filter(|_| bound.resource == Resource::Uniform);
            reads.insert(Read { resource, bytes });
        }
    }
    reads
}

impl Read {
    fn hash_of(&self, content: &[u8]) -> u64 {
        let within = |(first, end): &(u32, u32)| content.get(*first as usize..*end as usize);
        match self
            .bytes
            .as_ref()
            .map(|list| list.iter().map(within).collect::<Option<Vec<_>>>())
        {
            Some(Some(ranges)) => hashed(ranges),
            _ => hashed(content),
        }
    }
}
