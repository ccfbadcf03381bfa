//! Random data flows, executed on the CPU in full and incrementally: memory is equal after every
//! frame.

use super::dataflow::{Dataflow, Place, StepFlow, Write};
use super::external::Externals;
use super::{Execution, Versions, hashed};

const PARTS: usize = 7;
/// Parts 0 and 1 are the copies of a resource with a history, which swap in odd frames.
const SWAPPED: [usize; 2] = [0, 1];
/// Parts without content between frames.
const TRANSIENT: [usize; 2] = [5, 6];
const INPUTS: usize = 3;
const CELLS: usize = 4;

/// How a step writes a part.
#[derive(Clone, Copy, PartialEq)]
enum How {
    /// All cells.
    Overwrites,
    /// All cells, from their old content.
    Updates,
    /// Some cells; which ones depends on its inputs.
    Stores,
}

/// A step: inputs, parts read, parts written.
#[derive(Clone)]
struct Random {
    inputs: Vec<usize>,
    reads: Vec<usize>,
    writes: Vec<(usize, How)>,
}

/// Numbers that look random and are the same in every run.
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, end: usize) -> usize {
        self.0 = hashed(self.0);
        (self.0 % end as u64) as usize
    }
}

/// Steps that read a transient part only after a step has overwritten it in the same frame, as
/// plans have them.
fn random_steps(numbers: &mut Numbers) -> Vec<Random> {
    let mut begun = [true; PARTS];
    TRANSIENT.iter().for_each(|part| begun[*part] = false);
    let mut steps = Vec::new();
    for _ in 0..2 + numbers.below(7) {
        let inputs = (0..INPUTS).filter(|_| numbers.below(4) == 0).collect();
        let reads = (0..PARTS)
            .filter(|part| begun[*part] && numbers.below(4) == 0)
            .collect();
        let mut writes = Vec::new();
        for (part, begun) in begun.iter_mut().enumerate() {
            // The last frame's copy of a history is never written.
            if part != SWAPPED[1] && numbers.below(4) == 0 {
                let how = [How::Overwrites, How::Updates, How::Stores][numbers.below(3)];
                writes.push((part, if *begun { how } else { How::Overwrites }));
                *begun = true;
            }
        }
        steps.push(Random {
            inputs,
            reads,
            writes,
        });
    }
    steps
}

/// The part that a step means in even or in odd frames.
fn copy(part: usize, odd: bool) -> usize {
    match SWAPPED.iter().position(|p| *p == part) {
        Some(side) => SWAPPED[side ^ usize::from(odd)],
        None => part,
    }
}

fn dataflow(steps: &[Random], odd: bool) -> Dataflow {
    let mut last: Vec<usize> = (0..PARTS).collect();
    let mut generations = PARTS;
    let mut flows = Vec::new();
    for step in steps {
        let updated = step
            .writes
            .iter()
            .filter(|w| w.1 == How::Updates)
            .map(|w| w.0);
        let read = step
            .reads
            .iter()
            .copied()
            .chain(updated)
            .map(|part| copy(part, odd));
        let reads = read
            .map(|part| Place {
                part,
                generation: last[part],
            })
            .collect();
        let mut writes = Vec::new();
        for (part, how) in &step.writes {
            let part = copy(*part, odd);
            if *how == How::Overwrites {
                last[part] = generations;
                generations += 1;
            }
            let to = Place {
                part,
                generation: last[part],
            };
            writes.push(Write {
                to,
                replaces: *how != How::Stores,
                target: part as u64,
            });
        }
        flows.push(StepFlow {
            externals: step.inputs.clone(),
            reads,
            writes,
        });
    }
    let mut transient = vec![false; PARTS];
    TRANSIENT.iter().for_each(|part| transient[*part] = true);
    Dataflow {
        steps: flows,
        last,
        generations,
        carried: Vec::new(),
        transient,
    }
}

type Memory = [[u64; CELLS]; PARTS];

/// The effect of a step on memory.
fn execute(memory: &mut Memory, number: usize, step: &Random, odd: bool, inputs: &[u64]) {
    let read: Vec<_> = step
        .reads
        .iter()
        .map(|part| memory[copy(*part, odd)])
        .collect();
    let input = hashed((
        number,
        step.inputs.iter().map(|i| inputs[*i]).collect::<Vec<_>>(),
        read,
    ));
    let updated = step
        .writes
        .iter()
        .filter(|w| w.1 == How::Updates)
        .map(|w| memory[copy(w.0, odd)]);
    let input = hashed((input, updated.collect::<Vec<_>>()));
    for (part, how) in &step.writes {
        let part = copy(*part, odd);
        for (number, cell) in memory[part].iter_mut().enumerate() {
            let value = hashed((input, part, number));
            if *how != How::Stores || value % 2 == 0 {
                *cell = value;
            }
        }
    }
}

#[test]
fn incremental_frames_leave_what_full_frames_leave() {
    let mut numbers = Numbers(1);
    let (mut skipped, mut all) = (0, 0);
    for case in 0..2000 {
        let steps = random_steps(&mut numbers);
        let flows = [false, true].map(|odd| dataflow(&steps, odd));
        let mut versions = Versions::of(Externals::of(INPUTS), flows, Vec::new());
        let mut inputs = [0; INPUTS];
        let mut memories: [Memory; 2] = [[[0; CELLS]; PARTS]; 2];
        for frame in 0..12 {
            let odd = frame % 2 == 1;
            if numbers.below(2) == 0 {
                // Settings that return to an earlier value, too.
                inputs[numbers.below(INPUTS)] = numbers.below(3) as u64;
            }
            versions.externals.set(&inputs);
            for part in TRANSIENT {
                let garbage = |memory: u64| [hashed((numbers.0, memory)); CELLS];
                (memories[0][part], memories[1][part]) = (garbage(0), garbage(1));
            }
            let runs = versions.frame(odd, Execution::Incremental).runs;
            for (i, step) in steps.iter().enumerate() {
                execute(&mut memories[0], i, step, odd, &inputs);
                if runs[i] {
                    execute(&mut memories[1], i, step, odd, &inputs);
                }
            }
            for part in (0..PARTS).filter(|part| !TRANSIENT.contains(part)) {
                assert_eq!(
                    memories[0][part], memories[1][part],
                    "case {case}, frame {frame}, part {part}"
                );
            }
            skipped += runs.iter().filter(|run| !**run).count();
            all += runs.len();
        }
    }
    println!("{skipped} of {all} steps skipped");
    assert!(
        skipped * 5 > all && skipped * 5 < 4 * all,
        "{skipped} of {all} steps skipped"
    );
}
