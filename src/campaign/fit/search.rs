//! Coordinate descent on a grid, restarted from the Pareto front of all trials.
//!
//! The search starts with every value of every axis around the given setting, and with the
//! neighbours of the last values of all axes. Each round then tries the neighbours along each axis
//! of one setting. It takes the best setting, or, if that is explored, the setting on the front
//! that is nearest to the bound. That setting is cheap and slightly above the bound, or expensive
//! and within it. Two or three steps from it may pass a local optimum. The search ends after
//! [`PATIENCE`] rounds without a gain.

use std::cmp::Ordering;
use std::collections::{HashMap, HashSet};

/// Rounds without a gain that end a search.
const PATIENCE: usize = 12;

/// Both quantities of one setting, in their own units. Smaller is better.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// The quantity to minimise.
    pub cost: f64,
    /// The quantity that must stay within the bound.
    pub bounded: f64,
}

/// Conditions that end a search.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Largest value of the bounded quantity.
    pub bound: f64,
    /// Largest number of evaluations.
    pub evaluations: usize,
    /// Relative gains below this are noise.
    pub least_gain: f64,
}

/// A setting that was tried.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// An index for each axis.
    pub place: Vec<usize>,
    /// Its quantities, `None` if it cannot be run.
    pub trial: Option<Trial>,
}

/// The reason that ended a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// No setting near the Pareto front is better.
    Local,
    /// All evaluations are used.
    Evaluations,
    /// No setting that was tried is within the bound.
    Unreachable,
}

impl Stop {
    /// The reason, for people.
    pub fn text(self) -> &'static str {
        match self {
            Stop::Local => "no setting near the Pareto front is better",
            Stop::Evaluations => "all evaluations are used",
            Stop::Unreachable => "no setting is within the bound",
        }
    }
}

/// The result of a search.
#[derive(Clone, Debug)]
pub struct Found {
    /// The best setting. It is within the bound if any that was tried is.
    pub place: Vec<usize>,
    /// Quantities of the best setting.
    pub trial: Trial,
    /// All settings in the order of their evaluation.
    pub tried: Vec<Step>,
    /// The reason that ended the search.
    pub stop: Stop,
}

/// Gives the quantities of a setting, or `None` if it cannot be run.
pub type Evaluate<'a, E> = dyn FnMut(&[usize]) -> Result<Option<Trial>, E> + 'a;

struct Search<'a, E> {
    evaluate: &'a mut Evaluate<'a, E>,
    limits: Limits,
    known: HashMap<Vec<usize>, Option<Trial>>,
    tried: Vec<Step>,
    /// Settings with explored neighbours.
    explored: HashSet<Vec<usize>>,
}

impl<E> Search<'_, E> {
    /// `None` also if all evaluations are used.
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

    fn spent(&self) -> bool {
        self.tried.len() >= self.limits.evaluations
    }

    /// Tries all settings that differ in one axis, by at most `reach` values.
    fn explore(&mut self, sizes: &[usize], place: &[usize], reach: usize) -> Result<(), E> {
        for (axis, size) in sizes.iter().enumerate() {
            let mut moved = place.to_vec();
            for value in (0..*size).filter(|v| v.abs_diff(place[axis]) <= reach) {
                moved[axis] = value;
                self.trial(&moved)?;
            }
        }
        self.explored.insert(place.to_vec());
        Ok(())
    }

    /// Settings that could be run.
    fn run(&self) -> impl Iterator<Item = (&Vec<usize>, Trial)> {
        let steps = self.tried.iter();
        steps.filter_map(|step| Some((&step.place, step.trial?)))
    }

    /// Settings within the bound first, by cost, then the others, by the bounded quantity.
    fn order(&self, a: Trial, b: Trial) -> Ordering {
        let merit = |t: Trial| match t.bounded <= self.limits.bound {
            true => (false, t.cost),
            false => (true, t.bounded),
        };
        let ((a_beyond, a), (b_beyond, b)) = (merit(a), merit(b));
        a_beyond.cmp(&b_beyond).then(a.total_cmp(&b))
    }

    /// The best setting; the first of equals.
    fn best(&self) -> Option<(Vec<usize>, Trial)> {
        let best = self.run().min_by(|a, b| self.order(a.1, b.1));
        best.map(|(place, trial)| (place.clone(), trial))
    }

    /// Whether a trial is better by more than noise.
    fn gains(&self, new: Trial, old: Trial) -> bool {
        let rest = 1.0 - self.limits.least_gain;
        let least = Trial {
            cost: old.cost * rest,
            bounded: match old.bounded <= self.limits.bound {
                true => old.bounded,
                false => old.bounded * rest,
            },
        };
        self.order(new, least).is_lt()
    }

    /// The next setting to explore: the best, or the one on the front that is nearest to the bound.
    fn next(&self) -> Option<Vec<usize>> {
        let is_open = |place: &Vec<usize>| !self.explored.contains(place);
        if let Some((place, _)) = self.best().filter(|best| is_open(&best.0)) {
            return Some(place);
        }
        let dominates = |a: Trial, b: Trial| a.cost <= b.cost && a.bounded <= b.bounded && a != b;
        let front = self
            .run()
            .filter(|(place, t)| is_open(place) && !self.run().any(|o| dominates(o.1, *t)));
        let distance = |t: Trial| (t.bounded / self.limits.bound).ln().abs();
        let nearest = front.min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)));
        nearest.map(|(place, _)| place.clone())
    }
}

/// Searches a grid that has `sizes` values on its axes. `evaluate` gives the quantities of a
/// setting, or `None` if it cannot be run. Returns `None` if the start cannot be run.
pub fn search<E>(
    sizes: &[usize],
    start: &[usize],
    limits: Limits,
    evaluate: &mut Evaluate<'_, E>,
) -> Result<Option<Found>, E> {
    let mut s = Search {
        evaluate,
        limits,
        known: HashMap::new(),
        tried: Vec::new(),
        explored: HashSet::new(),
    };
    if s.trial(start)?.is_none() {
        return Ok(None);
    }
    s.explore(sizes, start, usize::MAX)?;
    let last: Vec<usize> = sizes.iter().map(|size| size - 1).collect();
    s.explore(sizes, &last, 1)?;
    let mut best = s.best();
    let mut rounds = 0;
    while let (Some(place), true) = (s.next(), rounds < PATIENCE && !s.spent()) {
        s.explore(sizes, &place, 1)?;
        let new = s.best();
        match new.as_ref().zip(best.as_ref()) {
            Some((new, old)) if s.gains(new.1, old.1) => rounds = 0,
            _ => rounds += 1,
        }
        best = new;
    }
    let spent = s.spent();
    Ok(best.map(|(place, trial)| Found {
        place,
        trial,
        stop: match trial.bounded <= limits.bound {
            _ if spent => Stop::Evaluations,
            true => Stop::Local,
            false => Stop::Unreachable,
        },
        tried: s.tried,
    }))
}
