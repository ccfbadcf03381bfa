//! Noise of a reference, from the means of its even and odd samples.

use super::{Compared, Linear, Metric, MetricError, RELMSE, means, relmse, structure_noise};

/// Noise of a reference, by metric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// relMSE of one half's mean against the other. The mean of all samples has a quarter of it.
    pub relmse: f64,
    /// FLIP of the mean of all samples against the converged reference.
    pub flip: f64,
    /// Structure error of the mean of all samples ([`super::structure_noise`]), natural log units.
    pub structure: f64,
}

impl Noise {
    /// Error of the mean of all samples by a metric, if it is known.
    pub(crate) fn in_mean(&self, metric: &Metric) -> Option<f64> {
        let noise = match metric.key {
            RELMSE => self.relmse / 4.0,
            "flip" => self.flip,
            "structure" => self.structure,
            _ => return None,
        };
        noise.is_finite().then_some(noise)
    }

    /// The noise of `mean`, the mean of both halves. The difference between one half and `mean` has
    /// the variance of the error of `mean`, so their FLIP needs no scale factor. FLIP is not linear.
    ///
    /// # Errors
    /// Pictures of different sizes, without pixels, or of more than `MAX_PIXELS`.
    pub fn of_halves([even, odd]: [&Linear; 2], mean: &Linear) -> Result<Noise, MetricError> {
        Ok(Noise {
            relmse: relmse(even, odd)?,
            flip: means::flip(&Compared::new(even, mean)?, None),
            structure: structure_noise(even, odd)?,
        })
    }
}
