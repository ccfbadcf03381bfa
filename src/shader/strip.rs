//! Removes unused outputs from a shader, so that the driver eliminates the work behind them.

use super::access::{accesses, images_at, origins};
use super::spirv::{DECORATE, HEADER, LOAD, VARIABLE, instructions, opcode};
use std::collections::BTreeSet;

/// Turns the outputs at these locations into private variables.
///
/// SPIR-V 1.6: sections 2.16 (interfaces list all global variables since 1.4, so the entry point is
/// unchanged) and 3.7 (storage classes).
pub fn strip_outputs(words: &[u32], locations: &[u32]) -> Vec<u32> {
    const TYPE_POINTER: u32 = 32;
    const ACCESS_CHAINS: [u32; 2] = [65, 66];
    const LOCATION: u32 = 30;
    const OUTPUT: u32 = 3;
    const PRIVATE: u32 = 6;
    let outputs: Vec<u32> = instructions(words)
        .filter_map(|i| match i {
            [_, _, id, OUTPUT, ..] if opcode(i) == VARIABLE => Some(*id),
            _ => None,
        })
        .collect();
    let mut dropped: Vec<u32> = instructions(words)
        .filter_map(|i| match i {
            [_, id, LOCATION, location]
                if opcode(i) == DECORATE
                    && outputs.contains(id)
                    && locations.contains(location) =>
            {
                Some(*id)
            }
            _ => None,
        })
        .collect();
    if dropped.is_empty() || words.len() < HEADER {
        return words.to_vec();
    }
    let mut out = words[..HEADER].to_vec();
    let mut next_id = words[3];
    // (pointer to Output, its pointee, the same pointer to Private)
    let mut pointers: Vec<(u32, u32, u32)> = Vec::new();
    for i in instructions(words) {
        match i {
            [_, id, LOCATION, _] if opcode(i) == DECORATE && dropped.contains(id) => {}
            [_, id, OUTPUT, pointee] if opcode(i) == TYPE_POINTER => {
                out.extend(i);
                out.extend([4 << 16 | TYPE_POINTER, next_id, PRIVATE, *pointee]);
                pointers.push((*id, *pointee, next_id));
                next_id += 1;
            }
            [first, ty, id, OUTPUT, rest @ ..] if opcode(i) == VARIABLE && dropped.contains(id) => {
                let private = pointers.iter().find(|p| p.0 == *ty).map_or(*ty, |p| p.2);
                out.extend([*first, private, *id, PRIVATE]);
                out.extend(rest);
            }
            [first, ty, id, base, rest @ ..]
                if ACCESS_CHAINS.contains(&opcode(i)) && dropped.contains(base) =>
            {
                let private = pointers.iter().find(|p| p.0 == *ty).map_or(*ty, |p| p.2);
                out.extend([*first, private, *id, *base]);
                out.extend(rest);
                dropped.push(*id);
            }
            other => out.extend(other),
        }
    }
    out[3] = next_id;
    out
}

/// Removes write-only storage images at these bindings with their stores. Images with size queries
/// stay.
///
/// SPIR-V 1.6, sections 2.16 (the entry point lists all global variables) and 3.52.10 (images).
pub fn strip_images(words: &[u32], bindings: &[u32]) -> Vec<u32> {
    const NAME: u32 = 5;
    const ENTRY_POINT: u32 = 15;
    const COPY_OBJECT: u32 = 83;
    const IMAGE_WRITE: u32 = 99;
    let accesses = accesses(words);
    let unsized_bindings: Vec<u32> = bindings
        .iter()
        .copied()
        .filter(|b| accesses.get(b).is_some_and(|a| !a.size))
        .collect();
    let stored = images_at(words, bindings);
    let gone = images_at(words, &unsized_bindings);
    let origins = origins(words, stored.iter().copied());
    let comes_from =
        |id: &u32, of: &BTreeSet<u32>| origins.get(id).is_some_and(|o| o.is_subset(of));
    let mut out = words[..words.len().min(HEADER)].to_vec();
    for i in instructions(words) {
        match (opcode(i), i) {
            (IMAGE_WRITE, [_, image, ..]) if comes_from(image, &stored) => {}
            // Handles of a write-only image have no other use.
            (LOAD | COPY_OBJECT | VARIABLE, [_, _, id, ..]) if comes_from(id, &gone) => {}
            (NAME | DECORATE, [_, id, ..]) if comes_from(id, &gone) => {}
            (ENTRY_POINT, [_, model, function, rest @ ..]) => {
                // The name is zero-terminated text; the variables follow.
                let name = rest
                    .iter()
                    .position(|w| w.to_le_bytes().contains(&0))
                    .map_or(rest.len(), |n| n + 1);
                let (name, listed) = rest.split_at(name);
                let listed: Vec<u32> = listed
                    .iter()
                    .copied()
                    .filter(|id| !gone.contains(id))
                    .collect();
                let count = u32::try_from(3 + name.len() + listed.len()).unwrap_or(u32::MAX);
                out.extend([count << 16 | ENTRY_POINT, *model, *function]);
                out.extend(name);
                out.extend(listed);
            }
            (_, other) => out.extend(other),
        }
    }
    out
}
