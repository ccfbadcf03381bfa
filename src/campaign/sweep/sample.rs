//! Sampling of many settings at once.

use crate::scene::splitmix;

/// `count` points in the unit cube of `dimensions` dimensions: along every axis each of `count` equal intervals holds
/// one point (McKay, Beckman and Conover 1979). The same on every machine.
pub(super) fn latin_hypercube(count: usize, dimensions: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut state = seed;
    let mut points = vec![Vec::with_capacity(dimensions); count];
    for _ in 0..dimensions {
        let mut order: Vec<usize> = (0..count).collect();
        for i in (1..count).rev() {
            order.swap(i, (splitmix(&mut state) % (i as u64 + 1)) as usize);
        }
        for (point, interval) in points.iter_mut().zip(order) {
            let inside = (splitmix(&mut state) >> 11) as f64 / (1u64 << 53) as f64;
            point.push((interval as f64 + inside) / count as f64);
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::latin_hypercube;

    #[test]
    fn every_interval_of_every_axis_holds_one_sample() {
        let points = latin_hypercube(17, 3, 5);
        assert_eq!(points, latin_hypercube(17, 3, 5));
        assert_ne!(points, latin_hypercube(17, 3, 6));
        for axis in 0..3 {
            let mut hit: Vec<usize> = points.iter().map(|p| (p[axis] * 17.0) as usize).collect();
            hit.sort_unstable();
            assert_eq!(hit, (0..17).collect::<Vec<_>>());
        }
    }
}
