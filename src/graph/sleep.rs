//! Which steps of a frame would write again what is there already. Every texture mip and buffer has an id of its content, made
//! of the step that wrote it and of all that this step read: the ids of its inputs, and the bytes of uniform blocks that its
//! shaders can read. A frame is gone through with ids alone first, and what comes out with the ids that are held already
//! sleeps. Nothing is declared for it; what depends on a count of frames, or on itself, never sleeps.

use super::externals::{EXTERNALS, ExternalKind};
use super::link::{Linked, Target};
use super::plan::{Plan, Step};
use super::usage::{Res, Use};
use crate::shader::Resource;
use std::collections::BTreeSet;
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};

/// What a mip of a texture or a buffer holds.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Content {
    /// The last that replaced it or changed it.
    base: u64,
    /// Who stored into it since and read nothing of it, the last one last. A store that is repeated changes nothing, and covers
    /// all that the same store left before: each stands here once.
    stores: Vec<u64>,
}

/// Beyond so many stores the first ones are taken for a base.
const MOST_STORES: usize = 8;

/// An external resource as a step reads it.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
struct Reads {
    external: usize,
    /// Bytes of a uniform block; none: all.
    bytes: Option<Vec<(u32, u32)>>,
}

/// Ids of all content, from frame to frame.
pub(super) struct Contents {
    held: Vec<Content>,
    /// Where the parts of each texture's two copies begin in `held`: a part a mip. Those of buffers follow, one a copy.
    textures: Vec<[usize; 2]>,
    buffers: usize,
    /// What steps read of externals, each of them once.
    reads: Vec<Reads>,
    /// For each step, which of those.
    of_step: Vec<Vec<usize>>,
    /// Last bytes of uniform blocks, and a hash of those of other buffers; empty before the first are sent.
    externals: Vec<Vec<u8>>,
}

fn hashed(value: impl Hash) -> u64 {
    // The keys of this one are the same in every run.
    let mut hasher = DefaultHasher::new();
    value.hash(&mut hasher);
    hasher.finish()
}

impl Contents {
    /// Of resources that hold anything: each step runs once.
    pub(super) fn new(linked: &[Linked], plan: &Plan) -> Contents {
        let mut parts = 0;
        let mut next = |count: usize| {
            parts += count;
            parts - count
        };
        let textures = plan.textures.iter().map(|t| [next(t.mips as usize), next(t.mips as usize)]).collect();
        let buffers = next(2 * plan.buffers.len());
        let read_by = |step: &Step| {
            let bound = linked[step.pass].bound.iter().zip(&step.cases);
            let reads: BTreeSet<Reads> = bound
                .filter_map(|(bound, case)| match bound.cases[*case].target {
                    Target::External(external) => {
                        let bytes = bound.reads.clone().filter(|_| bound.resource == Resource::Uniform);
                        Some(Reads { external, bytes })
                    }
                    _ => None,
                })
                .collect();
            reads
        };
        let of_steps: Vec<BTreeSet<Reads>> = plan.steps.iter().map(read_by).collect();
        let reads: Vec<Reads> = of_steps.iter().flatten().cloned().collect::<BTreeSet<_>>().into_iter().collect();
        let number = |r: &Reads| reads.binary_search(r).unwrap_or(0);
        let of_step = of_steps.iter().map(|list| list.iter().map(number).collect()).collect();
        Contents {
            held: (0..parts).map(|i| Content { base: hashed(("unknown", i)), stores: Vec::new() }).collect(),
            textures,
            buffers,
            reads,
            of_step,
            externals: vec![Vec::new(); EXTERNALS.len()],
        }
    }

    /// New bytes of an external resource, from the next frame on.
    pub(super) fn update(&mut self, name: &str, bytes: &[u8]) {
        if let Some(i) = EXTERNALS.iter().position(|e| e.name == name) {
            self.externals[i] = match EXTERNALS[i].kind {
                ExternalKind::Uniform => bytes.to_vec(),
                _ => hashed(bytes).to_ne_bytes().to_vec(),
            };
        }
    }

    /// Which steps of the next frame have work to do; from then on content is as after that frame.
    pub(super) fn frame(&mut self, plan: &Plan, odd: bool) -> Vec<bool> {
        let inputs: Vec<u64> = self.reads.iter().map(|r| self.external(r)).collect();
        let mut now = self.held.clone();
        let mut lives = vec![0; now.len()];
        let (mut reads, mut writes): (Vec<Vec<Read>>, Vec<Vec<Life>>) = (Vec::new(), Vec::new());
        for (i, step) in plan.steps.iter().enumerate() {
            let read: Vec<usize> = step.uses.iter().filter(|u| u.read).flat_map(|u| self.parts(plan, u, odd)).collect();
            let mut hasher = DefaultHasher::new();
            i.hash(&mut hasher);
            self.of_step[i].iter().for_each(|r| inputs[*r].hash(&mut hasher));
            read.iter().for_each(|p| now[*p].hash(&mut hasher));
            let input = hasher.finish();
            let there = |p: usize| Read { life: (p, lives[p]), is_held: now[p] == self.held[p] };
            reads.push(read.into_iter().map(there).collect());
            let mut written = Vec::new();
            for u in step.uses.iter().filter(|u| u.write) {
                for (place, part) in self.parts(plan, u, odd).enumerate() {
                    now[part].write(hashed((input, u.res, u.mips.0 as usize + place)), u);
                    lives[part] += usize::from(u.overwrite && !u.read);
                    written.push((part, lives[part]));
                }
            }
            writes.push(written);
        }
        let changed = (0..now.len()).filter(|p| now[*p] != self.held[*p]).map(|p| (p, lives[p])).collect();
        let awake = awake(&reads, &writes, &lives, changed);
        self.held = now;
        awake
    }

    fn external(&self, reads: &Reads) -> u64 {
        let bytes = &self.externals[reads.external];
        let within = |(first, end): &(u32, u32)| bytes.get(*first as usize..*end as usize);
        match reads.bytes.as_ref().map(|list| list.iter().map(within).collect::<Option<Vec<_>>>()) {
            Some(Some(parts)) => hashed(parts),
            _ => hashed(bytes),
        }
    }

    /// Where the content of a use lies, in the copy of this frame or of the one before.
    fn parts(&self, plan: &Plan, u: &Use, odd: bool) -> std::ops::Range<usize> {
        match u.res {
            Res::Buffer(b, history) => {
                let copy = usize::from(plan.buffers[b].history && (history != odd));
                let part = self.buffers + 2 * b + copy;
                part..part + 1
            }
            Res::Texture(t, history) => {
                let copy = usize::from(plan.textures[t].history && (history != odd));
                let first = self.textures[t][copy] + u.mips.0 as usize;
                first..first + u.mips.1 as usize
            }
        }
    }
}

impl Content {
    fn write(&mut self, id: u64, u: &Use) {
        if u.overwrite || u.read {
            // Of one that reads what was there, that is part of its id.
            *self = Content { base: id, stores: Vec::new() };
            return;
        }
        self.stores.retain(|s| *s != id);
        self.stores.push(id);
        if self.stores.len() > MOST_STORES {
            self.base = hashed((self.base, self.stores.remove(0)));
        }
    }
}

/// A part from where it is replaced to where it is replaced again: (part, how often it was before in this frame).
type Life = (usize, usize);

/// What a step reads.
struct Read {
    life: Life,
    /// Whether it is as at the start of the frame.
    is_held: bool,
}

/// Steps that run: who writes a life that ends up changed, and who writes the lives that these read or write, unless that is
/// there already. Of those that write a life all run or none, and where one life is written the last one is too, so that at
/// each step that runs all is as ids say, and after the frame.
fn awake(reads: &[Vec<Read>], writes: &[Vec<Life>], last: &[usize], changed: BTreeSet<Life>) -> Vec<bool> {
    let (mut wanted, mut awake) = (changed, vec![false; writes.len()]);
    let mut touched = vec![false; last.len()];
    loop {
        let before = wanted.len();
        for (step, lives) in writes.iter().enumerate() {
            if !awake[step] && lives.iter().any(|life| wanted.contains(life)) {
                awake[step] = true;
                lives.iter().for_each(|(part, _)| touched[*part] = true);
                wanted.extend(lives.iter().flat_map(|life| [*life, (life.0, last[life.0])]));
            }
        }
        for read in reads.iter().zip(&awake).filter(|(_, awake)| **awake).flat_map(|(reads, _)| reads) {
            if !read.is_held || touched[read.life.0] {
                wanted.insert(read.life);
            }
        }
        if wanted.len() == before {
            return awake;
        }
    }
}
