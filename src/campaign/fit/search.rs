//! The search: neighbours on a grid, a few evaluations, no knowledge of the method.
//!
//! While the bound is not met, the step that lowers the bounded quantity most for what it costs is taken. Once it is
//! met, single steps that cost less and stay within it; then exchanges of two steps, one that saves and one that mends,
//! of which only those are tried that a model promises: that the ratio by which a step changes a quantity is the same
//! wherever it is taken. From where no step helps any more, a model of all that was tried proposes settings farther away
//! ([`propose`]); several in a row that are no better end the search. Whatever a setting was tried for, the walk goes on
//! from it if it is the best, and the best of all is what comes back.

use super::model::propose;
use std::collections::HashMap;

/// Both quantities of one setting, in their own units; smaller is better.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// The quantity that is made as small as can be.
    pub cost: f64,
    /// What must be at most the limit.
    pub bounded: f64,
}

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Most of the bounded quantity.
    pub bound: f64,
    /// Most evaluations.
    pub evaluations: usize,
    /// Gains below this part are noise.
    pub least_gain: f64,
}

/// A setting that was tried, in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// An index for each axis.
    pub place: Vec<usize>,
    /// Its quantities; nothing where it cannot be run.
    pub trial: Option<Trial>,
}

/// Why a search has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// No step, no promising pair of steps and no proposal is better.
    Local,
    /// The evaluations are used up.
    Evaluations,
    /// No step lowers the bounded quantity any more, and it is still above the bound.
    Unreachable,
}

/// What a search has found.
#[derive(Clone, Debug)]
pub struct Found {
    /// The best setting: within the bound if any that was tried is.
    pub place: Vec<usize>,
    /// Quantities of the best setting.
    pub trial: Trial,
    /// Everything that was tried.
    pub tried: Vec<Step>,
    /// Why it ended.
    pub stop: Stop,
}

/// Gives a setting's quantities, or nothing where it cannot be run.
pub type Evaluate<'a, E> = dyn FnMut(&[usize]) -> Result<Option<Trial>, E> + 'a;

/// A change of one axis.
type Move = (usize, usize);

struct Search<'a, E> {
    evaluate: &'a mut Evaluate<'a, E>,
    sizes: &'a [usize],
    limits: Limits,
    known: HashMap<Vec<usize>, Option<Trial>>,
    tried: Vec<Step>,
    /// By axis and direction: the ratios by which the last such step changed cost and bounded quantity.
    ratios: HashMap<(usize, bool), (f64, f64)>,
}

impl<E> Search<'_, E> {
    /// `None` also when the evaluations are used up.
    fn trial(&mut self, place: &[usize]) -> Result<Option<Trial>, E> {
        if let Some(known) = self.known.get(place) {
            return Ok(*known);
        }
        if self.spent() {
            return Ok(None);
        }
        let trial = (self.evaluate)(place)?;
        let trial = trial.filter(|t| t.cost.is_finite() && t.bounded.is_finite());
        self.known.insert(place.to_vec(), trial);
        self.tried.push(Step {
            place: place.to_vec(),
            trial,
        });
        Ok(trial)
    }

    /// Tries steps and remembers what they change.
    fn try_all(
        &mut self,
        place: &[usize],
        from: Trial,
        moves: &[Move],
        found: &mut Vec<(Move, Trial)>,
    ) -> Result<(), E> {
        for (axis, to) in moves {
            if let Some(trial) = self.trial(&moved(place, &[(*axis, *to)]))? {
                let ratios = (
                    trial.cost / from.cost.max(1e-30),
                    trial.bounded / from.bounded.max(1e-30),
                );
                self.ratios.insert((*axis, *to > place[*axis]), ratios);
                found.push(((*axis, *to), trial));
            }
        }
        Ok(())
    }

    /// Whether a step was better, or is not known, where it was last tried.
    fn is_hopeful(&self, place: &[usize], from: Trial, (axis, to): Move) -> bool {
        self.ratios
            .get(&(axis, to > place[axis]))
            .is_none_or(|(cost, bounded)| {
                self.better(
                    Trial {
                        cost: from.cost * cost,
                        bounded: from.bounded * bounded,
                    },
                    from,
                )
            })
    }

    fn spent(&self) -> bool {
        self.tried.len() >= self.limits.evaluations
    }

    /// One step along each axis, either way.
    fn moves(&self, place: &[usize]) -> Vec<Move> {
        let ways = |axis: usize| {
            [
                place[axis].checked_sub(1),
                Some(place[axis] + 1).filter(|i| *i < self.sizes[axis]),
            ]
        };
        (0..place.len())
            .flat_map(|axis| ways(axis).into_iter().flatten().map(move |to| (axis, to)))
            .collect()
    }

    /// The best of everything tried, gains of any size counted: the first of equals.
    fn best(&self) -> Option<(Vec<usize>, Trial)> {
        let within = |t: &Trial| t.bounded <= self.limits.bound;
        let merit = |t: &Trial| (!within(t), if within(t) { t.cost } else { t.bounded });
        let order = |a: &Trial, b: &Trial| {
            let ((beyond, value), (other_beyond, other)) = (merit(a), merit(b));
            beyond.cmp(&other_beyond).then(value.total_cmp(&other))
        };
        let tried = self
            .tried
            .iter()
            .filter_map(|step| Some((&step.place, step.trial?)));
        tried
            .min_by(|a, b| order(&a.1, &b.1))
            .map(|(place, trial)| (place.clone(), trial))
    }

    /// How far a setting is from what is wanted: first within the bound, then cheap.
    fn better(&self, new: Trial, old: Trial) -> bool {
        let within = |t: Trial| t.bounded <= self.limits.bound;
        let gain = 1.0 - self.limits.least_gain;
        match (within(new), within(old)) {
            (true, false) => true,
            (false, true) => false,
            (true, true) => new.cost < old.cost * gain,
            (false, false) => new.bounded < old.bounded * gain,
        }
    }
}

fn moved(place: &[usize], steps: &[Move]) -> Vec<usize> {
    let mut place = place.to_vec();
    for (axis, to) in steps {
        place[*axis] = *to;
    }
    place
}

/// Proposals in vain after which the best is taken.
const PROPOSALS: usize = 24;

/// Searches on a grid with so many values on each axis: from `start`, from the first value of every axis, and from what
/// the trials so far promise. `evaluate` gives a setting's quantities, or nothing where it cannot be run.
///
/// # Errors
/// The errors of `evaluate`; `None` when not even the start can be run.
pub fn search<E>(
    sizes: &[usize],
    start: &[usize],
    limits: Limits,
    evaluate: &mut Evaluate<'_, E>,
) -> Result<Option<Found>, E> {
    let mut s = Search {
        evaluate,
        sizes,
        limits,
        known: HashMap::new(),
        tried: Vec::new(),
        ratios: HashMap::new(),
    };
    let Some((mut place, mut trial)) = descend(&mut s, start, None)? else {
        return Ok(None);
    };
    if let Some(found) =
        descend(&mut s, &vec![0; sizes.len()], Some(trial))?.filter(|f| s.better(f.1, trial))
    {
        (place, trial) = found;
    }
    // Every value of every axis once, so that the model knows of all of them.
    for (axis, values) in sizes.iter().enumerate() {
        for value in 0..*values {
            s.trial(&moved(&place, &[(axis, value)]))?;
        }
    }
    let mut in_vain = 0;
    loop {
        // Whatever it was tried for: the walk goes on from the best.
        if let Some(best) = s.best().filter(|best| s.better(best.1, trial)) {
            (place, trial) = descend(&mut s, &best.0, None)?.unwrap_or(best);
            in_vain = 0;
            continue;
        }
        if in_vain == PROPOSALS || s.spent() {
            break;
        }
        // What should miss the bound by a little may turn out to be within.
        let bound = limits.bound * (1.0 + 0.02 * (in_vain % 3) as f64);
        let tried: Vec<(&[usize], Trial)> = s
            .tried
            .iter()
            .filter_map(|t| Some((&t.place[..], t.trial?)))
            .collect();
        let Some(from) = propose(sizes, &s.known, &tried, bound) else {
            break;
        };
        s.trial(&from)?;
        in_vain += 1;
    }
    // Smaller gains than those worth a walk are gains too.
    if let Some(best) = s.best() {
        (place, trial) = best;
    }
    let stop = match trial.bounded <= limits.bound {
        _ if s.spent() => Stop::Evaluations,
        true => Stop::Local,
        false => Stop::Unreachable,
    };
    Ok(Some(Found {
        place,
        trial,
        tried: s.tried,
        stop,
    }))
}

/// Walks from a setting to one that no step betters, or that is dearer than `known`, which is within the bound, and
/// itself is not: until it is within, a walk gets ever dearer.
fn descend<E>(
    s: &mut Search<'_, E>,
    start: &[usize],
    known: Option<Trial>,
) -> Result<Option<(Vec<usize>, Trial)>, E> {
    let mut place = start.to_vec();
    let Some(mut trial) = s.trial(&place)? else {
        return Ok(None);
    };
    let bound = s.limits.bound;
    let known = known.filter(|known| known.bounded <= bound);
    loop {
        if known.is_some_and(|known| trial.bounded > bound && trial.cost > known.cost) {
            return Ok(Some((place, trial)));
        }
        // Those that helped before, or have not been tried, come first; all of them before the walk ends.
        let (hopeful, others): (Vec<Move>, Vec<Move>) = s
            .moves(&place)
            .into_iter()
            .partition(|m| s.is_hopeful(&place, trial, *m));
        let mut singles = Vec::new();
        s.try_all(&place, trial, &hopeful, &mut singles)?;
        let mut next = best_single(s, trial, &singles).map(|step| vec![step]);
        if next.is_none() {
            s.try_all(&place, trial, &others, &mut singles)?;
            next = best_single(s, trial, &singles).map(|step| vec![step]);
        }
        if next.is_none() {
            next = exchange(s, &place, trial, &singles)?;
        }
        match next {
            Some(steps) => (place, trial) = follow(s, place, trial, &steps)?,
            None => return Ok(Some((place, trial))),
        }
    }
}

/// The single step to take: within the bound the cheapest, outside the one that lowers the bounded quantity most for
/// what it costs.
fn best_single<E>(s: &Search<'_, E>, from: Trial, singles: &[(Move, Trial)]) -> Option<Move> {
    let better = singles.iter().filter(|(_, t)| s.better(*t, from));
    let within = from.bounded <= s.limits.bound;
    let merit = |t: &Trial| match (within, t.bounded <= s.limits.bound) {
        (true, _) => t.cost,
        // Reaching the bound is the end of this phase: the cheapest way there.
        (false, true) => t.cost * 1e-6,
        (false, false) => {
            let gain = (from.bounded / t.bounded.max(1e-30)).ln();
            let price = (t.cost / from.cost.max(1e-30)).ln().max(0.02);
            1e6 * price / gain
        }
    };
    better
        .min_by(|a, b| merit(&a.1).total_cmp(&merit(&b.1)))
        .map(|(step, _)| *step)
}

/// Several steps at once, where the ratios of what is known promise a gain: two single ones; then a single one with two
/// that help only together.
fn exchange<E>(
    s: &mut Search<'_, E>,
    place: &[usize],
    from: Trial,
    singles: &[(Move, Trial)],
) -> Result<Option<Vec<Move>>, E> {
    let singles: Vec<(Vec<Move>, Trial)> = singles
        .iter()
        .map(|(step, trial)| (vec![*step], *trial))
        .collect();
    if let Some(found) = combine(s, place, from, &singles, &singles)? {
        return Ok(Some(found));
    }
    // Steps that cost and do not help alone: more of one thing may need more of another.
    let idle = |t: &Trial| t.bounded > 0.98 * from.bounded && t.cost >= from.cost;
    let idle: Vec<Move> = singles
        .iter()
        .filter(|(_, t)| idle(t))
        .map(|(steps, _)| steps[0])
        .collect();
    let mut together = Vec::new();
    for (i, a) in idle.iter().enumerate() {
        for b in idle.iter().skip(i + 1).filter(|b| b.0 != a.0) {
            if let Some(trial) = s
                .trial(&moved(place, &[*a, *b]))?
                .filter(|t| t.bounded < 0.98 * from.bounded)
            {
                together.push((vec![*a, *b], trial));
            }
        }
    }
    combine(s, place, from, &together, &singles)
}

/// Tries steps of one list together with steps of another, most promising first.
fn combine<E>(
    s: &mut Search<'_, E>,
    place: &[usize],
    from: Trial,
    some: &[(Vec<Move>, Trial)],
    others: &[(Vec<Move>, Trial)],
) -> Result<Option<Vec<Move>>, E> {
    let mut pairs: Vec<(f64, Vec<Move>)> = Vec::new();
    for (a, x) in some {
        for (b, y) in others
            .iter()
            .filter(|(b, _)| b.iter().all(|b| a.iter().all(|a| a.0 != b.0)))
        {
            let ratio = |of: fn(&Trial) -> f64| of(x) * of(y) / of(&from).max(1e-30);
            let expected = Trial {
                cost: ratio(|t| t.cost),
                bounded: ratio(|t| t.bounded),
            };
            // A little beyond the bound may turn out to be within.
            let near = Trial {
                bounded: expected.bounded / 1.05,
                ..expected
            };
            if s.better(near, from) {
                let merit = if from.bounded <= s.limits.bound {
                    expected.cost
                } else {
                    expected.bounded
                };
                pairs.push((merit, a.iter().chain(b).copied().collect()));
            }
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (_, steps) in pairs {
        if let Some(found) = s.trial(&moved(place, &steps))?
            && s.better(found, from)
        {
            return Ok(Some(steps));
        }
    }
    Ok(None)
}

/// Takes steps, and more in the same directions while that is better.
fn follow<E>(
    s: &mut Search<'_, E>,
    mut place: Vec<usize>,
    mut trial: Trial,
    steps: &[Move],
) -> Result<(Vec<usize>, Trial), E> {
    let ups: Vec<(usize, bool)> = steps
        .iter()
        .map(|(axis, to)| (*axis, *to > place[*axis]))
        .collect();
    let mut next = Some(moved(&place, steps));
    while let Some(to) = next {
        match s.trial(&to)? {
            Some(found) if s.better(found, trial) => (place, trial) = (to, found),
            _ => break,
        }
        let further = |(axis, up): &(usize, bool)| {
            let to = if *up {
                Some(place[*axis] + 1)
            } else {
                place[*axis].checked_sub(1)
            };
            to.filter(|to| *to < s.sizes[*axis]).map(|to| (*axis, to))
        };
        next = ups
            .iter()
            .map(further)
            .collect::<Option<Vec<Move>>>()
            .map(|steps| moved(&place, &steps));
    }
    Ok((place, trial))
}
