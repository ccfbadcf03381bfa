//! Bounds a shader's macro expansion before compilation. Forty lines `#define B (A+A)`, each with
//! the name of the previous one, expand to a trillion tokens.

use std::collections::BTreeMap;

/// Maximum tokens of a shader's files after macro expansion.
const MAX_TOKENS: f64 = 4e6;
/// Reason why a macro that repeats an argument cannot be bounded.
const WITHOUT_ARGUMENTS: &str =
    "a macro that repeats an argument must be followed by its arguments in brackets";
/// Maximum nesting depth of macros and arguments.
const MAX_DEPTH: usize = 256;

/// Excessive macro expansion, at the line that uses the macro.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Grown {
    /// Name of the file.
    pub file: String,
    /// Line, from 1.
    pub line: u32,
    /// The fault, as a sentence.
    pub message: String,
}

/// Checks the files of a shader. `#if` is ignored: all definitions count, and of several with one
/// name the most expensive.
///
/// # Errors
/// The first line that expands beyond the bound or cannot be bounded.
pub(super) fn check_growth(texts: &BTreeMap<String, String>) -> Result<(), Grown> {
    let files: Vec<(&str, Vec<Line>)> = texts
        .iter()
        .map(|(name, text)| (name.as_str(), lines(text)))
        .collect();
    let mut macros = Macros::default();
    let defines = files
        .iter()
        .flat_map(|(_, lines)| lines)
        .filter(|l| l.directive() == Some("define"));
    let all: Vec<(&str, Definition)> = defines.filter_map(definition).collect();
    for (name, definition) in &all {
        macros.definitions.entry(name).or_default().push(definition);
    }
    let mut sum = 0.0;
    for (file, lines) in &files {
        // A call may span several lines, so all lines between two directives form one text.
        for part in lines.chunk_by(|a, b| a.directive().is_none() && b.directive().is_none()) {
            let tokens = match part[0].directive() {
                Some(
                    "define" | "undef" | "ifdef" | "ifndef" | "include" | "extension" | "version",
                ) => continue,
                Some(_) => part[0].without_defined(),
                None => part
                    .iter()
                    .flat_map(|line| line.tokens.iter().copied())
                    .collect(),
            };
            let before = sum;
            let found = macros.top(&tokens).map(|own| sum += own);
            if found.is_ok() && sum <= MAX_TOKENS {
                continue;
            }
            // Narrows the error down to a line, if lines can be expanded separately.
            let mut up_to = before;
            let beyond = part.iter().find(|line| {
                up_to += macros.top(&line.tokens).unwrap_or(f64::INFINITY);
                up_to > MAX_TOKENS
            });
            let line = beyond.unwrap_or(&part[0]);
            let name = line
                .tokens
                .iter()
                .find(|t| macros.definitions.contains_key(*t));
            let about = name.map_or(String::new(), |name| format!(" with '{name}'"));
            let message = found.err().unwrap_or_else(|| {
                format!("macros expand to {sum:.0e} tokens{about}; {MAX_TOKENS:.0e} are allowed")
            });
            return Err(Grown {
                file: (*file).into(),
                line: line.number,
                message,
            });
        }
    }
    Ok(())
}

/// Checks that only comments precede `#version`. Otherwise the compiler prints thousands of lines
/// of its own tables to standard output.
pub(super) fn check_version(text: &str) -> Result<(), (u32, String)> {
    let lines = lines(text);
    let mut before = lines
        .iter()
        .take_while(|l| l.directive() != Some("version"))
        .filter(|l| !l.tokens.is_empty());
    let first = before.next().filter(|_| {
        lines
            .iter()
            .any(|l| l.tokens.windows(2).any(|t| t == ["#", "version"]))
    });
    first.map_or(Ok(()), |l| {
        Err((
            l.number,
            format!(
                "'{}' is before #version, which must come first",
                l.tokens[0]
            ),
        ))
    })
}

/// A line with its continuations.
pub(super) struct Line<'t> {
    /// Number of its first line, from 1.
    pub number: u32,
    pub tokens: Vec<&'t str>,
}

impl<'t> Line<'t> {
    /// The name of a preprocessor directive.
    pub fn directive(&self) -> Option<&'t str> {
        (self.tokens.first() == Some(&"#")).then(|| self.tokens.get(1).copied().unwrap_or_default())
    }

    /// The tokens without operands of `defined`, which are not expanded.
    fn without_defined(&self) -> Vec<&'t str> {
        let asked = |i: usize| {
            let before = |n: usize| i.checked_sub(n).map(|i| self.tokens[i]);
            before(1) == Some("defined") || before(1) == Some("(") && before(2) == Some("defined")
        };
        (0..self.tokens.len())
            .filter(|i| !asked(*i))
            .map(|i| self.tokens[i])
            .collect()
    }
}

/// Tokens by line, without comments.
pub(super) fn lines(text: &str) -> Vec<Line<'_>> {
    let (bytes, mut at, mut number) = (text.as_bytes(), 0, 1);
    let (mut all, mut line) = (
        Vec::new(),
        Line {
            number: 1,
            tokens: Vec::new(),
        },
    );
    let word = |b: &u8| b.is_ascii_alphanumeric() || *b == b'_' || *b >= 128;
    while at < bytes.len() {
        let rest = &bytes[at..];
        match rest[0] {
            b'\n' => {
                number += 1;
                at += 1;
                let next = Line {
                    number,
                    tokens: Vec::new(),
                };
                all.push(std::mem::replace(&mut line, next));
            }
            b'\\' if rest.starts_with(b"\\\n") || rest.starts_with(b"\\\r\n") => {
                number += 1;
                at += if rest[1] == b'\n' { 2 } else { 3 };
            }
            b'/' if rest.starts_with(b"//") => {
                at += rest.iter().position(|b| *b == b'\n').unwrap_or(rest.len())
            }
            b'/' if rest.starts_with(b"/*") => {
                let end = rest
                    .windows(2)
                    .skip(2)
                    .position(|w| w == b"*/")
                    .map_or(rest.len(), |i| i + 4);
                number += rest[..end].iter().filter(|b| **b == b'\n').count() as u32;
                at += end;
            }
            b if b.is_ascii_whitespace() => at += 1,
            b => {
                let end = if word(&b) {
                    rest.iter().position(|b| !word(b)).unwrap_or(rest.len())
                } else {
                    1
                };
                line.tokens.push(&text[at..at + end]);
                at += end;
            }
        }
    }
    all.push(line);
    all.retain(|line| !line.tokens.is_empty());
    all
}

/// A `#define`.
struct Definition<'t> {
    /// Names of the parameters; `None` for an object-like macro.
    parameters: Option<Vec<&'t str>>,
    body: Vec<&'t str>,
}

fn definition<'t>(line: &Line<'t>) -> Option<(&'t str, Definition<'t>)> {
    let [_, _, name, rest @ ..] = line.tokens.as_slice() else {
        return None;
    };
    // Only a parenthesis directly after the name starts parameters.
    let adjacent = rest
        .first()
        .is_some_and(|t| *t == "(" && t.as_ptr() == name.as_bytes().as_ptr_range().end);
    let close = rest.iter().position(|t| *t == ")").filter(|_| adjacent);
    let parameters = close.map(|end| rest[1..end].iter().copied().filter(|t| *t != ",").collect());
    let body = close.map_or(rest, |end| &rest[end + 1..]).to_vec();
    Some((name, Definition { parameters, body }))
}

/// Above any bound, and its square is finite.
const ENDLESS: f64 = 1e30;

/// Cost of an expansion: its own tokens, and the repetitions of each argument.
#[derive(Clone, Debug, Default)]
struct Form {
    own: f64,
    repeats: Vec<f64>,
    /// If the expansion ends in the name of a function-like macro, the repetitions of that macro's
    /// arguments. For a macro itself, the repetitions of its own arguments.
    call: Option<Vec<f64>>,
}

impl Form {
    fn ends_in_repeats(&self) -> bool {
        self.call.iter().flatten().any(|n| *n > 1.0)
    }
}

#[derive(Default)]
struct Macros<'d> {
    definitions: BTreeMap<&'d str, Vec<&'d Definition<'d>>>,
    forms: BTreeMap<&'d str, Form>,
    open: Vec<&'d str>,
}

impl<'d> Macros<'d> {
    /// Cost of a text (tokens).
    fn top(&mut self, tokens: &[&'d str]) -> Result<f64, String> {
        let form = self.cost(tokens, &[], 0);
        self.open.clear();
        let form = form?;
        if form.ends_in_repeats() {
            Err(WITHOUT_ARGUMENTS.into())
        } else {
            Ok(form.own)
        }
    }

    /// Cost of a macro: the maximum over its definitions, per argument and for the rest.
    fn form(&mut self, name: &'d str, depth: usize) -> Result<Form, String> {
        if let Some(form) = self.forms.get(name) {
            return Ok(form.clone());
        }
        // A macro is not expanded within itself.
        if self.open.last() == Some(&name) {
            return Ok(Form {
                own: 1.0,
                ..Form::default()
            });
        }
        if self.open.contains(&name) {
            return Err(format!(
                "the macros '{name}' and '{}' name each other",
                self.open[self.open.len() - 1]
            ));
        }
        self.open.push(name);
        let mut most = Form {
            own: 1.0,
            ..Form::default()
        };
        let mut repeats: Vec<f64> = Vec::new();
        for definition in self.definitions.get(name).cloned().unwrap_or_default() {
            let parameters = definition.parameters.as_deref().unwrap_or_default();
            if definition.body.windows(2).any(|w| w == ["#", "#"]) {
                return Err(format!(
                    "the macro '{name}' joins tokens (##); write them out"
                ));
            }
            let form = self.cost(&definition.body, parameters, depth + 1)?;
            let own = match &definition.parameters {
                Some(_) if form.ends_in_repeats() => return Err(WITHOUT_ARGUMENTS.into()),
                Some(_) => Some(&form.repeats),
                // An alias of a function-like macro.
                None => form.call.as_ref(),
            };
            if let Some(own) = own {
                repeats.resize(repeats.len().max(own.len()), 0.0);
                repeats
                    .iter_mut()
                    .zip(own)
                    .for_each(|(most, one)| *most = most.max(*one));
                most.call = Some(repeats.clone());
            }
            // The macro's name is a token even if its expansion is empty.
            most.own = most.own.max(1.0 + form.own);
        }
        self.open.pop();
        self.forms.insert(name, most.clone());
        Ok(most)
    }

    /// Cost of tokens in which `parameters` are replaced by arguments.
    fn cost(
        &mut self,
        tokens: &[&'d str],
        parameters: &[&'d str],
        depth: usize,
    ) -> Result<Form, String> {
        if depth > MAX_DEPTH {
            return Err(format!(
                "macros and their arguments are nested more than {MAX_DEPTH} deep"
            ));
        }
        let mut sum = Form {
            own: 0.0,
            repeats: vec![0.0; parameters.len()],
            call: None,
        };
        let mut at = 0;
        while let Some(token) = tokens.get(at) {
            at += 1;
            if let Some(i) = parameters.iter().position(|p| p == token) {
                sum.repeats[i] += 1.0;
                continue;
            }
            let Some((&name, _)) = self.definitions.get_key_value(token) else {
                sum.own += 1.0;
                continue;
            };
            let form = self.form(name, depth)?;
            sum.own = (sum.own + form.own).min(ENDLESS);
            let Some(repeats) = &form.call else { continue };
            let arguments = if tokens.get(at) == Some(&"(") {
                arguments(&tokens[at..])
            } else {
                None
            };
            let Some((arguments, length)) = arguments else {
                // Arguments passed by other macros are not visible here.
                if form.ends_in_repeats() && at < tokens.len() {
                    return Err(WITHOUT_ARGUMENTS.into());
                }
                sum.call = form.call.filter(|_| at == tokens.len());
                continue;
            };
            at += length;
            for (i, argument) in arguments.into_iter().enumerate() {
                let inner = self.cost(argument, parameters, depth + 1)?;
                if inner.ends_in_repeats() {
                    return Err(WITHOUT_ARGUMENTS.into());
                }
                // An argument is expanded once before it replaces its parameter.
                let times = repeats.get(i).copied().unwrap_or(0.0) + 1.0;
                sum.own = (sum.own + times * inner.own).min(ENDLESS);
                for (all, one) in sum.repeats.iter_mut().zip(&inner.repeats) {
                    *all = (*all + times * one).min(ENDLESS);
                }
            }
        }
        Ok(sum)
    }
}

/// The arguments of a call that starts with its parenthesis, and its tokens; `None` without a
/// closing one.
fn arguments<'s, 'd>(tokens: &'s [&'d str]) -> Option<(Vec<&'s [&'d str]>, usize)> {
    let (mut list, mut begin, mut depth) = (Vec::new(), 1, 0u32);
    for (i, token) in tokens.iter().enumerate() {
        match *token {
            "(" => depth += 1,
            ")" if depth == 1 => {
                list.push(&tokens[begin..i]);
                return Some((list, i + 1));
            }
            ")" => depth -= 1,
            "," if depth == 1 => {
                list.push(&tokens[begin..i]);
                begin = i + 1;
            }
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn checked(text: &str) -> Result<(), Grown> {
        check_growth(&BTreeMap::from([("a.glsl".to_string(), text.to_string())]))
    }

    #[track_caller]
    fn refused(text: &str, line: u32, message: &str) {
        let grown = checked(text).expect_err("it was accepted");
        assert_eq!(grown.line, line, "{}", grown.message);
        assert!(grown.message.contains(message), "{}", grown.message);
    }

    fn chain(first: &str, next: impl Fn(usize) -> String, use_of_it: &str) -> String {
        let lines: String = (1..40).map(next).collect();
        format!("{first}{lines}{use_of_it}")
    }

    #[test]
    fn only_comments_come_before_the_version() {
        for text in [
            "#version 460\nvoid main() {}",
            "// one\n/* two\n */ #version 460\n",
            "float version;\n",
        ] {
            assert_eq!(check_version(text), Ok(()), "{text}");
        }
        for (text, line) in [
            ("x#version 460\n", 1),
            ("\n;\n#version 460\n", 2),
            ("\u{feff}#version 460\n", 1),
        ] {
            assert_eq!(check_version(text).map_err(|e| e.0), Err(line), "{text:?}");
        }
    }

    #[test]
    fn macros_that_double_are_refused_where_they_are_used() {
        refused(
            &chain(
                "#define A0 1.0\n",
                |i| format!("#define A{i} (A{0}+A{0})\n", i - 1),
                "float x =\nA39;\n",
            ),
            42,
            "'A39'",
        );
        // The compiler does not see them where nothing remains, nor are they harmless there.
        refused(
            &chain(
                "#define A0\n",
                |i| format!("#define A{i} A{0} A{0}\n", i - 1),
                "A39\n",
            ),
            41,
            "tokens",
        );
        refused(
            &chain(
                "#define A0 1\n",
                |i| format!("#define A{i} (A{0}|A{0})\n", i - 1),
                "#if A39\n#endif\n",
            ),
            41,
            "A39",
        );
        let calls = format!(
            "#define D(x) x x\n{}a{};\n",
            "D(".repeat(40),
            ")".repeat(40)
        );
        refused(&calls, 2, "'D'");
        let lines = format!(
            "#define D(x, \\\n y) x y x\n{}a, b{};\n",
            "D(\n".repeat(40),
            ", c)".repeat(40)
        );
        refused(&lines, 3, "tokens");
        refused(
            &chain(
                "#define A0(x) x x\n",
                |i| format!("#define A{i}(x) A{0}(A{0}(x))\n", i - 1),
                "A39(1)\n",
            ),
            41,
            "A39",
        );
        let alias = format!(
            "#define D(x) x x\n#define G D\n{}a{};\n",
            "G(".repeat(40),
            ")".repeat(40)
        );
        refused(&alias, 3, "'G'");
    }

    #[test]
    fn what_cannot_be_bounded_is_refused() {
        refused(
            "#define D(x) x x\n#define X D (\nX X X a ) ) )\n",
            3,
            "arguments",
        );
        refused("#define C(a, b) a ## b\nC(a, b)\n", 2, "##");
        refused("#define A B B\n#define B A A\nA\n", 3, "each other");
        let deep = format!(
            "#define I(x) x\n{}a{};\n",
            "I(".repeat(300),
            ")".repeat(300)
        );
        refused(&deep, 2, "256");
    }

    #[test]
    fn ordinary_macros_are_accepted() {
        for text in [
            "#define A(x) ((x) * (x))\n#define B A(A(A(2.0)))\nfloat x = A(A(B)); // A(\n",
            "#define A A\n#define NONE\nA NONE /* #define B B */\n",
            "#define D(x) x x\n#if defined(D) && defined D\nD(1)\n#endif\n#ifdef D\n#undef D\n#endif\n",
            "#ifdef X\n#define N 4\n#else\n#define N 8\n#endif\nfloat a[N];\n",
        ] {
            assert_eq!(checked(text), Ok(()), "{text}");
        }
        // An unused macro costs nothing.
        let unused = chain(
            "#define A0 1.0\n",
            |i| format!("#define A{i} (A{0}+A{0})\n", i - 1),
            "float x;\n",
        );
        assert_eq!(checked(&unused), Ok(()));
    }
}
