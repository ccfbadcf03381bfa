//! Animation curves as in glTF 2.0, Appendix C.

use glam::{Quat, Vec3, Vec4};

/// Interpolation between two keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// The value of the previous key.
    Step,
    /// Linear; for rotations along the shorter arc.
    Linear,
    /// Cubic Hermite spline. Each key has an in-tangent, a value and an out-tangent; tangents are
    /// per second.
    Cubic,
}

/// Values that can be interpolated.
pub trait Value: Copy {
    /// Interpolates from `self` to `other` at `s` in 0..1.
    fn between(self, other: Self, s: f32) -> Self;
    /// Weighted sum.
    fn sum(values: [Self; 4], weights: [f32; 4]) -> Self;
    /// Whether all components are finite.
    fn is_finite(self) -> bool;
}

/// A value over time; constant before the first and after the last key.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve<T> {
    times: Vec<f32>,
    values: Vec<T>,
    interpolation: Interpolation,
}

impl<T: Value> Curve<T> {
    /// `None` if there is no key, a time or value is not finite, times do not increase, or the
    /// number of values does not match (one per time, three for cubic curves).
    pub fn new(times: Vec<f32>, values: Vec<T>, interpolation: Interpolation) -> Option<Curve<T>> {
        let each = if interpolation == Interpolation::Cubic {
            3
        } else {
            1
        };
        let fits = !times.is_empty() && values.len() == times.len().checked_mul(each)?;
        let finite = times.iter().all(|t| t.is_finite()) && values.iter().all(|v| v.is_finite());
        (fits && finite && times.is_sorted()).then_some(Curve {
            times,
            values,
            interpolation,
        })
    }

    /// The curve times a factor, if its values stay finite.
    pub(in crate::scene) fn scaled(&self, factor: f32) -> Option<Curve<T>>
    where
        T: std::ops::Mul<f32, Output = T>,
    {
        let values = self.values.iter().map(|v| *v * factor).collect();
        Curve::new(self.times.clone(), values, self.interpolation)
    }

    /// Times of the keys (s), increasing.
    pub fn times(&self) -> &[f32] {
        &self.times
    }

    /// One value per key, or three for cubic curves.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    pub fn interpolation(&self) -> Interpolation {
        self.interpolation
    }

    /// The value at a time in seconds.
    pub fn at(&self, time: f32) -> T {
        let next = self.times.partition_point(|t| *t <= time);
        let (a, b) = (next.saturating_sub(1), next.min(self.times.len() - 1));
        let span = self.times[b] - self.times[a];
        let s = if span > 0.0 {
            ((time - self.times[a]) / span).clamp(0.0, 1.0)
        } else {
            0.0
        };
        match self.interpolation {
            Interpolation::Step => self.values[a],
            Interpolation::Linear => self.values[a].between(self.values[b], s),
            Interpolation::Cubic => {
                let (s2, s3) = (s * s, s * s * s);
                let weights = [
                    2.0 * s3 - 3.0 * s2 + 1.0,
                    span * (s3 - 2.0 * s2 + s),
                    3.0 * s2 - 2.0 * s3,
                    span * (s3 - s2),
                ];
                let keys = [3 * a + 1, 3 * a + 2, 3 * b + 1, 3 * b].map(|i| self.values[i]);
                T::sum(keys, weights)
            }
        }
    }
}

impl Value for f32 {
    fn between(self, other: f32, s: f32) -> f32 {
        self + (other - self) * s
    }
    fn sum(values: [f32; 4], weights: [f32; 4]) -> f32 {
        values.iter().zip(weights).map(|(v, w)| v * w).sum()
    }
    fn is_finite(self) -> bool {
        f32::is_finite(self)
    }
}

impl Value for Vec3 {
    fn between(self, other: Vec3, s: f32) -> Vec3 {
        self.lerp(other, s)
    }
    fn sum(values: [Vec3; 4], weights: [f32; 4]) -> Vec3 {
        values.into_iter().zip(weights).map(|(v, w)| v * w).sum()
    }
    fn is_finite(self) -> bool {
        Vec3::is_finite(self)
    }
}

/// Tangents of cubic curves are quaternions without unit length.
impl Value for Quat {
    fn between(self, other: Quat, s: f32) -> Quat {
        self.slerp(other, s)
    }
    fn sum(values: [Quat; 4], weights: [f32; 4]) -> Quat {
        let sum: Vec4 = values
            .into_iter()
            .zip(weights)
            .map(|(q, w)| Vec4::from(q) * w)
            .sum();
        sum.try_normalize().map_or(Quat::IDENTITY, Quat::from_vec4)
    }
    fn is_finite(self) -> bool {
        Quat::is_finite(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubic_curves_pass_their_keys_with_their_tangents() {
        // x^3 from 1 to 3: its own Hermite spline.
        let (f, slope) = (|x: f32| x * x * x, |x: f32| 3.0 * x * x);
        let values = [1.0, 3.0]
            .into_iter()
            .flat_map(|x| [slope(x), f(x), slope(x)])
            .collect();
        let curve = Curve::new(vec![1.0, 3.0], values, Interpolation::Cubic).unwrap();
        for x in [1.0, 1.25, 2.0, 2.9, 3.0] {
            assert!((curve.at(x) - f(x)).abs() < 1e-4, "{x}: {}", curve.at(x));
        }
        assert_eq!((curve.at(0.0), curve.at(9.0)), (1.0, 27.0));
    }

    #[test]
    fn steps_hold_and_what_is_no_curve_is_refused() {
        let curve = Curve::new(
            vec![0.0, 1.0, 2.0],
            vec![5.0, 6.0, 7.0],
            Interpolation::Step,
        )
        .unwrap();
        assert_eq!(
            [-1.0, 0.0, 0.999, 1.0, 1.5, 2.0, 3.0].map(|t| curve.at(t)),
            [5.0, 5.0, 5.0, 6.0, 6.0, 7.0, 7.0]
        );
        let none = |times: &[f32], values: &[f32]| {
            assert_eq!(
                Curve::new(times.to_vec(), values.to_vec(), Interpolation::Linear),
                None
            );
        };
        none(&[], &[]);
        none(&[0.0, 1.0], &[1.0]);
        none(&[1.0, 0.0], &[1.0, 1.0]);
        none(&[0.0, f32::NAN], &[1.0, 1.0]);
        none(&[0.0], &[f32::INFINITY]);
    }
}
