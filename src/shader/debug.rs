//! Names of shown values and checks (`shaders/common/debug.glsl`). GLSL has no strings: before
//! compilation each name becomes a number, on the same line.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::hash::{BuildHasher, Hash};

/// The include that declares `show` and `check`.
pub(crate) const DEBUG_FILE: &str = "common/debug.glsl";

/// A name in a call of `show` or `check`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct DebugName {
    /// The number in the shader.
    pub id: u32,
    /// Whether the call is a `check`.
    pub is_check: bool,
    /// The name.
    pub name: String,
    /// File in the shader folder.
    pub file: String,
    /// Line, from 1.
    pub line: u32,
}

/// Files of a shader by their names.
type Texts = BTreeMap<String, String>;

/// A misuse: file, line, message.
pub(super) type Misuse = (String, u32, String);

/// The names of a shader, by its files.
pub(crate) fn debug_names(shader: &str, texts: &BTreeMap<String, String>) -> Vec<DebugName> {
    numbered(shader, texts).map_or_else(|_| Vec::new(), |found| found.1)
}

/// The files of a shader with numbers in place of names, and these names.
///
/// # Errors
/// The first call without a string for its name.
pub(super) fn numbered<'t>(
    shader: &str,
    texts: &'t Texts,
) -> Result<(Cow<'t, Texts>, Vec<DebugName>), Misuse> {
    let mut names = Vec::new();
    if !texts.contains_key(DEBUG_FILE) {
        return Ok((Cow::Borrowed(texts), names));
    }
    let mut all = BTreeMap::new();
    for (file, text) in texts {
        let text = if file == DEBUG_FILE {
            text.clone()
        } else {
            file_numbered(shader, file, text, &mut names)?
        };
        all.insert(file.clone(), text);
    }
    let others = texts.iter().filter(|(file, _)| *file != DEBUG_FILE);
    if names.is_empty() && !others.map(|f| f.1).any(|text| selects(text)) {
        // Its variables would change the instructions of a shader that calls nothing.
        all.insert(DEBUG_FILE.to_string(), String::new());
    }
    Ok((Cow::Owned(all), names))
}

/// Whether a file uses another function of the include, such as `debugIf`.
fn selects(text: &str) -> bool {
    let mut words = text.split(|c| !is_word(c));
    words.any(|w| w.len() > 5 && w.starts_with("debug"))
}

/// A file with numbers in place of names.
fn file_numbered(
    shader: &str,
    file: &str,
    text: &str,
    names: &mut Vec<DebugName>,
) -> Result<String, Misuse> {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let length = if rest.starts_with("//") || is_directive(&out, first) {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if is_word(first) {
            rest.find(|c| !is_word(c)).unwrap_or(rest.len())
        } else {
            first.len_utf8()
        };
        let (token, after) = rest.split_at(length);
        out.push_str(token);
        rest = after;
        let arguments = rest.trim_start().strip_prefix('(');
        let (true, Some(arguments)) = (matches!(token, "show" | "check"), arguments) else {
            continue;
        };
        let line = 1 + out.matches('\n').count() as u32;
        let name = arguments.trim_start().strip_prefix('"');
        let Some((name, after)) = name.and_then(|name| name.split_once('"')) else {
            let message = format!("the first argument of '{token}' must be a name in quotes");
            return Err((file.into(), line, message));
        };
        if name.is_empty() || name.contains('\n') {
            let message = format!("the name of '{token}' must have one line");
            return Err((file.into(), line, message));
        }
        let id = number((shader, file, line, names.len(), name));
        out.push_str(&rest[..rest.len() - arguments.len()]);
        out.push_str(&arguments[..arguments.len() - arguments.trim_start().len()]);
        out.push_str(&format!("{id}u"));
        rest = after;
        names.push(DebugName {
            id,
            is_check: token == "check",
            name: name.into(),
            file: file.into(),
            line,
        });
    }
    Ok(out)
}

/// Whether a character begins a directive: `#` with only blanks before it on its line.
fn is_directive(before: &str, first: char) -> bool {
    let line = || before.rsplit('\n').next().unwrap_or_default();
    first == '#' && line().trim().is_empty()
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// A number that is the same in every run.
fn number(of: impl Hash) -> u32 {
    let hash = foldhash::quality::FixedState::with_seed(0).hash_one(of);
    (hash >> 32) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(main: &str) -> BTreeMap<String, String> {
        let files = [("main.comp", main), (DEBUG_FILE, "void show(uint name);")];
        BTreeMap::from(files.map(|(name, text)| (name.to_string(), text.to_string())))
    }

    #[test]
    fn names_become_numbers_on_their_lines() {
        let main = "#include \"common/debug.glsl\"\n// show(x)\nvoid main() {\n    show( \"a b\", f(\n1));/* check(2\n*/ \
                    check(\"c\", true); shower(x); }\n";
        let given = texts(main);
        let (all, names) = numbered("main.comp", &given).unwrap();
        assert_eq!(
            all["main.comp"],
            main.replace("\"a b\"", &format!("{}u", names[0].id))
                .replace("\"c\"", &format!("{}u", names[1].id))
        );
        let found: Vec<_> = names
            .iter()
            .map(|n| (n.name.as_str(), n.line, n.is_check))
            .collect();
        assert_eq!(found, [("a b", 4, false), ("c", 6, true)]);
        assert_eq!(all[DEBUG_FILE], texts("")[DEBUG_FILE]);
        let debug_file =
            |main: &str| numbered("main.comp", &texts(main)).unwrap().0[DEBUG_FILE].clone();
        assert_eq!(debug_file("// show, check"), "");
        assert_eq!(debug_file("debugIf(true);"), texts("")[DEBUG_FILE]);
    }

    #[test]
    fn a_name_is_a_string() {
        for call in ["show(x, 1);", "check(\"\", true);", "show (\n3u, 1);"] {
            let (file, line, _) = numbered("main.comp", &texts(&format!("\n{call}"))).unwrap_err();
            assert_eq!((file.as_str(), line), ("main.comp", 2), "{call}");
        }
    }
}
