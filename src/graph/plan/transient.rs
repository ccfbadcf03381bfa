//! Transient textures and buffers, which hold nothing between frames. Those that are never needed
//! at the same time share memory.

use super::data::{Plan, Transient};
use super::uses::begins;
use crate::diagnostics::Diagnostic;
use crate::graph::definition::{Graph, Res};

/// The transient resources that are used.
///
/// # Errors
/// Transient resources that are read before anything is written to them.
pub(super) fn find(graph: &Graph, plan: &Plan) -> Result<Vec<Transient>, Vec<Diagnostic>> {
    let textures = (0..plan.textures.len()).map(|t| Res::Texture(t, false));
    let buffers = (0..plan.buffers.len()).map(|b| Res::Buffer(b, false));
    let (mut list, mut errors) = (Vec::new(), Vec::new());
    for res in textures
        .chain(buffers)
        .filter(|res| plan.is_transient(*res))
    {
        let mut spans: Vec<(usize, usize)> = Vec::new();
        for (i, step) in plan.steps.iter().enumerate() {
            let mut uses = step.uses.iter().filter(|u| u.res == res).peekable();
            match (uses.peek().is_some(), uses.all(begins), spans.last_mut()) {
                (false, ..) => {}
                (true, true, _) => spans.push((i, i)),
                (true, false, Some(last)) => last.1 = i,
                (true, false, None) => {
                    let name = &graph.passes[step.pass].value.name;
                    let what = graph.title_of(res);
                    let message = format!(
                        "'{what}' is transient, and pass '{}' reads it before it is written",
                        name.value
                    );
                    errors.push(graph.sources.error(name.at, message));
                    break;
                }
            }
        }
        if !spans.is_empty() {
            list.push(Transient { res, spans });
        }
    }
    if errors.is_empty() {
        Ok(list)
    } else {
        Err(errors)
    }
}

/// Offsets of resources with these sizes, alignments and times in one piece of memory, and the
/// bytes of all. The largest first, each as low as it fits among those that are there at the same
/// time (greedy by size; Pisarchyk and Lee 2020, "Efficient Memory Management for Deep Neural Net
/// Inference", section 5.2).
pub fn pack(sizes: &[(u64, u64)], transients: &[Transient]) -> (Vec<u64>, u64) {
    let meet = |a: &Transient, b: &Transient| {
        a.spans
            .iter()
            .any(|(first, last)| b.spans.iter().any(|(from, to)| first <= to && from <= last))
    };
    let mut order: Vec<usize> = (0..sizes.len()).collect();
    order.sort_by_key(|i| std::cmp::Reverse(sizes[*i].0));
    let (mut offsets, mut placed): (Vec<u64>, Vec<usize>) = (vec![0; sizes.len()], Vec::new());
    for i in order {
        let (size, alignment) = sizes[i];
        let mut beside: Vec<usize> = placed
            .iter()
            .copied()
            .filter(|k| meet(&transients[i], &transients[*k]))
            .collect();
        beside.sort_by_key(|k| offsets[*k]);
        let mut offset = 0;
        for k in beside {
            if offset + size <= offsets[k] {
                break;
            }
            offset = offset.max((offsets[k] + sizes[k].0).next_multiple_of(alignment.max(1)));
        }
        offsets[i] = offset;
        placed.push(i);
    }
    let end = offsets
        .iter()
        .zip(sizes)
        .map(|(offset, (size, _))| offset + size)
        .max()
        .unwrap_or(0);
    (offsets, end)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn transient(spans: &[(usize, usize)]) -> Transient {
        Transient {
            res: Res::Buffer(0, false),
            spans: spans.to_vec(),
        }
    }

    #[test]
    fn what_follows_lies_where_the_other_was() {
        let list = [
            transient(&[(0, 2)]),
            transient(&[(3, 5)]),
            transient(&[(2, 3)]),
            transient(&[(0, 0), (4, 4)]),
        ];
        let (offsets, end) = pack(&[(100, 1), (80, 1), (50, 64), (20, 1)], &list);
        assert_eq!((offsets, end), (vec![0, 0, 128, 100], 178));
    }

    proptest! {
        #[test]
        fn nothing_overlaps_in_time_and_place(
            pieces in proptest::collection::vec((1u64..1000, 0u32..8, proptest::collection::vec((0usize..20, 0usize..4), 1..3)), 0..30)
        ) {
            let list: Vec<Transient> = pieces
                .iter()
                .map(|(_, _, spans)| transient(&spans.iter().map(|(first, long)| (*first, first + long)).collect::<Vec<_>>()))
                .collect();
            let sizes: Vec<(u64, u64)> = pieces.iter().map(|(size, power, _)| (*size, 1 << power)).collect();
            let (offsets, end) = pack(&sizes, &list);
            for i in 0..sizes.len() {
                prop_assert!(offsets[i] % sizes[i].1 == 0 && offsets[i] + sizes[i].0 <= end);
                for k in 0..i {
                    let together = (0..30).any(|step| {
                        [i, k].iter().all(|n| list[*n].spans.iter().any(|(first, last)| (*first..=*last).contains(&step)))
                    });
                    let apart = offsets[i] + sizes[i].0 <= offsets[k] || offsets[k] + sizes[k].0 <= offsets[i];
                    prop_assert!(!together || apart, "{i} and {k}");
                }
            }
            // No step needs more than there is, and all is never more than without sharing.
            let needed = |step: usize| -> u64 {
                let there = |n: &usize| list[*n].spans.iter().any(|(first, last)| (*first..=*last).contains(&step));
                (0..sizes.len()).filter(there).map(|n| sizes[n].0).sum()
            };
            prop_assert!(end >= (0..30).map(needed).max().unwrap_or(0));
            prop_assert!(end <= sizes.iter().map(|(size, alignment)| size + alignment).sum::<u64>());
        }
    }
}
