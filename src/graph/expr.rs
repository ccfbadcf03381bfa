//! Expressions over parameters: sizes, counts and conditions. The language is that of Rhai's
//! expressions; variables are numbers or booleans, a true result counts as 1.

use crate::diagnostics::Loc;
use rhai::packages::{ArithmeticPackage, BasicMathPackage, LogicPackage, Package};
use rhai::{AST, ASTNode, Dynamic, Engine, EvalAltResult, ImmutableString, Scope};
use serde::de::{Deserialize, Deserializer, Visitor};
use std::collections::BTreeMap;
use std::fmt;
use std::sync::LazyLock;

/// A variable's value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Var {
    /// A number.
    Number(f64),
    /// true or false.
    Bool(bool),
}

/// An expression with its place.
pub type Ex = Loc<Expr>;

/// Values of variables by name.
pub type Env = BTreeMap<String, Var>;

/// An expression as written: a number or a text.
#[derive(Clone, Debug)]
pub struct Expr {
    /// As written.
    pub text: String,
    variables: Vec<String>,
    compiled: Result<AST, String>,
}

/// Arithmetic, comparisons and a few functions; no loops, no strings to speak of, and a bound on
/// the work.
static ENGINE: LazyLock<Engine> = LazyLock::new(|| {
    let mut engine = Engine::new_raw();
    ArithmeticPackage::new().register_into_engine(&mut engine);
    LogicPackage::new().register_into_engine(&mut engine);
    BasicMathPackage::new().register_into_engine(&mut engine);
    engine
        .set_max_operations(10_000)
        .set_max_expr_depths(64)
        .set_max_string_size(256);
    engine
        .register_fn("log2", f64::log2)
        .register_fn("exp2", f64::exp2)
        .register_fn("radians", f64::to_radians);
    engine
        .register_fn("log2", |a: i64| (a as f64).log2())
        .register_fn("exp2", |a: i64| (a as f64).exp2());
    // Literals without a point are integers, which the package's functions do not take.
    type Function = (&'static str, fn(f64) -> f64);
    let functions: [Function; 8] = [
        ("ceil", f64::ceil),
        ("round", f64::round),
        ("floor", f64::floor),
        ("sqrt", f64::sqrt),
        ("exp", f64::exp),
        ("sin", f64::sin),
        ("cos", f64::cos),
        ("tan", f64::tan),
    ];
    for (name, f) in functions {
        engine.register_fn(name, f);
        engine.register_fn(name, move |a: i64| f(a as f64));
    }
    for_numbers(&mut engine, "min", f64::min);
    for_numbers(&mut engine, "max", f64::max);
    engine.register_fn(
        "select",
        |c: bool, a: Dynamic, b: Dynamic| if c { a } else { b },
    );
    // Rhai takes values of different kinds for unequal; that would leave a pass out without a word.
    engine.set_fast_operators(false);
    incomparable::<bool, i64>(
        &mut engine,
        "true or false is no number: write `flag` or `!flag`",
    );
    incomparable::<bool, f64>(
        &mut engine,
        "true or false is no number: write `flag` or `!flag`",
    );
    incomparable::<f64, ImmutableString>(
        &mut engine,
        "options stand without quotes: choice == option",
    );
    incomparable::<i64, ImmutableString>(
        &mut engine,
        "options stand without quotes: choice == option",
    );
    incomparable::<bool, ImmutableString>(&mut engine, "true and false stand without quotes");
    engine
});

fn for_numbers(engine: &mut Engine, name: &str, f: fn(f64, f64) -> f64) {
    engine.register_fn(name, f);
    engine.register_fn(name, move |a: i64, b: f64| f(a as f64, b));
    engine.register_fn(name, move |a: f64, b: i64| f(a, b as f64));
    engine.register_fn(name, move |a: i64, b: i64| f(a as f64, b as f64));
}

/// Makes `==` and `!=` between two kinds an error.
fn incomparable<A: rhai::Variant + Clone, B: rhai::Variant + Clone>(
    engine: &mut Engine,
    why: &'static str,
) {
    for operator in ["==", "!="] {
        engine.register_fn(
            operator,
            move |_: A, _: B| -> Result<bool, Box<EvalAltResult>> { Err(why.into()) },
        );
        engine.register_fn(
            operator,
            move |_: B, _: A| -> Result<bool, Box<EvalAltResult>> { Err(why.into()) },
        );
    }
}

impl Expr {
    /// Compiles a text. [`Expr::mistake`] returns a mistake.
    pub fn new(text: &str) -> Expr {
        let compiled = if text.len() > 1000 {
            Err(String::from("longer than 1000 characters"))
        } else {
            ENGINE.compile_expression(text).map_err(|e| e.to_string())
        };
        let mut variables = Vec::new();
        if let Ok(ast) = &compiled {
            ast.walk(&mut |path| {
                if let Some(ASTNode::Expr(rhai::Expr::Variable(v, ..))) = path.last() {
                    variables.push(v.1.to_string());
                }
                true
            });
        }
        Expr {
            text: text.to_string(),
            variables,
            compiled,
        }
    }

    /// Why the text is no expression, if it is none.
    pub fn mistake(&self) -> Option<&str> {
        self.compiled.as_ref().err().map(String::as_str)
    }

    /// The compiled expression; nothing if it has a mistake.
    pub(super) fn statements(&self) -> &[rhai::Stmt] {
        self.compiled.as_ref().map_or(&[], |ast| ast.statements())
    }

    /// The variables it reads.
    pub fn variables(&self) -> &[String] {
        &self.variables
    }

    /// Its value, or why it has none (a variable that has no value here, a number where a condition
    /// belongs).
    ///
    /// # Errors
    /// The text for the user.
    pub fn eval(&self, env: &Env) -> Result<f64, String> {
        let ast = self.compiled.as_ref().map_err(Clone::clone)?;
        let mut scope = Scope::new();
        for name in &self.variables {
            match env.get(name) {
                Some(Var::Number(v)) => drop(scope.push(name.as_str(), *v)),
                Some(Var::Bool(v)) => drop(scope.push(name.as_str(), *v)),
                None => return Err(format!("'{name}' has no value here")),
            }
        }
        let value: Dynamic = ENGINE
            .eval_ast_with_scope(&mut scope, ast)
            .map_err(|e| e.to_string())?;
        let number = if let Ok(v) = value.as_float() {
            v
        } else if let Ok(v) = value.as_int() {
            v as f64
        } else if let Ok(v) = value.as_bool() {
            f64::from(u8::from(v))
        } else {
            return Err(format!(
                "the result is a {}, not a number",
                value.type_name()
            ));
        };
        if number.is_finite() {
            Ok(number)
        } else {
            Err(format!("the result is {number}"))
        }
    }
}

impl<'de> Deserialize<'de> for Expr {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct V;
        impl Visitor<'_> for V {
            type Value = Expr;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an expression: a number, or a text such as \"width / 2\"")
            }
            fn visit_str<E>(self, text: &str) -> Result<Expr, E> {
                Ok(Expr::new(text))
            }
            fn visit_bool<E>(self, value: bool) -> Result<Expr, E> {
                Ok(Expr::new(if value { "1" } else { "0" }))
            }
            fn visit_u64<E>(self, value: u64) -> Result<Expr, E> {
                Ok(Expr::new(&value.to_string()))
            }
            fn visit_i64<E>(self, value: i64) -> Result<Expr, E> {
                Ok(Expr::new(&value.to_string()))
            }
            fn visit_f64<E>(self, value: f64) -> Result<Expr, E> {
                Ok(Expr::new(&format!("{value:?}")))
            }
        }
        deserializer.deserialize_any(V)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn eval(text: &str) -> f64 {
        let env = Env::from([
            ("maximum".into(), Var::Number(5.0)),
            ("n".into(), Var::Number(128.0)),
            ("flag".into(), Var::Bool(true)),
        ]);
        Expr::new(text)
            .eval(&env)
            .unwrap_or_else(|e| panic!("{text}: {e}"))
    }

    #[test]
    fn precedence_functions_and_conditions() {
        assert_eq!(eval("2 + 3 * 2 ** 2"), 14.0);
        assert_eq!(eval("-2 + 5"), 3.0);
        assert_eq!(eval("log2(n) + 1"), 8.0);
        assert_eq!(eval("max(1, min(n, 4)) * 2"), 8.0);
        assert_eq!(eval("n / 2 - 1 >= 63 && !(n == 64)"), 1.0);
        assert_eq!(eval("flag && n == 128"), 1.0);
        assert_eq!(eval("select(n > 200, 1, select(flag, 2, 3))"), 2.0);
        assert_eq!(eval("maximum + 1"), 6.0);
        assert_eq!(eval("ceil(n / 3)"), 43.0);
        assert_eq!(eval("7"), 7.0);
        assert_eq!(eval("sqrt(64) + floor(8) + sin(0)"), 16.0);
    }

    #[test]
    fn mistakes_are_told() {
        assert!(Expr::new("2 +* ").mistake().is_some());
        assert!(Expr::new("while true {}").mistake().is_some());
        assert!(
            Expr::new("unknown + 1")
                .eval(&Env::new())
                .unwrap_err()
                .contains("'unknown' has no value")
        );
        assert_eq!(Expr::new("a && (b || c > 1)").variables(), ["a", "b", "c"]);
        assert!(Expr::new("1.0 / 0.0").eval(&Env::new()).is_err());
        let env = Env::from([
            ("flag".into(), Var::Bool(true)),
            ("n".into(), Var::Number(2.0)),
        ]);
        assert!(
            Expr::new("flag == 1")
                .eval(&env)
                .unwrap_err()
                .contains("write `flag`")
        );
        assert!(
            Expr::new("n != `exact`")
                .eval(&env)
                .unwrap_err()
                .contains("without quotes")
        );
    }
}
