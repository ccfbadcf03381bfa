//! Methods and cases of a suite.

use super::motion::Motion;
use crate::campaign::settings::Setting;

/// A method with its settings over the suite's experiment.
#[derive(Clone, Debug)]
pub struct Method {
    pub name: String,
    pub set: Vec<Setting>,
}

/// A situation in which methods are compared.
#[derive(Clone, Debug)]
pub struct Case {
    pub name: String,
    /// Name of the variant, if the case has some.
    pub variant: String,
    pub about: String,
    /// Settings over the method's.
    pub set: Vec<Setting>,
    pub motion: Motion,
    /// Frames before the first measured one; the case moves during them too.
    pub warmup: usize,
    /// Default number of measured frames.
    pub frames: usize,
    /// Whether the case fixes its number of frames.
    pub own_frames: bool,
    /// Names of its methods, all if empty.
    pub methods: Vec<String>,
    /// Whether its voxels are compared with exact ones.
    pub voxels: bool,
}

impl Case {
    /// Whether a method runs in it.
    pub fn is_for(&self, method: &str) -> bool {
        self.methods.is_empty() || self.methods.iter().any(|m| m == method)
    }
}
