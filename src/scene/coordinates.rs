//! Texture coordinates of materials: each texture names its source, and a vertex has two sets.

use super::Lookup;
use super::warnings::Warnings;

/// The two sources of texture coordinates of a material's vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct UvSources<S> {
    pub first: S,
    pub second: Option<S>,
}

/// The textures of a material: the source of each, and how it is looked up.
#[derive(Clone, Debug, Default)]
pub(super) struct References<S> {
    list: Vec<(S, Lookup)>,
}

impl<S: Clone + Default + PartialEq> References<S> {
    /// Adds a texture and returns its index.
    pub fn add(&mut self, source: S, lookup: Lookup) -> usize {
        self.list.push((source, lookup));
        self.list.len() - 1
    }

    /// The two most used sources, earlier ones first. `name` is the material's.
    pub fn sources(&self, name: &str, warnings: &mut Warnings) -> UvSources<S> {
        let mut counts: Vec<(&S, usize)> = Vec::new();
        for (source, _) in &self.list {
            match counts.iter_mut().find(|(known, _)| *known == source) {
                Some((_, count)) => *count += 1,
                None => counts.push((source, 1)),
            }
        }
        // Ties keep their order, because the sort is stable.
        counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        let mut sources = counts.into_iter().map(|(source, _)| source.clone());
        let found = UvSources {
            first: sources.next().unwrap_or_default(),
            second: sources.next(),
        };
        if sources.next().is_some() {
            let what = "textures of one material have more than two kinds of coordinates (sets or transforms); the \
                        rest takes the commonest";
            warnings.add(what, name);
        }
        found
    }

    /// The lookup of a texture. A texture with a third source falls back to the first set.
    pub fn lookup(&self, reference: Option<usize>, sources: &UvSources<S>) -> Lookup {
        let Some((source, lookup)) = reference.and_then(|i| self.list.get(i)) else {
            return Lookup::default();
        };
        Lookup {
            second_set: sources.second.as_ref() == Some(source),
            ..*lookup
        }
    }
}
