//! Shown values and failed checks of shaders (`shaders/common/debug.glsl`), read from their buffer.

use super::debug::{CHECKS, DEBUG_BUFFER, VALUES};
use super::definition::Graph;
use super::link::Linked;
use crate::shader::{DebugName, debug_names};
use std::fmt;

/// A shown value or a failed check.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DebugRow {
    /// Name in the shader.
    pub name: String,
    /// The value; of a check the number of failures and the first place.
    pub value: String,
    /// Names of the passes that run the shader.
    pub pass: String,
    /// File in the shader folder.
    pub file: String,
    /// Line of the call.
    pub line: u32,
}

/// Everything that shaders recorded in a frame.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Debug {
    /// Shown values, in the order in which they were recorded.
    pub values: Vec<DebugRow>,
    /// Checks that failed.
    pub failed: Vec<DebugRow>,
    /// Values that did not fit.
    pub lost: usize,
}

impl fmt::Display for DebugRow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let DebugRow {
            name,
            value,
            pass,
            file,
            line,
        } = self;
        write!(f, "check '{name}' {value} (pass '{pass}', {file}:{line})")
    }
}

impl Debug {
    /// Number of the buffer.
    pub fn buffer(graph: &Graph) -> Option<usize> {
        graph.buffer(DEBUG_BUFFER)
    }

    /// Whether one of these passes records anything.
    pub fn is_recorded(linked: &[Linked], passes: &[usize]) -> bool {
        let bound = passes.iter().flat_map(|p| &linked[*p].bound);
        bound.into_iter().any(|b| b.name == DEBUG_BUFFER)
    }

    /// Names that the shaders of these passes use, each with its passes.
    pub(crate) fn names(
        graph: &Graph,
        linked: &[Linked],
        passes: &[usize],
    ) -> Vec<(String, DebugName)> {
        let mut names: Vec<(String, DebugName)> = Vec::new();
        for pass in passes {
            let title = graph.pass_name(*pass);
            let records = linked[*pass]
                .bound
                .iter()
                .filter(|b| b.name == DEBUG_BUFFER);
            for stage in records.map(|b| b.stage) {
                let shaders = linked[*pass].stages.iter().filter(|s| s.stage == stage);
                for name in shaders.flat_map(|s| debug_names(&s.file, &s.texts)) {
                    match names.iter_mut().find(|(_, known)| *known == name) {
                        Some((passes, _)) => *passes = format!("{passes}, {title}"),
                        None => names.push((title.to_string(), name)),
                    }
                }
            }
        }
        names
    }

    /// The content of the buffer.
    pub(crate) fn read(names: &[(String, DebugName)], bytes: &[u8]) -> Debug {
        let word = |at: usize| {
            let bytes = bytes.get(at..at + 4).and_then(|b| b.try_into().ok());
            bytes.map_or(0, u32::from_ne_bytes)
        };
        let row = |(pass, name): &(String, DebugName), value: String| DebugRow {
            name: name.name.clone(),
            value,
            pass: pass.clone(),
            file: name.file.clone(),
            line: name.line,
        };
        let mut found = Debug::default();
        let count = word(0) as usize;
        found.lost = count.saturating_sub(VALUES.1);
        for i in 0..count.min(VALUES.1) {
            let at = VALUES.0 + i * VALUES.2;
            let value = [2, 3, 4, 5].map(|k| word(at + 4 * k));
            let known = names.iter().find(|n| n.1.id == word(at));
            found
                .values
                .extend(known.map(|name| row(name, text(word(at + 4), value))));
        }
        for name in names.iter().filter(|n| n.1.is_check) {
            let slot = name.1.id as usize % CHECKS.1;
            let at = CHECKS.0 + slot * CHECKS.2;
            let (failed, first) = (word(at), !word(at + 4));
            if failed > 0 {
                let place = place(first);
                let value = format!("failed {failed} times, first at {place}");
                found.failed.push(row(name, value));
            }
        }
        found
    }
}

/// A value of a type of `debug.glsl`.
fn text(kind: u32, bits: [u32; 4]) -> String {
    let number = |bits: &u32| match kind >> 2 {
        0 => f32::from_bits(*bits).to_string(),
        1 => bits.cast_signed().to_string(),
        2 => bits.to_string(),
        _ => (*bits != 0).to_string(),
    };
    let parts: Vec<String> = bits[..=(kind & 3) as usize].iter().map(number).collect();
    parts.join(" ")
}

/// The place of a `debugKey` of `debug.glsl`.
fn place(key: u32) -> String {
    match key >> 30 {
        0 | 1 => format!("{} {}", key & 0xffff, key >> 16),
        2 => format!("{} 0", key & 0x3fff_ffff),
        _ => format!("{} {} {}", key & 1023, key >> 10 & 1023, key >> 20 & 1023),
    }
}
