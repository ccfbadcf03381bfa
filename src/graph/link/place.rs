//! Where shaders declare names.

use crate::diagnostics::{Diagnostic, Place};
use crate::shader::{Compiled, find};
use foldhash::fast::RandomState;
use std::collections::HashSet;
use std::path::Path;

/// An error at the line of a member, `type member;`, before the line where a shader declares its
/// block; there, where the member has no line of its own.
pub(super) fn at_member(
    shaders: &Path,
    shader: &Compiled,
    name: &str,
    member: &str,
    message: String,
) -> Diagnostic {
    let block = at_declaration(shaders, shader, name, message);
    let declares = |line: &str| {
        let word = line.split_whitespace().nth(1).unwrap_or("");
        word.strip_prefix(member)
            .is_some_and(|rest| rest.starts_with([';', '[', ',']))
    };
    let text = shader
        .texts
        .iter()
        .find(|(file, _)| block.place.file.ends_with(file.as_str()))
        .map(|(_, t)| t);
    let lines = (1u32..).zip(text.map_or("", String::as_str).lines());
    match lines
        .take_while(|(n, _)| *n <= block.place.line)
        .filter(|(_, line)| declares(line))
        .last()
    {
        Some((line, source)) => Diagnostic {
            place: Place {
                line,
                ..block.place
            },
            source: Some(source.trim().into()),
            ..block
        },
        None => block,
    }
}

/// An error at the line where a shader declares a name.
pub(super) fn at_declaration(
    shaders: &Path,
    shader: &Compiled,
    name: &str,
    message: String,
) -> Diagnostic {
    // The declaration stands after `uniform` or `buffer`, or closes a block: `} name;`.
    let declares = |line: &str| {
        has_word(line, name)
            && (line.contains("uniform")
                || line.contains("buffer")
                || line.trim_start().starts_with('}'))
    };
    let main = std::iter::once(&shader.file).chain(shader.texts.keys());
    for file in main {
        let Some(text) = shader.texts.get(file) else {
            continue;
        };
        if let Some((number, line)) = (1u32..).zip(text.lines()).find(|(_, l)| declares(l)) {
            let path = find(shaders, file).unwrap_or_else(|| shaders.join(file));
            let place = Place {
                file: path,
                line: number,
                column: 0,
            };
            return Diagnostic {
                source: Some(line.trim().into()),
                ..Diagnostic::error(place, message)
            };
        }
    }
    Diagnostic::error(
        Place {
            file: shaders.join(&shader.file),
            ..Place::default()
        },
        message,
    )
}

/// Whether a text has a name as a whole word.
pub fn has_word(text: &str, name: &str) -> bool {
    text.match_indices(name).any(|(i, _)| {
        let edge = |c: Option<char>| c.is_none_or(|c| !c.is_alphanumeric() && c != '_');
        edge(text[..i].chars().next_back()) && edge(text[i + name.len()..].chars().next())
    })
}

/// The words of some texts, and pairs of words with a point between them, as `params.name`. An
/// index, because texts are long and many names are looked up.
pub(super) struct Words<'t>(HashSet<&'t str, RandomState>);

impl<'t> Words<'t> {
    pub(super) fn of(texts: impl IntoIterator<Item = &'t str>) -> Words<'t> {
        let mut words = HashSet::default();
        for text in texts {
            let (mut start, mut before) = (0, None);
            for (end, c) in text.char_indices().chain([(text.len(), ' ')]) {
                if c.is_alphanumeric() || c == '_' {
                    continue;
                }
                words.insert(&text[start..end]);
                words.extend(before.map(|from: usize| &text[from..end]));
                before = (c == '.').then_some(start);
                start = end + c.len_utf8();
            }
        }
        Words(words)
    }

    /// As [`has_word`].
    pub(super) fn has(&self, name: &str) -> bool {
        self.0.contains(name)
    }
}

#[cfg(test)]
mod tests {
    use super::{Words, has_word};

    #[test]
    fn words_are_those_that_stand_alone() {
        let text =
            "uniform Params { float a; } params;\nx = params.a_b + params.é.c - s.params.d; // end";
        let words = Words::of([text, ""]);
        for name in [
            "params",
            "a",
            "a_b",
            "params.a_b",
            "params.a",
            "b",
            "é",
            "params.é",
            "é.c",
            "params.d",
            "d",
            "end",
            "e",
        ] {
            assert_eq!(words.has(name), has_word(text, name), "{name}");
        }
        assert!(words.has("params.a_b") && !words.has("params.a") && !words.has("para"));
    }
}
