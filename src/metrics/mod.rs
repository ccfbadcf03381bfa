//! Stand-in until the metrics are merged.
#![allow(missing_docs)]
use crate::lab::LabError;
use serde::{Deserialize, Serialize};
#[derive(Clone, Debug, PartialEq)]
pub struct Linear {
    pub size: (u32, u32),
    pub rgb: Vec<[f32; 3]>,
}
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scores {
    pub relmse: f64,
}
pub fn scores(test: &Linear, reference: &Linear) -> Result<Scores, LabError> {
    let all: Vec<f64> = test
        .rgb
        .iter()
        .flatten()
        .zip(reference.rgb.iter().flatten())
        .map(|(x, r)| f64::from((x - r).powi(2) / (r * r + 0.01)))
        .collect();
    Ok(Scores { relmse: all.iter().sum::<f64>() / all.len() as f64 })
}
