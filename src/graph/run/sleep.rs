//! Which steps of a frame would write again what is there already. Every texture mip and buffer has an id of its content, made
//! of the step that wrote it and of all that this step read: the ids of its inputs, and the bytes of uniform blocks that its
//! shaders can read. A frame is gone through with ids alone first, and what comes out with the ids that are held already
//! sleeps. Nothing is declared for it; what depends on the count of frames, or on itself, never does, unless it rests
//! ([`Settling`](crate::graph::plan::Settling)).

use crate::graph::definition::Res;
use crate::graph::externals::{EXTERNALS, ExternalKind};
use crate::graph::host::CAMERA_COUNTS;
use crate::graph::link::{Linked, Target};
use crate::graph::plan::{Places, Plan, Step};
use crate::shader::Resource;
use std::collections::BTreeSet;
use std::hash::{BuildHasher, Hash, Hasher};

/// What a frame does.
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
pub enum Redo {
    /// All passes run.
    #[default]
    All,
    /// Passes run whose outcome would be another than what is there: with the same content, to the bit.
    Changed,
}

/// What a mip of a texture or a buffer holds.
#[derive(Clone, Debug)]
struct Content {
    /// Of the rest.
    id: u64,
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
    /// What steps read of externals, each of them once.
    reads: Vec<Reads>,
    /// Ids of what those read, with the count of frames and without.
    inputs: Vec<[u64; 2]>,
    /// Last bytes of uniform blocks, and a hash of those of other buffers; empty before the first are sent.
    externals: Vec<Vec<u8>>,
    /// Where content goes in even frames and in odd ones.
    flows: [Flow; 2],
    /// How long nothing has changed of what each of the plan's settling groups gathers from.
    still: Vec<Still>,
}

/// Where content goes in a frame. A part is a mip of a copy of a texture, or a copy of a buffer; it has a life from where it is
/// replaced to where it is replaced again.
struct Flow {
    steps: Vec<StepFlow>,
    /// The last life of each part.
    last: Vec<usize>,
    lives: usize,
    /// For each settling group, the parts of this frame's copies and of last frame's.
    kept: Vec<Vec<(usize, usize)>>,
    /// Parts that hold nothing when a frame begins.
    transient: Vec<bool>,
}

struct StepFlow {
    /// Which of [`Contents::reads`].
    externals: Vec<usize>,
    reads: Vec<Part>,
    writes: Vec<Write>,
}

struct Part {
    part: usize,
    life: usize,
}

struct Write {
    to: Part,
    /// Nothing is left of what was there, or that is in the id already.
    replaces: bool,
    /// What it is among the step's.
    what: u64,
}

/// What a settling group's ring reads that it has not written.
struct Still {
    /// Which parts it writes.
    own: Vec<bool>,
    /// Ids of the rest, by step of the ring, in the last frame.
    inputs: Vec<u64>,
    /// Frames since they changed.
    frames: u32,
}

/// What there is to do in a frame.
#[derive(PartialEq, Eq)]
pub(super) struct Frame {
    /// Steps that run.
    pub awake: Vec<bool>,
    /// Settling groups whose outcome is what they left in the frame before, and that have to bring it here.
    pub keeping: Vec<bool>,
}

/// A frame gone through with ids.
struct Walk {
    now: Vec<Content>,
    /// Of each step's reads, whether it is as at the start of the frame.
    is_held: Vec<Vec<bool>>,
    /// By settling group and step of its ring.
    inputs: Vec<Vec<u64>>,
}

/// Ids are the same in every run.
const IDS: foldhash::quality::FixedState = foldhash::quality::FixedState::with_seed(0);

fn hashed(value: impl Hash) -> u64 {
    IDS.hash_one(value)
}

impl Contents {
    /// Of resources that hold anything: each step runs once.
    pub(super) fn new(linked: &[Linked], plan: &Plan) -> Contents {
        let read_by = |step: &Step| {
            let bound = linked[step.pass].bound.iter().zip(&step.cases);
            let reads: BTreeSet<Reads> = bound
                .filter_map(|(bound, case)| match bound.cases[*case].target {
                    Target::External(external) => {
                        let bytes = bound
                            .reads
                            .clone()
                            .filter(|_| bound.resource == Resource::Uniform);
                        Some(Reads { external, bytes })
                    }
                    _ => None,
                })
                .collect();
            reads
        };
        let of_steps: Vec<BTreeSet<Reads>> = plan.steps.iter().map(read_by).collect();
        let reads: Vec<Reads> = of_steps
            .iter()
            .flatten()
            .cloned()
            .collect::<BTreeSet<_>>()
            .into_iter()
            .collect();
        let number = |r: &Reads| reads.binary_search(r).unwrap_or(0);
        let of_steps: Vec<Vec<usize>> = of_steps
            .iter()
            .map(|list| list.iter().map(number).collect())
            .collect();
        let places = Places::new(plan);
        let flows = [false, true].map(|odd| Flow::new(plan, &of_steps, &places, odd));
        let still = plan.settling.iter().map(|group| {
            let mut own = vec![false; places.count];
            let written = |flow: &Flow| {
                group
                    .ring
                    .iter()
                    .flat_map(|i| &flow.steps[*i].writes)
                    .map(|w| w.to.part)
                    .collect()
            };
            flows
                .iter()
                .flat_map(|flow| -> Vec<usize> { written(flow) })
                .for_each(|part| own[part] = true);
            Still {
                own,
                inputs: Vec::new(),
                frames: 0,
            }
        });
        let unknown = |i| {
            let id = hashed(("unknown", i));
            Content {
                id,
                base: id,
                stores: Vec::new(),
            }
        };
        Contents {
            held: (0..places.count).map(unknown).collect(),
            inputs: vec![[0; 2]; reads.len()],
            reads,
            externals: vec![Vec::new(); EXTERNALS.len()],
            still: still.collect(),
            flows,
        }
    }

    /// New bytes of an external resource or of its part at an offset, from the next frame on.
    pub(super) fn update(&mut self, name: &str, at: Option<u64>, bytes: &[u8]) {
        let Some(external) = EXTERNALS.iter().position(|e| e.name == name) else {
            return;
        };
        self.externals[external] = match (at, EXTERNALS[external].kind) {
            // What was sent before is still in the other parts. The same bytes again count as others.
            (Some(at), _) => {
                let all = [
                    &self.externals[external],
                    at.to_ne_bytes().as_slice(),
                    bytes,
                ]
                .concat();
                hashed(&all).to_ne_bytes().to_vec()
            }
            (None, ExternalKind::Uniform) => bytes.to_vec(),
            _ => hashed(bytes).to_ne_bytes().to_vec(),
        };
        let known = &self.externals[external];
        let uncounted = (name == "camera").then(|| {
            let mut bytes = known.clone();
            bytes
                .get_mut(CAMERA_COUNTS)
                .into_iter()
                .for_each(|counts| counts.fill(0));
            bytes
        });
        for (reads, ids) in self
            .reads
            .iter()
            .zip(&mut self.inputs)
            .filter(|(reads, _)| reads.external == external)
        {
            let id = reads.id(known);
            *ids = [id, uncounted.as_ref().map_or(id, |bytes| reads.id(bytes))];
        }
    }

    /// What the next frame has to do; from then on content is as after that frame. Where it does all, groups that rest do their
    /// work too, and what they leave is thrown away: pictures are the same, and times are of all work.
    pub(super) fn frame(&mut self, plan: &Plan, odd: bool, redo: Redo) -> Frame {
        let flow = &self.flows[usize::from(odd)];
        let mut resting: Vec<bool> = plan
            .settling
            .iter()
            .zip(&self.still)
            .map(|(group, still)| still.frames >= group.frames)
            .collect();
        let walk = loop {
            let walk = self.walk(plan, flow, &resting);
            // A change before the last of them wakes them in this frame, a later one in the next.
            let is_woken = |k: usize| {
                let group = &plan.settling[k];
                let before = group
                    .ring
                    .iter()
                    .take_while(|i| Some(*i) <= group.steps.last())
                    .count();
                walk.inputs[k][..before] != self.still[k].inputs[..before]
            };
            let woken: Vec<usize> = (0..resting.len())
                .filter(|k| resting[*k] && is_woken(*k))
                .collect();
            if woken.is_empty() {
                break walk;
            }
            woken.iter().for_each(|k| resting[*k] = false);
        };
        let frame = match redo {
            Redo::All => Frame {
                awake: vec![true; plan.steps.len()],
                keeping: resting,
            },
            Redo::Changed => {
                let is_new =
                    |part: usize| !flow.transient[part] && walk.now[part].id != self.held[part].id;
                let keeps = |(kept, rests): (&Vec<(usize, usize)>, &bool)| {
                    *rests && kept.iter().any(|(new, _)| is_new(*new))
                };
                let mut rests = vec![false; plan.steps.len()];
                for (group, _) in plan
                    .settling
                    .iter()
                    .zip(&resting)
                    .filter(|(_, resting)| **resting)
                {
                    group.steps.iter().for_each(|i| rests[*i] = true);
                }
                let keeping = flow.kept.iter().zip(&resting).map(keeps).collect();
                Frame {
                    awake: flow.awake(&walk.is_held, &rests, is_new),
                    keeping,
                }
            }
        };
        for (still, inputs) in self.still.iter_mut().zip(walk.inputs) {
            still.frames = if still.inputs == inputs {
                still.frames.saturating_add(1)
            } else {
                0
            };
            still.inputs = inputs;
        }
        self.held = walk.now;
        frame
    }

    /// Whether every group of steps that settles rests from the next frame on, unless something changes.
    pub(super) fn is_at_rest(&self, plan: &Plan) -> bool {
        plan.settling
            .iter()
            .zip(&self.still)
            .all(|(group, still)| still.frames >= group.frames)
    }

    fn walk(&self, plan: &Plan, flow: &Flow, resting: &[bool]) -> Walk {
        let mut now = self.held.clone();
        let mut inputs: Vec<Vec<u64>> = vec![Vec::new(); plan.settling.len()];
        let mut is_held = Vec::with_capacity(flow.steps.len());
        for (i, step) in flow.steps.iter().enumerate() {
            let there =
                |r: &Part| !flow.transient[r.part] && now[r.part].id == self.held[r.part].id;
            is_held.push(step.reads.iter().map(there).collect());
            let mut rests = false;
            for (k, (group, still)) in plan.settling.iter().zip(&self.still).enumerate() {
                if group.ring.binary_search(&i).is_ok() {
                    let mut hasher = IDS.build_hasher();
                    step.externals
                        .iter()
                        .for_each(|r| self.inputs[*r][1].hash(&mut hasher));
                    let others = step.reads.iter().filter(|r| !still.own[r.part]);
                    others.for_each(|r| now[r.part].id.hash(&mut hasher));
                    inputs[k].push(hasher.finish());
                }
                if resting[k] && group.steps.contains(&i) {
                    rests = true;
                    if group.steps.last() == Some(&i) {
                        flow.kept[k]
                            .iter()
                            .for_each(|(new, last)| now[*new] = now[*last].clone());
                    }
                }
            }
            if rests {
                continue;
            }
            let mut hasher = IDS.build_hasher();
            i.hash(&mut hasher);
            step.externals
                .iter()
                .for_each(|r| self.inputs[*r][0].hash(&mut hasher));
            step.reads
                .iter()
                .for_each(|r| now[r.part].id.hash(&mut hasher));
            let input = hasher.finish();
            step.writes
                .iter()
                .for_each(|w| now[w.to.part].write(hashed((input, w.what)), w.replaces));
        }
        Walk {
            now,
            is_held,
            inputs,
        }
    }
}

impl Reads {
    fn id(&self, bytes: &[u8]) -> u64 {
        let within = |(first, end): &(u32, u32)| bytes.get(*first as usize..*end as usize);
        match self
            .bytes
            .as_ref()
            .map(|list| list.iter().map(within).collect::<Option<Vec<_>>>())
        {
            Some(Some(parts)) => hashed(parts),
            _ => hashed(bytes),
        }
    }
}

impl Flow {
    fn new(plan: &Plan, externals: &[Vec<usize>], places: &Places, odd: bool) -> Flow {
        let mut last: Vec<usize> = (0..places.count).collect();
        let mut lives = places.count;
        let mut steps = Vec::new();
        for (step, externals) in plan.steps.iter().zip(externals) {
            let read = step
                .uses
                .iter()
                .filter(|u| u.read)
                .flat_map(|u| places.of(plan, u.res, u.mips, odd));
            let reads = read
                .map(|part| Part {
                    part,
                    life: last[part],
                })
                .collect();
            let mut writes = Vec::new();
            for u in step.uses.iter().filter(|u| u.write) {
                for (mip, part) in (u.mips.0..).zip(places.of(plan, u.res, u.mips, odd)) {
                    if u.overwrite && !u.read {
                        last[part] = lives;
                        lives += 1;
                    }
                    let to = Part {
                        part,
                        life: last[part],
                    };
                    writes.push(Write {
                        to,
                        replaces: u.overwrite || u.read,
                        what: hashed((u.res, mip)),
                    });
                }
            }
            steps.push(StepFlow {
                externals: externals.clone(),
                reads,
                writes,
            });
        }
        let of = |res, mips| places.of(plan, res, mips, odd);
        let copies = |res: &Res| match *res {
            Res::Buffer(b, _) => of(*res, (0, 1)).zip(of(Res::Buffer(b, true), (0, 1))),
            Res::Texture(t, _) => {
                let mips = (0, plan.textures[t].mips);
                of(*res, mips).zip(of(Res::Texture(t, true), mips))
            }
        };
        let kept = plan
            .settling
            .iter()
            .map(|group| group.kept.iter().flat_map(copies).collect())
            .collect();
        let mut transient = vec![false; places.count];
        plan.transients
            .iter()
            .flat_map(|t| of(t.res, (0, 1)))
            .for_each(|part| transient[part] = true);
        Flow {
            steps,
            last,
            lives,
            kept,
            transient,
        }
    }

    /// Steps that run: who writes a life that ends up changed, and who writes the lives that these read or write, unless that is
    /// there already. Of those that write a life all run or none, and where one life is written the last one is too, so that at
    /// each step that runs all is as ids say, and after the frame; but of what is transient nobody asks after the frame.
    fn awake(
        &self,
        is_held: &[Vec<bool>],
        rests: &[bool],
        is_new: impl Fn(usize) -> bool,
    ) -> Vec<bool> {
        let (mut wanted, mut touched) = (vec![false; self.lives], vec![false; self.last.len()]);
        let mut awake = vec![false; self.steps.len()];
        (0..self.last.len())
            .filter(|part| is_new(*part))
            .for_each(|part| wanted[self.last[part]] = true);
        loop {
            let mut more = false;
            // What is read was mostly written before.
            for (i, step) in self
                .steps
                .iter()
                .enumerate()
                .rev()
                .filter(|(i, _)| !rests[*i])
            {
                if !awake[i] && step.writes.iter().any(|w| wanted[w.to.life]) {
                    (awake[i], more) = (true, true);
                    for w in &step.writes {
                        touched[w.to.part] = true;
                        wanted[w.to.life] = true;
                        wanted[self.last[w.to.part]] |= !self.transient[w.to.part];
                    }
                }
                if awake[i] {
                    for (read, _) in step
                        .reads
                        .iter()
                        .zip(&is_held[i])
                        .filter(|(r, held)| !**held || touched[r.part])
                    {
                        more |= !std::mem::replace(&mut wanted[read.life], true);
                    }
                }
            }
            if !more {
                return awake;
            }
        }
    }
}

impl Content {
    fn write(&mut self, id: u64, replaces: bool) {
        if replaces {
            // Of one that reads what was there, that is part of its id.
            (self.id, self.base) = (id, id);
            self.stores.clear();
            return;
        }
        self.stores.retain(|s| *s != id);
        self.stores.push(id);
        if self.stores.len() > MOST_STORES {
            self.base = hashed((self.base, self.stores.remove(0)));
        }
        self.id = hashed((self.base, &self.stores));
    }
}
