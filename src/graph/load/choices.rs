//! Choices in expressions: a choice is compared with its own options and stands for nothing else.
//! Rhai sees numbers, so a comparison that never holds would leave a pass out without a word.

use crate::diagnostics::nearest;
use crate::graph::expr::Expr;
use crate::graph::param::{Kind, Params};
use rhai::Stmt;

/// The type of a part of an expression.
enum Type<'a> {
    /// A number or a boolean, which Rhai distinguishes.
    Plain,
    /// An unknown name, which another check reports.
    Unknown,
    /// A choice parameter.
    Choice(&'a str, &'a [String]),
    /// One of these options.
    Options(Vec<&'a str>),
}

/// A mistake and what to write instead.
pub(super) type Misuse = (String, Option<String>);

/// Comparisons that cannot hold, and choices and options that stand where a number belongs.
pub(super) fn misuses(expr: &Expr, params: &Params) -> Vec<Misuse> {
    let mut walk = Walk {
        params,
        text: &expr.text,
        found: Vec::new(),
    };
    for statement in expr.statements() {
        match statement {
            Stmt::Expr(root) => walk.plain(root),
            Stmt::FnCall(call, _) => {
                let of = walk.call(&call.name, &call.args);
                walk.expect_plain(&of);
            }
            _ => {}
        }
    }
    walk.found
}

struct Walk<'a> {
    params: &'a Params,
    text: &'a str,
    found: Vec<Misuse>,
}

impl<'a> Walk<'a> {
    fn type_of(&mut self, expr: &'a rhai::Expr) -> Type<'a> {
        match expr {
            rhai::Expr::Variable(v, ..) => self.named(&v.1),
            rhai::Expr::FnCall(call, _) | rhai::Expr::MethodCall(call, _) => {
                self.call(&call.name, &call.args)
            }
            rhai::Expr::And(parts, _) | rhai::Expr::Or(parts, _) => {
                parts.iter().for_each(|part| self.plain(part));
                Type::Plain
            }
            rhai::Expr::Dot(sides, ..) => {
                self.plain(&sides.lhs);
                self.plain(&sides.rhs);
                Type::Plain
            }
            // Rhai has its own words for comparing texts.
            rhai::Expr::StringConstant(..) => Type::Unknown,
            _ => Type::Plain,
        }
    }

    fn named(&self, name: &'a str) -> Type<'a> {
        match self.params.param(name).map(|p| &p.kind) {
            Some(Kind::Choice(options)) => Type::Choice(name, options),
            Some(_) => Type::Plain,
            None if self.params.option_names().any(|o| o == name) => Type::Options(vec![name]),
            None => Type::Unknown,
        }
    }

    fn call(&mut self, name: &str, args: &'a [rhai::Expr]) -> Type<'a> {
        match (name, args) {
            ("==" | "!=", [a, b]) => {
                let (a, b) = (self.type_of(a), self.type_of(b));
                self.compare(&a, &b);
                Type::Plain
            }
            ("select", [condition, a, b]) => {
                self.plain(condition);
                match (self.type_of(a), self.type_of(b)) {
                    (Type::Options(a), Type::Options(b)) => Type::Options([a, b].concat()),
                    (a, b) => {
                        self.expect_plain(&a);
                        self.expect_plain(&b);
                        Type::Plain
                    }
                }
            }
            ("hash", [a, b]) => {
                // A signature only depends on whether a choice has changed.
                for part in [a, b] {
                    self.type_of(part);
                }
                Type::Plain
            }
            _ => {
                args.iter().for_each(|arg| self.plain(arg));
                Type::Plain
            }
        }
    }

    fn plain(&mut self, expr: &'a rhai::Expr) {
        let of = self.type_of(expr);
        self.expect_plain(&of);
    }

    fn expect_plain(&mut self, of: &Type<'a>) {
        if let Some(what) = self.describe(of) {
            self.tell(format!("{what}, no number"), self.comparison(of));
        }
    }

    fn compare(&mut self, a: &Type<'a>, b: &Type<'a>) {
        match (a, b) {
            (Type::Choice(choice, known), Type::Options(options))
            | (Type::Options(options), Type::Choice(choice, known)) => {
                for option in options.iter().filter(|o| !known.iter().any(|k| k == *o)) {
                    let near =
                        nearest(option, known.iter().map(String::as_str)).unwrap_or_default();
                    let help = [near, self.owners(option)]
                        .into_iter()
                        .filter(|h| !h.is_empty())
                        .collect::<Vec<_>>();
                    self.tell(
                        format!("'{choice}' has no option '{option}'"),
                        Some(help.join("; ")),
                    );
                }
            }
            (Type::Choice(a, _), Type::Choice(b, _)) => {
                let message = format!("'{a}' and '{b}' are two choices, which never compare");
                self.tell(
                    message,
                    self.comparison(&Type::Choice(a, self.options_of(a))),
                );
            }
            (Type::Options(_), Type::Options(_)) => {
                let what = self.describe(a).unwrap_or_default();
                self.tell(
                    format!("{what}, compared with another option"),
                    self.comparison(a),
                );
            }
            (Type::Unknown, _) | (_, Type::Unknown) => {}
            (a, b) => {
                self.expect_plain(a);
                self.expect_plain(b);
            }
        }
    }

    fn describe(&self, of: &Type<'a>) -> Option<String> {
        match of {
            Type::Choice(name, _) => Some(format!("'{name}' is a choice")),
            Type::Options(options) => options.first().map(|option| self.owners(option)),
            Type::Plain | Type::Unknown => None,
        }
    }

    /// What could have been meant.
    fn comparison(&self, of: &Type<'a>) -> Option<String> {
        let (choice, option) = match of {
            Type::Choice(name, options) => (*name, options.first()?.as_str()),
            Type::Options(options) => {
                let option = *options.first()?;
                (self.choices_with(option).first().copied()?, option)
            }
            Type::Plain | Type::Unknown => return None,
        };
        Some(format!(
            "compare a choice with its options: {choice} == {option}"
        ))
    }

    fn options_of(&self, choice: &str) -> &'a [String] {
        self.params.param(choice).map_or(&[], |p| p.kind.options())
    }

    fn choices_with(&self, option: &str) -> Vec<&'a str> {
        let has = |kind: &Kind| kind.options().iter().any(|o| o == option);
        self.params
            .list
            .iter()
            .filter(|p| has(&p.kind))
            .map(|p| p.name.as_str())
            .collect()
    }

    fn owners(&self, option: &str) -> String {
        let names: Vec<String> = self
            .choices_with(option)
            .iter()
            .map(|c| format!("'{c}'"))
            .collect();
        format!("'{option}' is an option of {}", names.join(" and "))
    }

    fn tell(&mut self, message: String, help: Option<String>) {
        let found = (format!("{message}, in '{}'", self.text), help);
        if !self.found.contains(&found) {
            self.found.push(found);
        }
    }
}
