//! The Pareto front of time and error.

/// Indices of the points on the Pareto front, by time: those that no other (time, error) beats in both numbers, where
/// less is better. Of equal points the first counts.
pub fn pareto(points: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> =
        (0..points.len()).filter(|i| points[*i].0.is_finite() && points[*i].1.is_finite()).collect();
    order.sort_by(|a, b| points[*a].0.total_cmp(&points[*b].0).then(points[*a].1.total_cmp(&points[*b].1)));
    let mut least = f64::INFINITY;
    order.retain(|i| {
        let better = points[*i].1 < least;
        least = least.min(points[*i].1);
        better
    });
    order
}

#[cfg(test)]
mod tests {
    use super::pareto;
    use proptest::prelude::*;

    proptest! {
        /// Against the definition, by comparing all pairs.
        #[test]
        fn nothing_beats_the_front_and_it_beats_or_equals_the_rest(
            points in prop::collection::vec((0u8..20, 0u8..20), 0..60),
        ) {
            let points: Vec<(f64, f64)> = points.iter().map(|p| (f64::from(p.0), f64::from(p.1))).collect();
            let beats = |a: (f64, f64), b: (f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
            let front = pareto(&points);
            for (i, p) in points.iter().enumerate() {
                let beaten = points.iter().any(|q| beats(*q, *p));
                let first = points.iter().position(|q| q == p) == Some(i);
                prop_assert_eq!(front.contains(&i), !beaten && first);
            }
            prop_assert!(front.windows(2).all(|w| points[w[0]].0 < points[w[1]].0));
        }
    }
}
