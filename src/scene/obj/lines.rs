//! Lines of OBJ and MTL files: byte order marks, line ends, continuations, comments and case.

use std::borrow::Cow;

/// Decodes the text of a file. UTF-16 is detected by its byte order mark; invalid UTF-8 is
/// replaced, because old files use other encodings.
pub(super) fn decode(bytes: Vec<u8>) -> String {
    let utf16 = |rest: &[u8], unit: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = rest
            .as_chunks::<2>()
            .0
            .iter()
            .map(|pair| unit(*pair))
            .collect();
        String::from_utf16_lossy(&units)
    };
    match bytes.as_slice() {
        [0xff, 0xfe, rest @ ..] => utf16(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => utf16(rest, u16::from_be_bytes),
        _ => String::from_utf8(bytes)
            .unwrap_or_else(|error| String::from_utf8_lossy(error.as_bytes()).into_owned()),
    }
}

/// A statement with joined continuation lines and trimmed blanks.
#[derive(Debug, PartialEq)]
pub(super) struct Line<'a> {
    /// Number of its first line, from 1.
    pub number: usize,
    pub text: Cow<'a, str>,
}

impl Line<'_> {
    /// The lower-case keyword and the arguments.
    pub fn split(&self) -> (Cow<'_, str>, &str) {
        let (key, rest) = self.text.split_once(is_blank).unwrap_or((&self.text, ""));
        let lower = key.bytes().any(|b| b.is_ascii_uppercase());
        let key = if lower {
            Cow::Owned(key.to_ascii_lowercase())
        } else {
            Cow::Borrowed(key)
        };
        (key, rest.trim_matches(is_blank))
    }
}

/// The statements of a text without empty lines and comments.
pub(super) fn lines(text: &str) -> impl Iterator<Item = Line<'_>> {
    let mut rest = text;
    let mut number = 0;
    std::iter::from_fn(move || {
        loop {
            let line = next_line(&mut rest)?;
            number += 1;
            if line.is_empty() || line.starts_with('#') {
                continue;
            }
            let first = number;
            let Some(begin) = line.strip_suffix('\\') else {
                return Some(Line {
                    number: first,
                    text: Cow::Borrowed(line),
                });
            };
            let mut joined = begin.to_owned();
            while let Some(more) = next_line(&mut rest) {
                number += 1;
                joined.push(' ');
                joined.push_str(more.strip_suffix('\\').unwrap_or(more));
                if !more.ends_with('\\') {
                    break;
                }
            }
            return Some(Line {
                number: first,
                text: Cow::Owned(joined.trim_matches(is_blank).to_owned()),
            });
        }
    })
}

/// The next trimmed line, ended by LF, CR or CRLF.
fn next_line<'a>(rest: &mut &'a str) -> Option<&'a str> {
    if rest.is_empty() {
        return None;
    }
    let text: &'a str = rest;
    let bytes = text.as_bytes();
    let end = bytes
        .iter()
        .position(|b| matches!(b, b'\n' | b'\r'))
        .unwrap_or(bytes.len());
    let both = bytes[end..].starts_with(b"\r\n");
    *rest = text.get(end + 1 + usize::from(both)..).unwrap_or_default();
    Some(text[..end].trim_matches(is_blank))
}

/// Blanks, byte order marks (from concatenated files), and the end-of-file character of DOS.
fn is_blank(c: char) -> bool {
    c.is_whitespace() || matches!(c, '\0' | '\u{1a}' | '\u{feff}')
}

/// The words before a comment.
pub(super) fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split('#')
        .next()
        .unwrap_or_default()
        .split(is_blank)
        .filter(|word| !word.is_empty())
}

/// A name without a trailing comment. `Material #25` of 3ds Max is a name.
pub(in crate::scene) fn without_comment(text: &str) -> &str {
    let is_comment = |at: &(usize, &str)| {
        let before = text[..at.0].ends_with(is_blank);
        before && !text[at.0 + 1..].starts_with(|c: char| c.is_ascii_digit())
    };
    let end = text
        .match_indices('#')
        .find(is_comment)
        .map_or(text.len(), |(at, _)| at);
    text[..end].trim_end_matches(is_blank)
}

/// A name shortened to one line for a message.
pub(in crate::scene) fn shown(name: &str) -> String {
    const LONGEST: usize = 60;
    let end = if name.chars().nth(LONGEST).is_some() {
        "..."
    } else {
        ""
    };
    let clean = |c: char| {
        if c.is_control() {
            char::REPLACEMENT_CHARACTER
        } else {
            c
        }
    };
    name.chars()
        .take(LONGEST)
        .map(clean)
        .chain(end.chars())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statements_have_one_form() {
        let text = "\u{feff}v 1 2\r\n# no\rF 1 2 \\\n 3\n\n  usemtl\tA b # c\n\u{1a}";
        let found: Vec<(usize, String, String)> = lines(text)
            .map(|line| {
                (
                    line.number,
                    line.split().0.into_owned(),
                    line.split().1.to_owned(),
                )
            })
            .collect();
        let expected = [
            (1, "v", "1 2"),
            (3, "f", "1 2  3"),
            (6, "usemtl", "A b # c"),
        ];
        assert_eq!(
            found,
            expected.map(|(n, key, rest)| (n, key.to_owned(), rest.to_owned()))
        );
    }

    #[test]
    fn comments_end_names_and_numbers() {
        assert_eq!(without_comment("red # wall"), "red");
        assert_eq!(without_comment("Material #25"), "Material #25");
        assert_eq!(without_comment("a#b"), "a#b");
        assert_eq!(words("1 2#3 4").collect::<Vec<_>>(), ["1", "2"]);
    }

    #[test]
    fn texts_have_several_encodings() {
        assert_eq!(decode(b"\xff\xfev\0 \0".to_vec()), "v ");
        assert_eq!(decode(b"\xfe\xff\0v".to_vec()), "v");
        assert_eq!(decode(b"caf\xe9".to_vec()), "caf\u{fffd}");
    }
}
