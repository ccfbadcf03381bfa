//! Signatures: numbers that tell whether a stage has the settings of an earlier frame. A shader
//! stores one in a buffer with the results of the stage, and discards these where the signature is
//! another.

use super::evaluated::Evaluated;
use super::link::{Bound, Linked, Target};
use super::param::Value;
use super::plan::{Plan, Step};
use super::{Res, interface::PARAMS};
use std::hash::{BuildHasher, Hash, Hasher};

/// The named values with their signatures, 1 to 2^31 - 1. A signature is a hash of the graph's name
/// and, for each step of the stage, of the shaders, the work, the sizes of all resources used, and
/// the parameters and values read. Passes that read the signature do not count: they decide
/// themselves which results stay valid when their own settings change, as passes that move a volume
/// do. A signature is the same in every run. Two settings share one by chance only (2^-31).
pub fn signed(set: &Evaluated<'_>, linked: &[Linked], plan: &Plan) -> Vec<Value> {
    let bytes = set.params.uniform_bytes(&set.values);
    let mut values = set.values.clone();
    for (named, value) in set.graph.values.iter().zip(&mut values) {
        if let Some(stage) = &named.signs {
            let of_stage = |step: &&Step| set.graph.passes[step.pass].value.stage() == stage;
            let steps = plan
                .steps
                .iter()
                .filter(of_stage)
                .filter(|s| !reads(&linked[s.pass], &named.name));
            let mut hasher = foldhash::quality::FixedState::with_seed(0).build_hasher();
            (&set.graph.name, set.params.constants()).hash(&mut hasher);
            steps.for_each(|step| hash_step(step, &bytes, &linked[step.pass], plan, &mut hasher));
            *value = Value::Int(((hasher.finish() >> 33) as i64).max(1));
        }
    }
    values
}

/// The bindings of the block of parameters.
fn params_of(link: &Linked) -> impl Iterator<Item = &Bound> {
    let is_params = |target: &Target| *target == Target::External(PARAMS);
    link.bound
        .iter()
        .filter(move |b| b.cases.iter().any(|c| is_params(&c.target)))
}

fn reads(link: &Linked, value: &str) -> bool {
    let reads = |bound: &Bound| {
        let member = bound
            .layout
            .as_ref()?
            .members()
            .iter()
            .find(|m| m.name == value)?;
        Some(
            bound
                .reads
                .as_ref()?
                .iter()
                .any(|(from, to)| (*from..*to).contains(&member.offset)),
        )
    };
    params_of(link).any(|bound| reads(bound) == Some(true))
}

fn hash_step(step: &Step, params: &[u8], link: &Linked, plan: &Plan, hasher: &mut impl Hasher) {
    (
        step.pass,
        step.index,
        format!("{:?}", step.work),
        step.viewport,
        step.samples,
    )
        .hash(hasher);
    for shader in &link.stages {
        shader.words.hash(hasher);
    }
    for bound in params_of(link) {
        match &bound.reads {
            Some(ranges) => ranges
                .iter()
                .for_each(|(from, to)| params.get(*from as usize..*to as usize).hash(hasher)),
            None => params.hash(hasher),
        }
    }
    for used in &step.uses {
        match used.res {
            Res::Texture(t, _) => (t, plan.textures[t].extent, plan.textures[t].mips).hash(hasher),
            Res::Buffer(b, _) => (b, plan.buffers[b].size).hash(hasher),
        }
    }
}
