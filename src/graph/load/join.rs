//! The files of a graph as one.

use super::findings::Findings;
use crate::diagnostics::{Entries, Items, Loc, RawText};
use crate::graph::definition::{Alias, AliasCase};
use crate::graph::file::{AliasDecl, Bind, GraphFile, NamedSampler, PassDecl, Size, TextureDecl};

/// Adds a file's sections to those of the files before it.
pub(super) fn add(all: &mut GraphFile, file: GraphFile) {
    // A parameter takes the place of an included file's value, and of the module that it has set
    // once and for all.
    let is_param = |name: &Loc<String>| {
        file.params
            .0
            .iter()
            .any(|p| p.value.name.value == name.value)
    };
    all.modules.0.retain(|(name, _)| !is_param(name));
    all.values.0.retain(|(name, _)| !is_param(name));
    replace(&mut all.modules, file.modules);
    replace(&mut all.values, file.values);
    replace(&mut all.tools, file.tools);
    replace(&mut all.view_mips, file.view_mips);
    for (name, title) in file.pinned.0 {
        match all.pinned.0.iter_mut().find(|p| p.0.value == name.value) {
            Some(known) => known.1 = title,
            None => all.pinned.0.push((name, title)),
        }
    }
    append(&mut all.params, file.params);
    append(&mut all.fixed, file.fixed);
    append(&mut all.outputs, file.outputs);
    append(&mut all.checks, file.checks);
    append(&mut all.refuse, file.refuse);
    append(&mut all.tables, file.tables);
    append(&mut all.compare, file.compare);
    append(&mut all.views, file.views);
    append(&mut all.ablation, file.ablation);
    all.defaults.0.extend(file.defaults.0);
    all.retired.0.extend(file.retired.0);
    all.textures.0.extend(file.textures.0);
    all.buffers.0.extend(file.buffers.0);
    all.parts.0.extend(file.parts.0);
    all.fit.0.extend(file.fit.0);
    all.groups.0.extend(file.groups.0);
    later(&mut all.output, file.output);
    later(&mut all.hdr, file.hdr);
    later(&mut all.scene, file.scene);
    later(&mut all.caption, file.caption);
    later(&mut all.pointer, file.pointer);
    later(&mut all.slice, file.slice);
}

/// Leaves out settings that included files offer and that would set a fixed parameter.
pub(super) fn leave_out_fixed(file: &mut GraphFile) {
    let is_free = |name: &Loc<String>| file.fixed.0.iter().all(|fixed| fixed.value != name.value);
    let are_free = |set: &Entries<RawText>| set.0.iter().all(|(name, _)| is_free(name));
    file.pinned.0.retain(|(name, _)| is_free(name));
    file.fit.0.retain(|(name, _)| is_free(name));
    file.view_mips.0.retain(|(_, name)| is_free(name));
    file.compare
        .0
        .retain(|c| are_free(&c.value.a) && are_free(&c.value.b));
    file.views.0.retain(|view| are_free(&view.value.set));
    file.ablation.0.retain(|step| are_free(&step.value.set));
}

fn append<T>(all: &mut Items<T>, more: Items<T>) {
    all.0.extend(more.0);
}

fn replace<T>(all: &mut Entries<T>, more: Entries<T>) {
    all.0
        .retain(|(name, _)| !more.0.iter().any(|(other, _)| other.value == name.value));
    all.0.extend(more.0);
}

fn later<T>(all: &mut Option<T>, more: Option<T>) {
    if more.is_some() {
        *all = more;
    }
}

/// Adds a pass at the end, or after the one that it names.
pub(super) fn insert_pass(
    passes: &mut Vec<Loc<PassDecl>>,
    pass: Loc<PassDecl>,
    found: &mut Findings,
) {
    let Some(after) = &pass.value.after else {
        return passes.push(pass);
    };
    match passes
        .iter()
        .position(|p| p.value.name.value == after.value)
    {
        Some(i) => passes.insert(i + 1, pass),
        None if found.is_unknown(&after.value) => {
            let known = passes.iter().map(|p| p.value.name.value.as_str());
            let message = format!("no earlier pass is named '{}'", after.value);
            found.unknown(after.at, &after.value, message, known);
        }
        None => passes.push(pass),
    }
}

/// Gives the textures that are as large as another its size.
pub(super) fn sizes_of_others(textures: &mut [(String, Loc<TextureDecl>)], found: &mut Findings) {
    let sizes: Vec<(String, Size)> = textures
        .iter()
        .map(|(name, t)| (name.clone(), t.value.size.clone()))
        .collect();
    let size_of = |name: &str| sizes.iter().find(|s| s.0 == name).map(|s| &s.1);
    for (name, texture) in textures {
        let mut at = texture.value.size.1.clone();
        // As many steps as there are textures: more go in a circle.
        for _ in 0..=sizes.len() {
            let Some(size) = at.as_ref().and_then(|other| size_of(&other.value)) else {
                break;
            };
            texture.value.size.0.clone_from(&size.0);
            at.clone_from(&size.1);
        }
        match at {
            Some(other) if size_of(&other.value).is_some() => {
                found.error(texture.at, format!("'{name}' is as large as itself"));
            }
            Some(other) => {
                let message = format!("no texture is named '{}'", other.value);
                found.unknown(
                    other.at,
                    &other.value,
                    message,
                    sizes.iter().map(|s| s.0.as_str()),
                );
            }
            None => {}
        }
    }
}

fn case(decl: AliasDecl) -> AliasCase {
    AliasCase {
        when: decl.when,
        bind: Bind {
            of: decl.of,
            mip: decl.mip,
            format: decl.format,
            history: decl.history,
            sampler: decl.sampler,
        },
    }
}

/// Every case except the last one has a condition.
fn check_cases(name: &str, list: &Loc<Vec<Loc<AliasDecl>>>, found: &mut Findings) {
    let Some((last, others)) = list.value.split_last() else {
        return found.error(list.at, format!("alias '{name}' stands for nothing"));
    };
    for case in others.iter().filter(|case| case.value.when.is_none()) {
        let message = format!("a case of '{name}' without `when` hides those behind it");
        found.error(case.at, message);
    }
    if let Some(when) = &last.value.when {
        let message = format!("the last case of '{name}' has a condition: what if none holds?");
        found.error(when.at, message);
    }
}

/// Adds the aliases and samplers of a file. They replace earlier ones of the same names.
pub(super) fn add_aliases(
    known: &mut Vec<Alias>,
    aliases: Entries<Vec<Loc<AliasDecl>>>,
    samplers: Entries<NamedSampler>,
    found: &mut Findings,
) {
    let mut new: Vec<Alias> = Vec::new();
    for (name, list) in aliases.0 {
        check_cases(&name.value, &list, found);
        new.push(Alias {
            name: name.value,
            at: name.at,
            cases: list.value.into_iter().map(|c| case(c.value)).collect(),
        });
    }
    for (name, sampler) in samplers.0 {
        if new.iter().any(|a| a.name == name.value) {
            let message = format!("'{}' is an alias and a sampler", name.value);
            found.error(name.at, message);
            continue;
        }
        let bind = sampler.value.bind();
        new.push(Alias {
            name: name.value,
            at: name.at,
            cases: vec![AliasCase { when: None, bind }],
        });
    }
    known.retain(|old| !new.iter().any(|a| a.name == old.name));
    known.extend(new);
}
