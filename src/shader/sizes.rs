//! Size limits for a shader's variables and values. Drivers allocate whatever a module declares, so
//! an array of a billion numbers would use all memory.

use super::spirv::{instructions, opcode};
use std::collections::BTreeMap;

/// Maximum bytes of all variables of a stage without buffers, and of one value.
pub const MAX_BYTES: u64 = 1 << 20;

/// Variables above the limit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TooLarge {
    /// The largest variable; empty if unnamed.
    pub name: String,
    /// Bytes of all variables, or of one value.
    pub bytes: u64,
}

impl std::fmt::Display for TooLarge {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let largest = if self.name.is_empty() {
            String::new()
        } else {
            format!(" ('{}' is the largest)", self.name)
        };
        let bytes = if self.bytes == u64::MAX {
            "more".into()
        } else {
            self.bytes.to_string()
        };
        write!(
            f,
            "the variables of the shader take {bytes} bytes{largest}; {MAX_BYTES} are allowed. Use a buffer"
        )
    }
}

const CONSTANT: u32 = 43;
const SPEC_CONSTANT: u32 = 50;
const SPEC_CONSTANT_OP: u32 = 52;
const VARIABLE: u32 = 59;
/// Storage classes with memory per invocation, workgroup or vertex: Input, Output, Workgroup,
/// Private, Function.
const OWN: [u32; 5] = [1, 3, 4, 6, 7];
/// Instructions with a result type as first operand: undefined, constants, function, parameter,
/// call, load, composites, copies, select, phi.
const VALUES: [u32; 15] = [
    1,
    44,
    46,
    51,
    54,
    55,
    57,
    61,
    80,
    82,
    83,
    169,
    245,
    400,
    SPEC_CONSTANT_OP,
];

/// Checks a module. `constants` overrides specialisation constants by id.
///
/// # Errors
/// Variables above `MAX_BYTES` in total, or one value above it.
pub fn check_sizes(words: &[u32], constants: &[(u32, u32)]) -> Result<(), TooLarge> {
    let (numbers, mut sizes) = (numbers(words, constants), Sizes::default());
    let (mut sum, mut largest) = (0u64, (0, 0));
    for i in instructions(words) {
        sizes.declare(i, &numbers);
        match (opcode(i), i) {
            (VARIABLE, [_, pointer, id, class, ..]) if OWN.contains(class) => {
                let bytes = sizes.pointee.get(pointer).map_or(0, |ty| sizes.of(*ty));
                sum = sum.saturating_add(bytes);
                largest = largest.max((bytes, *id));
            }
            (op, [_, ty, id, ..]) if VALUES.contains(&op) && sizes.of(*ty) > MAX_BYTES => {
                return Err(TooLarge {
                    name: name_of(words, *id),
                    bytes: sizes.of(*ty),
                });
            }
            _ => {}
        }
    }
    if sum > MAX_BYTES {
        Err(TooLarge {
            name: name_of(words, largest.1),
            bytes: sum,
        })
    } else {
        Ok(())
    }
}

/// Sizes of types by id (bytes), and pointee types.
#[derive(Default)]
struct Sizes {
    bytes: BTreeMap<u32, u64>,
    pointee: BTreeMap<u32, u32>,
}

impl Sizes {
    fn of(&self, ty: u32) -> u64 {
        self.bytes.get(&ty).copied().unwrap_or(0)
    }

    /// Records a type: SPIR-V 1.6, section 3.52.6.
    fn declare(&mut self, i: &[u32], numbers: &BTreeMap<u32, u64>) {
        let (id, bytes) = match (opcode(i), i) {
            // OpTypeBool.
            (20, [_, id]) => (*id, 4),
            // OpTypeInt, OpTypeFloat.
            (21 | 22, [_, id, width, ..]) => (*id, u64::from(*width).div_ceil(8)),
            // OpTypeVector, OpTypeMatrix.
            (23 | 24, [_, id, of, count]) => (*id, self.of(*of).saturating_mul(u64::from(*count))),
            // OpTypeArray; a length that cannot be computed counts as too long.
            (28, [_, id, of, length]) => {
                let count = numbers.get(length).copied().unwrap_or(u64::MAX);
                (*id, self.of(*of).saturating_mul(count))
            }
            // OpTypeStruct.
            (30, [_, id, members @ ..]) => (
                *id,
                members
                    .iter()
                    .fold(0u64, |sum, member| sum.saturating_add(self.of(*member))),
            ),
            // OpTypePointer.
            (32, [_, id, _, pointee]) => {
                self.pointee.insert(*id, *pointee);
                return;
            }
            _ => return,
        };
        self.bytes.insert(id, bytes);
    }
}

/// Values of integer constants by id.
fn numbers(words: &[u32], constants: &[(u32, u32)]) -> BTreeMap<u32, u64> {
    const DECORATE: u32 = 71;
    const SPEC_ID: u32 = 1;
    let ids: BTreeMap<u32, u32> = instructions(words)
        .filter_map(|i| match i {
            [_, id, SPEC_ID, number] if opcode(i) == DECORATE => Some((*id, *number)),
            _ => None,
        })
        .collect();
    let given = |id: &u32| {
        let number = ids.get(id)?;
        constants
            .iter()
            .find(|(known, _)| known == number)
            .map(|(_, value)| u64::from(*value))
    };
    let mut known = BTreeMap::new();
    for i in instructions(words) {
        let found = match (opcode(i), i) {
            (CONSTANT, [_, _, id, value]) => Some((*id, u64::from(*value))),
            (SPEC_CONSTANT, [_, _, id, value]) => {
                Some((*id, given(id).unwrap_or(u64::from(*value))))
            }
            (SPEC_CONSTANT_OP, [_, _, id, op, operands @ ..]) => {
                let operands: Option<Vec<u64>> =
                    operands.iter().map(|o| known.get(o).copied()).collect();
                operands
                    .and_then(|list| computed(*op, &list))
                    .map(|value| (*id, value))
            }
            _ => None,
        };
        known.extend(found);
    }
    known
}

/// Upper bound of an operation on constants, for operations that array lengths use.
fn computed(op: u32, operands: &[u64]) -> Option<u64> {
    match (op, operands) {
        (128, [a, b]) => Some(a.saturating_add(*b)),
        // A negative difference wraps to 32 bits.
        (130, [a, b]) => Some(a.checked_sub(*b).unwrap_or(u64::from(u32::MAX))),
        (132, [a, b]) => Some(a.saturating_mul(*b)),
        (134 | 135, [a, b]) => a.checked_div(*b),
        (194 | 195, [a, b]) => Some(a.checked_shr(u32::try_from(*b).ok()?).unwrap_or(0)),
        (196, [a, b]) => a.checked_mul(1u64.checked_shl(u32::try_from(*b).ok()?)?),
        _ => None,
    }
}

/// The name of an id: OpName.
fn name_of(words: &[u32], id: u32) -> String {
    let text = instructions(words).find_map(|i| match i {
        [_, named, text @ ..] if opcode(i) == 5 && *named == id => Some(text),
        _ => None,
    });
    let bytes = text
        .unwrap_or_default()
        .iter()
        .flat_map(|w| w.to_le_bytes())
        .take_while(|b| *b != 0);
    String::from_utf8_lossy(&bytes.collect::<Vec<_>>()).into_owned()
}
