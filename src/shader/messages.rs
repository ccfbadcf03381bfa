//! The compiler's messages about a shader: without consequences of earlier errors, and with the
//! name that an unknown one may stand for.

use super::macros::{Line, lines};
use super::names::{Names, names};
use crate::diagnostics::nearest;
use std::collections::BTreeMap;

/// The generated include that declares the parameters.
const PARAMS: &str = "params.glsl";

/// Tokens of a shader's files by line.
type Files<'t> = BTreeMap<&'t str, Vec<Line<'t>>>;

/// A message of the compiler.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Message {
    /// File in the shader folder.
    pub file: String,
    /// Line, from 1.
    pub line: u32,
    /// Whether the shader cannot be compiled.
    pub is_error: bool,
    /// The message.
    pub text: String,
    /// The name that may be meant.
    pub help: Option<String>,
}

/// Maximum messages read from the compiler's output.
const MAX_MESSAGES: usize = 500;

/// The messages in the compiler's output.
pub(super) fn messages(output: &str, texts: &BTreeMap<String, String>) -> Vec<Message> {
    let files: Files<'_> = texts.iter().map(|(f, t)| (f.as_str(), lines(t))).collect();
    let names = names(files.values().flatten());
    let mut list: Vec<Message> = Vec::new();
    let all = output.lines().filter_map(|line| message(line, texts));
    for found in all.take(MAX_MESSAGES) {
        let statement = statement(&found, &files);
        let unknown = Unknown::of(&found.text).filter(|u| !u.is_known(&names));
        let help = unknown.and_then(|u| u.help(&statement.tokens, texts, &names));
        let is_cause = unknown.is_some() || !found.is_error;
        if (is_cause || !list.iter().any(|m| statement.follows(m))) && !list.contains(&found) {
            list.push(Message { help, ..found });
        }
    }
    // Every name of a missing include is unknown.
    let is_include = |m: &Message| m.text.starts_with("'#include'");
    if let Some(first) = list.iter().position(is_include) {
        return vec![list.swap_remove(first)];
    }
    list
}

/// A line of the compiler's output: `FILE:LINE: error: TEXT`.
fn message(line: &str, texts: &BTreeMap<String, String>) -> Option<Message> {
    let parts: Vec<&str> = line.splitn(4, ':').collect();
    let &[file, number, level, text] = &parts[..] else {
        return None;
    };
    let line = number.parse().ok().filter(|_| texts.contains_key(file))?;
    Some(Message {
        file: file.into(),
        line,
        is_error: level.trim() == "error",
        text: text.trim().into(),
        help: None,
    })
}

/// A name that the compiler does not find.
#[derive(Clone, Copy)]
struct Unknown<'m> {
    name: &'m str,
    kind: Kind,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Variable,
    Function,
    Member,
}

impl<'m> Unknown<'m> {
    fn of(message: &'m str) -> Option<Unknown<'m>> {
        let (name, rest) = message.strip_prefix('\'')?.split_once('\'')?;
        let kinds = [
            ("undeclared identifier", Kind::Variable),
            ("no matching overloaded function", Kind::Function),
            ("no such field", Kind::Member),
        ];
        let kind = kinds.iter().find(|(text, _)| rest.contains(text))?.1;
        Some(Unknown { name, kind })
    }

    /// Whether a function of this name has other arguments.
    fn is_known(&self, names: &Names<'_>) -> bool {
        self.kind == Kind::Function && names.functions.contains(self.name)
    }

    fn help(
        &self,
        statement: &[&str],
        texts: &BTreeMap<String, String>,
        names: &Names<'_>,
    ) -> Option<String> {
        let members: Vec<&str> = texts.get(PARAMS).map_or(Vec::new(), |t| params_members(t));
        match self.kind {
            Kind::Function => nearest(self.name, names.functions.iter().copied()),
            Kind::Variable => {
                let help = nearest(self.name, names.variables.iter().copied())?;
                let is_meant = |m: &&str| help == format!("did you mean '{m}'?");
                let member = members.iter().find(|m| is_meant(m));
                Some(member.map_or(help.clone(), |m| format!("did you mean 'params.{m}'?")))
            }
            Kind::Member => {
                let in_params = statement
                    .windows(3)
                    .any(|t| t[0] == "params" && t[1] == "." && t[2] == self.name);
                nearest(self.name, members.into_iter().filter(|_| in_params))
            }
        }
    }
}

/// Lines that a statement spans, and its tokens.
struct Statement<'t> {
    file: String,
    first: u32,
    last: u32,
    tokens: Vec<&'t str>,
}

impl Statement<'_> {
    /// Whether its errors are consequences of an earlier message: one about the same statement, or
    /// about an unknown variable that it uses.
    fn follows(&self, earlier: &Message) -> bool {
        let is_inside = (self.first..=self.last).contains(&earlier.line);
        let unknown = Unknown::of(&earlier.text).filter(|u| u.kind == Kind::Variable);
        let is_used = unknown.is_some_and(|u| self.tokens.contains(&u.name));
        earlier.is_error && (is_used || (is_inside && self.file == earlier.file))
    }
}

/// The statement at a message's line.
fn statement<'t>(message: &Message, files: &Files<'t>) -> Statement<'t> {
    let lines = files.get(message.file.as_str()).map_or(&[][..], |l| l);
    let ends = |line: &&Line<'_>| {
        let last = line.tokens.last().copied().unwrap_or_default();
        line.directive().is_some() || matches!(last, ";" | "{" | "}")
    };
    let start = lines
        .iter()
        .rposition(|l| l.number < message.line && ends(&l));
    let own = &lines[start.map_or(0, |i| i + 1)..];
    let end = own
        .iter()
        .position(|l| l.number >= message.line && ends(&l));
    let own = &own[..end.map_or(own.len(), |i| i + 1)];
    Statement {
        file: message.file.clone(),
        first: own.first().map_or(message.line, |l| l.number),
        last: own.last().map_or(message.line, |l| l.number),
        tokens: own.iter().flat_map(|l| l.tokens.iter().copied()).collect(),
    }
}

/// Member names of the parameter block in the generated include.
fn params_members(text: &str) -> Vec<&str> {
    let block = text
        .lines()
        .skip_while(|l| !l.contains("uniform Params"))
        .skip(1)
        .take_while(|l| !l.starts_with('}'));
    block
        .filter_map(|line| line.trim().strip_suffix(';')?.split_whitespace().nth(1))
        .collect()
}
