//! What the settings tried so far say of those that were not: both quantities as sums of an effect of each axis's value.
//! Frames are sums of passes, and squared errors sums of parts, so that this is nearly true; it only proposes, and what
//! it proposes is measured.

use super::search::Trial;
use std::collections::HashMap;

/// Rounds of fitting the effects in turn (backfitting; Hastie and Tibshirani 1990, Section 4.4).
const ROUNDS: usize = 40;

/// Trials without effect that are added to each value: few trials say little.
const DOUBT: f64 = 0.05;

/// Places that a proposal looks at before it takes the best so far.
const MOST_STEPS: usize = 2_000_000;

/// A mean, and for each axis and value what it adds.
struct Sum {
    mean: f64,
    effects: Vec<Vec<f64>>,
}

impl Sum {
    fn of(sizes: &[usize], trials: &[(&[usize], f64)]) -> Sum {
        let mean = trials.iter().map(|t| t.1).sum::<f64>() / trials.len().max(1) as f64;
        let mut effects: Vec<Vec<f64>> = sizes.iter().map(|n| vec![0.0; *n]).collect();
        let mut left: Vec<f64> = trials.iter().map(|t| t.1 - mean).collect();
        for _ in 0..ROUNDS {
            for axis in 0..sizes.len() {
                let mut sums = vec![(0.0, 0.0); sizes[axis]];
                for ((place, _), left) in trials.iter().zip(&left) {
                    sums[place[axis]].0 += left + effects[axis][place[axis]];
                    sums[place[axis]].1 += 1.0;
                }
                let new: Vec<f64> = sums
                    .iter()
                    .map(|(sum, count)| sum / (count + DOUBT))
                    .collect();
                for ((place, _), left) in trials.iter().zip(&mut left) {
                    *left += effects[axis][place[axis]] - new[place[axis]];
                }
                effects[axis] = new;
            }
        }
        // A value that was never tried is like the nearest that was.
        for (axis, effects) in effects.iter_mut().enumerate() {
            let seen: Vec<usize> = (0..sizes[axis])
                .filter(|i| trials.iter().any(|t| t.0[axis] == *i))
                .collect();
            let known = effects.clone();
            for (i, effect) in effects.iter_mut().enumerate() {
                if let Some(nearest) = seen.iter().min_by_key(|s| s.abs_diff(i)) {
                    *effect = known[*nearest];
                }
            }
        }
        Sum { mean, effects }
    }

    /// For each axis the least that it and those after it can add.
    fn least(&self) -> Vec<f64> {
        let mut least = vec![0.0; self.effects.len() + 1];
        for (axis, effects) in self.effects.iter().enumerate().rev() {
            least[axis] = least[axis + 1] + effects.iter().copied().fold(f64::INFINITY, f64::min);
        }
        least
    }
}

/// A walk over the grid that leaves out what cannot be better than the best so far.
struct Walk<'a> {
    cost: Sum,
    bounded: Sum,
    least_cost: Vec<f64>,
    least_bounded: Vec<f64>,
    bound: f64,
    known: &'a HashMap<Vec<usize>, Option<Trial>>,
    best: Option<(f64, Vec<usize>)>,
    steps: usize,
}

impl Walk<'_> {
    fn go(&mut self, place: &mut Vec<usize>, cost: f64, bounded: f64) {
        self.steps += 1;
        let axis = place.len();
        let hopeless = self
            .best
            .as_ref()
            .is_some_and(|b| cost + self.least_cost[axis] >= b.0);
        if self.steps > MOST_STEPS || hopeless || bounded + self.least_bounded[axis] > self.bound {
            return;
        }
        if axis == self.cost.effects.len() {
            if !self.known.contains_key(place) {
                self.best = Some((cost, place.clone()));
            }
            return;
        }
        // Cheap ones first: what is found early ends more of the walk.
        let mut order: Vec<usize> = (0..self.cost.effects[axis].len()).collect();
        order.sort_by(|a, b| self.cost.effects[axis][*a].total_cmp(&self.cost.effects[axis][*b]));
        for value in order {
            place.push(value);
            let (more, further) = (
                self.cost.effects[axis][value],
                self.bounded.effects[axis][value],
            );
            self.go(place, cost + more, bounded + further);
            place.pop();
        }
    }
}

/// The setting, not tried yet, that should be the cheapest within the bound.
pub(super) fn propose(
    sizes: &[usize],
    known: &HashMap<Vec<usize>, Option<Trial>>,
    tried: &[(&[usize], Trial)],
    bound: f64,
) -> Option<Vec<usize>> {
    let of = |value: fn(&Trial) -> f64| -> Vec<(&[usize], f64)> {
        tried.iter().map(|(p, t)| (*p, value(t))).collect()
    };
    let (cost, bounded) = (
        Sum::of(sizes, &of(|t| t.cost)),
        Sum::of(sizes, &of(|t| t.bounded)),
    );
    let (least_cost, least_bounded) = (cost.least(), bounded.least());
    let start = (cost.mean, bounded.mean);
    let mut walk = Walk {
        cost,
        bounded,
        least_cost,
        least_bounded,
        bound,
        known,
        best: None,
        steps: 0,
    };
    walk.go(&mut Vec::new(), start.0, start.1);
    walk.best.map(|b| b.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_cheapest_of_a_sum_from_few_of_its_terms() {
        let sizes = [4, 3, 5];
        let trial = |p: &[usize]| Trial {
            cost: [1.0, 2.0, 4.0, 13.0][p[0]] + p[1] as f64 + 0.3 * p[2] as f64,
            bounded: 0.1 / (1.0 + p[0] as f64)
                + [0.05, 0.02, 0.01][p[1]]
                + 0.01 * (4 - p[2]) as f64,
        };
        // One line along each axis.
        let mut places = vec![vec![0, 0, 0]];
        places.extend((1..4).map(|i| vec![i, 0, 0]));
        places.extend((1..3).map(|i| vec![0, i, 0]));
        places.extend((1..5).map(|i| vec![0, 0, i]));
        let known: HashMap<Vec<usize>, Option<Trial>> =
            places.iter().map(|p| (p.clone(), Some(trial(p)))).collect();
        let tried: Vec<(&[usize], Trial)> = places.iter().map(|p| (&p[..], trial(p))).collect();
        let all = || (0..60).map(|i| vec![i % 4, i / 4 % 3, i / 12]);
        let bound = 0.095;
        let within = all().filter(|p| trial(p).bounded <= bound && !known.contains_key(p));
        let best = within
            .min_by(|a, b| trial(a).cost.total_cmp(&trial(b).cost))
            .unwrap();
        let found = propose(&sizes, &known, &tried, bound).unwrap();
        let (found, best) = (trial(&found), trial(&best));
        assert!(
            found.cost <= 1.2 * best.cost && found.bounded < 1.2 * bound,
            "{found:?} for {best:?}"
        );
        assert!(propose(&sizes, &known, &tried, -1.0).is_none());
    }
}
