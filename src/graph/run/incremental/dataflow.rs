//! Dependencies between steps, and the steps that have to run.

use super::hashed;
use crate::graph::definition::Res;
use crate::graph::plan::{Places, Plan, Step};

/// Whether a part holds the version that a step reads at the start of the frame already, by step
/// and read.
pub(super) type Ready = Vec<Vec<bool>>;

/// The data flow of a frame. A *part* is a mip of a copy of a texture, or a copy of a buffer. Each
/// time that a step replaces a part, a new *generation* of it begins: steps that read one
/// generation need the steps that write it, and no others.
pub(super) struct Dataflow {
    pub steps: Vec<StepFlow>,
    /// The last generation of each part.
    pub last: Vec<usize>,
    /// Number of generations. The first ones, one for each part, are the contents at the start of
    /// the frame.
    pub generations: usize,
    /// Parts of this frame's history, each with that of the last frame, by group.
    pub carried: Vec<Vec<(usize, usize)>>,
    /// Whether the memory of a part is shared, so that it holds nothing between frames.
    pub transient: Vec<bool>,
}

pub(super) struct StepFlow {
    /// Indices of external reads.
    pub externals: Vec<usize>,
    pub reads: Vec<Place>,
    pub writes: Vec<Write>,
}

#[derive(Clone, Copy)]
pub(super) struct Place {
    pub part: usize,
    pub generation: usize,
}

pub(super) struct Write {
    pub to: Place,
    /// Whether nothing is left of the old content, or the step has read it.
    pub replaces: bool,
    /// Tells the writes of a step apart.
    pub target: u64,
}

impl Dataflow {
    /// The data flow of even or odd frames; `externals`: the external reads of each step.
    pub fn new(plan: &Plan, externals: &[Vec<usize>], places: &Places, odd: bool) -> Dataflow {
        let mut last: Vec<usize> = (0..places.count).collect();
        let mut generations = places.count;
        let mut steps = Vec::new();
        for (step, externals) in plan.steps.iter().zip(externals) {
            let parts = |step: &Step| -> Vec<usize> {
                let read = step.uses.iter().filter(|u| u.read);
                read.flat_map(|u| places.of(plan, u.res, u.mips, odd))
                    .collect()
            };
            let place = |part: usize| Place {
                part,
                generation: last[part],
            };
            let reads = parts(step).into_iter().map(place).collect();
            let mut writes = Vec::new();
            for u in step.uses.iter().filter(|u| u.write) {
                for (mip, part) in (u.mips.0..).zip(places.of(plan, u.res, u.mips, odd)) {
                    if u.overwrite && !u.read {
                        last[part] = generations;
                        generations += 1;
                    }
                    writes.push(Write {
                        to: Place {
                            part,
                            generation: last[part],
                        },
                        replaces: u.overwrite || u.read,
                        target: hashed((u.res, mip)),
                    });
                }
            }
            steps.push(StepFlow {
                externals: externals.clone(),
                reads,
                writes,
            });
        }
        let mut transient = vec![false; places.count];
        for shared in &plan.transients {
            places
                .of(plan, shared.res, (0, 1), odd)
                .for_each(|part| transient[part] = true);
        }
        Dataflow {
            steps,
            last,
            generations,
            carried: carried(plan, places, odd),
            transient,
        }
    }

    /// The steps that have to run so that every part with a new version (`is_new`) gets it. Three
    /// rules are applied until nothing changes:
    ///
    /// 1. A step runs if it writes a generation that is needed. The last generations of new parts
    ///    are needed first.
    /// 2. A step that runs makes all generations that it writes needed, so that their other writers
    ///    run too, and also the last generation of each part that it overwrites, so that the part
    ///    is complete after the frame. Nothing reads a transient part after the frame.
    /// 3. A step that runs makes a generation that it reads needed, unless the part holds it
    ///    already and no step that runs overwrites the part.
    ///
    /// `stopped` steps never run: their groups have converged.
    pub fn steps_to_run(
        &self,
        ready: &Ready,
        stopped: &[bool],
        is_new: impl Fn(usize) -> bool,
    ) -> Vec<bool> {
        let mut needed = vec![false; self.generations];
        let mut overwritten = vec![false; self.last.len()];
        let mut runs = vec![false; self.steps.len()];
        (0..self.last.len())
            .filter(|part| is_new(*part))
            .for_each(|part| needed[self.last[part]] = true);
        loop {
            let mut changed = false;
            // Backwards, because inputs are usually written by earlier steps.
            for (i, step) in self
                .steps
                .iter()
                .enumerate()
                .rev()
                .filter(|(i, _)| !stopped[*i])
            {
                if !runs[i] && step.writes.iter().any(|write| needed[write.to.generation]) {
                    (runs[i], changed) = (true, true);
                    for Place { part, generation } in step.writes.iter().map(|write| write.to) {
                        overwritten[part] = true;
                        needed[generation] = true;
                        needed[self.last[part]] |= !self.transient[part];
                    }
                }
                if runs[i] {
                    for (read, is_ready) in step.reads.iter().zip(&ready[i]) {
                        if (!is_ready || overwritten[read.part]) && !needed[read.generation] {
                            (needed[read.generation], changed) = (true, true);
                        }
                    }
                }
            }
            if !changed {
                return runs;
            }
        }
    }
}

/// Parts of this frame's history, each with last frame's, by group.
fn carried(plan: &Plan, places: &Places, odd: bool) -> Vec<Vec<(usize, usize)>> {
    let parts = |res, mips| places.of(plan, res, mips, odd);
    let copies = |res: &Res| match *res {
        Res::Buffer(b, _) => parts(*res, (0, 1)).zip(parts(Res::Buffer(b, true), (0, 1))),
        Res::Texture(t, _) => {
            let mips = (0, plan.textures[t].mips);
            parts(*res, mips).zip(parts(Res::Texture(t, true), mips))
        }
    };
    plan.settling
        .iter()
        .map(|group| group.kept.iter().flat_map(copies).collect())
        .collect()
}
