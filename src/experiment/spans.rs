//! Text positions of entries in a RON struct or map, and edits that keep all other text.

use std::ops::Range;

/// One `key: value`.
#[derive(Clone, Debug)]
pub(super) struct Entry {
    /// The key without quotes.
    pub key: String,
    /// From its first byte to the end of its comma, if any.
    pub whole: Range<usize>,
    pub value: Range<usize>,
    /// Whether a comma follows.
    pub comma: bool,
}

/// The text between two brackets.
#[derive(Clone, Debug)]
pub(super) struct Body {
    /// Entries in order.
    pub entries: Vec<Entry>,
    /// Offset of the closing bracket.
    pub close: usize,
}

/// The entries of the first bracket at or after `at`; `None` if the text has another form.
pub(super) fn body(text: &str, at: usize) -> Option<Body> {
    let open = blank(text, at);
    if !text.get(open..)?.starts_with(['(', '{']) {
        return None;
    }
    let mut entries = Vec::new();
    let mut at = blank(text, open + 1);
    loop {
        let rest = text.get(at..)?;
        if rest.starts_with([')', '}']) {
            return Some(Body { entries, close: at });
        }
        let start = at;
        let key_end = if rest.starts_with('"') {
            token(text, at)?
        } else {
            at + rest.find(|c: char| !c.is_alphanumeric() && c != '_')?
        };
        let key = text.get(start..key_end)?.trim_matches('"').to_string();
        at = blank(text, key_end);
        if key_end == start || !text.get(at..)?.starts_with(':') {
            return None;
        }
        let value_start = blank(text, at + 1);
        let value_end = value(text, value_start)?;
        at = blank(text, value_end);
        let comma = text.get(at..)?.starts_with(',');
        at += usize::from(comma);
        let end = if comma { at } else { value_end };
        entries.push(Entry {
            key,
            whole: start..end,
            value: value_start..value_end,
            comma,
        });
        at = blank(text, at);
    }
}

/// The end of the value that starts at `at`.
fn value(text: &str, mut at: usize) -> Option<usize> {
    let (mut depth, mut end) = (0u32, at);
    loop {
        match text.get(at..)?.chars().next()? {
            ',' | ')' | '}' | ']' if depth == 0 => return Some(end),
            '(' | '{' | '[' => depth += 1,
            ')' | '}' | ']' => depth -= 1,
            _ => {}
        }
        end = token(text, at)?;
        at = blank(text, end);
    }
}

/// The end of the string or single character at `at`.
fn token(text: &str, at: usize) -> Option<usize> {
    let rest = text.get(at..)?;
    if let Some(raw) = rest.strip_prefix('r') {
        let marks = raw.len() - raw.trim_start_matches('#').len();
        if raw[marks..].starts_with('"') {
            let end = format!("\"{}", "#".repeat(marks));
            let found = raw.get(marks + 1..)?.find(&end)?;
            return Some(at + 1 + marks + 1 + found + end.len());
        }
    }
    if !rest.starts_with('"') {
        return rest.chars().next().map(|c| at + c.len_utf8());
    }
    let mut escaped = false;
    for (i, c) in rest.char_indices().skip(1) {
        match c {
            '"' if !escaped => return Some(at + i + 1),
            '\\' => escaped = !escaped,
            _ => escaped = false,
        }
    }
    None
}

/// Skips white space and comments.
fn blank(text: &str, mut at: usize) -> usize {
    loop {
        let rest = text.get(at..).unwrap_or("");
        let trimmed = rest.trim_start();
        at += rest.len() - trimmed.len();
        if trimmed.starts_with("//") {
            at += trimmed.find('\n').unwrap_or(trimmed.len());
        } else if trimmed.starts_with("/*") {
            at += block_comment(trimmed);
        } else {
            return at;
        }
    }
}

/// Length of the nested block comment at the start of a text.
fn block_comment(text: &str) -> usize {
    let (mut depth, mut at) = (0u32, 0);
    while let Some(found) = text[at..].find(['/', '*']).map(|i| at + i) {
        match text.get(found..found + 2) {
            Some("/*") => (depth, at) = (depth + 1, found + 2),
            Some("*/") if depth == 1 => return found + 2,
            Some("*/") => (depth, at) = (depth - 1, found + 2),
            _ => at = found + 1,
        }
    }
    text.len()
}

/// Replacements of parts of a text.
pub(super) type Edits = Vec<(Range<usize>, String)>;

/// Applies edits that do not overlap.
pub(super) fn apply(text: &str, mut edits: Edits) -> String {
    edits.sort_by_key(|(range, _)| (range.start, range.end));
    let mut out = text.to_string();
    for (range, new) in edits.into_iter().rev() {
        out.replace_range(range, &new);
    }
    out
}

/// Removes an entry, including its line if only a comment remains there.
pub(super) fn remove(text: &str, entry: &Entry) -> (Range<usize>, String) {
    let line = text[..entry.whole.start].rfind('\n').map_or(0, |i| i + 1);
    let end = text[entry.whole.end..]
        .find('\n')
        .map(|i| entry.whole.end + i + 1);
    let after = &text[entry.whole.end..end.unwrap_or(text.len())];
    let alone = text[line..entry.whole.start].trim().is_empty()
        && (after.trim().is_empty() || after.trim_start().starts_with("//"));
    match end {
        Some(end) if alone => (line..end, String::new()),
        _ => (entry.whole.clone(), String::new()),
    }
}

/// Inserts lines after the last entry. `keeps_last`: whether the last entry stays.
pub(super) fn append(
    text: &str,
    body: &Body,
    keeps_last: bool,
    lines: &[String],
    edits: &mut Edits,
) {
    if lines.is_empty() {
        return;
    }
    if let Some(last) = body.entries.last().filter(|e| keeps_last && !e.comma) {
        edits.push((last.value.end..last.value.end, ",".into()));
    }
    let line = text[..body.close].rfind('\n').map_or(0, |i| i + 1);
    let before = &text[line..body.close];
    let indent: String = before.chars().take_while(|c| c.is_whitespace()).collect();
    let new: String = lines
        .iter()
        .map(|l| {
            format!(
                "{indent}    {}\n",
                l.replace('\n', &format!("\n{indent}    "))
            )
        })
        .collect();
    if before.trim().is_empty() {
        edits.push((line..line, new));
    } else {
        edits.push((body.close..body.close, format!("\n{new}{indent}")));
    }
}
