//! Makes untrusted text safe and short enough to print.

/// The text without control characters that terminals interpret; tabs and line ends are kept.
pub fn harmless(text: &str) -> String {
    text.chars().map(plain).collect()
}

fn plain(c: char) -> char {
    if c.is_control() && c != '\n' && c != '\t' {
        char::REPLACEMENT_CHARACTER
    } else {
        c
    }
}

/// At most `most` characters, with an ellipsis if shortened, and without control characters.
pub fn excerpt(text: &str, most: usize) -> String {
    let mut out: String = text
        .chars()
        .take(most)
        .map(|c| if c == '\t' { ' ' } else { plain(c) })
        .collect();
    if text.chars().nth(most).is_some() {
        out.push_str(" ...");
    }
    out
}

/// The text, cut to a number of characters.
pub fn cut(text: &str, most: usize) -> String {
    match text.chars().count() <= most {
        true => text.to_string(),
        false => text.chars().take(most - 1).chain(['…']).collect(),
    }
}

/// At most `most` characters of a line around a column (from 1; 0 if unknown).
pub fn excerpt_at(line: &str, column: usize, most: usize) -> String {
    let first = if column + 20 > most {
        column - most / 2
    } else {
        0
    };
    let rest = line
        .char_indices()
        .nth(first)
        .map_or("", |(i, _)| &line[i..]);
    format!(
        "{}{}",
        if first > 0 { "... " } else { "" },
        excerpt(rest, most)
    )
}

/// A chain of names, shortened in the middle.
pub fn chain(names: &[String]) -> String {
    let short = |names: &[String]| {
        names
            .iter()
            .map(|n| excerpt(n, 60))
            .collect::<Vec<_>>()
            .join(" > ")
    };
    match names.len() {
        0..=8 => short(names),
        n => format!("{} > ... > {}", short(&names[..4]), short(&names[n - 3..])),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_and_control_characters_are_not_shown() {
        assert_eq!(excerpt("a\0b\tc", 9), "a\u{fffd}b c");
        assert_eq!(excerpt("abcdef", 3), "abc ...");
        assert_eq!(excerpt_at("short", 3, 80), "short");
        let line = format!("{}HERE{}", "x".repeat(1000), "y".repeat(1000));
        let shown = excerpt_at(&line, 1001, 80);
        assert!(shown.contains("HERE") && shown.len() < 100, "{shown}");
        assert!(excerpt_at(&line, 0, 80).len() < 100);
    }
}
