//! Accesses of a module to its storage buffers and images, derived from its instructions instead of
//! GLSL qualifiers.

use super::spirv::{DECORATE, HEADER, LOAD, VARIABLE, instructions, opcode};
use std::collections::{BTreeMap, BTreeSet};

/// Accesses to the content of a resource.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Access {
    /// Loads, and atomics that return the old value.
    pub read: bool,
    pub write: bool,
    /// Size queries of an image, and image arguments of calls.
    pub size: bool,
}

const READ: Access = Access {
    read: true,
    write: false,
    size: false,
};
const WRITE: Access = Access {
    read: false,
    write: true,
    size: false,
};
const BOTH: Access = Access {
    read: true,
    write: true,
    size: false,
};
const SIZE: Access = Access {
    read: false,
    write: false,
    size: true,
};

const FUNCTION_CALL: u32 = 57;
const MEMBER_DECORATE: u32 = 72;
const UNIFORM_CONSTANT: u32 = 0;
const STORAGE_BUFFER: u32 = 12;
const BINDING: u32 = 33;
const NON_WRITABLE: u32 = 24;
const NON_READABLE: u32 = 25;

/// Instructions that reference an id without accessing it: OpName, OpMemberName, OpEntryPoint,
/// OpDecorate, OpMemberDecorate, instructions with literals, and instructions on values that are
/// never blocks (OpExtInst, OpVectorShuffle, OpCompositeExtract, OpCompositeInsert).
const NAMES_ONLY: [u32; 21] = [
    3,
    4,
    5,
    6,
    7,
    8,
    10,
    11,
    12,
    14,
    15,
    16,
    17,
    21,
    22,
    43,
    DECORATE,
    MEMBER_DECORATE,
    79,
    81,
    82,
];

/// A storage buffer, image or sampler of a module.
struct Variable {
    binding: u32,
    buffer: bool,
}

/// The accesses to each storage buffer and image by binding: SPIR-V 1.6, sections 3.52.8 (memory),
/// 3.52.10 (images) and 3.52.18 (atomics).
pub(super) fn accesses(words: &[u32]) -> BTreeMap<u32, Access> {
    let variables = variables(words);
    let origins = origins(words, variables.keys().copied());
    let mut found: BTreeMap<u32, Access> = variables
        .values()
        .map(|v| (v.binding, Access::default()))
        .collect();
    for i in instructions(words) {
        for (id, access) in touched(i) {
            let origin = origins.get(&id);
            // A store to one of several possible images cannot be removed for one of them, so it
            // also counts as a read.
            let access = if origin.is_some_and(|o| o.len() > 1) && access == WRITE {
                BOTH
            } else {
                access
            };
            for variable in origin
                .into_iter()
                .flatten()
                .filter_map(|v| variables.get(v))
            {
                // Loading an image only gives a handle; its uses count.
                if (variable.buffer || opcode(i) != LOAD)
                    && let Some(known) = found.get_mut(&variable.binding)
                {
                    known.read |= access.read;
                    known.write |= access.write;
                    known.size |= access.size;
                }
            }
        }
    }
    found
}

/// Decorates never written resources NonWritable and never read ones NonReadable. Devices without
/// stores in vertex or fragment stages require the first (VUID-RuntimeSpirv-NonWritable), and
/// drivers optimise with both.
pub(super) fn decorated(words: &[u32]) -> Vec<u32> {
    let (accesses, images) = (accesses(words), storage_images(words));
    let is_decoration = |i: &[u32]| [DECORATE, MEMBER_DECORATE].contains(&opcode(i));
    let there: BTreeSet<&[u32]> = instructions(words)
        .filter(|i| opcode(i) == DECORATE)
        .filter_map(|i| i.get(1..3))
        .collect();
    let mut added = Vec::new();
    // Samplers are never written and cannot be decorated.
    for (id, variable) in variables(words)
        .into_iter()
        .filter(|(id, v)| v.buffer || images.contains(id))
    {
        let access = accesses.get(&variable.binding).copied().unwrap_or(BOTH);
        for (decoration, holds) in [
            (NON_WRITABLE, !access.write),
            (NON_READABLE, access.write && !access.read),
        ] {
            if holds && !there.contains([id, decoration].as_slice()) {
                added.extend([3 << 16 | DECORATE, id, decoration]);
            }
        }
    }
    let last = instructions(words).filter(|i| is_decoration(i)).count();
    let mut out = words[..words.len().min(HEADER)].to_vec();
    let mut seen = 0;
    for i in instructions(words) {
        out.extend(i);
        if is_decoration(i) {
            seen += 1;
            if seen == last {
                out.extend(&added);
            }
        }
    }
    out
}

fn variables(words: &[u32]) -> BTreeMap<u32, Variable> {
    let classes: BTreeMap<u32, bool> = instructions(words)
        .filter_map(|i| match i {
            [_, _, id, class @ (UNIFORM_CONSTANT | STORAGE_BUFFER), ..]
                if opcode(i) == VARIABLE =>
            {
                Some((*id, *class == STORAGE_BUFFER))
            }
            _ => None,
        })
        .collect();
    let bound = instructions(words).filter_map(|i| match i {
        [_, id, BINDING, binding] if opcode(i) == DECORATE => classes.get(id).map(|buffer| {
            (
                *id,
                Variable {
                    binding: *binding,
                    buffer: *buffer,
                },
            )
        }),
        _ => None,
    });
    bound.collect()
}

/// The members that may be read of each uniform block, by binding; `None` if all may be (SPIR-V
/// 1.6, section 3.52.8, OpAccessChain).
pub(super) fn uniform_members(words: &[u32]) -> BTreeMap<u32, Option<BTreeSet<u32>>> {
    const UNIFORM: u32 = 2;
    const CONSTANT: u32 = 43;
    let blocks: BTreeSet<u32> = instructions(words)
        .filter_map(|i| match i {
            [_, _, id, UNIFORM, ..] if opcode(i) == VARIABLE => Some(*id),
            _ => None,
        })
        .collect();
    let constants: BTreeMap<u32, u32> = instructions(words)
        .filter_map(|i| match i {
            [_, _, id, value] if opcode(i) == CONSTANT => Some((*id, *value)),
            _ => None,
        })
        .collect();
    let mut members: BTreeMap<u32, Option<BTreeSet<u32>>> =
        blocks.iter().map(|b| (*b, Some(BTreeSet::new()))).collect();
    for i in instructions(words) {
        let said = NAMES_ONLY.contains(&opcode(i)) || opcode(i) == VARIABLE;
        for (at, block) in i
            .iter()
            .enumerate()
            .skip(1)
            .filter(|(_, id)| !said && blocks.contains(id))
        {
            let chain = (opcode(i) == 65 || opcode(i) == 66) && at == 3;
            let member = if chain {
                i.get(4).and_then(|index| constants.get(index))
            } else {
                None
            };
            match (members.get_mut(block), member) {
                (Some(Some(list)), Some(member)) => drop(list.insert(*member)),
                // Any other use may read all members. It may also be a literal that equals the id.
                (Some(all), None) => *all = None,
                _ => {}
            }
        }
    }
    let binding = |i: &[u32]| match i {
        [_, id, BINDING, binding] if opcode(i) == DECORATE => {
            Some((*binding, members.get(id)?.clone()))
        }
        _ => None,
    };
    instructions(words).filter_map(binding).collect()
}

/// The images, by binding, into which every thread of a compute shader stores at its own position.
/// The store is in the first block of the entry point, which all threads execute, at
/// `gl_GlobalInvocationID` (SPIR-V 1.6, section 3.52.10, OpImageWrite). Other patterns are not
/// detected.
pub(super) fn stored_by_each(words: &[u32]) -> BTreeSet<u32> {
    const ENTRY_POINT: u32 = 15;
    const BUILT_IN: u32 = 11;
    const GLOBAL_INVOCATION_ID: u32 = 28;
    const FUNCTION: u32 = 54;
    let entry = instructions(words)
        .find(|i| opcode(i) == ENTRY_POINT)
        .and_then(|i| i.get(2));
    let main = instructions(words).skip_while(|i| opcode(i) != FUNCTION || i.get(2) != entry);
    // Up to the first branch, return or kill.
    let first_block = main.take_while(|i| !(249..=255).contains(&opcode(i)));
    let place = |i: &[u32]| match i {
        [_, id, BUILT_IN, GLOBAL_INVOCATION_ID] if opcode(i) == DECORATE => Some(*id),
        _ => None,
    };
    let mut places: BTreeSet<u32> = instructions(words).filter_map(place).collect();
    let (variables, mut images, mut stored) = (variables(words), BTreeMap::new(), BTreeSet::new());
    for i in first_block {
        match (opcode(i), i) {
            (LOAD, [_, _, id, from, ..]) if places.contains(from) => drop(places.insert(*id)),
            (LOAD, [_, _, id, from, ..]) => {
                if let Some(variable) = variables.get(from) {
                    images.insert(*id, variable.binding);
                }
            }
            // OpBitcast; OpVectorShuffle of the first two.
            (124, [_, _, id, from]) if places.contains(from) => drop(places.insert(*id)),
            (79, [_, _, id, a, _, 0, 1]) if places.contains(a) => drop(places.insert(*id)),
            (99, [_, image, at, ..]) if places.contains(at) => stored.extend(images.get(image)),
            _ => {}
        }
    }
    stored
}

/// The storage images with these binding numbers.
pub(super) fn images_at(words: &[u32], bindings: &[u32]) -> BTreeSet<u32> {
    let images = storage_images(words);
    let bound = variables(words)
        .into_iter()
        .filter(|(id, v)| images.contains(id) && bindings.contains(&v.binding));
    bound.map(|(id, _)| id).collect()
}

/// The storage image variables: pointers to an OpTypeImage; samplers use another type.
fn storage_images(words: &[u32]) -> BTreeSet<u32> {
    const TYPE_IMAGE: u32 = 25;
    const TYPE_POINTER: u32 = 32;
    let mut types = BTreeSet::new();
    let mut images = BTreeSet::new();
    for i in instructions(words) {
        match (opcode(i), i) {
            (TYPE_IMAGE, [_, id, ..]) => drop(types.insert(*id)),
            (TYPE_POINTER, [_, id, _, pointee]) if types.contains(pointee) => {
                types.insert(*id);
            }
            (VARIABLE, [_, ty, id, ..]) if types.contains(ty) => drop(images.insert(*id)),
            _ => {}
        }
    }
    images
}

/// The variables that a pointer or loaded image may originate from.
pub(super) type Origins = BTreeMap<u32, BTreeSet<u32>>;

/// The origins of all pointers and images.
pub(super) fn origins(words: &[u32], variables: impl Iterator<Item = u32>) -> Origins {
    let mut origins: Origins = variables.map(|id| (id, BTreeSet::from([id]))).collect();
    let parameters = parameters(words);
    // Repeats, because a call may pass a pointer to a function earlier in the module.
    while follow(words, &parameters, &mut origins) {}
    origins
}

/// The parameters of each function.
fn parameters(words: &[u32]) -> BTreeMap<u32, Vec<u32>> {
    const FUNCTION: u32 = 54;
    const FUNCTION_PARAMETER: u32 = 55;
    let mut parameters: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    let mut function = 0;
    for i in instructions(words) {
        match (opcode(i), i) {
            (FUNCTION, [_, _, id, ..]) => function = *id,
            (FUNCTION_PARAMETER, [_, _, id]) => parameters.entry(function).or_default().push(*id),
            _ => {}
        }
    }
    parameters
}

/// Propagates origins through the module once; returns whether anything changed.
fn follow(words: &[u32], parameters: &BTreeMap<u32, Vec<u32>>, origins: &mut Origins) -> bool {
    let mut learnt = false;
    let mut join = |to: u32, from: &[u32]| {
        for id in from {
            let variables = origins.get(id).cloned().unwrap_or_default();
            if !variables.is_empty() {
                let known = origins.entry(to).or_default();
                let before = known.len();
                known.extend(variables);
                learnt |= known.len() > before;
            }
        }
    };
    for i in instructions(words) {
        match (opcode(i), i) {
            // Access chains, copies and texel pointers; a loaded image has the origin of its
            // variable.
            (60 | LOAD | 65..=67 | 70 | 83, [_, _, id, base, ..]) => join(*id, &[*base]),
            // OpSelect, OpPhi.
            (169, [_, _, id, _, a, b]) => join(*id, &[*a, *b]),
            (245, [_, _, id, rest @ ..]) => {
                join(*id, &rest.iter().step_by(2).copied().collect::<Vec<_>>())
            }
            (FUNCTION_CALL, [_, _, _, callee, arguments @ ..]) => {
                for (parameter, argument) in
                    parameters.get(callee).into_iter().flatten().zip(arguments)
                {
                    join(*parameter, &[*argument]);
                }
            }
            _ => {}
        }
    }
    learnt
}

/// The accesses of an instruction, by pointer or image id.
fn touched(i: &[u32]) -> Vec<(u32, Access)> {
    match (opcode(i), i) {
        (LOAD, [_, _, _, pointer, ..]) => vec![(*pointer, READ)],
        // OpStore, OpAtomicStore.
        (62 | 228, [_, pointer, ..]) => vec![(*pointer, WRITE)],
        // OpCopyMemory, OpCopyMemorySized.
        (63 | 64, [_, target, source, ..]) => vec![(*target, WRITE), (*source, READ)],
        // OpImageRead, OpImageSparseRead, OpAtomicLoad.
        (98 | 320 | 227, [_, _, _, image, ..]) => vec![(*image, READ)],
        // OpImageWrite.
        (99, [_, image, ..]) => vec![(*image, WRITE)],
        // OpImageQuerySizeLod, OpImageQuerySize, other queries.
        (103..=107, [_, _, _, image, ..]) => vec![(*image, SIZE)],
        // Arguments of a call that was not inlined may be accessed in any way.
        (FUNCTION_CALL, [_, _, _, _, arguments @ ..]) => {
            arguments.iter().map(|id| (*id, SIZE)).collect()
        }
        // Atomics that return the old value: integers, flags, float minimum, maximum and sum.
        (229..=242 | 318 | 5614 | 5615 | 6035, [_, _, _, pointer, ..]) => vec![(*pointer, BOTH)],
        // OpAtomicFlagClear.
        (319, [_, pointer, ..]) => vec![(*pointer, WRITE)],
        _ => vec![],
    }
}
