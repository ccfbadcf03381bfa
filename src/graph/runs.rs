//! Which passes run with which parameters, as far as their `when` says: the shaders of the others need not be compiled.

use super::expr::Env;
use super::link::Linked;
use super::load::Graph;
use super::param::Params;

/// Whether each pass of a graph runs.
pub struct Runs(Vec<bool>);

impl Runs {
    /// All passes, whatever the parameters.
    pub fn all(graph: &Graph) -> Runs {
        Runs(vec![true; graph.passes.len()])
    }

    /// Whether a pass runs.
    pub fn has(&self, pass: usize) -> bool {
        self.0.get(pass).copied().unwrap_or(false)
    }

    /// Whether every pass that runs has its shaders.
    pub fn are_linked(&self, graph: &Graph, linked: &[Linked]) -> bool {
        let mut passes = graph.passes.iter().zip(linked).enumerate();
        passes.all(|(i, (pass, link))| !self.has(i) || pass.value.shaders.0.is_empty() || !link.stages.is_empty())
    }
}

/// The passes that run with these parameters; `env` has size and scene. One whose `when` cannot be evaluated is among
/// them: the plan says what is wrong with it.
pub fn runs(graph: &Graph, params: &Params, env: &Env) -> Runs {
    let mut env = env.clone();
    super::value::fill(graph, params, &mut env);
    let holds = |when: &super::file::Ex| when.value.eval(&env) != Ok(0.0);
    Runs(graph.passes.iter().map(|p| p.value.conditions().all(holds)).collect())
}
