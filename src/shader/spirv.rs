//! The instructions of a SPIR-V module.

/// Words before the first instruction of a module.
pub(super) const HEADER: usize = 5;

pub(super) const LOAD: u32 = 61;
pub(super) const VARIABLE: u32 = 59;
pub(super) const DECORATE: u32 = 71;

/// Opcode of an instruction.
pub(super) fn opcode(instruction: &[u32]) -> u32 {
    instruction.first().map_or(0, |w| w & 0xffff)
}

/// The instructions of a module, after its header.
pub(super) fn instructions(words: &[u32]) -> impl Iterator<Item = &[u32]> {
    let mut rest = words.get(HEADER..).unwrap_or(&[]);
    std::iter::from_fn(move || {
        let first = *rest.first()?;
        let count = ((first >> 16) as usize).clamp(1, rest.len());
        let (instruction, after) = rest.split_at(count);
        rest = after;
        Some(instruction)
    })
}
