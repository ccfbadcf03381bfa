//! Names that shaders bind and that stand for something else: one of several resources, or a texture sampled in its own way.

use super::file::{AliasDecl, Bind, Ex, NamedSampler, PassDecl, SamplerDecl};
use super::load::Graph;
use crate::diagnostics::{At, Entries, Loc, Sources};

/// A name and what it stands for.
#[derive(Clone, Debug)]
pub struct Alias {
    /// The name.
    pub name: String,
    /// Where it is declared.
    pub at: At,
    /// What it stands for: the first whose condition holds.
    pub cases: Vec<AliasCase>,
}

/// What a name stands for under a condition.
#[derive(Clone, Debug)]
pub struct AliasCase {
    /// The condition; none in the last case.
    pub when: Option<Ex>,
    /// The resource, as in a pass's `bind`.
    pub bind: Bind,
}

/// Adds the aliases and samplers of a file to those of the files before it, whose names they replace. What is wrong with
/// them, as far as that needs no other section, comes back.
pub(super) fn join(
    known: &mut Vec<Alias>,
    aliases: Entries<Vec<Loc<AliasDecl>>>,
    samplers: Entries<NamedSampler>,
    sources: &Sources,
) -> Vec<crate::diagnostics::Diagnostic> {
    let mut errors = Vec::new();
    let mut new: Vec<Alias> = Vec::new();
    for (name, list) in aliases.0 {
        let last = list.value.len().saturating_sub(1);
        if list.value.is_empty() {
            errors.push(sources.error(list.at, format!("alias '{}' stands for nothing", name.value)));
        }
        for (i, case) in list.value.iter().enumerate() {
            match (&case.value.when, i == last) {
                (Some(when), true) => {
                    let message = format!("the last case of '{}' has a condition: what if none holds?", name.value);
                    errors.push(sources.error(when.at, message));
                }
                (None, false) => {
                    let message = format!("a case of '{}' without `when` hides those behind it", name.value);
                    errors.push(sources.error(case.at, message));
                }
                _ => {}
            }
        }
        let cases = list.value.into_iter().map(|case| {
            let AliasDecl { when, of, mip, layer, format, history, sampler } = case.value;
            AliasCase { when, bind: Bind { of, mip, layer, format, history, sampler } }
        });
        new.push(Alias { name: name.value, at: name.at, cases: cases.collect() });
    }
    for (name, sampler) in samplers.0 {
        if new.iter().any(|a| a.name == name.value) {
            errors.push(sources.error(name.at, format!("'{}' is an alias and a sampler", name.value)));
            continue;
        }
        let NamedSampler { of, filter, mip_filter, address, compare } = sampler.value;
        let sampler = Some(SamplerDecl { filter, mip_filter, address, compare });
        let bind = Bind { of, mip: None, layer: None, format: None, history: false, sampler };
        new.push(Alias { name: name.value, at: name.at, cases: vec![AliasCase { when: None, bind }] });
    }
    known.retain(|old| !new.iter().any(|a| a.name == old.name));
    known.extend(new);
    errors
}

impl Graph {
    /// The alias or named sampler of that name.
    pub fn alias(&self, name: &str) -> Option<&Alias> {
        self.aliases.iter().find(|a| a.name == name)
    }

    /// What a name stands for in a pass, by condition: itself, what the pass's `bind` says, or the cases of an alias.
    pub(super) fn cases(&self, pass: &PassDecl, name: &str) -> Vec<(Option<Ex>, Option<Bind>)> {
        let own = pass.bind.0.iter().find(|(key, _)| key.value == name).map(|(_, bind)| &bind.value);
        match self.alias(own.map_or(name, |b| b.of.value.as_str())) {
            None => vec![(None, own.cloned())],
            Some(alias) => {
                let narrowed = |case: &AliasCase| own.map_or(case.bind.clone(), |own| narrowed(&case.bind, own));
                alias.cases.iter().map(|case| (case.when.clone(), Some(narrowed(case)))).collect()
            }
        }
    }
}

/// What an alias stands for, with what a pass says of it besides.
pub(super) fn narrowed(case: &Bind, by: &Bind) -> Bind {
    Bind {
        of: case.of.clone(),
        mip: by.mip.clone().or(case.mip.clone()),
        layer: by.layer.clone().or(case.layer.clone()),
        format: by.format.clone().or(case.format.clone()),
        history: by.history || case.history,
        sampler: by.sampler.or(case.sampler),
    }
}
