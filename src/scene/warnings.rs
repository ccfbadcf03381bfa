//! Warnings about one file, grouped by kind, so that a thousand similar channels give one line with
//! a count.

use std::fmt::Display;

/// Names listed per line; the rest is counted.
const SHOWN: usize = 3;

/// Warnings about one file by kind: content that is dropped or interpreted differently.
#[derive(Clone, Debug, Default)]
pub(crate) struct Warnings {
    kinds: Vec<Kind>,
}

#[derive(Clone, Debug)]
struct Kind {
    what: String,
    /// The first affected objects.
    names: Vec<String>,
    count: usize,
}

impl Warnings {
    /// Adds a warning. `what` is the sentence of its kind: the content, its treatment, and a remedy
    /// if there is one. `name` is the affected object; an empty name is counted but not listed.
    pub fn add(&mut self, what: impl Into<String>, name: impl Display) {
        let (what, name) = (what.into(), name.to_string());
        let kind = match self.kinds.iter_mut().position(|k| k.what == what) {
            Some(known) => &mut self.kinds[known],
            None => {
                self.kinds.push(Kind {
                    what,
                    names: Vec::new(),
                    count: 0,
                });
                let last = self.kinds.len() - 1;
                &mut self.kinds[last]
            }
        };
        kind.count += 1;
        if kind.names.len() < SHOWN && !name.is_empty() && !kind.names.contains(&name) {
            kind.names.push(name);
        }
    }

    /// One line per kind, in order of first occurrence, each prefixed with the file's name.
    pub fn lines(&self, file: impl Display) -> Vec<String> {
        self.kinds
            .iter()
            .map(|kind| format!("{file}: {kind}"))
            .collect()
    }
}

impl Display for Kind {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "{}", self.what)?;
        let list: Vec<String> = self.names.iter().map(|n| format!("'{n}'")).collect();
        match (list.is_empty(), self.count > self.names.len()) {
            (true, false) => Ok(()),
            (true, true) if self.count == 1 => Ok(()),
            (true, true) => write!(f, " ({} times)", self.count),
            (false, false) => write!(f, " ({})", list.join(", ")),
            (false, true) => write!(f, " ({} times: {}, ...)", self.count, list.join(", ")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thousand_of_a_kind_are_one_line() {
        let mut warnings = Warnings::default();
        for i in 0..1000 {
            warnings.add("animations of scale are left out", format!("bone {i}"));
        }
        warnings.add("COLOR_1 is left out", "cube");
        warnings.add("the file has no end", "");
        assert_eq!(
            warnings.lines("a.glb"),
            [
                "a.glb: animations of scale are left out (1000 times: 'bone 0', 'bone 1', 'bone 2', ...)",
                "a.glb: COLOR_1 is left out ('cube')",
                "a.glb: the file has no end",
            ]
        );
    }
}
