//! Methods and cases of a suite.

use super::motion::Motion;
use crate::campaign::settings::Setting;

/// A method: what it sets over the suite's experiment.
#[derive(Clone, Debug)]
pub struct Method {
    /// Name of the method.
    pub name: String,
    /// Settings of the method.
    pub set: Vec<Setting>,
}

/// Something that methods are looked at in.
#[derive(Clone, Debug)]
pub struct Case {
    /// Name of the case.
    pub name: String,
    /// Name of the variant, if the case has some.
    pub variant: String,
    /// For people.
    pub about: String,
    /// What it sets over the method.
    pub set: Vec<Setting>,
    /// What moves.
    pub motion: Motion,
    /// Frames that run, moving, before the first measured one.
    pub warmup: usize,
    /// Frames measured, when nothing else is asked for.
    pub frames: usize,
    /// Whether more or fewer frames may be asked for: a case with its own number knows what it needs.
    pub own_frames: bool,
    /// Names of the methods that it is for; all when empty.
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
