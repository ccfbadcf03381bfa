//! The effect of parameters on shaders: passes that run by their `when`, and files of modules.
//! The shaders of other passes need not be compiled, other files not be read.

use super::linked::Linked;
use crate::graph::definition::{Graph, Named};
use crate::graph::evaluated::Evaluated;
use crate::graph::expr::Ex;
use crate::graph::param::Params;
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
        Runs {
            passes: vec![true; graph.passes.len()],
            generated: generated(graph, params),
        }
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
                        self.generated
                            .iter()
                            .all(|(name, text)| s.texts.get(name).is_none_or(|used| used == text))
                    })
        })
    }
}

/// Members of the named values in the uniform block of parameters.
fn members(graph: &Graph) -> String {
    let member = |v: &Named| {
        format!(
            "    {} {};\n",
            if v.whole { "int" } else { "float" },
            v.name
        )
    };
    graph.values.iter().map(member).collect()
}

/// The files that the graph makes for its shaders.
pub fn generated(graph: &Graph, params: &Params) -> Generated {
    let mut files = Generated::from([("params.glsl".into(), params.glsl(&members(graph)))]);
    let pixel = graph.pointer.as_ref();
    let pixel = pixel.map_or("-1".into(), |name| format!("floor(params.{name})"));
    let text = format!("ivec2 clickedPixel() {{ return ivec2({pixel}); }}\n");
    files.insert("common/debug_pixel.glsl".into(), text);
    let fixed = graph
        .modules
        .iter()
        .map(|(name, file)| (name.as_str(), file.as_str()));
    for (name, file) in fixed.chain(params.modules()) {
        files.insert(module_include(name), format!("#include \"{file}\"\n"));
    }
    files
}

/// The passes that run. A pass with an invalid `when` is included, and the plan reports the
/// mistake.
pub fn runs(set: &Evaluated<'_>) -> Runs {
    let holds = |when: &Ex| when.value.eval(&set.env) != Ok(0.0);
    let passes = set
        .graph
        .passes
        .iter()
        .map(|p| p.value.conditions().all(holds))
        .collect();
    Runs {
        passes,
        generated: generated(set.graph, set.params),
    }
}
