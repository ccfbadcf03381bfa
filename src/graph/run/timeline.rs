//! When a frame was worked on, on the CPU's time line.

use crate::vulkan::{ClockReading, Gpu};
use std::time::{Duration, Instant};

/// Times of a frame's work; spans have a start and an end.
#[derive(Clone, Copy, Debug)]
pub struct Timeline {
    /// The CPU recorded commands.
    pub recorded: [Instant; 2],
    /// The CPU submitted them.
    pub submitted: [Instant; 2],
    /// The CPU waited for the frame to finish.
    pub waited: [Instant; 2],
    /// The first timestamp of the GPU, with its uncertainty; `None` without calibrated timestamps.
    pub gpu: Option<(Instant, Duration)>,
}

/// The last reading of the device's clock.
#[derive(Default)]
pub(super) struct Calibration(Option<ClockReading>);

/// Age at which a reading is replaced: the two clocks drift apart.
const AGE: Duration = Duration::from_millis(100);

impl Calibration {
    /// The time of a frame's first timestamp, and its uncertainty.
    pub fn time(&mut self, gpu: &Gpu, ticks: &[u64]) -> Option<(Instant, Duration)> {
        let first = ticks.first()?;
        if self.0.is_none_or(|reading| reading.at.elapsed() > AGE) {
            self.0 = gpu.read_clock();
        }
        let reading = self.0?;
        Some((gpu.info.instant(&reading, *first)?, reading.uncertainty))
    }
}
