//! Which parameters have an effect on the frame as it runs now, and why the others have none.
//! Nothing is declared for it: a parameter counts where a shader of a pass that runs reads it, or
//! where another value of it would change an expression that counts. What shaders decide at run
//! time is beyond that; a declaration's `when` tells it.

use super::evaluated::Evaluated;
use super::expr::{Env, Ex, Var};
use super::interface::PARAMS;
use super::link::{Linked, Target, generated, has_word};
use super::param::{Kind, Param, Params, Value};
use crate::shader::{ShaderCompiler, module_include};
use std::collections::{BTreeMap, BTreeSet};

/// What runs.
pub struct Running<'a> {
    /// The graph, with its parameters set.
    pub set: &'a Evaluated<'a>,
    /// Its passes with their shaders; those of passes that do not run are not looked at.
    pub linked: &'a [Linked],
    /// Numbers of the passes that run.
    pub passes: &'a [usize],
    /// Textures and buffers that they write.
    pub written: BTreeSet<&'a str>,
}

/// Why a parameter changes nothing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reason {
    /// In words.
    pub text: String,
    /// Choices with an option each with which it would count.
    pub needs: Vec<(String, String)>,
}

/// Parameters that change nothing now, by name, with the reason. `compiler` finds the files of
/// options that are not chosen.
pub fn idle(running: &Running<'_>, compiler: &ShaderCompiler) -> BTreeMap<String, Reason> {
    let (params, read) = (running.set.params, read_by_shaders(running));
    let trial = Trial::new(running, &read);
    let silent: Vec<&Param> = params
        .list
        .iter()
        .filter(|p| {
            trial.refuses(p) || !read.contains(&p.name) && !trial.is_format(p) && !trial.changes(p)
        })
        .collect();
    if silent.is_empty() {
        return BTreeMap::new();
    }
    let texts = Texts::new(running, compiler);
    silent
        .into_iter()
        .map(|p| (p.name.clone(), trial.reason(p, &texts)))
        .collect()
}

/// Passes that a condition leaves out, by name, with the choices with which it would hold.
pub fn resting(set: &Evaluated<'_>) -> BTreeMap<String, Vec<(String, String)>> {
    let (read, written) = (BTreeSet::new(), BTreeSet::new());
    let running = Running {
        set,
        linked: &[],
        passes: &[],
        written,
    };
    let trial = Trial::new(&running, &read);
    let passes = set.graph.passes.iter().map(|pass| &pass.value);
    passes
        .filter_map(|pass| {
            let failing = pass
                .conditions()
                .find(|when| when.value.eval(&trial.env) == Ok(0.0))?;
            Some((pass.name.value.clone(), trial.needs_of(failing)))
        })
        .collect()
}

/// What shaders take in a parameter's place, where that is a number and another than its value.
pub fn effective(set: &Evaluated<'_>, param: &Param) -> Option<f64> {
    let taken = param.effective.as_ref()?.value.eval(&set.env).ok()?;
    let own = set.params.get(&param.name)?.number()?;
    ((taken - own).abs() > 1e-6 * own.abs().max(1.0)).then_some(taken)
}

/// Parameters and named values that shaders of running passes read.
fn read_by_shaders(running: &Running<'_>) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    let mut texts: BTreeMap<&str, &str> = BTreeMap::new();
    for link in running.passes.iter().filter_map(|p| running.linked.get(*p)) {
        for bound in &link.bound {
            let block = |t: &Target| *t == Target::External(PARAMS);
            let Some(layout) = bound
                .layout
                .as_ref()
                .filter(|_| bound.cases.iter().any(|c| block(&c.target)))
            else {
                continue;
            };
            for member in layout.members() {
                let end = member.offset + member.layout.bytes();
                let inside = |range: &(u32, u32)| range.0 < end && member.offset < range.1;
                // Where the instructions do not tell, the text does.
                let in_text = || {
                    let word = format!("params.{}", member.name);
                    let stages = link.stages.iter().filter(|s| s.stage == bound.stage);
                    let mut texts = stages.flat_map(|s| s.texts.values());
                    texts.any(|text| has_word(text, &word))
                };
                if bound
                    .reads
                    .as_ref()
                    .map_or_else(in_text, |ranges| ranges.iter().any(inside))
                {
                    names.insert(member.name.clone());
                }
            }
        }
        for stage in &link.stages {
            texts.extend(
                stage
                    .texts
                    .iter()
                    .filter(|t| t.0 != "params.glsl")
                    .map(|(f, t)| (f.as_str(), t.as_str())),
            );
        }
    }
    for param in &running.set.graph.params.list {
        let upper = param.name.to_uppercase();
        if param.is_module() && texts.contains_key(module_include(&param.name).as_str())
            || param.constant && texts.values().any(|text| has_word(text, &upper))
        {
            names.insert(param.name.clone());
        }
    }
    names
}

/// The expressions that count, to be tried with other values.
struct Trial<'a> {
    running: &'a Running<'a>,
    params: &'a Params,
    /// What shaders of running passes read.
    read: &'a BTreeSet<String>,
    env: Env,
    expressions: Vec<&'a Ex>,
}

impl<'a> Trial<'a> {
    fn new(running: &'a Running<'a>, read: &'a BTreeSet<String>) -> Trial<'a> {
        let Evaluated { graph, params, .. } = *running.set;
        let mut env = running.set.env.clone();
        for name in ["index", "mip"] {
            env.insert(name.into(), Var::Number(0.0));
        }
        let mut expressions: Vec<&Ex> = graph
            .passes
            .iter()
            .flat_map(|p| p.value.conditions())
            .collect();
        expressions.extend(
            running
                .passes
                .iter()
                .flat_map(|p| graph.passes[*p].value.expressions()),
        );
        let textures = graph
            .textures
            .iter()
            .filter(|t| running.written.contains(t.0.as_str()));
        expressions.extend(textures.flat_map(|(_, t)| t.value.expressions()));
        let buffers = graph
            .buffers
            .iter()
            .filter(|b| running.written.contains(b.0.as_str()));
        expressions.extend(buffers.filter_map(|(_, b)| b.value.size.value.expression()));
        expressions.extend(graph.alias_expressions());
        expressions.extend(
            graph
                .values
                .iter()
                .filter(|v| read.contains(&v.name))
                .map(|v| &v.expr),
        );
        expressions.extend(graph.scene_expressions());
        Trial {
            running,
            params,
            read,
            env,
            expressions,
        }
    }

    fn value(&self, param: &Param) -> Value {
        self.params
            .get(&param.name)
            .unwrap_or(&param.default)
            .clone()
    }

    /// Whether its declaration says that it does not count now.
    fn refuses(&self, param: &Param) -> bool {
        param
            .when
            .as_ref()
            .is_some_and(|when| when.value.eval(&self.env) == Ok(0.0))
    }

    /// Whether it is the format of a texture that is made.
    fn is_format(&self, param: &Param) -> bool {
        let mut made = self
            .running
            .set
            .graph
            .textures
            .iter()
            .filter(|t| self.running.written.contains(t.0.as_str()));
        made.any(|t| t.1.value.format.value == param.name)
    }

    /// Whether another value of it would change an expression.
    fn changes(&self, param: &Param) -> bool {
        self.changes_in(param, &self.env, &self.expressions)
    }

    fn changes_in(&self, param: &Param, env: &Env, expressions: &[&Ex]) -> bool {
        let moved = self.depending_on(param);
        let counts = |ex: &&&Ex| ex.value.variables().iter().any(|v| moved.contains(v));
        let named: Vec<&&Ex> = expressions.iter().filter(counts).collect();
        let outcome = |env: &Env| -> Vec<Option<u64>> {
            named
                .iter()
                .map(|ex| ex.value.eval(env).ok().map(f64::to_bits))
                .collect()
        };
        let now = outcome(env);
        !named.is_empty()
            && others(param, &self.value(param))
                .iter()
                .any(|other| outcome(&self.with(env, param, other)) != now)
    }

    /// Why it changes nothing, in words.
    fn reason(&self, param: &Param, texts: &Texts) -> Reason {
        if let Some(when) = param.when.as_ref().filter(|_| self.refuses(param)) {
            return Reason {
                text: format!("if {}", when.value.text),
                needs: self.needs_of(when),
            };
        }
        let files = texts.naming(param, &self.depending_on(param));
        let mut clauses: Vec<String> = Vec::new();
        let mut needs = Vec::new();
        // A module that no running pass includes makes no difference.
        let modules = self
            .params
            .list
            .iter()
            .filter(|m| m.is_module() && m.name != param.name);
        for module in modules.filter(|m| self.read.contains(&m.name)) {
            let naming = |o: &&OptionFiles| {
                !o.is_chosen && o.module == module.name && !o.files.is_disjoint(&files)
            };
            let names: Vec<&str> = texts
                .options
                .iter()
                .filter(naming)
                .map(|o| o.option.as_str())
                .collect();
            if names.is_empty() {
                continue;
            }
            clauses.push(format!("{} is {}", module.name, names.join(" or ")));
            needs.extend(
                names
                    .iter()
                    .map(|o| (module.name.clone(), (*o).to_string())),
            );
        }
        if clauses.is_empty() {
            (clauses, needs) = self.switches(param);
        }
        if clauses.is_empty() {
            let resting = texts
                .resting
                .iter()
                .filter(|(_, used)| !used.is_disjoint(&files));
            clauses = resting.map(|(condition, _)| condition.clone()).collect();
            clauses.dedup();
        }
        clauses.truncate(2);
        let text = match clauses.len() {
            0 => "no active pass reads it".into(),
            _ => format!("if {}", clauses.join(", or if ")),
        };
        Reason { text, needs }
    }

    /// Choices and flags with which a condition holds.
    fn needs_of(&self, condition: &Ex) -> Vec<(String, String)> {
        let switches = self
            .params
            .list
            .iter()
            .filter(|s| matches!(s.kind, Kind::Bool | Kind::Choice(_)));
        let holds = |switch: &Param, value: &Value| {
            condition
                .value
                .eval(&self.with(&self.env, switch, value))
                .is_ok_and(|v| v != 0.0)
        };
        let mut needs = Vec::new();
        for switch in switches {
            let values = others(switch, &self.value(switch))
                .into_iter()
                .filter(|v| holds(switch, v));
            needs.extend(values.map(|v| (switch.name.clone(), v.to_string())));
        }
        needs
    }

    /// Choices and flags with which another value would change an expression that depends on both.
    fn switches(&self, param: &Param) -> (Vec<String>, Vec<(String, String)>) {
        let moved = self.depending_on(param);
        let all: Vec<&Ex> = self.running.set.graph.expressions().collect();
        let naming: Vec<&Ex> = all
            .into_iter()
            .filter(|ex| ex.value.variables().iter().any(|v| moved.contains(v)))
            .collect();
        let (mut clauses, mut needs) = (Vec::new(), Vec::new());
        for switch in self.params.list.iter().filter(|s| s.name != param.name) {
            let deciding = self.depending_on(switch);
            let is_switch = matches!(switch.kind, Kind::Bool | Kind::Choice(_));
            let named = naming
                .iter()
                .any(|ex| ex.value.variables().iter().any(|v| deciding.contains(v)));
            if !is_switch || !named {
                continue;
            }
            let works = |value: &Value| {
                self.changes_in(param, &self.with(&self.env, switch, value), &naming)
            };
            let values: Vec<Value> = others(switch, &self.value(switch))
                .into_iter()
                .filter(works)
                .collect();
            if !values.is_empty() {
                let names: Vec<String> = values.iter().map(ToString::to_string).collect();
                clauses.push(format!("{} is {}", switch.name, names.join(" or ")));
                needs.extend(names.into_iter().map(|v| (switch.name.clone(), v)));
            }
        }
        (clauses, needs)
    }

    /// The parameter's names in expressions, and the values that follow from it.
    fn depending_on(&self, param: &Param) -> Vec<String> {
        let mut moved = param.variables();
        for value in &self.running.set.graph.values {
            if value
                .expr
                .value
                .variables()
                .iter()
                .any(|v| moved.contains(v))
            {
                moved.push(value.name.clone());
            }
        }
        moved
    }

    /// The variables with another value of a parameter, and all that follows from it.
    fn with(&self, env: &Env, param: &Param, value: &Value) -> Env {
        let mut env = env.clone();
        param.put(value, &mut env);
        let moved = self.depending_on(param);
        for value in self
            .running
            .set
            .graph
            .values
            .iter()
            .filter(|v| moved.contains(&v.name))
        {
            if let Ok(number) = value.number(&env) {
                env.insert(value.name.clone(), Var::Number(number));
            }
        }
        env
    }
}

/// Other values worth trying: all of a choice, the ends and the middle of a range, the neighbours.
fn others(param: &Param, now: &Value) -> Vec<Value> {
    let numbers = |v: f64| {
        let (low, high) = param.range.unwrap_or((v - 1.0, v + 1.0));
        let step = param.step.unwrap_or(1.0);
        [low, high, 0.5 * (low + high), v - step, v + step].map(|x| x.clamp(low, high))
    };
    let mut list: Vec<Value> = match now {
        Value::Bool(v) => vec![Value::Bool(!v)],
        Value::Int(v) => numbers(*v as f64)
            .iter()
            .map(|x| Value::Int(x.round() as i64))
            .collect(),
        Value::Float(v) => numbers(*v).iter().map(|x| Value::Float(*x)).collect(),
        Value::Vector(v) => (0..5)
            .map(|i| Value::Vector(v.iter().map(|x| numbers(*x)[i]).collect()))
            .collect(),
        Value::Choice(_) => param
            .kind
            .options()
            .iter()
            .map(|o| Value::Choice(o.clone()))
            .collect(),
    };
    list.extend(param.plain.clone());
    list.push(param.default.clone());
    let mut once: Vec<Value> = Vec::new();
    for value in list.into_iter().filter(|v| v != now) {
        if !once.contains(&value) {
            once.push(value);
        }
    }
    once
}

/// The shader files of a module's option.
struct OptionFiles {
    module: String,
    option: String,
    is_chosen: bool,
    files: BTreeSet<String>,
}

/// Files of shaders, by what uses them or would use them.
struct Texts {
    files: BTreeMap<String, String>,
    options: Vec<OptionFiles>,
    /// A condition that does not hold, files of the pass's shaders.
    resting: Vec<(String, BTreeSet<String>)>,
}

impl Texts {
    fn new(running: &Running<'_>, compiler: &ShaderCompiler) -> Texts {
        let Evaluated {
            graph,
            params,
            ref env,
            ..
        } = *running.set;
        let made = generated(graph, params);
        let mut files = BTreeMap::new();
        let mut take = |file: &str| -> BTreeSet<String> {
            // Compilation reports unreadable files.
            let texts = compiler.texts(file, &made).unwrap_or_default();
            let names = texts.keys().cloned().collect();
            files.extend(texts.into_iter().filter(|t| t.0 != "params.glsl"));
            names
        };
        let mut options = Vec::new();
        for param in params.list.iter().filter(|p| p.is_module()) {
            let chosen = params.get(&param.name);
            for (option, file) in param.kind.options().iter().zip(&param.files) {
                let is_chosen = chosen == Some(&Value::Choice(option.clone()));
                let (module, option) = (param.name.clone(), option.clone());
                options.push(OptionFiles {
                    module,
                    option,
                    is_chosen,
                    files: take(file),
                });
            }
        }
        let mut resting = Vec::new();
        for (number, pass) in graph
            .passes
            .iter()
            .enumerate()
            .filter(|(i, _)| !running.passes.contains(i))
        {
            let fails = |when: &&Ex| when.value.eval(env) == Ok(0.0);
            let Some(condition) = pass.value.conditions().find(fails) else {
                continue;
            };
            let used = graph.passes[number]
                .value
                .shaders
                .0
                .iter()
                .flat_map(|s| take(&s.value))
                .collect();
            resting.push((condition.value.text.clone(), used));
        }
        Texts {
            files,
            options,
            resting,
        }
    }

    /// Files that name a parameter, or a value that depends on it.
    fn naming(&self, param: &Param, moved: &[String]) -> BTreeSet<String> {
        if param.is_module() {
            return BTreeSet::from([module_include(&param.name)]);
        }
        let words: Vec<String> = std::iter::once(param.in_shaders())
            .chain(moved.iter().map(|v| format!("params.{v}")))
            .collect();
        let named = |text: &str| words.iter().any(|w| has_word(text, w));
        self.files
            .iter()
            .filter(|(_, text)| named(text))
            .map(|(file, _)| file.clone())
            .collect()
    }
}
