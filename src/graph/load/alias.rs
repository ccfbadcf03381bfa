//! Names that shaders bind and that stand for something else.

use super::findings::Findings;
use crate::diagnostics::{Entries, Loc};
use crate::graph::definition::{Alias, AliasCase};
use crate::graph::file::{AliasDecl, Bind, NamedSampler, SamplerDecl};

/// Adds the aliases and samplers of a file to those of the files before it, whose names they replace.
pub(super) fn join(
    known: &mut Vec<Alias>,
    aliases: Entries<Vec<Loc<AliasDecl>>>,
    samplers: Entries<NamedSampler>,
    found: &mut Findings,
) {
    let mut new: Vec<Alias> = Vec::new();
    for (name, list) in aliases.0 {
        let last = list.value.len().saturating_sub(1);
        if list.value.is_empty() {
            found.error(list.at, format!("alias '{}' stands for nothing", name.value));
        }
        for (i, case) in list.value.iter().enumerate() {
            match (&case.value.when, i == last) {
                (Some(when), true) => {
                    let message = format!("the last case of '{}' has a condition: what if none holds?", name.value);
                    found.error(when.at, message);
                }
                (None, false) => {
                    let message = format!("a case of '{}' without `when` hides those behind it", name.value);
                    found.error(case.at, message);
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
            found.error(name.at, format!("'{}' is an alias and a sampler", name.value));
            continue;
        }
        let NamedSampler { of, filter, mip_filter, address, compare } = sampler.value;
        let sampler = Some(SamplerDecl { filter, mip_filter, address, compare });
        let bind = Bind { of, mip: None, layer: None, format: None, history: false, sampler };
        new.push(Alias { name: name.value, at: name.at, cases: vec![AliasCase { when: None, bind }] });
    }
    known.retain(|old| !new.iter().any(|a| a.name == old.name));
    known.extend(new);
}
