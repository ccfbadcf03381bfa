//! RON files with positions: every checked value keeps its position, and an invalid item does not
//! hide the errors of others.

pub(crate) mod excerpt;
pub(crate) mod panics;

use crate::files::read_input_text;
use excerpt::{excerpt, excerpt_at, harmless};
use ron::extensions::Extensions;
use serde::de::{Deserialize, Deserializer, Error as _};
use std::cell::RefCell;
use std::fmt;
use std::path::{Path, PathBuf};

/// A position in a file, or a whole file if `line` is 0.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// The file as the user named it.
    pub file: PathBuf,
    /// Line, from 1.
    pub line: u32,
    /// Column, from 1; 0 if only the line is known.
    pub column: u32,
}

/// Severity of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The input is rejected.
    Error,
    /// The input is accepted.
    Warning,
}

/// A finding about an input file.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// Severity.
    pub severity: Severity,
    /// Position of the finding.
    pub place: Place,
    /// The problem and the expected input.
    pub message: String,
    /// A remedy, for example the nearest known name.
    pub help: Option<String>,
    /// The line it is about.
    pub source: Option<String>,
}

impl Diagnostic {
    /// An error at a position.
    pub fn error(place: Place, message: impl Into<String>) -> Diagnostic {
        Diagnostic {
            severity: Severity::Error,
            place,
            message: message.into(),
            help: None,
            source: None,
        }
    }

    /// A warning at a position.
    pub fn warning(place: Place, message: impl Into<String>) -> Diagnostic {
        Diagnostic {
            severity: Severity::Warning,
            ..Diagnostic::error(place, message)
        }
    }

    /// Adds a hint.
    pub(crate) fn help(mut self, help: Option<String>) -> Diagnostic {
        self.help = help;
        self
    }

    /// Joins messages by line ends.
    pub fn joined(list: &[Diagnostic]) -> String {
        list.iter()
            .map(ToString::to_string)
            .collect::<Vec<_>>()
            .join("\n")
    }

    /// Suggests the nearest known name, or lists all names if they are few.
    pub fn nearest<'a>(self, name: &str, known: impl IntoIterator<Item = &'a str>) -> Diagnostic {
        let help = nearest(name, known);
        self.help(help)
    }
}

/// Maximum length of a printed message or hint; they may quote the input.
const MAX_MESSAGE: usize = 2000;
/// Maximum length of a quoted line.
const MAX_LINE: usize = 240;

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Command line arguments have no lines.
        let file = self.place.file.to_string_lossy();
        let option = file.starts_with("--") || file == SETTINGS;
        write!(f, "{}", harmless(&file))?;
        if self.place.line > 0 && !option {
            write!(f, ":{}", self.place.line)?;
            if self.place.column > 0 {
                write!(f, ":{}", self.place.column)?;
            }
        }
        let level = if self.severity == Severity::Error {
            "error"
        } else {
            "warning"
        };
        write!(f, ": {level}: {}", excerpt(&self.message, MAX_MESSAGE))?;
        if let Some(source) = self.source.as_ref().filter(|_| !option) {
            write!(
                f,
                "\n    | {}",
                excerpt_at(source.trim_end(), self.place.column as usize, MAX_LINE)
            )?;
        }
        if let Some(help) = &self.help {
            write!(f, "\n    = help: {}", excerpt(help, MAX_MESSAGE))?;
        }
        Ok(())
    }
}

/// Begins the hint of a name that is close.
pub const DID_YOU_MEAN: &str = "did you mean";
/// Stands for a file in messages about settings that a program gives: they have no lines.
pub const SETTINGS: &str = "settings";

/// "did you mean 'x'?" if a known name is close, else a list of known names if it is short.
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let mut known: Vec<&str> = known.into_iter().collect();
    known.sort_unstable();
    known.dedup();
    let close = known
        .iter()
        .map(|k| {
            (
                strsim::jaro_winkler(&name.to_lowercase(), &k.to_lowercase()),
                *k,
            )
        })
        .max_by(|a, b| a.0.total_cmp(&b.0));
    match close {
        Some((score, k)) if score > 0.8 => Some(format!("{DID_YOU_MEAN} '{k}'?")),
        _ if known.is_empty() => None,
        _ if known.len() <= 12 => Some(format!("known: {}", known.join(", "))),
        _ => None,
    }
}

/// A value with its position.
#[derive(Clone, Debug, Default)]
pub struct Loc<T> {
    /// The parsed value.
    pub value: T,
    /// Position in its file.
    pub at: At,
}

/// File index and byte offset.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct At {
    /// Index in [`Sources`].
    pub(crate) file: u32,
    /// Offset from the start of the file (bytes).
    pub offset: u32,
}

/// Files read by a parser, with their text.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    files: Vec<(PathBuf, String)>,
}

/// RON files larger than this are refused.
const MAX_BYTES: u64 = 4 << 20;

impl Sources {
    /// Reads a file and returns its index.
    pub fn read(&mut self, path: &Path) -> Result<u32, Diagnostic> {
        let fail = |why: String| {
            Diagnostic::error(
                Place {
                    file: path.to_path_buf(),
                    ..Place::default()
                },
                format!("cannot read it: {why}"),
            )
        };
        let text = read_input_text(path, MAX_BYTES).map_err(|e| fail(e.to_string()))?;
        Ok(self.add(path, text))
    }

    /// Adds a text under a name.
    pub fn add(&mut self, path: &Path, text: String) -> u32 {
        self.files.push((path.to_path_buf(), text));
        u32::try_from(self.files.len() - 1).unwrap_or(u32::MAX)
    }

    /// Paths of all files read.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.files.iter().map(|(p, _)| p.as_path())
    }

    /// Path and text of all files read.
    pub fn texts(&self) -> impl Iterator<Item = (&Path, &str)> {
        self.files.iter().map(|(p, t)| (p.as_path(), t.as_str()))
    }

    /// Whether the files on disk are unchanged.
    pub(crate) fn are_current(&self) -> bool {
        self.files
            .iter()
            .all(|(path, text)| read_input_text(path, MAX_BYTES).is_ok_and(|now| now == *text))
    }

    /// Line and column of an offset.
    pub fn place(&self, at: At) -> Place {
        let Some((file, text)) = self.files.get(at.file as usize) else {
            return Place::default();
        };
        let before = text.get(..at.offset as usize).unwrap_or(text);
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
        Place {
            file: file.clone(),
            line: u32::try_from(line).unwrap_or(0),
            column: u32::try_from(column).unwrap_or(0),
        }
    }

    /// An error at an offset, with its source line.
    pub fn error(&self, at: At, message: impl Into<String>) -> Diagnostic {
        let place = self.place(at);
        let source = self
            .files
            .get(at.file as usize)
            .and_then(|(_, text)| text.lines().nth(place.line.saturating_sub(1) as usize))
            .map(String::from);
        Diagnostic {
            source,
            ..Diagnostic::error(place, message)
        }
    }

    /// Parses a file into `T`. Invalid items of [`Items`] and [`Entries`] are reported and skipped.
    /// Their names are added to `broken`, so that references to them are not reported too.
    pub fn parse<'s, T: Deserialize<'s>>(
        &'s self,
        file: u32,
        errors: &mut Vec<Diagnostic>,
        broken: &mut Vec<String>,
    ) -> Option<T> {
        let text = self
            .files
            .get(file as usize)
            .map_or("", |(_, t)| t.as_str());
        CONTEXT.set(Some(Context {
            file,
            base: text.as_ptr() as usize,
            len: text.len(),
            findings: Vec::new(),
            broken: Vec::new(),
        }));
        let parsed = options().from_str::<T>(text);
        if let Some(context) = CONTEXT.take() {
            for (offset, message, help) in context.findings {
                errors.push(self.error(At { file, offset }, message).help(help));
            }
            broken.extend(context.broken);
        }
        match parsed {
            Ok(value) => Some(value),
            Err(e) => {
                let (message, help) = explain(&e.code);
                if message != REPORTED {
                    let offset = offset_of(text, e.span.start.line, e.span.start.col);
                    errors.push(self.error(At { file, offset }, message).help(help));
                }
                None
            }
        }
    }
}

/// RON options of the program: `Some(x)` may be written `x`, and `Variant((a: 1))` as `Variant(a:
/// 1)`.
pub fn options() -> ron::Options {
    ron::Options::default()
        .with_default_extension(Extensions::IMPLICIT_SOME | Extensions::UNWRAP_VARIANT_NEWTYPES)
}

struct Context {
    file: u32,
    base: usize,
    len: usize,
    findings: Vec<(u32, String, Option<String>)>,
    broken: Vec<String>,
}

thread_local! {
    static CONTEXT: RefCell<Option<Context>> = const { RefCell::new(None) };
}

/// Marks an error that has been reported at its position.
const REPORTED: &str = "(reported)";

/// Error for files with more nested brackets than the parser supports.
pub(crate) const TOO_DEEP: &str = "brackets are nested too deeply; remove brackets around this";

fn explain(error: &ron::Error) -> (String, Option<String>) {
    match error {
        ron::Error::NoSuchStructField {
            expected, found, ..
        } => (
            format!("unknown field '{found}'"),
            nearest(found, expected.iter().copied()),
        ),
        ron::Error::NoSuchEnumVariant {
            expected, found, ..
        } => (
            format!("unknown name '{found}'"),
            nearest(found, expected.iter().copied()),
        ),
        ron::Error::MissingStructField { field, .. } => {
            (format!("field '{field}' is missing"), None)
        }
        ron::Error::ExpectedComma => (
            String::from("expected a comma"),
            Some(String::from(
                "one is missing before this, or a whole number has a point",
            )),
        ),
        ron::Error::ExpectedRawValue => (String::from("expected one value"), None),
        ron::Error::ExceededRecursionLimit => (TOO_DEEP.into(), None),
        ron::Error::Message(text) => (text.clone(), None),
        other => (other.to_string(), None),
    }
}

fn offset_of(text: &str, line: usize, column: usize) -> u32 {
    let start: usize = text
        .split_inclusive('\n')
        .take(line.saturating_sub(1))
        .map(str::len)
        .sum();
    let inside: usize = text[start.min(text.len())..]
        .chars()
        .take(column.saturating_sub(1))
        .map(char::len_utf8)
        .sum();
    u32::try_from((start + inside).min(text.len())).unwrap_or(0)
}

/// Offset of a slice of the file being parsed; 0 for values built in code.
pub(super) fn offset_in_file(slice: &str) -> At {
    CONTEXT.with_borrow(|context| {
        context.as_ref().map_or(At::default(), |c| {
            let offset = (slice.as_ptr() as usize).wrapping_sub(c.base);
            At {
                file: c.file,
                offset: u32::try_from(if offset <= c.len { offset } else { 0 }).unwrap_or(0),
            }
        })
    })
}

fn report(offset: u32, message: String, help: Option<String>) {
    CONTEXT.with_borrow_mut(|context| {
        if let Some(c) = context {
            c.findings.push((offset, message, help));
        }
    });
}

fn mark_broken<'a>(names: impl Iterator<Item = &'a str>) {
    CONTEXT.with_borrow_mut(|context| {
        if let Some(c) = context {
            c.broken.extend(names.map(String::from));
        }
    });
}

/// Parses a raw value; an error is reported at its position and gives `None`.
fn parse_raw<'de, T: Deserialize<'de>>(raw: &'de ron::value::RawValue) -> Option<Loc<T>> {
    let text = raw.trim().get_ron();
    let at = offset_in_file(text);
    match options().from_str::<T>(text) {
        Ok(value) => Some(Loc { value, at }),
        Err(e) => {
            let (message, help) = explain(&e.code);
            if message != REPORTED {
                report(
                    at.offset + offset_of(text, e.span.start.line, e.span.start.col),
                    message,
                    help,
                );
            }
            // Any quoted word of an invalid item may be a name.
            mark_broken(text.split('"').skip(1).step_by(2));
            None
        }
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Loc<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let raw = <&'de ron::value::RawValue>::deserialize(deserializer)?;
        parse_raw(raw).ok_or_else(|| D::Error::custom(REPORTED))
    }
}

/// Parses the content of a raw value; errors are reported at their position.
pub(super) fn nested<'de, T: Deserialize<'de>, E: serde::de::Error>(
    raw: &'de ron::value::RawValue,
) -> Result<T, E> {
    parse_raw(raw)
        .map(|found| found.value)
        .ok_or_else(|| E::custom(REPORTED))
}

/// A list; invalid items are reported and skipped.
#[derive(Clone, Debug)]
pub struct Items<T>(pub Vec<Loc<T>>);

impl<T> Default for Items<T> {
    fn default() -> Self {
        Items(Vec::new())
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Items<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let raws = Vec::<&'de ron::value::RawValue>::deserialize(deserializer)?;
        Ok(Items(raws.into_iter().filter_map(parse_raw).collect()))
    }
}

/// A map in file order; invalid values are reported and skipped.
#[derive(Clone, Debug)]
pub struct Entries<T>(pub Vec<(Loc<String>, Loc<T>)>);

impl<T> Default for Entries<T> {
    fn default() -> Self {
        Entries(Vec::new())
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Entries<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Visitor<T>(std::marker::PhantomData<T>);
        impl<'de, T: Deserialize<'de>> serde::de::Visitor<'de> for Visitor<T> {
            type Value = Entries<T>;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a map from names to values: { \"name\": (...) }")
            }
            fn visit_map<A: serde::de::MapAccess<'de>>(
                self,
                mut map: A,
            ) -> Result<Entries<T>, A::Error> {
                let mut out: Vec<(Loc<String>, Loc<T>)> = Vec::new();
                while let Some((key, raw)) =
                    map.next_entry::<Loc<String>, &'de ron::value::RawValue>()?
                {
                    let twice = out.iter().any(|(k, _)| k.value == key.value);
                    if twice {
                        report(key.at.offset, format!("'{}' stands twice", key.value), None);
                    }
                    match parse_raw(raw) {
                        Some(_) if twice => {}
                        Some(value) => out.push((key, value)),
                        None => mark_broken(std::iter::once(key.value.as_str())),
                    }
                }
                Ok(Entries(out))
            }
        }
        deserializer.deserialize_map(Visitor(std::marker::PhantomData))
    }
}

/// A tuple of two or three values.
#[derive(Clone, Debug)]
pub struct TwoOrThree<T>(pub Vec<Loc<T>>);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for TwoOrThree<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        type Raw<'r> = &'r ron::value::RawValue;
        let text = Raw::deserialize(deserializer)?.get_ron();
        let parts: Vec<Raw<'de>> = match options().from_str::<(Raw<'de>, Raw<'de>, Raw<'de>)>(text)
        {
            Ok((a, b, c)) => vec![a, b, c],
            Err(_) => match options().from_str::<(Raw<'de>, Raw<'de>)>(text) {
                Ok((a, b)) => vec![a, b],
                Err(_) => {
                    return Err(D::Error::custom(
                        "expected two sizes (width, height) or three (width, height, depth)",
                    ));
                }
            },
        };
        let values: Vec<Loc<T>> = parts.iter().copied().filter_map(parse_raw).collect();
        if values.len() < parts.len() {
            Err(D::Error::custom(REPORTED))
        } else {
            Ok(TwoOrThree(values))
        }
    }
}

/// A RON value kept as text; its parameter parses it.
#[derive(Clone, Debug, PartialEq)]
pub struct RawText(pub String);

impl<'de> Deserialize<'de> for RawText {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let raw = <&'de ron::value::RawValue>::deserialize(deserializer)?;
        Ok(RawText(raw.trim().get_ron().to_string()))
    }
}
