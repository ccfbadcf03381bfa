//! What the parameters say about shaders: which passes run, as far as their `when` says, and which files stand for modules.
//! The shaders of other passes need not be compiled, other files not be read.

use super::expr::Env;
use super::link::Linked;
use super::load::Graph;
use super::param::Params;
use crate::shader::{Generated, module_include};

/// Whether each pass of a graph runs, and the files that the graph makes for its shaders.
pub struct Runs {
    passes: Vec<bool>,
    /// `params.glsl`, and an include for each module.
    pub generated: Generated,
}

impl Runs {
    /// All passes, with the modules that these parameters choose.
    pub fn all(graph: &Graph, params: &Params) -> Runs {
        Runs { passes: vec![true; graph.passes.len()], generated: generated(graph, params) }
    }

    /// Whether a pass runs.
    pub fn has(&self, pass: usize) -> bool {
        self.passes.get(pass).copied().unwrap_or(false)
    }

    /// Whether every pass that runs has its shaders, made of the files that are chosen now.
    pub fn are_linked(&self, graph: &Graph, linked: &[Linked]) -> bool {
        let mut passes = graph.passes.iter().zip(linked).enumerate();
        passes.all(|(i, (pass, link))| {
            !self.has(i)
                || pass.value.shaders.0.is_empty()
                || !link.stages.is_empty()
                    && link.stages.iter().all(|s| {
                        self.generated.iter().all(|(name, text)| s.texts.get(name).is_none_or(|used| used == text))
                    })
        })
    }
}

/// The files that the graph makes for its shaders.
pub fn generated(graph: &Graph, params: &Params) -> Generated {
    let mut files = Generated::from([("params.glsl".into(), params.glsl(&graph.values))]);
    let fixed = graph.modules.iter().map(|(name, file)| (name.as_str(), file.as_str()));
    for (name, file) in fixed.chain(params.modules()) {
        files.insert(module_include(name), format!("#include \"{file}\"\n"));
    }
    files
}

/// The passes that run with these parameters; `env` has size and scene. One whose `when` cannot be evaluated is among
/// them: the plan says what is wrong with it.
pub fn runs(graph: &Graph, params: &Params, env: &Env) -> Runs {
    let mut env = env.clone();
    super::value::fill(graph, params, &mut env);
    let holds = |when: &super::file::Ex| when.value.eval(&env) != Ok(0.0);
    let passes = graph.passes.iter().map(|p| p.value.conditions().all(holds)).collect();
    Runs { passes, generated: generated(graph, params) }
}
